"""The surfaces of the laboratory and the scores of a made-up run of cases/liu1999."""

import tomllib
import unittest
from unittest import mock

import numpy as np

import synthetic_run
from tailwater.run import Run
from tailwater.tables import read_table
from tailwater_validation.studies import liu1999

CASE = synthetic_run.CASES / "liu1999" / "case.toml"
DATA = CASE.parent / "data"

EFFECTIVE_CASE = synthetic_run.tank_case("A made-up dam break", 0.9, 0.5)


def slope(_run, _instant):
    """A straight surface, so that profiles of any spacing represent it exactly."""
    return np.linspace(0.05, 0.85, 41), np.linspace(0.2, 0.1, 41)


class Data(unittest.TestCase):
    def test_every_file_says_where_it_comes_from(self):
        for path in DATA.iterdir():
            for word in ("# WHAT:", "# PAPER:", "# SOURCE:", "# CAVEATS:", "# ADDED:"):
                self.assertIn(word, path.read_text(), path)

    def test_points_are_those_of_the_profiles(self):
        points = read_table(DATA / "surface_points.csv")
        self.assertEqual(sorted(set(points["t_s"])), list(liu1999.INSTANTS))
        for instant in liu1999.INSTANTS:
            now = points["t_s"] == instant
            table = read_table(DATA / f"profile_t{instant:.1f}.csv")
            np.testing.assert_array_equal(points["x_m"][now], table["x_m"])
            np.testing.assert_array_equal(points["connected_m"][now], table["surface_m"])

    def test_the_case_is_the_one_that_is_scored(self):
        with open(CASE, "rb") as file:
            case = tomllib.load(file)
        surface, = (probe for probe in case["probe"] if probe["name"] == "surface")
        np.testing.assert_allclose(surface["times"], liu1999.INSTANTS)
        rock, = case["porous"]
        self.assertEqual((rock["min"][0], rock["max"][0]), liu1999.ROCK)


class Scores(synthetic_run.CaseTest):
    def score(self, too_high):
        """The scores of surfaces that are `too_high` (m) above the straight line."""
        folder = synthetic_run.make_folder(self.folder, EFFECTIVE_CASE + synthetic_run.measurements("liu1999"))
        x = np.arange(0.005, 0.9, 0.01)
        (x0, *_, x1), (y0, *_, y1) = slope(None, 0.0)
        level = y0 + (x - x0) / (x1 - x0) * (y1 - y0) + too_high
        rows = [np.stack([np.full_like(x, instant), x, np.zeros_like(x), level, level]) for instant in liu1999.INSTANTS]
        synthetic_run.write_surfaces(folder, rows)
        with mock.patch.object(liu1999, "laboratory", slope):
            return {metric.name: metric for metric in liu1999.metrics(Run(folder))}

    def test_surfaces_that_are_too_high(self):
        metrics = self.score(0.005)
        self.assertAlmostEqual(metrics["rms"].value, 5, places=9)
        self.assertEqual(metrics["rms"].verdict, "met")
        for instant in liu1999.INSTANTS:
            self.assertAlmostEqual(metrics[f"rms {instant:g}"].value, 5, places=9)

    def test_surfaces_that_miss_the_target(self):
        self.assertEqual(self.score(-0.013)["rms"].verdict, "missed")

    def test_drawn(self):
        self.score(0.0)
        self.assert_drawn(liu1999)


if __name__ == "__main__":
    unittest.main()
