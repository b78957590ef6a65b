#!/usr/bin/python3
"""Writes the cases of the set `ninth` (README.md), by the driver of `eighth`; how sizes are set is that of third.py.

    ninth.py FOLDER [--only 7 12] [--seed N]
    ninth.py --check [--program driftwright]      the nominal machines and what the grammar can say against `driftwright simulate`
"""
import eighth      # before numpy: one core

import numpy as np

import check
import ninth_families as families
import ninth_faults as faults
import writing
from families import Draw
from faults import Fault, Impossible
from ninth_network import simulate

writing.TITLES.update(families.TITLES)
eighth.families, eighth.faults, eighth.SEED, eighth.__doc__ = families, faults, 2026112631, __doc__


def held_to(program):
    """Each family twice, nominal and without noise, in two styles of driving and of rows; then what is new: as the grammar says it, by recorded columns, or by another form of the truth."""
    worst = [0.0, 0.0]

    def note(name, off):
        print(f"{name:66s} off by {off[0]:.4f} K, {off[1]:.4f} um", flush=True)
        worst[:] = [max(a, b) for a, b in zip(worst, off)]

    for i, family in enumerate(families.FAMILIES):
        for repeat in range(2):
            rng = np.random.default_rng([131, i, repeat])
            machine, plan = family(rng, Draw(rng))
            machine.sensors = [("t_" + b, b) for b in machine.bodies]
            families.priors(rng, machine)
            machine.start = [["hall", 30.5], ["steady", "hall"], [14.0, "steady"]][i % 3][repeat]
            dt, n = families.pace(rng, plan, 12, 2)
            style = (("watched", "even"), ("gaps", "watched"), ("lost", "slower"))[i % 3][repeat]
            machine.longest_step_s = float(np.clip(dt, 20, 150))
            styles = [families.STYLES[(i + 3 * k + 4 * repeat) % len(families.STYLES)] for k in range(3)]
            record = families.record(rng, "measured_1", plan, families.rows(rng, style, dt, n), styles, ("basement", "degC"))
            note(f"{family.__name__}, {style}, {' '.join(styles)}", check.met(program, machine, record, dt)[0])
    noise = dict(temperature=dict(sigma=0.1, step=0.01), displacement=dict(sigma=0.5, step=0.01))
    rng = np.random.default_rng([132])
    machine, plan = families.centerless_grinder(rng, Draw(rng))
    machine.sensors, time_s = [("t_" + b, b) for b in machine.bodies], np.arange(300) * 60.0
    machine.longest_step_s = 20.0

    def drawn(way, column=None):
        for _ in range(200):
            record = families.record(rng, "measured_1", plan, time_s, ["telegraph", "takt", "trials"], column)
            try:
                fault = faults.draw(rng, way, machine, plan, [record], column, noise)[0]
                return record, fault.with_size(np.sqrt(fault.low * fault.high))
            except Impossible:
                continue
        raise SystemExit(f"{way} cannot be drawn")
    met = lambda record, fault, line: check.met(program, machine, record, 60, [fault], "\n  - ".join(line if isinstance(line, list) else [line]))[0]
    rows = lambda windows: ", ".join(f"[{a:.9g} s, {b:.9g} s]" for a, b in windows)
    for way in ("adapter_chain", "circuit_also"):
        for machine.start in ("hall", "steady"):
            record, fault = drawn(way)
            note(f"{way}, written down, start {machine.start}", eighth.met_as(program, machine, record, 60, fault))
    machine.start = "hall"
    for way in ("holding_torque", "bearing_damage", "chip_heap", "loss_saturates"):      # each hides a column; here the record contains it
        record, fault = drawn(way)
        record.columns["told"] = record.columns.pop(faults.HIDDEN)
        fault.data["column"] = "told"
        note(f"{way} by a column that is told", met(record, fault, f"{{type: recorded_drive, node: {fault.data['node']}, gain: {fault.size[0]:.9g}, column: told}}"))
    record, fault = drawn("two_feet")
    record.columns["told"] = record.columns.pop(faults.HIDDEN)
    fault.data["column"] = "told"
    note("two_feet by a column that is told", met(record, fault, [f"{{type: recorded_drive, node: {n}, conductance: {fault.size[0]:.9g} W/K, column: told}}" for n in fault.data["nodes"]]))
    record, fault = drawn("filter_clogs")
    record.columns["told"] = record.columns.pop(faults.HIDDEN)
    fault.data["column"] = "told"
    node, fault = fault.data["node"], fault.with_size(-0.4)      # the grammar has openings and no closings
    note("filter_clogs the other way, by a column that is told", met(record, fault, f"{{type: recorded_drive, node: {node}, opening: {-fault.size[0] * machine.numbers[f'G {node} hall'][0]:.9g}, column: told}}"))
    record, fault = drawn("lid_over_two")
    note("lid_over_two", met(record, fault, [f"{{type: exchange_window, node: {n}, conductance: {fault.size[0]:.9g} W/K, surrounding: ambient, windows: [{rows(fault.windows(record))}]}}" for n in fault.data["nodes"]]))
    record, fault = drawn("clamped_at_rest")
    note("clamped_at_rest", met(record, fault, f"{{type: exchange_window, node: {fault.data['a']}, conductance: {fault.size[0]:.9g} W/K, surrounding: {fault.data['b']}, windows: [{rows(fault.windows(record))}]}}"))
    record, fault = drawn("column_on_two", ("work_light", "W"))
    note("column_on_two", met(record, fault, [f"{{type: recorded_drive, node: {n}, gain: {w * fault.size[0]:.9g}, column: work_light}}" for n, w in zip(fault.data["nodes"], fault.data["shares"])]))
    record, fault = drawn("crosstalk")
    fault = fault.with_size(0.2)
    bodies = dict(machine.sensors)
    note("crosstalk", met(record, fault, [f"{{type: sensor_place, sensor: {n}, share: 0.2, body: {bodies[m]}}}" for n, m in zip(fault.data["card"][1:], fault.data["card"])]))
    record, fault = drawn("stand_on_machine")
    note("stand_on_machine", met(record, fault, [f"{{type: displacement_path, displacement: {c}, sensitivity: {w * fault.size[0]:.9g} um/K, body: {fault.data['stand']}}}" for c, w in zip(fault.data["channels"], fault.data["shares"])]))
    while True:      # a changed law is changed in its idle heat, too
        record, fault = drawn("exponent_of_two")
        if not any(machine.heats[i]["has_idle"] for i in fault.data["heats"]):
            break
    note("exponent_of_two", met(record, fault, [f"{{type: changed_law, law: {machine.heats[i]['kind']} {n}, exponent: {fault.size[0]:.9g}, at_speed: {machine.heats[i]['at']:g} rpm}}" for i, n in zip(fault.data["heats"], fault.data["nodes"])]))
    record, fault = drawn("many_stops")
    note("many_stops", met(record, fault, [f"{{type: missing_stop, start: {t:g} s, length: {fault.size[0]:.9g} min}}" for t in fault.data["starts_s"]]))
    # a plain link and a plain film, as heat that follows temperatures has them
    def fed(make):
        def change(m, numbers, s):
            m.feedback = [lambda index, record, row, speed, hall: make(index, s, hall)]
        return Fault("restructured", dict(change=change))
    record = families.record(rng, "measured_1", plan, time_s, ["telegraph", "takt", "trials"])
    link = fed(lambda index, s, hall: lambda T, k: [(index["blade"], s * (T[:, index["bed"]] - T[:, index["blade"]])), (index["bed"], s * (T[:, index["blade"]] - T[:, index["bed"]]))]).with_size(3.0)
    note("a link by feedback", met(record, link, "{type: link, node: blade, to: bed, conductance: 3 W/K}"))
    film = fed(lambda index, s, hall: lambda T, k: [(index["wheel_spindle"], -s * (T[:, index["wheel_spindle"]] - hall[:, k]))]).with_size(4.0)
    note("a film by feedback", met(record, film, "{type: link, node: wheel_spindle, to: ambient, conductance: 4 W/K}"))
    # a stream from a body that nothing moves is a link to it
    old = machine.numbers["C bed"]
    machine.numbers["C bed"] = (1e15, "log")
    for _ in range(300):
        _, stream = drawn("one_way_stream")
        if stream.data["nodes"][0] == "bed":
            break
    stream = stream.with_size(5.0)
    both = simulate(machine, machine.nominal(), record, [stream]), simulate(machine, machine.nominal(), record, [Fault("link", dict(a=stream.data["nodes"][1], b="bed")).with_size(5.0)])
    note("one_way_stream from a body of no end", [float(np.max(np.abs(x - y))) for x, y in zip(*both)])
    machine.numbers["C bed"] = old
    # below a speed that never comes, or of a body that is never warm, nothing is hidden
    still = [Fault("jams", dict(channel="diameter", body="bed", above_degC=500.0)).with_size(1.0), Fault("amplifier_warms", dict(card=["t_bed"], fades_s=1e-3)).with_size(0.0), Fault("many_stops", dict(starts_s=[600.0])).with_size(1e-9)]
    note("nothing of some of them", [float(np.max(np.abs(x - y))) for x, y in zip(simulate(machine, machine.nominal(), record, still), simulate(machine, machine.nominal(), record))])
    few = families.record(rng, "measured_1", plan, time_s, ["takt", "takt", "takt"])
    few.speed = np.where(few.time_s < 6000, plan["top"], 0.0)
    mean = faults.coasting(few, plan["top"], 10.0)
    note("coasts_down of one stop: turns less than nothing or too often", [abs(float(np.sum((mean - few.speed) * 60.0) / (plan["top"] * 300.0)) - 1), 0.0])
    good = worst[0] <= 0.05 and worst[1] <= 0.25
    print(f"worst: {worst[0]:.4f} K, {worst[1]:.4f} um: {'fine' if good else 'NOT WITHIN 0.05 K and 0.25 um'}")
    return 0 if good else 1


eighth.held_to = held_to

if __name__ == "__main__":
    eighth.main()
