"""Print wave heights, harmonics, reflection, response of bodies and overtopping from the probes of a run.

Prints, for each gauge, mean depth, set-up, heights and periods; for regular waves also the harmonics; with two or more gauges
along one line the incident and reflected waves; on request the response of bodies and forces, and overtopping volumes.
RUN/waves.json holds the same numbers, RUN/waves_spectrum.csv the spectra.

Exit codes: 0 done; 2 bad input, 4 a file cannot be written.
"""

import json
import sys
from pathlib import Path

import numpy as np

from .command_line import Parser, exit_code_of, number
from .errors import DataError
from .run import Run
from .wave_records import (BAND, best_period, drift_with_interval, fit_harmonics, mean_with_interval, overtopping_volumes,
                           period_means, response, separate, separate_regular, separate_second, single_waves, spectrum,
                           trend_of, wave_numbers, without_trend)
from .whole_file import write_whole_text

__all__ = ["BAND", "Gauges", "analyse", "crest", "separate", "single_waves", "solitary", "wave_numbers"]

# Readings that a period must have for its five harmonics.
MIN_READINGS = 11
# Waves that a window must hold for mean heights of waves of unknown period.
MIN_WAVES = 3
# Waves are regular if the rms of what their harmonics leave is below this fraction of the rms of the record.
MAX_IRREGULAR = 0.2
# Gauges over depths that differ by a larger factor do not separate incident and reflected waves.
MAX_UNEVEN = 1.1
# Overtopping events are separated by pauses of this fraction of the period.
PAUSE = 0.25


def peak_frequency(frequency, density):
    """Hz; the mean frequency, weighted with the fourth power of the density."""
    weight = density**4
    return float((frequency * weight).sum() / weight.sum())


