"""Numbers that are read from runs, and their comparison with targets."""

from collections.abc import Callable
from dataclasses import dataclass

from .metric import Metric, measure
from .runs import finished


@dataclass(frozen=True)
class Check:
    """One number. `compute` takes the results of `runs` and returns the value, or several fields of the metric. With
    `also_failed` it takes the runs themselves, failed ones included, and the folder of all runs instead. `variant`
    names the variant of a comparison."""

    metric: Metric
    runs: tuple
    compute: Callable
    also_failed: bool = False
    variant: str = ""

    def scores(self, out):
        return [self.score(out)]

    def score(self, out):
        if self.also_failed:
            return measure(self.metric, lambda: self.compute(self.runs, out))
        return measure(self.metric, lambda: self.compute(*(finished(run, out) for run in self.runs)))


def runs_of(parts):
    """The runs of checks, or of groups of checks, in order and without repetition."""
    return list(dict.fromkeys(run for part in parts for run in part.runs))
