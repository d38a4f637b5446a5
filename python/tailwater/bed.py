"""Convert surveyed terrain to a wall mesh.

Reads a GeoTIFF or any other raster that rasterio reads, or a text file of x, y and z. Writes an STL mesh whose front is
its upper side. Coordinates become those of the case: the origin is the lower left corner, or that of --origin.

Exit codes: 0 done; 2 bad input, 4 a file cannot be read or written.
"""

import re
import sys
from pathlib import Path

import numpy as np

from .command_line import Parser, exit_code_of, number
from .errors import DataError
from .input_file import LARGEST_TABLE, read_bytes
from .whole_file import require_other_file, write_whole

NAMES = {"x": ("x", "easting", "east", "e", "rechtswert"), "y": ("y", "northing", "north", "n", "hochwert"),
         "z": ("z", "elevation", "height", "level", "h")}
# Units of a column in m; those of points_file, too (src/case_files/column_file.h).
UNITS = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3, "ft": 0.3048}
LARGEST = 5_000_000  # triangles; a mesh for a case with the same number of particles has some thousands
NO_DATA = (-9999, -99999, -32767, -32768)  # m; heights with which surveys mark missing ones
LARGEST_HEIGHT = 1e30  # m; rasters of single precision mark missing heights with about 3e38


class Terrain:
    """Points (n, 3) in m, in the survey's coordinates, and triangles of them (m, 3), counter-clockwise from above. `lines`
    (n) are those of the text file with the points, `warnings` concern its heights."""

    def __init__(self, points, triangles, lines=None, warnings=()):
        self.points, self.triangles, self.lines, self.warnings = points, triangles, lines, list(warnings)

    def bounds(self):
        used = self.points[np.unique(self.triangles)]
        return used.min(axis=0), used.max(axis=0)

    def within(self, x0, y0, x1, y1):
        """The triangles that lie in the box."""
        x, y = self.points[:, 0], self.points[:, 1]
        inside = (x >= x0) & (x <= x1) & (y >= y0) & (y <= y1)
        return Terrain(self.points, self.triangles[inside[self.triangles].all(axis=1)], self.lines, self.warnings)

    def spikes(self):
        """Indices and heights above the next neighbour [m] of the points that are above, or below, all their neighbours,
        by a slope of more than 1 and by more than five times the range of the neighbours' heights."""
        sides = ([0, 1], [1, 2], [2, 0])
        is_steep = np.zeros(len(self.points), dtype=bool)
        is_steep[self.triangles] = True
        for side in sides:
            ends = self.triangles[:, side]
            x, y, z = (self.points[ends[:, 1]] - self.points[ends[:, 0]]).T
            is_steep[ends[np.abs(z) <= np.hypot(x, y)]] = False
        triangles = self.triangles[is_steep[self.triangles].any(axis=1)]  # few, because the minima below are slow
        edges = np.concatenate([triangles[:, side] for side in sides])
        start, end = np.concatenate([edges, edges[:, ::-1]]).T
        low, high = np.full(len(self.points), np.inf), np.full(len(self.points), -np.inf)
        np.minimum.at(low, start, self.points[end, 2])
        np.maximum.at(high, start, self.points[end, 2])
        steep = np.flatnonzero(is_steep)
        low, high, z = low[steep], high[steep], self.points[steep, 2]
        above = np.where(z > high, z - high, np.minimum(z - low, 0.0))
        is_spike = np.abs(above) > 5 * (high - low)
        return steep[is_spike], above[is_spike]

    def resampled(self, step):
        """Heights on a square grid with this step, linear between known points."""
        import matplotlib.tri

        low, high = self.bounds()
        surface = matplotlib.tri.Triangulation(self.points[:, 0], self.points[:, 1], self.triangles)
        x, y = (grid_coordinates(low[axis], high[axis], step) for axis in (0, 1))
        z = matplotlib.tri.LinearTriInterpolator(surface, self.points[:, 2])(*np.meshgrid(x, y))
        return from_grid(x, y, np.ma.filled(z, np.nan))


def grid_coordinates(low, high, step):
    """Coordinates from `low` in steps; with `high` where the steps reach it within the rounding of the two, about 1e-9 m at
    northings of millions."""
    rounding = 1e-9 * step + 2 * np.spacing(max(abs(low), abs(high)))
    count = int((high - low + rounding) / step)
    return np.minimum(low + step * np.arange(count + 1), high)


