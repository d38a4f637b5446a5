"""Where the water of a run is thin: its thickness at each place, from the field files.

The space is divided into cubes with an edge of two spacings. The thickness at a cube is the volume of the unbroken
row of cubes with water through it, over their cross section: the least of the rows along the axes. Sheets, jets and
tongues are thin along one axis and long along another; drops are thin along all axes and do not count."""

from dataclasses import dataclass

import numpy as np

from .errors import DataError
from .fields import list_frames, read_frame, spacings_of

__all__ = ["ThinWater", "find_thin_water"]

CELL = 2.0  # spacings
MOST_FRAMES = 40
MOST_CELLS = 3_000_000
FILLED = 0.15  # fraction of a cube's volume above which it holds water
THINNEST = 1.2  # spacings; thinner water is spray


def rows_along(volume, holds, axis):
    """The volume of the unbroken row of cubes along an axis to which each cube belongs; 0 for cubes without water."""
    filled, wet = np.moveaxis(volume * holds, axis, 0), np.moveaxis(holds, axis, 0)
    whole = np.zeros_like(filled)
    sum_before = np.zeros(filled.shape[1:])
    for k in range(len(filled)):
        sum_before = np.where(wet[k], sum_before + filled[k], 0.0)
        whole[k] = sum_before
    for k in range(len(filled) - 2, -1, -1):  # the last cube of a row has its whole volume
        whole[k] = np.where(wet[k] & wet[k + 1], whole[k + 1], whole[k])
    return np.moveaxis(whole, 0, axis)


@dataclass(frozen=True)
class ThinWater:
    """`low` [m] is the lowest corner of the cubes, `edge` [m] that of a cube. By cube: `wet` and `thin` are the fractions
    of the frames in which it holds water, and in which this is thin; `thickness` [m] is the mean over the former."""

    low: np.ndarray
    edge: float
    wet: np.ndarray
    thin: np.ndarray
    thickness: np.ndarray

    def cell_of(self, place):
        """The index of the cube at a place; None outside."""
        cell = tuple(np.floor((np.asarray(place, float) - self.low) / self.edge).astype(int))
        return cell if all(0 <= k < count for k, count in zip(cell, self.wet.shape)) else None


def cubes_around(run, frames, limit):
    """(lowest corner, edge, counts) of cubes around the water of some frames; larger ones where there would be more than
    the limit."""
    dim = run.dimension
    low = np.min([frame.position[:, :dim].min(0) for frame in frames], axis=0).astype(float)
    high = np.max([frame.position[:, :dim].max(0) for frame in frames], axis=0).astype(float)
    edge = CELL * run.spacing
    while np.prod(np.floor((high - low) / edge) + 1) > limit:
        edge *= 1.25
    return low, edge, (np.floor((high - low) / edge) + 1).astype(int)


def find_thin_water(run, rows, spacing) -> ThinWater:
    """Thin water has fewer than `rows` particles of a spacing [m] across. Throws DataError if the run wrote no field
    files."""
    listed = list_frames(run.path)
    if not listed:
        raise DataError(f"{run.path}: the run wrote no field files; remedy: give output.fields_interval, or another run")
    chosen = np.unique(np.linspace(0, len(listed) - 1, MOST_FRAMES).round().astype(int))
    frames = [read_frame(*listed[k]) for k in chosen]
    low, edge, counts = cubes_around(run, frames, MOST_CELLS)
    wet, thin, sum_of_thickness = np.zeros(counts), np.zeros(counts), np.zeros(counts)
    for frame in frames:
        place = np.floor((frame.position[:, :run.dimension] - low) / edge).astype(int)
        volume = np.zeros(counts)
        np.add.at(volume, tuple(np.minimum(place, counts - 1).T), spacings_of(run, frame) ** run.dimension)
        holds = volume > FILLED * edge**run.dimension
        along = np.array([rows_along(volume, holds, axis) for axis in range(run.dimension)]) / edge ** (run.dimension - 1)
        least, most = along.min(0), along.max(0)
        is_thin = holds & (least >= THINNEST * run.spacing) & (least < rows * spacing) & (most >= rows * spacing)
        wet += holds
        thin += is_thin
        sum_of_thickness += np.where(holds, least, 0.0)
    thickness = np.divide(sum_of_thickness, wet, out=np.zeros(counts), where=wet > 0)
    return ThinWater(low, edge, wet / len(frames), thin / len(frames), thickness)
