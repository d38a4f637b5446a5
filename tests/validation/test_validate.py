"""The command `validate`: studies, numbers and results, repeated runs, and the report."""

import json
import tempfile
import unittest
import unittest.mock
from pathlib import Path

import numpy as np

import synthetic_run
from fake_program import ProgramTest
from tailwater import plots
from tailwater.errors import DataError
from tailwater.run import Run
from tailwater_validation import panels, runs, study, validate
from tailwater_validation.checks import Check
from tailwater_validation.metric import Metric, shown
from tailwater_validation.particles import detached
from tailwater_validation.study import LEVELS, Plan
from tailwater_validation.studies import operators, studies, zhou1999

DEPTH_ERROR = 0.03  # over H: within the targets of the depths


def setUpModule():
    """Makes the folder of a run of cases/zhou1999 in which every number that a study needs is known."""
    global scratch
    scratch = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(scratch.cleanup)
    folder = synthetic_folder()
    synthetic_run.write_run(folder, spacing=0.06, depth_error=DEPTH_ERROR)
    summary = json.loads((folder / "summary.json").read_text())
    (folder / "summary.json").write_text(json.dumps(summary | {
        "spacing_m": 0.06, "pressure_solver": {"iterations_per_solve": 8.0}}))
    case = folder / "case.effective.toml"
    case.write_text(case.read_text() + "[physics]\ndensity = 1000.0\ngravity = [0.0, -9.81]\n")
    time = np.linspace(0, 8 * zhou1999.TIME_SCALE, 50)
    columns = {"time_s": time, "kinetic_J": 100 * time, "potential_J": 2000 - 150 * time, "passes": 1 + 0 * time,
               "density_error_mean": 0 * time, "density_error_rms": 0.01 + 0 * time, "volume_out_m3": 0 * time}
    np.savetxt(folder / "steps.csv", np.stack(list(columns.values()), axis=1), delimiter=",", header=",".join(columns),
               comments="")


def synthetic_folder():
    return Path(scratch.name) / "zhou"


class ValidateTest(ProgramTest):
    def validate(self, *arguments, draw=False):
        """Runs the command; without `draw` there are no figures, which take longer than all else."""
        figures = validate.figures if draw else lambda *_: []
        with unittest.mock.patch.object(validate, "figures", figures):
            return self.command(validate.main, "--jobs", "1", *arguments)

    def only_run(self, *arguments):
        """Runs the command without scores and report."""
        with unittest.mock.patch.object(validate, "score", lambda *_: ""):
            return self.command(validate.main, "--jobs", "1", *arguments)

    def result(self):
        return json.loads((self.folder / "out/validation.json").read_text())

    def report(self):
        return json.loads((self.folder / "out/report.json").read_text())

    def metrics(self):
        return {metric["name"]: metric for record in self.result()["studies"] for metric in record["metrics"]}


