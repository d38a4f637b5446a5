#!/usr/bin/python3
"""How open ends hold their level: the table of docs/theory/open_ends.md, section Measured.

Usage: scripts/level_study.py [NAME ...]   needs build/release/bin/tailwater (scripts/build.sh); all of it takes a minute
"""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "python"))
from tailwater import tables  # noqa: E402

PROGRAM = ROOT / "build/release/bin/tailwater"
CHANNEL = ROOT / "cases/flume/channel.toml"
RISE = '"0.4 + 0.3*min(1, t/3)"'
RISE_OF_BASIN = '"0.5 + 0.3*min(1, t/5)"'


def tank(length, depth, level, end, side="outlet", spacing=0.05, top=1.0, scheme=""):
    """A 2D tank with one open end, or (without water) a channel from a reservoir to a free brink."""
    left = side == "inlet"
    walls = [[0, 0], [length, 0]]
    if depth:
        walls = walls + [[length, 1.5]] if left else [[0, 1.5]] + walls
    x = 0 if left else length
    water = f"[[fluid]]\nmin = [0, 0]\nmax = [{length}, {depth}]\n" if depth else ""
    brink = "" if depth else f"[[outlet]]\nfrom = [{length}, 0]\nto = [{length}, {top}]\nlevel = 0.0\n"
    return (f"[particles]\nspacing = {spacing}\n[time]\nend = {end}\n{scheme}{water}[[wall]]\npoints = {walls}\n"
            f'fluid_side = "left"\n[[{side}]]\nfrom = [{x}, 0]\nto = [{x}, {top}]\nlevel = {level}\n{brink}'
            f'[[probe]]\nname = "depth"\ntype = "depth"\nat = [{length / 2}, 0]\n'
            f'[[probe]]\nname = "discharge"\ntype = "discharge"\nfrom = [{length / 2}, 0]\nto = [{length / 2}, {top}]\n')


TWO_STEP = '[scheme]\nname = "farmani2020"\n'
IMPLICIT = '[scheme]\nintegrator = "implicit"\n'
CASES = {  # what it is, the case, options, the probe, the times [s] at which it is shown
    "filling tank": (tank(1, 0.5, 0.9, 40), [], "depth", (4, 10, 20, 40)),
    "basin": (tank(2, 0.5, RISE_OF_BASIN, 20, "inlet"), [], "depth", (5, 6, 7, 9, 20)),
    "rising tailwater": (tank(1, 0.4, RISE, 7), [], "depth", (1, 2, 3, 4, 7)),
    "rising tailwater, implicit": (tank(1, 0.4, RISE, 7, scheme=IMPLICIT), [], "depth", (1, 2, 3, 4, 7)),
    "rising tailwater, two-step": (tank(1, 0.4, RISE, 7, scheme=TWO_STEP), [], "depth", (1, 2, 3, 4, 7)),
    "rising tailwater, H/16": (tank(1, 0.4, RISE, 7, spacing=0.025), [], "depth", (1, 2, 3, 4, 7)),
    "falling tailwater": (tank(1, 0.7, '"0.7 - 0.4*min(1, t/4)"', 8), [], "depth", (1, 2, 4, 6, 8)),
    "still tank": (tank(1, 0.5, 0.5, 10), [], "depth", (1, 5, 10)),
    "reservoir": (tank(3, 0, 0.4, 12, "inlet", 0.04), [], "discharge", (6, 9, 12)),
    "discharge ends": (None, ["particles.spacing=H/8", "time.end=30", "inlet[0].discharge=q*max(0, 1 - t/5)"],
                       "depth_downstream", (3, 6, 10, 15, 20, 29)),
    "even flow, depth": (None, ["particles.spacing=H/8"], "depth_downstream", (2, 5, 9)),
    "even flow, discharge": (None, ["particles.spacing=H/8"], "discharge", (2, 5, 9)),
}


def main():
    print("| case | mean over 0.5 s around a time | least, largest | mean of the second half |")
    print("| --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for name, (case, settings, probe, times) in CASES.items():
            if sys.argv[1:] and name not in sys.argv[1:]:
                continue
            path = pathlib.Path(folder) / "case.toml"
            path.write_text(case or CHANNEL.read_text())
            options = [part for setting in settings for part in ("--set", setting)]
            subprocess.run([PROGRAM, "run", path, "--out", f"{folder}/run", "--force", "--quiet", "-n", "1", *options], check=True)
            values = tables.frame(f"{folder}/run/probes/{probe}.csv").iloc[:, 0]
            shown = ", ".join(f"{values[t - 0.25:t + 0.25].mean():.3f} at {t} s" for t in times)
            second_half = values[values.index[-1] / 2:].mean()
            print(f"| {name} | {shown} | {values.min():.3f}, {values.max():.3f} | {second_half:.5f} |", flush=True)


if __name__ == "__main__":
    main()
