#!/usr/bin/python3
"""Puts the lines of `driftwright follow` on pins of LinuxCNC's HAL, for followed_axis.comp.

    loadusr -Wn follow ./follow.sh      # which holds: thermometers | driftwright follow model.json | follow_hal.py --axes drift_y

Pins: follow.AXIS.correction-um (float) and follow.AXIS.trust (float) for each axis ('_' in its name becomes '-'), follow.heartbeat (bit), which toggles
with each line that answers a row, follow.is-on (bit). When the lines end, the pins keep their values and the heartbeat stops: the watchdog of
followed_axis then returns the offset to 0 at its slew limit. The component leaves on SIGTERM, as unloadusr sends it.
"""
import argparse
import json
import math
import os
import select
import sys
import time

import hal


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--axes", required=True, help="names of the corrections, with commas: drift_y,drift_z")
    arguments.add_argument("--name", default="follow", help="of the component")
    arguments = arguments.parse_args()
    axes = {name: name.replace("_", "-").lower() for name in arguments.axes.split(",")}
    component = hal.component(arguments.name)
    for pin in axes.values():
        component.newpin(f"{pin}.correction-um", hal.HAL_FLOAT, hal.HAL_OUT)
        component.newpin(f"{pin}.trust", hal.HAL_FLOAT, hal.HAL_OUT)
    component.newpin("heartbeat", hal.HAL_BIT, hal.HAL_OUT)
    component.newpin("is-on", hal.HAL_BIT, hal.HAL_OUT)
    component.ready()
    rest, file = b"", sys.stdin.fileno()
    try:
        while True:
            select.select([file], [], [])
            got = os.read(file, 65536)
            if not got:
                break
            *lines, rest = (rest + got).split(b"\n")
            for line in lines:
                take(component, axes, line)
        component["is-on"] = False
        while True:  # unloadusr ends it; LinuxCNC would take away the pins with it
            time.sleep(1.0)
    except KeyboardInterrupt:
        pass


def take(component, axes, line):
    """Corrections of one line, if it has a number for each axis; else the pins stay and nothing beats."""
    try:
        told = json.loads(line)
        values = [(pin, float(told["axes"][name]["correction_um"]), float(told["axes"][name]["trust"])) for name, pin in axes.items()]
    except (ValueError, KeyError, TypeError):
        return
    if not all(math.isfinite(x) for _, *numbers in values for x in numbers):
        return
    for pin, correction_um, trust in values:
        component[f"{pin}.correction-um"] = correction_um
        component[f"{pin}.trust"] = trust
    component["is-on"] = told.get("state") == "on"
    component["heartbeat"] = not component["heartbeat"]


main()
