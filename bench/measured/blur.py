#!/usr/bin/env python3
"""Adds noise to the readings of a record CSV, as much as the model errs that is compared with it.

    blur.py record.csv out.csv 0.5 5      white noise of 0.5 K on temperatures and 5 um on displacements; the same at each call

A diagnosis weighs readings by their noise. Thermometers of 0.02 K against a network that is good to 0.5 K give evidence of 1e5 nats for
whatever bends the model most; noise of the model's own size lets the causes be weighed as they deserve. Standard library only.
"""

import csv
import random
import sys

DRIVES = ("time_", "speed_", "ambient_", "feed_", "cutting_power_")


def blurred(rows, noise_K, noise_um):
    draw = random.Random(7)
    header = next(rows)
    yield header
    for row in rows:
        yield [cell if name.startswith(DRIVES) or not cell else
               f"{float(cell) + draw.gauss(0.0, noise_um if name.endswith('_um') else noise_K):.4f}"
               for name, cell in zip(header, row)]


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as source, open(sys.argv[2], "w", newline="", encoding="utf-8") as out:
        csv.writer(out, lineterminator="\n").writerows(blurred(csv.reader(source), float(sys.argv[3]), float(sys.argv[4])))
