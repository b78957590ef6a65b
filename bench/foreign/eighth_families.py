"""Fifteen more families of machines, for the set `eighth` (README.md), of two to nine bodies; driven by shifts, random telegraphs, long runs and by the ways of the two sets before; how they are seen, and how loggers write and lose rows."""
import numpy as np

import seventh_families as seventh
import sixth_families as sixth
import third
from families import rounded
from network import Machine, Record
from third_families import build

OWN_STYLES = ["night_shift", "telegraph", "long_run", "warm_up_and_cut"]
STYLES = OWN_STYLES + OWN_STYLES + ["series", "tool_list", "soak_steps", "recipe", "walk", "trials", "trips", "iso_steps"]
ROWS = ["even", "gaps", "lost", "slower", "two_paces"]


def broaching_machine(rng, v):
    """A long ram pulled by oil; its feed is recorded."""
    m = Machine("broaching_machine")
    build(m, v, dict(broach=9e3, ram=60e3, cylinder=38e3, oil_tank=0.19e6, work=5e3, fixture=24e3, column=0.42e6),
          [("broach", "ram", 12), ("ram", "column", 15), ("cylinder", "ram", 9), ("cylinder", "oil_tank", 34), ("cylinder", "column", 12), ("work", "fixture", 19), ("broach", "work", 4), ("fixture", "column", 13), ("oil_tank", "hall", 21), ("column", "hall", 24), ("oil_tank", "column", 6)])
    m.circuit("oil_tank", v(7), v(60), rounded(rng.uniform(28, 40)))
    m.heat("servo_loss", "oil_tank", v(1300), 0.12, rounded(rng.uniform(0.8, 1.3)), idle=v(240), axis="z")
    m.heat("servo_loss", "broach", v(260), 0.12, rounded(rng.uniform(0.9, 1.4)), axis="z")
    m.heat("servo_loss", "fixture", v(110), 0.05, rounded(rng.uniform(0.9, 1.4)), axis="x")
    m.displacement("profile", "x", {"broach": v(1.3), "ram": v(1.7), "fixture": -v(1.6)})
    m.displacement("stroke", "z", {"column": v(3.9), "ram": -v(2.2)})
    return m, dict(hours=(1.5, 9), drive="feeds", feeds={"z": 7200, "x": 3000})


def die_caster(rng, v):
    """Two halves of a die on two tempering circuits; the metal's heat is recorded as power."""
    m = Machine("die_caster")
    build(m, v, dict(die_fixed=0.11e6, die_moving=0.12e6, sleeve=12e3, platen_fixed=0.5e6, platen_moving=0.46e6, tie_bars=0.3e6), [("die_fixed", "die_moving", 60), ("die_fixed", "platen_fixed", 55), ("die_moving", "platen_moving", 52), ("sleeve", "die_fixed", 18), ("sleeve", "platen_fixed", 14),
          ("platen_fixed", "tie_bars", 34), ("platen_moving", "tie_bars", 26), ("die_fixed", "hall", 9), ("die_moving", "hall", 11), ("platen_fixed", "hall", 24), ("platen_moving", "hall", 23), ("tie_bars", "hall", 15)])
    m.circuit("die_fixed", v(11), v(170), rounded(rng.uniform(60, 110)))
    m.circuit("die_moving", v(12), v(180), rounded(rng.uniform(60, 110)))
    m.heat("cutting_heat", "die_fixed", rounded(rng.uniform(0.28, 0.38), 2))
    m.heat("cutting_heat", "die_moving", rounded(rng.uniform(0.3, 0.4), 2))
    m.heat("cutting_heat", "sleeve", rounded(rng.uniform(0.05, 0.09), 2))
    m.displacement("parting", "z", {"die_fixed": v(0.9), "die_moving": v(0.9), "tie_bars": -v(2.7)})
    m.displacement("offset", "y", {"platen_fixed": v(2.1), "platen_moving": -v(2.2)})
    return m, dict(hours=(3, 16), drive="power", power=14e3)


