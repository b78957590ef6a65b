"""Nine more families of machine tools, for the set `twelfth` (README.md), of five to seven bodies; driven, recorded and looked at as in `eleventh`, by one to four records of 200 to 900 rows."""
import numpy as np

import eleventh_families as eleventh
import ninth_families as ninth
from families import rounded
from network import Machine
from third_families import build

STYLES, ROWS, priors, instruments, record = eleventh.STYLES, eleventh.ROWS, eleventh.priors, eleventh.instruments, eleventh.record
DECOYS = [("bay_light", "W_m2"), ("dust_filter", "W"), ("corridor", "degC"), ("parts_done", "count"), ("guard_lamp", "1"), ("air_line", "percent")]


def horizontal_centre(rng, v):
    """Horizontal machining centre; the headstock has a chiller."""
    m = Machine("horizontal_centre")
    build(m, v, dict(spindle=9e3, headstock=55e3, column=0.38e6, screw_y=11e3, rotary_table=0.15e6, pallet=90e3, bed=0.8e6), [("spindle", "headstock", 28), ("headstock", "column", 23), ("screw_y", "column", 11), ("screw_y", "headstock", 6), ("column", "bed", 36), ("rotary_table", "bed", 26), ("pallet", "rotary_table", 19),
          ("headstock", "hall", 9), ("column", "hall", 18), ("rotary_table", "hall", 9), ("pallet", "hall", 8), ("bed", "hall", 30)])
    m.circuit("headstock", v(5), v(55), rounded(rng.uniform(20, 25)))
    m.heat("friction_law", "spindle", v(310), 10000, rounded(rng.uniform(1.1, 1.7)))
    m.heat("motor_loss", "headstock", v(360), 10000, rounded(rng.uniform(0.9, 1.5)))
    m.heat("servo_loss", "screw_y", v(110), 0.6, rounded(rng.uniform(0.9, 1.3)), idle=v(14), axis="y")
    m.heat("servo_loss", "bed", v(150), 0.6, rounded(rng.uniform(0.9, 1.3)), idle=v(16), axis="z")
    m.displacement("tcp_y", "y", {"headstock": v(1.8), "column": v(2.3), "screw_y": v(1.2)})
    m.displacement("tcp_z", "z", {"spindle": v(1.4), "headstock": v(1.9), "bed": -v(1.1)})
    return m, dict(hours=(3, 14), drive="speed", top=10000, feeds={"y": 36000, "z": 36000})


def hard_turning_lathe(rng, v):
    """A lathe that turns hard and dry; the cutting power is recorded."""
    m = Machine("hard_turning_lathe")
    build(m, v, dict(main_spindle=13e3, headstock=72e3, carriage=46e3, turret=25e3, tailstock=32e3, bed=0.62e6), [("main_spindle", "headstock", 30), ("headstock", "bed", 29), ("carriage", "bed", 21), ("turret", "carriage", 14), ("tailstock", "bed", 16), ("main_spindle", "hall", 4), ("headstock", "hall", 11), ("carriage", "hall", 6), ("turret", "hall", 4),
          ("tailstock", "hall", 5), ("bed", "hall", 26)])
    m.heat("friction_law", "main_spindle", v(240), 4000, rounded(rng.uniform(1.0, 1.6)))
    m.heat("motor_loss", "headstock", v(300), 4000, rounded(rng.uniform(0.9, 1.5)), idle=v(40))
    m.heat("cutting_heat", "turret", rounded(rng.uniform(0.03, 0.06), 2))
    m.heat("cutting_heat", "main_spindle", rounded(rng.uniform(0.02, 0.05), 2))
    m.heat("servo_loss", "carriage", v(90), 0.3, rounded(rng.uniform(0.9, 1.3)), idle=v(15), axis="z")
    m.displacement("diameter", "x", {"headstock": v(2.0), "turret": -v(1.2), "carriage": -v(0.9)})
    m.displacement("shoulder", "z", {"main_spindle": v(1.5), "headstock": v(1.1), "bed": -v(1.0)})
    return m, dict(hours=(2, 11), drive="speed+power", top=4000, power=4000, feeds={"z": 15000})


