"""Twelve more families of machines, for the set `fourth` (README.md), with cyclograms that repeat, climb or never come twice, and loggers that change their pace."""
import numpy as np

from families import rounded
from network import Machine, Record
from third_families import build

# Rows are so far apart [s], or two, three or five times as far in other records of the case.
CADENCES = (4, 5, 7, 8, 12, 16, 18, 25, 40, 45, 75, 90, 100, 150, 180, 240, 420, 500, 720, 1200)


def vacuum_furnace_shelf(rng, v):
    """Radiation between shields of nearly equal temperature is written as conductances."""
    m = Machine("vacuum_furnace_shelf")
    build(m, v, dict(heater=1.4e3, shelf=9e3, charge=22e3, shield=5e3, vessel=58e3),
          [("heater", "shelf", 3.2), ("heater", "shield", 1.5), ("shelf", "charge", 7), ("charge", "shield", 0.9), ("shield", "vessel", 1.3), ("vessel", "hall", 9)])
    m.circuit("vessel", v(2.5), v(28), rounded(rng.uniform(16, 24)))
    m.heat("cutting_heat", "heater", rounded(rng.uniform(0.75, 0.9), 2))
    m.displacement("shelf_lift", "z", {"shelf": v(1.3), "vessel": -v(0.6)})
    return m, dict(hours=(5, 16), drive="programme", power=520)


def wind_turbine_drive(rng, v):
    m = Machine("wind_turbine_drive")
    build(m, v, dict(main_bearing=0.35e6, gear_case=2.1e6, gear_oil=0.9e6, fast_bearing=40e3, generator=1.6e6, bedplate=4e6, nacelle=60e3), [])
    m.air.add("nacelle")
    for a, b, g in [("main_bearing", "bedplate", 90), ("gear_case", "gear_oil", 900), ("gear_case", "bedplate", 140), ("fast_bearing", "gear_case", 110), ("fast_bearing", "gear_oil", 60), ("generator", "bedplate", 120),
                    ("generator", "nacelle", 260), ("gear_case", "nacelle", 130), ("bedplate", "nacelle", 150), ("gear_oil", "hall", 420), ("main_bearing", "hall", 60), ("nacelle", "hall", 520)]:
        m.link(a, b, v(g))
    m.heat("cutting_heat", "gear_oil", rounded(rng.uniform(0.012, 0.02), 2))
    m.heat("cutting_heat", "generator", rounded(rng.uniform(0.015, 0.028), 2))
    m.heat("heat_source", "main_bearing", v(2200), 1600, rounded(rng.uniform(0.9, 1.5)))
    m.heat("heat_source", "fast_bearing", v(1500), 1600, rounded(rng.uniform(1.1, 1.8)))
    m.displacement("shaft_offset", "y", {"gear_case": v(6), "bedplate": -v(4), "generator": -v(2.5)})
    return m, dict(hours=(60, 150), drive="wind", top=1600, power=900e3, outdoor=True, week=True)


def welding_robot_wrist(rng, v):
    m = Machine("welding_robot_wrist")
    build(m, v, dict(motor=1.1e3, reducer=2.6e3, forearm=14e3, wrist_housing=7e3, flange=1.5e3, torch=0.8e3),
          [("motor", "forearm", 2.2), ("motor", "reducer", 1.1), ("reducer", "wrist_housing", 8), ("wrist_housing", "forearm", 4), ("flange", "reducer", 3), ("flange", "torch", 0.7), ("torch", "hall", 1.1), ("flange", "hall", 0.6),
           ("wrist_housing", "hall", 1.8), ("forearm", "hall", 3.6)])
    m.heat("motor_loss", "motor", v(38), 3500, rounded(rng.uniform(0.8, 1.6)), idle=v(9))
    m.heat("friction_law", "reducer", v(55), 3500, rounded(rng.uniform(0.6, 1.2)), decay=v(0.016))
    m.heat("cutting_heat", "torch", rounded(rng.uniform(0.008, 0.018), 2))
    m.displacement("tool_x", "x", {"flange": v(3.4), "torch": v(1.9)})
    m.displacement("tool_z", "z", {"forearm": v(7.5), "wrist_housing": v(2.6)})
    return m, dict(hours=(1.2, 4), drive="bursts", top=3500, power=4200)


