"""The laboratory's surfaces and the scores of a made-up run of cases/janosi2004."""

import tomllib
import unittest
from unittest import mock

import numpy as np

import synthetic_run
from tailwater.run import Run
from tailwater.tables import read_table
from tailwater_validation.studies import janosi2004

CASE = synthetic_run.CASES / "janosi2004" / "case.toml"
DATA = CASE.parent / "data"
PICTURES = sorted(DATA.glob("janosi2004_*.csv"))
START, STEP = 0.40, 0.001  # m: nearer to the gate its guides are seen; between the places that are compared

EFFECTIVE_CASE = synthetic_run.tank_case("A made-up bore", 1.5, 0.3)


def slope(_run, _instant):
    """A surface that is a straight line, so that profiles of any spacing hold it exactly."""
    return np.linspace(0.38, 1.0, 63), np.linspace(0.08, 0.04, 63)


def single_valued(x, y, places):
    """Heights of a polyline at `places`; nan where it passes none or several times."""
    passes, height = np.zeros(places.size, dtype=int), np.zeros(places.size)
    for x0, y0, x1, y1 in zip(x[:-1], y[:-1], x[1:], y[1:]):
        if x0 == x1:
            continue
        # One end belongs to the piece, the other to the next: no place is met twice where two pieces join.
        met = (x0 <= places) & (places < x1) if x0 < x1 else (x1 < places) & (places <= x0)
        passes += met
        height[met] = y0 + (places[met] - x0) / (x1 - x0) * (y1 - y0)
    return np.where(passes == 1, height, np.nan)


def write_run(folder, too_high=0.0, late=0.0):
    """Surfaces `too_high` (m) above the straight line; the one of an instant appears `late` (s) later, and 2 cm higher at
    all other times. The highest water is 1 mm above that."""
    folder = synthetic_run.make_folder(folder, EFFECTIVE_CASE + synthetic_run.measurements("janosi2004"))
    x = np.arange(0.005, 1.5, 0.01)
    (x0, *_, x1), (y0, *_, y1) = slope(None, 0.0)
    line = y0 + (x - x0) / (x1 - x0) * (y1 - y0)
    rows = []
    for instant in janosi2004.INSTANTS:
        for shift in janosi2004.SHIFTS:
            level = line + too_high + 0.02 * (abs(shift - late) > 1e-9)
            rows.append(np.stack([np.full_like(x, instant + shift), x, np.zeros_like(x), level, level + 0.001]))
    synthetic_run.write_surfaces(folder, rows)
    return folder


class Data(unittest.TestCase):
    def test_every_file_says_where_it_comes_from(self):
        self.assertEqual(len(PICTURES), len(janosi2004.INSTANTS))
        for path in DATA.iterdir():
            for word in ("# WHAT:", "# PAPER:", "# SOURCE:", "# CAVEATS:", "# ADDED:"):
                self.assertIn(word, path.read_text(), path)

    def test_added_columns_follow_from_the_raw_ones(self):
        for path in PICTURES:
            table = read_table(path)
            np.testing.assert_allclose(table["x_m"], table["x_cm"] / 100, rtol=1e-5)
            np.testing.assert_allclose(table["y_m"], table["y_cm"] / 100, rtol=1e-5)
            # One shift for each picture.
            self.assertLess(np.ptp(table["y_shifted_m"] - table["y_m"]), 1e-5)

    def test_points_are_those_of_the_pictures(self):
        points = read_table(DATA / "surface_points.csv")
        for instant, path in zip(janosi2004.INSTANTS, PICTURES):
            table, now = read_table(path), points["t_s"] == instant
            x, y = table["x_m"], table["y_shifted_m"]
            first, last = max(x.min(), START), x.max()
            places = np.linspace(first, last, int(np.ceil((last - first) / STEP)) + 1)
            height = single_valued(x, y, places)
            known = np.isfinite(height)
            np.testing.assert_allclose(points["x_m"][now], places[known], atol=1e-6)
            np.testing.assert_allclose(points["connected_m"][now], height[known], atol=1e-6)

    def test_single_values_of_a_line_that_turns_back(self):
        # It rises to (2, 4), turns back to (1, 5), goes on to (4, 5): two heights and more from 1 to 2.
        height = single_valued([0.0, 2, 1, 4], [0.0, 4, 5, 5], np.array([0.5, 0.99, 1.01, 1.99, 2.01, 4.1]))
        np.testing.assert_allclose(height, [1, 1.98, np.nan, np.nan, 5, np.nan])

    def test_the_case_is_the_one_that_is_scored(self):
        with open(CASE, "rb") as file:
            case = tomllib.load(file)
        self.assertEqual(case["parameters"]["d"], janosi2004.DEPTH)
        surface, = (probe for probe in case["probe"] if probe["name"] == "surface")
        np.testing.assert_allclose(surface["times"], [instant + shift for instant in janosi2004.INSTANTS
                                                      for shift in janosi2004.SHIFTS], rtol=1e-9)


class Scores(synthetic_run.CaseTest):
    def score(self, **options):
        write_run(self.folder, **options)
        with mock.patch.object(janosi2004, "laboratory", slope):
            return {metric.name: metric for metric in janosi2004.metrics(Run(self.folder))}

    def test_surfaces_that_are_too_high(self):
        for height, verdict in ((0.003, "met"), (0.005, "missed")):
            metrics = self.score(too_high=height)
            for instant in janosi2004.INSTANTS:
                self.assertEqual(metrics[f"rms {instant:g}"].shift, 0)
                self.assertAlmostEqual(metrics[f"rms {instant:g}"].value, 1000 * height, places=9)
                self.assertAlmostEqual(metrics[f"largest {instant:g}"].value, 1000 * height, places=9)
                self.assertAlmostEqual(metrics[f"rms highest {instant:g}"].value, 1000 * height + 1, places=9)
                self.assertEqual(metrics[f"rms {instant:g}"].verdict,
                                 verdict if instant >= janosi2004.TARGET_FROM else "")
            self.folder = self.folder.with_name("other")

    def test_surfaces_that_come_late(self):
        metrics = self.score(late=0.005)
        for instant in janosi2004.INSTANTS:
            metric = metrics[f"rms {instant:g}"]
            self.assertEqual(metric.shift, 0.005)
            self.assertAlmostEqual(metric.value, 20, places=9)
            self.assertAlmostEqual(metric.shifted_value, 0, places=9)

    def test_drawn(self):
        write_run(self.folder)
        self.assert_drawn(janosi2004)


if __name__ == "__main__":
    unittest.main()
