"""What is hidden in the set `seventh`: kinds of the sets before and twenty ways of being wrong that none of them has (README.md), many of them by columns that act and that no file has."""
import numpy as np

import fifth_faults
import third_faults
from faults import Fault, Impossible, largest_heat, pick, typical_link
from network import Record

# Ways of class A, each as often as it comes; those of C16 that are new, once each; the older effects of C16, C8 and D.
NEW_A = ["vent_by_hall", "late_heat", "load_heat", "heat_on_two", "heat_moved", "preload_rise", "belt_slip", "cover_fitted", "foundation", "cold_tank", "sunbeam", "loosening", "grease_shots", "standstill_heater"]
WAYS_A = ["hidden_body"] * 2 + ["link", "exchange_window", "heat_window", "column_heat", "column_opening", "body_growth", "sensor_place", "run_state"] + NEW_A
NEW_C = ["slow_hall", "wrong_slope", "held_reading", "bumped_and_back", "clock_jump", "cold_junction"]
KINDS_C = [k for k in third_faults.KINDS_C if k != "sensor_swap"]      # which has no size
N_RECORDS = {"run_state": [3, 4, 5], "cover_fitted": [3, 4, 5], "loosening": [3, 4, 5]}
NOT_STEADY = {"standstill_heater", "cold_tank"}      # bodies at rest for long before would have been warmed, or cooled, by it
HIDDEN = "untold"      # a column of this name acts and no file has it
LEAST_NATS = 3.0       # another name counts as right where it leaves less than this of what is hidden

# key of truth.json and further names that count as right at the same place; `parameters` is empty and `sizes` says how large it is
NAMES = dict(vent_by_hall=("exchange_window", ["convection", "link", "contact", "forced_convection", "recorded_drive"]), late_heat=("heat_source", ["heat_window", "friction_law"]), load_heat=("heat_source", ["recorded_drive", "heat_window"]),
             heat_on_two=("heat_source", []), heat_moved=("heat_source", []), belt_slip=("speed_override", ["heat_window"]), foundation=("link", ["convection", "contact", "coolant", "radiation", "hidden_body"]),
             cold_tank=("coolant", ["heat_window"]), sunbeam=("heat_window", ["radiation", "heat_source"]), grease_shots=("heat_window", ["heat_source", "friction_law"]), standstill_heater=("heat_source", ["heat_window"]),
             slow_hall=("ambient", ["sensor_lag"]), wrong_slope=("sensor_bias", ["sensor_place", "sensor_detached"]), held_reading=("sensor_detached", ["sensor_lag", "sensor_bias", "sensor_drift"]),
             bumped_and_back=("mount_shift", []), clock_jump=("clock_offset", []), cold_junction=("sensor_bias", []))


def known_to_all(record):
    """The record as the logger has it."""
    return Record(record.name, record.time_s, record.speed, record.feeds, record.power, record.hall, {k: x for k, x in record.columns.items() if k != HIDDEN})


def hide(records, unit, values, must_move=True):
    for r in records:
        r.columns[HIDDEN] = (unit, np.asarray(values(r), float))
        if must_move and not np.ptp(r.columns[HIDDEN][1]) > 0:
            raise Impossible


def runs(machine, record):
    """Where the machine is driven: it turns, or what is recorded of power or feeds is more than nothing."""
    if fifth_faults.machine_turns(machine):
        return record.speed > 0
    return (record.power > 0) | np.any([f > 0 for f in record.feeds.values()] or [record.power > 0], axis=0)


def loaded(machine, plan, record, share):
    """From 0 to 1, how far what is recorded of power, or else of feeds, or else of speed, exceeds a share of its greatest."""
    if "power" in plan:
        x = record.power / plan["power"]
    elif record.feeds:
        x = np.mean([f / (plan["feeds"][a] / 60000) for a, f in record.feeds.items()], axis=0)
    else:
        x = record.speed / plan["top"]
    return (x > share).astype(float)


