"""Settings and functions common to all pictures.

Curves have Okabe and Ito's colours, fields viridis: both are distinguishable with any colour vision and in grey.
Figures are drawn with STYLE; sizes are in inches for a page of width WIDTH.
"""

import math
from dataclasses import dataclass

import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection
from matplotlib.figure import Figure

from .errors import DataError
from .fields import Frame, list_frames, spacings_of
from .run import wall_chain
from .vtp import read_points
from .whole_file import write_whole

BLUE, ORANGE, SKY, BLACK, GREY = "#0072B2", "#D55E00", "#56B4E9", "#000000", "#777777"
STYLE = {"font.size": 9, "axes.titlesize": 9.5, "axes.labelsize": 9, "legend.fontsize": 8, "axes.linewidth": 0.8,
         "axes.spines.top": False, "axes.spines.right": False, "axes.axisbelow": True}
WIDTH = 11.5
LOOK_FROM = (1.0, -1.6, 0.9)  # direction from the middle of the walls to the camera, in 3D
FLATTEST = 0.11  # lowest height over width of a particle picture; flatter pictures have exaggerated heights
SHOWN_SHARE = 99.7  # percent of the particles that a picture must show; the others are spray
COLOURED_SHARE = 99.5  # percent of the particles whose speed lies within the colour scale
COLOURS = "viridis"
DPI = 100


def new_figure(width=WIDTH, height=3.0):
    return Figure(figsize=(width, height), layout="constrained")


class View:
    """The visible part of the plane in the pictures of some frames, and the exaggeration of heights. With `crop`, the
    view ends shortly downstream of the water, even if the channel continues."""

    def __init__(self, run, frames, crop=False, margin=0.02):
        water = np.concatenate([frame.position[:, :2] for frame in frames])
        walls = [line for frame in frames for line in wall_lines(run, frame.time)]
        corners = np.array([point for line in walls for point in line] or water)
        low, high = np.minimum(corners.min(0), water.min(0)), np.maximum(corners.max(0), water.max(0))
        if walls:  # walls extend higher than the water
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
        """Height over width as drawn."""
        return self.exaggeration * (self.y[1] - self.y[0]) / (self.x[1] - self.x[0])

    def label_of_heights(self):
        return "y (m)" if self.exaggeration == 1 else f"y (m), {self.exaggeration} times higher"

    def apply(self, axes):
        axes.set(xlim=self.x, ylim=self.y, aspect=self.exaggeration)
        axes.spines[["left", "bottom"]].set_visible(False)
        axes.tick_params(length=2.5)


def draw_particles(axes, position, spacing, exaggeration=1, **style):
    """Draws each particle as a disc that covers the area of its water; `spacing` is one number, or one of each particle.
    With exaggerated heights, where discs would be spikes, each particle is a rectangle about dx high."""
    x, y, share = position[:, 0], position[:, 1], 2**0.5
    if exaggeration > 1:
        wide, high = share, 1.1  # without gaps
        half = 0.5 * np.reshape(spacing, (-1, 1, 1)) * np.array([[-wide, -high], [wide, -high], [wide, high], [-wide, high]])
        dots = PolyCollection(np.stack([x, y], axis=1)[:, None, :] + half, linewidths=0, rasterized=True, zorder=2, **style)
    else:
        size = np.broadcast_to(share * spacing, len(position))
        dots = EllipseCollection(size, size, np.zeros(len(position)), units="xy", offsets=position[:, :2],
                                 transOffset=axes.transData, linewidths=0, rasterized=True, zorder=2, **style)
    axes.add_collection(dots)
    return dots


def wall_lines(run, time):
    """Wall lines in 2D at a time (s). If the run wrote moving walls with its fields, these are all walls at that time;
    otherwise they are the walls that do not move."""
    if not (run.path / "fields" / "walls.pvd").is_file():
        return run.walls_at(time)
    *_, (_, path) = (entry for entry in list_frames(run.path, "walls") if entry[0] <= time + 1e-9)
    lines = read_points(path)[0][:, :2].reshape(-1, 2, 2)
    for axis, name in enumerate(("periodic_x", "periodic_y")):
        # points that crossed a periodic boundary return to the domain
        if period := run.case.get("domain", {}).get(name):
            low, high = period
            lines[:, :, axis] -= ((high - low) * np.floor((lines[:, :, axis].mean(1) - low) / (high - low)))[:, None]
    return lines


