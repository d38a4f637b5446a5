"""The laboratory's dam breaks except the impact on a wall; each is scored by a module of its own."""

from dataclasses import replace
from functools import partial

from .. import janosi2004, kleefsman2005, martin_moyce1952, ozmen_cagatay2014, panels, soares_frazao2002
from ..checks import Check
from ..curves import DataError
from ..metric import Metric
from ..reading import scored, summary
from ..study import LABORATORY, ModuleChecks, Plot, Study

ALWAYS = ("The laboratory's gate, friction of side walls and surface tension are not included in these uncertainties.")


def case_run(plan, name, length, count, seconds, integrator=None, variant="", settings=()):
    """A run with `count` particles over the case's own length; `seconds` is what it costs with ten of them."""
    return plan.run("_".join(filter(None, (f"{name}_{length}-{count}", variant))), f"{name}/case.toml",
                    (f"particles.spacing={length}/{count}", *settings), seconds * (count / 10) ** 3.1,
                    plan.integrators[-1] if integrator is None else integrator)


def water_error(run):
    """Particles of the start that are neither inside nor have left."""
    start, inside, out = (summary("water_balance", where, run)["particles"] for where in ("start", "inside", "out"))
    return start - inside - out


def draw_convergence(module, names, ylabel, *runs):
    """Scores of a case's module by spacing: `names` are (label, name of the score)."""
    return panels.convergence({label: {run.spacing: scored(module.score, name, run) for run in runs}
                               for label, name in names}, ylabel)


def everything(_):
    return True


def laboratory_study(name, title, module, about, uncertainty, runs, converging, ylabel, paper=(), keep=everything,
                     more_checks=(), more_plots=(), **more):
    """A study of the scores of the last of `runs`, with its curves beside the laboratory's."""
    plots_of = (Plot("Differences from the laboratory by spacing; they end at the uncertainty of the data.", runs,
                     partial(draw_convergence, module, converging, ylabel)),) if converging else ()
    return Study(name, title, LABORATORY, about, f"{uncertainty} {ALWAYS}",
                 (ModuleChecks(name, module.score, runs[-1:], keep, paper), *more_checks), (Plot(f"Computed ({runs[-1].name}) and measured.", runs[-1:], module.draw), *plots_of, *more_plots),
                 **({"shown": runs[-1]} | more))


def martin_moyce(plan):
    name = "martin_moyce1952"
    runs = tuple(case_run(plan, name, "a", count, 0.5) for count in plan.at((15, 30), (30, 60, 96), (60, 96, 160)))
    return laboratory_study(
        name, "Collapse of a square column: Martin & Moyce (1952)", martin_moyce1952,
        "A column 57 mm wide and as high collapses and runs over a dry, smooth bed. Front x/a over T = t sqrt(g/a) and height of "
        "the column at its back wall. Farzin et al. compute it with 3898 and 9320 particles (a/60 and a/96) on a frictionless bed "
        "but give no numbers.",
        "The release takes time: before friction can matter, the laboratory's fronts are 0.13 to 0.19 in T behind that of a "
        "column released at once, so the best shift is sought within 0.2. Readings of one figure differ by 0.006 to 0.04 a, "
        "columns of two sizes by 0.12 a where they should coincide.", runs,
        (("front, the table (a)", "rms front table"), ("column height (n2 a)", "rms height")), "RMS difference")


def janosi(plan):
    name = "janosi2004"
    runs = tuple(case_run(plan, name, "d", count, 50) for count in plan.at((4, 7), (7, 13), (13, 21)))
    return laboratory_study(
        name, "Bore on a wet bed behind a rising gate: Janosi et al. (2004)", janosi2004,
        "A lock 0.38 m long and 0.15 m deep opens onto water 38 mm deep; the gate is a moving wall that rises at 1.5 m/s and does work "
        "on the water. Surfaces "
        "at eight instants. Farzin et al. compute it with 11 905 particles and compare four of them.",
        "Each photograph has its own vertical offset (the still water reads 35.3 to 45.7 mm and is moved to 38 mm); the instant at "
        "which the gate began to move is known to 0.015 s, in which the bore runs 15 mm; differences below 2 mm mean nothing.", runs,
        tuple((f"t = {instant:g} s", f"rms {instant:g}") for instant in janosi2004.INSTANTS[2::2]), "RMS distance (mm)",
        keep=lambda score: not score.startswith("rms published"))


