"""Waves over a submerged sill: runs of cases/beji_battjes1993, beside the gauges of the laboratory."""

import csv
from pathlib import Path

import numpy as np

from tailwater.errors import DataError
from tailwater.wave_records import fit_harmonics

PERIODS = 3  # at the end of the run, in which waves are read
HARMONICS = 4
FIRST = 4.0  # m; place of the gauge that gives the shift in time
BEHIND = 15.0  # m; gauges beyond it stand behind the crest of the sill
DATA = Path(__file__).resolve().parents[2] / "cases/beji_battjes1993/data"


def measured_records(folder):
    """{place: (time, elevation)} of the laboratory's gauges, in m and s."""
    records = {}
    for path in sorted(folder.glob("group_*.csv")):
        lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
        heading, *rows = csv.reader(lines)
        table = np.array(rows, dtype=float)
        for column, name in enumerate(heading[1:], start=1):
            records[float(name.removeprefix("eta_x").removesuffix("_m"))] = table[:, 0], table[:, column]
    return records


def amplitudes(time, value, period):
    """Complex amplitudes of the harmonics over whole periods."""
    return fit_harmonics(time, value, period, count=HARMONICS).amplitude


def computed_records(run):
    """{place: (time, elevation)} in the last periods of the run."""
    end = run.case["time"]["end"]
    records = {}
    for probe in run.case["probe"]:
        curve = run.curve(probe["name"], "highest_m")
        if curve.time[-1] < end - 0.1:
            raise DataError(f"{run.path}: its gauge '{probe['name']}' ends at {curve.time[-1]:.4g} s, the run at {end:.4g} s")
        curve = curve.window(end - PERIODS * run.parameters["T"], end)
        records[float(probe["at"][0])] = curve.time, curve.value
    return records


def beji_battjes(run, folder=DATA):
    """Numbers for each gauge, x in m: rms_over_H, of the difference of the harmonics' sums over the height in the case;
    harmonics, computed amplitudes less measured ones, over the largest measured one of the gauge. The instant at which the
    laboratory's time begins is free: the first harmonics agree at x = 4 m."""
    period, height = run.parameters["T"], run.parameters["H"]
    ours, theirs = computed_records(run), measured_records(folder)
    found = {x: amplitudes(*ours[x], period) for x in theirs}
    wanted = {x: amplitudes(*theirs[x], period) for x in theirs}
    shift = np.angle(found[FIRST][0] / wanted[FIRST][0])
    order = np.arange(1, HARMONICS + 1)
    gauges = {}
    for x in sorted(theirs):
        difference = found[x] - wanted[x] * np.exp(1j * order * shift)
        gauges[f"x{x:g}"] = {
            "rms_over_H": float(np.sqrt((np.abs(difference) ** 2).sum() / 2) / height),
            "measured_mm": [1e3 * float(a) for a in np.abs(wanted[x])], "computed_mm": [1e3 * float(a) for a in np.abs(found[x])],
            "harmonics": [float(a) for a in (np.abs(found[x]) - np.abs(wanted[x])) / np.abs(wanted[x]).max()]}
    behind = [gauge for name, gauge in gauges.items() if float(name[1:]) > BEHIND]
    return {"rms_over_H": float(np.sqrt(np.mean([gauge["rms_over_H"] ** 2 for gauge in gauges.values()]))),
            "largest_rms_over_H": max(gauge["rms_over_H"] for gauge in gauges.values()),
            "largest_error_of_harmonics_behind": max(max(map(abs, gauge["harmonics"][:3])) for gauge in behind), "gauges": gauges}
