"""The picture of a run of cases/soares_frazao2002: particles coloured by pressure at the five published instants, and
depths over time."""

from tailwater.fields import nearest_frames

from . import soares_frazao2002 as case
from .picture import BAR_GAP, COMPUTED, LEFT, Page, draw_particles, finish_axes, save_page
from .run_folder import RunFolder

GAUGES = (("gate", "at the gate, x = 2.39 m"), ("midway", "x = 3.2 m"), ("toe", "toe of the sill, x = 4 m"),
          ("crest", "crest, x = 4.45 m"), ("end", "end wall, x = 5.6 m"))
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000")  # Okabe and Ito's

HEAD, ROW_GAP, CURVE_HEAD, CURVE, FOOT = 0.72, 0.12, 0.75, 3.4, 0.55
PICTURE, ROW, VIEW_TOP = 9.3, 1.05, 0.135  # inches, inches, m: heights are drawn five times larger than lengths


def draw_page(run, frames):
    view = ((-0.03, case.LENGTH + 0.03), (-0.006, VIEW_TOP))
    exaggeration = ROW / PICTURE * (view[0][1] - view[0][0]) / (view[1][1] - view[1][0])
    pictures = len(frames) * ROW + (len(frames) - 1) * ROW_GAP
    page = Page(HEAD + pictures + CURVE_HEAD + CURVE + FOOT)
    page.head("Dam break over a sill into still water, Soares-Frazao (2002); heights five times larger", run, frames[0])
    for k, frame in enumerate(frames):
        axes = page.axes(LEFT, HEAD + k * (ROW + ROW_GAP), PICTURE, ROW)
        dots = draw_particles(axes, frame, run, view, run.density * run.gravity * case.DEPTH,
                              f"$t$ = {frame.time:.1f} s", exaggeration)
        axes.spines[["left", "bottom"]].set_visible(False)
        axes.tick_params(length=2.5, labelbottom=k == len(frames) - 1)
        axes.set_ylabel("y (m)")
    axes.set_xlabel("x (m)", labelpad=1)
    page.pressure_bar(dots, LEFT + PICTURE + BAR_GAP, HEAD, pictures)

    axes = page.axes(LEFT, HEAD + pictures + CURVE_HEAD, PICTURE, CURVE)
    for (gauge, label), colour in zip(GAUGES, COLOURS):
        curve = run.probe(gauge, "connected_m")
        axes.plot(curve.time, curve.value, label=label, **COMPUTED | {"color": colour})
    axes.set(xlim=(0, run.case["time"]["end"]), ylim=(0, 1.05 * case.DEPTH), xlabel="$t$ (s)", ylabel="depth (m)")
    finish_axes(axes)
    return page.figure


def draw(run_folder, image):
    """Draws the picture of a run into `image` (its suffix chooses the format). Throws DataError."""
    run = RunFolder(run_folder)
    frames = nearest_frames(run_folder, case.INSTANTS)
    save_page(image, draw_page, run, frames)
