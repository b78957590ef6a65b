"""Twelve more families of machines, for the set `eleventh` (README.md), of three to nine bodies; driven as people run machines, by the ways of `tenth` and by lots of parts with a set-up before each."""
import numpy as np

import eighth_families as eighth
import ninth_families as ninth
import seventh_families as seventh
import tenth_families as tenth
from families import rounded
from network import Machine, Record
from third_families import build

OWN_STYLES = ["lots"]
STYLES = OWN_STYLES * 4 + tenth.OWN_STYLES * 3 + ["night_shift", "long_run", "warm_up_and_cut", "iso_steps", "product_change", "sporadic"]
ROWS = ["even", "watched", "gaps", "lost", "slower"]


def crankshaft_grinder(rng, v):
    """Wheelhead on a slide, workhead and tailstock, oil for guideways and grinding in one tank; the grinding power is recorded."""
    m = Machine("crankshaft_grinder")
    build(m, v, dict(wheel_spindle=12e3, wheelhead=95e3, wheel_slide=0.2e6, workhead=40e3, tailstock=26e3, oil_tank=0.2e6, bed=0.9e6), [("wheel_spindle", "wheelhead", 34), ("wheelhead", "wheel_slide", 26), ("wheel_slide", "bed", 30), ("workhead", "bed", 22), ("tailstock", "bed", 16), ("oil_tank", "wheelhead", 9), ("oil_tank", "bed", 12),
          ("wheelhead", "hall", 11), ("wheel_slide", "hall", 9), ("workhead", "hall", 7), ("tailstock", "hall", 5), ("oil_tank", "hall", 14), ("bed", "hall", 33)])
    m.heat("friction_law", "wheel_spindle", v(420), 4500, rounded(rng.uniform(1.0, 1.7)), decay=v(0.012))
    m.heat("motor_loss", "wheelhead", v(380), 4500, rounded(rng.uniform(0.9, 1.6)), idle=v(55))
    m.heat("cutting_heat", "oil_tank", rounded(rng.uniform(0.3, 0.45), 2))
    m.heat("cutting_heat", "workhead", rounded(rng.uniform(0.03, 0.06), 2))
    m.heat("heat_source", "oil_tank", v(240))
    m.displacement("journal_diameter", "x", {"wheel_slide": v(1.6), "wheelhead": v(1.1), "workhead": -v(1.3)})
    m.displacement("journal_place", "z", {"workhead": v(1.2), "bed": -v(0.9)})
    return m, dict(hours=(2, 12), drive="speed+power", top=4500, power=3200)


def portal_mill(rng, v):
    """A ram on a crossbeam on two posts, a chiller for the spindle."""
    m = Machine("portal_mill")
    build(m, v, dict(spindle=7.5e3, milling_head=34e3, ram=85e3, saddle=0.13e6, crossbeam=0.5e6, post_left=0.42e6, post_right=0.42e6, table=0.6e6, bed=1.6e6),
          [("spindle", "milling_head", 30), ("milling_head", "ram", 25), ("ram", "saddle", 22), ("saddle", "crossbeam", 24), ("crossbeam", "post_left", 38), ("crossbeam", "post_right", 38), ("post_left", "bed", 42), ("post_right", "bed", 42), ("table", "bed", 35),
           ("milling_head", "hall", 8), ("ram", "hall", 10), ("saddle", "hall", 9), ("crossbeam", "hall", 26), ("post_left", "hall", 21), ("post_right", "hall", 21), ("table", "hall", 24), ("bed", "hall", 48)])
    m.circuit("spindle", v(6), v(80), rounded(rng.uniform(20, 25)))
    m.heat("friction_law", "spindle", v(330), 12000, rounded(rng.uniform(1.1, 1.7)), decay=v(0.011))
    m.heat("motor_loss", "milling_head", v(420), 12000, rounded(rng.uniform(0.9, 1.6)), idle=v(60))
    m.heat("servo_loss", "saddle", v(160), 0.5, rounded(rng.uniform(0.9, 1.4)), idle=v(20), axis="y")
    m.heat("servo_loss", "table", v(260), 0.4, rounded(rng.uniform(0.9, 1.4)), idle=v(25), axis="x")
    m.displacement("tcp_x", "x", {"post_left": v(1.4), "post_right": v(1.4), "table": -v(1.2)})
    m.displacement("tcp_y", "y", {"crossbeam": v(2.2), "saddle": v(0.9), "bed": -v(1.1)})
    m.displacement("tcp_z", "z", {"milling_head": -v(1.3), "ram": -v(2.4), "post_left": v(1.5), "post_right": v(1.5)})
    return m, dict(hours=(4, 20), drive="speed", top=12000, feeds={"x": 24000, "y": 30000})


