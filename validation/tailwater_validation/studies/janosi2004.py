"""Bore on a wet bed behind a rising gate: cases/janosi2004 (its README lists the measurements).

Surfaces at eight instants after the gate opens: x from the closed end of the lock, heights above the bed, m.
"""

from functools import partial

import numpy as np

from tailwater.errors import DataError

from .. import panels
from ..metric import Metric, measure
from ..profiles import differences_at, profile_at, rms
from .laboratory import case_run, laboratory_study, measured_tables

NAME = "janosi2004"
DEPTH = 0.038  # m, of the water ahead
INSTANTS = (0.156, 0.219, 0.281, 0.343, 0.406, 0.468, 0.531, 0.593)  # s

# The instants are odd 32nds of a second and 1/16 s apart: pictures at 16 a second, of which the gate began to move between two.
# So the instants have one common error of up to 1/32 s. A run takes its profile also so much (s) off each instant:
SHIFTS = (-0.03, -0.025, -0.02, -0.015, -0.01, -0.005, 0.0, 0.005, 0.01, 0.015, 0.02, 0.025, 0.03)

DISTANCE_TARGET = 4.0  # mm
TARGET_FROM = 0.28  # s: the target does not hold before


def laboratory(run, instant):
    """(x, y) of the measured surface, at places a millimetre apart."""
    table = measured_tables(run, "surface")["surface_points"]
    now = np.abs(table["t"] - instant) < 1e-6
    return table["x"][now], table["connected"][now]


def distances(run, instant, shift=0.0, computed="level"):
    """Computed less measured height (mm). `shift` (s) is how much later the run is read; `computed` is "level", of the water
    joined with the bed, or "highest_level"."""
    profile = profile_at(run, "surface", instant + shift)
    return 1000 * differences_at(*laboratory(run, instant), profile.x, getattr(profile, computed))


def best_shift(run):
    """The shift in time (s), within the data's uncertainty, at which all measured surfaces fit best. Throws DataError if the
    run lacks the profiles for it."""
    instants = [instant for instant in INSTANTS if instant >= TARGET_FROM]
    scores = [sum(rms(distances(run, instant, shift=shift)) ** 2 for instant in instants) for shift in SHIFTS]
    return SHIFTS[int(np.argmin(scores))]


def metrics(run):
    """All numbers of a run, as [Metric]; the shift is that of the whole run."""
    try:
        shift = best_shift(run)
    except DataError:
        shift = None  # the run ended early

    def distance(instant):
        found = {"value": rms(distances(run, instant))}
        return found if shift is None else found | {"shift": shift, "shifted_value": rms(distances(run, instant, shift=shift))}

    return [one for instant in INSTANTS for one in (
        measure(Metric(f"rms {instant:g}", f"RMS distance of the surface, t = {instant:g} s", "mm", "undisturbed water at 38 mm",
                       high=DISTANCE_TARGET if instant >= TARGET_FROM else None, shift_unit="s"), partial(distance, instant)),
        measure(Metric(f"largest {instant:g}", "largest distance", "mm", "undisturbed water at 38 mm"),
                lambda: float(np.abs(distances(run, instant)).max())),
        measure(Metric(f"rms highest {instant:g}", "RMS of the highest water", "mm", "undisturbed water at 38 mm"),
                lambda: rms(distances(run, instant, computed="highest_level"))))]


def draw(run):
    def panel(instant):
        profile = profile_at(run, "surface", instant)
        shown = profile.x < 1.1
        return panels.panel(f"Surface at t = {instant:g} s", "x (m)", "y (m)", (
            panels.curve("laboratory, undisturbed water at 38 mm", *laboratory(run, instant), "measured"),
            panels.curve("computed", profile.x[shown], profile.level[shown]),
            panels.curve("highest water", profile.x[shown], profile.highest_level[shown], "aside")))

    return [panel(instant) for instant in INSTANTS]


def study(plan):
    runs = tuple(case_run(plan, NAME, "d", count, 50) for count in plan.at((4, 7), (7, 13), (13, 21)))
    return laboratory_study(
        NAME, "Bore on a wet bed behind a rising gate: Janosi et al. (2004)", metrics, draw,
        "A lock 0.38 m long and 0.15 m deep opens onto water 38 mm deep; the gate is a moving wall that rises at 1.5 m/s and does work "
        "on the water. Surfaces "
        "at eight instants. Farzin et al. compute it with 11 905 particles and compare four of them.",
        "Each photograph has its own vertical offset (the still water reads 35.3 to 45.7 mm and is moved to 38 mm); the instant at "
        "which the gate began to move is known to 0.015 s, in which the bore runs 15 mm; differences below 2 mm mean nothing.", runs,
        tuple((f"t = {instant:g} s", f"rms {instant:g}") for instant in INSTANTS[2::2]), "RMS distance (mm)")
