"""What an entrant of the scoreboard gets and hands in, as CSV. Standard library only.

For each row of the scoreboard an entrant gets a folder `<id>/`:

    row.json    id, record, split, target, unit, inputs, drive, ambient, from_start; the runs of fit and judge in their order
    fit/*.csv   runs: time_s, drive and inputs, target; the target is empty where it is missing or kept out. With `from_start` it counts from the run's first reading
    judge/*.csv runs: time_s, drive and inputs, and `judged`: 1 in rows that are judged. No target

and hands in one file `<id>.csv`: columns run (a file name of judge/), time_s, predicted (in the target's unit, as in fit/) and, if the method has an
interval, half_width (of its 95 % interval). Exactly the judged rows are expected, in any order. Of a single long record both files contain all its rows.
"""

import csv
import json
import math
import os

import records


class EntryError(Exception):
    """A prediction that cannot be scored: file, line, what is wrong, what is allowed."""


def counted(case, table):
    """The target as it is judged: from the first reading of the run if the case says so."""
    y = table.columns[case.target]
    first = next((v for v in y if v is not None), 0.0) if case.from_start else 0.0
    return [None if v is None else v - first for v in y]


def judged(case):
    """{(run, time in ms): target} of all judged rows."""
    return {(table.name, round(1000.0 * t)): y for table in case.judge for t, y in zip(table.time_s, counted(case, table))
            if y is not None and case.is_judged(t)}


def write_table(path, table, names, extra_name, extra):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as out:
        rows = csv.writer(out, lineterminator="\n")
        rows.writerow(["time_s", *names, extra_name])
        for i, t in enumerate(table.time_s):
            rows.writerow(["" if v is None else repr(v) for v in (t, *(table.columns[n][i] for n in names), extra[i])])


def write_inputs(case, folder):
    """Writes the folder of a case, its id, into `folder`, and returns its path."""
    own = os.path.join(folder, case.id)
    names = ([case.drive] if case.drive else []) + [n for n in case.thermometers if n != case.drive]
    names += [case.ambient] if case.ambient and case.ambient not in names else []
    for table in case.fit:
        y = [v if case.is_fitted(t) else None for t, v in zip(table.time_s, counted(case, table))]
        write_table(os.path.join(own, "fit", table.name), table, names, case.target, y)
    counts = judged(case)
    for table in case.judge:
        write_table(os.path.join(own, "judge", table.name), table, names, "judged", [int((table.name, round(1000.0 * t)) in counts) for t in table.time_s])
    with open(os.path.join(own, "row.json"), "w", encoding="utf-8") as out:
        json.dump({"id": case.id, "record": case.record, "split": case.split, "target": case.target, "unit": case.unit, "inputs": case.thermometers,
                   "drive": case.drive, "ambient": case.ambient, "from_start": case.from_start,
                   "fit": [t.name for t in case.fit], "judge": [t.name for t in case.judge]}, out, indent=1)
    return own


def read_inputs(own):
    """The folder of a row as a Case, as an entrant sees it: no target in judge."""
    with open(os.path.join(own, "row.json"), encoding="utf-8") as file:
        row = json.load(file)
    fit, judge = ([records.read(os.path.join(own, part, n)) for n in row[part]] for part in ("fit", "judge"))
    return records.Case(row["record"], row["split"], row["target"], fit, judge, row["inputs"], row["drive"], row["ambient"], row["from_start"], id=row["id"])


def write_prediction(path, case, predicted, half_width=None):
    """Writes the judged rows of one prediction a row of each judged run; case is that of read_inputs()."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as out:
        rows = csv.writer(out, lineterminator="\n")
        rows.writerow(["run", "time_s", "predicted"] + (["half_width"] if half_width else []))
        for k, (table, values) in enumerate(zip(case.judge, predicted)):
            for i, (t, v) in enumerate(zip(table.time_s, values)):
                if table.columns["judged"][i]:
                    rows.writerow([table.name, repr(t), repr(v)] + ([repr(half_width[k][i])] if half_width else []))


def read_prediction(path, case):
    """{(run, time in ms): (predicted, half width or None)} of exactly the judged rows of a case; EntryError else."""
    wanted, found, lines = judged(case), {}, {}
    if not os.path.exists(path):
        raise EntryError(f"{path}: this file is missing; each row of the scoreboard requires a prediction")
    with open(path, newline="", encoding="utf-8-sig") as file:
        rows = csv.reader(file)
        header = next(rows, [])
        allowed = ["run", "time_s", "predicted", "half_width"]
        if header not in (allowed, allowed[:3]):
            raise EntryError(f"{path}:1: the header is '{','.join(header)}'; it must be run,time_s,predicted or run,time_s,predicted,half_width")
        for cells in rows:
            where = f"{path}:{rows.line_num}"
            if len(cells) != len(header):
                raise EntryError(f"{where}: {len(cells)} cells; the header has {len(header)}")
            numbers = []
            for name, cell in zip(header[1:], cells[1:]):
                try:
                    numbers.append(float(cell))
                except ValueError:
                    numbers.append(math.nan)
                if not math.isfinite(numbers[-1]):
                    raise EntryError(f"{where}: {name} is '{cell}'; it must be a finite number")
            key = (cells[0], round(1000.0 * numbers[0]))
            if key not in wanted:
                runs = sorted({run for run, _ in wanted})
                known = f"run {cells[0]} has no judged row at time_s {cells[1]}" if cells[0] in runs else f"there is no run '{cells[0]}'; the runs are {', '.join(runs)}"
                raise EntryError(f"{where}: {known}")
            if key in found:
                raise EntryError(f"{where}: run {cells[0]} at time_s {cells[1]} is predicted twice, first in line {lines[key]}")
            if len(numbers) == 3 and numbers[2] < 0.0:
                raise EntryError(f"{where}: half_width is {cells[3]}; it must not be negative")
            found[key], lines[key] = (numbers[1], numbers[2] if len(numbers) == 3 else None), rows.line_num
    lacking = [key for key in wanted if key not in found]
    if lacking:
        raise EntryError(f"{path}: {len(lacking)} of {len(wanted)} judged rows have no prediction, the first at time_s {lacking[0][1] / 1000.0:g} of run {lacking[0][0]}")
    return found


def scored(path, case):
    """RMS of target minus prediction over the judged rows [unit of the target], and the percentage of them that the 95 % interval contains; None without one."""
    wanted, found = judged(case), read_prediction(path, case)
    rms = math.sqrt(sum((y - found[key][0]) ** 2 for key, y in wanted.items()) / len(wanted))
    if any(half is None for _, half in found.values()):
        return rms, None
    return rms, 100.0 * sum(abs(y - found[key][0]) <= found[key][1] for key, y in wanted.items()) / len(wanted)


def no_correction(case):
    """RMS of the target itself."""
    y = judged(case).values()
    return math.sqrt(sum(v * v for v in y) / len(y))
