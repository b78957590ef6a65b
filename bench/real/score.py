#!/usr/bin/env python3
"""The scoreboard of measured records: a table of RMS errors on data kept out, one row for each row of a set in splits.toml, and the figures of each method.

Plain baselines (baselines.py) and the entries of others hand in predictions as CSV (entry.py: what an entrant gets, and what is expected). The strategy of the program is
the one that `validate` chooses by the training part alone; the program judges it itself, on the same rows. Standard library only.
"""

import argparse
import os
import statistics
import sys

import baselines
import entry
import program
import records

PROGRAM, BARE = "Driftwright", "without fail-safe"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-s", "--set", default="older", help="set of splits.toml [older]")
    parser.add_argument("-d", "--data", default=os.path.join(program.ROOT, "..", "shared", "data"), help="folder of the records [../shared/data]")
    parser.add_argument("-o", "--out", default="/tmp/driftwright_real", help="folder for what is made on the way [/tmp/driftwright_real]")
    parser.add_argument("-t", "--seconds", type=float, default=1800.0, help="longest time of one command of the program [1800]")
    parser.add_argument("--program", help="driftwright; without it baselines and entries alone are scored")
    parser.add_argument("--diagnosis", action="store_true", help="score the scenario as written and as `diagnose` extends it, too")
    parser.add_argument("--enter", nargs=2, action="append", default=[], metavar=("NAME", "FOLDER"), help="score FOLDER/<id>.csv of each row as NAME; may be repeated")
    parser.add_argument("--inputs", metavar="FOLDER", help="write what an entrant gets into FOLDER, and stop")
    parser.add_argument("records", nargs="*", metavar="RECORD", help="only rows whose record has a name that begins so")
    return parser.parse_args()


class Scores:
    """RMS of each method in each row, the interval's share of rows, and what is needed to compare them."""

    def __init__(self, case):
        self.case = case
        self.drift = entry.no_correction(case)
        self.rms, self.covered = {}, {}      # by method
        self.rivals = {}                     # RMS of every single strategy and baseline
        self.strategy, self.notes = "-", []

    def enter(self, name, path):
        self.rms[name], self.covered[name] = entry.scored(path, self.case)

    def over_best(self, name):
        return self.rms[name] / min(self.rivals.values())

    def over_baselines(self, name):
        return self.rms[name] / min(self.rms[n] for n in baselines.BASELINES if n in self.rms)


def score_program(scores, options, folder):
    case = scores.case
    ours = program.by_strategies(case, os.path.abspath(options.program), folder)
    if "why" in ours:
        scores.notes.append(f"no strategy: {ours['why']}")
    else:
        scores.rms[PROGRAM], scores.rms[BARE], scores.covered[PROGRAM], scores.strategy = ours["guarded"], ours["bare"], ours["covered"], ours["name"]
        scores.rivals.update(ours["all"])
        theirs = ours["all"].get("no correction", scores.drift)
        if abs(theirs - scores.drift) > 1e-3 * scores.drift:
            scores.notes.append(f"the program judges other rows: without correction it finds {theirs:.4g}, not {scores.drift:.4g}")
    if options.diagnosis:
        twin = program.by_diagnosis(case, os.path.abspath(options.program), folder)
        scores.rms.update({n: twin[n] for n in ("as written", "diagnosed") if n in twin})
        if case.scenario:
            scores.notes.append(f"diagnosis: {twin.get('verdict', 'none')}" + (f", no model: {twin['why']}" if "why" in twin else ""))


def number(v, form="{:.2f}"):
    return "-" if v is None else form.format(v)


def print_row(scores, methods):
    best = min(scores.rivals, key=scores.rivals.get)
    case = scores.case
    print(f"| {case.id} | {case.record}, {case.split} | {records.base(case.target)} [{case.unit}] | {scores.drift:.2f} | "
          + " | ".join(number(scores.rms.get(m)) + (f" ({scores.covered[m]:.0f} %)" if scores.covered.get(m) is not None else "") for m in methods)
          + f" | {scores.strategy} | {best} {scores.rivals[best]:.2f} |", flush=True)


def print_figures(rows, methods):
    print("\n| method | rows | RMS over the best single strategy or baseline in hindsight: median | worst (row) | rows worse than no correction "
          f"| beaten by the best of {len(baselines.BASELINES)} baselines by more than 10 % | RMS over the best of them, geometric mean | 95 % interval holds in 90 to 98 % of the judged rows | in 90 % or more |")
    print("|" + "---|" * 9)
    for m in methods:
        own = [s for s in rows if m in s.rms]
        if own:
            worst = max(own, key=lambda s: s.over_best(m))
            covered = [s.covered[m] for s in own if s.covered.get(m) is not None]
            print(f"| {m} | {len(own)} of {len(rows)} | {statistics.median(s.over_best(m) for s in own):.2f} | {worst.over_best(m):.2f} ({worst.case.id}) "
                  f"| {sum(s.rms[m] > s.drift for s in own)} | {sum(s.over_baselines(m) > 1.1 for s in own)} "
                  f"| {statistics.geometric_mean(max(s.over_baselines(m), 1e-9) for s in own):.2f} "
                  f"| {f'{sum(90 <= c <= 98 for c in covered)} of {len(covered)}' if covered else '-'} "
                  f"| {f'{sum(c >= 90 for c in covered)} of {len(covered)}' if covered else '-'} |")


def main():
    options = arguments()
    if not os.path.isdir(options.data):
        raise ValueError(f"{options.data}: there is no such folder of records; give one with -d")
    cases = records.cases(options.data, options.set, options.records)
    if options.diagnosis and not options.program:
        raise ValueError("--diagnosis requires --program")
    if not cases:
        raise ValueError(f"no row of the set '{options.set}' has a record whose name begins with {' or '.join(options.records)}")
    if options.inputs:
        for case in cases:
            entry.write_inputs(case, options.inputs)
        print(f"{len(cases)} rows in {options.inputs}")
        return
    program.CAP_S = options.seconds
    names = [name for name, _ in options.enter]
    taken = {PROGRAM, BARE, "as written", "diagnosed", *baselines.BASELINES}
    for name in names:
        if name in taken or names.count(name) > 1:
            raise ValueError(f"--enter {name}: this name is taken; choose another")
    rows = [Scores(case) for case in cases]
    for scores in rows:  # before the program runs for long, all entries are read
        for name, folder in options.enter:
            scores.enter(name, os.path.join(folder, scores.case.id + ".csv"))
    methods = [*names, *([PROGRAM, BARE] if options.program else []), *(["as written", "diagnosed"] if options.diagnosis else []), *baselines.BASELINES]
    print("| row | record, kept out | target | drift | " + " | ".join(methods) + " | strategy | best in hindsight |")
    print("|" + "---|" * (len(methods) + 6))
    for scores in rows:
        own = entry.write_inputs(scores.case, os.path.join(options.out, "inputs"))
        for name, path in baselines.enter(own, os.path.join(options.out, "baselines")).items():
            scores.enter(name, path)
            scores.rivals[name] = scores.rms[name]
        if options.program:
            folder = os.path.join(os.path.abspath(options.out), scores.case.id)
            os.makedirs(folder, exist_ok=True)
            score_program(scores, options, folder)
        print_row(scores, methods)
    print_figures(rows, [m for m in methods if m != BARE])  # its rivals have their fail-safe
    print("".join(f"\n{s.case.id}: {note}" for s in rows for note in s.notes))


if __name__ == "__main__":
    try:
        main()
    except (ValueError, OSError, entry.EntryError) as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)
