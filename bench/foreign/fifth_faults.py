"""What is hidden in the set `fifth`: kinds of the sets before and six that none of them has (README.md). One way of being wrong may be two faults, or follow a column that no record contains."""
import copy

import numpy as np

import fourth_faults
import third_faults
from faults import Fault, Impossible, largest_heat, pick, typical_link
from network import Record

# Ways of class A, each as often as it comes; effects of C and D, and those of them that hold in two records of four or five.
WAYS_A = ["two_links"] * 3 + ["sensor_moved"] * 3 + ["feed_law"] * 2 + ["power_square"] * 2 + ["run_on"] * 2 + ["hidden_body"] * 2 + ["exchange_window"] * 2
WAYS_A += ["link", "heat_window", "heat_from", "column_heat", "column_opening", "body_growth", "spindle_growth", "run_state"]
SOME_RECORDS = dict(some_records_of_parts=["heat_source", "convection", "contact"], some_records_of_instruments=["sensor_bias", "sensor_lag", "expansion", "scale_expansion"],
                    some_records_of_drives=["ambient", "clock_offset", "speed_override"])
KINDS_C = third_faults.KINDS_C
N_RECORDS = {**{k: [4, 5] for k in SOME_RECORDS}, "sensor_moved": [3, 4, 5], "run_state": [3, 4, 5]}
HIDDEN = "untold"      # a column that acts, and that no file has


def known_to_all(record):
    """The record as the logger has it."""
    return Record(record.name, record.time_s, record.speed, record.feeds, record.power, record.hall, {k: x for k, x in record.columns.items() if k != HIDDEN})


def hide(records, unit, values):
    for r in records:
        r.columns[HIDDEN] = (unit, values(r))
        if not np.ptp(r.columns[HIDDEN][1]) > 0:
            raise Impossible


def rests(record):
    """[begin, end] of all times at which speed, power and feeds are nothing, but for one that begins with the record."""
    moving = (record.speed > 0) | (record.power > 0)
    for f in record.feeds.values():
        moving = moving | (f > 0)
    edges = np.flatnonzero(np.diff(moving.astype(int)))
    times = record.time_s[edges + 1]
    begins, ends = times[moving[edges]], list(times[~moving[edges]]) + [1.02 * record.time_s[-1]]
    return [(float(a), float(min(e for e in ends if e > a))) for a in begins]


def happened(rng, records):
    """When: at the rests of the drive in one record (a lid that is opened then), once from somewhere until the end or before it, or every so often in all records."""
    measured = [r for r in records if r.name != "holdout_1"]
    r, kind = pick(rng, measured), pick(rng, ["rests", "once", "every"])
    total = r.time_s[-1]
    if kind == "rests":
        windows = [w for w in rests(r) if w[1] - w[0] > 0.02 * total]
        if not 1 <= len(windows) <= 5 or sum(b - a for a, b in windows) > 0.7 * total:
            raise Impossible
        return dict(windows=windows, records=[r.name])
    if kind == "once":
        a = rng.uniform(0.05, 0.7)
        return dict(windows=[(float(round(a * total)), float(round((a + rng.uniform(0.06, 0.4)) * total)))], records=[r.name])
    period = rng.uniform(0.15, 0.4) * min(x.time_s[-1] for x in records)
    return dict(all_windows=(float(round(period)), float(round(rng.uniform(0.1, 0.9) * period)), float(round(rng.uniform(0.2, 0.5) * period))))


