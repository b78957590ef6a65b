#!/usr/bin/env python3
"""Runs every verb under faults of the environment and prints the table of docs/theory/verification_faults.md.

    bench/faults.py [PROGRAM] [--meshed [--cell MM]] [--kills N] [--verbs simulate,diagnose,...]
    bench/faults.py build/asan/app/driftwright --sanitized      each verb once, without faults, by a program built with sanitizers, and what they report

The machine is lumped; with --meshed `init` makes it from a drawing, a box of 100 mm, with the mesh size of `init` or with --cell.

Faults: address space of 300 to 1500 MB, files of 20 kB at most (RLIMIT_FSIZE), a disk that is full after 400 kB, standard output that is full, TMPDIR
that is missing or takes no file, an empty PATH, a current folder that is gone, an -o of 300 characters, Ctrl-C and SIGKILL after
random parts of the usual time, and a second run after each.

A verb passes if three things hold. It ends in time with 0, 2 or 3 (130 after Ctrl-C) and a message. Its results are then complete or absent. Runs that end
with 0, and the run after a kill, give the same bytes as the undisturbed run. Otherwise this script ends with exit code 1. Full disks require root (a small
tmpfs is mounted); without root they are left out.
"""
import argparse, os, random, re, resource, shutil, signal, subprocess, sys, tempfile, time
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
LONGEST_S = 300


STUDIED = """
cyclograms:
  shift: [[120 min, 6000 rpm], [30 min, 0 rpm], [90 min, 3000 rpm]]
  climb: [[40 min, 1500 rpm], [40 min, 3000 rpm], [40 min, 6000 rpm], [60 min, 0 rpm]]
  other: [[30 min, 5000 rpm], [20 min, 0 rpm], [60 min, 2000 rpm]]
study: {target: nose_z, train: [shift, climb], judge: other, sensors_to_choose: 1, tolerance: 5 um}
schedule: {tolerance: 10 um, rapid: 15 m/min, tool_change: 8 s, axes: {z: {displacement: nose_z, sign: -1}}}
"""


def small_scenario(work):
    """The smallest shipped machine, with the blocks that `run`, `validate` and `schedule` require."""
    text = (TOP / "scenarios/first_machine.yaml").read_text()
    assert "\ncyclograms:" in text
    path = work / "small.yaml"
    path.write_text(text[:text.index("\ncyclograms:")] + STUDIED)
    return path


def meshed_scenario(program, work, cell_mm):
    """The same for a box from a drawing; 20 W warm its spindle. @param cell_mm  None: the mesh size of `init`"""
    subprocess.run([program, "init", "box", "--from", TOP / "tests/fuzz/corpus/meshes/box.step"], check=True, cwd=work, capture_output=True)
    path = work / "box/box.yaml"
    text = path.read_text().replace("drift_z", "nose_z")
    assert "power: 0.5 W, at_speed: 3000 rpm" in text
    if cell_mm:
        text, n = re.subn(r"(default: )[\d.]+ mm", rf"\g<1>{cell_mm:g} mm", text)
        assert n == 1, text
    text = text.replace("power: 0.5 W, at_speed: 3000 rpm", "power: 20 W, at_speed: 6000 rpm")
    path.write_text(text[:text.index("\ncyclograms:")] + "\nsolver: {model: reduced}" + STUDIED)
    return path


def meshed_sweep(scenario, work):
    path = work / "box_sweep.yaml"
    path.write_text(f"name: box_sweep\nscenario: {scenario}\ncyclograms: [other]\ndesign: grid\nvary:\n  - {{name: power, key: 'effects[heat_source].power', "
                    "values: [10 W, 20 W, 40 W]}\ncollect: [nose_z]\n")
    return path