def multispindle_automatic(rng, v):
    """A drum of spindles, above and below, gears behind it, and a sump below."""
    m = Machine("multispindle_automatic")
    build(m, v, dict(spindles_upper=15e3, spindles_lower=15e3, drum=0.16e6, gear_case=62e3, motor=34e3, cross_slides=48e3, oil_sump=0.11e6, frame=0.75e6), [("spindles_upper", "drum", 28), ("spindles_lower", "drum", 28), ("drum", "frame", 36), ("gear_case", "drum", 15), ("gear_case", "frame", 24), ("motor", "gear_case", 9), ("cross_slides", "frame", 22), ("oil_sump", "frame", 18),
          ("spindles_lower", "oil_sump", 6), ("drum", "hall", 6), ("gear_case", "hall", 10), ("motor", "hall", 12), ("cross_slides", "hall", 7), ("oil_sump", "hall", 11), ("frame", "hall", 36)])
    m.heat("friction_law", "spindles_upper", v(310), 5000, rounded(rng.uniform(1.0, 1.7)), decay=v(0.012))
    m.heat("friction_law", "spindles_lower", v(310), 5000, rounded(rng.uniform(1.0, 1.7)), decay=v(0.012))
    m.heat("heat_source", "gear_case", v(290), 5000, rounded(rng.uniform(1.0, 1.6)))
    m.heat("motor_loss", "motor", v(420), 5000, rounded(rng.uniform(0.9, 1.6)), idle=v(60))
    m.displacement("turned_diameter", "x", {"drum": v(1.9), "cross_slides": -v(1.7), "spindles_upper": v(0.6)})
    m.displacement("cut_off", "z", {"spindles_lower": v(1.3), "frame": -v(1.2)})
    return m, dict(hours=(2, 13), drive="speed", top=5000)


def bevel_gear_mill(rng, v):
    """A cutter head against a work head on a swivelling base; dry, and the milling power is recorded."""
    m = Machine("bevel_gear_mill")
    build(m, v, dict(cutter_spindle=11e3, cutter_head=54e3, column=0.4e6, work_spindle=22e3, work_head=0.11e6, swivel_base=0.2e6, bed=0.85e6), [("cutter_spindle", "cutter_head", 31), ("cutter_head", "column", 25), ("column", "bed", 37), ("work_spindle", "work_head", 23), ("work_head", "swivel_base", 24), ("swivel_base", "bed", 29),
          ("cutter_head", "hall", 9), ("column", "hall", 17), ("work_spindle", "hall", 3), ("work_head", "hall", 9), ("swivel_base", "hall", 9), ("bed", "hall", 31)])
    m.heat("friction_law", "cutter_spindle", v(270), 1200, rounded(rng.uniform(0.9, 1.5)), decay=v(0.011))
    m.heat("motor_loss", "cutter_head", v(340), 1200, rounded(rng.uniform(0.9, 1.5)), idle=v(50))
    m.heat("cutting_heat", "work_spindle", rounded(rng.uniform(0.05, 0.09), 2))
    m.heat("cutting_heat", "cutter_spindle", rounded(rng.uniform(0.02, 0.05), 2))
    m.heat("servo_loss", "work_head", v(120), 0.2, rounded(rng.uniform(0.9, 1.4)), idle=v(20), axis="x")
    m.displacement("tooth_depth", "x", {"column": v(2.1), "cutter_head": v(0.8), "work_head": -v(1.7)})
    m.displacement("mounting_distance", "z", {"work_spindle": v(1.5), "swivel_base": v(0.9), "bed": -v(1.3)})
    return m, dict(hours=(2, 11), drive="speed+power", top=1200, power=4200, feeds={"x": 12000})


