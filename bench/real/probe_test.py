#!/usr/bin/env python3
"""Closed forms for probe.py."""
import math
import unittest

import probe
import records


def ramp(hours, rate_um_h, start_s=0.0):
    """A row each minute, judged from the first one on."""
    return start_s, [(start_s + 60.0 * i, rate_um_h * i / 60.0) for i in range(60 * hours + 1)]


class Held(unittest.TestCase):
    def test_of_a_ramp(self):
        """1 um an hour, a probing each hour without noise: the error runs from 1/60 to 1 um in each hour, and from 0 in the first."""
        hour = sum((i / 60.0) ** 2 for i in range(1, 61))
        self.assertAlmostEqual(probe.held([ramp(5, 1.0)], 3600.0, 0.0), math.sqrt(5.0 * hour / 301.0), 12)

    def test_each_run_begins_without_a_probing(self):
        one, two = (probe.held(runs, 3600.0, 0.0) for runs in ([ramp(3, 2.0)], [ramp(3, 2.0), ramp(3, 2.0, 1e6)]))
        self.assertAlmostEqual(one, two, 12)

    def test_noise_adds_its_square(self):
        still = [(60.0 * i, 0.0) for i in range(60 * 2000)]
        self.assertAlmostEqual(probe.held([(0.0, still)], 3600.0, 1.5), 1.5, delta=0.15)

    def test_a_judged_part_is_probed_in_its_first_row(self):
        self.assertAlmostEqual(probe.held([(0.0, [(7200.0 + 60.0 * i, 5.0) for i in range(100)])], 3600.0, 0.0), 0.5, 12)  # 5 um in one row of 100


class Rows(unittest.TestCase):
    def test_are_judged_ones_from_the_first_reading(self):
        table = records.Table("run", [0.0, 60.0, 120.0, 180.0], {"z_um": [None, 5.0, 7.0, 4.0]})
        case = records.Case("imbd_lathe", "", "z_um", [table], [table], [], from_start=True, judge_rows=lambda t: t >= 120.0)
        self.assertEqual(probe.judged_runs(case), [(0.0, [(120.0, 2.0), (180.0, -1.0)])])
        self.assertEqual(probe.group(case), "imbd_lathe z")


if __name__ == "__main__":
    unittest.main()
