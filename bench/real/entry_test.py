#!/usr/bin/env python3
"""The splits of the scoreboard, and what entrants get and hand in."""
import contextlib
import csv
import io
import math
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import entry
import fetch
import records
import score

TOML = """
[record.oven]
file = "oven/{}.csv"
target = "z_um"
inputs = ["a_degC"]
from_start = true
[record.bench]
file = "bench.csv"
inputs = ["a_degC"]
drive = "power_W"
every = 2
target_within = [-100, 100]
[set.tried]
fixed = 2026-01-02
rows = [{id = "days", record = "oven", split = "Tuesday kept out", fit = ["monday"], judge = ["tuesday"]},
        {id = "end", record = "bench", split = "second half kept out", targets = ["z_um", "b_degC"], fit = [0, 1], judge = [1, inf]}]
"""


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        os.mkdir(os.path.join(self.folder, "oven"))
        self.write("splits.toml", TOML)
        self.write("oven/monday.csv", "# a comment\ntime_s,a_degC,z_um\n30,20,5\n60,21,7\n")
        self.write("oven/tuesday.csv", "time_s,a_degC,z_um\n30,22,\n60,23,4\n90,24,10\n")
        self.write("bench.csv", "time_s,a_degC,power_W,b_degC,z_um\n" + "".join(f"{600 * i},{i},{10 * i},{2 * i},{4000 if i == 8 else 3 * i}\n" for i in range(14)))

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as out:
            out.write(text)
        return path

    def cases(self):
        return records.cases(self.folder, "tried", path=os.path.join(self.folder, "splits.toml"))

    def rows(self, path):
        with open(path, newline="", encoding="utf-8") as file:
            return list(csv.reader(file))


class Splits(Folder):
    def test_rows_with_several_targets_are_one_each(self):
        days, end, other = self.cases()
        self.assertEqual([days.id, end.id, other.id], ["days_z", "end_z", "end_b"])
        self.assertEqual([days.unit, other.unit], ["um", "K"])
        self.assertEqual([t.time_s for t in days.fit + days.judge], [[30.0, 60.0], [30.0, 60.0, 90.0]])

    def test_every_second_row_within_limits_before_and_from_an_hour_on(self):
        _, end, other = self.cases()
        self.assertEqual(end.fit[0].time_s, [600.0 * i for i in (0, 2, 4, 6, 10, 12)])  # row 8 is outside of target_within
        self.assertEqual([end.is_fitted(t) for t in end.fit[0].time_s], [True, True, True, False, False, False])
        self.assertEqual([end.is_judged(t) for t in end.fit[0].time_s], [False, False, False, True, True, True])
        self.assertEqual(len(other.fit[0].time_s), 7)

    def test_mistakes_are_named(self):
        for old, new, said in (('"oven", split', '"owen", split', "row 'days' of set 'tried': there is no record 'owen'; the records are oven, bench"),
                               ("split =", "spilt =", "key 'spilt' is unknown"), ("every = 2", "evry = 2", "row 'end' of set 'tried': key 'evry' is unknown"),
                               (', judge = ["tuesday"]', "", "row 'days' of set 'tried': key 'judge' is missing"), ('"b_degC"]', '"z_degC"]', "two rows with the id 'end_z'")):
            self.assertIn(old, TOML)
            with self.assertRaisesRegex(ValueError, said):
                records.splits("tried", self.write("wrong.toml", TOML.replace(old, new)))
        with self.assertRaisesRegex(ValueError, "there is no set 'fourth'; the sets are tried"):
            records.splits("fourth", os.path.join(self.folder, "splits.toml"))

    def test_no_row_that_ships_is_fitted_on_what_it_is_judged_by(self):
        ids = []
        for name, n in (("older", 26), ("later", 24), ("third", 30)):
            rows = records.splits(name)
            self.assertEqual(len(rows), n)
            ids += [r["id"] for r in rows]
            for r in rows:
                if isinstance(r["fit"][0], str):
                    self.assertFalse(set(r["fit"]) & set(r["judge"]), r["id"])
                else:
                    self.assertTrue(r["fit"][1] <= r["judge"][0] or r["judge"][1] <= r["fit"][0], r["id"])
                self.assertNotIn(r["target"], [*r["inputs"], r.get("drive")])
        self.assertEqual(len(ids), len(set(ids)))


