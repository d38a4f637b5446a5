"""The picture of a run beside what its laboratory measured: the water at some moments, and below it the panels of the
case (module panels), as the page of `tailwater view` has them."""

import math

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from tailwater.fields import nearest_frames

from . import pictures, plots

COLUMNS = 2
PANEL = 2.6  # inches high
DPI = 160
STYLES = {"run": {"linewidth": 1.3, "zorder": 3},
          "aside": {"color": plots.GREY, "linewidth": 0.9, "linestyle": (0, (2, 1.2)), "zorder": 2},
          "measured": {"linestyle": "none", "markersize": 3, "zorder": 4}}
COLOURS = (plots.BLUE, plots.ORANGE, plots.SKY, "#009E73", "#CC79A7", plots.BLACK)  # Okabe and Ito's
MARKERS = ("o", "s", "^", "D", "v", "x")


def draw_panel(axes, panel):
    """Curves of a kind are told apart by their colours, measured ones by their markers."""
    seen = {}
    for curve in panel["curves"]:
        kind = curve["kind"]
        number = seen[kind] = seen.get(kind, -1) + 1
        style = dict(STYLES[kind])
        if kind == "run":
            style["color"] = COLOURS[number % len(COLOURS)]
        elif kind == "measured":
            style |= {"marker": MARKERS[number % len(MARKERS)], "color": plots.BLACK if number == 0 else plots.GREY}
        axes.plot(curve["x"], [np.nan if y is None else y for y in curve["y"]], label=curve["label"], **style)
    axes.set(xlabel=panel["x"], ylabel=panel["y"], ylim=panel["limits"])
    axes.set_title(panel["title"], loc="left")
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.legend(frameon=False)


def grid_of(figure, count, margin):
    """Axes in COLUMNS, with `margin` (inches) below each row. Placed by hand: layouts of many axes take long."""
    rows = math.ceil(count / COLUMNS)
    height = figure.bbox.height / figure.dpi
    grid = figure.subplots(rows, COLUMNS, squeeze=False, gridspec_kw={
        "left": 0.06, "right": 0.98, "wspace": 0.14, "top": 1 - 0.3 / height, "bottom": margin / height,
        "hspace": rows * margin / (height - rows * margin)}).ravel()
    for axes in grid[count:]:
        axes.set_axis_off()
    return grid[:count]


def draw_water(figure, run, frames, speed):
    """Coloured up to a speed (m/s)."""
    if run.dimension == 3:
        from . import pictures_3d, scene, surface  # VTK, which pictures in 2D do without

        window = scene.Scene(pictures_3d.bounds_of(frames, [pictures_3d.walls_at(run, 0.0)]), width=560)
        colours = matplotlib.colormaps[pictures.COLOURS] if speed > 0 else None
    else:
        view = plots.View(run, frames, crop=True)
    for axes, frame in zip(grid_of(figure, len(frames), 0.7), frames):
        axes.set_title(f"$t$ = {frame.time:.3g} s", loc="left")
        if run.dimension == 3:
            water = surface.water_surface(frame, run.spacing, ("velocity",))
            axes.imshow(window.draw(water, pictures_3d.walls_at(run, frame.time), colours=colours, field="velocity",
                                    limits=(0, speed)))
            axes.set_axis_off()
        else:
            pictures.draw_plane(axes, run, frame, view, speed)


def draw(run, image, moments, panels):
    """Into `image`, whose suffix chooses the format. Throws DataError."""
    frames = nearest_frames(run.path, moments)
    speed = pictures.highest_speed(frames)
    rows, panel_rows = (math.ceil(len(each) / COLUMNS) for each in (frames, panels))
    ratio = 0.6 if run.dimension == 3 else plots.View(run, frames, crop=True).ratio
    heights = [0.6, rows * (plots.WIDTH / COLUMNS * ratio + 0.7), panel_rows * PANEL]
    with matplotlib.rc_context(plots.STYLE):
        figure = Figure(figsize=(plots.WIDTH, sum(heights)))
        head, water, curves = figure.subfigures(3, 1, height_ratios=heights)
        head.text(0.01, 0.7, pictures.plain(run.case["case"]["title"]), fontsize=12.5, va="center")
        head.text(0.01, 0.2, f"Tailwater, dx = {run.spacing:.3g} m, {frames[0].position.shape[0]} particles, "
                  f"{run.integrator} projection; coloured by speed, 0 to {speed:.3g} m/s", fontsize=9.5, va="center")
        draw_water(water, run, frames, speed)
        for axes, panel in zip(grid_of(curves, len(panels), 0.8), panels):
            draw_panel(axes, panel)
        figure.savefig(image, dpi=DPI)
