"""Dam breaks in a long frictionless channel against shallow-water theory."""

import math
from functools import partial

import numpy as np

from .. import exact_flows, plots
from ..metric import Metric
from ..reading import exact
from ..study import EXACT, OrderCheck, Plot, Study
from .exact import draw_errors

LIMIT = ("Shallow-water theory is the limit at late times, not the solution: it leaves out vertical acceleration, which is as large as g "
         "when a gate is removed at once. The water takes about sqrt(h0/g) to start and stays behind by a length that does not grow, and "
         "dispersion rounds the kinks over a length like t^(1/3). So the comparison begins at T = t sqrt(g/h0) = 3 and ends before "
         "the wave that runs back meets the end of the reservoir. Speeds and the discharge are slopes over T, in which a constant lag does "
         "not count; the profile is compared over x/t, and its distance must fall as T grows. The discharge, and the depth behind a bore, "
         "follow from mass and momentum, however the energy is dissipated: these have targets (our own). The tip is thinner than "
         "a particle, so the place where the depth is 0.1 h0 represents the front.")


def draw_profiles(theory, label, *runs):
    """The latest profile of each run and the earlier ones of the last, over x/t."""
    figure = plots.new_figure(height=3.0)
    axes = figure.subplots()
    scale = math.sqrt(runs[0].parameters["h0"] / runs[0].gravity)
    for run, style in zip(runs, plots.CYCLE):
        T, x, depth = exact_flows.late_profiles(run, scale)[-1]
        axes.plot(x / T, depth, label=f"dx = {run.spacing:g} $h_0$, T = {T:.1f}", linewidth=1.3, zorder=3, **style)
    T, x, depth = exact_flows.late_profiles(runs[-1], scale)[0]
    axes.plot(x / T, depth, label=f"dx = {runs[-1].spacing:g} $h_0$, T = {T:.1f}", color=plots.GREY, linewidth=0.9)
    similarity = np.linspace(-1.6, 2.2, 2000)
    axes.plot(similarity, theory(similarity), label=label, **plots.EXACT)
    axes.set(xlim=(-1.6, 2.2), ylim=(0, 1.1), xlabel=r"$x/(t\sqrt{g h_0})$", ylabel="$h/h_0$")
    axes.legend(frameon=False)
    plots.grid(axes)
    return figure


def dam_break(plan, name, title, about, theory, label, quantities):
    runs = tuple(plan.run(f"{name}_dx{dx:g}", f"verification/{name}.toml", (f"particles.spacing={dx:g}",),
                          0.7 * (0.1 / dx) ** 3.1)
                 for dx in plan.at((0.1, 0.05, 0.025), (0.1, 0.05, 0.025), (0.05, 0.025, 0.0125)))
    return Study(name, title, EXACT, about, LIMIT, tuple(
        OrderCheck(Metric(f"{name}.{key}", words, "", "shallow-water theory", high=high), runs, partial(exact, name, key))
        for key, words, _, high in quantities), (
        Plot("Depth over x/t: theory does not change, the computed profiles come nearer as T grows.", runs,
             partial(draw_profiles, theory, label)),
        Plot("Differences from shallow-water theory by spacing; they end at what the theory leaves out.", runs,
             partial(draw_errors, name, quantities))), shown=runs[-1],
        moments=tuple(T / math.sqrt(9.81) for T in (1, 3, 5)), time_scale=1 / math.sqrt(9.81))


def ritter(plan):
    return dam_break(
        plan, "ritter", "Dam break over a dry bed: Ritter (1892)",
        "A reservoir of depth h0 is released at once over a dry, frictionless floor. Theory: depth 4/9 h0 and discharge "
        "8/27 sqrt(g) h0^1.5 at the gate, a parabola between x/t = -1 and 2 sqrt(g h0).", exact_flows.ritter, "Ritter",
        (("discharge_error", "discharge at the gate, relative error", "", 0.02),
         ("gate_error", "depth at the gate at T = 5.5, relative error", "", 0.03),
         ("profile_error", "profile at T = 5.5, rms error over h0", "", None),
         ("front_error", "speed of the depth 0.1 h0, relative error", "", None)))


def stoker(plan):
    return dam_break(
        plan, "stoker", "Dam break onto still water: Stoker (1957)",
        "The same onto water 0.2 h0 deep. Theory: a bore at 0.948 sqrt(g h0) and behind it water 0.508 h0 deep.",
        partial(exact_flows.stoker, ahead=0.2), "Stoker",
        (("discharge_error", "discharge at the gate, relative error", "", 0.02),
         ("plateau_error", "mean depth behind the bore at T = 5.5, relative error", "", 0.02),
         ("profile_error", "profile at T = 5.5, rms error over h0", "", None),
         ("front_error", "speed of the bore, relative error", "", None)))
