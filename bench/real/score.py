#!/usr/bin/env python3
"""The scoreboard of measured records: score.py [--strategies] [--later] PROGRAM DATA OUT [RECORD...]

PROGRAM is driftwright, DATA the folder of the records, OUT a folder for what is made on the way; RECORD keeps the cases whose record begins so.
--strategies leaves the diagnosis out; --later takes the splits of records.later_cases().
Prints a table of RMS errors on data kept out, a row a case: plain baselines written apart from the program (baselines.py), the program's strategy
that `validate` chose by the training runs, and the model that `diagnose` made of the training part. A diagnosis that is in OUT is kept. Standard
library only.

How ours is judged: `validate` gets the training runs and the judged runs, a single long record as two parts of its file. The strategy is the one that `validate`
chooses, by the training runs alone; what is judged is never looked at.
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
        rows.writerow(["time_s", *(["speed_rpm"] if case.drive else []), *(n.replace("W_m2", "K").replace("_Ps", "_K") for n in names), base(case.target) + "_um"])
        for i, t in enumerate(table.time_s):
            y = table.columns[case.target][i] if has_target(i) else None
            rows.writerow([number(t), *([number(table.columns[case.drive][i])] if case.drive else []),
                           *(number(table.columns[n][i]) for n in names), number(y)])
    return path


def training_and_judged(case, folder):
    """What `validate` is given: --train, --test. Of a single record its parts, with the target in the rows that are fitted and judged alone."""
    if not case.fit_rows:
        every = lambda _: True  # noqa: E731
        return ([write_run(case, t, os.path.join(folder, "fit_" + t.name), every) for t in case.fit],
                [write_run(case, t, os.path.join(folder, "judge_" + t.name), every) for t in case.judge])
    table = case.fit[0]
    path = write_run(case, table, os.path.join(folder, "record.csv"), lambda _: True)

    def part(keeps):
        times = [t - table.time_s[0] for t in table.time_s if keeps(t)]
        return f"{path}:{times[0] / 60:.6f}min..{times[-1] / 60 + 1e-5:.6f}min"

    return [part(case.fit_rows)], [part(case.judge_rows)]


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
    """Name of the strategy that `validate` chose by the training runs, its RMS with fail-safe and without, and the best one in hindsight."""
    train, test = training_and_judged(case, folder)
    scenario = os.path.join(folder, "study.yaml")
    with open(scenario, "w", encoding="utf-8") as out:
        out.write(f"name: scoreboard\nstudy:\n  target: {base(case.target)}\n  sensors_to_choose: {max(1, min(case.sensors_to_choose, len(case.thermometers)))}\n"
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
        validation = json.load(file)["validation"]
    strategies, chosen = validation["strategies"], validation.get("chosen")
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
        if s["name"] in left:
            n, guarded, unguarded = left[s["name"]]
            found.append((s["name"], math.sqrt(guarded / n), math.sqrt(unguarded / n), s["covered_percent"]))
    mine = next((f for f in found if f[0] == chosen), None)
    if not mine:
        return {"why": "no strategy was chosen: too little can be left out of the training runs"}
    name, guarded, unguarded, covered = mine
    best = min(found, key=lambda f: f[1])
    return {"name": name, "guarded": guarded, "bare": unguarded, "covered": covered, "hindsight": best[0], "hindsight_rms": best[1]}


def converted(case, source, path):
    """The record as the scenario reads it (bench/measured/to_record.py); without a conversion as it is."""
    if not case.conversion:
        with open(source, encoding="utf-8") as whole, open(path, "w", encoding="utf-8") as rows:
            rows.writelines(line for line in whole if not line.startswith("#"))
        return path
    subprocess.run([sys.executable, os.path.join(ROOT, "bench", "measured", "to_record.py"), case.conversion, source, path], check=True)
    return path


def raw_rows(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.reader(file))


def simulated_channels(program, scenario, record, folder, name, ambient=""):
    """{header: [(time, measured, simulated)]} of all channels that record and simulation have, by the scenario driven as the record says; None and why where that fails.

    ambient: the channel of the surroundings, where it is not called so."""
    with open(scenario, encoding="utf-8") as file:
        text = re.sub(r"\bcsv: (?![/\"])", f"csv: {os.path.dirname(scenario)}/", file.read())
    text = re.sub(r"^cyclograms:.*\n", lambda m: m.group(0) + f"  kept_out: {{csv: {record}}}\n", text, count=1, flags=re.M)
    rows = raw_rows(record)
    ambient = "ambient" if "ambient_degC" in rows[0] else ambient
    if ambient:
        text = re.sub(r"^(?:ambient|hall):.*$", f"ambient: {{csv: {record}, channel: {ambient}}}", text, count=1, flags=re.M)
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


def ratio_words(values, words):
    values = sorted(values)
    return f"{words}: median {values[len(values) // 2]:.2f}, worst {values[-1]:.2f}" if values else f"{words}: no row"


def main():
    arguments = sys.argv[1:]
    with_diagnosis = "--strategies" not in arguments
    later = "--later" in arguments
    arguments = [a for a in arguments if not a.startswith("--")]
    program, data, out = (os.path.abspath(p) for p in arguments[:3])
    wanted = arguments[3:]
    columns = ["drift", *baselines.BASELINES, "ours", "bare", *(["as written", "diagnosed"] if with_diagnosis else [])]
    print("| record | kept out | target | " + " | ".join(columns) + " | in its 95 % | strategy | over the best in hindsight |")
    print("|" + "---|" * (len(columns) + 6))
    over_best, over_plain, covered, notes = [], [], [], []
    n_rows = n_worse = 0
    for i, case in enumerate(records.later_cases(data) if later else records.cases(data)):
        if wanted and not any(case.record.startswith(w) for w in wanted):
            continue
        folder = os.path.join(out, f"{'later_' if later else ''}{i:02d}_{case.record.replace(' ', '_')}_{base(case.target)}")
        os.makedirs(folder, exist_ok=True)
        plain = {}
        for name, predict in baselines.BASELINES.items():
            predicted = predict(case)
            plain[name] = None if predicted is None else baselines.rms(case, predicted)
        ours = by_strategies(case, program, folder)
        twin = by_diagnosis(case, program, folder) if with_diagnosis else {}
        drift = baselines.rms(case, baselines.constant(case, 0.0))
        row = {"drift": drift, **plain, "ours": ours.get("guarded"), "bare": ours.get("bare"),
               "as written": twin.get("written"), "diagnosed": twin.get("extended")}
        against = min((v, n) for n, v in plain.items() if v is not None)
        label = f"{case.record}, {case.split}, {base(case.target)}"
        best = "-"
        if "guarded" in ours:
            n_rows += 1
            mine = ours["guarded"]
            hindsight = min(against, (ours["hindsight_rms"], ours["hindsight"]))
            over_best.append(mine / hindsight[0])
            over_plain.append(mine / against[0])
            n_worse += mine > drift
            if ours["covered"] is not None:
                covered.append(ours["covered"])
            best = f"{over_best[-1]:.2f} ({hindsight[1]} {hindsight[0]:.2f})"
        else:
            notes.append(f"{label}: no strategy: {ours['why']}")
        share = ours.get("covered")
        print(f"| {case.record} | {case.split} | {base(case.target)} [{case.unit}] | "
              + " | ".join("-" if row[c] is None else f"{row[c]:.2f}" for c in columns)
              + f" | {'-' if share is None else f'{share:.0f} %'} | {ours.get('name', '-')} | {best} |", flush=True)
        if "why" in twin and case.scenario:
            notes.append(f"{label}: no diagnosed model: {twin['why']}")
        elif "verdict" in twin:
            notes.append(f"{label}: verdict of the diagnosis: {twin['verdict']}")
    print("\n" + ratio_words(over_best, "RMS of the choice over the best strategy or baseline in hindsight"))
    print(f"rows where the choice is worse than no correction: {n_worse} of {n_rows}")
    print(f"rows where the best of {len(baselines.BASELINES)} baselines leaves less by more than 10 %: {sum(r > 1.1 for r in over_plain)} of {n_rows}")
    print(f"rows of the scoreboard whose 95 % interval holds in 90 to 98 % of the judged rows: {sum(90 <= c <= 98 for c in covered)} of {len(covered)}, "
          f"in 90 % or more: {sum(c >= 90 for c in covered)}")
    print("\n".join(notes))


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main()
