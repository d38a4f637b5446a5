"""Water with neither walls nor gravity: two equal blocks collide head-on and spread. Nothing acts on the water from
outside. The blocks are small because in a small drop all particles have nearly the same neighbours, so that rows of the
pressure equation couple the same unknowns."""

import itertools
import unittest

import numpy as np

from fields import read_points, read_series
from program import ProgramTest

SPACING = 0.02
TOLERANCE = 1e-10
SCHEMES = ("scheme.integrator=explicit", "scheme.integrator=implicit", "scheme.name=farmani2020")


def colliding_blocks(dimension, particles_per_edge):
    """Two blocks side by side, 2 m/s towards each other."""
    edge = SPACING * particles_per_edge
    across = [edge] * (dimension - 1)
    still = [0.0] * (dimension - 1)
    return f"""\
[case]
title = "Two blocks of water that collide"
dimension = {dimension}
[physics]
gravity = {[0.0, *still]}
[particles]
spacing = {SPACING}
[[fluid]]
name = "left"
min = {[0.0, *still]}
max = {[edge, *across]}
velocity = {[1.0, *still]}
[[fluid]]
name = "right"
min = {[edge, *still]}
max = {[2 * edge, *across]}
velocity = {[-1.0, *still]}
[time]
end = 0.1
[pressure_solver]
tolerance = {TOLERANCE}
"""


class CollidingBlocks(ProgramTest):
    def check_run(self, dimension, particles_per_edge, scheme):
        (self.folder / "blocks.toml").write_text(colliding_blocks(dimension, particles_per_edge))
        self.call("check", "blocks.toml", "--set", scheme)
        self.call("run", "blocks.toml", "--out", "run", "--force", "--quiet", "--set", scheme)
        particles = 2 * particles_per_edge**dimension
        mass = 1000.0 * SPACING**dimension

        summary = self.summary("run")
        self.assertEqual(summary["status"], "done")
        self.assertEqual(summary["particles"], {"fluid": particles, "wall": 0})
        balance = summary["water_balance"]
        self.assertEqual(balance["inside"], balance["start"])
        self.assertEqual(balance["inside"]["particles"], particles)
        self.assertEqual(summary["volume"]["outside_the_walls_most"], 0)

        # Kinetic energy can only be lost; a solve leaves at most its tolerance of it.
        names, steps = self.table("run/steps.csv")
        kinetic = np.array([0.5 * mass * particles, *(row[names.index("kinetic_J")] for row in steps)])
        self.assertGreater(kinetic[-1], 0.0)
        self.assertLessEqual(np.diff(kinetic).max(), TOLERANCE * kinetic[0])

        self.assertEqual(len(self.check_momentum()), particles)

    def check_momentum(self):
        """The forces of each pair are opposite, so momentum stays 0, but for the solve's tolerance and the single
        precision of fields. Returns the last positions."""
        _, last = read_series(self.folder / "run/fields/fields.pvd")[-1]
        positions, fields = read_points(last)
        velocity = fields["velocity"].astype(float)
        np.testing.assert_array_less(np.abs(velocity.sum(axis=0)), (2.0**-24 + TOLERANCE) * np.abs(velocity).sum())
        return positions

    def test_as_one_drop(self):
        # Nearly every particle is a neighbour of every other, from the first solve on.
        for dimension, scheme in itertools.product((2, 3), SCHEMES):
            with self.subTest(dimension=dimension, scheme=scheme):
                self.check_run(dimension, 2, scheme)

    def test_as_drops_that_spread(self):
        for scheme in SCHEMES:
            with self.subTest(scheme=scheme):
                self.check_run(2, 3, scheme)

    def test_without_symmetry(self):
        # The two blocks are no mirror images, so nothing but the pairs keeps momentum.
        for scheme in SCHEMES:
            with self.subTest(scheme=scheme):
                (self.folder / "blocks.toml").write_text(colliding_blocks(3, 2))
                self.call("run", "blocks.toml", "--out", "run", "--force", "--quiet", "--set", scheme,
                          "--set", "particles.jitter=0.1")
                self.check_momentum()


if __name__ == "__main__":
    unittest.main()
