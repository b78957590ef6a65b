"""The measured records of the scoreboard as tables, split as splits.toml says. Temperatures that are targets are in K or degC, displacements in um. Standard library only."""

import csv
import dataclasses
import functools
import os
import re
import tomllib

SPLITS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "splits.toml")
RECORD_KEYS = {"file", "target", "inputs", "drive", "ambient", "every", "from_start", "target_within", "sensors_to_choose", "scenario", "conversion"}
ROW_KEYS = RECORD_KEYS | {"id", "record", "split", "targets", "fit", "judge"}


@dataclasses.dataclass
class Table:
    """One run: `time_s` and the columns by name, a list of floats each; None where a cell is empty."""
    name: str
    time_s: list
    columns: dict

    def rows(self, keep):
        return Table(self.name, [t for t, k in zip(self.time_s, keep) if k],
                     {n: [v for v, k in zip(c, keep) if k] for n, c in self.columns.items()})


def read(path, every=1):
    with open(path, encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))[::every]
    names = [n for n in rows[0] if n != "time_s"]
    return Table(os.path.basename(path), [float(r["time_s"]) for r in rows],
                 {n: [float(r[n]) if r[n] else None for r in rows] for n in names})


@dataclasses.dataclass
class Case:
    """A row of the scoreboard: a record, what is predicted of it from what, and one way to keep data out.

    fit, judge: runs whose target is fitted to and judged by. Of a single long record both are the whole record: `fit_rows` and `judge_rows` then say
    which of its rows count, and rows before the judged ones are known to every predictor but for the target.
    """
    record: str
    split: str
    target: str
    fit: list
    judge: list
    thermometers: list
    drive: str = ""            # column of what drives the machine: speed, voltage, heater
    ambient: str = ""          # column of the surroundings' temperature
    from_start: bool = False   # temperatures and target count from the first row of a run
    fit_rows: object = None    # function of time [s]
    judge_rows: object = None
    sensors_to_choose: int = 4
    scenario: str = ""         # of scenarios/measured, for the diagnosed model
    conversion: str = ""       # of bench/measured/to_record.py, for that scenario
    fit_files: list = dataclasses.field(default_factory=list)
    judge_files: list = dataclasses.field(default_factory=list)
    id: str = ""

    @property
    def unit(self):
        return "um" if self.target.endswith("_um") else "K"

    def is_fitted(self, t_s):
        return self.fit_rows is None or self.fit_rows(t_s)

    def is_judged(self, t_s):
        return self.judge_rows is None or self.judge_rows(t_s)


def base(name):
    """Name of a column without its unit."""
    return re.sub(r"_(degC|K|um|V|W|rpm|W_m2)$", "", name)


def between(from_h, until_h):
    return lambda t_s: 3600.0 * from_h <= t_s < 3600.0 * until_h


def splits(set_name, path=SPLITS):
    """The rows of a set, one for each target, with all keys of their records; ValueError with file, row and key if the file is wrong."""
    with open(path, "rb") as file:
        whole = tomllib.load(file)
    if set_name not in whole["set"]:
        raise ValueError(f"{path}: there is no set '{set_name}'; the sets are {', '.join(whole['set'])}")
    rows = []
    for row in whole["set"][set_name]["rows"]:
        where = f"{path}: row '{row.get('id', '?')}' of set '{set_name}'"
        if row.get("record") not in whole["record"]:
            raise ValueError(f"{where}: there is no record '{row.get('record')}'; the records are {', '.join(whole['record'])}")
        record = whole["record"][row["record"]]
        unknown = (row.keys() - ROW_KEYS) | (record.keys() - RECORD_KEYS)
        if unknown:
            raise ValueError(f"{where}: key '{min(unknown)}' is unknown; allowed are {', '.join(sorted(ROW_KEYS))}")
        merged = {**record, **row}
        for target in merged.pop("targets", [merged.get("target")]):
            missing = [k for k in ("id", "split", "inputs", "fit", "judge") if k not in merged] + ([] if target else ["target"])
            if missing:
                raise ValueError(f"{where}: key '{missing[0]}' is missing")
            rows.append({**merged, "target": target, "id": f"{row['id']}_{base(target)}"})
    ids = [r["id"] for r in rows]
    for i in ids:
        if ids.count(i) > 1:
            raise ValueError(f"{path}: set '{set_name}' has two rows with the id '{i}'")
    return rows


def cases(data, set_name="older", begins=(), path=SPLITS):
    """The rows of a set with their tables, read from the folder of records; only records whose name begins with one of `begins`, if there are any."""
    result, table = [], functools.cache(read)
    for row in splits(set_name, path):
        if begins and not row["record"].startswith(tuple(begins)):
            continue
        parts, hours = {}, {}
        for part in ("fit", "judge"):
            whole = all(isinstance(p, str) for p in row[part])
            files = [os.path.join(data, row["file"].replace("{}", p)) for p in row[part]] if whole else [os.path.join(data, row["file"])]
            for f in files:
                if not os.path.exists(f):
                    raise ValueError(f"{f}: row '{row['id']}' requires this file; bench/real/fetch.py says where it comes from")
            tables = [table(f, row.get("every", 1)) for f in files]
            if "target_within" in row:
                low, high = row["target_within"]
                tables = [t.rows([v is not None and low < v < high for v in t.columns[row["target"]]]) for t in tables]
            parts[part], parts[part + "_files"] = tables, files
            hours[part + "_rows"] = None if whole else between(*row[part])
        given = {k: row[k] for k in ("record", "split", "target", "drive", "ambient", "from_start", "sensors_to_choose", "scenario", "conversion", "id") if k in row}
        result.append(Case(thermometers=row["inputs"], **given, **parts, **hours))
    return result
