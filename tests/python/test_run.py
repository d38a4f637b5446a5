"""Runs by the program: tables, fields, sweeps, errors, pages."""

import os
import re
import signal
import threading
import time
import unittest
import unittest.mock
import urllib.request
from pathlib import Path
from xml.parsers import expat

import numpy as np
import tailwater as tw
from small import DAM, PackageTest
from tailwater import tables
from tailwater.fields import list_frames, read_frame, read_polydata, to_frame
from tailwater.program import call


def names_in(block):
    """Keys of a block of the summary and of those in it; those of probes are on another page."""
    for name, value in block.items():
        yield name
        if isinstance(value, dict) and name not in ("probes", "results"):
            yield from names_in(value)


class Runs(PackageTest):
    def setUp(self):
        super().setUp()
        self.case = tw.Case(self.write("dam.toml", DAM))

    def test_probe_is_a_table_with_units(self):
        run = self.case.run("out")
        self.assertEqual(list(run.probes), ["depth"])
        depth = run.probes["depth"]
        with open("out/probes/depth.csv", encoding="utf-8") as file:
            names, *rows = (line.strip().split(",") for line in file)
        self.assertEqual([depth.index.name, *depth.columns], names)
        self.assertEqual(depth["highest_m"].iloc[-1], float(rows[-1][names.index("highest_m")]))
        self.assertEqual(depth.attrs["units"], {"time_s": "s", "connected_m": "m", "highest_m": "m", "wet_m": "m"})
        with self.assertRaisesRegex(KeyError, "the case has depth"):
            run.probes["dept"]
        curve = run.curve("depth", "highest_m")
        self.assertEqual([curve.time.tolist(), curve.value.tolist()], [depth.index.tolist(), depth["highest_m"].tolist()])
        with self.assertRaisesRegex(tw.DataError, "has no column lowest_m; it has time_s, "):
            run.curve("depth", "lowest_m")
        self.assertEqual(run.step_curve("kinetic_J").value.size, run.summary["steps"]["count"])
        with self.assertRaisesRegex(tw.DataError, "dept.csv: there is no such probe; there are: depth"):
            run.curve("dept", "highest_m")
        self.assertEqual([run.fluid_particles, run.integrator], [50, run.case["scheme"]["integrator"]])

    def test_profile_is_no_curve(self):
        probe = '[[probe]]\nname = "bed"\ntype = "profile"\nfrom = [0.1, 0]\nto = [0.9, 0]\ntimes = [0.05, 0.1]\n'
        run = tw.Case(self.write("profile.toml", DAM + probe)).run("out")
        with self.assertRaisesRegex(tw.DataError, "connected_m has a value for each place of the profile, so it is no curve"):
            run.curve("bed", "connected_m")
        self.assertGreater(len(run.probes["bed"]), 5)

    def test_fields_are_arrays(self):
        run = self.case.run("out")
        last = run.last()
        self.assertEqual(last.time, run.times[-1])
        self.assertEqual([last.position.shape, last["velocity"].shape, last["pressure"].shape],
                         [(50, 3), (50, 3), (50,)])
        self.assertLess(abs(run.at(0.0).position[:, :2].mean(axis=0) - [0.5, 0.25]).max(), 1e-6)
        with self.assertRaisesRegex(tw.DataError, "no frame is nearest"):
            run.at(float("nan"))
        self.assertIn("50 particles, pressure", repr(last))
        with self.assertRaisesRegex(KeyError, "there are pressure"):
            last["speed"]

    def test_fields_are_those_that_vtk_reads(self):
        found = []
        for folder, ranks in (("one", 1), ("two", 2)):
            for time, path in list_frames(self.case.run(folder, ranks=ranks).path):
                ours, theirs = read_frame(time, path), to_frame(time, read_polydata(path))
                self.assertEqual(list(ours.fields), list(theirs.fields))
                for name, values in ours.fields.items():
                    self.assertTrue(np.array_equal(values, theirs[name]), name)
                    self.assertEqual(values.dtype, theirs[name].dtype, name)
                found.append(np.array_equal(ours.position, theirs.position))
        self.assertGreater(len(found), 2)
        self.assertTrue(all(found))

    def test_fields_are_raw_for_a_parser_that_waits(self):
        # VTK gives expat the tag up to its end, and then "/", ">" and the end of the document. An expat of 2024 or newer
        # looks at a tag again when twice as much is there as when it last looked.
        whole = (self.case.run("out").path / "fields" / "fields_00000.vtp").read_bytes()
        head, tag, rest = whole.partition(b"<AppendedData")
        attributes = rest[:rest.index(b">")]
        pieces = [head + tag, attributes, b"/", b">", b"\n</VTKFile>\n"]
        self.assertGreaterEqual(sum(map(len, pieces[1:])) + len(tag), 2 * (len(tag) + len(attributes)))
        self.assertTrue(attributes, "without any, some look at \"/\" first, and then there is not enough")
        seen = {}
        parser = expat.ParserCreate()
        parser.StartElementHandler = seen.__setitem__
        for piece in pieces:
            parser.Parse(piece, False)
        self.assertEqual(seen["AppendedData"], {"encoding": "raw"})

    def test_broken_fields_are_named(self):
        path = self.case.run("out").path / "fields" / "fields_00000.vtp"
        whole = path.read_bytes()
        for part in (b"", whole[:200], whole[:-2000], whole.replace(b"<Points>", b"<Paints>")):
            path.write_bytes(part)
            with self.assertRaisesRegex(tw.DataError, "fields_00000.vtp"):
                read_frame(0.0, path)

    def test_summary_and_steps(self):
        run = self.case.run("out")
        self.assertEqual(run.summary["status"], "done")
        self.assertEqual(len(run.steps), run.summary["steps"]["count"])
        self.assertEqual(run.results["depth"]["type"], "depth")
        self.assertIn("done", repr(run))
        # The reference names each of them.
        page = (Path(__file__).resolve().parents[2] / "docs/reference/summary.md").read_text(encoding="utf-8")
        names = {*names_in(run.summary), *run.steps.columns, run.steps.index.name}
        self.assertEqual({name for name in names if f"`{name}`" not in page}, set())

    def test_measurements_are_scored(self):
        self.write("gauge.csv", "t [s], depth [mm]\n0, 500\n0.08, 500\n")
        self.write("measured.toml", DAM + '[[measurement]]\nprobe = "depth"\nfile = "gauge.csv"\nscatter = 0.2\n')
        case = tw.Case("measured.toml")
        run = case.run("out")
        found = run.measurements.loc[("depth", "connected")]
        depth = run.probes["depth"]["connected_m"]
        # Two samples count alike.
        off = np.array([depth.iloc[0] - 0.5, np.interp(0.08, depth.index, depth) - 0.5])
        self.assertAlmostEqual(found["rms"], np.sqrt(np.mean(off**2)), 9)
        self.assertAlmostEqual(found["bias"], off.mean(), 9)
        self.assertTrue(found["is_inside"])
        self.assertIn("against gauge.csv", call("info", "out"))
        table = tw.sweep(case, {"measurement[0].scatter": [0.2, 1e-9]}, out="s").table()
        self.assertEqual(list(table["depth_connected_is_inside"]), [1, 0])
        self.assertAlmostEqual(table["depth_connected_rms"].iloc[1], found["rms"], 9)
        self.assertTrue(self.case.run("none").measurements.empty)

    def test_every_column_that_can_be_measured_is_in_its_table(self):
        units = {"length": "m", "speed": "m/s", "pressure": "kPa", "force": "N/m", "moment": "N m/m", "energy": "J",
                 "volume": "l", "discharge": "l/s"}
        at, line = "at = [0.5, 0.2]", "from = [0.5, 0]\nto = [0.5, 1]"
        probes = {"depth": (at, {"connected": "length", "highest": "length", "wet": "length"}),
                  "wall-pressure": ("at = [0.5, 0]", {"pressure": "pressure"}),
                  "wall-pressure-mean": ("from = [0.2, 0]\nto = [0.4, 0]", {"pressure": "pressure"}),
                  "pressure": (at, {"pressure": "pressure"}), "velocity": (at, {"u": "speed", "v": "speed"}),
                  "front": ("", {"front_connected": "length", "front": "length"}),
                  "energy": ("", {"total": "energy", "kinetic": "energy", "potential": "energy"}),
                  "volume": ("", {"volume_out": "volume", "volume_in": "volume"}),
                  "discharge": (line, {"discharge": "discharge", "volume": "volume"}),
                  "force": ("moment_about = [0, 0]", {"force_x": "force", "force_y": "force", "moment": "moment"}),
                  "pressure-map": ("", {"largest": "pressure", "mean": "pressure"}),
                  "run-up": ("", {"connected": "length", "highest": "length"}),
                  "level-map": ("from = [0.2, 0]\nto = [0.8, 0]", {"mean": "length", "highest": "length"}),
                  "pockets": ("", {"pressure": "pressure", "volume": "volume", "gas": "volume", "vented": "volume",
                                   "energy": "energy"})}
        text = DAM[:DAM.index("[[probe]]")].replace("end = 0.1", "end = 0.02") + '[air]\npockets = "adiabatic"\n'
        for name, (keys, columns) in probes.items():
            text += f'[[probe]]\nname = "{name}"\ntype = "{name}"\n{keys}\n'
            for column, measure in columns.items():
                self.write(f"{measure}.csv", f"t [s], value [{units[measure]}]\n0, 1\n0.01, 1\n")
                text += f'[[measurement]]\nprobe = "{name}"\ncolumn = "{column}"\nfile = "{measure}.csv"\n'
        found = tw.Case(self.write("all.toml", text)).run("out").measurements
        self.assertEqual(len(found), sum(len(columns) for _, columns in probes.values()))
        self.assertTrue((found["samples"] == 2).all(), found)
        self.assertTrue((found["unit"] != "").all(), found)

    def test_folder_of_another_kind(self):
        with self.assertRaisesRegex(tw.DataError, "is not the folder of a run"):
            tw.Run(".")

    def test_folder_that_is_there_is_kept(self):
        self.case.run("out")
        with self.assertRaisesRegex(tw.InputError, "out"):
            self.case.run("out")
        self.case.run("out", force=True)

    def test_goes_on_to_a_later_end(self):
        run = self.case.copy().update({"time.end": 0.05}).run("out")
        before = len(run.probes["depth"])
        longer = run.resume({"time.end": 0.1})
        self.assertEqual([longer.status, longer.case["time"]["end"]], ["done", 0.1])
        self.assertGreater(len(longer.probes["depth"]), before)
        self.assertEqual(longer.last().position.tolist(), self.case.run("whole").last().position.tolist())
        with self.assertRaisesRegex(tw.InputError, "a resumed run keeps its case"):
            run.resume({"particles.spacing": 0.2})

    def test_failed_step_is_a_solver_error(self):
        self.case["pressure_solver.max_iterations"] = 1
        with self.assertRaisesRegex(tw.SolverError, "max_iterations"):
            self.case.run("out")
        self.assertEqual(tw.Run("out").status, "failed")

    def test_ranks(self):
        self.assertEqual(self.case.run("out", ranks=2).summary["ranks"]["count"], 2)
        with unittest.mock.patch("tailwater.case.call") as program, unittest.mock.patch("tailwater.case.Run"):
            self.case.run("one", progress=True)
        words = program.call_args.args
        self.assertEqual(words[words.index("-n") + 1], 1)  # whatever the program does by default

    def test_interrupt_ends_the_run_in_order(self):
        self.case["time.end"] = 1e6
        fields = Path("out/fields").absolute()

        def stop():
            while not list(fields.glob("*.vtp")):
                time.sleep(0.02)
            os.kill(os.getpid(), signal.SIGINT)

        threading.Thread(target=stop, daemon=True).start()
        with self.assertRaises(KeyboardInterrupt):
            self.case.run("out")
        self.assertEqual(tw.Run("out").summary["status"], "interrupted")

    def test_sweep_is_a_table(self):
        self.case["particles.spacing"] = 0.07
        sweep = tw.sweep(self.case, {"particles.spacing": [0.1, 0.05], "parameters.H": [0.5, 1.0]}, jobs=2)
        self.assertEqual(sweep.path, Path("dam_sweep"))
        table = sweep.table()
        self.assertEqual(list(table["fluid_particles"]), [50, 100, 200, 400])
        self.assertEqual(list(table["status"]), ["done"] * 4)
        self.assertEqual([run.spacing for run in sweep], [0.1, 0.1, 0.05, 0.05])

    def test_sweep_says_which_member_failed(self):
        table = tw.sweep(self.case, {"pressure_solver.max_iterations": [1, 1000]}, out="s").table()
        self.assertEqual(list(table["status"]), ["failed", "done"])

    def test_sweep_that_cannot_begin(self):
        for values in ({"particles.spacing": [-1, 0.1]}, {"particles.spacing": 0.1}, {}):
            with self.assertRaisesRegex(tw.InputError, "particles.spacing" if values else "values"):
                tw.sweep(self.case, values)

    def test_page_of_a_run(self):
        view = self.case.run("out").view()
        self.addCleanup(view.close)
        with urllib.request.urlopen(view.address) as page:
            self.assertIn(b"<html", page.read())
        self.assertIn("<iframe", view._repr_html_())
        with self.assertRaises((tw.InputError, tw.IoError)):
            tw.View("none")

    def test_program_that_cannot_be_started(self):
        with unittest.mock.patch("tailwater.program.program", return_value=Path("no_program")):
            for start in (self.case.check, lambda: tw.View("out")):
                with self.assertRaisesRegex(tw.IoError, "no_program: cannot be started"):
                    start()