def long_bed_mill(rng, v):
    """A travelling column with a ram and a gearbox before a long bed."""
    m = Machine("long_bed_mill")
    build(m, v, dict(spindle=14e3, gearbox=34e3, ram=0.11e6, column=0.55e6, screw_x=24e3, table=0.5e6, bed=1.5e6), [("spindle", "ram", 26), ("gearbox", "ram", 22), ("spindle", "gearbox", 9), ("ram", "column", 27), ("column", "bed", 44), ("screw_x", "bed", 16), ("table", "bed", 38), ("gearbox", "hall", 7), ("ram", "hall", 11), ("column", "hall", 24),
          ("screw_x", "hall", 3), ("table", "hall", 22), ("bed", "hall", 50)])
    m.circuit("gearbox", v(5), v(50), rounded(rng.uniform(21, 27)))
    m.heat("friction_law", "spindle", v(290), 5000, rounded(rng.uniform(1.0, 1.6)), decay=v(0.011))
    m.heat("heat_source", "gearbox", v(420), 5000, rounded(rng.uniform(1.1, 1.7)))
    m.heat("servo_loss", "screw_x", v(190), 0.5, rounded(rng.uniform(0.9, 1.3)), idle=v(24), axis="x")
    m.heat("servo_loss", "column", v(150), 0.5, rounded(rng.uniform(0.9, 1.3)), idle=v(18), axis="y")
    m.displacement("tcp_x", "x", {"screw_x": v(2.2), "table": -v(1.1), "column": v(0.8)})
    m.displacement("tcp_y", "y", {"ram": v(2.6), "spindle": v(0.9), "column": v(0.7)})
    m.displacement("tcp_z", "z", {"column": v(2.8), "ram": -v(0.8), "bed": v(0.9)})
    return m, dict(hours=(4, 20), drive="speed", top=5000, feeds={"x": 30000, "y": 24000})


def internal_grinder(rng, v):
    """Internal grinding machine with a fast cooled spindle; the grinding power is recorded."""
    m = Machine("internal_grinder")
    build(m, v, dict(wheel_spindle=5.5e3, spindle_housing=17e3, cross_slide=65e3, workhead=42e3, chuck=12e3, bed=0.5e6), [("wheel_spindle", "spindle_housing", 17), ("spindle_housing", "cross_slide", 15), ("cross_slide", "bed", 24), ("chuck", "workhead", 13), ("workhead", "bed", 22), ("spindle_housing", "hall", 4), ("cross_slide", "hall", 7), ("chuck", "hall", 3),
          ("workhead", "hall", 8), ("bed", "hall", 24)])
    m.circuit("spindle_housing", v(3), v(26), rounded(rng.uniform(19, 24)))
    m.heat("friction_law", "wheel_spindle", v(190), 30000, rounded(rng.uniform(1.2, 1.8)))
    m.heat("motor_loss", "spindle_housing", v(230), 30000, rounded(rng.uniform(1.0, 1.6)))
    m.heat("cutting_heat", "chuck", rounded(rng.uniform(0.05, 0.09), 2))
    m.heat("heat_source", "workhead", v(85), turning=True)
    m.displacement("bore_radius", "x", {"cross_slide": v(1.7), "spindle_housing": v(1.2), "workhead": -v(1.6)})
    m.displacement("bore_depth", "z", {"wheel_spindle": v(1.3), "spindle_housing": v(1.1), "chuck": -v(0.9)})
    return m, dict(hours=(2, 10), drive="speed+power", top=30000, power=2400)