def diamond_lathe(rng, v):
    """An air spindle and two slides on granite, in a quiet room."""
    m = Machine("diamond_lathe")
    build(m, v, dict(air_spindle=4.6e3, headstock=25e3, slide_x=55e3, slide_z=58e3, tool_post=2.6e3, granite=0.6e6), [("air_spindle", "headstock", 8), ("headstock", "slide_z", 10), ("tool_post", "slide_x", 3.5), ("slide_x", "granite", 14), ("slide_z", "granite", 14), ("air_spindle", "hall", 0.8), ("headstock", "hall", 3.5), ("slide_x", "hall", 5), ("slide_z", "hall", 4), ("tool_post", "hall", 0.5), ("granite", "hall", 19)])
    m.circuit("headstock", v(2), v(24), rounded(rng.uniform(19, 23)))
    m.heat("heat_source", "air_spindle", v(75), 8000, rounded(rng.uniform(1.3, 2.0)))
    m.heat("motor_loss", "headstock", v(85), 8000, rounded(rng.uniform(1.0, 1.7)), idle=v(12))
    m.heat("servo_loss", "slide_x", v(32), 0.05, rounded(rng.uniform(0.9, 1.4)), idle=v(6), axis="x")
    m.heat("servo_loss", "slide_z", v(32), 0.05, rounded(rng.uniform(0.9, 1.4)), idle=v(6), axis="z")
    m.displacement("form", "z", {"headstock": v(1.5), "air_spindle": v(1.1), "slide_z": -v(0.9), "tool_post": -v(0.6)})
    m.displacement("centre_height", "y", {"headstock": v(1.3), "tool_post": -v(0.9)})
    return m, dict(hours=(1.5, 12), drive="speed", top=8000, feeds={"x": 3000, "z": 3000}, seen="displacements")


def gearbox_stand(rng, v):
    """A motor, the gearbox that is tested with its oil, a brake with water; the power that the brake takes is recorded."""
    m = Machine("gearbox_stand")
    build(m, v, dict(drive_motor=58e3, torque_meter=6.5e3, test_gearbox=68e3, oil_sump=21e3, brake=72e3, base_frame=0.6e6), [("drive_motor", "base_frame", 17), ("torque_meter", "drive_motor", 4), ("torque_meter", "test_gearbox", 4.5), ("test_gearbox", "oil_sump", 34), ("test_gearbox", "base_frame", 20), ("brake", "base_frame", 16),
          ("drive_motor", "hall", 19), ("torque_meter", "hall", 1.2), ("test_gearbox", "hall", 15), ("brake", "hall", 9), ("base_frame", "hall", 27)])
    m.circuit("brake", v(6), v(85), rounded(rng.uniform(16, 26)))
    m.heat("heat_source", "oil_sump", v(290), 3000, rounded(rng.uniform(1.1, 1.9)))
    m.heat("friction_law", "torque_meter", v(42), 3000, rounded(rng.uniform(1.0, 1.7)), decay=v(0.011))
    m.heat("motor_loss", "drive_motor", v(380), 3000, rounded(rng.uniform(0.9, 1.6)), idle=v(70))
    m.heat("cutting_heat", "test_gearbox", rounded(rng.uniform(0.02, 0.05), 2))
    m.heat("cutting_heat", "brake", rounded(rng.uniform(0.25, 0.4), 2))
    m.displacement("shaft_height", "y", {"test_gearbox": v(2.1), "base_frame": v(1.1)})
    m.displacement("flange_gap", "z", {"drive_motor": -v(1.2), "torque_meter": v(1.6), "test_gearbox": -v(1.4)})
    return m, dict(hours=(1.5, 9), drive="speed+power", top=3000, power=9000)


def facade_test_cell(rng, v):
    """A room behind the facade that is tested, in the open; the heater's power is recorded."""
    m = Machine("facade_test_cell")
    build(m, v, dict(room_air=0.11e6, floor_slab=3.6e6, back_wall=1.5e6, ceiling=1.0e6, facade=0.36e6), [])
    m.air.add("room_air")
    for a, b, g in [("room_air", "floor_slab", 42), ("room_air", "back_wall", 55), ("room_air", "ceiling", 38), ("room_air", "facade", 50), ("floor_slab", "back_wall", 12), ("ceiling", "back_wall", 11), ("room_air", "hall", 13), ("facade", "hall", 46), ("back_wall", "hall", 9), ("ceiling", "hall", 8)]:
        m.link(a, b, v(g))
    m.heat("cutting_heat", "room_air", rounded(rng.uniform(0.75, 0.85), 2))
    m.heat("cutting_heat", "floor_slab", rounded(rng.uniform(0.05, 0.1), 2))
    m.displacement("mullion", "z", {"facade": v(9), "ceiling": -v(4)})
    m.displacement("lintel", "x", {"back_wall": v(6), "floor_slab": -v(5)})
    return m, dict(hours=(18, 90), drive="power", power=2600, outdoor=True)


