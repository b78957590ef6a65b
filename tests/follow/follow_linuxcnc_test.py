#!/usr/bin/python3
"""Moves the Z axis of a headless LinuxCNC by the corrections of `driftwright follow`. Checked are the offset, its soft limit, and the state after `follow` is killed.

    follow_linuxcnc_test.py PROGRAM PROJECT        run as root: the component is copied into LinuxCNC's folder of modules during the test
"""
import fcntl
import json
import os
import pathlib
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from one_head import HEAD

MODULES = pathlib.Path("/usr/lib/linuxcnc/modules")
RATE_UM_S, MOST_AGE_S, LOW_MM = 20.0, 5.0, -10.0
INI = (pathlib.Path(__file__).resolve().parents[1] / "shared/linuxcnc.ini").read_text() + "MAX_LINEAR_VELOCITY = 100\nMAX_LINEAR_ACCELERATION = 1000\n" + "".join(
    f"[{head}]\nMIN_LIMIT = {LOW_MM}\nMAX_LIMIT = 10\nMAX_VELOCITY = 100\nMAX_ACCELERATION = 1000\n{more}"
    for head, more in [("AXIS_X", ""), ("AXIS_Y", ""), ("AXIS_Z", "OFFSET_AV_RATIO = 0.2\n")]
    + [(f"JOINT_{j}", "TYPE = LINEAR\nFERROR = 100\nMIN_FERROR = 100\nHOME_SEQUENCE = 0\n") for j in range(3)])
HAL = f"""loadrt trivkins coordinates=XYZ
loadrt motmod servo_period_nsec=1000000 num_joints=3
loadrt followed_axis names=thermal
loadrt and2
loadusr -Wn follow ./feed.sh
addf motion-command-handler servo-thread
addf and2.0 servo-thread
addf thermal servo-thread
addf motion-controller servo-thread
net m0 joint.0.motor-pos-cmd => joint.0.motor-pos-fb
net m1 joint.1.motor-pos-cmd => joint.1.motor-pos-fb
net m2 joint.2.motor-pos-cmd => joint.2.motor-pos-fb
net estop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
net thermal-counts thermal.eoffset-counts => axis.z.eoffset-counts
net thermal-scale thermal.eoffset-scale => axis.z.eoffset-scale
net thermal-enable thermal.eoffset-enable => axis.z.eoffset-enable
net thermal-correction follow.nose-z.correction-um => thermal.correction-um
net thermal-heartbeat follow.heartbeat => thermal.heartbeat
net on motion.motion-enabled => and2.0.in0
net homed motion.is-all-homed => and2.0.in1
net ready and2.0.out => thermal.machine-is-on
setp thermal.most-rate-um-s {RATE_UM_S}
setp thermal.most-age-s {MOST_AGE_S}
"""
# Replaces LinuxCNC's user interface: homes the axes, then executes the commands line by line.
SCRIPT = """#!/usr/bin/python3
import linuxcnc, time
c, s, e = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
c.state(linuxcnc.STATE_ESTOP_RESET); c.wait_complete(10)
c.state(linuxcnc.STATE_ON); c.wait_complete(10)
c.teleop_enable(0); c.wait_complete(10)
c.home(-1)
for _ in range(1000):
    s.poll()
    if all(s.homed[:3]): break
    time.sleep(0.02)
c.mode(linuxcnc.MODE_MDI); c.wait_complete(10)
asked, told = open("asked"), open("told", "w")
print("homed", file=told, flush=True)
for line in asked:
    if line == "end\\n":
        print("ending", file=told, flush=True)
        break
    c.mdi(line.strip())
    c.wait_complete(30)
    time.sleep(0.1)
    said = e.poll()
    s.poll()
    print(said[1] if said else "done", int(all(s.homed[:3])), file=told, flush=True)
"""


def halcmd(*words):
    return subprocess.run(["halcmd", *words], capture_output=True, text=True).stdout.strip()


