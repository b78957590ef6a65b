#!/usr/bin/python3
"""Checks that the record of `follow` is an ordinary record: `diagnose` names the same cause in it as in the rows themselves, a fan that stopped at some time. follow_record_test.py PROGRAM"""
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

MACHINE = """name: spindle
reference_temperature: 20 degC
ambient: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 5.6 kJ/K}
  - {type: node, node: housing, capacity: 19 kJ/K}
  - {type: heat_source, node: spindle, power: 150 W, at_speed: 6000 rpm, exponent: 1.5}
  - {type: link, node: spindle, to: housing, conductance: 12 W/K}
  - {type: link, node: housing, to: ambient, conductance: 5 W/KUNTIL}
sensors: [{name: t_housing, node: housing}]
displacements: [{name: nose_z, sensitivities: [{node: spindle, sensitivity: 2.5 um/K}]}]
cyclograms: {shift: [[120 min, 6000 rpm], [40 min, 0 rpm], [100 min, 3000 rpm], [60 min, 6000 rpm], [90 min, 0 rpm], [120 min, 4500 rpm]]}
"""
FAULT = ", until: 200 min}\n  - {type: link, node: housing, to: ambient, conductance: 2 W/K, from: 200 min"


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory(prefix="driftwright_record-") as folder:
        work = pathlib.Path(folder)
        os.environ["XDG_CACHE_HOME"] = folder + "/cache"
        (work / "good.yaml").write_text(MACHINE.replace("UNTIL", ""))
        (work / "faulty.yaml").write_text(MACHINE.replace("UNTIL", FAULT))

        def call(*words, **more):
            return subprocess.run([program, *words], cwd=folder, check=True, stdout=subprocess.PIPE, text=True, **more)

        call("predict", "faulty.yaml", "--cyclogram", "shift", "-o", "truth", "--quiet")
        rows = [line.split(",") for line in (work / "truth/record.csv").read_text().splitlines() if not line.startswith("#")]
        draw, noise = random.Random(5), {"t_housing_degC": 0.1, "nose_z_um": 0.5}
        measured = [rows[0]] + [[f"{float(v) + draw.gauss(0, noise[n]):.2f}" if n in noise else v for n, v in zip(rows[0], row)] for row in rows[1:]]
        text = "".join(",".join(row) + "\n" for row in measured)
        (work / "hours.csv").write_text(text)
        late = text.splitlines()
        late[100:100] = [late[100], "no row at all", late[97]]  # twice, unreadable, late: none of these rows is recorded
        lines = call("follow", "good.yaml", "--record", "seen.csv", input="\n".join(late) + "\n").stdout.splitlines()
        assert len(lines) == len(rows) - 1 + 3, len(lines)
        found = []
        for record in ("hours", "seen"):
            call("diagnose", "good.yaml", "--measured", f"{record}.csv", "-o", record, "--quiet")
            found.append(json.loads((work / record / "diagnosis.json").read_text()))
        offline, recorded = found
        assert recorded["verdict"] == offline["verdict"] == "named", found
        (cause,) = recorded["causes"]
        assert (cause["effect"], cause["where"]) == (offline["causes"][0]["effect"], offline["causes"][0]["where"]), found
        numbers = {p["name"]: p for p in cause["parameters"]}
        low, high = numbers["factor"]["ci95"]
        assert abs(numbers["factor"]["value"] - 0.4) < 0.02 and low < high, numbers  # 2 of 5 W/K
        print(json.dumps({name: [p["value"], p["unit"]] for name, p in numbers.items()}))


main()
