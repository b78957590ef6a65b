"""The measured records of the scoreboard: what each is, how it is split, and how a scenario of this project reads it.

A Record is a table of columns; a Split says which rows are fitted on and which are judged. Temperatures that are targets are in K or degC, displacements in um.
Standard library only.
"""

import csv
import dataclasses
import glob
import os


@dataclasses.dataclass
class Table:
    """One run: `time_s` and the columns by name, a list of floats each; None where a cell is empty."""
    name: str
    time_s: list
    columns: dict

    def rows(self, keep):
        return Table(self.name, [t for t, k in zip(self.time_s, keep) if k],
                     {n: [v for v, k in zip(c, keep) if k] for n, c in self.columns.items()})


def read(path, every=1):
    with open(path, encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))[::every]
    names = [n for n in rows[0] if n != "time_s"]
    return Table(os.path.basename(path), [float(r["time_s"]) for r in rows],
                 {n: [float(r[n]) if r[n] else None for r in rows] for n in names})


@dataclasses.dataclass
class Case:
    """A record, what is predicted of it from what, and one way to keep data out.

    fit, judge: runs whose target is fitted to and judged by. Of a single long record both are the whole record: `fit_rows` and `judge_rows` then say
    which of its rows count, and rows before the judged ones are known to every predictor but for the target.
    """
    record: str
    split: str
    target: str
    fit: list
    judge: list
    thermometers: list
    drive: str = ""            # column of what drives the machine: speed, voltage, heater
    ambient: str = ""             # column of the surroundings' temperature, among the thermometers
    from_start: bool = False   # temperatures and target count from the first row of a run
    fit_rows: object = None    # function of time [s]
    judge_rows: object = None
    sensors_to_choose: int = 4
    scenario: str = ""         # of scenarios/measured, for the diagnosed model
    conversion: str = ""       # of bench/measured/to_record.py, for that scenario
    scenario_target: str = ""  # column there
    fit_files: list = dataclasses.field(default_factory=list)
    judge_files: list = dataclasses.field(default_factory=list)

    @property
    def unit(self):
        return "um" if self.target.endswith("_um") else "K"


LATHE_SENSORS = ["ambient_degC", "bed_degC", "spindle_rear_degC", "spindle_front_degC", "coolant_wall_degC", "transformer_bed_degC"]


def lathe(data, fit, judge, split):
    path = {os.path.basename(p).split("_")[1][:-4]: p for p in glob.glob(os.path.join(data, "lathe", "*.csv"))}
    return Case("lathe", split, "diameter_um", [read(path[d]) for d in fit], [read(path[d]) for d in judge], LATHE_SENSORS,
                ambient="ambient_degC", from_start=True, sensors_to_choose=3, scenario="lathe", conversion="lathe",
                scenario_target="diameter_um", fit_files=[path[d] for d in fit], judge_files=[path[d] for d in judge])


def spindle_22(data, judged):
    files = [os.path.join(data, "spindle_22", f"run{i}.csv") for i in (1, 2, 3)]
    fit = [f for i, f in enumerate(files) if i + 1 != judged]
    judge = [files[judged - 1]]
    first = read(files[0])
    return Case("spindle_22", f"run {judged} kept out", "error_um", [read(f) for f in fit], [read(f) for f in judge],
                [n for n in first.columns if n.startswith("rise_")], scenario="spindle_22", conversion="spindle_22",
                scenario_target="error_um", fit_files=fit, judge_files=judge)


def imbd_lathe(data, fit, judge, split, target):
    def days(names):
        return [os.path.join(data, "imbd_lathe", f"2020{d}.csv") for d in names]
    fit, judge = days(fit), days(judge)
    first = read(fit[0])
    return Case("imbd_lathe", split, target, [read(f) for f in fit], [read(f) for f in judge], [n for n in first.columns if n.endswith("_degC")],
                drive="speed_rpm", ambient="tc08_degC", from_start=True, fit_files=fit, judge_files=judge)


def parted(record, path, split, fit_rows, judge_rows, target, thermometers, every=1, **more):
    table = read(path, every)
    if target.endswith("drift_um"):  # two homings of one file are off by 4 mm: neither fitted on nor judged by
        table = table.rows([v is not None and abs(v) < 1000.0 for v in table.columns[target]])
    return Case(record, split, target, [table], [table], thermometers, fit_rows=fit_rows, judge_rows=judge_rows, fit_files=[path],
                judge_files=[path], **more)


def between(from_h, to_h):
    return lambda t_s: 3600.0 * from_h <= t_s < 3600.0 * to_h


def halves(path):
    end_h = read(path).time_s[-1] / 3600.0
    return between(0.0, 0.5 * end_h), between(0.5 * end_h, 2.0 * end_h)


