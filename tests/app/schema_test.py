#!/usr/bin/python3
"""Checks `driftwright schema` with an independent validator: every shipped file is valid; the program refuses with exit code 2 what the schema refuses;
both accept other correct spellings; the tables in docs/reference/ are those that the program prints.

    schema_test.py PROGRAM FOLDER_OF_THE_PROJECT
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import jsonschema
import yaml

PROGRAM, TOP = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()


class Loader(yaml.SafeLoader):
    """YAML 1.2, as editors read it: no `yes` for true, no 1:30 for ninety, 1e-3 is a number, a key is a text."""

    yaml_implicit_resolvers = {}

    def construct_mapping(self, node, deep=False):
        return {key.value: self.construct_object(value, deep=True) for key, value in node.value}


Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile(r"^(?:true|false)$"), list("tf"))
Loader.add_implicit_resolver("tag:yaml.org,2002:null", re.compile(r"^(?:~|null|)$"), ["~", "n", ""])
Loader.add_implicit_resolver("tag:yaml.org,2002:int", re.compile(r"^[-+]?(?:0|[1-9][0-9]*)$"), list("-+0123456789"))
Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(r"^[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?$"), list("-+.0123456789")
)
Loader.add_constructor("tag:yaml.org,2002:map", Loader.construct_mapping)
Loader.add_constructor("tag:yaml.org,2002:float", lambda loader, node: float(node.value))


def run(*words):
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True, cwd=TOP)


def validator(what):
    schema = json.loads(run("schema", what).stdout)
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


VALIDATORS = {what: validator(what) for what in ("scenario", "sweep")}


def what_is(data):
    return "sweep" if "vary" in data else "scenario"


def errors(text):
    data = yaml.load(text, Loader)
    return [f"{'/'.join(map(str, e.absolute_path))}: {e.message[:200]}" for e in VALIDATORS[what_is(data)].iter_errors(data)]


SPINDLE, MILL, TABLE = "lumped_spindle", "fp3_spindle", "gantry_table"
# file, its text, the replacement, a part of the program's message
WRONG = [
    # an unknown key
    (SPINDLE, "reference_temperature: 22 degC", "reference_temperature: 22 degC\nreference: 3", "unknown key 'reference'"),
    (SPINDLE, "  output_interval: 30 s", "  output_intervall: 30 s", "unknown key 'output_intervall'"),
    (SPINDLE, "    f0: 0.4  ", "    f_0: 3\n    f0: 0.4  ", "unknown key 'f_0'"),
    (SPINDLE, "{name: t_ambient, node: ambient}", "{name: t_ambient, node: ambient, at: [0 m, 0 m, 0 m]}", "key 'region' is missing"),
    (SPINDLE, "sensitivity: 2.9 um/K", "sensitivity: 2.9 um/K, share: 1", "unknown key 'share'"),
    (MILL, "signal_period: 1 um", "signal_period: 1 um\n  speed: 1 rpm", "unknown key 'speed'"),
    (MILL, "bore: 95 mm", "bore: 95 mm, bores: 95 mm", "unknown key 'bores'"),
    (TABLE, "slew: 0.01", "slew: 0.01, slow: 1", "unknown key 'slow'"),
    ("measured/spindle_22", "generator: lumped", "generator: lumped\n  mesh_size: 3 mm", "unknown key 'mesh_size'"),
    # another kind of unit, or none
    (SPINDLE, "absolute_tolerance: 1e-3 K", "absolute_tolerance: 1e-3 degC", "temperature difference"),
    (SPINDLE, "conductance: 30 W/K", "conductance: 30 W/(m^2 K)", "wrong unit"),
    (SPINDLE, "flow: 6 L/min", "flow: 6 L", "wrong unit"),
    (SPINDLE, "reference_temperature: 22 degC", "reference_temperature: 22 degC\nlimits: {step: 3 K}", "wrong unit"),
    (SPINDLE, "reference_temperature: 22 degC", "reference_temperature: 22 degC\nlimits: {travel: {x: [3 mm]}}", "at least 2"),
    (SPINDLE, "reference_temperature: 22 degC", "reference_temperature: 22 degC\nlimits: {speeds: 3 rpm}", "unknown key 'speeds'"),
    (SPINDLE, "capacity: 19 kJ/K", "capacity: 19", "has no unit"),
    (SPINDLE, "[4 h, 23.5 degC]", "[4 h, 23.5 h]", "wrong unit"),
    (SPINDLE, "warm_up: [[60 min, 12000 rpm]]", "warm_up: [[60 min, 200 Hz]]", "wrong unit"),
    (MILL, "machine_zero: [0 mm, 0 mm, 200 mm]", "machine_zero: [0 mm, 0 mm, 200 s]", "wrong unit"),
    (MILL, "winter: {offset: -8 K", "winter: {offset: -8 degC", "temperature difference"),
    (MILL, "at_speed: 2000 rpm", "at_speed: 2000 1/min", "wrong unit"),
    (TABLE, "probe_noise: 2 um", "probe_noise: 2 urad", "wrong unit"),
    # a compulsory key left out
    (SPINDLE, "    passage_conductance: 150 W/K\n", "", "key 'passage_conductance' is missing"),
    (SPINDLE, "reference_temperature: 22 degC\n", "", "key 'reference_temperature' is missing"),
    (SPINDLE, "{type: link, node: shaft, to: ambient, ", "{type: link, node: shaft, ", "key 'to' is missing"),
    (MILL, "  judge: chaotic\n", "", "key 'judge' is missing"),
    (MILL, "feed: 600 mm/min, every: 20 s", "feed: 600 mm/min", "key 'every' is missing"),
    (TABLE, "  judge_until: 24 h  ", "  # ", "key 'judge_until' is missing"),
    (TABLE, "{name: low, at: [-4.8 m, 0 m, 0 m]}", "{name: low}", "key 'at' is missing"),
    # an unknown word, a number out of range, too few or too many entries
    (SPINDLE, "runs: always", "runs: often", "'often' is not known here"),
    (SPINDLE, "type: motor_loss, node: shaft", "type: motor_los, node: shaft", "'motor_los' is not known here"),
    (SPINDLE, "name: t_stator", "name: t/stator", "is no name"),
    (MILL, "sensors_to_choose: 4", "sensors_to_choose: 0", "must be a whole number"),
    (MILL, "counts: x1 ", "counts: x3 ", "'x3' is not known here"),
    (MILL, "dialect: linuxcnc", "dialect: fanuc", "'fanuc' is not known here"),
    (MILL, "train: [continuous_1000, continuous_1600, continuous_2000]", "train: [continuous_1000]", "at least 2 are required"),
    # keys that do not go together
    (SPINDLE, "{type: link, node: stator, to: shaft", "{type: link, node: stator, region: a, to: shaft", "requires exactly one place"),
    (MILL, "signal_period: 1 um", "signal_period: 1 um\n  pitch: 2 mm\n  lines: 2000", "`signal_period` and `pitch`"),
    (MILL, "signal_period: 1 um", "pitch: 2 mm", "key 'lines' is missing"),
    (TABLE, "scale_y: {sensor: beam,", "scale_y: {", "one of `sensor` and `sensors`"),
    (MILL, "fixed: [x, y, z]", "", "how is this surface held?"),
    # a list for a map, a map for a list
    (SPINDLE, "solver:\n", "solver: []\nsolver_: \n", ""),
    (SPINDLE, "warm_up: [[60 min, 12000 rpm]]", "warm_up: {row: [[60 min, 12000 rpm]]}", "one of the keys rows, csv, nc_program"),
    # studies
    ("lumped_sweep", "samples: 48", "samples: 48\nsample: 3", "unknown key 'sample'"),
    ("lumped_sweep", "samples: 48\n", "", "key 'samples' is missing"),
    ("lumped_sweep", "design: latin_hypercube", "design: grid", "a distribution requires"),
    ("lumped_sweep", "uniform: [210 N, 390 N]", "uniform: [210 N, 390 N]\n    from: 3 N", "one of values, from"),
]
RIGHT = [
    (SPINDLE, "output_interval: 30 s", "output_interval: 0.5 minute"),
    (SPINDLE, "flow: 6 L/min", "flow: 1e-4 m3 s-1"),
    (SPINDLE, "conductance: 30 W/K", "conductance: 30 J s-1 K-1"),
    (SPINDLE, "relative_tolerance: 1e-4", "relative_tolerance: 0.01 %"),
    (SPINDLE, "reference_temperature: 22 degC", "reference_temperature: 22 degC\nlimits: {speed: 24000 rpm, travel: {x: [-1 mm, 0.3 m]}, correction: 0.1 mm, step: 5 um}"),
    (SPINDLE, "relative_tolerance: 1e-4", "relative_tolerance: '1e-4'"),
    (SPINDLE, "reference_temperature: 22 degC", "reference_temperature: 295.15 K\nstart: 71.6 degF"),
    (SPINDLE, "  output_interval: 30 s", "  stresses: false\n  output_interval: 30s"),
    (SPINDLE, "conductance: 30 W/K}", "conductance: 30 W/K, known_to: {conductance: guess}, from: 1 h, in: shift}"),
    (SPINDLE, "  warm_up: [[60 min, 12000 rpm]]", "  warm_up: {columns: [duration, heater_W, speed], rows: [[1 h, 3 W, 200 rpm]], repeat: 2}"),
    ("lumped_sweep", "uniform: [210 N, 390 N]", "values: [300 N, 0.4 kN]"),
]


class Schema(unittest.TestCase):
    def edited(self, name, right, wrong):
        text = (TOP / "scenarios" / f"{name}.yaml").read_text()
        self.assertIn(right, text, f"{name}.yaml no longer holds this")
        return text.replace(right, wrong, 1)

    def judged_by_the_program(self, name, text):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            for beside in (TOP / "scenarios" / f"{name}.yaml").parent.iterdir():
                (folder / beside.name).symlink_to(beside)
            (folder / "edited.yaml").write_text(text)
            if name == "lumped_sweep":
                return run("sweep", f"{folder}/edited.yaml", "--shard", "1/48", "-o", f"{folder}/out")
            return run("check", f"{folder}/edited.yaml")

    def test_every_shipped_file_is_valid(self):
        files = sorted((TOP / "scenarios").glob("**/*.yaml"))
        self.assertGreater(len(files), 15)
        for path in files:
            with self.subTest(path.name):
                self.assertEqual(errors(path.read_text()), [])

    def test_what_the_schema_refuses_the_program_refuses(self):
        for name, right, wrong, message in WRONG:
            with self.subTest(f"{name}: {wrong}"):
                text = self.edited(name, right, wrong)
                self.assertNotEqual(errors(text), [], "the schema takes it")
                outcome = self.judged_by_the_program(name, text)
                self.assertEqual(outcome.returncode, 2, outcome.stdout + outcome.stderr)
                self.assertIn(message, outcome.stdout + outcome.stderr)

    def test_what_is_right_both_take(self):
        for name, right, other in RIGHT:
            with self.subTest(f"{name}: {other}"):
                text = self.edited(name, right, other)
                self.assertEqual(errors(text), [])
                outcome = self.judged_by_the_program(name, text)
                self.assertEqual(outcome.returncode, 0, outcome.stdout + outcome.stderr)

    def test_tables_of_the_documentation_are_those_of_the_program(self):
        for page, words in (("scenario.md", "schema scenario"), ("sweep.md", "schema sweep"), ("diagnosis.md", "schema diagnosis"), ("scenario.md", "list ranges")):
            with self.subTest(words):
                text = (TOP / "docs/reference" / page).read_text()
                begin, end = f"<!-- driftwright {words} --markdown -->\n", "<!-- end -->\n"
                self.assertIn(begin, text)
                table = text.split(begin)[1].split(end)[0]
                self.assertEqual(table, run(*words.split(), "--markdown").stdout, f"docs/reference/{page} is stale: tests/app/schema_tables.sh writes it anew")

    def test_the_reference_has_every_key(self):
        """Every key of the scenario's upper two levels, taken from the JSON and not from the tables."""
        text = (TOP / "docs/reference/scenario.md").read_text()
        for block, schema in VALIDATORS["scenario"].schema["then"]["properties"].items():
            self.assertIn(f"`{block}`", text)
            if block == "effects":
                continue
            for key in schema.get("properties", schema.get("items", {}).get("properties", {})):
                self.assertIn(f"`{key}`", text, f"{block}.{key}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
