#!/usr/bin/python3
"""Writes the cases of the set `seventh` (README.md); how sizes are set is that of third.py.

    seventh.py FOLDER [--only 7 12] [--seed N]
    seventh.py --check [--program driftwright]      the nominal machines and what the grammar can say against `driftwright simulate`
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
import seventh_families as families
import seventh_faults as faults
import third
import writing
from families import Draw, rounded
from faults import Fault, Impossible
from fourth import noisy
from nats import HALL_SIGMA_K, Judge
from network import moved
from seventh_network import simulate
from writing import record_csv, scenario

SEED = 2026112701
COUNTS = dict(A=24, B=14, C16=12, C8=6, D=4)
writing.TITLES.update(families.TITLES)
third.RANGE.update({"seventh A": (18, 350), "seventh C16": (17, 350), "seventh C8": (8.4, 15.4), "seventh D": (18, 300)})
third.ALLOWED.update({"seventh A": (16, 400), "seventh C16": (16, 400), "seventh C8": (8, 16), "seventh D": (16, 400)})


def table():
    """(class, ways, families in the order in which they are tried) of each case; an older effect comes once or, a few of them, twice."""
    rng = np.random.default_rng([SEED, 7])
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
    wide, said = families.priors(rng, machine)
    noise, seen = families.instruments(rng, machine, plan)
    machine.stated = {k: x for k, x in machine.stated.items() if k in machine.numbers}
    way, column = ways[0] if ways else "", None
    machine.start = ["hall", "steady", float(np.round(rng.uniform(10, 38), 1))][int(rng.choice(3, p=[0.45, 0.35, 0.2]))]
    if way in faults.NOT_STEADY and machine.start == "steady":
        machine.start = "hall"
    if way in families.COLUMNS:
        column = families.COLUMNS[way][int(rng.integers(len(families.COLUMNS[way])))]
    elif rng.random() < 0.25:
        column = families.DECOYS[int(rng.integers(len(families.DECOYS)))]
    n_records = int(rng.choice(faults.N_RECORDS[way])) if way in faults.N_RECORDS else int(rng.choice([1, 2, 3, 4, 5], p=[0.3, 0.22, 0.2, 0.15, 0.13]))
    style, records, driven = str(rng.choice(["even", "triggered", "bursts", "slower"], p=[0.5, 0.16, 0.17, 0.17])), [], []
    dt, n_rows = families.pace(rng, plan, len(machine.sensors) + len(machine.displacements), n_records)
    for r in range(n_records + 1):
        time_s = families.rows(rng, style, dt, n_rows)
        driven.append([str(rng.choice(families.STYLES)) for _ in range(3)])
        records.append(families.record(rng, f"measured_{r + 1}" if r < n_records else "holdout_1", plan, time_s, driven[-1], column))
    measured = records[:-1]
    if any(max(np.ptp(x) for x in [r.speed, r.power, *r.feeds.values()]) == 0 or (column and np.ptp(r.columns[column[0]][1]) == 0) for r in records):
        raise Impossible
    if rng.random() < 0.3:
        noise["coloured"] = dict(share=rounded(rng.uniform(0.15, 0.45), 2), minutes=rounded(dt / 60 * rng.uniform(1.5, 12), 2))
    machine.longest_step_s = float(np.clip(dt, 20, 150))
    z = third.scattered(rng, machine, wide)
    numbers = {k: np.array([moved(v, kind, z[k], machine.stated.get(k, 1.0))]) for k, (v, kind) in machine.numbers.items()}
    shares = {i: numbers[f"P {i}"][0] for i, h in enumerate(machine.heats) if h["kind"] == "cutting_heat"}
    offsets = {r.name: float(np.round(HALL_SIGMA_K * rng.standard_normal(), 3)) for r in records}
    drawn = [f for w in ways for f in faults.draw(rng, w, machine, plan, records, column)]
    places = [f.data.get("sensor") or f.data.get("channel") or f.key for f in drawn]
    if sum(shares.values()) > 0.98 or (cls == "D" and (places[0] == places[1] or drawn[0].key == drawn[1].key)):
        raise Impossible

    def warm(t):
        return t.size and (not np.isfinite(t).all() or t.max() > 220 or t.min() < -30)
    for f in [None] + drawn:      # a look at the temperatures before the dear part
        if any(warm(simulate(machine, numbers, r, [f.with_size(f.low)] if f else [])[0]) for r in records):
            raise Impossible
    try:
        hidden, worth, line = third.sized(rng, "seventh " + cls, drawn, machine, measured, noise, z, [offsets[r.name] for r in measured]) if drawn else ([], [], [])
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
        alike = []
        if hidden and cls != "D":
            judge = Judge(machine, measured, noise)
            alike = [faults.told_alike(f, machine, plan, measured, judge, worth[0] / max(line[0], 0.1)) for f in hidden]
        effects = faults.told(way, hidden, machine, records, worth, alike)
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
        print(f"{name:62s} off by {off[0]:.4f} K, {off[1]:.4f} um", flush=True)
        worst[:] = [max(a, b) for a, b in zip(worst, off)]

    for i, family in enumerate(families.FAMILIES):
        for repeat in range(2):
            rng = np.random.default_rng([111, i, repeat])
            machine, plan = family(rng, Draw(rng))
            machine.sensors = [("t_" + b, b) for b in machine.bodies]
            families.priors(rng, machine)
            machine.start = [["hall", 31.5], ["steady", "hall"], [13.0, "steady"]][i % 3][repeat]
            dt, n = families.pace(rng, plan, 12, 2)
            style = (("triggered", "even"), ("bursts", "slower"))[i % 2][repeat]
            machine.longest_step_s = float(np.clip(dt, 20, 150))
            styles = [families.STYLES[(i + 3 * k + 4 * repeat) % len(families.STYLES)] for k in range(3)]
            record = families.record(rng, "measured_1", plan, families.rows(rng, style, dt, n), styles, ("cellar", "degC"))
            note(f"{family.__name__}, {style}, {' '.join(styles)}", check.met(program, machine, record, dt)[0])
    rng = np.random.default_rng([112])
    machine, plan = families.gun_drill(rng, Draw(rng))
    machine.sensors, time_s = [("t_" + b, b) for b in machine.bodies], np.arange(400) * 60.0
    for way in ("vent_by_hall", "late_heat", "load_heat", "foundation", "cold_tank", "sunbeam", "grease_shots", "standstill_heater"):      # each hides a column; here the record contains it
        machine.start = "hall"
        record = families.record(rng, "measured_1", plan, time_s, ["trials", "walk", "recipe"])
        while True:
            try:
                fault = faults.draw(rng, way, machine, plan, [record], None)[0]
                break
            except Impossible:
                record = families.record(rng, "measured_1", plan, time_s, ["trials", "walk", "recipe"])
        record.columns["told"] = record.columns.pop(faults.HIDDEN)
        fault.data["column"] = "told"
        fault = fault.with_size(np.sqrt(fault.low * fault.high) / 2)
        note(f"{way} by a column that is told", check.met(program, machine, record, 60, [fault], f"{{type: recorded_drive, node: {fault.data['node']}, {fault.data['mode']}: {fault.size[0]:.9g}{' W/K' if fault.data['mode'] == 'conductance' else ''}, column: told}}")[0])
    record = families.record(rng, "measured_1", plan, time_s, ["trials", "walk", "recipe"])
    machine.start, top = "steady", float(plan["top"])
    note("heat_on_two", check.met(program, machine, record, 60, [Fault("heat_on_two", dict(nodes=["drill", "bed"], shares=[0.4, 0.6], law="power", from_s=0.0, at=top, exponent=1.3)).with_size(200.0)],
                                  "\n  - ".join(f"{{type: heat_source, node: {n}, power: {p} W, at_speed: {top:g} rpm, exponent: 1.3}}" for n, p in (("drill", 80), ("bed", 120))))[0])
    note("cover_fitted", check.met(program, machine, record, 60, [Fault("two_films", dict(links=[("oil", "hall"), ("bed", "hall")]), sign=-1.0).with_size(float(np.log(2)))],
                                   "\n  - ".join(f"{{type: changed_law, law: link {n} - ambient, factor: 0.5}}" for n in ("oil", "bed")))[0])
    note("loosening", check.met(program, machine, record, 60, [Fault("loosening", dict(link=("bushing", "work"), order=["earlier", "measured_1"])).with_size(float(np.log(3)))], f"{{type: changed_law, law: link bushing - work, factor: {1 / 3:.9g}}}")[0])
    i = next(i for i, h in enumerate(machine.heats) if h["has_decay"])
    decay = machine.numbers[f"decay {i}"][0]
    fault = Fault("friction_law", dict(heat=i, node="headstock", decay=True), sign=-1.0).with_size(decay + 0.004)
    t, u = simulate(machine, machine.nominal(), record, [fault])
    machine.numbers[f"decay {i}"] = (-0.004, "log")
    note("preload_rise, the truth's two ways to say it", [float(np.max(np.abs(x - y))) for x, y in zip((t, u), simulate(machine, machine.nominal(), record))])
    machine.numbers[f"decay {i}"] = (decay, "log")
    share = machine.numbers["P 1"][0]
    note("heat_moved", check.met(program, machine, record, 60, [Fault("heat_moved", dict(heat=1, node="bed", from_node="work")).with_size(0.3)],
                                 f"{{type: cutting_heat, node: bed, share: {0.3 * share:.9g}}}\n  - {{type: recorded_drive, node: work, gain: {-0.3 * share:.9g}, column: cutting_power}}")[0])
    note("bumped_and_back", check.met(program, machine, record, 60, [Fault("bumped", dict(channel="depth", begin_s=4210.0, end_s=9970.0)).with_size(7.0)], "{type: mount_shift, displacement: depth, shift: 7 um, time: 4210 s}\n  - {type: mount_shift, displacement: depth, shift: -7 um, time: 9970 s}")[0])
    note("cold_junction", check.met(program, machine, record, 60, [Fault("card_bias", dict(sensors=["t_drill", "t_oil"])).with_size(0.8)], "\n  - ".join(f"{{type: sensor_bias, sensor: {n}, bias: 0.8 K}}" for n in ("t_drill", "t_oil")))[0])
    slip = Fault("record_change", dict(place="spindle", change=lambda r, s: faults.truly(r, speed=r.speed * np.exp(-s)))).with_size(0.25)
    note("a record changed, as of belt_slip", check.met(program, machine, record, 60, [slip], f"{{type: speed_override, factor: {np.exp(-0.25):.9g}}}")[0])
    warmer = Fault("record_change", dict(place="hall", change=lambda r, s: faults.truly(r, hall=r.hall + s))).with_size(1.5)
    note("a record changed, as of slow_hall", check.met(program, machine, record, 60, [warmer], "{type: ambient, offset: 1.5 K}")[0])
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
