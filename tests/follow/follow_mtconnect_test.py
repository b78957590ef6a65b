#!/usr/bin/python3
"""Runs `driftwright follow` with an MTConnect agent: an HTTP server that answers as the standard says, is unreachable, or lacks an item. follow_mtconnect_test.py PROGRAM"""
import csv
import functools
import http.server
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading

import waiting
from one_head import HEAD as SLOW_HEAD

HEAD = SLOW_HEAD.replace("60 kJ/K", "1.2 J/K")  # a small heat capacity: it is warm at once
CURRENT = """<?xml version="1.0" encoding="UTF-8"?>
<MTConnectStreams xmlns="urn:mtconnect.org:MTConnectStreams:1.5">
  <Header creationTime="2026-11-23T12:00:00Z" sender="shop" instanceId="1" version="1.5" bufferSize="131072" nextSequence="9" firstSequence="1" lastSequence="8"/>
  <Streams>
    <DeviceStream name="mill" uuid="000">
      <ComponentStream component="Rotary" name="C" componentId="c1">
        <Samples>
          <RotaryVelocity dataItemId="c3" name="S1speed" sequence="4" subType="ACTUAL" timestamp="2026-11-23T11:59:59.1Z">{speed}</RotaryVelocity>
          <Load dataItemId="c4" sequence="5" timestamp="2026-11-23T11:59:59.1Z">12</Load>
          <AxisFeedrate dataItemId="c5" name="Xfrt" sequence="6" subType="ACTUAL" timestamp="2026-11-23T11:59:59.1Z">50</AxisFeedrate>
        </Samples>
      </ComponentStream>
      <ComponentStream component="Environmental" componentId="e1">
        <Samples><Temperature dataItemId="e2" sequence="7" timestamp="2026-11-23T11:50:00Z">{ambient}</Temperature></Samples>
        <Condition><Normal dataItemId="e3" sequence="8" timestamp="2026-11-23T11:50:00Z" type="TEMPERATURE"/></Condition>
      </ComponentStream>
    </DeviceStream>
  </Streams>
</MTConnectStreams>
"""
PROBE = """<?xml version="1.0"?><MTConnectDevices xmlns="urn:mtconnect.org:MTConnectDevices:1.5"><Header/><Devices><Device id="d" name="mill" uuid="000"><Components>
<Axes id="a"><Components><Rotary id="c1" name="C"><DataItems>
<DataItem category="SAMPLE" id="c3" name="S1speed" type="ROTARY_VELOCITY" subType="ACTUAL" units="REVOLUTION/MINUTE" nativeUnits="REVOLUTION/MINUTE"/>
<DataItem category="SAMPLE" id="c5" name="Xfrt" type="AXIS_FEEDRATE" subType="ACTUAL" units="{feed}" nativeUnits="MILLIMETER/MINUTE"/>
</DataItems></Rotary></Components></Axes><Environmental id="e1"><DataItems><DataItem category="SAMPLE" id="e2" type="TEMPERATURE" units="CELSIUS"/></DataItems></Environmental>
</Components></Device></Devices></MTConnectDevices>"""
WRONG = """<?xml version="1.0"?><MTConnectError xmlns="urn:mtconnect.org:MTConnectError:1.5"><Header/><Errors>
<Error errorCode="NO_DEVICE">Could not find the device turn</Error></Errors></MTConnectError>"""


