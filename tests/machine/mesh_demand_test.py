#!/usr/bin/python3
"""`check` predicts the memory that a mesh will take and refuses a mesh that does not fit. The test compares the prediction with the measured peak of `simulate`.

    mesh_demand_test.py PROGRAM FOLDER_OF_THE_PROJECT
"""
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "shared"))
from claims import expect, failures


def main():
    program, top = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    mill = top / "scenarios/cnc_mill_13.yaml"
    with tempfile.TemporaryDirectory(prefix="driftwright_mesh_demand-") as folder:
        environment = os.environ | {"XDG_CACHE_HOME": f"{folder}/cache"}
        done = subprocess.run([program, "check", mill, "--json"], capture_output=True, text=True, cwd=folder, env=environment)
        expect(done.returncode == 0, f"check: {done.stderr.strip()[-300:]}")
        told_MB = json.loads(done.stdout)["memory_MB"]
        run = subprocess.Popen([program, "simulate", mill, "-o", "out", "--quiet"], cwd=folder, env=environment)
        _, status, usage = os.wait4(run.pid, 0)
        measured_MB = 1.024e-3 * usage.ru_maxrss
        expect(status == 0 and 0.88 < told_MB / measured_MB < 1.12, f"cnc_mill_13: {told_MB:.0f} MB told, {measured_MB:.0f} MB measured")
        # With a lower memory limit of the process the scenario is refused before anything is solved; the message has both numbers and what to change.
        for limit_MB in range(600, 3000, 100):
            def limited():
                resource.setrlimit(resource.RLIMIT_AS, (limit_MB << 20, limit_MB << 20))
            done = subprocess.run([program, "check", mill], capture_output=True, text=True, cwd=folder, preexec_fn=limited, env=environment | {"OMP_NUM_THREADS": "1"})
            if "are left here" in done.stderr:
                break
        expect(done.returncode == 2 and "16350 nodes would take about 0.4 GB of memory" in done.stderr and "coarser mesh" in done.stderr,
               f"limited to {limit_MB} MB: {done.returncode} {done.stderr.strip()[-400:]}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
