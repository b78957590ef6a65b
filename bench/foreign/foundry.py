#!/usr/bin/env python3
"""Blind cases `foundry`: meshed machines. Writes OUT/case_NNNN/{scenario.yaml, measured_n.csv, truth.json[, machine.inp]}.
usage: foundry.py [--out foundry] [--check] [--only N]
Driftwright (DW) meshes the machine and writes its reduced model (matrices); the truth is integrated here from these matrices with the scattered
numbers and with the fault, which may look at temperatures, times and its own memory. Needs numpy and scipy; one core."""
import os, re, sys, json, math, shutil, subprocess, argparse, tempfile
for k in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"): os.environ[k] = "1"
import numpy as np
import laws
from machines import rounded
DW = os.environ.get("DW", "driftwright")
SEED = 71923
COUNTS = {"A": 32, "B": 18, "D": 12}
CACHE = os.environ.setdefault("XDG_CACHE_HOME", os.path.join(tempfile.gettempdir(), "foundry_cache"))
TREF = 20.0
MAT = {  # density, heat capacity, conductivity, expansion [um/(m K)], E [GPa], Poisson: Driftwright's library, `list materials`
 "cast_iron_gjl250": (7200, 460, 48.5, 11, 110, .26), "cast_iron_gjs400": (7100, 515, 36.2, 12.5, 169, .28), "steel_c45": (7850, 470, 45, 11.5, 210, .30),
 "steel_42crmo4": (7840, 470, 42.6, 11.5, 210, .30), "bearing_steel": (7810, 470, 42, 11.9, 208, .30), "motor_mean": (5200, 460, 20, 13, 60, .30),
 "mineral_casting": (2400, 1000, 2, 15, 40, .25), "aluminium_6082": (2700, 896, 172, 23.4, 70, .33), "granite": (2900, 840, 3, 6.5, 70, .25),
 "steel_16mncr5": (7850, 460, 44, 11.5, 210, .30)}
W, WK, F = "W", "W/K", "W/(m^2 K)"
SOURCES = ("bearing_friction", "motor_loss", "servo_loss", "ball_screw", "guideway_friction", "cutting_heat", "heat_source")
EXCHANGES = ("convection", "forced_convection", "contact", "link", "air_node")
SCATTER = {"power": .1, "idle": .1, "film": .1, "growth": .1, "conductance": .1, "exchange": .1, "capacity": .1, "torque": .1, "friction": .1, "share": .1, "f0": .1, "load": .1, "exponent": .03}

def E(type, **k): return dict(type=type, **k)
def num(v):
    return ("%.4g %s" % v) if isinstance(v, tuple) else ("%.5g" % v if isinstance(v, float) else str(v))
def flow(d): return "{" + ", ".join("%s: %s" % (k, num(v)) for k, v in d.items()) + "}"

# ------------------------------------------------------------------------------------------------------------------ families
def box_mesh(boxes):
    """C3D8 boxes -> text of an .inp in mm; boxes: name -> ((x0,x1),(y0,y1),(z0,z1),(nx,ny,nz))"""
    out, els, n, e = ["*NODE"], [], 0, 0
    for name, (X, Y, Z, (nx, ny, nz)) in boxes.items():
        xs, ys, zs = (np.linspace(a, b, m + 1) for (a, b), m in ((X, nx), (Y, ny), (Z, nz)))
        idx = {}
        for k in range(nz + 1):
            for j in range(ny + 1):
                for i in range(nx + 1):
                    n += 1; idx[i, j, k] = n
                    out.append("%d, %.6g, %.6g, %.6g" % (n, xs[i], ys[j], zs[k]))
        els.append("*ELEMENT, TYPE=C3D8, ELSET=%s" % name)
        for k in range(nz):
            for j in range(ny):
                for i in range(nx):
                    e += 1
                    q = [idx[i + a, j + b, k + c] for a, b, c in ((0,0,0),(1,0,0),(1,1,0),(0,1,0),(0,0,1),(1,0,1),(1,1,1),(0,1,1))]
                    els.append(", ".join(map(str, [e] + q)))
    return "\n".join(out + els) + "\n"

def plane(name, region, p, nrm):
    return "    - {name: %s, region: %s, plane: {through: [%g mm, %g mm, %g mm], normal: [%g, %g, %g]}}" % ((name, region) + tuple(p) + tuple(nrm))
def rest(name, region): return "    - {name: %s, region: %s, remaining: true}" % (name, region)
def films(**of): return [E("convection", surface=k, film=(float(x), F)) for k, x in of.items()]
def contacts(of): return [E("contact", joint=k, conductance=(float(x), F)) for k, x in of.items()]
def thermometers(**at):
    """name: (region, x, y, z) or (node,)"""
    return dict(sensors={k: "  - {name: %s, region: %s, at: [%g mm, %g mm, %g mm]}" % (k, *x) if x[1:] else "  - {name: %s, node: %s}" % (k, *x) for k, x in at.items()}, sensor_body={k: x[0] for k, x in at.items()})
def drawn(**of):
    """name: (direction, region, place[, region, place])"""
    at = lambda what, r, p: "%s: {region: %s, at: [%g mm, %g mm, %g mm]}" % (what, r, *p)
    return {k: "  - {name: %s, along: %s, %s}" % (k, x[0], ", ".join([at("tool", *x[1:3])] + ([at("table", *x[3:])] if x[3:] else []))) for k, x in of.items()}

