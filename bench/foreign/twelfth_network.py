"""The truth of eleventh_network.py for machines that ran before their record begins; importing it lets the judges of sizes (nats.py, refitted.py), check.py and the driver of `eighth` use it, in this process alone.

    before    in a fault's `data`: (record, size) -> the record with what was run before it, and how many rows that has
"""
import copy

import numpy as np

import check
import eighth
import eleventh_network
import nats
import refitted


def simulate(machine, numbers, record, faults=(), offset_K=0.0):
    ran = [f for f in faults if "before" in f.data and f.holds(record.name)]
    if not ran:
        return eleventh_network.simulate(machine, numbers, record, faults, offset_K)
    (fault,), others = ran, [f for f in faults if f not in ran]
    n = len(fault.size)
    offsets, out = np.broadcast_to(np.reshape(offset_K, -1), (n,)), [np.empty((n, len(record.time_s), len(x))) for x in (machine.sensors, machine.displacements)]
    for size in np.unique(fault.size):
        m, some = fault.size == size, [copy.copy(f) for f in others]
        for f in some:
            f.size = f.size[m]
        longer, k = fault.data["before"](record, float(size))
        for a, b in zip(out, eleventh_network.simulate(machine, {i: x[m] for i, x in numbers.items()}, longer, some, offsets[m])):
            a[m] = b[:, k:]
    return tuple(out)


check.simulate = nats.simulate = refitted.simulate = eighth.simulate = simulate