def gauge_numbers(time, depth, period=None):
    """Numbers of one gauge in its window: depth, heights, periods. Throws DataError for fewer than MIN_WAVES waves unless the
    period (s) is known."""
    mean = float(depth.mean())
    elevation = depth - mean
    heights, periods = single_waves(time, elevation)
    if heights.size < MIN_WAVES:
        if period is None:
            raise DataError(f"holds {heights.size} waves; at least {MIN_WAVES} are needed; remedy: give a longer window, or the "
                            "period of regular waves (--period)")
        heights, periods = np.array([np.ptp(elevation)]), np.array([period])
    highest_third = np.sort(heights)[::-1][:max(1, heights.size // 3)]
    frequency, density = spectrum(time, elevation)
    inside = frequency > 0
    energy = density[inside].sum() * frequency[1]
    return {"depth_m": mean, "waves": int(heights.size), "H_mean_m": float(heights.mean()),
            "H_third_m": float(highest_third.mean()), "H_max_m": float(heights.max()), "crest_m": float(elevation.max()),
            "trough_m": float(elevation.min()), "Hm0_m": float(4 * np.sqrt(energy)), "T_mean_s": float(periods.mean()),
            "T_peak_s": 1 / peak_frequency(frequency[inside], density[inside])}


def numbers_in_window(gauges, n, window, period):
    """`gauge_numbers` of gauge n. An error names the gauge and the window that the user gave, which `gauges` may have
    shortened to whole waves."""
    try:
        return gauge_numbers(gauges.time, gauges.depth[n], period)
    except DataError as error:
        raise DataError(f"gauge '{gauges.names[n]}' between {window[0]:.4g} and {window[1]:.4g} s {error}") from error


def set_up(time, depth, still, period):
    """Rise of the mean level above the still level, and half of its 95 % interval, m."""
    mean, interval = mean_with_interval(period_means(time, depth, period)[1])
    return {"set_up_m": mean - still, "set_up_interval_m": interval}


def harmonic_numbers(found):
    """Amplitudes and phases of Harmonics."""
    phases, relative = found.phases()
    return {"amplitude_m": [float(a) for a in np.abs(found.amplitude)], "phase_deg": [float(p) for p in phases],
            "phase_from_first_deg": [float(p) for p in relative], "residual_m": found.residual}


def direction_of(there, back):
    """The text for the direction of the larger of two energies."""
    return "towards the last gauge" if there >= back else "towards the first gauge"


def reflection_of(there, back):
    """The smaller amplitude over the larger."""
    return float(min(there, back) / max(there, back))


def reflection_numbers(there, back):
    """Heights and reflection of waves of all frequencies."""
    energy_there, energy_back = (np.abs(there) ** 2).sum(), (np.abs(back) ** 2).sum()
    return {"Hm0_there_m": float(4 * np.sqrt(energy_there / 2)), "Hm0_back_m": float(4 * np.sqrt(energy_back / 2)),
            "reflection": reflection_of(np.sqrt(energy_there), np.sqrt(energy_back)),
            "runs": direction_of(energy_there, energy_back)}


def regular_numbers(position, harmonics, depth, gravity):
    """(numbers, RegularWaves) from the harmonics at two or more gauges."""
    period = harmonics[0].period
    first, second = (np.array([found.amplitude[n] for found in harmonics]) for n in (0, 1))
    waves = separate_regular(position, first, float(wave_numbers(1 / period, depth, gravity)), depth)
    there, back = abs(waves.there), abs(waves.back)
    numbers = {"H_there_m": 2 * there, "H_back_m": 2 * back, "reflection": reflection_of(there, back),
               "wavelength_m": 2 * np.pi / waves.wave_number, "runs": direction_of(there, back)}
    parts = separate_second(position, second, waves.wave_number, float(wave_numbers(2 / period, depth, gravity)))
    if parts is not None:
        names = ("bound_there", "bound_back", "free_there", "free_back")
        numbers["second_m"] = {name: float(abs(part)) for name, part in zip(names, parts)}
    return numbers, waves


class Gauges:
    """Depth probes of a run over one uniform series of times."""

    def __init__(self, run, names, start=None, end=None):
        probes = {probe["name"]: probe for probe in run.case.get("probe", []) if probe["type"] == "depth"}
        self.names = names or list(probes)
        if not self.names:
            raise DataError(f"{run.path}: has no depth probes, which wave gauges are")
        for name in self.names:
            if name not in probes:
                raise DataError(f"{run.path}: has no depth probe '{name}'; it has {', '.join(probes) or 'none'}")
        self.place = np.array([probes[name]["at"][:run.dimension - 1] for name in self.names])
        curves = [run.curve(name, "highest_m") for name in self.names]
        self.still = np.array([curve.value[0] for curve in curves])  # at the first reading
        first = max([start if start is not None else 0.0] + [curve.time[0] for curve in curves])
        last = min([end if end is not None else np.inf] + [curve.time[-1] for curve in curves])
        if last <= first:
            raise DataError(f"{run.path}: its gauges have no times between {first:.4g} and {last:.4g} s")
        steps = [np.diff(curve.time).max() for curve in curves if curve.time.size > 1]
        self.time = np.linspace(first, last, int(np.ceil((last - first) / min(steps))) + 1)
        self.depth = np.array([np.interp(self.time, curve.time, curve.value) for curve in curves])
        self.level = self.depth  # as recorded; `depth` may lose its trend
        self.trend = np.zeros(len(self.names))

    def remove_trends(self, period):
        """Removes a trend of the mean level from `depth`. Without a period (s) it is the mean one between up-crossings."""
        if period is None:
            line = np.polyfit(self.time, self.depth[0], 1) if self.time.size > 2 else (0.0, 0.0)
            heights, periods = single_waves(self.time, self.depth[0] - np.polyval(line, self.time))
            if heights.size < MIN_WAVES:
                return
            period = float(periods.mean())
        self.trend = np.array([trend_of(self.time, level, period) for level in self.level])
        self.depth = np.array([without_trend(self.time, *each) for each in zip(self.level, self.trend)])

    def whole_waves(self, period):
        """Shortens the window to whole periods at its end, so that regular waves have one frequency."""
        count = max(1, int((self.time[-1] - self.time[0]) / period * (1 + 1e-9)))
        keep = self.time >= self.time[-1] - count * period
        self.time, self.depth, self.level = self.time[keep], self.depth[:, keep], self.level[:, keep]

    def along(self):
        """The unit vector from the first gauge to the last. Throws DataError if they are at one place."""
        along = self.place[-1] - self.place[0]
        if np.linalg.norm(along) == 0:
            raise DataError("the first and the last gauge are at one place")
        return along / np.linalg.norm(along)

    def position(self, places=None):
        """Distances of places (default: of the gauges) from the first gauge along that vector."""
        return ((self.place if places is None else places) - self.place[0]) @ self.along()


class Incident:
    """The incident waves of a window, at any place: regular or of many frequencies."""

    def __init__(self, frequency, amplitude, depth, gravity, origin, wave_number=None):
        self.frequency, self.amplitude, self.origin = frequency, amplitude, origin
        self.wave_number = wave_numbers(frequency, depth, gravity) if wave_number is None else np.array([wave_number])
        self.sign = 1.0

    def at(self, position):
        """Complex amplitudes at a distance (m) from the first gauge."""
        return self.amplitude * np.exp(-1j * self.sign * self.wave_number * position)


def larger(there, back):
    """(amplitudes, sign) of the waves with more energy: these are the incident waves."""
    return (there, 1.0) if (np.abs(there) ** 2).sum() >= (np.abs(back) ** 2).sum() else (back, -1.0)


def separation(gauges, numbers, depth, gravity, harmonics):
    """Adds incident and reflected waves to the numbers. Returns the Incident waves."""
    position = gauges.position()
    peak = 1 / numbers["gauges"][gauges.names[0]]["T_peak_s"]
    if harmonics:
        numbers["regular"], waves = regular_numbers(position, harmonics, depth, gravity)
        amplitude, sign = larger(np.array([waves.there]), np.array([waves.back]))
        incident = Incident(np.array([1 / harmonics[0].period]), amplitude, depth, gravity, 0.0, waves.wave_number)
    if not harmonics or len(gauges.names) > 2:
        frequency, there, back = separate(position, gauges.time, gauges.depth, depth, gravity, peak)
        numbers["separation"] = reflection_numbers(there, back)
        if not harmonics:
            amplitude, sign = larger(there, back)
            incident = Incident(frequency, amplitude, depth, gravity, gauges.time[0])
    incident.sign = sign
    return incident


def body_place(run, probe, gauges):
    """Distance (m) of a floating body's centre from the first gauge along the waves, on average; 0 for other probes."""
    if probe["type"] != "motion":
        return 0.0
    body = next(body for body in run.case["body"] if body["name"] == probe["body"])
    place = np.array(body["centre"][:run.dimension - 1], dtype=float)
    for n, axis in enumerate("xy"[:run.dimension - 1]):
        curve = run.curve(probe["name"], f"displacement_{axis}_m").window(gauges.time[0], gauges.time[-1])
        place[n] += curve.value.mean()
    return float(gauges.position(place[None, :])[0])


def columns_of(run, probe):
    """Columns of a motion or force probe that respond to waves."""
    table = (run.path / "probes" / f"{probe['name']}.csv").read_text(encoding="utf-8").splitlines()
    heading = next(line for line in table if not line.startswith("#")).split(",")
    kinds = ("displacement_", "angle_") if probe["type"] == "motion" else ("force_", "moment_")
    return [column.strip() for column in heading if column.strip().startswith(kinds)]


def answer_of(curve, gauges, incident, place, is_regular):
    """Response of one column: over the incident amplitude, with its phase, for each frequency; and its mean and drift."""
    value = np.interp(gauges.time, curve.time, curve.value)
    period = 1 / float(incident.frequency[np.argmax(np.abs(incident.amplitude))])
    times, means = period_means(gauges.time, value, period)
    mean, interval = mean_with_interval(means)
    slope, slope_interval = drift_with_interval(times, means)
    numbers = {"mean": mean, "mean_interval": interval, "drift_per_s": slope, "drift_interval_per_s": slope_interval}
    if is_regular:
        value = without_trend(gauges.time, value, trend_of(gauges.time, value, period))
        amplitude = fit_harmonics(gauges.time, value, period).amplitude
        ratio = amplitude[:1] / incident.at(place)
        return {**numbers, "amplitude": float(abs(amplitude[0])), "rao": float(abs(ratio[0])),
                "phase_deg": float(np.degrees(np.angle(ratio[0])))}
    rest = value - np.polyval(np.polyfit(gauges.time, value, 1), gauges.time)
    line = np.rint(incident.frequency * gauges.time.size * (gauges.time[1] - gauges.time[0])).astype(int)
    amplitude = 2 * np.fft.rfft(rest)[line] / rest.size
    frequency, ratio, coherence = response(incident.frequency, incident.at(place), amplitude)
    return {**numbers, "frequency_Hz": frequency.tolist(), "rao": np.abs(ratio).tolist(),
            "phase_deg": np.degrees(np.angle(ratio)).tolist(), "coherence": coherence.tolist()}


def response_numbers(run, names, gauges, incident, is_regular):
    """Responses of motion and force probes, per probe and column. Phases are leads over the incident crest: of a floating
    body at its mean position, of a force at the first gauge."""
    probes = {probe["name"]: probe for probe in run.case.get("probe", []) if probe["type"] in ("motion", "force")}
    found = {}
    for name in names:
        if name not in probes:
            raise DataError(f"{run.path}: has no motion or force probe '{name}'; it has {', '.join(probes) or 'none'}")
        place = body_place(run, probes[name], gauges)
        found[name] = {column: answer_of(run.curve(name, column), gauges, incident, place, is_regular)
                       for column in columns_of(run, probes[name])}
    return found


def damper_power(run, names, gauges, period):
    """Mean power (W) that the dampers of bodies take, with its interval, per motion probe of a body with dampers."""
    probes = {probe["name"]: probe for probe in run.case.get("probe", []) if probe["type"] == "motion"}
    bodies = {body["name"]: body for body in run.case.get("body", [])}
    found = {}
    for name in (name for name in names if name in probes):
        body = bodies[probes[name]["body"]]
        heading = (run.path / "probes" / f"{name}.csv").read_text(encoding="utf-8").splitlines()
        columns = [column.strip() for column in next(line for line in heading if not line.startswith("#")).split(",")]
        power = np.zeros(gauges.time.size)
        for key, exponent in (("damping", 2), ("quadratic_damping", 3)):
            velocities = [column for column in columns if "velocity" in column]
            for strength, column in zip(body.get(key, ()), velocities):
                curve = run.curve(name, column)
                power += strength * np.abs(np.interp(gauges.time, curve.time, curve.value)) ** exponent
        if power.any():
            mean, interval = mean_with_interval(period_means(gauges.time, power, period)[1])
            found[name] = {"mean": mean, "interval": interval}
    return found


def overtopping_numbers(run, name, window, period, height):
    """Mean discharge with its interval, and the volumes of single waves, of a discharge probe on a crest."""
    volume = run.curve(name, "volume_m3").window(*window)
    if volume.time.size < 2:
        raise DataError(f"{run.path}: probe '{name}' has no readings between {window[0]:.4g} and {window[1]:.4g} s")
    duration = float(volume.time[-1] - volume.time[0])
    discharge = float(volume.value[-1] - volume.value[0]) / duration
    edges = volume.time[-1] - period * np.arange(int(duration / period), -1, -1)
    _, interval = mean_with_interval(np.diff(np.interp(edges, volume.time, volume.value)) / period)
    times, volumes = overtopping_volumes(volume.time, volume.value, PAUSE * period)
    waves = duration / period
    return {"discharge": discharge, "discharge_interval": interval,
            "relative_discharge": discharge / float(np.sqrt(run.gravity * height**3)), "waves": waves,
            "overtopping_waves": int(volumes.size), "fraction": volumes.size / waves,
            "largest_volume": float(volumes.max(initial=0.0)), "times_s": times.tolist(), "volumes": volumes.tolist()}


def period_of_case(run):
    """The period (s) of the case's makers and zones of regular waves, if they have one period."""
    makers = [*run.case.get("wave_maker", []), *run.case.get("damping", [])]
    periods = {maker["period"] for maker in makers if maker["waves"] == "regular"}
    return periods.pop() if len(periods) == 1 else None


def regular_harmonics(gauges, period, is_given):
    """Harmonics at each gauge if the waves are regular. A period (s) that the user gives is believed. Throws DataError for
    one with too few readings."""
    readings = period / (gauges.time[1] - gauges.time[0])
    if is_given and readings < MIN_READINGS:
        raise DataError(f"gauges {', '.join(gauges.names)}: a period of {period:.4g} s has {readings:.2g} readings; its "
                        f"harmonics need {MIN_READINGS}; remedy: give the period of the waves, or read the gauges more often")
    if not is_given:
        period = best_period(gauges.time, gauges.depth[0], period)
    harmonics = [fit_harmonics(gauges.time, depth, period) for depth in gauges.depth]
    is_regular = all(found.residual < MAX_IRREGULAR * depth.std() for found, depth in zip(harmonics, gauges.depth))
    return harmonics if is_given or is_regular else []


def notes_on(gauges, harmonics, mean_period):
    """Notes on trends that were removed, and on a given period that is not that of the record."""
    notes = []
    if gauges.trend.any():
        trends = ", ".join(f"{name} {slope:+.3g} m/s" for name, slope in zip(gauges.names, gauges.trend) if slope)
        notes.append(f"the mean level has a trend, which is removed ({trends}); the set-up and its interval include it")
    rest = sum(found.residual**2 for found in harmonics)
    if rest > MAX_IRREGULAR**2 * gauges.depth.var(axis=1).sum():
        share = np.sqrt(rest / gauges.depth.var(axis=1).sum())
        notes.append(f"harmonics of the period {harmonics[0].period:.4g} s leave {100 * share:.2g} % of the rms of the records, whose "
                     f"mean period is {mean_period:.4g} s: the waves are irregular, or of another period")
    return notes


def analyse(run, names=(), start=None, end=None, depth=None, period=None, responses=(), overtopping=()):
    """(numbers, spectra) of a run's gauges between two times (s).

    `period` (s) is that of regular waves, by default the best fit; `responses` names motion and force probes, `overtopping`
    discharge probes. Throws DataError."""
    gauges = Gauges(run, list(names), start, end)
    window = (float(gauges.time[0]), float(gauges.time[-1]))
    known = period or period_of_case(run)
    gauges.remove_trends(known)
    first = numbers_in_window(gauges, 0, window, known)
    harmonics = regular_harmonics(gauges, known or first["T_mean_s"], bool(period))
    mean_period = harmonics[0].period if harmonics else first["T_mean_s"]
    gauges.whole_waves(mean_period)
    numbers = {"from_s": float(gauges.time[0]), "to_s": float(gauges.time[-1]), "gauges": {}}
    spectra = {}
    notes = notes_on(gauges, harmonics, first["T_mean_s"])
    if notes:
        numbers["notes"] = notes
    for n, (name, reading) in enumerate(zip(gauges.names, gauges.depth)):
        numbers["gauges"][name] = numbers_in_window(gauges, n, window, mean_period if harmonics else known)
        numbers["gauges"][name] |= set_up(gauges.time, gauges.level[n], gauges.still[n], mean_period)
        if gauges.trend[n]:
            numbers["gauges"][name]["trend_m_per_s"] = float(gauges.trend[n])
        if harmonics:
            numbers["gauges"][name]["harmonics"] = harmonic_numbers(harmonics[n])
        spectra["frequency_Hz"], spectra[f"{name}_m2_per_Hz"] = spectrum(gauges.time, reading)
    depths = [gauge["depth_m"] for gauge in numbers["gauges"].values()]
    still = depth or float(np.mean(depths))
    if harmonics:
        numbers["period_s"] = mean_period
    height = numbers["gauges"][gauges.names[0]]["Hm0_m"]
    is_even = bool(depth) or max(depths) <= MAX_UNEVEN * min(depths)
    if not is_even:
        numbers["uneven_depths_m"] = [min(depths), max(depths)]
        if responses:
            raise DataError(f"the gauges are over depths from {min(depths):.4g} to {max(depths):.4g} m, and a response needs "
                            "incident waves, which are found over an even bed; remedy: choose gauges over one depth, or give --depth")
    elif len(gauges.names) >= 2:
        incident = separation(gauges, numbers, still, run.gravity, harmonics)
        height = float(4 * np.sqrt((np.abs(incident.amplitude) ** 2).sum() / 2))
        numbers["responses"] = response_numbers(run, responses, gauges, incident, bool(harmonics))
        numbers["damper_power_W"] = damper_power(run, responses, gauges, mean_period)
    elif responses:
        raise DataError("a response needs two gauges or more, which separate the incident waves; remedy: add gauges")
    numbers["overtopping"] = {name: overtopping_numbers(run, name, window, mean_period, height) for name in overtopping}
    return numbers, spectra


def crest(curve):
    """(time, height over the first reading) of a curve's highest wave: the parabola through the samples above 0.9 of it."""
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
    if not 0.5 < speed / theory < 2.0:
        raise DataError(f"the highest crests at the gauges are not those of one solitary wave: they would run at {speed:.4g} "
                        f"m/s, and such a wave runs at {theory:.4g} m/s; remedy: leave out --solitary, or name gauges "
                        f"that it passes in this order")
    return {"gauges": found, "depth_m": depth, "speed_m_per_s": float(speed),
            "theory_m_per_s": float(theory), "difference": float(speed / theory - 1)}


def solitary_report(numbers):
    lines = [f"{'gauge':<12}{'at m':>8}{'crest s':>10}{'height m':>10}"]
    lines += [f"{name:<12}{gauge['position_m']:>8.3f}{gauge['time_s']:>10.4f}{gauge['height_m']:>10.5f}"
              for name, gauge in numbers["gauges"].items()]
    lines.append(f"speed {numbers['speed_m_per_s']:.4f} m/s; a solitary wave of this height (Fenton 1972) runs at "
                 f"{numbers['theory_m_per_s']:.4f} m/s: {100 * numbers['difference']:+.2f} %")
    return "\n".join(lines)


def gauge_table(numbers):
    """Lines of heights and periods, a gauge each."""
    lines = [f"{'gauge':<12}{'depth m':>10}{'waves':>7}{'H mean m':>10}{'H 1/3 m':>10}{'H max m':>10}{'Hm0 m':>10}"
             f"{'T mean s':>10}{'T peak s':>10}{'set-up m':>11}{'+-':>10}"]
    for name, gauge in numbers["gauges"].items():
        lines.append(f"{name:<12}{gauge['depth_m']:>10.4f}{gauge['waves']:>7}" + "".join(
            f"{gauge[key]:>10.4f}" for key in ("H_mean_m", "H_third_m", "H_max_m", "Hm0_m", "T_mean_s", "T_peak_s"))
            + f"{gauge['set_up_m']:>11.5f}{gauge['set_up_interval_m']:>10.5f}")
    return lines


def harmonic_table(numbers):
    """Lines of harmonics, a gauge each; empty for irregular waves."""
    if "period_s" not in numbers:
        return []
    lines = [f"harmonics of the period {numbers['period_s']:.5g} s: amplitude in m, and phase - n times that of the first"]
    for name, gauge in numbers["gauges"].items():
        found = gauge["harmonics"]
        lines.append(f"{name:<12}" + "".join(f"{amplitude:>10.5f} {phase:>+5.0f}" for amplitude, phase in
                                             zip(found["amplitude_m"], found["phase_from_first_deg"])))
    return lines


def separation_lines(numbers):
    """Lines on incident and reflected waves."""
    lines = []
    if "uneven_depths_m" in numbers:
        least, largest = numbers["uneven_depths_m"]
        lines.append(f"no incident and reflected waves: the gauges are over depths from {least:.4g} to {largest:.4g} m; "
                     "choose gauges over an even bed, or give --depth")
    if "separation" in numbers:
        found = numbers["separation"]
        lines.append(f"Hm0 {found['Hm0_there_m']:.4f} m incident, {found['Hm0_back_m']:.4f} m reflected "
                     f"({100 * found['reflection']:.1f} %); the waves run {found['runs']}")
    if "regular" in numbers:
        found = numbers["regular"]
        lines.append(f"regular waves: H {found['H_there_m']:.4f} m incident, {found['H_back_m']:.4f} m reflected "
                     f"({100 * found['reflection']:.1f} %); wavelength {found['wavelength_m']:.4g} m")
        if "second_m" in found:
            lines.append("second harmonic: " + ", ".join(f"{name.replace('_', ' ')} {value:.5f} m"
                                                         for name, value in found["second_m"].items()))
    return lines


def response_lines(numbers):
    """Lines on responses of bodies and forces, and on the power of dampers."""
    lines = []
    for name, columns in numbers.get("responses", {}).items():
        for column, found in columns.items():
            head = f"{name}.{column}: mean {found['mean']:.5g} +- {found['mean_interval']:.2g}, drift " \
                   f"{found['drift_per_s']:.4g} +- {found['drift_interval_per_s']:.2g} per s"
            if "amplitude" in found:
                head += f"; {found['rao']:.5g} per m of wave amplitude, leads the crest by {found['phase_deg']:.1f} deg"
            lines.append(head)
            if "frequency_Hz" in found:
                lines += ["   {:.4f} Hz: {:.5g} per m, leads by {:.1f} deg, coherence {:.2f}".format(*row)
                          for row in zip(*(found[key] for key in ("frequency_Hz", "rao", "phase_deg", "coherence")))]
    return lines + [f"{name}: dampers take {found['mean']:.4g} +- {found['interval']:.2g} W"
                    for name, found in numbers.get("damper_power_W", {}).items()]


def overtopping_lines(numbers):
    """Lines on overtopping."""
    return [f"{name}: q {found['discharge']:.4g} +- {found['discharge_interval']:.2g} m^3/s, q/sqrt(g Hm0^3) "
            f"{found['relative_discharge']:.4g}; {found['overtopping_waves']} of {found['waves']:.0f} waves overtop, the largest "
            f"with {found['largest_volume']:.4g} m^3" for name, found in numbers["overtopping"].items()]


def report(numbers):
    """The text that the command prints."""
    return "\n".join([f"from {numbers['from_s']:.4g} to {numbers['to_s']:.4g} s",
                      *(f"note: {note}" for note in numbers.get("notes", [])), *gauge_table(numbers), *harmonic_table(numbers),
                      *separation_lines(numbers), *response_lines(numbers), *overtopping_lines(numbers)])


def write_spectra(path, spectra):
    """Writes the spectra as a CSV file."""
    names = list(spectra)
    lines = [",".join(names)]
    lines += [",".join(f"{value:.9g}" for value in row) for row in zip(*spectra.values())]
    write_whole_text(path, "\n".join(lines) + "\n")


def without_nan(value):
    """Replaces nan, which JSON does not have, by None."""
    if isinstance(value, dict):
        return {key: without_nan(item) for key, item in value.items()}
    if isinstance(value, list):
        return [without_nan(item) for item in value]
    return None if isinstance(value, float) and np.isnan(value) else value


def print_waves(options):
    """Prints and writes the numbers. Throws DataError, IoError."""
    run, spectra = Run(options.run), None
    if options.solitary:
        numbers = solitary(run, options.gauges)
    else:
        numbers, spectra = analyse(run, options.gauges, options.start, options.end, options.depth, options.period,
                                   options.response, options.overtopping)
    print(solitary_report(numbers) if options.solitary else report(numbers))
    write_whole_text(options.run / "waves.json", json.dumps(without_nan(numbers), indent=2) + "\n")
    if spectra:
        write_spectra(options.run / "waves_spectrum.csv", spectra)


def main(arguments):
    """Runs the command and returns its exit code."""
    parser = Parser("tailwater waves", description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="folder of a run")
    parser.add_argument("gauges", nargs="*", metavar="GAUGE", help="depth probes, in the direction of wave travel (all)")
    parser.add_argument("--from", type=number, dest="start", metavar="S", help="start of the window, s (start of the run)")
    parser.add_argument("--to", type=number, dest="end", metavar="S", help="end of the window, s (end of the run)")
    parser.add_argument("--depth", type=number, metavar="M", help="still-water depth, m (mean of the gauges)")
    parser.add_argument("--period", type=number, metavar="S", help="period of regular waves, s (best fit); with it the window "
                        "may be as short as one period")
    parser.add_argument("--response", action="append", default=[], metavar="PROBE", help="motion or force probe: response to "
                        "the incident waves, mean and drift; may be repeated")
    parser.add_argument("--overtopping", action="append", default=[], metavar="PROBE", help="discharge probe on a crest: "
                        "overtopping volumes; may be repeated")
    parser.add_argument("--solitary", action="store_true", help="evaluate a solitary wave: height and speed")
    options = parser.parse_args(arguments)
    for name, what in (("depth", "depth"), ("period", "period")):
        value = getattr(options, name)
        if value is not None and value <= 0:
            parser.error(f"--{name} {value:g}: a {what} is above 0")
    return exit_code_of(lambda: print_waves(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
