"""Thirteen more families of machines, for the set `fifth` (README.md), of two to twelve bodies: chains, rings, stars and twins; driven as a test laboratory or a shop would."""
import numpy as np

from families import rounded
from network import Machine, Record
from third_families import build

PACES = (5, 10, 15, 20, 30, 45, 60, 90, 120, 180, 300, 450, 600)      # of the logger [s]
STYLES = ["staircase", "spectrum", "constant", "warm_cool", "shop", "pulses", "ramps"]


def pump_bracket(rng, v):
    """Two bodies; the pumped liquid is a circuit."""
    m = Machine("pump_bracket")
    build(m, v, dict(bearing=2.2e3, casing=26e3), [("bearing", "casing", 9), ("casing", "hall", 11), ("bearing", "hall", 0.8)])
    m.circuit("casing", v(3), v(24), rounded(rng.uniform(18, 40)))
    m.heat("friction_law", "bearing", v(130), 2900, rounded(rng.uniform(0.9, 1.6)), decay=v(0.012))
    m.heat("heat_source", "casing", v(70), 2900, rounded(rng.uniform(2.0, 2.9)))
    m.displacement("shaft_end", "z", {"bearing": v(1.8), "casing": -v(0.9)})
    return m, dict(hours=(0.9, 5), drive="speed", top=2900)


def diode_bar(rng, v):
    """Three bodies in a row, the quickest of seconds; the laser's electric power is recorded."""
    m = Machine("diode_bar")
    build(m, v, dict(junction=38, spreader=260, block=1100), [("junction", "spreader", 3.6), ("spreader", "block", 6), ("block", "hall", 0.6)])
    m.circuit("block", v(1.2), v(9), rounded(rng.uniform(17, 27)))
    m.heat("cutting_heat", "junction", rounded(rng.uniform(0.35, 0.55), 2))
    return m, dict(hours=(0.5, 2.2), drive="power", power=90)


def slewing_ring(rng, v):
    """A ring of six arcs, closed on itself, of a heavy turntable."""
    m = Machine("slewing_ring")
    arcs = [f"arc_{i + 1}" for i in range(6)]
    build(m, v, {**{a: 62e3 for a in arcs}, "pinion": 9e3, "motor": 14e3, "foundation": 0.9e6}, [(arcs[i], arcs[i + 1], 26) for i in range(5)] + [("arc_6", "arc_1", 26)])
    for a in arcs:
        m.link(a, "hall", v(6))
    for a, b, g in [("arc_1", "foundation", 28), ("arc_3", "foundation", 26), ("arc_5", "foundation", 27), ("pinion", "arc_1", 12), ("motor", "pinion", 5), ("motor", "hall", 9), ("foundation", "hall", 60)]:
        m.link(a, b, v(g))
    m.heat("heat_source", "pinion", v(260), 30, rounded(rng.uniform(0.8, 1.5)))
    m.heat("motor_loss", "motor", v(240), 30, rounded(rng.uniform(1.0, 1.9)), idle=v(45))
    m.heat("heat_source", "arc_4", v(330), 30, rounded(rng.uniform(0.9, 1.4)))
    m.displacement("rim_tilt", "y", {"arc_1": v(4.2), "arc_4": -v(4.0)})
    m.displacement("rim_lift", "z", {"arc_2": v(2.4), "arc_5": v(2.1), "foundation": -v(1.5)})
    return m, dict(hours=(6, 28), drive="speed", top=30)


