"""What is hidden in the set `sixth`: kinds of the sets before and fourteen ways of being wrong that none of them has (README.md), some of them by columns that act and that no file has."""
import numpy as np

import fifth_faults
import third_faults
from faults import Fault, Impossible, largest_heat, pick, typical_link
from network import Record

# Ways of class A, each as often as it comes; those of C16 that are new, once each; the older effects of C16, C8 and D.
NEW_A = ["flood", "neighbour", "run_up", "mixed_friction", "running_in", "link_some_days", "work_pieces", "force_path", "turning_joint"]
WAYS_A = ["hidden_body"] * 2 + ["exchange_window"] * 2 + ["link", "heat_window", "speed_windows", "heat_from", "column_heat", "column_opening", "power_gain", "body_growth", "spindle_growth", "run_state", "sensor_place"] + NEW_A
NEW_C = ["ambient_window", "clock_rate", "inverter_error", "loose_thermometer", "mount_creep"]
KINDS_C = [k for k in third_faults.KINDS_C if k != "sensor_swap"]      # which has no size
N_RECORDS = {"link_some_days": [4, 5], "run_state": [3, 4, 5], "running_in": [2, 3]}
WORK = dict(hexapod_mill=["frame", "platform"], honing_machine=["liner", "fixture"], laminating_press=["book", "platen_low"], fatigue_frame=["specimen", "grip_low"], dough_kneader=["dough", "bowl"], roll_grinder=["roll_2", "roll_3", "tailstock"],
            sliding_headstock_lathe=["main_spindle", "sub_spindle"], balancing_machine=["rotor"])      # where work comes to
HIDDEN = "untold"      # columns of this name, or that begin with it, act and no file has them

# key of truth.json and further names that count as right there; `parameters` is empty and `sizes` says how large it is
NAMES = dict(flood=("coolant", ["exchange_window", "forced_convection", "recorded_drive", "convection", "link", "contact"]), neighbour=("heat_window", ["heat_source"]), run_up=("heat_source", ["heat_window", "friction_law"]),
             mixed_friction=("heat_source", ["friction_law"]), running_in=("heat_source", ["heat_window", "friction_law"]), force_path=("displacement_path", ["spindle_growth", "centrifugal"]),
             work_pieces=("exchange_window", ["mass_change", "hidden_body", "heat_capacity", "heat_window", "convection", "link", "contact"]), ambient_window=("ambient", []), clock_rate=("clock_offset", []),
             inverter_error=("sensor_bias", ["sensor_place"]), loose_thermometer=("sensor_detached", ["sensor_place"]), mount_creep=("mount_shift", ["displacement_path"]))


def known_to_all(record):
    """The record as the logger has it."""
    return Record(record.name, record.time_s, record.speed, record.feeds, record.power, record.hall, {k: x for k, x in record.columns.items() if not k.startswith(HIDDEN)})


def hide(records, unit, values, name=HIDDEN, must_move=None):
    """must_move: the records in which the column has to do so (all of them)."""
    for r in records:
        r.columns[name] = (unit, np.asarray(values(r), float))
        if (must_move is None or r.name in must_move) and not np.ptp(r.columns[name][1]) > 0:
            raise Impossible


def runs(machine, record):
    """Where the machine is driven: it turns, or what is recorded of power or feeds is more than nothing."""
    if fifth_faults.machine_turns(machine):
        return record.speed > 0
    return (record.power > 0) | np.any([f > 0 for f in record.feeds.values()] or [record.power > 0], axis=0)


