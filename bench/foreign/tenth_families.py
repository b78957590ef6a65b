"""Twelve more families of machines, for the set `tenth` (README.md), of three to ten bodies; driven as people run machines: parts with pauses, a day with breaks, a test of the spindle, and by some ways of the sets before."""
import numpy as np

import eighth_families as eighth
import ninth_families as ninth
import seventh_families as seventh
from families import rounded
from network import Machine, Record
from third_families import build

OWN_STYLES = ["parts", "day", "spindle_test"]
STYLES = OWN_STYLES * 4 + ["night_shift", "long_run", "warm_up_and_cut", "iso_steps", "series", "takt", "product_change", "sporadic"]
ROWS = ["even", "watched", "gaps", "lost", "slower"]


def five_axis_mill(rng, v):
    """A motor spindle, a column, and a swivelling table with a torque motor that water cools."""
    m = Machine("five_axis_mill")
    build(m, v, dict(bearing_front=1.2e3, rotor=6.5e3, spindle_housing=26e3, headstock=75e3, column=0.42e6, screw_z=11e3, torque_motor=17e3, table=58e3, cradle=0.1e6, bed=0.95e6),
          [("bearing_front", "rotor", 13), ("bearing_front", "spindle_housing", 27), ("rotor", "spindle_housing", 4), ("spindle_housing", "headstock", 28), ("headstock", "column", 24), ("screw_z", "headstock", 8), ("screw_z", "column", 9), ("column", "bed", 40), ("torque_motor", "table", 13), ("torque_motor", "cradle", 19), ("table", "cradle", 8), ("cradle", "bed", 25),
           ("headstock", "hall", 9), ("column", "hall", 19), ("table", "hall", 6), ("cradle", "hall", 7), ("bed", "hall", 34)])
    m.circuit("spindle_housing", v(6), v(95), rounded(rng.uniform(20, 25)))
    m.circuit("torque_motor", v(3), v(45), rounded(rng.uniform(20, 25)))
    m.heat("friction_law", "bearing_front", v(170), 14000, rounded(rng.uniform(1.1, 1.7)), decay=v(0.012))
    m.heat("motor_loss", "rotor", v(290), 14000, rounded(rng.uniform(1, 1.8)), idle=v(45))
    m.heat("servo_loss", "screw_z", v(85), 0.5, rounded(rng.uniform(0.9, 1.4)), idle=v(12), axis="z")
    m.heat("servo_loss", "torque_motor", v(210), 0.3, rounded(rng.uniform(1.0, 1.8)), idle=v(40), axis="x")
    m.displacement("tcp_x", "x", {"headstock": v(1.3), "table": -v(1.1), "bed": v(0.7)})
    m.displacement("tcp_y", "y", {"headstock": v(1.9), "column": v(2.3)})
    m.displacement("tcp_z", "z", {"spindle_housing": v(2.1), "rotor": v(0.9), "column": -v(2.6), "table": v(1.2)})
    return m, dict(hours=(3, 11), drive="speed", top=14000, feeds={"z": 30000, "x": 18000})


def injection_unit(rng, v):
    """A barrel in three zones whose heaters' power is recorded, a throat that water keeps cold, a drive behind it."""
    m = Machine("injection_unit")
    build(m, v, dict(nozzle=2.6e3, barrel_front=14e3, barrel_back=15e3, throat=13e3, drive_housing=52e3, motor=24e3, frame=0.34e6), [("nozzle", "barrel_front", 3.2), ("barrel_front", "barrel_back", 4.5), ("barrel_back", "throat", 5.5), ("throat", "drive_housing", 10), ("motor", "drive_housing", 9), ("drive_housing", "frame", 17), ("throat", "frame", 7), ("nozzle", "hall", 0.9),
          ("barrel_front", "hall", 5), ("barrel_back", "hall", 5), ("drive_housing", "hall", 8), ("motor", "hall", 11), ("frame", "hall", 24)])
    m.circuit("throat", v(3), v(50), rounded(rng.uniform(16, 28)))
    m.heat("cutting_heat", "barrel_front", rounded(rng.uniform(0.36, 0.44), 2))
    m.heat("cutting_heat", "barrel_back", rounded(rng.uniform(0.36, 0.44), 2))
    m.heat("cutting_heat", "nozzle", rounded(rng.uniform(0.04, 0.08), 2))
    m.heat("friction_law", "drive_housing", v(240), 320, rounded(rng.uniform(0.9, 1.5)), decay=v(0.011))
    m.heat("motor_loss", "motor", v(420), 320, rounded(rng.uniform(0.9, 1.6)), idle=v(60))
    m.displacement("screw_stroke", "z", {"barrel_front": v(1.4), "barrel_back": v(1.3), "drive_housing": -v(1.2)})
    m.displacement("nozzle_height", "y", {"throat": v(1.1), "frame": v(2.1)})
    return m, dict(hours=(1.5, 9), drive="speed+power", top=320, power=2100)


