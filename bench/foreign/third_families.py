"""Thirteen more families of machines, for the set `third` (README.md), with records as loggers leave them: gaps, uneven rows, working weeks, columns that do nothing."""
import numpy as np

from families import Draw, blocks, extra_column, hall_curve, rounded
from network import Machine, Record


def build(m, v, bodies, links):
    for b, c in bodies.items():
        m.body(b, v(c))
    for a, b, g in links:
        m.link(a, b, v(g))


def surface_grinder(rng, v):
    m = Machine("surface_grinder")
    build(m, v, dict(wheel_bearing=1.9e3, wheel_spindle=7e3, wheelhead=48e3, chuck=31e3, saddle=66e3, column=150e3, sump=90e3),
          [("wheel_bearing", "wheel_spindle", 11), ("wheel_bearing", "wheelhead", 24), ("wheelhead", "column", 17), ("wheelhead", "hall", 6), ("chuck", "sump", 14), ("chuck", "saddle", 26),
           ("saddle", "column", 9), ("column", "hall", 16), ("sump", "hall", 11)])
    m.heat("friction_law", "wheel_bearing", v(130), 2800, rounded(rng.uniform(1.0, 1.6)), decay=v(0.013))
    m.heat("motor_loss", "wheelhead", v(110), 2800, rounded(rng.uniform(1, 1.8)), idle=v(30))
    m.heat("cutting_heat", "chuck", rounded(rng.uniform(0.05, 0.12), 2))
    m.heat("heat_source", "sump", v(120), turning=True)
    m.displacement("wheel_z", "z", {"wheelhead": v(2.7), "column": v(2.1), "chuck": -v(1.1)})
    m.displacement("wheel_y", "y", {"wheel_spindle": v(2.2), "column": -v(0.8)})
    return m, dict(hours=(4, 9), dt=(30, 60), drive="speed+power", top=2800, power=3500)


def chiller_plant(rng, v):
    m = Machine("chiller_plant")
    build(m, v, dict(compressor=9e3, condenser=13e3, evaporator=8e3, tank=210e3, pipes=17e3, cabinet=24e3),
          [("compressor", "condenser", 16), ("compressor", "cabinet", 5), ("condenser", "hall", 55), ("evaporator", "tank", 120), ("tank", "pipes", 40), ("pipes", "hall", 7), ("tank", "hall", 8),
           ("cabinet", "hall", 9), ("evaporator", "cabinet", 2)])
    m.heat("cutting_heat", "compressor", rounded(rng.uniform(0.25, 0.45), 2))
    m.heat("cutting_heat", "condenser", rounded(rng.uniform(0.35, 0.5), 2))
    m.heat("heat_source", "pipes", v(90))
    m.heat("heat_source", "tank", v(120), 1450, rounded(rng.uniform(1.2, 2.4)))
    return m, dict(hours=(4, 12), dt=(30, 120), drive="speed+power", top=1450, power=1500)


def two_stage_gearbox(rng, v):
    m = Machine("two_stage_gearbox")
    build(m, v, dict(motor=15e3, input_bearing=0.9e3, middle_bearing=1.3e3, output_bearing=2.4e3, input_shaft=3.5e3, output_shaft=12e3, oil=13e3, case=52e3, foot=110e3),
          [("motor", "input_shaft", 3), ("motor", "hall", 11), ("input_bearing", "input_shaft", 7), ("input_bearing", "case", 12), ("middle_bearing", "case", 15), ("middle_bearing", "oil", 6),
           ("output_bearing", "output_shaft", 14), ("output_bearing", "case", 21), ("oil", "case", 46), ("oil", "input_shaft", 8), ("oil", "output_shaft", 15), ("case", "foot", 19), ("case", "hall", 13),
           ("foot", "hall", 12)])
    m.heat("motor_loss", "motor", v(210), 3000, rounded(rng.uniform(1, 2)), idle=v(35))
    m.heat("heat_source", "input_bearing", v(45), 3000, rounded(rng.uniform(1, 1.7)))
    m.heat("heat_source", "middle_bearing", v(40), 3000, rounded(rng.uniform(1, 1.5)))
    m.heat("friction_law", "oil", v(310), 3000, rounded(rng.uniform(1.4, 2)), decay=v(0.012))
    m.heat("heat_source", "output_bearing", v(50), 3000, rounded(rng.uniform(0.9, 1.4)))
    m.displacement("shaft_z", "z", {"output_shaft": v(2.3), "case": v(1.7)})
    m.displacement("shaft_x", "x", {"case": v(2.0), "foot": v(1.1)})
    return m, dict(hours=(3, 8), dt=(30, 60), drive="speed", top=3000)


