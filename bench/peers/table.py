#!/usr/bin/env python3
"""table.py REFERENCE FOLDER...: one table of all runs of each folder, as text and as FOLDER/table.csv.

REFERENCE is the name of the run that errors are counted against (a fine one of the same semi-discrete system).
"""
import csv
import glob
import json
import os
import sys

import case

COLUMNS = ["run", "exit", "wall_s", "user_s", "peak_MB", "rows", "max_dT_K", "max_du_um", "note"]


def rows_of(folder, reference):
    path = "%s/%s.csv" % (folder, reference)
    fine = case.read_rows(path) if os.path.exists(path) else {}
    for path in sorted(glob.glob(folder + "/*.run.json")):
        with open(path) as file:
            run = json.load(file)
        table = "%s/%s.csv" % (folder, run["name"])
        dT_K = du_um = None
        if fine and os.path.exists(table) and run["name"] != reference:
            dT_K, du_um, n = case.differences(fine, case.read_rows(table))
            if n == 0:  # a run without rows has no error
                dT_K = None
        show = lambda x, digits: "" if x is None else "%.*f" % (digits, x)
        yield [run["name"], run["exit_code"], show(run["wall_s"], 2), show(run["user_s"], 2), show(run["peak_MB"], 0), run["rows"],
               show(dT_K, 4), show(du_um, 4), run["note"]]


for folder in sys.argv[2:]:
    info = case.info(folder)
    print("%s: %d nodes, %d tetrahedra, order %d" % (folder, info["n_nodes"], info["n_cells"], info["order"]))
    form = "  %-28s %4s %9s %9s %8s %5s %9s %9s  %s"
    print(form % tuple(COLUMNS))
    with open(folder + "/table.csv", "w") as file:
        out = csv.writer(file)
        out.writerow(COLUMNS)
        for row in rows_of(folder, sys.argv[1]):
            out.writerow(row)
            print(form % tuple(row))
