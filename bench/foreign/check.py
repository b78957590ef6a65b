#!/usr/bin/python3
"""Does `driftwright simulate` meet the truth? Each family nominal, without noise; then ways of being wrong that the grammar can say, as it says them (README.md).

    check.py [--program driftwright] [--families first third] [--ways]        exit 1 where they differ by more than 0.05 K or 0.25 um
"""
import argparse
import csv
import os
import pathlib
import shutil
import subprocess
import tempfile

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(variable, "1")
import numpy as np

import drives
import faults
import machines
from network import simulate
from writing import record_csv, scenario

ALLOWED = (0.05, 0.25)      # K, um

# way -> names that are not drawn (formulas), and the effect as the grammar says it (formulas in braces)
SAID = {
    "heat_source": (dict(law="'constant'", node="bodies[0]", exponent="1.0", at="1.0", from_s="2220.0"), "type: heat_source, node: {node}, power: {size} W, from: 2220 s"),
    "heat_law": (dict(law="'speed'", node="bodies[0]", exponent="1.4", at="float(top)"), "type: heat_source, node: {node}, power: {size} W, at_speed: {top} rpm, exponent: 1.4"),
    "exchange_window": (dict(a="bodies[0]", b="'hall'", when="in_records({'measured_1': [(2030.0, 3010.0), (5110.0, 7990.0)]})"), "type: exchange_window, node: {a}, conductance: {size} W/K, surrounding: ambient, windows: [[2030 s, 3010 s], [5110 s, 7990 s]]"),
    "heat_window": (dict(node="bodies[0]", way_sign="1.0", when="in_records({'measured_1': [(2030.0, 3010.0), (5110.0, 7990.0)]})"), "type: heat_window, node: {node}, power: {size} W, windows: [[2030 s, 3010 s], [5110 s, 7990 s]]"),
    "link": (dict(a="bodies[0]", b="'hall'"), "type: link, node: {a}, to: ambient, conductance: {size} W/K"),
    "hidden_body": (dict(node="bodies[0]", capacity="9000.0", conductance="6.0", to_hall="1.0"), "type: hidden_body, node: {node}, capacity: {9000 * s} J/K, conductance: {6 * s} W/K, hall_conductance: {s} W/K"),
    "ambient": (dict(steps="True", from_s="2220.0", scope="None"), "type: ambient, offset: {size} K, from: 2220 s"),
    "ambient_ramp": ({}, "type: ambient, ramp: {size} K/h"),
    "sensor_bias": (dict(name="thermometers[0]"), "type: sensor_bias, sensor: {name}, bias: {size} K"),
    "sensor_lag": (dict(name="thermometers[0]"), "type: sensor_lag, sensor: {name}, lag: {size} min"),
    "sensor_drift": (dict(name="thermometers[0]"), "type: sensor_drift, sensor: {name}, drift: {size} K/h"),
    "sensor_detached": (dict(name="thermometers[0]", from_s="2220.0"), "type: sensor_detached, sensor: {name}, share: {size}, time: 2220 s"),
    "sensor_place": (dict(sensor="sensors[0]", name="sensors[0][0]", other="bodies[1]"), "type: sensor_place, sensor: {name}, share: {size}, body: {other}"),
    "sensor_swap": (dict(one="sensors[0]", two_="sensors[1]"), "type: sensor_swap, sensor: {a}, with: {b}"),
    "mount_shift": (dict(name="channels[0]", from_s="2220.0"), "type: mount_shift, displacement: {name}, shift: {size} um, time: 2220 s"),
    "spindle_growth": (dict(name="channels[0]", exponent="1.5", lag_s="540.0"), "type: spindle_growth, displacement: {name}, growth: {size} um, at_speed: {top} rpm, exponent: 1.5, lag: 9 min"),
    "centrifugal": (dict(name="channels[0]"), "type: centrifugal, displacement: {name}, growth: {size} um, at_speed: {top} rpm"),
    "body_growth": (dict(channel="displacements[0]", name="channels[0]", node="bodies[0]", lag_s="1500.0"), "type: displacement_path, displacement: {name}, sensitivity: {size} um/K, body: {node}, lag: 25 min"),
    "scale_expansion": (dict(what="'factor'", name="channels[0]"), "type: scale_expansion, displacement: {name}, factor: {exp(s)}"),
    "clock_offset": ({}, "type: clock_offset, offset: {size} min"),
    "speed_override": ({}, "type: speed_override, factor: {exp(s)}"),
    "missing_stop": (dict(name="'measured_1'"), "type: missing_stop, start: {start_s} s, length: {size} min"),
    "heat_capacity": (dict(node="bodies[0]"), "type: heat_capacity, node: {node}, factor: {exp(s)}"),
    "forced_exchange": (dict(link="[x for x in links if x[1] == 'hall'][0]"), "type: changed_law, law: link {node} - ambient, exponent: {size}, at_speed: {at} rpm"),
    "column_heat": (dict(node="bodies[0]", way_sign="1.0"), "type: recorded_drive, node: {node}, gain: {size}, column: {column}"),
    "column_warmth": (dict(node="bodies[0]"), "type: recorded_drive, node: {node}, conductance: {size} W/K, column: {column}"),
    "column_opening": (dict(node="bodies[0]"), "type: recorded_drive, node: {node}, opening: {size}, column: {column}"),
    "machine_warms_its_air": ({}, "type: ambient, with_speed: {size} K, at_speed: {top} rpm, behind: {slow / 60} min"),
}


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
            raise SystemExit(f"{line}\n{run.stdout}{run.stderr}")
        lines = [x for x in (folder / "out" / "record.csv").read_text().splitlines() if not x.startswith("#")]
    rows = {round(float(r["time_s"]), 3): r for r in csv.DictReader(lines)}
    off = [0.0, 0.0]
    for k, t in enumerate(record.time_s):
        r = rows[round(float(t), 3)]
        off[0] = max([off[0]] + [abs(float(r[n + "_degC"]) - temperatures[k, j]) for j, (n, _) in enumerate(machine.sensors)])
        off[1] = max([off[1]] + [abs(float(r[n + "_um"]) - displacements[k, j]) for j, (n, _, _) in enumerate(machine.displacements)])
    return off


