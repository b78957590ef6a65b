"""The truth: networks of lumped bodies, integrated by exact exponentials in steps that end at every row and every event.

    C_i dT_i/dt = sum_j G_ij (T_j - T_i) + G_i (T_hall - T_i) + W_i (T_set - T_i) + P_i(n, v, P_recorded, T)

The hall is linear between rows; speed, feeds and recorded power hold from their row on. SI units, but speeds in rpm, displacements in um and temperatures in degC. Many variants of one machine (numbers, sizes of
faults) are integrated side by side: arrays carry the variant as their first axis.

A fault is a list of terms. Each is a dict of one of these forms; formulas are Python expressions (see README.md) in `s` (the size), the names that the fault drew, and `n(label)` (a number of the machine):

    {body: NAME, C: formula}                                          one more body
    {link: [A, B], G: formula, while: windows, open: signal}          one more link; B may be `hall`, or `nothing` (what A loses goes nowhere)
    {bath: A, G: formula, degC: formula or signal, while:, open:}     a link to something that keeps a temperature
    {law: [A, B], G: formula of g and x, of: signal}                  an existing link whose conductance follows a signal x
    {relink: [A, B], to: C}                                           an existing link goes elsewhere
    {number: LABEL, is: formula of x}                                 another number, such as `C bed`, `G bed hall`, `P 0`, `e 0`, `decay 0`, `set tank`, `flow tank`, `S gap bed`
    {heat: A, W: formula, law: constant, turning, speed, feed or load, at:, exponent:, axis:, decay:, while:}
    {heat_like: I, node: A, share: formula}                           a share of heat number I arises in another body, too
    {heat: A, W: formula, of: signal}                                 heat that follows a signal
    {fed: {A: formula, ...}}                                          heat that hangs on temperatures: T(body), hall, heat_of(i), thermostat(T, low, high), melting(T, at, G, J), signals
    {start: A, K: formula} or {start: A, degC: formula}               the body begins warmer by so much, or at this temperature
    {drive: speed, power, feeds or hall, is: formula of x, while:}    what truly drives, step by step
    {record: {speed: formula, hall: ..., feed_x: ...}}                the same by laws of whole rows; one size at a time
    {before: formula, speed: , feeds: , power: , pause_s: }           it ran so many minutes before its record begins
    {reads: CHANNEL or list, thermometers, displacements, all; is: formula of y}
"""
import copy

import numpy as np
from scipy.linalg import expm

import laws


class Record:
    """What a logger knows: times [s], speed [rpm], feeds [m/s] by axis, recorded power [W], hall [degC], further columns: name -> (unit, values)."""

    def __init__(self, name, time_s, speed, feeds, power, hall, columns):
        self.name, self.time_s, self.speed, self.feeds, self.power, self.hall, self.columns = name, time_s, speed, feeds, power, hall, columns