def ozmen_cagatay(plan):
    name = "ozmen_cagatay2014"
    runs = tuple(case_run(plan, name, "h0", count, 18) for count in plan.at((9, 13), (9, 18), (18, 27)))
    farmani = (("mean error profile", 9.24), ("largest error profile", 14.2), ("mean error gauge", 12.47),
               ("largest error gauge", 15.3))

    def errors(score):
        return not score.startswith("level ")

    two_step = case_run(replace(plan, scheme="farmani2020"), name, "h0", plan.at(13, 18, 27), 18)
    return laboratory_study(
        name, "Dam break over a hump with an open end: Ozmen-Cagatay, Kocaman & Guzel (2014)", ozmen_cagatay2014,
        "A reservoir 0.25 m deep empties over a dry floor and a triangular hump 0.075 m high; part is reflected, the rest leaves "
        "through the open end. Heights at eight places and instants of profiles and at six gauges. Farmani et al. compute it with "
        "5976 particles, dx = 0.014 m (h0/18).",
        "Published are 14 numbers with two or three digits, chosen by the paper as the worst of its model; the error of the "
        "data is not given. "
        "The channel's width, 0.30 m, is assumed: with 0.20 m the mean errors are 1.6 and 2.2 % smaller, without side walls 2.2 and "
        "4.3 % larger (scheme F, h0/12).",
        runs, (("profile points", "mean error profile"), ("gauge points", "mean error gauge")), "mean error (%)", farmani,
        errors, (Check(Metric(f"{name}.water", "water of the start that is neither inside nor counted as out", "particles",
                              "the outlet's balance is exact", 0, 0), runs[-1:], water_error),
                 ModuleChecks(f"{name}.farmani2020", ozmen_cagatay2014.score, (two_step,), errors, farmani, ", scheme B"),),
        moments=ozmen_cagatay2014.MOMENTS,
        time_scale=ozmen_cagatay2014.TIME_SCALE)


def surface_distance(k, run, reference):
    """RMS distance (mm) of the surfaces of two runs of the sill at the k-th instant."""
    return 1000 * soares_frazao2002.distances(run, reference)[k][1]


def draw_surface_distances(*runs):
    """Of each run but the last from the last, by spacing. Throws DataError if there is only one."""
    if len(runs) < 2:
        raise DataError("only one run reached its end")
    return panels.convergence({f"t = {instant:g} s": {run.spacing: surface_distance(k, run, runs[-1]) for run in runs[:-1]}
                               for k, instant in enumerate(soares_frazao2002.INSTANTS)}, "RMS distance from the finest (mm)")


def soares_frazao(plan):
    name = "soares_frazao2002"
    runs = tuple(case_run(plan, name, "h0", count, 40) for count in plan.at((8, 11), (8, 11, 16), (11, 16, 22)))
    *coarser, finest = runs
    distances = tuple(Check(Metric(f"{name}.distance.{instant:g}.{run.name}", f"surface at t = {instant:g} s, RMS distance "
                                   f"from that of {finest.name}, {run.name}", "mm", "the finest run"), (run, finest),
                            partial(surface_distance, k))
                      for k, instant in enumerate(soares_frazao2002.INSTANTS) for run in coarser)
    return laboratory_study(
        name, "Dam break over a sill into still water: Soares-Frazao (2002)", soares_frazao2002,
        "A reservoir 0.111 m deep empties over a sill 0.065 m high into still water before a closed end. Farmani et al. show surfaces "
        "at five instants and state a worst error of 12.3 % without giving a measured number: arrivals, reflections and "
        "surfaces are shown.",
        "No measured numbers are published: nothing here has a target. Surfaces of coarser runs are "
        "compared with those of the finest; most of the distance comes from where the breaking faces are.", runs, (), "",
        more_checks=distances,
        more_plots=(Plot("Surfaces by spacing: distance from those of the finest run.", runs, draw_surface_distances),),
        moments=soares_frazao2002.MOMENTS[:4])


def box_run(plan, count, end):
    """The box with `count` particles over the water's depth, until `end` (s)."""
    return plan.run(f"kleefsman2005_H-{count}_{end:g}s", "kleefsman2005/case.toml",
                    (f"particles.spacing=H/{count}", f"time.end={end}"), 22 * end * (count / 11) ** 4,
                    plan.integrators[0])


def kleefsman(plan):
    name = "kleefsman2005"
    counts, end = plan.at((11,), (11, 15), (15, 30)), plan.at(1.0, kleefsman2005.END, kleefsman2005.END)
    return laboratory_study(
        name, "Dam break against a box in 3D: Kleefsman et al. (2005), SPHERIC 2", kleefsman2005,
        "Water 0.55 m deep, 1.228 m long and 1 m wide runs against a box 0.161 m high in a tank 3.22 m long. Heights of the water "
        "at four places and pressures on the box's face. The benchmark's own spacing is H/30, 108 000 particles.",
        "Sensors drift by 50 Pa before the impact; a door that a weight pulls up lets the water go.",
        tuple(box_run(plan, count, end) for count in counts),
        tuple((gauge, f"mean error {gauge}") for gauge in kleefsman2005.GAUGES), "mean error of heights (% of H)",
        keep=lambda score: not score.endswith("highest"), shown=None)  # in 3D, too large for a report of one file
