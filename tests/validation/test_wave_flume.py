"""Waves with known properties, at the gauges of cases/wave_flume."""

import tempfile
import unittest
from pathlib import Path

import numpy as np

from tailwater.run import Run
from tailwater.waves import wave_numbers
from tailwater_validation import wave_flume

DEPTH, LENGTH, HEIGHT, G = 0.2, 1.25, 0.08, 9.81
LOW = 0.01  # m; height of waves that superpose without waves that both trains bind
PERIOD = 2 * np.pi / (G * 2 * np.pi / LENGTH * np.tanh(2 * np.pi / LENGTH * DEPTH)) ** 0.5


def add_gauge(path, name, x, times, level):
    """Writes the readings of a gauge, and returns the gauge's table of the case; `level` is above the still water."""
    (path / "probes" / f"{name}.csv").write_text("time_s,highest_m\n" + "".join(
        f"{time:.12g},{DEPTH + z:.12g}\n" for time, z in zip(times, level)))
    return f'[[probe]]\nname = "{name}"\ntype = "depth"\nat = [{x}, 0.0]\n'


class WaveFlume(unittest.TestCase):
    def run_with(self, decay, reflected, longer=1.0):
        """Waves of height `LOW` at the first gauge, with `longer` times the wavelength of linear theory. They decay
        by exp(-decay) per length, and the far end reflects the fraction `reflected` to the gauges there."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = Path(folder.name)
        (path / "probes").mkdir()
        places = {"a": 0.5 * LENGTH + LENGTH * np.array([0, 0.1, 0.25, 0.4]), "b": 10.5 * LENGTH + LENGTH * np.array([0, 0.1, 0.25, 0.4])}
        tables, t = "", np.arange(0, 22 * PERIOD, 0.004)
        k = 2 * np.pi / LENGTH / longer
        for letter, group in places.items():
            for n, x in enumerate(group, 1):
                height = LOW * np.exp(-decay * (group[0] / LENGTH - 0.5))
                phase = 2 * np.pi * t / PERIOD
                level = 0.5 * height * np.cos(phase - k * x)
                if letter == "b":
                    level += 0.5 * reflected * height * np.cos(phase + k * x + 0.4)
                tables += add_gauge(path, f"{letter}{n}", x, t, level)
        (path / "case.effective.toml").write_text(
            f"[case]\ndimension = 2\n[physics]\ngravity = [0.0, -{G}]\n[time]\nend = {22 * PERIOD}\n"
            f"[parameters]\nh = {DEPTH}\nL = {LENGTH}\nT = {PERIOD}\nH = {LOW}\n{tables}")
        return Run(path)

    def test_waves_that_neither_decay_nor_come_back(self):
        numbers = wave_flume.wave_flume(self.run_with(0.0, 0.0))
        self.assertAlmostEqual(numbers["height_left"], 1.0, delta=1e-3)
        self.assertAlmostEqual(numbers["height_error"], 0.0, delta=1e-3)
        self.assertLess(numbers["reflection"], 2e-3)

    def test_decay_and_reflection_are_told_apart_also_of_longer_waves(self):
        numbers = wave_flume.wave_flume(self.run_with(0.03, 0.1, longer=1.05))
        self.assertAlmostEqual(numbers["height_left"], np.exp(-0.3), delta=3e-3)
        self.assertAlmostEqual(numbers["reflection"], 0.1, delta=3e-3)
        self.assertAlmostEqual(numbers["longer_than_linear"], 0.05, delta=3e-3)

    def test_the_linear_wave_number_is_the_cases(self):
        self.assertAlmostEqual(float(wave_numbers(1 / PERIOD, DEPTH, G)) * LENGTH, 2 * np.pi, places=6)


class IrregularWaves(unittest.TestCase):
    PERIODS, SEED = 40, 7

    def run_with(self, height_factor=1.0, high_factor=1.0, reflected=0.0):
        """The sea of a seed with `height_factor` times its height. Components above the peak frequency are also
        multiplied by `high_factor`, and the fraction `reflected` of all waves is reflected."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = Path(folder.name)
        (path / "probes").mkdir()
        start = 2 * PERIOD
        end = start + self.PERIODS * PERIOD
        t = np.linspace(0, end, 2500)
        amplitude, omega, k, phase = wave_flume.sea(self.SEED, HEIGHT, PERIOD, DEPTH, G)
        amplitude = amplitude * height_factor * np.where(omega > 1.1 * 2 * np.pi / PERIOD, high_factor, 1.0)
        tables = f'[[wave_maker]]\nname = "piston"\nseed = {self.SEED}\n'
        for n, x in enumerate(0.5 * LENGTH + LENGTH * np.array([0, 0.1, 0.25, 0.4]), 1):
            angle = np.outer(t, omega) + phase
            level = (np.cos(angle - k * x) + reflected * np.cos(angle + k * x)) @ amplitude
            tables += add_gauge(path, f"a{n}", x, t, level)
        (path / "case.effective.toml").write_text(
            f"[case]\ndimension = 2\n[physics]\ngravity = [0.0, -{G}]\n[time]\nend = {end}\n"
            f"[parameters]\nh = {DEPTH}\nT = {PERIOD}\nH = {HEIGHT}\nwindow = {start}\n{tables}")
        return Run(path)

    def test_the_sea_that_was_made(self):
        numbers = wave_flume.irregular_waves(self.run_with())
        for name in ("height_error", "period_error", "parts_error"):
            self.assertAlmostEqual(numbers[name], 0.0, delta=1e-3)

    def test_a_sea_that_loses_height_and_one_that_loses_its_short_waves(self):
        self.assertAlmostEqual(wave_flume.irregular_waves(self.run_with(height_factor=0.8))["height_error"], -0.2, delta=1e-3)
        shorter = wave_flume.irregular_waves(self.run_with(high_factor=0.5))
        self.assertAlmostEqual(shorter["parts_error"], 0.75, delta=0.05)
        self.assertLess(shorter["height_error"], -0.05)

    def test_waves_that_come_back_are_told_apart(self):
        numbers = wave_flume.irregular_waves(self.run_with(reflected=0.2))
        self.assertAlmostEqual(numbers["reflection"], 0.2, delta=0.05)
        self.assertAlmostEqual(numbers["height_error"], 0.0, delta=0.02)

    def test_the_sines_are_those_of_the_spectrum(self):
        amplitude, omega, k, _ = wave_flume.sea(self.SEED, HEIGHT, PERIOD, DEPTH, G)
        self.assertAlmostEqual(4 * np.sqrt((amplitude**2).sum() / 2), HEIGHT, places=12)
        self.assertLess(np.abs(omega**2 / (G * k * np.tanh(k * DEPTH)) - 1).max(), 1e-9)
        self.assertTrue((np.diff(omega) > 0).all())

    def test_the_scatter_is_that_of_the_theory(self):
        """The energy m of a record of length D has the variance of the integral of S^2, over D."""
        numbers = wave_flume.irregular_waves(self.run_with())
        f = np.linspace(*wave_flume.BAND, 5001)
        density = wave_flume.jonswap(f)
        energy, square = density.mean() * np.ptp(f), (density**2).mean() * np.ptp(f)
        self.assertAlmostEqual(numbers["height_scatter"], 0.5 * np.sqrt(square / self.PERIODS) / energy, delta=0.006)


if __name__ == "__main__":
    unittest.main()