def verbs(small, first, drawn, sweep, record, others):
    """Arguments of the program for each verb. OUT is the folder or file of results; a verb without it writes its results to standard output."""
    shift, climb, other = record, *others
    return {
        "list": ["list", "effects"],
        "schema": ["schema", "scenario"],
        "help": ["help", "diagnose"],
        "check": ["check", small],
        "init": ["init", "OUT"],
        "import": ["import", TOP / "scenarios/records/logger_file.csv", "-o", "OUT"],
        "compare": ["compare", shift, climb, "-o", "OUT"],
        "mesh": ["mesh", drawn, "-o", "OUT"],
        "simulate": ["simulate", small, "-o", "OUT"],
        "predict": ["predict", small, "--cyclogram", "other", "-o", "OUT"],
        "warmup": ["warmup", small, "--then", "other", "--time-limit", "30 min", "--tolerance", "20 um", "-o", "OUT"],
        "place": ["place", small, "-o", "OUT"],
        "plan-test": ["plan-test", small, "--programmes", "50", "-o", "OUT"],
        "select": ["select", "STUDY", "--train", shift, "--train", climb, "-o", "OUT"],
        "validate": ["validate", "STUDY", "--train", shift, "--train", climb, "--test", other, "-o", "OUT"],
        "compensate": ["compensate", "STUDY", "--model", "MODEL", "--through", "none", "--measured", other, "-o", "OUT"],
        "probe-plan": ["probe-plan", small, "--job", "other", "--model", "MODEL", "-o", "OUT"],
        "calibrate": ["calibrate", first, "--measured", shift, "-o", "OUT"],
        "diagnose": ["diagnose", first, "--measured", shift, "-o", "OUT"],
        "sweep": ["sweep", sweep, "-o", "OUT"],
        "schedule": ["schedule", small, "--program", TOP / "scenarios/parts/pocket.ngc", "-o", "OUT"],
        "run": ["run", small, "-o", "OUT"],
        "view": ["view", small, "-o", "OUT.html"],
        "export": ["export", first, "--fmu", "-o", "OUT.fmu"],
        "follow": ["follow", first, "--replay", shift],
        "inject": ["inject", "--correction", "CORRECTION", "--row-time", "1 ms", "--period", "4 um"],
    }


class Trial:
    """How a run ended (`code`, "killed" or "hangs"), and what it wrote to standard error and, if kept, to standard output."""

    def __init__(self, code, err, time_s, said=None):
        self.code, self.err, self.time_s, self.said = code, err, time_s, said


