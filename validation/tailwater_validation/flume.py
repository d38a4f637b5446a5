"""Flows in a flume against the formulas of hydraulics: runs of cases/flume.

Each function takes a Run and returns its numbers by name; all are relative unless the name ends in a unit. They
throw DataError where the run lacks the data that they need.
"""

import math
from functools import lru_cache

import numpy as np

from tailwater.errors import DataError
from tailwater.waves import crest, solitary

from . import potential_wave
from .floating import floating_box
from .potential_gate import contraction
from .profiles import profile_at, profile_table, rms
from .wave_flume import irregular_waves, wave_flume

STEADY = 0.5  # fraction of the run after which the flow counts as steady
SURFACE_TENSION_HEAD = 0.0011  # m, Rehbock's, of surface tension and viscosity


def steady(run, probe, column):
    """The curve of a column of a probe from STEADY on."""
    curve = run.curve(probe, column)
    end = run.case["time"]["end"]
    inside = curve.window(STEADY * end, end)
    if inside.time.size < 2 or curve.time[-1] < 0.98 * end:
        raise DataError(f"{run.path}: its probe '{probe}' ends at {curve.time[-1]:.4g} s, the run at {end:.4g} s")
    return inside


def steady_mean(run, probe, column):
    return float(steady(run, probe, column).value.mean())


def steady_discharge(run, probe):
    """Mean of a discharge probe, from the volume that has passed: exact also where the flow bends."""
    volume = steady(run, probe, "volume_m3")
    return float((volume.value[-1] - volume.value[0]) / (volume.time[-1] - volume.time[0]))


def drift(run, probe, column):
    """The mean of the last quarter less that of the quarter before."""
    curve = run.curve(probe, column)
    end = run.case["time"]["end"]
    before, after = curve.window(0.5 * end, 0.75 * end), curve.window(0.75 * end, end)
    return float(after.value.mean() - before.value.mean())


def solve(function, low, high):
    """Where a function that rises from `low` to `high` is zero, by bisection."""
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if function(middle) < 0 else (low, middle)
    return 0.5 * (low + high)


def rehbock(head, height, added=SURFACE_TENSION_HEAD):
    """Discharge per width (m^2/s) over a thin weir `height` (m) high: Rehbock T. (1929), Discussion of "Precise weir
    measurements", Trans. ASCE 93, 1143-1162. Water without surface tension and viscosity has no head `added` (m)."""
    effective = head + added
    return (1.782 + 0.24 * effective / height) * effective**1.5


def weir(run):
    """coefficient_error: discharge over what Rehbock has for the head upstream, less 1. ideal_error: the same for
    water without surface tension. head_error: the head over what he has for the discharge, less 1."""
    height = run.parameters["P"]
    discharge = steady_discharge(run, "over_crest")
    head = steady_mean(run, "upstream", "connected_m") - height
    expected = solve(lambda h: rehbock(h, height) - discharge, 0.0, 10.0 * head)
    return {"coefficient_error": discharge / rehbock(head, height) - 1,
            "ideal_error": discharge / rehbock(head, height, 0.0) - 1, "head_error": head / expected - 1,
            "head_m": head, "discharge_m2_s": discharge, "head_drift_m": drift(run, "upstream", "connected_m")}


def flow_over_crest(run):
    """(discharge (m^2/s), depth upstream (m), energy head over the crest (m)) of steady flow over a weir P high."""
    discharge = steady_discharge(run, "over_crest")
    depth = steady_mean(run, "upstream", "connected_m")
    return discharge, depth, depth - run.parameters["P"] + discharge**2 / (2 * run.gravity * depth**2)


# Discharge over that of critical flow on the crest of cases/flume/broad_weir.toml, by potential_weir.py: the streamlines
# bend.
BROAD_WEIR_COEFFICIENT = 0.9835


def broad_weir(run):
    """coefficient_error: discharge over that of critical flow on the crest, sqrt(g) (2 H/3)^1.5 with the energy head H
    upstream, less 1. potential_error: over that of potential flow, less 1."""
    discharge, depth, head = flow_over_crest(run)
    g = run.gravity
    coefficient = discharge / (g**0.5 * (2 * head / 3) ** 1.5)
    return {"coefficient_error": coefficient - 1, "potential_error": coefficient / BROAD_WEIR_COEFFICIENT - 1,
            "head_m": depth - run.parameters["P"],
            "discharge_m2_s": discharge, "crest_over_critical": steady_mean(run, "crest", "connected_m")
            / (discharge**2 / g) ** (1 / 3), "head_drift_m": drift(run, "upstream", "connected_m")}


