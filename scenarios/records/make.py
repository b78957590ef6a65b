#!/usr/bin/env python3
"""Makes the records of this folder anew: make.py PROGRAM   (from the folder of the project; the same bytes each time)"""
import datetime, pathlib, random, subprocess, sys, tempfile

HERE = pathlib.Path(__file__).resolve().parent
SCENARIO = HERE.parent / "fp3_spindle.yaml"
NOISE = {"degC": 0.1, "um": 0.5, "urad": 0.3}  # standard deviations of readings
DAYS = {  # minutes, rpm
    "morning": [(40, 800), (50, 2000), (30, 1200), (60, 1600)],
    "monday": [(90, 1600), (60, 0), (90, 1000), (60, 2000)],
    "tuesday": [(60, 2000), (30, 600), (60, 1400), (120, 0)],
    "good": [(120, 1800), (90, 0), (60, 1200)],
}
OWN_LAW = HERE.parent / "own_law.yaml"
SHIFT = [(120, 6000), (30, 0), (90, 3000)]  # its cyclogram
PRELOAD = "k: {} 1/K"
FIRST = HERE.parent / "first_machine.yaml"
LINK = "  - {type: link, node: housing, to: ambient, conductance: 5 W/K}\n"
FALLEN = "  - {type: sensor_detached, sensor: t_housing, share: 0.8, time: 95 min}\n"
FILM = "surface: headstock_outer, film: {} W/(m^2 K)"


def plan_of(sections):
    """A cyclogram as a record: a row each minute, whose speed holds until the next."""
    speeds = [rpm for minutes, rpm in sections for _ in range(minutes)]
    speeds.append(speeds[-1])
    return "time_s,speed_rpm\n" + "".join(f"{60 * minute},{rpm}\n" for minute, rpm in enumerate(speeds))


def simulated(program, scenario, sections, work):
    plan = work / "plan.csv"
    plan.write_text(plan_of(sections))
    subprocess.run([program, "simulate", scenario, "--cyclogram", plan, "-o", work / "out", "--force", "--quiet"], check=True)
    return [line for line in (work / "out/record.csv").read_text().splitlines() if not line.startswith("#")]


def measured(rows, seed):
    """Every second row, with noise; speeds change at even minutes."""
    noise = random.Random(seed)
    head = rows[0].split(",")
    sd = [NOISE.get(name.rsplit("_", 1)[-1], 0.0) if name not in ("t_ambient_degC", "ambient_degC") else 0.0 for name in head]
    out = [rows[0]]
    for row in rows[1::2]:
        out.append(",".join(f"{float(v) + noise.gauss(0, s):.2f}" if s else v for v, s in zip(row.split(","), sd)))
    return out


def as_a_logger(rows):
    """A record as a logger in Germany might have written it: stamps, semicolons, decimal commas, Latin-1, other names, mm."""
    columns = [name.split(",") for name in rows]
    head, start = columns[0], datetime.datetime(2024, 3, 9, 7, 0)
    names = {"speed_rpm": "Spindel [U/min]", "t_ambient_degC": "Halle (°C)", "drift_y_um": "Drift Y (mm)"}
    names |= {f"t{i:02}_degC": f"T{i:02} (°C)" for i in range(1, 13)}
    taken = [i for i, name in enumerate(head) if name in names]
    lines = ["Messprotokoll;Fräsmaschine", "", "Zeitstempel;" + ";".join(names[head[i]] for i in taken)]
    for row in columns[1:]:
        at = start + datetime.timedelta(seconds=float(row[0]))
        cells = [f"{float(row[i]) / 1000:.4f}" if head[i].endswith("_um") else f"{float(row[i]):.1f}" for i in taken]
        lines.append(at.strftime("%d.%m.%Y %H:%M:%S;") + ";".join(cell.replace(".", ",") for cell in cells))
    return "\r\n".join(lines) + "\r\n"


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        text = SCENARIO.read_text()
        assert text.count(FILM.format(9)) == 1, "the scenario's film has changed"
        other = work / "other.yaml"
        other.write_text(text.replace(FILM.format(9), FILM.format(16)))
        (HERE / "plan.csv").write_text("# a shift to predict: rows of speed (docs/how-to/cyclograms.md)\n" + plan_of([(60, 1200), (20, 0), (100, 1800), (60, 600)]))
        for seed, (name, sections) in enumerate(DAYS.items()):
            rows = simulated(program, other if name in ("monday", "tuesday") else SCENARIO, sections, work)
            if name != "morning":
                rows = measured(rows, seed)
            if name == "tuesday":
                (HERE / "logger_file.csv").write_text(as_a_logger(rows), encoding="latin-1", newline="")
            (HERE / f"{name}.csv").write_text(f"# made by scenarios/records/make.py, not measured on a machine\n" + "\n".join(rows) + "\n")
        text = OWN_LAW.read_text()
        assert text.count(PRELOAD.format(0.01)) == 1, "the scenario's law has changed"
        other.write_text(text.replace(PRELOAD.format(0.01), PRELOAD.format(0.04)))
        rows = measured(simulated(program, other, SHIFT, work), len(DAYS))
        (HERE / "own_law.csv").write_text("# made by scenarios/records/make.py, not measured on a machine\n" + "\n".join(rows) + "\n")
        text = FIRST.read_text()
        assert text.count(LINK) == 1, "the link of the first machine has changed"
        other.write_text(text.replace(LINK, LINK + FALLEN))
        rows = measured(simulated(program, other, SHIFT, work), 11)
        (HERE / "fallen.csv").write_text("# made by scenarios/records/make.py, not measured on a machine\n" + "\n".join(rows) + "\n")
        rows = [f"{int(i % 4 in (1, 2))} {int(i % 4 in (2, 3))}" for i in range(1000)]
        (HERE / "encoder_rows.txt").write_text("\n".join(rows) + "\n")
        (HERE / "drift.csv").write_text("time_s,drift_um\n0,0\n0.5,6\n1,12\n")


if __name__ == "__main__":
    main()
