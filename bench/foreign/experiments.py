#!/usr/bin/python3
"""Makes the experiments that diagnoses of a set propose, by the truth's own program, and diagnoses anew with them (README.md).

    experiments.py SETS.yaml CASES --diagnoses NAME --program driftwright -o OUT [--limit 300] [--only 7 12]

Reads CASES/case_*/truth.json, scenario.yaml, measured_*.csv and NAME/diagnosis.json, and writes nothing there. Per case: OUT/case_*/ with the same files, experiment_1.csv, `diagnosis` (the
results), diagnosis.log and tried.json (what was done; a case that has it is scored as it is, so that a run may be broken off and taken up again).
"""
import argparse
import collections
import copy
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import time

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):     # before numpy: as draw.py has it, for the same bytes
    os.environ.setdefault(variable, "1")
import numpy as np

import draw
import drives
import faults
from draw import noisy
from network import Record, simulate
from score import kind_right, place_right, wilson
from sizing import HALL_SIGMA_K
from writing import record_csv, scenario

NEW_DAY, NEW_THERMOMETER = 2000003, 2000004     # seeds beside those of the cases
FEED = re.compile(r"^feed_(\w)_mm_min$")
QUESTIONS = dict(ambiguous="the cause: ambiguous", suspected="the cause or nothing: suspected", place="the place: named, with alternatives")
RESULTS = ("rightly", "still open", "lost", "wrongly", "no end")


class NotTried(Exception):
    """The proposal cannot be made with this truth, and why."""


# --- the experiment ------------------------------------------------------------------------------------------------------------


def rebuilt(a_set, folder):
    """The case with its machine, true numbers and faults; its files must be those of the folder, byte by byte."""
    seed, index, number = json.loads((folder / "truth.json").read_text())["seed"]
    if seed != a_set["seed"]:
        raise SystemExit(f"{folder}: no case of this set")
    case = draw.attempt(a_set, index, number, *draw.table(a_set)[index])
    for name, text in case.files.items():
        if (folder / name).read_text() != text:
            raise SystemExit(f"{folder}/{name} is not what its seed gives: another set, or another numpy")
    return case


def lasting(case, rng, record):
    """The faults that hold in a record to come, as they hold in the holdout."""
    out = [copy.copy(f) for f in case.hidden if f.holds("holdout_1")]
    words = faults.Words(rng, case.machine, case.plan, [record], case.column, case.noise)
    for f in out:
        f.records = None
        try:
            f.signals = words.signals(f.told["spec"].get("signals"), f.names)
        except faults.Impossible:
            raise NotTried("what acts does not move in this record")
    return out


def new_day(case, rng, sections):
    """A record of a proposed cyclogram: rows as far apart as the case's, and one at each section's beginning; ambient and further column as the family has them."""
    begins = 60.0 * np.concatenate([[0.0], np.cumsum([s["duration_min"] for s in sections])])
    even = np.arange(0.0, begins[-1] + 1e-6, case.interval_s)
    time_s = np.unique(np.round(np.concatenate([even, begins]), 3))
    section = np.clip(np.searchsorted(begins, time_s + 1e-3, side="right") - 1, 0, len(sections) - 1)
    axes = set(case.records[0].feeds)
    for s in sections:
        asked = {FEED.match(k)[1] for k, x in s.items() if FEED.match(k) and x > 0}
        if asked - axes:
            raise NotTried(f"feeds of axes that the machine has not: {sorted(asked - axes)}")

    def held(key):
        return np.array([float(s.get(key, 0.0)) for s in sections])[section]

    hall = np.round(np.interp(time_s, even, drives.hall(rng, even, case.plan.get("outdoor", False))), 2)
    columns = {c: (how["unit"], np.full(len(time_s), how.get("low", 0.0))) for c, how in case.plan.get("columns", {}).items()}
    if case.column:
        name, unit = case.column
        columns[name] = (unit, drives.further(rng, time_s, unit))
    feeds = {a: held(f"feed_{a}_mm_min") / 60000 for a in axes}
    return Record("experiment_1", time_s, held("speed_rpm"), feeds, np.zeros(len(time_s)), hall, columns)