def draw(rng, way, machine, plan, records, column):
    """The faults that this way of being wrong consists of; some put columns into `records` that no file has."""
    measured = [r for r in records if r.name != "holdout_1"]
    names = [r.name for r in measured]
    shortest = min(r.time_s[-1] for r in records)
    sign = 1.0 if rng.random() < 0.5 else -1.0
    watts, g = largest_heat(machine, plan), typical_link(machine)
    speeds = [i for i, h in enumerate(machine.heats) if h["has_exponent"] and h["kind"] not in ("servo_loss", "cutting_heat")]      # heats that follow the speed
    turning, powered, channels = fifth_faults.machine_turns(machine), "power" in plan, [d[0] for d in machine.displacements]
    if (way in ("run_up", "mixed_friction", "running_in", "turning_joint", "loose_thermometer") and not turning) or (way == "force_path" and not (powered and channels)) or (way == "mount_creep" and not channels):
        raise Impossible
    if way in ("inverter_error", "loose_thermometer") and not machine.sensors:
        raise Impossible
    if way == "flood":      # it runs over a body while something is cut, or while the machine runs
        warm = float(round(rng.uniform(8, 32), 1))
        if min(abs(warm - np.mean(r.hall)) for r in measured) < 3:
            raise Impossible
        on = (lambda r: r.power > 0.3 * plan["power"]) if powered else (lambda r: runs(machine, r))
        hide(records, "1", on)
        hide(records, "W", lambda r: on(r) * (warm - r.hall), HIDDEN + "_2")
        return [Fault("stream", dict(node=pick(rng, machine.bodies), on=HIDDEN, excess=HIDDEN + "_2", degC=warm), None, 0.01 * g, 8 * g)]
    if way == "neighbour":      # at its own times on each day, the holdout's too
        def times(r):
            out, t = np.zeros(len(r.time_s)), rng.uniform(0.03, 0.3)
            while t < 0.95:
                length = rng.uniform(0.06, 0.25)
                out[(r.time_s >= t * r.time_s[-1]) & (r.time_s < (t + length) * r.time_s[-1])] = 1.0
                t += length + rng.uniform(0.08, 0.4)
            return out
        hide(records, "W", times)
        return [Fault("recorded_drive", dict(node=pick(rng, machine.bodies), column=HIDDEN, mode="gain"), None, 0.01 * watts, 4 * watts)]
    if way == "run_up":      # an energy at each change of speed, as large as that of the rotor's change, within a row
        pace = float(np.median(np.diff(records[0].time_s)))
        hide(records, "W", lambda r: np.append(0.0, np.abs(np.diff((r.speed / plan["top"]) ** 2))) * pace / np.append(np.diff(r.time_s), pace))
        return [Fault("recorded_drive", dict(node=machine.heats[pick(rng, speeds)]["node"], column=HIDDEN, mode="gain", pace_s=pace), None, 0.05 * watts, 40 * watts)]
    if way == "mixed_friction":      # boundary lubrication: more at low speeds
        at = rng.uniform(0.15, 0.4) * plan["top"]
        i = pick(rng, [i for i in speeds if machine.heats[i]["kind"] != "motor_loss"])
        hide(records, "W", lambda r: (r.speed > 0) * np.exp(-(r.speed / at) ** 2))
        if not all(np.max(r.columns[HIDDEN][1]) > 0.2 for r in measured):
            raise Impossible
        return [Fault("recorded_drive", dict(node=machine.heats[i]["node"], column=HIDDEN, mode="gain", at_speed=float(at)), None, 0.01 * watts, 4 * watts)]
    if way == "running_in":      # new grease: what a bearing loses beside its law fades with the time that it has turned, from record to record
        i = pick(rng, [i for i in speeds if machine.heats[i]["kind"] != "motor_loss"])
        tau, turned = rng.uniform(0.15, 0.7) * shortest, {}
        before = 0.0
        for r in records:
            steps = np.append(0.0, np.diff(r.time_s) * (r.speed[:-1] > 0))
            turned[r.name] = before + np.cumsum(steps)
            before = turned[r.name][-1]
        exponent = machine.numbers[f"e {i}"][0]
        hide(records, "W", lambda r: (r.speed / plan["top"]) ** exponent * np.exp(-turned[r.name] / tau), must_move=names[:1])
        p = machine.numbers[f"P {i}"][0]
        return [Fault("recorded_drive", dict(node=machine.heats[i]["node"], column=HIDDEN, mode="gain", fades_h=float(round(tau / 3600, 3))), None, 0.05 * p, 6 * p)]
    if way == "link_some_days":      # a bracket, a hose or a cable that somebody puts there on some days
        fault = third_faults.draw(rng, "link", machine, plan, records, None)
        while True:
            fault.records = sorted(str(x) for x in rng.choice(names, int(rng.integers(2, len(names) - 1)), replace=False))
            if fault.records != names[-len(fault.records):]:
                return [fault]
    if way == "work_pieces":      # one after another, each as warm as the hall when it comes
        node = pick(rng, WORK.get(machine.family, []))
        capacity = machine.numbers["C " + node][0] * np.exp(rng.uniform(np.log(0.2), np.log(1.5)))
        period = rng.uniform(0.08, 0.25) * shortest
        return [Fault("mass_change", dict(node=node, capacity=capacity, conductance=capacity / (period * np.exp(rng.uniform(np.log(0.1), np.log(1.0))))), None, 0.02, 5, all_windows=(float(round(period)), float(round(rng.uniform(0.1, 0.9) * period)), float(round(rng.uniform(0.35, 0.75) * period))))]
    if way == "force_path":      # what cuts bends, at once
        hide(records, "degC", lambda r: machine.t_ref + r.power / plan["power"])
        return [Fault("displacement_path", dict(channel=pick(rng, channels), column=HIDDEN, lag_min=0.0), None, 0.1, 80, sign)]
    if way == "turning_joint":      # the film in a bearing takes more heat across the faster it turns
        if max(len(np.unique(r.speed)) for r in records) > 14:
            raise Impossible      # each speed is a network of its own
        return [Fault("forced_convection", dict(link=pick(rng, [x for x in machine.links if x[1] != "hall" and {machine.heats[i]["node"] for i in speeds} & set(x)]), at=float(plan["top"] / 4)), None, 0.05, 2.5)]
    if way == "ambient_window":      # an open gate on the machine's side of the hall
        r = pick(rng, measured)
        begin, length = rng.uniform(0.08, 0.65), rng.uniform(0.1, 0.35)
        return [Fault("ambient_window", dict(begin_s=float(round(begin * r.time_s[-1])), end_s=float(round((begin + length) * r.time_s[-1]))), [r.name], 0.3, 9, sign)]
    if way == "clock_rate":
        return [Fault(way, {}, [pick(rng, names)], 0.001, 0.15, sign)]
    if way == "inverter_error":      # a lead that picks up the drive
        hide(records, "1", lambda r: runs(machine, r))
        return [Fault("sensor_with_drive", dict(sensor=pick(rng, machine.sensors)[0], column=HIDDEN), None, 0.03, 6, sign)]
    if way == "loose_thermometer":      # it shakes when the machine turns fast
        at = rng.uniform(0.3, 0.6) * plan["top"]
        hide(records, "1", lambda r: r.speed > at)
        return [Fault("sensor_loose", dict(sensor=pick(rng, machine.sensors)[0], column=HIDDEN, above_rpm=float(round(at))), None, 0.03, 0.95)]
    if way == "mount_creep":      # a stand that was clamped or glued just before
        r = pick(rng, measured)
        tau = rng.uniform(0.04, 0.3) * r.time_s[-1]
        hide(records, "degC", lambda x: machine.t_ref + 1 - np.exp(-x.time_s / tau))
        return [Fault("displacement_path", dict(channel=pick(rng, channels), column=HIDDEN, lag_min=0.0, creeps_min=float(round(tau / 60, 2))), [r.name], 0.1, 90, sign)]
    return fifth_faults.draw(rng, way, machine, plan, records, column)


