#!/usr/bin/env python3
"""Long runs and runs that are killed often: `inject` at constant memory, and a sweep that is killed again and again.

    bench/long_runs.py [PROGRAM] [--rows 100000000] [--members 10000] [--kills 20] [--only inject|sweep]

`inject` reads --rows encoder rows from a pipe. Its largest resident memory is compared with that for a thousandth of the rows.
The sweep is scenarios/lumped_sweep.yaml with --members members. It runs once undisturbed, and once killed with SIGKILL after random parts of that time
and started again. Both folders of results are compared byte by byte. The script prints the measurements; exit code 1 means that a check failed.
"""
import argparse, os, random, subprocess, sys, tempfile, threading, time
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
CYCLE = b"1 0\n1 1\n0 1\n0 0\n"
MOST_GROWTH_MB = 2.0


def fed(pipe, n_rows):
    block = CYCLE * 16384
    whole, rest = divmod(n_rows * len(CYCLE) // 4, len(block))
    for _ in range(whole):
        pipe.write(block)
    pipe.write(block[:rest])
    pipe.close()


def inject(program, work, n_rows):
    """@return exit code, rows that came out, seconds, largest resident memory [MB]"""
    correction = work / "correction.csv"
    correction.write_text("row,drift_um\n" + "".join(f"{i * n_rows // 10 + 1},{40 * (i % 3)}\n" for i in range(10)))
    began = time.time()
    process = subprocess.Popen([program, "inject", "--correction", correction, "--period", "4 um"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    threading.Thread(target=fed, args=(process.stdin, n_rows), daemon=True).start()
    n_out = 0
    while block := process.stdout.read(1 << 20):
        n_out += block.count(b"\n")
    _, status, used = os.wait4(process.pid, 0)
    return os.waitstatus_to_exitcode(status), n_out, time.time() - began, used.ru_maxrss / 1024


def files(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def sweep(program, work, n_members, n_kills):
    text = (TOP / "scenarios/lumped_sweep.yaml").read_text()
    (work / "lumped_spindle.yaml").write_text((TOP / "scenarios/lumped_spindle.yaml").read_text())
    study = work / "sweep.yaml"
    study.write_text(text.replace("samples: 48", f"samples: {n_members}"))
    out = work / "killed"
    command = [program, "sweep", study, "--quiet", "-o"]
    began = time.time()
    subprocess.run([*command, work / "undisturbed"], check=True)
    usual_s = time.time() - began
    # A killed run continues from where it was. Its parts together last as long as the undisturbed run, and none ends early.
    n_killed = 0
    while n_killed < n_kills:
        process = subprocess.Popen([*command, out])
        try:
            process.wait(timeout=max(0.05, random.uniform(0.2, 1.8) * usual_s / (n_kills + 2)))
            break
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            n_killed += 1
            if out.exists():
                sys.exit(f"sweep: the folder of results is there after kill {n_killed}")
    code = subprocess.run([*command, out]).returncode
    return code, n_killed, usual_s, files(work / "undisturbed"), files(out)


def main():
    args = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    args.add_argument("program", nargs="?", default=str(TOP / "build/release/app/driftwright"))
    args.add_argument("--rows", type=int, default=10**8)
    args.add_argument("--members", type=int, default=10**4)
    args.add_argument("--kills", type=int, default=20)
    args.add_argument("--seed", type=int, default=1)
    args.add_argument("--only", choices=["inject", "sweep"])
    args = args.parse_args()
    program = os.path.abspath(args.program)
    random.seed(args.seed)
    is_kept = True
    with tempfile.TemporaryDirectory(prefix="driftwright-long-") as folder:
        work = Path(folder)
        if args.only != "sweep":
            n_few = max(4, args.rows // 1000)
            _, _, _, few_MB = inject(program, work, n_few)
            code, n_out, time_s, all_MB = inject(program, work, args.rows)
            print(f"inject: exit code {code}, {args.rows} rows in, {n_out} out in {time_s:.0f} s; {all_MB:.1f} MB at most, {few_MB:.1f} MB for {n_few} rows", flush=True)
            is_kept = code == 0 and n_out >= args.rows and all_MB < few_MB + MOST_GROWTH_MB
        if args.only != "inject":
            code, n_killed, time_s, right, got = sweep(program, work, args.members, args.kills)
            unlike = sorted(k for k in right.keys() | got.keys() if right.get(k) != got.get(k))
            print(f"sweep: exit code {code}, {args.members} members, {time_s:.0f} s undisturbed; killed {n_killed} times; {len(right)} files, unlike: {unlike or 'none'}", flush=True)
            is_kept = is_kept and code == 0 and n_killed == args.kills and not unlike
    sys.exit(0 if is_kept else 1)


if __name__ == "__main__":
    main()