def is_missing(z):
    """Whether a height stands for a missing one."""
    return ~(np.abs(z) < LARGEST_HEIGHT) | np.isin(z, NO_DATA)


def from_grid(x, y, z, lines=None, warnings=()):
    """Two triangles for each cell of a grid, z[row of y, column of x], whose four corners are known."""
    rows, columns = z.shape
    number_of = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = number_of[:-1, :-1], number_of[:-1, 1:], number_of[1:, 1:], number_of[1:, :-1]
    known = np.isfinite(z)
    whole = known[:-1, :-1] & known[:-1, 1:] & known[1:, 1:] & known[1:, :-1]
    triangles = np.concatenate([np.stack([a, b, c], axis=-1)[whole], np.stack([a, c, d], axis=-1)[whole]])
    grid_x, grid_y = np.meshgrid(x, y)
    points = np.stack([grid_x.ravel(), grid_y.ravel(), z.ravel()], axis=-1)
    return Terrain(points, triangles, None if lines is None else lines.ravel(), warnings)


def read_raster(path):
    try:
        import rasterio
    except ImportError:
        raise DataError(f"{path}: rasters are read by rasterio, which is not there; remedy: apt install python3-rasterio, "
                        "or give a text file of x, y and z") from None
    try:
        with rasterio.open(path) as raster:
            if raster.crs is not None and raster.crs.is_geographic:
                raise DataError(f"{path}: is in degrees ({raster.crs}); remedy: bring it to metres, as by gdalwarp -t_srs "
                                "EPSG:25832 in.tif out.tif with the projection of the place")
            to_metres = raster.transform
            if to_metres.b != 0 or to_metres.d != 0:
                raise DataError(f"{path}: its rows are not along x; remedy: gdalwarp in.tif out.tif")
            z = raster.read(1, masked=True).astype(float)
    except rasterio.errors.RasterioIOError as error:
        raise DataError(f"{path}: cannot be read: {error}") from None
    x = to_metres.c + to_metres.a * (np.arange(z.shape[1]) + 0.5)  # centres of the cells
    y = to_metres.f + to_metres.e * (np.arange(z.shape[0]) + 0.5)
    z = np.ma.filled(z, np.nan)  # the heights that the raster itself declares as missing
    marked = np.isin(z, NO_DATA) | (np.abs(z) >= LARGEST_HEIGHT)
    warnings = [missing_heights(z[marked], "")] if marked.any() else []
    z[marked] = np.nan
    return from_grid(np.sort(x), np.sort(y), z[np.argsort(y)][:, np.argsort(x)], warnings=warnings)


def missing_heights(z, where):
    """A warning of points that have these heights, the first of them `where`."""
    count = "1 point has" if len(z) == 1 else f"{len(z)} points have"
    return f"{count} no height, but {z[0]:g}{where}, and {'is' if len(z) == 1 else 'are'} left out."


def fields_of(line):
    """The fields of a line, separated by commas or semicolons, otherwise by blanks."""
    text = line.partition("#")[0]
    for separator in (";", ","):
        if separator in text:
            return [word.strip().strip('"') for word in text.split(separator)]
    return text.split()


def is_number(word):
    try:
        float(word)
    except ValueError:
        return False
    return True


def heading_of(word):
    """(name, unit) of a column: "X [mm]", "x (mm)" and "x_mm" are "x" in "mm"; the unit is "" if there is none."""
    text = word.lower().strip()
    bracket = re.fullmatch(r"([^\[(]*)[\[(]([^\])]*).*", text)
    if bracket:
        return bracket[1].strip(), bracket[2].strip()
    name, _, unit = text.rpartition("_")
    return (name, unit) if name and unit in UNITS else (text, "")


def columns_named(words):
    """The columns x, y and z in a line of names, such as "Name", "X [m]", "Y", "elevation", as [(index, name, unit)]; None
    if the line names no such columns."""
    headings = [heading_of(word) for word in words]
    found = [next(((k, words[k].strip(), unit) for k, (name, unit) in enumerate(headings) if name in NAMES[axis]), None)
             for axis in "xyz"]
    return None if None in found else found


def factor_of(unit):
    """The size of a unit in m; that of its first word for one like "m NHN". None for an unknown unit."""
    return UNITS.get(re.split(r"[^a-z]", unit)[0]) if unit else 1.0


