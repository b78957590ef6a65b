#!/usr/bin/env python3
"""Runs every indented `driftwright` command of README and of the pages below unchanged, and checks that it prints what the page shows under it. It also runs every example in the --help of a verb. Left out are docs/start/fl_thermal.md and docs/theory/measured.md,
whose records others published, and docs/how-to/library.md, whose programs `installed_test.sh` and `python_test.py` build and run.

    documents_test.py PROGRAM FOLDER_OF_THE_PROJECT [--at-length] [PAGE ...]

Without --at-length the commands of AT_LENGTH are left out, and those of SHORTER replaced, whose shown output is then not compared; with it all run as they are shown.

Commands run in a folder that holds scenarios/ and docs/ of the project, in the order of the pages, so that a command may read what an earlier one wrote. A command that several pages show
runs once; each page must show what it printed. Each line of a shown output must be printed. Several blanks count as one; a line that ends with "..." is the beginning of a line; "..." alone means any number of lines.
"""
import os, re, resource, subprocess, sys, tempfile
import xml.etree.ElementTree as xml
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "shared"))
from result_schema import errors

PAGES = ["README.md", "docs/start/commands.md", "docs/how-to/scenario.md", "docs/how-to/own_law.md", "docs/how-to/feed_axis.md", "docs/how-to/films.md", "docs/how-to/coolant_channel.md", "docs/how-to/meshes.md", "docs/start/first_diagnosis.md", "docs/start/diagnosis.md", "docs/how-to/identification.md", "docs/how-to/prediction.md", "docs/how-to/validation.md", "docs/how-to/probing.md", "docs/how-to/schedule.md", "docs/how-to/sweep.md", "docs/how-to/fmu.md", "docs/how-to/controls.md", "docs/reference/record.md", "docs/how-to/view.md", "docs/how-to/warmup.md", "docs/how-to/test_planning.md"]
# Shorter commands of these pages, or tests of the verb, do the same: `diagnose` of the first machine, `validate_records`, `schedule_verb`, `place_verb`, `warmup_verb`, `Init.OfADrawingRunsAtOnce`,
# `own_records` for `calibrate`, the same of a small drawing for `mesh --convergence`.
# 20 parts last so long that the FP3 is reduced again.
AT_LENGTH = ("driftwright diagnose scenarios/fp3_spindle.yaml", "driftwright validate results/identified/monday.yaml", "driftwright schedule scenarios/fp3_spindle.yaml --program scenarios/parts/fp3_part.ngc --start",
             "driftwright place scenarios/fp3_spindle.yaml", "driftwright warmup scenarios/fp3_spindle.yaml", "driftwright predict scenarios/fp3_spindle.yaml --cyclogram chaotic --start results/warmup/",
             "driftwright run results/mill/mill.yaml", "driftwright validate scenarios/ball_screw.yaml", "driftwright export --model results/axis/", "driftwright calibrate scenarios/fp3_spindle.yaml", "driftwright mesh scenarios/fp3_spindle.yaml --convergence")
# What writes the files that later commands read. This one leaves the families of cyclograms out, which take half of its time and which `continued_records` has of a small machine.
SHORTER = {"driftwright validate scenarios/fp3_spindle.yaml -o results/validation":
           "sed '/^programme:/,/^study:/{/^study:/!d}' scenarios/fp3_spindle.yaml > fp3_study.yaml && driftwright validate fp3_study.yaml -o results/validation"}
COMMAND = re.compile(r"^    (?:[a-z]+ .*\| )?(?:\./)?driftwright [a-z]")


def blocks(text):
    """The commands of a page, as (line number, command, lines shown under it)."""
    found, shown = [], None
    for number, line in enumerate(text.splitlines(), 1):
        if COMMAND.match(line):
            shown = []
            found.append((number, line.strip(), shown))
        elif line.startswith("    ") and shown is not None:
            shown.append(line.strip())
        else:
            shown = None
    return found


def plain(line):
    return " ".join(line.split())