def run(command, out, cwd, env=None, limit_mb=None, file_limit=None, stdout=None, stdin=None, kill_after=None, with_signal=signal.SIGKILL, longest_s=LONGEST_S):
    def before():
        if limit_mb:
            resource.setrlimit(resource.RLIMIT_AS, (limit_mb << 20, limit_mb << 20))
        if file_limit is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (file_limit, file_limit))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    words = [str(w).replace("OUT", str(out)) if str(w).startswith("OUT") else str(w) for w in command]
    began = time.time()
    with tempfile.TemporaryFile() as said, open(stdin if stdin else os.devnull, "rb") as rows, tempfile.TemporaryFile() as err:
        process = subprocess.Popen(words, cwd=cwd, env=env, stdout=stdout or said, stderr=err, preexec_fn=before, stdin=rows)
        code = None
        try:
            code = process.wait(timeout=kill_after or longest_s)
        except subprocess.TimeoutExpired:
            process.send_signal(with_signal if kill_after else signal.SIGKILL)
            try:
                code = process.wait(timeout=LONGEST_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                code = "hangs"
            if not kill_after:
                code = "hangs"
            elif with_signal == signal.SIGKILL:
                code = "killed"
        said.seek(0)
        err.seek(0)
        return Trial(code, err.read().decode(errors="replace"), time.time() - began, said.read())


def results(out):
    """Bytes of a folder or file of results by name, with OUT in place of its path; None if it does not exist."""
    def bytes_of(path):
        return path.read_bytes().replace(str(out).encode(), b"OUT")
    if out.is_file():
        return {out.name: bytes_of(out)}
    return {str(p.relative_to(out)): bytes_of(p) for p in sorted(out.rglob("*")) if p.is_file()} if out.exists() else None


def judged(trial, also=()):
    """'2' if that is the right exit code; '**1: ...**' if it is not."""
    if trial.code == -signal.SIGINT and 130 in also:  # exit code as a shell gives it, if the verb had written nothing yet
        return "130"
    if trial.code in also or trial.code in (0, 2, 3) and (trial.code == 0 or trial.err.strip()):
        return str(trial.code)
    is_signal = isinstance(trial.code, int) and trial.code < 0
    last = trial.err.strip().splitlines()[-1][:80] if trial.err.strip() else "no words"
    return f"**{signal.Signals(-trial.code).name if is_signal else trial.code}: {last}**"


def remove(path):
    shutil.rmtree(path, ignore_errors=True) if path.is_dir() else path.unlink(missing_ok=True)


FAULTS = ["300 MB", "400 MB", "1500 MB", "files of 20 kB", "disk 400 kB", "stdout full", "no TMPDIR", "TMPDIR read-only", "PATH empty", "folder gone", "-o of 300",
          "Ctrl-C", "kills, then again"]


def row_of(verb, command, stdin, work, env, tiny, n_kills):
    """The cells of a verb's row."""
    writes = any(str(w).startswith("OUT") for w in command)
    suffix = next((str(w)[3:] for w in command if str(w).startswith("OUT")), "")
    folder = work / "out"
    folder.mkdir(exist_ok=True)
    stem = folder / verb
    out = Path(str(stem) + suffix)
    usual = run(command, stem, work, env, stdin=stdin)
    remove(out)
    usual = run(command, stem, work, env, stdin=stdin)  # reduced models are kept by now
    right, said = results(out), usual.said
    if usual.code != 0:
        return [judged(usual) + " **undisturbed**"] * len(FAULTS)

    def verdict(trial, where=out, also=(), is_said=True):
        cell = judged(trial, also)
        left = results(where) if writes else None
        is_said_incomplete = trial.code == 130 and b'"complete": false' in (left or {}).get("diagnosis.json", b"")  # the results of a diagnosis so far
        if writes and left is not None and left != right and not is_said_incomplete:
            cell += " **other bytes**" if trial.code == 0 else " **half of it**"
        if writes and trial.code == 0 and left is None:
            cell += " **nothing written**"
        if not writes and is_said and trial.code == 0 and trial.said != said:
            cell += " **other bytes**"
        return cell

    def tried(**fault):
        remove(out)
        env_here = dict(env, **fault.pop("variables", {}))
        is_said = "stdout" not in fault
        return verdict(run(command, stem, fault.pop("cwd", work), env_here, stdin=stdin, **fault), is_said=is_said)

    cells = [tried(limit_mb=mb) for mb in (300, 400, 1500)]
    cells.append(tried(file_limit=20000) if writes else "-")
    if tiny and writes:
        for p in tiny.iterdir():
            remove(p)
        cells.append(verdict(run(command, tiny / verb, work, dict(env, TMPDIR=str(tiny)), stdin=stdin), Path(str(tiny / verb) + suffix)))
        left = [p.name for p in tiny.iterdir() if p.name not in (verb + suffix, verb + ".parts")]
        cells[-1] += f" **left: {left[0]}**" if left else ""
    else:
        cells.append("-")
    with open("/dev/full", "wb") as full:
        cells.append(tried(stdout=full))
    cells.append(tried(variables={"TMPDIR": "/no/such/folder"}))
    cells.append(tried(variables={"TMPDIR": "/proc"}))
    cells.append(tried(variables={"PATH": "/nowhere"}))
    gone = work / "gone"
    gone.mkdir(exist_ok=True)
    remove(out)
    cells.append(verdict(run(["/bin/sh", "-c", 'rmdir "$PWD"; exec "$@"', "sh", *command], stem, gone, env, stdin=stdin)))
    cells.append(verdict(run(command, work / ("x" * 300), work, env, stdin=stdin), work / "nowhere") if writes else "-")

    def cut_short(how, also):
        """Ends the verb after random parts of its usual time. The results must be complete or absent, no other file may remain, and another run must give the same bytes."""
        worst = ""
        for _ in range(n_kills):
            remove(out)
            end = run(command, stem, work, env, stdin=stdin, kill_after=max(0.02, random.uniform(0.05, 1.0) * usual.time_s), with_signal=how)
            cell = verdict(end, also=also, is_said=False)
            worst = cell if "**" in cell else worst
            if verb == "init":  # it never replaces a folder
                remove(out)
            again = run(command, stem, work, env, stdin=stdin)
            if verdict(again) != "0":
                worst = f"**then {again.code}: {verdict(again)}**"
        beside = [p.name for p in folder.iterdir() if p != out and p.name.startswith(verb + ".")]
        return (worst or ("same bytes" if how == signal.SIGKILL else "130")) + (f" **left: {beside[0]}**" if beside and how != signal.SIGKILL else "")

    cells.append(cut_short(signal.SIGINT, (130,)))
    cells.append(cut_short(signal.SIGKILL, ("killed",)))
    return cells


def sanitized_row(verb, command, stdin, work, env):
    """Exit code, seconds and number of sanitizer reports, for the program and all processes that it starts, with the file that contains the reports."""
    logs = work / "reports" / verb
    logs.mkdir(parents=True)
    usual = {name: f"{env.get(name, '')}:log_path={logs}/{name[:4].lower()}" for name in ("ASAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS")}
    usual["UBSAN_OPTIONS"] += ":print_stacktrace=1"
    end = run(command, work / "out" / verb, work, dict(env, **usual), stdin=stdin, longest_s=5 * LONGEST_S)
    reports = [p.read_text(errors="replace") for p in sorted(logs.iterdir())]
    kept = Path(tempfile.gettempdir()) / "driftwright-reports"
    if reports:
        kept.mkdir(exist_ok=True)
        (kept / f"{verb}.txt").write_text("\n".join(reports))
    n = sum(r.count("ERROR: ") + r.count("runtime error:") + r.count("WARNING: ThreadSanitizer") for r in reports)
    return [judged(end), f"{end.time_s:.0f}", f"{n}: {kept / verb}.txt" if reports else "0"]


def main():
    args = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    args.add_argument("program", nargs="?", default=str(TOP / "build/release/app/driftwright"))
    args.add_argument("--meshed", action="store_true")
    args.add_argument("--cell", type=float, metavar="MM")
    args.add_argument("--sanitized", action="store_true")
    args.add_argument("--kills", type=int, default=5)
    args.add_argument("--verbs", default="")
    args.add_argument("--seed", type=int, default=1)
    args = args.parse_args()
    program = os.path.abspath(args.program)
    random.seed(args.seed)
    is_kept = True
    work = Path(tempfile.mkdtemp(prefix="driftwright-faults-"))
    env = dict(os.environ, XDG_CACHE_HOME=str(work / "cache"))
    tiny = work / "tiny"
    tiny.mkdir()
    has_tiny = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=400k", "none", tiny], capture_output=True).returncode == 0
    try:
        small = meshed_scenario(program, work, args.cell) if args.meshed else small_scenario(work)
        subprocess.run([program, "simulate", small, "-o", work / "simulated"], check=True, env=env, capture_output=True)
        records = [work / "simulated/records" / f"{name}.csv" for name in ("shift", "climb", "other")]
        study = work / "study.yaml"
        study.write_text("name: study\nstudy: {target: nose_z, sensors_to_choose: 1, tolerance: 5 um}\n")
        correction = work / "correction.csv"
        correction.write_text("time_s,drift_um\n0,0\n1,4\n")
        rows_in = work / "rows.txt"
        rows_in.write_text("0 0\n1 0\n1 1\n0 1\n" * 20000)
        first = small if args.meshed else TOP / "scenarios/first_machine.yaml"
        drawn = small if args.meshed else TOP / "scenarios/c_frame.yaml"
        sweep = meshed_sweep(small, work) if args.meshed else TOP / "scenarios/lumped_sweep.yaml"
        commands = verbs(small, first, drawn, sweep, records[0], records[1:])
        names = {"STUDY": study, "CORRECTION": correction}
        of_models = [program] + [names.get(str(w), w) for w in commands["validate"]]
        run(of_models, work / "models", work, env)
        names["MODEL"] = next(iter(sorted((work / "models/models").glob("*.json"))), "none.json")
        if args.sanitized:
            print("| verb | exit code | seconds | reports |\n|---|---|---|---|")
        else:
            print("| verb | " + " | ".join(FAULTS).replace("kills", f"{args.kills} kills") + " |")
            print("|---" * (len(FAULTS) + 1) + "|")
        for verb in args.verbs.split(",") if args.verbs else commands:
            command = [program] + [names.get(str(w), w) for w in commands[verb]]
            if args.sanitized:
                cells = sanitized_row(verb, command, rows_in if verb == "inject" else None, work, env)
                is_kept = is_kept and cells[0] == "0" and cells[2] == "0"
                print(f"| {verb} | " + " | ".join(cells) + " |", flush=True)
                continue
            cells = row_of(verb, command, rows_in if verb == "inject" else None, work, env, tiny if has_tiny else None, args.kills)
            is_kept = is_kept and not any("**" in cell for cell in cells)
            print(f"| {verb} | " + " | ".join(cells) + " |", flush=True)
    finally:
        if has_tiny:
            subprocess.run(["umount", tiny])
        shutil.rmtree(work, ignore_errors=True)
    sys.exit(0 if is_kept else 1)


if __name__ == "__main__":
    main()
