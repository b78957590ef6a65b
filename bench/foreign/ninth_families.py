"""Fifteen more families of machines, for the set `ninth` (README.md), of three to nine bodies; driven by takts, changes of product, runs now and then, saw teeth and by the ways of the three sets before; halls with a set-back at night and a gate, and loggers that write more while they are watched."""
import numpy as np

import eighth_families as eighth
import seventh_families as seventh
import sixth_families as sixth
from families import rounded
from network import Machine, Record
from third_families import build

OWN_STYLES = ["takt", "product_change", "sporadic", "sawtooth"]
STYLES = OWN_STYLES + OWN_STYLES + ["night_shift", "telegraph", "long_run", "warm_up_and_cut", "recipe", "trials", "series", "iso_steps"]
ROWS = ["even", "watched", "gaps", "lost", "slower"]


def centerless_grinder(rng, v):
    """Two wheels and a blade between them; coolant takes most of what is ground."""
    m = Machine("centerless_grinder")
    build(m, v, dict(wheel_spindle=17e3, wheel_housing=95e3, regulating_spindle=9e3, regulating_slide=64e3, blade=1.3e3, coolant=0.12e6, bed=0.62e6),
          [("wheel_spindle", "wheel_housing", 26), ("wheel_housing", "bed", 34), ("regulating_spindle", "regulating_slide", 17), ("regulating_slide", "bed", 15), ("blade", "regulating_slide", 6), ("blade", "coolant", 19), ("wheel_housing", "coolant", 8), ("coolant", "bed", 26), ("coolant", "hall", 17),
           ("wheel_housing", "hall", 12), ("regulating_slide", "hall", 7), ("bed", "hall", 31)])
    m.heat("friction_law", "wheel_spindle", v(420), 1900, rounded(rng.uniform(1.0, 1.7)), decay=v(0.012))
    m.heat("heat_source", "regulating_spindle", v(95), 1900, rounded(rng.uniform(0.9, 1.4)))
    m.heat("motor_loss", "wheel_housing", v(330), 1900, rounded(rng.uniform(0.9, 1.7)), idle=v(60))
    m.heat("cutting_heat", "blade", rounded(rng.uniform(0.02, 0.04), 2))
    m.heat("cutting_heat", "coolant", rounded(rng.uniform(0.3, 0.5), 2))
    m.heat("servo_loss", "regulating_slide", v(90), 0.02, rounded(rng.uniform(0.8, 1.3)), idle=v(15), axis="x")
    m.displacement("diameter", "x", {"wheel_housing": v(2.4), "regulating_slide": -v(2.1), "bed": v(1.2)})
    m.displacement("height", "z", {"blade": v(0.9), "bed": v(1.7)})
    return m, dict(hours=(2, 11), drive="speed+power", top=1900, power=5500, feeds={"x": 1200})


def wire_drawer(rng, v):
    """Three dies in a row, a capstan with water behind each."""
    m = Machine("wire_drawer")
    stages = ("1", "2", "3")
    build(m, v, {**{f"die_{i}": 0.9e3 for i in stages}, **{f"capstan_{i}": 15e3 for i in stages}, "gear_train": 70e3, "frame": 0.32e6},
          [(f"die_{i}", f"capstan_{i}", 3) for i in stages] + [(f"die_{i}", "frame", 5) for i in stages] + [(f"capstan_{i}", "gear_train", 7) for i in stages] + [("gear_train", "frame", 21), ("gear_train", "hall", 14), ("frame", "hall", 24)] + [(f"capstan_{i}", "hall", 4) for i in stages])
    for i in stages:
        m.circuit(f"capstan_{i}", v(3), v(34), rounded(rng.uniform(18, 27)))
        m.heat("cutting_heat", f"die_{i}", rounded(rng.uniform(0.02, 0.035), 2))
        m.heat("cutting_heat", f"capstan_{i}", rounded(rng.uniform(0.1, 0.16), 2))
    m.heat("friction_law", "gear_train", v(620), 650, rounded(rng.uniform(1.0, 1.6)), decay=v(0.011))
    m.displacement("die_line", "y", {"die_1": v(0.8), "die_3": -v(0.7), "frame": v(1.5)})
    return m, dict(hours=(1, 7), drive="speed+power", top=650, power=7000)


