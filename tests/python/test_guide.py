"""The guides run as they are printed: scripts as notebooks, cell by cell, case files with the changes of the guide.

The tests use fewer particles than the guides, and check the guides' statements about the runs."""

import contextlib
import io
import json
import subprocess
import sys
import unittest
from pathlib import Path

import numpy as np
import tailwater as tw
from small import PackageTest

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "scripts"))
import walk_guides  # noqa: E402

GUIDES = ROOT / "docs" / "guide"


def run_notebook(name, least, coarser=()):
    """(names that the cells define, their output); `coarser` (old, new) changes their text."""
    names = {}
    told = io.StringIO()
    subprocess.run([ROOT / "scripts/notebook.py", GUIDES / name, "guide.ipynb"], check=True)
    cells = json.loads(Path("guide.ipynb").read_text(encoding="utf-8"))["cells"]
    blocks = [cell["source"] for cell in cells if cell["cell_type"] == "code"]
    if coarser:
        blocks = [block.replace(*coarser) for block in blocks]
    assert len(blocks) == (GUIDES / name).read_text(encoding="utf-8").count("```python\n") >= least, f"{name}: {len(blocks)} cells"
    with contextlib.redirect_stdout(told):
        for block in blocks:
            exec(compile(block, str(GUIDES / name), "exec"), names)
    return names, told


class Guide(PackageTest):
    def test_search_finds_a_weir_of_the_level(self):
        names, told = run_notebook("optimise.md", 2)
        lines = told.getvalue().splitlines()
        levels = [float(line.split()[-2]) for line in lines if " level " in line]
        self.assertLess(abs(levels[-1] - names["wanted"]), 0.002)
        self.assertLess(abs(names["height"] - 0.213), 0.003)
        self.assertLess(len(levels), 8)
        # And a damper: a stronger damper reduces the swing.
        shares = sorted((float(line.split()[0]), float(line.split()[3])) for line in lines if "of a swing" in line)
        self.assertEqual([share for _, share in shares], sorted((share for _, share in shares), reverse=True))
        self.assertLess(min(abs(share - names["wanted_fraction"]) for _, share in shares), 0.01)
        self.assertLess(abs(names["damping"] - 540), 25)

    def test_study_of_a_weir(self):
        quick = ('template("weir")', 'template("weir").update({"particles.spacing": "P/6", "time.end": 3.0})')
        names, told = run_notebook("weir.md", 1, quick)
        self.assertRegex(told.getvalue(), r"^head \d+ mm, within \d+ mm\n")
        # Six rows in the weir's height: the finest value is near, and the interval contains Rehbock's head.
        row, crest = names["row"], names["case"]["parameters.P"]
        self.assertTrue(0.07 < row["value"] - crest < 0.1, row["value"])
        self.assertTrue(row["low"] < crest + 0.088 < row["high"], row)

    def walk(self, guide, changes, words=()):
        """The names that the guide's blocks of Python define after a sweep of one run; `words` (old, new) changes their
        text."""
        case = tw.Case(walk_guides.write_case(guide))
        self.assertEqual(case.check().findings, [])
        spacing = changes.pop("particles.spacing")
        tw.sweep(case.update(changes), {"particles.spacing": [spacing]}, out=walk_guides.GUIDES[guide])
        with contextlib.redirect_stdout(io.StringIO()):
            return walk_guides.run_blocks(guide, *words)

    def test_waves_on_a_wall(self):
        found = self.walk("waves_on_a_wall", {"particles.spacing": "H/2", "time.end": "5*T"}, ("range(6, 11)", "range(4, 5)"))
        self.assertLess(abs(found["high"] / 50.4e3 - 1), 0.15)
        self.assertLess(abs(found["low"] / -38.6e3 - 1), 0.15)
        self.assertAlmostEqual(found["crest"], 61.3, delta=0.1)

    def test_floating_box(self):
        found = self.walk("floating_box", {"particles.spacing": 0.2, "time.end": 8})
        self.assertLess(abs(found["period"] - 3.99), 0.1)
        self.assertLess(abs(found["place"] - 0.1), 0.01)
        self.assertLess(abs(found["load"] / (25000 * 9.81) - 1), 0.01)
        # Pictures show the hull at its current position.
        hull = found["run"].walls_at(2.0)[1]
        self.assertLess(abs(hull[0][1] - 1.4 - np.interp(2.0, found["rise"].time, found["rise"].value)), 1e-9)

    def test_sloshing(self):
        case = tw.Case(walk_guides.write_case("sloshing")).update({"particles.spacing": "h/5", "time.end": "8*T"})
        self.assertEqual(case.check().findings, [])
        tw.sweep(case, {"parameters.T": [1.98]}, out="baffled")
        del case["wall.baffle"]
        tw.sweep(case, {"parameters.T": [1.98]}, out="tank")
        with contextlib.redirect_stdout(io.StringIO()):
            found = walk_guides.run_blocks("sloshing", "12 * period", "8 * period")["forces"]
        # The baffle takes the water out of resonance: 694 and 165 N/m with these few particles.
        self.assertGreater(found["tank"][1.98], 3 * found["baffled"][1.98])

    def test_runs(self):
        names, told = run_notebook("python.md", 6)
        self.assertEqual(names["case"]["physics.density"], 1000)
        self.assertEqual(names["upstream"].attrs["units"]["connected_m"], "m")
        self.assertEqual(len(names["level"]), 4)
        for level in names["level"]:  # 0.29 m at the start; two to three rows over the crest do not resolve the head
            self.assertAlmostEqual(level, 0.295, delta=0.015)
        self.assertEqual(names["crest"][0][0], 0.0)
        self.assertTrue(np.isfinite(names["crest"]).all())
        # The paddle moves 50 mm in 0.2 s, at most at pi/2 times its mean speed of 0.25 m/s, and so does the water in
        # front of it.
        self.assertTrue(0.05 < names["pushed"] < 1.0, names["pushed"])
        self.assertIn("particles.spacing - ", told.getvalue())


if __name__ == "__main__":
    unittest.main()
