#!/usr/bin/env python3
"""Fetches the records of the scoreboard that their licence lets one use, and checks all: fetch.py DATA

Files that are in the folder DATA are compared with records.sha256. Of those that are missing, those with a licence, an address and a conversion here are downloaded; of the
others the script prints the source, which a person must ask or convert. Exit code 1 if a file is missing or differs. Standard library only.
"""

import csv
import datetime
import hashlib
import io
import os
import sys
import urllib.request

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCES = {  # folder: source (owner/name on GitHub), licence
    "fl_thermal": ("CAIVIAC/FL_THERMAL, data/data.xlsx at 293b225 (a table of Excel; the first 28.125 h of it)", "MIT"),
    "heated_plate": ("DaISy data base of KU Leuven; no address known", "unknown"),
    "houses_nl": ("JulienLeprince/fiftyshadesofgrey", "MIT"),
    "imbd_lathe": ("ljthub-2025/2025-imbd-dataloader, 2025_dataset_0806/train at 1a2c9c7; thinned to 40 s, plan added", "MIT for the repository; not known whether for the data of the competition"),
    "incubator": ("INTO-CPS-Association/example_digital-twin_incubator", "none stated"),
    "lathe": ("continuous-deploy/CML_thermal, ACE_data", "none stated"),
    "printer_frame": ("tanaes/whopping_Voron_mods", "GPL-3.0"),
    "sjtu_spindle": ("ruoheng-du/thermal-expansion-error-prediction", "none stated"),
    "smc_stator": ("James-Keogh/Thermal-Modelling-and-Characterisation-of-an-Axial-FLux-SMC-Stator", "none stated"),
    "spindle_22": ("GOODDASH/soft_py", "none stated"),
    "test_house": ("Nilavro/BSSPy, of Bacher & Madsen, Energy and Buildings 43 (2011) 1511", "none stated"),
}


def since_first(times, form):
    """Whole seconds since the first of times, which are texts of the form."""
    at = [datetime.datetime.strptime(t, form) for t in times]
    return [round((t - at[0]).total_seconds()) for t in at]


def printer(text):
    """Z drift [um] by motor steps of 2.5 um, against the temperatures."""
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    lines = ["# 3D-printer gantry: Z drift at homing, step 0.0025 mm", "time_s,frame_degC,chamber_degC,bed_degC,bed_target_degC,drift_um"]
    for t, r in zip(since_first([r["time"] for r in rows], "%Y/%m/%d-%H:%M:%S"), rows):
        lines.append(f"{t},{r['frame_t']},{r['chamber_t']},{r['bed_t']},{r['bed_target']},{2.5 * (int(r['mcu_pos_z']) - int(rows[0]['mcu_pos_z']))}")
    return "\n".join(lines) + "\n"


def house(text, n_rows=4181):
    """Rounded, without the weeks after those of the scoreboard."""
    rows = list(csv.DictReader(io.StringIO(text), delimiter=";"))[:n_rows]
    lines = ["time_s,sun_Ps,outdoor_degC,indoor_degC,heating_Thm"]
    for t, r in zip(since_first([r["t"] for r in rows], "%Y-%m-%d %H:%M:%S"), rows):
        lines.append(f"{t},{round(float(r['Ps']), 4)},{r['Ta']},{round(float(r['yTi']), 3)},{round(float(r['Thm']), 4)}")
    return "\n".join(lines) + "\n"


GITHUB = "https://raw.githubusercontent.com/"
VORON = GITHUB + "tanaes/whopping_Voron_mods/"
FETCHED = {  # file: address, conversion
    "houses_nl/house_1.csv": (GITHUB + "JulienLeprince/fiftyshadesofgrey/683ef4add11c9bd82306c5a89275ba8d9547f7e3/data/in/blg_1.csv", house),
    "printer_frame/frame_exp_quant_v3_2021-06-13_05-41-53.csv":
        (VORON + "6d8967f75439feab313a23778f9ae4bf9c17425c/docs/frame_expansion/frame_exp_quant_v3_2021-06-13_05-41-53.csv", printer),
    "printer_frame/frame_temp_v_pos_2021-06-05_13-24-32.csv":
        (VORON + "8068640df43c3fbd91c3c0fa88987e45a25504fa/docs/frame_expansion/data/frame_temp_v_pos_2021-06-05_13-24-32.csv", printer),
}


def main(data):
    wrong, missing = 0, {}
    with open(os.path.join(HERE, "records.sha256"), encoding="utf-8") as file:
        expected = [line.split() for line in file]
    for digest, name in expected:
        path = os.path.join(data, name)
        if not os.path.exists(path) and name in FETCHED:
            address, convert = FETCHED[name]
            try:
                with urllib.request.urlopen(address, timeout=60) as answer:
                    text = convert(answer.read().decode())
            except OSError as error:
                print(f"{name}: {address}: {error}")
                wrong += 1
                continue
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8", newline="") as out:
                out.write(text)
            print(f"{name}: fetched from {address}; licence: {SOURCES[name.split('/')[0]][1]}")
        if not os.path.exists(path):
            missing.setdefault(name.split("/")[0], []).append(name)
            wrong += 1
            continue
        with open(path, "rb") as file:
            if hashlib.sha256(file.read()).hexdigest() != digest:
                print(f"{name}: other content than the scoreboard was made with (records.sha256)")
                wrong += 1
    for folder, names in missing.items():
        source, licence = SOURCES[folder]
        print(f"{folder}: {len(names)} missing ({os.path.basename(names[0])}{', ...' if len(names) > 1 else ''}). Source: {source}. Licence: {licence}")
    print(f"{len(expected) - wrong} of {len(expected)} files are as the scoreboard expects")
    return 1 if wrong else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
