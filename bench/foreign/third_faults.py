"""What is hidden in the set `third`: the kinds of faults.py and further ones; how they are drawn, where they act, and how truth.json describes them (README.md)."""
import numpy as np

import faults
from faults import Fault, Impossible, largest_heat, pick, scope, typical_link

# Ways of being wrong in kind (class A) and catalogued effects (C16, C8, D), in turn.
WAYS_A = ["hidden_body", "link", "exchange_window", "heat_window", "speed_windows", "heat_from", "column_heat", "column_exchange", "body_growth", "spindle_growth", "mass_change", "run_state", "sensor_place",
          "heat_law", "friction_decay", "forced_exchange"]
KINDS_C = faults.KINDS_C + ["heat_capacity", "coolant", "scale_expansion", "centrifugal", "sensor_swap", "ambient_ramp"]
COLUMNS = dict(column_heat=[("sun", "W_m2"), ("lamp", "V"), ("aux_power", "W"), ("conveyor", "count")], column_exchange=[("loop", "degC"), ("loop", "degC"), ("valve", "percent"), ("purge", "1")])


def draw(rng, way, machine, plan, records, column):
    names = [r.name for r in records if r.name != "holdout_1"]
    shortest = min(r.time_s[-1] for r in records)
    sign = 1.0 if rng.random() < 0.5 else -1.0
    watts, g = largest_heat(machine, plan), typical_link(machine)
    speeds = [i for i, h in enumerate(machine.heats) if h["has_exponent"] and h["kind"] not in ("servo_loss", "cutting_heat")]
    channels = [d[0] for d in machine.displacements]
    if way in ("sensor_place", "sensor_swap", "sensor_bias", "sensor_lag", "sensor_drift", "sensor_detached") and not machine.sensors:
        raise Impossible
    if way == "exchange_window" and shortest > 2.2 * 86400:      # let in at night, every day
        a, first = pick(rng, machine.bodies), rng.uniform(0, 20) * 3600
        return Fault("exchange_window", dict(a=a, b="hall"), low=0.01 * g, high=15 * g, all_windows=(86400.0, float(round(first)), float(round(rng.uniform(2, 7) * 3600))))
    if way == "speed_windows":
        if not speeds:
            raise Impossible
        n, out, t = int(rng.integers(1, 6)), [], rng.uniform(0.04, 0.15) * shortest
        for _ in range(n):
            length = rng.uniform(0.15, 0.45) * shortest / n
            out.append((float(round(t)), float(round(t + length))))
            t += length + rng.uniform(0.1, 0.45) * shortest / n
        if out[-1][1] > 0.96 * shortest:
            raise Impossible
        return Fault("heat_window", dict(what="speed"), low=0.1, high=1.1, sign=sign, windows=out, records=[pick(rng, names)])
    if way == "heat_from":
        law = pick(rng, ["constant"] + (["turning", "power", "power"] if speeds else []))
        data = dict(node=pick(rng, machine.bodies), law=law, from_s=float(round(rng.uniform(0.15, 0.65) * shortest)))
        if law == "power":
            data.update(at=float(plan["top"]), exponent=float(round(rng.uniform(0.5, 2.5), 2)))
        return Fault("heat_source", data, [pick(rng, names)], 0.01 * watts, 4 * watts, 1.0 if rng.random() < 0.75 else -1.0)
    if way == "heat_law":      # in all records: idle heat that is there at standstill too, on and off with the spindle, at any exponent
        law = pick(rng, ["constant"] + (["turning", "power"] if speeds else []))
        data = dict(node=pick(rng, machine.bodies), law=law, from_s=0.0)
        if law == "power":
            data.update(at=float(plan["top"]), exponent=float(pick(rng, [0.33, 0.5, 2, 2.5, 3])))
        return Fault("heat_source", data, None, 0.01 * watts, 4 * watts, 1.0)
    if way == "column_heat":
        top = max(np.max(r.columns[column[0]][1]) for r in records)
        return Fault("recorded_drive", dict(node=pick(rng, machine.bodies), column=column[0], unit=column[1], mode="gain"), low=0.01 * watts / top, high=4 * watts / top, sign=1.0 if rng.random() < 0.8 else -1.0)
    if way == "column_exchange":
        mode = "conductance" if column[1] == "degC" else "opening"
        scale = g if mode == "conductance" else g / max(np.max(r.columns[column[0]][1]) for r in records)
        return Fault("recorded_drive", dict(node=pick(rng, machine.bodies), column=column[0], unit=column[1], mode=mode), low=0.01 * scale, high=6 * scale)
    if way == "body_growth":
        if not channels:
            raise Impossible
        channel = pick(rng, channels)
        used = next(d[2] for d in machine.displacements if d[0] == channel)
        node = "hall" if rng.random() < 0.2 else pick(rng, [b for b in machine.bodies if b not in used])
        return Fault("displacement_path", dict(channel=channel, node=node, lag_min=float(round(np.exp(rng.uniform(np.log(0.01), np.log(0.15))) * shortest / 60, 1)) if rng.random() < 0.75 else 0.0),
                     low=0.03, high=20, sign=sign)
    if way == "spindle_growth":
        if not channels or not speeds:
            raise Impossible
        return Fault(way, dict(channel=pick(rng, channels), at=float(plan["top"]), exponent=float(pick(rng, [0.5, 1, 1.5, 2])), lag_min=float(round(np.exp(rng.uniform(np.log(0.006), np.log(0.1))) * shortest / 60, 1))),
                     low=0.2, high=80, sign=sign)
    if way == "mass_change":      # a pallet, a workpiece, a cup of water as warm as the hall comes to a body and may go again
        node = pick(rng, machine.bodies)
        begin = rng.uniform(0.1, 0.6) * shortest
        end = begin + rng.uniform(0.1, 0.4) * shortest if rng.random() < 0.5 else 1.01 * max(r.time_s[-1] for r in records)
        capacity = machine.numbers["C " + node][0] * np.exp(rng.uniform(np.log(0.2), np.log(1.5)))
        return Fault(way, dict(node=node, capacity=capacity, conductance=capacity / (shortest * np.exp(rng.uniform(np.log(0.01), np.log(0.12))))), [pick(rng, names)], 0.02, 5,
                     windows=[(float(round(begin)), float(round(end)))])
    if way == "sensor_place" and rng.random() < 0.35:      # half in the air from the start
        return Fault(way, dict(sensor=pick(rng, machine.sensors)[0], other="hall"), low=0.03, high=0.95)
    if way == "friction_decay":
        i = pick(rng, speeds)
        return Fault("friction_law", dict(heat=i, node=machine.heats[i]["node"], decay=True), scope(rng, records, ["all", "all", "from"]), 0.002, 0.12)
    if way == "forced_exchange":
        if not speeds or plan.get("week"):
            raise Impossible
        return Fault("forced_convection", dict(link=pick(rng, [x for x in machine.links if x[1] == "hall"]), at=float(plan["top"] / 4)), None, 0.05, 2.5, 1.0)
    if way == "heat_capacity":
        return Fault(way, dict(node=pick(rng, machine.bodies)), None, 0.2, 1.9, sign)
    if way == "coolant":
        node, _ = pick(rng, machine.circuits)
        what = pick(rng, ["set_point", "flow"])
        return Fault(way, dict(node=node, what=what), scope(rng, records, ["all", "one", "from"]), 0.2, 9 if what == "set_point" else 2.2, sign)
    if way == "scale_expansion":
        what = pick(rng, ["factor", "lag"])
        return Fault(way, dict(channel=pick(rng, channels), what=what), scope(rng, records, ["all", "all", "from"]), *((0.1, 1.6, sign) if what == "factor" else (0.002 * shortest / 60, 0.15 * shortest / 60, 1.0)))
    if way == "centrifugal":
        if not channels or not speeds:
            raise Impossible
        return Fault(way, dict(channel=pick(rng, channels), at=float(plan["top"])), scope(rng, records, ["all", "all", "from"]), 0.1, 80, sign)
    if way == "sensor_swap":
        if len(machine.sensors) < 2:
            raise Impossible
        a = pick(rng, machine.sensors)
        b = pick(rng, [s for s in machine.sensors if s[1] != a[1]])
        return Fault(way, dict(sensor=a[0], other=b[0]), scope(rng, records, ["all", "one", "from"]), 1.0, 1.0)
    if way == "ambient_ramp":
        return Fault("ambient", dict(ramp=True), [pick(rng, names)], 0.02, 40 * 3600 / shortest, sign)
    return faults.draw(rng, "heat_source" if way == "heat_source" else way, machine, plan, records, None, way in KINDS_C)


