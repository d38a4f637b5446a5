#!/usr/bin/python3
"""Time per step by number of particles and ranks: docs/scaling.csv and the table of docs/scaling.md.

Runs the first steps of the Zhou dam break, from a jittered start, twice with different ends: the difference is free of
start and end. Needs a machine that does nothing else.
Usage: scripts/scaling_study.py [--ranks 1,2] [--steps N] [--csv FILE] PARTICLES ...
"""
import argparse
import csv
import json
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build/release/bin/tailwater"
CASE = ROOT / "cases/zhou1999/case.toml"
WATER = 1.2 * 0.6  # m^2
COURANT, REFERENCE_SPEED = 0.25, (2 * 9.81 * 0.6) ** 0.5  # the first steps are all this long
SHORT = 5  # steps that are not counted
COLUMNS = {  # of the file, with what the table shows of them
    "fluid": "{:.0f}", "particles": "{:.0f}", "ranks": "{:.0f}", "seconds_per_step": "{:.3f}",
    "microseconds_per_particle": "{:.2f}", "speed_up": "{:.2f}", "exchange_share": "{:.1%}", "reduction_share": "{:.1%}",
    "iterations_per_step": "{:.1f}", "bytes_per_step": "{:.3g}", "messages_per_step": "{:.0f}",
    "memory_bytes_per_particle": "{:.0f}"}


def first_steps(particles, ranks, steps, settings, out):
    """Summary of a run of about `steps` steps."""
    spacing = (WATER / particles) ** 0.5
    end = (steps - 0.5) * COURANT * spacing / REFERENCE_SPEED
    values = {"particles.spacing": spacing, "particles.jitter": 0.1, "time.end": end,
              "output.fields_interval": 2 * end}
    command = [PROGRAM, "run", CASE, "--out", out, "--force", "--quiet", "-n", str(ranks)]
    for setting in [f"{key}={value}" for key, value in values.items()] + settings:
        command += ["--set", setting]
    subprocess.run(command, check=True)
    return json.loads((pathlib.Path(out) / "summary.json").read_text())


def measure(particles, ranks, options, folder):
    short, long = (first_steps(particles, ranks, steps, options.set, f"{folder}/run")
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
            "memory_bytes_per_particle": long["cost"]["peak_memory_bytes"] / count}


def whole_numbers(text):
    return [int(float(number)) for number in text.split(",")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("particles", nargs="+", type=lambda text: int(float(text)))
    parser.add_argument("--ranks", type=whole_numbers, default=[1, 2], help="as in 1,2,4")
    parser.add_argument("--steps", type=int, default=20, help="counted")
    parser.add_argument("--csv", type=pathlib.Path)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    options = parser.parse_args()
    rows = []
    print("| " + " | ".join(COLUMNS) + " |\n" + "| --- " * len(COLUMNS) + "|")
    with tempfile.TemporaryDirectory() as folder:
        for particles in options.particles:
            alone = None
            for ranks in options.ranks:
                row = measure(particles, ranks, options, folder)
                alone = alone or row["seconds_per_step"] * options.ranks[0]
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