def place_mm():
    return float(halcmd("getp", "joint.2.motor-pos-cmd"))


def wait_for(what, is_so, seconds=60.0):
    end = time.monotonic() + seconds
    while not is_so():
        assert time.monotonic() < end, f"no {what}: Z at {place_mm()} mm, correction {halcmd('getp', 'follow.nose-z.correction-um')} um"
        time.sleep(0.05)


class Control:
    """The mill: executes one block after another."""

    def __init__(self, folder):
        ends = []  # opened for reading and writing, so that neither side waits for the other
        for name in ("asked", "told"):
            os.mkfifo(folder / name)
            (folder / name).chmod(0o777)
            ends.append(os.open(folder / name, os.O_RDWR))
        self.asked, self.told, self.rest = *ends, b""
        self.process = subprocess.Popen(["timeout", "300", "linuxcnc", "-r", "mill.ini"], cwd=folder, stdout=open(folder / "log.txt", "w"),
                                        stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)

    def answer(self, seconds=60.0):
        while b"\n" not in self.rest:
            readable = select.select([self.told], [], [], seconds)[0]
            assert readable and self.process.poll() is None, "LinuxCNC does not answer"
            self.rest += os.read(self.told, 4096)
        line, self.rest = self.rest.split(b"\n", 1)
        return line.decode().split()

    def do(self, block):
        os.write(self.asked, (block + "\n").encode())
        return self.answer()


