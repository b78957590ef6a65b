#!/usr/bin/env python3
"""Every verb under faults of the environment; prints the table of docs/verification.md.

    bench/faults.py [PROGRAM] [--kills N] [--verbs simulate,diagnose,...]

Faults: address space of 300 to 1500 MB, a disk that is full after 0 to 400 kB, standard output that is full, TMPDIR that is missing or read-only, no
gnuplot, a current folder that is gone, an -o of 300 characters, SIGKILL after a random part of the usual time, and a second run after it.

A verb passes where it ends with 0, 2 or 3 and words, in time, where the folder of results then is whole or not there, and where the run after a
kill gives the same bytes as the undisturbed one. Full disks want root (a small tmpfs is mounted); without, they are left out.
"""
import argparse, os, random, re, resource, shutil, signal, subprocess, sys, tempfile, time
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
LONGEST_S = 300


def verbs(data):
    lumped, fp3 = TOP / "scenarios/lumped_spindle.yaml", TOP / "scenarios/fp3_spindle.yaml"
    records = [arg for f in data.values() for arg in ("--measured", f)]
    return {
        "list": ["list", "effects"],
        "check": ["check", lumped],
        "mesh": ["mesh", TOP / "scenarios/c_frame.yaml", "-o", "OUT"],
        "simulate": ["simulate", lumped, "-o", "OUT"],
        "predict": ["predict", lumped, "--cyclogram", "warm_up", "-o", "OUT"],
        "select": ["select", "STUDY", "--train", data["a"], "--train", data["b"], "-o", "OUT"],
        "validate": ["validate", "STUDY", "--train", data["a"], "--train", data["b"], "--test", data["c"], "-o", "OUT"],
        "compensate": ["compensate", "STUDY", "--model", "MODEL", "--through", "none", "--measured", data["c"], "-o", "OUT"],
        "calibrate": ["calibrate", lumped, *records, "-o", "OUT"],
        "diagnose": ["diagnose", lumped, "--measured", data["a"], "-o", "OUT"],
        "sweep": ["sweep", TOP / "scenarios/lumped_sweep.yaml", "-o", "OUT"],
        "schedule": ["schedule", fp3, "--program", TOP / "scenarios/parts/fp3_part.ngc", "-o", "OUT"],
        "run": ["run", fp3, "-o", "OUT"],
        "inject": ["inject", "--correction", "CORRECTION", "--row-time", "1 ms", "--period", "4 um"],
    }


def run(command, out, cwd, env=None, limit_mb=None, stdout=subprocess.PIPE, stdin=None, kill_after=None):
    def before():
        if limit_mb:
            resource.setrlimit(resource.RLIMIT_AS, (limit_mb << 20, limit_mb << 20))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    words = [str(out) if str(w) == "OUT" else str(w) for w in command]
    began = time.time()
    process = subprocess.Popen(words, cwd=cwd, env=env, stdout=stdout, stderr=subprocess.PIPE, preexec_fn=before,
                               stdin=open(stdin) if stdin else subprocess.DEVNULL)
    try:
        _, err = process.communicate(timeout=kill_after if kill_after else LONGEST_S)
    except subprocess.TimeoutExpired:
        process.kill()
        _, err = process.communicate()
        return ("killed" if kill_after else "hangs"), err.decode(errors="replace"), time.time() - began
    return process.returncode, err.decode(errors="replace"), time.time() - began


def files(folder):
    if not folder.exists():
        return None
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def same(a, b):
    """Bytes, but for times of day and the folder's own name."""
    return a is not None and b is not None and a.keys() == b.keys() and all(a[k] == b[k] for k in a)


def judged(code, err):
    """'2' where that is what it should be; '**1: ...**' where it is not."""
    if code in (0, 2, 3) and (code == 0 or err.strip()):
        return str(code)
    return f"**{signal.Signals(-code).name if isinstance(code, int) and code < 0 else code}: {err.strip().splitlines()[-1][:80] if err.strip() else 'no words'}**"


