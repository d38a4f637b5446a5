"""Heave of a box in waves by matched eigenfunctions, against limits that are known without it."""

import unittest

import numpy as np

from tailwater_validation.radiation import FloatingBox, roots

G = 9.81


class RadiationTest(unittest.TestCase):
    box = FloatingBox(breadth=0.3, draught=0.1, depth=0.3, mass=30.0)

    def test_the_roots_satisfy_the_dispersion_relation(self):
        k, evanescent = roots(5.0, G, 0.3, 5)
        self.assertAlmostEqual(G * k * np.tanh(0.3 * k), 25.0, delta=1e-9)
        for number in evanescent:
            self.assertAlmostEqual(-G * number * np.tan(0.3 * number), 25.0, delta=1e-6)

    def test_a_box_follows_long_waves(self):
        """Damping from the pressure and excitation by Haskind's relation agree, or the heave would not be that of the waves."""
        self.assertAlmostEqual(self.box.response(0.3)[0], 1.0, delta=2e-3)

    def test_damping_of_a_thin_box_is_that_of_a_moving_surface(self):
        """Long waves, small draught: the box pumps the discharge omega a B, half to each side, as waves of that discharge."""
        thin = FloatingBox(breadth=0.02, draught=1e-4, depth=0.3, mass=0.002)
        omega = 0.5
        amplitude = 0.5 * omega * 0.02 / np.sqrt(G * 0.3)  # of each wave, for a heave of amplitude 1
        expected = 2 * 0.5 * 1000.0 * G * amplitude**2 * np.sqrt(G * 0.3) / (0.5 * omega**2)
        self.assertAlmostEqual(thin.radiation(omega)[1] / expected, 1.0, delta=0.01)

    def test_the_best_damper_takes_half_of_what_the_waves_bring(self):
        omegas = np.linspace(6.0, 7.0, 21)
        powers = [self.box.response(omega, self.box.radiation(omega)[1]) for omega in omegas]
        brought = [0.5 * 1000.0 * G * self.box.group_speed(omega) for omega in omegas]
        self.assertAlmostEqual(max(power / full for (_, power), full in zip(powers, brought)), 0.5, delta=2e-3)


if __name__ == "__main__":
    unittest.main()