def families():
    """A table, one machine after the other."""
    fam = {}
    # 1: toolroom mill, horizontal spindle, the generator's knee mill; idle runs
    fam["toolroom_mill"] = dict(inp=None, cad=dict(top=2500, feeds=(), cut=0),
        machine="""  generator: knee_mill
  element_order: 1
  mesh_size: {frame: 200 mm, spindle: 60 mm}
  column: {width: 480 mm, depth: 560 mm, height: 1150 mm, wall: 30 mm}
  headstock: {width: 340 mm, depth: 780 mm, height: 340 mm, wall: 30 mm, overhang: 240 mm, axis_height: 170 mm, barrel_diameter: 190 mm}
  quill: {diameter: 125 mm, bore: 95 mm, length: 480 mm, stick_out: 80 mm}
  spindle: {diameter: 60 mm, stick_out: 30 mm}
  bearings: {front: {width: 36 mm, setback: 10 mm}, rear: {width: 18 mm, setback: 20 mm}}
  motor: {diameter: 220 mm, length: 240 mm}
  knee: {width: 300 mm, depth: 400 mm, height: 240 mm, bottom: 520 mm}
  table: {width: 800 mm, depth: 380 mm, thickness: 80 mm, gap: 40 mm}
""", materials=dict(column="cast_iron_gjl250", headstock="cast_iron_gjl250", quill="steel_c45", spindle="steel_c45", bearing_front="bearing_steel", bearing_rear="bearing_steel", motor="motor_mean", knee="cast_iron_gjl250", table="cast_iron_gjl250"),
        supports="  - {surface: foot, fixed: [x, y, z]}\n", joints="",
        effects=[E("heat_source", region="bearing_front", power=(28., W), at_speed=(2000., "rpm"), exponent=1.4), E("heat_source", region="bearing_rear", power=(11., W), at_speed=(2000., "rpm"), exponent=1.4),
            E("heat_source", region="headstock", power=(90., W), at_speed=(2000., "rpm"), exponent=1.3), E("motor_loss", region="motor", power=(70., W), at_speed=(2000., "rpm"), exponent=1.2, idle=(25., W)),
            *films(column_outer=9, column_inner=3, headstock_outer=9, headstock_inner=2, motor_outer=10), E("forced_convection", surface="motor_outer", growth=(20., F), at_speed=(2000., "rpm"), exponent=0.7),
            *films(knee_outer=9, table_outer=9), E("convection", surface="quill_outer", film=(9., F), surrounding="air_nose"), E("convection", surface="spindle_nose", film=(18., F), surrounding="air_nose"),
            E("air_node", node="air_nose", capacity=(60., "J/K"), exchange=(1.5, WK)),
            *contacts({"column/headstock": 1500, "column/knee": 1500, "knee/table": 1200, "headstock/motor": 800, "headstock/quill": 900, "bearing_front/quill": 2500, "bearing_front/spindle": 2500, "bearing_rear/quill": 2500, "bearing_rear/spindle": 2500})],
        **thermometers(t_head_front=("headstock", 170, 180, 1320), t_head_back=("headstock", 170, -350, 1320), t_roof=("headstock", 0, -80, 1490), t_motor=("motor", 0, -660, 1430), t_quill=("quill", 0, 285, 1382.5), t_column=("column", 0, 0, 1000), t_column_side=("column", 240, -280, 600), t_table=("table", 120, 320, 840), t_air=("air_nose",)),
        displacements=drawn(drift_y=("y", "quill", (55, 320, 1320), "table", (120, 320, 840)), drift_z=("z", "quill", (0, 305, 1382.5), "table", (120, 320, 840)), drift_x=("x", "quill", (62.5, 305, 1320), "table", (120, 320, 840))),
        regions=["column", "headstock", "quill", "motor", "table", "knee"], dummies=["headstock", "quill", "column", "motor", "table"])
    # 2: small bench mill with a milling programme: feeds along x, cutting power
    fam["bench_mill"] = dict(inp=None, cad=dict(top=6000, feeds=("x", "y"), cut=500),
        machine="""  generator: knee_mill
  element_order: 1
  mesh_size: {frame: 140 mm, spindle: 50 mm}
  column: {width: 300 mm, depth: 340 mm, height: 800 mm, wall: 25 mm}
  headstock: {width: 240 mm, depth: 500 mm, height: 240 mm, wall: 25 mm, overhang: 180 mm, axis_height: 120 mm, barrel_diameter: 140 mm}
  quill: {diameter: 90 mm, bore: 68 mm, length: 320 mm, stick_out: 50 mm}
  spindle: {diameter: 42 mm, stick_out: 25 mm}
  bearings: {front: {width: 28 mm, setback: 10 mm}, rear: {width: 16 mm, setback: 15 mm}}
  motor: {diameter: 160 mm, length: 180 mm}
  knee: {width: 220 mm, depth: 300 mm, height: 180 mm, bottom: 330 mm}
  table: {width: 550 mm, depth: 260 mm, thickness: 60 mm, gap: 30 mm}
""", materials=dict(column="cast_iron_gjs400", headstock="cast_iron_gjl250", quill="steel_16mncr5", spindle="steel_42crmo4", bearing_front="bearing_steel", bearing_rear="bearing_steel", motor="motor_mean", knee="cast_iron_gjl250", table="cast_iron_gjs400"),
        supports="  - {surface: foot, springs: [2e8 N/m, 2e8 N/m, 6e8 N/m]}\n", joints="",
        effects=[E("bearing_friction", region="bearing_front", count=2, f0=0.6, viscosity="15 mm^2/s", mean_diameter="55 mm", f1="0.0009", load=(300., "N")),
            E("heat_source", region="bearing_rear", power=(9., W), at_speed=(4000., "rpm"), exponent=1.4), E("motor_loss", region="motor", power=(85., W), at_speed=(4000., "rpm"), exponent=1.3, idle=(15., W)),
            E("heat_source", region="headstock", power=(35., W), at_speed=(4000., "rpm"), exponent=1.2), E("servo_loss", region="knee", axis="x", power=(45., W), at_feed=(4., "m/min"), exponent=1.0, idle=(6., W)),
            E("guideway_friction", region="table", axis="y", friction=0.08, load="1800 N", share=0.5), E("cutting_heat", region="table", share=0.12), *films(column_outer=10, column_inner=3, headstock_outer=10, motor_outer=8),
            E("forced_convection", surface="motor_outer", growth=(25., F), at_speed=(4000., "rpm"), exponent=0.7), *films(knee_outer=9, table_outer=12, quill_outer=12, spindle_nose=20),
            *contacts({"column/headstock": 1800, "column/knee": 900, "knee/table": 700, "headstock/motor": 500, "headstock/quill": 900, "bearing_front/quill": 2500, "bearing_front/spindle": 2500, "bearing_rear/quill": 2500, "bearing_rear/spindle": 2500})],
        **thermometers(head_side=("headstock", 120, 100, 920), head_top=("headstock", 0, -60, 1040), motor=("motor", 0, -410, 1000), quill=("quill", 0, 205, 965), column=("column", 0, 0, 700), knee=("knee", 110, 150, 420), table=("table", 275, 150, 540)),
        displacements=drawn(err_y=("y", "quill", (38, 230, 920), "table", (100, 220, 570)), err_z=("z", "quill", (0, 215, 965), "table", (100, 220, 570))),
        regions=["column", "headstock", "quill", "motor", "table", "knee"], dummies=["headstock", "quill", "column", "knee", "table"])
    # 3: table of a gantry mill with a workpiece: feeds, hydraulics, a foundation as a lumped node
    fam["gantry"] = dict(inp=None, cad=dict(top=8000, feeds=("x",), cut=900),
        machine="""  generator: gantry_table
  element_order: 1
  table: {length: 2.4 m, width: 0.9 m, height: 160 mm}
  bed: {length: 4 m, width: 0.8 m, height: 300 mm}
  guideways: {width: 120 mm, height: 60 mm, gauge: 560 mm}
  workpiece: {length: 600 mm, width: 400 mm, height: 200 mm, at: [400 mm, 0 mm, 0 mm]}
  mesh_size: 200 mm
""", materials=dict(table="cast_iron_gjl250", bed="cast_iron_gjs400", workpiece="aluminium_6082"),
        supports="  - {surface: bed_underside, fixed: [z]}\n  - {surface: bed_underside, springs: [1e8 N/m, 1e8 N/m, 0 N/m]}\n  - {surface: table_underside, springs: [1e7 N/m, 1e7 N/m, 0 N/m]}\n",
        joints="joints:\n  - {name: table/workpiece, normal_stiffness: 1e9 N/m, tangential_stiffness: 1e7 N/m}\n  - {name: bed/table, normal_stiffness: 1e10 N/m, tangential_stiffness: 1e6 N/m}\n",
        effects=[E("ball_screw", region="table", axis="x", torque=(4., "N m"), lead="20 mm", share=0.5), E("guideway_friction", region="table", axis="x", friction=0.07, load="12 kN", share=0.5),
            E("guideway_friction", region="bed", axis="x", friction=0.07, load="12 kN", share=0.5), E("cutting_heat", region="workpiece", share=0.15), E("heat_source", surface="table_high_x", power=(160., W)),
            E("servo_loss", region="bed", axis="x", power=(120., W), at_feed=(6., "m/min"), exponent=1.2, idle=(20., W)), E("heat_source", node="motor", power=(220., W), at_speed=(6000., "rpm"), exponent=1.3),
            E("link", node="motor", to="ambient", conductance=(9., WK)), E("node", node="motor", capacity=(14000., "J/K")), *films(table_top=9, table_low_x=8, table_high_x=8, table_low_y=8, table_high_y=8),
            E("convection", surface="table_underside", film=(7., F), surrounding="air_below"), E("convection", surface="bed_top", film=(4., F), surrounding="air_below"), *films(workpiece_outer=10, bed_sides=7),
            E("air_node", node="air_below", capacity=(3000., "J/K"), exchange=(30., WK)), E("node", node="foundation", capacity=(8e6, "J/K")), E("link", surface="bed_underside", to="foundation", conductance=(60., WK)),
            E("link", node="foundation", to="ambient", conductance=(30., WK)), *contacts({"bed/table": 150, "table/workpiece": 350})],
        **thermometers(table_mid=("table", 0, 0, 0), table_low=("table", -1100, 0, 0), table_high=("table", 1150, 0, 0), work=("workpiece", 400, 0, 200), bed_1=("bed", -1400, 0, -520), bed_2=("bed", 1400, 0, -520), below=("air_below",), motor=("motor",), foundation=("foundation",)),
        displacements=drawn(grow_x=("x", "table", (1200, 0, 0), "table", (-1200, 0, 0)), work_x=("x", "workpiece", (700, 0, 200), "bed", (0, 0, -300 - 220)), sag_z=("z", "table", (0, 0, 0), "table", (1200, 0, 0))),
        regions=["table", "bed", "workpiece"], dummies=["table", "bed", "workpiece"])
    # 4: lathe of boxes, mesh written here
    lb = {"bed": ((0, 1600), (0, 350), (0, 300), (12, 4, 3)), "headstock": ((0, 400), (20, 330), (300, 460), (5, 4, 2)), "spindle": ((-60, 520), (130, 220), (460, 550), (10, 2, 2)), "cap": ((0, 400), (80, 270), (550, 620), (5, 3, 1)),
          "carriage": ((800, 1050), (10, 340), (300, 420), (3, 4, 2)), "tailstock": ((1300, 1500), (60, 290), (300, 560), (2, 3, 3))}
    fam["lathe"] = dict(inp=lb, cad=dict(top=3200, feeds=("x",), cut=1500),
        machine="  mesh: machine.inp\n  units: mm\n  surfaces:\n" + "\n".join([plane("bed_foot", "bed", (0, 0, 0), (0, 0, -1)), plane("bed_ways", "bed", (0, 0, 300), (0, 0, 1)), plane("head_foot", "headstock", (0, 20, 300), (0, 0, -1)), plane("head_saddle", "headstock", (0, 20, 460), (0, 0, 1)),
            plane("spindle_under", "spindle", (0, 130, 460), (0, 0, -1)), plane("spindle_over", "spindle", (0, 130, 550), (0, 0, 1)), plane("cap_under", "cap", (0, 80, 550), (0, 0, -1)), plane("carriage_under", "carriage", (800, 10, 300), (0, 0, -1)), plane("tail_under", "tailstock", (1300, 60, 300), (0, 0, -1)), plane("nose", "spindle", (520, 130, 460), (1, 0, 0)),
            rest("bed_outer", "bed"), rest("head_outer", "headstock"), rest("spindle_outer", "spindle"), rest("cap_outer", "cap"), rest("carriage_outer", "carriage"), rest("tail_outer", "tailstock")]) +
            "\n  joints:\n    - {name: bed/headstock, a: bed_ways, b: head_foot}\n    - {name: headstock/spindle, a: head_saddle, b: spindle_under}\n    - {name: cap/spindle, a: cap_under, b: spindle_over}\n    - {name: bed/carriage, a: bed_ways, b: carriage_under}\n    - {name: bed/tailstock, a: bed_ways, b: tail_under}\n",
        materials=dict(bed="cast_iron_gjl250", headstock="cast_iron_gjl250", spindle="steel_42crmo4", cap="cast_iron_gjs400", carriage="cast_iron_gjs400", tailstock="cast_iron_gjl250"),
        supports="  - {surface: bed_foot, fixed: [x, y, z]}\n", joints="",
        effects=[E("heat_source", surface="spindle_under", power=(110., W), at_speed=(2000., "rpm"), exponent=1.5), E("heat_source", region="headstock", power=(120., W), at_speed=(2000., "rpm"), exponent=1.2),
            E("motor_loss", node="motor", power=(260., W), at_speed=(2000., "rpm"), exponent=1.2, idle=(40., W)), E("node", node="motor", capacity=(11000., "J/K")), E("link", node="motor", to="ambient", conductance=(11., WK)),
            E("link", surface="head_outer", to="motor", conductance=(5., WK)), E("ball_screw", region="bed", axis="x", torque=(2., "N m"), lead="10 mm", share=0.5),
            E("guideway_friction", region="carriage", axis="x", friction=0.08, load="4000 N", share=0.6), E("cutting_heat", region="carriage", share=0.06), E("cutting_heat", surface="nose", share=0.04),
            *films(bed_outer=9, bed_ways=6, head_outer=10, spindle_outer=10), E("forced_convection", surface="nose", growth=(45., F), at_speed=(2000., "rpm"), exponent=0.7), *films(cap_outer=9, carriage_outer=10, tail_outer=9),
            *contacts({"bed/headstock": 1200, "headstock/spindle": 900, "cap/spindle": 700, "bed/carriage": 500, "bed/tailstock": 900})],
        **thermometers(th_front=("headstock", 400, 60, 400), th_rear=("headstock", 0, 60, 400), th_cap=("cap", 200, 175, 620), th_nose=("spindle", 500, 175, 550), th_bed_left=("bed", 200, 0, 220), th_bed_right=("bed", 1200, 0, 220), th_carriage=("carriage", 900, 175, 420), th_tail=("tailstock", 1400, 175, 560), th_motor=("motor",)),
        displacements=drawn(ax_x=("x", "carriage", (800, 175, 420), "spindle", (520, 175, 505)), ax_z=("z", "carriage", (800, 175, 420), "spindle", (520, 175, 505)), tail_z=("z", "tailstock", (1300, 175, 505), "spindle", (520, 175, 505)), nose_z=("z", "spindle", (520, 175, 505))),
        regions=["bed", "headstock", "spindle", "cap", "carriage", "tailstock"], dummies=["headstock", "spindle", "carriage", "bed", "cap"])
    # 5: surface grinder of boxes with a guard and a coolant tank as lumped nodes
    gb = {"base": ((0, 1400), (0, 900), (0, 350), (8, 5, 2)), "post": ((500, 900), (550, 850), (350, 1250), (3, 2, 7)), "wheelhead": ((520, 880), (150, 550), (850, 1150), (3, 4, 3)), "table": ((200, 1200), (150, 450), (350, 430), (8, 3, 1)), "chuck": ((400, 1000), (180, 420), (430, 490), (5, 2, 1)), "drive": ((560, 840), (300, 500), (1150, 1300), (3, 2, 2))}
    fam["grinder"] = dict(inp=gb, cad=dict(top=3000, feeds=("x",), cut=700),
        machine="  mesh: machine.inp\n  units: mm\n  surfaces:\n" + "\n".join([plane("base_foot", "base", (0, 0, 0), (0, 0, -1)), plane("base_top", "base", (0, 0, 350), (0, 0, 1)), plane("post_foot", "post", (500, 550, 350), (0, 0, -1)), plane("post_front", "post", (500, 550, 350), (0, -1, 0)), plane("head_back", "wheelhead", (520, 550, 850), (0, 1, 0)), plane("head_top", "wheelhead", (520, 150, 1150), (0, 0, 1)),
            plane("head_front", "wheelhead", (520, 150, 850), (0, -1, 0)), plane("table_under", "table", (200, 150, 350), (0, 0, -1)), plane("table_top", "table", (200, 150, 430), (0, 0, 1)), plane("chuck_under", "chuck", (400, 180, 430), (0, 0, -1)), plane("chuck_top", "chuck", (400, 180, 490), (0, 0, 1)), plane("drive_under", "drive", (560, 300, 1150), (0, 0, -1)),
            rest("base_outer", "base"), rest("post_outer", "post"), rest("head_outer", "wheelhead"), rest("table_outer", "table"), rest("chuck_outer", "chuck"), rest("drive_outer", "drive")]) +
            "\n  joints:\n    - {name: base/post, a: base_top, b: post_foot}\n    - {name: post/wheelhead, a: post_front, b: head_back}\n    - {name: base/table, a: base_top, b: table_under}\n    - {name: chuck/table, a: chuck_under, b: table_top}\n    - {name: drive/wheelhead, a: drive_under, b: head_top}\n",
        materials=dict(base="granite", post="cast_iron_gjl250", wheelhead="cast_iron_gjl250", table="cast_iron_gjs400", chuck="steel_c45", drive="motor_mean"),
        supports="  - {surface: base_foot, springs: [5e8 N/m, 5e8 N/m, 1e9 N/m]}\n", joints="joints:\n  - {name: base/table, normal_stiffness: 2e9 N/m, tangential_stiffness: 2e8 N/m}\n",
        effects=[E("heat_source", surface="head_front", power=(130., W), at_speed=(2400., "rpm"), exponent=1.4), E("motor_loss", region="drive", power=(150., W), at_speed=(2400., "rpm"), exponent=1.3, idle=(30., W)),
            E("guideway_friction", region="table", axis="x", friction=0.06, load="2500 N", share=0.5), E("servo_loss", region="base", axis="x", power=(80., W), at_feed=(10., "m/min"), exponent=1.0, idle=(10., W)),
            E("cutting_heat", surface="chuck_top", share=0.2), E("cutting_heat", node="tank", share=0.4), E("node", node="tank", capacity=(250e3, "J/K")), E("heat_source", node="tank", power=(140., W)),
            E("link", node="tank", to="ambient", conductance=(14., WK)), E("link", surface="chuck_top", to="tank", conductance=(12., WK)), E("link", surface="base_outer", to="tank", conductance=(7., WK)),
            E("node", node="guard_air", capacity=(2400., "J/K")), E("link", node="guard_air", to="ambient", conductance=(11., WK)), E("convection", surface="chuck_outer", film=(9., F), surrounding="guard_air"),
            E("convection", surface="table_outer", film=(9., F), surrounding="guard_air"), E("convection", surface="head_front", film=(8., F), surrounding="guard_air"),
            E("forced_convection", surface="head_front", growth=(10., F), at_speed=(2400., "rpm"), exponent=0.7, surrounding="guard_air"), *films(base_outer=8, post_outer=9, head_outer=9, drive_outer=10),
            E("forced_convection", surface="drive_outer", growth=(30., F), at_speed=(2400., "rpm"), exponent=0.8), *contacts({"base/post": 900, "post/wheelhead": 500, "base/table": 200, "chuck/table": 900, "drive/wheelhead": 400})],
        **thermometers(g_head=("wheelhead", 520, 300, 1000), g_front=("wheelhead", 700, 150, 900), g_drive=("drive", 700, 400, 1300), g_post_low=("post", 500, 700, 500), g_post_high=("post", 500, 700, 1150), g_table=("table", 200, 300, 400), g_chuck=("chuck", 400, 300, 470), g_base=("base", 200, 0, 250), g_tank=("tank",), g_air=("guard_air",)),
        displacements=drawn(gap_z=("z", "wheelhead", (700, 150, 850), "chuck", (700, 300, 490)), gap_y=("y", "wheelhead", (700, 150, 850), "chuck", (700, 300, 490)), post_y=("y", "post", (700, 550, 1250))),
        regions=["base", "post", "wheelhead", "table", "chuck", "drive"], dummies=["wheelhead", "post", "table", "base", "drive"])
    return fam

