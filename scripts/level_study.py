#!/usr/bin/python3
"""Levels at open ends beside shallow-water theory: the table "Levels" of docs/theory/open_ends.md.

Usage: scripts/level_study.py [--absorbing 0,0.3,1] [--set KEY=VALUE ...] [NAME ...]

Needs build/release/bin/tailwater (scripts/build.sh). All of it takes some two minutes on one core. Runs the cases of
cases/openings, each with several values of `absorbing`, and prints the depth at the gauge. The reference is the solution of
the shallow-water equations with a level that is held at any instant (validation/tailwater_validation/openings.py).
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile
import tomllib

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "validation")]
from tailwater.run import Run  # noqa: E402
from tailwater_validation.openings import THEORIES, depth_at_gauge  # noqa: E402

PROGRAM = ROOT / "build/release/bin/tailwater"
HALF = 0.25  # s, of the time over which a depth is averaged

# name: case of cases/openings, settings, times (s) at which the depth is shown
ROWS = {
    "drain": ("draining_tank", (), (3, 5, 10, 15, 20)),
    "rise": ("changing_level", (), (1, 2, 3, 5, 7)),
    "fall": ("changing_level", ("parameters.H=0.7", "parameters.change=-0.4", "parameters.within=4"), (2, 4, 6, 7)),
    "tide": ("tide", (), (12, 15, 20, 24)),
    "discharge ends": ("ending_discharge", (), (3, 6, 10, 15, 24)),
    "rising sea": ("rising_sea", (), (3, 5, 7)),
    "still": ("changing_level", ("parameters.H=0.5", "parameters.change=0", "time.end=10"), (1, 5, 9)),
}


def show(label, times, depths, shown):
    means = " ".join(f"{depths[np.abs(times - t) < HALF].mean():.3f}" for t in shown)
    print(f"  {label:14} {means}  lowest {depths.min():.3f}, highest {depths.max():.3f}", flush=True)


def run_case(case, settings, folder):
    words = [word for setting in settings for word in ("--set", setting)]
    subprocess.run([PROGRAM, "run", case, "--out", folder, "--force", "--quiet", "-n", "1", *words], check=True)
    return Run(folder)


def show_row(name, case, settings, shown, absorbing, folder):
    path = ROOT / "cases" / "openings" / f"{case}.toml"
    outlet = tomllib.loads(path.read_text(encoding="utf-8"))["outlet"][0]["name"]
    print(f"{name} at t = {shown} s")
    for k, share in enumerate(absorbing):
        run = run_case(path, (*settings, f"outlet.{outlet}.absorbing={share}"), folder)
        curve, gauge = depth_at_gauge(run)
        if k == 0:
            theory = THEORIES[case.replace("_", "-")](run.parameters)
            show("shallow water", curve.time, theory.depths(run, curve.time, gauge), shown)
        show(f"absorbing {share}", curve.time, curve.value, shown)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--absorbing", default="0,0.3,1")
    parser.add_argument("--set", action="append", default=[], dest="settings")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(ROWS))
    arguments = parser.parse_args()
    unknown = [name for name in arguments.names if name not in ROWS]
    if unknown:
        parser.error(f"there is no row {unknown[0]!r}; choose from {', '.join(ROWS)}")
    print(f"depth at the gauge, m; means over {2 * HALF:g} s")
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments.names or ROWS:
            case, settings, shown = ROWS[name]
            show_row(name, case, (*settings, *arguments.settings), shown, arguments.absorbing.split(","), f"{folder}/run")


if __name__ == "__main__":
    main()
