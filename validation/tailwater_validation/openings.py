"""Flows through the open ends of a basin whose levels and discharges change: runs of cases/openings against the
shallow-water equations (open_basin.py).

Each function takes a Run and returns its numbers by name. depth_error_dx: the largest difference of the depth at the gauge,
over dx, from what shallow water has at any time within LATE of the period; both are means over WINDOW.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from tailwater.errors import DataError

from .flume import solve, steady_discharge, steady_mean
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


@dataclass(frozen=True)
class Theory:
    """The basin beside a run: lengths in m, times in s; the levels and discharges of its ends are functions of the time."""

    start: tuple  # depth, speed
    level: Callable  # beyond the right end
    discharge: Callable | None = None  # into the left end, which else is a wall
    period: float | None = None  # by default that of the basin

    def depths(self, run, times, place):
        """Depth (m) at `place` at each of `times`."""
        depth = run.parameters["H"]
        unit = math.sqrt(depth / run.gravity)
        left = WALL
        if self.discharge:
            left = Discharge(lambda time: self.discharge(time * unit) * unit / depth**2)
        right = Level(lambda time: self.level(time * unit) / depth)
        found, _ = basin(run.parameters["L"] / depth, self.start[0] / depth, self.start[1] * unit / depth, (left, right),
                         np.asarray(times) / unit, [place / depth])
        return depth * found[:, 0]


def draining_tank(p):
    return Theory((p["start"], 0.0), lambda t: p["H"])


def changing_level(p):
    return Theory((p["H"], 0.0), lambda t: p["H"] + p["change"] * min(1.0, t / p["within"]))


def tide(p):
    return Theory((p["H"], 0.0), lambda t: p["H"] + p["a"] * math.sin(2 * math.pi * t / p["T"]), period=p["T"])


def ending_discharge(p):
    return Theory((p["H"], p["q"] / p["H"]), lambda t: p["H"], lambda t: p["q"] * max(0.0, 1 - t / 5.0))


def rising_sea(p):
    return Theory((p["H"], p["q"] / p["H"]), lambda t: p["H"] + p["rise"] * min(max(t - 1.0, 0.0), 5.0) / 5.0,
                  lambda t: p["q"])


# By the parameters of the case.
THEORIES = {"draining-tank": draining_tank, "changing-level": changing_level, "tide": tide,
            "ending-discharge": ending_discharge, "rising-sea": rising_sea}


def depth_at_gauge(run):
    """(curve of the depth at the gauge, its place)."""
    return run.curve("depth", "connected_m"), run.case["probe"][0]["at"][0]


def compared_with(theory_of, run):
    """depth_error_dx and the density error."""
    theory, (curve, gauge) = theory_of(run.parameters), depth_at_gauge(run)
    scale = run.parameters["H"]
    unit = math.sqrt(scale / run.gravity)
    period = theory.period or 4 * run.parameters["L"] / math.sqrt(run.gravity * scale)
    times = np.linspace(0.0, curve.time[-1], int(curve.time[-1] / (0.1 * unit)) + 2)
    late, found = means(times, np.interp(times, curve.time, curve.value), WINDOW * unit)
    _, exact = means(times, theory.depths(run, times, gauge), WINDOW * unit)
    if not (late > START * unit).any():
        raise DataError(f"{run.path}: ends before its basin is shallow, at {START * unit:.3g} s")
    low, high = band(late, exact, LATE * period)
    outside = np.maximum(np.maximum(low - found, found - high), 0.0)
    return {"depth_error_dx": float(outside[late > START * unit].max()) / run.spacing, **density(run)}


def density(run):
    """density_error_rms of all water, beside the open ends too."""
    return {"density_error_rms": run.summary["volume"]["density_error_rms"]}


def critical_discharge(head, gravity):
    """m^2/s, of water at rest `head` (m) deep that falls into a channel."""
    return math.sqrt(gravity) * (2 * head / 3) ** 1.5


def reservoir(run):
    """discharge_error: over that of critical flow, less 1."""
    exact = critical_discharge(run.parameters["H"], run.gravity)
    return {"discharge_error": steady_discharge(run, "discharge") / exact - 1, **density(run)}


def sudden_head(run):
    """discharge_error and depth_error: behind the bore that a head sends over still water, against shallow water, less 1."""
    p, (_, gauge) = run.parameters, depth_at_gauge(run)
    scale = p["H"]
    depths, discharges = basin(p["L"] / scale, p["still"] / scale, 0.0, (Level(lambda time: 1.0), WALL),
                               [run.case["time"]["end"] * math.sqrt(run.gravity / scale)], [gauge / scale])
    exact = float(discharges[0, 0]) * math.sqrt(run.gravity * scale) * scale
    return {"discharge_error": steady_discharge(run, "discharge") / exact - 1,
            "depth_error": steady_mean(run, "depth", "connected_m") / (scale * float(depths[0, 0])) - 1, **density(run)}


def river_section(x, length):
    """(height of the bed, width of the bottom) of cases/openings/river_bed.obj, m; its banks rise by 45 degrees."""
    s = math.sin(math.pi * x / length) ** 2
    return 0.1 * s, 0.4 - 0.1 * s


def backwater_level(x, length, discharge, head, gravity):
    """Level (m) of subcritical flow without friction that has a total head (m) above z = 0."""
    bed, bottom = river_section(x, length)

    def head_at(depth):
        return bed + depth + (discharge / (depth * (bottom + depth))) ** 2 / (2 * gravity)

    depths = np.linspace(0.02, 1.0, 2000)
    critical = float(depths[np.argmin(head_at(depths))])
    return bed + solve(lambda depth: head_at(depth) - head, critical, 1.0)


def river(run):
    """level_error_dx: largest error of the mean level at three gauges against the curve on which the head is the same; that
    downstream is of the level of the rating curve. missing: the fraction of the discharge that has not come in."""
    p, g = run.parameters, run.gravity
    level = 0.25 + p["Q"]
    bed, bottom = river_section(p["L"], p["L"])
    depth = level - bed
    head = level + (p["Q"] / (depth * (bottom + depth))) ** 2 / (2 * g)
    errors = []
    for probe in run.case["probe"][:3]:
        x = probe["at"][0]
        found = river_section(x, p["L"])[0] + steady_mean(run, probe["name"], "connected_m")
        errors.append(abs(found - backwater_level(x, p["L"], p["Q"], head, g)) / run.spacing)
    balance = run.summary["water_balance"]
    inlet = balance["inlets"][0]
    return {"level_error_dx": max(errors), "missing": 1 - inlet["volume_m3"] / inlet["asked_for_m3"],
            "outside": balance["outside"]["particles"], **density(run)}


FLOWS = {**{name: partial(compared_with, theory_of) for name, theory_of in THEORIES.items()},
         "reservoir": reservoir, "sudden-head": sudden_head, "river": river}
