#!/usr/bin/python3
"""Writes the cases of the blind trial whose truth is not this program's own (README.md).

    generate.py FOLDER [--set first] [--seed 20261122] [--cases 330] [--only 7 12]
    generate.py --check [--set first] [--program driftwright]      the nominal machine against `driftwright simulate`
"""
import argparse
import json
import os
import pathlib

for v in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):     # before numpy: the same sums in the same order, and one core
    os.environ.setdefault(v, "1")
import numpy as np

import check
import families
import faults
import further_families
from nats import HALL_SIGMA_K, Judge
from network import moved, simulate
from writing import record_csv, scenario

# Of each set: its own seed, the classes of its cases, the families of its machines.
SETS = {"first": (20261122, ["A"] * 140 + ["B"] * 60 + ["C16"] * 50 + ["C8"] * 50 + ["D"] * 30, families.FAMILIES),
        "structure_2": (20261123, ["A"] * 25 + ["B"] * 10, further_families.FAMILIES)}


def table(seed, classes):
    """(class, kinds) of each case, mixed by the seed; kinds take turns within a class."""
    rng = np.random.default_rng([seed, 1000003])
    out, turn = [], {"A": 0, "C16": 0, "C8": 5, "D": 0}
    for c in classes:
        kinds = []
        if c == "A":
            kinds = [faults.KINDS_A[turn[c] % len(faults.KINDS_A)]]
        elif c in ("C16", "C8"):
            kinds = [faults.KINDS_C[turn[c] % len(faults.KINDS_C)]]
        elif c == "D":
            kinds = [faults.KINDS_C[i] for i in rng.choice(len(faults.KINDS_C), 2, replace=False)]
        if c in turn:
            turn[c] += 1
        out.append((c, kinds))
    return [out[i] for i in rng.permutation(len(out))]


def log_uniform(rng, a, b):
    return float(np.exp(rng.uniform(np.log(a), np.log(b))))


def scattered(rng, machine, wide):
    """True numbers: the scenario's, 10 % (exponents 3 %) one sigma, never beyond three stated sigmas; `wide` names a group whose prior is wrong by a factor 2."""
    out = {}
    for k, (value, kind) in machine.numbers.items():
        factor = wide["factor"] if wide and k.startswith(wide["group"]) else 1.0
        while True:
            z = factor * rng.standard_normal()
            if abs(z) <= 3:
                break
        out[k] = np.array([moved(value, kind, z)])
    return out


def noisy(rng, clean, channel, coloured, dt):
    n = clean.shape
    e = rng.standard_normal(n)
    if coloured["share"] > 0:
        phi = np.exp(-dt / (60 * coloured["minutes"]))
        x = coloured["share"] * rng.standard_normal(n[1])
        for k in range(n[0]):
            e[k] += x
            x = phi * x + coloured["share"] * np.sqrt(1 - phi ** 2) * rng.standard_normal(n[1])
    y = clean + channel["sigma"] * e
    return np.round(y / channel["step"]) * channel["step"]


