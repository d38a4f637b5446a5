"""Flows whose solution is known: errors by spacing, observed orders."""

from functools import partial
from pathlib import Path

import numpy as np

from .. import exact_flows, panels
from ..metric import Metric
from ..reading import exact, signed
from ..study import EXACT, OrderCheck, Plot, Study


def error_checks(name, flow, runs, quantities):
    """Error of each quantity (key, words, unit, target) on the last run, and its observed order."""
    return tuple(OrderCheck(Metric(f"{name}.{key}", words, unit, "exact solution", high=high), runs, partial(exact, flow, key),
                            interval_of=partial(signed, flow, key))
                 for key, words, unit, high in quantities)


def draw_errors(flow, quantities, *runs):
    return panels.convergence({words: {run.spacing: exact(flow, key, run) for run in runs}
                               for key, words, _, _ in quantities}, "error, relative")


def runs_by_rows(plan, case, length, seconds, rows):
    """The runs of a case with `rows` particles over a length (a parameter or number of the case). `seconds` is the CPU time of
    one run, the rows that it had, and the power with which the time grows with the rows."""
    known_seconds, known_rows, power = seconds
    name = Path(case).stem
    return tuple(plan.run(f"{name}_n{n}", case, (f"particles.spacing={length}/{n}",),
                          known_seconds * (n / known_rows) ** power) for n in rows)


def flow_study(name, title, flow, about, uncertainty, runs, quantities, moments, more_plots=(), has_histories=True):
    """A study of one flow at several spacings, the finest last; its errors are plotted."""
    return Study(name, title, EXACT, about, uncertainty, error_checks(name, flow, runs, quantities),
                 (Plot("Errors by spacing, with observed orders.", runs, partial(draw_errors, flow, quantities)),
                  *more_plots), shown=runs[-1], moments=moments, has_histories=has_histories)


EXACTLY = "The solution is exact, so the number is the error of the discretisation; round-off is far smaller."


def taylor_green(plan):
    runs = tuple(plan.run(f"taylor_green_dx{dx:g}", "robustness/taylor_green.toml", (f"particles.spacing={dx:g}",),
                          0.4 * (0.04 / dx) ** 3.4)
                 for dx in plan.at((0.04, 0.02, 0.01), (0.04, 0.02, 0.01), (0.04, 0.02, 0.01, 0.005)))
    return flow_study(
        "taylor-green", "Decaying Taylor-Green vortices, Re = 100", "taylor-green",
        "Four vortices in a periodic box decay by viscosity, from particles displaced at random by up to 0.1 dx. Velocity and "
        "pressure against the exact Navier-Stokes solution at t = L/U, decay rate of the kinetic energy over the run.",
        EXACTLY, runs, (("decay_error", "decay rate of the energy, relative error", "", 0.02),
                        ("velocity_error", "velocity at t = L/U, relative L2 error", "", None),
                        ("pressure_error", "pressure at t = L/U, relative L2 error", "", None)), (0.2, 1.0))


def standing_wave(plan):
    runs = tuple(plan.run(f"standing_wave_dx{dx:g}", "robustness/standing_wave.toml", (f"particles.spacing={dx:g}",),
                          1.5 * (0.05 / dx) ** 3.2)
                 for dx in plan.at((0.05, 0.025, 0.016666667), (0.05, 0.025, 0.0125), (0.05, 0.025, 0.0125, 0.00625)))
    return flow_study(
        "standing-wave", "Standing wave with viscous decay", "standing-wave",
        "The slowest wave of a tank 1 m long and 0.5 m deep, amplitude a = 0.05/k, five periods. Period and decay of the centre "
        "of mass against linear theory with viscosity (Lamb 1932), whose root is solved exactly.",
        "Linear theory leaves out terms of order (k a)^2 = 0.25 %; they change the period of a standing wave by about 1/8 of that.", runs,
        (("period_error", "period, relative error", "", 0.005), ("decay_error", "decay, relative error", "", 0.05),
         ("wave_error", "whole curve, rms error over the amplitude", "", None)), ())


