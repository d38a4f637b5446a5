"""Steady flows in a flume against the formulas of hydraulics."""

from functools import partial

from .. import plots
from ..checks import Check
from ..metric import Metric
from ..reading import exact
from ..study import EXACT, LABORATORY, OrderCheck, Plot, Study


def draw_gauge(probe, *runs):
    """The depth at a gauge over time."""
    figure = plots.new_figure(height=2.6)
    axes = figure.subplots()
    for run, style in zip(runs, plots.CYCLE):
        curve = run.probe(probe, "connected_m")
        axes.plot(curve.time, curve.value, label=f"dx = {run.spacing:.3g} m", linewidth=1.0, **style)
    axes.set(xlabel="t (s)", ylabel="depth (m)")
    axes.legend(frameon=False)
    plots.grid(axes)
    return figure


def flume_study(plan, name, title, about, uncertainty, gauge, rows, seconds, quantities, kind=EXACT):
    """A study of cases/flume at several numbers of `rows`: particles over the case's own length, (key, its rows at
    quick and at paper); `seconds` of CPU time at the first. `quantities`: (key, words, unit, against, bar)."""
    length, quick, paper = rows
    chosen = plan.at(quick, paper, paper)
    runs = tuple(plan.run(f"{name}_{length}{n}", f"flume/{name.replace('-', '_')}.toml",
                          (f"particles.spacing={length}/{n}",), seconds * (n / quick[0]) ** 3.1) for n in chosen)
    one_or_all = OrderCheck if len(runs) > 1 else Check
    checks = tuple(one_or_all(Metric(f"{name}.{key}", words, unit, against, high=high), runs, partial(exact, name, key))
                   for key, words, unit, against, high in quantities)
    return Study(name, title, kind, about, uncertainty, checks,
                 (Plot("Depth at the gauge over time; numbers are means of the second half.", runs, partial(draw_gauge, gauge)),),
                 shown=runs[-1], moments=(8.0,))


def weir(plan):
    return flume_study(
        plan, "weir", "Sharp-crested weir: Rehbock (1929)",
        "50 l/s per metre over a thin weir 0.2 m high: discharge for the head that the water finds, against Rehbock's formula.",
        "Rehbock's own measurements scatter by less than 1 % about his formula. It has 1.1 mm for surface tension and viscosity, "
        "1.8 % of the discharge here, which this water does not have.",
        "upstream", ("P", (12,), (12, 16, 24)), 27.0,
        (("coefficient_error", "discharge for the head upstream, relative error", "", "Rehbock (1929)", 0.03),
         ("head_error", "head for the discharge, relative error", "", "Rehbock (1929)", None)), LABORATORY)


def broad_weir(plan):
    return flume_study(
        plan, "broad-weir", "Broad-crested weir: critical flow on the crest",
        "50 l/s per metre over a weir with a rounded nose and a crest 0.4 m long, without friction: discharge for the energy head "
        "upstream, against sqrt(g) (2H/3)^1.5.",
        "The formula has straight streamlines and no friction on the crest; laboratories measure up to 2 % less on smooth weirs of "
        "this shape.",
        "upstream", ("P", (8,), (8, 10, 12)), 25.0,
        (("coefficient_error", "discharge for the energy head, relative error", "", "critical flow", 0.03),
         ("crest_over_critical", "depth in the middle of the crest over the critical depth", "", "critical flow", None)))


def sluice_gate(plan):
    return flume_study(
        plan, "sluice-gate", "Sluice gate: contraction",
        "Water shoots out freely under a sharp-edged gate: its depth 2.5 openings behind the gate over the opening.",
        "0.61 is Kirchhoff's for a jet without gravity, pi/(pi + 2); potential flow with gravity has 0.60 to 0.61 at this opening.",
        "jet", ("a", (6,), (6, 9, 13)), 90.0,
        (("contraction_error", "contraction, relative error", "", "0.61", 0.02),
         ("discharge_error", "discharge for both depths, relative error", "", "energy equation", None)))


def hydraulic_jump(plan):
    return flume_study(
        plan, "hydraulic-jump", "Hydraulic jump: Belanger's conjugate depths",
        "Supercritical water, Froude number 2.5, meets a tailwater of its conjugate depth, without friction: depth behind the jump "
        "for the depth and the speed before it, both seen from the jump, which may wander.",
        "Belanger's formula follows from mass and momentum alone, however the energy is lost.",
        "behind", ("h1", (4,), (4, 6, 9)), 45.0,
        (("conjugate_error", "depth behind the jump, relative error", "", "Belanger", 0.02),
         ("wander_m_s", "speed at which the jump wanders", "m/s", "at rest", None)))


def channel(plan):
    return flume_study(
        plan, "channel", "Even flow through a channel with open ends",
        "0.11 m^2/s through 3 m of water 0.2 m deep without friction, inlet with a discharge, outlet with a tailwater, 10 s.",
        "The flow is even: nothing should change.",
        "depth_upstream", ("H", (8,), (8, 12, 18)), 16.0,
        (("discharge_error", "discharge in the middle, relative error", "", "inlet", 0.005),
         ("level_error_dx", "depth at two gauges, largest error", "dx", "tailwater", 0.25)))