def hot_plate_welder(rng, v):
    """A hot plate between two slides that press, and their hydraulics; the plate's power is recorded."""
    m = Machine("hot_plate_welder")
    build(m, v, dict(hot_plate=11e3, plate_mount=19e3, slide_left=41e3, slide_right=41e3, hydraulics=42e3, frame=0.36e6), [("hot_plate", "plate_mount", 5), ("plate_mount", "frame", 9), ("slide_left", "frame", 14), ("slide_right", "frame", 14), ("hot_plate", "slide_left", 1.3), ("hot_plate", "slide_right", 1.3), ("hydraulics", "frame", 9),
          ("hot_plate", "hall", 8), ("plate_mount", "hall", 5), ("slide_left", "hall", 6), ("slide_right", "hall", 6), ("hydraulics", "hall", 11), ("frame", "hall", 22)])
    m.circuit("plate_mount", v(2), v(16), rounded(rng.uniform(16, 26)))
    m.heat("cutting_heat", "hot_plate", rounded(rng.uniform(0.75, 0.88), 2))
    m.heat("heat_source", "hydraulics", v(210))
    m.heat("servo_loss", "slide_left", v(90), 0.2, rounded(rng.uniform(0.9, 1.4)), idle=v(16), axis="x")
    m.heat("servo_loss", "slide_right", v(90), 0.2, rounded(rng.uniform(0.9, 1.4)), idle=v(16), axis="z")
    m.displacement("joint_gap", "x", {"slide_left": v(1.6), "slide_right": -v(1.6), "frame": v(0.8)})
    m.displacement("plate_height", "y", {"plate_mount": v(2.2), "frame": -v(1.1)})
    return m, dict(hours=(1.5, 10), drive="power", power=1500, feeds={"x": 12000, "z": 12000})


def tapping_centre(rng, v):
    """A small fast machining centre with a turret of tools over its head."""
    m = Machine("tapping_centre")
    build(m, v, dict(spindle=3.2e3, head=33e3, screw_z=6.5e3, column=0.22e6, table=46e3, base=0.36e6), [("spindle", "head", 21), ("head", "column", 19), ("screw_z", "head", 6), ("screw_z", "column", 7), ("column", "base", 28), ("table", "base", 19), ("head", "hall", 7), ("column", "hall", 13), ("table", "hall", 6), ("base", "hall", 21)])
    m.heat("friction_law", "spindle", v(180), 16000, rounded(rng.uniform(1.1, 1.8)), decay=v(0.012))
    m.heat("motor_loss", "head", v(210), 16000, rounded(rng.uniform(0.9, 1.6)), idle=v(30))
    m.heat("servo_loss", "screw_z", v(95), 0.8, rounded(rng.uniform(0.9, 1.4)), idle=v(10), axis="z")
    m.heat("servo_loss", "table", v(85), 0.8, rounded(rng.uniform(0.9, 1.4)), idle=v(10), axis="x")
    m.displacement("bore_x", "x", {"column": v(1.5), "table": -v(1.4)})
    m.displacement("bore_y", "y", {"head": v(1.9), "column": v(2.4), "base": -v(0.9)})
    m.displacement("bore_depth", "z", {"spindle": v(1.6), "screw_z": v(2.6), "column": -v(2.3)})
    return m, dict(hours=(1.5, 9), drive="speed", top=16000, feeds={"x": 48000, "z": 48000})


def optical_gauge(rng, v):
    """A lamp and a camera over a stage on granite; nothing turns, and the two axes are what is recorded."""
    m = Machine("optical_gauge")
    build(m, v, dict(lamp_house=3.4e3, camera_arm=9.5e3, stage=24e3, granite=0.2e6), [("lamp_house", "camera_arm", 2.6), ("camera_arm", "granite", 4.5), ("stage", "granite", 8), ("lamp_house", "hall", 1.6), ("camera_arm", "hall", 2.1), ("stage", "hall", 3), ("granite", "hall", 9)])
    m.heat("heat_source", "lamp_house", v(38))
    m.heat("servo_loss", "stage", v(48), 0.3, rounded(rng.uniform(0.9, 1.5)), idle=v(7), axis="x")
    m.heat("servo_loss", "camera_arm", v(30), 0.2, rounded(rng.uniform(0.9, 1.5)), idle=v(5), axis="z")
    m.displacement("edge_x", "x", {"stage": v(1.9), "camera_arm": -v(1.5)})
    m.displacement("focus", "z", {"camera_arm": v(2.4), "granite": -v(1.1)})
    return m, dict(hours=(1, 10), drive="feeds", feeds={"x": 18000, "z": 12000}, seen="displacements")


