#!/usr/bin/python3
"""Compares the Python package with the program: python_test.py PROGRAM (with PYTHONPATH at the package, in the project's folder)."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import pandas as pd

import driftwright as dw

PROGRAM = sys.argv.pop(1)
FP3 = "scenarios/fp3_spindle.yaml"
LUMPED = "scenarios/lumped_spindle.yaml"
FIRST = "scenarios/first_machine.yaml"


def program(*arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return done.stdout


def with_absolute_paths(path):
    """The text of a scenario, whose paths are relative to it, as the library gives it: for a file in any folder."""
    return re.sub(r'"([^"]*\.(?:csv|inp|step))"', lambda m: f'"{os.path.normpath(path.parent / m[1])}"', path.read_text())


def rows_of(path):
    """The lines of a record CSV without its comments."""
    return [line for line in pathlib.Path(path).read_text().splitlines() if not line.startswith("#")]


class Package(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def as_csv(self, table):
        dw.write_record(table, self.folder / "table.csv")
        return rows_of(self.folder / "table.csv")

    def test_predictions_are_the_program_s_to_the_last_digit(self):
        machine = dw.Machine(FP3)
        for cyclogram in ("chaotic", "heat_cool_1000"):
            program("predict", FP3, "--cyclogram", cyclogram, "-o", self.folder / cyclogram)
            self.assertEqual(self.as_csv(machine.predict(cyclogram)), rows_of(self.folder / cyclogram / "record.csv"))

    def test_simulations_are_the_program_s_to_the_last_digit(self):
        program("simulate", LUMPED, "--cyclogram", "shift", "-o", self.folder / "shift")
        self.assertEqual(self.as_csv(dw.Machine(LUMPED).simulate("shift")), rows_of(self.folder / "shift" / "record.csv"))

    def test_a_table_of_speeds_is_a_cyclogram(self):
        machine = dw.Machine(FP3)
        by_name = machine.predict("warm_up_2000")
        by_rows = machine.predict([(300 * 60, 2000)])
        by_table = machine.predict(by_name[["speed_rpm"]])
        for other in (by_rows, by_table):
            pd.testing.assert_frame_equal(by_name, other, check_exact=True)

    def test_many_at_once_are_each_alone(self):
        machine = dw.Machine(FP3)
        shifts = [[(600.0 * (i + 1), 200.0 + 50 * i), (900.0, 0.0)] for i in range(7)]
        for shift, record in zip(shifts, machine.predict_all(shifts)):
            pd.testing.assert_frame_equal(machine.predict(shift), record, check_exact=True)

    def test_row_by_row_is_the_run_at_once(self):
        machine = dw.Machine(FP3)
        whole = machine.predict("chaotic")
        speed = whole["speed_rpm"].to_numpy()
        run = machine.start()
        steps = [run.step(t, speed_rpm=speed[i]) for i, t in enumerate(whole.index[1:])]
        live = pd.DataFrame(steps)
        for column in ("drift_x_um", "drift_y_um", "drift_z_um"):
            np.testing.assert_allclose(live[column], whole[column].iloc[1:], atol=1e-9)
        for column in ("t05_degC", "t06_degC", "air_degC", "t_ambient_degC"):
            np.testing.assert_allclose(live[column], whole[column].iloc[1:], atol=1e-9)

    def test_row_by_row_follows_the_ambient_of_each_row(self):
        # A warmer ambient warms a machine that starts in balance with it: nothing moves against it.
        machine = dw.Machine(FP3)
        run = machine.start(ambient_degC=20.0)
        for minute in range(1, 2000):
            last = run.step(60.0 * minute, ambient_degC=25.0)
        self.assertGreater(last["t10_degC"], 24.0)
        self.assertLess(last["t10_degC"], 25.0)

    def test_fields_are_those_of_the_sensors(self):
        machine = dw.Machine(FP3)
        start, hot = machine.fields("warm_up_2000")
        mesh = machine.mesh()
        self.assertEqual(mesh.points_m.shape, hot.displacement_um.shape)
        self.assertLess(np.ptp(start.temperature_degC), 1e-6)
        t06 = np.argmin(np.linalg.norm(mesh.points_m - [0.0, 0.285, 1.3825], axis=1))  # quill over the front bearing
        read = machine.simulate("warm_up_2000")["t06_degC"].iloc[-1]
        self.assertAlmostEqual(hot.temperature_degC[t06], read, delta=0.5)  # the nearest node is up to 10 mm away
        as_meshio = machine.meshio(hot)
        as_meshio.write(self.folder / "hot.vtu")
        import meshio
        self.assertEqual(len(meshio.read(self.folder / "hot.vtu").points), len(mesh.points_m))

    def test_a_diagnosis_is_the_program_s(self):
        machine = self.folder / "machine.yaml"
        machine.write_text(pathlib.Path(FIRST).read_text().replace("sensors: [", "sensors: [{name: t_spindle, node: spindle}, "))
        pump = "  - {type: heat_source, node: housing, power: 40 W}\n"
        (self.folder / "truth.yaml").write_text(machine.read_text().replace("sensors: [", pump + "sensors: ["))
        truth = dw.Machine(self.folder / "truth.yaml")
        random = np.random.default_rng(3)
        files = []
        for cyclogram in truth.cyclograms:
            record = truth.simulate(cyclogram)
            for column in record.columns:
                noise = {"degC": 0.1, "um": 0.5}.get(column.rsplit("_", 1)[-1], 0.0)
                record[column] += noise * random.standard_normal(len(record))
            files.append(self.folder / f"{cyclogram}_measured.csv")
            dw.write_record(record, files[-1])
        arguments = [a for file in files for a in ("--measured", file)]
        program("diagnose", machine, *arguments, "-o", self.folder / "diagnosis")
        import json
        expected = json.loads((self.folder / "diagnosis" / "diagnosis.json").read_text())
        found = dw.Machine(machine).diagnose(files)
        self.assertEqual(found.causes[0].effect, "heat_source")
        self.assertEqual(found.verdict, expected["verdict"])
        self.assertEqual(found.reason, expected["reason"])
        self.assertEqual([(c.effect, c.where) for c in found.causes], [(c["effect"], c["where"]) for c in expected["causes"]])
        for ours, theirs in zip(found.causes, expected["causes"]):
            for p, q in zip(ours.parameters, theirs["parameters"]):
                np.testing.assert_allclose([p.value, p.low, p.high], [q["value"], *q["ci95"]], rtol=1e-5)
        self.assertEqual(found.extended_scenario, with_absolute_paths(self.folder / "diagnosis" / "extended.yaml"))
        self.assertEqual(found.not_written, [])
        for ours, theirs in zip(found.gain, expected["gain"]["channels"], strict=True):
            np.testing.assert_allclose([ours.rmse_all_before, ours.rmse_written], [theirs["rmse_all_before"], theirs["rmse_written"]], rtol=1e-5)
            self.assertLess(ours.rmse_written, 0.5 * ours.rmse_all_before)  # 40 W in the housing, and noise
        with self.assertRaisesRegex(dw.InputError, "^without: no candidate has the key 'heat_sorce'"):
            dw.Machine(machine).diagnose(files, without=["heat_sorce"])
        program("calibrate", machine, *arguments, "-o", self.folder / "calibration")
        self.assertEqual(dw.Machine(machine).calibrate(files).extended_scenario,
                         with_absolute_paths(self.folder / "calibration" / "calibrated.yaml"))

    def test_angles_of_rotary_axes_are_columns(self):
        table = pd.DataFrame({"position_c_deg": [0.0, 90.0]}, index=[0.0, 60.0])
        self.assertEqual(self.as_csv(table), ["time_s,position_c_deg", "0,0", "60,90"])

    def test_errors_are_python_s(self):
        with self.assertRaisesRegex(dw.InputError, "no_such.yaml"):
            dw.Machine("no_such.yaml")
        machine = dw.Machine(FP3)
        with self.assertRaisesRegex(dw.InputError, "warm_up_2000"):  # the message names the existing cyclograms
            machine.predict("warm_up")
        with self.assertRaisesRegex(dw.InputError, "names no unit"):
            machine.diagnose(pd.DataFrame({"speed": [1.0, 2.0, 3.0]}, index=[0.0, 1.0, 2.0]))
        with self.assertRaisesRegex(dw.InputError, "thermostat"):
            dw.Machine(LUMPED).start()
        with self.assertRaisesRegex(dw.InputError, "time must increase"):
            machine.start().step(-1.0)

    def test_every_verb_is_reachable(self):
        self.assertEqual(dw.command("check", LUMPED), 0)
        self.assertEqual(dw.command("check", "no_such.yaml"), 2)
        self.assertEqual(dw.command("simulate", LUMPED, "-o", self.folder / "simulated"), 0)
        self.assertTrue((self.folder / "simulated" / "report.html").exists())


if __name__ == "__main__":
    unittest.main(verbosity=2)
