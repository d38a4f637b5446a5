"""The dam break against a box in 3D (SPHERIC 2) for work_precision.py: codes, and their errors against the laboratory."""

import argparse
import pathlib
import shutil
import subprocess

import beside
import interfoam
import interfoam_box
import numpy as np
from tailwater import Run
from tailwater.errors import DataError
from tailwater_validation.studies import kleefsman2005 as box

END = 2.0  # s: the water has hit the box and the wall behind it, and falls back
SPACINGS = (0.05, 0.55 / 15, 0.55 / 20)  # m
ERRORS = {"impulse": ("impulse at P1 to P4", "mean relative error"), "arrival": ("arrival at P1 to P4", "mean error, s"),
          "level": ("water levels H2 and H4", "mean error / H")}
BETWEEN = {}  # The laboratory has one reading.


def errors_of(done):
    """{error: value}; impulses and arrivals are missing where the water does not reach a sensor."""
    run = done.result
    found = {"level": np.mean([box.mean_error(run, gauge, END) / 100 for gauge in box.HEIGHT_BARS]),
             "impulse": np.mean([abs(box.excess(box.of_impact, run, sensor)) / 100 for sensor in box.SENSORS])}
    try:
        found["arrival"] = np.mean([abs(box.arrival(box.computed(run, sensor)) - box.arrival(box.laboratory(run, sensor)))
                                    for sensor in box.SENSORS])
    except DataError:
        pass
    return {name: float(value) for name, value in found.items()}


def tailwater(program, dx, settings, folder):
    words = [word for each in (f"particles.spacing={dx}", f"time.end={END}", *settings) for word in ("--set", each)]
    out = folder / f"box_{dx:g}"
    subprocess.run([program, "run", beside.ROOT / "cases/kleefsman2005/case.toml", "--out", out, "--force", "--quiet", "-n", "1",
                    *words], check=True)
    return beside.done_by_tailwater(out, Run(out))


def foam(dx, folder):
    case = interfoam_box.Box(argparse.Namespace(case="kleefsman2005", out=pathlib.Path(folder) / f"foam_{dx:g}", dx=dx,
                                                turbulence="none", air_density=1.2, surface_tension=0.0, walls="slip"))
    case.end = END
    case.run()
    log = case.folder / "log.interFoam"
    water = round(1.228 * box.DEPTH / dx**3)
    return beside.Done(interfoam.cpu_seconds(log), END, water, interfoam.count_steps(log), case)


def codes(dx, options, folder):
    """{name: Code} of Tailwater and the other codes that are installed."""
    words = "".join(f" --set {setting}" for setting in options.set)
    found = {"Tailwater": beside.Code(f"defaults{words}", "Tailwater",
                                      f"tailwater run cases/kleefsman2005/case.toml --set particles.spacing={dx:g}",
                                      lambda: tailwater(options.program, dx, options.set, folder))}
    if shutil.which("interFoam"):
        found["interFoam"] = beside.Code("Courant number 0.4, vanLeer, linearUpwind, PISO of 3 corrections; water and air; free walls",
                                         "Tailwater", f"benchmarks/interfoam_box.py FOLDER --dx {dx:g} --end {END:g}",
                                         lambda: foam(dx, folder))
    return found
