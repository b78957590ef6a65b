"""What is hidden in the set `eighth`: kinds of the sets before and twenty-six ways of being wrong that none of them has (README.md): bodies, paths and heats that are elsewhere than the model has them, columns that act and that no file has, and errors of whole cards of instruments."""
import copy

import numpy as np

import fifth_faults
import seventh_faults
import third_faults
from faults import Fault, Impossible, largest_heat, pick, typical_link
from network import Record, simulate
from seventh_faults import HIDDEN, LEAST_NATS, hide, runs

# Ways of class A; those of C16 that are new, once each; the older effects of C16, C8 and D.
SAYABLE_A = ["body_between", "body_with_heat", "split_body", "cabin_forgotten", "link_moved", "mislabelled", "heat_too_much", "bending", "resistance_rises", "warm_corner", "every_other_run"]
UNSAYABLE_A = ["warm_start", "evaporation", "pump_rests", "axes_mixed", "speed_capped", "other_room", "chiller_hunts", "stiff_start", "critical_speed"]
OLDER_A = ["hidden_body", "link", "heat_law", "exchange_window"]
WAYS_A = OLDER_A + SAYABLE_A + UNSAYABLE_A
NEW_C = ["logger_mean", "play", "range_end", "recalibrated", "stand_bumped", "all_in_air"]
UNSAYABLE = set(UNSAYABLE_A) | {"logger_mean", "play", "range_end"}      # by no effect of the grammar, or by one that says nearly the same
KINDS_C = [k for k in third_faults.KINDS_C if k != "sensor_swap"]      # which has no size
N_RECORDS = {"recalibrated": [3, 4, 5], "warm_start": [2, 3, 4]}
NOT_STEADY = {"evaporation", "pump_rests", "chiller_hunts"}      # a machine at rest for long before would have another state
MOST_NATS = 400        # of what has no size

# key of truth.json and further names that count as right at the same place; `parameters` is empty and `sizes` says how large it is
NAMES = dict(body_between=("hidden_body", ["heat_capacity"]), body_with_heat=("hidden_body", ["heat_source", "heat_capacity", "heat_window"]), split_body=("hidden_body", ["heat_capacity"]), cabin_forgotten=("hidden_body", ["convection", "contact"]),
             link_moved=("link", []), mislabelled=("sensor_place", []), heat_too_much=("heat_source", []), bending=("displacement_path", []), resistance_rises=("friction_law", ["recorded_drive", "heat_source"]),
             warm_corner=("heat_source", ["radiation", "stratification"]), every_other_run=("heat_window", ["heat_source"]), warm_start=("heat_window", ["heat_source"]), evaporation=("convection", ["contact", "radiation", "heat_source"]),
             pump_rests=("coolant", ["exchange_window", "forced_convection", "recorded_drive", "convection", "link", "contact"]), axes_mixed=("heat_source", ["recorded_drive", "friction_law"]), speed_capped=("speed_override", ["heat_window"]),
             other_room=("link", ["convection", "contact", "coolant", "radiation", "hidden_body", "exchange_window"]), chiller_hunts=("coolant", ["heat_window", "heat_source"]), stiff_start=("heat_source", ["heat_window", "friction_law"]),
             critical_speed=("heat_source", ["friction_law", "heat_window"]), logger_mean=("clock_offset", []), play=("scale_expansion", ["displacement_path", "mount_shift"]), range_end=(None, []), recalibrated=("sensor_bias", []),
             stand_bumped=("mount_shift", []), all_in_air=("sensor_place", ["sensor_detached"]))


def all_temperatures(machine, records):
    """Of all bodies of the nominal machine, one array for each record (row x body)."""
    m = copy.copy(machine)
    m.sensors, m.displacements = [(b, b) for b in m.bodies], []
    return [simulate(m, m.nominal(), r)[0][0] for r in records]


def beside(machine, body):
    return [y if x == body else x for x, y in machine.links if body in (x, y) and "hall" not in (x, y)]


def restructured(change, low, high, **data):
    return [Fault("restructured", dict(change=change, **data), None, low, high)]