def accelerator_magnet(rng, v):
    """Four coils about a yoke with one water circuit for two of them each; current times voltage is recorded."""
    m = Machine("accelerator_magnet")
    build(m, v, dict(coil_1=21e3, coil_2=21e3, coil_3=22e3, coil_4=21e3, yoke=0.7e6, beam_pipe=5e3, girder=0.5e6), [(f"coil_{i + 1}", "yoke", 13) for i in range(4)] + [("beam_pipe", "yoke", 3), ("yoke", "girder", 24), ("yoke", "hall", 17), ("girder", "hall", 29), ("beam_pipe", "hall", 1.2)])
    for i in range(4):
        m.circuit(f"coil_{i + 1}", v(2.2), v(75), rounded(rng.uniform(22, 28)))
        m.heat("cutting_heat", f"coil_{i + 1}", rounded(rng.uniform(0.19, 0.23), 2))
    m.displacement("axis_x", "x", {"yoke": v(2.3), "girder": v(1.1)})
    m.displacement("axis_y", "y", {"yoke": v(1.9), "girder": v(2.6)})
    return m, dict(hours=(3, 20), drive="power", power=7500)


def brake_rig(rng, v):
    """Disc and pads: speed and braking power are recorded; warm within minutes."""
    m = Machine("brake_rig")
    build(m, v, dict(disc=4.6e3, pad_in=0.34e3, pad_out=0.33e3, caliper=3.4e3, fluid=0.7e3, hub=6.5e3, rig=70e3), [("pad_in", "disc", 3), ("pad_out", "disc", 3), ("pad_in", "caliper", 1.6), ("pad_out", "caliper", 1.5), ("caliper", "fluid", 2.2), ("disc", "hub", 5), ("hub", "rig", 7),
          ("caliper", "rig", 4), ("disc", "hall", 9), ("caliper", "hall", 2.1), ("hub", "hall", 2.6), ("rig", "hall", 12)])
    m.heat("cutting_heat", "disc", rounded(rng.uniform(0.55, 0.7), 2))
    m.heat("cutting_heat", "pad_in", rounded(rng.uniform(0.05, 0.09), 2))
    m.heat("cutting_heat", "pad_out", rounded(rng.uniform(0.05, 0.09), 2))
    m.heat("friction_law", "hub", v(75), 1200, rounded(rng.uniform(0.9, 1.4)), decay=v(0.011))
    m.displacement("coning", "x", {"disc": v(3.3), "hub": -v(1.2)})
    return m, dict(hours=(0.4, 3.5), drive="speed+power", top=1200, power=900)


def radio_dish(rng, v):
    """In the open; its two axes are recorded as feeds."""
    m = Machine("radio_dish")
    build(m, v, dict(panels=0.22e6, backup=0.6e6, hub=0.35e6, elevation_drive=24e3, azimuth_drive=28e3, pedestal=2.2e6, receiver=9e3), [("panels", "backup", 45), ("backup", "hub", 38), ("hub", "elevation_drive", 14), ("elevation_drive", "pedestal", 11), ("azimuth_drive", "pedestal", 17), ("hub", "pedestal", 22),
          ("receiver", "hub", 5), ("panels", "hall", 260), ("backup", "hall", 120), ("hub", "hall", 24), ("pedestal", "hall", 75), ("azimuth_drive", "hall", 5), ("elevation_drive", "hall", 4), ("receiver", "hall", 3)])
    m.heat("servo_loss", "azimuth_drive", v(420), 0.02, rounded(rng.uniform(0.9, 1.5)), idle=v(50), axis="x")
    m.heat("servo_loss", "elevation_drive", v(360), 0.02, rounded(rng.uniform(0.9, 1.5)), idle=v(60), axis="y")
    m.heat("heat_source", "receiver", v(140))
    m.displacement("focus", "z", {"panels": v(1.6), "backup": v(2.5), "hub": -v(1.4)})
    m.displacement("pointing", "y", {"backup": v(2.2), "pedestal": -v(2.9)})
    return m, dict(hours=(10, 60), drive="feeds", feeds={"x": 1200, "y": 1200}, outdoor=True)


