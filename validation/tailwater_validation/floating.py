"""A box that floats in the middle of a closed tank, by linear potential theory: runs of cases/floating_box.

The water between tank and box and the box are one oscillator. Its coordinates are the elevations of the surface and the
displacement (or the angle) of the box; the kinetic energy of the water for given velocities of these follows from the
Laplace equation for the velocity potential, so that added mass and waves are part of it. Half of the tank is divided
into square cells (finite volumes), and what comes out is extrapolated over the size of the cells.
"""

from dataclasses import dataclass

import numpy as np

from tailwater.errors import DataError

CELLS = (10, 20)  # of half the box's breadth
CORNER_ORDER = 4 / 3  # of the kinetic energy's error: the potential goes like r^(2/3) at the box's right-angled corners
SWINGS = 6  # crossings of the mean over which a period is measured, three whole periods


@dataclass(frozen=True)
class Tank:
    """Lengths in m; `mass` (kg) and `inertia` (kg m^2 about the centre of mass, at half the box's height) per metre."""

    width: float
    depth: float  # of the still water, with the box in it
    breadth: float
    height: float
    mass: float
    inertia: float
    density: float
    gravity: float

    @property
    def draught(self):
        return self.mass / (self.density * self.breadth)


class Oscillator:
    """Heave (symmetric) or roll about a fixed centre of mass (antisymmetric), with `cells` in half the box's breadth."""

    def __init__(self, tank, rolls, cells):
        side = 0.5 * tank.breadth / cells
        lengths = np.array([0.5 * tank.width, tank.depth, tank.depth - tank.draught]) / side
        columns, rows, below = (int(round(length)) for length in lengths)
        if np.abs(lengths - np.round(lengths)).max() > 1e-6:
            raise DataError(f"width, depth and draught must be whole numbers of B/{2 * cells}")
        wet = np.ones((columns, rows), dtype=bool)
        wet[:cells, below:] = False
        index = np.full(wet.shape, -1)
        index[wet] = np.arange(wet.sum())
        surface = index[cells:, -1]
        laplacian, last = np.zeros((wet.sum(),) * 2), surface.size
        for first, second in ((index[:-1], index[1:]), (index[:, :-1], index[:, 1:])):
            both = (first >= 0) & (second >= 0)
            a, b = first[both], second[both]
            np.add.at(laplacian, (a, a), 1.0)
            np.add.at(laplacian, (b, b), 1.0)
            laplacian[a, b] = laplacian[b, a] = -1.0
        # Fluxes out of the water: column k for coordinate k, the surface's elevations and last the box.
        fluxes = np.zeros((wet.sum(), last + 1))
        fluxes[surface, np.arange(last)] = side
        at_faces = np.full(last, side**2)  # the square of what passes each face, for the half cells before it
        x = (np.arange(cells) + 0.5) * side
        y = (np.arange(below, rows) + 0.5) * side - (tank.depth - tank.draught + 0.5 * tank.height)
        under = x * side if rolls else np.full(cells, side)
        beside = -y * side if rolls else np.zeros(y.size)
        fluxes[index[:cells, below - 1], last] += under
        fluxes[index[cells, below:], last] -= beside  # the water is on the other side of this face
        if rolls:  # the potential is 0 in the middle of the tank
            laplacian[index[0, :below], index[0, :below]] += 2.0
        else:  # it is known up to a constant
            laplacian[0, 0] += 1.0
        water = fluxes.T @ np.linalg.solve(laplacian, fluxes)
        water[np.arange(last), np.arange(last)] += 0.5 * at_faces
        water[last, last] += 0.5 * ((under**2).sum() + (beside**2).sum())
        mass = tank.density * water
        mass[last, last] += 0.5 * (tank.inertia if rolls else tank.mass)
        stiffness = np.diag(np.full(last + 1, tank.density * tank.gravity * side))
        # Half of: rho g B; rho g B^3/12 less the weight times the height of the centre of mass over that of buoyancy.
        restoring = tank.breadth if not rolls else (
            tank.breadth**3 / 12 - tank.breadth * tank.draught * 0.5 * (tank.height - tank.draught))
        stiffness[last, last] = 0.5 * tank.density * tank.gravity * restoring
        free = np.eye(last + 1)
        if not rolls:  # the displaced water raises the surface
            free = free[:, 1:]
            free[0, :-1] = -1.0
            free[0, -1] = -0.5 * tank.breadth / side
        start = np.zeros(last + 1)
        start[last] = 1.0 if rolls else 1 - tank.breadth / tank.width
        if not rolls:
            start[:last] = -tank.breadth / tank.width
        root = np.linalg.cholesky(free.T @ mass @ free)
        inverse = np.linalg.inv(root)
        squares, shapes = np.linalg.eigh(inverse @ free.T @ stiffness @ free @ inverse.T)
        shapes = inverse.T @ shapes
        parts = shapes.T @ (free.T @ mass @ free) @ start[0 if rolls else 1:]
        self.frequency = np.sqrt(squares)
        self.amplitude = (free @ shapes)[last] * parts  # of the box, in the modes, let go at 1 from its place at rest

    def motion(self, time):
        return np.cos(np.outer(time, self.frequency)) @ self.amplitude


def crossings(time, value):
    """Times at which a curve passes 0, linear between samples."""
    k = np.flatnonzero(value[:-1] * value[1:] < 0)
    return time[k] - value[k] * (time[k + 1] - time[k]) / (value[k + 1] - value[k])


def period(time, value):
    """Period from SWINGS half periods after the first crossing."""
    found = crossings(time, value)
    if found.size < SWINGS + 1:
        raise DataError(f"passes its mean {found.size} times, fewer than the {SWINGS + 1} that a period is taken from")
    return 2 * (found[SWINGS] - found[0]) / SWINGS


def theory(tank, rolls, end):
    """(period, fraction of the motion in the strongest mode), extrapolated to cells of size zero."""
    time = np.linspace(0, end, 20001)
    found = [Oscillator(tank, rolls, cells) for cells in CELLS]
    periods = [period(time, oscillator.motion(time)) for oscillator in found]
    coarse, fine = (cells**-CORNER_ORDER for cells in CELLS)
    return periods[1] + (periods[1] - periods[0]) * fine / (coarse - fine), float(np.abs(found[1].amplitude).max())


def tank_of(run):
    p, body = run.parameters, run.case["body"][0]
    return Tank(p["W"], p["h"], p["B"], p["H"], body["mass"], body["inertia"][0], run.density, run.gravity)


def floating_box(run):
    """period_error: relative error of the period over SWINGS/2 periods. draught_error_dx: error of the mean position
    in the second half (heave)."""
    tank, body = tank_of(run), run.case["body"][0]
    rolls = body["free"] == ["rotation"]
    end = run.case["time"]["end"]
    curve = run.curve("box", "angle_rad" if rolls else "displacement_y_m")
    p = run.parameters
    # Where it comes to rest; the water that it displaces there stands around it.
    rest = 0.0 if rolls else p["up"] * (p["B"] / p["W"] - 1)
    place = curve.value + p["tilt"] if rolls else curve.value - rest
    computed = period(curve.time, place)
    expected, share = theory(tank, rolls, end)
    numbers = {"period_s": computed, "theory_s": expected, "period_error": computed / expected - 1, "mode_share": share}
    if not rolls:
        later = curve.window(0.5 * end, end)
        numbers["draught_error_dx"] = float(later.value.mean() - rest) / run.spacing
    return numbers
