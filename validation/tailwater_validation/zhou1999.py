"""Scores a run of cases/zhou1999 against the laboratory data beside the case (its README says what was measured).

T = t sqrt(g/H); depths over H; pressures over rho g H. Two people digitised the same curves; each is scored apart, and
their distance from each other is scored too: it is the least uncertainty that the data can have.
"""

from functools import partial
from pathlib import Path

from . import panels
from .curves import DataError, arrival_time, first_peak, noise, read_curve
from .metric import Metric, measure
from .run_folder import RunFolder
from .scoring import compare_curves, result

TITLE = "Dam break of a 1.2 m x 0.6 m column, Zhou et al. (1999)"  # of the case file: how a run is recognised
H = 0.6
TANK = 3.22
GRAVITY = 9.81
DENSITY = 1000.0
TIME_SCALE = (H / GRAVITY) ** 0.5
MOMENTS = tuple(T * TIME_SCALE for T in (1.6, 3.0, 5.0, 6.6))  # s: collapse, run-up, fall, overturning on the water ahead
PRESSURE_SCALE = DENSITY * GRAVITY * H

DATA = Path(__file__).resolve().parents[2] / "cases" / "zhou1999" / "data"
DIGITISATIONS = ("openmps", "fluidity")
TIME_UNCERTAINTY = 0.12  # of T: the instant of release is known to 0.03 s
LABORATORY_QUIET = 1.5  # T before which the gauge shows only the noise of the release

GRID = 0.01  # of T
PRESSURE_WINDOW = (2.4, 7.0)
ARRIVAL_THRESHOLD = 0.05
FIRST_PEAK_WITHIN = 0.75  # of T after the arrival: the jet has met the wall, the water above has not come down yet
NOISE_WINDOW = (0.6, 1.4)  # s
NOISE_MEDIAN = 0.02  # s

ARRIVAL_TARGET = (0.60, 0.66)  # s, at the point READ_AT
DEPTH_TARGETS = {(0.0, 6.0): 0.05, (0.0, 8.0): 0.10}  # window of T: largest RMS over H

POINT_HEIGHTS = {"P060": 0.06, "P115": 0.115, "P120": 0.12, "P160": 0.16}  # m, of the point probes
READ_AT = "P120"  # the height 0.2 H that Buchner (2002) gives for the gauge; the case's README argues for it
NOISE_AT = "P160"  # where others' noise was read


def laboratory(quantity, digitisation):
    """Measured H1, H2 (over H) or P2 (over rho g H), as a curve over T; digitisation is one of DIGITISATIONS."""
    column = "p_over_rhogH" if quantity == "P2" else "h_over_H"
    return read_curve(DATA / f"zhou1999_{quantity}_{digitisation}.csv", column, time_column="tstar")


def depth(run, gauge, column="wet_m"):
    """Computed depth over H at a gauge, over T; by default what the laboratory's wire reads, the length under water."""
    return run.probe(gauge, column).scaled(1 / TIME_SCALE, 1 / H)


def pressure(run, probe):
    """Computed wall pressure over rho g H, over T."""
    return run.probe(probe, "pressure_Pa").scaled(1 / TIME_SCALE, 1 / PRESSURE_SCALE)


def arrival_in_seconds(curve, not_before=0.0):
    """When a pressure over rho g H, over T, first exceeds the threshold: in s."""
    arrival = arrival_time(curve, ARRIVAL_THRESHOLD, not_before)
    if arrival is None:
        raise DataError(f"the pressure never exceeds {ARRIVAL_THRESHOLD} rho g H")
    return arrival * TIME_SCALE


def front_arrival(run):
    """When the front, which is half a spacing ahead of the first particle, is within a spacing of the wall: in s."""
    arrival = arrival_time(run.probe("front", "front_m"), TANK - run.spacing)
    if arrival is None:
        raise DataError("the front never reaches the wall")
    return arrival


def peak(curve, not_before=0.0):
    """(T, pressure over rho g H) of the first peak."""
    return first_peak(curve, arrival_in_seconds(curve, not_before) / TIME_SCALE, FIRST_PEAK_WITHIN)


def measured_values(read):
    """"openmps 0.596, fluidity 0.607": what the laboratory's P2 gives, read with the rule for the computed curve."""
    return ", ".join(f"{name} {read(laboratory('P2', name), LABORATORY_QUIET):.3f}" for name in DIGITISATIONS)