def length_comparator(rng, v):
    """A carriage along a scale under a cover; its heat sources are a lamp, a motor and the people next to it."""
    m = Machine("length_comparator")
    build(m, v, dict(scale=1.9e3, gauge=0.8e3, carriage=11e3, granite=0.9e6, cover_air=4e3, laser=2.6e3), [])
    m.air.add("cover_air")
    for a, b, g in [("scale", "granite", 1.5), ("gauge", "granite", 0.8), ("scale", "cover_air", 1.3), ("gauge", "cover_air", 0.7), ("carriage", "granite", 2.5), ("carriage", "cover_air", 3), ("granite", "cover_air", 7), ("laser", "granite", 0.9), ("laser", "hall", 1.1), ("granite", "hall", 12), ("cover_air", "hall", 6)]:
        m.link(a, b, v(g))
    m.heat("servo_loss", "carriage", v(16), 0.05, rounded(rng.uniform(0.8, 1.4)), idle=v(3), axis="x")
    m.heat("heat_source", "laser", v(11))
    m.heat("heat_source", "cover_air", v(5))
    m.displacement("length", "x", {"scale": v(9.0), "gauge": -v(8.5), "granite": v(1.2)})
    m.displacement("cosine", "y", {"carriage": v(1.6), "granite": -v(1.1)})
    return m, dict(hours=(3, 24), drive="feeds", feeds={"x": 3000}, seen="displacements")


def test_engine(rng, v):
    """Fuel's power and speed are recorded."""
    m = Machine("test_engine")
    build(m, v, dict(piston=0.5e3, liner=2.4e3, head=9e3, oil=9e3, coolant=16e3, block=34e3, crank=14e3), [("piston", "liner", 18), ("piston", "oil", 9), ("liner", "coolant", 95), ("head", "coolant", 110), ("head", "block", 25), ("liner", "block", 30), ("oil", "block", 28), ("crank", "oil", 24), ("crank", "block", 15),
          ("oil", "hall", 7), ("block", "hall", 16), ("head", "hall", 4)])
    m.circuit("coolant", v(22), v(420), rounded(rng.uniform(45, 75)))
    m.heat("cutting_heat", "piston", rounded(rng.uniform(0.03, 0.05), 2))
    m.heat("cutting_heat", "head", rounded(rng.uniform(0.1, 0.16), 2))
    m.heat("cutting_heat", "liner", rounded(rng.uniform(0.06, 0.1), 2))
    m.heat("friction_law", "crank", v(520), 3600, rounded(rng.uniform(1.1, 1.7)), decay=v(0.012))
    return m, dict(hours=(0.6, 5), drive="speed+power", top=3600, power=16e3)


def slot_coater(rng, v):
    """A die over a roll that turns slowly; the web brings the hall's warmth, the die has its own water."""
    m = Machine("slot_coater")
    build(m, v, dict(die=24e3, die_holder=40e3, roll=0.1e6, bearing_left=4e3, bearing_right=4.1e3, pump=7e3, frame=0.36e6), [("die", "die_holder", 20), ("die_holder", "frame", 11), ("bearing_left", "roll", 9), ("bearing_right", "roll", 9), ("bearing_left", "frame", 14), ("bearing_right", "frame", 14),
          ("pump", "die", 2.4), ("pump", "frame", 4), ("roll", "hall", 21), ("die", "hall", 3), ("frame", "hall", 26), ("pump", "hall", 2.2)])
    m.circuit("die", v(3), v(45), rounded(rng.uniform(24, 45)))
    m.heat("heat_source", "bearing_left", v(85), 60, rounded(rng.uniform(0.9, 1.5)))
    m.heat("heat_source", "bearing_right", v(85), 60, rounded(rng.uniform(0.9, 1.5)))
    m.heat("motor_loss", "pump", v(95), 60, rounded(rng.uniform(0.8, 1.4)), idle=v(25))
    m.displacement("gap_left", "z", {"die": v(1.4), "roll": v(2.2), "bearing_left": -v(0.9)})
    m.displacement("gap_right", "z", {"die": v(1.4), "roll": v(2.2), "bearing_right": -v(0.9)})
    return m, dict(hours=(1.5, 10), drive="speed", top=60)


