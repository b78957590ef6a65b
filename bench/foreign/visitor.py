#!/usr/bin/env python3
"""Blind test cases "visitor": seventeen lumped machines, simulated by a Runge-Kutta of its own.

  visitor.py [FOLDER]          writes the cases (default: the folder `visitor` beside this file)
  visitor.py --check [DW]      compares machines without fault, scatter and noise with `DW simulate` (default driftwright)
"""
import csv, json, math, os, shutil, subprocess, sys, tempfile, zlib
for _k in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[_k] = "1"                                       # same bytes: no sum depends on threads
import numpy as np
from scipy.linalg import cho_factor, cho_solve

SEED = 740219
COUNTS = {"A": 52, "B": 22, "D": 20}
AMB = "ambient"

# ---------------------------------------------------------------------------------------------------------------- families
# links: (a, b, W/K[, "turns"]);  heats: (type, node, numbers);  sens: nodes with a thermometer;  disp: name -> {node: um/K}
# drive: speeds of the spindle, feeds {axis: top mm/min}, cut: top W, cols: column -> (way of driving, low, high)
FAMILIES = {
 "turning_centre": dict(
  nodes=dict(spindle=9e3, front_bearing=3.5e3, headstock=45e3, motor=14e3, bed=160e3),
  links=[("front_bearing", "spindle", 18), ("front_bearing", "headstock", 30), ("spindle", "headstock", 6), ("motor", "headstock", 20),
         ("headstock", "bed", 35), ("bed", AMB, 14), ("headstock", AMB, 7), ("motor", AMB, 6, "turns")],
  heats=[("friction_law", "front_bearing", dict(power=180, at_speed=4000, exponent=1.3, decay=0.012, at_temperature=25)),
         ("motor_loss", "motor", dict(power=420, at_speed=4000, exponent=1.4, idle=40)),
         ("cutting_heat", "spindle", dict(share=0.03)),
         ("servo_loss", "bed", dict(power=60, at_feed=10, exponent=1, idle=8, axis="x"))],
  sens=["headstock", "front_bearing", "bed", "motor"], disp=dict(nose_z=dict(spindle=2.6, headstock=1.4, bed=-0.6), nose_x=dict(headstock=3.2, bed=-2.2)),
  speeds=[1000, 1800, 2500, 3200, 4000], feeds=dict(x=9000), cut=4000, dt=60, rows=(240, 480), amb=(21, 1.2)),
 "ball_screw_axis": dict(
  nodes=dict(screw=11e3, nut=3.2e3, bearing=3e3, motor=6e3, saddle=60e3, bed=120e3),
  links=[("nut", "screw", 22), ("nut", "saddle", 20), ("bearing", "screw", 14), ("bearing", "bed", 24), ("motor", "bearing", 5),
         ("motor", AMB, 5), ("screw", AMB, 3), ("saddle", "bed", 30), ("saddle", AMB, 8), ("bed", AMB, 14)],
  heats=[("servo_loss", "motor", dict(power=120, at_feed=20, exponent=1.2, idle=15, axis="x")),
         ("servo_loss", "nut", dict(power=150, at_feed=20, exponent=1, axis="x")),
         ("servo_loss", "bearing", dict(power=60, at_feed=20, exponent=1, axis="x"))],
  sens=["nut", "motor", "bed"], disp=dict(pos_x=dict(screw=7.5, bed=-5.0)),
  speeds=[], feeds=dict(x=24000), dt=30, rows=(300, 700), amb=(20, 0.8)),
 "surface_grinder": dict(
  nodes=dict(wheel_spindle=8e3, wheelhead=50e3, column=200e3, table=90e3, hydraulics=70e3),
  links=[("wheel_spindle", "wheelhead", 40), ("wheelhead", "column", 45), ("column", "table", 12), ("hydraulics", "table", 20),
         ("hydraulics", AMB, 16), ("table", AMB, 12), ("column", AMB, 20), ("wheelhead", AMB, 6)],
  heats=[("friction_law", "wheel_spindle", dict(power=260, at_speed=1500, exponent=1.5, decay=0.02, at_temperature=25)),
         ("heat_source", "hydraulics", dict(power=480, runs="while_spindle_turns")),
         ("servo_loss", "table", dict(power=90, at_feed=15, exponent=1, axis="x")),
         ("cutting_heat", "table", dict(share=0.06))],
  coolant=[("wheelhead", dict(flow=4, ua=45, set_point=22, runs="while_spindle_turns"))],
  sens=["wheelhead", "hydraulics", "column"], disp=dict(wheel_y=dict(column=3.0, wheelhead=-1.5, table=-1.0)),
  speeds=[1200, 1500, 1800], feeds=dict(x=15000), cut=3000, dt=120, rows=(220, 420), amb=(22, 1.5)),
 "optical_bench": dict(
  nodes=dict(laser_head=4.5e3, crystal_oven=1.5e3, mirror_mount=1.2e3, cover_air=2e3, breadboard=40e3, base=90e3),
  links=[("laser_head", "breadboard", 5), ("crystal_oven", "breadboard", 0.4), ("mirror_mount", "breadboard", 1.5), ("cover_air", "laser_head", 2.5),
         ("cover_air", "crystal_oven", 0.3), ("cover_air", "mirror_mount", 0.5), ("cover_air", "breadboard", 5), ("cover_air", AMB, 6),
         ("breadboard", "base", 6), ("base", AMB, 14)],
  heats=[("recorded_drive", "laser_head", dict(column="laser_W", gain=0.85)), ("recorded_drive", "crystal_oven", dict(column="oven_W", gain=1.0)),
         ("heat_source", "cover_air", dict(power=6))],
  sens=["laser_head", "crystal_oven", "cover_air", "breadboard", "base"],
  disp=dict(beam_x=dict(breadboard=1.8, mirror_mount=-1.1), beam_y=dict(base=-1.4, breadboard=2.1, laser_head=0.4)),
  speeds=[], cols=dict(laser_W=("blocks", 0, 90), oven_W=("duty", 0, 18)), dt=30, rows=(300, 800), amb=(21.5, 0.5), start="steady",
  tnoise=(0.01, 0.03), tres=(0.001, 0.01), dnoise=(0.1, 0.3)),
 "wind_gearbox": dict(
  nodes=dict(planet_stage=300e3, fast_bearing=45e3, oil=120e3, housing=500e3, generator=600e3, nacelle=60e3),
  links=[("planet_stage", "oil", 260), ("fast_bearing", "oil", 120), ("oil", "housing", 150), ("oil", AMB, 330, "turns"), ("planet_stage", "housing", 90),
         ("fast_bearing", "housing", 70), ("housing", "nacelle", 90), ("generator", "nacelle", 160), ("generator", AMB, 260, "turns"), ("nacelle", AMB, 240)],
  heats=[("recorded_drive", "planet_stage", dict(column="grid_W", gain=0.006)), ("recorded_drive", "generator", dict(column="grid_W", gain=0.011)),
         ("friction_law", "fast_bearing", dict(power=2600, at_speed=1500, exponent=1.6, decay=0.008, at_temperature=40)),
         ("heat_source", "oil", dict(power=1800, runs="while_spindle_turns")), ("heat_source", "nacelle", dict(power=900))],
  sens=["planet_stage", "fast_bearing", "oil", "housing", "generator", "nacelle"], disp={},
  speeds=[900, 1100, 1300, 1500, 1600], cols=dict(grid_W=("wind", 0, 1.8e6)), dt=300, rows=(240, 520), amb=(9, 4.0), tnoise=(0.1, 0.2), tres=(0.1,)),
 "bakery_oven": dict(
  nodes=dict(chamber=25e3, hearth=260e3, wall=180e3, door=30e3),
  links=[("chamber", "hearth", 45), ("chamber", "hearth", 50, "turns"), ("chamber", "wall", 60), ("chamber", "door", 14), ("wall", AMB, 11),
         ("door", AMB, 9), ("hearth", "wall", 18)],
  heats=[("recorded_drive", "chamber", dict(column="burner_W", gain=0.72)), ("recorded_drive", "hearth", dict(column="hearth_W", gain=0.95)),
         ("recorded_drive", "chamber", dict(column="vent_percent", opening=0.22))],
  sens=["chamber", "hearth", "wall", "door"], disp={},
  speeds=[1400], cols=dict(burner_W=("duty", 0, 14000), hearth_W=("duty", 0, 4000), vent_percent=("blocks", 0, 100)), dt=60, rows=(260, 600),
  amb=(27, 1.5), tnoise=(0.3, 0.6), tres=(0.1, 0.5)),
 "server_rack": dict(
  nodes=dict(cpu=4e3, memory=2.5e3, psu=8e3, board=6e3, chassis=30e3, rack_air=6e3),
  links=[("cpu", "rack_air", 14), ("cpu", "board", 3), ("memory", "rack_air", 7), ("memory", "board", 2), ("psu", "rack_air", 9), ("board", "chassis", 4),
         ("board", "rack_air", 5), ("chassis", AMB, 6), ("chassis", "rack_air", 8), ("rack_air", AMB, 8), ("rack_air", AMB, 38, "turns")],
  heats=[("recorded_drive", "cpu", dict(column="it_W", gain=0.55)), ("recorded_drive", "memory", dict(column="it_W", gain=0.15)),
         ("recorded_drive", "psu", dict(column="it_W", gain=0.09)), ("heat_source", "board", dict(power=35)),
         ("heat_source", "rack_air", dict(power=30, at_speed=6000, exponent=2.5))],
  sens=["cpu", "memory", "psu", "board", "rack_air"], disp={},
  speeds=[3000, 4500, 6000, 7500], nostop=True, cols=dict(it_W=("blocks", 120, 900)), dt=60, rows=(300, 900), amb=(23, 1.0), tnoise=(0.1, 0.25), tres=(0.1, 0.25)),
 "wire_edm": dict(
  nodes=dict(dielectric=400e3, worktable=110e3, upper_head=20e3, lower_arm=35e3, column=180e3),
  links=[("dielectric", "worktable", 90), ("dielectric", "lower_arm", 45), ("dielectric", AMB, 22), ("upper_head", "column", 14), ("upper_head", AMB, 4),
         ("lower_arm", "column", 16), ("worktable", "column", 25), ("column", AMB, 22)],
  heats=[("recorded_drive", "dielectric", dict(column="spark_W", gain=0.7)), ("heat_source", "dielectric", dict(power=350)),
         ("recorded_drive", "upper_head", dict(column="spark_W", gain=0.03)), ("servo_loss", "column", dict(power=45, at_feed=1, exponent=1, idle=20, axis="y"))],
  coolant=[("dielectric", dict(flow=14, ua=260, set_point=20.5, runs="always"))],
  sens=["dielectric", "worktable", "upper_head", "column"],
  disp=dict(wire_u=dict(upper_head=2.4, column=2.8, worktable=-2.0), wire_v=dict(upper_head=1.1, lower_arm=-3.0), table_y=dict(worktable=4.0, column=-2.5)),
  speeds=[], feeds=dict(y=800), cols=dict(spark_W=("blocks", 0, 2600)), dt=120, rows=(240, 500), amb=(21, 1.3), start="steady", tnoise=(0.02, 0.06), tres=(0.01, 0.1)),
 "hydraulic_press": dict(
  nodes=dict(pump=15e3, oil=200e3, cylinder=80e3, frame=350e3),
  links=[("pump", "oil", 70), ("pump", AMB, 8), ("oil", "cylinder", 110), ("oil", AMB, 60, "turns"), ("oil", AMB, 18), ("cylinder", "frame", 60), ("frame", AMB, 35), ("cylinder", AMB, 9)],
  heats=[("motor_loss", "pump", dict(power=700, at_speed=1450, exponent=1.2, idle=250)), ("recorded_drive", "oil", dict(column="press_W", gain=0.38)),
         ("recorded_drive", "cylinder", dict(column="press_W", gain=0.06))],
  sens=["oil", "cylinder", "frame"], disp=dict(ram_z=dict(frame=5.0, cylinder=-2.2)),
  speeds=[980, 1450], cols=dict(press_W=("blocks", 0, 9000)), dt=120, rows=(220, 460), amb=(24, 2.0), tnoise=(0.08, 0.15), tres=(0.1,)),
 "chilled_motor_spindle": dict(
  nodes=dict(shaft=6e3, bearings=2.4e3, stator=7e3, housing=22e3),
  links=[("bearings", "shaft", 12), ("bearings", "housing", 25), ("stator", "shaft", 1.5), ("stator", "housing", 55), ("housing", AMB, 4), ("shaft", AMB, 0.8)],
  heats=[("friction_law", "bearings", dict(power=420, at_speed=18000, exponent=1.6, decay=0.015, at_temperature=30)),
         ("motor_loss", "stator", dict(power=700, at_speed=18000, exponent=1.5, idle=70)), ("motor_loss", "shaft", dict(power=150, at_speed=18000, exponent=1.5)),
         ("cutting_heat", "shaft", dict(share=0.015))],
  coolant=[("housing", dict(flow=6, ua=120, set_point=24, runs="always"))],
  sens=["housing", "stator"], disp=dict(nose_z=dict(shaft=2.9, housing=-1.2)),
  speeds=[4000, 8000, 12000, 15000, 18000], cut=6000, dt=30, rows=(260, 700), amb=(23, 0.9)),
 "coordinate_measuring_machine": dict(
  nodes=dict(granite=400e3, bridge=25e3, ram=6e3, scale_x=3e3, controller=12e3),
  links=[("granite", AMB, 22), ("bridge", AMB, 9), ("bridge", "granite", 6), ("ram", "bridge", 4), ("ram", AMB, 3), ("scale_x", "granite", 5),
         ("scale_x", AMB, 1.2), ("controller", AMB, 4), ("controller", "granite", 2)],
  heats=[("servo_loss", "bridge", dict(power=22, at_feed=12, exponent=1, idle=4, axis="x")), ("servo_loss", "ram", dict(power=14, at_feed=12, exponent=1, idle=3, axis="z")),
         ("heat_source", "controller", dict(power=45))],
  sens=["granite", "bridge", "ram", "scale_x"],
  disp=dict(probe_x=dict(scale_x=-5.2, granite=3.1), probe_y=dict(bridge=4.4, granite=-3.0), probe_z=dict(ram=5.0, bridge=2.5, granite=-2.0)),
  speeds=[], feeds=dict(x=15000, z=9000), dt=300, rows=(220, 420), amb=(20.3, 2.2), start="steady", tnoise=(0.01, 0.04), tres=(0.01,), dnoise=(0.2, 0.4)),
 "moulding_machine": dict(
  nodes=dict(throat=12e3, barrel_rear=30e3, barrel_front=28e3, nozzle=6e3, mould=90e3, platen=200e3, oil=150e3),
  links=[("throat", "barrel_rear", 7), ("throat", AMB, 16), ("barrel_rear", "barrel_front", 14), ("barrel_rear", AMB, 6), ("barrel_front", "nozzle", 7),
         ("barrel_front", AMB, 5.5), ("nozzle", "mould", 2.5), ("nozzle", AMB, 1.2), ("mould", "platen", 40), ("mould", AMB, 7), ("platen", AMB, 18),
         ("oil", "platen", 22), ("oil", AMB, 30)],
  heats=[("recorded_drive", "barrel_rear", dict(column="zone_a_W", gain=0.9)), ("recorded_drive", "barrel_front", dict(column="zone_b_W", gain=0.9)),
         ("recorded_drive", "mould", dict(column="shot_W", gain=0.8)), ("heat_source", "oil", dict(power=1300, at_speed=1500, exponent=1.1))],
  coolant=[("mould", dict(flow=8, ua=90, set_point=38, runs="always"))],
  sens=["throat", "barrel_rear", "barrel_front", "mould", "oil"], disp=dict(tie_z=dict(platen=3.4, mould=2.0)),
  speeds=[1000, 1500], cols=dict(zone_a_W=("duty", 0, 2600), zone_b_W=("duty", 0, 2400), shot_W=("blocks", 0, 1500)), dt=60, rows=(300, 700),
  amb=(25, 1.5), tnoise=(0.1, 0.3), tres=(0.1,)),
 "filament_printer": dict(
  nodes=dict(bed=1.8e3, hotend=0.3e3, chamber=1.6e3, gantry=3e3, frame=12e3, drives=1.5e3),
  links=[("bed", "chamber", 2.2), ("bed", "frame", 0.5), ("hotend", "chamber", 0.25), ("hotend", "gantry", 0.08), ("gantry", "chamber", 1.8), ("gantry", "frame", 0.7),
         ("chamber", "frame", 3.0), ("chamber", AMB, 2.4), ("frame", AMB, 4.5), ("drives", "frame", 1.6), ("drives", AMB, 0.6), ("chamber", AMB, 2.0, "turns")],
  heats=[("recorded_drive", "bed", dict(column="bed_W", gain=0.95)), ("recorded_drive", "hotend", dict(column="hotend_W", gain=1.0)),
         ("servo_loss", "drives", dict(power=14, at_feed=9, exponent=1, idle=6, axis="x")), ("servo_loss", "gantry", dict(power=7, at_feed=9, exponent=1.3, axis="y"))],
  sens=["bed", "hotend", "chamber", "frame", "drives", "gantry"], disp=dict(layer_z=dict(frame=4.2, gantry=-3.0, bed=1.2)),
  speeds=[2400], feeds=dict(x=9000, y=9000), cols=dict(bed_W=("duty", 0, 180), hotend_W=("duty", 0, 60)), dt=30, rows=(300, 900), amb=(22, 1.2)),
 "telescope": dict(
  nodes=dict(mirror=180e3, cell=60e3, truss=30e3, instrument=20e3, dome_air=50e3),
  links=[("mirror", "cell", 25), ("mirror", "dome_air", 18), ("cell", "dome_air", 20), ("cell", "truss", 12), ("truss", "dome_air", 24), ("instrument", "cell", 9),
         ("instrument", "dome_air", 6), ("dome_air", AMB, 80), ("dome_air", AMB, 220, "turns"), ("truss", AMB, 6)],
  heats=[("heat_source", "instrument", dict(power=120)), ("recorded_drive", "dome_air", dict(column="sun_W_m2", gain=1.1)),
         ("heat_source", "dome_air", dict(power=260, at_speed=1200, exponent=2.2))],
  sens=[], disp=dict(focus_z=dict(truss=9.0, mirror=-2.4), tip_x=dict(cell=3.6, truss=-2.6), tip_y=dict(instrument=2.2, cell=-1.6)),
  speeds=[600, 900, 1200], cols=dict(sun_W_m2=("sun", 0, 750)), dt=300, rows=(240, 480), amb=(11, 4.5), dnoise=(0.5, 1.0)),
 "cold_centrifuge": dict(
  nodes=dict(rotor=14e3, bearing=2.5e3, bowl=18e3, motor=9e3, cabinet=25e3),
  links=[("rotor", "bowl", 9), ("bearing", "rotor", 3), ("bearing", "motor", 11), ("bearing", "bowl", 5), ("motor", "cabinet", 7), ("motor", AMB, 9, "turns"),
         ("bowl", "cabinet", 2.5), ("cabinet", AMB, 8)],
  heats=[("heat_source", "rotor", dict(power=260, at_speed=12000, exponent=2.7)), ("friction_law", "bearing", dict(power=75, at_speed=12000, exponent=1.2, decay=0.015, at_temperature=25)),
         ("motor_loss", "motor", dict(power=240, at_speed=12000, exponent=1.3, idle=25))],
  coolant=[("bowl", dict(flow=3, ua=26, set_point=2, runs="always"))],
  sens=["bowl", "motor", "cabinet"], disp={}, speeds=[4000, 6000, 9000, 12000], dt=30, rows=(260, 700), amb=(22, 0.8), start="18 degC"),
 "gantry_mill": dict(
  nodes=dict(spindle=10e3, head=40e3, ram=70e3, crossbeam=160e3, left_column=220e3, right_column=220e3, table=260e3, bed=500e3),
  links=[("spindle", "head", 45), ("head", "ram", 60), ("ram", "crossbeam", 55), ("crossbeam", "left_column", 40), ("crossbeam", "right_column", 40),
         ("left_column", "bed", 50), ("right_column", "bed", 50), ("table", "bed", 60), ("head", AMB, 6), ("ram", AMB, 9), ("crossbeam", AMB, 18),
         ("left_column", AMB, 24), ("right_column", AMB, 24), ("table", AMB, 26), ("bed", AMB, 36), ("head", AMB, 9, "turns")],
  heats=[("friction_law", "spindle", dict(power=380, at_speed=8000, exponent=1.4, decay=0.01, at_temperature=25)), ("motor_loss", "head", dict(power=650, at_speed=8000, exponent=1.5, idle=60)),
         ("servo_loss", "table", dict(power=260, at_feed=20, exponent=1, idle=30, axis="x")), ("servo_loss", "crossbeam", dict(power=150, at_feed=20, exponent=1, axis="y")),
         ("servo_loss", "ram", dict(power=70, at_feed=10, exponent=1, holding=60, axis="z")), ("cutting_heat", "table", dict(share=0.05))],
  sens=["spindle", "head", "ram", "ram", "crossbeam", "left_column", "right_column", "table", "table", "bed"],
  disp=dict(tool_x=dict(left_column=2.2, right_column=-2.0, crossbeam=1.0), tool_y=dict(ram=1.8, crossbeam=1.5, bed=-1.1), tool_z=dict(head=2.4, ram=4.1, left_column=-2.6, right_column=-2.6, bed=0.8)),
  speeds=[2000, 4000, 6000, 8000], feeds=dict(x=20000, y=18000, z=9000), cut=9000, dt=120, rows=(220, 420), amb=(20, 2.0)),
 "calender_roll": dict(
  nodes=dict(roll=150e3, journal=8e3, frame=60e3),
  links=[("roll", "journal", 22), ("journal", "frame", 28), ("roll", AMB, 30), ("frame", AMB, 20)],
  heats=[("recorded_drive", "roll", dict(column="steam_degC", conductance=55)), ("friction_law", "journal", dict(power=520, at_speed=400, exponent=1.2, decay=0.014, at_temperature=40)),
         ("heat_source", "frame", dict(power=90, runs="while_spindle_turns"))],
  sens=["journal"], disp=dict(gap_y=dict(roll=5.5, frame=-3.4)), speeds=[150, 250, 400], cols=dict(steam_degC=("blocks", 22, 130)),
  dt=60, rows=(300, 1000), amb=(25, 1.4), tnoise=(0.06, 0.15), tres=(0.1,)),
}
UNITS = dict(power="W", at_speed="rpm", decay="1/K", at_temperature="degC", idle="W", holding="W", at_feed="m/min", conductance="W/K")


