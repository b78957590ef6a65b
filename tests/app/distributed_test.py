#!/usr/bin/python3
"""`mpirun -n N driftwright simulate SCENARIO --distributed` against one process: 1, 2, 3 and 4 ranks on a small FP3 and a small C-frame, what is refused, and
ranks that are killed.

    distributed_test.py PROGRAM OTHER_BUILD
"""
import csv, os, re, signal, subprocess, sys, tempfile, time, zlib
from pathlib import Path

import numpy as np

TOP = Path(__file__).resolve().parents[2]
MOST_K, MOST_UM = 1e-3, 1e-2  # what several processes may differ by
failures = []


def claim(holds, words):
    print(("ok  " if holds else "FAILED  ") + words, flush=True)
    if not holds:
        failures.append(words)


def edited(name, edits):
    """The text of a scenario that ships, with parts replaced; files of it by their full path."""
    text = (TOP / "scenarios" / f"{name}.yaml").read_text()
    for old, new in edits:
        text, n = re.subn(old, new, text, count=1, flags=re.S)
        assert n == 1, (name, old)
    return text.replace("parts/", f"{TOP}/scenarios/parts/").replace("records/", f"{TOP}/scenarios/records/")


def rows_of(path):
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    header, *rows = csv.reader(lines)
    return header, [[float(x or 0) for x in row] for row in rows]


def largest_differences(one, other):
    """By unit of the column: the largest difference of two records, and the largest value."""
    header, rows = rows_of(one)
    same, others = rows_of(other)
    assert header == same and len(rows) == len(others), (header, same, len(rows), len(others))
    found = {}
    for i, name in enumerate(header):
        unit = name.rsplit("_", 1)[-1]
        apart, size = found.get(unit, (0.0, 0.0))
        found[unit] = (max([apart] + [abs(a[i] - b[i]) for a, b in zip(rows, others)]), max([size] + [abs(a[i]) for a in rows]))
    return found


def fields_of(folder):
    """The nodes of the last file of fields, and its fields of nodes: arrays of VTK, compressed and appended."""
    data = sorted(folder.glob("fields/*.vtu"))[-1].read_bytes()
    text, raw = data.split(b'<AppendedData encoding="raw">', 1)
    raw = raw[raw.index(b"_") + 1:]
    word = np.uint64 if b'header_type="UInt64"' in text else np.uint32

    def array(tag):
        key = dict(re.findall(r'(\w+)="([^"]*)"', tag))
        at, size = int(key["offset"]), np.dtype(word).itemsize
        n = int(np.frombuffer(raw, word, 1, at)[0])
        lengths = np.frombuffer(raw, word, n, at + 3 * size)
        at += (3 + n) * size
        blocks = []
        for length in lengths:
            blocks.append(zlib.decompress(raw[at:at + int(length)]))
            at += int(length)
        return key["Name"], np.frombuffer(b"".join(blocks), {"Float64": float, "Float32": np.float32}[key["type"]])

    part = {name: re.search(rf"<{name}[ >].*?</{name}>", text.decode("latin1"), re.S)[0] for name in ("Points", "PointData")}
    tags = {name: [t for t in re.findall(r"<DataArray[^>]*>", inner) if 'type="Float' in t] for name, inner in part.items()}
    return array(tags["Points"][0])[1], dict(map(array, tags["PointData"]))


