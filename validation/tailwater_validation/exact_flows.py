"""Errors of runs of cases/robustness, cases/verification and cases/flume against theory.

Each function takes a Run and returns its numbers by name; all are without unit unless the name ends in one. They
throw DataError where the run lacks the data that they need.
"""

import cmath
import math
from functools import partial
from pathlib import Path

import numpy as np

from tailwater.errors import DataError
from tailwater.fields import list_frames, read_frame
from tailwater.tables import read_table

from . import beji_battjes, flume, openings, shallow_water, thick_flows, two_liquids
from .profiles import rms

REST = 5.0  # s from which a tank counts as at rest; at most half the run
BOTTOM_LAYER = 4  # dx


def fields(run, frame, *names):
    """Fields of a frame, as float64. Throws DataError for a field that is not in the file."""
    for name in names:
        if name not in frame.fields:
            raise DataError(f"{run.path}: the field files hold no {name}; add it to output.fields")
    return [frame.fields[name].astype(float) for name in names]


def frames(run):
    """All frames of a run, from the start to the end. Throws DataError if the run did not reach its end."""
    found = list_frames(run.path)
    if not found or run.summary.get("status") != "done":
        raise DataError(f"{run.path}: the run {run.summary.get('message') or 'has not ended'}")
    return [read_frame(*entry) for entry in found]


def relative_error(computed, exact):
    """L2 norm of the difference over that of `exact`."""
    return float(np.linalg.norm(computed - exact) / np.linalg.norm(exact))


# ---------------------------------------------------------------------------------------------------- still water


def bottom_distance(run, position):
    """Distance (m) from the parts of the tank's bottom that are not vertical. In 3D the bottom is the lowest plane or,
    if the case's parameters have a `radius`, the round valley of that radius in the middle."""
    if "radius" in run.parameters:
        radius = run.parameters["radius"]
        return radius - np.hypot(position[:, 0] - 0.5 * run.parameters["L"], position[:, 2] - radius)
    wall, = run.case["wall"]
    if run.dimension == 3:
        return position[:, 2] - wall["min"][2]
    least = np.full(len(position), np.inf)
    for start, end in zip(np.array(wall["points"])[:-1], np.array(wall["points"])[1:]):
        along = end - start
        if along[0] == 0.0:
            continue
        share = np.clip((position[:, :2] - start) @ along / (along @ along), 0.0, 1.0)
        least = np.minimum(least, np.linalg.norm(position[:, :2] - start - share[:, None] * along, axis=1))
    return least


def tank(run):
    """Water at rest whose surface is at the height `depth` of the case's parameters, over a bottom whose height at the
    depth probe is `bed` (default 0).

    u_rms: largest from REST on, over sqrt(g H). pressure_error: rms over all
    particles at the end, over rho g H. level_error_dx: largest from then on. bottom_density: mean density error within
    4 dx of the bottom at the end."""
    depth, dx = run.parameters["depth"], run.spacing
    last = frames(run)[-1]
    pressure, density_error = fields(run, last, "pressure", "density_error")
    height = last.position[:, run.dimension - 1].astype(float)
    scale = run.density * run.gravity * depth
    hydrostatic = run.density * run.gravity * (depth - height)
    kinetic = run.step_curve("kinetic_J")
    rest = min(REST, 0.5 * kinetic.time[-1])
    mass = run.density * dx**run.dimension * run.fluid_particles
    level = run.curve("level", "connected_m").window(rest, math.inf).value + run.parameters.get("bed", 0.0)
    return {
        "u_rms": math.sqrt(2 * kinetic.window(rest, math.inf).value.max() / mass / (run.gravity * depth)),
        "pressure_error": float(np.sqrt(np.mean((pressure - hydrostatic) ** 2))) / scale,
        "level_error_dx": float(np.abs(level - depth).max()) / dx,
        "bottom_density": float(density_error[bottom_distance(run, last.position) < BOTTOM_LAYER * dx].mean()),
    }


# -------------------------------------------------------------------------------------------- Taylor-Green vortices


def taylor_green_field(position, time, speed, side, viscosity, density):
    """(velocity, pressure with mean 0) of the decaying vortices."""
    k = 2 * math.pi / side
    x, y = k * position[:, 0], k * position[:, 1]
    decay = math.exp(-2 * viscosity * k**2 * time)
    velocity = speed * decay * np.stack([np.sin(x) * np.cos(y), -np.cos(x) * np.sin(y)], axis=1)
    pressure = 0.25 * density * (speed * decay) ** 2 * (np.cos(2 * x) + np.cos(2 * y))
    return velocity, pressure


