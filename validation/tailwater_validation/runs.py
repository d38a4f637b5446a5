"""Runs by the program under test: several at a time, in the order of a list, and none twice.
Every run is an ordinary folder, OUT/runs/NAME, with an additional file made.json: its case, settings, program and
outcome. A run whose made.json has the same case, settings and program is not repeated."""

import hashlib
import json
import re
import shlex
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

from tailwater.errors import DataError
from tailwater.run import Run as RunFolder

INTERRUPTED = 130
# A run that takes this many times its estimate, and so much longer at least, is stopped.
PATIENCE = 10
LEAST_PATIENCE = 600  # s


def digest(path):
    """Hash of a file's content; "" if there is none."""
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else ""


@dataclass(frozen=True)
class Run:
    """A case with settings (key=value); `seconds` is its approximate cost on one core. The name is that of its
    folder and belongs to one case with one set of settings."""

    name: str
    case: Path
    settings: tuple = ()
    seconds: float = 10.0

    def recipe(self, program):
        """Inputs on which the results depend."""
        return {"case": digest(self.case), "settings": list(self.settings), "program": program.identity,
                "ranks": program.ranks}

    def command(self, program, folder):
        return [str(program.path), "run", str(self.case), "--out", str(folder), "--force", "--quiet",
                "-n", str(program.ranks), *settings_of(self)]

    def open(self, folder):
        return RunFolder(folder)


@dataclass(frozen=True)
class TestRun:
    """The GoogleTest program of a module of the build, for the numbers recorded by the tests that match `tests`."""

    name: str
    module: str
    tests: str
    seconds: float = 10.0

    def file(self, program):
        return program.path.with_name(f"test_{self.module}")

    def recipe(self, program):
        return {"tests": digest(self.file(program)), "filter": self.tests}

    def command(self, program, folder):
        # Through env, whose message is the run's if the tests have not been built.
        return ["/usr/bin/env", str(self.file(program)), f"--gtest_filter={self.tests}", "--gtest_brief=1",
                f"--gtest_output=json:{folder / 'tests.json'}"]

    def open(self, folder):
        """{name: number} of all numbers that the tests recorded (RecordProperty), as texts."""
        suites = json.loads((folder / "tests.json").read_text(encoding="utf-8"))["testsuites"]
        entries = [entry for suite in suites for test in suite["testsuite"] for entry in test.items()]
        return {name: float(value) for name, value in entries
                if isinstance(value, str) and re.fullmatch(r"[-+.\deE]*\d", value)}


class Program:
    """The program under test, on a number of ranks. Throws DataError if it cannot be started."""

    def __init__(self, path, ranks=1):
        self.path, self.ranks = Path(path).absolute(), ranks
        try:
            told = subprocess.run([self.path, "--version"], capture_output=True, text=True, check=True).stdout
        except (OSError, subprocess.CalledProcessError) as error:
            raise DataError(f"{path}: cannot be started ({error})") from error
        match = re.search(r"tailwater (\S+) \(commit (\S+)\)", told)
        if match is None:
            raise DataError(f"{path}: --version says {told!r}, not \"tailwater VERSION (commit COMMIT)\"")
        self.version, self.commit = match.groups()

    @property
    def identity(self):
        """The commit of the program; for a program with uncommitted changes, its content."""
        if not self.commit.endswith("-dirty") and self.commit != "unknown":
            return self.commit
        return digest(self.path)