def planer_bed(rng, v):
    """Twelve bodies: a long bed in eight pieces; nothing is recorded but feeds."""
    m = Machine("planer_bed")
    pieces = [f"bed_{i + 1}" for i in range(8)]
    build(m, v, {**{b: 95e3 for b in pieces}, "carriage": 70e3, "rack_drive": 9e3, "slide": 18e3, "motor": 6e3}, [(pieces[i], pieces[i + 1], 24) for i in range(7)])
    for b in pieces:
        m.link(b, "hall", v(9))
    for a, b, g in [("carriage", "bed_4", 15), ("carriage", "bed_5", 14), ("rack_drive", "bed_1", 10), ("rack_drive", "hall", 4), ("slide", "carriage", 14), ("motor", "slide", 5), ("motor", "hall", 3)]:
        m.link(a, b, v(g))
    m.heat("servo_loss", "rack_drive", v(210), 0.3, rounded(rng.uniform(0.9, 1.5)), idle=v(30), axis="x")
    m.heat("servo_loss", "carriage", v(280), 0.3, rounded(rng.uniform(0.7, 1.2)), axis="x")
    m.heat("servo_loss", "motor", v(90), 0.1, rounded(rng.uniform(1.0, 1.7)), idle=v(15), axis="z")
    m.displacement("straightness", "y", {"bed_2": v(2.1), "bed_4": -v(3.8), "bed_7": v(2.0)})
    m.displacement("tool_height", "z", {"carriage": v(3.2), "slide": v(1.5), "bed_5": v(1.1)})
    return m, dict(hours=(6, 24), drive="feeds", feeds={"x": 18000, "z": 6000})


def optical_table(rng, v):
    """A star: modules on one breadboard, seen by where their beams go."""
    m = Machine("optical_table")
    build(m, v, dict(breadboard=40e3, laser_head=2.6e3, pump_module=3.1e3, camera=0.6e3, mount_a=0.45e3, mount_b=0.4e3, stage=4e3),
          [("laser_head", "breadboard", 1.8), ("pump_module", "breadboard", 2.2), ("camera", "breadboard", 0.5), ("mount_a", "breadboard", 0.35), ("mount_b", "breadboard", 0.3), ("stage", "breadboard", 2.6), ("laser_head", "hall", 0.7),
           ("pump_module", "hall", 1.1), ("camera", "hall", 0.25), ("mount_a", "hall", 0.12), ("mount_b", "hall", 0.1), ("stage", "hall", 0.4), ("breadboard", "hall", 5.5)])
    m.heat("cutting_heat", "pump_module", rounded(rng.uniform(0.4, 0.55), 2))
    m.heat("cutting_heat", "laser_head", rounded(rng.uniform(0.12, 0.25), 2))
    m.heat("heat_source", "camera", v(6))
    m.displacement("beam_x", "x", {"mount_a": v(0.9), "mount_b": -v(0.8), "stage": v(0.6)})
    m.displacement("beam_y", "y", {"breadboard": v(1.5), "laser_head": -v(0.7)})
    m.displacement("focus", "z", {"camera": v(0.5), "breadboard": v(0.9)})
    return m, dict(hours=(2, 10), drive="power", power=110, seen="displacements")


def traction_motor(rng, v):
    m = Machine("traction_motor")
    build(m, v, dict(rotor=9e3, winding=3.2e3, end_winding=1.2e3, stator=14e3, jacket=8e3, bearing_drive=0.9e3, bearing_free=0.6e3),
          [("winding", "stator", 42), ("end_winding", "winding", 13), ("stator", "jacket", 95), ("rotor", "stator", 4.5), ("rotor", "end_winding", 1.2), ("bearing_drive", "rotor", 5), ("bearing_free", "rotor", 4), ("bearing_drive", "jacket", 8),
           ("bearing_free", "jacket", 7), ("jacket", "hall", 6)])
    m.circuit("jacket", v(7), v(120), rounded(rng.uniform(25, 45)))
    m.heat("cutting_heat", "winding", rounded(rng.uniform(0.018, 0.03), 2))
    m.heat("cutting_heat", "end_winding", rounded(rng.uniform(0.007, 0.012), 2))
    m.heat("heat_source", "rotor", v(240), 9000, rounded(rng.uniform(1.2, 1.9)))
    m.heat("heat_source", "bearing_drive", v(55), 9000, rounded(rng.uniform(0.9, 1.5)))
    m.heat("friction_law", "bearing_free", v(40), 9000, rounded(rng.uniform(0.9, 1.5)), decay=v(0.013))
    m.displacement("shaft_growth", "z", {"rotor": v(2.6), "jacket": -v(1.4)})
    return m, dict(hours=(0.7, 3.5), drive="speed+power", top=9000, power=38e3)


