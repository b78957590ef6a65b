#!/usr/bin/env python3
"""The scoreboard with probings: what a touch probe of 1 um noise leaves of measured drifts, each hour and each four hours.

Rows are those of splits.toml whose target is a displacement; they were fixed before any of them was probed by the program, and are regression data since. Probings are cut
from the judged displacement itself. Of each row: the drift; the last probing held, without a model (computed here); `no correction` with the filter of probings; the
strategy that `validate` chooses without and with probings. A row counts for an interval if its longest judged run is three intervals long at least. Standard library only.
"""

import argparse
import math
import os
import random
import statistics
import sys

import program
import records

SETS = ["older", "later", "third"]
RECORDS = ["fl_thermal", "imbd_lathe", "lathe", "printer_frame", "sjtu_spindle", "spindle_22"]
INTERVALS_H = [1, 4]
NOISE_UM = 1.0
LEAST_INTERVALS = 3


def group(case):
    """Rows of one machine; of the lathe in the climate chamber those of one axis."""
    record = case.record.split(" ")[0]
    return f"{record} {records.base(case.target)}" if record == "imbd_lathe" else record


def judged_runs(case):
    """[(time of the first row of the record, [(time, displacement)] of the judged rows)]: what came before the judged part is known, but no displacement."""
    runs = []
    for table in case.judge:
        y = table.columns[case.target]
        first = next((v for v in y if v is not None), 0.0) if case.from_start else 0.0
        runs.append((table.time_s[0], [(t, v - first) for t, v in zip(table.time_s, y) if v is not None and case.is_judged(t)]))
    return [run for run in runs if len(run[1]) > 1]


def held(runs, every_s, noise_um, seed=1):
    """RMS of the displacement minus the last probing, which counts from the row after it; 0 before the first one. As `validate` does, the first judged row that is an
    interval or more after the first row of the record is probed, and then the first one after each interval."""
    rng, square, n = random.Random(seed), 0.0, 0
    for start_s, run in runs:
        next_s, last = start_s + every_s, 0.0
        for t, y in run:
            square, n = square + (y - last) ** 2, n + 1
            if t >= next_s:
                last = y + rng.gauss(0.0, noise_um)
                next_s += every_s * (1 + (t - next_s) // every_s)
    return math.sqrt(square / n)


def left(case, executable, folder):
    """{(strategy, interval in h or None): RMS} and the chosen strategy; or why there is none."""
    options = ["--probe", ", ".join(f"{h} h" for h in INTERVALS_H), "--probe-noise", f"{NOISE_UM:g} um"]
    ours = program.by_strategies(case, executable, folder, options)
    if "why" in ours:
        return None, ours["why"]
    matrix = {(r["name"], r["every_min"] and round(r["every_min"] / 60.0, 6)): r["rms_um"] for r in ours["validation"]["probing_matrix"]}
    return matrix, ours["name"]


def print_means(found):
    """Geometric means of each machine, and rows in which more is left with probings than without."""
    print("\n| rows | every [h] | n | last probing held | `no correction`, probed | chosen strategy, not probed | chosen strategy, probed | worse than not probed | at most |")
    print("|" + "---|" * 9)
    for name in [*dict.fromkeys(g for g, *_ in found), "all"]:
        for h in INTERVALS_H:
            rows = [r for g, at_h, *r in found if at_h == h and name in (g, "all")]
            if rows:
                means = [statistics.geometric_mean(column) for column in zip(*rows)]
                over = [probed / bare for *_, bare, probed in rows]
                print(f"| {name} | {h} | {len(rows)} | " + " | ".join(f"{m:.2f}" for m in means) + f" | {sum(o > 1.0 for o in over)} | {max(over):.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="driftwright")
    parser.add_argument("-d", "--data", default=os.path.join(program.ROOT, "..", "shared", "data"), help="folder of the records [../shared/data]")
    parser.add_argument("-o", "--out", default="/tmp/driftwright_probe", help="folder for what is made on the way [/tmp/driftwright_probe]")
    parser.add_argument("records", nargs="*", metavar="RECORD", help="only rows whose record has a name that begins so")
    options = parser.parse_args()
    found = []
    print("| row | target | every [h] | drift [um] | last probing held | `no correction`, probed | strategy | not probed | probed |")
    print("|" + "---|" * 9)
    for case in [c for s in SETS for c in records.cases(options.data, s, options.records or RECORDS) if c.unit == "um"]:
        runs = judged_runs(case)
        intervals = [h for h in INTERVALS_H if max((run[-1][0] - run[0][0] for _, run in runs), default=0.0) >= 3600.0 * h * LEAST_INTERVALS]
        if not intervals or case.record == "fl_thermal_network":
            continue
        folder = os.path.join(os.path.abspath(options.out), case.id)
        os.makedirs(folder, exist_ok=True)
        matrix, chosen = left(case, os.path.abspath(options.program), folder)
        if matrix is None:
            print(f"| {case.id} | {records.base(case.target)} | - | {chosen} |", flush=True)
            continue
        for h in intervals:
            row = [held(runs, 3600.0 * h, NOISE_UM), matrix["no correction", h], matrix[chosen, None], matrix[chosen, h]]
            found.append((group(case), h, *row))
            print(f"| {case.id} | {records.base(case.target)} | {h} | {matrix['no correction', None]:.2f} | {row[0]:.2f} | {row[1]:.2f} | {chosen} | {row[2]:.2f} | {row[3]:.2f} |", flush=True)
    print_means(found)


if __name__ == "__main__":
    try:
        main()
    except (ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)
