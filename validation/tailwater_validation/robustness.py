"""The gates of the robust core: studies of its own of the program, with targets.

`tailwater bench robustness` runs this module: it makes the runs, scores them and writes the same files as `tailwater
validate`. All cases and both integrators run with the defaults. `--set` changes the default under test, but not the
start and the spacing, which define a gate.

Usage: python -m tailwater_validation.robustness --program FILE [--out DIR] [--level quick|full] [--gate NAME]...
Exit codes: 0 all was run and scored, whatever the results are; 2 bad input, 4 a file cannot be written, 130
interrupted.
"""

import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from tailwater.errors import DataError

from . import command, validate
from .checks import Check
from .metric import Metric
from .reading import exact, interventions, mean_level, observed_order, summary
from .runs import finished, outcome
from .studies import zhou1999
from .studies.zhou1999 import energy_at, wall_noise
from .study import Plan, Study

INVISCID = ("study.noise_viscosity=0",)
STARTS = {
    "regular": (),
    "shifted": ('fluid[0].min=["dx/2", "dx/2"]', 'fluid[0].max=["2*H+dx/2", "H+dx/2"]'),
    "jitter0.02": ("particles.jitter=0.02",),
    "jitter0.1": ("particles.jitter=0.1",),
    "jitter0.15": ("particles.jitter=0.15",),
}


@dataclass(frozen=True)
class Bench(Plan):
    """The settings under test come first in each run."""

    settings: tuple = ()

    @property
    def is_full(self):
        return self.level == "full"

    def zhou(self, dx, T, start="regular", integrator="explicit", variant="", settings=()):
        """Zhou's dam break to T = t sqrt(g/H); costs 11 CPU s to T = 8 at dx = 0.02. Its walls have no friction
        here, so that all loss of energy is due to the scheme."""
        name = f"zhou_dx{dx:g}_T{T:g}_{start}_{integrator}" + (f"_{variant}" if variant else "")
        return self.run(name, "zhou1999/case.toml",
                        (f"particles.spacing={dx:g}", f"time.end={T:g}*sqrt(H/g)", f"scheme.integrator={integrator}",
                         "output.fields_interval=sqrt(H/g)", "wall.tank.slip=free", *STARTS[start], *settings),
                        11 * (0.02 / dx) ** 3.2 * T / 8)


def gate(name, what, checks):
    return Study(name, what, "Robustness", "", "The bars are our own.", tuple(checks))


def number(name, what, unit, runs, compute, against="", low=None, high=None, also_failed=False):
    """A check of one run or of several."""
    return Check(Metric(name, what, unit, against, low, high), runs if isinstance(runs, tuple) else (runs,), compute, also_failed)


def tank_gate(bench, name, what, case, dx, end, seconds, factor=1.0, is_implicit_quick=False):
    """Still water; the targets are multiplied by `factor`."""
    checks = []
    for integrator in bench.integrators if bench.is_full or is_implicit_quick else ("explicit",):
        run = bench.run(f"{name}_{integrator}", case,
                        (f"particles.spacing={dx:g}", "particles.jitter=0.2", f"time.end={end:g}",
                         f"scheme.integrator={integrator}", "output.fields_interval=1.0"), seconds)
        for key, text, unit, high in (
                ("u_rms", "rms speed from 5 s on, largest" if end > 5 else "rms speed in the second half, largest",
                 "sqrt(g H)", 3e-4),
                ("pressure_error", "rms pressure error at the end", "rho g H", 3e-3),
                ("level_error_dx", "level, largest error", "dx", 0.25),
                ("bottom_density", "density error within 4 dx of the bottom", "", 2e-3)):
            checks.append(number(f"{name}.{integrator}.{key}", f"{text}, {integrator}", unit, run, partial(exact, "tank", key),
                                 "exact: 0", high=factor * high))
    return gate(name, what, checks)


