#!/usr/bin/env python3
"""Closed forms for baselines.py."""
import math
import random
import unittest

import baselines
import records


def case(tables, **more):
    return records.Case("made up", "", "z_um", tables[:-1], tables[-1:], ["a_degC", "b_degC"], drive="speed_rpm", **more)


def table(seed, n=300):
    """z = 2 + 3 a - b + 5 times the spindle's turning with a lag of 20 min; one row per minute."""
    rng = random.Random(seed)
    columns = {n: [] for n in ("a_degC", "b_degC", "speed_rpm", "z_um")}
    speed = on = 0.0
    for _ in range(n):
        a, b = rng.uniform(20, 30), rng.uniform(20, 30)
        for name, value in zip(columns, (a, b, speed, 2.0 + 3.0 * a - b + 5.0 * on)):
            columns[name].append(value)
        on += (1.0 - math.exp(-60.0 / 1200.0)) * ((speed > 0.0) - on)
        if rng.random() < 0.05:
            speed = rng.choice([0.0, 1000.0, 2000.0])
    return records.Table(f"run {seed}", [60.0 * i for i in range(n)], columns)


class Baselines(unittest.TestCase):
    def test_lag_of_a_step_and_of_a_ramp(self):
        t = [2.0 * i for i in range(60)]
        for got, at in zip(baselines.lagged(t, [3.0] * 60, 60.0, True), t):
            self.assertAlmostEqual(got, 3.0 * (1.0 - math.exp(-at / 60.0)), places=12)
        for got, at in zip(baselines.lagged(t, [0.01 * s for s in t], 60.0, False), t):
            self.assertAlmostEqual(got, 0.01 * (at - 60.0 * (1.0 - math.exp(-at / 60.0))), places=4)  # h^2 / (12 tau) of the slope

    def test_ridge_of_one_column_shrinks_by_one_plus_the_penalty(self):
        rows = [([float(x)], 4.0 * x + 1.0) for x in range(11)]
        intercept, (slope,) = baselines.solve(baselines.sums(rows), 0.25)
        self.assertAlmostEqual(slope, 4.0 / 1.25, places=12)
        self.assertAlmostEqual(intercept, 21.0 - 5.0 * slope, places=12)  # through the means

    def test_a_column_that_repeats_another_or_stands_still_does_no_harm(self):
        rows = [([float(x), 2.0 * x, 7.0], 4.0 * x + 1.0) for x in range(11)]
        fit = baselines.solve(baselines.sums(rows), 1e-12)
        self.assertAlmostEqual(baselines.apply(fit, [20.0, 40.0, 7.0]), 81.0, places=6)

    def test_run_and_stop_and_memories_find_what_thermometers_miss(self):
        made = case([table(1), table(2), table(3)])
        left = {name: baselines.rms(made, predict(made)) for name, predict in baselines.BASELINES.items()}
        self.assertLess(left["and run/stop"], 1e-6)   # exactly the truth
        self.assertLess(left["and memories"], 0.01)
        self.assertGreater(left["thermometers"], 0.5)
        self.assertGreater(left["mean"], 5.0)         # with a and b alone: 3.2 * 10 / sqrt(12)

    def test_a_single_record_is_judged_on_other_rows_than_it_is_fitted_on(self):
        whole = table(4, 600)
        kept = [t >= 18000.0 for t in whole.time_s]
        for i, k in enumerate(kept):
            if k:
                whole.columns["z_um"][i] = 1000.0     # rows that the fit must not know
        made = records.Case("made up", "", "z_um", [whole], [whole], ["a_degC"], fit_rows=lambda t: t < 18000.0, judge_rows=lambda t: t >= 18000.0)
        self.assertGreater(baselines.rms(made, baselines.by_mean(made)), 900.0)
        self.assertGreater(baselines.rms(made, baselines.by_ridge(made)), 900.0)


if __name__ == "__main__":
    unittest.main()
