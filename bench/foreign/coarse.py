#!/usr/bin/python3
"""Writes the cases of the set `coarse`: a truth that is finer and richer than the user's model everywhere (README.md).

    coarse.py FOLDER [--seed 2026112615] [--cases 30] [--only 7 12] [--program driftwright]
    coarse.py --check        the truth's own integration against scipy's Radau
"""
import argparse
import copy
import json
import os
import pathlib
import tempfile

for v in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(v, "1")
import numpy as np

import coarse_families
import coarse_faults
from coarse_truth import SIGMA, Record, Solver, power_of, readings
import held_out
from writing import g, seen, with_readings

SEED, CASES = 2026112615, 30
TOO_FAR = 0.6           # of the rise: a model as written that is farther off is drawn again
PACES = (30, 36, 40, 45, 50, 60, 75, 90)


def near(rng, sigma):
    """A factor, lognormal, never beyond two sigmas."""
    while True:
        z = rng.standard_normal()
        if abs(z) < 2:
            return float(np.exp(sigma * z))


def r3(x):
    return float(f"{x:.3g}")


# ---------------------------------------------------------------------------------------------------------------- runs

def levels(rng, minutes, kind):
    """[(begin_s, level 0 to 1)]."""
    out, at = [], 0.0
    if rng.random() < 0.6:
        at = rng.uniform(5, 25)
        out.append((0.0, 0.0))
    i, one = 0, rng.uniform(0.6, 1.0)
    while at < minutes:
        if kind == "steps":
            level, length = rng.choice([0, 0.25, 0.4, 0.6, 0.8, 1.0]), rng.uniform(15, 70)
        elif kind == "duty":
            level, length = (one if i % 2 == 0 else 0.0), rng.uniform(8, 40)
        elif kind == "long":
            level, length = (one if i % 2 == 0 else 0.0), (rng.uniform(0.35, 0.7) * minutes if i % 2 == 0 else rng.uniform(30, 120))
        else:
            level, length = (rng.uniform(0.2, 1.0) if rng.random() < 0.75 else 0.0), rng.uniform(10, 50)
        out.append((60 * at, round(float(level), 2)))
        at += length
        i += 1
    return out


def course(rng, t, base):
    hours = t / 3600
    a = base + rng.uniform(-0.5, 1.2) * hours / max(hours[-1], 1) + rng.uniform(0.2, 1.2) * np.sin(2 * np.pi * (hours / rng.uniform(5, 24) + rng.random()))
    dt, x, y = t[1] - t[0], 0.0, np.empty(len(t))
    phi = np.exp(-dt / 2400)
    for k in range(len(t)):
        y[k] = x
        x = phi * x + 0.25 * np.sqrt(1 - phi ** 2) * rng.standard_normal()
    return a + y