def drop(plan):
    runs = tuple(plan.run(f"drop_dx{dx:g}", "robustness/drop.toml", (f"particles.spacing={dx:g}", "time.end=2.5/A",
                                                                    "output.fields_interval=0.25/A"),
                          0.5 * (0.1 / dx) ** 3.2)
                 for dx in plan.at((0.1, 0.05, 0.025), (0.1, 0.05, 0.025), (0.05, 0.025, 0.0125)))
    return flow_study(
        "drop", "Stretching elliptical drop", "drop",
        "A round drop without gravity in u = (A x, -A y) becomes an ellipse whose axes obey an ordinary differential equation "
        "(Monaghan 1994), to t = 2.5/A. No dissipation: its energy should not change.",
        EXACTLY, runs, (("axes_error", "semi-axes, largest relative error over the run", "", 0.005),
                        ("energy_error", "kinetic energy at the end, relative error", "", None),
                        ("velocity_error", "velocity at the end, relative L2 error", "", None),
                        ("pressure_error", "pressure at the end, relative L2 error", "", None)), (0.0, 1.0, 2.5))


def tank(plan):
    runs = tuple(plan.run(f"tank_dx{dx:g}", "tank/case.toml",
                          (f"particles.spacing={dx:g}", "particles.jitter=0.2", "time.end=10",
                           "output.fields_interval=1.0"), 1.5 * (0.05 / dx) ** 3.2)
                 for dx in plan.at((0.05, 0.025), (0.05, 0.025, 0.02), (0.05, 0.025, 0.0125)))
    quantities = (("pressure_error", "pressure at t = 10 s, rms error over rho g H", "", 3e-3),
                  ("u_rms", "speed from 5 s on, largest rms over sqrt(g H)", "", 3e-4),
                  ("level_error_dx", "level, largest error", "dx", 0.25),
                  ("bottom_density", "density error within 4 dx of the bottom", "", 2e-3))
    return flow_study(
        "tank", "Water at rest from disordered particles", "tank",
        "A tank of 1 m x 0.5 m starts with particles displaced at random by up to 0.2 dx and should come to rest: hydrostatic "
        "pressure, no motion, no compression.", EXACTLY, runs, quantities, (10.0,))


def draw_channel(exact_of, *runs):
    """Speeds of the particles across the channel at several times, with the exact series."""
    def of(run):
        profile, _ = exact_of(run)
        y = np.linspace(0, run.parameters["L"], 200)
        for frame in exact_flows.frames(run)[1::3]:
            velocity, = exact_flows.fields(run, frame, "velocity")
            yield panels.curve(f"t = {frame.time:.1f} s", frame.position[:, 1], velocity[:, 0], "particles")
            yield panels.curve("series", y, profile(y, frame.time), "exact")

    return [panels.panel(f"dx = {run.spacing:g} m", "y (m)", "speed (m/s)", of(run)) for run in runs]


def channel_study(plan, name, title, about, exact_of):
    runs = tuple(plan.run(f"{name}_dx{dx:g}", f"verification/{name}.toml", (f"particles.spacing={dx:g}",),
                          1.5 * (0.05 / dx) ** 3.6)
                 for dx in plan.at((0.1, 0.05), (0.1, 0.05, 0.025), (0.1, 0.05, 0.025)))
    return flow_study(
        name, title, name, f"{about} Re = 20, particles displaced at random by up to 0.1 dx, speeds at ten instants against the series "
        "solution. No slip is a wall law for any Reynolds number: here it must give the laminar limit.", EXACTLY, runs,
        (("profile_error", "speed, largest rms error of ten instants over the rms speed", "", 0.01),
         ("across", "speed across the channel, rms over the rms speed, largest", "", None)), (),
        (Plot("Speeds of the particles (dots) over the series.", runs, partial(draw_channel, exact_of)),),
        has_histories=False)


def poiseuille(plan):
    return channel_study(plan, "poiseuille", "Poiseuille flow from rest",
                         "Water between two no-slip plates 1 m apart is set in motion by a body force.",
                         exact_flows.poiseuille_exact)


def couette(plan):
    return channel_study(plan, "couette", "Couette flow from rest",
                         "Water between two no-slip plates 1 m apart is set in motion by one of them, which moves along itself.",
                         exact_flows.couette_exact)


