"""What is hidden in the set `ninth`: twelve ways of being wrong that the grammar can say, in guises that no earlier set has, twelve that it cannot, five errors of instruments, and the older kinds (README.md)."""
import numpy as np

import eighth_faults
import fifth_faults
import third_faults
from eighth_faults import HIDDEN, all_temperatures, beside, hide, restructured, runs
from faults import Fault, Impossible, largest_heat, pick, typical_link
from network import Record
from seventh_faults import truly

# Ways of class A; those of C16 that are new, once each; the older effects of C16, C8 and D.
SAYABLE_A = ["adapter_chain", "two_feet", "lid_over_two", "holding_torque", "bearing_damage", "column_on_two", "circuit_also", "crosstalk", "stand_on_machine", "exponent_of_two", "many_stops", "clamped_at_rest"]
UNSAYABLE_A = ["one_way_stream", "wax_valve", "free_convection", "fit_tightens", "preload_by_difference", "loss_saturates", "power_offset", "coasts_down", "chip_heap", "filter_clogs", "jams", "rate_bending"]
WAYS_A = SAYABLE_A + UNSAYABLE_A
NEW_C = ["ratchet", "amplifier_warms", "hall_clock", "tilted_indicator", "hall_in_exhaust"]
UNSAYABLE = set(UNSAYABLE_A) | {"ratchet", "amplifier_warms", "hall_clock", "hall_in_exhaust"}
KINDS_C = eighth_faults.KINDS_C
N_RECORDS = {"bearing_damage": [2, 3, 4]}
NOT_STEADY = {"holding_torque", "clamped_at_rest", "one_way_stream", "wax_valve", "free_convection", "fit_tightens", "filter_clogs"}      # a machine at rest for long before would have another state
MOST_NATS = 400

# key of truth.json and further names that count as right at the same place; `parameters` is empty and `sizes` says how large it is
FILM = ["convection", "contact"]
NAMES = dict(adapter_chain=("hidden_body", ["heat_capacity"]), two_feet=("link", FILM + ["coolant", "radiation", "hidden_body"]), lid_over_two=("exchange_window", []), holding_torque=("heat_source", ["heat_window", "friction_law"]),
             bearing_damage=("heat_source", ["heat_window", "friction_law"]), column_on_two=("recorded_drive", []), circuit_also=("coolant", FILM + ["radiation", "hidden_body", "exchange_window"]), crosstalk=("sensor_place", []), stand_on_machine=("displacement_path", []),
             exponent_of_two=("friction_law", ["heat_source"]), many_stops=("missing_stop", ["heat_window", "speed_override"]), clamped_at_rest=("exchange_window", ["link", "contact"]),
             one_way_stream=("link", ["contact"]), wax_valve=("exchange_window", FILM + ["forced_convection", "coolant"]), free_convection=("convection", ["contact", "radiation", "forced_convection"]), fit_tightens=("contact", ["link"]),
             preload_by_difference=("friction_law", ["heat_source"]), loss_saturates=("friction_law", ["heat_source", "heat_window"]), power_offset=("recorded_drive", ["heat_source"]), coasts_down=("speed_override", ["heat_window"]),
             chip_heap=("heat_source", ["heat_window", "hidden_body"]), filter_clogs=("convection", ["contact", "exchange_window", "forced_convection"]), jams=("expansion", ["displacement_path", "scale_expansion"]),
             rate_bending=("displacement_path", ["expansion", "scale_expansion"]), ratchet=("mount_shift", ["displacement_path"]), amplifier_warms=("sensor_bias", ["sensor_drift"]), hall_clock=("clock_offset", []), tilted_indicator=("displacement_path", ["expansion", "scale_expansion"]),
             hall_in_exhaust=("ambient", ["sensor_place", "sensor_bias", "stratification"]))


