"""Six more families of machines, for the set `structure_2` (README.md): other trades, other networks, other drives than those of families.py."""
from families import rounded
from network import Machine


def laser_cutter(rng, v):
    m = Machine("laser_cutter")
    for b, c in dict(source=14e3, optics=0.7e3, head=2.2e3, rail=26e3, frame=95e3).items():
        m.body(b, v(c))
    for a, b, g in [("source", "frame", 9), ("optics", "head", 3.5), ("head", "rail", 4.5), ("rail", "frame", 14), ("frame", "hall", 13), ("head", "hall", 1.3), ("rail", "hall", 5)]:
        m.link(a, b, v(g))
    m.circuit("source", v(5), v(70), rounded(rng.uniform(20, 25)))
    m.heat("cutting_heat", "source", rounded(rng.uniform(0.3, 0.5), 2))
    m.heat("cutting_heat", "optics", rounded(rng.uniform(0.01, 0.03), 2))
    m.heat("servo_loss", "rail", v(110), 1.0, rounded(rng.uniform(0.9, 1.5)), idle=v(15), axis="x")
    m.displacement("focus_z", "z", {"optics": v(2.1), "head": v(3.3)})
    m.displacement("rail_x", "x", {"rail": v(4.0), "frame": -v(1.2)})
    return m, dict(hours=(1.5, 5), dt=(15, 30), drive="steps", power=2400, feeds={"x": 60000})


def coordinate_measuring_machine(rng, v):
    m = Machine("coordinate_measuring_machine")
    for b, c in dict(granite=420e3, bridge=46e3, quill=7e3, motor_bridge=2.6e3).items():
        m.body(b, v(c))
    for a, b, g in [("motor_bridge", "bridge", 2.2), ("bridge", "granite", 3.0), ("quill", "bridge", 2.4), ("granite", "hall", 9), ("bridge", "hall", 7), ("quill", "hall", 1.9),
                    ("motor_bridge", "hall", 0.7)]:
        m.link(a, b, v(g))
    m.heat("servo_loss", "motor_bridge", v(26), 0.3, rounded(rng.uniform(0.8, 1.4)), idle=v(7), axis="y")
    m.heat("servo_loss", "quill", v(9), 0.2, rounded(rng.uniform(0.8, 1.3)), axis="z")
    m.displacement("probe_z", "z", {"quill": v(5.2), "bridge": v(1.5)})
    m.displacement("probe_x", "x", {"bridge": v(7.1), "granite": -v(2.6)})
    return m, dict(hours=(5, 16), dt=(60, 120), drive="feeds", feeds={"y": 20000, "z": 12000})


def wire_eroder(rng, v):
    m = Machine("wire_eroder")
    for b, c in dict(tank=230e3, work=9e3, arm=15e3, cabinet=20e3, base=150e3).items():
        m.body(b, v(c))
    for a, b, g in [("work", "tank", 60), ("tank", "base", 22), ("tank", "hall", 16), ("arm", "tank", 5), ("arm", "base", 7), ("cabinet", "hall", 12), ("cabinet", "base", 2.5), ("base", "hall", 15)]:
        m.link(a, b, v(g))
    m.circuit("tank", v(3), v(45), rounded(rng.uniform(20, 23)))
    m.heat("cutting_heat", "work", rounded(rng.uniform(0.4, 0.6), 2))
    m.heat("cutting_heat", "cabinet", rounded(rng.uniform(0.2, 0.35), 2))
    m.displacement("wire_x", "x", {"arm": v(6.3), "base": -v(2.2)})
    m.displacement("wire_y", "y", {"base": v(3.6), "work": v(0.8)})
    return m, dict(hours=(4, 12), dt=(30, 60), drive="steps", power=1600)


def trunnion(rng, v):
    m = Machine("trunnion")
    for b, c in dict(drive_a=6e3, bearing_a=2.4e3, cradle=70e3, plate=24e3, yoke=110e3).items():
        m.body(b, v(c))
    for a, b, g in [("drive_a", "bearing_a", 6), ("bearing_a", "cradle", 19), ("drive_a", "yoke", 15), ("cradle", "plate", 24), ("cradle", "yoke", 7), ("plate", "hall", 5), ("yoke", "hall", 13)]:
        m.link(a, b, v(g))
    m.heat("motor_loss", "drive_a", v(170), 90, rounded(rng.uniform(1, 1.8)), idle=v(40))
    m.heat("friction_law", "bearing_a", v(75), 90, rounded(rng.uniform(0.8, 1.5)), decay=v(0.012))
    m.displacement("plate_z", "z", {"cradle": v(2.9), "plate": v(1.4)})
    m.displacement("plate_y", "y", {"yoke": v(3.8), "cradle": -v(1.1)})
    return m, dict(hours=(3, 8), dt=(20, 60), drive="speed", top=90)


def wood_router(rng, v):
    m = Machine("wood_router")
    for b, c in dict(rotor=2.2e3, stator=4.1e3, shell=6e3, carriage=19e3, beam=42e3).items():
        m.body(b, v(c))
    for a, b, g in [("rotor", "stator", 2.4), ("rotor", "shell", 7), ("stator", "shell", 26), ("shell", "hall", 6.5), ("shell", "carriage", 6), ("carriage", "beam", 9), ("beam", "hall", 10)]:
        m.link(a, b, v(g))
    m.heat("motor_loss", "stator", v(190), 18000, rounded(rng.uniform(1.1, 1.9)), idle=v(25))
    m.heat("heat_source", "rotor", v(95), 18000, rounded(rng.uniform(1.2, 1.8)))
    m.heat("cutting_heat", "rotor", rounded(rng.uniform(0.03, 0.08), 2))
    m.displacement("tool_z", "z", {"rotor": v(2.0), "shell": v(1.2)})
    m.displacement("tool_y", "y", {"carriage": v(3.0), "beam": -v(2.0)})
    return m, dict(hours=(1.5, 4), dt=(10, 20), drive="speed+power", top=18000, power=2200)


def moulding_tool(rng, v):
    m = Machine("moulding_tool")
    for b, c in dict(nozzle=1.1e3, hot_runner=5.5e3, cavity=18e3, platen=85e3).items():
        m.body(b, v(c))
    for a, b, g in [("nozzle", "hot_runner", 5), ("hot_runner", "cavity", 3.2), ("cavity", "platen", 14), ("platen", "hall", 17), ("hot_runner", "platen", 1.5), ("cavity", "hall", 2.2)]:
        m.link(a, b, v(g))
    m.circuit("cavity", v(7), v(55), rounded(rng.uniform(28, 45)))
    m.heat("cutting_heat", "hot_runner", rounded(rng.uniform(0.5, 0.7), 2))
    m.heat("cutting_heat", "nozzle", rounded(rng.uniform(0.06, 0.12), 2))
    m.displacement("gap_z", "z", {"cavity": v(1.7), "platen": v(2.4)})
    return m, dict(hours=(1.5, 4), dt=(10, 20), drive="duty", power=900)


FAMILIES = [laser_cutter, coordinate_measuring_machine, wire_eroder, trunnion, wood_router, moulding_tool]
TITLES = dict(laser_cutter="laser cutter: source on a chiller, optics in a moving head; the laser's electric power is recorded", coordinate_measuring_machine="coordinate measuring machine on granite",
              wire_eroder="wire eroder; the generator's power is recorded", trunnion="trunnion with a worm drive", wood_router="router for wood, spindle cooled by its own fan",
              moulding_tool="moulding tool with a hot runner on a water circuit; the heaters' power is recorded")
