#!/usr/bin/python3
"""Cost of the pressure solve by depth and preconditioner: the tables of docs/theory/linear.md.

Runs the first steps of the Zhou dam break (2D) and of a column of 20 x 20 particles that collapses in a box twice as
wide (3D), and prints, for each solver, iterations per solve and CPU microseconds per particle and step (everything in
the step included; the rest of the step costs the same for all solvers).
Usage: scripts/solver_study.py [ROWS ...]   rows of particles the water is deep; needs build/release/bin/tailwater
(scripts/build.sh)
"""
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build/release/bin/tailwater"
SOLVERS = ["ssor", "cell-multigrid", "boomeramg"]
STEPS = 20
COURANT = 0.25
DX_3D = 0.01  # m
WIDTH_3D = 0.2  # m


def dam_break_2d(rows):
    """Case, depth [m] and settings of water so many rows deep."""
    return ROOT / "cases/zhou1999/case.toml", 0.6, {"particles.spacing": 0.6 / rows}


def column_3d(rows):
    depth = rows * DX_3D
    return ROOT / "cases/robustness/tank_3d.toml", depth, {
        "particles.spacing": DX_3D,
        "particles.jitter": 0,
        "fluid[0].max": f"[{WIDTH_3D}, {WIDTH_3D}, {depth:g}]",
        "wall[0].max": f"[{2 * WIDTH_3D}, {WIDTH_3D}, {depth + 0.1:g}]",
    }


def first_steps(case, depth, settings, preconditioner, out):
    """Summary of a run of about STEPS steps."""
    end = STEPS * COURANT * float(settings["particles.spacing"]) / (2 * 9.81 * depth) ** 0.5
    settings = settings | {
        "time.end": end,
        "output.fields_interval": 2 * end,
        "pressure_solver.preconditioner": preconditioner,
    }
    command = [PROGRAM, "run", case, "--out", out, "--force", "--quiet", "-n", "1"]
    for key, value in settings.items():
        command += ["--set", f"{key}={value}"]
    subprocess.run(command, check=True)
    return json.loads((pathlib.Path(out) / "summary.json").read_text())


def main():
    depths = [int(argument) for argument in sys.argv[1:]] or [25, 50, 100, 200]
    print("| case | rows deep | particles | solver | iterations per solve | CPU us per particle and step |")
    print("| --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for name, make in (("2D", dam_break_2d), ("3D", column_3d)):
            for rows in depths:
                for preconditioner in SOLVERS:
                    summary = first_steps(*make(rows), preconditioner, f"{folder}/run")
                    particles = summary["particles"]["fluid"] + summary["particles"]["wall"]
                    iterations = summary["pressure_solver"]["iterations_per_solve"]
                    microseconds = 1e6 * summary["cost"]["cpu_s"] / summary["steps"]["count"] / particles
                    print(f"| {name} | {rows} | {particles} | {preconditioner} | {iterations:.1f} | "
                          f"{microseconds:.1f} |", flush=True)


if __name__ == "__main__":
    main()
