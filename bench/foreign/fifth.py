#!/usr/bin/python3
"""Writes the cases of the set `fifth` (README.md); how sizes are set is that of third.py.

    fifth.py FOLDER [--only 7 12] [--seed N]
    fifth.py --check [--program driftwright]      the nominal machines and what the grammar can say against `driftwright simulate`
"""
import argparse
import json
import os
import pathlib

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):     # before numpy: the same sums in the same order, and one core
    os.environ.setdefault(variable, "1")
import numpy as np

import check
import fifth_families as families
import fifth_faults as faults
import third
import writing
from families import Draw, rounded
from faults import Fault, Impossible
from fourth import noisy
from nats import HALL_SIGMA_K
from network import moved, simulate
from writing import record_csv, scenario

SEED = 2026112519
COUNTS = dict(A=24, B=14, C16=12, C8=6, D=4)
writing.TITLES.update(families.TITLES)
third.RANGE.update({"fifth A": (17, 280), "fifth C16": (16.5, 280), "fifth C8": (8.3, 15.5), "fifth D": (18, 280)})
third.ALLOWED.update({"fifth A": (16, 320), "fifth C16": (16, 320), "fifth C8": (8, 16), "fifth D": (16, 320)})


def table():
    """(class, ways, families in the order in which they are tried) of each case; an effect comes once or, a few of them, twice."""
    rng = np.random.default_rng([SEED, 5])
    ways = [str(x) for x in rng.permutation(faults.WAYS_A)]
    kinds = [str(x) for x in rng.permutation(faults.KINDS_C)] + [str(x) for x in rng.permutation(faults.KINDS_C)]
    key = lambda kind: kind.split("_ramp")[0]
    out = [("A", [w]) for w in ways] + [("B", [])] * COUNTS["B"] + [("C16", [w]) for w in faults.SOME_RECORDS]

    def next_kind(*not_these):
        k = next(i for i, x in enumerate(kinds) if key(x) not in not_these)
        return kinds.pop(k)
    for cls, n in [("C16", COUNTS["C16"] - len(faults.SOME_RECORDS)), ("C8", COUNTS["C8"])]:      # thermometers that are swapped have no size
        out += [(cls, [next_kind(*([] if cls == "C16" else ["sensor_swap"]))]) for _ in range(n)]
    for _ in range(COUNTS["D"]):
        a = next_kind("sensor_swap")
        out.append(("D", [a, next_kind("sensor_swap", key(a))]))
    n = len(families.FAMILIES)
    first = np.concatenate([rng.permutation(n) for _ in range(-(-len(out) // n))])
    return [(*out[i], [int(first[k])] + [int(x) for x in rng.permutation(n)]) for k, i in enumerate(rng.permutation(len(out)))]


def attempt(index, number, cls, ways, order):
    """Files of the case of this number of the table, at this try."""
    rng = np.random.default_rng([SEED, index, number])
    machine, plan = families.FAMILIES[order[(number // 3) % len(order)]](rng, Draw(rng))
    wide, said = third.priors(rng, machine)
    noise, seen = families.instruments(rng, machine, plan)
    machine.stated = {k: x for k, x in machine.stated.items() if k in machine.numbers}
    if machine.start == "hall":
        machine.start = [machine.start, "steady", float(np.round(rng.uniform(14, 33), 1))][int(rng.choice(3, p=[0.5, 0.25, 0.25]))]
    way = ways[0] if ways else ""
    column = None
    if way in families.COLUMNS:
        column = families.COLUMNS[way][int(rng.integers(len(families.COLUMNS[way])))]
    elif rng.random() < 0.3:
        column = families.DECOYS[int(rng.integers(len(families.DECOYS)))]
    n_records = int(rng.choice(faults.N_RECORDS[way])) if way in faults.N_RECORDS else int(rng.choice([1, 2, 3, 4, 5], p=[0.24, 0.28, 0.24, 0.14, 0.1]))
    style, (dt, n_rows) = str(rng.choice(["even", "uneven", "dropped"], p=[0.55, 0.27, 0.18])), families.pace(rng, plan)
    hole, records = int(rng.integers(n_records)) if index % 10 == 4 else None, []
    driven = []
    for r in range(n_records + 1):
        time_s = families.rows(rng, style, dt, n_rows)
        if r == hole:
            time_s = families.with_hole(rng, time_s)
        driven.append([str(rng.choice(families.STYLES)) for _ in range(3)])
        records.append(families.record(rng, f"measured_{r + 1}" if r < n_records else "holdout_1", plan, time_s, driven[-1], column))
    measured = records[:-1]
    if column and any(np.ptp(r.columns[column[0]][1]) == 0 for r in records):
        raise Impossible
    if rng.random() < 0.33:
        noise["coloured"] = dict(share=rounded(rng.uniform(0.15, 0.45), 2), minutes=rounded(dt / 60 * rng.uniform(1.5, 12), 2))
    machine.longest_step_s = float(np.clip(dt / 2, 20, 60))
    z = third.scattered(rng, machine, wide)
    numbers = {k: np.array([moved(v, kind, z[k], machine.stated.get(k, 1.0))]) for k, (v, kind) in machine.numbers.items()}
    shares = {i: numbers[f"P {i}"][0] for i, h in enumerate(machine.heats) if h["kind"] == "cutting_heat"}
    offsets = {r.name: float(np.round(HALL_SIGMA_K * rng.standard_normal(), 3)) for r in records}
    drawn = [f for w in ways for f in faults.draw(rng, w, machine, plan, records, column)]
    places = [f.data.get("sensor") or f.data.get("channel") for f in drawn]
    if sum(shares.values()) > 0.98 or (cls == "D" and ((places[0] and places[0] == places[1]) or drawn[0].key == drawn[1].key)):
        raise Impossible
    for f in [None] + drawn:      # a look at the temperatures before the dear part
        for r in records:
            t = simulate(machine, numbers, r, [f.with_size(f.low)] if f else [])[0]
            if t.size and (not np.isfinite(t).all() or t.max() > 220 or t.min() < -30):
                raise Impossible
    try:
        hidden, worth, line = third.sized(rng, "fifth " + cls, drawn, machine, measured, noise, z, [offsets[r.name] for r in measured]) if drawn else ([], [], [])
    except np.linalg.LinAlgError:      # the records contain no information about this size
        raise Impossible
    for f in hidden:      # of a recorded power no more becomes heat than all of it, and no less than nothing
        if way == "power_square" and not 0 < shares[f.data["of_heat"]] + f.size[0] < 1:
            raise Impossible
    missing, files = float(rng.choice([0.0, 0.005, 0.03], p=[0.75, 0.15, 0.1])), {}
    for r in records:
        t, u = (a[0] for a in simulate(machine, numbers, r, hidden, np.array([offsets[r.name]])))
        if not np.isfinite(t).all() or (t.size and (t.max() > 220 or t.min() < -30)):
            raise Impossible
        files[r.name + ".csv"] = record_csv(machine, faults.known_to_all(r), noisy(rng, t, noise["temperature"], noise["coloured"], r.time_s), noisy(rng, u, noise["displacement"], noise["coloured"], r.time_s), rng, missing)
    files["scenario.yaml"] = scenario(machine, dt)
    channels = {n + "_degC": noise["temperature"] for n, _ in machine.sensors} | {d[0] + "_um": noise["displacement"] for d in machine.displacements}
    with np.errstate(over="ignore"):      # a power in watts has a `factor`, too, that nobody reads
        effects = faults.told(way, hidden, machine, records, worth)
    for e, w, l in zip(effects, worth, line):
        e.update(nats=round(w, 2), nats_linear=round(l, 2))
    most_rows = max(len(r.time_s) for r in records)
    truth = dict(case=index, seed=[SEED, index, number], **{"class": cls}, ways=ways, family=machine.family, n_records=n_records,
                 interval_s=float(np.ceil(max(r.time_s[-1] for r in records) / most_rows)),      # so that it spans the longest record, as score.py has it
                 paces_s=[dt] * len(records), rows={r.name: len(r.time_s) for r in records}, rows_are=style, hole_in=records[hole].name if hole is not None else None, driven_by=driven, looked_at_by=seen, start=machine.start, effects=effects,
                 channels=channels, coloured_noise=noise["coloured"], priors=said, hall_offset_K=offsets, extra_column=column[0] if column else None, missing=missing,
                 numbers={k: [float(f"{x:.6g}"), float(f"{numbers[k][0]:.6g}")] for k, (x, _) in machine.numbers.items()})
    files["truth.json"] = json.dumps(truth, indent=1) + "\n"
    return files


def held_to(program):
    """Each family twice, nominal and without noise, in two styles of driving and of rows; then what is new and the grammar can say, or the truth can say in two ways."""
    worst = [0.0, 0.0]

    def note(name, off):
        print(f"{name:48s} off by {off[0]:.4f} K, {off[1]:.4f} um", flush=True)
        worst[:] = [max(a, b) for a, b in zip(worst, off)]

    for i, family in enumerate(families.FAMILIES):
        for repeat in range(2):
            rng = np.random.default_rng([91, i, repeat])
            machine, plan = family(rng, Draw(rng))
            machine.sensors = [("t_" + b, b) for b in machine.bodies]
            if machine.start == "hall":
                machine.start = [["hall", 29.5], ["steady", "hall"], [16.0, "steady"]][i % 3][repeat]
            dt, n = families.pace(rng, plan)
            time_s = families.rows(rng, (("uneven", "even"), ("even", "dropped"))[i % 2][repeat], dt, n)
            if i % 4 == 0 and repeat:
                time_s = families.with_hole(rng, time_s)
            machine.longest_step_s = float(np.clip(dt / 2, 20, 60))
            styles = [families.STYLES[(i + 2 * k + 3 * repeat) % len(families.STYLES)] for k in range(3)]
            note(f"{family.__name__}, {' '.join(styles)}", check.met(program, machine, families.record(rng, "measured_1", plan, time_s, styles, ("supply", "degC")), dt)[0])
    rng = np.random.default_rng([92])
    machine, plan = families.bridge_saw(rng, Draw(rng))
    machine.sensors, machine.start = [("t_" + b, b) for b in machine.bodies], "steady"
    record = families.record(rng, "measured_1", plan, np.arange(400) * 60.0, ["warm_cool", "staircase", "spectrum"])
    two = [Fault("link", dict(a="tray", b=b)).with_size(s) for b, s in (("bridge", 9.0), ("carriage", 14.0))]
    note("two_links", check.met(program, machine, record, 60, two, "{type: link, node: tray, to: bridge, conductance: 9 W/K}\n  - {type: link, node: tray, to: carriage, conductance: 14 W/K}")[0])
    note("sensor_moved", check.met(program, machine, record, 60, [Fault("sensor_place", dict(sensor="t_motor", other="pier_right")).with_size(0.9)], "{type: sensor_place, sensor: t_motor, share: 0.9, body: pier_right}")[0])
    for way, pattern in (("power_square", "{{type: recorded_drive, node: {node}, gain: {size:.9g}, column: told}}"), ("run_on", "{{type: recorded_drive, node: {node}, opening: {size:.9g}, column: told}}")):
        fault = faults.draw(rng, way, machine, plan, [record], None)[0]
        unit, values = record.columns.pop(faults.HIDDEN)
        record.columns["told"], fault.data["column"] = (unit, values), "told"      # here the record contains it
        fault = fault.with_size(np.sqrt(fault.low * fault.high))
        note(f"{way} by a column that is told", check.met(program, machine, record, 60, [fault], pattern.format(node=fault.data["node"], size=fault.size[0]))[0])
        del record.columns["told"]
    fault = faults.draw(rng, "feed_law", machine, plan, [record], None)[0].with_size(0.4)
    other = simulate(machine, machine.nominal(), record, [fault])
    label = f"e {fault.data['heat']}"
    machine.numbers[label] = (machine.numbers[label][0] + float(fault.size[0]), "exponent")
    note("feed_law, the truth's two ways to say it", [float(np.max(np.abs(a - b))) for a, b in zip(other, simulate(machine, machine.nominal(), record))])
    note("feed_law as the scenario's exponent", check.met(program, machine, record, 60)[0])
    good = worst[0] <= 0.05 and worst[1] <= 0.25
    print(f"worst: {worst[0]:.4f} K, {worst[1]:.4f} um: {'fine' if good else 'NOT WITHIN 0.05 K and 0.25 um'}")
    return 0 if good else 1


def main():
    global SEED
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("folder", nargs="?")
    p.add_argument("--only", type=int, nargs="*")
    p.add_argument("--check", action="store_true")
    p.add_argument("--program", default="driftwright")
    p.add_argument("--seed", type=int, default=SEED, help="other machines, faults and sizes of the same families and kinds [%(default)s]")
    a = p.parse_args()
    SEED = a.seed
    if a.check:
        raise SystemExit(held_to(a.program))
    if not a.folder:
        p.error("FOLDER is missing")
    plan = table()
    for index in (a.only if a.only is not None else range(len(plan))):
        cls, ways, order = plan[index]
        for number in range(150):
            try:
                files = attempt(index, number, cls, ways, order)
                break
            except Impossible:
                continue
        else:
            raise SystemExit(f"case {index}: no machine found for {cls} {ways}")
        folder = pathlib.Path(a.folder) / f"case_{index:04d}"
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in files.items():
            (folder / name).write_text(text)
        truth = json.loads(files["truth.json"])
        print(f"case_{index:04d} {cls:3s} {truth['family']:20s} {','.join(ways) or '-'} {[(e['nats'], e['nats_linear']) for e in truth['effects']]} {list(truth['rows'].values())} (try {number})", flush=True)


if __name__ == "__main__":
    main()
