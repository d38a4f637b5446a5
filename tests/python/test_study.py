"""A study of a case of a few particles: its runs, its results, and its error messages."""

import csv
import json
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas
import tailwater as tw
from small import DAM, PackageTest
from tailwater import study_command
from tailwater.study import done, finest_within, fitting, ladder, misfit, quantities_of
from tailwater.uncertainty import estimate


class Studies(PackageTest):
    def setUp(self):
        super().setUp()
        self.case = tw.Case(self.write("dam.toml", DAM)).update({"time.end": 0.02})

    def test_of_a_case(self):
        found = tw.study(self.case, out="s", spacings=[0.1, 0.125, 0.16], starts=1, jobs=2)
        self.assertEqual(found.spacings, [0.1, 0.125, 0.16])
        self.assertEqual([found.starts[0].spacing, found.step.spacing], [0.125, 0.125])
        self.assertEqual(found.step.case["scheme"]["courant"], found.runs[1].case["scheme"]["courant"] / 2)
        self.assertEqual(found.starts[0].case["particles"]["jitter"], 0.01)
        # The table holds the estimates for the results of the runs.
        def value(run):
            return run.results["depth"]["quantities"][0]["value"]
        expected = estimate(found.spacings, [value(run) for run in found.runs],
                            starts={0.125: [value(found.runs[1]), value(found.starts[0])]},
                            step=(0.125, value(found.step)))
        row = found.table().loc[("depth", "depth")]
        self.assertEqual([row["value"], row["low"], row["high"]], [expected.value, expected.low, expected.high])
        self.assertEqual(row["unit"], "m")
        with open("s/study.csv", encoding="utf-8") as file:
            self.assertAlmostEqual(float(next(csv.DictReader(file))["high"]), expected.high, 8)
        told = json.loads(Path("s/study.json").read_text(encoding="utf-8"))
        self.assertEqual([told["spacings_m"], len(told["results"])], [found.spacings, len(found.rows)])
        self.assertEqual([Path("s", name).resolve() for name in told["runs"]], [run.path.resolve() for run in found.runs])
        self.assertIn("depth, depth: ", Path("s/study.txt").read_text(encoding="utf-8"))
        loaded = tw.Study.load("s")
        self.assertEqual([repr(loaded), loaded.step.path.resolve()], [repr(found), found.step.path.resolve()])
        # A second call runs nothing.
        before = [run.path.joinpath("summary.json").stat().st_mtime_ns for run in found.runs]
        again = tw.study(self.case, out="s", spacings=[0.1, 0.125, 0.16], starts=1)
        self.assertEqual([run.path.joinpath("summary.json").stat().st_mtime_ns for run in again.runs], before)
        self.assertEqual(repr(again), repr(found))

    def test_numbers_of_your_own(self):
        found = tw.study(self.case, out="s", spacings=[0.1, 0.125, 0.16], starts=0, step=False,
                         quantities=lambda run: {("mine", "spacing"): (run.spacing, "m")})
        self.assertEqual([(row["probe"], row["quantity"], row["value"], row["unit"]) for row in found.rows],
                         [("mine", "spacing", 0.1, "m")])
        self.assertTrue(found.rows[0]["low"] < 0 < found.rows[0]["high"])
        self.assertLess(found.rows[0]["limit"], 0.1)

    def test_numbers_of_particles_have_no_limit(self):
        volume = [{"name": "particles", "value": 560.0, "unit": ""}, {"name": "volume in", "value": 0.5, "unit": "m^3"}]
        run = SimpleNamespace(results={"water": {"quantities": volume}}, summary={})
        self.assertEqual(quantities_of(run), {("water", "volume in"): (0.5, "m^3")})

    def test_rows_that_do_not_fit_the_water(self):
        """Rows are stretched to fit a block, so all runs have its water."""
        found = tw.study(self.case, out="s", spacings=[0.09, 0.13, 0.17], starts=0, step=False)
        self.assertNotIn("water than", found.text())
        summary = Path("s/spacings/particles.spacing=0.13/summary.json")
        told = json.loads(summary.read_text(encoding="utf-8"))
        told["water_balance"]["start"]["volume_m3"] *= 0.96
        summary.write_text(json.dumps(told), encoding="utf-8")
        self.assertIn("\nthe run at 0.13 m begins with 4.0 % more or less water than the finest one: ", tw.Study.load("s").text())

    def test_runs_stop_with_the_study(self):
        case, out = self.write("dam.toml", DAM.replace("end = 0.1", "end = 1000")), Path("s")
        for stop, code in ((signal.SIGINT, 130), (signal.SIGTERM, 130), (signal.SIGKILL, -signal.SIGKILL)):
            study = subprocess.Popen([sys.executable, "-B", "-m", "tailwater.study_command", case, "--out", out,
                                      "--spacings", "0.2,0.15,0.1", "--starts", "0", "--quiet"])
            self.addCleanup(study.kill)
            steps = out / "spacings/particles.spacing=0.2/steps.csv"
            before = self.wait_for(lambda: steps.exists() and steps.stat().st_size)
            self.wait_for(lambda: steps.stat().st_size > before)
            study.send_signal(stop)
            self.assertEqual(study.wait(), code)
            self.wait_for(lambda: tw.Run(steps.parent).status == "interrupted")
            self.wait_for(lambda: "interrupted" in (out / "spacings/sweep.csv").read_text(encoding="utf-8"))

    def wait_for(self, condition):
        end = time.monotonic() + 60
        while not (found := condition()):
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)
        return found

    def test_run_that_fails_is_named(self):
        self.case["pressure_solver.max_iterations"] = 1
        with self.assertRaisesRegex(tw.DataError, "particles.spacing=0.*max_iterations"):
            tw.study(self.case, out="s", spacings=[0.16, 0.125, 0.1])

    def test_run_on_a_full_disk(self):
        message = "cannot write 'a/steps.csv': No space left on device"
        table = pandas.DataFrame([{"member": "a", "status": "failed", "exit_code": 4.0, "message": message}]).set_index("member")
        members = SimpleNamespace(path=Path("s"), table=lambda: table)
        with self.assertRaisesRegex(tw.IoError, f"s/a: failed: {message}; remedy: make room for the files"):
            done(members, "other spacings")

    def test_what_is_no_study(self):
        with self.assertRaisesRegex(tw.DataError, "nowhere/study.json: is not the table of a study"):
            tw.Study.load("nowhere")
        for budget in ("10min", -1):
            with self.assertRaisesRegex(tw.InputError, "seconds"):
                tw.study(self.case, budget=budget)

    def test_case_without_probes_is_refused_before_the_first_run(self):
        del self.case["probe"]
        with self.assertRaisesRegex(tw.InputError, "has no probe, so a study has no result; remedy: add a "):
            tw.study(self.case, out="s", spacings=[0.1, 0.125, 0.16])
        self.assertFalse(Path("s").exists())
        tw.study(self.case, out="s", spacings=[0.1, 0.125, 0.16], starts=0, step=False,
                 quantities=lambda run: {("mine", "spacing"): (run.spacing, "m")})
        made = tw.report("s", pictures=0)
        self.assertFalse(made.is_reliable)
        self.assertRegex(made.first_line, "relied on: the case has no probe, so there is no number; .* no result.$")

    def test_the_folder_of_a_run_is_none_for_a_study(self):
        self.case.run("run")
        before = sorted(Path("run").rglob("*"))
        with self.assertRaisesRegex(tw.InputError, "holds the results of a run; remedy"):
            tw.study(self.case, out="run", spacings=[0.1, 0.125, 0.16])
        self.assertEqual(sorted(Path("run").rglob("*")), before)

    def test_two_spacings_are_no_study(self):
        for spacings in ([0.1, 0.2, 0.1], [0.1, 0.2, -0.1]):
            with self.assertRaisesRegex(tw.InputError, "three or more"):
                tw.study(self.case, spacings=spacings)
        self.assertFalse(Path("dam_study").exists())


