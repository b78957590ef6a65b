"""Fifteen more families of machines, for the set `seventh` (README.md), of one to nine bodies, driven as workshops and laboratories do that try things; how they are seen, how well their numbers are known, and how loggers write."""
import numpy as np

from families import rounded
from network import Machine, Record
from third import GUESS
from third_families import build

PACES = (1, 2, 3, 5, 10, 20, 30, 60, 120, 300, 600)      # of the logger [s]
STYLES = ["recipe", "walk", "duty_sweep", "trials", "idling", "trips", "chirp", "iso_steps"]


def vertical_lathe(rng, v):
    """A heavy table on a track of oil; two feeds."""
    m = Machine("vertical_lathe")
    build(m, v, dict(table=0.9e6, track=0.1e6, sump=0.22e6, gearbox=0.15e6, base=1.7e6, cross_rail=0.5e6, ram=70e3),
          [("table", "track", 130), ("track", "base", 160), ("track", "sump", 90), ("sump", "base", 30), ("gearbox", "base", 40), ("cross_rail", "base", 28), ("ram", "cross_rail", 24), ("table", "hall", 28), ("base", "hall", 65), ("cross_rail", "hall", 26), ("gearbox", "hall", 18), ("ram", "hall", 4)])
    m.circuit("sump", v(12), v(110), rounded(rng.uniform(20, 30)))
    m.heat("friction_law", "track", v(2300), 150, rounded(rng.uniform(1.1, 1.7)), decay=v(0.011))
    m.heat("motor_loss", "gearbox", v(1500), 150, rounded(rng.uniform(0.9, 1.5)), idle=v(150))
    m.heat("servo_loss", "ram", v(110), 0.15, rounded(rng.uniform(0.8, 1.4)), idle=v(20), axis="z")
    m.heat("servo_loss", "cross_rail", v(140), 0.15, rounded(rng.uniform(0.8, 1.4)), axis="x")
    m.displacement("table_rise", "z", {"table": v(3.2), "track": v(1.1), "base": -v(1.5)})
    m.displacement("tool_x", "x", {"cross_rail": v(4.2), "ram": v(1.3)})
    return m, dict(hours=(4, 22), drive="speed", top=150, feeds={"x": 9000, "z": 9000})


def thread_roller(rng, v):
    """Two dies on two spindles, alike but not the same."""
    m = Machine("thread_roller")
    build(m, v, dict(die_left=3.2e3, die_right=3.1e3, spindle_left=10e3, spindle_right=9.5e3, slide=42e3, base=0.17e6, emulsion=55e3),
          [("die_left", "spindle_left", 9), ("die_right", "spindle_right", 9), ("spindle_left", "base", 17), ("spindle_right", "slide", 16), ("slide", "base", 11), ("die_left", "emulsion", 20), ("die_right", "emulsion", 19), ("emulsion", "base", 9), ("emulsion", "hall", 15), ("base", "hall", 18), ("slide", "hall", 6)])
    m.heat("cutting_heat", "die_left", rounded(rng.uniform(0.08, 0.14), 2))
    m.heat("cutting_heat", "die_right", rounded(rng.uniform(0.08, 0.14), 2))
    m.heat("cutting_heat", "emulsion", rounded(rng.uniform(0.15, 0.3), 2))
    m.heat("heat_source", "spindle_left", v(130), 120, rounded(rng.uniform(0.9, 1.6)))
    m.heat("heat_source", "spindle_right", v(125), 120, rounded(rng.uniform(0.9, 1.6)))
    m.displacement("pitch_gap", "x", {"spindle_left": v(1.4), "slide": v(1.9), "base": -v(1.1)})
    return m, dict(hours=(1.5, 8), drive="speed+power", top=120, power=3500)


