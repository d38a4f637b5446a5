"""Runs made by the program under test: several at a time, in order of a list, and none twice.

Every run is an ordinary folder, OUT/runs/NAME, with one file more, made.json: what it was made from and how it ended. A
run whose made.json tells of the same case, settings and program is not made again.
"""

import hashlib
import json
import re
import shlex
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from .curves import DataError
from .run_folder import RunFolder

INTERRUPTED = 130
POLL = 0.1  # s
# A run that takes this many times what it was estimated at, and so much longer at least, is stopped.
PATIENCE = 10
LEAST_PATIENCE = 600  # s


def digest(path):
    """Of a file's content; "" if there is none."""
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else ""


@dataclass(frozen=True)
class Run:
    """A case with settings (key=value); `seconds` is about what it costs on one core. The name is that of its folder
    and belongs to one case and one set of settings."""

    name: str
    case: Path
    settings: tuple = ()
    seconds: float = 10.0

    def recipe(self, program):
        """What the results depend on."""
        return {"case": digest(self.case), "settings": list(self.settings), "program": program.identity,
                "ranks": program.ranks}

    def command(self, program, folder):
        return [str(program.path), "run", str(self.case), "--out", str(folder), "--force", "--quiet",
                "-n", str(program.ranks), *settings_of(self)]

    def open(self, folder):
        return RunFolder(folder)


@dataclass(frozen=True)
class TestRun:
    """The GoogleTest program of a room of the build, for the numbers that the tests matching `tests` record."""

    name: str
    room: str
    tests: str
    seconds: float = 10.0

    def file(self, program):
        return program.path.with_name(f"test_{self.room}")

    def recipe(self, program):
        return {"tests": digest(self.file(program)), "filter": self.tests}

    def command(self, program, folder):
        # Through env, whose message is the run's if the tests have not been built.
        return ["/usr/bin/env", str(self.file(program)), f"--gtest_filter={self.tests}", "--gtest_brief=1",
                f"--gtest_output=json:{folder / 'tests.json'}"]

    def open(self, folder):
        """{name: number} of all that the tests recorded (RecordProperty), which are texts that hold a number."""
        suites = json.loads((folder / "tests.json").read_text(encoding="utf-8"))["testsuites"]
        entries = [entry for suite in suites for test in suite["testsuite"] for entry in test.items()]
        return {name: float(value) for name, value in entries
                if isinstance(value, str) and re.fullmatch(r"[-+.\deE]*\d", value)}


class Program:
    """The program under test, on so many ranks. Throws DataError if it cannot be started."""

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
        """The commit; of a program with changes that have none, its content."""
        if not self.commit.endswith("-dirty") and self.commit != "unknown":
            return self.commit
        return digest(self.path)


def outcome(folder):
    """{recipe, exit_code, message} of a run that has ended; {} if there is none."""
    try:
        return json.loads((folder / "made.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}


def finished(run, out):
    """What a run that reached its end left: a RunFolder, or the numbers of tests. Throws DataError with the program's
    own message for any other."""
    folder = out / "runs" / run.name
    made = outcome(folder)
    if not made:
        raise DataError(f"{run.name}: not made")
    if made["exit_code"] != 0:
        raise DataError(f"{run.name}: {made['message'] or 'failed'}")
    return run.open(folder)


def settings_of(run):
    """As words of a command line."""
    return [word for setting in run.settings for word in ("--set", setting)]


def require_accepted(run, program, out):
    """Throws DataError, with what the program says, if it does not accept the case with these settings."""
    command = [program.path, "check", run.case, "--no-preview", *settings_of(run)]
    result = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    if result.returncode != 0:
        raise DataError(result.stderr.strip().removeprefix("error: ") or f"{run.name}: exit code {result.returncode}")


def message_of(folder, errors):
    """Why a run failed, in one line: its summary, or what the program said."""
    try:
        told = json.loads((folder / "summary.json").read_text(encoding="utf-8")).get("message", "")
    except (OSError, ValueError):
        told = ""
    return " ".join((told or errors).split())


class Progress:
    """Lines on standard error: what has ended, and when the rest should."""

    def __init__(self, runs, jobs):
        self.total, self.jobs = len(runs), jobs
        self.estimated_left = sum(run.seconds for run in runs)
        self.done, self.estimated, self.taken = 0, 0.0, 0.0

    def ended(self, run, seconds, how):
        self.done += 1
        self.estimated += run.seconds
        self.taken += seconds
        self.estimated_left -= run.seconds
        left = max(0.0, self.estimated_left) * self.taken / self.estimated / self.jobs
        print(f"[{self.done}/{self.total}] {run.name}: {how} in {seconds:.0f} s; ETA {duration(left)}",
              file=sys.stderr, flush=True)


def duration(seconds):
    """"40 s", "12 min" or "3.5 h"."""
    return (f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.0f} min" if seconds < 6000
            else f"{seconds / 3600:.1f} h")


class Child:
    """One run under way."""

    def __init__(self, run, program, out):
        self.run, self.folder = run, out / "runs" / run.name
        command = run.command(program, self.folder)
        self.made = {"recipe": run.recipe(program), "command": shlex.join(command)}
        self.folder.mkdir(parents=True, exist_ok=True)
        (self.folder / "made.json").unlink(missing_ok=True)
        self.messages = open(self.folder / "messages.txt", "w+", encoding="utf-8")
        # A session of its own: Ctrl-C reaches it through `stop` only, once.
        self.process = subprocess.Popen(command, stdout=subprocess.DEVNULL,
                                        stderr=self.messages, start_new_session=True)
        self.start = time.monotonic()
        self.stopped = ""

    @property
    def seconds(self):
        return time.monotonic() - self.start

    def stop(self, reason):
        """Asks the run to end in order."""
        self.stopped = reason
        self.process.send_signal(signal.SIGINT)

    def has_ended(self):
        if self.seconds > max(LEAST_PATIENCE, PATIENCE * self.run.seconds) and not self.stopped:
            self.stop(f"stopped after {self.seconds:.0f} s, estimated at {self.run.seconds:.0f} s")
        return self.process.poll() is not None

    def close(self):
        """Writes made.json; returns how the run ended, in words."""
        self.messages.seek(0)
        errors = self.messages.read()
        self.messages.close()
        code = self.process.returncode
        message = "" if code == 0 else self.stopped or message_of(self.folder, errors) or f"exit code {code}"
        text = json.dumps(self.made | {"exit_code": code, "message": message}, indent=2)
        (self.folder / "made.json").write_text(text + "\n", encoding="utf-8")
        return "done" if code == 0 else f"failed ({message})"


def make(runs, program, out, jobs):
    """Makes the runs that are not there yet, `jobs` at a time. A run that fails is left as it is. On KeyboardInterrupt
    the runs under way are stopped, to be made again next time, and it is raised again."""
    waiting = [run for run in runs if outcome(out / "runs" / run.name).get("recipe") != run.recipe(program)]
    if len(waiting) < len(runs):
        print(f"{len(runs) - len(waiting)} of {len(runs)} runs are there already", file=sys.stderr)
    progress, children = Progress(waiting, jobs), []
    try:
        while waiting or children:
            while waiting and len(children) < jobs:
                children.append(Child(waiting.pop(0), program, out))
            time.sleep(POLL)
            for child in [child for child in children if child.has_ended()]:
                children.remove(child)
                progress.ended(child.run, child.seconds, child.close())
    except KeyboardInterrupt:
        for child in children:
            child.stop("interrupted")
        for child in children:
            child.process.wait()
            child.messages.close()
        raise
