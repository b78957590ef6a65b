#!/usr/bin/python3
"""Scores diagnoses of a set of cases against their truth; the rules are those of README.md and were written before any diagnosis was run.

    score.py CASES [--diagnoses NAME] [--csv FILE]      reads case_*/truth.json, case_*/NAME/diagnosis.json, case_*/NAME.heldout.json

FILE gets one row for each figure, after those that it has: set, diagnoses, figure, yes, of, share and its 95 % interval in per cent. The tables of docs/theory/diagnosis_trials.md are made of such rows.
"""
import argparse
import collections
import csv
import json
import math
import pathlib
import re
import statistics

SUFFIX = re.compile(r"_(degC|um|urad)$")
MINUTES = dict(min=1.0, s=1 / 60, h=60.0, d=1440.0)
TO_UNIT = {"kJ/K": ("J/K", 1e3), "mK": ("K", 1e-3), "kW": ("W", 1e3), "mm": ("um", 1e3), "percent": ("1", 1e-2), "%": ("1", 1e-2), "": ("1", 1.0), "-": ("1", 1.0)}


def interval(k, n):
    """Share and its 95 % interval (Wilson) [%]."""
    z, p = 1.959964, k / n
    middle, half = (p + z * z / (2 * n)) / (1 + z * z / n), z * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n)
    return 100 * p, 100 * max(0, middle - half), 100 * min(1, middle + half)


def wilson(k, n):
    return "     -" if n == 0 else f"{k:4d} of {n:4d}   {interval(k, n)[0]:5.1f} %   [{interval(k, n)[1]:5.1f}, {interval(k, n)[2]:5.1f}]"


def append_csv(path, rows):
    fresh = not pathlib.Path(path).exists()
    with open(path, "a", newline="") as file:
        out = csv.writer(file)
        out.writerows([["set", "diagnoses", "figure", "yes", "of", "share_percent", "low_percent", "high_percent"]] * fresh + rows)


def cases(folder, name):
    """(case, truth, diagnosis or None) of each case; diagnosis is {} where a run ended without one, None where there was none."""
    for case in sorted(pathlib.Path(folder).glob("case_*")):
        file = case / name / "diagnosis.json"
        d = json.loads(file.read_text()) if file.exists() else {} if (case / (name + ".exit")).exists() else None
        yield case, json.loads((case / "truth.json").read_text()), d


def words(text):
    if isinstance(text, (list, tuple)):
        return set().union(*[words(x) for x in text]) if text else set()
    return {SUFFIX.sub("", w) for w in re.split(r"[^A-Za-z0-9_]+", str(text or "")) if w}


def accepted(effect):
    """(name, place) pairs that count as right for this truth."""
    return [(effect["key"], effect["where"])] + [(a["effect"], a["where"]) for a in effect["also"]]


def kind_right(cause, effect):
    return any(cause.get("effect") == name for name, _ in accepted(effect))


def place_right(cause, effect, n_records):
    for name, where in accepted(effect):
        if cause.get("effect") != name:
            continue
        told = words(cause.get("where"))
        if name == "run_state":
            text = json.dumps({k: v for k, v in cause.items() if k != "alternatives"})
            named = set(re.findall(r"measured_\d+", text))
            truth = set(words(where))
            rest = {f"measured_{i + 1}" for i in range(n_records)} - truth
            if named in (truth, rest):
                return True
        elif name == "expansion":
            if told & words(where):
                return True
        elif "," in where:
            if words(where) - {"hall"} <= told:
                return True
        elif words(where) & told:
            return True
    return False


TIMES = re.compile(r"^(begin|start|from|end|until|length|time)(_?\d+)?$")


def told_windows(cause, last_min):
    """[begin, end] in minutes of all windows of a cause, under any of their names; one without an end lasts."""
    out, begin = [], None
    for p in cause.get("parameters") or []:
        name = TIMES.match(str(p.get("name")))
        values = p.get("value") if isinstance(p.get("value"), list) else [p.get("value")]
        if not name or p.get("unit", "min") not in MINUTES or any(not isinstance(v, (int, float, list)) for v in values):
            continue
        if any(isinstance(v, list) for v in values):
            out += [[x * MINUTES[p.get("unit", "min")] for x in v] for v in values if isinstance(v, list) and len(v) == 2]
            continue
        for v in values:
            v *= MINUTES[p.get("unit", "min")]
            if name[1] in ("begin", "start", "from", "time"):
                if begin is not None:
                    out.append([begin, last_min])
                begin = v
            elif begin is not None:
                out.append([begin, begin + v if name[1] == "length" else v])
                begin = None
    return out + ([[begin, last_min]] if begin is not None else [])


