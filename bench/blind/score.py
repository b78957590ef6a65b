#!/usr/bin/env python3
"""Scores diagnoses of blind cases against their truth: score.py CASES [--diagnoses NAME] [--resolved NAME] [--misses N] [--json FILE]

CASES holds case_*/truth.json (tests/blind), case_*/NAME/diagnosis.json (NAME: diagnosis), and for ambiguous cases the same after the
proposed experiment (NAME: resolved). A case is resolved rightly if each hidden effect is a cause without alternatives at its place, and there is
no other cause.

Same cause, same place:
- A place is the set of its words: "a,b", "b,a" and "a/b" are one.
- Constant heat is one law under three keys: heat_source of exponent 0, coolant and radiation at the same place are one cause.
- A link to the hall is the film of a machine without surfaces: contact "x,hall" and convection "x" are one cause.
The set of a cause is the cause with its alternatives. It contains a truth if it has at most three members and one of them is the truth.
Loudness is d' of truth.json; with two effects the smaller of both, each beside the other. The figures are those of d' >= 10.
The script needs only the standard library.
"""
import argparse
import csv
import glob
import json
import math
import os
import re

LARGEST_SET = 3
RESOLVED = "ambiguous, proposed experiment simulated: resolved rightly"
RESOLVED_CATALOGUE = "the same, without effects that are in no catalogue"
CONSTANT_HEAT = {"heat_source", "coolant", "radiation"}
# Laws that were in no catalogue when cases were drawn with them, but are now: these names count as right.
HELD_SINCE = {"oscillating heat": "heat_source"}


def wilson(hits, n):
    """95 % interval of a share (Wilson, J. Am. Stat. Assoc. 22 (1927) 209-212)."""
    if n == 0:
        return 0.0, 1.0
    z = 1.959964
    share, scale = hits / n, 1.0 + z * z / n
    middle = (share + z * z / (2 * n)) / scale
    half = z * math.sqrt(share * (1 - share) / n + z * z / (4 * n * n)) / scale
    return max(0.0, middle - half), min(1.0, middle + half)


def place(where):
    return frozenset(w for w in re.split(r"[,/\s]+", where or "") if w)


def forms(effect, where, constant):
    """All (key, place) that say the same thing."""
    at = place(where)
    same = {(effect, at)}
    if effect in CONSTANT_HEAT and constant:
        same |= {(key, at) for key in CONSTANT_HEAT}
    if effect == "contact" and "hall" in at:
        same.add(("convection", at - {"hall"}))
    if effect == "convection":
        same.add(("contact", at | {"hall"}))
    return same


def truth_forms(effect):
    exponent = [p["value"] for p in effect["parameters"] if p["name"] == "exponent"]
    constant = effect["law"] in ("constant heat", "coolant", "radiation") or exponent == [0.0]
    return forms(effect["effect"], effect["where"], constant)


def same_cause(effect, claim):
    return any(key == claim.get("effect") for key, _ in truth_forms(effect))


def same_place(effect, claim):
    return (claim.get("effect"), place(claim.get("where"))) in truth_forms(effect)


def members(cause):
    return [cause] + cause.get("alternatives", [])


def find(effect, causes):
    """The member that is the truth (at its place if there is one), with its cause; or None."""
    found = None
    for cause in causes:
        if len(members(cause)) > LARGEST_SET:
            continue
        for member in members(cause):
            if same_place(effect, member):
                return cause, member
            if found is None and same_cause(effect, member):
                found = cause, member
    return found


def both_found(effects, causes):
    """Whether two truths are in two different causes."""
    a, b = effects
    holds = [[i for i, c in enumerate(causes) if find(e, [c])] for e in (a, b)]
    return any(i != j for i in holds[0] for j in holds[1])


def resolved_rightly(effects, diagnosis):
    """Whether each truth is a cause alone at its place, and there is no other cause."""
    causes = diagnosis.get("causes", [])
    return (len(causes) == len(effects) and all(len(members(c)) == 1 for c in causes)
            and all(any(same_place(e, c) for c in causes) for e in effects))


