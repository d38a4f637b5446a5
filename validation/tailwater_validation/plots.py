"""Plots and particle pictures that all cases share.

Curves have Okabe and Ito's colours and different dashes, fields viridis: both read well with any colour vision and in
grey. Functions return a matplotlib figure, drawn under STYLE; sizes are in inches of a page that is WIDTH wide.
"""

import math

import matplotlib
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection
from matplotlib.figure import Figure

from tailwater.fields import nearest_frames

from .curves import DataError

BLUE, ORANGE, GREEN, PURPLE, SKY, YELLOW, BLACK, GREY = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9",
                                                         "#E69F00", "#000000", "#777777")
CYCLE = [{"color": color, "linestyle": dash} for color, dash in (
    (BLUE, "-"), (ORANGE, (0, (5, 1.5))), (GREEN, (0, (1.5, 1))), (PURPLE, (0, (6, 1.5, 1.5, 1.5))), (YELLOW, "-"),
    (SKY, (0, (5, 1.5))), (BLACK, (0, (1.5, 1))), (GREY, "-"))]
MEASURED = {"color": BLACK, "marker": "o", "markersize": 3.2, "linestyle": "none", "zorder": 4}
EXACT = {"color": BLACK, "linewidth": 1.0, "linestyle": (0, (1, 1.2)), "zorder": 4}
STYLE = {"font.size": 9, "axes.titlesize": 9.5, "axes.labelsize": 9, "legend.fontsize": 8, "axes.linewidth": 0.8,
         "axes.spines.top": False, "axes.spines.right": False, "svg.fonttype": "path", "axes.axisbelow": True}
DARK = "#063a5b"
WIDTH = 11.5
MOST_STRETCHED = 2  # exaggeration of heights up to which particles are drawn as discs
FLATTEST = 0.11  # height over width of a particle picture, below which its heights are exaggerated
SHOWN_SHARE = 99.7  # percent of the particles that a picture must show; the rest is spray
MOST_RUNS = 8  # in one plot
ARROWS = 16  # across the start of a flow that moves


def new_figure(width=WIDTH, height=3.0):
    return Figure(figsize=(width, height), layout="constrained")


def grid(axes):
    axes.grid(color="#dddddd", linewidth=0.6)


def run_label(run):
    return f"dx = {run.spacing * 1000:.3g} mm, {run.integrator}"


def labels(runs, names=None):
    """A label for each run that tells them apart: from `names` {folder's name: label} if given, else spacing and
    integrator, or the folder's name where those do not."""
    if names:
        return [names[run.path.name] for run in runs]
    short = [run_label(run) for run in runs]
    return short if len(set(short)) == len(short) else [run.path.name for run in runs]


# ------------------------------------------------------------------------------------------------ particle pictures


class View:
    """What part of the plane the pictures of some frames show, and by how much heights are exaggerated. Of a channel that
    goes on in front of the water, with `crop`, only a part."""

    def __init__(self, run, frames, crop=False, margin=0.02):
        water = np.concatenate([frame.position[:, :2] for frame in frames])
        corners = np.array([point for chain in run.walls for point in chain] or water)
        low, high = np.minimum(corners.min(0), water.min(0)), np.maximum(corners.max(0), water.max(0))
        if run.walls:  # walls are higher than the water goes
            high[1] = min(high[1], low[1] + 1.12 * (np.percentile(water[:, 1], SHOWN_SHARE) - low[1]))
        if crop:
            high[0] = min(high[0], water[:, 0].max() + 0.1 * np.ptp(water[:, 0]))
        pad = margin * (high[0] - low[0])
        self.x = (low[0] - pad, high[0] + pad)
        ratio = (high[1] - low[1]) / (high[0] - low[0])
        self.exaggeration = 1 if ratio > FLATTEST else math.ceil(FLATTEST / ratio)
        self.y = (low[1] - pad / self.exaggeration, high[1] + pad / self.exaggeration)

    @property
    def ratio(self):
        """Height over width, as drawn."""
        return self.exaggeration * (self.y[1] - self.y[0]) / (self.x[1] - self.x[0])

    def label_of_heights(self):
        return "y (m)" if self.exaggeration == 1 else f"y (m), {self.exaggeration} times higher"

    def apply(self, axes):
        axes.set(xlim=self.x, ylim=self.y, aspect=self.exaggeration)
        axes.spines[["left", "bottom"]].set_visible(False)
        axes.tick_params(length=2.5)