def gun_drill(rng, v):
    """Long holes: oil under pressure carries what the drill makes; speed, feed and power are recorded."""
    m = Machine("gun_drill")
    build(m, v, dict(drill=0.7e3, bushing=5e3, headstock=26e3, oil=0.16e6, work=34e3, bed=0.36e6),
          [("drill", "oil", 16), ("drill", "headstock", 1.4), ("bushing", "work", 7), ("bushing", "oil", 10), ("bushing", "bed", 6), ("work", "oil", 30), ("work", "bed", 9), ("headstock", "bed", 19), ("oil", "hall", 14), ("headstock", "hall", 7), ("bed", "hall", 24)])
    m.circuit("oil", v(8), v(70), rounded(rng.uniform(19, 27)))
    m.heat("cutting_heat", "drill", rounded(rng.uniform(0.1, 0.18), 2))
    m.heat("cutting_heat", "work", rounded(rng.uniform(0.15, 0.25), 2))
    m.heat("cutting_heat", "oil", rounded(rng.uniform(0.25, 0.4), 2))
    m.heat("friction_law", "headstock", v(300), 4500, rounded(rng.uniform(1.0, 1.7)), decay=v(0.012))
    m.heat("servo_loss", "bed", v(80), 0.05, rounded(rng.uniform(0.8, 1.2)), axis="z")
    m.displacement("hole_run", "y", {"headstock": v(1.9), "bushing": -v(1.2)})
    m.displacement("depth", "z", {"drill": v(2.3), "headstock": v(1.2), "bed": -v(1.9)})
    return m, dict(hours=(1.5, 8), drive="speed+power", top=4500, power=2500, feeds={"z": 2500})


def ultrasonic_welder(rng, v):
    """A stack in resonance; within a minute it is warm. The generator's power is recorded."""
    m = Machine("ultrasonic_welder")
    build(m, v, dict(converter=0.55e3, booster=0.38e3, sonotrode=0.95e3, anvil=2.4e3), [("converter", "booster", 4), ("booster", "sonotrode", 5), ("sonotrode", "anvil", 0.5), ("converter", "hall", 1.1), ("sonotrode", "hall", 0.6), ("anvil", "hall", 1.8)])
    m.heat("cutting_heat", "converter", rounded(rng.uniform(0.05, 0.09), 2))
    m.heat("cutting_heat", "booster", rounded(rng.uniform(0.01, 0.03), 2))
    m.heat("cutting_heat", "sonotrode", rounded(rng.uniform(0.05, 0.1), 2))
    m.heat("heat_source", "converter", v(4))
    m.displacement("stack", "z", {"converter": v(0.9), "booster": v(1.6), "sonotrode": v(2.7)})
    return m, dict(hours=(0.15, 1.2), drive="power", power=700)


def drying_tunnel(rng, v):
    """Five zones in a row and a belt that goes through all of them; it has thermometers and nothing else."""
    m = Machine("drying_tunnel")
    zones = [f"zone_{i + 1}" for i in range(5)]
    build(m, v, {**{z: 32e3 for z in zones}, "belt": 48e3, "fan_box": 14e3}, [(zones[i], zones[i + 1], 9) for i in range(4)] + [(z, "belt", 11) for z in zones] + [("fan_box", "zone_1", 12), ("fan_box", "zone_5", 10)] + [(z, "hall", 6) for z in zones] + [("belt", "hall", 9), ("fan_box", "hall", 5)])
    for z, share in zip(zones, (0.28, 0.22, 0.17, 0.1, 0.06)):
        m.heat("cutting_heat", z, rounded(share * rng.uniform(0.8, 1.1), 2))
    m.heat("heat_source", "fan_box", v(170))
    return m, dict(hours=(3, 14), drive="power", power=4200)


def calender(rng, v):
    """A stack of five rolls between two rows of bearings, warmed by oil that goes round."""
    m = Machine("calender")
    rolls = [f"roll_{c}" for c in "abcde"]
    build(m, v, {**{r: 0.19e6 for r in rolls}, "bearing_drive": 13e3, "bearing_far": 12e3, "frame": 0.65e6, "thermal_oil": 0.1e6}, [(rolls[i], rolls[i + 1], 34) for i in range(4)])
    for a, b, g in [("roll_b", "thermal_oil", 130), ("roll_d", "thermal_oil", 120), ("bearing_drive", "roll_c", 14), ("bearing_far", "roll_c", 13), ("bearing_drive", "frame", 22), ("bearing_far", "frame", 21), ("frame", "hall", 38), ("thermal_oil", "hall", 16)] + [(r, "hall", 11) for r in rolls]:
        m.link(a, b, v(g))
    m.circuit("thermal_oil", v(25), v(260), rounded(rng.uniform(45, 70)))
    m.heat("cutting_heat", "roll_c", rounded(rng.uniform(0.12, 0.2), 2))
    m.heat("cutting_heat", "roll_e", rounded(rng.uniform(0.05, 0.1), 2))
    m.heat("friction_law", "bearing_drive", v(420), 90, rounded(rng.uniform(0.9, 1.5)), decay=v(0.01))
    m.heat("heat_source", "bearing_far", v(380), 90, rounded(rng.uniform(0.9, 1.5)))
    m.displacement("nip", "z", {"roll_b": v(1.1), "roll_c": v(1.3), "frame": -v(2.8)})
    m.displacement("skew", "x", {"bearing_drive": v(1.7), "bearing_far": -v(1.8)})
    return m, dict(hours=(4, 20), drive="speed+power", top=90, power=9000)


