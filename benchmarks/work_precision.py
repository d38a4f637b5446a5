#!/usr/bin/python3
"""The cost of an error: dam breaks by Tailwater and other codes, each at several spacings, against the laboratory.

Usage: benchmarks/work_precision.py [--case zhou|box|weir] [--dx SPACING]... [--program FILE] [--dfsph FILE] [--json FILE]
                                    [--picture FILE.webp] [--from FILE.json]

Runs the codes that are there, one after the other, on one core each. For each run: CPU seconds and errors.
zhou, in 2D, the codes of beside.py to 1.5 s, before the water falls back on itself and air would count:
  pressure  RMS difference of the wall pressure at z = 0.12 m over T = 2.4..6, over rho g H, at the best shift of time
            within the laboratory's uncertainty, mean over both readings of its curve
  impulse   its integral over the same time, relative difference
  level     RMS difference of the wire gauge H1 to T = 6, over H
  noise     RMS of the pressure about its running median over 0.02 s, over rho g H; a code without noise has 0
The laboratory is not exact: two people who read its curves differ by the lines of the picture.
box, in 3D, SPHERIC's benchmark 2, Tailwater and interFoam to 2 s:
  impulse   at P1 to P4 over t = 0.4..1 s, mean relative difference
  arrival   at P1 to P4, mean difference, s
  level     mean difference of the water levels H2 and H4, over H
weir, in 2D, the template of `tailwater new weir`, Tailwater and interFoam to 8 s:
  head      relative difference from Rehbock's formula, mean of the second half
--from draws and prints an earlier file again. The picture of the documentation:
    benchmarks/work_precision.py --json validation/tailwater_validation/work_precision.json \\
                                 --picture docs/images/work_precision.webp
    scripts/picture_record.py docs/images/work_precision.webp
The tables of the documentation are of such files; those of other flows end in _box.json and _weir.json.
"""
import argparse
import json
import pathlib
import shutil
import sys
import tempfile

import numpy as np

import beside
import box_precision
import weir_precision

ROOT = beside.ROOT
import matplotlib  # noqa: E402
from PIL import Image  # noqa: E402
from tailwater import plots  # noqa: E402
from tailwater.curves import Curve, read_curve  # noqa: E402
from tailwater_validation.curves import best_shift, rms_difference  # noqa: E402
from tailwater_validation.studies import zhou1999  # noqa: E402

END = 1.5  # s
SPACINGS = (0.03, 0.02, 0.015)  # m
READERS = ("openmps", "fluidity")
WINDOW, LEVEL_WINDOW = (2.4, 6.0), (0.0, 6.0)  # T
ERRORS = {"pressure": ("pressure at z = 0.12 m", "RMS / ρgH"), "impulse": ("impulse at z = 0.12 m", "relative error"),
          "level": ("water level H1", "RMS / H"), "noise": ("noise of the pressure", "RMS / ρgH")}
OTHER_FLOWS = {"box": box_precision, "weir": weir_precision}
GRIDS = {1: (1, 1), 3: (1, 3), 4: (2, 2)}  # rows and columns of plots
COLOURS = {"Tailwater": plots.BLUE, "interFoam": plots.ORANGE, "SISPH": plots.SKY, "WCSPH": plots.GREY, "DFSPH": plots.BLACK}


def measured(quantity):
    """The laboratory's curve over T, as its two readers have it."""
    scale = zhou1999.PRESSURE_SCALE if quantity == "P2" else zhou1999.H
    column = "value_Pa" if quantity == "P2" else "value_m"
    folder = ROOT / "cases/zhou1999/data"
    return [read_curve(folder / f"zhou1999_{quantity}_{reader}.csv", column, "t_s").scaled(1 / zhou1999.TIME_SCALE, 1 / scale)
            for reader in READERS]


def impulse(curve):
    """Mean over the window, over rho g H."""
    times = np.linspace(*WINDOW, 721)
    return float(np.interp(times, curve.time, curve.value).mean())


def pressure_error(laboratory, computed):
    return best_shift(laboratory, computed, *WINDOW, zhou1999.GRID, zhou1999.TIME_UNCERTAINTY)[1]


def errors_of(run, case):
    """{error: value} of a finished run."""
    readings = run.result
    times = readings.times / zhou1999.TIME_SCALE
    pressure = Curve.from_samples(times, readings.pressure / zhou1999.PRESSURE_SCALE)
    found = {"pressure": np.mean([pressure_error(curve, pressure) for curve in measured("P2")]),
             "impulse": np.mean([abs(impulse(pressure) / impulse(curve) - 1) for curve in measured("P2")]),
             "noise": beside.noise(run, case)}
    if readings.level is not None:
        level = Curve.from_samples(times, readings.level / zhou1999.H)
        found["level"] = np.mean([rms_difference(curve, level, *LEVEL_WINDOW, zhou1999.GRID) for curve in measured("H1")])
    return {name: float(value) for name, value in found.items()}