def electron_writer(rng, v):
    """A stage in a vacuum beneath a column; lens currents are constant, the stage's moves are recorded."""
    m = Machine("electron_writer")
    build(m, v, dict(mask=0.32e3, holder=1.6e3, stage=15e3, lens=7e3, column=34e3, chamber=0.3e6), [("mask", "holder", 0.35), ("holder", "stage", 1.1), ("stage", "chamber", 2.3), ("lens", "column", 6), ("column", "chamber", 10), ("chamber", "hall", 17), ("column", "hall", 4)])
    m.circuit("lens", v(1.1), v(20), rounded(rng.uniform(19, 24)))
    m.heat("servo_loss", "stage", v(17), 0.03, rounded(rng.uniform(0.9, 1.5)), idle=v(2), axis="x")
    m.heat("servo_loss", "holder", v(5), 0.03, rounded(rng.uniform(0.9, 1.5)), axis="y")
    m.heat("heat_source", "lens", v(75))
    m.displacement("placement_x", "x", {"mask": v(1.1), "stage": v(1.9), "column": -v(2.1)})
    m.displacement("placement_y", "y", {"holder": v(1.8), "chamber": -v(1.2)})
    return m, dict(hours=(1.5, 14), drive="feeds", feeds={"x": 1800, "y": 1800}, seen="displacements")


def flywheel_store(rng, v):
    """A rotor in a vacuum that runs for hours; windage, magnets and a motor that also brakes."""
    m = Machine("flywheel_store")
    build(m, v, dict(rotor=24e3, bearing_top=2.6e3, bearing_low=2.9e3, stator=8e3, vessel=46e3), [("rotor", "vessel", 2.2), ("bearing_top", "rotor", 0.8), ("bearing_low", "rotor", 0.9), ("bearing_top", "vessel", 6), ("bearing_low", "vessel", 6), ("stator", "vessel", 17), ("stator", "rotor", 0.7), ("vessel", "hall", 13)])
    m.circuit("stator", v(2.5), v(26), rounded(rng.uniform(18, 28)))
    m.heat("heat_source", "rotor", v(32), 16000, rounded(rng.uniform(1.8, 2.6)))
    m.heat("motor_loss", "stator", v(260), 16000, rounded(rng.uniform(1.0, 1.8)), idle=v(35))
    m.heat("friction_law", "bearing_top", v(42), 16000, rounded(rng.uniform(1.0, 1.6)), decay=v(0.012))
    m.heat("heat_source", "bearing_low", v(48), 16000, rounded(rng.uniform(1.0, 1.6)))
    m.displacement("lift", "z", {"rotor": v(1.9), "vessel": -v(2.4)})
    return m, dict(hours=(2, 14), drive="speed", top=16000)


def board_drill(rng, v):
    """Five spindles side by side on one beam, one water circuit that meets the beam; speed and two feeds."""
    m = Machine("board_drill")
    spindles = [f"spindle_{c}" for c in "abcde"]
    build(m, v, {**{s: 1.7e3 for s in spindles}, "beam": 52e3, "table": 48e3, "granite": 1.1e6}, [(s, "beam", 11) for s in spindles] + [("beam", "granite", 19), ("table", "granite", 14), ("beam", "hall", 9), ("table", "hall", 8), ("granite", "hall", 34)] + [(s, "hall", 0.7) for s in spindles])
    m.circuit("beam", v(5), v(55), rounded(rng.uniform(19, 24)))
    for s in spindles:
        m.heat("heat_source", s, v(65), 120000, rounded(rng.uniform(1.2, 1.9)))
    m.heat("servo_loss", "table", v(310), 0.4, rounded(rng.uniform(0.9, 1.5)), idle=v(30), axis="y")
    m.heat("servo_loss", "beam", v(190), 0.4, rounded(rng.uniform(0.9, 1.5)), axis="x")
    m.displacement("pitch", "x", {"spindle_a": v(1.2), "beam": v(4.4), "granite": -v(0.9)})
    m.displacement("depth", "z", {"spindle_c": v(2.6), "beam": -v(0.8)})
    m.displacement("table_y", "y", {"table": v(3.1)})
    return m, dict(hours=(1, 7), drive="speed", top=120000, feeds={"x": 24000, "y": 24000})


