"""How well a number is known that was computed at several spacings: its limit, its order, and an interval.

The method is that of L. Eca and M. Hoekstra, A procedure for the estimation of the numerical uncertainty of CFD
calculations based on grid refinement studies, J. Comput. Phys. 262 (2014) 104-130, for values that scatter about their
trend; docs/theory/uncertainty.md has it, with what it cannot do."""

import math
from dataclasses import dataclass, field

import numpy as np

from .errors import DataError

__all__ = ["Estimate", "Extrapolation", "chance_of", "estimate", "extrapolate"]

LEAST_ORDER, LARGEST_ORDER = 0.5, 2.0  # of an error that can be believed to go on so
SAFE, UNSAFE = 1.25, 3.0  # factors on the error that was found
ORDERS = np.linspace(0.05, 8.0, 160)  # that are looked through, before the best is made precise
# Of Student's distribution, by degrees of freedom: within how many standard deviations the mean is, 95 times of 100.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228)
ROUNDING = 1e-12  # of the values: what spreads less is one number


@dataclass(frozen=True)
class Extrapolation:
    """Of values at several spacings; the first is the finest."""

    limit: float  # at spacing 0
    order: float  # that was observed; nan where none is between 0 and 8
    error: float  # of the finest value, as the fit has it: fit - limit
    scatter: float  # of the values about the fit
    spread: float  # of the values, per interval between spacings
    uncertainty: float  # of the finest value, either way
    form: str  # of the error that was fitted: "h^p", "h", "h^2", "h + h^2", or "none" where all values are one


def fitted(h, value, weights, powers):
    """(limit, error at the finest, scatter, distance of the finest from the fit) of a sum of powers of h."""
    rows = np.column_stack([np.ones_like(h), *(h**power for power in powers)])
    root = np.sqrt(weights)
    coefficients = np.linalg.lstsq(rows * root[:, None], value * root, rcond=None)[0]
    left = rows @ coefficients - value
    free = max(len(h) - len(powers) - 1, 0)
    scatter = math.sqrt(len(h) * float(weights @ left**2) / free) if free else 0.0
    return float(coefficients[0]), float(rows[0, 1:] @ coefficients[1:]), scatter, abs(float(left[0]))


def misfits(orders, h, value, weights):
    """Of one power each: the weighted sum of the squares that a straight line over h^order leaves."""
    x = (h / h[0]) ** np.asarray(orders)[:, None]
    x = x - (x @ weights)[:, None]
    y = value - weights @ value
    return weights @ y**2 - (x @ (weights * y)) ** 2 / (x**2 @ weights)


def best_order(h, value, weights):
    """The order with which one power fits best; nan if that is at an end of those looked through."""
    orders = ORDERS
    for _ in range(4):
        k = int(np.argmin(misfits(orders, h, value, weights)))
        if k in (0, len(orders) - 1):
            return math.nan
        found = float(orders[k])
        orders = np.linspace(orders[k - 1], orders[k + 1], 41)
    return found


def scatter_of(named):
    """Of a fit with its name."""
    return named[1][2]


