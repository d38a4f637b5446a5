#!/usr/bin/python3
"""Readings of pressure probes when a dam break hits a wall: the table of docs/theory/probes.md, section First contact.

At the foot of the wall of Zhou's dam break, at a point and as the mean over 90 mm: the largest pressure over rho g H, how
long it took to rise from a tenth of that, the largest mean over 20 ms, and the impulse of the first 0.15 s.

Usage: scripts/contact_study.py [ROWS ...]   rows of particles in the column; needs build/release/bin/tailwater; a minute
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "python"))
from tailwater import tables  # noqa: E402

PROGRAM = ROOT / "build/release/bin/tailwater"
CASE = ROOT / "cases/zhou1999/case.toml"
PROBES = """
[[probe]]
name = "point"
type = "wall-pressure"
at = ["tank", 0.0]

[[probe]]
name = "area"
type = "wall-pressure-mean"
from = ["tank", 0.0]
to = ["tank", 0.09]
"""
SCALE = 1000 * 9.81 * 0.6  # Pa; rho g H
CONTACT = 0.05 * SCALE  # Pa; the wall is wet from this on
LENGTH, WINDOW = 0.15, 0.02  # s


def impact(time, pressure, impulse):
    """(largest pressure and largest mean over WINDOW, Pa; rise, s; impulse of LENGTH from contact on, Pa s)."""

    def between(start, end):
        return np.interp(end, time, impulse) - np.interp(start, time, impulse)

    peak = int(np.argmax(pressure))
    rise = time[peak] - time[:peak][pressure[:peak] < 0.1 * pressure[peak]][-1]
    contact = time[np.argmax(pressure > CONTACT)]
    return pressure[peak], max(between(t, t + WINDOW) for t in time[time < time[-1] - WINDOW]) / WINDOW, rise, between(
        contact, contact + LENGTH)


def main():
    print("| dx | reading | largest | rise, ms | largest mean over 20 ms | impulse of 0.15 s, kPa s |")
    print("| --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "case.toml"
        text = CASE.read_text()
        path.write_text(text[:text.index("[[measurement]]")] + PROBES)
        for rows in [int(argument) for argument in sys.argv[1:]] or (15, 30, 60):
            subprocess.run([PROGRAM, "run", path, "--out", f"{folder}/run", "--force", "--quiet", "--set", "time.end=0.85",
                            "--set", f"particles.spacing=H/{rows}"], check=True)
            for name in ("point", "area"):
                table = tables.frame(f"{folder}/run/probes/{name}.csv")
                largest, mean, rise, impulse = impact(table.index.to_numpy(), table["pressure_Pa"].to_numpy(),
                                                      table["impulse_Pa_s"].to_numpy())
                print(f"| H/{rows} | {name} | {largest / SCALE:.2f} | {1000 * rise:.1f} | {mean / SCALE:.2f} | "
                      f"{impulse / 1000:.3f} |", flush=True)


if __name__ == "__main__":
    main()