# m^(1/2)/s; q = 2.18 H^1.5 at the design head, for a crest twice as high: 3.95 ft^(1/2)/s (U.S. Bureau of Reclamation,
# Design of Small Dams). Laboratories and manuals have 2.17 to 2.23.
OGEE_COEFFICIENT = 2.18
# Discharge coefficient by potential_crest.py for the crest of cases/flume/ogee.toml as its gauge reads H; 2.2238 for
# the true one, since the water at the surface is faster there than the mean.
OGEE_POTENTIAL_COEFFICIENT = 2.2386


def ogee(run):
    """coefficient_error: discharge over that of the crest for the energy head upstream, less 1. potential_error: over that of
    potential flow, less 1."""
    discharge, _, head = flow_over_crest(run)
    coefficient = discharge / head**1.5
    return {"coefficient_error": coefficient / OGEE_COEFFICIENT - 1,
            "potential_error": coefficient / OGEE_POTENTIAL_COEFFICIENT - 1, "energy_head_m": head,
            "discharge_m2_s": discharge, "head_drift_m": drift(run, "upstream", "connected_m")}


def sluice_gate(run):
    """contraction_error: depth of the jet over that of potential flow, less 1. discharge_error: discharge over that of the
    energy equation with the depths that were read, less 1."""
    opening, g = run.parameters["a"], run.gravity
    upstream = steady_mean(run, "upstream", "connected_m")
    jet = steady_mean(run, "jet", "connected_m")
    discharge = steady_discharge(run, "discharge")
    without_losses = jet * upstream * (2 * g / (jet + upstream)) ** 0.5
    return {"contraction_error": jet / (contraction(opening / upstream) * opening) - 1,
            "discharge_error": discharge / without_losses - 1,
            "upstream_m": upstream, "jet_m": jet, "upstream_drift_m": drift(run, "upstream", "connected_m")}


def uneven_momentum(run, probe):
    """Flux of momentum over the density (m^3/s^2) through a velocity profile beyond that of even flow of the same depth
    and discharge, the integral of u^2 less q^2/h. It is the same for an observer that moves."""
    columns = profile_table(run, probe)
    depth, discharge, squares = [], [], []
    for time in np.unique(columns["time_s"][columns["time_s"] >= STEADY * run.case["time"]["end"]]):
        rows = columns["time_s"] == time
        height, u, h = (columns[name][rows] for name in ("height_m", "u_m_s", "depth_m"))
        edges = np.append(0.5 * (height[1:] + height[:-1]), h[0])
        thickness = np.diff(edges, prepend=0.0)
        depth.append(h[0])
        discharge.append(thickness @ u)
        squares.append(thickness @ u**2)
    if not depth:
        raise DataError(f"{run.path}: its probe '{probe}' has no reading of the steady flow")
    return float(np.mean(squares) - np.mean(discharge) ** 2 / np.mean(depth))


def hydraulic_jump(run):
    """conjugate_error: depth behind the jump over Belanger's for the depth and the speed before it, both seen from the
    jump, which may wander, less 1. momentum_error: the same over the depth that momentum asks for if the flow behind it
    is as uneven as it is. wander_m_s: the jump's speed. momentum_coefficient: h/q^2 times the integral of u^2 behind it."""
    g = run.gravity
    before = steady_mean(run, "before", "connected_m")
    behind = steady_mean(run, "behind", "connected_m")
    discharge = run.parameters["q"]
    times = [t for t in np.unique(profile_table(run, "surface")["time_s"]) if t >= STEADY * run.case["time"]["end"]]
    if len(times) < 3:
        raise DataError(f"{run.path}: has {len(times)} profiles of the steady flow, too few for the jump's speed")
    profiles = [profile_at(run, "surface", time) for time in times]
    places = [p.x[np.flatnonzero(p.connected > 0.5 * (before + behind))[0]] for p in profiles]
    speed = float(np.polyfit(times, places, 1)[0])
    passing = discharge - speed * before
    froude = passing / before / (g * before) ** 0.5
    conjugate = 0.5 * before * ((1 + 8 * froude**2) ** 0.5 - 1)
    uneven = uneven_momentum(run, "velocity_behind")
    critical = (passing**2 / g) ** (1 / 3)
    specific_force = 0.5 * g * before**2 + passing**2 / before - uneven
    with_profile = solve(lambda h: 0.5 * g * h**2 + passing**2 / h - specific_force, critical, 2 * conjugate)
    return {"conjugate_error": behind / conjugate - 1, "momentum_error": behind / with_profile - 1,
            "momentum_coefficient": 1 + uneven * behind / (discharge + speed * (behind - before)) ** 2,
            "before_m": before, "behind_m": behind, "froude": froude, "wander_m_s": speed}