class Agent:
    """An agent that answers with `values`. `feed`: the unit in its probe; None: it has no probe. `mode`: "html", a page for clients that do not request XML;
    301 ... 308, a redirection; "loop", an endless redirection."""

    def __init__(self, values, port=0, feed="MILLIMETER/SECOND", mode=""):
        agent = self
        self.values = values

        class Answer(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                if mode == "loop" or isinstance(mode, int) and not self.path.startswith("/new"):
                    self.send_response(302 if mode == "loop" else mode)
                    self.send_header("Location", "/new" + self.path if mode != "loop" else self.path)
                    self.send_header("Content-Length", "0")
                    self.end_headers()
                    return
                path = self.path.removeprefix("/new")
                text = CURRENT.format(**agent.values) if path in ("/current", "/mill/current") else WRONG
                if feed is not None and path in ("/probe", "/mill/probe"):
                    text = PROBE.format(feed=feed)
                if mode == "html" and "application/xml" not in self.headers.get("Accept", ""):
                    text = "<!DOCTYPE html><html><body>MTConnect <br> current</body></html>"
                self.send_response(200 if text is not WRONG else 404)
                self.send_header("Content-Type", "text/xml")
                self.end_headers()
                self.wfile.write(text.encode())

            def log_message(self, *_):
                pass

        http.server.ThreadingHTTPServer.allow_reuse_address = True
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", port), Answer)
        self.port = self.server.server_address[1]
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def leave(self):
        self.server.shutdown()
        self.server.server_close()


def follow(program, folder, address, *topics, record=()):
    return subprocess.Popen([program, "follow", "head.yaml", "--mtconnect", address, "--every", "0.2 s", "--slew", "1000 um/s", *record,
                             *(word for topic in topics for word in ("--topic", topic))],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=folder, text=True)


lines = []
wait_for = functools.partial(waiting.wait_for, told=lambda: lines[-3:])


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory(prefix="driftwright_mtconnect-") as folder:
        os.environ["XDG_CACHE_HOME"] = folder + "/cache"
        pathlib.Path(folder, "head.yaml").write_text(HEAD)
        agent = Agent({"speed": "1000", "ambient": "20"})
        address = f"http://127.0.0.1:{agent.port}"
        running = follow(program, folder, address + "/mill", "speed_rpm=S1speed", "ambient_degC=e2")
        threading.Thread(target=lambda: lines.extend(json.loads(line) for line in running.stdout), daemon=True).start()

        def is_at(um):  # 1.2 J/K on 20 W/K settle within 0.5 s to 300 W / 2000 rpm / 20 W/K * 4 um/K above the ambient
            return bool(lines) and abs(lines[-1]["axes"]["nose_z"]["predicted_um"] - um) < 0.05 and lines[-1]["state"] == "on"

        wait_for("drift of 1000 rpm", lambda: is_at(1000 * 0.15 / 20 * 4))
        agent.values = {"speed": "500", "ambient": "21.5"}
        wait_for("drift of 500 rpm in a warmer ambient", lambda: is_at((500 * 0.15 / 20 + 1.5) * 4))
        agent.values = {"speed": "UNAVAILABLE", "ambient": "21.5"}
        n = len(lines)
        wait_for("rows without a speed", lambda: len(lines) > n + 10)  # 2 s; the body settles in 0.5
        assert is_at((500 * 0.15 / 20 + 1.5) * 4), lines[-1]  # a missing value is held and does not become 0
        agent.values = {"speed": "500", "ambient": "21.5"}
        agent.leave()
        n = len(lines)
        wait_for("rows while it is away", lambda: len(lines) > n + 4)
        again = Agent({"speed": "2000", "ambient": "20"}, agent.port)
        wait_for("drift after it has come back", lambda: is_at(2000 * 0.15 / 20 * 4))
        running.send_signal(signal.SIGTERM)
        assert running.wait(30) == 0
        words = running.stderr.read()
        assert "asks it again every 0.2 s" in words and "answers again" in words, words
        # missing items, a missing device, an invalid address
        for where, topics, code, said in [(address, ["speed_rpm=S1speeed", "ambient_degC=e2"], 2, "Did you mean 'S1speed'?"), ("ftp://x", ["speed_rpm=c3", "ambient_degC=e2"], 2, "http://10.0.0.7:5000")]:
            wrong = follow(program, folder, where, *topics)
            assert wrong.wait(60) == code, (where, wrong.stderr.read())
            text = wrong.stderr.read()
            assert said in text, text
        # the map `topics` in the scenario that is followed, and in a scenario given with a model file; --topic replaces it
        pathlib.Path(folder, "mapped.yaml").write_text(HEAD + "topics: {speed_rpm: S1speed, ambient_degC: e2}\n")
        for words in (["mapped.yaml"], ["head.yaml", "--columns", "mapped.yaml"]):
            mapped = subprocess.Popen([program, "follow", *words, "--mtconnect", address, "--every", "0.2 s"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=folder, text=True)
            line = json.loads(mapped.stdout.readline())
            assert line["state"] == "on" and not line.get("faults"), line
            mapped.send_signal(signal.SIGTERM)
            assert mapped.wait(30) == 0
        for words, said in ((["mapped.yaml", "--topic", "speed_rpm=none", "--topic", "ambient_degC=e2"], "no data item of this id"), (["head.yaml"], "`topics` in the scenario")):
            done = subprocess.run([program, "follow", *words, "--mtconnect", address], capture_output=True, text=True, cwd=folder)
            assert done.returncode == 2 and said in done.stderr, done
        nobody = follow(program, folder, address + "/turn", "speed_rpm=c3", "ambient_degC=e2")
        assert "Could not find the device turn" in nobody.stderr.readline()
        nobody.send_signal(signal.SIGTERM)
        assert nobody.wait(30) == 0
        again.leave()
        # units from the probe, else from the standard; agents that answer with a page unless XML is requested, and agents that redirect
        for feed, mode, expected, said in [("MILLIMETER/SECOND", "", 3000.0, ""), ("MILLIMETER/MINUTE", "", 50.0, ""), ("INCH/MINUTE", "", 1270.0, ""),
                                           ("", "", 3000.0, "its probe gives no units for them, so the standard's units are taken: Xfrt (AxisFeedrate) in MILLIMETER/SECOND"),
                                           (None, "", 3000.0, "it gives no probe (it answers: Could not find the device turn), so the standard's units are taken: S1speed (RotaryVelocity)"),
                                           *(("MILLIMETER/SECOND", mode, 3000.0, "") for mode in ("html", 301, 302, 307, 308))]:
            moved = Agent({"speed": "1000", "ambient": "20"}, feed=feed, mode=mode)
            for device in ("", "/mill") if not mode else ("",):
                pathlib.Path(folder, "units.csv").unlink(missing_ok=True)
                running = follow(program, folder, f"http://127.0.0.1:{moved.port}{device}", "speed_rpm=S1speed", "ambient_degC=e2", "feed_x_mm_min=Xfrt", record=("--record", "units.csv"))
                for _ in range(2):
                    line = running.stdout.readline()
                    assert line and json.loads(line)["state"] == "on", (feed, mode, line or running.stderr.read())
                running.send_signal(signal.SIGTERM)
                assert running.wait(30) == 0
                words = running.stderr.read()
                assert said in words and (said or "units" not in words), (feed, mode, words)
                rows = list(csv.DictReader(line for line in pathlib.Path(folder, "units.csv").open() if not line.startswith("#")))
                assert rows and all(abs(float(row["feed_x_mm_min"]) - expected) < 1e-9 and float(row["speed_rpm"]) == 1000.0 for row in rows), (feed, mode, rows)
            moved.leave()
        # a unit of another quantity, a redirection without end
        other = Agent({"speed": "1000", "ambient": "20"}, feed="MILLIMETER")
        wrong = follow(program, folder, f"http://127.0.0.1:{other.port}", "speed_rpm=S1speed", "ambient_degC=e2", "feed_x_mm_min=Xfrt")
        assert wrong.wait(60) == 2
        words = wrong.stderr.read()
        assert "--topic feed_x_mm_min=Xfrt: the numbers of this data item are in MILLIMETER (by its probe)" in words and "must convert to the channel's unit 'mm/min'" in words, words
        other.leave()
        endless = Agent({"speed": "1000", "ambient": "20"}, mode="loop")
        lost = follow(program, folder, f"http://127.0.0.1:{endless.port}", "speed_rpm=S1speed", "ambient_degC=e2")
        first = lost.stderr.readline()
        assert "redirects" in first and "asks it again every 0.2 s" in first, first
        lost.send_signal(signal.SIGTERM)
        assert lost.wait(30) == 0
        endless.leave()
        print(f"{len(lines)} lines")


main()
