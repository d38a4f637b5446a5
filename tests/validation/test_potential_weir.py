"""Potential flow over a broad weir: the reference constant of the runs, and conditions that the method does not use."""

import unittest

from tailwater_validation.flume import BROAD_WEIR_COEFFICIENT
from tailwater_validation.potential_weir import coefficient, flow

CRITICAL = (0.05**2 / 9.81) ** (1 / 3)  # m, depth of cases/flume/broad_weir.toml
WEIR = [length / CRITICAL for length in (0.1, 0.4, 0.04)]


class BroadWeir(unittest.TestCase):
    def test_coefficient_of_the_case(self):
        self.assertAlmostEqual(coefficient(*WEIR, gauge=3 * 0.085 / CRITICAL), BROAD_WEIR_COEFFICIENT, delta=2e-4)

    def test_energy_where_the_depth_is_critical(self):
        """E = h + (1 + (2 h h'' - h'^2)/3)/(2 h^2), for flow with weakly curved streamlines (Serre F. (1953),
        Contribution a l'etude des ecoulements permanents et variables dans les canaux, La Houille Blanche 8,
        374-388)."""
        surface, energy = flow(*WEIR, 0.12)  # the flow of the first test, cached
        x = next(x / 1000 for x in range(6000) if surface(x / 1000) < WEIR[0] + 1)
        slope, bend = surface(x, 1), surface(x, 2)
        self.assertAlmostEqual(energy, 1.5 + (2 * bend - slope**2) / 6, delta=0.003)

    def test_what_is_beyond_the_critical_depth_does_not_matter(self):
        longer = coefficient(WEIR[0], 2 * WEIR[1], WEIR[2], gauge=3 * 0.085 / CRITICAL, size=0.25)
        self.assertAlmostEqual(longer, BROAD_WEIR_COEFFICIENT, delta=0.003)


if __name__ == "__main__":
    unittest.main()
