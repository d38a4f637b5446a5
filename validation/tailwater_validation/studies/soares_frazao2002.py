"""Dam break over a sill into still water: cases/soares_frazao2002 (its README lists the measurements).

The events and surfaces that the experiment shows. No measured numbers are published: nothing here has a target.
"""

from functools import partial

import numpy as np

from tailwater.errors import DataError

from .. import panels
from ..checks import Check
from ..curves import passage_time
from ..metric import Metric, measure
from ..profiles import differences_at, profile_at, rms
from ..study import Plot
from .laboratory import case_run, laboratory_study

NAME = "soares_frazao2002"
DEPTH, POOL, SILL = 0.111, 0.02, 0.065  # m: of the reservoir, of the still water, height of the sill
LENGTH, TOE, CREST = 5.6, 4.0, 4.45  # m
INSTANTS = (1.8, 3.0, 3.7, 8.4, 15.5)  # s, of the published profiles

ARRIVAL = 0.05 * DEPTH  # m: a depth above it is the front
GAUGES = {"midway": 3.2, "toe": TOE, "crest": CREST}  # m, where the front is timed
# The bore that the sill sends back, where it is looked for: the depth halfway up its face (m), and the time (s) after which
# nothing else rises through it.
REFLECTED = {"toe": (0.065, 2.0), "midway": (0.06, 3.0), "gate": (0.05, 5.0)}
RISE_AT_END = POOL + 0.1 * DEPTH  # m


def passage(run, gauge, depth, after=0.0):
    """Time at which the water at a gauge rises through a depth (m), s."""
    curve = run.curve(gauge, "connected_m")
    return passage_time(curve.window(after, curve.time[-1]), depth)


def behind(run, instant):
    """Water behind the crest, m^2."""
    return profile_at(run, "surface", instant).area(CREST, LENGTH)


def excess_volume(run, instant):
    """Area below the surface over that of the particles, less 1. Between the walls and the middles of the first and
    last piece the surface is taken as level."""
    return profile_at(run, "surface", instant).area(0, LENGTH) / (run.fluid_particles * run.spacing**2) - 1


def metrics(run):
    """All numbers of a run, as [Metric]."""
    events = [*((f"arrival {gauge}", f"front at x = {x:g} m", (gauge, ARRIVAL)) for gauge, x in GAUGES.items()),
              ("arrival end", "wave at the end wall", ("end", RISE_AT_END)),
              *((f"reflection {gauge}", f"reflected bore at {gauge}, depth {depth:g} m", (gauge, depth, after))
                for gauge, (depth, after) in REFLECTED.items())]
    return [*(measure(Metric(name, what, "s", ""), partial(passage, run, *where)) for name, what, where in events),
            *(measure(Metric(f"{name} {instant:g}", what.format(instant), unit, ""), partial(read, run, instant))
              for instant in INSTANTS for name, what, unit, read in (
                ("behind", "water behind the crest, t = {:g} s", "m^2", behind),
                ("volume", "area below the surface over that of the particles, t = {:g} s, less 1", "", excess_volume)))]


def surface_distance(instant, run, reference):
    """RMS vertical difference (mm) between the surfaces of two runs."""
    one, other = (profile_at(which, "surface", instant) for which in (run, reference))
    places = np.linspace(other.x[0], other.x[-1], int(np.ceil(np.ptp(other.x) / run.spacing)) + 1)
    return 1000 * rms(differences_at(places, np.interp(places, other.x, other.level), one.x, one.level))


def draw(run):
    places = {"gate": 2.39, **GAUGES, "end": LENGTH}
    return [panels.panel("Depths", "t (s)", "depth (m)", (panels.over_time(f"{name}, x = {x:g} m", run.curve(name, "connected_m"))
                                                          for name, x in places.items()), limits=(0, 1.05 * DEPTH))]


def draw_surface_distances(*runs):
    """Difference between the last run and each other run, by spacing. Throws DataError if there is only one run."""
    if len(runs) < 2:
        raise DataError("only one run reached its end")
    return panels.convergence({f"t = {instant:g} s": {run.spacing: surface_distance(instant, run, runs[-1]) for run in runs[:-1]}
                               for instant in INSTANTS}, "RMS distance from the finest (mm)")


def study(plan):
    runs = tuple(case_run(plan, NAME, "h0", count, 40) for count in plan.at((8, 11), (8, 11, 16), (11, 16, 22)))
    *coarser, finest = runs
    distances = tuple(Check(Metric(f"{NAME}.distance.{instant:g}.{run.name}", f"surface at t = {instant:g} s, RMS distance "
                                   f"from that of {finest.name}, {run.name}", "mm", "the finest run"), (run, finest),
                            partial(surface_distance, instant))
                      for instant in INSTANTS for run in coarser)
    return laboratory_study(
        NAME, "Dam break over a sill into still water: Soares-Frazao (2002)", metrics, draw,
        "A reservoir 0.111 m deep empties over a sill 0.065 m high into still water before a closed end. Farmani et al. show surfaces "
        "at five instants and state a worst error of 12.3 % without giving a measured number: arrivals, reflections and "
        "surfaces are shown.",
        "No measured numbers are published: nothing here has a target. Surfaces of coarser runs are "
        "compared with those of the finest; most of the distance comes from where the breaking faces are.", runs,
        more_checks=distances,
        more_plots=(Plot("Surfaces by spacing: distance from those of the finest run.", runs, draw_surface_distances),),
        moments=INSTANTS[:4])
