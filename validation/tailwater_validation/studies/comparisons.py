"""The papers' comparisons: one thing changed at a time, the same numbers for each variant."""

from dataclasses import replace
from functools import partial

import numpy as np

from .. import plots
from ..checks import Check
from ..metric import Metric
from ..reading import energy_at, summary, zhou
from ..study import COMPARISON, Plot, Study
from .zhou import draw_depths, draw_pressure, mean_of_readings, zhou_run


def milliseconds(run):
    return 1000 * summary("steps", "dt_mean_s", run)


def passes(run):
    return float(np.mean(run.steps()["passes"]))


# key: (words, unit, how it is read from a run of zhou1999)
QUANTITIES = {
    "H2": ("depth H2, RMS over T = 0..6", "H", partial(mean_of_readings, "rms H2 T 0..6")),
    "H1": ("depth H1, RMS over T = 0..6", "H", partial(mean_of_readings, "rms H1 T 0..6")),
    "pressure": ("wall pressure, z = 0.12 m, RMS over T = 2.4..7, best shift", "rho g H",
                 partial(mean_of_readings, "rms point z = 0.12 m T 2.4..7", field="shifted_value")),
    "noise": ("noise of the wall pressure, z = 0.16 m", "rho g H", partial(zhou, "noise")),
    "front": ("front at the wall", "s", partial(zhou, "arrival_front")),
    "energy": ("energy at T = 8", "of the start", partial(energy_at, 8)),
    "rise": ("largest rise of the energy", "of the start", partial(summary, "energy", "largest_rise_over_start")),
    "density": ("density error, rms", "", partial(summary, "volume", "density_error_rms")),
    "dt": ("time step, mean", "ms", milliseconds),
    "passes": ("passes per step", "", passes),
    "iterations": ("iterations per solve", "", partial(summary, "pressure_solver", "iterations_per_solve")),
    "cost": ("CPU time per simulated second", "s", partial(summary, "cost", "cpu_s_per_simulated_s")),
}
UNCERTAINTY = ("The variants share everything but what is compared. A dam break is chaotic after the impact: what another start of the "
               "same case changes (the study of starts) is the least difference that means anything. The laboratory's own "
               "uncertainty is that of the study zhou1999.")


def spacing(plan):
    return plan.at(0.02, 0.012, 0.008)


def ratio(read, run, other):
    return read(run) / read(other)


def draw_numbers(variants, *runs):
    """Small bars of every quantity; the variants are told by the folders of their runs."""
    names = {run.name: variant for variant, run in variants.items()}
    figure = plots.new_figure(height=0.9 + 3 * (0.42 + 0.15 * len(runs)))
    for k, (axes, (words, unit, read)) in enumerate(zip(figure.subplots(3, 4, sharey=True).flat, QUANTITIES.values())):
        values = [read(run) for run in runs]
        axes.barh(range(len(runs)), values, color=[style["color"] for style in plots.CYCLE[:len(runs)]], height=0.7)
        for row, value in enumerate(values):
            axes.text(0, row, f" {value:.3g}", va="center", fontsize=7.5, color="white",
                      bbox={"facecolor": "#00000088", "edgecolor": "none", "pad": 0.8})
        axes.set_title(words.split(", RMS")[0] + (f" ({unit})" if unit else ""), loc="left", fontsize=8)
        axes.tick_params(labelsize=7, length=0)
        axes.set_xticks([])
        axes.spines[["bottom"]].set_visible(False)
        if k % 4 == 0:
            axes.set_yticks(range(len(runs)), [names[run.path.name] for run in runs], fontsize=8)
    axes.invert_yaxis()
    return figure


def comparison(name, title, about, variants, claims=()):
    """A study of runs of zhou1999, {variant: run}."""
    runs = tuple(variants.values())
    checks = [Check(Metric(f"{name}.{key}.{variant}", words, unit, ""), (run,), read, variant=variant)
              for key, (words, unit, read) in QUANTITIES.items() for variant, run in variants.items()]
    return Study(name, title, COMPARISON, about, UNCERTAINTY, (*claims, *checks),
                 (Plot("The same numbers for each variant; each panel has its own scale.", runs,
                       partial(draw_numbers, variants)),
                  Plot("Pressure on the wall.", runs, draw_pressure), Plot("Water levels.", runs, draw_depths)))


