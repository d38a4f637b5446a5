"""Impact of a dam break on a wall: cases/zhou1999 (its README lists the measurements and their sources).

T = t sqrt(g/H); depths over H; pressures over rho g H. Two people digitised the same curves; a distance from the
laboratory is the mean of those from both.
"""

from functools import partial

import numpy as np

from tailwater.errors import DataError
from tailwater.fields import nearest_frames

from .. import panels
from ..checks import Check
from ..curves import arrival_time, compare, first_peak, noise
from ..metric import Metric, measure
from ..particles import detached
from ..peers import peers_of
from ..reading import summary
from ..study import LABORATORY, Plot, Study
from .laboratory import measured_curves

H, TANK, GRAVITY, DENSITY = 0.6, 3.22, 9.81, 1000.0
TIME_SCALE, PRESSURE_SCALE = (H / GRAVITY) ** 0.5, DENSITY * GRAVITY * H

TIME_UNCERTAINTY = 0.12  # of T: the instant of release is known to 0.03 s
LABORATORY_QUIET = 1.5  # T before which the gauge shows only the noise of the release

# The targets. Depths: by window of T, largest RMS over H.
DEPTH_TARGETS = {(0.0, 6.0): 0.05, (0.0, 8.0): 0.10}
PRESSURE_TARGET = 0.20  # rho g H, RMS at the best shift
NOISE_TARGET = 6e-3  # rho g H
ARRIVAL_TARGET = (0.61, 0.64)  # s
RISE_TARGET = 1e-4  # of the energy at the start

# This dam break by other programs, at 0.015 m with free walls, as benchmarks/beside.py has measured them.
COST_PEERS = peers_of("zhou", "cpu_s_per_simulated_s")

GRID = 0.01  # of T, on which curves are compared
PRESSURE_WINDOW = (2.4, 7.0)
ARRIVAL_THRESHOLD = 0.05
FIRST_PEAK_WITHIN = 0.75  # of T after the arrival: the jet has met the wall, the water above has not come down yet
NOISE_WINDOW = (0.6, 1.4)  # s
NOISE_MEDIAN = 0.02  # s

GAUGES = ("H1", "H2")
POINT_HEIGHTS = {"P060": 0.06, "P115": 0.115, "P120": 0.12, "P160": 0.16}  # m, of the point probes
READ_AT = "P120"  # the height 0.2 H that Buchner (2002) gives for the gauge; the case's README argues for it
NOISE_AT = "P160"  # where others' noise was read


def laboratory(run, quantity):
    """{person who digitised the curves: measured H1, H2 (over H) or P2 (over rho g H), as a curve over T}."""
    scale = PRESSURE_SCALE if quantity == "P2" else H
    return {name.rpartition("_")[2]: curve.scaled(1 / TIME_SCALE, 1 / scale)
            for name, curve in measured_curves(run, quantity).items()}


def depth(run, gauge, column="wet_m"):
    """Computed depth over H at a gauge, as a curve over T; by default the reading of the laboratory's wire, its wet
    length."""
    return run.curve(gauge, column).scaled(1 / TIME_SCALE, 1 / H)


def pressure(run, probe):
    """Computed wall pressure over rho g H, as a curve over T."""
    return run.curve(probe, "pressure_Pa").scaled(1 / TIME_SCALE, 1 / PRESSURE_SCALE)


def distance(run, probe, window=PRESSURE_WINDOW, column="wet_m", reading=""):
    """Difference between a gauge's depth, or the pressure of a probe, and the laboratory: the fields of
    `curves.compare`, by default the mean over all digitised versions of its curve."""
    is_depth = probe in GAUGES
    computed = depth(run, probe, column) if is_depth else pressure(run, probe)
    found = [compare(curve, computed, window, GRID, TIME_UNCERTAINTY)
             for name, curve in laboratory(run, probe if is_depth else "P2").items() if reading in ("", name)]
    return {field: sum(one[field] for one in found) / len(found) for field in found[0]}


