#!/usr/bin/python3
"""Writes the cases of the set `third`, whose sizes are set by refits that are not linear (README.md).

    third.py FOLDER [--only 7 12]
    third.py --check [--program driftwright]      the nominal machines against `driftwright simulate`
"""
import argparse
import dataclasses
import json
import os
import pathlib

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):     # before numpy: the same sums in the same order, and one core
    os.environ.setdefault(variable, "1")
import numpy as np

import check
import third_families as families
import third_faults as faults
from third_faults import Impossible
from generate import log_uniform, noisy
from nats import HALL_SIGMA_K, Judge
from network import Machine, moved, simulate
from refitted import Refit
from writing import record_csv, scenario

SEED = 2026112419
CLASSES = ["A"] * 28 + ["B"] * 11 + ["C16"] * 16 + ["C8"] * 9 + ["D"] * 6
RANGE = dict(A=(20, 400), C16=(16.5, 400), C8=(8, 16), D=(18, 400))      # of the nats that are aimed at
ALLOWED = dict(A=(18, 480), C16=(16, 480), C8=(8, 16), D=(16, 480))      # of the refitted nats that are reached
GUESS = float(np.log(2) / 0.1)


def table():
    """(class, kinds, turn of the instruments) of each case, mixed by the seed; families, kinds and instruments take turns."""
    rng = np.random.default_rng([SEED, 1000003])
    ways = list(rng.permutation(faults.WAYS_A)) + list(rng.permutation(faults.WAYS_A))
    kinds = list(rng.permutation(faults.KINDS_C)) + list(rng.permutation([k for k in faults.KINDS_C if k != "sensor_swap"]))
    out = []
    for c in CLASSES:
        if c == "A":
            out.append((c, [str(ways.pop(0))]))
        elif c in ("C16", "C8"):
            k = next(i for i, x in enumerate(kinds) if c == "C16" or x != "sensor_swap")
            out.append((c, [str(kinds.pop(k))]))
        elif c == "D":
            out.append((c, [str(x) for x in rng.choice([k for k in faults.KINDS_C if k != "sensor_swap"], 2, replace=False)]))
        else:
            out.append((c, []))
    return [out[i] for i in rng.permutation(len(out))]


def priors(rng, machine):
    """What the scenario says of how well its numbers are known, and how they scatter in truth: label -> sigmas; what was done, for truth.json."""
    r, labels = rng.random(), list(machine.numbers)
    if r < 0.40:
        return {}, None
    group = str(rng.choice(["C ", "G ", "P "]))
    air = {"C " + b for b in machine.air}      # the grammar has no word for how well the capacity of air is known
    of_group = [k for k in labels if k.startswith(group)]
    if r < 0.60:      # not said
        factor = float(rng.choice([0.5, 2.0]))
        return {k: factor for k in of_group}, dict(kind="scatter unlike the prior, unsaid", group=group.strip(), factor=factor)
    if r < 0.80:
        factor = float(rng.choice([0.5, 2.0]))
        machine.stated = {k: factor for k in of_group if k not in air}
        return {}, dict(kind="said to be known to 20 %" if factor > 1 else "said to be known to 5 %", group=group.strip(), factor=factor)
    shares = {f"P {i}" for i, h in enumerate(machine.heats) if h["kind"] == "cutting_heat"}
    able = [k for k in labels if k[:2] in ("C ", "G ", "P ") and k not in shares | air]
    chosen = [str(x) for x in rng.choice(able, min(len(able), int(rng.integers(2, 5))), replace=False)]
    machine.stated = {k: GUESS for k in chosen}
    return {}, dict(kind="guess", numbers=chosen)


def scattered(rng, machine, wide):
    z = {}
    for k in machine.numbers:
        most = 1.6 if machine.stated.get(k, 1.0) > 3 else 3.0
        while True:
            z[k] = float(wide.get(k, 1.0) * rng.standard_normal())
            if abs(z[k]) <= most:
                break
    return z


def fits(cls, value, fault):
    """Thermometers that are swapped have no size: they are worth what they are."""
    return ALLOWED[cls][0] <= value and (value <= ALLOWED[cls][1] or fault.low == fault.high)