def telescope_mount(rng, v):
    """In the open at night; speed is that of the dome's fan, feeds are those of the two axes."""
    m = Machine("telescope_mount")
    build(m, v, dict(mirror=0.21e6, cell=0.08e6, tube=0.05e6, fork=0.32e6, pier=1.1e6, cabinet=18e3),
          [("mirror", "cell", 6), ("mirror", "hall", 5), ("cell", "tube", 9), ("tube", "hall", 24), ("cell", "fork", 7), ("fork", "pier", 22), ("fork", "hall", 20), ("pier", "hall", 18), ("cabinet", "fork", 2.4), ("cabinet", "hall", 4)])
    m.heat("cutting_heat", "cabinet", rounded(rng.uniform(0.6, 0.9), 2))
    m.heat("servo_loss", "fork", v(60), 0.05, rounded(rng.uniform(0.8, 1.4)), idle=v(14), axis="x")
    m.start = rounded(rng.uniform(11, 17))      # it comes out of the day
    m.displacement("focus", "z", {"tube": v(11.5), "mirror": -v(3.2)})
    m.displacement("sag", "y", {"fork": v(5), "pier": -v(2)})
    return m, dict(hours=(7, 22), drive="power", power=260, feeds={"x": 3000}, outdoor=True)


def wafer_stage(rng, v):
    m = Machine("wafer_stage")
    build(m, v, dict(coils=0.7e3, mover=3.4e3, chuck=2.1e3, mirror_block=1.2e3, base=52e3),
          [("coils", "mover", 1.1), ("mover", "chuck", 1.8), ("chuck", "mirror_block", 1.3), ("mirror_block", "hall", 0.35), ("mover", "base", 0.8), ("base", "hall", 5), ("chuck", "hall", 0.4)])
    m.circuit("coils", v(1.1), v(14), rounded(rng.uniform(20, 22.5)))
    m.heat("servo_loss", "coils", v(180), 0.5, rounded(rng.uniform(1.4, 2)), idle=v(12), axis="x")
    m.heat("servo_loss", "mover", v(16), 0.4, rounded(rng.uniform(1.0, 1.8)), axis="y")
    m.displacement("overlay_x", "x", {"mirror_block": v(0.9), "chuck": v(0.5)})
    m.displacement("overlay_y", "y", {"chuck": v(1.1), "base": -v(0.35)})
    return m, dict(hours=(0.8, 3), drive="feeds", feeds={"x": 30000, "y": 24000})


def printing_cylinder(rng, v):
    m = Machine("printing_cylinder")
    build(m, v, dict(journal_left=5e3, journal_right=5e3, cylinder=120e3, ink_roller=31e3, ink_duct=14e3, side_left=160e3, side_right=150e3),
          [("journal_left", "cylinder", 16), ("journal_right", "cylinder", 15), ("journal_left", "side_left", 34), ("journal_right", "side_right", 30), ("cylinder", "ink_roller", 12), ("ink_roller", "ink_duct", 9),
           ("ink_duct", "side_left", 5), ("cylinder", "hall", 14), ("side_left", "hall", 17), ("side_right", "hall", 16)])
    m.circuit("ink_roller", v(3), v(22), rounded(rng.uniform(24, 29)))
    m.heat("friction_law", "journal_left", v(240), 900, rounded(rng.uniform(1.0, 1.6)), decay=v(0.012))
    m.heat("heat_source", "journal_right", v(200), 900, rounded(rng.uniform(1.0, 1.6)))
    m.heat("heat_source", "ink_roller", v(330), 900, rounded(rng.uniform(1.2, 1.9)))
    m.displacement("register", "x", {"side_left": v(3.3), "cylinder": -v(5.2)})
    m.displacement("nip", "z", {"cylinder": v(2.4), "ink_roller": v(1.4), "side_right": -v(1.8)})
    return m, dict(hours=(5, 13), drive="speed", top=900)


