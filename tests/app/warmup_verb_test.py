#!/usr/bin/python3
"""`driftwright warmup` on the FP3: `predict`, started from the written programme, gives the drift that the report states. LinuxCNC's interpreter reads the
NC program, and wrong options are refused.

    warmup_verb_test.py PROGRAM FOLDER_OF_THE_PROJECT [--at-length]

Without --at-length the job after a pause of three hours is left out.
"""
import csv
import fcntl
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "shared"))
from claims import caller, expect, failures


LAG = """name: lag
reference_temperature: 20 degC
ambient: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: body, capacity: 20 kJ/K}
  - {type: heat_source, node: body, power: 100 W, at_speed: 1000 rpm, exponent: 1}
  - {type: link, node: body, to: ambient, conductance: 5 W/K}
  - {type: scale_expansion, displacement: nose, lag: 60 min}
sensors: [{name: t_body, node: body}]
displacements: [{name: nose, sensitivities: [{node: body, sensitivity: 1 um/K}]}]
cyclograms:
  job: [[120 min, 600 rpm]]
  fast: [[1 min, 1000 rpm]]
"""


def peak_um(record, columns=("drift_x_um", "drift_y_um", "drift_z_um")):
    rows = list(csv.DictReader(line for line in record.open() if not line.startswith("#")))
    return max(abs(float(row[c]) - float(rows[0][c])) for c in columns for row in rows)


def main():
    program, top = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    fp3 = top / "scenarios/fp3_spindle.yaml"
    with tempfile.TemporaryDirectory(prefix="driftwright_warmup-") as name:
        folder = pathlib.Path(name)
        call = caller(program, folder)
        def way(summary, name):
            return next(w for w in summary["ways"] if w["way"] == name)

        least = {}
        cases = [("cold", []), ("warm", ["--start", "heat_cool_1600", "--after-pause", "20 min"])]
        if "--at-length" in sys.argv:
            cases.append(("cooled", ["--start", "heat_cool_1600", "--after-pause", "3 h"]))
        for out, before in cases:
            done = call("warmup", fp3, "--then", "chaotic", "--tolerance", "12 um", *before, "-o", out)
            expect(done.returncode == 0, f"warmup {before}: {done.stderr.strip()[-300:]}")
            summary = json.loads((folder / out / "summary.json").read_text())
            best = way(summary, "two speeds")
            least[" ".join(before)] = best["duration_min"]
            expect(best["is_enough"] and best["peak_um"] <= 12.0, f"{before}: {best}")
            expect(best["duration_min"] <= way(summary, "one speed")["duration_min"], "two speeds are no slower than one")
        expect(len(set(least.values())) == len(cases), f"minutes by what was before: {least}")

        summary = json.loads((folder / "cold/summary.json").read_text())
        told = way(summary, "two speeds")["peak_um"]
        corrected = {row["strategy"]: row for row in summary["corrected"]}
        expect(abs(corrected["no correction"]["at_once_um"] - way(summary, "at once")["peak_um"]) < 0.01, "without correction the job at once is the job at once")
        one = way(summary, "one speed")["duration_min"]
        expect(one <= corrected["no correction"]["least_min"] < 1.02 * one, f"without correction as long as one speed: {corrected['no correction']}")
        expect(corrected["observer"]["least_um"] < corrected["one thermometer"]["least_um"] < corrected["no correction"]["least_um"], "an observer leaves less than a thermometer")
        done = call("predict", fp3, "--cyclogram", "chaotic", "--start", "cold/warmup.csv", "-o", "again")
        expect(done.returncode == 0, f"predict behind warmup.csv: {done.stderr.strip()[-300:]}")
        expect(abs(peak_um(folder / "again/record.csv") - told) < 0.01, f"peak told {told:.4f} um, of predict {peak_um(folder / 'again/record.csv'):.4f} um")
        expect(abs(peak_um(folder / "cold/record.csv") - told) < 1e-4, "record.csv holds that peak")

        (folder / "lag.yaml").write_text(LAG)  # an instrument with memory of the time before the job
        done = call("warmup", "lag.yaml", "--then", "job", "--tolerance", "3 um", "-o", "lag")
        told = way(json.loads((folder / "lag/summary.json").read_text()), "two speeds")
        call("predict", "lag.yaml", "--cyclogram", "job", "--start", "lag/warmup.csv", "-o", "lag_again")
        expect(told["is_enough"] and abs(peak_um(folder / "lag_again/record.csv", ["nose_um"]) - told["peak_um"]) < 0.01,
               f"behind a scale that lags: told {told['peak_um']:.4f} um, of predict {peak_um(folder / 'lag_again/record.csv', ['nose_um']):.4f} um")

        if shutil.which("rs274"):
            with open("/tmp/driftwright_one_hal", "a") as turn:  # one HAL per computer, see tests/shared/one_hal.hpp
                fcntl.flock(turn, fcntl.LOCK_EX)
                said = subprocess.run(["rs274", "-g", str(folder / "cold/warmup.ngc")], capture_output=True, text=True, timeout=60)
            dwelt_s = sum(float(s) for s in re.findall(r"DWELL\(([0-9.]+)\)", said.stdout))
            expect(abs(dwelt_s / 60.0 - way(summary, "two speeds")["duration_min"]) < 1e-3 and "START_SPINDLE_CLOCKWISE" in said.stdout,
                   f"rs274 dwells for {dwelt_s:.0f} s")

        for words, says in [(["--then", "nothing"], "no cyclogram 'nothing'"), (["--then", "chaotic", "--tolerance", "12"], "--tolerance '12'"),
                            (["--then", "chaotic", "--margin", "120 %"], "--margin '120 %'"),
                            (["--then", "chaotic", "--power-limit", "150"], "--power-limit '150'"), (["--then", "chaotic", "--model-error", "0 %"], "--model-error '0 %'"),
                            (["--then", "chaotic", "--margin", "10 %", "--model-error", "10 %"], "--margin"), (["--then", "chaotic", "--channel", "t05"], "--channel 't05'"),
                            (["--then", "chaotic", "--after-pause", "1 h"], "--start"), (["--then", "chaotic", "--time-limit", "1 s"], "--time-limit '1 s'")]:
            done = call("warmup", fp3, *words, "-o", "refused")
            expect(done.returncode == 2 and says in done.stderr, f"{words}: exit {done.returncode}, {done.stderr.strip()[:160]}")
        expect(not (folder / "refused").exists(), "nothing is left of what was refused")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
