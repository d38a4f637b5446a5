"""The water surface as a mesh, and pictures of runs: their content and the files that are written."""

import contextlib
import io
import shutil
import subprocess
import sys
import unittest
import unittest.mock
from pathlib import Path

import matplotlib.image
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

import synthetic_run
from tailwater import pictures, pictures_3d, plots, scene, start_picture, surface
from tailwater.errors import DataError
from tailwater.fields import Frame, list_frames, read_polydata
from tailwater.run import Run

DX = 0.1
CASE = """\
[case]
title = "A block for $5_^$"
dimension = {dimension}
[physics]
density = 1000.0
gravity = [0.0, -9.81]
[particles]
spacing = 0.1
[scheme]
integrator = "explicit"
"""


def block(*counts):
    """Centres of a block of cells, from the origin; `counts` are their numbers along the axes."""
    return DX * (np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), -1).reshape(-1, len(counts)) + 0.5)


def points_of(mesh):
    return vtk_to_numpy(mesh.GetPoints().GetData())


class Surface(unittest.TestCase):
    def test_stands_on_the_flat_surface_of_a_lattice(self):
        mesh = surface.water_surface(Frame(0.0, block(12, 12, 10), {}), DX)
        points = points_of(mesh)
        middle = np.abs(points[:, :2] - 0.6).max(1) < 0.3
        top = points[middle & (points[:, 2] > 0.5), 2]
        self.assertGreater(top.size, 100)
        # Errors over the slope of c at the surface, 0.4/s with s = dx/2. The ripple of c, 2 exp(-2 (pi/2)^2) = 1.4 %,
        # is 0.02 dx. The error of linear interpolation between nodes s apart, s^2/8 of the second derivative 0.24/s^2,
        # is 0.04 dx.
        self.assertLess(np.abs(top - 1.0).max(), 0.06 * DX)
        bottom = points[middle & (points[:, 2] < 0.5), 2]
        self.assertLess(np.abs(bottom).max(), 0.06 * DX)

    def test_particles_of_half_the_size_have_the_same_surface(self):
        coarse = block(12, 12, 8)
        fine = block(24, 24, 4) / 2 + (0, 0, 0.8)
        sizes = np.concatenate([np.full(len(coarse), DX), np.full(len(fine), DX / 2)])
        mesh = surface.water_surface(Frame(0.0, np.concatenate([coarse, fine]), {"spacing": sizes}), DX)
        points = points_of(mesh)
        middle = np.abs(points[:, :2] - 0.6).max(1) < 0.3
        top = points[middle & (points[:, 2] > 0.5), 2]
        # As of a lattice, with the spacing of the fine particles.
        self.assertLess(np.abs(top - 1.0).max(), 0.06 * DX / 2)
        self.assertFalse((middle & (np.abs(points[:, 2] - 0.8) < 0.1)).any(), "water without a gap where sizes meet")

    def test_a_particle_alone_is_just_seen(self):
        grid = surface.colour_function(np.array([[0.3, 0.2, 0.1]]), DX)
        values = vtk_to_numpy(grid.GetPointData().GetScalars())
        # (dx/(sqrt(2 pi) s))^3 = 0.508 with s = dx/2 at the particle; the grid samples it every s.
        self.assertGreater(values.max(), 0.4)
        self.assertLess(values.max(), 0.54)
        cell = grid.GetSpacing()[0]
        self.assertAlmostEqual(values.sum() * cell**3, DX**3, delta=0.01 * DX**3)

    def test_memory_is_bounded_wherever_the_water_is(self):
        far = np.concatenate([block(6, 6, 6), block(6, 6, 6) + 20.0])
        grid = surface.colour_function(far, DX, most_nodes=100_000)
        self.assertLessEqual(np.prod(grid.GetDimensions()), 100_000)
        self.assertGreater(grid.GetSpacing()[0], 4 * surface.CELL * DX)
        # A drop far away does not make the rest coarse.
        one_drop = np.concatenate([block(12, 12, 12), [[20.0, 20.0, 20.0]]])
        grid = surface.colour_function(one_drop, DX, most_nodes=100_000)
        self.assertEqual(grid.GetSpacing()[0], surface.CELL * DX)
        self.assertLess(grid.GetBounds()[1], 2.0)

    def test_fields_are_those_of_the_particles_around(self):
        position = block(8, 8, 8)
        velocity = np.stack([position[:, 2], 0 * position[:, 2], 0 * position[:, 2]], axis=1)
        mesh = surface.water_surface(Frame(0.0, position, {"velocity": velocity}), DX)
        found = vtk_to_numpy(mesh.GetPointData().GetArray("velocity"))
        # A mean over particles on the inner side, within two spacings.
        self.assertLess(np.abs(found[:, 0] - points_of(mesh)[:, 2]).max(), 2 * DX)
        self.assertLess(np.abs(found[:, 1:]).max(), 1e-6)


