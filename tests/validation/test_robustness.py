"""The robustness suite: its runs with a program that imitates Tailwater, its acceptance tests, and its report."""

import contextlib
import io
import json
import math
import os
import signal
import subprocess
import sys
import time
import tomllib
import unittest

from fake_program import ProgramTest
from tailwater.errors import DataError
from tailwater_validation import reading, robustness, runs
from tailwater_validation.metric import Metric


class BenchTest(ProgramTest):
    def make(self, *made, jobs=1):
        with contextlib.redirect_stderr(io.StringIO()) as messages:
            runs.make(made, runs.Program(self.program), self.folder / "out", jobs)
        return messages.getvalue()

    def bench(self, *arguments):
        return self.command(robustness.main, *arguments)


class Runs(BenchTest):
    def test_finished_runs_are_not_repeated(self):
        a, b = (runs.Run(name, self.case, (f"x={name}",)) for name in "ab")
        self.make(a)
        self.make(a, b)
        self.assertEqual(self.calls(), ["a", "b"])

    def test_another_setting_case_or_commit_repeats_them(self):
        self.make(runs.Run("a", self.case))
        self.make(runs.Run("a", self.case, ("x=1",)))
        self.case.write_text("# changed")
        self.make(runs.Run("a", self.case, ("x=1",)))
        self.commit("def")
        self.make(runs.Run("a", self.case, ("x=1",)))
        self.assertEqual(self.calls(), ["a"] * 4)

    def test_a_program_without_commit_is_known_by_its_content(self):
        self.commit("abc-dirty")
        run = runs.Run("a", self.case)
        self.make(run)
        self.make(run)
        self.program.write_text(self.program.read_text() + "# changed\n")
        self.make(run)
        self.assertEqual(self.calls(), ["a"] * 2)

    def test_a_run_that_fails_keeps_its_message_and_the_others_go_on(self):
        self.fake(FAKE_FAILS="x=1")
        bad, good = runs.Run("bad", self.case, ("x=1",)), runs.Run("good", self.case)
        self.assertIn("failed (error: made to fail)", self.make(bad, good, jobs=2))
        self.assertEqual(runs.finished(good, self.folder / "out").spacing, 0.02)
        with self.assertRaisesRegex(DataError, "bad: error: made to fail"):
            runs.finished(bad, self.folder / "out")
        self.make(bad)
        self.assertEqual(sorted(self.calls()), ["bad", "good"])

    def test_progress_tells_what_is_left(self):
        lines = self.make(*(runs.Run(name, self.case, seconds=5) for name in "ab")).splitlines()
        self.assertRegex(lines[0], r"^\[1/2\] a: done in \d+ s; ETA \d+ s$")
        self.assertRegex(lines[1], r"^\[2/2\] b: done in \d+ s; ETA 0 s$")

    def test_a_program_that_cannot_be_started(self):
        with self.assertRaisesRegex(DataError, "cannot be started"):
            runs.Program(self.folder / "nothing")


class Gates(BenchTest):
    def test_runs_of_one_name_are_one_run(self):
        for is_full in (False, True):
            every = [run for gate in robustness.gates(robustness.Bench("full" if is_full else "quick")).values() for run in gate.runs]
            self.assertEqual(len({run.name for run in every}), len(set(every)))

    def test_cases_are_there_and_have_what_is_scored(self):
        every = robustness.gates(robustness.Bench("full")).values()
        for path in {run.case for gate in every for run in gate.runs}:
            case = tomllib.loads(path.read_text())
            if "tank" in path.name or path.parent.name == "tank":
                self.assertIn("depth", case["parameters"], path)
                self.assertIn("level", [probe["name"] for probe in case["probe"]], path)

    def test_settings_of_a_gate_win_over_those_under_test(self):
        bench = robustness.Bench(settings=("scheme.courant=0.1", "particles.spacing=1"))
        self.assertEqual(bench.zhou(0.02, 8).settings[:3],
                         ("scheme.courant=0.1", "particles.spacing=1", "particles.spacing=0.02"))

    def test_order_of_a_power_law(self):
        self.assertAlmostEqual(reading.order({dx: 3 * dx**1.7 for dx in (0.1, 0.05, 0.02)}), 1.7, places=12)

    def test_errors_are_held_to_their_bars_from_the_second_spacing_on(self):
        for is_full, count in ((False, 1), (True, 2)):
            checks = {check.metric.name: check for check in robustness.exact_gate(robustness.Bench("full" if is_full else "quick")).checks}
            for name, flow in robustness.EXACT_FLOWS.items():
                for quantity, high in flow.bars:
                    held = [check.runs[0].settings[0] for check in checks.values() if check.metric.high == high
                            and check.metric.name.startswith(f"exact.{name}.{quantity}.dx")]
                    finer = (*flow.spacings, flow.finest)[1:1 + count]
                    self.assertEqual(held, [f"particles.spacing={dx:g}" for dx in finer])
                self.assertEqual(checks[f"exact.{name}.{flow.ordered}.order"].metric.low, 1.5)

    def test_an_order_is_not_asked_of_who_is_right_on_the_coarsest_set(self):
        made = runs.Run("coarse", self.case), runs.Run("fine", self.case)
        self.make(*made)
        for coarse, fine, bar, verdict in ((0.02, 0.015, 0.03, "met"),  # order 0.4, but both within the target
                                           (0.03, 0.03, 0.03, "met"),
                                           (0.031, 0.015, 0.03, "missed"),  # order 1.05, not within the target
                                           (0.02, 0.021, 0.03, "missed"),  # grows
                                           (0.02, 0.015, None, "missed"),  # no target
                                           (0.1, 0.025, 0.03, "met")):  # order 2
            errors = {"coarse": coarse, "fine": fine}
            check = robustness.OrderOfError(Metric("a.order", "order", "", "", low=robustness.LEAST_ORDER), made,
                                            lambda *_, coarse=coarse, fine=fine: math.log2(coarse / fine),
                                            error=lambda run, errors=errors: errors[run.path.name], bar=bar)
            metric, = check.scores(self.folder / "out")
            self.assertEqual(metric.verdict, verdict, errors)
            self.assertAlmostEqual(metric.value, math.log2(coarse / fine))  # the order is shown unchanged
            self.assertEqual(bool(metric.met_because), verdict == "met" and metric.value < robustness.LEAST_ORDER)

    def test_the_full_matrix_is_that_of_the_table(self):
        gate = robustness.gates(robustness.Bench("full"))["dam-break"]
        self.assertEqual(len(gate.runs), 3 * 5 * 2 * 2)  # spacings, starts, with and without viscosity, integrators


