#!/usr/bin/env python3
"""Tests the scorer with diagnoses written by hand."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import score  # noqa: E402


def effect(key, where, law="", parameters=(), loud=30.0):
    numbers = [{"name": n, "unit": "", "value": v} for n, v in parameters]
    return {"effect": key, "law": law, "where": where, "parameters": numbers, "d_prime": loud, "d_prime_beside_others": loud}


def cause(key, where, parameters=(), alternatives=()):
    numbers = [{"name": n, "unit": "", "value": v, "ci95": ci} for n, v, ci in parameters]
    return {"effect": key, "where": where, "parameters": numbers, "alternatives": list(alternatives)}


class Rules(unittest.TestCase):
    def test_wilson(self):  # 9 of 10: Brown, Cai & DasGupta (2001) give 0.596 to 0.982
        low, high = score.wilson(9, 10)
        self.assertAlmostEqual(low, 0.596, 3)
        self.assertAlmostEqual(high, 0.982, 3)

    def test_places_and_kin(self):
        self.assertTrue(score.same_place(effect("sensor_swap", "b,a"), cause("sensor_swap", "a,b")))
        self.assertTrue(score.same_place(effect("coolant", "head", "coolant"), cause("heat_source", "head")))
        self.assertFalse(score.same_place(effect("heat_source", "head", "heat of speed", [("exponent", 2.0)]), cause("coolant", "head")))
        self.assertTrue(score.same_place(effect("contact", "box,hall"), cause("convection", "box")))
        self.assertFalse(score.same_place(effect("sensor_lag", "a"), cause("sensor_lag", "b")))

    def test_sets_of_four_name_nothing(self):
        others = [cause("contact", w) for w in "xyz"]
        self.assertIsNone(score.find(effect("sensor_lag", "a"), [cause("sensor_lag", "a", (), others)]))
        self.assertIsNotNone(score.find(effect("sensor_lag", "a"), [cause("sensor_lag", "a", (), others[:2])]))

    def test_two_want_two_causes(self):
        pair = [effect("sensor_lag", "a"), effect("sensor_bias", "b")]
        self.assertTrue(score.both_found(pair, [cause("sensor_bias", "b"), cause("sensor_lag", "a")]))
        self.assertFalse(score.both_found(pair, [cause("sensor_bias", "b", (), [cause("sensor_lag", "a")])]))

    def test_numbers_that_mean_the_same(self):
        of_speed = effect("heat_source", "a", "heat of speed", [("power", 100.0), ("at_speed", 2000.0), ("exponent", 2.0)])
        said = cause("heat_source", "a", [("power", 26.0, [20.0, 30.0]), ("at_speed", 1000.0, None)])
        self.assertEqual(score.comparable(of_speed, said), [("power", 25.0, [20.0, 30.0])])
        cooled = effect("coolant", "a", "coolant", [("power", 50.0)])
        self.assertEqual(score.comparable(cooled, cause("heat_source", "a", [("power", -49.0, [-55.0, -45.0])]))[0][1], -50.0)

    def test_a_table_of_files(self):
        with tempfile.TemporaryDirectory() as folder:
            for seed, (kind, effects, verdict, causes) in enumerate([
                    ("one", [effect("sensor_lag", "a")], "named", [cause("sensor_lag", "a")]),
                    ("one", [effect("sensor_lag", "a")], "consistent", []),
                    ("none", [], "consistent", []),
                    ("outside", [effect(None, "a", "travel creep")], "named", [cause("sensor_lag", "a")]),
                    ("outside", [effect(None, "a", "oscillating heat")], "named", [cause("heat_source", "a")]),
                    ("outside", [effect(None, "a", "oscillating heat")], "named", [cause("sensor_lag", "a")])]):
                at = os.path.join(folder, f"case_{seed:04d}", "diagnosis")
                os.makedirs(at)
                truth = {"seed": seed, "class": kind, "machine": "m", "without": None, "effects": effects,
                         "channels": [{"name": "a", "noise": 0.1}]}
                with open(os.path.join(at, "..", "truth.json"), "w", encoding="utf-8") as file:
                    json.dump(truth, file)
                gain = {"channels": [{"name": "a", "rmse_after": 0.2}]}
                with open(os.path.join(at, "diagnosis.json"), "w", encoding="utf-8") as file:
                    json.dump({"verdict": verdict, "causes": causes, "gain": gain}, file)
            at = os.path.join(folder, "case_0006")
            os.makedirs(at)
            with open(os.path.join(at, "truth.json"), "w", encoding="utf-8") as file:
                json.dump({"seed": 6, "class": "none", "machine": "m", "without": None, "effects": [], "channels": []}, file)
            with open(os.path.join(at, "diagnosis.log"), "w", encoding="utf-8") as file:
                file.write("gave up")
            script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "score.py")
            said = subprocess.run([sys.executable, script, folder], capture_output=True, text=True, check=True).stdout
        rows = {line.split("  ")[0]: line.split()[-1] for line in said.splitlines() if line[-1:].isdigit()}
        self.assertEqual(rows["one: cause named or in a set of three"], "1/2")
        self.assertEqual(rows["none: consistent"], "1/2")
        self.assertEqual(rows["outside: not confidently misnamed"], "1/3")
        self.assertIn("case_0001 m one:", said)
        self.assertIn("median 2.000", said)


if __name__ == "__main__":
    unittest.main()
