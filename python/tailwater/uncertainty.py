"""Estimates limit, order and interval of a number that was computed at several spacings.

`estimate` is a probabilistic Richardson extrapolation (Oates, Karvonen, Teckentrup, Strocchi, Niederer 2024,
Probabilistic Richardson extrapolation, arXiv:2401.07562). It includes random errors of the values (Oliver, Malaya,
Ulerich, Moser 2014, Estimating uncertainties in statistics computed from direct numerical simulation, Phys. Fluids 26,
035101). `extrapolate` is the method of L. Eca and M. Hoekstra, A procedure for the estimation of the numerical
uncertainty of CFD calculations based on grid refinement studies, J. Comput. Phys. 262 (2014) 104-130.
docs/theory/uncertainty.md describes both, with their limits."""

import math
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import product

import numpy as np

from .errors import DataError

__all__ = ["Estimate", "Extrapolation", "estimate", "extrapolate"]

LEAST_ORDER, LARGEST_ORDER = 0.5, 2.0  # range of observed orders that are used for extrapolation
FAST_ORDER = 3.0  # above it, values converge faster than the errors of `hypotheses`
SAFE, UNSAFE = 1.25, 3.0  # safety factors on the estimated error
ORDERS = np.linspace(0.05, 8.0, 160)  # trial orders of the search, before refinement
# Prior hypotheses of `estimate`, all equally probable. An error is a sum of TERMS powers of the spacing; the lowest
# power is 0.5 or 1, each further one is higher by 1.
FIRST_POWERS, TERMS = (0.5, 1.0), 3
SIZES = np.geomspace(0.3, 30.0, 9)  # sizes of the terms at the coarsest spacing, over the range of the values
STEPS = (0.01, 0.1, 1.0)  # error of the time step at the coarsest spacing, over that size
# scatter of values about such an error, over its size, due to the arrangement of particles at walls
SCATTERS = (0.02, 0.06, 0.2, 0.6)
CHANCES = np.geomspace(1e-3, 2.0, 10)  # standard deviation of one run, over the range of the values
UNEVEN = 0.4  # scatter over the size of an error, above which finer spacings do not narrow the interval
# standard deviations; the range of seven values that differ only by chance is smaller with a probability of 95 %
HIDDEN = 4.2
CERTAIN = 0.95  # probability that the limit lies within the interval
ROUNDING = 1e-12  # relative to the values; a smaller range counts as equal values


@dataclass(frozen=True)
class Extrapolation:
    """Extrapolation from values at several spacings; the finest is the first."""

    limit: float  # at spacing 0
    order: float  # observed order; nan if no order between 0 and 8 fits
    error: float  # of the finest value by the fit: fit - limit
    scatter: float  # of the values about the fit
    spread: float  # range of the values per interval between spacings
    uncertainty: float  # half width for the finest value
    form: str  # of the fitted error: "h^p", "h", "h^2", "h + h^2", or "none" if all values are equal


def fitted(h, value, weights, powers):
    """Fits a limit and a sum of powers of h. Returns (limit, error at the finest spacing, scatter, distance of the
    finest value from the fit)."""
    rows = np.column_stack([np.ones_like(h), *(h**power for power in powers)])
    root = np.sqrt(weights)
    coefficients = np.linalg.lstsq(rows * root[:, None], value * root, rcond=None)[0]
    left = rows @ coefficients - value
    free = max(len(h) - len(powers) - 1, 0)
    scatter = math.sqrt(len(h) * float(weights @ left**2) / free) if free else 0.0
    return float(coefficients[0]), float(rows[0, 1:] @ coefficients[1:]), scatter, abs(float(left[0]))


def misfits(orders, h, value, weights):
    """The weighted sum of squared residuals of a straight line over h^order, for each of the orders."""
    x = (h / h[0]) ** np.asarray(orders)[:, None]
    x = x - (x @ weights)[:, None]
    y = value - weights @ value
    return weights @ y**2 - (x @ (weights * y)) ** 2 / (x**2 @ weights)