def eccentric_press(rng, v):
    m = Machine("eccentric_press")
    build(m, v, dict(flywheel=70e3, clutch=14e3, crank_bearing=8e3, slide=95e3, gibs=16e3, frame=600e3),
          [("flywheel", "clutch", 9), ("clutch", "crank_bearing", 13), ("crank_bearing", "frame", 45), ("crank_bearing", "slide", 18), ("slide", "gibs", 30), ("gibs", "frame", 40), ("flywheel", "hall", 10),
           ("slide", "hall", 9), ("frame", "hall", 48)])
    m.heat("heat_source", "clutch", v(260), 80, rounded(rng.uniform(0.9, 1.3)))
    m.heat("friction_law", "crank_bearing", v(420), 80, rounded(rng.uniform(1, 1.6)), decay=v(0.012))
    m.heat("heat_source", "gibs", v(180), 80, rounded(rng.uniform(1, 1.4)))
    m.displacement("shut_height", "z", {"frame": v(9.0), "slide": -v(4.5), "crank_bearing": -v(1.2)})
    m.displacement("tilt_gap", "x", {"gibs": v(2.5), "frame": -v(1.3)})
    return m, dict(hours=(8, 20), dt=(60, 300), drive="speed", top=80)


def curing_oven(rng, v):
    m = Machine("curing_oven")
    build(m, v, dict(element=2.6e3, air=4e3, inner_wall=46e3, outer_wall=60e3, rack=28e3, door=19e3), [])
    m.air.add("air")
    for a, b, g in [("element", "air", 16), ("air", "inner_wall", 24), ("inner_wall", "outer_wall", 5), ("outer_wall", "hall", 15), ("air", "rack", 18), ("air", "door", 6), ("door", "hall", 4), ("air", "hall", 2)]:
        m.link(a, b, v(g))
    m.heat("cutting_heat", "element", rounded(rng.uniform(0.5, 0.6), 2))
    m.heat("heat_source", "air", v(40), turning=True)
    return m, dict(hours=(3, 9), dt=(20, 60), drive="duty+speed", top=1400, power=1500)


def linear_motor_stage(rng, v):
    m = Machine("linear_motor_stage")
    build(m, v, dict(coil_x=1.2e3, coil_y=1.6e3, slide=6.5e3, carriage=11e3, scale=0.5e3, granite=240e3),
          [("coil_x", "slide", 3.5), ("coil_y", "carriage", 4), ("slide", "carriage", 5), ("carriage", "granite", 6), ("scale", "carriage", 1.0), ("scale", "granite", 0.5), ("coil_x", "hall", 0.9), ("slide", "hall", 1.8),
           ("carriage", "hall", 2.2), ("granite", "hall", 8)])
    m.heat("servo_loss", "coil_x", v(60), 0.8, rounded(rng.uniform(1.2, 2)), idle=v(6), axis="x")
    m.heat("servo_loss", "coil_y", v(75), 0.8, rounded(rng.uniform(1.2, 2)), idle=v(8), axis="y")
    m.displacement("probe_x", "x", {"slide": v(3.2), "scale": -v(1.6)})
    m.displacement("probe_y", "y", {"carriage": v(2.6), "granite": -v(1.7)})
    m.displacement("probe_z", "z", {"slide": v(1.1), "carriage": v(1.4)})
    m.displacement("far_y", "y", {"carriage": v(4.4), "scale": v(0.9)})
    return m, dict(hours=(2, 5), dt=(15, 30), drive="feeds", feeds={"x": 48000, "y": 48000})


