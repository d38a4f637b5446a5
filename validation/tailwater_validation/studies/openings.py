"""Flows through open ends whose levels and discharges change, against the shallow-water equations: cases/openings."""

from functools import partial

from .. import panels
from ..checks import Check
from ..metric import Metric
from ..reading import exact
from ..study import EXACT, Plot, Study

# case: (words, seconds of CPU, quantities)
DEPTH = ("depth_error_dx", "depth at the gauge, largest error beyond 2 % of the period", "dx", 1.0)
FLOWS = {
    "rising_sea": ("a river flows into a rising sea", 1.0, (DEPTH,)),
    "draining_tank": ("a tank drains to a level outside, swings below it and refills", 5.0, (DEPTH,)),
    "tide": ("a basin beside a sea with tides near resonance", 4.0, (DEPTH,)),
    "ending_discharge": ("the discharge of a channel ends, the tailwater keeps its level", 5.0, (DEPTH,)),
    "changing_level": ("the level outside a short basin rises within 3 s", 1.0, (DEPTH,)),
    "reservoir": ("a reservoir feeds a channel with a free brink", 5.0,
                  (("discharge_error", "discharge over critical flow, relative error", "", 0.01),)),
    "sudden_head": ("a head is applied suddenly to shallow still water", 3.0,
                    (("discharge_error", "discharge behind the bore, relative error", "", 0.03),
                     ("depth_error", "depth behind the bore, relative error", "", 0.03))),
    "river": ("a river on a surveyed bed in 3D, with a rating curve", 60.0,
              (("level_error_dx", "mean levels over a riffle, largest error against the backwater curve", "dx", 1.0),
               ("outside", "particles that leave beside the openings", "", 0.0))),
}


def draw(run):
    return [panels.panel("", "t (s)", "depth (m)", (panels.over_time("depth at the gauge", run.curve("depth", "connected_m")),))]


def openings(plan):
    flows = {name: flow for name, flow in FLOWS.items() if name != "river" or plan.level != "quick"}
    runs = {name: plan.run(f"openings_{name}", f"openings/{name}.toml", (), seconds) for name, (_, seconds, _) in flows.items()}
    checks = [Check(Metric(f"openings.{name}.{key}", f"{words}: {what}", unit, "shallow water", high=high), (runs[name],),
                    partial(exact, name.replace("_", "-"), key))
              for name, (words, _, quantities) in flows.items() for key, what, unit, high in quantities]
    checks += [Check(Metric(f"openings.{name}.density_error_rms", f"{words}: rms density error, openings included", "", "uniform density", high=0.02),
                     (runs[name],), partial(exact, name.replace("_", "-"), "density_error_rms"))
               for name, (words, _, _) in flows.items()]
    return Study(
        "openings", "Open ends whose levels and discharges change", EXACT,
        "Seven basins and channels and a river in 3D without friction, 4 to 20 particles deep, whose ends hold a level, bring a discharge or take it.",
        "Shallow water has no vertical acceleration and sharp bores; both are compared as means over two times sqrt(H/g).",
        tuple(checks), tuple(Plot(words + ".", (runs[name],), draw) for name, (words, _, _) in flows.items()),
        shown=runs["draining_tank"], moments=(2.0, 6.0), has_histories=False)  # the reservoir starts dry
