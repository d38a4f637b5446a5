"""Compute wave maker motion from a recorded surface elevation or from a wave spectrum.

Writes the motion of a wall (`[[wall]] motion`, docs/theory/moving_walls.md), by linear theory (docs/theory/waves.md). A
recorded motion of a plate already is such a file and needs no conversion.

Exit codes: 0 done; 2 bad input, 4 a file cannot be written.
"""

import csv
import math
import re
import sys
from pathlib import Path

import numpy as np

from .command_line import Parser, exit_code_of, number
from .errors import DataError
from .input_file import LARGEST_TABLE, read_text
from .waves import wave_numbers
from .whole_file import require_other_file, write_whole_text

UNITS = {"t": {"s": 1, "ms": 1e-3, "min": 60}, "f": {"Hz": 1, "1/s": 1},
         "eta": {"m": 1, "cm": 1e-2, "mm": 1e-3},
         "S": {"m^2/Hz": 1, "m^2 s": 1, "cm^2/Hz": 1e-4, "cm^2 s": 1e-4, "mm^2/Hz": 1e-6, "mm^2 s": 1e-6}}
BAND = (0.3, 3.0)  # over the peak frequency; no waves are generated outside this band
LINES_PER_PERIOD = 20  # of the shortest generated wave; the spline between lines is then exact to 0.02 %
GRAVITY = 9.81  # m/s^2
LARGEST_LOSS = 0.5  # fraction of the energy that may lie outside the band
BREAKING = 0.78  # height over depth
DEEP = 300.0  # kh, above which the plate acts as in infinitely deep water, and far above which sinh overflows
MOST_SAMPLES = 1 << 24  # of a record with a constant step, or of a motion
LARGEST = 1e9  # limit for numbers in a file, in SI units


def read_columns(path):
    """Reads a CSV file whose first line has names and units, such as "t [s], eta [mm]". Returns {name: values in SI
    units}. Throws DataError."""
    text = read_text(path, LARGEST_TABLE)
    lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.partition("#")[0].strip()]
    if not lines:
        raise DataError(f"{path}: is empty")
    scales = {}
    for heading in next(csv.reader([lines[0][1]])):
        found = re.fullmatch(r"\s*(\w+)\s*(?:\[(.+)\])?\s*", heading)
        name, unit = (found[1], found[2]) if found else (heading.strip(), None)
        if name not in UNITS or (unit or next(iter(UNITS[name]))) not in UNITS[name]:
            raise DataError(f"{path}:{lines[0][0]}: unknown column \"{heading.strip()}\"; a surface has \"t [s], eta [m]\", a "
                            "spectrum \"f [Hz], S [m^2/Hz]\"; units: "
                            + "; ".join(f"{key}: {', '.join(units)}" for key, units in UNITS.items()))
        scales[name] = UNITS[name][unit or next(iter(UNITS[name]))]
    rows = []
    for n, line in lines[1:]:
        try:
            row = [float(word) for word in line.partition("#")[0].split(",")]
        except ValueError:
            raise DataError(f"{path}:{n}: not numbers: {line[:60]}") from None
        if len(row) != len(scales):
            raise DataError(f"{path}:{n}: has {len(row)} numbers under {len(scales)} names")
        if not (np.abs(row) <= LARGEST).all():
            raise DataError(f"{path}:{n}: has a number that is not finite, or beyond {LARGEST:g}: {line[:60]}")
        rows.append(row)
    columns = dict(zip(scales, np.array(rows).reshape(-1, len(scales)).T * np.array(list(scales.values()))[:, None]))
    first = next((name for name in ("t", "f") if name in columns), None)
    if set(columns) not in ({"t", "eta"}, {"f", "S"}):
        raise DataError(f"{path}: has the columns {', '.join(columns)}; needed are t and eta, or f and S")
    if len(rows) < 3 or (np.diff(columns[first]) <= 0).any():
        raise DataError(f"{path}: needs three lines or more, with {first} that ascends")
    return columns


def wave_over_stroke(k, depth, is_flap):
    """Amplitude of the wave, far from the plate, over the amplitude of the plate at the still-water level.

    R.G. Dean, R.A. Dalrymple (1991) *Water wave mechanics for engineers and scientists*, ch. 6."""
    y = np.minimum(k * depth, DEEP)
    s = np.sinh(y) + (1 - np.cosh(y)) / y if is_flap else np.sinh(y)
    return 4 * np.sinh(y) * s / (np.sinh(2 * y) + 2 * y)