def region_of(fam, surface):
    for line in fam["machine"].splitlines():
        m = re.search(r"name: %s, region: (\w+)" % surface, line)
        if m: return m.group(1)
    for r in sorted(fam["materials"], key=len, reverse=True):
        if surface.startswith(r): return r
    raise KeyError(surface)
def place_of(fam, e):
    """the bodies of an effect: one for heat; two ends for an exchange"""
    if "joint" in e: return e["joint"].split("/")
    body = e.get("region") or e.get("node") or region_of(fam, e["surface"])
    if e["type"] in EXCHANGES: return [body, e.get("surrounding") or e.get("to") or "ambient"]
    return [body]

# ------------------------------------------------------------------------------------------------------------------ scenario text
def scenario(fam, name, effects, materials, sensors, disps, cyclograms, ambient, start, dt, extra_disps=(), comment=""):
    t = comment + "name: %s\nreference_temperature: 20 degC\nstart: %s\nmachine:\n%smaterials:\n" % (name, start, fam["machine"])
    for r, m in materials.items():
        t += "  %s: %s\n" % (r, m if isinstance(m, str) else "{density: %.10g kg/m^3, conductivity: %.10g W/(m K), heat_capacity: %.10g J/(kg K), youngs_modulus: %.10g GPa, poisson_ratio: %.4g, expansion: %.10ge-6 1/K}" % (m[0], m[2], m[1], m[4], m[5], m[3]))
    t += "supports:\n" + fam["supports"] + fam["joints"] + "effects:\n"
    for e in effects: t += "  - " + flow(e) + "\n"
    t += "ambient: " + ambient + "\nsensors:\n" + "\n".join(fam["sensors"][s] for s in sensors) + "\n"
    t += "displacements:\n" + "\n".join([fam["displacements"][d] for d in disps] + list(extra_disps)) + "\n"
    t += "cyclograms:\n" + cyclograms
    t += "solver: {model: reduced, reduction_tolerance: 5 mK, output_interval: %g min, fields_every: 1000 h}\n" % dt
    return t

SPEED_COL = lambda feeds, cut: ["duration", "speed"] + ["feed_" + a for a in feeds] + (["cutting_power"] if cut else [])

