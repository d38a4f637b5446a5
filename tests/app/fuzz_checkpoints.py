"""Mutated checkpoints with a valid checksum: `tailwater resume` must refuse each, fail at a step or continue.

Each refusal or failure needs a reason. mutate_checkpoint changes values, their number and type, and the numbers in
texts. To run a campaign:

    TAILWATER=build/release/bin/tailwater MUTATE_CHECKPOINT=build/release/bin/mutate_checkpoint \\
        /usr/bin/python3 -B tests/app/fuzz_checkpoints.py --count 1000
"""

import functools
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import zlib

import fuzzing
from program import PROGRAM, SMALL_CASE
from test_resume import BARGE, FLUME, GATE, POCKET, WAVES

MUTATE = os.environ["MUTATE_CHECKPOINT"]

# Cases whose checkpoints have different datasets.
CASES = ((), GATE, WAVES, BARGE, FLUME, POCKET)

COUNT_IN_SUITE = 25


def make_runs(folder):
    """Runs each case to 0.05 s, in `folder`; returns the newest checkpoints."""
    (folder / "small.toml").write_text(SMALL_CASE)
    newest = []
    for k, changes in enumerate(CASES):
        subprocess.run([PROGRAM, "run", "small.toml", "--out", str(k), "--quiet", "--set", "time.end=0.05", *changes],
                       cwd=folder, check=True)
        newest.append(max((folder / str(k) / "checkpoints").iterdir()))
    return newest


def resume_one(number, seed, keep, originals):
    """(exit code, finding)."""
    original = originals[number % len(originals)]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        shutil.copytree(original.parents[1], folder / "run")
        checkpoint = folder / "run/checkpoints" / original.name
        mutation = subprocess.run([MUTATE, original, checkpoint, str(zlib.crc32(f"{seed} {number}".encode()))],
                                  check=True, capture_output=True, text=True)
        code, error = fuzzing.run_within_limits(["resume", "run", "--quiet", "--set", "time.end=0.07"], folder)
        finding = fuzzing.look_for_findings(code, error, (0, 2, 3, 4))
        if finding is None and code in (2, 4) and "run/" not in error:
            finding = "refused without the name of a file"
        if finding and keep:
            shutil.copy(checkpoint, keep / f"{seed}-{number}.h5")
            (keep / f"{seed}-{number}.txt").write_text(f"{mutation.stdout}{finding}; exit code {code}\n{error}")
    return code, finding


class MutatedCheckpoints(unittest.TestCase):
    def test_each_is_answered(self):
        with tempfile.TemporaryDirectory() as scratch:
            originals = make_runs(pathlib.Path(scratch))
            codes, findings = fuzzing.campaign(functools.partial(resume_one, originals=originals),
                                               range(COUNT_IN_SUITE), "suite")
        self.assertEqual(findings, [])
        self.assertGreater(codes[4], COUNT_IN_SUITE / 4, "most of what is wrong is seen")


def main():
    options = fuzzing.arguments(__doc__).parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        originals = make_runs(pathlib.Path(scratch))
        return fuzzing.main(options, functools.partial(resume_one, originals=originals))


if __name__ == "__main__":
    sys.exit(main())
