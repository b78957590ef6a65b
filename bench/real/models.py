#!/usr/bin/env python3
"""Measures the errors of models on rows that were kept out of every fit; no reading is fed back: models.py [--without=calibrated,diagnosed] PROGRAM DATA OUT [RECORD...]

PROGRAM is driftwright, DATA the folder of the records, OUT a folder for intermediate files; files in it are used again. RECORD limits the run to cases whose record has a name that begins so.
The table has one row for each channel of each split of a record that has a scenario (scenarios/measured): the scenario as written, calibrated, diagnosed (`extended.yaml`), each of the three with what it
misses learned beside it (`identify --prior`), the network from the records alone (`identify`), a plain regression on the drives and the ambient of the same records (baselines.py: memories), and for displacements the
observer that `validate` fits on the scenario with what was learned: it reads thermometers, the others do not. RMS on the rows that were kept out. Then follow the geometric mean of each divided by that of the scenario as written, in how
many rows it is worse by more than 5 %, and both divided by the regression. The script needs only the standard library.
"""

import csv
import dataclasses
import json
import math
import os
import re
import sys
import time

import baselines
import program as runs
import records


DRIVES = ("heater_W", "bed_degC")  # recorded columns that drive the machine: read, not predicted
RUN_AND_STOP = "runs: while_spindle_turns}\n"


def scenario_of(case, folder):
    """The scenario as written; a separate file if heats of run and stop are left out."""
    path = runs.written(case)
    if "no run/stop" not in case.record:
        return path
    rough = os.path.join(folder, "rough.yaml")
    with open(path, encoding="utf-8") as source, open(rough, "w", encoding="utf-8") as out:
        out.writelines(line for line in source if not ("heat_source" in line and line.endswith(RUN_AND_STOP)))
    return rough


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
    if runs.run(arguments, log) != 0:
        print(f"  {verb} {' '.join(options)}: {runs.why(log)}", flush=True)
        return None
    print(f"  {os.path.basename(out)}: {time.time() - begin:.0f} s", flush=True)
    return path


def judged(case, program, scenario, folder, name):
    """{channel: RMS} on the kept-out rows."""
    kept = os.path.join(folder, f"judged_{name}.json")
    if os.path.exists(kept):
        return json.load(open(kept, encoding="utf-8"))
    channels, reason = runs.kept_out(case, program, scenario, folder, name)
    if channels is None:
        print(f"  {name}: {reason}", flush=True)
        return {}
    result = {header: runs.rms(pairs) for header, pairs in channels.items()}
    json.dump(result, open(kept, "w", encoding="utf-8"))
    return result


def regression(case, fit, folder, channel):
    """RMS of a ridge regression on memories of each drive and of the ambient, as the records of the fit and of the kept-out rows have them; None without a reading on both sides."""
    judge = [runs.converted(case, source, os.path.join(folder, "twin_judge_" + os.path.basename(source))) for source in case.judge_files]
    tables = [records.read(path) for path in fit], [records.read(path) for path in judge]
    if any(channel not in t.columns for t in tables[0] + tables[1]):
        return None
    names = tables[0][0].columns
    ambient = next((n for n in ("ambient_degC", case.ambient) if n in names), "")
    same = dataclasses.replace(case, target=channel, fit=tables[0], judge=tables[1], thermometers=[], ambient="", from_start=False)

    def columns(_, table):
        parts = [baselines.memories(dataclasses.replace(same, drive=n), table) for n in ("speed_rpm", *DRIVES) if n in names]
        parts += [baselines.memories(dataclasses.replace(same, drive="", ambient=ambient), table)] if ambient else []
        return [sum(row, []) for row in zip(*parts)]

    predicted = baselines.ridge(same, columns, baselines.PENALTIES)
    if predicted is None:
        return None
    return runs.rms([(y, p) for table, values in zip(tables[1], predicted) for t, y, p in zip(table.time_s, table.columns[channel], values) if y is not None and case.is_judged(t)])