def coil_winder(rng, v):
    """A winding head, a traverse that lays the wire, and the tensioner's brake."""
    m = Machine("coil_winder")
    build(m, v, dict(head_bearing=2.3e3, winding_head=29e3, traverse=15e3, tensioner=3.4e3, bench=0.15e6), [("head_bearing", "winding_head", 15), ("winding_head", "bench", 13), ("traverse", "bench", 8), ("tensioner", "bench", 2.2), ("winding_head", "hall", 6), ("traverse", "hall", 3), ("tensioner", "hall", 1.4), ("bench", "hall", 12)])
    m.heat("friction_law", "head_bearing", v(90), 6000, rounded(rng.uniform(1.0, 1.7)), decay=v(0.012))
    m.heat("motor_loss", "winding_head", v(130), 6000, rounded(rng.uniform(0.9, 1.6)), idle=v(22))
    m.heat("heat_source", "tensioner", v(38), 6000, rounded(rng.uniform(0.9, 1.2)))
    m.heat("servo_loss", "traverse", v(55), 0.15, rounded(rng.uniform(0.9, 1.4)), idle=v(9), axis="x")
    m.displacement("layer_place", "x", {"winding_head": v(1.7), "traverse": -v(1.5), "bench": v(0.7)})
    m.displacement("layer_height", "y", {"winding_head": v(1.4), "head_bearing": v(0.5), "traverse": -v(0.9)})
    return m, dict(hours=(1, 8), drive="speed", top=6000, feeds={"x": 9000})


def pillar_drill(rng, v):
    """Three bodies: a head, its motor behind a belt, and the pillar."""
    m = Machine("pillar_drill")
    build(m, v, dict(drill_head=24e3, motor=11e3, pillar=85e3), [("drill_head", "pillar", 11), ("motor", "drill_head", 4.5), ("drill_head", "hall", 5), ("motor", "hall", 5.5), ("pillar", "hall", 10)])
    m.heat("friction_law", "drill_head", v(120), 3000, rounded(rng.uniform(0.9, 1.6)), decay=v(0.011))
    m.heat("motor_loss", "motor", v(140), 3000, rounded(rng.uniform(0.9, 1.5)), idle=v(25))
    m.displacement("hole_place", "y", {"drill_head": v(1.9), "pillar": v(2.2)})
    m.displacement("hole_depth", "z", {"drill_head": v(1.2), "pillar": -v(2.6)})
    return m, dict(hours=(1, 9), drive="speed", top=3000)


FAMILIES = [crankshaft_grinder, portal_mill, multispindle_automatic, bevel_gear_mill, diamond_lathe, gearbox_stand, facade_test_cell, hot_plate_welder, tapping_centre, optical_gauge, coil_winder, pillar_drill]
TITLES = dict(crankshaft_grinder="crankshaft grinding machine; the grinding power is recorded", portal_mill="portal milling machine", multispindle_automatic="multi-spindle automatic lathe", bevel_gear_mill="bevel gear milling machine; the milling power is recorded", diamond_lathe="diamond turning machine",
              gearbox_stand="test stand for gearboxes; the brake's power is recorded", facade_test_cell="test cell behind a facade; the heater's power and the outdoor temperature are recorded", hot_plate_welder="hot plate welding machine; the plate's power is recorded", tapping_centre="tapping centre", optical_gauge="optical gauge with two axes",
              coil_winder="coil winding machine", pillar_drill="pillar drilling machine")
WORK = dict(crankshaft_grinder=["workhead", "tailstock"], portal_mill=["table"], multispindle_automatic=["cross_slides", "drum"], bevel_gear_mill=["work_spindle", "work_head"], diamond_lathe=["air_spindle", "slide_x"], gearbox_stand=["base_frame", "test_gearbox"], facade_test_cell=["floor_slab"],
            hot_plate_welder=["slide_left", "slide_right"], tapping_centre=["table"], optical_gauge=["stage"], coil_winder=["winding_head", "bench"], pillar_drill=["pillar"])      # where a part or a fixture is clamped, and what is washed
