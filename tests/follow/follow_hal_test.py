#!/usr/bin/python3
"""Checks the lines of `driftwright follow` on the pins of a real HAL, and which values remain when it is killed. follow_hal_test.py PROGRAM PROJECT"""
import fcntl
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from one_head import HEAD


def main():
    program, project = sys.argv[1], pathlib.Path(sys.argv[2])
    if not shutil.which("halrun") or not shutil.which("halcmd"):
        print("no halrun here; Debian's linuxcnc-uspace has it")
        sys.exit(77)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="driftwright_hal-"))
    folder.chmod(0o777)
    os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
    os.environ["RTAPI_FIFO_PATH"] = str(folder / "rtapi")
    if os.geteuid() == 0:  # as root, LinuxCNC runs under a user of its own
        os.environ["RTAPI_UID"] = "65534"
    (folder / "head.yaml").write_text(HEAD)
    os.mkfifo(folder / "lines")
    feeder = project / "compensation/control/follow_hal.py"
    (folder / "feed.sh").write_text(f"#!/bin/sh\nexec {feeder} --axes nose_z <{folder}/lines\n")
    (folder / "feed.sh").chmod(0o755)
    # one HAL per computer, see tests/shared/one_hal.hpp
    turn = open("/tmp/driftwright_one_hal", "a")
    fcntl.flock(turn, fcntl.LOCK_EX)
    # halrun ends its HAL with its shell, so its standard input is kept open
    hal = subprocess.Popen(["halrun", "-s"], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.STDOUT, cwd=folder, text=True)
    follow = None
    try:
        hal.stdin.write(f"loadusr -Wn follow {folder}/feed.sh\n")
        hal.stdin.flush()
        with open(folder / "lines", "w") as lines:
            follow = subprocess.Popen([program, "follow", "head.yaml"], stdin=subprocess.PIPE, stdout=lines, stderr=subprocess.DEVNULL, cwd=folder, text=True)
        wait_for("the component", lambda: "follow" in halcmd("list", "comp").split())
        say(follow, "time_s,speed_rpm,ambient_degC\n")
        for row in range(40):
            before = halcmd("getp", "follow.heartbeat")
            say(follow, f"{60 * row},2000,20\n")
            if row < 6:  # it toggles with each line
                wait_for("a beat", lambda: halcmd("getp", "follow.heartbeat") not in (before, ""))
        # 300 W on 20 W/K, 60 kJ/K: 15 K (1 - exp(-t / 50 min)), 4 um/K
        wanted_um = 60.0 * (1.0 - 2.718281828459045 ** (-39.0 / 50.0))
        wait_for("the correction", lambda: abs(float(halcmd("getp", "follow.nose-z.correction-um")) - wanted_um) < 1e-3)
        assert halcmd("getp", "follow.is-on") == "TRUE"
        assert float(halcmd("getp", "follow.nose-z.trust")) == 1.0
        follow.send_signal(signal.SIGKILL)
        follow.wait()
        wait_for("the end", lambda: halcmd("getp", "follow.is-on") == "FALSE")
        beat = halcmd("getp", "follow.heartbeat")
        time.sleep(1.0)
        assert halcmd("getp", "follow.heartbeat") == beat  # the watchdog of followed_axis sees that
        assert abs(float(halcmd("getp", "follow.nose-z.correction-um")) - wanted_um) < 1e-3
        print(f"{wanted_um:.3f} um on the pin, and there it stays")
    finally:
        if follow and follow.poll() is None:
            follow.kill()
        hal.stdin.close()
        hal.wait(timeout=60)
        shutil.rmtree(folder, ignore_errors=True)


def halcmd(*words):
    return subprocess.run(["halcmd", *words], capture_output=True, text=True).stdout.strip()


def say(process, text):
    process.stdin.write(text)
    process.stdin.flush()


def wait_for(what, is_so, for_s=30.0):
    end = time.monotonic() + for_s
    while time.monotonic() < end:
        try:
            if is_so():
                return
        except ValueError:
            pass
        time.sleep(0.1)
    sys.exit(f"{what} did not come")


main()