def jig_grinder(rng, v):
    """A planetary spindle for grinding holes; a quiet room."""
    m = Machine("jig_grinder")
    build(m, v, dict(air_spindle=1.7e3, planet_head=24e3, quill=13e3, column=0.31e6, table=0.12e6, base=0.66e6), [("air_spindle", "planet_head", 5), ("planet_head", "quill", 13), ("quill", "column", 11), ("column", "base", 26), ("table", "base", 19), ("planet_head", "hall", 4), ("column", "hall", 14), ("table", "hall", 8), ("base", "hall", 23)])
    m.heat("heat_source", "air_spindle", v(65), 40000, rounded(rng.uniform(1.2, 1.9)))
    m.heat("motor_loss", "planet_head", v(90), 40000, rounded(rng.uniform(0.9, 1.5)), idle=v(18))
    m.heat("servo_loss", "table", v(60), 0.1, rounded(rng.uniform(0.9, 1.4)), idle=v(8), axis="x")
    m.heat("servo_loss", "quill", v(38), 0.1, rounded(rng.uniform(0.9, 1.4)), axis="z")
    m.displacement("hole_x", "x", {"column": v(2.4), "table": -v(1.9)})
    m.displacement("hole_y", "y", {"column": v(2.9), "planet_head": v(0.8), "base": -v(1.4)})
    m.displacement("depth", "z", {"quill": v(1.9), "column": -v(2.2), "air_spindle": v(0.5)})
    return m, dict(hours=(2, 12), drive="speed", top=40000, feeds={"x": 6000, "z": 6000}, seen="displacements")


def friction_welder(rng, v):
    """A headstock that presses, a slide on the other side, and oil for both; the welding power is recorded."""
    m = Machine("friction_welder")
    build(m, v, dict(chuck=21e3, bearing_thrust=3.4e3, headstock=0.13e6, slide=0.16e6, oil=62e3, bed=0.7e6), [("chuck", "bearing_thrust", 14), ("bearing_thrust", "headstock", 34), ("chuck", "headstock", 8), ("headstock", "bed", 36), ("slide", "bed", 21), ("oil", "headstock", 12), ("oil", "slide", 10), ("chuck", "hall", 6), ("headstock", "hall", 13), ("slide", "hall", 10), ("oil", "hall", 9), ("bed", "hall", 29)])
    m.heat("friction_law", "bearing_thrust", v(380), 1600, rounded(rng.uniform(1.0, 1.6)), decay=v(0.012))
    m.heat("motor_loss", "headstock", v(460), 1600, rounded(rng.uniform(0.9, 1.6)), idle=v(70))
    m.heat("cutting_heat", "chuck", rounded(rng.uniform(0.05, 0.1), 2))
    m.heat("cutting_heat", "slide", rounded(rng.uniform(0.03, 0.07), 2))
    m.heat("heat_source", "oil", v(240))
    m.displacement("length", "z", {"headstock": v(1.9), "slide": -v(1.6), "bed": v(0.9)})
    return m, dict(hours=(2, 10), drive="speed+power", top=1600, power=6200)


