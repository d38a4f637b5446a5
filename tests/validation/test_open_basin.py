"""The shallow-water equations in a basin with open ends, by the solutions that they must come to."""

import math
import unittest

import numpy as np

from tailwater_validation import openings, panels
from tailwater_validation.open_basin import WALL, Discharge, Level, basin
from tailwater_validation.shallow_water import stoker_state


class OpenBasin(unittest.TestCase):
    def test_still_water_at_the_level_outside_stays(self):
        depths, discharges = basin(5.0, 1.0, 0.0, (WALL, Level(lambda t: 1.0)), [3.0, 30.0], [1.0, 4.0], cells=50)
        self.assertLess(np.abs(depths - 1.0).max(), 1e-12)
        self.assertLess(np.abs(discharges).max(), 1e-12)

    def test_even_flow_stays_even(self):
        depths, discharges = basin(5.0, 1.0, 0.4, (Discharge(lambda t: 0.4), Level(lambda t: 1.0)), [30.0], [2.0], cells=50)
        self.assertAlmostEqual(depths[0, 0], 1.0, places=10)
        self.assertAlmostEqual(discharges[0, 0], 0.4, places=10)

    def test_a_discharge_brings_its_volume(self):
        depths, _ = basin(4.0, 0.5, 0.0, (Discharge(lambda t: 0.1), WALL), [5.0], (np.arange(100) + 0.5) * 0.04, cells=100)
        self.assertAlmostEqual(float(depths.mean()) * 4.0, 4.0 * 0.5 + 0.1 * 5.0, places=9)

    def test_a_level_at_a_dry_bed_gives_critical_flow(self):
        # Behind the front comes the fan h = (3 c0 - x/t)^2/9, with c0^2 = 2/3 of the head; the discharge is that of critical flow.
        depths, discharges = basin(8.0, 1e-7, 0.0, (Level(lambda t: 1.0), WALL), [3.0], [0.01, 1.0], cells=1600)
        c0 = math.sqrt(2 / 3)
        self.assertAlmostEqual(discharges[0, 0], (2 / 3) ** 1.5, delta=0.005)
        self.assertAlmostEqual(depths[0, 1], (3 * c0 - 1.0 / 3.0) ** 2 / 9 - 0.0, delta=0.01)

    def test_a_brink_draws_still_water_down_to_critical_depth(self):
        # Ritter's dam break: 4/9 of the depth, and 8/27 leave.
        depths, discharges = basin(10.0, 1.0, 0.0, (WALL, Level(lambda t: 0.0)), [5.0], [9.99], cells=1000)
        self.assertAlmostEqual(depths[0, 0], 4 / 9, delta=0.005)
        self.assertAlmostEqual(discharges[0, 0], 8 / 27, delta=0.003)

    def test_a_high_discharge_sends_stokers_bore(self):
        # The state behind the bore of a dam break, whose discharge is prescribed instead of the dam.
        depth, speed, bore = stoker_state(0.2)
        depths, _ = basin(8.0, 0.2, 0.0, (Discharge(lambda t: depth * speed), WALL), [4.0], [1.0, 0.9 * bore * 4.0, 1.1 * bore * 4.0], cells=800)
        self.assertAlmostEqual(depths[0, 0], depth, delta=0.003)
        self.assertAlmostEqual(depths[0, 1], depth, delta=0.01)
        self.assertAlmostEqual(depths[0, 2], 0.2, delta=0.001)

    def test_a_basin_swings_with_four_crossings(self):
        times = np.arange(0.0, 40.0, 0.1)
        depths, _ = basin(5.0, 1.001, 0.0, (WALL, Level(lambda t: 1.0)), times, [0.1], cells=100)
        crossings = times[1:][np.diff(np.sign(depths[:, 0] - 1.0)) != 0]
        self.assertAlmostEqual(float(np.mean(np.diff(crossings))), 10.0, delta=0.15)  # half of 4 L/c


class Band(unittest.TestCase):
    def test_a_late_curve_is_inside_and_a_high_one_is_not(self):
        times = np.linspace(0.0, 10.0, 1001)
        low, high = openings.band(times, np.sin(times), 0.2)
        late = np.sin(times - 0.19)
        inside = (times > 0.5) & (times < 9.5)
        self.assertTrue(((late >= low) & (late <= high))[inside].all())
        self.assertAlmostEqual(float((np.sin(times) + 0.3 - high)[inside].max()), 0.3, places=3)


class Histories(unittest.TestCase):
    def test_of_a_run_that_starts_dry_are_empty(self):
        times = np.linspace(0.0, 1.0, 5 * panels.BINS)
        self.assertEqual(panels.curve("dry", times, np.full(times.size, np.nan))["y"], [])


if __name__ == "__main__":
    unittest.main()