class Model:
    """reduced matrices of a scenario's machine, with dummies: a heat and a link to the ambient at places, mean temperatures of bodies as outputs"""
    def __init__(self, fam, effects, materials, drives, tmp):
        bodies = list(fam["materials"]) + [e["node"] for e in effects if e["type"] in ("node", "air_node")]
        dum = [E("heat_source", region=r, power=(25., W)) for r in fam["dummies"]] + [E("link", region=r, to="ambient", conductance=(4., WK), runs="while_spindle_turns") for r in fam["dummies"]]
        ex = ["  - {name: zz_%s, sensitivities: [{%s: %s, sensitivity: 1 um/K}]}" % (b, "region" if b in fam["materials"] else "node", b) for b in bodies]
        feeds, cut = fam["cad"]["feeds"], fam["cad"]["cut"]
        cyc = "  drives:\n    columns: [%s]\n    rows:\n" % ", ".join(SPEED_COL(feeds, cut))
        for d in drives:
            v = ["60 min", "%.6g rpm" % d[0]] + ["%.6g mm/min" % x for x in d[1:1 + len(feeds)]] + (["%.6g W" % d[-1]] if cut else [])
            cyc += "      - [%s]\n" % ", ".join(v)
        shutil.rmtree(tmp, ignore_errors=True); os.makedirs(tmp)
        if fam["inp"]: open(tmp + "/machine.inp", "w").write(box_mesh(fam["inp"]))
        open(tmp + "/s.yaml", "w").write(scenario(fam, "export", [e2 for e2 in effects] + dum, materials, list(fam["sensors"]), list(fam["displacements"]), cyc, "20 degC", "reference", 60, ex))
        r = subprocess.run([DW, "simulate", "s.yaml", "-o", "o", "--quiet", "--force", "--threads", "1"], cwd=tmp, capture_output=True, text=True)
        if r.returncode: raise RuntimeError(r.stdout + r.stderr)
        d = tmp + "/o/reduced_model/"
        m = json.load(open(d + "model.json")); a = {n: np.load(d + n + ".npy") for n in "conduction exchanges to_hall offset loads outputs outputs_hall ones".split()}
        n = self.n = m["size"]; self.err = m["error"]
        self.K0 = a["conduction"].reshape(n, n); self.G = a["exchanges"].reshape(-1, n, n); self.hall = a["to_hall"].reshape(n, -1); self.off = a["offset"].reshape(n, -1)
        self.loads = a["loads"].reshape(n, -1); self.C = a["outputs"].reshape(n, -1).T; self.Ch = a["outputs_hall"]; self.ones = a["ones"]
        self.out = m["outputs"]["name"]; self.unit = np.array([1e6 if u == "m" else 1. for u in m["outputs"]["unit"]])
        self.si = [i for i, e2 in enumerate(effects) if e2["type"] in SOURCES]; self.xi = [i for i, e2 in enumerate(effects) if e2["type"] in EXCHANGES]
        assert len(m["sources"]) == len(self.si) + len(fam["dummies"]), [s["name"] for s in m["sources"]]
        assert len(m["exchanges"]) == len(self.xi) + len(fam["dummies"]), [s["name"] for s in m["exchanges"]]
        def match(L, wanted):
            used, where = set(), {}
            for k, e2 in wanted:
                body = e2.get("joint") or e2.get("region") or e2.get("surface") or e2.get("node"); other = e2.get("surrounding") or e2.get("to")
                hit = [j for j, q in enumerate(L) if j not in used and q["name"].split(" ")[0] == e2["type"] and q["body"]["name"] == body and (not other or q.get("surrounding") == other)
                       and ("with the spindle" in q["name"]) == ("runs" in e2)]
                assert hit, (e2, [q["name"] for q in L]); used.add(hit[0]); where[k] = hit[0]
            assert len(used) == len(L), [q["name"] for q in L]
            return where
        nd = len(fam["dummies"]); num_src, num_exc = match(m["sources"], [(i, effects[i]) for i in self.si] + [(r, dum[j]) for j, r in enumerate(fam["dummies"])]), match(m["exchanges"], [(i, effects[i]) for i in self.xi] + [(r, dum[nd + j]) for j, r in enumerate(fam["dummies"])])
        self.dheat = {r: num_src[r] for r in fam["dummies"]}; self.dlink = {r: num_exc[r] for r in fam["dummies"]}
        self.src = {i: num_src[i] for i in self.si}; self.exc = {i: num_exc[i] for i in self.xi}
        self.drv = {}
        for q in m["drives"]:
            key = (q["speed_rpm"],) + tuple(q["feed_m_s"]["xyz".index(ax)] * 60000 for ax in feeds) + ((q["cutting_power_W"],) if cut else ())
            c, P = np.array(q["coefficients"]), np.array(q["powers_W"])
            c[list(self.dlink.values())] = 0; P[list(self.dheat.values())] = 0
            self.drv[tuple(round(x, 3) for x in key)] = (c, P)
        self.mean = {b: self.out.index("zz_" + b) for b in bodies}
        self.eig = {}
        shutil.rmtree(tmp, ignore_errors=True)
    def drive(self, key): return self.drv[tuple(round(float(x), 3) for x in key)]
    def modes(self, c):
        k = c.tobytes()
        if k not in self.eig:
            if len(self.eig) > 400: self.eig.clear()
            w, V = np.linalg.eigh(self.K0 + np.tensordot(c, self.G, 1))
            self.eig[k] = (np.maximum(w, 1e-12), V)
        return self.eig[k]
    def steady(self, c, P, Ta):
        return np.linalg.solve(self.K0 + np.tensordot(c, self.G, 1), self.loads @ P + self.hall @ c * (Ta - TREF) + self.off @ c)
    def run(self, rec, amb, speeds=None, start="ambient", step=None, sub=1, scaleP=None, scalec=None):
        """rec: dict(t [s], drives: array of rows); amb true at rows [degC]; step(ctx) changes c and P. Returns outputs (rows x out) in degC-20 / um"""
        t, dr = rec["t"], rec["drives"].copy()
        if speeds is not None: dr[:, 0] = speeds
        fixP = (lambda P, d: P) if scaleP is None else scaleP
        fixc = (lambda c, d: c) if scalec is None else scalec
        st = {}
        d0 = np.zeros(dr.shape[1])
        if start == "steady":
            c, P = (x.copy() for x in self.drive(d0)); c, P = fixc(c, d0), fixP(P, d0)
            z = self.steady(c, P, amb[0])
            if step:
                for _ in range(3):
                    c, P = (x.copy() for x in self.drive(d0))
                    Tm = self.unit * (self.C @ z) + self.Ch * self.unit * (amb[0] - TREF)
                    step(dict(t=-1., dt=0., drive=d0, c=c, P=P, T=lambda b: TREF + (Tm[self.mean[b]] if b != "ambient" else amb[0] - TREF), st={}, m=self, rec=rec, settle=True))
                    z = self.steady(c, P, amb[0])
        else: z = self.ones * (amb[0] - TREF)
        Y = np.empty((len(t), len(self.out)))
        memo = {}
        for k in range(len(t)):
            Y[k] = self.unit * (self.C @ z + self.Ch * (amb[k] - TREF))
            if k + 1 == len(t): break
            h = (t[k + 1] - t[k]) / sub
            kd = dr[k].tobytes()
            if kd not in memo:
                c, P = self.drive(dr[k]); memo[kd] = (fixc(c.copy(), dr[k]), fixP(P.copy(), dr[k]))
            c0, P0 = memo[kd]
            for s in range(sub):
                a0, a1 = amb[k] + (amb[k + 1] - amb[k]) * s / sub, amb[k] + (amb[k + 1] - amb[k]) * (s + 1) / sub
                c, P = c0, P0
                if step:
                    c, P = c0.copy(), P0.copy()
                    Tm = self.unit * (self.C @ z) + self.Ch * self.unit * (a0 - TREF)
                    step(dict(t=t[k] + s * h, dt=h, drive=dr[k], c=c, P=P, T=lambda b: TREF + (Tm[self.mean[b]] if b != "ambient" else a0 - TREF), st=st, m=self, rec=rec, settle=False))
                w, V = self.modes(c)
                f = self.loads @ P + self.off @ c; g = self.hall @ c
                f0, f1 = V.T @ (f + g * (a0 - TREF)), V.T @ (f + g * (a1 - TREF))
                x = w * h; ex = np.exp(-x)
                p1 = np.where(x < 1e-5, 1 - x / 2, (1 - ex) / np.maximum(x, 1e-300)); p2 = np.where(x < 1e-3, 0.5 - x / 6, (1 - p1) / np.maximum(x, 1e-300))
                z = V @ (ex * (V.T @ z) + h * (p1 * f0 + p2 * (f1 - f0)))
        return Y

# ------------------------------------------------------------------------------------------------------------------ drive and ambient
def make_record(rng, fam, dt):
    n = int(rng.integers(90, 260)); n = min(n, int(rng.uniform(330, 660) / dt)); n = max(n, 80)
    top, feeds, cut = fam["cad"]["top"], fam["cad"]["feeds"], fam["cad"]["cut"]
    dr = np.zeros((n, 1 + len(feeds) + (1 if cut else 0)))
    style = rng.choice(["steps", "heat_cool", "shift", "chaotic"])
    k = int(rng.integers(0, 1 + max(1, int(10 / dt))))
    levels = [round(top * f / 50) * 50 for f in (0.25, 0.4, 0.55, 0.7, 0.85, 1.0)]
    def block(a, b, sp, milling):
        b = min(b, n); dr[a:b, 0] = sp
        if feeds and milling:
            for j in range(len(feeds)): dr[a:b, 1 + j] = float(rng.choice([600., 1500., 3000., 5000.]))
            if cut: dr[a:b, -1] = round(cut * float(rng.choice([0., 0.3, 0.6, 1.])))
    if style == "heat_cool":
        b = int(n * rng.uniform(0.45, 0.65)); block(k, b, float(rng.choice(levels[3:])), True)
        if rng.random() < .5: block(b + int(60 / dt), b + int(60 / dt) + int(30 / dt), float(rng.choice(levels[:4])), False)
    else:
        lo, hi = dict(steps=(40, 90), shift=(20, 60), chaotic=(12, 45))[style]
        while k < n:
            L = max(2, int(rng.uniform(lo, hi) / dt)); idle = rng.random() < dict(steps=.2, shift=.3, chaotic=.25)[style]
            block(k, k + L, 0. if idle else float(rng.choice(levels)), (not idle) and rng.random() < .8)
            k += L
    t = np.arange(n) * dt * 60.
    h = t / 3600.; T0 = rng.uniform(18, 24)
    amb = T0 + rng.normal(0, .12) * h + rng.uniform(0, .7) * (np.sin(2 * np.pi * (h / rng.uniform(5, 16) + rng.random()))) + rng.uniform(0, .15) * np.sin(2 * np.pi * (h / rng.uniform(.4, 1.2) + rng.random()))
    if rng.random() < .35:
        a = rng.uniform(.2, .7) * h[-1]; amb = amb - rng.uniform(.5, 1.8) * np.where(h > a, np.exp(-np.maximum(h - a, 0) / .35), 0.)
    return dict(t=t, drives=dr, amb=np.round(amb, 4), dt=dt)

# ------------------------------------------------------------------------------------------------------------------ faults
class Fault:
    def __init__(s, kind, what, statements, amplitude, sayable, records, step=None, amb=None, speed=None, read=None, material=None, sub=1):
        s.__dict__.update(locals()); del s.__dict__["s"]

def first_order(x, lag, t, x0=None):
    y = np.empty_like(x); y[0] = x[0] if x0 is None else x0
    for k in range(1, len(x)):
        e = math.exp(-(t[k] - t[k - 1]) / lag); m = (x[k] + x[k - 1]) / 2; y[k] = m + (y[k - 1] - m) * e
    return y
st_ = lambda q, p, f: {"quantity": q, "place": p, "follows": f}

SAYABLE = ["hidden_heat", "law_power", "film", "contact", "link_ambient", "fan_link", "door", "conductivity", "capacity", "hidden_body", "bias", "drift", "lag", "detached", "scale", "swap", "mount_shift", "disp_scale", "disp_lag", "centrifugal", "askew", "expansion", "hall_step", "hall_offset", "clock", "speed", "missing_stop", "heat_window"]
OUTSIDE = ["stick_slip", "backlash", "thermostat_valve", "phase_change", "restart_grease", "loose_sensor", "lift_off", "cross_talk", "coolant_splash", "preload_hysteresis", "frozen_reading", "start_loss", "wandering_sun", "saturated", "self_heating_lead"]