def gear_hobber(rng, v):
    m = Machine("gear_hobber")
    build(m, v, dict(hob_spindle=9e3, hob_bearing=2.2e3, hob_head=52e3, table_gear=27e3, table=44e3, bed=260e3, oil_tank=150e3),
          [("hob_bearing", "hob_spindle", 10), ("hob_bearing", "hob_head", 20), ("hob_head", "bed", 15), ("hob_head", "hall", 7), ("table_gear", "table", 29), ("table", "bed", 20), ("bed", "oil_tank", 34),
           ("hob_head", "oil_tank", 6), ("oil_tank", "hall", 13), ("bed", "hall", 17)])
    m.circuit("oil_tank", v(2), v(30), rounded(rng.uniform(22, 26)))
    m.heat("heat_source", "hob_bearing", v(130), 600, rounded(rng.uniform(1, 1.6)))
    m.heat("friction_law", "table_gear", v(210), 600, rounded(rng.uniform(0.9, 1.5)), decay=v(0.014))
    m.heat("cutting_heat", "oil_tank", rounded(rng.uniform(0.15, 0.3), 2))
    m.heat("motor_loss", "hob_head", v(130), 600, rounded(rng.uniform(1, 2)), idle=v(40))
    m.displacement("centre_x", "x", {"bed": v(3.6), "hob_head": v(1.5), "table": -v(1.2)})
    m.displacement("hob_z", "z", {"hob_spindle": v(2.0), "hob_head": v(2.0)})
    return m, dict(hours=(6, 14), dt=(60, 120), drive="speed+power", top=600, power=2200)


def swivel_head(rng, v):
    m = Machine("swivel_head")
    build(m, v, dict(rotor=3.2e3, stator=4.5e3, sleeve=8e3, fork=36e3, torque_motor=5.5e3, ram=88e3),
          [("rotor", "stator", 1.6), ("rotor", "sleeve", 13), ("stator", "sleeve", 48), ("sleeve", "fork", 11), ("torque_motor", "fork", 19), ("fork", "ram", 13), ("fork", "hall", 4.5), ("ram", "hall", 9), ("sleeve", "hall", 1.5)])
    m.circuit("sleeve", v(5), v(75), rounded(rng.uniform(20, 25)))
    if rng.random() < 0.5:
        m.circuit("torque_motor", v(2), v(20), rounded(rng.uniform(20, 25)))
    m.heat("motor_loss", "stator", v(330), 15000, rounded(rng.uniform(1, 1.9)), idle=v(45))
    m.heat("friction_law", "rotor", v(140), 15000, rounded(rng.uniform(1.2, 1.8)), decay=v(0.012))
    m.heat("heat_source", "torque_motor", v(45))
    m.displacement("tip_z", "z", {"rotor": v(3.0), "fork": v(2.1)})
    m.displacement("tip_y", "y", {"fork": v(2.9), "ram": -v(1.6)})
    m.displacement("tip_x", "x", {"sleeve": v(0.8), "ram": v(1.1)})
    return m, dict(hours=(2, 5), dt=(15, 30), drive="speed", top=15000)


def compressor_station(rng, v):
    m = Machine("compressor_station")
    build(m, v, dict(screw_block=26e3, motor=34e3, oil=38e3, cooler=20e3, vessel=160e3, enclosure=45e3),
          [("screw_block", "oil", 75), ("motor", "screw_block", 9), ("motor", "enclosure", 22), ("oil", "cooler", 80), ("cooler", "hall", 42), ("oil", "vessel", 14), ("vessel", "hall", 12), ("screw_block", "enclosure", 9),
           ("enclosure", "hall", 26)])
    m.heat("heat_source", "screw_block", v(900), 3000, rounded(rng.uniform(1, 1.5)))
    m.heat("motor_loss", "motor", v(420), 3000, rounded(rng.uniform(1, 1.8)), idle=v(80))
    m.heat("heat_source", "enclosure", v(60))
    return m, dict(hours=(72, 170), dt=(600, 900), drive="speed", top=3000, week=True, outdoor=rng.random() < 0.3)


