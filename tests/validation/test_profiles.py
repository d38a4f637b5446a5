"""Distances of surfaces that are known."""

import math
import tempfile
import unittest
from pathlib import Path

import numpy as np

import synthetic_run
from tailwater.errors import DataError
from tailwater.run import Run
from tailwater_validation.profiles import Profile, profile_at, rms, single_valued, vertical_differences


class SingleValued(unittest.TestCase):
    # Rises to (2, 4), turns back to (1, 5), goes on to (4, 5): two heights and more from 1 to 2.
    X, Y = [0.0, 2, 1, 4], [0.0, 4, 5, 5]

    def test_heights_where_there_is_one(self):
        height = single_valued(self.X, self.Y, [0.0, 0.5, 0.99, 2.01, 3])
        np.testing.assert_allclose(height, [0, 1, 1.98, 5, 5])

    def test_no_height_where_it_overturns_or_is_not(self):
        self.assertTrue(np.isnan(single_valued(self.X, self.Y, [1.01, 1.5, 1.99, -0.1, 4.1])).all())

    def test_joints_and_vertical_pieces_are_met_once(self):
        height = single_valued([0, 1, 1, 2], [1, 1, 3, 3], [0.5, 1, 1.5])
        np.testing.assert_allclose(height, [1, 3, 3])


class Differences(unittest.TestCase):
    STEP = 0.01

    def test_rms_of_a_sine_over_a_flat_surface(self):
        x = np.arange(0, 4 + 1e-9, 1 / 500)
        wave = 0.3 * np.sin(2 * np.pi * x)
        apart = vertical_differences((x, np.ones_like(x)), (x, 1 + wave), self.STEP)
        # Straight lines miss the sine by (2 pi dx)^2/8 of its height; the last of the 400 places is left out.
        self.assertAlmostEqual(rms(apart), 0.3 / math.sqrt(2), delta=0.3 * ((2 * np.pi / 500) ** 2 / 8 + 1 / 400))

    def test_an_overturning_wave_counts_outside_its_fold_only(self):
        computed = (np.array([0.0, 4]), np.array([1.0, 1]))
        apart = vertical_differences((SingleValued.X, SingleValued.Y), computed, self.STEP, start=2.5)
        np.testing.assert_allclose(apart, -4)

    def test_a_computed_surface_that_is_too_short_is_refused(self):
        with self.assertRaisesRegex(DataError, "spans 0..3 m of the measured 0..4"):
            vertical_differences(([0, 4], [0, 0]), (np.array([0.0, 3]), np.zeros(2)), self.STEP)

    def test_a_fold_alone_is_refused(self):
        with self.assertRaisesRegex(DataError, "nowhere single-valued"):
            vertical_differences(([0, 1, 0, 1], [0, 1, 2, 3]), (np.array([0.0, 1]), np.zeros(2)), self.STEP,
                                 start=0.005, end=0.995)


class Profiles(unittest.TestCase):
    def test_area_of_a_wedge_and_its_level(self):
        x = np.linspace(0, 2, 21)
        profile = Profile(0.0, x, bed=np.full(21, 0.5), connected=x / 2, highest=x)
        self.assertAlmostEqual(profile.area(0.33, 1.55), (1.55**2 - 0.33**2) / 4)
        np.testing.assert_allclose(profile.level, 0.5 + x / 2)
        np.testing.assert_allclose(profile.highest_level, 0.5 + x)

    def test_read_by_time(self):
        with tempfile.TemporaryDirectory() as folder:
            run = synthetic_run.make_folder(Path(folder) / "run", "[case]\n")
            synthetic_run.write_probe(run, "surface", {
                "time_s": np.repeat([1.001, 2.002], 3), "x_m": np.tile([0.1, 0.2, 0.3], 2), "bed_m": np.zeros(6),
                "connected_m": np.arange(6.0), "highest_m": np.arange(6.0)})
            profile = profile_at(Run(run), "surface", 2.0)
            self.assertEqual((profile.time, list(profile.connected)), (2.002, [3, 4, 5]))
            with self.assertRaisesRegex(DataError, "no profile at 1.500 s"):
                profile_at(Run(run), "surface", 1.5)


if __name__ == "__main__":
    unittest.main()