def server_rack(rng, v):
    """Three boards and a supply between a cold and a hot aisle of their own; the power is recorded, and the fans' speed."""
    m = Machine("server_rack")
    build(m, v, dict(board_1=1.5e3, board_2=1.5e3, board_3=1.6e3, supply=3.1e3, drives=4e3, hot_aisle=5e3, rack=34e3), [])
    m.air.add("hot_aisle")
    for a, b, g in [("board_1", "hot_aisle", 6), ("board_2", "hot_aisle", 6), ("board_3", "hot_aisle", 5.5), ("supply", "hot_aisle", 5), ("drives", "hot_aisle", 4), ("drives", "rack", 3), ("supply", "rack", 2), ("board_1", "hall", 3), ("board_2", "hall", 3), ("board_3", "hall", 3), ("rack", "hot_aisle", 6),
                    ("rack", "hall", 9), ("hot_aisle", "hall", 32)]:
        m.link(a, b, v(g))
    for b in ("board_1", "board_2", "board_3"):
        m.heat("cutting_heat", b, rounded(rng.uniform(0.2, 0.27), 2))
    m.heat("cutting_heat", "supply", rounded(rng.uniform(0.07, 0.12), 2))
    m.heat("heat_source", "drives", v(45))
    m.heat("heat_source", "hot_aisle", v(60), 9000, rounded(rng.uniform(1.8, 2.8)))
    return m, dict(hours=(0.6, 8), drive="speed+power", top=9000, power=1100)


def hydrostatic_slide(rng, v):
    """A slide on oil: the pump warms it, the gaps warm it, a cooler holds it; speed of the pump and one feed."""
    m = Machine("hydrostatic_slide")
    build(m, v, dict(pump=9e3, oil=0.13e6, rail=0.24e6, slide=0.16e6, bed=0.9e6), [("pump", "oil", 42), ("oil", "rail", 75), ("oil", "slide", 62), ("rail", "bed", 48), ("slide", "hall", 17), ("bed", "hall", 42), ("oil", "hall", 12), ("pump", "hall", 5)])
    m.circuit("oil", v(9), v(85), rounded(rng.uniform(20, 26)))
    m.heat("friction_law", "oil", v(900), 1500, rounded(rng.uniform(0.9, 1.4)), decay=v(0.01))
    m.heat("motor_loss", "pump", v(330), 1500, rounded(rng.uniform(1.0, 1.8)), idle=v(60))
    m.heat("servo_loss", "slide", v(240), 0.5, rounded(rng.uniform(1.2, 2.0)), axis="x")
    m.displacement("float", "z", {"slide": v(1.5), "rail": v(1.7), "bed": -v(1.1)})
    m.displacement("travel", "x", {"slide": v(4.0), "bed": -v(3.4)})
    return m, dict(hours=(3, 16), drive="speed", top=1500, feeds={"x": 18000})


def solenoid_valve(rng, v):
    """Two bodies; the coil's power is recorded."""
    m = Machine("solenoid_valve")
    build(m, v, dict(coil=75, body=310), [("coil", "body", 0.35), ("coil", "hall", 0.06), ("body", "hall", 0.28)])
    m.heat("cutting_heat", "coil", rounded(rng.uniform(0.7, 0.9), 2))
    m.displacement("seat", "z", {"coil": v(0.3), "body": v(0.9)})
    return m, dict(hours=(0.3, 3), drive="power", power=13)


