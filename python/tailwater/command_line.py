"""Command-line options and error messages, common to the package's commands and in the style of the program."""

import argparse
import math
import sys
from collections.abc import Callable
from pathlib import Path

from .errors import DataError, IoError

__all__ = ["Parser", "complain", "exit_code_of", "number"]


class Parser(argparse.ArgumentParser):
    """Argument parser of a command that the program starts; the program passes its own path by `--program`. Wrong
    options end the command with exit code 2."""

    def __init__(self, prog: str, needs_program: bool = False, **words):
        super().__init__(prog=prog, allow_abbrev=False, **words)
        self.add_argument("--program", type=Path, required=needs_program, help=argparse.SUPPRESS)

    def error(self, message):
        print(f"error: {message}; see: {self.prog} --help", file=sys.stderr)
        sys.exit(2)


def number(text: str) -> float:
    """Converts an option to a finite number."""
    value = float(text)
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text}: not a finite number")
    return value


def complain(what, code: int) -> int:
    """Prints an error; returns its exit code."""
    print(f"error: {what}", file=sys.stderr)
    return code


def exit_code_of(work: Callable[[], object]) -> int:
    """Runs a command and prints its error. Returns the exit code: 0, 2 for wrong input, 4 for a file."""
    try:
        work()
    except DataError as error:
        return complain(error, 2)
    except (IoError, OSError) as error:
        return complain(error, 4)
    return 0