def readings(case, rng, machine, record, hidden, offset_K):
    t, u = (a[0] for a in simulate(machine, case.numbers, record, hidden, np.array([offset_K])))
    return noisy(rng, t, case.noise["temperature"], case.noise["coloured"], record.time_s), noisy(rng, u, case.noise["displacement"], case.noise["coloured"], record.time_s)


def with_thermometer(case, body):
    """The machine with one thermometer more, and its name."""
    if body not in case.machine.bodies:
        raise NotTried(f"a thermometer on {body}, which the truth has not")
    names = {n for n, _ in case.machine.sensors}
    name = next(n for n in [f"t_{body}_new"] + [f"t_{body}_new_{i}" for i in range(2, 9)] if n not in names)
    machine = copy.copy(case.machine)
    machine.sensors = sorted(case.machine.sensors + [(name, body)])
    return machine, name


def again_with(case, rng, machine, name, record):
    """The record as it was measured, and beside it what one thermometer more would have read."""
    t, _ = simulate(machine, case.numbers, record, case.hidden, np.array([case.offsets[record.name]]))
    at = [n for n, _ in machine.sensors].index(name)
    y = noisy(rng, t[0][:, at:at + 1], case.noise["temperature"], case.noise["coloured"], record.time_s)[:, 0]
    lines = case.files[record.name + ".csv"].splitlines()
    return "\n".join([f"{lines[0]},{name}_degC"] + [f"{line},{x:.4f}" for line, x in zip(lines[1:], y)]) + "\n"


def experiment_files(case, index, experiment):
    """(name -> text of scenario and records with the experiment in them, what it is)."""
    measured = case.records[:-1]
    files = {name: case.files[name] for name in ["scenario.yaml"] + [r.name + ".csv" for r in measured]}
    by_sensor = experiment["proposes"] == "extra_sensor"
    machine, name = with_thermometer(case, experiment["extra_sensor"]["region"]) if by_sensor else (case.machine, None)
    if by_sensor:
        files["scenario.yaml"] = scenario(machine, case.interval_s)
    if happened_once(experiment):
        if not by_sensor:
            raise NotTried("it happened once, and no thermometer is proposed")
        rng = np.random.default_rng([case.truth["seed"][0], index, NEW_THERMOMETER])
        for r in measured:
            files[r.name + ".csv"] = again_with(case, rng, machine, name, r)
        return files, f"the records with a thermometer on {experiment['extra_sensor']['region']}"
    rng = np.random.default_rng([case.truth["seed"][0], index, NEW_DAY])
    offset_K = float(np.round(HALL_SIGMA_K * rng.standard_normal(), 3))
    record = new_day(case, rng, experiment["cyclogram"]["sections"])
    t, u = readings(case, rng, machine, record, lasting(case, rng, record), offset_K)
    files["experiment_1.csv"] = record_csv(machine, record, t, u, rng, case.missing)
    return files, experiment["cyclogram"]["name"] + (f" with a thermometer on {experiment['extra_sensor']['region']}" if by_sensor else "")


def happened_once(experiment):
    """What is open does nothing in a new record: the proposal is a record again, should it happen again."""
    return "happened in one record only" in experiment["why"]


def tried(a_set, folder, out, diagnosis, program, limit_s):
    """What was done, for tried.json."""
    experiment = diagnosis["discriminating_experiment"]
    case = rebuilt(a_set, folder)
    if out.exists():      # of a run that was broken off
        shutil.rmtree(out)
    out.mkdir(parents=True)
    try:
        files, what = experiment_files(case, json.loads(case.files["truth.json"])["case"], experiment)
    except NotTried as why:
        return dict(not_tried=str(why))
    for name, text in files.items():
        (out / name).write_text(text)
    command = [program, "diagnose", "scenario.yaml"] + [x for name in sorted(files) if name.endswith(".csv") for x in ("--measured", name)] + ["--as-recorded", "-o", "diagnosis"]
    begin = time.time()
    with open(out / "diagnosis.log", "w") as log:
        # Seconds of the processor: those of the clock say on a shared machine what else ran.
        code = subprocess.run(command, cwd=out, stdout=log, stderr=subprocess.STDOUT, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (int(limit_s), int(limit_s) + 5))).returncode
    return dict(experiment=what, code=code, seconds=round(time.time() - begin), lasting=[f.way for f in case.hidden if f.holds("holdout_1")])