class Scores(ValidateTest):
    def test_numbers_and_verdicts(self):
        self.fake(FAKE_RUN=str(synthetic_folder()))
        code, out, err = self.validate("zhou1999")
        self.assertEqual(code, 0, err)
        result, metrics = self.result(), self.metrics()
        # The depths are one of two readings of the laboratory's curves plus DEPTH_ERROR; the other reading differs by a
        # few hundredths.
        other = zhou1999.distance(Run(synthetic_folder()), "H2", (0.0, 6.0), reading="fluidity")["value"]
        self.assertAlmostEqual(metrics["zhou1999.H2.T6"]["value"], 0.5 * (DEPTH_ERROR + other), places=9)
        self.assertEqual([metrics["zhou1999.H2.T6"][name] for name in ("verdict", "result")], ["met", "met"])
        self.assertEqual(metrics["zhou1999.noise"]["verdict"], "missed")  # the sawtooth is 0.02 rho g H
        self.assertEqual((metrics["zhou1999.cost"]["value"], metrics["zhou1999.cost"]["verdict"]), (30.0, "missed"))
        self.assertEqual(metrics["zhou1999.H1.T6.highest"]["verdict"], "shown")
        measured = dict((name, [low, high]) for name, low, high in zhou1999.COST_PEERS)
        self.assertTrue(measured)
        self.assertEqual({peer["name"]: peer["range"] for peer in metrics["zhou1999.cost"]["peers"]}, measured)
        self.assertEqual((result["commit"], result["level"], result["scheme"], result["ranks"]), ("abc", "quick", "", 1))
        self.assertLess({"name", "processor", "cores"}, set(result["machine"]) | {"any"})
        verdicts = [metric["verdict"] for metric in metrics.values()]
        self.assertEqual(result["verdicts"], {verdict: verdicts.count(verdict) for verdict in ("met", "missed", "shown")})
        self.assertIn(f"report: {self.folder}/out/report.html", out)

    def test_a_failed_run_is_missed_and_told(self):
        self.fake(FAKE_RUN=str(synthetic_folder()), FAKE_FAILS="particles.spacing=0.015")
        self.assertEqual(self.validate("zhou1999")[0], 0)
        metric = self.metrics()["zhou1999.H2.T6"]
        self.assertEqual((metric["value"], metric["verdict"]), (None, "missed"))
        self.assertIn("made to fail", metric["note"])
        self.assertIn("made to fail", (self.folder / "out/report.html").read_text())

    def test_finished_runs_are_not_repeated(self):
        self.fake(FAKE_RUN=str(synthetic_folder()))
        self.only_run("slip")
        made = self.calls()
        self.assertEqual(len(made), 3)
        self.only_run("slip", "time-step")
        self.assertEqual(len(self.calls()), 5)  # the default belongs to both
        self.commit("def")
        self.only_run("slip")
        self.assertEqual(self.calls()[5:], made)

    def test_scheme_and_ranks_reach_the_program(self):
        self.fake(FAKE_RUN=str(synthetic_folder()))
        self.only_run("zhou1999", "--scheme", "farmani2020", "-n", "3")
        for path in (self.folder / "out/runs").glob("*/made.json"):
            command = json.loads(path.read_text())["command"]
            self.assertIn("--set scheme.name=farmani2020", command)
            self.assertIn("-n 3", command)
        self.assertTrue(all(name.endswith("_farmani2020") for name in self.calls()))


class Report(ValidateTest):
    def test_has_all_numbers_with_what_there_is_to_look_at(self):
        self.fake(FAKE_RUN=str(synthetic_folder()))
        code, _, err = self.validate("zhou1999", "slip", draw=True)
        self.assertEqual(code, 0, err)
        report = self.report()
        zhou, slip = report.pop("studies")
        result = self.result()
        for told, record in zip((zhou, slip), result.pop("studies")):
            self.assertEqual(told, told | record)
        self.assertEqual(report, result)
        self.assertEqual((zhou["shown"], slip["shown"]), ("zhou1999_dx0.015_implicit", None))
        self.assertEqual(zhou["moments"][0], {"time": zhou1999.TIME_SCALE, "label": "t = 0.247 s, T = 1"})
        for figure in (*zhou["figures"], *slip["figures"]):
            self.assertNotIn("missing", figure)
            for panel in figure["panels"]:
                self.assertGreater(len(panel["curves"]), 0, figure["caption"])
        depths = zhou["figures"][1]["panels"][0]["curves"]
        self.assertEqual([curve["kind"] for curve in depths], ["measured", "measured", "run", "run", "aside"])
        # The computed depth is one reading of the laboratory's curve plus DEPTH_ERROR.
        measured = next(curve for curve in depths if "openmps" in curve["label"])
        computed = np.interp(measured["x"], depths[2]["x"], depths[2]["y"])
        self.assertLess(np.median(np.abs(computed - measured["y"] - DEPTH_ERROR)), 0.01)
        self.assertEqual([curve["label"] for curve in slip["figures"][0]["panels"][0]["curves"]][2:],
                         ["free", "partial (0.5)", "no slip"])

    def test_says_why_there_is_no_figure(self):
        self.fake(FAKE_RUN=str(synthetic_folder()), FAKE_FAILS="particles.spacing")
        self.validate("zhou1999", draw=True)
        zhou, = self.report()["studies"]
        self.assertIsNone(zhou["shown"])
        self.assertEqual({figure["missing"] for figure in zhou["figures"]}, {"no run reached its end"})

    def test_that_cannot_be_made_ends_the_command(self):
        self.fake(FAKE_RUN=str(synthetic_folder()), FAKE_FAILS="--export")
        code, _, err = self.validate("slip")
        self.assertEqual(code, 4)
        self.assertIn("report.html: made to fail", err)
        self.assertEqual(len(self.result()["studies"]), 1)