def record(rng, truth, name, hours, base, column, dt):
    n = int(np.clip(round(hours * 3600 / dt), 200, 800))
    t = np.arange(n) * float(dt)
    drive = np.zeros(n)
    for begin, level in levels(rng, t[-1] / 60, rng.choice(["steps", "duty", "long", "random"])):
        drive[t >= begin] = level
    if drive.max() == 0:
        drive[n // 8: n // 2] = 0.8
    zero = np.zeros(n)
    by = dict(speed=zero, feed=zero, power=zero)
    by[truth.drive] = np.round(drive * dict(speed=truth.top, feed=truth.top_feed, power=truth.top_power)[truth.drive])
    rec = Record(name, t, by["speed"], by["feed"], by["power"], course(rng, t, base), truth.gradient * rng.uniform(0.6, 1.4))
    if column:
        on = np.zeros(n)
        for begin, level in levels(rng, t[-1] / 60, "random"):
            on[t >= begin] = level
        rec.column = on
    rec.start = truth.warm_at_start * rng.standard_normal()
    lag, x = truth.recorder_lag_s, rec.air[0]
    rec.recorded = np.empty(n)
    for k in range(n):
        rec.recorded[k] = x
        if k + 1 < n:
            x += (rec.air[k + 1] - x) * -np.expm1(-dt / lag)
    rec.recorded = rec.recorded + truth.recorder_bias + 0.03 * rng.standard_normal(n)
    return rec


# ---------------------------------------------------------------------------------------------------------------- truth

def machine(rng, family):
    v = lambda x: float(x * np.exp(rng.uniform(-0.35, 0.35)))
    t = family(rng, v)
    t.gradient = float(rng.uniform(0.0, 0.8))
    t.recorder_lag_s, t.recorder_bias = 60 * rng.uniform(2, 12), float(0.15 * rng.standard_normal())
    t.wall_lag_s = 3600 * rng.uniform(0.7, 3)
    t.h = [h * rng.uniform(0.8, 1.25) for h in t.h]
    for part in t.parts.values():
        f, e = rng.uniform(0.75, 1.3), rng.uniform(0.3, 0.95)
        for i in part["nodes"]:
            t.h[i] *= f
            t.eps[i] = e
    # heats by shares, so that what is warmest rises by so much in the mean use after three hours
    rise = rng.uniform(14, 34)
    total = 150.0
    for _ in range(4):
        probe = t.copy()
        for h in probe.heats:
            h["p"] *= total
            h["idle"] *= total
        n = 40
        rec = Record("probe", np.linspace(0, 3.5 * 3600, n), np.full(n, 0.7 * t.top), np.full(n, 0.7 * t.top_feed), np.full(n, 0.7 * t.top_power), np.full(n, 20.0), 0.0)
        top = Solver(probe).run(rec, 400)[-1].max() - 20
        total *= float(np.clip(rise / top, 0.1, 8))
    for h in t.heats:
        h["p"] *= total
        h["idle"] *= total
    rec.air = np.full(n, 20.0)
    solver = Solver(t)
    warm = solver.run(rec, 400)[-1]
    air = solver.air_at(rec, 1.0)
    film = solver.area * ((warm - air) * (solver.h * ((warm - air) ** 2 + 0.25) ** 0.125 / 10 ** 0.25 + solver.wind * 0.7 ** 0.7) + solver.eps * SIGMA * ((warm + 273.15) ** 4 - 293.15 ** 4))
    t.warm, t.film = warm, film
    if t.drive == "power":      # the heater takes what is recorded, but for what its leads lose
        t.top_power = r3(t.heats[0]["p"] / rng.uniform(0.85, 0.97))
    for b in bodies(t):
        idx = [i for i, x in enumerate(t.body) if x == b]
        for k in range(1 if rng.random() < 0.75 else 2):
            i = idx[int(rng.integers(len(idx) // 4, -(-3 * len(idx) // 4)))] if len(idx) > 1 else idx[0]
            t.sensors.append(dict(name=f"t_{b}" + ("_2" if k else ""), body=b, node=i, lag_s=60 * rng.uniform(0.3, 2.5), bias=float(np.clip(0.1 * rng.standard_normal(), -0.2, 0.2))))
    if rng.random() < 0.5 and len(t.sensors) > 4:       # not every body has one
        del t.sensors[int(rng.integers(len(t.sensors)))]
    t.warm_at_start = np.zeros(len(t.cap))
    for b in bodies(t):
        t.warm_at_start[[i for i, x in enumerate(t.body) if x == b]] = abs(0.2 * rng.standard_normal())
    return t


def bodies(t):
    return list(dict.fromkeys(b for b in t.body if b))


# ---------------------------------------------------------------------------------------------------------------- the user's model

def model(rng, t):
    """Numbers as an engineer has them: [(what, dict of numbers and words)]; each with an error of its own."""
    def number(x, key, sigma=0.13, words=None):
        known = rng.random()
        word = None
        if key in ("conductance", "passage_conductance") and known < 0.12:
            word, sigma = "guess", 0.35
        elif known < 0.3 and key != "exponent":
            word, sigma = "20 %", 0.17
        if word:
            words[key] = word
        return r3(x * near(rng, sigma))

    out, names = [], bodies(t)
    index = {b: [i for i, x in enumerate(t.body) if x == b] for b in names}
    for b in names:
        w = {}
        out.append(dict(type="node", node=b, capacity=number(sum(t.cap[i] for i in index[b]), "capacity", 0.08, w), known=w))
    links = {}

    def middle(part, body):
        s = [t.s[i] for i in index[body] if t.part_of[i] == part]
        return (min(s) + max(s)) / 2, max(max(s) - min(s), 1 / len(t.parts[part]["nodes"]))

    def way(part, body, s, wide):
        m, span = middle(part, body)
        p = t.parts[part]
        return max(abs(s - m), span / 4) * (1 - min(wide, 1.0)) * p["length"] / p["kA"] * 0.8

    for j in t.joints:
        a, b = j["bodies"]
        if a != b:
            res = 1 / j["g"] + way(j["a"], a, j["sa"], j["wa"]) + way(j["b"], b, j["sb"], j["wb"])
            links[a, b] = links.get((a, b), 0.0) + 1 / res
    for part, p in t.parts.items():
        own = list(dict.fromkeys(t.body[i] for i in p["nodes"]))
        for a, b in zip(own, own[1:]):
            links[a, b] = links.get((a, b), 0.0) + p["kA"] / (abs(middle(part, a)[0] - middle(part, b)[0]) * p["length"])
    mean = {b: np.average(t.warm[index[b]], weights=[t.cap[i] for i in index[b]]) for b in names}
    for (a, b), x in links.items():         # from the drawing, corrected towards what flows in a warm state of the truth
        flow = sum(k * (t.warm[i] - t.warm[j]) * (1 if t.body[i] == a else -1) for i, j, k in t.edges if {t.body[i], t.body[j]} == {a, b})
        w, d = {}, mean[a] - mean[b]
        if abs(d) > 0.3 and flow / d > 0:
            x *= float(np.clip(flow / d / x, 0.25, 4.0))
        out.append(dict(type="link", node=a, to=b, conductance=number(x, "conductance", 0.15, w), known=w))
    for b in names:
        w = {}
        x = sum(t.area[i] * (t.h[i] * 0.92 + 5.8 * t.eps[i] + 0.4 * t.wind[i]) for i in index[b])
        if mean[b] > 20.5:
            x *= float(np.clip(sum(t.film[i] for i in index[b]) / (mean[b] - 20) / x, 0.6, 1.6))
        out.append(dict(type="link", node=b, to="ambient", conductance=number(x, "conductance", 0.14, w), known=w))
    for c in t.circuits:
        w = {}
        out.append(dict(type="coolant", node=c["body"], flow=number(c["flow"], "flow", 0.08, w), passage_conductance=number(c["ha"], "passage_conductance", 0.15, w), set_point=c["set"], known=w))
    for h in t.heats:
        w = {}
        r = np.array([0.25, 0.5, 0.75, 1.0])
        q = np.array([power_of(h, x, 20 + (t.warm[h['nodes']].mean() - 20) * min(1.0, x / 0.7), 0.0)[0] for x in r])
        idle = power_of(h, 0.0, 22.0, 0.0)[0]
        if h["kind"] == "heater":
            out.append(dict(type="cutting_heat", node=h["body"], share=min(0.99, r3(q[-1] / t.top_power * near(rng, 0.06))), known=w))
            continue
        e = np.polyfit(np.log(r), np.log(q - idle), 1)[0]
        law = dict(type="servo_loss" if h["by"] == "feed" else "motor_loss" if h["kind"] == "motor" else "heat_source", node=h["body"], power=number(q[-1] - idle, "power", 0.14, w),
                   exponent=round(float(e * near(rng, 0.04)), 2), known=w)
        if idle > 0:
            law["idle"] = r3(idle * near(rng, 0.14))
        out.append(law)
    seen = []
    for d in t.displacements:
        terms = {}
        for i, x in d["model"].items():
            terms[t.body[i]] = terms.get(t.body[i], 0.0) + x
        seen.append((d["name"], [(b, r3(x * near(rng, 0.08))) for b, x in terms.items()]))
    return dict(effects=out, displacements=seen, names=names)


UNITS = dict(capacity="J/K", conductance="W/K", flow="L/min", passage_conductance="W/K", set_point="degC", power="W", idle="W")


def scenario(t, m, dt):
    out = [f"# {coarse_families.TITLES[t.family].capitalize()}. Numbers are estimates from drawings and data sheets.", f"name: {t.family}", "reference_temperature: 20 degC", "start: ambient",
           "machine: {generator: lumped}", "effects:"]
    for e in m["effects"]:
        words = [f"{x}: {e[x]}" for x in ("type", "node", "to") if x in e]
        words += [f"{x}: {g(e[x])} {u}" for x, u in UNITS.items() if x in e]
        if e["type"] == "servo_loss":
            words += [f"at_feed: {g(t.top_feed / 1000)} m/min", "axis: x"]
        elif "exponent" in e:
            words += [f"at_speed: {g(t.top)} rpm"]
        words += [f"{x}: {g(e[x])}" for x in ("exponent", "share") if x in e]
        if e["known"]:
            words.append("known_to: {%s}" % ", ".join(f"{k}: {w}" for k, w in e["known"].items()))
        out.append("  - {" + ", ".join(words) + "}")
    return "\n".join(out + seen([(s["name"], s["body"]) for s in t.sensors], m["displacements"], dt)) + "\n"


def record_csv(t, rec, temperatures, displacements, column):
    head, cols = ["time_s", "speed_rpm"], [[g(x) for x in rec.t], [g(x) for x in rec.speed]]
    if t.drive == "feed":
        head.append("feed_x_mm_min")
        cols.append([g(x) for x in rec.feed])
    if t.drive == "power":
        head.append("cutting_power_W")
        cols.append([g(x) for x in rec.power])
    if column:
        head.append(f"{column[0]}_{column[1]}")
        cols.append([g(x * column[2]) for x in rec.column])
    return with_readings(head, cols, rec.recorded, [s["name"] for s in t.sensors], temperatures, [d["name"] for d in t.displacements], displacements)


def simulated(program, text, t, rec, csv):
    """The model as written on a record: (rows, sensors), (rows, displacements)."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "measured_1.csv").write_text(csv)
        (folder / "scenario.yaml").write_text(held_out.with_ambient(text, "measured_1.csv"))
        rows, message = held_out.simulated(program, "scenario.yaml", "measured_1.csv", folder)
    if not rows:
        raise SystemExit(text + message)
    at = [rows[round(float(x), 3)] for x in rec.t]
    return np.array([[float(r[s["name"] + "_degC"]) for s in t.sensors] for r in at]), np.array([[float(r[d["name"] + "_um"]) for d in t.displacements] for r in at])


# ---------------------------------------------------------------------------------------------------------------- a case

def noisy(rng, clean, noise, dt):
    n = clean.shape
    phi = np.exp(-dt / (60 * noise["slow_min"]))
    x, y = noise["slow"] * rng.standard_normal(n[1]), np.empty(n)
    for k in range(n[0]):
        y[k] = x
        x = phi * x + noise["slow"] * np.sqrt(1 - phi ** 2) * rng.standard_normal(n[1])
    return np.round((clean + y + noise["sigma"] * rng.standard_normal(n)) / noise["step"]) * noise["step"]


def rms(parts):
    return float(np.sqrt(sum((x ** 2).sum() for x in parts) / sum(x.size for x in parts)))


def table(seed):
    """(class, family, fault) of each case: half of them have a gross fault; families and faults take turns in a mixed order."""
    rng = np.random.default_rng([seed, 1000003])
    cls = rng.permutation(["K"] * (CASES // 2) + ["F"] * (CASES // 2))
    fam = [coarse_families.FAMILIES[i] for k in range(-(-CASES // 8)) for i in rng.permutation(len(coarse_families.FAMILIES))][:CASES]
    kinds = [coarse_faults.KINDS[i] for k in range(2) for i in rng.permutation(len(coarse_faults.KINDS))]
    return [(str(c), fam[i], kinds[int(np.sum(cls[:i] == "F"))] if c == "F" else None) for i, c in enumerate(cls)]


def no(why):
    if os.environ.get("COARSE_WHY"):
        print("    drawn anew:", why, flush=True)


def attempt(seed, index, number, cls, family, kind, program):
    rng = np.random.default_rng([seed, index, number])
    t = machine(rng, family)
    noise_t = dict(sigma=round(rng.uniform(0.03, 0.08), 3), step=float(rng.choice([0.01, 0.0625, 0.1])), slow=round(rng.uniform(0.02, 0.06), 3), slow_min=round(rng.uniform(15, 60)))
    noise_u = dict(sigma=round(rng.uniform(0.1, 0.5), 2), step=float(rng.choice([0.01, 0.1])), slow=round(rng.uniform(0.1, 0.5), 2), slow_min=round(rng.uniform(20, 80)))
    m = model(rng, t)
    n_records = int(rng.integers(2, 4))
    spare = rng.random() < 0.3
    column = None
    if kind == "recorded_column" or spare:
        column = [("sun", "W_m2", 800.0), ("hydraulics", "W", 1000.0), ("valve", "percent", 100.0)][int(rng.integers(3))]
    base = rng.uniform(18, 23)
    dt = float(rng.choice([x for x in PACES if 200 <= 3600 * t.hours[0] / x and 3600 * t.hours[1] / x <= 800]))
    records = []
    for r in range(n_records + 2):
        name = f"measured_{r + 1}" if r < n_records else f"holdout_{r + 1 - n_records}"
        records.append(record(rng, t, name, rng.uniform(*t.hours), base + rng.uniform(-1.5, 1.5) + (rng.choice([-2.5, 2.5]) if r >= n_records else 0), column, dt))
    fault = coarse_faults.draw(rng, kind, t, m, records, column) if kind else None
    if kind and fault is None:
        return no('cannot be on it')
    ratio_wanted = rng.uniform(2.1, 3.5)
    text = scenario(t, m, dt)
    # the model as written, on the records without the fault
    clean, far, said = {}, [[], []], {}
    for rec in records:
        y = readings(t, rec, Solver(t).run(rec))
        clean[rec.name] = y
        if rec.name.startswith("holdout"):
            continue
        said[rec.name] = simulated(program, text, t, rec, record_csv(t, rec, *y, column))
        for k in (0, 1):
            far[k].append((said[rec.name][k] - y[k], y[k] - y[k][0]))
        if rec.name == "measured_1" and any(rms([f[0][0]]) > 1.5 * TOO_FAR * rms([f[0][1]]) for f in far):
            return no('far off at once')
    off = [rms([a for a, _ in f]) / rms([b for _, b in f]) for f in far]
    if max(off) > TOO_FAR:
        return no(f'far off {off}')
    sigma = [np.sqrt(n["sigma"] ** 2 + n["step"] ** 2 / 12) for n in (noise_t, noise_u)]
    miss = lambda truth_y, model_y: rms([(model_y[r][k] - truth_y[r][k]) / sigma[k] for r in model_y for k in (0, 1)])
    plain_miss, told, with_fault = miss(clean, said), None, clean
    if fault:
        lo, hi = fault["sizes"]
        size = lo
        while True:
            with_fault = dict(clean)
            for rec in records:
                if rec.name in fault["records"]:
                    t2, rec2 = copy.deepcopy(t), copy.deepcopy(rec)
                    with_fault[rec.name] = fault["change"](t2, rec2, size)
            hottest = max(np.abs(y[0]).max() for y in with_fault.values())
            gross = miss(with_fault, said)
            if gross >= ratio_wanted * plain_miss:
                break
            if size >= hi:
                if gross >= 2 * plain_miss:
                    break
                return no(f'{kind} never gross: {gross / plain_miss:.2f}, as written {off[0]:.2f} {off[1]:.2f}')
            size = min(size * (1.35 if gross > 1.5 * plain_miss else 1.7), hi)
        if hottest > 130 or gross > 8 * plain_miss:
            return no(f'{kind} too gross: {gross / plain_miss:.2f}, {hottest:.0f} degC')
        told = dict(key=fault["key"], where=fault["where"], parameters=[], sizes={fault["unit"]: float(f"{size:.4g}"), **fault.get("more", {})}, records=fault["told_records"], way=kind,
                    worth=round(gross / plain_miss, 2), also=[dict(effect=a, where=b) for a, b in fault["also"]])
        if fault.get("windows_min"):
            told["windows_min"] = fault["windows_min"]
    files = {"scenario.yaml": text}
    for rec in records:
        y = with_fault[rec.name]
        files[rec.name + ".csv"] = record_csv(t, rec, noisy(rng, y[0], noise_t, dt), noisy(rng, y[1], noise_u, dt), column)
    channels = {s["name"] + "_degC": noise_t for s in t.sensors} | {d["name"] + "_um": noise_u for d in t.displacements}
    truth = dict(case=index, seed=[seed, index, number], **{"class": cls}, family=t.family, ways=[kind] if kind else [], n_records=n_records, interval_s=dt,
                 rows={r.name: len(r.t) for r in records}, effects=[told] if told else [], channels=channels, coloured_noise=dict(temperature=noise_t, displacement=noise_u),
                 nodes=len(t.cap), bodies=len(m["names"]), off_as_written=dict(temperature=round(off[0], 3), displacement=round(off[1], 3), over_noise=round(plain_miss, 2)),
                 extra_column=column[0] if column else None, small=dict(gradient_K_m=round(t.gradient, 3), recorder_lag_min=round(t.recorder_lag_s / 60, 2), recorder_bias_K=round(t.recorder_bias, 3),
                 bias_K={s["name"]: round(s["bias"], 3) for s in t.sensors}, lag_min={s["name"]: round(s["lag_s"] / 60, 2) for s in t.sensors}, decay_1_K=[round(h["decay"], 4) for h in t.heats]))
    files["truth.json"] = json.dumps(truth, indent=1) + "\n"
    return files


def check():
    from scipy.integrate import solve_ivp
    for i, family in enumerate(coarse_families.FAMILIES):
        rng = np.random.default_rng([99, i])
        t = machine(rng, family)
        rec = record(rng, t, "measured_1", 3.0, 20.0, None, 45.0)
        s = Solver(t)
        mine = s.run(rec)
        y, w, worst = mine[0], rec.air[0], 0.0
        state = np.append(y, w)
        for row in range(len(rec.t) - 1):
            u = s.inputs(rec, row)
            end = rec.t[row + 1]

            def f(x, z):
                x = min(x, end - 1e-6)
                return np.append(s.rates(z[:-1], s.air_at(rec, x), z[-1], u, x, False) / s.cap, (np.interp(x, rec.t, rec.air) - z[-1]) / t.wall_lag_s)

            def jac(x, z):
                out = np.zeros((len(z), len(z)))
                out[:-1, :-1] = s.rates(z[:-1], s.air_at(rec, min(x, end - 1e-6)), z[-1], u, min(x, end - 1e-6))[1] / s.cap[:, None]
                out[-1, -1] = -1 / t.wall_lag_s
                return out
            state = solve_ivp(f, (rec.t[row], end), state, method="Radau", jac=jac, rtol=1e-7, atol=1e-7).y[:, -1]
            worst = max(worst, np.abs(state[:-1] - mine[row + 1]).max())
            if row > 120:
                break
        print(f"{t.family:18s} {len(t.cap):3d} nodes, {len(bodies(t))} bodies, greatest rise {np.ptp(mine, axis=0).max():5.1f} K, off from Radau by {worst:.4f} K", flush=True)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("folder", nargs="?")
    p.add_argument("--seed", type=int, default=SEED)
    p.add_argument("--cases", type=int, default=CASES)
    p.add_argument("--only", type=int, nargs="*")
    p.add_argument("--check", action="store_true")
    p.add_argument("--program", default="driftwright")
    a = p.parse_args()
    if a.check:
        return check()
    if not a.folder:
        p.error("FOLDER is missing")
    plan = table(a.seed)
    for index in (a.only if a.only else range(a.cases)):
        cls, family, kind = plan[index]
        files = None
        for number in range(40):
            # a fault that cannot be on a family, or is not gross enough there in six tries, moves to another family
            can = [f for f in coarse_families.FAMILIES if coarse_faults.can_be_on(kind, f.__name__)]
            at = family if number < 6 and family in can else can[int(np.random.default_rng([a.seed, index, number // 3, 5]).integers(len(can)))]
            files = attempt(a.seed, index, number, cls, at, kind, a.program)
            if files:
                break
        else:
            raise SystemExit(f"case {index}: no machine found for {cls} {kind}")
        folder = pathlib.Path(a.folder) / f"case_{index:04d}"
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in files.items():
            (folder / name).write_text(text)
        d = json.loads(files["truth.json"])
        o = d["off_as_written"]
        print(f"case_{index:04d} {cls} {d['family']:18s} {kind or '-':18s} try {number:2d}  {d['nodes']:2d} nodes {d['bodies']} bodies, off {o['temperature']:.2f} {o['displacement']:.2f}, {o['over_noise']:5.1f} of noise"
              + (f", times {d['effects'][0]['worth']}" if kind else ""), flush=True)


if __name__ == "__main__":
    main()
