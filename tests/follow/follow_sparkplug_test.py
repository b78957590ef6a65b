#!/usr/bin/python3
"""Runs `driftwright follow --sparkplug` with a real mosquitto and payloads made by another program: births with aliases, data by alias and by name, signed numbers,
null, historical values, missing messages, deaths. follow_sparkplug_test.py PROGRAM"""
import functools
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

import waiting
from one_head import HEAD as SLOW_HEAD

HEAD = SLOW_HEAD.replace("60 kJ/K", "1.2 J/K")  # a small heat capacity: it is warm at once
INT16, INT32, FLOAT, DOUBLE, BOOLEAN, STRING, DATASET = 2, 3, 9, 10, 11, 12, 16
lines, words = [], []
wait_for = functools.partial(waiting.wait_for, told=lambda: (lines[-2:], words))


def main():
    try:
        from sparkplug_payload import Payload, payload
    except ImportError:
        print("no google.protobuf here; Debian's python3-protobuf has it")
        sys.exit(77)
    waiting.need_mosquitto()
    program = str(pathlib.Path(sys.argv[1]).resolve())
    port = waiting.free_port()
    folder = tempfile.mkdtemp(prefix="driftwright_sparkplug-")
    os.environ["XDG_CACHE_HOME"] = folder + "/cache"
    pathlib.Path(folder, "head.yaml").write_text(HEAD)

    def publish(kind, data, device="/spindle"):
        subprocess.run(["mosquitto_pub", "-h", "127.0.0.1", "-p", str(port), "-t", f"spBv1.0/shop/{kind}/mill{'' if kind[0] == 'N' else device}", "-q", "1", "-s"],
                       input=data, check=True)

    commands = []

    def listen_to_commands():
        heard = subprocess.Popen(["mosquitto_sub", "-h", "127.0.0.1", "-p", str(port), "-t", "spBv1.0/shop/NCMD/mill", "-F", "%x"], stdout=subprocess.PIPE, text=True)
        threading.Thread(target=lambda: commands.extend(Payload.FromString(bytes.fromhex(line)) for line in heard.stdout), daemon=True).start()
        return heard

    def follow(*topics):
        return subprocess.Popen([program, "follow", "head.yaml", "--mqtt", f"127.0.0.1:{port}", "--sparkplug", "shop/mill/spindle", "--every", "0.2 s", "--slew",
                                 "1000 um/s", *(word for topic in topics for word in ("--topic", topic))], stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=folder, text=True)

    def birth(number, speed=1000, ambient=20, extra=None):
        publish("NBIRTH", payload(0, {"name": "bdSeq", "datatype": 8, "long_value": number}, {"name": "Node Control/Rebirth", "datatype": BOOLEAN, "boolean_value": False}))
        publish("DBIRTH", payload(1, {"name": "Spindle/Speed", "alias": 5, "datatype": INT32, "int_value": speed,
                                      "properties": {"keys": ["engUnit"], "values": [{"type": STRING, "string_value": "rpm"}]}},
                                  {"name": "Ambient", "alias": 6, "datatype": INT16, "int_value": ambient},
                                  {"name": "Program", "alias": 7, "datatype": STRING, "string_value": "O1000"},
                                  {"name": "Tools", "datatype": DATASET, "dataset_value": {"num_of_columns": 1, "columns": ["n"], "types": [3]}}, *(extra or [])))

    def is_at(speed, ambient):  # 1.2 J/K on 20 W/K settle within 0.5 s
        um = (speed * 0.15 / 20 + ambient - 20) * 4
        return bool(lines) and abs(lines[-1]["axes"]["nose_z"]["predicted_um"] - um) < 0.05 and lines[-1]["state"] == "on"

    server = waiting.broker(folder, port)
    heard = listen_to_commands()
    time.sleep(0.5)
    running = follow("speed_rpm=Spindle/Speed", "ambient_degC=Ambient")
    threading.Thread(target=lambda: lines.extend(json.loads(line) for line in running.stdout), daemon=True).start()
    threading.Thread(target=lambda: words.extend(running.stderr), daemon=True).start()
    try:
        wait_for("request for a birth", lambda: commands)
        asked = commands[0].metrics[0]
        assert (asked.name, asked.datatype, asked.boolean_value) == ("Node Control/Rebirth", BOOLEAN, True), commands
        publish("DDATA", payload(9, {"alias": 5, "int_value": 2000}))  # data before the birth are not used
        birth(7)
        wait_for("drift of the birth", lambda: is_at(1000, 20))
        publish("DDATA", payload(2, {"alias": 5, "int_value": 500}))
        wait_for("drift of 500 rpm, told by alias", lambda: is_at(500, 20))
        publish("DDATA", payload(3, {"name": "Ambient", "datatype": INT16, "int_value": 0xFFFB}), "/spindle")
        wait_for("drift at -5 degC, told by name", lambda: is_at(500, -5))
        publish("DDATA", payload(4, {"name": "Spindle/Speed", "int_value": 9000}), "/table")  # data of another device, numbered in the same sequence
        publish("DDATA", payload(5, {"alias": 5, "int_value": 1500, "is_historical": True}, {"alias": 6, "is_null": True}))
        n = len(lines)
        wait_for("rows", lambda: len(lines) > n + 8)  # 1.6 s; the body settles in 0.5
        assert is_at(500, -5), lines[-1]  # historical values are not used; null is missing, and the last value is held
        publish("DDATA", payload(6, {"alias": 6, "datatype": INT16, "int_value": 22}))
        wait_for("drift at 22 degC", lambda: is_at(500, 22))
        # a message is missing: later ones are not used until the node publishes a new birth
        n = len(commands)
        publish("DDATA", payload(8, {"alias": 5, "int_value": 9000}))
        wait_for("request for a birth", lambda: len(commands) > n)
        wait_for("word of what is missing", lambda: any("message 7 of its node is missing" in w for w in words))
        birth(7, speed=2000, ambient=21)
        wait_for("drift of the second birth", lambda: is_at(2000, 21))
        # deaths: of an earlier birth, of the device, of the node
        publish("NDEATH", payload(None, {"name": "bdSeq", "datatype": 8, "long_value": 6}))
        publish("DDATA", payload(2, {"alias": 5, "int_value": 1800}))
        wait_for("drift behind another's death", lambda: is_at(1800, 21))
        publish("NDEATH", payload(None, {"name": "bdSeq", "datatype": 8, "long_value": 7}))
        wait_for("word of its death", lambda: any("has died" in w for w in words))
        # the broker ends: messages may have been missed
        n = len(commands)
        server.kill()
        server.wait()
        heard.kill()
        server = waiting.broker(folder, port)
        heard = listen_to_commands()
        wait_for("request for a birth behind a new link", lambda: len(commands) > n)
        birth(8, speed=1000, ambient=20)
        wait_for("drift of the third birth", lambda: is_at(1000, 20))
        publish("DDATA", b"\xff\xff no payload")
        wait_for("word on what is none", lambda: any("none of Sparkplug B" in w for w in words))
        running.send_signal(signal.SIGTERM)
        assert running.wait(30) == 0, words
        n = len(commands)
        wrong = follow("speed_rpm=Spindle/Sped", "ambient_degC=Ambient")
        wait_for("its request for a birth", lambda: len(commands) > n)
        birth(9)
        assert wrong.wait(60) == 2
        assert "Did you mean 'Spindle/Speed'?" in wrong.stderr.read()
        for address in ("shop", "shop/", "shop/+", "a/b/c/d"):
            done = subprocess.run([program, "follow", "head.yaml", "--mqtt", "localhost", "--sparkplug", address, "--topic", "speed_rpm=x"], cwd=folder, capture_output=True, text=True)
            assert done.returncode == 2 and "GROUP/NODE" in done.stderr, done
        print(f"{len(lines)} lines, {len(commands)} requests for a birth")
    finally:
        for process in (running, server, heard):
            if process.poll() is None:
                process.kill()
        shutil.rmtree(folder, ignore_errors=True)


main()