class Machine:
    """A family's nominal numbers; every scattered number has an index into a vector of multipliers."""

    def __init__(self, name):
        f = FAMILIES[name]
        self.name, self.f = name, f
        self.nodes = list(f["nodes"])
        self.ix = {n: i for i, n in enumerate(self.nodes)}
        self.tref = 20.0
        self.start = f.get("start", "ambient")
        self.sigma, self.pname = [], []
        self.C = np.array(list(f["nodes"].values()), float)
        self.c_par = [self.par("C " + n, 0.1) for n in self.nodes]
        self.links = [dict(a=l[0], b=l[1], G=float(l[2]), turns=len(l) > 3, p=self.par("G %s-%s" % l[:2], 0.1)) for l in f["links"]]
        self.heats = []
        for kind, node, num in f["heats"]:
            h = dict(kind=kind, node=node, num=num, p={})
            for k, v in num.items():
                if k in ("power", "idle", "holding", "share", "gain", "conductance", "opening", "decay") and v:
                    h["p"][k] = self.par("%s %s %s" % (kind, node, k), 0.1)
                if k == "exponent":
                    h["p"][k] = self.par("%s %s %s" % (kind, node, k), 0.03)
            self.heats.append(h)
        self.cool = [dict(node=n, p=dict(flow=self.par("flow " + n, 0.1), ua=self.par("UA " + n, 0.1)), **c) for n, c in f.get("coolant", [])]
        seen, self.sens = {}, []
        for n in f["sens"]:
            seen[n] = seen.get(n, 0) + 1
            self.sens.append(("t_" + n + ("" if seen[n] == 1 else "_%d" % seen[n]), n))
        self.disp = [(d, [(n, s, self.par("%s/%s" % (d, n), 0.1)) for n, s in w.items()]) for d, w in f["disp"].items()]
        self.sigma = np.array(self.sigma)
        self.channels = [s for s, _ in self.sens] + [d for d, _ in self.disp]
        self.ns = len(self.sens)

    def par(self, name, sigma):
        self.sigma.append(sigma)
        self.pname.append(name)
        return len(self.sigma) - 1

    def law(self, h, rec, M, n):
        """Heat (rows, B) of a law that does not look at temperatures; of friction at its stated temperature."""
        x, g = h["num"], lambda k, d=0.0: h["num"].get(k, d) * (M[:, h["p"][k]] if k in h["p"] else 1.0)
        on = n > 0
        kind = h["kind"]
        with np.errstate(divide="ignore"):
            if kind in ("friction_law", "motor_loss"):
                return np.where(on, g("idle") + g("power") * np.where(on, n / x["at_speed"], 1) ** g("exponent", 1.0), 0)
            if kind == "heat_source":
                if "exponent" in x:
                    return np.where(on, g("power") * np.where(on, n / x["at_speed"], 1) ** g("exponent"), 0)
                return np.where(on, g("power"), 0) if x.get("runs") else np.ones(n.shape) * g("power")
            if kind == "servo_loss":
                v = rec["drive"]["feed_%s_mm_min" % x["axis"]][:, None] / 1000.0
                return np.where(v > 0, g("idle") + g("power") * np.where(v > 0, v / x["at_feed"], 1) ** g("exponent", 1.0), g("idle") + g("holding"))
            if kind == "cutting_heat":
                return rec["drive"]["cutting_power_W"][:, None] * g("share")
            if "gain" in x:
                return rec["drive"][x["column"]][:, None] * g("gain")
        return np.zeros(n.shape)

    def matrices(self, M, extra):
        B, N = len(M), len(self.nodes) + len(extra)
        K0, K1, f0, f1 = np.zeros((B, N, N)), np.zeros((B, N, N)), np.zeros((B, N)), np.zeros((B, N))
        a0, a1 = np.zeros((B, N)), np.zeros((B, N))
        for l in self.links:
            K, amb, G = (K1, a1, l["G"] * M[:, l["p"]]) if l["turns"] else (K0, a0, l["G"] * M[:, l["p"]])
            i = self.ix[l["a"]]
            K[:, i, i] += G
            if l["b"] == AMB:
                amb[:, i] += G
            else:
                j = self.ix[l["b"]]
                K[:, j, j] += G
                K[:, i, j] -= G
                K[:, j, i] -= G
        for c in self.cool:
            W = c["flow"] * M[:, c["p"]["flow"]] * 3800.0 / 60.0
            G = W * (1 - np.exp(-c["ua"] * M[:, c["p"]["ua"]] / W))
            K, f = (K1, f1) if c["runs"] != "always" else (K0, f0)
            i = self.ix[c["node"]]
            K[:, i, i] += G
            f[:, i] += G * c["set_point"]
        return K0, K1, a0, a1, f0, f1


