"""Flows in a flume against the formulas of hydraulics."""

from functools import partial

from .. import panels
from ..checks import Check
from ..metric import Metric
from ..reading import exact, signed
from ..study import EXACT, LABORATORY, OrderCheck, Plot, Study


def draw_gauge(probe, *runs):
    """The depth at a gauge over time."""
    return [panels.panel("", "t (s)", "depth (m)", (panels.over_time(f"dx = {run.spacing:.3g} m", run.curve(probe, "connected_m"))
                                                    for run in runs))]


def flume_study(plan, name, title, about, uncertainty, gauge, rows, seconds, quantities, kind=EXACT):
    """A study of cases/flume at several numbers of `rows`: particles over the case's own length, (key, its rows at
    quick and at paper); `seconds` of CPU time at the first. `quantities`: (key, words, unit, against, target)."""
    length, quick, paper = rows
    chosen = plan.at(quick, paper, paper)
    runs = tuple(plan.run(f"{name}_{length}{n}", f"flume/{name.replace('-', '_')}.toml",
                          (f"particles.spacing={length}/{n}",), seconds * (n / quick[0]) ** 3.1) for n in chosen)
    checks = tuple(OrderCheck(Metric(f"{name}.{key}", words, unit, against, high=high), runs, partial(exact, name, key),
                              interval_of=partial(signed, name, key)) for key, words, unit, against, high in quantities)
    return Study(name, title, kind, about, uncertainty, checks,
                 (Plot("Depth at the gauge over time; numbers are means of the second half.", runs, partial(draw_gauge, gauge)),),
                 shown=runs[-1], moments=(8.0,))


def weir(plan):
    return flume_study(
        plan, "weir", "Sharp-crested weir: Rehbock (1929)",
        "50 l/s per metre over a thin weir 0.2 m high: discharge for the head that the water finds, against Rehbock's formula less its "
        "1.1 mm for surface tension and viscosity, 1.8 % of the discharge here, which this water does not have.",
        "Rehbock's own measurements scatter by less than 1 % about his formula.",
        "upstream", ("P", (10,), (12, 16, 24)), 16.0,
        (("ideal_error", "discharge for the head upstream, of water without surface tension, relative error", "",
          "Rehbock (1929) without 1.1 mm", 0.03),
         ("coefficient_error", "the same against laboratory water, which has surface tension", "", "Rehbock (1929)", None),
         ("head_error", "head for the discharge, relative error", "", "Rehbock (1929)", None)), LABORATORY)


def broad_weir(plan):
    return flume_study(
        plan, "broad-weir", "Broad-crested weir: critical flow on the crest",
        "50 l/s per metre over a weir with a rounded nose and a crest 0.4 m long, without friction: discharge for the energy head "
        "upstream, against sqrt(g) (2H/3)^1.5.",
        "The formula has straight streamlines and no friction on the crest; laboratories measure up to 2 % less on smooth weirs of "
        "this shape.",
        "upstream", ("P", (8,), (8, 10, 12)), 25.0,
        (("coefficient_error", "discharge for the energy head, relative error", "", "critical flow", 0.03),
         ("crest_over_critical", "depth in the middle of the crest over the critical depth", "", "critical flow", None)))


def ogee(plan):
    return flume_study(
        plan, "ogee", "Ogee crest at its design head",
        "69 l/s per metre over a spillway crest 0.2 m high, shaped by the U.S. Army Engineers' formulas for a head of 0.1 m: discharge for "
        "the energy head upstream, against 2.18 H^1.5.",
        "Laboratories and manuals have coefficients of 2.17 to 2.23 m^(1/2)/s for this shape.",
        "upstream", ("Hd", (8,), (8, 12, 16)), 20.0,
        (("coefficient_error", "discharge for the energy head, relative error", "", "2.18 H^1.5", 0.03),))


