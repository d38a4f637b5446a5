"""Checks of all input files: a folder, a device or a pipe may deliver endless bytes or none, and a file may be too
large."""

from pathlib import Path

from .errors import DataError

__all__ = ["LARGEST_TABLE", "read_bytes", "read_text", "require_input_file"]

LARGEST_TABLE = 1 << 31  # bytes; limit for a series over millions of steps
LARGEST_TEXT = 1 << 26  # bytes; limit for the case of a run and its summary


def require_input_file(path, largest: int = LARGEST_TABLE):
    """Throws DataError unless `path` is a regular file, or a link to one, of at most `largest` bytes."""
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
    """Reads a UTF-8 text without its byte order mark. Throws DataError."""
    try:
        return read_bytes(path, largest).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise DataError(f"{path}: is not a text in UTF-8 ({error.reason} at byte {error.start})") from error
