#!/usr/bin/python3
"""Writes the cases of the set `sixth` (README.md); how sizes are set is that of third.py.

    sixth.py FOLDER [--only 7 12] [--seed N]
    sixth.py --check [--program driftwright]      the nominal machines and what the grammar can say against `driftwright simulate`
"""
import argparse
import json
import os
import pathlib
import shutil

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):     # before numpy: the same sums in the same order, and one core
    os.environ.setdefault(variable, "1")
import numpy as np

import check
import sixth_families as families
import sixth_faults as faults
import third
import writing
from families import Draw, rounded
from faults import Fault, Impossible
from fourth import noisy
from nats import HALL_SIGMA_K
from network import moved
from sixth_network import simulate, unfolded
from writing import record_csv, scenario

SEED = 2026112601
COUNTS = dict(A=24, B=14, C16=12, C8=6, D=4)
writing.TITLES.update(families.TITLES)
third.RANGE.update({"sixth A": (18, 350), "sixth C16": (17, 350), "sixth C8": (8.4, 15.4), "sixth D": (18, 300)})
third.ALLOWED.update({"sixth A": (16, 400), "sixth C16": (16, 400), "sixth C8": (8, 16), "sixth D": (16, 400)})


def table():
    """(class, ways, families in the order in which they are tried) of each case; an older effect comes once or, a few of them, twice."""
    rng = np.random.default_rng([SEED, 6])
    kinds = [str(x) for x in rng.permutation(faults.KINDS_C)] + [str(x) for x in rng.permutation(faults.KINDS_C)]
    key = lambda kind: kind.split("_ramp")[0]

    def next_kind(*not_these):
        return kinds.pop(next(i for i, x in enumerate(kinds) if key(x) not in not_these))
    out = [("A", [w]) for w in faults.WAYS_A] + [("B", [])] * COUNTS["B"] + [("C16", [w]) for w in faults.NEW_C]
    out += [("C16", [next_kind()]) for _ in range(COUNTS["C16"] - len(faults.NEW_C))]
    out += [("C8", [next_kind()]) for _ in range(COUNTS["C8"])]
    for _ in range(COUNTS["D"]):
        a = next_kind()
        out.append(("D", [a, next_kind(key(a))]))
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
    machine.start = ["hall", "steady", float(np.round(rng.uniform(12, 35), 1))][int(rng.choice(3, p=[0.5, 0.3, 0.2]))]
    way, column = ways[0] if ways else "", None
    if way in families.COLUMNS:
        column = families.COLUMNS[way][int(rng.integers(len(families.COLUMNS[way])))]
    elif rng.random() < 0.25:
        column = families.DECOYS[int(rng.integers(len(families.DECOYS)))]
    n_records = int(rng.choice(faults.N_RECORDS[way])) if way in faults.N_RECORDS else int(rng.choice([1, 2, 3, 4, 5], p=[0.25, 0.27, 0.23, 0.15, 0.1]))
    style, (dt, n_rows), records, driven = str(rng.choice(["even", "sleepy", "on_change"], p=[0.6, 0.2, 0.2])), families.pace(rng, plan), [], []
    for r in range(n_records + 1):
        time_s = families.rows(rng, style, dt, n_rows)
        driven.append([str(rng.choice(families.STYLES)) for _ in range(3)])
        records.append(families.record(rng, f"measured_{r + 1}" if r < n_records else "holdout_1", plan, time_s, driven[-1], column))
    if style == "on_change":
        every = int(rng.integers(3, 7))
        records = [families.thinned(r, every) for r in records]
    measured = records[:-1]
    if any(max(np.ptp(x) for x in [r.speed, r.power, *r.feeds.values()]) == 0 or (column and np.ptp(r.columns[column[0]][1]) == 0) for r in records):
        raise Impossible
    if rng.random() < 0.3:
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

    def warm(t):
        return t.size and (not np.isfinite(t).all() or t.max() > 220 or t.min() < -30)
    for f in [None] + drawn:      # a look at the temperatures before the dear part
        if any(warm(simulate(machine, numbers, r, [f.with_size(f.low)] if f else [])[0]) for r in records):
            raise Impossible
    try:
        hidden, worth, line = third.sized(rng, "sixth " + cls, drawn, machine, measured, noise, z, [offsets[r.name] for r in measured]) if drawn else ([], [], [])
    except np.linalg.LinAlgError:      # the records contain no information about this size
        raise Impossible
    for f in hidden:      # of a recorded power no more becomes heat than all of it
        if f.key == "recorded_drive" and "heat" in f.data and sum(shares.values()) + shares[f.data["heat"]] * (np.exp(f.size[0]) - 1) > 1:
            raise Impossible
    missing, files = float(rng.choice([0.0, 0.005, 0.03], p=[0.75, 0.15, 0.1])), {}
    for r in records:
        t, u = (a[0] for a in simulate(machine, numbers, r, hidden, np.array([offsets[r.name]])))
        if warm(t):
            raise Impossible
        files[r.name + ".csv"] = record_csv(machine, faults.known_to_all(r), noisy(rng, t, noise["temperature"], noise["coloured"], r.time_s), noisy(rng, u, noise["displacement"], noise["coloured"], r.time_s), rng, missing)
    files["scenario.yaml"] = scenario(machine, dt)
    channels = {n + "_degC": noise["temperature"] for n, _ in machine.sensors} | {d[0] + "_um": noise["displacement"] for d in machine.displacements}
    with np.errstate(over="ignore"):      # a power in watts has a `factor`, too, that nobody reads
        effects = faults.told(way, hidden, machine, records, worth)
    for e, w, l in zip(effects, worth, line):
        e.update(nats=round(w, 2), nats_linear=round(l, 2))
    truth = dict(case=index, seed=[SEED, index, number], **{"class": cls}, ways=ways, family=machine.family, n_records=n_records,
                 interval_s=float(np.ceil(max(r.time_s[-1] for r in records) / max(len(r.time_s) for r in records))),      # so that it spans the longest record, as score.py has it
                 paces_s=[dt] * len(records), rows={r.name: len(r.time_s) for r in records}, rows_are=style, driven_by=driven, looked_at_by=seen, start=machine.start, effects=effects, channels=channels,
                 coloured_noise=noise["coloured"], priors=said, hall_offset_K=offsets, extra_column=column[0] if column else None, missing=missing,
                 numbers={k: [float(f"{x:.6g}"), float(f"{numbers[k][0]:.6g}")] for k, (x, _) in machine.numbers.items()})
    files["truth.json"] = json.dumps(truth, indent=1) + "\n"
    return files


