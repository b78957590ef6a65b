#!/usr/bin/env python3
"""peer_calculix.py FOLDER [--mode heat|coupled] [--solver "ITERATIVE SCALING"|SPOOLES] [--step SECONDS] [--cap S] [--name NAME]

CalculiX, backward Euler in fixed steps: temperatures alone (*HEAT TRANSFER) or with displacements (*UNCOUPLED
TEMPERATURE-DISPLACEMENT). A run is ended after --cap seconds; the note then gives the time projected from its increments.
"""
import argparse
import os
import shutil

import case
import timed


def deck(info, options):
    text = ("*INCLUDE, INPUT=mesh.inc\n*MATERIAL, NAME=IRON\n*ELASTIC\n%g, %g\n*EXPANSION, ZERO=0.\n%g\n*CONDUCTIVITY\n%g\n*DENSITY\n%g\n"
            "*SPECIFIC HEAT\n%g\n*SOLID SECTION, ELSET=EALL, MATERIAL=IRON\n*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL, 0.\n"
            % (case.YOUNGS_MODULUS_Pa, case.POISSON_RATIO, case.EXPANSION_1_K, case.CONDUCTIVITY_W_mK, case.DENSITY_kg_m3,
               case.CAPACITY_J_kgK))
    heat = options.mode == "heat"
    step = "HEAT TRANSFER" if heat else "UNCOUPLED TEMPERATURE-DISPLACEMENT"
    for minutes, ratio in case.CYCLOGRAM:
        f = ratio ** case.EXPONENT
        text += "*STEP, INC=1000000\n*%s, DIRECT, SOLVER=%s\n%g, %g\n" % (step, options.solver, options.step, 60 * minutes)
        text += "*BOUNDARY\nNBOT, 11, 11, 0.\n" + ("" if heat else "NBOT, 1, 3, 0.\n") + "*DFLUX, OP=NEW\n"
        for name, region in (("EFB", "front_bearing"), ("ERB", "rear_bearing")):
            text += "%s, BF, %.10g\n" % (name, f * case.POWER_W[region] / info["volume_m3"][region])
        text += "*FILM, OP=NEW\n" + "".join("EF%d, F%d, 0., %g\n" % (k, k, case.FILM_W_m2K) for k in range(1, 5))
        text += "*NODE PRINT, NSET=NSENS, FREQUENCY=%d\nNT%s\n*END STEP\n" % (max(1, round(60 / options.step)), "" if heat else ", U")
    return text


def tables(path):
    """Values by time [s] and node: temperatures and displacements."""
    temperature, displacement, present = {}, {}, None
    with open(path) as file:
        for line in file:
            words = line.split()
            if "time" in line:
                present = (temperature if words[0].startswith("temp") else displacement).setdefault(float(words[-1]), {})
            elif words and present is not None:
                present[int(words[0]) - 1] = [float(x) for x in words[1:]]
    return temperature, displacement


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("folder")
    arguments.add_argument("--mode", default="heat", choices=["heat", "coupled"])
    arguments.add_argument("--solver", default="ITERATIVE SCALING")
    arguments.add_argument("--step", type=float, default=60.0)
    arguments.add_argument("--cap", type=float, default=60.0)
    arguments.add_argument("--name", default="calculix")
    options = arguments.parse_args()
    info = case.info(options.folder)
    base = options.folder + "/" + options.name
    for ending in (".dat", ".sta", ".csv"):
        if os.path.exists(base + ending):
            os.remove(base + ending)
    with open(base + ".inp", "w") as file:
        file.write(deck(info, options))
    threads = str(os.cpu_count())
    outcome = timed.run([shutil.which("ccx"), "-i", options.name], base + ".log", options.cap,
                        {"OMP_NUM_THREADS": threads, "CCX_NPROC_EQUATION_SOLVER": threads}, options.folder)
    temperature, displacement = tables(base + ".dat") if os.path.exists(base + ".dat") else ({}, {})
    n = 0
    with open(base + ".csv", "w") as file:
        for t_s in sorted(temperature):
            row = temperature[t_s]
            if not all(node in row for node in info["sensors"]):
                continue  # cut short within a table
            values = [row[node][0] for node in info["sensors"]]
            values += [1e6 * x for x in displacement.get(t_s, {}).get(info["tip"], [])]
            file.write(",".join("%.9g" % x for x in [t_s / 60.0] + values) + "\n")
            n += 1
    n_all = sum(minutes for minutes, _ in case.CYCLOGRAM)
    note = ""
    if outcome["exit_code"] > 0:
        note = "failed; see its log"
    elif n == 0:
        note = "cut short in the first minute"
    elif n < n_all:
        note = "cut short; projected %.0f s" % (outcome["wall_s"] * n_all / n)
    timed.report(options.folder, options.name, outcome, n, note)


main()
