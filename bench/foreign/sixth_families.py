"""Fifteen more families of machines, for the set `sixth` (README.md), of two to ten bodies: parallel struts, combs, a loop over a bed, a rotor that hardly touches anything; driven as production and test floors do."""
import numpy as np

import fifth_families
from families import rounded
from network import Machine, Record
from third_families import build

PACES = (2, 5, 10, 15, 20, 30, 60, 90, 120, 180, 300, 600, 900, 1200)      # of the logger, or of who reads the dials [s]
STYLES = ["series", "breaks", "teeth", "binary", "soak_steps", "tool_list", "octaves", "decline"]


def eddy_dynamometer(rng, v):
    """Absorbs what another machine gives; its power is recorded, and most of it goes with the water."""
    m = Machine("eddy_dynamometer")
    build(m, v, dict(rotor=18e3, coil=4e3, yoke=42e3, bearing=1.5e3), [("rotor", "yoke", 21), ("coil", "yoke", 14), ("bearing", "rotor", 4), ("bearing", "yoke", 6), ("yoke", "hall", 10)])
    m.circuit("yoke", v(16), v(500), rounded(rng.uniform(14, 30)))
    m.heat("cutting_heat", "yoke", rounded(rng.uniform(0.12, 0.25), 2))
    m.heat("cutting_heat", "rotor", rounded(rng.uniform(0.01, 0.02), 2))
    m.heat("heat_source", "rotor", v(260), 6000, rounded(rng.uniform(2.0, 2.8)))
    m.heat("friction_law", "bearing", v(60), 6000, rounded(rng.uniform(0.9, 1.5)), decay=v(0.012))
    m.displacement("air_gap", "x", {"rotor": v(1.9), "yoke": -v(1.5)})
    return m, dict(hours=(0.8, 4.5), drive="speed+power", top=6000, power=55e3)


def turbo_pump(rng, v):
    """A rotor in a vacuum: it gives its heat away by next to nothing."""
    m = Machine("turbo_pump")
    build(m, v, dict(rotor=1.3e3, stator=2.6e3, base=4.2e3, ball_bearing=0.14e3, flange=3.4e3, controller=1.4e3),
          [("rotor", "stator", 0.2), ("rotor", "ball_bearing", 0.14), ("ball_bearing", "base", 0.8), ("stator", "base", 7), ("stator", "flange", 4), ("controller", "base", 1.3), ("controller", "hall", 0.9), ("flange", "hall", 1.4), ("base", "hall", 0.8)])
    m.circuit("base", v(0.8), v(9), rounded(rng.uniform(17, 28)))
    m.heat("heat_source", "rotor", v(7), 48000, rounded(rng.uniform(2.0, 2.8)))
    m.heat("motor_loss", "stator", v(32), 48000, rounded(rng.uniform(1.1, 2.0)), idle=v(6))
    m.heat("friction_law", "ball_bearing", v(7), 48000, rounded(rng.uniform(0.9, 1.5)), decay=v(0.012))
    m.heat("heat_source", "controller", v(11))
    m.displacement("clearance", "z", {"rotor": v(2.1), "stator": -v(1.6)})
    return m, dict(hours=(1.5, 9), drive="speed", top=48000)


def hexapod_mill(rng, v):
    """Six struts side by side between a frame and a platform."""
    m = Machine("hexapod_mill")
    struts = [f"strut_{i + 1}" for i in range(6)]
    build(m, v, {"frame": 0.42e6, **{s: 9e3 for s in struts}, "platform": 36e3, "spindle": 9e3}, [(s, "frame", 7) for s in struts] + [(s, "platform", 5) for s in struts])
    for a, b, g in [("spindle", "platform", 22), ("platform", "hall", 8), ("frame", "hall", 34)] + [(s, "hall", 2.2) for s in struts]:
        m.link(a, b, v(g))
    for i, s in enumerate(struts):
        m.heat("servo_loss", s, v(75), 0.3, rounded(rng.uniform(0.8, 1.5)), idle=v(12) if i % 2 else 0.0, axis="xy"[i % 2])
    m.heat("heat_source", "spindle", v(240), 15000, rounded(rng.uniform(1.1, 1.8)))
    m.displacement("height", "z", {"strut_1": v(1.6), "strut_3": v(1.6), "strut_5": v(1.6), "spindle": v(2.2)})
    m.displacement("tilt_x", "x", {"strut_1": v(3.0), "strut_4": -v(3.1)})
    m.displacement("tilt_y", "y", {"strut_2": v(2.9), "strut_6": -v(2.8), "frame": v(0.7)})
    return m, dict(hours=(1.5, 7), drive="speed", top=15000, feeds={"x": 20000, "y": 20000})


