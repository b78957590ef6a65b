#!/usr/bin/python3
"""A month of a simulated shop: `driftwright follow` corrects a mill for 30 days over MQTT while its friction grows by 1 % a day, doors open, thermometers fail,
rows are lost and clocks are set. What it did is compared with what a careful engineer would have done; the rules for both are KINDS, written before the
first run. docs/how-to/shop_month.md shows the result.

    shop_month_test.py PROGRAM [FOLDER [SEED]]      FOLDER: keeps minutes.csv, events.md, summary.json and month.svg there; SEED: another month, drawn by it
"""
import csv
import json
import math
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import threading

import waiting
from waiting import broker, free_port, need_mosquitto

TOP = pathlib.Path(__file__).resolve().parents[2]
EVENTS, BY_KEY = [], {}
DAYS, DAY_MIN, TARGET = 30, 1440, "drift_y"
BEGIN_H = 6  # the first row is of a Monday at six
GROWTH = 0.01  # of all heat of the spindle, a day
NOISE_K, BLOCK = 0.1, 200


WORDS = {"t05": "motor", "t06": "quill", "t07": "headstock's roof", "t09": "headstock's front"}  # the thermometers that the observer reads


class Event:
    """Something that happens in the shop.

    @param day, hour     of the month, by the clock on the wall; the month begins on day 1 at six
    @param lasts_min     until the cause is gone
    @param engineer      what a careful engineer does, in words
    @param answers       what counts as the same answer of `follow`: "drops NAME", "fades", "alarm", "goes on"
    @param within_min    how soon
    @param sensors       thermometers that are concerned
    """

    def __init__(self, key, day, hour, lasts_min, what, engineer, answers, within_min, sensors=()):
        names = ", ".join(WORDS[name] for name in sensors)
        self.key, self.engineer, self.within_min, self.sensors = key, engineer, within_min, sensors
        self.what = what.format(names)
        self.answers = [a for answer in answers for a in ([f"drops {s}" for s in sensors] if answer == "drops" else [answer])]
        self.first = int((day - 1) * DAY_MIN + (hour - BEGIN_H) * 60)
        self.last = self.first + lasts_min
        self.when = f"day {day}, {int(hour):02d}:{int(hour % 1 * 60):02d}"

    def holds(self, minute):
        return self.first <= minute < self.last


# A thermometer that is wrong by more than 1 K is out within half an hour; rows that are lost are held for 5 min and then faded out; what is only untidy changes
# nothing; a machine that no longer is as modelled is told, and corrected only as far as the thermometers bear it out.
KINDS = [
    ("door", 2, 9.0, 30, "the hall's door is open: 5 K colder", "goes on: the ambient thermometer shows it", ["goes on"], 30, ()),
    ("stuck", 3, 10.0, 360, "a thermometer ({}) is stuck at its reading", "leaves it out within half an hour, goes on with the others", ["drops"], 60, ("t05",)),
    ("fallen", 5, 9.0, 480, "a thermometer ({}) has fallen off and reads the air", "leaves it out, goes on", ["drops"], 30, ("t06",)),
    ("lead", 8, 8.0, 600, "the lead of a thermometer ({}) is broken: no value", "goes on with the others", ["goes on", "drops"], 30, ("t09",)),
    ("spikes", 10, 9.0, 120, "a bad contact ({}): single readings of 850 °C", "ignores them, goes on", ["goes on", "drops"], 30, ("t07",)),
    ("broker", 11, 10.0, 45, "the broker is down", "holds for 5 min, fades out, comes back with the rows", ["fades"], 20, ()),
    ("logger", 12, 11.0, 120, "the logger sends nothing", "holds for 5 min, fades out, comes back with the rows", ["fades"], 20, ()),
    ("clock", 15, 9.0, 1, "the logger's clock is set back by an hour", "goes on", ["goes on"], 30, ()),
    ("reboot", 16, 13.0, 10, "the computer that runs `follow` is switched off and on", "goes on from the saved state", ["goes on", "fades"], 20, ()),
    ("untidy", 17, 8.0, 120, "rows come twice, late or unreadable", "goes on", ["goes on"], 30, ()),
    ("speed", 18, 10.0, 60, "the control no longer gives the speed", "holds for 5 min, fades out", ["fades"], 20, ()),
    ("sun", 22, 12.0, 240, "the sun is on the ambient thermometer: up to 8 K too warm", "leaves it out, goes on with those on the machine", ["fades", "drops t_ambient"], 90, ()),
    ("swap", 24, 9.0, 420, "two thermometers ({}) are exchanged in their sockets", "leaves both out, goes on with the others", ["drops", "fades"], 60, ("t05", "t06")),
    ("fan", 29, 9.0, 480, "the motor's fan stops", "is told, has it mended; goes on, since the thermometers show it", ["alarm", "fades", "goes on"], 120, ()),
]


