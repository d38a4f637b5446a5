"""The picture of a run of cases/zhou1999: pressure-coloured particles at four times, and gauges over the laboratory's.

Colours are Okabe and Ito's for curves and viridis for the field: both read well with any colour vision and in grey.
"""

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

from tailwater.fields import nearest_frames

from . import plots, zhou1999
from .curves import DataError
from .plots import BLACK, BLUE, GREY, ORANGE, STYLE
from .run_folder import RunFolder

FRAME_TIMES = (1.6, 3.0, 5.0, 6.6)  # T: collapse, run-up, fall, overturning on the water ahead
COMPUTED = {"color": BLUE, "linewidth": 1.3, "zorder": 3}
HIGHEST = {"color": ORANGE, "linewidth": 0.9, "linestyle": (0, (2, 1.2)), "zorder": 2}
MEASURED = {
    "openmps": {"color": BLACK, "marker": "o", "markersize": 2.6, "linestyle": "none", "zorder": 4},
    "fluidity": {"markeredgecolor": GREY, "markerfacecolor": "white", "markeredgewidth": 0.8, "marker": "s",
                 "markersize": 3.4, "linestyle": "none", "zorder": 1},
}
MEASURED_LABEL = {"openmps": "laboratory (read by OpenMPS)", "fluidity": "laboratory (read by Fluidity)"}

# Layout in inches: columns from the left, rows from the top. Two columns of particles; the colour bar right of them.
WIDTH, LEFT, COLUMN, COLUMN_GAP, BAR_GAP, BAR = 11.0, 0.72, 4.42, 0.36, 0.14, 0.15
HEAD, ROW_GAP, PRESSURE_HEAD, PRESSURE, DEPTH_HEAD, DEPTH, FOOT = 0.72, 0.18, 1.25, 2.0, 0.85, 1.65, 0.52
LOWEST_VIEW, HIGHEST_VIEW = 0.75, 1.45  # m: limits of the height that the particle pictures show


def view_height(frames):
    """Height (m) that shows the water of all frames, but not for the sake of a few drops."""
    reach = max(np.percentile(frame.position[:, 1], 99.7) for frame in frames)
    return float(np.clip(1.08 * reach, LOWEST_VIEW, HIGHEST_VIEW))


def draw_particles(axes, frame, run, view, largest_pressure, label="", exaggeration=1):
    """One particle picture coloured up to `largest_pressure` (Pa), with `label` at its top; `exaggeration` is that of
    heights. Returns the dots."""
    if "pressure" not in frame.fields:
        raise DataError(f"the field files hold no pressure, only {', '.join(frame.fields)}: "
                        'add "pressure" to output.fields')
    dots = plots.draw_particles(axes, frame.position, run.spacing, exaggeration, array=frame.fields["pressure"] / 1000,
                                cmap="viridis", clim=(0, largest_pressure / 1000))
    plots.draw_walls(axes, run)
    axes.set(xlim=view[0], ylim=view[1], aspect=exaggeration)
    axes.text(0.5, 0.95, label, transform=axes.transAxes, ha="center", va="top", fontsize=10,
              bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.5}, zorder=4)
    return dots


def mark_gauges(axes, top):
    """Where the laboratory measured: the two levels and the pressure plate on the right wall."""
    for name, x in (("H2", 2.228), ("H1", 2.725)):
        axes.plot([x, x], [0, 0.62 * top], color=GREY, linewidth=0.8, linestyle=(0, (4, 2)), zorder=1)
        axes.text(x, 0.64 * top, name, ha="center", va="bottom", color=GREY, fontsize=8.5)
    axes.plot([3.22, 3.22], [0.115, 0.205], color=ORANGE, linewidth=4.5, solid_capstyle="butt", zorder=5)
    axes.text(3.16, 0.16, "P2", ha="right", va="center", color=ORANGE, fontsize=8.5, zorder=5)


def draw_gauge(axes, quantity, scale, computed, end):
    """Measured points over T, multiplied by `scale`, with the computed curves [(curve, style, label)]."""
    for digitisation in zhou1999.DIGITISATIONS:
        measured = zhou1999.laboratory(quantity, digitisation).window(0, end)
        axes.plot(measured.time, measured.value * scale, label=MEASURED_LABEL[digitisation], **MEASURED[digitisation])
    for curve, style, label in computed:
        axes.plot(curve.time, curve.value * scale, label=label, **style)
    axes.set_xlim(0, end)
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.set_xlabel(r"$T = t\,\sqrt{g/H}$")


def draw_time_uncertainty(axes, x, y):
    """A bar as wide as the laboratory's time zero is uncertain. x is T; y a share of the height of the axes."""
    transform = axes.get_xaxis_transform()
    axes.errorbar([x], [y], xerr=zhou1999.TIME_UNCERTAINTY, color=BLACK, capsize=2.5, linewidth=1, transform=transform)
    axes.text(x + 1.8 * zhou1999.TIME_UNCERTAINTY, y, "time of the data: ±0.03 s", va="center", fontsize=8,
              transform=transform)