def extrapolate(spacings, values) -> Extrapolation:
    """Of three values or more. Throws DataError for fewer, and for what is no number."""
    h, value = np.asarray(spacings, dtype=float), np.asarray(values, dtype=float)
    if h.shape != value.shape or len(np.unique(h)) != h.size or h.size < 3:
        raise DataError(f"{h.size} spacings and {value.size} values; an uncertainty needs three values or more, each "
                        "at a spacing of its own")
    if not (np.isfinite(h).all() and np.isfinite(value).all() and (h > 0).all()):
        raise DataError("a spacing or a value is not a finite number")
    finest_first = np.argsort(h)
    h, value = h[finest_first], value[finest_first]
    whole = float(value.max() - value.min())
    if whole <= ROUNDING * float(abs(value).max()):
        return Extrapolation(float(value[0]), math.nan, 0.0, 0.0, 0.0, 0.0, "none")
    spread = whole / (h.size - 1)
    alike, by_fineness = np.full(h.size, 1 / h.size), (1 / h) / (1 / h).sum()
    orders = [(best_order(h, value, weights), weights) for weights in (alike, by_fineness)]
    powers_of = {"h": [1], "h^2": [2], "h + h^2": [1, 2]}
    seen = [(order, fitted(h, value, weights, [order])) for order, weights in orders if not math.isnan(order)]
    order = min(seen, key=scatter_of)[0] if seen else math.nan
    believed = [one for one in seen if LEAST_ORDER <= one[0] <= LARGEST_ORDER]
    if believed:
        order, fit = min(believed, key=scatter_of)
        form = "h^p"
    else:
        # Faster than order 2: one of the orders that theory has. Slower than 0.5, or none: their sum as well, where
        # there are values left to tell its scatter.
        forms = ["h", "h^2"] if order > LARGEST_ORDER or h.size < 4 else ["h", "h^2", "h + h^2"]
        form, fit = min(((form, fitted(h, value, weights, powers_of[form]))
                         for form in forms for weights in (alike, by_fineness)), key=scatter_of)
    limit, error, scatter, off = fit
    if scatter < spread:
        # The order of three values is found from them alone: no scatter can show that it is chance.
        is_safe = form == "h^p" and h.size > 3
        uncertainty = (SAFE if is_safe else UNSAFE) * abs(error) + scatter + off
    else:
        uncertainty = 3 * scatter / spread * (abs(error) + scatter + off)
    return Extrapolation(limit, order, error, scatter, spread, uncertainty, form)


def chance_of(values) -> float:
    """Within how much of it one value is of the mean of all such, 95 times of 100, from a few that differ by chance
    alone; nan of less than two."""
    values = np.asarray(values, dtype=float)
    if values.size < 2:
        return math.nan
    factor = STUDENT[min(values.size - 1, len(STUDENT)) - 1]
    return factor * float(values.std(ddof=1))


def amplification(spacings) -> float:
    """By how much chance in values at these spacings is larger in the limit of a straight line through them."""
    h = np.asarray(spacings, dtype=float)
    away = h - h.mean()
    weights = 1 / h.size - h.mean() * away / (away @ away)
    return max(1.0, float(np.linalg.norm(weights)))


@dataclass(frozen=True)
class Estimate:
    """One number with an interval: `value` is that of the finest spacing."""

    value: float
    uncertainty: float  # either way: the root of the sum of the squares of the three
    limit: float
    order: float
    discretisation: float
    chance: float  # nan where no run from another start says it
    step: float  # likewise, by half of the time step
    form: str
    notes: list = field(default_factory=list)

    @property
    def low(self) -> float:
        return self.value - self.uncertainty

    @property
    def high(self) -> float:
        return self.value + self.uncertainty


def estimate(spacings, values, *, starts=(), step=None) -> Estimate:
    """`values` at `spacings`; `starts`, the values of one spacing from several starts; `step`, the two at one spacing
    with the time step and half of it. What chance does to a value it does more to a limit. Throws as `extrapolate`."""
    found = extrapolate(spacings, values)
    chance = chance_of(starts) * amplification(spacings)
    of_step = abs(step[0] - step[1]) if step else math.nan
    parts = [found.uncertainty, *(part for part in (chance, of_step) if not math.isnan(part))]
    value = float(np.asarray(values, dtype=float)[int(np.argmin(spacings))])
    notes = []
    if found.form == "none":
        notes.append("all spacings give one value")
    elif math.isnan(found.order):
        notes.append("no order: the values do not come nearer to a limit")
    elif found.form != "h^p":
        notes.append(f"the observed order is not between {LEAST_ORDER:g} and {LARGEST_ORDER:g}: {found.form} is taken")
    if found.scatter >= found.spread > 0:
        notes.append("the values scatter as much as they change with the spacing")
    if len(values) == 3 and found.form == "h^p":
        notes.append("three spacings give an order that nothing confirms")
    if not math.isnan(chance) and found.spread > 0 and chance > abs(found.error) + found.scatter:
        notes.append("chance is more than the spacing does: longer means help, finer spacings do not")
    return Estimate(value, math.hypot(*parts), found.limit, found.order, found.uncertainty, chance, of_step, found.form,
                    notes)
