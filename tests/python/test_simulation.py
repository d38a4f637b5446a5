"""Runs in this process: the same run as the program's, views without a copy, errors, Ctrl-C."""

import os
import signal
import unittest
import warnings
from pathlib import Path

import numpy as np
import tailwater as tw
from small import DAM, PackageTest
from tailwater.simulation import _simulation


class Steps(PackageTest):
    def setUp(self):
        super().setUp()
        self.case = tw.Case(self.write("dam.toml", DAM))

    def test_run_is_that_of_the_program_bit_for_bit(self):
        by_program = self.case.run("program")
        with self.case.simulation("script") as simulation:
            for step in simulation:
                step.position.sum(), step.velocity.sum(), step.pressure.sum()  # reading changes nothing
        for name in ("steps.csv", "probes/depth.csv", "case.effective.toml"):
            self.assertEqual(Path("program", name).read_bytes(), Path("script", name).read_bytes(), name)
        self.assertEqual(simulation.result().summary["status"], "done")
        # And without output.
        with self.case.simulation() as simulation:
            moments = [(step.time, step.dt) for step in simulation]
            steps = by_program.steps
            self.assertEqual([time + dt for time, dt in moments], list(steps.index))
            self.assertEqual([dt for _, dt in moments], list(steps["dt_s"]))
            self.assertEqual(simulation.time, steps.index[-1])
            self.assertEqual(simulation.iterations, steps["iterations"].iloc[-1])
        self.assertEqual(sorted(os.listdir()), ["dam.toml", "program", "script"])

    def test_views_share_the_memory_of_the_flow(self):
        def address(array):
            return array.__array_interface__["data"][0]

        with self.case.simulation() as simulation:
            for step in simulation:
                for name in ("position", "velocity", "pressure", "volume", "id"):
                    one, other = getattr(step, name), getattr(step, name)
                    self.assertEqual(address(one), address(other), name)  # a copy would be somewhere else
                    self.assertFalse(one.flags.writeable or one.flags.owndata, name)
                self.assertEqual(step.position.shape, (step.pressure.size, 2))
                self.assertEqual(np.count_nonzero(step.is_water), 50)
                break

    def test_view_that_is_kept_stays_what_it_was(self):
        with self.case.simulation() as simulation:
            kept = []
            for step in simulation:
                position = step.position
                kept.append((position, position.copy()))
        for position, copy in kept:
            self.assertTrue(np.array_equal(position, copy))
        self.assertFalse(np.array_equal(kept[0][1][:50], kept[-1][1][:50]))

    def test_step_that_is_over_says_so(self):
        with self.case.simulation() as simulation:
            first, *_ = simulation
            with self.assertRaisesRegex(RuntimeError, "step 0 is over"):
                first.position.sum()
            self.assertEqual(simulation.now().number, len(_) + 1)
        with self.assertRaisesRegex(RuntimeError, "closed"):
            simulation.run()

    def test_loop_that_is_left_goes_on_later(self):
        with self.case.simulation("parts") as simulation:
            simulation.run(until=0.05)
            self.assertGreaterEqual(simulation.time, 0.05)
            self.assertLess(simulation.time, 0.1)
            simulation.run()
        self.case.run("whole")
        self.assertEqual(Path("parts/steps.csv").read_bytes(), Path("whole/steps.csv").read_bytes())

    def test_several_at_once_do_not_meet(self):
        other = self.case.copy()
        other["parameters.H"] = 0.8
        with self.case.simulation() as one, other.simulation() as two:
            for _ in zip(one, two):
                pass
            one.run()
            first = one.now().position.copy()
        with self.case.simulation() as again:
            again.run()
            self.assertTrue(np.array_equal(first, again.now().position))

    def test_three_dimensions(self):
        self.case.update({"case.dimension": 3, "probe.depth.at": [0.5, 0.2, 0], "physics.gravity": [0, 0, -9.81],
                          "fluid[0].min": [0, 0, 0], "fluid[0].max": [0.5, 0.4, 0.4], "wall[0].shape": "box",
                          "time.end": 0.03})
        text = "\n".join(line for line in DAM.splitlines() if not line.startswith(("points", "          [3")))
        case = tw.Case(self.write("box.toml", text)).update(self.case.changes)
        case.update({"wall[0].min": [0, 0, 0], "wall[0].max": [1, 0.4, 1]})
        with case.simulation() as simulation:
            for step in simulation:
                self.assertEqual(step.position.shape[1:], (3,))
            self.assertEqual(simulation.dimension, 3)


