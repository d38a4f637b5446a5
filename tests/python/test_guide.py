"""The guide docs/guide/python.md runs as it stands, block after block, and its words about the run are true."""

import contextlib
import io
import re
import unittest
from pathlib import Path

import numpy as np
from small import PackageTest

GUIDE = Path(__file__).resolve().parents[2] / "docs" / "guide" / "python.md"


class Guide(PackageTest):
    def test_runs(self):
        names = {}
        told = io.StringIO()
        blocks = re.findall(r"^```python\n(.*?)^```", GUIDE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
        self.assertGreater(len(blocks), 5)
        with contextlib.redirect_stdout(told):
            for block in blocks:
                exec(compile(block, str(GUIDE), "exec"), names)
        self.assertEqual(names["case"]["physics.density"], 1000)
        self.assertEqual(names["upstream"].attrs["units"]["connected_m"], "m")
        self.assertEqual(len(names["level"]), 4)
        # More discharge stands higher.
        self.assertGreater(names["level"][1], names["level"][0])
        self.assertGreater(names["level"][3], names["level"][2])
        self.assertEqual(names["crest"][0][0], 0.0)
        self.assertTrue(np.isfinite(names["crest"]).all())
        self.assertIn("particles.spacing - ", told.getvalue())


if __name__ == "__main__":
    unittest.main()