def outcome(folder):
    """{recipe, exit_code, message} of a run that has ended; {} if it has not been made."""
    try:
        return json.loads((folder / "made.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}


def finished(run, out):
    """Result of a run that reached its end: a RunFolder, or the numbers of tests. Throws DataError with the
    program's message for any other run."""
    folder = out / "runs" / run.name
    made = outcome(folder)
    if not made:
        raise DataError(f"{run.name}: not made")
    if made["exit_code"] != 0:
        raise DataError(f"{run.name}: {made['message'] or 'failed'}")
    return run.open(folder)


def settings_of(run):
    """Settings as command-line words."""
    return [word for setting in run.settings for word in ("--set", setting)]


def require_accepted(run, program, out):
    """Throws DataError, with the program's message, if it does not accept the case with these settings."""
    command = [program.path, "check", run.case, "--no-preview", *settings_of(run)]
    result = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    if result.returncode != 0:
        raise DataError(result.stderr.strip().removeprefix("error: ") or f"{run.name}: exit code {result.returncode}")


def message_of(folder, errors):
    """The cause of a failed run, in one line: from its summary, or the program's message."""
    try:
        told = json.loads((folder / "summary.json").read_text(encoding="utf-8")).get("message", "")
    except (OSError, ValueError):
        told = ""
    return " ".join((told or errors).split())


def duration(seconds):
    """"40 s", "12 min" or "3.5 h"."""
    return (f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.0f} min" if seconds < 6000
            else f"{seconds / 3600:.1f} h")


def end_of(process, run):
    """The reason why a run was stopped: a run that takes far longer than estimated is stopped with its files
    complete."""
    patience = max(LEAST_PATIENCE, PATIENCE * run.seconds)
    try:
        process.wait(patience)
        return ""
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGINT)
        process.wait()
        return f"stopped after {patience:.0f} s, estimated at {run.seconds:.0f} s"


def make_one(run, program, out, under_way, stopping):
    """Makes a run and writes made.json; returns its time (s) and its outcome in words. Meanwhile its process is in
    `under_way`."""
    folder, start = out / "runs" / run.name, time.monotonic()
    made = folder / "made.json"
    folder.mkdir(parents=True, exist_ok=True)
    made.unlink(missing_ok=True)
    command = run.command(program, folder)
    with open(folder / "messages.txt", "w+", encoding="utf-8") as messages:
        # A session of its own: Ctrl-C reaches it through `make` only, once.
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=messages, start_new_session=True)
        under_way.add(process)
        if stopping.is_set():
            process.send_signal(signal.SIGINT)
        stopped = end_of(process, run)
        under_way.remove(process)
        if stopping.is_set():
            return 0.0, "interrupted"  # and to be made again
        messages.seek(0)
        code = process.returncode
        message = "" if code == 0 else stopped or message_of(folder, messages.read()) or f"exit code {code}"
    text = json.dumps({"recipe": run.recipe(program), "command": shlex.join(command), "exit_code": code, "message": message},
                      indent=2)
    made.write_text(text + "\n", encoding="utf-8")
    return time.monotonic() - start, "done" if code == 0 else f"failed ({message})"


def make(runs, program, out, jobs):
    """Makes the missing runs, `jobs` at a time, and reports on standard error which runs have ended and when the
    rest should end. A run that fails is left as it is. KeyboardInterrupt stops the current runs, which are made
    again next time, and is raised again."""
    waiting = [run for run in runs if outcome(out / "runs" / run.name).get("recipe") != run.recipe(program)]
    if len(waiting) < len(runs):
        print(f"{len(runs) - len(waiting)} of {len(runs)} runs are there already", file=sys.stderr)
    left, estimated, taken = sum(run.seconds for run in waiting), 0.0, 0.0
    under_way, stopping = set(), threading.Event()
    with ThreadPoolExecutor(jobs) as pool:
        jobs_of = {pool.submit(make_one, run, program, out, under_way, stopping): run for run in waiting}
        try:
            for number, job in enumerate(as_completed(jobs_of), 1):
                run, (seconds, how) = jobs_of[job], job.result()
                left, estimated, taken = left - run.seconds, estimated + run.seconds, taken + seconds
                print(f"[{number}/{len(waiting)}] {run.name}: {how} in {seconds:.0f} s; "
                      f"ETA {duration(max(0.0, left) * taken / estimated / jobs)}", file=sys.stderr, flush=True)
        except KeyboardInterrupt:
            stopping.set()
            pool.shutdown(wait=False, cancel_futures=True)
            for process in list(under_way):
                process.send_signal(signal.SIGINT)
            raise