class Ctx:
    pass


def simulate(mc, rec, M, offset=0.0, faults=(), amps=None, fine=1):
    """Readings (rows, B, channels) and temperatures (rows, B, nodes) of a record; amps: one vector (B) for each fault. In one piece: the steps of one record in their order."""
    B, R, dt, r = len(M), rec["R"], rec["dt"], rec["index"]
    acts = [(f, a) for f, a in zip(faults, amps or []) if r in f["records"]]
    M = M.copy()
    for f, a in acts:
        if "pm" in f:
            f["pm"](M, a)
    n = np.repeat(rec["drive"]["speed_rpm"][:, None], B, 1)
    ta = np.repeat(rec["amb"][:, None], B, 1) + np.broadcast_to(np.asarray(offset, float), (B,))
    for f, a in acts:
        if "speed" in f:
            n = f["speed"](n, rec, a)
        if "ambient" in f:
            ta = f["ambient"](ta, rec, a)
    extra = [c for f, _ in acts for c in f.get("extra", [])]
    N0 = len(mc.nodes)
    N = N0 + len(extra)
    C = np.ones((B, N))
    C[:, :N0] = mc.C * M[:, mc.c_par]
    for k, c in enumerate(extra):
        C[:, N0 + k] = c(acts)
    K0, K1, a0, a1, f0, f1 = mc.matrices(M, extra)
    P = np.zeros((R, B, N))
    plaw, friction, opening = {}, [], []
    for k, h in enumerate(mc.heats):
        i, x = mc.ix[h["node"]], h["num"]
        plaw[k] = p = mc.law(h, rec, M, n)
        if h["kind"] == "friction_law":
            friction.append((i, p, x["decay"] * M[:, h["p"]["decay"]], x["at_temperature"]))
        elif "conductance" in x or "opening" in x:
            col = rec["drive"][x["column"]]
            G = x.get("conductance", x.get("opening")) * M[:, h["p"]["conductance" if "conductance" in x else "opening"]]
            if "conductance" in x:
                K0[:, i, i] += G
                P[:, :, i] += G * col[:, None]
            else:
                opening.append((i, col[:, None] * G))
        else:
            P[:, :, i] += p
    on = n > 0
    varies = bool(np.any(K1)) or bool(np.any(a1))
    heats = [(f, a) for f, a in acts if "heat" in f]
    c = Ctx()
    c.B, c.N, c.N0, c.C, c.plaw, c.mc, c.rec, c.links = B, N, N0, C, plaw, mc, rec, M
    c.mem = [{} for _ in heats]

    def kmat(k):
        if varies:
            s = on[k][:, None]
            return K0 + s[:, :, None] * K1, a0 + s * a1, f0 + s * f1
        return K0, a0, f0

    def rhs(t, k, T, A, ga, q0):
        w = (t - k * dt) / dt
        Ta = ta[k] + (ta[min(k + 1, R - 1)] - ta[k]) * w
        q = q0 + ga * Ta[:, None] - np.matmul(A, T[:, :, None])[:, :, 0]
        for i, p, d, t0 in friction:
            q[:, i] += p[k] * np.exp(-d * (T[:, i] - t0))
        for i, G in opening:
            q[:, i] += G[k] * (Ta - T[:, i])
        if heats:
            c.t, c.k, c.T, c.Ta, c.n = t, k, T, Ta, n[k]
            for (f, a), m in zip(heats, c.mem):
                f["heat"](c, q, a, m)
        return q / C

    T = np.repeat(ta[0][:, None], N, 1)
    if mc.start == "steady":                                   # standstill: settled with what acts at t = 0
        A, ga, ff = K0, a0, f0
        for _ in range(60):
            q = P[0] * 0 + ga * ta[0][:, None] + ff
            for k, h in enumerate(mc.heats):
                if h["kind"] in ("heat_source",) and not h["num"].get("runs") and "exponent" not in h["num"]:
                    q[:, mc.ix[h["node"]]] += plaw[k][0]
                if h["kind"] == "servo_loss":
                    g = lambda s: h["num"].get(s, 0.0) * (M[:, h["p"][s]] if s in h["p"] else 1.0)
                    q[:, mc.ix[h["node"]]] += g("idle") + g("holding")
                if h["kind"] == "recorded_drive" and "gain" in h["num"]:
                    q[:, mc.ix[h["node"]]] += plaw[k][0]
            if heats:
                c.t, c.k, c.T, c.Ta, c.n = 0.0, 0, T, ta[0], n[0] * 0
                for (f, a), m in zip(heats, c.mem):
                    f["heat"](c, q, a, m)
            new = np.empty_like(T)
            new[:, :N0] = np.linalg.solve(A[:, :N0, :N0], q[:, :N0, None])[:, :, 0]
            for f, _ in acts:                                  # a hidden body is as warm as its own
                if "extra" in f:
                    new[:, N0] = new[:, f["body"]]
            if np.abs(new - T).max() < 1e-8:
                break
            T = 0.5 * T + 0.5 * new if heats else new
        c.mem = [{} for _ in heats]
    elif mc.start != "ambient":
        T[:] = float(mc.start.split()[0])
    diag = (np.einsum("bii->bi", K0 + K1) / C)
    for i, G in opening:
        diag[:, i] += G.max(0) / C[:, i]
    lam = 2 * diag.max() * (1.6 if heats else 1.0)
    ns = max(1, int(math.ceil(dt * lam / 1.1))) * fine
    h = dt / ns
    out = np.empty((R, B, N))
    out[0] = T
    for k in range(R - 1):
        A, ga, ff = kmat(k)
        q0 = P[k] + ff
        for s in range(ns):
            t = k * dt + s * h
            k1 = rhs(t, k, T, A, ga, q0)
            k2 = rhs(t + h / 2, k, T + h / 2 * k1, A, ga, q0)
            k3 = rhs(t + h / 2, k, T + h / 2 * k2, A, ga, q0)
            k4 = rhs(t + h, k, T + h * k3, A, ga, q0)
            T = T + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            if heats:
                c.t, c.k, c.T, c.Ta, c.n = t + h, k, T, ta[k], n[k]
                for (f, a), m in zip(heats, c.mem):
                    if "update" in f:
                        f["update"](c, a, m, h)
        out[k + 1] = T
    Y = np.empty((R, B, len(mc.channels)))
    for j, (_, node) in enumerate(mc.sens):
        Y[:, :, j] = out[:, :, mc.ix[node]]
    for j, (_, w) in enumerate(mc.disp):
        Y[:, :, mc.ns + j] = sum(s * M[:, p] * (out[:, :, mc.ix[nd]] - mc.tref) for nd, s, p in w)
    for f, a in sorted(acts, key=lambda fa: fa[0]["kind"].startswith("clock")):
        if "read" in f:
            aux = Ctx()
            aux.T, aux.ta, aux.n, aux.rec, aux.mc, aux.M = out, ta, n, rec, mc, M
            Y = f["read"](Y, aux, a)
    return Y, out


# --------------------------------------------------------------------------------------------------------------- programmes
def blocks(rng, R, dt, lo, hi, choose):
    x, k = np.zeros(R), 0
    while k < R:
        m = max(2, int(round(math.exp(rng.uniform(math.log(lo), math.log(hi))) * 60 / dt)))
        x[k:k + m] = choose()
        k += m
    return x


def make_record(mc, rng, index):
    f = mc.f
    dt, R = f["dt"], int(rng.integers(f["rows"][0], f["rows"][1] + 1))
    span = R * dt / 60.0
    short, long_ = max(6, 2 * dt / 60.0, span / 40), span / 6
    drive = {}
    last = [0.0]

    def speed():
        stop = 0.0 if f.get("nostop") or last[0] == 0 else 0.3
        last[0] = 0.0 if rng.random() < stop else float(rng.choice(f["speeds"]))
        return last[0]
    sp = blocks(rng, R, dt, short, long_, speed) if f["speeds"] else np.zeros(R)
    if not f.get("nostop"):
        sp[:int(rng.integers(2, 6))] = 0
    elif f["speeds"]:
        sp[:2] = sp[2]
    drive["speed_rpm"] = sp
    busy = sp > 0 if f["speeds"] and "cut" in f else np.ones(R, bool)
    for axis, top in f.get("feeds", {}).items():
        v = blocks(rng, R, dt, short, long_, lambda: 0.0 if rng.random() < 0.3 else float(round(top * rng.uniform(0.25, 1.0), -2)))
        v[:2] = 0
        drive["feed_%s_mm_min" % axis] = v * busy
    if "cut" in f:
        cut = blocks(rng, R, dt, short, long_ / 2, lambda: 0.0 if rng.random() < 0.4 else float(round(f["cut"] * rng.uniform(0.15, 1.0), -1)))
        drive["cutting_power_W"] = cut * (sp > 0)
    t = np.arange(R) * dt
    for col, (way, lo, hi) in f.get("cols", {}).items():
        if way == "blocks":
            x = blocks(rng, R, dt, short, long_, lambda: lo if rng.random() < 0.25 else lo + (hi - lo) * rng.uniform(0.2, 1.0))
            x[:2] = lo
        elif way == "duty":                                    # full power first, then on and off by a controller, now and then a set-back
            level = blocks(rng, R, dt, long_ / 3, long_, lambda: float(rng.choice([0.0, 0.3, 0.45, 0.6], p=[0.15, 0.25, 0.35, 0.25])))
            level[:int(rng.uniform(0.06, 0.12) * R)] = 1.0
            period = max(4, int(rng.uniform(6, 14)))
            x = np.where((np.arange(R) % period) < np.round(level * period), hi, lo).astype(float)
            x[:2] = lo
        elif way == "wind":
            hours = np.arange(0, t[-1] + 3600, 3600)
            w = np.clip(np.interp(t, hours, np.cumsum(rng.normal(0, 0.16, len(hours))) + 0.55), 0, 1)
            x = np.where(sp > 0, hi * w * (sp / max(f["speeds"])) ** 1.5, 0)
        else:
            day = np.clip(np.sin(2 * np.pi * (t / 86400 + rng.uniform(0, 1))), 0, 1)
            x = hi * day * np.clip(blocks(rng, R, dt, short, long_ / 2, lambda: rng.uniform(0.3, 1)), 0, 1)
        drive[col] = np.round(x, 1 if hi < 1000 else 0)
    mean, swing = f["amb"]
    amb = mean + rng.normal(0, swing / 2) + swing * rng.uniform(0.3, 1) * np.sin(2 * np.pi * (t / 86400 + rng.uniform(0, 1)))
    knots = np.arange(0, t[-1] + 2400, 2400)
    amb += np.interp(t, knots, swing * 0.15 * rng.normal(0, 1, len(knots)))
    return dict(index=index, R=R, dt=dt, t=t.astype(float), drive=drive, amb=amb)


# ------------------------------------------------------------------------------------------------------------------- faults
def st(quantity, place, follows):
    return dict(quantity=quantity, place=list(place) if isinstance(place, (list, tuple)) else [place], follows=follows)


class No(Exception):
    """This kind has no place in this machine or record."""


def pick(rng, seq):
    seq = list(seq)
    if not seq:
        raise No
    return seq[int(rng.integers(len(seq)))]


