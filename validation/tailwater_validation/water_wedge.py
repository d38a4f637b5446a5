"""A wedge of water that meets a wall at right angles to its axis, without gravity: the self-similar potential flow after
the first contact, by a boundary element method that is marched to its steady state.

Lengths over U t, speeds over U, potentials over U^2 t, pressures over rho U^2, with t since the contact: x along the wall
from the axis, y from the wall. With s = ln t a particle of the surface obeys dx/ds = grad phi - x and
dphi/ds = |grad phi|^2/2 + 1/2 - phi (Bernoulli at p = 0). The thin jet is cut off where it is CUT thick. The water is
bounded at the height `reach`, where it moves undisturbed, which lowers the pressure.

Usage: python -m tailwater_validation.water_wedge > cases/verification/data/water_wedge.csv     (some minutes)
"""

import math

import numpy as np

HALF_ANGLE = math.radians(60)
REACH = 16.0  # height of the water
CUT = 0.04  # thickness of the jet where it is cut off
FINEST, ELEMENTS = 0.012, 220  # first element of the surface, at the jet; their number
END = 3.5  # s; then exp(-s) = 3 % of the start is left, and the jet's tip becomes noisy later on


def segment_integrals(p, a, b):
    """Integrals of ln r and of d ln r/dn over the segments from a to b, for each point p; n is to their right."""
    length = np.hypot(*(b - a).T)
    t = (b - a) / length[:, None]
    n = np.stack([t[:, 1], -t[:, 0]], axis=1)
    to = a[None] - p[:, None]
    start, across = (to * t).sum(2), (to * n).sum(2)
    away = np.where(np.abs(across) > 1e-12, across, np.inf)

    def logarithm(x):
        angle = np.where(np.isinf(away), 0.0, across * np.arctan(x / away))
        return 0.5 * x * np.log(np.maximum(x**2 + across**2, 1e-300)) - x + angle

    return (logarithm(start + length) - logarithm(start),
            np.arctan((start + length) / away) - np.arctan(start / away))


def influence(p, a, b):
    """Single and double layers of ln(1/r)/2 pi of segments and their images in the wall and the axis."""
    single, double = 0.0, 0.0
    for mirror in ((1, 1), (-1, 1), (1, -1), (-1, -1)):
        ends = (a * mirror, b * mirror)
        one, two = segment_integrals(p, *(ends if mirror[0] == mirror[1] else ends[::-1]))
        single, double = single - one / (2 * math.pi), double - two / (2 * math.pi)
    return single, double


def stretched(length):
    """Arc lengths of the ends of the elements, which grow from FINEST in equal ratio."""
    low, high = 1 + 1e-9, 1.2
    for _ in range(80):
        ratio = 0.5 * (low + high)
        low, high = (low, ratio) if FINEST * (ratio**ELEMENTS - 1) / (ratio - 1) > length else (ratio, high)
    ends = (ratio ** np.arange(ELEMENTS + 1) - 1) / (ratio - 1)
    return ends / ends[-1] * length


def line(start, end, pieces):
    return np.linspace(start, end, pieces + 1)


def smoothed(values):
    """Smoothed by the five-point formula of Longuet-Higgins & Cokelet (1976), which removes a sawtooth."""
    out = values.copy()
    out[2:-2] = (-values[:-4] + 4 * values[1:-3] + 10 * values[2:-2] + 4 * values[3:-1] - values[4:]) / 16
    out[1] = (values[0] + 2 * values[1] + values[2]) / 4
    return out


def cubic(at, arc, values):
    """Monotone Hermite interpolation along a curve (Fritsch & Carlson 1980). Linear pieces would erode the jet, and
    other cubics overshoot at its root."""
    rise = np.diff(values) / np.diff(arc)
    before, after = rise[:-1], rise[1:]
    alike = before * after > 0
    inner = np.where(alike, 2 * before * after / np.where(alike, before + after, 1.0), 0.0)
    slope = np.concatenate([[rise[0]], inner, [rise[-1]]])
    k = np.clip(np.searchsorted(arc, at) - 1, 0, len(arc) - 2)
    gap = arc[k + 1] - arc[k]
    t = (at - arc[k]) / gap
    return ((1 + 2 * t) * values[k] + t * gap * slope[k]) * (1 - t) ** 2 + (
        (3 - 2 * t) * values[k + 1] - (1 - t) * gap * slope[k + 1]) * t**2


