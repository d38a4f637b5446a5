"""The field files of a run, read with VTK."""

import xml.etree.ElementTree as ElementTree
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from .curves import DataError


@dataclass(frozen=True)
class Frame:
    """Fluid particles at one time: positions (n, 3) in m, and fields by name (n or n x 3)."""

    time: float
    position: np.ndarray
    fields: dict


def list_frames(run_folder, name="fields"):
    """[(time in s, path)] of fields/NAME.pvd, in its order. Throws DataError."""
    series = Path(run_folder) / "fields" / f"{name}.pvd"
    try:
        entries = ElementTree.parse(series).getroot().iter("DataSet")
        return [(float(entry.get("timestep")), series.parent / entry.get("file")) for entry in entries]
    except OSError as error:
        raise DataError(f"{series}: cannot be read ({error.strerror})") from error
    except (ElementTree.ParseError, TypeError, ValueError) as error:
        raise DataError(f"{series}: is not a ParaView series ({error})") from error


def read_polydata(path):
    """As vtkPolyData. Throws DataError if VTK cannot read the file."""
    reader = vtkXMLPolyDataReader()
    if not Path(path).is_file() or not reader.CanReadFile(str(path)):
        raise DataError(f"{path}: is not a VTK polydata file")
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def to_frame(time, data):
    """The points and their fields, which borrow the memory of `data`."""
    arrays = data.GetPointData()
    fields = {arrays.GetArrayName(k): vtk_to_numpy(arrays.GetArray(k)) for k in range(arrays.GetNumberOfArrays())}
    return Frame(time, vtk_to_numpy(data.GetPoints().GetData()), fields)


def read_frame(time, path):
    """Throws DataError if VTK cannot read the file, or if there are no particles in it."""
    data = read_polydata(path)
    if data.GetNumberOfPoints() == 0:
        raise DataError(f"{path}: holds no particles")
    return to_frame(time, data)


def nearest_frames(run_folder, times):
    """The frame nearest to each of `times` (s)."""
    frames = list_frames(run_folder)
    if not frames:
        raise DataError(f"{run_folder}: the run wrote no field files")
    return [read_frame(*min(frames, key=lambda frame: abs(frame[0] - time))) for time in times]


def detached(position, reach):
    """How many particles (2D) no chain of others joins with the largest body of water: of cells `reach` wide, neighbours
    join."""
    count = Counter(map(tuple, np.floor(position[:, :2] / reach).astype(int)))
    cells = set(count)
    bodies = []
    while cells:
        waiting, body = [cells.pop()], 0
        while waiting:
            x, y = waiting.pop()
            body += count[x, y]
            near = {(x + dx, y + dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1)} & cells
            cells -= near
            waiting += near
        bodies.append(body)
    return len(position) - max(bodies)
