"""What is hidden in the set `fourth`: the kinds of faults.py and third_faults.py, some of them drawn otherwise, and two that neither had (README.md)."""
import numpy as np

import faults
import third_faults
from faults import Fault, Impossible, largest_heat, pick, typical_link

# Ways of class A, each as often as it comes; of C and D, each at most once in the set.
WAYS_A = ["hidden_body", "hidden_body", "link", "link", "exchange_window", "exchange_window", "heat_window", "speed_windows", "heat_from", "heat_from", "heat_law", "column_heat", "column_warmth", "column_opening",
          "power_gain", "body_growth", "column_path", "spindle_growth", "run_state", "sensor_place", "mass_change", "forced_exchange"]
KINDS_C = [k for k in third_faults.KINDS_C if k != "sensor_swap"]
told = third_faults.told


def spans(rng, record, n):
    """n windows [s] of a record, of any length, in any place; the last may end after it."""
    total = record.time_s[-1]
    cuts = np.sort(rng.uniform(0.01, 1.05, 2 * n))
    lengths, pauses = cuts[1::2] - cuts[::2], cuts[2::2] - cuts[1:-1:2]
    if lengths.min() < 0.03 or lengths.sum() > 0.75 or (n > 1 and pauses.min() < 0.03):
        return spans(rng, record, n)
    return [(float(round(a * total)), float(round(b * total))) for a, b in cuts.reshape(n, 2)]


def happened(rng, records):
    """When and in which records: once in one, a few times in one, at the same times in two, or every so often in all."""
    measured = [r for r in records if r.name != "holdout_1"]
    kind = pick(rng, ["once", "few", "few", "two", "every"])
    if kind == "every":
        period = rng.uniform(0.08, 0.45) * min(r.time_s[-1] for r in records)
        return dict(all_windows=(float(round(period)), float(round(rng.uniform(0.03, 0.9) * period)), float(round(rng.uniform(0.15, 0.6) * period))))
    chosen = [pick(rng, measured)]
    if kind == "two" and len(measured) > 1:
        chosen = [measured[i] for i in rng.choice(len(measured), 2, replace=False)]
    shortest = min(chosen, key=lambda r: r.time_s[-1])
    return dict(windows=spans(rng, shortest, 1 if kind == "once" else int(rng.integers(2, 4))), records=sorted(r.name for r in chosen))


def draw(rng, way, machine, plan, records, column):
    names = [r.name for r in records if r.name != "holdout_1"]
    sign = 1.0 if rng.random() < 0.5 else -1.0
    watts, g = largest_heat(machine, plan), typical_link(machine)
    speeds = [i for i, h in enumerate(machine.heats) if h["has_exponent"] and h["kind"] not in ("servo_loss", "cutting_heat")]
    channels = [d[0] for d in machine.displacements]
    if way == "exchange_window":
        a = pick(rng, machine.bodies)
        b = pick(rng, [x for x in machine.bodies if x != a]) if rng.random() < 0.45 else "hall"
        return Fault(way, dict(a=a, b=b), low=0.01 * g, high=15 * g, **happened(rng, records))
    if way == "heat_window":
        return Fault(way, dict(what="heat", node=pick(rng, machine.bodies)), low=0.01 * watts, high=4 * watts, sign=1.0 if rng.random() < 0.75 else -1.0, **happened(rng, records))
    if way == "speed_windows":
        if not speeds:
            raise Impossible
        name = pick(rng, names)
        return Fault("heat_window", dict(what="speed"), [name], 0.1, 1.1, sign, spans(rng, next(r for r in records if r.name == name), int(rng.integers(1, 4))))
    if way == "heat_from":
        law, name = pick(rng, ["constant"] + (["turning", "power"] if speeds else [])), pick(rng, names)
        total = next(r for r in records if r.name == name).time_s[-1]
        data = dict(node=pick(rng, machine.bodies), law=law, from_s=float(round(rng.uniform(0.08, 0.8) * total)))
        if law == "power":
            data.update(at=float(plan["top"]), exponent=float(pick(rng, [0.5, 1, 1.5, 2, 2.5])))
        return Fault("heat_source", data, [name], 0.01 * watts, 4 * watts, 1.0 if rng.random() < 0.7 else -1.0)
    if way == "power_gain":
        if not any(h["kind"] == "cutting_heat" for h in machine.heats):
            raise Impossible
        return faults.draw(rng, "recorded_drive", machine, plan, records, None, False)
    if way == "column_path":
        if not channels:
            raise Impossible
        lag = float(round(np.exp(rng.uniform(np.log(0.01), np.log(0.12))) * min(r.time_s[-1] for r in records) / 60, 1)) if rng.random() < 0.6 else 0.0
        return Fault("displacement_path", dict(channel=pick(rng, channels), column=column[0], lag_min=lag), low=0.01, high=20, sign=sign)
    if way == "forced_exchange" and max(len(np.unique(r.speed)) for r in records) > 14:
        raise Impossible      # each speed is a network of its own
    way = dict(column_warmth="column_exchange", column_opening="column_exchange").get(way, way)
    return third_faults.draw(rng, way, machine, plan, records, column)
