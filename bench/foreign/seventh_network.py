"""network.py's truth with what only the set `seventh` hides (seventh_faults.py); importing it lets the judges of sizes (nats.py, refitted.py) and check.py use it, in this process alone.

    record_change    the drive or the ambient was another one than the record says: `change` makes the true record of the recorded one, for each size
    heat_moved       a share of a heat that the model has in one body arises in another
    heat_on_two      one heater for two bodies, by stated shares
    two_films        the exchange of two bodies with the ambient, by one factor
    loosening        a joint's conductance falls by one factor from record to record
    bumped           a displacement is shifted, and shifted back later
    wrong_slope      a thermometer reads T + s (T - 20 degC)
    held_reading     a thermometer's channel repeats its last value for a while
    card_bias        all thermometers of one card read so much more or less
    clock_jump       from a time on what is read is logged late (+) or early
"""
import copy

import numpy as np

import check
import nats
import network
import refitted
from faults import Fault


def part(fault, key, size=None, **data):
    out = Fault(key, data, fault.records)
    out.size = fault.size if size is None else size
    return out


def unfolded(faults, record):
    """The same by what network.py knows."""
    out = []
    for f in faults:
        d = f.data
        if f.key == "heat_on_two":
            law = {k: d[k] for k in ("law", "from_s", "at", "exponent") if k in d}
            out += [part(f, "heat_source", w * f.size, node=n, **law) for n, w in zip(d["nodes"], d["shares"])]
        elif f.key == "two_films":
            out += [part(f, "convection", link=link) for link in d["links"]]
        elif f.key == "loosening":
            out.append(part(f, "contact", -d["order"].index(record.name) * f.size, link=d["link"]))
        elif f.key == "bumped":
            out += [part(f, "mount_shift", channel=d["channel"], from_s=d["begin_s"]), part(f, "mount_shift", -f.size, channel=d["channel"], from_s=d["end_s"])]
        else:
            out.append(f)
    return out


def by_body(machine, numbers, record, faults, offset_K):
    """Readings with what changes the machine's structure."""
    for f in (f for f in faults if f.key == "heat_moved"):
        i, new = f.data["heat"], len(machine.heats)
        machine, numbers = copy.copy(machine), dict(numbers)
        machine.heats = machine.heats + [dict(machine.heats[i], node=f.data["node"])]
        for k in ("P", "idle"):
            if f"{k} {i}" in numbers:
                numbers[f"{k} {new}"], numbers[f"{k} {i}"] = f.size * numbers[f"{k} {i}"], (1 - f.size) * numbers[f"{k} {i}"]
        for k in ("e", "decay"):
            if f"{k} {i}" in numbers:
                numbers[f"{k} {new}"] = numbers[f"{k} {i}"]
    return network.simulate(machine, numbers, record, unfolded(faults, record), offset_K)


def simulate(machine, numbers, record, faults=(), offset_K=0.0):
    faults = [f for f in faults if f.holds(record.name)]
    changes = [f for f in faults if f.key == "record_change"]
    if changes:      # the sizes of a call are few: each has its own true record
        n = len(next(iter(numbers.values())))
        offsets = np.broadcast_to(np.reshape(offset_K, -1), (n,))
        temperatures, displacements = (np.empty((n, len(record.time_s), len(x))) for x in (machine.sensors, machine.displacements))
        sizes = np.stack([f.size for f in changes], 1)
        for row in np.unique(sizes, axis=0):
            m = np.all(sizes == row, axis=1)
            true, others = record, []
            for f, s in zip(changes, row):
                true = f.data["change"](true, float(s))
            for f in (f for f in faults if f.key != "record_change"):
                others.append(copy.copy(f))
                others[-1].size = f.size[m]
            temperatures[m], displacements[m] = by_body(machine, {k: x[m] for k, x in numbers.items()}, true, others, offsets[m])
    else:
        temperatures, displacements = by_body(machine, numbers, record, faults, offset_K)
    names, t = [n for n, _ in machine.sensors], record.time_s
    for f in faults:
        s = f.size[:, None]
        if f.key == "wrong_slope":
            i = names.index(f.data["sensor"])
            temperatures[:, :, i] += s * (temperatures[:, :, i] - 20.0)
        elif f.key == "card_bias":
            for name in f.data["sensors"]:
                temperatures[:, :, names.index(name)] += s
        elif f.key == "held_reading":      # of a size between two rows' ends it fades out, so that a reading is no step of the size
            i, k = names.index(f.data["sensor"]), int(np.searchsorted(t, f.data["begin_s"]))
            pace = np.append(np.diff(t), t[-1] - t[-2])
            held = (t >= f.data["begin_s"] - 1e-7) * np.clip((f.data["begin_s"] + 60 * s - t) / pace, 0, 1)
            temperatures[:, :, i] += held * (temperatures[:, k:k + 1, i] - temperatures[:, :, i])
        elif f.key == "clock_jump":
            late = t >= f.data["from_s"] - 1e-7
            for v, minutes in enumerate(f.size):
                at = np.clip(t - 60 * minutes * late, t[0], t[-1])
                for a in (temperatures, displacements):
                    for i in range(a.shape[2]):
                        a[v, :, i] = np.interp(at, t, a[v, :, i])
    return temperatures, displacements


check.simulate = nats.simulate = refitted.simulate = simulate
