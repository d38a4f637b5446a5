"""What a run left in its folder: the effective case, its summary, and curves of its probes."""

import json
import tomllib
from pathlib import Path

from .curves import DataError, read_curve, read_table


class RunFolder:
    def __init__(self, path):
        self.path = Path(path)
        self._profile_tables = {}
        effective = self.path / "case.effective.toml"
        try:
            self.case = tomllib.loads(effective.read_text(encoding="utf-8"))
        except OSError as error:
            raise DataError(f"{self.path}: is not the folder of a run, {effective.name} cannot be read "
                            f"({error.strerror})") from error
        except tomllib.TOMLDecodeError as error:
            raise DataError(f"{effective}: {error}") from error

    def probe(self, name, column):
        """The curve of a probe's column over time in s."""
        return read_curve(self.path / "probes" / f"{name}.csv", column)

    def profile_table(self, name):
        """Columns of a profile probe's CSV, by name; read once, since one file holds the profiles of all times."""
        if name not in self._profile_tables:
            self._profile_tables[name] = read_table(self.path / "probes" / f"{name}.csv")
        return self._profile_tables[name]

    def steps(self):
        """Columns of steps.csv, by name."""
        return read_table(self.path / "steps.csv")

    def step_curve(self, column):
        """A column of steps.csv over time in s."""
        return read_curve(self.path / "steps.csv", column)

    @property
    def parameters(self):
        return self.case.get("parameters", {})

    @property
    def summary(self):
        """summary.json of a run that has ended; empty when it goes on or was killed."""
        path = self.path / "summary.json"
        try:
            summary = json.loads(path.read_text(encoding="utf-8"))
            return {} if summary.get("status") == "running" else summary
        except FileNotFoundError:
            return {}
        except (OSError, ValueError) as error:
            raise DataError(f"{path}: {error}") from error

    @property
    def fluid_particles(self):
        """How many there are at the end. Throws DataError if the run has not ended."""
        if "particles" not in self.summary:
            raise DataError(f"{self.path}: the run has not ended")
        return self.summary["particles"]["fluid"]

    @property
    def spacing(self):
        return self.case["particles"]["spacing"]

    @property
    def dimension(self):
        return self.case["case"]["dimension"]

    @property
    def density(self):
        return self.case["physics"]["density"]

    @property
    def gravity(self):
        """Magnitude, m/s^2."""
        return sum(component**2 for component in self.case["physics"]["gravity"]) ** 0.5

    @property
    def integrator(self):
        """"two-step" for the scheme that knows no other."""
        return self.case["scheme"].get("integrator", "two-step")

    @property
    def walls(self):
        """Chains of wall points (m) of the walls that stay where they are drawn (2D), closed ones with their first point
        again at the end."""
        return [wall_chain(wall) for wall in self.case.get("wall", []) if not is_moving(wall)]

    @property
    def moving_walls(self):
        """The same of those that move, where they start."""
        walls = [wall_chain(wall) for wall in self.case.get("wall", []) if is_moving(wall)]
        plates = self.case.get("gate", []) + self.case.get("wave_maker", [])
        return walls + [[tuple(plate["from"]), tuple(plate["to"])] for plate in plates]


def is_moving(wall):
    return any(wall.get("displacement", ())) or wall.get("rotation", 0) != 0 or wall.get("motion", "") != ""


def wall_chain(wall):
    if wall["shape"] == "box":
        (left, low), (right, high) = wall["min"], wall["max"]
        return [(left, low), (right, low), (right, high), (left, high), (left, low)]
    points = [tuple(point) for point in wall["points"]]
    return points + points[:1] if wall["shape"] == "polygon" else points
