"""Hidden faults: how they are drawn, where they act, and how truth.json describes them. Their sizes are set afterwards, by nats."""
import numpy as np

KINDS_A = ["hidden_body", "link", "exchange_window", "heat_window", "heat_source", "recorded_drive", "displacement_path", "run_state", "sensor_place"]
KINDS_C = ["heat_source", "convection", "contact", "ambient", "sensor_bias", "sensor_lag", "sensor_drift", "sensor_detached", "mount_shift", "clock_offset",
           "speed_override", "missing_stop", "friction_law", "expansion"]


class Impossible(Exception):
    """This machine or these records cannot have such a fault; another one is drawn."""


class Fault:
    def __init__(self, key, data=None, records=None, low=0.0, high=1.0, sign=1.0, windows=None, all_windows=None):
        self.key, self.data, self.records, self.low, self.high, self.sign = key, data or {}, records, low, high, sign
        self.own_windows, self.every = windows, all_windows
        self.size = np.zeros(1)

    def holds(self, record_name):
        return self.records is None or record_name in self.records

    def windows(self, record):
        if self.every is None:
            return self.own_windows
        period, first, length = self.every
        return [(a, a + length) for a in np.arange(first, record.time_s[-1], period)]

    def events(self, record):
        """Times [s] at which it begins or ends."""
        out = []
        if self.own_windows is not None or self.every is not None:
            out += [x for w in self.windows(record) for x in w]
        if self.data.get("from_s", 0) > 0:
            out.append(self.data["from_s"])
        if self.key == "missing_stop":
            out += [self.data["start_s"]] + [self.data["start_s"] + 60 * s for s in self.size]
        return out

    def with_size(self, sizes):
        f = Fault(self.key, self.data, self.records, self.low, self.high, self.sign, self.own_windows, self.every)
        f.size = self.sign * np.atleast_1d(np.asarray(sizes, float))
        return f


def pick(rng, things):
    things = list(things)
    if not things:
        raise Impossible
    return things[int(rng.integers(len(things)))]


def largest_heat(machine, plan):
    v = machine.numbers
    return max(v[f"P {i}"][0] * (plan["power"] if h["kind"] == "cutting_heat" else 1) for i, h in enumerate(machine.heats))


def typical_link(machine):
    return float(np.median([machine.numbers[f"G {a} {b}"][0] for a, b in machine.links]))


def scope(rng, records, kinds):
    """`all`: every record, the held-out one too; `one`; `from`: from one record on."""
    names = [r.name for r in records if r.name != "holdout_1"]
    kind = pick(rng, kinds) if len(names) > 1 else ("all" if "all" in kinds else "one")
    if kind == "all":
        return None
    if kind == "one":
        return [pick(rng, names)]
    return names[int(rng.integers(1, len(names))):] + ["holdout_1"]


