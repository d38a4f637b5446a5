"""The surface of the water in 3D as a mesh.

Each particle spreads its volume dx^3 over a grid as a Gaussian of standard deviation dx/2. The sum c is 1 in the water
and 0 in the air, and by symmetry 1/2 on the flat surface of a lattice; the surface is where c = 1/2. With this width a
lattice has ripples of 1 % of c, and a single particle, whose highest c is 0.51, is just visible. The mesh is closed: it
also follows walls where the water touches them, and rounds edges by about dx/2.
"""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D, vtkPolyDataNormals, vtkWindowedSincPolyDataFilter
from vtkmodules.vtkFiltersPoints import vtkGaussianKernel, vtkPointInterpolator
from vtkmodules.vtkImagingGeneral import vtkImageGaussianSmooth

WIDTH = 0.5  # dx; standard deviation of the Gaussian
CELL = 0.5  # dx; cells of the grid
MOST_NODES = 50_000_000  # of the grid, about 12 bytes each
DROPS = 0.1  # percent of the particles at each end of each axis that may be omitted
COARSER = 1.05
REACH = 3.0  # widths of the Gaussian, beyond which it is cut off
SHARE = 0.5  # value of c on the surface
EVENING, PASS_BAND = 20, 0.1  # steps and pass band of the low-pass filter that removes bumps of single particles
NEIGHBOURS = [(i, j, k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)]


def grid_of(low, high, cell, width):
    """(origin, nodes along each axis) of a grid with cells of size `cell` around a box with space for a Gaussian of this
    width, in m."""
    margin = REACH * width + 2 * cell
    return low - margin, np.ceil((high - low + 2 * margin) / cell).astype(int) + 1


def spread(position, weight, origin, shape, cell):
    """The grid with the weight of each particle in the 27 nodes around it, by quadratic splines. Their variance is
    cell^2/4 along each axis for any position."""
    place = (position - origin) / cell
    node = np.rint(place).astype(int)
    off = (place - node).astype(np.float32)
    shares = {-1: 0.5 * (0.5 - off) ** 2, 0: 0.75 - off**2, 1: 0.5 * (0.5 + off) ** 2}
    grid = np.zeros(np.prod(shape), np.float32)
    for steps in NEIGHBOURS:
        parts = weight * np.prod([shares[step][:, axis] for axis, step in enumerate(steps)], axis=0)
        np.add.at(grid, np.ravel_multi_index(tuple((node + steps).T[::-1]), shape[::-1]), parts)
    return grid


def smoothed(grid, origin, shape, cell, width):
    """The grid as vtkImageData, smoothed to a Gaussian of this width around each particle."""
    image = vtkImageData()
    image.SetDimensions(*map(int, shape))
    image.SetOrigin(*origin)
    image.SetSpacing(cell, cell, cell)
    values = numpy_to_vtk(grid, deep=True)
    values.SetName("c")
    image.GetPointData().SetScalars(values)
    smooth = vtkImageGaussianSmooth()
    smooth.SetInputData(image)
    smooth.SetDimensionality(3)
    smooth.SetStandardDeviations(*[(width**2 - cell**2 / 4) ** 0.5 / cell] * 3)
    smooth.SetRadiusFactors(REACH, REACH, REACH)
    smooth.Update()
    return smooth.GetOutput()


def colour_function(position, spacing, most_nodes=MOST_NODES, sizes=None):
    """c on a grid around the particles, as vtkImageData. `sizes` (m) are the spacings of the particles if they differ;
    the Gaussians of particles of about half the size are half as wide. A grid that would be too large omits drops that
    are far from the other water; if it still is too large, it becomes coarser."""
    sizes = np.full(len(position), float(spacing)) if sizes is None else np.asarray(sizes, float)
    halvings = np.maximum(np.rint(np.log2(spacing / sizes)), 0).astype(int)
    cell = CELL * spacing / 2.0 ** halvings.max()
    low, high = position.min(0).astype(float), position.max(0).astype(float)
    if np.prod(grid_of(low, high, cell, WIDTH * spacing)[1]) > most_nodes:
        low, high = np.percentile(position, (DROPS, 100 - DROPS), axis=0) + np.array([[-1], [1]]) * REACH * WIDTH * spacing
        inside = ((position >= low) & (position <= high)).all(1)
        position, sizes, halvings = position[inside], sizes[inside], halvings[inside]
    origin, shape = grid_of(low, high, cell, WIDTH * spacing)
    while np.prod(shape) > most_nodes:
        cell *= COARSER
        origin, shape = grid_of(low, high, cell, max(WIDTH * spacing, WIDTH / CELL * cell))
    total = None
    for halving in np.unique(halvings):
        of_size = halvings == halving
        width = max(WIDTH * spacing / 2.0**halving, WIDTH / CELL * cell)
        grid = spread(position[of_size], (sizes[of_size] / cell) ** 3, origin, shape, cell)
        image = smoothed(grid, origin, shape, cell, width)
        if total is None:
            total = image
        else:
            values = vtk_to_numpy(total.GetPointData().GetScalars())
            values += vtk_to_numpy(image.GetPointData().GetScalars())
    return total


def particles_with(frame, names):
    """The particles of a frame as vtkPolyData, with those of the named fields that exist."""
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(frame.position), deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    for name in names:
        if name in frame.fields:
            values = numpy_to_vtk(np.ascontiguousarray(frame.fields[name], dtype=np.float32), deep=True)
            values.SetName(name)
            data.GetPointData().AddArray(values)
    return data


def water_surface(frame, spacing, names=("velocity", "pressure", "spacing", "liquid"), most_nodes=MOST_NODES):
    """The mesh (vtkPolyData) with normals and with those of the named fields that exist, averaged over the particles
    around. With a field "spacing" (m) particles have these sizes."""
    contour = vtkFlyingEdges3D()
    contour.SetInputData(colour_function(frame.position, spacing, most_nodes, frame.fields.get("spacing")))
    contour.SetValue(0, SHARE)
    contour.ComputeNormalsOff()
    contour.ComputeScalarsOff()
    even = vtkWindowedSincPolyDataFilter()
    even.SetInputConnection(contour.GetOutputPort())
    even.SetNumberOfIterations(EVENING)
    even.SetPassBand(PASS_BAND)
    even.NormalizeCoordinatesOn()
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(even.GetOutputPort())
    normals.SplittingOff()
    kernel = vtkGaussianKernel()
    kernel.SetRadius(2.0 * spacing)
    kernel.SetSharpness(2.0)
    interpolator = vtkPointInterpolator()
    interpolator.SetInputConnection(normals.GetOutputPort())
    interpolator.SetSourceData(particles_with(frame, names))
    interpolator.SetKernel(kernel)
    interpolator.SetNullPointsStrategyToClosestPoint()
    interpolator.Update()
    return interpolator.GetOutput()
