"""Studies: the results of a case at decreasing particle spacings, with intervals for them.

A study runs a case at several spacings. At one of them it also runs other initial displacements of the particles and
half of the time step. It gives each result of each probe with an interval (`uncertainty`,
docs/theory/uncertainty.md)."""

import csv
import io
import json
import math
import os
from pathlib import Path

import numpy as np

from . import uncertainty
from .errors import DataError, InputError, IoError
from .input_file import read_text
from .readings import error_of_mean
from .run import Run
from .sweep import sweep
from .whole_file import write_whole_text

__all__ = ["Study", "study"]

COARSEST = 2.0  # over the spacing of the case, or of the finest run
SPACINGS = 7
STARTS = 3
JITTER = 0.01  # of dx: large enough that the random part of a result differs from run to run
FITS = 0.001  # fraction of the water; a spacing may fit it worse than the best one by this much
MISFIT = 0.01  # fraction of the water, above which the summary mentions that the runs begin with different amounts
LEAST_RANGE = 1.5  # smallest ratio of the coarsest to the finest spacing
# The cost of a run grows with 1/spacing: the particles by the power of the dimension, the steps by 1, the iterations of
# the solver a little.
COST_POWER = 1.3
COLUMNS = ("probe", "quantity", "unit", "value", "low", "high", "limit", "order", "uncertainty", "discretisation",
           "chance", "averaging", "step", "eca_hoekstra", "notes")


def quantities_of(run) -> dict:
    """{(probe, quantity): (value, unit)}: the results of the probes and the measurements of a run. Numbers of particles
    are left out, because they have no limit at zero spacing."""
    found = {}
    for probe, result in run.results.items():
        for quantity in result["quantities"]:
            name, unit = quantity["name"], quantity["unit"]
            if name == "particles":
                continue
            if "to" in quantity:
                found[probe, f"least {name}"] = quantity["value"], unit
                found[probe, f"largest {name}"] = quantity["to"], unit
            else:
                found[probe, name] = quantity["value"], unit
    for score in run.summary.get("measurements", []):
        for name in ("rms", "bias"):
            if name in score:
                quantity = f"{score['column']}, {name} from {Path(score['file']).name}"
                found[score["probe"], quantity] = score[name], score["unit"]
    return found


def cell(value) -> str:
    """The value for a CSV file; empty where there is no value."""
    if isinstance(value, float):
        return "" if math.isnan(value) else f"{value:.9g}"
    return "" if value is None else value


def number(value, digits=4) -> str:
    return "-" if value is None or math.isnan(value) else f"{value:.{digits}g}"