def draw(rng, way, machine, plan, records, column, noise):
    """The faults that this way of being wrong consists of; some put columns into `records` that no file has."""
    measured = [r for r in records if r.name != "holdout_1"]
    names = [r.name for r in measured]
    shortest = min(r.time_s[-1] for r in records)
    sign = 1.0 if rng.random() < 0.5 else -1.0
    watts, g = largest_heat(machine, plan), typical_link(machine)
    speeds = [i for i, h in enumerate(machine.heats) if h["has_exponent"] and h["kind"] not in ("servo_loss", "cutting_heat")]      # heats that follow the speed
    channels, sensors = [d[0] for d in machine.displacements], [n for n, _ in machine.sensors]
    value = lambda k: machine.numbers[k][0]
    if (way in ("speed_capped", "stiff_start", "critical_speed") and not speeds) or (way in ("bending", "play") and not channels) or (way == "mislabelled" and not sensors) or (way in ("recalibrated", "all_in_air") and len(sensors) < 2) or (way == "stand_bumped" and len(channels) < 2):
        raise Impossible
    tau = lambda low=0.01, high=0.15: float(shortest * np.exp(rng.uniform(np.log(low), np.log(high))))

    def gain(node, low=0.01, high=4, sign=1.0, **more):
        return [Fault("recorded_drive", dict(node=node, column=HIDDEN, mode="gain", **more), None, low * watts, high * watts, sign)]
    if way == "body_between":      # an adapter, a coupling, a clamp that touches both: also a path
        a, b = pick(rng, [x for x in machine.links if x[1] != "hall"])
        c = min(value("C " + a), value("C " + b)) * np.exp(rng.uniform(np.log(0.15), np.log(1.2)))
        ga, gb = c / tau(), c / tau()

        def between(m, numbers, s):
            m.bodies.append("left_out")
            m.links += [("left_out", a), ("left_out", b)]
            numbers.update({"C left_out": np.maximum(s * c, 1e-3), f"G left_out {a}": s * ga, f"G left_out {b}": s * gb})
        return restructured(between, 0.02, 6, nodes=[a, b], capacity=c, conductances=[ga, gb])
    if way == "body_with_heat":      # a pump, a motor, a lamp with its own heat
        a = pick(rng, machine.bodies)
        c, law = value("C " + a) * np.exp(rng.uniform(np.log(0.15), np.log(1))), pick(rng, ["constant"] + (["turning", "power"] if speeds else []))
        ga, w, e = c / tau(), watts * rng.uniform(0.05, 0.3), float(pick(rng, [1.0, 1.5, 2.0]))

        def warm(m, numbers, s):
            i = len(m.heats)
            m.bodies.append("left_out")
            m.links.append(("left_out", a))
            m.heats.append(dict(kind="heat_source", node="left_out", at=float(plan.get("top", 1)), axis=None, turning=law == "turning", has_exponent=law == "power", has_idle=False, has_decay=False))
            numbers.update({"C left_out": np.maximum(s * c, 1e-3), f"G left_out {a}": s * ga, f"P {i}": s * w, **({f"e {i}": np.full_like(s, e)} if law == "power" else {})})
        return restructured(warm, 0.01, 6, node=a, capacity=c, conductance=ga, power=w, law=law)
    if way == "split_body":      # what is one body in the model is two, and heat and thermometer are in the one
        a = pick(rng, [b for b in machine.bodies if b not in machine.air])
        t = tau(0.02, 0.3)

        def split(m, numbers, s):
            s, c = np.minimum(s, 0.97), numbers["C " + a]
            m.bodies.append("left_out")
            m.links.append(("left_out", a))
            numbers.update({"C left_out": s * c, f"G left_out {a}": s * c / t, "C " + a: (1 - s) * c})
        return restructured(split, 0.02, 0.93, node=a, minutes=t / 60)
    if way == "cabin_forgotten":      # two or more bodies are in separate air inside a guard
        films = [a for a, b in machine.links if b == "hall" and a not in machine.air]
        if len(films) < 2:
            raise Impossible
        inside = [films[int(i)] for i in rng.choice(len(films), int(rng.integers(2, min(4, len(films)) + 1)), replace=False)]
        total = sum(value(f"G {a} hall") for a in inside)
        c = total * tau(0.003, 0.02)

        def cabin(m, numbers, s):
            m.bodies.append("left_out")
            for a in inside:
                m.links[m.links.index((a, "hall"))] = (a, "left_out")
                numbers[f"G {a} left_out"] = numbers[f"G {a} hall"]
            m.links.append(("left_out", "hall"))
            numbers.update({"C left_out": np.full_like(s, c), "G left_out hall": total / s})
        return restructured(cabin, 0.03, 6, nodes=inside, capacity=c, films_W_K=total)
    if way == "link_moved":      # bolted to the other part
        a, b = pick(rng, [x for x in machine.links if x[1] != "hall"])
        if rng.random() < 0.5:
            a, b = b, a
        taken = {frozenset(x) for x in machine.links}
        c = pick(rng, [x for x in machine.bodies if x not in (a, b) and frozenset((a, x)) not in taken])
        label, = [f"G {x} {y}" for x, y in machine.links if {x, y} == {a, b}]

        def move(m, numbers, s):
            s = np.minimum(s, 0.97)
            m.links.append((a, c))
            numbers[f"G {a} {c}"], numbers[label] = s * numbers[label], (1 - s) * numbers[label]
        return restructured(move, 0.03, 0.97, pair=[a, c], old=[a, b])
    if way == "mislabelled":      # it has always been on the other body, one that is about as warm
        name, body = pick(rng, machine.sensors)
        t = all_temperatures(machine, measured)
        i = machine.bodies.index(body)
        worth = {b: sum(np.sum((x[:, i] - x[:, k]) ** 2) for x in t) / (2 * (noise["temperature"]["sigma"] ** 2 + noise["temperature"]["step"] ** 2 / 12)) for k, b in enumerate(machine.bodies) if k != i}
        return [Fault("sensor_place", dict(sensor=name, other=pick(rng, [b for b, x in worth.items() if 20 < x < 8000])), None, 1.0, 1.0)]
    if way == "heat_too_much":      # written twice, or with the rated power
        i = pick(rng, range(len(machine.heats)))

        def less(m, numbers, s):
            for k in ("P", "idle"):
                if f"{k} {i}" in numbers:
                    numbers[f"{k} {i}"] = numbers[f"{k} {i}"] * np.exp(-s)
        return restructured(less, 0.1, 3, node=machine.heats[i]["node"], heat=i)
    if way == "bending":
        channel, _, used = machine.displacements[int(rng.integers(len(channels)))]
        pair = [x for x in machine.links if x[1] != "hall" and not set(x) <= set(used)]
        a, b = pick(rng, pair)
        return [Fault(way, dict(channel=channel, nodes=[a, b]), None, 0.03, 30, sign)]
    if way == "resistance_rises":      # what a recorded power leaves in a body falls, or grows, as the body warms
        i = pick(rng, [i for i, h in enumerate(machine.heats) if h["kind"] == "cutting_heat"])
        return [Fault("friction_law", dict(heat=i, node=machine.heats[i]["node"], decay=True), None, 0.0005, 0.03, 1.0 if rng.random() < 0.75 else -1.0)]
    if way == "warm_corner":      # the air about some bodies is warmer than where the ambient is recorded
        films = [a for a, b in machine.links if b == "hall" and a not in machine.air]
        if len(films) < 3:
            raise Impossible
        inside = [films[int(i)] for i in rng.choice(len(films), 2, replace=False)]

        def corner(m, numbers, s):
            for a in inside:
                i = len(m.heats)
                m.heats.append(dict(kind="heat_source", node=a, at=1.0, axis=None, turning=False, has_exponent=False, has_idle=False, has_decay=False))
                numbers[f"P {i}"] = s * numbers[f"G {a} hall"]
        return restructured(corner, 0.2, 25, nodes=inside)
    if way == "every_other_run":      # another tool, pallet or mould, in turn
        def turn(r):
            on = np.asarray(runs(machine, r), bool)
            count = np.cumsum(np.append(on[:1], on[1:] & ~on[:-1]))
            if count[-1] < 3 and r.name != "holdout_1":
                raise Impossible
            return on & (count % 2 == 0)
        hide(records, "W", turn)
        return gain(pick(rng, machine.bodies), sign=1.0 if rng.random() < 0.8 else -1.0)
    if way == "warm_start":      # it had been run before somebody began to write
        a = machine.heats[int(rng.integers(len(machine.heats)))]["node"] if rng.random() < 0.7 else pick(rng, machine.bodies)
        nodes = [a] + (beside(machine, a)[:1] if rng.random() < 0.5 else [])
        return [Fault("begun_warm", dict(nodes=nodes), [pick(rng, names)], 0.1, 40, 1.0 if rng.random() < 0.8 else -1.0)]
    if way == "evaporation":      # of coolant on what is wet: the vapour's pressure grows by 6 % with each kelvin
        t = [np.max([x[:, i].max() for x in all_temperatures(machine, measured)]) for i in range(len(machine.bodies))]
        node = pick(rng, [b for b, x in zip(machine.bodies, t) if x < 65])

        def wet(m, numbers, s):
            i = len(m.heats)
            m.heats.append(dict(kind="heat_source", node=node, at=1.0, axis=None, turning=False, has_exponent=False, has_idle=False, has_decay=True))
            numbers[f"P {i}"], numbers[f"decay {i}"] = -s, np.full_like(s, -0.06)
        return restructured(wet, 0.002 * watts, 1.5 * watts, node=node, per_K=0.06)
    if way == "pump_rests":      # the coolant rests, or trickles, while the machine is at rest
        node, warm = pick(rng, machine.circuits)
        rests = lambda r: ~np.asarray(runs(machine, r), bool)
        hide(records, "1", rests)
        for r in records:
            r.columns[HIDDEN + "_2"] = ("W", rests(r) * (warm - r.hall))
        return [Fault(way, dict(node=node, on=HIDDEN, excess=HIDDEN + "_2"), None, 0.05, 0.95)]
    if way == "axes_mixed":      # the logger's axes are not the machine's: a share of each belongs to the other
        used = sorted({h["axis"] for h in machine.heats if h["kind"] == "servo_loss"})
        if len(used) < 2:
            raise Impossible
        a, b = used[:2]

        def mixed(r, s):
            s = min(s, 1.0)
            return Record(r.name, r.time_s, r.speed, {**r.feeds, a: (1 - s) * r.feeds[a] + s * r.feeds[b], b: (1 - s) * r.feeds[b] + s * r.feeds[a]}, r.power, r.hall, r.columns)
        return [Fault("record_change", dict(axes=[a, b], change=mixed), None, 0.02, 1.0)]
    if way == "speed_capped":      # a gear, a belt, a current limit: it turns no faster than this
        return [Fault("record_change", dict(place="spindle", change=lambda r, s: seventh_faults.truly(r, speed=np.minimum(r.speed, plan["top"] * (1 - min(s, 0.97))))), None, 0.02, 0.85)]
    if way == "other_room":      # a wall, a pit or a duct that follows weather of its own
        middle, swing = rng.uniform(4, 34), rng.uniform(1, 5)
        if min(abs(middle - np.mean(r.hall)) for r in measured) < 3:
            raise Impossible

        def weather(r):
            x = 2 * np.pi * r.time_s / (shortest * rng.uniform(0.7, 3)) + rng.uniform(0, 6.3)
            return middle + rng.normal(0, 1.5) + swing * np.sin(x) + 0.3 * swing * np.sin(2.7 * x)
        hide(records, "degC", weather)
        return [Fault("recorded_drive", dict(node=pick(rng, machine.bodies), column=HIDDEN, mode="conductance", about_degC=round(middle, 1)), None, 0.01 * g, 6 * g)]
    if way == "chiller_hunts":      # its thermostat goes on and off, or its controller swings
        node, _ = pick(rng, machine.circuits)
        period, saw = rng.uniform(0.06, 0.3) * shortest, rng.random() < 0.5

        def wave(r):
            x = (r.time_s / period + rng.uniform(0, 1)) % 1
            return 1 - 2 * x if saw else np.sin(2 * np.pi * x)
        hide(records, "W", wave)
        return gain(node, 0.01, 8, period_min=round(period / 60, 2))
    if way == "stiff_start":      # grease that has settled: more heat after each start, the more the longer the machine had been at rest
        fades, settles = rng.uniform(0.01, 0.06) * shortest, rng.uniform(0.02, 0.2) * shortest

        def churned(r):
            out, x = np.zeros(len(r.time_s)), 1.0
            for k in range(len(out)):
                h = r.time_s[min(k + 1, len(out) - 1)] - r.time_s[k]
                if r.speed[k] > 0:
                    out[k], x = x, x * np.exp(-h / fades)
                else:
                    x = 1 - (1 - x) * np.exp(-h / settles)
            return out
        hide(records, "W", churned)
        return gain(machine.heats[pick(rng, [i for i in speeds if machine.heats[i]["kind"] != "motor_loss"])]["node"], 0.02, 10, fades_min=round(fades / 60, 2), settles_min=round(settles / 60, 2))
    if way == "critical_speed":      # a resonance, a cage that rattles, a whistle: heat about one speed alone
        levels = np.concatenate([r.speed[r.speed > 0] for r in measured])
        at, width = float(pick(rng, np.unique(levels))), rng.uniform(0.05, 0.14) * plan["top"]
        near = np.abs(levels - at) < width
        if not 0.05 < near.mean() < 0.7:
            raise Impossible
        hide(records, "W", lambda r: (r.speed > 0) * np.exp(-((r.speed - at) / width) ** 2))
        return gain(machine.heats[pick(rng, speeds)]["node"], at_speed=at, width_rpm=float(round(width, 1)))
    if way == "logger_mean":      # it averages
        step = float(np.median(np.concatenate([np.diff(r.time_s) for r in measured])))
        return [Fault(way, {}, None, 0.2 * step / 60, 0.15 * shortest / 60)]
    if way == "play":      # a dial gauge that sticks
        return [Fault(way, dict(channel=pick(rng, channels)), None, 0.03, 60)]
    if way == "range_end":      # in all records; truth.json has it as if nothing were wrong
        channel = pick(rng, channels if channels and (not sensors or rng.random() < 0.4) else sensors)
        m = copy.copy(machine)
        m.sensors, m.displacements = [x for x in machine.sensors if x[0] == channel], [x for x in machine.displacements if x[0] == channel]
        y = [np.concatenate([a[0].ravel() for a in simulate(m, m.nominal(), r)]) for r in measured]
        top, low = max(x.max() for x in y), min(x.min() for x in y)
        sigma = noise["displacement" if channel in channels else "temperature"]["sigma"]
        return [Fault(way, dict(channel=channel, top=float(top)), None, max(0.01 * (top - low), 0.2 * sigma), 0.8 * (top - low))]
    if way == "recalibrated":      # a card is exchanged: from a record on its thermometers are all off, each by its own
        k = min(len(sensors), int(rng.integers(2, 6)))
        chosen = [sensors[int(i)] for i in rng.choice(len(sensors), k, replace=False)]
        return [Fault("many_readings", dict(channels=chosen, shares=[float(x) for x in np.round(rng.uniform(0.4, 1, k) * rng.choice([-1, 1], k), 2)], begin_s=0.0), names[int(rng.integers(1, len(names))):] + ["holdout_1"], 0.02, 6)]
    if way == "stand_bumped":      # all indicators are on it
        r = pick(rng, measured)
        return [Fault("many_readings", dict(channels=channels, shares=[float(x) for x in np.round(rng.uniform(0.3, 1, len(channels)) * rng.choice([-1, 1], len(channels)), 2)], begin_s=float(round(rng.uniform(0.1, 0.85) * r.time_s[-1]))), [r.name], 0.1, 90)]
    if way == "all_in_air":      # glued on, and nobody has covered them
        return [Fault(way, dict(sensors=sensors), None, 0.003, 0.6)]
    return fifth_faults.draw(rng, way, machine, plan, records, column)