def main():
    args = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    args.add_argument("program", nargs="?", default=str(TOP / "build/release/app/driftwright"))
    args.add_argument("--kills", type=int, default=5)
    args.add_argument("--verbs", default="")
    args.add_argument("--seed", type=int, default=1)
    args = args.parse_args()
    program = os.path.abspath(args.program)
    random.seed(args.seed)
    work = Path(tempfile.mkdtemp(prefix="driftwright-faults-"))
    base_env = dict(os.environ, XDG_CACHE_HOME=str(work / "cache"))
    tiny = work / "tiny"
    tiny.mkdir()
    has_tiny = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=400k", "none", tiny], capture_output=True).returncode == 0
    try:
        # Records of the lumped spindle, as `simulate` writes them, and a study on them.
        subprocess.run([program, "simulate", str(TOP / "scenarios/lumped_spindle.yaml"), "-o", str(work / "simulated")], check=True,
                       env=base_env, capture_output=True)
        found = sorted((work / "simulated").rglob("*.csv"))
        found = [f for f in found if "heat_flow" not in str(f)]
        data = {k: str(found[i % len(found)]) for i, k in enumerate("abc")}
        if len(found) < 3:  # one run thrice, each a little longer ago
            text = found[0].read_text().splitlines()
            head = [l for l in text if l.startswith("#") or l.startswith("time")]
            rows = [l for l in text if not (l.startswith("#") or l.startswith("time"))]
            noise = random.Random(7)
            for k in "abc":
                path = work / f"{k}.csv"
                lines = []
                for row in rows:
                    cells = row.split(",")
                    lines.append(",".join([cells[0]] + [c if not c or i < 1 else f"{float(c) + (noise.gauss(0, 0.05) if float(c) != 0 and 'speed' not in head[-1].split(',')[i + 1] else 0):.6g}"
                                                        for i, c in enumerate(cells[1:])]))
                path.write_text("\n".join(head + lines) + "\n")
                data[k] = str(path)
        study = work / "study.yaml"
        study.write_text("name: study\nstudy: {target: nose_z, sensors_to_choose: 2, tolerance: 5 um}\n")
        correction = work / "correction.csv"
        correction.write_text("time_s,drift_um\n0,0\n1,4\n")
        rows_in = work / "rows.txt"
        rows_in.write_text("".join(f"{a} {b}\n" for _ in range(20000) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))))
        commands = verbs(data)
        model = work / "models"
        subprocess.run([program, *[str(w) if w not in ("OUT", "STUDY") else str(model if w == "OUT" else study) for w in commands["validate"]]],
                       env=base_env, capture_output=True)
        models = sorted((model / "models").glob("*.json")) if (model / "models").exists() else []
        names = {"STUDY": study, "CORRECTION": correction, "MODEL": models[-1] if models else "none.json"}
        chosen = args.verbs.split(",") if args.verbs else list(commands)
        faults = ["300 MB", "400 MB", "1500 MB", "disk 400 kB", "stdout full", "no TMPDIR", "no gnuplot", "cwd gone", "-o 300 long", f"{args.kills} kills, then again"]
        print("| verb | " + " | ".join(faults) + " |")
        print("|---" * (len(faults) + 1) + "|")
        for verb in chosen:
            command = [program] + [names.get(str(w), w) for w in commands[verb]]
            stdin = rows_in if verb == "inject" else None
            writes = "OUT" in [str(w) for w in command]
            out = work / "out" / verb
            code, err, usual_s = run(command, out, work, base_env, stdin=stdin)
            code, err, usual_s = run(command, out, work, base_env, stdin=stdin)
            right = files(out)
            row = []

            def tried(result, where=out):
                code, err, _ = result
                cell = judged(code, err)
                left = files(where) if writes else None
                if writes and code != 0 and left is not None and not same(left, right):
                    cell += " **half a folder**"
                if writes and code == 0 and not same(left, right):
                    cell += " **other bytes**"
                return cell

            for mb in (300, 400, 1500):
                row.append(tried(run(command, out, work, base_env, limit_mb=mb, stdin=stdin)))
            if has_tiny and writes:
                for p in tiny.iterdir():
                    shutil.rmtree(p)
                row.append(tried(run(command, tiny / "out", work, dict(base_env, TMPDIR=str(tiny)), stdin=stdin), tiny / "out"))
                left = [p.name for p in tiny.iterdir() if p.name not in ("out", "out.parts")]
                if left:
                    row[-1] += f" **left: {left[0]}**"
            else:
                row.append("-")
            with open("/dev/full", "wb") as full:
                row.append(tried(run(command, out, work, base_env, stdout=full, stdin=stdin)))
            row.append(tried(run(command, out, work, dict(base_env, TMPDIR="/no/such/folder"), stdin=stdin)))
            row.append(tried(run(command, out, work, dict(base_env, PATH="/nowhere"), stdin=stdin)))
            gone = work / "gone"
            gone.mkdir(exist_ok=True)
            row.append(judged(*run(["/bin/sh", "-c", 'rmdir "$PWD"; exec "$@"', "sh", *command], out, gone, base_env, stdin=stdin)[:2]))
            row.append(tried(run(command, work / ("x" * 300), work, base_env, stdin=stdin), work / "nowhere") if writes else "-")
            if writes:
                worst = "same bytes"
                for _ in range(args.kills):
                    shutil.rmtree(out, ignore_errors=True)
                    result = run(command, out, work, base_env, stdin=stdin, kill_after=max(0.02, random.uniform(0.05, 1.0) * usual_s))
                    left = files(out)
                    if left is not None and not same(left, right):
                        worst = "**half a folder**"
                    code, err, _ = run(command, out, work, base_env, stdin=stdin)
                    if code != 0 or not same(files(out), right):
                        worst = f"**{code}, other bytes**"
                beside = [p.name for p in out.parent.iterdir() if p.name != verb and p.name.startswith(verb)]
                row.append(worst + (f" **left: {beside[0]}**" if beside else ""))
            else:
                row.append("-")
            print(f"| {verb} | " + " | ".join(row) + " |", flush=True)
    finally:
        if has_tiny:
            subprocess.run(["umount", tiny])
        shutil.rmtree(work, ignore_errors=True)


if __name__ == "__main__":
    main()
