"""What is hidden in the set `tenth`: what usually is wrong with a thermal model of a machine when it meets records from the shop (README.md).

WEIGHTS is how often, of a hundred or so, the author expects each to be what is wrong, from what he knows of shops and of the literature on thermal errors (unknown heat sources and boundary conditions come first
there; then parts and joints that were left out, then what the displacement is measured against, then the drive that was another one than the record says). It was chosen before the ways were written,
and by no look at what the catalogue can say. The laws are those of things: a chiller has a tank, a compressor and a hysteresis; a pump has its own case; a cover has air on its outer side; a lid bares several bodies at once.
"""
import copy

import numpy as np

import eighth_faults
import fifth_faults
import third_faults
from eighth_faults import HIDDEN, all_temperatures, beside, restructured, runs
from faults import Fault, Impossible, largest_heat, pick, scope, typical_link
from ninth_faults import feedback
from seventh_faults import hide
from tenth_families import WORK

WEIGHTS = dict(
    heat_left_out=12,             # drive electronics, a pump, a seal, a gearbox, a nut: a heat that nobody put in, often in a case of its own
    body_left_out=10,             # a cover, a tank, a fixture, a motor's body that the model lacks
    joint_left_out=9,             # two bodies touch, or are bolted or piped together, and the model has no path there
    follows_another=8,            # the displacement is measured against a gauge's holder, the bed, the column, which warm, too
    chiller_set_point=6,          # the chiller is set to another temperature than the data sheet says
    door_open=6,                  # a door, a lid, a guard is open for a while
    thermometer_elsewhere=6,      # it sits nearer to the neighbour, or in a stream of air
    friction_another_law=6,       # friction goes with speed otherwise, or the grease thins as it warms
    stands_on_floor=5,            # the machine's feet, or a tank's, conduct into a slow floor
    standby_heat=5,               # drives and pumps that warm while nothing moves, until the control switches them off
    recorded_not_used=5,          # the sun, a heater column, an air supply, an extraction: somebody recorded it and the model does not use it
    guard_left_out=5,             # several bodies are in a guard's air and not in the hall's
    warm_up_unrecorded=5,         # the machine had been run before somebody began to write
    cuts_in_and_out=5,            # a heater, a fan or a chiller that goes by a thermostat
    part_clamped=4,               # a part, a pallet, a fixture as warm as the hall is put on the table
    cooling_off=4,                # the circuit, or a fan, is off for a while, or passes less
    second_shift=4,               # in one shift something else runs: a neighbour, a compressor, another station
    speed_overridden=4,           # the override knob had another position
    stop_unrecorded=3,            # the spindle stopped, but the commanded speed does not show it
    splash=3)                     # coolant, oil mist or chips wash a body while the machine works
WAYS_A = list(WEIGHTS)
MOST = 4      # cases of one way
UNSAYABLE = {"friction_another_law", "standby_heat", "warm_up_unrecorded", "cuts_in_and_out", "cooling_off", "splash"}
KINDS_C = eighth_faults.KINDS_C
NEW_C = []
NOT_STEADY = {"cuts_in_and_out", "cooling_off", "splash"}      # a machine at rest for long before would have another state
MOST_NATS = 400


class Any(dict):
    """One to four records, whatever is hidden."""

    def __contains__(self, way):
        return True

    def __getitem__(self, way):
        return [1, 1, 2, 2, 3, 3, 4]


N_RECORDS = Any()

