"""Readings of a probe over the run, for results that depend on the time at which the run ends."""

import math

import numpy as np

from .errors import DataError
from .finite_time import MAX_BLOCKS, error_of_time_mean
from .tables import read_table, without_unit

__all__ = ["error_of_mean", "rise_at_end"]

# Columns, without units, of the results that are the largest or least reading; those of a `motion` probe are named as
# their columns.
EXTREMES = {"highest water": "highest", "run-up": "connected", "highest drop": "highest", "highest level": "highest",
            "largest discharge": "discharge", "largest force": "magnitude of force",
            "largest moment": "magnitude of moment", "largest pressure": "pressure", "least pressure": "pressure"}
TYPES = {"pressure-map": {"largest pressure": "largest"}, "profile": {}}  # types of probes with other columns
# Columns, without units, of the results that are means over the second half of the run. RATES are mean rates of change.
MEANS = {"depth": {"depth": "connected"}, "level-map": {"level": "mean"}, "pressure": {"pressure": "pressure"},
         "velocity": {name: name for name in "uvw"},
         "force": {"moment": "moment", **{f"{what} {axis}": f"{what}_{axis}" for what in ("force", "moment") for axis in "xyz"}}}
RATES = {"discharge": {"discharge": "volume"}, "wall-pressure": {"pressure": "impulse"},
         "wall-pressure-mean": {"pressure": "impulse"}}
MIN_READINGS = 10  # in the second half
END = 0.9  # of the run; a reading after that is one of its end


def columns_of(run, probe) -> dict:
    """The table of a probe by its columns without units, with the magnitudes of a force and a moment; empty without the
    table."""
    try:
        table = read_table(run.path / "probes" / f"{probe}.csv")
    except DataError:
        return {}
    found = {without_unit(name): column for name, column in table.items()}
    for vector in ("force", "moment"):
        components = [found[name] for name in (vector, *(f"{vector}_{axis}" for axis in "xyz")) if name in found]
        if components:
            found[f"magnitude of {vector}"] = np.sqrt(sum(one**2 for one in components))
    return found


def series_of(run, probe, column):
    """(times, values) of a column, without readings that are no number; None if there are fewer than two."""
    columns = columns_of(run, probe)
    if column not in columns or "time" not in columns:
        return None
    time, value = columns["time"], columns[column]
    is_known = np.isfinite(time) & np.isfinite(value)
    return (time[is_known], value[is_known]) if is_known.sum() > 1 else None


def rise_at_end(run, probe, quantity) -> float:
    """The excess of the last reading over all readings before the end of the run, relative to the range of the
    readings. It is negative for a least reading that is still falling. 0 if the last reading is not the largest or
    least one, and for a result that is neither."""
    sign = -1 if quantity.startswith("least ") else 1
    moved = quantity.removeprefix("least ").removeprefix("largest ").replace(" ", "_")
    kind = run.results.get(probe, {}).get("type", "")
    column = moved if kind == "motion" else TYPES.get(kind, EXTREMES).get(quantity)
    series = series_of(run, probe, column) if column else None
    if series is None:
        return 0.0
    time, value = series[0], sign * series[1]
    before = value[time <= END * time[-1]]
    if value[-1] < value.max() or not before.size or np.ptp(value) == 0:
        return 0.0
    return sign * float(value[-1] - before.max()) / float(np.ptp(value))


def error_of_mean(run, probe, quantity) -> float:
    """Half width of the 95 % interval of a mean over the second half of the run, due to the finite time. It follows
    from the means of equal parts of that half (finite_time.py). nan for another result, and for too few readings."""
    kind = run.results.get(probe, {}).get("type", "")
    rate = RATES.get(kind, {}).get(quantity)
    column = rate or MEANS.get(kind, {}).get(quantity)
    series = series_of(run, probe, column) if column else None
    if series is None:
        return math.nan
    time, value = series
    half = 0.5 * run.summary["time_s"]["reached"]
    readings = int((time >= half).sum())
    if readings < MIN_READINGS:
        return math.nan
    sums = value if rate else np.append(0.0, np.cumsum(0.5 * (value[1:] + value[:-1]) * np.diff(time)))
    ends = np.linspace(half, time[-1], min(MAX_BLOCKS, readings) + 1)
    return error_of_time_mean(np.diff(np.interp(ends, time, sums)) / np.diff(ends))
