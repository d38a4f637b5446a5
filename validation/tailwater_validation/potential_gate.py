"""Water that shoots out under a vertical sluice gate, by potential flow with gravity: how thin the jet gets.

Lengths over the depth h of the jet far downstream, speeds over its speed V, so that g = 1/(2 (E - 1)) with the energy head
E. In t = exp(pi (phi + i psi)) the water is the upper half plane: t > 0 is the bed, 0 > t > R^2 - 1 the surface upstream,
which is taken as level, from there to t = -1 the gate, and t = -1 - s^2 the surface of the jet. Of omega = ln u - i theta,
with speed u and direction theta, one part is known everywhere: theta on walls and gate, by Bernoulli u on the jet. So
omega/sqrt(t + 1) is an integral over the known values (Riemann and Hilbert), and the jet is found by iteration.
"""

import math
from functools import lru_cache

import numpy as np

POINTS = 300
X = (np.arange(POINTS) + 0.5) / POINTS
S = np.tan(0.5 * math.pi * X)
DS = 0.5 * math.pi / np.cos(0.5 * math.pi * X) ** 2 / POINTS


def jet(energy):
    """(opening of the gate, depth upstream, R, ln u at the points S of the jet) for an energy head above 1.5."""
    g2 = 1 / (energy - 1)
    depth = 0.5 * (1 / g2 + math.sqrt(1 / g2**2 + 4 / g2))  # as much energy and discharge as the jet
    apart = S[:, None] ** 2 - S**2
    np.fill_diagonal(apart, 1)
    log_speed = np.zeros(POINTS)
    for _ in range(200):
        R = math.tanh(math.log(depth) + 2 / math.pi * np.sum(log_speed / (1 + S**2) * DS))
        rest = (log_speed - log_speed[:, None]) / apart
        np.fill_diagonal(rest, -np.gradient(log_speed, S) / (2 * S))
        theta = 2 * S / math.pi * (rest @ DS) - np.arctan(R / S)
        falls = -np.sin(theta) / np.exp(log_speed) * 2 / math.pi * S / (1 + S**2) * DS
        height = 1 + np.cumsum(falls[::-1])[::-1] - 0.5 * falls
        change = 0.5 * np.log((energy - height) * g2) - log_speed
        log_speed = log_speed + 0.5 * change
        if abs(change).max() < 1e-10:
            break
    return 1 + falls.sum(), depth, R, log_speed


@lru_cache(maxsize=None)
def contraction(share):
    """Depth of the jet over the opening of a gate, whose opening is this fraction of the depth upstream, at most a
    half."""
    low, high = math.log(3.0), math.log(1e4)
    for _ in range(22):
        middle = 0.5 * (low + high)
        opening, depth, *_ = jet(math.exp(middle))
        low, high = (middle, high) if opening / depth > share else (low, middle)
    return 1 / opening
