#!/usr/bin/env python3
"""Converts measured records, as others publish them, to record CSVs that `driftwright diagnose` reads (docs/reference/record.md, docs/theory/measured.md).

    to_record.py spindle_22    run1.csv                   out.csv   speed 1000 rpm throughout; the source gives none
    to_record.py lathe         2016-12-30_TM1.csv         out.csv   nominal speed levels, at rest where the spindle cools
    to_record.py lathe_no_stop 2016-12-30_TM1.csv         out.csv   the same without the stop
    to_record.py table_d       -                          out.csv   eight published numbers, at standstill
    to_record.py incubator     2021-01-22_lid_opening.csv out.csv   at standstill, with heater_W
    to_record.py printer_frame frame_temp_v_pos_....csv   out.csv   at standstill, with bed_degC
    to_record.py printer_good  frame_temp_v_pos_....csv   out.csv   the same without homings off by more than 1 mm
    to_record.py heated_plate  run.csv                    out.csv   100 rpm per volt of lamp drive
    to_record.py test_house    prbs.csv                   out.csv   at standstill, with heater_W, without the sun
    to_record.py test_house_sun prbs.csv                  out.csv   the same, solar_W_m2 too

Columns that drive a machine keep their names, because effects `recorded_drive` of the scenario use them. An empty cell stays empty.
The script needs only the standard library.
"""

import csv
import math
import sys

# These speeds are nominal: the source gives only low (BM), medium (TM) and high (CM).
LATHE_RPM = {"BM": 1000, "TM": 2000, "CM": 3000}

# Li Lianyu et al.: table of a gantry mill, uncompensated; hours from 10-23 08:00, hall in degC, delta X in mm.
TABLE_D = [(0, 23, 0.02), (3, 24.5, 0.09), (6, 25.5, 0.10), (9, 25.5, 0.12),
           (24, 22.5, 0.04), (27, 22.5, 0.05), (30, 22.5, 0.09), (33, 24.5, 0.05)]


def read(path):
    with open(path, encoding="utf-8-sig") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def number(cell):
    return float(cell) if cell.strip() else math.nan


def written(value, digits):
    """The text of a cell; empty if the value is missing."""
    return "" if math.isnan(value) else f"{value:.{digits}f}"


def first_of(rows, name):
    """The first reading of a column."""
    return next(v for v in (number(r[name]) for r in rows) if not math.isnan(v))


# A stop at mid-day: the rear bearing falls by a good part of its day's range, and rises again within the day.
LEAST_FALL = 0.1
LEAST_RISE_AGAIN = 0.5
LONGEST_STOP_S = 4 * 3600.0


def is_turning(rows):
    """One value per row: false during the one stop of the day, from the highest to the lowest reading of the rear bearing's largest fall. A fall that is small,
    that takes longer than a break, or that does not end in a rise of half its size (a night, a day that cools with its hall) is no stop."""
    known = [i for i, r in enumerate(rows) if r["spindle_rear_degC"].strip()]
    rear = {i: float(rows[i]["spindle_rear_degC"]) for i in known}
    time_s = [float(r["time_s"]) for r in rows]
    day = max(rear.values()) - min(rear.values())
    begin = end = known[0]
    for n, peak in enumerate(known):
        lowest = peak
        for i in known[n:]:
            if rear[i] > rear[peak]:
                break
            if rear[i] < rear[lowest]:
                lowest = i
        fall = rear[peak] - rear[lowest]
        if fall <= rear[begin] - rear[end] or fall < LEAST_FALL * day or time_s[lowest] - time_s[peak] > LONGEST_STOP_S:
            continue
        if max(rear[i] for i in known if i >= lowest) - rear[lowest] < LEAST_RISE_AGAIN * fall:
            continue
        begin, end = peak, lowest
    return [not begin <= i < end for i in range(len(rows))]


def lathe(path, with_stop):
    rows = read(path)
    level = next(rpm for cycle, rpm in LATHE_RPM.items() if cycle in path)
    turning = is_turning(rows) if with_stop else [True] * len(rows)
    # Readings count from the first one, and the hall has about 20 degC: each body starts with its own warmth of the day before, but a
    # scenario has one start for all bodies.
    names = [n for n in rows[0] if n.endswith("_degC") and n != "ambient_degC"]
    start_s = float(rows[0]["time_s"])
    first = {n: first_of(rows, n) for n in [*names, "ambient_degC", "diameter_um"]}
    yield ["time_s", "speed_rpm", "ambient_degC", *(n.replace("degC", "K") for n in names), "diameter_um"]
    for row, turns in zip(rows, turning):
        rise = {n: number(row[n]) - first[n] for n in first}
        yield [f"{float(row['time_s']) - start_s:g}", level if turns else 0, written(20.0 + rise["ambient_degC"], 2),
               *(written(rise[n], 2) for n in names), written(rise["diameter_um"], 3)]


def table_d(_):
    yield ["time_h", "speed_rpm", "ambient_degC", "delta_x_mm"]
    for time_h, hall_degC, delta_mm in TABLE_D:
        yield [time_h, 0, hall_degC, delta_mm]


def with_columns(rename, fixed=None, scale=None):
    """Renames columns (old: new), adds constant ones (name: value), scales some (old: factor) and drops all others."""
    fixed, scale = fixed or {}, scale or {}

    def convert(path):
        yield ["time_s", *fixed, *rename.values()]
        for row in read(path):
            yield [row["time_s"], *fixed.values(),
                   *("" if math.isnan(number(row[n])) else f"{number(row[n]) * scale.get(n, 1.0):.6g}" for n in rename)]

    return convert


def spindle_22(path):
    names = [n for n in read(path)[0] if n != "time_s"]
    return with_columns({n: n for n in names}, {"speed_rpm": 1000})(path)


def printer(keep):
    def convert(path):
        names = ("bed_degC", "frame_degC", "chamber_degC")
        yield ["time_s", "speed_rpm", *names, "drift_um"]
        for row in filter(keep, read(path)):
            yield [row["time_s"], 0, *(written(number(row[n]), 2) for n in names), row["drift_um"]]

    return convert


def same(*names):
    return {n: n for n in names}


HOUSE = {"outdoor_degC": "ambient_degC", **same("heater_W", "indoor_degC")}
CONVERSIONS = {
    "spindle_22": spindle_22,
    "lathe": lambda path: lathe(path, True),
    "lathe_no_stop": lambda path: lathe(path, False),
    "table_d": table_d,
    "incubator": with_columns(same("heater_W", "room_degC", "inside_2_degC", "inside_3_degC"), {"speed_rpm": 0}),
    "printer_frame": printer(lambda row: True),
    "printer_good": printer(lambda row: not abs(number(row["drift_um"])) >= 1000.0),
    "heated_plate": with_columns({"drive_V": "speed_rpm", "plate_degC": "plate_degC"}, scale={"drive_V": 100.0}),
    "test_house": with_columns(HOUSE, {"speed_rpm": 0}),
    "test_house_sun": with_columns({**HOUSE, **same("solar_W_m2")}, {"speed_rpm": 0}),
}

if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] not in CONVERSIONS:
        sys.exit(__doc__)
    with open(sys.argv[3], "w", newline="", encoding="utf-8") as out:
        csv.writer(out, lineterminator="\n").writerows(CONVERSIONS[sys.argv[1]](sys.argv[2]))