def jacket_spindle_rig(rng, v):
    """A belt-driven spindle on a bench, water in its jacket; what a laboratory has most thermometers for."""
    m = Machine("jacket_spindle_rig")
    build(m, v, dict(shaft=4.8e3, bearing_front=1.1e3, bearing_rear=0.8e3, jacket=8.5e3, flange=15e3, pulley=1.9e3, bench=85e3), [("bearing_front", "shaft", 11), ("bearing_rear", "shaft", 8), ("bearing_front", "jacket", 24), ("bearing_rear", "jacket", 17), ("jacket", "flange", 21), ("bearing_front", "flange", 9), ("flange", "bench", 13), ("pulley", "shaft", 3.4), ("pulley", "hall", 1.6), ("shaft", "hall", 0.8), ("flange", "hall", 3), ("bench", "hall", 9)])
    m.circuit("jacket", v(4), v(70), rounded(rng.uniform(18, 26)))
    m.heat("friction_law", "bearing_front", v(160), 9000, rounded(rng.uniform(1.1, 1.8)), decay=v(0.013))
    m.heat("heat_source", "bearing_rear", v(80), 9000, rounded(rng.uniform(1.1, 1.7)))
    m.heat("heat_source", "pulley", v(45), 9000, rounded(rng.uniform(0.9, 1.4)))
    m.displacement("nose_z", "z", {"shaft": v(2.4), "flange": v(1.2)})
    m.displacement("nose_x", "x", {"flange": v(1.5), "bench": v(1.7)})
    return m, dict(hours=(1, 7), drive="speed", top=9000)


def powder_bed_printer(rng, v):
    """A heated plate in a chamber with air of its own; the laser's power is recorded."""
    m = Machine("powder_bed_printer")
    build(m, v, dict(build_plate=9.5e3, piston=7e3, chamber_wall=42e3, chamber_air=2.4e3, optics=8.5e3, frame=0.16e6), [])
    m.air.add("chamber_air")
    for a, b, g in [("build_plate", "piston", 6), ("piston", "chamber_wall", 5), ("build_plate", "chamber_air", 4), ("chamber_wall", "chamber_air", 14), ("optics", "chamber_wall", 3.4), ("chamber_wall", "frame", 9), ("chamber_air", "hall", 3), ("chamber_wall", "hall", 9), ("optics", "hall", 3), ("frame", "hall", 15)]:
        m.link(a, b, v(g))
    m.circuit("optics", v(2), v(18), rounded(rng.uniform(20, 24)))
    m.heat("cutting_heat", "build_plate", rounded(rng.uniform(0.55, 0.7), 2))
    m.heat("cutting_heat", "optics", rounded(rng.uniform(0.04, 0.09), 2))
    m.heat("heat_source", "piston", v(140))
    m.heat("servo_loss", "frame", v(75), 0.2, rounded(rng.uniform(0.9, 1.4)), idle=v(15), axis="x")
    m.displacement("plate_z", "z", {"build_plate": v(0.8), "piston": v(2.1), "frame": -v(1.3)})
    m.displacement("beam_x", "x", {"optics": v(3.1), "chamber_wall": v(1.2)})
    return m, dict(hours=(2, 16), drive="power", power=420, feeds={"x": 12000})


def wafer_saw(rng, v):
    """A fast spindle in a carriage over a chuck table, all of it wet."""
    m = Machine("wafer_saw")
    build(m, v, dict(spindle=2.4e3, carriage=19e3, chuck_table=6.2e3, slide=28e3, granite=0.28e6), [("spindle", "carriage", 7), ("carriage", "granite", 8), ("chuck_table", "slide", 6), ("slide", "granite", 9), ("spindle", "hall", 0.6), ("carriage", "hall", 3.5), ("chuck_table", "hall", 2.4), ("granite", "hall", 11)])
    m.circuit("spindle", v(1.5), v(26), rounded(rng.uniform(20, 24)))
    m.heat("motor_loss", "spindle", v(150), 50000, rounded(rng.uniform(1.1, 1.9)), idle=v(14))
    m.heat("heat_source", "spindle", v(55), 50000, rounded(rng.uniform(1.2, 1.9)))
    m.heat("servo_loss", "slide", v(55), 0.4, rounded(rng.uniform(0.9, 1.5)), idle=v(9), axis="x")
    m.heat("servo_loss", "carriage", v(32), 0.2, rounded(rng.uniform(0.9, 1.5)), idle=v(6), axis="y")
    m.displacement("index_y", "y", {"carriage": v(2.6), "slide": -v(1.4), "granite": v(0.9)})
    m.displacement("cut_depth", "z", {"spindle": v(2.2), "chuck_table": v(1.1), "carriage": -v(0.9)})
    return m, dict(hours=(1, 8), drive="speed", top=50000, feeds={"x": 24000, "y": 12000}, seen="displacements")