def draw(rng, way, machine, plan, records, column):
    """The faults that this way of being wrong consists of; some put a column into `records` that no file has."""
    names = [r.name for r in records if r.name != "holdout_1"]
    sign = 1.0 if rng.random() < 0.5 else -1.0
    watts, g = largest_heat(machine, plan), typical_link(machine)
    if way == "two_links":
        pairs = {frozenset(x) for x in machine.links}
        a = pick(rng, machine.bodies)
        free = [x for x in machine.bodies + ["hall"] if x != a and frozenset((a, x)) not in pairs]
        if len(free) < 2:
            raise Impossible
        return [Fault("link", dict(a=a, b=free[int(i)]), low=0.01 * g, high=8 * g) for i in rng.choice(len(free), 2, replace=False)]
    if way == "sensor_moved":
        sensor, body = pick(rng, machine.sensors)
        return [Fault("sensor_place", dict(sensor=sensor, other=pick(rng, [b for b in machine.bodies if b != body])), names[2:] + ["holdout_1"], 0.1, 1.0)]
    if way == "feed_law":
        i = pick(rng, [i for i, h in enumerate(machine.heats) if h["kind"] == "servo_loss" and h["has_exponent"]])
        return [Fault("friction_law", dict(heat=i, node=machine.heats[i]["node"]), None, 0.08, 1.8 if sign > 0 else machine.numbers[f"e {i}"][0] - 0.05, sign)]
    if way == "power_square":
        i = pick(rng, [i for i, h in enumerate(machine.heats) if h["kind"] == "cutting_heat"])
        share = machine.numbers[f"P {i}"][0]
        hide(records, "W", lambda r: r.power ** 2 / plan["power"])
        return [Fault("recorded_drive", dict(node=machine.heats[i]["node"], column=HIDDEN, unit="W", mode="gain", of_heat=i), None, 0.02 * share, 0.85 * share if sign < 0 else min(3 * share, 0.95 - share), sign)]
    if way == "run_on":
        minutes = float(round(rng.uniform(0.015, 0.08) * min(r.time_s[-1] for r in records) / 60, 1))

        def blows(r):
            last = np.maximum.accumulate(np.where(r.speed > 0, np.append(r.time_s[1:], r.time_s[-1]), -1e9))
            return ((r.speed > 0) | (r.time_s - last < 60 * minutes)).astype(float)
        if not machine_turns(machine):
            raise Impossible
        hide(records, "1", blows)
        return [Fault("recorded_drive", dict(node=pick(rng, machine.bodies), column=HIDDEN, unit="1", mode="opening", run_on_min=minutes), None, 0.01 * g, 8 * g)]
    if way in SOME_RECORDS:
        fault = copy.copy(third_faults.draw(rng, pick(rng, SOME_RECORDS[way]), machine, plan, records, None))
        fault.data = {**fault.data, **({"from_s": 0.0} if "from_s" in fault.data else {})}
        while True:
            fault.records = sorted(str(x) for x in rng.choice(names, 2, replace=False))
            if fault.records != names[-2:]:
                return [fault]
    if way == "exchange_window":
        a = pick(rng, machine.bodies)
        b = pick(rng, [x for x in machine.bodies if x != a]) if rng.random() < 0.3 else "hall"
        return [Fault(way, dict(a=a, b=b), low=0.01 * g, high=15 * g, **happened(rng, records))]
    if way == "heat_window":
        return [Fault(way, dict(what="heat", node=pick(rng, machine.bodies)), low=0.01 * watts, high=4 * watts, sign=1.0 if rng.random() < 0.75 else -1.0, **happened(rng, records))]
    return [fourth_faults.draw(rng, way, machine, plan, records, column)]


def machine_turns(machine):
    return any(h["has_exponent"] and h["kind"] not in ("servo_loss", "cutting_heat") for h in machine.heats)


def told(way, hidden, machine, records, worth):
    """The entries of truth.json. Where a further name counts as right, or either of two, `parameters` is empty and `sizes` says how large it is: no interval is judged by it."""
    if way == "two_links":
        out = [third_faults.told(f, machine, records, w) for f, w in zip(hidden, worth)]
        names = [[dict(effect=e["key"], where=e["where"])] + e["also"] for e in out]
        for e, other, f in zip(out, reversed(names), hidden):
            own = {(x["effect"], x["where"]) for x in e["also"]} | {(e["key"], e["where"])}
            e.update(also=e["also"] + [x for x in other if (x["effect"], x["where"]) not in own], parameters=[], sizes=dict(conductance_W_K=float(f.size[0])))
        return out
    if way in ("power_square", "run_on"):
        f, node = hidden[0], hidden[0].data["node"]
        if way == "power_square":
            key, also, sizes = "recorded_drive", ["heat_source"], dict(watts_per_watt_at_full_power=float(f.size[0]))
        else:
            key, also, sizes = "forced_convection", ["exchange_window", "convection", "link", "contact", "recorded_drive"], dict(conductance_W_K=float(f.size[0]), run_on_min=f.data["run_on_min"])
        return [dict(key=key, where=node, parameters=[], sizes=sizes, records="all", nats=round(float(worth[0]), 2), also=[dict(effect=x, where=node) for x in also], node=node)]
    out = [third_faults.told(f, machine, records, w) for f, w in zip(hidden, worth)]
    if way == "feed_law":
        out[0]["also"] += [dict(effect=x, where=out[0]["where"]) for x in ("heat_source", "recorded_drive")]
    if way in SOME_RECORDS and out[0]["key"] in ("heat_source", "convection", "contact", "speed_override"):
        out[0]["also"].append(dict(effect="run_state", where=",".join(hidden[0].records)))
    return out