def taylor_green(run):
    """Relative L2 errors of velocity and pressure (without its mean) at the end, and of the decay rate of the kinetic
    energy over the run, (computed - exact)/exact."""
    parameters, viscosity = run.parameters, run.case["physics"]["viscosity"]
    last = frames(run)[-1]
    velocity, pressure = fields(run, last, "velocity", "pressure")
    exact_velocity, exact_pressure = taylor_green_field(last.position.astype(float), last.time, parameters["U"],
                                                        parameters["L"], viscosity, run.density)
    kinetic = run.curve("energy", "kinetic_J")
    rate = math.log(kinetic.value[0] / kinetic.value[-1]) / kinetic.time[-1]
    exact_rate = 4 * viscosity * (2 * math.pi / parameters["L"]) ** 2
    return {
        "velocity_error": relative_error(velocity[:, :2], exact_velocity),
        "pressure_error": relative_error(pressure - pressure.mean(), exact_pressure),
        "decay_error": rate / exact_rate - 1,
    }


# ---------------------------------------------------------------------------------------------------- standing wave


def wave_root(k, depth, viscosity, gravity):
    """Root s = -decay + i frequency (1/s) of linear waves exp(s t) on viscous water over a free-slip bed:

    (s + 2 nu k^2)^2 + g k tanh(k h) = 4 nu^2 k^3 m tanh(k h) coth(m h), m^2 = k^2 + s/nu

    (Lamb 1932, art. 349, with the bed; to first order decay = 2 nu k^2, frequency^2 = g k tanh(k h))."""
    restoring = gravity * k * math.tanh(k * depth)
    root = complex(-2 * viscosity * k**2, math.sqrt(restoring))
    if viscosity == 0:
        return root
    for _ in range(50):  # each contracts the error by about (nu k^2/omega)^1.5
        m = cmath.sqrt(k**2 + root / viscosity)
        drag = 4 * viscosity**2 * k**3 * m * math.tanh(k * depth) / cmath.tanh(m * depth)
        beat = cmath.sqrt(drag - restoring)
        root = (beat if beat.imag > 0 else -beat) - 2 * viscosity * k**2
    return root


def fit_oscillation(time, value, root, iterations=30):
    """The s nearest to `root` with which offset + Re(C exp(s t)) fits best: Gauss-Newton, linear in offset and C."""
    for _ in range(iterations):
        wave = np.exp(root * time)
        basis = np.stack([np.ones_like(time), wave.real, -wave.imag], axis=1)
        offset, real, imaginary = np.linalg.lstsq(basis, value, rcond=None)[0]
        tangent = complex(real, imaginary) * time * wave  # d/ds of C exp(s t)
        jacobian = np.column_stack([basis, tangent.real, -tangent.imag])
        change = np.linalg.lstsq(jacobian, value - basis @ [offset, real, imaginary], rcond=None)[0]
        root += complex(change[3], change[4])
    return root


def standing_wave(run):
    """The slowest wave of a tank, followed by the centre of mass, which no disorder of particles disturbs.

    period_error, decay_error: (computed - exact)/exact, from the best fit of an offset and a damped oscillation.
    wave_error: rms difference from the exact path of the centre, over its amplitude. lost_per_period: of the wave's
    height."""
    parameters, viscosity = run.parameters, run.case["physics"]["viscosity"]
    length, depth, k = parameters["L"], parameters["depth"], parameters["k"]
    path = [(frame.time, frame.position[:, 0].astype(float).mean()) for frame in frames(run)]
    time, centre = np.array(path).T
    root = wave_root(k, depth, viscosity, run.gravity)
    # The centre of mass moves as -2 a/(k^2 L h) times the elevation; the elevation starts with a omega exp(s t)/Im s.
    amplitude = -2 * parameters["a"] * parameters["omega"] / (k**2 * length * depth * root.imag)
    exact = amplitude * np.exp(root * time).imag
    found = fit_oscillation(time, centre, root)
    return {
        "period_error": root.imag / found.imag - 1,
        "decay_error": found.real / root.real - 1,
        "lost_per_period": 1 - math.exp(2 * math.pi * found.real / found.imag),
        "wave_error": float(np.sqrt(np.mean((centre - centre[0] - exact) ** 2))) / abs(amplitude),
    }


# -------------------------------------------------------------------------------------------------- stretching drop