def places(way, fault, machine):
    """Bodies at which another kind might say the same."""
    d = fault.data
    if way == "axes_mixed":
        return sorted({h["node"] for h in machine.heats if h["kind"] == "servo_loss" and h["axis"] in d["axes"]})
    if way == "bending" or d.get("sensor") or d.get("channel"):
        return []
    return [x for x in (d.get("nodes") or d.get("pair") or [d.get("node") or d.get("a")]) if x and x != "hall"]


def told_alike(way, fault, machine, plan, records, judge, scale):
    """Those of seventh_faults.py's candidates at these bodies, and links between them, that leave less than LEAST_NATS of it, by linear nats about the nominal numbers with their size free."""
    at = places(way, fault, machine)
    proxy = Fault("heat_on_two", dict(nodes=at), fault.records, windows=fault.own_windows, all_windows=fault.every)
    others = seventh_faults.candidates(proxy, machine, plan, records)
    g = 0.2 * typical_link(machine)
    for i, a in enumerate(at):
        for b in at[i + 1:]:
            others += [(x, f"{a},{b}", Fault("link", dict(a=a, b=b)).with_size(g)) for x in ("link", "contact")]
    if way in ("all_in_air", "recalibrated", "warm_corner", "cabin_forgotten"):
        others.append(("ambient", "hall", Fault("ambient", dict(from_s=0.0)).with_size(0.3)))
    d, out = judge.deviation([fault], 1), []
    for effect, where, other in others:
        beside_it = judge.deviation([other], 1)[0]
        if np.isfinite(beside_it).all() and np.linalg.norm(beside_it) > 1e-6 and scale * judge.nats(d, beside_it)[0] < LEAST_NATS:
            out.append((effect, where))
    return out