def events_of(seed):
    """The month above; or the same kinds at drawn times, for drawn durations, of drawn thermometers, in another weather and at other work."""
    if seed == 0:
        return [Event(*kind) for kind in KINDS]
    draw = random.Random(1000 + seed)
    days = sorted(draw.sample([d for d in range(2, DAYS) if (d - 1) % 7 < 5], len(KINDS)))
    order = draw.sample(KINDS, len(KINDS))
    events = []
    for day, (key, _, _, lasts, what, engineer, answers, within, sensors) in zip(days, order):
        lasts = lasts if key in ("clock", "reboot") else int(lasts * draw.uniform(0.5, 2.0))
        events.append(Event(key, day, round(4 * draw.uniform(7, 15)) / 4, lasts, what, engineer, answers, within, tuple(draw.sample(sorted(WORDS), len(sensors)))))
    return events


def month(draw):
    """Sections [(minutes, rpm)] of 30 days: work in two shifts from six to 22 h on five days a week, rest at night and on the week-end."""
    sections = []
    for day in range(DAYS):
        left = 16 * 60 if day % 7 < 5 else 0
        while left > 0:
            length = min(left, draw.randrange(15, 121))
            sections.append((length, 0 if draw.random() < 0.25 else draw.randrange(2, 21) * 100))
            left -= length
        sections.append((8 * 60 if day % 7 < 5 else DAY_MIN, 0))
    return sections


