"""What is hidden in the set `eleventh`: structure that is missing, in five groups (README.md).

Each way is one fault with one size. It carries its law (`change`, `parts`, `record`, `reads`; eleventh_network.py), and what it is called: `key` and `place` of truth.json, `also`, whether the grammar can say it exactly (`sayable`),
and `at`, the bodies at which the rule about indistinguishable effects tries other names. The laws are those of things: a tank is pumped while the machine runs, a furnace radiates with the fourth power, a tool that is new has the air's temperature.
"""
import numpy as np

import eighth_faults
import fifth_faults
import seventh_faults
from eighth_faults import all_temperatures, beside, runs
from eleventh_families import FLUID, HIGH, WORK
from eleventh_network import with_rows
from faults import Fault, Impossible, largest_heat, pick, typical_link
from network import Record, first_order
from ninth_faults import InRecords, level, stretches
from seventh_network import part
from sixth_faults import HIDDEN

GROUPS = dict(
    body=["way_cover",                   # bellows or telescopic sheets hang between two parts, in the air
          "gear_oil",                    # oil that two parts share and that is churned
          "control_cabinet",             # a cabinet, or drive electronics in a box, is bolted to a part
          "fixture_changed",             # from one record on another fixture, or an angle plate with a part on it, stays on the table
          "tank_pumped"],                # coolant goes round between a tank and the work space while the machine runs
    exchange=["belt_fans",               # a pulley or a chuck moves the air about a part, the more the faster
              "furnace_beside",          # a furnace of a neighbour shines on a part
              "line_while_running",      # a hydraulic line or a chip stream joins two parts while the machine runs
              "seal_air",                # sealing or blowing air, colder than the hall, blows while the machine runs and a little longer
              "warm_under_the_roof",     # the hall warms from its roof, and high parts are in warmer air
              "shared_pipe"],            # one pipe, or one casting, joins three parts in a row
    input=["heat_follows_another",       # a heat goes by another input than is written, or by none
           "brake_resistor",             # what a spindle gives back as it brakes is burnt beside a part
           "changer_unrecorded",         # the changer, the clamping hydraulics or the loader works at the beginning of each pause
           "sun_wanders",                # the sun goes through a gate from one part to the next
           "gear_stage",                 # below a speed the motor turns faster than the spindle
           "machine_warms_its_air"],     # the ambient is recorded where the machine does not warm the air
    path=["stand_follows_hall",          # the stand of the indicators goes with the hall, late
          "position_changes",            # the axis has another position in some programmes, so that more or less of a body lies between tool and table
          "thermometer_on_plate",        # a thermometer sits on a plate between body and air
          "thermometer_in_return",       # a thermometer reads a neighbour while oil or coolant passes it
          "control_compensates",         # the control moves the axis by a thermometer of its own, every so many minutes
          "tool_swapped"],               # each run begins with a tool that is as warm as the air
    event=["power_cut",                  # everything was off for a while, pumps and electronics too, but the record has the commanded speed
           "washed_down",                # a part is hosed down once
           "tank_refilled",              # a tank, a sump or a gearbox is filled up with cold or warm fluid
           "rezeroed",                   # the indicators are set anew in a pause, or in several
           "remounted",                  # thermometers are put elsewhere, between two records or in one
           "ran_by_hand"])               # the spindle turned in a pause, by hand, and only programmes are recorded
GROUP = {w: g for g, ways in GROUPS.items() for w in ways}
WAYS_A = list(GROUP)
NOT_STEADY = {"furnace_beside", "warm_under_the_roof"}      # a machine at rest for long before would have another state
NOT_OUTDOORS = {"seal_air", "furnace_beside", "changer_unrecorded", "tool_swapped", "position_changes", "control_compensates"}      # there is no machine there
N_RECORDS = {"fixture_changed": [2, 3, 4, 5]}
MOST_NATS = 400
STEFAN_BOLTZMANN = 5.67e-8
FILM = ["convection", "contact"]


def hide(records, name, unit, values, must_move=True):
    for r in records:
        r.columns[name] = (unit, np.asarray(values(r), float))
    if must_move and not any(np.ptp(r.columns[name][1]) > 0 for r in records if r.name != "holdout_1"):
        raise Impossible


def late(r, x, tau, y0=0.0):
    """tau dy/dt = x - y, of x that holds from row on."""
    y = np.full(len(x), float(y0))
    for k in range(1, len(x)):
        e = np.exp(-(r.time_s[k] - r.time_s[k - 1]) / tau)
        y[k] = y[k - 1] * e + x[k - 1] * (1 - e)
    return y


def begins(on):
    """Where something goes on that was off one row before."""
    on = np.asarray(on, bool)
    return np.append(False, on[1:] & ~on[:-1])


def column(f, mode, node, k=0, size=None):
    return part(f, "recorded_drive", size, node=node, column=f.data["columns"][k], mode=mode)


def exchange(f, a, b, size):
    out = InRecords("exchange_window", dict(a=a, b=b, by_record=f.data["by_record"]), f.records)
    out.size = size
    return out


def heat(kind, node, **law):
    return {**dict(kind=kind, node=node, at=1.0, axis=None, turning=False, has_exponent=False, has_idle=False, has_decay=False), **law}


