#!/usr/bin/python3
"""Blind cases of lumped thermal machines with hidden faults:  stranger.py FOLDER [--plain K] [--only N]
Own simulation: Runge-Kutta of order 4 on a batch of variants at once. Same seed, same bytes."""
import os
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import sys, json, math, argparse
import numpy as np
from scipy.optimize import lsq_linear

SEED = 73041219
PI = math.pi


def sig(x, n=4):
    return float("%.*g" % (n, float(x)))


def U(rng, a, b):
    return float(rng.uniform(a, b))


def LU(rng, a, b):
    return float(math.exp(rng.uniform(math.log(a), math.log(b))))


# ------------------------------------------------------------------------------------------------------------ families
# bodies kJ/K; links W/K (a, b, lo, hi[, probability]); amb (body, lo, hi[, prob]); fans: to ambient while the spindle turns
# heats: (kind, body, weight, ...); disp: (name, [(body, lo, hi)])
FAM = {
    "surface_grinder": dict(
        bodies=dict(wheel_spindle=(3, 7), wheelhead=(20, 45), belt_motor=(8, 18), pillar=(50, 120), magnet_table=(25, 60), bed=(120, 260)),
        links=[("wheel_spindle", "wheelhead", 10, 30), ("belt_motor", "wheelhead", 2, 7), ("wheelhead", "pillar", 12, 35), ("pillar", "bed", 15, 45), ("magnet_table", "bed", 6, 18)],
        amb=[("wheelhead", 3, 8), ("belt_motor", 3, 8), ("pillar", 5, 12), ("bed", 9, 20), ("magnet_table", 3, 8), ("wheel_spindle", .4, 1.4)],
        heats=[("fric", "wheel_spindle", 1.0, 1.2, 1.8, .006, .02), ("motor", "belt_motor", 1.2, 1.1, 1.8, .25), ("cut", "magnet_table", .1, .3), ("servo", "bed", "x", .5, 1., 1.3, .2)],
        disp=[("wheel_y", [("wheel_spindle", 1, 3), ("pillar", 4, 9), ("magnet_table", -4, -1)]), ("wheel_z", [("wheelhead", 2, 5), ("bed", -4, -1)])],
        top=(2400, 4200), feeds=["x"], cut=(900, 2600)),
    "roll_coater": dict(
        bodies=dict(drum=(14, 35), lamp_box=(3, 8), nip_roller=(5, 14), side_frame=(30, 70), gear_motor=(6, 14)),
        links=[("drum", "side_frame", 4, 12), ("lamp_box", "drum", 2, 6), ("nip_roller", "drum", 3, 9), ("nip_roller", "side_frame", 3, 8), ("gear_motor", "side_frame", 2, 7)],
        amb=[("drum", 3, 7), ("lamp_box", 3, 6), ("side_frame", 7, 15), ("gear_motor", 2, 5), ("nip_roller", 1, 3)],
        heats=[("col", "lamp_box", 2.0, "lamp_V"), ("col", "drum", 1.0, "lamp_V"), ("src", "nip_roller", .5, 1., 1.6), ("motor", "gear_motor", .8, 1., 1.5, .3)],
        disp=[("gap", [("drum", 1, 3), ("nip_roller", 1, 3), ("side_frame", -5, -2)])],
        top=(120, 400), col=("lamp_V", 110, 230)),
    "gear_pump_rig": dict(
        bodies=dict(pump=(3, 8), manifold=(4, 10), oil_tank=(30, 90), motor=(9, 22), baseplate=(25, 60)),
        links=[("pump", "manifold", 8, 25), ("manifold", "oil_tank", 10, 30), ("pump", "motor", 1, 4), ("motor", "baseplate", 3, 9), ("pump", "baseplate", 2, 8), ("oil_tank", "baseplate", 1, 4, .6)],
        amb=[("pump", .8, 2), ("manifold", 1, 3), ("oil_tank", 5, 12), ("motor", 3, 7), ("baseplate", 4, 10)],
        fans=[("motor", 2, 6)],
        heats=[("fric", "pump", 1.5, 1.1, 1.7, .008, .02), ("motor", "motor", 1.2, 1.1, 1.8, .2), ("src", "manifold", .5, 1.5, 2.4)],
        disp=[("shaft_gap", [("pump", 1, 3), ("motor", -3, -1), ("baseplate", 2, 5)])],
        top=(1200, 3200)),
    "filament_printer": dict(
        bodies=dict(hotend=(.5, 1.2), carriage=(1.5, 4), plate=(3, 8), portal=(8, 20), frame=(10, 30)),
        air=dict(chamber=(1.5, 4, 3, 9)),
        links=[("hotend", "carriage", .3, .8), ("carriage", "portal", .8, 2.5), ("plate", "frame", .8, 2.5), ("portal", "frame", 2, 6), ("hotend", "chamber", .2, .6), ("plate", "chamber", 1.5, 4), ("portal", "chamber", 2, 5), ("frame", "chamber", 2, 5)],
        amb=[("frame", 3, 7)],
        heats=[("src", "hotend", .3, .5, 1.), ("col", "plate", 2.0, "bed_V"), ("servo", "portal", "x", .5, 1., 1.3, .3), ("servo", "frame", "y", .6, 1., 1.3, .3)],
        disp=[("nozzle_z", [("portal", 3, 8), ("plate", -4, -1), ("frame", -6, -2)]), ("nozzle_x", [("carriage", 1, 4), ("portal", 2, 6)])],
        top=(200, 600), feeds=["x", "y"], col=("bed_V", 12, 24)),
    "conveyor_oven": dict(
        bodies=dict(muffle=(15, 40), belt=(6, 16), door=(4, 10), shell=(20, 50)),
        air=dict(oven_air=(2, 5, 2, 6)),
        links=[("muffle", "oven_air", 6, 18), ("belt", "oven_air", 4, 10), ("door", "oven_air", 2, 6), ("muffle", "shell", 2, 6), ("door", "shell", 1, 4)],
        amb=[("shell", 8, 18), ("door", 2, 5), ("belt", 1, 4)],
        heats=[("col", "muffle", 3., "heater_V"), ("src", "belt", .4, 1., 1.5), ("const", "shell", .2, "always")],
        disp=[("rail_x", [("shell", 4, 9), ("belt", 1, 4)])],
        top=(60, 300), col=("heater_V", 120, 240)),
    "swiss_lathe": dict(
        bodies=dict(main_spindle=(4, 9), sub_spindle=(3, 6), guide_bush=(.9, 2), headstock=(18, 40), slant_bed=(80, 180), screw_z=(2, 5), z_motor=(3, 7)),
        links=[("main_spindle", "headstock", 14, 35), ("guide_bush", "headstock", 2, 6), ("sub_spindle", "slant_bed", 5, 14), ("headstock", "slant_bed", 15, 40), ("screw_z", "slant_bed", 3, 9), ("z_motor", "screw_z", 1, 4), ("z_motor", "slant_bed", 2, 6)],
        amb=[("main_spindle", .5, 1.5), ("sub_spindle", 1.5, 4), ("headstock", 3, 8), ("slant_bed", 8, 18), ("screw_z", .7, 2), ("z_motor", 1, 3)],
        heats=[("fric", "main_spindle", 1.4, 1.2, 1.7, .006, .018), ("src", "sub_spindle", .7, 1.2, 1.8), ("motor", "headstock", .9, 1., 1.6, .3), ("cut", "guide_bush", .02, .06), ("servo", "z_motor", "z", .6, 1., 1.3, .25), ("servo", "screw_z", "z", .3, 1., 1.2, .0)],
        disp=[("tool_x", [("headstock", 3, 7), ("slant_bed", -4, -1), ("main_spindle", .8, 2)]), ("tool_z", [("screw_z", 4, 8), ("slant_bed", -5, -2)]), ("sub_z", [("sub_spindle", 2, 5), ("slant_bed", 1, 4)])],
        top=(6000, 12000), feeds=["z"], cut=(600, 1800)),
    "bearing_test_rig": dict(
        bodies=dict(test_bearing=(.8, 2), shaft=(3, 7), load_block=(8, 20), support=(6, 15), motor=(8, 20), table=(60, 140)),
        links=[("test_bearing", "shaft", 4, 10), ("test_bearing", "load_block", 6, 16), ("shaft", "support", 5, 14), ("shaft", "motor", .8, 2.5), ("support", "table", 6, 18), ("motor", "table", 4, 10), ("load_block", "table", .8, 3)],
        amb=[("shaft", .5, 2), ("load_block", 2, 5), ("support", 2, 5), ("motor", 3, 8), ("table", 7, 15)],
        heats=[("fric", "test_bearing", 1.6, 1., 1.6, .008, .025), ("fric", "support", .6, 1., 1.6, .005, .015), ("motor", "motor", 1.1, 1.1, 1.9, .3)],
        disp=[("runout", [("shaft", 1, 4), ("support", -3, -1)]), ("block_z", [("load_block", 2, 5), ("table", 1, 4)])],
        top=(3000, 9000)),
    "lab_centrifuge": dict(
        bodies=dict(rotor=(4, 10), drive=(4, 9), bowl=(6, 14), cabinet=(12, 30)),
        air=dict(bowl_air=(.8, 2, .5, 2)),
        links=[("rotor", "bowl_air", 3, 8), ("bowl", "bowl_air", 4, 10), ("drive", "rotor", .6, 2), ("drive", "cabinet", 3, 8), ("bowl", "cabinet", 2, 6)],
        amb=[("cabinet", 6, 14), ("drive", 1.5, 4)],
        fans=[("drive", 1.5, 4)],
        heats=[("src", "bowl_air", 1.2, 2., 2.8), ("motor", "drive", 1.2, 1., 1.7, .25), ("const", "cabinet", .25, "always")],
        disp=[],
        top=(4000, 15000)),
    "laser_engraver": dict(
        bodies=dict(tube=(1, 2.5), cold_plate=(3, 8), mirror_arm=(1, 3), gantry=(8, 20), honeycomb=(4, 10), housing=(15, 35)),
        links=[("tube", "cold_plate", 4, 10), ("cold_plate", "housing", 3, 8), ("mirror_arm", "gantry", .6, 2), ("gantry", "housing", 3, 8), ("honeycomb", "housing", 2, 5)],
        amb=[("cold_plate", 3, 8), ("gantry", 2, 4), ("honeycomb", 2, 5), ("housing", 6, 13), ("tube", .3, 1)],
        fans=[("housing", 2, 6)],
        heats=[("col", "tube", 2., "tube_V"), ("col", "honeycomb", .8, "tube_V"), ("servo", "gantry", "x", .6, 1., 1.4, .3), ("servo", "housing", "y", .5, 1., 1.4, .3), ("const", "housing", .4, "running")],
        disp=[("beam_x", [("gantry", 3, 7), ("mirror_arm", 2, 5)]), ("beam_y", [("housing", 2, 6), ("gantry", -3, -1)])],
        top=(1500, 3000), feeds=["x", "y"], col=("tube_V", 8, 20)),
    "gantry_router": dict(
        bodies=dict(nose=(1.5, 4), cartridge=(4, 10), ram=(20, 45), bridge=(70, 150), leg_left=(30, 70), leg_right=(30, 70), table=(90, 200), x_drive=(3, 8)),
        links=[("nose", "cartridge", 6, 18), ("cartridge", "ram", 12, 30), ("ram", "bridge", 8, 22), ("bridge", "leg_left", 10, 25), ("bridge", "leg_right", 10, 25), ("leg_left", "table", 6, 16), ("leg_right", "table", 6, 16), ("x_drive", "bridge", 2, 7)],
        amb=[("nose", .5, 1.5), ("ram", 3, 7), ("bridge", 8, 18), ("leg_left", 4, 9), ("leg_right", 4, 9), ("table", 9, 20), ("x_drive", 2, 5)],
        heats=[("fric", "nose", 1., 1.2, 1.7, .006, .02), ("motor", "cartridge", 1.3, 1.2, 1.9, .3), ("servo", "x_drive", "x", .7, 1., 1.4, .3), ("servo", "ram", "z", .3, 1., 1.3, .3), ("cut", "table", .05, .2)],
        disp=[("tip_x", [("bridge", 3, 8), ("leg_left", 1, 3)]), ("tip_y", [("ram", 2, 6), ("bridge", -4, -1)]), ("tip_z", [("ram", -7, -3), ("leg_left", 2, 5), ("leg_right", 2, 5), ("cartridge", -3, -1)]), ("tip_c", [("leg_left", 2, 5), ("leg_right", -5, -2)])],
        top=(9000, 20000), feeds=["x", "z"], cut=(1500, 4000)),
    "screw_extruder": dict(
        bodies=dict(barrel=(18, 40), screw=(6, 14), die=(3, 7), gearbox=(14, 30), motor=(12, 28)),
        links=[("barrel", "screw", 3, 9), ("barrel", "die", 4, 10), ("screw", "gearbox", 1.5, 5), ("barrel", "gearbox", 1, 4), ("gearbox", "motor", 3, 9)],
        amb=[("barrel", 4, 10), ("die", 1, 3), ("gearbox", 4, 9), ("motor", 4, 9)],
        fans=[("motor", 3, 7)],
        heats=[("col", "barrel", 1.8, "band_V"), ("src", "screw", .8, 1., 1.6), ("fric", "gearbox", .7, 1., 1.5, .006, .015), ("motor", "motor", .9, 1., 1.6, .3)],
        disp=[("die_z", [("barrel", 6, 14), ("screw", -6, -2)])],
        top=(60, 180), col=("band_V", 110, 230)),
    "dry_vacuum_pump": dict(
        bodies=dict(rotors=(6, 14), stator=(20, 45), gearcase=(8, 18), motor=(9, 20), silencer=(2, 5), skid=(30, 70)),
        links=[("rotors", "stator", 3, 9), ("rotors", "gearcase", 2, 6), ("gearcase", "stator", 8, 20), ("motor", "gearcase", 3, 8), ("silencer", "stator", 1, 4), ("stator", "skid", 2, 7), ("motor", "skid", 2, 6)],
        amb=[("stator", 5, 12), ("gearcase", 2, 5), ("motor", 3, 7), ("silencer", 1, 3), ("skid", 4, 10)],
        heats=[("src", "rotors", 1.2, 1.5, 2.3), ("fric", "gearcase", .8, 1.1, 1.6, .008, .02), ("motor", "motor", 1., 1., 1.6, .3), ("src", "silencer", .3, 1., 1.6)],
        disp=[("rotor_gap", [("rotors", 2, 6), ("stator", -5, -2)])],
        top=(2500, 7000)),
    "flywheel_store": dict(
        bodies=dict(flywheel=(20, 45), bearing_up=(.8, 2), bearing_low=(.9, 2.2), casing=(30, 70), converter=(4, 10)),
        links=[("flywheel", "bearing_up", 1, 4), ("flywheel", "bearing_low", 1, 4), ("bearing_up", "casing", 4, 10), ("bearing_low", "casing", 4, 10), ("flywheel", "casing", .8, 2.5), ("converter", "casing", 1, 4)],
        amb=[("casing", 8, 18), ("converter", 3, 8)],
        heats=[("fric", "bearing_up", .6, 1., 1.5, .01, .025), ("fric", "bearing_low", 1., 1., 1.5, .01, .025), ("motor", "flywheel", .4, 1.5, 2.3, .1), ("const", "converter", .7, "running")],
        disp=[("top_z", [("flywheel", 2, 6), ("casing", -4, -1)]), ("top_r", [("bearing_up", 1, 4), ("casing", 1, 3)])],
        top=(6000, 18000)),
    "wire_saw": dict(
        bodies=dict(drum_left=(8, 18), drum_right=(8, 18), ingot=(3, 9), slurry=(15, 40), machine_frame=(60, 140)),
        links=[("drum_left", "machine_frame", 6, 16), ("drum_right", "machine_frame", 6, 16), ("ingot", "slurry", 5, 14), ("slurry", "machine_frame", 4, 12), ("slurry", "drum_left", 1, 4), ("slurry", "drum_right", 1, 4)],
        amb=[("drum_left", 1, 3), ("drum_right", 1, 3), ("ingot", .5, 2), ("slurry", 4, 9), ("machine_frame", 9, 20)],
        heats=[("fric", "drum_left", 1., 1., 1.6, .005, .015), ("src", "drum_right", .9, 1., 1.6), ("cut", "ingot", .08, .2), ("servo", "machine_frame", "z", .4, 1., 1.3, .4)],
        disp=[("wire_y", [("drum_left", 1, 4), ("drum_right", -4, -1)]), ("wire_z", [("machine_frame", 4, 9), ("ingot", -4, -1)])],
        top=(900, 2200), feeds=["z"], cut=(500, 1600)),
    "hot_press": dict(
        bodies=dict(upper_platen=(10, 25), lower_platen=(10, 25), crosshead=(40, 90)),
        links=[("upper_platen", "crosshead", 3, 8), ("lower_platen", "crosshead", 2, 6), ("upper_platen", "lower_platen", 1.5, 5)],
        amb=[("upper_platen", 2, 5), ("lower_platen", 2, 5), ("crosshead", 7, 15)],
        heats=[("col", "upper_platen", 1.2, "platen_V"), ("col", "lower_platen", 1., "platen_V"), ("motor", "crosshead", .8, 1., 1.5, .4)],
        disp=[("gap_l", [("upper_platen", 1, 3), ("lower_platen", 1, 3), ("crosshead", -6, -3)])],
        top=(700, 1500), col=("platen_V", 100, 230)),
}