def matrix_gate(bench):
    """Zhou's dam break from five starts, with and without numerical viscosity."""
    T = 20 if bench.is_full else 8
    groups = []  # (dx, integrator, [(start, variant, settings)])
    both = [(start, variant, settings) for variant, settings in (("", ()), ("inviscid", INVISCID)) for start in STARTS]
    if bench.is_full:
        groups = [(dx, integrator, both) for dx in (0.02, 0.012, 0.006) for integrator in bench.integrators]
    else:
        groups = [(0.02, "explicit", [*both[:5], both[5], both[9]]), (0.02, "implicit", [both[0], both[9]])]
    checks = []
    for dx, integrator, starts in groups:
        runs = tuple(bench.zhou(dx, T, start, integrator, variant, settings) for start, variant, settings in starts)
        label, text = f"dam_break.dx{dx:g}.{integrator}", f"dx = {dx:g}, {integrator}"
        checks += [
            number(f"{label}.finished", f"runs that reach T = {T}, {text}", f"of {len(runs)}", runs, count_finished,
                   low=len(runs), also_failed=True),
            *(number(f"{label}.{key}", f"{words}, {text}", unit, runs, partial(largest, partial(summary, *read)), against,
                     high=high, also_failed=True) for key, words, unit, against, high, read in (
                ("outside", "particles outside the tank, most", "", "", 0, ("volume", "outside_the_walls_most")),
                ("energy_rise", "largest rise of the total energy", "of the start", "physics: none", 1e-4,
                 ("energy", "largest_rise_over_start")),
                ("energy_rise_unexplained", "the same without the work of the density source", "of the start",
                 "physics: none", 1e-4, ("energy", "largest_rise_less_density_work_over_start")))),
        ]
    return gate("dam-break", f"Zhou to T = {T} from five starts, with and without numerical viscosity", checks)


def count_finished(runs, out):
    return sum(outcome(out / "runs" / run.name).get("exit_code") == 0 for run in runs)


def largest(read, runs, out):
    """The largest value of the runs that finished; a run that did not finish misses the target for finishing."""
    values = [read(finished(run, out)) for run in runs if outcome(out / "runs" / run.name).get("exit_code") == 0]
    if not values:
        raise DataError("none of the runs finished")
    return max(values)


def slip_gate(bench):
    T = 20 if bench.is_full else 8
    free = bench.zhou(0.02, T)
    checks = []
    for name, settings in (("no-slip", ("wall[0].slip=no-slip",)),
                           ("partial", ("wall[0].slip=partial", "wall[0].friction=0.5"))):
        for integrator in bench.integrators if bench.is_full else ("explicit",):
            run = bench.zhou(0.02, T, integrator=integrator, variant=name, settings=settings)
            label, text = f"slip.{name}.{integrator}", f"{name}, {integrator}"
            checks += [number(f"{label}.finished", f"reaches T = {T}, {text}", "of 1", run, count_finished, low=1,
                              also_failed=True),
                       number(f"{label}.delay", f"front at the wall later than with free slip, {text}", "s", (run, free),
                              lambda run, free: zhou1999.front_arrival(run) - zhou1999.front_arrival(free))]
    return gate("slip", f"no slip and partial slip, Zhou to T = {T}", checks)


def density_gate(bench):
    dx, T = (0.012, 20) if bench.is_full else (0.02, 8)
    checks = []
    for integrator in bench.integrators:
        run = bench.zhou(dx, T, integrator=integrator)
        label, text = f"density.{integrator}", f"dx = {dx:g}, to T = {T}, {integrator}"
        checks += [
            number(f"{label}.mean", f"mean density error, {text}", "", run,
                   partial(summary, "volume", "density_error_mean"), "incompressible: 0", -2e-3, 2e-3),
            number(f"{label}.rms", f"rms density error, {text}", "", run, partial(summary, "volume", "density_error_rms"),
                   "incompressible: 0", high=1e-2),
        ]
        if bench.is_full:
            rest = bench.zhou(0.02, 80, integrator=integrator)
            exact_level = 2 * zhou1999.H**2 / zhou1999.TANK
            checks.append(number(f"{label}.level", f"mean level at T = 80, error, {integrator}", "of the level", rest,
                                 lambda run: mean_level(run) / exact_level - 1, low=-5e-3, high=5e-3))
    return gate("density", "volume of the dam break", checks)


INTERVENTIONS = ("stopped_at_walls", "capped_shifts", "fallback_rows", "restarted_solves")


