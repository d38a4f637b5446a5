#!/usr/bin/python3
"""Levels at open ends beside shallow-water theory: the tables of docs/theory/open_ends.md, section Measured.

Usage: scripts/level_study.py [--absorbing 0,0.3,1] [--set KEY=VALUE ...] [NAME ...]

Needs build/release/bin/tailwater (scripts/build.sh). All of it takes some ten minutes on one core. The reference is the
solution of the shallow-water equations in validation/tailwater_validation/open_basin.py, with a level that is held at any
instant, and with the energy of the head where water comes in.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "validation")]
from tailwater import tables  # noqa: E402
from tailwater_validation.open_basin import WALL, Discharge, Level, basin  # noqa: E402

PROGRAM = ROOT / "build/release/bin/tailwater"
G = 9.81
CELLS = 200
INTERVAL = 0.02  # s


def shallow_water(length, depth, level, end, speed=0.0, inflow=None):
    """Times, and the depth in the middle over time. On the left a wall or a discharge into the case, on the right a level."""
    unit = np.sqrt(depth / G)  # s
    ends = (Discharge(lambda t: inflow(t * unit) * unit / depth**2) if inflow else WALL, Level(lambda t: level(t * unit) / depth))
    times = np.arange(0, end + INTERVAL / 2, INTERVAL)
    depths, _ = basin(length / depth, 1.0, speed * unit / depth, ends, times / unit, [length / depth / 2], CELLS)
    return times, depth * depths[:, 0]


def case(length, depth, level, end, spacing=0.05, top=1.0, speed=0.0, inflow=None):
    """A 2D tank or channel: a level on the right; on the left a wall, or a discharge."""
    walls = [[0, 0], [length, 0]] if inflow else [[0, 1.5], [0, 0], [length, 0]]
    fed = f'[[inlet]]\nfrom = [0, 0]\nto = [0, {top}]\ndischarge = "{inflow}"\n' if inflow else ""
    return (f"[particles]\nspacing = {spacing}\n[time]\nend = {end}\n[[fluid]]\nmin = [0, 0]\nmax = [{length}, {depth}]\n"
            f'velocity = [{speed}, 0]\n[[wall]]\npoints = {walls}\nfluid_side = "left"\n{fed}'
            f'[[outlet]]\nname = "end"\nfrom = [{length}, 0]\nto = [{length}, {top}]\nlevel = "{level}"\nabsorbing = ABSORBING\n'
            f'[[probe]]\nname = "depth"\ntype = "depth"\nat = [{length / 2}, 0]\ninterval = {INTERVAL}\n')


def formula(text):
    return lambda t: eval(text, {"t": t, "min": min, "max": max, "sin": np.sin, "pi": np.pi})


# name: length, depth, level, end, times at which the depth is shown, other arguments
TRANSIENTS = {
    "drain": (4, 0.8, "0.3", 25, (3, 5, 10, 15, 20), dict(top=1.2)),
    "rise": (1, 0.4, "0.4 + 0.3*min(1, t/3)", 8, (1, 2, 3, 5, 7), {}),
    "fall": (1, 0.7, "0.7 - 0.4*min(1, t/4)", 8, (2, 4, 6, 7), {}),
    "tide": (4, 0.4, "0.4 + 0.1*sin(2*pi*t/10)", 25, (12, 15, 20, 24), dict(spacing=0.04)),
    "discharge ends": (3, 0.2, "0.2", 25, (3, 6, 10, 15, 24), dict(spacing=0.025, top=0.4, speed=0.55, inflow="0.11*max(0, 1 - t/5)")),
    "rising sea": (2, 0.2, "0.2 + 0.008*min(max(0, t - 1), 5)", 8, (3, 5, 7), dict(spacing=0.02, top=0.4, speed=0.1, inflow="0.02")),
    "even flow": (3, 0.2, "0.2", 12, (3, 6, 11), dict(spacing=0.025, top=0.4, speed=0.55, inflow="0.11")),
    "still": (1, 0.5, "0.5", 10, (1, 5, 9), {}),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--absorbing", default="0,0.3,1")
    parser.add_argument("--set", action="append", default=[], dest="settings")
    parser.add_argument("names", nargs="*")
    arguments = parser.parse_args()
    print("depth in the middle, m; means over 0.5 s")
    with tempfile.TemporaryDirectory() as folder:
        for name, (length, depth, level, end, shown, other) in TRANSIENTS.items():
            if arguments.names and name not in arguments.names:
                continue
            inflow = other.get("inflow")
            times, middle = shallow_water(length, depth, formula(level), end, other.get("speed", 0.0), inflow and formula(inflow))
            means = [middle[abs(times - t) < 0.25].mean() for t in shown]
            print(f"{name} at t = {shown} s\n  shallow water  ", " ".join(f"{h:.3f}" for h in means), f" lowest {middle.min():.3f}, highest {middle.max():.3f}", flush=True)
            for absorbing in arguments.absorbing.split(","):
                path = pathlib.Path(folder) / "case.toml"
                path.write_text(case(length, depth, level, end, **other).replace("ABSORBING", absorbing))
                options = [part for setting in arguments.settings for part in ("--set", setting)]
                subprocess.run([PROGRAM, "run", path, "--out", f"{folder}/run", "--force", "--quiet", "-n", "1", *options], check=True)
                values = tables.frame(f"{folder}/run/probes/depth.csv").iloc[:, 0]
                means = [values[t - 0.25:t + 0.25].mean() for t in shown]
                print(f"  absorbing {absorbing:5}", " ".join(f"{h:.3f}" for h in means), f" lowest {values.min():.3f}, highest {values.max():.3f}", flush=True)


if __name__ == "__main__":
    main()