def climate_cabinet(rng, v):
    """Air in the middle of everything; the heater's power is recorded, the cold wall is a circuit."""
    m = Machine("climate_cabinet")
    build(m, v, dict(air=4e3, liner=22e3, insulation=30e3, outer=26e3, specimen=15e3, floor=42e3), [])
    m.air.add("air")
    for a, b, g in [("air", "liner", 14), ("liner", "insulation", 5), ("insulation", "outer", 5), ("outer", "hall", 16), ("air", "specimen", 6), ("floor", "liner", 4), ("floor", "hall", 5), ("specimen", "floor", 1.1), ("air", "hall", 0.9)]:
        m.link(a, b, v(g))
    m.circuit("liner", v(0.7), v(9), rounded(rng.uniform(2, 14)))
    m.heat("cutting_heat", "air", rounded(rng.uniform(0.5, 0.75), 2))
    m.heat("heat_source", "air", v(38))
    return m, dict(hours=(4, 18), drive="power", power=700)


def tyre_drum(rng, v):
    m = Machine("tyre_drum")
    build(m, v, dict(drum=0.4e6, tyre=14e3, rim=9e3, hub=5e3, arm=60e3),
          [("tyre", "drum", 8), ("tyre", "rim", 4), ("tyre", "hall", 8), ("rim", "hub", 9), ("hub", "arm", 10), ("drum", "hall", 30), ("rim", "hall", 4), ("arm", "hall", 10)])
    m.heat("heat_source", "tyre", v(620), 1000, rounded(rng.uniform(1.1, 1.9)))
    m.heat("friction_law", "hub", v(75), 1000, rounded(rng.uniform(0.8, 1.4)), decay=v(0.012))
    m.heat("heat_source", "drum", v(240), 1000, rounded(rng.uniform(1.8, 2.6)))
    m.displacement("radius", "x", {"tyre": v(2.5), "rim": v(1.0)})
    m.displacement("arm_y", "y", {"arm": v(2.3), "hub": v(0.7)})
    return m, dict(hours=(1.8, 8), drive="speed", top=1000)


def bridge_saw(rng, v):
    """Speed, feed and motor power are all recorded."""
    m = Machine("bridge_saw")
    build(m, v, dict(flange=4e3, spindle_box=16e3, motor=18e3, carriage=55e3, bridge=0.24e6, pier_left=0.3e6, pier_right=0.29e6, tray=0.12e6),
          [("flange", "spindle_box", 11), ("flange", "hall", 3), ("spindle_box", "carriage", 18), ("motor", "carriage", 8), ("motor", "hall", 12), ("carriage", "bridge", 22), ("carriage", "hall", 7), ("bridge", "pier_left", 20),
           ("bridge", "pier_right", 19), ("bridge", "hall", 24), ("pier_left", "hall", 16), ("pier_right", "hall", 15), ("tray", "hall", 14), ("tray", "pier_left", 6), ("tray", "pier_right", 5)])
    m.heat("heat_source", "spindle_box", v(190), 3600, rounded(rng.uniform(1.0, 1.6)))
    m.heat("motor_loss", "motor", v(230), 3600, rounded(rng.uniform(1.0, 1.9)), idle=v(60))
    m.heat("cutting_heat", "flange", rounded(rng.uniform(0.012, 0.03), 2))
    m.heat("cutting_heat", "tray", rounded(rng.uniform(0.06, 0.14), 2))
    m.heat("servo_loss", "carriage", v(110), 0.2, rounded(rng.uniform(0.8, 1.4)), axis="x")
    m.displacement("cut_z", "z", {"flange": v(0.8), "spindle_box": v(1.9), "bridge": v(2.3)})
    m.displacement("cut_y", "y", {"bridge": v(3.1), "pier_left": -v(1.6), "pier_right": -v(1.5)})
    return m, dict(hours=(3, 11), drive="speed+power", top=3600, power=7000, feeds={"x": 12000})


