#!/usr/bin/python3
"""Made-up readings whose long-time mean is 0: the fraction of intervals of their mean over a finite time that contain it,
and the widths of the intervals.

Usage: PYTHONPATH=python tests/python/made_up_means.py [COUNT]    prints the table of docs/theory/uncertainty.md; 2 minutes
"""
import math
import sys

import numpy as np
from scipy.signal import lfilter
from scipy.stats import t as student
from tailwater.finite_time import MAX_BLOCKS, error_of_time_mean

TIME = np.linspace(0, 1, 401)  # over the averaging time


def noise(correlation, random):
    """Noise with a standard deviation of 1 and an exponential correlation."""
    kept = math.exp(-TIME[1] / correlation)
    steps = random.normal(size=TIME.size) * np.where(TIME > 0, math.sqrt(1 - kept**2), 1)
    return lfilter([1], [1, -kept], steps)


def sine(periods, random):
    return np.sin(2 * math.pi * (periods * TIME + random.uniform()))


def approach(decay, random, of_noise=0.01, correlation=0.01):
    return np.exp(-TIME / decay) + of_noise * noise(correlation, random)


# By the time of correlation or decay, or the number of periods, in the averaging time.
SIGNALS = {
    "noise, correlated over 0.003": lambda random: noise(0.003, random),
    "noise, 0.01": lambda random: noise(0.01, random),
    "noise, 0.03": lambda random: noise(0.03, random),
    "noise, 0.1": lambda random: noise(0.1, random),
    "noise, 0.3": lambda random: noise(0.3, random),
    "sine, 1 period": lambda random: sine(1, random),
    "sine, 1.5 periods": lambda random: sine(1.5, random),
    "sine, 3 periods": lambda random: sine(3, random),
    "sine, 10 periods": lambda random: sine(10, random),
    "sine, 1 to 4 periods": lambda random: sine(random.uniform(1, 4), random),
    "the same and 0.3 noise, 0.01": lambda random: sine(random.uniform(1, 4), random) + 0.3 * noise(0.01, random),
    "sine, 0.5 to 1 period": lambda random: sine(random.uniform(0.5, 1), random),
    "two sines": lambda random: sine(random.uniform(1, 4), random) + 0.5 * sine(random.uniform(2, 6), random),
    "sine that decays, 2.3 periods": lambda random: sine(2.3, random) * np.exp(-TIME / 0.7),
    "approach, 0.1": lambda random: approach(0.1, random),
    "approach, 0.3": lambda random: approach(0.3, random),
    "approach, 0.5": lambda random: approach(0.5, random),
    "approach, 0.5, and 0.1 noise, 0.01": lambda random: approach(0.5, random, 0.1),
    "approach, 0.5, and 0.3 noise, 0.03": lambda random: approach(0.5, random, 0.3, 0.03),
    "approach, 1": lambda random: approach(1, random),
    "approach, 2": lambda random: approach(2, random),
    "approach, 0.3, and 0.3 sine, 1.5": lambda random: approach(0.3, random) + 0.3 * sine(1.5, random),
    "approach, 0.5, and 0.3 sine, 5, and 0.1 noise": lambda random: approach(0.5, random, 0.1) + 0.3 * sine(5, random),
    "linear drift by 1, truth 1 beyond the mean": lambda random: TIME - 1.5 + 0.01 * noise(0.01, random),
}


def block_means(readings, count):
    sums = np.append(0, np.cumsum(0.5 * (readings[1:] + readings[:-1]) * np.diff(TIME)))
    return np.diff(np.interp(np.linspace(0, 1, count + 1), TIME, sums)) * count


def of_quarters(readings):
    """The half width by Student's t from the scatter of four means, as before December 2026."""
    return float(student.ppf(0.975, 3) * block_means(readings, 4).std(ddof=1) / 2)


def of_models(readings):
    return error_of_time_mean(block_means(readings, MAX_BLOCKS))


def shares(signal, half_width, count, seed=1):
    """For `count` series, the fraction of intervals that contain 0, their median half width, and the 95 % quantile of the
    magnitude of the mean."""
    random = np.random.default_rng(seed)
    means, widths = [], []
    for _ in range(count):
        readings = signal(random)
        means.append(abs(block_means(readings, 1)[0]))
        widths.append(half_width(readings))
    return np.mean(np.array(means) <= widths), np.median(widths), np.quantile(means, 0.95)


def main(count=400):
    print("| readings | error | of quarters | of models |\n| --- | --- | --- | --- |")
    for name, signal in SIGNALS.items():
        before, after = (shares(signal, half_width, count) for half_width in (of_quarters, of_models))
        cells = " | ".join(f"{100 * inside:.0f} %, {width:.2g}" for inside, width, _ in (before, after))
        print(f"| {name} | {after[2]:.2g} | {cells} |", flush=True)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
