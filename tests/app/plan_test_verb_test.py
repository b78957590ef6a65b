#!/usr/bin/python3
"""`driftwright plan-test`: `check` accepts the written programme as a cyclogram, and `simulate` gives the record that was written with it. LinuxCNC's interpreter reads the NC
program, the same seed gives the same plan, and wrong options are refused.

    plan_test_verb_test.py PROGRAM FOLDER_OF_THE_PROJECT
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

AXES = """name: axes
reference_temperature: 20 degC
ambient: [[0 h, 20 degC], [4 h, 21 degC]]
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 5.6 kJ/K}
  - {type: node, node: screw, capacity: 2 kJ/K}
  - {type: node, node: housing, capacity: 19 kJ/K}
  - {type: heat_source, node: spindle, power: 150 W, at_speed: 6000 rpm, exponent: 1.5}
  - {type: servo_loss, node: screw, axis: z, power: 40 W, at_feed: 6 m/min, exponent: 1}
  - {type: link, node: spindle, to: housing, conductance: 12 W/K}
  - {type: link, node: screw, to: housing, conductance: 3 W/K}
  - {type: link, node: housing, to: ambient, conductance: 5 W/K}
sensors: [{name: t_housing, node: housing}, {name: t_ambient, node: ambient}]
displacements: [{name: nose_z, sensitivities: [{node: spindle, sensitivity: 2.5 um/K}, {node: screw, sensitivity: -1 um/K}]}]
"""
JOB = """cyclograms:
  job: {columns: [duration, speed, feed_z], rows: [[2 h, 6000 rpm, 6 m/min]]}
"""


def rows_of(path):
    return list(csv.DictReader(line for line in path.open() if not line.startswith("#")))


def main():
    program, top = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    first = top / "scenarios/first_machine.yaml"
    with tempfile.TemporaryDirectory(prefix="driftwright_plan_test-") as name:
        folder = pathlib.Path(name)
        call = caller(program, folder)
        (folder / "axes.yaml").write_text(AXES + JOB)
        done = call("plan-test", "axes.yaml", "--time", "4 h", "--interval", "30 s", "--programmes", "400", "-o", "axes")
        expect(done.returncode == 0, f"plan-test of spindle and axis: {done.stderr.strip()[-300:]}")
        summary = json.loads((folder / "axes/summary.json").read_text())
        share = {t["test"]: t["share_named"] for t in summary["tests"]}
        expect(share["planned"] > share["usual"] and share["planned"] >= share["stepped"], f"shares {share}")
        sections = summary["programme"]
        expect(abs(sum(s["duration_min"] for s in sections) - 240) < 1e-6, "it lasts for 4 h")
        expect(max(s["speed_rpm"] for s in sections) <= 6000 and max(s["feed_z_mm_min"] for s in sections) <= 6000.001, "no faster than the job")
        expect(any(s["feed_z_mm_min"] > 0 and s["speed_rpm"] == 0 for s in sections) or any(s["feed_z_mm_min"] == 0 and s["speed_rpm"] > 0 for s in sections),
               "spindle and axis are told apart by running one of them alone")
        expect(not (folder / "axes/plan_test.ngc").exists(), "no NC program where axes move")
        expect("t_ambient" not in json.dumps(summary["channels"]), "an ambient thermometer is the ambient record")

        # the written cyclogram replaces the job of the scenario
        (folder / "again.yaml").write_text(AXES + (folder / "axes/plan_test.yaml").read_text() + "\nsolver: {output_interval: 30 s}\n")
        done = call("check", "again.yaml")
        expect(done.returncode == 0, f"check of the written cyclogram: {done.stderr.strip()[-300:]}")
        done = call("simulate", "again.yaml", "-o", "again")
        expect(done.returncode == 0, f"simulate: {done.stderr.strip()[-300:]}")
        said, is_so = rows_of(folder / "axes/record.csv"), rows_of(next((folder / "again").rglob("record*.csv")))
        by_time = {round(float(r["time_s"])): r for r in is_so}
        for channel, allowed in (("t_housing_degC", 0.01), ("nose_z_um", 0.02)):
            most = max(abs(float(r[channel]) - float(by_time[round(float(r["time_s"]))][channel])) for r in said if round(float(r["time_s"])) in by_time)
            expect(most < allowed, f"{channel}: told and simulated differ by {most:.2g}")

        for out in ("one", "two"):
            call("plan-test", first, "--programmes", "300", "--seed", "4", "-o", out)
        expect((folder / "one/summary.json").read_text() == (folder / "two/summary.json").read_text(), "the same seed gives the same plan")
        call("plan-test", first, "--programmes", "300", "--speed-limit", "2000 rpm", "-o", "slow")
        expect(max(s["speed_rpm"] for s in json.loads((folder / "slow/summary.json").read_text())["programme"]) == 2000.0, "--speed-limit is held")
        quiet, loud = (json.loads((folder / "one/summary.json").read_text()), None)
        call("plan-test", first, "--programmes", "300", "--noise-temperature", "0.5 K", "--noise-displacement", "5 um", "-o", "loud")
        loud = json.loads((folder / "loud/summary.json").read_text())
        expect(all(b["share_named"] < a["share_named"] for a, b in zip(quiet["tests"], loud["tests"])), "more noise, fewer faults named")

        if shutil.which("rs274"):
            with open("/tmp/driftwright_one_hal", "a") as turn:  # one HAL per computer, see tests/shared/one_hal.hpp
                fcntl.flock(turn, fcntl.LOCK_EX)
                said = subprocess.run(["rs274", "-g", str(folder / "one/plan_test.ngc")], capture_output=True, text=True, timeout=60)
            dwelt_s = sum(float(s) for s in re.findall(r"DWELL\(([0-9.]+)\)", said.stdout))
            expect(abs(dwelt_s - 8 * 3600) < 1e-3 and "START_SPINDLE_CLOCKWISE" in said.stdout, f"rs274 dwells for {dwelt_s:.0f} s")

        for words, says in [(["--time", "8"], "--time '8'"), (["--time", "1 min"], "--time '1 min'"), (["--interval", "1 h"], "--interval '1 h'"), (["--speed-limit", "3 m"], "--speed-limit"),
                            (["--noise-temperature", "0 K"], "--noise-temperature '0 K'"), (["--noise-displacement", "x"], "--noise-displacement 'x'"), (["--programmes", "3"], "--programmes")]:
            done = call("plan-test", first, *words, "-o", "refused")
            expect(done.returncode == 2 and says in done.stderr, f"{words}: exit {done.returncode}, {done.stderr.strip()[:160]}")
        expect(not (folder / "refused").exists(), "nothing is left of what was refused")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