def laboratory_centrifuge(rng, v):
    m = Machine("laboratory_centrifuge")
    build(m, v, dict(rotor=5.2e3, spindle=1.0e3, motor=2.8e3, chamber=4.5e3, housing=16e3),
          [("rotor", "chamber", 2.6), ("rotor", "spindle", 1.4), ("spindle", "motor", 1.9), ("motor", "housing", 4.2), ("chamber", "housing", 1.2), ("housing", "hall", 5.5)])
    m.circuit("chamber", v(0.5), v(9), rounded(rng.uniform(3, 12)))
    m.heat("heat_source", "rotor", v(95), 14000, rounded(rng.uniform(2.2, 2.9)))
    m.heat("motor_loss", "motor", v(85), 14000, rounded(rng.uniform(1.0, 2.0)), idle=v(14))
    m.heat("heat_source", "spindle", v(22), 14000, rounded(rng.uniform(0.9, 1.4)))
    return m, dict(hours=(1.5, 6), drive="speed", top=14000)


def ball_screw_axis(rng, v):
    m = Machine("ball_screw_axis")
    build(m, v, dict(nut=1.9e3, screw=8.5e3, fixed_bearing=1.3e3, far_bearing=1.0e3, motor=4.1e3, carriage=34e3, bed=170e3, rail=21e3),
          [("nut", "screw", 9), ("nut", "carriage", 8), ("fixed_bearing", "screw", 7), ("fixed_bearing", "bed", 16), ("far_bearing", "screw", 6), ("far_bearing", "bed", 13), ("motor", "fixed_bearing", 2.4), ("motor", "bed", 5),
           ("motor", "hall", 2.2), ("screw", "hall", 2.6), ("carriage", "rail", 6), ("rail", "bed", 30), ("carriage", "hall", 6), ("bed", "hall", 15)])
    m.heat("servo_loss", "nut", v(75), 0.4, rounded(rng.uniform(0.9, 1.3)), axis="x")
    m.heat("servo_loss", "fixed_bearing", v(48), 0.4, rounded(rng.uniform(0.9, 1.4)), axis="x")
    m.heat("servo_loss", "motor", v(65), 0.4, rounded(rng.uniform(0.9, 1.5)), idle=v(18), axis="x")
    m.displacement("end_of_travel", "x", {"screw": v(9.5), "bed": -v(6.5)})
    m.displacement("carriage_z", "z", {"carriage": v(2.1), "rail": v(0.9)})
    return m, dict(hours=(2, 7), drive="feeds", feeds={"x": 24000})


def milk_tank(rng, v):
    """An agitator in warm milk; the evaporator is a circuit."""
    m = Machine("milk_tank")
    build(m, v, dict(milk=2.4e6, inner_wall=0.06e6, jacket=0.09e6, shell=0.11e6, gearmotor=9e3),
          [("milk", "inner_wall", 420), ("inner_wall", "jacket", 500), ("jacket", "shell", 7), ("shell", "hall", 38), ("gearmotor", "shell", 2.4), ("gearmotor", "hall", 3), ("milk", "hall", 6)])
    m.circuit("jacket", v(1.6), v(110), rounded(rng.uniform(1, 5)))
    m.heat("motor_loss", "gearmotor", v(110), 40, rounded(rng.uniform(0.8, 1.4)), idle=v(25))
    m.heat("heat_source", "milk", v(160), 40, rounded(rng.uniform(1.6, 2.6)))
    m.start = rounded(rng.uniform(22, 33))
    return m, dict(hours=(8, 36), drive="speed", top=40)


def rolling_mill_stand(rng, v):
    m = Machine("rolling_mill_stand")
    build(m, v, dict(work_roll=0.3e6, back_up_roll=1.5e6, chock=0.24e6, roll_bearing=32e3, stand=3.6e6, pinion_gear=0.5e6),
          [("work_roll", "back_up_roll", 190), ("back_up_roll", "roll_bearing", 130), ("roll_bearing", "chock", 260), ("chock", "stand", 160), ("stand", "hall", 210), ("back_up_roll", "hall", 45), ("pinion_gear", "stand", 70),
           ("pinion_gear", "hall", 95), ("work_roll", "hall", 30)])
    m.circuit("work_roll", v(24), v(480), rounded(rng.uniform(24, 32)))
    m.heat("cutting_heat", "work_roll", rounded(rng.uniform(0.05, 0.11), 2))
    m.heat("friction_law", "roll_bearing", v(4200), 300, rounded(rng.uniform(0.9, 1.5)), decay=v(0.011))
    m.heat("heat_source", "pinion_gear", v(2900), 300, rounded(rng.uniform(1.0, 1.7)))
    m.displacement("gap", "z", {"work_roll": v(4.2), "back_up_roll": v(3.1), "stand": -v(5.5)})
    return m, dict(hours=(10, 30), drive="speed+power", top=300, power=190e3)


