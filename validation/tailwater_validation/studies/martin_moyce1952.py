"""Collapse of a column on a dry bed: cases/martin_moyce1952 (its README lists the measurements).

Front x/a over T = t sqrt(n2 g/a), height of the column over n2 a, over tau = t sqrt(g/a); a is the width of the column
and n2 its height over a. The run's parameters say which column it is.
"""

from functools import partial

from tailwater.errors import DataError

from .. import panels
from ..curves import compare, passage_time, rms_difference
from ..metric import Metric, measure
from .laboratory import case_run, laboratory_study, measured_curves

NAME = "martin_moyce1952"
GRAVITY = 9.81

GRID = 0.01  # of T and tau
TIME_UNCERTAINTY = 0.2  # of T: how long the release takes (the case's README)
FRONT_TARGET = 0.10  # of a
HEIGHT_TARGET = 0.03  # of n2 a
SPEED_BETWEEN = (2.0, 4.0)  # x/a


def n2_of(run):
    """Height over width of the run's column. Throws DataError if the measurements are of another column."""
    n2 = run.parameters["n2"]
    for name in measured_curves(run, "front"):
        if f"_n2_{n2:g}_" not in name:
            raise DataError(f"{run.path}: parameters.n2 = {n2:g}, but {name} was measured on another column; remedy: give each "
                            "[[measurement]] a file of this one")
    return n2


def fronts(run):
    """{label: measured front x/a over T} of the published series: the table first, then the others, named after the
    person who digitised them."""
    curves = measured_curves(run, "front")
    labels = ["table", *(name.rpartition("_")[2] for name in list(curves)[1:])]
    return {label: scaled(run, curve) for label, curve in zip(labels, curves.values())}


def laboratory_height(run):
    """Measured height over n2 a, over tau."""
    curve, = measured_curves(run, "height").values()
    return of_height(run, curve)


def scaled(run, curve):
    """A front (m) over a, over T."""
    a = run.parameters["a"]
    return curve.scaled((n2_of(run) * GRAVITY / a) ** 0.5, 1 / a)


def of_height(run, curve):
    """A height (m) over n2 a, over tau."""
    a = run.parameters["a"]
    return curve.scaled((GRAVITY / a) ** 0.5, 1 / (n2_of(run) * a))


def front(run, column="front_m"):
    """Computed front x/a over T."""
    return scaled(run, run.curve("front", column))


def height(run):
    """Computed height over n2 a, over tau."""
    return of_height(run, run.curve("height", "connected_m"))


def speed(curve, between=SPEED_BETWEEN):
    """Mean speed of a front between two places (of a): d(x/a)/dT. It does not depend on the instant of release."""
    low, high = between
    return (high - low) / (passage_time(curve, high) - passage_time(curve, low))


def speeds(run):
    """"table 1.30; ..." for the published series that cover these places."""
    told = []
    for label, curve in fronts(run).items():
        try:
            told.append(f"{label} {speed(curve):.2f}")
        except DataError:
            continue
    return "; ".join(told)


def beside(name, what, unit, label, measured, computed, high=None):
    """The difference between a computed curve, from `computed()`, and a measured one over all its times."""
    start, end = measured.time[0], measured.time[-1]
    return measure(Metric(name, what.format(start, end), unit, label, high=high),
                   lambda: compare(measured, computed(), (start, end), GRID, TIME_UNCERTAINTY))


def of_laboratory(run):
    """The run's numbers compared with the laboratory's, as [Metric]. The target is for the table of the computed
    column; the other series show the uncertainty of the table."""
    return [
        *(beside(f"rms front {label}", "RMS of the front, T {:.2g}..{:.2g}", "a", label, curve, partial(front, run),
                 FRONT_TARGET if label == "table" else None) for label, curve in fronts(run).items()),
        measure(Metric("speed front", "speed of the front, x/a {:g}..{:g}".format(*SPEED_BETWEEN), "a/T", speeds(run)),
                lambda: speed(front(run))),
        beside("rms height", "RMS of the column's height, tau {:.3g}..{:.3g}", "n2 a", "table", laboratory_height(run),
               partial(height, run), HEIGHT_TARGET)]


def metrics(run):
    """All numbers of a run, as [Metric], and the difference between the other published series and the table where
    they overlap."""
    (_, table), *others = fronts(run).items()
    found = of_laboratory(run)
    for label, other in others:
        start, end = max(table.time[0], other.time[0]), min(table.time[-1], other.time[-1])
        found.append(measure(Metric(f"rms front table {label}", f"RMS of the table's front, T {start:.2g}..{end:.2g}", "a", label),
                             partial(rms_difference, other, table, start, end, GRID)))
    return found


def draw(run):
    measured, tall = fronts(run), laboratory_height(run)
    end = 1.05 * max(curve.time[-1] for curve in measured.values())
    return [panels.panel("Front", "T = t sqrt(n2 g/a)", "x/a", (
                *(panels.over_time(f"laboratory, {label}", curve, "measured") for label, curve in measured.items()),
                panels.over_time("computed, foremost particle", front(run).window(0, end)),
                panels.over_time("computed, foremost connected", front(run, "front_connected_m").window(0, end), "aside"))),
            panels.panel("Height of the column at its back wall", "tau = t sqrt(g/a)", "h/(n2 a)", (
                panels.over_time("laboratory", tall, "measured"),
                panels.over_time("computed", height(run).window(0, 1.05 * tall.time[-1]))), limits=(0, 1.05))]


def study(plan):
    runs = tuple(case_run(plan, NAME, "a", count, 0.5) for count in plan.at((15, 30), (30, 60, 96), (60, 96, 160)))
    return laboratory_study(
        NAME, "Collapse of a square column: Martin & Moyce (1952)", metrics, draw,
        "A column 57 mm wide and as high collapses and runs over a dry, smooth bed. Front x/a over T = t sqrt(g/a) and height of "
        "the column at its back wall. Farzin et al. compute it with 3898 and 9320 particles (a/60 and a/96) on a frictionless bed "
        "but give no numbers.",
        "The release takes time: before friction can matter, the laboratory's fronts are 0.13 to 0.19 in T behind that of a "
        "column released at once, so the best shift is sought within 0.2. Readings of one figure differ by 0.006 to 0.04 a, "
        "columns of two sizes by 0.12 a where they should coincide.", runs,
        (("front, the table (a)", "rms front table"), ("column height (n2 a)", "rms height")), "RMS difference")
