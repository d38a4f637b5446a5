"""Sweeps: runs of one case for several values of some keys."""

import csv
from pathlib import Path

from . import case_text
from .errors import DataError, Error, InputError
from .program import call
from .run import Run

__all__ = ["Sweep", "sweep"]


class Sweep:
    """The folder of a sweep. Throws DataError if the folder holds no sweep."""

    def __init__(self, path):
        self.path = Path(path)
        self.table()

    def table(self):
        """sweep.csv as a pandas.DataFrame: the values, status, cost and errors of each member."""
        import pandas

        path = self.path / "sweep.csv"
        try:
            return pandas.read_csv(path).set_index("member")
        except (OSError, ValueError, csv.Error) as error:
            raise DataError(f"{path}: is not the table of a sweep ({error})") from error

    @property
    def runs(self) -> list:
        """The members that have begun, in order."""
        return [Run(self.path / member) for member in self.table().index
                if (self.path / member / "summary.json").exists()]

    def __iter__(self):
        return iter(self.runs)

    def __repr__(self):
        return f"Sweep({str(self.path)!r}: {len(self.table())} members)"

    def _repr_html_(self):
        return self.table()._repr_html_()


def sweep(case, values: dict, *, out=None, jobs: int = 1, ranks: int = 1, progress: bool = False) -> Sweep:
    """Runs a case for each value of each key, for several keys all combinations, `jobs` runs at a time. `out` is the
    folder, by default NAME_sweep with the name of the case file; a further call completes a sweep that was interrupted.
    A member that fails does not end the others: the table holds the status of each. Throws InputError before anything
    is run."""
    out = Path(out or f"{case.file.stem}_sweep")
    if not values:
        raise InputError("values: give keys, each with a list of its values")
    words = []
    for key, each in values.items():
        if isinstance(each, (str, int, float)):
            raise InputError(f"{key} = {each}: give a list of values")
        case[key]  # throws for a key that the case cannot have
        words += ["--sweep", f"{key}={','.join(map(case_text.toml_value, each))}"]
    table = out / "sweep.csv"
    before = table.stat().st_mtime_ns if table.exists() else None
    try:
        call("run", *case.words(without=values), "--out", out, *words, "--jobs", jobs,
             *(["-n", ranks] if ranks != 1 else []), *([] if progress else ["--quiet"]), progress=progress)
    except Error:
        if not table.exists() or table.stat().st_mtime_ns == before:
            raise
    return Sweep(out)