class Tables(PackageTest):
    def test_units_by_name(self):
        for name, unit in (("time_s", "s"), ("discharge_m3_per_s", "m^3/s"), ("moment_N_m_per_m", "N m/m"),
                           ("step", ""), ("pressure_Pa", "Pa"), ("impulse_Pa_s", "Pa s"), ("divergence_old_per_s", "1/s"), ("s", "")):
            self.assertEqual(tables.unit_of(name), unit, name)

    def test_units_of_probes_are_those_that_the_program_declares(self):
        def in_2d_and_3d(cell):
            both = re.fullmatch("2D: (.*); 3D: (.*)", cell)
            return both.groups() if both else (cell, cell)

        found = 0
        for line in call("run", "--help-case=probes").splitlines():
            row = re.match(r"\| ((?:[23]D: )?`.*?) \| (.*?) \|", line)
            for headings, unit in zip(*map(in_2d_and_3d, row.groups())) if row else ():
                for heading in re.findall(r"`(\w+)`", headings):
                    self.assertEqual(tables.unit_of(heading), unit.removesuffix(" per m"), heading)
                    found += 1
        self.assertGreater(found, 100)

    def test_table_of_others_has_provenance_lines(self):
        self.write("lab.csv", "# of a flume\nx_m,h_m\n0,1\n1,2\n")
        self.assertTrue(np.array_equal(tables.frame("lab.csv")["h_m"], [1.0, 2.0]))


if __name__ == "__main__":
    unittest.main()