def draw_particles(axes, position, spacing, exaggeration=1, share=2**0.5, **style):
    """Each particle a disc of diameter `share` dx; by default it covers its share of the water. Where heights are
    exaggerated discs would be spikes: there each is a piece about dx high."""
    x, y = position[:, 0], position[:, 1]
    if exaggeration > MOST_STRETCHED:
        wide, high = max(share, 1.1), 1.1  # without cracks
        half = 0.5 * spacing * np.array([[-wide, -high], [wide, -high], [wide, high], [-wide, high]])
        dots = PolyCollection(np.stack([x, y], axis=1)[:, None, :] + half, linewidths=0, rasterized=True, zorder=2, **style)
    else:
        size = np.full(len(position), share * spacing)
        dots = EllipseCollection(size, size, np.zeros(len(position)), units="xy", offsets=position[:, :2],
                                 transOffset=axes.transData, linewidths=0, rasterized=True, zorder=2, **style)
    axes.add_collection(dots)
    return dots


def draw_walls(axes, run):
    axes.add_collection(LineCollection(run.walls, colors=BLACK, linewidths=1.6, capstyle="projecting", zorder=3))


def pressure_range(run, frames):
    """(lowest, highest) in kPa: that of the water at rest where there is gravity, else of nearly all particles."""
    if run.gravity > 0:
        height = np.ptp(frames[0].position[:, run.dimension - 1].astype(float)) + run.spacing
        return 0.0, run.density * run.gravity * height / 1000
    everything = np.concatenate([frame.fields["pressure"] for frame in frames[1:] or frames]) / 1000
    return tuple(np.percentile(everything, (100 - SHOWN_SHARE, SHOWN_SHARE)))


def moment(time, time_scale):
    return f"$t$ = {time:.3g} s" + ("" if time_scale is None else f"   ($T$ = {time / time_scale:.3g})")


def draw_moments(run, times, time_scale=None):
    """Particles coloured by pressure at several times (s); T = t over `time_scale`."""
    start, *frames = nearest_frames(run.path, (0.0, *times))
    view = View(run, [start, *frames], crop=True)
    columns = min(len(frames), 1 if view.ratio < 0.2 else 2 if view.ratio < 0.35 else 3)
    rows = math.ceil(len(frames) / columns)
    width = min((WIDTH - 1.2) / columns, 0.4 * WIDTH if columns > 1 or view.ratio > 0.2 else WIDTH)
    figure = new_figure(columns * width + 1.2, rows * (width * view.ratio + 0.42) + 0.3)
    every = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    low, high = pressure_range(run, [start, *frames])
    for axes in every.flat[len(frames):]:
        axes.set_visible(False)
    for axes, frame in zip(every.flat, frames):
        dots = draw_particles(axes, frame.position, run.spacing, view.exaggeration, cmap="viridis", clim=(low, high),
                              array=frame.fields["pressure"] / 1000)
        draw_walls(axes, run)
        view.apply(axes)
        axes.set_title(moment(frame.time, time_scale), fontsize=9)
    for axes in every[-1]:
        axes.set_xlabel("x (m)")
    for axes in every[:, 0]:
        axes.set_ylabel(view.label_of_heights())
    bar = figure.colorbar(dots, ax=every, extend="both" if low < 0 else "max", fraction=0.03, pad=0.01, aspect=12 * rows)
    bar.set_label("pressure (kPa)")
    return figure


def mark_probe(axes, probe, view):
    """Where a probe of the case measures, with its name."""
    height = view.y[1] - view.y[0]
    if probe["type"] == "depth":
        x = probe["at"][0]
        axes.plot([x, x], [view.y[0], view.y[0] + 0.86 * height], color=GREY, linewidth=0.9, linestyle=(0, (4, 2)),
                  zorder=4)
        axes.text(x, view.y[0] + 0.88 * height, probe["name"], ha="center", va="bottom", color=GREY, fontsize=8)
    elif probe["type"] == "wall-pressure-mean":
        axes.plot(*zip(probe["from"], probe["to"]), color=ORANGE, linewidth=4.5, solid_capstyle="butt", zorder=5)
        axes.annotate(probe["name"], np.mean([probe["from"], probe["to"]], axis=0), (-6, 0), ha="right", va="center",
                      textcoords="offset points", color=ORANGE, fontsize=8, zorder=5)
    elif probe["type"] == "wall-pressure":
        axes.plot(*probe["at"], color=ORANGE, marker="o", markersize=4, zorder=5)


