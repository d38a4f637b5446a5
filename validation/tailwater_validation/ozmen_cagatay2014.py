"""Scores a run of cases/ozmen_cagatay2014 against the points that are published (the case's README says what was measured).

T = t sqrt(g/h0); X = x/h0 from the gate, downstream; heights over h0. A height is the level above the channel's floor, over the
hump too (the README argues for it); the mean errors are also given for the other reading, depth above the hump.
"""

import csv
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from . import panels
from .curves import Curve, DataError, passage_time
from .metric import Metric, measure
from .profiles import profile_at
from .run_folder import RunFolder
from .scoring import result

TITLE = "Dam break over a hump with an open end, Ozmen-Cagatay et al. (2014)"  # of the case file: how a run is recognised
DEPTH, GATE = 0.25, 4.65  # m: h0; x of the gate
TIME_SCALE = (DEPTH / 9.81) ** 0.5  # s
MOMENTS = tuple(T * TIME_SCALE for T in (8, 15.16, 23.05, 41.84))
TOE, CREST, HUMP_END, HUMP_HEIGHT = 6.0, 8.0, 10.0, 0.3  # X, X, X, over h0

DATA = Path(__file__).resolve().parents[2] / "cases" / "ozmen_cagatay2014" / "data"

# Largest mean error in %, over the profile and the gauge points, by scheme; and the largest of one point.
MEAN_TARGETS = {"farzin2014": {"profile": 6.0, "gauge": 8.0}, "farmani2020": {"profile": 9.24, "gauge": 12.47}}
LARGEST_TARGET = 15.3
# The gauges whose point lies on the face of the reflected bore: there the height tells when it comes.
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


def bed(X):
    """Height of the bed over h0."""
    return HUMP_HEIGHT * np.maximum(0, 1 - np.abs(X - CREST) / (CREST - TOE))


def read_points(kind):
    """Points of `kind` "profile" or "gauge", in the order of the file."""
    lines = (DATA / f"{kind}_points.csv").read_text(encoding="utf-8").splitlines()
    return [Point(row.get("gauge", ""), *(float(row[name]) for name in
                                          ("T", "x_over_h0", "h_over_h0_measured", "h_over_h0_farmani")))
            for row in csv.DictReader(line for line in lines if not line.startswith("#"))]


def gauge_level(run, gauge, X):
    """Computed level over h0 at a gauge, over T."""
    depth = run.probe(gauge, "connected_m").scaled(1 / TIME_SCALE, 1 / DEPTH)
    return Curve(depth.time, depth.value + bed(X))


def level(run, point):
    """Computed level over h0 at a point's place and instant."""
    if not point.gauge:
        profile = profile_at(run, "surface", point.T * TIME_SCALE)
        return float(np.interp(GATE + point.X * DEPTH, profile.x, profile.level)) / DEPTH
    curve = gauge_level(run, point.gauge, point.X)
    if curve.time[-1] < point.T:
        raise DataError(f"{point.gauge} ends at T = {curve.time[-1]:.2f}, before {point.T:g}")
    return float(np.interp(point.T, curve.time, curve.value))


def error(run, point, reading="level"):
    """Distance from the measured height, in % of it; it is read as "level" or as "depth" above the hump."""
    computed = level(run, point) - (bed(point.X) if reading == "depth" else 0.0)
    return 100 * abs(computed - point.measured) / point.measured


def bore_lag(run, point):
    """How much later than measured the reflected bore passes a gauge, of T: when the computed level rises through the
    measured one."""
    curve = gauge_level(run, point.gauge, point.X).window(point.T - BORE_WITHIN, point.T + BORE_WITHIN)
    return passage_time(curve, point.measured) - point.T


def score_points(run, kind, points, targets):
    def mean(reading):
        return float(np.mean([error(run, point, reading) for point in points]))

    metrics = [
        measure(Metric(f"mean error {kind}", f"mean error of the {len(points)} {kind} points", "%",
                       f"Farmani et al. {np.mean([100 * abs(p.farmani - p.measured) / p.measured for p in points]):.2f}",
                       high=targets[kind]), value=partial(mean, "level")),
        measure(Metric(f"largest error {kind}", f"largest error of the {kind} points", "%",
                       f"Farmani et al. {max(100 * abs(p.farmani - p.measured) / p.measured for p in points):.1f}",
                       high=LARGEST_TARGET), value=lambda: max(error(run, point) for point in points)),
        measure(Metric(f"mean error {kind} depth", f"mean error of the {kind} points, heights read as depth", "%", ""),
                value=partial(mean, "depth")),
    ]
    return metrics + [
        measure(Metric(f"level {point.name}", f"level, {point.gauge or 'profile'}, T = {point.T:g}, X = {point.X:g}", "h0",
                       f"measured {point.measured:.3f}, Farmani et al. {point.farmani:.3f}"),
                value=partial(level, run, point)) for point in points]


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

    return [*map(of_profile, read_points("profile")), *map(of_gauge, read_points("gauge"))]


def score(run_folder):
    """Scores a run; returns the result of `scoring`. Throws DataError if the folder is not that of a run."""
    run = RunFolder(run_folder)
    targets = MEAN_TARGETS[run.case["scheme"]["name"]]
    gauges = read_points("gauge")
    lags = [measure(Metric(f"bore {point.gauge}", f"reflected bore at {point.gauge}, X = {point.X:g}, behind the measured one",
                           "T", f"level {point.measured:.3f} at T = {point.T:g}"), value=partial(bore_lag, run, point))
            for point in gauges if point.gauge in ON_THE_BORE]
    return result("ozmen_cagatay2014", run, score_points(run, "profile", read_points("profile"), targets)
                  + score_points(run, "gauge", gauges, targets) + lags)
