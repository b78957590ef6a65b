"""Gross faults of the set `coarse`: what is in the truth and not in the model, or in the records.

draw() gives a dict: key, where, also (catalogue's words and places of the scenario), sizes (least, most), unit, records, change(truth, record, size) -> readings. Or None,
where it cannot be on this machine. The user's file is the same with and without it.
"""
import numpy as np

from coarse_truth import Solver, readings

KINDS = ["coolant_missing", "fan", "heat_missing", "door", "swap", "fell_off", "missing_stop", "hidden_body", "recorded_column", "ambient_elsewhere", "speed_other", "circuit_off", "heat_window"]
# Kinds that ask for a spindle, or for a circuit.
ONLY = dict(fan="speed", missing_stop="speed", speed_other="speed", circuit_off="circuit")
HAVE = dict(speed=("spindle_column", "lathe", "dividing_head", "grinding_spindle", "bearing_rig"), circuit=("grinding_spindle", "linear_axis"))


class No(Exception):
    """This machine cannot have it."""


def can_be_on(kind, family):
    return kind not in ONLY or family in HAVE[ONLY[kind]]


def draw(rng, kind, t, m, records, column):
    try:
        return drawn(rng, kind, t, m, records, column)
    except No:
        return None


def drawn(rng, kind, t, m, records, column):
    """One branch a kind: a table."""
    names, measured = [r.name for r in records], [r for r in records if r.name.startswith("measured")]
    own = [b for b in m["names"] if any(s["body"] == b for s in t.sensors)]
    index = {b: [i for i, x in enumerate(t.body) if x == b] for b in m["names"]}
    heated, drive_heat = list(dict.fromkeys(h["body"] for h in t.heats)), sum(h["p"] for h in t.heats)
    pick = lambda x: x[int(rng.integers(len(x)))]
    air_names = lambda b: [("convection", b), ("forced_convection", b), ("link", f"{b},hall"), ("contact", b), ("exchange_window", b), ("coolant", b), ("radiation", b)]
    warmest = lambda: np.argsort([t.warm[s["node"]] for s in t.sensors])

    def fault(key, where, also, sizes, unit, alter=None, read=None, rec=None, until_end=False, **further):
        """alter(truth, record, size) before it is solved, read(readings, record, size) after that."""
        def change(truth, record, size):
            if alter:
                alter(truth, record, size)
            y = readings(truth, record, Solver(truth).run(record))
            if read:
                read(y, record, size)
            return y
        held = names if rec is None else names[names.index(rec.name):] if until_end else [rec.name]
        return dict(key=key, where=where, also=[x for x in also if x != (key, where)], sizes=sizes, unit=unit, change=change, records=held, told_records="all" if rec is None else held, **further)

    def window(rec, least, most, while_running=False):
        end, length = rec.t[-1] / 60, rng.uniform(least, most)
        for _ in range(60):
            begin = rng.uniform(0.15, 0.85) * end
            if begin + length > 0.97 * end:
                continue
            on = (rec.speed + rec.feed + rec.power)[(rec.t >= 60 * begin) & (rec.t < 60 * (begin + length))]
            if not while_running or (on > 0).mean() > 0.6:
                return float(round(begin, 1)), float(round(begin + length, 1))
        raise No

    def heat(law, b, by, when=None):
        return lambda truth, rec, size: truth.heats.append(dict(kind=law, nodes=index[b], body=b, p=size, e=1.0, decay=0.0, idle=0.0, by=by, window=when))

    if kind == "coolant_missing":
        b = pick([x for x in own if len(index[x]) > 2 and not any(c["body"] == x for c in t.circuits)] or own)
        set_point, s = float(round(rng.uniform(12, 17), 1)), [t.s[i] for i in index[b]]

        def alter(truth, rec, size):
            truth.circuit(truth.part_of[index[b][0]], min(s), max(s), 3.0, size, set_point)
            rec.start = np.append(rec.start, 0.0)
        return fault("coolant", b, air_names(b), (4.0, 160.0), "passage_W_K", alter, more=dict(set_point_degC=set_point))

    if kind == "fan":
        b = pick([x for x in own if sum(t.area[i] for i in index[x]) > 0.05] or own)

        def alter(truth, rec, size):
            for i in index[b]:
                truth.wind[i] += size
        return fault("forced_convection", b, air_names(b)[:-1], (8.0, 300.0), "film_W_m2K", alter)

    if kind == "heat_missing":
        b = pick(own)
        law = pick(["constant", "turning"]) if t.drive == "speed" else "constant"
        return fault("heat_source", b, [("friction_law", b)] * (law == "turning") + [("heat_window", b)], (0.1 * drive_heat, 2.5 * drive_heat), "W", heat(law, b, "speed" if law == "turning" else "one"), more=dict(law=law))

    if kind == "door":
        rec = pick(measured)
        w = window(rec, 40, 110)
        side = [str(x) for x in rng.permutation(m["names"])[:max(2, len(m["names"]) // 2)]]
        nodes, sign = [i for b in side for i in index[b]], -1.0 if rng.random() < 0.8 else 1.0

        def alter(truth, _, size):
            truth.more_film.append((nodes, 5.0, 60 * w[0], 60 * w[1]))
            truth.cold_air.append((nodes, sign * size, 60 * w[0], 60 * w[1]))
        b = max(side, key=lambda x: sum(t.area[i] for i in index[x]) / sum(t.cap[i] for i in index[x]))
        also = [(e, x) for x in side for e in ("exchange_window", "convection", "heat_window", "heat_source", "contact", "coolant")] + [("link", f"{x},hall") for x in side] + [("ambient", "hall"), ("stratification", "hall")]
        return fault("exchange_window", b, also, (4.0, 18.0), "air_K", alter, rec=rec, more=dict(film_factor=5.0, bodies=side), windows_min=[list(w)])

    if kind == "swap":
        if len(t.sensors) < 3:
            raise No
        order = warmest()
        i, j = int(order[-1 - int(rng.integers(2))]), int(order[int(rng.integers(2)) if len(order) > 3 else 0])
        a, b = t.sensors[i], t.sensors[j]
        if a["body"] == b["body"]:
            raise No

        def read(y, rec, size):
            y[0][:, [i, j]] = y[0][:, [j, i]]
        return fault("sensor_swap", a["name"] + "," + b["name"], [("sensor_place", a["name"]), ("sensor_place", b["name"])], (1.0, 1.0), "swap", read=read)

    if kind == "fell_off":
        order = warmest()
        j = int(order[-1 - int(rng.integers(min(2, len(order))))])
        first = measured[int(rng.integers(2))] if len(measured) > 2 else measured[0]
        at = float(round(rng.uniform(0.12, 0.4) * first.t[-1] / 60, 1))

        def read(y, rec, size):
            late = rec.t >= (60 * at if rec.name == first.name else 0.0)
            y[0][late, j] = size * rec.air[late] + (1 - size) * y[0][late, j]
        return fault("sensor_detached", t.sensors[j]["name"], [("sensor_place", t.sensors[j]["name"])], (0.7, 1.0), "share", read=read, rec=first, until_end=True, more=dict(time_min=at))

    if kind == "missing_stop":
        rec = pick(measured)
        w = window(rec, 60, 200, True)

        def alter(truth, record, size):
            record.speed = record.speed.copy()
            record.speed[(record.t >= 60 * w[0]) & (record.t < 60 * w[1])] = 0.0
        return fault("missing_stop", "spindle", [("heat_window", "spindle"), ("speed_override", "spindle")] + [("heat_window", b) for b in heated], (1.0, 1.0), "stop", alter, rec=rec, windows_min=[list(w)])

    if kind == "hidden_body":
        b = pick(own)
        cap, contact, area = sum(t.cap[i] for i in index[b]), rng.uniform(1.0, 3.0), rng.random()

        def alter(truth, rec, size):
            new = truth.node("fixture", None, size * cap, 0.1 + 0.4 * area, 1.0, 0.5, 4.5, 0.0, 0.5)
            rec.start = np.append(rec.start, 0.0)
            truth.edges += [(i, new, contact * size * cap / 3600.0 / len(index[b])) for i in index[b]]
        return fault("hidden_body", b, [("heat_capacity", b)], (0.8, 40.0), "times_capacity", alter)

    if kind == "recorded_column":
        b = pick(own)
        return fault("recorded_drive", b, [("heat_source", b), ("heat_window", b)], (0.15 * drive_heat, 3.5 * drive_heat), "W_at_full", heat("heater", b, "column"), more=dict(column=column[0]))

    if kind == "ambient_elsewhere":
        sign = pick([-1.0, 1.0])

        def alter(truth, rec, size):
            rec.air = rec.air + sign * size
        return fault("ambient", "hall", [("stratification", "hall")], (2.0, 9.0), "K", alter, more=dict(sign=sign))

    if kind == "speed_other":
        down = rng.random() < 0.6

        def alter(truth, rec, size):
            rec.speed = rec.speed * (1 / size if down else size)
        single = [("heat_source", b) for b in heated] + [("friction_law", b) for b in heated] if len(heated) == 1 else []
        return fault("speed_override", "spindle", [("heat_window", "spindle")] + single, (1.3, 4.0 if down else 2.2), "divided_by" if down else "times", alter)

    if kind == "circuit_off":
        rec = pick(measured)
        w, b = window(rec, 60, 200, True), t.circuits[0]["body"]

        def alter(truth, record, size):
            truth.circuits[0]["off"] = [(60 * w[0], 60 * w[1])]
        also = [("coolant", b), ("heat_window", b), ("heat_source", b), ("convection", b), ("contact", b), ("link", f"{b},hall")]
        return fault("exchange_window", b, also, (1.0, 1.0), "off", alter, rec=rec, windows_min=[list(w)])

    if kind == "heat_window":
        rec = pick(measured)
        w, b = window(rec, 50, 140), pick(own)
        return fault("heat_window", b, [("heat_source", b)], (0.3 * drive_heat, 5 * drive_heat), "W", heat("constant", b, "one", [(60 * w[0], 60 * w[1])]), rec=rec, windows_min=[list(w)])
    raise ValueError(kind)