def force_microscope(rng, v):
    """It drifts by what a person in the room is worth; the rate of its scan is recorded as a feed."""
    m = Machine("force_microscope")
    build(m, v, dict(scanner=70, head=420, stage=260, base=5.2e3), [("scanner", "stage", 0.25), ("scanner", "base", 0.35), ("head", "base", 0.8), ("stage", "base", 0.6), ("head", "hall", 0.22), ("base", "hall", 0.7)])
    m.heat("servo_loss", "scanner", v(0.9), 0.02, rounded(rng.uniform(1.2, 2.0)), idle=v(0.05), axis="x")
    m.heat("servo_loss", "stage", v(0.5), 0.02, rounded(rng.uniform(0.9, 1.5)), axis="y")
    m.heat("heat_source", "head", v(1.1))
    m.displacement("tip_z", "z", {"scanner": v(2.6), "head": -v(3.4), "stage": v(1.2)})
    m.displacement("tip_x", "x", {"stage": v(2.2), "base": v(1.4)})
    return m, dict(hours=(0.5, 5), drive="feeds", feeds={"x": 1200, "y": 1200}, seen="displacements")


def tablet_press(rng, v):
    """A turret in a cabin of its own air."""
    m = Machine("tablet_press")
    build(m, v, dict(turret=30e3, punches=6e3, feeder=7e3, rollers=9.5e3, gearbox=22e3, cabin=9e3, frame=0.12e6), [])
    m.air.add("cabin")
    for a, b, g in [("turret", "punches", 16), ("punches", "cabin", 4), ("turret", "cabin", 7), ("feeder", "turret", 3), ("feeder", "cabin", 3), ("rollers", "punches", 2.5), ("rollers", "frame", 10), ("gearbox", "turret", 5), ("gearbox", "frame", 12), ("cabin", "hall", 17), ("frame", "cabin", 8), ("frame", "hall", 13)]:
        m.link(a, b, v(g))
    m.heat("heat_source", "punches", v(190), 80, rounded(rng.uniform(0.9, 1.4)))
    m.heat("friction_law", "rollers", v(160), 80, rounded(rng.uniform(0.9, 1.5)), decay=v(0.011))
    m.heat("motor_loss", "gearbox", v(170), 80, rounded(rng.uniform(0.9, 1.6)), idle=v(30))
    m.heat("heat_source", "feeder", v(40), turning=True)
    m.displacement("thickness", "z", {"turret": v(1.2), "punches": v(1.6), "frame": -v(2.2)})
    return m, dict(hours=(1.5, 9), drive="speed", top=80)


def band_saw(rng, v):
    """A loop: what the band takes at the guide it brings to both wheels."""
    m = Machine("band_saw")
    build(m, v, dict(band=3.6e3, wheel_top=15e3, wheel_low=16e3, guide=2.2e3, column=0.13e6), [("band", "wheel_top", 13), ("band", "wheel_low", 13), ("band", "guide", 4), ("wheel_top", "column", 6), ("wheel_low", "column", 7), ("guide", "column", 3), ("band", "hall", 5), ("wheel_top", "hall", 3), ("column", "hall", 15)])
    m.heat("cutting_heat", "band", rounded(rng.uniform(0.1, 0.18), 2))
    m.heat("heat_source", "guide", v(70), 700, rounded(rng.uniform(0.9, 1.3)))
    m.heat("friction_law", "wheel_low", v(150), 700, rounded(rng.uniform(0.9, 1.5)), decay=v(0.012))
    m.heat("heat_source", "wheel_top", v(55), 700, rounded(rng.uniform(0.9, 1.5)))
    m.displacement("cut_wander", "y", {"guide": v(1.8), "column": v(2.4)})
    m.displacement("tension", "z", {"band": v(3.1), "column": -v(2.7)})
    return m, dict(hours=(1, 6), drive="speed+power", top=700, power=2200)