def cases(data):
    """All of them, in the order of the table."""
    result = [
        lathe(data, ["TM1", "TM2", "TM3", "CM1", "CM2", "BM1", "BM2"], ["TM4", "TM5", "TM6", "BM3", "CM3"], "5 of 12 days kept out"),
        lathe(data, ["TM1", "TM2", "TM3", "TM4", "TM5", "TM6", "CM1", "CM2", "CM3"], ["BM1", "BM2", "BM3"], "duty cycle BM kept out"),
    ]
    result += [spindle_22(data, run) for run in (1, 2, 3)]
    for file, scenario in (("2021-01-22_lid_opening", "incubator"), ("2023-05-01_calibration_empty", "incubator_2023")):
        path = os.path.join(data, "incubator", file + ".csv")
        result.append(parted("incubator " + file[:4], path, "second half kept out", *halves(path), "inside_2_degC",
                             ["room_degC", "inside_3_degC"], drive="heater_W", scenario=scenario, conversion="incubator",
                             scenario_target="inside_2_degC"))
    printer = [os.path.join(data, "printer_frame", f"frame_{f}.csv")
               for f in ("exp_quant_v3_2021-06-13_05-41-53", "temp_v_pos_2021-06-05_13-24-32")]
    sensors = ["frame_degC", "chamber_degC", "bed_degC"]
    for path, name in zip(printer, ("June 13", "June 5")):
        result.append(parted("printer_frame " + name, path, "second half kept out", *halves(path), "drift_um", sensors,
                             scenario="printer_frame", conversion="printer_good", scenario_target="drift_um"))
    path = os.path.join(data, "heated_plate", "run.csv")
    result.append(parted("heated_plate", path, "second half kept out", *halves(path), "plate_degC", [], drive="drive_V",
                         scenario="heated_plate", conversion="heated_plate", scenario_target="plate_degC"))
    path = os.path.join(data, "fl_thermal", "first_28h.csv")
    for split, fit, judge in (("fit 0-20 h, judge 20-28 h", between(0, 20), between(20, 99)),
                              ("fit 0-12 h, judge 12-20 h", between(0, 12), between(12, 20)),
                              ("fit 8-28 h, judge 0-8 h", between(8, 99), between(0, 8))):
        for channel in range(1, 6):
            result.append(parted("fl_thermal", path, split, fit, judge, f"ch{channel}_um", [f"t{i}_degC" for i in range(1, 17)], every=4,
                                 drive="speed_rpm"))
    path = os.path.join(data, "test_house", "prbs.csv")
    result.append(parted("test_house", path, "second half kept out", *halves(path), "indoor_degC", ["outdoor_degC", "solar_W_m2"],
                         drive="heater_W", ambient="outdoor_degC", scenario="test_house", conversion="test_house",
                         scenario_target="indoor_degC"))
    return result


IMBD_DAYS = ["0615", "0616", "0617", "0701", "0702", "0703", "0708", "0709", "0710", "0713", "0727", "0729", "0730", "0805", "0807", "0813",
             "0814", "0817", "0820"]
IMBD_2000_RPM = ["0615", "0701", "0708", "0727", "0813", "0817", "0820"]
IMBD_VARYING = ["0708", "0709", "0710", "0713", "0813", "0814", "0817"]


def later_cases(data):
    """Written on 27 November 2026, before the blend was run on any of them; what came of it is in docs/theory/measured_strategies.md."""
    result = []
    for target in ("x_um", "z_um"):
        result.append(imbd_lathe(data, IMBD_DAYS[:10], IMBD_DAYS[10:], "fit 10 days, judge the 9 after them", target))
        result.append(imbd_lathe(data, IMBD_2000_RPM, [d for d in IMBD_DAYS if d not in IMBD_2000_RPM], "fit days at 2000 rpm alone", target))
        result.append(imbd_lathe(data, [d for d in IMBD_DAYS if d not in IMBD_VARYING], IMBD_VARYING, "fit days of constant climate", target))
    path = os.path.join(data, "sjtu_spindle", "first_40h.csv")
    result.append(parted("sjtu_spindle", path, "second half kept out", *halves(path), "growth_um", [f"t{i:02d}_degC" for i in range(16)]))
    path = os.path.join(data, "smc_stator", "dc_10a_insulated_core.csv")
    result.append(parted("smc_stator", path, "second half kept out", *halves(path), "coil_1_degC", ["ambient_degC"], every=5, drive="power_W",
                         ambient="ambient_degC"))
    path = os.path.join(data, "houses_nl", "house_1.csv")
    result.append(parted("houses_nl", path, "second half kept out", *halves(path), "indoor_degC", ["outdoor_degC", "sun_Ps"],
                         drive="heating_Thm", ambient="outdoor_degC"))
    tm = [f"TM{i}" for i in range(1, 7)]
    result.append(lathe(data, tm, ["CM1", "CM2", "CM3", "BM1", "BM2", "BM3"], "duty cycles CM and BM kept out"))
    result.append(lathe(data, tm[:3], tm[3:], "TM4 to TM6 kept out of six alike"))
    for run in (1, 2, 3):
        case = spindle_22(data, run)
        case.fit, case.judge, case.fit_files, case.judge_files = case.judge, case.fit, case.judge_files, case.fit_files
        case.split = f"fit run {run} alone"
        result.append(case)
    path = os.path.join(data, "fl_thermal", "first_28h.csv")
    for split, fit, judge in (("fit 0-16 h, judge 16-28 h", between(0, 16), between(16, 99)),
                              ("fit 8-20 h, judge 20-28 h", between(8, 20), between(20, 99))):
        for channel in range(1, 6):
            result.append(parted("fl_thermal", path, split, fit, judge, f"ch{channel}_um", [f"t{i}_degC" for i in range(1, 17)], every=4,
                                 drive="speed_rpm"))
    return result