def not_printed(shown, printed):
    lines = [plain(line) for line in printed.splitlines()]
    for line in map(plain, shown):
        if line == "..." or line.startswith("#"):
            continue
        beginning = line[:-3].rstrip() if line.endswith("...") else None
        if not any(p == line if beginning is None else p.startswith(beginning) for p in lines):
            return line
    return None


def processor_s():
    """What the commands have taken so far: the processor's time, which other work on the machine does not lengthen."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def examples(program):
    """The examples in --help, as (verb, command)."""
    verbs = re.findall(r"^  ([a-z-]+) ", subprocess.run([program, "--help"], capture_output=True, text=True).stdout.split("Subcommands:")[1].split("Exit codes:")[0], re.M)
    for verb in verbs:
        text = subprocess.run([program, verb, "--help"], capture_output=True, text=True).stdout.split("Example:")
        if len(text) != 2:
            yield verb, "false  # no example"
            continue
        for command in re.findall(r"^  (driftwright .*)$", text[1], re.M):
            yield verb, command


def main():
    program, top = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    pages = [page for page in sys.argv[3:] if page != "--at-length"]
    left_out, shorter = ((), {}) if "--at-length" in sys.argv else (AT_LENGTH, SHORTER)
    failures = n = 0
    done_before = {}  # of each command, as it is typed without ./ and remarks: how it ended
    with tempfile.TemporaryDirectory(prefix="driftwright-documents-") as folder:
        work = Path(folder)
        (work / "scenarios").symlink_to(top / "scenarios")
        (work / "docs").symlink_to(top / "docs")
        (work / "driftwright").symlink_to(program)
        env = dict(os.environ, XDG_CACHE_HOME=os.environ.get("DRIFTWRIGHT_TEST_STORE", str(work / "cache")), PATH=f"{work}:{os.environ['PATH']}")
        for page in pages or PAGES:
            for number, command, shown in blocks((top / page).read_text()):
                typed = command.removeprefix("./").split("  #")[0].strip()
                if typed.startswith(left_out):
                    continue
                n += 1
                begun = processor_s()
                if typed not in done_before:
                    done_before[typed] = subprocess.run(["bash", "-c", shorter.get(typed, command)], cwd=work, env=env, capture_output=True, text=True)
                done = done_before[typed]
                missed = not_printed(shown, done.stdout) if done.returncode == 0 and typed not in shorter else None
                print(f"{processor_s() - begun:6.1f} s  {page}:{number}: {command}", flush=True)
                if done.returncode != 0 or missed:
                    failures += 1
                    print(f"  FAILED: {done.stderr.strip()[-400:] if done.returncode else 'not printed: ' + missed}", flush=True)
        for verb, command in () if pages else examples(program):
            if command in done_before or command.startswith(left_out):
                continue
            n += 1
            begun = processor_s()
            done = subprocess.run(["bash", "-c", command], cwd=work, env=env, capture_output=True, text=True)
            print(f"{processor_s() - begun:6.1f} s  {verb} --help: {command}", flush=True)
            if done.returncode != 0:
                failures += 1
                print(f"  FAILED: {done.stderr.strip()[-400:]}", flush=True)
        figures = sorted(work.glob("results/*/figures/*.svg"))
        for figure in figures:
            try:
                if not xml.parse(figure).getroot().get("viewBox"):
                    raise ValueError("no viewBox")
            except Exception as wrong:
                failures += 1
                print(f"  FAILED: {figure.relative_to(work)} is no SVG file: {wrong}", flush=True)
        if not pages and len(figures) < 20:
            failures += 1
            print(f"  FAILED: {len(figures)} figures stand beside reports", flush=True)
        for file in [*work.rglob("diagnosis.json"), *work.rglob("calibration.json")]:
            for error in errors(program, file):
                failures += 1
                print(f"  FAILED: {file.relative_to(work)}, by its schema: {error}", flush=True)
    print(f"{n} commands, {failures} failed")
    return 1 if failures or n < 20 else 0


if __name__ == "__main__":
    sys.exit(main())