class Entry(Folder):
    def test_an_entrant_gets_inputs_and_the_targets_of_the_fit_alone(self):
        days, end, _ = self.cases()
        own = entry.write_inputs(days, self.folder)
        self.assertEqual(self.rows(own + "/fit/monday.csv"), [["time_s", "a_degC", "z_um"], ["30.0", "20.0", "0.0"], ["60.0", "21.0", "2.0"]])  # from its first reading
        self.assertEqual(self.rows(own + "/judge/tuesday.csv"), [["time_s", "a_degC", "judged"], ["30.0", "22.0", "0"], ["60.0", "23.0", "1"], ["90.0", "24.0", "1"]])
        own = entry.write_inputs(end, self.folder)
        self.assertEqual([r[-1] for r in self.rows(own + "/fit/bench.csv")], ["z_um", "0.0", "6.0", "12.0", "", "", ""])
        self.assertEqual([r[1:] for r in self.rows(own + "/judge/bench.csv")[:5]],
                         [["power_W", "a_degC", "judged"], ["0.0", "0.0", "0"], ["20.0", "2.0", "0"], ["40.0", "4.0", "0"], ["60.0", "6.0", "1"]])
        seen = entry.read_inputs(own)
        self.assertEqual((seen.target, seen.drive, seen.thermometers, seen.id), ("z_um", "power_W", ["a_degC"], "end_z"))

    def test_error_and_interval_of_a_prediction(self):
        days = self.cases()[0]  # 0 and 6 um are judged
        path = self.write("days_z.csv", "run,time_s,predicted,half_width\ntuesday.csv,90,3,2.9\ntuesday.csv,60.0000001,4,4\n")
        rms, covered = entry.scored(path, days)
        self.assertAlmostEqual(rms, math.sqrt((9 + 16) / 2), places=12)
        self.assertEqual(covered, 50.0)
        self.assertAlmostEqual(entry.no_correction(days), math.sqrt(36 / 2), places=12)
        self.assertIsNone(entry.scored(self.write("days_z.csv", "run,time_s,predicted\ntuesday.csv,90,3\ntuesday.csv,60,4\n"), days)[1])

    def test_predictions_that_cannot_be_scored(self):
        head, good = "run,time_s,predicted\n", "tuesday.csv,60,1\n"
        for text, said in ((head + good, "days_z.csv: 1 of 2 judged rows have no prediction, the first at time_s 90 of run tuesday.csv"),
                           (head + good + "tuesday.csv,91,1\n", "days_z.csv:3: run tuesday.csv has no judged row at time_s 91"),
                           (head + good + "tuesday.csv,30,1\n", "days_z.csv:3: run tuesday.csv has no judged row at time_s 30"),
                           (head + "monday.csv,60,1\n", "days_z.csv:2: there is no run 'monday.csv'; the runs are tuesday.csv"),
                           (head + good + "tuesday.csv,90,nan\n", "days_z.csv:3: predicted is 'nan'; it must be a finite number"),
                           (head + good + "tuesday.csv,90,\n", "days_z.csv:3: predicted is ''; it must be a finite number"),
                           (head + good + "tuesday.csv,60,2\n", "days_z.csv:3: run tuesday.csv at time_s 60 is predicted twice, first in line 2"),
                           (head + "tuesday.csv,60\n", "days_z.csv:2: 2 cells; the header has 3"),
                           ("time_s,predicted\n60,1\n", "days_z.csv:1: the header is 'time_s,predicted'"),
                           ("run,time_s,predicted,half_width\ntuesday.csv,60,1,-1\n", "days_z.csv:2: half_width is -1; it must not be negative")):
            with self.assertRaisesRegex(entry.EntryError, said):
                entry.scored(self.write("days_z.csv", text), self.cases()[0])
        with self.assertRaisesRegex(entry.EntryError, "end_z.csv: this file is missing"):
            entry.scored(os.path.join(self.folder, "end_z.csv"), self.cases()[1])


class Figures(Folder):
    def test_figures_of_three_rows(self):
        rows = []
        for i, (drift, mine, ridge, strategy, covered) in enumerate(((10, 2.0, 1.0, 0.5, 95), (10, 1.0, 1.0, 2.0, 90), (1, 1.05, 1.0, 3.0, 99))):
            s = score.Scores(self.cases()[i])
            s.drift, s.rms, s.covered, s.rivals = drift, {"mine": mine, "ridge": ridge, "mean": 9.0}, {"mine": covered}, {"ridge": ridge, "mean": 9.0, "one thermometer": strategy}
            rows.append(s)
        with contextlib.redirect_stdout(io.StringIO()) as out:
            score.print_figures(rows, ["mine", "ridge", "none"])
        lines = out.getvalue().strip().splitlines()[2:]
        self.assertEqual(lines, ["| mine | 3 of 3 | 1.05 | 4.00 (days_z) | 1 | 1 | 1.28 | 2 of 3 | 3 of 3 |",    # 2/0.5, 1/1, 1.05/1; 1.05 > drift of 1; 2/1 > 1.1; (2 1 1.05)^(1/3); 95 and 90 %, not 99
                                 "| ridge | 3 of 3 | 1.00 | 2.00 (days_z) | 0 | 0 | 1.00 | - | - |"])


