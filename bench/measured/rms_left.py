#!/usr/bin/env python3
"""Prints the RMS difference between a simulated and a measured record, for each channel in both, on the rows of some hours.

    rms_left.py results/run/record.csv first_28h.csv 20 28
"""
import bisect
import math
import sys


def read(path):
    lines = [line.strip().split(",") for line in open(path) if not line.startswith("#")]
    rows = [[float(cell) if cell else math.nan for cell in line] for line in lines[1:]]
    return dict(zip(lines[0], zip(*rows)))


def at(times, values, t):
    i = min(max(bisect.bisect_right(times, t), 1), len(times) - 1)
    share = (t - times[i - 1]) / (times[i] - times[i - 1])
    return values[i - 1] + share * (values[i] - values[i - 1])


simulated, measured = read(sys.argv[1]), read(sys.argv[2])
begin, end = (3600.0 * float(h) for h in sys.argv[3:5])
for channel in simulated:
    if channel not in measured or channel in ("time_s", "speed_rpm"):
        continue
    left = [at(simulated["time_s"], simulated[channel], t) - y for t, y in zip(measured["time_s"], measured[channel])
            if begin <= t < end and not math.isnan(y)]
    name, unit = channel.rsplit("_", 1)
    print(f"{name} {math.sqrt(sum(e * e for e in left) / len(left)):.2f} {'K' if unit == 'degC' else unit}")
