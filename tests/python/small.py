"""Cases of a few particles, and a test class with a working folder."""

import os
import tempfile
import unittest

DAM = """\
# A small dam break
[case]
title = "Small dam break"
[parameters]
H = 0.5   # m
[particles]
spacing = 0.1
[[fluid]]
name = "column"
min = [0, 0]
max = [1, "H"]
[[wall]]
name = "tank"
points = [[0, 2], [0, 0],
          [3, 0], [3, 2]]
[time]
end = 0.1
[[probe]]
name = "depth"
type = "depth"
at = [0.5, 0]
"""

# No force acts on the drop except those of a script.
DROP = """\
[case]
title = "A drop that nothing holds"
[physics]
gravity = [0, 0]
[particles]
spacing = 0.1
[[fluid]]
name = "drop"
min = [0, 0]
max = [0.5, 0.5]
velocity = [1, 0]
[time]
end = 0.2
"""


class PackageTest(unittest.TestCase):
    """A test in an empty folder, which is the working folder."""

    maxDiff = None

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(scratch.name)

    def write(self, name, text):
        with open(name, "w", encoding="utf-8") as file:
            file.write(text)
        return name
