"""Curves: a quantity at strictly increasing times, in the units of its source."""

from dataclasses import dataclass

import numpy as np

from .errors import DataError
from .tables import read_table

__all__ = ["Curve", "read_curve"]


@dataclass(frozen=True)
class Curve:
    """`time` (n), strictly increasing, and `value` (n)."""

    time: np.ndarray
    value: np.ndarray

    @classmethod
    def from_samples(cls, time, value, name="curve") -> "Curve":
        """Sorts by time and averages samples at the same time, because digitised curves step back and repeat times.
        Throws DataError with the name `name` where there are no samples or a number is not finite."""
        time, value = np.asarray(time, dtype=float), np.asarray(value, dtype=float)
        if time.size == 0:
            raise DataError(f"{name}: has no samples")
        if not (np.isfinite(time).all() and np.isfinite(value).all()):
            raise DataError(f"{name}: holds a number that is not finite")
        unique, owner = np.unique(time, return_inverse=True)
        return cls(unique, np.bincount(owner, weights=value) / np.bincount(owner))

    def scaled(self, time=1.0, value=1.0) -> "Curve":
        """The curve in other units: times and values are multiplied by these factors."""
        return Curve(self.time * time, self.value * value)

    def shifted(self, delay) -> "Curve":
        """The curve, later by `delay`."""
        return Curve(self.time + delay, self.value)

    def window(self, start, end) -> "Curve":
        """The samples from `start` to `end`."""
        inside = (self.time >= start) & (self.time <= end)
        return Curve(self.time[inside], self.value[inside])


def read_curve(path, value_column, time_column="time_s") -> Curve:
    """One column of a CSV file over its time column. The default time column is that of probes; for laboratory files,
    name both columns. Throws DataError."""
    table = read_table(path)
    for column in (time_column, value_column):
        if column not in table:
            raise DataError(f"{path}: has no column {column}; it has {', '.join(table)}")
    return Curve.from_samples(table[time_column], table[value_column], name=f"{path}, {value_column}")