class Study:
    """Results of a study. `rows` is a list of dicts with the columns of `table()`; `spacings` [m] are those of the
    runs, the finest first; `runs`, `starts` and `step` are the runs."""

    def __init__(self, runs, starts=(), step=None, quantities=quantities_of):
        """`runs` are at three spacings or more, `starts` at one of them; `step` is the run at that spacing with half of
        its time step. `quantities(run)` returns {(probe, quantity): (value, unit)}, by default the results of the
        probes. Throws DataError if a run has not ended."""
        for run in [*runs, *starts, *([step] if step else [])]:
            if run.summary.get("status") != "done":
                raise DataError(f"{run.path}: has not ended; remedy: repeat the study, which continues with the missing "
                                "runs")
        self.runs = sorted(runs, key=lambda run: run.spacing)
        self.starts, self.step = list(starts), step
        self.spacings = [run.spacing for run in self.runs]
        others = [*self.starts, *([step] if step else [])]
        self._base = next((run for run in self.runs if others and math.isclose(run.spacing, others[0].spacing)), None)
        if others and self._base is None:
            raise DataError(f"{others[0].path}: no run of the study has its spacing, {others[0].spacing:g} m")
        self.rows = self._rows(quantities)

    @classmethod
    def load(cls, folder, quantities=quantities_of) -> "Study":
        """The study in a folder, from its runs. Throws DataError if the folder holds no study."""
        path = Path(folder) / "study.json"
        try:
            told = json.loads(read_text(path))
            runs, starts = ([Run(path.parent / name) for name in told[which]] for which in ("runs", "starts"))
            step = told["step"] and Run(path.parent / told["step"])
        except (DataError, KeyError, RecursionError, TypeError, ValueError) as error:
            raise DataError(f"{path}: is not the table of a study ({error})") from error
        return cls(runs, starts, step, quantities)

    def _rows(self, quantities):
        of_runs = [quantities(run) for run in self.runs]
        of_starts = [quantities(run) for run in ([self._base, *self.starts] if self.starts else [])]
        of_step = quantities(self.step) if self.step else {}
        rows, everywhere = [], [*of_runs, *of_starts, *([of_step] if self.step else [])]
        keys = dict.fromkeys(key for found in everywhere for key in found)
        self.without_limit = [key for key in keys if not all(key in found for found in everywhere)]
        if quantities is quantities_of:
            probes = [probe["name"] for probe in self.runs[0].case.get("probe", [])]
            self.without_limit += [(probe, "") for probe in probes if all(probe != name for name, _ in keys)]
        for key, (_, unit) in of_runs[0].items():
            if key in self.without_limit:
                continue
            values = [found[key][0] for found in of_runs]
            starts = {self._base.spacing: [found[key][0] for found in of_starts]} if of_starts else {}
            found = uncertainty.estimate(self.spacings, values, starts=starts,
                                         step=(self._base.spacing, of_step[key][0]) if of_step else None,
                                         averaging=error_of_mean(self.runs[0], *key))
            told = {name: getattr(found, name) for name in COLUMNS[3:-1]}
            rows.append({"probe": key[0], "quantity": key[1], "unit": unit, **told, "notes": "; ".join(found.notes),
                         "values": values})
        return rows

    def table(self):
        """A pandas.DataFrame over probe and quantity. `value` is that of the finest run. `limit` is the extrapolated
        value; it lies between `low` and `high` with a probability of 95 %. `order` is the observed order. `uncertainty`
        is the half width of the interval, with the parts `discretisation`, `chance` and `averaging`. `step` is the
        change by half of the time step. `eca_hoekstra` is the uncertainty of the value by the method of Eca & Hoekstra.
        `notes` say which runs narrow the interval."""
        import pandas

        return pandas.DataFrame([{name: row[name] for name in COLUMNS} for row in self.rows],
                                columns=COLUMNS).set_index(["probe", "quantity"])

    def text(self) -> str:
        """The table as text, two or three lines for each number."""
        told = f"spacings {', '.join(f'{spacing:.4g}' for spacing in self.spacings)} m"
        if self.starts:
            told += f"; {len(self.starts)} other starts"
        if self.step:
            told += "; half of the time step"
        lines = [told + (f", at {self._base.spacing:.4g} m" if self._base else "")]
        off, spacing = difference_of_water(self.runs)
        if off > MISFIT:
            lines.append(f"the run at {spacing:.4g} m begins with {100 * off:.1f} % more or less water than the finest one: "
                         "spacings that divide the lengths of the water narrow the intervals")
        for row in self.rows:
            share = row["uncertainty"] / abs(row["limit"]) if row["limit"] else math.inf
            percent = f" (+- {100 * share:.2g} %)" if share < 1 else ""
            lines.append(f"{row['probe']}, {row['quantity']}: {number(row['value'])} {row['unit']}; limit "
                         f"{number(row['limit'])}, within {number(row['low'])} to {number(row['high'])}{percent}")
            names = ("discretisation", "chance", "averaging", "step")
            parts = ", ".join(f"{name} {number(row[name], 2)}" for name in names)
            lines.append(f"    {parts}; order {number(row['order'], 2)}; Eca & Hoekstra +- {number(row['eca_hoekstra'], 2)}")
            if row["notes"]:
                lines.append(f"    {row['notes']}")
        for probe, quantity in self.without_limit:
            runs = "a run" if quantity else "the runs"
            lines.append(f"{probe}{', ' if quantity else ''}{quantity}: no result, because {runs} had too few readings, or none")
        return "\n".join(lines) + "\n"

    def write(self, folder):
        """Writes study.csv, study.json and study.txt, with paths of runs relative to the folder; `tailwater view` shows
        them."""
        folder = Path(folder)
        lines = io.StringIO()
        table = csv.writer(lines, lineterminator="\n")
        table.writerow(COLUMNS)
        table.writerows([cell(row[name]) for name in COLUMNS] for row in self.rows)
        write_whole_text(folder / "study.csv", lines.getvalue())
        rows = [{name: None if isinstance(value, float) and math.isnan(value) else value for name, value in row.items()}
                for row in self.rows]
        def place(run):
            return os.path.relpath(run.path, folder)

        told = {"spacings_m": self.spacings, "runs": [place(run) for run in self.runs],
                "starts": [place(run) for run in self.starts], "step": place(self.step) if self.step else None,
                "results": rows}
        write_whole_text(folder / "study.json", json.dumps(told, indent=2) + "\n")
        write_whole_text(folder / "study.txt", self.text())

    def __repr__(self):
        return self.text()

    def _repr_html_(self):
        return self.table()._repr_html_()