def scara_robot(rng, v):
    """Two arms and a quill; three axes are recorded as feeds."""
    m = Machine("scara_robot")
    build(m, v, dict(pillar=34e3, shoulder_drive=3.1e3, arm_1=11e3, elbow_drive=2.3e3, arm_2=7.5e3, quill=2.9e3), [("shoulder_drive", "pillar", 5), ("shoulder_drive", "arm_1", 4), ("arm_1", "elbow_drive", 3), ("elbow_drive", "arm_2", 3.4), ("arm_2", "quill", 1.5), ("pillar", "hall", 7), ("arm_1", "hall", 3.1), ("arm_2", "hall", 2.3), ("quill", "hall", 0.8)])
    m.heat("servo_loss", "shoulder_drive", v(85), 0.5, rounded(rng.uniform(1.0, 1.8)), idle=v(9), axis="x")
    m.heat("servo_loss", "elbow_drive", v(62), 0.5, rounded(rng.uniform(1.0, 1.8)), idle=v(6), axis="y")
    m.heat("servo_loss", "quill", v(21), 0.2, rounded(rng.uniform(0.9, 1.4)), axis="z")
    m.heat("heat_source", "pillar", v(30))
    m.displacement("reach", "x", {"arm_1": v(3.6), "arm_2": v(2.9)})
    m.displacement("tip_z", "z", {"pillar": v(4.1), "quill": -v(2.2), "arm_2": v(0.7)})
    return m, dict(hours=(0.7, 6), drive="feeds", feeds={"x": 30000, "y": 30000, "z": 12000})


def roots_blower(rng, v):
    """Rotors that warm by what they compress, between plates and a case of gears in oil."""
    m = Machine("roots_blower")
    build(m, v, dict(rotors=15e3, side_plate=12e3, gear_case=17e3, casing=44e3, motor=31e3, base=0.13e6), [("rotors", "casing", 9), ("rotors", "side_plate", 6), ("side_plate", "casing", 19), ("side_plate", "gear_case", 12), ("gear_case", "hall", 8), ("casing", "base", 13), ("motor", "base", 11), ("motor", "gear_case", 3), ("casing", "hall", 14), ("motor", "hall", 13), ("base", "hall", 11)])
    m.heat("heat_source", "rotors", v(560), 3000, rounded(rng.uniform(1.5, 2.3)))
    m.heat("friction_law", "gear_case", v(270), 3000, rounded(rng.uniform(1.1, 1.7)), decay=v(0.013))
    m.heat("heat_source", "side_plate", v(85), 3000, rounded(rng.uniform(0.9, 1.4)))
    m.heat("motor_loss", "motor", v(410), 3000, rounded(rng.uniform(0.9, 1.7)), idle=v(55))
    m.displacement("rotor_gap", "x", {"rotors": v(2.1), "casing": -v(2.3)})
    return m, dict(hours=(1, 8), drive="speed", top=3000)