def draw_pressure(axes, run, end):
    curve = zhou1999.pressure(run, "P2")
    scale = zhou1999.PRESSURE_SCALE / 1000
    # A spike of a few steps must not squeeze the curve that is compared; the legend tells of it.
    top = 1.15 * max(np.percentile(curve.value, 99.5), 0.9) * scale
    highest = curve.value.max() * scale
    label = "computed, mean over z = 0.115..0.205 m" + (f" (highest {highest:.1f} kPa)" if highest > top else "")
    point = zhou1999.POINT_HEIGHTS[zhou1999.READ_AT]
    draw_gauge(axes, "P2", scale, [(curve, COMPUTED, label),
                                   (zhou1999.pressure(run, zhou1999.READ_AT), HIGHEST, f"computed, z = {point:g} m")],
               end)
    draw_time_uncertainty(axes, 0.22, 0.36)
    axes.set_title("P2: pressure on the right wall", loc="left")
    axes.set_ylabel("pressure (kPa)")
    axes.set_ylim(-0.9, top)
    axes.legend(loc="upper left", frameon=False)
    seconds = axes.secondary_xaxis("top", functions=(lambda time: time * zhou1999.TIME_SCALE,
                                                     lambda time: time / zhou1999.TIME_SCALE))
    seconds.set_xlabel("$t$ (s)")


def draw_depth(axes, run, gauge, place, end):
    computed = [(zhou1999.depth(run, gauge), COMPUTED, "computed, length under water"),
                (zhou1999.depth(run, gauge, "highest_m"), HIGHEST, "computed, highest water")]
    draw_gauge(axes, gauge, zhou1999.H, computed, end)
    axes.set_title(f"{gauge}: water depth, x = {place} m", loc="left")
    axes.set_ylim(0, 1.0)


class Page:
    """A figure on which axes are placed in inches from the upper left corner."""

    def __init__(self, height):
        self.height = height
        self.figure = plt.figure(figsize=(WIDTH, height))

    def axes(self, left, top, width, height):
        return self.figure.add_axes([left / WIDTH, 1 - (top + height) / self.height, width / WIDTH,
                                     height / self.height])

    def text(self, left, top, text, **style):
        self.figure.text(left / WIDTH, 1 - top / self.height, text, va="center", **style)

    def head(self, title, run, frame):
        """Two lines: the experiment, and with what it was computed."""
        self.text(LEFT, 0.25, title, fontsize=12.5)
        self.text(LEFT, 0.5, f"Tailwater, dx = {run.spacing:.3g} m, {frame.position.shape[0]} particles, "
                  f"{run.integrator} projection", fontsize=9.5, color="#444444")

    def pressure_bar(self, dots, left, top, height):
        bar = self.figure.colorbar(dots, cax=self.axes(left, top, BAR, height), extend="max")
        bar.set_label("pressure (kPa)")


def finish_axes(axes):
    """Grid and legend of a plot of curves."""
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.legend(frameon=False)


def draw_page(run, frames):
    corners = np.array([point for chain in run.walls for point in chain])
    margin = 0.03
    view = ((corners[:, 0].min() - margin, corners[:, 0].max() + margin),
            (corners[:, 1].min() - margin, view_height(frames)))
    inches_per_metre = COLUMN / (view[0][1] - view[0][0])
    row_height = (view[1][1] - view[1][0]) * inches_per_metre
    particles = 2 * row_height + ROW_GAP
    both_columns = 2 * COLUMN + COLUMN_GAP
    end = run.case["time"]["end"] / zhou1999.TIME_SCALE

    page = Page(HEAD + particles + PRESSURE_HEAD + PRESSURE + DEPTH_HEAD + DEPTH + FOOT)
    page.head("Dam break of a 1.2 m x 0.6 m column, Zhou, De Kat and Buchner (1999)", run, frames[0])
    for k, frame in enumerate(frames):
        row, column = divmod(k, 2)
        axes = page.axes(LEFT + column * (COLUMN + COLUMN_GAP), HEAD + row * (row_height + ROW_GAP), COLUMN, row_height)
        dots = draw_particles(axes, frame, run, view, zhou1999.PRESSURE_SCALE,
                              f"$T$ = {frame.time / zhou1999.TIME_SCALE:.1f}   ($t$ = {frame.time:.2f} s)")
        axes.spines[["left", "bottom"]].set_visible(False)
        axes.tick_params(length=2.5, labelbottom=row == 1, labelleft=column == 0)
        axes.set_xlabel("x (m)" if row == 1 else "", labelpad=1)
        axes.set_ylabel("y (m)" if column == 0 else "")
        if k == 0:
            mark_gauges(axes, view[1][1])
    page.pressure_bar(dots, LEFT + both_columns + BAR_GAP, HEAD, particles)

    top = HEAD + particles + PRESSURE_HEAD
    draw_pressure(page.axes(LEFT, top, both_columns, PRESSURE), run, end)
    top += PRESSURE + DEPTH_HEAD
    for k, (gauge, place) in enumerate((("H2", 2.228), ("H1", 2.725))):
        axes = page.axes(LEFT + k * (COLUMN + COLUMN_GAP), top, COLUMN, DEPTH)
        draw_depth(axes, run, gauge, place, end)
        if k == 0:
            axes.set_ylabel("depth (m)")
            axes.legend(loc="upper left", frameon=False)
        else:
            axes.tick_params(labelleft=False)
    return page.figure


def save_page(image, draw_page, *arguments):
    """Draws a page in the style of all pictures into `image` (its suffix chooses the format)."""
    with plt.rc_context(STYLE):
        figure = draw_page(*arguments)
        figure.savefig(image, dpi=160)
        plt.close(figure)


def draw_zhou1999(run_folder, image):
    """Draws the picture of a run into `image` (its suffix chooses the format). Throws DataError."""
    run = RunFolder(run_folder)
    frames = nearest_frames(run_folder, [T * zhou1999.TIME_SCALE for T in FRAME_TIMES])
    save_page(image, draw_page, run, frames)