def drop_axes(times, rate, a, b):
    """[(semi-axis along x, along y, rate of strain)] at rising `times` of an ideal ellipse that starts with `rate`, a,
    b at 0: a' = s a, b' = -s b, s' = s^2 (b^2 - a^2)/(a^2 + b^2) (Monaghan 1994, JCP 110, 399), by Runge-Kutta 4."""
    def slope(state):
        a, b, s = state
        return np.array([s * a, -s * b, s**2 * (b**2 - a**2) / (a**2 + b**2)])

    state, now, states = np.array([a, b, rate], dtype=float), 0.0, []
    for time in times:
        steps = max(1, math.ceil((time - now) * abs(rate) / 1e-3))
        dt = (time - now) / steps
        for _ in range(steps):
            k1 = slope(state)
            k2 = slope(state + 0.5 * dt * k1)
            k3 = slope(state + 0.5 * dt * k2)
            k4 = slope(state + dt * k3)
            state = state + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        now = time
        states.append(state)
    return states


def semi_axes(position):
    """Semi-axes along x and y of the ellipse with the second moments of these particles."""
    return 2 * position[:, :2].astype(float).std(axis=0)


def drop(run):
    """axes_error: largest relative error of a semi-axis over all frames, both started as the particles are.
    velocity_error, pressure_error: relative L2 at the end. energy_error: (end - start)/start of the kinetic energy,
    which an ideal drop keeps."""
    series = frames(run)
    start, last = semi_axes(series[0].position), series[-1]
    exact = drop_axes([frame.time for frame in series], run.parameters["A"], *start)
    axes = [np.abs(semi_axes(frame.position) / state[:2] - 1).max() for frame, state in zip(series, exact)]
    a, b, s = exact[-1]
    x, y = (last.position.astype(float) - last.position.astype(float).mean(axis=0))[:, :2].T
    velocity, pressure = fields(run, last, "velocity", "pressure")
    centre_pressure = run.density * s**2 * (a * b) ** 2 / (a**2 + b**2)
    kinetic = run.curve("energy", "kinetic_J")
    return {
        "axes_error": float(max(axes)),
        "velocity_error": relative_error(velocity[:, :2], np.stack([s * x, -s * y], axis=1)),
        "pressure_error": relative_error(pressure, centre_pressure * np.maximum(0, 1 - (x / a) ** 2 - (y / b) ** 2)),
        "energy_error": float(kinetic.value[-1] / kinetic.value[0] - 1),
    }


# ----------------------------------------------------------------------------------------- flow between two plates


def poiseuille_profile(y, time, gap, viscosity, force):
    """Speed at the distance y (m) from a plate, at `time` after a body force (m/s^2) begins to act on water at rest."""
    steady = 0.5 * force / viscosity * y * (gap - y)
    k = np.arange(1, 200, 2) * math.pi / gap
    # Terms are below the last by far when (k gap)^2 nu t/gap^2 > 1 with k gap = 600: from t = 3e-6 gap^2/nu on.
    share = np.exp(-viscosity * k**2 * time) * 4 * force / (viscosity * gap * k**3)
    return steady - np.sin(np.multiply.outer(y, k)) @ share


def couette_profile(y, time, gap, viscosity, speed):
    """Speed at the distance y (m) from a plate at rest, at `time` after the other one has begun to move along itself."""
    k = np.arange(1, 400) * math.pi / gap
    # The terms left out are below exp(-(400 pi)^2 nu t/gap^2): nothing from t = 3e-5 gap^2/nu on.
    share = np.exp(-viscosity * k**2 * time) * 2 * speed / (k * gap) * np.cos(k * gap)
    return speed * y / gap + np.sin(np.multiply.outer(y, k)) @ share


def channel_flow(run, profile, scale):
    """profile_error: the largest value over all frames of the rms error of the speed along the plates, over `scale`,
    the rms speed of the steady flow; profile(y, time) is the exact one. steady_error: the same error in the last
    frame. across: largest rms speed across the channel, over `scale`."""
    errors, across = [], []
    for frame in frames(run)[1:]:
        velocity, = fields(run, frame, "velocity")
        errors.append(rms(velocity[:, 0] - profile(frame.position[:, 1].astype(float), frame.time)) / scale)
        across.append(rms(velocity[:, 1]) / scale)
    return {"profile_error": max(errors), "steady_error": errors[-1], "across": max(across)}


def poiseuille_exact(run):
    """(profile(y, time), rms speed of the steady flow) of a run."""
    gap, force, viscosity = run.parameters["L"], run.parameters["G"], run.case["physics"]["viscosity"]
    return (partial(poiseuille_profile, gap=gap, viscosity=viscosity, force=force),
            force * gap**2 / (viscosity * math.sqrt(120)))


