#!/usr/bin/python3
"""Effect of disorder on the pressure equation: the table of docs/theory/robustness.md#disorder-is-not-air.

For jittered lattices and for fields of runs, over particles inside the water: the fraction of the Laplacian's weights A_0
that is missing, mean of max(0, 1 - sum c/A_0); the distance over which pressure would be screened if that were air; and
the distance over which the force itself screens it, by 4 |grad C|^2. Default kernel, 2D.
Usage: scripts/disorder_study.py [RUN ...]   RUN: a folder of `tailwater run` of Zhou's dam break
"""
import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "validation"), str(ROOT / "python")]
from tailwater.fields import list_frames, read_frame  # noqa: E402
from tailwater.run import Run  # noqa: E402

SUPPORT = 3.0  # dx
SAMPLE = 1000
RANDOM = np.random.default_rng(1)


def slope(r):
    """-dW/dr/r of Wendland C2 in 2D, everything in dx; 0 at the particle itself and beyond the support."""
    q = np.clip(r / SUPPORT, 0.0, 1.0)
    return np.where(r > 1e-9, 7 / (np.pi * SUPPORT**2) * 20 * (1 - q) ** 3 / SUPPORT**2, 0.0)


def row_sums(points, inside):
    """sum c and |grad C|^2 (both dx^2) at points[inside]."""
    weights, gradients = [], []
    for i in inside:
        d = points[i] - points
        c = slope(np.hypot(d[:, 0], d[:, 1]))
        weights.append(2 * c.sum())
        gradients.append(((c[:, None] * d).sum(axis=0) ** 2).sum())
    return np.array(weights), np.array(gradients)


def lattice(jitter, rows=40):
    grid = np.stack(np.meshgrid(np.arange(rows), np.arange(rows)), axis=-1).reshape(-1, 2).astype(float)
    inside = np.flatnonzero((np.abs(grid - rows / 2) < rows / 2 - 5).all(axis=1))
    return grid + RANDOM.uniform(-jitter, jitter, grid.shape), inside


def frame(run, time):
    """Points of the run in dx at about `time`, and those whose neighbours are all inside and out of the walls' reach."""
    folder = Run(run)
    data = read_frame(*min(list_frames(run), key=lambda entry: abs(entry[0] - time)))
    points = data.position[:, :2] / folder.spacing
    off_walls = (points[:, 1] > 3.5) & (points[:, 0] > 3.5) & (points[:, 0] < points[:, 0].max() - 3.5)
    light = points[data.fields["density_error"] < -0.03]
    inside = [i for i in np.flatnonzero(off_walls) if ((light - points[i]) ** 2).sum(axis=1).min() > SUPPORT**2]
    return points, RANDOM.permutation(inside)[:SAMPLE]


def main():
    full = row_sums(*lattice(0.0))[0].mean()
    print("| | missing of A_0 | as air screens over | the force screens over |\n| --- | --- | --- | --- |")
    sets = [(f"lattice, jitter {jitter}", lattice(jitter)) for jitter in (0.02, 0.1, 0.15, 0.2)]
    for run in sys.argv[1:]:
        sets += [(f"{pathlib.Path(run).name}, t = {time} s", frame(run, time)) for time in (0.4, 0.8)]
    for name, points_inside in sets:
        weights, gradients = row_sums(*points_inside)
        missing = np.maximum(0.0, 1.0 - weights / full).mean()
        print(f"| {name} | {100 * missing:.2f} % | {(missing * full) ** -0.5:.0f} dx "
              f"| {(4 * gradients.mean()) ** -0.5:.0f} dx |")


if __name__ == "__main__":
    main()
