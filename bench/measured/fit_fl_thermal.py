#!/usr/bin/env python3
"""Fits the network of scenarios/measured/fl_thermal_network.yaml to a part of the record, and judges it by the rest.

    fit_fl_thermal.py first_28h.csv 0 20        fits hours 0 to 20 and judges by all others

It is a least-squares fit that shares no code with the program. Rows are one minute long, and the linear network is integrated exactly over each (one matrix
exponential for the spindle at rest and one for it turning). Rows are compared as means of five minutes. Capacities are fixed: with free heats and
sensitivities they only set scales. Priors are a factor of two for sizes and 8 um/K for sensitivities. Twelve rows count as one, because residuals are
correlated over an hour.
"""
import sys

import numpy as np
from scipy.linalg import expm
from scipy.optimize import least_squares

BODIES = ["air", "spindle", "head", "column", "bed", "drive"]
CAPACITY = np.array([50e3, 50e3, 50e3, 50e3, 50e3, 20e3])  # J/K
EXPONENT = np.array([2.0, 2.0, 1.5, 2.0, 2.0, 2.0])        # of heat that grows with speed
TO_HALL = {"air": 104.0, "spindle": 23.8, "head": 27.8, "column": 7.6, "bed": 1.85, "drive": 5.6}  # W/K; guesses, like all numbers below
GROWING = {"spindle": 300.0, "head": 200.0, "column": 200.0, "bed": 7.0}                           # W at 5000 rpm
WHILE_TURNING = {"spindle": 100.0, "column": 40.0, "bed": 4.0, "drive": 100.0}                      # W at any speed but 0
SEEN = {"ch1": ["air", "head", "bed", "column"], "ch2": ["air", "head", "bed", "column"], "ch3": ["air", "column", "head"],
        "ch4": ["air", "column", "head"], "ch5": ["air", "spindle", "bed"]}
MISSED_UM = {"ch1": 1.0, "ch2": 1.0, "ch3": 1.5, "ch4": 1.5, "ch5": 1.5}  # a model of this kind
MISSED_K = 0.5                                                            # of t5
ROWS_AS_ONE = 12.0

LABELS = ([("hall", b) for b in TO_HALL] + [("growing", b) for b in GROWING] + [("turning", b) for b in WHILE_TURNING] +
          [("link", "drive-bed"), ("oil", "spindle")])
GUESS = np.log(list(TO_HALL.values()) + list(GROWING.values()) + list(WHILE_TURNING.values()) + [0.4, 20.0])
KNOWN_TO = np.array([0.7] * (len(GUESS) - 1) + [1.0])  # of the logarithm