def attempt(seed, index, number, cls, kinds, machines):
    rng = np.random.default_rng([seed, index, number])
    family = machines[int(rng.integers(len(machines)))]
    machine, plan = family(rng, families.Draw(rng))
    noise = families.instruments(rng, machine, plan)
    if cls not in ("A", "B"):
        noise["coloured"] = dict(share=0.0, minutes=0.0)
    n_records = int(rng.integers(3, 5)) if "run_state" in kinds else int(rng.integers(1, 5))
    column, drives = None, False
    if "recorded_drive" in kinds:
        gain = any(h["kind"] == "cutting_heat" for h in machine.heats) and rng.random() < 0.45
        drives = not gain
    if drives or rng.random() < 0.25:
        column = families.EXTRA_COLUMNS[int(rng.integers(len(families.EXTRA_COLUMNS)))]
    choices = [d for d in (10, 15, 20, 30, 60, 120, 300) if plan["dt"][0] <= d <= plan["dt"][1]]
    dt = choices[int(rng.integers(len(choices)))]
    records = []
    for r in range(n_records + 1):
        hours = rng.uniform(*plan["hours"])
        n_rows = int(np.clip(round(hours * 3600 / dt), 200, 1500))
        records.append(families.record(rng, f"measured_{r + 1}" if r < n_records else "holdout_1", plan, n_rows, dt, column))
    if column and any(not np.any(r.columns[column[0]][1]) for r in records):
        raise faults.Impossible
    judge = Judge(machine, records[:-1], noise) if kinds else None
    hidden, worth = [], []
    for kind in kinds:
        fault = faults.draw(rng, kind, machine, plan, records, column if drives else None, cls != "A")
        target = log_uniform(rng, *{"A": (20, 400), "C16": (16.5, 400), "C8": (8, 16), "D": (20, 400)}[cls])
        size = judge.size_for(fault, target, may_be_louder=not hidden)
        if size is None:
            raise faults.Impossible
        fault = fault.with_size(float(f"{size:.6g}"))
        hidden.append(fault)
        worth.append(float(judge.nats(judge.deviation([fault], 1))[0]))
        if not 0.9 < worth[-1] / target < 1.1 or (cls == "C16" and worth[-1] < 16) or (cls == "C8" and not 7.9 < worth[-1] < 16):
            raise faults.Impossible
    apart = None
    if cls == "D":
        same = [f.data.get("sensor") or f.data.get("channel") for f in hidden]
        if same[0] and same[0] == same[1]:
            raise faults.Impossible
        d = [judge.deviation([f], 1) for f in hidden]
        apart = [float(judge.nats(d[i], d[1 - i][0])[0]) for i in (0, 1)]
        if min(apart) < 16:
            raise faults.Impossible
    wide = None
    if rng.random() < 0.2:
        wide = dict(group=str(rng.choice(["C ", "G ", "P "])), factor=float(rng.choice([0.5, 2.0])))
    numbers = scattered(rng, machine, wide)
    for fault in hidden:      # a share of recorded power is never more than all of it
        i = fault.data.get("heat")
        if fault.key == "recorded_drive" and i is not None and numbers[f"P {i}"][0] * np.exp(fault.size[0]) > 1:
            raise faults.Impossible
    missing = 0.005 if rng.random() < 0.15 else 0.0
    files, offsets = {}, {}
    for r in records:
        offset = float(np.round(HALL_SIGMA_K * rng.standard_normal(), 3))
        offsets[r.name] = offset
        t, u = (a[0] for a in simulate(machine, numbers, r, hidden, np.array([offset])))
        t = noisy(rng, t, noise["temperature"], noise["coloured"], dt)
        u = noisy(rng, u, noise["displacement"], noise["coloured"], dt)
        if t.size and (t.max() > 250 or t.min() < -60):
            raise faults.Impossible
        files[r.name + ".csv"] = record_csv(machine, r, t, u, rng, missing)
    files["scenario.yaml"] = scenario(machine, dt)
    channels = {n + "_degC": noise["temperature"] for n, _ in machine.sensors} | {d[0] + "_um": noise["displacement"] for d in machine.displacements}
    truth = dict(case=index, seed=[seed, index, number], **{"class": cls}, family=machine.family, n_records=n_records, interval_s=dt, rows={r.name: len(r.time_s) for r in records},
                 effects=[faults.told(f, machine, records, w) for f, w in zip(hidden, worth)], nats_apart=apart, channels=channels, coloured_noise=noise["coloured"],
                 prior_wrong=wide, hall_offset_K=offsets, extra_column=column[0] if column else None, missing=missing,
                 numbers={k: [float(f"{x:.6g}"), float(f"{numbers[k][0]:.6g}")] for k, (x, _) in machine.numbers.items()})
    files["truth.json"] = json.dumps(truth, indent=1) + "\n"
    return files


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("folder", nargs="?")
    p.add_argument("--set", choices=list(SETS), default="first")
    p.add_argument("--seed", type=int, help="default: the set's own")
    p.add_argument("--cases", type=int, help="default: all")
    p.add_argument("--only", type=int, nargs="*")
    p.add_argument("--check", action="store_true")
    p.add_argument("--program", default="driftwright")
    a = p.parse_args()
    if a.check:
        raise SystemExit(check.check(a.program, SETS[a.set][2]))
    if not a.folder:
        p.error("FOLDER is missing")
    own_seed, classes, machines = SETS[a.set]
    seed = own_seed if a.seed is None else a.seed
    plan = table(seed, classes)
    for index in (a.only if a.only is not None else range(a.cases if a.cases is not None else len(classes))):
        cls, kinds = plan[index]
        for number in range(400):
            try:
                files = attempt(seed, index, number, cls, kinds, machines)
                break
            except faults.Impossible:
                continue
        else:
            raise SystemExit(f"case {index}: no machine found for {cls} {kinds}")
        folder = pathlib.Path(a.folder) / f"case_{index:04d}"
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in files.items():
            (folder / name).write_text(text)
        print(f"case_{index:04d} {cls:3s} {json.loads(files['truth.json'])['family']:16s} {','.join(kinds) or '-'}  (try {number})", flush=True)


if __name__ == "__main__":
    main()
