"""Dam break against a box in 3D, SPHERIC 2: cases/kleefsman2005 (its README lists the measurements).

Times in s, heights over the water's depth at the start, pressures in Pa.
"""

from functools import partial

import numpy as np

from tailwater.curves import Curve
from tailwater.errors import DataError
from tailwater.fields import list_frames, read_frame

from .. import panels
from ..curves import arrival_time, differences
from ..metric import Metric, measure
from ..reading import summary
from ..study import AllChecks
from .laboratory import laboratory_study, measured_curves

NAME = "kleefsman2005"
DEPTH = 0.55  # m
TANK = np.array([3.22, 1.0, 1.0])  # m; open at its top
END = 6.0  # s
GRID = 0.01  # s, between the instants at which heights are compared

GAUGES = ("H1", "H2", "H3", "H4")
HEIGHT_BARS = {"H2": 4.0, "H4": 2.0}  # percent of the depth, mean over END

SENSORS = {"P1": 0.021, "P2": 0.061, "P3": 0.101, "P4": 0.141}  # m, heights on the face towards the water
# The sensors drift by some 50 Pa before the impact; ten times that is a tenth of the hydrostatic pressure at the start.
THRESHOLD = 500.0  # Pa
NOT_BEFORE = 0.3  # s; the door's own shocks are over
IMPACT = (0.4, 1.0)  # s; the window of largest pressures and impulses
# s; a row of particles that meets the face is stopped within dx/u = 9 ms at H/15, and its pressure there is the step's
# (docs/theory/probes.md). Both curves are averaged over three of these times before their largest values are compared.
MEAN_OVER = 0.03
ARRIVAL_BAR, PEAK_BAR, IMPULSE_BAR = 0.01, 15.0, 10.0  # s, percent, percent
RISE_BAR, DENSITY_BAR = 1e-4, 0.01  # of the energy at the start; rms


def laboratory(run, name):
    """Measured height (m) or pressure (Pa), as a curve over s."""
    curve, = measured_curves(run, name).values()
    return curve


def computed(run, name, column="connected_m"):
    return run.curve(name, column if name in GAUGES else "pressure_Pa")


def mean_error(run, gauge, end, column="connected_m"):
    """Mean distance of the heights until `end` (s), percent of the depth."""
    return 100 * float(np.abs(differences(laboratory(run, gauge), computed(run, gauge, column), 0, end, GRID)).mean()) / DEPTH


def arrival(curve):
    """Time of arrival, s. Throws DataError if the pressure never exceeds the threshold."""
    time = arrival_time(curve, THRESHOLD, NOT_BEFORE)
    if time is None:
        raise DataError(f"the pressure never exceeds {THRESHOLD:g} Pa")
    return time


def impulses(curve):
    """Impulse of a measured pressure, Pa s, since its first sample; a run has a column with its impulse."""
    steps = 0.5 * (curve.value[1:] + curve.value[:-1]) * np.diff(curve.time)
    return Curve(curve.time, np.concatenate([[0.0], np.cumsum(steps)]))


def gains(impulse, start, end):
    """Increase of an impulse from each start to its end, Pa s. Throws DataError if the curve does not cover IMPACT."""
    if impulse.time[0] > IMPACT[0] or impulse.time[-1] < IMPACT[1]:
        raise DataError(f"the curve does not cover {IMPACT[0]:g}..{IMPACT[1]:g} s")
    return np.interp(end, impulse.time, impulse.value) - np.interp(start, impulse.time, impulse.value)


def largest(impulse):
    """Largest of all means over MEAN_OVER, Pa. Such a mean begins or ends at a sample, because impulses are linear
    between samples."""
    starts = np.clip(np.concatenate([impulse.time, impulse.time - MEAN_OVER]), IMPACT[0], IMPACT[1] - MEAN_OVER)
    return float(gains(impulse, starts, starts + MEAN_OVER).max()) / MEAN_OVER


def of_impact(impulse):
    """Impulse of the impact, Pa s."""
    return float(gains(impulse, *IMPACT))


def excess(read, run, sensor):
    """Excess of a number of the computed impulse over that of the measured one, percent."""
    return 100 * (read(run.curve(sensor, "impulse_Pa_s")) / read(impulses(laboratory(run, sensor))) - 1)


def end_of(run):
    """End of the comparison, s; also for a run that was stopped."""
    asked = run.case["time"]["end"]
    return min(END, asked, run.summary.get("time_s", {}).get("reached", asked))


def of_heights(run):
    """Metrics of the heights. A run that ends before END has no target."""
    end = end_of(run)
    is_whole = end == END
    columns = (("", "without spray", "connected_m"), (" highest", "highest water", "highest_m"))
    return [measure(Metric(f"mean error {gauge}{suffix}", f"water height {gauge}, {label}, mean error over t = 0..{end:.3g} s",
                           "% of H", "laboratory", high=HEIGHT_BARS.get(gauge) if is_whole and not suffix else None),
                    partial(mean_error, run, gauge, end, column))
            for gauge in GAUGES for suffix, label, column in columns]


