#!/usr/bin/python3
"""Measures how soon `driftwright follow` answers a row, and how much memory it takes over many rows (docs/how-to/follow.md).

    follow.py PROGRAM latency RECORD.csv [rows] -- MODEL...    sends each row once the last one is answered; quantiles of the answer times
    follow.py PROGRAM memory  RECORD.csv ROWS   -- MODEL...    sends the record again and again, with times that continue; resident memory
    follow.py PROGRAM trial   RECORD.csv [pace] -- MODEL...    24 h of the record at 1000 times its pace over a mosquitto that is killed 20 times, with rows
                                                               late, doubled, swapped, missing, none; clocks that are set; a thermometer that is pulled
"""
import json
import math
import pathlib
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

CHECKED = {factor * 10**power for factor in (1, 2, 5) for power in range(3, 9)}  # numbers of rows after which memory is measured


def rows_of(path):
    lines = [line for line in pathlib.Path(path).read_text().splitlines() if line and not line.startswith("#")]
    return lines[0], lines[1:]


def resident_kB(process):
    for line in pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return int(line.split()[1])
    return 0


KILLS, TRIAL_s, PULLED_s, SLEW_UM_S = 20, 86400.0, 8 * 3600.0, 0.02
CLOCKS = [(5 * 3600.0, 3000.0), (14 * 3600.0, -7200.0), (20 * 3600.0, 30 * 86400.0)]  # hour at which the source's clock is set, and by how much


