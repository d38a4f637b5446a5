"""Dam breaks in a long channel, without friction or with a rough bed, against shallow-water theory."""

import math
from functools import partial

import numpy as np

from .. import panels, shallow_water
from ..checks import Check
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

SIMILARITY = (-1.6, 2.2)  # x/(t sqrt(g h0)) that is shown


def draw_profiles(theory, label, *runs):
    """The latest profile of each run and the earlier ones of the last, over x/t."""
    def profile(run, k, kind):
        T, x, depth = shallow_water.late_profiles(run)[k]
        low, high = np.searchsorted(x / T, SIMILARITY)
        return panels.curve(f"dx = {run.spacing:g} h0, T = {T:.1f}", x[low:high] / T, depth[low:high], kind)

    similarity = np.linspace(*SIMILARITY, 2000)
    return [panels.panel("", "x/(t sqrt(g h0))", "h/h0", (
        *(profile(run, -1, "run") for run in runs), profile(runs[-1], 0, "aside"),
        panels.curve(label, similarity, theory(similarity), "exact")))]


def dam_break(name, title, about, theory, label, runs, quantities, moments):
    return Study(name, title, EXACT, about, LIMIT, tuple(
        OrderCheck(Metric(f"{name}.{key}", words, "", "shallow-water theory", high=high), runs, partial(exact, name, key))
        for key, words, _, high in quantities), (
        Plot("Depth over x/t: theory does not change, the computed profiles come nearer as T grows.", runs,
             partial(draw_profiles, theory, label)),
        Plot("Differences from shallow-water theory by spacing; they end at what the theory leaves out.", runs,
             partial(draw_errors, name, quantities))), shown=runs[-1],
        moments=tuple(T / math.sqrt(9.81) for T in moments), time_scale=1 / math.sqrt(9.81))


def spacings(plan):
    return plan.at((0.1, 0.05), (0.1, 0.05, 0.025), (0.05, 0.025, 0.0125))


def ritter(plan):
    runs = tuple(plan.run(f"ritter_dx{dx:g}", "verification/ritter.toml", (f"particles.spacing={dx:g}",), 0.7 * (0.1 / dx) ** 3.1)
                 for dx in spacings(plan))
    return dam_break(
        "ritter", "Dam break over a dry bed: Ritter (1892)",
        "A reservoir of depth h0 is released at once over a dry, frictionless floor. Theory: depth 4/9 h0 and discharge "
        "8/27 sqrt(g) h0^1.5 at the gate, a parabola between x/t = -1 and 2 sqrt(g h0).", shallow_water.ritter, "Ritter", runs,
        (("discharge_error", "discharge at the gate, relative error", "", 0.02),
         ("gate_error", "depth at the gate at T = 5.5, relative error", "", 0.03),
         ("profile_error", "profile at T = 5.5, rms error over h0", "", None),
         ("front_error", "speed of the depth 0.1 h0, relative error", "", None)), (1, 3, 5))


def stoker(plan):
    """Stoker's dam break, for twice the duration of Ritter's, so that the bore separates from the rarefaction."""
    runs = tuple(rough_run(plan, "wet_bed", "stoker", dx, None) for dx in spacings(plan))
    return dam_break(
        "stoker", "Dam break onto still water: Stoker (1957)",
        "The same onto water 0.2 h0 deep, for twice the time. Theory: a bore at 0.948 sqrt(g h0) and behind it water 0.508 h0 deep.",
        partial(shallow_water.stoker, ahead=0.2), "Stoker", runs,
        (("discharge_error", "discharge at the gate, relative error", "", 0.02),
         ("plateau_error", "mean depth behind the bore at T = 11.9, relative error", "", 0.02),
         ("profile_error", "profile at T = 11.9, rms error over h0", "", None),
         ("front_error", "speed of the bore, relative error", "", None)), (2, 6, 10))


ROUGH_T = 12  # t sqrt(g/h0) at the end