def decanter(rng, v):
    """A bowl, a screw in it and a gear between both; what is separated runs through at its own temperature."""
    m = Machine("decanter")
    build(m, v, dict(bowl=0.1e6, screw=52e3, bearing_gear=4.1e3, bearing_weir=3.9e3, cyclo_gear=13e3, frame=0.36e6, motor=27e3), [("bowl", "screw", 30), ("bearing_gear", "bowl", 8), ("bearing_weir", "bowl", 8), ("bearing_gear", "frame", 17), ("bearing_weir", "frame", 18), ("cyclo_gear", "bowl", 9), ("cyclo_gear", "bearing_gear", 3), ("cyclo_gear", "hall", 6),
          ("motor", "frame", 10), ("motor", "hall", 13), ("frame", "hall", 26), ("bowl", "hall", 15)])
    m.circuit("screw", v(9), v(95), rounded(rng.uniform(18, 44)))
    m.heat("friction_law", "bearing_gear", v(260), 3600, rounded(rng.uniform(1.1, 1.7)), decay=v(0.012))
    m.heat("heat_source", "bearing_weir", v(235), 3600, rounded(rng.uniform(1.1, 1.7)))
    m.heat("heat_source", "bowl", v(420), 3600, rounded(rng.uniform(2.0, 2.8)))
    m.heat("cutting_heat", "cyclo_gear", rounded(rng.uniform(0.16, 0.26), 2))
    m.heat("motor_loss", "motor", v(360), 3600, rounded(rng.uniform(0.9, 1.6)), idle=v(50))
    m.displacement("bowl_end", "z", {"bowl": v(3.4), "frame": -v(2.5)})
    m.displacement("weir_bearing", "y", {"bearing_weir": v(1.3), "frame": v(1.1)})
    return m, dict(hours=(2, 14), drive="speed+power", top=3600, power=1600)


def fuel_cell_stack(rng, v):
    """Cells in three blocks between end plates on one loop; the electric power is recorded."""
    m = Machine("fuel_cell_stack")
    build(m, v, dict(cells_front=9e3, cells_middle=14e3, cells_back=9.2e3, plate_front=8e3, plate_back=8.4e3, loop=17e3, humidifier=6.5e3), [("cells_front", "cells_middle", 8), ("cells_middle", "cells_back", 8), ("plate_front", "cells_front", 10), ("plate_back", "cells_back", 10), ("cells_front", "loop", 26), ("cells_middle", "loop", 40), ("cells_back", "loop", 26),
          ("humidifier", "loop", 7), ("plate_front", "hall", 3), ("plate_back", "hall", 3.2), ("humidifier", "hall", 2.2), ("loop", "hall", 3)])
    m.circuit("loop", v(12), v(240), rounded(rng.uniform(42, 62)))
    m.heat("cutting_heat", "cells_front", rounded(rng.uniform(0.14, 0.2), 2))
    m.heat("cutting_heat", "cells_middle", rounded(rng.uniform(0.24, 0.32), 2))
    m.heat("cutting_heat", "cells_back", rounded(rng.uniform(0.14, 0.2), 2))
    m.heat("heat_source", "humidifier", v(45))
    m.displacement("stack_length", "z", {"cells_front": v(0.9), "cells_middle": v(1.4), "cells_back": v(0.9), "plate_front": v(0.5)})
    return m, dict(hours=(1, 9), drive="power", power=2600)


def press_brake(rng, v):
    """Two cylinders and their oil on one frame; the ram's moves and the back gauge's are recorded."""
    m = Machine("press_brake")
    build(m, v, dict(oil=70e3, pump=13e3, cylinder_left=42e3, cylinder_right=43e3, ram=0.36e6, back_gauge=19e3, side_frame=0.9e6), [("pump", "oil", 24), ("oil", "cylinder_left", 20), ("oil", "cylinder_right", 19), ("cylinder_left", "side_frame", 18), ("cylinder_right", "side_frame", 18), ("cylinder_left", "ram", 9), ("cylinder_right", "ram", 9), ("back_gauge", "side_frame", 6),
          ("oil", "hall", 12), ("pump", "hall", 4), ("ram", "hall", 14), ("side_frame", "hall", 36), ("back_gauge", "hall", 3)])
    m.heat("servo_loss", "oil", v(640), 0.1, rounded(rng.uniform(0.8, 1.3)), idle=v(150), axis="y")
    m.heat("servo_loss", "pump", v(230), 0.1, rounded(rng.uniform(0.9, 1.4)), idle=v(90), axis="y")
    m.heat("servo_loss", "back_gauge", v(75), 0.3, rounded(rng.uniform(0.9, 1.5)), idle=v(8), axis="x")
    m.displacement("bend_left", "y", {"cylinder_left": v(1.6), "ram": v(1.2), "side_frame": -v(2.1)})
    m.displacement("bend_right", "y", {"cylinder_right": v(1.6), "ram": v(1.2), "side_frame": -v(2.1)})
    m.displacement("gauge", "x", {"back_gauge": v(2.6), "side_frame": v(0.8)})
    return m, dict(hours=(2, 13), drive="feeds", feeds={"y": 6000, "x": 18000})