class Machine:
    pass


def draw_machine(rng, fam):
    """In one piece: another order of draws would be another set."""
    s = FAM[fam]
    m = Machine()
    m.fam = fam
    m.bodies, m.par = [], []

    def par(label, v, sg=0.1):
        m.par.append((label, sig(v), sg))
        return len(m.par) - 1

    m.C = []
    for b, (lo, hi) in s["bodies"].items():
        m.bodies.append(b)
        m.C.append(par("C " + b, LU(rng, lo, hi) * 1e3))
    m.air = []
    for b, (lo, hi, el, eh) in s.get("air", {}).items():
        m.bodies.append(b)
        m.air.append(b)
        m.C.append(par("C " + b, LU(rng, lo, hi) * 1e3))
    ix = {b: i for i, b in enumerate(m.bodies)}
    m.ix, m.n = ix, len(m.bodies)
    m.links = []  # (i, j, parameter, running, is_air_exchange)
    for l in s["links"]:
        if len(l) > 4 and rng.random() > l[4]:
            continue
        m.links.append((ix[l[0]], ix[l[1]], par("G %s-%s" % l[:2], LU(rng, l[2], l[3])), False, False))
    for l in s["amb"]:
        if len(l) > 3 and rng.random() > l[3]:
            continue
        m.links.append((ix[l[0]], -1, par("G %s-ambient" % l[0], LU(rng, l[1], l[2])), False, False))
    for l in s.get("fans", []):
        m.links.append((ix[l[0]], -1, par("Gfan %s-ambient" % l[0], LU(rng, l[1], l[2])), True, False))
    for b, (lo, hi, el, eh) in s.get("air", {}).items():
        m.links.append((ix[b], -1, par("G %s-ambient" % b, LU(rng, el, eh)), False, True))
    m.top = round(U(rng, *s["top"]), -1)
    m.feeds = {a: round(U(rng, 2000, 15000), -2) for a in s.get("feeds", [])}
    m.cut = round(U(rng, *s["cut"]), -1) if "cut" in s else None
    m.col = (s["col"][0], round(U(rng, s["col"][1], s["col"][2]))) if "col" in s else None
    # heats, first in relative weights, then scaled to a largest rise
    raw = []
    for h in s["heats"]:
        raw.append((h, h[2] * LU(rng, .6, 1.6) if h[0] != "cut" and h[0] != "servo" else None))
    m.heats = []
    q = np.zeros(m.n)
    ws = []
    for h, w in raw:
        k, b = h[0], ix[h[1]]
        if k == "cut":
            share = U(rng, h[2], h[3])
            w = 0.0
            ws.append(share)
            continue
        if k == "servo":
            w = h[3] * LU(rng, .6, 1.6)
        ws.append(w)
        q[b] += w * .6
    A = np.zeros((m.n, m.n))
    for i, j, p, fan, _ in m.links:
        g = m.par[p][1]
        A[i, i] += g
        if j >= 0:
            A[j, j] += g
            A[i, j] -= g
            A[j, i] -= g
    rise = np.linalg.solve(A, q)
    sc = LU(rng, 12, 38) / rise.max()
    tot = 0
    for (h, _), w in zip(raw, ws):
        k, b = h[0], ix[h[1]]
        d = dict(kind=k, b=b)
        if k == "cut":
            d["share"] = par("share " + h[1], w)
            tot += .5 * w * m.cut
        else:
            P = w * sc
            tot += .6 * P
            if k == "src":
                d.update(p=par("P " + h[1], P), e=par("e " + h[1], U(rng, h[3], h[4]), .03))
            elif k == "const":
                d.update(p=par("P " + h[1], P), run=h[3])
            elif k == "motor":
                f = h[5] * U(rng, .6, 1.3)
                d.update(p=par("P " + h[1], P * (1 - f)), e=par("e " + h[1], U(rng, h[3], h[4]), .03), idle=par("idle " + h[1], P * f))
            elif k == "fric":
                d.update(p=par("P " + h[1], P * 1.2), e=par("e " + h[1], U(rng, h[3], h[4]), .03), dec=par("dec " + h[1], U(rng, h[5], h[6])))
            elif k == "servo":
                f = h[6] * U(rng, .6, 1.3)
                d.update(ax=h[2], p=par("P %s %s" % (h[1], h[2]), P * (1 - f)), e=par("e %s %s" % (h[1], h[2]), U(rng, h[4], h[5]), .03))
                if f > 0:
                    d["idle"] = par("idle %s %s" % (h[1], h[2]), P * f)
            elif k == "col":
                d.update(g=par("gain " + h[1], P / m.col[1]))
        m.heats.append(d)
    m.Pref = tot
    nd = len(s["disp"])
    keep = sorted(rng.permutation(nd)[:int(rng.integers(0, nd + 1))] if rng.random() < .35 else range(nd))
    m.disp = []
    for k in keep:
        name, se = s["disp"][k]
        m.disp.append((name, [(ix[b], par("s %s %s" % (name, b), U(rng, lo, hi))) for b, lo, hi in se]))
    # thermometers
    nb = len(s["bodies"])
    real = list(s["bodies"])
    miss = int(rng.integers(1, 3)) if nb >= 5 else (1 if rng.random() < .8 else 0)
    out = set(rng.permutation(nb)[:miss])
    style = rng.integers(0, 3)
    m.sens = []
    for k, b in enumerate(real + m.air):
        if (k < nb and k in out) or (k >= nb and rng.random() < .5):
            continue
        m.sens.append((["t_%s" % b, "pt_%s" % b, "th%d" % (k + 1)][style], ix[b]))
    m.start = "ambient"
    m.tref = sig(U(rng, 18, 24), 3)
    m.nom = np.array([p[1] for p in m.par])
    m.sg = np.array([p[2] for p in m.par])
    return m


