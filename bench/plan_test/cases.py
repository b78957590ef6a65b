#!/usr/bin/python3
"""Cases of the paired trial of `plan-test`: the same hidden machine and fault after the usual test and after the planned one (README.md).

    cases.py FOLDER --program driftwright [--cases 75] [--programmes 2000] [--only 3 4]

Machine, fault, its size and all scatter depend only on the seed and the case's number, and are drawn before any programme is planned. Truth and noise come from ../foreign, which
shares no code with Driftwright. Per case: scenario.yaml (what `plan-test` is given: the machine as its user knows it and a job), truth.json, usual/ and planned/
(a scenario and measured_1.csv each, for `diagnose`).
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys

for v in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(v, "1")
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "foreign"))
import faults
import machines
from draw import noisy
from drives import record as drawn_record
from machines import log_uniform
from network import Record, moved, simulate
from sizing import HALL_SIGMA_K, Judge
from writing import record_csv, scenario

SEED = 20261125
HOURS, DT = 8.0, 60
# Machines whose test takes a shift and whose heats do not depend on temperature: `diagnose` takes seconds.
FAMILIES = ["grinding_spindle", "printer", "incubator", "gantry", "heater_plate", "rotary_table", "hydraulic_unit"]
# Lasting faults only: no programme knows in advance when something happens.
KINDS = ["hidden_body", "link", "heat_source", "body_growth", "sensor_place", "convection", "contact", "ambient", "sensor_bias", "sensor_lag", "sensor_drift",
         "clock_offset", "speed_override", "friction_law", "expansion"]
# Evidence of the fault, log-uniform. In even cases it is that of the usual test; in odd cases that of a record of the job of the same length, which favours neither test.
NATS = (5.0, 30.0)


def drives(record):
    return {"speed": record.speed, "power": record.power} | {"feed " + a: f for a, f in record.feeds.items()}


def record_of(name, sections, hall, like):
    """@param sections  [minutes, {drive: value}]"""
    t = np.arange(len(hall)) * float(DT)
    values = {k: np.zeros(len(t)) for k in drives(like)}
    edge = 0.0
    for minutes, drive in sections:
        inside = (t >= edge - 1e-6) & (t < edge + 60 * minutes - 1e-6)
        for k in values:
            values[k][inside] = drive.get(k, 0.0)
        edge += 60 * minutes
    for k in values:    # the last row has the values of the row before it
        values[k][-1] = values[k][-2]
    return Record(name, t, values["speed"], {k[5:]: x for k, x in values.items() if k.startswith("feed ")}, values["power"], hall, {})


def attempt(index, number, kind, sized_by):
    rng = np.random.default_rng([SEED, index, number])
    family = FAMILIES[int(rng.integers(len(FAMILIES)))]
    machine, plan = machines.machine(rng, family, machines.families("first")[family])
    noise, _ = machines.instruments(rng, machine, plan)
    n_rows = int(round(HOURS * 3600 / DT)) + 1
    job = drawn_record(rng, "job", plan, np.arange(n_rows) * float(DT), ["blocks", "blocks", "blocks"])
    top = {k: float(x.max()) for k, x in drives(job).items()}
    if not any(top.values()):
        raise faults.Impossible
    usual = record_of("measured_1", [(30 * HOURS, top), (30 * HOURS, {})], job.hall, job)
    fault, = faults.Words(rng, machine, plan, [usual], noise=noise).draw(kind)
    if fault.names.get("from_s", 0) > 0:
        raise faults.Impossible
    fault.records = None
    judge = Judge(machine, [usual if sized_by == "usual" else job], noise)
    size = judge.size_for(fault, log_uniform(rng, *NATS))
    if size is None:
        raise faults.Impossible
    fault = fault.with_size(float(f"{size:.6g}"))
    nats = float(judge.nats(judge.deviation([fault], 1))[0])
    if not 0.9 * NATS[0] < nats < 1.1 * NATS[1]:
        raise faults.Impossible
    judge = Judge(machine, [usual], noise)
    usual_nats = float(judge.nats(judge.deviation([fault], 1))[0])
    offset = float(np.round(HALL_SIGMA_K * rng.standard_normal(), 3))
    return dict(machine=machine, noise=noise, job=job, usual=usual, fault=fault, nats=nats, usual_nats=usual_nats, sized_by=sized_by, numbers=scattered(rng, machine), offset=offset, noise_seed=[SEED, index, number, 7])


def scattered(rng, machine):
    """True numbers, 10 % one sigma about the scenario's."""
    z = machines.scattered(rng, machine, {})
    return {k: np.array([moved(v, kind, z[k])]) for k, (v, kind) in machine.numbers.items()}


def case(index, kind):
    sized_by = "job" if index % 2 else "usual"
    for number in range(400):
        try:
            return attempt(index, number, kind, sized_by)
        except faults.Impossible:
            continue
    raise SystemExit(f"case {index}: no machine found for {kind}")


