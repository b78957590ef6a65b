"""Eleven families of machines, their cyclograms, halls and instruments; every number is drawn anew for each case."""
import numpy as np
from network import Machine, Record


def rounded(x, digits=3):
    return float(f"{x:.{digits}g}")


class Draw:
    def __init__(self, rng, spread=0.35):
        self.rng, self.spread = rng, spread

    def __call__(self, x, spread=None):
        return rounded(x * np.exp((spread or self.spread) * self.rng.standard_normal()))


def lathe_headstock(rng, v):
    m = Machine("lathe_headstock")
    for b, c in dict(spindle=12e3, bearing_front=2.5e3, bearing_rear=1.8e3, headstock=45e3, bed=180e3).items():
        m.body(b, v(c))
    for a, b, g in [("bearing_front", "spindle", 14), ("bearing_front", "headstock", 28), ("bearing_rear", "spindle", 10), ("bearing_rear", "headstock", 22),
                    ("headstock", "bed", 18), ("headstock", "hall", 9), ("bed", "hall", 15)]:
        m.link(a, b, v(g))
    m.heat("heat_source", "bearing_front", v(190), 3000, rounded(rng.uniform(1.0, 1.7)))
    m.heat("friction_law", "bearing_rear", v(110), 3000, rounded(rng.uniform(0.9, 1.6)), decay=v(0.012))
    m.heat("motor_loss", "headstock", v(140), 3000, rounded(rng.uniform(1, 2)), idle=v(25))
    m.displacement("drift_x", "x", {"headstock": v(1.8), "spindle": v(0.6)})
    m.displacement("drift_z", "z", {"spindle": v(2.6), "bed": -v(0.9)})
    m.displacement("drift_y", "y", {"headstock": v(3.4), "bearing_front": v(0.5)})
    return m, dict(hours=(3, 10), dt=(15, 60), drive="speed", top=3000)


def grinding_spindle(rng, v):
    m = Machine("grinding_spindle")
    for b, c in dict(shaft=6e3, bearing=1.6e3, motor=9e3, housing=22e3, wheelhead=60e3).items():
        m.body(b, v(c))
    for a, b, g in [("bearing", "shaft", 13), ("bearing", "housing", 30), ("motor", "shaft", 2.5), ("motor", "housing", 45), ("housing", "wheelhead", 25),
                    ("wheelhead", "hall", 12), ("shaft", "hall", 1.6)]:
        m.link(a, b, v(g))
    m.circuit("housing", v(4), v(60), rounded(rng.uniform(20, 24)))
    m.heat("heat_source", "bearing", v(120), 6000, rounded(rng.uniform(1.2, 1.9)))
    m.heat("motor_loss", "motor", v(260), 6000, rounded(rng.uniform(1, 2)), idle=v(50))
    m.heat("cutting_heat", "shaft", rounded(rng.uniform(0.06, 0.16), 2))
    m.displacement("wheel_x", "x", {"wheelhead": v(2.2), "shaft": v(1.1)})
    m.displacement("nose_z", "z", {"shaft": v(2.5), "housing": -v(1.2)})
    return m, dict(hours=(2, 7), dt=(10, 30), drive="speed+power", top=6000, power=1500)


def motor_spindle(rng, v):
    m = Machine("motor_spindle")
    for b, c in dict(rotor=5e3, bearing_front=0.9e3, bearing_rear=0.6e3, stator=5e3, jacket=7e3, housing=21e3).items():
        m.body(b, v(c))
    for a, b, g in [("bearing_front", "rotor", 12), ("bearing_front", "housing", 26), ("bearing_rear", "rotor", 8), ("bearing_rear", "housing", 16),
                    ("stator", "rotor", 1.4), ("stator", "jacket", 70), ("jacket", "housing", 30), ("housing", "hall", 5), ("rotor", "hall", 0.8)]:
        m.link(a, b, v(g))
    m.circuit("jacket", v(6), v(110), rounded(rng.uniform(22, 26)))
    m.heat("friction_law", "bearing_front", v(150), 12000, rounded(rng.uniform(1.1, 1.7)), decay=v(0.015))
    m.heat("heat_source", "bearing_rear", v(70), 12000, rounded(rng.uniform(1.1, 1.7)))
    m.heat("motor_loss", "rotor", v(80), 12000, rounded(rng.uniform(1, 2)))
    m.heat("motor_loss", "stator", v(420), 12000, rounded(rng.uniform(1, 2)), idle=v(60))
    m.displacement("nose_z", "z", {"rotor": v(2.9), "housing": -v(1.2)})
    m.displacement("nose_y", "y", {"housing": v(1.5)})
    return m, dict(hours=(1.5, 5), dt=(10, 30), drive="speed", top=12000)