def twin_spindle_station(rng, v):
    """Eleven bodies: two spindles alike in one casting, at one speed."""
    m = Machine("twin_spindle_station")
    sides = dict(quill=11e3, front=2.2e3, rear=1.7e3, drive=16e3)
    build(m, v, {**{f"{b}_{s}": c for s in "ab" for b, c in sides.items()}, "casting": 0.33e6, "slide": 60e3, "base": 0.5e6}, [])
    for s in "ab":
        for a, b, g in [("front", "quill", 15), ("rear", "quill", 11), ("front", "casting", 30), ("rear", "casting", 24), ("drive", "casting", 10), ("drive", "hall", 9)]:
            m.link(f"{a}_{s}", b if b in ("casting", "hall") else f"{b}_{s}", v(g))
    for a, b, g in [("casting", "slide", 40), ("slide", "base", 30), ("casting", "hall", 26), ("base", "hall", 34)]:
        m.link(a, b, v(g))
    for s in "ab":
        m.heat("heat_source", f"front_{s}", v(180), 6000, rounded(rng.uniform(1.0, 1.7)))
        m.heat("heat_source", f"rear_{s}", v(90), 6000, rounded(rng.uniform(1.0, 1.6)))
        m.heat("motor_loss", f"drive_{s}", v(260), 6000, rounded(rng.uniform(1.0, 2.0)), idle=v(50))
    m.heat("servo_loss", "slide", v(120), 0.25, rounded(rng.uniform(0.8, 1.3)), axis="z")
    m.displacement("tip_a", "z", {"quill_a": v(2.6), "casting": v(1.2)})
    m.displacement("tip_b", "z", {"quill_b": v(2.5), "casting": v(1.3)})
    m.displacement("pitch", "x", {"casting": v(2.0), "base": -v(1.3)})
    return m, dict(hours=(3, 9), drive="speed", top=6000, feeds={"z": 15000})


def oil_transformer(rng, v):
    """Oil goes round: up through the winding, down through the radiator; the load is recorded."""
    m = Machine("oil_transformer")
    build(m, v, dict(winding=0.2e6, core=0.7e6, top_oil=0.6e6, bottom_oil=0.55e6, tank=0.3e6, radiator=0.25e6),
          [("winding", "top_oil", 160), ("top_oil", "radiator", 210), ("radiator", "bottom_oil", 200), ("bottom_oil", "winding", 60), ("core", "top_oil", 70), ("core", "bottom_oil", 55), ("tank", "top_oil", 60), ("tank", "bottom_oil", 50),
           ("tank", "hall", 45), ("radiator", "hall", 250)])
    m.heat("cutting_heat", "winding", rounded(rng.uniform(0.009, 0.016), 2))
    m.heat("heat_source", "core", v(800))
    m.displacement("tank_lift", "z", {"tank": v(7.5), "radiator": v(1.2)})
    return m, dict(hours=(40, 140), drive="power", power=380e3, outdoor=True, days=True)


def cold_store(rng, v):
    """It is cooled down while the weather goes on outside; the fan's speed is recorded."""
    m = Machine("cold_store")
    build(m, v, dict(air=60e3, evaporator=45e3, goods=3.5e6, walls=1.2e6, floor=2.4e6), [])
    m.air.add("air")
    for a, b, g in [("air", "evaporator", 420), ("air", "goods", 210), ("air", "walls", 250), ("walls", "hall", 85), ("air", "floor", 110), ("air", "hall", 28), ("floor", "goods", 40)]:
        m.link(a, b, v(g))
    m.circuit("evaporator", v(12), v(280), rounded(rng.uniform(-3, 5)))
    m.heat("heat_source", "air", v(650), 1400, rounded(rng.uniform(2.0, 2.9)))
    m.heat("heat_source", "floor", v(180))
    m.start = rounded(rng.uniform(6, 18))
    return m, dict(hours=(30, 130), drive="speed", top=1400, outdoor=True, days=True)