def honing_machine(rng, v):
    """Stone and liner in a bath of oil; speed and stroke are recorded."""
    m = Machine("honing_machine")
    build(m, v, dict(stone=0.9e3, spindle=9e3, liner=4.5e3, oil=70e3, fixture=30e3, column=0.19e6),
          [("stone", "spindle", 2.5), ("stone", "oil", 14), ("liner", "oil", 42), ("liner", "fixture", 18), ("stone", "liner", 3), ("fixture", "column", 9), ("spindle", "column", 12), ("oil", "hall", 15), ("column", "hall", 17), ("fixture", "oil", 6)])
    m.heat("heat_source", "stone", v(220), 400, rounded(rng.uniform(0.9, 1.4)))
    m.heat("heat_source", "liner", v(520), 400, rounded(rng.uniform(0.9, 1.4)))
    m.heat("motor_loss", "spindle", v(140), 400, rounded(rng.uniform(1.0, 1.8)), idle=v(30))
    m.heat("servo_loss", "column", v(170), 0.4, rounded(rng.uniform(0.9, 1.5)), axis="z")
    m.displacement("bore", "x", {"liner": v(1.4), "stone": -v(0.8)})
    m.displacement("stroke_end", "z", {"column": v(2.4), "spindle": v(1.5), "fixture": -v(1.1)})
    return m, dict(hours=(1.2, 6), drive="speed", top=400, feeds={"z": 24000})


def laminating_press(rng, v):
    """Two heated platens and what lies between them; the heaters' power is recorded."""
    m = Machine("laminating_press")
    build(m, v, dict(platen_up=62e3, platen_low=60e3, book=24e3, ram=80e3, frame=0.26e6),
          [("platen_up", "book", 38), ("platen_low", "book", 41), ("platen_up", "frame", 6), ("platen_low", "ram", 7), ("ram", "frame", 15), ("frame", "hall", 30), ("platen_up", "hall", 5), ("platen_low", "hall", 4), ("ram", "hall", 7), ("book", "hall", 2)])
    m.heat("cutting_heat", "platen_up", rounded(rng.uniform(0.28, 0.4), 2))
    m.heat("cutting_heat", "platen_low", rounded(rng.uniform(0.28, 0.4), 2))
    m.heat("heat_source", "ram", v(120))
    m.displacement("daylight", "z", {"platen_up": v(0.6), "platen_low": v(0.6), "ram": v(1.6), "frame": -v(3.2)})
    m.displacement("bow", "y", {"platen_up": v(1.3), "frame": -v(1.1)})
    return m, dict(hours=(4, 18), drive="power", power=2200)


def fatigue_frame(rng, v):
    """A servohydraulic rig: nothing is recorded but the speed of the stroke."""
    m = Machine("fatigue_frame")
    build(m, v, dict(specimen=0.35e3, grip_up=12e3, grip_low=12.5e3, load_cell=5e3, actuator=42e3, crosshead=0.13e6, columns=0.17e6),
          [("specimen", "grip_up", 1.6), ("specimen", "grip_low", 1.7), ("specimen", "hall", 0.25), ("grip_up", "load_cell", 9), ("load_cell", "crosshead", 11), ("grip_low", "actuator", 8), ("crosshead", "columns", 24), ("actuator", "columns", 7),
           ("columns", "hall", 18), ("crosshead", "hall", 9), ("grip_up", "hall", 1.5), ("grip_low", "hall", 1.4)])
    m.circuit("actuator", v(3), v(30), rounded(rng.uniform(28, 44)))
    m.heat("servo_loss", "specimen", v(46), 0.25, rounded(rng.uniform(1.1, 1.9)), axis="z")
    m.heat("servo_loss", "actuator", v(380), 0.25, rounded(rng.uniform(0.8, 1.4)), idle=v(60), axis="z")
    m.displacement("stroke", "z", {"specimen": v(0.7), "actuator": v(2.1), "columns": -v(4.0)})
    m.displacement("extensometer", "z", {"specimen": v(0.5), "grip_low": v(0.3)})
    return m, dict(hours=(1, 7), drive="feeds", feeds={"z": 15000})


