"""Machines: families/*.yaml, how their numbers are drawn, what looks at them, and how well their numbers are known (README.md)."""
import functools
import pathlib

import numpy as np
import yaml

from network import Machine

FOLDER = pathlib.Path(__file__).resolve().parent / "families"
GUESS = float(np.log(2) / 0.1)      # a `guess` is known to a factor of 2
KINDS = ("heat_source", "friction_law", "motor_loss", "servo_loss", "cutting_heat", "recorded_drive")


@functools.lru_cache(maxsize=None)
def families(name):
    """Of a file of families/, or of a path: name -> family."""
    path = pathlib.Path(name)
    return yaml.safe_load((path if path.suffix == ".yaml" else FOLDER / f"{name}.yaml").read_text())


def rounded(x, digits=3):
    return float(f"{x:.{digits}g}")


def log_uniform(rng, a, b):
    return float(np.exp(rng.uniform(np.log(a), np.log(b))))


def number(rng, x):
    """Lognormal about x, 35 %; [a, b]: uniform; {exactly: x}: x."""
    if isinstance(x, dict):
        return float(x["exactly"])
    return rounded(rng.uniform(*map(float, x))) if isinstance(x, list) else rounded(float(x) * np.exp(0.35 * rng.standard_normal()))      # YAML takes 9e3 for a word


def parts(rng, m, spec):
    of = functools.partial(number, rng)
    for b, c in spec.get("bodies", {}).items():
        m.body(b, of(c))
    m.air |= set(spec.get("air", []))
    for a, b, g in spec.get("links", []):
        m.link(a, b, of(g))
    for a, b, g in spec.get("fans", []):
        m.fan(a, b, of(g))
    for x in spec.get("recorded", []):
        how, = set(x) & {"opening", "warmth"}
        m.by_column(x[how], x["column"], how, of(x["conductance"]))
    for c in spec.get("circuits", []):
        m.circuit(c["node"], of(c["flow"]), of(c["passage"]), of(c["set_point"]))
    for h in spec.get("heats", []):
        kind, = set(h) & set(KINDS)
        at = h.get("at", 1.0)
        drawn = {k: of(h[k]) for k in ("power", "exponent", "idle", "decay") if isinstance(h.get(k), list) or (k in h and k != "exponent")}
        if isinstance(h.get("exponent"), (int, float)):
            drawn["exponent"] = float(h["exponent"])
        m.heat(kind, h[kind], at=of(at) if isinstance(at, list) else float(at), axis=h.get("axis"), turning=h.get("turning", False), column=h.get("column"), **drawn)
    for name, d in spec.get("displacements", {}).items():
        m.displacement(name, d["axis"], {k: of(x) for k, x in d.items() if k != "axis"})
    if "start" in spec:
        m.start = spec["start"] if isinstance(spec["start"], str) else of(spec["start"] if isinstance(spec["start"], list) else {"exactly": spec["start"]})


def machine(rng, family, spec):
    """(the machine, how its records are)."""
    m = Machine(family)
    m.title, m.groups = spec.get("title", family.replace("_", " ")), spec.get("groups", {})
    parts(rng, m, spec)
    for more in spec.get("maybe", []):
        if rng.random() < more["chance"]:
            parts(rng, m, more)
    m.groups = {k: [b for b in x if b in m.bodies] if isinstance(x, list) else x for k, x in m.groups.items()}
    return m, spec["records"]


# --- what looks at it ------------------------------------------------------------------------------------------------------------------


SEEN = dict(both=0.4, temperatures=0.22, displacements=0.1, few=0.1, one_displacement=0.08, many=0.1)
NAMES = ["t_{body}_{nth}", "TE{number}", "card{card}_ch{slot}", "{body}_pt{nth}", "Pt{number}"]


