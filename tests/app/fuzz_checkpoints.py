"""Checkpoints with wrong contents behind a right checksum: `tailwater resume` must refuse each with a reason, fail at a
step with a reason, or go on.

mutate_checkpoint knows what a checkpoint is made of: it changes values, how many there are, their type, and the numbers
in its texts. By hand:

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

MUTATE = os.environ["MUTATE_CHECKPOINT"]

COUNT_IN_SUITE = 25


def make_run(folder):
    """A run that was done at 0.05 s, in `folder`; its newest checkpoint."""
    (folder / "small.toml").write_text(SMALL_CASE)
    subprocess.run([PROGRAM, "run", "small.toml", "--out", "run", "--quiet", "--set", "time.end=0.05"], cwd=folder,
                   check=True)
    return max((folder / "run/checkpoints").iterdir())


def resume_one(number, seed, keep, original):
    """(exit code, finding)."""
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
            original = make_run(pathlib.Path(scratch))
            codes, findings = fuzzing.campaign(functools.partial(resume_one, original=original), range(COUNT_IN_SUITE),
                                               "suite")
        self.assertEqual(findings, [])
        self.assertGreater(codes[4], COUNT_IN_SUITE / 4, "most of what is wrong is seen")


def main():
    options = fuzzing.arguments(__doc__).parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        original = make_run(pathlib.Path(scratch))
        return fuzzing.main(options, functools.partial(resume_one, original=original))


if __name__ == "__main__":
    sys.exit(main())