class BadInput(ValidateTest):
    def test_is_refused_before_anything_runs(self):
        taken = self.folder / "taken"
        taken.write_text("")
        for arguments, part in ((("zhou",), "did you mean zhou1999? Cases: zhou1999, "), (("--level", "some"), "quick"),
                                (("--jobs", "0"), "at least 1"), (("-n", "0"), "at least 1"), (("-n", "two"), "-n"),
                                (("--scheme", "bogus"), "unknown key bogus"), (("--bogus",), "--help")):
            with self.subTest(arguments):
                code, out, err = self.validate(*arguments)
                self.assertEqual((code, out), (2, ""))
                self.assertRegex(err, "^error: ")
                self.assertIn(part, err)
        code, _, err = self.validate("drop", "--out", str(taken))
        self.assertEqual(code, 4)
        self.assertIn("taken", err)
        self.assertEqual(self.calls(), [])

    def test_a_folder_with_other_things_is_kept(self):
        (self.folder / "out").mkdir()
        (self.folder / "out/mine.txt").write_text("mine")
        self.fake(FAKE_RUN=str(synthetic_folder()))
        self.assertEqual(self.only_run("zhou1999")[0], 0)
        self.assertEqual((self.folder / "out/mine.txt").read_text(), "mine")

    def test_a_program_that_refuses_every_run(self):
        self.fake(FAKE_REFUSES="run")
        code, _, err = self.validate("slip")
        self.assertEqual(code, 2)
        self.assertIn("every run was refused", err)
        self.assertIn("not accepted", err)

    def test_list_does_nothing(self):
        code, out, _ = self.validate("--list")
        self.assertEqual(code, 0)
        self.assertEqual([line.split()[0] for line in out.splitlines()], list(studies(Plan())))
        self.assertFalse((self.folder / "out").exists())

    def test_cases_may_stand_between_options(self):
        code, out, _ = self.validate("drop", "--list", "tank")
        self.assertEqual((code, [line.split()[0] for line in out.splitlines()]), (0, ["tank", "drop"]))


class Studies(unittest.TestCase):
    def test_runs_of_one_name_are_one_run_and_their_cases_are_there(self):
        for plan in (*map(Plan, LEVELS), Plan("quick", "farmani2020")):
            every = [run for one in studies(plan).values() for run in one.runs]
            self.assertEqual(len({run.name for run in every}), len(set(every)))
            for run in every:
                if isinstance(run, runs.Run):
                    self.assertTrue(run.case.is_file(), run.case)

    def test_names_of_numbers_are_unique_and_begin_with_the_study(self):
        names = [(one.name, check.metric.name) for one in studies(Plan()).values() for check in one.checks
                 if isinstance(check, Check)]
        self.assertEqual(len(names), len(set(names)))
        for one, name in names:
            self.assertTrue(name.startswith(f"{one}."), name)

    def test_quick_is_under_ten_minutes_on_two_cores(self):
        every = {run for one in studies(Plan("quick")).values() for run in one.runs}
        self.assertLess(sum(run.seconds for run in every), 2 * 600)

    def test_a_scheme_under_test_leaves_the_comparisons_alone(self):
        default = studies(Plan("quick"))
        for name, one in studies(Plan("quick", "farmani2020")).items():
            if one.kind == study.COMPARISON:
                self.assertEqual(one.runs, default[name].runs)
                self.assertIn("scheme.integrator", str(one.runs))
            else:
                self.assertNotIn("scheme.integrator", str(one.runs), "it has no integrators")
                self.assertTrue(all("scheme.name=farmani2020" in run.settings for run in one.runs
                                    if isinstance(run, runs.Run)), name)


