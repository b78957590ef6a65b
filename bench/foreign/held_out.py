#!/usr/bin/python3
"""Scores scenario.yaml and extended.yaml on the record that no diagnosis was given.

    held_out.py CASE NAME PROGRAM     writes CASE/NAME.heldout.json: pooled RMSE over noise, before and after, and the RMSE of each channel
"""
import csv
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile


def with_ambient(text, csv_file):
    """The scenario with the ambient temperature of another record."""
    ambient = f"ambient: {{csv: {csv_file}, channel: ambient}}\n"
    return re.sub(r"^(?:ambient|hall):.*?(?=^[^\s\-#]|\Z)", lambda _: ambient, text, count=1, flags=re.M | re.S)


def rows_of(text):
    lines = [x for x in text.splitlines() if x and not x.startswith("#")]
    return {round(float(r["time_s"]), 3): r for r in csv.DictReader(lines)}


def simulated(program, scenario, cyclogram, folder):
    """Rows, or the program's message."""
    with tempfile.TemporaryDirectory() as out:
        try:
            run = subprocess.run([program, "simulate", str(scenario), "--cyclogram", str(cyclogram), "-o", out + "/out"], cwd=folder, capture_output=True, text=True, timeout=120)
        except subprocess.TimeoutExpired:
            return None, "took more than 120 s"
        if run.returncode:
            return None, run.stderr.strip()[:500]
        return rows_of((pathlib.Path(out) / "out" / "record.csv").read_text()), ""


def simulate_file(program, case, file):
    """Beside the file, so that its paths hold; else in a folder with the case's records."""
    holdout = case / "holdout_1.csv"
    text = with_ambient(file.read_text(), holdout)
    message = ""
    with tempfile.TemporaryDirectory() as away:
        beside = file.parent / f".{file.stem}_on_holdout.yaml"
        for place in (beside, pathlib.Path(away) / "scenario.yaml"):
            if place is not beside:
                for record in case.glob("*.csv"):
                    shutil.copy(record, away)
            place.write_text(text)
            rows, message = simulated(program, place, holdout, place.parent)
            place.unlink()
            if rows:
                return rows, message
    return None, message


def score(rows, measured, channels):
    pooled, n, by_channel = 0.0, 0, {}
    for name, noise in channels.items():
        sigma = math.sqrt(noise["sigma"] ** 2 + noise["step"] ** 2 / 12)
        off = [float(rows[t][name]) - float(m[name]) for t, m in measured.items() if t in rows and m[name] and rows[t].get(name)]
        if not off:
            continue
        by_channel[name] = math.sqrt(sum(x * x for x in off) / len(off))
        pooled += sum((x / sigma) ** 2 for x in off)
        n += len(off)
    return (math.sqrt(pooled / n) if n else None), by_channel


def main():
    case, name, program = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], sys.argv[3]
    truth = json.loads((case / "truth.json").read_text())
    measured = rows_of((case / "holdout_1.csv").read_text())
    out = dict(written=False, before=None, after=None, message="")
    rows, out["message"] = simulate_file(program, case, case / "scenario.yaml")
    if rows:
        out["before"], out["rmse_before"] = score(rows, measured, truth["channels"])
    extended = case / name / "extended.yaml"
    if extended.exists() and rows:
        out["written"] = True
        rows, out["message"] = simulate_file(program, case, extended)
        if rows:
            out["after"], out["rmse_after"] = score(rows, measured, truth["channels"])
    (case / (name + ".heldout.json")).write_text(json.dumps(out, indent=1) + "\n")


if __name__ == "__main__":
    main()
