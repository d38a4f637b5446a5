"""Flows through the open ends of a basin whose levels and discharges change: runs of cases/openings against the
shallow-water equations (open_basin.py).

Each function takes a Run and returns its numbers by name. depth_error_dx: the largest difference of the depth at the gauge,
over dx, from what shallow water has at any time within LATE of the period; both are means over WINDOW.
"""

import math

import numpy as np

from tailwater.errors import DataError

from .flume import steady_discharge, steady_mean
from .open_basin import WALL, WINDOW, Discharge, Level, basin

LATE = 0.02  # of the period
START = 4.0  # sqrt(H/g); real water needs a time to become shallow


def means(times, values, width):
    """Running means over `width`, of even samples, and their times."""
    count = max(1, round(width / (times[1] - times[0])))
    kernel = np.ones(count) / count
    return np.convolve(times, kernel, "valid"), np.convolve(values, kernel, "valid")


def band(times, values, reach):
    """Least and largest value within `reach` of each of even times."""
    count = int(reach / (times[1] - times[0]))
    padded = np.pad(values, count, mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * count + 1)
    return windows.min(axis=1), windows.max(axis=1)


def depth_error(run, start, ends, period, since=START):
    """The number of this module, over dx; `start` (depth (m), speed (m/s)), `ends` of lengths H, `period` in s."""
    scale, curve = run.parameters["H"], run.curve("depth", "connected_m")
    unit = math.sqrt(scale / run.gravity)
    times = np.linspace(0.0, curve.time[-1], int(curve.time[-1] / (0.1 * unit)) + 2)
    gauge = run.case["probe"][0]["at"][0]
    exact, _ = basin(run.parameters["L"] / scale, start[0] / scale, start[1] * unit / scale, ends, times / unit, [gauge / scale])
    late, found = means(times, np.interp(times, curve.time, curve.value), WINDOW * unit)
    _, exact = means(times, scale * exact[:, 0], WINDOW * unit)
    low, high = band(late, exact, LATE * period)
    outside = np.maximum(np.maximum(low - found, found - high), 0.0)
    if not (late > since * unit).any():
        raise DataError(f"{run.path}: ends before its basin is shallow, at {since * unit:.3g} s")
    return float(outside[late > since * unit].max()) / run.spacing


def over_depths(run, level):
    """A level (m) over time (s) as one over H and sqrt(H/g)."""
    scale = run.parameters["H"]
    unit = math.sqrt(scale / run.gravity)
    return Level(lambda time: level(time * unit) / scale)


def discharge_over_depths(run, discharge):
    scale = run.parameters["H"]
    unit = math.sqrt(scale / run.gravity)
    return Discharge(lambda time: discharge(time * unit) * unit / scale**2)


def density(run):
    """density_error_rms of all water, beside the open ends too."""
    return {"density_error_rms": run.summary["volume"]["density_error_rms"]}


def rising_sea(run):
    p = run.parameters
    ends = (discharge_over_depths(run, lambda t: p["q"]),
            over_depths(run, lambda t: p["H"] + p["rise"] * min(max(t - 1.0, 0.0), 5.0) / 5.0))
    period = 4 * p["L"] / math.sqrt(run.gravity * p["H"])
    return {"depth_error_dx": depth_error(run, (p["H"], p["q"] / p["H"]), ends, period), **density(run)}


def draining_tank(run):
    p = run.parameters
    period = 4 * p["L"] / math.sqrt(run.gravity * p["H"])
    return {"depth_error_dx": depth_error(run, (p["start"], 0.0), (WALL, over_depths(run, lambda t: p["H"])), period),
            **density(run)}


def tide(run):
    p = run.parameters
    level = over_depths(run, lambda t: p["H"] + p["a"] * math.sin(2 * math.pi * t / p["T"]))
    return {"depth_error_dx": depth_error(run, (p["H"], 0.0), (WALL, level), p["T"]), **density(run)}


def ending_discharge(run):
    p = run.parameters
    ends = (discharge_over_depths(run, lambda t: p["q"] * max(0.0, 1 - t / 5.0)), over_depths(run, lambda t: p["H"]))
    period = 4 * p["L"] / math.sqrt(run.gravity * p["H"])
    return {"depth_error_dx": depth_error(run, (p["H"], p["q"] / p["H"]), ends, period), **density(run)}


def changing_level(run):
    p = run.parameters
    level = over_depths(run, lambda t: p["H"] + p["change"] * min(1.0, t / p["within"]))
    period = 4 * p["L"] / math.sqrt(run.gravity * p["H"])
    return {"depth_error_dx": depth_error(run, (p["H"], 0.0), (WALL, level), period), **density(run)}


def critical_discharge(head, gravity):
    """m^2/s, of water at rest `head` (m) deep that falls into a channel."""
    return math.sqrt(gravity) * (2 * head / 3) ** 1.5


def reservoir(run):
    """discharge_error: over that of critical flow, less 1."""
    exact = critical_discharge(run.parameters["H"], run.gravity)
    return {"discharge_error": steady_discharge(run, "discharge") / exact - 1, **density(run)}


def sudden_head(run):
    """discharge_error and depth_error: behind the bore that a head sends over still water, against shallow water, less 1."""
    p = run.parameters
    scale = p["H"]
    depths, discharges = basin(p["L"] / scale, p["still"] / scale, 0.0, (Level(lambda time: 1.0), WALL),
                               [run.case["time"]["end"] * math.sqrt(run.gravity / scale)], [0.25 * p["L"] / scale])
    exact = float(discharges[0, 0]) * math.sqrt(run.gravity * scale) * scale
    return {"discharge_error": steady_discharge(run, "discharge") / exact - 1,
            "depth_error": steady_mean(run, "depth", "connected_m") / (scale * float(depths[0, 0])) - 1, **density(run)}


FLOWS = {"rising-sea": rising_sea, "draining-tank": draining_tank, "tide": tide, "ending-discharge": ending_discharge,
         "changing-level": changing_level, "reservoir": reservoir, "sudden-head": sudden_head}