def integrators(plan):
    plan = replace(plan, scheme="")
    dx = spacing(plan)
    explicit, implicit = zhou_run(plan, dx), zhou_run(plan, dx, "implicit")
    both = (implicit, explicit)
    claims = (
        Check(Metric("integrators.dt_ratio", "time step, implicit over explicit", "",
                     "the paper: alpha = 0.12 against 0.05", paper=2.4), both, partial(ratio, milliseconds)),
        Check(Metric("integrators.cost_ratio", "CPU time per simulated second, implicit over explicit", "",
                     "the paper: about twice or more", paper=2.0), both,
              partial(ratio, partial(summary, "cost", "cpu_s_per_simulated_s"))),
        Check(Metric("integrators.passes", "passes per step, implicit", "", "the paper: 8 to 30", paper=8.0, high=3.0),
              (implicit,), passes),
        *(Check(Metric(f"integrators.{key}_ratio", f"{words}: implicit over explicit", "",
                       "the paper's claim: below 1"), both, partial(ratio, read))
          for key, (words, _, read) in QUANTITIES.items() if key in ("H2", "H1", "pressure", "noise")),
    )
    return comparison(
        "integrators", "Explicit against implicit integration", "Farzin et al. claim that the implicit integrator is nearer to the "
        "measured profiles, takes steps about twice as large, needs 8 to 30 iterations and costs about twice as much or more.",
        {"explicit": explicit, "implicit": implicit}, claims)


def devices(plan):
    plan = replace(plan, scheme="")
    dx = spacing(plan)
    no_noise = ("scheme.noise_viscosity=0",)
    return comparison(
        "devices", "With and without artificial viscosity, sub-particle stress and shifting",
        "The default damps only what neighbouring particles do differently from a smooth field. The papers damp speed "
        "(c_a = 0.2), add a sub-particle stress (c_s = 0.10), and shift particles.",
        {"default": zhou_run(plan, dx),
         "no viscosity": zhou_run(plan, dx, variant="inviscid", settings=no_noise),
         "c_a = 0.2 instead": zhou_run(plan, dx, variant="ca0.2",
                                       settings=(*no_noise, "scheme.artificial_viscosity=0.2")),
         "with stress": zhou_run(plan, dx, variant="sps", settings=("scheme.smagorinsky=0.10",)),
         "no shifting": zhou_run(plan, dx, variant="no-shifting", settings=("scheme.shifting=none",))})


def slip(plan):
    plan = replace(plan, scheme="")
    dx = spacing(plan)
    return comparison(
        "slip", "Free slip, partial slip and no slip on walls",
        "No slip is a wall law here (Werner & Wengle 1991): the stress of a smooth wall whether dx resolves the boundary layer or "
        "not. The papers' u = 0 on one layer of particles delays the front far more.",
        {"free": zhou_run(plan, dx),
         "partial (0.5)": zhou_run(plan, dx, variant="partial", settings=("wall[0].slip=partial", "wall[0].friction=0.5")),
         "no slip": zhou_run(plan, dx, variant="no-slip", settings=("wall[0].slip=no-slip",))})


def time_step(plan):
    plan = replace(plan, scheme="")
    dx = spacing(plan)
    return comparison(
        "time-step", "Time step", "The same flow at half the default time step (explicit, courant 0.25), at the default, and near "
        "the limit of stability.",
        {"courant 0.125": zhou_run(plan, dx, variant="courant0.125", settings=("scheme.courant=0.125",)),
         "courant 0.25": zhou_run(plan, dx),
         "courant 0.4": zhou_run(plan, dx, variant="courant0.4", settings=("scheme.courant=0.4",))})


def starts(plan):
    plan = replace(plan, scheme="")
    dx = spacing(plan)
    return comparison(
        "starts", "Starts: how far chance goes", "The same case from the regular lattice and from particles displaced at random. The "
        "scatter is the uncertainty of every single run of this case.",
        {"regular": zhou_run(plan, dx),
         **{f"displaced by {jitter:g} dx": zhou_run(plan, dx, variant=f"jitter{jitter:g}",
                                                   settings=(f"particles.jitter={jitter:g}",))
            for jitter in (0.02, 0.1, 0.15)}})