class CommandLine(Folder):
    """score.py with a folder of records of its own: the incubator's row alone."""

    def score(self, *words):
        return subprocess.run([sys.executable, os.path.join(os.path.dirname(os.path.abspath(__file__)), "score.py"), "-d", self.folder, "-o", self.folder + "/out", *words, "incubator 2021"],
                              capture_output=True, text=True)

    def setUp(self):
        super().setUp()
        os.mkdir(os.path.join(self.folder, "incubator"))
        rows = "".join(f"{15 * i},{i % 2},21,{20 + i % 5},{22 + i % 3}\n" for i in range(94))
        self.write("incubator/2021-01-22_lid_opening.csv", "time_s,heater_W,room_degC,inside_2_degC,inside_3_degC\n" + rows)

    def test_one_table_with_an_entry_beside_the_baselines(self):
        self.assertEqual(self.score("--inputs", self.folder + "/inputs").returncode, 0)
        rows = [r for r in self.rows(self.folder + "/inputs/incubator_2021_end_inside_2/judge/2021-01-22_lid_opening.csv")[1:] if r[-1] == "1"]
        self.assertEqual(len(rows), 47)
        os.mkdir(self.folder + "/mine")
        truth = [f"2021-01-22_lid_opening.csv,{r[0]},{20 + round(float(r[0]) / 15) % 5 + 0.5},0.4\n" for r in rows]
        self.write("mine/incubator_2021_end_inside_2.csv", "run,time_s,predicted,half_width\n" + "".join(truth))
        done = self.score("--enter", "mine", self.folder + "/mine")
        self.assertEqual(done.stderr, "")
        self.assertIn("| 0.50 (0 %) |", done.stdout)
        self.assertRegex(done.stdout, r"\| mine \| 1 of 1 \| 0\.\d\d \| 0\.\d\d \(incubator_2021_end_inside_2\) \| 0 \| 0 \| 0\.\d\d \| 0 of 1 \| 0 of 1 \|")

    def test_mistakes_end_with_2(self):
        for words, said in ((("--enter", "mine", self.folder + "/mine"), "mine/incubator_2021_end_inside_2.csv: this file is missing"),
                            (("--enter", "ridge", self.folder), "--enter ridge: this name is taken"), (("-s", "fourth"), "there is no set 'fourth'"),
                            (("-d", self.folder + "/none"), "there is no such folder of records"), (("--diagnosis",), "--diagnosis requires --program"),
                            (("lathe",), "2016-12-30_TM1.csv: row 'lathe_days_diameter' requires this file")):
            done = self.score(*words)
            self.assertEqual((done.returncode, said in done.stderr), (2, True), done.stderr)


class Fetched(unittest.TestCase):
    def test_conversions_of_sources(self):  # first lines of the sources, and of the records that records.sha256 is of
        printer = ("# step_dist=0.0025\nsample,time,mcu_pos_z,frame_t,chamber_t,bed_t,bed_target,he_t,he_target\n"
                   "0,2021/06/13-05:42:16,-89869,21.904961377645936,22.791379232062354,23.426148642112906,105.0,23.69877320371435,100.0\n"
                   "0,2021/06/13-05:42:20,-89865,21.927560388636202,23.467930994641904,26.03203107645634,105.0,32.280772582015715,100.0\n")
        self.assertEqual(fetch.printer(printer).splitlines()[1:], ["time_s,frame_degC,chamber_degC,bed_degC,bed_target_degC,drift_um",
                         "0,21.904961377645936,22.791379232062354,23.426148642112906,105.0,0.0", "4,21.927560388636202,23.467930994641904,26.03203107645634,105.0,10.0"])
        house = (";t;Ps;Ta;yTi;Thm\n0;2021-11-22 09:00:00;0.1972222222222222;7.4;18.955;0.0\n34;2021-11-22 17:30:00;0.0;2.9;18.247333333333337;65.48833723653397\n")
        self.assertEqual(fetch.house(house).splitlines()[1:], ["0,0.1972,7.4,18.955,0.0", "30600,0.0,2.9,18.247,65.4883"])


if __name__ == "__main__":
    unittest.main()
