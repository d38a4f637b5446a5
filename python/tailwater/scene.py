"""Perspective pictures of water and walls, drawn by VTK without a screen.

VTK of Debian 12 draws only through an X server and ends the whole process if there is none. Xvfb is a small X server
that draws into memory. It is started here and ends with this process.
"""

import os
import shutil

import numpy as np
import vtkmodules.vtkInteractionStyle  # noqa: F401
import vtkmodules.vtkRenderingOpenGL2  # registers the renderer
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkFiltersCore import vtkFeatureEdges, vtkPolyDataNormals, vtkStaticCleanPolyData
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkRenderingCore import (vtkActor, vtkCoordinate, vtkLightKit, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow,
                                         vtkWindowToImageFilter)

from .errors import DataError
from .plots import LOOK_FROM

WATER, WALL, EDGE, MARK = (0.22, 0.52, 0.80), (0.86, 0.84, 0.80), (0.35, 0.35, 0.35), (0.84, 0.10, 0.10)
SHARP = 30  # degrees; an edge is drawn between faces whose normals differ by a larger angle
FINER = 2  # drawn pixels per shown pixel along each side: smooth edges with any renderer
MARGIN = 0.02  # over the width of the picture, around its contents
NEARER = 200  # units of VTK's polygon offset by which walls are drawn nearer than they are
MARK_SIZE = 0.012  # radius of a mark over the diagonal of the scene

_has_display = False


def start_display():
    """Starts an X server for this process. Throws DataError if Xvfb is missing or does not start."""
    global _has_display
    if _has_display:
        return
    program = shutil.which("Xvfb")
    if program is None:
        raise DataError("pictures in 3D need Xvfb; remedy: apt install xvfb")
    read, write = os.pipe()
    os.set_inheritable(write, True)
    quiet = [(os.POSIX_SPAWN_OPEN, stream, os.devnull, os.O_WRONLY, 0) for stream in (1, 2)]
    # Xvfb chooses a free display number and writes it when it is ready. The system ends Xvfb whenever this process
    # ends.
    os.posix_spawn("/usr/bin/setpriv", ["setpriv", "--pdeathsig", "TERM", program, "-displayfd", str(write), "-screen", "0",
                                        "64x64x24", "-nolisten", "tcp", "-noreset"], os.environ, file_actions=quiet)
    os.close(write)
    with os.fdopen(read) as told:
        number = told.readline().strip()
    if not number:
        raise DataError(f"{program} does not start")
    os.environ["DISPLAY"] = f":{number}"
    _has_display = True


def actor_of(data, colour):
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*colour)
    return actor