class Errors(PackageTest):
    def setUp(self):
        super().setUp()
        self.case = tw.Case(self.write("dam.toml", DAM))

    def test_wrong_case_has_file_line_and_key(self):
        self.write("dam.toml", DAM.replace("spacing = 0.1", "spacing = 0"))
        with self.assertRaises(tw.InputError) as caught:
            tw.Case("dam.toml").simulation()
        self.assertEqual((caught.exception.file, caught.exception.line, caught.exception.key),
                         ("dam.toml", 7, "particles.spacing"))

    def test_wrong_geometry_has_its_place(self):
        self.case["fluid[0].max"] = [4, 0.5]
        with self.assertRaisesRegex(tw.InputError, "column"):
            self.case.simulation("out")
        self.assertFalse(Path("out").exists())

    def test_forces_of_a_script_that_are_not_finite_are_named(self):
        with self.assertRaisesRegex(tw.InputError, "the script has given .* a body_force that is not finite"):
            with self.case.simulation() as simulation:
                for step in simulation:
                    step.body_force = np.nan

    def test_failed_solve_ends_the_simulation(self):
        self.case["pressure_solver.max_iterations"] = 1
        with self.assertRaisesRegex(tw.SolverError, "max_iterations"):
            with self.case.simulation("out") as simulation:
                simulation.run()
        self.assertEqual(tw.Run("out").summary["status"], "failed")
        self.assertTrue(Path("out/failure/report.txt").exists())
        with self.assertRaisesRegex(tw.SolverError, "max_iterations"):
            self.case.simulation()

    def test_interrupt_is_pythons_and_the_run_can_go_on(self):
        with self.assertRaises(KeyboardInterrupt):
            with self.case.simulation("out") as simulation:
                for step in simulation:
                    if step.number == 5:
                        os.kill(os.getpid(), signal.SIGINT)
        self.assertEqual(tw.Run("out").summary["status"], "interrupted")
        from tailwater.program import call

        call("resume", "out", "--quiet")
        self.case.run("whole")
        self.assertEqual(Path("out/steps.csv").read_bytes(), Path("whole/steps.csv").read_bytes())

    def test_error_of_a_script_leaves_a_folder_that_says_interrupted(self):
        with self.assertRaises(ZeroDivisionError):
            with self.case.simulation("out") as simulation:
                for step in simulation:
                    1 / (step.number - 2)
        self.assertEqual(tw.Run("out").summary["status"], "interrupted")

    def test_warnings_are_pythons_and_of_this_run_only(self):
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            with self.case.simulation("out", hook=lambda step: step.body_force) as simulation:
                simulation.run()
        self.assertEqual([each.category for each in told], [tw.RunWarning])
        self.assertEqual([str(told[0].message)], tw.Run("out").summary["warnings"])
        with self.case.simulation():
            self.assertEqual(_simulation.warnings(), [])

    def test_warning_of_the_end_is_told(self):
        self.case["limits.volume_warning"] = 1e-9
        with self.assertWarnsRegex(tw.RunWarning, "the largest value in this run"):
            with self.case.simulation("out") as simulation:
                simulation.run()

    def test_warning_of_one_of_several_is_told_once(self):
        late = '[[probe]]\nname = "profile"\ntype = "profile"\nfrom = [0.5, 0]\nto = [0.5, 0.5]\ntimes = [7]\n'
        warns = tw.Case(self.write("late.toml", DAM + late))
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            with self.case.simulation() as one, warns.simulation():
                one.run()
        self.assertEqual([each.category for each in told], [tw.RunWarning])

    def test_only_one_writes(self):
        with self.case.simulation("one"):
            with self.assertRaisesRegex(tw.InputError, "close the other first"):
                self.case.simulation("two")
            with self.assertRaisesRegex(tw.InputError, "close the other first"):
                self.case.simulation()


if __name__ == "__main__":
    unittest.main()
