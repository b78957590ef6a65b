#!/usr/bin/python3
"""`driftwright validate --probe` with several intervals. `driftwright probe-plan`: the plan of an NC program and of a cyclogram, computed again by closed forms, against every other plan; files, and messages of the command line about wrong input.

    probe_plan_verb_test.py PROGRAM
"""
import csv
import itertools
import json
import math
import pathlib
import random
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "shared"))
from claims import caller, expect, failures

SHOP = """name: shop
reference_temperature: 20 degC
ambient: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 6 kJ/K}
  - {type: heat_source, node: spindle, power: 60 W, at_speed: 3000 rpm, exponent: 1}
  - {type: link, node: spindle, to: ambient, conductance: 5 W/K}
sensors: [{name: t_spindle, node: spindle}]
displacements: [{name: nose_z, sensitivities: [{node: spindle, sensitivity: 2 um/K}]}]
cyclograms: {shift: [[50 min, 3000 rpm], [20 min, 0 rpm], [40 min, 1500 rpm], [1 min, 0 rpm], [40 min, 3000 rpm]]}
"""
SCHEDULE = "schedule: {axes: {z: {displacement: nose_z}}, tolerance: 5 um, rapid: 10 m/min, tool_change: 30 s}\n"
# 0.5 + 20 + 25 + 0.5 + 14 = 60 min; places at 0, 20.5 and 45.5 min
PART = "G21 G90\nT1 M6\nS3000 M3\nG4 P1200\nM0\nG4 P1500\nT2 M6\nG4 P840\nM2\n"


