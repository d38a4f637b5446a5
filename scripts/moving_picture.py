#!/usr/bin/python3
"""A moving picture of a 2D run: particles coloured by pressure, a frame for each field file.

Usage: scripts/moving_picture.py RUN OUT.gif
The one of the README:
    build/release/bin/tailwater run cases/zhou1999/case.toml --out out/film --set output.fields_interval=0.02 --set time.end=2
    scripts/moving_picture.py out/film docs/images/dam_break.gif
"""
import io
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "python"))
import matplotlib  # noqa: E402

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402

import picture_record  # noqa: E402
from tailwater import Run, plots  # noqa: E402
from tailwater.fields import list_frames, read_frame  # noqa: E402

WIDTH, DPI, COLOURS = 6.4, 100, 40  # inches, dots per inch, of the whole picture
SLOWER = 2.0  # than the water


def draw(run, frame, view, largest):
    """A frame as an image; `largest` (Pa) is the pressure of the brightest colour."""
    figure = plt.figure(figsize=(WIDTH, WIDTH * view.ratio), dpi=DPI)
    axes = figure.add_axes((0, 0, 1, 1))
    plots.draw_particles(axes, frame.position, run.spacing, view.exaggeration, array=frame.fields["pressure"],
                         cmap="viridis", clim=(0, largest))
    plots.draw_walls(axes, run, frame.time)
    view.apply(axes)
    axes.set_axis_off()
    axes.text(0.03, 0.95, f"{frame.time:.2f} s", transform=axes.transAxes, va="top", fontsize=11, color=plots.GREY)
    png = io.BytesIO()
    figure.savefig(png, format="png")
    plt.close(figure)
    return Image.open(png).convert("RGB")


def main(arguments):
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    run = Run(arguments[0])
    frames = [read_frame(time, path) for time, path in list_frames(run.path)]
    largest = np.percentile(np.concatenate([frame.fields["pressure"] for frame in frames]), 99)
    view = plots.View(run, frames)
    images = [draw(run, frame, view, largest) for frame in frames]
    palette = Image.fromarray(np.concatenate([np.asarray(image) for image in images[::8]])).quantize(COLOURS)
    pictures = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
    spacing = 1000 * SLOWER * (frames[-1].time - frames[0].time) / max(1, len(frames) - 1)
    pictures[0].save(arguments[1], save_all=True, append_images=pictures[1:], duration=round(spacing), loop=0, optimize=True)
    picture_record.write(arguments[1])
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