def couette_exact(run):
    gap, speed, viscosity = run.parameters["L"], run.parameters["U"], run.case["physics"]["viscosity"]
    return partial(couette_profile, gap=gap, viscosity=viscosity, speed=speed), speed / math.sqrt(3)


def poiseuille(run):
    return channel_flow(run, *poiseuille_exact(run))


def couette(run):
    return channel_flow(run, *couette_exact(run))


# --------------------------------------------------------------------------------- uniform flow down a rough channel


def uniform_flow(run):
    """Errors over the last quarter of the run. depth_error: the depth over that of Manning's formula for the discharge,
    the slope and n, less 1. keulegan_error: the mean speed over that of the logarithmic law, less 1. profile_error: rms
    distance of the particles' speed from the logarithmic law, over its mean, up to half the depth. stress_error: by how
    much the bed's stress differs from that of a steady flow, from the momentum that the water gains or loses."""
    depth, n, slope, ks, shear = (run.parameters[name] for name in ("h", "n", "S", "ks", "ut"))
    last = [frame for frame in frames(run) if frame.time >= 0.75 * run.case["time"]["end"]]
    law = 1 / 0.41
    means, errors = [], []
    for frame in last:
        velocity, = fields(run, frame, "velocity")
        y = frame.position[:, 1].astype(float)
        means.append(float(velocity[:, 0].mean()))
        low = y < 0.5 * depth
        errors.append(rms(velocity[low, 0] - shear * law * np.log1p(30 * y[low] / ks)))
    mean = float(np.mean(means))
    logarithmic = shear * law * ((1 + ks / 30 / depth) * math.log1p(30 * depth / ks) - 1)
    gain = float(np.polyfit([frame.time for frame in last], means, 1)[0])
    return {"depth_error": depth / (mean * depth * n / math.sqrt(slope)) ** 0.6 - 1, "keulegan_error": mean / logarithmic - 1,
            "profile_error": float(np.mean(errors)) / logarithmic, "stress_error": -gain * depth / shear**2}


# ------------------------------------------------------------------------------------------------ a jet on a plate


# A block with free sides and any length meets a wall all at once (Cooker & Peregrine 1995): the impulse P of the
# pressure obeys Laplace's equation, P = 0 on the sides, dP/dy = -rho U on the wall. In the middle of the wall it is
# 4 G/pi^2 rho U b, with Catalan's constant G.
JET_IMPULSE = 4 * 0.915965594 / math.pi**2


def jet_pressure(x):
    """Pressure over rho U^2/2 on a plate that a plane jet of thickness 1 meets at right angles, at the distance x from
    its middle: free-streamline theory (Milne-Thomson, Theoretical Hydrodynamics, sec. 11.42), with the speed s over U
    along the plate: x = 2/pi (artanh s + arctan s)."""
    s = 1 - np.logspace(-9, 0, 4000)[::-1]
    return np.interp(np.abs(x), 2 / math.pi * (np.arctanh(s) + np.arctan(s)), 1 - s**2)


def jet(run):
    """All over rho U^2/2, for the mean pressure from 5 to 8 b/U. pressure_error: rms distance from theory over the gauges.
    stagnation_error: in the middle. noise: largest rms about its mean of a gauge. impulse_error: of the impulse of first
    contact per area in the middle, which the first step takes, over JET_IMPULSE rho U b, less 1."""
    b, U = run.parameters["b"], run.parameters["U"]
    stagnation = 0.5 * run.case["physics"]["density"] * U**2
    errors, noise = [], []
    for probe in run.case["probe"]:
        if probe["type"] != "wall-pressure":
            continue
        pressure = run.curve(probe["name"], "pressure_Pa").window(5 * b / U, 8 * b / U).value / stagnation
        errors.append(float(pressure.mean() - jet_pressure(probe["at"][0] / b)))
        noise.append(float(pressure.std()))
    middle = run.curve(run.case["probe"][0]["name"], "pressure_Pa")
    impulse = float(middle.value[1] * (middle.time[1] - middle.time[0]))  # the pressure of a step stands at its end
    return {"pressure_error": rms(errors), "stagnation_error": errors[0], "noise": max(noise),
            "impulse_error": impulse / (JET_IMPULSE * run.case["physics"]["density"] * U * b) - 1}


# ------------------------------------------------------------------------------------------------ a jet out of a slot


def slot_contraction(share):
    """Width of the jet far from a slot over the width of the slot. The slot is the fraction `share` of the width of
    a channel that meets it at right angles (von Mises R. (1917), Berechnung von Ausfluss- und Ueberfallzahlen, Z.
    VDI 61). For a wide channel it is pi/(pi + 2)."""
    def excess(contraction):
        k = contraction * share  # speed in the channel over that of the jet
        return contraction * (1 + 2 / math.pi * (1 / k - k) * math.atan(k)) - 1

    return flume.solve(excess, 1e-9, 1.0)


