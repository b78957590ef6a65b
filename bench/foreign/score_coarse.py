#!/usr/bin/python3
"""Figures of the set `coarse` (README.md), of one name of results.

    score_coarse.py FOLDER [--diagnoses diagnosis] [--list]
"""
import argparse
import collections
import json
import pathlib
import statistics

from score import kind_right, place_right, wilson


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("cases")
    a.add_argument("--diagnoses", default="diagnosis")
    a.add_argument("--list", action="store_true", help="one line for each case")
    a = a.parse_args()
    count, verdicts, before, after, causes_of = collections.defaultdict(lambda: [0, 0]), collections.defaultdict(collections.Counter), collections.defaultdict(list), collections.defaultdict(list), collections.defaultdict(list)
    skipped = 0

    def note(cls, figure, yes):
        for c in (cls, "all"):
            count[c, figure][0] += bool(yes)
            count[c, figure][1] += 1

    for folder in sorted(pathlib.Path(a.cases).glob("case_*")):
        truth = json.loads((folder / "truth.json").read_text())
        file, ended = folder / a.diagnoses / "diagnosis.json", folder / (a.diagnoses + ".exit")
        if not file.exists() and not ended.exists():
            skipped += 1
            continue
        d = json.loads(file.read_text()) if file.exists() else dict(verdict="none", causes=[])
        cls, effects, n = truth["class"], truth["effects"], truth["n_records"]
        causes = d.get("causes") or []
        named = [c for c in causes if c.get("standing") == "named"]
        said = causes + [x for c in causes if c.get("standing") == "ambiguous" for x in c.get("alternatives") or []]
        verdicts[cls][d["verdict"]] += 1
        causes_of[cls].append(len(named))
        note(cls, "ended with a diagnosis", file.exists())
        note(cls, "named something", named or d["verdict"] == "named")
        wrong = [c for c in named if not any(kind_right(c, e) for e in effects)]
        if cls == "F":
            e = effects[0]
            note(cls, "right: named, kind and place", any(kind_right(c, e) and place_right(c, e, n) for c in named))
            note(cls, "kind right among the named", any(kind_right(c, e) for c in named))
            note(cls, "kind and place right in any standing, or what cannot be told from it", any(kind_right(c, e) and place_right(c, e, n) for c in said))
            note(cls, "wrong: a named cause whose kind is not right", wrong)
            note(cls, "verdict consistent though a gross fault is hidden", d["verdict"] == "consistent")
        held = folder / (a.diagnoses + ".heldout.json")
        line = f"{folder.name} {cls} {truth['family']:18s} {d['verdict']:12s} truth {','.join(e['key'] + '@' + e['where'] for e in effects) or '-':34s} named {','.join(str(c['effect']) + '@' + str(c.get('where')) for c in named) or '-'}"
        if held.exists():
            h = json.loads(held.read_text())
            if h.get("written"):
                note(cls, "extended file that does not run", h.get("after") is None)
            if h.get("before") is not None and h.get("after") is not None:
                note(cls, "extended file worse on the holdout by more than 5 %", h["after"] > 1.05 * h["before"])
                note(cls, "extended file better on the holdout by more than 5 %", h["after"] < 0.95 * h["before"])
                before[cls].append(h["before"])
                after[cls].append(h["after"])
                line += f"   holdout {h['before']:.3g} -> {h['after']:.3g}{' WORSE' if h['after'] > 1.05 * h['before'] else ''}"
        if a.list:
            print(line)
    print(f"without a try: {skipped}")
    for cls in sorted(verdicts):
        print(f"\nclass {cls}: verdicts " + ", ".join(f"{k} {x}" for k, x in verdicts[cls].most_common()) + f"; causes named per case: {statistics.mean(causes_of[cls]):.2f} in the mean")
        if after[cls]:
            ratio = sorted(y / x for x, y in zip(before[cls], after[cls]))
            print(f"class {cls}: pooled RMSE over noise on the holdout, medians: as written {statistics.median(before[cls]):.2f}, extended {statistics.median(after[cls]):.2f}; "
                  f"after/before: median {statistics.median(ratio):.3f}, {ratio[0]:.3f} to {ratio[-1]:.3f} of {len(ratio)} cases")
    print("\n95 % intervals: Wilson")
    for (cls, figure), x in sorted(count.items()):
        print(f"{cls:4s}{figure:76s} {wilson(*x)}")


if __name__ == "__main__":
    main()
