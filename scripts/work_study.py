#!/usr/bin/python3
"""Cost of a row per step, in pairs: a weight of src/neighbours/neighbourhood.cpp, docs/scaling.md.

CPU time per step and particle of periodic vortices at several supports gives the cost of a row and of a pair.
Usage: scripts/work_study.py    needs build/release/bin/tailwater
"""
import json
import math
import pathlib
import subprocess
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build/release/bin/tailwater"
VORTEX = ROOT / "cases/robustness/taylor_green.toml"
QUICK_SOLVE = ["pressure_solver.preconditioner=ssor", "pressure_solver.tolerance=0.1"]  # iterations vary


def seconds_per_step(case, settings, short, long):
    """CPU seconds per step between the end times `short` and `long`, least of three, and the summary."""
    costs = []
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(3):
            runs = []
            for end in (short, long):
                command = [PROGRAM, "run", case, "--out", f"{folder}/run", "--force", "--quiet", "-n", "1",
                           "--set", f"time.end={end}", "--set", "output.fields_interval=1e6"]
                for setting in settings:
                    command += ["--set", setting]
                subprocess.run(command, check=True)
                runs.append(json.loads((pathlib.Path(folder) / "run/summary.json").read_text()))
            first, last = runs
            costs.append((last["cost"]["cpu_s"] - first["cost"]["cpu_s"]) /
                         (last["steps"]["count"] - first["steps"]["count"]))
    return min(costs), last


def main():
    rows = []
    for support in (2.4, 3.0, 4.0):
        cost, run = seconds_per_step(VORTEX, ["particles.spacing=0.005", "particles.jitter=0.1",
                                              f"study.support={support}", *QUICK_SOLVE], 0.003, 0.02)
        pairs = math.pi * support**2 - 1
        rows.append((pairs, cost / run["particles"]["fluid"]))
        print(f"vortex, support {support} dx: {pairs:.1f} pairs, {1e6 * rows[-1][1]:.2f} us per particle and step")
    per_pair, per_row = np.polyfit(*np.array(rows).T, 1)
    print(f"a pair {1e9 * per_pair:.0f} ns, a row {per_row / per_pair:.1f} pairs")


if __name__ == "__main__":
    main()