def rough_run(plan, name, bed, dx, roughness):
    """The dam break over a rough bed, or without friction (None), for twice the duration."""
    times = ", ".join(f'"{T:g}*sqrt(h0/g)"' for T in (*range(3, ROUGH_T), ROUGH_T - 0.1))
    rough = ("wall.channel.slip=no-slip", f"wall.channel.roughness={roughness}") if roughness else ()
    probe = {"ritter": 2, "stoker": 1}[bed]
    return plan.run(f"{name}_{'rough' if roughness else 'free'}_dx{dx:g}", f"verification/{bed}.toml",
                    (f"particles.spacing={dx:g}", f"parameters.T={ROUGH_T}", f"probe[{probe}].times=[{times}]", *rough),
                    1.2 * (0.1 / dx) ** 2.8)


def draw_fronts(*runs):
    histories = [(run, *np.transpose(shallow_water.front_history(run))) for run in runs]
    _, T, _, exact_front = histories[-1]
    return [panels.panel("", "t sqrt(g/h0)", "x/h0 of the front", (
        *(panels.curve(f"dx = {run.spacing:g} h0", times, found) for run, times, found, _ in histories),
        panels.curve("with friction", T, exact_front, "exact"), panels.curve("without (Ritter)", T, 2 * T, "aside")))]


def rough_dry_bed(plan):
    runs = tuple(rough_run(plan, "dry_bed", "ritter", dx, "h0/100")
                 for dx in plan.at((0.1,), (0.1, 0.05), (0.1, 0.05, 0.025)))
    return Study(
        "rough-dry-bed", "Tip of a dam break over a rough dry bed", EXACT,
        "Ritter's dam break over a bed of k_s = h0/100, for twice the time: friction holds the tip back by 10 h0 of 24. Place and speed "
        "of the front against the shallow-water equations with the logarithmic law, whose layers grow with the water.",
        "The theory leaves out vertical acceleration, which delays the start; so early fronts differ, and the speed is compared over "
        "the last third. The solver of the equations meets Ritter's and Stoker's solutions and, for little friction, Whitham's.",
        tuple(Check(Metric(f"rough-dry-bed.{key}", words, "", "shallow-water theory with friction", high=high), (runs[-1],),
                    partial(exact, "rough-dry-bed", key))
              for key, words, high in (("front_error", "place of the front at T = 11.9, relative error", 0.02),
                                       ("speed_error", "mean speed from T = 8 on, relative error", 0.05),
                                       ("profile_error", "depths ahead of the gate at T = 11.9, rms error over h0", None))),
        (Plot("Front over time.", runs, draw_fronts),), shown=runs[-1], moments=tuple(T / math.sqrt(9.81) for T in (4, 8, 11.9)),
        time_scale=1 / math.sqrt(9.81))


def draw_held_back(*runs):
    histories = [(rough, *np.transpose(shallow_water.held_back(rough, free))) for rough, free in zip(runs[::2], runs[1::2])]
    _, T, _, theory = histories[-1]
    return [panels.panel("", "t sqrt(g/h0)", "water held back (h0²)", (
        *(panels.curve(f"dx = {rough.spacing:g} h0", times, found) for rough, times, found, _ in histories),
        panels.curve("theory", T, theory, "exact")))]


def rough_wet_bed(plan):
    runs = tuple(rough_run(plan, "wet_bed", "stoker", dx, roughness)
                 for dx in plan.at((0.1,), (0.1, 0.05), (0.1, 0.05, 0.025)) for roughness in ("h0/50", None))
    return Study(
        "rough-wet-bed", "Decay of a bore over a rough bed", EXACT,
        "Stoker's dam break onto water 0.2 h0 deep over a bed of k_s = h0/50, for twice the time, beside the same without friction: how "
        "much water the friction has held back behind the gate, against the shallow-water equations with the logarithmic law.",
        "The difference of two runs: what the theory leaves out is the same in both. It is 0.05 h0^2 of 3.4 that have passed the gate; "
        "particles are counted on both sides of it.",
        (Check(Metric("rough-wet-bed.held_back_error", "water held back by friction at T = 12, relative error", "",
                      "shallow-water theory with friction", low=-0.15, high=0.15), runs[-2:], shallow_water.held_back_error),),
        (Plot("Water held back over time.", runs, draw_held_back),), shown=runs[-2],
        moments=tuple(T / math.sqrt(9.81) for T in (4, 8, 11.9)), time_scale=1 / math.sqrt(9.81))
