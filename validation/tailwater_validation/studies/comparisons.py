"""The papers' comparisons: one thing changed at a time, the same numbers for each variant."""

from dataclasses import replace
from functools import partial

from ..checks import Check
from ..metric import Metric
from ..reading import scored, summary
from ..study import COMPARISON, Plot, Study
from . import janosi2004, soares_frazao2002, zhou1999
from .laboratory import case_run
from .zhou1999 import FREE_SLIP, READ_AT, energy_at, rms, zhou_run


def milliseconds(run):
    return 1000 * summary("steps", "dt_mean_s", run)


# {key: (words, unit, how it is read from a run)}
GENERAL = {
    "rise": ("largest rise of the energy", "of the start", partial(summary, "energy", "largest_rise_over_start")),
    "density": ("density error, rms", "", partial(summary, "volume", "density_error_rms")),
    "dt": ("time step, mean", "ms", milliseconds),
    "iterations": ("iterations per solve", "", partial(summary, "pressure_solver", "iterations_per_solve")),
    "cost": ("CPU time per simulated second", "s", partial(summary, "cost", "cpu_s_per_simulated_s")),
}
ZHOU = {
    "H2": ("depth H2, RMS over T = 0..6", "H", lambda run: rms(run, "H2", (0.0, 6.0))),
    "H1": ("depth H1, RMS over T = 0..6", "H", lambda run: rms(run, "H1", (0.0, 6.0))),
    "pressure": ("wall pressure, z = 0.12 m, RMS over T = 2.4..7, best shift", "rho g H",
                 lambda run: rms(run, READ_AT, field="shifted_value")),
    "noise": ("noise of the wall pressure, z = 0.16 m", "rho g H", zhou1999.wall_noise),
    "front": ("front at the wall", "s", zhou1999.front_arrival),
    "energy": ("energy at T = 8", "of the start", partial(energy_at, 8)),
} | GENERAL
JANOSI = {
    **{f"rms_{instant:g}": (f"surface at t = {instant:g} s, RMS distance", "mm",
                            partial(scored, janosi2004.metrics, f"rms {instant:g}"))
       for instant in janosi2004.INSTANTS if instant >= janosi2004.TARGET_FROM},
} | GENERAL
UNCERTAINTY = ("The variants differ only in what is compared. A dam break is chaotic after the impact: differences smaller than those "
               "between the starts of one case (the study of starts) mean nothing. The laboratory's own uncertainty is that of "
               "the study zhou1999.")


def spacing(plan):
    return plan.at(0.02, 0.012, 0.008)


def ratio(read, run, other):
    return read(run) / read(other)


def comparison(name, title, about, variants, quantities, more_plots=(), claims=()):
    """A study of {variant: run}: each quantity of each variant. `more_plots` are (caption, draw); `draw` takes the
    folders of the runs and their `names`."""
    runs = tuple(variants.values())
    names = {run.name: variant for variant, run in variants.items()}
    checks = [Check(Metric(f"{name}.{key}.{variant}", words, unit, ""), (run,), read, variant=variant)
              for key, (words, unit, read) in quantities.items() for variant, run in variants.items()]
    return Study(name, title, COMPARISON, about, UNCERTAINTY, (*claims, *checks),
                 tuple(Plot(caption, runs, partial(draw, names=names)) for caption, draw in more_plots), names=names)


def zhou_comparison(name, title, about, variants, claims=()):
    return comparison(name, title, about, variants, ZHOU, (("Pressure on the wall.", zhou1999.draw_pressure),
                                                           ("Water levels.", zhou1999.draw_depths)), claims)


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
        *(Check(Metric(f"integrators.{key}_ratio", f"{words}: implicit over explicit", "",
                       "the paper's claim: below 1"), both, partial(ratio, read))
          for key, (words, _, read) in ZHOU.items() if key in ("H2", "H1", "pressure", "noise")),
    )
    return zhou_comparison(
        "integrators", "Explicit against implicit integration", "Farzin et al. claim that the implicit integrator is nearer to the "
        "measured profiles, takes steps about twice as large, needs 8 to 30 iterations and costs about twice as much or more.",
        {"explicit": explicit, "implicit": implicit}, claims)


ACCELERATED_GATE = ('gate=[{name="gate", from=["lock", 0], to=["lock", "h0+6*dx"], thickness="3*dx", '
                    'motion="acceleration", acceleration=30, travel="2*h0"}]')


def wet_bed(plan):
    """Both schemes on the paper's case of a wet bed, and the influence of the gate."""
    plan = replace(plan, scheme="")
    count = plan.at(7, 13, 21)
    run = partial(case_run, plan, "janosi2004", "d", count, 50)
    return comparison(
        "wet-bed", "Explicit against implicit, and the gate, on a wet bed", "Farzin et al. claim that the implicit integrator is nearer to the "
        "surfaces of Janosi et al. and blame the gate for the early differences: it is computed as a wall that rises at 1.5 m/s, as "
        "removed at once, and as evenly accelerated so that it is clear of the water after the same 0.1 s. A gate does work on the water.",
        {"explicit": run(integrator="explicit"), "implicit": run(integrator="implicit"),
         "explicit, no gate": run(integrator="explicit", variant="no-gate", settings=(
             'gate.gate.from=["lock", "3*h0"]', 'gate.gate.to=["lock", "4*h0"]')),  # drawn above the water
         "explicit, gate accelerated": run(integrator="explicit", variant="accelerated",
                                           settings=(ACCELERATED_GATE,))},
        JANOSI)