def between_readers():
    """{error: value} of one reader's curve against the other's."""
    pressure, level = measured("P2"), measured("H1")
    return {"pressure": pressure_error(*pressure), "impulse": abs(impulse(pressure[0]) / impulse(pressure[1]) - 1),
            "level": rms_difference(*level, *LEVEL_WINDOW, zhou1999.GRID)}


def runs_of_zhou(dx, options, folder):
    """(name, Code, done or None, message, errors) of each code."""
    case = beside.zhou(dx, END)
    for name, code in beside.available_codes("zhou", case, options, folder).items():
        done, message = beside.attempt(name, code)
        yield name, code, done, message, errors_of(done, case) if done else {}


def runs_of(flow, dx, options, folder):
    """(name, Code, done or None, message, errors) of each code, for the flow of a module."""
    for name, code in flow.codes(dx, options, folder).items():
        done, message = beside.attempt(name, code)
        yield name, code, done, message, flow.errors_of(done) if done else {}


def record(name, code, done, message, errors):
    """A run in the JSON file."""
    found = {"code": name, "settings": code.settings, "chosen_by": code.chosen_by, "command": code.command,
             "finished": done is not None, "message": message}
    return found if done is None else found | {"fluid_particles": done.fluid, "steps": done.steps, "cpu_s": done.cpu,
                                               "simulated_s": done.simulated, "errors": errors}


def measure(options):
    """All runs, as the JSON file has them."""
    runs = []
    flow = OTHER_FLOWS.get(options.case)
    with tempfile.TemporaryDirectory() as folder:
        for dx in options.dx or (flow.SPACINGS if flow else SPACINGS):
            place = pathlib.Path(folder)
            for one in runs_of(flow, dx, options, place) if flow else runs_of_zhou(dx, options, place):
                runs.append(record(*one) | {"spacing_m": dx})
                print(line(runs[-1]), flush=True)
    return beside.provenance(options) | {"case": options.case, "end_s": flow.END if flow else END,
                                         "between_readers": flow.BETWEEN if flow else between_readers(), "runs": runs}


def line(run):
    if not run["finished"]:
        return f"{run['code']:9}  {run['spacing_m']:5g} m  did not finish: {run['message']}"
    errors = "  ".join(f"{name} {value:.4f}" for name, value in run["errors"].items())
    return f"{run['code']:9}  {run['spacing_m']:5g} m  {run['cpu_s']:8.1f} CPU s  {errors}"


def draw(told, path):
    with matplotlib.rc_context(plots.STYLE):
        figure = plots.new_figure(width=8.5, height=5.2)
        errors = OTHER_FLOWS[told["case"]].ERRORS if told["case"] in OTHER_FLOWS else ERRORS
        for axes, (error, (title, unit)) in zip(figure.subplots(*GRIDS[len(errors)], sharex=True, squeeze=False).flat, errors.items()):
            for code, colour in COLOURS.items():
                points = [(run["cpu_s"], run["errors"][error]) for run in told["runs"]
                          if run["code"] == code and run["finished"] and error in run["errors"]]
                if points:
                    axes.loglog(*zip(*points), "o-", color=colour, label=code, linewidth=1.3, markersize=4)
            if error in told["between_readers"]:
                axes.axhline(told["between_readers"][error], color=plots.BLACK, linewidth=0.8, linestyle=":",
                             label="between two readings of the laboratory")
            axes.set(title=title, ylabel=unit)
        for axes in figure.axes[-GRIDS[len(errors)][1]:]:
            axes.set_xlabel("CPU seconds")
        figure.get_layout_engine().set(rect=(0, 0.06, 1, 0.94))  # leaves space for the legend
        figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="lower center", ncol=6, frameon=False)
        with tempfile.TemporaryDirectory() as folder:
            figure.savefig(f"{folder}/picture.png", dpi=plots.DPI)
            Image.open(f"{folder}/picture.png").convert("RGB").save(path, quality=85, method=6)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--case", default="zhou", choices=("zhou", *OTHER_FLOWS))
    parser.add_argument("--dx", type=float, action="append", help="m, may be repeated (three spacings)")
    parser.add_argument("--program", default=ROOT / "build/release/bin/tailwater")
    parser.add_argument("--dfsph", metavar="FILE", default=shutil.which("SPHSimulator"))
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="write figures, settings and commands there")
    parser.add_argument("--picture", type=pathlib.Path, metavar="FILE.webp")
    parser.add_argument("--from", dest="source", type=pathlib.Path, metavar="FILE.json", help="run nothing, read this file")
    options = parser.parse_args()
    if options.source:
        told = json.loads(options.source.read_text(encoding="utf-8"))
        print("\n".join(line(run) for run in told["runs"]))
    else:
        told = measure(options)
    if options.json:
        options.json.write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")
    if options.picture:
        draw(told, options.picture)
    return 0


if __name__ == "__main__":
    sys.exit(main())
