"""Results of a run, read from its folder."""

import json
import tomllib
import warnings
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path

import numpy as np

from . import case_text, tables
from .curves import Curve, read_curve
from .errors import DataError, RunWarning
from .fields import Frame, list_frames, nearest_frames
from .input_file import read_text
from .netcdf import EPOCH, write_netcdf
from .paraview import write_paraview
from .program import call
from .view import View
from .vtkhdf import write_vtkhdf

__all__ = ["Probes", "Run"]


PROFILES = ("profile", "velocity-profile")  # types of probes with a line of the table for each place


class Probes(Mapping):
    """The tables of a run's probes by name, each read on first access: a pandas.DataFrame over `time_s`, with the unit
    of each column in `attrs["units"]`."""

    def __init__(self, run: "Run"):
        self._run = run
        self._names = [probe["name"] for probe in run.case.get("probe", [])]
        self._tables = {}

    def __getitem__(self, name: str):
        if name not in self._names:
            raise KeyError(f"{name}; the case has {', '.join(self._names) or 'no probes'}")
        if name not in self._tables:
            self._tables[name] = tables.frame(self._run.path / "probes" / f"{name}.csv")
        return self._tables[name]

    def __iter__(self):
        return iter(self._names)

    def __len__(self):
        return len(self._names)

    def __repr__(self):
        return f"probes {', '.join(self._names) or 'none'}"


