#!/usr/bin/env python3
"""Measured records as others publish them -> record CSVs that `driftwright diagnose` reads (docs/record.md, docs/measured.md).

    to_record.py spindle_22    run1.csv                   out.csv   speed 1000 rpm throughout: the source says none
    to_record.py lathe         2016-12-30_TM1.csv         out.csv   nominal levels, stopped where the spindle cools
    to_record.py lathe_no_stop 2016-12-30_TM1.csv         out.csv   the same as if nobody had noted the stop
    to_record.py table_d       -                          out.csv   eight published numbers, at standstill
    to_record.py incubator     2021-01-22_lid_opening.csv out.csv   heater as cutting_power_W
    to_record.py printer_frame frame_temp_v_pos_....csv   out.csv   heat of the bed as cutting_power_W
    to_record.py printer_good  frame_temp_v_pos_....csv   out.csv   the same without homings off by more than 1 mm
    to_record.py heated_plate  run.csv                    out.csv   100 rpm per volt of lamp drive
    to_record.py test_house    prbs.csv                   out.csv   heaters as cutting_power_W, sun left out
    to_record.py test_house_sun prbs.csv                  out.csv   the same, sun as feed_x: 100 mm/min per W/m2

Speeds, feeds and cutting power are the drives that a record may have; what drives these machines is written into one of them.
Standard library only.
"""

import csv
import sys

# Nominal: the source knows low (BM), medium (TM) and high (CM) only.
LATHE_RPM = {"BM": 1000, "TM": 2000, "CM": 3000}

# Li Lianyu et al.: table of a gantry mill, uncompensated; hours from 10-23 08:00, hall in degC, delta X in mm.
TABLE_D = [(0, 23, 0.02), (3, 24.5, 0.09), (6, 25.5, 0.10), (9, 25.5, 0.12),
           (24, 22.5, 0.04), (27, 22.5, 0.05), (30, 22.5, 0.09), (33, 24.5, 0.05)]


def read(path):
    with open(path, encoding="utf-8-sig") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def is_turning(rows):
    """Per row, false in the one stop of the day: from the highest to the lowest reading of the rear bearing's deepest fall."""
    rear = [float(r["spindle_rear_degC"]) for r in rows]
    peak = begin = end = 0
    for i, value in enumerate(rear):
        if value > rear[peak]:
            peak = i
        if rear[peak] - value > rear[begin] - rear[end]:
            begin, end = peak, i
    return [not begin <= i < end for i in range(len(rear))]


def lathe(path, with_stop):
    rows = read(path)
    level = next(rpm for cycle, rpm in LATHE_RPM.items() if cycle in path)
    turning = is_turning(rows) if with_stop else [True] * len(rows)
    # All readings from their first one on, the hall about 20 degC: yesterday's warmth is in each body as its own start, and a
    # scenario has one start for all.
    names = [n for n in rows[0] if n.endswith("_degC") and n != "ambient_degC"]
    start_s = float(rows[0]["time_s"])
    first = {n: float(rows[0][n]) for n in [*names, "ambient_degC", "diameter_um"]}
    yield ["time_s", "speed_rpm", "ambient_degC", *(n.replace("degC", "K") for n in names), "diameter_um"]
    for row, turns in zip(rows, turning):
        rise = {n: float(row[n]) - first[n] for n in first}
        yield [f"{float(row['time_s']) - start_s:g}", level if turns else 0, f"{20.0 + rise['ambient_degC']:.2f}", *(f"{rise[n]:.2f}" for n in names),
               f"{rise['diameter_um']:.3f}"]


def table_d(_):
    yield ["time_h", "speed_rpm", "ambient_degC", "delta_x_mm"]
    for time_h, hall_degC, delta_mm in TABLE_D:
        yield [time_h, 0, hall_degC, delta_mm]


def with_columns(rename, fixed=None, scale=None):
    """Columns renamed (old: new), constant ones put in (name: value), some scaled (old: factor); others are dropped."""
    fixed, scale = fixed or {}, scale or {}

    def convert(path):
        yield ["time_s", *fixed, *rename.values()]
        for row in read(path):
            yield [row["time_s"], *fixed.values(), *(f"{float(row[n]) * scale.get(n, 1.0):.6g}" for n in rename)]

    return convert


def spindle_22(path):
    names = [n for n in read(path)[0] if n != "time_s"]
    return with_columns({n: n for n in names}, {"speed_rpm": 1000})(path)


def printer(keep):
    """The bed's heat into the chamber, 1 W/K times what it is warmer than the room, of 22 degC, as cutting power."""

    def convert(path):
        yield ["time_s", "speed_rpm", "cutting_power_W", "frame_degC", "chamber_degC", "drift_um"]
        for row in filter(keep, read(path)):
            power_W = max(0.0, float(row["bed_degC"]) - 22.0)
            yield [row["time_s"], 0, f"{power_W:.2f}", *(f"{float(row[n]):.2f}" for n in ("frame_degC", "chamber_degC")),
                   row["drift_um"]]

    return convert


HOUSE = {"outdoor_degC": "ambient_degC", "heater_W": "cutting_power_W", "indoor_degC": "indoor_degC"}
CONVERSIONS = {
    "spindle_22": spindle_22,
    "lathe": lambda path: lathe(path, True),
    "lathe_no_stop": lambda path: lathe(path, False),
    "table_d": table_d,
    "incubator": with_columns({"heater_W": "cutting_power_W", "room_degC": "room_degC", "inside_2_degC": "inside_2_degC",
                               "inside_3_degC": "inside_3_degC"}, {"speed_rpm": 0}),
    "printer_frame": printer(lambda row: True),
    "printer_good": printer(lambda row: abs(float(row["drift_um"])) < 1000.0),
    "heated_plate": with_columns({"drive_V": "speed_rpm", "plate_degC": "plate_degC"}, scale={"drive_V": 100.0}),
    "test_house": with_columns(HOUSE, {"speed_rpm": 0}),
    "test_house_sun": with_columns({**HOUSE, "solar_W_m2": "feed_x_mm_min"}, {"speed_rpm": 0}, {"solar_W_m2": 100.0}),
}

if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] not in CONVERSIONS:
        sys.exit(__doc__)
    with open(sys.argv[3], "w", newline="", encoding="utf-8") as out:
        csv.writer(out, lineterminator="\n").writerows(CONVERSIONS[sys.argv[1]](sys.argv[2]))