# key of truth.json and further names that count as right at the same place; `parameters` is empty and `sizes` says how large it is
FILM = ["convection", "contact"]
NAMES = dict(heat_left_out=("heat_source", []), body_left_out=("hidden_body", ["heat_capacity"]), door_open=("exchange_window", []), friction_another_law=("friction_law", ["heat_source"]),
             stands_on_floor=("link", FILM + ["coolant", "radiation", "hidden_body"]), standby_heat=("heat_source", ["heat_window"]), recorded_not_used=("recorded_drive", []), warm_up_unrecorded=("heat_window", ["heat_source"]),
             cuts_in_and_out=(None, []), part_clamped=("mass_change", ["hidden_body", "heat_capacity", "exchange_window", "heat_window"]), cooling_off=(None, []), second_shift=("heat_window", ["heat_source"]),
             speed_overridden=("speed_override", ["heat_window"]), stop_unrecorded=("missing_stop", ["heat_window", "speed_override"]), splash=("coolant", FILM + ["exchange_window", "forced_convection"]))


def bounded(low, high):
    if high < 10 * low:
        raise Impossible
    return low, high


def thermostat(state, T, k, low, high):
    """1 from where it is warmer than `high` until it is colder than `low`; it is looked at once in each step."""
    if state.get("k") != k:
        state["on"] = np.where(T > high, 1.0, np.where(T < low, 0.0, state.get("on", np.zeros_like(T))))
        state["k"] = k
    return state["on"]