def measured(c, record):
    """The CSV of a test; both tests get the same draws of noise."""
    t, u = (a[0] for a in simulate(c["machine"], c["numbers"], record, [c["fault"]], np.array([c["offset"]])))
    rng = np.random.default_rng(c["noise_seed"])
    t = noisy(rng, t, c["noise"]["temperature"], c["noise"]["coloured"], record.time_s)
    u = noisy(rng, u, c["noise"]["displacement"], c["noise"]["coloured"], record.time_s)
    return record_csv(c["machine"], record, t, u, rng, 0.0)


def planned_sections(path):
    """Sections from the JSON of `plan-test`: [minutes, {drive: value}]."""
    out = []
    for row in json.loads(path.read_text())["programme"]:
        drive = {"speed": row["speed_rpm"], "power": row["cutting_power_W"]}
        drive |= {"feed " + a: row[f"feed_{a}_mm_min"] / 60000 for a in "xyz"}
        out.append((row["duration_min"], drive))
    return out


def write(folder, c, index, kind, program, programmes):
    machine = c["machine"]
    (folder / "scenario.yaml").write_text(scenario(machine, DT, hall="{csv: job.csv, channel: ambient}", plan="job.csv"))
    (folder / "job.csv").write_text(bare_csv(c["job"]))
    truth = dict(case=index, family=machine.family, kind=kind, sized_by=c["sized_by"], effects=[faults.told(c["fault"], [c["usual"]], c["nats"])], seed=SEED)
    t, u = c["noise"]["temperature"], c["noise"]["displacement"]
    sigma = [float(np.sqrt(x["sigma"] ** 2 + x["step"] ** 2 / 12)) for x in (t, u)]
    done = subprocess.run([program, "plan-test", "scenario.yaml", "--time", f"{HOURS} h", "--interval", f"{DT} s", "--noise-temperature", f"{sigma[0]:.4g} K",
                           "--noise-displacement", f"{sigma[1]:.4g} um", "--programmes", str(programmes), "-o", "plan", "--quiet"], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"case {index}: plan-test: {done.stderr}")
    sections = planned_sections(folder / "plan/summary.json")
    planned = record_of("measured_1", sections, c["job"].hall, c["job"])
    judge = Judge(machine, [planned], c["noise"])
    truth["effects"][0]["nats_usual"] = round(c["usual_nats"], 2)
    truth["effects"][0]["nats_planned"] = round(float(judge.nats(judge.deviation([c["fault"]], 1))[0]), 2)
    for name, record in (("usual", c["usual"]), ("planned", planned)):
        (folder / name).mkdir(exist_ok=True)
        (folder / name / "scenario.yaml").write_text(scenario(machine, DT))
        (folder / name / "measured_1.csv").write_text(measured(c, record))
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n")


def write_stepped(folder, c):
    """Writes the stepped test of the same length, as ISO 230-3 varies speeds: all drives at a quarter, half, three quarters and all of their range, then rest."""
    top = {k: float(x.max()) for k, x in drives(c["job"]).items()}
    sections = [(12 * HOURS, {k: share * x for k, x in top.items()}) for share in (0.25, 0.5, 0.75, 1.0, 0.0)]
    (folder / "stepped").mkdir(exist_ok=True)
    (folder / "stepped/scenario.yaml").write_text(scenario(c["machine"], DT))
    (folder / "stepped/measured_1.csv").write_text(measured(c, record_of("measured_1", sections, c["job"].hall, c["job"])))


def bare_csv(record):
    """The CSV of the drives and the hall, without readings."""
    head, columns = ["time_s", "speed_rpm"], [record.time_s, record.speed]
    for a, f in sorted(record.feeds.items()):
        head.append(f"feed_{a}_mm_min")
        columns.append(np.round(f * 60000, 1))
    if record.power.any():
        head.append("cutting_power_W")
        columns.append(record.power)
    head.append("ambient_degC")
    columns.append(record.hall)
    return ",".join(head) + "\n" + "\n".join(",".join(f"{x:.6g}" for x in row) for row in zip(*columns)) + "\n"


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("folder")
    p.add_argument("--program", required=True)
    p.add_argument("--cases", type=int, default=75)
    p.add_argument("--programmes", type=int, default=2000)
    p.add_argument("--only", type=int, nargs="*")
    p.add_argument("--stepped", action="store_true", help="only adds stepped/ to cases that are there")
    a = p.parse_args()
    for index in (a.only if a.only is not None else range(a.cases)):
        folder = pathlib.Path(a.folder) / f"case_{index:03d}"
        if a.stepped:
            write_stepped(folder, case(index, KINDS[index % len(KINDS)]))
            continue
        if (folder / "truth.json").exists():
            continue
        folder.mkdir(parents=True, exist_ok=True)
        kind = KINDS[index % len(KINDS)]
        c = case(index, kind)
        write(folder, c, index, kind, os.path.abspath(a.program), a.programmes)
        print(f"{folder.name} {c['machine'].family:16s} {kind:18s} {c['nats']:6.1f} nats", flush=True)


if __name__ == "__main__":
    main()
