#!/usr/bin/python3
"""Scores the statements of diagnoses (quantity, place, what it follows, probability) against the truth of a set of cases.

    score_statements.py CASES ... [--diagnoses NAME] [--list] [--csv FILE]      FILE: as score.py has it; reads case_*/truth.json and case_*/NAME/diagnosis.json

Rules (README.md, "Scoring statements"), written before the sets seventh, ninth, tenth, eleventh, twelfth and the first 150 cases of `first` were given to it:

- Each name that counts for a truth (its key and those under `also`) is a quantity: heat (heat_source, friction_law, recorded_drive, heat_window), exchange (convection,
  forced_convection, contact, link, coolant, exchange_window, radiation, conductivity), capacity (heat_capacity, hidden_body, mass_change), reading (sensor_*), displacement (mount_shift,
  centrifugal, spindle_growth, displacement_path, expansion, scale_expansion, probe_lag), ambient (ambient, stratification), clock, speed (speed_override, missing_stop, a heat_window of the
  spindle). coolant, radiation and recorded_drive are heat or exchange. run_state is heat or exchange of "all", of heat the speed as well. A hidden body with a path to the hall is an exchange with it, too.
- A statement is right if quantity and place are: of an exchange both ends, of one named by a single body that body (of a film with the ambient); of an expansion the body or the channel; of a swap both.
- The statements of a case are taken in order of probability. "Said" is a probability of 0.9 or more; "silent" a probability of more than a half that nothing is wrong.
- A truth that lists `statements` itself (`foundry`, and the old cases of `stranger` and `visitor`) accepts these quantities and places, and no others. Its conductivity is an exchange at
  that body, its expansion a displacement there (both by the grammar's words); an exchange at one body alone is one with the ambient.
- A run that has no statements counts as wrong, and not silent.
"""
import argparse
import collections
import math
import pathlib
import re

from score import append_csv, cases, interval

QUANTITY = dict(
    heat=["heat_source", "friction_law", "recorded_drive", "heat_window"],
    exchange=["convection", "forced_convection", "contact", "link", "coolant", "exchange_window", "radiation", "conductivity"],
    capacity=["heat_capacity", "hidden_body", "mass_change"],
    reading=["sensor_bias", "sensor_lag", "sensor_drift", "sensor_detached", "sensor_place", "sensor_swap"],
    displacement=["mount_shift", "centrifugal", "spindle_growth", "displacement_path", "expansion", "scale_expansion", "probe_lag"],
    ambient=["ambient", "stratification"], clock=["clock_offset"], speed=["speed_override", "missing_stop"], all=["run_state"])
OF_KEY = {key: quantity for quantity, keys in QUANTITY.items() for key in keys}
HEAT_OR_EXCHANGE = ("coolant", "radiation", "recorded_drive")
FILMS = ("convection", "forced_convection", "radiation")


def places(where):
    return {re.sub(r"_(degC|um|urad)$", "", x).replace("hall", "ambient") for x in re.split(r"[^A-Za-z0-9_]+", where) if x}


def right(statement, effect):
    if "statements" in effect:      # a truth that says itself which statements are right
        told = {p.replace("hall", "ambient") for p in statement["place"]}
        words = dict(conductivity="exchange", expansion="displacement")
        for s in effect["statements"]:
            place = {p.replace("hall", "ambient") for p in s["place"]}
            if s["quantity"] == "exchange" and len(place) == 1 and "all" not in place:
                place.add("ambient")
            if statement["quantity"] == words.get(s["quantity"], s["quantity"]) and told == place:
                return True
        return False
    names = [(effect["key"], effect["where"])] + [(a["effect"], a["where"]) for a in effect.get("also", [])]
    if effect["key"] == "hidden_body" and any(p["name"] == "to_hall" and p["value"] > 0 for p in effect["parameters"]):
        names.append(("link", effect["where"] + ",hall"))
    quantity, told = statement["quantity"], {p.replace("hall", "ambient") for p in statement["place"]}
    for key, where in names:
        of, place = OF_KEY.get(key), places(where)
        if of is None:
            continue
        if key == "heat_window" and "spindle" in place and quantity == "speed":
            return True
        if of == "all":
            if ("all" in told and quantity in ("heat", "exchange")) or (quantity == "speed" and effect.get("what") == "heat"):
                return True
            continue
        if quantity != of and not (key in HEAT_OR_EXCHANGE and quantity in ("heat", "exchange")):
            continue
        if of in ("ambient", "clock", "speed"):
            return True
        if key == "expansion":
            ok = bool(told & place)
        elif key == "sensor_swap":
            ok = place <= told
        elif of in ("reading", "displacement"):
            ok = told == place
        elif quantity == "exchange" and key not in HEAT_OR_EXCHANGE:
            if len(place) == 1:
                ok = place <= told and (key not in FILMS or "ambient" in told or len(told) == 1)
            else:
                ok = told in (place, place - {"ambient"})
        else:
            ok = bool(told & place)
        if ok:
            return True
    return False


