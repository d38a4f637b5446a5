"""Command-line options and error messages, common to the package's commands and in the style of the program."""

import argparse
import math
import os
import signal
import sys
import warnings
from collections.abc import Callable
from pathlib import Path

from .errors import DataError, InputError, IoError, RunWarning, SolverError

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


def show_warning(message, *_, **__):
    print(f"warning: {message}", file=sys.stderr)


def exit_code_of(work: Callable[[], object], code_of_data: int = 2) -> int:
    """Runs a command and prints its warnings, each once, and its error. Returns what `work` returns, or 0 for None; 2
    for wrong input, 3 for a failed solve, 4 for a file and 130 after Ctrl-C or SIGTERM; `code_of_data` for insufficient
    data. A reader of the output may leave early, as head does."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # so that runs of the command stop before it ends
    with warnings.catch_warnings():
        warnings.simplefilter("once", RunWarning)
        warnings.showwarning = show_warning
        try:
            code = work() or 0
            sys.stdout.flush()
            return code
        except InputError as error:
            return complain(error, 2)
        except SolverError as error:
            return complain(error, 3)
        except DataError as error:
            return complain(error, code_of_data)
        except IoError as error:
            return complain(error, 4)
        except BrokenPipeError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # which Python flushes at its end
            return 0
        except OSError as error:
            return complain(f"{error.filename}: {error.strerror}" if error.filename else error, 4)
        except KeyboardInterrupt:
            return 130
