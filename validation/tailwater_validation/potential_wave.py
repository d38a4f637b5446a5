"""A solitary wave that meets an upright wall, by fully nonlinear potential flow: the reference for the force and the
pressure on the wall. High-order spectral method (Dommermuth & Yue 1987, J. Fluid Mech. 184, 267; West et al. 1987, J.
Geophys. Res. 92, 11803): the wall is the plane of symmetry between two equal waves in a periodic channel.

Lengths over the depth h of the still water, times over sqrt(h/g), pressures over rho g h.
"""

from dataclasses import dataclass

import numpy as np

ORDER = 6  # of the expansion about the still level
NODES = 256
HALF = 24.0  # depths from the wall to the next plane of symmetry
STEP = 0.04  # sqrt(h/g)


class Channel:
    """Fourier modes of the channel, with the wall in its middle."""

    def __init__(self):
        self.x = (np.arange(NODES) / NODES - 0.5) * 2 * HALF
        self.k = np.fft.rfftfreq(NODES, 2 * HALF / NODES) * 2 * np.pi
        # Products of as many factors as ORDER would be aliased; modes above a third hold nothing of these long waves.
        self.kept = self.k < self.k[-1] / 3

    def modes(self, values):
        return np.where(self.kept, np.fft.rfft(values), 0.0)

    def values(self, modes):
        return np.fft.irfft(modes, NODES)

    def derivative(self, values):
        return self.values(1j * self.k * self.modes(values))

    def vertical(self, modes, order):
        """The `order`-th upward derivative, at the still level, of the potential with these modes there."""
        return self.values(modes * self.k**order * (np.tanh(self.k) if order % 2 else 1.0))

    def potentials(self, elevation, surface):
        """Modes at the still level, by order, of the potential that equals `surface` at the elevation."""
        orders = [self.modes(surface)]
        for m in range(1, ORDER):
            total, power = np.zeros(NODES), 1.0
            for l in range(1, m + 1):
                power = power * elevation / l
                total = total + power * self.vertical(orders[m - l], l)
            orders.append(-self.modes(total))
        return orders

    def rise(self, elevation, surface):
        """Vertical velocity of the water at its surface, and the modes of the potential at the still level."""
        orders = self.potentials(elevation, surface)
        total, power = np.zeros(NODES), np.ones(NODES)
        for l in range(ORDER):
            total = total + power * self.vertical(sum(orders[:ORDER - l]), l + 1)
            power = power * elevation / (l + 1)
        return total, sum(orders)

    def change(self, elevation, surface):
        """Rates of the elevation and of the potential at the surface."""
        w, _ = self.rise(elevation, surface)
        eta_x, phi_x = self.derivative(elevation), self.derivative(surface)
        eta_t = (1 + eta_x**2) * w - phi_x * eta_x
        phi_t = -elevation - 0.5 * phi_x**2 + 0.5 * (1 + eta_x**2) * w**2
        return self.values(self.modes(eta_t)), self.values(self.modes(phi_t))


def fenton(e, x):
    """Elevation of a solitary wave of height e to the third order (Fenton 1972), and its speed."""
    a = np.sqrt(0.75 * e) * (1 - 0.625 * e + 71 / 128 * e**2)
    s2 = 1 / np.cosh(a * x) ** 2
    t2 = np.tanh(a * x) ** 2
    eta = e * s2 - 0.75 * e**2 * s2 * t2 + e**3 * (0.625 * s2 * t2 - 101 / 80 * s2**2 * t2)
    return eta, np.sqrt(1 + e - e**2 / 20 - 3 * e**3 / 70)


def start(channel, e, distance):
    """Two waves of height e, which run towards the wall from this distance: (elevation, potential at the surface)."""
    elevation, rate = np.zeros(NODES), np.zeros(NODES)
    for side in (-1, 1):
        eta, c = fenton(e, channel.x - side * distance)
        elevation += eta
        rate += side * c * channel.derivative(eta)
    # The potential whose surface rises as that of waves of permanent form does, by iteration.
    surface = np.zeros(NODES)
    flat = np.where(channel.k > 0, channel.k * np.tanh(channel.k), 1.0)
    for _ in range(60):
        left = rate - channel.change(elevation, surface)[0]
        surface = surface + channel.values(np.where(channel.k > 0, channel.modes(left) / flat, 0.0))
    return elevation, surface


@dataclass(frozen=True)
class WallHistory:
    """History at the wall over `time` (0 at the highest water): run-up above the still level, and force on the wall
    and pressures at the requested heights, both less those of the still water."""

    time: np.ndarray
    run_up: np.ndarray
    force: np.ndarray
    pressure: dict


def at_wall(e, heights=(0.0,), distance=12.0):
    """The history at a wall for a solitary wave of height e (at most 0.3)."""
    channel = Channel()
    state = start(channel, e, distance)
    middle, count = NODES // 2, int(2 * distance / np.sqrt(1 + e) / STEP)
    run_up, moment = np.empty(count), np.empty(count)
    potential, speed = {z: np.empty(count) for z in heights}, {z: np.empty(count) for z in heights}
    sign = np.where(np.arange(channel.k.size) % 2, -1.0, 1.0)  # of each mode in the middle
    weight = np.where(channel.k > 0, 2.0, 1.0) / NODES
    for n in range(count):
        elevation, surface = state
        _, modes = channel.rise(elevation, surface)
        run_up[n] = elevation[middle]
        moment[n] = np.sum(elevation * np.abs(channel.x)) / 2 * (channel.x[1] - channel.x[0])
        column = np.real(modes) * sign * weight * channel.kept
        k = np.where(channel.kept, channel.k, 0.0)
        for z in heights:
            potential[z][n] = np.sum(column * np.cosh(k * z) / np.cosh(k))
            speed[z][n] = np.sum(column * k * np.sinh(k * z) / np.cosh(k))
        stages = []
        for fraction in (0.0, 0.5, 0.5, 1.0):
            point = tuple(s + fraction * STEP * r for s, r in zip(state, stages[-1])) if stages else state
            stages.append(channel.change(*point))
        state = tuple(s + STEP / 6 * (a + 2 * b + 2 * c + d) for s, a, b, c, d in zip(state, *stages))
    # Momentum of the water on one side: the wall's force less that of the water at rest far away is its change, and
    # continuity makes it the first moment of the elevation.
    force = np.gradient(np.gradient(moment, STEP), STEP)
    pressure = {z: -np.gradient(potential[z], STEP) - 0.5 * speed[z] ** 2 for z in heights}
    time = (np.arange(count) - int(np.argmax(run_up))) * STEP
    inner = slice(2, -2)
    return WallHistory(time[inner], run_up[inner], force[inner], {z: p[inner] for z, p in pressure.items()})