def share(k, n):
    if n == 0:
        return "-"
    p, low, high = interval(k, n)
    return f"{k} of {n}, {p:.0f} % ({low:.0f} to {high:.0f})"


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("cases", nargs="+")
    a.add_argument("--diagnoses", default="diagnosis")
    a.add_argument("--list", action="store_true", help="each case whose first statement is wrong, or that is not silent")
    a.add_argument("--csv", help="appends the figures to this file")
    a = a.parse_args()
    counts, bins = collections.defaultdict(collections.Counter), collections.defaultdict(list)
    kinds, log_score, seconds = collections.defaultdict(list), [], []
    for folder in a.cases:
        for case, truth, d in cases(folder, a.diagnoses):
            if d is None:
                continue
            told, nothing = d.get("statements", []), d.get("probability_nothing_wrong", 0.0)
            seconds += [d["seconds"]] if "seconds" in d else []
            effects = truth["effects"]
            correct = [any(right(s, e) for e in effects) for s in told]
            bins_of = [min(9, int(10 * s["probability"])) for s in told]
            for b, s, ok in zip(bins_of, told, correct):
                bins[b].append((s["probability"], ok))
                log_score.append(math.log(max(1e-6, s["probability"] if ok else 1 - s["probability"])))
            for who in (pathlib.Path(folder).name, "all"):
                c = counts[who]
                said_wrong = any(s["probability"] >= 0.9 and not ok for s, ok in zip(told, correct))
                if not effects:
                    c["faultless"] += 1
                    c["silent"] += nothing > 0.5
                    c["faultless said"] += said_wrong
                    continue
                group = "faint" if truth["class"] == "C8" else "two" if len(effects) > 1 else "one"
                c[group] += 1
                c[group + " top"] += correct[:1] == [True]
                c[group + " three"] += any(correct[:3])
                c[group + " said wrong"] += said_wrong
                c[group + " both"] += all(any(right(s, e) for s in told[:3]) for e in effects)
            if len(effects) == 1:
                kinds[effects[0].get("key", "sayable" if truth.get("sayable") else "alien")].append(correct[:1] == [True])
            if a.list and ((effects and correct[:1] != [True]) or (not effects and nothing <= 0.5)):
                what = [(e.get("key", e.get("what")), e.get("where"), round(e.get("nats", 0))) for e in effects]
                print(f"{case.parent.name}/{case.name} {truth['class']} {what} nothing {nothing:.2f}",
                      [(s["quantity"], ",".join(s["place"]), s["follows"], round(s["probability"], 2)) for s in told[:3]])
    for who, c in counts.items():
        print(who)
        for group, words in (("one", "one effect, 16 nats or more"), ("faint", "one effect, 8 to 16 nats"), ("two", "two effects")):
            if c[group]:
                print(f"  {words}: first statement {share(c[group + ' top'], c[group])}; among three {share(c[group + ' three'], c[group])}; "
                      f"said and wrong {share(c[group + ' said wrong'], c[group])}" + (f"; both {share(c['two both'], c['two'])}" if group == "two" else ""))
        if c["faultless"]:
            print(f"  nothing hidden: silent {share(c['silent'], c['faultless'])}; said and wrong {c['faultless said']}")
    print("of statements: probability, share right, number:", {b: (round(sum(p for p, _ in v) / len(v), 2), round(sum(o for _, o in v) / len(v), 2), len(v)) for b, v in sorted(bins.items())})
    brier = [(p - o) ** 2 for v in bins.values() for p, o in v]
    print(f"Brier score {sum(brier) / max(1, len(brier)):.4f}, log score {sum(log_score) / max(1, len(log_score)):.4f} a statement")
    print("first statement right, by kind:", {k: f"{sum(v)}/{len(v)}" for k, v in sorted(kinds.items())})
    if a.csv:
        append_csv(a.csv, [[who, a.diagnoses, "statements: " + figure, c[figure], c[figure.split()[0]], *(f"{x:.1f}" for x in interval(c[figure], c[figure.split()[0]]))]
                           for who, c in counts.items() for figure in ("one top", "one three", "one said wrong", "faint top", "faint three", "two top", "two both", "faultless said") if c[figure.split()[0]]]
                   + [[who, a.diagnoses, "statements: silent", c["silent"], c["faultless"], *(f"{x:.1f}" for x in interval(c["silent"], c["faultless"]))] for who, c in counts.items() if c["faultless"]])
    if seconds:
        print(f"seconds: median {sorted(seconds)[len(seconds) // 2]:.1f}, most {max(seconds):.1f}")


if __name__ == "__main__":
    main()