def draw(rng, way, machine, plan, records, extra, noise):
    """The fault that this way of being wrong is; some put columns into `records` that no file has."""
    if way not in GROUP:
        return fifth_faults.draw(rng, way, machine, plan, records, extra)
    if way in NOT_OUTDOORS and plan.get("outdoor"):
        raise Impossible
    measured = [r for r in records if r.name != "holdout_1"]
    names = [r.name for r in measured]
    shortest = min(r.time_s[-1] for r in records)
    sign = 1.0 if rng.random() < 0.5 else -1.0
    watts, g = largest_heat(machine, plan), typical_link(machine)
    speeds = [i for i, h in enumerate(machine.heats) if h["has_exponent"] and h["kind"] not in ("servo_loss", "cutting_heat")]      # heats that follow the speed
    channels, sensors = [d[0] for d in machine.displacements], [n for n, _ in machine.sensors]
    value, solid = lambda k: machine.numbers[k][0], [b for b in machine.bodies if b not in machine.air]
    tau = lambda low=0.01, high=0.15: float(shortest * np.exp(rng.uniform(np.log(low), np.log(high))))
    uniform, log_uniform = lambda a, b: float(rng.uniform(a, b)), lambda a, b: float(np.exp(rng.uniform(np.log(a), np.log(b))))
    running = lambda r: np.asarray(runs(machine, r), float)
    work = [b for b in WORK[machine.family] if b in solid]
    linked = {frozenset(x) for x in machine.links}
    hidden = lambda n=1: [f"{HIDDEN}_{way}_{k}" for k in range(n)]
    rest = lambda r: [(a, b) for a, b in stretches(r.time_s, running(r) == 0) if b <= r.time_s[-1] and a > 0]
    paired = lambda at: [(k, f"{a},{b}") for i, a in enumerate(at) for b in at[i + 1:] for k in ("link", "contact")]

    def of_body(body, rs=measured):
        i = len(machine.bodies) if body == "hall" else machine.bodies.index(body)
        return np.concatenate([r.hall if body == "hall" else t[:, i] for r, t in zip(rs, all_temperatures(machine, rs))])

    def fault(low, high, key, place, also=(), sayable=False, where=None, sign=1.0, windows=None, **data):
        return [Fault(way, dict(dict(way=way, key=key, place=place, also=list(also), sayable=sayable, at=[], sizes={}), **data), where, low, high, sign, windows)]

    # --- a body -------------------------------------------------------------------------------------------------------------
    if way == "way_cover":
        a, b = pick(rng, [x for x in machine.links if x[1] != "hall" and set(x) <= set(solid)])
        c = min(value("C " + a), value("C " + b)) * log_uniform(0.03, 0.3)
        ga, share, out = c / tau(0.02, 0.1), uniform(0.4, 1), uniform(0.1, 0.5)

        def cover(m, numbers, s):
            m.bodies.append("way_cover")
            m.links += [("way_cover", a), ("way_cover", b), ("way_cover", "hall")]
            numbers.update({"C way_cover": np.maximum(s * c, 1e-3), f"G way_cover {a}": s * ga, f"G way_cover {b}": s * share * ga, "G way_cover hall": s * out * ga})
        return fault(0.02, 8, "hidden_body", a, [("hidden_body", b), ("heat_capacity", a), ("heat_capacity", b)] + paired([a, b]), True, at=[a, b], change=cover, sizes=dict(capacity=c, conductance=ga, to_the_other=share * ga, to_hall=out * ga))
    if way == "gear_oil":
        driven = [machine.heats[i]["node"] for i in speeds] or [h["node"] for h in machine.heats if h["node"] in solid]
        a = pick(rng, driven)
        b = pick(rng, [x for x in solid if x != a and (frozenset((a, x)) in linked or rng.random() < 0.3)])
        c = value("C " + a) * log_uniform(0.1, 0.8)
        ga, share, out, e, w = c / tau(0.01, 0.08), uniform(0.3, 1), uniform(0.05, 0.3), float(round(uniform(1.2, 2.4), 2)), watts * uniform(0.05, 0.2)
        axis = pick(rng, sorted(plan["feeds"])) if not speeds and plan.get("feeds") else None
        law = heat("heat_source", "gear_oil", at=float(plan["top"]), has_exponent=True) if speeds else heat("servo_loss", "gear_oil", at=plan["feeds"][axis] / 60000, has_exponent=True, axis=axis) if axis else heat("cutting_heat", "gear_oil")

        def oil(m, numbers, s):
            i = len(m.heats)
            m.bodies.append("gear_oil")
            m.links += [("gear_oil", a), ("gear_oil", b), ("gear_oil", "hall")]
            m.heats.append(law)
            numbers.update({"C gear_oil": np.maximum(s * c, 1e-3), f"G gear_oil {a}": s * ga, f"G gear_oil {b}": s * share * ga, "G gear_oil hall": s * out * ga, f"P {i}": s * w / (plan["power"] if law["kind"] == "cutting_heat" else 1.0)})
            if law["has_exponent"]:
                numbers[f"e {i}"] = np.full_like(s, e)
        return fault(0.01, 8, "hidden_body", a, [("hidden_body", b)] + [(k, x) for x in (a, b) for k in ("heat_capacity", "heat_source")] + paired([a, b]), True, at=[a, b], change=oil, sizes=dict(capacity=c, conductance=ga, to_the_other=share * ga, to_hall=out * ga, churned_W=w, exponent=e))
    if way == "control_cabinet":
        a = pick(rng, sorted(solid, key=lambda b: -value("C " + b))[:max(2, (len(solid) + 1) // 2)])
        w, out, warmer, idle = watts * uniform(0.1, 0.6), uniform(0.3, 1.5), uniform(8, 30), 1.0 if rng.random() < 0.6 else 0.35      # alone it would be so much warmer than all about it
        ga = w / warmer / (1 + out)
        c = ga * tau(0.01, 0.1)

        def cabinet(m, numbers, s):
            m.bodies.append("cabinet")
            m.links += [("cabinet", a), ("cabinet", "hall")]
            numbers.update({"C cabinet": np.maximum(s * c, 1e-3), f"G cabinet {a}": s * ga, "G cabinet hall": s * out * ga})
            for turning, share in ((False, idle), (True, 1 - idle)):
                if share > 0 and (speeds or not turning):
                    numbers[f"P {len(m.heats)}"] = s * share * w
                    m.heats.append(heat("heat_source", "cabinet", turning=turning))
        return fault(0.01, 8, "hidden_body", a, [("heat_source", a), ("heat_capacity", a)], True, at=[a], change=cabinet, sizes=dict(capacity=c, conductance=ga, to_hall=out * ga, power_W=w, share_at_rest=idle))
    if way == "fixture_changed":
        a, behind = pick(rng, work), rng.random() < 0.4
        c = value("C " + a) * log_uniform(0.15, 1.5)
        ga, out, c2, g2 = c / tau(0.01, 0.12), uniform(0.1, 0.5), c * uniform(0.3, 1.2), c / tau(0.01, 0.12)
        where = names[int(rng.integers(1, len(names))):] + ["holdout_1"] if len(names) > 1 else pick(rng, [])

        def fixture(m, numbers, s):
            last = "part_on_it" if behind else "fixture"
            m.bodies += ["fixture", "part_on_it"] if behind else ["fixture"]
            m.links += [("fixture", a)] + ([("part_on_it", "fixture")] if behind else []) + [(last, "hall")]
            numbers.update({"C fixture": np.maximum(s * c, 1e-3), f"G fixture {a}": s * ga, f"G {last} hall": s * out * ga})
            if behind:
                numbers.update({"C part_on_it": np.maximum(s * c2, 1e-3), "G part_on_it fixture": s * g2})
        return fault(0.02, 8, "hidden_body", a, [("heat_capacity", a), ("mass_change", a)], where=where, at=[a], change=fixture, sizes=dict(capacity=c, conductance=ga, to_hall=out * ga, second_capacity=c2 if behind else 0.0))
    if way == "tank_pumped":
        washed = [pick(rng, work)]
        if rng.random() < 0.5:
            washed.append(pick(rng, [x for x in solid if x not in washed]))
        g1, c = g * uniform(0.3, 1.5), value("C " + washed[0]) * log_uniform(0.3, 2.5)
        flows, out, warmer = [g1, g1 * uniform(0.3, 1)][:len(washed)], g1 * uniform(0.1, 0.4), uniform(4, 15)
        w = warmer * (out + 0.3 * sum(flows))
        names_of, windows = hidden(), {r.name: stretches(r.time_s, running(r)) for r in records}
        hide(records, names_of[0], "W", running)

        def tank(m, numbers, s):
            m.bodies.append("coolant_tank")
            m.links.append(("coolant_tank", "hall"))
            numbers.update({"C coolant_tank": np.maximum(s * c, 1e-3), "G coolant_tank hall": s * out})
        parts = lambda f, m, numbers, r: [exchange(f, x, "coolant_tank", f.size * y) for x, y in zip(washed, flows)] + [column(f, "gain", "coolant_tank", 0, f.size * w)]
        return fault(0.02, 8, "hidden_body", washed[0], [(k, x) for x in washed for k in ("hidden_body", "coolant", "exchange_window", "heat_source", "heat_capacity")] + paired(washed), at=washed, change=tank, parts=parts, columns=names_of, by_record=windows, washed=washed, flows=flows, pump=w,
                     sizes=dict(capacity=c, conductances=flows, to_hall=out, pump_W=w))
    # --- a link, an exchange, a surrounding -------------------------------------------------------------------------------------
    if way == "belt_fans":
        driven = {machine.heats[i]["node"] for i in speeds}
        if max(len(np.unique(r.speed)) for r in records) > 24:      # each speed is a network of its own
            raise Impossible
        a, e, names_of = pick(rng, [b for b in solid if b in driven or set(beside(machine, b)) & driven]), float(round(uniform(0.6, 0.9), 2)), hidden()
        hide(records, names_of[0], "1", lambda r: (r.speed / plan["top"]) ** e)
        return fault(0.01 * g, 8 * g, "forced_convection", a, [(k, a) for k in FILM + ["exchange_window"]] + [("link", a + ",hall")], at=[a], columns=names_of, node=a, parts=lambda f, m, numbers, r: [column(f, "opening", a)], sizes=dict(exponent=e))
    if way == "furnace_beside":
        a, hot, slow, names_of, shift = pick(rng, [b for b in solid if frozenset((b, "hall")) in linked]), uniform(70, 260), tau(0.03, 0.2), hidden(), {}
        for r in records:
            begin = uniform(-0.3, 0.6)
            shift[r.name] = [begin, begin + uniform(0.3, 0.8)]

        def furnace(r):
            x = r.time_s / r.time_s[-1]
            on = ((x >= shift[r.name][0]) & (x < shift[r.name][1])).astype(float)
            return r.hall + (hot - 20) * late(r, on, slow, uniform(0.7, 1) if shift[r.name][0] < 0 else 0.0)
        hide(records, names_of[0], "degC", furnace)
        scale = STEFAN_BOLTZMANN * ((hot + 273.15) ** 4 - 293.15 ** 4)

        def shines(m, numbers, s):
            def make(index, record, row, speed, hall):
                i, warm = index[a], (record.columns[names_of[0]][1][row] + 273.15) ** 4
                return lambda T, k: [(i, s * STEFAN_BOLTZMANN * (warm[k] - (T[:, i] + 273.15) ** 4))]
            m.feedback = list(getattr(m, "feedback", ())) + [make]
        return fault(0.01 * watts / scale, 4 * watts / scale, "radiation", a, [("heat_window", a), ("heat_source", a)], at=[a], change=shines, columns=names_of, node=a, sizes=dict(unit="m^2", hot_degC=round(hot, 1), lag_min=round(slow / 60, 2), shares_of_record={k: [round(z, 3) for z in x] for k, x in shift.items()}))
    if way == "line_while_running":
        a = pick(rng, solid)
        b = pick(rng, [x for x in solid if x != a and frozenset((a, x)) not in linked])
        windows = {r.name: stretches(r.time_s, running(r)) for r in records}
        if any(not 0 < len(x) <= 60 for x in windows.values()):
            raise Impossible
        return fault(0.01 * g, 10 * g, "exchange_window", f"{a},{b}", paired([a, b]), True, at=[a, b], by_record=windows, pair=[a, b], parts=lambda f, m, numbers, r: [exchange(f, a, b, f.size)], parameters=[("conductance", "W/K")])
    if way == "seal_air":
        heated = [h["node"] for h in machine.heats if h["node"] in solid]
        a, colder, after, names_of = pick(rng, heated if rng.random() < 0.6 else solid), float(round(uniform(4, 14), 1)), tau(0.005, 0.03), hidden(2)

        def blows(r):
            last = np.maximum.accumulate(np.where(running(r) > 0, np.append(r.time_s[1:], r.time_s[-1]), -1e9))
            return ((running(r) > 0) | (r.time_s - last < after)).astype(float)
        hide(records, names_of[0], "1", blows)
        hide(records, names_of[1], "W", lambda r: -colder * blows(r))
        return fault(0.01 * g, 8 * g, "exchange_window", a + ",hall", [(k, a) for k in ["coolant", "forced_convection", "heat_source"] + FILM] + [("link", a + ",hall")], at=[a], columns=names_of, node=a, parts=lambda f, m, numbers, r: [column(f, "opening", a), column(f, "gain", a, 1)],
                     sizes=dict(colder_K=colder, after_min=round(after / 60, 2)))
    if way == "warm_under_the_roof":
        films = [b for b in HIGH[machine.family] if frozenset((b, "hall")) in linked]
        if len(films) < 2:
            raise Impossible
        high = [films[int(i)] for i in rng.choice(len(films), int(rng.integers(2, min(3, len(films)) + 1)), replace=False)]
        shares, slow, names_of, kind = [1.0] + [float(x) for x in np.round(rng.uniform(0.4, 0.95, len(high) - 1), 2)], tau(0.08, 0.4), hidden(), rng.random()
        phase = {r.name: uniform(0, 0.4) for r in records}
        hide(records, names_of[0], "K", lambda r: 0.3 + 0.7 * (1 - np.exp(-r.time_s / slow) if kind < 0.5 else np.clip(np.sin(np.pi * (r.time_s / r.time_s[-1] + phase[r.name]) / 1.4), 0, None)))
        return fault(0.2, 20, "stratification", "hall", [("ambient", "hall")] + [(k, b) for b in high for k in ("stratification", "heat_source", "radiation")], at=high, columns=names_of, bodies=high, shares=shares,
                     parts=lambda f, m, numbers, r: [column(f, "gain", b, 0, f.size * x * numbers[f"G {b} hall"]) for b, x in zip(high, shares)], sizes=dict(unit="K", bodies=high, shares=shares))
    if way == "shared_pipe":
        a = pick(rng, solid)
        free = [x for x in solid if x != a and frozenset((a, x)) not in linked]
        if len(free) < 2:
            raise Impossible
        (b, c), share = (free[int(i)] for i in rng.choice(len(free), 2, replace=False)), float(round(uniform(0.4, 1), 2))

        def pipe(m, numbers, s):
            m.links += [(a, b), (a, c)]
            numbers.update({f"G {a} {b}": s, f"G {a} {c}": share * s})
        return fault(0.01 * g, 8 * g, "link", f"{a},{b}", [("contact", f"{a},{b}"), ("link", f"{a},{c}"), ("contact", f"{a},{c}")], True, at=[a, b, c], change=pipe, sizes=dict(unit="W/K", other=c, share_of_other=share))
    # --- an input -------------------------------------------------------------------------------------------------------------------
    if way == "heat_follows_another":
        i = pick(rng, [i for i, h in enumerate(machine.heats) if h["has_exponent"] or h["kind"] == "cutting_heat"])
        h = machine.heats[i]
        own = "power" if h["kind"] == "cutting_heat" else h["axis"] if h["kind"] == "servo_loss" else "speed"
        law = pick(rng, [x for x in (["speed"] * bool(speeds) + ["power"] * ("power" in plan) + sorted(plan.get("feeds", {}))) * 2 + ["constant"] if x != own])
        e = float(round(uniform(0.8, 1.6), 2))
        new = {"speed": heat("heat_source", h["node"], at=float(plan.get("top", 1)), has_exponent=True), "power": heat("cutting_heat", h["node"]), "constant": heat("heat_source", h["node"])}.get(law) or heat("servo_loss", h["node"], at=plan["feeds"][law] / 60000, has_exponent=True, axis=law)
        mean = lambda x: float(np.mean(np.concatenate([x(r) for r in measured])))
        was = value(f"P {i}") * (plan["power"] if own == "power" else 1) * mean(lambda r: level(machine, plan, i, r))
        p = was / max(1e-9, mean(dict(speed=lambda r: (r.speed / plan.get("top", 1)) ** e, power=lambda r: r.power, constant=lambda r: np.ones(len(r.time_s))).get(law) or (lambda r: (r.feeds[law] / new["at"]) ** e)))
        if p > (0.9 - sum(value(f"P {k}") for k, x in enumerate(machine.heats) if x["kind"] == "cutting_heat") if law == "power" else 4 * watts):
            raise Impossible

        def other(m, numbers, s):
            s, k = np.minimum(s, 1.0), len(m.heats)
            m.heats.append(new)
            numbers.update({f"P {i}": (1 - s) * numbers[f"P {i}"], f"P {k}": s * p})
            if new["has_exponent"]:
                numbers[f"e {k}"] = np.full_like(s, e)
        also = ([("friction_law", h["node"])] if h["has_exponent"] or new["has_exponent"] else []) + ([("recorded_drive", h["node"])] if {own, law} - {"speed", "constant"} else [])
        return fault(0.02, 1.0, "heat_source", h["node"], also, True, at=[h["node"]], change=other, law=law, own=own, sizes=dict(written=own, follows=law, exponent=e if new["has_exponent"] else None, at_full=p))
    if way == "brake_resistor":
        if not speeds:
            raise Impossible
        driven = {machine.heats[i]["node"] for i in speeds if machine.heats[i]["kind"] != "motor_loss"}
        a, fades, names_of = pick(rng, [b for b in solid if b not in driven]), tau(0.01, 0.05), hidden()

        def burnt(r):
            fallen, out, x = np.append(0.0, np.maximum(0, -np.diff((r.speed / plan["top"]) ** 2))), np.zeros(len(r.time_s)), 0.0
            for k in range(len(out)):      # the mean of each row, so that all that is given back becomes heat
                h = r.time_s[min(k + 1, len(out) - 1)] - r.time_s[min(k, len(out) - 2)]
                x += fallen[k]
                out[k] = x * (1 - np.exp(-h / fades)) * fades / h
                x *= np.exp(-h / fades)
            return out
        hide(records, names_of[0], "W", burnt)
        return fault(0.02 * watts, 30 * watts, "heat_source", a, [("heat_window", a)], at=[a], columns=names_of, node=a, parts=lambda f, m, numbers, r: [column(f, "gain", a)], sizes=dict(unit="W", fades_min=round(fades / 60, 2)))
    if way == "changer_unrecorded":
        a, lasts, names_of = pick(rng, work if rng.random() < 0.4 else solid), tau(0.006, 0.03), hidden()

        def changes(r):
            ended = begins(running(r) == 0)
            since = r.time_s - np.maximum.accumulate(np.where(ended, r.time_s, -1e9))
            return (running(r) == 0) & (since < lasts)
        hide(records, names_of[0], "W", changes)
        if any(np.sum(begins(r.columns[names_of[0]][1])) < 3 for r in measured):
            raise Impossible
        return fault(0.02 * watts, 6 * watts, "heat_window", a, [("heat_source", a)], at=[a], columns=names_of, node=a, parts=lambda f, m, numbers, r: [column(f, "gain", a)], sizes=dict(unit="W", lasts_min=round(lasts / 60, 2)))
    if way == "sun_wanders":
        k = min(len(solid), int(rng.integers(2, 4)))
        bodies, names_of = [solid[int(i)] for i in rng.choice(len(solid), k, replace=False)], hidden(k)
        shares, width, step = [1.0] + [float(x) for x in np.round(rng.uniform(0.5, 1, k - 1), 2)], uniform(0.05, 0.11) * shortest, uniform(0.1, 0.2) * shortest
        first = {r.name: uniform(0.05, 0.9) * r.time_s[-1] - 0.5 * step * (k - 1) for r in records}
        for j, name in enumerate(names_of):
            hide(records, name, "W", lambda r: np.exp(-0.5 * ((r.time_s - first[r.name] - j * step) / width) ** 2))
        return fault(0.02 * watts, 5 * watts, "heat_window", bodies[0], [(x, b) for b in bodies for x in ("heat_window", "heat_source", "radiation")], at=bodies, columns=names_of, bodies=bodies, shares=shares,
                     parts=lambda f, m, numbers, r: [column(f, "gain", b, j, f.size * x) for j, (b, x) in enumerate(zip(bodies, shares))], sizes=dict(unit="W", bodies=bodies, shares=shares, first_min={n: round(x / 60, 2) for n, x in first.items()}, step_min=round(step / 60, 2), width_min=round(width / 60, 2)))
    if way == "gear_stage":
        i = pick(rng, [i for i in speeds if machine.heats[i]["kind"] == "motor_loss"] or speeds)
        h, e, share, names_of = machine.heats[i], value(f"e {i}"), uniform(0.3, 0.6), hidden()
        at = float(round(share * plan["top"]))
        low = np.concatenate([r.speed[r.speed > 0] < at for r in measured])
        if low.size == 0 or not 0.05 < low.mean() < 0.85:
            raise Impossible
        hide(records, names_of[0], "W", lambda r: np.where((r.speed > 0) & (r.speed < at), (r.speed / share / h["at"]) ** e - (r.speed / h["at"]) ** e, 0.0))
        return fault(0.02, 1.2, "friction_law", h["node"], [("heat_source", h["node"])], at=[h["node"]], columns=names_of, node=h["node"], heat=f"P {i}", parts=lambda f, m, numbers, r: [column(f, "gain", h["node"], 0, f.size * numbers[f"P {i}"])], sizes=dict(below_rpm=at, ratio=round(1 / share, 3)))
    if way == "machine_warms_its_air":
        slow = tau(0.01, 0.1)
        use = (lambda r: r.speed / plan["top"]) if speeds else (lambda r: r.power / plan["power"]) if "power" in plan else running

        def warmed(r, s):
            return Record(r.name, r.time_s, r.speed, r.feeds, r.power, r.hall + s * late(r, use(r), slow), r.columns)
        return fault(0.2, 12, "ambient", "hall", [("hidden_body", "hall")], bool(speeds), record=warmed, at=[], slow=slow, sizes=dict(unit="K", lag_min=round(slow / 60, 2)))
    # --- a path to what is read -----------------------------------------------------------------------------------------------------
    if way == "stand_follows_hall":
        if not channels:
            raise Impossible
        shares, lag = [1.0] + [float(x) for x in np.round(rng.uniform(0.3, 1, len(channels) - 1) * rng.choice([-1, 1], len(channels) - 1), 2)], float(round(tau(0.02, 0.25) / 60, 1))
        return fault(0.03, 20, "displacement_path", channels[0], [("displacement_path", c) for c in channels[1:]], True, sign=sign, shares=shares, lag=lag, sizes=dict(unit="um/K", lag_min=lag, shares=shares), parameters=[("sensitivity", "um/K")] if len(channels) == 1 else [],
                     parts=lambda f, m, numbers, r: [part(f, "displacement_path", f.size * x, channel=c, node="hall", lag_min=lag) for c, x in zip(channels, shares)])
    if way == "position_changes":
        name, _, used = pick(rng, machine.displacements)
        b, names_of, levels = pick(rng, [x for x in used if x in solid]), hidden(), [0.0, float(round(uniform(0.3, 0.7), 2)), 1.0]

        def stands(r):
            out, share, t = np.zeros(len(r.time_s)), r.time_s / r.time_s[-1], uniform(0, 0.2)
            while t < 1:
                out[share >= t] = levels[int(rng.integers(3))]
                t += uniform(0.06, 0.25)
            return out
        hide(records, names_of[0], "1", stands)
        if any(np.ptp(r.columns[names_of[0]][1]) == 0 for r in measured) or np.ptp(of_body(b)) < 1:
            raise Impossible

        def reads(f, seen):
            seen.displacements[:, :, seen.channel(name)] += f.size[:, None] * seen.record.columns[f.data["columns"][0]][1] * (seen.bodies[b] - machine.t_ref)
        return fault(0.02, 30, "expansion", f"{b},{name}", [("displacement_path", name), ("scale_expansion", name)], sign=sign, channel=name, columns=names_of, looks=[b], body=b, reads=reads, sizes=dict(unit="um/K", levels=levels))
    if way == "thermometer_on_plate":
        name, b = pick(rng, machine.sensors)
        lag = tau(0.01, 0.08) / 60
        return fault(0.03, 0.95, "sensor_place", name, [("sensor_detached", name), ("sensor_lag", name)], True, sensor=name, lag=lag, sizes=dict(lag_of_one_min=round(lag, 3)), parts=lambda f, m, numbers, r: [part(f, "sensor_place", sensor=name, other="hall"), part(f, "sensor_lag", f.size * lag, sensor=name)])
    if way == "thermometer_in_return":
        name, b = pick(rng, machine.sensors)
        other, names_of = pick(rng, beside(machine, b)), hidden()
        hide(records, names_of[0], "1", running)

        def reads(f, seen):
            y = seen.temperatures[:, :, seen.sensor(name)]
            y += f.size[:, None] * seen.record.columns[f.data["columns"][0]][1] * (seen.bodies[other] - y)
        return fault(0.03, 0.95, "sensor_place", name, sensor=name, columns=names_of, looks=[other], other=other, reads=reads, sizes=dict(body=other))
    if way == "control_compensates":
        name, _, used = pick(rng, machine.displacements)
        b, every = pick(rng, [x for x in used if x in solid] if rng.random() < 0.6 else solid), tau(0.008, 0.05)

        def reads(f, seen):
            k = np.maximum.accumulate(np.where(np.append(True, np.diff(np.floor(seen.t / every)) > 0), np.arange(len(seen.t)), 0))
            seen.displacements[:, :, seen.channel(name)] -= f.size[:, None] * (seen.bodies[b][:, k] - machine.t_ref)
        return fault(0.02, 30, "displacement_path", name, [("expansion", f"{b},{name}")] if b in used else [], sign=sign, channel=name, looks=[b], body=b, every=every, reads=reads, sizes=dict(unit="um/K", body=b, every_min=round(every / 60, 2)))
    if way == "tool_swapped":
        name, _, used = pick(rng, machine.displacements)
        b, slow = pick(rng, [h["node"] for h in machine.heats if h["node"] in solid]), tau(0.01, 0.06)
        fresh = lambda r: np.flatnonzero(begins(running(r)))
        if any(len(fresh(r)) < 2 for r in measured):
            raise Impossible

        def reads(f, seen):
            y, warm, new = np.empty_like(seen.bodies[b]), seen.bodies[b], set(fresh(seen.record))
            y[:, 0] = seen.bodies["hall"][:, 0]
            for k in range(1, y.shape[1]):
                middle = 0.5 * (warm[:, k] + warm[:, k - 1])
                y[:, k] = seen.bodies["hall"][:, k] if k in new else middle + (y[:, k - 1] - middle) * np.exp(-(seen.t[k] - seen.t[k - 1]) / slow)
            seen.displacements[:, :, seen.channel(name)] += f.size[:, None] * (y - machine.t_ref)
        return fault(0.02, 30, "displacement_path", name, [("spindle_growth", name)] if speeds else [], sign=sign, channel=name, looks=[b, "hall"], body=b, reads=reads, sizes=dict(unit="um/K", body=b, lag_min=round(slow / 60, 2)))
    # --- an event -------------------------------------------------------------------------------------------------------------------
    if way == "power_cut":
        r = pick(rng, measured)
        begin = float(pick(rng, r.time_s[(running(r) > 0) & (r.time_s > 0.1 * r.time_s[-1]) & (r.time_s < 0.7 * r.time_s[-1])]))
        low, high = max(0.3 * float(np.median(np.diff(r.time_s))), 0.002 * r.time_s[-1]) / 60, 0.2 * r.time_s[-1] / 60
        names_of = hidden(1 + len(machine.circuits))

        def cut(r, s):
            r = with_rows(r, [begin, begin + 60 * s])
            off = (r.time_s >= begin - 1e-6) & (r.time_s < begin + 60 * s - 1e-3)
            columns = {names_of[0]: ("1", off.astype(float))} | {n: ("W", off * (warm - r.hall)) for n, (_, warm) in zip(names_of[1:], machine.circuits)}
            return Record(r.name, r.time_s, np.where(off, 0.0, r.speed), {a: np.where(off, 0.0, x) for a, x in r.feeds.items()}, np.where(off, 0.0, r.power), r.hall, {**r.columns, **columns})

        def parts(f, m, numbers, r):
            still = [(h["node"], numbers[f"idle {i}"]) for i, h in enumerate(m.heats) if h["kind"] == "servo_loss" and h["has_idle"]] + [(h["node"], numbers[f"P {i}"]) for i, h in enumerate(m.heats) if h["kind"] == "heat_source" and not h["has_exponent"] and not h["turning"]]
            return [column(f, "gain", n, 0, -p) for n, p in still] + [Fault("pump_rests", dict(node=n, on=names_of[0], excess=c), f.records).with_size(np.full_like(f.size, 0.97)) for c, (n, _) in zip(names_of[1:], m.circuits)]
        heated = list(dict.fromkeys(h["node"] for h in sorted(machine.heats, key=lambda h: h["kind"] == "cutting_heat")))
        alone = not machine.circuits and all(h["kind"] in ("friction_law", "motor_loss", "heat_source") and (h["has_exponent"] or h["turning"]) for h in machine.heats)
        key, place, also = ("missing_stop", "spindle", [("heat_window", "spindle"), ("speed_override", "spindle")]) if speeds else ("heat_window", heated[0], [])
        return fault(low, high, key, place, also + [("heat_window", n) for n in heated], alone, where=[r.name], record=cut, parts=parts, columns=names_of, begin=begin, spans=lambda s: [[begin / 60, begin / 60 + s]], sizes=dict(unit="min", start_min=round(begin / 60, 4)))
    if way == "washed_down":
        r, a = pick(rng, measured), pick(rng, work if rng.random() < 0.5 else solid)
        k = int(rng.integers(int(0.15 * len(r.time_s)), int(0.85 * len(r.time_s))))
        if rng.random() < 0.6 and rest(r):      # in a pause
            k = int(np.searchsorted(r.time_s, pick(rng, rest(r))[0]))
        end = min(len(r.time_s) - 1, max(k + 1, int(np.searchsorted(r.time_s, r.time_s[k] + tau(0.008, 0.04)))))
        warm, names_of = float(round(uniform(8, 45), 1)), hidden(2)
        if k >= end or abs(warm - np.mean(of_body(a, [r]))) < 4:
            raise Impossible
        on = lambda x: (x.name == r.name) * (x.time_s >= r.time_s[k]) * (x.time_s < r.time_s[end]) * 1.0
        hide(records, names_of[0], "1", on)
        hide(records, names_of[1], "W", lambda x: on(x) * (warm - x.hall))
        return fault(0.05 * g, 60 * g, "exchange_window", a + ",hall", [(x, a) for x in ["heat_window", "coolant"] + FILM] + [("link", a + ",hall")], where=[r.name], at=[a], windows=[(float(r.time_s[k]), float(r.time_s[end]))], columns=names_of, node=a,
                     parts=lambda f, m, numbers, r: [column(f, "opening", a), column(f, "gain", a, 1)], sizes=dict(unit="W/K", water_degC=warm))
    if way == "tank_refilled":
        a, r = pick(rng, [b for b in FLUID.get(machine.family, []) if b in solid]), pick(rng, measured)
        begin, lasts = float(round(uniform(0.1, 0.8) * r.time_s[-1])), float(round(max(60.0, tau(0.002, 0.01))))

        def parts(f, m, numbers, r):
            out = Fault("heat_window", dict(what="heat", node=a), f.records, windows=f.own_windows)
            out.size = f.size * numbers["C " + a] / lasts
            return [out]
        return fault(0.1, 40, "heat_window", a, [("mass_change", a), ("exchange_window", a + ",hall"), ("coolant", a)], True, where=[r.name], sign=-1.0 if rng.random() < 0.75 else 1.0, windows=[(begin, begin + lasts)], at=[a], parts=parts, node=a, sizes=dict(unit="K"))
    if way == "rezeroed":
        r = pick(rng, measured)
        pauses = [a for a, _ in rest(r) if 0.08 * r.time_s[-1] < a < 0.9 * r.time_s[-1]]
        if not channels or not pauses:
            raise Impossible
        times = np.sort(rng.choice(pauses, min(len(pauses), int(rng.integers(1, 4))), replace=False))

        def reads(f, seen):
            for k in np.searchsorted(seen.t, times - 1e-6):
                seen.displacements[:, k:] -= f.size[:, None, None] * seen.displacements[:, k:k + 1]
        return fault(0.02, 1.6, "mount_shift", channels[0], [("mount_shift", c) for c in channels[1:]], True, where=[r.name], reads=reads, times=times, sizes=dict(times_min=[round(float(t) / 60, 4) for t in times]))
    if way == "remounted":
        k = int(rng.integers(0, len(names)))
        first, n = names[k], min(len(sensors), int(rng.integers(1, 4)))
        r = next(x for x in measured if x.name == first)
        begin = 0.0 if k > 0 and rng.random() < 0.5 else float(round(uniform(0.12, 0.75) * r.time_s[-1]))
        if n == 0:
            raise Impossible
        moved = [machine.sensors[int(i)] for i in rng.choice(len(sensors), n, replace=False)]
        others = ["hall" if rng.random() < 0.3 else pick(rng, beside(machine, b)) for _, b in moved]

        def reads(f, seen):
            on = seen.t >= (begin if seen.record.name == first else 0.0) - 1e-6
            for (name, _), other in zip(moved, others):
                y = seen.temperatures[:, :, seen.sensor(name)]
                y += f.size[:, None] * on * (seen.bodies[other] - y)
        also = [("sensor_place", s) for s, _ in moved[1:]] + [("sensor_detached", s) for (s, _), o in zip(moved, others) if o == "hall"]
        return fault(0.05, 0.95, "sensor_place", moved[0][0], also, begin == 0, where=names[k:] + ["holdout_1"], looks=list(others), reads=reads, moved=moved, others=others, begin=begin, sizes=dict(thermometers=[s for s, _ in moved], bodies=others, first_record=first, from_min=round(begin / 60, 4)))
    if way == "ran_by_hand":
        r = pick(rng, measured)
        long = [(a, b) for a, b in rest(r) if b - a > 0.02 * r.time_s[-1]]
        if not speeds or not long:
            raise Impossible
        a, b = pick(rng, long)
        rows = r.time_s[(r.time_s >= a) & (r.time_s <= b)]
        i = int(rng.integers(0, max(1, len(rows) // 3)))
        if len(rows) < 4:
            raise Impossible
        begin, end = float(rows[i]), float(rows[max(i + 1, int(len(rows) * uniform(0.6, 0.99)))])
        turns = lambda r, s: Record(r.name, r.time_s, np.where((r.time_s >= begin - 1e-6) & (r.time_s < end - 1e-6), s * plan["top"], r.speed), r.feeds, r.power, r.hall, r.columns)
        driven = list(dict.fromkeys(machine.heats[k]["node"] for k in sorted(speeds, key=lambda k: -value(f"P {k}"))))
        return fault(0.05, 1.0, "heat_window", driven[0], [("heat_window", n) for n in driven[1:] + ["spindle"]] + [("speed_override", "spindle")] + [("heat_source", n) for n in driven], not any(machine.heats[k]["has_decay"] for k in speeds), where=[r.name], windows=[(begin, end)], record=turns,
                     sizes=dict(unit="of the top speed"))
    raise ValueError(way)


def told_alike(way, fault, machine, plan, records, judge, scale):
    """As in eighth_faults.py, at the bodies that the fault names."""
    at = fault.data["at"]
    others = seventh_faults.candidates(Fault("heat_on_two", dict(nodes=at), fault.records, windows=fault.own_windows, all_windows=fault.every), machine, plan, records)
    g = 0.2 * typical_link(machine)
    for i, a in enumerate(at):
        for b in at[i + 1:]:
            others += [(x, f"{a},{b}", Fault("link", dict(a=a, b=b)).with_size(g)) for x in ("link", "contact")]
    d, out = judge.deviation([fault], 1), []
    for effect, where, other in others:
        beside_it = judge.deviation([other], 1)[0]
        if np.isfinite(beside_it).all() and np.linalg.norm(beside_it) > 1e-6 and scale * judge.nats(d, beside_it)[0] < eighth_faults.LEAST_NATS:
            out.append((effect, where))
    return out


def told(way, hidden, machine, records, worth, alike):
    """The entries of truth.json. `parameters` is empty but where the grammar has one number for what is hidden; `sizes` says what is true."""
    out = []
    for k, (f, w) in enumerate(zip(hidden, worth)):
        d, s = f.data, float(f.size[0])
        e = dict(key=d["key"], where=d["place"], parameters=[dict(name=n, value=s, unit=u) for n, u in d.get("parameters", [])], sizes=dict(size=s, **{n: x for n, x in d["sizes"].items() if x is not None}), records=f.records or "all", nats=round(float(w), 2))
        known = [(d["key"], d["place"])]
        known += [x for i, x in enumerate(d["also"]) if x not in known and x not in d["also"][:i]]
        bare = lambda x: (x[0], x[1].replace(",hall", ""))
        fresh = [x for x in dict.fromkeys(alike[k]) if bare(x) not in [bare(y) for y in known]] if alike else []
        e.update(way=d["way"], group=GROUP[d["way"]], sayable=d["sayable"], also=[dict(effect=x, where=y) for x, y in known[1:] + fresh], also_as_data_cannot_tell=[list(x) for x in fresh])
        if "spans" in d or f.own_windows is not None:
            e["windows_min"] = d["spans"](s) if "spans" in d else [[a / 60, b / 60] for a, b in f.own_windows]
        out.append(e)
    return out
