"""Dam break over a hump with an open end: cases/ozmen_cagatay2014 (its README lists the measurements).

T = t sqrt(g/h0); X = x/h0 from the gate, downstream; heights over h0. A height is the level above the channel's floor, over the
hump too (the README argues for it); the mean errors are also given for the other reading, depth above the hump.
"""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from tailwater.curves import Curve
from tailwater.errors import DataError

from .. import panels
from ..checks import Check
from ..curves import passage_time
from ..metric import Metric, measure
from ..profiles import profile_at
from ..reading import summary
from ..study import AllChecks
from .laboratory import case_run, laboratory_study, measured_tables

NAME = "ozmen_cagatay2014"
DEPTH, GATE = 0.25, 4.65  # m: h0; x of the gate
TIME_SCALE = (DEPTH / 9.81) ** 0.5  # s
TOE, CREST, HUMP_END, HUMP_HEIGHT = 6.0, 8.0, 10.0, 0.3  # X, X, X, over h0

# Largest mean error in %, over the profile and the gauge points, by scheme; and the largest of one point.
MEAN_TARGETS = {"farzin2014": {"profile": 6.0, "gauge": 8.0}, "farmani2020": {"profile": 9.24, "gauge": 12.47}}
LARGEST_TARGET = 15.3
# Errors that the paper of the scheme reports for its own model, in %.
FARMANI = (("mean error profile", 9.24), ("largest error profile", 14.2), ("mean error gauge", 12.47),
           ("largest error gauge", 15.3))
# The gauges whose point lies on the face of the reflected bore: there the height depends on its arrival.
ON_THE_BORE = ("P4", "P2", "P1")
BORE_WITHIN = 6.0  # of T either way


@dataclass(frozen=True)
class Point:
    """A measured height and the published model's, at one place and instant; `gauge` is empty for a profile's point."""

    gauge: str
    T: float
    X: float
    measured: float
    farmani: float

    @property
    def name(self):
        return f"{self.gauge or 'profile'} T {self.T:g}"

    @property
    def farmani_error(self):
        """Error of the published model, in % of the measured height."""
        return 100 * abs(self.farmani - self.measured) / self.measured


def bed(X):
    """Height of the bed over h0."""
    return HUMP_HEIGHT * np.maximum(0, 1 - np.abs(X - CREST) / (CREST - TOE))


def read_points(run, kind):
    """Points of `kind` "profile" or "gauge", in the order of the file."""
    table = measured_tables(run, "surface")[f"{kind}_points"]
    columns = (table[name] for name in ("tstar", "x_over_h0", "h_over_h0_measured", "h_over_h0_farmani"))
    return [Point(f"P{k}" if kind == "gauge" else "", *numbers) for k, numbers in enumerate(zip(*columns), 1)]


def gauge_level(run, gauge, X):
    """Computed level over h0 at a gauge, as a curve over T."""
    depth = run.curve(gauge, "connected_m").scaled(1 / TIME_SCALE, 1 / DEPTH)
    return Curve(depth.time, depth.value + bed(X))


def level(run, point):
    """Computed level over h0 at the place and time of a point."""
    if not point.gauge:
        profile = profile_at(run, "surface", point.T * TIME_SCALE)
        return float(np.interp(GATE + point.X * DEPTH, profile.x, profile.level)) / DEPTH
    curve = gauge_level(run, point.gauge, point.X)
    if curve.time[-1] < point.T:
        raise DataError(f"{point.gauge} ends at T = {curve.time[-1]:.2f}, before {point.T:g}")
    return float(np.interp(point.T, curve.time, curve.value))


def error(run, point, reading="level"):
    """Difference from the measured height, in % of it; the measured height is read as "level" or as "depth" above
    the hump."""
    computed = level(run, point) - (bed(point.X) if reading == "depth" else 0.0)
    return 100 * abs(computed - point.measured) / point.measured


def bore_lag(run, point):
    """Delay of the reflected bore at a gauge, in units of T: it passes when the computed level rises through the measured
    one."""
    curve = gauge_level(run, point.gauge, point.X).window(point.T - BORE_WITHIN, point.T + BORE_WITHIN)
    return passage_time(curve, point.measured) - point.T


