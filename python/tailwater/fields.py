"""The field files of a run."""

import math
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .errors import DataError
from .input_file import read_bytes, require_input_file
from .vtp import read_points

__all__ = ["Frame", "list_frames", "nearest_frames", "read_frame", "read_polydata", "spacings_of", "to_frame"]


@dataclass(frozen=True, repr=False)
class Frame:
    """Fluid particles at one time (s): positions (n, 3) in m, z = 0 in 2D, and fields by name, (n) or (n, 3), in SI
    units."""

    time: float
    position: np.ndarray
    fields: dict

    def __repr__(self):
        return f"Frame({self.time:.6g} s: {len(self.position)} particles, {', '.join(self.fields)})"

    def __getitem__(self, name: str) -> np.ndarray:
        try:
            return self.fields[name]
        except KeyError:
            raise KeyError(f"{name}; there are {', '.join(self.fields)}") from None


def list_frames(run_folder, name: str = "fields") -> list:
    """[(time in s, path)] of fields/NAME.pvd, in its order. Throws DataError."""
    series = Path(run_folder) / "fields" / f"{name}.pvd"
    try:
        entries = ElementTree.fromstring(read_bytes(series)).iter("DataSet")
        return [(float(entry.get("timestep")), series.parent / entry.get("file")) for entry in entries]
    except (ElementTree.ParseError, TypeError, ValueError) as error:
        raise DataError(f"{series}: is not a ParaView series ({error})") from error


def read_polydata(path):
    """Reads a file as vtkPolyData. Throws DataError if VTK cannot read it."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader  # slow to import

    reader = vtkXMLPolyDataReader()
    require_input_file(path)
    if not reader.CanReadFile(str(path)):
        raise DataError(f"{path}: is not a VTK polydata file")
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def to_frame(time: float, data) -> Frame:
    """A frame of the points and their fields, which shares the memory of `data`."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    arrays = data.GetPointData()
    fields = {arrays.GetArrayName(k): vtk_to_numpy(arrays.GetArray(k)) for k in range(arrays.GetNumberOfArrays())}
    return Frame(time, vtk_to_numpy(data.GetPoints().GetData()), fields)


def read_frame(time: float, path) -> Frame:
    """Reads a field file. Throws DataError if the file is not one of a run, or has no particles."""
    position, fields = read_points(path)
    if len(position) == 0:
        raise DataError(f"{path}: holds no particles")
    return Frame(time, position, fields)


def spacings_of(run, frame: Frame) -> np.ndarray:
    """The spacing (m) of each particle of a frame of a run, by its volume; without volumes that of the run."""
    volume = frame.fields.get("volume")
    if volume is None:
        return np.full(len(frame.position), run.spacing)
    return np.asarray(volume, float) ** (1 / run.dimension)


def nearest_frames(run_folder, times) -> list:
    """The frame nearest to each of `times` (s)."""
    frames = list_frames(run_folder)
    if any(math.isnan(time) for time in times):
        raise DataError(f"{run_folder}: no frame is nearest to the time nan; remedy: give a number")
    if not frames:
        raise DataError(f"{run_folder}: the run wrote no field files")
    return [read_frame(*min(frames, key=lambda frame: abs(frame[0] - time))) for time in times]
