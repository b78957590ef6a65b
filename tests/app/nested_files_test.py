#!/usr/bin/env python3
"""Files and rows that nest 300 000 deep, for every verb that reads JSON or YAML: a file ends the verb with exit code 2 and a message; `follow` continues after such a row.

    nested_files_test.py PROGRAM
"""
import os, subprocess, sys, tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
N = 300000
LISTS, OBJECTS = "[" * N + "]" * N, '{"a":' * N + "1" + "}" * N
PREDICTOR = TOP / "tests/fuzz/corpus/predictors/transfer_functions_from_speed.json"
OBSERVER = TOP / "tests/fuzz/corpus/predictors/observer.json"
SCENARIO = TOP / "scenarios/first_machine.yaml"
HEADER = "time_s,speed_rpm,ambient_degC\n"
failures = []


def main():
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="driftwright-nested-") as folder:
        work = Path(folder)
        env = dict(os.environ, XDG_CACHE_HOME=os.environ.get("DRIFTWRIGHT_TEST_STORE", str(work / "cache")))

        def run(label, *words, wanted=2, says="nested more than", rows=None, stdin=HEADER):
            for p in work.glob("out*"):
                subprocess.run(["rm", "-rf", p], check=True)
            done = subprocess.run([program, *map(str, words)], cwd=work, env=env, capture_output=True, text=True, input=stdin, timeout=300)
            said = done.stderr + done.stdout
            print(f"{done.returncode}  {label}: {done.stderr.strip()[:200]}", flush=True)
            if done.returncode != wanted or says not in said or len(done.stderr) > 4000:
                failures.append(f"{label}: {done.returncode}, {len(done.stderr)} characters: {done.stderr[-300:]}")
            if rows and rows not in done.stderr:
                failures.append(f"{label}: '{rows}' is not said: {done.stderr[-300:]}")

        (work / "study.yaml").write_text("name: study\nstudy: {target: nose_z, sensors_to_choose: 1, tolerance: 5 um}\n")
        for kind, nested in (("lists", LISTS), ("objects", OBJECTS)):
            bare, below, last = work / "bare.json", work / "below.json", work / "last.json"
            bare.write_text(nested)
            below.write_text('{"format": "driftwright predictor 1", "predictor": "formula", "formula": ' + nested + "}")
            whole = PREDICTOR.read_text().rstrip()
            assert whole.endswith("}")
            last.write_text(whole[:-1] + ', "more": ' + nested + "}")
            for file in (bare, below, last):
                run(f"follow, model of {kind}", "follow", file)
                run(f"compensate, model of {kind}", "compensate", "study.yaml", "--model", file, "--through", "none", "--measured",
                    TOP / "scenarios/records/good.csv", "-o", "out")
                run(f"export, model of {kind}", "export", SCENARIO, "--fmu", "--of", "observer", "--model", file, "-o", "out.fmu")
                run(f"calibrate-watch, model of {kind}", "follow", file, "--calibrate-watch", "out.watch", "--top-speed", "2000 rpm")
                run(f"follow, state of {kind}", "follow", SCENARIO, "--state", file)
                run(f"follow, limits of {kind}", "follow", OBSERVER, "--watch", file)

            # A folder of results whose list of files is not ours is not replaced.
            (work / "results").mkdir(exist_ok=True)
            (work / "results/driftwright-manifest.json").write_text('{"program": "driftwright", "files": ' + nested + "}")
            run(f"manifest of {kind}", "predict", SCENARIO, "--cyclogram", "shift", "-o", "results", says="--force")

        # Rows: a line has 100 000 characters at most.
        deep = ['{"time_s":' + "[" * 45000 + "]" * 45000 + "}", '{"time_s":1,"speed_rpm":' + '{"a":' * 15000 + "1" + "}" * 15000 + "}"]
        stream = ['{"time_s":0,"speed_rpm":0,"ambient_degC":20}', *deep, '{"time_s":60,"speed_rpm":0,"ambient_degC":20}']
        run("rows of follow", "follow", SCENARIO, wanted=0, stdin="\n".join(stream) + "\n", rows="4 rows, 2 taken; unreadable_row 2")
        (work / "rows.txt").write_text("\n".join(stream) + "\n")
        run("rows of a replay", "follow", SCENARIO, "--replay", "rows.txt", wanted=0, rows="4 rows, 2 taken; unreadable_row 2")
        run("a first row", "follow", SCENARIO, stdin=deep[0] + "\n")

        # YAML.
        for kind, text in (("lists", "[" * N + "]" * N), ("maps", "{a: " * N + "}" * N), ("lists that are not closed", "[" * N),
                           ("lists of blocks", "- " * N + "1"), ("keys", "? " * N + "1"), ("anchors", "&a " * N), ("tags", "!!x " * N)):
            (work / "nested.yaml").write_text(f"name: x\neffects:\n  {text}\n")
            for verb in (["check"], ["sweep"], ["simulate"], ["follow"], ["import", TOP / "scenarios/records/logger_file.csv", "-o", "out", "--by"]):
                run(f"{verb[0]}, {kind} in YAML", *verb, "nested.yaml", says="nested.yaml")
    for failure in failures:
        print(f"FAILED: {failure}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