def ladder(coarsest, finest, count=SPACINGS):
    """Spacings from `coarsest`, which is left out, to `finest` in a geometric series, rounded to four digits."""
    ratio = (finest / coarsest) ** (1 / (count - 1))
    return [float(f"{coarsest * ratio**k:.4g}") for k in range(1, count)]


def difference_of_water(runs):
    """(largest relative difference of the initial volume of water from that of the finest run, spacing): by the water
    balances in the summaries. (0, nan) with inlets or outlets, whose ducts count, and without balances."""
    volumes = {run.spacing: run.summary["water_balance"]["start"]["volume_m3"] for run in runs
               if "water_balance" in run.summary}
    finest = volumes[min(volumes)] if volumes else 0.0
    if finest == 0.0 or any(run.case.get("inlet") or run.case.get("outlet") for run in runs):
        return 0.0, math.nan
    return max((abs(volume / finest - 1), spacing) for spacing, volume in volumes.items())


def lengths_of_water(case):
    """Lengths [m] of the initial blocks of water: edges of boxes, and depths of regions filled to a level. `case` is
    the effective case of a run. A block has whole rows of particles. If the rows do not fit, they are stretched, so that
    the cells of the particles are no squares. Empty with inlets or outlets, since these determine the rows."""
    if case.get("inlet") or case.get("outlet"):
        return np.zeros(0)
    heights = [point[-1] for wall in case.get("wall", []) for point in wall.get("points", [])]
    found = []
    for fluid in case.get("fluid", []):
        if fluid["shape"] == "box":
            found += [high - low for low, high in zip(fluid["min"], fluid["max"])]
        elif fluid["shape"] == "fill" and heights:
            found.append(fluid["level"] - min(heights))
    return np.array([length for length in found if length > 0])


def misfit(spacing, lengths):
    """Largest relative stretch of whole rows of particles that fit the water's lengths, over all directions of all
    blocks."""
    rows = lengths / spacing
    return float(np.abs(np.round(rows) / rows - 1).max(initial=0.0))


def fitting(spacing, lengths, within):
    """The spacing nearest to `spacing`, within the relative distance `within`, whose misfit exceeds the smallest one
    there by 0.1 % at most."""
    rows = range(1, math.ceil(lengths.max(initial=0.0) / (spacing * (1 - within))) + 1)
    near = [spacing, *(length / n for length in lengths for n in rows if abs(length / n / spacing - 1) <= within)]
    least = min(misfit(one, lengths) for one in near)
    return min((one for one in near if misfit(one, lengths) <= least + FITS), key=lambda one: abs(math.log(one / spacing)))


def fitted_ladder(coarsest, finest, case, keeps_finest):
    """The ladder below `coarsest`, with spacings replaced by near ones that fit the water of `case`; the finest one
    stays if `keeps_finest`."""
    below = ladder(coarsest, finest)
    lengths, within = lengths_of_water(case), 0.35 * (coarsest / below[0] - 1)
    fitted = [float(f"{fitting(spacing, lengths, within):.6g}") for spacing in below]
    return [*fitted[:-1], below[-1]] if keeps_finest else fitted


def finest_within(coarsest, seconds, budget, dimension, extra):
    """The finest spacing for which the whole study takes the time `budget`. The coarsest run took `seconds`; `extra`
    runs are at the second coarsest spacing."""
    def cost(finest):
        each = [(coarsest / spacing) ** (dimension + COST_POWER) for spacing in (coarsest, *ladder(coarsest, finest))]
        return seconds * (sum(each) + extra * each[1])

    low, high = coarsest / 64, coarsest
    for _ in range(60):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if cost(middle) < budget else (middle, high)
    if coarsest / high < LEAST_RANGE:
        raise InputError(f"--budget {budget:g}: the coarsest run, at {coarsest:g} m, has taken {seconds:.3g} s, and a "
                         f"study down to {coarsest / LEAST_RANGE:.4g} m takes about "
                         f"{cost(coarsest / LEAST_RANGE):.3g} s; remedy: a larger budget, or a coarser case")
    return high


