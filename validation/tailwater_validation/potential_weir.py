"""Water over a broad weir with a rounded nose, by potential flow with gravity: its discharge over that of critical flow.

Lengths over the critical depth, speeds over that of critical flow, so that g and the discharge are 1. The stream
function is 0 along bed, weir and the underside of the sheet that falls from it, 1 along the surface, and even across
both ends. Boundary elements give the speed along the water's outline from it. Surface and underside are curves through
some heights, which are sought, with the energy head, until Bernoulli's equation holds along both as well as it can.
"""

import math
from functools import lru_cache

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import least_squares

CHANNEL, FALL = 8.0, 1.9  # lengths of the channel upstream and of the sheet
CUT = 0.5  # length before the sheet's end along which its speed is not asked for


def line(start, end, size):
    """Points from one to the other, about `size` apart."""
    start, end = np.array(start), np.array(end)
    pieces = max(1, round(float(np.hypot(*(end - start))) / size))
    return start + np.linspace(0, 1, pieces + 1)[:, None] * (end - start)


def speeds(points, psi):
    """Speed of water to the left of an outline, along each of its pieces, at whose middles the stream function is
    `psi`."""
    along = np.diff(points, axis=0)
    length = np.hypot(*along.T)
    apart = (0.5 * (points[1:] + points[:-1]))[:, None] - points[:-1]
    x = (apart * along).sum(axis=2) / length
    y = (apart[..., 0] * along[:, 1] - apart[..., 1] * along[:, 0]) / length
    np.fill_diagonal(y, 0.0)

    def seen(s):
        """(integral of the logarithm of the distance, angle) of a part that begins at the foot of the perpendicular."""
        angle = np.arctan2(s, np.abs(y))
        return 0.5 * s * np.log(s**2 + y**2) - s + np.abs(y) * angle, angle

    (ahead, angle_ahead), (behind, angle_behind) = seen(length - x), seen(x)
    angle = np.sign(y) * (angle_ahead + angle_behind)
    return np.linalg.solve(-ahead - behind, math.pi * psi + angle @ psi)


class Flow:
    """Over a weir of a `height`, whose crest ends at x = `crest`; the radius of its nose, in four pieces, is `nose`."""

    def __init__(self, height, crest, nose, size):
        arc = [(nose * (1 - math.cos(a)), height - nose * (1 - math.sin(a))) for a in math.pi / 8 * np.arange(1, 5)]
        corners = [(-CHANNEL, 0), (0, 0), (0, height - nose), *arc, (crest, height)]
        self.bed = np.vstack([corners[:1], *(line(start, end, 0.7 * size)[1:] for start, end in zip(corners, corners[1:]))])
        self.height, self.crest, self.size = height, crest, size
        near, end = crest - 1.3, crest + FALL
        self.knots = np.concatenate([np.linspace(-CHANNEL, -1.6, 8)[:-1], np.linspace(-1.6, 1.6, 15)[:-1],
                                     np.linspace(1.6, near, 1 + round(3 * (near - 1.6)))[:-1], np.linspace(near, end, 13)[[*range(11), 12]]])
        self.x = np.concatenate([np.linspace(-CHANNEL, -1.6, round(4 / size))[:-1], np.linspace(-1.6, end, round((end + 1.6) / size))])
        self.sheet = crest + FALL * np.linspace(0, 1, round(2.4 / size)) ** 1.5

    def surface(self, unknown):
        return CubicSpline(self.knots, unknown[:len(self.knots)], bc_type=((1, 0.0), "not-a-knot"))

    def outline(self, unknown):
        """(points, psi at the middles, slices of underside and surface)."""
        top = self.surface(unknown)(self.x)
        fall = self.sheet - self.crest
        below = self.height - fall**1.5 * np.polynomial.polynomial.polyval(fall, unknown[len(self.knots):-1])
        out = line((self.sheet[-1], below[-1]), (self.x[-1], top[-1]), 0.7 * self.size)
        parts = [self.bed, np.column_stack([self.sheet, below]), out, np.column_stack([self.x, top])[::-1],
                 line((-CHANNEL, top[0]), (-CHANNEL, 0), 1.6 * self.size)]
        points = np.vstack([parts[0], *(part[1:] for part in parts[1:])])
        ends = np.cumsum([len(part) - 1 for part in parts])
        under, surface = slice(ends[0], ends[1]), slice(ends[2], ends[3])
        height = 0.5 * (points[1:, 1] + points[:-1, 1])
        psi = np.zeros(len(height))
        psi[ends[1]:ends[2]] = (height[ends[1]:ends[2]] - below[-1]) / (top[-1] - below[-1])
        psi[surface] = 1.0
        psi[ends[3]:] = height[ends[3]:] / top[0]
        return points, psi, under, surface

    def misfit(self, unknown):
        """Residuals of Bernoulli's equation along underside and surface. They leave out the sheet's end, where the
        speed is not even, and the edge from which the sheet falls."""
        points, psi, under, surface = self.outline(unknown)
        height = 0.5 * (points[1:, 1] + points[:-1, 1]) - self.height
        off = 0.5 * speeds(points, psi) ** 2 + height - unknown[-1]
        off *= np.sqrt(np.hypot(*np.diff(points, axis=0).T))
        place = 0.5 * (points[1:, 0] + points[:-1, 0])
        off[place > self.crest + FALL - CUT] = 0.0
        return np.concatenate([off[under][1:], off[surface][:-2]])

    def found(self):
        """(surface, energy head above the crest)."""
        depth = 1 + 0.31 * (1 - np.tanh(1.2 * (self.knots - 1))) - 0.25 * np.clip(self.knots / self.crest, 0, 1) ** 3
        past = np.clip(self.knots - self.crest, 0, None)
        start = np.concatenate([self.height + depth - 0.25 * past - 0.27 * past**2, [0.3, 0.05, 0.0, 0.0, 1.5]])
        unknown = least_squares(self.misfit, start, x_scale="jac", xtol=1e-6, ftol=1e-6).x
        return self.surface(unknown), float(unknown[-1])


@lru_cache(maxsize=None)
def flow(height, crest, nose, size):
    """(surface, energy head above the crest)."""
    return Flow(height, crest, nose, size).found()


def coefficient(height, crest, nose, gauge, size=0.12):
    """Discharge over that of critical flow, sqrt(g) (2 H/3)^1.5 with the energy head H of the depth that is read at the
    distance `gauge` upstream, all over the critical depth. For a smaller `size` of the elements it is more precise."""
    surface, _ = flow(height, crest, nose, size)
    depth = float(surface(-gauge))
    return (2 / 3 * (depth - height + 0.5 / depth**2)) ** -1.5
