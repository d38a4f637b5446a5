"""Scores of curves whose scores are known."""

import math
import tempfile
import unittest
from pathlib import Path

import numpy as np

from tailwater.curves import Curve, read_curve
from tailwater.errors import DataError
from tailwater.tables import read_table
from tailwater_validation.curves import (arrival_time, best_shift, first_peak, noise, passage_time, rms_difference,
                                         running_median)


class Reading(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "probe.csv"

    def write(self, text):
        self.path.write_text(text)
        return self.path

    def test_columns_by_name_without_provenance(self):
        table = read_table(self.write("# WHAT: a, b\n# more\ntime_s,depth_m\n0,1.5\n0.5,2e-1\n\n"))
        self.assertEqual({name: list(column) for name, column in table.items()},
                         {"time_s": [0, 0.5], "depth_m": [1.5, 0.2]})

    def test_samples_are_sorted_and_repeated_times_averaged(self):
        curve = read_curve(self.write("t,v\n1,10\n0,4\n1,20\n0.5,7\n1,0\n"), "v", time_column="t")
        self.assertEqual(list(curve.time), [0, 0.5, 1])
        self.assertEqual(list(curve.value), [4, 7, 10])

    def test_what_cannot_be_read_says_where_and_why(self):
        cases = {
            "time_s,v\n0,1\n1,wet\n": f"{self.path}:3:.*wet",
            "time_s,v\n0,1\n1\n": f"{self.path}:3: 1 numbers under 2 names",
            "time_s,depth_m\n0,1\n": "no column v; it has time_s, depth_m",
            "time_s,v\n0,nan\n": "v: holds a number that is not finite",
            "# only words\n": "no lines of numbers",
        }
        for text, message in cases.items():
            with self.subTest(text), self.assertRaisesRegex(DataError, message):
                read_curve(self.write(text), "v")
        with self.assertRaisesRegex(DataError, "absent.csv: cannot be read"):
            read_curve(self.path.with_name("absent.csv"), "v")


class Differences(unittest.TestCase):
    OMEGA = 2 * math.pi
    SAMPLING = 1 / 500
    STEP = 1 / 100
    # Straight lines between samples miss a sine by at most (omega dt)^2/8, twice for two curves.
    INTERPOLATION = 2 * (OMEGA * SAMPLING) ** 2 / 8

    def sine(self, delay=0.0):
        time = np.arange(-1000, 3501) * self.SAMPLING
        return Curve(time, np.sin(self.OMEGA * (time - delay)))

    def rms_of_delay(self, delay):
        """sin(w t) - sin(w (t - d)) = 2 sin(w d/2) cos(...): RMS over whole periods."""
        return math.sqrt(2) * abs(math.sin(self.OMEGA * delay / 2))

    def tolerance(self, start, end):
        """The grid counts both ends of the period: a weight of one in N too much, of at most twice the mean square."""
        return self.INTERPOLATION + 1 / ((end - start) / self.STEP)

    def test_rms_of_a_delayed_sine(self):
        for delay in (0.0, 0.05, 0.25, 0.5):
            with self.subTest(delay):
                self.assertAlmostEqual(rms_difference(self.sine(), self.sine(delay), 0, 4, self.STEP),
                                       self.rms_of_delay(delay), delta=self.tolerance(0, 4))

    def test_rms_of_a_constant_is_that_constant(self):
        curve = self.sine()
        self.assertAlmostEqual(rms_difference(curve, Curve(curve.time, curve.value - 0.3), 0, 4, self.STEP), 0.3,
                               places=12)

    def test_best_shift_finds_the_delay_in_either_direction(self):
        for delay in (0.0731, -0.0731):
            found, rms = best_shift(self.sine(), self.sine(delay), 0, 4, self.STEP, limit=0.12)
            half_a_trial = 0.12 / 120
            self.assertLessEqual(abs(found - delay), half_a_trial + self.INTERPOLATION)
            self.assertLessEqual(rms, self.rms_of_delay(half_a_trial) + self.tolerance(0, 4) * self.rms_of_delay(0.002)
                                 + self.INTERPOLATION)

    def test_best_shift_keeps_to_its_limit(self):
        found, rms = best_shift(self.sine(), self.sine(0.2), 0, 4, self.STEP, limit=0.12)
        self.assertAlmostEqual(found, 0.12)
        self.assertAlmostEqual(rms, self.rms_of_delay(0.08), delta=self.tolerance(0, 4))

    def test_a_curve_that_ends_early_is_refused(self):
        whole = self.sine()
        with self.assertRaisesRegex(DataError, "share only 0..2 of the window 0..4"):
            rms_difference(whole, whole.window(0, 2), 0, 4, self.STEP)
        with self.assertRaisesRegex(DataError, "share nothing"):
            rms_difference(whole, whole.window(5, 6), 0, 4, self.STEP)


class Events(unittest.TestCase):
    def test_arrival_is_the_first_sample_above_the_threshold(self):
        curve = Curve(np.array([0.0, 1, 2, 3, 4]), np.array([0, 0.9, 0.05, 0.2, 0.1]))
        self.assertEqual(arrival_time(curve, 0.05), 1)
        self.assertEqual(arrival_time(curve, 0.05, not_before=1.5), 3)
        self.assertIsNone(arrival_time(curve, 1.0))

    def test_passage_is_the_first_rise_between_samples(self):
        curve = Curve(np.array([0.0, 1, 3, 4, 5]), np.array([1.0, 1, 5, 2, 9]))
        self.assertEqual(passage_time(curve, 4), 2.5)
        for level in (0.5, 1, 10):
            with self.subTest(level), self.assertRaisesRegex(DataError, "does not rise through"):
                passage_time(curve, level)

    def test_first_peak_is_not_the_later_larger_one(self):
        curve = Curve(np.array([0.0, 1, 2, 3, 4]), np.array([0, 0.4, 0.6, 0.3, 2]))
        self.assertEqual(first_peak(curve, arrival=1, within=2), (2, 0.6))
        with self.assertRaisesRegex(DataError, "ends before the first peak is over"):
            first_peak(curve, arrival=3, within=2)

    def test_a_steady_rise_has_no_peak(self):
        with self.assertRaisesRegex(DataError, "no peak"):
            first_peak(Curve(np.arange(5.0), np.arange(5.0)), arrival=1, within=2)


class Noise(unittest.TestCase):
    WIDTH = 0.02

    def sawtooth(self, amplitude, samples_per_period, sampling):
        time = np.arange(0, 2, sampling)
        phase = np.arange(time.size) % samples_per_period
        return Curve(time, amplitude * (2 * phase / (samples_per_period - 1) - 1))

    def test_sawtooth_on_a_slope(self):
        # The median's width holds five periods of 40 samples, and one sample more or less: its error is at most one
        # step between neighbouring values. RMS of n equally spaced values from -a to a: a sqrt((n+1)/(3(n-1))).
        n, amplitude = 40, 0.3
        step = 2 * amplitude / (n - 1)
        rms = amplitude * math.sqrt((n + 1) / (3 * (n - 1)))
        saw = self.sawtooth(amplitude, n, sampling=1e-4)
        # A slope that rises by one step over the width moves the median by at most another one.
        slope = step / self.WIDTH
        for rise in (0.0, slope):
            curve = Curve(saw.time, saw.value + 7 + rise * saw.time)
            self.assertAlmostEqual(noise(curve, 0.6, 1.4, self.WIDTH), rms, delta=2 * step)

    def test_a_smooth_rise_is_no_noise(self):
        time = np.arange(0, 2, 1e-3)
        # Symmetric window on a straight line: the median is the line, but for a sample at one end of the window that
        # rounding puts outside: half a sample's rise.
        self.assertLessEqual(noise(Curve(time, 3 * time), 0.6, 1.4, self.WIDTH), 3 * 1e-3 / 2 + 1e-12)

    def test_noise_outside_the_window_does_not_count(self):
        time = np.arange(0, 2, 1e-3)
        loud = np.where((time < 0.5) | (time > 1.5), np.sin(1e4 * time), 1.0)
        self.assertEqual(noise(Curve(time, loud), 0.6, 1.4, self.WIDTH), 0)

    def test_samples_too_far_apart_are_refused(self):
        time = np.arange(0, 2, 0.01)
        with self.assertRaisesRegex(DataError, "write the probe at every step"):
            noise(Curve(time, np.sin(time)), 0.6, 1.4, self.WIDTH)

    def test_a_curve_that_misses_the_window_is_refused(self):
        time = np.arange(0, 1, 1e-3)
        with self.assertRaisesRegex(DataError, "does not cover"):
            noise(Curve(time, time), 0.6, 1.4, self.WIDTH)

    def test_running_median_passes_over_a_single_spike(self):
        value = np.ones(9)
        value[4] = 50
        self.assertEqual(list(running_median(Curve(np.arange(9.0), value), 2.0)), [1] * 9)


if __name__ == "__main__":
    unittest.main()
