"""Regular and irregular waves along a flume: runs of cases/wave_flume."""

import numpy as np

from tailwater.errors import DataError
from tailwater.wave_records import BAND, fit_harmonics, separate, separate_regular, single_waves, wave_numbers
from tailwater.waves import Gauges

PERIODS = 5  # at the end of the run, in which waves are read
FAR = 10  # wavelengths over which the remaining height is reported
PEAK_ENHANCEMENT = 3.3  # of the JONSWAP spectrum; the default of the maker
MAKER = (0.5, 3.0)  # frequencies that the maker makes, over that of the peak
COMPONENTS = 200  # sines of a maker
# Frequencies over that of the peak between which the energy of irregular waves is compared: below, at and above the peak.
PARTS = (BAND[0], 0.9, 1.1, BAND[1])
DRAWS = 2000  # of a sea, for the scatter of its readings


class Group:
    """Gauges whose names begin with a letter, in the last periods of a run."""

    def __init__(self, run, letter):
        period, end = run.parameters["T"], run.case["time"]["end"]
        gauges = [probe for probe in run.case["probe"] if probe["type"] == "depth" and probe["name"].startswith(letter)]
        self.place = np.array([gauge["at"][0] for gauge in gauges])
        amplitudes, heights = [], []
        for gauge in gauges:
            curve = run.curve(gauge["name"], "highest_m")
            if curve.time[-1] < end - 0.1 * period:
                raise DataError(f"{run.path}: its gauge '{gauge['name']}' ends at {curve.time[-1]:.4g} s, the run at {end:.4g} s")
            curve = curve.window(end - PERIODS * period, end)
            amplitudes.append(fit_harmonics(curve.time, curve.value, period, count=3).amplitude[0])
            heights.append(single_waves(curve.time, curve.value - curve.value.mean())[0].mean())
        self.height = float(np.mean(heights))
        linear = float(wave_numbers(1 / period, run.parameters["h"], run.gravity))
        waves = separate_regular(self.place - self.place[0], np.array(amplitudes), linear, run.parameters["h"])
        self.there, self.back, self.wave_number = abs(waves.there), abs(waves.back), waves.wave_number


def wave_flume(run):
    """height_error: between crest and trough near the maker, over the height in the case, less 1. height_left: fraction
    of the first harmonic that ten wavelengths leave, by its decay between both groups of gauges. reflection: of the
    absorber."""
    near, far = Group(run, "a"), Group(run, "b")
    wavelengths = (far.place[0] - near.place[0]) / run.parameters["L"]
    return {"height_error": near.height / run.parameters["H"] - 1, "height_left": float((far.there / near.there) ** (FAR / wavelengths)),
            "reflection": float(far.back / far.there), "height_m": near.height, "height_far_m": far.height,
            "longer_than_linear": float(run.parameters["L"] * near.wave_number / (2 * np.pi)) ** -1 - 1}


def jonswap(frequency):
    """The JONSWAP spectrum over the peak frequency, with energy 1 between the frequencies of the maker."""
    def shape(f):
        return f**-5.0 * np.exp(-1.25 * f**-4.0) * PEAK_ENHANCEMENT ** np.exp(-0.5 * ((f - 1) / np.where(f <= 1, 0.07, 0.09)) ** 2)

    all_of_it = np.linspace(*MAKER, 2501)
    return shape(frequency) / (shape(all_of_it).mean() * (MAKER[1] - MAKER[0]))


def spectrum_numbers(frequency, density):
    """(energy, peak frequency, energy in each of PARTS) of densities at evenly spaced frequencies along the last axis. The peak
    is that of `tailwater waves`."""
    weight = density**4
    parts = [density[..., (frequency >= low) & (frequency < high)].sum(axis=-1) for low, high in zip(PARTS[:-1], PARTS[1:])]
    return density.sum(axis=-1), (frequency * weight).sum(axis=-1) / weight.sum(axis=-1), np.stack(parts, axis=-1)


def random_number(seed, item, which):
    """The random number of src/base/random.h, which gives the waves of a maker from its seed."""
    all_bits = 2**64 - 1
    z = (seed * 0x9E3779B97F4A7C15 & all_bits) ^ (item * 3 + which)
    for _ in range(2):
        z = z + 0x9E3779B97F4A7C15 & all_bits
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 & all_bits
        z = (z ^ z >> 27) * 0x94D049BB133111EB & all_bits
        z ^= z >> 31
    return (z >> 11) * 2.0**-52 - 1


def sea(seed, height, period, depth, gravity):
    """(amplitude, angular frequency, wave number, phase) of each sine of a maker of irregular waves
    (docs/theory/waves.md)."""
    width = (MAKER[1] - MAKER[0]) / COMPONENTS
    n = range(COMPONENTS)
    share = np.array([MAKER[0] + width * (k + 0.5 + 0.5 * random_number(seed, k, 0)) for k in n])
    density = jonswap(share)
    amplitude = height / 4 * np.sqrt(2 * density / density.sum())
    return (amplitude, 2 * np.pi * share / period, wave_numbers(share / period, depth, gravity),
            np.pi * np.array([random_number(seed, k, 1) for k in n]))


def irregular_waves(run):
    """Waves away from the piston against the sines that its seed makes it make, by linear theory, at the same gauges and times,
    between the frequencies of BAND.

    height_error, period_error: of the significant height and of the period of the peak. parts_error: largest relative error of
    the energy below, at and above the peak. reflection: of the absorber. height_of_draw: height of those sines in this window
    over that of the spectrum, less 1. height_scatter: the standard deviation of such draws; that of a Gaussian sea, each
    ordinate of whose periodogram is distributed exponentially about the spectrum (Bendat & Piersol 2010, Random Data, ch. 8)."""
    period, height, end = run.parameters["T"], run.parameters["H"], run.case["time"]["end"]
    depth, maker = run.parameters["h"], run.case["wave_maker"][0]
    gauges = Gauges(run, None, run.parameters["window"], None)
    if gauges.time[-1] < end - 0.1 * period:
        raise DataError(f"{run.path}: its gauges end at {gauges.time[-1]:.4g} s, the run at {end:.4g} s")
    amplitude, omega, k, phase = sea(maker["seed"], height, period, depth, run.gravity)
    made = np.array([np.cos(np.outer(gauges.time, omega) + phase - k * x) @ amplitude for x in gauges.place[:, 0]])

    def read(elevations):
        frequency, there, back = separate(gauges.position(), gauges.time, elevations, depth, run.gravity, 1 / period)
        return frequency, np.abs(there), np.abs(back)

    frequency, there, back = read(gauges.depth)
    frequency = frequency * period
    energy, peak, parts = spectrum_numbers(frequency, there**2 / 2)
    energy_made, peak_made, parts_made = spectrum_numbers(frequency, read(made)[1] ** 2 / 2)
    step = period / (gauges.time[-1] - gauges.time[0])
    asked = jonswap(frequency) * step * (height / 4) ** 2
    draws = asked * np.random.default_rng(1).exponential(size=(DRAWS, frequency.size))
    return {"height_error": float(np.sqrt(energy / energy_made)) - 1, "period_error": float(peak_made / peak) - 1,
            "parts_error": float(np.abs(parts / parts_made - 1).max()), "reflection": float(np.sqrt((back**2).sum() / (there**2).sum())),
            "height_of_draw": float(np.sqrt(energy_made / asked.sum())) - 1,
            "height_scatter": float(np.sqrt(draws.sum(axis=1) / asked.sum()).std())}
