"""The program `tailwater`: where it is, and calling it."""

import os
import shutil
import signal
import subprocess
import sys
import warnings
from functools import lru_cache
from pathlib import Path

from .errors import IoError, RunWarning, error_of

__all__ = ["call", "program", "version"]

INTERRUPTED = 130


@lru_cache(maxsize=None)
def program() -> Path:
    """$TAILWATER, else PREFIX/bin/tailwater of the installation or build that has this package, else that in PATH.

    Throws IoError where there is none."""
    named = os.environ.get("TAILWATER")
    beside = Path(__file__).absolute().parents[4] / "bin" / "tailwater"
    found = named or (beside if beside.is_file() else shutil.which("tailwater"))
    if not found:
        raise IoError(f"there is no {beside} and no tailwater in PATH; remedy: install the program, or name it in "
                      "the environment variable TAILWATER")
    return Path(found)


@lru_cache(maxsize=None)
def version() -> str:
    """"tailwater 1.0.0 (commit ...)"."""
    return call("--version").strip()


def environment():
    """What a program starts with. It is no rank of an mpirun that this process is a rank of."""
    if "PMIX_RANK" not in os.environ and "PMI_RANK" not in os.environ:
        return None
    return {name: value for name, value in os.environ.items() if not name.startswith(("OMPI_", "PMIX_", "PMI_"))}


def start(*words, folder=None) -> subprocess.Popen:
    """The program, whose outputs are pipes; in a session of its own, which Ctrl-C does not reach. Throws IoError."""
    command = [str(program()), *map(str, words)]
    try:
        return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=folder,
                                env=environment(), start_new_session=True)
    except OSError as error:
        raise IoError(f"{command[0]}: cannot be started ({error.strerror})") from error


def call(*words, progress: bool = False, folder=None) -> str:
    """What the program says on standard output. Its warnings become Python's (RunWarning).

    With `progress`, what it tells on standard error is shown. Throws InputError, SolverError or IoError as the program
    ends; KeyboardInterrupt ends it in order first."""
    child = start(*words, folder=folder)
    try:
        said, told = follow(child) if progress else child.communicate()
    except KeyboardInterrupt:
        child.send_signal(signal.SIGINT)
        child.communicate()
        raise
    for line in told.splitlines():
        if line.startswith("warning: "):
            warnings.warn(line.removeprefix("warning: "), RunWarning, stacklevel=3)
    if child.returncode == INTERRUPTED:
        raise KeyboardInterrupt
    if child.returncode != 0:
        raise error_of(child.returncode, told)
    return said


def follow(child) -> tuple:
    """Shows what the child tells, but not its error, which the caller gets; for commands that say little on standard
    output."""
    told = []
    for line in child.stderr:
        told.append(line)
        if not line.startswith("error: "):
            print(line, end="", file=sys.stderr, flush=True)
    return child.communicate()[0], "".join(told)
