"""A machine as a user would write it down (scenario YAML), and records as a logger would write them."""
import numpy as np


def g(x):
    return f"{x:.6g}"


def body(b):
    """As scenarios call it: `hall`, here and as a value of `where` in diagnosis.json, is `ambient` there."""
    return "ambient" if b == "hall" else b


def known_to(machine, keys):
    """How well the scenario says that numbers of an effect are known; keys: key of the grammar -> label."""
    words = {}
    for key, label in keys.items():
        factor = machine.stated.get(label, 1.0)
        if factor != 1.0:
            words[key] = "guess" if factor > 3 else f"{g(10 * factor)} %"
    return ", known_to: {%s}" % ", ".join(f"{k}: {w}" for k, w in words.items()) if words else ""


def scenario(machine, dt, hall="{csv: measured_1.csv, channel: ambient}", plan="measured_1.csv", name=None):
    v = {k: x for k, (x, _) in machine.numbers.items()}
    out = [f"# {machine.title[:1].upper() + machine.title[1:]}. Nominal numbers are estimates.", f"name: {name or machine.family}", f"reference_temperature: {g(machine.t_ref)} degC",
           f"start: {body(machine.start) if isinstance(machine.start, str) else g(machine.start) + ' degC'}", "machine: {generator: lumped}", "effects:"]
    for b in machine.bodies:
        if b in machine.air:
            out.append(f"  - {{type: air_node, node: {b}, capacity: {g(v['C ' + b])} J/K, exchange: {g(v[f'G {b} hall'])} W/K{known_to(machine, {'exchange': f'G {b} hall'})}}}")
        else:
            out.append(f"  - {{type: node, node: {b}, capacity: {g(v['C ' + b])} J/K{known_to(machine, {'capacity': 'C ' + b})}}}")
    for a, b in machine.links:
        if not (a in machine.air and b == "hall"):
            out.append(f"  - {{type: link, node: {a}, to: {body(b)}, conductance: {g(v[f'G {a} {b}'])} W/K{known_to(machine, {'conductance': f'G {a} {b}'})}}}")
    for a, b in machine.fans:
        out.append(f"  - {{type: link, node: {a}, to: {body(b)}, conductance: {g(v[f'fan {a} {b}'])} W/K, runs: while_spindle_turns}}")
    for node, column, how in machine.recorded:
        key, unit = ("opening", "") if how == "opening" else ("conductance", " W/K")
        out.append(f"  - {{type: recorded_drive, node: {node}, {key}: {g(v[f'{how} {node}'])}{unit}, column: {column}}}")
    for node, set_point in machine.circuits:
        out.append(f"  - {{type: coolant, node: {node}, flow: {g(v['flow ' + node])} L/min, passage_conductance: {g(v['passage ' + node])} W/K, set_point: {g(set_point)} degC}}")
    for i, law in enumerate(machine.heats):
        known = known_to(machine, {dict(cutting_heat="share", recorded_drive="gain").get(law["kind"], "power"): f"P {i}", "exponent": f"e {i}", "idle": f"idle {i}", "decay": f"decay {i}"})
        p, e = v[f"P {i}"], f", exponent: {g(v[f'e {i}'])}" if law["has_exponent"] else ""
        idle = f", idle: {g(v[f'idle {i}'])} W" if law["has_idle"] else ""
        head = f"  - {{type: {law['kind']}, node: {law['node']}"
        if law["kind"] == "cutting_heat":
            out.append(f"{head}, share: {g(p)}{known}}}")
        elif law["kind"] == "recorded_drive":
            out.append(f"{head}, gain: {g(p)}, column: {law['column']}{known}}}")
        elif law["kind"] == "servo_loss":
            out.append(f"{head}, power: {g(p)} W, at_feed: {g(law['at'] * 60)} m/min{e or ', exponent: 1'}{idle}, axis: {law['axis']}{known}}}")
        elif law["kind"] == "heat_source" and not law["has_exponent"]:
            out.append(f"{head}, power: {g(p)} W{', runs: while_spindle_turns' if law['turning'] else ''}{known}}}")
        else:
            decay = f", decay: {g(v[f'decay {i}'])} 1/K, at_temperature: {g(machine.t_ref)} degC" if law["has_decay"] else ""
            out.append(f"{head}, power: {g(p)} W, at_speed: {g(law['at'])} rpm{e}{idle}{decay}{known}}}")
    return "\n".join(out + seen(machine.sensors, [(n, [(b, v[f"S {n} {b}"]) for b in nodes]) for n, _, nodes in machine.displacements], dt, hall, plan)) + "\n"


def seen(sensors, displacements, dt, hall="{csv: measured_1.csv, channel: ambient}", plan="measured_1.csv"):
    """The end of a scenario. sensors: (name, body); displacements: (name, [(body, um/K)])."""
    out = [f"ambient: {hall}"]
    if sensors:
        out += ["sensors:"] + [f"  - {{name: {n}, node: {body(b)}}}" for n, b in sensors]
    if displacements:
        out += ["displacements:"] + [f"  - {{name: {n}, sensitivities: [" + ", ".join(f"{{node: {b}, sensitivity: {g(x)} um/K}}" for b, x in terms) + "]}" for n, terms in displacements]
    return out + ["cyclograms:", f"  plan: {{csv: {plan}}}", f"solver: {{relative_tolerance: 1e-5, absolute_tolerance: 1e-4 K, output_interval: {g(dt)} s}}"]


def record_csv(machine, record, temperatures, displacements, rng=None, missing=0.0):
    head, columns = ["time_s", "speed_rpm"], [[g(t) for t in record.time_s], [g(n) for n in record.speed]]
    for axis, f in sorted(record.feeds.items()):
        head.append(f"feed_{axis}_mm_min")
        columns.append([f"{x * 60000:.1f}" for x in f])
    if record.power.any() or any(h["kind"] == "cutting_heat" for h in machine.heats):
        head.append("cutting_power_W")
        columns.append([g(p) for p in record.power])
    for name, (unit, x) in record.columns.items():
        head.append(f"{name}_{unit}")
        columns.append([g(a) for a in x])
    return with_readings(head, columns, record.hall, [n for n, _ in machine.sensors], temperatures, [d[0] for d in machine.displacements], displacements, rng, missing)


def with_readings(head, columns, hall, thermometers, temperatures, channels, displacements, rng=None, missing=0.0):
    """A record's text. head, columns: what is recorded of the drive, as text; temperatures, displacements: row x channel."""
    head = head + ["ambient_degC"] + [n + "_degC" for n in thermometers] + [n + "_um" for n in channels]
    columns = columns + [[f"{x:.2f}" for x in hall]]
    cells = [[f"{x:.4f}".rstrip("0").rstrip(".") for x in y] for y in np.transpose(temperatures)] + [[f"{x:.2f}" for x in y] for y in np.transpose(displacements)]
    if missing > 0:
        for column in cells:
            for k in np.flatnonzero(rng.random(len(column)) < missing):
                column[k] = ""
    return ",".join(head) + "\n" + "\n".join(",".join(r) for r in zip(*(columns + cells))) + "\n"
