"""Exceptions of the package. The program reports the same errors by exit code and message."""

import re

__all__ = ["DataError", "Error", "InputError", "IoError", "RunWarning", "SolverError", "error_of"]

# The place before the message of an error: "FILE:12:5: ", or "--set KEY=VALUE: " for a change.
PLACE = re.compile(r"(?P<file>[^\n]+?):(?P<line>\d+):(?P<column>\d+): ")
CHANGE = re.compile(r"--set (?P<key>[^=\s]+)=")
KEY = re.compile(r"(?P<key>[A-Za-z_][\w.\[\]]*)(?: = | is missing|: unknown key)")


class Error(Exception):
    """Base of all errors of this package."""


class InputError(Error):
    """The case, an argument or the geometry is wrong. The message names the place, the value and the remedy.

    `file`, `line` and `column` (from 1) give the place in the case file, `key` the key; each is None where it does not
    apply. If there are several problems, these attributes describe the first one; the message has a line for each
    problem."""

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
    """A linear solve did not converge, or a step computed a value that is not finite."""


class IoError(Error):
    """A file or folder cannot be read or written, or the program cannot be started."""


class DataError(Error):
    """Data of a run or a laboratory cannot be read, or are insufficient for the request."""


class RunWarning(UserWarning):
    """A warning of a run; the summary of the run holds it too."""


KINDS = {2: InputError, 3: SolverError, 4: IoError}


def error_of(exit_code: int, told: str) -> Error:
    """The exception for an exit code of the program; `told` is the text of its standard error."""
    lines = told.splitlines()
    errors = [line.removeprefix("error: ") for line in lines if line.startswith("error: ")] or lines[-1:]
    message = "\n".join(errors) or f"the program ended with exit code {exit_code}"
    return KINDS.get(exit_code, SolverError)(message)