def lookup_table(colours):
    """A VTK lookup table with the colours of a matplotlib colour map."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(256)
    for k in range(256):
        table.SetTableValue(k, *colours(k))
    return table


def wall_actors(walls):
    """Faces of walls (vtkPolyData), drawn on the side of the water only. The back, such as the near side of a tank,
    shows only its edges."""
    clean = vtkStaticCleanPolyData()  # faster than vtkCleanPolyData, by a factor that grows with the mesh
    clean.SetInputData(walls)
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(clean.GetOutputPort())
    normals.SetFeatureAngle(SHARP)
    # the front of a face is the side of the water, which may differ from that of its neighbours
    normals.ConsistencyOff()
    normals.Update()
    faces = actor_of(normals.GetOutput(), WALL)
    faces.GetProperty().BackfaceCullingOn()
    faces.GetProperty().SetAmbient(0.7)
    faces.GetProperty().SetDiffuse(0.35)
    # nearer, because ripples of the water's surface behind a plate reach through it
    faces.GetMapper().SetResolveCoincidentTopologyToPolygonOffset()
    faces.GetMapper().SetRelativeCoincidentTopologyPolygonOffsetParameters(0.0, -NEARER)
    edges = vtkFeatureEdges()
    edges.SetInputConnection(clean.GetOutputPort())
    edges.SetFeatureAngle(SHARP)
    edges.ColoringOff()
    edges.Update()
    lines = actor_of(edges.GetOutput(), EDGE)
    lines.GetProperty().SetLineWidth(1.2 * FINER)
    lines.GetProperty().LightingOff()
    lines.GetMapper().SetResolveCoincidentTopologyToPolygonOffset()
    lines.GetMapper().SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -1.1 * NEARER)
    return [faces, lines]


class Scene:
    """A window for a series of pictures with the same camera and bounds."""

    def __init__(self, bounds, look_from=LOOK_FROM, up=(0, 0, 1), width=1100):
        """`bounds` are xmin, xmax, ymin, ymax, zmin, zmax in m."""
        start_display()
        self.bounds, self.width = bounds, width
        self.renderer, self.overlay = vtkRenderer(), vtkRenderer()
        self.renderer.SetBackground(1, 1, 1)
        vtkLightKit().AddLightsToRenderer(self.renderer)
        self.window = vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetNumberOfLayers(2)
        self.overlay.SetLayer(1)
        self.window.AddRenderer(self.renderer)
        self.window.AddRenderer(self.overlay)
        camera = self.renderer.GetActiveCamera()
        self.overlay.SetActiveCamera(camera)
        middle = np.array(bounds).reshape(3, 2).mean(1)
        camera.SetFocalPoint(*middle)
        camera.SetPosition(*(middle + np.array(look_from, float)))
        camera.SetViewUp(*up)
        self.window.SetSize(FINER * width, FINER * width)
        self.renderer.ResetCamera(bounds)
        self.box = self.box_on_screen()

    def box_on_screen(self):
        """(left, right, low, high) of the bounds on the screen, in drawn pixels."""
        corners = np.array(self.bounds).reshape(3, 2)
        seen = []
        for corner in np.ndindex(2, 2, 2):
            coordinate = vtkCoordinate()
            coordinate.SetCoordinateSystemToWorld()
            coordinate.SetValue(*(corners[axis, corner[axis]] for axis in range(3)))
            seen.append(coordinate.GetComputedDoubleDisplayValue(self.renderer))
        seen = np.array(seen)
        margin = MARGIN * FINER * self.width
        return (*(np.array([seen[:, 0].min(), seen[:, 0].max()]) + (-margin, margin)),
                *(np.array([seen[:, 1].min(), seen[:, 1].max()]) + (-margin, margin)))

    def draw(self, water=None, walls=None, marks=(), colours=None, field=None, limits=(0, 1)):
        """Returns an image (rows, columns, 3) of 8 bits: the surface of the water (vtkPolyData), walls, and marks in
        front of all. If `field` and `colours`, a matplotlib colour map, are given, the magnitude of the field colours
        the water."""
        self.renderer.RemoveAllViewProps()
        self.overlay.RemoveAllViewProps()
        if water is not None:
            actor = actor_of(water, WATER)
            actor.GetProperty().SetAmbient(0.2)
            actor.GetProperty().SetDiffuse(0.85)
            actor.GetProperty().SetSpecular(0.25)
            actor.GetProperty().SetSpecularPower(30)
            if colours is not None:
                mapper = actor.GetMapper()
                table = lookup_table(colours)
                table.SetVectorModeToMagnitude()
                mapper.ScalarVisibilityOn()
                mapper.SetScalarModeToUsePointFieldData()
                mapper.SelectColorArray(field)
                mapper.SetLookupTable(table)
                mapper.SetScalarRange(*limits)
            self.renderer.AddActor(actor)
        for actor in wall_actors(walls) if walls is not None and walls.GetNumberOfPoints() else ():
            self.renderer.AddActor(actor)
        size = np.ptp(np.array(self.bounds).reshape(3, 2), axis=1)
        for x in marks:
            ball = vtkSphereSource()
            ball.SetCenter(*x)
            ball.SetRadius(MARK_SIZE * float(np.linalg.norm(size)))
            ball.SetThetaResolution(24)
            ball.SetPhiResolution(24)
            ball.Update()
            actor = actor_of(ball.GetOutput(), MARK)
            actor.GetProperty().SetOpacity(0.75)
            self.overlay.AddActor(actor)
        self.renderer.ResetCameraClippingRange()
        self.window.Render()
        grab = vtkWindowToImageFilter()
        grab.SetInput(self.window)
        grab.ReadFrontBufferOff()
        grab.Update()
        image = grab.GetOutput()
        columns, rows, _ = image.GetDimensions()
        pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(rows, columns, 3)
        left, right, low, high = (int(round(value / FINER)) * FINER for value in self.box)
        pixels = pixels[max(low, 0):min(high, rows), max(left, 0):min(right, columns)][::-1]
        rows, columns = (length // FINER for length in pixels.shape[:2])
        return pixels.reshape(rows, FINER, columns, FINER, 3).mean((1, 3)).astype(np.uint8)
