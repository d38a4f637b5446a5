"""Draw images of a run; in 3D also write the water surface as meshes for ParaView.

Writes DIR/pictures/picture_00000.png, ... In 3D it also writes DIR/fields/surface_00000.vtp, ..., a mesh for each field
file, with DIR/fields/surface.pvd; current meshes are not written again. Needs only the field files of the run, which
may still be running.
"""

import sys
from pathlib import Path

import matplotlib
import numpy as np

from . import plots
from .command_line import Parser, exit_code_of, number
from .errors import DataError
from .fields import list_frames, read_frame, spacings_of
from .run import Run

COUNT = 6


def choose_frames(frames, times, count):
    """[(number, time, path)] of the frames nearest to `times` (s), or of `count` evenly spaced frames that include the
    last."""
    numbered = [(number, time, path) for number, (time, path) in enumerate(frames)]
    if times:
        chosen = {min(numbered, key=lambda frame: abs(frame[1] - time))[0] for time in times}
    else:
        chosen = set(np.linspace(len(frames) - 1, 0, min(count, len(frames))).round().astype(int))
    return [frame for frame in numbered if frame[0] in chosen]


def draw_plane(axes, run, frame, view, colours):
    """Draws particles, each with its spacing and coloured by a Colouring, walls, and porous layers. Returns the drawn
    particles."""
    style = {"facecolors": plots.SKY} if colours is None else {
        "cmap": plots.COLOURS, "clim": colours.limits, "array": colours.values(frame)}
    dots = plots.draw_particles(axes, frame.position, spacings_of(run, frame), view.exaggeration, **style)
    plots.draw_walls(axes, run, frame.time)
    plots.draw_porous(axes, run)
    view.apply(axes)
    axes.set_xlabel("x (m)")
    axes.set_ylabel(view.label_of_heights())
    return dots


def draw_2d(run, chosen, folder, by):
    frames = [plots.with_spacing(run, read_frame(time, path)) for _, time, path in chosen]
    colours = plots.colouring(run, frames, by)
    view = plots.View(run, frames, crop=True)
    for (number, time, _), frame in zip(chosen, frames):
        figure = plots.new_figure(plots.WIDTH, (plots.WIDTH - 1.2) * view.ratio + 0.9)
        axes = figure.subplots()
        dots = draw_plane(axes, run, frame, view, colours)
        plots.save(figure, axes, run, time, dots, folder / f"picture_{number:05}.png", colours)


def draw_3d(run, frames, chosen, folder, look_from, by):
    from . import pictures_3d  # needs VTK, which pictures in 2D do not need

    pictures_3d.write_surfaces(run, frames)
    pictures_3d.draw(run, chosen, folder, look_from, by)


def draw(run, times=(), count=COUNT, look_from=plots.LOOK_FROM, by="speed"):
    """Writes the files; returns the folder of the pictures. `by` is what colours the water: "speed", "pressure",
    "spacing" or "liquid". Throws DataError; IoError; ImportError for a run in 3D without VTK."""
    frames = list_frames(run.path)
    if not frames:
        raise DataError(f"{run.path}: the run wrote no field files")
    folder = run.path / "pictures"
    folder.mkdir(exist_ok=True)
    chosen = choose_frames(frames, times, count)
    with matplotlib.rc_context(plots.STYLE):
        if run.dimension == 3:
            draw_3d(run, frames, chosen, folder, look_from, by)
        else:
            draw_2d(run, chosen, folder, by)
    return folder


def main(arguments):
    parser = Parser("tailwater pictures", description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("run", type=Path, metavar="DIR", help="folder of a run")
    parser.add_argument("--count", type=int, default=COUNT, metavar="N", help=f"images, evenly spaced in time ({COUNT})")
    parser.add_argument("--times", type=number, nargs="+", metavar="S", help="draw the output nearest to these times instead, s")
    parser.add_argument("--from", type=number, nargs=3, dest="look_from", default=plots.LOOK_FROM, metavar=("X", "Y", "Z"),
                        help="3D: view direction, from the centre of the walls to the camera "
                             f"({' '.join(f'{value:g}' for value in plots.LOOK_FROM)})")
    parser.add_argument("--colour", choices=("speed", "pressure", "spacing", "liquid"), default="speed",
                        help="what the colour of the water shows (speed): zones of refinement have several spacings")
    options = parser.parse_args(arguments)
    if options.count < 1:
        parser.error(f"--count {options.count}: at least 1")
    if not any(options.look_from):
        parser.error("--from 0 0 0: is no direction")
    return exit_code_of(
        lambda: print(f"pictures: {draw(Run(options.run), options.times, options.count, options.look_from, options.colour)}"))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
