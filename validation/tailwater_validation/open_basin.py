"""Water in a basin with open ends, by the shallow-water equations, as the reference for runs of cases/openings. Each
end prescribes one quantity of its flow, like an opening of Tailwater: a level, with the total head of the water outside
for inflow, or a discharge. A wall is a discharge of 0.

Lengths over a depth H, speeds over sqrt(g H), times over sqrt(H/g). The outward direction of an end is positive."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .shallow_water import DRY, fluxes, half_step, hll

CELLS = 400
WINDOW = 2.0  # sqrt(H/g); the mean over which depths are compared: shallow water has no waves as short


@dataclass(frozen=True)
class Level:
    """The level over time beyond an end, above its floor."""

    at: Callable

    def state(self, depth, speed, time):
        """(depth, outward speed) at the end for water inside with the given depth and speed. The outgoing
        characteristic u + 2c comes from inside. Outflow has the level, or is critical if it falls freely. Inflow has
        the total head of the water outside, and is at most critical."""
        c = math.sqrt(depth)
        head, outgoing = max(self.at(time), 0.0), speed + 2 * c
        if speed > c and depth * speed**2 + 0.5 * depth**2 > 0.5 * head**2:  # no jump comes in from outside
            return depth, speed
        if outgoing >= 2 * math.sqrt(head):
            c_end = max(math.sqrt(head), outgoing / 3)
            return c_end**2, outgoing - 2 * c_end
        critical = math.sqrt(2 * head / 3)
        root = 3 * head - 0.5 * outgoing**2
        c_end = critical if root < 0 else max(critical, (outgoing + math.sqrt(root)) / 3)
        return c_end**2, max(outgoing - 2 * c_end, -c_end)


@dataclass(frozen=True)
class Discharge:
    """The discharge per width into the basin over time."""

    into: Callable

    def state(self, depth, speed, time):
        q, outgoing = self.into(time), speed + 2 * math.sqrt(depth)
        # 2 c^3 - (u + 2c) c^2 - q = 0; Newton's method from above.
        c = max(outgoing, 0.0) / 2 + max(q, 0.0) ** (1 / 3) + 1e-6
        for _ in range(60):
            slope = 6 * c**2 - 2 * outgoing * c
            if slope <= 0:
                break
            c -= (2 * c**3 - outgoing * c**2 - q) / slope
        return c**2, -q / c**2


WALL = Discharge(lambda time: 0.0)


def end_states(ends, depth, speed, time):
    """(depth, speed) at the left and at the right end."""
    left = ends[0].state(max(depth[0], DRY), -speed[0], time)
    return (left[0], -left[1]), ends[1].state(max(depth[-1], DRY), speed[-1], time)


def advance(depth, speed, dt, dx, states_at_ends):
    """(depth, speed) a step later: MUSCL-Hancock, of first order in the cells at the ends."""
    (hl, ul), (hr, ur) = half_step(depth, speed, dt / dx)
    first, last = states_at_ends
    flux = np.column_stack([fluxes(*first), hll((hr[:-1], ur[:-1]), (hl[1:], ul[1:])), fluxes(*last)])
    states = np.array([depth, depth * speed]) - dt / dx * np.diff(flux)
    depth = np.maximum(states[0], 0.0)
    return depth, np.where(depth > DRY, states[1] / np.maximum(depth, DRY), 0.0)


def basin(length, depth, speed, ends, times, places, cells=CELLS):
    """(depths, discharges), each times x places, of a basin that starts with a uniform depth and speed; `ends` are
    left and right, each a Level or a Discharge."""
    dx = length / cells
    x = (np.arange(cells) + 0.5) * dx
    depth, speed = np.full(cells, float(depth)), np.full(cells, float(speed))
    now, depths, discharges = 0.0, [], []
    for time in times:
        while now < time - 1e-12:
            at_ends = end_states(ends, depth, speed, now)
            fastest = max(np.max(np.abs(speed) + np.sqrt(depth)), *(abs(u) + math.sqrt(h) for h, u in at_ends))
            dt = min(0.45 * dx / fastest, time - now)
            depth, speed = advance(depth, speed, dt, dx, at_ends)
            now += dt
        depths.append(np.interp(places, x, depth))
        discharges.append(np.interp(places, x, depth * speed))
    return np.array(depths), np.array(discharges)