def crane_hoist(rng, v):
    """In the open, by day."""
    m = Machine("crane_hoist")
    build(m, v, dict(motor=19e3, brake=5e3, gearbox=34e3, drum=62e3, girder=0.5e6), [("motor", "gearbox", 11), ("motor", "brake", 3), ("gearbox", "drum", 9), ("gearbox", "girder", 12), ("drum", "girder", 8), ("motor", "hall", 13), ("brake", "hall", 2.5), ("gearbox", "hall", 7), ("drum", "hall", 9), ("girder", "hall", 55)])
    m.heat("motor_loss", "motor", v(480), 1400, rounded(rng.uniform(1.0, 1.8)), idle=v(70))
    m.heat("heat_source", "gearbox", v(260), 1400, rounded(rng.uniform(1.0, 1.7)))
    m.heat("heat_source", "brake", v(60), turning=True)
    return m, dict(hours=(8, 60), drive="speed", top=1400, outdoor=True, days=True)


def hydro_generator(rng, v):
    """Air goes round in it and through a cooler; the electric power is recorded."""
    m = Machine("hydro_generator")
    build(m, v, dict(winding=0.12e6, core=0.5e6, rotor=0.6e6, thrust_oil=0.1e6, guide_bearing=24e3, cooler=60e3, inner_air=50e3, pit=3e6), [])
    m.air.add("inner_air")
    for a, b, g in [("winding", "core", 420), ("core", "inner_air", 300), ("winding", "inner_air", 160), ("rotor", "inner_air", 210), ("inner_air", "cooler", 900), ("thrust_oil", "rotor", 45), ("thrust_oil", "pit", 60), ("guide_bearing", "rotor", 18), ("guide_bearing", "pit", 25), ("core", "pit", 50), ("inner_air", "hall", 40), ("pit", "hall", 130)]:
        m.link(a, b, v(g))
    m.circuit("cooler", v(60), v(1300), rounded(rng.uniform(9, 18)))
    m.circuit("thrust_oil", v(14), v(220), rounded(rng.uniform(16, 26)))
    m.heat("cutting_heat", "winding", rounded(rng.uniform(0.006, 0.009), 2))
    m.heat("heat_source", "core", v(4200), 300, rounded(rng.uniform(1.5, 2.2)))
    m.heat("heat_source", "rotor", v(3300), 300, rounded(rng.uniform(2.2, 2.9)))
    m.heat("friction_law", "thrust_oil", v(3600), 300, rounded(rng.uniform(1.2, 1.7)), decay=v(0.01))
    m.heat("heat_source", "guide_bearing", v(600), 300, rounded(rng.uniform(1.0, 1.6)))
    m.displacement("air_gap", "x", {"rotor": -v(2.3), "core": v(2.0), "pit": v(0.8)})
    return m, dict(hours=(10, 70), drive="speed+power", top=300, power=1.4e6)


def stir_welder(rng, v):
    """A pin that stirs; speed, travel and the spindle's power are recorded."""
    m = Machine("stir_welder")
    build(m, v, dict(pin=0.3e3, holder=2.6e3, spindle=9e3, head=42e3, plate=6e3, backing=28e3, portal=0.3e6),
          [("pin", "holder", 3), ("pin", "plate", 9), ("holder", "spindle", 5), ("spindle", "head", 22), ("head", "portal", 14), ("plate", "backing", 36), ("backing", "portal", 13), ("holder", "hall", 0.8), ("plate", "hall", 2), ("head", "hall", 6), ("portal", "hall", 28)])
    m.circuit("holder", v(1.5), v(12), rounded(rng.uniform(16, 24)))
    m.heat("cutting_heat", "pin", rounded(rng.uniform(0.12, 0.2), 2))
    m.heat("cutting_heat", "plate", rounded(rng.uniform(0.4, 0.6), 2))
    m.heat("friction_law", "spindle", v(210), 2000, rounded(rng.uniform(1.0, 1.6)), decay=v(0.012))
    m.heat("servo_loss", "portal", v(160), 0.04, rounded(rng.uniform(0.8, 1.3)), axis="x")
    m.displacement("plunge", "z", {"spindle": v(1.5), "head": v(1.8), "backing": -v(0.7)})
    m.displacement("track", "y", {"head": v(1.1), "portal": v(3.1)})
    return m, dict(hours=(0.8, 5), drive="speed+power", top=2000, power=900, feeds={"x": 2000})


def vibration_shaker(rng, v):
    """The amplifier's power is recorded; a blower's speed as well."""
    m = Machine("vibration_shaker")
    build(m, v, dict(drive_coil=1.3e3, armature=3.4e3, field_coil=26e3, magnet=95e3, suspension=1.8e3), [("drive_coil", "armature", 7), ("drive_coil", "magnet", 3), ("armature", "suspension", 1.2), ("suspension", "magnet", 1.6), ("field_coil", "magnet", 17), ("drive_coil", "hall", 5), ("armature", "hall", 2.6), ("field_coil", "hall", 6), ("magnet", "hall", 12)])
    m.heat("cutting_heat", "drive_coil", rounded(rng.uniform(0.14, 0.22), 2))
    m.heat("cutting_heat", "suspension", rounded(rng.uniform(0.008, 0.016), 2))
    m.heat("heat_source", "field_coil", v(330))
    m.displacement("rest_position", "z", {"suspension": v(2.1), "armature": v(1.2), "magnet": -v(1.6)})
    return m, dict(hours=(0.5, 5), drive="power", power=1800)


