"""What a run of cases/soares_frazao2002 gives for the events and surfaces that the experiment shows (the case's README
says what was measured). No measured numbers are published: nothing here has a bar.

Usage: python -m tailwater_validation.soares_frazao2002 RUN_DIR REFERENCE_DIR
prints how far the surfaces of a run are from those of another one: the study of time step and resolution.
"""

import sys

from . import panels
from .curves import passage_time
from .metric import Metric, measure
from .profiles import profile_at, rms, vertical_differences
from .run_folder import RunFolder
from .scoring import result

TITLE = "Dam break over a sill into still water, Soares-Frazao (2002)"  # of the case file: how a run is recognised
DEPTH, POOL, SILL = 0.111, 0.02, 0.065  # m: of the reservoir, of the still water, height of the sill
LENGTH, TOE, CREST, POOL_START = 5.6, 4.0, 4.45, 4.9  # m
INSTANTS = MOMENTS = (1.8, 3.0, 3.7, 8.4, 15.5)  # s, of the published profiles

ARRIVAL = 0.05 * DEPTH  # m: a depth above it is the front
GAUGES = {"midway": 3.2, "toe": TOE, "crest": CREST}  # m, where the front is timed
# The bore that the sill sends back, where it is looked for: the depth halfway up its face (m), and the time (s) after which
# nothing else rises through it.
REFLECTED = {"toe": (0.065, 2.0), "midway": (0.06, 3.0), "gate": (0.05, 5.0)}
RISE_AT_END = POOL + 0.1 * DEPTH  # m


def score_arrivals(run):
    metrics = [measure(Metric(f"arrival {gauge}", f"front at x = {x:g} m", "s", ""),
                       value=lambda gauge=gauge: passage_time(run.probe(gauge, "connected_m"), ARRIVAL))
               for gauge, x in GAUGES.items()]
    metrics.append(measure(Metric("arrival end", "wave at the end wall", "s", ""),
                           value=lambda: passage_time(run.probe("end", "connected_m"), RISE_AT_END)))
    return metrics


def reflected(run, gauge):
    """When the bore that the sill sends back passes a gauge, s."""
    depth, after = REFLECTED[gauge]
    curve = run.probe(gauge, "connected_m")
    return passage_time(curve.window(after, curve.time[-1]), depth)


def score_reflections(run):
    return [measure(Metric(f"reflection {gauge}", f"reflected bore at {gauge}, depth {depth:g} m", "s", ""),
                    value=lambda gauge=gauge: reflected(run, gauge)) for gauge, (depth, _) in REFLECTED.items()]


def score_profiles(run):
    """Water on either side of the crest, and the level behind it, at each published instant."""
    metrics = []
    for instant in INSTANTS:
        def behind(instant=instant):
            return profile_at(run, "surface", instant).area(CREST, LENGTH)

        def whole(instant=instant):
            profile = profile_at(run, "surface", instant)
            # Between the middles of the first and last piece and the walls the surface is taken as level.
            return profile.area(0, LENGTH) / (run.fluid_particles * run.spacing**2) - 1
        metrics += [measure(Metric(f"behind {instant:g}", f"water behind the crest, t = {instant:g} s", "m^2", ""),
                            value=behind),
                    measure(Metric(f"volume {instant:g}", f"area below the surface over that of the particles, "
                                   f"t = {instant:g} s, less 1", "", ""), value=whole)]
    return metrics


def distances(run, reference):
    """[(instant, RMS, largest)] of the vertical distances between the surfaces of two runs, m, at each instant."""
    rows = []
    for instant in INSTANTS:
        one, other = (profile_at(which, "surface", instant) for which in (run, reference))
        apart = vertical_differences((other.x, other.level), (one.x, one.level), run.spacing)
        rows.append((instant, rms(apart), float(abs(apart).max())))
    return rows


def draw(run):
    places = {"gate": 2.39, **GAUGES, "end": LENGTH}
    return [panels.panel("Depths", "t (s)", "depth (m)", (panels.over_time(f"{name}, x = {x:g} m", run.probe(name, "connected_m"))
                                                          for name, x in places.items()), limits=(0, 1.05 * DEPTH))]


def score(run_folder):
    """Scores a run; returns the result of `scoring`. Throws DataError if the folder is not that of a run."""
    run = RunFolder(run_folder)
    return result("soares_frazao2002", run, score_arrivals(run) + score_reflections(run) + score_profiles(run))


def main(arguments):
    run, reference = (RunFolder(folder) for folder in arguments)
    print("t (s)  RMS (mm)  largest (mm)")
    for instant, typical, largest in distances(run, reference):
        print(f"{instant:5.1f}  {1000 * typical:8.2f}  {1000 * largest:12.1f}")


if __name__ == "__main__":
    main(sys.argv[1:])