class Run:
    """The folder of a run that is running or has ended. Throws DataError if it is not the folder of a run.

    `path` is the folder; `case` is the effective case with all values, as tomllib reads it."""

    def __init__(self, path):
        self.path = Path(path)
        effective = self.path / "case.effective.toml"
        try:
            self.case = tomllib.loads(read_text(effective))
        except tomllib.TOMLDecodeError as error:
            raise DataError(f"{effective}: {error}") from error
        except DataError as error:
            raise DataError(f"{self.path}: is not the folder of a run: {error}") from error
        require_tables(effective, self.case)

    @property
    def summary(self) -> dict:
        """summary.json of a run that has ended; empty if the run is still running or was killed."""
        path = self.path / "summary.json"
        try:
            if not path.exists():
                return {}
            summary = json.loads(read_text(path))
            return {} if summary.get("status") == "running" else summary
        except (AttributeError, RecursionError, ValueError) as error:
            raise DataError(f"{path}: is not the summary of a run ({error})") from error

    @property
    def status(self) -> str:
        """"done", "interrupted" or "failed"; "running" if the run is still running or was killed."""
        return self.summary.get("status", "running")

    def resume(self, changes=(), *, ranks=None, progress: bool = False) -> "Run":
        """Resumes from the newest checkpoint, by default with as many ranks as before. `changes` may set keys that
        change no result, as in {"time.end": 20}. Returns the run as it is then. Throws as `Case.run` does."""
        words = [word for key, value in dict(changes).items() for word in ("--set", f"{key}={case_text.toml_value(value)}")]
        call("resume", self.path, *words, *(["-n", ranks] if ranks else []), *([] if progress else ["--quiet"]),
             progress=progress)
        run = Run(self.path)
        if not progress:
            warn_of(run)
        return run

    @property
    def results(self) -> dict:
        """The results of the probes by the probe's name (docs/theory/probes.md); empty until the run has ended."""
        return self.summary.get("results", {})

    def waves(self, gauges=(), **options) -> dict:
        """Heights, harmonics, reflection, responses and overtopping from depth probes (docs/theory/waves.md), as `tailwater
        waves` writes them to waves.json. `options`: `start` and `end` (s) of the window, `depth` (m), `period` (s) of regular
        waves, `responses` (names of motion and force probes), `overtopping` (names of discharge probes). Throws DataError."""
        from .waves import analyse

        return analyse(self, gauges, **options)[0]

    @property
    def measurements(self):
        """The differences between probes and laboratory data, one line for each [[measurement]] of the case. A
        pandas.DataFrame over probe and column: `rms`, `bias` (computed less measured), `best_shift_s` (delay of the
        computed curve, within the limits of the case), `shifted_rms`, `scatter`, `is_inside`. `unit` is their unit
        (docs/theory/probes.md)."""
        import pandas

        rows = [{**{name: score.get(name) for name in ("probe", "column", "unit", "samples", "rms", "bias",
                                                       "best_shift_s")},
                 "shifted_rms": score.get("shifted", {}).get("rms"), "scatter": score.get("scatter"),
                 "is_inside": score.get("is_inside"), "words": score["words"]}
                for score in self.summary.get("measurements", [])]
        names = ["probe", "column", "unit", "samples", "rms", "bias", "best_shift_s", "shifted_rms", "scatter",
                 "is_inside", "words"]
        return pandas.DataFrame(rows, columns=names).set_index(["probe", "column"])

    @cached_property
    def probes(self) -> Probes:
        """The tables of the probes by name."""
        return Probes(self)

    @property
    def steps(self):
        """steps.csv as a pandas.DataFrame over `time_s`."""
        return tables.frame(self.path / "steps.csv")

    def curve(self, probe: str, column: str) -> Curve:
        """A column of a probe over time, as in `curve("gauge", "highest_m")`; needs no pandas. Throws DataError, also for a
        column of a profile that has several values at one time."""
        file = self.path / "probes" / f"{probe}.csv"
        if not file.exists():
            there = ", ".join(sorted(other.stem for other in file.parent.glob("*.csv")))
            raise DataError(f"{file}: there is no such probe; there are: {there or 'none'}")
        found = read_curve(file, column)
        kind = next((one["type"] for one in self.case.get("probe", []) if one["name"] == probe), "")
        if kind in PROFILES and has_several_values(file, column):
            raise DataError(f"{file}: {column} has a value for each place of the {kind}, so it is no curve; remedy: choose a place "
                            f"in run.probes[{probe!r}]")
        return found

    def step_curve(self, column: str) -> Curve:
        """A column of steps.csv over time. Throws DataError."""
        return read_curve(self.path / "steps.csv", column)

    @property
    def times(self) -> list:
        """Times of the field files, s."""
        return [time for time, _ in list_frames(self.path)]

    def at(self, time: float) -> Frame:
        """The fields at the available time nearest to `time` [s]."""
        return nearest_frames(self.path, [time])[0]

    def last(self) -> Frame:
        """The last fields: `position` (n, 3) in m, and others by name as in `last()["velocity"]`."""
        return self.at(max(self.times, default=0.0))

    def view(self) -> View:
        """Opens the viewer of the run, in the browser or in a notebook."""
        return View(self.path)

    def to_netcdf(self, path, start=EPOCH):
        """Writes the probes over time as a NetCDF file (CF-1.8, featureType timeSeries). `start` is the date and time
        at which the run's time is 0: a datetime, or a text such as "2026-03-01T12:00". Throws DataError if no probe
        recorded numbers over time."""
        write_netcdf(self, Path(path), start)

    def to_vtkhdf(self, path):
        """Writes the water with all its fields and times as one VTKHDF file, for ParaView 5.12 or newer; needs h5py.
        Throws DataError."""
        write_vtkhdf(self, Path(path))

    def to_paraview(self, path):
        """Writes a Python state for ParaView that shows the run, its water coloured by pressure. Throws DataError."""
        write_paraview(self, Path(path))

    def _value(self, table: str, key: str, kind):
        """A value of the effective case. Throws DataError where it is missing or has another type."""
        found = self.case.get(table)
        value = found.get(key) if isinstance(found, dict) else None
        if not isinstance(value, kind):
            raise DataError(f"{self.path / 'case.effective.toml'}: {table}.{key} is missing or damaged; remedy: repeat the run")
        return value

    @property
    def title(self) -> str:
        """The title of the case, `case.title`."""
        return self._value("case", "title", str)

    @property
    def spacing(self) -> float:
        """Particle spacing, m."""
        return self._value("particles", "spacing", (int, float))

    @property
    def dimension(self) -> int:
        """2 or 3"""
        return self._value("case", "dimension", int)

    @property
    def integrator(self) -> str:
        """"explicit" or "two-step"; "two-step" for a scheme without a choice of integrators."""
        return self.case["scheme"].get("integrator", "two-step")

    @property
    def fluid_particles(self) -> int:
        """Number of fluid particles at the end. Throws DataError if the run has not ended."""
        if "particles" not in self.summary:
            raise DataError(f"{self.path}: the run has not ended")
        return self.summary["particles"]["fluid"]

    @property
    def density(self) -> float:
        """Density of the water, kg/m^3."""
        return self._value("physics", "density", (int, float))

    @property
    def gravity(self) -> float:
        """Magnitude, m/s^2."""
        return sum(component**2 for component in self._value("physics", "gravity", list)) ** 0.5

    @property
    def parameters(self) -> dict:
        """The [parameters] of the case."""
        return self.case.get("parameters", {})

    @property
    def walls(self):
        """In 2D, the walls that do not move, as chains of points (m). The first point of a closed wall is repeated at
        its end."""
        return [wall_chain(wall) for wall in self.case.get("wall", []) if not is_moving(wall)]

    def walls_at(self, time: float):
        """The walls at rest, and hulls of floating bodies where a motion probe recorded them at a time (s). Gates and other
        walls on a path are not among them."""
        found = {probe["body"]: probe["name"] for probe in self.case.get("probe", []) if probe["type"] == "motion"}
        placed = {hull: place_of(self, body, found[body["name"]], time) for body in self.case.get("body", [])
                  if body["name"] in found for hull in body["walls"]}
        return [placed.get(wall["name"], lambda chain: chain)(wall_chain(wall))
                for wall in self.case.get("wall", []) if not is_moving(wall)]

    def __repr__(self):
        summary = self.summary
        reached = f", t = {summary['time_s']['reached']:.4g} s" if summary else ""
        return f"Run({str(self.path)!r}: {self.title}, {summary.get('status', 'not ended')}{reached})"


