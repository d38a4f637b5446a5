"""Keys in which the runs of a study differ, other than those that the study varies."""

import numpy as np

__all__ = ["differing_keys"]

# Keys that a study varies, by the role of a run or its folder in an unfinished study, besides the spacing.
OF_STARTS, OF_STEP = ("particles.jitter", "particles.seed"), ("scheme.courant",)
VARIED = {"start": OF_STARTS, "starts": OF_STARTS, "half step": OF_STEP, "step": OF_STEP}
OUTPUT = "output."  # keys of this table change no result
ROUNDING = 1e-6  # relative; an effective case has nine digits


def values_of(case) -> dict:
    """{key: value} of an effective case, with keys as on the command line, such as "probe.weir.at"."""
    found = {}
    for name, tables in case.items():
        for number, table in enumerate(tables if isinstance(tables, list) else [tables]):
            place = f"{name}.{table.get('name', number)}" if isinstance(tables, list) else name
            found |= {f"{place}.{key}": value for key, value in table.items()}
    return {key: value for key, value in found.items() if not key.startswith(OUTPUT)}


def numbers_in(value):
    """The numbers of a value or a list as an array; None if it has others than numbers."""
    try:
        found = np.array(value)
    except ValueError:  # lists of different lengths
        return None
    return found.astype(float) if found.dtype.kind in "iuf" else None


def follows_the_spacing(spacings, values) -> bool:
    """Whether the values are a + b dx, as of a key that is an expression with dx. Two spacings cannot disprove it."""
    numbers = [numbers_in(value) for value in values]
    if any(each is None or each.shape != numbers[0].shape for each in numbers):
        return False
    table, h = np.array([each.ravel() for each in numbers]), np.array(spacings)
    rows = np.column_stack([np.ones_like(h), h / h.max()])
    rest = rows @ np.linalg.lstsq(rows, table, rcond=None)[0] - table
    return bool((abs(rest) <= ROUNDING * np.maximum(abs(table).max(axis=0), h.max())).all())


def differing_keys(roles) -> dict:
    """{key: its different values} of the runs in `roles`, [(role, Run)]. Keys that the study varies are left out, and
    those that follow the spacing."""
    cases = [(role, run.spacing, values_of(run.case)) for role, run in roles]
    found = {}
    for key in dict.fromkeys(key for _, _, values in cases for key in values):
        compared = [(spacing, values.get(key)) for role, spacing, values in cases if key not in VARIED.get(role, ())]
        distinct = [value for k, (_, value) in enumerate(compared) if value not in [other for _, other in compared[:k]]]
        if len(distinct) < 2:
            continue
        of_spacing = dict(compared)
        is_same = all(of_spacing[spacing] == value for spacing, value in compared)
        if not (is_same and follows_the_spacing(list(of_spacing), list(of_spacing.values()))):
            found[key] = distinct
    return found