def air_bearing_table(rng, v):
    """Seen by capacitive probes; the supplied air is a circuit."""
    m = Machine("air_bearing_table")
    build(m, v, dict(rotor=15e3, stator=22e3, motor=3.2e3, granite=0.55e6), [("rotor", "stator", 5), ("stator", "granite", 7), ("motor", "rotor", 1.5), ("motor", "granite", 2.6), ("rotor", "hall", 1.8), ("granite", "hall", 14), ("stator", "hall", 1.2)])
    m.circuit("stator", v(0.12), v(3), rounded(rng.uniform(16, 24)))
    m.heat("heat_source", "stator", v(24), 600, rounded(rng.uniform(1.8, 2.3)))
    m.heat("motor_loss", "motor", v(42), 600, rounded(rng.uniform(1.0, 2.0)), idle=v(8))
    m.displacement("axial", "z", {"rotor": v(1.5), "stator": -v(0.9)})
    m.displacement("radial", "x", {"stator": v(1.2), "granite": v(2.0)})
    m.displacement("ring_tilt", "y", {"motor": v(0.35), "granite": -v(1.4)})
    return m, dict(hours=(3, 15), drive="speed", top=600, seen="displacements")


def dough_kneader(rng, v):
    """The motor's power is recorded; most of it ends in the dough."""
    m = Machine("dough_kneader")
    build(m, v, dict(dough=48e3, bowl=14e3, hook=6e3, gearbox=23e3), [("dough", "bowl", 28), ("dough", "hook", 11), ("hook", "gearbox", 3), ("bowl", "hall", 8), ("gearbox", "hall", 9), ("dough", "hall", 3), ("bowl", "gearbox", 1.4)])
    m.heat("cutting_heat", "dough", rounded(rng.uniform(0.5, 0.75), 2))
    m.heat("cutting_heat", "gearbox", rounded(rng.uniform(0.06, 0.12), 2))
    m.heat("heat_source", "gearbox", v(90), 250, rounded(rng.uniform(0.9, 1.6)))
    return m, dict(hours=(1, 6), drive="speed+power", top=250, power=750)


def elevator_machine(rng, v):
    """Motor, sheave and brake in a small room; there is little traffic at night."""
    m = Machine("elevator_machine")
    build(m, v, dict(motor=40e3, sheave=68e3, brake=6e3, bedplate=0.1e6, room_air=60e3, walls=1.6e6), [])
    m.air.add("room_air")
    for a, b, g in [("motor", "sheave", 12), ("motor", "bedplate", 9), ("motor", "room_air", 14), ("sheave", "room_air", 12), ("sheave", "bedplate", 7), ("brake", "sheave", 3), ("brake", "room_air", 2.4), ("bedplate", "walls", 6), ("room_air", "walls", 60),
                    ("room_air", "hall", 25), ("walls", "hall", 45)]:
        m.link(a, b, v(g))
    m.heat("motor_loss", "motor", v(560), 180, rounded(rng.uniform(0.9, 1.8)), idle=v(90))
    m.heat("heat_source", "brake", v(110), turning=True)
    m.heat("heat_source", "sheave", v(140), 180, rounded(rng.uniform(0.8, 1.4)))
    m.heat("heat_source", "room_air", v(160))
    return m, dict(hours=(8, 60), drive="speed", top=180, days=True)


def inverter_cabinet(rng, v):
    """From seconds to an hour; the load's power and the fan's speed are recorded."""
    m = Machine("inverter_cabinet")
    build(m, v, dict(chip=75, heatsink=2.5e3, choke=3.6e3, capacitor=0.9e3, busbar=0.7e3, inner_air=1.5e3, enclosure=16e3), [])
    m.air.add("inner_air")
    for a, b, g in [("chip", "heatsink", 16), ("heatsink", "inner_air", 6), ("heatsink", "hall", 6), ("choke", "inner_air", 3), ("capacitor", "inner_air", 1.1), ("busbar", "inner_air", 0.9), ("busbar", "chip", 0.8), ("capacitor", "busbar", 0.6),
                    ("inner_air", "enclosure", 12), ("inner_air", "hall", 4), ("enclosure", "hall", 11)]:
        m.link(a, b, v(g))
    m.heat("cutting_heat", "chip", rounded(rng.uniform(0.011, 0.018), 2))
    m.heat("cutting_heat", "choke", rounded(rng.uniform(0.003, 0.005), 2))
    m.heat("cutting_heat", "busbar", rounded(rng.uniform(0.0008, 0.0014), 2))
    m.heat("heat_source", "inner_air", v(26), 2800, rounded(rng.uniform(2.0, 2.9)))
    m.heat("heat_source", "capacitor", v(5))
    return m, dict(hours=(0.5, 3), drive="speed+power", top=2800, power=15e3)


