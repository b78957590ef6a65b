"""What is hidden in the set `twelfth`: what the literature says thermal models of machine tools, and experiments with them, usually lack (README.md, which names the sources).

Each way is one fault with one size, with its law in `change`, `parts`, `record`, `reads` (eleventh_network.py) or `before` (twelfth_network.py), and is described as in eleventh_faults.py. The laws are those of things and not of the catalogue.
"""
import numpy as np

import eleventh_faults
import fifth_faults
from eighth_faults import all_temperatures, beside, runs
from eleventh_faults import FILM, begins, column, heat, hide, late, told, told_alike      # the last two for the driver of `eighth`
from faults import Impossible, Fault, largest_heat, pick, typical_link
from network import Record
from ninth_faults import stretches
from seventh_network import part
from sixth_faults import HIDDEN
from twelfth_families import BED, HIGH, INSIDE, WORK

WEIGHTS = dict(      # cases of class A of each way, the more the more ordinary it is
    body=dict(hydraulic_unit=2,            # a hydraulic unit with its own loss is mounted on the machine and feeds another part
              foundation=1,                # the bed is on concrete, and the concrete on the ground
              workpieces=2),               # a workpiece is clamped, as warm as the store, and changed in each pause
    exchange=dict(enclosure_air=1,         # air in an enclosure, warmed while the machine runs, let out as its door opens
                  air_over_height=1,       # the air is the warmer the higher, and the more so at some hours of the day
                  cutting_fluid=2,         # cutting fluid flows in some programmes and not in others
                  joint_tightens=1,        # a fit becomes tighter, or looser, as what is inside is warmer than what is outside
                  surface_turns=1,         # the film of what turns grows with speed
                  chiller_follows_room=1), # a chiller's set point follows the room
    input=dict(preload_rises=1,            # a bearing's preload, and so its friction, rises as it is warmer than its housing
               oil_thins=1,                # friction falls with the oil's viscosity
               motor_enabled=1,            # a motor that is switched on has a loss at rest, too
               nut_friction=2,             # nuts and guideways rub, and the model has the axis's motor alone
               sun_on_part=1),             # the sun shines through a window, and clouds pass
    path=dict(bracket_grows=2,             # an indicator's bracket expands
              thermometer_loose=1,         # a thermometer has poor contact
              shaft_stretches=2),          # the rotor grows, as no body of the model does
    event=dict(door_opened=2,              # the hall's door was open
               warm_before=1,              # the machine had run before the record begins
               override_turned=2))         # the spindle's override was turned down
GROUPS = {g: list(ways) for g, ways in WEIGHTS.items()}
GROUP = {w: g for g, ways in GROUPS.items() for w in ways}
WAYS_A = list(GROUP)
NOT_STEADY = {"air_over_height", "chiller_follows_room"}      # a machine at rest for long before would have another state
STEADY = {"foundation"}                # else concrete would begin as warm as the air
ALONE = {"warm_before"}                # in no case of class D: another fault's times would be moved
N_RECORDS = {w: [1, 2, 2, 3, 3, 4] for w in WAYS_A + [""]}
MOST_NATS = 400
eleventh_faults.GROUP.update(GROUP)


def viscosity(T, at):
    """Of a mineral oil of VG 32, as a share of that at `at`: Vogel's law."""
    return np.exp(711 / (np.maximum(T, -40) + 95) - 711 / (at + 95))


