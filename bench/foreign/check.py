"""`generate.py --check`: does `driftwright simulate` meet the truth where nothing is hidden?"""
import csv
import pathlib
import subprocess
import tempfile

import numpy as np

import families
from faults import Fault
from network import simulate
from writing import record_csv, scenario


def one_of_each(machine, record):
    """Faults that the grammar can say, with their lines: how the truth understands them is how the program does."""
    sensor, channel, body = machine.sensors[0][0], machine.displacements[0][0], machine.bodies[0]
    end = record.time_s[-1]
    at = float(round(0.37 * end))
    row = next(t for t, n in zip(record.time_s, record.speed) if n > 0 and t > 0.3 * end)
    windows = [(at, at + 1000.0), (at + 2500.0, at + 3300.0)]
    rows = "[[%g s, %g s], [%g s, %g s]]" % (*windows[0], *windows[1])
    top = float(record.speed.max())
    node = f"node: {body}"
    return [
        (Fault("heat_source", dict(node=body, law="constant", from_s=at)), 40.0, f"{{type: heat_source, {node}, power: 40 W, from: {at:g} s}}"),
        (Fault("heat_source", dict(node=body, law="power", from_s=0.0, at=top, exponent=1.4)), 40.0, f"{{type: heat_source, {node}, power: 40 W, at_speed: {top:g} rpm, exponent: 1.4}}"),
        (Fault("exchange_window", dict(a=body, b="hall"), windows=windows), 12.0, f"{{type: exchange_window, {node}, conductance: 12 W/K, surrounding: ambient, windows: {rows}}}"),
        (Fault("link", dict(a=body, b="hall")), 3.0, f"{{type: link, {node}, to: ambient, conductance: 3 W/K}}"),
        (Fault("ambient", dict(from_s=at)), 2.0, f"{{type: ambient, offset: 2 K, from: {at:g} s}}"),
        (Fault("ambient", dict(from_s=0.0)), -2.0, "{type: ambient, offset: -2 K}"),
        (Fault("sensor_bias", dict(sensor=sensor)), 1.0, f"{{type: sensor_bias, sensor: {sensor}, bias: 1 K}}"),
        (Fault("sensor_lag", dict(sensor=sensor)), 6.0, f"{{type: sensor_lag, sensor: {sensor}, lag: 6 min}}"),
        (Fault("sensor_drift", dict(sensor=sensor)), 0.5, f"{{type: sensor_drift, sensor: {sensor}, drift: 0.5 K/h}}"),
        (Fault("sensor_detached", dict(sensor=sensor, from_s=at)), 0.4, f"{{type: sensor_detached, sensor: {sensor}, share: 0.4, time: {at:g} s}}"),
        (Fault("mount_shift", dict(channel=channel, from_s=at)), 5.0, f"{{type: mount_shift, displacement: {channel}, shift: 5 um, time: {at:g} s}}"),
        (Fault("spindle_growth", dict(channel=channel, at=top, exponent=1.5, lag_min=9.0)), 12.0,
         f"{{type: spindle_growth, displacement: {channel}, growth: 12 um, at_speed: {top:g} rpm, exponent: 1.5, lag: 9 min}}"),
        (Fault("clock_offset"), 4.3, "{type: clock_offset, offset: 4.3 min}"),
        (Fault("speed_override"), float(np.log(1.3)), "{type: speed_override, factor: 1.3}"),
        (Fault("missing_stop", dict(start_s=float(row))), 11.0, f"{{type: missing_stop, start: {row:g} s, length: 11 min}}"),
    ]


def met(program, machine, record, dt, hidden=(), line=""):
    """Greatest differences [K, um] between the truth and `driftwright simulate`."""
    temperatures, displacements = (a[0] for a in simulate(machine, machine.nominal(), record, hidden))
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        text = scenario(machine, dt)
        (folder / "scenario.yaml").write_text(text.replace("\nambient:", f"\n  - {line}\nambient:", 1) if line else text)
        (folder / "measured_1.csv").write_text(record_csv(machine, record, temperatures, displacements))
        run = subprocess.run([program, "simulate", "scenario.yaml", "--cyclogram", "measured_1.csv", "-o", "out"], cwd=folder, capture_output=True, text=True)
        if run.returncode:
            raise SystemExit(run.stdout + run.stderr)
        lines = [x for x in (folder / "out" / "record.csv").read_text().splitlines() if not x.startswith("#")]
    rows = {round(float(r["time_s"]), 3): r for r in csv.DictReader(lines)}
    off = [0.0, 0.0]
    for k, t in enumerate(record.time_s):
        r = rows[round(float(t), 3)]
        off[0] = max([off[0]] + [abs(float(r[n + "_degC"]) - temperatures[k, j]) for j, (n, _) in enumerate(machine.sensors)])
        off[1] = max([off[1]] + [abs(float(r[n + "_um"]) - displacements[k, j]) for j, (n, _, _) in enumerate(machine.displacements)])
    return off, np.ptp(temperatures, axis=0).max()


def check(program, machines):
    worst = [0.0, 0.0]
    for i, family in enumerate(machines):
        for repeat in range(2):
            rng = np.random.default_rng([77, i, repeat])
            machine, plan = family(rng, families.Draw(rng))
            machine.sensors = [("t_" + b, b) for b in machine.bodies]
            if repeat:
                machine.start = "steady"
            n_rows, dt = 300, plan["dt"][1]
            record = families.record(rng, "measured_1", plan, n_rows, dt, ("sun", "W_m2"))
            off, span = met(program, machine, record, dt)
            print(f"{family.__name__:18s} start {str(machine.start):7s} greatest rise {span:6.1f} K   off by {off[0]:.4f} K, {off[1]:.4f} um")
            worst = [max(a, b) for a, b in zip(worst, off)]
    rng = np.random.default_rng([78])
    machine, plan = families.gearbox(rng, families.Draw(rng))
    machine.sensors = [("t_" + b, b) for b in machine.bodies]
    record = families.record(rng, "measured_1", plan, 300, 60)
    for fault, size, line in one_of_each(machine, record):
        off, _ = met(program, machine, record, 60, [fault.with_size(abs(size)) if size > 0 else Fault(fault.key, fault.data, sign=-1.0).with_size(-size)], line)
        print(f"{fault.key:18s} off by {off[0]:.4f} K, {off[1]:.4f} um")
        worst = [max(a, b) for a, b in zip(worst, off)]
    good = worst[0] <= 0.05 and worst[1] <= 0.25
    print(f"worst: {worst[0]:.4f} K, {worst[1]:.4f} um: {'fine' if good else 'NOT WITHIN 0.05 K and 0.25 um'}")
    return 0 if good else 1
