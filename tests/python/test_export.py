"""Runs in the formats of others: what readers of those formats find in them."""

import contextlib
import io
import os
import resource
import stat
import subprocess
import sys
import types
import unittest
import unittest.mock
from pathlib import Path

import h5py
import numpy as np
import tailwater as tw
from scipy.io import netcdf_file
from small import DAM, PackageTest
from tailwater import export_command
from tailwater.fields import list_frames, read_frame

# Water comes in, so each field file has more particles.
FILLED = """\
[case]
title = "A channel that fills – slowly"
[particles]
spacing = 0.1
[[fluid]]
name = "water"
min = [0, 0]
max = [1, 0.4]
[[wall]]
name = "bed"
points = [[0, 0], [2, 0], [2, 1]]
[[inlet]]
name = "in"
from = [0, 0]
to = [0, 1]
discharge = 0.4
[time]
end = 0.6
[output]
fields_interval = 0.2
"""


def text(value):
    return value.decode()


class Export(PackageTest):
    def dam(self, probes="", name="out"):
        return tw.Case(self.write(f"{name}.toml", DAM + probes)).run(name)

    def command(self, *arguments):
        """Exit code and messages."""
        told = io.StringIO()
        with contextlib.redirect_stderr(told):
            try:
                code = export_command.main([str(word) for word in arguments])
            except SystemExit as ended:
                code = ended.code
        return code, told.getvalue()

    def test_vtkhdf_has_each_moment_as_its_field_file_has_it(self):
        run = tw.Case(self.write("filled.toml", FILLED)).run("out")
        run.to_vtkhdf("water.vtkhdf")
        frames = [read_frame(*frame) for frame in list_frames(run.path)]
        counts = [len(frame.position) for frame in frames]
        self.assertGreater(counts[-1], counts[0])
        with h5py.File("water.vtkhdf") as file:
            root = file["VTKHDF"]
            steps = root["Steps"]
            self.assertEqual((list(root.attrs["Version"]), root.attrs["Type"]), ([2, 0], b"PolyData"))
            self.assertEqual(root.attrs.get_id("Type").get_type().is_variable_str(), False)
            self.assertEqual((steps.attrs["NSteps"], list(steps["Values"])), (len(frames), run.times))
            self.assertEqual(list(root["NumberOfPoints"]), counts)
            for k, frame in enumerate(frames):
                # As a reader does: the parts of the step, then what belongs to its one part.
                self.assertEqual((steps["PartOffsets"][k], steps["NumberOfParts"][k]), (k, 1))
                count = root["NumberOfPoints"][steps["PartOffsets"][k]]
                first = steps["PointOffsets"][k]
                self.assertTrue(np.array_equal(root["Points"][first:first + count], frame.position))
                self.assertEqual(list(root["PointData"]), sorted(frame.fields))
                for name, values in frame.fields.items():
                    first = steps[f"PointDataOffsets/{name}"][k]
                    self.assertTrue(np.array_equal(root["PointData"][name][first:first + count], values), name)
                for kind, number in (("Vertices", count), ("Lines", 0), ("Polygons", 0), ("Strips", 0)):
                    cells = root[kind]
                    self.assertEqual((cells["NumberOfCells"][k], cells["NumberOfConnectivityIds"][k]), (number, number))
                    column = ("Vertices", "Lines", "Polygons", "Strips").index(kind)
                    first = steps["CellOffsets"][k, column] + k  # a part has one more offset than cells
                    self.assertEqual(list(cells["Offsets"][first:first + number + 1]), list(range(number + 1)))
                    first = steps["ConnectivityIdOffsets"][k, column]
                    self.assertEqual(list(cells["Connectivity"][first:first + number]), list(range(number)))

    def test_netcdf_has_the_tables_of_the_probes(self):
        run = self.dam('[[probe]]\nname = "wall"\ntype = "pressure"\nat = [0.5, 0.1]\n'
                       '[[probe]]\nname = "edge"\ntype = "front"\n[[probe]]\nname = "shape"\ntype = "profile"\n'
                       'from = [0, 0]\nto = [1, 0]\ntimes = [0.02, 0.05]\n')
        run.to_netcdf("gauges.nc", start="2026-03-01T12:00")
        with netcdf_file("gauges.nc", mmap=False) as file:
            self.assertEqual([text(file.Conventions), text(file.featureType)], ["CF-1.8", "timeSeries"])
            names = [b"".join(row).decode().rstrip("\0") for row in file.variables["station_name"][:]]
            self.assertEqual(names, ["depth", "wall", "edge"])  # a profile has many lines of one time
            self.assertEqual(text(file.variables["station_name"].cf_role), "timeseries_id")
            time = file.variables["time"]
            self.assertEqual(text(time.units), "seconds since 2026-03-01 12:00:00")
            self.assertEqual((time.dimensions, list(time[:])), (("time",), list(run.probes["depth"].index)))
            self.assertEqual(list(file.variables["x"][:2]), [0.5, 0.5])
            self.assertTrue(np.isnan(file.variables["y"][2]))
            for station, name in enumerate(names):
                for column in run.probes[name]:
                    values = file.variables[column]
                    self.assertTrue(np.array_equal(values[station], run.probes[name][column], equal_nan=True), column)
                    self.assertEqual(text(values.units), run.probes[name].attrs["units"][column] or "1")
                    self.assertEqual(text(values.coordinates), "station_name station_type x y")
            self.assertTrue(np.isnan(file.variables["pressure_Pa"][0]).all())

    def test_netcdf_of_probes_with_times_of_their_own(self):
        run = self.dam('[[probe]]\nname = "seldom"\ntype = "pressure"\nat = [0.5, 0.1]\ninterval = 0.05\n')
        run.to_netcdf("gauges.nc")
        with netcdf_file("gauges.nc", mmap=False) as file:
            time, pressure = file.variables["time"], file.variables["pressure_Pa"]
            self.assertEqual([time.dimensions, pressure.dimensions], [("station", "observation")] * 2)
            self.assertTrue(text(pressure.coordinates).startswith("time "))
            table = run.probes["seldom"]
            self.assertLess(len(table), len(run.probes["depth"]))
            self.assertEqual(list(time[1][:len(table)]), list(table.index))
            self.assertEqual(list(pressure[1][:len(table)]), list(table["pressure_Pa"]))
            self.assertTrue(np.isnan(time[1][len(table):]).all() and np.isnan(pressure[1][len(table):]).all())

    def test_paraview_state_shows_the_run_that_it_was_made_of(self):
        run = self.dam()
        run.to_paraview("state.py")
        shown = unittest.mock.MagicMock()
        simple = types.ModuleType("paraview.simple")
        names = ("GetActiveViewOrCreate", "PVDReader", "GetAnimationScene", "Show", "ColorBy", "GetColorTransferFunction",
                 "GetScalarBar", "PolyLineSource", "AnnotateTimeFilter", "ResetCamera", "SetActiveSource", "Render")
        for name in names:
            setattr(simple, name, getattr(shown, name))
        simple.__all__ = names
        with unittest.mock.patch.dict(sys.modules, {"paraview": types.ModuleType("paraview"), "paraview.simple": simple}):
            exec(compile(Path("state.py").read_text(encoding="utf-8"), "state.py", "exec"), {})
        self.assertTrue(Path(shown.PVDReader.call_args.kwargs["FileName"]).samefile(run.path / "fields" / "fields.pvd"))
        self.assertEqual(shown.ColorBy.call_args.args[1], ("POINTS", "pressure"))
        # A column of 0.5 m of water weighs 4.9 kPa at its foot.
        low, high = shown.GetColorTransferFunction.return_value.RescaleTransferFunction.call_args.args
        self.assertEqual(low, 0.0)
        self.assertTrue(2000 < high < 8000, high)
        self.assertEqual(shown.PolyLineSource.call_args.kwargs["Points"], [0, 2, 0, 0, 0, 0, 3, 0, 0, 3, 2, 0])

    def test_command(self):
        self.dam()
        files = ("--vtkhdf", "water.vtkhdf", "--netcdf", "gauges.nc", "--paraview", "state.py")
        self.assertEqual(self.command("out", *files), (0, ""))
        self.assertTrue(all(Path(name).stat().st_size for name in files[1::2]))
        for arguments, code, words in ((("out",), 2, "give one of"), (("nowhere", *files), 2, "is not the folder of a run"),
                                       (("out", *files, "--start", "noon"), 2, "2026-03-01T12:00"),
                                       (("out", "--netcdf", "no/gauges.nc"), 4, "no/gauges.nc")):
            ended = self.command(*arguments)
            self.assertEqual((ended[0], words in ended[1]), (code, True), ended)

    def test_nothing_that_is_not_a_file_of_ones_own_is_replaced(self):
        run = self.dam()
        os.mkfifo("pipe")
        Path("folder").mkdir()
        Path("victim").write_text("precious", encoding="utf-8")
        os.symlink("victim", "link")
        ways = {"--netcdf": run.to_netcdf, "--paraview": run.to_paraview, "--vtkhdf": run.to_vtkhdf}
        for option, write in ways.items():
            for name, what in (("pipe", "a device or a pipe"), ("link", "a link"), ("folder", "a folder")):
                with self.subTest(option=option, name=name):
                    code, told = self.command("out", option, name)
                    self.assertEqual(code, 4)
                    self.assertIn(f"'{name}': {what} is in its place", told)
                    with self.assertRaisesRegex(tw.IoError, what):
                        write(name)
        self.assertEqual(Path("victim").read_text(encoding="utf-8"), "precious")
        self.assertTrue(stat.S_ISFIFO(os.lstat("pipe").st_mode))
        self.assertEqual([path.name for path in Path().glob("*.part")], [])

    def test_full_disk_ends_with_4(self):
        """HDF5 crashes if a write fails. A limit of the size of files stands for a full disk."""
        tw.Case(self.write("filled.toml", FILLED)).run("out")
        for size in (100, 5000, 20000):
            def limit(size=size):
                resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

            words = [sys.executable, "-B", "-m", "tailwater.export_command", "out", "--vtkhdf", "water.vtkhdf"]
            ended = subprocess.run(words, preexec_fn=limit, capture_output=True, text=True, check=False)
            self.assertEqual(ended.returncode, 4, ended.stderr)
            self.assertEqual(ended.stderr, "error: cannot write 'water.vtkhdf': File too large\n")
            self.assertEqual([path.name for path in Path().glob("water*")], [])

    def test_a_damaged_run_is_told(self):
        self.dam()
        effective = Path("out/case.effective.toml")
        whole = effective.read_text(encoding="utf-8")
        for damaged in ("", "probe = 3\n", whole.replace("[particles]", "[particules]"), whole.replace("title = ", "titel = ")):
            effective.write_text(damaged, encoding="utf-8")
            with self.subTest(damaged[:40]):
                self.assertEqual(self.command("out", "--paraview", "state.py")[0], 2)
        effective.write_bytes(b"\xff\xfe")
        self.assertIn("is not a text in UTF-8", self.command("out", "--netcdf", "gauges.nc")[1])
        effective.unlink()
        os.mkfifo(effective)
        self.assertIn("a device or a pipe", self.command("out", "--netcdf", "gauges.nc")[1])

    def test_what_is_not_there_is_told(self):
        run = tw.Case(self.write("dry.toml", DAM[:DAM.index("[[probe]]")])).run("out")
        with self.assertRaisesRegex(tw.DataError, "no probe"):
            run.to_netcdf("gauges.nc")
        with unittest.mock.patch.dict(sys.modules, {"h5py": None}), self.assertRaisesRegex(tw.DataError, "python3-h5py"):
            run.to_vtkhdf("water.vtkhdf")
        self.assertFalse(list(Path(".").glob("gauges*")) + list(Path(".").glob("water*")))


if __name__ == "__main__":
    unittest.main()