def draw(rng, way, machine, plan, records, extra, noise):
    """The fault that this way of being wrong is; some put columns into `records` that no file has."""
    if way not in GROUP:
        return fifth_faults.draw(rng, way, machine, plan, records, extra)
    if (way in NOT_STEADY and machine.start == "steady") or (way in STEADY and machine.start != "steady"):
        raise Impossible
    measured = [r for r in records if r.name != "holdout_1"]
    shortest = min(r.time_s[-1] for r in records)
    watts, g = largest_heat(machine, plan), typical_link(machine)
    speeds = [i for i, h in enumerate(machine.heats) if h["has_exponent"] and h["kind"] not in ("servo_loss", "cutting_heat")]      # heats that follow the speed
    channels, value, solid = [d[0] for d in machine.displacements], lambda k: machine.numbers[k][0], list(machine.bodies)
    driven = list(dict.fromkeys(machine.heats[k]["node"] for k in sorted(speeds, key=lambda k: -value(f"P {k}"))))
    conductance = lambda a, b: value(f"G {a} {b}" if f"G {a} {b}" in machine.numbers else f"G {b} {a}")
    tau = lambda low=0.01, high=0.15: float(shortest * np.exp(rng.uniform(np.log(low), np.log(high))))
    uniform, log_uniform = lambda a, b: float(rng.uniform(a, b)), lambda a, b: float(np.exp(rng.uniform(np.log(a), np.log(b))))
    running = lambda r: np.asarray(runs(machine, r), float)
    films, joints = [a for a, b in machine.links if b == "hall"], [x for x in machine.links if x[1] != "hall"]
    hidden = lambda n=1: [f"{HIDDEN}_{way}_{k}" for k in range(n)]
    at_film = lambda a, more=(): [(k, a) for k in FILM + list(more)] + [("link", a + ",hall")]
    pair = lambda a, b: [("link", f"{a},{b}"), ("contact", f"{a},{b}")]

    def fault(low, high, key, place, also=(), sayable=False, where=None, sign=1.0, windows=None, **data):
        return [Fault(way, dict(dict(way=way, key=key, place=place, also=list(also), sayable=sayable, at=[], sizes={}), **data), where, low, high, sign, windows)]

    def feeds_back(make):
        """Heat that hangs on temperatures: make(machine, numbers, size, index, record, row, speed) -> (T, step) -> [(body, watts)]."""
        def change(m, numbers, s):
            m.feedback = list(getattr(m, "feedback", ())) + [lambda index, record, row, speed, hall: make(m, numbers, s, index, record, row, speed)]
        return change

    def heat_now(m, numbers, i, speed):
        """(T of its body, step) -> watts of heat `i`, which follows the speed, as the machine has it."""
        h, decay = m.heats[i], numbers[f"decay {i}"] if m.heats[i]["has_decay"] else 0.0
        q = np.where(speed > 0, numbers[f"P {i}"][:, None] * (np.where(speed > 0, speed, 1) / h["at"]) ** numbers[f"e {i}"][:, None], 0.0)
        return lambda T, k: q[:, k] * np.exp(-decay * (T - m.t_ref))
    # --- a body -------------------------------------------------------------------------------------------------------------
    if way == "hydraulic_unit":
        a = pick(rng, sorted(solid, key=lambda b: -value("C " + b))[:3])
        b = pick(rng, [x for x in solid if x != a])
        w, out, pipe, warmer = watts * uniform(0.15, 0.7), uniform(0.3, 1.2), uniform(0.1, 0.7), uniform(8, 25)      # alone it would be so much warmer than all about it
        ga = w / warmer / (1 + out + pipe)
        c = ga * tau(0.03, 0.25)

        def unit(m, numbers, s):
            m.bodies.append("hydraulic_unit")
            m.links += [("hydraulic_unit", a), ("hydraulic_unit", b), ("hydraulic_unit", "hall")]
            numbers.update({"C hydraulic_unit": np.maximum(s * c, 1e-3), f"G hydraulic_unit {a}": s * ga, f"G hydraulic_unit {b}": s * pipe * ga, "G hydraulic_unit hall": s * out * ga, f"P {len(m.heats)}": s * w})
            m.heats.append(heat("heat_source", "hydraulic_unit"))
        return fault(0.01, 8, "hidden_body", a, [("hidden_body", b)] + [(k, x) for x in (a, b) for k in ("heat_source", "heat_capacity")] + pair(a, b), True, at=[a, b], change=unit, sizes=dict(capacity=c, conductance=ga, to_the_other=pipe * ga, to_hall=out * ga, power_W=w))
    if way == "foundation":
        a = BED[machine.family]
        c, ga, ground, cold = value("C " + a) * uniform(1, 5), value(f"G {a} hall") * uniform(0.4, 2), uniform(0.2, 1), float(round(uniform(8, 16), 1))

        def concrete(m, numbers, s):
            m.bodies.append("foundation")
            m.links.append(("foundation", a))
            m.circuits.append(("foundation", cold))      # so strong a stream that it is as warm as the ground
            numbers.update({"C foundation": np.maximum(s * c, 1e-3), f"G foundation {a}": s * ga, "flow foundation": np.full_like(s, 1e5), "passage foundation": s * ground * ga})
        return fault(0.02, 6, "hidden_body", a, [("heat_capacity", a)] + at_film(a, ["coolant", "radiation"]), True, at=[a], change=concrete, sizes=dict(capacity=c, conductance=ga, to_ground=ground * ga, ground_degC=cold))
    if way == "workpieces":
        a = pick(rng, WORK[machine.family])
        c, out, other = value("C " + a) * log_uniform(0.06, 0.6), uniform(0.05, 0.3), float(round(uniform(1, 7) * (1 if rng.random() < 0.3 else -1), 1))
        ga, names_of = c / tau(0.01, 0.08), hidden(2)
        pace = lambda r: np.append(np.diff(r.time_s), r.time_s[-1] - r.time_s[-2])
        hide(records, names_of[0], "1", lambda r: begins(running(r) == 0) * np.round(5 * c / pace(r), 3))      # within a row the new one takes the place of the old one
        hide(records, names_of[1], "W", lambda r: other * r.columns[names_of[0]][1])
        if any(np.sum(r.columns[names_of[0]][1] > 0) < 2 for r in measured) or max(len(np.unique(r.columns[names_of[0]][1])) for r in records) > 20:
            raise Impossible

        def clamped(m, numbers, s):
            m.bodies.append("workpiece")
            m.links += [("workpiece", a), ("workpiece", "hall")]
            numbers.update({"C workpiece": np.maximum(s * c, 1e-3), f"G workpiece {a}": s * ga, "G workpiece hall": s * out * ga})
        return fault(0.02, 8, "hidden_body", a, [(k, a) for k in ("heat_capacity", "mass_change", "exchange_window", "heat_window")], at=[a], change=clamped, columns=names_of, parts=lambda f, m, numbers, r: [column(f, "opening", "workpiece"), column(f, "gain", "workpiece", 1)],
                     sizes=dict(capacity=c, conductance=ga, to_hall=out * ga, warmer_than_hall_K=other))
    # --- an exchange, a surrounding ---------------------------------------------------------------------------------------------
    if way == "enclosure_air":
        inside = [b for b in INSIDE[machine.family] if b in films]
        total = sum(value(f"G {b} hall") for b in inside)
        c, out, door, warmer, names_of = total * tau(0.002, 0.012), total * uniform(0.5, 1.5), uniform(2, 6), uniform(3, 12), hidden(2)
        w = warmer * out
        hide(records, names_of[0], "1", lambda r: 1 - running(r))
        hide(records, names_of[1], "W", running)

        def enclosed(m, numbers, s):      # the less air comes in, the warmer it becomes
            m.bodies.append("enclosure_air")
            for b in inside:
                m.links[m.links.index((b, "hall"))] = (b, "enclosure_air")
                numbers[f"G {b} enclosure_air"] = numbers[f"G {b} hall"]
            m.links.append(("enclosure_air", "hall"))
            numbers.update({"C enclosure_air": np.full_like(s, c), "G enclosure_air hall": out / s})
        return fault(0.01, 4, "hidden_body", inside[0], [("hidden_body", b) for b in inside[1:] + ["hall"]] + [("ambient", "hall"), ("stratification", "hall")] + [x for b in inside for x in at_film(b, ["exchange_window", "stratification"])], at=inside, change=enclosed, columns=names_of,
                     parts=lambda f, m, numbers, r: [column(f, "opening", "enclosure_air", 0, door * out / f.size), column(f, "gain", "enclosure_air", 1, np.full_like(f.size, w))], sizes=dict(bodies=inside, capacity=c, to_hall=out, door_open_times=door, power_W=w))
    if way == "air_over_height":
        high = [b for b in HIGH[machine.family] if b in films]
        places = [(b, float(x)) for b, x in zip(high, [1.0] + list(np.round(rng.uniform(0.3, 0.95, len(high) - 1), 2)))] + [(BED[machine.family], -float(round(uniform(0.15, 0.6), 2)))]      # heights over the thermometer of the ambient
        phase, names_of = {r.name: uniform(0, 1) for r in records}, hidden()
        hide(records, names_of[0], "K", lambda r: 0.4 + 0.6 * np.sin(np.pi * (r.time_s / 86400 + phase[r.name])) ** 2)
        return fault(0.2, 15, "stratification", "hall", [("ambient", "hall")] + [(k, b) for b, _ in places for k in ("stratification", "heat_source", "radiation")], at=[b for b, _ in places], columns=names_of,
                     parts=lambda f, m, numbers, r: [column(f, "gain", b, 0, f.size * x * numbers[f"G {b} hall"]) for b, x in places], sizes=dict(unit="K", heights=dict(places)))
    if way == "cutting_fluid":
        washed = [pick(rng, WORK[machine.family])]
        if rng.random() < 0.5:
            washed.append(pick(rng, [x for x in INSIDE[machine.family] if x not in washed]))
        shares, often, warmer, colder, slow, names_of = [1.0, float(round(uniform(0.2, 0.8), 2))][:len(washed)], uniform(0.4, 0.75), uniform(2, 9), uniform(0.5, 3), tau(0.05, 0.3), hidden(2)

        def flows(r):
            on = np.zeros(len(r.time_s))
            for a, b in stretches(r.time_s, running(r)):
                on[(r.time_s >= a) & (r.time_s < b)] = rng.random() < often
            return on
        hide(records, names_of[0], "1", flows)
        hide(records, names_of[1], "W", lambda r: r.columns[names_of[0]][1] * late(r, np.where(r.columns[names_of[0]][1] > 0, warmer, -colder), slow, -colder))      # a pump warms its tank; at rest it gives vapour
        if any(np.ptp(r.columns[names_of[0]][1]) == 0 for r in measured) or not any(np.any((running(r) > 0) & (r.columns[names_of[0]][1] == 0)) for r in measured):
            raise Impossible
        return fault(0.02 * g, 15 * g, "exchange_window", washed[0] + ",hall", [("exchange_window", a + ",hall") for a in washed[1:]] + [x for a in washed for x in [(k, a) for k in ("coolant", "forced_convection", "heat_window", "heat_source", "hidden_body")] + at_film(a)], at=washed, columns=names_of,
                     parts=lambda f, m, numbers, r: [column(f, mode, a, k, f.size * x) for a, x in zip(washed, shares) for k, mode in enumerate(("opening", "gain"))], sizes=dict(unit="W/K", bodies=washed, shares=shares, tank_warmer_K=warmer, tank_colder_K=colder, tank_lag_min=round(slow / 60, 2)))
    if way == "joint_tightens":
        a, b = pick(rng, [x for x in joints if set(x) & set(driven) and min(value("C " + y) for y in x) / value("G %s %s" % x) > 2.5 * machine.longest_step_s])
        inner, outer = (a, b) if a in driven else (b, a)

        def fit(m, numbers, s, index, record, row, speed):      # by Yovanovich conductance goes by pressure to the power 0.95, and pressure by the difference
            i, j, k0 = index[inner], index[outer], numbers[f"G {a} {b}"]

            def watts(T, k):
                d = T[:, i] - T[:, j]
                q = k0 * (np.clip(1 + s * d, 0.1, 3.0) ** 0.95 - 1) * d
                return [(i, -q), (j, q)]
            return watts
        return fault(0.004, 0.4, "contact", f"{a},{b}", [("link", f"{a},{b}")], sign=1.0 if rng.random() < 0.5 else -1.0, at=[a, b], change=feeds_back(fit), pair=[inner, outer], joint=f"G {a} {b}", sizes=dict(unit="1/K", inner=inner))
    if way == "surface_turns":
        if max(len(np.unique(r.speed)) for r in records) > 24:      # each speed is a network of its own
            raise Impossible
        a, names_of = pick(rng, driven), hidden()
        hide(records, names_of[0], "1", lambda r: (r.speed / plan["top"]) ** (2 / 3))
        return fault(0.01 * g, 8 * g, "forced_convection", a, at_film(a, ["exchange_window"]), at=[a], columns=names_of, parts=lambda f, m, numbers, r: [column(f, "opening", a)], sizes=dict(unit="W/K", exponent=0.6667))
    if way == "chiller_follows_room":
        a, at = pick(rng, machine.circuits)
        slow, names_of = tau(0.005, 0.05), hidden()
        hide(records, names_of[0], "W", lambda r: late(r, r.hall, slow, r.hall[0]) - at)

        def follows(f, m, numbers, r):
            stream = numbers["flow " + a] / 60 * 3800.0
            return [column(f, "gain", a, 0, f.size * stream * (1 - np.exp(-numbers["passage " + a] / stream)))]
        return fault(0.03, 1.0, "coolant", a, at_film(a), at=[a], columns=names_of, parts=follows, sizes=dict(unit="K/K", lag_min=round(slow / 60, 2)))
    # --- an input -------------------------------------------------------------------------------------------------------------------
    if way == "preload_rises":
        i = pick(rng, [i for i in speeds if machine.heats[i]["kind"] == "friction_law"])
        a = machine.heats[i]["node"]
        b = max(beside(machine, a), key=lambda x: conductance(a, x))

        def preloaded(m, numbers, s, index, record, row, speed):      # friction goes by load to the power 4/3
            q, x, y = heat_now(m, numbers, i, speed), index[a], index[b]
            return lambda T, k: [(x, q(T[:, x], k) * (np.clip(1 + s * (T[:, x] - T[:, y]), 0.2, 2.5) ** (4 / 3) - 1))]
        return fault(0.002, 0.3, "friction_law", a, [("heat_source", a)], at=[a], change=feeds_back(preloaded), node=a, housing=b, heat=f"P {i}", number=i, sizes=dict(unit="1/K", housing=b))
    if way == "oil_thins":
        i = pick(rng, [i for i in speeds if machine.heats[i]["kind"] != "motor_loss" and not machine.heats[i]["has_decay"]])
        a = machine.heats[i]["node"]

        def thins(m, numbers, s, index, record, row, speed):
            q, x = heat_now(m, numbers, i, speed), index[a]
            return lambda T, k: [(x, q(T[:, x], k) * (viscosity(T[:, x], m.t_ref) ** s - 1))]
        return fault(0.02, 1.0, "friction_law", a, [("heat_source", a)], at=[a], change=feeds_back(thins), node=a, heat=f"P {i}", number=i, sizes=dict(unit="exponent of the viscosity"))
    if way == "motor_enabled":
        a = pick(rng, [h["node"] for h in machine.heats if h["kind"] == "motor_loss"])
        after, names_of = tau(0.02, 0.2), hidden()

        def enabled(r):
            last = np.maximum.accumulate(np.where(running(r) > 0, np.append(r.time_s[1:], r.time_s[-1]), -1e9))
            return ((running(r) > 0) | (r.time_s - last < after)).astype(float)
        hide(records, names_of[0], "W", enabled)
        return fault(0.01 * watts, 3 * watts, "heat_source", a, [("heat_window", a)], at=[a], columns=names_of, parts=lambda f, m, numbers, r: [column(f, "gain", a)], sizes=dict(unit="W", after_min=round(after / 60, 2)))
    if way == "nut_friction":
        i = pick(rng, [i for i, h in enumerate(machine.heats) if h["kind"] == "servo_loss"])
        axis, near = machine.heats[i]["axis"], beside(machine, machine.heats[i]["node"])
        a, top, names_of = pick(rng, near if rng.random() < 0.8 else [x for x in solid if x != machine.heats[i]["node"]]), plan["feeds"][machine.heats[i]["axis"]] / 60000, hidden()
        hide(records, names_of[0], "W", lambda r: 0.6 * r.feeds[axis] / top + 0.4 * (r.feeds[axis] / top) ** (5 / 3))      # preload alone, and grease
        return fault(0.01 * watts, 4 * watts, "heat_source", a, [("recorded_drive", a)], at=[a], columns=names_of, parts=lambda f, m, numbers, r: [column(f, "gain", a)], sizes=dict(unit="W", axis=axis))
    if way == "sun_on_part":
        a, width, names_of = pick(rng, HIGH[machine.family] if rng.random() < 0.7 else films), uniform(0.15, 0.5) * shortest, hidden()
        first = {r.name: uniform(-0.3 * width, r.time_s[-1] - 0.5 * width) for r in records}

        def sun(r):
            out, t = np.clip(np.sin(np.pi * (r.time_s - first[r.name]) / width), 0, None) * ((r.time_s >= first[r.name]) & (r.time_s <= first[r.name] + width)), 0.0
            while t < r.time_s[-1]:
                length = width * uniform(0.05, 0.3)
                out[(r.time_s >= t) & (r.time_s < t + length)] *= 1.0 if rng.random() < 0.65 else uniform(0.1, 0.5)
                t += length
            return out
        hide(records, names_of[0], "W", sun)
        return fault(0.02 * watts, 5 * watts, "radiation", a, [("heat_window", a), ("heat_source", a)], at=[a], columns=names_of, parts=lambda f, m, numbers, r: [column(f, "gain", a)], sizes=dict(unit="W", first_min={n: round(x / 60, 2) for n, x in first.items()}, lasts_min=round(width / 60, 2)))
    # --- a path to what is read -----------------------------------------------------------------------------------------------------
    if way == "bracket_grows":
        name, _, used = pick(rng, machine.displacements)
        b, share, slow = pick(rng, films), float(round(uniform(0.1, 0.7), 2)), tau(0.01, 0.12)

        def reads(f, seen):
            x = share * seen.bodies[b] + (1 - share) * seen.bodies["hall"]
            seen.displacements[:, :, seen.channel(name)] += f.size[:, None] * (eleventh_faults.first_order(seen.t, x, np.full(len(f.size), slow), x[:, 0]) - machine.t_ref)
        return fault(0.02, 20, "displacement_path", name, [("expansion", f"{b},{name}")] if b in used else [], sign=1.0 if rng.random() < 0.5 else -1.0, channel=name, looks=[b, "hall"], reads=reads, sizes=dict(unit="um/K", body=b, share_of_body=share, lag_min=round(slow / 60, 2)))
    if way == "thermometer_loose":
        name, b = pick(rng, machine.sensors)
        lag, names_of = tau(0.01, 0.08), hidden()
        hide(records, names_of[0], "1", running)

        def reads(f, seen):
            y, s = seen.temperatures[:, :, seen.sensor(name)], f.size[:, None]
            share = np.minimum(0.97, s * (1 + 0.6 * seen.record.columns[f.data["columns"][0]][1]))      # air about it moves while the machine runs
            x = y + share * (seen.bodies["hall"] - y)
            seen.temperatures[:, :, seen.sensor(name)] = eleventh_faults.first_order(seen.t, x, f.size * lag, x[:, 0])
        return fault(0.02, 0.6, "sensor_place", name, [("sensor_detached", name), ("sensor_lag", name)], sensor=name, lag=lag / 60, columns=names_of, looks=["hall"], reads=reads, sizes=dict(lag_of_one_min=round(lag / 60, 3)))
    if way == "shaft_stretches":
        if not speeds:
            raise Impossible
        name, (slow, falls), at = pick(rng, channels), (tau(0.02, 0.12), uniform(0.02, 0.2)), float(plan["top"])

        def reads(f, seen):
            x, y = seen.record.speed / at, np.zeros(len(seen.t))
            for k in range(1, len(y)):
                e = np.exp(-(seen.t[k] - seen.t[k - 1]) * (1 + 2 * x[k - 1]) / slow)      # what turns is cooled better
                y[k] = y[k - 1] * e + x[k - 1] ** 1.5 * (1 - e)
            seen.displacements[:, :, seen.channel(name)] += f.size[:, None] * (y - falls * x ** 2)      # and it becomes thicker, and so shorter, at once
        return fault(0.1, 300, "spindle_growth", name, [("displacement_path", name)], sign=1.0 if rng.random() < 0.7 else -1.0, channel=name, reads=reads, sizes=dict(unit="um", lag_at_rest_min=round(slow / 60, 2), centrifugal_share=round(falls, 3)))
    # --- an event -------------------------------------------------------------------------------------------------------------------
    if way == "door_opened":
        r = pick(rng, measured)
        begin = sorted(uniform(0.05, 0.85) * r.time_s[-1] for _ in range(int(rng.integers(1, 4))))
        open_s, (fast, slow) = [(a, a + tau(0.008, 0.05)) for a in begin], (uniform(60, 300), tau(0.01, 0.06))

        def air(x):
            y, on = np.zeros(len(x.time_s)), np.any([(x.time_s >= a) & (x.time_s < b) for a, b in open_s], axis=0)
            for k in range(1, len(y)):
                h = x.time_s[k] - x.time_s[k - 1]
                y[k] = on[k - 1] + (y[k - 1] - on[k - 1]) * np.exp(-h / (fast if on[k - 1] else slow))
            return y
        if air(r).max() < 0.3:
            raise Impossible
        cooled = lambda x, s: Record(x.name, x.time_s, x.speed, x.feeds, x.power, x.hall + s * air(x), x.columns)
        return fault(0.2, 15, "ambient", "hall", where=[r.name], sign=1.0 if rng.random() < 0.25 else -1.0, at=[], record=cooled, spans=lambda s: [[a / 60, b / 60] for a, b in open_s], sizes=dict(unit="K", falls_within_min=round(fast / 60, 2), recovers_within_min=round(slow / 60, 2)))
    if way == "warm_before":
        if not speeds or machine.start not in ("hall", "steady"):
            raise Impossible
        where, level, pause = None if rng.random() < 0.4 else [pick(rng, measured).name], float(round(uniform(0.4, 1), 2)), float(round(tau(0.002, 0.03)))

        def before(r, minutes):
            t = np.array([0.0, round(60 * minutes, 3)])
            first = lambda x, on=0.0: np.concatenate([[on, 0 * on], x])
            return Record(r.name, np.concatenate([t, r.time_s + t[1] + pause]), first(r.speed, level * plan["top"]), {a: first(x, 0.3 * plan["feeds"][a] / 60000) for a, x in r.feeds.items()}, first(r.power, 0.5 * plan.get("power", 0.0)),
                          np.append([r.hall[0]] * 2, r.hall), {n: (u, np.append([x[0]] * 2, x)) for n, (u, x) in r.columns.items()}), 2
        return fault(0.002 * shortest / 60, 0.8 * shortest / 60, "heat_window", driven[0], [("heat_window", n) for n in driven[1:] + ["spindle"]] + [("heat_source", n) for n in driven], where=where, before=before, sizes=dict(unit="min", share_of_top=level, pause_min=round(pause / 60, 2)))
    if way == "override_turned":
        r = pick(rng, measured)
        if not speeds:
            raise Impossible
        i, n = int(rng.integers(0, int(0.7 * len(r.time_s)))), len(r.time_s)
        k = min(n - 1, i + int(uniform(0.1, 0.5) * n))
        begin, end = float(r.time_s[i]), float(r.time_s[k])
        if np.mean(r.speed[i:k] > 0) < 0.3:
            raise Impossible
        slower = lambda x, s: Record(x.name, x.time_s, np.where((x.time_s >= begin - 1e-6) & (x.time_s < end - 1e-6), (1 - min(s, 0.99)) * x.speed, x.speed), x.feeds, x.power, x.hall, x.columns)
        return fault(0.02, 0.9, "speed_override", "spindle", [("heat_window", x) for x in ["spindle"] + driven], True, where=[r.name], record=slower, spans=lambda s: [[begin / 60, end / 60]], sizes=dict(unit="of the speed"))
    raise ValueError(way)