def measuring_room(rng, v):
    m = Machine("measuring_room")
    build(m, v, dict(room=0.9e6, walls=7e6, granite=1.1e6, machine=0.25e6), [])
    m.air.add("room")
    for a, b, g in [("room", "walls", 190), ("walls", "hall", 70), ("room", "granite", 28), ("room", "machine", 22), ("granite", "machine", 9), ("room", "hall", 35)]:
        m.link(a, b, v(g))
    m.heat("heat_source", "room", v(520), 100, rounded(rng.uniform(0.7, 1.2)))      # the logger's `speed` is the share of the crew that is in
    m.heat("heat_source", "machine", v(90))
    m.start = rounded(rng.uniform(19.5, 22))
    m.displacement("bridge_z", "z", {"machine": v(7.0), "granite": -v(5.5)})
    m.displacement("bridge_x", "x", {"machine": v(8.0), "granite": -v(4.5)})
    return m, dict(hours=(96, 168), dt=(600, 900), drive="speed", top=100, week=True, outdoor=True)


def film_extruder(rng, v):
    m = Machine("film_extruder")
    build(m, v, dict(zone_1=11e3, zone_2=11e3, zone_3=12e3, screw=14e3, die=16e3, gearbox=40e3),
          [("zone_1", "zone_2", 6), ("zone_2", "zone_3", 6), ("zone_3", "die", 9), ("screw", "zone_1", 5), ("screw", "zone_2", 5), ("screw", "zone_3", 5), ("screw", "gearbox", 4), ("zone_1", "hall", 3.2),
           ("zone_2", "hall", 3.0), ("zone_3", "hall", 3.1), ("die", "hall", 4.6), ("gearbox", "hall", 14)])
    for zone, share in (("zone_1", 0.22), ("zone_2", 0.2), ("zone_3", 0.2), ("die", 0.25)):
        m.heat("cutting_heat", zone, rounded(share * rng.uniform(0.85, 1.1), 2))
    m.heat("heat_source", "screw", v(230), 90, rounded(rng.uniform(1.0, 1.7)))
    m.heat("friction_law", "gearbox", v(160), 90, rounded(rng.uniform(1, 1.5)), decay=v(0.011))
    m.displacement("die_gap", "z", {"die": v(0.6), "zone_3": -v(0.25)})
    return m, dict(hours=(3, 8), dt=(30, 60), drive="speed+power", top=90, power=1500)


def boring_mill(rng, v):
    m = Machine("boring_mill")
    build(m, v, dict(quill=22e3, front_bearing=4e3, rear_bearing=3e3, sleeve=40e3, headstock=230e3, column=900e3, bed=1.6e6, motor=28e3),
          [("front_bearing", "quill", 17), ("front_bearing", "sleeve", 34), ("rear_bearing", "quill", 12), ("rear_bearing", "sleeve", 28), ("sleeve", "headstock", 55), ("motor", "headstock", 24), ("motor", "hall", 14),
           ("headstock", "column", 42), ("column", "bed", 45), ("headstock", "hall", 26), ("column", "hall", 60), ("bed", "hall", 75)])
    m.heat("friction_law", "front_bearing", v(290), 2000, rounded(rng.uniform(1, 1.7)), decay=v(0.012))
    m.heat("heat_source", "rear_bearing", v(170), 2000, rounded(rng.uniform(1, 1.6)))
    m.heat("motor_loss", "motor", v(520), 2000, rounded(rng.uniform(1, 2)), idle=v(90))
    m.heat("servo_loss", "headstock", v(180), 0.2, rounded(rng.uniform(0.9, 1.4)), axis="y")
    m.displacement("tip_z", "z", {"quill": v(5.0), "sleeve": v(1.5)})
    m.displacement("tip_y", "y", {"column": v(9.0), "headstock": v(2.6), "bed": -v(1.5)})
    m.displacement("tip_x", "x", {"column": v(2.5), "bed": -v(1.9)})
    return m, dict(hours=(12, 24), dt=(120, 300), drive="speed", top=2000, feeds={"y": 8000})