def stepping_motor(rng, v):
    """One body."""
    m = Machine("stepping_motor")
    build(m, v, dict(motor=0.55e3), [("motor", "hall", 0.6)])
    m.heat("motor_loss", "motor", v(14), 1200, rounded(rng.uniform(0.9, 1.8)), idle=v(6))
    m.heat("heat_source", "motor", v(5))
    m.displacement("shaft_end", "z", {"motor": v(1.4)})
    return m, dict(hours=(0.5, 5), drive="speed", top=1200)


def sewing_machine(rng, v):
    """Small parts that run at 5000 stitches a minute in a hollow arm."""
    m = Machine("sewing_machine")
    build(m, v, dict(needle_bar=0.42e3, hook=0.55e3, arm=14e3, bed=13e3, motor=3.2e3), [("needle_bar", "arm", 1.3), ("hook", "bed", 1.6), ("arm", "bed", 5), ("motor", "arm", 2.2), ("needle_bar", "hall", 0.3), ("arm", "hall", 4), ("bed", "hall", 3.5), ("motor", "hall", 1.8)])
    m.heat("friction_law", "hook", v(22), 5000, rounded(rng.uniform(1.1, 1.8)), decay=v(0.013))
    m.heat("heat_source", "needle_bar", v(17), 5000, rounded(rng.uniform(1.1, 1.8)))
    m.heat("motor_loss", "motor", v(60), 5000, rounded(rng.uniform(0.9, 1.6)), idle=v(9))
    m.displacement("needle_gap", "x", {"needle_bar": v(0.9), "hook": -v(0.8), "arm": v(1.7)})
    m.displacement("needle_height", "z", {"arm": v(2.4), "bed": -v(1.9)})
    return m, dict(hours=(0.5, 4), drive="speed", top=5000)


FAMILIES = [vertical_lathe, thread_roller, gun_drill, ultrasonic_welder, drying_tunnel, calender, force_microscope, tablet_press, band_saw, crane_hoist, hydro_generator, stir_welder, vibration_shaker, stepping_motor, sewing_machine]
TITLES = dict(vertical_lathe="vertical lathe; speed of the table and two feeds are recorded", thread_roller="thread roller with two dies; the rolling power is recorded", gun_drill="deep-hole drill; speed, feed and power are recorded",
              ultrasonic_welder="ultrasonic welder; the generator's power is recorded", drying_tunnel="drying tunnel with a belt; the heaters' power is recorded", calender="calender of five rolls; the drive's power is recorded",
              force_microscope="atomic force microscope; its scan rates are recorded as feeds", tablet_press="tablet press with a cabin", band_saw="band saw; the motor's power is recorded", crane_hoist="hoist of a crane in the open",
              hydro_generator="generator of a hydro power station; its electric power is recorded", stir_welder="friction stir welder; the spindle's power is recorded", vibration_shaker="electrodynamic shaker; the amplifier's power is recorded",
              stepping_motor="stepping motor", sewing_machine="industrial sewing machine")

COLUMNS = dict(column_heat=[("uv_lamp", "W"), ("daylight", "W_m2"), ("grid", "V")], column_opening=[("flap", "percent"), ("air_knife", "1")])
DECOYS = COLUMNS["column_heat"] + COLUMNS["column_opening"] + [("cellar", "degC"), ("lots", "count")]


