"""The laboratory's files, and the comparison from end to end on a made-up run whose scores are known."""

import contextlib
import io
import json
import math
import shutil
import tempfile
import tomllib
import unittest
import unittest.mock
from pathlib import Path

import numpy as np

import synthetic_run
from tailwater.errors import DataError
from tailwater.fields import list_frames, nearest_frames
from tailwater.run import Run
from tailwater.tables import read_table
from tailwater_validation import score
from tailwater_validation.curves import rms_difference
from tailwater_validation.studies import zhou1999

CASE = synthetic_run.CASES / "zhou1999"
DATA = CASE / "data"


class RunTest(unittest.TestCase):
    def write_run(self, **options):
        parent = tempfile.TemporaryDirectory()
        self.addCleanup(parent.cleanup)
        run = Path(parent.name) / "run"
        synthetic_run.write_run(run, **options)
        return run

    def score(self, **options):
        return {metric.name: metric for metric in zhou1999.metrics(Run(self.write_run(**options)))}


class Data(RunTest):
    FILES = [(quantity, digitisation) for quantity in ("H1", "H2", "P2") for digitisation in ("openmps", "fluidity")]

    def test_every_file_says_where_it_comes_from(self):
        self.assertEqual(len(list(DATA.iterdir())), len(self.FILES))
        for path in DATA.iterdir():
            text = path.read_text()
            for word in ("# WHAT:", "# PAPER:", "# SOURCE:", "# CAVEATS:", "# ADDED:"):
                self.assertIn(word, text, path)

    def test_curves_span_what_is_scored(self):
        run = Run(self.write_run(spacing=0.1, end=1.0))
        for quantity, digitisation in self.FILES:
            curve = zhou1999.laboratory(run, quantity)[digitisation]
            start, end = zhou1999.PRESSURE_WINDOW if quantity == "P2" else (0, 8)
            self.assertLessEqual(curve.time[0], start)
            self.assertGreaterEqual(curve.time[-1], end + zhou1999.TIME_UNCERTAINTY)
            self.assertTrue((np.diff(curve.time) > 0).all())

    def test_scaled_columns_follow_from_the_raw_ones(self):
        for quantity, digitisation in self.FILES:
            table = read_table(DATA / f"zhou1999_{quantity}_{digitisation}.csv")
            seconds = table["t_s"]
            raw = table[next(name for name in table if name.startswith("value"))]
            scale = zhou1999.PRESSURE_SCALE if quantity == "P2" else zhou1999.H
            scaled = table["p_over_rhogH" if quantity == "P2" else "h_over_H"]
            # The added columns carry six digits; the seconds they were made from as well.
            np.testing.assert_allclose(table["tstar"], seconds / zhou1999.TIME_SCALE, rtol=1e-5, atol=1e-6)
            np.testing.assert_allclose(scaled, raw / scale, rtol=1e-5, atol=1e-6)

    def test_the_case_has_the_probes_that_are_scored(self):
        with open(CASE / "case.toml", "rb") as file:
            case = tomllib.load(file)
        types = {probe["name"]: probe["type"] for probe in case["probe"]}
        self.assertEqual({name: types.get(name) for name in ("H1", "H2", "P2", *zhou1999.POINT_HEIGHTS)},
                         {"H1": "depth", "H2": "depth", "P2": "wall-pressure-mean"} | dict.fromkeys(zhou1999.POINT_HEIGHTS, "wall-pressure"))
        self.assertEqual(case["parameters"]["H"], zhou1999.H)
        self.assertNotIn("interval", [key for probe in case["probe"] for key in probe])  # noise needs every step