class PicturesTest(synthetic_run.CaseTest):
    def run_of(self, dimension, frames=3):
        folder = synthetic_run.make_folder(self.folder, CASE.format(dimension=dimension))
        if dimension == 3:
            synthetic_run.write_frames_3d(folder, [(0.5 * k, block(6, 5, 4) + (0.5 + 0.2 * k, 0.5, 0)) for k in range(frames)])
        else:
            synthetic_run.write_frames(folder, [(0.5 * k, block(6, 4), np.zeros(24)) for k in range(frames)])
        return folder

    def command(self, *arguments):
        """Exit code, output and messages."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = pictures.main(["--program", "tailwater", *map(str, arguments)])
        return code, out.getvalue(), err.getvalue()


class Pictures(PicturesTest):
    def test_a_run_in_3d_gets_pictures_and_a_mesh_for_each_field_file(self):
        folder = self.run_of(3)
        self.assertEqual(self.command(folder, "--count", "2")[0], 0)
        self.assertEqual(sorted(path.name for path in (folder / "pictures").iterdir()),
                         ["picture_00000.png", "picture_00002.png"])
        meshes = list_frames(folder, "surface")
        self.assertEqual([time for time, _ in meshes], [0.0, 0.5, 1.0])
        for k, (_, path) in enumerate(meshes):
            self.assertAlmostEqual(points_of(read_polydata(path))[:, 0].min(), 0.5 + 0.2 * k, delta=0.2 * DX)  # rounded
        made = [path.stat().st_mtime_ns for _, path in meshes]
        self.assertEqual(self.command(folder, "--times", "0.4")[0], 0)
        self.assertTrue((folder / "pictures/picture_00001.png").is_file())
        self.assertEqual([path.stat().st_mtime_ns for _, path in meshes], made)

    def test_a_run_in_2d_gets_pictures(self):
        folder = self.run_of(2)
        self.assertEqual(self.command(folder, "--count", "1")[0], 0)
        self.assertEqual([path.name for path in (folder / "pictures").iterdir()], ["picture_00002.png"], "the last")
        self.assertFalse((folder / "fields/surface.pvd").exists())

    def test_colour_of_the_pressure(self):
        folder, file = self.run_of(2, frames=1), "fields/fields_00000.vtp"
        synthetic_run.write_frame(folder / file, block(6, 4))
        self.assertIn("have no pressure", self.command(folder, "--colour", "pressure")[2])
        pressure = np.linspace(0, 500, 24)
        synthetic_run.write_frame(folder / file, block(6, 4), pressure=pressure)
        with unittest.mock.patch.object(plots, "draw_particles", wraps=plots.draw_particles) as drawn:
            self.assertEqual(self.command(folder, "--colour", "pressure")[0], 0)
        np.testing.assert_allclose(drawn.call_args.kwargs["array"], pressure, rtol=1e-6)

    def test_particles_have_their_own_size_and_the_colour_of_their_spacing(self):
        folder = self.run_of(2, frames=1)
        self.assertIn("no [[refinement]]", self.command(folder, "--colour", "spacing")[2])
        self.assertIn("one liquid", self.command(folder, "--colour", "liquid")[2])
        volume = np.where(np.arange(24) < 12, DX**2, DX**2 / 4)
        synthetic_run.write_frame(folder / "fields/fields_00000.vtp", block(6, 4), volume=volume)
        with unittest.mock.patch.object(plots, "draw_particles", wraps=plots.draw_particles) as drawn:
            code, _, err = self.command(folder, "--colour", "spacing")
        self.assertEqual(code, 0, err)
        spacings = np.where(np.arange(24) < 12, DX, DX / 2)
        np.testing.assert_allclose(drawn.call_args.args[2], spacings)
        np.testing.assert_allclose(drawn.call_args.kwargs["array"], spacings)

    def test_walls_in_2d_are_where_they_have_moved(self):
        folder = self.run_of(2)
        with (folder / "case.effective.toml").open("a") as case:
            case.write("[domain]\nperiodic_x = [0.0, 2.0]\n")
        bed, gate = [(0, 0), (2, 0)], [(1.5, 0), (1.5, 0.4)]
        for k in range(3):
            synthetic_run.write_frame(folder / f"fields/walls_{k:05}.vtp", np.array(bed + [(x + k, y) for x, y in gate]))
        synthetic_run.write_series(folder, "walls", [0.0, 0.5, 1.0])
        run = Run(folder)
        for time, x in ((0.0, 1.5), (0.5, 0.5), (0.7, 0.5), (1.0, 1.5)):
            np.testing.assert_allclose(plots.wall_lines(run, time), [bed, [(x, 0), (x, 0.4)]], atol=1e-6)
        frames = [Frame(0.5 * k, np.array([[1.0, 0.3, 0.0]]), {}) for k in range(3)]
        self.assertLess(plots.View(run, frames).x[0], 0.0, "what is shown has room for them")

    def test_only_pictures_in_3d_need_vtk(self):
        flat = shutil.move(self.run_of(2), Path(self.folder).parent / f"{Path(self.folder).name}-flat")
        self.addCleanup(shutil.rmtree, flat)
        program = ("import sys; sys.modules['vtkmodules'] = None; from tailwater_validation import launch, validate; "
                   "launch.main()")
        for folder, code in ((flat, 0), (self.run_of(3), 2)):
            ended = subprocess.run([sys.executable, "-B", "-c", program, "tailwater.pictures", "--program", "tailwater",
                                    folder], capture_output=True, text=True, check=False)
            self.assertEqual((ended.returncode, "install python3-vtk9" in ended.stderr), (code, code == 2), ended.stderr)
            self.assertEqual(len(ended.stderr.splitlines()), code // 2, "one line")

    def test_what_cannot_be_drawn_is_told(self):
        code, _, err = self.command(Path(self.folder) / "nothing")
        self.assertEqual((code, "is not the folder of a run" in err), (2, True), err)
        folder = self.run_of(3)
        with unittest.mock.patch.object(scene, "_has_display", False), unittest.mock.patch("shutil.which", lambda _: None):
            code, _, err = self.command(folder)
        self.assertEqual((code, "remedy: apt install xvfb" in err), (2, True), err)


class Bounds(unittest.TestCase):
    class Walls:
        """Bounds of a box from -1 to 1 at the position `x`; without x, no walls."""
        def __init__(self, x=None):
            self.x = x

        def GetNumberOfPoints(self):
            return 0 if self.x is None else 8

        def GetBounds(self):
            return (self.x - 1, self.x + 1, -1, 1, -1, 1)

    def test_hold_walls_that_move_at_all_times_shown(self):
        found = pictures_3d.bounds_of([], [self.Walls(0.0), self.Walls(-2.5), None, self.Walls(7.0), self.Walls()])
        self.assertEqual(found, (-3.5, 8, -1, 1, -1, 1))

    def test_hold_the_water_where_there_are_no_walls(self):
        frames = [Frame(0.0, np.array([[0.0, 1.0, 2.0]]), {}), Frame(1.0, np.array([[5.0, 0.0, 2.5]]), {})]
        self.assertEqual(pictures_3d.bounds_of(frames, [None, self.Walls()]), (0, 5, 0, 1, 2, 2.5))


class Scene(PicturesTest):
    def test_shows_water_faces_that_look_here_and_marks_on_top(self):
        folder = self.run_of(3, frames=1)
        walls = pictures_3d.walls_at(Run(folder), 0.0)
        water = surface.water_surface(Frame(0.0, block(6, 5, 4) + (0.5, 0.5, 0), {}), DX)
        bounds = (0, 4, 0, 4, 0, 1)

        def share(image, is_shown):
            return np.mean(is_shown(*(image[:, :, k].astype(int) for k in range(3))))

        def is_blue(red, green, blue):
            return blue > red + 60

        def is_red(red, green, blue):
            return red > blue + 60

        def is_wall(red, green, blue):
            return (red < 250) & (np.abs(red - blue) < 40)

        above = scene.Scene(bounds, (0.5, -1, 1), width=200)
        image = above.draw(water, walls)
        self.assertGreater(share(image, is_blue), 0.005)
        self.assertGreater(share(image, is_wall), 0.2)  # the floor faces upwards
        self.assertEqual(share(image, is_red), 0)
        # The mark is behind the water and must still be visible.
        self.assertGreater(share(above.draw(water, walls, [(0.8, 1.1, 0.1)]), is_red), 1e-4)
        below = scene.Scene(bounds, (0.5, -1, -1), width=200)
        self.assertLess(share(below.draw(None, walls), is_wall), 0.05)  # only its edges

    def test_the_start_with_a_place_marked(self):
        folder = self.run_of(3, frames=1)
        image = folder / "start.png"
        code = start_picture.main(["--walls", str(folder / "fields/walls_00000.vtp"), "--water",
                                   str(folder / "fields/fields_00000.vtp"), "--spacing", "0.1", "--title", "$5_^$", "--image",
                                   str(image), "--mark=-0.5,1,0.5"])
        self.assertEqual(code, 0)
        shown = matplotlib.image.imread(image)
        self.assertGreater(np.mean((shown[:, :, 0] > shown[:, :, 2] + 0.25)), 1e-4)


class Frames(unittest.TestCase):
    def test_equal_distances_or_the_nearest_times(self):
        frames = [(0.1 * k, None) for k in range(11)]
        self.assertEqual([number for number, *_ in pictures.choose_frames(frames, (), 3)], [0, 5, 10])
        self.assertEqual([number for number, *_ in pictures.choose_frames(frames, (0.72, 0.19, 0.21), 3)], [2, 7])
        self.assertEqual(len(pictures.choose_frames(frames, (), 99)), 11)

    def test_an_empty_series_is_told(self):
        with self.assertRaisesRegex(DataError, "no walls|cannot be read"):
            list_frames(Path("/nowhere"), "walls")


if __name__ == "__main__":
    unittest.main()
