"""A solitary wave at a wall, compared with its momentum, its energy and the series of other authors."""

import unittest

import numpy as np

from tailwater_validation import potential_wave

HEIGHT = 0.1


class AtWall(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.heights = tuple(np.linspace(0, 1, 11))
        cls.wall = potential_wave.at_wall(HEIGHT, cls.heights)
        cls.top = int(np.argmax(cls.wall.run_up))

    def test_the_run_up_is_that_of_su_and_mirie(self):
        series = 2 * HEIGHT + HEIGHT**2 / 2 + 0.75 * HEIGHT**3
        # The waves start with errors of third order; the omitted part leaves as a tail of e^4/e.
        self.assertAlmostEqual(self.wall.run_up[self.top] / series, 1.0, delta=2 * HEIGHT**3)

    def test_the_force_by_momentum_is_that_of_the_pressures(self):
        pressure = np.array([self.wall.pressure[z][self.top] for z in self.heights])
        below = float(np.sum((pressure[1:] + pressure[:-1]) / 2)) * (self.heights[1] - self.heights[0])
        above = 0.5 * pressure[-1] * self.wall.run_up[self.top]  # falls to 0 over the run-up, almost linearly
        self.assertAlmostEqual((below + above) / self.wall.force[self.top], 1.0, delta=HEIGHT**2)

    def test_the_impulse_turns_the_wave_round(self):
        # The momentum of a wave of permanent form is c times its volume, before and after.
        x = np.linspace(-30, 30, 6001)
        elevation, c = potential_wave.fenton(HEIGHT, x)
        momentum = c * float(np.sum(elevation)) * 0.01
        impulse = float(np.sum(self.wall.force[np.abs(self.wall.time) < 10])) * potential_wave.STEP
        self.assertAlmostEqual(impulse / (2 * momentum), 1.0, delta=0.01)


if __name__ == "__main__":
    unittest.main()