class Machine:
    """Bodies, links, circuits, heats, thermometers and displacements; `numbers` are the uncertain ones: label -> (value, kind).

    kind `log`: lognormal, 10 % one sigma; `exponent`: normal, 3 % one sigma. `stated`: label -> how much wider or narrower the scenario says that it is known.
    """

    def __init__(self, family):
        self.family, self.title, self.groups, self.bodies, self.links, self.circuits, self.heats = family, "", {}, [], [], [], []
        self.fans, self.recorded = [], []      # links while the spindle turns: (a, b); by columns that the model has, too: (node, column, opening or warmth)
        self.sensors, self.displacements, self.numbers, self.air, self.start, self.t_ref = [], [], {}, set(), "hall", 20.0
        self.longest_step_s, self.stated = 20.0, {}      # of steps, where heat hangs on temperatures

    def body(self, name, capacity):
        self.bodies.append(name)
        self.numbers["C " + name] = (capacity, "log")

    def link(self, a, b, conductance):
        self.links.append((a, b))
        self.numbers[f"G {a} {b}"] = (conductance, "log")

    def fan(self, a, b, conductance):
        self.fans.append((a, b))
        self.numbers[f"fan {a} {b}"] = (conductance, "log")

    def by_column(self, node, column, how, value):
        self.recorded.append((node, column, how))
        self.numbers[f"{how} {node}"] = (value, "log")

    def circuit(self, node, flow_L_min, passage, set_point):
        self.circuits.append((node, set_point))
        self.numbers["flow " + node] = (flow_L_min, "log")
        self.numbers["passage " + node] = (passage, "log")

    def heat(self, kind, node, power, at=1.0, exponent=0.0, idle=0.0, decay=0.0, axis=None, turning=False, column=None):
        i = len(self.heats)
        self.heats.append(heat_law(kind, node, at, axis, turning, exponent != 0.0, idle > 0, decay > 0, column=column))
        for label, value, kind in (("P", power, "log"), ("e", exponent, "exponent"), ("idle", idle, "log"), ("decay", decay, "log")):
            if value != 0.0:
                self.numbers[f"{label} {i}"] = (value, kind)

    def displacement(self, name, axis, sensitivities):
        self.displacements.append((name, axis, list(sensitivities)))
        for node, s in sensitivities.items():
            self.numbers[f"S {name} {node}"] = (s, "log")

    def keep_displacements(self, kept):
        gone = {d[0] for d in self.displacements} - {d[0] for d in kept}
        self.displacements = list(kept)
        self.numbers = {k: x for k, x in self.numbers.items() if not (k.startswith("S ") and k.split()[1] in gone)}

    def nominal(self, n_variants=1):
        return {k: np.full(n_variants, v[0], float) for k, v in self.numbers.items()}

    def sigma_steps(self, step):
        """One variant for each uncertain number, moved by `step` of its prior sigma; the first variant is nominal."""
        p = self.nominal(len(self.numbers) + 1)
        for i, (k, (v, kind)) in enumerate(self.numbers.items()):
            p[k][i + 1] = moved(v, kind, step, self.stated.get(k, 1.0))
        return p


def heat_law(kind, node, at=1.0, axis=None, turning=False, exponent=False, idle=False, decay=False, gate=None, column=None):
    return dict(kind=kind, node=node, at=at, axis=axis, turning=turning, has_exponent=exponent, has_idle=idle, has_decay=decay, gate=gate, column=column)


def moved(value, kind, z, sigma_factor=1.0):
    return value * np.exp(0.1 * sigma_factor * z) if kind == "log" else value * (1 + 0.03 * sigma_factor * z)


class Fault:
    """What is hidden: terms and one size. `names`: what the formulas know; `windows`: of a record's name; `signals`: record -> name -> values at its rows; `told`: how truth.json describes it (faults.py)."""

    def __init__(self, way, terms, names=None, records=None, low=0.0, high=1.0, sign=1.0, windows=None, signals=None, told=None):
        self.way, self.terms, self.names, self.records, self.low, self.high, self.sign = way, terms, names or {}, records, low, high, sign
        self.windows, self.signals, self.told, self.size = windows or {}, signals or {}, told or {}, np.zeros(1)
        self.each_size = any("record" in t or "before" in t or ("while" in t and ("link" in t or "bath" in t) and laws.mentions(t["while"], "s")) for t in terms)

        self.moves_stops = any("drive" in t and laws.mentions(t.get("while"), "s") for t in terms)

    def holds(self, record_name):
        return self.records is None or record_name in self.records

    def with_size(self, sizes):
        f = copy.copy(self)
        f.size = f.sign * np.atleast_1d(np.asarray(sizes, float))
        return f

    def of(self, formula, **more):
        """The value of a formula; numbers and names of signals are formulas, too."""
        return laws.value(formula, {**self.names, "s": self.size, **more})