class Checks(unittest.TestCase):
    def test_the_order_is_that_of_a_power_law(self):
        spacings = (0.4, 0.2, 0.1)
        folders = {dx: unittest.mock.Mock(spacing=dx) for dx in spacings}
        made = tuple(runs.Run(f"{dx}", Path("case"), (), 1) for dx in spacings)
        check = study.OrderCheck(Metric("a", "a", "", "", high=0.1), made, lambda folder: 3 * folder.spacing**1.7)
        with unittest.mock.patch.object(study, "finished", lambda run, out: folders[float(run.name)]):
            metric = check.score(None)
        self.assertAlmostEqual(metric.order, 1.7, places=9)
        self.assertAlmostEqual(metric.value, 3 * 0.1**1.7, places=12)
        # With three values nothing confirms the order, so the uncertainty is three times the error.
        self.assertAlmostEqual(metric.uncertainty, 3 * metric.value, places=6)
        self.assertRegex(shown(validate.metric_record(check, metric)), r"^0\.0599 ± 0\.18$")
        self.assertEqual(metric.verdict, "met")

    def test_all_numbers_of_a_module_come_with_its_name(self):
        made = (runs.Run("r", Path("case")),)
        found = {"a": Metric("a", "deep", "m", "b", high=1.0, value=2.0), "z": Metric("z", "far", "m", "b")}
        checks = study.AllChecks("case", None, made, lambda name: name == "a", (("a", 9.24),))
        with unittest.mock.patch.object(study, "finished"), unittest.mock.patch.object(study, "scores", lambda *_: found):
            metric, = checks.scores(None)
        self.assertEqual((metric.name, metric.what, metric.paper, metric.verdict), ("case.a", "deep", 9.24, "missed"))
        with unittest.mock.patch.object(study, "finished", side_effect=DataError("r: it broke")):
            metric, = checks.scores(None)
        self.assertEqual((metric.name, metric.verdict, metric.note), ("case.finished", "missed", "r: it broke"))

    def test_numbers_of_tests_come_from_their_record(self):
        run = runs.TestRun("t", "operators", "*")
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "tests.json").write_text(json.dumps({"testsuites": [{"name": "A", "testsuite": [
                {"name": "one", "line": 3, "time": "0.1s", "timestamp": "2026-11-21T08:00:00Z",
                 "grad_2D_dx0.02": "4.0e-04", "grad_2D_dx0.01": "1.0e-04", "grad_3D_dx0.01": "5e+00"}]}]}))
            numbers = run.open(Path(folder))
        self.assertEqual(operators.recorded("grad", 2, numbers), {0.02: 4e-4, 0.01: 1e-4})
        self.assertAlmostEqual(operators.observed_order("grad", 2, numbers), 2.0, places=12)
        with self.assertRaisesRegex(DataError, "no grad in 1D"):
            operators.recorded("grad", 1, numbers)