def rms(run, *what, field="value"):
    """One number of that difference; "shifted_value" is that with the best shift in time."""
    return distance(run, *what)[field]


def arrival(curve, not_before=0.0):
    """Time (s) at which a pressure over rho g H, as a curve over T, first exceeds the threshold."""
    time = arrival_time(curve, ARRIVAL_THRESHOLD, not_before)
    if time is None:
        raise DataError(f"the pressure never exceeds {ARRIVAL_THRESHOLD} rho g H")
    return time * TIME_SCALE


def arrival_at(run, probe=READ_AT):
    return arrival(pressure(run, probe))


def front_arrival(run):
    """Time (s) at which the front, half a spacing ahead of the first particle, is within a spacing of the wall."""
    time = arrival_time(run.curve("front", "front_m"), TANK - run.spacing)
    if time is None:
        raise DataError("the front never reaches the wall")
    return time


def peak(curve, not_before=0.0):
    """(T, pressure over rho g H) of the first peak."""
    return first_peak(curve, arrival(curve, not_before) / TIME_SCALE, FIRST_PEAK_WITHIN)


def wall_noise(run):
    """RMS of the pressure about its running median, over rho g H."""
    return noise(run.curve(NOISE_AT, "pressure_Pa"), *NOISE_WINDOW, NOISE_MEDIAN) / PRESSURE_SCALE


def energy_at(T, run):
    """Total energy at a time T over that of the start."""
    kinetic, potential = run.step_curve("kinetic_J"), run.step_curve("potential_J")
    return float(np.interp(T * TIME_SCALE, kinetic.time, kinetic.value + potential.value)
                 / run.summary["energy"]["start_J"])


def measured(run, read):
    """"openmps 0.596, fluidity 0.607": values of the laboratory's P2, computed by the rule for the computed curve."""
    return ", ".join(f"{name} {read(curve, LABORATORY_QUIET):.3f}" for name, curve in laboratory(run, "P2").items())


def impact(run):
    """Time at which the water meets the wall, and its first peak there, as [Metric]."""
    arrivals = f"measured P2: {measured(run, arrival)} (+-{TIME_UNCERTAINTY * TIME_SCALE:.2f})"
    return [
        *(measure(Metric(f"arrival_{probe}", f"arrival, {probe}", "s", arrivals), partial(arrival_at, run, probe))
          for probe in (*POINT_HEIGHTS, "P2")),
        measure(Metric("arrival_front", "arrival, front at the wall", "s", arrivals), partial(front_arrival, run)),
        measure(Metric("peak_P2", "first peak, P2", "rho g H",
                       f"measured P2: {measured(run, lambda curve, after: peak(curve, after)[1])}"),
                lambda: peak(pressure(run, "P2"))[1]),
        measure(Metric("peak_time_P2", "time of first peak, P2", "T",
                       f"measured P2: {measured(run, lambda curve, after: peak(curve, after)[0])} (+-{TIME_UNCERTAINTY})"),
                lambda: peak(pressure(run, "P2"))[0])]


def distances(run, reading=""):
    """Difference from the laboratory for each gauge and window, as [Metric]; by default the mean over all digitised
    versions of its curves."""
    windows = [*((gauge, window, "H") for gauge in GAUGES for window in DEPTH_TARGETS),
               *((probe, PRESSURE_WINDOW, "rho g H") for probe in ("P2", *POINT_HEIGHTS))]
    return [measure(Metric(f"rms {probe} T {start:g}..{end:g} {reading}".rstrip(), f"RMS of {probe}, T {start:g}..{end:g}", unit,
                           reading or ", ".join(laboratory(run, "P2"))),
                    partial(distance, run, probe, (start, end), reading=reading))
            for probe, (start, end), unit in windows]


def metrics(run):
    """All numbers of a run, as [Metric]."""
    return [*impact(run), measure(Metric("noise", "noise of the wall pressure", "rho g H", ""), partial(wall_noise, run)),
            *distances(run)]


FREE_SLIP = ("wall.tank.slip=free",)