def battery_cycler(rng, v):
    m = Machine("battery_cycler")
    build(m, v, dict(cells_inner=9e3, cells_outer=12e3, busbar=1.4e3, plate=6e3, power_stage=3.5e3, box=18e3),
          [("cells_inner", "cells_outer", 7), ("cells_inner", "plate", 4), ("cells_outer", "plate", 8), ("busbar", "cells_outer", 2.2), ("busbar", "power_stage", 1.6), ("power_stage", "hall", 4.5), ("plate", "box", 7), ("box", "hall", 8),
           ("cells_outer", "box", 1.8)])
    m.circuit("plate", v(1.5), v(16), rounded(rng.uniform(18, 25)))
    m.heat("cutting_heat", "cells_inner", rounded(rng.uniform(0.03, 0.06), 2))
    m.heat("cutting_heat", "cells_outer", rounded(rng.uniform(0.03, 0.07), 2))
    m.heat("cutting_heat", "busbar", rounded(rng.uniform(0.006, 0.015), 2))
    m.heat("cutting_heat", "power_stage", rounded(rng.uniform(0.03, 0.06), 2))
    m.displacement("swelling", "z", {"cells_inner": v(1.7), "cells_outer": v(1.5), "plate": -v(0.7)})
    return m, dict(hours=(3, 9), dt=(20, 60), drive="steps", power=1800)


FAMILIES = [surface_grinder, chiller_plant, two_stage_gearbox, eccentric_press, curing_oven, linear_motor_stage, gear_hobber, swivel_head, compressor_station, measuring_room, film_extruder, boring_mill, battery_cycler]
TITLES = dict(surface_grinder="surface grinder with a magnetic chuck under coolant; the wheel's cutting power is recorded", chiller_plant="chiller with its tank; the compressor's electric power and the pump's speed are recorded",
              two_stage_gearbox="two-stage gearbox with motor on a test bench", eccentric_press="eccentric press; strokes per minute are recorded as speed",
              curing_oven="curing oven with a fan and a rack; the heaters' power is recorded", linear_motor_stage="stage with linear motors on granite", gear_hobber="gear hobbing machine with cooled oil",
              swivel_head="two-axis milling head with a motor spindle, on a chiller", compressor_station="screw compressor over working days", measuring_room="measuring room in a working week; the crew's presence is recorded as speed, in per cent",
              film_extruder="extruder with three heated zones and a die; the heaters' power is recorded", boring_mill="horizontal boring mill", battery_cycler="battery pack on a cold plate; charging power is recorded")

DECOYS = [("sun", "W_m2"), ("valve", "percent"), ("purge", "1"), ("lamp", "V"), ("aux_power", "W"), ("conveyor", "count"), ("loop", "degC")]


def temperature_column(rng, time_s):
    """Water of some other circuit: a set point that is moved now and then, and a slow swing."""
    y = rng.uniform(24, 40) + blocks(rng, time_s, 3, 300, rng.uniform(0.08, 0.2) * time_s[-1], 0.3) / 40
    return np.round(y + rng.uniform(0.5, 2) * np.sin(2 * np.pi * time_s / (rng.uniform(0.3, 0.9) * time_s[-1])), 1)


