"""Terrains of which every height is known."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import numpy as np

from tailwater import bed

try:
    import rasterio
    from rasterio.transform import from_origin
except ImportError:
    rasterio = None

X0, Y0 = 512000.0, 5401000.0  # of a survey, m


def height(x, y):
    """A plane, which linear interpolation keeps."""
    return 210 + 0.25 * (x - X0) - 0.125 * (y - Y0)


def facets(path):
    data = path.read_bytes()
    kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")])
    found = np.frombuffer(data[84:], dtype=kind)
    assert int.from_bytes(data[80:84], "little") == len(found)
    return found


class Bed(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        self.stl = self.folder / "bed.stl"

    def make(self, terrain, *options, expect=0):
        told, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(told), contextlib.redirect_stderr(errors):
            code = bed.main(["--program", "x", str(terrain), "--to", str(self.stl), *map(str, options)])
        self.assertEqual(code, expect, errors.getvalue())
        return errors.getvalue() if expect else told.getvalue()

    def points(self, name, xy, header=""):
        path = self.folder / name
        path.write_text(header + "".join(f"{x:.3f} {y:.3f} {height(x, y):.4f}\n" for x, y in xy), encoding="utf-8")
        return path

    def is_the_plane(self, found, origin=(X0, Y0, 0.0)):
        x, y, z = (found["corners"].astype(float) + origin).reshape(-1, 3).T
        np.testing.assert_allclose(z, height(x, y), atol=2e-4)  # four decimals in the file, single precision in the mesh
        self.assertTrue((found["normal"][:, 2] > 0).all(), "the front is the upper side")

    def test_grid_of_points(self):
        grid = [(X0 + 2 * i, Y0 + 3 * j) for j in range(4) for i in range(6)]
        told = self.make(self.points("grid.xyz", grid, "# survey\nx y z\n"))
        self.assertEqual(len(facets(self.stl)), 2 * 5 * 3)
        self.is_the_plane(facets(self.stl))
        for part in ("30 triangles, x 0 to 10, y 0 to 9", "origin is 512000, 5401000, 0", 'file = "bed.stl"'):
            self.assertIn(part, told)

    def test_a_hole_of_the_survey_stays_one(self):
        grid = [(X0 + i, Y0 + j) for j in range(4) for i in range(4) if (i, j) != (1, 1)]
        self.make(self.points("hole.xyz", grid))
        self.assertEqual(len(facets(self.stl)), 2 * (9 - 4))

    def test_scattered_points(self):
        rng = np.random.default_rng(5)
        corners = [(X0, Y0), (X0 + 50, Y0), (X0, Y0 + 40), (X0 + 50, Y0 + 40)]
        xy = corners + [(X0 + 50 * a, Y0 + 40 * b) for a, b in rng.random((60, 2))]
        self.make(self.points("scattered.csv", xy))
        found = facets(self.stl)
        self.is_the_plane(found)
        sides = found["corners"][:, 1:, :2] - found["corners"][:, :1, :2]
        area = 0.5 * np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]).sum()
        self.assertAlmostEqual(area, 50 * 40, places=1)  # the hull of the points, without gap or overlap

    def test_scattered_points_that_share_coordinates(self):
        self.make(self.points("three.xyz", [(X0, Y0), (X0 + 1, Y0), (X0, Y0 + 1)]))
        self.assertEqual(len(facets(self.stl)), 1)
        self.is_the_plane(facets(self.stl))

    def test_part_of_it_on_a_coarser_grid_from_another_origin(self):
        grid = [(X0 + i, Y0 + j) for j in range(21) for i in range(31)]
        self.make(self.points("fine.xyz", grid), "--box", X0 + 5, Y0 + 5, X0 + 25, Y0 + 15, "--step", 2.5, "--origin",
                  X0 + 10, Y0, "--datum", 200)
        found = facets(self.stl)
        self.assertEqual(len(found), 2 * 8 * 4)
        self.is_the_plane(found, (X0 + 10, Y0, 200))
        np.testing.assert_allclose(found["corners"][..., 0].min(), -5)

    @unittest.skipUnless(rasterio, "python3-rasterio is not there (scripts/install.sh tests)")
    def test_geotiff(self):
        path = self.folder / "terrain.tif"
        x, y = X0 + 2 * (np.arange(6) + 0.5), Y0 + 8 - 2 * (np.arange(4) + 0.5)  # the first row is in the north
        z = height(*np.meshgrid(x, y)).astype("float32")
        z[0, 0] = -9999
        profile = {"driver": "GTiff", "width": 6, "height": 4, "count": 1, "dtype": "float32", "nodata": -9999}
        with rasterio.open(path, "w", crs="EPSG:25832", transform=from_origin(X0, Y0 + 8, 2, 2), **profile) as raster:
            raster.write(z, 1)
        self.make(path)
        self.assertEqual(len(facets(self.stl)), 2 * (15 - 1))
        self.is_the_plane(facets(self.stl), (X0 + 1, Y0 + 1, 0))
        with rasterio.open(path, "w", crs="EPSG:4326", transform=from_origin(9, 48, 1e-4, 1e-4), **profile) as raster:
            raster.write(z, 1)
        self.assertIn("is in degrees", self.make(path, expect=2))

    def test_a_survey_with_a_name_and_a_number_for_each_point(self):
        points = [(X0 + i, Y0 + j, height(X0 + i, Y0 + j)) for j in range(3) for i in range(3)]
        path = self.folder / "survey.csv"
        path.write_text("No, Point name, Northing [m], Easting [m], Elevation [m]\n" + "".join(
            f"{k}, P {k}, {y}, {x}, {z}\n" for k, (x, y, z) in enumerate(points)), encoding="utf-8")
        self.make(path)
        self.assertEqual(len(facets(self.stl)), 8)
        self.is_the_plane(facets(self.stl), (X0, Y0, 0))
        path.write_text("".join(f"P{k}, {x}, {y}, {z}\n" for k, (x, y, z) in enumerate(points)), encoding="utf-8")
        self.assertIn("of more columns than x, y and z the first line names", self.make(path, expect=2))

    def test_units_of_columns(self):
        rows = [(10 * i, 10 * j) for j in range(3) for i in range(3)]
        for header, factors in {"x [ft],y [ft],z [ft]": (0.3048, 0.3048), "\ufeffX (km);Y (km);Z (mm)": (1e3, 1e-3),
                                "easting_cm,northing_cm,elevation_m": (1e-2, 1), "x [m],y [m],z [m NHN]": (1, 1)}.items():
            with self.subTest(header):
                separator = ";" if ";" in header else ","
                lines = [separator.join(map(str, (x, y, 2.5 if (x, y) != (20, 20) else -9999))) for x, y in rows]
                path = self.folder / "units.csv"
                path.write_text("\n".join([header, *lines]) + "\n", encoding="utf-8")
                told = self.make(path)
                corners = facets(self.stl)["corners"].reshape(-1, 3)
                np.testing.assert_allclose(corners.max(axis=0), [20 * factors[0], 20 * factors[0], 2.5 * factors[1]], rtol=1e-6)
                self.assertIn("1 point has no height, but -9999", told)
                self.assertNotIn("unit", told)

    def test_an_unknown_unit_is_reported(self):
        path = self.folder / "units.csv"
        path.write_text("x,y,z (rod)\n0,0,1\n1,0,1\n0,1,1\n", encoding="utf-8")
        self.assertIn("The unit of the column 'z (rod)' (line 1) is none of m, mm, cm, km, ft, and is taken as m.", self.make(path))

    def test_what_is_wrong_is_told(self):
        for text, part in (("1 2 3\n4 5\n", "wrong.xyz:2: has 2 numbers"), ("1 2 3\n4 5 x\n", "wrong.xyz:2: not numbers"),
                           ("1 2 3\n4 inf 5\n", "wrong.xyz:2: is no point: 4 inf 5; leave it out"),
                           ("1 2 3\n", "has 1 points"), ("0 0 1\n1 1 1\n2 2 1\n3 3 2\n", "no surface")):
            path = self.folder / "wrong.xyz"
            path.write_text(text, encoding="utf-8")
            self.assertIn(part, self.make(path, expect=2))
        self.assertIn("there is no such file", self.make(self.folder / "nowhere.tif", expect=2))
        grid = self.points("grid.xyz", [(X0 + i, Y0 + j) for j in range(3) for i in range(3)])
        self.assertIn("no height in this --box", self.make(grid, "--box", 0, 0, 1, 1, expect=2))
        self.assertIn("above 0 m", self.make(grid, "--step", 0, expect=2))
        for step in (1e-3, 1e-9):  # the second is more than there is memory for
            self.assertIn("remedy: --box, or a coarser --step", self.make(grid, "--step", step, expect=2))
        self.assertFalse(self.stl.exists())

    def test_a_survey_in_degrees_is_reported(self):
        """20 m of relief on a tenth of a degree."""
        path = self.folder / "degrees.xyz"
        path.write_text("".join(f"{8 + 0.05 * i} {47 + 0.05 * j} {400 + 10 * i}\n" for i in range(3) for j in range(3)),
                        encoding="utf-8")
        self.assertIn("coordinates look like degrees", self.make(path))
        self.assertNotIn("degrees", self.make(self.points("grid.xyz", [(X0 + i, Y0 + j) for j in range(3) for i in range(3)])))

    def test_a_grid_in_millions_keeps_its_last_row(self):
        """The rounding of a northing, 1e-9 m, is above a billionth of the step."""
        grid = [(500000 + 0.05 * i, 5400000 + 0.05 * j) for j in range(61) for i in range(61)]
        survey = self.points("utm.xyz", grid)
        for step, cells in ((0.1, 30), (0.2, 15), (0.25, 12), (0.3, 10), (0.7, 4)):
            self.assertIn(f"x 0 to {cells * step:g}, y 0 to {cells * step:g}", self.make(survey, "--step", step))
            self.assertEqual(len(facets(self.stl)), 2 * cells**2)

    def grid_with(self, changed, name="changed.xyz"):
        """A plane on 5 x 5 points, line k + 1 with the height that `changed` has for k."""
        path = self.folder / name
        path.write_text("".join(f"{X0 + k % 5} {Y0 + k // 5} {changed.get(k, height(X0 + k % 5, Y0 + k // 5))}\n"
                                for k in range(25)), encoding="utf-8")
        return path

    def test_values_for_missing_heights_are_left_out(self):
        for value in ("-9999", "-9999.00", "-32768", "-99999", "3.4e38", "-3.4e+38", "1e38", "nan"):
            told = self.make(self.grid_with({12: value}))
            self.assertIn(f"1 point has no height, but {float(value):g} (line 13), and is left out", told)
            self.assertNotIn("degrees", told)
            self.assertEqual(len(facets(self.stl)), 2 * (16 - 4))
            self.is_the_plane(facets(self.stl))
        self.assertIn("2 points have no height, but -9999 (line 3), and are left out",
                      self.make(self.grid_with({2: "-9999", 20: "-9999"})))
        self.assertNotIn("Warning", self.make(self.grid_with({})))

    def test_a_height_far_from_its_neighbours_is_named(self):
        for k, z, part in ((12, 216, "5.5 m above all its neighbours"), (0, -5000, "5.21e+03 m below all its neighbours"),
                           (24, 9999, "above all its neighbours")):
            told = self.make(self.grid_with({k: z}))
            self.assertIn(f"The height {z} m at {X0 + k % 5:.0f}, {Y0 + k // 5:.0f} (line {k + 1}) is ", told)
            self.assertIn(part, told)
            self.assertNotIn("degrees", told)

    def test_two_heights_of_one_place_are_named(self):
        survey = self.grid_with({})
        survey.write_text(survey.read_text(encoding="utf-8") + f"{X0 + 1} {Y0} {height(X0 + 1, Y0)}\n", encoding="utf-8")
        self.assertNotIn("Warning", self.make(survey))
        survey.write_text(survey.read_text(encoding="utf-8") + f"{X0 + 2} {Y0 + 2} 210.5\n", encoding="utf-8")
        self.assertIn("Lines 13 and 27 are two heights of one place; the last one counts", self.make(survey))

    @unittest.skipUnless(rasterio, "python3-rasterio is not there (scripts/install.sh tests)")
    def test_a_raster_without_a_declared_value_for_missing_heights(self):
        path = self.folder / "terrain.tif"
        z = np.full((4, 4), 5, dtype="float32")
        z[1, 1] = -9999
        profile = {"driver": "GTiff", "width": 4, "height": 4, "count": 1, "dtype": "float32"}
        with rasterio.open(path, "w", crs="EPSG:25832", transform=from_origin(X0, Y0, 1, 1), **profile) as raster:
            raster.write(z, 1)
        self.assertIn("1 point has no height, but -9999, and is left out", self.make(path))
        self.assertEqual(len(facets(self.stl)), 2 * (9 - 4))

    def test_does_not_replace_its_survey(self):
        self.make(self.points("grid.xyz", [(X0 + i, Y0 + j) for j in range(3) for i in range(3)]))
        before = self.stl.read_bytes()
        self.assertIn("is the file that the command reads", self.make(self.stl, expect=2))
        self.assertEqual(self.stl.read_bytes(), before)


if __name__ == "__main__":
    unittest.main()
