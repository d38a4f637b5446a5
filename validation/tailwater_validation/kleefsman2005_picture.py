"""The picture of a run of cases/kleefsman2005: the water in perspective at three times, pressures and heights over the
laboratory's."""

import matplotlib
import numpy as np

from tailwater.fields import nearest_frames

from . import kleefsman2005, pictures, plots, scene
from .picture import finish_axes, save_page
from .run_folder import RunFolder
from .surface import water_surface

MOMENTS = (0.5, 0.9, 2.0)  # s
LOOK_FROM = (1.6, -1.6, 1.1)  # at the face that the water meets
COMPUTED = {"color": plots.BLUE, "linewidth": 1.2, "zorder": 3}
HIGHEST = {"color": plots.ORANGE, "linewidth": 0.9, "linestyle": (0, (2, 1.2)), "zorder": 2}
MEASURED = {"color": plots.BLACK, "linewidth": 1.0, "zorder": 4}
PRESSURE_WINDOW = (0.3, 1.3)  # s; shown
HIGHEST_SHOWN = 1.3  # of the highest measured pressure: a spike of a few steps must not squeeze the curves


def draw_pressure(axes, run, sensor):
    measured, computed = kleefsman2005.laboratory(sensor), kleefsman2005.computed(run, sensor)
    start, end = PRESSURE_WINDOW
    axes.plot(measured.time, measured.value / 1000, label="laboratory", **MEASURED)
    highest = computed.window(start, end).value.max(initial=0.0) / 1000
    top = HIGHEST_SHOWN * measured.window(start, end).value.max() / 1000
    axes.plot(computed.time, computed.value / 1000, **COMPUTED,
              label="computed" + (f" (highest {highest:.1f} kPa)" if highest > top else ""))
    axes.set(xlim=PRESSURE_WINDOW, ylim=(-0.05 * top, top), xlabel="$t$ (s)", ylabel="pressure (kPa)")
    axes.set_title(f"{sensor}, z = {kleefsman2005.SENSORS[sensor]:g} m", loc="left")
    finish_axes(axes)


def draw_height(axes, run, gauge, end):
    measured = kleefsman2005.laboratory(gauge)
    axes.plot(measured.time, measured.value, label="laboratory", **MEASURED)
    for column, style, label in (("connected_m", COMPUTED, "computed, joined with the bed"),
                                 ("highest_m", HIGHEST, "computed, highest water")):
        curve = kleefsman2005.computed(run, gauge, column)
        axes.plot(curve.time, curve.value, label=label, **style)
    axes.set(xlim=(0, end), ylim=(0, None), xlabel="$t$ (s)", ylabel="height (m)")
    axes.set_title(gauge, loc="left")
    finish_axes(axes)


def draw_page(run, frames):
    end = kleefsman2005.end_of(run)
    figure = plots.new_figure(11.0, 12.0)
    head, scenes, pressures, heights = figure.subfigures(4, 1, height_ratios=(0.35, 2.6, 2.6, 4.6))
    head.text(0.01, 0.7, "Dam break against a box, Kleefsman et al. (2005)", fontsize=12.5, va="center")
    head.text(0.01, 0.15, f"Tailwater, dx = {run.spacing:.3g} m, {frames[0].position.shape[0]} particles, "
              f"{run.integrator} projection; the water's surface coloured by speed, 0 to 4 m/s", fontsize=9.5,
              color="#444444", va="center")
    window = scene.Scene(pictures.bounds_of(frames, [pictures.walls_at(run, 0.0)]), LOOK_FROM, width=560)
    for axes, frame in zip(scenes.subplots(1, len(frames)), frames):
        image = window.draw(water_surface(frame, run.spacing, ("velocity",)), pictures.walls_at(run, frame.time),
                            colours=matplotlib.colormaps[pictures.COLOURS], field="velocity", limits=(0, 4))
        axes.imshow(image)
        axes.set_axis_off()
        axes.set_title(f"$t$ = {frame.time:.2f} s", fontsize=9)
    for axes, sensor in zip(pressures.subplots(1, 4), kleefsman2005.SENSORS):
        draw_pressure(axes, run, sensor)
    for axes, gauge in zip(np.ravel(heights.subplots(2, 2)), kleefsman2005.GAUGES):
        draw_height(axes, run, gauge, end)
    return figure


def draw(run_folder, image):
    """Draws the picture of a run into `image` (its suffix chooses the format). Throws DataError."""
    run = RunFolder(run_folder)
    save_page(image, draw_page, run, nearest_frames(run_folder, MOMENTS))