def roundness_tester(rng, v):
    """Some watts on granite: a slow spindle and a probe's arm on a column."""
    m = Machine("roundness_tester")
    build(m, v, dict(turntable=7e3, spindle=8.5e3, column=23e3, arm=2.3e3, granite=0.36e6), [("turntable", "spindle", 3), ("spindle", "granite", 4), ("column", "granite", 4.5), ("arm", "column", 1.4), ("turntable", "hall", 0.9), ("column", "hall", 2.6), ("arm", "hall", 0.5), ("granite", "hall", 9)])
    m.heat("heat_source", "spindle", v(13), 20, rounded(rng.uniform(0.8, 1.4)))
    m.heat("motor_loss", "spindle", v(7), 20, rounded(rng.uniform(0.8, 1.5)), idle=v(2))
    m.heat("servo_loss", "column", v(9), 0.02, rounded(rng.uniform(0.8, 1.4)), idle=v(2), axis="z")
    m.heat("heat_source", "arm", v(2))
    m.displacement("radius", "x", {"turntable": v(1.4), "arm": -v(2.7), "column": v(1.1)})
    m.displacement("axis_tilt", "y", {"column": v(2.3), "granite": -v(1.6)})
    return m, dict(hours=(1, 11), drive="speed", top=20, feeds={"z": 1200}, seen="displacements")


def wheelset_lathe(rng, v):
    """Two sides that are nearly alike, each with headstock, driving rollers and carriage."""
    m = Machine("wheelset_lathe")
    sides = ("left", "right")
    build(m, v, {**{f"headstock_{s}": 0.3e6 for s in sides}, **{f"rollers_{s}": 22e3 for s in sides}, **{f"carriage_{s}": 64e3 for s in sides}, "hydraulics": 85e3, "bed": 1.9e6},
          [(f"rollers_{s}", f"headstock_{s}", 17) for s in sides] + [(f"headstock_{s}", "bed", 45) for s in sides] + [(f"carriage_{s}", "bed", 21) for s in sides] + [(f"headstock_{s}", "hall", 22) for s in sides] + [(f"carriage_{s}", "hall", 7) for s in sides] + [("hydraulics", "bed", 11), ("hydraulics", "hall", 15), ("bed", "hall", 75)])
    for s in sides:
        m.heat("heat_source", f"rollers_{s}", v(330), 70, rounded(rng.uniform(0.9, 1.5)))
        m.heat("motor_loss", f"headstock_{s}", v(640), 70, rounded(rng.uniform(0.9, 1.6)), idle=v(80))
    m.heat("servo_loss", "carriage_left", v(120), 0.05, rounded(rng.uniform(0.8, 1.3)), idle=v(14), axis="x")
    m.heat("servo_loss", "carriage_right", v(120), 0.05, rounded(rng.uniform(0.8, 1.3)), idle=v(14), axis="z")
    m.heat("heat_source", "hydraulics", v(420), turning=True)
    m.displacement("wheel_left", "x", {"carriage_left": v(2.2), "headstock_left": -v(2.6), "bed": v(0.8)})
    m.displacement("wheel_right", "x", {"carriage_right": v(2.2), "headstock_right": -v(2.6), "bed": v(0.8)})
    return m, dict(hours=(4, 20), drive="speed", top=70, feeds={"x": 3000, "z": 3000})


