#!/usr/bin/python3
"""Runs `driftwright follow --mtconnect --sample` with an agent that has a buffer, as the standard describes it. No observation is lost between two requests, if the agent gives
few at a time, or if it is unreachable for a while; `follow` reports when the agent restarted or lost observations. follow_sample_test.py PROGRAM"""
import csv
import datetime
import http.server
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse

from one_head import HEAD
from waiting import wait_for

PLACE = {"speed": ("Rotary", "RotaryVelocity", "s1", 'name="S1speed"'), "ambient": ("Environmental", "Temperature", "e2", ""), "load": ("Rotary", "Load", "l1", "")}

PROBE = ('<?xml version="1.0"?><MTConnectDevices xmlns="urn:mtconnect.org:MTConnectDevices:1.7"><Devices><Device id="d"><DataItems>'
         '<DataItem id="s1" type="ROTARY_VELOCITY" units="REVOLUTION/MINUTE"/><DataItem id="e2" type="TEMPERATURE" units="CELSIUS"/>'
         '</DataItems></Device></Devices></MTConnectDevices>')


def stamp(time_s):
    return datetime.datetime.fromtimestamp(time_s, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%fZ")


class Agent:
    """An agent with observations (sequence, time, key, value) in a buffer of limited size; it answers as MTConnect Standard part 1 says."""

    def __init__(self, size=1000, most=7):
        self.size, self.most, self.instance, self.lock, self.asked = size, most, 1, threading.Lock(), []
        self.start_anew()

    def start_anew(self):
        self.buffer, self.last = [], 0
        for key, value in (("speed", "1000"), ("ambient", "20"), ("load", "UNAVAILABLE")):
            self.observe(key, value)

    def observe(self, key, value, time_s=None):
        with self.lock:
            self.last += 1
            self.buffer = (self.buffer + [(self.last, time_s or time.time(), key, value)])[-self.size:]

    def open(self, port=0):
        agent = self

        class Answer(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                url = urllib.parse.urlparse(self.path)
                agent.asked.append(self.path)
                with agent.lock:
                    text = {"/current": agent.current, "/probe": lambda: PROBE}.get(url.path, lambda: agent.sample(urllib.parse.parse_qs(url.query)))()
                self.send_response(200)
                self.send_header("Content-Type", "text/xml")
                self.end_headers()
                self.wfile.write(text.encode())

            def log_message(self, *_):
                pass

        http.server.ThreadingHTTPServer.allow_reuse_address = True
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", port), Answer)
        self.port = self.server.server_address[1]
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        return self

    def leave(self):
        self.server.shutdown()
        self.server.server_close()

    def header(self, next_sequence):
        return (f'<Header creationTime="{stamp(time.time())}" sender="shop" instanceId="{self.instance}" version="1.7" bufferSize="{self.size}" '
                f'nextSequence="{next_sequence}" firstSequence="{self.buffer[0][0]}" lastSequence="{self.last}"/>')

    def streams(self, observations, next_sequence):
        text = ""
        for sequence, time_s, key, value in sorted(observations, key=lambda o: o[2]):  # by component, as agents write them
            component, tag, item, name = PLACE[key]
            text += (f'<ComponentStream component="{component}" componentId="c"><Samples><{tag} dataItemId="{item}" {name} sequence="{sequence}" '
                     f'timestamp="{stamp(time_s)}">{value}</{tag}></Samples></ComponentStream>')
        return (f'<?xml version="1.0"?><MTConnectStreams xmlns="urn:mtconnect.org:MTConnectStreams:1.7">{self.header(next_sequence)}'
                f'<Streams><DeviceStream name="mill" uuid="000">{text}</DeviceStream></Streams></MTConnectStreams>')

    def current(self):
        return self.streams({o[2]: o for o in self.buffer}.values(), self.last + 1)

    def sample(self, query):
        first, count = int(query["from"][0]), min(self.most, int(query.get("count", ["100"])[0]))
        if not self.buffer[0][0] <= first <= self.last + 1:
            return (f'<?xml version="1.0"?><MTConnectError xmlns="urn:mtconnect.org:MTConnectError:1.7"><Header creationTime="{stamp(time.time())}" sender="shop" '
                    f'instanceId="{self.instance}" version="1.7" bufferSize="{self.size}"/><Errors><Error errorCode="OUT_OF_RANGE">from must be at least '
                    f'{self.buffer[0][0]}</Error></Errors></MTConnectError>')
        found = [o for o in self.buffer if o[0] >= first][:count]
        return self.streams(found, found[-1][0] + 1 if found else first)


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory(prefix="driftwright_sample-") as folder:
        os.environ["XDG_CACHE_HOME"] = folder + "/cache"
        pathlib.Path(folder, "head.yaml").write_text(HEAD)
        agent = Agent().open()
        running = subprocess.Popen([program, "follow", "head.yaml", "--mtconnect", f"http://127.0.0.1:{agent.port}", "--sample", "--every", "0.5 s", "--topic",
                                    "speed_rpm=S1speed", "--topic", "ambient_degC=e2", "--record", "seen.csv"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=folder, text=True)
        lines, words = [], []
        threading.Thread(target=lambda: lines.extend(json.loads(line) for line in running.stdout), daemon=True).start()
        threading.Thread(target=lambda: words.extend(running.stderr), daemon=True).start()
        wait_for("line", lambda: lines)
        said = [1000]

        def observe(n):
            for _ in range(n):  # more observations than requests, and more than one answer contains
                said.append(said[-1] + 1)
                agent.observe("speed", str(said[-1]))
                agent.observe("load", "12")
                time.sleep(0.01)

        observe(60)
        agent.leave()
        wait_for("word that it is away", lambda: any("asks it again" in w for w in words))
        observe(60)
        agent.open(agent.port)
        wait_for("word that it is back", lambda: any("answers again" in w for w in words))
        observe(20)
        wait_for("row of now", lambda: time.time() - lines[-1]["time_s"] < 2.0 and lines[-1]["state"] == "on")
        time.sleep(1.5)
        n_currents = sum(path == "/current" for path in agent.asked)
        assert n_currents == 1, agent.asked  # it continues and never starts again
        assert agent.asked.count("/probe") == 1, agent.asked
        # the agent restarts: sequence numbers begin at 1 again
        with agent.lock:
            agent.instance = 2
        agent.start_anew()
        wait_for("word of the new agent", lambda: any("started anew (instanceId 2 in place of 1)" in w for w in words))
        wait_for("question for its units", lambda: agent.asked.count("/probe") == 2)
        said.append(1000)  # the first values
        observe(20)
        wait_for("row of now", lambda: time.time() - lines[-1]["time_s"] < 2.0)
        time.sleep(1.5)
        # while it is unreachable, more is observed than its buffer can hold
        agent.leave()
        n_said = len(said)
        agent.size = 30
        observe(40)
        agent.open(agent.port)
        wait_for("word that it has forgotten", lambda: any("no longer has the observations" in w for w in words))
        said[n_said:] = said[-1:]  # it then gives the latest values
        observe(5)
        time.sleep(1.5)
        running.send_signal(signal.SIGTERM)
        assert running.wait(30) == 0, words
        rows = list(csv.DictReader(line for line in pathlib.Path(folder, "seen.csv").open() if not line.startswith("#")))
        seen = [round(float(row["speed_rpm"])) for row in rows]
        changes = [v for k, v in enumerate(seen) if k == 0 or v != seen[k - 1]]
        assert changes == said, ([v for v in said if v not in changes], [v for v in changes if v not in said])
        times = [float(row["time_s"]) for row in rows]
        # rows have the spacing of the observations: 10 ms plus the delay of a thread
        apart = [b - a for a, b, u, v in zip(times, times[1:], seen, seen[1:]) if v == u + 1]
        assert 0.009 < sorted(apart)[len(apart) // 2] < 0.2, sorted(apart)
        agent.leave()
        print(f"{len(said)} values, {len(rows)} rows, none lost; {len(agent.asked)} questions")


main()
