#!/usr/bin/python3
"""Cost of a program that also runs on other processors: docs/packages.md.

Usage: scripts/processor_study.py NATIVE OTHER...    programs built with -D TAILWATER_ARCH=native, x86-64-v3, x86-64-v2

Runs two dam breaks with each in turn, several times, and prints their CPU time in user mode over that of the first program in
the same round: the median, and the least and the most. On a busy machine that is nearer to the truth than seconds.
"""
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
ROUNDS = 7
CASES = {"2D": ("dam-break", ["particles.spacing=0.01", "time.end=0.2"]),
         "3D": (ROOT / "benchmarks/dam_break_3d.toml", ["parameters.d=0.05", "time.end=0.3"])}


def seconds(program, case, settings, folder):
    """CPU time of a whole run in user mode."""
    command = [program, "run", case, "--out", folder / "run", "--force", "--quiet"]
    for setting in settings:
        command += ["--set", setting]
    child = subprocess.Popen(command)
    _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(map(str, command))} ended with {status}")
    return usage.ru_utime


def name_of(program):
    """The processor that it is built for, by its own report."""
    told = subprocess.run([program, "info"], check=True, capture_output=True, text=True).stdout
    return told.partition("ARCH ")[2].partition(",")[0]


def main(programs):
    if len(programs) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    print(f"| case | {' | '.join(map(name_of, programs))} |\n|{' --- |' * (len(programs) + 1)}")
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        subprocess.run([programs[0], "new", "dam-break", folder / "dam-break"], check=True, capture_output=True)
        for label, (case, settings) in CASES.items():
            rounds = [[seconds(program, folder / case, settings, folder) for program in programs] for _ in range(ROUNDS)]
            cells = [f"{statistics.median(first for first, *_ in rounds):.2f} s"]
            for k in range(1, len(programs)):
                ratios = sorted(each[k] / each[0] for each in rounds)
                cells.append(f"{statistics.median(ratios):.2f} ({ratios[0]:.2f} to {ratios[-1]:.2f})")
            print(f"| {label} | {' | '.join(cells)} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
