#!/usr/bin/python3
"""Effect of the size of the time step: level, force and speed of ten flows with the default's steps and with short ones,
the table of docs/theory/robustness.md, section The largest step.

Usage: scripts/step_study.py [NAME ...]   needs build/release/bin/tailwater (scripts/build.sh); all of it takes ten minutes
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "validation")]
from tailwater import waves  # noqa: E402
from tailwater.run import Run  # noqa: E402
from tailwater_validation import exact_flows  # noqa: E402
from tailwater_validation.flume import steady_discharge, steady_mean  # noqa: E402

PROGRAM = ROOT / "build/release/bin/tailwater"
STEPS = (0.55, 0.2)  # dx that the fastest water goes in a step: the default, and one taken for zero
KINDS = ("level", "force", "speed")


def upstream(run):
    return {"level": (1000 * steady_mean(run, "upstream", "connected_m"), "mm")}


def gate(run):
    speed = steady_discharge(run, "discharge") / steady_mean(run, "jet", "connected_m")
    return {**upstream(run), "force": (steady_mean(run, "gate_force", "force_x_N_per_m"), "N/m"), "speed": (speed, "m/s")}


def solitary(run):
    wall, force = run.curve("wall", "connected_m"), run.curve("force", "force_x_N_per_m")
    return {"level": (1000 * wall.value.max(), "mm"), "force": (force.value.max(), "N/m"),
            "speed": (waves.solitary(run)["speed_m_per_s"], "m/s")}


def beach(run):
    return {"level": (1000 * run.curve("beach", "connected_m").value.max(), "mm")}


def box(run):
    path = run.curve("box", "displacement_y_m")
    found = exact_flows.FLOWS["floating-box"](run)
    return {"level": (1000 * path.window(0.5 * path.time[-1], path.time[-1]).value.mean(), "mm"),
            "speed": (found["period_s"], "s per swing")}


def jet(run):
    b, U = run.parameters["b"], run.parameters["U"]
    return {"force": (run.curve("p00", "pressure_Pa").window(5 * b / U, 8 * b / U).value.mean(), "Pa in the middle")}


def entry(run):
    force = run.curve("force", "force_y_N_per_m")
    end = force.time[-1]
    return {"force": (float(force.window(0.5 * end, end).value.mean()), "N/m")}


# Force on a plate of the dam break's wall, where the case reads its pressure.
ON_PLATE = """
[[probe]]
name = "plate"
type = "force"
walls = ["tank"]
region_min = ["tank-dx", 0.115]
region_max = ["tank+dx", 0.205]
"""


def dam_break(run):
    gauge, push, front = run.curve("H2", "connected_m"), run.curve("plate", "force_x_N_per_m"), run.curve("front", "front_m")
    arrival = float(np.interp(3.0, front.value, front.time))
    return {"level": (1000 * gauge.window(0.7, 1.0).value.mean(), "mm"),
            "force": (float(np.trapz(push.value, push.time)), "N s/m on the plate"),
            "speed": ((3.0 - 1.2) / arrival, "m/s")}


def wave(run):
    found = exact_flows.standing_wave(run)
    return {"speed": (100 * found["period_error"], "% of the period")}


CASES = {  # description, the case, its settings, its evaluation
    "ogee, Hd/8": ("flume/ogee", ["particles.spacing=Hd/8", "time.end=5"], upstream),
    "sharp crest, P/10": ("flume/weir", ["particles.spacing=P/10", "time.end=5"], upstream),
    "sluice gate, a/5": ("flume/sluice_gate", ["particles.spacing=a/5", "time.end=4"], gate),
    "solitary wave, h/8": ("solitary_wave/case", ["particles.spacing=h/8"], solitary),
    "run-up, h/8": ("flume/run_up", ["particles.spacing=h/8"], beach),
    "floating box, B/20": ("floating_box/case", ["particles.spacing=B/20", "parameters.up=B/20"], box),
    "jet on a plate, b/10": ("verification/jet", ["particles.spacing=b/10"], jet),
    "wedge entry, D/4": ("verification/wedge_entry", ["particles.spacing=D/4"], entry),
    "dam break, H/20": ("zhou1999/case", ["particles.spacing=H/20", "time.end=1.0"], dam_break),
    "standing wave, depth/10": ("robustness/standing_wave", ["particles.spacing=0.05"], wave),
}


def cell(found, kind):
    if kind not in found[0]:
        return ""
    (default, unit), (short, _) = (numbers[kind] for numbers in found)
    change = "" if unit.startswith("%") else f" ({100 * (default / short - 1):+.2f} %)"
    return f"{default:.4g}, {short:.4g} {unit}{change}"


def main():
    print(f"| steps of {STEPS[0]} and {STEPS[1]} dx | {' | '.join(KINDS)} |")
    print("| --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for name, (case, settings, read) in CASES.items():
            if sys.argv[1:] and name not in sys.argv[1:]:
                continue
            found = []
            text = (ROOT / f"cases/{case}.toml").read_text() + (ON_PLATE if read is dam_break else "")
            file = pathlib.Path(folder, "case.toml")
            file.write_text(text.replace('file = "', f'file = "{(ROOT / "cases" / case).parent}/'))
            for step in STEPS:
                options = [part for setting in (*settings, f"scheme.courant={step}") for part in ("--set", setting)]
                subprocess.run([PROGRAM, "run", file, "--out", f"{folder}/run", "--force", "--quiet",
                                *options], check=True)
                found.append(read(Run(f"{folder}/run")))
            print(f"| {name} | {' | '.join(cell(found, kind) for kind in KINDS)} |", flush=True)


if __name__ == "__main__":
    main()
