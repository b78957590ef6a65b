#!/usr/bin/python3
"""How soon `driftwright follow` answers a row, and how much memory it takes over many (docs/follow.md).

    follow.py PROGRAM latency RECORD.csv [rows] -- MODEL...    each row said when the one before it is answered: quantiles of the time between
    follow.py PROGRAM memory  RECORD.csv ROWS   -- MODEL...    the record again and again, its time going on: resident memory on the way
"""
import pathlib
import subprocess
import sys
import time


def rows_of(path):
    lines = [line for line in pathlib.Path(path).read_text().splitlines() if line and not line.startswith("#")]
    return lines[0], lines[1:]


def resident_kB(process):
    for line in pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return int(line.split()[1])
    return 0


def main():
    split = sys.argv.index("--")
    program, what, record = sys.argv[1:4]
    models = sys.argv[split + 1:]
    n = int(sys.argv[4]) if split > 4 else None
    header, rows = rows_of(record)
    follow = subprocess.Popen([program, "follow", *models], stdin=subprocess.PIPE, stdout=subprocess.PIPE if what == "latency" else subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, text=True, bufsize=1 if what == "latency" else 1 << 16)
    follow.stdin.write(header + "\n")
    if what == "latency":
        took_ms = []
        for row in rows[:n]:
            said = time.perf_counter()
            follow.stdin.write(row + "\n")
            follow.stdout.readline()
            took_ms.append(1e3 * (time.perf_counter() - said))
        follow.stdin.close()
        follow.wait()
        first, rest = took_ms[0], sorted(took_ms[1:])
        at = lambda share: rest[min(len(rest) - 1, int(share * len(rest)))]
        print(f"{len(rows[:n])} rows: median {at(0.5):.2f} ms, 99 % {at(0.99):.2f} ms, longest {rest[-1]:.2f} ms, the first {first:.0f} ms")
        return
    times = [float(row.split(",", 1)[0]) for row in rows]
    rest = [row.split(",", 1)[1] for row in rows]
    length = times[-1] - times[0] + (times[1] - times[0])
    seen = []
    said = 0
    began = time.perf_counter()
    while said < n:
        turn = said // len(rows)
        for t, row in zip(times, rest):
            follow.stdin.write(f"{t + turn * length:.10g},{row}\n")
            said += 1
            if said in (1000, 10000, 100000, 200000, 500000, 1000000, 2000000, 5000000, n):
                follow.stdin.flush()
                seen.append((said, resident_kB(follow)))
            if said >= n:
                break
    follow.stdin.close()
    while follow.poll() is None:
        seen.append((said, resident_kB(follow) or seen[-1][1]))
        time.sleep(0.2)
    print(f"{said} rows in {time.perf_counter() - began:.0f} s; resident memory [kB] " + ", ".join(f"{n}: {kB}" for n, kB in dict(seen).items()))


main()