def xray_tube(rng, v):
    """An anode that turns in a vacuum, in oil, in a housing; the beam's power is recorded."""
    m = Machine("xray_tube")
    build(m, v, dict(anode=0.95e3, bearing=0.26e3, stator=1.7e3, oil=6.5e3, housing=9.5e3), [("anode", "oil", 2.3), ("anode", "bearing", 0.16), ("bearing", "oil", 0.7), ("stator", "oil", 4), ("oil", "housing", 17), ("housing", "hall", 8)])
    m.heat("cutting_heat", "anode", rounded(rng.uniform(0.75, 0.9), 2))
    m.heat("cutting_heat", "housing", rounded(rng.uniform(0.02, 0.05), 2))
    m.heat("friction_law", "bearing", v(9), 9000, rounded(rng.uniform(1.1, 1.8)), decay=v(0.008))
    m.heat("motor_loss", "stator", v(34), 9000, rounded(rng.uniform(1.0, 1.8)), idle=v(7))
    m.displacement("focus", "z", {"anode": v(0.4), "bearing": v(0.5), "housing": -v(1.6)})
    return m, dict(hours=(0.5, 4), drive="speed+power", top=9000, power=190)


def escalator_drive(rng, v):
    """In a pit with air of its own, by day and for days."""
    m = Machine("escalator_drive")
    build(m, v, dict(motor=21e3, gear=27e3, brake=4.2e3, main_shaft=47e3, handrail_drive=9e3, pit_air=15e3, truss=0.85e6), [])
    m.air.add("pit_air")
    for a, b, g in [("motor", "gear", 10), ("motor", "brake", 3), ("gear", "truss", 15), ("gear", "main_shaft", 6), ("main_shaft", "truss", 12), ("handrail_drive", "main_shaft", 2.4), ("motor", "pit_air", 12), ("gear", "pit_air", 8), ("main_shaft", "pit_air", 6), ("handrail_drive", "pit_air", 3.5), ("brake", "pit_air", 2), ("truss", "pit_air", 16), ("pit_air", "hall", 30), ("truss", "hall", 38)]:
        m.link(a, b, v(g))
    m.heat("motor_loss", "motor", v(390), 960, rounded(rng.uniform(0.9, 1.6)), idle=v(60))
    m.heat("friction_law", "gear", v(310), 960, rounded(rng.uniform(1.0, 1.6)), decay=v(0.012))
    m.heat("heat_source", "handrail_drive", v(90), 960, rounded(rng.uniform(0.9, 1.4)))
    m.heat("heat_source", "main_shaft", v(70), turning=True)
    m.heat("heat_source", "brake", v(22))
    return m, dict(hours=(9, 60), drive="speed", top=960)


def waterjet_pump(rng, v):
    """Oil drives two plungers that take turns; the hydraulic power is recorded."""
    m = Machine("waterjet_pump")
    build(m, v, dict(motor=62e3, oil_pump=24e3, oil=75e3, plunger_left=14e3, plunger_right=14.5e3, accumulator=23e3, skid=0.16e6), [("motor", "oil_pump", 8), ("motor", "skid", 12), ("oil_pump", "oil", 28), ("oil", "plunger_left", 15), ("oil", "plunger_right", 15), ("plunger_left", "accumulator", 6), ("plunger_right", "accumulator", 6), ("oil", "skid", 13),
          ("accumulator", "skid", 5), ("motor", "hall", 24), ("oil", "hall", 10), ("accumulator", "hall", 5), ("skid", "hall", 16)])
    m.circuit("oil", v(15), v(210), rounded(rng.uniform(26, 38)))
    m.heat("cutting_heat", "oil", rounded(rng.uniform(0.05, 0.09), 2))
    m.heat("cutting_heat", "plunger_left", rounded(rng.uniform(0.015, 0.025), 3))
    m.heat("cutting_heat", "plunger_right", rounded(rng.uniform(0.015, 0.025), 3))
    m.heat("friction_law", "oil_pump", v(680), 1480, rounded(rng.uniform(1.0, 1.6)), decay=v(0.01))
    m.heat("motor_loss", "motor", v(820), 1480, rounded(rng.uniform(0.9, 1.6)), idle=v(110))
    m.displacement("seal_gap", "x", {"plunger_left": v(1.4), "accumulator": -v(1.2), "skid": v(0.7)})
    return m, dict(hours=(1.5, 9), drive="speed+power", top=1480, power=15e3)


