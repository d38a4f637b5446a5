"""The picture of a run of cases/janosi2004: particles coloured by pressure at the eight instants, with the measured
surfaces."""

from tailwater.fields import nearest_frames

from . import janosi2004 as case
from .picture import BAR_GAP, LEFT, ORANGE, Page, draw_particles, save_page
from .run_folder import RunFolder

VIEW = ((0.25, 1.1), (-0.006, 0.135))  # m
HEAD, ROW_GAP, FOOT, COLUMN, COLUMN_GAP = 1.0, 0.34, 0.55, 4.42, 0.36  # inches


def draw_page(run, frames):
    inches_per_metre = COLUMN / (VIEW[0][1] - VIEW[0][0])
    row_height = (VIEW[1][1] - VIEW[1][0]) * inches_per_metre
    rows = len(frames) // 2
    pictures = rows * row_height + (rows - 1) * ROW_GAP
    page = Page(HEAD + pictures + FOOT)
    page.head("Dam break over a wet bed, Janosi et al. (2004)", run, frames[0])
    for k, (frame, instant) in enumerate(zip(frames, case.INSTANTS)):
        column, row = divmod(k, rows)
        axes = page.axes(LEFT + column * (COLUMN + COLUMN_GAP), HEAD + row * (row_height + ROW_GAP), COLUMN, row_height)
        dots = draw_particles(axes, frame, run, VIEW, run.density * run.gravity * 0.1)
        axes.set_title(f"$t$ = {instant:.3f} s", loc="left", pad=2)
        axes.plot(*case.laboratory(instant), color=ORANGE, linewidth=1.2, zorder=5,
                  label="laboratory, far water at 38 mm")
        axes.spines[["left", "bottom"]].set_visible(False)
        axes.tick_params(length=2.5, labelbottom=row == rows - 1, labelleft=column == 0)
        axes.set_xlabel("x (m)" if row == rows - 1 else "", labelpad=1)
        axes.set_ylabel("y (m)" if column == 0 else "")
        if k == 0:
            axes.legend(loc="lower right", bbox_to_anchor=(1, 1), frameon=False)
    page.pressure_bar(dots, LEFT + 2 * COLUMN + COLUMN_GAP + BAR_GAP, HEAD, pictures)
    return page.figure


def draw(run_folder, image):
    """Draws the picture of a run into `image` (its suffix chooses the format). Throws DataError."""
    run = RunFolder(run_folder)
    frames = nearest_frames(run_folder, case.INSTANTS)
    save_page(image, draw_page, run, frames)
