"""Regular waves along a flume: runs of cases/wave_flume."""

import numpy as np

from .curves import DataError
from .waves import single_waves, wave_numbers

PERIODS = 5  # at the end of the run, in which waves are read
# Waves of finite height are longer than linear theory has them. The wave number is looked for within these shares of it.
LENGTHS = np.linspace(0.8, 1.15, 141)
FAR = 10  # wavelengths over which the height that is left is told


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
