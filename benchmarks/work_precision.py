#!/usr/bin/python3
"""The cost of an error: Zhou's dam break by Tailwater and other codes, each at several spacings, against the laboratory.

Usage: benchmarks/work_precision.py [--dx SPACING]... [--program FILE] [--dfsph FILE] [--json FILE] [--picture FILE.webp]
                                    [--from FILE.json]

Runs the codes of beside.py that are there, one after the other, on one core each, to 1.5 s, before the water falls back on
itself and air would count. For each run: CPU seconds and four errors:
  pressure  RMS difference of the wall pressure at z = 0.12 m over T = 2.4..6, over rho g H, at the best shift of time
            within the laboratory's uncertainty, mean over both readings of its curve
  impulse   its integral over the same time, relative difference
  level     RMS difference of the wire gauge H1 to T = 6, over H
  noise     RMS of the pressure about its running median over 0.02 s, over rho g H; a code without noise has 0
The laboratory is not exact: two people who read its curves differ by the lines of the picture.
--from draws and prints an earlier file again. The picture of the documentation:
    benchmarks/work_precision.py --json validation/tailwater_validation/work_precision.json \\
                                 --picture docs/images/work_precision.webp
"""
import argparse
import json
import pathlib
import shutil
import sys
import tempfile

import numpy as np

import beside

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
    times = run.times / zhou1999.TIME_SCALE
    pressure = Curve.from_samples(times, run.pressure / zhou1999.PRESSURE_SCALE)
    found = {"pressure": np.mean([pressure_error(curve, pressure) for curve in measured("P2")]),
             "impulse": np.mean([abs(impulse(pressure) / impulse(curve) - 1) for curve in measured("P2")]),
             "noise": beside.noise(run, case)}
    if run.level is not None:
        level = Curve.from_samples(times, run.level / zhou1999.H)
        found["level"] = np.mean([rms_difference(curve, level, *LEVEL_WINDOW, zhou1999.GRID) for curve in measured("H1")])
    return {name: float(value) for name, value in found.items()}


def between_readers():
    """{error: value} of one reader's curve against the other's."""
    pressure, level = measured("P2"), measured("H1")
    return {"pressure": pressure_error(*pressure), "impulse": abs(impulse(pressure[0]) / impulse(pressure[1]) - 1),
            "level": rms_difference(*level, *LEVEL_WINDOW, zhou1999.GRID)}


def measure(options):
    """All runs, as the JSON file has them."""
    runs = []
    with tempfile.TemporaryDirectory() as folder:
        for dx in options.dx or SPACINGS:
            case = beside.zhou(dx, END)
            for name, code in beside.available_codes("zhou", case, options, pathlib.Path(folder)).items():
                done, message = beside.attempt(name, code)
                found = beside.record(name, code, case, done, message) | {"spacing_m": dx}
                runs.append(found | ({"errors": errors_of(done, case)} if done else {}))
                print(line(runs[-1]), flush=True)
    return beside.provenance(options) | {"case": "zhou", "end_s": END, "between_readers": between_readers(), "runs": runs}


def line(run):
    if not run["finished"]:
        return f"{run['code']:9}  {run['spacing_m']:5g} m  did not finish: {run['message']}"
    errors = "  ".join(f"{name} {value:.4f}" for name, value in run["errors"].items())
    return f"{run['code']:9}  {run['spacing_m']:5g} m  {run['cpu_s']:8.1f} CPU s  {errors}"


def draw(told, path):
    with matplotlib.rc_context(plots.STYLE):
        figure = plots.new_figure(width=8.5, height=5.2)
        for axes, (error, (title, unit)) in zip(figure.subplots(2, 2, sharex=True).flat, ERRORS.items()):
            for code, colour in COLOURS.items():
                points = [(run["cpu_s"], run["errors"][error]) for run in told["runs"]
                          if run["code"] == code and run["finished"] and error in run["errors"]]
                if points:
                    axes.loglog(*zip(*points), "o-", color=colour, label=code, linewidth=1.3, markersize=4)
            if error in told["between_readers"]:
                axes.axhline(told["between_readers"][error], color=plots.BLACK, linewidth=0.8, linestyle=":",
                             label="between two readings of the laboratory")
            axes.set(title=title, ylabel=unit)
        for axes in figure.axes[2:]:
            axes.set_xlabel("CPU seconds")
        figure.get_layout_engine().set(rect=(0, 0.06, 1, 0.94))  # leaves space for the legend
        figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="lower center", ncol=6, frameon=False)
        with tempfile.TemporaryDirectory() as folder:
            figure.savefig(f"{folder}/picture.png", dpi=plots.DPI)
            Image.open(f"{folder}/picture.png").convert("RGB").save(path, quality=85, method=6)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--dx", type=float, action="append", help=f"m, may be repeated ({', '.join(map(str, SPACINGS))})")
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
