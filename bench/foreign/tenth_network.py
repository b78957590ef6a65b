"""The truth of ninth_network.py with what only the set `tenth` hides (tenth_faults.py); importing it lets the judges of sizes (nats.py, refitted.py), check.py and the driver of `eighth` use it, in this process alone.

    door_open     several bodies exchange heat with the ambient in the same windows, by stated shares of one conductance
    splash        a body is joined to a stream while a column says so, by one conductance; another column says how much warmer than the ambient the stream is
    ran_before    as the record begins each body is warmer than the scenario's start has it, by a stated share of the size
    in_stream     a thermometer reads a share of the ambient, and a larger one while air blows on it
"""
import numpy as np

import check
import eighth
import eighth_network
import nats
import ninth_network
import refitted
from faults import Fault
from seventh_network import part


def unfolded(f):
    d = f.data
    if f.key == "door_open":
        out = []
        for n, w in zip(d["nodes"], d["shares"]):
            out.append(Fault("exchange_window", dict(a=n, b="hall"), f.records, windows=f.own_windows, all_windows=f.every))
            out[-1].size = w * f.size
        return out
    if f.key == "splash":
        return [part(f, "recorded_drive", node=d["node"], column=d["on"], mode="opening"), part(f, "recorded_drive", node=d["node"], column=d["excess"], mode="gain")]
    return [f]


def simulate(machine, numbers, record, faults=(), offset_K=0.0):
    faults = [f for f in faults if f.holds(record.name)]
    inner, run = [x for f in faults if f.key not in ("ran_before", "in_stream") for x in unfolded(f)], record
    warm = [f for f in faults if f.key == "ran_before"]
    if warm:
        run, more = eighth_network.begun_warm(machine, numbers, record, warm[0])
        for x, w in zip(more, warm[0].data["shares"]):
            x.size = w * x.size
        inner += more
    temperatures, displacements = ninth_network.simulate(machine, numbers, run, inner, offset_K)
    if warm:
        temperatures, displacements = temperatures[:, 1:], displacements[:, 1:]
    for f in faults:
        if f.key == "in_stream":
            i = [n for n, _ in machine.sensors].index(f.data["sensor"])
            share = f.size[:, None] * np.where(record.columns[f.data["blows"]][1] > 0, 1.0, f.data["at_rest"])
            temperatures[:, :, i] += share * (record.hall + np.reshape(offset_K, (-1, 1)) - temperatures[:, :, i])
    return temperatures, displacements


check.simulate = nats.simulate = refitted.simulate = eighth.simulate = simulate