def make_fault(kind, rng, fam, case, a):
    """One branch a kind: a table in the order of SAYABLE and OUTSIDE. a: an amplitude factor that is tried around 1"""
    D_, Se, R = case["disps"], case["sensors"], case["records"]; effects = case["effects"]
    dum = fam["dummies"]; body = str(rng.choice(dum)); top = fam["cad"]["top"]; nrec = len(R)
    pick = lambda L: L[int(rng.integers(0, len(L)))]
    sens = pick([s for s in Se]); disp = pick(D_); recs = list(range(1, nrec + 1))
    dur = min(r["t"][-1] for r in R); u, v = rng.random(), rng.random(); sg = 1 if rng.random() < .5 else -1
    mass = 1.0 if body not in ("bed", "base") else 2.0
    if fam is FAM["gantry"] and body == "table": mass = 4.0
    def src(eff): return [i for i, e in enumerate(eff) if e["type"] in SOURCES and any(k in e for k in ("power", "torque", "friction", "f0"))]
    if kind == "hidden_heat":
        Q = a * mass * rng.uniform(35, 110); mode = pick(["constant", "running", "power of speed"]); ex = float(pick([1., 1.5, 2.]))
        def step(x):
            n = x["drive"][0]; x["P"][x["m"].dheat[body]] += Q * (1 if mode == "constant" else (n > 0) if mode == "running" else (n / top) ** ex * 1.6)
        return Fault(kind, "a source of %.0f W in %s that nobody wrote down, %s" % (Q, body, mode), [st_("heat", [body], mode)], Q, True, recs, step=step)
    if kind == "heat_window":
        Q = a * mass * rng.uniform(70, 240); t0 = (0.1 + 0.5 * u) * dur; t1 = min(t0 + (0.12 + 0.25 * v) * dur, dur * .95); rr = [int(rng.integers(1, nrec + 1))]
        def step(x):
            if x["rec"]["no"] in rr and t0 <= x["t"] < t1: x["P"][x["m"].dheat[body]] += Q
        return Fault(kind, "%.0f W in %s from %.0f to %.0f min of record %d" % (Q, body, t0 / 60, t1 / 60, rr[0]), [st_("heat", [body], "window")], Q, True, rr, step=step, sub=2)
    if kind == "law_power":
        i = pick(src(effects)); f = 1 + a * rng.uniform(.5, 1.3) if u < .7 else max(.15, 1 - .6 * a)
        e = effects[i]; fol = "power of speed" if e.get("at_speed") or e["type"] == "bearing_friction" else ("power of feed_" + e["axis"] if "axis" in e else "constant")
        def step(x): x["P"][x["m"].src[i]] *= f
        return Fault(kind, "the heat of %s at %s is %.2f times what is written" % (e["type"], place_of(fam, e)[0], f), [st_("heat", place_of(fam, e), fol)], f, True, recs, step=step)
    if kind in ("film", "contact"):
        L = [i for i, e in enumerate(effects) if (e["type"] in ("convection", "forced_convection") if kind == "film" else e["type"] == "contact" and "bearing" not in e["joint"])]
        i = pick(L); f = (1 + a * rng.uniform(.8, 2.) if u < .5 else 1 / (1 + a * rng.uniform(1., 3.))); e = effects[i]
        def step(x): x["c"][x["m"].exc[i]] *= f
        return Fault(kind, "the %s of %s is %.2f times what is written" % (e["type"], e.get("surface") or e.get("joint"), f), [st_("exchange", place_of(fam, e), "power of speed" if e["type"] == "forced_convection" else "difference")], f, True, recs, step=step)
    if kind in ("link_ambient", "fan_link", "door"):
        G = a * mass * rng.uniform(3, 9); t0 = (.1 + .45 * u) * dur; t1 = t0 + (.15 + .25 * v) * dur
        if kind == "door": G *= 2
        def step(x):
            on = True if kind == "link_ambient" else x["drive"][0] > 0 if kind == "fan_link" else t0 <= x["t"] < t1
            if on: x["c"][x["m"].dlink[body]] += G
        fol = {"link_ambient": "difference", "fan_link": "running", "door": "window"}[kind]
        return Fault(kind, "%.1f W/K between %s and the ambient that is not in the scenario, %s" % (G, body, fol + (" %.0f to %.0f min" % (t0 / 60, t1 / 60) if kind == "door" else "")), [st_("exchange", [body, "ambient"], fol)], G, True, recs, step=step, sub=2)
    if kind in ("conductivity", "capacity", "expansion"):
        r = pick(fam["regions"]); f = 1 + a * rng.uniform(.35, .9) if u < .5 else 1 / (1 + a * rng.uniform(.5, 1.2))
        j = dict(capacity=1, conductivity=2, expansion=3)[kind]
        def material(m): m = dict(m); x = list(m[r]); x[j] *= f; m[r] = tuple(x); return m
        return Fault(kind, "the %s of %s is %.2f times that of its material as written" % (kind, r, f), [st_(kind, [r], "constant")], f, True, recs, material=material)
    if kind == "hidden_body":
        C = a * mass * rng.uniform(12e3, 50e3); G = mass * rng.uniform(8, 30)
        def step(x):
            st = x["st"]; T = x["T"](body)
            if x["settle"]: return
            if "T" not in st: st["T"] = T
            e = math.exp(-G / C * x["dt"]); Q = C * (T - st["T"]) * (1 - e) / max(x["dt"], 1e-9); st["T"] += Q * x["dt"] / C; x["P"][x["m"].dheat[body]] -= Q
        return Fault(kind, "a body of %.0f kJ/K hangs at %s by %.0f W/K" % (C / 1e3, body, G), [st_("capacity", [body], "constant")], C, True, recs, step=step, sub=4)
    if kind == "phase_change":
        L = a * mass * rng.uniform(60e3, 250e3); G = mass * rng.uniform(25, 60); Tm = float(np.quantile(case["meanT"][body], rng.uniform(.35, .6))); cp = 1500. * mass
        def step(x):
            st = x["st"]; T = x["T"](body)
            if x["settle"]: return
            if "H" not in st: st["H"] = cp * (T - Tm) if T < Tm else L + cp * (T - Tm)
            H = st["H"]; Tp = Tm + (H / cp if H < 0 else (H - L) / cp if H > L else 0.)
            Q = G * (T - Tp) * (1 if 0 <= H <= L else (1 - math.exp(-G / cp * x["dt"])) / (G / cp * x["dt"])); st["H"] += Q * x["dt"]; x["P"][x["m"].dheat[body]] -= Q
        return Fault(kind, "wax behind %s melts at %.1f degC and takes %.0f kJ" % (body, Tm, L / 1e3), [st_("capacity", [body], "its melting point")], L, False, recs, step=step, sub=4)
    if kind == "thermostat_valve":
        Q = a * mass * rng.uniform(60, 200); q = case["meanT"][body]; mid = float(np.quantile(q, rng.uniform(.35, .65))); hy = max(.15, .12 * float(q.max() - q.min()))
        def step(x):
            T = x["T"](body); st = x["st"]
            if x["settle"]: return
            on = st.get("on", False)
            if T > mid + hy: on = True
            if T < mid - hy: on = False
            st["on"] = on
            if on: x["P"][x["m"].dheat[body]] -= Q
        return Fault(kind, "a valve with a thermostat opens at %s above %.1f degC and shuts below %.1f degC; open it takes %.0f W" % (body, mid + hy, mid - hy, Q), [st_("heat", [body], "thermostat on the temperature of " + body)], Q, False, recs, step=step, sub=4)
    if kind == "restart_grease":
        Q = a * mass * rng.uniform(90, 260); tau = rng.uniform(8, 25) * 60
        def step(x):
            st = x["st"]; w = st.get("w", 1.)
            if x["settle"]: return
            if x["drive"][0] > 0:
                x["P"][x["m"].dheat[body]] += Q * w * (x["drive"][0] / top); w *= math.exp(-x["dt"] / tau)
            else: w = 1 - (1 - w) * math.exp(-x["dt"] / (3 * tau))
            st["w"] = w
        return Fault(kind, "grease that stiffens at rest heats %s after each restart and is worked soft in %.0f min" % (body, tau / 60), [st_("heat", [body], "time since the restart and length of the rest before it")], Q, False, recs, step=step, sub=2)
    if kind == "lift_off":
        L = [i for i, e in enumerate(effects) if e["type"] == "contact" and all(b in case["meanT"] for b in e["joint"].split("/")) and "bearing" not in e["joint"]]
        i = pick(L); e = effects[i]; p, q = e["joint"].split("/"); dd = case["meanT"][p] - case["meanT"][q]; lvl = float(np.quantile(abs(dd), .5)); f = 1 / (1 + 5 * a)
        def step(x):
            st = x["st"]; d = abs(x["T"](p) - x["T"](q))
            if x["settle"]: return
            up = st.get("up", False)
            if d > 1.15 * lvl: up = True
            if d < .7 * lvl: up = False
            st["up"] = up
            if up: x["c"][x["m"].exc[i]] *= f
        return Fault(kind, "the joint %s lifts off where its sides differ by more than %.1f K and closes below %.1f K; lifted it conducts %.2f of what is written" % (e["joint"], 1.15 * lvl, .7 * lvl, f), [st_("exchange", [p, q], "difference, with hysteresis")], f, False, recs, step=step, sub=2)
    if kind == "coolant_splash":
        G = a * mass * rng.uniform(8, 25); dead = rng.uniform(4, 12) * 60; dry = rng.uniform(15, 35) * 60
        def step(x):
            st = x["st"]
            if x["settle"]: return
            act = x["drive"][-1] > 0 if fam["cad"]["cut"] else x["drive"][0] > .5 * top
            st["run"] = st.get("run", 0.) + x["dt"] if act else 0.
            if st["run"] > dead: st["wet"] = 1.
            else: st["wet"] = st.get("wet", 0.) * math.exp(-x["dt"] / dry)
            w = math.ceil(st["wet"] * 8) / 8 if st["wet"] > .06 else 0.
            x["c"][x["m"].dlink[body]] += G * w
        return Fault(kind, "%s gets wet once the machine has %s for %.0f min and dries slowly; wet it loses %.0f W/K more" % (body, "cut" if fam["cad"]["cut"] else "run fast", dead / 60, G), [st_("exchange", [body, "ambient"], "how long it has cut, then drying")], G, False, recs, step=step, sub=2)
    if kind == "preload_hysteresis":
        Q = a * mass * rng.uniform(60, 180)
        def step(x):
            st = x["st"]; T = x["T"](body)
            if x["settle"]: return
            st["f"] = st.get("f", T) + (T - st.get("f", T)) * (1 - math.exp(-x["dt"] / 900.))
            if T - st["f"] > .15: st["s"] = 1
            if T - st["f"] < -.05: st["s"] = 0
            if st.get("s", 0): x["P"][x["m"].dheat[body]] += Q * x["drive"][0] / top
        return Fault(kind, "bearings in %s are preloaded and drag while it warms up, not while it cools or stays" % body, [st_("heat", [body], "sign of its own warming, with hysteresis")], Q, False, recs, step=step, sub=2)
    if kind == "start_loss":
        J = a * mass * rng.uniform(25e3, 80e3)
        def step(x):
            st = x["st"]; n = x["drive"][0]; d = max(0., n - st.get("n", 0.)); st["n"] = n
            if x["settle"]: return
            st["E"] = st.get("E", 0.) + J * (d / top) ** 2 * 1.5
            q = st["E"] * (1 - math.exp(-x["dt"] / 120.)); st["E"] -= q; x["P"][x["m"].dheat[body]] += q / x["dt"]
        return Fault(kind, "each acceleration of the spindle leaves a pulse of heat in %s, by the square of the step" % body, [st_("heat", [body], "steps of the speed upwards")], J, False, recs, step=step, sub=2)
    if kind == "wandering_sun":
        b2 = pick([b for b in dum if b != body]); Q = a * rng.uniform(90, 260) * mass; t0 = (.05 + .3 * u) * dur; L = (.35 + .25 * v) * dur
        def step(x):
            s = (x["t"] - t0) / L
            if 0 < s < 1:
                q = Q * math.sin(math.pi * s); w = min(max(2 * s - .5, 0.), 1.); x["P"][x["m"].dheat[body]] += q * (1 - w); x["P"][x["m"].dheat[b2]] += q * w
        return Fault(kind, "a patch of sun wanders from %s to %s between %.0f and %.0f min" % (body, b2, t0 / 60, (t0 + L) / 60), [st_("heat", [body], "window, a half sine"), st_("heat", [b2], "window, a half sine")], Q, False, recs, step=step, sub=2)
    # readings -----------------------------------------------------------------------------------------------
    rd = lambda q, p, f, what, amp, fn, say=True, rr=None: Fault(kind, what, [st_(q, p, f)], amp, say, rr or recs, read=fn)
    if kind == "bias":
        b = sg * a * rng.uniform(.5, 1.8)
        if u < .5: return rd("reading", [sens], "running", "%s reads %.2f K wrong while the spindle turns" % (sens, b), b, lambda r, y, A: y.__setitem__(sens, y[sens] + b * (r["drives"][:, 0] > 0)))
        return rd("reading", [sens], "constant", "%s reads %.2f K wrong" % (sens, b), b, lambda r, y, A: y.__setitem__(sens, y[sens] + b))
    if kind == "drift":
        b = sg * a * rng.uniform(.15, .5)
        return rd("reading", [sens], "since start", "%s drifts by %.2f K/h" % (sens, b), b, lambda r, y, A: y.__setitem__(sens, y[sens] + b * r["t"] / 3600))
    if kind == "lag":
        g = a * rng.uniform(8, 25) * 60
        return rd("reading", [sens], "unknown", "%s follows %.0f min late" % (sens, g / 60), g / 60, lambda r, y, A: y.__setitem__(sens, first_order(y[sens], g, r["t"])))
    if kind == "detached":
        s = min(.9, a * rng.uniform(.3, .7)); t0 = (.15 + .5 * u) * dur; rr = [int(rng.integers(1, nrec + 1))]
        return rd("reading", [sens], "window", "%s comes off at %.0f min of record %d and reads %.2f of the air" % (sens, t0 / 60, rr[0], s), s, lambda r, y, A: y.__setitem__(sens, np.where((r["t"] >= t0), (1 - s) * y[sens] + s * A, y[sens])), rr=rr)
    if kind == "scale":
        f = 1 + sg * a * rng.uniform(.15, .4)
        return rd("reading", [sens], "temperature of " + fam["sensor_body"][sens], "%s reads kelvins that are %.2f times too large" % (sens, f), f, lambda r, y, A: y.__setitem__(sens, TREF + f * (y[sens] - TREF)))
    if kind == "swap":
        o = pick([s for s in Se if s != sens])
        def fn(r, y, A): y[sens], y[o] = y[o].copy(), y[sens].copy()
        return rd("reading", [sens, o], "constant", "%s and %s are plugged into each other's channel" % (sens, o), 1, fn)
    if kind == "mount_shift":
        s = sg * a * rng.uniform(4, 15); t0 = (.15 + .6 * u) * dur; rr = [int(rng.integers(1, nrec + 1))]
        return rd("displacement", [disp], "window", "the indicator of %s slips by %.1f um at %.0f min of record %d" % (disp, s, t0 / 60, rr[0]), s, lambda r, y, A: y.__setitem__(disp, y[disp] + s * (r["t"] >= t0)), rr=rr)
    if kind == "disp_scale":
        f = 1 + sg * a * rng.uniform(.25, .5)
        return rd("displacement", [disp], "unknown", "%s is %.2f times what the machine does" % (disp, f), f, lambda r, y, A: y.__setitem__(disp, y[disp] * f))
    if kind == "disp_lag":
        g = a * rng.uniform(12, 40) * 60
        return rd("displacement", [disp], "unknown", "%s follows %.0f min late" % (disp, g / 60), g / 60, lambda r, y, A: y.__setitem__(disp, first_order(y[disp], g, r["t"])))
    if kind == "centrifugal":
        g = sg * a * rng.uniform(3, 12)
        return rd("displacement", [disp], "power of speed", "%s jumps with the square of speed, %.1f um at top speed" % (disp, g), g, lambda r, y, A: y.__setitem__(disp, y[disp] + g * (r["drives"][:, 0] / top) ** 2))
    if kind == "askew":
        b = pick(list(case["meanT"])); g = sg * a * rng.uniform(1., 4.)
        return rd("displacement", [disp], "temperature of " + b, "the indicator's bracket of %s sits on %s and moves %.2f um/K" % (disp, b, g), g, lambda r, y, A: y.__setitem__(disp, y[disp] + g * (y["_mean"][b] - TREF)))
    if kind == "stick_slip":
        b = a * rng.uniform(3, 9)
        return rd("displacement", [disp], "stick-slip", "%s sticks and slips where it is %.1f um behind" % (disp, b), b, lambda r, y, A: y.__setitem__(disp, laws.sticks(y[disp][None], np.array([[b]]))[0]), False)
    if kind == "backlash":
        b = a * rng.uniform(2, 7)
        return rd("displacement", [disp], "hysteresis", "%s has a play of %.1f um to each side" % (disp, b), b, lambda r, y, A: y.__setitem__(disp, laws.play(y[disp][None], np.array([[b]]))[0]), False)
    seedr = int(rng.integers(1, 1 << 30))
    if kind == "loose_sensor":
        s = min(.9, a * rng.uniform(.3, .7))
        def fn(r, y, A):
            g = np.random.default_rng(seedr + r["no"]); on = False; x = y[sens].copy()
            for k in range(len(x)):
                p = .12 if r["drives"][k, 0] > 0 else .02
                if g.random() < p: on = not on
                if on: x[k] = (1 - s) * x[k] + s * A[k]
            y[sens] = x
        return rd("reading", [sens], "intermittent, more often while it runs", "%s has a loose contact to its body and now and then reads %.2f of the air" % (sens, s), s, fn, False)
    if kind == "cross_talk":
        o = pick([s for s in Se if s != sens]); g = a * rng.uniform(.15, .35)
        if u < .5:
            def fn(r, y, A): y[sens] = y[sens] + g * 3 * (np.gradient(y[o], r["t"]) * 600)
            return Fault(kind, "%s picks up the rate of %s" % (sens, o), [st_("reading", [sens], "rate of " + o)], g, False, recs, read=fn)
        def fn(r, y, A): y[sens] = y[sens] + g * .5 * (y[o] - y[o][0]) * np.sign(y[o] - y[sens])
        return Fault(kind, "cross-talk of %s into %s, its sign by which is warmer" % (o, sens), [st_("reading", [sens], "difference to " + o)], g, False, recs, read=fn)
    if kind == "frozen_reading":
        t0 = (.1 + .45 * u) * dur; L = min(.85, a * (.2 + .25 * v)) * dur; rr = [int(rng.integers(1, nrec + 1))]
        def fn(r, y, A):
            x = y[sens].copy(); k0 = int(np.searchsorted(r["t"], t0)); x[(r["t"] >= t0) & (r["t"] < t0 + L)] = x[k0]; y[sens] = x
        return rd("reading", [sens], "window, held", "%s is frozen from %.0f to %.0f min of record %d" % (sens, t0 / 60, (t0 + L) / 60, rr[0]), L / 60, fn, False, rr)
    if kind == "saturated":
        def fn(r, y, A):
            lim = case["satur"][sens] if sens in case["satur"] else 99; y[sens] = np.where(y[sens] > lim, lim + .08 * (y[sens] - lim), y[sens])
        q = case["sensT"][sens]; case["satur"][sens] = float(q.min() + (q.max() - q.min()) * max(.15, 1 - .5 * a))
        return rd("reading", [sens], "above a limit", "%s hardly rises above %.1f degC" % (sens, case["satur"][sens]), case["satur"][sens], fn, False)
    if kind == "self_heating_lead":
        g = sg * a * rng.uniform(1., 3.); tau = rng.uniform(5, 20) * 60
        def fn(r, y, A):
            d = r["drives"][:, 0] / top; w = first_order((np.abs(np.diff(d, prepend=d[0])) > 0) * 1., tau, r["t"], 0.); y[sens] = y[sens] + g * w * 3
        return rd("reading", [sens], "changes of speed", "the lead of %s warms at every change of speed and decays in %.0f min" % (sens, tau / 60), g, fn, False)
    if kind in ("hall_step", "hall_offset"):
        o = sg * a * rng.uniform(1.8, 3.5); t0 = (.15 + .4 * u) * dur; t1 = t0 + (.2 + .3 * v) * dur; rr = [int(rng.integers(1, nrec + 1))] if kind == "hall_step" else recs
        f = lambda r, A: A + o * ((r["t"] >= t0) & (r["t"] < t1)) if kind == "hall_step" else A + o
        amb = lambda r, A: f(r, A) if r["no"] in rr else A
        return Fault(kind, "the hall is %.1f K from what is recorded%s" % (o, " between %.0f and %.0f min of record %d" % (t0 / 60, t1 / 60, rr[0]) if kind == "hall_step" else ""), [st_("ambient", ["hall"], "window" if kind == "hall_step" else "constant")], o, True, rr, amb=amb)
    if kind == "clock":
        o = sg * a * rng.uniform(3, 12) * 60
        def fn(r, y, A):
            for k in list(y):
                if k != "_mean": y[k] = np.interp(r["t"] - o, r["t"], y[k])
        return rd("clock", ["clock"], "constant", "readings are logged %.1f min %s" % (abs(o) / 60, "late" if o > 0 else "early"), o / 60, fn)
    if kind == "speed":
        f = round(1 + sg * min(.4, a * rng.uniform(.12, .28)), 3)
        return Fault(kind, "the spindle turns at %.3f of the recorded speed" % f, [st_("speed", ["spindle"], "constant")], f, True, recs, speed=lambda r, s: np.round(s * f, 3))
    if kind == "missing_stop":
        L = min(.5, a * (.12 + .15 * v)) * dur; rr = [int(rng.integers(1, nrec + 1))]; t0 = (.1 + .5 * u) * dur
        return Fault(kind, "the spindle stood from %.0f to %.0f min of record %d, which is not recorded" % (t0 / 60, (t0 + L) / 60, rr[0]), [st_("speed", ["spindle"], "window")], L / 60, True, rr, speed=lambda r, s: np.where((r["t"] >= t0) & (r["t"] < t0 + L), 0., s) if r["no"] in rr else s)
    raise KeyError(kind)