def turning_centre(rng, v):
    """Two spindles that face each other, a turret between them."""
    m = Machine("turning_centre")
    build(m, v, dict(main_bearing=3.1e3, main_head=62e3, sub_bearing=1.8e3, sub_head=41e3, turret=33e3, screw_x=7.5e3, bed=0.78e6), [("main_bearing", "main_head", 33), ("sub_bearing", "sub_head", 24), ("main_head", "bed", 31), ("sub_head", "bed", 22), ("turret", "bed", 11), ("screw_x", "turret", 6), ("screw_x", "bed", 5), ("main_head", "hall", 10), ("sub_head", "hall", 8), ("turret", "hall", 5), ("bed", "hall", 30)])
    m.heat("friction_law", "main_bearing", v(260), 5000, rounded(rng.uniform(1.0, 1.7)), decay=v(0.011))
    m.heat("heat_source", "sub_bearing", v(130), 5000, rounded(rng.uniform(1.0, 1.7)))
    m.heat("motor_loss", "main_head", v(310), 5000, rounded(rng.uniform(0.9, 1.6)), idle=v(45))
    m.heat("cutting_heat", "turret", rounded(rng.uniform(0.02, 0.05), 2))
    m.heat("servo_loss", "screw_x", v(75), 0.4, rounded(rng.uniform(0.9, 1.4)), idle=v(10), axis="x")
    m.displacement("diameter", "x", {"main_head": v(2.5), "turret": -v(1.9), "bed": v(0.8)})
    m.displacement("face", "z", {"main_head": v(1.5), "main_bearing": v(0.6), "bed": -v(1.7)})
    m.displacement("sub_face", "z", {"sub_head": -v(1.4), "bed": v(1.7)})
    return m, dict(hours=(2, 10), drive="speed+power", top=5000, power=7500, feeds={"x": 24000})


def gear_shaper(rng, v):
    """A ram that strokes, a worm that turns the work, oil over everything."""
    m = Machine("gear_shaper")
    build(m, v, dict(cutter_head=31e3, crank_drive=25e3, column=0.38e6, work_table=48e3, worm=6.5e3, oil_tank=0.17e6, bed=0.6e6), [("cutter_head", "crank_drive", 11), ("cutter_head", "column", 18), ("crank_drive", "column", 15), ("column", "bed", 33), ("worm", "work_table", 13), ("work_table", "bed", 22), ("cutter_head", "oil_tank", 6), ("work_table", "oil_tank", 12), ("oil_tank", "bed", 14), ("column", "hall", 16), ("crank_drive", "hall", 5), ("oil_tank", "hall", 13), ("bed", "hall", 25)])
    m.heat("friction_law", "cutter_head", v(290), 900, rounded(rng.uniform(1.0, 1.6)), decay=v(0.012))
    m.heat("motor_loss", "crank_drive", v(350), 900, rounded(rng.uniform(0.9, 1.6)), idle=v(55))
    m.heat("heat_source", "worm", v(85), 900, rounded(rng.uniform(0.8, 1.3)))
    m.heat("cutting_heat", "oil_tank", rounded(rng.uniform(0.35, 0.55), 2))
    m.heat("cutting_heat", "work_table", rounded(rng.uniform(0.03, 0.07), 2))
    m.displacement("centre_distance", "x", {"column": v(2.7), "work_table": -v(1.6), "bed": v(1.1)})
    m.displacement("lead", "z", {"cutter_head": v(1.7), "column": -v(1.9)})
    return m, dict(hours=(2, 12), drive="speed+power", top=900, power=1900)


