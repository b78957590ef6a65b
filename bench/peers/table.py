#!/usr/bin/env python3
"""table.py REFERENCE FOLDER...: one table of all runs of all folders, as text and as FOLDER/table.csv.

REFERENCE is the name of the run that errors are counted against (a fine one of the same semi-discrete system). `times` is
the processor time over Driftwright's for the same results in the same folder: the middle one of driftwright_1 to _3 with
displacements, driftwright_heat without. A run that was cut short has none.
"""
import csv
import glob
import json
import os
import statistics
import sys

import case

COLUMNS = ["nodes", "run", "exit", "wall_s", "processor_s", "times", "peak_MB", "rows", "max_dT_K", "max_du_um", "note"]
FORM = "%9s  %-26s %4s %9s %12s %7s %8s %5s %9s %10s  %s"


def rows_of(folder, reference):
    n_nodes = case.info(folder)["n_nodes"]
    paths = {os.path.basename(path)[:-4]: path for path in glob.glob(folder + "/*.csv")}
    tables = {name: case.read_rows(path) for name, path in paths.items() if name != "table"}
    fine = tables.get(reference, {})
    runs = []
    for path in sorted(glob.glob(folder + "/*.run.json")):
        with open(path) as file:
            runs.append(json.load(file))
    ours = lambda names: [run["processor_s"] for run in runs if run["name"] in names and run["exit_code"] == 0]
    base_s = {True: ours(["driftwright_1", "driftwright_2", "driftwright_3"]), False: ours(["driftwright_heat"])}
    show = lambda x, digits: "" if x is None else "%.*f" % (digits, x)
    for run in runs:
        rows = tables.get(run["name"], {})
        dT_K = du_um = times = None
        if run["name"] != reference and any(minute in fine for minute in rows):  # a run without rows has no error
            dT_K, du_um, _ = case.differences(fine, rows)
        base = base_s[any(len(row) > len(case.SENSORS_m) for row in rows.values())]
        if base and len(rows) == sum(minutes for minutes, _ in case.CYCLOGRAM):
            times = run["processor_s"] / statistics.median(base)
        yield [n_nodes, run["name"], run["exit_code"], show(run["wall_s"], 2), show(run["processor_s"], 2), show(times, 1),
               show(run["peak_MB"], 0), run["rows"], show(dT_K, 4), show(du_um, 4), run["note"]]


print(FORM % tuple(COLUMNS))
for folder in sys.argv[2:]:
    with open(folder + "/table.csv", "w") as file:
        out = csv.writer(file)
        out.writerow(COLUMNS)
        for row in rows_of(folder, sys.argv[1]):
            out.writerow(row)
            print(FORM % tuple(row))