def broker(folder, port):
    (folder / "broker.conf").write_text(f"listener {port} 127.0.0.1\nallow_anonymous true\n")
    started = subprocess.Popen([shutil.which("mosquitto", path="/usr/sbin:/usr/bin"), "-c", folder / "broker.conf"], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    for _ in range(400):
        with socket.socket() as s:
            if s.connect_ex(("127.0.0.1", port)) == 0:
                return started
        time.sleep(0.025)
    sys.exit("mosquitto does not listen")


class Trial:
    """One run: rows are published through the broker with faults; it keeps each line and its time."""

    def __init__(self, program, record, pace, models):
        self.header, rows = rows_of(record)
        self.names = self.header.split(",")
        cells = [dict(zip(self.names, row.split(","))) for row in rows]
        first_s = float(cells[0]["time_s"])
        self.rows = [c for c in cells if float(c["time_s"]) - first_s <= TRIAL_s]
        self.program, self.pace, self.models, self.draw = program, pace, models, random.Random(23)
        self.lines, self.counts = [], {}
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="driftwright_trial-"))
        with socket.socket() as s:
            s.bind(("127.0.0.1", 0))
            self.port = s.getsockname()[1]

    def listen(self):
        for text in iter(self.follow.stdout.readline, ""):
            self.lines.append((time.perf_counter(), json.loads(text)))

    def speak(self):
        """Starts a publisher of lines, which ends with its broker."""
        return subprocess.Popen(["mosquitto_pub", "-h", "127.0.0.1", "-p", str(self.port), "-t", "row", "-l"], stdin=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                text=True, bufsize=1)

    def publish(self, cells, time_s):
        values = {name: (float(text) if text not in ("", "nan") else None) for name, text in cells.items() if not name.endswith("_um")}
        values["time_s"] = time_s
        self.text(json.dumps(values))

    def text(self, line):
        try:
            self.speaker.stdin.write(line + "\n")
        except OSError:
            self.count("rows said while there was no broker")

    def count(self, what):
        self.counts[what] = self.counts.get(what, 0) + 1

    def run(self):
        server = broker(self.folder, self.port)
        self.follow = subprocess.Popen([self.program, "follow", *self.models, "--mqtt", f"127.0.0.1:{self.port}", "--from", "row", "--slew", f"{SLEW_UM_S} um/s"],
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        threading.Thread(target=self.listen, daemon=True).start()
        self.speaker = self.speak()
        first_s, length_s = float(self.rows[0]["time_s"]), float(self.rows[-1]["time_s"]) - float(self.rows[0]["time_s"])
        for _ in range(200):  # until it has subscribed
            self.publish(self.rows[0], first_s)
            time.sleep(0.1)
            if self.lines:
                break
        kills = sorted(self.draw.uniform(0.02, 0.97) * length_s for _ in range(KILLS))
        began, offset_s, waiting, back = time.perf_counter(), 0.0, [], None
        clocks = list(CLOCKS)
        for cells in self.rows[1:]:
            run_s = float(cells["time_s"]) - first_s
            time.sleep(max(0.0, began + run_s / self.pace - time.perf_counter()))
            if kills and run_s >= kills[0] and back is None:
                kills.pop(0)
                server.send_signal(signal.SIGKILL)
                server.wait()
                self.count("kills")
                back = time.perf_counter() + self.draw.uniform(0.05, 1.0)
            if back is not None and time.perf_counter() >= back:
                server, back = broker(self.folder, self.port), None
                self.speaker.kill()
                self.speaker.wait()
                self.speaker = self.speak()
            if clocks and run_s >= clocks[0][0]:
                offset_s += clocks.pop(0)[1]
                self.count("clock set")
            cells, time_s, kind = dict(cells), run_s + offset_s, self.draw.random()
            if run_s >= PULLED_s:
                cells[self.pulled] = "22"  # the thermometer hangs in the air
            if kind < 0.02:
                self.count("missing")
                continue
            if kind < 0.04:
                self.count("late")
                waiting.append((cells, time_s))
                continue
            if kind < 0.06:
                self.count("NaN")
                for name in self.draw.sample([n for n in self.names if n.endswith("_degC")], 3):
                    cells[name] = "nan"
            self.publish(cells, time_s)
            if kind > 0.98:
                self.count("doubled")
                self.publish(cells, time_s)
            elif kind > 0.96:
                self.count("unreadable")
                self.text("no row at all")
            if waiting and kind > 0.5:
                self.publish(*waiting.pop())
        time.sleep(2.0)
        self.follow.send_signal(signal.SIGTERM)
        words = self.follow.communicate(timeout=30)[1]
        for process in (server, self.speaker):
            process.kill()
        return words

    def judge(self):
        """Compares steps with the slew limit, and the residual with no correction, at the time of each row as `follow` took it."""
        first_s = float(self.rows[0]["time_s"])
        axes = list(self.lines[0][1]["axes"])
        most_step, why = 0.0, {}
        last = {a: 0.0 for a in axes}
        last_run_s, last_wall_s = 0.0, self.lines[0][0]
        in_force = []  # (real time of the run, corrections)
        for wall_s, line in self.lines:
            if line["state"] != "on":
                why.setdefault(line["state"], set()).add("".join(c for c in line.get("why", "NOTHING SAID") if not c.isdigit()))
            taken = line.get("run_s") is not None
            passed_s = line["run_s"] - last_run_s if taken else wall_s - last_wall_s + 0.5 if line["time_s"] is None and not line.get("faults") else 0.0
            for a in axes:
                um = line["axes"][a]["correction_um"]
                most_step = max(most_step, (abs(um - last[a]) - 1e-6) / (SLEW_UM_S * passed_s) if passed_s > 0 else (2.0 if abs(um - last[a]) > 1e-6 else 0.0))
                last[a] = um
            last_run_s, last_wall_s = (line["run_s"] if taken else last_run_s), wall_s
            if taken and line["time_s"] is not None:
                in_force.append((line["time_s"], dict(last)))
        told = {}
        for a in axes:
            truth = [float(c[a.removesuffix("_um") + "_um"]) for c in self.rows]
            truth = [t - truth[0] for t in truth]
            times = [float(c["time_s"]) - first_s for c in self.rows]
            at = self.on_record_clock(in_force)
            k, left = 0, []
            for t, um in zip(times, truth):
                while k + 1 < len(at) and at[k + 1][0] <= t:
                    k += 1
                left.append(um - at[k][1][a])
            told[a] = (math.sqrt(sum(u * u for u in truth) / len(truth)), max(map(abs, truth)), math.sqrt(sum(u * u for u in left) / len(left)), max(map(abs, left)))
        return most_step, why, told

    @staticmethod
    def on_record_clock(in_force):
        """Times of lines without the steps of the source's clock; lines come in order."""
        at, shift_s, clocks, last_s = [], 0.0, list(CLOCKS), 0.0
        for time_s, corrections in in_force:
            while clocks and abs(time_s - (shift_s + clocks[0][1]) - last_s) < abs(time_s - shift_s - last_s):
                shift_s += clocks.pop(0)[1]
            last_s = time_s - shift_s
            at.append((last_s, corrections))
        return at


def trial(program, record, pace, models):
    t = Trial(program, record, pace, models)
    t.pulled = next(n for n in t.names if n.endswith("_degC"))
    words = t.run()
    most_step, why, told = t.judge()
    shutil.rmtree(t.folder, ignore_errors=True)
    print(f"{len(t.rows)} rows, {t.counts}; {len(t.lines)} lines\n{words.strip()}")
    print(f"largest step: {most_step:.3f} of the slew limit")
    for state, reasons in why.items():
        print(f"{state}: {len(reasons)} reasons: {'; '.join(sorted(reasons))[:600]}")
    for axis, (rms, peak, rms_left, peak_left) in told.items():
        print(f"{axis}: RMS {rms:.2f} -> {rms_left:.2f} um, peak {peak:.2f} -> {peak_left:.2f} um")
    is_well = most_step <= 1.0 and all("NOTHING SAID" not in r for r in why.values()) and all(l <= r and pl <= p for r, p, l, pl in told.values())
    print("holds" if is_well else "DOES NOT HOLD")


def main():
    split = sys.argv.index("--")
    program, what, record = sys.argv[1:4]
    models = sys.argv[split + 1:]
    if what == "trial":
        return trial(program, record, float(sys.argv[4]) if split > 4 else 1000.0, models)
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
            if said in CHECKED or said == n:
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
