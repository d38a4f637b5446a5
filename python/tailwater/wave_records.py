"""Analysis of wave records: heights, harmonics, incident and reflected waves, response, drift, overtopping.

All functions take numpy arrays in SI units and need no run. A complex amplitude A stands for Re(A exp(i omega t)), so a wave
a cos(omega t - k x) has the amplitude a exp(-i k x)."""

from dataclasses import dataclass

import numpy as np

from .errors import DataError

# Frequencies between these multiples of the peak frequency are separated into incident and reflected waves.
BAND = (0.5, 1.8)
# Gauges half a wavelength apart, or almost at one place, cannot separate incident and reflected waves. The smallest singular
# value of the fit, over its largest possible value, must exceed MIN_DETERMINED. Other frequencies are left out. If they have
# more than MAX_LOSS of the energy, the separation fails.
MIN_DETERMINED = 0.1
MAX_LOSS = 0.2
# Wave numbers that are tried for waves of finite height, over the wave number of linear theory.
WAVE_NUMBER_FACTORS = np.linspace(0.8, 1.15, 141)
# Bound waves of a larger fraction of the waves that bind them are beyond third-order theory and left out.
MAX_BOUND = 0.2
BOUND_ROUNDS = 6
# Periods are searched for within this fraction of the mean period between up-crossings.
PERIOD_RANGE = 0.05
# Quantiles 0.975 of Student's t for 1, 2, ... degrees of freedom; `student` continues with the expansion for large numbers.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228)
# A trend of a record is removed if it is significant and its rise exceeds this fraction of the rms of the record; a smaller one
# has less than 0.1 % of the energy.
MIN_RISE = 0.1
# Frequencies in one band of a response.
LINES_PER_BAND = 8


def wave_numbers(frequency, depth, gravity):
    """Wave numbers (1/m) of frequencies (Hz): omega^2 = g k tanh kh, by Newton's method."""
    target = (2 * np.pi * np.asarray(frequency, dtype=float)) ** 2 * depth / gravity
    y = target / np.sqrt(np.tanh(target))
    for _ in range(20):
        tanh_y = np.tanh(y)
        y += (target - y * tanh_y) / (tanh_y + y * (1 - tanh_y**2))
    return y / depth


def up_crossings(time, elevation):
    """Times at which the elevation rises through 0, linear between samples, and the samples before them."""
    k = np.flatnonzero((elevation[:-1] < 0) & (elevation[1:] >= 0))
    return time[k] - elevation[k] * (time[k + 1] - time[k]) / (elevation[k + 1] - elevation[k]), k


def single_waves(time, elevation):
    """(height, period) of each wave between two up-crossings."""
    crossings, k = up_crossings(time, elevation)
    heights = [elevation[i + 1:j + 1].max() - elevation[i + 1:j + 1].min() for i, j in zip(k[:-1], k[1:])]
    return np.array(heights), np.diff(crossings)


def spectrum(time, elevation):
    """(frequency, density): the periodogram, m^2/Hz, without the mean. The window holds whole waves or is long."""
    n, step = elevation.size, time[1] - time[0]
    amplitude = np.fft.rfft(elevation - elevation.mean()) / n
    density = 2 * np.abs(amplitude) ** 2 * n * step
    return np.fft.rfftfreq(n, step), density


@dataclass(frozen=True)
class Harmonics:
    """`amplitude` has the complex amplitudes of 1, 2, ... times the frequency; `residual` is the rms of the rest."""

    period: float
    mean: float
    amplitude: np.ndarray
    residual: float

    def phases(self):
        """Phases (deg) phi of a cos(n omega t - phi), and phi_n - n phi_1, which does not depend on the origin of time."""
        phase = -np.angle(self.amplitude)
        relative = phase - np.arange(1, phase.size + 1) * phase[0]
        return np.degrees(phase), (np.degrees(relative) + 180) % 360 - 180


