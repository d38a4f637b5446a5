"""Plates whose waves are known: the waves of the computed motion by the theory of wave makers."""

import contextlib
import io
import math
import tempfile
import unittest
from pathlib import Path

import numpy as np

from tailwater import paddle

DEPTH = 0.4


def wave_number(frequency):
    """omega^2 = g k tanh kh, by bisection."""
    low, high = 1e-3, 1e3
    for _ in range(200):
        middle = (low + high) / 2
        below = 9.81 * middle * math.tanh(middle * DEPTH) < (2 * math.pi * frequency) ** 2
        low, high = (middle, high) if below else (low, middle)
    return low


class Paddle(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        self.to = self.folder / "paddle.csv"

    def make(self, text, *options, expect=0):
        """The output of the command."""
        file = self.folder / "waves.csv"
        file.write_text(text, encoding="utf-8")
        told, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(told), contextlib.redirect_stderr(errors):
            code = paddle.main(["--program", "x", str(file), "--to", str(self.to), "--depth", str(DEPTH), *map(str, options)])
        self.assertEqual(code, expect, errors.getvalue())
        return errors.getvalue() if expect else told.getvalue()

    def record(self, *sines):
        """A record of sines of (frequency, amplitude in m), in mm and ms."""
        time = np.arange(0, 60, 0.02)
        surface = sum(1000 * a * np.cos(2 * math.pi * f * time) for f, a in sines)
        return "# of a flume\nt [ms], eta [mm]\n" + "".join(f"{1000 * t:.1f}, {z:.6f}\n" for t, z in zip(time, surface))

    def sine_of(self, frequency, start, end):
        """The plate's amplitude (m) and phase, as a sine of the record's time, between two times of the file."""
        t, x = np.loadtxt(self.to, delimiter=",", skiprows=1).T
        inside = (t > start) & (t < end)
        t, x = t[inside], x[inside]
        shape = np.stack([np.sin(2 * math.pi * frequency * t), np.cos(2 * math.pi * frequency * t)], axis=1)
        sine, cosine = np.linalg.lstsq(shape, x, rcond=None)[0]
        return math.hypot(sine, cosine), math.atan2(cosine, sine)

    def test_piston_makes_the_recorded_wave(self):
        for distance in (0.0, 3.0):
            told = self.make(self.record((0.6, 0.02)), "--distance", distance)
            y = wave_number(0.6) * DEPTH
            # Dean & Dalrymple (1991), 6.25
            height_over_stroke = 2 * (math.cosh(2 * y) - 1) / (math.sinh(2 * y) + 2 * y)
            begins = float(told.rpartition("t = ")[2].split()[0]) if distance else 0.0
            amplitude, phase = self.sine_of(0.6, begins + 15, begins + 45)
            self.assertAlmostEqual(amplitude * height_over_stroke, 0.02, delta=2e-5)
            # cos(w (t - begins)) at the gauge is sin(w t + phase) at the plate: the cosine leads by a quarter period,
            # and the gauge lags by kx.
            wanted = -2 * math.pi * 0.6 * begins + wave_number(0.6) * distance
            self.assertAlmostEqual(math.sin(phase - wanted), 0.0, delta=0.01)
            self.assertGreater(math.cos(phase - wanted), 0.0)

    def test_flap_needs_more_than_a_piston(self):
        self.make(self.record((0.6, 0.02)), "--flap")
        self.assertEqual(self.to.read_text(encoding="utf-8").splitlines()[0], "t [s], angle [rad]")
        t, angle = np.loadtxt(self.to, delimiter=",", skiprows=1).T
        y = wave_number(0.6) * DEPTH
        height_over_stroke = 4 * math.sinh(y) / y * (y * math.sinh(y) - math.cosh(y) + 1) / (math.sinh(2 * y) + 2 * y)
        self.make(self.record((0.6, 0.02)))
        piston = np.loadtxt(self.to, delimiter=",", skiprows=1).T[1]
        self.assertLess(np.corrcoef(angle, piston)[0, 1], -0.99)  # counter-clockwise is away from the water
        largest = np.abs(DEPTH * np.tan(angle[(t > 20) & (t < 40)])).max()
        # lines at most 1/40 period from the crest
        self.assertAlmostEqual(largest * height_over_stroke, 0.02, delta=2e-4)

    def test_motion_begins_and_ends_at_rest(self):
        self.make(self.record((0.6, 0.02)))
        t, x = np.loadtxt(self.to, delimiter=",", skiprows=1).T
        self.assertEqual((t[0], x[0], x[-1]), (0.0, 0.0, 0.0))
        self.assertLess(np.abs(np.diff(x[:4])).max(), 1e-3 * np.abs(x).max())

    def test_what_is_outside_of_the_band_is_told(self):
        told = self.make(self.record((0.6, 0.02), (3.0, 0.01)))
        share = 100 * 0.01**2 / (0.01**2 + 0.02**2)
        self.assertAlmostEqual(float(told.partition("leaves out ")[2].split()[0]), share, delta=0.5)

    def test_spectrum_has_its_height_and_is_that_of_its_seed(self):
        spectrum = "f [Hz], S [cm^2/Hz]\n" + "".join(f"{f}, {s}\n" for f, s in ((0.3, 0), (0.5, 40), (0.7, 40), (0.9, 0)))
        told = self.make(spectrum, "--duration", 100)
        # from the area of the spectrum
        self.assertAlmostEqual(float(told.partition("Hm0 ")[2].split()[0]), 4 * math.sqrt(16e-4), delta=1e-3)
        first = self.to.read_bytes()
        self.make(spectrum, "--duration", 100, "--seed", 2)
        self.assertNotEqual(self.to.read_bytes(), first)
        self.make(spectrum, "--duration", 100)
        self.assertEqual(self.to.read_bytes(), first)

    def test_sizes_are_refused_before_there_is_memory_for_them(self):
        for text, words in (("t [s], eta [mm]\n0, 0\n1e-9, 1\n1e9, 2\n", ()),
                            ("f [Hz], S [m^2/Hz]\n1, 1e-5\n2, 1e-5\n1e9, 0\n", ("--duration", 60)),
                            ("t [s], eta [mm]\n0, 0\n0.1, 1\n0.2, 0\n", ("--distance", 1e300))):
            self.assertIn("samples", self.make(text, *words, expect=2))
        self.assertIn("values are all the same", self.make("t [s], eta [mm]\n0, 1\n1, 1\n2, 1\n", expect=2))
        self.assertIn("beyond 1e+09", self.make("t [s], eta [mm]\n0, 1\n1, 1e300\n2, 1\n", expect=2))

    def test_what_is_wrong_is_told(self):
        good = self.record((0.6, 0.02))
        for text, options, words in ((good.replace("eta [mm]", "eta [inch]"), (), "eta [inch]"),
                                     (good.replace("eta", "zeta"), (), "waves.csv:2"), ("", (), "is empty"),
                                     ("t [s], eta [m]\n0, 1\n0, 2\n1, 3\n", (), "ascends"),
                                     ("t [s], eta [m]\n0, 1\n1, a\n", (), "waves.csv:3"),
                                     ("t [s], S [m^2/Hz]\n0, 1\n1, 1\n2, 1\n", (), "needed are"),
                                     ("f [Hz], S [m^2 s]\n0, 1\n1, 1\n2, 1\n", (), "--duration"),
                                     (good, ("--band", 5, 6), "outside of the band"),
                                     (good.replace("eta [mm]", "eta [m]"), (), "they break")):
            self.assertIn(words, self.make(text, *options, expect=2))
        self.assertFalse(self.to.exists())
        self.to = self.folder / "waves.csv"
        self.assertIn("is the file that the command reads", self.make(good, expect=2))
        self.assertEqual(self.to.read_text(encoding="utf-8"), good)

    def test_height_is_that_of_the_record_at_any_distance(self):
        for distance in (0.0, 30.0):
            told = self.make(self.record((0.6, 0.02)), "--distance", distance)
            self.assertAlmostEqual(float(told.partition("Hm0 ")[2].split()[0]), 4 * 0.02 / math.sqrt(2), delta=1e-3)


if __name__ == "__main__":
    unittest.main()
