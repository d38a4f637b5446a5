"""Water over a crest of straight pieces, by potential flow with gravity: which discharge an energy head drives over it.

The unit of length is free, that of time makes g = 1. Potential and stream function are over the discharge q, so that the water
is the strip 0 < psi < 1, with the bed below and the surface above. Of ln u - i theta, with the speed u and its direction
theta, one part is known along each: theta along the bed, which turns at its corners, and by Bernoulli u along the surface.
The other parts follow from Laplace's equation in the strip, with S(x) = sech(pi x/2)/2, L(x) = ln(coth(pi |x|/4))/pi, and *
for a convolution along phi:

    theta of the surface = S * theta of the bed - L * d(ln u)/dphi of the surface
    ln u of the bed = S * ln u of the surface - sum over the corners of their turns times L(phi - phi of the corner)

Sought are a curve for ln u of the surface, the phi of the corners, and the speed far upstream, such that Bernoulli's equation
holds along the surface and the pieces of the bed have their lengths. The curve is too stiff for standing waves upstream, and
only with one speed there the flow can become fast beyond the crest. The last piece of the bed goes on for ever.
"""

import math
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import least_squares

UPSTREAM, DOWNSTREAM = 4.0, 2.5  # phi that is looked at before the first corner and behind the last
LENGTHS = 10.0  # weight of the lengths beside Bernoulli's equation
NODES, WEIGHTS = (0.5 * (one + shift) for one, shift in zip(np.polynomial.legendre.leggauss(16), (1.0, 0.0)))


def log_coth(x):
    """L(x)."""
    decay = np.exp(-0.5 * math.pi * np.abs(x))
    return (np.log1p(decay) - np.log1p(-decay)) / math.pi


def sech_integral(x):
    """The integral of S from 0 to x."""
    return 2 / math.pi * np.arctan(np.tanh(0.25 * math.pi * x))


class Flow:
    """Flow of a `discharge` over a bed that is level up to points[0] and whose highest point is at the height 0. `step`
    and `knot` are distances in phi, of the surface's pieces and of the knots of its curve."""

    def __init__(self, points, discharge, step=0.02, knot=0.2):
        self.points, self.discharge, self.step = np.array(points, dtype=float), discharge, step
        pieces = np.diff(self.points, axis=0)
        self.lengths = np.hypot(*pieces.T)[:-1]
        self.turns = np.diff(np.arctan2(pieces[:, 1], pieces[:, 0]), prepend=0.0)

        # To start from: some corners, and a surface whose water is slow, then falls.
        head, height = 1.5 * discharge ** (2 / 3), 0.5 * (self.points[1:-1, 1] + self.points[:-2, 1])
        speed = np.where(pieces[:-1, 0] <= 1e-9, 0.18 * math.sqrt(head), np.sqrt(2 * np.maximum(head - height, 0.2 * head)))
        gaps = self.lengths * speed / discharge
        corners = np.append(0.0, np.cumsum(gaps))
        crest = corners[np.argmax(self.points[:-1, 1])]
        end = corners[-1] + DOWNSTREAM
        self.knots = np.concatenate([np.linspace(-UPSTREAM, crest - 2.5, 6)[:-1], np.arange(crest - 2.5, end - 0.6 * knot, knot), [end]])
        entry = discharge / (head - self.points[0, 1])
        falls = 0.5 * discharge * np.logaddexp(0, (self.knots - crest + 0.25) / 0.3)
        self.start = np.concatenate([np.log(gaps), np.log(entry**3 + falls) / 3, [math.log(entry)]])

        # L over the surface's pieces, from their middles: of its logarithm the integral, of the rest the value.
        self.edges = np.linspace(-UPSTREAM, end, round((end + UPSTREAM) / step) + 1)
        self.step = self.edges[1] - self.edges[0]
        self.middles = 0.5 * (self.edges[1:] + self.edges[:-1])
        apart = self.middles[:, None] - self.edges
        distance = np.maximum(np.abs(self.middles[:, None] - self.middles), 1e-3 * self.step)
        self.by_change = (np.diff(apart * np.log(np.abs(apart)) - apart, axis=1) / self.step + np.log(distance)) / math.pi + log_coth(distance)

    def parts(self, unknown):
        """(phi of the corners, ln u at the surface's edges, speed far upstream)."""
        count = len(self.lengths)
        curve = CubicSpline(self.knots, unknown[count:-1], bc_type=((1, 0.0), "not-a-knot"))
        return np.append(0.0, np.cumsum(np.exp(unknown[:count]))), curve(self.edges), math.exp(unknown[-1])

    def bed(self, phi, corners, log_speed, entry):
        """ln u of the bed."""
        share = sech_integral(phi[:, None] - self.edges)
        return (-np.diff(share, axis=1) @ (0.5 * (log_speed[1:] + log_speed[:-1])) + (0.5 - share[:, 0]) * math.log(entry)
                + (0.5 + share[:, -1]) * log_speed[-1] - log_coth(phi[:, None] - corners) @ self.turns)

    def surface(self, corners, log_speed, entry):
        """(x, y) of its edges, x from where it begins."""
        theta = (0.5 + sech_integral(self.middles[:, None] - corners)) @ self.turns - self.by_change @ np.diff(log_speed)
        length = self.step * self.discharge * np.exp(-0.5 * (log_speed[1:] + log_speed[:-1]))
        x, y = (np.append(0.0, np.cumsum(length * along)) for along in (np.cos(theta), np.sin(theta)))
        return x, y + self.discharge / entry + self.points[0, 1]

    def energy(self, entry):
        """Head above the crest."""
        return 0.5 * entry**2 + self.discharge / entry + self.points[0, 1]

    def misfit(self, unknown):
        corners, log_speed, entry = parts = self.parts(unknown)
        off = 0.5 * np.exp(2 * log_speed) + self.surface(*parts)[1] - self.energy(entry)
        gaps = np.diff(corners)[:, None]
        phi = corners[:-1, None] + gaps * (3 * NODES**2 - 2 * NODES**3)  # dense at corners, where u is 0 or has no end
        slowness = np.exp(-self.bed(phi.ravel(), *parts)).reshape(phi.shape)
        lengths = self.discharge * (gaps * 6 * (NODES - NODES**2) * slowness) @ WEIGHTS
        return np.append(off * np.exp(-log_speed) * math.sqrt(self.step), LENGTHS * np.log(lengths / self.lengths))

    @cached_property
    def found(self):
        """(x and y of the surface, energy head above the crest)."""
        parts = self.parts(least_squares(self.misfit, self.start, x_scale="jac", xtol=1e-9, ftol=1e-10).x)
        x, y = self.surface(*parts)
        share = (np.arange(400) + 0.5) / 400
        slowness = np.exp(-self.bed(-UPSTREAM * share**2, *parts))  # of the level bed before the first corner
        return x + self.points[0, 0] - self.discharge * UPSTREAM * float((2 * share * slowness).mean()), y, self.energy(parts[2])


def coefficients(flow, gauge):
    """(q/sqrt(g H^3) of the energy head H, the same if H is that of the depth at the distance `gauge` upstream of x = 0 with the
    same speed everywhere in it)."""
    x, y, energy = flow.found
    level = float(np.interp(-gauge, x, y))
    read = level + 0.5 * (flow.discharge / (level - flow.points[0][1])) ** 2
    return flow.discharge / energy**1.5, flow.discharge / read**1.5