def schemes(plan):
    plan, two_step = replace(plan, scheme=""), replace(plan, scheme="farmani2020")
    dx = spacing(plan)
    published = ("scheme.formulation=published",)
    return zhou_comparison(
        "schemes", "Scheme F against scheme B", "The projection of Farzin et al. (2014) and the two steps of Farmani et al. (2020), each as "
        "published and in its robust formulation.",
        {"F": zhou_run(plan, dx), "F as published": zhou_run(plan, dx, variant="published", settings=published),
         "B": zhou_run(two_step, dx, ""),
         "B as published": zhou_run(two_step, dx, "", "published", published)})


def sill_time_step(plan):
    """The paper's study of the time step on its own case; surfaces are compared with those for the smallest step."""
    plan = replace(plan, scheme="")
    count = plan.at(8, 11, 16)
    run = partial(case_run, plan, "soares_frazao2002", "h0", count, 40, "explicit")
    variants = {f"courant {courant:g}": run(variant=f"courant{courant:g}", settings=(f"scheme.courant={courant:g}",))
                for courant in (0.5, 0.25, 0.125)}
    reference = variants["courant 0.125"]

    claims = tuple(Check(Metric(f"sill-time-step.{instant:g}.{variant}",
                                f"surface at t = {instant:g} s, RMS distance from that of courant 0.125, {variant}", "mm",
                                "the paper: largest error 21 % with 3 ms, 10.2 % with 1.4 ms"), (run, reference),
                         partial(soares_frazao2002.surface_distance, instant))
                   for instant in soares_frazao2002.INSTANTS for variant, run in variants.items()
                   if run is not reference)
    return comparison("sill-time-step", "Time step on the sill", "Farmani et al. find their scheme sensitive to the time step in the dam break over "
                      "a sill of Soares-Frazao (2002). Here the step is halved and doubled.", variants, GENERAL, (), claims)


def devices(plan):
    plan = replace(plan, scheme="")
    dx = spacing(plan)
    no_noise = ("study.noise_viscosity=0",)
    return zhou_comparison(
        "devices", "With and without artificial viscosity and shifting",
        "The default damps only differences between neighbours that a smooth field does not explain. The papers damp the "
        "velocity itself (c_a = 0.2), and shift particles.",
        {"default": zhou_run(plan, dx),
         "no viscosity": zhou_run(plan, dx, variant="inviscid", settings=no_noise),
         "c_a = 0.2 instead": zhou_run(plan, dx, variant="ca0.2",
                                       settings=(*no_noise, "study.artificial_viscosity=0.2")),
         "no shifting": zhou_run(plan, dx, variant="no-shifting", settings=("study.shifting=0",))})


def slip(plan):
    plan = replace(plan, scheme="")
    dx = spacing(plan)
    return zhou_comparison(
        "slip", "Free slip, partial slip and no slip on walls",
        "No slip is a law of the wall here, with an eddy viscosity: the stress of a smooth wall, whether or not dx resolves the boundary "
        "layer. The papers' u = 0 on one layer of particles delays the front far more.",
        {"free": zhou_run(plan, dx, variant="free-slip", settings=FREE_SLIP),
         "partial (0.5)": zhou_run(plan, dx, variant="partial", settings=("wall[0].slip=partial", "wall[0].friction=0.5")),
         "no slip": zhou_run(plan, dx)})


def time_step(plan):
    plan = replace(plan, scheme="")
    dx = spacing(plan)
    return zhou_comparison(
        "time-step", "Time step", "The same flow at half the default time step (explicit, courant 0.55), at the default, and at "
        "0.6.",
        {"courant 0.275": zhou_run(plan, dx, variant="courant0.275", settings=("scheme.courant=0.275",)),
         "courant 0.55": zhou_run(plan, dx),
         "courant 0.6": zhou_run(plan, dx, variant="courant0.6", settings=("scheme.courant=0.6",))})


def starts(plan):
    plan = replace(plan, scheme="")
    dx = spacing(plan)
    return zhou_comparison(
        "starts", "Scatter between initial states", "The same case from the regular lattice and from particles displaced at random. The "
        "scatter is the uncertainty of any single run of this case.",
        {"regular": zhou_run(plan, dx),
         **{f"displaced by {jitter:g} dx": zhou_run(plan, dx, variant=f"jitter{jitter:g}",
                                                   settings=(f"particles.jitter={jitter:g}",))
            for jitter in (0.02, 0.1, 0.15)}})
