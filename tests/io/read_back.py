#!/usr/bin/python3
"""Reads field files back with VTK's own reader and compares every value with the original.

Usage: read_back.py SAMPLES MPIRUN: the files that the program write_vtk_samples writes on one rank, and on three."""

import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


def read(path):
    """The vtkPolyData in the file; any error or warning of the reader is an error."""
    complaints = []
    reader = vtkXMLPolyDataReader()
    reader.AddObserver("ErrorEvent", lambda *_: complaints.append("error"))
    reader.AddObserver("WarningEvent", lambda *_: complaints.append("warning"))
    reader.SetFileName(str(path))
    assert reader.CanReadFile(str(path)), f"{path}: VTK does not know this file"
    reader.Update()
    assert not complaints and reader.GetErrorCode() == 0, f"{path}: {complaints} {reader.GetErrorCode()}"
    return reader.GetOutput()


def array(data, name, dtype):
    values = data.GetArray(name)
    assert values is not None, f"no array {name}"
    values = vtk_to_numpy(values)
    assert values.dtype == dtype, f"{name} is {values.dtype}"
    return values


def same(actual, expected, what):
    assert actual.shape == expected.shape, f"{what}: shape {actual.shape}, written {expected.shape}"
    assert np.array_equal(actual, expected), f"{what} differs"


def check_file(path):
    with open(path.with_suffix(".csv")) as table:
        header, *lines = table.read().splitlines()
    expected = np.array([[float(x) for x in line.split(",")] for line in lines]).reshape(len(lines), 8)
    assert header == "x,y,z,pressure,u,v,w,id"

    poly = read(path)
    time = poly.GetFieldData().GetArray("TimeValue")
    assert time is not None and time.GetNumberOfTuples() == 1 and time.GetValue(0) == 0.1 + 0.2, f"{path}: time"
    count = len(lines)
    assert poly.GetNumberOfPoints() == count and poly.GetNumberOfVerts() == count, f"{path}: {count} particles"
    if count == 0:
        return
    same(vtk_to_numpy(poly.GetPoints().GetData()), expected[:, 0:3], f"{path}: points")
    fields = poly.GetPointData()
    same(array(fields, "pressure", np.float32), expected[:, 3].astype(np.float32), f"{path}: pressure")
    same(array(fields, "velocity", np.float32), expected[:, 4:7].astype(np.float32), f"{path}: velocity")
    same(array(fields, "id", np.int64), expected[:, 7].astype(np.int64), f"{path}: id")
    vertices = vtk_to_numpy(poly.GetVerts().GetConnectivityArray())
    same(vertices, np.arange(count, dtype=vertices.dtype), f"{path}: vertices")


def check_series(folder):
    with open(folder / "series.csv") as table:
        expected = [tuple(float(x) for x in line.split(",")) for line in table.read().splitlines()[1:]]
    listed = ElementTree.parse(folder / "series" / "fields.pvd").getroot().findall("Collection/DataSet")
    assert len(listed) == len(expected), f"{len(listed)} files listed, {len(expected)} written"
    for entry, (time, count) in zip(listed, expected):
        poly = read(folder / "series" / entry.get("file"))
        assert float(entry.get("timestep")) == time
        assert poly.GetFieldData().GetArray("TimeValue").GetValue(0) == time
        assert poly.GetNumberOfPoints() == count


def check_samples(command):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([*command, name], check=True)
        files = sorted(folder.glob("*.vtp"))
        assert len(files) == 24, f"{len(files)} files: 2 dimensions, 3 levels, 4 sets of particles were expected"
        for path in files:
            check_file(path)
        check_series(folder)


def main():
    samples, mpirun = sys.argv[1:]
    check_samples([samples])
    check_samples([mpirun, "-n", "3", samples])


if __name__ == "__main__":
    main()
