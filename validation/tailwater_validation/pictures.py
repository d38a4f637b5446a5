"""Pictures of a run, and in 3D the surface of its water as meshes for ParaView.

Leaves DIR/pictures/picture_00000.png, ... and, in 3D, DIR/fields/surface_00000.vtp, ... with DIR/fields/surface.pvd, a mesh
for each field file; those that are there already are not made again. Needs only the field files of the run, which may
still go on.
"""

import sys
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

from tailwater.fields import list_frames, read_frame, read_polydata

from . import plots, scene
from .command import PlainParser, complain, number
from .curves import DataError
from .run_folder import RunFolder
from .surface import water_surface
from .whole_file import write_whole

COUNT = 6
DPI = 100
SHOWN_SHARE = 99.5  # percent of the particles whose speed the colours cover
COLOURS = "viridis"


def choose_frames(frames, times, count):
    """[(number, time, path)] of those nearest to `times` (s), or of `count` at equal distances."""
    numbered = [(number, time, path) for number, (time, path) in enumerate(frames)]
    if times:
        chosen = {min(numbered, key=lambda frame: abs(frame[1] - time))[0] for time in times}
    else:
        chosen = set(np.linspace(0, len(frames) - 1, min(count, len(frames))).round().astype(int))
    return [frame for frame in numbered if frame[0] in chosen]


def write_polydata(path, data):
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(data)
    writer.EncodeAppendedDataOff()  # raw bytes and short indices: a quarter less
    writer.SetIdTypeToInt32()

    def write(part):
        writer.SetFileName(str(part))
        if not writer.Write():
            raise OSError(f"{path}: cannot be written")

    write_whole(path, write)


def write_surfaces(run, frames):
    """A mesh for each field file that has none, and the list of all."""
    folder = run.path / "fields"
    entries = []
    for number, (time, fields) in enumerate(frames):
        path = folder / f"surface_{number:05}.vtp"
        if not path.is_file() or path.stat().st_mtime < fields.stat().st_mtime:
            write_polydata(path, water_surface(read_frame(time, fields), run.spacing))
        entries.append(f'    <DataSet timestep="{time!r}" file="{path.name}"/>\n')
    text = ('<?xml version="1.0"?>\n<VTKFile type="Collection" version="1.0">\n  <Collection>\n' + "".join(entries)
            + "  </Collection>\n</VTKFile>\n")
    write_whole(folder / "surface.pvd", lambda part: part.write_text(text, encoding="utf-8"))


def walls_at(run, time):
    """The faces of all walls at a time (s); none if the run wrote none."""
    series = [entry for entry in list_frames(run.path, "walls") if entry[0] <= time + 1e-9]
    return read_polydata(series[-1][1]) if series else None


def highest_speed(frames):
    """Of nearly all particles, m/s; 0 if a field file has no velocity."""
    def of(frame):
        velocity = frame.fields.get("velocity")
        return 0.0 if velocity is None else np.percentile(np.linalg.norm(velocity, axis=1), SHOWN_SHARE)

    return max(of(frame) for frame in frames)


def bounds_of(frames, walls):
    """Of what the pictures show: the walls wherever they are at the times of the frames, and without any the water."""
    boxes = [faces.GetBounds() for faces in walls if faces is not None and faces.GetNumberOfPoints()]
    if boxes:
        boxes = np.array(boxes)
        return tuple(np.stack([boxes[:, 0::2].min(0), boxes[:, 1::2].max(0)], axis=1).ravel())
    low = np.min([frame.position.min(0) for frame in frames], axis=0)
    high = np.max([frame.position.max(0) for frame in frames], axis=0)
    return tuple(np.stack([low, high], axis=1).ravel())


def plain(text):
    """A text of a user, in which $ begins no formula."""
    return text.replace("$", r"\$")


def finish(figure, axes, run, time, mappable, path):
    axes.set_title(f"{plain(run.case['case']['title'])}\n$t$ = {time:.4g} s, dx = {run.spacing:.4g} m", loc="left", fontsize=10)
    if mappable is not None:
        bar = figure.colorbar(mappable, ax=axes, fraction=0.025, pad=0.01, extend="max")
        bar.set_label("speed (m/s)")
    write_whole(path, lambda part: figure.savefig(part, dpi=DPI, format="png"))


