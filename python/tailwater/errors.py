"""What can go wrong, as exceptions. The program tells the same by its exit code and message."""

import re

__all__ = ["DataError", "Error", "InputError", "IoError", "RunWarning", "SolverError", "error_of"]

# "FILE:12:5: ", or of a change "--set KEY=VALUE: ", before what is wrong.
PLACE = re.compile(r"(?P<file>[^\n]+?):(?P<line>\d+):(?P<column>\d+): ")
CHANGE = re.compile(r"--set (?P<key>[^=\s]+)=")
KEY = re.compile(r"(?P<key>[A-Za-z_][\w.\[\]]*)(?: = | is missing|: unknown key)")


class Error(Exception):
    """Base of all errors of this package that are not Python's own."""


class InputError(Error):
    """The case, an argument or the geometry is wrong. The message names the place, the value and the remedy.

    `file`, `line` and `column` (from 1) say where in the case file, `key` which key; each is None where it does not
    apply. With several problems they are those of the first; the message has a line for each."""

    def __init__(self, message: str):
        super().__init__(message)
        first = message.split("\n", maxsplit=1)[0]
        place, change = PLACE.match(first), CHANGE.match(first)
        key = change or KEY.match(first, place.end() if place else 0)
        self.file = place["file"] if place else None
        self.line = int(place["line"]) if place else None
        self.column = int(place["column"]) if place else None
        self.key = key["key"] if key else None


class SolverError(Error):
    """A linear solve did not converge, or a step gave a value that is not finite."""


class IoError(Error):
    """A file or folder cannot be read or written, or the program cannot be started."""


class DataError(Error):
    """What a run or a laboratory has left cannot be read, or is not enough for what is asked."""


class RunWarning(UserWarning):
    """What a run warns of; its summary keeps it too."""


KINDS = {2: InputError, 3: SolverError, 4: IoError}


def error_of(exit_code: int, told: str) -> Error:
    """The error that the program has ended with; `told` is what it wrote on standard error."""
    lines = told.splitlines()
    errors = [line.removeprefix("error: ") for line in lines if line.startswith("error: ")] or lines[-1:]
    message = "\n".join(errors) or f"the program ended with exit code {exit_code}"
    return KINDS.get(exit_code, SolverError)(message)