class Command(BenchTest):
    def test_numbers_verdicts_and_files(self):
        self.fake(FAKE_FAILS="no-slip")
        code, out, err = self.bench("--gate", "slip", "--gate", "density")
        self.assertEqual(code, 0, err)
        result = json.loads((self.folder / "out/validation.json").read_text())
        metrics = {metric["name"]: metric for gate in result["studies"] for metric in gate["metrics"]}
        self.assertEqual((metrics["density.explicit.mean"]["value"], metrics["density.explicit.mean"]["verdict"]),
                         (0.001, "met"))
        self.assertEqual(metrics["density.explicit.rms"]["verdict"], "missed")
        self.assertEqual((metrics["slip.no-slip.explicit.finished"]["value"],
                          metrics["slip.no-slip.explicit.finished"]["verdict"]), (0, "missed"))
        self.assertIn("made to fail", metrics["slip.no-slip.explicit.delay"]["note"])
        self.assertEqual(metrics["slip.partial.explicit.finished"]["verdict"], "met")
        self.assertEqual((result["commit"], result["version"]), ("abc", "9.9.9"))
        self.assertRegex(out, r"density +rms density error, .* 0\.02 +<= 0\.01 +missed")
        self.assertIn("made to fail", (self.folder / "out/report.html").read_text())

    def test_interventions_count_each_kind_but_no_rates(self):
        self.make(run := runs.Run("a", self.case))
        made = runs.finished(run, self.folder / "out")
        self.assertEqual(robustness.interventions(made), 4 / (100 * 50))
        self.assertEqual(robustness.interventions(made, "capped_shifts"), 1 / (100 * 50))

    def test_list_does_nothing(self):
        code, out, _ = self.bench("--list")
        self.assertEqual(code, 0)
        self.assertEqual([line.split()[0] for line in out.splitlines()], list(robustness.gates(robustness.Bench())))
        self.assertFalse((self.folder / "out").exists())

    def test_bad_input_is_refused_before_anything_runs(self):
        for arguments, part in ((("--gate", "tnak"), "did you mean tank?"), (("--jobs", "0"), "at least 1"),
                                (("--set", "x"), "key=value"), (("--level", "some"), "quick"),
                                (("--set", "bogus=1"), "unknown key bogus"), (("--bogus",), "--help")):
            with self.subTest(arguments):
                code, out, err = self.bench(*arguments)
                self.assertEqual((code, out), (2, ""))
                self.assertRegex(err, "^error: ")
                self.assertIn(part, err)
        self.assertEqual(self.calls(), [])

    def test_interrupted_runs_are_made_again_and_finished_ones_kept(self):
        command = [sys.executable, "-B", "-m", "tailwater_validation.robustness", "--program", str(self.program),
                   "--out", str(self.folder / "out"), "--gate", "slip"]
        process = subprocess.Popen(command, env={**os.environ, "FAKE_WAITS": "partial"}, stderr=subprocess.PIPE,
                                   text=True)
        self.addCleanup(process.communicate)
        while len(self.calls()) < 3:  # no-slip, free slip, then the run that waits
            self.assertIsNone(process.poll(), "it has ended before it was interrupted")
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=600)
        self.assertEqual(process.returncode, 130, err)
        self.assertEqual(len(self.calls()), 3)
        self.assertEqual(self.bench("--gate", "slip")[0], 0)
        made = self.calls()
        self.assertEqual(len(made), 4)
        self.assertEqual(made[3], made[2])


if __name__ == "__main__":
    unittest.main()
