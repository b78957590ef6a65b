#!/usr/bin/env python3
"""Measures the errors of models on rows that were kept out of every fit; no reading is fed back: models.py [--no-diagnosis] PROGRAM DATA OUT [RECORD...]

PROGRAM is driftwright, DATA the folder of the records, OUT a folder for intermediate files; files in it are used again. RECORD limits the run to cases whose record has a name that begins so.
The table has one row for each channel of each split of a record that has a scenario (scenarios/measured): the scenario as written, calibrated, diagnosed (`extended.yaml`), each of the three with what it
misses learned beside it (`identify --prior`), and the network from the records alone (`identify`); RMS on the rows that were kept out. Then follow the geometric mean of each divided by that of the scenario as written, and in how many
rows it is worse by more than 5 %. The script needs only the standard library.
"""

import json
import math
import os
import sys
import time

import records
import score


DRIVES = ("heater_W", "bed_degC")  # recorded columns that drive the machine: read, not predicted
RUN_AND_STOP = "runs: while_spindle_turns}\n"


def fl_thermal(data, fit_h, judge_h, lacks_run_and_stop):
    """The network of fl_thermal, made by hand; its structure and exponents were chosen with all 28 h. Without its heats of run and stop it is a rough scenario."""
    path = os.path.join(data, "fl_thermal", "first_28h.csv")
    return records.parted("fl_thermal" + (", no run/stop" if lacks_run_and_stop else ""), path, f"fit {fit_h[0]}-{fit_h[1]} h, judge {judge_h[0]}-{judge_h[1]} h",
                          records.between(*fit_h), records.between(*judge_h), "ch3_um", [], ambient="t16_degC", scenario="fl_thermal_network")


def scenario_of(case, folder):
    """The scenario as written; a separate file if heats of run and stop are left out."""
    path = os.path.join(score.ROOT, "scenarios", "measured", case.scenario + ".yaml")
    if "no run/stop" not in case.record:
        return path
    rough = os.path.join(folder, "rough.yaml")
    with open(path, encoding="utf-8") as source, open(rough, "w", encoding="utf-8") as out:
        out.writelines(line for line in source if not ("heat_source" in line and line.endswith(RUN_AND_STOP)))
    return rough


def fitted(case, folder):
    """The records of the fit, as the scenario reads them, cut to their rows."""
    paths = []
    for source in case.fit_files:
        path = score.converted(case, source, os.path.join(folder, "fit_" + os.path.basename(source)))
        if len(case.fit_files) == 1 and case.fit_rows:
            rows = score.raw_rows(path)
            with open(path, "w", newline="", encoding="utf-8") as out:
                score.csv.writer(out, lineterminator="\n").writerows([rows[0], *(r for r in rows[1:] if case.fit_rows(float(r[0])))])
        paths.append(path)
    return paths


def made(program, verb, options, fit, flag, result, folder):
    """Path of the file that a verb writes, and its time; None if it failed."""
    out = os.path.join(folder, verb + "_" + os.path.splitext(result)[0] + ("_of_" + os.path.basename(os.path.dirname(options[-1])) if "--prior" in options else ""))
    path, log = os.path.join(out, result), out + ".log"
    if os.path.exists(path):
        return path
    arguments = [program, verb, *options, "-o", out]
    for record in fit:
        arguments += [flag, record]
    begin = time.time()
    if score.run(arguments, log) != 0:
        print(f"  {verb} {' '.join(options)}: {score.why(log)}", flush=True)
        return None
    print(f"  {os.path.basename(out)}: {time.time() - begin:.0f} s", flush=True)
    return path


def judged(case, program, scenario, folder, name):
    """{channel: RMS} on the kept-out rows."""
    kept = os.path.join(folder, f"judged_{name}.json")
    if os.path.exists(kept):
        return json.load(open(kept, encoding="utf-8"))
    squares = {}
    for source in case.judge_files:
        record = score.converted(case, source, os.path.join(folder, "judge_" + os.path.basename(source)))
        channels, reason = score.simulated_channels(program, scenario, record, folder, f"{name}_{os.path.basename(source)[:-4]}",
                                                     score.base(case.ambient))
        if channels is None:
            print(f"  {name}: {reason}", flush=True)
            return {}
        for header, rows in channels.items():
            for t, y, p in rows:
                if not case.judge_rows or len(case.judge_files) > 1 or case.judge_rows(t):
                    of = squares.setdefault(header, [0, 0.0])
                    of[0] += 1
                    of[1] += (y - p) ** 2
    result = {header: math.sqrt(s / n) for header, (n, s) in squares.items()}
    json.dump(result, open(kept, "w", encoding="utf-8"))
    return result


def main():
    arguments = sys.argv[1:]
    with_diagnosis = "--no-diagnosis" not in arguments
    arguments = [a for a in arguments if not a.startswith("--")]
    program, data, out = (os.path.abspath(p) for p in arguments[:3])
    table, seen = [], set()
    cases = [fl_thermal(data, fit, judge, lacks) for lacks in (False, True) for fit, judge in (((0, 20), (20, 28)), ((8, 28), (0, 8)), ((0, 16), (16, 28)))]
    for case in cases + records.cases(data) + records.later_cases(data):
        key = (case.record, case.split)
        if not case.scenario or key in seen or (arguments[3:] and not any(case.record.startswith(w) for w in arguments[3:])):
            continue
        seen.add(key)
        folder = os.path.join(out, f"{case.record} {case.split}".replace(" ", "_").replace(",", ""))
        os.makedirs(folder, exist_ok=True)
        print(f"{case.record}, {case.split}", flush=True)
        written = scenario_of(case, folder)
        fit = fitted(case, folder)
        models = {"written": written, "calibrated": made(program, "calibrate", [written], fit, "--measured", "calibrated.yaml", folder)}
        if with_diagnosis:
            models["diagnosed"] = made(program, "diagnose", [written], fit, "--measured", "extended.yaml", folder)
        for name, model in list(models.items()):
            if model:
                models[name + "+"] = made(program, "identify", ["--prior", model], fit, "--record", "extended.yaml", folder)
        stem = os.path.splitext(os.path.basename(fit[0]))[0]
        models["identified"] = made(program, "identify", ["--ambient", "t16"] if case.ambient == "t16_degC" else [], fit, "--record", stem + ".yaml", folder)
        left = {name: judged(case, program, model, folder, name) for name, model in models.items() if model}
        for channel in (c for c in left["written"] if c not in DRIVES):
            table.append((f"{case.record}, {case.split}", channel, {name: of.get(channel) for name, of in left.items()}))
    names = ["written", "written+", "calibrated", "calibrated+", *(["diagnosed", "diagnosed+"] if with_diagnosis else []), "identified"]
    print("\n| record, kept out | channel | " + " | ".join(names) + " |\n|" + "---|" * (len(names) + 2))
    for label, channel, left in table:
        print(f"| {label} | {channel} | " + " | ".join("-" if left.get(n) is None else f"{left[n]:.3g}" for n in names) + " |")
    print()
    for name in names[1:]:
        ratios = [left[name] / left["written"] for _, _, left in table if left.get(name) is not None and left["written"] > 0]
        if ratios:
            print(f"{name} over written: {math.exp(sum(map(math.log, ratios)) / len(ratios)):.2f}, worse by more than 5 % in {sum(r > 1.05 for r in ratios)} of {len(ratios)} rows")


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main()
