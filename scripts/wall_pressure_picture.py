#!/usr/bin/python3
"""The wall pressure of Zhou's dam break beside the laboratory's: the first picture of the README.

Usage: scripts/wall_pressure_picture.py RUN PICTURE    a .webp or .png file
The picture of the README and of the paper:
    build/release/bin/tailwater run cases/zhou1999/case.toml --out out/zhou
    scripts/wall_pressure_picture.py out/zhou docs/images/wall_pressure.webp
    scripts/wall_pressure_picture.py out/zhou paper/wall_pressure.png
"""
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "build/release/lib/python3/dist-packages"), str(ROOT / "python")]
import matplotlib  # noqa: E402
import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402
import picture_record  # noqa: E402
from tailwater import Run, plots  # noqa: E402

SCALE = 1000 * 9.81 * 0.6  # rho g H, Pa
READINGS = {"laboratory, read by OpenMPS": ("openmps", "o"), "laboratory, read by Fluidity": ("fluidity", "x")}


def reading(name):
    """Time (s) and pressure (Pa) of a digitised figure."""
    path = ROOT / f"cases/zhou1999/data/zhou1999_P2_{name}.csv"
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    columns = lines[0].split(",")
    rows = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    return rows[:, columns.index("t_s")], rows[:, columns.index("value_Pa")]


def main(arguments):
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    run = Run(arguments[0])
    with matplotlib.rc_context(plots.STYLE):
        figure = plots.new_figure(width=8.5, height=3.1)
        axes = figure.subplots()
        for label, (name, marker) in READINGS.items():
            time, pressure = reading(name)
            axes.plot(time, pressure / SCALE, marker, color=plots.GREY, markersize=3, markerfacecolor="none", label=label)
        for probe, height, colour in (("P120", "0.12", plots.BLUE), ("P160", "0.16", plots.ORANGE)):
            curve = run.curve(probe, "pressure_Pa")
            axes.plot(curve.time, curve.value / SCALE, color=colour, linewidth=1.3,
                      label=f"Tailwater, z = {height} m, every step, unfiltered")
        axes.set(xlabel="time (s)", ylabel="wall pressure / ρgH", xlim=(0.4, run.curve("P120", "pressure_Pa").time[-1]),
                 ylim=(-0.1, 1.2))
        axes.legend(loc="upper left", frameon=False)
        with tempfile.TemporaryDirectory() as folder:
            figure.savefig(f"{folder}/picture.png", dpi=plots.DPI)
            Image.open(f"{folder}/picture.png").convert("RGB").save(arguments[1], quality=85, method=6)
    picture_record.write(arguments[1])
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
