"""The one guard of files that are read: a folder, a device or a pipe may give no end of bytes, or none at all, and a file
may be larger than anything of its kind."""

from pathlib import Path

from .errors import DataError

__all__ = ["LARGEST_TABLE", "read_bytes", "read_text", "require_input_file"]

LARGEST_TABLE = 1 << 31  # bytes; of a series over millions of steps
LARGEST_TEXT = 1 << 26  # bytes; of the case of a run and its summary


def require_input_file(path, largest: int = LARGEST_TABLE):
    """Throws DataError unless there is a regular file, or a link to one, of at most so many bytes."""
    path = Path(path)
    try:
        size = path.stat().st_size
        if path.is_dir():
            raise DataError(f"{path}: is a folder; give a file in it")
        if not path.is_file():
            raise DataError(f"{path}: is a device or a pipe; give a file")
    except (OSError, ValueError) as error:
        raise DataError(f"{path}: cannot be read ({getattr(error, 'strerror', None) or error})") from error
    if size > largest:
        raise DataError(f"{path}: has {size} bytes, and such a file has at most {largest}; give fewer lines")


def read_bytes(path, largest: int = LARGEST_TEXT) -> bytes:
    """All bytes of a file. Throws DataError."""
    require_input_file(path, largest)
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror})") from error


def read_text(path, largest: int = LARGEST_TEXT) -> str:
    """A text in UTF-8, without the mark that some programs begin it with. Throws DataError."""
    try:
        return read_bytes(path, largest).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise DataError(f"{path}: is not a text in UTF-8 ({error.reason} at byte {error.start})") from error