def zhou_run(plan, dx, integrator="explicit", variant="", settings=()):
    """A run to T = 8; costs 12 CPU s at dx = 0.02."""
    return plan.run("_".join(filter(None, (f"zhou1999_dx{dx:g}", variant))), "zhou1999/case.toml",
                    (f"particles.spacing={dx:g}", *settings), 12 * (0.02 / dx) ** 3.2, integrator)


def depth_checks(run):
    columns = (("wet_m", "", "wet length of a wire gauge"), ("connected_m", ".joined", "without spray"),
               ("highest_m", ".highest", "highest water"))
    return [Check(Metric(f"zhou1999.{gauge}.T{end:g}{key}", f"depth {gauge}, {words}, RMS over T = {start:g}..{end:g}", "H",
                         "mean over two readings of the laboratory's curve", high=None if key else bar), (run,),
                  partial(distance, probe=gauge, window=(start, end), column=column))
            for gauge in GAUGES for (start, end), bar in DEPTH_TARGETS.items() for column, key, words in columns]


def pressure_checks(run):
    readings = (("P120", "0.12 m", "z = 0.12 m"), ("P160", "0.16 m", "z = 0.16 m"),
                ("P2", "P2", "mean over z = 0.115..0.205 m"))
    return [
        *(Check(Metric(f"zhou1999.pressure.{key}", f"wall pressure, {words}, RMS over T = 2.4..7", "rho g H",
                       "mean over two readings of the laboratory's curve"), (run,), partial(distance, probe=probe))
          for probe, key, words in readings),
        Check(Metric("zhou1999.pressure.best", "wall pressure, z = 0.12 m, RMS over T = 2.4..7 at the best shift of time",
                     "rho g H", f"the laboratory's time is known to T = {TIME_UNCERTAINTY}",
                     high=PRESSURE_TARGET), (run,), lambda run: rms(run, READ_AT, field="shifted_value")),
        Check(Metric("zhou1999.arrival", "water reaches the gauge, z = 0.12 m: pressure above 0.05 rho g H", "s",
                     "measured 0.596 and 0.607 (+-0.03)", *ARRIVAL_TARGET), (run,), arrival_at),
        Check(Metric("zhou1999.noise", "noise of the wall pressure, z = 0.16 m", "rho g H",
                     "RMS about its running median of 0.02 s, t = 0.6..1.4 s", high=NOISE_TARGET), (run,), wall_noise),
    ]


def detached_at(T, run):
    frame, = nearest_frames(run.path, (T * TIME_SCALE,))
    return detached(frame.position, 1.5 * run.spacing)


def soundness_checks(run):
    return [
        Check(Metric("zhou1999.detached", "particles detached from the body of water at T = 5", "", "the paper's claim: none"),
              (run,), partial(detached_at, 5.0)),
        Check(Metric("zhou1999.energy_rise", "largest rise of the total energy", "of the start", "physics: none",
                     high=RISE_TARGET), (run,), partial(summary, "energy", "largest_rise_over_start")),
        Check(Metric("zhou1999.energy_rise_unexplained", "the same without the work of the density source", "of the start",
                     "physics: none"), (run,), partial(summary, "energy", "largest_rise_less_density_work_over_start")),
        Check(Metric("zhou1999.density", "density error, rms over the bulk and time", "", "incompressible: none",
                     high=0.01), (run,), partial(summary, "volume", "density_error_rms")),
    ]


def beside_laboratory(run, quantity, computed, end=8):
    """The digitised versions of the laboratory's curve to T = `end`, with the computed ones [(label, curve)]."""
    for name, curve in laboratory(run, quantity).items():
        yield panels.over_time(f"laboratory, read by {name}", curve.window(0, end), "measured")
    for label, curve in computed:
        yield panels.over_time(label, curve)


def draw_pressure(*runs, names=None):
    return [panels.panel(f"Pressure on the right wall, {title}", "T", "p/(rho g H)", beside_laboratory(
        runs[-1], "P2", zip(panels.labels(runs, names), (pressure(run, probe) for run in runs))), limits=(-0.05, 1.25))
            for probe, title in ((READ_AT, "z = 0.12 m"), ("P2", "mean over z = 0.115..0.205 m"))]