class Budgets(unittest.TestCase):
    def test_ladder_goes_down_by_one_factor(self):
        self.assertEqual(ladder(0.2, 0.025, 4), [0.1, 0.05, 0.025])

    def test_spacings_fit_the_water(self):
        block = np.array([1.0, 0.2])
        self.assertAlmostEqual(misfit(0.0625, block), 1 - 3 * 0.0625 / 0.2)
        self.assertAlmostEqual(fitting(0.0625, block, 0.1), 1 / 15)
        self.assertEqual(fitting(0.05, block, 0.1), 0.05)
        self.assertEqual(fitting(0.0625, np.zeros(0), 0.1), 0.0625)

    def test_budget_is_what_all_runs_take(self):
        finest = finest_within(0.1, 2.0, 1000.0, 2, extra=5)
        seconds = [2.0 * (0.1 / spacing)**3.3 for spacing in (0.1, *ladder(0.1, finest))]
        self.assertAlmostEqual(sum(seconds) + 5 * seconds[1], 1000, delta=5)

    def test_budget_that_is_too_small(self):
        with self.assertRaisesRegex(tw.InputError, "budget 10: the coarsest run, at 0.1 m, has taken 2 s.*remedy"):
            finest_within(0.1, 2.0, 10.0, 2, extra=5)


class CommandLine(unittest.TestCase):
    def test_times_and_values(self):
        self.assertEqual([study_command.seconds(text) for text in ("90", "20min", "1.5h")], [90, 1200, 5400])
        for text in ("", "-1", "1 day", "0"):
            with self.assertRaises(study_command.argparse.ArgumentTypeError):
                study_command.seconds(text)
        self.assertEqual([study_command.change(f"a.b={text}") for text in ("0.1", "[1, 2]", "2*H")],
                         [("a.b", 0.1), ("a.b", [1, 2]), ("a.b", "2*H")])

    def test_mistakes_end_with_2(self):
        out = ["my.toml", "--out", "s"]
        for words in (["my.toml"], [*out, "--starts", "-1"], [*out, "--spacings", "a"],
                      [*out, "--set", "particles.spacing"]):
            with self.assertRaises(SystemExit) as ended:
                study_command.parser().parse_args(words)
            self.assertEqual(ended.exception.code, 2)


if __name__ == "__main__":
    unittest.main()