def sluice_gate(plan):
    return flume_study(
        plan, "sluice-gate", "Sluice gate: contraction",
        "Water shoots out freely under a sharp-edged gate: its depth 2.5 openings behind the gate over the opening.",
        "Potential flow with gravity has 0.598 for an opening of a quarter of the depth upstream, 0.611 for a small one; the surface "
        "upstream is taken as level.",
        "jet", ("a", (5,), (6, 9, 13)), 51.0,
        (("contraction_error", "contraction, relative error", "", "potential flow", 0.02),
         ("discharge_error", "discharge for both depths, relative error", "", "energy equation", None)))


def hydraulic_jump(plan):
    return flume_study(
        plan, "hydraulic-jump", "Hydraulic jump: Belanger's conjugate depths",
        "Supercritical water, Froude number 2.5, meets a tailwater of its conjugate depth, without friction: depth behind the jump "
        "for the depth and the speed before it, both seen from the jump, which may wander.",
        "Belanger's formula follows from mass and momentum alone, however the energy is lost, but for uniform flow behind the jump. "
        "Without friction the jet along the bed is still there at the gauge, and momentum with the computed velocities gives "
        "a depth lower by 4 to 7 %: that depth has the target.",
        "behind", ("h1", (4,), (4, 6, 9)), 45.0,
        (("momentum_error", "depth behind the jump, with the computed velocity profile there, relative error", "", "momentum", 0.02),
         ("conjugate_error", "the same, for uniform flow", "", "Belanger", None),
         ("momentum_coefficient", "momentum of the flow behind the jump over that of uniform flow", "", "1", None),
         ("wander_m_s", "speed at which the jump wanders", "m/s", "at rest", None)))


def channel(plan):
    return flume_study(
        plan, "channel", "Uniform flow through a channel with open ends",
        "0.11 m^2/s through 3 m of water 0.2 m deep without friction, inlet with a discharge, outlet with a tailwater, 10 s.",
        "The flow is uniform: nothing should change.",
        "depth_upstream", ("H", (8,), (8, 12, 18)), 16.0,
        (("discharge_error", "discharge in the middle, relative error", "", "inlet", 0.005),
         ("level_error_dx", "depth at two gauges, largest error", "dx", "tailwater", 0.25)))


def backwater(plan):
    return flume_study(
        plan, "backwater", "Backwater down a sloping channel with rough side walls",
        "0.09 m^2/s down a slope of 0.01 between rough side walls 50 mm apart, held up by a tailwater 0.21 m deep from a normal "
        "depth of 0.152 m; starts at the normal depth upstream.",
        "The curve is dh/dx = (S - S_f)/(1 - F^2) with the law of the wall that the solver has, so it tests levels, slope and "
        "discharge, and not that law. Without friction the depth upstream would be 36 mm less.",
        "upstream", ("H", (8,), (8, 12, 16)), 25.0,
        (("level_error_dx", "depth at three gauges, largest error", "dx", "backwater curve", 0.25),
         ("discharge_error", "discharge in the middle, relative error", "", "inlet", 0.005)))


def circulation(plan):
    length, end = plan.at(("10*H", 20), ("100*H", 200), ("100*H", 200))
    run = plan.run(f"circulation_{length.removesuffix('*H')}", "flume/circulation.toml",
                   (f"parameters.L={length}", f"time.end={end}"), plan.at(7.0, 350.0, 350.0))
    quantities = (("discharge_error", "discharge in the middle, relative error", "", "pump", 0.005),
                  ("level_error_dx", "depth at two gauges, largest error", "dx", "tailwater", 0.25),
                  ("lost_particles", "particles lost or made", "", "none", 0),
                  ("discharge_drift", "discharge of the last quarter over that of the one before, less 1", "", "none", None),
                  ("level_drift_dx", "change of the depth between the same quarters", "dx", "none", None))
    return Study(
        "circulation", "Uniform flow that circulates", EXACT,
        f"0.11 m^2/s through a channel {length.removesuffix('*H')} depths long with 5 particles over its depth, for {end} s: "
        "what leaves at the tailwater enters again.",
        "The flow is uniform: nothing should change.",
        tuple(Check(Metric(f"circulation.{key}", words, unit, against, high=high), (run,), partial(exact, "circulation", key))
              for key, words, unit, against, high in quantities),
        (Plot("Depth at the upstream gauge over time.", (run,), partial(draw_gauge, "depth_upstream")),), shown=run)


