#!/usr/bin/python3
"""Draws a set of blind cases: machines with something hidden, their records as loggers leave them, and the truth (README.md).

    draw.py SETS.yaml [FOLDER] [--seed N] [--only 7 12]      FOLDER: where cases are written; without it the table of what would be drawn is printed
    draw.py SETS.yaml FOLDER --hash                          of a folder that was drawn: the hash that a set's history records

SETS.yaml: see sets/*.yaml and README.md. The same seed gives the same bytes.
"""
import argparse
import copy
import dataclasses
import hashlib
import json
import os
import pathlib

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):     # before numpy: the same sums in the same order, and one core
    os.environ.setdefault(variable, "1")
import numpy as np
import yaml

import drives
import faults
import machines
from faults import Impossible
from network import Machine, moved, simulate
from sizing import HALL_SIGMA_K, sized
from writing import record_csv, scenario

TRIES = 150
NATS = dict(A=[16, 400], C16=[16, 400], C8=[8, 16], D=[16, 400])      # of the refitted value, where a set does not say others
COLUMNS = [("sun", "W_m2"), ("valve", "percent"), ("purge", "1"), ("lamp", "V"), ("aux_power", "W"), ("conveyor", "count"), ("loop", "degC")]
DEFAULTS = dict(families=[], cases={}, nats={}, drives=list(drives.STYLES), logger=dict(rows=[75, 900], styles=dict(even=0.4, gaps=0.15, lost=0.15, slower=0.1, watched=0.2), records=[1, 1, 2, 2, 3, 3, 4, 5]),
                instruments={}, start=dict(hall=0.45, steady=0.35, degC=[10, 38]), coloured=0.3, missing=[0.75, 0.005, 0.03], columns=COLUMNS, hall_noise=None, faults=None)


def read_set(path):
    """A set's YAML over the defaults."""
    given = yaml.safe_load(pathlib.Path(path).read_text())
    unknown = set(given) - set(DEFAULTS) - {"title", "seed", "history"}
    if unknown:
        raise SystemExit(f"{path}: no such key: {', '.join(sorted(unknown))}; there are {', '.join(sorted(set(DEFAULTS) | {'title', 'seed', 'history'}))}")
    out = copy.deepcopy(DEFAULTS) | given
    out["logger"] = DEFAULTS["logger"] | given.get("logger", {})
    out["ways"] = faults.catalogue(str(pathlib.Path(path).parent / out["faults"]) if out["faults"] else None)
    out["machines"] = {k: x for name in out["families"] for k, x in machines.families(name if not name.endswith(".yaml") else str(pathlib.Path(path).parent / name)).items()}
    named = {w for c in out["cases"].values() if isinstance(c, dict) for w in c["ways"]}
    if named - set(out["ways"]):
        raise SystemExit(f"{path}: faults.yaml has no {', '.join(sorted(named - set(out['ways'])))}")
    return out


def in_turn(rng, ways, count):
    """Ways in a shuffled row, again and again; with weights each comes as often as they have it, or once more or less."""
    if isinstance(ways, dict):
        row = [str(x) for x in rng.permutation(list(ways))]
        ends = np.cumsum([ways[w] for w in row]) / sum(ways.values())
        first = rng.random()
        return [row[int(np.searchsorted(ends, (k + first) / count, side="right"))] for k in range(count)]
    out = []
    while len(out) < count:
        out += [str(x) for x in rng.permutation(ways)]
    return out[:count]