def draw(rng, way, machine, plan, records, column, noise):
    """The faults that this way of being wrong consists of; some put columns into `records` that no file has."""
    if way not in WEIGHTS:
        return fifth_faults.draw(rng, way, machine, plan, records, column)
    measured = [r for r in records if r.name != "holdout_1"]
    names = [r.name for r in measured]
    shortest = min(r.time_s[-1] for r in records)
    sign = 1.0 if rng.random() < 0.5 else -1.0
    watts, g = largest_heat(machine, plan), typical_link(machine)
    speeds = [i for i, h in enumerate(machine.heats) if h["has_exponent"] and h["kind"] not in ("servo_loss", "cutting_heat")]      # heats that follow the speed
    channels, sensors = [d[0] for d in machine.displacements], [n for n, _ in machine.sensors]
    value, solid = lambda k: machine.numbers[k][0], [b for b in machine.bodies if b not in machine.air]
    tau = lambda low=0.01, high=0.15: float(shortest * np.exp(rng.uniform(np.log(low), np.log(high))))
    steady = lambda body, slope: 0.7 * value("C " + body) / machine.longest_step_s / slope      # the size up to which steps of network.py bear it

    def gain(node, low=0.01, high=4, sign=1.0, **more):
        return [Fault("recorded_drive", dict(node=node, column=HIDDEN, mode="gain", **more), None, low * watts, high * watts, sign)]

    def of_body(body, rs=measured):
        i = machine.bodies.index(body)
        return np.concatenate([x[:, i] for x in all_temperatures(machine, rs)])
    if way == "heat_left_out":
        a, e = pick(rng, solid), float(round(rng.uniform(0.8, 2.0), 2))
        law = pick(rng, ["constant"] + (["turning", "power", "power"] if speeds else []) + (["feed"] * 2 if plan.get("feeds") else []) + (["load"] if "power" in plan else []))
        axis = pick(rng, sorted(plan["feeds"])) if law == "feed" else None
        cased = rng.random() < 0.4
        c = value("C " + a) * np.exp(rng.uniform(np.log(0.08), np.log(0.6)))
        ga = c / tau(0.01, 0.1)
        heat = dict(constant=dict(kind="heat_source", at=1.0), turning=dict(kind="heat_source", at=1.0, turning=True), power=dict(kind="heat_source", at=float(plan.get("top", 1)), has_exponent=True), feed=dict(kind="servo_loss", at=plan["feeds"][axis] / 60000 if axis else 1.0, has_exponent=True, axis=axis),
                    load=dict(kind="cutting_heat", at=1.0))[law]

        def more(m, numbers, s):
            i = len(m.heats)
            if cased:
                m.bodies.append("left_out")
                m.links.append(("left_out", a))
                numbers.update({"C left_out": np.full_like(s, c), f"G left_out {a}": np.full_like(s, ga)})
            m.heats.append({**dict(node="left_out" if cased else a, axis=None, turning=False, has_exponent=False, has_idle=False, has_decay=False), **heat})
            numbers[f"P {i}"] = s * watts / (plan["power"] if law == "load" else 1.0)
            if heat.get("has_exponent"):
                numbers[f"e {i}"] = np.full_like(s, e)
        return restructured(more, 0.01, 3, node=a, law=law, axis=axis, exponent=e, cased=cased, case_capacity=c if cased else None, watts=watts)
    if way == "body_left_out":
        a = pick(rng, solid)
        c = value("C " + a) * np.exp(rng.uniform(np.log(0.15), np.log(2)))
        ga = c / tau(0.01, 0.2)
        gh, behind = ga * rng.uniform(0.05, 0.4) if rng.random() < 0.6 else 0.0, rng.random() < 0.3
        c2, g2 = c * rng.uniform(0.3, 1.2), ga * rng.uniform(0.3, 1.0)

        def body(m, numbers, s):
            m.bodies.append("left_out")
            m.links.append(("left_out", a))
            numbers.update({"C left_out": np.maximum(s * c, 1e-3), f"G left_out {a}": s * ga})
            last = "left_out"
            if behind:
                last = "left_out_behind"
                m.bodies.append(last)
                m.links.append((last, "left_out"))
                numbers.update({"C left_out_behind": np.maximum(s * c2, 1e-3), "G left_out_behind left_out": s * g2})
            if gh > 0:
                m.links.append((last, "hall"))
                numbers[f"G {last} hall"] = s * gh
        return restructured(body, 0.02, 6, node=a, capacity=c, conductance=ga, to_hall=gh, second_capacity=c2 if behind else 0.0)
    if way == "joint_left_out":      # between two parts; a part that the hall does not touch in the model may touch it
        a = pick(rng, solid)
        taken = {frozenset(x) for x in machine.links}
        free = [x for x in solid if x != a and frozenset((a, x)) not in taken]
        near = [x for x in free if any({a, y} in taken and {x, y} in taken for y in machine.bodies)]      # what is bolted to the same part
        if rng.random() < 0.25:
            near = [] if frozenset((a, "hall")) in taken else ["hall"]
        b = pick(rng, near if rng.random() < 0.75 else near or free)
        return [Fault("link", dict(a=a, b=b, nodes=[a, b] if b != "hall" else [a]), None, 0.01 * g, 6 * g)]
    if way == "follows_another":
        name, _, used = pick(rng, machine.displacements)
        node = pick(rng, [b for b in solid if b not in used] + ["hall"])
        return [Fault("displacement_path", dict(channel=name, node=node, lag_min=float(round(tau(0.01, 0.12) / 60, 1)) if rng.random() < 0.5 else 0.0), None, 0.03, 20, sign)]
    if way == "chiller_set_point":
        node, _ = pick(rng, machine.circuits)
        return [Fault("coolant", dict(node=node, what="set_point"), scope(rng, records, ["all", "all", "one", "from"]), 0.3, 9, sign)]
    if way == "door_open":
        k = min(len(solid), int(rng.integers(2, 4)))
        nodes = [solid[int(i)] for i in rng.choice(len(solid), k, replace=False)]
        return [Fault(way, dict(nodes=nodes, shares=[1.0] + [float(x) for x in np.round(rng.uniform(0.3, 1, k - 1), 2)]), low=0.01 * g, high=12 * g, **fifth_faults.happened(rng, records))]
    if way == "thermometer_elsewhere":
        sensor, body = pick(rng, machine.sensors)
        if rng.random() < 0.6:
            return [Fault("sensor_place", dict(sensor=sensor, other=pick(rng, beside(machine, body))), None, 0.03, 0.95)]
        hide(records, "1", lambda r: runs(machine, r))
        return [Fault("in_stream", dict(sensor=sensor, blows=HIDDEN, at_rest=float(round(rng.uniform(0.2, 0.7), 2))), None, 0.01, 0.9)]
    if way == "friction_another_law":
        i = pick(rng, [i for i in speeds if machine.heats[i]["kind"] != "motor_loss"] or speeds)
        h, p, e = machine.heats[i], value(f"P {i}"), value(f"e {i}")
        if rng.random() < 0.55:      # a part of it is not viscous, or is churning
            other = float(round(e + rng.uniform(0.6, 1.5) if sign > 0 else max(0.05, e - rng.uniform(0.5, 1.2)), 2))
            x = lambda r: np.where(r.speed > 0, np.maximum(r.speed, 1e-9) / h["at"], 0.0)
            hide(records, "W", lambda r: np.where(r.speed > 0, x(r) ** other - x(r) ** e, 0.0), must_move=False)
            if not any(np.ptp(r.columns[HIDDEN][1]) > 0.05 for r in measured):
                raise Impossible
            return [Fault("recorded_drive", dict(node=h["node"], column=HIDDEN, mode="gain", law="mixed", other_exponent=other), None, 0.02 * p, 1.0 * p)]
        cold = 1 / (machine.t_ref + 95)

        def thins(s, numbers, m):
            p, e = numbers[f"P {i}"], numbers[f"e {i}"]
            decay = numbers[f"decay {i}"] if h["has_decay"] else 0 * p

            def make(index, record, row, speed, hall):
                k = index[h["node"]]
                friction = np.where(speed > 0, p[:, None] * (np.maximum(speed, 1e-9) / h["at"]) ** e[:, None], 0.0)
                return lambda T, n: [(k, friction[:, n] * np.exp(-decay * (T[:, k] - m.t_ref)) * (np.exp(s * (1 / (np.maximum(T[:, k], -40) + 95) - cold)) - 1))]
            return make
        return feedback(thins, 20, 1100, node=h["node"], law="thins")
    if way == "stands_on_floor":
        heavy = sorted(solid, key=lambda b: -value("C " + b))[:max(2, (len(solid) + 1) // 2)]
        a, warm, slow = pick(rng, heavy), float(round(rng.uniform(11, 24), 1)), rng.uniform(0.3, 1.0)
        if min(abs(warm - np.mean(r.hall)) for r in measured) < 2:
            raise Impossible
        hide(records, "degC", lambda r: warm + rng.normal(0, 0.5) + slow * r.time_s / r.time_s[-1], must_move=False)
        return [Fault("recorded_drive", dict(node=a, column=HIDDEN, mode="conductance", about_degC=warm), None, 0.01 * g, 6 * g)]
    if way == "standby_heat":
        off = tau(0.05, 0.3)

        def standby(r):
            on, rested, out = np.asarray(runs(machine, r), bool), 0.0, np.ones(len(r.time_s))
            for k in range(1, len(out)):
                rested = 0.0 if on[k] else rested + r.time_s[k] - r.time_s[k - 1]
                out[k] = rested < off
            return out
        hide(records, "W", standby, must_move=False)
        axes = [h["node"] for h in machine.heats if h["kind"] in ("servo_loss", "motor_loss")]
        return gain(pick(rng, axes) if axes and rng.random() < 0.6 else pick(rng, solid), 0.01, 3, off_after_min=round(off / 60, 2))
    if way == "recorded_not_used":
        if not column or column[1] == "percent":
            raise Impossible
        a, top = pick(rng, solid), max(np.max(r.columns[column[0]][1]) for r in records)
        if column[1] in ("degC", "1"):
            mode = "conductance" if column[1] == "degC" else "opening"
            return [Fault("recorded_drive", dict(node=a, column=column[0], unit=column[1], mode=mode, nodes=[a], shares=[1.0]), None, 0.01 * g, 6 * g)]
        if rng.random() < 0.35 and len(solid) > 1:      # it shines on two
            pair, share = [solid[int(i)] for i in rng.choice(len(solid), 2, replace=False)], float(np.round(rng.uniform(0.5, 0.85), 2))
            return [Fault("column_on_two", dict(nodes=pair, shares=[share, 1 - share], column=column[0], unit=column[1]), None, 0.01 * watts / top, 4 * watts / top)]
        return [Fault("recorded_drive", dict(node=a, column=column[0], unit=column[1], mode="gain", nodes=[a], shares=[1.0]), None, 0.01 * watts / top, 4 * watts / top)]
    if way == "guard_left_out":
        return eighth_faults.draw(rng, "cabin_forgotten", machine, plan, records, column, noise)
    if way == "warm_up_unrecorded":
        r = pick(rng, measured)
        m = copy.copy(machine)
        m.start = "hall"
        t = all_temperatures(m, [r])[0]
        rise = t[int(rng.uniform(0.3, 0.8) * len(t))] - t[0]      # as the same drive would have warmed it
        if rise.max() < 1:
            raise Impossible
        shares = np.round(np.maximum(rise, 0) / rise.max(), 3)
        order = [b for _, b in sorted(zip(-shares, machine.bodies)) if shares[machine.bodies.index(b)] >= 0.3]
        return [Fault("ran_before", dict(nodes=list(machine.bodies), shares=[float(x) for x in shares], warm=order), [r.name], 0.1, 40)]
    if way == "cuts_in_and_out":
        kind = pick(rng, ["heater", "fan"] + ["chiller"] * 4 * bool(machine.circuits))
        if kind == "chiller":      # its tank: the compressor runs from set point + s until set point - s
            node, warm = pick(rng, machine.circuits)
            stream = value("flow " + node) / 60 * 3800
            ga = stream * (1 - np.exp(-value("passage " + node) / stream))
            load = ga * np.maximum(of_body(node) - warm, 0)
            if np.mean(load) < 0.05 * watts or np.mean(load > 0) < 0.6:
                raise Impossible
            c, power = float(np.mean(load)) * tau(0.03, 0.12) / 2, 1.6 * float(np.max(load))

            def chiller(m, numbers, s):
                m.circuits.remove((node, warm))
                m.bodies.append("chiller_tank")
                m.links.append(("chiller_tank", node))
                stream = numbers["flow " + node] / 60 * 3800
                numbers.update({"C chiller_tank": np.full_like(s, c), f"G chiller_tank {node}": stream * (1 - np.exp(-numbers["passage " + node] / stream))})

                def make(index, record, row, speed, hall):
                    state, i = {}, index["chiller_tank"]
                    h = record.time_s[1] / np.ceil(record.time_s[1] / machine.longest_step_s)      # within the first step the tank, which had been cooled before, comes to its set point

                    def q(T, k):
                        if k == 0:
                            state.setdefault("first", T[:, i].copy())
                            return [(i, c * (warm - state["first"]) / h)]
                        return [(i, -power * thermostat(state, T[:, i], k, warm - s, warm + s))]
                    return q
                m.feedback = [make]
            return restructured(chiller, 0.1, 7, node=node, kind=kind, tank_J_K=c, compressor_W=power)
        b = pick(rng, solid)
        t = of_body(b)
        span = np.ptp(t)
        if span < 2:
            raise Impossible
        at, half = float(round(np.min(t) + rng.uniform(0.25, 0.6) * span, 2)), float(round(max(0.4, rng.uniform(0.05, 0.15) * span), 2))

        def switched(s, numbers, m):
            def make(index, record, row, speed, hall):
                state, i = {}, index[b]
                if kind == "heater":
                    return lambda T, k: [(i, s * (1 - thermostat(state, T[:, i], k, at - half, at + half)))]
                return lambda T, k: [(i, -s * thermostat(state, T[:, i], k, at - half, at + half) * (T[:, i] - hall[:, k]))]
            return make
        low, high = (0.01 * watts, 2 * watts) if kind == "heater" else bounded(0.01 * g, min(8 * g, steady(b, 2)))
        return feedback(switched, low, high, node=b, kind=kind, about_degC=at, half_band_K=half)
    if way == "part_clamped":
        node = pick(rng, [b for b in WORK[machine.family] if b in machine.bodies])
        c = value("C " + node) * np.exp(rng.uniform(np.log(0.1), np.log(1.2)))
        if rng.random() < 0.5:      # one part, in one record, for a while or until its end
            begin = rng.uniform(0.1, 0.6) * shortest
            end = begin + rng.uniform(0.1, 0.4) * shortest if rng.random() < 0.5 else 1.01 * max(r.time_s[-1] for r in records)
            return [Fault("mass_change", dict(node=node, capacity=c, conductance=c / tau(0.01, 0.1)), [pick(rng, names)], 0.02, 6, windows=[(float(round(begin)), float(round(end)))])]
        period = rng.uniform(0.08, 0.25) * shortest      # one after another
        return [Fault("mass_change", dict(node=node, capacity=c, conductance=c / (period * np.exp(rng.uniform(np.log(0.1), np.log(1.0))))), None, 0.02, 6, all_windows=(float(round(period)), float(round(rng.uniform(0.1, 0.9) * period)), float(round(rng.uniform(0.35, 0.75) * period))))]
    if way == "cooling_off":
        r = pick(rng, measured)
        a, b = rng.uniform(0.1, 0.55), 0.0
        b = a + rng.uniform(0.1, 0.35)
        off = lambda x: (x.name == r.name) & (x.time_s >= a * r.time_s[-1]) & (x.time_s < b * r.time_s[-1])
        more = dict(window_min=[round(a * r.time_s[-1] / 60, 2), round(b * r.time_s[-1] / 60, 2)])
        if machine.circuits and rng.random() < 0.75:
            node, warm = pick(rng, machine.circuits)
            hide(records, "1", off, must_move=False)
            for x in records:
                x.columns[HIDDEN + "_2"] = ("W", off(x) * (warm - x.hall))
            return [Fault("pump_rests", dict(node=node, on=HIDDEN, excess=HIDDEN + "_2", what="circuit", **more), [r.name], 0.05, 0.97)]
        heated = {h["node"] for h in machine.heats}
        node = pick(rng, [x for x, y in machine.links if y == "hall" and x in heated])
        hide(records, "1", off, must_move=False)
        return [Fault("filter_clogs", dict(node=node, column=HIDDEN, what="fan", **more), [r.name], 0.05, 0.95)]
    if way == "second_shift":
        blocks = {}
        for r in records:
            a = rng.uniform(0.0, 0.6)
            blocks[r.name] = (a, a + rng.uniform(0.25, 0.45))
        pause = rng.uniform(0.15, 0.85)      # somebody has a break in it, too

        def shift(r):
            x, (a, b) = r.time_s / r.time_s[-1], blocks[r.name]
            return (x >= a) & (x < b) & ~((x >= a + pause * (b - a)) & (x < a + pause * (b - a) + 0.03))
        hide(records, "W", shift)
        return gain(pick(rng, solid), 0.01, 3, shifts_min={r.name: [round(x * r.time_s[-1] / 60, 2) for x in blocks[r.name]] for r in records})
    if way == "speed_overridden":
        if not speeds:
            raise Impossible
        r = pick(rng, measured)
        if rng.random() < 0.4:
            return [Fault("speed_override", {}, None if len(names) == 1 or rng.random() < 0.3 else [r.name], 0.05, 0.7, sign)]
        a = rng.uniform(0.05, 0.5)
        window = (float(round(a * r.time_s[-1])), float(round((a + rng.uniform(0.15, 0.45)) * r.time_s[-1])))
        return [Fault("heat_window", dict(what="speed"), [r.name], 0.05, 0.9, sign, windows=[window])]
    if way == "stop_unrecorded":
        r = pick(rng, measured)
        turning = r.time_s[(r.speed > 0) & (r.time_s > 0.06 * r.time_s[-1]) & (r.time_s < 0.85 * r.time_s[-1])]
        if len(turning) < 20 or not speeds:
            raise Impossible
        starts = np.sort(rng.choice(turning, int(rng.integers(1, 3)), replace=False))
        gap = float(np.min(np.diff(np.append(starts, r.time_s[-1]))))
        low, high = max(0.3 * float(np.median(np.diff(r.time_s))), 0.001 * r.time_s[-1]) / 60, min(0.9 * gap, 0.12 * r.time_s[-1]) / 60
        if high < 4 * low:
            raise Impossible
        return [Fault("many_stops", dict(starts_s=[float(x) for x in starts]), [r.name], low, high)]
    if way == "splash":
        node, warm, rises = pick(rng, solid), float(round(rng.uniform(15, 32), 1)), rng.uniform(0, 4)
        on = lambda r: np.asarray(runs(machine, r), float)
        tank = lambda r: warm + rises * (1 - np.exp(-2 * r.time_s / r.time_s[-1]))
        if min(abs(np.mean(tank(r)) - np.mean(of_body(node, [r]))) for r in measured) < 2:
            raise Impossible
        hide(records, "1", on)
        for r in records:
            r.columns[HIDDEN + "_2"] = ("W", on(r) * (tank(r) - r.hall))
        return [Fault(way, dict(node=node, on=HIDDEN, excess=HIDDEN + "_2", tank_degC=warm, tank_rises_K=round(rises, 2)), None, 0.01 * g, 8 * g)]
    raise ValueError(way)


def told_alike(way, fault, machine, plan, records, judge, scale):
    """As in eighth_faults.py; of what warms or cools several bodies all those that the table names are tried."""
    if way == "warm_up_unrecorded":
        fault = copy.copy(fault)
        proxy = dict(fault.data, nodes=fault.data["warm"])
        others, d, out = eighth_faults.seventh_faults.candidates(Fault("heat_on_two", proxy, fault.records), machine, plan, records), judge.deviation([fault], 1), []
        for effect, where, other in others:
            beside_it = judge.deviation([other], 1)[0]
            if np.isfinite(beside_it).all() and np.linalg.norm(beside_it) > 1e-6 and scale * judge.nats(d, beside_it)[0] < eighth_faults.LEAST_NATS:
                out.append((effect, where))
        return out
    return eighth_faults.told_alike("cabin_forgotten" if way == "guard_left_out" else way, fault, machine, plan, records, judge, scale)


def told(way, hidden, machine, records, worth, alike):
    """The entries of truth.json. `parameters` of what has a law of its own is empty, and `sizes` says how large it is: no interval is judged by it."""
    f = hidden[0] if hidden else None
    if way not in NAMES or not hidden:
        kind = "sensor_moved_air" if way == "thermometer_elsewhere" and f.key == "in_stream" else "cabin_forgotten" if way == "guard_left_out" else way
        if kind != "sensor_moved_air":
            out = eighth_faults.told(kind, hidden, machine, records, worth, alike)
            for e in out:
                e["sayable"] = True
            return out
    d, (key, further) = f.data, NAMES.get(way, ("sensor_place", ["sensor_detached"]))
    words = ("sensor", "column", "mode", "change", "on", "excess", "blows", "channel", "starts_s", "nodes", "unit")
    sizes = dict(size=float(f.size[0]), **{k: x for k, x in d.items() if k not in words and x is not None})
    nodes = d.get("nodes") or [d[k] for k in ("node",) if k in d]
    film = lambda names, at: [(x, a) for a in at for x in names] + [("link", a + ",hall") for a in at]
    sayable, also = way not in UNSAYABLE, []
    measured = sorted({r.name for r in records} - {"holdout_1"})
    if way == "thermometer_elsewhere":
        where, also, sayable = d["sensor"], [(x, d["sensor"]) for x in further], False
    elif way == "heat_left_out":
        where = d["node"]
        if d["law"] in ("feed", "load"):      # what it follows is recorded
            also.append(("recorded_drive", where))
        if d["law"] in ("power", "feed") and any(h["node"] == where and h["has_exponent"] and (h["kind"] == "servo_loss") == (d["law"] == "feed") for h in machine.heats):
            also.append(("friction_law", where))
        if d["cased"]:
            also.append(("hidden_body", where))
    elif way == "door_open":
        where, also = nodes[0] + ",hall", [(key, a + ",hall") for a in nodes]
        also += film(FILM, nodes) if f.every is None and len(f.own_windows) == 1 else []
    elif way == "stands_on_floor":
        where, also = nodes[0] + ",hall", film(further, nodes)
    elif way == "recorded_not_used":
        where, also = nodes[0], [(key, a) for a in nodes]
        if d["unit"] == "1":
            also.append(("exchange_window", nodes[0]))
        if d["unit"] == "W_m2":
            also += [("radiation", a) for a in nodes]
    elif way == "warm_up_unrecorded":
        where, also = d["warm"][0], [(k, n) for n in d["warm"] for k in [key] + further] + ([("run_state", ",".join(f.records))] if len(measured) > 1 else [])
    elif way == "cuts_in_and_out":
        where = nodes[0]
        if d["kind"] == "chiller":
            key, also = "coolant", [("heat_window", where), ("heat_source", where)]
        elif d["kind"] == "heater":
            key, also = "heat_source", [("heat_window", where)]
        else:
            key, also = "exchange_window", film(FILM + ["forced_convection", "coolant"], nodes)
    elif way == "cooling_off":
        where = nodes[0]
        if d["what"] == "circuit":
            key, also = "coolant", film(FILM + ["exchange_window", "forced_convection"], nodes) + [("heat_window", where)]
        else:
            key, also = "convection", film(["contact", "exchange_window", "forced_convection"], nodes)
    elif way in ("speed_overridden", "stop_unrecorded"):
        where, also = "spindle", [(x, "spindle") for x in further]
        driven = sorted({h["node"] for h in machine.heats if h["has_exponent"] and h["kind"] not in ("servo_loss", "cutting_heat")})
        if way == "speed_overridden" and len(driven) == 1:
            also += [(x, driven[0]) for x in ("heat_source", "friction_law")]
        if f.key == "speed_override" and f.records:
            also.append(("run_state", ",".join(f.records)))
    elif way == "splash":
        where, also = nodes[0], film([x for x in further if x != "link"], nodes)
    else:
        where = nodes[0]
        also = [(x, where) for x in further]
        if way == "second_shift":
            sayable = len(measured) == 1
    also = [x for i, x in enumerate(also) if x != (key, where) and x not in also[:i]]
    e = dict(key=key, where=where, parameters=[], sizes=sizes, records=f.records or "all", nats=round(float(worth[0]), 2), also=[dict(effect=x, where=y) for x, y in also], sayable=sayable)
    if way == "stop_unrecorded":
        e["windows_min"] = [[t / 60, t / 60 + float(f.size[0])] for t in d["starts_s"]]
    elif f.own_windows is not None or f.every is not None:
        e["windows_min"] = [[a / 60, b / 60] for a, b in (f.own_windows if f.every is None else f.windows(records[0]))]
    for others in alike:
        known = {(key, where)} | set(also)
        fresh = [x for i, x in enumerate(others) if x not in known and x not in others[:i]]
        e["also"] += [dict(effect=x, where=y) for x, y in fresh]
        e["also_as_data_cannot_tell"] = [list(x) for x in fresh]
    return [e]