# --- what came of it -----------------------------------------------------------------------------------------------------------


def questions(diagnosis):
    """[(question, cause)]: what the experiment is to answer."""
    out = []
    for c in diagnosis["causes"]:
        if c["standing"] in ("ambiguous", "suspected"):
            out.append((c["standing"], c))
        elif c.get("alternatives"):
            out.append(("place", c))
    return out


def claims(cause):
    return [cause] + (cause.get("alternatives") or [])


def named_in(diagnosis):
    return [c for c in diagnosis["causes"] if c["standing"] == "named"]


def answered(question, cause, before, after, truth):
    """(result, whether the truth was among the claims, a word on the place)."""
    effects, n = truth["effects"], truth["n_records"]
    asked = [e for e in effects if any(kind_right(c, e) for c in claims(cause))]
    stood = bool(asked)
    if not asked:      # then the answer must be an effect that no cause contained
        asked = [e for e in effects if not any(kind_right(x, e) for c in before["causes"] for x in claims(c))]
    if after is None:
        return "no end", stood, ""
    named = named_in(after)
    wrong = [c for c in named if not any(kind_right(c, e) for e in effects)]
    if wrong:
        return "wrongly", stood, "named: " + ", ".join(f"{c['effect']} {c['where']}" for c in wrong)
    if not asked:      # all that is hidden has its cause elsewhere: the answer is that there is nothing in this one's place
        there = any((c["effect"], c["where"]) == (x["effect"], x["where"]) for c in after["causes"] for x in claims(cause))
        return ("still open" if there else "rightly"), stood, ""
    right = [(c, e) for c in named for e in asked if kind_right(c, e)]
    if question == "place":
        told = [(c, e) for c, e in right if place_right(c, e, n)]
        if told:
            return ("still open" if told[0][0].get("alternatives") else "rightly"), stood, ""
        if right:
            return ("still open" if any(place_right(x, e, n) for c, e in right for x in claims(c)) else "wrongly"), stood, "place " + right[0][0]["where"]
    elif right:
        return "rightly", stood, "" if any(place_right(c, e, n) for c, e in right) else "place wrong"
    loose = any(kind_right(x, e) for c in after["causes"] for x in claims(c) for e in asked)
    return ("still open" if loose else "lost"), stood, after["verdict"]


