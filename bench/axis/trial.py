#!/usr/bin/env python3
"""Twelve feed axes whose records another program made (axis_truth.py), each with one fault of three kinds, or none; `diagnose` on
each, and a table of what it says.

    bench/axis/trial.py ./driftwright                     # all twelve; --case 3: one of them; --draw: says what is hidden and runs nothing
    bench/axis/trial.py ./driftwright --seed 20261130 -o /tmp/axis

Kinds, sizes, places, drives and scattered numbers come from the seed. It needs numpy."""

import argparse
import json
import os
import resource
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import numpy as np

import axis_truth as truth

SHIPPED = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scenarios/ball_screw.yaml")
FOLLOWS = dict(nut=("own heat",), bearing=("power of feed_x", "own heat", "own heat, exponent"), scale=("temperature of x_scale",))


def drive(rng):
    """Five to seven stretches: strokes somewhere on the travel, with a rest after each second one."""
    rows = []
    for i in range(rng.integers(5, 8)):
        stroke = float(rng.choice([150, 300, 500, 800]))
        middle = float(np.round(rng.uniform(stroke / 2, 800 - stroke / 2)))
        rows.append((60.0 * 2 * rng.integers(12, 26), float(rng.integers(4, 16)) / 60, middle, stroke))
        if i % 2:
            rows.append((60.0 * 2 * rng.integers(8, 18), 0.0, middle, 0.0))
    return rows


def drawn(seed):
    rng = np.random.default_rng(seed)
    cases = []
    for kind in rng.permutation(["nut", "bearing", "scale", "nothing"] * 3):
        case = dict(kind=str(kind), seed=int(rng.integers(1 << 31)), drives=[drive(rng) for _ in range(2)],
                    air=[(rng.uniform(19, 22), rng.uniform(0.2, 1.0), rng.uniform(4000, 9000)) for _ in range(2)])
        if kind == "nut":
            case["size"] = float(rng.uniform(1.6, 2.4))
            case.update(say="nut's torque times %.2f" % case["size"], quantity="heat", place="x_nut", effect="feed_axis")
        elif kind == "bearing":
            case["place"], case["size"] = str(rng.choice(["x_fixed", "x_far"])), float(rng.uniform(12, 40))
            case.update(say="%.0f W at 15 m/min in %s" % (case["size"], case["place"]), quantity="heat", effect="heat_source")
        elif kind == "scale":
            case["size"] = float(rng.choice([0, 800, rng.uniform(0, 200), rng.uniform(600, 800)]))
            case.update(say="scale fixed at %.0f mm" % case["size"], quantity="displacement", place="x_by_scale", effect="linear_scale")
        else:
            case["say"] = "nothing"
        cases.append(case)
    return cases


def write(case, folder):
    """@returns paths of the records; the scenario is the shipped one, with a start in its first ambient"""
    os.makedirs(folder, exist_ok=True)
    text = open(SHIPPED).read()
    text = text[:text.index("# --- corrections")] + "solver: {output_interval: 2 min}\n"
    text = text.replace("\nambient: [[", "\nstart: ambient\nambient: [[", 1)
    assert "\nstart: ambient" in text
    open(os.path.join(folder, "scenario.yaml"), "w").write(text)
    rng = np.random.default_rng(case["seed"])
    numbers, how = truth.scattered(rng), {}
    if case["kind"] == "nut":
        how = dict(friction=case["size"])
    elif case["kind"] == "bearing":
        how = dict(extra={case["place"]: lambda feed, _mm, _s: case["size"] * feed / 0.25})
    elif case["kind"] == "scale":
        how = dict(fixed_at_mm=case["size"])
    axis, paths = truth.Axis(numbers, **how), []
    for i, (rows, (mean, swing, wave)) in enumerate(zip(case["drives"], case["air"])):
        paths.append(os.path.join(folder, "measured_%d.csv" % (i + 1)))
        truth.write_record(paths[-1], axis, rows, lambda t: mean + swing * np.sin(t / wave), rng)
    return paths


def said(case, folder, program, paths, limit_s):
    out = os.path.join(folder, "diagnosis")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [program, "diagnose", os.path.join(folder, "scenario.yaml"), "-o", out, "--force", "--quiet"]
    for path in paths:
        command += ["--measured", path]
    try:
        run = subprocess.run(command, capture_output=True, text=True, timeout=limit_s)
    except subprocess.TimeoutExpired:
        return dict(verdict="no end within %.0f s" % limit_s)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if run.returncode != 0:
        return dict(verdict="exit %d: %s" % (run.returncode, run.stderr.strip()[-200:]))
    found = json.load(open(os.path.join(out, "diagnosis.json")))
    found["seconds"] = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return found


def judged(case, found):
    """place right, what it follows right, name right; of nothing: silent"""
    statements, causes = found.get("statements", []), found.get("causes", [])
    if case["kind"] == "nothing":
        return [found.get("verdict") == "consistent" and all(s["probability"] < 0.5 for s in statements)] + [None] * 2
    if not statements:
        return [False] * 3
    first = statements[0]
    at = first["quantity"] == case["quantity"] and list(first["place"]) == [case["place"]]
    return [at, at and first["follows"] in FOLLOWS[case["kind"]],
            any(c["effect"] == case["effect"] and c["where"] == case["place"] for c in causes[:1])]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--seed", type=int, default=20261130)
    parser.add_argument("--case", type=int)
    parser.add_argument("--draw", action="store_true")
    parser.add_argument("--limit", type=float, default=1200.0, help="s of one diagnosis")
    parser.add_argument("-o", default="/tmp/axis_trial")
    how = parser.parse_args()
    yes = {True: "yes", False: "**no**", None: ""}
    print("| case | hidden | first statement | probability | place, or silent | follows | first cause | named | CPU [s] |")
    print("|---|---|---|---|---|---|---|---|---|")
    right = []
    for number, case in enumerate(drawn(how.seed)):
        if how.case is not None and number != how.case:
            continue
        folder = os.path.join(how.o, "case_%02d" % number)
        paths = write(case, folder)
        if how.draw:
            print("| %d | %s |" % (number, case["say"]))
            continue
        found = said(case, folder, how.program, paths, how.limit)
        judge = judged(case, found)
        right.append(judge[0])
        first, cause = (found.get("statements") or [None])[0], (found.get("causes") or [None])[0]
        print("| %d | %s | %s | %s | %s | %s | %s | %s | %s |" % (
            number, case["say"], "%s of %s: %s, %s" % (first["quantity"], ", ".join(first["place"]), first["follows"], first["law"]) if first else "none",
            "%.2f" % first["probability"] if first else "", yes[judge[0]], yes[judge[1]],
            "%s at %s (%s)" % (cause["effect"], cause["where"], cause["standing"]) if cause else found["verdict"], yes[judge[2]],
            "%.0f" % found["seconds"] if "seconds" in found else ""), flush=True)
    if right:
        print("\n%d of %d right" % (sum(right), len(right)))


if __name__ == "__main__":
    main()
