"""Numbers that compare curves over time. Times and values keep the units of the given curves."""

import numpy as np

from tailwater.errors import DataError

# Fraction of a window that two curves must both cover to be compared over it. Less would compare other events.
LEAST_COVERAGE = 0.95
# Samples inside the running median's width below which it follows the noise itself.
LEAST_MEDIAN_SAMPLES = 5


def differences(a, b, start, end, step):
    """b - a on a uniform grid from `start` to `end`, where both curves have values (linear between samples)."""
    first = max(start, a.time[0], b.time[0])
    last = min(end, a.time[-1], b.time[-1])
    if last - first < LEAST_COVERAGE * (end - start):
        raise DataError(f"the curves share only {first:.3g}..{last:.3g} of the window {start:.3g}..{end:.3g}"
                        if last > first else f"the curves share nothing of the window {start:.3g}..{end:.3g}")
    times = np.linspace(first, last, int(np.ceil((last - first) / step)) + 1)
    return np.interp(times, b.time, b.value) - np.interp(times, a.time, a.value)


def rms_difference(a, b, start, end, step):
    """Root of the mean square of b - a over the window, on a uniform grid of `step`."""
    return float(np.sqrt(np.mean(differences(a, b, start, end, step) ** 2)))


def best_shift(measured, computed, start, end, step, limit, trials=121):
    """(delay, rms): the delay of the measured curve, at most `limit` either way, with the smallest rms difference,
    and that rms. The window stays on the measured curve, which may end at the end of the window."""
    delays = np.linspace(-limit, limit, trials)
    scores = [rms_difference(measured, computed.shifted(-delay), start, end, step) for delay in delays]
    best = int(np.argmin(scores))
    return float(delays[best]), scores[best]


def compare(measured, computed, window, step, limit):
    """{value, shifted_value, shift} for a Metric: the RMS difference over the window (times of the measured curve)
    without a shift, and that with the best shift within the uncertainty of the measured time."""
    shift, shifted = best_shift(measured, computed, *window, step, limit)
    return {"value": rms_difference(measured, computed, *window, step), "shifted_value": shifted, "shift": shift}


def arrival_time(pressure, threshold, not_before=-np.inf):
    """Time of the first sample above `threshold` at or after `not_before`; None if there is none."""
    arrived = (pressure.value > threshold) & (pressure.time >= not_before)
    return float(pressure.time[np.argmax(arrived)]) if arrived.any() else None


def passage_time(curve, level):
    """Time at which the curve first rises through `level`, linear between samples."""
    above = curve.value >= level
    if not above.any() or above[0]:
        raise DataError(f"the curve does not rise through {level:.3g}")
    k = int(np.argmax(above))
    share = (level - curve.value[k - 1]) / (curve.value[k] - curve.value[k - 1])
    return float(curve.time[k - 1] + share * (curve.time[k] - curve.time[k - 1]))


def first_peak(pressure, arrival, within):
    """(time, value) of the largest sample from `arrival` until `within` later."""
    impact = pressure.window(arrival, arrival + within)
    if impact.time.size == 0 or pressure.time[-1] < arrival + within:
        raise DataError(f"the curve ends before the first peak is over, at {arrival + within:.3g}")
    highest = int(np.argmax(impact.value))
    if highest == impact.time.size - 1:
        raise DataError(f"no peak: the pressure still rises {within:g} after the arrival")
    return float(impact.time[highest]), float(impact.value[highest])


def running_median(curve, width):
    """Median of the samples within `width`/2 of each sample."""
    first = np.searchsorted(curve.time, curve.time - width / 2, side="left")
    last = np.searchsorted(curve.time, curve.time + width / 2, side="right")
    return np.array([np.median(curve.value[i:j]) for i, j in zip(first, last)])


def noise(curve, start, end, width):
    """RMS difference between the samples from `start` to `end` and their running median of `width`."""
    if curve.time[0] > start or curve.time[-1] < end:
        raise DataError(f"the curve does not cover the window {start:.3g}..{end:.3g}")
    margin = curve.window(start - width, end + width)
    inside = (margin.time >= start) & (margin.time <= end)
    if np.count_nonzero(inside) * width < LEAST_MEDIAN_SAMPLES * (end - start):
        raise DataError(f"fewer than {LEAST_MEDIAN_SAMPLES} samples in the running median of {width:.3g}: "
                        "write the probe at every step")
    rest = (margin.value - running_median(margin, width))[inside]
    return float(np.sqrt(np.mean(rest**2)))