def linkname(m, l):
    return [m.bodies[l[0]], "ambient" if l[1] < 0 else m.bodies[l[1]]]


# ------------------------------------------------------------------------------------------------------------- records
class Rec:
    pass


def draw_records(rng, m):
    nrec = int(rng.choice([1, 2, 3, 4], p=[.2, .35, .3, .15]))
    recs = []
    same = rng.random() < .6
    dt0 = None
    levels = sorted(round(m.top * f / 10) * 10 if m.top > 600 else round(m.top * f) for f in (U(rng, .25, .45), U(rng, .5, .75), 1.0))
    base = U(rng, 17, 26)
    q = rng.random() < .3
    qs = float(rng.choice([.05, .1, .1, .2]))
    nK = LU(rng, .02, .2)
    nU = LU(rng, .1, 1.)
    col = rng.random() < .1
    for r in range(nrec):
        R = Rec()
        R.dt = dt0 if same and dt0 else float(rng.choice([10, 15, 20, 30, 60, 60, 120, 180, 300]))
        dt0 = R.dt
        lo, hi = max(150, int(5400 / R.dt)), min(900, int(108000 / R.dt))
        R.n = int(rng.integers(lo, max(lo + 1, hi + 1))) if lo < hi else hi
        R.n = max(150, min(900, R.n))
        n, T = R.n, R.n * R.dt
        R.t = np.arange(n) * R.dt

        def pieces(draw, first=None):
            x, k = np.zeros(n), 0
            while k < n:
                ln = max(3, int(n * U(rng, .06, .3)))
                x[k:k + ln] = draw() if (k or first is None) else first
                k += ln
            return x

        last = [0.]

        def sp():
            c = [v for v in [0.] + levels + levels if v != last[0]]
            last[0] = float(c[int(rng.integers(len(c)))])
            return last[0]

        R.speed = pieces(sp, first=0. if rng.random() < .4 else None)
        if not (R.speed > 0).any():
            R.speed[n // 4: n // 2] = levels[2]
        if r == 0 and len(set(R.speed[R.speed > 0])) < 2:   # the first record knows two speeds
            R.speed[n // 2: 3 * n // 4] = levels[0]
            R.speed[n // 8: n // 2 - 2] = levels[2]
        R.feed = {a: pieces(lambda: 0. if rng.random() < .3 else round(f * U(rng, .2, 1.), -2)) for a, f in m.feeds.items()}
        R.cut = None
        if m.cut:
            R.cut = pieces(lambda: 0. if rng.random() < .4 else round(m.cut * U(rng, .3, 1.), -1)) * (R.speed > 0)
        R.col = None
        if m.col:
            R.col = pieces(lambda: 0. if rng.random() < .3 else round(m.col[1] * U(rng, .3, 1.), 1))
        a = base + rng.normal(0, 1.2) + U(rng, -1.5, 1.5) * R.t / 86400 * 4
        per = U(rng, 2, 14) * 3600
        a = a + U(rng, .1, 1.0) * np.sin(2 * PI * (R.t / per + rng.random()))
        if rng.random() < .3:
            t0 = U(rng, .2, .8) * T
            a = a - U(rng, .3, 1.2) * (R.t > t0) * np.exp(-np.maximum(0, R.t - t0) / U(rng, 900, 3600))
        R.amb = a                       # what a perfect ambient thermometer would have shown
        R.aoff = rng.normal(0, .3)
        qq = q if rng.random() < .85 else not q
        R.q = qs if qq else 0.
        R.qU = float(rng.choice([.1, .5])) if qq and rng.random() < .5 else 0.
        R.nK, R.nU, R.ncol = nK, nU, (U(rng, 2, 12) if col else 0.)
        R.namb = U(rng, .0, .06)
        recs.append(R)
    if m.start != "ambient" and m.start != "steady":
        m.start = sig(base + U(rng, -3, 2), 3)
    return recs


# ---------------------------------------------------------------------------------------------------------- simulation
def heat_law(h, v, n, m, R, k):
    """Power of one heat in row(s) k: v (P, K) numbers, n speeds (rows, P) or (P,)."""
    def powr(x, x0, e):
        return np.where(x > 0, np.abs(x / x0) ** e, 0.)
    kind = h["kind"]
    one = np.ones_like(n)
    ex = (lambda a: a[..., None] * one) if np.ndim(n) == 2 else (lambda a: a * one)
    if kind in ("src", "fric"):
        return v[:, h["p"]] * powr(n, m.top, v[:, h["e"]])
    if kind == "motor":
        return np.where(n > 0, v[:, h["idle"]] + v[:, h["p"]] * powr(n, m.top, v[:, h["e"]]), 0.)
    if kind == "const":
        return v[:, h["p"]] * (one if h["run"] == "always" else (n > 0))
    if kind == "cut":
        return v[:, h["share"]] * ex(R.cut[k])
    if kind == "servo":
        x = ex(R.feed[h["ax"]][k])
        return (v[:, h["idle"]] if "idle" in h else 0.) + v[:, h["p"]] * powr(x, m.feeds[h["ax"]], v[:, h["e"]])
    if kind == "col":
        return v[:, h["g"]] * ex(R.col[k])
    raise ValueError(kind)


class Ctx:
    """What faults may look at."""


def simulate(m, val, R, r, aoff, faults, amps, hsub=1.0):
    """Temperatures (rows, P, n), the readings by channel (rows, P), over P variants. In one piece: the steps of one record in their order."""
    P, n, N = val.shape[0], m.n, R.n
    live = [(f, a) for f, a in zip(faults, amps) if r in f.recs]
    v = val.copy()
    for f, a in live:
        if f.vals:
            f.vals(v, a)
    c = Ctx()
    c.m, c.R, c.v, c.P = m, R, v, P
    c.speed = np.repeat(R.speed[:, None], P, 1)
    c.amb = R.amb[:, None] + aoff[None, :]
    for f, a in live:
        if f.speed:
            f.speed(c, a)
        if f.ambient:
            f.ambient(c, a)
    ext = [(f, a) for f, a in live if f.extra]
    n += len(ext)
    q = np.zeros((N, P, n))
    fr = []
    for h in m.heats:
        p = heat_law(h, v, c.speed, m, R, slice(None))
        if h["kind"] == "fric":
            fr.append((h["b"], p, v[:, h["dec"]]))
        else:
            q[:, :, h["b"]] += p
    c.q = q
    for f, a in live:
        if f.qrow:
            f.qrow(c, a)
    Aon, gon, Aoff, goff = (np.zeros((P, n, n)), np.zeros((P, n)), np.zeros((P, n, n)), np.zeros((P, n)))
    for i, j, p, fan, _ in m.links:
        g = v[:, p]
        for A, ga, on in ((Aon, gon, True), (Aoff, goff, False)):
            if fan and not on:
                continue
            A[:, i, i] -= g
            if j >= 0:
                A[:, j, j] -= g
                A[:, i, j] += g
                A[:, j, i] += g
            else:
                ga[:, i] += g
    C = v[:, m.C]
    for x, (f, a) in enumerate(ext):
        i, j, g = f.extra[0], m.n + x, np.maximum(a, 1e-6)
        C = np.concatenate([C, np.full((P, 1), f.extra[1])], 1)
        for A in (Aon, Aoff):
            A[:, i, i] -= g
            A[:, j, j] -= g
            A[:, i, j] += g
            A[:, j, i] += g
    lam = max(np.abs(np.linalg.eigvals(A / C[:, :, None])).max() for A in (Aon, Aoff))
    sub = max(1, int(math.ceil(R.dt * lam / 0.45 * hsub)))
    h = R.dt / sub
    dyn = [(f, a) for f, a in live if f.qdyn]
    for f, a in live:
        if f.begin:
            f.begin(c, a)
    cap = [(f, a) for f, a in live if f.cap]
    gx = []
    for f, a in live:
        if f.gx:
            gx += f.gx(c, a)          # (i, j or -1, rows x P)
    if m.start == "ambient":
        T = np.repeat(c.amb[0][:, None], n, 1)
    elif m.start == "steady":
        qs = np.zeros((P, n))
        for hh in m.heats:
            if hh["kind"] == "const" and hh["run"] == "always":
                qs[:, hh["b"]] += v[:, hh["p"]]
            if hh["kind"] == "servo" and "idle" in hh:
                qs[:, hh["b"]] += v[:, hh["idle"]]
        T = np.linalg.solve(-Aoff, (qs + goff * c.amb[0][:, None])[..., None])[..., 0]
    else:
        T = np.full((P, n), float(m.start))
    out = np.empty((N, P, n))
    fan = any(l[3] for l in m.links)
    for k in range(N):
        out[k] = T
        c.k = k
        for f, a in live:
            if f.row:
                f.row(c, a, k, T)
        if k == N - 1:
            break
        on = R.speed[k] > 0
        A, ga = (Aon, gon) if on else (Aoff, goff)
        qk, a0, a1 = q[k], c.amb[k], c.amb[k + 1]
        frk = [(b, p[k], d) for b, p, d in fr if p[k].any()]
        gxk = [(i, j, g[k]) for i, j, g in gx if g[k].any()]

        def rhs(t, T):
            am = a0 + (a1 - a0) * (t / R.dt)
            w = np.matmul(A, T[..., None])[..., 0] + qk + ga * am[:, None]
            for b, p, d in frk:
                w[:, b] += p * np.exp(-d * (T[:, b] - 20.))
            for i, j, g in gxk:
                if j < 0:
                    w[:, i] += g * (am - T[:, i])
                else:
                    fl = g * (T[:, j] - T[:, i])
                    w[:, i] += fl
                    w[:, j] -= fl
            for f, a in dyn:
                f.qdyn(c, a, k, R.t[k] + t, T, am, w)
            Ce = C
            for f, a in cap:
                Ce = f.cap(c, a, T, Ce)
            return w / Ce

        for s_ in range(sub):
            t = s_ * h
            k1 = rhs(t, T)
            k2 = rhs(t + h / 2, T + h / 2 * k1)
            k3 = rhs(t + h / 2, T + h / 2 * k2)
            k4 = rhs(t + h, T + h * k3)
            T = T + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    c.T = out
    Y = {}
    for s, b in m.sens:
        Y[s] = out[:, :, b].copy()
    for d, se in m.disp:
        Y[d] = sum(v[:, p] * (out[:, :, b] - m.tref) for b, p in se)
    c.Y = Y
    for f, a in live:
        if f.post:
            f.post(c, a)
    return out, Y


# -------------------------------------------------------------------------------------------------------------- faults
class Fault:
    extra = vals = speed = ambient = qrow = begin = qdyn = cap = gx = row = post = None
    lo, hi, unit = .05, .6, ""


def st(q, place, *follows):
    return [dict(quantity=q, place=list(place), follows=f) for f in follows]


def some_records(rng, nrec, f, p_all=.62):
    f.recs = set(range(nrec))
    f.when = "in all records"
    if nrec > 1 and rng.random() > p_all:
        if rng.random() < .5:
            k = int(rng.integers(nrec))
            f.recs = {k}
            f.when = "in record %d alone" % (k + 1)
        else:
            k = int(rng.integers(1, nrec))
            f.recs = set(range(k, nrec))
            f.when = "from record %d on" % (k + 1)


def pick_body(rng, m, measured=.85, air=False):
    sb = [b for _, b in m.sens if air or m.bodies[b] not in m.air]
    ot = [i for i in range(m.n) if i not in [b for _, b in m.sens] and m.bodies[i] not in m.air]
    if ot and rng.random() > measured:
        return ot[int(rng.integers(len(ot)))]
    return sb[int(rng.integers(len(sb)))]


def window(rng, recs, f):
    """one window of time in minutes, the same in each record that it is in, inside the shortest of them"""
    T = min(recs[r].n * recs[r].dt for r in f.recs)
    a = U(rng, .12, .6) * T
    b = a + U(rng, .15, .35) * T
    if rng.random() < .25:
        b = 1e9
    return round(a / 60) * 60., (round(b / 60) * 60. if b < 1e8 else b)


def wtext(w):
    return "from %.0f min %s" % (w[0] / 60, "until %.0f min" % (w[1] / 60) if w[1] < 1e8 else "on")


def inwin(R, w):
    return ((R.t >= w[0]) & (R.t < w[1])).astype(float)


def starts(R):
    on = R.speed > 0
    return np.cumsum(on & ~np.concatenate([[False], on[:-1]]))


def lagged(x, R, tau, x0=0.):
    y, out = x0, np.empty_like(x)
    e = math.exp(-R.dt / tau)
    for k in range(len(x)):
        out[k] = y
        y = x[k] + (y - x[k]) * e
    return out


def speed_bodies(m):
    return {h["b"] for h in m.heats if h["kind"] in ("src", "fric", "motor") or (h["kind"] == "const" and h["run"] == "running")}


def only_speed(m):
    return all(h["kind"] in ("src", "fric", "motor") for h in m.heats)


def F_heat(kind):
    def make(rng, m, recs):
        f = Fault()
        some_records(rng, len(recs), f)
        b = pick_body(rng, m)
        nm = m.bodies[b]
        f.lo, f.hi = .03 * m.Pref, .6 * m.Pref
        e = U(rng, 1.3, 2.6)
        sgn = -1. if kind in ("constant", "window") and rng.random() < .2 else 1.
        if kind == "constant":
            shape, tx, fo = (lambda R: np.ones(R.n)), "constant heat", "constant"
        elif kind == "running":
            shape, tx, fo = (lambda R: (R.speed > 0) * 1.), "heat while the spindle turns, whatever its speed", "running"
        elif kind == "speed":
            shape, tx, fo = (lambda R: (R.speed / m.top) ** e), "heat by the power %.2f of speed, at %g rpm" % (e, m.top), "power of speed"
        elif kind == "column":
            c = [("feed_" + a, m.feeds[a], (lambda R, a=a: R.feed[a])) for a in m.feeds]
            if m.cut:
                c.append(("cutting_power", m.cut, lambda R: R.cut))
            if m.col:
                c.append((m.col[0].rsplit("_", 1)[0], m.col[1], lambda R: R.col))
            if not c:
                return None
            nme, top, g = c[int(rng.integers(len(c)))]
            e = 1. if rng.random() < .6 else U(rng, 1.5, 2.2)
            shape, tx, fo = (lambda R: (g(R) / top) ** e), "heat by the power %.2f of %s, at %g" % (e, nme, top), "power of " + nme
        elif kind == "window":
            w = window(rng, recs, f)
            shape, tx, fo = (lambda R: inwin(R, w)), "heat " + wtext(w), "window"
        elif kind == "since":
            tau = U(rng, .12, .4) * min(R.n * R.dt for R in recs)
            shape, tx, fo = (lambda R: np.exp(-R.t / tau)), "heat that fades from the start of each record, to 37 %% in %.0f min" % (tau / 60), "since start"
        if kind == "temperature":
            y = pick_body(rng, m, 1.) if rng.random() < .5 else b
            f.lo, f.hi = .003 * m.Pref, .035 * m.Pref
            f.qdyn = lambda c, a, k, t, T, am, wv: wv.__setitem__((slice(None), b), wv[:, b] + a * (T[:, y] - m.tref))
            tx, fo = "heat that grows with the temperature of %s over %g degC" % (m.bodies[y], m.tref), "temperature of " + m.bodies[y]
            f.unit = "W/K"
            f.statements = st("heat", [nm], fo) + (st("exchange", [nm, "ambient"], "constant") if y == b else [])
        else:
            f.qrow = lambda c, a: c.q.__setitem__((slice(None), slice(None), b), c.q[:, :, b] + sgn * shape(c.R)[:, None] * a)
            f.unit = "W"
            f.statements = st("heat", [nm], fo)
            if kind == "speed" and only_speed(m) and len(speed_bodies(m)) == 1 and b in speed_bodies(m):
                f.statements += st("speed", ["spindle"], "constant")
        f.text = lambda a: "%s in %s: %.3g %s, %s" % (tx, nm, sgn * a, f.unit, f.when)
        f.key = ("heat", nm)
        return f
    return make


def F_exch(kind):
    def make(rng, m, recs):
        f = Fault()
        some_records(rng, len(recs), f)
        ls = [l for l in m.links if not l[3]]
        if kind == "window" or kind == "running":
            ls = [l for l in ls if l[1] < 0]
        l = ls[int(rng.integers(len(ls)))]
        pl = linkname(m, l)
        if kind == "constant":
            sg_ = 1. if rng.random() < .5 else -1.
            f.lo, f.hi = .4, 1.2

            def vals(v, a):
                v[:, l[2]] *= np.exp(sg_ * a)
            f.vals = vals
            f.statements = st("exchange", pl, "constant")
            amb = [x for x in m.links if x[1] < 0 and not x[3]]
            if l[1] < 0 and len(amb) == 1:
                f.statements += st("exchange", ["all"], "constant")
            f.text = lambda a: "exchange of %s and %s times %.3g, %s" % (pl[0], pl[1], math.exp(sg_ * a), f.when)
        else:
            G = m.par[l[2]][1]
            f.lo, f.hi = .3 * G, 3. * G
            e = float(rng.choice([0., U(rng, .6, 1.2)]))
            if kind == "window":
                w = window(rng, recs, f)
                shape, tx, fo = (lambda R: inwin(R, w)), wtext(w), ["window"]
            elif e:
                shape, tx, fo = (lambda R: (R.speed / m.top) ** e), "by the power %.2f of speed, at %g rpm" % (e, m.top), ["power of speed", "running"]
            else:
                shape, tx, fo = (lambda R: (R.speed > 0) * 1.), "while the spindle turns", ["running"]
            f.gx = lambda c, a: [(l[0], l[1], shape(c.R)[:, None] * a[None, :])]
            f.statements = st("exchange", pl, *fo)
            f.text = lambda a: "further exchange of %s and %s of %.3g W/K %s, %s" % (pl[0], pl[1], a, tx, f.when)
        f.key = ("exchange", pl[0])
        return f
    return make


def F_capacity(rng, m, recs):
    f = Fault()
    some_records(rng, len(recs), f, .9)
    b = pick_body(rng, m)
    s_ = 1. if rng.random() < .7 else -1.
    f.lo, f.hi = .35, 1.1

    def vals(v, a):
        v[:, m.C[b]] *= np.exp(s_ * a)
    f.vals = vals
    f.statements = st("capacity", [m.bodies[b]], "constant")
    f.text = lambda a: "capacity of %s times %.3g, %s" % (m.bodies[b], math.exp(s_ * a), f.when)
    f.key = ("capacity", m.bodies[b])
    return f


def F_reading(kind):
    def make(rng, m, recs):
        f = Fault()
        some_records(rng, len(recs), f)
        s, b = m.sens[int(rng.integers(len(m.sens)))]
        sg_ = 1. if rng.random() < .5 else -1.
        f.lo, f.hi, f.unit = .08, 3., "K"
        e = U(rng, 1., 2.2)
        add = None
        acc = []
        if kind == "constant":
            add, tx, fo = (lambda c: np.ones((c.R.n, 1))), "wrong by", "constant"
        elif kind == "running":
            add, tx, fo = (lambda c: (c.R.speed > 0)[:, None] * 1.), "wrong while the spindle turns by", "running"
        elif kind == "speed":
            add, tx, fo = (lambda c: (c.R.speed / m.top)[:, None] ** e), "wrong by the power %.2f of speed, at %g rpm by" % (e, m.top), "power of speed"
        elif kind == "window":
            w = window(rng, recs, f)
            add, tx, fo = (lambda c: inwin(c.R, w)[:, None]), "wrong %s by" % wtext(w), "window"
        elif kind == "since":
            add, tx, fo = (lambda c: c.R.t[:, None] / (c.R.n * c.R.dt)), "drifts evenly from the start of the record, at its end by", "since start"
        elif kind == "ambient":
            f.lo, f.hi, f.unit, sg_ = .04, .5, "of the difference to the ambient", -1.
            add, tx, fo = (lambda c: c.T[:, :, b] - c.amb), "loses touch and reads the air too, by a share of", "temperature of ambient"
            acc = st("reading", [s], "temperature of " + m.bodies[b])

        def post(c, a):
            c.Y[s] = c.Y[s] + sg_ * a * add(c)
        f.post = post
        f.statements = st("reading", [s], fo) + acc
        f.text = lambda a: "thermometer %s on %s %s %.3g %s, %s" % (s, m.bodies[b], tx, sg_ * a if kind != "ambient" else a, f.unit, f.when)
        f.key = ("reading", m.bodies[b])
        return f
    return make


def F_disp(kind):
    def make(rng, m, recs):
        if not m.disp:
            return None
        f = Fault()
        some_records(rng, len(recs), f)
        d, se = m.disp[int(rng.integers(len(m.disp)))]
        sg_ = 1. if rng.random() < .5 else -1.
        f.lo, f.hi = 3 * recs[0].nU, 60 * recs[0].nU
        f.unit = "um"
        e = U(rng, 1.6, 2.2)
        if kind == "speed":
            add, tx, fo = (lambda c: (c.R.speed / m.top)[:, None] ** e), "at once by the power %.2f of speed, at %g rpm" % (e, m.top), "power of speed"
        elif kind == "window":
            w = window(rng, recs, f)
            add, tx, fo = (lambda c: inwin(c.R, w)[:, None]), "shifted " + wtext(w), "window"
        elif kind == "since":
            add, tx, fo = (lambda c: c.R.t[:, None] / (c.R.n * c.R.dt)), "drifts evenly from the start of a record, in all", "since start"
        elif kind == "temperature":
            b = int(rng.integers(m.n))
            f.lo, f.hi, f.unit = .3, 6., "um/K"
            add, tx, fo = (lambda c: c.T[:, :, b] - m.tref), "by the temperature of %s besides" % m.bodies[b], "temperature of " + m.bodies[b]

        def post(c, a):
            c.Y[d] = c.Y[d] + sg_ * a * add(c)
        f.post = post
        f.statements = st("displacement", [d], fo)
        f.text = lambda a: "displacement %s moves %s: %.3g %s, %s" % (d, tx, sg_ * a, f.unit, f.when)
        f.key = ("displacement", d)
        return f
    return make


def F_ambient(kind):
    def make(rng, m, recs):
        f = Fault()
        some_records(rng, len(recs), f, .4)
        sg_ = 1. if rng.random() < .6 else -1.
        f.lo, f.hi = .9, 4.
        if kind == "constant":
            sh, tx, fo = (lambda R: np.ones(R.n)), "at all times", "constant"
        elif kind == "window":
            w = window(rng, recs, f)
            sh, tx, fo = (lambda R: inwin(R, w)), wtext(w), "window"
        elif kind == "running":
            sh, tx, fo = (lambda R: (R.speed > 0) * 1.), "while the spindle turns", "running"

        def ambient(c, a):
            c.amb = c.amb + sg_ * a[None, :] * sh(c.R)[:, None]
        f.ambient = ambient
        f.statements = st("ambient", ["hall"], fo)
        f.text = lambda a: "ambient truly %+.2f K from what is recorded, %s, %s" % (sg_ * a, tx, f.when)
        f.key = ("ambient", "hall")
        return f
    return make


def F_speed(kind):
    def make(rng, m, recs):
        f = Fault()
        some_records(rng, len(recs), f)
        sg_ = 1. if rng.random() < .35 else -1.
        f.lo, f.hi = .05, .4
        w = window(rng, recs, f) if kind == "window" else None

        def speed(c, a):
            x = sg_ * a[None, :] * (inwin(c.R, w)[:, None] if w else 1.)
            c.speed = c.speed * (1 + x)
        f.speed = speed
        f.statements = st("speed", ["spindle"], kind)
        if only_speed(m):
            f.statements += st("heat", ["all"], kind, "power of speed")
        sb = speed_bodies(m)
        if len(sb) == 1:
            f.statements += st("heat", [m.bodies[list(sb)[0]]], "power of speed", kind)
        f.text = lambda a: "spindle truly turns at %.3f times the recorded speed%s, %s" % (1 + sg_ * a, " " + wtext(w) if w else "", f.when)
        f.key = ("speed", "spindle")
        return f
    return make


def F_clock(rng, m, recs):
    f = Fault()
    some_records(rng, len(recs), f)
    f.lo, f.hi = 60., 1500.

    def post(c, a):
        for s in c.Y:
            y = c.Y[s].copy()
            for p in np.nonzero(a)[0]:
                y[:, p] = np.interp(c.R.t - a[p], c.R.t, c.Y[s][:, p])
            c.Y[s] = y
    f.post = post
    f.statements = st("clock", ["clock"], "constant")
    f.text = lambda a: "all readings are stamped %.1f min late against the drive, %s" % (a / 60, f.when)
    f.key = ("clock", "clock")
    f.clock = True
    return f


def F_all(what):
    def make(rng, m, recs):
        f = Fault()
        some_records(rng, len(recs), f, .5)
        sg_ = 1. if rng.random() < .5 else -1.
        f.lo, f.hi = .2, .8
        if what == "heat":
            ps = [h[k] for h in m.heats for k in ("p", "idle", "share", "g") if k in h]
            f.statements = st("heat", ["all"], "constant")
            if only_speed(m):
                f.statements += st("speed", ["spindle"], "constant")
        else:
            ps = [l[2] for l in m.links if l[1] < 0]
            f.statements = st("exchange", ["all"], "constant")
            if len(ps) == 1:
                l = [l for l in m.links if l[1] < 0][0]
                f.statements += st("exchange", linkname(m, l), "constant")

        def vals(v, a):
            for p in ps:
                v[:, p] *= np.exp(sg_ * a)
        f.vals = vals
        f.text = lambda a: "%s times %.3g, %s" % ("all heats" if what == "heat" else "all exchange with the ambient", math.exp(sg_ * a), f.when)
        f.key = (what, "all")
        return f
    return make


# ---- from outside of the grammar
def base(rng, recs, p_all=.8):
    f = Fault()
    some_records(rng, len(recs), f, p_all)
    f.alien = True
    return f


def two(rng, m):
    a = pick_body(rng, m, 1.)
    o = [b for _, b in m.sens if b != a]
    return a, o[int(rng.integers(len(o)))]


def add_w(f, b, fun):
    def qdyn(c, a, k, t, T, am, w):
        w[:, b] += fun(c, a, k, t, T, am)
    f.qdyn = qdyn


def X_difference(rng, m, recs):                      # preload by a difference of two bodies
    f = base(rng, recs)
    y, z = two(rng, m)
    b = y if rng.random() < .6 else pick_body(rng, m, 1.)
    e = U(rng, .8, 1.4)
    f.lo, f.hi = .006 * m.Pref, .08 * m.Pref
    add_w(f, b, lambda c, a, k, t, T, am: a * (c.R.speed[k] / m.top) ** e * np.clip(T[:, y] - T[:, z], 0, None))
    n = m.bodies
    f.text = lambda a: "heat in %s that grows with the difference %s - %s (where positive) and the power %.2f of speed: %.3g W/K at %g rpm, %s" % (n[b], n[y], n[z], e, a, m.top, f.when)
    f.statements = st("heat", [n[b]], "difference of temperatures of %s and %s" % (n[y], n[z]), "temperature of " + n[y], "temperature of " + n[z], "unknown", "running", "power of speed")
    f.key = ("heat", n[b])
    return f


def X_band(rng, m, recs):                            # heat in a band of speeds alone
    f = base(rng, recs)
    b = pick_body(rng, m)
    v = sorted({x for R in recs for x in R.speed if x > 0})
    if len(v) < 3:
        return None
    mid = v[int(rng.integers(0, len(v) - 1))]
    f.lo, f.hi = .04 * m.Pref, .6 * m.Pref

    def qrow(c, a):
        c.q[:, :, b] += (np.abs(c.R.speed - mid) < .04 * m.top)[:, None] * a
    f.qrow = qrow
    f.text = lambda a: "resonance: heat in %s only at speeds within %.0f rpm of %g rpm: %.3g W, %s" % (m.bodies[b], .04 * m.top, mid, a, f.when)
    f.statements = st("heat", [m.bodies[b]], "band of speed", "unknown", "power of speed", "running", "window")
    f.key = ("heat", m.bodies[b])
    return f


def X_hyst(rng, m, recs):                            # comes with warmth, goes only well below
    f = base(rng, recs)
    b = pick_body(rng, m, 1.)
    up, dn = U(rng, .5, .8), U(rng, .15, .4)
    f.lo, f.hi = .04 * m.Pref, .5 * m.Pref

    def begin(c, a):
        c.hyst = np.zeros(c.P)

    def row(c, a, k, T):
        g = f.scale
        hi, lo = m.f0 + up * g[b], m.f0 + dn * g[b]
        c.hyst = np.where(T[:, b] > hi, 1., np.where(T[:, b] < lo, 0., c.hyst))
    f.begin, f.row = begin, row
    add_w(f, b, lambda c, a, k, t, T, am: a * c.hyst * (c.R.speed[k] > 0))
    f.text = lambda a: "seal that drags once %s is above %.1f degC until it is below %.1f degC: %.3g W in it while the spindle turns, %s" % (
        m.bodies[b], m.f0 + up * f.scale[b], m.f0 + dn * f.scale[b], a, f.when)
    f.statements = st("heat", [m.bodies[b]], "hysteresis of temperature of " + m.bodies[b], "temperature of " + m.bodies[b], "unknown", "window", "running")
    f.key = ("heat", m.bodies[b])
    return f


def X_linkT(rng, m, recs):                           # a conductance that depends on temperature
    f = base(rng, recs)
    ls = [l for l in m.links if not l[3] and l[1] >= 0]
    l = ls[int(rng.integers(len(ls)))]
    s_ = 1. if rng.random() < .6 else -1.
    G = m.par[l[2]][1]
    f.lo, f.hi = .02, .15

    def qdyn(c, a, k, t, T, am, w):
        i, j = l[0], l[1]
        g = G * np.clip(s_ * a * ((T[:, i] + T[:, j]) / 2 - m.tref), -.85, 3.)
        fl = g * (T[:, j] - T[:, i])
        w[:, i] += fl
        w[:, j] -= fl
    f.qdyn = qdyn
    pl = linkname(m, l)
    f.text = lambda a: "conductance of %s - %s changes by %.3g of itself for each kelvin of their mean temperature over %g degC, %s" % (pl[0], pl[1], s_ * a, m.tref, f.when)
    f.statements = st("exchange", pl, "temperature of both", "temperature of " + pl[0], "temperature of " + pl[1], "unknown", "constant")
    f.key = ("exchange", pl[0])
    return f


def X_third(rng, m, recs):                           # only from the third start on
    f = base(rng, recs)
    ok = [r for r in range(len(recs)) if starts(recs[r]).max() >= 3]
    if not ok:
        return None
    f.recs = set(ok)
    b = pick_body(rng, m)
    f.lo, f.hi = .05 * m.Pref, .7 * m.Pref

    def qrow(c, a):
        c.q[:, :, b] += ((starts(c.R) == 3) & (c.R.speed > 0))[:, None] * a
    f.qrow = qrow
    f.text = lambda a: "heat in %s only during the third running of the spindle in a record: %.3g W" % (m.bodies[b], a)
    f.statements = st("heat", [m.bodies[b]], "third start", "window", "unknown", "running")
    f.key = ("heat", m.bodies[b])
    return f


def X_n2lag(rng, m, recs):                           # thermometer, speed squared with a lag
    f = base(rng, recs)
    s, b = m.sens[int(rng.integers(len(m.sens)))]
    tau = U(rng, .03, .15) * min(R.n * R.dt for R in recs)
    sg_ = 1. if rng.random() < .6 else -1.
    f.lo, f.hi = .1, 3.

    def post(c, a):
        c.Y[s] = c.Y[s] + sg_ * a * lagged((c.R.speed / m.top) ** 2, c.R, tau)[:, None]
    f.post = post
    f.text = lambda a: "thermometer %s on %s wrong by the square of speed behind a lag of %.1f min: %.3g K at %g rpm, %s" % (s, m.bodies[b], tau / 60, sg_ * a, m.top, f.when)
    f.statements = st("reading", [s], "square of speed behind a lag", "power of speed", "unknown", "running")
    f.key = ("reading", m.bodies[b])
    return f


def X_melt(rng, m, recs):                            # latent heat within a body
    f = base(rng, recs, 1.)
    b = pick_body(rng, m, 1.)
    fr, wd = U(rng, .35, .65), U(rng, .8, 1.6)
    C = m.nom[m.C[b]]
    f.lo, f.hi = 2., 25.                              # in K of the body's own heat capacity

    def cap(c, a, T, Ce):
        Tm = m.f0 + fr * f.scale[b]
        x = np.exp(-.5 * ((T[:, b] - Tm) / wd) ** 2) / (wd * math.sqrt(2 * PI))
        Ce = Ce.copy()
        Ce[:, b] = Ce[:, b] + C * a * x
        return Ce
    f.cap = cap
    n = m.bodies[b]
    f.text = lambda a: "filling of %s melts about %.1f degC (width %.1f K) and stores %.3g kJ there, %s" % (n, m.f0 + fr * f.scale[b], wd, a * C / 1e3, f.when)
    f.statements = st("capacity", [n], "melting at a temperature", "temperature of " + n, "unknown", "constant") + st("heat", [n], "unknown")
    f.key = ("capacity", n)
    return f


def X_fans(rng, m, recs):                            # two fans on two thermostats
    f = base(rng, recs)
    b = pick_body(rng, m, 1.)
    o = [x for _, x in m.sens if x != b]
    y = o[int(rng.integers(len(o)))]
    u1, u2 = U(rng, .3, .5), U(rng, .6, .8)
    G = sum(m.nom[l[2]] for l in m.links if b in l[:2])
    f.lo, f.hi = .08 * G, 1. * G

    def begin(c, a):
        c.f1, c.f2 = np.zeros(c.P), np.zeros(c.P)

    def row(c, a, k, T):
        g = f.scale
        for nme, x, u in (("f1", b, u1), ("f2", y, u2)):
            on, off = m.f0 + u * g[x], m.f0 + (u - .15) * g[x]
            setattr(c, nme, np.where(T[:, x] > on, 1., np.where(T[:, x] < off, 0., getattr(c, nme))))
    f.begin, f.row = begin, row
    add_w(f, b, lambda c, a, k, t, T, am: a * (c.f1 + .7 * c.f2) * (am - T[:, b]))
    n = m.bodies
    f.text = lambda a: "two fans blow on %s: one (%.3g W/K) by its own temperature, one (%.3g W/K) by that of %s, %s" % (n[b], a, .7 * a, n[y], f.when)
    f.statements = st("exchange", [n[b], "ambient"], "two thermostats", "temperature of " + n[b], "temperature of " + n[y], "unknown", "window", "constant", "running") + st("heat", [n[b]], "unknown")
    f.key = ("exchange", n[b])
    return f


def X_wander(rng, m, recs):                          # a heat that wanders
    f = base(rng, recs)
    b = pick_body(rng, m, 1.)
    W = {}
    for r, R in enumerate(recs):
        tau = U(rng, .06, .2) * R.n * R.dt
        e = math.exp(-R.dt / tau)
        x, z = rng.normal(), rng.normal(size=R.n)
        o = np.empty(R.n)
        for k in range(R.n):
            o[k] = x
            x = e * x + math.sqrt(1 - e * e) * z[k]
        W[id(R)] = o
    f.lo, f.hi = .05 * m.Pref, .6 * m.Pref

    def qrow(c, a):
        c.q[:, :, b] += W[id(c.R)][:, None] * a
    f.qrow = qrow
    f.text = lambda a: "heat in %s wanders at random with a standard deviation of %.3g W, %s" % (m.bodies[b], a, f.when)
    f.statements = st("heat", [m.bodies[b]], "unknown", "window")
    f.key = ("heat", m.bodies[b])
    return f


def X_neighbour(rng, m, recs):                       # radiation of an oven next door
    f = base(rng, recs)
    b = pick_body(rng, m, 1.)
    T0, tr, td = U(rng, 120, 260), U(rng, .1, .4), U(rng, .2, .4)
    f.lo, f.hi = .03, 1.5                             # m^2

    def Th(c, t):
        D = c.R.n * c.R.dt
        up = np.clip((t - tr * D) / (.15 * D), 0, 1) * (t < (tr + td) * D) + (t >= (tr + td) * D) * math.exp(-max(0, t - (tr + td) * D) / (.12 * D))
        return m.f0 + (T0 - m.f0) * up
    f.lo, f.hi = .002 * m.Pref / 10, .08 * m.Pref / 10
    add_w(f, b, lambda c, a, k, t, T, am: a * 5.67e-8 * ((Th(c, t) + 273.15) ** 4 - (m.f0 + 273.15) ** 4) * 1. - a * 5.67e-8 * ((T[:, b] + 273.15) ** 4 - (m.f0 + 273.15) ** 4))
    n = m.bodies[b]
    f.text = lambda a: "radiation to a furnace beside the machine (%.0f degC from %.0f %% of each record on, for a while): %.3g m^2 of %s, %s" % (T0, 100 * tr, a, n, f.when)
    f.statements = st("exchange", [n, "furnace"], "radiation to a body that is not in the model") + st("heat", [n], "unknown", "window", "since start")
    f.key = ("heat", n)
    return f


def X_beltslip(rng, m, recs):                        # belt slips as it warms
    f = base(rng, recs)
    sb = [b for b in speed_bodies(m)]
    meas = [b for b in sb if b in [x for _, x in m.sens]]
    if not meas:
        return None
    y = meas[int(rng.integers(len(meas)))]
    f.lo, f.hi = .03, .5                              # share lost at the body's full rise
    hs = [h for h in m.heats if h["kind"] in ("src", "fric", "motor")]

    def qdyn(c, a, k, t, T, am, w):
        n0 = c.speed[k]
        if n0[0] <= 0:
            return
        s_ = np.clip(a * (T[:, y] - m.f0 - .2 * f.scale[y]) / f.scale[y], 0, .7)
        for h in hs:
            p1, p0 = heat_law(h, c.v, n0 * (1 - s_), m, c.R, k), heat_law(h, c.v, n0, m, c.R, k)
            d = p1 - p0
            if h["kind"] == "fric":
                d = d * np.exp(-c.v[:, h["dec"]] * (T[:, h["b"]] - 20.))
            w[:, h["b"]] += d
    f.qdyn = qdyn
    n = m.bodies
    f.text = lambda a: "belt slips the more the warmer %s is: true speed lower by up to %.3g of itself, %s" % (n[y], a, f.when)
    f.statements = st("speed", ["spindle"], "temperature of " + n[y], "unknown", "constant", "window")
    f.statements += st("heat", ["all"], "unknown", "temperature of " + n[y], "power of speed") if only_speed(m) else []
    if len(sb) == 1:
        f.statements += st("heat", [n[y]], "temperature of " + n[y], "unknown", "power of speed", "running")
    f.key = ("speed", "spindle")
    return f


def X_natural(rng, m, recs):                         # loss by free convection, with a power of the difference
    f = base(rng, recs)
    ls = [l for l in m.links if l[1] < 0 and not l[3] and l[0] in [b for _, b in m.sens]]
    if not ls:
        return None
    l = ls[int(rng.integers(len(ls)))]
    b, e = l[0], U(rng, .5, 1.2)
    G = m.par[l[2]][1]
    f.lo, f.hi = .15 * G, 2.5 * G
    add_w(f, b, lambda c, a, k, t, T, am: a * (np.abs(am - T[:, b]) / 10.) ** e * (am - T[:, b]))
    n = m.bodies[b]
    f.text = lambda a: "%s loses heat to the ambient by a power %.2f of the temperature difference besides: %.3g W/K at 10 K, %s" % (n, 1 + e, a, f.when)
    f.statements = st("exchange", [n, "ambient"], "power of the difference", "temperature of " + n, "unknown", "constant")
    f.key = ("exchange", n)
    return f


def X_chirp(rng, m, recs):                           # coolant pulses at a growing period
    f = base(rng, recs)
    b = pick_body(rng, m, 1.)
    p0, gr, du = U(rng, .05, .1), U(rng, 1.15, 1.5), U(rng, .3, .6)
    f.lo, f.hi = .06 * m.Pref, .8 * m.Pref

    def qrow(c, a):
        D = c.R.n * c.R.dt
        x, t, p = np.zeros(c.R.n), .1 * D, p0 * D
        while t < D:
            x[(c.R.t >= t) & (c.R.t < t + du * p)] = 1
            t += p
            p *= gr
        c.q[:, :, b] -= x[:, None] * a
    f.qrow = qrow
    f.text = lambda a: "a leaking valve lets coolant over %s in pulses that come ever more rarely: -%.3g W, %s" % (m.bodies[b], a, f.when)
    f.statements = st("heat", [m.bodies[b]], "pulses of a growing period", "unknown", "window", "since start") + st("exchange", [m.bodies[b], "ambient"], "unknown", "window")
    f.key = ("heat", m.bodies[b])
    return f


def X_play(rng, m, recs):                            # a displacement with play
    if not m.disp:
        return None
    f = base(rng, recs)
    d, se = m.disp[int(rng.integers(len(m.disp)))]
    b = se[int(rng.integers(len(se)))][0]
    f.lo, f.hi = .5, 10.

    def post(c, a):
        w = .25 * f.scale[b]
        x = c.T[:, :, b]
        y = np.empty_like(x)
        p = x[0].copy()
        for k in range(len(x)):
            p = np.clip(p, x[k] - w / 2, x[k] + w / 2)
            y[k] = p
        c.Y[d] = c.Y[d] + a * (y - x[0])
    f.post = post
    f.text = lambda a: "displacement %s follows %s through a clamp with play of %.2f K: %.3g um/K, %s" % (d, m.bodies[b], .25 * f.scale[b], a, f.when)
    f.statements = st("displacement", [d], "hysteresis of temperature of " + m.bodies[b], "temperature of " + m.bodies[b], "unknown")
    f.key = ("displacement", d)
    return f


def X_ratchet(rng, m, recs):                         # a step with every start
    if not m.disp:
        return None
    f = base(rng, recs)
    if max(starts(R).max() for R in recs) < 2:
        return None
    d, se = m.disp[int(rng.integers(len(m.disp)))]
    sg_ = 1. if rng.random() < .5 else -1.
    f.lo, f.hi = 1.5 * recs[0].nU, 30 * recs[0].nU

    def post(c, a):
        c.Y[d] = c.Y[d] + sg_ * a * starts(c.R)[:, None]
    f.post = post
    f.text = lambda a: "displacement %s jumps by %.3g um with each start of the spindle and stays there, %s" % (d, sg_ * a, f.when)
    f.statements = st("displacement", [d], "count of starts", "unknown", "since start", "window")
    f.key = ("displacement", d)
    return f


def X_clip(rng, m, recs):                            # a thermometer that saturates
    f = base(rng, recs)
    s, b = m.sens[int(rng.integers(len(m.sens)))]
    f.lo, f.hi = .15, .75

    def post(c, a):
        lim = m.f0 + (1 - a) * f.scale[b]
        y = c.Y[s]
        z = np.where(y > lim, lim + .08 * (y - lim), y)
        c.Y[s] = np.where(a > 0, z, y)
    f.post = post
    f.text = lambda a: "amplifier of %s on %s saturates above %.1f degC, %s" % (s, m.bodies[b], m.f0 + (1 - a) * f.scale[b], f.when)
    f.statements = st("reading", [s], "saturation", "temperature of " + m.bodies[b], "unknown", "window")
    f.key = ("reading", m.bodies[b])
    return f


def X_hidden(rng, m, recs):                          # a body nobody wrote down
    f = base(rng, recs)
    b = pick_body(rng, m, 1.)
    C = m.nom[m.C[b]] * U(rng, .6, 1.6)
    G = sum(m.nom[l[2]] for l in m.links if b in l[:2])
    f.lo, f.hi = .1 * G, 1.2 * G

    f.extra = (b, C)
    n = m.bodies[b]
    f.text = lambda a: "a body of %.3g kJ/K that nobody wrote down is clamped to %s by %.3g W/K, %s" % (C / 1e3, n, a, f.when)
    f.statements = st("exchange", [n, "hidden"], "constant") + st("capacity", [n], "constant", "unknown") + st("heat", [n], "unknown")
    f.key = ("capacity", n)
    return f


def X_moving(rng, m, recs):                          # a heat that moves from one body to another
    f = base(rng, recs)
    x, y = two(rng, m)
    f.lo, f.hi = .05 * m.Pref, .5 * m.Pref

    def qrow(c, a):
        s = np.clip((c.R.t / (c.R.n * c.R.dt) - .2) / .6, 0, 1)
        c.q[:, :, x] += ((1 - s) * (c.R.speed > 0))[:, None] * a
        c.q[:, :, y] += (s * (c.R.speed > 0))[:, None] * a
    f.qrow = qrow
    n = m.bodies
    f.text = lambda a: "a rubbing place that moves from %s to %s within each record: %.3g W while the spindle turns, %s" % (n[x], n[y], a, f.when)
    f.statements = st("heat", [n[x]], "moves from %s to %s" % (n[x], n[y]), "unknown", "since start", "running", "window") + st("heat", [n[y]], "unknown", "since start", "running", "window")
    f.key = ("heat", n[x])
    return f


def X_gust(rng, m, recs):                            # half of the machine is in other air
    f = base(rng, recs)
    bs = [l for l in m.links if l[1] < 0 and not l[3]]
    if len(bs) < 3:
        return None
    sel = [bs[i] for i in sorted(rng.permutation(len(bs))[:max(1, len(bs) // 2)])]
    per, ph = U(rng, .25, .7), rng.random()
    f.lo, f.hi = .8, 8.

    def qrow(c, a):
        D = c.R.n * c.R.dt
        s = np.clip(np.sin(2 * PI * (c.R.t / (per * D) + ph)), 0, None) ** 2
        for l in sel:
            c.q[:, :, l[0]] += s[:, None] * a * c.v[:, l[2]][None, :]
    f.qrow = qrow
    n = [m.bodies[l[0]] for l in sel]
    f.text = lambda a: "%s stand in sunlit air that is up to %.3g K warmer than the rest of the hall, in waves of %.0f %% of a record, %s" % (", ".join(n), a, 100 * per, f.when)
    f.statements = st("ambient", ["hall"], "for some bodies alone, in waves", "unknown", "window")
    for x in n:
        f.statements += st("heat", [x], "unknown", "window")
    f.key = ("ambient", "hall")
    return f


def X_lift(rng, m, recs):                            # a ring lifts off above a speed
    f = base(rng, recs)
    ls = [l for l in m.links if not l[3] and l[1] >= 0 and (l[0] in speed_bodies(m) or l[1] in speed_bodies(m))]
    v = sorted({x for R in recs for x in R.speed if x > 0})
    if not ls or len(v) < 2:
        return None
    l = ls[int(rng.integers(len(ls)))]
    lim = .5 * (v[-1] + v[-2])
    f.lo, f.hi = .3, .9
    f.gx = lambda c, a: [(l[0], l[1], -1. * (c.R.speed > lim)[:, None] * (a * c.v[:, l[2]])[None, :])]
    pl = linkname(m, l)
    f.text = lambda a: "seat between %s and %s opens above %.0f rpm: its conductance times %.2f there, %s" % (pl[0], pl[1], lim, 1 - a, f.when)
    f.statements = st("exchange", pl, "above a speed", "power of speed", "running", "unknown", "window")
    f.key = ("exchange", pl[0])
    return f


SAY = [("heat constant", F_heat("constant")), ("heat running", F_heat("running")), ("heat speed", F_heat("speed")), ("heat column", F_heat("column")),
       ("heat window", F_heat("window")), ("heat since start", F_heat("since")), ("heat temperature", F_heat("temperature")),
       ("exchange constant", F_exch("constant")), ("exchange window", F_exch("window")), ("exchange running", F_exch("running")),
       ("capacity", F_capacity), ("reading constant", F_reading("constant")), ("reading running", F_reading("running")), ("reading speed", F_reading("speed")),
       ("reading window", F_reading("window")), ("reading since start", F_reading("since")), ("reading ambient", F_reading("ambient")),
       ("displacement speed", F_disp("speed")), ("displacement window", F_disp("window")), ("displacement since start", F_disp("since")),
       ("displacement temperature", F_disp("temperature")), ("ambient constant", F_ambient("constant")), ("ambient window", F_ambient("window")),
       ("ambient running", F_ambient("running")), ("speed constant", F_speed("constant")), ("speed window", F_speed("window")), ("clock", F_clock),
       ("all heats", F_all("heat")), ("all losses", F_all("exchange"))]
OUT = [("x difference", X_difference), ("x speed band", X_band), ("x hysteresis heat", X_hyst), ("x link of temperature", X_linkT), ("x third start", X_third),
       ("x reading n2 lag", X_n2lag), ("x melting", X_melt), ("x two fans", X_fans), ("x wandering heat", X_wander), ("x furnace next door", X_neighbour),
       ("x belt slip", X_beltslip), ("x free convection", X_natural), ("x pulses", X_chirp), ("x play", X_play), ("x ratchet", X_ratchet), ("x saturation", X_clip),
       ("x hidden body", X_hidden), ("x moving heat", X_moving), ("x sunlit half", X_gust), ("x lifting ring", X_lift)]
KIND = dict(SAY + OUT)


# ---------------------------------------------------------------------------------------------------------------- size
def noise_of(m, R, ch):
    t = ch in [s for s, _ in m.sens]
    return math.hypot(R.nK if t else R.nU, (R.q if t else R.qU) / math.sqrt(12))


def pick_rows(R, n=70):
    return np.unique(np.linspace(0, R.n - 1, min(n, R.n)).astype(int))


class Sizer:
    """How much of a change no scatter within three sigmas can explain, in noise sigmas."""

    def __init__(s, m, recs, sims, theta, K, nrec):
        # variants: 0 truth, 1..K numbers moved by +0.5 sigma, K+1 ambient +0.3 K
        s.m, s.recs = m, recs
        blocks, s.rows = [], []
        for r, R in enumerate(recs):
            _, Y = sims[r]
            rows = pick_rows(R)
            s.rows.append(rows)
            for ch in Y:
                y = Y[ch][rows]
                w = noise_of(m, R, ch)
                J = np.zeros((len(rows), K + nrec))
                J[:, :K] = (y[:, 1:K + 1] - y[:, :1]) / .5 / w
                J[:, K + r] = (y[:, K + 1] - y[:, 0]) / w
                blocks.append(J)
        s.J = np.vstack(blocks)
        z = np.concatenate([theta, [R.aoff / .3 for R in recs]])
        s.lo, s.hi = -3 - np.clip(z, -2.9, 2.9), 3 - np.clip(z, -2.9, 2.9)
        s.z = z
        s.H = s.J.T @ s.J + np.eye(K + nrec)

    def __call__(s, dY):
        """dY[r][ch] (rows,) of all rows; the n-th largest residual of a channel in a record"""
        b, tags = [], []
        for r, R in enumerate(s.recs):
            for ch in dY[r]:
                d = dY[r][ch][s.rows[r]] / noise_of(s.m, R, ch)
                tags.append((len(b) and tags[-1][1] or 0, (len(b) and tags[-1][1] or 0) + len(d)))
                b.append(d)
        d = np.concatenate(b)
        L = np.linalg.cholesky(s.H)
        rhs = np.linalg.solve(L, s.J.T @ d - s.z)
        x = lsq_linear(L.T, rhs, bounds=(s.lo, s.hi), method="bvls", max_iter=200).x
        e = np.abs(d - s.J @ x)
        best = 0.
        for a, z in tags:
            q = np.sort(e[a:z])[::-1]
            best = max(best, q[min(len(q) - 1, max(4, len(q) // 12))])
        return best


def run_all(m, recs, val, aoffs, faults, amps):
    return [simulate(m, val, R, r, aoffs[r], faults, amps) for r, R in enumerate(recs)]


def try_case(rng, fam, kinds):
    m = draw_machine(rng, fam)
    u = rng.random()
    if u < .08:
        m.start = "given"
    elif u < .14 and m.col is None and any(h["kind"] == "const" or "idle" in h and h["kind"] == "servo" for h in m.heats):
        m.start = "steady"
    recs = draw_records(rng, m)
    K, nrec = len(m.par), len(recs)
    theta = rng.normal(size=K)
    tv = m.nom * np.exp(theta * m.sg)
    m.f0 = float(np.mean([R.amb.mean() for R in recs]))
    faults = []
    for kd in kinds:
        f = KIND[kd](rng, m, recs)
        if f is None:
            return None
        f.kind = kd
        faults.append(f)
    if len(faults) == 2 and (faults[0].key[0] == faults[1].key[0] or faults[0].key[1] == faults[1].key[1]):
        return None
    NA = 12
    # first the machine without any fault, with its sensitivities
    base_val = np.repeat(tv[None], K + 2, 0)
    for k in range(K):
        base_val[k + 1, k] *= math.exp(.5 * m.sg[k])
    off0 = [np.r_[np.full(K + 1, R.aoff), R.aoff + .3] for R in recs]
    sims = run_all(m, recs, base_val, off0, [], [])
    T = np.concatenate([s[0][:, 0] for s in sims])
    if T.max() > 140 or T.max() - m.f0 < 4:
        return None
    scale = np.maximum(2., np.percentile(T, 97, axis=0) - m.f0)
    chosen, sizes = [], []
    if faults:
        siz = Sizer(m, recs, sims, theta, K, nrec)
        for f in faults:
            f.scale = scale
            amps = np.geomspace(f.lo * LU(rng, .85, 1.2), f.hi * LU(rng, .75, 1.), NA)
            s2 = run_all(m, recs, np.repeat(tv[None], NA, 0), [np.full(NA, R.aoff) for R in recs], [f], [amps])
            if not all(np.isfinite(x[0]).all() and x[0].max() < 180 and x[0].min() > -20 for x in s2):
                ok = np.array([all(np.isfinite(x[0][:, p]).all() and x[0][:, p].max() < 180 and x[0][:, p].min() > -20 for x in s2) for p in range(NA)])
            else:
                ok = np.ones(NA, bool)
            sz = np.full(NA, np.nan)
            for p in range(NA):
                if ok[p]:
                    sz[p] = siz([{ch: s2[r][1][ch][:, p] - sims[r][1][ch][:, 0] for ch in s2[r][1]} for r in range(nrec)])
            target = LU(rng, 5, 22)
            good = np.nonzero(ok & (sz > 3.5) & (sz < 30))[0]
            if not len(good):
                return None
            p = good[np.argmin(np.abs(np.log(sz[good] / target)))]
            chosen.append(sig(amps[p], 4))
            sizes.append(float(sz[p]))
    final = run_all(m, recs, tv[None], [np.array([R.aoff]) for R in recs], faults, [np.array([a]) for a in chosen])
    if any(not np.isfinite(x[0]).all() or x[0].max() > 180 or x[0].min() < -20 for x in final):
        return None
    return m, recs, faults, chosen, sizes, final


# ------------------------------------------------------------------------------------------------------------- writing
def yaml_of(m, recs, name):
    P = lambda k: "%.4g" % m.par[k][1]
    L = ["name: " + name, "reference_temperature: %g degC" % m.tref,
         "start: " + (m.start if isinstance(m.start, str) else "%g degC" % m.start),
         "machine: {generator: lumped}", "effects:"]
    ex = {i: p for i, j, p, fan, air in m.links if air}
    for i, b in enumerate(m.bodies):
        if b in m.air:
            L.append("  - {type: air_node, node: %s, capacity: %s J/K, exchange: %s W/K}" % (b, P(m.C[i]), P(ex[i])))
        else:
            L.append("  - {type: node, node: %s, capacity: %s J/K}" % (b, P(m.C[i])))
    for i, j, p, fan, air in m.links:
        if not air:
            L.append("  - {type: link, node: %s, to: %s, conductance: %s W/K%s}" % (m.bodies[i], "ambient" if j < 0 else m.bodies[j], P(p), ", runs: while_spindle_turns" if fan else ""))
    for h in m.heats:
        b, k = m.bodies[h["b"]], h["kind"]
        if k == "src":
            L.append("  - {type: heat_source, node: %s, power: %s W, at_speed: %g rpm, exponent: %s}" % (b, P(h["p"]), m.top, P(h["e"])))
        elif k == "const":
            L.append("  - {type: heat_source, node: %s, power: %s W, runs: %s}" % (b, P(h["p"]), "always" if h["run"] == "always" else "while_spindle_turns"))
        elif k == "motor":
            L.append("  - {type: motor_loss, node: %s, power: %s W, at_speed: %g rpm, exponent: %s, idle: %s W}" % (b, P(h["p"]), m.top, P(h["e"]), P(h["idle"])))
        elif k == "fric":
            L.append("  - {type: friction_law, node: %s, power: %s W, at_speed: %g rpm, exponent: %s, decay: %s 1/K, at_temperature: 20 degC}" % (b, P(h["p"]), m.top, P(h["e"]), P(h["dec"])))
        elif k == "cut":
            L.append("  - {type: cutting_heat, node: %s, share: %s}" % (b, P(h["share"])))
        elif k == "servo":
            L.append("  - {type: servo_loss, node: %s, axis: %s, power: %s W, at_feed: %g mm/min, exponent: %s%s}" % (b, h["ax"], P(h["p"]), m.feeds[h["ax"]], P(h["e"]), ", idle: %s W" % P(h["idle"]) if "idle" in h else ""))
        elif k == "col":
            L.append("  - {type: recorded_drive, node: %s, gain: %s, column: %s}" % (b, P(h["g"]), m.col[0]))
    L.append("ambient: {csv: measured_1.csv, channel: ambient}")
    L.append("sensors:")
    L += ["  - {name: %s, node: %s}" % (s, m.bodies[b]) for s, b in m.sens]
    if m.disp:
        L.append("displacements:")
        for d, se in m.disp:
            L.append("  - {name: %s, sensitivities: [%s]}" % (d, ", ".join("{node: %s, sensitivity: %s um/K}" % (m.bodies[b], P(p)) for b, p in se)))
    L.append("cyclograms:")
    L += ["  rec_%d: {csv: measured_%d.csv}" % (r + 1, r + 1) for r in range(len(recs))]
    L.append("solver: {output_interval: %g s}" % recs[0].dt)
    return "\n".join(L) + "\n"


def noisy(rng, y, s, q, ncol):
    z = rng.normal(size=len(y))
    if ncol:
        e = math.exp(-1 / ncol)
        x, o = rng.normal(), np.empty(len(y))
        for k in range(len(y)):
            o[k] = x
            x = e * x + math.sqrt(1 - e * e) * z[k]
        z = .8 * o + .6 * rng.normal(size=len(y))
    y = y + s * z
    return np.round(y / q) * q if q else y


def write_case(folder, rng, m, recs, Ys, name, plain=False, ambshift=None):
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "scenario.yaml"), "w") as o:
        o.write(yaml_of(m, recs, name))
    for r, R in enumerate(recs):
        head = ["time_s", "speed_rpm"]
        cols = [["%g" % t for t in R.t], ["%g" % x for x in R.speed]]
        for a in m.feeds:
            head.append("feed_%s_mm_min" % a)
            cols.append(["%g" % x for x in R.feed[a]])
        if m.cut:
            head.append("cutting_power_W")
            cols.append(["%g" % x for x in R.cut])
        if m.col:
            head.append(m.col[0])
            cols.append(["%g" % x for x in R.col])
        head.append("ambient_degC")
        a = R.amb if not ambshift or not ambshift.get(r) else np.interp(R.t - ambshift[r], R.t, R.amb)
        a = a if plain else noisy(rng, a, R.namb, R.q, 0)
        cols.append([("%.6f" if plain else "%.3f") % x for x in a])
        for s, _ in m.sens:
            head.append(s + "_degC")
            y = Ys[r][s][:, 0] if plain else noisy(rng, Ys[r][s][:, 0], R.nK, R.q, R.ncol)
            cols.append([("%.6f" if plain else "%.3f") % x for x in y])
        for d, _ in m.disp:
            head.append(d + "_um")
            y = Ys[r][d][:, 0] if plain else noisy(rng, Ys[r][d][:, 0], R.nU, R.qU, R.ncol)
            cols.append([("%.6f" if plain else "%.3f") % x for x in y])
        with open(os.path.join(folder, "measured_%d.csv" % (r + 1)), "w") as o:
            o.write(",".join(head) + "\n")
            for row in zip(*cols):
                o.write(",".join(row) + "\n")


def plan():
    rng = np.random.default_rng([SEED, 1])
    say, out = [k for k, _ in SAY], [k for k, _ in OUT]
    o = list(rng.permutation(out))
    A = [[k] for k in say] + [[k] for k in ("heat constant", "exchange constant", "heat window")] + [[k] for k in o[:16]]      # 32 + 16
    pool = list(rng.permutation(say)) + list(rng.permutation(say))
    group = lambda k: k.split()[0]
    D = []
    for k in range(8):
        a = pool.pop()
        b = next(x for x in pool if group(x) != group(a) and "all" not in (group(x), group(a)) or group(x) not in ("all", group(a), "heat", "exchange"))
        pool.remove(b)
        D.append([a, b])
    for k in range(4):
        b = next(x for x in pool if group(x) in ("reading", "displacement", "heat", "ambient"))
        pool.remove(b)
        D.append([o[16 + k], b])
    cases = [("A", k) for k in A] + [("D", k) for k in D] + [("B", [])] * 20
    return [cases[i] for i in rng.permutation(len(cases))]


def main():
    ap = argparse.ArgumentParser()
    ap.add_argument("folder")
    ap.add_argument("--plain", type=int, default=0)
    ap.add_argument("--only", type=int, default=-1)
    a = ap.parse_args()
    fams = list(FAM)
    if a.plain:
        for n in range(a.plain):
            rng = np.random.default_rng([SEED, 5, n])
            m = draw_machine(rng, fams[([3, 6, 9, 12, 0, 7, 14, 1, 13, 8])[n % 10]])
            m.start = {5: "steady", 6: "given"}.get(n, "ambient")
            recs = draw_records(rng, m)
            Y = [simulate(m, m.nom[None], R, r, np.zeros(1), [], [])[1] for r, R in enumerate(recs[:1])]
            write_case(os.path.join(a.folder, "plain_%d" % n), rng, m, recs[:1], Y, "plain_%d" % n, plain=True)
        return
    order = []
    g = np.random.default_rng([SEED, 2])
    while len(order) < 80:
        order += list(g.permutation(len(fams)))
    for n, (cls, kinds) in enumerate(plan()):
        if a.only >= 0 and n != a.only:
            continue
        res = None
        for t in range(200):
            rng = np.random.default_rng([SEED, 3, n, t])
            fam = fams[order[(n + t * 7) % 80]] if t else fams[order[n]]
            res = try_case(rng, fam, kinds)
            if res:
                break
        if not res:
            sys.exit("case %d %s: no success" % (n, kinds))
        m, recs, faults, amps, sizes, final = res
        folder = os.path.join(a.folder, "case_%04d" % n)
        shift = {}
        for f, x in zip(faults, amps):
            if getattr(f, "clock", False):
                shift = {r: x for r in f.recs}
        write_case(folder, rng, m, recs, [x[1] for x in final], "case_%04d" % n, ambshift=shift)
        tr = {"case": n, "class": cls, "family": m.fam, "sayable": not any(getattr(f, "alien", False) for f in faults), "start": m.start if isinstance(m.start, str) else "%g degC" % m.start,
              "effects": [{"what": f.text(x), "kind": f.kind, "statements": f.statements, "records": sorted(r + 1 for r in f.recs), "amplitude": x, "residual_sigmas": round(s, 2),
                           "sayable": not getattr(f, "alien", False)} for f, x, s in zip(faults, amps, sizes)]}
        with open(os.path.join(folder, "truth.json"), "w") as o:
            json.dump(tr, o, indent=1)
            o.write("\n")
        print("%d %s %s try %d %s rows %s | %s" % (n, cls, m.fam, t, m.start, [R.n for R in recs], " ; ".join("%s [%.1f]" % (f.text(x), s) for f, x, s in zip(faults, amps, sizes))), flush=True)


if __name__ == "__main__":
    main()