def best_order(h, value, weights):
    """The order of the single power that fits best; nan if it is at an end of the range of trial orders."""
    orders = ORDERS
    for _ in range(4):
        k = int(np.argmin(misfits(orders, h, value, weights)))
        if k in (0, len(orders) - 1):
            return math.nan
        found = float(orders[k])
        orders = np.linspace(orders[k - 1], orders[k + 1], 41)
    return found


def scatter_of(named):
    """The scatter of a pair (name, fit)."""
    return named[1][2]


def extrapolate(spacings, values) -> Extrapolation:
    """Extrapolates three values or more. Throws DataError for fewer, and for values that are not finite."""
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
        # Above order 2: one of the theoretical orders. Below 0.5, or without an order: also the sum of both powers, if
        # enough values remain to estimate the scatter.
        forms = ["h", "h^2"] if order > LARGEST_ORDER or h.size < 4 else ["h", "h^2", "h + h^2"]
        form, fit = min(((form, fitted(h, value, weights, powers_of[form]))
                         for form in forms for weights in (alike, by_fineness)), key=scatter_of)
    limit, error, scatter, off = fit
    if scatter < spread:
        # With three values the order fits them exactly, so that no scatter can show whether the order is random.
        is_safe = form == "h^p" and h.size > 3
        uncertainty = (SAFE if is_safe else UNSAFE) * abs(error) + scatter + off
    else:
        uncertainty = 3 * scatter / spread * (abs(error) + scatter + off)
    return Extrapolation(limit, order, error, scatter, spread, uncertainty, form)


@dataclass(frozen=True)
class Hypotheses:
    """Possible models of values at some spacings, one per entry. In each model the mean of the limit is `weights @
    values`."""

    weights: np.ndarray  # [entry, spacing]
    deviation: np.ndarray  # standard deviation of the limit
    misfit: np.ndarray  # [entry, spacing, spacing]: values @ misfit @ values is the sum of squared residuals
    evidence: np.ndarray  # logarithm of the likelihood, without the misfit
    chance: np.ndarray  # standard deviation of one run
    of_chance: np.ndarray  # standard deviation of the limit due to `chance`
    scatter: np.ndarray  # over the size of the error


@lru_cache(maxsize=8)
def hypotheses(h, steps, counts):
    """The hypotheses for values with a range of about 1. The values are means of `counts` runs at the spacings `h`,
    with time steps that are `steps` times the usual one. The prior of the limit is flat; all other priors are
    Gaussian."""
    x = np.array(h) / max(h)
    of_step, is_same = np.outer(x * steps, x * steps), x[:, None] == x
    covariances, chances, scatters = [], [], []
    for first, size, step, scatter, chance in product(FIRST_POWERS, SIZES, STEPS, SCATTERS, CHANCES):
        terms = x[:, None] ** (first + np.arange(TERMS))
        covariances.append(size**2 * (terms @ terms.T + step**2 * of_step + scatter**2 * is_same)
                           + chance**2 * np.diag(1 / np.array(counts)))
        chances.append(chance)
        scatters.append(scatter)
    covariance, chance = np.array(covariances), np.array(chances)
    inverse = np.linalg.inv(covariance)
    row = inverse.sum(axis=1)
    total = row.sum(axis=1)
    weights = row / total[:, None]
    return Hypotheses(weights, 1 / np.sqrt(total), inverse - row[:, :, None] * weights[:, None, :],
                      -0.5 * (np.linalg.slogdet(covariance)[1] + np.log(total)), chance,
                      chance * np.sqrt(weights**2 @ (1 / np.array(counts))), np.array(scatters))