def done(members, what):
    """The runs of a sweep. Throws the first message if a run has failed or was interrupted: IoError if a file could not be
    written, otherwise DataError."""
    for member, row in members.table().iterrows():
        if row["status"] != "done":
            message = row["message"] if isinstance(row["message"], str) else ""
            is_file = row["exit_code"] == 4
            remedy = "make room for the files, or choose another folder" if is_file else f"another case, or {what}"
            raise (IoError if is_file else DataError)(
                f"{members.path / member}: {row['status']}{': ' if message else ''}{message}; remedy: {remedy}; the study "
                "then continues with the missing runs")
    return members.runs


def require_folder_for_study(out: Path):
    """Throws InputError for a folder that holds other results than those of a study, IoError if `out` is not a
    folder."""
    if out.exists() and not out.is_dir():
        raise IoError(f"{out}: is no folder; remedy: choose another name")
    for file, what in (("case.effective.toml", "a run"), ("sweep.csv", "a sweep")):
        if (out / file).exists():
            raise InputError(f"{out} holds the results of {what}; remedy: choose a folder of its own for the study")


def study(case, *, out=None, spacings=None, budget=None, starts: int = STARTS, step: bool = True, jobs: int = 1,
          ranks: int = 1, progress: bool = False, quantities=quantities_of) -> Study:
    """Runs a case at several spacings and estimates intervals for its results. `out` is the folder, by default
    NAME_study; a further call completes a study that was interrupted.

    `spacings`: three or more, in m. By default they are seven, from twice the spacing of the case down to that spacing.
    With a `budget` in seconds of CPU time, they go down to the finest spacing within it. Intermediate spacings are
    adjusted so that whole rows of particles fit the water, where such spacings are near. At the second coarsest
    spacing, `starts` runs have other random initial displacements of the particles, and one run has half of the time
    step if `step`. `quantities(run)` returns your own numbers instead of the probes' results, as {(name, quantity):
    (value, unit)}. Throws InputError before anything is run; DataError if a run fails."""
    out = Path(out or f"{case.file.stem}_study")
    require_folder_for_study(out)
    runner = {"jobs": jobs, "ranks": ranks, "progress": progress}
    if budget is not None and not (isinstance(budget, (int, float)) and budget > 0):
        raise InputError(f"budget = {budget!r}: give seconds of computing time, as a number")
    if quantities is quantities_of and "probe[0].type" not in case:
        raise InputError(f"{case.file}: has no probe, so a study has no result; remedy: add a [[probe]]")
    if starts < 0:
        raise InputError(f"starts = {starts}: give 0 or more")
    if spacings is not None:
        chosen = sorted({float(spacing) for spacing in spacings}, reverse=True)
        if len(chosen) < 3 or not chosen[-1] > 0:
            raise InputError(f"spacings = {', '.join(map(str, spacings))}: give three or more that differ, in m")
        if budget is not None:
            raise InputError("spacings and a budget: give one of them")
        runs = done(sweep(case, {"particles.spacing": chosen}, out=out / "spacings", **runner), "other spacings")
    else:
        own = case["particles.spacing"]
        if isinstance(own, bool) or not isinstance(own, (int, float, str)):
            raise InputError(f"particles.spacing = {own!r}: give a length in m in the case, or spacings of the study")
        first = f"{COARSEST:g}*({own})" if isinstance(own, str) else COARSEST * own
        coarse = done(sweep(case, {"particles.spacing": [first]}, out=out / "coarsest", **runner), "a finer case")
        coarsest, finest = coarse[0].spacing, coarse[0].spacing / COARSEST
        if budget is not None:
            finest = finest_within(coarsest, coarse[0].summary["cost"]["cpu_s"], budget, coarse[0].dimension,
                                   starts + 2 * step)
        below = fitted_ladder(coarsest, finest, coarse[0].case, keeps_finest=budget is None)
        finer = sweep(case, {"particles.spacing": below}, out=out / "spacings", **runner)
        runs = [*coarse, *done(finer, "a coarser one")]
    base = sorted(runs, key=lambda run: run.spacing)[-2]
    at_base = case.copy().update({"particles.spacing": base.spacing})
    others, half = [], None
    if starts:
        seed, jitter = base.case["particles"]["seed"], base.case["particles"]["jitter"] or JITTER
        seeds = [seed + k + 1 for k in range(starts)]
        others = done(sweep(at_base, {"particles.jitter": [jitter], "particles.seed": seeds}, out=out / "starts",
                            **runner), "starts=0")
    if step:
        courant = base.case["scheme"]["courant"] / 2
        half = done(sweep(at_base, {"scheme.courant": [courant]}, out=out / "step", **runner), "step=False")[0]
    found = Study(runs, others, half, quantities)
    found.write(out)
    return found