def tool_grinder(rng, v):
    """Grinds cutters: wheel spindle, workhead, and oil that a chiller keeps."""
    m = Machine("tool_grinder")
    build(m, v, dict(wheel_spindle=14e3, wheel_slide=72e3, workhead=18e3, swivel=46e3, bed=0.4e6), [("wheel_spindle", "wheel_slide", 26), ("wheel_slide", "bed", 21), ("workhead", "swivel", 14), ("swivel", "bed", 17), ("wheel_slide", "hall", 8), ("workhead", "hall", 3.5), ("swivel", "hall", 5), ("bed", "hall", 20)])
    m.circuit("wheel_spindle", v(4), v(55), rounded(rng.uniform(20, 26)))
    m.heat("friction_law", "wheel_spindle", v(230), 10000, rounded(rng.uniform(1.1, 1.8)), decay=v(0.012))
    m.heat("motor_loss", "wheel_spindle", v(260), 10000, rounded(rng.uniform(0.9, 1.6)), idle=v(40))
    m.heat("servo_loss", "workhead", v(95), 0.3, rounded(rng.uniform(0.9, 1.5)), idle=v(25), axis="y")
    m.heat("servo_loss", "wheel_slide", v(65), 0.3, rounded(rng.uniform(0.9, 1.5)), idle=v(10), axis="x")
    m.displacement("cutter_radius", "x", {"wheel_slide": v(2.0), "swivel": -v(1.6), "workhead": -v(0.7)})
    m.displacement("cutter_length", "z", {"workhead": v(1.6), "wheel_spindle": -v(1.4), "bed": v(0.8)})
    return m, dict(hours=(1.5, 9), drive="speed", top=10000, feeds={"y": 9000, "x": 15000})


def pallet_mill(rng, v):
    """A horizontal machining centre: geared head, column, a table that takes pallets, hydraulics at its side."""
    m = Machine("pallet_mill")
    build(m, v, dict(spindle=9.5e3, gear_head=56e3, column=0.6e6, screw_y=13e3, pallet=0.14e6, rotary_base=0.18e6, hydraulics=46e3, bed=1.3e6), [("spindle", "gear_head", 30), ("gear_head", "column", 27), ("screw_y", "gear_head", 7), ("screw_y", "column", 9), ("column", "bed", 44), ("pallet", "rotary_base", 14), ("rotary_base", "bed", 30), ("hydraulics", "bed", 9), ("gear_head", "hall", 11), ("column", "hall", 24), ("pallet", "hall", 9), ("hydraulics", "hall", 11), ("bed", "hall", 42)])
    m.heat("friction_law", "spindle", v(310), 6000, rounded(rng.uniform(1.0, 1.6)), decay=v(0.011))
    m.heat("heat_source", "gear_head", v(420), 6000, rounded(rng.uniform(0.9, 1.5)))
    m.heat("motor_loss", "gear_head", v(350), 6000, rounded(rng.uniform(0.9, 1.6)), idle=v(60))
    m.heat("servo_loss", "screw_y", v(95), 0.4, rounded(rng.uniform(0.9, 1.4)), idle=v(14), axis="y")
    m.heat("heat_source", "hydraulics", v(330))
    m.displacement("bore_y", "y", {"gear_head": v(1.6), "column": v(3.1), "pallet": -v(1.4)})
    m.displacement("bore_z", "z", {"spindle": v(1.5), "column": v(0.8), "bed": -v(1.2)})
    return m, dict(hours=(3, 14), drive="speed", top=6000, feeds={"y": 24000})


