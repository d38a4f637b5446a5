"""Results that depend on the end of the run, from made-up readings."""

import json
import shutil
import unittest
from pathlib import Path

import made_up_means
import numpy as np
import tailwater as tw
from small import PackageTest
from tailwater.finite_time import error_of_time_mean
from tailwater.readings import EXTREMES, MEANS, RATES, error_of_mean, rise_at_end
from test_report import make_study, summary

TIME = np.linspace(0, 2, 201)


def make_readings(folder, results, columns):
    """A study whose runs have these results of the probe "depth" and these columns of its table."""
    shutil.rmtree(folder, ignore_errors=True)
    told = {"results": {"depth": {"type": "depth", "words": "", "quantities": results}},
            "time_s": {"end": 2, "reached": 2}}
    make_study(folder, {spacing: told for spacing in (0.1, 0.125, 0.16)})
    for path in Path(folder).glob("spacings/*"):
        Path(path, "probes").mkdir()
        table = np.column_stack([TIME, *columns.values()])
        rows = "\n".join(",".join(f"{number:.9g}" for number in row) for row in table)
        Path(path, "probes/depth.csv").write_text(f"time_s,{','.join(columns)}\n{rows}\n", encoding="utf-8")


class Means(PackageTest):
    def answer(self, readings):
        second = TIME >= 1
        mean = float(np.trapz(readings[second], TIME[second]))
        make_readings("s", [{"name": "depth", "value": mean, "unit": "m", "what": "mean of the second half"}],
                      {"connected_m": readings})
        return tw.report("s", pictures=0).content["answer"]

    def test_oscillation_widens_the_interval(self):
        for period in (0.5, 0.8, 1.3, 1.6):
            row = self.answer(0.4 + 0.05 * np.sin(2 * np.pi * TIME / period))
            self.assertTrue(row["low"] < 0.4 < row["high"], row)

    def test_drift_widens_the_interval_beyond_its_end(self):
        row = self.answer(0.4 + 0.001 * TIME)
        self.assertTrue(row["low"] < 0.401 and row["high"] > 0.4025)
        row = self.answer(0.4 - 0.1 * np.exp(-TIME / 0.8))  # which is still 0.0082 below its limit at the end
        self.assertTrue(row["low"] < 0.4 < row["high"], row)

    def test_whole_period_averages_out(self):
        row = self.answer(0.4 + 0.05 * np.sin(2 * np.pi * TIME))
        self.assertLess(row["averaging"], 0.001)

    def test_fast_oscillation_and_noise_average_out(self):
        noise = 0.001 * np.random.default_rng(1).normal(size=TIME.size)
        row = self.answer(0.4 + 0.05 * np.sin(40 * np.pi * TIME) + noise)
        self.assertTrue(0 < row["averaging"] < 0.001)

    def test_rate_of_change(self):
        make_readings("s", [], {"volume_m3": 3 * TIME + 0.01 * np.sin(9 * TIME)})
        run = tw.Run(next(Path("s").glob("spacings/*")))
        told = json.loads(Path(run.path, "summary.json").read_text(encoding="utf-8"))
        told["results"]["depth"]["type"] = "discharge"
        Path(run.path, "summary.json").write_text(json.dumps(told), encoding="utf-8")
        # The mean rate of the oscillation, of 1.4 periods, is 0.01 (sin 18 - sin 9) = -0.0116.
        self.assertTrue(0.0116 < error_of_mean(run, "depth", "discharge") < 0.02)
        self.assertTrue(np.isnan(error_of_mean(run, "depth", "largest discharge")))

    def test_columns_are_those_of_the_reference(self):
        page = (Path(__file__).resolve().parents[2] / "docs/reference/probes.md").read_text(encoding="utf-8")
        means = {line.split("|")[1].strip() for line in page.splitlines()
                 if line.startswith("|") and line.endswith("over the second half of the run |")}
        self.assertEqual(means, {name for table in (MEANS, RATES) for names in table.values() for name in names})
        for kind, names in [*MEANS.items(), *RATES.items()]:
            section = page.partition(f"\n## {kind}\n")[2].partition("\n## ")[0]
            for name, column in names.items():
                self.assertIn(f"| {name} | `{column}` |", section)


