"""The picture of a run of cases/martin_moyce1952: particles coloured by pressure at three times; front and height of the
column over the laboratory's."""

from tailwater.fields import nearest_frames

from . import martin_moyce1952 as case
from .picture import BLACK, COMPUTED, GREY, HIGHEST, LEFT, Page, draw_particles, finish_axes, save_page
from .run_folder import RunFolder

FRAME_TIMES = (0.8, 1.6, 2.8)  # T
# One marker for each reader of the same figure, filled for the column of 2.25 in, open for the one of 1.125 in.
MARKERS = {"table": "o", "TrixiParticles": "s", "OpenMPS": "s", "PySPH": "^", "a = 1.125 in, OpenMPS": "s",
           "a = 1.125 in, PySPH": "^"}

HEAD, ROW_GAP, CURVE_HEAD, CURVE, FOOT = 0.72, 0.14, 0.75, 3.2, 0.55
PICTURE, CURVE_WIDTH, CURVE_GAP = 9.0, 4.45, 0.75


def measured_style(series):
    wide = series.width_inches == 2.25
    colour = BLACK if series.label == "table" else GREY
    return {"color": colour, "marker": MARKERS[series.label], "markersize": 4, "linestyle": "none",
            "markerfacecolor": colour if wide else "white", "zorder": 4 if series.label == "table" else 1}


def draw_front(axes, run):
    for series in case.fronts(case.n2_of(run)):
        measured = case.laboratory_front(series)
        name = series.label if series.width_inches != 2.25 else f"a = 2.25 in, {series.label}"
        axes.plot(measured.time, measured.value, label=f"laboratory ({name})", **measured_style(series))
    end = 1.05 * max(case.laboratory_front(series).time[-1] for series in case.fronts(case.n2_of(run)))
    for column, style, label in (("front_m", COMPUTED, "computed, foremost particle"),
                                 ("front_connected_m", HIGHEST, "computed, foremost connected")):
        curve = case.front(run, column).window(0, end)
        axes.plot(curve.time, curve.value, label=label, **style)
    axes.errorbar([0.9 * end], [1.25], xerr=case.TIME_UNCERTAINTY, color=BLACK, capsize=2.5, linewidth=1)
    axes.text(0.9 * end - 1.3 * case.TIME_UNCERTAINTY, 1.25, "time of the data", ha="right", va="center", fontsize=8)
    axes.set(xlim=(0, end), xlabel=r"$T = t\,\sqrt{n^2 g/a}$", ylabel="$x/a$")
    axes.set_title("front", loc="left")


def draw_height(axes, run):
    measured = case.laboratory_height(case.n2_of(run))
    axes.plot(measured.time, measured.value, color=BLACK, marker="o", markersize=4, linestyle="none",
              label="laboratory (table)", zorder=4)
    end = 1.05 * measured.time[-1]
    computed = case.height(run).window(0, end)
    axes.plot(computed.time, computed.value, label="computed", **COMPUTED)
    axes.set(xlim=(0, end), ylim=(0, 1.05), xlabel=r"$\tau = t\,\sqrt{g/a}$", ylabel="$h/(n^2 a)$")
    axes.set_title("height of the column at its back wall", loc="left")


def draw_page(run, frames):
    a, n2 = case.width(run), case.n2_of(run)
    scale = (a / (n2 * case.GRAVITY)) ** 0.5
    reach = max(frame.position[:, 0].max() for frame in frames)
    view = ((-0.1 * a, max(reach + 0.2 * a, 5 * a)), (-0.06 * a, 1.06 * n2 * a))
    inches_per_metre = PICTURE / (view[0][1] - view[0][0])
    row = (view[1][1] - view[1][0]) * inches_per_metre
    pictures = len(frames) * row + (len(frames) - 1) * ROW_GAP

    page = Page(HEAD + pictures + CURVE_HEAD + CURVE + FOOT)
    page.head(f"Collapse of a column {a:g} m wide, n$^2$ = {n2}, Martin and Moyce (1952)", run, frames[0])
    for k, frame in enumerate(frames):
        axes = page.axes(LEFT, HEAD + k * (row + ROW_GAP), PICTURE, row)
        dots = draw_particles(axes, frame, run, view, run.density * case.GRAVITY * n2 * a,
                              f"$T$ = {frame.time / scale:.1f}   ($t$ = {frame.time:.3f} s)")
        axes.spines[["left", "bottom"]].set_visible(False)
        axes.tick_params(length=2.5, labelbottom=k == len(frames) - 1)
        axes.set_ylabel("y (m)")
    axes.set_xlabel("x (m)", labelpad=1)
    page.pressure_bar(dots, LEFT + PICTURE + 0.14, HEAD, pictures)
    top = HEAD + pictures + CURVE_HEAD
    for k, draw in enumerate((draw_front, draw_height)):
        axes = page.axes(LEFT + k * (CURVE_WIDTH + CURVE_GAP), top, CURVE_WIDTH, CURVE)
        draw(axes, run)
        finish_axes(axes)
    return page.figure


def draw(run_folder, image):
    """Draws the picture of a run into `image` (its suffix chooses the format). Throws DataError."""
    run = RunFolder(run_folder)
    scale = (case.width(run) / (case.n2_of(run) * case.GRAVITY)) ** 0.5
    frames = nearest_frames(run_folder, [T * scale for T in FRAME_TIMES])
    save_page(image, draw_page, run, frames)