def drive(rng, time_s, style, top, days=False):
    """A column from 0 to `top`, held from each row on. `recipe` a warming run, then batches at one or two levels with changes of batch between; `walk` a level that somebody moves a little now and then; `duty_sweep` on and off at one level, for an ever
    greater share of each period; `trials` a few long levels, each tried twice with rests; `idling` a low level with rare peaks; `trips` runs that end at once and are taken up again; `chirp` on and off, ever quicker; `iso_steps` levels in turn,
    a stop after every few. `days`: at night there is nothing."""
    share, n = time_s / time_s[-1], len(time_s)
    out = np.zeros(n)
    if style == "recipe":
        warm, levels, t = rng.uniform(0.06, 0.2), np.round(rng.uniform(0.35, 1, 2), 2), 0.0
        out[share < warm] = round(rng.uniform(0.3, 0.6), 2)
        t = warm
        while t < 1:
            t += rng.uniform(0.02, 0.07)
            length = rng.uniform(0.06, 0.14)
            out[(share >= t) & (share < t + length)] = levels[int(rng.integers(2))]
            t += length
    elif style == "walk":
        t, level = 0.0, rng.uniform(0.3, 0.8)
        while t < 1:
            length = rng.uniform(0.03, 0.12)
            out[(share >= t) & (share < t + length)] = round(level, 2)
            level, t = float(np.clip(level + 0.18 * rng.standard_normal(), 0.1, 1)), t + length
        t = rng.uniform(0.2, 0.75)
        out[(share >= t) & (share < t + rng.uniform(0.06, 0.15))] = 0.0
    elif style == "duty_sweep":
        period, level = rng.uniform(0.05, 0.12), round(rng.uniform(0.6, 1), 2)
        k = np.floor(share / period)
        duty = 0.15 + 0.75 * (k * period if rng.random() < 0.6 else 1 - k * period)
        out = np.where(share / period - k < duty, level, 0.0)
    elif style == "trials":
        m = int(rng.integers(2, 4))
        levels, block = np.repeat(np.round(rng.uniform(0.3, 1, m), 2), 2), 1 / (2 * m)
        k = np.minimum((share / block).astype(int), 2 * m - 1)
        out = np.where((share / block) % 1 < rng.uniform(0.5, 0.75), levels[k], 0.0)
    elif style == "idling":
        out[:] = round(rng.uniform(0.1, 0.3), 2)
        out[share < rng.uniform(0.01, 0.06)] = 0.0
        for _ in range(int(rng.integers(3, 8))):
            t = rng.uniform(0, 0.95)
            out[(share >= t) & (share < t + rng.uniform(0.02, 0.1))] = round(rng.uniform(0.6, 1), 2)
    elif style == "trips":
        t = rng.uniform(0, 0.05)
        while t < 1:
            length, level = rng.uniform(0.1, 0.3), round(rng.uniform(0.5, 1), 2)
            out[(share >= t) & (share < t + length)] = level
            t += length + (rng.uniform(0.01, 0.03) if rng.random() < 0.6 else rng.uniform(0.08, 0.2))
    elif style == "chirp":
        t, length, level = rng.uniform(0, 0.03), rng.uniform(0.12, 0.22), round(rng.uniform(0.6, 1), 2)
        while t < 1:
            out[(share >= t) & (share < t + 0.6 * length)] = level
            t, length = t + length, max(0.02, 0.82 * length)
    else:
        t, k = 0.0, 0
        while t < 1:
            length = rng.uniform(0.04, 0.07)
            out[(share >= t) & (share < t + length)] = 0.0 if k % 4 == 3 else round(rng.uniform(0.2, 1), 2)
            t, k = t + length, k + 1
    if days:
        hour = (time_s / 3600 + rng.uniform(0, 24)) % 24
        out = np.where((hour > 6) & (hour < rng.uniform(17, 22)), out, 0.0)
    return float(top) * np.round(out, 3)


def further(rng, time_s, unit):
    if unit == "degC":
        return np.round(rng.uniform(10, 30) + rng.uniform(2, 6) * drive(rng, time_s, "walk", 1.0) + 0.3 * rng.standard_normal(len(time_s)), 1)
    if unit == "W_m2":
        day = max(86400, 1.6 * time_s[-1]) if time_s[-1] < 86400 else 86400
        return np.round(540 * np.clip(1.15 * np.cos(2 * np.pi * (time_s / day - rng.uniform(0, 0.3))), 0, 1) * np.where(drive(rng, time_s, "trips", 1.0) > 0.3, 1.0, rng.uniform(0.2, 0.5)))
    if unit == "1":
        return (drive(rng, time_s, str(rng.choice(["trials", "recipe", "chirp"])), 1.0) > 0).astype(float)
    if unit == "percent":
        return np.round(10 * drive(rng, time_s, str(rng.choice(["walk", "iso_steps"])), 1.0)) * 10
    return np.round(drive(rng, time_s, str(rng.choice(["recipe", "iso_steps", "trials"])), {"V": 230, "W": 280, "count": 12}[unit]), 0)


