#!/usr/bin/env python3
"""A machine whose friction falls as it warms, over 4,000 sections (17 days) with tight tolerances: it runs to its end.

    long_duty_cycle_test.py PROGRAM

In this one a step of the integrator ends 2 us before a section does. Such a rest was taken for steps that shrink to nothing, and the run was given up.
"""
import os, random, subprocess, sys, tempfile
from pathlib import Path

SCENARIO = """name: long_duty_cycle
reference_temperature: 20 degC
ambient: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 5.6 kJ/K}
  - {type: node, node: housing, capacity: 19 kJ/K}
  - {type: link, node: spindle, to: housing, conductance: 12 W/K}
  - {type: link, node: housing, to: ambient, conductance: 5 W/K}
  - {type: friction_law, node: spindle, power: 150 W, at_speed: 6000 rpm, exponent: 1.5, decay: 0.01 1/K, at_temperature: 20 degC}
sensors: [{name: t_spindle, node: spindle}]
displacements: [{name: nose_z, sensitivities: [{node: spindle, sensitivity: 2.5 um/K}]}]
cyclograms: {many: SECTIONS}
solver: {relative_tolerance: 1e-6, absolute_tolerance: 1e-5 K, output_interval: 60 min}
"""


def main():
    random.seed(1)
    sections = [(random.randint(3, 9), random.choice((0, 800, 2000, 3500, 5000, 6000))) for _ in range(4000)]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "long_duty_cycle.yaml")
        file.write_text(SCENARIO.replace("SECTIONS", "[" + ", ".join(f"[{minutes} min, {rpm} rpm]" for minutes, rpm in sections) + "]"))
        done = subprocess.run([sys.argv[1], "predict", file, "--cyclogram", "many", "-o", Path(folder, "out"), "--quiet"], capture_output=True, text=True,
                              env={**os.environ, "XDG_CACHE_HOME": folder})
        assert done.returncode == 0, done.stderr
        last = Path(folder, "out", "record.csv").read_text().splitlines()[-1].split(",")
        assert float(last[0]) == 60 * sum(minutes for minutes, _ in sections), last


if __name__ == "__main__":
    main()