def numbers_of(path):
    """The points of a text file, and the line of each: three numbers per line, separated by blanks, commas or semicolons;
    # begins a comment. If a header line names columns x, y and z, these columns are read; surveys may have others with
    names or numbers of points. Also returns the size of the unit of x, y and z in m, and warnings."""
    points, lines, chosen, factors, warnings = [], [], None, np.ones(3), []
    text = read_bytes(path, LARGEST_TABLE).decode("utf-8-sig", errors="replace")
    for line_number, line in enumerate(text.splitlines(), 1):
        words = line.partition("#")[0].replace(",", " ").replace(";", " ").split()
        if not words:
            continue
        if not points and (columns := columns_named(fields_of(line))):
            chosen = [column for column, _, _ in columns]
            unknown = [name for _, name, unit in columns if factor_of(unit) is None]
            warnings = [f"The unit of the column '{name}' (line {line_number}) is none of {', '.join(UNITS)}, and is taken as m."
                        for name in unknown]
            factors = np.array([factor_of(unit) or 1.0 for _, _, unit in columns])
            continue
        if chosen and len(fields := fields_of(line)) > max(chosen):
            words = [fields[column] for column in chosen]
        try:
            point = [float(word) for word in words]
        except ValueError:
            if not points and not any(is_number(word) for word in words):
                continue  # a title
            raise DataError(f"{path}:{line_number}: not numbers: {line[:60]}; of more columns than x, y and z the first line "
                            "names those three") from None
        if len(point) != 3:
            raise DataError(f"{path}:{line_number}: has {len(point)} numbers; a point is x, y and z in m; of more columns "
                            "the first line names those three")
        if not np.isfinite(point[:2]).all():
            raise DataError(f"{path}:{line_number}: is no point: {line[:60]}; leave it out")
        points.append(point)
        lines.append(line_number)
    return np.array(points).reshape(-1, 3), np.array(lines, dtype=int), factors, warnings


def known_points(path):
    """The points of a text file that have a height, one at each place, the line of each, and warnings of the others."""
    points, lines, factors, warnings = numbers_of(path)
    missing = is_missing(points[:, 2])
    if missing.any():
        warnings.append(missing_heights(points[missing, 2], f" (line {lines[missing][0]})"))
        points, lines = points[~missing], lines[~missing]
    points = points * factors
    _, last = np.unique(points[::-1, :2], axis=0, return_index=True)
    last = np.sort(len(points) - 1 - last)
    if len(last) < len(points):
        height_at = {(x, y): (z, line) for (x, y, z), line in zip(points[last], lines[last], strict=True)}
        pairs = [(line, height_at[x, y]) for (x, y, z), line in zip(points, lines, strict=True) if z != height_at[x, y][0]]
        if pairs:
            first, (_, second) = pairs[0]
            warnings.append(f"Lines {first} and {second} are two heights of one place"
                            f"{f', and {len(pairs) - 1} more lines are' if len(pairs) > 1 else ''}; the last one counts.")
        points, lines = points[last], lines[last]
    return points, lines, warnings


def read_points(path):
    """A grid where the points form one, otherwise Delaunay triangles between them."""
    points, lines, warnings = known_points(path)
    if len(points) < 3:
        raise DataError(f"{path}: has {len(points)} points; a bed needs three")
    x, y = np.unique(points[:, 0]), np.unique(points[:, 1])
    column, row = np.searchsorted(x, points[:, 0]), np.searchsorted(y, points[:, 1])
    if x.size > 1 and y.size > 1 and x.size * y.size <= 2 * len(points):
        z, line_at = np.full((y.size, x.size), np.nan), np.zeros((y.size, x.size), dtype=int)
        z[row, column], line_at[row, column] = points[:, 2], lines
        grid = from_grid(x, y, z, line_at, warnings)
        if len(grid.triangles):  # scattered points may also share coordinates
            return grid
    import matplotlib.tri

    try:
        middle = points[:, :2].mean(axis=0)
        triangles = matplotlib.tri.Triangulation(*(points[:, :2] - middle).T).triangles
    except (RuntimeError, ValueError) as error:
        raise DataError(f"{path}: no surface goes through its points: {error}") from None
    return Terrain(points, triangles, lines, warnings)


def read_terrain(path):
    if not path.is_file():
        raise DataError(f"{path}: there is no such file")
    return read_points(path) if path.suffix.lower() in (".xyz", ".txt", ".csv", ".dat") else read_raster(path)


