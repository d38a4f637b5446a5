"""Scores a run of cases/martin_moyce1952 against the laboratory data beside the case (its README says what was measured).

Front x/a over T = t sqrt(n2 g/a), height of the column over n2 a, over tau = t sqrt(g/a); a is the width of the column
and n2 its height over a. The data are for n2 = 1 and 2; the run's parameters say which one it is.
"""

from dataclasses import dataclass
from pathlib import Path

from . import panels
from .curves import DataError, passage_time, read_curve, rms_difference
from .metric import Metric, measure
from .run_folder import RunFolder
from .scoring import compare_curves, result

TITLE = "Collapse of a column on a dry bed, Martin and Moyce (1952)"  # of the case file: how a run is recognised
GRAVITY = 9.81
DATA = Path(__file__).resolve().parents[2] / "cases" / "martin_moyce1952" / "data"

GRID = 0.01  # of T and tau
TIME_UNCERTAINTY = 0.2  # of T: how long the release takes (the case's README)
FRONT_TARGET = 0.10  # of a
HEIGHT_TARGET = 0.03  # of n2 a
SPEED_BETWEEN = (2.0, 4.0)  # x/a


@dataclass(frozen=True)
class Series:
    """One published set of fronts: who read it, of a column how wide (in), for which n2."""

    file: str
    label: str
    n2: int
    width_inches: float


FRONTS = (
    Series("front_n2_1_a2.25in.csv", "table", 1, 2.25),
    Series("front_n2_1_trixiparticles.csv", "TrixiParticles", 1, 2.25),
    Series("front_n2_2_a2.25in_table2.csv", "table", 2, 2.25),
    Series("front_n2_2_a2.25in_openmps.csv", "OpenMPS", 2, 2.25),
    Series("front_n2_2_a2.25in_fig3_pysph.csv", "PySPH", 2, 2.25),
    Series("front_n2_2_a1.125in_openmps.csv", "a = 1.125 in, OpenMPS", 2, 1.125),
    Series("front_n2_2_a1.125in_fig3_pysph.csv", "a = 1.125 in, PySPH", 2, 1.125),
)
HEIGHTS = {1: "height_n2_1_a2.25in.csv", 2: "height_n2_2_a2.25in_table6.csv"}


def n2_of(run):
    """Height over width of the run's column. Throws DataError if there are no data for it."""
    n2 = run.parameters.get("n2")
    if n2 not in HEIGHTS:
        raise DataError(f"{run.path}: there are data for parameters.n2 = 1 and 2, not {n2}")
    return int(n2)


def width(run):
    """Of the column, m."""
    return run.parameters["a"]


def fronts(n2):
    """The published series for this n2."""
    return [series for series in FRONTS if series.n2 == n2]


def laboratory_front(series):
    """Measured front x/a over T."""
    return read_curve(DATA / series.file, "Z", time_column="T")


def laboratory_height(n2):
    """Measured height over n2 a, over tau."""
    return read_curve(DATA / HEIGHTS[n2], "H", time_column="tau")


def front(run, column="front_m"):
    """Computed front x/a over T."""
    return run.probe("front", column).scaled((n2_of(run) * GRAVITY / width(run)) ** 0.5, 1 / width(run))


def height(run):
    """Computed height over n2 a, over tau."""
    return run.probe("height", "connected_m").scaled((GRAVITY / width(run)) ** 0.5, 1 / (n2_of(run) * width(run)))


def span(curve):
    return curve.time[0], curve.time[-1]


def common_span(one, other):
    """The times that both curves have."""
    return max(one.time[0], other.time[0]), min(one.time[-1], other.time[-1])


def speed(curve, between=SPEED_BETWEEN):
    """Mean speed of a front between two places (of a): d(x/a)/dT. It does not depend on the instant of release."""
    low, high = between
    return (high - low) / (passage_time(curve, high) - passage_time(curve, low))


def score_speed(run):
    measured = []
    for series in fronts(n2_of(run)):
        try:
            measured.append(f"{series.label} {speed(laboratory_front(series)):.2f}")
        except DataError:
            continue  # the series ends before
    return [measure(Metric("speed front", "speed of the front, x/a {:g}..{:g}".format(*SPEED_BETWEEN), "a/T",
                           "; ".join(measured)), value=lambda: speed(front(run)))]


def score_fronts(run):
    n2 = n2_of(run)
    metrics = []
    for series in fronts(n2):
        measured = laboratory_front(series)
        # The bar is for the table of the column that is computed; the others say how well it is known.
        target = FRONT_TARGET if series.label == "table" else None
        start, end = span(measured)
        metrics.append(compare_curves(
            Metric(f"rms front {series.label}", f"RMS of the front, T {start:.2g}..{end:.2g}", "a", series.label,
                   high=target), measured, lambda: front(run), span(measured), GRID, TIME_UNCERTAINTY))
    return metrics


def score_height(run):
    measured = laboratory_height(n2_of(run))
    start, end = span(measured)
    return [compare_curves(Metric("rms height", f"RMS of the column's height, tau {start:g}..{end:g}", "n2 a", "table",
                                  high=HEIGHT_TARGET), measured, lambda: height(run), span(measured), GRID,
                           TIME_UNCERTAINTY)]


def score_series(n2):
    """How far the other published series are from the table where they overlap."""
    table, *others = fronts(n2)  # the table comes first
    one = laboratory_front(table)
    metrics = []
    for series in others:
        other = laboratory_front(series)
        start, end = common_span(one, other)
        metrics.append(measure(Metric(f"rms front {table.label} {series.label}",
                                      f"RMS of the table's front, T {start:.2g}..{end:.2g}", "a", series.label),
                               value=lambda: rms_difference(other, one, start, end, GRID)))
    return metrics


def moments(run):
    """s; of T = 0.8, 1.6 and 2.8."""
    return [T * (width(run) / (n2_of(run) * GRAVITY)) ** 0.5 for T in (0.8, 1.6, 2.8)]


def draw(run):
    n2 = n2_of(run)
    measured = [(series.label, laboratory_front(series)) for series in fronts(n2)]
    end = 1.05 * max(curve.time[-1] for _, curve in measured)
    tall = laboratory_height(n2)
    return [panels.panel("Front", "T = t sqrt(n2 g/a)", "x/a", (
                *(panels.over_time(f"laboratory, {label}", curve, "measured") for label, curve in measured),
                panels.over_time("computed, foremost particle", front(run).window(0, end)),
                panels.over_time("computed, foremost connected", front(run, "front_connected_m").window(0, end), "aside"))),
            panels.panel("Height of the column at its back wall", "tau = t sqrt(g/a)", "h/(n2 a)", (
                panels.over_time("laboratory", tall, "measured"),
                panels.over_time("computed", height(run).window(0, 1.05 * tall.time[-1]))), limits=(0, 1.05))]


def score(run_folder):
    """Scores a run; returns the result of `scoring`. Throws DataError if the folder is not that of a run."""
    run = RunFolder(run_folder)
    return result("martin_moyce1952", run, score_fronts(run) + score_speed(run) + score_height(run)
                  + score_series(n2_of(run)))
