"""A study: its runs, the numbers that are read from them, their references, and its drawings."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from tailwater.errors import DataError
from tailwater.uncertainty import extrapolate

from .checks import Check, runs_of
from .metric import Metric, measure
from .reading import order, scores
from .runs import Run, finished

CASES = Path(__file__).resolve().parents[2] / "cases"
LEVELS = ("quick", "paper", "fine")
LABORATORY, EXACT, COMPARISON = "Laboratory", "Exact solutions", "Comparisons"
KINDS = (LABORATORY, EXACT, COMPARISON)


@dataclass(frozen=True)
class Plot:
    """`draw` takes what those of `runs` left that reached their end, and returns panels (module panels)."""

    caption: str
    runs: tuple
    draw: Callable


@dataclass(frozen=True)
class Study:
    """`about` names the compared values, `uncertainty` how well the reference is known. The water of `shown` is in the
    report, which points to it at `moments` (s); T = t over `time_scale` (s), if there is one. Without `has_histories`
    the energies mean nothing, such as those of a flow that a body force drives around. `names` {run's name: label} are
    labels of plots."""

    name: str
    title: str
    kind: str
    about: str
    uncertainty: str
    checks: tuple
    plots: tuple = ()
    shown: Run | None = None
    moments: tuple = ()
    time_scale: float | None = None
    has_histories: bool = True
    names: dict | None = None

    @property
    def what(self):
        return self.title

    @property
    def runs(self):
        return runs_of((*self.plots, *self.checks))


@dataclass(frozen=True)
class Plan:
    """How the runs of the studies are made: the level, and the scheme under test ("" is the program's default)."""

    level: str = "quick"
    scheme: str = ""

    def at(self, quick, paper, fine):
        """The one of three values that belongs to the tier."""
        return {"quick": quick, "paper": paper, "fine": fine}[self.level]

    @property
    def settings(self):
        return (f"scheme.name={self.scheme}",) if self.scheme else ()

    @property
    def integrators(self):
        """The plain one, then the one that the targets are for; "" where the scheme has no choice."""
        return ("explicit", "implicit") if self.scheme in ("", "farzin2014") else ("", "")

    def run(self, name, case, settings=(), seconds=10.0, integrator=""):
        """Settings of the run itself come last and override those of the plan."""
        if integrator:
            name, settings = f"{name}_{integrator}", (f"scheme.integrator={integrator}", *settings)
        return Run("_".join(filter(None, (name, self.scheme))), CASES / case, (*self.settings, *settings), seconds)


@dataclass(frozen=True)
class OrderCheck(Check):
    """An error on the last of the runs, and its observed order over all of them if there are several; `compute` takes
    one run. Of three runs or more also its uncertainty (docs/theory/uncertainty.md), from what `interval_of` reads of
    each run: the error with its sign."""

    interval_of: Callable | None = None

    def score(self, out):
        return measure(self.metric, lambda: self.fields([finished(run, out) for run in self.runs]))

    def fields(self, left):
        errors = {run.spacing: self.compute(run) for run in left}
        found = {"value": errors[left[-1].spacing]}
        if len(left) > 1:
            found["order"] = order(errors)
        if len(left) > 2:
            signed = [(self.interval_of or self.compute)(run) for run in left]
            found["uncertainty"] = extrapolate(list(errors), signed).uncertainty
        return found


@dataclass(frozen=True)
class AllChecks:
    """All numbers that `metrics` finds in one run, [Metric], and whose names `keep` accepts; `paper` has the values
    that the paper reports for its own code, by name. Of a run that did not reach its end: that it did not."""

    name: str
    metrics: Callable
    runs: tuple
    keep: Callable = lambda name: True
    paper: tuple = ()
    suffix: str = ""
    variant: str = ""

    def scores(self, out):
        run, = self.runs
        try:
            found = scores(self.metrics, finished(run, out).path)
        except DataError as error:
            return [Metric(f"{self.name}.finished", f"the run reaches its end{self.suffix}", "of 1", "", low=1, value=0, note=str(error))]
        return [replace(metric, name=f"{self.name}.{name}", what=metric.what + self.suffix, paper=dict(self.paper).get(name))
                for name, metric in found.items() if self.keep(name)]