def table(a_set):
    """(class, ways, families in the order in which they are tried) of each case."""
    rng, out, n = np.random.default_rng([a_set["seed"], 1000003]), [], len(a_set["machines"])
    for cls, what in a_set["cases"].items():
        if cls == "B":
            out += [("B", [])] * what
        elif cls == "D":
            left = in_turn(rng, what["ways"], 3 * what["count"])
            for _ in range(what["count"]):      # two that are not of one kind; those that determine the start come first
                kind = lambda w: a_set["ways"][w].get("key", w)
                a = left.pop(0)
                able = [i for i, w in enumerate(left) if kind(w) != kind(a) and not a_set["ways"][w].get("alone") and not a_set["ways"][a].get("alone")]
                out.append(("D", [a, left.pop(able[0])] if able else [a, left.pop(0)]))
        else:
            out += [(cls, [w]) for w in in_turn(rng, what["ways"], what["count"])]
    first = np.concatenate([rng.permutation(n) for _ in range(-(-len(out) // n))])
    return [(*out[i], [int(first[k])] + [int(x) for x in rng.permutation(n)]) for k, i in enumerate(rng.permutation(len(out)))]


def noisy(rng, clean, channel, coloured, time_s):
    """White noise, coloured noise of the first order beside it, and the steps of the reading."""
    e, n = rng.standard_normal(clean.shape), clean.shape[1]
    if coloured["share"] > 0:
        x = coloured["share"] * rng.standard_normal(n)
        for k in range(clean.shape[0]):
            phi = np.exp(-(time_s[k] - time_s[k - 1]) / (60 * coloured["minutes"])) if k else 1.0
            x = phi * x + coloured["share"] * np.sqrt(1 - phi ** 2) * rng.standard_normal(n)
            e[k] += x
    return np.round((clean + channel["sigma"] * e) / channel["step"]) * channel["step"]


@dataclasses.dataclass
class Case:
    """A case with all that its files do not say."""
    machine: Machine
    plan: dict
    noise: dict
    numbers: dict       # the true ones, each an array of one
    hidden: list        # faults, sized
    offsets: dict       # of the true ambient from the recorded one [K], by record
    records: list       # the holdout last
    column: tuple       # (name, unit) of the further column, or None
    interval_s: float
    missing: float      # share of readings
    truth: dict
    files: dict         # name -> text


def chosen(rng, weights):
    return str(rng.choice(list(weights), p=np.array(list(weights.values())) / sum(weights.values())))


def start(rng, a_set, specs):
    """Where the bodies begin: as their way needs it, or as it comes."""
    needed = {spec["steady"] for spec in specs if spec.get("steady") is not None}
    weights = {k: x for k, x in a_set["start"].items() if k != "degC"}
    low, high = a_set["start"]["degC"]
    drawn = chosen(rng, weights | dict(degC=max(0.0, 1 - sum(weights.values()))))
    if True in needed:
        return "steady"
    if drawn == "steady" and False in needed:
        return "hall"
    return drawn if drawn != "degC" else float(np.round(rng.uniform(low, high), 1))


def the_records(rng, a_set, machine, plan, column, n_records):
    """(records with the holdout last, seconds from row to row, style of rows)."""
    logger, style = a_set["logger"], chosen(rng, a_set["logger"]["styles"])
    dt, n_rows = drives.pace(rng, plan, logger["rows"], max(1, len(machine.sensors) + len(machine.displacements)), n_records)
    out = []
    for r in range(n_records + 1):
        time_s = drives.rows(rng, "even" if style == "on_change" else style, dt, n_rows)
        styles = [str(rng.choice(a_set["drives"])) for _ in range(3)]
        record = drives.record(rng, f"measured_{r + 1}" if r < n_records else "holdout_1", plan, time_s, styles, column)
        out.append(drives.thinned(record, 5) if style == "on_change" else record)
    if any(max(np.ptp(x) for x in [r.speed, r.power, *r.feeds.values(), *(r.columns[c][1] for c in plan.get("columns", {}))]) == 0 or (column and np.ptp(r.columns[column[0]][1]) == 0) for r in out):
        raise Impossible
    return out, dt, style


def too_warm(t):
    return t.size and (not np.isfinite(t).all() or t.max() > 230 or t.min() < -40)


def attempt(a_set, index, number, cls, ways, order):
    """The case of this number of the table, at this try."""
    rng = np.random.default_rng([a_set["seed"], index, number])
    family = list(a_set["machines"])[order[(number // 3) % len(order)]]
    machine, plan = machines.machine(rng, family, a_set["machines"][family])
    wide, said = machines.priors(rng, machine)
    noise, looked = machines.instruments(rng, machine, plan, **a_set["instruments"])
    machine.stated = {k: x for k, x in machine.stated.items() if k in machine.numbers}
    specs = [a_set["ways"][w] for w in ways]
    own_start = machine.start if machine.start != "hall" and not any(s.get("steady") is not None for s in specs) else None
    machine.start = own_start or start(rng, a_set, specs)
    units = [u for s in specs for u in s.get("column", [])] or [u for s in specs for w in s.get("one_of", {}) for u in a_set["ways"][w].get("column", [])]
    able = [tuple(c) for c in a_set["columns"] if not units or c[1] in units]
    column = able[int(rng.integers(len(able)))] if units or rng.random() < 0.25 else None
    n_records = int(rng.choice(next((s["records_needed"] for s in specs if "records_needed" in s), [4, 5] if any("in_two_records" in s for s in specs) else a_set["logger"]["records"])))
    records, dt, style = the_records(rng, a_set, machine, plan, column, n_records)
    measured = records[:-1]
    if rng.random() < a_set["coloured"]:
        noise["coloured"] = machines.coloured(rng, dt)
    machine.longest_step_s = float(np.clip(dt, 20, 150))
    z = machines.scattered(rng, machine, wide)
    numbers = {k: np.array([moved(v, kind, z[k], machine.stated.get(k, 1.0))]) for k, (v, kind) in machine.numbers.items()}
    shares = {i: float(numbers[f"P {i}"][0]) for i, h in enumerate(machine.heats) if h["kind"] == "cutting_heat"}
    offsets = {r.name: float(np.round(HALL_SIGMA_K * rng.standard_normal(), 3)) for r in records}
    words = faults.Words(rng, machine, plan, records, column, noise, a_set["ways"])
    drawn = [f for w in ways for f in words.draw(w)]
    told = [(f.told["key"], f.told["place"]) for f in drawn]
    if sum(shares.values()) > 0.98 or (cls == "D" and (told[0][0] == told[1][0] or told[0][1] == told[1][1])):
        raise Impossible
    for f in [None] + drawn:      # a look at the temperatures before the dear part
        if any(too_warm(simulate(machine, numbers, r, [f.with_size(f.low)] if f else [])[0]) for r in records):
            raise Impossible
    try:
        hidden, worth, line, judge = sized(rng, (NATS | a_set["nats"])[cls], drawn, machine, measured, noise, z, [offsets[r.name] for r in measured]) if drawn else ([], [], [], None)
    except np.linalg.LinAlgError:      # the records contain no information about this size
        raise Impossible
    for f in hidden:      # of a recorded power no more becomes heat than all of it
        if "load" in f.told["spec"] and sum(shares.values()) + shares[f.names["i"]] * (np.exp(f.size[0]) - 1) > 1:
            raise Impossible
    share, few, many = a_set["missing"]
    missing, files = float(rng.choice([0.0, few, many], p=[share, 0.6 * (1 - share), 0.4 * (1 - share)])), {}
    for r in records:
        t, u = (a[0] for a in simulate(machine, numbers, r, hidden, np.array([offsets[r.name]])))
        if too_warm(t):
            raise Impossible
        told = r
        if a_set["hall_noise"]:      # what records the ambient has noise, too
            told = copy.copy(r)
            told.hall = r.hall + rng.uniform(*a_set["hall_noise"]) * rng.standard_normal(len(r.hall))
        files[r.name + ".csv"] = record_csv(machine, told, noisy(rng, t, noise["temperature"], noise["coloured"], r.time_s), noisy(rng, u, noise["displacement"], noise["coloured"], r.time_s), rng, missing)
    files["scenario.yaml"] = scenario(machine, dt)
    effects = []
    for f, w, l in zip(hidden, worth, line):
        alike = faults.told_alike(words, f, judge, w / max(l, 0.1)) if len(hidden) == 1 else []
        effects.append(faults.told(f, records, w, alike) | dict(nats_linear=round(l, 2)))
    truth = {"case": index, "seed": [a_set["seed"], index, number], "class": cls, "ways": ways, "family": family, "n_records": n_records,
             "interval_s": float(np.ceil(max(r.time_s[-1] for r in records) / max(len(r.time_s) for r in records))),      # so that it spans the longest record, as score.py has it
             "pace_s": dt, "rows": {r.name: len(r.time_s) for r in records}, "rows_are": style, "looked_at_by": looked, "start": machine.start, "effects": effects,
             "channels": {n + "_degC": noise["temperature"] for n, _ in machine.sensors} | {d[0] + "_um": noise["displacement"] for d in machine.displacements}, "coloured_noise": noise["coloured"], "priors": said,
             "hall_offset_K": offsets, "extra_column": column[0] if column else None, "missing": missing, "numbers": {k: faults.plain([x, numbers[k][0]]) for k, (x, _) in machine.numbers.items()}}
    files["truth.json"] = json.dumps(truth, indent=1) + "\n"
    return Case(machine, plan, noise, numbers, hidden, offsets, records, column, dt, missing, truth, files)


def case(a_set, index, row):
    """The first try that is possible."""
    for number in range(TRIES):
        try:
            return attempt(a_set, index, number, *row)
        except Impossible:
            continue
    raise SystemExit(f"case {index}: no machine found for {row[0]} {row[1]}")


def folder_hash(folder):
    """As `find . -type f | LC_ALL=C sort | xargs sha256sum | sha256sum` in the folder of a fresh set says it."""
    files = sorted((("./" + str(x.relative_to(folder))).encode(), x) for x in pathlib.Path(folder).rglob("*") if x.is_file())
    return hashlib.sha256(b"".join(hashlib.sha256(x.read_bytes()).hexdigest().encode() + b"  " + name + b"\n" for name, x in files)).hexdigest()


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("set")
    p.add_argument("folder", nargs="?")
    p.add_argument("--seed", type=int, help="other machines, faults and sizes of the same families and kinds [the set's own]")
    p.add_argument("--only", type=int, nargs="*", help="these cases")
    p.add_argument("--hash", action="store_true", help="of the folder; nothing is drawn")
    a = p.parse_args()
    if a.hash:
        print(folder_hash(a.folder))
        return
    a_set = read_set(a.set)
    a_set["seed"] = a.seed if a.seed is not None else a_set["seed"]
    rows = table(a_set)
    for index in (a.only if a.only is not None else range(len(rows))):
        if not a.folder:
            print(f"case_{index:04d} {rows[index][0]:3s} {list(a_set['machines'])[rows[index][2][0]]:24s} {','.join(rows[index][1]) or '-'}")
            continue
        c = case(a_set, index, rows[index])
        folder = pathlib.Path(a.folder) / f"case_{index:04d}"
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in c.files.items():
            (folder / name).write_text(text)
        print(f"case_{index:04d} {rows[index][0]:3s} {c.truth['family']:24s} {','.join(rows[index][1]) or '-'} {[(e['nats'], e['nats_linear']) for e in c.truth['effects']]} {list(c.truth['rows'].values())} (try {c.truth['seed'][2]})", flush=True)


if __name__ == "__main__":
    main()
