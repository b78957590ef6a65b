#!/usr/bin/python3
"""Writes the cases of the set `eighth` (README.md); how sizes are set is that of third.py.

    eighth.py FOLDER [--only 7 12] [--seed N]
    eighth.py --check [--program driftwright]      the nominal machines and what the grammar can say against `driftwright simulate`
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
import eighth_families as families
import eighth_faults as faults
import third
import writing
from eighth_network import altered, simulate
from families import Draw, rounded
from faults import Fault, Impossible
from fourth import noisy
from nats import HALL_SIGMA_K, Judge
from network import moved
from sixth_faults import known_to_all
from writing import record_csv, scenario

SEED = 2026112611
COUNTS = dict(A=24, B=14, C16=12, C8=6, D=4)
writing.TITLES.update(families.TITLES)
third.RANGE.update({"eighth A": (18, 350), "eighth C16": (17, 350), "eighth C8": (8.4, 15.4), "eighth D": (18, 300)})
third.ALLOWED.update({"eighth A": (16, 400), "eighth C16": (16, 400), "eighth C8": (8, 16), "eighth D": (16, 400)})


def table():
    """(class, ways, families in the order in which they are tried) of each case; an older effect comes once or, a few of them, twice."""
    rng = np.random.default_rng([SEED, 8])
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
    if rng.random() < 0.25:
        column = families.DECOYS[int(rng.integers(len(families.DECOYS)))]
    n_records = int(rng.choice(faults.N_RECORDS[way])) if way in faults.N_RECORDS else int(rng.choice([1, 2, 3, 4, 5], p=[0.3, 0.22, 0.2, 0.15, 0.13]))
    style, records, driven = str(rng.choice(families.ROWS, p=[0.4, 0.17, 0.15, 0.14, 0.14])), [], []
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
    drawn = [f for w in ways for f in faults.draw(rng, w, machine, plan, records, column, noise)]
    places = [f.data.get("sensor") or f.data.get("channel") or f.key for f in drawn]
    if sum(shares.values()) > 0.98 or (cls == "D" and (places[0] == places[1] or drawn[0].key == drawn[1].key)):
        raise Impossible

    def warm(t):
        return t.size and (not np.isfinite(t).all() or t.max() > 220 or t.min() < -30)
    for f in [None] + drawn:      # a look at the temperatures before the dear part
        if any(warm(simulate(machine, numbers, r, [f.with_size(f.low)] if f else [])[0]) for r in records):
            raise Impossible
    try:
        hidden, worth, line = third.sized(rng, "eighth " + cls, drawn, machine, measured, noise, z, [offsets[r.name] for r in measured]) if drawn else ([], [], [])
    except np.linalg.LinAlgError:      # the records contain no information about this size
        raise Impossible
    if hidden and hidden[0].low == hidden[0].high and worth[0] > faults.MOST_NATS:
        raise Impossible
    for f in hidden:      # of a recorded power no more becomes heat than all of it
        if f.key == "recorded_drive" and "heat" in f.data and sum(shares.values()) + shares[f.data["heat"]] * (np.exp(f.size[0]) - 1) > 1:
            raise Impossible
    missing, files = float(rng.choice([0.0, 0.005, 0.03], p=[0.75, 0.15, 0.1])), {}
    for r in records:
        t, u = (a[0] for a in simulate(machine, numbers, r, hidden, np.array([offsets[r.name]])))
        if warm(t):
            raise Impossible
        files[r.name + ".csv"] = record_csv(machine, known_to_all(r), noisy(rng, t, noise["temperature"], noise["coloured"], r.time_s), noisy(rng, u, noise["displacement"], noise["coloured"], r.time_s), rng, missing)
    files["scenario.yaml"] = scenario(machine, dt)
    channels = {n + "_degC": noise["temperature"] for n, _ in machine.sensors} | {d[0] + "_um": noise["displacement"] for d in machine.displacements}
    with np.errstate(over="ignore"):      # a power in watts has a `factor`, too, that nobody reads
        alike = []
        if hidden and cls != "D":
            judge = Judge(machine, measured, noise)
            alike = [faults.told_alike(way, f, machine, plan, measured, judge, worth[0] / max(line[0], 0.1)) for f in hidden]
        effects = faults.told(way, hidden, machine, records, worth, alike)
    for e, w, l in zip(effects, worth, line):
        e.update(nats=round(w, 2), nats_linear=round(l, 2))
    truth = dict(case=index, seed=[SEED, index, number], **{"class": cls}, ways=ways, family=machine.family, n_records=n_records,
                 interval_s=float(np.ceil(max(r.time_s[-1] for r in records) / max(len(r.time_s) for r in records))),      # so that it spans the longest record, as score.py has it
                 paces_s=[dt] * len(records), rows={r.name: len(r.time_s) for r in records}, rows_are=style, sayable=all(e["sayable"] for e in effects), driven_by=driven, looked_at_by=seen, start=machine.start, effects=effects, channels=channels,
                 coloured_noise=noise["coloured"], priors=said, hall_offset_K=offsets, extra_column=column[0] if column else None, missing=missing,
                 numbers={k: [float(f"{x:.6g}"), float(f"{numbers[k][0]:.6g}")] for k, (x, _) in machine.numbers.items()})
    files["truth.json"] = json.dumps(truth, indent=1) + "\n"
    return files


def met_as(program, machine, record, dt, fault):
    """Greatest differences [K, um] between the truth with what is hidden and `driftwright simulate` of the machine written down as it is."""
    t, u = (a[0] for a in simulate(machine, machine.nominal(), record, [fault]))
    other, numbers = altered(fault, machine, machine.nominal())
    other.numbers = {k: (float(x[0]), machine.numbers.get(k, (0, "exponent" if k.startswith("e ") else "log"))[1]) for k, x in numbers.items() if machine.numbers.get(k) is not None or not k.startswith("G ") or tuple(k.split()[1:]) in other.links}
    again = simulate(other, other.nominal(), record)
    own = max(np.max(np.abs(a - b[0])) if a.size else 0.0 for a, b in zip((t, u), again))
    if own > 1e-6:
        raise SystemExit(f"{fault.key}: two ways to say it differ by {own}")
    return check.met(program, other, record, dt)[0]


def held_to(program):
    """Each family twice, nominal and without noise, in two styles of driving and of rows; then what is new: as the grammar says it, or by recorded columns."""
    worst = [0.0, 0.0]

    def note(name, off):
        print(f"{name:62s} off by {off[0]:.4f} K, {off[1]:.4f} um", flush=True)
        worst[:] = [max(a, b) for a, b in zip(worst, off)]

    for i, family in enumerate(families.FAMILIES):
        for repeat in range(2):
            rng = np.random.default_rng([121, i, repeat])
            machine, plan = family(rng, Draw(rng))
            machine.sensors = [("t_" + b, b) for b in machine.bodies]
            families.priors(rng, machine)
            machine.start = [["hall", 31.5], ["steady", "hall"], [13.0, "steady"]][i % 3][repeat]
            dt, n = families.pace(rng, plan, 12, 2)
            style = (("gaps", "even"), ("lost", "slower"), ("two_paces", "even"))[i % 3][repeat]
            machine.longest_step_s = float(np.clip(dt, 20, 150))
            styles = [families.STYLES[(i + 3 * k + 4 * repeat) % len(families.STYLES)] for k in range(3)]
            record = families.record(rng, "measured_1", plan, families.rows(rng, style, dt, n), styles, ("corridor", "degC"))
            note(f"{family.__name__}, {style}, {' '.join(styles)}", check.met(program, machine, record, dt)[0])
    noise = dict(temperature=dict(sigma=0.1, step=0.01), displacement=dict(sigma=0.5, step=0.01))
    rng = np.random.default_rng([122])
    machine, plan = families.test_engine(rng, Draw(rng))
    machine.displacement("deck", "z", {"head": 1.4, "block": 2.0})
    machine.displacement("front", "y", {"block": 1.1})
    machine.sensors, time_s = [("t_" + b, b) for b in machine.bodies], np.arange(300) * 30.0

    def drawn(way, **more):
        for _ in range(200):
            record = families.record(rng, "measured_1", plan, time_s, ["telegraph", "night_shift", "trials"])
            try:
                return record, faults.draw(rng, way, machine, plan, [record], None, noise)[0]
            except Impossible:
                continue
        raise SystemExit(f"{way} cannot be drawn")
    for way in ("body_between", "body_with_heat", "split_body", "cabin_forgotten", "link_moved", "heat_too_much", "warm_corner"):      # the grammar says it as another machine
        for machine.start in ("hall", "steady"):
            record, fault = drawn(way)
            note(f"{way}, written down, start {machine.start}", met_as(program, machine, record, 30, fault.with_size(min(0.6, np.sqrt(fault.low * fault.high)))))
    machine.start = "hall"
    record, fault = drawn("bending")
    note("mislabelled", check.met(program, machine, record, 30, [Fault("sensor_place", dict(sensor="t_liner", other="head")).with_size(1.0)], "{type: sensor_place, sensor: t_liner, share: 1, body: head}")[0])
    a, b = fault.data["nodes"]
    fault = fault.with_size(1.3)
    note("bending", check.met(program, machine, record, 30, [fault], "\n  - ".join(f"{{type: displacement_path, displacement: {fault.data['channel']}, sensitivity: {x * fault.size[0]:.9g} um/K, body: {n}}}" for n, x in ((a, 1), (b, -1))))[0])
    record, fault = drawn("resistance_rises")
    fault = fault.with_size(0.004)
    note("resistance_rises", check.met(program, machine, record, 30, [fault], f"{{type: changed_law, law: cutting_heat {fault.data['node']}, decay: {fault.size[0]:.9g} 1/K}}")[0])
    for way in ("every_other_run", "chiller_hunts", "stiff_start", "critical_speed", "other_room"):      # each hides a column; here the record contains it
        record, fault = drawn(way)
        record.columns["told"] = record.columns.pop(faults.HIDDEN)
        fault.data["column"] = "told"
        fault = fault.with_size(np.sqrt(fault.low * fault.high) / 2)
        note(f"{way} by a column that is told", check.met(program, machine, record, 30, [fault], f"{{type: recorded_drive, node: {fault.data['node']}, {fault.data['mode']}: {fault.size[0]:.9g}{' W/K' if fault.data['mode'] == 'conductance' else ''}, column: told}}")[0])
    record, fault = drawn("every_other_run")
    on, fault = record.columns[faults.HIDDEN][1], fault.with_size(50.0)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], on, [0]])))
    rows = ", ".join(f"[{time_s[a]:g} s, {time_s[min(b, len(time_s) - 1)] + (30 if b >= len(time_s) else 0):g} s]" for a, b in zip(edges[::2], edges[1::2]))
    record.columns.pop(faults.HIDDEN)
    told = Fault("heat_window", dict(what="heat", node=fault.data["node"]), windows=[(time_s[a], time_s[b] if b < len(time_s) else time_s[-1] + 30) for a, b in zip(edges[::2], edges[1::2])]).with_size(50.0)
    note("every_other_run as windows", check.met(program, machine, record, 30, [told], f"{{type: heat_window, node: {fault.data['node']}, power: 50 W, windows: [{rows}]}}")[0])
    record, fault = drawn("speed_capped")
    record.speed = np.where(record.speed > 0, plan["top"], 0.0)
    note("speed_capped of one speed, as an override", check.met(program, machine, record, 30, [fault.with_size(0.2)], "{type: speed_override, factor: 0.8}")[0])
    record, fault = drawn("stiff_start")
    record.columns.pop(faults.HIDDEN)
    many = Fault("many_readings", dict(channels=["t_head", "t_block"], shares=[0.5, -1.0], begin_s=0.0)).with_size(0.8)
    note("recalibrated", check.met(program, machine, record, 30, [many], "{type: sensor_bias, sensor: t_head, bias: 0.4 K}\n  - {type: sensor_bias, sensor: t_block, bias: -0.8 K}")[0])
    many = Fault("many_readings", dict(channels=["deck", "front"], shares=[0.5, -1.0], begin_s=4210.0)).with_size(9.0)
    note("stand_bumped", check.met(program, machine, record, 30, [many], "{type: mount_shift, displacement: deck, shift: 4.5 um, time: 4210 s}\n  - {type: mount_shift, displacement: front, shift: -9 um, time: 4210 s}")[0])
    note("all_in_air", check.met(program, machine, record, 30, [Fault("all_in_air", dict(sensors=[])).with_size(0.1)], "\n  - ".join(f"{{type: sensor_place, sensor: {n}, share: 0.1, body: ambient}}" for n, _ in machine.sensors))[0])
    still = Fault("begun_warm", dict(nodes=["head"])).with_size(0.0)      # the short step before the first row does nothing of its own
    note("warm_start of nothing", [float(np.max(np.abs(x - y))) for x, y in zip(simulate(machine, machine.nominal(), record, [still]), simulate(machine, machine.nominal(), record))])
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
