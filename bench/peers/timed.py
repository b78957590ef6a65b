"""Runs a program as a whole process and reports its time and memory."""
import json
import os
import resource
import subprocess
import time


def run(command, log, cap_s, environment=None, folder=None):
    """Wall and processor seconds (user and system), peak MB (of it or its largest child) and exit code; killed after cap_s (exit code -9)."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.time()
    with open(log, "w") as file:
        # GNU time gives the peak memory of this process alone, getrusage that of the largest child so far.
        # With --foreground, timeout(1) waits for the process that it kills, so the CPU time of that process counts.
        process = subprocess.run(["/usr/bin/time", "-f", "%M", "-o", log + ".peak", "timeout", "--foreground", "-s", "KILL", str(cap_s)] + command,
                                 stdout=file, stderr=file, env={**os.environ, **(environment or {})}, cwd=folder)
    wall_s = time.time() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        with open(log + ".peak") as file:
            peak_MB = float(file.read().split()[-1]) / 1024.0
        os.remove(log + ".peak")
    except (OSError, ValueError, IndexError):
        peak_MB = float("nan")
    return {"exit_code": -9 if process.returncode == 137 else process.returncode, "wall_s": wall_s, "peak_MB": peak_MB,
            "processor_s": after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime}


def report(folder, name, outcome, n_rows, note=""):
    """Leaves FOLDER/<name>.run.json for table.py."""
    outcome = {**outcome, "name": name, "rows": n_rows, "note": note}
    with open("%s/%s.run.json" % (folder, name), "w") as file:
        json.dump(outcome, file, indent=1)
    print("%-34s exit %d  wall %8.2f s  processor %8.2f s  peak %6.0f MB  rows %d %s"
          % (name, outcome["exit_code"], outcome["wall_s"], outcome["processor_s"], outcome["peak_MB"], n_rows, note), flush=True)
