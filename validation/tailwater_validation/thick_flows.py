"""Errors of runs of thick and yielding liquids in cases/verification against theory. As in exact_flows.py, each
function takes a Run and returns its numbers by name."""

import math

import numpy as np

from . import exact_flows
from .profiles import rms


def film_velocity(y, depth, force, consistency, index, yield_stress):
    """Speed (m/s) at the height y (m) in a steady film under the body force (N/m^3) along its bed. The stress
    force (depth - y) shears it up to the plug."""
    sheared = depth - yield_stress / force
    power = 1 / index + 1
    return (force / consistency) ** (1 / index) / power * (sheared**power - np.maximum(sheared - y, 0) ** power)


def thick_film(run):
    """At the end: profile_error, the rms error of the speed over that of the plug, and discharge_error, the mean speed
    over that of theory, less 1."""
    liquid, = run.case["liquid"]
    depth, force = run.parameters["H"], liquid["density"] * run.parameters["G"]
    last = exact_flows.frames(run)[-1]
    velocity, = exact_flows.fields(run, last, "velocity")
    exact = film_velocity(last.position[:, 1].astype(float), depth, force, liquid["viscosity"], 1.0, liquid["yield_stress"])
    return {"profile_error": rms(velocity[:, 0] - exact) / exact.max(),
            "discharge_error": float(velocity[:, 0].mean() / exact.mean() - 1)}


def viscous_front(time, area, viscosity, gravity):
    """Reach (m) of a thin viscous current of this area (m^2) behind a wall: Huppert (1982), J. Fluid Mech. 121, 43."""
    return 1.411 * (gravity * area**3 / (3 * viscosity)) ** 0.2 * time**0.2


def viscous_dam_break(run):
    """front_error: the front at the end over that of Huppert (1982), less 1."""
    liquid, = run.case["liquid"]
    front = run.curve("front", "front_m")
    exact = viscous_front(front.time[-1], run.parameters["L"] * run.parameters["H"],
                          liquid["viscosity"] / liquid["density"], run.gravity)
    return {"front_error": float(front.value[-1] / exact - 1)}


def axisymmetric_front(time, volume, viscosity, gravity):
    """Radius (m) of a thin viscous current of this volume (m^3): Huppert (1982), J. Fluid Mech. 121, 43."""
    return 0.894 * (gravity * volume**3 / (3 * viscosity)) ** 0.125 * time**0.125


def axisymmetric_dam_break(run):
    """front_error and diagonal_error: the fronts along x and between x and y at the end over that of Huppert (1982),
    less 1. The block is a quarter of a cylinder of the height and radius H."""
    liquid, = run.case["liquid"]
    volume = math.pi * run.parameters["H"] ** 3
    errors = {}
    for probe in ("front", "diagonal"):
        front = run.curve(probe, "front_m")
        exact = axisymmetric_front(front.time[-1], volume, liquid["viscosity"] / liquid["density"], run.gravity)
        errors[f"{probe}_error"] = float(front.value[-1] / exact - 1)
    return errors


def slump_surface(way, yield_height):
    """Height (m) of a plane slump of a yielding liquid at rest, at this way (m) behind its tip; yield_height (m) is
    t_y/(rho g). In a slump that has flowed outwards Nadai's stresses yield everywhere: the longitudinal stress takes
    pi/2 t_y h from the thrust rho g h^2/2 of a column, whose gradient balances t_y on the bed. Without that part this
    is Liu & Mei (1989), J. Fluid Mech. 207, 505 (docs/theory/rheology.md)."""
    half = math.pi / 2 * yield_height
    return half + np.sqrt(half**2 + 2 * yield_height * way)


def slump_reach(area, yield_height):
    """Reach (m) of such a slump of this area (m^2). The root s = h(0) - pi/2 t_y/(rho g) of the area under its surface
    is that of a cubic."""
    half = math.pi / 2 * yield_height
    roots = np.roots([2, 3 * half, 0, -5 * half**3 - 6 * yield_height * area])
    root = roots[np.abs(roots.imag) < 1e-9 * np.abs(roots)].real.max()
    return (root**2 - half**2) / (2 * yield_height)


def yielding_slump(run):
    """reach_error: the front at the end over that of slump_reach, less 1. surface_error: rms distance of the level from
    slump_surface, over its height at the wall. The level is the area of the particles beside a place, weighted by a hat
    of half a width of 4 dx."""
    liquid, = run.case["liquid"]
    yield_height = liquid["yield_stress"] / (liquid["density"] * run.gravity)
    reach = slump_reach(run.parameters["L"] * run.parameters["H"], yield_height)
    x = exact_flows.frames(run)[-1].position[:, 0].astype(float)
    width = 4 * run.spacing
    places = np.arange(width, 0.9 * reach, run.spacing)  # the tip is steeper than the theory's long waves
    level = [np.maximum(0, 1 - np.abs(x - place) / width).sum() * run.spacing**2 / width for place in places]
    errors = level - slump_surface(reach - places, yield_height)
    return {"reach_error": float(run.curve("front", "front_m").value[-1] / reach - 1),
            "surface_error": rms(errors) / float(slump_surface(reach, yield_height))}


FLOWS = {"thick-film": thick_film, "viscous-dam-break": viscous_dam_break,
         "axisymmetric-dam-break": axisymmetric_dam_break, "yielding-slump": yielding_slump}
