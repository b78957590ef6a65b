#!/usr/bin/python3
"""`driftwright place` on the FP3: places avoid excluded regions, leave less drift than random places and those of the grey grade on cyclograms that were not used for the choice,
and are written as sensors that `check` and `simulate` accept. Wrong options are refused.

    place_verb_test.py PROGRAM FOLDER_OF_THE_PROJECT
"""
import csv
import json
import pathlib
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "shared"))
from claims import caller, expect, failures


def main():
    program, top = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    fp3 = top / "scenarios/fp3_spindle.yaml"
    with tempfile.TemporaryDirectory(prefix="driftwright_place-") as name:
        folder = pathlib.Path(name)
        call = caller(program, folder)
        done = call("place", fp3, "--count", "3", "--points", "80", "--exclude", "quill", "--exclude", "table", "-o", "out")
        expect(done.returncode == 0, f"place: {done.stderr.strip()[-300:]}")
        result = json.loads((folder / "out/place.json").read_text())
        places = result["places"]
        expect(len(places) == 3 and all(p["region"] not in ("quill", "table", "spindle") for p in places), f"places keep out: {[p['region'] for p in places]}")
        expect("spindle" in result["left_out"], "what turns is left out and named")
        expect(len(result["curve"]) == 9, "a curve of 0 to 8")
        for predictor in ("observer", "regression"):
            ways = {w["way"]: w for w in result[f"{predictor}_by_way"]}
            chosen = ways["chosen"]["n3_um"]
            for other in ("grey grade", "random, median"):
                expect(chosen < ways[other]["n3_um"], f"{predictor}: chosen {chosen} um, {other} {ways[other]['n3_um']} um")
            expect(abs(chosen - result["curve"][3][f"{predictor}_um"]) < 1e-9, f"{predictor}: curve and comparison say the same")
        expect(result["curve"][3]["observer_um"] < 0.5 * result["model_alone_um"] < result["drift_um"], "three take off half of what the model alone leaves")
        rows = list(csv.DictReader(line for line in (folder / "out/place.csv").open() if not line.startswith("#")))
        expect([r["entry"] for r in rows] == [p["entry"] for p in places], "place.csv holds the places")
        done = call("check", "out/placed.yaml")
        expect(done.returncode == 0, f"check of placed.yaml: {done.stderr.strip()[-300:]}")
        original, placed = fp3.read_text(), (folder / "out/placed.yaml").read_text()
        added = [line for line in placed.splitlines() if line not in original.splitlines() and not line.startswith("#")]
        expect(len(added) == 3 and all("placed" in line for line in added), f"three lines more: {added}")
        expect((folder / "out/sensors.yaml").read_text().count("- {name: p") == 3, "sensors.yaml has what to paste")
        texts = [p.read_text() for p in sorted((folder / "out/figures").glob("*.svg"))]
        svg = next((t for t in texts if "drift left by one thermometer there" in t), "")
        expect(all(f">p{i}<" in svg for i in (1, 2, 3)), "the picture names the places")
        for words, message in (
            (["--exclude", "tabel"], "--exclude 'tabel': the machine has no such region; there are column, headstock, quill, spindle, bearing_front, bearing_rear, motor, knee, table. Did you mean 'table'?"),
            (["--count", "0"], "--count 0: 1 to 12 is allowed"),
            (["--points", "7"], "--points 7: 50 to 3000 is allowed"),
            (["--noise", "20 um"], "--noise '20 um'"),
            (["--channel", "tilt_x"], "--channel 'tilt_x' is a tilt"),
            (["--train", "chaotik"], "chaotik"),
            (["--for", "all"], "--for"),
        ):
            done = call("place", fp3, *words, "-o", "refused")
            expect(done.returncode == 2 and message in done.stderr and not (folder / "refused").exists(), f"{words}: {done.returncode} {done.stderr.strip()[-250:]}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