def channel(run):
    """discharge_error: of the mean in the middle. level_error_dx: the largest of both gauges."""
    depth = run.parameters["H"]
    levels = [steady_mean(run, name, "connected_m") for name in ("depth_upstream", "depth_downstream")]
    return {"discharge_error": steady_discharge(run, "discharge") / run.parameters["q"] - 1,
            "level_error_dx": max(abs(level - depth) for level in levels) / run.spacing}


def side_wall_slope(speed, width, roughness, viscosity, g):
    """Slope of the energy line that the friction of a channel's side walls takes, for the law of docs/theory/friction.md."""
    def speed_with(shear):
        zero_height, half = 0.11 * viscosity / shear + roughness / 30, 0.5 * width
        return shear / 0.41 * ((1 + zero_height / half) * math.log1p(half / zero_height) - 1)

    shear = solve(lambda u: speed_with(u) - speed, 1e-3 * speed, speed)
    return 2 * shear**2 / (g * width)


def backwater_curve(depth, distance, discharge, slope, friction, g, steps=100):
    """Depth at `distance` (m) upstream of `depth` (m): dh/dx = (S - friction(u))/(1 - F^2), by the midpoint rule."""
    def rise(h):
        return (slope - friction(discharge / h)) / (1 - discharge**2 / (g * h**3))

    step = distance / steps
    for _ in range(steps):
        depth -= step * rise(depth - 0.5 * step * rise(depth))
    return depth


def backwater(run):
    """level_error_dx: largest error of the depth at three gauges against the backwater curve that the tailwater, the
    discharge and the side walls ask for. discharge_error: of the mean in the middle."""
    physics = run.case["physics"]
    length, slope, tailwater, discharge = (run.parameters[name] for name in ("L", "S", "H", "q"))
    walls = (physics["channel_width"], physics["channel_roughness"], physics["viscosity"], run.gravity)
    found, errors = {}, []
    for name, upstream_of_outlet in (("upstream", 5 / 6), ("middle", 1 / 2), ("downstream", 1 / 6)):
        found[f"{name}_m"] = steady_mean(run, name, "connected_m")
        curve = backwater_curve(tailwater, upstream_of_outlet * length, discharge, slope,
                                lambda speed: side_wall_slope(speed, *walls), run.gravity)
        errors.append((found[f"{name}_m"] - curve) / run.spacing)
    return {"level_error_dx": max(map(abs, errors)), "discharge_error": steady_discharge(run, "discharge") / discharge - 1,
            **found, "upstream_drift_m": drift(run, "upstream", "connected_m")}


def circulation(run):
    """channel's numbers; lost_particles: of start and sump, neither inside nor in the sump at the end. discharge_drift,
    level_drift_dx: of the last quarter from the one before."""
    balance = run.summary["water_balance"]
    inlet, = run.case["inlet"]
    there = balance["start"]["particles"] + round(inlet["reserve"] / run.spacing**run.dimension)
    kept = sum(balance[place]["particles"] for place in ("inside", "outside")) + balance["outlets"][0]["waiting"]["particles"]
    volume = run.curve("discharge", "volume_m3")
    quarters = np.interp(np.array([0.5, 0.75, 1.0]) * volume.time[-1], volume.time, volume.value)
    before, after = np.diff(quarters) / (0.25 * volume.time[-1])
    drifts = [drift(run, name, "connected_m") for name in ("depth_upstream", "depth_downstream")]
    return channel(run) | {"lost_particles": there - kept, "discharge_drift": float(after / before - 1),
                           "level_drift_dx": max(drifts, key=abs) / run.spacing,
                           "steps_short_of_water": balance["inlets"][0]["steps_short_of_water"]}


