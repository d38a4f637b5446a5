"""The water of a run as one VTKHDF file with all its times, for ParaView 5.12 and newer.

The format is VTKHDF 2.0, PolyData with steps (VTK documentation, "VTKHDF File Format"). Each time is a part of its own,
with as many points as the run had particles then, and one vertex for each."""

import numpy as np

from .errors import DataError
from .fields import list_frames, read_frame
from .whole_file import write_whole

__all__ = ["write_vtkhdf"]

VERSION = (2, 0)
KINDS = ("Vertices", "Lines", "Polygons", "Strips")
CHUNK = 1 << 18  # bytes before compression


def append(group, name, values):
    """To a dataset that grows; a table's row is one value."""
    values = np.asarray(values)
    if name not in group:
        row = values.shape[1:]
        length = max(1, CHUNK // max(1, values.dtype.itemsize * int(np.prod(row))))
        group.create_dataset(name, shape=(0, *row), maxshape=(None, *row), chunks=(length, *row), dtype=values.dtype,
                             compression="gzip", compression_opts=1, shuffle=True)
    data = group[name]
    data.resize(len(data) + len(values), axis=0)
    data[len(data) - len(values):] = values


def append_cells(root, count):
    """Of one time: a vertex for each of `count` points, and nothing else."""
    for kind in KINDS:
        cells = count if kind == "Vertices" else 0
        group = root.require_group(kind)
        append(group, "NumberOfCells", np.array([cells]))
        append(group, "NumberOfConnectivityIds", np.array([cells]))
        append(group, "Connectivity", np.arange(cells))
        append(group, "Offsets", np.arange(cells + 1))


def append_step(root, number, frame, points, names):
    """`points` were written before it."""
    steps = root.require_group("Steps")
    steps.attrs["NSteps"] = number + 1
    append(steps, "Values", [frame.time])
    append(steps, "PartOffsets", [number])
    append(steps, "NumberOfParts", [1])
    append(steps, "PointOffsets", [points])
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        append(steps, name, [[points, 0, 0, 0]])
    for name in names:
        append(steps.require_group("PointDataOffsets"), name, [points])


def write_steps(file, frames):
    """[(time in s, path)] into an open HDF5 file, one in memory at a time."""
    root = file.create_group("VTKHDF")
    root.attrs["Version"] = VERSION
    root.attrs["Type"] = np.bytes_("PolyData")  # a text of fixed length, as VTK wants it
    points, names = 0, None
    for number, (time, path) in enumerate(frames):
        frame = read_frame(time, path)
        if names is not None and list(frame.fields) != names:
            raise DataError(f"{path}: has the fields {', '.join(frame.fields)}, and the files before it {', '.join(names)}")
        names = list(frame.fields)
        count = len(frame.position)
        append_step(root, number, frame, points, names)
        append(root, "NumberOfPoints", [count])
        append(root, "Points", frame.position)
        append_cells(root, count)
        for name, values in frame.fields.items():
            append(root.require_group("PointData"), name, values)
        points += count


def write_vtkhdf(run, path):
    """Throws DataError where there are no fields, or no h5py; OSError."""
    try:
        import h5py
    except ImportError as error:
        raise DataError(f"VTKHDF files are written by h5py, which is not there ({error}); remedy: apt install "
                        "python3-h5py") from error
    frames = list_frames(run.path)
    if not frames:
        raise DataError(f"{run.path}: the run wrote no field files")

    def write(part):
        with h5py.File(part, "w") as file:
            write_steps(file, frames)

    write_whole(path, write)
