#!/usr/bin/env python3
"""Tests unusual file names: as long as the file system allows, not UTF-8, with line breaks and terminal commands, and the names of our own result files.
Every verb must end with 0, or with 2 and a message; all that it writes and prints must be UTF-8 without control characters.

    names_test.py PROGRAM
"""
import os, shutil, subprocess, sys, tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
LONGEST = 255      # longest file name in bytes
LONGEST_OURS = 235
SMALL = """
cyclograms:
  shift: [[120 min, 6000 rpm], [30 min, 0 rpm], [90 min, 3000 rpm]]
  climb: [[40 min, 1500 rpm], [40 min, 3000 rpm], [40 min, 6000 rpm], [60 min, 0 rpm]]
  other: [[30 min, 5000 rpm], [20 min, 0 rpm], [60 min, 2000 rpm]]
study: {target: nose_z, train: [shift, climb], judge: other, sensors_to_choose: 1, tolerance: 5 um}
schedule: {tolerance: 10 um, rapid: 15 m/min, tool_change: 8 s, axes: {z: {displacement: nose_z, sign: -1}}}
solver: {output_interval: 3 min}
"""
failures = []


class Trial:
    def __init__(self, program, work):
        self.program, self.work = program, work
        self.env = dict(os.environ, XDG_CACHE_HOME=os.environ.get("DRIFTWRIGHT_TEST_STORE", str(work / "cache")))
        self.out = work / "out"

    def judge(self, label, what, data):
        try:
            data.decode()
        except UnicodeDecodeError:
            failures.append(f"{label}: {what} is no UTF-8")
        if any(c < 32 and c not in b"\n\t\r" or c == 127 for c in data) or any(line.startswith(b"G0 X999") for line in data.splitlines()):
            failures.append(f"{label}: {what} holds control characters of a name")

    def run(self, label, *words, wanted=(0,), says=""):
        """@return the names of the files that were written"""
        shutil.rmtree(self.out, ignore_errors=True)
        writes = [] if words[0] == "check" else ["-o", self.out]
        done = subprocess.run([self.program, *words, *writes], cwd=self.work, env=self.env, capture_output=True, stdin=subprocess.DEVNULL, timeout=300)
        said = done.stderr.decode(errors="replace").strip()
        print(done.returncode, label, said[-160:].replace("\n", " "), flush=True)
        if done.returncode not in wanted or says not in said:
            failures.append(f"{label}: {done.returncode}, not {wanted}: {said[-300:]}")
        self.judge(label, "what is printed", done.stdout)
        if done.returncode == 2 and "no UTF-8" not in label:  # messages show such a name unchanged
            self.judge(label, "the message", done.stderr)
        files = [p for p in sorted(self.out.rglob("*")) if p.is_file()]
        for p in files:
            self.judge(label, "a file's name", os.fsencode(p.name))
            if p.suffix not in (".vtu", ".npy"):
                self.judge(label, f"{p.name[:40]}...", p.read_bytes())
            if len(os.fsencode(p.name)) > LONGEST_OURS:
                failures.append(f"{label}: the name of {p.name[:40]}... has {len(os.fsencode(p.name))} bytes")
        return [p.name for p in files]


def try_name(trial, label, name, wanted=(0,), says=""):
    """Runs the verbs on a record, a scenario and a program of that name (given without its ending)."""
    work, folder = trial.work, os.fsencode(trial.work)

    def copy(of, ending):
        path = folder + b"/" + name[:LONGEST - len(ending)] + ending
        shutil.copy(of, path)
        return path
    scenario, records = work / "small.yaml", work / "simulated/records"
    record, named_scenario = copy(records / "shift.csv", b""), copy(scenario, b".yaml")
    # calibrated.yaml names a record by its path; YAML cannot contain a path that is not UTF-8 (docs/theory/verification_faults.md)
    fitted = records / "climb.csv" if label == "no UTF-8" else record
    climb = records / "climb.csv"
    for words in (["check", named_scenario], ["predict", scenario, "--cyclogram", record], ["compare", record, climb],
                  ["simulate", named_scenario, "--cyclogram", record, "--cyclogram", "climb"], ["diagnose", named_scenario, "--measured", record],
                  ["calibrate", named_scenario, "--measured", fitted],
                  ["select", work / "study.yaml", "--train", record, "--train", climb],
                  ["validate", work / "study.yaml", "--train", record, "--train", climb, "--test", records / "other.csv"],
                  ["schedule", scenario, "--program", copy(TOP / "scenarios/parts/pocket.ngc", b".ngc")],
                  ["schedule", scenario, "--program", copy(TOP / "scenarios/parts/pocket.ngc", b".ngc"), "--parts", "3"]):
        trial.run(f"{words[0]}, {label}", *words, wanted=wanted, says=says)
    trial.run(f"import, {label}", "import", copy(TOP / "scenarios/records/logger_file.csv", b""), wanted=wanted, says=says)


def main():
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="driftwright-names-") as folder:
        work = Path(folder)
        trial = Trial(program, work)
        text = (TOP / "scenarios/first_machine.yaml").read_text()
        (work / "small.yaml").write_text(text[:text.index("\ncyclograms:")] + SMALL)
        (work / "study.yaml").write_text("name: study\nstudy: {target: nose_z, sensors_to_choose: 1, tolerance: 5 um}\n")
        subprocess.run([program, "simulate", work / "small.yaml", "-o", work / "simulated"], env=trial.env, check=True, capture_output=True)
        try_name(trial, "255 bytes", b"x" * LONGEST)
        try_name(trial, "letters of two bytes", "ä".encode() * (LONGEST // 2 - 3))
        try_name(trial, "no UTF-8", b"Geh\xe4use")
        try_name(trial, "marks of other languages", b"*)( %s {} ;<b>&\"'$(x)` #include")
        for label, name in (("a line break", b"a\nG0 X999\nb"), ("a command to a terminal", b"a\x1b[31m"), ("one of two bytes", b"a\xc2\x9b31m")):
            try_name(trial, label, name, wanted=(2,), says="control character")
        for name in ("driftwright-manifest.json", "figures", "tables", "report.html"):
            shutil.copy(TOP / "scenarios/parts/pocket.ngc", work / name)
            trial.run(f"schedule, {name}", "schedule", work / "small.yaml", "--program", work / name, wanted=(2,), says="rename the program")
        # Twice into one folder: the files of the first run are recognised as ours.
        os.rename(work / "driftwright-manifest.json", os.fsencode(work) + b"/Geh\xe4use.ngc")
        for i in range(2):
            done = subprocess.run([program, "schedule", work / "small.yaml", "--program", os.fsencode(work) + b"/Geh\xe4use.ngc", "-o", work / "again"],
                                  env=trial.env, capture_output=True)
            if done.returncode != 0:
                failures.append(f"schedule, for the {i + 1}. time: {done.stderr.decode(errors='replace')}")
        broken = work / "broken.yaml"
        broken.write_text(text[:text.index("\ncyclograms:")] + SMALL.replace("nose_z, train", '"nose\\nG0 X999\\nz", train'))
        trial.run("a line break in a scenario", "run", broken, wanted=(2,), says="control character")
    for failure in failures:
        print("FAILED", failure)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
