#!/usr/bin/python3
"""What Tailwater costs beside another code, and what both make of the flow: Zhou's dam break, the same spacing and end,
in turn, on one core each.

Usage: benchmarks/beside.py [--dx 0.015] [--end SECONDS] [--repeats N] [--program FILE] [--set KEY=VALUE]...

Prints CPU seconds per simulated second, their ratio to Tailwater's, and two numbers of the pressure on the wall 0.12 m
above the floor: its noise, the RMS about its running median over 0.02 s from 0.6 s on, over rho g H, and when the water
arrives, the first time that it is above 0.05 rho g H (in the laboratory 0.61 to 0.64 s). Times are of one machine and
hour: only ratios of one call tell something. Of several repeats the cheapest counts.

The other code is PySPH's SISPH (apt-get install python3-pysph), set as in PySPH's own example. Its first run compiles
its loops, which takes minutes and is not counted.
"""
import argparse
import csv
import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile
from dataclasses import dataclass

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
RHO_G_H = 1000.0 * 9.81 * 0.6  # Pa
WINDOW = 0.02  # s; of the running median
NOISY_FROM = 0.6  # s
ARRIVED = 0.05  # of rho g H


@dataclass
class Done:
    """What a code has taken and found."""

    cpu: float  # s
    simulated: float  # s
    fluid: int
    steps: int
    times: np.ndarray  # s
    pressure: np.ndarray  # Pa; on the wall

    @property
    def price(self):
        return self.cpu / self.simulated


def tailwater(program, dx, end, settings, folder):
    """Walls are free, as those of the other code."""
    command = [program, "run", ROOT / "cases/zhou1999/case.toml", "--out", f"{folder}/run", "--force", "--quiet",
               "-n", "1"]
    for setting in (f"particles.spacing={dx}", f"time.end={end}", "wall.tank.slip=free", *settings):
        command += ["--set", setting]
    subprocess.run(command, check=True)
    run = pathlib.Path(folder) / "run"
    summary = json.loads((run / "summary.json").read_text())
    rows = list(csv.DictReader(line for line in (run / "probes/P120.csv").open() if not line.startswith("#")))
    times, pressure = (np.array([float(row[name]) for row in rows]) for name in ("time_s", "pressure_Pa"))
    return Done(summary["cost"]["cpu_s"], summary["time_s"]["reached"], summary["particles"]["fluid"],
                summary["steps"]["count"], times, pressure)


def sisph(dx, end, folder):
    command = ["/usr/bin/python3", "-B", ROOT / "benchmarks/sisph_zhou.py", str(dx), str(end), f"{folder}/sisph"]
    told = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()[-1])
    times, pressure = np.array(told["pressure"]).T
    return Done(told["cpu_s"], told["simulated_s"], told["fluid"], told["steps"], times, pressure)


def noise(run):
    """Of rho g H; nothing if the run ends before the water arrives."""
    late = run.times >= NOISY_FROM
    if not late.any():
        return None
    around = [run.pressure[abs(run.times - time) <= WINDOW / 2] for time in run.times[late]]
    about_median = run.pressure[late] - [np.median(values) for values in around]
    return float(np.sqrt(np.mean(about_median**2))) / RHO_G_H


def arrival(run):
    """s; nothing if the run ends before."""
    arrived = np.flatnonzero(run.pressure > ARRIVED * RHO_G_H)
    return float(run.times[arrived[0]]) if len(arrived) else None


def or_dash(value, form):
    return "-" if value is None else format(value, form)


def show(name, run, price):
    print(f"{name:9}  {run.fluid:7} particles  {run.steps:6} steps  {run.price:9.2f} CPU s per simulated s"
          f"  ratio {run.price / price:6.2f}  noise {or_dash(noise(run), '.4f'):>6}"
          f"  arrival {or_dash(arrival(run), '.3f'):>5} s", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--dx", type=float, default=0.015)
    parser.add_argument("--end", type=float, default=1.4, help="simulated seconds (1.4)")
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--program", default=ROOT / "build/release/bin/tailwater")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    options = parser.parse_args()
    if importlib.util.find_spec("pysph") is None:
        print("error: PySPH is not installed; remedy: apt-get install python3-pysph", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as folder:
        sisph(0.1, 1e-3, folder)  # compiles
        pairs = [(tailwater(options.program, options.dx, options.end, options.set, folder),
                  sisph(options.dx, options.end, folder)) for _ in range(options.repeats)]
    ours, theirs = (min(runs, key=lambda run: run.price) for runs in zip(*pairs))
    show("Tailwater", ours, ours.price)
    show("SISPH", theirs, ours.price)
    return 0


if __name__ == "__main__":
    sys.exit(main())