def sized(rng, cls, drawn, machine, records, noise, z, offsets):
    """The faults with sizes at which they are worth what they shall be: (faults, refitted nats, linear nats)."""
    judge = Judge(machine, records, noise)
    target, sizes = [], []
    for fault in drawn:
        goal = log_uniform(rng, *RANGE[cls])
        if fault.low == fault.high:      # wired to each other's channel: there is no size
            sizes.append(1.0)
        else:
            size = judge.size_for(fault, goal, may_be_louder=len(drawn) == 1)
            if size is None:
                raise Impossible
            sizes.append(size)
        target.append(goal)
    for _ in range(6):
        sizes = [float(f"{s:.5g}") for s in sizes]
        hidden = [f.with_size(s) for f, s in zip(drawn, sizes)]
        refit = Refit(machine, records, noise, z, offsets, hidden)
        got = [refit.nats(i if len(hidden) > 1 else None) for i in range(len(hidden))]
        if all(fits(cls, n, f) and (0.67 < n / t < 1.5 or f.low == f.high) for n, t, f in zip(got, target, drawn)):
            got = [refit.nats(i if len(hidden) > 1 else None, thorough=True) for i in range(len(hidden))]
            if all(fits(cls, n, f) for n, f in zip(got, drawn)):
                line = [float(judge.nats(judge.deviation([f], 1))[0]) for f in hidden]
                return hidden, [float(n) for n in got], line
        if all(f.low == f.high for f in drawn):
            raise Impossible
        new = [s if f.low == f.high else float(np.clip(s * np.clip(np.sqrt(t / max(n, 0.05)), 0.3, 2.2), f.low, f.high)) for s, n, t, f in zip(sizes, got, target, drawn)]
        if new == sizes:
            raise Impossible
        sizes = new
    raise Impossible


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
    files: dict         # name -> text


