"""The truth of eighth_network.py with what only the set `ninth` hides (ninth_faults.py); importing it lets the judges of sizes (nats.py, refitted.py), check.py and the driver of `eighth` use it, in this process alone.

    lid_over_two     two bodies exchange heat with the ambient in the same windows
    two_feet         two bodies are joined to something that keeps its temperature
    column_on_two    a recorded column is heat in two bodies, by stated shares
    exponent_of_two  the heat of two bodies grows with another exponent, by one further exponent
    many_stops       the spindle stopped several times, each as long as the size [min]
    stand_on_machine displacements follow one more body, by stated shares
    filter_clogs     a film takes less by a share of the size, as a column says it
    crosstalk        each thermometer of a card reads a share of the channel before it
    amplifier_warms  thermometers of a card are off as a record begins, which fades
    tilted_indicator a displacement reads a share of another one
    jams             of what a body does to a displacement, a share is missing above a temperature
    rate_bending     a displacement follows how much a body is ahead of its own slow mean
"""
import copy

import numpy as np

import check
import eighth
import eighth_network
import nats
import refitted
from faults import Fault
from network import first_order
from seventh_network import part

READINGS = ("crosstalk", "amplifier_warms", "tilted_indicator", "jams", "rate_bending")


def unfolded(f, numbers):
    d = f.data
    if f.key == "lid_over_two":
        out = [Fault("exchange_window", dict(a=n, b="hall"), f.records, windows=f.own_windows, all_windows=f.every) for n in d["nodes"]]
        for x in out:
            x.size = f.size
        return out
    if f.key == "two_feet":
        return [part(f, "recorded_drive", node=n, column=d["column"], mode="conductance") for n in d["nodes"]]
    if f.key == "column_on_two":
        return [part(f, "recorded_drive", w * f.size, node=n, column=d["column"], mode="gain") for n, w in zip(d["nodes"], d["shares"])]
    if f.key == "exponent_of_two":
        return [part(f, "friction_law", heat=i, node=n) for i, n in zip(d["heats"], d["nodes"])]
    if f.key == "many_stops":
        return [part(f, "missing_stop", np.round(60 * f.size, 4) / 60, start_s=t) for t in d["starts_s"]]      # network.py's events lie on whole microseconds
    if f.key == "stand_on_machine":
        return [part(f, "displacement_path", w * f.size, channel=c, node=d["stand"], lag_min=0.0) for c, w in zip(d["channels"], d["shares"])]
    if f.key == "filter_clogs":
        return [part(f, "recorded_drive", -np.minimum(f.size, 0.97) * numbers[f"G {d['node']} hall"], node=d["node"], column=d["column"], mode="opening")]
    return [f]


def simulate(machine, numbers, record, faults=(), offset_K=0.0):
    faults = [f for f in faults if f.holds(record.name)]
    reading = [f for f in faults if f.key in READINGS]
    looked = [f.data["body"] for f in reading if "body" in f.data]
    seen = machine
    if looked:      # thermometers that nobody has
        seen = copy.copy(machine)
        seen.sensors = machine.sensors + [(f"untold_{i}", b) for i, b in enumerate(looked)]
    inner = [x for f in faults if f.key not in READINGS for x in unfolded(f, numbers)]
    temperatures, displacements = eighth_network.simulate(seen, numbers, record, inner, offset_K)
    bodies, temperatures = temperatures[:, :, len(machine.sensors):], temperatures[:, :, :len(machine.sensors)]
    names, channels, t = [n for n, _ in machine.sensors], [d[0] for d in machine.displacements], record.time_s
    for f in reading:
        s, d = f.size[:, None], f.data
        if f.key == "crosstalk":
            own = temperatures.copy()
            for name, other in zip(d["card"][1:], d["card"]):
                temperatures[:, :, names.index(name)] += s * (own[:, :, names.index(other)] - own[:, :, names.index(name)])
        elif f.key == "amplifier_warms":
            for name in d["card"]:
                temperatures[:, :, names.index(name)] += s * np.exp(-t / d["fades_s"])
        elif f.key == "tilted_indicator":
            displacements[:, :, channels.index(d["channel"])] += s * displacements[:, :, channels.index(d["other"])]
        elif f.key == "jams":
            displacements[:, :, channels.index(d["channel"])] -= s * numbers[f"S {d['channel']} {d['body']}"][:, None] * np.maximum(bodies[:, :, 0] - d["above_degC"], 0)
        elif f.key == "rate_bending":
            y = bodies[:, :, 0]
            displacements[:, :, channels.index(d["channel"])] += s * (y - first_order(t, y, np.full(len(f.size), d["lag_s"]), y[:, 0]))
    return temperatures, displacements


check.simulate = nats.simulate = refitted.simulate = eighth.simulate = simulate