def pressure_gate(bench):
    """Noise, laboratory pressure, arrival, interventions and cost, of the runs at dx = 0.015."""
    checks = []
    for integrator in bench.integrators:
        run = bench.zhou(0.015, 8, integrator=integrator)
        checks += [
            number(f"noise.{integrator}", f"wall pressure noise, z = 0.16 m, {integrator}", "rho g H", run,
                   wall_noise, "SISPH 0.015-0.020, DFSPH 0.04, SPHinXsys 0.17, DualSPHysics 0.22", high=6e-3),
            number(f"arrival.{integrator}", f"arrival at the wall, z = 0.12 m, {integrator}", "s", run,
                   zhou1999.arrival_at, "SISPH 0.62", 0.61, 0.64),
            number(f"arrival.front.{integrator}", f"arrival, front at the wall, {integrator}", "s", run,
                   zhou1999.front_arrival),
            number(f"interventions.{integrator}", f"clamps, limiters, fallbacks per particle and step, {integrator}", "", run,
                   interventions, high=1e-5),
            *(number(f"interventions.{kind}.{integrator}", f"of these, {kind.replace('_', ' ')}, {integrator}", "", run,
                     lambda run, kind=kind: interventions(run, kind)) for kind in INTERVENTIONS),
            number(f"cost.{integrator}", f"CPU time per simulated second, {integrator}", "s", run,
                   partial(summary, "cost", "cpu_s_per_simulated_s"), "SISPH 36-45, DFSPH 2.0, SPHinXsys 7, DualSPHysics 28",
                   high=8.0 if integrator == "explicit" else None),
        ]
    return gate("noise", "noise, arrival, interventions and cost of the dam break, dx = 0.015", checks)


READINGS = {"z = 0.06 m": "P060", "z = 0.115 m": "P115", "z = 0.12 m": "P120", "z = 0.16 m": "P160",
            "mean of 0.115..0.205 m": "P2"}


def laboratory_rms(probe, run):
    """RMS difference from the laboratory data for T = 2.4..7, with the best shift in time."""
    return zhou1999.rms(run, probe, field="shifted_value")


def laboratory_gate(bench):
    spacings = (0.02, 0.015, 0.012, 0.006) if bench.is_full else (0.02, 0.015)
    reference = "SISPH 0.21, SPHinXsys 0.29, DFSPH 0.31, DualSPHysics 0.38"
    checks = []
    for integrator in bench.integrators if bench.is_full else ("explicit",):
        runs = {dx: bench.zhou(dx, 20 if bench.is_full and dx in (0.02, 0.012, 0.006) else 8, integrator=integrator)
                for dx in spacings}
        label = f"laboratory.{integrator}"
        checks.append(number(f"{label}.best", f"RMS of the wall pressure, the best reading, dx = {spacings[-1]:g}, {integrator}",
                             "rho g H", runs[spacings[-1]],
                             lambda run: min(laboratory_rms(reading, run) for reading in READINGS.values()), reference, high=0.20))
        for text, reading in READINGS.items():
            checks += [number(f"{label}.{reading}.dx{dx:g}", f"RMS, {text}, dx = {dx:g}, {integrator}", "rho g H", run,
                              partial(laboratory_rms, reading), reference) for dx, run in runs.items()]
            checks.append(number(
                f"{label}.{reading}.falls", f"RMS at dx = {spacings[-1]:g} over that at {spacings[0]:g}, {text}, {integrator}", "",
                (runs[spacings[0]], runs[spacings[-1]]),
                lambda coarse, fine, reading=reading: laboratory_rms(reading, fine) / laboratory_rms(reading, coarse),
                "should be below 1"))
    return gate("laboratory", "wall pressure against Zhou, T = 2.4..7, shift within 0.12", checks)


@dataclass(frozen=True)
class ExactFlow:
    """A flow with a known solution, at the spacings of the tier quick and one more of the tier full. Every quantity
    is listed at each spacing. Those in `bars` must meet their target from the second spacing on. The order of
    `ordered` must be at least LEAST_ORDER, unless the coarsest run is accurate already (OrderOfError). The run at
    the coarsest spacing costs `seconds`; the cost of the others grows with the power `growth`."""

    case: str
    spacings: tuple
    finest: float
    seconds: float
    growth: float
    quantities: tuple
    ordered: str
    bars: tuple = ()
    settings: tuple = ()