def instruments(rng, m, plan, seen=None, names=None, most=30):
    """Leaves the thermometers and displacements that the case has; their noise, and which manner of looking it is. seen: manner -> weight; names: of thermometers."""
    seen, n = seen or SEEN, len(m.bodies)
    kind = str(rng.choice(list(seen), p=np.array(list(seen.values())) / sum(seen.values())))
    if not m.displacements and kind in ("displacements", "one_displacement"):
        kind = "temperatures"
    elif plan.get("seen") == "displacements" and m.displacements and rng.random() < 0.6:
        kind = "displacements"
    count = dict(one_displacement=0, displacements=0, few=int(rng.integers(1, 4)), temperatures=int(rng.integers(max(2, n // 2), n + 4)), both=int(rng.integers(max(1, n // 2), n + 2)), many=int(rng.integers(14, most + 1)))[kind]
    bodies = [m.bodies[int(i)] for i in rng.permutation(n)]
    places = (bodies + [bodies[int(i)] for i in rng.integers(n, size=40)])[:count]
    manner, first = str(rng.choice(names or NAMES)), 100 * int(rng.integers(1, 9)) + 1
    m.sensors = [(manner.format(body=b, nth=places[:i].count(b) + 1, number=first + i, card=i // 8 + 1, slot=i % 8 + 1), b) for i, b in enumerate(places)]
    kept = [] if kind == "temperatures" else list(m.displacements)
    if kind in ("one_displacement", "few") and kept:
        k = int(rng.integers(len(kept)))
        kept = kept[k:k + 1] if kind == "one_displacement" or rng.random() < 0.7 else []
    elif kind == "both" and len(kept) > 1 and rng.random() < 0.35:
        kept.pop(int(rng.integers(len(kept))))
    m.keep_displacements(kept)
    channel = lambda low, high, steps: (lambda step: dict(sigma=rounded(max(log_uniform(rng, low, high), 0.4 * step), 2), step=step))(float(rng.choice(list(steps), p=np.array(list(steps.values())))))
    temperature = channel(0.015, 0.2, {0.001: 0.45, 0.01: 0.15, 0.0625: 0.15, 0.1: 0.2, 0.25: 0.05})
    return dict(temperature=temperature, displacement=channel(0.08, 1.5, {0.01: 0.55, 0.1: 0.3, 0.5: 0.1, 1.0: 0.05}), coloured=dict(share=0.0, minutes=0.0)), kind


def coloured(rng, dt):
    """Noise of the first order beside the white one."""
    return dict(share=rounded(rng.uniform(0.15, 0.45), 2), minutes=rounded(dt / 60 * rng.uniform(1.5, 12), 2))


# --- how well its numbers are known --------------------------------------------------------------------------------------------------------


def priors(rng, m):
    """What the scenario says of how well numbers are known (`stated`), and how they scatter in truth: label -> sigmas of 10 % or of what is stated; what was done, for truth.json.

    10 % and so said (a third); a group that scatters by 20 % or 5 % though nobody says so; one that is said to; joints to 30 % and parts to 5 %; heats and films to 20 %; a few guesses.
    """
    air, labels, r = {"C " + b for b in m.air}, list(m.numbers), rng.random()      # the grammar has no word for how well the capacity of air is known
    shares = {f"P {i}" for i, h in enumerate(m.heats) if h["kind"] == "cutting_heat"}
    joints, films = ([k for k in labels if k.startswith("G ") and k.endswith(" hall") == to_hall] for to_hall in (False, True))
    groups = dict(parts=[k for k in labels if k.startswith("C ") and k not in air], joints=joints, films=films, heats=[k for k in labels if k.startswith("P ")])
    name, factor = str(rng.choice(list(groups))), float(rng.choice([0.5, 2.0]))
    if r < 0.35:
        return {}, None
    if r < 0.55:
        return {k: factor for k in groups[name]}, dict(kind="scatter unlike the prior, unsaid", group=name, factor=factor)
    if r < 0.70:
        m.stated = {k: factor for k in groups[name]}
        return {}, dict(kind="said to be known to 20 %" if factor > 1 else "said to be known to 5 %", group=name, factor=factor)
    if r < 0.78:
        m.stated = {k: 3.0 for k in joints} | {k: 0.5 for k in groups["parts"]}
        return {}, dict(kind="joints said to be known to 30 %, parts to 5 %")
    if r < 0.85:
        m.stated = {k: 2.0 for k in groups["heats"] + films}
        return {}, dict(kind="heats and films said to be known to 20 %")
    able = [k for k in groups["parts"] + joints + films + groups["heats"] if k not in shares]
    chosen = [str(x) for x in rng.choice(able, min(len(able), int(rng.integers(1, 5))), replace=False)]
    m.stated = {k: GUESS for k in chosen}
    return {}, dict(kind="guess", numbers=chosen)


def scattered(rng, m, wide):
    """z of each number in sigmas of what is stated: never beyond three, of a guess 1.6."""
    z = {}
    for k in m.numbers:
        most = 1.6 if m.stated.get(k, 1.0) > 3 else 3.0
        while True:
            z[k] = float(wide.get(k, 1.0) * rng.standard_normal())
            if abs(z[k]) <= most:
                break
    return z