def of_points(run, kind, points):
    def mean(reading):
        return float(np.mean([error(run, point, reading) for point in points]))

    return [
        measure(Metric(f"mean error {kind}", f"mean error of the {len(points)} {kind} points", "%",
                       f"Farmani et al. {np.mean([point.farmani_error for point in points]):.2f}",
                       high=MEAN_TARGETS[run.case["scheme"]["name"]][kind]), partial(mean, "level")),
        measure(Metric(f"largest error {kind}", f"largest error of the {kind} points", "%",
                       f"Farmani et al. {max(point.farmani_error for point in points):.1f}", high=LARGEST_TARGET),
                lambda: max(error(run, point) for point in points)),
        measure(Metric(f"mean error {kind} depth", f"mean error of the {kind} points, heights read as depth", "%", ""),
                partial(mean, "depth")),
        *(measure(Metric(f"level {point.name}", f"level, {point.gauge or 'profile'}, T = {point.T:g}, X = {point.X:g}", "h0",
                         f"measured {point.measured:.3f}, Farmani et al. {point.farmani:.3f}"), partial(level, run, point))
          for point in points)]


def metrics(run):
    """All numbers of a run, as [Metric]."""
    gauges = read_points(run, "gauge")
    return [*of_points(run, "profile", read_points(run, "profile")), *of_points(run, "gauge", gauges),
            *(measure(Metric(f"bore {point.gauge}", f"reflected bore at {point.gauge}, X = {point.X:g}, behind the measured one",
                             "T", f"level {point.measured:.3f} at T = {point.T:g}"), partial(bore_lag, run, point))
              for point in gauges if point.gauge in ON_THE_BORE)]


def draw(run):
    def measured(x, point):
        return (panels.curve("laboratory", [x], [point.measured], "measured"),
                panels.curve("Farmani et al. (2020)", [x], [point.farmani], "measured"))

    def of_profile(point):
        profile = profile_at(run, "surface", point.T * TIME_SCALE)
        X = (profile.x - GATE) / DEPTH
        return panels.panel(f"Surface at T = {point.T:g}", "X", "level/h0", (
            *measured(point.X, point), panels.curve("computed", X, profile.level / DEPTH),
            panels.curve("bed", X, profile.bed / DEPTH, "aside")), limits=(0, 1.1))

    def of_gauge(point):
        return panels.panel(f"{point.gauge}, X = {point.X:g}", "T", "level/h0", (
            *measured(point.T, point), panels.over_time("computed", gauge_level(run, point.gauge, point.X))), limits=(0, 1.1))

    return [*map(of_profile, read_points(run, "profile")), *map(of_gauge, read_points(run, "gauge"))]


def water_error(run):
    """Number of initial particles that are neither inside nor have left."""
    start, inside, out = (summary("water_balance", where, run)["particles"] for where in ("start", "inside", "out"))
    return start - inside - out


def study(plan):
    runs = tuple(case_run(plan, NAME, "h0", count, 18) for count in plan.at((9, 13), (9, 18), (18, 27)))
    two_step = case_run(replace(plan, scheme="farmani2020"), NAME, "h0", plan.at(13, 18, 27), 18)

    def errors(name):
        return not name.startswith("level ")

    return laboratory_study(
        NAME, "Dam break over a hump with an open end: Ozmen-Cagatay, Kocaman & Guzel (2014)", metrics, draw,
        "A reservoir 0.25 m deep empties over a dry floor and a triangular hump 0.075 m high; part is reflected, the rest leaves "
        "through the open end. Heights at eight places and instants of profiles and at six gauges. Farmani et al. compute it with "
        "5976 particles, dx = 0.014 m (h0/18).",
        "Published are 14 numbers with two or three digits, chosen by the paper as the worst of its model; the error of the "
        "data is not given. "
        "The channel's width, 0.30 m, is assumed: with 0.20 m the mean errors are 1.6 and 2.2 % smaller, without side walls 2.2 and "
        "4.3 % larger (scheme F, h0/12).",
        runs, (("profile points", "mean error profile"), ("gauge points", "mean error gauge")), "mean error (%)", FARMANI,
        errors, (Check(Metric(f"{NAME}.water", "initial water that is neither inside nor counted as outflow", "particles",
                              "the outlet's balance is exact", 0, 0), runs[-1:], water_error),
                 AllChecks(f"{NAME}.farmani2020", metrics, (two_step,), errors, FARMANI, ", scheme B")),
        moments=tuple(T * TIME_SCALE for T in (8, 15.16, 23.05, 41.84)), time_scale=TIME_SCALE)
