"""The program under test, called as a user calls it; $TAILWATER is its path."""

import csv
import json
import os
import pathlib
import subprocess
import tempfile
import time
import unittest

PROGRAM = os.environ["TAILWATER"]

SLOWDOWN = int(os.environ.get("TAILWATER_SLOWDOWN", 1))  # of a program with sanitizers

# s; far more than anything here takes, also on a machine that is busy with other work.
PATIENCE = 200 * SLOWDOWN

# A dam break of 50 fluid particles: a run of a few steps takes milliseconds.
SMALL_CASE = """\
[case]
title = "Small dam break"
[particles]
spacing = 0.1
[[fluid]]
name = "column"
min = [0, 0]
max = [1, 0.5]
[[wall]]
name = "tank"
points = [[0, 2], [0, 0], [3, 0], [3, 2]]
[time]
end = 0.1
[output]
fields_interval = 0.02
[[probe]]
name = "depth"
type = "depth"
at = [0.5, 0]
[[probe]]
name = "wall_pressure"
type = "wall-pressure"
at = [0.5, 0]
[[probe]]
name = "energy"
type = "energy"
"""


def environment(traps=True):
    """Floating-point traps on, except where the test provokes values that are not finite."""
    return {**os.environ, "TAILWATER_FP_TRAPS": "1" if traps else "0"}


class ProgramTest(unittest.TestCase):
    """Runs the program in an empty folder, self.folder, which holds the small case as small.toml."""

    maxDiff = None

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        (self.folder / "small.toml").write_text(SMALL_CASE)

    def call(self, *arguments, expect=0, errors_only=True, traps=True, **options):
        """The finished process; its exit code is `expect`. With `errors_only`, a refusal says nothing else."""
        arguments = [str(argument) for argument in arguments]
        result = subprocess.run([PROGRAM, *arguments], cwd=self.folder, env=environment(traps), capture_output=True,
                                text=True, timeout=PATIENCE, **options)
        self.assertEqual(result.returncode, expect, f"{arguments}\n{result.stdout}{result.stderr}")
        if expect != 0 and errors_only:
            self.assertNotEqual(result.stderr, "")
            for line in result.stderr.splitlines():
                self.assertRegex(line, "^(error|warning): ")
        return result

    def start(self, *arguments, **variables):
        """A run that goes on until it is stopped; killed at the end of the test at the latest. `variables` are added to
        its environment."""
        process = subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder, env={**environment(), **variables},
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def wait_for(self, condition, process=None):
        """Waits until the condition holds; fails if the process ends first, or if nothing comes of it."""
        deadline = time.monotonic() + PATIENCE
        while not condition():
            if process is not None:
                self.assertIsNone(process.poll(), "the run ended too early")
            self.assertLess(time.monotonic(), deadline, "nothing has happened")
            time.sleep(0.02)

    def listing(self):
        """Everything in the folder with its content; None for folders."""
        return {str(path.relative_to(self.folder)): path.read_bytes() if path.is_file() else None
                for path in self.folder.rglob("*")}

    def summary(self, run):
        return json.loads((self.folder / run / "summary.json").read_text())

    def whole_lines(self, path):
        """The lines of a table that a run is writing, without one that has not arrived whole."""
        return (self.folder / path).read_text().split("\n")[:-1]

    def table(self, path):
        """A CSV file as (column names, rows of floats). Every line must be whole."""
        with open(self.folder / path, newline="") as file:
            text = file.read()
        self.assertTrue(text.endswith("\n"), f"{path} ends in the middle of a line")
        names, *rows = csv.reader(text.splitlines())
        self.assertEqual(names[0], "time_s")
        for row in rows:
            self.assertEqual(len(row), len(names), f"{path}: {row}")
        return names, [[float(value) for value in row] for row in rows]