def whole(rng, family, spec):
    """A machine with a thermometer on each body."""
    machine, plan = machines.machine(rng, family, spec)
    machine.sensors = [("t_" + b, b) for b in machine.bodies]
    return machine, plan


def check_family(program, family, spec, i):
    rng, out = np.random.default_rng([77, i]), [0.0, 0.0]
    for style, start in (("gaps", "hall"), ("lost", "steady")):
        machine, plan = whole(rng, family, spec)
        machine.start = start if machine.start == "hall" else machine.start
        machines.priors(rng, machine)
        dt, _ = drives.pace(rng, plan, [250, 300], 1, 1)
        machine.longest_step_s = float(np.clip(dt / 2, 20, 60))
        record = drives.record(rng, "measured_1", plan, drives.rows(rng, style, dt, 250), [str(rng.choice(list(drives.STYLES))) for _ in range(3)], ("yard", "degC"))
        out = [max(a, b) for a, b in zip(out, met(program, machine, record, dt))]
    return out


def check_way(program, way, given, line):
    unit = dict(column_warmth="degC", column_opening="percent").get(way, "W_m2")
    for number in range(50):
        rng = np.random.default_rng([78, number])
        machine, plan = whole(rng, "gear_hobber", machines.families("third")["gear_hobber"])
        record = drives.record(rng, "measured_1", plan, np.arange(300) * 60.0, ["series", "telegraph", "blocks"], ("told", unit))
        words = faults.Words(rng, machine, plan, [record], ("told", unit))
        try:
            fault = words.one(way, words.ways[way], {k: faults.laws.value(x, words.names) for k, x in given.items()})
            break
        except faults.Impossible:
            continue
    fault.records, fault.sign = None, 1.0
    fault = fault.with_size(np.sqrt(fault.low * fault.high))
    names = {**fault.names, "s": float(fault.size[0]), "size": float(fault.size[0])}
    text = faults.re.sub(r"\{([^{}]+)\}", lambda m: (lambda x: x if isinstance(x, str) else f"{float(x):.9g}")(faults.laws.value(m[1], names)), line)
    return met(program, machine, record, 60, [fault], "{" + text + "}")


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", default="driftwright")
    p.add_argument("--families", nargs="*", default=sorted(x.stem for x in machines.FOLDER.glob("*.yaml")), help="files of families/ [all]")
    p.add_argument("--ways", action="store_true", help="the ways alone")
    a = p.parse_args()
    program, worst = os.path.realpath(shutil.which(a.program) or a.program), [0.0, 0.0]      # it runs in a folder of its own

    def note(name, off):
        print(f"{name:40s} off by {off[0]:.4f} K, {off[1]:.4f} um", flush=True)
        worst[:] = [max(x, y) for x, y in zip(worst, off)]
    for name in [] if a.ways else a.families:
        for i, (family, spec) in enumerate(machines.families(name).items()):
            note(f"{name} {family}", check_family(program, family, spec, i))
    for way, (given, line) in SAID.items():
        note(way, check_way(program, way, given, line))
    good = worst[0] <= ALLOWED[0] and worst[1] <= ALLOWED[1]
    print(f"worst: {worst[0]:.4f} K, {worst[1]:.4f} um: {'fine' if good else 'NOT WITHIN %g K and %g um' % ALLOWED}")
    raise SystemExit(0 if good else 1)


if __name__ == "__main__":
    main()