def told(way, hidden, machine, records, worth):
    """The entries of truth.json. Where no key says the law, `parameters` is empty and `sizes` says how large it is: no interval is judged by it."""
    f = hidden[0] if hidden else None
    if way == "turning_joint":
        a, b = f.data["link"]
        also = [("link", f"{a},{b}"), ("forced_convection", a), ("forced_convection", b)]
        return [dict(key="contact", where=f"{a},{b}", parameters=[], sizes=dict(exponent=float(f.size[0]), at_speed_rpm=f.data["at"]), records="all", nats=round(float(worth[0]), 2), also=[dict(effect=x, where=y) for x, y in also])]
    if way == "link_some_days":
        out = third_faults.told(f, machine, records, worth[0])
        out["also"] += [dict(effect="exchange_window", where=out["where"]), dict(effect="run_state", where=",".join(f.records))]
        return [out]
    if way in NAMES:
        key, further = NAMES[way]
        where = dict(ambient_window="hall", clock_rate="clock").get(way) or f.data.get("sensor") or f.data.get("channel") or f.data["node"]
        sizes = dict(size=float(f.size[0]), **{k: x for k, x in f.data.items() if k not in ("node", "sensor", "channel", "column", "mode", "on", "excess", "lag_min")})
        out = dict(key=key, where=where, parameters=[], sizes=sizes, records=f.records or "all", nats=round(float(worth[0]), 2), also=[dict(effect=x, where=where) for x in further])
        return [out | ({"node": f.data["node"]} if "node" in f.data else {})]
    return fifth_faults.told(way, hidden, machine, records, worth)