LEAST_ORDER = 1.5
# The targets are our own, set for the second spacing: 50 particles across the box of vortices, 20 in the wave's depth,
# 20 in the drop's radius. Of the wave's period linear theory leaves out 0.03 % ((k a)^2/8): a target ten times that is
# the scheme's own error. The gates of the tanks have the target for the pressure of the tank.
EXACT_FLOWS = {
    "taylor-green": ExactFlow("robustness/taylor_green.toml", (0.04, 0.02), 0.01, 0.4, 3.4,
                              ("velocity_error", "pressure_error", "decay_error"), "velocity_error",
                              (("velocity_error", 5e-3),)),
    "standing-wave": ExactFlow("robustness/standing_wave.toml", (0.05, 0.025), 0.0125, 1.5, 3.2,
                               ("wave_error", "period_error", "decay_error"), "wave_error",
                               (("wave_error", 0.03), ("period_error", 3e-3))),
    "drop": ExactFlow("robustness/drop.toml", (0.1, 0.05), 0.025, 0.2, 3.2,
                      ("velocity_error", "pressure_error", "axes_error", "energy_error"), "velocity_error",
                      (("axes_error", 3e-3), ("energy_error", 2e-3))),
    "tank": ExactFlow("tank/case.toml", (0.05, 0.025), 0.0125, 1.5, 3.2, ("pressure_error", "u_rms"), "pressure_error",
                      (), ("particles.jitter=0.2", "time.end=5", "output.fields_interval=1.0")),
}


@dataclass(frozen=True)
class OrderOfError(Check):
    """The observed order of an error; `error` computes it from one run, and the coarsest run comes first. `bar` is the
    target of the error for the finer runs, if there is one.

    A method that just meets `bar` with the required order has 2^LEAST_ORDER times that error at twice the spacing. A
    method that meets `bar` on the coarsest run is better there by this factor and has less to gain. It meets the
    target of the order too, if its error does not grow from the coarsest run to the finest."""

    error: Callable | None = None
    bar: float | None = None

    def score(self, out):
        metric = super().score(out)
        if self.bar is None or metric.value is None or metric.verdict != "missed":
            return metric
        coarsest, *_, finest = (self.error(finished(run, out)) for run in self.runs)
        if not finest <= coarsest <= self.bar:
            return metric
        return replace(metric, met_because=f"{coarsest:.2g} on the coarsest set, within the bar of the finer ones, {self.bar:g}")


def exact_gate(bench):
    checks = []
    for name, flow in EXACT_FLOWS.items():
        spacings = (*flow.spacings, flow.finest) if bench.is_full else flow.spacings
        runs = tuple(bench.run(f"{name}_dx{dx:g}", flow.case, (f"particles.spacing={dx:g}", *flow.settings),
                               flow.seconds * (spacings[0] / dx) ** flow.growth) for dx in spacings)
        for quantity in flow.quantities:
            label, text = f"exact.{name}.{quantity}", f"{name}, {quantity.replace('_', ' ')}"
            bar = dict(flow.bars).get(quantity)
            checks.append(OrderOfError(Metric(f"{label}.order", f"{text}: observed order", "", "",
                                              low=LEAST_ORDER if quantity == flow.ordered else None), runs,
                                       partial(observed_order, name, quantity), error=partial(exact, name, quantity), bar=bar))
            for dx, run in zip(spacings, runs):
                high = bar if dx < spacings[0] else None
                checks.append(number(f"{label}.dx{dx:g}", f"{text}, dx = {dx:g}", "", run, partial(exact, name, quantity),
                                     "exact: 0", high=high))
    return gate("exact", "flows with a known solution: errors and orders", checks)


def implicit_gate(bench):
    explicit, implicit = bench.zhou(0.015, 8), bench.zhou(0.015, 8, integrator="implicit")
    both = (implicit, explicit)
    checks = [
        number("implicit.whole", "divergence at the new positions, over the explicit scheme's", "", both,
               lambda run, other: divergence("new", run) / divergence("new", other), high=1 / 3),
        number("implicit.energy", "energy at T = 4, less the explicit scheme's", "of the start", both,
               lambda run, other: energy_at(4, run) - energy_at(4, other), low=-2e-3),
        # The implicit integrator solves at the new positions: it has no divergence at the old ones to show.
        *(number(f"implicit.divergence.{name}.{positions}", f"rms divergence at the {positions} positions, {name}", "sqrt(g/H)",
                 run, partial(divergence, positions))
          for name, positions, run in (("explicit", "old", explicit), ("explicit", "new", explicit), ("implicit", "new", implicit))),
        *(number(f"implicit.energy.{name}", f"energy at T = 4, {name}", "of the start", run, partial(energy_at, 4))
          for name, run in (("explicit", explicit), ("implicit", implicit)))]
    return gate("implicit", "divergence left and energy lost, Zhou, dx = 0.015", checks)


def divergence(positions, run):
    """Rms over the run, in sqrt(g/H), at the "old" or "new" positions."""
    return run.summary["divergence"][f"rms_at_{positions}_positions_per_s"] * zhou1999.TIME_SCALE


# At its own, larger time step an implicit run costs about as much as an explicit one; the gate shows the ratio.
EQUAL_COST_SPACING = 0.015