def ring_frame(rng, v):
    """A spinning frame: a head with motor and gear, and a rail in four pieces with their spindles."""
    m = Machine("ring_frame")
    rails = [f"rail_{i + 1}" for i in range(4)]
    build(m, v, {"motor": 26e3, "gear_head": 34e3, **{r: 22e3 for r in rails}, "frame": 0.4e6}, [("motor", "gear_head", 9), ("gear_head", "rail_1", 5), ("gear_head", "frame", 12)] + [(rails[i], rails[i + 1], 4) for i in range(3)] + [(r, "frame", 7) for r in rails] + [(r, "hall", 9) for r in rails])
    for a, b, g in [("motor", "hall", 11), ("gear_head", "hall", 6), ("frame", "hall", 22)]:
        m.link(a, b, v(g))
    for r in rails:
        m.heat("heat_source", r, v(190), 18000, rounded(rng.uniform(1.1, 1.8)))
    m.heat("motor_loss", "motor", v(520), 18000, rounded(rng.uniform(0.9, 1.6)), idle=v(70))
    m.heat("friction_law", "gear_head", v(210), 18000, rounded(rng.uniform(1.0, 1.6)), decay=v(0.012))
    m.displacement("rail_end", "x", {"rail_4": v(2.8), "frame": v(1.4)})
    return m, dict(hours=(2, 16), drive="speed", top=18000)


FAMILIES = [broaching_machine, die_caster, accelerator_magnet, brake_rig, radio_dish, length_comparator, test_engine, slot_coater, electron_writer, flywheel_store, board_drill, server_rack, hydrostatic_slide, solenoid_valve, ring_frame]
TITLES = dict(broaching_machine="broaching machine; two feeds are recorded", die_caster="die casting machine; what the metal brings is recorded as power", accelerator_magnet="magnet of an accelerator; its electric power is recorded", brake_rig="brake rig; speed and braking power are recorded",
              radio_dish="dish of a radio telescope; its axes are recorded as feeds", length_comparator="length comparator beneath a cover", test_engine="engine on a test bed; fuel's power and speed are recorded", slot_coater="slot coater", electron_writer="electron beam writer; the stage's moves are recorded as feeds",
              flywheel_store="flywheel store", board_drill="drilling machine for circuit boards with five spindles", server_rack="rack of servers; power and the fans' speed are recorded", hydrostatic_slide="slide on hydrostatic guideways", solenoid_valve="solenoid valve; the coil's power is recorded", ring_frame="ring spinning frame")
DECOYS = [("pressure_line", "V"), ("uv_lamp", "W"), ("flap", "percent"), ("pieces", "count"), ("corridor", "degC"), ("air_knife", "1")]


def drive(rng, time_s, style, top, days=False):
    """A column from 0 to `top`, held from each row on. `night_shift` two long runs of different use with a rest between; `telegraph` on and off, or between two levels, at random times; `long_run` one level for most of the record, once or twice
    interrupted; `warm_up_and_cut` a warming run at a low level, then cuts at one level with pauses of one length. Else as the sets before."""
    if style in seventh.STYLES:
        return seventh.drive(rng, time_s, style, top, days)
    if style in sixth.STYLES:
        return sixth.drive(rng, time_s, style, top, days)
    share = time_s / time_s[-1]
    out = np.zeros(len(share))

    def put(a, b, level):
        out[(share >= a) & (share < b)] = level
    if style == "night_shift":
        a, b, c = rng.uniform(0.02, 0.1), rng.uniform(0.38, 0.48), rng.uniform(0.55, 0.68)
        for begin, end, use in ((a, b, rng.uniform(0.7, 0.95)), (c, rng.uniform(0.88, 0.98), rng.uniform(0.35, 0.7))):
            t, levels = begin, np.round(rng.uniform(0.4, 1, 3), 2)
            while t < end:
                length = rng.uniform(0.03, 0.08)
                put(t, min(end, t + use * length), levels[int(rng.integers(3))])
                t += length
    elif style == "telegraph":
        low, high, t, on = (0.0 if rng.random() < 0.6 else round(rng.uniform(0.15, 0.35), 2)), round(rng.uniform(0.65, 1), 2), 0.0, rng.random() < 0.5
        while t < 1:
            length = rng.exponential(0.06) + 0.015
            put(t, t + length, high if on else low)
            t, on = t + length, not on
        put(*np.sort(rng.uniform(0.3, 0.6, 2)), 0.0)
    elif style == "long_run":
        put(rng.uniform(0.01, 0.1), rng.uniform(0.6, 0.85), round(rng.uniform(0.6, 1), 2))
        for _ in range(int(rng.integers(1, 3))):
            t = rng.uniform(0.15, 0.6)
            put(t, t + rng.uniform(0.02, 0.08), 0.0)
        if rng.random() < 0.5:
            put(0.9, 1.1, round(rng.uniform(0.2, 0.6), 2))
    else:
        put(rng.uniform(0, 0.03), 0.2, round(rng.uniform(0.2, 0.4), 2))
        level, run, pause, t = round(rng.uniform(0.6, 1), 2), rng.uniform(0.04, 0.1), rng.uniform(0.015, 0.06), 0.2 + rng.uniform(0.01, 0.06)
        while t < 0.97:
            put(t, t + run, level if rng.random() < 0.8 else round(0.6 * level, 2))
            t += run + pause
    return float(top) * np.round(out, 3)


