"""Numbers that several commands read from the folders of runs."""

from functools import lru_cache

import numpy as np

from tailwater.errors import DataError
from tailwater.run import Run

from . import exact_flows


@lru_cache(maxsize=None)
def flow_numbers(flow, path):
    return exact_flows.FLOWS[flow](Run(path))


@lru_cache(maxsize=None)
def scores(metrics, path):
    """{name: Metric} from a laboratory's `metrics` for the folder of a run."""
    return {metric.name: metric for metric in metrics(Run(path))}


def signed(flow, name, run):
    """The error against theory with its sign: positive if the value is too large."""
    return flow_numbers(flow, run.path)[name]


def exact(flow, name, run):
    return abs(signed(flow, name, run))


def scored(metrics, name, run):
    metric = scores(metrics, run.path)[name]
    if metric.value is None:
        raise DataError(f"{run.path.name}: {metric.note}")
    return metric.value


def summary(block, name, run):
    try:
        return run.summary[block][name]
    except KeyError as error:
        raise DataError(f"{run.path.name}: its summary has no {block}.{name}") from error


def interventions(run, *kinds):
    """Number of clamps, limiters and fallbacks of these kinds, or of all kinds, per particle and step."""
    counts = {kind: count for kind, count in run.summary["interventions"].items() if isinstance(count, int)}
    return (sum(counts[kind] for kind in kinds or counts)
            / (run.fluid_particles * run.summary["steps"]["count"]))


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
