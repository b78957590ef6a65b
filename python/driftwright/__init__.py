"""Driftwright: a digital twin of a machine tool's thermal behaviour.

Records are pandas tables: the index is the time in seconds (`time_s`), a column is a channel with its unit in its name, as in a record CSV
(`speed_rpm`, `t01_degC`, `drift_y_um`).

    import driftwright as dw
    machine = dw.Machine("scenarios/fp3_spindle.yaml")
    drift = machine.predict("chaotic")          # ahead of the run, by the reduced model
    drift.plot(y="drift_y_um")
"""

import pathlib

try:
    import numpy as np
    import pandas as pd
except ModuleNotFoundError as missing:
    raise ImportError(f"driftwright takes {missing.name}, which is not installed: apt-get install python3-numpy python3-pandas, "
                      "or pip install numpy pandas") from missing

try:
    from . import core
except ImportError as missing:
    raise ImportError(
        f"driftwright is not built for this Python ({missing}). In the project's folder:\n"
        "  apt-get install $(grep -v '#' packages-python.txt)\n"
        "  cmake --preset release -DDRIFTWRIGHT_PYTHON=ON\n"
        "  cmake --build --preset release --target driftwright_python_package\n"
        "  PYTHONPATH=build/release/python python3") from missing
from .core import InputError, SolveError, __version__

__all__ = ["Machine", "Run", "InputError", "SolveError", "read_record", "write_record", "judge", "command", "__version__"]


def _table(record):
    source, time_s, columns = record.columns
    table = pd.DataFrame({f"{name}_{unit}": values for name, unit, values in columns}, index=pd.Index(time_s, name="time_s"))
    table.attrs["source"] = source
    return table


# Longest first, so that mm_min is found before min; as in docs/reference/record.md.
_UNITS = sorted(["rpm", "mm_min", "degC", "K", "um", "mm", "urad", "deg", "W", "W_m2", "V", "percent", "count", "1", "s", "min",
                 "h"],
                key=len, reverse=True)


def _record(table, source=None):
    columns = []
    for header in table.columns:
        unit = next((u for u in _UNITS if str(header).endswith("_" + u)), None)
        if unit is None:
            raise InputError(f"column '{header}' names no unit; it must be called '<channel>_<unit>' with one of {', '.join(_UNITS)}")
        columns.append((header[:-len(unit) - 1], unit, np.asarray(table[header], dtype=float).tolist()))
    if table.index.name not in (None, "time_s"):
        raise InputError(f"the index is '{table.index.name}'; time_s is required")
    return core.Record(source or table.attrs.get("source") or "record", np.asarray(table.index, dtype=float).tolist(), columns)


def read_record(path):
    """A record CSV as a table."""
    return _table(core.read_record(str(path)))


def write_record(table, path, comments=()):
    """Writes a table as a record CSV, with seven significant digits as the program does."""
    pathlib.Path(path).write_text(core.record_csv(_record(table), list(comments)), encoding="utf-8")


class Run:
    """A machine on its way through a run that is not known ahead."""

    def __init__(self, run):
        self._run = run
        self.columns = run.headers

    def step(self, time_s, speed_rpm=0.0, ambient_degC=None, feed_m_s=(0.0, 0.0, 0.0), cutting_power_W=0.0):
        """Goes on to `time_s` [s]; speed, feeds and power hold from the row before. Returns the readings as a Series."""
        values = self._run.step(time_s, speed_rpm, ambient_degC, list(feed_m_s), cutting_power_W)
        return pd.Series(values, index=self.columns, name=time_s)


