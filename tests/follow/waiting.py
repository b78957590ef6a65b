"""Shared by tests of sources: waiting for another program, ports, a real mosquitto on loopback."""
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import time


def wait_for(what, is_so, seconds=60.0, told=lambda: ""):
    """@param told  further text of the message if the event never comes"""
    end = time.monotonic() + seconds
    while not is_so():
        assert time.monotonic() < end, f"no {what}: {told()}"
        time.sleep(0.05)


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def program_of(name):
    return shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin:/usr/bin")


def need_mosquitto():
    if not program_of("mosquitto") or not program_of("mosquitto_pub"):
        print("no mosquitto here; Debian's mosquitto and mosquitto-clients have it")
        sys.exit(77)


def broker(folder, port):
    """@return the process of a mosquitto that already listens"""
    conf = pathlib.Path(folder) / "broker.conf"
    conf.write_text(f"listener {port} 127.0.0.1\nallow_anonymous true\n")
    started = subprocess.Popen([program_of("mosquitto"), "-c", conf], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def listens():
        with socket.socket() as s:
            return s.connect_ex(("127.0.0.1", port)) == 0

    wait_for("broker", listens)
    return started
