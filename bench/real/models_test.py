#!/usr/bin/env python3
"""Known values for models.py."""
import csv
import math
import os
import random
import tempfile
import unittest

import models
import program
import records


def write(path, seed):
    """A displacement of 4 um after 20 min while the spindle turns, and of 0.5 um for 1 K of the ambient after 60 min; a second column that no drive explains."""
    rng = random.Random(seed)
    speed = on = 0.0
    ambient = late = 20.0
    with open(path, "w", newline="", encoding="utf-8") as out:
        rows = csv.writer(out)
        rows.writerow(["time_s", "speed_rpm", "ambient_degC", "nose_um", "noise_um"])
        for i in range(600):
            rows.writerow([60 * i, speed, ambient, 4.0 * on + 0.5 * late, rng.gauss(0.0, 3.0)])
            on += (1.0 - math.exp(-60.0 / 1200.0)) * ((speed > 0.0) - on)
            before, ambient = ambient, ambient + rng.gauss(0.0, 0.2)
            late += (1.0 - math.exp(-60.0 / 3600.0)) * (0.5 * (before + ambient) - late)
            if rng.random() < 0.03:
                speed = rng.choice([0.0, 1000.0, 2000.0])


class Models(unittest.TestCase):
    def test_regression(self):
        with tempfile.TemporaryDirectory() as folder:
            paths = [os.path.join(folder, f"{n}.csv") for n in range(3)]
            for seed, path in enumerate(paths):
                write(path, seed)
            case = records.Case("made up", "", "nose_um", [], [], [], judge_files=[paths[2]])
            self.assertLess(models.regression(case, paths[:2], folder, "nose_um"), 0.05)
            left = models.regression(case, paths[:2], folder, "noise_um")
            self.assertAlmostEqual(left, 3.0, delta=0.3)
            self.assertIsNone(models.regression(case, paths[:2], folder, "tail_um"))
            late = records.Case("made up", "", "nose_um", [], [], [], judge_files=[paths[2]], judge_rows=lambda t_s: t_s > 3e4)
            self.assertNotEqual(models.regression(late, paths[:2], folder, "noise_um"), left)

    def test_a_scenario_is_read_from_any_folder(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "extended.yaml")
            with open(path, "w", encoding="utf-8") as out:
                out.write('a: {csv: "../run.csv", measured: true}\nb: {csv: days.csv}\nc: {csv: "/run.csv"}\nd: {csv: /run.csv}\n')
            self.assertEqual(program.text_from_anywhere(path),
                             f'a: {{csv: "{folder}/../run.csv", measured: true}}\nb: {{csv: {folder}/days.csv}}\nc: {{csv: "/run.csv"}}\nd: {{csv: /run.csv}}\n')


if __name__ == "__main__":
    unittest.main()
