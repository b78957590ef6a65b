"""Eight machines and benches of the set `coarse`, drawn anew each time: geometry, material, joints, heats by shares (scaled afterwards), places of displacements."""
from coarse_truth import Truth


def spindle_column(rng, v):
    t = Truth("spindle_column", "speed", (4, 10))
    t.bar("shaft", v(0.5), v(0.0045), 0.06, 8, z=(1.3, 1.3), wind=4)
    t.bar("bearing_front", 0.05, v(0.006), 0.02, 2, z=(1.3, 1.3))
    t.bar("bearing_rear", 0.04, v(0.005), 0.02, 2, z=(1.3, 1.3))
    t.bar("housing", v(0.45), v(0.02), v(0.45), 8, "cast", z=(1.3, 1.35))
    t.bar("motor", v(0.22), v(0.02), v(0.6), 3, "winding", z=(1.5, 1.6), wind=5)
    t.bar("head", v(0.6), v(0.03), v(1.3), 7, "cast", z=(1.3, 1.4))
    t.bar("column", v(1.5), v(0.05), v(2.0), 14, "cast", z=(0.2, 1.8))
    t.joint("bearing_front", 0.5, "shaft", 0.15, v(18), 1, 0.2)
    t.joint("bearing_front", 0.5, "housing", 0.1, v(45), 1, 0.2)
    t.joint("bearing_rear", 0.5, "shaft", 0.8, v(14), 1, 0.2)
    t.joint("bearing_rear", 0.5, "housing", 0.85, v(35), 1, 0.2)
    t.joint("shaft", 1.0, "motor", 0.0, v(4))
    t.joint("housing", 0.5, "head", 0.1, v(120), 0.9, 0.2)
    t.joint("motor", 0.5, "head", 0.5, v(12), 1, 0.2)
    t.joint("head", 1.0, "column", 0.75, v(150), 0.2, 0.25)
    t.heat("friction", "bearing_front", 0.5, 1, 0.4, rng.uniform(1.2, 1.7), rng.uniform(0.006, 0.016))
    t.heat("friction", "bearing_rear", 0.5, 1, 0.25, rng.uniform(1.1, 1.6), rng.uniform(0.006, 0.016))
    t.heat("motor", "motor", 0.5, 1, 0.6, idle=0.04)
    t.top = 6000.0
    t.grow("tool_z", "z", [("shaft", 1, 0, 0.15), ("housing", 1, 0, 1), ("column", -1, 0.1, 0.7)], [("column", v(0.4))])
    t.grow("tool_y", "y", [("head", 1, 0, 1)], [("column", v(1.0)), ("head", v(0.3))])
    return t


def gantry_screw(rng, v):
    t = Truth("gantry_screw", "feed", (4, 9))
    t.bar("screw", v(1.6), v(0.0011), 0.12, 24, z=(1, 1), wind=0)
    t.bar("nut", 0.14, v(0.006), 0.3, 3, z=(1, 1))
    t.bar("bearing", 0.1, v(0.008), 0.2, 2, z=(1, 1))
    t.bar("servo", v(0.2), v(0.012), v(0.5), 3, "winding", z=(1, 1))
    t.bar("slide", v(0.7), v(0.03), v(1.4), 6, "alu", z=(1.05, 1.15))
    t.bar("beam", v(2.0), v(0.03), v(1.3), 16, z=(0.95, 0.95))
    t.joint("nut", 0.5, "screw", 0.5, v(16), 1, rng.uniform(0.3, 0.6))
    t.joint("nut", 0.5, "slide", 0.5, v(40), 1, 0.3)
    t.joint("bearing", 0.5, "screw", 0.0, v(22), 1, 0.04)
    t.joint("bearing", 0.5, "beam", 0.05, v(40), 1, 0.1)
    t.joint("servo", 0.0, "bearing", 1.0, v(8))
    t.joint("slide", 0.5, "beam", 0.5, v(9), 0.8, 0.5)
    t.heat("friction", "nut", 0.5, 1, 0.4, rng.uniform(0.9, 1.4), rng.uniform(0.006, 0.014), by="feed")
    t.heat("friction", "bearing", 0.5, 1, 0.25, rng.uniform(1.0, 1.4), rng.uniform(0.006, 0.014), by="feed")
    t.heat("motor", "servo", 0.5, 1, 0.5, idle=0.05, by="feed")
    t.heat("friction", "slide", 0.5, 1, 0.1, rng.uniform(0.9, 1.2), 0.01, by="feed")
    t.top_feed = 20000.0
    t.grow("position_x", "x", [("screw", 1, 0, 0.9), ("beam", -0.3, 0, 1)])
    t.grow("height_z", "z", [("slide", 1, 0, 0.4)], [("beam", v(0.3)), ("slide", v(0.3))])
    return t