def attempt(index, number, cls, kinds):
    """The case of this number of the table, at this try."""
    rng = np.random.default_rng([SEED, index, number])
    make = families.FAMILIES[(index + number) % len(families.FAMILIES)]
    machine, plan = make(rng, families.Draw(rng))
    wide, said = priors(rng, machine)
    noise, looked = families.instruments(rng, machine, index // 2 + number)
    machine.stated = {k: x for k, x in machine.stated.items() if k in machine.numbers}
    if not isinstance(machine.start, float) and rng.random() < 0.25:
        machine.start = "steady"
    style = ["even", "gaps", "even", "uneven", "even"][int(rng.integers(5))]
    if cls in ("A", "B") and style == "even" and rng.random() < 0.4:
        noise["coloured"] = dict(share=families.rounded(rng.uniform(0.15, 0.4), 2), minutes=families.rounded(rng.uniform(2, 6), 2))
    n_records = int(rng.integers(3, 5)) if "run_state" in kinds else int(rng.integers(1, 5))
    column = None
    way = kinds[0] if kinds else ""
    if way in faults.COLUMNS:
        column = faults.COLUMNS[way][int(rng.integers(4))]
    elif rng.random() < 0.3:
        column = families.DECOYS[int(rng.integers(len(families.DECOYS)))]
    steps = [d for d in (10, 15, 20, 30, 60, 120, 300, 600, 900) if plan["dt"][0] <= d <= plan["dt"][1]]
    dt = steps[int(rng.integers(len(steps)))]
    records = []
    for r in range(n_records + 1):
        n_rows = int(np.clip(round(rng.uniform(*plan["hours"]) * 3600 / dt), 200, 500))
        records.append(families.record(rng, f"measured_{r + 1}" if r < n_records else "holdout_1", plan, n_rows, dt, style, column))
    if column and any(not np.any(r.columns[column[0]][1]) for r in records):
        raise Impossible
    machine.longest_step_s = float(np.clip(dt / 2, 20, 60))
    z = scattered(rng, machine, wide)
    numbers = {k: np.array([moved(v, kind, z[k], machine.stated.get(k, 1.0))]) for k, (v, kind) in machine.numbers.items()}
    if any(h["kind"] == "cutting_heat" and numbers[f"P {i}"][0] > 0.98 for i, h in enumerate(machine.heats)):
        raise Impossible
    offsets = {r.name: float(np.round(HALL_SIGMA_K * rng.standard_normal(), 3)) for r in records}
    drawn = [faults.draw(rng, k, machine, plan, records, column) for k in kinds]
    if len(drawn) == 2:
        places = [f.data.get("sensor") or f.data.get("channel") for f in drawn]
        if (places[0] and places[0] == places[1]) or drawn[0].key == drawn[1].key:
            raise Impossible
    hidden, worth, line = sized(rng, cls, drawn, machine, records[:-1], noise, z, [offsets[r.name] for r in records[:-1]]) if drawn else ([], [], [])
    for fault in hidden:
        i = fault.data.get("heat")
        if fault.key == "recorded_drive" and i is not None and numbers[f"P {i}"][0] * np.exp(fault.size[0]) > 1:
            raise Impossible
    missing, files = 0.005 if rng.random() < 0.2 else 0.0, {}
    for r in records:
        t, u = (a[0] for a in simulate(machine, numbers, r, hidden, np.array([offsets[r.name]])))
        if not np.isfinite(t).all() or (t.size and (t.max() > 230 or t.min() < -40)):
            raise Impossible
        t, u = noisy(rng, t, noise["temperature"], noise["coloured"], dt), noisy(rng, u, noise["displacement"], noise["coloured"], dt)
        files[r.name + ".csv"] = record_csv(machine, r, t, u, rng, missing)
    files["scenario.yaml"] = scenario(machine, dt)
    channels = {n + "_degC": noise["temperature"] for n, _ in machine.sensors} | {d[0] + "_um": noise["displacement"] for d in machine.displacements}
    effects = []
    for f, w, l in zip(hidden, worth, line):
        effects.append(faults.told(f, machine, records, w))
        effects[-1].update(nats=round(w, 2), nats_linear=round(l, 2))
    truth = dict(case=index, seed=[SEED, index, number], **{"class": cls}, ways=kinds, family=machine.family, n_records=n_records, interval_s=dt, rows={r.name: len(r.time_s) for r in records}, rows_are=style,
                 looked_at_by=looked, effects=effects, channels=channels, coloured_noise=noise["coloured"], priors=said, hall_offset_K=offsets, extra_column=column[0] if column else None, missing=missing,
                 numbers={k: [float(f"{x:.6g}"), float(f"{numbers[k][0]:.6g}")] for k, (x, _) in machine.numbers.items()})
    files["truth.json"] = json.dumps(truth, indent=1) + "\n"
    return Case(machine, plan, noise, numbers, hidden, offsets, records, column, dt, missing, files)


def held_to(program):
    """Each family twice, nominal and without noise: even rows and uneven ones, priors said; then those faults that the grammar can say and check.py has not."""
    worst = [0.0, 0.0]

    def note(name, off):
        print(f"{name:42s} off by {off[0]:.4f} K, {off[1]:.4f} um", flush=True)
        worst[:] = [max(a, b) for a, b in zip(worst, off)]

    for i, family in enumerate(families.FAMILIES):
        for repeat, style in enumerate(("uneven", "gaps")):
            rng = np.random.default_rng([79, i, repeat])
            machine, plan = family(rng, families.Draw(rng))
            machine.sensors = [("t_" + b, b) for b in machine.bodies]
            machine.stated = {k: (GUESS, 2.0, 0.5, 1.0)[j % 4] for j, k in enumerate(machine.numbers) if not k.startswith("S ") and k not in {"C " + b for b in machine.air}}
            machine.longest_step_s = float(np.clip(plan["dt"][1] / 2, 20, 60))
            if repeat and not isinstance(machine.start, float):
                machine.start = "steady"
            record = families.record(rng, "measured_1", plan, 300, plan["dt"][1], style, ("loop", "degC"))
            note(f"{family.__name__}, {style}", check.met(program, machine, record, plan["dt"][1])[0])
    rng = np.random.default_rng([80])
    machine, plan = families.gear_hobber(rng, families.Draw(rng))
    machine.sensors = [("t_" + b, b) for b in machine.bodies]
    body, channel, top = "hob_head", machine.displacements[0][0], float(plan["top"])
    for column in (("loop", "degC"), ("valve", "percent")):
        record = families.record(rng, "measured_1", plan, 300, 60, "even", column)
        F = faults.Fault
        for fault, size, line in [
                (F("recorded_drive", dict(node=body, column="loop", unit="degC", mode="conductance")), 6.0, f"{{type: recorded_drive, node: {body}, conductance: 6 W/K, column: loop}}"),
                (F("recorded_drive", dict(node=body, column="valve", unit="percent", mode="opening")), 0.2, f"{{type: recorded_drive, node: {body}, opening: 0.2, column: valve}}"),
                (F("recorded_drive", dict(node=body, column="valve", unit="percent", mode="gain")), 1.5, f"{{type: recorded_drive, node: {body}, gain: 1.5, column: valve}}"),
                (F("friction_law", dict(heat=0, node="hob_bearing", decay=True)), 0.02, "{type: changed_law, law: heat_source hob_bearing, decay: 0.02 1/K}"),
                (F("forced_convection", dict(link=(body, "hall"), at=top / 4)), 0.6, f"{{type: changed_law, law: link {body} - ambient, exponent: 0.6, at_speed: {top / 4:g} rpm}}"),
                (F("heat_capacity", dict(node=body)), float(np.log(1.5)), f"{{type: heat_capacity, node: {body}, factor: 1.5}}"),
                (F("scale_expansion", dict(channel=channel, what="factor")), float(np.log(1.4)), f"{{type: scale_expansion, displacement: {channel}, factor: 1.4}}"),
                (F("scale_expansion", dict(channel=channel, what="lag")), 25.0, f"{{type: scale_expansion, displacement: {channel}, lag: 25 min}}"),
                (F("centrifugal", dict(channel=channel, at=top)), 9.0, f"{{type: centrifugal, displacement: {channel}, growth: 9 um, at_speed: {top:g} rpm}}"),
                (F("sensor_swap", dict(sensor="t_hob_head", other="t_bed")), 1.0, "{type: sensor_swap, sensor: t_hob_head, with: t_bed}"),
                (F("sensor_place", dict(sensor="t_hob_head", other="hall")), 0.4, "{type: sensor_place, sensor: t_hob_head, share: 0.4, body: ambient}"),
                (F("ambient", dict(ramp=True)), 0.7, "{type: ambient, ramp: 0.7 K/h}")]:
            if fault.data.get("column", column[0]) == column[0]:
                note(fault.key, check.met(program, machine, record, 60, [fault.with_size(size)], line)[0])
    print(f"worst: {worst[0]:.4f} K, {worst[1]:.4f} um: {'fine' if worst[0] <= 0.05 and worst[1] <= 0.25 else 'NOT WITHIN 0.05 K and 0.25 um'}")
    return 0 if worst[0] <= 0.05 and worst[1] <= 0.25 else 1


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("folder", nargs="?")
    p.add_argument("--only", type=int, nargs="*")
    p.add_argument("--check", action="store_true")
    p.add_argument("--program", default="driftwright")
    a = p.parse_args()
    if a.check:
        raise SystemExit(held_to(a.program))
    if not a.folder:
        p.error("FOLDER is missing")
    plan = table()
    for index in (a.only if a.only is not None else range(len(plan))):
        cls, kinds = plan[index]
        for number in range(150):
            try:
                files = attempt(index, number, cls, kinds).files
                break
            except Impossible:
                continue
        else:
            raise SystemExit(f"case {index}: no machine found for {cls} {kinds}")
        folder = pathlib.Path(a.folder) / f"case_{index:04d}"
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in files.items():
            (folder / name).write_text(text)
        truth = json.loads(files["truth.json"])
        print(f"case_{index:04d} {cls:3s} {truth['family']:20s} {','.join(kinds) or '-'} {[(e['nats'], e['nats_linear']) for e in truth['effects']]} (try {number})", flush=True)


if __name__ == "__main__":
    main()
