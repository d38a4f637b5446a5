"""The linear theory of a box that floats in a tank, and runs that obey it."""

import tempfile
import unittest
from dataclasses import replace
from pathlib import Path

import numpy as np

from tailwater.errors import DataError
from tailwater.run import Run
from tailwater_validation import floating

G = 9.81
BOX = floating.Tank(width=0.42, depth=0.375, breadth=0.3, height=0.15, mass=22.5, inertia=22.5 * 0.1125 / 12,
                    density=1000.0, gravity=G)


class Theory(unittest.TestCase):
    def test_a_small_light_box_swings_with_the_water(self):
        """In the middle of a long tank a flat box follows the slope of the longest wave, w^2 = g k tanh kh with k = pi/W: it
        covers a tenth of the width around the node and changes the frequency by the square of that at most."""
        tank = replace(BOX, width=3.0, depth=0.6, height=0.06, mass=9.0, inertia=9.0 * 0.09 / 12)
        k = np.pi / tank.width
        oscillator = floating.Oscillator(tank, True, 5)
        self.assertAlmostEqual(oscillator.frequency[0] / np.sqrt(G * k * np.tanh(k * tank.depth)), 1.0, delta=0.02)

    def test_heave_in_a_tight_tank_is_that_of_a_column_of_water(self):
        """The water in the gaps must move B/(W - B) times as fast as the box, and nearly all kinetic energy is theirs: gaps
        of the width b, d deep, weigh 2 rho b d (B/2b)^2; the least that the water below adds makes the period longer."""
        tank = replace(BOX, width=0.33)
        b, d = 0.015, tank.draught
        mass = tank.mass + 1000 * 2 * b * d * (tank.breadth / (2 * b)) ** 2
        stiffness = 1000 * G * (tank.breadth + tank.breadth**2 / (2 * b))
        shortest = 2 * np.pi * np.sqrt(mass / stiffness)
        found, share = floating.theory(tank, False, 5.0)
        self.assertGreater(share, 0.999 * (1 - tank.breadth / tank.width))
        self.assertGreater(found, shortest)
        self.assertLess(found, 1.5 * shortest)

    def test_all_modes_together_begin_where_the_box_is_let_go(self):
        for rolls, start in ((True, 1.0), (False, 1 - 0.3 / 0.42)):
            oscillator = floating.Oscillator(BOX, rolls, 10)
            self.assertAlmostEqual(float(oscillator.motion(np.array([0.0]))[0]), start, places=9)

    def test_the_cells_converge_as_their_corners_say(self):
        tank = replace(BOX, width=0.45)  # whole cells also of the coarsest
        coarse, middle, fine = (floating.Oscillator(tank, False, cells).frequency[0] for cells in (4, 8, 16))
        self.assertAlmostEqual(np.log2((middle - coarse) / (fine - middle)), floating.CORNER_ORDER, delta=0.15)


class Runs(unittest.TestCase):
    def run_with(self, place, parameters, free):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = Path(folder.name)
        (path / "probes").mkdir()
        (path / "case.effective.toml").write_text(
            f"[case]\ndimension = 2\n[physics]\ndensity = 1000.0\ngravity = [0.0, -{G}]\n[particles]\nspacing = 0.01\n"
            f"[time]\nend = 4.0\n[parameters]\nB = 0.3\nH = 0.15\nW = 0.42\nh = 0.375\n{parameters}\n"
            f"[[body]]\nmass = {BOX.mass}\ninertia = [{BOX.inertia}]\nfree = ['{free}']\n")
        time = np.linspace(0, 4, 4001)
        (path / "probes" / "box.csv").write_text("time_s,displacement_y_m,angle_rad\n" + "".join(
            f"{t:.9g},{y:.9g},{y:.9g}\n" for t, y in zip(time, place(time))))
        return Run(path)

    def test_a_box_that_obeys_has_no_error(self):
        period, _ = floating.theory(BOX, False, 4.0)
        rest = 0.0075 * (0.3 / 0.42 - 1)
        run = self.run_with(lambda t: rest + 2e-4 - rest * np.cos(2 * np.pi * t / period) * np.exp(-0.3 * t), "up = 0.0075\ntilt = 0.0", "y")
        numbers = floating.floating_box(run)
        self.assertAlmostEqual(numbers["draught_error_dx"], 0.02, delta=0.01)

    def test_a_period_that_is_longer_is_told(self):
        period, _ = floating.theory(BOX, True, 4.0)
        run = self.run_with(lambda t: 0.05 * np.cos(2 * np.pi * t / (1.05 * period)) - 0.05, "up = 0.0\ntilt = 0.05", "rotation")
        self.assertAlmostEqual(floating.floating_box(run)["period_error"], 0.05, delta=2e-3)

    def test_a_box_that_does_not_swing_has_no_period(self):
        run = self.run_with(lambda t: 0 * t, "up = 0.0\ntilt = 0.05", "rotation")
        with self.assertRaisesRegex(DataError, "passes its mean 0 times"):
            floating.floating_box(run)


if __name__ == "__main__":
    unittest.main()