class Waves:
    """Complex amplitudes (m) of waves at evenly spaced frequencies (Hz). The waves repeat after `duration` (s), and
    outside of `present` (s) of that time the water is still. `lost` is the fraction of the energy that was removed."""

    def __init__(self, frequency, amplitude, duration, present, lost):
        self.frequency, self.amplitude, self.lost = frequency, amplitude, lost
        self.duration, self.present = duration, present

    def limited(self, band):
        """The waves within a band (Hz), with the fraction of energy outside it as `lost`. Throws DataError."""
        energy = np.abs(self.amplitude) ** 2
        inside = (self.frequency >= band[0]) & (self.frequency <= band[1])
        lost = 1 - energy[inside].sum() / energy.sum() if energy.any() else 1.0
        if lost > LARGEST_LOSS:
            raise DataError(f"{100 * lost:.3g} % of the waves' energy lies outside of the band from {band[0]:.4g} to "
                            f"{band[1]:.4g} Hz; remedy: a wider --band")
        return Waves(self.frequency[inside], self.amplitude[inside], self.duration, self.present, lost)

    @property
    def peak(self):
        """Peak frequency, Hz. Throws DataError if there are no waves."""
        largest = np.abs(self.amplitude).max(initial=0.0)
        if not largest > 0:
            raise DataError("the file has no waves: its values are all the same")
        weight = (np.abs(self.amplitude) / largest) ** 8
        return float((self.frequency * weight).sum() / weight.sum())

    @property
    def height(self):
        """Significant wave height Hm0, m, while there are waves."""
        return float(4 * np.sqrt((np.abs(self.amplitude) ** 2).sum() / 2 * self.duration / self.present))


def require_few(samples, what):
    """Throws DataError for a number of samples that would exhaust the memory."""
    if not samples <= MOST_SAMPLES:
        raise DataError(f"{what} would have {samples:.3g} samples, and at most {MOST_SAMPLES} are possible; remedy: a shorter "
                        "time, or a coarser step or band")


def even_series(columns):
    """Resamples a record with a constant step and subtracts its mean."""
    time, elevation = columns["t"], columns["eta"]
    step = np.diff(time).min()
    require_few((time[-1] - time[0]) / step, "the record, with even steps as its shortest,")
    even = np.arange(time[0], time[-1] + step / 2, step)
    return even, np.interp(even, time, elevation - elevation.mean())


def recorded(time, elevation, lead):
    """The waves of a record, after `lead` (s) of still water."""
    step = time[1] - time[0]
    require_few(lead / step, "the still water before the record")
    still = np.zeros(round(lead / step))
    surface = np.concatenate([still, elevation, still])
    amplitude = 2 * np.fft.rfft(surface)[1:] / surface.size
    return Waves(np.fft.rfftfreq(surface.size, step)[1:], amplitude, surface.size * step, elevation.size * step, 0.0)


def chosen(frequency, density, duration, seed):
    """Waves of a spectrum (m^2/Hz) with random phases; they repeat after `duration` (s)."""
    require_few(frequency[-1] * duration, "the spectrum over this duration")
    even = np.arange(1, int(frequency[-1] * duration) + 1) / duration
    energy = np.maximum(np.interp(even, frequency, density, left=0, right=0), 0)
    phase = np.random.default_rng(seed).uniform(0, 2 * np.pi, even.size)
    return Waves(even, np.sqrt(2 * energy / duration) * np.exp(1j * phase), duration, duration, 0.0)


def motion(waves, depth, distance, is_flap):
    """Times (s) and strokes (m) of a plate that generates the waves at a distance (m) in front of it.

    With c the amplitude of the wave over that of the plate, a stroke X sin wt generates the wave c X cos(wt - kx)."""
    require_few(waves.duration * LINES_PER_PERIOD * waves.frequency[-1], "the motion")
    k = wave_numbers(waves.frequency, depth, GRAVITY)
    stroke = waves.amplitude * np.exp(1j * k * distance) / (1j * wave_over_stroke(k, depth, is_flap))
    time = np.arange(0, waves.duration, 1 / (LINES_PER_PERIOD * waves.frequency[-1]))
    moved = np.array([(stroke * np.exp(2j * np.pi * waves.frequency * t)).real.sum() for t in time])
    ramp = min(2 / waves.peak, waves.duration / 4)
    ends = np.clip(np.minimum(time, time[-1] - time) / ramp, 0, 1)
    return time, moved * (1 - np.cos(np.pi * ends)) / 2