def why_class(experiment):
    if experiment is None:
        return "no proposal"
    if happened_once(experiment):
        return "happened once: a thermometer, should it happen again" if experiment["proposes"] == "extra_sensor" else "happened once, and no thermometer tells"
    if "no cyclogram of the family surely " in experiment["why"]:
        return "a cyclogram that does not surely tell (d' below 5)"
    return "a cyclogram" if experiment["proposes"] == "cyclogram" else "a cyclogram with a thermometer more"


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("set")
    p.add_argument("cases")
    p.add_argument("--diagnoses", default="diagnosis")
    p.add_argument("--program", default="driftwright")
    p.add_argument("-o", "--out", required=True)
    p.add_argument("--limit", type=float, default=300, help="seconds of processor time for each diagnosis")
    p.add_argument("--only", type=int, nargs="*", help="these cases")
    a = p.parse_args()
    program = shutil.which(a.program)
    if not program:
        raise SystemExit(f"no program {a.program}")
    a_set = draw.read_set(a.set)
    program, rows, why = str(pathlib.Path(program).resolve()), [], collections.Counter()
    n_diagnosed = 0
    for folder in sorted(pathlib.Path(a.cases).glob("case_*")):
        file = folder / a.diagnoses / "diagnosis.json"
        if a.only is not None and int(folder.name[5:]) not in a.only:
            continue
        if not file.exists() or not (folder / (a.diagnoses + ".exit")).exists():     # none, or not yet
            continue
        n_diagnosed += 1
        before, truth = json.loads(file.read_text()), json.loads((folder / "truth.json").read_text())
        experiment, open_ones = before.get("discriminating_experiment"), questions(before)
        for question in sorted({q for q, _ in open_ones}):
            why[question, f"verdict {before['verdict']}", why_class(experiment)] += 1
        if not open_ones or experiment is None:
            continue
        out = pathlib.Path(a.out) / folder.name
        if not (out / "tried.json").exists():
            done = tried(a_set, folder, out, before, program, a.limit)
            (out / "tried.json").write_text(json.dumps(done, indent=1) + "\n")
        done = json.loads((out / "tried.json").read_text())
        hidden = ", ".join(f"{e['key']} {e['where']} ({'all' if e['records'] == 'all' else 'lasting' if 'holdout_1' in e['records'] else 'one record'}, {e['nats']:g} nats)" for e in truth["effects"]) or "nothing"
        simulated = experiment["simulated"]
        print(f"\n{folder.name} {truth['class']} {truth['family']}, hidden: {hidden}\n    proposed: {why_class(experiment)}; expected to decide {100 * experiment['decides']:.0f} %"
              + (f" ({100 * experiment['extra_sensor']['decides']:.0f} % with the thermometer)" if experiment["proposes"] == "extra_sensor" else "") + f", forecast {simulated['told']} of {simulated['records']}", flush=True)
        if "not_tried" in done:
            print(f"    not tried: {done['not_tried']}")
        else:
            result = out / "diagnosis" / "diagnosis.json"
            after = json.loads(result.read_text()) if result.exists() and done["code"] == 0 else None
            print(f"    made: {done['experiment']}; exit {done['code']}, {done['seconds']} s")
        for question, cause in open_ones:
            print(f"    {question:10s} " + " | ".join(f"{c['effect']} {c['where']}" for c in claims(cause)))
            if "not_tried" in done:
                rows.append((question, why_class(experiment), None, None))
                continue
            result, stood, more = answered(question, cause, before, after, truth)
            rows.append((question, why_class(experiment), result, stood))
            print(f"    {'':10s} -> {result}{'' if stood else ' (the truth did not stand among the claims)'}{'; ' + more if more else ''}")
        if "not_tried" not in done and after:
            print("    then       " + after["verdict"] + ": " + "; ".join(f"{c['standing']} " + " | ".join(f"{x['effect']} {x['where']}" for x in claims(c)) for c in after["causes"]), flush=True)

    print(f"\n{n_diagnosed} diagnoses; cases with an open question, and what their diagnosis proposes:")
    for (question, verdict, kind), k in sorted(why.items()):
        print(f"  {QUESTIONS[question]:44s} {verdict:20s} {k:3d}  {kind}")
    print("\nopen causes, tried (95 % intervals: Wilson)")
    for question, text in QUESTIONS.items():
        some = [r for r in rows if r[0] == question]
        runs = [r for r in some if r[2]]
        print(f"{text}: {len(some)} with a proposal, {len(runs)} tried")
        for result in RESULTS:
            print(f"    {result:54s} {wilson(sum(r[2] == result for r in runs), len(runs))}")
        among = [r for r in runs if r[3]]
        print(f"    {'rightly, of those with the truth among the claims':54s} {wilson(sum(r[2] == 'rightly' for r in among), len(among))}")
        for kind in sorted({r[1] for r in runs}):
            of = [r for r in runs if r[1] == kind]
            print(f"    {'rightly, ' + kind:60s} {wilson(sum(r[2] == 'rightly' for r in of), len(of))}")


if __name__ == "__main__":
    main()