def run_up(run):
    """run_up_error: largest height of connected water on the beach over Synolakis's law for the wave that the gauge saw,
    less 1. Heights are above the probe's own reading of the still water, whose tip is thinner than a particle.

    Synolakis C.E. (1987), The runup of solitary waves, J. Fluid Mech. 185, 523-545."""
    depth = run.parameters["h"]
    _, height = crest(run.curve("gauge", "highest_m"))
    beach = run.curve("beach", "connected_m")
    highest = int(np.argmax(beach.value))
    if highest > 0.98 * beach.value.size:
        raise DataError(f"{run.path}: the water still runs up when the run ends, at {beach.time[-1]:.4g} s")
    law = 2.831 * run.parameters["cot"] ** 0.5 * (height / depth) ** 1.25
    reached = float(beach.value[highest] - beach.value[0]) / depth
    return {"run_up_error": reached / law - 1, "run_up_over_depth": reached, "law_over_depth": float(law),
            "height_error": float(height / run.parameters["H"] - 1)}


WALL_WINDOW = 3.0  # sqrt(h/g) to each side of the largest force
GAUGE_HEIGHTS = {"p1": 0.25, "p2": 0.75}  # h above the bed


@lru_cache(maxsize=None)
def wall_history(height):
    return potential_wave.at_wall(height, tuple(GAUGE_HEIGHTS.values()))


def wall_load_errors(run, height):
    """Errors of the force on the wall that a solitary wave of this height (h) meets, and of the pressures there."""
    depth = run.parameters["h"]
    scale, weight = math.sqrt(depth / run.gravity), run.density * run.gravity
    exact = wall_history(height)
    force = run.curve("force", "force_x_N_per_m")
    load = force.value / (weight * depth**2) - 0.5
    peak, exact_peak = load.max(), exact.force.max()
    time = (force.time - force.time[int(np.argmax(load))]) / scale + exact.time[int(np.argmax(exact.force))]
    near = np.abs(time) < WALL_WINDOW
    pressures = [abs((run.curve(name, "pressure_Pa").value.max() / weight / depth - (1 - z)) / exact.pressure[z].max() - 1)
                 for name, z in GAUGE_HEIGHTS.items()]
    return {"force_error": peak / exact_peak - 1, "pressure_error": max(pressures),
            "force_rms": rms(load[near] - np.interp(time[near], exact.time, exact.force)) / exact_peak}


def solitary_wave(run):
    """speed_error: over Fenton's third order for the mean height at the gauges, less 1. wall_error: largest height of
    connected water on the wall at the end of the channel, above the still water, over that of the third order of Su &
    Mirie for the height at the last gauge, less 1. height_lost: fraction of the wave's height from the first gauge to
    the last.

    The force on that wall and the pressures p1 and p2, less those at rest, are compared with potential flow for that
    height (potential_wave.py): force_error and pressure_error, of the largest values (of p1 or p2, whichever is worse),
    relative; force_rms, over WALL_WINDOW about the largest force, over the largest.

    Su C.H., Mirie R.M. (1980), On head-on collisions between two solitary waves, J. Fluid Mech. 98, 509-525; a wall is the
    plane of symmetry between equal waves."""
    found = solitary(run)
    heights = [gauge["height_m"] for gauge in found["gauges"].values()]
    depth = run.parameters["h"]
    e = heights[-1] / depth
    wall = run.curve("wall", "connected_m")
    reached = float(wall.value.max() - wall.value[0]) / depth
    if int(np.argmax(wall.value)) > 0.98 * wall.value.size:
        raise DataError(f"{run.path}: the water still rises at the wall when the run ends, at {wall.time[-1]:.4g} s")
    return {"speed_error": found["difference"], "wall_error": reached / (2 * e + e**2 / 2 + 3 * e**3 / 4) - 1,
            **wall_load_errors(run, round(e, 4)),
            "height_lost": 1 - heights[-1] / heights[0], "height_error": heights[0] / run.parameters["H"] - 1}


FLOWS = {"weir": weir, "broad-weir": broad_weir, "ogee": ogee, "sluice-gate": sluice_gate, "hydraulic-jump": hydraulic_jump,
         "channel": channel, "backwater": backwater, "circulation": circulation, "run-up": run_up, "solitary-wave": solitary_wave, "wave-flume": wave_flume,
         "irregular-waves": irregular_waves, "floating-box": floating_box}
