#!/usr/bin/env python3
"""The scoreboard of measured records: score.py PROGRAM DATA OUT [RECORD...]

PROGRAM is driftwright, DATA the folder of the records, OUT a folder for what is made on the way; RECORD keeps the cases whose record begins so.
Prints a table of RMS errors on data kept out, a row a case: plain baselines written apart from the program (baselines.py), the program's strategy
that was best on training runs left out, and the model that `diagnose` made of the training part. A diagnosis that is in OUT is kept. Standard
library only.

How ours is judged: `validate` gets the training runs and the judged runs. A single long record is given as eight runs, each the whole training part with
the target in an eighth of it alone, so that lags run through; the judged run has the readings of the training part before it, without the target.
The strategy is the one with the smallest prediction interval, which `validate` takes from training runs left out in turn; what is judged is never looked at.
"""

import csv
import json
import math
import os
import re
import subprocess
import sys

import baselines
import records

PARTS = 8  # of a single record, as in baselines.py
CAP_S = float(os.environ.get("cap", "1800"))  # for one verb of the program
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


def number(v):
    return "" if v is None else f"{v:.9g}"


def base(name):
    return re.sub(r"_(degC|K|um|V|W|rpm|W_m2)$", "", name)


def write_run(case, table, path, has_target):
    """A record CSV of a run with the target where has_target(row); the drive as speed_rpm, a temperature that is a target in K as if in um."""
    names = [n for n in case.thermometers]
    with open(path, "w", newline="", encoding="utf-8") as out:
        rows = csv.writer(out, lineterminator="\n")
        rows.writerow(["time_s", *(["speed_rpm"] if case.drive else []), *(n.replace("W_m2", "K") for n in names), base(case.target) + "_um"])
        for i, t in enumerate(table.time_s):
            y = table.columns[case.target][i] if has_target(i) else None
            rows.writerow([number(t), *([number(table.columns[case.drive][i])] if case.drive else []),
                           *(number(table.columns[n][i]) for n in names), number(y)])
    return path


