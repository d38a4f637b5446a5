"""What the scores of all cases have in common: how a curve is compared, and what a scored run looks like."""

from dataclasses import asdict, replace

from .curves import best_shift, rms_difference
from .metric import measure


def compare_curves(metric, measured, compute, window, grid, time_uncertainty):
    """The metric with the RMS difference over the window (times of the measured curve, on a grid of `grid`) as published,
    and with the shift within the data's own uncertainty of time that fits best. `compute` makes the computed curve; if
    it cannot, or misses the window, the metric says why."""
    scored = measure(metric, value=lambda: rms_difference(measured, compute(), *window, grid))
    if scored.value is None:
        return scored
    shift, value = best_shift(measured, compute(), *window, grid, time_uncertainty)
    return replace(scored, shift=shift, shifted_value=value)


def result(case, run, metrics):
    """{case, run, spacing_m, integrator, summary (the run's own), metrics: [Metric's fields and its verdict]}."""
    return {
        "case": case,
        "run": str(run.path),
        "spacing_m": run.spacing,
        "integrator": run.integrator,
        "summary": run.summary,
        "metrics": [asdict(metric) | {"verdict": metric.verdict} for metric in metrics],
    }
