"""Perspective pictures of runs in 3D, and meshes of their water surface, made with VTK."""

import matplotlib
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

from . import plots, scene
from .fields import list_frames, read_frame, read_polydata
from .surface import water_surface
from .whole_file import write_whole, write_whole_text


def write_polydata(path, data):
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(data)
    writer.SetDataModeToBinary()  # inline: ParaView of Debian 12 cannot read VTK's appended data
    writer.SetIdTypeToInt32()

    def write(part):
        writer.SetFileName(str(part))
        if not writer.Write():
            raise OSError("VTK cannot write it")

    write_whole(path, write)


def write_surfaces(run, frames):
    """Writes a surface mesh for each field file that has no current one, and the list of all meshes."""
    folder = run.path / "fields"
    entries = []
    for number, (time, fields) in enumerate(frames):
        path = folder / f"surface_{number:05}.vtp"
        if not path.is_file() or path.stat().st_mtime < fields.stat().st_mtime:
            write_polydata(path, water_surface(plots.with_spacing(run, read_frame(time, fields)), run.spacing))
        entries.append(f'    <DataSet timestep="{time!r}" file="{path.name}"/>\n')
    text = ('<?xml version="1.0"?>\n<VTKFile type="Collection" version="1.0">\n  <Collection>\n' + "".join(entries)
            + "  </Collection>\n</VTKFile>\n")
    write_whole_text(folder / "surface.pvd", text)


def walls_at(run, time):
    """The faces of all walls at a time (s); None if the run wrote no walls."""
    series = [entry for entry in list_frames(run.path, "walls") if entry[0] <= time + 1e-9]
    return read_polydata(series[-1][1]) if series else None


def bounds_of(frames, walls):
    """Bounds of the pictures: those of the walls at all times of the frames, or of the water if there are no walls."""
    boxes = [faces.GetBounds() for faces in walls if faces is not None and faces.GetNumberOfPoints()]
    if boxes:
        boxes = np.array(boxes)
        return tuple(np.stack([boxes[:, 0::2].min(0), boxes[:, 1::2].max(0)], axis=1).ravel())
    low = np.min([frame.position.min(0) for frame in frames], axis=0)
    high = np.max([frame.position.max(0) for frame in frames], axis=0)
    return tuple(np.stack([low, high], axis=1).ravel())


def show_image(image, title, mappable=None):
    """A figure with an image at its native resolution, with space for a title and a colour scale; and the axes of the
    figure."""
    rows, columns, _ = image.shape
    figure = plots.new_figure(columns / plots.DPI + (1.0 if mappable is not None else 0.2), rows / plots.DPI + 0.6)
    axes = figure.subplots()
    axes.imshow(image, interpolation="none")
    axes.set_axis_off()
    axes.set_title(title, loc="left", fontsize=10)
    return figure, axes


def draw(run, chosen, folder, look_from, by):
    frames = [plots.with_spacing(run, read_frame(time, path)) for _, time, path in chosen]
    colours = plots.colouring(run, frames, by)
    mappable = ScalarMappable(Normalize(*colours.limits), plots.COLOURS) if colours else None
    window = scene.Scene(bounds_of(frames, [walls_at(run, time) for _, time, _ in chosen]), look_from)
    for (number, time, _), frame in zip(chosen, frames):
        water = read_polydata(run.path / "fields" / f"surface_{number:05}.vtp")
        image = window.draw(water, walls_at(run, time), colours=mappable and matplotlib.colormaps[plots.COLOURS],
                            field=colours and colours.field, limits=colours.limits if colours else (0, 1))
        figure, axes = show_image(image, "", mappable)
        plots.save(figure, axes, run, time, mappable, folder / f"picture_{number:05}.png", colours)