def dental_mill(rng, v):
    """Small and quick: speed and two feeds, rows of seconds."""
    m = Machine("dental_mill")
    build(m, v, dict(spindle=0.7e3, holder=0.95e3, x_slide=2.3e3, column=6.2e3, base=14e3, blank=0.16e3),
          [("spindle", "holder", 3.2), ("holder", "column", 2.4), ("holder", "hall", 0.5), ("x_slide", "base", 3.1), ("column", "base", 4.5), ("blank", "x_slide", 0.5), ("blank", "hall", 0.06), ("column", "hall", 1.3), ("base", "hall", 2.7),
           ("x_slide", "hall", 0.6)])
    m.heat("motor_loss", "spindle", v(34), 40000, rounded(rng.uniform(1.2, 2.1)), idle=v(6))
    m.heat("servo_loss", "x_slide", v(16), 0.05, rounded(rng.uniform(0.8, 1.4)), idle=v(3), axis="x")
    m.heat("servo_loss", "column", v(13), 0.05, rounded(rng.uniform(0.9, 1.5)), idle=v(4), axis="z")
    m.displacement("mill_z", "z", {"spindle": v(0.9), "holder": v(1.1), "column": v(1.7)})
    m.displacement("mill_x", "x", {"x_slide": v(1.6), "base": -v(1.2)})
    return m, dict(hours=(0.6, 2.8), drive="speed", top=40000, feeds={"x": 3000, "z": 3000})


FAMILIES = [pump_bracket, diode_bar, slewing_ring, planer_bed, optical_table, traction_motor, climate_cabinet, tyre_drum, bridge_saw, twin_spindle_station, oil_transformer, cold_store, dental_mill]
TITLES = dict(pump_bracket="bearing bracket of a pump", diode_bar="bar of laser diodes on a cooled block; its electric power is recorded", slewing_ring="slewing ring of a heavy turntable", planer_bed="planer with a long bed",
              optical_table="modules on an optical table; the laser's electric power is recorded", traction_motor="traction motor on a test bench; speed and shaft power are recorded",
              climate_cabinet="climate cabinet with a specimen; the heater's power is recorded", tyre_drum="tyre on a test drum", bridge_saw="bridge saw for stone; the motor's power is recorded",
              twin_spindle_station="station of a transfer line with two spindles", oil_transformer="transformer in oil, in the open; its load is recorded", cold_store="cold store with goods; the fan's speed is recorded",
              dental_mill="desktop mill for dental work")

COLUMNS = dict(column_heat=[("window_sun", "W_m2"), ("tracer", "W"), ("bulb", "V")], column_opening=[("louvre", "percent"), ("curtain", "1")])
DECOYS = COLUMNS["column_heat"] + COLUMNS["column_opening"] + [("supply", "degC"), ("pallets", "count")]


def drive(rng, time_s, style, top, days=False):
    """A column from 0 to `top`, held from each row on. `staircase` up and down again; `spectrum` of random levels of equal length; `constant` from the first row for most of the time, then rest; `warm_cool` rest, run, rest; `shop` jobs
    and pauses of any length; `pulses` in one rhythm; `ramps` between levels. `days`: at night there is little or nothing."""
    total = time_s[-1]
    share = time_s / total
    if style == "staircase":
        n = int(rng.integers(4, 8))
        up = np.arange(1, n + 1) / n
        levels = np.concatenate([up, up[-2::-1], [0.0]])
        out = levels[np.minimum((share * len(levels)).astype(int), len(levels) - 1)]
    elif style == "spectrum":
        n = int(rng.integers(9, 25))
        levels = np.where(rng.random(n) < 0.2, 0.0, np.round(rng.uniform(0.15, 1, n), 2))
        out = levels[np.minimum((share * n).astype(int), n - 1)]
    elif style == "constant":
        out = np.where(share < rng.uniform(0.5, 0.85), round(rng.uniform(0.5, 1), 2), 0.0)
    elif style == "warm_cool":
        a = rng.uniform(0.05, 0.15)
        out = np.where((share > a) & (share < a + rng.uniform(0.35, 0.6)), round(rng.uniform(0.6, 1), 2), 0.0)
        if rng.random() < 0.5:
            out[share > 0.85] = round(rng.uniform(0.3, 0.6), 2)
    elif style == "shop":
        out, t = np.zeros(len(time_s)), 0.0
        while t < 1:
            job, pause = 0.05 * np.exp(0.8 * rng.standard_normal()), 0.02 * np.exp(0.9 * rng.standard_normal())
            out[(share >= t) & (share < t + job)] = rng.choice([0.3, 0.45, 0.6, 0.8, 1.0])
            t += job + pause
    elif style == "pulses":
        period, duty = rng.uniform(0.04, 0.2), rng.uniform(0.3, 0.75)
        out = np.where((share / period + rng.random()) % 1 < duty, round(rng.uniform(0.6, 1), 2), 0.0)
    else:
        at = np.sort(np.append(rng.uniform(0, 1, int(rng.integers(4, 9))), [0, 1]))
        out = np.round(16 * np.interp(share, at, np.clip(rng.uniform(-0.25, 1.1, len(at)), 0, 1))) / 16
    if days and style not in ("constant", "staircase"):
        hour = (time_s / 3600 + rng.uniform(0, 24)) % 24
        out = np.where((hour > 6) & (hour < rng.uniform(17, 23)), out, 0.3 * out if rng.random() < 0.5 else 0.0)
    return float(top) * out


