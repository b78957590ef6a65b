"""What is hidden: faults.yaml, how a way of being wrong is drawn for a machine and its records, and how truth.json describes it (README.md).

A formula of faults.yaml knows laws.py, what its way drew before, and what `Words` has: the machine, its records, and how to choose.
"""
import copy
import functools
import pathlib
import re

import numpy as np
import yaml

import laws
from network import Fault, simulate

LEAST_NATS = 3.0       # another name counts as right where it leaves less than this of what is hidden
FOLDER = pathlib.Path(__file__).resolve().parent


class Impossible(Exception):
    """This machine or these records cannot have such a fault; another one is drawn."""


@functools.lru_cache(maxsize=None)
def catalogue(path=None):
    """way -> how it is drawn, what it does and what it is called; a set may have further ways in a file of its own."""
    out = yaml.safe_load((FOLDER / "faults.yaml").read_text()) | (yaml.safe_load(pathlib.Path(path).read_text()) if path else {})
    return {way: whole(out, way) for way in out}


def whole(ways, way):
    """A way with what it has from the one that it is `like`, and with what need not be written."""
    spec = ways[way]
    if "like" in spec:
        base = whole(ways, spec["like"])
        spec = {**base, **spec, "draw": {**base.get("draw", {}), **spec.get("draw", {})}}
        spec = {k: {a: b for a, b in x.items() if b is not None} if k == "draw" else x for k, x in spec.items() if k != "like" and x is not None}
    if "key" in spec and "where" not in spec:
        spec = spec | {"where": next(x for x in ("node", "name") if x in spec.get("draw", {}) or x in spec.get("late", {}))}
    return spec


def bounded(low, high):
    if high < 10 * low:
        raise Impossible
    return low, high


def one_window(when):
    return not when["every"] and sum(len(x) for x in when["windows"].values()) == 1


def in_records(by_record, records=None, told=False):
    """Windows [s] of records by name; told: truth.json says them."""
    return dict(windows=by_record, records=records, every=None, told=told)


