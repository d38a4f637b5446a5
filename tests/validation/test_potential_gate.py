"""Potential flow under a gate: its limit without gravity, and conditions that the computation of the jet does not
use."""

import math
import unittest

import numpy as np

from tailwater_validation.potential_gate import DS, S, contraction, jet


class Gate(unittest.TestCase):
    def test_small_openings_have_the_contraction_of_kirchhoff(self):
        self.assertAlmostEqual(contraction(0.002), math.pi / (math.pi + 2), delta=5e-4)

    def test_gravity_makes_the_jet_thinner(self):
        found = [contraction(share) for share in (0.05, 0.1, 0.2, 0.3)]
        self.assertEqual(found, sorted(found, reverse=True))

    def test_the_gate_reaches_from_the_surface_upstream_to_its_edge(self):
        """The length of the gate is the integral of d phi/u along it, over r from 0, the edge, to R; with r = R
        sin(x)."""
        opening, depth, R, log_speed = jet(6.8)
        x = (np.arange(2000) + 0.5) / 2000 * math.pi / 2
        r = R * np.sin(x)
        rest = [2 * one / math.pi * np.sum(log_speed / (S**2 + one**2) * DS) for one in r]
        # sqrt((R + r)/(R - r)) dr = R (1 + sin x) dx
        length = np.sum(np.exp(-np.array(rest)) * 2 / math.pi * r / (1 - r**2) * R * (1 + np.sin(x))) * math.pi / 2 / 2000
        self.assertAlmostEqual(length / (depth - opening), 1, delta=2e-3)


if __name__ == "__main__":
    unittest.main()