# ------------------------------------------------------------------------------------------------------------------ a case
def scatter_num(rng, e, s=1.0):
    e = dict(e)
    for k, sig in SCATTER.items():
        if k not in e or isinstance(e[k], str) or (e["type"] == "heat_source" and k == "exponent" and not e.get("at_speed")): continue
        v = e[k]; q = math.exp(s * sig * rng.normal())
        e[k] = (float(v[0] * q), v[1]) if isinstance(v, tuple) else float(v * q)
    return e
def exact(e): return {k: (("%.9g %s" % v) if isinstance(v, tuple) else "%.9g" % v if isinstance(v, float) else v) for k, v in e.items()}

def simulate(model, case, faults, offs):
    out = []
    for r in case["records"]:
        amb = r["amb"] + offs[r["no"] - 1]; sp = r["drives"][:, 0].copy()
        for f in faults:
            if f.amb: amb = f.amb(r, amb)
            if f.speed: sp = f.speed(r, sp)
        steps = [f.step for f in faults if f.step and r["no"] in f.records]; sub = max([f.sub for f in faults if f.step] + [1])
        step = None
        if steps:
            def step(x, steps=steps):
                st = x["st"]
                for j, g in enumerate(steps): x["st"] = st.setdefault(j, {}) if not x["settle"] else {}; g(x)
        if step and r["dt"] > 2: sub *= 2
        Y = model.run(r, amb, sp, case["start"], step, sub)
        y = {s: TREF + Y[:, model.out.index(s)] for s in case["sensors"]}; y.update({d: Y[:, model.out.index(d)].copy() for d in case["disps"]})
        y["_mean"] = {b: TREF + Y[:, i] for b, i in model.mean.items()}
        for f in faults:
            if f.read and r["no"] in f.records: f.read(r, y, amb)
        out.append(y)
    return out

