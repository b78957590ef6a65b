#!/usr/bin/python3
"""Runs `driftwright follow` with a real mosquitto on loopback that is killed again and again. Rows come late, twice, swapped or not at all, are unreadable, nest
without end or have megabytes.

    follow_mqtt_test.py PROGRAM
"""
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

from one_head import HEAD
import waiting
from waiting import broker, free_port, need_mosquitto

SLEW_UM_S = 0.05
KILLS = 5


def publish(port, topic, text):
    return subprocess.run(["mosquitto_pub", "-h", "127.0.0.1", "-p", str(port), "-t", topic, "-s"], input=text.encode(), capture_output=True).returncode == 0


def main():
    program = sys.argv[1]
    need_mosquitto()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="driftwright_mqtt-"))
    os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
    (folder / "head.yaml").write_text(HEAD)
    port = free_port()
    draw = random.Random(23)
    follow = subprocess.Popen([program, "follow", "head.yaml", "--mqtt", f"127.0.0.1:{port}", "--from", "mill/row", "--to", "mill/correction", "--slew",
                               f"{SLEW_UM_S} um/s"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=folder, text=True)  # before there is a broker
    lines = []
    threading.Thread(target=lambda: lines.extend(json.loads(line) for line in iter(follow.stdout.readline, "")), daemon=True).start()
    server = broker(folder, port)
    try:
        nested = '{"time_s":' + "[" * 45000 + "]" * 45000 + "}"
        large = (json.dumps({"time_s": 1, "speed_rpm": 9000, "ambient_degC": 20}) + "\n") * 40000  # 2 MB; it would be a valid row
        words, n_waited = [], 0
        threading.Thread(target=lambda: words.extend(iter(follow.stderr.readline, "")), daemon=True).start()
        while not any("waits for a header or a JSON row" in w for w in words):  # no first message may end the run
            n_waited += 1
            assert n_waited < 100 and follow.poll() is None, words
            publish(port, "mill/row", nested)
            time.sleep(0.2)
        for _ in range(100):  # until the link is there
            publish(port, "mill/row", json.dumps({"time_s": 0, "speed_rpm": 2000, "ambient_degC": 20}))
            if lines:
                break
            time.sleep(0.2)
        assert lines, "no line came"
        for text, why in ((nested, "more than 100 deep"), (large, "more than 100000 characters")):
            publish(port, "mill/row", text)
            waiting.wait_for(why, lambda: any(why in line.get("why", "") for line in lines), told=lambda: words)
        late, row, n_heard = [], 0, []
        for part in range(KILLS + 1):
            before = len(lines)
            deadline = time.monotonic() + 60
            sent = 0
            while (sent < 15 or len(lines) - before < 8) and time.monotonic() < deadline:
                row += 1
                sent += 1
                values = {"time_s": 60 * row, "speed_rpm": 2000, "ambient_degC": 20}
                kind = draw.random()
                if kind < 0.1:
                    late.append(values)
                    continue
                if kind < 0.2:
                    values["ambient_degC"] = draw.choice([None, 1e9, "warm"])
                publish(port, "mill/row", json.dumps(values))
                if kind > 0.9:
                    publish(port, "mill/row", json.dumps(values))
                if 0.8 < kind < 0.9:
                    publish(port, "mill/row", "no row at all")
                if late and kind > 0.5:
                    publish(port, "mill/row", json.dumps(late.pop()))
            n_heard.append(len(lines) - before)
            if part < KILLS:
                server.send_signal(signal.SIGKILL)
                server.wait()
                time.sleep(draw.uniform(0.1, 1.5))
                server = broker(folder, port)
        heard = subprocess.Popen(["mosquitto_sub", "-h", "127.0.0.1", "-p", str(port), "-t", "mill/correction", "-C", "1", "-W", "30"],
                                 stdout=subprocess.PIPE, text=True)
        for _ in range(100):
            row += 1
            publish(port, "mill/row", json.dumps({"time_s": 60 * row, "speed_rpm": 2000, "ambient_degC": 20}))
            if heard.poll() is not None:
                break
            time.sleep(0.2)
        correction = json.loads(heard.communicate()[0])
        assert "nose_z" in correction["axes"], correction
        follow.send_signal(signal.SIGTERM)
        follow.wait(timeout=30)
        waiting.wait_for("last words", lambda: any("rows," in w for w in words))
        words = "".join(words)
        assert follow.returncode == 0, (follow.returncode, words)
        assert min(n_heard) >= 8, (n_heard, words)
        last_um, last_s = 0.0, 0.0
        for line in lines:
            um = line["axes"]["nose_z"]["correction_um"]
            now_s = line.get("run_s") if line.get("run_s") is not None else last_s
            assert abs(um - last_um) <= SLEW_UM_S * (now_s - last_s) + 1e-6, (last_um, line)
            last_um, last_s = um, now_s
        assert last_um > 5.0, last_um
        assert "doubled" in words and "unreadable_row" in words, words
        print(f"{len(lines)} lines over {KILLS} kills, {n_heard} between them; at the end {last_um:.2f} um; {words.strip()}")
    finally:
        for process in (follow, server):
            if process.poll() is None:
                process.kill()
        shutil.rmtree(folder, ignore_errors=True)


main()
