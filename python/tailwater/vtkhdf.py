"""The water of a run as one VTKHDF file with all its times, for ParaView 5.12 and newer.

The format is VTKHDF 2.0, PolyData with steps (VTK documentation, "VTKHDF File Format"). Each time is one part, with one
point and one vertex for each particle at that time."""

import io

import numpy as np

from .errors import DataError
from .fields import list_frames, read_frame
from .whole_file import write_whole

__all__ = ["write_vtkhdf"]

VERSION = (2, 0)
KINDS = ("Vertices", "Lines", "Polygons", "Strips")
CHUNK = 1 << 18  # bytes before compression


class SafeFile(io.RawIOBase):
    """A file for HDF5, which crashes if a write fails, as on a full disk. This file keeps the `error` instead,
    and all data from then on in memory, so that HDF5 can close it."""

    def __init__(self, file):
        super().__init__()
        self.file, self.error = file, None
        self._at, self._end, self._late = 0, 0, []  # _late: (offset, data) that could not be written

    def seek(self, offset, whence=0):
        self._at = offset + (0, self._at, self._end)[whence]
        return self._at

    def tell(self):
        return self._at

    def write(self, data):
        data = bytes(data)
        if self.error is None:
            try:
                self.file.seek(self._at)
                written = 0
                while written < len(data):  # a nearly full disk takes the first part
                    written += self.file.write(data[written:])
            except OSError as error:
                self.error = error
        if self.error is not None:
            self._late.append((self._at, data))
        self._at += len(data)
        self._end = max(self._end, self._at)
        return len(data)

    def readinto(self, buffer):
        start, size = self._at, len(buffer)
        self.file.seek(start)
        found = self.file.read(size)
        buffer[:] = found + bytes(size - len(found))
        for offset, data in self._late:
            low, high = max(offset, start), min(offset + len(data), start + size)
            if low < high:
                buffer[low - start:high - start] = data[low - offset:high - offset]
        self._at += size
        return size

    def truncate(self, size=None):
        self._end = self._at if size is None else size
        if self.error is None:
            try:
                self.file.truncate(self._end)
            except OSError as error:
                self.error = error
        return self._end


class Tables:
    """Datasets that grow. They stay open, because HDF5 compresses a chunk when its dataset is closed, and repeated
    compression leaves holes in the file."""

    def __init__(self, root):
        self.root = root
        self._open = {}

    def append(self, name, values):
        """Appends values; each one is a row of the table."""
        values = np.asarray(values)
        if name not in self._open:
            row = values.shape[1:]
            length = max(1, CHUNK // max(1, values.dtype.itemsize * int(np.prod(row))))
            self._open[name] = self.root.create_dataset(
                name, shape=(0, *row), maxshape=(None, *row), chunks=(length, *row), dtype=values.dtype, compression="gzip",
                compression_opts=1, shuffle=True)
        data = self._open[name]
        data.resize(len(data) + len(values), axis=0)
        data[len(data) - len(values):] = values


def append_cells(tables, count):
    """Appends the cells of one time: a vertex for each of `count` points, no other cells."""
    for kind in KINDS:
        cells = count if kind == "Vertices" else 0
        tables.append(f"{kind}/NumberOfCells", [cells])
        tables.append(f"{kind}/NumberOfConnectivityIds", [cells])
        tables.append(f"{kind}/Connectivity", np.arange(cells))
        tables.append(f"{kind}/Offsets", np.arange(cells + 1))


def append_step(tables, number, frame, points, names):
    """Appends the offsets of one time; `points` is the number of points written before it."""
    tables.root.require_group("Steps").attrs["NSteps"] = number + 1
    tables.append("Steps/Values", [frame.time])
    tables.append("Steps/PartOffsets", [number])
    tables.append("Steps/NumberOfParts", [1])
    tables.append("Steps/PointOffsets", [points])
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        tables.append(f"Steps/{name}", [[points, 0, 0, 0]])
    for name in names:
        tables.append(f"Steps/PointDataOffsets/{name}", [points])


def write_steps(file, frames, is_failed):
    """Writes frames [(time in s, path)] into an open HDF5 file, with one frame in memory at a time, until
    `is_failed()`."""
    root = file.create_group("VTKHDF")
    root.attrs["Version"] = VERSION
    root.attrs["Type"] = np.bytes_("PolyData")  # a text of fixed length, as VTK requires
    tables, points, names = Tables(root), 0, None
    for number, (time, path) in enumerate(frames):
        frame = read_frame(time, path)
        if names is not None and list(frame.fields) != names:
            raise DataError(f"{path}: has the fields {', '.join(frame.fields)}, and the files before it {', '.join(names)}")
        names = list(frame.fields)
        count = len(frame.position)
        append_step(tables, number, frame, points, names)
        tables.append("NumberOfPoints", [count])
        tables.append("Points", frame.position)
        append_cells(tables, count)
        for name, values in frame.fields.items():
            tables.append(f"PointData/{name}", values)
        points += count
        if is_failed():
            return


def write_vtkhdf(run, path):
    """Writes a VTKHDF file. Throws DataError where there are no fields, or if h5py is missing; IoError."""
    try:
        import h5py
    except ImportError as error:
        raise DataError(f"VTKHDF files are written by h5py, which is not there ({error}); remedy: apt install "
                        "python3-h5py") from error
    frames = list_frames(run.path)
    if not frames:
        raise DataError(f"{run.path}: the run wrote no field files")

    def write(part):
        with open(part, "w+b", buffering=0) as raw:
            safe = SafeFile(raw)
            with h5py.File(safe, "w") as file:
                write_steps(file, frames, lambda: safe.error is not None)
            if safe.error is not None:
                raise safe.error

    write_whole(path, write)
