"""`tailwater refine`: thin water, and the zones proposed for it."""

import contextlib
import io
import tempfile
import tomllib
import unittest
from pathlib import Path

import numpy as np

import tailwater as tw
from tailwater import refine, thin_water

CASE = """\
[case]
title = "A jet on a pool"
[particles]
spacing = 0.02
[time]
end = 0.02
[output]
fields_interval = 0.01
[[fluid]]
name = "pool"
min = [0.0, 0.0]
max = [1.6, 0.5]
[[fluid]]
name = "jet"
min = [0.96, 0.5]
max = [1.04, 1.2]
[[wall]]
name = "tank"
shape = "box"
min = [0.0, 0.0]
max = [1.6, 2.0]
open = ["+y"]
fluid_side = "inside"
[[probe]]
name = "deep"
type = "depth"
at = [0.3, 0.0]
"""


class RowsAlong(unittest.TestCase):
    def test_are_unbroken_and_have_one_volume(self):
        volume = np.array([[1.0, 2.0, 0.0, 4.0], [5.0, 0.1, 7.0, 8.0]])
        holds = volume > 0.5
        np.testing.assert_allclose(thin_water.rows_along(volume, holds, 1), [[3, 3, 0, 4], [5, 0, 15, 15]])
        np.testing.assert_allclose(thin_water.rows_along(volume, holds, 0), [[6, 2, 0, 12], [6, 0, 7, 12]])


class Refine(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.case = cls.folder / "jet.toml"
        cls.case.write_text(CASE)
        cls.run_folder = tw.Case(cls.case).run(cls.folder / "run").path

    def command(self, *words):
        """Exit code, output and messages."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = refine.main(list(map(str, words)))
        return code, out.getvalue(), err.getvalue()

    def test_a_zone_holds_the_jet_and_not_the_pool(self):
        refined = self.folder / "refined.toml"
        code, out, err = self.command(self.run_folder, "--case", self.case, "--write", refined)
        self.assertEqual(code, 0, err)
        zone, = tomllib.loads(refined.read_text())["refinement"]
        self.assertEqual(tomllib.loads(out)["refinement"], [zone], "it can be pasted")
        self.assertTrue(zone["min"][0] < 0.96 and zone["max"][0] > 1.04 and zone["min"][1] < 0.56 and zone["max"][1] > 1.2)
        self.assertGreater(zone["min"][1], 0.2)
        self.assertIn("# water 4 rows thick, 100 % of the time", out)
        self.assertIn("when full", out)
        self.assertTrue(tw.Case(refined).check())
        self.assertEqual(self.command(self.run_folder, "--case", self.case, "--write", refined)[0], 2, "exists")

    def test_wrong_words_are_refused_with_a_remedy(self):
        self.assertIn("--case FILE", self.command(self.run_folder)[2])
        self.assertIn("is not the folder of a run", self.command(self.folder, "--case", self.case)[2])
        self.assertEqual(self.command(self.folder / "no.toml")[0], 4)
        self.assertEqual(self.command(self.folder / "nowhere")[0], 2)
        for words in (("--level", 5), ("--zones", 0)):
            with self.assertRaises(SystemExit) as end, contextlib.redirect_stderr(io.StringIO()):
                refine.main([str(self.case), *map(str, words)])
            self.assertEqual(end.exception.code, 2)

    def test_a_case_without_room_for_zones_is_not_run(self):
        thick = self.folder / "thick.toml"
        thick.write_text(CASE.replace('[[fluid]]', '[[fluid]]\nliquid = "mud"') +
                         '[[liquid]]\nname = "mud"\nviscosity = 1.0\n')
        code, _, err = self.command(thick)
        self.assertEqual(code, 2)
        self.assertIn("thick.toml: zones of refinement do not work with other liquids than water; remedy: refine the whole case", err)
        self.assertFalse(Path("thick_coarse").exists())

    def test_water_that_is_thin_everywhere_needs_another_spacing(self):
        run = tw.Run(self.run_folder)
        with self.assertRaisesRegex(tw.DataError, "particles.spacing = 0.05"):
            refine.propose(run, 0.1, 1, 3)


if __name__ == "__main__":
    unittest.main()
