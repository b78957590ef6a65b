"""The truth of ninth_network.py with faults that carry their own laws (eleventh_faults.py); importing it lets the judges of sizes (nats.py, refitted.py), check.py and the driver of `eighth` use it, in this process alone. What a fault of this set has in its `data`, any of them:

    change    (machine, numbers, size): alters copies of both, as in eighth_network.py
    record    (record, size) -> what really drove the machine; it may have more rows than the record, and is made anew for each size
    parts     (fault, machine, numbers, record) -> faults of the older truths, with their sizes
    looks     bodies, or `hall`, whose temperatures `reads` needs
    reads     (fault, seen): alters the readings of one record
"""
import copy
import types

import numpy as np

import check
import eighth
import nats
import ninth_network
import refitted
from eighth_network import altered
from network import Record


def with_rows(record, times):
    """The record with further rows, at which its drive goes on as it was."""
    t = np.union1d(record.time_s, np.round([x for x in times if 0 < x < record.time_s[-1]], 3))
    k = np.searchsorted(record.time_s, t + 1e-7, side="right") - 1
    return Record(record.name, t, record.speed[k], {a: f[k] for a, f in record.feeds.items()}, record.power[k], np.interp(t, record.time_s, record.hall), {n: (u, x[k]) for n, (u, x) in record.columns.items()})


def simulate(machine, numbers, record, faults=(), offset_K=0.0):
    faults = [f for f in faults if f.holds(record.name)]
    own = [f for f in faults if "way" in f.data]
    driven = [f for f in own if "record" in f.data]
    if driven:
        sizes = np.stack([f.size for f in driven], 1)
        different = np.unique(sizes, axis=0)
        if len(different) > 1:
            n = len(sizes)
            offsets, out = np.broadcast_to(np.reshape(offset_K, -1), (n,)), [np.empty((n, len(record.time_s), len(x))) for x in (machine.sensors, machine.displacements)]
            for row in different:
                m, some = np.all(sizes == row, axis=1), [copy.copy(f) for f in faults]
                for f in some:
                    f.size = f.size[m]
                for a, b in zip(out, simulate(machine, {k: x[m] for k, x in numbers.items()}, record, some, offsets[m])):
                    a[m] = b
            return tuple(out)
    run, inner = record, [f for f in faults if f not in own]
    for f in driven:
        run = f.data["record"](run, float(f.size[0]))
    for f in own:
        if "change" in f.data:
            machine, numbers = altered(f, machine, numbers)
    for f in own:
        if "parts" in f.data:
            inner += f.data["parts"](f, machine, numbers, run)
    looked = sorted({b for f in own for b in f.data.get("looks", [])})
    shown = machine
    if looked:      # thermometers that nobody has
        shown = copy.copy(machine)
        shown.sensors = machine.sensors + [(f"untold_{i}", b) for i, b in enumerate(looked)]
    temperatures, displacements = ninth_network.simulate(shown, numbers, run, inner, offset_K)
    if run is not record:
        k = np.searchsorted(run.time_s, record.time_s - 1e-6)
        temperatures, displacements = temperatures[:, k], displacements[:, k]
    n = len(machine.sensors)
    seen = types.SimpleNamespace(record=record, t=record.time_s, machine=machine, temperatures=temperatures[:, :, :n], displacements=displacements, bodies={b: temperatures[:, :, n + i] for i, b in enumerate(looked)},
                                 sensor=[x for x, _ in machine.sensors].index, channel=[d[0] for d in machine.displacements].index)
    for f in own:
        if "reads" in f.data:
            f.data["reads"](f, seen)
    return seen.temperatures, seen.displacements


check.simulate = nats.simulate = refitted.simulate = eighth.simulate = simulate