def draw(rng, key, machine, plan, records, column, older):
    """One fault of this key; `older`: as class C has it."""
    names = [r.name for r in records if r.name != "holdout_1"]
    interval = records[0].time_s[1] - records[0].time_s[0]
    shortest = min(r.time_s[-1] for r in records)
    sign = 1.0 if rng.random() < 0.5 else -1.0
    sensors = [n for n, _ in machine.sensors]
    channels = [d[0] for d in machine.displacements]
    pairs = {frozenset(x) for x in machine.links}
    watts, g = largest_heat(machine, plan), typical_link(machine)
    speeds = [i for i, h in enumerate(machine.heats) if h["has_exponent"] and h["kind"] not in ("servo_loss", "cutting_heat")]

    def windows(n, lo=0.05, hi=0.18):
        out, t = [], rng.uniform(0.08, 0.3) * shortest
        for _ in range(n):
            length = rng.uniform(lo, hi) * shortest / n
            out.append((float(round(t)), float(round(t + length))))
            t += length + rng.uniform(0.1, 0.5) * shortest / n
        if out[-1][1] > 0.95 * shortest:
            raise Impossible
        return out

    def some_windows():
        if rng.random() < 0.4:
            period = round(rng.uniform(0.12, 0.3) * shortest)
            length = round(period * rng.uniform(0.1, 0.4))
            return dict(all_windows=(float(period), float(round(period * rng.uniform(0.2, 0.6))), float(length)))
        return dict(windows=windows(int(rng.integers(1, 4))), records=[pick(rng, names)])

    if key == "hidden_body":
        body = pick(rng, machine.bodies)
        capacity = machine.numbers["C " + body][0] * np.exp(rng.uniform(np.log(0.2), np.log(2)))
        minutes = np.exp(rng.uniform(np.log(4), np.log(90))) * (12 if plan.get("outdoor") else 1)
        conductance = capacity / (60 * minutes)
        return Fault(key, dict(node=body, capacity=capacity, conductance=conductance, to_hall=conductance * rng.uniform(0.05, 0.3) if rng.random() < 0.4 else 0.0), low=0.02, high=6)
    if key == "link":
        a = pick(rng, machine.bodies)
        b = pick(rng, [x for x in machine.bodies + ["hall"] if x != a and frozenset((a, x)) not in pairs])
        return Fault(key, dict(a=a, b=b), low=0.01 * g, high=4 * g)
    if key == "exchange_window":
        a = pick(rng, machine.bodies)
        b = "hall" if rng.random() < 0.7 else pick(rng, [x for x in machine.bodies if x != a])
        return Fault(key, dict(a=a, b=b), low=0.01 * g, high=15 * g, **some_windows())
    if key == "heat_window":
        if speeds and rng.random() < 0.35:
            w = windows(int(rng.integers(1, 3)), 0.1, 0.35)
            return Fault(key, dict(what="speed"), low=0.1, high=1.1, sign=sign, windows=w, records=[pick(rng, names)])
        return Fault(key, dict(what="heat", node=pick(rng, machine.bodies)), low=0.01 * watts, high=4 * watts, sign=1.0 if rng.random() < 0.85 else -1.0, **some_windows())
    if key == "heat_source":
        law = pick(rng, ["constant"] + (["turning", "power", "power"] if speeds else []))
        data = dict(node=pick(rng, machine.bodies), law=law, from_s=0.0)
        if law == "power":
            data.update(at=float(plan["top"]), exponent=float(round(rng.uniform(0.8, 2.2), 2)))
        if older:
            where = scope(rng, records, ["all", "all", "one", "from"])
        else:
            where = [pick(rng, names)]
            data["from_s"] = float(round(rng.uniform(0.15, 0.65) * shortest))
        return Fault(key, data, where, 0.01 * watts, 4 * watts, 1.0 if rng.random() < 0.85 else -1.0)
    if key == "recorded_drive":
        recorded = [i for i, h in enumerate(machine.heats) if h["kind"] == "cutting_heat"]
        if column:
            top = max(np.max(r.columns[column[0]][1]) for r in records)
            return Fault(key, dict(node=pick(rng, machine.bodies), column=column[0], unit=column[1]), low=0.01 * watts / top, high=4 * watts / top)
        i = pick(rng, recorded)
        share = machine.numbers[f"P {i}"][0]
        up = np.log(0.97 / share) > 0.4 and sign > 0
        return Fault(key, dict(heat=i, node=machine.heats[i]["node"]), low=0.1, high=min(1.3, np.log(0.97 / share)) if up else 1.3, sign=1.0 if up else -1.0)
    if key == "displacement_path":
        channel = pick(rng, channels)
        if speeds and rng.random() < 0.65:
            return Fault("spindle_growth", dict(channel=channel, at=float(plan["top"]), exponent=float(pick(rng, [1, 1, 1.5, 2])), lag_min=float(round(np.exp(rng.uniform(np.log(2), np.log(40))), 1))),
                         low=0.2, high=80, sign=sign)
        used = next(d[2] for d in machine.displacements if d[0] == channel)
        node = "hall" if rng.random() < 0.25 else pick(rng, [b for b in machine.bodies if b not in used])
        return Fault(key, dict(channel=channel, node=node, lag_min=float(round(np.exp(rng.uniform(np.log(3), np.log(60))), 1)) if rng.random() < 0.5 else 0.0), low=0.03, high=20, sign=sign)
    if key == "run_state":
        if len(names) < 3:
            raise Impossible
        k = int(rng.integers(1, len(names) - 1 if len(names) > 3 else 2)) if len(names) > 2 else 1
        chosen = sorted(rng.choice(names, k, replace=False).tolist())
        what = "heat" if rng.random() < 0.5 else "exchange"
        return Fault(key, dict(what=what), chosen, 0.08, 1.6, sign)
    if key == "sensor_place":
        sensor, body = pick(rng, machine.sensors)
        near = [b if a == body else a for a, b in machine.links if body in (a, b) and "hall" not in (a, b)]
        return Fault(key, dict(sensor=sensor, other=pick(rng, near)), low=0.03, high=0.95)
    if key in ("convection", "contact"):
        link = pick(rng, [x for x in machine.links if (x[1] == "hall") == (key == "convection")])
        return Fault(key, dict(link=link), scope(rng, records, ["all", "one", "from"]), 0.2, 1.9, sign)
    if key == "ambient":
        step = rng.random() < 0.5
        return Fault(key, dict(from_s=float(round(rng.uniform(0.15, 0.7) * shortest)) if step else 0.0), [pick(rng, names)] if step else scope(rng, records, ["all", "one"]), 0.3, 9, sign)
    if key == "sensor_detached":
        return Fault(key, dict(sensor=pick(rng, sensors), from_s=float(round(rng.uniform(0.15, 0.75) * shortest))), [pick(rng, names)], 0.05, 0.95)
    if key.startswith("sensor_"):
        hours = shortest / 3600
        low, high = dict(sensor_bias=(0.03, 6), sensor_lag=(max(0.1, 0.3 * interval / 60), 25 * max(1, hours / 8)), sensor_drift=(0.05 / hours, 12 / hours))[key]
        return Fault(key, dict(sensor=pick(rng, sensors)), scope(rng, records, ["all", "one", "from"]), low, high, 1.0 if key == "sensor_lag" else sign)
    if key == "mount_shift":
        return Fault(key, dict(channel=pick(rng, channels), from_s=float(round(rng.uniform(0.1, 0.9) * shortest))), [pick(rng, names)], 0.1, 90, sign)
    if key == "clock_offset":
        return Fault(key, {}, scope(rng, records, ["all", "one", "from"]), max(0.05, 0.3 * interval / 60), 15 * max(1, shortest / 8 / 3600), sign)
    if key == "speed_override":
        if not speeds:
            raise Impossible
        return Fault(key, {}, scope(rng, records, ["all", "one", "from"]), 0.05, 0.8, sign)
    if key == "missing_stop":
        name = pick(rng, names)
        r = next(x for x in records if x.name == name)
        turning = np.flatnonzero((r.speed > 0) & (r.time_s > 0.08 * r.time_s[-1]) & (r.time_s < 0.85 * r.time_s[-1]))
        if not speeds or len(turning) == 0:
            raise Impossible
        return Fault(key, dict(start_s=float(r.time_s[pick(rng, turning)])), [name], max(0.5, interval / 60), 0.12 * r.time_s[-1] / 60)
    if key == "friction_law":
        i = pick(rng, speeds)
        e = machine.numbers[f"e {i}"][0]
        return Fault(key, dict(heat=i, node=machine.heats[i]["node"]), scope(rng, records, ["all", "all", "from"]), 0.05, 1.8 if sign > 0 else e + 0.6, sign)
    if key == "expansion":
        name, _, nodes = pick(rng, machine.displacements)
        node = pick(rng, nodes)
        sharers = [d[0] for d in machine.displacements if node in d[2]]
        return Fault(key, dict(node=node, displacement=None if len(sharers) > 1 and rng.random() < 0.5 else name), scope(rng, records, ["all", "all", "from"]), 0.2, 1.9, sign)
    raise ValueError(key)


