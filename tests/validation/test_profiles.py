"""Distances of surfaces that are known."""

import math
import tempfile
import unittest
from pathlib import Path

import numpy as np

import synthetic_run
from tailwater.errors import DataError
from tailwater.run import Run
from tailwater_validation.profiles import Profile, differences_at, profile_at, rms


class Differences(unittest.TestCase):
    def test_of_a_sine_from_a_flat_surface(self):
        x = np.arange(0, 4 + 1e-9, 1 / 500)
        apart = differences_at(np.linspace(0, 4, 401), np.ones(401), x, 1 + 0.3 * np.sin(2 * np.pi * x))
        # The last of the 401 places is one too many.
        self.assertAlmostEqual(rms(apart), 0.3 / math.sqrt(2), delta=0.3 / 400)

    def test_a_computed_surface_that_is_too_short_is_refused(self):
        with self.assertRaisesRegex(DataError, "spans 0..3 m of the measured 0..4"):
            differences_at(np.linspace(0, 4, 9), np.zeros(9), np.array([0.0, 3]), np.zeros(2))


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
