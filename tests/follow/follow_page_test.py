#!/usr/bin/python3
"""Runs the commands of docs/how-to/follow.md, "From a thermometer to a corrected axis", unchanged, with a real broker. follow_page_test.py PROGRAM PROJECT"""
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile


def end_daemons(folder):
    """Ends the broker, which has left the process group of its shell and is found by its environment."""
    for entry in pathlib.Path("/proc").glob("[0-9]*/environ"):
        try:
            if f"XDG_CACHE_HOME={folder}/cache".encode() in entry.read_bytes().split(b"\0"):
                os.kill(int(entry.parent.name), signal.SIGTERM)
        except OSError:  # a process of another user, or one that has ended
            continue


def main():
    program, project = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    os.environ["PATH"] += ":/usr/sbin"
    with socket.socket() as s:
        is_taken = s.connect_ex(("127.0.0.1", 1883)) == 0
    if is_taken or not shutil.which("mosquitto") or not shutil.which("mosquitto_pub"):
        print("no mosquitto here (Debian's mosquitto and mosquitto-clients have it), or a broker runs already")
        sys.exit(77)
    page = (project / "docs/how-to/follow.md").read_text()
    commands = page.split("## From a thermometer to a corrected axis")[1].split("```\n")[1]
    with tempfile.TemporaryDirectory(prefix="driftwright_page-") as folder:
        work = pathlib.Path(folder)
        (work / "scenarios").symlink_to(project / "scenarios")
        if "DRIFTWRIGHT_TEST_STORE" in os.environ:  # machines that other tests have reduced
            (work / "cache").symlink_to(pathlib.Path(os.environ["DRIFTWRIGHT_TEST_STORE"]).resolve())
        env = dict(os.environ, XDG_CACHE_HOME=str(work / "cache"), PATH=f"{program.parent}:{os.environ['PATH']}")
        shell = subprocess.Popen(["bash", "-ec", commands], cwd=work, env=env, stdout=subprocess.PIPE, text=True, start_new_session=True)
        try:
            heard = [json.loads(line) for line in iter(shell.stdout.readline, "") if line.strip()][:3] if shell.wait(240) == 0 else []
        finally:
            os.killpg(shell.pid, signal.SIGTERM)
            end_daemons(work)
    assert len(heard) == 3, heard
    for line in heard:
        assert "drift_y" in line["axes"] and abs(line["axes"]["drift_y"]["correction_um"]) < 5.0, line
    print("heard:", json.dumps(heard[-1])[:300])


main()