class LongTimeMeans(unittest.TestCase):
    def test_intervals_contain_them(self):
        for name in ("noise, 0.01", "noise, 0.1", "sine, 0.5 to 1 period", "sine, 1 to 4 periods", "approach, 0.5", "approach, 1",
                     "approach, 0.3, and 0.3 sine, 1.5"):
            inside, _, _ = made_up_means.shares(made_up_means.SIGNALS[name], made_up_means.of_models, 60)
            self.assertGreaterEqual(inside, 0.9, name)

    def test_oscillations_average_out(self):
        for name, largest in (("sine, 1 period", 0.02), ("sine, 1.5 periods", 0.25), ("sine, 10 periods", 0.02)):
            _, width, _ = made_up_means.shares(made_up_means.SIGNALS[name], made_up_means.of_models, 20)
            self.assertLess(width, largest, name)

    def test_few_readings(self):
        for count in range(10, 13):
            width = error_of_time_mean(np.random.default_rng(count).normal(size=count))
            self.assertTrue(1 / np.sqrt(count) < width < 3, width)
        self.assertEqual(error_of_time_mean(np.ones(20)), 0)


class Extremes(PackageTest):
    def first_line(self, readings):
        largest = {"name": "highest water", "value": float(readings.max()), "unit": "m",
                   "what": f"at {TIME[readings.argmax()]:.4g} s"}
        make_readings("s", [largest], {"highest_m": readings})
        return tw.report("s", pictures=0).first_line

    def test_value_that_still_rises_cannot_be_relied_on(self):
        line = self.first_line(0.2 + 0.1 * TIME**2)
        self.assertIn("relied on: the answer was still rising at the end of the run (the last reading is 19 % of the "
                      "range beyond the others; remedy: a later time.end) at the spacing 0.1, 0.125, 0.16 m", line)

    def test_completed_peak_and_steady_readings_can_be_relied_on(self):
        noise = 0.001 * np.random.default_rng(1).normal(size=TIME.size)
        for readings in (0.3 - (TIME - 1.9)**2, 0.3 + noise, 0.3 * (1 - np.exp(-3 * TIME)) + noise):
            self.assertNotIn("still rising", self.first_line(readings))

    def test_last_reading_that_is_the_largest_in_one_run_only(self):
        make_readings("s", summary()["results"]["depth"]["quantities"], {"connected_m": 0.3 + 0 * TIME})
        results = {"depth": {"type": "depth", "words": "", "quantities": [
            {"name": "highest water", "value": 0.3, "unit": "m", "what": "at 2 s"}]}}
        for path in Path("s").glob("spacings/*"):
            told = json.loads(Path(path, "summary.json").read_text(encoding="utf-8"))
            Path(path, "summary.json").write_text(json.dumps(told | {"results": results}), encoding="utf-8")
            end = 1 if path.name.endswith("0.125") else -1
            readings = 0.3 + 0.1 * np.sin(9 * TIME) + np.where(TIME == 2, end, 0)
            table = "".join(f"{time},{value}\n" for time, value in zip(TIME, readings))
            Path(path, "probes/depth.csv").write_text("time_s,highest_m\n" + table, encoding="utf-8")
        self.assertTrue(tw.report("s", pictures=0).is_reliable)

    def test_least_value_that_still_falls(self):
        make_readings("s", [], {"displacement_x_m": -TIME})
        run = tw.Run(next(Path("s").glob("spacings/*")))
        told = json.loads(Path(run.path, "summary.json").read_text(encoding="utf-8"))
        told["results"]["depth"]["type"] = "motion"
        Path(run.path, "summary.json").write_text(json.dumps(told), encoding="utf-8")
        self.assertAlmostEqual(rise_at_end(run, "depth", "least displacement x"), -0.1)
        self.assertEqual(rise_at_end(run, "depth", "largest displacement x"), 0)

    def test_moment_that_still_grows(self):
        make_readings("s", [], {"force_x_N_per_m": 1 + 0 * TIME, "moment_N_m_per_m": -TIME})
        run = tw.Run(next(Path("s").glob("spacings/*")))
        told = json.loads(Path(run.path, "summary.json").read_text(encoding="utf-8"))
        told["results"]["depth"]["type"] = "force"
        Path(run.path, "summary.json").write_text(json.dumps(told), encoding="utf-8")
        self.assertAlmostEqual(rise_at_end(run, "depth", "largest moment"), 0.1)
        self.assertEqual(rise_at_end(run, "depth", "largest force"), 0)
        self.assertGreater(error_of_mean(run, "depth", "moment"), 0.5)

    def test_columns_are_those_of_the_reference(self):
        page = (Path(__file__).resolve().parents[2] / "docs/reference/probes.md").read_text(encoding="utf-8")
        for quantity, column in EXTREMES.items():
            found = column.replace("magnitude of force", "force_x").replace("magnitude of ", "")
            self.assertIn(f"| {quantity} | `{found}` |",
                          page.replace("| pressure | `pressure` |", "| least pressure | `pressure` |"))


if __name__ == "__main__":
    unittest.main()