def weighing_cell(rng, v):
    """Three bodies; the electronics' power is recorded."""
    m = Machine("weighing_cell")
    build(m, v, dict(coil=55, lever=240, housing=1900), [("coil", "lever", 0.12), ("lever", "housing", 0.22), ("housing", "hall", 0.9), ("coil", "housing", 0.05)])
    m.heat("cutting_heat", "coil", rounded(rng.uniform(0.3, 0.5), 2))
    m.heat("heat_source", "housing", v(1.6))
    m.displacement("zero", "z", {"lever": v(1.2), "housing": -v(0.7)})
    return m, dict(hours=(1.5, 8), drive="power", power=5)


def dividing_saw(rng, v):
    """A dicing saw: an air spindle in cold water, a chuck that carries the wafer, speed and the axis' feed both recorded."""
    m = Machine("dividing_saw")
    build(m, v, dict(rotor=0.9e3, spindle_case=4.2e3, bracket=13e3, chuck=3.6e3, x_table=17e3, frame=85e3),
          [("rotor", "spindle_case", 3.0), ("spindle_case", "bracket", 6), ("bracket", "frame", 8), ("chuck", "x_table", 5), ("x_table", "frame", 7), ("bracket", "hall", 2), ("x_table", "hall", 2.6), ("frame", "hall", 9), ("chuck", "hall", 1.3)])
    m.circuit("spindle_case", v(1.4), v(17), rounded(rng.uniform(18, 23)))
    m.heat("motor_loss", "rotor", v(90), 45000, rounded(rng.uniform(1.5, 2.6)), idle=v(10))
    m.heat("heat_source", "spindle_case", v(60), 45000, rounded(rng.uniform(1.0, 1.8)))
    m.heat("servo_loss", "x_table", v(28), 0.33, rounded(rng.uniform(0.9, 1.4)), idle=v(4), axis="x")
    m.displacement("cut_depth", "z", {"rotor": v(1.0), "bracket": v(2.4), "chuck": v(0.9)})
    m.displacement("index_y", "y", {"bracket": v(2.1), "frame": -v(1.2)})
    return m, dict(hours=(1, 4.5), drive="speed", top=45000, feeds={"x": 20000})


FAMILIES = [vacuum_furnace_shelf, wind_turbine_drive, welding_robot_wrist, telescope_mount, wafer_stage, printing_cylinder, laboratory_centrifuge, ball_screw_axis, milk_tank, rolling_mill_stand, weighing_cell, dividing_saw]
TITLES = dict(vacuum_furnace_shelf="shelf of a vacuum furnace with its charge; the heater's power is recorded", wind_turbine_drive="drive train of a wind turbine; speed of the fast shaft and electric power are recorded",
              welding_robot_wrist="wrist of a welding robot; the motor's speed and the arc's power are recorded", telescope_mount="telescope on its mount at night; the cabinet's power is recorded",
              wafer_stage="stage for wafers with cooled coils", printing_cylinder="cylinder of a printing press with its ink roller", laboratory_centrifuge="laboratory centrifuge with a refrigerated chamber",
              ball_screw_axis="axis with a ball screw", milk_tank="cooling tank for milk with an agitator", rolling_mill_stand="stand of a rolling mill; rolling power is recorded",
              weighing_cell="weighing cell; its coil's power is recorded", dividing_saw="dicing saw with a water-cooled air spindle")