def fit_harmonics(time, value, period, count=5):
    """Least squares of the mean and `count` harmonics of a known period. The window may hold any number of periods from one
    on, whole or not. Throws DataError for shorter ones."""
    if time[-1] - time[0] < 0.999 * period:
        raise DataError(f"the window of {time[-1] - time[0]:.4g} s is shorter than the period of {period:.4g} s")
    count = max(1, min(count, (time.size - 1) // 4))
    angle = 2 * np.pi * (time - time[0]) / period
    shapes = [np.ones_like(angle)] + [wave(n * angle) for n in range(1, count + 1) for wave in (np.cos, np.sin)]
    matrix = np.stack(shapes, axis=1)
    found = np.linalg.lstsq(matrix, value, rcond=None)[0]
    shift = np.exp(-2j * np.pi * np.arange(1, count + 1) * time[0] / period)
    residual = float(np.sqrt(np.mean((matrix @ found - value) ** 2)))
    return Harmonics(float(period), float(found[0]), (found[1::2] - 1j * found[2::2]) * shift, residual)


def best_period(time, value, guess):
    """The period (s) within PERIOD_RANGE of a guess whose harmonics fit a record best."""
    low, high = (1 - PERIOD_RANGE) * guess, min((1 + PERIOD_RANGE) * guess, time[-1] - time[0])
    for _ in range(4):
        periods = np.linspace(low, high, 17)
        best = int(np.argmin([fit_harmonics(time, value, period).residual for period in periods]))
        low, high = periods[max(best - 1, 0)], periods[min(best + 1, 16)]
    return float(periods[best])


def wave_shapes(position, wave_number):
    """Columns of a unit wave towards larger positions, and of one back."""
    return np.stack([np.exp(-1j * wave_number * position), np.exp(1j * wave_number * position)], axis=1)


def determined(shape):
    """The smallest singular value of a fit over its largest possible value: 0 if the gauges cannot separate the waves."""
    return np.linalg.svd(shape, compute_uv=False)[-1] / np.sqrt(shape.shape[0])


def refuse_gauges():
    raise DataError("the gauges stand half a wavelength apart, or much closer; remedy: place them at unequal distances, about a "
                    "tenth and a quarter of the wavelength apart")


def separate(position, time, elevations, depth, gravity, peak):
    """Waves towards larger positions, and back, by least squares over all gauges for each frequency.

    Two gauges: Y. Goda, Y. Suzuki (1976) *Estimation of incident and reflected waves in random wave experiments*, Proc. 15th
    Coastal Eng. Conf., 828-845. More: E.P.D. Mansard, E.R. Funke (1980) *The measurement of incident and reflected spectra
    using a least squares method*, Proc. 17th Coastal Eng. Conf., 154-172.
    Returns (frequencies in Hz, complex amplitudes in m of the waves there, and back, at position 0 and time[0])."""
    n, step = time.size, time[1] - time[0]
    frequency = np.fft.rfftfreq(n, step)
    amplitude = 2 * np.fft.rfft(elevations - elevations.mean(axis=1, keepdims=True), axis=1) / n
    chosen = np.flatnonzero((frequency >= BAND[0] * peak) & (frequency <= BAND[1] * peak))
    kept, found, lost = [], [], 0.0
    for m, k in zip(chosen, wave_numbers(frequency[chosen], depth, gravity)):
        shape = wave_shapes(position, k)
        if determined(shape) < MIN_DETERMINED:
            lost += (np.abs(amplitude[:, m]) ** 2).sum()
            continue
        kept.append(frequency[m])
        found.append(np.linalg.lstsq(shape, amplitude[:, m], rcond=None)[0])
    if lost > MAX_LOSS * (np.abs(amplitude[:, chosen]) ** 2).sum() or not kept:
        refuse_gauges()
    there, back = np.array(found).T
    return np.array(kept), there, back


@dataclass(frozen=True)
class RegularWaves:
    """Complex amplitudes (m) at position 0 of the waves there and back, and their wave number (1/m)."""

    there: complex
    back: complex
    wave_number: float


def bound_by_two_trains(there, back, wave_number, depth, position):
    """Complex amplitudes (m) at gauges of the waves of the same frequency and of three times the wave number that two trains
    bind to third order. Of the standing wave A cos(k x) cos(omega t) this is b13 cos(3 k x) cos(omega t): I. Tadjbakhsh, J.B.
    Keller (1960) *Standing surface waves of finite amplitude*, J. Fluid Mech. 8, 442-451. In deep water b13 = 9/32 k^2 A^3."""
    t = np.tanh(wave_number * depth) ** 2
    factor = 3 * wave_number**2 * (2 * t**4 + t**3 - 15 * t**2 + 27 * t + 9) / (64 * t**2)
    if factor * max(abs(there), abs(back)) ** 2 > MAX_BOUND:
        return np.zeros(position.size)
    return factor * wave_shapes(position, 3 * wave_number) @ [there**2 * np.conj(back), back**2 * np.conj(there)]


def least_misfit(position, amplitude, depth, wave_numbers_tried):
    """(misfit, RegularWaves) of the wave number with the least misfit; None if the gauges cannot separate any."""
    best = None
    for k in wave_numbers_tried:
        shape = wave_shapes(position, k)
        if determined(shape) < MIN_DETERMINED:
            continue
        inverse, bound = np.linalg.pinv(shape), 0.0
        for _ in range(BOUND_ROUNDS):
            found = inverse @ (amplitude - bound)
            bound = bound_by_two_trains(*found, k, depth, position)
        misfit = np.linalg.norm(shape @ found + bound - amplitude)
        if best is None or misfit < best[0]:
            best = misfit, RegularWaves(complex(found[0]), complex(found[1]), float(k))
    return best


def separate_regular(position, amplitude, wave_number, depth):
    """RegularWaves of the complex amplitudes at two or more gauges. With three or more the wave number has the least misfit
    near that of linear theory, because high waves are longer than linear waves; with two it is the one given. The waves that
    both trains bind are taken into account: high standing waves would otherwise seem a tenth too long."""
    tried = wave_number * WAVE_NUMBER_FACTORS if position.size > 2 else np.array([wave_number])
    best = least_misfit(position, amplitude, depth, tried)
    if best is None:
        refuse_gauges()
    if position.size > 2:
        step = tried[1] - tried[0]
        finer = least_misfit(position, amplitude, depth, best[1].wave_number + step * np.linspace(-1, 1, 41))
        best = min(best, finer, key=lambda one: one[0]) if finer else best
    return best[1]


def separate_second(position, amplitude, wave_number, free_wave_number):
    """Complex amplitudes of the second harmonic from four or more gauges: (bound there, bound back, free there, free back).
    Bound waves have twice the wave number of the first harmonic. None if the gauges cannot separate them."""
    if position.size < 4:
        return None
    shape = np.hstack([wave_shapes(position, 2 * wave_number), wave_shapes(position, free_wave_number)])
    if determined(shape) < 0.5 * MIN_DETERMINED:
        return None
    return np.linalg.lstsq(shape, amplitude, rcond=None)[0]


def student(freedom):
    """The quantile 0.975 of Student's t."""
    if freedom <= len(STUDENT):
        return STUDENT[max(int(freedom), 1) - 1]
    z, n = 1.959964, freedom
    return z + (z**3 + z) / (4 * n) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * n**2) \
        + (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / (384 * n**3)


def period_means(time, value, period):
    """(middle times, means) of whole consecutive periods at the end of a record, by trapezoids. A period that lacks one sample
    is whole."""
    count = max(1, int((time[-1] - time[0] + np.diff(time).max()) / period))
    edges = time[-1] - period * np.arange(count, -1, -1)
    rest = value - value.mean()
    integral = np.concatenate([[0.0], np.cumsum(0.5 * (rest[1:] + rest[:-1]) * np.diff(time))])
    return 0.5 * (edges[1:] + edges[:-1]), value.mean() + np.diff(np.interp(edges, time, integral)) / period


def correlation(values):
    """Correlation of consecutive values about 0, from 0 to 0.9; fewer than 8 values do not determine it."""
    if values.size < 8 or not values.any():
        return 0.0
    return float(np.clip((values[1:] * values[:-1]).sum() / (values**2).sum(), 0.0, 0.9))


def mean_with_interval(means):
    """(mean, half of the 95 % interval) of consecutive means, whose correlation widens the interval. nan for fewer than 3."""
    if means.size < 3:
        return float(means.mean()), float("nan")
    r = correlation(means - means.mean())
    effective = max(means.size * (1 - r) / (1 + r), 2.0)
    return float(means.mean()), float(student(effective - 1) * means.std(ddof=1) / np.sqrt(effective))


def drift_with_interval(time, means):
    """(slope, half of its 95 % interval) of a line through consecutive means. nan for fewer than 4."""
    t = time - time.mean()
    slope = float(t @ means / (t @ t)) if means.size > 1 else float("nan")
    if means.size < 4:
        return slope, float("nan")
    rest = means - means.mean() - slope * t
    r = correlation(rest)
    error = np.sqrt((rest**2).sum() / (means.size - 2) / (t @ t) * (1 + r) / (1 - r))
    return slope, float(student(means.size - 2) * error)


def trend_of(time, value, period):
    """Slope (per s) of a record through the means of its whole periods; 0 unless it is significant and large."""
    slope, interval = drift_with_interval(*period_means(time, value, period))
    is_large = abs(slope) * (time[-1] - time[0]) > MIN_RISE * value.std()
    return slope if abs(slope) > interval and is_large else 0.0


def without_trend(time, value, slope):
    """The record without a trend, with its mean."""
    return value - slope * (time - 0.5 * (time[0] + time[-1])) if slope else value


def response(frequency, incident, answer):
    """Response to irregular incident waves from complex amplitudes at the same frequencies, in bands of LINES_PER_BAND lines.

    Returns (frequencies, complex response, coherence). Only the coherence shows whether a band is an answer to the waves."""
    bands = np.array_split(np.arange(frequency.size), max(1, frequency.size // LINES_PER_BAND))
    power = np.array([(np.abs(incident[band]) ** 2).sum() for band in bands])
    cross = np.array([(answer[band] * incident[band].conj()).sum() for band in bands])
    own = np.array([(np.abs(answer[band]) ** 2).sum() for band in bands])
    centre = np.array([(frequency[band] * np.abs(incident[band]) ** 2).sum() for band in bands]) / power
    return centre, cross / power, np.abs(cross) ** 2 / np.maximum(power * own, 1e-300)


def overtopping_volumes(time, volume, pause):
    """(start times, volumes) of single overtopping events of a record of the volume that has passed.

    Events are separated by intervals of `pause` (s), a fraction of a wave period, during which less than a thousandth of the
    total volume passes."""
    total = volume[-1] - volume[0]
    if total <= 0:
        return np.empty(0), np.empty(0)
    rising = np.interp(time + pause, time, volume) - volume > 1e-3 * total
    starts = np.flatnonzero(rising & ~np.concatenate([[False], rising[:-1]]))
    ends = np.append(starts[1:], time.size - 1)
    return time[starts] + pause, volume[ends] - volume[starts]
