"""Dam break through a block of crushed rock: cases/liu1999 (its README lists the measurements).

Surfaces at six instants after the start of the gate: x from the wall of the reservoir, heights above the bed, m.
"""

import numpy as np

from .. import panels
from ..metric import Metric, measure
from ..profiles import differences_at, profile_at, rms
from .laboratory import case_run, laboratory_study, measured_tables

NAME = "liu1999"
INSTANTS = (0.2, 0.4, 0.8, 1.2, 1.6, 2.0)  # s
DISTANCE_TARGET = 12.0  # mm, over all profiles
ROCK = (0.30, 0.59)  # m


def laboratory(run, instant):
    """(x, y) of the measured surface."""
    table = measured_tables(run, "surface")["surface_points"]
    now = np.abs(table["t"] - instant) < 1e-6
    return table["x"][now], table["connected"][now]


def distances(run, instant):
    """Computed less measured height (mm)."""
    profile = profile_at(run, "surface", instant)
    return 1000 * differences_at(*laboratory(run, instant), profile.x, profile.level)


def metrics(run):
    """All numbers of a run, as [Metric]."""
    whole = measure(Metric("rms", "RMS distance of the surface, all profiles", "mm", "surface above the bed", high=DISTANCE_TARGET),
                    lambda: rms(np.concatenate([distances(run, instant) for instant in INSTANTS])))
    return [whole, *(measure(Metric(f"rms {instant:g}", f"RMS distance of the surface, t = {instant:g} s", "mm",
                                    "surface above the bed"), lambda at=instant: rms(distances(run, at)))
                     for instant in INSTANTS)]


def draw(run):
    def panel(instant):
        profile = profile_at(run, "surface", instant)
        return panels.panel(f"Surface at t = {instant:g} s (rock from {ROCK[0]:.2f} to {ROCK[1]:.2f} m)", "x (m)", "y (m)", (
            panels.curve("laboratory", *laboratory(run, instant), "measured"),
            panels.curve("computed", profile.x, profile.level)))

    return [panel(instant) for instant in INSTANTS]


def study(plan):
    # The gate is 20 mm thick, which must hold three layers of wall particles.
    runs = tuple(case_run(plan, NAME, "depth", count, 0.1) for count in plan.at((36, 48), (36, 48), (36, 48, 72)))
    return laboratory_study(
        NAME, "Dam break through crushed rock: Liu et al. (1999)", metrics, draw,
        "A reservoir 0.28 m long and 0.24 m deep opens onto a block of crushed rock 0.29 m long, with 25 mm of water in the rock and "
        "behind it. Van Gent's law with the coefficients that Jensen et al. (2014) found for this rock. Surfaces at six instants.",
        "The gate needs 0.1 s to open and disturbs the first profiles; readings scatter by 5 mm. Coefficients of the resistance differ "
        "between authors by factors of 2 to 5.", runs,
        (("all profiles", "rms"),), "RMS distance (mm)")