def wins(ours, other):
    """Number of quantities (noise, volume, energy) in which `ours` is better."""
    return (int(wall_noise(ours) < wall_noise(other))
            + int(summary("volume", "density_error_rms", ours) < summary("volume", "density_error_rms", other))
            + int(energy_at(4, ours) > energy_at(4, other)))


def equal_cost_gate(bench):
    pairs = {"Zhou": tuple(bench.zhou(EQUAL_COST_SPACING, 8, integrator=name) for name in bench.integrators)}
    if bench.is_full:
        pairs["wet bed"] = tuple(
            bench.run(f"wet-bed_dx{EQUAL_COST_SPACING:g}_{name}", "robustness/wet_bed.toml",
                      (f"particles.spacing={EQUAL_COST_SPACING:g}", f"scheme.integrator={name}"), 35)
            for name in bench.integrators)
    read = {"noise": ("rho g H", wall_noise),
            "rms density error": ("", partial(summary, "volume", "density_error_rms")),
            "energy at T = 4": ("of the start", partial(energy_at, 4))}
    checks = []
    for case, (explicit, implicit) in pairs.items():
        label = f"equal_cost.{case}"
        checks += [
            number(f"{label}.wins", f"{case}: implicit better than explicit at dx = 0.015 in noise, volume, energy", "of 3",
                   (implicit, explicit), wins, "mixed", low=1),
            number(f"{label}.cpu", f"{case}: CPU time of the two, implicit over explicit", "", (implicit, explicit),
                   lambda run, other: summary("cost", "cpu_s", run) / summary("cost", "cpu_s", other), "should be 1"),
            *(number(f"{label}.{name}.{what}", f"{case}: {what}, {name} at dx = {EQUAL_COST_SPACING}", unit, run, compute)
              for name, run in (("explicit", explicit), ("implicit", implicit)) for what, (unit, compute) in read.items()),
        ]
    return gate("equal-cost", "implicit against explicit at equal CPU time, Zhou and the wet bed", checks)


def gates(bench):
    """All acceptance tests by name, in the order of the table."""
    found = [
        tank_gate(bench, "tank", "tank 1 m x 0.5 m at rest, jitter 0.2, 10 s", "tank/case.toml", 0.02, 10, 18,
                  is_implicit_quick=True),
        tank_gate(bench, "tank-tilted", "the same with a tilted bottom", "robustness/tank_tilted.toml", 0.02, 10, 15),
        tank_gate(bench, "tank-step", "the same with a step", "robustness/tank_step.toml", 0.02, 10, 15),
        tank_gate(bench, "tank-corner", "the same with a corner of 45 degrees", "robustness/tank_corner.toml", 0.02,
                  10, 16),
        tank_gate(bench, "tank-valley", "the same with a round valley for a bed", "robustness/tank_valley.toml", 0.02,
                  10, 16),
        tank_gate(bench, "tank-deep", "2 m deep", "robustness/tank_deep.toml", 0.02, 10, 80),
        tank_gate(bench, "tank-3d", "3D tank, 5 s, twice the bars", "robustness/tank_3d.toml", 0.025, 5, 80,
                  factor=2.0),
        matrix_gate(bench), slip_gate(bench), density_gate(bench), pressure_gate(bench), laboratory_gate(bench),
        exact_gate(bench), implicit_gate(bench), equal_cost_gate(bench),
    ]
    return {one.name: one for one in found}


def main(arguments=None):
    parser = command.RunsParser("tailwater bench robustness", "Run the robustness suite and its acceptance tests.", "bench", 1)
    parser.add_argument("--level", choices=("quick", "full"), default="quick",
                        help="quick: part of the runs, about ten minutes; full: all runs, many hours")
    parser.add_argument("--gate", action="append", default=[], metavar="NAME", help="test to run; may be repeated (default: all)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", dest="settings",
                        help="override a key in all runs, for example scheme.courant=0.2; may be repeated")
    parser.set_defaults(scheme="")
    options = parser.parse_args(arguments)

    def choose():
        if wrong := [setting for setting in options.settings if "=" not in setting]:
            raise DataError(f"--set {wrong[0]}: write key=value, as in --set scheme.courant=0.2")
        return command.choose(gates(Bench(options.level, settings=tuple(options.settings))), options.gate, "gate", "--gate ")

    return command.execute(options, choose, validate.score)


if __name__ == "__main__":
    sys.exit(main())