COLUMNS = dict(column_heat=[("skylight", "W_m2"), ("preheater", "W"), ("fan", "V"), ("parts", "count")], column_warmth=[("brine", "degC"), ("flue", "degC")], column_opening=[("damper", "percent"), ("hatch", "1")],
               column_path=[("brine", "degC"), ("flue", "degC")])
DECOYS = [x for k in ("column_heat", "column_warmth", "column_opening") for x in COLUMNS[k]]
STYLES = ["cycle", "stair", "fresh", "single", "shifts", "slope"]


def drive(rng, time_s, style, top):
    """A column from 0 to `top`, held from each row on: `cycle` comes again and again, `stair` climbs and falls, `fresh` has no value twice, `single` is on or off, `shifts` has long rests, `slope` nears its levels in many steps."""
    total, out = time_s[-1], np.zeros(len(time_s))
    if style == "cycle":
        n = int(rng.integers(2, 6))
        lengths, levels = rng.uniform(0.3, 1, n), rng.uniform(0.25, 1, n)
        levels[int(rng.integers(n))] = 0.0
        levels[int(rng.integers(n))] = 1.0
        ends = np.cumsum(lengths) / np.sum(lengths)
        phase = (time_s / (total / rng.uniform(3.2, 14))) % 1
        out = levels[np.minimum(np.searchsorted(ends, phase, side="right"), n - 1)]
    elif style == "stair":
        n = int(rng.integers(3, 8))
        climb = list(np.linspace(1 / n, 1, n))
        levels = climb + (climb[::-1] if rng.random() < 0.5 else []) + [0.0]
        if rng.random() < 0.3:
            levels = [0.0] + levels[::-1]
        levels = np.array(levels)
        out = levels[np.minimum((time_s / total * len(levels)).astype(int), len(levels) - 1)]
    elif style == "single":
        t, on = rng.uniform(0, 0.06) * total, True
        level = rng.uniform(0.55, 1)
        while t < total:
            length = rng.uniform(0.06, 0.4 if on else 0.25) * total
            out[(time_s >= t) & (time_s < t + length)] = level if on else 0.0
            t, on = t + length, not on
    elif style == "shifts":
        t = 0.0
        while t < total:
            work = rng.uniform(0.2, 0.4) * total
            inside = t
            while inside < t + work:
                piece = rng.uniform(0.01, 0.06) * total
                out[(time_s >= inside) & (time_s < min(inside + piece, t + work))] = rng.choice([0.0, 0.4, 0.7, 0.85, 1.0])
                inside += piece
            t += work + rng.uniform(0.12, 0.25) * total
    else:
        t, last = 0.0, 0.0
        while t < total:
            length = np.exp(rng.uniform(np.log(0.015), np.log(0.16))) * total
            level = 0.0 if rng.random() < 0.2 else rng.uniform(0.12, 1)
            m = (time_s >= t) & (time_s < t + length)
            out[m] = level if style == "fresh" else np.round(20 * (last + (level - last) * np.minimum(1, (time_s[m] - t) / (0.35 * length)))) / 20
            t, last = t + length, level
    return float(f"{top:.3g}") * np.round(out, 3)


def further(rng, time_s, unit):
    total = time_s[-1]
    if unit == "degC":      # a thermostat's saw teeth about a set point that somebody moves
        mean, swing, period = rng.uniform(8, 55), rng.uniform(0.5, 3), rng.uniform(0.03, 0.2) * total
        return np.round(mean + 14 * (drive(rng, time_s, "single", 1.0) - 0.5) + swing * (2 * np.abs((time_s / period + rng.random()) % 1 - 0.5) - 0.5), 1)
    if unit == "W_m2":
        x = np.sin(np.pi * np.clip((time_s / total - rng.uniform(-0.3, 0.3)) / rng.uniform(0.5, 1.1), 0, 1)) if total < 86400 else np.maximum(0, np.sin(2 * np.pi * (time_s / 86400 - rng.random())))
        return np.round(820 * x * np.where(drive(rng, time_s, "fresh", 1.0) > 0.45, 1.0, rng.uniform(0.2, 0.5)), 0)
    if unit == "1":
        return (drive(rng, time_s, str(rng.choice(["single", "cycle"])), 1.0) > 0).astype(float)
    top = {"percent": 100, "V": 10, "W": 450, "count": 60}[unit]
    return np.round(drive(rng, time_s, str(rng.choice(["cycle", "stair", "single"])), top), 1 if unit == "V" else 0)