def draw_start(run):
    """The geometry: water and walls at the start (those that will move in another colour), the gauges, and arrows where the
    water moves already."""
    frame, = nearest_frames(run.path, (0.0,))
    view = View(run, [frame])
    width = WIDTH - 0.8 if view.ratio < 0.3 else min(WIDTH / 2 - 1.0, 4.0 / view.ratio)
    figure = new_figure(width + 0.8, width * view.ratio + 0.6)
    axes = figure.subplots()
    draw_particles(axes, frame.position, run.spacing, view.exaggeration, 0.9, facecolors=SKY)
    draw_walls(axes, run)
    axes.add_collection(LineCollection(run.moving_walls, colors=ORANGE, linewidths=2, zorder=4))
    for probe in run.case.get("probe", []):
        mark_probe(axes, probe, view)
    velocity = frame.fields.get("velocity")
    if velocity is not None and np.abs(velocity).max() > 0:
        cells = np.floor(frame.position[:, :2] / (np.ptp(frame.position[:, 0]) / ARROWS)).astype(int)
        _, some = np.unique(cells, axis=0, return_index=True)  # one particle of each cell
        axes.quiver(*frame.position[some, :2].T, *velocity[some, :2].T, color=DARK, width=0.003, zorder=4)
    view.apply(axes)
    axes.set_xlabel("x (m)")
    axes.set_ylabel(view.label_of_heights())
    return figure


# ------------------------------------------------------------------------------------------------------------ plots


def of_the_start(run, energy):
    return energy / run.summary["energy"]["start_J"]


HISTORIES = {
    "total energy, of the start": lambda run, steps: of_the_start(run, steps["kinetic_J"] + steps["potential_J"]),
    "kinetic energy, of the start": lambda run, steps: of_the_start(run, steps["kinetic_J"]),
    "density error, mean (%)": lambda run, steps: 100 * steps["density_error_mean"],
    "density error, rms (%)": lambda run, steps: 100 * steps["density_error_rms"],
}
WATER_INSIDE = {"water inside, of the start":
                lambda run, steps: 1 - steps["volume_out_m3"] / run.summary["water_balance"]["start"]["volume_m3"]}


def draw_histories(runs, names=None):
    """Energies, the volume's error by the density and, if water leaves, what is inside, over time, of several runs;
    `names` as in `labels`."""
    leaves = any(run.step_table()["volume_out_m3"].any() for run in runs)
    histories = HISTORIES | (WATER_INSIDE if leaves else {})
    figure = new_figure(height=2.4)
    every = figure.subplots(1, len(histories))
    for run, label, style in zip(runs, labels(runs, names), CYCLE):
        steps = run.step_table()
        for axes, history in zip(every, histories.values()):
            axes.plot(steps["time_s"], history(run, steps), linewidth=1.1, label=label, **style)
    for axes, title in zip(every, histories):
        axes.set_title(title, loc="left", fontsize=8.5)
        axes.set_xlabel("$t$ (s)")
        grid(axes)
    legend_below(figure, every[0], 4)
    return figure


def legend_below(figure, axes, columns=1):
    """Under the axes, the figure as much higher as it takes."""
    handles, texts = axes.get_legend_handles_labels()
    width, height = figure.get_size_inches()
    need = 0.19 * math.ceil(len(texts) / columns) + 0.1
    figure.set_size_inches(width, height + need)
    share = need / (height + need)
    figure.get_layout_engine().set(rect=(0, share, 1, 1 - share))
    figure.legend(handles, texts, loc="lower center", ncols=columns, frameon=False)


