"""The laboratory's curves and the scores of a made-up run of cases/kleefsman2005."""

import tomllib
import unittest

import numpy as np

import synthetic_run
from tailwater.curves import Curve
from tailwater.errors import DataError
from tailwater.run import Run
from tailwater.tables import read_table
from tailwater_validation.studies import kleefsman2005

TOP_SENSORS = ("P5", "P6", "P7", "P8")
CASE = synthetic_run.CASES / "kleefsman2005"
DATA = CASE / "data" / "kleefsman2005.csv"

EFFECTIVE_CASE = """\
[case]
title = "A made-up impact"
dimension = 3
[physics]
density = 1000.0
gravity = [0.0, 0.0, -9.81]
[particles]
spacing = 0.1
[time]
end = {end}
[scheme]
integrator = "explicit"
"""


def write_run(folder, end=6.0, too_high=0.0, late=0.0, factor=1.0):
    """Repeats the laboratory's curves: heights `too_high` (m), pressures `late` (s) and `factor` times as large after the
    impact. Before it a run's sensors are dry."""
    folder = synthetic_run.make_folder(folder, EFFECTIVE_CASE.format(end=end) + synthetic_run.measurements("kleefsman2005"))
    run = Run(folder)
    for gauge in kleefsman2005.GAUGES:
        curve = kleefsman2005.laboratory(run, gauge).window(0, end + 0.01)
        synthetic_run.write_probe(folder, gauge, {"time_s": curve.time, "connected_m": curve.value + too_high,
                                                  "highest_m": curve.value + too_high + 0.01})
    for sensor in (*kleefsman2005.SENSORS, *TOP_SENSORS):
        curve = kleefsman2005.laboratory(run, sensor).window(0, end + 0.01)
        pressure = np.where(curve.time > kleefsman2005.NOT_BEFORE, factor * curve.value, 0)
        impulse = kleefsman2005.impulses(Curve(curve.time, pressure)).value
        synthetic_run.write_probe(folder, sensor, {"time_s": curve.time + late, "pressure_Pa": pressure,
                                                   "impulse_Pa_s": impulse})
    return folder


class Data(synthetic_run.CaseTest):
    def test_the_file_says_where_it_comes_from(self):
        text = DATA.read_text()
        for word in ("# WHAT:", "# PAPER:", "# SOURCE:", "# CAVEATS:"):
            self.assertIn(word, text)

    def test_curves_span_what_is_scored(self):
        run = Run(write_run(self.folder))
        for name in (*kleefsman2005.GAUGES, *kleefsman2005.SENSORS, *TOP_SENSORS):
            curve = kleefsman2005.laboratory(run, name)
            self.assertLess(curve.time[0], 0.01)
            self.assertGreater(curve.time[-1], kleefsman2005.END)

    def test_heights_are_named_by_who_gets_wet_first(self):
        table = read_table(DATA)
        wet = [table["time_s"][np.argmax(table[f"{gauge}_m"] > 0.05)] for gauge in ("H3", "H2", "H1")]
        self.assertEqual(wet, sorted(wet))
        self.assertAlmostEqual(table["H4_m"][:20].mean(), kleefsman2005.DEPTH, delta=0.01)

    def test_the_case_has_the_probes_that_are_scored(self):
        with open(CASE / "case.toml", "rb") as file:
            case = tomllib.load(file)
        probes = {probe["name"]: probe for probe in case["probe"]}
        for gauge in kleefsman2005.GAUGES:
            self.assertEqual(probes[gauge]["type"], "depth")
        for sensor, height in kleefsman2005.SENSORS.items():
            self.assertEqual((probes[sensor]["type"], probes[sensor]["at"][2]), ("wall-pressure", height))
            self.assertNotIn("interval", probes[sensor])  # impacts are shorter than any