def compiled(folder, project):
    for name in ("followed_axis.comp", "axis_offset.c", "axis_offset.h"):
        shutil.copy(project / "compensation/control" / name, folder)
    subprocess.run(["halcompile", "--compile", "followed_axis.comp"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return folder / "followed_axis.so"


def follow_drift(program, folder, control, lines):
    """Commands for the mill while `follow` runs and writes to `lines`, and the moves that it must make."""
    follow = subprocess.Popen([program, "follow", "head.yaml", "--slew", "100 um/s"], stdin=subprocess.PIPE, stdout=lines, cwd=folder, text=True)
    n_rows = 0

    def rows(n):
        nonlocal n_rows
        for n_rows in range(n_rows + 1, n_rows + n + 1):
            follow.stdin.write(json.dumps({"time_s": 60 * n_rows, "speed_rpm": 2000, "ambient_degC": 20}) + "\n")
            follow.stdin.flush()
            time.sleep(0.02)

    def correction_um():
        return float(halcmd("getp", "follow.nose-z.correction-um"))

    def is_led(at_mm):
        rows(1)
        return abs(place_mm() - (at_mm - 1e-3 * correction_um())) < 1.5e-4  # a count is 0.1 um; halcmd prints 7 digits

    assert control.do("G0 X1 Z2")[0] == "done"
    assert abs(place_mm() - 2.0) < 1e-9
    halcmd("setp", "thermal.enable", "1")
    rows(60)  # 60 min at 2000 rpm
    # Once the reader of `follow` runs and the slew limit allows it, Z is offset by the correction and keeps this offset in all moves.
    wait_for("correction", lambda: correction_um() > 35.0)
    wait_for("offset", lambda: is_led(2.0))
    assert 35.0 < correction_um() < 60.0, correction_um()
    assert control.do("G0 Z5")[0] == "done"
    wait_for("offset at the new place", lambda: is_led(5.0))
    # At its soft limit the axis takes only the travel that is left, here 15 um.
    halcmd("setp", "thermal.enable", "0")
    wait_for("way back", lambda: abs(place_mm() - 5.0) < 1e-4)
    assert control.do(f"G0 Z{LOW_MM + 0.015}")[0] == "done"
    halcmd("setp", "thermal.enable", "1")
    until = time.monotonic() + 2.0 + correction_um() / RATE_UM_S
    while time.monotonic() < until:
        rows(1)
    at_limit_mm = place_mm()
    assert LOW_MM - 1e-6 <= at_limit_mm < LOW_MM + 0.002, at_limit_mm
    # `follow` is killed with SIGKILL: after the watchdog's time the offset returns to 0 at the slew limit, and all axes stay homed.
    halcmd("setp", "thermal.enable", "0")
    wait_for("way back from the limit", lambda: abs(place_mm() - (LOW_MM + 0.015)) < 1e-4)
    assert control.do("G0 Z5")[0] == "done"
    halcmd("setp", "thermal.enable", "1")
    wait_for("offset again", lambda: is_led(5.0))
    led_mm = place_mm()
    follow.send_signal(signal.SIGKILL)
    follow.wait()
    killed = time.monotonic()
    lines.close()
    while time.monotonic() < killed + 0.5 * MOST_AGE_S:
        assert abs(place_mm() - led_mm) < 2e-4, "it moved before the watchdog's time"
        time.sleep(0.1)
    wait_for("way back after the kill", lambda: abs(place_mm() - 5.0) < 1e-4, 30.0)
    took_s = time.monotonic() - killed
    assert took_s > MOST_AGE_S + 1e3 * abs(led_mm - 5.0) / RATE_UM_S - 1.0, took_s
    said = control.do("G0 Z-3")
    assert said == ["done", "1"], said
    assert abs(place_mm() + 3.0) < 1e-4, place_mm()  # the control's planner ends within a count of 0, at 0.05 um
    print(f"offset {1e3 * (led_mm - 5.0):.1f} um; at the limit {at_limit_mm:.4f} mm of {LOW_MM}; back {took_s:.1f} s after the kill")


def main():
    program, project = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    if not shutil.which("linuxcnc") or not shutil.which("halcompile") or not os.access(MODULES, os.W_OK):
        print("no linuxcnc or halcompile here, or no right to its modules; Debian's linuxcnc-uspace and linuxcnc-uspace-dev have them")
        sys.exit(77)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="driftwright_linuxcnc-"))
    folder.chmod(0o777)
    os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
    (folder / "fifo").mkdir(mode=0o777)
    (folder / "fifo").chmod(0o777)
    os.environ.update(RTAPI_UID="65534", RTAPI_FIFO_PATH=str(folder / "fifo/f"))  # as root, LinuxCNC runs under a user of its own
    for name, text in {"head.yaml": HEAD, "mill.ini": INI, "sim.hal": HAL, "script.py": SCRIPT, "tool.tbl": "T1 P1\n", "sim.var": "5220 1\n",
                       "feed.sh": f"#!/bin/sh\nexec {project}/compensation/control/follow_hal.py --axes nose_z <{folder}/lines\n"}.items():
        (folder / name).write_text(text)
        (folder / name).chmod(0o777)
    os.mkfifo(folder / "lines")
    keeper = os.open(folder / "lines", os.O_RDWR)  # so that feed.sh and follow may come in any order
    turn = open("/tmp/driftwright_one_hal", "a")  # one HAL per computer, see tests/shared/one_hal.hpp
    fcntl.flock(turn, fcntl.LOCK_EX)
    module = MODULES / "followed_axis.so"
    was_there = module.exists()
    control = None
    try:
        if not was_there:
            shutil.copy(compiled(folder, project), module)
        control = Control(folder)
        assert control.answer() == ["homed"]
        lines = open(folder / "lines", "w")
        os.close(keeper)  # not earlier: a reader would take a FIFO without a writer for the end of the lines
        follow_drift(program, folder, control, lines)
        assert control.do("end") == ["ending"]
        control.process.wait(60)
    finally:
        if not was_there:
            module.unlink(missing_ok=True)
        if control and control.process.poll() is None:
            control.process.terminate()
            control.process.wait(30)
        log = (folder / "log.txt").read_text() if (folder / "log.txt").exists() else ""
        if sys.exc_info()[0]:
            print(log[-3000:])
        shutil.rmtree(folder, ignore_errors=True)


main()