def ultramicrotome(rng, v):
    """An arm that cuts slices of some nanometres; its moves are recorded as feeds."""
    m = Machine("ultramicrotome")
    build(m, v, dict(knife=0.19e3, arm=0.95e3, stand=6.4e3), [("knife", "stand", 0.32), ("arm", "stand", 0.5), ("knife", "hall", 0.07), ("arm", "hall", 0.24), ("stand", "hall", 0.9)])
    m.heat("servo_loss", "arm", v(1.9), 0.02, rounded(rng.uniform(0.9, 1.5)), idle=v(0.3), axis="z")
    m.heat("servo_loss", "stand", v(1.5), 0.02, rounded(rng.uniform(0.9, 1.5)), axis="x")
    m.heat("heat_source", "knife", v(0.5))
    m.displacement("slice", "z", {"arm": v(2.8), "knife": -v(1.1), "stand": -v(1.4)})
    m.displacement("edge", "x", {"knife": v(1.3), "stand": v(1.9)})
    return m, dict(hours=(0.4, 4), drive="feeds", feeds={"z": 1200, "x": 1200}, seen="displacements")


def tunnel_borer(rng, v):
    """A main bearing as wide as a room, four motors about it and oil for all; the cutting power is recorded."""
    m = Machine("tunnel_borer")
    motors = [f"motor_{i + 1}" for i in range(4)]
    build(m, v, {"main_bearing": 0.55e6, "gear_ring": 0.42e6, **{x: 90e3 for x in motors}, "oil": 0.24e6, "bulkhead": 2.6e6}, [("main_bearing", "gear_ring", 160), ("main_bearing", "oil", 130), ("gear_ring", "oil", 150), ("main_bearing", "bulkhead", 140)] + [(x, "gear_ring", 26) for x in motors] + [(x, "bulkhead", 40) for x in motors] + [("oil", "bulkhead", 60), ("bulkhead", "hall", 320)] + [(x, "hall", 35) for x in motors])
    m.circuit("oil", v(22), v(330), rounded(rng.uniform(18, 30)))
    for x in motors:
        m.heat("cutting_heat", x, rounded(rng.uniform(0.012, 0.018), 3))
    m.heat("friction_law", "main_bearing", v(5200), 6, rounded(rng.uniform(0.8, 1.4)), decay=v(0.011))
    m.heat("heat_source", "gear_ring", v(3100), 6, rounded(rng.uniform(0.9, 1.5)))
    m.displacement("seal_path", "x", {"main_bearing": v(3.2), "bulkhead": -v(3.6)})
    return m, dict(hours=(6, 48), drive="speed+power", top=6, power=0.2e6)


def voice_coil_stage(rng, v):
    """Three bodies, the first warm within a minute; the coil's power is recorded."""
    m = Machine("voice_coil_stage")
    build(m, v, dict(coil=62, carriage=0.72e3, magnet=1.9e3), [("coil", "carriage", 0.7), ("coil", "magnet", 0.25), ("coil", "hall", 0.12), ("carriage", "hall", 0.5), ("carriage", "magnet", 0.2), ("magnet", "hall", 0.8)])
    m.heat("cutting_heat", "coil", rounded(rng.uniform(0.7, 0.85), 2))
    m.heat("cutting_heat", "magnet", rounded(rng.uniform(0.02, 0.06), 2))
    m.heat("heat_source", "carriage", v(1.2))
    m.displacement("stage", "x", {"coil": v(0.2), "carriage": v(1.7), "magnet": -v(1.1)})
    m.displacement("lift", "z", {"carriage": v(0.8), "magnet": v(1.3)})
    return m, dict(hours=(0.3, 3), drive="power", power=26)


