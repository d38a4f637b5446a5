"""Distribution of a run's time, from perf's samples: functions of the program by name, and libraries as a whole."""

import re
import shutil
import subprocess
from pathlib import Path

from tailwater.errors import DataError

from .metric import Metric

LEAST_SHARE = 1.0  # %; smaller ones are not shown
SAMPLES_PER_SECOND = 499  # prime, so that no loop keeps step with it


def require_perf():
    if shutil.which("perf") is None:
        raise DataError("--part profile needs perf; remedy: apt-get install linux-perf")


def name_of(library, symbol):
    """Name under which a sample is counted: the function without templates and parameters; a library; the kernel."""
    if symbol.startswith("[k]"):
        return "kernel"
    if library.strip() != "tailwater":
        return re.split(r"\.so|-\d", library.strip())[0]
    name = re.sub(r"\(anonymous namespace\)::|<[23]>", "", symbol.removeprefix("[.]").strip())
    return re.split(r"[<(]", name)[0].split(" ")[-1].removeprefix("tailwater::")


def shares(report):
    """{name: % of the samples}, largest first, from `perf report` with fields share|library|symbol."""
    found = {}
    for line in report.splitlines():
        fields = [field.strip() for field in line.split("|")]
        if len(fields) == 3 and fields[0].endswith("%"):
            name = name_of(fields[1], fields[2])
            found[name] = found.get(name, 0.0) + float(fields[0].rstrip("%"))
    return dict(sorted(found.items(), key=lambda item: -item[1]))


def perf(arguments):
    told = subprocess.run(["perf", *arguments], capture_output=True, text=True, check=False)
    if told.returncode != 0:
        raise DataError(f"perf {arguments[0]}: {' '.join(told.stderr.split())[:300]}")
    return told.stdout


def measure(runner, dimension, command):
    """Fractions of the command's CPU time."""
    samples = str(Path(runner.folder) / "perf.data")
    perf(["record", "-q", "-F", str(SAMPLES_PER_SECOND), "-o", samples, "--", *command])
    report = perf(["report", "-i", samples, "--stdio", "--no-children", "-g", "none", "-t", "|", "-F",
                   "overhead,dso,sym"])
    return [Metric(f"profile.{dimension}D.{name}", f"{dimension}D, {name}", "% of the CPU time", "", value=share)
            for name, share in shares(report).items() if share >= LEAST_SHARE]
