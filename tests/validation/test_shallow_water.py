"""The shallow-water equations with and without friction, compared with their limiting solutions."""

import unittest

import numpy as np

from tailwater_validation import shallow_water
from tailwater_validation.shallow_water import EvenBed, RoughBed, dam_break, front_of


def whitham_front(time, coefficient):
    """Position of the front over a dry bed with a constant friction coefficient, for small coefficient time^4: Whitham
    (1955), Proc. R. Soc. Lond. A 227, 399: 2 t - 3.452 (c t^4)^(1/3)."""
    return 2 * time - 3.452 * (coefficient * time**4) ** (1 / 3)


def rms(values):
    return float(np.sqrt(np.mean(values**2)))


class WithoutFriction(unittest.TestCase):
    def test_a_dry_bed_gives_ritters_dam_break(self):
        (x, depth, _), = dam_break(0.0, EvenBed(0.0), [3.0], 4, 7, cells=1000)
        # the two kinks of the solution are rounded
        self.assertLess(rms(depth - shallow_water.ritter(x / 3.0)), 0.2 * (x[1] - x[0]))
        self.assertAlmostEqual(float(np.sum(depth)), np.count_nonzero(x < 0), places=7)  # no water is lost

    def test_still_water_ahead_gives_stokers(self):
        (x, depth, _), = dam_break(0.2, EvenBed(0.0), [3.0], 4, 5, cells=1000)
        # A jump that is two cells wide.
        self.assertLess(rms(depth - shallow_water.stoker(x / 3.0, 0.2)), 0.3 * np.sqrt(2 / 1000))


class WithFriction(unittest.TestCase):
    def test_little_friction_holds_the_tip_back_as_whitham_says(self):
        # The omitted terms are of higher order in the loss over the distance: the differences fall faster than the
        # losses.
        for coefficient, least in ((1e-4, 0.15), (1e-3, 0.3)):
            (x, depth, _), = dam_break(0.0, EvenBed(coefficient), [2.0], 3, 5, cells=2000)
            loss = 4.0 - front_of(x, depth)
            self.assertAlmostEqual(loss / (4.0 - whitham_front(2.0, coefficient)), 1.0, delta=least)

    def test_a_layer_that_fills_the_depth_has_the_logarithmic_law(self):
        bed = RoughBed(0.03)
        y = (np.arange(100000) + 0.5) / 100000
        mean = np.mean(np.log1p(y / bed.y0)) / shallow_water.KARMAN
        self.assertAlmostEqual(float(bed.friction_velocity(1.0, 2.0, 5.0)), 2.0 / mean, places=6)

    def test_a_thin_layer_grows_by_what_the_bed_takes(self):
        # Deep water at uniform speed: the momentum deficit u_tau delta/kappa equals the momentum that the bed has
        # taken, except for the slow change of the logarithm.
        bed = RoughBed(0.001)
        speed, layer, taken = np.array([1.0]), np.array([0.001]), 0.0
        for _ in range(2000):
            u_tau = bed.friction_velocity(100.0, 1.0, layer)
            taken += 0.005 * float(u_tau[0] ** 2)
            _, layer = bed.slow(np.array([100.0]), speed, layer, 0.005)
        self.assertAlmostEqual(float(u_tau[0] * layer[0]) / shallow_water.KARMAN / taken, 1.0, delta=0.15)

    def test_friction_takes_momentum_and_no_water(self):
        states = {bed: dam_break(0.2, bed, [3.0], 4, 5, cells=600)[0] for bed in (EvenBed(0.0), RoughBed(0.02))}
        (x, free_depth, free_speed), (_, depth, speed) = states.values()
        self.assertAlmostEqual(float(np.sum(depth - free_depth)), 0.0, places=9)
        self.assertLess(float(np.sum(depth * speed)), float(np.sum(free_depth * free_speed)))


if __name__ == "__main__":
    unittest.main()