def roll_grinder(rng, v):
    """Ten bodies: a roll in four pieces between the two ends of a bed, washed from one tank."""
    m = Machine("roll_grinder")
    zones = [f"roll_{i + 1}" for i in range(4)]
    build(m, v, {**{z: 0.28e6 for z in zones}, "headstock": 62e3, "tailstock": 26e3, "bed": 0.9e6, "wheelhead": 90e3, "wheel_spindle": 13e3, "tank": 0.42e6}, [(zones[i], zones[i + 1], 55) for i in range(3)])
    for a, b, g in [(z, "tank", 26) for z in zones] + [("headstock", "roll_1", 12), ("tailstock", "roll_4", 10), ("headstock", "bed", 23), ("tailstock", "bed", 17), ("wheelhead", "bed", 24), ("wheel_spindle", "wheelhead", 27), ("headstock", "hall", 8),
                                                      ("wheelhead", "hall", 9), ("bed", "hall", 38), ("tank", "hall", 24)]:
        m.link(a, b, v(g))
    m.circuit("tank", v(5), v(90), rounded(rng.uniform(18, 25)))
    m.heat("friction_law", "wheel_spindle", v(360), 1500, rounded(rng.uniform(1.0, 1.6)), decay=v(0.011))
    m.heat("motor_loss", "headstock", v(210), 1500, rounded(rng.uniform(0.9, 1.7)), idle=v(40))
    m.heat("cutting_heat", "tank", rounded(rng.uniform(0.25, 0.45), 2))
    m.heat("cutting_heat", "roll_2", rounded(rng.uniform(0.04, 0.09), 2))
    m.heat("cutting_heat", "roll_3", rounded(rng.uniform(0.04, 0.09), 2))
    m.displacement("diameter", "x", {"roll_2": v(3.6), "wheelhead": -v(1.8), "wheel_spindle": v(0.9)})
    m.displacement("crown", "y", {"roll_1": -v(1.7), "roll_3": v(3.3), "roll_4": -v(1.6)})
    m.displacement("bed_bend", "z", {"bed": v(3.5), "tailstock": -v(1.1)})
    return m, dict(hours=(4, 20), drive="speed+power", top=1500, power=7000)


def ship_shaft_line(rng, v):
    """A comb: bearings in a row, each of them on the hull."""
    m = Machine("ship_shaft_line")
    build(m, v, dict(gearbox=0.5e6, thrust=0.12e6, line_1=26e3, line_2=27e3, line_3=25e3, stern_tube=90e3, hull=2.8e6),
          [("gearbox", "thrust", 26), ("thrust", "line_1", 11), ("line_1", "line_2", 9), ("line_2", "line_3", 9), ("line_3", "stern_tube", 10), ("gearbox", "hull", 50), ("thrust", "hull", 22), ("line_1", "hull", 9), ("line_2", "hull", 9), ("line_3", "hull", 10),
           ("stern_tube", "hull", 18), ("gearbox", "hall", 16), ("line_1", "hall", 3), ("line_2", "hall", 3), ("line_3", "hall", 3), ("hull", "hall", 260)])
    m.circuit("gearbox", v(9), v(130), rounded(rng.uniform(26, 40)))
    m.circuit("stern_tube", v(6), v(60), rounded(rng.uniform(8, 20)))
    m.heat("heat_source", "gearbox", v(4200), 120, rounded(rng.uniform(1.3, 2.2)))
    m.heat("friction_law", "thrust", v(750), 120, rounded(rng.uniform(0.9, 1.6)), decay=v(0.01))
    for b, p in (("line_1", 230), ("line_2", 240), ("line_3", 220), ("stern_tube", 520)):
        m.heat("heat_source", b, v(p), 120, rounded(rng.uniform(0.9, 1.6)))
    return m, dict(hours=(10, 70), drive="speed", top=120, outdoor=True)


