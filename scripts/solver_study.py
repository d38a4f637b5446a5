#!/usr/bin/python3
"""Cost of the pressure solve by size and preconditioner: the table of docs/theory/linear.md.

Runs the first steps of the Zhou dam break at several spacings and prints, for each solver, iterations per solve and
CPU milliseconds per time step (everything in the step included; the rest of the step costs the same for all solvers).
Usage: scripts/solver_study.py [SPACING ...]   needs build/release/bin/tailwater (scripts/build.sh)
"""
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build/release/bin/tailwater"
CASE = ROOT / "cases/zhou1999/case.toml"
SOLVERS = [("bicgstab", "ssor"), ("bicgstab", "ilu"), ("gmres", "boomeramg")]
STEPS = 30
COURANT, REFERENCE_SPEED = 0.25, (2 * 9.81 * 0.6) ** 0.5  # the first steps are all this long


def first_steps(spacing, method, preconditioner, out):
    """Summary of a run of about STEPS steps."""
    end = STEPS * COURANT * spacing / REFERENCE_SPEED
    settings = {
        "particles.spacing": spacing,
        "time.end": end,
        "output.fields_interval": 2 * end,
        "pressure_solver.method": method,
        "pressure_solver.preconditioner": preconditioner,
    }
    command = [PROGRAM, "run", CASE, "--out", out, "--force", "--quiet"]
    for key, value in settings.items():
        command += ["--set", f"{key}={value}"]
    subprocess.run(command, check=True)
    return json.loads((pathlib.Path(out) / "summary.json").read_text())


def main():
    spacings = [float(argument) for argument in sys.argv[1:]] or [0.024, 0.012, 0.006, 0.003, 0.0015]
    print("| unknowns | solver | iterations per solve | CPU ms per step |")
    print("| --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for spacing in spacings:
            for method, preconditioner in SOLVERS:
                summary = first_steps(spacing, method, preconditioner, f"{folder}/run")
                unknowns = summary["particles"]["fluid"] + summary["particles"]["wall"]
                iterations = summary["pressure_solver"]["iterations_per_solve"]
                milliseconds = 1e3 * summary["cost"]["cpu_s"] / summary["steps"]["count"]
                print(f"| {unknowns} | {method} + {preconditioner} | {iterations:.1f} | {milliseconds:.1f} |", flush=True)


if __name__ == "__main__":
    main()