def watch_lathe(rng, v):
    """Three bodies: a small headstock with its motor, on a bed."""
    m = Machine("watch_lathe")
    build(m, v, dict(headstock=3.2e3, motor=2.1e3, bed=21e3), [("headstock", "bed", 4.5), ("motor", "bed", 2.2), ("motor", "headstock", 0.6), ("headstock", "hall", 0.9), ("motor", "hall", 1.5), ("bed", "hall", 4)])
    m.heat("friction_law", "headstock", v(28), 12000, rounded(rng.uniform(1.0, 1.7)), decay=v(0.012))
    m.heat("motor_loss", "motor", v(32), 12000, rounded(rng.uniform(0.9, 1.6)), idle=v(5))
    m.displacement("turned_diameter", "x", {"headstock": v(1.6), "bed": v(0.9)})
    m.displacement("shoulder", "z", {"headstock": v(2.1), "bed": -v(1.2)})
    return m, dict(hours=(0.8, 7), drive="speed", top=12000)


FAMILIES = [five_axis_mill, injection_unit, jig_grinder, friction_welder, jacket_spindle_rig, powder_bed_printer, wafer_saw, turning_centre, gear_shaper, tool_grinder, pallet_mill, watch_lathe]
TITLES = dict(five_axis_mill="five-axis milling machine with a torque table", injection_unit="injection unit of a moulding machine; the barrel heaters' power is recorded", jig_grinder="jig grinding machine", friction_welder="rotary friction welding machine; the welding power is recorded",
              jacket_spindle_rig="spindle test rig with a water jacket", powder_bed_printer="laser powder bed machine; the laser's power is recorded", wafer_saw="wafer saw", turning_centre="turning centre with two spindles; the cutting power is recorded", gear_shaper="gear shaping machine; the cutting power is recorded",
              tool_grinder="tool and cutter grinding machine", pallet_mill="horizontal machining centre with pallets", watch_lathe="watchmaker's lathe")
WORK = dict(five_axis_mill=["table"], injection_unit=["nozzle"], jig_grinder=["table"], friction_welder=["chuck", "slide"], jacket_spindle_rig=["flange", "bench"], powder_bed_printer=["build_plate"], wafer_saw=["chuck_table"], turning_centre=["main_head", "turret"], gear_shaper=["work_table"],
            tool_grinder=["workhead"], pallet_mill=["pallet"], watch_lathe=["headstock"])      # where a part or a fixture is clamped
DECOYS = [("sun", "W_m2"), ("heater_column", "W"), ("air_supply", "degC"), ("parts", "count"), ("mist_extraction", "1"), ("compressed_air", "percent")]


def drive(rng, time_s, style, top, days=False):
    """A column from 0 to `top`, held from each row on. `parts` one part programme of two to five cuts again and again, with a pause while the next part is put in and now and then a longer one; `day` a warming run, work until a break,
    work until a second one, work; `spindle_test` steps upwards or up and down with a rest, or one level until all is warm and then a rest. Else as the sets before."""
    if style not in OWN_STYLES:
        return ninth.drive(rng, time_s, style, top, days)
    share = time_s / time_s[-1]
    out = np.zeros(len(share))

    def put(a, b, level):
        out[(share >= a) & (share < b)] = level
    if style == "parts":
        k = int(rng.integers(2, 6))
        levels, lengths = np.round(rng.uniform(0.3, 1, k), 2), rng.uniform(0.4, 1, k)
        cut, pause, t = rng.uniform(0.04, 0.12), rng.uniform(0.008, 0.03), rng.uniform(0.0, 0.06)
        lengths = lengths / lengths.sum() * cut
        while t < 0.97:
            for level, length in zip(levels, lengths):
                put(t, t + length, level)
                t += length
            t += pause if rng.random() < 0.85 else rng.uniform(0.05, 0.12)
    elif style == "day":
        a, b, c = rng.uniform(0.01, 0.05), rng.uniform(0.3, 0.4), rng.uniform(0.6, 0.7)
        put(a, a + 0.06, round(rng.uniform(0.2, 0.5), 2))
        for begin, end in ((a + 0.06, b), (b + rng.uniform(0.03, 0.06), c), (c + rng.uniform(0.05, 0.1), rng.uniform(0.88, 0.98))):
            t, usual = begin, round(rng.uniform(0.4, 1), 2)
            while t < end:
                length = rng.uniform(0.02, 0.07)
                put(t, min(end, t + length), usual if rng.random() < 0.6 else round(rng.uniform(0.25, 1), 2))
                t += length + rng.uniform(0.004, 0.02)
    else:
        kind = rng.random()
        if kind < 0.4:
            n, begin, end = int(rng.integers(3, 7)), rng.uniform(0.01, 0.06), rng.uniform(0.7, 0.85)
            levels = np.round(np.linspace(1 / n, 1, n), 2)
            for i, level in enumerate(levels):
                put(begin + i * (end - begin) / n, begin + (i + 1) * (end - begin) / n, level)
        elif kind < 0.7:
            levels, begin, length = [0.25, 0.5, 0.75, 1.0, 0.6, 0.3], rng.uniform(0.01, 0.05), rng.uniform(0.1, 0.14)
            for i, level in enumerate(levels):
                put(begin + i * length, begin + (i + 0.9) * length, level)
        else:
            put(rng.uniform(0.01, 0.06), rng.uniform(0.55, 0.7), round(rng.uniform(0.5, 1), 2))
            put(0.85, 0.95, round(rng.uniform(0.3, 1), 2))
    return float(top) * np.round(out, 3)