def told(fault, machine, records, nats):
    d, s, key = fault.data, float(fault.size[0]), fault.key
    if key == "heat_window" and d["what"] == "speed":
        out = faults.told(fault, machine, records, nats)
        out["also"] = [dict(effect="speed_override", where="spindle")]
        return out
    p, also, where = [], [], d.get("sensor") or d.get("channel") or d.get("node")
    factor = dict(name="factor", value=float(np.exp(s)), unit="1")
    if key == "mass_change":
        p = [dict(name="capacity", value=s * d["capacity"], unit="J/K"), dict(name="conductance", value=s * d["conductance"], unit="W/K"), dict(name="from", value=fault.own_windows[0][0] / 60, unit="min")]
        also = [(x, where) for x in ("hidden_body", "heat_capacity", "exchange_window", "heat_window")]
    elif key == "recorded_drive" and d.get("mode", "gain") != "gain":
        p = [dict(name=d["mode"], value=s, unit="W/K" if d["mode"] == "conductance" else f"W/K/({d['unit']})")]
        also = [("exchange_window", where)] if d["unit"] == "1" else []
    elif key == "friction_law" and d.get("decay"):
        p = [dict(name="decay", value=s, unit="1/K")]
    elif key == "forced_convection":
        where, p = d["link"][0], [dict(name="exponent", value=s, unit="1"), dict(name="at_speed", value=d["at"], unit="rpm")]
    elif key == "heat_capacity":
        p, also = [factor], [("hidden_body", where)] if s > 0 else []
    elif key == "coolant":
        p = [dict(name="set_point", value=dict(machine.circuits)[where] + s, unit="degC")] if d["what"] == "set_point" else [factor]
    elif key == "scale_expansion":
        p = [factor] if d["what"] == "factor" else [dict(name="lag", value=s, unit="min")]
        also = [("expansion", where)] if d["what"] == "factor" else []
    elif key == "centrifugal":
        p = [dict(name="growth", value=s, unit="um"), dict(name="at_speed", value=d["at"], unit="rpm"), dict(name="exponent", value=2.0, unit="1")]
    elif key == "sensor_swap":
        where = f"{d['sensor']},{d['other']}"
    elif key == "ambient" and d.get("ramp"):
        where, p = "hall", [dict(name="ramp", value=s, unit="K/h")]
    else:
        out = faults.told(fault, machine, records, nats)
        names = {(a["effect"], a["where"]) for a in out["also"]} | {(key, out["where"])}
        # a link to the ambient, whatever it is called, is one link
        for name, place in sorted(names):
            if place and (name == "convection" or (name == "link" and place.endswith(",hall"))):
                for other in ("contact", "convection"):
                    if (other, place.split(",")[0]) not in names:
                        out["also"].append(dict(effect=other, where=place.split(",")[0]))
                        names.add((other, place.split(",")[0]))
        return out
    out = dict(key=key, where=where, parameters=p, records=fault.records or "all", nats=round(float(nats), 2), also=[dict(effect=a, where=b) for a, b in also])
    if fault.own_windows is not None:
        out["windows_min"] = [[a / 60, b / 60] for a, b in fault.own_windows]
    for k in ("what", "node", "other", "column", "mode"):
        if d.get(k) is not None:
            out[k] = d[k]
    return out
