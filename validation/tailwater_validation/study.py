"""A study: which runs it needs, what is read from them, what it is held against, and what is drawn."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from tailwater.uncertainty import extrapolate

from .checks import Check, runs_of
from .curves import DataError
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
    """`about` says what is compared with what, `uncertainty` how well that is known. The water of `shown` is in the report,
    which points to it at `moments` (s); T = t over `time_scale` (s), if there is one. Without `has_histories` the energies mean
    nothing, such as those of a flow that a body force drives around. `names` {run's name: label} tell runs apart in plots."""

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
        """What belongs to the level."""
        return {"quick": quick, "paper": paper, "fine": fine}[self.level]

    @property
    def settings(self):
        return (f"scheme.name={self.scheme}",) if self.scheme else ()

    @property
    def integrators(self):
        """The plain one, then the one that the bars are for; "" where the scheme has no choice."""
        return ("explicit", "implicit") if self.scheme in ("", "farzin2014") else ("", "")

    def run(self, name, case, settings=(), seconds=10.0, integrator=""):
        """Settings of the run itself come last and override those of the plan."""
        if integrator:
            name, settings = f"{name}_{integrator}", (f"scheme.integrator={integrator}", *settings)
        return Run("_".join(filter(None, (name, self.scheme))), CASES / case, (*self.settings, *settings), seconds)


@dataclass(frozen=True)
class CurveCheck(Check):
    """A difference of curves, also at the best shift: `compute` takes the name of the metric's field, too."""

    def score(self, out):
        def read(field):
            return self.compute(*(finished(run, out) for run in self.runs), field=field)

        return measure(self.metric, **{field: partial(read, field) for field in ("value", "shifted_value", "shift")})


@dataclass(frozen=True)
class OrderCheck(Check):
    """An error on the last of the runs, and its observed order over all of them if there are several; `compute` takes
    one run. Of three runs or more also its uncertainty (docs/theory/uncertainty.md), from what `interval_of` reads of
    each run: the error with its sign."""

    interval_of: Callable | None = None

    def score(self, out):
        def of_all(read):
            return {run.spacing: read(run) for run in (finished(run, out) for run in self.runs)}

        def uncertainty():
            errors = of_all(self.interval_of or self.compute)
            return extrapolate(list(errors), list(errors.values())).uncertainty

        more = {"order": lambda: order(of_all(self.compute))} if len(self.runs) > 1 else {}
        if len(self.runs) > 2:
            more["uncertainty"] = uncertainty
        return measure(self.metric, value=lambda: self.compute(finished(self.runs[-1], out)), **more)


@dataclass(frozen=True)
class ModuleChecks:
    """All numbers that a laboratory case's own module finds in one run and whose names `keep` accepts; `paper` has what
    the paper reports for its own code, by name. Of a run that did not reach its end: that it did not."""

    name: str
    module_score: Callable
    runs: tuple
    keep: Callable = lambda name: True
    paper: tuple = ()
    suffix: str = ""
    variant: str = ""

    def scores(self, out):
        run, = self.runs
        try:
            found = scores(self.module_score, finished(run, out).path)
        except DataError as error:
            return [Metric(f"{self.name}.finished", f"the run reaches its end{self.suffix}", "of 1", "", low=1, value=0, note=str(error))]
        return [Metric(**{key: value for key, value in metric.items() if key != "verdict"}
                       | {"name": f"{self.name}.{name}", "what": metric["what"].strip() + self.suffix,
                          "paper": dict(self.paper).get(name)})
                for name, metric in found.items() if self.keep(name)]
