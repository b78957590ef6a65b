#!/usr/bin/python3
"""Writes the cases of the set `twelfth` (README.md), by the driver of `eighth`; how sizes are set is that of third.py.

    twelfth.py FOLDER [--only 7 12] [--seed N]
    twelfth.py --check [--program driftwright]      the nominal machines and what is hidden, as the grammar, another machine or recorded columns say it, against `driftwright simulate`
"""
import eighth      # before numpy: one core

import copy

import numpy as np

import check
import third
import twelfth_families as families
import twelfth_faults as faults
import writing
from families import Draw
from faults import Fault, Impossible
from twelfth_network import simulate

COUNTS = dict(B=8, D=4)      # those of class A: twelfth_faults.WEIGHTS
writing.TITLES.update(families.TITLES)
eighth.families, eighth.faults, eighth.SEED, eighth.__doc__ = families, faults, 2026112700, __doc__
third.RANGE.update({"eighth A": (22, 350), "eighth D": (22, 300)})
third.ALLOWED.update({"eighth A": (20, 400), "eighth D": (20, 400)})


def table():
    """(class, ways, families in the order in which they are tried) of each case. The ways of D are of two groups, and no way comes twice there."""
    rng = np.random.default_rng([eighth.SEED, 12])
    out = [("B", [])] * COUNTS["B"] + [("A", [w]) for ways in faults.WEIGHTS.values() for w, n in ways.items() for _ in range(n)]
    left = [str(x) for x in rng.permutation([w for w in faults.WAYS_A if w not in faults.ALONE])]
    for _ in range(COUNTS["D"]):
        a = left.pop(0)
        start = lambda x: (x in faults.STEADY) - (x in faults.NOT_STEADY)
        b = left.pop(next(i for i, x in enumerate(left) if faults.GROUP[x] != faults.GROUP[a] and start(x) * start(a) >= 0))
        out.append(("D", [b, a] if start(b) else [a, b]))
    n = len(families.FAMILIES)
    row = np.concatenate([rng.permutation(n) for _ in range(-(-len(out) // n))])
    return [(*out[i], [int(row[k])] + [int(x) for x in rng.permutation(n)]) for k, i in enumerate(rng.permutation(len(out)))]


def held_to(program):
    """Each family twice, nominal and without noise, in two styles of driving and of rows; then each way."""
    worst, done = [0.0, 0.0], set()

    def note(name, off):
        print(f"{name:88s} off by {off[0]:.4f} K, {off[1]:.4f} um", flush=True)
        worst[:] = [max(a, b) for a, b in zip(worst, off)]

    for i, family in enumerate(families.FAMILIES):
        for repeat in range(2):
            rng = np.random.default_rng([171, i, repeat])
            machine, plan = family(rng, Draw(rng))
            machine.sensors = [("t_" + b, b) for b in machine.bodies]
            families.priors(rng, machine)
            machine.start = [["hall", 28.0], ["steady", "hall"], [17.0, "steady"]][i % 3][repeat]
            dt, n = families.pace(rng, plan, 12, 4)
            style = (("watched", "even"), ("gaps", "watched"), ("lost", "slower"))[i % 3][repeat]
            machine.longest_step_s = float(np.clip(dt, 20, 150))
            styles = [families.STYLES[(5 * i + 3 * k + 4 * repeat) % len(families.STYLES)] for k in range(3)]
            record = families.record(rng, "measured_1", plan, families.rows(rng, style, dt, n), styles, ("corridor", "degC"))
            note(f"{family.__name__}, {style}, {' '.join(styles)}", check.met(program, machine, record, dt)[0])
    noise, rng = dict(temperature=dict(sigma=0.1, step=0.01), displacement=dict(sigma=0.5, step=0.01)), np.random.default_rng([172])
    machine, plan = families.horizontal_centre(rng, Draw(rng))
    machine.sensors, machine.longest_step_s = [("t_" + b, b) for b in machine.bodies], 20.0

    def drawn(way, start="hall"):
        """A record with even rows, and the fault with the geometric mean of its least and its greatest size."""
        done.add(way)
        machine.start = "steady" if way in faults.STEADY else start
        for _ in range(400):
            record = families.record(rng, "measured_1", plan, np.arange(300) * 60.0, ("lots", "parts", "spindle_test"))
            try:
                fault = faults.draw(rng, way, machine, plan, [record], None, noise)[0]
            except Impossible:
                continue
            fault.records = None
            return record, fault.with_size(np.sqrt(fault.low * fault.high))
        raise SystemExit(f"{way} cannot be drawn")

    def met(record, fault, lines, other=None):
        return check.met(program, other or machine, record, 60, [fault] if fault else [], "\n  - ".join(lines))[0]

    def own(record, fault, other):
        return [float(np.max(np.abs(x - y))) for x, y in zip(simulate(machine, machine.nominal(), record, [fault]), other)]

    def tell(record, fault):
        """Moves hidden columns into the record."""
        new = [f"told_{k}" for k in range(len(fault.data["columns"]))]
        for old, name in zip(fault.data["columns"], new):
            record.columns[name] = record.columns.pop(old)
        fault.data["columns"] = new

    def drives(fault, record):
        return [f"{{type: recorded_drive, node: {p.data['node']}, {p.data['mode']}: {float(p.size[0]):.9g}, column: {p.data['column']}}}" for p in fault.data["parts"](fault, machine, machine.nominal(), record)]

    for way in ("hydraulic_unit", "foundation"):      # the grammar says it as another machine
        for start in ("steady",) if way in faults.STEADY else ("hall", "steady"):
            record, fault = drawn(way, start)
            note(f"{way}, written down, start {machine.start}", eighth.met_as(program, machine, record, 60, fault))
    for way in ("workpieces", "enclosure_air"):      # another machine, and recorded columns
        record, fault = drawn(way)
        tell(record, fault)
        other, numbers = eighth.altered(fault, machine, machine.nominal())
        other.numbers = {k: (float(x[0]), "log") for k, x in numbers.items() if not k.startswith("G ") or tuple(k.split()[1:]) in other.links}
        still = Fault(way, {k: x for k, x in fault.data.items() if k != "change"}).with_size(fault.size[0])
        note(f"{way}, another machine and columns that are told", met(record, still, drives(fault, record), other))
        note(f"{way}, the same by one machine", own(record, fault, simulate(other, other.nominal(), record, [still])))
    for way in ("air_over_height", "cutting_fluid", "surface_turns", "chiller_follows_room", "motor_enabled", "nut_friction", "sun_on_part"):      # each follows columns; here the record contains them
        record, fault = drawn(way)
        tell(record, fault)
        note(f"{way} by columns that are told", met(record, fault, drives(fault, record)))
    for way in ("joint_tightens", "preload_rises", "oil_thins"):      # laws that depend on temperature, recorded row by row as the true temperatures give them
        record, fault = drawn(way)
        T = simulate(machine, machine.nominal(), record, [fault])[0][0]
        index, row, speed = {b: i for i, b in enumerate(machine.bodies)}, np.arange(len(record.time_s)), record.speed[None, :]
        m, numbers = eighth.altered(fault, machine, machine.nominal())
        watts = m.feedback[0](index, record, row, speed, None)
        at = lambda k, j: dict(watts(T[j][None, :], k))
        both = [(at(k, k), at(k, min(k + 1, len(row) - 1))) for k in row]
        lines = []
        for i in both[0][0]:
            record.columns[f"told_{i}"] = ("W", np.array([0.5 * float(a[i][0] + b[i][0]) for a, b in both]))
            lines.append(f"{{type: recorded_drive, node: {machine.bodies[i]}, gain: 1, column: told_{i}}}")
        note(f"{way} by what it brings, told row by row, {abs(record.columns[f'told_{i}'][1]).max():.0f} W", met(record, fault, lines))
        note(f"{way} of nothing", own(record, fault.with_size(0.0), simulate(machine, machine.nominal(), record)))
    for way in ("bracket_grows", "shaft_stretches"):
        record, fault = drawn(way)
        size, c = float(fault.size[0]), fault.data["channel"]
        extra = simulate(machine, machine.nominal(), record, [fault])[1][0] - simulate(machine, machine.nominal(), record)[1][0]
        record.columns["told"] = ("degC", machine.t_ref + extra[:, [d[0] for d in machine.displacements].index(c)] / size)
        note(f"{way} by a column that is told", met(record, fault, [f"{{type: displacement_path, displacement: {c}, sensitivity: {size:.9g} um/K, column: told}}"]))
    record, fault = drawn("thermometer_loose")
    record.columns[fault.data["columns"][0]] = ("1", np.zeros(300))
    n = fault.data["sensor"]
    note("thermometer_loose in air that rests", met(record, fault, [f"{{type: sensor_place, sensor: {n}, share: {fault.size[0]:.9g}, body: ambient}}", f"{{type: sensor_lag, sensor: {n}, lag: {fault.size[0] * fault.data['lag']:.9g} min}}"]))
    for way in ("door_opened", "override_turned"):      # with the true record
        record, fault = drawn(way)
        true = fault.data["record"](record, float(fault.size[0]))
        note(f"{way}, told by the record", own(record, fault, simulate(machine, machine.nominal(), true)))
        note(f"{way}, told by the record, by the program", met(true, None, []))
    for start in ("hall", "steady"):
        record, fault = drawn("warm_before", start)
        fault = fault.with_size(np.round(fault.size))      # whole minutes, so that the file contains the exact times
        longer, k = fault.data["before"](record, float(fault.size[0]))
        note(f"warm_before, the longer record, start {start}", own(record, fault, [x[:, k:] for x in simulate(machine, machine.nominal(), longer)]))
        note(f"warm_before, the longer record, by the program, start {start}", check.met(program, machine, longer, 1)[0])      # rows each second, among them those of the file
    if set(faults.WAYS_A) - done:
        raise SystemExit(f"not looked at: {sorted(set(faults.WAYS_A) - done)}")
    good = worst[0] <= 0.05 and worst[1] <= 0.25
    print(f"worst: {worst[0]:.4f} K, {worst[1]:.4f} um: {'fine' if good else 'NOT WITHIN 0.05 K and 0.25 um'}")
    return 0 if good else 1


eighth.table, eighth.held_to = table, held_to

if __name__ == "__main__":
    eighth.main()