def hall(rng, time_s, outdoor):
    """Indoors heating that is turned up in the morning, people who come and go, draughts, or a well kept laboratory; outdoors a day with clouds."""
    hours = time_s / 3600
    end, n = hours[-1], len(hours)
    if outdoor:
        x = 2 * np.pi * (hours + rng.uniform(0, 24)) / 24
        y = rng.uniform(2, 24) + rng.uniform(2, 6) * np.sin(x) + rng.uniform(0, 1.5) * np.sin(3 * x) + rng.uniform(-3, 3) * hours / max(end, 24)
    else:
        y, kind = np.full(n, rng.uniform(16, 28)), str(rng.choice(["morning", "people", "draughts", "laboratory"]))
        if kind == "morning":
            y = y - rng.uniform(1, 5) * np.exp(-hours / (rng.uniform(0.1, 0.4) * end))
        elif kind == "people":
            here, x, tau, swing = drive(rng, time_s, "trials", 1.0) > 0, 0.0, rng.uniform(0.05, 0.12) * end, rng.uniform(0.5, 1.8)
            for k in range(1, n):
                x = here[k - 1] + (x - here[k - 1]) * np.exp(-(hours[k] - hours[k - 1]) / tau)
                y[k] += swing * x
        elif kind == "draughts":
            for _ in range(int(rng.integers(2, 7))):
                t, width = rng.uniform(0, end), rng.uniform(0.015, 0.05) * end
                y = y - rng.uniform(0.5, 2.5) * np.exp(-((hours - t) / width) ** 2)
        else:
            y = y + 0.15 * np.sin(2 * np.pi * hours / (rng.uniform(0.08, 0.3) * end))
    walk, x, tau = np.empty(n), 0.0, rng.uniform(0.1, 0.4) * end
    for k in range(n):
        e = np.exp(-(hours[k] - hours[k - 1]) / tau) if k else 0.0
        x = e * x + np.sqrt(1 - e * e) * (0.6 if outdoor else 0.18) * rng.standard_normal()
        walk[k] = x
    return np.round(y + np.convolve(np.pad(walk, 3, mode="edge"), np.ones(7) / 7, mode="valid"), 2)


def pace(rng, plan, channels, n_records):
    """Of the logger [s]; and how many rows a record has, about, fewer where there are many channels."""
    n = float(np.exp(rng.uniform(*np.log((70, 1400)))))
    n = max(90.0, min(n, 24000 / (channels * n_records), 1200 / n_records))
    span = 3600 * np.exp(rng.uniform(*np.log(plan["hours"])))
    return min(PACES, key=lambda d: abs(np.log(d * n / span))), n