def write_record(path, rate, draw):
    """Four hours of a spindle that is driven to and fro; the drift has a part that no thermometer reads."""
    rows, heat_K, extra_um = [], 0.0, 0.0
    for i in range(241):
        speed = 3000 * rate if (i // 40) % 2 == 0 else 0
        heat_K += (speed / 3000 * 12 - heat_K) / 40
        extra_um = extra_um * math.exp(-1 / 90) + 2.0 * math.sqrt(1 - math.exp(-2 / 90)) * draw.gauss(0, 1)
        rows.append(f"{60 * i},{speed:.0f},{20 + heat_K + 0.05 * draw.gauss(0, 1):.3f},{2 * heat_K + extra_um:.3f}")
    path.write_text("time_s,speed_rpm,t_spindle_degC,nose_z_um\n" + "\n".join(rows) + "\n")


class Axis:
    """The process of a model's file, and the half width after some probings, by the formulas of docs/how-to/probing.md."""

    def __init__(self, model, noise_um):
        file = json.loads(model.read_text())
        self.s, self.T = file["probing"]["deviation_um"], file["probing"]["time_constant_s"] / 60
        self.factor = max(1.96, file["interval_95_um"] / self.s)
        self.noise_um = noise_um

    def worst_um(self, places_min, end_min):
        at, um2, worst = 0.0, 0.0, 0.0
        for time in [*places_min, end_min]:
            um2 = self.s**2 + (um2 - self.s**2) * math.exp(-2 * (time - at) / self.T)
            worst = max(worst, self.factor * math.sqrt(um2))
            um2 = um2 * self.noise_um**2 / (um2 + self.noise_um**2)
            at = time
        return worst


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="driftwright_probe_plan-") as name:
        folder = pathlib.Path(name)
        call = caller(program, folder)
        def plan(out, *words):
            done = call("probe-plan", *words, "-o", out)
            expect(done.returncode == 0, f"{out}: exit {done.returncode} {done.stderr.strip()[-300:]}")
            return json.loads((folder / out / "summary.json").read_text()), done.stdout

        draw = random.Random(3)
        for record, rate in (("a", 1.0), ("b", 0.7), ("c", 1.2)):
            write_record(folder / f"{record}.csv", rate, draw)
        (folder / "shop.yaml").write_text(SHOP + SCHEDULE)
        (folder / "plain.yaml").write_text(SHOP)
        (folder / "part.ngc").write_text(PART)
        done = call("validate", "shop.yaml", "--target", "nose_z", "--train", "a.csv", "--train", "b.csv", "--test", "c.csv", "--probe", "30 min, 1 h", "--probing-time", "3 min", "-o", "fit")
        expect(done.returncode == 0, f"validate: {done.stderr.strip()[-300:]}")
        model = folder / "fit/models/no_correction.json"
        judged = json.loads((folder / "fit/summary.json").read_text())["validation"]
        matrix = {(row["name"], row["every_min"]): row for row in judged["probing_matrix"]}
        none = [matrix["no correction", every] for every in (None, 60, 30)]
        expect(none[0]["rms_um"] > none[1]["rms_um"] > none[2]["rms_um"], f"the last probing alone: {[row['rms_um'] for row in none]} um without, each hour, each 30 min")
        expect([row["lost_min_per_h"] for row in none] == [0, 3, 6], "minutes lost")
        first = {row["name"]: row for row in judged["probing"]}
        expect(all(abs(matrix[name, 30]["rms_um"] - row["probed_rms_um"]) < 1e-5 * row["probed_rms_um"] for name, row in first.items()), "both tables agree at the first interval")
        members = [row["rms_um"] for (name, every), row in matrix.items() if every == 30 and name not in ("no correction", "blend", "weights by probings") and "training runs" not in name]
        weighted = matrix["weights by probings", 30]
        expect(weighted["rms_um"] < sorted(members)[len(members) // 2] * 1.05, f"weights leave {weighted['rms_um']} um, members {sorted(members)}")
        expect(weighted["failed_rms_um"] is not None and weighted["judged"] > 1, "weights with failed sensors")
        faults = {row["name"]: row for row in judged["probe_faults"]}
        ridge = faults["ridge, all sensors"]
        expect(ridge["biased_peak_um"] > ridge["good_peak_um"] and ridge["bound_um"] > 4, f"a biased probe: {ridge}")

        # two parts of an NC program with a rest of 30 min between them
        places_min = [0, 20.5, 45.5, 90, 110.5, 135.5]
        axis = Axis(model, 0.5)
        tolerance_um = 1.05 * axis.worst_um([0, 25, 50], 75)  # the longest work without a place is 25 min
        words = ["shop.yaml", "--job", "part.ngc", "--model", model, "--parts", "2", "--between", "30 min", "--probe-noise", "0.5 um", "--probing-time", "3 min"]
        found, said = plan("part", *words, "--tolerance", f"{tolerance_um:.6f} um")
        rows = found["probings"]
        at_min = [row["at_min"] for row in rows]
        expect(found["n_places"] == 6 and len(rows) > 2 and set(at_min) <= set(places_min), f"places {at_min}")
        expect(all(row["before_um"] <= tolerance_um + 1e-3 for row in rows), "each is before the tolerance is passed")
        lines = {0: None, 20.5: 5, 45.5: 7, 90: None, 110.5: 5, 135.5: 7}
        expect(all(row["line"] == lines[row["at_min"]] for row in rows), "lines of the program")
        expect(all(row["lost_min"] == (0 if row["at_min"] == 90 else 3) for row in rows), "a probing in the rest between two parts costs nothing")
        expect("the tolerance" in said, said[:200])
        with (folder / "part/probe_plan.csv").open() as file:
            written = list(csv.DictReader(line for line in file if not line.startswith("#")))
        expect([float(row["at_min"]) for row in written] == at_min, "probe_plan.csv has the rows of the summary")

        # without a rest the closed form holds to the end: the fewest of all subsets, and of those the least half width
        words = ["shop.yaml", "--job", "part.ngc", "--model", model, "--parts", "2", "--probe-noise", "0.5 um"]
        places_min, end_min = [0, 20.5, 45.5, 60, 80.5, 105.5], 120
        tolerance_um = 1.15 * axis.worst_um(places_min, end_min)
        found, _ = plan("joined", *words, "--tolerance", f"{tolerance_um:.6f} um")
        judged = {n: min(axis.worst_um(chosen, end_min) for chosen in itertools.combinations(places_min, n)) for n in range(7)}
        fewest = min(n for n, um in judged.items() if um <= tolerance_um)
        expect(len(found["probings"]) == fewest and fewest > 0, f"{len(found['probings'])} probings, {fewest} by all subsets")
        half_um = {row["n"]: row["half_width_um"] for row in found["curve"]}
        expect(all(half_um[n] <= um * (1 + 1e-4) for n, um in judged.items() if n in half_um), f"curve {half_um}, subsets {judged}")
        expect(abs(half_um[fewest] - judged[fewest]) < 1e-3 * judged[fewest], f"half width {half_um[fewest]}, by all subsets {judged[fewest]}")
        expect(all(row["equal_half_width_um"] >= row["half_width_um"] * (1 - 1e-5) for row in found["curve"]), "equal intervals are never better")
        half, _ = plan("half", *words, "--tolerance", f"{2 * tolerance_um:.6f} um", "--margin", "50 %")
        expect([r["at_min"] for r in half["probings"]] == [r["at_min"] for r in found["probings"]], "--margin leaves the rest of the tolerance")

        # a cyclogram: at the end of its rests
        found, _ = plan("shift", "plain.yaml", "--job", "shift", "--model", model, "--tolerance", "9 um")
        expect(found["n_places"] == 3 and all(row["where"] in ("before the job", "after a rest") for row in found["probings"]), f"{found['probings']}")
        found, said = plan("none", "plain.yaml", "--job", "shift", "--model", model, "--tolerance", "50 um")
        expect("No probing is needed" in said and found["probings"] == [], said[:200])
        found, said = plan("never", "plain.yaml", "--job", "shift", "--model", model, "--tolerance", "0.5 um")
        expect("No number of probings" in said and found["probings"] == [], said[:200])
        expect((folder / "never/report.html").stat().st_size > 1000 and list((folder / "part/figures").glob("*.svg")), "report and figures")

        # a table whose rings shift and grow: its ends tell most
        (folder / "rings.csv").write_text("time_s,ring_1_um,ring_2_um,ring_3_um\n" + "".join(
            f"{60 * i},{5 * a - 10 * b:.4f},{5 * a:.4f},{5 * a + 10 * b:.4f}\n" for i, (a, b) in enumerate((draw.gauss(0, 1), draw.gauss(0, 1)) for _ in range(500))))
        found, said = plan("points", "plain.yaml", "--job", "shift", "--model", model, "--tolerance", "9 um", "--points", "rings.csv", "--probe-noise", "0.5 um")
        sets = {row["n"]: row for row in found["points"]}
        expect(sets[2]["least_mean"] == ["ring_1", "ring_3"] == sets[2]["most_information"] and sets[2]["left_um"] < 0.6 < sets[1]["left_um"] < sets[0]["left_um"], f"points {sets}")
        found, said = plan("inner", "plain.yaml", "--job", "shift", "--model", model, "--tolerance", "9 um", "--points", "rings.csv", "--may-probe", "ring_2", "--counts", "ring_2")
        expect([row["n"] for row in found["points"]] == [0, 1] and found["points"][1]["left_um"] < 1.0, f"{found['points']}")

        # the touch cycle of the axis: its limits, of the process of the file, and its programs
        written, said = plan("touch", *words[:-2], "--probe-noise", "0.5 um", "--tolerance", f"{2 * tolerance_um:.6f} um", "--gauge", "-400 mm, 250 mm, -310 mm", "--touch", "x+", "--probe-tool", "9", "--probing-time", "60 s")
        at_min = [row["at_min"] for row in written["probings"]]
        longest_min = max(b - a for a, b in zip(at_min or [0], at_min[1:] + [end_min])) + 1
        s_um = axis.s * axis.factor / 1.96
        step_um = 4 * math.sqrt(2 * 0.25 + 2 * s_um**2 * (1 - math.exp(-longest_min / axis.T)))
        expect(abs(written["step_um"] - step_um) < 2e-3 * step_um and abs(written["first_step_um"] - 4 * math.sqrt(s_um**2 + 0.25)) < 0.01 * s_um and written["most_um"] == 1000, f"limits {written['first_step_um']}, {written['step_um']}, {written['most_um']}; {step_um}")
        texts = {path.name: path.read_text() for path in (folder / "touch/control").rglob("*.*") if path.is_file()}
        expect(sorted(texts) == ["PROBEX.H", "PROBEX.SPF", "TOUCHX.SPF", "probe_x.ngc"] and "G0 X-405.0000 Y250.0000" in texts["probe_x.ngc"] and "G10 L2 P9" in texts["probe_x.ngc"] and "#5400 NE 9" in texts["probe_x.ngc"], f"{sorted(texts)}")

        # the rest of what is refused: tests/app/probe_refusals_test.cpp
        for words, says in [(["plain.yaml", "--job", "shift"], "--model"), (["plain.yaml", "--model", model], "--job"), (["plain.yaml", "--job", "shift", "--model", model, "--counts", "ring_1"], "--points"),
                            (["plain.yaml", "--job", "shift", "--model", model, "--parts", "0"], "--parts"), (["plain.yaml", "--job", "nope.ngc", "--model", model], "nope.ngc: there is no such file")]:
            done = call("probe-plan", *words, "-o", "refused")
            expect(done.returncode == 2 and says in done.stderr, f"{[str(w) for w in words]}: exit {done.returncode}, {done.stderr.strip()[:160]}")
        expect(not (folder / "refused").exists(), "nothing is left of what was refused")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
