"""The error of a mean over a finite time (docs/theory/uncertainty.md)."""

import itertools
import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from .uncertainty import CERTAIN, quantile

__all__ = ["error_of_time_mean"]

MAX_BLOCKS = 32
# Times are fractions of the averaging time, frequencies are periods in that time.
CORRELATION_TIMES = (0, 1 / 32, 1 / 16, 1 / 8, 1 / 4)  # of the noise
DECAY_TIMES = tuple(2 ** np.linspace(-3.5, 0, 12))  # of the approach to the limit
FREQUENCIES = np.concatenate([np.arange(0.4, 1, 0.02), np.arange(1, 2, 0.05), np.arange(2, 4, 0.1), np.arange(4, 15, 0.25)])
P_APPROACH, P_OSCILLATION = 0.1, 0.1  # probabilities a priori
MISFIT = 1e-3  # least sum of squared residuals over the squared range, since no flow follows a model exactly


@dataclass(frozen=True)
class Models:
    """Models of the means of equal blocks of time, each with its fit by generalised least squares."""

    whiten: np.ndarray  # (c, n, n), whose products with the means have independent noise, for each correlation time
    correlation: np.ndarray  # (k), the index of the correlation time
    weights: np.ndarray  # (k, n), which turn the means of the blocks into the long-time mean
    fitted: np.ndarray  # (k, 4, n), whose products with the means are the fitted part of those of `whiten`
    variance: np.ndarray  # of the long-time mean, over that of the noise
    freedom: np.ndarray  # blocks less fitted numbers
    evidence: np.ndarray  # log of the prior, and of the part of the evidence that does not depend on the means


@lru_cache(maxsize=4)
def models(n) -> Models:
    """All models for `n` blocks."""
    ends = np.linspace(0, 1, n + 1)
    distance = np.abs(np.subtract.outer(np.arange(n), np.arange(n))) / n
    whitens = [np.linalg.inv(np.linalg.cholesky(np.exp(-distance / time))) if time else np.eye(n)
               for time in CORRELATION_TIMES]
    frequencies = FREQUENCIES[FREQUENCIES < 0.47 * n]
    found = []
    for (c, whiten), decay, frequency in itertools.product(enumerate(whitens), (None, *DECAY_TIMES),
                                                           (None, *frequencies)):
        columns = [np.ones(n)]
        if decay:
            columns.append(-np.diff(np.exp(-ends / decay)) * n)
        if frequency:
            angle = 2 * math.pi * frequency * ends
            columns += [np.diff(np.sin(angle)) * n, np.diff(np.cos(angle)) * n]
        basis, triangle = np.linalg.qr(whiten @ np.array(columns).T)
        first = np.linalg.inv(triangle)[0]
        fitted = np.zeros((4, n))
        fitted[:len(columns)] = basis.T @ whiten
        prior = ((P_APPROACH / len(DECAY_TIMES) if decay else 1 - P_APPROACH)
                 * (P_OSCILLATION / len(frequencies) if frequency else 1 - P_OSCILLATION))
        found.append((c, first @ basis.T @ whiten, fitted, first @ first, n - len(columns),
                      math.log(prior) + np.log(np.diag(whiten)).sum() - 0.5 * len(columns) * math.log(n)))
    return Models(np.array(whitens), *map(np.array, zip(*found)))


def error_of_time_mean(means) -> float:
    """Half width of the interval around the mean of equal blocks of time that contains the long-time mean with a
    probability of 95 %. `means` are those of the blocks."""
    means = np.asarray(means, dtype=float)
    scale = float(np.ptp(means))
    if scale == 0:
        return 0.0
    known = models(means.size)
    value = (means - means.mean()) / scale
    whole = ((known.whiten @ value)**2).sum(axis=1)[known.correlation]
    squares = np.maximum(whole - ((known.fitted @ value)**2).sum(axis=1), 0) + MISFIT
    evidence = known.evidence - 0.5 * means.size * np.log(squares)
    weights = np.exp(evidence - evidence.max())
    kept = weights > 1e-5
    weights = weights[kept] / weights[kept].sum()
    # Student's distributions of these degrees of freedom, as normal ones of equal variance.
    deviations = np.sqrt(squares[kept] * known.variance[kept] / (known.freedom[kept] - 2))
    places = known.weights[kept] @ value
    return scale * max(abs(quantile(share, weights, places, deviations))
                       for share in (0.5 - 0.5 * CERTAIN, 0.5 + 0.5 * CERTAIN))
