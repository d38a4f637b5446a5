"""Work and precision: the errors of curves whose errors are known, and a file that is drawn again."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))

import beside
import work_precision
from tailwater_validation.studies import zhou1999


def run_of(pressure_factor=1.0, level_more=0.0):
    """A run whose curves are one reading of the laboratory, its pressure multiplied, its level raised by a fraction of H."""
    pressure, level = work_precision.measured("P2")[0], work_precision.measured("H1")[0]
    times = np.arange(0.0, work_precision.END, 0.001)
    over_T = times / zhou1999.TIME_SCALE
    return beside.Done(3.0, work_precision.END, 800, len(times), times,
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


class File(unittest.TestCase):
    def test_is_drawn_again_with_runs_that_did_not_finish(self):
        case = beside.zhou(0.03, work_precision.END)
        code = beside.Code("defaults", "its authors", "run it", run_of)
        done = {"spacing_m": 0.03, "errors": work_precision.errors_of(run_of(), case)}
        runs = [beside.record("Tailwater", code, case, run_of(), "") | done,
                beside.record("WCSPH", code, case, None, "it blew up") | {"spacing_m": 0.03}]
        with tempfile.TemporaryDirectory() as folder:
            file, picture = Path(folder) / "work.json", Path(folder) / "work.webp"
            file.write_text(json.dumps({"runs": runs, "between_readers": work_precision.between_readers()}), encoding="utf-8")
            told = subprocess.run([ROOT / "benchmarks/work_precision.py", "--from", file, "--picture", picture], check=True,
                                  stdout=subprocess.PIPE, text=True).stdout
            self.assertGreater(picture.stat().st_size, 5000)
        self.assertIn("3.0 CPU s", told)
        self.assertIn("did not finish: it blew up", told)


if __name__ == "__main__":
    unittest.main()