def observed(case, program, scenario, fit, folder, channel):
    """RMS of the observer on the kept-out rows of a displacement; None where `validate` has none."""
    text = re.sub(r"^study:\n(?:[ #].*\n|\n)*", "", runs.text_from_anywhere(scenario), count=1, flags=re.M)
    study = os.path.join(folder, f"observer_{channel}.yaml")
    with open(study, "w", encoding="utf-8") as out:
        out.write(text + f"\nstudy: {{target: {records.base(channel)}, tolerance: 10 um}}\n")
    arguments = [program, "validate", study, "-o", study[:-5]]
    for path in fit:
        arguments += ["--train", path]
    for source in case.judge_files:
        path = runs.converted(case, source, os.path.join(folder, "twin_judge_" + os.path.basename(source)))
        times = [float(r[0]) for r in runs.raw_rows(path)[1:]]
        judged = [t - times[0] for t in times if case.is_judged(t)]
        arguments += ["--test", f"{path}:{judged[0] / 60:.6f}min..{judged[-1] / 60 + 1e-5:.6f}min" if case.judge_rows else path]
    left, log = os.path.join(study[:-5], "strategies.csv"), study[:-5] + ".log"
    if not os.path.exists(left) and runs.run(arguments, log) != 0:
        print(f"  observer of {channel}: {runs.why(log)}", flush=True)
        return None
    squares = rows = 0.0
    with open(left, encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            if row["strategy"] == "observer" and not row["failed_sensor"]:
                squares += float(row["rows"]) * float(row["rms_left_um"]) ** 2
                rows += float(row["rows"])
    return math.sqrt(squares / rows) if rows else None


def kept(path, compute):
    """What `compute` gives, from the file where it is there."""
    if os.path.exists(path):
        return json.load(open(path, encoding="utf-8"))
    value = compute()
    json.dump(value, open(path, "w", encoding="utf-8"))
    return value


def main():
    arguments = sys.argv[1:]
    without = next((a.split("=")[1].split(",") for a in arguments if a.startswith("--without=")), [])
    arguments = [a for a in arguments if not a.startswith("--")]
    program, data, out = (os.path.abspath(p) for p in arguments[:3])
    table, seen = [], set()
    network = records.cases(data, "network", arguments[3:])
    rough = [dataclasses.replace(case, record=case.record + ", no run/stop") for case in network]  # as a first draft of a scenario would be
    for case in network + rough + records.cases(data, "older", arguments[3:]) + records.cases(data, "later", arguments[3:]):
        key = (case.record, case.split)
        if not case.scenario or key in seen:
            continue
        seen.add(key)
        folder = os.path.join(out, f"{case.record} {case.split}".replace(" ", "_").replace(",", ""))
        os.makedirs(folder, exist_ok=True)
        print(f"{case.record}, {case.split}", flush=True)
        written = scenario_of(case, folder)
        fit = runs.fitted(case, folder)
        models = {"written": written}
        for name, verb, file in (("calibrated", "calibrate", "calibrated.yaml"), ("diagnosed", "diagnose", "extended.yaml")):
            if name not in without:
                models[name] = made(program, verb, [written], fit, "--measured", file, folder)
        for name, model in list(models.items()):
            if model:
                models[name + "+"] = made(program, "identify", ["--prior", model], fit, "--record", "extended.yaml", folder)
        stem = os.path.splitext(os.path.basename(fit[0]))[0]
        models["identified"] = made(program, "identify", ["--ambient", "t16"] if case.ambient == "t16_degC" else [], fit, "--record", stem + ".yaml", folder)
        left = {name: judged(case, program, model, folder, name) for name, model in models.items() if model}
        best = next((models[n] for n in ("diagnosed+", "calibrated+", "written+") if models.get(n)), None)
        for channel in (c for c in left["written"] if c not in DRIVES):
            row = {name: of.get(channel) for name, of in left.items()}
            row["regression"] = kept(os.path.join(folder, f"regression_{channel}.json"), lambda of=channel: regression(case, fit, folder, of))
            if best and channel.endswith("_um"):
                row["observer"] = kept(os.path.join(folder, f"observer_{channel}.json"), lambda of=channel: observed(case, program, best, fit, folder, of))
            table.append((f"{case.record}, {case.split}", channel, row))
    names = [n for n in ("written", "written+", "calibrated", "calibrated+", "diagnosed", "diagnosed+", "identified", "regression", "observer") if n.rstrip("+") not in without]
    print("\n| record, kept out | channel | " + " | ".join(names) + " |\n|" + "---|" * (len(names) + 2))
    for label, channel, left in table:
        print(f"| {label} | {channel} | " + " | ".join("-" if left.get(n) is None else f"{left[n]:.3g}" for n in names) + " |")
    print()
    for other in ("written", "regression"):
        for name in (n for n in names if n != other):
            ratios = [left[name] / left[other] for _, _, left in table if left.get(name) and left.get(other)]
            if ratios:
                print(f"{name} over {other}: {math.exp(sum(map(math.log, ratios)) / len(ratios)):.2f}, worse by more than 5 % in {sum(r > 1.05 for r in ratios)} of {len(ratios)} rows")


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main()
