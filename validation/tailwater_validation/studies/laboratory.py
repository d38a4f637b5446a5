"""Functions that the studies of laboratories share."""

from functools import partial
from pathlib import Path

from tailwater.curves import Curve
from tailwater.errors import DataError
from tailwater.tables import read_table, without_unit

from .. import panels
from ..reading import scored
from ..study import LABORATORY, AllChecks, Plot, Study

ALWAYS = ("The laboratory's gate, friction of side walls and surface tension are not included in these uncertainties.")


def measured_tables(run, probe):
    """{name of the file: {quantity: values}}, in SI units, of the case's `[[measurement]]`s of a probe. Throws
    DataError if there are none."""
    paths = [Path(table["file"]) for table in run.case.get("measurement", []) if table["probe"] == probe]
    if not paths:
        raise DataError(f"{run.path}: its case has no [[measurement]] of {probe}")
    return {path.stem: {without_unit(name): values for name, values in read_table(path).items()} for path in paths}


def measured_curves(run, probe, column="value"):
    """{name of the file: Curve over s} of a quantity, named in the file like the probe or like `column`. Throws
    DataError."""
    return {name: Curve.from_samples(table["t" if "t" in table else "time"], table[probe if probe in table else column], name)
            for name, table in measured_tables(run, probe).items()}


def case_run(plan, name, length, count, seconds, integrator=None, variant="", settings=()):
    """A run with `count` particles over the case's characteristic length; `seconds` is its cost with ten of them."""
    return plan.run("_".join(filter(None, (f"{name}_{length}-{count}", variant))), f"{name}/case.toml",
                    (f"particles.spacing={length}/{count}", *settings), seconds * (count / 10) ** 3.1,
                    plan.integrators[-1] if integrator is None else integrator)


def draw_convergence(metrics, names, ylabel, *runs):
    """Numbers of runs by spacing: `names` are (label, name of the number)."""
    return panels.convergence({label: {run.spacing: scored(metrics, name, run) for run in runs} for label, name in names},
                              ylabel)


def everything(_):
    return True


def laboratory_study(name, title, metrics, draw, about, uncertainty, runs, converging=(), ylabel="", paper=(),
                     keep=everything, more_checks=(), more_plots=(), **more):
    """A study of the [Metric] that `metrics(run)` computes for the last of `runs`; `draw(run)` returns panels with
    its curves beside those of the laboratory."""
    plots = [Plot(f"Computed ({runs[-1].name}) and measured.", runs[-1:], draw)]
    if converging:
        plots.append(Plot("Differences from the laboratory by spacing; they end at the uncertainty of the data.", runs,
                          partial(draw_convergence, metrics, converging, ylabel)))
    return Study(name, title, LABORATORY, about, f"{uncertainty} {ALWAYS}",
                 (AllChecks(name, metrics, runs[-1:], keep, paper), *more_checks), (*plots, *more_plots),
                 **({"shown": runs[-1]} | more))