def lathe(rng, v):
    t = Truth("lathe", "speed", (5, 11))
    t.bar("spindle", v(0.7), v(0.006), 0.07, 10, z=(1.1, 1.1), wind=4)
    t.bar("bearing_nose", 0.06, v(0.008), 0.02, 2, z=(1.1, 1.1))
    t.bar("bearing_tail", 0.05, v(0.006), 0.02, 2, z=(1.1, 1.1))
    t.bar("headstock", v(0.65), v(0.045), v(1.7), 9, "cast", z=(1.0, 1.1))
    t.bar("motor", v(0.3), v(0.02), v(0.7), 3, "winding", z=(0.4, 0.5), wind=6)
    t.bar("bed", v(2.0), v(0.05), v(1.6), 20, "cast", z=(0.6, 0.6), bodies=[("bed_left", 0.4), ("bed_right", 1.0)])
    t.joint("bearing_nose", 0.5, "spindle", 0.1, v(24), 1, 0.12)
    t.joint("bearing_nose", 0.5, "headstock", 0.08, v(60), 1, 0.2)
    t.joint("bearing_tail", 0.5, "spindle", 0.85, v(18), 1, 0.12)
    t.joint("bearing_tail", 0.5, "headstock", 0.9, v(45), 1, 0.2)
    t.joint("headstock", 0.5, "bed", 0.15, v(130), 0.9, 0.3)
    t.joint("motor", 0.5, "bed", 0.05, v(9), 1, 0.1)
    t.heat("friction", "bearing_nose", 0.5, 1, 0.45, rng.uniform(1.2, 1.7), rng.uniform(0.006, 0.016))
    t.heat("friction", "bearing_tail", 0.5, 1, 0.25, rng.uniform(1.1, 1.6), rng.uniform(0.006, 0.016))
    t.heat("friction", "headstock", 0.6, 0.3, 0.2, rng.uniform(1.3, 1.9), 0.012)
    t.heat("motor", "motor", 0.5, 1, 0.5, idle=0.03)
    t.top = 4000.0
    t.grow("nose_z", "z", [("spindle", 1, 0, 0.5), ("headstock", 0.5, 0, 1)], [("bed", v(0.3))])
    t.grow("centre_x", "x", [("headstock", 0.4, 0, 1)], [("headstock", v(1.2)), ("bed", v(0.6))])
    return t


def dividing_head(rng, v):
    t = Truth("dividing_head", "speed", (2.5, 7))
    t.bar("motor", v(0.18), v(0.011), v(0.42), 3, "winding", z=(1, 1), wind=3)
    t.bar("worm", v(0.25), v(0.0012), 0.05, 5, z=(1, 1))
    t.bar("wheel", v(0.2), v(0.02), 0.2, 4, z=(1.05, 1.1))
    t.bar("faceplate", v(0.12), v(0.05), v(1.2), 4, "cast", z=(1.2, 1.25))
    t.bar("housing", v(0.4), v(0.03), v(1.2), 8, "cast", z=(0.9, 1.2))
    t.bar("table", v(0.9), v(0.05), v(1.4), 9, "cast", z=(0.85, 0.85))
    t.joint("motor", 1.0, "worm", 0.0, v(3))
    t.joint("motor", 0.8, "housing", 0.2, v(10), 0.4, 0.3)
    t.joint("worm", 0.6, "wheel", 0.3, v(8), 0.4, 0.4)
    t.joint("worm", 0.6, "housing", 0.4, v(11), 0.8, 0.3)
    t.joint("wheel", 0.9, "faceplate", 0.1, v(55))
    t.joint("faceplate", 0.2, "housing", 0.8, v(25), 0.3, 0.3)
    t.joint("housing", 0.0, "table", 0.5, v(70), 0.3, 0.5)
    t.heat("motor", "motor", 0.5, 1, 0.6, idle=0.06)
    t.heat("friction", "worm", 0.6, 0.5, 0.3, rng.uniform(1.0, 1.5), rng.uniform(0.008, 0.018))
    t.heat("friction", "faceplate", 0.2, 0.3, 0.2, rng.uniform(1.1, 1.6), 0.01)
    t.top = 120.0
    t.grow("face_z", "z", [("faceplate", 1, 0, 1), ("wheel", 1, 0, 1), ("housing", 0.4, 0, 1)], [("housing", v(0.4))])
    t.grow("axis_y", "y", [("housing", 0.7, 0, 1)], [("table", v(0.8)), ("housing", v(0.6))])
    return t