def earlier(time_s, x, delay_s):
    """The values that held `delay_s` before each row; the first one before the record."""
    return x[np.clip(np.searchsorted(time_s, time_s - delay_s + 1e-7, side="right") - 1, 0, len(x) - 1)]


def truly(record, speed=None, hall=None):
    return Record(record.name, record.time_s, record.speed if speed is None else speed, record.feeds, record.power, record.hall if hall is None else hall, record.columns)


def draw(rng, way, machine, plan, records, column):
    """The faults that this way of being wrong consists of; some put a column into `records` that no file has."""
    measured = [r for r in records if r.name != "holdout_1"]
    names = [r.name for r in measured]
    shortest = min(r.time_s[-1] for r in records)
    sign = 1.0 if rng.random() < 0.5 else -1.0
    watts, g = largest_heat(machine, plan), typical_link(machine)
    speeds = [i for i, h in enumerate(machine.heats) if h["has_exponent"] and h["kind"] not in ("servo_loss", "cutting_heat")]      # heats that follow the speed
    turning, powered, channels, sensors = fifth_faults.machine_turns(machine), "power" in plan, [d[0] for d in machine.displacements], [n for n, _ in machine.sensors]
    if (way in ("preload_rise", "belt_slip", "grease_shots") and not turning) or (way == "bumped_and_back" and not channels) or (way in ("wrong_slope", "held_reading", "cold_junction") and not sensors):
        raise Impossible

    def gain(node, low=0.01, high=4, sign=1.0, **more):
        return [Fault("recorded_drive", dict(node=node, column=HIDDEN, mode="gain", **more), None, low * watts, high * watts, sign)]
    if way == "vent_by_hall":      # a roof vent or a blower that goes by the hall's temperature
        at = float(np.round(np.quantile(np.concatenate([r.hall for r in measured]), rng.uniform(0.4, 0.75)), 1))
        hide(records, "1", lambda r: r.hall > at, must_move=False)
        if not any(np.ptp(r.columns[HIDDEN][1]) > 0 for r in measured):
            raise Impossible
        return [Fault("recorded_drive", dict(node=pick(rng, machine.bodies), column=HIDDEN, mode="opening", above_degC=at), None, 0.01 * g, 10 * g)]
    if way == "late_heat":      # it comes with oil, chips or air that take their time
        delay = float(round(rng.uniform(0.02, 0.1) * shortest))
        e = float(pick(rng, [1.0, 1.5, 2.0]))
        what = (lambda r: (r.speed / plan["top"]) ** e) if turning else (lambda r: r.power / plan["power"]) if powered else (lambda r: runs(machine, r))
        hide(records, "W", lambda r: earlier(r.time_s, np.asarray(what(r), float), delay))
        return gain(pick(rng, machine.bodies), delay_min=delay / 60, exponent=e)
    if way == "load_heat":      # what grows with speed and load together: a torque that slips
        if plan["drive"] not in ("speed+power",) and not (turning and plan.get("feeds")):
            raise Impossible
        load = (lambda r: r.power / plan["power"]) if powered else (lambda r: np.mean([f / (plan["feeds"][a] / 60000) for a, f in r.feeds.items()], axis=0))
        hide(records, "W", lambda r: (r.speed / plan["top"]) * load(r))
        return gain(pick(rng, machine.bodies))
    if way == "heat_on_two":      # one lamp, hose or cable duct beside both
        if len(machine.bodies) < 2:
            raise Impossible
        nodes = [str(x) for x in rng.choice(machine.bodies, 2, replace=False)]
        share = float(np.round(rng.uniform(0.3, 0.7), 2))
        law = pick(rng, ["constant"] + (["turning", "power"] if turning else []))
        return [Fault("heat_on_two", dict(nodes=nodes, shares=[share, 1 - share], law=law, from_s=0.0, **(dict(at=float(plan["top"]), exponent=float(pick(rng, [0.7, 1.3, 2.0]))) if law == "power" else {})), None, 0.02 * watts, 5 * watts)]
    if way == "heat_moved":
        i = pick(rng, range(len(machine.heats)))
        a = machine.heats[i]["node"]
        near = [y if x == a else x for x, y in machine.links if a in (x, y) and "hall" not in (x, y)]
        b = pick(rng, near if rng.random() < 0.5 else [x for x in machine.bodies if x != a])
        return [Fault("heat_moved", dict(heat=i, node=b, from_node=a), None, 0.04, 0.95)]
    if way == "preload_rise":      # a bearing that tightens as it warms, a winding whose resistance grows
        i = pick(rng, speeds)
        return [Fault("friction_law", dict(heat=i, node=machine.heats[i]["node"], decay=True), None, 0.001, 0.03, -1.0)]
    if way == "belt_slip":      # while it is loaded, in every record
        share = float(np.round(rng.uniform(0.35, 0.65), 2))
        for r in measured:
            on = loaded(machine, plan, r, share)[r.speed > 0]
            if on.size == 0 or not 0.05 < on.mean() < 0.9:
                raise Impossible
        return [Fault("record_change", dict(place="spindle", loaded_above=share, change=lambda r, s: truly(r, speed=r.speed * np.where(loaded(machine, plan, r, share) > 0, np.exp(-s), 1.0))), None, 0.02, 0.9)]
    if way == "cover_fitted":      # from one record on, the holdout too
        films = [x for x in machine.links if x[1] == "hall"]
        if len(films) < 2:
            raise Impossible
        chosen = [films[int(i)] for i in rng.choice(len(films), 2, replace=False)]
        return [Fault("two_films", dict(links=chosen), names[int(rng.integers(1, len(names))):] + ["holdout_1"], 0.15, 2.5, -1.0 if rng.random() < 0.75 else 1.0)]
    if way == "foundation":      # bolted to ground, a wall or a pipe that keeps its temperature
        warm = float(round(rng.uniform(6, 22), 1))
        if min(abs(warm - np.mean(r.hall)) for r in measured) < 2.5:
            raise Impossible
        hide(records, "degC", lambda r: np.full(len(r.time_s), warm), must_move=False)
        return [Fault("recorded_drive", dict(node=pick(rng, machine.bodies), column=HIDDEN, mode="conductance", degC=warm), None, 0.01 * g, 6 * g)]
    if way == "cold_tank":      # the circuit begins each record colder, or warmer, than it is set
        node, _ = pick(rng, machine.circuits)
        tau = rng.uniform(0.03, 0.2) * shortest
        hide(records, "W", lambda r: np.exp(-r.time_s / tau))
        return gain(node, 0.02, 8, -1.0 if rng.random() < 0.75 else 1.0, fades_min=float(round(tau / 60, 2)))
    if way == "sunbeam":      # over a window sill, at its own time in each record
        width = {r.name: (rng.uniform(0.15, 0.85) * r.time_s[-1], rng.uniform(0.05, 0.14) * shortest) for r in records}
        hide(records, "W", lambda r: np.exp(-0.5 * ((r.time_s - width[r.name][0]) / width[r.name][1]) ** 2))
        return gain(pick(rng, machine.bodies), centres_min={k: round(x[0] / 60, 2) for k, x in width.items()})
    if way == "loosening":      # a bolted joint, from record to record
        link = pick(rng, [x for x in machine.links if x[1] != "hall"])
        return [Fault("loosening", dict(link=link, order=names + ["holdout_1"]), None, 0.08, 1.5)]
    if way == "grease_shots":      # every so often, in each record from a time of its own on; while it turns
        i = pick(rng, [i for i in speeds if machine.heats[i]["kind"] != "motor_loss"])
        period = rng.uniform(0.12, 0.4) * shortest
        tau, first = period * rng.uniform(0.15, 0.5), {r.name: rng.uniform(0, period) for r in records}
        hide(records, "W", lambda r: (r.speed > 0) * (r.time_s >= first[r.name]) * np.exp(-((r.time_s - first[r.name]) % period) / tau))
        return gain(machine.heats[i]["node"], period_min=round(period / 60, 2), fades_min=round(tau / 60, 2))
    if way == "standstill_heater":      # against dew, or to keep it warm
        hide(records, "W", lambda r: ~np.asarray(runs(machine, r)))
        return gain(pick(rng, machine.bodies))
    if way == "slow_hall":      # what recorded the ambient is itself slow, in a box or on a wall
        def change(r, s):
            width = max(3, len(r.time_s) // 60)
            smooth = np.convolve(np.pad(r.hall, width, mode="edge"), np.ones(2 * width + 1) / (2 * width + 1), mode="valid")
            return truly(r, hall=r.hall + 60 * s * np.gradient(smooth, r.time_s))
        return [Fault("record_change", dict(place="hall", change=change), None, 0.003 * shortest / 60, 0.25 * shortest / 60)]
    if way == "wrong_slope":      # another thermocouple than the amplifier thinks
        return [Fault(way, dict(sensor=pick(rng, sensors)), None, 0.004, 0.4, sign)]
    if way == "held_reading":      # the bus has lost the module and the logger goes on
        r = pick(rng, measured)
        return [Fault(way, dict(sensor=pick(rng, sensors), begin_s=float(round(rng.uniform(0.05, 0.7) * r.time_s[-1]))), [r.name], max(1.5 * np.median(np.diff(r.time_s)), 0.005 * r.time_s[-1]) / 60, 0.28 * r.time_s[-1] / 60)]
    if way == "bumped_and_back":      # somebody leans on the stand
        r = pick(rng, measured)
        a = rng.uniform(0.05, 0.7)
        return [Fault("bumped", dict(channel=pick(rng, channels), begin_s=float(round(a * r.time_s[-1])), end_s=float(round((a + rng.uniform(0.05, 0.25)) * r.time_s[-1]))), [r.name], 0.1, 90, sign)]
    if way == "clock_jump":      # it is set by the network
        r = pick(rng, measured)
        return [Fault(way, dict(from_s=float(round(rng.uniform(0.15, 0.6) * r.time_s[-1]))), [r.name], max(0.05, 0.3 * np.median(np.diff(r.time_s)) / 60), 0.1 * r.time_s[-1] / 60, sign)]
    if way == "cold_junction":      # of one card; the others have their own
        n = len(sensors)
        k = n if n < 3 else int(rng.integers(2, n))
        return [Fault("card_bias", dict(sensors=sensors[:k]), None, 0.03, 6, sign)]
    return fifth_faults.draw(rng, way, machine, plan, records, column)


def places(fault):
    """Bodies at which another kind might say the same."""
    d = fault.data
    if fault.key == "heat_on_two":
        return d["nodes"]
    if fault.key == "heat_moved":
        return [d["node"], d["from_node"]]
    return [x for x in (d.get("node") or d.get("a"),) if x and not d.get("sensor") and not d.get("channel")]


def candidates(fault, machine, plan, records):
    """(effect, where, fault of a moderate size) of what might be taken for it at its own place."""
    watts, g, shortest, out = 0.05 * largest_heat(machine, plan), 0.2 * typical_link(machine), min(r.time_s[-1] for r in records), []
    turning = fifth_faults.machine_turns(machine)
    for node in places(fault):
        laws = [dict(law="constant")] + ([dict(law="turning")] + [dict(law="power", at=float(plan["top"]), exponent=e) for e in (1.0, 2.0)] if turning else [])
        out += [("heat_source", node, Fault("heat_source", dict(node=node, from_s=0.0, **law)).with_size(watts)) for law in laws]
        film = Fault("link", dict(a=node, b="hall")).with_size(g)
        out += [("link", node + ",hall", film), ("convection", node, film), ("contact", node, film)]
        c = machine.numbers["C " + node][0]
        out += [("hidden_body", node, Fault("hidden_body", dict(node=node, capacity=c, conductance=c / (x * shortest), to_hall=0.0)).with_size(0.3)) for x in (0.02, 0.1, 0.4)]
        out.append(("heat_capacity", node, Fault("heat_capacity", dict(node=node)).with_size(0.1)))
        for i, h in enumerate(machine.heats):
            if h["node"] == node and h["has_exponent"]:
                out.append(("friction_law", node, Fault("friction_law", dict(heat=i, node=node)).with_size(0.1)))
            if h["node"] == node and h["kind"] == "cutting_heat":
                out.append(("recorded_drive", node, Fault("recorded_drive", dict(heat=i, node=node)).with_size(0.1)))
        when = dict(records=fault.records, windows=fault.own_windows, all_windows=fault.every)
        if fault.own_windows is not None or fault.every is not None:
            out.append(("heat_window", node, Fault("heat_window", dict(what="heat", node=node), **when).with_size(watts)))
            out.append(("exchange_window", node, Fault("exchange_window", dict(a=node, b="hall"), **when).with_size(g)))
    if fault.key == "heat_moved":
        a, b = fault.data["from_node"], fault.data["node"]
        out += [(x, f"{a},{b}", Fault("link", dict(a=a, b=b)).with_size(g)) for x in ("contact", "link")]
    if fault.key == "card_bias":
        out.append(("ambient", "hall", Fault("ambient", dict(from_s=0.0)).with_size(0.3)))
    return out


def told_alike(fault, machine, plan, records, judge, scale):
    """Those of the candidates that leave less than LEAST_NATS of it, by linear nats about the nominal numbers with their size free; `scale`: refitted over linear nats of the fault."""
    d, out = judge.deviation([fault], 1), []
    for effect, where, other in candidates(fault, machine, plan, records):
        beside = judge.deviation([other], 1)[0]
        if np.isfinite(beside).all() and np.linalg.norm(beside) > 1e-6 and scale * judge.nats(d, beside)[0] < LEAST_NATS:
            out.append((effect, where))
    return out


def told(way, hidden, machine, records, worth, alike):
    """The entries of truth.json; `alike`: of each fault, what told_alike says. Where no key says the law, `parameters` is empty and `sizes` says how large it is: no interval is judged by it."""
    f = hidden[0] if hidden else None
    if way in NAMES or way in ("cover_fitted", "loosening"):
        d = f.data
        sizes = dict(size=float(f.size[0]), **{k: x for k, x in d.items() if k not in ("sensor", "channel", "column", "mode", "change", "place", "order", "link")})
        if way == "loosening":
            where, key, also = ",".join(d["link"]), "contact", [("link", ",".join(d["link"]))]
        elif way == "cover_fitted":
            key, where, also = "convection", d["links"][0][0], [("run_state", ",".join(r for r in f.records if r != "holdout_1"))]
            for a, _ in d["links"]:
                also += [("convection", a), ("link", a + ",hall"), ("contact", a)]
        else:
            key, further = NAMES[way]
            where = d.get("sensor") or d.get("channel") or d.get("place") or d.get("node") or ("clock" if way == "clock_jump" else (d.get("nodes") or d.get("sensors"))[0])
            if way == "foundation":
                where += ",hall"
            also = [(x, where.replace(",hall", "")) for x in further]
            also += [(key, x) for x in (d.get("nodes") or d.get("sensors") or [])[1:]] + ([(key, d["from_node"])] if way == "heat_moved" else [])
            if way == "heat_moved" and machine.heats[d["heat"]]["kind"] == "cutting_heat":
                also += [("recorded_drive", d["node"]), ("recorded_drive", d["from_node"])]
        also = [x for i, x in enumerate(also) if x != (key, where) and x not in also[:i]]
        out = [dict(key=key, where=where, parameters=[], sizes=sizes, records=f.records or "all", nats=round(float(worth[0]), 2), also=[dict(effect=x, where=y) for x, y in also])]
    else:
        out = fifth_faults.told(way, hidden, machine, records, worth)
    for e, others in zip(out, alike):
        known = {(e["key"], e["where"])} | {(x["effect"], x["where"]) for x in e["also"]}
        fresh = [x for i, x in enumerate(others) if x not in known and x not in others[:i]]
        e["also"] += [dict(effect=x, where=y) for x, y in fresh]
        e["also_as_data_cannot_tell"] = [list(x) for x in fresh]
    return out
