"""Regular and irregular waves along a flume: runs of cases/wave_flume."""

import numpy as np

from .curves import DataError
from .waves import BAND, Gauges, separate as separate_spectrum, single_waves, wave_numbers

PERIODS = 5  # at the end of the run, in which waves are read
# Waves of finite height are longer than linear theory has them. The wave number is looked for within these shares of it.
LENGTHS = np.linspace(0.8, 1.15, 141)
FAR = 10  # wavelengths over which the height that is left is told
PEAK_ENHANCEMENT = 3.3  # of the JONSWAP spectrum; the default of the maker
MAKER = (0.5, 3.0)  # frequencies that the maker makes, over that of the peak
# Frequencies over that of the peak between which the energy of irregular waves is compared: below, at and above the peak.
PARTS = (BAND[0], 0.9, 1.1, BAND[1])
DRAWS = 2000  # of a sea, for the scatter of what is read from it


def first_harmonic(time, value, period):
    """The complex amplitude at a period, by least squares with the mean and three harmonics."""
    phase = 2 * np.pi * time / period
    shapes = [np.ones_like(phase)] + [wave(n * phase) for n in (1, 2, 3) for wave in (np.cos, np.sin)]
    found = np.linalg.lstsq(np.stack(shapes, axis=1), value, rcond=None)[0]
    return found[1] - 1j * found[2]


def separate(position, amplitude, wave_number):
    """(amplitude there, amplitude back, wave number) of the waves along the line of gauges, whose own wave number is the
    one with the least misfit."""
    best = None
    for share in LENGTHS:
        shape = np.stack([np.exp(sign * 1j * share * wave_number * position) for sign in (-1, 1)], axis=1)
        found = np.linalg.lstsq(shape, amplitude, rcond=None)[0]
        misfit = np.linalg.norm(shape @ found - amplitude)
        if best is None or misfit < best[0]:
            best = misfit, abs(found[0]), abs(found[1]), share * wave_number
    return best[1:]


class Group:
    """Gauges whose names begin with a letter, in the last periods of a run."""

    def __init__(self, run, letter):
        period, end = run.parameters["T"], run.case["time"]["end"]
        gauges = [probe for probe in run.case["probe"] if probe["type"] == "depth" and probe["name"].startswith(letter)]
        self.place = np.array([gauge["at"][0] for gauge in gauges])
        amplitudes, heights = [], []
        for gauge in gauges:
            curve = run.probe(gauge["name"], "highest_m")
            if curve.time[-1] < end - 0.1 * period:
                raise DataError(f"{run.path}: its gauge '{gauge['name']}' ends at {curve.time[-1]:.4g} s, the run at {end:.4g} s")
            curve = curve.window(end - PERIODS * period, end)
            amplitudes.append(first_harmonic(curve.time, curve.value, period))
            heights.append(single_waves(curve.time, curve.value - curve.value.mean())[0].mean())
        self.height = float(np.mean(heights))
        linear = float(wave_numbers(1 / period, run.parameters["h"], run.gravity))
        self.there, self.back, self.wave_number = separate(self.place - self.place[0], np.array(amplitudes), linear)


def wave_flume(run):
    """height_error: between crest and trough near the maker, over what was asked for, less 1. height_left: share of the
    first harmonic that ten wavelengths leave, by its decay between both groups of gauges. reflection: of the absorber."""
    near, far = Group(run, "a"), Group(run, "b")
    wavelengths = (far.place[0] - near.place[0]) / run.parameters["L"]
    return {"height_error": near.height / run.parameters["H"] - 1, "height_left": float((far.there / near.there) ** (FAR / wavelengths)),
            "reflection": float(far.back / far.there), "height_m": near.height, "height_far_m": far.height,
            "longer_than_linear": float(run.parameters["L"] * near.wave_number / (2 * np.pi)) ** -1 - 1}


def jonswap(frequency):
    """The JONSWAP spectrum over the frequency of the peak, with the energy 1 between the frequencies that the maker makes."""
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


def irregular_waves(run):
    """Waves away from the piston against the JONSWAP spectrum that was asked for, between the frequencies of BAND.

    height_error, period_error: of the significant height and of the period of the peak. height_scatter, period_scatter: the
    standard deviations of the two in records of this length. parts_in_scatters: rms error of the energy below, at and
    above the peak, each over its standard deviation. reflection: of the absorber.

    Standard deviations are those of a Gaussian sea, each ordinate of whose periodogram is distributed exponentially about
    the spectrum (Bendat & Piersol 2010, Random Data, ch. 8)."""
    period, height, end = run.parameters["T"], run.parameters["H"], run.case["time"]["end"]
    gauges = Gauges(run, None, run.parameters["window"], None)
    if gauges.time[-1] < end - 0.1 * period:
        raise DataError(f"{run.path}: its gauges end at {gauges.time[-1]:.4g} s, the run at {end:.4g} s")
    frequency, there, back = separate_spectrum(gauges.position(), gauges.time, gauges.depth, run.parameters["h"], run.gravity, 1 / period)
    frequency = frequency * period
    step = period / (gauges.time[-1] - gauges.time[0])
    asked = jonswap(frequency) * step * (height / 4) ** 2
    energy, peak, parts = spectrum_numbers(frequency, there**2 / 2)
    energy_asked, peak_asked, parts_asked = spectrum_numbers(frequency, asked)
    draws = spectrum_numbers(frequency, asked * np.random.default_rng(1).exponential(size=(DRAWS, frequency.size)))
    return {"height_error": float(np.sqrt(energy / energy_asked)) - 1, "height_scatter": float(np.std(np.sqrt(draws[0] / energy_asked))),
            "period_error": float(peak_asked / peak) - 1, "period_scatter": float(np.std(peak_asked / draws[1])),
            "parts_in_scatters": float(np.sqrt(np.mean(((parts - parts_asked) / draws[2].std(axis=0)) ** 2))),
            "reflection": float(np.sqrt((back**2).sum() / (there**2).sum()))}
