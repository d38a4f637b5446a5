"""Finds and calls the program `tailwater`."""

import ctypes
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

BAD_INPUT, INTERRUPTED = 2, 130  # exit codes
PR_SET_PDEATHSIG = 1  # linux/prctl.h
LIBC = ctypes.CDLL(None)  # loaded here, since a process that forks from a thread must not load it


@lru_cache(maxsize=None)
def program() -> Path:
    """The path of the program: $TAILWATER, otherwise PREFIX/bin/tailwater of the installation or build that contains
    this package, otherwise the program in PATH.

    Throws IoError if none of these exists."""
    named = os.environ.get("TAILWATER")
    beside = Path(__file__).absolute().parents[4] / "bin" / "tailwater"
    found = named or (beside if beside.is_file() else shutil.which("tailwater"))
    if not found:
        raise IoError(f"there is no {beside} and no tailwater in PATH; remedy: install the program, or name it in "
                      "the environment variable TAILWATER")
    return Path(found)


@lru_cache(maxsize=None)
def version() -> str:
    """The version line of the program, "tailwater 1.0.0 (commit ...)"."""
    return call("--version").strip()


def environment():
    """The environment for the program. Under mpirun it omits the variables of MPI, so that the program does not become
    a rank of that run."""
    if "PMIX_RANK" not in os.environ and "PMI_RANK" not in os.environ:
        return None
    return {name: value for name, value in os.environ.items() if not name.startswith(("OMPI_", "PMIX_", "PMI_"))}


def stop_with_parent():
    """In a new process: requests SIGTERM, which stops a run as Ctrl-C does, when the thread that started it ends for any
    reason."""
    LIBC.prctl(PR_SET_PDEATHSIG, int(signal.SIGTERM))


def start(*words, folder=None, in_child=None) -> subprocess.Popen:
    """Starts the program with pipes for its outputs, in its own session, which Ctrl-C does not reach. `in_child` is called
    in the new process. Throws IoError."""
    command = [str(program()), *map(str, words)]
    try:
        return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=folder,
                                env=environment(), start_new_session=True, preexec_fn=in_child)
    except OSError as error:
        raise IoError(f"{command[0]}: cannot be started ({error.strerror})") from error


def call(*words, progress: bool = False, folder=None, reports_errors: bool = False) -> str:
    """The standard output of the program. Its warnings become Python warnings (RunWarning).

    With `progress`, its standard error is shown. Throws InputError, SolverError or IoError by the exit code of the
    program, but not for wrong input if `reports_errors` and the standard output reports its errors. KeyboardInterrupt
    first interrupts the program and waits for its end. If this process is killed, a run of the program stops with a
    checkpoint."""
    child = start(*words, folder=folder, in_child=stop_with_parent)
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
    if child.returncode not in ((0, BAD_INPUT) if reports_errors and said else (0,)):
        raise error_of(child.returncode, told)
    return said


def follow(child) -> tuple:
    """Shows the standard error of a child process, except its error message, which the caller receives. Only for
    commands with little standard output, which is read at the end."""
    told = []
    for line in child.stderr:
        told.append(line)
        if not line.startswith("error: "):
            print(line, end="", file=sys.stderr, flush=True)
    return child.communicate()[0], "".join(told)