def sliding_headstock_lathe(rng, v):
    """Two spindles, a guide bush between them, two feeds, and oil over all of it."""
    m = Machine("sliding_headstock_lathe")
    build(m, v, dict(main_spindle=5.2e3, headstock=28e3, guide_bush=0.9e3, gang_slide=14e3, sub_spindle=3.6e3, sub_carriage=12e3, bed=0.15e6, oil=56e3),
          [("main_spindle", "headstock", 21), ("main_spindle", "guide_bush", 0.9), ("guide_bush", "bed", 4), ("guide_bush", "oil", 5), ("gang_slide", "bed", 8), ("gang_slide", "oil", 6), ("sub_spindle", "sub_carriage", 17), ("sub_carriage", "bed", 9),
           ("headstock", "bed", 12), ("bed", "oil", 12), ("bed", "hall", 17), ("oil", "hall", 8), ("headstock", "hall", 5), ("sub_carriage", "hall", 3)])
    m.heat("motor_loss", "main_spindle", v(240), 8000, rounded(rng.uniform(1.0, 1.9)), idle=v(40))
    m.heat("friction_law", "guide_bush", v(75), 8000, rounded(rng.uniform(0.9, 1.5)), decay=v(0.012))
    m.heat("heat_source", "sub_spindle", v(120), 8000, rounded(rng.uniform(1.1, 1.8)))
    m.heat("servo_loss", "gang_slide", v(80), 0.3, rounded(rng.uniform(0.8, 1.4)), idle=v(14), axis="x")
    m.heat("servo_loss", "headstock", v(90), 0.3, rounded(rng.uniform(0.8, 1.4)), axis="z")
    m.heat("heat_source", "oil", v(150), turning=True)
    m.displacement("diameter", "x", {"gang_slide": v(1.5), "guide_bush": -v(0.6), "bed": v(0.8)})
    m.displacement("length", "z", {"main_spindle": v(1.3), "headstock": v(1.7), "bed": -v(2.4)})
    m.displacement("transfer", "z", {"sub_spindle": v(1.2), "sub_carriage": v(1.6)})
    return m, dict(hours=(2, 9), drive="speed", top=8000, feeds={"x": 20000, "z": 20000})


def balancing_machine(rng, v):
    """A rotor on two pedestals, seen by their pickups."""
    m = Machine("balancing_machine")
    build(m, v, dict(rotor=31e3, pedestal_left=25e3, pedestal_right=24e3), [("rotor", "pedestal_left", 5), ("rotor", "pedestal_right", 4.6), ("rotor", "hall", 5), ("pedestal_left", "hall", 8), ("pedestal_right", "hall", 7.5)])
    m.heat("heat_source", "pedestal_left", v(95), 3000, rounded(rng.uniform(0.9, 1.6)))
    m.heat("friction_law", "pedestal_right", v(90), 3000, rounded(rng.uniform(0.9, 1.6)), decay=v(0.012))
    m.heat("heat_source", "rotor", v(170), 3000, rounded(rng.uniform(2.2, 3.0)))
    m.displacement("left", "y", {"pedestal_left": v(2.6), "rotor": v(0.8)})
    m.displacement("right", "y", {"pedestal_right": v(2.7), "rotor": v(0.8)})
    m.displacement("end_play", "z", {"rotor": v(3.4), "pedestal_left": -v(0.7)})
    return m, dict(hours=(1, 7), drive="speed", top=3000, seen="displacements")


def axle_box_rig(rng, v):
    """Two bodies."""
    m = Machine("axle_box_rig")
    build(m, v, dict(axle_bearing=8.5e3, box=46e3), [("axle_bearing", "box", 19), ("box", "hall", 13), ("axle_bearing", "hall", 1.6)])
    m.heat("friction_law", "axle_bearing", v(330), 1800, rounded(rng.uniform(0.9, 1.6)), decay=v(0.01))
    m.heat("heat_source", "box", v(70), 1800, rounded(rng.uniform(1.6, 2.6)))
    m.displacement("axle_end", "z", {"axle_bearing": v(1.7), "box": -v(1.1)})
    return m, dict(hours=(1.5, 12), drive="speed", top=1800)


FAMILIES = [eddy_dynamometer, turbo_pump, hexapod_mill, honing_machine, laminating_press, fatigue_frame, air_bearing_table, dough_kneader, elevator_machine, inverter_cabinet, roll_grinder, ship_shaft_line, sliding_headstock_lathe, balancing_machine,
            axle_box_rig]