def of_sensor(run, sensor, height):
    measured = laboratory(run, sensor)
    return [
        measure(Metric(f"arrival {sensor}", f"arrival at {sensor}, z = {height:g} m, later than measured", "s",
                       f"laboratory: {arrival(measured):.3f}", -ARRIVAL_BAR, ARRIVAL_BAR),
                lambda: arrival(computed(run, sensor)) - arrival(measured)),
        measure(Metric(f"largest {sensor}", f"largest mean over {MEAN_OVER:g} s at {sensor}, excess over the measured value",
                       "%",
                       f"laboratory: {largest(impulses(measured)):.0f} Pa", -PEAK_BAR, PEAK_BAR), partial(excess, largest, run, sensor)),
        measure(Metric(f"impulse {sensor}", f"impulse at {sensor}, t = {IMPACT[0]:g}..{IMPACT[1]:g} s, excess over the measured value", "%",
                       f"laboratory: {of_impact(impulses(measured)):.0f} Pa s", -IMPULSE_BAR, IMPULSE_BAR),
                partial(excess, of_impact, run, sensor)),
    ]


def height_of_passage(position, velocity, gravity):
    """Height (m) at which particles outside the tank passed the plane of a wall, from their present positions in
    free fall."""
    sides, speed = position[:, :2], velocity[:, :2]
    beyond = np.where(sides < 0, sides, np.maximum(sides - TANK[:2], 0))
    since = np.divide(beyond, speed, out=np.zeros_like(beyond), where=beyond != 0).max(axis=1)
    return position[:, 2] - velocity[:, 2] * since - 0.5 * gravity * since**2


def lost_through_walls(run):
    """Particles that are missing or outside at the end, less those that were observed to leave over the tank's rim,
    as water does in the laboratory. In zones of refinement particles also vanish because they merge."""
    if summary("volume", "outside_the_walls_end", run) == 0:
        return 0
    merge = bool(run.case.get("refinement"))
    all_of_them, over_the_rim = None, set()
    for entry in list_frames(run.path):
        frame = read_frame(*entry)
        ids = frame.fields["id"]
        all_of_them = all_of_them or set(ids)
        outside = ((frame.position[:, :2] < 0) | (frame.position[:, :2] > TANK[:2])).any(axis=1)
        heights = height_of_passage(frame.position[outside], frame.fields["velocity"][outside], run.gravity)
        over_the_rim.update(ids[outside][heights > TANK[2]])
    missing = set(ids[outside]) if merge else all_of_them - set(ids[~outside])
    return len(missing - over_the_rim)


def of_health(run):
    return [
        measure(Metric("energy rise", "largest rise of the total energy", "of the start", "0", high=RISE_BAR),
                partial(summary, "energy", "largest_rise_over_start", run)),
        measure(Metric("density rms", "density error, rms over the bulk and time", "", "0", high=DENSITY_BAR),
                partial(summary, "volume", "density_error_rms", run)),
        measure(Metric("outside", "particles lost other than over the open tank's rim", "particles", "0", 0, 0),
                partial(lost_through_walls, run))]


def metrics(run):
    """All numbers of a run, as [Metric]."""
    return [*of_heights(run), *(one for sensor, height in SENSORS.items() for one in of_sensor(run, sensor, height)),
            *of_health(run)]


def draw(run):
    """Pressures around the impact, heights to the end; a spike of a few steps must not squeeze the curves."""
    def beside(sensor, curves, title, unit, window, limits):
        measured = laboratory(run, sensor).window(*window)
        return panels.panel(title, "t (s)", unit, (panels.over_time("laboratory", measured, "measured"), *(
            panels.over_time(label, curve.window(*window), kind) for label, curve, kind in curves)),
            limits=limits or (-0.05 * measured.value.max(), 1.3 * measured.value.max()))

    return [*(beside(sensor, [("computed", computed(run, sensor), "run")], f"{sensor}, z = {height:g} m", "pressure (Pa)",
                     (0.3, 1.3), None) for sensor, height in SENSORS.items()),
            *(beside(gauge, [("without spray", computed(run, gauge), "run"),
                             ("highest water", computed(run, gauge, "highest_m"), "aside")], gauge, "height (m)",
                     (0, end_of(run)), (0, DEPTH)) for gauge in GAUGES)]


def box_run(plan, count, end):
    """The box with `count` particles over the water's depth, until `end` (s)."""
    return plan.run(f"{NAME}_H-{count}_{end:g}s", f"{NAME}/case.toml",
                    (f"particles.spacing=H/{count}", f"time.end={end}"), 8.5 * end * (count / 11) ** 3.6,
                    plan.integrators[0])


def zone_run(plan):
    """H/15, with a zone of H/30 around the box, until the end of the impact."""
    return plan.run(f"{NAME}_zone", f"{NAME}/zone.toml", (), 110, plan.integrators[0])


def zone_checks(plan):
    """Checks that the zone gives the impulses of the uniform fine run, which is part of the tier fine."""
    if plan.level != "fine":
        return ()
    return (AllChecks(f"{NAME}.zone", metrics, (zone_run(plan),), keep=lambda name: name[:7] in ("arrival", "impulse"),
                      suffix=", zone of H/30 in H/15"),)


def study(plan):
    counts, end = plan.at((11,), (11, 15), (15, 30)), plan.at(1.0, END, END)
    return laboratory_study(
        NAME, "Dam break against a box in 3D: Kleefsman et al. (2005), SPHERIC 2", metrics, draw,
        "Water 0.55 m deep, 1.228 m long and 1 m wide runs against a box 0.161 m high in a tank 3.22 m long. Heights of the water "
        "at four places and pressures on the box's face. The benchmark's own spacing is H/30, 108 000 particles.",
        "Sensors drift by 50 Pa before the impact; a door that a weight pulls up lets the water go.",
        tuple(box_run(plan, count, end) for count in counts),
        tuple((gauge, f"mean error {gauge}") for gauge in GAUGES), "mean error of heights (% of H)",
        keep=lambda name: not name.endswith("highest"), more_checks=zone_checks(plan), shown=None)  # in 3D, too large for a report of one file