def printer(rng, v):
    m = Machine("printer")
    for b, c in dict(bed=1.2e3, plate=0.5e3, frame=9e3, gantry=2.4e3, chamber=3.5e3).items():
        m.body(b, v(c))
    m.air.add("chamber")
    for a, b, g in [("bed", "plate", 9), ("plate", "chamber", 1.4), ("bed", "chamber", 0.5), ("bed", "frame", 0.25), ("chamber", "frame", 4), ("chamber", "gantry", 2.6),
                    ("gantry", "frame", 0.7), ("frame", "hall", 2.8), ("chamber", "hall", 1.1)]:
        m.link(a, b, v(g))
    m.heat("cutting_heat", "bed", rounded(rng.uniform(0.45, 0.6), 2))
    m.heat("servo_loss", "gantry", v(9), rounded(rng.uniform(0.1, 0.15)), rounded(rng.uniform(0.8, 1.3)), idle=v(3), axis="x")
    m.displacement("z_offset", "z", {"frame": v(4.2), "gantry": -v(6.1), "bed": v(0.4)})
    return m, dict(hours=(1.5, 5), dt=(10, 30), drive="bed", power=400, feeds={"x": 9000})


def incubator(rng, v):
    m = Machine("incubator")
    m.body("heater", v(330))
    m.body("air", v(260))
    m.air.add("air")
    m.link("heater", "air", v(2.2))
    m.link("air", "hall", v(0.6))
    if rng.random() < 0.8:
        m.body("wall", v(1900))
        m.link("air", "wall", v(1.1))
        m.link("wall", "hall", v(0.5))
    if rng.random() < 0.6:
        m.body("tray", v(900))
        m.link("air", "tray", v(0.9))
    m.heat("cutting_heat", "heater", rounded(rng.uniform(0.4, 0.6), 2))
    return m, dict(hours=(1, 5), dt=(10, 30), drive="duty", power=70)


def house(rng, v):
    m = Machine("house")
    for b, c in dict(room=1.6e6, heaters=7e4, envelope=9e6, floor=6e6).items():
        m.body(b, v(c))
    m.air.add("room")
    for a, b, g in [("heaters", "room", 110), ("room", "envelope", 260), ("envelope", "hall", 110), ("room", "hall", 45), ("room", "floor", 240)]:
        m.link(a, b, v(g))
    if rng.random() < 0.5:
        m.body("attic", v(8e5))
        m.link("room", "attic", v(35))
        m.link("attic", "hall", v(70))
    m.start = rounded(rng.uniform(12, 19))      # it was heated before
    m.heat("cutting_heat", "heaters", rounded(rng.uniform(0.45, 0.6), 2))
    return m, dict(hours=(48, 120), dt=(300, 300), drive="duty", power=7000, outdoor=True)


