"""Solutions for thick liquids, by the equations that they must satisfy, and the scores of made-up runs."""

import unittest

import numpy as np

from test_exact_flows import RunTest, lattice
from tailwater_validation import thick_flows

SLUMP = """\
[parameters]
L = 0.2
H = 0.1
[case]
dimension = 2
[physics]
density = 1000.0
gravity = [0.0, -9.81]
[particles]
spacing = 0.005
[[liquid]]
density = 1000.0
viscosity = 100.0
yield_stress = 30.0
"""


class Film(unittest.TestCase):
    def test_profile_has_the_stress_of_its_law(self):
        depth, force, consistency, index, yield_stress, h = 1.0, 1000.0, 50.0, 0.6, 300.0, 1e-5
        y = np.array([0.1, 0.4, 0.6])
        rate = (thick_flows.film_velocity(y + h, depth, force, consistency, index, yield_stress)
                - thick_flows.film_velocity(y - h, depth, force, consistency, index, yield_stress)) / (2 * h)
        np.testing.assert_allclose(yield_stress + consistency * rate**index, force * (depth - y), rtol=1e-6)

    def test_plug_has_one_speed_and_the_bed_none(self):
        speeds = thick_flows.film_velocity(np.array([0.0, 0.7, 1.0]), 1.0, 1000.0, 50.0, 1.0, 300.0)
        self.assertEqual(speeds[0], 0.0)
        self.assertEqual(speeds[1], speeds[2])


class Slump(RunTest):
    def test_surface_holds_the_area_and_balances_the_stress_on_the_bed(self):
        area, yield_height, step = 0.02, 30.0 / 9810, 1e-6
        reach = thick_flows.slump_reach(area, yield_height)
        way = (np.arange(20000) + 0.5) / 20000 * reach
        self.assertAlmostEqual(thick_flows.slump_surface(way, yield_height).mean() * reach / area, 1.0, places=5)

        def thrust(way):  # over rho g
            height = thick_flows.slump_surface(way, yield_height)
            return height**2 / 2 - np.pi / 2 * yield_height * height

        np.testing.assert_allclose((thrust(way + step) - thrust(way - step)) / (2 * step), yield_height, rtol=1e-5)

    def test_known_errors_come_back(self):
        yield_height = 30.0 / 9810
        reach = thick_flows.slump_reach(0.02, yield_height)
        position = lattice((0, 0), (reach, 0.1), 0.005)
        height = thick_flows.slump_surface(np.maximum(reach - position[:, 0], 0), yield_height)
        run = self.write_run(SLUMP, [(1.0, position[position[:, 1] < 1.1 * height], {})],
                             {"probes/front.csv": {"time_s": np.array([0.0, 1.0]), "front_m": np.array([0.2, 1.05 * reach])}})
        numbers = thick_flows.yielding_slump(run)
        self.assertAlmostEqual(numbers["reach_error"], 0.05, places=6)
        self.assertAlmostEqual(numbers["surface_error"], 0.075, delta=0.02)  # a tenth of the mean height


class Current(RunTest):
    def test_known_error_comes_back(self):
        exact = thick_flows.viscous_front(10.0, 0.02, 0.1, 9.81)
        run = self.write_run(SLUMP, [(10.0, lattice((0, 0), (0.2, 0.1), 0.005), {})],
                             {"probes/front.csv": {"time_s": np.array([0.0, 10.0]), "front_m": np.array([0.2, 0.97 * exact])}})
        self.assertAlmostEqual(thick_flows.viscous_dam_break(run)["front_error"], -0.03, places=6)

    def test_known_errors_of_both_directions_come_back(self):
        exact = thick_flows.axisymmetric_front(10.0, np.pi * 0.1**3, 0.1, 9.81)
        run = self.write_run(SLUMP, [(10.0, lattice((0, 0), (0.2, 0.1), 0.005), {})],
                             {f"probes/{name}.csv": {"time_s": np.array([0.0, 10.0]), "front_m": np.array([0.1, factor * exact])}
                              for name, factor in (("front", 0.97), ("diagonal", 1.02))})
        errors = thick_flows.axisymmetric_dam_break(run)
        self.assertAlmostEqual(errors["front_error"], -0.03, places=6)
        self.assertAlmostEqual(errors["diagonal_error"], 0.02, places=6)

    def test_axisymmetric_front_keeps_the_similarity(self):
        # The front of h = t^-1/4 f(r t^-1/8) goes with t^1/8.
        one = thick_flows.axisymmetric_front(1.0, 0.003, 0.1, 9.81)
        self.assertAlmostEqual(thick_flows.axisymmetric_front(256.0, 0.003, 0.1, 9.81), 2 * one)
        self.assertAlmostEqual(thick_flows.axisymmetric_front(1.0, 8 * 0.003, 0.1, 2 * 9.81), 2 * 2 ** 0.25 * one)

    def test_front_keeps_the_similarity(self):
        # The front of h = t^-1/5 f(x t^-1/5) goes with t^1/5.
        one = thick_flows.viscous_front(1.0, 0.02, 0.1, 9.81)
        self.assertAlmostEqual(thick_flows.viscous_front(32.0, 0.02, 0.1, 9.81), 2 * one)
        # With twice the lengths, in the same time, it is twice as far.
        self.assertAlmostEqual(thick_flows.viscous_front(1.0, 4 * 0.02, 4 * 0.1, 2 * 9.81), 2 * one)


if __name__ == "__main__":
    unittest.main()