def profile_gear_grinder(rng, v):
    """A wheelhead on a column against a work table; the stroke is an axis, and the wheel spindle has a chiller."""
    m = Machine("profile_gear_grinder")
    build(m, v, dict(wheel_spindle=8.5e3, wheelhead=48e3, column=0.45e6, stroke_screw=9e3, work_table=0.17e6, dresser=14e3, bed=0.9e6), [("wheel_spindle", "wheelhead", 24), ("wheelhead", "column", 22), ("stroke_screw", "column", 9), ("stroke_screw", "wheelhead", 5), ("column", "bed", 38), ("work_table", "bed", 29), ("dresser", "bed", 9), ("wheelhead", "hall", 8),
          ("column", "hall", 19), ("work_table", "hall", 12), ("dresser", "hall", 3), ("bed", "hall", 34)])
    m.circuit("wheel_spindle", v(3), v(32), rounded(rng.uniform(19, 24)))
    m.heat("friction_law", "wheel_spindle", v(260), 6000, rounded(rng.uniform(1.1, 1.7)), decay=v(0.011))
    m.heat("motor_loss", "wheelhead", v(280), 6000, rounded(rng.uniform(0.9, 1.5)))
    m.heat("servo_loss", "stroke_screw", v(150), 0.4, rounded(rng.uniform(0.9, 1.3)), idle=v(16), axis="z")
    m.heat("heat_source", "work_table", v(110), turning=True)
    m.displacement("flank", "x", {"column": v(2.0), "wheelhead": v(1.3), "work_table": -v(1.5)})
    m.displacement("stroke_place", "z", {"stroke_screw": v(2.1), "column": v(1.6), "bed": -v(0.8)})
    return m, dict(hours=(3, 14), drive="speed", top=6000, feeds={"z": 24000})


def mill_turn_centre(rng, v):
    """Two spindles that face each other and a milling head over them, in one enclosure."""
    m = Machine("mill_turn_centre")
    build(m, v, dict(main_spindle=42e3, counter_spindle=30e3, mill_head=38e3, cross_carriage=95e3, screw_z=12e3, bed=0.85e6), [("main_spindle", "bed", 27), ("counter_spindle", "bed", 20), ("mill_head", "cross_carriage", 18), ("cross_carriage", "bed", 28), ("screw_z", "cross_carriage", 7), ("screw_z", "bed", 9), ("main_spindle", "hall", 7),
          ("counter_spindle", "hall", 6), ("mill_head", "hall", 6), ("cross_carriage", "hall", 9), ("bed", "hall", 32)])
    m.circuit("mill_head", v(4), v(36), rounded(rng.uniform(20, 25)))
    m.heat("friction_law", "main_spindle", v(330), 5000, rounded(rng.uniform(1.0, 1.6)))
    m.heat("motor_loss", "main_spindle", v(260), 5000, rounded(rng.uniform(0.9, 1.5)), idle=v(30))
    m.heat("heat_source", "counter_spindle", v(240), 5000, rounded(rng.uniform(1.0, 1.6)))
    m.heat("heat_source", "mill_head", v(160), turning=True)
    m.heat("servo_loss", "screw_z", v(110), 0.6, rounded(rng.uniform(0.9, 1.3)), idle=v(14), axis="z")
    m.heat("servo_loss", "cross_carriage", v(110), 0.5, rounded(rng.uniform(0.9, 1.3)), idle=v(16), axis="x")
    m.displacement("diameter", "x", {"main_spindle": v(1.7), "cross_carriage": -v(1.6), "mill_head": -v(1.1)})
    m.displacement("length", "z", {"main_spindle": v(1.4), "screw_z": v(1.9), "bed": -v(0.9)})
    m.displacement("height", "y", {"mill_head": v(1.6), "main_spindle": -v(1.5), "bed": v(0.6)})
    return m, dict(hours=(2, 12), drive="speed", top=5000, feeds={"x": 30000, "z": 36000})


