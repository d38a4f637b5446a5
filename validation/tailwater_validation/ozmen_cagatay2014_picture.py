"""The picture of a run of cases/ozmen_cagatay2014: surfaces at the eight published instants and levels at the six gauges,
with the published points."""

from tailwater.fields import nearest_frames

from . import ozmen_cagatay2014 as case
from .picture import BLACK, COMPUTED, GREY, HIGHEST, LEFT, Page, finish_axes, save_page
from .profiles import profile_at
from .run_folder import RunFolder

MEASURED = {"color": BLACK, "marker": "o", "markersize": 5, "linestyle": "none", "zorder": 5}
FARMANI = {"markeredgecolor": GREY, "markerfacecolor": "white", "marker": "s", "markersize": 5, "linestyle": "none",
           "zorder": 4}
VIEW = (-6.0, 17.0)  # X
HEAD, ROW, ROW_GAP, FOOT, WIDE, GAP = 0.95, 1.35, 0.42, 0.55, 4.65, 0.55  # inches


def draw_point(axes, x, point):
    axes.plot([x], [point.measured], label="laboratory", **MEASURED)
    axes.plot([x], [point.farmani], label="Farmani et al. (2020)", **FARMANI)


def draw_profile(axes, run, point):
    profile = profile_at(run, "surface", point.T * case.TIME_SCALE)
    X = (profile.x - case.GATE) / case.DEPTH
    axes.fill_between(X, profile.bed / case.DEPTH, 0, color="#bbbbbb", linewidth=0)
    axes.plot(X, profile.highest_level / case.DEPTH, label="highest water", **HIGHEST)
    axes.plot(X, profile.level / case.DEPTH, label="computed", **COMPUTED)
    draw_point(axes, point.X, point)
    axes.set(xlim=VIEW, ylim=(0, 1.1))
    axes.set_title(f"$T$ = {point.T:g}  ($t$ = {point.T * case.TIME_SCALE:.2f} s)", loc="left")


def draw_gauge(axes, run, point):
    curve = case.gauge_level(run, point.gauge, point.X)
    axes.plot(curve.time, curve.value, label="computed", **COMPUTED)
    draw_point(axes, point.T, point)
    axes.set(xlim=(0, curve.time[-1]), ylim=(0, 1.1))
    axes.set_title(f"{point.gauge}, $X$ = {point.X:g}", loc="left")


def draw_page(run, frame):
    profiles, gauges = case.read_points("profile"), case.read_points("gauge")
    rows = (len(profiles) + len(gauges)) // 2
    page = Page(HEAD + rows * ROW + (rows - 1) * ROW_GAP + 0.2 + FOOT)
    page.head("Dam break over a hump with an open end, Ozmen-Cagatay, Kocaman and Guzel (2014)", run, frame)
    panels = [(draw_profile, point) for point in profiles] + [(draw_gauge, point) for point in gauges]
    for k, (draw_panel, point) in enumerate(panels):
        row, column = divmod(k, 2)
        of_gauges = k >= len(profiles)
        axes = page.axes(LEFT + column * (WIDE + GAP), HEAD + row * (ROW + ROW_GAP) + 0.2 * of_gauges, WIDE, ROW)
        draw_panel(axes, run, point)
        finish_axes(axes)
        axes.legend().set_visible(k in (0, len(profiles)))
        axes.set_ylabel("level / $h_0$" if column == 0 else "")
        if k in (len(profiles) - 2, len(profiles) - 1, len(panels) - 2, len(panels) - 1):
            axes.set_xlabel(r"$T = t\,\sqrt{g/h_0}$" if of_gauges else "$X = (x-x_{gate})/h_0$", labelpad=1)
    return page.figure


def draw(run_folder, image):
    """Draws the picture of a run into `image` (its suffix chooses the format). Throws DataError."""
    run = RunFolder(run_folder)
    frame, = nearest_frames(run_folder, [0.0])
    save_page(image, draw_page, run, frame)