def rows(rng, style, dt, n):
    """Times [s]. triggered: it writes at its pace for a while after a trigger, and else every third to sixth time; bursts: the logger sleeps after every so many rows; slower: this record was written at two, three or five times the pace."""
    n = int(np.clip(round(n * np.exp(rng.uniform(np.log(0.6), np.log(1.4)))), 60, 1900))
    if style == "triggered":
        slow, steps = int(rng.integers(3, 7)), []
        while len(steps) < n - 1:
            steps += [1] * int(rng.integers(10, 40)) + [slow] * int(rng.integers(5, 30))
        return np.append(0.0, np.cumsum(steps[:n - 1]) * float(dt))
    if style == "bursts":
        run, sleep = int(rng.integers(4, 13)), int(rng.integers(3, 9))
        return np.append(0.0, np.cumsum(np.where(np.arange(1, n) % run == 0, sleep, 1) * float(dt)))
    if style == "slower":
        k = int(rng.choice([1, 1, 2, 3, 5]))
        return np.arange(max(60, n // k)) * float(dt * k)
    return np.arange(n) * float(dt)


def record(rng, name, plan, time_s, styles, column=None):
    """styles: of speed, of power, of feeds."""
    n, days = len(time_s), plan.get("days", False)
    speed, power = np.zeros(n), np.zeros(n)
    if "top" in plan:
        speed = np.round(drive(rng, time_s, styles[0], plan["top"], days), 0 if plan["top"] > 300 else 1)
    if "power" in plan:
        load = drive(rng, time_s, styles[1], 1.0, days)
        if plan["drive"] == "speed+power":
            load = np.where(speed > 0, 0.08 + 0.92 * load, 0.0)
        power = np.array([float(f"{p:.4g}") for p in plan["power"] * load])
    feeds = {axis: np.round(drive(rng, time_s, styles[2], top), 0) / 60000 for axis, top in plan.get("feeds", {}).items()}
    columns = {column[0]: (column[1], further(rng, time_s, column[1]))} if column else {}
    return Record(name, time_s, speed, feeds, power, hall(rng, time_s, plan.get("outdoor", False)), columns)


def instruments(rng, machine, plan):
    """What looks at it: one displacement and nothing else, displacements, one to three thermometers and at most one displacement, thermometers, both, or up to thirty channels. Two manners of naming thermometers."""
    seen = str(rng.choice(["one_displacement", "displacements", "few", "temperatures", "both", "many"], p=[0.13, 0.1, 0.17, 0.22, 0.23, 0.15]))
    if not machine.displacements and seen in ("one_displacement", "displacements"):
        seen = "temperatures"
    elif plan.get("seen") and rng.random() < 0.6:
        seen = str(rng.choice(["one_displacement", "displacements"]))
    bodies = [str(b) for b in rng.permutation(machine.bodies)]
    n = len(bodies)
    count = dict(one_displacement=0, displacements=0, few=int(rng.integers(1, 4)), temperatures=int(rng.integers(max(1, n // 2), n + 3)), both=int(rng.integers(max(1, n // 2), n + 2)), many=int(rng.integers(14, 28)))[seen]
    places = (bodies + [bodies[int(i)] for i in rng.integers(n, size=40)])[:count]
    if rng.random() < 0.5:
        first = 100 * int(rng.integers(1, 9))
        machine.sensors = [(f"TE{first + i + 1}", b) for i, b in enumerate(places)]
    else:
        machine.sensors = [(f"{b}_{'pqrstuvwxyz'[places[:i].count(b) % 11]}{places[:i].count(b) // 11 or ''}", b) for i, b in enumerate(places)]
    kept = machine.displacements
    if seen == "temperatures":
        kept = []
    elif seen in ("one_displacement", "few") and kept:
        k = int(rng.integers(len(kept)))
        kept = kept[k:k + 1] if seen == "one_displacement" or rng.random() < 0.7 else []
    gone = [d[0] for d in machine.displacements if d not in kept]
    machine.displacements = kept
    machine.numbers = {k: x for k, x in machine.numbers.items() if not (k.startswith("S ") and k.split()[1] in gone)}
    step = float(rng.choice([0.001, 0.01, 0.1, 0.0625, 0.5], p=[0.35, 0.25, 0.2, 0.1, 0.1]))
    temperature = dict(sigma=rounded(np.clip(np.exp(rng.uniform(*np.log((0.012, 0.22)))), 0.4 * step, None), 2), step=step)
    step = float(rng.choice([0.01, 0.1, 0.5, 1.0], p=[0.45, 0.3, 0.15, 0.1]))
    displacement = dict(sigma=rounded(np.clip(np.exp(rng.uniform(*np.log((0.05, 1.3)))), 0.4 * step, None), 2), step=step)
    return dict(temperature=temperature, displacement=displacement, coloured=dict(share=0.0, minutes=0.0)), seen


def priors(rng, machine):
    """As third.priors, by what users say: nothing; joints to 30 % and weighed parts to 5 %; heats and films to 20 %; a few joints or heats as guesses; nothing though a group is twice as uncertain; 20 % of a group that is known twice as well."""
    labels, air, r = list(machine.numbers), {"C " + b for b in machine.air}, rng.random()
    shares = {f"P {i}" for i, h in enumerate(machine.heats) if h["kind"] == "cutting_heat"}
    joints, films = ([k for k in labels if k.startswith("G ") and k.endswith(" hall") == to_hall] for to_hall in (False, True))
    heats, parts = [k for k in labels if k.startswith("P ") and k not in shares], [k for k in labels if k.startswith("C ") and k not in air]
    if r < 0.33:
        return {}, None
    if r < 0.5:
        machine.stated = {k: 3.0 for k in joints} | {k: 0.5 for k in parts}
        return {}, dict(kind="joints said to be known to 30 %, parts to 5 %")
    if r < 0.64:
        machine.stated = {k: 2.0 for k in heats + films}
        return {}, dict(kind="heats and films said to be known to 20 %")
    if r < 0.78:
        able = joints + heats
        chosen = [str(x) for x in rng.choice(able, min(len(able), int(rng.integers(1, 4))), replace=False)]
        machine.stated = {k: GUESS for k in chosen}
        return {}, dict(kind="guess", numbers=chosen)
    name, group = [("films", films), ("joints", joints), ("heats", heats), ("parts", parts)][int(rng.integers(4))]
    if r < 0.91:
        return {k: 2.0 for k in group}, dict(kind="scatter of 20 %, unsaid", group=name)
    machine.stated = {k: 2.0 for k in group}
    return {k: 0.5 for k in group}, dict(kind="said to be known to 20 %, scatter of 10 %", group=name)
