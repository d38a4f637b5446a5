"""Print wave heights, periods and reflection from the depth probes of a run.

Prints, for each gauge, the mean depth, heights and periods, and with three or more gauges along one line the waves that
run along it and back. RUN/waves.json holds the same numbers, RUN/waves_spectrum.csv the spectra.

Exit codes: 0 done; 2 bad input, 4 a file cannot be written.
"""

import json
import sys
from pathlib import Path

import numpy as np

from .command_line import Parser, exit_code_of, number
from .errors import DataError
from .run import Run
from .whole_file import write_whole_text

# Frequencies between these multiples of the peak's count as waves in a separation of waves and reflected waves.
BAND = (0.5, 1.8)
# Gauges that stand half a wave apart, or almost at one place, cannot tell waves from reflected ones. Frequencies for
# which the worse determined of the two is known this much less well than it could be are left out, and with more than
# this share of the energy lost there is no answer.
LEAST_DETERMINED = 0.1
LARGEST_LOSS = 0.2
# Waves that a window must hold, so that mean heights mean anything.
LEAST_WAVES = 3


def wave_numbers(frequency, depth, gravity):
    """Wave numbers (1/m) of frequencies (Hz): omega^2 = g k tanh kh, by Newton's method."""
    target = (2 * np.pi * np.asarray(frequency, dtype=float)) ** 2 * depth / gravity
    y = target / np.sqrt(np.tanh(target))
    for _ in range(20):
        tanh_y = np.tanh(y)
        y += (target - y * tanh_y) / (tanh_y + y * (1 - tanh_y**2))
    return y / depth


def up_crossings(time, elevation):
    """Times at which the elevation rises through 0, linear between samples."""
    k = np.flatnonzero((elevation[:-1] < 0) & (elevation[1:] >= 0))
    return time[k] - elevation[k] * (time[k + 1] - time[k]) / (elevation[k + 1] - elevation[k]), k


def single_waves(time, elevation):
    """(height, period) of each wave between two up-crossings."""
    crossings, k = up_crossings(time, elevation)
    heights = [elevation[i + 1:j + 1].max() - elevation[i + 1:j + 1].min() for i, j in zip(k[:-1], k[1:])]
    return np.array(heights), np.diff(crossings)


def spectrum(time, elevation):
    """(frequency, density): the periodogram, m^2/Hz. The mean is taken out; the window holds whole waves or is long."""
    n, step = elevation.size, time[1] - time[0]
    amplitude = np.fft.rfft(elevation - elevation.mean()) / n
    density = 2 * np.abs(amplitude) ** 2 * n * step
    return np.fft.rfftfreq(n, step), density


