"""A study: its runs, the numbers computed from them, their references, and its drawings."""

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
    """`draw` takes the results of those `runs` that reached their end, and returns panels (module panels)."""

    caption: str
    runs: tuple
    draw: Callable


@dataclass(frozen=True)
class Study:
    """`about` describes the compared values, `uncertainty` that of the reference. The report shows the water of the
    run `shown`, with buttons for `moments` (s); T = t over `time_scale` (s), if there is one. `has_histories` is
    false where energies have no meaning, as in a flow driven by a body force. `names` {run's name: label} are labels
    in plots."""

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
    """Settings for all runs of the studies: the tier, and the scheme under test ("" is the program's default)."""

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
    """An error of the last run, and its observed order over all runs if there are several; `compute` takes one run.
    From three runs on it also has an uncertainty (docs/theory/uncertainty.md), from the error with its sign, which
    `interval_of` computes for each run."""

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
    """All numbers, [Metric], that `metrics` computes for one run and whose names `keep` accepts; `paper` has the
    values that the paper reports for its own code, by name. A run that did not reach its end has one number, which
    records this."""

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