def quantile(share, weights, means, deviations):
    """Quantile of a mixture of normal distributions, by Newton's method, with bisection where a step leaves the
    bracket."""
    low, high = float((means - 9 * deviations).min()), float((means + 9 * deviations).max())
    enough, place = 1e-12 * (high - low), float(weights @ means)
    while high - low > enough:
        z = (means - place) / deviations
        below = weights @ [0.5 * math.erfc(one) for one in z / math.sqrt(2)]
        low, high = (place, high) if below < share else (low, place)
        density = float((weights / deviations) @ np.exp(-0.5 * z**2)) / math.sqrt(2 * math.pi)
        step = (share - below) / density if density > 0 else math.inf
        if abs(step) <= enough:
            return place
        place = place + step if low < place + step < high else 0.5 * (low + high)
    return place


@dataclass(frozen=True)
class Limit:
    """Distribution of the limit of several values."""

    mean: float
    low: float
    high: float
    chance: float  # random part of (high - low)/2, in quadrature; nan without values from other starts
    discretisation: float  # the other part of (high - low)/2
    scatter: float  # of the values from spacing to spacing, over the size of their error


def limit_of(h, steps, means, counts, variance, freedom) -> Limit:
    """The limit for the means of `counts` runs at each of the spacings `h`, with time steps that are `steps` times the
    usual one. `variance`, that of one run, was estimated with `freedom` degrees of freedom, which may be 0."""
    scale = max(float(np.ptp(means)), math.sqrt(variance))
    if scale <= ROUNDING * float(abs(means).max()):
        return Limit(float(means[0]), float(means[0]), float(means[0]), 0.0 if freedom else math.nan, 0.0, 0.0)
    known = hypotheses(tuple(h), tuple(steps), tuple(counts))
    value, squares = (means - means[0]) / scale, variance / scale**2
    evidence = (known.evidence - 0.5 * np.einsum("i,kij,j->k", value, known.misfit, value)
                - 0.5 * freedom * (2 * np.log(known.chance) + squares / known.chance**2))
    weights = np.exp(evidence - evidence.max())
    kept = weights > 1e-5
    weights = weights[kept] / weights[kept].sum()
    at, deviation, of_chance = known.weights[kept] @ value, known.deviation[kept], known.of_chance[kept]
    mean = float(weights @ at)
    low, high = (quantile(share, weights, at, deviation) for share in (0.5 - 0.5 * CERTAIN, 0.5 + 0.5 * CERTAIN))
    share = float(weights @ of_chance**2) / float(weights @ (deviation**2 + (at - mean)**2)) if freedom else 0.0
    half = 0.5 * scale * (high - low)
    return Limit(float(means[0]) + scale * mean, float(means[0]) + scale * low, float(means[0]) + scale * high,
                 half * math.sqrt(share) if freedom else math.nan, half * math.sqrt(max(0.0, 1 - share)),
                 float(weights @ known.scatter[kept]))


def bounded_limit(limit, h, value):
    """The limit, but for steady convergence above FAST_ORDER no farther from the finest value than LARGEST_ORDER
    extrapolates the change between the two finest spacings. The finest value is the first. The errors of `hypotheses`
    fit such values by terms that compensate each other and grow beyond the values below the finest spacing."""
    order = ORDERS[int(np.argmin(misfits(ORDERS, h, value, np.full(h.size, 1 / h.size))))]
    changes = np.diff(value)
    if order <= FAST_ORDER or not (np.all(changes > 0) or np.all(changes < 0)):
        return limit
    farthest = abs(changes[0]) / ((h[1] / h[0])**LARGEST_ORDER - 1)
    return float(np.clip(limit, value[0] - farthest, value[0] + farthest))