class Wedge:
    """The surface, from the cut through the jet to the height `reach`: ends of the elements, and the potential at
    their middles."""

    def __init__(self, half_angle, reach):
        self.far = np.array([math.tan(half_angle) * (1 + reach), reach])
        start = np.array([math.tan(half_angle) * (1 + CUT), CUT])
        arc = stretched(math.dist(start, self.far))
        self.ends = start + (self.far - start) * (arc / arc[-1])[:, None]
        self.potential = -self.middles[:, 1]

    @property
    def middles(self):
        return 0.5 * (self.ends[1:] + self.ends[:-1])

    def solve(self):
        """Potential and its outward derivative on all elements; also of the undisturbed top, and of the cut, across which
        the potential does not change."""
        top = line(self.far, (0.0, self.far[1]), 24)
        cut = line((self.ends[0, 0], 0.0), self.ends[0], 4)
        self.a = np.concatenate([part[:-1] for part in (self.ends, top, cut)])
        self.b = np.concatenate([part[1:] for part in (self.ends, top, cut)])
        middle = 0.5 * (self.a + self.b)
        self.phi = np.concatenate([self.potential, np.full(len(top) - 1, -self.far[1]),
                                   np.full(len(cut) - 1, 1.5 * self.potential[0] - 0.5 * self.potential[1])])
        single, double = influence(middle, self.a, self.b)
        self.normal = np.linalg.solve(single, double @ self.phi + 0.5 * self.phi)

    def velocity(self):
        """Velocity at the middles of the surface's elements, after solve()."""
        step = np.diff(self.ends, axis=0)
        length = np.hypot(*step.T)
        t = step / length[:, None]
        arc = np.concatenate([[0.0], np.cumsum(0.5 * (length[1:] + length[:-1]))])
        along = np.gradient(self.potential, arc)
        return along[:, None] * t + self.normal[:len(t), None] * np.stack([t[:, 1], -t[:, 0]], axis=1)

    def march(self):
        """One step; returns its length in s."""
        self.solve()
        x, u = self.middles, self.velocity()
        gaps = np.hypot(*np.diff(x, axis=0).T)
        ds = 0.3 * np.min(gaps / np.maximum(np.hypot(*(u - x)[1:].T), 0.3))
        moved = smoothed(x + ds * (u - x))
        phi = smoothed(self.potential + ds * (0.5 * (u**2).sum(1) + 0.5 - self.potential))
        # From the tip, half an element before the first middle, or from where the jet is CUT thick.
        x = np.vstack([1.5 * moved[0] - 0.5 * moved[1], moved])
        phi = np.concatenate([[1.5 * phi[0] - 0.5 * phi[1]], phi])
        thin = np.flatnonzero(x[:40, 1] < CUT)
        if thin.size:
            k = thin[-1]
            share = (CUT - x[k, 1]) / (x[k + 1, 1] - x[k, 1])
            x = np.vstack([x[k] + share * (x[k + 1] - x[k]), x[k + 1:]])
            phi = np.concatenate([[phi[k] + share * (phi[k + 1] - phi[k])], phi[k + 1:]])
        kept = x[:, 1] < 0.98 * self.far[1]
        x, phi = np.vstack([x[kept], self.far]), np.concatenate([phi[kept], [-self.far[1]]])
        arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(x, axis=0).T))])
        ends = stretched(arc[-1])
        self.ends = np.column_stack([cubic(ends, arc, x[:, k]) for k in (0, 1)])
        self.potential = cubic(0.5 * (ends[1:] + ends[:-1]), arc, phi)
        return ds

    def wall_pressure(self, x):
        """Pressure at places along the wall, after solve(): p = 1/2 - phi_t - u^2/2 with phi_t = phi - x phi_x."""
        h = 1e-4

        def potential(at):
            single, double = influence(np.column_stack([at, np.full(at.size, 1e-3)]), self.a, self.b)
            return single @ self.normal - double @ self.phi

        speed = (potential(x + h) - potential(x - h)) / (2 * h)
        return 0.5 - (potential(x) - x * speed) - 0.5 * speed**2


def pressure_on_wall(half_angle=HALF_ANGLE, reach=REACH):
    """(x, pressure) from the axis to the cut."""
    wedge, s = Wedge(half_angle, reach), 0.0
    while s < END:
        s += wedge.march()
    wedge.solve()
    x = np.linspace(0.01, 0.98 * wedge.ends[0, 0], 120)
    return x, wedge.wall_pressure(x)


def main():
    print(f"# Pressure on a wall that a wedge of water of half-angle 60 degrees has met, {REACH:g} U t high; over rho U^2.")
    print("# Made by: python -m tailwater_validation.water_wedge")
    print("x_over_Ut,pressure")
    for x, pressure in zip(*pressure_on_wall()):
        print(f"{x:.4f},{pressure:.4f}")


if __name__ == "__main__":
    main()