def gantry(rng, v):
    m = Machine("gantry")
    for b, c in dict(motor_x=3e3, motor_y=3.5e3, screw_x=6e3, screw_y=7e3, beam=50e3, table=110e3, column=85e3).items():
        m.body(b, v(c))
    for a, b, g in [("motor_x", "beam", 5), ("motor_y", "column", 6), ("screw_x", "beam", 8), ("screw_y", "column", 9), ("beam", "column", 16), ("column", "table", 10),
                    ("motor_x", "hall", 1.2), ("motor_y", "hall", 1.3), ("beam", "hall", 9), ("table", "hall", 14), ("column", "hall", 11)]:
        m.link(a, b, v(g))
    for axis, motor, screw in (("x", 70, 60), ("y", 90, 75)):
        m.heat("servo_loss", "motor_" + axis, v(motor * 2.2), 0.4, rounded(rng.uniform(1, 1.8)), idle=v(12), axis=axis)
        m.heat("servo_loss", "screw_" + axis, v(screw * 2), 0.4, rounded(rng.uniform(0.8, 1.2)), axis=axis)
    m.displacement("drift_x", "x", {"screw_x": v(5.2), "beam": -v(3.1)})
    m.displacement("drift_y", "y", {"screw_y": v(6.0), "column": -v(2.8)})
    if rng.random() < 0.5:
        m.displacement("far_x", "x", {"screw_x": v(9.5), "table": -v(1.1)})
        m.displacement("far_y", "y", {"screw_y": v(10), "beam": v(0.8)})
    m.displacement("drift_z", "z", {"beam": v(2.5), "column": v(4.4), "table": -v(1.6)})
    return m, dict(hours=(3, 9), dt=(20, 60), drive="feeds", feeds={"x": 24000, "y": 24000})


def heater_plate(rng, v):
    m = Machine("heater_plate")
    m.body("plate", v(4e3))
    m.body("block", v(9e3))
    m.link("plate", "block", v(12))
    m.link("block", "hall", v(2.4))
    m.link("plate", "hall", v(1.1))
    if rng.random() < 0.6:
        m.body("base", v(16e3))
        m.link("block", "base", v(4))
        m.link("base", "hall", v(2))
    m.heat("cutting_heat", "plate", rounded(rng.uniform(0.35, 0.6), 2))
    m.displacement("gap", "z", {"plate": v(0.9), "block": v(1.6)})
    m.displacement("side", "y", {"block": v(2.4)})
    return m, dict(hours=(1.5, 5), dt=(10, 30), drive="steps", power=240)


def gearbox(rng, v):
    m = Machine("gearbox")
    for b, c in dict(oil=9e3, casing=32e3, shaft=8e3, pinion_bearing=1.4e3).items():
        m.body(b, v(c))
    for a, b, g in [("oil", "casing", 35), ("oil", "shaft", 18), ("pinion_bearing", "shaft", 11), ("pinion_bearing", "casing", 20), ("casing", "hall", 14)]:
        m.link(a, b, v(g))
    m.heat("friction_law", "oil", v(420), 1500, rounded(rng.uniform(1.4, 2)), decay=v(0.014))
    m.heat("heat_source", "pinion_bearing", v(90), 1500, rounded(rng.uniform(1, 1.5)))
    m.heat("heat_source", "casing", v(35), turning=True)
    m.displacement("shaft_offset", "y", {"casing": v(3.2), "shaft": -v(0.7)})
    return m, dict(hours=(2, 7), dt=(15, 60), drive="speed", top=1500)


def rotary_table(rng, v):
    m = Machine("rotary_table")
    for b, c in dict(motor=7e3, bearing=6e3, platter=42e3, base=95e3, encoder=0.7e3).items():
        m.body(b, v(c))
    for a, b, g in [("motor", "base", 40), ("motor", "platter", 5), ("bearing", "platter", 32), ("bearing", "base", 28), ("encoder", "platter", 1.1), ("encoder", "base", 0.6),
                    ("platter", "hall", 9), ("base", "hall", 13)]:
        m.link(a, b, v(g))
    m.heat("motor_loss", "motor", v(310), 300, rounded(rng.uniform(1, 2)), idle=v(60))
    m.heat("heat_source", "bearing", v(150), 300, rounded(rng.uniform(1, 1.8)))
    m.heat("heat_source", "base", v(20))
    m.start = "steady"
    m.displacement("platter_z", "z", {"platter": v(2.1), "bearing": v(0.8), "base": v(0.7)})
    m.displacement("platter_x", "x", {"base": v(1.4), "platter": -v(0.8)})
    m.displacement("rim", "y", {"platter": v(3.8)})
    return m, dict(hours=(3, 9), dt=(20, 120), drive="speed", top=300)


