"""Runs that fail on their way: exit code 3, a report and the last good fields."""

import re
import unittest

import numpy as np

from fields import read_points, read_series
from program import ProgramTest

PARTICLE = r"id +\d+ +(fluid|wall) +at \(.+\) m +velocity \(.+\) m/s +pressure .+ Pa"
WHERE = r"particle \d+(, which was)? at \(.+\),? "
REMEDY = r"\. .*remedy: "


class Failure(ProgramTest):
    def fail_run(self, *arguments):
        """The report and the summary of a failed run, after the checks that are common to all failures."""
        result = self.call("run", "small.toml", "--out", "run", "--quiet", *arguments, expect=3, traps=False)
        self.assertEqual(result.stdout, "")
        self.assertIn("run/failure", result.stderr)
        summary = self.summary("run")
        self.assertEqual((summary["status"], summary["exit_code"]), ("failed", 3))
        self.assertEqual(result.stderr, f"error: {summary['message']}\n")

        report = (self.folder / "run/failure/report.txt").read_text()
        first, *_ = report.splitlines()
        self.assertTrue(summary["message"].startswith(first))

        # All results end at the last good state.
        positions, fields = read_points(self.folder / "run/failure/last_good.vtp")
        self.assertEqual(positions.shape, (50, 3))
        self.assertEqual(set(fields), {"velocity", "pressure", "id"})
        self.assertTrue(np.isfinite(positions).all() and np.isfinite(fields["pressure"]).all())
        _, steps = self.table("run/steps.csv")
        self.assertEqual(len(steps), summary["steps"]["count"])
        if steps:
            self.assertEqual(steps[-1][0], summary["time_s"]["reached"])
        series = self.folder / "run/fields/fields.pvd"
        self.assertTrue(series.exists() or not steps, "a run that took a step has fields")
        for time, path in read_series(series) if series.exists() else ():
            self.assertLessEqual(time, summary["time_s"]["reached"])
            read_points(path)
        return report, summary

    def check_culprit(self, report):
        """Checks that the report names a particle that is among the last good ones, and its neighbours."""
        self.assertRegex(report, "particle before the step: " + PARTICLE)
        _, neighbours = report.split("its neighbours before the step:\n")
        # Water in a corner of the tank has more than five neighbours.
        self.assertGreater(len(neighbours.splitlines()), 5)
        for line in neighbours.splitlines():
            self.assertRegex(line, "^  " + PARTICLE)

    def test_a_time_step_that_collapses(self):
        # At 149 m/s, the largest speed allowed, the step is courant dx / u. Small gravity makes the first step by its
        # rule, sqrt(2 g H), more than a thousand times longer.
        report, _ = self.fail_run("--set", "fluid[0].velocity=[149, 0]", "--set", "physics.gravity=[0, -1e-4]")
        self.assertRegex(report, r"^step 0 from t = 0 s failed: the time step collapsed to 0\.000369 s, less "
                         "than 0.001 of .*, by the advective limit: " + WHERE + r"moves at 149 m/s" + REMEDY)
        self.check_culprit(report)

    def test_a_run_that_becomes_unstable_on_its_way(self):
        # The published formulation fails in a dam break and is therefore not the default (docs/theory/schemes.md).
        report, summary = self.fail_run("--set", "scheme.formulation=published", "--set", "time.end=5")
        self.assertIn("scheme.formulation = \"robust\"", report)
        self.check_culprit(report)
        self.assertGreater(summary["time_s"]["reached"], 0.0)

    def test_a_pressure_solve_that_does_not_converge(self):
        report, summary = self.fail_run("--set", "pressure_solver.max_iterations=1")
        self.assertIn("did not converge", report)
        residual = float(re.search(r"relative residual (\S+),", report)[1])
        first, last = map(float, re.search(r"Residuals on the way: (\S+), (\S+)\.", report).groups())
        self.assertGreater(first, last)
        self.assertAlmostEqual(last, residual, delta=0.005 * residual)  # the message has fewer digits
        self.assertIn("pressure_solver.max_iterations", summary["message"])

    def test_a_failed_run_can_be_replaced(self):
        self.fail_run("--set", "pressure_solver.max_iterations=1")
        self.call("run", "small.toml", "--out", "run", "--quiet", "--force")
        self.assertFalse((self.folder / "run/failure").exists())
        self.assertEqual(self.summary("run")["status"], "done")


if __name__ == "__main__":
    unittest.main()