def micro_mill(rng, v):
    """A small fast spindle on a portal of granite."""
    m = Machine("micro_mill")
    build(m, v, dict(spindle=2.8e3, spindle_mount=11e3, z_slide=20e3, portal=0.22e6, xy_table=26e3, granite=0.45e6), [("spindle", "spindle_mount", 9), ("spindle_mount", "z_slide", 8), ("z_slide", "portal", 8), ("portal", "granite", 17), ("xy_table", "granite", 9), ("spindle_mount", "hall", 2.5), ("z_slide", "hall", 2.5), ("portal", "hall", 9), ("xy_table", "hall", 3.5),
          ("granite", "hall", 15)])
    m.circuit("spindle_mount", v(2), v(14), rounded(rng.uniform(19, 23)))
    m.heat("friction_law", "spindle", v(75), 40000, rounded(rng.uniform(1.3, 1.9)))
    m.heat("motor_loss", "spindle_mount", v(70), 40000, rounded(rng.uniform(1.0, 1.6)))
    m.heat("servo_loss", "xy_table", v(34), 0.2, rounded(rng.uniform(0.9, 1.3)), idle=v(6), axis="x")
    m.heat("servo_loss", "z_slide", v(22), 0.1, rounded(rng.uniform(0.9, 1.3)), idle=v(5), axis="z")
    m.displacement("groove_x", "x", {"portal": v(1.6), "xy_table": -v(1.3)})
    m.displacement("groove_depth", "z", {"spindle": v(1.2), "spindle_mount": v(1.3), "z_slide": v(0.9), "portal": -v(1.1)})
    return m, dict(hours=(1.5, 10), drive="speed", top=40000, feeds={"x": 12000, "z": 6000}, seen="displacements")


def transfer_unit(rng, v):
    """A boring unit of a transfer line: a quill, its motor behind a belt, and a slide."""
    m = Machine("transfer_unit")
    build(m, v, dict(quill=8e3, unit_case=38e3, belt_motor=16e3, slide=44e3, index_table=0.2e6, base=0.34e6), [("quill", "unit_case", 24), ("belt_motor", "unit_case", 7), ("unit_case", "slide", 18), ("slide", "base", 20), ("index_table", "base", 23), ("unit_case", "hall", 7), ("belt_motor", "hall", 8), ("slide", "hall", 5), ("index_table", "hall", 11),
          ("base", "hall", 19)])
    m.heat("friction_law", "quill", v(210), 3500, rounded(rng.uniform(1.0, 1.6)), decay=v(0.012))
    m.heat("heat_source", "unit_case", v(130), 3500, rounded(rng.uniform(0.9, 1.4)))
    m.heat("motor_loss", "belt_motor", v(220), 3500, rounded(rng.uniform(0.9, 1.5)), idle=v(30))
    m.heat("servo_loss", "slide", v(95), 0.3, rounded(rng.uniform(0.9, 1.3)), idle=v(14), axis="z")
    m.displacement("bore_height", "y", {"unit_case": v(2.0), "slide": v(1.0), "index_table": -v(1.4)})
    m.displacement("bore_depth", "z", {"quill": v(1.7), "unit_case": v(1.2), "base": -v(0.8)})
    return m, dict(hours=(1.5, 9), drive="speed", top=3500, feeds={"z": 18000})


def glass_cutting_table(rng, v):
    """A bridge over a table with a blower; nothing turns, and the two axes are what is recorded."""
    m = Machine("glass_cutting_table")
    build(m, v, dict(cutting_head=6e3, bridge=70e3, drive_rail=34e3, table_top=0.21e6, blower_box=26e3), [("cutting_head", "bridge", 5), ("bridge", "drive_rail", 10), ("drive_rail", "table_top", 11), ("blower_box", "table_top", 8), ("cutting_head", "hall", 1.5), ("bridge", "hall", 9), ("drive_rail", "hall", 5), ("table_top", "hall", 21), ("blower_box", "hall", 6)])
    m.heat("heat_source", "blower_box", v(120))
    m.heat("servo_loss", "drive_rail", v(140), 1.2, rounded(rng.uniform(0.9, 1.3)), idle=v(15), axis="x")
    m.heat("servo_loss", "bridge", v(110), 1.2, rounded(rng.uniform(0.9, 1.3)), idle=v(12), axis="y")
    m.displacement("cut_x", "x", {"drive_rail": v(2.1), "table_top": -v(1.7)})
    m.displacement("cut_y", "y", {"bridge": v(2.4), "cutting_head": v(0.6), "table_top": -v(1.2)})
    return m, dict(hours=(1.5, 10), drive="feeds", feeds={"x": 72000, "y": 72000}, seen="displacements")