def further(rng, time_s, unit):
    total = time_s[-1]
    if unit == "degC":
        return np.round(rng.uniform(10, 40) + rng.uniform(2, 9) * drive(rng, time_s, "spectrum", 1.0) + rng.uniform(0.2, 1) * np.sin(2 * np.pi * time_s / (rng.uniform(0.1, 0.4) * total)), 1)
    if unit == "W_m2":
        sky = np.clip(1.2 * np.cos(2 * np.pi * (time_s - rng.uniform(0.2, 0.8) * total) / max(86400, 1.6 * total)), 0, 1) if total < 86400 else np.clip(np.cos(2 * np.pi * (time_s / 86400 - rng.random())), 0, 1)
        return np.round(760 * sky * (1 - 0.6 * (drive(rng, time_s, "shop", 1.0) > 0.5)))
    if unit == "1":
        return (drive(rng, time_s, str(rng.choice(["shop", "pulses", "spectrum"])), 1.0) > 0.4).astype(float)
    if unit == "percent":
        return np.round(4 * drive(rng, time_s, str(rng.choice(["spectrum", "shop", "ramps"])), 1.0)) * 25
    return np.round(drive(rng, time_s, str(rng.choice(["spectrum", "shop", "warm_cool"])), {"V": 24, "W": 300, "count": 30}[unit]), 1 if unit == "V" else 0)


def hall(rng, time_s, outdoor):
    """Day and night outdoors with a front that passes; indoors a rising forenoon, an air conditioner's teeth, or next to nothing."""
    hours = time_s / 3600
    if outdoor:
        y = rng.uniform(2, 20) + rng.uniform(2, 6) * np.cos(2 * np.pi * (hours - rng.uniform(0, 24)) / 24)
        y = y + rng.uniform(-6, 6) / (1 + np.exp(-(hours - rng.uniform(0.2, 0.8) * hours[-1]) / 3))
    else:
        y = np.full(len(hours), rng.uniform(18, 26))
        kind = str(rng.choice(["forenoon", "teeth", "still", "day"]))
        if kind == "forenoon":
            y = y + rng.uniform(0.8, 4) * (1 - np.exp(-hours / max(0.5, rng.uniform(0.3, 0.9) * hours[-1])))
        elif kind == "teeth":
            y = y + rng.uniform(0.3, 1.0) * (hours / rng.uniform(0.2, 0.6) % 1 - 0.5)
        elif kind == "day":
            y = y + rng.uniform(0.8, 2.5) * np.sin(2 * np.pi * (hours + rng.uniform(0, 24)) / 24)
    walk, x, tau = np.empty(len(hours)), 0.0, rng.uniform(0.1, 0.4) * hours[-1]
    for k in range(len(hours)):
        e = np.exp(-(hours[k] - hours[k - 1]) / tau) if k else 0.0
        x = e * x + np.sqrt(1 - e * e) * (0.6 if outdoor else 0.2) * rng.standard_normal()
        walk[k] = x
    return np.round(y + np.convolve(np.pad(walk, 6, mode="edge"), np.ones(13) / 13, mode="valid"), 2)


def pace(rng, plan):
    """Of all records of a case [s]; and how many rows they have, about."""
    n = np.exp(rng.uniform(np.log(300), np.log(800)) if rng.random() < 0.85 else rng.uniform(np.log(800), np.log(1500)))
    span = 3600 * np.exp(rng.uniform(*np.log(plan["hours"])))
    return min(PACES, key=lambda d: abs(np.log(d * n / span))), n