def first_order(time_s, u, lag_s, y0):
    """lag dy/dt = u - y over rows between which u (variant x row) is linear; lag (variant)."""
    y = np.empty_like(u)
    y[:, 0] = y0
    lag = np.maximum(lag_s, 1e-6)
    for k in range(1, u.shape[1]):
        h = time_s[k] - time_s[k - 1]
        e = np.exp(-h / lag)
        slope = (u[:, k] - u[:, k - 1]) / h
        y[:, k] = u[:, k] - slope * lag + (y[:, k - 1] - u[:, k - 1] + slope * lag) * e
    return y


def simulate(machine, numbers, record, faults=(), offset_K=0.0):
    """Readings without noise of one record: temperatures (variant x row x sensor), displacements (variant x row x channel).

    Each fault has `size` (one value for each variant); those that do not hold in this record are passed over.
    """
    faults = [f for f in faults if f.holds(record.name)]
    n = len(next(iter(numbers.values())))
    offset = np.broadcast_to(np.reshape(np.asarray(offset_K, float), -1), (n,))
    own = [f for f in faults if f.each_size or (machine.fans and f.moves_stops)]
    sizes = np.stack([np.broadcast_to(f.size, (n,)) for f in own], 1) if own else np.zeros((n, 0))
    different = np.unique(sizes, axis=0)
    if len(different) == 1 or not own:
        return Truth(machine, numbers, record, faults, offset).readings()
    out = [np.empty((n, len(record.time_s), len(x))) for x in (machine.sensors, machine.displacements)]
    for row in different:
        m, some = np.all(sizes == row, axis=1), [copy.copy(f) for f in faults]
        for f in some:
            f.size = np.broadcast_to(f.size, (n,))[m]
        for a, b in zip(out, simulate(machine, {k: x[m] for k, x in numbers.items()}, record, some, offset[m])):
            a[m] = b
    return tuple(out)