def hall(rng, time_s, outdoor):
    """A day's wave, or an hour's door, or heating that is turned down at night; a slow walk beside it."""
    hours = time_s / 3600
    kind = str(rng.choice(["wave", "doors", "heating"]))
    y = rng.uniform(3, 17) + rng.uniform(2, 7) * np.cos(2 * np.pi * (hours - rng.uniform(0, 24)) / 24) if outdoor else np.full(len(hours), rng.uniform(17, 27))
    if kind == "wave" and not outdoor:
        y = y + rng.uniform(0.4, 2.2) * np.cos(2 * np.pi * (hours - rng.uniform(0, 24)) / 24)
    elif kind == "doors":
        for _ in range(int(rng.integers(1, 5))):
            t, back = rng.uniform(0, hours[-1]), rng.uniform(0.02, 0.12) * hours[-1]
            y = y - rng.uniform(0.5, 2.5) * np.where(hours > t, np.exp(-np.maximum(0, hours - t) / back), 0.0)
    elif kind == "heating":
        t, swing = rng.uniform(0.05, 0.6) * hours[-1], rng.uniform(1, 3.5) * (1 if rng.random() < 0.7 else -1)
        y = y + swing * np.where(hours > t, 1 - np.exp(-np.maximum(0, hours - t) / (0.15 * hours[-1])), 0.0)
    walk, x, tau = np.empty(len(hours)), 0.0, rng.uniform(0.04, 0.3) * hours[-1]
    for k in range(len(hours)):
        e = np.exp(-(hours[k] - hours[k - 1]) / tau) if k else 0.0
        x = e * x + np.sqrt(1 - e * e) * (0.8 if outdoor else 0.25) * rng.standard_normal()
        walk[k] = x
    return np.round(y + np.convolve(np.pad(walk, 4, mode="edge"), np.ones(9) / 9, mode="valid"), 2)


def pace(rng, plan):
    """The quickest logger's [s], which divides those of all records of a case."""
    n, span = np.exp(rng.uniform(np.log(240), np.log(700))), 3600 * np.exp(np.mean(np.log(plan["hours"])))
    return min(CADENCES, key=lambda d: abs(np.log(d * n / span)))


def rows(rng, plan, style, base, one_pace=True):
    """Times of a record [s] and its pace. `style`: even; two_paces (quick at first, slow later, or the other way); off (the logger was off for a while); dropped (single rows are missing)."""
    able = [k for k in (1, 2, 3, 5) if 260 * base * k <= 1.2 * 3600 * plan["hours"][1]]
    dt = base if one_pace or not able else base * able[int(rng.integers(len(able)))]
    n = int(np.clip(round(3600 * np.exp(rng.uniform(*np.log(plan["hours"]))) / dt), 260, 900))
    t = np.arange(n) * float(dt)
    if style == "two_paces":
        k = int(rng.uniform(0.3, 0.7) * n)
        steps = np.where((np.arange(n - 1) < k) == (rng.random() < 0.7), dt, dt * int(rng.integers(2, 5)))
        t = np.append(0.0, np.cumsum(steps.astype(float)))
    elif style == "off":
        a, b = rng.uniform(0.2, 0.6), rng.uniform(0.08, 0.2)
        t = t[(t < a * t[-1]) | (t > (a + b) * t[-1]) | (np.arange(n) < 2)]
    elif style == "dropped":
        t = t[(rng.random(n) > 0.12) | (np.arange(n) < 2) | (np.arange(n) == n - 1)]
    return t, dt