def stack(case, out, base):
    return np.concatenate([(o[c] - b[c]) / case["sigma"][c] for o, b in zip(out, base) for c in case["sensors"] + case["disps"]])
def worst_rms(case, out, base):
    """largest rms, over channels and records, of the change over noise"""
    return max(math.sqrt(np.mean(((o[c] - b[c]) / case["sigma"][c]) ** 2)) for o, b in zip(out, base) for c in case["sensors"] + case["disps"])

def sensitivities(case, model, fammodels, base, offs):
    """one column per scattered number, for one sigma of its prior, over noise"""
    cols = []
    def runs(m, **k):
        res = []
        for r in case["records"]:
            Y = m.run(r, r["amb"] + offs[r["no"] - 1], None, "ambient" if k.get("amb_start") else case["start"], None, 1, k.get("scaleP"), k.get("scalec"))
            res.append({c: (TREF if c in case["sensors"] else 0) + Y[:, m.out.index(c)] for c in case["sensors"] + case["disps"]})
        return res
    base = runs(model)
    for i, e in enumerate(case["effects"]):
        if i in model.src:
            j = model.src[i]; f = np.ones(model.loads.shape[1]); f[j] = 1.1
            cols.append(stack(case, runs(model, scaleP=lambda P, d: P * f), base))
            if "exponent" in e and "at_speed" in e and e["exponent"] > 0:
                n0 = e["at_speed"][0]; g = .03 * e["exponent"]
                def sp(P, d):
                    P = P.copy(); P[j] *= (max(d[0], 1e-9) / n0) ** g if d[0] > 0 else 1
                    return P
                cols.append(stack(case, runs(model, scaleP=sp), base))
        if i in model.exc:
            j = model.exc[i]; f = np.ones(model.G.shape[0]); f[j] = 1.1
            cols.append(stack(case, runs(model, scalec=lambda c, d: c * f), base))
    b0, others = fammodels
    r0 = runs2(case, b0, model, offs)
    for m in others: cols.append(stack(case, runs2(case, m, model, offs), r0))
    for k, r in enumerate(case["records"]):
        o2 = list(offs); o2[k] += .3
        Y = model.run(r, r["amb"] + o2[k], None, case["start"])
        v = [dict(b) for b in base]; v[k] = {c: (TREF if c in case["sensors"] else 0) + Y[:, model.out.index(c)] for c in case["sensors"] + case["disps"]}
        cols.append(stack(case, v, base))
    return np.array(cols).T
def runs2(case, m, model, offs):
    m.drv = model.drv; res = []; m.eig = {} if len(m.eig) > 60 else m.eig
    for r in case["records"]:
        Y = m.run(r, r["amb"] + offs[r["no"] - 1], None, case["start"]); res.append({c: (TREF if c in case["sensors"] else 0) + Y[:, m.out.index(c)] for c in case["sensors"] + case["disps"]})
    return res
def remainder(d, S):
    A = S.T @ S + np.eye(S.shape[1]); b = S.T @ d
    return .5 * (d @ d - b @ np.linalg.solve(A, b))

FAM, FAMMODELS = None, {}
def fam_models(name, fam, tmp):
    """sensitivity models: base and each region's capacity, conductivity and expansion 10 % up, and lumped capacities"""
    if name not in FAMMODELS:
        mats = {r: MAT[m] for r, m in fam["materials"].items()}; dr = [tuple([0.] * (1 + len(fam["cad"]["feeds"]) + bool(fam["cad"]["cut"]))), tuple([fam["cad"]["top"]] + [1000.] * len(fam["cad"]["feeds"]) + ([100.] if fam["cad"]["cut"] else []))]
        mk = lambda eff, mm: Model(fam, [exact(e) for e in eff], mm, dr, tmp)
        base, L = mk(fam["effects"], mats), []
        for r in fam["regions"]:
            for j in (1, 2, 3):
                mm = dict(mats); x = list(mm[r]); x[j] *= 1.1; mm[r] = tuple(x); L.append(mk(fam["effects"], mm))
        for i, e in enumerate(fam["effects"]):
            if e["type"] == "node":
                eff = list(fam["effects"]); eff[i] = dict(e, capacity=(e["capacity"][0] * 1.1, e["capacity"][1])); L.append(mk(eff, mats))
        FAMMODELS[name] = (base, L)
    return FAMMODELS[name]

def fmt(x, step): return ("%.*f" % (max(0, int(round(-math.log10(step)))) + (1 if step in (.05, .5) else 0), round(x / step) * step))
def write_record(path, case, r, y, rng, noise=True):
    feeds, cut = case["fam"]["cad"]["feeds"], case["fam"]["cad"]["cut"]
    head = ["time_s", "speed_rpm"] + ["feed_%s_mm_min" % a for a in feeds] + (["cutting_power_W"] if cut else []) + ["ambient_degC"] + [s + "_degC" for s in case["sensors"]] + [d + "_um" for d in case["disps"]]
    n = len(r["t"]); lines = [",".join(head)]
    amb = r["amb"] + (rng.normal(0, case["amb_noise"], n) if noise else 0)
    cols = {}
    for c in case["sensors"] + case["disps"]: cols[c] = y[c] + (rng.normal(0, case["noise"][c], n) if noise else 0)
    gaps = rng.random((n, len(cols))) < case["gaps"]
    for k in range(n):
        row = ["%g" % r["t"][k]] + ["%g" % x for x in r["drives"][k]] + [fmt(amb[k], .01) if noise else "%.4f" % amb[k]]
        for j, c in enumerate(cols): row.append("" if noise and gaps[k, j] else (fmt(cols[c][k], case["step"][c]) if noise else "%.5f" % cols[c][k]))
        lines.append(",".join(row))
    open(path, "w").write("\n".join(lines) + "\n")

def case_scenario(case, name):
    cyc = "".join("  rec_%d: {csv: measured_%d.csv}\n" % (r["no"], r["no"]) for r in case["records"])
    return scenario(case["fam"], name, case["effects"], case["fam"]["materials"], case["sensors"], case["disps"], cyc, "{csv: measured_1.csv, channel: ambient}", case["start"], case["records"][0]["dt"])

