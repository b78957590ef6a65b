#!/usr/bin/env python3
"""What a law of one's own costs beside the law of the catalogue that it copies: processor time of `predict` without its start, least of three runs in turn
(goal: 1.5 times), and the largest difference of the records, which is that of the integrator's steps (the test `formula_laws` holds equal steps to 1e-9).

    bench/own_law.py [PROGRAM]
"""
import os, random, resource, subprocess, sys, tempfile
from pathlib import Path

VISCOSITY = "(10^10^(log10(log10(nu40 + 0.8)) + log10(kelvin(oil)/t40)/log10(t100/t40)*(log10(log10(nu100 + 0.8)) - log10(log10(nu40 + 0.8)))) - 0.8)"
FRICTION = f"W*2*pi*n/60e3*(if({VISCOSITY}*n < 2000, f0*160e-7*d^3, f0*1e-7*({VISCOSITY}*n)^(2/3)*d^3) + f1*F*d)"
NUMBERS = "W: 1 W, f0: 2, f1: 0.0006, F: 300, d: 90, t40: 313.15 K, t100: 373.15 K, nu40: 25, nu100: 5, oil: spindle"
PALMGREN = "type: bearing_friction, node: spindle, f0: 2, viscosity_40: 25 mm^2/s, viscosity_100: 5 mm^2/s, mean_diameter: 90 mm, f1: 0.0006, load: 300 N"
LAWS = {
    "heat by a power of the speed": ("type: heat_source, node: spindle, power: 80 W, at_speed: 3000 rpm, exponent: 1.7",
                                     'type: formula, node: spindle, power: "P*(n/3000)^x", P: 80 W, x: 1.7'),
    "friction that falls with temperature": ("type: friction_law, node: spindle, power: 150 W, at_speed: 6000 rpm, exponent: 1.5, decay: 0.01 1/K, at_temperature: 20 degC",
                                             'type: formula, node: spindle, power: "P*(n/6000)^x*exp(-k*(T - T0))", P: 150 W, x: 1.5, k: 0.01 1/K, T: spindle, T0: 20 degC'),
    "Palmgren with oil that thins, viscosity written once": (PALMGREN, f'type: formula, node: spindle, power: "{FRICTION.split("if(")[0]}f0*1e-7*({VISCOSITY}*n)^(2/3)*d^3 + f1*F*d)", {NUMBERS}'),
    "the same with both branches, viscosity written twice": (PALMGREN, f'type: formula, node: spindle, power: "{FRICTION}", {NUMBERS}'),
}
SCENARIO = """name: own_law
reference_temperature: 20 degC
ambient: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 5.6 kJ/K}
  - {type: node, node: housing, capacity: 19 kJ/K}
  - {type: link, node: spindle, to: housing, conductance: 12 W/K}
  - {type: link, node: housing, to: ambient, conductance: 5 W/K}
  - {LAW}
sensors: [{name: t_spindle, node: spindle}]
displacements: [{name: nose_z, sensitivities: [{node: spindle, sensitivity: 2.5 um/K}]}]
cyclograms: {one: [[60 min, 6000 rpm]], many: MANY}
solver: {relative_tolerance: 1e-6, absolute_tolerance: 1e-5 K, output_interval: 60 min}
"""


def predict(program, file, cyclogram, out):
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run([program, "predict", file, "--cyclogram", cyclogram, "-o", out, "--quiet", "--threads", "1"], check=True)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def rows(out):
    return [[float(x) for x in line.split(",")] for line in (out / "record.csv").read_text().splitlines() if line[0].isdigit()]


def main():
    program = Path(sys.argv[1] if len(sys.argv) > 1 else "build/release/app/driftwright").resolve()
    random.seed(1)
    many = "[" + ", ".join(f"[{random.randint(3, 9)} min, {random.choice((0, 800, 2000, 3500, 5000, 6000))} rpm]" for _ in range(3000)) + "]"
    with tempfile.TemporaryDirectory() as name:
        os.environ["XDG_CACHE_HOME"] = name
        for what, laws in LAWS.items():
            least, out = [1e9, 1e9], [Path(name) / "built_in", Path(name) / "formula"]
            for law, folder in zip(laws, out):
                folder.with_suffix(".yaml").write_text(SCENARIO.replace("{LAW}", "{" + law + "}").replace("MANY", many))
            start_s = min(predict(program, out[0].with_suffix(".yaml"), "one", Path(name) / "start") for _ in range(3))
            for _ in range(3):
                for k in (0, 1):
                    least[k] = min(least[k], predict(program, out[k].with_suffix(".yaml"), "many", out[k]) - start_s)
            apart = max(abs(a - b) for one, other in zip(*map(rows, out)) for a, b in zip(one, other))
            print(f"{what}: {least[0]:.2f} s, by formula {least[1]:.2f} s, {least[1] / least[0]:.2f} times; records differ by {apart:.1e}")


if __name__ == "__main__":
    main()
