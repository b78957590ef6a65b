#!/usr/bin/env python3
"""Counts how often the 95 % intervals of `driftwright calibrate` contain the truth if the model is right, and in how many machines `identify --prior` then learns something that does not exist:
calibration_coverage.py PROGRAM [MACHINES [SEED]]

The machines have two bodies, and their numbers differ from the scenario's by 10 % (exponent 3 %), one sigma. Each has two records with 0.05 K and 0.3 um of noise. It needs only the standard library.
"""
import csv
import glob
import json
import math
import os
import random
import subprocess
import sys
import tempfile

MACHINE = """name: two_bodies
reference_temperature: 20 degC
machine: {{generator: lumped}}
effects:
  - {{type: node, node: head, capacity: {head:.6g} kJ/K}}
  - {{type: node, node: column, capacity: {column:.6g} kJ/K}}
  - {{type: heat_source, node: head, power: {power:.6g} W, at_speed: 1000 rpm, exponent: {exponent:.6g}}}
  - {{type: link, node: head, to: column, conductance: {between:.6g} W/K}}
  - {{type: link, node: column, to: ambient, conductance: {of_column:.6g} W/K}}
  - {{type: link, node: head, to: ambient, conductance: {of_head:.6g} W/K}}
ambient: [[0 min, 20 degC], [200 min, 22 degC], [400 min, 21 degC]]
sensors: [{{name: t_head, node: head}}, {{name: t_column, node: column}}]
displacements: [{{name: nose, sensitivities: [{{node: head, sensitivity: {growth:.6g} um/K}}]}}]
cyclograms:
  monday: [[60 min, 600 rpm], [60 min, 1900 rpm], [40 min, 0 rpm], [80 min, 1000 rpm], [60 min, 1400 rpm]]
  tuesday: [[50 min, 1800 rpm], [70 min, 300 rpm], [60 min, 1000 rpm], [60 min, 0 rpm], [60 min, 2000 rpm]]
solver: {{output_interval: 2 min}}
"""
WRITTEN = {"head": 6, "column": 40, "power": 100, "exponent": 1.3, "between": 12, "of_column": 14, "of_head": 4, "growth": 3}
JUDGED = {"power": "heat_source head power", "exponent": "friction_law head exponent", "between": "contact head,column conductance",
          "of_column": "contact column,ambient conductance", "of_head": "contact head,ambient conductance"}
NOISE = {"t_head_degC": 0.05, "t_column_degC": 0.05, "nose_um": 0.3}


def run(*words):
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)


def noisy(path, to):
    with open(path) as file:
        header, *rows = csv.reader(line for line in file if not line.startswith("#"))
    with open(to, "w") as file:
        write = csv.writer(file).writerow
        write(header)
        for row in rows:
            write(f"{float(cell) + NOISE[name] * random.gauss(0, 1):.5f}" if name in NOISE else cell for name, cell in zip(header, row))


def main():
    program = os.path.abspath(sys.argv[1])
    machines = int(sys.argv[2]) if len(sys.argv) > 2 else 40
    random.seed(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    os.chdir(tempfile.mkdtemp(prefix="driftwright-coverage-"))
    held = judged = rough = unwritten = learned = learned_channels = 0
    open("written.yaml", "w").write(MACHINE.format(**WRITTEN))
    for _ in range(machines):
        true = {k: v * math.exp((0.03 if k == "exponent" else 0.1) * random.gauss(0, 1)) for k, v in WRITTEN.items()}
        open("true.yaml", "w").write(MACHINE.format(**true))
        run(program, "simulate", "true.yaml", "-o", "simulated", "--force", "--quiet")
        records = []
        for path in sorted(glob.glob("simulated/records/*.csv")):
            records += ["--measured", os.path.basename(path)]
            noisy(path, records[-1])
        run(program, "calibrate", "written.yaml", *records, "-o", "calibrated", "--force", "--quiet")
        result = json.load(open("calibrated/calibration.json"))
        rough += result["weighed_by_model_error"]
        unwritten += not any(n["written"] for n in result["calibrated"])
        run(program, "identify", "--prior", "calibrated/calibrated.yaml", *["--record" if r == "--measured" else r for r in records], "-o", "learned", "--force", "--quiet")
        channels = sum(c["written"] == "yes" for c in json.load(open("learned/summary.json"))["channels"])
        learned += channels > 0
        learned_channels += channels
        for key, name in JUDGED.items():
            low, high = next(n["ci95"] for n in result["calibrated"] if n["name"] == name)
            held += low <= true[key] <= high
            judged += 1
    print(f"{held} of {judged} intervals hold ({100 * held / judged:.1f} %); of {machines} machines {rough} were taken for a wrong model, {unwritten} not written")
    print(f"with the calibrated file something was learned in {learned} of {machines} machines, {learned_channels} of {3 * machines} channels")


if __name__ == "__main__":
    main()