def read_diagnosis(path):
    """The diagnosis; None if it does not exist or cannot be read."""
    try:
        with open(os.path.join(path, "diagnosis.json"), encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return None


def comparable(effect, claim):
    """Pairs of true value and estimate of the same number."""
    pairs = []
    truth = {p["name"]: p for p in effect["parameters"]}
    said = {p["name"]: p for p in claim.get("parameters", [])}
    sign = -1.0 if {effect["effect"], claim["effect"]} == {"coolant", "heat_source"} else 1.0
    of_speed = truth.get("exponent", {}).get("value", 0.0) != 0.0 or "at_speed" in truth
    for name, p in said.items():
        if name not in truth or name in ("at_speed", "exponent") or not p.get("ci95"):
            continue
        value = truth[name]["value"]
        if name in ("power", "growth") and of_speed:
            if "at_speed" not in said:
                continue  # a power without its speed cannot be compared
            ratio = said["at_speed"]["value"] / truth["at_speed"]["value"]
            exponent = truth["exponent"]["value"] if "exponent" in truth else 2.0 if effect["effect"] == "centrifugal" else 1.0
            value *= ratio**exponent
        pairs.append((name, sign * value if name == "power" else value, p["ci95"]))
    return pairs


def loudness(truth):
    if len(truth["effects"]) == 2:
        return min(e["d_prime_beside_others"] for e in truth["effects"])
    return min((e["d_prime"] for e in truth["effects"]), default=math.inf)


def confusable(truth, claim):
    for pattern in truth.get("confusable", []):
        key, where = pattern.split(" ", 1)
        if key == claim["effect"] and (where == "*" or place(where) == place(claim["where"])):
            return True
    return False


def columns(path):
    """Channels of a record CSV without their unit, by time; empty cells are left out."""
    with open(path, encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    return {head.rsplit("_", 1)[0]: {row[0]: float(row[i]) for row in rows[1:] if row[i]} for i, head in enumerate(rows[0]) if i}


def held_out(folder, truth, diagnosis):
    """Residuals of the extended model divided by the noise of each channel, root mean square over channels. A model that
    has the effect and all numbers right leaves only the noise: 1.

    They are computed on holdout.csv if the diagnosis has holdout_prediction.csv, its prediction of that record; else they are those of
    the rows that the diagnosis kept out (`gain`).
    """
    noise = {c["name"]: c["noise"] for c in truth["channels"]}
    prediction = os.path.join(folder, "holdout_prediction.csv")
    if os.path.exists(prediction):
        said, measured = columns(prediction), columns(os.path.join(os.path.dirname(folder), "holdout.csv"))
        rmse = {}
        for name in noise.keys() & said.keys():
            gaps = [said[name][t] - value for t, value in measured[name].items() if t in said[name]]
            rmse[name] = math.sqrt(sum(g * g for g in gaps) / len(gaps))
    else:
        rmse = {g["name"]: g["rmse_after"] for g in (diagnosis.get("gain") or {}).get("channels", []) if g.get("rmse_after") is not None}
    ratios = [value / noise[name] for name, value in rmse.items() if name in noise]
    return math.sqrt(sum(r * r for r in ratios) / len(ratios)) if ratios else None


class Table:
    def __init__(self):
        self.rows = {}

    def add(self, row, hit):
        hits, n = self.rows.get(row, (0, 0))
        self.rows[row] = hits + bool(hit), n + 1

    def show(self, order):
        for row, wanted in order:
            hits, n = self.rows.get(row, (0, 0))
            if n:
                low, high = wilson(hits, n)
                print(f"{row:<62} {wanted:>8} {100 * hits / n:6.1f} %  [{100 * low:5.1f}, {100 * high:5.1f}]  {hits}/{n}")
            else:
                print(f"{row:<62} {wanted:>8}      -                   0/0")


def in_words(causes):
    return "; ".join(" | ".join(f"{m.get('effect')} {m.get('where')}" for m in members(c)) for c in causes) or "nothing"


def told_rightly(table, truth, diagnosis, band, per_law):
    """Adds what a case says by its class to the table. @return whether its cause is told rightly"""
    verdict, causes, kind = diagnosis["verdict"], diagnosis.get("causes", []), truth["class"]
    right = True
    if kind == "one":
        effect = truth["effects"][0]
        found = find(effect, causes)
        alone = len(causes) == 1 and len(members(causes[0])) == 1 and same_cause(effect, causes[0])
        right = found is not None
        table.add("one: cause named or in a set of three" + band, right)
        table.add("one: cause named alone" + band, alone)
        if found:
            table.add("one: its place right" + band, same_place(effect, found[1]))
        if not band:
            table.add("one: no cause beside it", len(causes) <= 1)
            hits, n = per_law.get(effect["law"], (0, 0))
            per_law[effect["law"]] = hits + right, n + 1
        right = right and same_place(effect, found[1])
    elif kind == "two":
        right = both_found(truth["effects"], causes)
        table.add("two: both found" + band, right)
        table.add("two: one or both found" + band, any(find(e, causes) for e in truth["effects"]))
    elif kind == "none":
        right = verdict == "consistent" and not causes
        table.add("none: consistent", right)
    elif kind == "outside":
        since = [dict(e, effect=HELD_SINCE.get(e["law"])) for e in truth["effects"]]
        is_right = not truth["without"] and all(e["effect"] and find(e, causes) for e in since)
        right = verdict != "failed" and (verdict != "named" or is_right)
        of = "taken out of the catalogue" if truth["without"] else "in no catalogue"
        table.add("outside: not confidently misnamed", right)
        table.add(f"outside, {of}: not confidently misnamed", right)
        table.add("outside: something is said to be wrong", verdict not in ("consistent", "failed"))
    else:
        in_set = all(any(same_place(e, m) for c in causes for m in members(c)) for e in truth["effects"])
        wrong = verdict == "named" and not any(same_place(e, m) for e in truth["effects"] for c in causes for m in members(c))
        right = not wrong and verdict != "failed"
        table.add("confounded: not confidently misnamed", right)
        table.add("confounded: truth among what is said", in_set)
        table.add("confounded: said to be ambiguous, or more is asked for", verdict in ("ambiguous", "insufficient_data"))
        table.add("confounded: truth or what it is confused with",
                  any(same_place(e, m) or confusable(truth, m) for e in truth["effects"] for c in causes for m in members(c)))
    return right


def show(table):
    print(f"{'figure':<62} {'wanted':>8} {'got':>8}  {'95 % interval':>14}")
    order = [("one: cause named or in a set of three", ">= 95 %"), ("one: cause named alone", ">= 80 %"),
             ("one: its place right", ">= 90 %"), ("one: no cause beside it", ""), ("two: both found", ">= 85 %"),
             ("two: one or both found", ""), ("none: consistent", ">= 98 %"),
             ("true value inside its 95 % interval", "90-98 %"), ("held-out residual at most 1.1 of the noise", ""),
             ("outside: not confidently misnamed", ">= 95 %"), ("outside, taken out of the catalogue: not confidently misnamed", ""),
             ("outside, in no catalogue: not confidently misnamed", ""), ("outside: something is said to be wrong", ""),
             ("confounded: not confidently misnamed", ""), ("confounded: truth among what is said", ""),
             ("confounded: truth or what it is confused with", ""),
             ("confounded: said to be ambiguous, or more is asked for", ""), (RESOLVED, ">= 90 %"), (RESOLVED_CATALOGUE, "")]
    for band in (", d' 5 to 10", ", d' < 5"):
        order += [(row + band, "") for row in ("one: cause named or in a set of three", "one: cause named alone", "one: its place right",
                                               "two: both found", "two: one or both found")]
    table.show(order)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("cases")
    parser.add_argument("--diagnoses", default="diagnosis")
    parser.add_argument("--resolved", default="resolved")
    parser.add_argument("--misses", type=int, default=1000)
    parser.add_argument("--json")
    options = parser.parse_args()
    table, misses, missing, failed, ratios, per_law, expected = Table(), [], 0, 0, [], {}, []
    for path in sorted(glob.glob(os.path.join(options.cases, "case_*", "truth.json"))):
        folder = os.path.dirname(path)
        with open(path, encoding="utf-8") as file:
            truth = json.load(file)
        diagnosis = read_diagnosis(os.path.join(folder, options.diagnoses))
        if diagnosis is None:
            if not os.path.exists(os.path.join(folder, options.diagnoses + ".log")):
                missing += 1
                continue
            diagnosis = {"verdict": "failed", "causes": []}  # begun and not finished: it counts as wrong
            failed += 1
        verdict, causes, kind, loud = diagnosis["verdict"], diagnosis.get("causes", []), truth["class"], loudness(truth)
        band = "" if loud >= 10 else ", d' 5 to 10" if loud >= 5 else ", d' < 5"
        right = told_rightly(table, truth, diagnosis, band, per_law)
        if kind in ("one", "two"):
            for effect in truth["effects"]:
                found = find(effect, causes)
                if found and same_place(effect, found[1]):
                    for name, value, (low, high) in comparable(effect, found[1]):
                        table.add("true value inside its 95 % interval", low <= value <= high)
        if kind in ("one", "two", "none"):
            ratio = held_out(os.path.join(folder, options.diagnoses), truth, diagnosis)
            if ratio is not None:
                ratios.append(ratio)
                table.add("held-out residual at most 1.1 of the noise", ratio <= 1.1)
        hidden = "; ".join(f"{e['law']} at {e['where']} (d' {e['d_prime_beside_others']:.0f})" for e in truth["effects"]) or "none"
        name = f"case_{truth['seed']:04d} {truth['machine']} {kind}: {hidden}"
        if verdict == "ambiguous":
            experiment = diagnosis.get("discriminating_experiment") or {}
            after = read_diagnosis(os.path.join(folder, options.resolved))
            told = after is not None and resolved_rightly(truth["effects"], after)
            table.add(RESOLVED, told)
            if kind != "outside":
                table.add(RESOLVED_CATALOGUE, told)
            simulated = experiment.get("simulated") or {}
            expected.append((simulated.get("told", 0), simulated.get("records", 0)))
            if not told:
                how = f"{(experiment.get('cyclogram') or {}).get('name')}, expected to decide {100 * experiment.get('decides', 0.0):.0f} %"
                misses.append(f"{name} -> ambiguous: {in_words(causes)}; after {how}: "
                              + ("not diagnosed" if after is None else f"{after['verdict']}: {in_words(after.get('causes', []))}"))
        if not right:
            misses.append(f"{name} -> {verdict}: {in_words(causes)}")
    show(table)
    if ratios:
        ratios.sort()
        print(f"held-out residual over noise, a model that knows all has 1: median {ratios[len(ratios) // 2]:.3f}, "
              f"9 of 10 below {ratios[min(len(ratios) - 1, 9 * len(ratios) // 10)]:.3f}")
    if sum(n for _, n in expected):
        print(f"experiments: the diagnosis itself expected {sum(t for t, _ in expected)} of {sum(n for _, n in expected)} simulated records to tell")
    if per_law:
        print("\none, d' >= 10, found by law: " + ", ".join(f"{law} {h}/{n}" for law, (h, n) in sorted(per_law.items())))
    if missing:
        print(f"\n{missing} cases that were never diagnosed count in no row")
    if failed:
        print(f"\n{failed} diagnoses failed or took too long: misses in every row")
    if misses:
        print(f"\nmissed ({len(misses)}):")
        print("\n".join(misses[: options.misses]))
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            rows = {r: {"hits": h, "n": n, "wilson95": wilson(h, n)} for r, (h, n) in table.rows.items()}
            json.dump({"rows": rows, "missing": missing, "failed": failed, "held_out_over_noise": ratios}, file, indent=2)


if __name__ == "__main__":
    main()
