"""What the package's commands share: options, and errors that read like those of the program."""

import argparse
import math
import sys
from collections.abc import Callable
from pathlib import Path

from .errors import DataError, IoError

__all__ = ["Parser", "complain", "exit_code_of", "number"]


class Parser(argparse.ArgumentParser):
    """Of a command that the program hands over, telling by `--program` where it is. Wrong options end it with exit code
    2."""

    def __init__(self, prog: str, needs_program: bool = False, **words):
        super().__init__(prog=prog, allow_abbrev=False, **words)
        self.add_argument("--program", type=Path, required=needs_program, help=argparse.SUPPRESS)

    def error(self, message):
        print(f"error: {message}; see: {self.prog} --help", file=sys.stderr)
        sys.exit(2)


def number(text: str) -> float:
    """A finite number, for an option."""
    value = float(text)
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text}: not a finite number")
    return value


def complain(what, code: int) -> int:
    """Tells an error; returns its exit code."""
    print(f"error: {what}", file=sys.stderr)
    return code


def exit_code_of(work: Callable[[], object]) -> int:
    """Does a command's work and tells what goes wrong: 0, 2 for wrong input, 4 for a file."""
    try:
        work()
    except DataError as error:
        return complain(error, 2)
    except (IoError, OSError) as error:
        return complain(error, 4)
    return 0