def record(rng, name, plan, time_s, styles, column=None):
    """styles: of speed, of power, of feeds."""
    n = len(time_s)
    speed, power = np.zeros(n), np.zeros(n)
    kind = plan["drive"]
    if "top" in plan:
        speed = np.round(drive(rng, time_s, styles[0], plan["top"]), 0)
    if kind == "wind":      # speed and power follow one wind; below its smallest value the rotor is at rest
        wind = np.clip(0.55 + np.cumsum(rng.standard_normal(n) * 0.35 * np.sqrt(np.diff(time_s, append=time_s[-1]) / 86400)), 0, None)
        wind = np.abs((wind + 1) % 2 - 1)
        speed = np.where(wind > 0.22, np.round(plan["top"] * np.clip(0.55 + 0.6 * wind, 0, 1) / 40) * 40, 0.0)
        power = np.where(speed > 0, np.round(plan["power"] * np.clip(1.15 * wind, 0, 1) ** 2 / 5000) * 5000, 0.0)
    elif kind == "programme":      # ramp and soak: full power, then less and less, with a thermostat's strokes in between
        soak = rng.uniform(0.12, 0.3)
        level = drive(rng, time_s, styles[1], 1.0)
        power = plan["power"] * np.where(time_s < rng.uniform(0.05, 0.2) * time_s[-1], 1.0, np.where(level > 0.4, soak + 0.3 * level, 0.0))
    elif kind == "bursts":      # the same seam again and again, while the wrist moves
        period, on = max(5 * (time_s[1] - time_s[0]), rng.uniform(0.015, 0.05) * time_s[-1]), rng.uniform(0.35, 0.7)
        power = np.where(((time_s / period) % 1 < on) & (speed > 0), plan["power"], 0.0)
    elif kind == "speed+power":
        power = np.where(speed > 0, drive(rng, time_s, styles[1], plan["power"]), 0.0)
    elif kind == "power":
        power = drive(rng, time_s, styles[1], plan["power"])
    power = np.array([float(f"{p:.4g}") for p in power])
    feeds = {axis: np.round(drive(rng, time_s, styles[2], top), 0) / 60000 for axis, top in plan.get("feeds", {}).items()}
    columns = {column[0]: (column[1], further(rng, time_s, column[1]))} if column else {}
    return Record(name, time_s, speed, feeds, power, hall(rng, time_s, plan.get("outdoor", False)), columns)


def instruments(rng, machine, seen):
    """`seen`: both, temperatures or displacements. Thermometers are numbered or named after what they sit on; where they sit is in the scenario."""
    bodies = [str(b) for b in machine.bodies]
    if not machine.displacements:
        seen = "temperatures"
    most = int(rng.choice([len(bodies), 2 * len(bodies)], p=[0.7, 0.3]))
    count = 0 if seen == "displacements" else int(rng.integers(min(2, len(bodies)), most + 1))
    places = [bodies[i] for i in rng.permutation(len(bodies))] + [bodies[int(i)] for i in rng.integers(len(bodies), size=len(bodies))]
    places = places[:count]
    if rng.random() < 0.5:
        machine.sensors = [(f"tc{i + 1:02d}", b) for i, b in enumerate(places)]
    else:
        machine.sensors = [(f"{b}_pt{1 + places[:i].count(b)}", b) for i, b in enumerate(places)]
    drop = [d[0] for d in machine.displacements] if seen == "temperatures" else []
    if seen == "both" and len(machine.displacements) > 1 and rng.random() < 0.4:
        drop = [machine.displacements[int(rng.integers(len(machine.displacements)))][0]]
    machine.displacements = [d for d in machine.displacements if d[0] not in drop]
    machine.numbers = {k: x for k, x in machine.numbers.items() if not (k.startswith("S ") and k.split()[1] in drop)}
    if rng.random() < 0.6:
        temperature = dict(sigma=rounded(np.exp(rng.uniform(np.log(0.015), np.log(0.2))), 2), step=0.001)
    else:      # resolution of the converter
        step = float(rng.choice([0.03125, 0.0625, 0.1, 0.2]))
        temperature = dict(sigma=rounded(max(0.02, step * rng.uniform(0.4, 0.9)), 2), step=step)
    displacement = dict(sigma=rounded(np.exp(rng.uniform(np.log(0.08), np.log(1.2))), 2), step=float(rng.choice([0.01, 0.05, 0.25], p=[0.6, 0.2, 0.2])))
    return dict(temperature=temperature, displacement=displacement, coloured=dict(share=0.0, minutes=0.0)), seen