def solitary_wave(plan):
    runs = tuple(plan.run(f"solitary_wave_h{n}", "solitary_wave/case.toml", (f"particles.spacing=h/{n}",),
                          8.0 * (n / 8) ** 3.1) for n in plan.at((8,), (12, 16), (12, 20)))
    quantities = (("speed_error", "speed between gauges 2 m apart, relative error", "Fenton (1972), third order", 0.005),
                  ("wall_error", "run-up on an upright wall, relative error", "Su & Mirie (1980), third order", 0.05),
                  ("force_error", "largest wave force on the wall, relative error", "potential flow", 0.05),
                  ("force_rms", "force on the wall over the largest, rms error while the wave is there", "potential flow", 0.03),
                  ("pressure_error", "largest wave pressure on the wall, relative error", "potential flow", 0.05),
                  ("height_lost", "fraction of its height that the wave loses in 10 depths", "none", None))
    return Study(
        "solitary-wave", "Solitary wave in a channel and at a wall", EXACT,
        "A wave 0.2 of the depth high runs along a channel, past three gauges, and up the wall at its end.",
        "Both theories are series of the third order in the wave's height over the depth; their last terms are 0.01 % of the speed "
        "and 1.4 % of the run-up here.",
        tuple(Check(Metric(f"solitary-wave.{key}", words, "", against, high=high), (runs[-1],), partial(exact, "solitary-wave", key))
              for key, words, against, high in quantities),
        (Plot("Depth at the last gauge over time.", runs, partial(draw_gauge, "g3")),), shown=runs[-1])


def run_up(plan):
    return flume_study(
        plan, "run-up", "Run-up of a solitary wave: Synolakis (1987)",
        "A solitary wave 0.15 of the depth high runs up a plane beach of 1 : 2.75: its highest level over R = 2.831 sqrt(cot) "
        "(H/h)^1.25 h for the height at the gauge.",
        "The law is asymptotic for waves that do not break; laboratories scatter by some 10 % about it.",
        "gauge", ("h", (8,), (10, 20)), 5.0,
        (("run_up_error", "run-up, relative error", "", "Synolakis (1987)", 0.05),
         ("height_error", "height of the wave at the gauge over the prescribed height, less 1", "", "maker", None)), LABORATORY)


def wave_flume(plan):
    """The flume is shorter at the quickest level, and its decay carried on to ten wavelengths."""
    short = ("parameters.far=2.5*L", "parameters.length=5*L", "time.end=10*T")
    rows, settings, seconds = plan.at((3, short, 17.0), (4, (), 300.0), (8, (), 2500.0))
    run = plan.run(f"wave_flume_H{rows}", "wave_flume/case.toml", (f"particles.spacing=H/{rows}", *settings), seconds)
    quantities = (("height_error", "height near the maker over the prescribed height, less 1", "maker's transfer function", None, None),
                  ("height_left", "fraction of the wave height left after ten wavelengths", "all of it", 0.97, None),
                  ("reflection", "height reflected by the absorber over the incident height", "none", None, 0.05))
    return Study(
        "wave-flume", "Regular waves over ten wavelengths", EXACT,
        f"A piston makes waves of kh = 1, 0.4 of the depth high, {rows} particles per height, which run to a damping zone.",
        "Water without viscosity keeps its waves. The reflection is read from four gauges; waves so high are 5 % longer than linear "
        "theory has them, so the wave number is fitted too.",
        tuple(Check(Metric(f"wave-flume.{key}", words, "", against, low=low, high=high), (run,), partial(exact, "wave-flume", key))
              for key, words, against, low, high in quantities),
        (Plot("Depth at the first and at the last gauge over time.", (run,), draw_waves),), shown=run)


