#!/usr/bin/python3
"""Tests whether the intervals of `tailwater study` contain the known values: the table of docs/theory/uncertainty.md.

Each flow has one number whose truth is known, taken over that truth. A study at seven spacings, with runs from other
starts and one with half of the time step, gives it an interval, which should contain 1 and be narrow.

Usage: scripts/interval_study.py DIR [NAME ...] [--jobs N] [--finer F]    needs the program (scripts/build.sh)
--finer F divides all spacings. Called again it continues with the missing runs. All of it takes half an hour of CPU time.
"""
import argparse
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "validation"), str(ROOT / "python")]
import tailwater as tw  # noqa: E402
from tailwater_validation import exact_flows, shallow_water  # noqa: E402


def error_of(flow, name):
    """1 + an error that validate has."""
    return lambda run: 1 + exact_flows.FLOWS[flow](run)[name]


def long_axis(run):
    series = exact_flows.frames(run)
    start, end = (exact_flows.semi_axes(frame.position) for frame in (series[0], series[-1]))
    return end[0] / exact_flows.drop_axes([series[-1].time], run.parameters["A"], *start)[0][0]


def mean_speed(run):
    last = exact_flows.frames(run)[-1]
    velocity, = exact_flows.fields(run, last, "velocity")
    profile, _ = exact_flows.poiseuille_exact(run)
    gap = run.parameters["L"]
    y = (np.arange(1000) + 0.5) * gap / 1000
    return velocity[:, 0].mean() / profile(y, last.time).mean()


def run_up(run):
    """Over Synolakis's law, above the probe's own reading of the still water from a tenth to a quarter of the time to the
    highest. The first reading is 0.7 to 1.2 dx too low, by how the lattice meets the beach; those 0.90 to 0.95 dx."""
    beach = run.curve("beach", "connected_m")
    law, last = exact_flows.FLOWS["run-up"](run)["law_over_depth"], beach.time[int(np.argmax(beach.value))]
    still = beach.window(0.1 * last, 0.25 * last).value.mean()
    return float(beach.value.max() - still) / run.parameters["h"] / law


def late_discharge(run):
    """Over that of shallow water, which is the limit of late times: from T = 3 to 4 it is 1 % less, from 5 to 6 0.2 %. So
    that of the second half of the run."""
    return shallow_water.late_discharge(run, since=0.5 * run.parameters["T"]) / (8 / 27)


# Description, source of its truth; the case; the coarsest spacing (the finest is half of it); its evaluation.
FLOWS = {
    "poiseuille": ("mean speed at 95 % of the steady flow, series", "verification/poiseuille", "L/14", mean_speed),
    "ritter": ("late discharge of a dam break on a dry bed, 8/27", "verification/ritter", "h0/15", late_discharge),
    "stoker": ("speed of the bore, mass and momentum of its profile", "verification/stoker", "h0/25",
               lambda run: 1 + shallow_water.bore_speed_error(run)),
    "drop": ("long axis of a stretching drop, Monaghan (1994)", "robustness/drop", "R/20", long_axis),
    "run-up": ("run-up on a beach, Synolakis (1987)", "flume/run_up", "h/24", run_up),
    "solitary-wave": ("speed, Fenton (1972)", "solitary_wave/case", "h/8", error_of("solitary-wave", "speed_error")),
    "standing-wave": ("period, linear theory", "robustness/standing_wave", "depth/14", error_of("standing-wave", "period_error")),
    "weir": ("discharge for the head, Rehbock without surface tension", "flume/weir", "P/10", error_of("weir", "ideal_error")),
    "ogee": ("discharge for the energy head, potential flow (2.239 H^1.5)", "flume/ogee", "Hd/12", error_of("ogee", "potential_error")),
    "broad-weir": ("discharge for the energy head, potential flow (0.9835 of critical)", "flume/broad_weir", "P/8",
                   error_of("broad-weir", "potential_error")),
    "gate": ("contraction, potential flow with gravity (0.599)", "flume/sluice_gate", "a/3", error_of("sluice-gate", "contraction_error")),
    "jump": ("depth behind the jump, momentum of its profile", "flume/hydraulic_jump", "h1/3.5",
             error_of("hydraulic-jump", "momentum_error")),
}
# Ritter's discharge is late, so for longer. The readings of a jump fluctuate with its roller: twice the time, in a channel
# in which it does not wander to the gauge before it. So does a bore: a third more time, profiles five times as often. An
# ogee is steady after 2 s, and its nose has a radius of 2.4 to 4.8 dx: finer, for less time.
SETTINGS = {"ritter": {"parameters.T": 10.0},
            "stoker": {"parameters.T": 8.0, "probe[1].times": [f"{k / 10:g}*sqrt(h0/g)" for k in range(30, 80)]},
            "ogee": {"time.end": 5.0},
            "jump": {"parameters.L": "30*h1", "time.end": 16.0, "probe[4].times": [8 + k / 4 for k in range(1, 32)]}}


def study(name, options):
    _, case, coarsest, read = FLOWS[name]
    case = tw.Case(ROOT / "cases" / f"{case}.toml")
    case.update({"particles.spacing": f"{coarsest}/{2 * options.finer:g}", **SETTINGS.get(name, {})})
    found = tw.study(case, out=options.out / name, jobs=options.jobs,
                     quantities=lambda run: {(name, "over the truth"): (read(run), "")})
    return found.rows[0]


def options_of(words=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path, metavar="DIR")
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--jobs", type=int, default=2, metavar="N")
    parser.add_argument("--finer", type=float, default=1.0, metavar="F")
    options = parser.parse_intermixed_args(words)
    options.names = options.names or list(FLOWS)
    if wrong := [name for name in options.names if name not in FLOWS]:
        parser.error(f"{wrong[0]}: no flow has this name; they are {', '.join(FLOWS)}")
    return options


def main():
    options = options_of()
    options.out.mkdir(parents=True, exist_ok=True)
    print("| flow | number, truth | finest value | limit | interval, half width | chance, step | contains 1 | "
          "Eça & Hoekstra |\n| --- | --- | --- | --- | --- | --- | --- | --- |", flush=True)
    contain = narrow = theirs = count = 0
    for name in options.names:
        try:
            row = study(name, options)
        except tw.Error as error:
            print(f"{name}: {error}", file=sys.stderr)
            continue
        is_inside, width, their_width = row["low"] <= 1 <= row["high"], row["uncertainty"], row["eca_hoekstra"]
        contain, narrow, count = contain + is_inside, narrow + (width <= 0.05), count + 1
        theirs += abs(row["value"] - 1) <= their_width
        print(f"| {name} | {FLOWS[name][0]} | {row['value']:.4f} | {row['limit']:.4f} | {row['low']:.4f} to {row['high']:.4f}, "
              f"{100 * width:.1f} % | {100 * row['chance']:.1f}, {100 * row['step']:.1f} % | {'yes' if is_inside else '**no**'} | "
              f"± {100 * their_width:.1f} % |", flush=True)
    print(f"\n{contain} of {count} intervals contain the truth; {narrow} have a half width of at most 5 %. Those of Eça & "
          f"Hoekstra around the finest value: {theirs}.")


if __name__ == "__main__":
    main()