def read(path):
    lines = [line.strip().split(",") for line in open(path) if not line.startswith("#")]
    rows = np.array(lines[1:], dtype=float)
    start_degC = rows[0, lines[0].index("t16_degC")]
    rows = rows[: len(rows) // 4 * 4].reshape(-1, 4, rows.shape[1]).mean(1)
    return {name: rows[:, i] for i, name in enumerate(lines[0])} | {"start_degC": start_degC}


def five_minutes(x):
    return x[: len(x) // 5 * 5].reshape(len(x) // 5, 5, *x.shape[1:]).mean(1)


def temperatures(record, x):
    """Rise of each body over its start, one row per minute. The machine starts in balance at rest, so idle heat cancels."""
    value = dict(zip(LABELS, np.exp(x)))
    per_body = lambda what: np.array([value.get((what, b), 0.0) for b in BODIES])
    speed, hall_K = record["speed_rpm"], record["t16_degC"] - record["start_degC"]
    turning = speed > 0
    n = len(BODIES)
    step, gain, to_hall = [], [], []
    for runs in (False, True):
        hall = per_body("hall") + (per_body("oil") if runs else 0.0)
        k = np.diag(hall)
        i, j, g = BODIES.index("drive"), BODIES.index("bed"), value[("link", "drive-bed")]
        k[i, i] += g; k[j, j] += g; k[i, j] -= g; k[j, i] -= g
        e = expm(60.0 * np.block([[-k / CAPACITY[:, None], np.eye(n)], [np.zeros((n, 2 * n))]]))
        step.append(e[:n, :n]); gain.append(e[:n, n:]); to_hall.append(hall)
    heat = (speed[:, None] / 5000.0) ** EXPONENT * per_body("growing") + np.outer(turning, per_body("turning"))
    t = np.zeros(n)
    out = np.empty((len(speed), n))
    for row, r in enumerate(turning.astype(int)):
        after = step[r] @ t + gain[r] @ ((heat[row] + to_hall[r] * hall_K[row]) / CAPACITY)
        out[row] = 0.5 * (t + after)
        t = after
    return out


def sensitivities(record, x, part):
    """Sensitivities [um/K] of each displacement to the bodies that it follows, its prediction, and the residual in units of the usual error."""
    t = five_minutes(temperatures(record, x))
    found, predicted, left = {}, {}, []
    for channel, bodies in SEEN.items():
        a, y = t[:, [BODIES.index(b) for b in bodies]], five_minutes(record[channel + "_um"])
        ridge = np.eye(len(bodies)) * MISSED_UM[channel] ** 2 * ROWS_AS_ONE / 8.0**2
        s = np.linalg.solve(a[part].T @ a[part] + ridge, a[part].T @ y[part])
        found[channel], predicted[channel] = dict(zip(bodies, s)), a @ s
        left += [(predicted[channel] - y)[part] / MISSED_UM[channel] / np.sqrt(ROWS_AS_ONE), s / 8.0]
    rise = (five_minutes(record["t5_degC"]) - t[:, BODIES.index("drive")])[part]
    left.append((rise - rise.mean()) / MISSED_K / np.sqrt(ROWS_AS_ONE))
    return found, predicted, np.concatenate(left), rise.mean() - record["start_degC"]


def main():
    record = read(sys.argv[1])
    begin, end = float(sys.argv[2]), float(sys.argv[3])
    hour = five_minutes(record["time_s"]) / 3600.0
    part = (hour >= begin) & (hour < end)
    residual = lambda x: np.concatenate([sensitivities(record, x, part)[2], (x - GUESS) / KNOWN_TO])
    x = least_squares(residual, GUESS, x_scale=KNOWN_TO).x
    found, predicted, _, above_hall_K = sensitivities(record, x, part)

    value = dict(zip(LABELS, np.exp(x)))
    for (what, where), number in value.items():
        print(f"{what:8} {where:10} {number:9.4g} {'W/K' if what in ('hall', 'link', 'oil') else 'W'}")
    # At rest the drive is warmer than the hall by its idle heat, and the bed by the heat that comes through the link.
    link, bed, drive = value[("link", "drive-bed")], value[("hall", "bed")], value[("hall", "drive")]
    bed_K = above_hall_K * link / (link + bed)
    print(f"idle heat of the drive {drive * above_hall_K + bed * bed_K:.4g} W: {above_hall_K:.3g} K above the hall, the bed {bed_K:.3g} K")
    for channel, s in found.items():
        print(f"{channel}: " + ", ".join(f"{b} {v:.4g}" for b, v in s.items()) + f" um/K; zero at rest {-s.get('bed', 0.0) * bed_K:.4g} um")
    rest = temperatures(record, x)
    print("largest rise [K]: " + ", ".join(f"{b} {np.abs(rest[:, i]).max():.3g}" for i, b in enumerate(BODIES)))
    for name, rows in (("fitted", part), ("kept out", ~part)):
        rms = [np.sqrt(np.mean((predicted[c] - five_minutes(record[c + "_um"]))[rows] ** 2)) for c in SEEN]
        print(f"RMS on the hours {name:8}: " + " / ".join(f"{r:.2f}" for r in rms) + " um")


if __name__ == "__main__":
    main()