class Scores(RunTest):
    def distance(self, probe, window, **options):
        """From the reading that the run repeats."""
        return zhou1999.distance(Run(self.write_run(**options)), probe, window, reading="openmps")

    def test_a_run_that_is_late_by_a_known_time(self):
        for probe, window in (("P2", zhou1999.PRESSURE_WINDOW), ("H1", (0.0, 8.0)), ("H2", (0.0, 6.0))):
            with self.subTest(probe):
                found = self.distance(probe, window, delay=0.1)
                self.assertAlmostEqual(found["shift"], 0.1, places=9)
                self.assertAlmostEqual(found["shifted_value"], 0, places=9)
                self.assertGreater(found["value"], 1e-3)

    def test_depths_that_are_wrong_by_a_known_height(self):
        for error in (0.04, 0.06):
            for gauge in zhou1999.GAUGES:
                self.assertAlmostEqual(self.distance(gauge, (0.0, 6.0), depth_error=error)["value"], error, places=9)

    def test_a_distance_is_the_mean_of_both_readings(self):
        run = Run(self.write_run(depth_error=0.04))
        for field, value in zhou1999.distance(run, "H1", (0.0, 6.0)).items():
            apart = [zhou1999.distance(run, "H1", (0.0, 6.0), reading=name)[field] for name in ("openmps", "fluidity")]
            self.assertAlmostEqual(value, np.mean(apart), places=12)

    def test_the_readings_differ_by_what_the_case_calls_their_scatter(self):
        run = Run(self.write_run(spacing=0.1, end=1.0))
        for quantity, window, told in (("P2", zhou1999.PRESSURE_WINDOW, 0.04), ("H1", (0, 8), 0.025), ("H2", (0, 8), 0.02)):
            one, other = zhou1999.laboratory(run, quantity).values()
            self.assertAlmostEqual(rms_difference(one, other, *window, zhou1999.GRID), told, delta=0.1 * told, msg=quantity)

    def test_arrival_and_noise_of_a_step_with_a_sawtooth(self):
        metrics = self.score()
        self.assertAlmostEqual(metrics[f"arrival_{zhou1999.READ_AT}"].value, synthetic_run.ARRIVAL, places=9)
        # RMS of -1, -1/3, 1/3, 1 is sqrt(5)/3; the running median of such a sawtooth is at most 1/3.
        amplitude = synthetic_run.SAWTOOTH
        self.assertAlmostEqual(metrics["noise"].value, amplitude * math.sqrt(5) / 3, delta=amplitude / 3)

    def test_arrival_of_the_front(self):
        metrics = self.score(spacing=0.05)
        exact = (zhou1999.TANK - 0.05 - 1.2) / 5.4
        self.assertGreaterEqual(metrics["arrival_front"].value, exact)
        self.assertLessEqual(metrics["arrival_front"].value, exact + synthetic_run.SAMPLING)

    def test_first_peak_is_that_of_the_laboratory_when_the_run_repeats_it(self):
        run = Run(self.write_run())
        impact = zhou1999.laboratory(run, "P2")["openmps"].window(2.4, 3.0)
        metrics = {metric.name: metric for metric in zhou1999.metrics(run)}
        self.assertAlmostEqual(metrics["peak_P2"].value, impact.value.max(), places=9)
        self.assertAlmostEqual(metrics["peak_time_P2"].value, impact.time[impact.value.argmax()], places=9)

    def test_a_run_that_ends_early_says_so_and_scores_the_rest(self):
        metrics = self.score(end=6.5)
        self.assertIsNone(metrics["rms H1 T 0..8"].value)
        self.assertIn("share only", metrics["rms H1 T 0..8"].note)
        self.assertIsNotNone(metrics["rms H1 T 0..6"].value)

    def test_a_missing_probe_is_named(self):
        run = self.write_run()
        (run / "probes" / "P160.csv").unlink()
        metrics = {metric.name: metric for metric in zhou1999.metrics(Run(run))}
        self.assertIn("P160.csv", metrics["noise"].note)
        self.assertIsNotNone(metrics["peak_P2"].value)


class Fields(RunTest):
    def test_frames_are_read_with_their_times_and_fields(self):
        run = self.write_run(spacing=0.1, end=1.0)
        self.assertEqual(len(list_frames(run)), 6)
        frame, = nearest_frames(run, [0.52 * zhou1999.TIME_SCALE])
        self.assertAlmostEqual(frame.time, 0.6 * zhou1999.TIME_SCALE)
        # Row by row from the floor, every particle's pressure is hydrostatic below the formula's surface.
        x, z = frame.position[:, 0], frame.position[:, 1]
        np.testing.assert_allclose(frame.fields["pressure"], 9810 * (synthetic_run.surface(x, 0.6) - z), rtol=1e-5,
                                   atol=1e-2)

    def test_broken_files_are_named(self):
        run = self.write_run(spacing=0.1, end=1.0)
        frame = run / "fields" / "fields_00000.vtp"
        frame.write_text("not a field file")
        with self.assertRaisesRegex(DataError, "fields_00000.vtp"):
            nearest_frames(run, [0.0])
        (run / "fields" / "fields.pvd").write_text("<half")
        with self.assertRaisesRegex(DataError, "fields.pvd"):
            list_frames(run)


class Picture(synthetic_run.CaseTest):
    def test_a_whole_run_and_one_that_ended_early(self):
        for end in (8.0, 1.0):
            synthetic_run.write_run(self.folder, spacing=0.05, end=end)
            for draw in (zhou1999.draw_pressure, zhou1999.draw_depths):
                self.assert_drawn(unittest.mock.Mock(draw=draw))
            shutil.rmtree(self.folder)


class Command(RunTest):
    def run_command(self, *arguments):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = score.main(list(map(str, arguments)))
        return code, out.getvalue(), err.getvalue()

    def test_numbers_by_name(self):
        code, out, _ = self.run_command("zhou1999", self.write_run(depth_error=0.06, end=6.5))
        numbers = json.loads(out)
        self.assertEqual(code, 0)
        self.assertAlmostEqual(numbers["arrival_P120"], synthetic_run.ARRIVAL, places=9)
        self.assertIn("share only", numbers["rms H1 T 0..8"])

    def test_a_folder_that_is_no_run(self):
        with tempfile.TemporaryDirectory() as folder:
            code, out, err = self.run_command("zhou1999", folder)
            self.assertEqual((code, out), (4, ""))
            self.assertIn("case.effective.toml: cannot be read", err)
            self.assertEqual(list(Path(folder).iterdir()), [])


if __name__ == "__main__":
    unittest.main()
