"""Gross faults of the set `coarse`: what is in the truth and not in the model, or in the records.

draw() gives a dict: key, where, also (catalogue's words and places of the scenario), sizes (least, most), unit, records, change(truth, record, size, solve) -> readings. Or None,
where it cannot be on this machine. The user's file is the same with and without it.
"""
import numpy as np

KINDS = ["coolant_missing", "fan", "heat_missing", "door", "swap", "fell_off", "missing_stop", "hidden_body", "recorded_column", "ambient_elsewhere", "speed_other", "circuit_off", "heat_window"]


# Kinds that ask for a spindle, or for a circuit.
ONLY = dict(fan="speed", missing_stop="speed", speed_other="speed", circuit_off="circuit")
HAVE = dict(speed=("spindle_column", "lathe", "dividing_head", "grinding_spindle", "bearing_rig"), circuit=("grinding_spindle", "linear_axis"))


def can_be_on(kind, family):
    return kind not in ONLY or family in HAVE[ONLY[kind]]


def draw(rng, kind, t, m, records, column):
    """One branch a kind: a table."""
    names = [r.name for r in records]
    measured = [r for r in records if r.name.startswith("measured")]
    own = [b for b in m["names"] if any(s["body"] == b for s in t.sensors)]
    index = {b: [i for i, x in enumerate(t.body) if x == b] for b in m["names"]}
    heated = list(dict.fromkeys(h["body"] for h in t.heats))
    drive_heat = sum(h["p"] for h in t.heats)
    pick = lambda x: x[int(rng.integers(len(x)))]
    everywhere = dict(records=names, told_records="all")

    def only(rec):
        return dict(records=[rec.name], told_records=[rec.name])

    def window(rec, least, most, while_running=False):
        end = rec.t[-1] / 60
        length = rng.uniform(least, most)
        for _ in range(60):
            begin = rng.uniform(0.15, 0.85) * end
            if begin + length > 0.97 * end:
                continue
            on = (rec.speed + rec.feed + rec.power)[(rec.t >= 60 * begin) & (rec.t < 60 * (begin + length))]
            if not while_running or (on > 0).mean() > 0.6:
                return float(round(begin, 1)), float(round(begin + length, 1))
        return None

    air_names = lambda b: [("convection", b), ("forced_convection", b), ("link", f"{b},hall"), ("contact", b), ("exchange_window", b), ("coolant", b), ("radiation", b)]

    if kind == "coolant_missing":
        b = pick([x for x in own if len(index[x]) > 2 and not any(c["body"] == x for c in t.circuits)] or own)
        nodes, set_point = index[b], float(round(rng.uniform(12, 17), 1))

        def change(truth, rec, size, solve):
            part = truth.part_of[nodes[0]]
            s = [truth.s[i] for i in nodes]
            truth.circuit(part, min(s), max(s), 3.0, size, set_point)
            rec.start = np.append(rec.start, 0.0)
            return solve(truth, rec)
        return dict(key="coolant", where=b, also=[x for x in air_names(b) if x[0] != "coolant"], sizes=(4.0, 160.0), unit="passage_W_K", more=dict(set_point_degC=set_point), change=change, **everywhere)

    if kind == "fan":
        if t.drive != "speed":
            return None
        b = pick([x for x in own if sum(t.area[i] for i in index[x]) > 0.05] or own)

        def change(truth, rec, size, solve):
            for i in index[b]:
                truth.wind[i] += size
            return solve(truth, rec)
        return dict(key="forced_convection", where=b, also=[x for x in air_names(b) if x[0] not in ("forced_convection", "radiation")], sizes=(8.0, 300.0), unit="film_W_m2K", change=change, **everywhere)

    if kind == "heat_missing":
        b = pick(own)
        law = pick(["constant", "turning"]) if t.drive == "speed" else "constant"

        def change(truth, rec, size, solve):
            truth.heats.append(dict(kind=law, nodes=index[b], body=b, p=size, e=1.0, decay=0.0, idle=0.0, by="speed" if law == "turning" else "one", window=None))
            return solve(truth, rec)
        return dict(key="heat_source", where=b, also=[("friction_law", b), ("heat_window", b)] if law == "turning" else [("heat_window", b)], sizes=(0.1 * drive_heat, 2.5 * drive_heat), unit="W", more=dict(law=law),
                    change=change, **everywhere)

    if kind == "door":
        rec = pick(measured)
        w = window(rec, 40, 110)
        side = list(rng.permutation(m["names"])[:max(2, len(m["names"]) // 2)])
        nodes = [i for b in side for i in index[b]]
        sign = -1.0 if rng.random() < 0.8 else 1.0
        if not w:
            return None

        def change(truth, rec2, size, solve):
            truth.more_film.append((nodes, 5.0, 60 * w[0], 60 * w[1]))
            truth.cold_air.append((nodes, sign * size, 60 * w[0], 60 * w[1]))
            return solve(truth, rec2)
        b = str(max(side, key=lambda x: sum(t.area[i] for i in index[x]) / sum(t.cap[i] for i in index[x])))
        also = [(e, str(x)) for x in side for e in ("exchange_window", "convection", "heat_window", "heat_source", "contact", "coolant")] + [("link", f"{x},hall") for x in side] + [("ambient", "hall"), ("stratification", "hall")]
        return dict(key="exchange_window", where=b, also=[x for x in also if x != ("exchange_window", b)], sizes=(4.0, 18.0), unit="air_K", more=dict(film_factor=5.0, bodies=[str(x) for x in side]), windows_min=[list(w)],
                    change=change, **only(rec))

    if kind == "swap":
        if len(t.sensors) < 3:
            return None
        order = np.argsort([t.warm[s["node"]] for s in t.sensors])
        i, j = int(order[-1 - int(rng.integers(2))]), int(order[int(rng.integers(2)) if len(order) > 3 else 0])
        a, b = t.sensors[i]["name"], t.sensors[j]["name"]
        if t.sensors[i]["body"] == t.sensors[j]["body"]:
            return None

        def change(truth, rec, size, solve):
            y = solve(truth, rec)
            y[0][:, [i, j]] = y[0][:, [j, i]]
            return y
        return dict(key="sensor_swap", where=f"{a},{b}", also=[("sensor_place", a), ("sensor_place", b)], sizes=(1.0, 1.0), unit="swap", change=change, **everywhere)

    if kind == "fell_off":
        order = np.argsort([t.warm[s["node"]] for s in t.sensors])
        j = int(order[-1 - int(rng.integers(min(2, len(order))))])
        name, first = t.sensors[j]["name"], measured[int(rng.integers(2))].name if len(measured) > 2 else measured[0].name
        from_there = names[names.index(first):]
        at = float(round(rng.uniform(0.12, 0.4) * next(r for r in records if r.name == first).t[-1] / 60, 1))

        def change(truth, rec2, size, solve):
            y = solve(truth, rec2)
            late = rec2.t >= (60 * at if rec2.name == first else 0.0)
            y[0][late, j] = size * rec2.air[late] + (1 - size) * y[0][late, j]
            return y
        return dict(key="sensor_detached", where=name, also=[("sensor_place", name)], sizes=(0.7, 1.0), unit="share", more=dict(time_min=at), change=change, records=from_there, told_records=from_there)

    if kind == "missing_stop":
        if t.drive != "speed":
            return None
        rec = pick(measured)
        w = window(rec, 60, 200, True)
        if not w:
            return None

        def change(truth, rec2, size, solve):
            rec2.speed = rec2.speed.copy()
            rec2.speed[(rec2.t >= 60 * w[0]) & (rec2.t < 60 * w[1])] = 0.0
            return solve(truth, rec2)
        return dict(key="missing_stop", where="spindle", also=[("heat_window", "spindle"), ("speed_override", "spindle")] + [("heat_window", b) for b in heated], sizes=(1.0, 1.0), unit="stop", windows_min=[list(w)],
                    change=change, **only(rec))

    if kind == "hidden_body":
        b = pick(own)
        cap, contact = sum(t.cap[i] for i in index[b]), rng.uniform(1.0, 3.0)

        def change(truth, rec, size, solve):
            new = truth.node("fixture", None, size * cap, 0.1 + 0.4 * rng_area, 1.0, 0.5, 4.5, 0.0, 0.5)
            rec.start = np.append(rec.start, 0.0)
            link = contact * size * cap / 3600.0
            truth.edges += [(i, new, link / len(index[b])) for i in index[b]]
            return solve(truth, rec)
        rng_area = rng.random()
        return dict(key="hidden_body", where=b, also=[("heat_capacity", b)], sizes=(0.8, 40.0), unit="times_capacity", change=change, **everywhere)

    if kind == "recorded_column":
        b = pick(own)

        def change(truth, rec, size, solve):
            truth.heats.append(dict(kind="heater", nodes=index[b], body=b, p=size, e=1.0, decay=0.0, idle=0.0, by="column", window=None))
            return solve(truth, rec)
        return dict(key="recorded_drive", where=b, also=[("heat_source", b), ("heat_window", b)], sizes=(0.15 * drive_heat, 3.5 * drive_heat), unit="W_at_full", more=dict(column=column[0]), change=change, **everywhere)

    if kind == "ambient_elsewhere":
        sign = pick([-1.0, 1.0])

        def change(truth, rec, size, solve):
            rec.air = rec.air + sign * size
            return solve(truth, rec)
        return dict(key="ambient", where="hall", also=[("stratification", "hall")], sizes=(2.0, 9.0), unit="K", more=dict(sign=sign), change=change, **everywhere)

    if kind == "speed_other":
        if t.drive != "speed":
            return None
        down = rng.random() < 0.6

        def change(truth, rec, size, solve):
            rec.speed = rec.speed * (1 / size if down else size)
            return solve(truth, rec)
        single = [("heat_source", b) for b in heated] + [("friction_law", b) for b in heated] if len(heated) == 1 else []
        return dict(key="speed_override", where="spindle", also=[("heat_window", "spindle")] + single, sizes=(1.3, 4.0 if down else 2.2), unit="divided_by" if down else "times", change=change, **everywhere)

    if kind == "circuit_off":
        if not t.circuits:
            return None
        rec = pick(measured)
        w = window(rec, 60, 200, True)
        if not w:
            return None
        b = t.circuits[0]["body"]

        def change(truth, rec2, size, solve):
            truth.circuits[0]["off"] = [(60 * w[0], 60 * w[1])]
            return solve(truth, rec2)
        return dict(key="exchange_window", where=b, also=[("coolant", b), ("heat_window", b), ("heat_source", b), ("convection", b), ("contact", b), ("link", f"{b},hall")], sizes=(1.0, 1.0), unit="off",
                    windows_min=[list(w)], change=change, **only(rec))

    if kind == "heat_window":
        rec = pick(measured)
        w = window(rec, 50, 140)
        b = pick(own)
        if not w:
            return None

        def change(truth, rec2, size, solve):
            truth.heats.append(dict(kind="constant", nodes=index[b], body=b, p=size, e=1.0, decay=0.0, idle=0.0, by="one", window=[(60 * w[0], 60 * w[1])]))
            return solve(truth, rec2)
        return dict(key="heat_window", where=b, also=[("heat_source", b)], sizes=(0.3 * drive_heat, 5 * drive_heat), unit="W", windows_min=[list(w)], change=change, **only(rec))

    raise ValueError(kind)