class Records(ValidateTest):
    def test_the_terminal_says_why_a_value_outside_of_its_bar_meets_it(self):
        metric = Metric("a", "observed order", "", "", low=1.5, value=0.9, met_because="right already")
        record = validate.metric_record(Check(metric, (), None), metric)
        table = validate.overview({"studies": [{"name": "exact", "metrics": [record]}], "verdicts": {"met": 1}})
        self.assertRegex(table, r"exact +observed order +0\.9 +>= 1\.5 +met +right already\n")

    def test_a_flow_that_starts_without_energy(self):
        path = synthetic_folder() / "summary.json"
        told = path.read_text()
        self.addCleanup(path.write_text, told)
        path.write_text(json.dumps(json.loads(told) | {"energy": {"start_J": 0.0, "end_J": 5.0, "largest_rise_over_start": 0}}))
        self.fake(FAKE_RUN=str(synthetic_folder()))
        self.only_run("slip")
        record = validate.run_record(studies(Plan())["slip"].runs[0], self.folder / "out")
        self.assertEqual((record["energy_end_over_start"], record["energy_rise_over_start"]), (None, None))


    def test_what_is_no_number_is_none(self):
        metric = Metric("a", "a", "", "", high=1, value=np.nan, order=-np.inf, note="why")
        record = validate.metric_record(unittest.mock.Mock(variant="", runs=()), metric)
        self.assertEqual((record["value"], record["order"], record["verdict"]), (None, None, "missed"))


class Detached(unittest.TestCase):
    def test_counts_what_no_chain_joins(self):
        block = np.array([(x, y, 0.0) for x in np.arange(20.0) for y in np.arange(5.0)])
        bridge = np.array([(x, 5.0, 0.0) for x in np.arange(20.0, 26.0)])
        drops = np.array([(10.0, 20.0, 0.0), (10.5, 20.5, 0.0), (40.0, 0.0, 0.0)])
        self.assertEqual(detached(np.concatenate([block, bridge, drops]), 1.5), 3)
        self.assertEqual(detached(block, 1.5), 0)


class Plots(unittest.TestCase):
    def test_labels_tell_runs_apart(self):
        def run(name, dx):
            folder = unittest.mock.Mock(spacing=dx, integrator="explicit")
            folder.path.name = name
            return folder
        self.assertEqual(panels.labels([run("a", 0.02), run("b", 0.01)]), ["dx = 20 mm, explicit", "dx = 10 mm, explicit"])
        self.assertEqual(panels.labels([run("a", 0.02), run("b", 0.02)]), ["a", "b"])

    def test_a_long_curve_keeps_its_peaks_and_gaps_are_no_numbers(self):
        time = np.linspace(0, 1, 20001)
        value = np.sin(9 * time)
        value[[700, 12345]] = 7, -7
        thin = panels.curve("gauge", time, value)
        self.assertLessEqual(len(thin["x"]), 2 * panels.BINS)
        self.assertEqual([(x, y) for x, y in zip(thin["x"], thin["y"]) if abs(y) > 1], [(0.035, 7.0), (0.61725, -7.0)])
        self.assertLess(np.max(np.abs(np.interp(time[:600], thin["x"], thin["y"]) - value[:600])), 0.02)
        self.assertEqual(panels.curve("gauge", [2, 1], [np.nan, 3])["y"], [3.0, None])

    def test_convergence_tells_the_order(self):
        panel, = panels.convergence({"error": {dx: 3 * dx**1.7 for dx in (0.1, 0.2, 0.4)}}, "error")
        self.assertEqual([curve["label"] for curve in panel["curves"]], ["error: order 1.7", "order 1", "order 2"])
        for curve, order in zip(panel["curves"], (1.7, 1, 2)):
            self.assertAlmostEqual(curve["y"][-1], 3 * 0.4**1.7, delta=1e-5)
            self.assertAlmostEqual(curve["y"][0], 3 * 0.4**1.7 / 4**order, delta=1e-5)

    def test_flat_channels_are_exaggerated(self):
        def view(length):
            run = unittest.mock.Mock(path=Path("none"), walls_at=lambda _: [[(0, 1), (0, 0), (length, 0), (length, 1)]])
            frame = unittest.mock.Mock(position=np.array([[0.5, 0.5, 0], [length - 0.5, 0.99, 0]]))
            return plots.View(run, [frame])
        self.assertEqual(view(3).exaggeration, 1)
        long = view(50)
        self.assertGreater(long.exaggeration, 1)
        self.assertGreaterEqual(long.ratio, plots.FLATTEST)


if __name__ == "__main__":
    unittest.main()
