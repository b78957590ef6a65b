"""network.py's truth with what only the set `sixth` hides (sixth_faults.py); importing it lets the judges of sizes (nats.py, refitted.py) and check.py use it, in this process alone.

    stream              exchange of a body with a stream that has a temperature of its own, while a column is 1 (`on`); `excess` is, in K, its temperature then over the recorded hall's
    ambient_window      the true hall is another one between two times
    sensor_with_drive   a thermometer's error while a column is 1
    sensor_loose        while a column is 1 a thermometer reads a share of the air
    clock_rate          what is read is logged ever later (+) or earlier against the drive: the clocks go at rates that differ by this
"""
import numpy as np

import check
import nats
import network
import refitted
from faults import Fault


def part(fault, key, sign=1.0, **data):
    out = Fault(key, data, fault.records)
    out.size = sign * fault.size
    return out


def unfolded(faults):
    """The same by what network.py knows."""
    out = []
    for f in faults:
        if f.key == "stream":
            out += [part(f, "recorded_drive", node=f.data["node"], column=f.data["on"], mode="opening"), part(f, "recorded_drive", node=f.data["node"], column=f.data["excess"], mode="gain")]
        elif f.key == "ambient_window":
            out += [part(f, "ambient", from_s=f.data["begin_s"]), part(f, "ambient", -1.0, from_s=f.data["end_s"])]
        else:
            out.append(f)
    return out


def simulate(machine, numbers, record, faults=(), offset_K=0.0):
    temperatures, displacements = network.simulate(machine, numbers, record, unfolded(faults), offset_K)
    names = [n for n, _ in machine.sensors]
    for f in (f for f in faults if f.holds(record.name)):
        if f.key in ("sensor_with_drive", "sensor_loose"):
            i, on, s = names.index(f.data["sensor"]), record.columns[f.data["column"]][1], f.size[:, None]
            air = record.hall + np.reshape(offset_K, (-1, 1))
            temperatures[:, :, i] += s * on * (1.0 if f.key == "sensor_with_drive" else air - temperatures[:, :, i])
        elif f.key == "clock_rate":
            for v, s in enumerate(f.size):
                for a in (temperatures, displacements):
                    for i in range(a.shape[2]):
                        a[v, :, i] = np.interp(record.time_s * (1 - s), record.time_s, a[v, :, i])
    return temperatures, displacements


check.simulate = nats.simulate = refitted.simulate = simulate
