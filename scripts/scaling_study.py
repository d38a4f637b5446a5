#!/usr/bin/python3
"""Time per step by number of particles and ranks: the tables of docs/scaling.md.

Runs the first steps of the Zhou dam break, from a jittered start, twice with different ends: the difference is free of
start and end. Prints for each size and number of ranks the time per step, the speed-up over one rank, the shares of
exchanges and of sums over ranks (both with waiting), iterations and memory. Needs a machine that does nothing else.
Usage: scripts/scaling_study.py [--ranks 1,2] [--steps N] PARTICLES ...   needs build/release/bin/tailwater
"""
import argparse
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


def per_step(short, long, read):
    return (read(long) - read(short)) / (long["steps"]["count"] - short["steps"]["count"])


def numbers(list_of_numbers):
    return [int(float(number)) for number in list_of_numbers.split(",")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("particles", nargs="+", type=lambda text: int(float(text)))
    parser.add_argument("--ranks", type=numbers, default=[1, 2], help="as in 1,2,4")
    parser.add_argument("--steps", type=int, default=20, help="counted")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    options = parser.parse_args()
    print("| fluid | all particles | ranks | s per step | us per particle | speed-up | exchange | sums | iterations | "
          "MB sent per step | messages per step | bytes per particle |")
    print("| --- " * 12 + "|")
    with tempfile.TemporaryDirectory() as folder:
        for particles in options.particles:
            alone = None
            for ranks in options.ranks:
                short, long = (first_steps(particles, ranks, steps, options.set, f"{folder}/run")
                               for steps in (SHORT, SHORT + options.steps))
                wall = per_step(short, long, lambda run: run["cost"]["wall_clock_s"])
                alone = alone or wall * options.ranks[0]
                count = long["particles"]["fluid"] + long["particles"]["wall"]
                told = long["ranks"]
                iterations = per_step(short, long, lambda run: run["pressure_solver"]["iterations"])
                sent = [per_step(short, long, lambda run: run["ranks"].get(name, 0)) for name in ("bytes", "messages")]
                print(f"| {long['particles']['fluid']} | {count} | {ranks} | {wall:.3f} | {1e6 * wall / count:.2f} | "
                      f"{alone / wall:.2f} | {100 * told.get('exchange_share', 0):.1f} % | "
                      f"{100 * told.get('reduction_share', 0):.1f} % | {iterations:.1f} | {1e-6 * sent[0]:.2f} | "
                      f"{sent[1]:.0f} | {long['cost']['peak_memory_bytes'] / count:.0f} |", flush=True)


if __name__ == "__main__":
    main()