def draw_machine(rng, fname, fam):
    case = dict(fam=fam, family=fname, start=str(rng.choice(["ambient", "steady"])))
    eff = []
    for e in fam["effects"]:
        e = dict(e)
        for k in ("power", "idle", "film", "growth", "conductance", "torque", "exchange"):
            if isinstance(e.get(k), tuple): e[k] = (rounded(e[k][0] * math.exp(.2 * rng.normal()), 2), e[k][1])
        eff.append(e)
    case["effects"] = eff
    allS, allD = list(fam["sensors"]), list(fam["displacements"])
    nS = int(rng.integers(max(3, len(allS) - 4), len(allS) + 1)); keep = set(rng.choice(len(allS), nS, replace=False)); case["sensors"] = [s for i, s in enumerate(allS) if i in keep]
    nD = int(rng.integers(1, len(allD) + 1)); keep = set(rng.choice(len(allD), nD, replace=False)); case["disps"] = [s for i, s in enumerate(allD) if i in keep]
    dt = float(rng.choice([1., 2., 3., 5.])); case["records"] = []
    for k in range(int(rng.choice([1, 2, 3], p=[.3, .45, .25]))):
        r = make_record(rng, fam, dt); r["no"] = k + 1; case["records"].append(r)
    tn, dn = float(rng.choice([.03, .05, .08])), float(rng.choice([.3, .5, .8])); ts, ds = float(rng.choice([.01, .1])), .1
    case["noise"] = {**{s: tn for s in case["sensors"]}, **{d: dn for d in case["disps"]}}; case["step"] = {**{s: ts for s in case["sensors"]}, **{d: ds for d in case["disps"]}}
    case["sigma"] = {c: math.hypot(case["noise"][c], case["step"][c] / math.sqrt(12)) for c in case["noise"]}; case["amb_noise"] = float(rng.choice([.02, .05])); case["gaps"] = .004 if rng.random() < .2 else 0.
    case["satur"] = {}
    return case
def drives_of(case, faults=()):
    s = {tuple(float(x) for x in row) for r in case["records"] for row in r["drives"]}; w = len(case["records"][0]["drives"][0]); s.add((0.,) * w)
    for f in faults:
        if f.speed:
            for r in case["records"]:
                sp = f.speed(r, r["drives"][:, 0].copy()); s |= {tuple([float(a)] + [float(x) for x in row[1:]]) for a, row in zip(sp, r["drives"])}
    return sorted(s)

def build(no, cls, kinds, fname, out, tmp):
    fam = FAM[fname]
    for attempt in range(12):
        rng = np.random.default_rng([SEED, no, attempt]); case = draw_machine(rng, fname, fam)
        eff = [scatter_num(rng, e) for e in case["effects"]]
        mats = {}
        for r, m in fam["materials"].items():
            x = list(MAT[m])
            for j in (1, 2, 3): x[j] *= math.exp(.1 * rng.normal())
            mats[r] = tuple(x)
        offs = list(rng.normal(0, .3, len(case["records"]))); effx = [exact(e) for e in eff]
        model = Model(fam, effx, mats, drives_of(case), tmp); base = simulate(model, case, [], offs)
        case["meanT"] = {b: np.concatenate([y["_mean"][b] for y in base]) for b in base[0]["_mean"]}; case["sensT"] = {s: np.concatenate([y[s] for y in base]) for s in case["sensors"]}
        faults, info, final = [], [], base
        if cls != "B":
            S_ = sensitivities(case, model, fam_models(fname, fam, tmp), base, offs); ok = True
            for kd in kinds:
                frng0 = [SEED, no, attempt, len(faults)]; a, got, tr = 1., None, 0; pickn = 0
                while tr < 9:
                    tr += 1; f = make_fault(kd, np.random.default_rng(frng0 + [pickn]), fam, case, a)
                    if faults and any(s["place"] == q["place"] for s in f.statements for g in faults for q in g.statements): pickn += 1; continue
                    m2 = model
                    if f.material: m2 = Model(fam, effx, f.material(mats), drives_of(case), tmp)
                    elif f.speed: m2 = Model(fam, effx, mats, drives_of(case, [f]), tmp)
                    o = simulate(m2, case, [f], offs); rms = worst_rms(case, o, base); nats = remainder(stack(case, o, base), S_)
                    if not np.isfinite(rms): pickn += 1; continue
                    if 2 <= rms <= 30 and nats >= 18: got = (f, rms, nats, m2); break
                    if kd == "swap": pickn += 1
                    elif rms > 30: a *= max(.15, 20 / rms)
                    elif a < 2.2: a *= 1.7
                    else: a = 1.; pickn += 1
                if not got: ok = False; break
                faults.append(got[0]); info.append(got[1:])
            if not ok:
                if attempt >= 4:  # this machine's family cannot show it: another kind of the same sort
                    j = len(faults); pool = SAYABLE if kinds[j] in SAYABLE else OUTSIDE
                    kinds = kinds[:j] + [[k for k in pool if k not in kinds][int(rng.integers(0, len(pool) - len(set(kinds) & set(pool))))]] + kinds[j + 1:]
                continue
            mm = mats
            for f in faults:
                if f.material: mm = f.material(mm)
            model2 = info[0][2] if len(faults) == 1 else (Model(fam, effx, mm, drives_of(case, faults), tmp) if any(f.material or f.speed for f in faults) else model)
            final = simulate(model2, case, faults, offs)
        break
    else: raise RuntimeError("case %d: %s of %s cannot be made" % (no, kinds, fname))
    d = "%s/case_%04d" % (out, no); os.makedirs(d)
    if fam["inp"]: open(d + "/machine.inp", "w").write(box_mesh(fam["inp"]))
    open(d + "/scenario.yaml", "w").write(case_scenario(case, "%s_%04d" % (fname, no)))
    nrng = np.random.default_rng([SEED, no, 777])
    for r, y in zip(case["records"], final): write_record("%s/measured_%d.csv" % (d, r["no"]), case, r, y, nrng)
    effects = [{"what": f.what, "kind": f.kind, "statements": f.statements, "records": f.records, "amplitude": rounded(float(f.amplitude), 4), "residual_sigmas": round(i[0], 2), "remaining_nats": round(min(i[1], 1e6), 1), "sayable": f.sayable} for f, i in zip(faults, info)]
    json.dump({"case": no, "class": cls, "family": fname, "sayable": all(f.sayable for f in faults), "start": case["start"], "effects": effects}, open(d + "/truth.json", "w"), indent=1)
    print("%4d %s %-14s n=%d rows=%s try=%d %s" % (no, cls, fname, model.n, [len(r["t"]) for r in case["records"]], attempt, [(f.kind, round(i[0], 1), round(i[1])) for f, i in zip(faults, info)]), flush=True)

def plan():
    rng = np.random.default_rng(SEED); names = list(FAM); L = []
    nA, nD = COUNTS["A"], COUNTS["D"]
    slots = nA + 2 * nD; nout = round(slots / 3)
    kinds = [str(k) for k in rng.permutation(SAYABLE)] + [str(k) for k in rng.permutation(SAYABLE)]
    kinds = kinds[:slots - nout]; o = [str(k) for k in rng.permutation(OUTSIDE)] + [str(k) for k in rng.permutation(OUTSIDE)]; kinds += o[:nout]
    kinds = [str(k) for k in rng.permutation(kinds)]
    for k in range(nA): L.append(("A", [kinds.pop()]))
    for k in range(nD):
        a = kinds.pop(); j = next(i for i in range(len(kinds) - 1, -1, -1) if kinds[i] != a); L.append(("D", [a, kinds.pop(j)]))
    L += [("B", [])] * COUNTS["B"]
    L = [L[i] for i in rng.permutation(len(L))]
    f = [names[i % len(names)] for i in range(len(L))]; f = [f[i] for i in rng.permutation(len(f))]
    return [(i + 1, c, k, f[i]) for i, (c, k) in enumerate(L)]

def check(tmp):
    """B cases without scatter and noise: Driftwright's own run of scenario.yaml against what is integrated here"""
    names = list(FAM); bad = 0
    for j, fname in enumerate(names):
        fam = FAM[fname]; no = 9000 + j; case = draw_machine(np.random.default_rng([SEED, no]), fname, fam)
        case["start"] = ["ambient", "steady"][j % 2]
        # the numbers as scenario.yaml prints them
        model = Model(fam, case["effects"], fam["materials"], drives_of(case), tmp); offs = [0.] * len(case["records"]); y = simulate(model, case, [], offs)
        wd = tmp + "_check"; shutil.rmtree(wd, ignore_errors=True); os.makedirs(wd)
        if fam["inp"]: open(wd + "/machine.inp", "w").write(box_mesh(fam["inp"]))
        for r, o in zip(case["records"], y):
            c1 = dict(case, records=[dict(r, no=1)]); write_record(wd + "/measured_1.csv", case, r, o, np.random.default_rng(0), noise=False)
            open(wd + "/scenario.yaml", "w").write(case_scenario(c1, "check"))
            q = subprocess.run([DW, "simulate", "scenario.yaml", "-o", "o", "--quiet", "--force", "--threads", "1"], cwd=wd, capture_output=True, text=True)
            if q.returncode: print(q.stdout + q.stderr); return 1
            L = open(wd + "/o/record.csv").read().split("\n"); L = [l for l in L if l and l[0] != "#"]; head = L[0].split(","); M = np.array([[float(x) if x else np.nan for x in l.split(",")] for l in L[1:]])
            tt = M[:, 0] * dict(s=1, min=60, h=3600)[head[0].split("_")[1]]
            dT = max(np.nanmax(abs(np.interp(tt, r["t"], o[s]) - M[:, head.index(s + "_degC")])) for s in case["sensors"]); dU = max(np.nanmax(abs(np.interp(tt, r["t"], o[s]) - M[:, head.index(s + "_um")])) for s in case["disps"])
            span = (max(np.ptp(o[s]) for s in case["sensors"]), max(np.ptp(o[s]) for s in case["disps"]))
            print("%-14s record %d, start %-8s %4d rows: %.4f K, %.4f um apart at most (spans %.1f K, %.1f um)" % (fname, r["no"], case["start"], len(tt), dT, dU, span[0], span[1]), flush=True); bad += dT > .05 or dU > .3
        shutil.rmtree(wd, ignore_errors=True)
    print("check:", "FAILED" if bad else "passed"); return 1 if bad else 0

def main():
    global FAM
    ap = argparse.ArgumentParser(); ap.add_argument("--out", default="foundry"); ap.add_argument("--check", action="store_true"); ap.add_argument("--only", type=int, nargs="*"); ap.add_argument("--plan", action="store_true")
    a = ap.parse_args(); FAM = families(); tmp = tempfile.mkdtemp(prefix="foundry_") + "/m"
    if a.check: sys.exit(check(tmp))
    P = plan()
    if a.plan:
        for p in P: print(*p)
        return
    if not a.only: shutil.rmtree(a.out, ignore_errors=True)
    os.makedirs(a.out, exist_ok=True)
    for p in P:
        if a.only and p[0] not in a.only: continue
        if a.only: shutil.rmtree("%s/case_%04d" % (a.out, p[0]), ignore_errors=True)
        build(*p, a.out, tmp)
if __name__ == "__main__": main()