FAMILIES = [horizontal_centre, hard_turning_lathe, long_bed_mill, internal_grinder, profile_gear_grinder, mill_turn_centre, micro_mill, transfer_unit, glass_cutting_table]
TITLES = dict(horizontal_centre="horizontal machining centre", hard_turning_lathe="lathe for hard turning; the cutting power is recorded", long_bed_mill="long bed milling machine", internal_grinder="internal grinding machine; the grinding power is recorded", profile_gear_grinder="profile gear grinding machine",
              mill_turn_centre="mill-turn centre", micro_mill="micro milling machine on granite", transfer_unit="boring unit of a transfer line", glass_cutting_table="glass cutting table with two axes")
WORK = dict(horizontal_centre=["pallet"], hard_turning_lathe=["main_spindle"], long_bed_mill=["table"], internal_grinder=["chuck"], profile_gear_grinder=["work_table"], mill_turn_centre=["main_spindle", "counter_spindle"], micro_mill=["xy_table"], transfer_unit=["index_table"], glass_cutting_table=["table_top"])      # where parts are clamped
BED = dict(horizontal_centre="bed", hard_turning_lathe="bed", long_bed_mill="bed", internal_grinder="bed", profile_gear_grinder="bed", mill_turn_centre="bed", micro_mill="granite", transfer_unit="base", glass_cutting_table="table_top")      # the body that is on the ground
HIGH = dict(horizontal_centre=["headstock", "column"], hard_turning_lathe=["headstock", "turret"], long_bed_mill=["ram", "column", "gearbox"], internal_grinder=["spindle_housing", "workhead"], profile_gear_grinder=["wheelhead", "column"], mill_turn_centre=["mill_head", "main_spindle", "counter_spindle"],
            micro_mill=["spindle_mount", "z_slide", "portal"], transfer_unit=["unit_case", "belt_motor"], glass_cutting_table=["bridge", "cutting_head"])
INSIDE = dict(horizontal_centre=["pallet", "rotary_table", "headstock"], hard_turning_lathe=["main_spindle", "turret", "carriage", "tailstock"], long_bed_mill=["table", "ram"], internal_grinder=["spindle_housing", "cross_slide", "chuck"], profile_gear_grinder=["wheelhead", "work_table", "dresser"],
              mill_turn_centre=["main_spindle", "counter_spindle", "mill_head", "cross_carriage"], micro_mill=["spindle_mount", "z_slide", "xy_table"], transfer_unit=["unit_case", "slide", "index_table"], glass_cutting_table=["cutting_head", "bridge"])      # what an enclosure has about it


def pace(rng, plan, channels, n_records):
    """Of the logger [s], as a logger is set, and how many rows a record has, about."""
    n = float(np.exp(rng.uniform(*np.log((220, 850)))))
    n = max(220.0, min(n, 20000 / (channels * n_records), 1500 / n_records))
    span = 3600 * np.exp(rng.uniform(*np.log(plan["hours"])))
    return min((5, 10, 15, 20, 30, 60, 120, 180, 300), key=lambda d: abs(np.log(d * n / span))), n


def rows(rng, style, dt, n):
    """Times [s], 200 to 900 of them, in the styles of `ninth`."""
    while True:
        t = ninth.rows(rng, style, dt, n)
        if 200 <= len(t) <= 900:
            return t
        n = float(np.clip(n * (1.2 if len(t) < 200 else 0.85), 100, 1500))