def gauge_numbers(time, depth):
    """What one gauge says about the waves in its window."""
    mean = float(depth.mean())
    elevation = depth - mean
    heights, periods = single_waves(time, elevation)
    if heights.size < LEAST_WAVES:
        raise DataError(f"holds {heights.size} waves between {time[0]:.4g} and {time[-1]:.4g} s; at least {LEAST_WAVES} "
                        "are needed: a longer window, or a longer run")
    highest_third = np.sort(heights)[::-1][:max(1, heights.size // 3)]
    frequency, density = spectrum(time, elevation)
    inside = frequency > 0
    energy = density[inside].sum() * frequency[1]
    peak = float((frequency[inside] * density[inside] ** 4).sum() / (density[inside] ** 4).sum())
    return {"depth_m": mean, "waves": int(heights.size), "H_mean_m": float(heights.mean()),
            "H_third_m": float(highest_third.mean()), "H_max_m": float(heights.max()),
            "Hm0_m": float(4 * np.sqrt(energy)), "T_mean_s": float(periods.mean()), "T_peak_s": 1 / peak}


def separate(position, time, elevations, depth, gravity, peak):
    """Waves that run towards larger positions, and back: least squares over all gauges for each frequency.

    E.P.D. Mansard, E.R. Funke (1980) *The measurement of incident and reflected spectra using a least squares method*,
    Proc. 17th Coastal Eng. Conf., 154-172; for any number of gauges from three on (two leave nothing to fit).
    Returns (frequencies, amplitudes there, amplitudes back), in Hz and m."""
    n, step = time.size, time[1] - time[0]
    frequency = np.fft.rfftfreq(n, step)
    amplitude = 2 * np.fft.rfft(elevations - elevations.mean(axis=1, keepdims=True), axis=1) / n
    chosen = np.flatnonzero((frequency >= BAND[0] * peak) & (frequency <= BAND[1] * peak))
    kept, there, back, lost = [], [], [], 0.0
    for m, k in zip(chosen, wave_numbers(frequency[chosen], depth, gravity)):
        shape = np.stack([np.exp(-1j * k * position), np.exp(1j * k * position)], axis=1)
        least = np.linalg.svd(shape, compute_uv=False)[-1] / np.sqrt(position.size)
        if least < LEAST_DETERMINED:
            lost += (np.abs(amplitude[:, m]) ** 2).sum()
            continue
        first, second = np.linalg.lstsq(shape, amplitude[:, m], rcond=None)[0]
        kept.append(frequency[m])
        there.append(abs(first))
        back.append(abs(second))
    total = (np.abs(amplitude[:, chosen]) ** 2).sum()
    if lost > LARGEST_LOSS * total:
        raise DataError("the gauges stand half a wave apart, or much less than that: put them at unequal distances, "
                        "about a tenth and a quarter of the wave's length")
    return np.array(kept), np.array(there), np.array(back)


def reflection_numbers(position, time, elevations, depth, gravity, peak):
    _, there, back = separate(position, time, elevations, depth, gravity, peak)
    energy_there, energy_back = (there**2).sum(), (back**2).sum()
    return {"Hm0_there_m": float(4 * np.sqrt(energy_there / 2)), "Hm0_back_m": float(4 * np.sqrt(energy_back / 2)),
            "reflection": float(np.sqrt(min(energy_there, energy_back) / max(energy_there, energy_back))),
            "runs": "towards the last gauge" if energy_there >= energy_back else "towards the first gauge"}


class Gauges:
    """Depth probes of a run over one uniform series of times."""

    def __init__(self, run, names, start, end):
        probes = {probe["name"]: probe for probe in run.case.get("probe", []) if probe["type"] == "depth"}
        self.names = names or list(probes)
        if not self.names:
            raise DataError(f"{run.path}: has no depth probes, which wave gauges are")
        for name in self.names:
            if name not in probes:
                raise DataError(f"{run.path}: has no depth probe '{name}'; it has {', '.join(probes) or 'none'}")
        self.place = np.array([probes[name]["at"][:run.dimension - 1] for name in self.names])
        curves = [run.curve(name, "highest_m") for name in self.names]
        first = max([start if start is not None else 0.0] + [curve.time[0] for curve in curves])
        last = min([end if end is not None else np.inf] + [curve.time[-1] for curve in curves])
        if last <= first:
            raise DataError(f"{run.path}: its gauges have no times between {first:.4g} and {last:.4g} s")
        steps = [np.diff(curve.time).max() for curve in curves if curve.time.size > 1]
        self.time = np.linspace(first, last, int(np.ceil((last - first) / min(steps))) + 1)
        self.depth = np.array([np.interp(self.time, curve.time, curve.value) for curve in curves])

    def whole_waves(self, period):
        """The same with a window of whole periods, at its end, so that regular waves have one frequency."""
        count = int((self.time[-1] - self.time[0]) / period)
        keep = self.time >= self.time[-1] - count * period
        self.time, self.depth = self.time[keep], self.depth[:, keep]

    def position(self):
        """Distance of each gauge from the first along the line through the first and the last."""
        along = self.place[-1] - self.place[0]
        if np.linalg.norm(along) == 0:
            raise DataError("the first and the last gauge are at one place")
        return (self.place - self.place[0]) @ (along / np.linalg.norm(along))


def analyse(run, names=(), start=None, end=None, depth=None):
    """(numbers, spectra) of a run's gauges."""
    gauges = Gauges(run, list(names), start, end)
    first = gauge_numbers(gauges.time, gauges.depth[0])
    gauges.whole_waves(first["T_mean_s"])
    numbers = {"from_s": float(gauges.time[0]), "to_s": float(gauges.time[-1]), "gauges": {}}
    spectra = {}
    for name, reading in zip(gauges.names, gauges.depth):
        try:
            numbers["gauges"][name] = gauge_numbers(gauges.time, reading)
        except DataError as error:
            raise DataError(f"gauge '{name}' {error}") from error
        spectra["frequency_Hz"], spectra[f"{name}_m2_per_Hz"] = spectrum(gauges.time, reading)
    if len(gauges.names) >= 3:
        still = depth or float(np.mean([gauge["depth_m"] for gauge in numbers["gauges"].values()]))
        numbers["separation"] = reflection_numbers(gauges.position(), gauges.time, gauges.depth, still, run.gravity,
                                                   1 / first["T_peak_s"])
    return numbers, spectra


def crest(curve):
    """(time, height over the first reading) of a curve's highest wave: the parabola through what is above 0.9 of it."""
    elevation = curve.value - curve.value[0]
    highest = int(np.argmax(elevation))
    near = elevation > 0.9 * elevation[highest]
    first = highest - int(np.argmin(near[highest::-1])) + 1 if not near[:highest + 1].all() else 0
    last = highest + int(np.argmin(near[highest:])) if not near[highest:].all() else near.size
    if last - first < 4 or last == near.size:
        raise DataError("has no wave whose crest has passed")
    origin = curve.time[highest]
    square, slope, top = np.polyfit(curve.time[first:last] - origin, elevation[first:last], 2)
    return origin - slope / (2 * square), top - slope**2 / (4 * square)


def solitary(run, names=()):
    """The wave's height at each gauge, and its speed between the first and the last."""
    gauges = Gauges(run, list(names), None, None)
    found = {}
    for name, position in zip(gauges.names, gauges.position()):
        try:
            time, height = crest(run.curve(name, "highest_m"))
        except DataError as error:
            raise DataError(f"gauge '{name}' {error}") from error
        found[name] = {"position_m": float(position), "time_s": float(time), "height_m": float(height)}
    first, last = found[gauges.names[0]], found[gauges.names[-1]]
    speed = (last["position_m"] - first["position_m"]) / (last["time_s"] - first["time_s"])
    depth = float(gauges.depth[:, 0].mean())
    steepness = float(np.mean([gauge["height_m"] for gauge in found.values()])) / depth
    theory = np.sqrt(run.gravity * depth * (1 + steepness - steepness**2 / 20 - 3 * steepness**3 / 70))
    return {"gauges": found, "depth_m": depth, "speed_m_per_s": float(speed),
            "theory_m_per_s": float(theory), "difference": float(speed / theory - 1)}


def solitary_report(numbers):
    lines = [f"{'gauge':<12}{'at m':>8}{'crest s':>10}{'height m':>10}"]
    lines += [f"{name:<12}{gauge['position_m']:>8.3f}{gauge['time_s']:>10.4f}{gauge['height_m']:>10.5f}"
              for name, gauge in numbers["gauges"].items()]
    lines.append(f"speed {numbers['speed_m_per_s']:.4f} m/s; a solitary wave of this height (Fenton 1972) runs at "
                 f"{numbers['theory_m_per_s']:.4f} m/s: {100 * numbers['difference']:+.2f} %")
    return "\n".join(lines)


def report(numbers):
    lines = [f"from {numbers['from_s']:.4g} to {numbers['to_s']:.4g} s",
             f"{'gauge':<12}{'depth m':>10}{'waves':>7}{'H mean m':>10}{'H 1/3 m':>10}{'H max m':>10}{'Hm0 m':>10}"
             f"{'T mean s':>10}{'T peak s':>10}"]
    for name, gauge in numbers["gauges"].items():
        lines.append(f"{name:<12}{gauge['depth_m']:>10.4f}{gauge['waves']:>7}" + "".join(
            f"{gauge[key]:>10.4f}" for key in ("H_mean_m", "H_third_m", "H_max_m", "Hm0_m", "T_mean_s", "T_peak_s")))
    if "separation" in numbers:
        found = numbers["separation"]
        lines.append(f"Hm0 {found['Hm0_there_m']:.4f} m there and {found['Hm0_back_m']:.4f} m back: "
                     f"{100 * found['reflection']:.1f} % reflected; the waves run {found['runs']}")
    return "\n".join(lines)


def write_spectra(path, spectra):
    names = list(spectra)
    lines = [",".join(names)]
    lines += [",".join(f"{value:.9g}" for value in row) for row in zip(*spectra.values())]
    write_whole_text(path, "\n".join(lines) + "\n")


def print_waves(options):
    """Prints and writes the numbers. Throws DataError, IoError."""
    run, spectra = Run(options.run), None
    if options.solitary:
        numbers = solitary(run, options.gauges)
    else:
        numbers, spectra = analyse(run, options.gauges, options.start, options.end, options.depth)
    print(solitary_report(numbers) if options.solitary else report(numbers))
    write_whole_text(options.run / "waves.json", json.dumps(numbers, indent=2) + "\n")
    if spectra:
        write_spectra(options.run / "waves_spectrum.csv", spectra)


def main(arguments):
    parser = Parser("tailwater waves", description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="folder of a run")
    parser.add_argument("gauges", nargs="*", metavar="GAUGE", help="depth probes, in the direction of wave travel (all)")
    parser.add_argument("--from", type=number, dest="start", metavar="S", help="start of the window, s (start of the run)")
    parser.add_argument("--to", type=number, dest="end", metavar="S", help="end of the window, s (end of the run)")
    parser.add_argument("--depth", type=number, metavar="M", help="still-water depth, m (mean of the gauges)")
    parser.add_argument("--solitary", action="store_true", help="evaluate a solitary wave: height and speed")
    options = parser.parse_args(arguments)
    if options.depth is not None and options.depth <= 0:
        parser.error(f"--depth {options.depth:g}: a depth is above 0 m")
    return exit_code_of(lambda: print_waves(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
