"""Bodies that leave their place: at the end of a period, out of an open end, into a porous layer."""

import math
import unittest

import numpy as np

from program import ProgramTest

CHANNEL = """
[case]
title = "A body in a channel"
[particles]
spacing = 0.03
[time]
end = {end}
{more}
[[wall]]
name = "hull"
shape = "polygon"
points = {points}
fluid_side = "outside"
[[body]]
name = "log"
walls = "hull"
mass = {mass}
centre = [{x}, {y}]
inertia = [0.1]
free = {free}
velocity = [{velocity}, 0]
[[probe]]
name = "motion"
type = "motion"
body = "log"
[[probe]]
name = "force"
type = "force"
walls = "hull"
"""
BED = """
[[wall]]
name = "bed"
points = [[0, 0], [1.2, 0]]
[[fluid]]
min = [0, 0]
max = [1.2, 0.7]
[domain]
periodic_x = [0, 1.2]
"""
RIVER = """
[[wall]]
name = "bed"
points = [[0, 0], [0.8, 0]]
[[fluid]]
min = [0, 0]
max = [0.8, 0.3]
velocity = [0.5, 0]
[[inlet]]
name = "in"
from = [0, 0]
to = [0, 0.5]
discharge = 0.15
[[outlet]]
name = "out"
from = [0.8, 0]
to = [0.8, 0.5]
level = 0.3
"""
STONES = """
[[wall]]
name = "tank"
points = [[0, 0.9], [0, 0], [0.8, 0], [0.8, 0.9]]
[[fluid]]
min = [0, 0]
max = [0.8, 0.6]
[[porous]]
name = "stones"
min = [0, 0]
max = [0.8, 0.2]
porosity = 0.4
grain_size = 0.02
"""


def polygon(x, y, radius=0.1, corners=16):
    angles = 2 * math.pi * np.arange(corners) / corners
    return [[float(x + radius * math.cos(a)), float(y + radius * math.sin(a))] for a in angles]


def area(radius=0.1, corners=16):
    return 0.5 * corners * radius**2 * math.sin(2 * math.pi / corners)


class BodiesTest(ProgramTest):
    def write(self, more, x, y, mass, free="[]", velocity=0.0, end=1.0):
        case = CHANNEL.format(more=more, points=polygon(x, y), x=x, y=y, mass=mass, free=free, velocity=velocity,
                              end=end)
        (self.folder / "body.toml").write_text(case)

    def columns(self, probe):
        names, rows = self.table(f"run/probes/{probe}.csv")
        return dict(zip(names, np.array(rows).T))


class AtTheEndOfAPeriod(BodiesTest):
    def refusal(self):
        result = self.call("check", "body.toml", expect=2, errors_only=False)
        return " ".join((result.stdout + result.stderr).split())

    def test_a_body_that_is_towed_there_is_refused(self):
        self.write(BED, 0.6, 0.3, 30.0, velocity=0.6, end=1.0)
        self.assertIn("body 'log' comes to x = 1.3", self.refusal())
        self.write(BED, 0.6, 0.3, 30.0, velocity=-0.6, end=1.0)
        self.assertIn("body 'log' comes to x = -0.1", self.refusal())
        self.write(BED, 0.6, 0.3, 30.0, velocity=0.6, end=0.5)
        self.call("check", "body.toml")

    def test_a_body_that_is_drawn_there_is_refused(self):
        self.write(BED, 0.13, 0.3, 30.0)
        self.assertIn("the water beyond the end would not see the body", self.refusal())

    def test_a_body_that_drifts_there_is_reported(self):
        self.write(BED, 0.98, 0.3, 30.0, free='["x", "y"]', velocity=1.0, end=0.2)
        result = self.call("run", "body.toml", "--out", "run")
        self.assertRegex(result.stderr, "body 'log' has come to the end of the period by t = ")

    def test_a_wall_that_slides_there_and_turns_is_refused(self):
        self.write(BED, 0.6, 0.3, 30.0)
        case = (self.folder / "body.toml").read_text()
        wall = case[:case.index("[[body]]")] + 'displacement = ["0.1*t", 0]\nrotation = "2*t"\npivot = [0.6, 0.3]\n'
        (self.folder / "body.toml").write_text(wall)
        self.assertIn("turns and also moves along x", self.refusal())


class OutOfTheCase(BodiesTest):
    def test_a_body_that_floats_out_is_reported_and_stops(self):
        self.write(RIVER, 0.6, 0.3, 15.0, free='["x", "y", "rotation"]', velocity=0.6, end=2.0)
        result = self.call("run", "body.toml", "--out", "run")
        self.assertRegex(result.stderr, "body 'log' has fallen below all walls by t = ")
        motion = self.columns("motion")
        lowest = 0.3 + motion["displacement_y_m"].min()
        # It stops within the step in which its top passes the bed.
        self.assertGreater(lowest, -0.3)
        self.assertEqual(motion["velocity_y_m_per_s"][-1], 0.0)


class OnStones(BodiesTest):
    def test_a_heavy_body_above_a_layer_is_refused(self):
        self.write(STONES, 0.4, 0.4, 60.0, free='["y"]')
        result = self.call("check", "body.toml", expect=2, errors_only=False)
        self.assertIn("body 'log' is heavy and sinks to", (result.stdout + result.stderr).replace("\n", " "))
        self.write(STONES, 0.4, 0.25, 25.0, free='["y"]')
        result = self.call("check", "body.toml", expect=2, errors_only=False)
        self.assertIn("is drawn in", result.stdout + result.stderr)

    def test_a_body_that_enters_a_layer_is_reported(self):
        self.write(STONES, 0.4, 0.32, 28.0, free='["y"]', velocity=0.0, end=0.5)
        case = (self.folder / "body.toml").read_text().replace("velocity = [0.0, 0]", "velocity = [0, -1.5]")
        (self.folder / "body.toml").write_text(case)
        result = self.call("run", "body.toml", "--out", "run")
        self.assertRegex(result.stderr, "body 'log' has entered porous layer 'stones' by t = ")


if __name__ == "__main__":
    unittest.main()
