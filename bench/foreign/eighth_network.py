"""network.py's truth, and seventh_network.py's, with what only the set `eighth` hides (eighth_faults.py); importing it lets the judges of sizes (nats.py, refitted.py) and check.py use it, in this process alone.

    restructured     the machine has other bodies, paths or heats than the model: `change(machine, numbers, size)` alters a copy of it
    begun_warm       some bodies are warmer or colder by so much as the record begins than the scenario's start has it
    pump_rests       a circuit takes by a share less while a column is 1
    bending          a displacement follows the difference of two bodies
    many_readings    thermometers, or displacements, are off by stated shares of one size, from a time on
    all_in_air       all thermometers read a share of the ambient
    logger_mean      every reading is the mean of so many minutes before it
    play             a displacement follows only after a change of more than this amount
    range_end        a channel reads no more than `top` minus the size
"""
import copy

import numpy as np

import check
import nats
import refitted
import seventh_network
from network import Record
from seventh_network import part

FIRST_s = 0.01     # within it, before the first row, bodies are brought to what they begin with


def altered(fault, machine, numbers):
    """The machine of the truth and its numbers."""
    machine, numbers = copy.copy(machine), dict(numbers)
    machine.bodies, machine.links, machine.circuits, machine.heats = (list(x) for x in (machine.bodies, machine.links, machine.circuits, machine.heats))
    fault.data["change"](machine, numbers, fault.size)
    return machine, numbers


def begun_warm(machine, numbers, record, fault):
    """The record with a short first step before it, and faults that bring the bodies' heat in it."""
    first = lambda x: np.append(x[:1], x)
    columns = {k: (u, first(x)) for k, (u, x) in record.columns.items()}
    columns["untold_start"] = ("W", np.append(1 / FIRST_s, np.zeros(len(record.time_s))))
    out = Record(record.name, np.append(0.0, record.time_s + FIRST_s), first(record.speed), {a: first(f) for a, f in record.feeds.items()}, first(record.power), first(record.hall), columns)
    return out, [part(fault, "recorded_drive", fault.size * numbers["C " + b], node=b, column="untold_start", mode="gain") for b in fault.data["nodes"]]


def unfolded(f, machine, numbers):
    if f.key == "bending":
        return [part(f, "displacement_path", x * f.size, channel=f.data["channel"], node=b, lag_min=0.0) for b, x in zip(f.data["nodes"], (1.0, -1.0))]
    if f.key == "pump_rests":
        stream = numbers["flow " + f.data["node"]] / 60 * 3800.0
        less = -np.minimum(f.size, 0.97) * stream * (1 - np.exp(-numbers["passage " + f.data["node"]] / stream))
        return [part(f, "recorded_drive", less, node=f.data["node"], column=f.data["on"], mode="opening"), part(f, "recorded_drive", less, node=f.data["node"], column=f.data["excess"], mode="gain")]
    return [f]


def simulate(machine, numbers, record, faults=(), offset_K=0.0):
    faults = [f for f in faults if f.holds(record.name)]
    for f in (f for f in faults if f.key == "restructured"):
        machine, numbers = altered(f, machine, numbers)
    instruments = ("many_readings", "all_in_air", "logger_mean", "play", "range_end")
    inner, run, warm = [], record, [f for f in faults if f.key == "begun_warm"]
    for f in faults:
        if f.key not in ("restructured", "begun_warm") + instruments:
            inner += unfolded(f, machine, numbers)
    if warm:
        run, more = begun_warm(machine, numbers, record, warm[0])
        inner += more
    temperatures, displacements = seventh_network.simulate(machine, numbers, run, inner, offset_K)
    if warm:
        temperatures, displacements = temperatures[:, 1:], displacements[:, 1:]
    names, channels, t = [n for n, _ in machine.sensors], [d[0] for d in machine.displacements], record.time_s

    def of(channel):
        return (temperatures, names.index(channel)) if channel in names else (displacements, channels.index(channel))
    for f in faults:
        s = f.size[:, None]
        if f.key == "many_readings":
            for channel, w in zip(f.data["channels"], f.data["shares"]):
                a, i = of(channel)
                a[:, :, i] += w * s * (t >= f.data["begin_s"] - 1e-7)
        elif f.key == "all_in_air":
            air = record.hall + np.reshape(offset_K, (-1, 1))
            temperatures += s[:, :, None] * (air[:, :, None] - temperatures)
        elif f.key == "logger_mean":
            for a in (temperatures, displacements):
                total = np.concatenate([np.zeros_like(a[:, :1]), np.cumsum(0.5 * (a[:, 1:] + a[:, :-1]) * np.diff(t)[:, None], axis=1)], axis=1)
                slope = np.diff(a, axis=1) / np.diff(t)[:, None]
                old = a.copy()
                for v, minutes in enumerate(f.size):
                    begin = np.maximum(t[1:] - 60 * minutes, t[0])
                    k = np.clip(np.searchsorted(t, begin, side="right") - 1, 0, len(t) - 2)
                    x = (begin - t[k])[:, None]
                    a[v, 1:] = (total[v, 1:] - total[v, k] - old[v, k] * x - 0.5 * slope[v, k] * x ** 2) / (t[1:] - begin)[:, None]
        elif f.key == "play":
            i = channels.index(f.data["channel"])
            u = displacements[:, :, i].copy()
            for k in range(1, u.shape[1]):
                displacements[:, k, i] = np.clip(displacements[:, k - 1, i], u[:, k] - f.size, u[:, k] + f.size)
        elif f.key == "range_end":
            a, i = of(f.data["channel"])
            a[:, :, i] = np.minimum(a[:, :, i], f.data["top"] - s)
    return temperatures, displacements


check.simulate = nats.simulate = refitted.simulate = simulate