TITLES = dict(eddy_dynamometer="eddy-current dynamometer; the absorbed power is recorded", turbo_pump="turbomolecular pump", hexapod_mill="milling machine on six struts", honing_machine="honing machine with an oil bath",
              laminating_press="laminating press; the heaters' power is recorded", fatigue_frame="servohydraulic frame for fatigue tests; the mean speed of the stroke is recorded", air_bearing_table="rotary table on air bearings",
              dough_kneader="kneader for dough; the motor's power is recorded", elevator_machine="machine room of an elevator", inverter_cabinet="cabinet of an inverter; load and fan are recorded", roll_grinder="grinding machine for rolls; the wheel's power is recorded",
              ship_shaft_line="shaft line of a ship", sliding_headstock_lathe="lathe with sliding headstock", balancing_machine="balancing machine with a rotor", axle_box_rig="test rig for axle boxes")

COLUMNS = dict(column_heat=[("skylight", "W_m2"), ("trace_heating", "W"), ("exciter", "V")], column_opening=[("shutter", "percent"), ("extraction", "1")])
DECOYS = COLUMNS["column_heat"] + COLUMNS["column_opening"] + [("mains", "degC"), ("parts", "count")]


def drive(rng, time_s, style, top, days=False):
    """A column from 0 to `top`, held from each row on. `series` of parts alike, then a set-up, then another series; `breaks` a shift with its breaks at fixed times; `teeth` levels that climb and fall back; `binary` two levels that change
    as a shift register does; `soak_steps` ever higher levels with a rest after each, then a long soak; `tool_list` a list of levels with short stops, over and over; `octaves` runs each twice as long as the one before; `decline` runs that
    become slower and rarer. `days`: at night there is little or nothing."""
    share = time_s / time_s[-1]
    out = np.zeros(len(time_s))
    if style == "series":
        t = rng.uniform(0, 0.08)
        while t < 1:
            parts, cycle, duty, level = int(rng.integers(4, 14)), rng.uniform(0.01, 0.04), rng.uniform(0.55, 0.85), round(rng.uniform(0.3, 1), 2)
            inside = (share >= t) & (share < t + parts * cycle)
            out[inside] = np.where(((share[inside] - t) / cycle) % 1 < duty, level, 0.0)
            t += parts * cycle + rng.uniform(0.04, 0.14)
    elif style == "breaks":
        begin, n, level = rng.uniform(0, 0.1), int(rng.integers(3, 6)), round(rng.uniform(0.5, 1), 2)
        block = (1 - begin) / n
        inside = (share >= begin) & ((share - begin) / block % 1 < rng.uniform(0.72, 0.9))
        out[inside] = level
        if rng.random() < 0.5:      # the last block goes at another rate
            out[inside & (share > begin + (n - 1) * block)] = round(0.6 * level, 2)
    elif style == "teeth":
        period = rng.uniform(0.08, 0.3)
        phase = (share / period + rng.random()) % 1
        out = np.ceil(6 * phase) / 6 * round(rng.uniform(0.6, 1), 2)
        out[phase > 0.85] = 0.0
    elif style == "binary":
        n, high = int(rng.integers(15, 40)), round(rng.uniform(0.65, 1), 2)
        low = 0.0 if rng.random() < 0.6 else round(rng.uniform(0.15, 0.4), 2)
        bits = rng.random(n) < 0.5
        bits[int(rng.integers(n // 2))], bits[n // 2 + int(rng.integers(n // 2))] = True, False
        out = np.where(bits[np.minimum((share * n).astype(int), n - 1)], high, low)
    elif style == "soak_steps":
        n, step = int(rng.integers(3, 6)), rng.uniform(0.07, 0.11)
        k = (share / step).astype(int)
        out = np.where((k < n) & ((share / step) % 1 < 0.75), np.round((k + 1) / n, 2), 0.0)
        out[(share > n * step) & (share < n * step + rng.uniform(0.2, 0.35))] = round(rng.uniform(0.6, 1), 2)
    elif style == "tool_list":
        n = int(rng.integers(4, 8))
        levels, lengths, period = np.round(rng.uniform(0.15, 1, n), 2), rng.uniform(0.3, 1, n), rng.uniform(0.1, 0.4)
        ends = np.cumsum(lengths) / lengths.sum()
        phase = (share / period) % 1
        k = np.minimum(np.searchsorted(ends, phase, side="right"), n - 1)
        begins = np.append(0.0, ends[:-1])[k]
        out = np.where(phase - begins < rng.uniform(0.02, 0.06), 0.0, levels[k])
    elif style == "octaves":
        t, length, rest, level = rng.uniform(0.01, 0.06), rng.uniform(0.015, 0.03), rng.uniform(0.02, 0.06), round(rng.uniform(0.6, 1), 2)
        while t < 1:
            out[(share >= t) & (share < t + length)] = level
            t, length = t + length + rest, 2 * length
    else:
        t, level, run = 0.0, 1.0, rng.uniform(0.08, 0.2)
        while t < 1:
            out[(share >= t) & (share < t + run)] = round(level, 2)
            t, level = t + run + rng.uniform(0.02, 0.12) / level, max(0.15, level * rng.uniform(0.65, 0.95))
    if days:
        hour = (time_s / 3600 + rng.uniform(0, 24)) % 24
        out = np.where((hour > 7) & (hour < rng.uniform(18, 23)), out, 0.0 if rng.random() < 0.5 else np.where(out > 0.5, 0.4 * out, 0.0))
    return float(top) * np.round(out, 3)


def further(rng, time_s, unit):
    if unit == "degC":
        return np.round(rng.uniform(9, 45) + rng.uniform(3, 10) * drive(rng, time_s, "teeth", 1.0) + 0.4 * rng.standard_normal(len(time_s)), 1)
    if unit == "W_m2":      # light through a roof, with clouds
        day = max(86400, 1.5 * time_s[-1]) if time_s[-1] < 86400 else 86400
        return np.round(690 * np.clip(1.1 * np.cos(2 * np.pi * (time_s / day - rng.uniform(-0.1, 0.35))), 0, 1) * np.where(drive(rng, time_s, "binary", 1.0) > 0.5, 1.0, rng.uniform(0.25, 0.6)))
    if unit == "1":
        return (drive(rng, time_s, str(rng.choice(["series", "breaks", "octaves"])), 1.0) > 0).astype(float)
    if unit == "percent":
        return np.round(5 * drive(rng, time_s, str(rng.choice(["tool_list", "decline", "binary"])), 1.0)) * 20
    return np.round(drive(rng, time_s, str(rng.choice(["series", "tool_list", "breaks"])), {"V": 48, "W": 350, "count": 40}[unit]), 1 if unit == "V" else 0)


def hall(rng, time_s, outdoor):
    """Indoors ventilation that goes on and off, a hot afternoon, a start of shift, or a conditioned room; outdoors a skewed day and a shower."""
    hours = time_s / 3600
    end = hours[-1]
    if outdoor:
        x = 2 * np.pi * (hours + rng.uniform(0, 24)) / 24
        y = rng.uniform(4, 22) + rng.uniform(1.5, 5) * (np.sin(x) + 0.3 * np.sin(2 * x))
        t = rng.uniform(0.1, 0.9) * end
        y = y - rng.uniform(0, 4) * np.where(hours > t, np.exp(-np.maximum(0, hours - t) / max(1.0, 0.15 * end)), 0.0)
    else:
        y = np.full(len(hours), rng.uniform(17, 27))
        kind = str(rng.choice(["ventilation", "afternoon", "shift", "conditioned"]))
        if kind == "ventilation":
            on, x, tau, swing = drive(rng, time_s, "binary", 1.0), 0.0, rng.uniform(0.02, 0.08) * end, rng.uniform(0.8, 3)
            for k in range(1, len(hours)):
                x = on[k - 1] + (x - on[k - 1]) * np.exp(-(hours[k] - hours[k - 1]) / tau)
                y[k] -= swing * x
        elif kind == "afternoon":
            y = y + rng.uniform(1, 4) * (1 - ((hours / end - rng.uniform(0.4, 0.8)) / 0.6) ** 2)
        elif kind == "shift":
            y = y + rng.uniform(0.8, 3.5) / (1 + np.exp(-(hours / end - rng.uniform(0.15, 0.6)) / rng.uniform(0.04, 0.12)))
        else:
            y = y + 0.25 * np.sin(2 * np.pi * hours / (rng.uniform(0.05, 0.15) * end))
    walk, x, tau = np.empty(len(hours)), 0.0, rng.uniform(0.08, 0.3) * end
    for k in range(len(hours)):
        e = np.exp(-(hours[k] - hours[k - 1]) / tau) if k else 0.0
        x = e * x + np.sqrt(1 - e * e) * (0.5 if outdoor else 0.2) * rng.standard_normal()
        walk[k] = x
    return np.round(y + np.convolve(np.pad(walk, 3, mode="edge"), np.ones(7) / 7, mode="valid"), 2)


def pace(rng, plan):
    """Of all records of a case [s]; and how many rows they have, about: read by hand, by a logger, or by a quick one."""
    r = rng.random()
    n = np.exp(rng.uniform(*np.log((65, 150) if r < 0.12 else (180, 800) if r < 0.82 else (800, 1700))))
    span = 3600 * np.exp(rng.uniform(*np.log(plan["hours"])))
    return min(PACES, key=lambda d: abs(np.log(d * n / span))), n


def rows(rng, style, dt, n):
    """Times [s] before thinning; records of a case may be half as long as others, or half as long again. sleepy: the logger writes ever more rarely, up to every eighth time, until something wakes it."""
    n = int(np.clip(round(n * np.exp(rng.uniform(np.log(0.6), np.log(1.5)))), 60, 2000))
    if style == "sleepy":
        steps = []
        while len(steps) < n - 1:
            steps += sum([[k] * int(rng.integers(3, 12)) for k in (1, 2, 4, 8)[:int(rng.integers(1, 5))]], [])
        return np.append(0.0, np.cumsum(steps[:n - 1]) * float(dt))
    return np.arange(n) * float(dt)


def thinned(record, every):
    """What a logger keeps that writes a row when the drive changes, and else one of `every`; at least 60 rows."""
    n = len(record.time_s)
    keep = (np.arange(n) % every == 0) | (np.arange(n) < 2) | (np.arange(n) == n - 1)
    for x in [record.speed, record.power, *record.feeds.values()]:
        keep |= np.append(False, np.diff(x) != 0)
    if keep.sum() < 60:
        return record
    k = np.flatnonzero(keep)
    return Record(record.name, record.time_s[k], record.speed[k], {a: f[k] for a, f in record.feeds.items()}, record.power[k], record.hall[k], {c: (u, x[k]) for c, (u, x) in record.columns.items()})


def record(rng, name, plan, time_s, styles, column=None):
    """styles: of speed, of power, of feeds."""
    n, days = len(time_s), plan.get("days", False)
    speed, power = np.zeros(n), np.zeros(n)
    if "top" in plan:
        speed = np.round(drive(rng, time_s, styles[0], plan["top"], days), 0 if plan["top"] > 300 else 1)
    if "power" in plan:
        load = drive(rng, time_s, styles[1], 1.0, days)
        if plan["drive"] == "speed+power":      # while it turns there is always some
            load = np.where(speed > 0, 0.12 + 0.88 * load, 0.0)
        power = np.array([float(f"{p:.4g}") for p in plan["power"] * load])
    feeds = {axis: np.round(drive(rng, time_s, styles[2], top), 0) / 60000 for axis, top in plan.get("feeds", {}).items()}
    columns = {column[0]: (column[1], further(rng, time_s, column[1]))} if column else {}
    return Record(name, time_s, speed, feeds, power, hall(rng, time_s, plan.get("outdoor", False)), columns)


def instruments(rng, machine, plan):
    """As in `fifth`, but in a third of the cases there are no more than three thermometers and one displacement; names are those of a wiring plan."""
    noise, seen = fifth_families.instruments(rng, machine, plan)
    if rng.random() < 0.33:
        machine.sensors = machine.sensors[:int(rng.integers(1, 4))]
        gone = [d[0] for d in machine.displacements[1:]]
        machine.displacements = machine.displacements[:1]
        machine.numbers = {k: x for k, x in machine.numbers.items() if not (k.startswith("S ") and k.split()[1] in gone)}
    slot = int(rng.integers(1, 4))
    machine.sensors = [(f"B{slot}_{i + 1:02d}", b) for i, (_, b) in enumerate(machine.sensors)]
    if rng.random() < 0.15:      # a control with a resolution of a quarter of a kelvin
        noise["temperature"] = dict(sigma=0.12, step=0.25)
    if rng.random() < 0.15:      # a dial gauge
        noise["displacement"] = dict(sigma=0.5, step=1.0)
    return noise, seen
