#!/usr/bin/python3
"""Runs a sloshing tank for a given elapsed time and judges whether anything drifts.

A tank of 1 m with 0.3 m of water is shaken for as long as --minutes say. Every few seconds the memory, the CPU time and
the step of the program are read. The first fifth is left out, since the water settles. Of what remains, the last third
is compared with the first:

  memory         the last third's median of the resident memory, over the first's: at most 1.02
  cost per step  the same for the median of CPU time per step: at most 1.10
  mass           fluid particles inside the walls at the end: all of the start, none outside, none out
  level          mean of both probes over each third: at most 0.1 dx apart, and 0.25 dx from the still water's level
  energy         mean of kinetic + potential energy over each third: at most 0.2 % of m g depth/2 apart, and the
                 largest rise that walls do not explain over the whole run: at most 1 % of it
  swing          rms of the surface at the left probe over the last third, over the first's: 0.8 to 1.25, for a flow
                 that dies or grows would be a drift too

    scripts/long_run.py --minutes 60 --out long_run
"""

import argparse
import csv
import json
import os
import pathlib
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent

DEPTH, SPACING, DENSITY, GRAVITY, LENGTH = 0.3, 0.02, 1000.0, 9.81, 1.0
CASE = f"""\
[parameters]
L = {LENGTH}      # length of the tank, m
depth = {DEPTH}  # of the water, m
swing = 0.01   # amplitude of the tank, m
omega = 3.5    # rad/s; the first mode of the water has 4.8
[case]
title = "Sloshing tank"
[physics]
density = {DENSITY}
gravity = [0, -{GRAVITY}]
[particles]
spacing = {SPACING}
[[fluid]]
min = [0, 0]
max = ["L", "depth"]
[[wall]]
name = "tank"
points = [[0, "2*depth"], [0, 0], ["L", 0], ["L", "2*depth"]]
displacement = ["swing*(1 - cos(omega*t))", 0]
[time]
end = 100000
[output]
fields_interval = 10
checkpoint_interval = 60
[[probe]]
name = "left"
type = "depth"
at = [0.2, 0]
interval = 0.02
[[probe]]
name = "right"
type = "depth"
at = [0.8, 0]
interval = 0.02
"""


def last_step(out):
    """The last whole line of steps.csv; 0 before there is one."""
    path = out / "steps.csv"
    if not path.exists():
        return 0
    with open(path, "rb") as file:
        file.seek(max(0, path.stat().st_size - 2000))
        lines = file.read().decode().split("\n")[:-1]
    field = lines[-1].split(",")[1] if lines else "step"
    return 0 if field == "step" else int(float(field))


def sample(process, out):
    """(resident memory in bytes, CPU seconds, step) now; nothing when the process is gone."""
    try:
        stat = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return None
    return (int(stat[21]) * os.sysconf("SC_PAGE_SIZE"),
            (int(stat[11]) + int(stat[12])) / os.sysconf("SC_CLK_TCK"), last_step(out))


def watch(program, out, minutes, period):
    """Runs the tank; the samples of it."""
    case = out.parent / f"{out.name}.toml"
    case.write_text(CASE)
    command = [program, "run", case, "--out", out, "--quiet", "-n", "1", "--wall-time", f"{60 * minutes:.0f}s"]
    process = subprocess.Popen(command)
    samples = []
    while process.poll() is None:
        now = sample(process, out)
        if now is not None and now[2] > 0:
            samples.append(now)
        time.sleep(period)
    if process.returncode != 130:
        sys.exit(f"long_run: exit code {process.returncode} instead of 130, which the end of --wall-time gives")
    return samples


def thirds(values):
    """The first and the last third of what follows the first fifth."""
    kept = values[len(values) // 5:]
    return kept[:len(kept) // 3], kept[-(len(kept) // 3):]


def column(path, *names):
    """The sums of these columns of a table, line by line."""
    with open(path, newline="") as file:
        return [sum(float(line[name]) for name in names) for line in csv.DictReader(file)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/release/bin/tailwater", type=pathlib.Path)
    parser.add_argument("--minutes", type=float, default=60.0, help="of wall-clock time")
    parser.add_argument("--every", type=float, default=2.0, help="s; between looks at the process")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder of the run, which must not exist")
    options = parser.parse_args()
    if options.out.exists():
        sys.exit(f"long_run: {options.out} exists; name another folder")

    samples = watch(options.program.resolve(), options.out, options.minutes, options.every)
    if len(samples) < 30:
        sys.exit(f"long_run: only {len(samples)} samples; run for longer")
    out = options.out
    summary = json.loads((out / "summary.json").read_text())
    water = summary["water_balance"]
    scale = water["start"]["mass_kg"] * GRAVITY * DEPTH / 2

    memory = [statistics.median(third) for third in thirds([bytes_ for bytes_, _, _ in samples])]
    costs = [(b[1] - a[1]) / (b[2] - a[2]) for a, b in zip(samples, samples[1:]) if b[2] > a[2]]
    cost = [statistics.median(third) for third in thirds(costs)]
    probes = [column(out / "probes/left.csv", "connected_m"), column(out / "probes/right.csv", "connected_m")]
    levels = [statistics.fmean(third) for third in thirds([(a + b) / 2 for a, b in zip(*probes)])]
    swings = [statistics.pstdev(third) for third in thirds(probes[0])]
    energies = [statistics.fmean(third) for third in thirds(column(out / "steps.csv", "kinetic_J", "potential_J"))]
    lost = water["start"]["particles"] - water["inside"]["particles"]

    rows = [
        ("memory, last third / first", memory[1] / memory[0], memory[1] <= 1.02 * memory[0], "<= 1.02"),
        ("CPU time per step, last third / first", cost[1] / cost[0], cost[1] <= 1.10 * cost[0], "<= 1.10"),
        ("particles not inside at the end", lost, lost == 0, "0"),
        ("level, last third - first, dx", (levels[1] - levels[0]) / SPACING,
         abs(levels[1] - levels[0]) <= 0.1 * SPACING, "within 0.1"),
        ("level - still water, dx", (levels[1] - DEPTH) / SPACING, abs(levels[1] - DEPTH) <= 0.25 * SPACING,
         "within 0.25"),
        ("energy, (last third - first) / (m g depth/2)", (energies[1] - energies[0]) / scale,
         abs(energies[1] - energies[0]) <= 0.002 * scale, "within 0.002"),
        ("largest rise of the energy / (m g depth/2)", summary["energy"]["largest_rise_J"] / scale,
         summary["energy"]["largest_rise_J"] <= 0.01 * scale, "<= 0.01"),
        ("swing, last third / first", swings[1] / swings[0], 0.8 <= swings[1] / swings[0] <= 1.25, "0.8 to 1.25"),
    ]
    print(f"{summary['cost']['wall_clock_s'] / 60:.1f} min, {summary['steps']['count']} steps to t = "
          f"{summary['time_s']['reached']:.1f} s, {memory[1] / 1e6:.1f} MB, {1000 * cost[1]:.2f} ms per step, "
          f"commit {summary['commit']}")
    for name, value, is_good, bound in rows:
        print(f"{'ok    ' if is_good else 'MISSED'}  {name:48} {value:10.3g}   {bound}")
    sys.exit(0 if all(is_good for _, _, is_good, _ in rows) else 1)


if __name__ == "__main__":
    main()