def ambient(draw):
    """Knots (minute, degC): a daily wave of 3 K, slow weather, two kelvin less on the week-end, and the open door."""
    knots, weather = [], 0.0
    door = BY_KEY["door"]

    def at(minute):
        hour = minute / 60
        return 20.0 + 1.5 * math.sin(2 * math.pi * (hour - 3) / 24) - 1.5 * math.sin(-2 * math.pi * 3 / 24)

    for hour in range(DAYS * 24 + 1):
        minute = 60 * hour
        if hour:
            weather = 0.97 * weather + 0.15 * draw.gauss(0, 1) - (0.06 if (hour // 24) % 7 >= 5 else 0.0)
        if not door.first <= minute <= door.last:
            knots.append((minute, at(minute) + weather))
    before = max(k for k in knots if k[0] < door.first)[1]
    knots += [(door.first, before), (door.first + 3, before - 5.0), (door.last, before - 5.0), (door.last + 5, before)]
    return sorted(knots)


def scenario(folder, seed):
    """The FP3 as it is in this shop, over the month."""
    draw = random.Random(2026 + seed)
    text = (TOP / "scenarios/fp3_spindle.yaml").read_text()
    grown = []
    laws = ["bearing_friction bearing_front", "bearing_friction bearing_rear", "heat_source headstock", "motor_loss motor"]
    for day in range(1, DAYS):
        for law in laws:
            grown.append(f"  - {{type: changed_law, law: {law}, factor: {(1 + GROWTH) ** day:.6f}, from: {day * 24} h, until: {(day + 1) * 24} h}}")
    fan = BY_KEY["fan"]
    grown.append(f"  - {{type: changed_law, law: forced_convection motor_outer, factor: 0.1, from: {fan.first} min, until: {fan.last} min}}")
    head, rest = text.split("# Ambient temperature over time", 1)
    text = head.rstrip() + "\n" + "\n".join(grown) + "\n\n# Ambient temperature over time" + rest
    before, after = text.split("\nambient:\n", 1)
    after = after[after.index("\n\n"):]
    text = before + "\nambient:\n" + "\n".join(f"  - [{m} min, {k:.3f} degC]" for m, k in ambient(draw)) + after
    sections = ", ".join(f"[{m} min, {n} rpm]" for m, n in month(draw))
    text = text.replace("cyclograms:\n", f"cyclograms:\n  month: [{sections}]\n", 1)
    path = folder / "month.yaml"
    path.write_text(text[:text.index("# The paper's programme")])
    return path


def run(program, *arguments, cwd):
    done = subprocess.run([program, *map(str, arguments)], cwd=cwd, capture_output=True, text=True)
    assert done.returncode == 0, (arguments, done.stdout[-2000:], done.stderr[-2000:])
    return done.stdout


def record_of(folder):
    path = next(folder.rglob("record.csv"))
    lines = [line for line in path.read_text().splitlines() if line and not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    return [{name: float(text) for name, text in row.items() if text} for row in rows]


class Shop:
    """What the sensors say, minute by minute: the true rows with noise and the month's faults."""

    def __init__(self, rows, sensors, seed):
        self.draw, self.rows, self.sensors, self.offset_s, self.waiting = random.Random(7 + seed), rows, sensors, 0.0, []

    def said(self, minute):
        """@return the texts that are published in this minute"""
        row, draw = self.rows[minute], self.draw
        values = {"time_s": row["time_s"], "speed_rpm": row["speed_rpm"]}
        for name in self.sensors:
            values[name] = round(row[name] + draw.gauss(0, NOISE_K), 2)
        air = values["t_ambient_degC"]

        def on(key):
            return BY_KEY[key].holds(minute)

        def concerned(key):
            return [f"{name}_degC" for name in BY_KEY[key].sensors] if on(key) else []

        for name in concerned("stuck"):
            values[name] = round(self.rows[BY_KEY["stuck"].first][name], 1)
        for name in concerned("fallen"):
            values[name] = round(air + (row[name] - air) * math.exp(-(minute - BY_KEY["fallen"].first) / 2), 2)
        for name in concerned("lead"):
            values[name] = None
        for name in concerned("spikes"):
            if draw.random() < 0.2:
                values[name] = 850.0
        if minute == BY_KEY["clock"].first:
            self.offset_s = -3600.0
        if on("sun"):
            values["t_ambient_degC"] = round(air + 8.0 * min(1.0, (minute - BY_KEY["sun"].first) / 60), 2)
        if on("swap"):
            one, other = concerned("swap")
            values[one], values[other] = values[other], values[one]
        if on("speed"):
            values["speed_rpm"] = None
        values["time_s"] += self.offset_s
        if on("logger") or on("broker") or on("reboot"):
            return []
        texts = [json.dumps(values)]
        if on("untidy"):
            kind = draw.random()
            if kind < 0.2:
                texts.append(texts[0])
            elif kind < 0.4:
                texts.append("no row at all")
            elif kind < 0.6:
                self.waiting.append(texts.pop())
            if self.waiting and kind > 0.7:
                texts.append(self.waiting.pop(0))
        return texts


class Follow:
    """The program at a real broker; one line is waited for for each message."""

    def __init__(self, program, model, folder):
        self.program, self.model, self.folder, self.port = program, model, folder, free_port()
        self.lines, self.words, self.server, self.process, self.speaker = [], [], None, None, None

    def start(self):
        if self.server is None:
            self.server = broker(self.folder, self.port)
        if self.process is None:
            self.process = subprocess.Popen([self.program, "follow", str(self.model), "--mqtt", f"127.0.0.1:{self.port}", "--from", "mill/row", "--to", "mill/correction",
                                             "--state", "state.json"], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            threading.Thread(target=self.listen, args=(self.process,), daemon=True).start()
            threading.Thread(target=lambda p: self.words.extend(iter(p.stderr.readline, "")), args=(self.process,), daemon=True).start()
        if self.speaker is None:
            self.speaker = subprocess.Popen(["mosquitto_pub", "-h", "127.0.0.1", "-p", str(self.port), "-q", "1", "-t", "mill/row", "-l"], stdin=subprocess.PIPE,
                                            stderr=subprocess.DEVNULL, text=True, bufsize=1)

    def listen(self, process):
        for text in iter(process.stdout.readline, ""):
            line = json.loads(text)
            if line["time_s"] is not None or line.get("faults"):  # an answer to a message, and no word about silence
                self.lines.append(line)

    def say(self, texts):
        n = len(self.lines) + len(texts)
        self.speaker.stdin.write("".join(text + "\n" for text in texts))
        self.speaker.stdin.flush()
        waiting.wait_for(f"{n} lines", lambda: len(self.lines) >= n or self.process.poll() is not None, told=lambda: (len(self.lines), self.words[-5:]))
        assert self.process.poll() is None, self.words[-5:]

    def hear_first(self, text):
        """Until the subscription is there, messages are lost: the first one is said again."""
        for _ in range(100):
            n = len(self.lines)
            self.speaker.stdin.write(text + "\n")
            try:
                waiting.wait_for("first line", lambda: len(self.lines) > n, seconds=0.5)
                break
            except AssertionError:
                continue
        waiting.time.sleep(1.0)  # those said before it are answered, too

    def stop(self, what):
        process = getattr(self, what)
        if process is not None and process.poll() is None:
            process.send_signal(signal.SIGKILL)
            process.wait()
        setattr(self, what, None)


def followed(program, model, folder, shop):
    """@return for each minute the last line of `follow`; None where it said nothing"""
    f = Follow(program, model, folder)
    f.start()
    of_minute = [None] * len(shop.rows)
    try:
        f.hear_first(shop.said(0)[0])
        of_minute[0] = f.lines[-1]
        block, minutes = [], []

        def send():
            if not block:
                return
            n = len(f.lines)
            f.say(block)
            for minute, line in zip(minutes, f.lines[n:]):
                of_minute[minute] = line
            block.clear()
            minutes.clear()

        for minute in range(1, len(shop.rows)):
            for key, what in (("broker", ("server", "speaker")), ("reboot", ("process",))):
                if minute == BY_KEY[key].first:
                    send()
                    if key == "reboot":
                        waiting.time.sleep(1.5)  # its state is saved each second
                    for one in what:
                        f.stop(one)
                if minute == BY_KEY[key].last:
                    f.start()
                    texts = shop.said(minute)
                    f.hear_first(texts[0])
                    of_minute[minute] = f.lines[-1]
                    break
            else:
                for text in shop.said(minute):
                    block.append(text)
                    minutes.append(minute)
            if len(block) >= BLOCK:
                send()
        send()
        f.process.send_signal(signal.SIGTERM)
        f.process.wait(timeout=30)
        assert f.process.returncode == 0, f.words[-3:]
    finally:
        for one in ("process", "speaker", "server"):
            f.stop(one)
    return of_minute, "".join(f.words)


def rms(values):
    values = [v for v in values if v is not None]
    return math.sqrt(sum(v * v for v in values) / len(values)) if values else float("nan")


def in_force(of_minute):
    """The correction on the machine's axis in each minute. Without a line `follow` holds 5 min and fades with 10 min, as it says of itself; a computer that is off
    leaves the control's watchdog to take the offset back: 0."""
    um, silent, last = [], 0, 0.0
    for minute, line in enumerate(of_minute):
        if BY_KEY["reboot"].holds(minute):
            um.append(0.0)
            continue
        if line is not None:
            last, silent = line["axes"][TARGET]["correction_um"], 0
            um.append(last)
            continue
        silent += 1
        um.append(last * (1.0 if silent <= 5 else math.exp(-(silent - 5) / 10)))
    return um


def answer_of(event, of_minute):
    """When and how `follow` answered an event: {"drops t05": minutes after its beginning, ...}"""
    found = {}
    before = next((of_minute[m] for m in range(event.first - 1, -1, -1) if of_minute[m]), None)
    doubted_before = {d.split(" ")[0] for d in before["axes"][TARGET]["doubted"]} if before else set()
    silent = 0
    for minute in range(event.first, event.last + 60):
        line = of_minute[minute] if minute < len(of_minute) else None
        after = minute - event.first
        if line is None:
            silent += 1
            if silent > 5:
                found.setdefault("fades", after)
            continue
        silent = 0
        axis = line["axes"][TARGET]
        for name in {d.split(" ")[0] for d in axis["doubted"]} - doubted_before:
            found.setdefault(f"drops {name}" if not name.startswith("the") else "doubts the model", after)
        if axis["trust"] < 0.9:
            found.setdefault("fades", after)
        if axis.get("alarm"):
            found.setdefault("alarm", after)
    return found


def picture(drift, left):
    """Drift and what is left of it over the month as SVG: the largest by size in each half hour; the events as bands with their numbers."""
    wide, high, step = 1100, 300, 30
    low, most = 1.1 * min(*drift, *left), 1.1 * max(*drift, *left)

    def at(minute, um):
        return 50 + (wide - 60) * minute / len(drift), 15 + (high - 35) * (most - um) / (most - low)

    def line(values, style):
        points = [max(values[m:m + step], key=abs) for m in range(0, len(values), step)]
        return f'<polyline fill="none" {style} points="' + " ".join("%.1f,%.1f" % at(k * step, um) for k, um in enumerate(points)) + '"/>'

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high + 24}" font-family="sans-serif" font-size="11">', '<rect width="100%" height="100%" fill="white"/>']
    for n, e in enumerate(sorted(EVENTS, key=lambda e: e.first), 1):
        x0, x1 = at(e.first, 0)[0], max(at(e.last, 0)[0], at(e.first, 0)[0] + 2)
        parts.append(f'<rect x="{x0:.1f}" y="12" width="{x1 - x0:.1f}" height="{high - 32}" fill="#f4c27a" fill-opacity="0.7"/><text x="{x0:.1f}" y="10">{n}</text>')
    for um in range(10 * math.ceil(low / 10), int(most) + 1, 10):
        x, y = at(0, um)
        parts.append(f'<line x1="{x}" x2="{wide - 10}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/><text x="{x - 6}" y="{y + 4:.1f}" text-anchor="end">{um}</text>')
    for day in range(0, DAYS + 1, 5):
        x = at(day * DAY_MIN, 0)[0]
        parts.append(f'<text x="{x:.1f}" y="{high}" text-anchor="middle">{day}</text>')
    parts += [line(drift, 'stroke="#999" stroke-width="1"'), line(left, 'stroke="#1f5fa8" stroke-width="1.2"'),
              f'<text x="50" y="{high + 18}">days; drift_y [\u00b5m]: <tspan fill="#777">without correction</tspan>, <tspan fill="#1f5fa8">with the correction of follow</tspan>; bands: the events of the table</text>', "</svg>"]
    return "\n".join(parts) + "\n"


def report(rows, of_minute, clean, folder):
    drift = [1.0 * row[f"{TARGET}_um"] - rows[0][f"{TARGET}_um"] for row in rows]
    corrected = in_force(of_minute)
    left = [d - c for d, c in zip(drift, corrected)]
    left_clean = [d - (line["axes"][TARGET]["correction_um"] if line else 0.0) for d, line in zip(drift, clean)]
    calm_wrong = [bool(line and line["axes"][TARGET]["trust"] > 0.95 and line["axes"][TARGET]["interval_95_um"] is not None
                       and abs(left[m]) > 2 * line["axes"][TARGET]["interval_95_um"]) for m, line in enumerate(of_minute)]
    table = ["| | when | what happens | a careful engineer | `follow` | drift, left, left without faults [um RMS] | calm and wrong [min] |", "|---|---|---|---|---|---|---|"]
    verdicts = {}
    for n, e in enumerate(sorted(EVENTS, key=lambda e: e.first), 1):
        span = range(e.first, min(e.last + 60, len(rows)))
        found = answer_of(e, of_minute)
        same = ("goes on" in e.answers and not {k for k in found if k == "fades" or k == "doubts the model"}) or any(
            found.get(a, math.inf) <= e.within_min for a in e.answers)
        wrong = sum(calm_wrong[m] for m in span)
        verdicts[e.key] = (same, wrong, rms([left[m] for m in span]), rms([drift[m] for m in span]))
        words = ", ".join(f"{k} after {v} min" for k, v in sorted(found.items(), key=lambda kv: kv[1])) or "goes on"
        table.append(f"| {n} | {e.when}, {e.last - e.first} min | {e.what} | {e.engineer} | {words}{'' if same else ' **(not the same)**'} | "
                     f"{rms([drift[m] for m in span]):.1f}, {rms([left[m] for m in span]):.1f}, {rms([left_clean[m] for m in span]):.1f} | {wrong} |")
    work = [m for m in range(len(rows)) if any(rows[k]["speed_rpm"] > 0 for k in range(max(0, m - 60), m + 1))]
    weeks = []
    for week in range(5):
        span = [m for m in work if week * 7 * DAY_MIN <= m < (week + 1) * 7 * DAY_MIN]
        weeks.append((week + 1, rms([drift[m] for m in span]), rms([left[m] for m in span]), rms([left_clean[m] for m in span])))
    summary = {"minutes": len(rows), "rms_drift_um": rms([drift[m] for m in work]), "rms_left_um": rms([left[m] for m in work]),
               "rms_left_without_faults_um": rms([left_clean[m] for m in work]), "calm_and_wrong_share": sum(calm_wrong) / len(rows),
               "same_answers": sum(v[0] for v in verdicts.values()), "events": len(EVENTS),
               "alarm_share": sum(bool(line and line["axes"][TARGET].get("alarm")) for line in of_minute) / len(rows),
               "alarm_share_without_faults": sum(bool(line["axes"][TARGET].get("alarm")) for line in clean) / len(rows),
               "on_share": sum(bool(line and line["state"] == "on") for line in of_minute) / len(rows)}
    if folder:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "events.md").write_text("\n".join(table) + "\n\n| week | drift [um RMS] | left | left without faults |\n|---|---|---|---|\n" + "".join(
            f"| {w} | {a:.1f} | {b:.1f} | {c:.1f} |\n" for w, a, b, c in weeks))
        with open(folder / "minutes.csv", "w") as f:
            out = csv.writer(f)
            out.writerow(["minute", "speed_rpm", "drift_um", "correction_um", "left_um", "left_without_faults_um", "interval_95_um", "trust", "state", "doubted", "alarm", "event"])
            for m, row in enumerate(rows):
                line = of_minute[m]
                axis = line["axes"][TARGET] if line else {}
                interval = axis.get("interval_95_um")
                out.writerow([m, f"{row['speed_rpm']:.0f}", f"{drift[m]:.2f}", f"{corrected[m]:.2f}", f"{left[m]:.2f}", f"{left_clean[m]:.2f}",
                              "" if interval is None else f"{interval:.2f}", axis.get("trust", ""), line["state"] if line else "no line", "; ".join(axis.get("doubted", [])),
                              axis.get("alarm", ""), " ".join(e.key for e in EVENTS if e.holds(m))])
        (folder / "month.svg").write_text(picture(drift, left))
        (folder / "summary.json").write_text(json.dumps(summary, indent=1))
    return summary, verdicts, table, weeks


def main():
    program = sys.argv[1]
    keep = pathlib.Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else None
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 0
    need_mosquitto()
    EVENTS.extend(events_of(seed))
    BY_KEY.update({e.key: e for e in EVENTS})
    with tempfile.TemporaryDirectory(prefix="driftwright_month-") as name:
        folder = pathlib.Path(name)
        if "XDG_CACHE_HOME" not in os.environ:
            os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
        run(program, "validate", TOP / "scenarios/fp3_spindle.yaml", "-o", folder / "judged", "--quiet", cwd=TOP)
        model = folder / "judged/models/observer.json"
        run(program, "predict", scenario(folder, seed), "--cyclogram", "month", "-o", folder / "truth", "--quiet", cwd=folder)
        rows = record_of(folder / "truth")[:DAYS * DAY_MIN]
        sensors = [n for n in rows[0] if n.endswith("_degC")]
        of_minute, words = followed(program, model, folder, Shop(rows, sensors, seed))
        (folder / "clean").mkdir()
        draw = random.Random(8 + seed)
        with open(folder / "clean/rows.csv", "w") as f:
            f.write(",".join(["time_s", "speed_rpm", *sensors]) + "\n")
            for row in rows:
                f.write(",".join([f"{row['time_s']:g}", f"{row['speed_rpm']:g}", *(f"{row[n] + draw.gauss(0, NOISE_K):.2f}" for n in sensors)]) + "\n")
        clean = [json.loads(line) for line in run(program, "follow", model, "--replay", folder / "clean/rows.csv", cwd=folder).splitlines()]
        summary, verdicts, table, weeks = report(rows, of_minute, clean, keep)
        print("\n".join(table))
        for week in weeks:
            print("week %d: drift %.1f um RMS, left %.1f, without faults %.1f" % week)
        print(json.dumps(summary, indent=1))
        print(words.strip()[-600:])
    if seed:
        return  # a month to look at
    assert summary["same_answers"] == summary["events"], verdicts
    assert summary["calm_and_wrong_share"] < 0.01, summary
    assert summary["rms_left_um"] < 0.25 * summary["rms_drift_um"], summary
    assert all(left < 1.05 * drift for _, _, left, drift in verdicts.values()), verdicts
    assert summary["rms_left_without_faults_um"] < 0.5, summary


if __name__ == "__main__":
    main()