def draw_depths(*runs, names=None):
    return [panels.panel(f"Depth {gauge}, x = {place} m", "T", "h/H", (
        *beside_laboratory(runs[-1], gauge, zip(panels.labels(runs, names), (depth(run, gauge) for run in runs))),
        panels.over_time("highest water, the last run", depth(runs[-1], gauge, "highest_m"), "aside")), limits=(0, 1.6))
            for gauge, place in (("H2", 2.228), ("H1", 2.725))]


def draw_convergence(*runs):
    series = {f"depth {gauge}, T = 0..6 (H)": {run.spacing: rms(run, gauge, (0.0, 6.0)) for run in runs}
              for gauge in ("H2", "H1")}
    best = {run.spacing: rms(run, READ_AT, field="shifted_value") for run in runs}
    return panels.convergence(series | {"pressure, z = 0.12 m, best shift (rho g H)": best},
                              "RMS difference from the laboratory")


def study(plan):
    spacings = plan.at((0.02, 0.015), (0.02, 0.012, 0.008), (0.012, 0.008, 0.006, 0.004))
    plain, best = plan.integrators
    runs = tuple(zhou_run(plan, dx, best) for dx in spacings)
    finest = runs[-1]
    # The spacing, the integrator and the walls of the others' figures.
    beside = zhou_run(plan, 0.015, plain, "free-slip", FREE_SLIP)
    checks = [*depth_checks(finest), *pressure_checks(finest), *soundness_checks(finest),
              Check(Metric("zhou1999.cost", "CPU time per simulated second, dx = 0.015 m, explicit, free slip", "s",
                           "others: about 3200 particles, one thread", high=8.0, peers=COST_PEERS), (beside,),
                    partial(summary, "cost", "cpu_s_per_simulated_s")),
              Check(Metric("zhou1999.noise.explicit", "noise of the wall pressure, dx = 0.015 m, explicit, free slip", "rho g H", "",
                           high=NOISE_TARGET), (beside,), wall_noise)]
    return Study(
        "zhou1999", "Impact of a dam break on a wall: Zhou, De Kat & Buchner (1999)", LABORATORY,
        "A column of 1.2 m x 0.6 m runs over a dry floor, hits the wall at x = 3.22 m, climbs it, falls back and overturns. "
        "Compared with the laboratory's two water levels and its pressure gauge on the wall, as published and at the best "
        "shift within the uncertainty of its time. Lengths over H = 0.6 m, T = t sqrt(g/H). Farzin et al. (2014) compute it "
        "with 5155 and 11187 particles (dx = 0.012 and 0.008 m) and show curves without numbers.",
        "Two people read the same published curves: their readings differ by RMS 0.04 rho g H (pressure), 0.025 H (H1) and "
        "0.02 H (H2). The instant of release is known to 0.03 s, T = 0.12. Sources disagree on the height the pressure "
        "gauge stands for: 0.12 m, 0.16 m or the mean over 0.115..0.205 m; all are given, the target is put on 0.12 m "
        "(cases/zhou1999/README.md argues why). After T = 6 the laboratory's wave encloses air, which is not computed: the level "
        "H1 then depends on what is read: a wire gauge, which the laboratory had, reads the length under water; the depth without "
        "spray and the highest water are given beside it. No error bars were published.",
        tuple(checks),
        (Plot("Pressure on the wall. Points: two readings of the laboratory's curve, whose time is known to "
              f"T = {TIME_UNCERTAINTY}.", runs, draw_pressure),
         Plot("Water levels. Points: two readings of the laboratory's curves.", runs, draw_depths),
         Plot("Differences from the laboratory by spacing. They end at the uncertainty of the data, not at zero.", runs,
              draw_convergence)),
        shown=finest, moments=tuple(T * TIME_SCALE for T in (1.0, 1.6, 2.4, 4.0, 5.6, 6.6)), time_scale=TIME_SCALE)
