"""Numbers that several commands read from the folders of runs, by name."""

from functools import lru_cache

import numpy as np

from . import exact_flows, zhou1999
from .curves import DataError


@lru_cache(maxsize=None)
def flow_numbers(flow, path):
    return exact_flows.FLOWS[flow](exact_flows.RunFolder(path))


@lru_cache(maxsize=None)
def scores(score, path):
    """What a laboratory case's `score` finds in the folder of a run, by name."""
    return {metric["name"]: metric for metric in score(path)["metrics"]}


def signed(flow, name, run):
    """An error against theory: too large is above 0."""
    return flow_numbers(flow, run.path)[name]


def exact(flow, name, run):
    return abs(signed(flow, name, run))


def scored(score, name, run, field="value"):
    metric = scores(score, run.path)[name]
    if metric[field] is None:
        raise DataError(f"{run.path.name}: {metric['note']}")
    return metric[field]


def zhou(name, run, field="value"):
    return scored(zhou1999.score, name, run, field)


def summary(block, name, run):
    try:
        return run.summary[block][name]
    except KeyError as error:
        raise DataError(f"{run.path.name}: its summary has no {block}.{name}") from error


def interventions(run, *kinds):
    """Clamps, limiters and fallbacks of these kinds, or of all, per particle and step."""
    counts = {kind: count for kind, count in run.summary["interventions"].items() if isinstance(count, int)}
    return (sum(counts[kind] for kind in kinds or counts)
            / (run.fluid_particles * run.summary["steps"]["count"]))


def energy_at(T, run):
    """Total energy at a time T over that of the start."""
    kinetic, potential = run.step_curve("kinetic_J"), run.step_curve("potential_J")
    return float(np.interp(T * zhou1999.TIME_SCALE, kinetic.time, kinetic.value + potential.value)
                 / run.summary["energy"]["start_J"])


def divergence(positions, run):
    """Rms over the run, in sqrt(g/H), at the "old" or "new" positions."""
    return run.summary["divergence"][f"rms_at_{positions}_positions_per_s"] * zhou1999.TIME_SCALE


def order(errors):
    """Observed order of {dx: error}: slope of log error over log dx, least squares."""
    return float(np.polyfit(np.log(list(errors)), np.log(list(errors.values())), 1)[0])


def observed_order(flow, name, *runs):
    return order({run.spacing: exact(flow, name, run) for run in runs})


def mean_level(run):
    """Mean height of the water over the floor at the end (m): the highest particle of each column of two spacings."""
    position = exact_flows.frames(run)[-1].position.astype(float)
    dx = run.spacing
    column = (position[:, 0] // (2 * dx)).astype(int)
    highest = np.full(column.max() + 1, np.nan)
    for k in range(highest.size):
        if (column == k).any():
            highest[k] = position[column == k, 1].max() + 0.5 * dx
    return float(np.nanmean(highest))