def some(rng, S, one=0.35):
    """The records in which something acts: all, or one."""
    n = len(S.recs)
    return [int(rng.integers(n))] if n > 1 and rng.random() < one else list(range(n))


def scale_w(S, node):
    """A heat that warms a node by some kelvin."""
    g = sum(l["G"] for l in S.mc.links if node in (l["a"], l["b"]))
    return 1.0 * g


def window(rng, S):
    r = S.recs[int(rng.integers(len(S.recs)))]
    end = r["t"][-1]
    lo = rng.uniform(0.1, 0.6) * end
    return r["index"], lo, lo + rng.uniform(0.15, 0.35) * end


def drives(S):
    """Names and arrays of the recorded drives, as shares of their largest values."""
    return [k for k in S.recs[0]["drive"] if any(np.ptp(r["drive"][k]) > 0 for r in S.recs)]


def drive_word(k):
    return "power of " + {"speed_rpm": "speed"}.get(k, k.replace("_mm_min", ""))


def wave(S, key, e=1.0):
    top = max(r["drive"][key].max() for r in S.recs)
    return {r["index"]: np.where(r["drive"][key] > 0, r["drive"][key] / top, 0) ** e for r in S.recs}, top


def heat_by(S, node, shape):
    i = S.mc.ix[node]

    def heat(c, q, a, m):
        q[:, i] += a * shape(c)
    return heat


def running(S):
    if not any((r["drive"]["speed_rpm"] > 0).any() and (r["drive"]["speed_rpm"] == 0).sum() > 10 for r in S.recs):
        raise No


def turns_only(S):
    return any((r["drive"]["speed_rpm"] > 0).any() for r in S.recs)


KINDS, OUTSIDE = {}, {}


def kind(name, outside=False):
    def deco(fn):
        (OUTSIDE if outside else KINDS)[name] = fn
        return fn
    return deco


def base(S, node):
    return S.T[0][:, S.mc.ix[node]]


@kind("heat constant")
def _(rng, S):
    n = pick(rng, S.mc.nodes)
    s = 1 if rng.random() < 0.8 else -1
    return dict(what="%s has a constant heat of {a:.3g} W that nobody wrote" % n, sign=s, grid=(0.1 * scale_w(S, n), 30 * scale_w(S, n)), heat=heat_by(S, n, lambda c: s),
                statements=[st("heat", n, "constant")], records=some(rng, S))


@kind("heat running")
def _(rng, S):
    running(S)
    n = pick(rng, S.mc.nodes)
    return dict(what="%s is heated by {a:.3g} W while the spindle turns" % n, grid=(0.1 * scale_w(S, n), 30 * scale_w(S, n)), heat=heat_by(S, n, lambda c: c.n > 0),
                statements=[st("heat", n, "running")], records=some(rng, S))


@kind("heat power of drive")
def _(rng, S):
    n, k, e = pick(rng, S.mc.nodes), pick(rng, drives(S)), float(rng.choice([1.0, 1.0, 1.5, 2.0]))
    w, top = wave(S, k, e)
    return dict(what="%s has a heat of {a:.3g} W at %s = %g that goes with it to the power %g" % (n, k, top, e), grid=(0.1 * scale_w(S, n), 40 * scale_w(S, n)),
                heat=heat_by(S, n, lambda c: w[c.rec["index"]][c.k]), statements=[st("heat", n, drive_word(k))], records=some(rng, S))


@kind("heat window")
def _(rng, S):
    n = pick(rng, S.mc.nodes)
    r, lo, hi = window(rng, S)
    return dict(what="%s is heated by {a:.3g} W from %.0f to %.0f min of record %d" % (n, lo / 60, hi / 60, r + 1), grid=(0.2 * scale_w(S, n), 60 * scale_w(S, n)),
                heat=heat_by(S, n, lambda c: float(lo <= c.t < hi)), statements=[st("heat", n, "window")], records=[r])


@kind("heat fades")
def _(rng, S):
    if S.mc.start == "steady":
        raise No
    n, tau = pick(rng, S.mc.nodes), rng.uniform(0.08, 0.3) * min(r["t"][-1] for r in S.recs)
    return dict(what="%s has a heat of {a:.3g} W that fades from the start of a record with %.0f min" % (n, tau / 60), grid=(0.2 * scale_w(S, n), 60 * scale_w(S, n)),
                heat=heat_by(S, n, lambda c: math.exp(-c.t / tau)), statements=[st("heat", n, "since start")], records=some(rng, S))


def law_word(h):
    if h["kind"] in ("friction_law", "motor_loss"):
        return "power of speed"
    if h["kind"] == "heat_source":
        return "power of speed" if "exponent" in h["num"] else "running" if h["num"].get("runs") else "constant"
    if h["kind"] == "servo_loss":
        return "power of feed_" + h["num"]["axis"]
    return "power of cutting_power_W" if h["kind"] == "cutting_heat" else "power of " + h["num"]["column"]


@kind("heat of another size")
def _(rng, S):
    h = pick(rng, [h for h in S.mc.heats if "power" in h["p"] or "share" in h["p"] or "gain" in h["p"]])
    s = 1 if rng.random() < 0.6 else -1
    ps = [h["p"][k] for k in ("power", "idle", "holding", "share", "gain") if k in h["p"]]

    def pm(M, a):
        for p in ps:
            M[:, p] *= np.exp(s * a)
    word = law_word(h)
    states = [st("heat", h["node"], word)]
    return dict(what="%s of %s is {f:.3g} times as large as written" % (h["kind"], h["node"]), sign=s, factor=True, grid=(0.15, 1.4), pm=pm, statements=states, records=some(rng, S))


@kind("heat of another exponent")
def _(rng, S):
    h = pick(rng, [h for h in S.mc.heats if "exponent" in h["p"] and h["num"].get("at_speed")])
    p, s = h["p"]["exponent"], 1 if rng.random() < 0.7 else -1

    def pm(M, a):
        M[:, p] *= np.exp(s * a)
    return dict(what="%s of %s grows with speed by an exponent {f:.3g} times the written one" % (h["kind"], h["node"]), sign=s, factor=True, grid=(0.12, 1.0), pm=pm,
                statements=[st("heat", h["node"], "power of speed")], records=list(range(len(S.recs))))


@kind("heat thins with temperature")
def _(rng, S):
    k, h = pick(rng, [(k, h) for k, h in enumerate(S.mc.heats) if h["kind"] in ("motor_loss", "heat_source", "servo_loss") and np.ptp(S.plaw(k)) > 0])
    i, t0 = S.mc.ix[h["node"]], float(np.mean(S.T[0][0]))

    def heat(c, q, a, m):
        q[:, i] += c.plaw[k][c.k] * np.expm1(-a * np.clip(c.T[:, i] - t0, -20, 200))
    return dict(what="%s of %s falls by the share {a:.3g} for each kelvin over %.1f degC" % (h["kind"], h["node"], t0), grid=(0.003, 0.08), heat=heat,
                statements=[st("heat", h["node"], "temperature of " + h["node"])], records=list(range(len(S.recs))))


@kind("exchange of another size")
def _(rng, S):
    l = pick(rng, S.mc.links)
    s = 1 if rng.random() < 0.45 else -1
    return dict(what="the exchange between %s and %s is {f:.3g} times as large as written" % (l["a"], l["b"]), sign=s, factor=True, grid=(0.2, 1.5),
                pm=lambda M, a: M.__setitem__((slice(None), l["p"]), M[:, l["p"]] * np.exp(s * a)),
                statements=[st("exchange", [l["a"], l["b"]], "running" if l["turns"] else "constant")], records=some(rng, S))


def pair(rng, S, linked=False):
    have = {frozenset((l["a"], l["b"])) for l in S.mc.links}
    ns = S.mc.nodes
    return pick(rng, [(a, b) for x, a in enumerate(ns) for b in ns[x + 1:] if (frozenset((a, b)) in have) == linked])


def exch(S, a_, b_, shape):
    i, j = S.mc.ix[a_], None if b_ == AMB else S.mc.ix[b_]

    def heat(c, q, a, m):
        w = a * shape(c, c.T[:, i] - (c.Ta if j is None else c.T[:, j]), m)
        f = w * ((c.Ta if j is None else c.T[:, j]) - c.T[:, i])
        q[:, i] += f
        if j is not None:
            q[:, j] -= f
    return heat


def gscale(S, *nodes):
    return min(sum(l["G"] for l in S.mc.links if n in (l["a"], l["b"])) for n in nodes if n != AMB)


@kind("exchange that nobody wrote")
def _(rng, S):
    a, b = pair(rng, S) if rng.random() < 0.6 else (pick(rng, [n for n in S.mc.nodes if frozenset((n, AMB)) not in {frozenset((l["a"], l["b"])) for l in S.mc.links}]), AMB)
    return dict(what="%s and %s exchange {a:.3g} W/K" % (a, b), grid=(0.02 * gscale(S, a, b), 2 * gscale(S, a, b)), heat=exch(S, a, b, lambda c, d, m: 1.0),
                statements=[st("exchange", [a, b], "constant")], records=some(rng, S))


@kind("exchange running")
def _(rng, S):
    running(S)
    a, b = pair(rng, S, True) if rng.random() < 0.4 else (pick(rng, S.mc.nodes), AMB)
    return dict(what="%s and %s exchange {a:.3g} W/K more while the spindle turns" % (a, b), grid=(0.03 * gscale(S, a, b), 2 * gscale(S, a, b)),
                heat=exch(S, a, b, lambda c, d, m: c.n > 0), statements=[st("exchange", [a, b], "running")], records=some(rng, S))


@kind("exchange power of speed")
def _(rng, S):
    running(S)
    a, e = pick(rng, S.mc.nodes), float(rng.choice([0.667, 0.8, 1.0, 1.5]))
    w, top = wave(S, "speed_rpm", e)
    return dict(what="%s and ambient exchange {a:.3g} W/K more at %g rpm, by the power %g of speed" % (a, top, e), grid=(0.03 * gscale(S, a), 2 * gscale(S, a)),
                heat=exch(S, a, AMB, lambda c, d, m: w[c.rec["index"]][c.k]), statements=[st("exchange", [a, AMB], "power of speed")], records=list(range(len(S.recs))))


@kind("exchange window")
def _(rng, S):
    a, b = (pick(rng, S.mc.nodes), AMB) if rng.random() < 0.7 else pair(rng, S, True)
    r, lo, hi = window(rng, S)
    return dict(what="%s and %s exchange {a:.3g} W/K more from %.0f to %.0f min of record %d" % (a, b, lo / 60, hi / 60, r + 1), grid=(0.05 * gscale(S, a, b), 2.2 * gscale(S, a, b)),
                heat=exch(S, a, b, lambda c, d, m: float(lo <= c.t < hi)), statements=[st("exchange", [a, b], "window")], records=[r])


@kind("exchange grows with difference")
def _(rng, S):
    a = pick(rng, S.mc.nodes)
    e = float(rng.choice([0.25, 0.33, 1.0]))
    d0 = max(2.0, float(np.abs(base(S, a) - S.recs[0]["amb"]).max()))
    return dict(what="%s and ambient exchange {a:.3g} W/K more at a difference of %.1f K, by its power %g" % (a, d0, e), grid=(0.03 * gscale(S, a), 2 * gscale(S, a)),
                heat=exch(S, a, AMB, lambda c, d, m: np.minimum(np.abs(d) / d0, 3) ** e), statements=[st("exchange", [a, AMB], "difference")], records=list(range(len(S.recs))))


@kind("capacity")
def _(rng, S):
    n = pick(rng, S.mc.nodes)
    p, s = S.mc.c_par[S.mc.ix[n]], 1 if rng.random() < 0.6 else -1
    return dict(what="the capacity of %s is {f:.3g} times the written one" % n, sign=s, factor=True, grid=(0.2, 1.3), pm=lambda M, a: M.__setitem__((slice(None), p), M[:, p] * np.exp(s * a)),
                statements=[st("capacity", n, "constant")], records=some(rng, S, 0.2))


@kind("hidden body")
def _(rng, S):
    n = pick(rng, S.mc.nodes)
    i = S.mc.ix[n]
    cap, tau = S.mc.C[i], rng.uniform(8, 40) * 60
    box = {}

    def size(acts):
        return np.maximum(1.0, box["a"])
    f = dict(what="behind %s stands a body of {a:.3g} J/K, reached with a time constant of %.0f min" % (n, tau / 60), grid=(0.05 * cap, 3 * cap), extra=[size], body=i,
             statements=[st("capacity", n, "constant"), st("exchange", [n, n + "_hidden"], "constant")], records=some(rng, S, 0.25))

    def heat(c, q, a, m):
        g = np.maximum(1.0, a) / tau
        fl = np.where(a > 0, g * (c.T[:, i] - c.T[:, c.N0]), 0)
        q[:, i] -= fl
        q[:, c.N0] += np.where(a > 0, fl, 0)
    f["heat"] = heat

    def pm(M, a):
        box["a"] = a
    f["pm"] = pm
    return f