def slot(run):
    """Means over the last quarter of the run. contraction_error: of the discharge of the piston over the speed of the
    jet, from 2.5 to 4 half slots behind the slot, and the slot, over theory, less 1. thickness_error: likewise, of the
    volume of the jet over its length. pressure_error: before the slot, over that of the jet's speed, less 1."""
    a, B, V, end = run.parameters["a"], run.parameters["B"], run.parameters["V"], run.case["time"]["end"]
    speeds, counts = [], []
    for frame in frames(run):
        if frame.time < 0.75 * end:
            continue
        velocity, = fields(run, frame, "velocity")
        x = frame.position[:, 0].astype(float)
        inside = (x > 2.5 * a) & (x < 4 * a)
        speeds.append(float(velocity[inside, 0].mean()))
        counts.append(int(inside.sum()))
    speed, theory = float(np.mean(speeds)), slot_contraction(a / B)
    pressure = run.curve("channel", "pressure_Pa").window(0.75 * end, end)
    mean = float(np.trapz(pressure.value, pressure.time) / (pressure.time[-1] - pressure.time[0]))
    return {"contraction_error": V * B / (speed * a * theory) - 1,
            "thickness_error": float(np.mean(counts)) * run.spacing**2 / (1.5 * a * a * theory) - 1,
            "pressure_error": mean / (0.5 * run.density * (speed**2 - V**2)) - 1, "contraction": V * B / (speed * a)}


# ---------------------------------------------------------------------------------------- a wedge of water on a wall


ROOT = 2.4  # U t; beyond it the pressure falls from its peak to that of a thin jet within half a U t
WEDGE_PRESSURE = Path(__file__).resolve().parents[2] / "cases/verification/data/water_wedge.csv"


def water_wedge(run):
    """Over the last fifth of the run, when the wedge has gone nearly D; theory is self-similar (water_wedge.py).
    middle_error: pressure in the middle, relative. pressure_error: rms over the gauges up to ROOT, over that in the middle.
    force_error: of the force per length, relative."""
    D, U = run.parameters["D"], run.parameters["U"]
    scale = run.density * U**2
    theory = read_table(WEDGE_PRESSURE)
    x, pressure = theory["x_over_Ut"], theory["pressure"]

    def late(name, column):
        return run.curve(name, column).window(0.8 * D / U, D / U)

    errors = []
    for probe in run.case["probe"]:
        if probe["type"] == "wall-pressure":
            found = late(probe["name"], "pressure_Pa")
            place = probe["at"][0] / (U * found.time)
            if place[0] < ROOT:
                errors.append(float(np.mean(found.value / scale - np.interp(place, x, pressure))))
    force = late("force", "force_y_N_per_m")
    exact = 2 * float(np.trapz(pressure, x))
    return {"middle_error": errors[0] / pressure[0], "pressure_error": rms(errors) / pressure[0],
            "force_error": float(np.mean(-force.value / (scale * U * force.time))) / exact - 1}


# ------------------------------------------------------------------------------------------ a wedge that enters water


# Force over rho V^3 t on a wedge whose faces rise at 30 degrees (Zhao R., Faltinsen O. (1993), Water entry of
# two-dimensional bodies, J. Fluid Mech. 246, 593-612; similarity solution after Dobrovol'skaya).
ENTRY_FORCE = 14.139


def wedge_entry(run):
    """force_error: mean force per length of the second half of the run, over that of the similarity solution, less 1."""
    D, V = run.parameters["D"], run.parameters["V"]
    force = run.curve("force", "force_y_N_per_m").window(0.5 * D / V, D / V)
    impulse = float(np.trapz(force.value, force.time))
    exact = ENTRY_FORCE * run.density * V**3 * (force.time[-1] ** 2 - force.time[0] ** 2) / 2
    return {"force_error": impulse / exact - 1}


FLOWS = {"tank": tank, "taylor-green": taylor_green, "standing-wave": standing_wave, "drop": drop,
         "poiseuille": poiseuille, "couette": couette, "uniform-flow": uniform_flow, "jet": jet, "slot": slot,
         "water-wedge": water_wedge, "wedge-entry": wedge_entry,
         "beji-battjes": beji_battjes.beji_battjes, **shallow_water.FLOWS, **flume.FLOWS, **openings.FLOWS, **thick_flows.FLOWS,
         **two_liquids.FLOWS}
