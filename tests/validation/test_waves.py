"""Gauges over made-up waves of which everything is known."""

import tempfile
import unittest
from pathlib import Path

import numpy as np

from tailwater import waves
from tailwater.errors import DataError
from tailwater.run import Run

DEPTH = 0.4
GRAVITY = 9.81
PERIOD = 1.25
PLACES = {"g1": 3.0, "g2": 3.2, "g3": 3.55}


def elevation(x, t, components):
    """Sum of waves (height, period, direction, phase)."""
    total = np.zeros_like(t)
    for height, period, direction, phase in components:
        k = waves.wave_numbers(1 / period, DEPTH, GRAVITY)
        total += 0.5 * height * np.cos(2 * np.pi * t / period - direction * k * x + phase)
    return total


class WaveGauges(unittest.TestCase):
    def run_with(self, components, places=None, end=20.0):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = Path(folder.name)
        (path / "probes").mkdir()
        places = places or PLACES
        probes = "".join(f'[[probe]]\nname = "{name}"\ntype = "depth"\nat = [{x}, 0.0]\n' for name, x in places.items())
        (path / "case.effective.toml").write_text(
            f"[case]\ndimension = 2\n[physics]\ngravity = [0.0, -{GRAVITY}]\n{probes}")
        rng = np.random.default_rng(1)
        for name, x in places.items():
            t = np.cumsum(rng.uniform(0.004, 0.008, int(end / 0.006)))  # steps as uneven as a run's
            depth = DEPTH + elevation(x, t, components)
            (path / "probes" / f"{name}.csv").write_text("time_s,highest_m\n" + "".join(
                f"{time:.9g},{value:.9g}\n" for time, value in zip(t, depth)))
        return Run(path)

    def test_the_wave_number_solves_the_dispersion_relation(self):
        k = waves.wave_numbers([0.1, 0.8, 3.0], DEPTH, GRAVITY)
        np.testing.assert_allclose(GRAVITY * k * np.tanh(k * DEPTH), (2 * np.pi * np.array([0.1, 0.8, 3.0])) ** 2, rtol=1e-12)

    def test_regular_waves_have_their_height_and_period(self):
        numbers, spectra = waves.analyse(self.run_with([(0.05, PERIOD, 1, 0.3)]))
        for gauge in numbers["gauges"].values():
            # Heights between samples 0.006 s apart err by (omega dt)^2/8 each way; lines of 9 digits.
            for key in ("H_mean_m", "H_third_m", "H_max_m"):
                self.assertAlmostEqual(gauge[key], 0.05, delta=0.05 * 2e-3)
            self.assertAlmostEqual(gauge["T_mean_s"], PERIOD, delta=1e-3)
            self.assertAlmostEqual(gauge["T_peak_s"], PERIOD, delta=0.02)
            self.assertAlmostEqual(gauge["depth_m"], DEPTH, delta=1e-4)
            # 4 rms of a sine is sqrt(2) times its height.
            self.assertAlmostEqual(gauge["Hm0_m"], 2**0.5 * 0.05, delta=1e-3 * 0.05)
        self.assertLess(numbers["separation"]["reflection"], 0.01)
        self.assertEqual(numbers["separation"]["runs"], "towards the last gauge")
        self.assertEqual(len(spectra), 4)

    def test_waves_and_reflected_waves_are_told_apart(self):
        for direction, runs in ((1, "towards the last gauge"), (-1, "towards the first gauge")):
            found = waves.analyse(self.run_with([(0.05, PERIOD, direction, 0.3), (0.015, PERIOD, -direction, 1.1)]))
            self.assertAlmostEqual(found[0]["separation"]["reflection"], 0.3, delta=0.01)
            self.assertEqual(found[0]["separation"]["runs"], runs)

    def test_of_irregular_waves_too(self):
        rng = np.random.default_rng(2)
        there = [(0.01, period, 1, phase) for period, phase in zip(rng.uniform(1.0, 1.6, 30), rng.uniform(0, 6.28, 30))]
        back = [(0.2 * height, period, -1, phase + 2) for height, period, _, phase in there]
        numbers, _ = waves.analyse(self.run_with(there + back, end=200.0))
        self.assertAlmostEqual(numbers["separation"]["reflection"], 0.2, delta=0.03)

    def test_gauges_that_cannot_tell_are_refused(self):
        half = np.pi / waves.wave_numbers(1 / PERIOD, DEPTH, GRAVITY)
        run = self.run_with([(0.05, PERIOD, 1, 0)], places={"a": 1.0, "b": 1.0 + half, "c": 1.0 + 2 * half})
        with self.assertRaisesRegex(DataError, "half a wave apart"):
            waves.analyse(run)

    def test_a_solitary_wave_has_its_height_and_speed(self):
        run = self.run_with([])
        height, speed = 0.08, 1.7
        for name, x in PLACES.items():
            t = np.arange(0.0, 8.0, 0.005)
            eta = height / np.cosh(3.0 * (speed * (t - 1.0) - x)) ** 2
            (run.path / "probes" / f"{name}.csv").write_text("time_s,highest_m\n" + "".join(
                f"{time:.9g},{DEPTH + value:.9g}\n" for time, value in zip(t, eta)))
        found = waves.solitary(run)
        self.assertAlmostEqual(found["speed_m_per_s"], speed, delta=1e-3 * speed)
        for gauge in found["gauges"].values():
            self.assertAlmostEqual(gauge["height_m"], height, delta=2e-3 * height)
        # Fenton's third order: 1.2 - 0.002 - 0.000343 of g h.
        self.assertAlmostEqual(found["theory_m_per_s"], (GRAVITY * DEPTH * 1.19766) ** 0.5, delta=1e-3)

    def test_bad_input_names_what_there_is(self):
        run = self.run_with([(0.05, PERIOD, 1, 0)])
        with self.assertRaisesRegex(DataError, "no depth probe 'g9'; it has g1, g2, g3"):
            waves.analyse(run, ["g9"])
        with self.assertRaisesRegex(DataError, "holds 1 waves"):
            waves.analyse(run, start=17.0)
        with self.assertRaisesRegex(DataError, "no times between"):
            waves.analyse(run, start=30.0)


if __name__ == "__main__":
    unittest.main()