FAMILIES = [centerless_grinder, wire_drawer, scara_robot, roots_blower, decanter, fuel_cell_stack, press_brake, roundness_tester, wheelset_lathe, xray_tube, escalator_drive, waterjet_pump, ultramicrotome, tunnel_borer, voice_coil_stage]
TITLES = dict(centerless_grinder="centreless grinding machine; the grinding power is recorded", wire_drawer="wire drawing machine with three dies; the drawing power is recorded", scara_robot="SCARA robot; its axes are recorded as feeds", roots_blower="Roots blower", decanter="decanter centrifuge; the screw's power is recorded",
              fuel_cell_stack="fuel cell stack; its electric power is recorded", press_brake="press brake; moves of the ram and the back gauge are recorded as feeds", roundness_tester="roundness measuring machine", wheelset_lathe="lathe for wheelsets", xray_tube="X-ray tube with a rotating anode; the beam's power is recorded",
              escalator_drive="drive of an escalator", waterjet_pump="high-pressure pump for water jets; the hydraulic power is recorded", ultramicrotome="ultramicrotome; its moves are recorded as feeds", tunnel_borer="main drive of a tunnel boring machine; the cutting power is recorded", voice_coil_stage="stage with a voice coil, whose power is recorded")
DECOYS = [("grid_hum", "V"), ("work_light", "W"), ("skylight", "W_m2"), ("damper", "percent"), ("strokes", "count"), ("basement", "degC"), ("suction", "1")]


def drive(rng, time_s, style, top, days=False):
    """A column from 0 to `top`, held from each row on. `takt` one level with short stops at one rhythm and two breaks; `product_change` blocks of one level each, set-ups between them; `sporadic` single runs of very different length; `sawtooth` levels that climb within each run and begin anew. Else as the sets before."""
    if style not in OWN_STYLES:
        return eighth.drive(rng, time_s, style, top, days)
    share = time_s / time_s[-1]
    out = np.zeros(len(share))

    def put(a, b, level):
        out[(share >= a) & (share < b)] = level
    if style == "takt":
        begin, takt, use, level = rng.uniform(0.01, 0.08), rng.uniform(0.03, 0.07), rng.uniform(0.6, 0.9), round(rng.uniform(0.6, 1), 2)
        t = begin
        while t < 0.97:
            put(t, t + use * takt, level if rng.random() < 0.85 else round(level / 2, 2))
            t += takt
        for _ in range(2):
            t = rng.uniform(0.2, 0.9)
            put(t, t + rng.uniform(0.04, 0.1), 0.0)
    elif style == "product_change":
        t = rng.uniform(0, 0.05)
        while t < 1:
            length, level = rng.uniform(0.1, 0.25), round(rng.uniform(0.3, 1), 2)
            put(t, t + length, level)
            t += length + rng.uniform(0.02, 0.09)
    elif style == "sporadic":
        t = rng.uniform(0.01, 0.1)
        while t < 0.98:
            length = min(0.3, 0.02 + rng.exponential(0.07))
            put(t, t + length, round(rng.uniform(0.35, 1), 2))
            t += length + 0.02 + rng.exponential(0.06)
    else:
        t = rng.uniform(0, 0.05)
        while t < 1:
            length, steps = rng.uniform(0.15, 0.3), int(rng.integers(3, 6))
            low = rng.uniform(0.15, 0.4)
            for i in range(steps):
                put(t + i * length / steps, t + (i + 1) * length / steps, round(low + (1 - low) * i / (steps - 1), 2))
            t += length + rng.uniform(0.03, 0.1)
    return float(top) * np.round(out, 3)


def pace(rng, plan, channels, n_records):
    return seventh.pace(rng, plan, channels, n_records)