@dataclass(frozen=True)
class Estimate:
    """A number with an interval that contains its limit with a probability of 95 %."""

    value: float  # of the finest spacing
    low: float
    high: float
    limit: float  # mean of the distribution of the limit, bounded if the values converge fast
    order: float  # observed order; nan if none
    discretisation: float  # part of the half width of the interval; adds to `chance` and `averaging` in quadrature
    chance: float  # random part of the half width; nan if there is no run from another start
    averaging: float  # part of the half width due to a finite averaging time; nan if unknown
    step: float  # change by half of the time step, a part of the discretisation; nan if no run has it
    eca_hoekstra: float  # half width of the uncertainty of `value` by the method of Eca & Hoekstra
    notes: list = field(default_factory=list)

    @property
    def uncertainty(self) -> float:
        """Half of the width of the interval."""
        return 0.5 * (self.high - self.low)


def notes_on(found, order, is_hidden, step, averaging):
    """Advice on a Limit; `is_hidden` if all differences of the values may be random."""
    half = 0.5 * (found.high - found.low)
    if half == 0:
        return ["all spacings give one value"]
    notes = ["no order: the values do not converge"] if math.isnan(order) else []
    if averaging > half:
        notes.append("mostly the averaging time: a later time.end narrows the interval")
    elif is_hidden:
        notes.append("the values differ by no more than chance: longer means and more starts narrow the interval")
    elif found.chance > found.discretisation:
        notes.append("mostly chance: longer means and more starts narrow the interval")
    elif found.scatter > UNEVEN:
        notes.append("the values scatter from spacing to spacing, more than from start to start: more spacings and longer "
                     "means narrow the interval")
    else:
        notes.append("mostly discretisation: finer spacings narrow the interval")
    if step > 0.5 * half:
        notes.append("half of the time step changes the value by much of it: a smaller scheme.courant narrows it, too")
    return notes


def estimate(spacings, values, *, starts=None, step=None, averaging=math.nan) -> Estimate:
    """Estimates the limit of `values` at `spacings`. `starts` is {spacing: all values at that spacing from different
    initial particle displacements}; `step` is (spacing, value with half of the time step). `averaging` is the half
    width due to a finite averaging time, an error that all values share. Throws DataError as `extrapolate`, and for
    starts or a step at another spacing."""
    starts = {spacing: np.asarray(each, dtype=float) for spacing, each in (starts or {}).items()}
    if others := {*starts, *(step[:1] if step else ())} - set(spacings):
        raise DataError(f"starts or a step at {min(others):g}, a spacing that has no value")
    means = np.array([starts[h].mean() if h in starts else value for h, value in zip(spacings, values)], dtype=float)
    eca_hoekstra = extrapolate(spacings, means)
    freedom = sum(len(each) - 1 for each in starts.values())
    variance = sum(float(each.var()) * len(each) for each in starts.values()) / freedom if freedom else 0.0
    # The finest value is the first, the one with half of the time step the last.
    members = [(float(h), 1.0, mean, len(starts.get(h, [0]))) for h, mean in sorted(zip(spacings, means))]
    of_step = math.nan
    if step:
        of_step = abs(float(means[list(spacings).index(step[0])]) - step[1])
        if not math.isfinite(of_step):
            raise DataError("the value with half of the time step is not a finite number")
        members.append((float(step[0]), 0.5, step[1], 1))
    h, steps, of_members, counts = zip(*members)
    found = limit_of(h, steps, np.array(of_members), counts, variance, freedom)
    is_hidden = np.ptp(means) < HIDDEN * math.sqrt(variance)
    finest_first = np.argsort(spacings)
    limit = bounded_limit(found.mean, np.array(spacings, dtype=float)[finest_first], means[finest_first])
    half = 0.5 * (found.high - found.low)
    wider = math.hypot(half, averaging) - half if averaging > 0 else 0.0
    return Estimate(float(values[int(np.argmin(spacings))]), found.low - wider, found.high + wider, limit,
                    eca_hoekstra.order, found.discretisation, found.chance, averaging, of_step,
                    eca_hoekstra.uncertainty,
                    notes_on(found, eca_hoekstra.order, is_hidden, of_step, averaging))