HIGH = dict(crankshaft_grinder=["wheelhead", "workhead", "tailstock"], portal_mill=["crossbeam", "saddle", "ram", "post_left", "post_right"], multispindle_automatic=["drum", "gear_case", "motor"], bevel_gear_mill=["cutter_head", "column", "work_head"], diamond_lathe=["air_spindle", "headstock", "tool_post"],
            gearbox_stand=["drive_motor", "test_gearbox", "brake"], facade_test_cell=["ceiling", "facade", "back_wall"], hot_plate_welder=["hot_plate", "slide_left", "slide_right"], tapping_centre=["head", "column"], optical_gauge=["lamp_house", "camera_arm"], coil_winder=["winding_head", "tensioner"], pillar_drill=["drill_head", "motor"])
FLUID = dict(crankshaft_grinder=["oil_tank"], multispindle_automatic=["oil_sump", "gear_case"], gearbox_stand=["oil_sump"], hot_plate_welder=["hydraulics"], portal_mill=["milling_head"], bevel_gear_mill=["cutter_head"], pillar_drill=["drill_head"])      # what holds oil or coolant that is refilled
DECOYS = [("roof_light", "W_m2"), ("part_dryer", "W"), ("yard", "degC"), ("pallets", "count"), ("chip_conveyor", "1"), ("line_pressure", "percent")]


def drive(rng, time_s, style, top, days=False):
    """A column from 0 to `top`, held from each row on. `lots`: a set-up, one trial part at half the level, then three to eight equal parts with short pauses; and so on. Else as in `tenth`."""
    if style not in OWN_STYLES:
        return tenth.drive(rng, time_s, style, top, days)
    share = time_s / time_s[-1]
    out, t = np.zeros(len(share)), rng.uniform(0.0, 0.05)

    def put(a, b, level):
        out[(share >= a) & (share < b)] = level
    while t < 0.97:
        level, length, pause = round(rng.uniform(0.35, 1), 2), rng.uniform(0.02, 0.06), rng.uniform(0.006, 0.015)
        put(t, t + length, round(level / 2, 2))
        t += length + rng.uniform(0.01, 0.03)
        for _ in range(int(rng.integers(3, 9))):
            put(t, t + length, level)
            t += length + pause
        t += rng.uniform(0.03, 0.09)
    return float(top) * np.round(out, 3)


def pace(rng, plan, channels, n_records):
    """Of the logger [s], as a logger is set, and how many rows a record has, about."""
    n = float(np.exp(rng.uniform(*np.log((75, 1100)))))
    n = max(75.0, min(n, 22000 / (channels * n_records), 1700 / n_records))
    span = 3600 * np.exp(rng.uniform(*np.log(plan["hours"])))
    return min((1, 2, 5, 10, 15, 20, 30, 60, 120, 180, 300, 600, 900), key=lambda d: abs(np.log(d * n / span))), n


def rows(rng, style, dt, n):
    """Times [s], 60 to 1500 of them, in the styles of `ninth`."""
    n = float(np.clip(n, 75, 1100))
    while True:
        t = ninth.rows(rng, style, dt, n)
        if 60 <= len(t) <= 1500:
            return t
        n = float(np.clip(n * (1.2 if len(t) < 60 else 0.85), 60, 1500))


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
    return Record(name, time_s, speed, feeds, power, ninth.hall(rng, time_s, plan.get("outdoor", False)), columns)


def instruments(rng, machine, plan):
    """As in `seventh`, with 25 channels at the most; thermometers have the name of their body and a letter, or are thermocouples of a box."""
    noise, seen = seventh.instruments(rng, machine, plan)
    places = [b for _, b in machine.sensors][:25 - len(machine.displacements)]
    if rng.random() < 0.5:
        machine.sensors = [(f"{b}_{'abcdefghijklmnopqrstuvwxyz'[places[:i].count(b)]}", b) for i, b in enumerate(places)]
    else:
        machine.sensors = [(f"TC{i // 8 + 1}_{i % 8 + 1}", b) for i, b in enumerate(places)]
    return noise, seen


def priors(rng, machine):
    """As in `eighth`."""
    return eighth.priors(rng, machine)
