"""Plots of the report as data for the page of `tailwater view`: panels of curves, in the form of JSON. A curve has a
kind: "run" (a line in its own colour), "exact" (theory), "measured" (points), "aside" (in grey), "spacings" (a line
through points) or "particles" (a point for each particle)."""

import math

import numpy as np

from tailwater.tables import read_table

BINS = 300  # of a curve, each with its least and its largest value: enough for a plot half a page wide
DIGITS = 7  # of small changes of large numbers
MOST_RUNS = 8  # in one plot


def rounded(values):
    """Rounded to DIGITS digits; None for a value that is not finite."""
    return [float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None for value in values]


def thinned(x, y):
    """The curve with as many points as can be seen, peaks included."""
    if len(x) <= 2 * BINS:
        return x, y
    parts = [part for part in np.array_split(np.arange(len(x)), BINS) if np.isfinite(y[part]).any()]
    kept = np.unique([part[find(y[part])] for part in parts for find in (np.nanargmin, np.nanargmax)]).astype(int)
    return x[kept], y[kept]


def curve(label, x, y, kind="run"):
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    order = np.argsort(x, kind="stable")
    x, y = thinned(x[order], y[order])
    return {"label": label, "kind": kind, "x": rounded(x), "y": rounded(y)}


def over_time(label, curve_of_run, kind="run"):
    """The points of a Curve of module curves."""
    return curve(label, curve_of_run.time, curve_of_run.value, kind)


def panel(title, x, y, curves, logarithmic=False, limits=None):
    """A panel. `x` and `y` name the axes; `limits` is the visible range of y, by default all of it."""
    return {"title": title, "x": x, "y": y, "logarithmic": logarithmic, "limits": limits, "curves": list(curves)}


def run_label(run):
    return f"dx = {run.spacing * 1000:.3g} mm, {run.integrator}"


def labels(runs, names=None):
    """A label for each run that differs from all others: from `names` {folder's name: label} if given, otherwise
    spacing and integrator, or the folder's name if these do not differ."""
    if names:
        return [names[run.path.name] for run in runs]
    short = [run_label(run) for run in runs]
    return short if len(set(short)) == len(short) else [run.path.name for run in runs]


def of_the_start(run, energy):
    return energy / run.summary["energy"]["start_J"]


HISTORIES = {
    "total energy, of the start": lambda run, steps: of_the_start(run, steps["kinetic_J"] + steps["potential_J"]),
    "kinetic energy, of the start": lambda run, steps: of_the_start(run, steps["kinetic_J"]),
    "density error, mean (%)": lambda run, steps: 100 * steps["density_error_mean"],
    "density error, rms (%)": lambda run, steps: 100 * steps["density_error_rms"],
}
WATER_INSIDE = {"water inside, of the start":
                lambda run, steps: 1 - steps["volume_out_m3"] / run.summary["water_balance"]["start"]["volume_m3"]}


def histories(runs, names=None):
    """Histories of several runs: energies, the volume error from the density and, if water leaves, the volume
    inside; `names` as in `labels`."""
    told = [(label, run, read_table(run.path / "steps.csv")) for run, label in zip(runs, labels(runs, names))]
    leaves = any(steps["volume_out_m3"].any() for _, _, steps in told)
    return [panel(title, "t (s)", "", [curve(label, steps["time_s"], history(run, steps)) for label, run, steps in told])
            for title, history in (HISTORIES | (WATER_INSIDE if leaves else {})).items()]


def convergence(series, y):
    """Errors over spacing on logarithmic axes: {label: {dx in m: error}}, with lines of order 1 and 2."""
    curves, everything = [], np.array([point for errors in series.values() for point in errors.items()])
    for label, errors in series.items():
        dx, error = np.array(sorted(errors.items())).T
        order = f": order {np.polyfit(np.log(dx), np.log(error), 1)[0]:.1f}" if len(dx) > 1 else ""
        curves.append(curve(label + order, dx, error, "spacings"))
    (least, _), (most, highest) = everything.min(0), everything.max(0)
    if least < most:
        ends = np.array([least, most])
        curves += [curve(f"order {order}", ends, highest * (ends / most) ** order, "aside") for order in (1, 2)]
    return [panel("", "spacing dx (m)", y, curves, logarithmic=True)]
