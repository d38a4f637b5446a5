"""Scores of made-up runs of two liquids."""

import math
import unittest

import numpy as np

from test_exact_flows import RunTest, lattice
from tailwater_validation import two_liquids

BOX = """\
[parameters]
L = 1.0
h = 0.5
k = 3.141592653589793
omega = 2.0
sigma = 2.0
H = 0.2
ratio = 0.98
[case]
dimension = 2
[physics]
gravity = [0.0, -10.0]
[particles]
spacing = 0.05
"""


class Modes(RunTest):
    def run_of(self, amplitude, times):
        position = lattice((0, 0), (1, 1), 0.05)
        x, y = position.T
        shape = np.sinh(math.pi * np.minimum(y, 1 - y)) / math.sinh(0.5 * math.pi) * np.cos(math.pi * x)
        frames = [(t, position, {"velocity": np.stack([0 * x, amplitude(t) * shape], axis=1)}) for t in times]
        return self.write_run(BOX, frames)

    def test_a_wave_that_is_slower_and_lower(self):
        run = self.run_of(lambda t: math.cos(2.0 * t / 1.03) * 0.8 ** (t / math.pi), np.arange(0, 6.6, 0.05))
        numbers = two_liquids.internal_wave(run)
        self.assertAlmostEqual(numbers["period_error"], 0.03, places=3)
        self.assertAlmostEqual(numbers["height_error"], 0.8 ** (1.5 * 1.03) - 1, delta=0.01)  # after 3/4 of a period

    def test_an_instability_that_is_faster(self):
        numbers = two_liquids.rayleigh_taylor(self.run_of(lambda t: 0.1 * math.cosh(2.1 * t), (0.0, 0.5, 1.0)))
        self.assertAlmostEqual(numbers["growth_error"], 0.05, places=5)


class LockExchange(RunTest):
    def test_a_front_that_is_slower(self):
        speed = 0.9 * 0.5 * math.sqrt(10.0 * 0.02 * 0.2)
        time = np.linspace(0, 8, 100)
        run = self.write_run(BOX, [(0.0, lattice((0, 0), (1, 0.2), 0.05), {})],
                             {"probes/front.csv": {"time_s": time, "front_m": 0.45 + speed * time}})
        self.assertAlmostEqual(two_liquids.lock_exchange(run)["froude_error"], -0.1, places=6)


if __name__ == "__main__":
    unittest.main()