def write_stl(path, terrain, origin):
    """Writes a binary STL file. Its numbers have seven digits, which is precise near the origin, but not at northings
    of millions."""
    corners = (terrain.points - origin)[terrain.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    facets = np.zeros(len(corners), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")])
    facets["normal"], facets["corners"] = normals, corners
    head = b"bed of Tailwater, m".ljust(80) + np.uint32(len(corners)).tobytes()
    write_whole(path, lambda part: part.write_bytes(head + facets.tobytes()))


def require_few(path, triangles):
    if triangles > LARGEST:
        raise DataError(f"{path}: makes {triangles:.7g} triangles, more than {LARGEST}; remedy: --box, or a coarser "
                        "--step in m")


def warnings_of_heights(terrain):
    """Warnings of single heights far from all others, and of a relief that no survey in metres has."""
    spikes, above = terrain.spikes()
    warnings = []
    if len(spikes):
        largest = np.argmax(np.abs(above))
        x, y, z = terrain.points[spikes[largest]]
        line = "" if terrain.lines is None else f" (line {terrain.lines[spikes[largest]]})"
        others = f" {len(spikes) - 1} more heights differ from their neighbours like this one." if len(spikes) > 1 else ""
        warnings.append(f"The height {z:g} m at {x:.10g}, {y:.10g}{line} is {abs(above[largest]):.3g} m "
                        f"{'above' if above[largest] > 0 else 'below'} all its neighbours: correct it, or leave it out.{others}")
    others = np.setdiff1d(terrain.triangles, spikes)
    extent = np.ptp(terrain.points[others], axis=0) if len(others) else np.zeros(3)
    if extent[2] > max(extent[:2]):
        warnings.append("Its relief is larger than its length and width, so its coordinates look like degrees: project the "
                        "survey to metres first, for example with gdalwarp -t_srs.")
    return warnings


def make_bed(options):
    require_other_file(options.to, options.terrain)
    terrain = read_terrain(options.terrain)
    if options.box:
        terrain = terrain.within(*options.box)
    warnings = terrain.warnings + warnings_of_heights(terrain)
    if options.step and len(terrain.triangles):
        low, high = terrain.bounds()
        require_few(options.terrain, 2 * np.prod((high - low)[:2] / options.step))
        terrain = terrain.resampled(options.step)
    count = len(terrain.triangles)
    if count == 0:
        raise DataError(f"{options.terrain}: has no height{' in this --box' if options.box else ''}")
    require_few(options.terrain, count)
    low, high = terrain.bounds()
    origin = np.array([*(options.origin or low[:2]), options.datum])
    write_stl(options.to, terrain, origin)
    return terrain, warnings, origin, low - origin, high - origin


def report(options, terrain, warnings, origin, low, high):
    ranges = ", ".join(f"{axis} {low[k]:.6g} to {high[k]:.6g}" for k, axis in enumerate("xyz"))
    print(f"Wrote {options.to}: {len(terrain.triangles)} triangles, {ranges} m.")
    for warning in warnings:
        print(f"Warning: {warning}")
    print(f"The case's origin is {origin[0]:.10g}, {origin[1]:.10g}, {origin[2]:.10g} of the survey. In the case:\n")
    print(f'[[wall]]\nname = "bed"\nshape = "mesh"\nfile = "{options.to.name}"\nfluid_side = "above"\nslip = "no-slip"')


def write_bed(options):
    """Reads the terrain and writes the mesh. Throws DataError, IoError."""
    if options.to.suffix.lower() != ".stl":
        raise DataError(f"--to {options.to}: is written as STL; name a file that ends in .stl")
    if options.step is not None and options.step <= 0:
        raise DataError(f"--step {options.step:g}: a step is above 0 m")
    report(options, *make_bed(options))


def main(arguments):
    parser = Parser("tailwater bed", description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("terrain", type=Path, metavar="TERRAIN", help="GeoTIFF or other raster, or x y z as .xyz, .txt or .csv")
    parser.add_argument("--to", type=Path, required=True, metavar="BED.stl", help="mesh to write")
    parser.add_argument("--box", type=number, nargs=4, metavar=("X0", "Y0", "X1", "Y1"), help="part to use, survey coordinates, m")
    parser.add_argument("--origin", type=number, nargs=2, metavar=("X", "Y"),
                        help="origin of the case, survey coordinates, m (lower left corner)")
    parser.add_argument("--datum", type=number, default=0.0, metavar="Z", help="survey elevation of z = 0 in the case, m (0)")
    parser.add_argument("--step", type=number, metavar="M", help="resample to a square grid, m (survey points)")
    options = parser.parse_args(arguments)
    return exit_code_of(lambda: write_bed(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
