#!/usr/bin/python3
"""Tests a warm-up that was planned on a scenario on machines with other numbers. Each power, friction, film, joint and link is multiplied by exp(sigma N(0, 1)). The machine
is meshed, reduced and run again by `predict --start warmup.csv`, and its peak drift is judged.

    bench/warm_up_draws.py PROGRAM SCENARIO JOB WARMUP_CSV TOLERANCE_UM [SIGMA=0.2] [MACHINES=100] [FIRST_SEED=1]

It prints one row per machine, then how many stayed within the tolerance, with the 95 % interval of Clopper and Pearson. The reduced machines are kept in a separate folder.
"""
import csv
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

SCATTERED = ["power", "idle", "f0", "f1", "film", "growth", "conductance", "exchange"]


def scattered(text, sigma, seed):
    """Multiplies all scattered numbers of an effect by one random factor."""
    draw = random.Random(seed)
    lines, factor, inside = [], 1.0, False
    for line in text.splitlines():
        if re.match(r"\S", line):
            inside = line.startswith("effects:")
        if inside and "type:" in line:
            factor = draw.lognormvariate(0.0, sigma)
        if inside:
            for key in SCATTERED:
                line = re.sub(rf"\b{key}: ([0-9.eE+-]+)", lambda m: f"{m.group(0).split(':')[0]}: {float(m.group(1)) * factor:.6g}", line)
        lines.append(line)
    return "\n".join(lines) + "\n"


def within(n, k):
    """Bounds of a share, found by bisection of the binomial sums."""
    from math import comb

    def below(p, most):
        return sum(comb(n, i) * p**i * (1 - p) ** (n - i) for i in range(most + 1))

    def root(f):
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if f(middle) > 0.0 else (low, middle)
        return low

    return (root(lambda p: 0.025 - (1.0 - below(p, k - 1))) if k else 0.0, root(lambda p: below(p, k) - 0.025) if k < n else 1.0)


def main():
    program, scenario, job, warmup = sys.argv[1:5]
    tolerance_um = float(sys.argv[5])
    sigma = float(sys.argv[6]) if len(sys.argv) > 6 else 0.2
    n = int(sys.argv[7]) if len(sys.argv) > 7 else 100
    first = int(sys.argv[8]) if len(sys.argv) > 8 else 1
    text = pathlib.Path(scenario).read_text()
    kept = done = 0
    with tempfile.TemporaryDirectory(prefix="driftwright_draws-") as name:
        folder = pathlib.Path(name)
        for other in ("parts", "records"):
            if (pathlib.Path(scenario).resolve().parent / other).is_dir():
                (folder / other).symlink_to(pathlib.Path(scenario).resolve().parent / other)
        for seed in range(first, first + n):
            (folder / "drawn.yaml").write_text(scattered(text, sigma, seed))
            ran = subprocess.run([program, "predict", folder / "drawn.yaml", "--cyclogram", job, "--start", warmup, "-o", folder / "out"],
                                 capture_output=True, text=True, env={**os.environ, "XDG_CACHE_HOME": str(folder / "kept")})
            if ran.returncode != 0:
                sys.exit(f"machine {seed}: {ran.stderr.strip()[-300:]}")
            rows = list(csv.DictReader(line for line in (folder / "out/record.csv").open() if not line.startswith("#")))
            columns = [c for c in rows[0] if c.endswith("_um")]
            peak_um = max(abs(float(row[c]) - float(rows[0][c])) for c in columns for row in rows)
            kept += peak_um <= tolerance_um
            done += 1
            print(f"{seed},{peak_um:.2f}", flush=True)
    low, high = within(done, kept)
    print(f"{kept} of {done} within {tolerance_um:g} um: {100 * kept / done:.0f} % ({100 * low:.0f} to {100 * high:.0f})")


if __name__ == "__main__":
    main()
