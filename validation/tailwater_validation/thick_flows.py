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


def slump_reach(area, density, yield_stress, gravity):
    """Reach (m) of a yielding liquid at rest over a bed: Liu & Mei (1989), J. Fluid Mech. 207, 505, whose surface
    h = sqrt(2 t_y (L - x)/(rho g)) holds the area 2/3 L h(0)."""
    return (1.5 * area / math.sqrt(2 * yield_stress / (density * gravity))) ** (2 / 3)


def yielding_slump(run):
    """reach_error: the front at the end over that of Liu & Mei (1989), less 1. surface_error: rms distance of the highest
    particles in columns of 4 dx from their surface, over the height at the wall."""
    liquid, = run.case["liquid"]
    area = run.parameters["L"] * run.parameters["H"]
    reach = slump_reach(area, liquid["density"], liquid["yield_stress"], run.gravity)
    height = math.sqrt(2 * liquid["yield_stress"] * reach / (liquid["density"] * run.gravity))
    x, y = exact_flows.frames(run)[-1].position[:, :2].astype(float).T
    column = np.floor(x / (4 * run.spacing)).astype(int)
    errors = []
    for k in range(column.max()):
        middle = (k + 0.5) * 4 * run.spacing
        if middle > 0.9 * reach:  # the tip is steeper than the theory's long waves
            break
        top = y[column == k].max() + 0.5 * run.spacing
        errors.append(top - height * math.sqrt(1 - middle / reach))
    return {"reach_error": float(run.curve("front", "front_m").value[-1] / reach - 1),
            "surface_error": rms(np.array(errors)) / height}


FLOWS = {"thick-film": thick_film, "viscous-dam-break": viscous_dam_break,
         "axisymmetric-dam-break": axisymmetric_dam_break, "yielding-slump": yielding_slump}