def require_tables(path: Path, case: dict):
    """Throws DataError if a table of an effective case lacks a key that every run writes."""
    for table, names in {"probe": ("name", "type"), "wall": ("shape",)}.items():
        tables = case.get(table, [])
        if not isinstance(tables, list) or not all(name in one for one in tables for name in names):
            raise DataError(f"{path}: a [[{table}]] is damaged; remedy: repeat the run")


def warn_of(run: Run):
    for line in run.summary.get("warnings", []):
        warnings.warn(line, RunWarning, stacklevel=4)


def is_moving(wall):
    return any(wall.get("displacement", ())) or wall.get("rotation", 0) != 0 or wall.get("motion", "") != ""


def place_of(run, body, probe, time):
    """Returns a function that moves points (2D) of a body from their drawn positions to those at a time (s), by its
    motion probe."""
    curves = [run.curve(probe, column) for column in ("displacement_x_m", "displacement_y_m", "angle_rad")]
    x, y, angle = (np.interp(time, curve.time, curve.value) for curve in curves)
    centre, turn = np.array(body["centre"]), np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return lambda points: (np.array(points) - centre) @ turn + centre + (x, y)


def has_several_values(file, column) -> bool:
    """Whether a column of a table has different values at one time."""
    table = tables.read_table(file)
    order = np.argsort(table["time_s"], kind="stable")
    time, value = table["time_s"][order], table[column][order]
    return bool(((np.diff(time) == 0) & (np.diff(value) != 0)).any())


def wall_chain(wall):
    if wall["shape"] == "box":
        (left, low), (right, high) = wall["min"], wall["max"]
        return [(left, low), (right, low), (right, high), (left, high), (left, low)]
    points = [tuple(point) for point in wall["points"]]
    return points + points[:1] if wall["shape"] == "polygon" else points
