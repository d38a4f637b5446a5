"""Potential flow over a crest: the constant that runs are held against, and the broad weir by another method."""

import math
import tomllib
import unittest
from functools import lru_cache
from pathlib import Path

import numpy as np

from tailwater_validation.flume import BROAD_WEIR_COEFFICIENT, OGEE_POTENTIAL_COEFFICIENT
from tailwater_validation.potential_crest import Flow, coefficients

OGEE = Path(__file__).resolve().parents[2] / "cases/flume/ogee.toml"
DISCHARGE = 0.0689 / math.sqrt(9.81 * 0.1**3)  # over sqrt(g Hd^3)


def crest_of_the_case():
    """Its points over the design head, heights above the crest."""
    wall = tomllib.loads(OGEE.read_text(encoding="utf-8"))["wall"][0]["points"]
    names = {"Hd": 1.0, "P": 2.0, "L": 6.0}
    points = [[eval(value, {}, names) if isinstance(value, str) else value for value in point] for point in wall]
    return [(x, y - 2.0) for x, y in points[1:]]


@lru_cache(maxsize=None)
def ogee(step=0.02, knot=0.2):
    return Flow(crest_of_the_case(), DISCHARGE, step, knot)


class Ogee(unittest.TestCase):
    def test_coefficient_of_the_case(self):
        true, read = (one * math.sqrt(9.81) for one in coefficients(ogee(), gauge=3.0))
        self.assertAlmostEqual(read, OGEE_POTENTIAL_COEFFICIENT, delta=3e-4)
        self.assertAlmostEqual(true, 2.2238, delta=3e-4)

    def test_finer_pieces_and_curves_change_nothing(self):
        found = [coefficients(flow, gauge=3.0)[0] for flow in (ogee(step=0.04), ogee(), ogee(knot=0.1))]
        self.assertLess(np.ptp(found), 2e-4 * found[0])

    def test_bernoulli_holds_along_the_surface(self):
        flow = ogee()
        x, y, energy = flow.found
        speed = DISCHARGE * flow.step / np.hypot(np.diff(x), np.diff(y))
        np.testing.assert_allclose(0.5 * speed**2 + 0.5 * (y[1:] + y[:-1]), energy, atol=2e-4)


class BroadWeir(unittest.TestCase):
    """Whose water falls freely from the crest's end by the other method (potential_weir.py); here down a slope."""

    def test_coefficient(self):
        critical = (0.05**2 / 9.81) ** (1 / 3)
        height, crest, nose = (length / critical for length in (0.1, 0.4, 0.04))
        arc = [(nose * (1 - math.cos(a)), -nose * (1 - math.sin(a))) for a in math.pi / 8 * np.arange(1, 5)]
        for slope in (math.radians(30), math.radians(60)):
            points = [(0, -height), (0, -nose), *arc, (crest, 0), (crest + math.cos(slope), -math.sin(slope))]
            _, read = coefficients(Flow(points, 1.0, step=0.04), gauge=3 * 0.085 / critical)
            self.assertAlmostEqual(read * 1.5**1.5, BROAD_WEIR_COEFFICIENT, delta=1e-3)


if __name__ == "__main__":
    unittest.main()
