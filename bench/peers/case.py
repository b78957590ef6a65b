"""The machine, its load and its readings, which every program of this comparison gets.

Column .4 x .5 x 1.5 m with a headstock .3 x .6 x .4 m, two bearing zones (cylinders R = .08 m) that are heated, and a nose
(R = .05 m) whose end is the tool point. Grey iron. The bottom keeps the ambient temperature and is clamped; all other faces
have a film of 10 W/(m^2 K). Heat ~ speed ratio^1.5. 300 minutes in six sections, readings each minute.
"""
import csv
import json

CONDUCTIVITY_W_mK, DENSITY_kg_m3, CAPACITY_J_kgK = 50.0, 7200.0, 500.0
YOUNGS_MODULUS_Pa, POISSON_RATIO, EXPANSION_1_K = 110e9, 0.27, 1.1e-5
FILM_W_m2K = 10.0
POWER_W = {"front_bearing": 280.0, "rear_bearing": 120.0}  # at ratio 1
EXPONENT = 1.5
CYCLOGRAM = [(60, 1.0), (30, 0.0), (60, 0.6), (45, 1.25), (30, 0.3), (75, 0.0)]  # minutes, ratio
SPEED_AT_RATIO_1_rpm = 4000.0

REGIONS = {"column": 1, "head": 2, "front_bearing": 3, "rear_bearing": 4, "nose": 5}  # names and physical numbers
SURFACES = {"bottom": 11, "exterior": 12}
TIP_m = (0.0, -0.4, 0.85)
SENSORS_m = [(0, -.32, 1.06), (0, -.32, 1.34), (0, -.4, .85), (0, -.6, 1.06), (0, -.6, 1.34), (.15, -.4, 1.2),
             (-.15, -.2, 1.2), (0, -.4, 1.4), (.2, .25, 1.2), (0, 0, .9), (0, .5, 1.2), (-.2, .25, .5)]


def info(folder):
    """The description that make_mesh.py wrote of its mesh."""
    with open(folder + "/info.json") as file:
        return json.load(file)


def read_rows(path):
    """Rows minute, 12 temperatures over the ambient's [K], 3 displacements [um] (absent from a run of heat alone), by minute."""
    with open(path) as file:
        return {round(float(row[0]), 3): [float(x) for x in row[1:]] for row in csv.reader(file) if row}


def differences(reference, rows):
    """Largest |dT| [K], largest |du| [um] (None where one has no displacements) and the number of common minutes."""
    most_K, most_um, n = 0.0, None, 0
    for minute, row in rows.items():
        if minute not in reference:
            continue
        n += 1
        for i, (a, b) in enumerate(zip(row, reference[minute])):
            if i < len(SENSORS_m):
                most_K = max(most_K, abs(a - b))
            else:
                most_um = max(most_um or 0.0, abs(a - b))
    return most_K, most_um, n