class Words:
    """The names that formulas know of a machine with its records; draws are made from `rng` in their order."""

    def __init__(self, rng, machine, plan, records, column=None, noise=None, ways=None):
        self.rng, self.machine, self.plan, self.records, self.noise = rng, machine, plan, records, noise
        self.measured = [r for r in records if r.name != "holdout_1"]
        self.ways, self.known = ways or catalogue(), {}
        self.names = self.of_machine() | self.of_records() | self.of_choice() | (dict(column=column[0], unit=column[1]) if column else {})

    def of_machine(self):
        m, plan = self.machine, self.plan
        value = lambda k: m.numbers[k][0]
        kinds = lambda test: [i for i, h in enumerate(m.heats) if test(h)]
        speeds = kinds(lambda h: h["has_exponent"] and h["kind"] not in ("servo_loss", "cutting_heat"))
        solid, by_power = [b for b in m.bodies if b not in m.air], sorted(speeds, key=lambda k: -value(f"P {k}"))

        def heavy(least, most=None):
            return sorted(solid, key=lambda b: -value("C " + b))[:most or max(least, (len(solid) + 1) // 2)]
        return dict(bodies=list(m.bodies), solid=solid, air=m.air, links=m.links, joints=[x for x in m.links if x[1] != "hall"], films=[a for a, b in m.links if b == "hall"], circuits=m.circuits, heats=m.heats, t_ref=m.t_ref, start=m.start,
                    sensors=m.sensors, thermometers=[n for n, _ in m.sensors], displacements=m.displacements, channels=[d[0] for d in m.displacements], linked={frozenset(x) for x in m.links}, longest_step=m.longest_step_s,
                    speeds=speeds, servos=kinds(lambda h: h["kind"] == "servo_loss"), loads=kinds(lambda h: h["kind"] == "cutting_heat"), driven=list(dict.fromkeys(m.heats[k]["node"] for k in by_power)), driven_bodies={m.heats[k]["node"] for k in speeds},
                    watts=max(value(f"P {i}") * self.full(h) for i, h in enumerate(m.heats)), recorded=sorted(plan.get("columns", {})), full=self.full, g=float(np.median([value(f"G {a} {b}") for a, b in m.links])),
                    top=plan.get("top", 0), full_power=plan.get("power", 0), powered="power" in plan, axes=sorted(plan.get("feeds", {})), top_feed=lambda a: plan["feeds"][a] / 60000, outdoor=plan.get("outdoor", False), week=plan.get("week", False),
                    value=value, heavy=heavy, label=lambda a, b: f"G {a} {b}" if f"G {a} {b}" in m.numbers else f"G {b} {a}", beside=lambda b: [y if x == b else x for x, y in m.links if b in (x, y) and "hall" not in (x, y)],
                    passage=lambda b: laws.passes(value, b), borne=lambda b, slope: 0.7 * value("C " + b) / m.longest_step_s / slope,      # the size up to which steps bear heat that hangs on temperatures
                    bounded=bounded, work=m.groups.get("work", []), high=m.groups.get("high", []), fluid=m.groups.get("fluid", []), inside_guard=m.groups.get("inside", []), bed=m.groups.get("bed"))

    def full(self, h):
        """What a recorded power, or a recorded column, is at its greatest."""
        return {"cutting_heat": lambda: self.plan["power"], "recorded_drive": lambda: self.plan["columns"][h["column"]]["top"]}.get(h["kind"], lambda: 1)()

    def own(self, r):
        """Columns that the model has, too: from 0 to 1."""
        return [r.columns[c][1] / how["top"] for c, how in self.plan.get("columns", {}).items()]

    def of_records(self):
        measured, records = self.measured, self.records

        def sigma(name):
            noise = self.noise["displacement" if name in [d[0] for d in self.machine.displacements] else "temperature"]
            return noise["sigma"], noise["sigma"] ** 2 + noise["step"] ** 2 / 12
        return dict(records=records, measured=measured, names=[r.name for r in measured], shortest=min(r.time_s[-1] for r in records), interval=records[0].time_s[1] - records[0].time_s[0], run_of=self.run, level=self.level, load_of=self.load,
                    of_body=self.of_body, rise_from_hall=self.rise_from_hall, nominal_of=self.nominal_of, sigma=lambda name: sigma(name)[0], variance=lambda name: sigma(name)[1])

    def of_choice(self):
        rng = self.rng
        return dict(rng=rng, sign=None, pick=self.pick, chance=lambda p: rng.random() < p, uniform=lambda a, b: float(rng.uniform(a, b)), log_uniform=lambda a, b: float(np.exp(rng.uniform(np.log(a), np.log(b)))), fixed=lambda x, digits=0: float(round(float(x), digits)),
                    tau=lambda low=0.01, high=0.15: float(self.names["shortest"] * np.exp(rng.uniform(np.log(low), np.log(high)))), some=self.some, two=lambda things: self.some(things, 2), scope=self.scope, some_days=self.some_days, happened=self.happened,
                    every=self.every, spans=lambda r, n: in_records({r.name: self.spans(r, n)}, [r.name], True), one_window=one_window, in_records=in_records)

    # --- choosing ---
    def pick(self, things):
        things = list(things)
        if not things:
            raise Impossible
        return things[int(self.rng.integers(len(things)))]

    def some(self, things, k):
        if len(things) < k:
            raise Impossible
        return [things[int(i)] for i in self.rng.choice(len(things), k, replace=False)]

    def scope(self, kinds):
        """None: every record, the held-out one too; one; from: from one record on."""
        names = self.names["names"]
        kind = self.pick(kinds) if len(names) > 1 else ("all" if "all" in kinds else "one")
        if kind == "all":
            return None
        return [self.pick(names)] if kind == "one" else names[int(self.rng.integers(1, len(names))):] + ["holdout_1"]

    def some_days(self, k):
        """k records, which are not the last ones."""
        names = self.names["names"]
        while True:
            days = sorted(str(x) for x in self.rng.choice(names, k, replace=False))
            if days != names[-k:]:
                return days

    def spans(self, record, n):
        """n windows of a record, of any length, in any place; the last may end after it."""
        while True:
            cuts = np.sort(self.rng.uniform(0.01, 1.05, 2 * n))
            lengths, pauses = cuts[1::2] - cuts[::2], cuts[2::2] - cuts[1:-1:2]
            if lengths.min() >= 0.03 and lengths.sum() <= 0.75 and (n == 1 or pauses.min() >= 0.03):
                return [(float(round(a * record.time_s[-1])), float(round(b * record.time_s[-1]))) for a, b in cuts.reshape(n, 2)]

    def every(self, period, first, length):
        longest = max(r.time_s[-1] for r in self.records)
        return dict(windows={"*": [(float(a), float(a + length)) for a in np.arange(first, 3 * longest, period)]}, records=None, every=(period, first, length), told=True)

    def happened(self, *kinds):
        """When: once or a few times in one record, at the same times in two, at the rests of the drive in one (as a lid that is opened then), or every so often in all."""
        rng, kind = self.rng, self.pick(kinds)
        if kind == "every":
            period = rng.uniform(0.08, 0.45) * self.names["shortest"]
            return self.every(float(round(period)), float(round(rng.uniform(0.03, 0.9) * period)), float(round(rng.uniform(0.15, 0.6) * period)))
        chosen = self.some(self.measured, 2) if kind == "two" and len(self.measured) > 1 else [self.pick(self.measured)]
        shortest = min(chosen, key=lambda r: r.time_s[-1])
        if kind == "rests":
            end = shortest.time_s[-1]
            windows = [w for w in laws.stretches(shortest, self.run(shortest) == 0) if w[0] > 0 and w[1] - w[0] > 0.02 * end]
            if not 1 <= len(windows) <= 5 or sum(b - a for a, b in windows) > 0.7 * end:
                raise Impossible
        else:
            windows = self.spans(shortest, 1 if kind == "once" else int(rng.integers(2, 4)))
        return in_records({r.name: windows for r in chosen}, sorted(r.name for r in chosen), True)

    # --- what records and machine say ---
    def run(self, r):
        """1 where the machine is driven: it turns, or what is recorded of power or feeds is more than nothing."""
        if self.names["speeds"]:
            return (r.speed > 0).astype(float)
        return ((r.power > 0) | np.any([f > 0 for f in [*r.feeds.values(), *self.own(r)]] or [r.power > 0], axis=0)).astype(float)

    def load(self, r):
        """From 0 to 1: what is recorded of power, or else of feeds, or else of speed."""
        if "power" in self.plan:
            return r.power / self.plan["power"]
        return np.mean([f / (self.plan["feeds"][a] / 60000) for a, f in r.feeds.items()], axis=0) if r.feeds else r.speed / self.plan["top"] if "top" in self.plan else np.mean(self.own(r), axis=0)

    def level(self, i, r):
        """What heat `i` is of its greatest, by nominal numbers and without idle heat."""
        h = self.machine.heats[i]
        e = self.machine.numbers[f"e {i}"][0] if h["has_exponent"] else 1.0
        if h["kind"] == "cutting_heat":
            return r.power / self.plan["power"]
        if h["kind"] == "recorded_drive":
            return r.columns[h["column"]][1] / self.full(h)
        if h["kind"] == "servo_loss":
            return (r.feeds[h["axis"]] / (self.plan["feeds"][h["axis"]] / 60000)) ** e
        if h["has_exponent"]:
            return (r.speed / self.plan["top"]) ** e
        return (r.speed > 0).astype(float) if h["turning"] else np.ones(len(r.time_s))

    def temperatures(self, start=None):
        """Of all bodies of the nominal machine, by record (row x body)."""
        if start not in self.known:
            m = copy.copy(self.machine)
            m.sensors, m.displacements, m.start = [(b, b) for b in m.bodies], [], start or m.start
            self.known[start] = {r.name: simulate(m, m.nominal(), r)[0][0] for r in self.measured}
        return self.known[start]

    def of_body(self, body, records=None):
        i = self.machine.bodies.index(body)
        return np.concatenate([self.temperatures()[r.name][:, i] for r in records or self.measured])

    def rise_from_hall(self, r, share):
        t = self.temperatures("hall")[r.name]
        return t[int(share * len(t))] - t[0]

    def nominal_of(self, channel):
        m = copy.copy(self.machine)
        m.sensors, m.displacements = [x for x in m.sensors if x[0] == channel], [x for x in m.displacements if x[0] == channel]
        return np.concatenate([a[0].ravel() for r in self.measured for a in simulate(m, m.nominal(), r)])

    def signals(self, spec, names):
        """record -> name -> values at its rows."""
        out = {r.name: {} for r in self.records}
        for name, how in (spec or {}).items():
            how = how if isinstance(how, dict) else {"is": how}
            for r in self.records:
                known = dict(r=r, t=r.time_s, end=r.time_s[-1], speed=r.speed, power=r.power, feeds=r.feeds, hall=r.hall, run=self.run(r), load=self.load(r) if laws.mentions(how["is"], "load") else None)
                out[r.name][name] = np.array(np.broadcast_to(np.asarray(laws.value(how["is"], {**names, **known, **out[r.name]}), float), r.time_s.shape))
            moving, moves = [r.name for r in self.records if np.ptp(out[r.name][name]) > 0], how.get("moves", "all")
            measured = [r.name for r in self.measured]
            needed = dict(all=len(moving) == len(self.records), all_measured=set(measured) <= set(moving), any=bool(set(measured) & set(moving)), first=measured[0] in moving)
            if moves and not needed[moves]:
                raise Impossible
        return out

    # --- a fault ---
    def draw(self, way, given=None):
        """The faults that this way of being wrong consists of; `given`: names that are not drawn."""
        spec = self.ways[way]
        if "one_of" in spec:
            ways, weights = list(spec["one_of"]), np.array(list(spec["one_of"].values()), float)
            chosen = ways[int(self.rng.choice(len(ways), p=weights / weights.sum()))]
            if "column" in self.ways[chosen]:      # the recorded column determines how it acts
                chosen = self.pick([w for w in ways if self.names.get("unit") in self.ways[w]["column"]])
            return self.draw(chosen, given)
        if "both" in spec:
            first, = self.draw(spec["both"][0])
            second, = self.draw(spec["both"][1], {spec["at"]: first.names[spec["at"]]})
            if first.told["place"] == second.told["place"]:
                raise Impossible
            either = [x for f in (first, second) for x in [(f.told["key"], f.told["place"])] + f.told["also"] + further_names(f.told["spec"].get("also"), f.names)]
            for f in (first, second):
                f.told = dict(f.told, also=either, parameters=[])
            return [first, second]
        if "in_two_records" in spec:
            if len(self.measured) < 4:
                raise Impossible
            fault, = self.draw(self.pick(spec["in_two_records"]), dict(scope=None, steps=False, from_s=0.0))
            fault.records = self.some_days(2)
            if fault.told["key"] in ("heat_source", "convection", "contact", "speed_override"):
                fault.told = dict(fault.told, also=fault.told["also"] + [("run_state", ",".join(fault.records))])
            return [fault]
        return [self.one(way, spec, given or {})]

    def one(self, way, spec, given):
        names = {**self.names, "sign": 1.0 if self.rng.random() < 0.5 else -1.0, "signal": None}
        of = lambda formula, **more: laws.value(formula, {**names, **more})

        def must(formulas):
            if not all(bool(of(x)) for x in formulas or []):
                raise Impossible
        if (spec.get("column") and self.names.get("unit") not in spec["column"]) or (spec.get("indoors") and self.plan.get("outdoor")) or (spec.get("steady") is not None and (self.machine.start == "steady") != spec["steady"] and not given):
            raise Impossible
        must(spec.get("needs") if not given else [])
        for k, formula in (spec.get("draw") or {}).items():
            names[k] = given[k] if k in given else of(formula)
        must(spec.get("must"))
        signals = self.signals(spec.get("signals"), names)
        names["signal"] = lambda name, records=self.measured: [signals[r.name][name] for r in records]
        for k, formula in (spec.get("late") or {}).items():
            names[k] = given[k] if k in given else of(formula)
        must(spec.get("then"))
        when = given.get("when") or of(spec["when"]) if "when" in spec else None
        low, high = (float(of(x)) for x in (of(spec["size"]) if isinstance(spec["size"], str) else spec["size"]))
        records = of(spec["records"]) if "records" in spec else when["records"] if when else None
        fault = Fault(way, terms(spec["terms"], names), names, records, low, high, float(of(spec.get("sign", 1.0))), when["windows"] if when else None, signals)
        fault.told = self.called(spec, names, when)
        return fault

    def called(self, spec, names, when):
        key = laws.value(spec["key"], names) if "'" in spec["key"] else spec["key"]
        place = places(spec["where"], names, key)
        return dict(key=key, place=place[0], also=[(key, x) for x in place[1:]], spec=spec, when=when)


# --- the words of faults.yaml ---------------------------------------------------------------------------------------------------------


def name(text, names):
    """A name that the way drew, or the text itself; what is in braces, or a list, is a formula."""
    if not isinstance(text, str):
        return text
    if "{" in text:
        return re.sub(r"\{([^{}]*)\}", lambda m: str(laws.value(m[1], names)), text)
    if "[" in text:
        return laws.value(text, names)
    return names[text] if text in names and (names[text] is None or isinstance(names[text], (str, list, int))) else text


NAMES = ("body", "link", "bath", "law", "relink", "to", "number", "heat", "heat_like", "node", "start", "reads", "axis", "of", "open", "drive")


def terms(specs, names):
    """The terms of a fault, with names in the place of words; `each`: one for each item, which formulas call `it`."""
    out = []
    for spec in specs:
        if "if" in spec and not laws.value(spec["if"], names):
            continue
        for item in list(laws.value(spec["each"], names)) if "each" in spec else [None]:
            own = spec
            if "each" in spec:
                word = f"it_{sum(k.startswith('it_') for k in names)}"
                names[word] = item
                own = {k: replaced(x, word) for k, x in spec.items()}
            term = {}
            for k, x in own.items():
                if k in NAMES:
                    term[k] = [name(y, names) for y in x] if isinstance(x, list) else name(x, names)
                elif k == "fed":
                    term[k] = {name(b, names): formula for b, formula in x.items()}
                elif k == "degC" and x in names and isinstance(names[x], str):
                    term[k] = names[x]
                elif k not in ("each", "if"):
                    term[k] = x
            out.append(term)
    return out


def replaced(x, word):
    if isinstance(x, dict):
        return {replaced(k, word): replaced(y, word) for k, y in x.items()}
    if isinstance(x, list):
        return [replaced(y, word) for y in x]
    return re.sub(r"\bit\b", word, x) if isinstance(x, str) else x


def places(text, names, key):
    """A place, or several where a word of it is a list; records of `run_state` are one place."""
    if "'" in text or " " in text:
        text = laws.value(text, names)
        return [text] if isinstance(text, str) else list(text)
    out = [""]
    for word in text.split(","):
        if "[" in word or "." in word:
            found = laws.value(word, names)
        else:
            found = names[word] if word in names and isinstance(names[word], (str, list, tuple)) else word
        found = [",".join(found)] if key == "run_state" and not isinstance(found, str) else [found] if isinstance(found, str) else list(found)
        out = [f"{a},{b}" if a else b for a in out for b in found]
    return out


def further_names(items, names):
    """[(effect, place)] of `also`: `effect place [if formula]`; film: the names of an exchange with the hall; pair, pairs: those of a link."""
    out = []
    for item in items or []:
        item, _, condition = item.partition(" if ")
        if condition and not laws.value(condition, names):
            continue
        effect, _, where = item.partition(" ")
        for place in places(where, names, effect) if effect != "pairs" else [None]:
            if effect == "film":
                out += [("convection", place), ("contact", place), ("link", place + ",hall")]
            elif effect == "pair":
                out += [("link", place), ("contact", place)]
            elif effect == "pairs":
                at = names[where]
                out += [(k, f"{a},{b}") for i, a in enumerate(at) for b in at[i + 1:] for k in ("link", "contact")]
            else:
                out.append((effect, place))
    return out


def plain(x):
    """As JSON has it."""
    if isinstance(x, dict):
        return {k: plain(y) for k, y in x.items()}
    if isinstance(x, (list, tuple, np.ndarray)):
        return [plain(y) for y in x]
    return float(f"{x:.6g}") if isinstance(x, (float, np.floating)) else x.item() if isinstance(x, np.generic) else x


def told(fault, records, nats, alike=()):
    """The entry of truth.json. `also`: other names that say the same of this fault (README.md); `alike`: those that the data cannot tell from it."""
    spec, s, when = fault.told["spec"], float(fault.size[0]), fault.told["when"]
    names = {**fault.names, "s": s}
    key, place = fault.told["key"], fault.told["place"]
    parameters = []
    for text in fault.told.get("parameters", spec.get("parameters", [])):
        text, _, condition = text.partition(" if ")
        if not condition or laws.value(condition, names):
            label, _, rest = text.partition(" ")
            formula, _, unit = rest.rpartition(" ")
            parameters.append(dict(name=label, value=float(laws.value(formula, names)), unit=name(unit, names)))
    also = [x for x in dict.fromkeys(fault.told["also"] + further_names(spec.get("also"), names)) if x != (key, place)]
    bare = {(k, w.replace(",hall", "")) for k, w in also + [(key, place)]}
    fresh = [x for x in dict.fromkeys(alike) if (x[0], x[1].replace(",hall", "")) not in bare]
    out = dict(way=fault.way, key=key, where=place, parameters=parameters, sizes=plain(dict(size=s, **{k: fault.names[k] for k in spec.get("sizes", [])})), records=fault.records or "all", nats=round(float(nats), 2),
               also=[dict(effect=a, where=b) for a, b in also + fresh], also_as_data_cannot_tell=[list(x) for x in fresh])
    if "windows_min" in spec:
        out["windows_min"] = plain(laws.value(spec["windows_min"], names))
    elif when and when["told"]:
        windows = next(iter(when["windows"].values()))
        out["windows_min"] = [[round(a / 60, 4), round(b / 60, 4)] for a, b in windows if not when["every"] or a < records[0].time_s[-1]]
        if when["every"]:
            out["every_min"] = round(when["every"][0] / 60, 4)
    if "told_what" in spec:
        out["what"] = names[spec["told_what"]]
    return out


# --- what data cannot tell apart --------------------------------------------------------------------------------------------------------


def candidates(words, at, when, records, ambient):
    """[(effect, where, fault of a moderate size)] of what might be taken for it at these bodies."""
    m, w = words.machine, words.names
    watts, g, out = 0.05 * w["watts"], 0.2 * w["g"], []

    def take(effect, where, way, size, **given):
        fault = words.one(way, words.ways[way], dict(given, scope=records))
        fault.sign, fault.records = 1.0, when["records"] if when and "when" in given else records
        out.append((effect, where, fault.with_size(size)))
    for node in at:
        for law, e in [("constant", 1.0)] + ([("turning", 1.0), ("speed", 1.0), ("speed", 2.0)] if w["speeds"] else []):
            take("heat_source", node, "heat_source", watts, node=node, law=law, exponent=e, at=float(w["top"]) or 1.0, from_s=0.0, way_sign=1.0)
        for effect, where in (("link", node + ",hall"), ("convection", node), ("contact", node)):
            take(effect, where, "link", g, a=node, b="hall")
        c = m.numbers["C " + node][0]
        for x in (0.02, 0.1, 0.4):
            take("hidden_body", node, "hidden_body", 0.3, node=node, capacity=c, minutes=1.0, conductance=c / (x * w["shortest"]), to_hall=0.0)
        take("heat_capacity", node, "heat_capacity", 0.1, node=node)
        for i, h in enumerate(m.heats):
            if h["node"] == node and h["has_exponent"]:
                take("friction_law", node, "feed_law", 0.1, i=i, node=node, e=1.0)
            if h["node"] == node and h["kind"] == "cutting_heat":
                take("recorded_drive", node, "power_gain", 0.1, i=i, node=node, share=0.3, up=True)
        if when:
            take("heat_window", node, "heat_window", watts, node=node, way_sign=1.0, when=when)
            take("exchange_window", node, "exchange_window", g, a=node, b="hall", when=when)
    for i, a in enumerate(at):
        for b in at[i + 1:]:
            for effect in ("link", "contact"):
                take(effect, f"{a},{b}", "link", g, a=a, b=b)
    if ambient:
        take("ambient", "hall", "ambient", 0.3, steps=False, from_s=0.0)
    return out


def told_alike(words, fault, judge, scale):
    """Those of the candidates that leave less than LEAST_NATS of it, by linear nats about the nominal numbers with their size free; `scale`: refitted over linear nats of the fault."""
    spec = fault.told["spec"]
    at = spec.get("alike", [x for x in spec["where"].split(",") if x in spec.get("draw", {}) or x in spec.get("late", {})])
    at = [name(x, fault.names) for x in at] if isinstance(at, list) else laws.value(at, fault.names)
    at = [b for x in at for b in (x if isinstance(x, list) else [x]) if b in words.machine.bodies]
    d, out = judge.deviation([fault], 1), []
    for effect, where, other in candidates(words, list(at), fault.told["when"], fault.records, spec.get("alike_ambient")):
        beside = judge.deviation([other], 1)[0]
        if np.isfinite(beside).all() and np.linalg.norm(beside) > 1e-6 and scale * judge.nats(d, beside)[0] < LEAST_NATS:
            out.append((effect, where))
    return out
