"""Heave of a floating box in regular waves, by linear potential theory with matched eigenfunctions.

A box of rectangular section heaves at the surface of water of even depth. The potential below the box and that beside it are series
of eigenfunctions, which agree in potential and flux along the vertical line below the edge (Black, Mei & Bray 1971, J. Fluid Mech. 46,
151-164). The heave is that of a box whose other motions are held.
"""

from dataclasses import dataclass

import numpy as np

MODES = 60  # of each series; the added mass changes by less than 1e-3 beyond


def roots(omega, gravity, depth, count):
    """k with omega^2 = g k tanh kh, and k_m with omega^2 = -g k_m tan k_m h, by bisection."""
    def bisect(function, low, high):
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if function(middle) > 0 else (middle, high)
        return 0.5 * (low + high)

    surface = omega**2 * depth / gravity
    first = bisect(lambda y: y * np.tanh(y) - surface, 0.0, surface + np.sqrt(surface))
    others = [bisect(lambda y: y * np.tan(y) + surface, (m - 0.5) * np.pi * (1 + 1e-12), m * np.pi) for m in range(1, count)]
    return first / depth, np.array(others) / depth


@dataclass(frozen=True)
class FloatingBox:
    """Lengths in m, all loads per metre of width."""

    breadth: float
    draught: float
    depth: float
    mass: float
    density: float = 1000.0
    gravity: float = 9.81

    def radiation(self, omega):
        """(added mass, damping) of heave at the angular frequency `omega` (1/s)."""
        half, below, h = 0.5 * self.breadth, self.depth - self.draught, self.depth
        k, evanescent = roots(omega, self.gravity, h, MODES)
        numbers = np.concatenate(([1j * k], evanescent)).astype(complex)  # cos(i k z) = cosh kz
        inner = np.arange(MODES) * np.pi / below
        # Integrals over 0 < z < below of cos(inner z) cos(numbers z), and over the depth of cos^2(numbers z); all over cosh kh.
        scale = np.where(np.arange(MODES) == 0, np.cosh(k * h), 1.0)
        plus, minus = numbers[None, :] + inner[:, None], numbers[None, :] - inner[:, None]
        overlap = 0.5 * (np.sin(plus * below) / plus + np.sin(minus * below) / minus) / scale
        norm = (0.5 * h + 0.25 * np.sin(2 * numbers * h) / numbers) / scale**2
        inner_norm = np.where(inner == 0, below, 0.5 * below)
        # Below the box: ((z^2 - x^2)/(2 below) + sum A_n cosh(inner x)/cosh(inner half) cos(inner z)), for a unit velocity.
        squares = np.where(inner == 0, below**3 / 3, 0.0)
        squares[1:] = 2 * below * np.cos(inner[1:] * below) / inner[1:]**2
        given = (squares - np.where(inner == 0, half**2 * below, 0.0)) / (2 * below)
        slope = inner * np.tanh(inner * half)
        # Beside it: sum B_m exp(-numbers (x - half)) cos(numbers z)/scale; exp(+ikx) for the first, which travels away.
        decay = np.where(np.arange(MODES) == 0, -1j * k, numbers)
        # Flux at the edge: -decay_m norm_m B_m = sum_n slope_n overlap_nm A_n - half/below overlap_0m.
        flux_of_inner = -(slope[:, None] * overlap).T / (decay * norm)[:, None]
        flux_given = half / below * overlap[0] / (decay * norm)
        matrix = np.diag(inner_norm) - overlap @ flux_of_inner
        series = np.linalg.solve(matrix.astype(complex), overlap @ flux_given - given)
        # The force is that of the pressure -rho dphi/dt below both halves, for phi exp(-i omega t).
        means = np.where(inner == 0, half, 0.0)
        means[1:] = np.tanh(inner[1:] * half) / inner[1:]
        integral = 2 * ((0.5 * below * half - half**3 / (6 * below)) + (series * np.cos(inner * below) * means).sum())
        return float(self.density * integral.real), float(self.density * omega * integral.imag)

    def group_speed(self, omega):
        k, _ = roots(omega, self.gravity, self.depth, 1)
        return 0.5 * omega / k * (1 + 2 * k * self.depth / np.sinh(2 * k * self.depth))

    def response(self, omega, damping=0.0):
        """(heave over the amplitude of the waves, power of a damper over the square of that amplitude, W/m^2)."""
        added, radiated = self.radiation(omega)
        exciting = np.sqrt(2 * self.density * self.gravity * self.group_speed(omega) * radiated)  # Haskind
        stiffness = self.density * self.gravity * self.breadth
        heave = exciting / abs(stiffness - omega**2 * (self.mass + added) - 1j * omega * (radiated + damping))
        return float(heave), float(0.5 * damping * (omega * heave)**2)