def working_week(rng, time_s, top):
    """Two shifts of five days, with breaks; the first row is midnight before a random day."""
    first = int(rng.integers(7))
    start, end = rng.uniform(5.5, 8), rng.uniform(15, 22.5)
    hours = time_s / 3600 + 24 * first
    busy = ((hours // 24) % 7 < 5) & (hours % 24 >= start) & (hours % 24 < end)
    if not busy.any():
        busy = (hours % 24 >= start) & (hours % 24 < end)
    return np.where(busy, blocks(rng, time_s, 3, top, 3 * 3600, 0.15), 0.0)


def record(rng, name, plan, n_rows, dt, style, column=None):
    """`style`: even, gaps (the logger wrote nothing for a while) or uneven (it passed over rows at random)."""
    time_s = np.arange(n_rows) * float(dt)
    total = time_s[-1]
    mean_s = rng.uniform(0.05, 0.14) * total
    speed, power, feeds = np.zeros(n_rows), np.zeros(n_rows), {}
    drive = plan["drive"]
    if plan.get("week"):
        speed = working_week(rng, time_s, plan["top"])
    elif "speed" in drive:
        speed = blocks(rng, time_s, int(rng.integers(3, 6)), plan["top"], mean_s, 0.3)
    if drive == "speed+power":
        power = np.where(speed > 0, blocks(rng, time_s, 4, plan["power"], mean_s / 2, 0.35), 0)
    elif drive == "steps":
        power = blocks(rng, time_s, 4, plan["power"], mean_s, 0.3)
    elif "duty" in drive:
        t, on, mean_on = 0.0, True, rng.uniform(0.01, 0.03) * total
        while t < total:
            length = max(dt, (mean_on if on else mean_on * rng.uniform(0.8, 2.2)) * np.exp(0.6 * rng.standard_normal()))
            power[(time_s >= t) & (time_s < t + length)] = plan["power"] if on else 0.0
            t, on = t + length, not on
    for axis, top in plan.get("feeds", {}).items():
        feeds[axis] = blocks(rng, time_s, 4, top, mean_s, 0.3) / 1000 / 60
    columns = {}
    if column:
        columns[column[0]] = (column[1], temperature_column(rng, time_s) if column[1] == "degC" else extra_column(rng, time_s, column[1]))
    hall = hall_curve(rng, time_s, plan.get("outdoor", False))
    keep = np.ones(n_rows, bool)
    if style == "gaps":
        for _ in range(int(rng.integers(1, 4))):
            a = int(rng.uniform(0.1, 0.85) * n_rows)
            keep[a:a + int(rng.uniform(0.01, 0.05) * n_rows)] = False
    elif style == "uneven":
        keep = rng.random(n_rows) > 0.3
        run = 0
        for i in range(n_rows):      # never more than four rows in a row
            run = 0 if keep[i] else run + 1
            if run > 4:
                keep[i], run = True, 0
    keep[[0, 1, n_rows - 1]] = True
    return Record(name, time_s[keep], speed[keep], {a: f[keep] for a, f in feeds.items()}, power[keep], hall[keep], {k: (u, x[keep]) for k, (u, x) in columns.items()})


def instruments(rng, machine, turn):
    """What the case is looked at by; `turn` goes round: both, temperatures only, both, displacements only, many thermometers, both."""
    bodies = list(machine.bodies)
    style = ["both", "temperatures", "both", "displacements", "many", "both"][turn % 6]
    if not machine.displacements and style == "displacements":
        style = "temperatures"
    n_t = dict(both=int(rng.integers(max(2, len(bodies) // 2), len(bodies) + 1)), temperatures=int(rng.integers(4, 3 * len(bodies) // 2 + 1)), displacements=0, many=int(rng.integers(22, 39)))[style]
    order, names = list(rng.permutation(bodies)), []
    for i in range(n_t):
        body = str(order[i] if i < len(order) else order[int(rng.integers(len(order)))])
        same = sum(b == body for _, b in names)
        names.append((f"t_{body}" if same == 0 else f"t_{body}_{same + 1}", body))
    machine.sensors = sorted(names)
    if style == "temperatures":
        machine.displacements = []
        machine.numbers = {k: x for k, x in machine.numbers.items() if not k.startswith("S ")}
    kind = rng.random()
    if kind < 0.5:
        temperature = dict(sigma=float(rng.choice([0.02, 0.03, 0.05, 0.1, 0.2])), step=0.001)
    else:
        temperature = dict(sigma=float(rng.choice([0.04, 0.06])), step=0.1 if kind < 0.75 else 0.0625)
    displacement = dict(sigma=rounded(np.exp(rng.uniform(np.log(0.1), np.log(1.5))), 2), step=0.01 if rng.random() < 0.7 else 0.1)
    return dict(temperature=temperature, displacement=displacement, coloured=dict(share=0.0, minutes=0.0)), style
