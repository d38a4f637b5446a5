"""Runs by the program: tables, fields, sweeps, errors, pages."""

import os
import signal
import threading
import unittest
import urllib.request
from pathlib import Path

import numpy as np
import tailwater as tw
from small import DAM, PackageTest
from tailwater import tables


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

    def test_fields_are_arrays(self):
        run = self.case.run("out")
        last = run.last()
        self.assertEqual(last.time, run.times[-1])
        self.assertEqual([last.position.shape, last["velocity"].shape, last["pressure"].shape],
                         [(50, 3), (50, 3), (50,)])
        self.assertLess(abs(run.at(0.0).position[:, :2].mean(axis=0) - [0.5, 0.25]).max(), 1e-6)
        with self.assertRaisesRegex(KeyError, "there are pressure"):
            last["speed"]

    def test_summary_and_steps(self):
        run = self.case.run("out")
        self.assertEqual(run.summary["status"], "done")
        self.assertEqual(len(run.steps), run.summary["steps"]["count"])
        self.assertEqual(run.results["depth"]["type"], "depth")
        self.assertIn("done", repr(run))

    def test_folder_of_another_kind(self):
        with self.assertRaisesRegex(tw.DataError, "is not the folder of a run"):
            tw.Run(".")

    def test_folder_that_is_there_is_kept(self):
        self.case.run("out")
        with self.assertRaisesRegex(tw.InputError, "out"):
            self.case.run("out")
        self.case.run("out", force=True)

    def test_failed_step_is_a_solver_error(self):
        self.case["pressure_solver.max_iterations"] = 1
        with self.assertRaisesRegex(tw.SolverError, "max_iterations"):
            self.case.run("out")
        self.assertEqual(tw.Run("out").summary["status"], "failed")

    def test_ranks(self):
        self.assertEqual(self.case.run("out", ranks=2).summary["ranks"]["count"], 2)

    def test_interrupt_ends_the_run_in_order(self):
        self.case["time.end"] = 1e6

        def stop():
            while not list(Path(".").glob("out/fields/*.vtp")):
                pass
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
        with self.assertRaisesRegex(tw.InputError, "particles.spacing"):
            tw.sweep(self.case, {"particles.spacing": [-1, 0.1]})

    def test_page_of_a_run(self):
        view = self.case.run("out").view()
        self.addCleanup(view.close)
        with urllib.request.urlopen(view.address) as page:
            self.assertIn(b"<html", page.read())
        self.assertIn("<iframe", view._repr_html_())
        with self.assertRaises((tw.InputError, tw.IoError)):
            tw.View("none")


class Tables(PackageTest):
    def test_units_by_name(self):
        for name, unit in (("time_s", "s"), ("discharge_m3_per_s", "m^3/s"), ("moment_N_m_per_m", "N m/m"),
                           ("step", ""), ("pressure_Pa", "Pa"), ("divergence_old_per_s", "1/s"), ("s", "")):
            self.assertEqual(tables.unit_of(name), unit, name)

    def test_table_of_others_has_provenance_lines(self):
        self.write("lab.csv", "# of a flume\nx_m,h_m\n0,1\n1,2\n")
        self.assertTrue(np.array_equal(tables.frame("lab.csv")["h_m"], [1.0, 2.0]))


if __name__ == "__main__":
    unittest.main()