def rows(rng, style, dt, n):
    """Times [s]: even; uneven (one, two or three paces from row to row, as they come); dropped (one of twelve is missing)."""
    n = int(np.clip(round(n * rng.uniform(0.85, 1.2)), 300, 1500))
    if style == "uneven":
        steps = rng.choice([1, 2, 3], n - 1, p=[0.7, 0.2, 0.1])
        steps[0] = 1
        return np.append(0.0, np.cumsum(steps * float(dt)))
    t = np.arange(n) * float(dt)
    if style == "dropped":
        t = t[(rng.random(n) > 1 / 12) | (np.arange(n) < 2) | (np.arange(n) == n - 1)]
    return t


def with_hole(rng, time_s):
    """The logger was off for a twentieth to a sixth of the record."""
    a, b = rng.uniform(0.15, 0.75), rng.uniform(0.05, 0.16)
    return time_s[(time_s < a * time_s[-1]) | (time_s > (a + b) * time_s[-1])]


def record(rng, name, plan, time_s, styles, column=None):
    """styles: of speed, of power, of feeds."""
    n, days = len(time_s), plan.get("days", False)
    speed, power, feeds = np.zeros(n), np.zeros(n), {}
    if "top" in plan:
        speed = np.round(drive(rng, time_s, styles[0], plan["top"], days), 0 if plan["top"] > 100 else 1)
    if "power" in plan:
        power = drive(rng, time_s, styles[1], plan["power"], days)
        power = np.array([float(f"{p:.4g}") for p in (np.where(speed > 0, power, 0.0) if plan["drive"] == "speed+power" else power)])
    for axis, top in plan.get("feeds", {}).items():
        feeds[axis] = np.round(drive(rng, time_s, styles[2], top), 0) / 60000
    columns = {column[0]: (column[1], further(rng, time_s, column[1]))} if column else {}
    return Record(name, time_s, speed, feeds, power, hall(rng, time_s, plan.get("outdoor", False)), columns)


def instruments(rng, machine, plan):
    """Thermometers are numbered; some bodies have none, some have two."""
    seen = str(rng.choice(["both", "temperatures", "displacements"], p=[0.5, 0.27, 0.23]))
    if not machine.displacements:
        seen = "temperatures"
    elif plan.get("seen") and rng.random() < 0.7:
        seen = plan["seen"]
    bodies = [str(b) for b in rng.permutation(machine.bodies)]
    count = 0 if seen == "displacements" else int(rng.integers(max(1, len(bodies) // 3), len(bodies) + 1)) if seen == "both" else int(rng.integers(max(2, len(bodies) // 2), len(bodies) + 4))
    places = (bodies + [bodies[int(i)] for i in rng.integers(len(bodies), size=4)])[:count]
    machine.sensors = [(f"T{i + 1}", b) for i, b in enumerate(places)]
    gone = [d[0] for d in machine.displacements] if seen == "temperatures" else []
    if len(machine.displacements) > 1 and seen != "temperatures" and rng.random() < 0.3:
        gone = [machine.displacements[int(rng.integers(len(machine.displacements)))][0]]
    machine.displacements = [d for d in machine.displacements if d[0] not in gone]
    machine.numbers = {k: x for k, x in machine.numbers.items() if not (k.startswith("S ") and k.split()[1] in gone)}
    kind = rng.random()
    if kind < 0.55:
        temperature = dict(sigma=float(rng.choice([0.02, 0.03, 0.05, 0.08, 0.15])), step=0.001)
    else:
        temperature = dict(sigma=float(rng.choice([0.03, 0.05, 0.07])), step=0.1 if kind < 0.8 else 0.0625)
    displacement = dict(sigma=rounded(np.exp(rng.uniform(np.log(0.1), np.log(1.0))), 2), step=float(rng.choice([0.01, 0.1], p=[0.7, 0.3])))
    return dict(temperature=temperature, displacement=displacement, coloured=dict(share=0.0, minutes=0.0)), seen
