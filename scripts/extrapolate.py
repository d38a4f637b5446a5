#!/usr/bin/python3
"""The limit of a quantity of a sweep over particles.spacing at dx = 0, with its uncertainty.

For each member: the mean of a probe's column from --from on, and its standard error, from the means of ten equal parts
of that time. The limit is that of a straight line over dx through all members. Its uncertainty is the larger of that from
the standard errors, doubled, and how far the lines through all but one of the members end from it.

Usage: extrapolate.py SWEEP PROBE COLUMN --from S [--minus VALUE]
"""
import argparse
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
from tailwater import DataError, Run

PARTS = 10


def limit(spacing, value):
    """At dx = 0, of the straight line that fits best."""
    return float(np.polyfit(spacing, value, 1)[1])


def member(run, options):
    """(spacing, mean, standard error) of one run."""
    curve = run.curve(options.probe, options.column)
    value = curve.value[curve.time >= options.start] - options.minus
    if run.summary.get("status") != "done" or value.size < PARTS:
        raise DataError(f"{run.path}: has not ended, or has fewer than {PARTS} readings from {options.start:g} s on")
    parts = [part.mean() for part in np.array_split(value, PARTS)]
    return run.spacing, float(value.mean()), float(np.std(parts, ddof=1) / PARTS**0.5)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sweep", type=Path)
    parser.add_argument("probe")
    parser.add_argument("column")
    parser.add_argument("--from", dest="start", type=float, required=True, metavar="S", help="when the flow is steady")
    parser.add_argument("--minus", type=float, default=0.0, metavar="VALUE", help="taken off all values")
    options = parser.parse_args()
    try:
        runs = [Run(case.parent) for case in options.sweep.glob("*/case.effective.toml")]
        members = sorted((member(run, options) for run in runs), reverse=True)
        if len(members) < 3:
            raise DataError(f"{options.sweep}: has {len(members)} runs; three spacings are needed")
    except DataError as error:
        sys.exit(f"extrapolate: {error}")
    spacing, mean, error = np.array(members).T
    end = limit(spacing, mean)
    # The limit is a sum of the values with these weights.
    weights = np.array([limit(spacing, one) for one in np.eye(spacing.size)])
    without = [limit(np.delete(spacing, k), np.delete(mean, k)) for k in range(spacing.size)]
    uncertainty = max(2 * float(np.linalg.norm(weights * error)), *(abs(one - end) for one in without))
    for dx, value, one in members:
        print(f"dx = {dx:<10.5g} {value:.5g} +- {2 * one:.2g}")
    print(f"dx = 0          {end:.5g} +- {uncertainty:.2g}")


if __name__ == "__main__":
    main()
