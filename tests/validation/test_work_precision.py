"""Work and precision: the errors of curves whose errors are known, and a file that is drawn again."""

import argparse
import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))

import beside
import box_precision
import interfoam_box
import weir_precision
import work_precision
from tailwater.curves import Curve
from tailwater_validation.studies import kleefsman2005, zhou1999


def run_of(pressure_factor=1.0, level_more=0.0):
    """A run whose curves are one reading of the laboratory, its pressure multiplied, its level raised by a fraction of H."""
    pressure, level = work_precision.measured("P2")[0], work_precision.measured("H1")[0]
    times = np.arange(0.0, work_precision.END, 0.001)
    over_T = times / zhou1999.TIME_SCALE
    return beside.done_with_readings(
        3.0, work_precision.END, 800, len(times), times,
        pressure_factor * zhou1999.PRESSURE_SCALE * np.interp(over_T, pressure.time, pressure.value),
        zhou1999.H * (level_more + np.interp(over_T, level.time, level.value)))


class Errors(unittest.TestCase):
    def setUp(self):
        self.case = beside.zhou(0.03, work_precision.END)
        self.between = work_precision.between_readers()
        self.exact = work_precision.errors_of(run_of(), self.case)

    def test_of_one_reading_is_half_of_the_distance_to_the_other(self):
        for name in ("pressure", "impulse", "level"):
            self.assertAlmostEqual(self.exact[name], self.between[name] / 2, delta=0.12 * self.between[name])

    def test_grow_with_what_is_wrong(self):
        wrong = work_precision.errors_of(run_of(1.5, 0.2), self.case)
        self.assertAlmostEqual(wrong["impulse"], 0.5, delta=0.05)
        self.assertAlmostEqual(wrong["level"], 0.2, delta=0.03)
        self.assertGreater(wrong["pressure"], 2 * self.exact["pressure"])


class OtherBox(interfoam_box.Box):
    """A run of the box whose curves are those of the laboratory, impulses multiplied, later and higher."""

    factor, later, more = 1.0, 0.0, 0.0

    def curve(self, name, column):
        measured = kleefsman2005.laboratory(self, name)
        if name in kleefsman2005.GAUGES:
            return Curve(measured.time, measured.value + self.more * kleefsman2005.DEPTH)
        if column == "impulse_Pa_s":
            impulse = kleefsman2005.impulses(measured)
            return Curve(impulse.time, self.factor * impulse.value)
        return Curve(measured.time + self.later, measured.value)


class Box(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.box = OtherBox(argparse.Namespace(case="kleefsman2005", out=Path(scratch.name), dx=0.05, walls="slip", turbulence="none",
                                               air_density=1.2, surface_tension=0.0))
        self.done = beside.Done(1.0, 2.0, 1, 1, self.box)

    def test_errors_are_those_of_the_curves(self):
        self.assertEqual(set(box_precision.errors_of(self.done).values()), {0.0})
        self.box.factor, self.box.later, self.box.more = 1.1, 0.02, 0.1
        for name, error in {"impulse": 0.1, "arrival": 0.02, "level": 0.1}.items():
            self.assertAlmostEqual(box_precision.errors_of(self.done)[name], error, delta=1e-3)

    def test_mesh_has_a_hole_and_closed_walls(self):
        self.box.mesh()
        text = (self.box.folder / "system/blockMeshDict").read_text()
        self.assertEqual(text.count("hex ("), 4 * 3 * 3 - 1)
        faces = {name: re.search(rf"\b{name} \{{ type .*faces \((.*)\); \}}", text)[1].count("(")
                 for name in ("left", "right", "bottom", "top", "sides", "box")}
        self.assertEqual(faces, {"left": 9, "right": 9, "bottom": 11, "top": 12, "sides": 24, "box": 5})
        self.assertEqual(sum(len(self.box.edges(axis)) - 1 for axis in range(3)), sum(map(sum, self.box.counts)))


class Weir(unittest.TestCase):
    def test_error_is_that_of_the_head(self):
        head = weir_precision.rehbock_head()
        self.assertAlmostEqual(head, 0.0877 + 0.0011, delta=1e-4)  # of laboratory water, and the addition for it
        self.assertEqual(weir_precision.errors_of(beside.Done(1.0, 8.0, 1, 1, head)), {"head": 0.0})
        self.assertAlmostEqual(weir_precision.errors_of(beside.Done(1.0, 8.0, 1, 1, 1.02 * head))["head"], 0.02)

    def test_cells_on_both_sides_of_the_plate_share_no_corners_below_the_crest(self):
        with tempfile.TemporaryDirectory() as folder:
            weir = weir_precision.Weir(argparse.Namespace(out=Path(folder), dx=0.025, end=1.0, walls="slip", turbulence="none"))
            weir.mesh()
            text = (Path(folder) / "system/blockMeshDict").read_text()
        self.assertEqual(text.count("(0.0 0 0.0)"), 2)  # the foot
        self.assertEqual(text.count(f"(0.0 0 {weir_precision.HEIGHT})"), 1)  # the crest


class File(unittest.TestCase):
    def test_is_drawn_again_with_runs_that_did_not_finish(self):
        case = beside.zhou(0.03, work_precision.END)
        code = beside.Code("defaults", "its authors", "run it", run_of)
        runs = [work_precision.record("Tailwater", code, run_of(), "", work_precision.errors_of(run_of(), case)),
                work_precision.record("WCSPH", code, None, "it blew up", {})]
        runs = [run | {"spacing_m": 0.03} for run in runs]
        with tempfile.TemporaryDirectory() as folder:
            file, picture = Path(folder) / "work.json", Path(folder) / "work.webp"
            file.write_text(json.dumps({"case": "zhou", "runs": runs, "between_readers": work_precision.between_readers()}), encoding="utf-8")
            told = subprocess.run([ROOT / "benchmarks/work_precision.py", "--from", file, "--picture", picture], check=True,
                                  stdout=subprocess.PIPE, text=True).stdout
            self.assertGreater(picture.stat().st_size, 5000)
        self.assertIn("3.0 CPU s", told)
        self.assertIn("did not finish: it blew up", told)


if __name__ == "__main__":
    unittest.main()
