"""Writes all output files: each under a temporary name beside its path, and then renamed."""

import os
import stat
from pathlib import Path

from .errors import DataError, IoError

__all__ = ["require_other_file", "write_whole", "write_whole_text"]


def obstacle_at(path: Path) -> str:
    """The obstacle at the path of a file that must not be replaced, such as "a link"; "" if there is none. The program
    has the same rule (src/io/write_file.h)."""
    try:
        found = os.lstat(path)
    except OSError:
        return ""  # a path that cannot be inspected cannot be opened either
    if stat.S_ISLNK(found.st_mode):
        return "a link"
    if stat.S_ISDIR(found.st_mode):
        return "a folder"
    if not stat.S_ISREG(found.st_mode):
        return "a device or a pipe"
    return "" if found.st_uid == os.geteuid() else "another user's file"


def require_replaceable(path: Path):
    """Throws IoError for a link, a folder, a device, a pipe or another user's file."""
    if what := obstacle_at(path):
        raise IoError(f"cannot write '{path}': {what} is in its place, and is neither followed nor replaced; remedy: remove "
                      "it, or choose another name")


def require_other_file(path: Path, read: Path):
    """Throws DataError if a command would replace the file that it reads."""
    if path.exists() and read.exists() and path.samefile(read):
        raise DataError(f"--to {path}: is the file that the command reads; choose another name")


def write_whole(path, write):
    """Writes a file with `write(part)`, where `part` is a temporary name. A killed program leaves no partial file.
    Throws IoError for an obstacle, and where the file cannot be written."""
    path = Path(path)
    part = path.with_name(path.name + ".part")
    for each in (path, part):
        require_replaceable(each)
    try:
        part.unlink(missing_ok=True)
        try:
            write(part)
            os.replace(part, path)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise IoError(f"cannot write '{path}': {error.strerror or error}") from error


def write_whole_text(path, text: str):
    """Writes a text as `write_whole` does."""
    write_whole(path, lambda part: part.write_text(text, encoding="utf-8"))