def main():
    program, other_build = map(os.path.abspath, sys.argv[1:3])
    with tempfile.TemporaryDirectory(prefix="driftwright-distributed-") as folder:
        work = Path(folder)
        env = dict(os.environ, XDG_CACHE_HOME=str(work / "cache"), OMP_NUM_THREADS="1", OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_MCA_mpi_yield_when_idle="1",
                   OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")

        def command(scenario, out, ranks=None, *more):
            words = [program, "simulate", str(scenario), "-o", str(out), *more]
            return ["mpirun", "-n", str(ranks), *words, "--distributed"] if ranks else words

        def run(words):
            return subprocess.run(words, cwd=work, env=env, capture_output=True, text=True, timeout=600)

        small = {
            "fp3_spindle": [(r"frame: 80 mm, spindle: 20 mm", "frame: 140 mm, spindle: 40 mm"), (r"model: reduced", "model: full"),
                            (r"warm_up_2000: \[\[300 min", "warm_up_2000: [[15 min")],
            "c_frame": [(r"default: 90 mm, head: 60 mm, spindle: 40 mm", "default: 160 mm, head: 110 mm, spindle: 70 mm"),
                        (r"warm_up: \[\[60 min, 6000 rpm\]\]", "warm_up: [[4 min, 6000 rpm]]"),
                        (r"fields_at: \[10 min, 15 min\]", "fields_at: [2 min]")],
        }
        cyclogram = {"fp3_spindle": "warm_up_2000", "c_frame": "warm_up"}
        for name, edits in small.items():
            scenario = work / f"{name}.yaml"
            scenario.write_text(edited(name, edits))
            begun = time.monotonic()
            done = run(command(scenario, work / f"{name}-one", None, "--cyclogram", cyclogram[name]))
            assert done.returncode == 0, done.stderr
            print(f"{name}: one process {time.monotonic() - begun:.1f} s")
            files = sorted(p.relative_to(work / f"{name}-one") for p in (work / f"{name}-one").rglob("*") if p.is_file())
            points, of_one = fields_of(work / f"{name}-one")
            for ranks in (1, 2, 3, 4):
                out = work / f"{name}-{ranks}"
                begun = time.monotonic()
                done = run(command(scenario, out, ranks, "--cyclogram", cyclogram[name]))
                words = f"{name}, {ranks} ranks, {time.monotonic() - begun:.1f} s"
                claim(done.returncode == 0, f"{words}: ends with 0 {done.stderr[-500:] if done.returncode else ''}")
                if done.returncode != 0:
                    continue
                claim(sorted(p.relative_to(out) for p in out.rglob("*") if p.is_file()) == files, f"{words}: the same files")
                apart = largest_differences(work / f"{name}-one/record.csv", out / "record.csv")
                claim(apart["degC"][0] <= MOST_K and apart["degC"][1] > 20.5, f"{words}: temperatures differ by {apart['degC'][0]:.1e} K")
                claim(apart["um"][0] <= MOST_UM and apart["um"][1] > 1.0, f"{words}: displacements differ by {apart['um'][0]:.1e} um")
                heat = largest_differences(work / f"{name}-one/heat_flows.csv", out / "heat_flows.csv")["W"]
                claim(heat[0] <= 1e-3 * heat[1], f"{words}: heat flows differ by {heat[0]:.1e} of {heat[1]:.0f} W")
                same, fields = fields_of(out)
                claim(abs(same - points).max() == 0.0 and sorted(fields) == sorted(of_one), f"{words}: the same nodes and fields")
                for field, most in (("temperature_degC", MOST_K), ("displacement_um", MOST_UM)):
                    field_apart = abs(fields[field] - of_one[field]).max()
                    claim(field_apart <= most, f"{words}: {field} of all nodes differs by {field_apart:.1e}")

        # What only one process computes, before any work: exit code 2, by its name, and no results.
        fp3 = work / "fp3_spindle.yaml"
        fixed = "effects:\n  - {type: fixed_temperature, surface: foot, temperature: 20 degC}\n"
        refused = {
            "model: reduced": edited("fp3_spindle", []),
            "lumped": (TOP / "scenarios/lumped_spindle.yaml").read_text(),
            "start: steady": "start: steady\n" + fp3.read_text(),
            "fixed_temperature": fp3.read_text().replace("effects:\n", fixed, 1),
            "moves axes": edited("moving_mill", []),
            "film from a file": (TOP / "scenarios/column_film.yaml").read_text().replace("model: reduced", "model: full"),
        }
        for what, text in refused.items():
            scenario = TOP / "scenarios" / f"refused_{os.getpid()}.yaml"  # beside the files that it names
            scenario.write_text(text)
            try:
                done = run(command(scenario, work / "refused", 2))
            finally:
                scenario.unlink()
            claim(done.returncode == 2 and what in done.stderr and "--distributed:" in done.stderr,
                  f"{what}: refused with {done.returncode}: {done.stderr.strip().splitlines()[:1]}")
            claim(done.stderr.count("error:") == 1 and not list(work.glob("refused*")), f"{what}: said once, nothing is left")
        done = run(["mpirun", "-n", "1", *command(fp3, work / "refused", None, "--distributed"), ":", "-n", "1", other_build])
        claim(done.returncode == 2 and "one build" in done.stderr and "other sources" in done.stderr, f"another build: {done.stderr.strip()[:200]}")

        # Temperatures that leave all bounds in the part of one rank: all fail alike, and the first one says it.
        runs_away = work / "runs_away.yaml"
        runs_away.write_text(fp3.read_text().replace("power: 85 W", "power: 1e6 W", 1))
        one, two = (run(command(runs_away, work / "too_hot", ranks, "--cyclogram", cyclogram["fp3_spindle"])) for ranks in (None, 2))
        claim(one.returncode not in (0, 2) and two.returncode == one.returncode, f"too hot: ends with {one.returncode} and {two.returncode}")
        claim(two.stderr.count("error:") == 1 and "cyclogram 'warm_up_2000'" in two.stderr, f"too hot: said once: {two.stderr.strip()[:200]}")
        claim(not list(work.glob("too_hot*")), "too hot: nothing is left")

        # A rank that is killed, early and late: mpirun says so, no results, nobody is left.
        def processes(marker):
            found = {}
            for entry in Path("/proc").iterdir():
                try:
                    if entry.name.isdigit() and marker in (entry / "cmdline").read_text() and b"OMPI_COMM_WORLD_RANK" in (entry / "environ").read_bytes():
                        found[int(re.search(rb"OMPI_COMM_WORLD_RANK=(\d+)", (entry / "environ").read_bytes())[1])] = int(entry.name)
                except OSError:
                    pass
            return found

        for victim, after_s in ((1, 0.5), (1, 4.0), (0, 2.0), (0, 5.0)):
            out = work / f"killed-{victim}-{after_s}"
            running = subprocess.Popen(command(fp3, out, 2, "--cyclogram", cyclogram["fp3_spindle"]), cwd=work, env=env, stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE, text=True)
            until = time.monotonic() + 30.0
            while len(processes(str(out))) < 2 and time.monotonic() < until:
                time.sleep(0.05)
            time.sleep(after_s)
            there = processes(str(out))
            if victim not in there:
                claim(False, f"rank {victim} had ended before it was killed after {after_s} s")
                running.wait()
                continue
            os.kill(there[victim], signal.SIGKILL)
            _, words = running.communicate(timeout=60)
            claim(running.returncode != 0 and "signal 9" in words, f"rank {victim} killed after {after_s} s: mpirun ends with {running.returncode}")
            claim(not out.exists(), f"rank {victim} killed after {after_s} s: no results")
            until = time.monotonic() + 10.0
            while processes(str(out)) and time.monotonic() < until:
                time.sleep(0.1)
            claim(not processes(str(out)), f"rank {victim} killed after {after_s} s: no process is left")

    print(f"{len(failures)} failures")
    sys.exit(1 if failures else 0)


main()