def pace(rng, plan, channels, n_records):
    return seventh.pace(rng, plan, channels, n_records)


def rows(rng, style, dt, n):
    """Times [s]. gaps: the logger was off once to three times; lost: single rows are missing; two_paces: at half the pace from somewhere on; slower: as in `seventh`."""
    if style == "slower":
        return seventh.rows(rng, style, dt, n)
    t = seventh.rows(rng, "even", dt, n)
    k = np.arange(len(t))
    keep = np.ones(len(t), bool)
    if style == "gaps":
        for _ in range(int(rng.integers(1, 4))):
            a = rng.uniform(0.1, 0.9)
            keep &= ~((k > a * len(t)) & (k < (a + rng.uniform(0.02, 0.07)) * len(t)))
    elif style == "lost":
        keep = rng.random(len(t)) > rng.uniform(0.04, 0.2)
    elif style == "two_paces":
        keep = (k < rng.uniform(0.25, 0.75) * len(t)) | (k % 2 == 0)
    keep[:2] = keep[-1] = True
    return t[keep]


def record(rng, name, plan, time_s, styles, column=None):
    """styles: of speed, of power, of feeds; each axis moves separately."""
    n = len(time_s)
    speed, power = np.zeros(n), np.zeros(n)
    if "top" in plan:
        speed = np.round(drive(rng, time_s, styles[0], plan["top"]), 0 if plan["top"] > 300 else 1)
    if "power" in plan:
        load = drive(rng, time_s, styles[1], 1.0)
        if plan["drive"] == "speed+power":
            load = np.where(speed > 0, 0.1 + 0.9 * load, 0.0)
        power = np.array([float(f"{p:.4g}") for p in plan["power"] * load])
    feeds = {axis: np.round(drive(rng, time_s, styles[2], top), 0) / 60000 for axis, top in plan.get("feeds", {}).items()}
    columns = {column[0]: (column[1], seventh.further(rng, time_s, column[1]))} if column else {}
    weather = (sixth if rng.random() < 0.5 else seventh).hall
    return Record(name, time_s, speed, feeds, power, weather(rng, time_s, plan.get("outdoor", False)), columns)


def instruments(rng, machine, plan):
    """As in `seventh`; thermometers are numbered channels of cards, or have the name of their body and a number."""
    noise, seen = seventh.instruments(rng, machine, plan)
    places = [b for _, b in machine.sensors]
    if rng.random() < 0.5:
        machine.sensors = [(f"card{i // 8 + 1}_ch{i % 8 + 1}", b) for i, b in enumerate(places)]
    else:
        machine.sensors = [(f"RTD_{b}_{places[:i].count(b) + 1}", b) for i, b in enumerate(places)]
    return noise, seen


def priors(rng, machine):
    """Of the sets before: what users say, or a group that is known twice as well or as badly, said or not, or guesses."""
    return seventh.priors(rng, machine) if rng.random() < 0.6 else third.priors(rng, machine)