def score_impact(run):
    arrivals = f"measured P2: {measured_values(arrival_in_seconds)} (+-{TIME_UNCERTAINTY * TIME_SCALE:.2f})"
    heights = f"measured P2: {measured_values(lambda curve, after: peak(curve, after)[1])}"
    times = f"measured P2: {measured_values(lambda curve, after: peak(curve, after)[0])} (+-{TIME_UNCERTAINTY})"
    return [
        *(measure(Metric(f"arrival_{point}", f"arrival, point z = {height:g} m", "s", arrivals,
                         *(ARRIVAL_TARGET if point == READ_AT else (None, None))),
                  value=lambda point=point: arrival_in_seconds(pressure(run, point)))
          for point, height in POINT_HEIGHTS.items()),
        measure(Metric("arrival_front", "arrival, front at the wall", "s", arrivals), value=lambda: front_arrival(run)),
        measure(Metric("arrival_P2", "arrival, P2", "s", arrivals),
                value=lambda: arrival_in_seconds(pressure(run, "P2"))),
        measure(Metric("peak_P2", "first peak, P2", "rho g H", heights), value=lambda: peak(pressure(run, "P2"))[1]),
        measure(Metric("peak_time_P2", "time of first peak, P2", "T", times),
                value=lambda: peak(pressure(run, "P2"))[0]),
    ]


def score_noise(run):
    window = f"t {NOISE_WINDOW[0]}..{NOISE_WINDOW[1]} s"
    return [measure(Metric("noise", f"pressure noise, point z = 0.16 m, {window}", "rho g H",
                           f"its running median of {NOISE_MEDIAN} s"),
                    value=lambda: noise(run.probe(NOISE_AT, "pressure_Pa"), *NOISE_WINDOW, NOISE_MEDIAN) / PRESSURE_SCALE)]


def score_curve(metric, measured, compute, window):
    return compare_curves(metric, measured, compute, window, GRID, TIME_UNCERTAINTY)


def score_curves(run):
    compared = [("P2", "P2", "rho g H", PRESSURE_WINDOW, None, lambda: pressure(run, "P2"))]
    for point, height in POINT_HEIGHTS.items():
        compared.append(("P2", f"point z = {height:g} m", "rho g H", PRESSURE_WINDOW, None,
                         partial(pressure, run, point)))
    for gauge in ("H1", "H2"):
        for window, target in DEPTH_TARGETS.items():
            compared.append((gauge, gauge, "H", window, target, partial(depth, run, gauge)))
            compared += [(gauge, f"{gauge} ({words})", "H", window, None, partial(depth, run, gauge, column))
                         for words, column in (("joined with the bed", "connected_m"), ("highest water", "highest_m"))]
    return [
        score_curve(Metric(f"rms {what} T {window[0]:g}..{window[1]:g} {digitisation}",
                           f"RMS of {what}, T {window[0]:g}..{window[1]:g}", unit, digitisation, high=target),
                    laboratory(gauge, digitisation), compute, window)
        for gauge, what, unit, window, target, compute in compared
        for digitisation in DIGITISATIONS
    ]


def score_digitisations():
    """How far the two readings of the same laboratory curves are from each other."""
    one, other = DIGITISATIONS
    return [
        score_curve(Metric(f"rms {gauge} T {window[0]:g}..{window[1]:g} {one} {other}",
                           f"RMS of {one}'s {gauge}, T {window[0]:g}..{window[1]:g}", unit, other),
                    laboratory(gauge, other), partial(laboratory, gauge, one), window)
        for gauge, unit, window in (("P2", "rho g H", PRESSURE_WINDOW), *(("H1", "H", w) for w in DEPTH_TARGETS),
                                    *(("H2", "H", w) for w in DEPTH_TARGETS))
    ]


def beside_laboratory(quantity, computed, end=8):
    """Two readings of the laboratory's curve to T = `end`, with the computed ones [(label, curve)]."""
    for digitisation in DIGITISATIONS:
        yield panels.over_time(f"laboratory, read by {digitisation}", laboratory(quantity, digitisation).window(0, end),
                               "measured")
    for label, curve in computed:
        yield panels.over_time(label, curve)


def draw_pressure(*runs, names=None):
    return [panels.panel(f"Pressure on the right wall, {title}", "T", "p/(rho g H)", beside_laboratory(
        "P2", zip(panels.labels(runs, names), (pressure(run, probe) for run in runs))), limits=(-0.05, 1.25))
            for probe, title in ((READ_AT, "z = 0.12 m"), ("P2", "mean over z = 0.115..0.205 m"))]


def draw_depths(*runs, names=None):
    return [panels.panel(f"Depth {gauge}, x = {place} m", "T", "h/H", (
        *beside_laboratory(gauge, zip(panels.labels(runs, names), (depth(run, gauge) for run in runs))),
        panels.over_time("highest water, the last run", depth(runs[-1], gauge, "highest_m"), "aside")), limits=(0, 1.6))
            for gauge, place in (("H2", 2.228), ("H1", 2.725))]


def draw(run):
    return [*draw_pressure(run), *draw_depths(run)]


def score(run_folder):
    """Scores a run; returns the result of `scoring`. Throws DataError if the folder is not that of a run."""
    run = RunFolder(run_folder)
    return result("zhou1999", run,
                  score_impact(run) + score_noise(run) + score_curves(run) + score_digitisations())