class InRecords(Fault):
    """Has windows of its own in each record: data["by_record"]."""

    def windows(self, record):
        return self.data["by_record"].get(record.name, [])

    def events(self, record):
        return [x for w in self.windows(record) for x in w]

    def with_size(self, sizes):
        f = InRecords(self.key, self.data, self.records, self.low, self.high, self.sign)
        f.size = self.sign * np.atleast_1d(np.asarray(sizes, float))
        return f


def level(machine, plan, i, r):
    """What heat `i` is of its greatest, by nominal numbers and without idle heat."""
    h = machine.heats[i]
    e = machine.numbers[f"e {i}"][0] if h["has_exponent"] else 1.0
    if h["kind"] == "cutting_heat":
        return r.power / plan["power"]
    if h["kind"] == "servo_loss":
        return (r.feeds[h["axis"]] / (plan["feeds"][h["axis"]] / 60000)) ** e
    if h["has_exponent"]:
        return (r.speed / plan["top"]) ** e
    return (r.speed > 0).astype(float) if h["turning"] else np.ones(len(r.time_s))


def stretches(time_s, on):
    """[begin, end] of all times at which `on` holds; beyond the end where the record ends so."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], np.asarray(on, int), [0]])))
    return [(float(time_s[a]), float(time_s[b]) if b < len(time_s) else 1.02 * float(time_s[-1])) for a, b in zip(edges[::2], edges[1::2])]


def feedback(make, low, high, **data):
    """Heat that hangs on temperatures as no heat of network.py does: make(size, numbers) -> what `feedback` of network.py needs."""
    def change(m, numbers, s):
        m.feedback = [make(s, numbers, m)]
    return restructured(change, low, high, **data)


def coasting(r, top, minutes):
    """The speed, in the mean of each row, of what needs so many minutes from `top` to rest where it is not driven."""
    rate, out, v = top / (60 * minutes), r.speed.astype(float).copy(), 0.0
    pace = np.append(np.diff(r.time_s), r.time_s[-1] - r.time_s[-2])
    for k, (target, h) in enumerate(zip(r.speed, pace)):
        if v > target:
            falls = min(h, (v - target) / rate)
            out[k] = (falls * (v - 0.5 * rate * falls) + (h - falls) * target) / h
            v = v - rate * falls
        else:
            v = target
    return out


def draw(rng, way, machine, plan, records, column, noise):
    """The faults that this way of being wrong consists of; some put columns into `records` that no file has."""
    measured = [r for r in records if r.name != "holdout_1"]
    names = [r.name for r in measured]
    shortest = min(r.time_s[-1] for r in records)
    sign = 1.0 if rng.random() < 0.5 else -1.0
    watts, g = largest_heat(machine, plan), typical_link(machine)
    speeds = [i for i, h in enumerate(machine.heats) if h["has_exponent"] and h["kind"] not in ("servo_loss", "cutting_heat")]      # heats that follow the speed
    servos = [i for i, h in enumerate(machine.heats) if h["kind"] == "servo_loss"]
    channels, sensors = [d[0] for d in machine.displacements], [n for n, _ in machine.sensors]
    value, pairs = lambda k: machine.numbers[k][0], [x for x in machine.links if x[1] != "hall"]
    joint = lambda a, b: next(value(f"G {x} {y}") for x, y in machine.links if {x, y} == {a, b})
    if (way in ("many_stops", "preload_by_difference", "loss_saturates", "coasts_down") and not speeds) or (way in ("jams", "rate_bending", "ratchet") and not channels) or (way in ("stand_on_machine", "tilted_indicator") and len(channels) < 2):
        raise Impossible
    if (way == "crosstalk" and len(sensors) < 3) or (way == "amplifier_warms" and not sensors) or (way == "power_offset" and "power" not in plan):
        raise Impossible
    tau = lambda low=0.01, high=0.15: float(shortest * np.exp(rng.uniform(np.log(low), np.log(high))))
    two = lambda things: [things[int(i)] for i in rng.choice(len(things), 2, replace=False)]
    steady = lambda body, slope: 0.7 * value("C " + body) / machine.longest_step_s / slope      # the size up to which steps of network.py bear it

    def gain(node, low=0.01, high=4, sign=1.0, **more):
        return [Fault("recorded_drive", dict(node=node, column=HIDDEN, mode="gain", **more), None, low * watts, high * watts, sign)]

    def of_body(body):
        i = machine.bodies.index(body)
        return np.concatenate([x[:, i] for x in all_temperatures(machine, measured)])

    def bounded(low, high):
        if high < 10 * low:
            raise Impossible
        return low, high
    # --- what the grammar can say ---
    if way == "adapter_chain":      # a fixture on it, and a part in the fixture
        a = pick(rng, machine.bodies)
        c1, c2 = (value("C " + a) * np.exp(rng.uniform(np.log(0.1), np.log(0.9))) for _ in range(2))
        g1, g2 = c1 / tau(), c2 / tau(0.02, 0.2)

        def chain(m, numbers, s):
            m.bodies += ["left_out", "left_out_behind"]
            m.links += [("left_out", a), ("left_out_behind", "left_out")]
            numbers.update({"C left_out": np.maximum(s * c1, 1e-3), "C left_out_behind": np.maximum(s * c2, 1e-3), f"G left_out {a}": s * g1, "G left_out_behind left_out": s * g2})
        return restructured(chain, 0.02, 6, node=a, capacities=[c1, c2], conductances=[g1, g2])
    if way == "two_feet":      # both are on the same cold or warm ground
        warm = float(round(rng.uniform(5, 30), 1))
        if len(machine.bodies) < 2 or min(abs(warm - np.mean(r.hall)) for r in measured) < 2.5:
            raise Impossible
        hide(records, "degC", lambda r: np.full(len(r.time_s), warm), must_move=False)
        return [Fault(way, dict(nodes=two(machine.bodies), column=HIDDEN, degC=warm), None, 0.01 * g, 6 * g)]
    if way == "lid_over_two":      # a door, a lid or a hood: bodies inside have the hall's air for a while
        return [Fault(way, dict(nodes=two([b for b in machine.bodies if b not in machine.air])), low=0.01 * g, high=12 * g, **fifth_faults.happened(rng, records))]
    if way == "holding_torque":      # a drive that holds its axis at rest
        i = pick(rng, servos + speeds)
        h = machine.heats[i]
        hide(records, "W", lambda r: (r.feeds[h["axis"]] if i in servos else r.speed) == 0)
        return gain(h["node"], of_axis=h["axis"] or "spindle")
    if way == "bearing_damage":      # from a time of one record on, and ever after
        i = pick(rng, (servos or [i for i, h in enumerate(machine.heats) if h["kind"] == "cutting_heat"]) if not speeds else [x for x in speeds if machine.heats[x]["kind"] != "motor_loss"] or speeds)
        k, share = int(rng.integers(len(measured))), rng.uniform(0.1, 0.75)
        begins = {r.name: 0.0 if j > k else share * r.time_s[-1] if j == k else np.inf for j, r in enumerate(records)}
        hide(records, "W", lambda r: (r.time_s >= begins[r.name]) * level(machine, plan, i, r), must_move=False)
        if not np.ptp(measured[k].columns[HIDDEN][1]) > 0:
            raise Impossible
        return gain(machine.heats[i]["node"], 0.005, 3, begins_in=measured[k].name, begins_min=round(begins[measured[k].name] / 60, 2), later=names[k:])
    if way == "column_on_two":      # what is recorded warms two bodies, and no law of the model has it
        if not column or column[1] in ("degC", "1", "percent") or len(machine.bodies) < 2:
            raise Impossible
        top, share = max(np.max(r.columns[column[0]][1]) for r in records), float(np.round(rng.uniform(0.3, 0.7), 2))
        return [Fault(way, dict(nodes=two(machine.bodies), shares=[share, 1 - share], column=column[0]), None, 0.01 * watts / top, 4 * watts / top)]
    if way == "circuit_also":      # the circuit, or tap water, runs through one more body
        cooled = dict(machine.circuits)
        node = pick(rng, [b for b in machine.bodies if b not in cooled and b not in machine.air])
        warm = pick(rng, sorted(cooled.values())) if cooled and rng.random() < 0.6 else float(round(rng.uniform(8, 20), 1))
        if min(abs(warm - np.mean(r.hall)) for r in measured) < 1.5:
            raise Impossible

        def branch(m, numbers, s):
            m.circuits.append((node, warm))
            numbers.update({"flow " + node: 0.06 * s * g, "passage " + node: s * g})      # the stream takes up four times what the passage lets through
        return restructured(branch, 0.01, 6, node=node, degC=warm)
    if way == "crosstalk":      # a multiplexer that does not settle
        k = min(len(sensors), int(rng.integers(3, 9)))
        first = int(rng.integers(len(sensors) - k + 1))
        card, bodies = sensors[first:first + k], dict(machine.sensors)
        wrong = [b for a, b in zip(card, card[1:]) if bodies[a] != bodies[b]]
        if not wrong:
            raise Impossible
        return [Fault(way, dict(card=card, wrong=wrong), None, 0.002, 0.6)]
    if way == "stand_on_machine":      # the indicators' stand has been put on a part that warms
        stand = pick(rng, [b for b in machine.bodies if b not in machine.air])
        return [Fault(way, dict(channels=channels, shares=[float(x) for x in np.round(rng.uniform(0.3, 1, len(channels)) * rng.choice([-1, 1], len(channels)), 2)], stand=stand, channel=channels[0]), None, 0.02, 25, sign)]
    if way == "exponent_of_two":      # the same grease, or drives of the same make
        chosen = two(speeds) if len(speeds) > 1 else two([i for i in servos if machine.heats[i]["has_exponent"]]) if len(servos) > 1 else []
        nodes = [machine.heats[i]["node"] for i in chosen]
        if len(set(nodes)) < 2:
            raise Impossible
        return [Fault(way, dict(heats=[int(i) for i in chosen], nodes=nodes), None, 0.05, 1.8 if sign > 0 else min(value(f"e {i}") for i in chosen) - 0.05, sign)]
    if way == "many_stops":      # at each change of tool or part the spindle stops for a while, but the commanded speed does not show it
        r = pick(rng, measured)
        turning = r.time_s[(r.speed > 0) & (r.time_s > 0.04 * r.time_s[-1]) & (r.time_s < 0.88 * r.time_s[-1])]
        if len(turning) < 20:
            raise Impossible
        starts = np.sort(rng.choice(turning, int(rng.integers(3, 6)), replace=False))
        gap = float(np.min(np.diff(np.append(starts, r.time_s[-1]))))
        low, high = max(0.3 * float(np.median(np.diff(r.time_s))), 0.001 * r.time_s[-1]) / 60, min(0.9 * gap, 0.08 * r.time_s[-1]) / 60
        if high < 4 * low:
            raise Impossible
        return [Fault(way, dict(starts_s=[float(x) for x in starts]), [r.name], low, high)]
    if way == "clamped_at_rest":      # two parts are pressed together while the machine is at rest
        by_record = {r.name: stretches(r.time_s, ~np.asarray(runs(machine, r), bool)) for r in records}
        if not all(any(a > 0 for a, _ in by_record[n]) for n in names):
            raise Impossible
        a, b = pick(rng, pairs) if rng.random() < 0.5 else two(machine.bodies)
        return [InRecords("exchange_window", dict(a=a, b=b, by_record=by_record), None, 0.01 * g, 15 * g)]
    # --- what it cannot ---
    if way == "one_way_stream":      # oil, water or chips that run from one body over another and do not come back
        a, b = pick(rng, pairs) if rng.random() < 0.4 else two(machine.bodies)
        if rng.random() < 0.5:
            a, b = b, a
        if np.mean(np.abs(of_body(a) - of_body(b))) < 0.3:
            raise Impossible

        def stream(m, numbers, s):
            m.links.append((b, "nothing"))
            numbers[f"G {b} nothing"] = s

            def make(index, record, row, speed, hall):
                i, j = index[a], index[b]
                return lambda T, k: [(j, s * T[:, i])]
            m.feedback = [make]
        return restructured(stream, 0.01 * g, 6 * g, nodes=[a, b])
    if way == "wax_valve":      # what opens as it warms, and cools
        b = pick(rng, [x for x in machine.bodies if x not in machine.air])
        t = of_body(b)
        span, excess = np.ptp(t), max(np.max(t) - min(np.min(r.hall) for r in measured), 1.0)
        if span < 2:
            raise Impossible
        at, width = float(round(np.min(t) + rng.uniform(0.3, 0.65) * span, 2)), float(round(max(0.5, rng.uniform(0.12, 0.3) * span), 2))

        def valve(s, numbers, m):
            def make(index, record, row, speed, hall):
                i = index[b]
                return lambda T, k: [(i, -s * np.clip((T[:, i] - at) / width, 0, 1) * (T[:, i] - hall[:, k]))]
            return make
        return feedback(valve, *bounded(0.01 * g, min(10 * g, steady(b, 1 + excess / width))), node=b, opens_at_degC=at, over_K=width)
    if way == "free_convection":      # a film that grows with the difference to the air
        b = pick(rng, machine.bodies)
        excess = np.max(np.abs(of_body(b) - np.mean(np.concatenate([r.hall for r in measured]))))
        if excess < 2:
            raise Impossible

        def film(s, numbers, m):
            def make(index, record, row, speed, hall):
                i = index[b]

                def q(T, k):
                    d = T[:, i] - hall[:, k]
                    return [(i, -s * d * np.abs(d) / excess)]
                return q
            return make
        return feedback(film, *bounded(0.01 * g, min(8 * g, steady(b, 2.5))), node=b, at_K=float(excess))
    if way == "fit_tightens":      # a shrink fit, a sleeve: it conducts the better the warmer the inner part is against the outer
        a, b = pick(rng, pairs)
        if np.mean(of_body(a)) < np.mean(of_body(b)):
            a, b = b, a
        most = np.max(of_body(a) - of_body(b))
        if most < 1:
            raise Impossible

        def fit(s, numbers, m):
            def make(index, record, row, speed, hall):
                i, j = index[a], index[b]

                def q(T, k):
                    x = s * np.maximum(T[:, i] - T[:, j], 0) ** 2 / most
                    return [(i, -x), (j, x)]
                return q
            return make
        g0 = joint(a, b)
        return feedback(fit, *bounded(0.02 * g0, min(8 * g0, steady(a, 2.5), steady(b, 2.5))), nodes=[a, b], at_K=float(most))
    if way == "preload_by_difference":      # the shaft grows into the bearing: friction goes by the difference of two bodies
        i = pick(rng, [i for i in speeds if machine.heats[i]["kind"] != "motor_loss"])
        a, at = machine.heats[i]["node"], machine.heats[i]["at"]
        b = pick(rng, beside(machine, a))
        if np.max(np.abs(of_body(a) - of_body(b))) < 1.5:
            raise Impossible

        def preload(s, numbers, m):
            p, e = numbers[f"P {i}"], numbers[f"e {i}"]

            def make(index, record, row, speed, hall):
                x, y = index[a], index[b]
                friction = np.where(speed > 0, p[:, None] * (np.maximum(speed, 1e-9) / at) ** e[:, None], 0.0)
                return lambda T, k: [(x, friction[:, k] * np.clip(s * (T[:, x] - T[:, y]), -0.9, 3))]
            return make
        return feedback(preload, 0.002, 0.25, node=a, against=b)
    if way == "loss_saturates":      # beyond a speed it grows no more: a field that is weakened, a bearing that floats
        i = pick(rng, speeds)
        e, xb = value(f"e {i}"), float(round(rng.uniform(0.3, 0.7), 2))
        above = np.concatenate([r.speed[r.speed > 0] for r in measured]) / plan["top"] > xb
        if not 0.1 < above.mean() < 0.9:
            raise Impossible
        hide(records, "W", lambda r: -((r.speed / plan["top"]) ** e - np.minimum(r.speed / plan["top"], xb) ** e), must_move=False)
        p = value(f"P {i}")
        return [Fault("recorded_drive", dict(node=machine.heats[i]["node"], column=HIDDEN, mode="gain", above_rpm=float(round(xb * plan["top"], 2)), one=len({machine.heats[x]["node"] for x in speeds}) == 1), None, 0.02 * p, 1.1 * p)]
    if way == "power_offset":      # what the drive draws without load counts in the record, and becomes heat elsewhere
        nodes = list(dict.fromkeys(h["node"] for h in machine.heats if h["kind"] == "cutting_heat"))
        change = lambda r, s: Record(r.name, r.time_s, r.speed, r.feeds, np.maximum(r.power - s * plan["power"], 0.0), r.hall, r.columns)
        return [Fault("record_change", dict(nodes=nodes, change=change), None, 0.01, 0.5)]
    if way == "coasts_down":      # it is switched off, and turns on
        nodes = {machine.heats[i]["node"] for i in speeds}
        if not any(np.any(np.diff(r.speed) < -0.2 * plan["top"]) for r in measured):
            raise Impossible
        return [Fault("record_change", dict(place="spindle", driven=sorted(nodes), change=lambda r, s: truly(r, speed=coasting(r, plan["top"], max(s, 1e-6)))), None, 0.004 * shortest / 60, 0.25 * shortest / 60)]
    if way == "chip_heap":      # it grows as the machine works, and is removed when the machine rests for long
        works = [i for i, h in enumerate(machine.heats) if h["kind"] == "cutting_heat"] or speeds or servos
        i, long = pick(rng, works), rng.uniform(0.03, 0.08) * shortest

        def heap(r):
            out, x, stood = np.zeros(len(r.time_s)), 0.0, 0.0
            on, y = np.asarray(runs(machine, r), bool), level(machine, plan, i, r)
            for k in range(len(out)):
                stood = 0.0 if on[k] else stood
                x = 0.0 if stood >= long else x
                out[k] = x
                h = r.time_s[min(k + 1, len(out) - 1)] - r.time_s[k]
                x, stood = x + y[k] * h / shortest, stood + (0.0 if on[k] else h)
            return out
        hide(records, "W", heap)
        top = max(r.columns[HIDDEN][1].max() for r in measured)
        for r in records:
            r.columns[HIDDEN] = ("W", r.columns[HIDDEN][1] / top)
        return gain(pick(rng, [b for b in machine.bodies if b not in machine.air]), 0.01, 4, swept_after_min=round(long / 60, 2), recorded=i not in speeds)
    if way == "filter_clogs":      # dust on fins or in a filter, by the time that the machine has run, from record to record
        node = pick(rng, [a for a, b in machine.links if b == "hall"])
        total = sum(r.time_s[-1] for r in measured)
        hours, before = rng.uniform(0.2, 0.8) * total, 0.0
        for r in records:
            on = np.asarray(runs(machine, r), float)
            ran = before + np.append(0.0, np.cumsum(np.diff(r.time_s) * on[:-1]))
            before = ran[-1]
            r.columns[HIDDEN] = ("1", np.round(12 * (1 - np.exp(-ran / hours))) / 12)
        if not any(np.ptp(r.columns[HIDDEN][1]) > 0.2 for r in measured):
            raise Impossible
        return [Fault(way, dict(node=node, column=HIDDEN, runs_h=round(hours / 3600, 3)), None, 0.03, 0.95)]
    if way == "jams":      # the floating end of a bearing or a scale that sticks above a temperature
        channel, _, nodes = machine.displacements[int(rng.integers(len(channels)))]
        body = pick(rng, nodes)
        t = of_body(body)
        if np.ptp(t) < 1:
            raise Impossible
        return [Fault(way, dict(channel=channel, body=body, above_degC=float(round(np.min(t) + rng.uniform(0.3, 0.65) * np.ptp(t), 2))), None, 0.03, 1.3)]
    if way == "rate_bending":      # a thick part bends while it warms: its skin is ahead of its core
        return [Fault(way, dict(channel=pick(rng, channels), body=pick(rng, machine.bodies + ["hall"]), lag_s=round(tau(0.02, 0.25), 1)), None, 0.05, 60, sign)]
    # --- instruments ---
    if way == "ratchet":      # each start moves it a little
        def starts(r):
            on = np.asarray(runs(machine, r), bool)
            return machine.t_ref + np.cumsum(np.append(False, on[1:] & ~on[:-1]))
        hide(records, "degC", starts)
        return [Fault("displacement_path", dict(channel=pick(rng, channels), column=HIDDEN, lag_min=0.0), None, 0.02, 20, sign)]
    if way == "amplifier_warms":      # it is switched on with the record
        k = int(rng.integers(1, len(sensors) + 1))
        return [Fault(way, dict(card=sensors[:k], fades_s=round(tau(0.02, 0.25), 1)), None, 0.03, 6, sign)]
    if way == "hall_clock":      # the hall's temperature comes from another logger with another clock
        if max(np.ptp(r.hall) for r in measured) < 1:
            raise Impossible
        return [Fault("record_change", dict(place="clock", change=lambda r, s: truly(r, hall=np.interp(r.time_s - 60 * s, r.time_s, r.hall))), None, 0.004 * shortest / 60, 0.3 * shortest / 60, sign)]
    if way == "tilted_indicator":      # it feels a share of another direction
        a, b = two(channels)
        return [Fault(way, dict(channel=a, other=b), None, 0.01, 3, sign)]
    if way == "hall_in_exhaust":      # the hall's thermometer hangs in what the machine blows out: it is colder than it says while the machine runs
        slow = tau(0.005, 0.05)

        def cooler(r, s):
            on, x, out = np.asarray(runs(machine, r), float), 0.0, np.zeros(len(r.time_s))
            for k in range(1, len(out)):
                x = on[k - 1] + (x - on[k - 1]) * np.exp(-(r.time_s[k] - r.time_s[k - 1]) / slow)
                out[k] = x
            return truly(r, hall=r.hall - s * out)
        return [Fault("record_change", dict(place="hall", change=cooler, slow_min=round(slow / 60, 2)), None, 0.2, 9)]
    return fifth_faults.draw(rng, way, machine, plan, records, column)


def told_alike(way, fault, machine, plan, records, judge, scale):
    """As in eighth_faults.py; where a whole card is off, the ambient is tried, too."""
    return eighth_faults.told_alike("recalibrated" if way in ("amplifier_warms", "crosstalk") else way, fault, machine, plan, records, judge, scale)


def told(way, hidden, machine, records, worth, alike):
    """The entries of truth.json. `parameters` of what is new is empty, and `sizes` says how large it is: no interval is judged by it."""
    if way not in NAMES:
        out = eighth_faults.told(way, hidden, machine, records, worth, alike)
        for e in out:
            e["sayable"] = True
        return out
    f = hidden[0]
    d, (key, further) = f.data, NAMES[way]
    hidden_words = ("sensor", "column", "mode", "change", "place", "by_record", "card", "channel", "one", "driven", "later", "heats", "channels", "recorded")
    sizes = dict(size=float(f.size[0]), **{k: x for k, x in d.items() if k not in hidden_words})
    nodes = d.get("nodes") or [d[k] for k in ("node",) if k in d]
    film = lambda names, at: [(x, a) for a in at for x in names] + [("link", a + ",hall") for a in at]
    also = []
    if way in ("two_feet", "circuit_also", "wax_valve", "free_convection", "filter_clogs", "lid_over_two"):
        where = nodes[0] + (",hall" if way in ("two_feet", "lid_over_two") else "")
        if way == "lid_over_two":
            also = [(key, a + ",hall") for a in nodes]
            also += film(FILM, nodes) if f.every is None and len(f.own_windows) == 1 else []
        else:
            also = film(further, nodes)
        if way == "two_feet":
            also += [("link", ",".join(nodes)), ("contact", ",".join(nodes))]
    elif way in ("clamped_at_rest", "one_way_stream", "fit_tightens"):
        pair = [d["a"], d["b"]] if way == "clamped_at_rest" else nodes
        where = ",".join(pair)
        also = [(x, where) for x in further]
        if way == "one_way_stream":      # it is a stream that the second body gets
            also.append(("coolant", pair[1]))
    elif way == "crosstalk":
        where, also = d["wrong"][0], [(key, n) for n in d["wrong"]]
    elif way == "amplifier_warms":
        where, also = d["card"][0], [(k, n) for n in d["card"] for k in [key] + further]
    elif way == "stand_on_machine":
        where = d["channels"][0]
        also = [x for c in d["channels"] for x in ((key, c), ("expansion", f"{d['stand']},{c}"))]
    elif way in ("many_stops", "coasts_down"):
        where, also = "spindle", [(x, "spindle") for x in further]
        if way == "coasts_down" and len(d["driven"]) == 1:
            also += [(x, d["driven"][0]) for x in ("heat_source", "friction_law")]
    elif way in ("hall_clock", "hall_in_exhaust"):
        where = d["place"]
        also = [(x, "hall") for x in further] + ([("ambient", "hall"), ("sensor_lag", "hall")] if way == "hall_clock" else [])
    elif way == "jams":
        where, also = f"{d['body']},{d['channel']}", [(x, d["channel"]) for x in further]
    elif way in ("rate_bending", "ratchet", "tilted_indicator"):
        where = d["channel"]
        also = [(x, where) for x in further]
    else:
        where = nodes[0]
        also = [(k, n) for n in nodes for k in [key] + further]
        if way == "holding_torque" and d["of_axis"] != "spindle":      # the feed is a recorded column
            also.append(("recorded_drive", where))
        if way == "chip_heap" and d["recorded"]:      # it goes by a recorded power or feed
            also.append(("recorded_drive", where))
        if way == "bearing_damage" and len(d["later"]) < len({r.name for r in records} - {"holdout_1"}):
            also.append(("run_state", ",".join(d["later"])))
        if way == "loss_saturates" and d["one"]:
            also.append(("speed_override", "spindle"))
    also = [x for i, x in enumerate(also) if x != (key, where) and x not in also[:i]]
    e = dict(key=key, where=where, parameters=[], sizes=sizes, records=f.records or "all", nats=round(float(worth[0]), 2), also=[dict(effect=x, where=y) for x, y in also], sayable=way not in UNSAYABLE)
    if way == "many_stops":
        e["windows_min"] = [[t / 60, t / 60 + float(f.size[0])] for t in d["starts_s"]]
    if way == "lid_over_two":
        e["windows_min"] = [[a / 60, b / 60] for a, b in (f.own_windows if f.every is None else f.windows(records[0]))]
    for others in alike:
        known = {(key, where)} | set(also)
        fresh = [x for i, x in enumerate(others) if x not in known and x not in others[:i]]
        e["also"] += [dict(effect=x, where=y) for x, y in fresh]
        e["also_as_data_cannot_tell"] = [list(x) for x in fresh]
    return [e]
