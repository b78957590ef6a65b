#!/usr/bin/env python3
"""peer_driftwright.py FOLDER PROGRAM [--heat-only] [--relative R] [--absolute K] [--name NAME]

Writes FOLDER/<name>.yaml, runs `PROGRAM simulate` on it as a whole process (reading the mesh, assembly, influence vectors,
time loop, record) and FOLDER/<name>.csv from its record.
"""
import argparse
import csv

import case
import timed


def scenario(info, options):
    mm = lambda p: "[%s]" % ", ".join("%.9g mm" % (1e3 * x) for x in p)
    text = "name: %s\nreference_temperature: 20 degC\nmachine: {mesh: mesh.msh, units: m}\nmaterials:\n" % options.name
    for region in case.REGIONS:
        text += ("  %s: {density: %g kg/m^3, conductivity: %g W/(m K), heat_capacity: %g J/(kg K), youngs_modulus: %g Pa, "
                 "poisson_ratio: %g, expansion: %g 1/K, source: the comparison's own}\n"
                 % (region, case.DENSITY_kg_m3, case.CONDUCTIVITY_W_mK, case.CAPACITY_J_kgK, case.YOUNGS_MODULUS_Pa,
                    case.POISSON_RATIO, case.EXPANSION_1_K))
    text += "supports: [{surface: bottom, fixed: [x, y, z]}]\neffects:\n"
    for region, power_W in case.POWER_W.items():
        text += ("  - {type: heat_source, region: %s, power: %g W, at_speed: %g rpm, exponent: %g}\n"
                 % (region, power_W, case.SPEED_AT_RATIO_1_rpm, case.EXPONENT))
    text += "  - {type: convection, surface: exterior, film: %g W/(m^2 K)}\n" % case.FILM_W_m2K
    text += "  - {type: fixed_temperature, surface: bottom, follows: ambient}\nambient: [[0 min, 20 degC]]\nsensors:\n"
    for i, (at, region) in enumerate(zip(info["sensors_m"], info["regions"])):
        text += "  - {name: t%d, region: %s, at: %s}\n" % (i, region, mm(at))
    if not options.heat_only:
        text += "displacements:\n"
        for axis in "xyz":
            text += "  - {name: u%s, along: %s, tool: {region: %s, at: %s}}\n" % (axis, axis, info["regions"][-1], mm(info["tip_m"]))
    rows = ", ".join("[%g min, %g rpm]" % (minutes, ratio * case.SPEED_AT_RATIO_1_rpm) for minutes, ratio in case.CYCLOGRAM)
    text += "cyclograms:\n  sections: [%s]\nsolver:\n  output_interval: 1 min\n  fields_format: none\n" % rows
    if options.relative:
        text += "  relative_tolerance: %g\n" % options.relative
    if options.absolute:
        text += "  absolute_tolerance: %g K\n" % options.absolute
    return text


def record_rows(path, heat_only):
    with open(path) as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    for row in rows[1:]:  # row 0 is the start
        values = [float(row["t%d_degC" % i]) - 20.0 for i in range(len(case.SENSORS_m))]
        if not heat_only:
            values += [float(row["u%s_um" % axis]) for axis in "xyz"]
        yield [float(row["time_s"]) / 60.0] + values


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("folder")
    arguments.add_argument("program")
    arguments.add_argument("--heat-only", action="store_true")
    arguments.add_argument("--relative", type=float)
    arguments.add_argument("--absolute", type=float)
    arguments.add_argument("--name", default="driftwright")
    arguments.add_argument("--cap", type=int, default=3600)
    arguments.add_argument("--threads", default="")
    options = arguments.parse_args()
    base = options.folder + "/" + options.name
    with open(base + ".yaml", "w") as file:
        file.write(scenario(case.info(options.folder), options))
    outcome = timed.run([options.program, "simulate", base + ".yaml", "-o", base + "_results", "--force"], base + ".log",
                        options.cap, {"OMP_NUM_THREADS": options.threads} if options.threads else {})
    n = 0
    if outcome["exit_code"] == 0:
        with open(base + ".csv", "w") as file:
            for row in record_rows(base + "_results/record.csv", options.heat_only):
                file.write(",".join("%.9g" % x for x in row) + "\n")
                n += 1
    timed.report(options.folder, options.name, outcome, n)


main()
