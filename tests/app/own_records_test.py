#!/usr/bin/env python3
"""Every verb reads what other verbs write: records of `simulate`, `predict`, `run` and `schedule` are given to select, validate, predict, calibrate and
diagnose. No run may end with 1 or a signal, and if the record has the columns that a verb needs, it must end with 0. A record that a
scenario simulated is consistent with it, and diagnosis.json has the keys that other programs rely on (docs/reference/diagnosis.md).

    own_records_test.py PROGRAM [SCENARIO ...]      [lumped_spindle]
"""
import json, os, subprocess, sys, tempfile
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "shared"))
from result_schema import errors

TOP = Path(__file__).resolve().parents[2]
UNJUDGED = {"lumped_spindle": "warm_up", "first_machine": "shift"}  # scenarios without a study for `run`, and one of their cyclograms
failures = []


def run(program, work, *words, wanted=(0,)):
    words = [str(w) for w in words]
    try:
        done = subprocess.run([program, *words], cwd=TOP, capture_output=True, text=True, timeout=900,
                              env=dict(os.environ, XDG_CACHE_HOME=os.environ.get("DRIFTWRIGHT_TEST_STORE", str(work / "cache"))))
        code, said = done.returncode, done.stderr.strip()
    except subprocess.TimeoutExpired:
        code, said = "900 s", ""
    print(f"{code}  {' '.join(words)}" + (f"\n   {said.splitlines()[-1][:200]}" if code and said else ""), flush=True)
    if code not in wanted:
        failures.append((code, words, said[-300:]))
    return code


def records_in(folder):
    return [f for f in sorted(folder.rglob("*.csv"))
            if not f.is_symlink() and ("record" in str(f.relative_to(folder)) or f.name in ("run.csv",)) and "time_s" in f.read_text()]


def scenario_of(name, work):
    """The scenario. One without mesh and study gets a study, so that all verbs can run."""
    path = TOP / f"scenarios/{name}.yaml"
    if name != "lumped_spindle":
        return path
    own = work / path.name
    own.write_text(path.read_text() + "\nstudy: {target: nose_z, train: [shift], judge: warm_up, sensors_to_choose: 2, candidates: "
                   "[t_housing, t_bearing_front, t_stator, t_shaft], tolerance: 5 um}\n")
    return own


def judge(diagnosis):
    """Judges the verbs on a record that the scenario itself simulated."""
    d = json.loads(diagnosis.read_text())
    if d["verdict"] != "consistent":
        failures.append(("verdict " + d["verdict"], [diagnosis.parent.name], d["reason"][:300]))
    wanted = {"verdict", "reason", "causes", "discriminating_experiment", "unexplained", "gain", "data", "calibrated", "process_noise", "complete", "n_candidates", "statements", "probability_nothing_wrong", "extended"}
    of_a_channel = {"name", "unit", "rmse_before", "rmse_calibrated", "rmse_after", "rmse_written", "noise_floor"}
    missing = wanted - d.keys() | {"gain.holdout" for _ in [0] if "holdout" not in d["gain"]} | of_a_channel - d["gain"]["channels"][0].keys()
    if missing:
        failures.append(("keys missing", sorted(missing), ""))


def try_scenario(program, name, work):
    scenario = scenario_of(name, work)
    written = []
    for verb in (["simulate"], ["predict", "--cyclogram", UNJUDGED[name]] if name in UNJUDGED else ["run"]):
        out = work / f"{name}-{verb[0]}"
        if run(program, work, verb[0], scenario, *verb[1:], "-o", out) == 0:
            written += records_in(out)
    print(f"{name}: {len(written)} records", flush=True)
    if not written:
        failures.append(("no records", [name], ""))
        return
    out = work / f"{name}-out"
    a, b, c = written[0], written[len(written) // 2], written[-1]
    # Only a single speed, or the same run twice, may be refused (2).
    for i, record in enumerate(written):
        run(program, work, "predict", scenario, "--cyclogram", record, "-o", out)
        other = written[i - 1]
        run(program, work, "select", scenario, "--train", record, "--train", other, "-o", out, wanted=(0, 2))
        run(program, work, "validate", scenario, "--train", record, "--test", other, "-o", out, wanted=(0, 2))
    if len({a, b, c}) == 3:
        run(program, work, "validate", scenario, "--train", a, "--train", b, "--test", c, "-o", out, wanted=(0, 2))
    for verb in ("calibrate", "diagnose"):
        run(program, work, verb, scenario, "--measured", a, "-o", out / verb)
    for file in (out / "calibrate" / "calibration.json", out / "diagnose" / "diagnosis.json"):
        failures.extend((file.name, ["schema"], error) for error in errors(program, file))
    judge(out / "diagnose" / "diagnosis.json")


def main():
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="driftwright-own-records-") as work:
        for name in sys.argv[2:] or ["lumped_spindle"]:
            try_scenario(program, name, Path(work))
    for code, words, said in failures:
        print(f"FAILED with {code}: {' '.join(words)}\n  {said}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