def training_and_judged(case, folder):
    """Files for `validate`: --train, --test."""
    if len(case.fit) > 1:
        every = lambda _: True  # noqa: E731
        return ([write_run(case, t, os.path.join(folder, "fit_" + t.name), every) for t in case.fit],
                [write_run(case, t, os.path.join(folder, "judge_" + t.name), every) for t in case.judge])
    table = case.fit[0]
    fitted = [i for i, t in enumerate(table.time_s) if case.fit_rows(t)]
    judged = [i for i, t in enumerate(table.time_s) if case.judge_rows(t)]
    part = table.rows([case.fit_rows(t) for t in table.time_s])
    train = []
    for f in range(PARTS):
        own = range(len(fitted) * f // PARTS, len(fitted) * (f + 1) // PARTS)
        train.append(write_run(case, part, os.path.join(folder, f"fit_{f + 1}.csv"), lambda i, own=own: i in own))
    until = judged[-1]
    known = table.rows([i <= until for i in range(len(table.time_s))])
    return train, [write_run(case, known, os.path.join(folder, "judge.csv"), lambda i: i >= judged[0])]


def run(arguments, log):
    with open(log, "w", encoding="utf-8") as out:
        try:
            return subprocess.run(arguments, stdout=out, stderr=subprocess.STDOUT, cwd=ROOT, check=False, timeout=CAP_S).returncode
        except subprocess.TimeoutExpired:
            out.write(f"error: not done after {CAP_S:.0f} s\n")
            return 1


def why(log):
    lines = [line.strip() for line in open(log, encoding="utf-8") if line.strip()]
    return next((line for line in reversed(lines) if "error" in line), lines[-1] if lines else "no output")


def by_strategies(case, program, folder):
    """Name of the strategy that was best on training runs left out, its RMS with fail-safe and without, and the best one in hindsight."""
    if not case.thermometers:
        return {"why": "no thermometer to read"}
    train, test = training_and_judged(case, folder)
    scenario = os.path.join(folder, "study.yaml")
    with open(scenario, "w", encoding="utf-8") as out:
        out.write(f"name: scoreboard\nstudy:\n  target: {base(case.target)}\n  sensors_to_choose: {min(case.sensors_to_choose, len(case.thermometers))}\n"
                  f"  count_from_start: {str(case.from_start).lower()}\n  tolerance: 10 um\n")
    arguments = [program, "validate", scenario, "-o", os.path.join(folder, "validate")]
    for file in train:
        arguments += ["--train", file]
    for file in test:
        arguments += ["--test", file]
    log = os.path.join(folder, "validate.log")
    if run(arguments, log) != 0:
        return {"why": why(log)}
    with open(os.path.join(folder, "validate", "summary.json"), encoding="utf-8") as file:
        strategies = json.load(file)["validation"]["strategies"]
    left = {}
    with open(os.path.join(folder, "validate", "strategies.csv"), encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            if row["failed_sensor"]:
                continue
            bare = row["rms_without_fail_safe_um"]
            squares = left.setdefault(row["strategy"], [0.0, 0.0, 0.0])
            n = float(row["rows"])
            squares[0] += n
            squares[1] += n * float(row["rms_left_um"]) ** 2
            squares[2] += n * float(bare) ** 2 if bare else math.inf
    found = []
    for s in strategies:
        if not s["baseline"]:
            n, guarded, unguarded = left[s["name"]]
            found.append((s["interval_95_um"], s["name"], math.sqrt(guarded / n), math.sqrt(unguarded / n)))
    with_interval = [f for f in found if f[0] is not None]
    if not with_interval:
        return {"why": "no strategy has an interval: too few training runs"}
    _, name, guarded, unguarded = min(with_interval)
    best = min(found, key=lambda f: f[2])
    return {"name": name, "guarded": guarded, "bare": unguarded, "hindsight": best[1], "hindsight_rms": best[2]}


def converted(case, source, path):
    """The record as the scenario reads it (bench/measured/to_record.py)."""
    subprocess.run([sys.executable, os.path.join(ROOT, "bench", "measured", "to_record.py"), case.conversion, source, path], check=True)
    return path


def raw_rows(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.reader(file))


def simulated_channels(program, scenario, record, folder, name):
    """{header: [(time, measured, simulated)]} of all channels that record and simulation have, by the scenario driven as the record says; None and why where that fails."""
    with open(scenario, encoding="utf-8") as file:
        text = file.read()
    text = re.sub(r"^cyclograms:.*\n", lambda m: m.group(0) + f"  kept_out: {{csv: {record}}}\n", text, count=1, flags=re.M)
    rows = raw_rows(record)
    if "ambient_degC" in rows[0]:
        text = re.sub(r"^(?:ambient|hall):.*$", f"ambient: {{csv: {record}, channel: ambient}}", text, count=1, flags=re.M)
    # paths of extended.yaml are absolute; it may lie anywhere
    edited, log, out = (os.path.join(folder, name + end) for end in (".yaml", ".log", ""))
    with open(edited, "w", encoding="utf-8") as file:
        file.write(text)
    if run([program, "simulate", edited, "--cyclogram", "kept_out", "-o", out], log) != 0:
        return None, why(log)
    got = raw_rows(os.path.join(out, "record.csv"))
    got = got[next(i for i, r in enumerate(got) if r[0].startswith("time")):]
    t, start_s = [float(r[0]) for r in got[1:]], float(rows[1][0])
    channels = {}
    for column, header in enumerate(rows[0]):
        if column == 0 or header not in got[0] or header.startswith(("speed", "feed", "cutting", "ambient")):
            continue
        y = [float(r[got[0].index(header)]) for r in got[1:]]
        hi = 1
        for row in rows[1:]:
            at = min(max(float(row[0]) - start_s, t[0]), t[-1])
            while hi < len(t) - 1 and t[hi] < at:
                hi += 1
            share = (at - t[hi - 1]) / (t[hi] - t[hi - 1])
            if row[column]:
                channels.setdefault(header, []).append((float(row[0]), float(row[column]), y[hi - 1] + share * (y[hi] - y[hi - 1])))
    return channels, ""


def simulated(case, program, scenario, record, folder, name):
    """The same of the target alone [unit of the record]."""
    channels, reason = simulated_channels(program, scenario, record, folder, name)
    if channels is None:
        return None, reason
    target = next((rows for header, rows in channels.items() if base(header) == base(case.scenario_target)), None)
    return target, "" if target else f"{case.scenario_target} is not both measured and simulated"


def by_diagnosis(case, program, folder):
    """RMS of the scenario as written and of `extended.yaml` on what was kept out of the diagnosis."""
    if not case.scenario:
        return {"why": "no scenario of this machine"}
    written = os.path.join(ROOT, "scenarios", "measured", case.scenario + ".yaml")
    fit = []
    for source in case.fit_files:
        path = converted(case, source, os.path.join(folder, "twin_fit_" + os.path.basename(source)))
        if len(case.fit_files) == 1 and case.fit_rows:
            rows = raw_rows(path)
            with open(path, "w", newline="", encoding="utf-8") as out:
                csv.writer(out, lineterminator="\n").writerows([rows[0], *(r for r in rows[1:] if case.fit_rows(float(r[0])))])
        fit.append(path)
    arguments = [program, "diagnose", written, "-o", os.path.join(folder, "diagnosis")]
    for path in fit:
        arguments += ["--measured", path]
    log = os.path.join(folder, "diagnose.log")
    found = os.path.join(folder, "diagnosis", "diagnosis.json")
    if not os.path.exists(found) and run(arguments, log) != 0:
        return {"why": why(log)}
    with open(found, encoding="utf-8") as file:
        verdict = json.load(file)["verdict"]
    result = {"verdict": verdict}
    for key, scenario in (("written", written), ("extended", os.path.join(folder, "diagnosis", "extended.yaml"))):
        squares = n = 0
        for source in case.judge_files:
            name = os.path.basename(source)
            record = converted(case, source, os.path.join(folder, "twin_judge_" + name))
            pairs, reason = simulated(case, program, scenario, record, folder, f"{key}_{name[:-4]}")
            if pairs is None:
                return {**result, "why": reason}
            for t, y, p in pairs:
                if not case.judge_rows or len(case.judge_files) > 1 or case.judge_rows(t):
                    squares += (y - p) ** 2
                    n += 1
        result[key] = math.sqrt(squares / n)
    return result


def main():
    program, data, out = (os.path.abspath(p) for p in sys.argv[1:4])
    wanted = sys.argv[4:]
    columns = ["drift", *baselines.BASELINES, "ours", "bare", "as written", "diagnosed"]
    print("| record | kept out | target | " + " | ".join(columns) + " | strategy | smallest |")
    print("|" + "---|" * (len(columns) + 5))
    better = {name: [0, 0] for name in baselines.BASELINES}  # rows in which our strategy leaves less, and rows that have both
    wins = losses = 0
    notes = []
    for i, case in enumerate(records.cases(data)):
        if wanted and not any(case.record.startswith(w) for w in wanted):
            continue
        folder = os.path.join(out, f"{i:02d}_{case.record.replace(' ', '_')}_{base(case.target)}")
        os.makedirs(folder, exist_ok=True)
        plain = {}
        for name, predict in baselines.BASELINES.items():
            predicted = predict(case)
            plain[name] = None if predicted is None else baselines.rms(case, predicted)
        ours = by_strategies(case, program, folder)
        twin = by_diagnosis(case, program, folder)
        row = {"drift": baselines.rms(case, baselines.constant(case, 0.0)), **plain, "ours": ours.get("guarded"), "bare": ours.get("bare"),
               "as written": twin.get("written"), "diagnosed": twin.get("extended")}
        against = {n: v for n, v in plain.items() if v is not None}
        mine = {n: v for n, v in (("ours", ours.get("guarded")), ("diagnosed", twin.get("extended"))) if v is not None}
        smallest = min({**against, **mine}.items(), key=lambda e: e[1])[0]
        for name, v in against.items():
            if "ours" in mine:
                better[name][0] += mine["ours"] < v
                better[name][1] += 1
        if mine:
            wins, losses = wins + (smallest in mine), losses + (smallest not in mine)
        print(f"| {case.record} | {case.split} | {base(case.target)} [{case.unit}] | "
              + " | ".join("-" if row[c] is None else f"{row[c]:.2f}" for c in columns)
              + f" | {ours.get('name', '-')} | {'**' + smallest + '**' if smallest in mine else smallest} |", flush=True)
        label = f"{case.record}, {case.split}, {base(case.target)}"
        if "why" in ours:
            notes.append(f"{label}: no strategy: {ours['why']}")
        elif ours["hindsight"] != ours["name"]:
            notes.append(f"{label}: in hindsight {ours['hindsight']} leaves {ours['hindsight_rms']:.2f} {case.unit}")
        if "why" in twin and case.scenario:
            notes.append(f"{label}: no diagnosed model: {twin['why']}")
        elif "verdict" in twin:
            notes.append(f"{label}: verdict of the diagnosis: {twin['verdict']}")
    print(f"\nsmallest error by one of ours in {wins} rows, by a plain baseline in {losses}")
    for name, (n, of) in better.items():
        print(f"the strategy chosen leaves less than '{name}' in {n} of {of} rows")
    print("\n".join(notes))


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main()