class Truth:
    """One record of one machine with its faults, in variants."""

    def __init__(self, machine, numbers, record, faults, offset_K):
        self.n, self.faults, self.known, self.offset = len(next(iter(numbers.values()))), faults, record, offset_K
        self.machine, self.numbers = copy.copy(machine), dict(numbers)
        for name in ("bodies", "links", "circuits", "heats"):
            setattr(self.machine, name, list(getattr(machine, name)))
        self.signals = {id(f): dict(f.signals.get(record.name, {})) for f in faults}
        self.record, self.first_row = record, 0
        for f, t in self.terms("before"):
            self.prefix(f, t)
        for f, t in self.terms("record"):
            r = self.record
            names = dict(r=r, t=r.time_s, speed=r.speed, power=r.power, feeds=r.feeds, hall=r.hall, **self.signals[id(f)])
            new = {k: self.value(f, x, **names) for k, x in t["record"].items()}
            self.record = Record(r.name, r.time_s, new.get("speed", r.speed), {**r.feeds, **new.get("feeds", {})}, new.get("power", r.power), new.get("hall", r.hall), r.columns)
        self.restructure()
        self.index = {b: i for i, b in enumerate(self.machine.bodies)}
        self.steps()
        self.drive()

    def terms(self, *kinds):
        return [(f, t) for f in self.faults for t in f.terms if any(k in t for k in kinds)]

    def value(self, f, formula, **more):
        """A formula's value; sizes are one number where sizes are simulated one by one."""
        s = f.size[0] if f.each_size and "r" in more else f.size
        return laws.value(formula, {**f.names, "n": self.numbers.__getitem__, "record": self.known.name, "s": s, **more})

    def per_variant(self, f, formula, **more):
        return np.broadcast_to(np.asarray(self.value(f, formula, **more), float), (self.n,))

    def prefix(self, f, t):
        """Two rows before the record: it ran, and after a pause somebody began to write."""
        r, s = self.record, float(f.size[0])
        ran_s = round(60 * float(f.of(t["before"], s=s)), 3)
        first = lambda x, on: np.concatenate([[on, 0 * on], x])
        feed = {a: float(f.of(t.get("feeds", 0), axis=a)) for a in r.feeds}
        self.record = Record(r.name, np.concatenate([[0.0, ran_s], r.time_s + ran_s + f.of(t["pause_s"])]), first(r.speed, float(f.of(t["speed"]))), {a: first(x, feed[a]) for a, x in r.feeds.items()},
                             first(r.power, float(f.of(t.get("power", 0)))), np.append([r.hall[0]] * 2, r.hall),
                             {c: (unit, np.append([x[0]] * 2, x)) for c, (unit, x) in r.columns.items()})
        self.first_row = 2
        for signals in self.signals.values():
            for k, x in signals.items():
                signals[k] = np.append([x[0]] * 2, x)

    def restructure(self):
        m, numbers = self.machine, self.numbers
        for f, t in self.terms("body", "link", "relink", "number", "heat", "heat_like"):
            if "body" in t:
                m.bodies.append(t["body"])
                numbers["C " + t["body"]] = np.maximum(self.per_variant(f, t["C"]), 1e-3)
            elif "link" in t and "while" not in t and "open" not in t:
                a, b = t["link"]
                label = f"G {a} {b}"
                g = self.per_variant(f, t["G"])
                if label in numbers:      # a second path of the same two
                    numbers[label] = numbers[label] + g
                else:
                    m.links.append((a, b))
                    numbers[label] = g
            elif "relink" in t:
                (a, b), c = t["relink"], t["to"]
                m.links[m.links.index((a, b))] = (a, c)
                numbers[f"G {a} {c}"] = numbers[f"G {a} {b}"]
            elif "heat_like" in t:
                i, new, share = t["heat_like"], len(m.heats), self.per_variant(f, t["share"])
                m.heats.append(dict(m.heats[i], node=t["node"]))
                numbers.update({f"{k} {new}": numbers[f"{k} {i}"] * (share if k in ("P", "idle") else 1.0) for k in ("P", "idle", "e", "decay") if f"{k} {i}" in numbers})
            elif "number" in t:
                if t.get("if_number") and t["number"] not in numbers:
                    continue
                old = numbers.get(t["number"])
                if old is None and t["number"].startswith("set "):
                    old = dict(m.circuits)[t["number"][4:]]
                numbers[t["number"]] = self.per_variant(f, t["is"], x=0.0 if old is None else old)
            elif "heat" in t and "of" not in t:
                i, kind = len(m.heats), dict(constant="heat_source", turning="heat_source", speed="heat_source", feed="servo_loss", load="cutting_heat")[t["law"]]
                power = t["law"] in ("speed", "feed")
                m.heats.append(heat_law(kind, t["heat"], float(f.of(t.get("at", 1.0))), t.get("axis"), t["law"] == "turning", power, decay="decay" in t, gate=(f, t["while"]) if "while" in t else None))
                numbers[f"P {i}"] = self.per_variant(f, t["W"])
                if power:
                    numbers[f"e {i}"] = self.per_variant(f, t.get("exponent", 1.0))
                if "decay" in t:
                    numbers[f"decay {i}"] = self.per_variant(f, t["decay"])

    # --- steps and what drives -----------------------------------------------------------------------------------------------
    def windows(self, f, formula):
        """[(begin, end)], each a number or one for each variant."""
        return self.value(f, formula, windows=f.windows.get(self.record.name, f.windows.get("*", [])), t_end=self.record.time_s[-1])

    def gate(self, f, formula):
        """1 in the windows, by step."""
        on = np.zeros((self.n, len(self.h)), bool)
        for a, b in self.windows(f, formula):
            a, b = (np.reshape(np.asarray(x, float), (-1, 1)) for x in (a, b))
            on |= (self.t[:-1] + 1e-6 >= a) & (self.t[:-1] + 1e-6 < b)
        return on

    def steps(self):
        rows = self.record.time_s
        events = [x for f, t in self.terms("while") for w in self.windows(f, t["while"]) for x in w]
        t = np.unique(np.round(np.concatenate([rows] + [np.clip(np.atleast_1d(e).ravel(), 0, rows[-1]) for e in events]), 6))
        self.fed = self.terms("fed")
        if self.fed or any(f"decay {i}" in self.numbers for i in range(len(self.machine.heats))):
            longest = self.machine.longest_step_s
            t = np.unique(np.concatenate([np.linspace(a, b, int(np.ceil((b - a) / longest)) + 1)[:-1] for a, b in zip(t[:-1], t[1:])] + [t[-1:]]))
        self.t, self.h = t, np.diff(t)
        self.row = np.clip(np.searchsorted(rows, t[:-1] + 1e-7, side="right") - 1, 0, len(rows) - 1)
        self.at_rows = np.searchsorted(t, rows - 1e-6)

    def drive(self):
        r, full = self.record, (self.n, len(self.h))
        self.speed, self.power = (np.broadcast_to(x[self.row], full) for x in (r.speed, r.power))
        self.feeds = {a: np.broadcast_to(x[self.row], full) for a, x in r.feeds.items()}
        self.hall0, self.hall1 = (np.interp(t, r.time_s, r.hall) + self.offset[:, None] for t in (self.t[:-1], self.t[1:]))
        for f, t in self.terms("drive"):
            on, s = self.gate(f, t["while"]) if "while" in t else True, f.size[:, None]
            new = lambda x, time: np.where(on, self.value(f, t["is"], x=x, s=s, t=time), x)
            if t["drive"] == "hall":
                self.hall0, self.hall1 = new(self.hall0, self.t[:-1]), new(self.hall1, self.t[1:])
            elif t["drive"] == "feeds":
                self.feeds = {a: new(x, self.t[:-1]) for a, x in self.feeds.items()}
            else:
                setattr(self, t["drive"], new(getattr(self, t["drive"]), self.t[:-1]))

    def signal(self, f, name):
        """A signal's values by row; a formula without one is constant."""
        known = self.signals[id(f)]
        if isinstance(name, str) and name in known:
            return known[name]
        if isinstance(name, str) and name in self.record.columns:
            return self.record.columns[name][1]
        return np.full(len(self.record.time_s), float(self.value(f, name, **known)))

    def column(self, name):
        """A recorded column by step."""
        return self.record.columns[name][1][self.row]

    # --- heats and links -----------------------------------------------------------------------------------------------------
    def heat_of(self, i):
        """Heat `i` by step at the reference temperature, and what of it there is at rest."""
        law, n = self.machine.heats[i], self.numbers
        p, e, idle = n[f"P {i}"][:, None], n.get(f"e {i}", np.zeros(self.n))[:, None], n.get(f"idle {i}", np.zeros(self.n))[:, None]
        turning, still = self.speed > 0, np.zeros(self.n)
        if law["kind"] == "cutting_heat":
            q = p * self.power
        elif law["kind"] == "recorded_drive":
            q = p * self.column(law["column"])
        elif law["kind"] == "servo_loss":
            q, still = idle + p * (self.feeds[law["axis"]] / law["at"]) ** e, idle[:, 0]
        elif law["kind"] == "heat_source" and not law["has_exponent"]:
            q, still = p * np.where(turning | (not law["turning"]), 1.0, 0.0), p[:, 0] * (not law["turning"])
        else:
            q = np.where(turning, idle + p * (np.where(turning, self.speed, law["at"]) / law["at"]) ** e, 0.0)
        if law["gate"]:
            q, still = q * self.gate(*law["gate"]), 0 * still
        return q, still

    def heats(self):
        self.heat, self.still, self.decaying = np.zeros((self.n, len(self.h), len(self.index))), np.zeros((self.n, len(self.index))), []
        for i, law in enumerate(self.machine.heats):
            (q, still), k = self.heat_of(i), self.index[law["node"]]
            self.still[:, k] += still
            if f"decay {i}" in self.numbers:
                self.decaying.append((k, q, self.numbers[f"decay {i}"]))
            else:
                self.heat[:, :, k] += q
        for f, t in self.terms("heat"):
            if "of" in t:
                self.heat[:, :, self.index[t["heat"]]] += self.per_variant(f, t["W"])[:, None] * self.signal(f, t["of"])[self.row]

    def levels(self, f, t):
        """Values of an opening or a gate, the one that holds at standstill first; and which of them holds, by step."""
        if "while" in t:
            return np.array([0.0, 1.0]), self.gate(f, t["while"])[0].astype(int)
        values, level = np.unique(np.append(0.0, self.signal(f, t.get("open", t.get("of")))[self.row]), return_inverse=True)
        return values, level[1:]

    def paths(self):
        """(a, b, conductances by level and variant, level by step) of all links; constant watts beside them: (a, watts by level and variant, ...)."""
        links = {(a, b): (self.numbers[f"G {a} {b}"][None], np.zeros(len(self.h), int)) for a, b in self.machine.links}
        for f, t in ((f, t) for f, t in self.terms("law") if "G" in t):
            pair = tuple(t["law"])
            values, level = self.levels(f, t)
            links[pair] = np.stack([self.per_variant(f, t["G"], g=links[pair][0][0], x=x) for x in values]), level
        out = [(a, b, g, level) for (a, b), (g, level) in links.items()]
        out += [(a, b, np.array([[0.0], [1.0]]) * self.numbers[f"fan {a} {b}"], (self.speed[0] > 0).astype(int)) for a, b in self.machine.fans]
        for node, column, how in self.machine.recorded:
            g, x = self.numbers[f"{how} {node}"], self.column(column)
            values, level = np.unique(np.append(0.0, x if how == "opening" else x > -300), return_inverse=True)      # the first one at standstill: nothing
            out.append((node, "hall" if how == "opening" else "nothing", values[:, None] * g, level[1:]))
            if how == "warmth":
                self.heat[:, :, self.index[node]] += g[:, None] * x
        for f, t in self.terms("link"):
            if "while" in t or "open" in t:
                values, level = self.levels(f, t)
                out.append((*t["link"], values[:, None] * self.per_variant(f, t["G"]), level))
        for f, t in self.terms("bath"):
            values, level = self.levels(f, t) if "while" in t or "open" in t else (np.ones(1), np.zeros(len(self.h), int))
            g, i, warm = values[:, None] * self.per_variant(f, t["G"]), self.index[t["bath"]], self.signal(f, t["degC"])
            out.append((t["bath"], "nothing", g, level))
            self.heat[:, :, i] += g[level].T * warm[self.row]
            self.still[:, i] += g[0] * warm[0]
        return out

    def circuits(self):
        out = []
        for node, set_point in self.machine.circuits:
            out.append((node, laws.passes(self.numbers.__getitem__, node), self.numbers.get("set " + node, set_point)))
        return out

    def matrices(self, state, links, circuits, c):
        n = len(self.index)
        a_matrix, to_hall, constant = np.zeros((self.n, n, n)), np.zeros((self.n, n)), np.zeros((self.n, n))
        for a, b, g, _ in links:
            state, one = divmod(state, len(g))
            g, i = g[one], self.index[a]
            a_matrix[:, i, i] -= g
            if b == "hall":
                to_hall[:, i] += g
            elif b != "nothing":
                j = self.index[b]
                a_matrix[:, i, j] += g
                a_matrix[:, j, i] += g
                a_matrix[:, j, j] -= g
        for node, g, set_point in circuits:
            a_matrix[:, self.index[node], self.index[node]] -= g
            constant[:, self.index[node]] += g * set_point
        return a_matrix / c[:, :, None], to_hall / c, constant / c

    def begin(self, matrix, c):
        T = np.repeat(self.hall0[:, :1], len(self.index), 1)
        if not isinstance(self.machine.start, str):
            T = np.full((self.n, len(self.index)), float(self.machine.start))
        elif self.machine.start == "steady":
            a_matrix, to_hall, constant = matrix
            T = np.linalg.solve(a_matrix, -(self.still / c + to_hall * self.hall0[:, :1] + constant)[:, :, None])[:, :, 0]
        for f, t in self.terms("start"):
            i = self.index[t["start"]]
            T[:, i] = self.per_variant(f, t["degC"]) if "degC" in t else T[:, i] + self.per_variant(f, t["K"])
        return T

    def feedback(self):
        """(T, step) -> [(body, watts)] of heats that hang on temperatures."""
        heats = {}

        def heat_of(i, T, k):
            if i not in heats:
                heats[i] = self.heat_of(i)[0]
            return heats[i][:, k] * np.exp(-self.numbers.get(f"decay {i}", 0.0) * (T[:, self.index[self.machine.heats[i]["node"]]] - self.machine.t_ref))
        states, state = {}, lambda f: states.setdefault(id(f), {})

        def watts(T, k):
            out = []
            for f, t in self.fed:
                names = {**{name: x[self.row[k]] for name, x in self.signals[id(f)].items()}, "T": lambda b: T[:, self.index[b]], "hall": self.hall0[:, k], "heat_of": lambda i: heat_of(i, T, k),
                         "thermostat": lambda x, low, high: laws.thermostat(state(f), x, k, low, high),
                         "melting": lambda x, at, g, most: laws.melting(state(f), x, k, self.h, at, g, most)}
                out += [(self.index[b], self.value(f, x, **names)) for b, x in t["fed"].items()]
            return out
        return watts

    def temperatures(self):
        """Of all bodies at the ends of all steps."""
        c = np.stack([self.numbers["C " + b] for b in self.machine.bodies], 1)
        self.heats()
        links, circuits = self.paths(), self.circuits()
        radix = np.cumprod([1] + [len(g) for _, _, g, _ in links])
        state = sum((level * int(x) for x, (*_, level) in zip(radix, links)), np.zeros(len(self.h), int))
        cache, transitions, n = {0: self.matrices(0, links, circuits, c)}, {}, len(self.index)
        code, hr = np.empty(len(self.h), int), np.round(self.h, 6)
        for k, key in enumerate(zip(state, hr)):
            if key not in transitions:
                if key[0] not in cache:
                    cache[key[0]] = self.matrices(key[0], links, circuits, c)
                big = np.zeros((self.n, 3 * n, 3 * n))
                big[:, :n, :n] = cache[key[0]][0] * key[1]
                big[:, :n, n:2 * n] = big[:, n:2 * n, 2 * n:] = np.eye(n) * key[1]
                e = expm(big)
                transitions[key] = (len(transitions), e[:, :n, :n], e[:, :n, n:2 * n], e[:, :n, 2 * n:], *cache[key[0]][1:])
            code[k] = transitions[key][0]
        table = sorted(transitions.values(), key=lambda x: x[0])
        base, ramp = self.heat / c[:, None, :], np.zeros_like(self.heat)
        for i, tr in enumerate(table):
            m = code == i
            base[:, m] += tr[4][:, None, :] * self.hall0[:, m, None] + tr[5][:, None, :]
            ramp[:, m] = tr[4][:, None, :] * ((self.hall1 - self.hall0)[:, m] / self.h[m])[:, :, None]
        T = self.begin(cache[0], c)
        return self.alone(T, table, code, base, ramp) if not self.decaying and not self.fed else self.fed_back(T, table, code, base, ramp, c)

    def alone(self, T, table, code, base, ramp):
        out = np.empty((self.n, len(self.h) + 1, len(self.index)))
        out[:, 0] = T
        for i, tr in enumerate(table):
            m = code == i
            base[:, m] = np.matmul(base[:, m], tr[2].transpose(0, 2, 1)) + np.matmul(ramp[:, m], tr[3].transpose(0, 2, 1))
        for k in range(len(self.h)):
            T = np.matmul(table[code[k]][1], T[:, :, None])[:, :, 0] + base[:, k]
            out[:, k + 1] = T
        return out

    def fed_back(self, T, table, code, base, ramp, c):
        """Heat that hangs on temperatures is linear over each step, from its value at the beginning to that at a first guess of the end."""
        out, watts = np.empty((self.n, len(self.h) + 1, len(self.index))), self.feedback()
        out[:, 0] = T

        def hanging(T, k):
            decaying = [(i, q[:, k] * np.exp(-decay * (T[:, i] - self.machine.t_ref))) for i, q, decay in self.decaying]
            return decaying + watts(T, k)
        for k in range(len(self.h)):
            _, E, F1, F2, _, _ = table[code[k]]
            b, r, before = base[:, k].copy(), ramp[:, k].copy(), hanging(T, k)
            for i, w in before:
                b[:, i] += w / c[:, i]
            known = np.matmul(E, T[:, :, None]) + np.matmul(F1, b[:, :, None])
            first = (known + np.matmul(F2, r[:, :, None]))[:, :, 0]
            for (i, old), (_, new) in zip(before, hanging(first, k)):
                r[:, i] += (new - old) / c[:, i] / self.h[k]
            T = (known + np.matmul(F2, r[:, :, None]))[:, :, 0]
            out[:, k + 1] = T
        return out

    # --- instruments ---------------------------------------------------------------------------------------------------------
    def readings(self):
        rows, m = self.record.time_s, self.machine
        T = self.temperatures()[:, self.at_rows]
        hall = np.concatenate([self.hall0, self.hall1[:, -1:]], 1)[:, self.at_rows]
        of = lambda node: hall if node == "hall" else T[:, :, self.index[node]]
        speed = self.speed[:, np.searchsorted(self.t[:-1], rows[:-1] - 1e-6)]
        read = {name: of(node).copy() for name, node in m.sensors}
        for name, _, nodes in m.displacements:
            read[name] = sum((self.numbers[f"S {name} {node}"][:, None] * (of(node) - m.t_ref) for node in nodes), np.zeros_like(hall))
        groups = dict(thermometers=[n for n, _ in m.sensors], displacements=[d[0] for d in m.displacements])
        groups["all"] = groups["thermometers"] + groups["displacements"]
        for f, t in self.terms("reads"):
            channels = groups[t["reads"]] if isinstance(t["reads"], str) and t["reads"] in groups else t["reads"] if isinstance(t["reads"], list) else [t["reads"]]
            before, s = {k: x.copy() for k, x in read.items()}, np.broadcast_to(f.size, (self.n,))[:, None]
            lag = lambda x, tau: first_order(rows, np.array(np.broadcast_to(x, hall.shape)), np.broadcast_to(np.reshape(tau, -1), (self.n,)), np.broadcast_to(x, hall.shape)[:, 0])
            names = dict(s=s, t=rows, hall=hall, of=of, speed=np.append(speed, speed[:, -1:], 1), lag=lag, read=before.__getitem__, col=lambda name: self.record.columns[name][1][None], t_ref=m.t_ref, **{k: x[None] for k, x in self.signals[id(f)].items()})
            for c in channels:
                read[c] = np.array(np.broadcast_to(laws.value(t["is"], {**f.names, "n": lambda k: self.numbers[k][:, None], "y": read[c], "channel": c, **names}), hall.shape))
        stack = lambda which: np.stack([read[c] for c in which], 2)[:, self.first_row:] if which else np.empty((self.n, len(rows) - self.first_row, 0))
        return stack(groups["thermometers"]), stack(groups["displacements"])