def told(fault, machine, records, nats):
    """The entry of truth.json. `also`: other names that say the same of this fault (README)."""
    d, s, key = fault.data, float(fault.size[0]), fault.key
    factor = dict(name="factor", value=float(np.exp(s)), unit="1")
    minutes = lambda x: round(x / 60, 4)
    also, where = [], d.get("sensor") or d.get("channel") or d.get("node")
    p = []
    rows = None
    if fault.own_windows is not None:
        rows = [[minutes(a), minutes(b)] for a, b in fault.own_windows]
    elif fault.every is not None:
        rows = [[minutes(a), minutes(b)] for a, b in fault.windows(records[0])]
    single = rows is not None and len(rows) == 1
    if key == "hidden_body":
        p = [dict(name="capacity", value=s * d["capacity"], unit="J/K"), dict(name="conductance", value=s * d["conductance"], unit="W/K"), dict(name="to_hall", value=s * d["to_hall"], unit="W/K")]
        also = [("heat_capacity", where)]
    elif key in ("link", "exchange_window"):
        where = f"{d['a']},{d['b']}"
        p = [dict(name="conductance", value=s, unit="W/K")]
        if key == "link" or single:
            also = [("link", where), ("convection", d["a"])] if d["b"] == "hall" else [("link", where), ("contact", where)]
    elif key == "heat_window":
        if d["what"] == "speed":
            where, p = "spindle", [factor]
            also = [("speed_override", "spindle")] if single else []
        else:
            p = [dict(name="power", value=s, unit="W")]
            also = [("heat_source", where)] if single else []
    elif key == "heat_source":
        p = [dict(name="power", value=s, unit="W")]
        if d["law"] == "power":
            p += [dict(name="at_speed", value=d["at"], unit="rpm"), dict(name="exponent", value=d["exponent"], unit="1")]
        if d["from_s"] > 0:
            p.append(dict(name="from", value=minutes(d["from_s"]), unit="min"))
            also = [("heat_window", where)]
    elif key == "recorded_drive":
        p = [dict(name="gain", value=s, unit=f"W/({d['unit']})")] if "column" in d else [factor]
        also = [] if "column" in d else [("heat_source", where)]
    elif key == "displacement_path":
        p = [dict(name="sensitivity", value=s, unit="um/K"), dict(name="lag", value=d["lag_min"], unit="min")]
    elif key == "spindle_growth":
        p = [dict(name="growth", value=s, unit="um"), dict(name="at_speed", value=d["at"], unit="rpm"), dict(name="exponent", value=d["exponent"], unit="1"), dict(name="lag", value=d["lag_min"], unit="min")]
        also = [("displacement_path", where)]
    elif key == "run_state":
        where, p = ",".join(fault.records), [factor]
        if d["what"] == "heat" and len(machine.heats) == 1:
            also = [("heat_source", machine.heats[0]["node"])]
        to_hall = [a for a, b in machine.links if b == "hall"]
        if d["what"] == "exchange" and len(to_hall) == 1:
            also = [("convection", to_hall[0]), ("link", to_hall[0] + ",hall")]
    elif key in ("sensor_place", "sensor_detached"):
        p = [dict(name="share", value=s, unit="1")] + ([dict(name="time", value=minutes(d["from_s"]), unit="min")] if "from_s" in d else [])
    elif key == "convection":
        where, p, also = d["link"][0], [factor], [("link", d["link"][0] + ",hall")]
    elif key == "contact":
        where, p, also = ",".join(d["link"]), [factor], [("link", ",".join(d["link"]))]
    elif key == "ambient":
        where, p = "hall", [dict(name="offset", value=s, unit="K")] + ([dict(name="from", value=minutes(d["from_s"]), unit="min")] if d["from_s"] > 0 else [])
    elif key == "sensor_bias":
        p = [dict(name="bias", value=s, unit="K")]
    elif key == "sensor_lag":
        p = [dict(name="lag", value=s, unit="min")]
    elif key == "sensor_drift":
        p = [dict(name="drift", value=s, unit="K/h")]
    elif key == "mount_shift":
        p = [dict(name="shift", value=s, unit="um"), dict(name="time", value=minutes(d["from_s"]), unit="min")]
    elif key == "clock_offset":
        where, p = "clock", [dict(name="offset", value=s, unit="min")]
    elif key == "speed_override":
        where, p = "spindle", [factor]
        driven = [h["node"] for h in machine.heats if h["has_exponent"]]
        also = [("heat_source", driven[0])] if len(driven) == 1 else []
    elif key == "missing_stop":
        where, p = "spindle", [dict(name="start", value=minutes(d["start_s"]), unit="min"), dict(name="length", value=s, unit="min")]
        also = [("heat_window", "spindle")]
    elif key == "friction_law":
        p = [dict(name="exponent", value=machine.numbers[f"e {d['heat']}"][0] + s, unit="1"), dict(name="further_exponent", value=s, unit="1")]
    elif key == "expansion":
        p = [factor]
        where = where if d["displacement"] is None else f"{where},{d['displacement']}"
        also = [("displacement_path", d["displacement"])] if d["displacement"] else []
    out = dict(key=key, where=where, parameters=p, records=fault.records or "all", nats=round(float(nats), 2), also=[dict(effect=a, where=b) for a, b in also if a != key])
    if rows is not None:
        out["windows_min"] = rows
    for k in ("law", "what", "node", "other", "column", "displacement"):
        if d.get(k) is not None:
            out[k] = d[k]
    if fault.every is not None:
        out["every_min"] = minutes(fault.every[0])
    return out