class Scores(synthetic_run.CaseTest):
    def score(self, **options):
        return {metric.name: metric for metric in kleefsman2005.metrics(Run(write_run(self.folder, **options)))}

    def test_a_run_that_repeats_the_laboratory_meets_all_bars(self):
        metrics = self.score()
        for name, metric in metrics.items():
            if not name.startswith("energy"):  # the made-up summary's rise is 2e-4
                self.assertIn(metric.verdict, ("met", ""), name)
        self.assertEqual(metrics["energy rise"].verdict, "missed")
        self.assertAlmostEqual(metrics["mean error H2"].value, 0, places=9)
        self.assertAlmostEqual(metrics["mean error H2 highest"].value, 100 * 0.01 / 0.55, places=6)

    def test_known_errors_are_found(self):
        metrics = self.score(too_high=0.0165, factor=1.12)
        self.assertAlmostEqual(metrics["mean error H4"].value, 3.0, places=6)
        self.assertEqual([metrics[f"mean error {gauge}"].verdict for gauge in ("H2", "H4")], ["met", "missed"])
        self.assertAlmostEqual(metrics["impulse P3"].value, 12.0, places=6)
        self.assertEqual(metrics["impulse P3"].verdict, "missed")
        self.assertAlmostEqual(metrics["largest P1"].value, 12.0, places=6)
        self.assertEqual(metrics["largest P1"].verdict, "met")

    def test_largest_pressures_are_means(self):
        run = Run(write_run(self.folder))
        for sensor in kleefsman2005.SENSORS:
            curve = kleefsman2005.laboratory(run, sensor)
            highest = curve.window(*kleefsman2005.IMPACT).value.max()
            self.assertLess(kleefsman2005.largest(kleefsman2005.impulses(curve)), highest)
        # A spike a tenth as long counts a tenth.
        time = np.linspace(0.3, 1.1, 8001)
        spike = Curve(time, 1e4 * ((time > 0.5) & (time <= 0.503)))
        self.assertAlmostEqual(kleefsman2005.largest(kleefsman2005.impulses(spike)), 1e3, places=6)

    def test_a_late_arrival_is_found(self):
        self.assertAlmostEqual(self.score(late=0.02)["arrival P2"].value, 0.02, places=9)

    def test_a_short_run_is_scored_as_far_as_it_goes_and_without_bars_of_the_whole(self):
        metrics = self.score(end=1.0)
        self.assertIn("0..1 s", metrics["mean error H2"].what)
        self.assertEqual(metrics["mean error H2"].verdict, "")
        self.assertAlmostEqual(metrics["impulse P1"].value, 0, places=9)

    def test_water_that_leaves_over_the_rim_is_told_from_water_that_leaks(self):
        run = Run(write_run(self.folder))
        self.assertEqual(kleefsman2005.lost_through_walls(run), 0)  # nothing is outside, and no frame is read
        (self.folder / "summary.json").write_text('{"volume": {"outside_the_walls_end": 3}}')
        # 0.1 s after they passed y = 1 m: one 0.2 m above the rim, two below it; and one that was never out.
        height, velocity = np.array([1.2, 0.6, 0.7, 0.3]), np.array([[0.1, 1.0, 2.0]] * 4)
        position = np.column_stack([np.ones(4), [1.1, 1.1, 1.1, 0.5], height + 0.1 * 2.0 + 0.5 * 9.81 * 0.1**2])
        ids = np.arange(1, 5)
        for k, (out, there) in enumerate(((0.0, [0, 1, 2, 3]), (1.0, [0, 1, 2, 3]), (1.0, [1, 3]))):  # two fall below all walls
            synthetic_run.write_frame(self.folder / "fields" / f"fields_{k:05}.vtp", (position * [1, out or 0.5, 1])[there],
                                      velocity=velocity[there], id=ids[there])
        synthetic_run.write_series(self.folder, "fields", (0.9, 1.0, 1.1))
        self.assertEqual(kleefsman2005.lost_through_walls(Run(self.folder)), 2)

    def test_a_sensor_that_stays_dry_is_told(self):
        metrics = self.score(factor=0.0)
        self.assertIsNone(metrics["arrival P1"].value)
        self.assertIn("never exceeds", metrics["arrival P1"].note)
        with self.assertRaises(DataError):
            kleefsman2005.of_impact(kleefsman2005.laboratory(Run(self.folder), "P1").window(0, 0.9))

    def test_drawn(self):
        write_run(self.folder)
        self.assert_drawn(kleefsman2005)


if __name__ == "__main__":
    unittest.main()