def hydraulic_unit(rng, v):
    m = Machine("hydraulic_unit")
    for b, c in dict(pump=6e3, tank=55e3, manifold=9e3, motor=8e3).items():
        m.body(b, v(c))
    for a, b, g in [("pump", "tank", 30), ("manifold", "tank", 22), ("motor", "pump", 6), ("tank", "hall", 12), ("motor", "hall", 7), ("manifold", "hall", 1.5)]:
        m.link(a, b, v(g))
    if rng.random() < 0.5:
        m.body("cylinder", v(14e3))
        m.link("manifold", "cylinder", v(5))
        m.link("cylinder", "hall", v(3))
        m.displacement("rod", "x", {"cylinder": v(4.5)})
    m.heat("heat_source", "pump", v(190), 1450, rounded(rng.uniform(1, 1.6)))
    m.heat("motor_loss", "motor", v(160), 1450, rounded(rng.uniform(1, 2)), idle=v(40))
    m.heat("cutting_heat", "manifold", rounded(rng.uniform(0.3, 0.6), 2))
    return m, dict(hours=(2, 8), dt=(15, 120), drive="speed+power", top=1450, power=600)


FAMILIES = [lathe_headstock, grinding_spindle, motor_spindle, printer, incubator, house, gantry, heater_plate, gearbox, rotary_table, hydraulic_unit]


def blocks(rng, time_s, n_levels, top, mean_s, rest):
    """A column that holds one of a few levels for a while; `rest` is the share of standstill."""
    levels = np.round(top * np.sort(rng.uniform(0.2, 1.0, n_levels)), -1 if top < 2000 else -2)
    levels[-1] = np.round(top * rng.uniform(0.9, 1.0), -1)
    out, t = np.zeros(len(time_s)), 0.0
    last = None
    while t < time_s[-1]:
        length = mean_s * np.exp(0.5 * rng.standard_normal())
        level = 0.0 if (last != 0.0 and t > 0 and rng.random() < rest) else rng.choice(levels)
        out[(time_s >= t) & (time_s < t + length)] = level
        t, last = t + length, level
    return out


def hall_curve(rng, time_s, outdoor):
    hours = time_s / 3600
    mean, swing = (rng.uniform(2, 12), rng.uniform(2, 6)) if outdoor else (rng.uniform(19, 25), rng.uniform(0.3, 2.0))
    y = mean + swing * np.sin(2 * np.pi * (hours - rng.uniform(0, 24)) / 24)
    slow, tau = 0.0, rng.uniform(1, 3)
    walk = np.empty(len(hours))
    e = np.exp(-(hours[1] - hours[0]) / tau)
    for k in range(len(hours)):
        slow = e * slow + np.sqrt(1 - e * e) * (1.2 if outdoor else 0.3) * rng.standard_normal()
        walk[k] = slow
    k = max(1, int(0.15 / (hours[1] - hours[0])))
    walk = np.convolve(np.pad(walk, (k, k), mode="edge"), np.ones(k) / k, mode="same")[k:-k]
    y = y + walk
    if not outdoor and rng.random() < 0.4:       # air conditioning that switches
        period = rng.uniform(0.15, 0.5)
        y = y + rng.uniform(0.1, 0.3) * (2 * np.abs((hours / period) % 1 - 0.5) - 0.5)
    return np.round(y, 2)


EXTRA_COLUMNS = [("sun", "W_m2"), ("valve", "percent"), ("purge", "1"), ("lamp", "V"), ("aux_power", "W"), ("conveyor", "count")]


def extra_column(rng, time_s, unit):
    mean_s = rng.uniform(0.05, 0.2) * time_s[-1]
    if unit == "W_m2":
        hours = time_s / 3600
        day = np.maximum(0, np.sin(2 * np.pi * (hours - rng.uniform(-3, 6)) / max(24 if time_s[-1] > 86400 else 12, 1)))
        cloud = 0.3 + 0.7 * (blocks(rng, time_s, 3, 100, mean_s, 0.3) > 40)
        return np.round(700 * day * cloud, 1)
    top = {"percent": 100, "1": 1, "V": 24, "W": 300, "count": 40}[unit]
    if unit == "1":
        return (blocks(rng, time_s, 2, 100, mean_s, 0.5) > 0).astype(float)
    return np.round(blocks(rng, time_s, 3, top * 10, mean_s, 0.35) / 10, 1)