def heated_plate(rng, v):
    t = Truth("heated_plate", "power", (3, 8))
    t.bar("heater", v(0.2), v(0.004), 0.02, 4, "steel", z=(0.95, 0.95))
    t.plate("plate", v(0.5), v(0.4), v(0.025), 7, 5)
    t.bar("post", v(0.3), v(0.004), 0.25, 8, "steel", z=(1.0, 1.3))
    t.bar("probe_arm", v(0.4), v(0.0015), 0.16, 8, "steel", z=(1.3, 1.3))
    t.bar("frame", v(0.9), v(0.009), v(0.9), 9, "alu", z=(0.8, 0.8))
    t.joint("heater", 0.5, "plate", rng.uniform(0.2, 0.4), v(40), 1, 0.3)
    t.joint("plate", 0.9, "post", 0.0, v(15), 0.15)
    t.joint("post", 1.0, "probe_arm", 0.0, v(8))
    t.joint("plate", 0.5, "frame", 0.5, v(3), 1, 0.8)
    t.joint("heater", 0.5, "frame", 0.3, v(1.2), 1, 0.3)
    t.heat("heater", "heater", 0.5, 1, 1.0, by="power")
    t.top_power = v(400)
    t.grow("post_z", "z", [("post", 1, 0, 1)], [("plate", v(0.3)), ("probe_arm", v(0.2))])
    t.grow("plate_x", "x", [("plate", 1, 0, 1)])
    return t


def grinding_spindle(rng, v):
    t = Truth("grinding_spindle", "speed", (3, 8))
    t.bar("spindle", v(0.5), v(0.003), 0.05, 9, z=(1.1, 1.1), wind=5)
    t.bar("bearing_wheel", 0.05, v(0.005), 0.02, 2, z=(1.1, 1.1))
    t.bar("bearing_drive", 0.05, v(0.005), 0.02, 2, z=(1.1, 1.1))
    t.bar("sleeve", v(0.45), v(0.011), v(0.3), 9, z=(1.1, 1.1))
    t.bar("wheelhead", v(0.7), v(0.05), v(1.8), 9, "cast", z=(0.9, 1.1))
    t.bar("bed", v(1.4), v(0.09), v(2.0), 10, "mineral", z=(0.5, 0.5))
    t.joint("bearing_wheel", 0.5, "spindle", 0.2, v(16), 1, 0.15)
    t.joint("bearing_wheel", 0.5, "sleeve", 0.15, v(45), 1, 0.2)
    t.joint("bearing_drive", 0.5, "spindle", 0.8, v(14), 1, 0.15)
    t.joint("bearing_drive", 0.5, "sleeve", 0.85, v(40), 1, 0.2)
    t.joint("sleeve", 0.5, "wheelhead", 0.3, v(60), 0.9, 0.5)
    t.joint("wheelhead", 0.5, "bed", 0.5, v(45), 0.9, 0.5)
    t.circuit("sleeve", 0.1, 0.9, v(4), v(35), round(rng.uniform(19, 23), 1))
    t.heat("friction", "bearing_wheel", 0.5, 1, 0.5, rng.uniform(1.2, 1.8), rng.uniform(0.006, 0.014))
    t.heat("friction", "bearing_drive", 0.5, 1, 0.4, rng.uniform(1.2, 1.8), rng.uniform(0.006, 0.014))
    t.heat("motor", "wheelhead", 0.8, 0.3, 0.4, idle=0.03)
    t.top = 9000.0
    t.grow("wheel_z", "z", [("spindle", 1, 0, 0.8), ("sleeve", -0.5, 0, 1)], [("wheelhead", v(0.4))])
    t.grow("infeed_x", "x", [("wheelhead", 0.6, 0, 1)], [("bed", v(0.5)), ("wheelhead", v(0.7))])
    return t


