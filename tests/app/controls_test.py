#!/usr/bin/python3
"""`driftwright export --as`: a formula of `validate` for each control, a machine and an observer as plain C. What is written is compiled or read here, run on
judged rows, and compared with what the program itself says.

    controls_test.py PROGRAM FOLDER_OF_THE_PROJECT [--at-length]

--at-length: only the axis corrected over its travel, whose `validate` takes a minute.
"""
import array
import csv
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "shared"))
from claims import caller, expect, failures

PLAIN = ["gcc", "-std=c99", "-O2", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror", "-pedantic", "-Wconversion"]
MACHINE = """sensors: [{name: t_housing, node: housing}, {name: t_spindle, node: spindle}]
displacements: [{name: nose_z, sensitivities: [{node: spindle, sensitivity: 2.5 um/K}]}]
cyclograms:
  shift: [[120 min, 6000 rpm], [30 min, 0 rpm], [90 min, 3000 rpm]]
  slow: [[60 min, 2000 rpm], [30 min, 5000 rpm], [60 min, 0 rpm], [60 min, 4000 rpm]]
  judged: [[90 min, 4500 rpm], [45 min, 1500 rpm], [45 min, 0 rpm]]
study: {target: nose_z, train: [shift, slow], judge: judged, sensors_to_choose: 1, tolerance: 5 um}
"""
STATED_um = 1e-9  # besides half a unit of the last of the twelve digits of reference_out.csv
STATED_LIVE = 1e-3  # um and K, of laws that follow temperatures and a chiller that switches, where `predict` keeps 1e-8
LIVE = """  - {type: friction_law, node: spindle, power: 90 W, at_speed: 6000 rpm, decay: 0.02 1/K}
  - type: formula
    node: housing
    conductance: "G*(abs(T_h - T_a)/d)^0.25"
    G: 2 W/K
    d: 1 K
    T_h: housing
    T_a: ambient
  - {type: coolant, node: housing, tank: cooler, flow: 6 L/min, passage_conductance: 60 W/K, volume: 8 L, pump_power: 60 W, cooling_power: 500 W, set_point: 22 degC}
  - {type: learned, sensor: t_housing, keeps: 0.9, follows: ambient, rises: [[20 min, 0.1 K]]}
  - {type: learned, displacement: nose_z, keeps: 0.8, follows: running, above: 1000 rpm, grows: [[0 min, 3 um], [15 min, 6 um]]}
"""
CORNER = """name: corner
reference_temperature: 20 degC
ambient: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: body, capacity: 10 kJ/K}
  - {type: formula, node: body, power: "P*sqrt(1 - a*n*P_cut)*n/n0", P: 100 W, n0: 3000 rpm, a: 3.36e-6 1/(rpm W)}
  - {type: link, node: body, to: ambient, conductance: 5 W/K}
displacements: [{name: nose_z, sensitivities: [{node: body, sensitivity: 2 um/K}]}]
cyclograms:
  warm:
    columns: [duration, speed, cutting_power]
    rows: [[60 min, 3000 rpm, 20 W], [60 min, 100 rpm, 100 W]]
"""
ALONG = CORNER[: CORNER.index("  - {type: formula")] + """  - {type: heat_source, node: body, power: 100 W, at_speed: 3000 rpm, exponent: 1}
  - {type: link, node: body, to: ambient, conductance: 5 W/K}
  - {type: linear_scale, displacement: x, body: body, expansion: 8e-6 1/K, position: position_x}
  - {type: linear_scale, displacement: y, body: body, expansion: 8e-6 1/K, position: position_y}
displacements:
  - {name: x, sensitivities: [{node: body, sensitivity: 2 um/K}]}
  - {name: y, sensitivities: [{node: body, sensitivity: 1 um/K}]}
cyclograms:
  warm:
    columns: [duration, speed, position_x_mm, position_y_mm]
    rows: [[60 min, 3000 rpm, -200 mm, 0 mm], [60 min, 100 rpm, 300 mm, 300 mm]]
"""
CORNER_ROWS = """#include <stdio.h>
#include "plain_model.h"
static plain_model m;
static void tell(const char* wrong) { printf("%s|%.17g\\n", wrong ? wrong : "", m.outputs[0]); }
int main(void) {
  const double inside[PLAIN_INPUTS] = {3000.0, 20.0, 20.0}, corner[PLAIN_INPUTS] = {3000.0, 100.0, 20.0};
  tell(plain_start(&m, corner));
  tell(plain_start(&m, inside));
  tell(plain_row(&m, inside, 60.0));
  tell(plain_row(&m, corner, 60.0));
  tell(plain_row(&m, inside, 60.0));
  tell(plain_row(&m, inside, 60.0));
  return 0;
}
"""
ROWS = """#include <math.h>
#include <stdio.h>
#include <string.h>
#include "plain_model.h"
static plain_model m, other;
static void tell(const char* wrong) { printf("%s|%.17g\\n", wrong ? wrong : "", m.outputs[PLAIN_NOSE]); }
int main(void) {
  double x[PLAIN_INPUTS] = {3000.0, 20.0};
  int k, i, n;
  for (i = 2; i < PLAIN_INPUTS; ++i) x[i] = i == 2 ? 20.0 : 0.0;
  tell(plain_start(&m, x));
  for (k = 0; k < 3; ++k) tell(plain_row(&m, x, 60.0));
  memcpy(&other, &m, sizeof m.saved);
  x[1] = NAN; tell(plain_row(&m, x, 60.0));      /* an ambient thermometer that breaks */
  x[1] = 20.0; x[0] = 1e5; tell(plain_row(&m, x, 60.0));
  x[0] = 3000.0; tell(plain_row(&m, x, -1.0));
  tell(plain_row(&m, x, 120.0));
  memcpy(&m, &other, sizeof m.saved); tell(plain_row(&m, x, 120.0)); /* without the rows that are refused */
  for (n = 1; n <= 600; n += 599) { /* a speed that is the same, and one that is measured: it changes in each row */
    tell(plain_start(&m, x));
    for (k = 1; k <= 600; ++k) { x[0] = n == 1 ? 3000.0 : 2970.0 + 20.0 * (k % 4); (void)plain_row(&m, x, 1.0); }
    tell(0);
  }
  return 0;
}
"""


def numbers(path):
    return list(csv.DictReader(line for line in pathlib.Path(path).open() if not line.startswith("#")))


def plain_c(call, folder, what, *words, stated=STATED_um):
    done = call("export", *words, "--as", "c", "-o", what)
    expect(done.returncode == 0, f"{what} is exported: {done.stderr.strip()[-300:]}")
    if done.returncode != 0:
        return
    own = folder / what
    sources = sorted(file.name for file in own.glob("*.c") if file.name != "example.c")
    done = subprocess.run([*PLAIN, "-c", *sources], cwd=own, capture_output=True, text=True)
    expect(done.returncode == 0, f"{what} compiles without a warning: {done.stderr[-300:]}")
    used = subprocess.run(["nm", "-u", *(name[:-2] + ".o" for name in sources)], cwd=own, capture_output=True, text=True).stdout
    expect(not re.search(r"\b(malloc|calloc|realloc|free|printf|fopen)\b", used), f"{what} takes no memory and opens no file")
    subprocess.run([*PLAIN, *sources, "example.c", "-lm", "-o", "example"], cwd=own, check=True)
    with (own / "reference_in.csv").open() as rows, (own / "out.csv").open("w") as out:
        done = subprocess.run(["./example"], cwd=own, stdin=rows, stdout=out, stderr=subprocess.PIPE, text=True)
    expect(done.returncode == 0, f"{what} runs: {done.stderr[-300:]}")
    got, judged = numbers(own / "out.csv"), numbers(own / "reference_out.csv")
    expect(len(got) == len(judged) > 100, f"{what}: {len(got)} rows")
    worst, most = 0.0, 0.0
    for a, b in zip(got, judged):
        for name, text in b.items():
            worst = max(worst, abs(float(a[name]) - float(text)) - 5e-12 * abs(float(text)))
            most = max(most, abs(float(text)) if name == "nose_z" else 0.0)
    expect(worst <= stated and most > 5.0, f"{what} is the judged one: within {worst:.1e}, largest {most:.1f} um")
    rows_of_a_plc(own, what, sources)


def rows_of_a_plc(own, what, sources):
    nose = re.findall(r"^ \*   (\d+) nose_z$", (own / "plain_model.h").read_text(), re.M)[0]
    (own / "rows.c").write_text(ROWS)
    subprocess.run(["gcc", "-std=c99", "-O2", "-ffp-contract=off", f"-DPLAIN_NOSE={nose}", *sources, "rows.c", "-lm", "-o", "rows"], cwd=own, check=True)
    told = subprocess.run([own / "rows"], capture_output=True, text=True, check=True).stdout.splitlines()
    words, um = zip(*(line.split("|") for line in told))
    expect(not any(words[:4]) and "finite" in words[4] and "min and max" in words[5] and "above 0" in words[6] and not any(words[7:]), f"{what} says what is wrong: {words}")
    expect(len(set(um[3:7])) == 1 and um[7] == um[8] != um[3], f"{what}: a row that is refused changes nothing: {um[3:9]}")
    same, measured = float(um[10]), float(um[12])
    expect(abs(measured - same) < 0.01 + 0.01 * abs(same), f"{what}: with a speed that changes in each row {measured:.4f} um, with its mean {same:.4f} um")


def law_without_a_value(call, folder):
    """Both inputs are within their range, and together they leave a law of the drive without a value."""
    (folder / "corner.yaml").write_text(CORNER)
    done = call("export", "corner.yaml", "--as", "c", "-o", "corner_c")
    expect(done.returncode == 0, f"corner_c is exported: {done.stderr.strip()[-300:]}")
    own = folder / "corner_c"
    (own / "rows.c").write_text(CORNER_ROWS)
    sources = sorted(file.name for file in own.glob("*.c") if file.name != "example.c")
    subprocess.run(["gcc", "-std=c99", "-O2", "-ffp-contract=off", *sources, "-lm", "-o", "rows"], cwd=own, check=True)
    told = subprocess.run([own / "rows"], capture_output=True, text=True, check=True).stdout.splitlines()
    words, um = zip(*(line.split("|") for line in told))
    expect([bool(w) for w in words] == [True, False, False, True, False, False] and "no value at this drive" in words[3], f"a drive without heat is refused: {words}")
    # 100 W sqrt(1 - 0.2016) into 10 kJ/K with 5 W/K: 1 - exp(-t / 2000 s) of 17.87 K, 2 um each; a row refused changes nothing
    expect(um[3] == um[2] and all(abs(float(um[k]) - 35.7413 * (1.0 - math.exp(-60.0 * n / 2000.0))) < 1e-3 for k, n in ((2, 1), (4, 2), (5, 3))), f"and changes nothing: {um}")


def structured_text(text):
    """A function of a dict of inputs: what the function block gives at each call."""
    memory = {name: 0.0 for name in re.findall(r"^  (\w+) : LREAL;", text, re.M)}
    body = text.split("END_VAR\n")[-1].split("END_FUNCTION_BLOCK")[0]
    lines = []
    for line in body.splitlines():
        condition = re.fullmatch(r"IF (.*) (<|=|>) (.*) THEN (\w+) := (.*); END_IF;", line)
        always = re.fullmatch(r"(\w+) := (.*);", line)
        if condition:
            a, sign, b, target, value = condition.groups()
            lines.append(f"if {a} {'==' if sign == '=' else sign} {b}: {target} = {value}")
        else:
            lines.append(f"{always.group(1)} = {always.group(2)}")
    code = compile("\n".join(lines), "st", "exec")

    def call(inputs):
        memory.update(inputs)
        exec(code, {}, memory)
        return memory["correction_um"]

    return call


def formula(call, folder, name, record):
    model = f"judged/models/{name}.json"
    for as_, own in (("c", [f"{name}.c"]), ("linuxcnc", [f"{name}.c", f"{name}_axis.comp"]), ("text", [f"{name}.txt"])):
        done = call("export", "--model", model, "--as", as_, "-o", f"{name}_{as_}")
        expect(done.returncode == 0, f"{name} as {as_}: {done.stderr.strip()[-300:]}")
        for file in own:
            same = [re.sub(r"Driftwright [^\n]*", "", (folder / place / file).read_text()) for place in (f"{name}_{as_}", "judged/models")]
            expect(same[0] == same[1], f"{file} is what `validate` wrote")
    done = call("export", "--model", model, "--as", "st", "-o", f"{name}_st")
    expect(done.returncode == 0, f"{name} as st: {done.stderr.strip()[-300:]}")
    text = next((folder / f"{name}_st").glob("*.st")).read_text()
    period_s = float(re.search(r"One row every (\S+) s", text).group(1))
    c_text = (folder / f"{name}_c/{name}.c").read_text()
    inputs = re.findall(r"double (\w+)", re.search(r"double nose_z_correction_um\(nose_z_state \*s, (.*?)double dt_s\)", c_text).group(1))
    wanted = re.findall(r"^  (in_\w+) : LREAL;", text, re.M)
    expect(wanted == ["in_" + x for x in inputs], f"{name}: inputs {wanted}")
    rows = [[float(row[x] or "nan") for x in inputs] for row in numbers(record)]
    (folder / f"{name}_c/main.c").write_text(
        f'#include <stdio.h>\n#include "{name}.c"\nint main(void) {{\n  static nose_z_state s;\n  double x[{len(inputs)}];\n'
        f"  while (fread(x, sizeof x, 1, stdin) == 1) {{\n    int k, doubted = 0;\n    const double um = nose_z_correction_um(&s, "
        + "".join(f"x[{k}], " for k in range(len(inputs)))
        + f"{period_s!r});\n    for (k = 0; k < {len(inputs)}; ++k) doubted |= s.inputs[k].is_doubted;\n"
        '    printf("%.17g %d\\n", um, doubted);\n  }\n  return 0;\n}\n')
    sources = ["main.c", "drift_correction.c", "probe_feedback.c", "probe_members.c"]
    subprocess.run(["gcc", "-std=c99", "-O2", "-ffp-contract=off", *sources, "-lm", "-o", "run"], cwd=folder / f"{name}_c", check=True)
    given = array.array("d", [x for row in rows for x in row]).tobytes()
    told = subprocess.run(["./run"], cwd=folder / f"{name}_c", input=given, capture_output=True, check=True).stdout.decode().split()
    block, worst, most, n = structured_text(text), 0.0, 0.0, 0
    for row, um, doubted in zip(rows, told[::2], told[1::2]):
        if doubted != "0":
            break  # from here on the C replaces readings
        worst = max(worst, abs(block(dict(zip(wanted, row))) - float(um)))
        most = max(most, abs(float(um)))
        n += 1
    expect(n > 50 and most > 5.0 and worst <= STATED_um, f"{name} as structured text gives the judged correction: {n} rows up to {most:.1f} um within {worst:.1e} um")
    done = call("export", "--model", model, "--as", "siemens", "--axis", "Y", "-o", f"{name}_siemens")
    many = "synchronized actions" in done.stderr
    expect(done.returncode == (2 if many else 0), f"{name} as siemens: {done.stderr.strip()[-200:]}")
    has_time = "LAG(" in (folder / f"judged/models/{name}.txt").read_text() or "rpm" in " ".join(inputs)
    for as_ in ("heidenhain", "fanuc"):
        done = call("export", "--model", model, "--as", as_, "--axis", "Y", "-o", f"{name}_{as_}")
        refused = has_time or (as_ == "heidenhain" and len(inputs) > 8)
        expect(done.returncode == (2 if refused else 0), f"{name} as {as_}: {done.stderr.strip()[-200:]}")
        expect(not refused or "--as st" in done.stderr or "take a formula of fewer" in done.stderr, f"{name} as {as_} says what to use")


def over_travel(call, folder, top):
    """Corrections for two places of the shipped screw, judged along its travel and exported as one."""
    text = (top / "scenarios/ball_screw.yaml").read_text()
    (folder / "screw.yaml").write_text(text.replace("[0 mm, 400 mm, 800 mm]", "[0 mm, 800 mm]").replace("output_interval: 1 min", "output_interval: 5 min"))
    done = call("validate", "screw.yaml", "-o", "along")
    expect(done.returncode == 0, f"validate along a travel: {done.stderr.strip()[-300:]}")
    summary = json.loads((folder / "along/summary.json").read_text())
    left = summary["travel"]["left"]
    chosen = [row for row in left if row["strategy"] == summary["travel"]["chosen"]]
    expect([row["corrected"] for row in chosen] == ["0 mm", "800 mm", "0 and 800 mm"], f"one of two places, and both: {chosen}")
    none, alone, both = left[0]["peak_um"], min(row["peak_um"] for row in chosen[:2]), chosen[2]["peak_um"]
    expect(none > 90 and alone > 0.5 * none and both < 0.75 * alone, f"{none:.1f} um without, {alone:.1f} um with one place at best, {both:.1f} um with both")
    expect([place["place"] for place in summary["validation"]] == ["x_0", "x_800"], "each place has its own judgement")
    models = [f"along/models/{place}/ridge_all_sensors.json" for place in ("x_0", "x_800")]
    blocks = []
    for given in ([models[0]], [models[1]], models[::-1]):  # in any order
        done = call("export", *(word for model in given for word in ("--model", model)), "--as", "st", "-o", f"st{len(blocks)}")
        expect(done.returncode == 0, f"{given} as st: {done.stderr.strip()[-300:]}")
        blocks.append(structured_text(next((folder / f"st{len(blocks)}").glob("*.st")).read_text()))
    done = call("simulate", "screw.yaml", "--cyclogram", "shift", "-o", "screw_run")
    expect(done.returncode == 0, f"simulate: {done.stderr.strip()[-300:]}")
    names = re.findall(r"^  in_(\w+) : LREAL;", next((folder / "st2").glob("*.st")).read_text(), re.M)
    worst, most = 0.0, 0.0
    for n, row in enumerate(numbers(folder / "screw_run/record.csv")):
        inputs = {"in_" + name: float(row[name]) for name in names}
        near, far = blocks[0](inputs), blocks[1](inputs)
        at_mm = (-100.0, 0.0, 200.0, 800.0, 900.0)[n % 5]
        share = min(max(at_mm / 800.0, 0.0), 1.0)
        worst = max(worst, abs(blocks[2]({**inputs, "position_mm": at_mm}) - (near + share * (far - near))))
        most = max(most, abs(far - near))
    expect(worst <= STATED_um and most > 20.0, f"over the travel it is straight between the places: within {worst:.1e} um, they differ by {most:.1f} um")
    both_words = [word for model in models for word in ("--model", model)]
    done = call("export", *both_words, "--as", "linuxcnc", "-o", "screw_hal")
    expect(done.returncode == 0 and (folder / "screw_hal/x_screw_over_travel_axis.comp").exists(), f"as linuxcnc: {done.stderr.strip()[-300:]}")
    done = subprocess.run([*PLAIN[:-1], "-c", "x_screw_over_travel.c", "drift_correction.c", "axis_travel.c", "axis_offset.c"], cwd=folder / "screw_hal", capture_output=True, text=True)
    expect(done.returncode == 0, f"its C compiles without a warning: {done.stderr[-300:]}")
    for words, said in (((*both_words, "--as", "heidenhain", "--axis", "X"), "one shift for the whole travel"), (("--model", models[0], "--model", models[0], "--as", "st"), "each place may have one"),
                        (("--model", models[0], "--model", "judged/models/ridge_all_sensors.json", "--as", "st"), "does not say its place")):
        done = call("export", *words, "-o", "refused")
        expect(done.returncode == 2 and said in done.stderr, f"refused: {done.stderr.strip()[-200:]}")


def main():
    program, top = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory(prefix="driftwright_controls-") as name:
        folder = pathlib.Path(name)
        call = caller(program, folder)
        first = (top / "scenarios/first_machine.yaml").read_text()
        (folder / "small.yaml").write_text(first[: first.index("sensors:")] + MACHINE)
        done = call("validate", "small.yaml", "-o", "judged")
        expect(done.returncode == 0, f"validate: {done.stderr.strip()[-300:]}")
        if "--at-length" in sys.argv:
            over_travel(call, folder, top)
            return 1 if failures else 0
        done = call("simulate", "small.yaml", "--cyclogram", "judged", "-o", "run")
        expect(done.returncode == 0, f"simulate: {done.stderr.strip()[-300:]}")
        plain_c(call, folder, "machine_c", "small.yaml")
        (folder / "live.yaml").write_text(first[: first.index("sensors:")] + LIVE + MACHINE + "solver: {relative_tolerance: 1e-8, absolute_tolerance: 1e-8 K}\n")
        plain_c(call, folder, "live_c", "live.yaml", stated=STATED_LIVE)
        law_without_a_value(call, folder)
        (folder / "along.yaml").write_text(ALONG)
        said = call("export", "along.yaml", "--fmu", "-o", "along.fmu").stdout
        ranges = re.findall(r"^  (\w+) from (\S+) to (\S+) (\S+)$", said, re.M)
        expect(ranges == [("spindle_speed", "0", "3000", "rpm"), ("position_x", "-200", "300", "mm"), ("position_y", "0", "300", "mm")], f"each input once, with its range: {said}")
        for model in ("observer", "thermal_modes_of_the_model", "model_fitted_to_the_training_runs"):
            plain_c(call, folder, model + "_c", "small.yaml", "--of", "observer", "--model", f"judged/models/{model}.json")
        for model in ("one_thermometer", "ridge_all_sensors", "regression_with_lags", "thermometers_and_drive", "transfer_functions_from_speed"):
            formula(call, folder, model, folder / "run/record.csv")
        done = call("export", "--model", "judged/models/observer.json", "--as", "st", "-o", "refused")
        expect(done.returncode == 2 and "--of observer" in done.stderr, f"an observer is no formula: {done.stderr.strip()[-200:]}")
        done = call("export", "--model", "judged/models/no_correction.json", "--as", "c", "-o", "refused")
        expect(done.returncode == 2 and "no formula" in done.stderr, f"nor is a baseline: {done.stderr.strip()[-200:]}")
        for words in (("--as", "st", "--axis", "Y"), ("--as", "fanuc", "--axis", "Y", "--axis-moves", "against_dk")):
            done = call("export", "--model", "judged/models/one_thermometer.json", *words, "-o", "refused")
            expect(done.returncode == 2 and "leave" in done.stderr, f"{words[1]} does not take {words[-2]}: {done.stderr.strip()[-200:]}")
        expect(not (folder / "refused").exists(), "nothing is left of what was refused")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