def draw_numbers(quantities, names, *runs):
    """Small bars of the quantities {key: (words, unit, read)} of several runs; `names` as in `labels`."""
    rows = math.ceil(len(quantities) / 4)
    figure = new_figure(height=0.3 + rows * (0.42 + 0.17 * len(runs)))
    every = figure.subplots(rows, 4, sharey=True, squeeze=False)
    for axes in every.flat[len(quantities):]:
        axes.set_visible(False)
    for axes, (words, unit, read) in zip(every.flat, quantities.values()):
        values = [value_or_nan(read, run) for run in runs]
        axes.barh(range(len(runs)), values, color=[style["color"] for style in CYCLE[:len(runs)]], height=0.7)
        for row, value in enumerate(values):
            axes.text(0, row, f" {value:.3g}" if value == value else " none", va="center", fontsize=7.5, color="white",
                      bbox={"facecolor": "#00000088", "edgecolor": "none", "pad": 0.8})
        axes.set_title(words.split(", RMS")[0] + (f" ({unit})" if unit else ""), loc="left", fontsize=8)
        axes.tick_params(labelsize=7, length=0)
        axes.set_xticks([])
        axes.spines[["bottom"]].set_visible(False)
    for axes in every[:, 0]:
        axes.set_yticks(range(len(runs)), labels(runs, names), fontsize=8)
    every[0, 0].invert_yaxis()
    return figure


def value_or_nan(read, run):
    try:
        return read(run)
    except DataError:
        return math.nan


def draw_convergence(series, ylabel, bar=None):
    """Errors over spacing on logarithmic axes: {label: {dx in m: error}}, with lines of order 1 and 2."""
    figure = new_figure(WIDTH / 2 - 0.2, 2.9)
    axes = figure.subplots()
    for k, (label, errors) in enumerate(series.items()):
        dx, error = np.array(sorted(errors.items())).T
        order = f": order {np.polyfit(np.log(dx), np.log(error), 1)[0]:.1f}" if len(dx) > 1 else ""
        axes.loglog(dx, error, marker="os^Dv*"[k % 6], markersize=5, label=label + order, **CYCLE[k % len(CYCLE)])
    everything = np.array([[dx, error] for errors in series.values() for dx, error in errors.items()])
    ends = np.array([everything[:, 0].min(), everything[:, 0].max()])
    for order in (1, 2):
        slope = everything[:, 1].max() * (ends / ends[1]) ** order
        axes.loglog(ends, slope, color="#bbbbbb", linewidth=0.8, zorder=1)
        axes.text(ends[0], slope[0], f"{order} ", color=GREY, ha="right", va="center", fontsize=8)
    if bar is not None:
        axes.axhline(bar, color=ORANGE, linewidth=0.9, zorder=1)
        axes.text(ends[1], bar, "target ", color=ORANGE, ha="right", va="bottom", fontsize=8)
    ticks = sorted({dx for errors in series.values() for dx in errors})
    axes.set_xticks(ticks, [f"{dx:.3g}" for dx in ticks])
    axes.xaxis.set_minor_locator(matplotlib.ticker.NullLocator())
    axes.set_xlabel("spacing $dx$ (m)")
    axes.set_ylabel(ylabel)
    grid(axes)
    legend_below(figure, axes)
    return figure


def draw_ranges(rows, xlabel, bar=None, logarithmic=True):
    """Our numbers beside others': rows (name, lowest, highest, is ours), best on top as given."""
    figure = new_figure(WIDTH / 2 - 0.2, 0.7 + 0.26 * len(rows))
    axes = figure.subplots()
    for k, (_, low, high, is_ours) in enumerate(rows):
        color = BLUE if is_ours else GREY
        axes.plot([low, high], [k, k], color=color, linewidth=5, solid_capstyle="round", zorder=3)
        axes.plot([0.5 * (low + high)], [k], color=color, marker="o", markersize=7, zorder=3)
    if bar is not None:
        axes.axvline(bar, color=ORANGE, linewidth=1.0)
        axes.text(bar, -0.75, " target", color=ORANGE, fontsize=8, va="center")
    if logarithmic:
        axes.set_xscale("log")
    axes.set_yticks(range(len(rows)), [name for name, *_ in rows])
    for text, (*_, is_ours) in zip(axes.get_yticklabels(), rows):
        text.set(color=BLUE if is_ours else BLACK, fontweight="bold" if is_ours else "normal")
    axes.set_ylim(len(rows) - 0.5, -1.0)
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel(xlabel)
    axes.spines["left"].set_visible(False)
    axes.grid(axis="x", color="#dddddd", linewidth=0.6)
    return figure