class Machine:
    """The machine of a scenario. Raises InputError for a scenario that cannot be read; `progress` is called with what is being done."""

    def __init__(self, scenario, progress=None):
        self._machine = core.Machine(str(scenario), progress)
        for name in ("name", "scenario_file", "cyclograms", "sensors", "displacements", "tilts"):
            setattr(self, name, getattr(self._machine, name))

    def __repr__(self):
        return f"Machine({self.scenario_file!r}): {', '.join(self.displacements + self.tilts)}"

    def cyclogram(self, what):
        """A cyclogram of the scenario by name or from a record CSV, from a table, or from rows (duration_s, speed_rpm)."""
        if isinstance(what, core.Cyclogram):
            return what
        if isinstance(what, pd.DataFrame):
            return self._machine.cyclogram_of(_record(what))
        if isinstance(what, (str, pathlib.Path)):
            return self._machine.cyclogram(str(what))
        rows = list(what)
        return core.cyclogram_of_speeds("rows", [float(r[0]) for r in rows], [float(r[1]) for r in rows])

    def predict(self, cyclogram, start="", after_pause="", model=""):
        """The drift before a run, as `driftwright predict` computes it."""
        return _table(self._machine.predict(self.cyclogram(cyclogram), core.PredictOptions(str(start), after_pause, model)))

    def predict_all(self, cyclograms, start="", after_pause="", model=""):
        """The same of several cyclograms, side by side on all cores."""
        asked = [self.cyclogram(c) for c in cyclograms]
        return [_table(r) for r in self._machine.predict_all(asked, core.PredictOptions(str(start), after_pause, model))]

    def simulate(self, cyclogram):
        """A run by the model that the scenario asks for, as `driftwright simulate` does it."""
        return _table(self._machine.simulate(self.cyclogram(cyclogram)))

    def fields(self, cyclogram, times_s=()):
        """Fields of all nodes, each with `time_s`, `temperature_degC` (n) and `displacement_um` (n x 3)."""
        return self._machine.fields(self.cyclogram(cyclogram), list(times_s))

    def mesh(self):
        """The mesh: `points_m` (n x 3), cells as VTK has them (`node`, `offset`, `vtk_type`), `region`, `region_name`."""
        return self._machine.mesh()

    def meshio(self, field=None):
        """The mesh, with a field where one is given, as a meshio.Mesh."""
        import meshio

        mesh = self.mesh()
        kinds, blocks, regions = meshio.vtk_to_meshio_type if hasattr(meshio, "vtk_to_meshio_type") else None, [], []
        if kinds is None:
            from meshio._vtk_common import vtk_to_meshio_type as kinds
        sizes = np.diff(mesh.offset)
        for vtk_type in np.unique(mesh.vtk_type):
            cells = np.flatnonzero(mesh.vtk_type == vtk_type)
            nodes = mesh.node[mesh.offset[cells][:, None] + np.arange(sizes[cells[0]])]
            blocks.append((kinds[int(vtk_type)], nodes))
            regions.append(mesh.region[cells])
        points = {} if field is None else {"temperature_degC": field.temperature_degC, "displacement_um": field.displacement_um}
        return meshio.Mesh(mesh.points_m, blocks, point_data=points, cell_data={"region": regions})

    def start(self, ambient_degC=None, name="run"):
        """A run row by row, from the scenario's start at time 0."""
        return Run(self._machine.start(ambient_degC, name))

    def _records(self, measured):
        if isinstance(measured, (pd.DataFrame, str, pathlib.Path)):
            measured = [measured]
        tables = [m if isinstance(m, pd.DataFrame) else read_record(m) for m in measured]
        return [_record(t, t.attrs.get("source") or f"record_{i + 1}") for i, t in enumerate(tables)]

    def diagnose(self, measured, without=(), causes_only=False, as_recorded=False):
        """What records say about the machine, as `driftwright diagnose`: verdict, causes, gain, the extended scenario.

        Records with a blunder (a speed in 1/s, a sign, exchanged channels ...) are refused unless `as_recorded`."""
        return self._machine.diagnose(self._records(measured), list(without), causes_only, as_recorded)

    def calibrate(self, measured, as_recorded=False):
        """The scenario's uncertain numbers, fitted to records; `as_recorded` as in diagnose()."""
        return self._machine.calibrate(self._records(measured), as_recorded)


def judge(scenario, train, test):
    """Strategies judged on records that they were not fitted on: one row a case."""
    rows = []
    for s in core.judge(str(scenario), [str(p) for p in train], [str(p) for p in test]):
        for c in s.cases:
            rows.append({"strategy": s.name, "verdict": s.verdict, "is_baseline": s.is_baseline, "record": c.record, "failed": c.failed,
                         "rms_before_um": c.rms_before_um, "peak_before_um": c.peak_before_um,
                         "rms_left_um": c.rms_left_um, "peak_left_um": c.peak_left_um})
    return pd.DataFrame(rows)


def command(*arguments):
    """Does what `driftwright ARGUMENTS` does, and returns its exit code: command("diagnose", "m.yaml", "--measured", "monday.csv")."""
    return core.command([str(a) for a in arguments])


def main():
    """The command `driftwright` of the wheel. Ctrl-C is the command's own, as in the program."""
    import signal
    import sys

    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(command(*sys.argv[1:]))
