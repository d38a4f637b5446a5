"""Which of a package's two programs is started."""

import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

HAS_AVX2 = " avx2 " in Path("/proc/cpuinfo").read_text(encoding="utf-8")


class TwoPrograms(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        prefix = Path(scratch.name)
        self.program, self.faster = prefix / "bin/tailwater", prefix / "lib/tailwater/tailwater-v3"
        for path in (self.program, self.faster):
            path.parent.mkdir(parents=True)
        shutil.copy(os.environ["CHOOSE"], self.program)
        self.faster.write_text('#!/bin/sh\necho x86-64-v3 "$@"\n', encoding="utf-8")
        self.faster.chmod(0o755)

    def started(self, *arguments, arch=None, program=None):
        ended = subprocess.run([program or self.program, *arguments], capture_output=True, text=True, check=False,
                               env={} if arch is None else {"TAILWATER_ARCH": arch})
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        return ended.stdout.strip()

    def test_the_processor_chooses(self):
        self.assertEqual(self.started("info"), "x86-64-v3 info" if HAS_AVX2 else "x86-64-v2")

    def test_a_link_is_followed(self):
        link = self.program.parent / "link"
        link.symlink_to(self.program)
        self.assertEqual(self.started(program=link), self.started())

    def test_the_environment_chooses(self):
        self.assertEqual(self.started(arch="x86-64-v2"), "x86-64-v2")
        self.assertEqual(self.started(arch="x86-64-v3"), "x86-64-v3")

    def test_what_the_environment_may_not_say_is_told(self):
        ended = subprocess.run([self.program], capture_output=True, text=True, check=False, env={"TAILWATER_ARCH": "native"})
        self.assertEqual((ended.returncode, ended.stdout), (2, ""))
        self.assertRegex(ended.stderr, "^error: TAILWATER_ARCH=native .*x86-64-v2 and x86-64-v3\n$")

    def test_without_the_faster_one_the_other_goes_on(self):
        self.faster.unlink()
        self.assertEqual(self.started(), "x86-64-v2")


if __name__ == "__main__":
    unittest.main()