def lead_of(distance, depth, highest):
    """Time (s) in which the slowest waves, of frequency `highest` (Hz), travel a distance (m) at their group
    velocity."""
    k = wave_numbers([0.999 * highest, 1.001 * highest], depth, GRAVITY)
    return distance * (k[1] - k[0]) / (2 * np.pi * 0.002 * highest)


def waves_of(columns, options):
    """The waves that the plate generates, and the time (s) of the run at which the record begins."""
    lead = 0.0
    if "f" in columns:
        if options.duration is None:
            raise DataError("a spectrum needs --duration: how many seconds of waves")
        waves = chosen(columns["f"], columns["S"], options.duration, options.seed)
        band = options.band or [ratio * waves.peak for ratio in BAND]
    else:
        series = even_series(columns)
        band = options.band or [ratio * recorded(*series, 0.0).peak for ratio in BAND]
        step = series[0][1] - series[0][0]
        lead = math.ceil(lead_of(options.distance, options.depth, band[1]) / step) * step
        waves = recorded(*series, lead)
    waves = waves.limited(band)
    if waves.height > BREAKING * options.depth:
        raise DataError(f"the waves are {waves.height:.3g} m high (Hm0) in water of {options.depth:.3g} m: they break; is the "
                        "unit of the file right?")
    return waves, lead


def write_motion(path, time, stroke, depth, is_flap):
    """Writes a motion file. The water lies at larger x than the plate: a flap that leans towards the water turns
    clockwise."""
    values, heading = (-np.arctan(stroke / depth), "t [s], angle [rad]") if is_flap else (stroke, "t [s], x [m]")
    text = "".join(f"{t:.5f}, {value:.7f}\n" for t, value in zip(time, values))
    write_whole_text(path, f"{heading}\n{text}")


def options_of(arguments):
    parser = Parser("tailwater paddle", description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.epilog = "Example: tailwater paddle gauge.csv --to paddle.csv --depth 0.4 --distance 5"
    parser.add_argument("file", type=Path, help='CSV: surface elevation ("t [s], eta [mm]") or spectrum ("f [Hz], S [m^2/Hz]")')
    parser.add_argument("--to", type=Path, required=True, metavar="FILE", help="motion file to write, for a wall")
    parser.add_argument("--depth", type=number, required=True, metavar="M", help="still-water depth at the plate, m")
    parser.add_argument("--distance", type=number, default=0.0, metavar="M", help="distance of the gauge from the plate, m (0)")
    parser.add_argument("--flap", action="store_true", help="flap hinged at the bed instead of a piston")
    parser.add_argument("--band", type=number, nargs=2, metavar=("HZ", "HZ"), help="frequency range to generate, Hz (0.3 to 3 "
                        "times the peak frequency)")
    parser.add_argument("--duration", type=number, metavar="S", help="duration of waves from a spectrum, s")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="seed of the random phases (1)")
    options = parser.parse_args(arguments)
    if options.seed < 0:
        parser.error(f"--seed {options.seed}: a seed is 0 or more")
    for name in ("depth", "duration"):
        if getattr(options, name) is not None and getattr(options, name) <= 0:
            parser.error(f"--{name} {getattr(options, name):g}: must be above 0")
    if options.distance < 0:
        parser.error(f"--distance {options.distance:g}: the gauge stands in front of the plate, at 0 or more")
    if options.band and not 0 < options.band[0] < options.band[1]:
        parser.error(f"--band {options.band[0]:g} {options.band[1]:g}: the first must be above 0 and below the second")
    return options


def make_motion(options):
    """Writes the motion file and prints a summary of it. Throws DataError, IoError."""
    require_other_file(options.to, options.file)
    waves, lead = waves_of(read_columns(options.file), options)
    time, stroke = motion(waves, options.depth, options.distance, options.flap)
    write_motion(options.to, time, stroke, options.depth, options.flap)
    print(f"{options.to}: {time.size} lines, {time[-1]:.4g} s; stroke {stroke.min():.4g} to {stroke.max():.4g} m at the still "
          f"water's level\nwaves: Hm0 {waves.height:.4g} m, peak {waves.peak:.4g} Hz, between {waves.frequency[0]:.4g} and "
          f"{waves.frequency[-1]:.4g} Hz, which leaves out {100 * waves.lost:.1f} % of the energy")
    if lead > 0:
        print(f"the record begins at t = {lead:.6g} s")


def main(arguments):
    options = options_of(arguments)
    return exit_code_of(lambda: make_motion(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