def show_image(image, title, mappable=None):
    """A figure that shows an image pixel by pixel, with room for its title and a colour bar; and its axes."""
    rows, columns, _ = image.shape
    figure = plots.new_figure(columns / DPI + (1.0 if mappable is not None else 0.2), rows / DPI + 0.6)
    axes = figure.subplots()
    axes.imshow(image, interpolation="none")
    axes.set_axis_off()
    axes.set_title(title, loc="left", fontsize=10)
    return figure, axes


def draw_3d(run, chosen, folder, look_from):
    frames = [read_frame(time, path) for _, time, path in chosen]
    speed = highest_speed(frames)
    mappable = ScalarMappable(Normalize(0, speed), COLOURS) if speed > 0 else None
    window = scene.Scene(bounds_of(frames, [walls_at(run, time) for _, time, _ in chosen]), look_from)
    for (number, time, _), frame in zip(chosen, frames):
        water = read_polydata(run.path / "fields" / f"surface_{number:05}.vtp")
        image = window.draw(water, walls_at(run, time), colours=mappable and matplotlib.colormaps[COLOURS],
                            field="velocity", limits=(0, speed))
        figure, axes = show_image(image, "", mappable)
        finish(figure, axes, run, time, mappable, folder / f"picture_{number:05}.png")


def draw_plane(axes, run, frame, view, speed):
    """Particles coloured by their speed, if there is any, and walls; returns the particles."""
    colours = {"facecolors": plots.SKY} if speed == 0 else {
        "cmap": COLOURS, "clim": (0, speed), "array": np.linalg.norm(frame.fields["velocity"], axis=1)}
    dots = plots.draw_particles(axes, frame.position, run.spacing, view.exaggeration, **colours)
    plots.draw_walls(axes, run)
    view.apply(axes)
    axes.set_xlabel("x (m)")
    axes.set_ylabel(view.label_of_heights())
    return dots


def draw_2d(run, chosen, folder):
    frames = [read_frame(time, path) for _, time, path in chosen]
    speed = highest_speed(frames)
    view = plots.View(run, frames, crop=True)
    for (number, time, _), frame in zip(chosen, frames):
        figure = plots.new_figure(plots.WIDTH, (plots.WIDTH - 1.2) * view.ratio + 0.9)
        axes = figure.subplots()
        dots = draw_plane(axes, run, frame, view, speed)
        finish(figure, axes, run, time, dots if speed > 0 else None, folder / f"picture_{number:05}.png")


def draw(run, times=(), count=COUNT, look_from=scene.FROM):
    """Leaves the files; returns the folder of the pictures. Throws DataError, OSError."""
    frames = list_frames(run.path)
    if not frames:
        raise DataError(f"{run.path}: the run wrote no field files")
    folder = run.path / "pictures"
    folder.mkdir(exist_ok=True)
    chosen = choose_frames(frames, times, count)
    with matplotlib.rc_context(plots.STYLE):
        if run.dimension == 3:
            write_surfaces(run, frames)
            draw_3d(run, chosen, folder, look_from)
        else:
            draw_2d(run, chosen, folder)
    return folder


def main(arguments):
    parser = PlainParser("tailwater pictures", __doc__.split("\n\n", maxsplit=1)[0], ".")
    parser.add_argument("run", type=Path, metavar="DIR", help="folder of a run")
    parser.add_argument("--count", type=int, default=COUNT, metavar="N", help=f"pictures, at equal times ({COUNT})")
    parser.add_argument("--times", type=number, nargs="+", metavar="S", help="or of the field files nearest to these times, s")
    parser.add_argument("--from", type=number, nargs=3, dest="look_from", default=scene.FROM, metavar=("X", "Y", "Z"),
                        help="3D: direction, from the middle of the walls, that the pictures look from "
                             f"({' '.join(f'{value:g}' for value in scene.FROM)})")
    options = parser.parse_args(arguments)
    if options.count < 1:
        parser.error(f"--count {options.count}: at least 1")
    if not any(options.look_from):
        parser.error("--from 0 0 0: is no direction")
    try:
        print(f"pictures: {draw(RunFolder(options.run), options.times, options.count, options.look_from)}")
    except DataError as error:
        return complain(error, 2)
    except OSError as error:
        return complain(error, 4)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