def rows(rng, style, dt, n):
    """Times [s]. watched: every row for one or two whiles, and else each fourth; the rest as in `eighth`."""
    t = eighth.rows(rng, "even" if style == "watched" else style, dt, n)
    if style == "watched":
        k = np.arange(len(t))
        keep = k % 4 == 0
        for _ in range(int(rng.integers(1, 3))):
            begin = rng.uniform(0, 0.75)
            keep |= (k >= begin * len(t)) & (k < (begin + rng.uniform(0.15, 0.4)) * len(t))
        keep[:2] = keep[-1] = True
        return t[keep]
    return t


def hall(rng, time_s, outdoor):
    """Heating that is set back for a while and turned up again, and a gate that is opened now and then; or the halls of the sets before."""
    kind = rng.random()
    if outdoor or kind < 0.6:
        return (sixth if kind < 0.3 else seventh).hall(rng, time_s, outdoor)
    share, n = time_s / time_s[-1], len(time_s)
    set_back = np.zeros(n)
    a = rng.uniform(0.05, 0.6)
    set_back[(share > a) & (share < a + rng.uniform(0.15, 0.35))] = -rng.uniform(1, 4)
    y, x, tau = np.full(n, rng.uniform(16, 26)), 0.0, rng.uniform(0.04, 0.15)
    for k in range(1, n):
        x = set_back[k - 1] + (x - set_back[k - 1]) * np.exp(-(share[k] - share[k - 1]) / tau)
        y[k] += x
    for _ in range(int(rng.integers(0, 4))):
        t = rng.uniform(0, 0.95)
        y = y - rng.uniform(0.4, 1.8) * (share > t) * np.exp(-np.maximum(0, share - t) / rng.uniform(0.01, 0.04))
    walk, x = np.empty(n), 0.0
    for k in range(n):
        e = np.exp(-(share[k] - share[k - 1]) / 0.2) if k else 0.0
        x = e * x + np.sqrt(1 - e * e) * 0.18 * rng.standard_normal()
        walk[k] = x
    return np.round(y + np.convolve(np.pad(walk, 3, mode="edge"), np.ones(7) / 7, mode="valid"), 2)


def record(rng, name, plan, time_s, styles, column=None):
    """styles: of speed, of power, of feeds; each axis moves separately."""
    n = len(time_s)
    speed, power = np.zeros(n), np.zeros(n)
    if "top" in plan:
        speed = np.round(drive(rng, time_s, styles[0], plan["top"]), 0 if plan["top"] > 300 else 2)
    if "power" in plan:
        load = drive(rng, time_s, styles[1], 1.0)
        if plan["drive"] == "speed+power":
            load = np.where(speed > 0, 0.1 + 0.9 * load, 0.0)
        power = np.array([float(f"{p:.4g}") for p in plan["power"] * load])
    feeds = {axis: np.round(drive(rng, time_s, styles[2], top), 0) / 60000 for axis, top in plan.get("feeds", {}).items()}
    columns = {column[0]: (column[1], seventh.further(rng, time_s, column[1]))} if column else {}
    return Record(name, time_s, speed, feeds, power, hall(rng, time_s, plan.get("outdoor", False)), columns)


def instruments(rng, machine, plan):
    """As in `seventh`; thermometers have numbers of a list of measuring points, or the first letters of their body and a number."""
    noise, seen = seventh.instruments(rng, machine, plan)
    places = [b for _, b in machine.sensors]
    if rng.random() < 0.5:
        first = int(rng.integers(10, 60))
        machine.sensors = [(f"MP{first + 2 * i}", b) for i, b in enumerate(places)]
    else:
        machine.sensors = [("".join(w[:2] for w in b.split("_")).upper() + f"_T{i + 1}", b) for i, b in enumerate(places)]
    return noise, seen


def priors(rng, machine):
    """As in `eighth`."""
    return eighth.priors(rng, machine)
