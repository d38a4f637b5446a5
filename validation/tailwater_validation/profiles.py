"""Water surfaces over x at one instant: those of a run's profile probe, measured ones, and the distances between them."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from tailwater.errors import DataError
from tailwater.tables import read_table

from .curves import LEAST_COVERAGE

# s: how late a profile may be where a run does not report its longest step
LATEST = 0.004
ROUND_OFF = 1e-6  # s, of times written as text


@dataclass(frozen=True)
class Profile:
    """Over the places x (m): the height of the bed, the depth of the water connected with it, and the height of the
    highest water above it (m)."""

    time: float
    x: np.ndarray
    bed: np.ndarray
    connected: np.ndarray
    highest: np.ndarray

    @property
    def level(self):
        """Level of the water connected with the bed; the height of the bed where it is dry."""
        return self.bed + self.connected

    @property
    def highest_level(self):
        return self.bed + self.highest

    def area(self, start, end):
        """Area of the water between two places that is connected with the bed, m^2."""
        places, depths = cut(self.x, self.connected, start, end)
        return float(np.sum(np.diff(places) * (depths[1:] + depths[:-1]) / 2))


def cut(x, y, start, end):
    """(x, y) of a curve over increasing x between two places, linear between its points and constant outside."""
    inside = (x > start) & (x < end)
    return (np.concatenate([[start], x[inside], [end]]),
            np.concatenate([[np.interp(start, x, y)], y[inside], [np.interp(end, x, y)]]))


@lru_cache(maxsize=8)
def table_of(path, _changed):
    return read_table(path)


def profile_table(run, probe):
    """Columns of a profile probe's CSV file by name. The table is kept, because one file holds the profiles of all
    times."""
    path = run.path / "probes" / f"{probe}.csv"
    return table_of(path, path.stat().st_mtime_ns if path.exists() else 0)


def profile_at(run, probe, time):
    """The profile that a probe recorded at the first step at or after `time` (s). Throws DataError if there is none."""
    table = profile_table(run, probe)
    taken = np.unique(table["time_s"])
    latest = time + run.summary.get("steps", {}).get("dt_largest_s", LATEST)
    due = taken[(taken > time - ROUND_OFF) & (taken < latest + ROUND_OFF)]
    if due.size == 0:
        nearest = taken[np.argmin(np.abs(taken - time))]
        raise DataError(f"{run.path}: {probe} has no profile at {time:.3f} s; the nearest is at {nearest:.3f} s")
    taken_at = due[0]
    rows = table["time_s"] == taken_at
    return Profile(float(taken_at), *(table[name][rows] for name in ("x_m", "bed_m", "connected_m", "highest_m")))


def differences_at(x, y, x_computed, y_computed):
    """Computed minus measured heights at the measured places x (m); the computed x increase. Throws DataError if the
    computed curve does not cover them."""
    reached = (x >= x_computed[0]) & (x <= x_computed[-1])
    if reached.mean() < LEAST_COVERAGE:
        raise DataError(f"the computed profile spans {x_computed[0]:.3g}..{x_computed[-1]:.3g} m of the measured "
                        f"{np.min(x):.3g}..{np.max(x):.3g} m")
    return np.interp(x[reached], x_computed, y_computed) - y[reached]


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))