def draw_walls(axes, run, time):
    axes.add_collection(LineCollection(wall_lines(run, time), colors=BLACK, linewidths=1.6, capstyle="projecting", zorder=3))


def draw_porous(axes, run):
    """Draws the outlines of porous layers in 2D."""
    outlines = [wall_chain(layer) for layer in run.case.get("porous", [])]
    axes.add_collection(LineCollection(outlines, colors=BLACK, linewidths=1.0, linestyles="dashed", zorder=3))


@dataclass(frozen=True)
class Colouring:
    """The meaning of the water's colour in some pictures. `field` is the coloured field, of which a vector counts by its
    magnitude; `ticks` are {value: name} of a field of whole numbers."""

    field: str
    label: str
    limits: tuple
    extend: str = "neither"
    ticks: dict | None = None

    def values(self, frame):
        values = frame.fields[self.field]
        return values if values.ndim == 1 else np.linalg.norm(values, axis=1)


def with_spacing(run, frame):
    """The frame with the field "spacing" (m), if its particles have volumes."""
    if "volume" not in frame.fields:
        return frame
    return Frame(frame.time, frame.position, {**frame.fields, "spacing": spacings_of(run, frame)})


def colouring(run, frames, by):
    """The colours of frames `by` "speed", "pressure", "spacing" or "liquid"; None if nothing moves or there is no velocity.
    Throws DataError if the particles of the run do not differ so, or have no pressure."""
    if by == "speed":
        def highest(frame):
            velocity = frame.fields.get("velocity")
            return 0.0 if velocity is None else np.percentile(np.linalg.norm(velocity, axis=1), COLOURED_SHARE)

        speed = max(highest(frame) for frame in frames)
        return Colouring("velocity", "speed (m/s)", (0, speed), "max") if speed > 0 else None
    if not all(by in frame.fields for frame in frames):
        why = {"spacing": "it has no [[refinement]], so all particles have one spacing",
               "pressure": "its output.fields have no pressure",
               "liquid": "it has one liquid, or was made by an earlier version"}[by]
        raise DataError(f"{run.path}: the pictures cannot be coloured by {by}: {why}; remedy: --colour speed")
    if by == "pressure":
        highest = max(np.percentile(frame.fields["pressure"], COLOURED_SHARE) for frame in frames)
        return Colouring("pressure", "pressure (Pa)", (0, max(highest, 1.0)), "max")
    if by == "liquid":
        names = {k: liquid["name"] for k, liquid in enumerate(run.case["liquid"])}
        return Colouring("liquid", "", (0, max(1, len(names) - 1)), ticks=names)
    ends = [(frame["spacing"].min(), frame["spacing"].max()) for frame in frames]
    return Colouring("spacing", "spacing (m)", (min(low for low, _ in ends), max(high for _, high in ends)))


def plain(text):
    """A user's text, with $ escaped so that it does not begin a formula."""
    return text.replace("$", r"\$")


def save(figure, axes, run, time, mappable, path, colours=None):
    """Saves a picture of the water at a time (s), with its title and, with a Colouring, a colour scale."""
    axes.set_title(f"{plain(run.title)}\n$t$ = {time:.4g} s, dx = {run.spacing:.4g} m", loc="left", fontsize=10)
    if colours is not None:
        bar = figure.colorbar(mappable, ax=axes, fraction=0.025, pad=0.01, extend=colours.extend)
        bar.set_label(colours.label)
        if colours.ticks:
            bar.set_ticks(list(colours.ticks), labels=[plain(name) for name in colours.ticks.values()])
    write_whole(path, lambda part: figure.savefig(part, dpi=DPI, format="png"))
