"""A Python state for ParaView that shows a run: its water coloured by pressure, its walls, its time.

The state reads the field files themselves. It therefore needs no export, shows also a run that is still running, and
works with ParaView 5.9 or newer."""

from pathlib import Path

import numpy as np

from .errors import DataError
from .fields import list_frames, read_frame
from .whole_file import write_whole_text

__all__ = ["write_paraview"]

COLOURED_SHARE = 99  # percent of the particles whose pressure lies within the colour scale
FRAMES = 5  # whose pressures determine the colour scale

STATE = '''\
# {title}
# In ParaView: File, Load State; or: paraview --script={name}
from paraview.simple import *

FOLDER = {folder!r}

view = GetActiveViewOrCreate("RenderView")
water = PVDReader(registrationName="water", FileName=FOLDER + "/fields.pvd")
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
shown = Show(water, view)
shown.SetRepresentationType("Point Gaussian")
shown.ShaderPreset = "Sphere"
shown.GaussianRadius = {radius!r}  # m; half the spacing
ColorBy(shown, ("POINTS", "pressure"))
colours = GetColorTransferFunction("pressure")
colours.ApplyPreset("Viridis (matplotlib)", True)
colours.RescaleTransferFunction(0.0, {highest!r})  # Pa
bar = GetScalarBar(colours, view)
bar.Title, bar.ComponentTitle = "pressure (Pa)", ""
shown.SetScalarBarVisibility(view, True)
{walls}
clock = AnnotateTimeFilter(registrationName="time", Input=water)
clock.Format = "t = {{time:.2f}} s"
Show(clock, view)
{camera}
SetActiveSource(water)
Render(view)
'''
WALLS = '''
walls = PVDReader(registrationName="walls", FileName=FOLDER + "/walls.pvd")
faces = Show(walls, view)
faces.DiffuseColor = faces.AmbientColor = [0.55, 0.55, 0.55]
faces.Opacity = {opacity}
faces.LineWidth = 2.0
'''
WALL_LINES = '''
for number, points in enumerate({lines}):
    line = PolyLineSource(registrationName=f"wall {{number + 1}}", Points=[x for point in points for x in (*point, 0.0)])
    edge = Show(line, view)
    edge.DiffuseColor = edge.AmbientColor = [0.2, 0.2, 0.2]
    edge.LineWidth = 2.0
'''
FLAT = '''
view.InteractionMode = "2D"
ResetCamera(view)'''
SOLID = '''
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [1.0, -1.6, 0.9], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]
ResetCamera(view)'''


def highest_pressure(frames) -> float:
    """Highest pressure (Pa, above 0) of nearly all particles, as the median over some times: an impact must not darken
    the pictures of all other times."""
    chosen = np.linspace(0, len(frames) - 1, min(FRAMES, len(frames))).round().astype(int)
    highest = np.median([np.percentile(read_frame(*frames[k])["pressure"], COLOURED_SHARE) for k in chosen])
    return float(f"{highest:.3g}") if highest > 0 else 1.0


def write_paraview(run, path):
    """Writes a state file. Throws DataError where there are no fields; IoError."""
    frames = list_frames(run.path)
    if not frames:
        raise DataError(f"{run.path}: the run wrote no field files")
    path, is_flat = Path(path), run.dimension == 2
    walls = ""
    if (run.path / "fields" / "walls.pvd").is_file():
        walls = WALLS.format(opacity=1.0 if is_flat else 0.2)
    elif is_flat:
        walls = WALL_LINES.format(lines=run.walls)
    title = " ".join(run.title.split())  # one line, also where the title of the case has several
    text = STATE.format(title=title, name=path.name, folder=str((run.path / "fields").resolve()), radius=run.spacing / 2,
                        highest=highest_pressure(frames), walls=walls, camera=FLAT if is_flat else SOLID)
    write_whole_text(path, text)