def times_right(causes, effect, last_min):
    """Do the windows of all causes of the right kind together overlap those of the truth by half of what both cover? They may belong to one cause or several."""
    grid = [last_min * (i + 0.5) / 2000 for i in range(2000)]
    told = [w for c in causes if kind_right(c, effect) for w in told_windows(c, last_min)]
    inside = lambda t, windows: any(a <= t < b for a, b in windows)
    both = sum(inside(t, told) and inside(t, effect["windows_min"]) for t in grid)
    either = sum(inside(t, told) or inside(t, effect["windows_min"]) for t in grid)
    return either > 0 and both >= 0.5 * either


def value_in(unit, value):
    if unit in MINUTES:
        return "min", value * MINUTES[unit]
    name, factor = TO_UNIT.get(unit, (unit, 1.0))
    return name, value * factor


def coverage(cause, effect):
    """[(first parameter?, inside?)] for the parameters that both name, in one unit, with an interval."""
    told = {p.get("name"): p for p in cause.get("parameters") or []}
    truth = {p["name"]: p for p in effect["parameters"]}
    if cause.get("effect") != effect["key"]:
        return []
    out = []
    for i, (name, p) in enumerate(truth.items()):
        names = {"time": ["time", "from"], "from": ["from", "time"], "length": ["length"], "further_exponent": []}.get(name, [name])
        mine = next((told[n] for n in names if n in told), None)
        if not mine or not mine.get("ci95") or None in mine["ci95"] or p["value"] == 0:
            continue
        unit, low = value_in(mine.get("unit", "1"), mine["ci95"][0])
        _, high = value_in(mine.get("unit", "1"), mine["ci95"][1])
        true_unit, value = value_in(p["unit"], p["value"])
        if unit != true_unit:
            continue
        values = [value]
        if effect["key"] == "friction_law" and name == "exponent":
            values.append(truth["further_exponent"]["value"])
        if name in ("power", "growth") and "at_speed" in truth:
            at = told.get("at_speed", {}).get("value")
            if at is None:
                continue
            values = [value * (at / truth["at_speed"]["value"]) ** truth["exponent"]["value"]]
        out.append((i == 0, any(low <= v <= high for v in values)))
    return out


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("cases")
    a.add_argument("--diagnoses", default="diagnosis")
    a.add_argument("--list", action="store_true", help="one line for each case")
    a.add_argument("--csv", help="appends the figures to this file")
    a = a.parse_args()
    count = collections.defaultdict(lambda: [0, 0])
    by_kind = collections.defaultdict(lambda: [0, 0, 0, 0, 0])
    ratios, failed, skipped = collections.defaultdict(list), 0, 0

    def note(figure, yes):
        count[figure][0] += bool(yes)
        count[figure][1] += 1

    for folder, truth, d in cases(a.cases, a.diagnoses):
        if d is None:
            skipped += 1
            continue
        ended = bool(d)
        failed += not ended
        d = d or dict(verdict="none")
        causes = d.get("causes") or []
        named = [c for c in causes if c.get("standing") == "named"]
        loose = causes + [x for c in causes if c.get("standing") == "ambiguous" for x in c.get("alternatives") or []]
        said = [c for c in causes if c.get("standing") in ("named", "suspected")]
        effects, n, cls = truth["effects"], truth["n_records"], truth["class"]
        wrong = [c for c in named if not any(kind_right(c, e) for e in effects)] or (["verdict"] if d["verdict"] == "named" and not named else [])
        note(f"{cls} ended with a diagnosis", ended)
        note(f"{cls} wrong name", wrong)
        note("all classes: wrong name", wrong)
        line = f"{folder.name} {cls:3s} {truth['family']:16s} {d['verdict']:12s}"
        if cls == "B":
            note("B verdict consistent", d["verdict"] == "consistent")
            note("B nothing named", ended and not named and d["verdict"] != "named")
        if cls == "K":      # nothing but many small things
            note("K named something", named or d["verdict"] == "named")
        if cls in ("A", "C16", "C8", "F"):
            e = effects[0]
            kind, place = any(kind_right(c, e) for c in named), any(kind_right(c, e) and place_right(c, e, n) for c in named)
            some = any(kind_right(c, e) for c in loose)
            some_place = any(kind_right(c, e) and place_right(c, e, n) for c in loose)
            note(f"{cls} named, kind right", kind)
            note(f"{cls} named, kind and place right", place)
            note(f"{cls} kind right in any standing, or what cannot be told from it", some)
            note(f"{cls} kind and place right in any standing, or what cannot be told from it", some_place)
            note(f"{cls} verdict consistent though something is hidden", d["verdict"] == "consistent")
            if e.get("windows_min") and "ways" in truth:
                last = truth["interval_s"] * max(truth["rows"].values()) / 60
                note(f"{cls} windows: times right (of those with windows, any number of causes)", times_right(named, e, last))
            if cls == "C8":
                note("C8 named or suspected rightly", any(kind_right(c, e) for c in said))
                note("C8 named or suspected wrongly", any(not kind_right(c, e) for c in said))
            t = by_kind[cls[0], e["key"]]
            for i, x in enumerate((True, kind, place, some, bool(wrong))):
                t[i] += x
            line += f" {e['key']:18s} {e.get('nats', e.get('worth')):6.1f}  {'kind' if kind else '----'} {'place' if place else '-----'}"
        if cls == "D":
            # two effects of one kind never occur together with one place; each needs a cause of its own
            def both(causes, placed):
                fits = [{i for i, c in enumerate(causes) if kind_right(c, e) and (not placed or place_right(c, e, n))} for e in effects]
                return any(i != j for i in fits[0] for j in fits[1])

            note("D both named", both(named, False))
            note("D both named, places right", both(named, True))
            note("D one of them named", any(kind_right(c, e) for c in named for e in effects))
            note("D both in any standing, or what cannot be told from it", both(loose, False))
            line += " " + ",".join(e["key"] for e in effects)
        for e in effects:
            for c in named:
                if kind_right(c, e) and place_right(c, e, n):
                    for first, inside in coverage(c, e):
                        note("true value inside its 95 % interval, all comparable parameters", inside)
                        if first:
                            note("true value inside its 95 % interval, first parameter", inside)
                    break
        held = folder / (a.diagnoses + ".heldout.json")
        if held.exists():
            h = json.loads(held.read_text())
            if h.get("written"):
                note("extended file that does not run", h.get("after") is None)
            if h.get("after") is not None:
                worse = h["after"] > 1.05 * h["before"]
                note("extended file worse on the holdout, all classes", worse)
                note(f"{cls} extended file worse on the holdout", worse)
                note(f"{cls} extended file better on the holdout", h["after"] < 0.95 * h["before"])
                ratios[cls].append(h["after"] / h["before"])
                line += f"   holdout {h['before']:.3g} -> {h['after']:.3g}{' WORSE' if worse else ''}"
        if wrong:
            line += "   wrong: " + ",".join(c if isinstance(c, str) else c["effect"] + "@" + str(c.get("where")) for c in wrong)
        if a.list:
            print(line)

    print(f"without a try: {skipped}; ended without a diagnosis (counted as not found): {failed}")
    print("95 % intervals: Wilson")
    for figure in sorted(count):
        print(f"{figure:82s} {wilson(*count[figure])}")
    for cls in sorted(ratios):
        print(f"{cls} RMSE on the holdout, after over before: median {statistics.median(ratios[cls]):.3f}, {min(ratios[cls]):.3f} to {max(ratios[cls]):.3f}")
    if a.csv:
        append_csv(a.csv, [[pathlib.Path(a.cases).resolve().name, a.diagnoses, figure, *count[figure], *(f"{x:.1f}" for x in interval(*count[figure]))] for figure in sorted(count)])
    print(f"\n{'class and truth':24s} {'cases':>6s} {'kind':>6s} {'place':>6s} {'loose':>6s} {'wrong':>6s}     kind, place: named; loose: kind in any standing; wrong: another kind named")
    for (cls, key), t in sorted(by_kind.items()):
        print(f"{cls} {key:22s} " + " ".join(f"{x:6d}" for x in t))


if __name__ == "__main__":
    main()