def irregular_waves(plan):
    rows, periods, seconds = plan.at((8, 12, 35.0), (10, 40, 130.0), (16, 40, 600.0))
    run = plan.run(f"irregular_waves_h{rows}", "wave_flume/irregular.toml",
                   (f"particles.spacing=h/{rows}", f"time.end=window+{periods}*T"), seconds)
    made = "linear theory of the maker"
    quantities = (("height_error", "significant height, relative error", made, 0.05),
                  ("period_error", "period of the peak, relative error", made, 0.02),
                  ("parts_error", "energy below, at and above the peak, largest relative error", made, None),
                  ("reflection", "height reflected by the absorber over the incident height", "none", None),
                  ("height_of_draw", "height of the generated sines in this record over the spectrum's, less 1", "JONSWAP spectrum", None),
                  ("height_scatter", "standard deviation of this in records of the same length", "", None))
    return Study(
        "irregular-waves", "Irregular waves: the JONSWAP spectrum", EXACT,
        f"A piston makes irregular waves over 0.2 m of water, {rows} particles of depth: what runs away from it between 0.5 and 1.8 "
        "times the peak's frequency, against the sines that its seed makes it make, at the same gauges and times.",
        f"A record of {periods} periods is one draw of a sea, which scatters about the spectrum asked for; the sines of the seed do "
        "not. The theory is linear.",
        tuple(Check(Metric(f"irregular-waves.{key}", words, "", against, high=high), (run,), partial(exact, "irregular-waves", key))
              for key, words, against, high in quantities),
        (Plot("Depth at the first and at the last gauge over time.", (run,), partial(draw_waves, names=("a1", "a4"))),), shown=run)


def draw_waves(run, names=("a1", "b1")):
    return [panels.panel("", "t (s)", "depth (m)", (panels.over_time(name, run.curve(name, "highest_m")) for name in names))]


LIGHT = ("parameters.H=B", "parameters.share=0.1")
ROLL = ("body[0].free=[\"rotation\"]", "parameters.up=0", "parameters.tilt=0.05")
BOXES = {"heave": ("heave of a half-submerged box", ()), "roll": ("roll of a half-submerged box", ROLL),
         "light_heave": ("heave of a box one tenth submerged", LIGHT),
         "light_roll": ("roll of a box one tenth submerged", (*LIGHT, *ROLL))}


def draw_boxes(*runs):
    def those(rolls):
        return [run for run in runs if (run.case["body"][0]["free"] == ["rotation"]) == rolls]

    return [panels.panel(title, "t (s)", y, (panels.over_time(run.path.name, run.curve("box", column)) for run in those(rolls)))
            for title, y, column, rolls in (("Heave", "displacement (m)", "displacement_y_m", False),
                                            ("Roll", "angle (rad)", "angle_rad", True)) if those(rolls)]


def floating_box(plan):
    chosen = plan.at(("heave",), tuple(BOXES), tuple(BOXES))
    checks, runs = [], []
    for name in chosen:
        words, settings = BOXES[name]
        rows = plan.at(20, 60, 80) if name.startswith("light") else plan.at(20, 40, 60)  # its draught is a tenth of B
        run = plan.run(f"box_{name}_B{rows}", "floating_box/case.toml", (f"particles.spacing=B/{rows}", *settings),
                       1.2 * (rows / 20) ** 3.1)
        runs.append(run)
        quantities = [("period_error", f"period, {words}", "", "linear potential theory", 0.02)]
        if "heave" in name:
            quantities.append(("draught_error_dx", f"draught at rest, {words}", "dx", "Archimedes", 0.1))
        checks += [Check(Metric(f"floating-box.{name}.{key}", text, unit, against, high=high), (run,),
                         partial(exact, "floating-box", key)) for key, text, unit, against, high in quantities]
    return Study(
        "floating-box", "Floating box: draught, heave and roll", EXACT,
        "A box in a narrow tank is let go a fortieth of its breadth above its draught, or tilted by 0.05, "
        "and swings: period from seven passages through its place of rest, and that place.",
        "Linear theory of the tank with the box in it, added mass and waves included, solved on finite volumes and extrapolated over their size. Linear: "
        "the box swings by a tenth to a quarter of its draught.",
        tuple(checks), (Plot("Heave and roll over time.", tuple(runs), draw_boxes),), shown=runs[0])