def told(way, hidden, machine, records, worth, alike):
    """The entries of truth.json; `alike`: of each fault, what told_alike says. Where no key says the law, `parameters` is empty and `sizes` says how large it is: no interval is judged by it."""
    f = hidden[0] if hidden else None
    if way in NAMES:
        d, (key, further), also = f.data, NAMES[way], []
        sizes = dict(size=float(f.size[0]), **{k: x for k, x in d.items() if k not in ("sensor", "column", "mode", "change", "place", "on", "excess", "sensors")})
        everything = [n for n, _ in machine.sensors] + [c[0] for c in machine.displacements]
        if way == "range_end":
            where = d["channel"]
            if where in [n for n, _ in machine.sensors]:
                key, further = "sensor_detached", ["sensor_lag", "sensor_bias", "sensor_drift", "sensor_place"]
            else:
                key, further = "scale_expansion", ["displacement_path", "mount_shift"]
                also = [("expansion", f"{b},{where}") for b in next(c[2] for c in machine.displacements if c[0] == where)]
        elif way == "logger_mean":
            where, also = "clock", [("sensor_lag", n) for n, _ in machine.sensors] + [("scale_expansion", c[0]) for c in machine.displacements]
        elif way in ("recalibrated", "stand_bumped", "all_in_air"):
            many = d.get("channels") or d["sensors"]
            where, also = many[0], [(k, n) for n in many for k in [key] + further]
        elif way == "axes_mixed":
            at = places(way, f, machine)
            where, also = at[0], [(k, n) for n in at for k in [key] + further]
        elif way in ("cabin_forgotten", "warm_corner", "body_between", "warm_start"):
            at = d["nodes"]
            where, also = at[0], [(k, n) for n in at for k in [key] + further]
            if way == "cabin_forgotten":
                also += [("hidden_body", "hall"), ("ambient", "hall")] + [("link", a + ",hall") for a in at]
            if way == "warm_corner":
                also += [("ambient", "hall"), ("stratification", "hall")]
            if way == "warm_start":
                also.append(("run_state", ",".join(f.records)))
            if way in ("cabin_forgotten", "body_between"):
                also += [(k, f"{a},{b}") for i, a in enumerate(at) for b in at[i + 1:] for k in ("link", "contact")]
        elif way == "link_moved":
            where = ",".join(d["pair"])
            also = [("contact", where), ("link", ",".join(d["old"])), ("contact", ",".join(d["old"]))]
        elif way == "speed_capped":
            where, also = "spindle", [("heat_window", "spindle")]
            driven = [h["node"] for h in machine.heats if h["has_exponent"] and h["kind"] not in ("servo_loss", "cutting_heat")]
            also += [(k, driven[0]) for k in ("heat_source", "friction_law")] if len(driven) == 1 else []
        elif way == "bending":
            where, also = d["channel"], [("expansion", f"{b},{d['channel']}") for b in d["nodes"]]
        else:
            where = d.get("sensor") or d.get("channel") or d["node"]
            if way == "other_room":
                where += ",hall"
            also = [(k, where.replace(",hall", "")) for k in further]
            if way in ("evaporation", "pump_rests"):
                also.append(("link", d["node"] + ",hall"))
            if way == "heat_too_much" and machine.heats[d["heat"]]["kind"] == "cutting_heat":
                also.append(("recorded_drive", where))
            if way == "play":
                also += [("expansion", f"{b},{where}") for b in next(c[2] for c in machine.displacements if c[0] == where)]
        if way == "range_end":
            also += [(k, where) for k in further]
        also = [x for i, x in enumerate(also) if x != (key, where) and x not in also[:i]]
        out = [dict(key=key, where=where, parameters=[], sizes=sizes, records=f.records or "all", nats=round(float(worth[0]), 2), also=[dict(effect=x, where=y) for x, y in also])]
    else:
        out = fifth_faults.told(way, hidden, machine, records, worth)
    for e, others in zip(out, alike):
        known = {(e["key"], e["where"])} | {(x["effect"], x["where"]) for x in e["also"]}
        fresh = [x for i, x in enumerate(others) if x not in known and x not in others[:i]]
        e["also"] += [dict(effect=x, where=y) for x, y in fresh]
        e["also_as_data_cannot_tell"] = [list(x) for x in fresh]
    for e in out:
        e["sayable"] = way not in UNSAYABLE
    return out