def pace(rng, plan, channels, n_records):
    """Of the logger [s], as a logger is set, and how many rows a record has, about."""
    n = float(np.exp(rng.uniform(*np.log((85, 900)))))
    n = max(80.0, min(n, 24000 / (channels * n_records), 1600 / n_records))
    span = 3600 * np.exp(rng.uniform(*np.log(plan["hours"])))
    return min((1, 2, 5, 10, 15, 20, 30, 60, 120, 180, 300, 600), key=lambda d: abs(np.log(d * n / span))), n


def rows(rng, style, dt, n):
    """Times [s], 60 to 1200 of them, in the styles of `ninth`."""
    n = float(np.clip(n, 80, 850))
    while True:
        t = ninth.rows(rng, style, dt, n)
        if 60 <= len(t) <= 1200:
            return t
        n = float(np.clip(n * (1.2 if len(t) < 60 else 0.85), 60, 1200))


def record(rng, name, plan, time_s, styles, column=None):
    """styles: of speed, of power, of feeds; each axis moves separately, and where there is a speed only while it turns, but for some positioning."""
    n = len(time_s)
    speed, power = np.zeros(n), np.zeros(n)
    if "top" in plan:
        speed = np.round(drive(rng, time_s, styles[0], plan["top"]), 0)
    if "power" in plan:
        load = drive(rng, time_s, styles[1], 1.0)
        if plan["drive"] == "speed+power":
            load = np.where(speed > 0, 0.1 + 0.9 * load, 0.0)
        power = np.array([float(f"{p:.4g}") for p in plan["power"] * load])
    feeds = {}
    for axis, top in plan.get("feeds", {}).items():
        f = drive(rng, time_s, styles[2], top)
        if "top" in plan:
            f = np.where(speed > 0, f, np.where(rng.random(n) < 0.1, 0.3 * f, 0.0))
        feeds[axis] = np.round(f, 0) / 60000
    columns = {column[0]: (column[1], seventh.further(rng, time_s, column[1]))} if column else {}
    return Record(name, time_s, speed, feeds, power, ninth.hall(rng, time_s, False), columns)


def instruments(rng, machine, plan):
    """As in `seventh`; thermometers have the name of their body, or a number of a card."""
    noise, seen = seventh.instruments(rng, machine, plan)
    places = [b for _, b in machine.sensors]
    if rng.random() < 0.5:
        machine.sensors = [(f"T_{b}_{places[:i].count(b) + 1}" if places.count(b) > 1 else f"T_{b}", b) for i, b in enumerate(places)]
    else:
        machine.sensors = [(f"Pt{101 + i}", b) for i, b in enumerate(places)]
    return noise, seen


def priors(rng, machine):
    """As in `eighth`."""
    return eighth.priors(rng, machine)
