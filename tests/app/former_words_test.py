#!/usr/bin/env python3
"""Scenarios with the key of an earlier release (`hall` for the ambient) give the same records, byte for byte, and a note for each line that says what to write. Both keys at once,
and a lumped node called `ambient`, end with exit code 2.

    former_words_test.py PROGRAM FOLDER_OF_THE_PROJECT [SCENARIO ...]

Without names it runs the lumped scenarios, which take seconds; former_words_test.cpp checks that all others are read alike.
"""
import pathlib
import re
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "shared"))
from claims import caller, expect, failures

LUMPED = ["first_machine", "lumped_spindle", "measured/lathe", "measured/heated_plate"]


def in_former_words(text):
    text = re.sub(r"^ambient:", "hall:", text, flags=re.M)
    return re.sub(r"\b(to|node|start|surrounding|body|follows): ambient\b", r"\1: hall", text)


def records(folder):
    found = {p.relative_to(folder): p.read_bytes() for p in folder.rglob("*.csv") if p.name == "record.csv" or p.parent.name == "records"}
    return {name: b"\n".join(line for line in text.split(b"\n") if not line.startswith(b"#")) for name, text in found.items()}


def main():
    program, top = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory(prefix="driftwright_former_words-") as name:
        folder = pathlib.Path(name)
        call = caller(program, folder)
        (folder / "scenarios").mkdir()
        for entry in (top / "scenarios").iterdir():  # files that a scenario names must be in the same folder
            (folder / "scenarios" / entry.name).symlink_to(entry)
        for scenario in sys.argv[3:] or LUMPED:
            now = top / f"scenarios/{scenario}.yaml"
            text = in_former_words(now.read_text())
            then = folder / (f"scenarios/former_{scenario}.yaml" if "/" not in scenario else f"{pathlib.Path(scenario).name}.yaml")
            then.write_text(text)
            done = call("simulate", now, "-o", "now", "--force", "--quiet")
            expect(done.returncode == 0 and "is now called" not in done.stderr, f"{scenario}: {done.stderr or 'no note about present words'}")
            done = call("simulate", then, "-o", "then", "--force", "--quiet")
            lines = [number for number, line in enumerate(text.splitlines(), 1) if re.search(r"^hall:|: hall\b", line.split("#")[0])]
            told = [int(n) for n in re.findall(r"note: \S+:(\d+): `hall` is now called `ambient`; write `", done.stderr)]
            expect(done.returncode == 0 and sorted(told) == lines and lines, f"{scenario}: a note for each of the lines {lines}: {told}")
            a, b = records(folder / "now"), records(folder / "then")
            expect(a and a == b, f"{scenario}: {len(a)} records of {sum(map(len, a.values()))} bytes are the same")

        text = (top / "scenarios/first_machine.yaml").read_text()
        (folder / "both.yaml").write_text(text + "\nhall: 20 degC\n")
        done = call("check", "both.yaml")
        expect(done.returncode == 2 and "`hall` is the former name of `ambient`" in done.stderr, f"both keys: {done.stderr.strip()}")
        (folder / "node.yaml").write_text(text.replace("effects:\n", "effects:\n  - {type: node, node: ambient, capacity: 1 kJ/K}\n", 1))
        done = call("check", "node.yaml")
        expect(done.returncode == 2 and "air around every machine and no lumped node" in done.stderr, f"a node of that name: {done.stderr.strip()}")
    return 1 if failures else 0


sys.exit(main())
