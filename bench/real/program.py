"""How the scoreboard runs the program: strategies by `validate`, models by `simulate` and `diagnose`, each on the records of a Case (records.py). Standard library only."""

import csv
import json
import math
import os
import re
import subprocess
import sys

import records

CAP_S = 1800.0  # for one verb of the program
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def number(v):
    return "" if v is None else f"{v:.9g}"


def write_run(case, table, path):
    """A record CSV of a run; the drive as speed_rpm, the ambient as ambient_degC, a temperature that is a target in K as if in um."""
    drive = ["speed_rpm"] if case.drive else []
    thermometers = ["ambient_degC" if n == case.ambient else n.replace("W_m2", "K").replace("_Ps", "_K") for n in case.thermometers]
    with open(path, "w", newline="", encoding="utf-8") as out:
        rows = csv.writer(out, lineterminator="\n")
        rows.writerow(["time_s", *drive, *thermometers, records.base(case.target) + "_um"])
        columns = [table.columns[n] for n in [case.drive] * len(drive) + case.thermometers + [case.target]]
        for t, *cells in zip(table.time_s, *columns):
            rows.writerow([number(t), *map(number, cells)])
    return path


def training_and_judged(case, folder):
    """What `validate` is given: --train, --test; of a single record two parts of its file."""
    if not case.fit_rows:
        return ([write_run(case, t, os.path.join(folder, "fit_" + t.name)) for t in case.fit],
                [write_run(case, t, os.path.join(folder, "judge_" + t.name)) for t in case.judge])
    table = case.fit[0]
    path = write_run(case, table, os.path.join(folder, "record.csv"))

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


def by_strategies(case, program, folder, options=()):
    """The strategy that `validate` chose by the training runs, its RMS with fail-safe and without, the share of rows that its interval contains [%], and all strategies' RMS;
    `validation` of the summary. options: further ones of `validate`."""
    train, test = training_and_judged(case, folder)
    scenario = os.path.join(folder, "study.yaml")
    with open(scenario, "w", encoding="utf-8") as out:
        out.write(f"name: scoreboard\nstudy:\n  target: {records.base(case.target)}\n  sensors_to_choose: {max(1, min(case.sensors_to_choose, len(case.thermometers)))}\n"
                  f"  count_from_start: {str(case.from_start).lower()}\n  tolerance: 10 um\n")
    arguments = [program, "validate", scenario, "-o", os.path.join(folder, "validate"), *options]
    for file in train:
        arguments += ["--train", file]
    for file in test:
        arguments += ["--test", file]
    log = os.path.join(folder, "validate.log")
    if run(arguments, log) != 0:
        return {"why": why(log)}
    with open(os.path.join(folder, "validate", "summary.json"), encoding="utf-8") as file:
        validation = json.load(file)["validation"]
    strategies, chosen = validation["strategies"], validation.get("chosen", "no correction")  # nothing is chosen: the axis stays as it is
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
    left = {name: (math.sqrt(guarded / n), math.sqrt(bare / n)) for name, (n, guarded, bare) in left.items()}
    mine = next((s for s in strategies if s["name"] == chosen and chosen in left), None)
    if not mine:
        return {"why": "no strategy was chosen"}
    return {"name": chosen, "guarded": left[chosen][0], "bare": left[chosen][1], "covered": mine["covered_percent"], "all": {name: of[0] for name, of in left.items()},
            "validation": validation}


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


def text_from_anywhere(scenario):
    """The text of a scenario whose tables and records are found from any folder: their paths, quoted or not, are made absolute."""
    with open(scenario, encoding="utf-8") as file:
        return re.sub(r'\b(csv: "?)(?![/"])', lambda m: f"{m.group(1)}{os.path.dirname(os.path.abspath(scenario))}/", file.read())


def simulated_channels(program, scenario, record, folder, name, ambient=""):
    """{header: [(time, measured, simulated)]} of all channels that record and simulation have, by the scenario driven as the record says; None and why where that fails.

    ambient: the channel of the surroundings, where it is not called so."""
    text = text_from_anywhere(scenario)
    text = re.sub(r"^cyclograms:.*\n", lambda m: m.group(0) + f"  kept_out: {{csv: {record}}}\n", text, count=1, flags=re.M)
    rows = raw_rows(record)
    ambient = "ambient" if "ambient_degC" in rows[0] else ambient
    if ambient:
        text = re.sub(r"^(?:ambient|hall):.*$", f"ambient: {{csv: {record}, channel: {ambient}}}", text, count=1, flags=re.M)
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


def fitted(case, folder):
    """Paths of the records of the fit, as the scenario reads them, cut to their rows."""
    paths = []
    for source in case.fit_files:
        path = converted(case, source, os.path.join(folder, "twin_fit_" + os.path.basename(source)))
        rows = raw_rows(path)
        with open(path, "w", newline="", encoding="utf-8") as out:
            csv.writer(out, lineterminator="\n").writerows([rows[0], *(r for r in rows[1:] if case.is_fitted(float(r[0])))])
        paths.append(path)
    return paths


def kept_out(case, program, scenario, folder, name):
    """{header: [(measured, simulated)]} of the judged rows of all runs, by simulated_channels(); None and why where that fails."""
    result = {}
    for source in case.judge_files:
        file = os.path.basename(source)
        record = converted(case, source, os.path.join(folder, "twin_judge_" + file))
        channels, reason = simulated_channels(program, scenario, record, folder, f"{name}_{file[:-4]}", records.base(case.ambient))
        if channels is None:
            return None, reason
        for header, rows in channels.items():
            result.setdefault(header, []).extend((y, p) for t, y, p in rows if case.is_judged(t))
    return result, ""


def rms(pairs):
    """Root mean square of the differences of pairs."""
    return math.sqrt(sum((y - p) ** 2 for y, p in pairs) / len(pairs))


def written(case):
    """Path of the scenario of a case."""
    return os.path.join(ROOT, "scenarios", "measured", case.scenario + ".yaml")


def by_diagnosis(case, program, folder):
    """RMS of the scenario as written and of `extended.yaml` on what was kept out of the diagnosis. A diagnosis that is in the folder is used again."""
    if not case.scenario:
        return {"why": "no scenario of this machine"}
    arguments = [program, "diagnose", written(case), "-o", os.path.join(folder, "diagnosis")]
    for path in fitted(case, folder):
        arguments += ["--measured", path]
    log = os.path.join(folder, "diagnose.log")
    found = os.path.join(folder, "diagnosis", "diagnosis.json")
    if not os.path.exists(found) and run(arguments, log) != 0:
        return {"why": why(log)}
    with open(found, encoding="utf-8") as file:
        result = {"verdict": json.load(file)["verdict"]}
    for key, scenario in (("as written", written(case)), ("diagnosed", os.path.join(folder, "diagnosis", "extended.yaml"))):
        channels, reason = kept_out(case, program, scenario, folder, key.replace(" ", "_"))
        if channels is None:
            return {**result, "why": reason}
        pairs = next((rows for header, rows in channels.items() if records.base(header) == records.base(case.target)), None)
        if not pairs:
            return {**result, "why": f"{case.target} is not both measured and simulated"}
        result[key] = rms(pairs)
    return result