def sensor(rng, S):
    return pick(rng, range(S.mc.ns))


def reader(j, fn):
    def read(Y, x, a):
        Y = Y.copy()
        Y[:, :, j] = fn(Y[:, :, j], x, a)
        return Y
    return read


def lagged(x, tau, dt):
    """First-order lag of (rows, B), linear between rows, settled at t = 0; tau may be a vector."""
    tau = np.broadcast_to(np.asarray(tau, float), x.shape[1:])
    y = np.empty_like(x)
    y[0] = x[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        e = np.where(tau > 0, np.exp(-dt / np.maximum(tau, 1e-9)), 0)
        for k in range(len(x) - 1):
            s = (x[k + 1] - x[k]) / dt
            y[k + 1] = np.where(tau > 0, x[k + 1] - s * tau + (y[k] - x[k] + s * tau) * e, x[k + 1])
    return y


@kind("reading bias")
def _(rng, S):
    j = sensor(rng, S)
    s = 1 if rng.random() < 0.5 else -1
    return dict(what="%s reads {a:.3g} K too much" % S.ch[j], sign=s, grid=(0.02, 30), read=reader(j, lambda y, x, a: y + s * a), statements=[st("reading", S.ch[j], "constant")], records=some(rng, S))


@kind("reading drift")
def _(rng, S):
    j = sensor(rng, S)
    s = 1 if rng.random() < 0.5 else -1
    return dict(what="%s drifts by {a:.3g} K/h" % S.ch[j], sign=s, grid=(0.005, 15), read=reader(j, lambda y, x, a: y + s * a * x.rec["t"][:, None] / 3600),
                statements=[st("reading", S.ch[j], "since start")], records=some(rng, S))


@kind("reading lag")
def _(rng, S):
    j = sensor(rng, S)
    return dict(what="%s follows with a lag of {a:.3g} s" % S.ch[j], grid=(30, 3600), read=reader(j, lambda y, x, a: lagged(y, a, x.rec["dt"])),
                statements=[st("reading", S.ch[j], "lag")], records=list(range(len(S.recs))))


@kind("reading detached")
def _(rng, S):
    j = sensor(rng, S)
    r, lo, hi = window(rng, S)
    return dict(what="%s comes off at %.0f min of record %d and reads the share {a:.3g} of the air" % (S.ch[j], lo / 60, r + 1), grid=(0.01, 0.95),
                read=reader(j, lambda y, x, a: np.where(x.rec["t"][:, None] >= lo, a * x.ta + (1 - a) * y, y)), statements=[st("reading", S.ch[j], "window")], records=[r])


@kind("reading of another place")
def _(rng, S):
    j = sensor(rng, S)
    own = S.mc.sens[j][1]
    b = pick(rng, [n for n in S.mc.nodes + [AMB] if n != own])
    return dict(what="%s reads the share {a:.3g} of %s" % (S.ch[j], b), grid=(0.01, 0.95),
                read=reader(j, lambda y, x, a: (1 - a) * y + a * (x.ta if b == AMB else x.T[:, :, x.mc.ix[b]])), statements=[st("reading", S.ch[j], "temperature of " + b)],
                records=list(range(len(S.recs))))


@kind("reading of a wrong scale")
def _(rng, S):
    j = sensor(rng, S)
    s = 1 if rng.random() < 0.5 else -1
    return dict(what="%s errs by the share {a:.3g} of what it is over the reference" % S.ch[j], sign=s, grid=(0.005, 0.6), read=reader(j, lambda y, x, a: y + s * a * (y - x.mc.tref)),
                statements=[st("reading", S.ch[j], "temperature of " + S.mc.sens[j][1])], records=list(range(len(S.recs))))


@kind("reading errs running")
def _(rng, S):
    running(S)
    j = sensor(rng, S)
    s = 1 if rng.random() < 0.5 else -1
    return dict(what="%s reads {a:.3g} K too much while the spindle turns" % S.ch[j], sign=s, grid=(0.02, 30), read=reader(j, lambda y, x, a: y + s * a * (x.n > 0)),
                statements=[st("reading", S.ch[j], "running")], records=some(rng, S))


@kind("reading swap")
def _(rng, S):
    i, j = pair_ix(rng, S.mc.ns)
    if S.mc.sens[i][1] == S.mc.sens[j][1]:
        raise No

    def read(Y, x, a):
        Z = Y.copy()
        Z[:, :, i] = np.where(a > 0, Y[:, :, j], Y[:, :, i])
        Z[:, :, j] = np.where(a > 0, Y[:, :, i], Y[:, :, j])
        return Z
    return dict(what="%s and %s are swapped" % (S.ch[i], S.ch[j]), fixed=1.0, read=read, statements=[st("reading", [S.ch[i], S.ch[j]], "constant")], records=some(rng, S))


def pair_ix(rng, n):
    if n < 2:
        raise No
    i, j = rng.choice(n, 2, replace=False)
    return int(min(i, j)), int(max(i, j))


def dsp(rng, S):
    return S.mc.ns + pick(rng, range(len(S.mc.disp)))


def dname(S, j):
    return S.mc.disp[j - S.mc.ns]


@kind("displacement step")
def _(rng, S):
    j = dsp(rng, S)
    r, lo, _ = window(rng, S)
    s = 1 if rng.random() < 0.5 else -1
    creep = 0.0 if rng.random() < 0.6 else rng.uniform(5, 30) * 60
    shape = lambda t: np.where(t >= lo, 1.0 if not creep else -np.expm1(-np.clip(t - lo, 0, None) / max(creep, 1)), 0)
    return dict(what="%s goes by {a:.3g} um at %.0f min of record %d, %s" % (S.ch[j], lo / 60, r + 1, "creeping with %.0f min" % (creep / 60) if creep else "at once"), sign=s,
                grid=(0.2, 60), read=reader(j, lambda y, x, a: y + s * a * shape(x.rec["t"])[:, None]), statements=[st("displacement", S.ch[j], "window")], records=[r])


@kind("displacement follows a body")
def _(rng, S):
    j = dsp(rng, S)
    have = [n for n, _, _ in dname(S, j)[1]]
    b = pick(rng, [n for n in S.mc.nodes + [AMB] if n not in have])
    s = 1 if rng.random() < 0.5 else -1
    states = [st("displacement", S.ch[j], "temperature of " + b)] + ([] if b == AMB else [st("expansion", b, "constant")])
    return dict(what="%s also follows %s, by {a:.3g} um/K" % (S.ch[j], b), sign=s, grid=(0.02, 40),
                read=reader(j, lambda y, x, a: y + s * a * ((x.ta if b == AMB else x.T[:, :, x.mc.ix[b]]) - x.mc.tref)), statements=states, records=list(range(len(S.recs))))


@kind("expansion")
def _(rng, S):
    j = dsp(rng, S)
    n, sens, p = pick(rng, dname(S, j)[1])
    s = 1 if rng.random() < 0.5 else -1
    states = [st("expansion", n, "constant"), st("displacement", S.ch[j], "temperature of " + n)]
    return dict(what="%s moves %s by {f:.3g} times the written sensitivity" % (n, S.ch[j]), sign=s, factor=True, grid=(0.2, 1.5),
                pm=lambda M, a: M.__setitem__((slice(None), p), M[:, p] * np.exp(s * a)), statements=states, records=list(range(len(S.recs))))


@kind("displacement of a wrong scale")
def _(rng, S):
    j = dsp(rng, S)
    s = 1 if rng.random() < 0.5 else -1
    return dict(what="%s reads the share {a:.3g} too much of itself" % S.ch[j], sign=s, grid=(0.02, 0.8), read=reader(j, lambda y, x, a: y * (1 + s * a)),
                statements=[st("displacement", S.ch[j], "constant")], records=list(range(len(S.recs))))


@kind("displacement grows with speed")
def _(rng, S):
    if not turns_only(S):
        raise No
    j = dsp(rng, S)
    e, tau = float(rng.choice([1.0, 1.5, 2.0])), 0.0 if rng.random() < 0.4 else rng.uniform(4, 25) * 60
    w, top = wave(S, "speed_rpm", e)

    def fn(y, x, a):
        u = w[x.rec["index"]]
        if tau:                                                # held from row to row, with a lag, at rest at t = 0
            z, k_ = np.zeros_like(u), math.exp(-x.rec["dt"] / tau)
            for k in range(len(u) - 1):
                z[k + 1] = u[k] + (z[k] - u[k]) * k_
            u = z
        return y + a * u[:, None]
    return dict(what="%s grows by {a:.3g} um at %g rpm, by the power %g of speed%s" % (S.ch[j], top, e, " behind %.0f min" % (tau / 60) if tau else ""), grid=(0.2, 80), read=reader(j, fn),
                statements=[st("displacement", S.ch[j], "power of speed")], records=list(range(len(S.recs))))


@kind("ambient offset")
def _(rng, S):
    s = 1 if rng.random() < 0.5 else -1
    return dict(what="the hall is {a:.3g} K warmer than recorded", sign=s, grid=(1.75, 10), ambient=lambda ta, rec, a: ta + s * a, statements=[st("ambient", "hall", "constant")],
                records=some(rng, S))


@kind("ambient window")
def _(rng, S):
    r, lo, hi = window(rng, S)
    s = 1 if rng.random() < 0.5 else -1
    return dict(what="the hall is {a:.3g} K warmer than recorded from %.0f to %.0f min of record %d" % (lo / 60, hi / 60, r + 1), sign=s, grid=(0.8, 14),
                ambient=lambda ta, rec, a: ta + s * a * ((rec["t"] >= lo) & (rec["t"] < hi))[:, None], statements=[st("ambient", "hall", "window")], records=[r])


@kind("ambient with speed")
def _(rng, S):
    if S.mc.start == "steady":
        raise No
    running(S)
    tau = rng.uniform(8, 40) * 60
    w, top = wave(S, "speed_rpm", 1.0)

    def amb(ta, rec, a):
        u = w[rec["index"]]
        z, k_ = np.zeros_like(u), math.exp(-rec["dt"] / tau)
        for k in range(len(u) - 1):
            z[k + 1] = u[k] + (z[k] - u[k]) * k_
        return ta + a * z[:, None]
    return dict(what="the machine warms the hall about itself by {a:.3g} K at %g rpm, behind %.0f min" % (top, tau / 60), grid=(0.5, 10), ambient=amb,
                statements=[st("ambient", "hall", "power of speed")], records=list(range(len(S.recs))))


@kind("clock offset")
def _(rng, S):
    s = 1 if rng.random() < 0.6 else -1

    def read(Y, x, a):
        t = x.rec["t"]
        Z = np.empty_like(Y)
        for b in range(Y.shape[1]):
            for j in range(Y.shape[2]):
                Z[:, b, j] = np.interp(t - s * (a[b] if np.ndim(a) else a), t, Y[:, b, j])
        return Z
    return dict(what="readings are logged {a:.3g} s late", sign=s, grid=(20, 1800), read=read, statements=[st("clock", "clock", "constant")], records=some(rng, S, 0.6))


@kind("speed factor")
def _(rng, S):
    if not turns_only(S):
        raise No
    s = 1 if rng.random() < 0.3 else -1
    drv = [h for h in S.mc.heats if h["kind"] in ("friction_law", "motor_loss") or (h["kind"] == "heat_source" and "exponent" in h["num"])]
    if not drv:
        raise No
    states = [st("speed", "spindle", "constant")]
    if len(drv) == 1 and not drv[0]["num"].get("idle"):
        states.append(st("heat", drv[0]["node"], "power of speed"))
    return dict(what="the spindle turns {f:.3g} times as fast as recorded", sign=s, factor=True, grid=(0.05, 0.6), speed=lambda n, rec, a: n * np.exp(s * a), statements=states, records=some(rng, S))


@kind("missing stop")
def _(rng, S):
    r = pick(rng, S.recs)
    on = r["drive"]["speed_rpm"] > 0
    ks = [k for k in range(5, r["R"] - 20) if on[k:k + 8].all()]
    k0 = pick(rng, ks)
    t0 = r["t"][k0]

    def speed(n, rec, a):
        return np.where((rec["t"][:, None] >= t0) & (rec["t"][:, None] < t0 + a), 0, n)
    return dict(what="from %.0f min of record %d on the spindle stood for {a:.3g} s that nobody recorded" % (t0 / 60, r["index"] + 1), grid=(6 * r["dt"], 0.3 * r["t"][-1]), speed=speed,
                steps=r["dt"], statements=[st("speed", "spindle", "window")], records=[r["index"]])


# ---- outside any simple grammar
def thermostat(on, low, high, T):
    return np.where(T > high, True, np.where(T < low, False, on))


@kind("valve with a thermostat", True)
def _(rng, S):
    n = pick(rng, S.mc.nodes)
    b = base(S, n)
    hi = float(np.quantile(b, rng.uniform(0.5, 0.8)))
    lo = hi - max(0.15 * np.ptp(b), 0.05)
    ex = exch(S, n, AMB, lambda c, d, m: m.get("on", 0.0))

    def update(c, a, m, h):
        m["on"] = thermostat(m.get("on", np.zeros(c.B, bool)), lo, hi, c.T[:, c.mc.ix[n]])
    if hi - S.recs[0]["amb"].max() < 1:
        raise No
    return dict(what="a valve opens %s to the air with {a:.3g} W/K when it is over %.2f degC and shuts below %.2f degC" % (n, hi, lo), grid=(0.05 * gscale(S, n), 2 * gscale(S, n)), heat=ex, update=update,
                statements=[st("exchange", [n, AMB], "a thermostat with hysteresis at " + n)], records=list(range(len(S.recs))))


@kind("phase change", True)
def _(rng, S):
    n = pick(rng, S.mc.nodes)
    i, b = S.mc.ix[n], base(S, n)
    tm = float(np.quantile(b, rng.uniform(0.3, 0.7)))
    g = 0.7 * gscale(S, n)

    def heat(c, q, a, m):
        H, d = m.get("H", np.zeros(c.B)), c.T[:, i] - tm
        q[:, i] -= np.where((a > 0) & (((d > 0) & (H < a)) | ((d < 0) & (H > 0))), g * d, 0)

    def update(c, a, m, h):
        H, d = m.get("H", np.zeros(c.B)), c.T[:, i] - tm
        m["H"] = np.clip(H + np.where(((d > 0) & (H < a)) | ((d < 0) & (H > 0)), g * d, 0) * h, 0, a)
    if np.ptp(b) < 1 or b[0] > tm:
        raise No
    return dict(what="something at %s melts at %.2f degC, takes {a:.3g} J and gives them back as it freezes" % (n, tm), grid=(0.02 * S.mc.C[i] * np.ptp(b), 3 * S.mc.C[i] * np.ptp(b)), heat=heat, update=update,
                statements=[st("capacity", n, "a phase change at one temperature of " + n)], records=list(range(len(S.recs))))


@kind("preload beyond a difference", True)
def _(rng, S):
    l = pick(rng, [l for l in S.mc.links if l["b"] != AMB])
    a_, b_ = (l["a"], l["b"]) if rng.random() < 0.5 else (l["b"], l["a"])
    i, j = S.mc.ix[a_], S.mc.ix[b_]
    d = np.concatenate([T[:, i] - T[:, j] for T in S.T])
    d0, dm = float(np.quantile(d, 0.55)), float(d.max())
    if dm - d0 < 0.3 or not turns_only(S):
        raise No

    def heat(c, q, a, m):
        q[:, i] += a * np.clip((c.T[:, i] - c.T[:, j] - d0) / (dm - d0), 0, 1.5) ** 2 * (c.n > 0)
    return dict(what="%s rubs while it turns and is more than %.2f K warmer than %s: {a:.3g} W at %.2f K, with the square of the excess" % (a_, d0, b_, dm), grid=(0.05 * scale_w(S, a_), 8 * scale_w(S, a_)), heat=heat,
                statements=[st("heat", a_, "the square of the difference to %s beyond a threshold, while running" % b_)], records=list(range(len(S.recs))))


@kind("contact that closes", True)
def _(rng, S):
    a_, b_ = pair(rng, S, rng.random() < 0.5)
    i, j = S.mc.ix[a_], S.mc.ix[b_]
    d = np.concatenate([T[:, i] - T[:, j] for T in S.T])
    if abs(np.quantile(d, 0.05)) > abs(np.quantile(d, 0.95)):
        a_, b_, i, j, d = b_, a_, j, i, -d
    d0 = float(np.quantile(d, rng.uniform(0.45, 0.7)))
    if d0 < 0.5 or d.max() - d0 < 0.5:
        raise No

    def update(c, a, m, h):
        m["on"] = thermostat(m.get("on", np.zeros(c.B, bool)), 0.6 * d0, d0, c.T[:, i] - c.T[:, j])
    return dict(what="%s touches %s, with {a:.3g} W/K, once it is %.2f K warmer, until it is less than %.2f K warmer" % (a_, b_, d0, 0.6 * d0), grid=(0.05 * gscale(S, a_, b_), 2 * gscale(S, a_, b_)),
                heat=exch(S, a_, b_, lambda c, dd, m: m.get("on", 0.0)), update=update, statements=[st("exchange", [a_, b_], "a gap that closes beyond a difference, with hysteresis")],
                records=list(range(len(S.recs))))


def run_hours(S, key="speed_rpm"):
    """What a drive has summed up before each row, over the records in their order, as a share of the total."""
    out, s = {}, 0.0
    for r in S.recs:
        x = r["drive"][key]
        out[r["index"]] = s + np.concatenate([[0], np.cumsum(x[:-1])]) * r["dt"]
        s += x.sum() * r["dt"]
    return {k: v / max(s, 1e-9) for k, v in out.items()}


@kind("wear", True)
def _(rng, S):
    key = pick(rng, [k for k in drives(S) if not k.endswith("degC")])
    n = pick(rng, S.mc.nodes)
    done, (w, top) = run_hours(S, key), wave(S, key)
    return dict(what="%s wears: with %s it has a heat that grows with all that %s has summed up over the records, to {a:.3g} W at %g at the end" % (n, key, key, top), grid=(0.2 * scale_w(S, n), 50 * scale_w(S, n)),
                heat=heat_by(S, n, lambda c: done[c.rec["index"]][c.k] ** 1.5 * w[c.rec["index"]][c.k]), statements=[st("heat", n, "%s times what it has summed up over all records" % drive_word(key))],
                records=list(range(len(S.recs))))


@kind("grease after a stop", True)
def _(rng, S):
    running(S)
    n = pick(rng, S.mc.nodes)
    ts, tr = rng.uniform(15, 60) * 60, rng.uniform(5, 20) * 60
    shape = {}
    for r in S.recs:
        on, stiff, y = r["drive"]["speed_rpm"] > 0, np.zeros(r["R"]), 1.0
        for k in range(r["R"]):
            y = y * math.exp(-r["dt"] / tr) if on[k] else 1 - (1 - y) * math.exp(-r["dt"] / ts)
            stiff[k] = y if on[k] else 0
        shape[r["index"]] = stiff
    return dict(what="grease at %s stiffens with %.0f min while it stands and heats by {a:.3g} W as it starts, working off with %.0f min" % (n, ts / 60, tr / 60), grid=(0.2 * scale_w(S, n), 60 * scale_w(S, n)),
                heat=heat_by(S, n, lambda c: shape[c.rec["index"]][c.k]), statements=[st("heat", n, "how long it stood before and how long it has run since")], records=list(range(len(S.recs))))


@kind("wet surface", True)
def _(rng, S):
    key = pick(rng, [k for k in drives(S) if k != "speed_rpm" and not k.endswith("degC")])
    n = pick(rng, S.mc.nodes)
    i, dry = S.mc.ix[n], rng.uniform(15, 50) * 60
    wet = {}
    for r in S.recs:
        x, y, o = r["drive"][key] > 0.6 * max(q["drive"][key].max() for q in S.recs), 0.0, np.zeros(r["R"])
        for k in range(r["R"]):
            y = 1.0 if x[k] else y * math.exp(-r["dt"] / dry)
            o[k] = y if y > 0.2 else 0.0
        wet[r["index"]] = o

    def heat(c, q, a, m):
        q[:, i] -= a * wet[c.rec["index"]][c.k] * np.exp(0.05 * np.clip(c.T[:, i] - 20, -30, 30))
    return dict(what="%s is wetted whenever %s is over 60 %% of its top and dries with %.0f min: evaporation takes {a:.3g} W at 20 degC, more when warm" % (n, key, dry / 60), grid=(0.05 * scale_w(S, n), 8 * scale_w(S, n)), heat=heat,
                statements=[st("heat", n, "wetting by %s and drying, and the vapour pressure at %s" % (key, n))], records=list(range(len(S.recs))))


@kind("stick-slip", True)
def _(rng, S):
    j = dsp(rng, S)

    def fn(y, x, a):
        z = y.copy()
        for k in range(1, len(y)):
            z[k] = np.where(np.abs(y[k] - z[k - 1]) > a, y[k], z[k - 1])
        return z
    return dict(what="%s sticks and slips: it stays until {a:.3g} um are pent up, then jumps there" % S.ch[j], grid=(0.5, 60), read=reader(j, fn), statements=[st("displacement", S.ch[j], "stick-slip of a joint")],
                records=list(range(len(S.recs))))


@kind("backlash", True)
def _(rng, S):
    j = dsp(rng, S)

    def fn(y, x, a):
        z = y.copy()
        for k in range(1, len(y)):
            z[k] = np.clip(z[k - 1], y[k] - a, y[k] + a)
        return z
    return dict(what="%s has play: it follows {a:.3g} um behind either way" % S.ch[j], grid=(0.5, 60), read=reader(j, fn), statements=[st("displacement", S.ch[j], "hysteresis, play")],
                records=list(range(len(S.recs))))


def telegraph(rng, S, recs, up, down):
    out = {}
    for r in recs:
        o, on = np.zeros(r["R"]), False
        for k in range(r["R"]):
            if rng.random() < r["dt"] / (down if not on else up):
                on = not on
            o[k] = on
        out[r["index"]] = o
    return out


@kind("intermittent contact of a thermometer", True)
def _(rng, S):
    j = sensor(rng, S)
    w = telegraph(rng, S, S.recs, rng.uniform(3, 20) * 60, rng.uniform(15, 60) * 60)
    return dict(what="%s has a loose contact: by chance, for minutes, it reads the share {a:.3g} of the air" % S.ch[j], grid=(0.01, 0.95),
                read=reader(j, lambda y, x, a: y + a * (x.ta - y) * w[x.rec["index"]][:, None]), statements=[st("reading", S.ch[j], "chance")], records=list(range(len(S.recs))))


@kind("cross-talk of channels", True)
def _(rng, S):
    i, j = pair_ix(rng, len(S.ch))
    if rng.random() < 0.5 and j < S.mc.ns:
        i, j = j, i
    tau = rng.uniform(6, 25) * 60

    def read(Y, x, a):
        Z = Y.copy()
        Z[:, :, i] = Y[:, :, i] + a * (Y[:, :, j] - lagged(Y[:, :, j], tau, x.rec["dt"]))
        return Z
    q = "reading" if i < S.mc.ns else "displacement"
    return dict(what="%s picks up {a:.3g} of the quick changes of %s, those within %.0f min" % (S.ch[i], S.ch[j], tau / 60), grid=(0.01, 1.5), read=read, statements=[st(q, S.ch[i], "cross-talk: changes of " + S.ch[j])],
                records=list(range(len(S.recs))))


@kind("clipped reading", True)
def _(rng, S):
    j = sensor(rng, S)
    top = max(float(Y[:, j].max()) for Y in S.Y)
    return dict(what="%s reads no more than {a:.3g} K below its highest, %.2f degC" % (S.ch[j], top), grid=(0.05, 60), read=reader(j, lambda y, x, a: np.where(a > 0, np.minimum(y, top - a), y)),
                statements=[st("reading", S.ch[j], "a limit that it does not pass")], records=list(range(len(S.recs))))


@kind("stuck reading", True)
def _(rng, S):
    j = sensor(rng, S)
    r = pick(rng, S.recs)
    starts = np.sort(rng.uniform(0.05, 0.85, 3)) * r["t"][-1]

    def fn(y, x, a):
        z, t = y.copy(), x.rec["t"]
        for s in starts:
            k0 = int(np.searchsorted(t, s))
            z = np.where(((t >= s)[:, None]) & (t[:, None] < s + a), y[k0], z)
        return z
    return dict(what="%s freezes at %s min of record %d, for {a:.3g} s each" % (S.ch[j], ", ".join("%.0f" % (s / 60) for s in starts), r["index"] + 1), grid=(3 * r["dt"], 0.2 * r["t"][-1]), steps=r["dt"],
                read=reader(j, fn), statements=[st("reading", S.ch[j], "windows in which it keeps its value")], records=[r["index"]])


@kind("clock that runs fast", True)
def _(rng, S):
    s = 1 if rng.random() < 0.5 else -1

    def read(Y, x, a):
        t = x.rec["t"]
        Z = np.empty_like(Y)
        for b in range(Y.shape[1]):
            for j in range(Y.shape[2]):
                Z[:, b, j] = np.interp(t * (1 - s * a[b]), t, Y[:, b, j])
        return Z
    return dict(what="the logger's clock runs fast by the share {a:.3g} against the drive's", sign=s, grid=(0.002, 0.12), read=read, statements=[st("clock", "clock", "grows with time")], records=some(rng, S, 0.5))


@kind("cut-out of a heater", True)
def _(rng, S):
    k, h = pick(rng, [(k, h) for k, h in enumerate(S.mc.heats) if h["kind"] == "recorded_drive" and "gain" in h["p"]])
    n = h["node"]
    i = S.mc.ix[n]
    b = np.concatenate([T[:, i] for T in S.T])
    hi = float(np.quantile(b, rng.uniform(0.6, 0.85)))
    lo = hi - 0.12 * np.ptp(b)

    def heat(c, q, a, m):
        q[:, i] -= a * c.plaw[k][c.k] * m.get("on", 0.0)

    def update(c, a, m, hh):
        m["on"] = thermostat(m.get("on", np.zeros(c.B, bool)), lo, hi, c.T[:, i])
    return dict(what="a protection takes the share {a:.3g} of what %s brings to %s once that is over %.2f degC, until it is below %.2f degC" % (h["num"]["column"], n, hi, lo), grid=(0.03, 1.0), heat=heat, update=update,
                statements=[st("heat", n, "a thermostat with hysteresis at %s, times %s" % (n, h["num"]["column"]))], records=list(range(len(S.recs))))


@kind("gusts", True)
def _(rng, S):
    n = pick(rng, S.mc.nodes)
    w = telegraph(rng, S, S.recs, rng.uniform(6, 25) * 60, rng.uniform(15, 60) * 60)
    return dict(what="draughts by chance, for minutes, let %s exchange {a:.3g} W/K more with the air" % n, grid=(0.05 * gscale(S, n), 2 * gscale(S, n)),
                heat=exch(S, n, AMB, lambda c, d, m: w[c.rec["index"]][c.k]), statements=[st("exchange", [n, AMB], "chance")], records=list(range(len(S.recs))))


@kind("fouling over the records", True)
def _(rng, S):
    if len(S.recs) < 2:
        raise No
    l = pick(rng, S.mc.links)
    if l["turns"]:
        raise No
    before, total = {}, 0.0
    for r in S.recs:
        before[r["index"]] = total
        total += r["t"][-1]
    box = {}

    def pm(M, a):
        box["G"] = l["G"] * M[:, l["p"]]
    i, j = S.mc.ix[l["a"]], None if l["b"] == AMB else S.mc.ix[l["b"]]

    def heat(c, q, a, m):
        w = box["G"] * np.expm1(-a * (before[c.rec["index"]] + c.t) / total)
        f = w * ((c.Ta if j is None else c.T[:, j]) - c.T[:, i])
        q[:, i] += f
        if j is not None:
            q[:, j] -= f
    return dict(what="the exchange between %s and %s falls steadily over all records, by the factor exp(-{a:.3g}) to the end" % (l["a"], l["b"]), grid=(0.15, 3), heat=heat, pm=pm,
                statements=[st("exchange", [l["a"], l["b"]], "time over all records")], records=list(range(len(S.recs))))


@kind("relaxing joint", True)
def _(rng, S):
    running(S)
    j = dsp(rng, S)
    s = 1 if rng.random() < 0.5 else -1
    shape = {}
    for r in S.recs:
        on, since, level, o = r["drive"]["speed_rpm"] > 0, 0.0, 0.0, np.zeros(r["R"])
        for k in range(1, r["R"]):
            if on[k] != on[k - 1]:
                level, since = o[k - 1], 0.0
            since += r["dt"]
            g = min(1.0, math.log1p(since / 120.0) / math.log1p(120.0))
            o[k] = level + ((1.0 if on[k] else 0.0) - level) * g
        shape[r["index"]] = o
    return dict(what="a joint lets %s creep by {a:.3g} um with the logarithm of the time since the spindle last started or stopped" % S.ch[j], sign=s, grid=(0.3, 60),
                read=reader(j, lambda y, x, a: y + s * a * shape[x.rec["index"]][:, None]), statements=[st("displacement", S.ch[j], "logarithm of the time since the last start or stop")],
                records=list(range(len(S.recs))))


@kind("one-way circulation", True)
def _(rng, S):
    a_, b_ = pair(rng, S, False)
    i, j = S.mc.ix[a_], S.mc.ix[b_]
    d = np.concatenate([T[:, i] - T[:, j] for T in S.T])
    if np.mean(d > 0.3) < 0.2 or np.mean(d < -0.3) < 0.15:
        raise No
    return dict(what="a thermosiphon carries heat from %s to %s alone, {a:.3g} W/K, and none back" % (a_, b_), grid=(0.05 * gscale(S, a_, b_), 2 * gscale(S, a_, b_)),
                heat=exch(S, a_, b_, lambda c, dd, m: dd > 0), statements=[st("exchange", [a_, b_], "difference, one way alone")], records=list(range(len(S.recs))))


# -------------------------------------------------------------------------------------------------------------------- cases
class State:
    pass


def noise_sigma(S):
    return np.array([math.hypot(n, q / math.sqrt(12)) for n, q in zip(S.noise, S.res)])


def new_case(rng, family):
    S = State()
    S.mc = mc = Machine(family)
    S.ch = mc.channels
    n = int(rng.choice([1, 2, 3, 4], p=[0.3, 0.35, 0.25, 0.1]))
    S.recs = [make_record(mc, rng, r) for r in range(n)]
    S.M = np.exp(mc.sigma * rng.normal(size=len(mc.sigma)))[None, :]
    S.offset = rng.normal(0, 0.3, n)
    f = mc.f
    tn, tr = rng.uniform(*f.get("tnoise", (0.03, 0.1))), float(rng.choice(f.get("tres", (0.01, 0.1))))
    dn, dr = rng.uniform(*f.get("dnoise", (0.3, 0.8))), float(rng.choice([0.01, 0.1]))
    S.noise = [tn] * mc.ns + [dn] * len(mc.disp)
    S.res = [tr] * mc.ns + [dr] * len(mc.disp)
    S.sigma = noise_sigma(S)
    S.amb_noise, S.amb_res = rng.uniform(0.02, 0.06), float(rng.choice([0.01, 0.1]))
    S.Y, S.T = [], []
    for r, o in zip(S.recs, S.offset):
        Y, T = simulate(mc, r, S.M, o)
        S.Y.append(Y[:, 0])
        S.T.append(T[:, 0, :])
    S.plaw = lambda k: np.concatenate([mc.law(mc.heats[k], r, S.M, r["drive"]["speed_rpm"][:, None])[:, 0] for r in S.recs])
    S.J = None
    return S


def sensitivities(S):
    """Whitened change of all readings for one prior sigma of each scattered number and of each record's ambient offset."""
    if S.J is not None:
        return S.J
    mc, n = S.mc, len(S.mc.sigma)
    M = np.repeat(S.M, n + 2, 0)
    M[np.arange(1, n + 1), np.arange(n)] *= math.exp(0.02)
    blocks_ = []
    for r, o in zip(S.recs, S.offset):
        off = np.full(n + 2, o)
        off[n + 1] += 0.3
        Y, _ = simulate(mc, r, M, off)
        D = (Y[:, 1:] - Y[:, :1]) / S.sigma
        J = np.zeros((D.shape[0] * D.shape[2], n + len(S.recs)))
        J[:, :n] = D[:, :n].transpose(0, 2, 1).reshape(-1, n) * (mc.sigma / 0.02)
        J[:, n + r["index"]] = D[:, n].reshape(-1)
        blocks_.append(J)
    S.J = np.concatenate(blocks_)
    return S.J


def remainder(S, d, others=()):
    J = sensitivities(S)
    if others:
        J = np.concatenate([J] + [o[:, None] * (100.0 / (np.linalg.norm(o) + 1e-12)) for o in others], 1)
    H = cho_factor(J.T @ J + np.eye(J.shape[1]))
    return 0.5 * float(d @ (d - J @ cho_solve(H, J.T @ d)))    # rest and what the numbers' priors charge for the fit


def alternatives(S):
    """Simple descriptions with their whitened change of all readings: heats and exchanges at every place, numbers, errors of channels."""
    if getattr(S, "alts", None) is not None:
        return S.alts
    mc, J, out = S.mc, sensitivities(S), []
    for p, n in zip(mc.c_par, mc.nodes):
        out.append((st("capacity", n, "constant"), J[:, p]))
    for l in mc.links:
        out.append((st("exchange", [l["a"], l["b"]], "running" if l["turns"] else "constant"), J[:, l["p"]]))
    for h in mc.heats:
        for k, p in h["p"].items():
            if k in ("power", "share", "gain"):
                out.append((st("heat", h["node"], law_word(h)), J[:, p]))
    for d, w in mc.disp:
        for n, _, p in w:
            out.append((st("expansion", n, "constant"), J[:, p]))
    out.append((st("ambient", "hall", "constant"), J[:, len(mc.sigma):].sum(1)))
    every, stops = list(range(len(S.recs))), any((r["drive"]["speed_rpm"] > 0).any() and (r["drive"]["speed_rpm"] == 0).any() for r in S.recs)
    N, todo = len(mc.nodes), []
    for i, n in enumerate(mc.nodes):
        todo.append((st("heat", n, "constant"), "Hc", i, None, 0.1 * scale_w(S, n)))
        if stops:
            todo.append((st("heat", n, "running"), "Hr", i, None, 0.1 * scale_w(S, n)))
    ends = mc.nodes + [AMB]
    for x, a in enumerate(mc.nodes):
        for y in range(x + 1, N + 1):
            todo.append((st("exchange", [a, ends[y]], "constant"), "X", x, y, 0.02 * gscale(S, a, ends[y])))
    B = len(todo) + 1
    Hc, Hr, X, xa = np.zeros((B, N)), np.zeros((B, N)), np.zeros((B, N, N)), np.zeros((B, N))
    for k, (_, way, i, j, g) in enumerate(todo, 1):
        if way == "X":
            X[k, i, i] += g
            if j == N:
                xa[k, i] += g
            else:
                X[k, j, j] += g
                X[k, i, j] -= g
                X[k, j, i] -= g
        else:
            (Hc if way == "Hc" else Hr)[k, i] = g

    def heat(c, q, a, m):
        q += Hc + Hr * (c.n > 0)[:, None] + xa * c.Ta[:, None] - np.matmul(X, c.T[:, :, None])[:, :, 0]
    f = dict(kind="all", heat=heat, records=every)
    Ys = change(S, [f], [np.arange(-1, len(todo)).astype(float)])
    for k, (s_, *_) in enumerate(todo):
        out.append((s_, np.concatenate([((Y[:, k + 1] - Y[:, 0]) / S.sigma).reshape(-1) for Y in Ys])))
    for j, ch in enumerate(S.ch):
        q = "reading" if j < mc.ns else "displacement"
        for word, shape in (("constant", lambda r: np.ones(r["R"])), ("since start", lambda r: r["t"] / 3600), ("running", lambda r: (r["drive"]["speed_rpm"] > 0).astype(float))):
            if word == "running" and not stops:
                continue
            col = []
            for r in S.recs:
                z = np.zeros((r["R"], len(S.ch)))
                z[:, j] = shape(r) / S.sigma[j]
                col.append(z.reshape(-1))
            out.append((st(q, ch, word), np.concatenate(col)))
    S.alts = out
    return out


def equals(S, f):
    """Those of the alternatives that leave nothing to find of a fault (less than 3 nats)."""
    mask = np.concatenate([np.full(r["R"] * len(S.ch), r["index"] in f["records"]) for r in S.recs])
    Jf = sensitivities(S)
    H = Jf.T @ Jf + np.eye(Jf.shape[1])
    cf = cho_factor(H)
    clean = lambda v: v - Jf @ cho_solve(cf, Jf.T @ v)
    d = f["d"]
    cd, found = clean(d), []
    for s_, v in alternatives(S):
        w = v * mask
        cw = clean(w)
        ww = float(w @ cw)
        if ww > 1e-9 and 0.5 * (float(d @ cd) - float(w @ cd) ** 2 / ww) < 3.0:
            found.append(s_)
    return found


def change(S, faults, amps):
    """Readings of each record for B amplitudes of faults."""
    B = len(amps[0])
    M = np.repeat(S.M, B, 0)
    return [simulate(S.mc, r, M, o, faults, amps)[0] for r, o in zip(S.recs, S.offset)]


def rms_of(S, f, D):
    """Largest over channels: rms over noise, over the records in which it acts."""
    x = np.concatenate([D[r] for r in f["records"]])
    return float((np.sqrt(np.mean(x ** 2, 0)) / S.sigma).max())


def try_fault(rng, S, name, outside):
    try:
        f = (OUTSIDE if outside else KINDS)[name](rng, S)
    except No:
        return None
    f["kind"], f["sayable"] = name, not outside
    levels = {x for r in S.recs for x in r["drive"]["speed_rpm"] if x > 0}
    twins = {"running": "power of speed", "power of speed": "running"} if len(levels) == 1 else {"running": "constant"} if S.mc.f.get("nostop") else {}
    f["statements"] += [dict(x, follows=twins[x["follows"]]) for x in f["statements"] if x["follows"] in twins]
    target = math.exp(rng.uniform(math.log(3.0), math.log(20.0)))
    sub = State()
    sub.__dict__.update(S.__dict__)
    sub.recs = [r for r in S.recs if r["index"] in f["records"]]
    sub.offset = S.offset[f["records"]]
    if "fixed" in f:
        a = f["fixed"]
    else:
        grid = np.exp(np.linspace(math.log(f["grid"][0]), math.log(f["grid"][1]), 9))
        with np.errstate(all="ignore"):
            Ys = change(sub, [f], [np.concatenate([[0], grid])])
        if f.get("factor") and "pm" in f and len(f["records"]) == len(S.recs):
            Ys = [Y[:, [0] + [b + 1 for b in range(9) if grid[b] >= 0.17 * (1 if name == "heat of another exponent" else 3.34)]] for Y in Ys]
            grid = grid[grid >= 0.17 * (1 if name == "heat of another exponent" else 3.34)]
        rms = np.array([(np.sqrt(np.mean(np.concatenate([Y[:, b + 1] - Y[:, 0] for Y in Ys]) ** 2, 0)) / S.sigma).max() for b in range(len(grid))])
        ok = np.isfinite(rms) & (rms > 1e-9)
        if ok.sum() < 2 or rms[ok].max() < 2.5 or rms[ok].min() > 25:
            return None
        g, y = grid[ok], np.maximum.accumulate(rms[ok]) * (1 + 1e-9 * np.arange(ok.sum()))
        target = min(max(target, y[0] * 1.02), y[-1] * 0.98)
        a = float(np.exp(np.interp(math.log(target), np.log(y), np.log(g))))
    if "steps" in f:
        a = max(1, round(a / f["steps"])) * f["steps"]
    a = float("%.4g" % a)
    f["a"] = a
    Ys = change(sub, [f], [np.array([0.0, a])])
    D = [np.zeros_like(Y) for Y in S.Y]
    for r, Y in zip(sub.recs, Ys):
        if not np.all(np.isfinite(Y)):
            return None
        D[r["index"]] = Y[:, 1] - Y[:, 0]
    f["rms"] = rms_of(S, f, D)
    if not 2.0 <= f["rms"] <= 30.0:
        return None
    # A number that is wrong in all records is absorbed by refitting it but for its prior: 16 nats are 5.66 sigmas of it.
    if f.get("factor") and "pm" in f and len(f["records"]) == len(S.recs) and a < 5.66 * (0.03 if name == "heat of another exponent" else 0.1):
        return None
    d = np.concatenate([(x / S.sigma).reshape(-1) for x in D])
    if remainder(S, d) < 16.0:
        return None
    f["d"] = d
    same = equals(S, f)
    if outside and same:                                       # then it is not outside
        return None
    for x in same:
        if not any((x["quantity"], x["follows"], sorted(x["place"])) == (y["quantity"], y["follows"], sorted(y["place"])) for y in f["statements"]):
            f["statements"].append(x)
            print("   also:", name, f["statements"][0]["place"], "=", x["quantity"], x["place"], x["follows"])
    return f


def describe(f):
    s = f.get("sign", 1)
    a = f["a"]
    amp = math.exp(s * a) if f.get("factor") else s * a
    text = f["what"].replace("{f:.3g}", "%.3g" % amp).replace("{a:.3g}", "%.3g" % (amp if f.get("sign") else a))
    return dict(what=text, kind=f["kind"], statements=f["statements"], records=[r + 1 for r in f["records"]], amplitude=float("%.4g" % amp),
                residual_sigmas=round(f["rms"], 2), sayable=f["sayable"])


def num(x):
    return "%.10g" % x


def scenario(mc, name, files):
    w = ["# %s: nominal numbers, as its maker wrote them" % mc.name.replace("_", " "), "name: " + name, "reference_temperature: %g degC" % mc.tref, "start: " + mc.start,
         "machine: {generator: lumped}", "ambient: {csv: %s, channel: ambient}" % files[0], "", "effects:"]
    for n, c in mc.f["nodes"].items():
        w.append("  - {type: node, node: %s, capacity: %s kJ/K}" % (n, num(c / 1e3)))
    for l in mc.links:
        w.append("  - {type: link, node: %s, to: %s, conductance: %s W/K%s}" % (l["a"], l["b"], num(l["G"]), ", runs: while_spindle_turns" if l["turns"] else ""))
    for h in mc.heats:
        item = ["type: " + h["kind"], "node: " + h["node"]]
        for k, v in h["num"].items():
            item.append("%s: %s" % (k, v if isinstance(v, str) else num(v) + (" " + UNITS[k] if k in UNITS else "")))
        w.append("  - {%s}" % ", ".join(item))
    for c in mc.cool:
        w.append("  - {type: coolant, node: %s, flow: %s L/min, passage_conductance: %s W/K, set_point: %s degC, runs: %s}" % (c["node"], num(c["flow"]), num(c["ua"]), num(c["set_point"]), c["runs"]))
    w.append("")
    if mc.sens:
        w += ["sensors:"] + ["  - {name: %s, node: %s}" % s for s in mc.sens] + [""]
    if mc.disp:
        w.append("displacements:")
        for d, ws in mc.disp:
            w.append("  - name: %s" % d)
            w.append("    sensitivities: [%s]" % ", ".join("{node: %s, sensitivity: %s um/K}" % (n, num(s)) for n, s, _ in ws))
        w.append("")
    w.append("cyclograms:")
    w += ["  rec_%d: {csv: %s}" % (k + 1, x) for k, x in enumerate(files)]
    w += ["", "solver: {output_interval: %g s}" % mc.f["dt"], ""]
    return "\n".join(w)


def rounded(x, step):
    dec = max(0, int(round(-math.log10(step) + 0.49))) if step < 1 else 0
    return np.round(np.round(x / step) * step, dec), dec


def write_record(path, mc, rec, amb, amb_dec, Y, decs, gaps=None):
    cols = ["time_s"] + list(rec["drive"]) + ["ambient_degC"] + [s + "_degC" for s, _ in mc.sens] + [d + "_um" for d, _ in mc.disp]
    with open(path, "w", newline="\n") as o:
        o.write(",".join(cols) + "\n")
        for k in range(rec["R"]):
            row = ["%g" % rec["t"][k]] + ["%.10g" % rec["drive"][c][k] for c in rec["drive"]] + ["%.*f" % (amb_dec, amb[k])]
            row += ["" if gaps is not None and gaps[k, j] else "%.*f" % (decs[j], Y[k, j]) for j in range(Y.shape[1])]
            o.write(",".join(row) + "\n")


def write_case(folder, number, cls, rng, S, faults):
    os.makedirs(folder)
    mc = S.mc
    amps = [np.array([f["a"]]) for f in faults]
    Ys = change(S, faults, amps) if faults else [Y[:, None] for Y in S.Y]
    files = ["measured_%d.csv" % (r + 1) for r in range(len(S.recs))]
    holes = rng.random() < 0.15
    for r, name in zip(S.recs, files):
        Y = Ys[r["index"]][:, 0] + rng.normal(size=(r["R"], len(S.ch))) * S.noise
        decs = [0] * len(S.ch)
        for j in range(len(S.ch)):
            Y[:, j], decs[j] = rounded(Y[:, j], S.res[j])
        amb, dec = rounded(r["amb"] + rng.normal(0, S.amb_noise, r["R"]), S.amb_res)
        gaps = rng.random(Y.shape) < 0.004 if holes else None
        if gaps is not None:
            gaps[0] = gaps[-1] = False
        write_record(os.path.join(folder, name), mc, r, amb, dec, Y, decs, gaps)
    with open(os.path.join(folder, "scenario.yaml"), "w", newline="\n") as o:
        o.write(scenario(mc, os.path.basename(folder), files))
    effects = [describe(f) for f in faults]
    truth = {"case": number, "class": cls, "family": mc.name, "sayable": all(e["sayable"] for e in effects), "start": mc.start, "effects": effects}
    with open(os.path.join(folder, "truth.json"), "w", newline="\n") as o:
        o.write(json.dumps(truth, indent=1) + "\n")


class Deck:
    """Kinds in random order, each before any comes again."""

    def __init__(self, rng, names):
        self.rng, self.names, self.left = rng, list(names), []

    def draw(self, fits, avoid=()):
        for _ in range(2):
            for k, n in enumerate(self.left):
                if n not in avoid and fits(n):
                    return self.left.pop(k)
            fresh = list(self.names)
            self.rng.shuffle(fresh)
            self.left += fresh
        return None


def find_fault(rng, S, deck, outside, avoid, log):
    tried = set(avoid)
    while True:
        name = deck.draw(lambda n: True, tried)
        if name is None:
            return None
        for _ in range(6):
            f = try_fault(rng, S, name, outside)
            if f is not None:
                return f
        tried.add(name)
        deck.left.insert(int(rng.integers(len(deck.left) + 1)), name)


def generate(folder):
    if os.path.exists(folder):
        shutil.rmtree(folder)
    os.makedirs(folder)
    rng = np.random.default_rng(SEED)
    inside, outside = Deck(rng, sorted(KINDS)), Deck(rng, sorted(OUTSIDE))
    classes = [c for c, n in COUNTS.items() for _ in range(n)]
    rng.shuffle(classes)
    fams, nfault = [], 0
    for number, cls in enumerate(classes, 1):
        done = False
        while not done:
            if not fams:
                fams = sorted(FAMILIES)
                rng.shuffle(fams)
            S = new_case(rng, fams.pop())
            faults = []
            for k in range({"A": 1, "B": 0, "D": 2}[cls]):
                out = (nfault + k) % 3 == 2
                for _ in range(4):
                    f = find_fault(rng, S, outside if out else inside, out, [g["kind"] for g in faults], None)
                    if f is None:
                        break
                    if not faults:
                        break
                    g = faults[0]
                    same = {tuple(s["place"]) for s in f["statements"]} & {tuple(s["place"]) for s in g["statements"]}
                    if not same and "speed" not in f and "extra" not in f and remainder(S, f["d"], [g["d"]]) >= 16 and remainder(S, g["d"], [f["d"]]) >= 16:
                        break
                    f = None
                if f is None:
                    break
                faults.append(f)
            done = len(faults) == {"A": 1, "B": 0, "D": 2}[cls]
        nfault += len(faults)
        write_case(os.path.join(folder, "case_%04d" % number), number, cls, rng, S, faults)
        print(number, cls, S.mc.name, [(f["kind"], round(f["rms"], 1)) for f in faults], flush=True)


def check(dw):
    tmp = tempfile.mkdtemp(prefix="visitor_check_")
    for family in sorted(FAMILIES):
        rng = np.random.default_rng(zlib.crc32(family.encode()))
        mc = Machine(family)
        rec = make_record(mc, rng, 0)
        Y = simulate(mc, rec, np.ones((1, len(mc.sigma))))[0][:, 0]
        fine = simulate(mc, rec, np.ones((1, len(mc.sigma))), fine=4)[0][:, 0]
        d = os.path.join(tmp, family)
        os.makedirs(d)
        write_record(os.path.join(d, "measured_1.csv"), mc, rec, rec["amb"], 9, Y, [9] * len(mc.channels))
        text = scenario(mc, family, ["measured_1.csv"]).replace("solver: {", "solver: {relative_tolerance: 1e-6, absolute_tolerance: 1e-5 K, ")
        open(os.path.join(d, "scenario.yaml"), "w").write(text)
        p = subprocess.run([dw, "simulate", "scenario.yaml", "-o", "out", "--force", "--quiet", "--threads", "1"], cwd=d, capture_output=True, text=True)
        if p.returncode:
            print(family, "FAILED:", p.stderr[-500:], p.stdout[-300:])
            continue
        rows = list(csv.reader(l for l in open(os.path.join(d, "out", "record.csv")) if not l.startswith("#")))
        head, X = rows[0], np.array([[float(v) for v in r] for r in rows[1:]])
        eT = eU = 0.0
        for j, c in enumerate(mc.channels):
            col = head.index(c + ("_degC" if j < mc.ns else "_um"))
            e = np.abs(np.interp(rec["t"], X[:, 0], X[:, col]) - Y[:, j]).max()
            eT, eU = (max(eT, e), eU) if j < mc.ns else (eT, max(eU, e))
        print("%-30s worst %.4f K %.4f um; step halved twice %.1e; range %s  %s" % (family, eT, eU, np.abs(fine - Y).max(), " ".join("%.0f..%.0f" % (a, b) for a, b in zip(Y.min(0), Y.max(0))),
              "ok" if eT < 0.05 and eU < 0.3 else "DISAGREES"))
    shutil.rmtree(tmp)


if __name__ == "__main__":
    if "--check" in sys.argv:
        i = sys.argv.index("--check")
        check(sys.argv[i + 1] if len(sys.argv) > i + 1 else "driftwright")
    else:
        generate(sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "visitor"))