def bearing_rig(rng, v):
    t = Truth("bearing_rig", "speed", (2, 6))
    t.bar("motor", v(0.25), v(0.016), v(0.6), 4, "winding", z=(1, 1), wind=6)
    t.bar("shaft", v(0.6), v(0.002), 0.1, 12, z=(1, 1), wind=4)
    t.bar("bearing_a", 0.04, v(0.006), 0.05, 2, z=(1, 1))
    t.bar("bearing_b", 0.04, v(0.006), 0.05, 2, z=(1, 1))
    t.bar("block_a", v(0.25), v(0.02), v(0.6), 6, z=(0.85, 1.05))
    t.bar("block_b", v(0.25), v(0.02), v(0.6), 6, z=(0.85, 1.05))
    t.bar("table", v(1.5), v(0.06), v(1.2), 14, "cast", z=(0.8, 0.8))
    t.joint("motor", 1.0, "shaft", 0.0, v(2.5))
    t.joint("bearing_a", 0.5, "shaft", 0.35, v(11), 1, 0.1)
    t.joint("bearing_b", 0.5, "shaft", 0.85, v(11), 1, 0.1)
    t.joint("bearing_a", 0.5, "block_a", 0.8, v(35), 1, 0.35)
    t.joint("bearing_b", 0.5, "block_b", 0.8, v(35), 1, 0.35)
    t.joint("block_a", 0.0, "table", 0.4, v(40), 0, 0.1)
    t.joint("block_b", 0.0, "table", 0.7, v(40), 0, 0.1)
    t.joint("motor", 0.5, "table", 0.1, v(12), 0.9, 0.15)
    t.heat("motor", "motor", 0.5, 1, 0.6, idle=0.03)
    t.heat("friction", "bearing_a", 0.5, 1, 0.35, rng.uniform(1.2, 1.8), rng.uniform(0.007, 0.018))
    t.heat("friction", "bearing_b", 0.5, 1, 0.3, rng.uniform(1.2, 1.8), rng.uniform(0.007, 0.018))
    t.top = 8000.0
    t.grow("shaft_z", "z", [("shaft", 1, 0.35, 1), ("table", -1, 0.4, 0.7)])
    t.grow("block_height", "y", [("block_a", 1, 0, 0.8)], [("table", v(0.4))])
    return t


def linear_axis(rng, v):
    t = Truth("linear_axis", "feed", (2.5, 7))
    t.bar("coil", v(0.4), v(0.006), 0.08, 5, "winding", z=(1, 1))
    t.bar("cooling_plate", v(0.45), v(0.006), 0.1, 6, "alu", z=(1.02, 1.02))
    t.bar("slide", v(0.6), v(0.025), v(1.1), 7, "alu", z=(1.05, 1.1))
    t.bar("magnets", v(1.2), v(0.004), 0.15, 9, z=(0.95, 0.95))
    t.bar("base", v(1.5), v(0.1), v(1.4), 12, "granite", z=(0.8, 0.8))
    t.joint("coil", 0.5, "cooling_plate", 0.5, v(60), 1, 0.9)
    t.joint("cooling_plate", 0.5, "slide", 0.5, v(35), 0.9, 0.7)
    t.joint("coil", 0.5, "magnets", 0.5, v(5), 1, 0.5)
    t.joint("magnets", 0.5, "base", 0.5, v(40), 0.9, 0.8)
    t.joint("slide", 0.5, "base", 0.5, v(5), 0.9, 0.5)
    t.circuit("cooling_plate", 0.05, 0.95, v(2.0), v(30), round(rng.uniform(19, 23), 1))
    t.heat("motor", "coil", 0.5, 1, 1.0, idle=0.08, by="feed")
    t.heat("friction", "slide", 0.5, 0.9, 0.12, rng.uniform(0.9, 1.3), 0.012, by="feed")
    t.heat("friction", "magnets", 0.5, 0.6, 0.1, rng.uniform(1.4, 1.9), 0.0, by="feed")
    t.top_feed = 60000.0
    t.grow("slide_x", "x", [("slide", 1, 0, 0.8)], [("slide", v(0.5))])
    t.grow("gap_z", "z", [("cooling_plate", 0.3, 0, 1), ("slide", 0.3, 0, 1)], [("base", v(0.8))])
    return t


FAMILIES = [spindle_column, gantry_screw, lathe, dividing_head, heated_plate, grinding_spindle, bearing_rig, linear_axis]
TITLES = dict(spindle_column="spindle head on a column", gantry_screw="gantry axis with a ball screw", lathe="headstock and bed of a lathe", dividing_head="dividing head with its motor",
              heated_plate="test bench with a heated plate; the heater's power is recorded", grinding_spindle="grinding spindle with a cooled sleeve", bearing_rig="rig for two bearings",
              linear_axis="axis with a cooled linear motor")
