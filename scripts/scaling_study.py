#!/usr/bin/python3
"""Time per step by number of particles and ranks: docs/scaling.csv and the tables of docs/scaling.md.

Runs the first steps of the Zhou dam break (in 3D: of a tank at rest), from a jittered start, twice with different ends:
the difference is free of start and end. Numbers of ranks take turns, and the least of the repeats counts. Needs a
machine that does nothing else.
Usage: scripts/scaling_study.py [--ranks 1,2] [--steps N] [--repeats N] [--dimension 3] [--csv FILE] PARTICLES ...
"""
import argparse
import csv
import json
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build/release/bin/tailwater"
CASES = {2: ("zhou1999/case.toml", 1.2 * 0.6, 0.6), 3: ("robustness/tank_3d.toml", 0.5 * 0.3 * 0.3, 0.3)}  # water, depth
COURANT = 0.55  # scheme.courant's default
SHORT = 5  # steps that are not counted
COLUMNS = {  # of the file, with their format in the table
    "fluid": "{:.0f}", "particles": "{:.0f}", "ranks": "{:.0f}", "seconds_per_step": "{:.3f}",
    "microseconds_per_particle": "{:.2f}", "speed_up": "{:.2f}", "exchange_share": "{:.1%}", "reduction_share": "{:.1%}",
    "iterations_per_step": "{:.1f}", "bytes_per_step": "{:.3g}", "messages_per_step": "{:.0f}",
    "ghosts": "{:.0f}", "imbalance": "{:.1%}",
    "memory_bytes_per_particle": "{:.0f}"}


def first_steps(particles, ranks, steps, options, out):
    """Summary of a run of about `steps` steps."""
    case, water, depth = CASES[options.dimension]
    spacing = (water / particles) ** (1 / options.dimension)
    end = (steps - 0.5) * COURANT * spacing / (2 * 9.81 * depth) ** 0.5  # the first steps are all this long
    values = {"particles.spacing": spacing, "particles.jitter": 0.1, "time.end": end,
              "output.fields_interval": 2 * end}
    command = [PROGRAM, "run", ROOT / "cases" / case, "--out", out, "--force", "--quiet", "-n", str(ranks)]
    for setting in [f"{key}={value}" for key, value in values.items()] + options.set:
        command += ["--set", setting]
    subprocess.run(command, check=True)
    return json.loads((pathlib.Path(out) / "summary.json").read_text())


def measure(particles, ranks, options, folder):
    short, long = (first_steps(particles, ranks, steps, options, f"{folder}/run")
                   for steps in (SHORT, SHORT + options.steps))

    def per_step(read):
        return (read(long) - read(short)) / (long["steps"]["count"] - short["steps"]["count"])

    seconds = per_step(lambda run: run["cost"]["wall_clock_s"])
    count = long["particles"]["fluid"] + long["particles"]["wall"]
    return {"fluid": long["particles"]["fluid"], "particles": count, "ranks": ranks, "seconds_per_step": seconds,
            "microseconds_per_particle": 1e6 * seconds / count,
            "exchange_share": long["ranks"].get("exchange_share", 0.0),
            "reduction_share": long["ranks"].get("reduction_share", 0.0),
            "iterations_per_step": per_step(lambda run: run["pressure_solver"]["iterations"]),
            "bytes_per_step": per_step(lambda run: run["ranks"].get("bytes", 0)),
            "messages_per_step": per_step(lambda run: run["ranks"].get("messages", 0)),
            "ghosts": long["ranks"].get("ghosts", 0.0), "imbalance": long["ranks"].get("imbalance_largest", 0.0),
            "memory_bytes_per_particle": long["cost"]["peak_memory_bytes"] / count}


def whole_numbers(text):
    return [int(float(number)) for number in text.split(",")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("particles", nargs="+", type=lambda text: int(float(text)))
    parser.add_argument("--ranks", type=whole_numbers, default=[1, 2], help="as in 1,2,4")
    parser.add_argument("--steps", type=int, default=20, help="counted")
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--dimension", type=int, choices=CASES, default=2)
    parser.add_argument("--csv", type=pathlib.Path)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    options = parser.parse_args()
    rows = []
    print("| " + " | ".join(COLUMNS) + " |\n" + "| --- " * len(COLUMNS) + "|")
    with tempfile.TemporaryDirectory() as folder:
        for particles in options.particles:
            measured = [[measure(particles, ranks, options, folder) for ranks in options.ranks]
                        for _ in range(options.repeats)]
            alone = None
            for repeats in zip(*measured):
                row = min(repeats, key=lambda repeat: repeat["seconds_per_step"])
                ranks = row["ranks"]
                alone = alone or row["seconds_per_step"] * ranks
                row["speed_up"] = alone / row["seconds_per_step"]
                rows.append(row)
                print("| " + " | ".join(shown.format(row[name]) for name, shown in COLUMNS.items()) + " |", flush=True)
    if options.csv:
        with options.csv.open("w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS)
            writer.writeheader()
            writer.writerows(rows)


if __name__ == "__main__":
    main()