def record(rng, name, plan, n_rows, dt, column=None):
    time_s = np.arange(n_rows) * float(dt)
    total = time_s[-1]
    mean_s = rng.uniform(0.05, 0.14) * total
    speed, power, feeds = np.zeros(n_rows), np.zeros(n_rows), {}
    drive = plan["drive"]
    if "speed" in drive:
        speed = blocks(rng, time_s, int(rng.integers(3, 6)), plan["top"], mean_s, 0.3)
    if drive == "speed+power":
        power = np.where(speed > 0, blocks(rng, time_s, 4, plan["power"], mean_s / 2, 0.35), 0)
    elif drive == "steps":
        power = blocks(rng, time_s, 4, plan["power"], mean_s, 0.3)
    elif drive == "bed":                       # full power until it is warm, then duty
        duty = blocks(rng, time_s, 4, plan["power"] * 0.45, mean_s * 1.5, 0.2)
        power = np.where(time_s < rng.uniform(0.03, 0.08) * total, plan["power"], duty)
    elif drive == "duty":                      # on and off, as a thermostat or a pseudo-random sequence does
        t, on = 0.0, True
        mean_on = rng.uniform(0.008, 0.03) * total
        while t < total:
            length = max(dt, (mean_on if on else mean_on * rng.uniform(0.8, 2.2)) * np.exp(0.6 * rng.standard_normal()))
            power[(time_s >= t) & (time_s < t + length)] = plan["power"] if on else 0.0
            t, on = t + length, not on
        if rng.random() < 0.4:
            power[(time_s > 0.6 * total) & (time_s < rng.uniform(0.7, 0.9) * total)] = 0
    for axis, top in plan.get("feeds", {}).items():
        feeds[axis] = blocks(rng, time_s, 4, top, mean_s, 0.3) / 1000 / 60
    columns = {}
    if column:
        columns[column[0]] = (column[1], extra_column(rng, time_s, column[1]))
    return Record(name, time_s, speed, feeds, power, hall_curve(rng, time_s, plan.get("outdoor", False)), columns)


def instruments(rng, machine, plan):
    """Thermometers and displacements that the case has, and their noise."""
    bodies = list(machine.bodies)
    kind = rng.random()
    has_displacements = len(machine.displacements) > 0
    n_t = int(rng.integers(2, len(bodies) + 1)) if len(bodies) > 2 else 2
    if has_displacements and kind < 0.10:
        n_t = 0
    elif kind > 0.85:
        n_t = int(min(20, rng.integers(len(bodies), 3 * len(bodies) + 1)))
    names = []
    order = list(rng.permutation(bodies))
    for i in range(n_t):
        body = order[i] if i < len(order) else order[int(rng.integers(len(order)))]
        n_same = sum(b == body for _, b in names)
        names.append((f"t_{body}" if n_same == 0 else f"t_{body}_{n_same + 1}", body))
    machine.sensors = sorted(names)
    if n_t > 0 and has_displacements and 0.10 <= kind < 0.28:
        keep = []
    else:
        keep = list(machine.displacements)
        if n_t > 0 and len(keep) > 1 and rng.random() < 0.4:
            keep.pop(int(rng.integers(len(keep))))
    gone = {d[0] for d in machine.displacements} - {d[0] for d in keep}
    machine.displacements = keep
    machine.numbers = {k: x for k, x in machine.numbers.items() if not (k.startswith("S ") and k.split()[1] in gone)}
    style = rng.random()
    if style < 0.6:
        temperature = dict(sigma=float(rng.choice([0.02, 0.03, 0.05, 0.1, 0.2])), step=0.001)
    else:
        temperature = dict(sigma=float(rng.choice([0.04, 0.06])), step=float(rng.choice([0.1, 0.0625])))
    displacement = dict(sigma=rounded(np.exp(rng.uniform(np.log(0.1), np.log(2.0))), 2), step=0.01)
    coloured = dict(share=0.0, minutes=0.0)
    if rng.random() < 0.33:
        coloured = dict(share=rounded(rng.uniform(0.15, 0.4), 2), minutes=rounded(rng.uniform(2, 6), 2))
    return dict(temperature=temperature, displacement=displacement, coloured=coloured)
