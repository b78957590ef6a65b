#!/usr/bin/python3
"""Compares the causes named after the planned test with those after the usual one, case by case.

    score.py FOLDER [--list]

A cause counts as right if its standing is `named` and its kind is that of the truth, or another name for the same thing (../foreign). The difference of two paired shares has the
interval of Wald with the variance of McNemar's table, and McNemar's exact test.
"""
import argparse
import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "foreign"))
from score import kind_right, place_right, wilson

ONE_DRIVE = ("incubator", "heater_plate", "rotary_table")


def outcome(folder, effect):
    path = folder / "diagnosis/diagnosis.json"
    if not path.exists():
        return None
    causes = [c for c in json.loads(path.read_text())["causes"] if c["standing"] == "named"]
    right = [c for c in causes if kind_right(c, effect)]
    return dict(named=bool(right), placed=any(place_right(c, effect, 1) for c in right), wrong=any(not kind_right(c, effect) for c in causes))


def compared(title, cases, before="usual"):
    cases = [c for c in cases if c[before]]
    n = len(cases)
    if n == 0:
        return
    print(f"{title}: {n} cases")
    for figure in ("named", "placed", "wrong"):
        usual, planned = (sum(c[t][figure] for c in cases) for t in (before, "planned"))
        more, fewer = (sum(c[a][figure] and not c[b][figure] for c in cases) for a, b in (("planned", before), (before, "planned")))
        d, se = (more - fewer) / n, math.sqrt(more + fewer - (more - fewer) ** 2 / n) / n
        p = min(1.0, 2 * sum(math.comb(more + fewer, k) for k in range(min(more, fewer) + 1)) / 2 ** (more + fewer))
        words = dict(named="named, kind right", placed="... and its place", wrong="a wrong name")[figure]
        print(f"  {words:18s} {before} {wilson(usual, n)}   planned {wilson(planned, n)}\n"
              f"  {'':18s} difference {100 * d:+.1f} points [{100 * (d - 1.96 * se):+.1f}, {100 * (d + 1.96 * se):+.1f}], {more} only planned, {fewer} only {before}, p = {p:.2g}")


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("folder")
    a.add_argument("--list", action="store_true")
    a = a.parse_args()
    cases, unfinished = [], 0
    for folder in sorted(pathlib.Path(a.folder).glob("case_*")):
        if not (folder / "truth.json").exists():
            continue
        truth = json.loads((folder / "truth.json").read_text())
        effect = truth["effects"][0]
        c = dict(truth=truth, **{t: outcome(folder / t, effect) for t in ("usual", "stepped", "planned")})
        if c["usual"] is None or c["planned"] is None:
            unfinished += 1
            continue
        cases.append(c)
        if a.list:
            said = {t: "named" if c[t]["named"] else "wrong" if c[t]["wrong"] else "-" for t in ("usual", "planned")}
            print(f"{folder.name} {truth['family']:16s} {effect['key']:18s} {effect['where']:24s} by {truth['sized_by']:5s} nats {effect['nats_usual']:8.1f} {effect['nats_planned']:8.1f}   {said['usual']:6s} {said['planned']}")
    compared("All", cases)
    for sized_by in ("usual", "job"):
        compared(f"Sized by the {sized_by}", [c for c in cases if c["truth"]["sized_by"] == sized_by])
    compared("All, against the stepped test", cases, "stepped")    # this and the lines below were added after the trial had been run
    for several in (False, True):
        compared("Machines of several drives" if several else "Machines of one drive", [c for c in cases if (c["truth"]["family"] not in ONE_DRIVE) == several])
    for kind in sorted({c["truth"]["kind"] for c in cases}):
        of = [c for c in cases if c["truth"]["kind"] == kind]
        print(f"  {kind:18s} {len(of)}: usual {sum(c['usual']['named'] for c in of)}, planned {sum(c['planned']['named'] for c in of)}")
    if unfinished:
        print(f"{unfinished} without both diagnoses")


if __name__ == "__main__":
    main()
