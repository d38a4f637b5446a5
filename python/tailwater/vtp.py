"""Reads the VTK PolyData files of runs (docs/theory/io.md) with numpy: VTK is slow to import and large to install."""

import re
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path

import numpy as np

from .errors import DataError
from .input_file import require_input_file

__all__ = ["read_points"]

TYPES = {"Float64": "<f8", "Float32": "<f4", "Int64": "<i8", "Int32": "<i4", "UInt64": "<u8", "UInt32": "<u4"}
START = re.compile(rb'<AppendedData\s*(?:encoding="raw")?>\s*_')
RAW = re.compile(rb'encoding(?: CDATA |=)"raw"')  # in the tag, or before it for all arrays


class File:
    """An open file: its XML, and its arrays at the offsets that the XML gives. Throws DataError if it is another kind
    of file."""

    def __init__(self, file):
        self._file = file
        head = b""
        while (start := START.search(head)) is None:
            if not (more := file.read(65536)):
                break
            head += more
        if start is None or not RAW.search(head[:start.end()]):
            raise DataError(f"{file.name}: is not a VTK file with raw appended arrays, as runs write them")
        self._begin = start.end()
        self.xml = ElementTree.fromstring(head[:start.start()] + b"</VTKFile>")
        self._head = TYPES[self.xml.get("header_type", "UInt32")]
        self._is_packed = self.xml.get("compressor") is not None

    def _numbers(self, count):
        return np.fromfile(self._file, self._head, count)

    def array(self, node) -> np.ndarray:
        """The array of a DataArray: (n), or (n, components)."""
        self._file.seek(self._begin + int(node.get("offset")))
        kind, components = TYPES[node.get("type")], int(node.get("NumberOfComponents", 1))
        size, = self._numbers(1)
        if self._is_packed:
            self._numbers(2)
            data = b"".join(zlib.decompress(self._file.read(packed)) for packed in self._numbers(size))
            values = np.frombuffer(bytearray(data), kind)
        else:
            values = np.fromfile(self._file, kind, int(size) // np.dtype(kind).itemsize)
            if values.nbytes != size:
                raise EOFError("ends too early")
        return values if components == 1 else values.reshape(-1, components)


def read_points(path) -> tuple:
    """Positions (n, 3) in m, and the fields by name, each (n) or (n, 3). Throws DataError."""
    path = Path(path)
    require_input_file(path)
    try:
        with path.open("rb") as file:
            opened = File(file)
            pieces = [(opened.array(piece.find("Points/DataArray")),
                       {node.get("Name"): opened.array(node) for node in piece.iterfind("PointData/DataArray")})
                      for piece in opened.xml.iterfind("PolyData/Piece")]
        (position, fields), *others = pieces
        if others:  # parts of other ranks
            position = np.concatenate([position, *(piece[0] for piece in others)])
            fields = {name: np.concatenate([values, *(piece[1][name] for piece in others)])
                      for name, values in fields.items()}
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror})") from error
    except (AttributeError, EOFError, ElementTree.ParseError, KeyError, MemoryError, OverflowError, TypeError, ValueError,
            zlib.error) as error:
        raise DataError(f"{path}: is not a whole VTK polydata file ({error})") from error
    return position, fields
