"""Field files as VTK's own reader sees them."""

import xml.etree.ElementTree

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


def read_points(path):
    """(positions, {name: array}) of a .vtp file; ValueError at any complaint of the reader."""
    complaints = []
    reader = vtkXMLPolyDataReader()
    reader.AddObserver("ErrorEvent", lambda *_: complaints.append("error"))
    reader.AddObserver("WarningEvent", lambda *_: complaints.append("warning"))
    reader.SetFileName(str(path))
    reader.Update()
    if complaints or reader.GetErrorCode() != 0:
        raise ValueError(f"{path}: VTK says {complaints}, error {reader.GetErrorCode()}")
    data = reader.GetOutput()
    arrays = data.GetPointData()
    fields = {arrays.GetArrayName(k): vtk_to_numpy(arrays.GetArray(k)) for k in range(arrays.GetNumberOfArrays())}
    return vtk_to_numpy(data.GetPoints().GetData()), fields


def read_series(path):
    """[(time, path of the .vtp file)] of a .pvd file."""
    sets = xml.etree.ElementTree.parse(path).getroot().iter("DataSet")
    return [(float(entry.get("timestep")), path.parent / entry.get("file")) for entry in sets]