def uniform_flow(plan):
    runs = tuple(plan.run(f"uniform_flow_dx{dx:g}", "verification/uniform_flow.toml", (f"particles.spacing={dx:g}",),
                          10 * (0.01 / dx) ** 3)
                 for dx in plan.at((0.01,), (0.01, 0.005), (0.01, 0.005, 0.0025)))
    return flow_study(
        "uniform-flow", "Uniform flow down a rough channel", "uniform-flow",
        "Water 0.1 m deep on a slope of 0.002, Manning's n = 0.012, periodic along the channel, for 14 h/u_tau; the eddy viscosity "
        "grows from the bed. Depth against Manning's formula for the discharge, speeds against the logarithmic law.",
        "Manning's formula and the logarithmic law (Keulegan 1938) differ by 1.8 % in speed, 1.1 % in depth, at this roughness "
        "(h/k_s = 125), and measured channels scatter by more.", runs,
        (("depth_error", "depth against Manning's formula", "", 0.02),
         ("keulegan_error", "mean speed against the logarithmic law", "", None),
         ("profile_error", "speeds up to half the depth, rms distance from the logarithmic law", "", None),
         ("stress_error", "stress of the bed against that of a steady flow", "", None)), (), has_histories=False)


def jet(plan):
    runs = tuple(plan.run(f"jet_dx{dx:g}", "verification/jet.toml", (f"particles.spacing={dx:g}",), 20 * (0.005 / dx) ** 3)
                 for dx in plan.at((0.02, 0.01), (0.01, 0.005), (0.01, 0.005, 0.0025)))
    return flow_study(
        "jet", "Plane jet on a plate", "jet",
        "A jet 0.1 m thick meets a plate at right angles at 2 m/s, without gravity. Pressure on the plate against free-streamline "
        "theory, mean from 5 to 8 b/U, over the stagnation pressure; impulse of the first contact against that of a block that "
        "stops at once.", EXACTLY, runs,
        (("pressure_error", "pressure along the plate, rms error", "", 0.03),
         ("stagnation_error", "stagnation pressure, error", "", 0.03),
         ("impulse_error", "impulse of first contact, error", "", None),
         ("noise", "largest rms of the pressure about its mean", "", None)), (0.0, 0.3))


def slot(plan):
    runs = tuple(plan.run(f"slot_a{n}", "verification/slot.toml", (f"particles.spacing=a/{n}",), 1.5 * (n / 8) ** 3)
                 for n in plan.at((6, 8), (8, 12, 16), (8, 16, 24)))
    return flow_study(
        "slot", "Jet out of a slot", "slot",
        "A piston pushes water out of a channel 8 a wide through a slot of 2 a between two plates, without gravity: width of the jet "
        "over that of the slot against free-streamline theory, mean over the last quarter of 12 a/U.",
        "Theory (von Mises 1917) is for the jet far from the slot; 2.5 a behind it, where it is read, it is within 0.1 % of that.", runs,
        (("contraction_error", "width of the jet, from its speed, relative error", "", 0.015),
         ("thickness_error", "the same, from its volume", "", None),
         ("pressure_error", "pressure before the slot for the speed of the jet, relative error", "", None)), (0.0, 1.2))


def wedge_runs(plan, name, counts):
    """Runs of a wedge with these numbers of particles over its path D."""
    return tuple(plan.run(f"{name}_D{n}", f"verification/{name}.toml", (f"particles.spacing=D/{n}",), 2 * (n / 4) ** 3.3)
                 for n in counts)


def water_wedge(plan):
    runs = wedge_runs(plan, "water_wedge", plan.at((8,), (4, 8), (4, 8, 16)))
    return flow_study(
        "water-wedge", "Wedge of water on a wall", "water-wedge",
        "A wedge of water, half-angle 60 degrees, meets a wall at right angles to its axis, without gravity: pressure and force against "
        "self-similar potential flow, when the wedge has gone D; the pressed part of the wall is then 6 D long.",
        "Potential flow by boundary elements, for the height of this wedge; with half the height the pressure in the middle is 2.3 % "
        "lower.", runs,
        (("middle_error", "pressure in the middle, relative error", "", 0.05),
         ("pressure_error", "pressure along the wall, up to the jet's root, rms error over that in the middle", "", 0.05),
         ("force_error", "force, relative error", "", None)), (0.0, 0.05), has_histories=False)


def wedge_entry(plan):
    runs = wedge_runs(plan, "wedge_entry", plan.at((4,), (4, 8), (4, 8, 16)))
    return flow_study(
        "wedge-entry", "Water entry of a wedge", "wedge-entry",
        "A wedge whose faces rise at 30 degrees enters water at rest at an even speed, without gravity. Mean force while it goes from "
        "D/2 to D against the similarity solution of Zhao & Faltinsen (1993).",
        "The solution is for boundless water; this water is 28 D wide and 14 D deep with free sides, and the force falls by 2.4 % when that "
        "is made 20 and 10 D.", runs, (("force_error", "force, relative error", "", 0.1),), (0.0, 0.05), has_histories=False)