def held_to(program):
    """Each family twice, nominal and without noise, in two styles of driving and of rows; then what is new: as the grammar says it, or by recorded columns."""
    worst = [0.0, 0.0]

    def note(name, off):
        print(f"{name:52s} off by {off[0]:.4f} K, {off[1]:.4f} um", flush=True)
        worst[:] = [max(a, b) for a, b in zip(worst, off)]

    def machine_of(family, rng):
        machine, plan = family(rng, Draw(rng))
        machine.sensors = [("t_" + b, b) for b in machine.bodies]
        return machine, plan

    for i, family in enumerate(families.FAMILIES):
        for repeat in range(2):
            rng = np.random.default_rng([101, i, repeat])
            machine, plan = machine_of(family, rng)
            machine.start = [["hall", 29.5], ["steady", "hall"], [16.0, "steady"]][i % 3][repeat]
            dt, n = families.pace(rng, plan)
            style = (("sleepy", "even"), ("on_change", "even"))[i % 2][repeat]
            machine.longest_step_s = float(np.clip(dt / 2, 20, 60))
            styles = [families.STYLES[(i + 3 * k + 4 * repeat) % len(families.STYLES)] for k in range(3)]
            record = families.record(rng, "measured_1", plan, families.rows(rng, style, dt, n), styles, ("mains", "degC"))
            note(f"{family.__name__}, {style}, {' '.join(styles)}", check.met(program, machine, families.thinned(record, 4) if style == "on_change" else record, dt)[0])
    rng = np.random.default_rng([102])
    machine, plan = machine_of(families.roll_grinder, rng)
    machine.start, time_s = "steady", np.arange(400) * 60.0
    for way in ("flood", "neighbour", "run_up", "mixed_friction", "running_in", "force_path", "mount_creep"):      # each hides columns; here the record contains them
        record = families.record(rng, "measured_1", plan, time_s, ["tool_list", "series", "breaks"])
        while True:
            try:
                fault = faults.draw(rng, way, machine, plan, [record], None)[0]
                break
            except Impossible:
                continue
        for name in (faults.HIDDEN, faults.HIDDEN + "_2"):
            if name in record.columns:
                record.columns[name.replace(faults.HIDDEN, "told")] = record.columns.pop(name)
        fault.data = {k: x.replace(faults.HIDDEN, "told") if isinstance(x, str) else x for k, x in fault.data.items()}
        fault = fault.with_size(np.sqrt(fault.low * fault.high))
        lines = []
        for f in unfolded([fault]):
            if f.key == "displacement_path":
                lines.append(f"{{type: displacement_path, displacement: {f.data['channel']}, sensitivity: {f.size[0]:.9g} um/K, column: {f.data['column']}}}")
            else:
                lines.append(f"{{type: recorded_drive, node: {f.data['node']}, {f.data['mode']}: {f.size[0]:.9g}, column: {f.data['column']}}}")
        note(f"{way} by columns that are told", check.met(program, machine, record, 60, [fault], "\n  - ".join(lines))[0])
    record = families.record(rng, "measured_1", plan, time_s, ["soak_steps", "series", "breaks"])
    top = float(plan["top"])
    note("turning_joint", check.met(program, machine, record, 60, [Fault("forced_convection", dict(link=("wheel_spindle", "wheelhead"), at=top / 4)).with_size(0.7)],
                                    f"{{type: changed_law, law: link wheel_spindle - wheelhead, exponent: 0.7, at_speed: {top / 4:g} rpm}}")[0])
    note("link_some_days", check.met(program, machine, record, 60, [Fault("link", dict(a="roll_4", b="wheelhead")).with_size(31.0)], "{type: link, node: roll_4, to: wheelhead, conductance: 31 W/K}")[0])
    note("ambient_window", check.met(program, machine, record, 60, [Fault("ambient_window", dict(begin_s=3610.0, end_s=9950.0)).with_size(3.0)], "{type: ambient, offset: 3 K, from: 3610 s}\n  - {type: ambient, offset: -3 K, from: 9950 s}")[0])
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
        raise SystemExit(held_to(os.path.realpath(shutil.which(a.program) or a.program)))      # it runs in a folder of its own
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
        print(f"case_{index:04d} {cls:3s} {truth['family']:24s} {','.join(ways) or '-'} {[(e['nats'], e['nats_linear']) for e in truth['effects']]} {list(truth['rows'].values())} (try {number})", flush=True)


if __name__ == "__main__":
    main()
