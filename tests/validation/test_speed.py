"""The speed benchmark: results of runs and of Google Benchmark, fits, reports, and the command.

The command runs with a program that imitates Tailwater."""

import contextlib
import csv
import importlib.util
import io
import itertools
import json
import math
import sys
import tempfile
import unittest
import unittest.mock
from pathlib import Path

from fake_program import ProgramTest
from tailwater.errors import DataError
from tailwater_validation import speed, speed_profile, speed_report, speed_modules, speed_runs
from tailwater_validation.metric import Metric

PROVENANCE = {"version": "1", "commit": "abc", "compiler": "GNU 12", "options": "-O3", "libraries": "PETSc",
              "machine": {"name": "vm", "processor": "Fast", "cores": 2}}


def summary(steps, cpu, wall=1.0, iterations=0, memory=10.0, reached=0.5):
    return {**PROVENANCE, "particles": {"fluid": 100}, "steps": {"count": steps}, "time_s": {"reached": reached},
            "cost": {"cpu_s": cpu, "wall_clock_s": wall, "cpu_s_per_simulated_s": cpu / reached,
                     "peak_memory_bytes": memory},
            "pressure_solver": {"iterations": iterations}}


class Steps(unittest.TestCase):
    def test_exponent_of_a_power_law(self):
        sizes = [5e3, 2e4, 1e6]
        self.assertAlmostEqual(speed_runs.exponent(sizes, [3 * size**1.07 for size in sizes]), 1.07, places=12)

    def test_no_exponent_of_one_size_or_of_costs_that_are_not_positive(self):
        for sizes, costs in (([1e3], [1]), ([1e3, 1e3], [1, 2]), ([1e3, 2e3], [1, -1]), ([1e3, 2e3], [0, 1])):
            with self.subTest((sizes, costs)), self.assertRaises(DataError):
                speed_runs.exponent(sizes, costs)

    def test_start_and_end_of_runs_cancel(self):
        short, long = summary(5, 2.0 + 5 * 0.3, 4.0, 50, 7.0), summary(25, 2.0 + 25 * 0.3, 14.0, 250, 9.0)
        cost = speed_runs.difference(short, long)
        for value, expected in ((cost.cpu, 0.3), (cost.wall, 0.5), (cost.iterations, 10), (cost.memory, 9.0),
                                (cost.cpu_per_particle, 0.003)):
            self.assertAlmostEqual(value, expected, places=12)
        with self.assertRaises(DataError):
            speed_runs.difference(long, long)

    def test_columns_have_about_as_many_particles_as_asked_for(self):
        # Rounding to whole particles changes a side of n by half a particle at most.
        for level in speed.LEVELS.values():
            for sizes in (level.growth, level.modules, level.ranks):
                for dimension, numbers in sizes.items():
                    water = speed_runs.WATERS[dimension]
                    for particles in numbers if isinstance(numbers, tuple) else (numbers,):
                        cells = water.volume / water.spacing(particles)**dimension
                        self.assertAlmostEqual(cells / particles, 1, delta=1e-3 * dimension)

    def test_deep_and_shallow_columns_have_60_000_particles(self):
        for rows in (25, 100):
            water = speed_runs.box_of_rows(rows)
            self.assertAlmostEqual(water.spacing(6e4), 0.01, places=12)
            self.assertAlmostEqual(water.depth / 0.01, rows, places=9)


def google(*entries, **context):
    """Output in the format of Google Benchmark; an entry is (name, time, unit, counters)."""
    return {"context": {"provenance": json.dumps(PROVENANCE), **context},
            "benchmarks": [{"name": name, "run_name": f"{name}/manual_time", "run_type": "iteration", "real_time": took,
                            "time_unit": unit, **counters} for name, took, unit, counters in entries]}


class Rooms(unittest.TestCase):
    SIZES = {"fluid": "1000", "pairs": "25000", "bytes.all": "4e6", "bytes.pairs": "2e6", "bytes.pair_vectors": "1e6",
             "bytes.matrix": "3e5"}

    def test_the_shortest_repetition_counts_in_its_own_unit_and_aggregates_do_not(self):
        result = google(("a", 5.0, "us", {}), ("a", 4.0, "us", {}), ("b", 2.0, "ms", {}))
        result["benchmarks"].append({"name": "a_mean", "run_name": "a/manual_time", "run_type": "aggregate",
                                     "real_time": 1.0, "time_unit": "us"})
        found = speed_modules.times(result)
        self.assertEqual({name: round(seconds, 12) for name, (seconds, _) in found.items()}, {"a": 4e-6, "b": 2e-3})

    def test_an_error_of_a_benchmark_is_told(self):
        with self.assertRaisesRegex(DataError, "a: broke"):
            speed_modules.times(google(("a", 0.0, "us", {"error_occurred": True, "error_message": "broke"})))

    def test_solves_are_measured_in_products(self):
        result = google(("pressure/product", 100.0, "us", {"bytes": 4e5, "rows": 1000}),
                        ("pressure/cold", 6.0, "ms", {"iterations_of_solve": 12}), **self.SIZES)
        found = {metric.name: metric for metric in speed_modules.metrics_of("2D 1000", 2, result)}
        cold = found["modules.2D 1000.pressure/cold.products"]
        self.assertAlmostEqual(cold.value, 60, places=9)
        self.assertEqual(cold.verdict, "missed")
        for name, expected in (("pressure/cold.iterations", 12), ("pressure/product.bandwidth", 4), ("pairs", 25),
                               ("bytes.all", 4000), ("pressure/product", 100)):
            self.assertAlmostEqual(found[f"modules.2D 1000.{name}"].value, expected, places=9)

    def test_growth_of_what_all_sizes_have(self):
        results = [google(("a", size**1.2, "us", {}), *extra, fluid=str(size))
                   for size, extra in ((1000, (("b", 1.0, "us", {}),)), (8000, ()))]
        metrics = speed_modules.growth(3, results)
        self.assertEqual([metric.name for metric in metrics], ["modules.3D.a.exponent"])
        self.assertAlmostEqual(metrics[0].value, 1.2, places=9)

    def test_benchmarks_of_another_commit_are_refused(self):
        speed_modules.require_same_commit(google(), "abc")
        with self.assertRaisesRegex(DataError, "commit abc, the program at def"):
            speed_modules.require_same_commit(google(), "def")


class Profile(unittest.TestCase):
    def test_functions_by_name_and_libraries_as_a_whole(self):
        report = """
# Overhead|Shared Object|Symbol
    5.00%|tailwater |[.] tailwater::add_noise<3>(tailwater::Pairs<3> const&, double)
    4.00%|tailwater |[.] void tailwater::(anonymous namespace)::add_noise<2>
    2.00%|tailwater |[.] tailwater::Neighbourhood<3>::rebuild
   30.00%|libpetsc_real.so.3.18.5|[.] 0x0000000000923d27
   20.00%|libpetsc_real.so.3.18.5|[.] 0x0000000000923dcf
    1.50%|libc-2.36.so|[.] memset
    1.00%|[kernel.kallsyms]|[k] page_fault
"""
        self.assertEqual(speed_profile.shares(report), {"libpetsc_real": 50.0, "add_noise": 9.0,
                                                        "Neighbourhood::rebuild": 2.0, "libc": 1.5, "kernel": 1.0})


def result(commit="abc", **numbers):
    metrics = [Metric(name, f"what {name}", "s", "", high=1, value=value) for name, value in numbers.items()]
    return {**PROVENANCE, "commit": commit, "date": "now", "level": "quick", "settings": [], "load_before": 0.1,
            "interrupted": False,
            "numbers": [speed_report.record(metric) for metric in metrics]}


class Report(unittest.TestCase):
    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            speed_report.write(result(a=0.5, b=None), Path(folder))
            self.assertEqual(speed_report.read(Path(folder) / "speed.json"), result(a=0.5, b=None))
            with (Path(folder) / "speed.csv").open() as file:
                lines = list(csv.DictReader(file))
            self.assertEqual([(line["commit"], line["name"], line["value"]) for line in lines],
                             [("abc", "a", "0.5"), ("abc", "b", "")])
            text = (Path(folder) / "speed.md").read_text()
            self.assertIn("| what a | 0.5 | s | <= 1 | met |  |", text)
            self.assertIn("| what b | - | s | <= 1 | missed |  |", text)
            self.assertIn("commit abc", text)

    def test_ratios_of_what_both_have(self):
        old, new = result(a=2.0, b=1.0, c=0.0, d=None), result("def", a=1.0, c=1.0, d=1.0, e=5.0)
        new["machine"] = {**new["machine"], "processor": "Slow"}
        lines = speed_report.comparison(old, new).splitlines()
        self.assertEqual(lines[0].split(), ["what", "abc", "def", "ratio", "unit"])
        self.assertEqual([line.split() for line in lines[2:4]],
                         [["what", "a", "2", "1", "0.500", "s"], ["what", "c", "0", "1", "-", "s"]])
        self.assertTrue(lines[4].startswith("not the same machine"))
        self.assertEqual(len(lines), 5)

    def test_files_that_are_no_result_are_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "speed.json"
            for text, part in ((None, "No such file"), ("{", "is no JSON"), ('{"a": 1}', "is missing"),
                               ("[]", "bench")):
                if text is not None:
                    path.write_text(text)
                with self.subTest(text), self.assertRaisesRegex(DataError, part):
                    speed_report.read(path)


class Floor(unittest.TestCase):
    def setUp(self):
        path = Path(speed.__file__).resolve().parents[2] / "benchmarks" / "floor.py"
        spec = importlib.util.spec_from_file_location("floor", path)
        self.floor = importlib.util.module_from_spec(spec)
        sys.modules["floor"] = self.floor  # its dataclasses look themselves up there
        self.addCleanup(sys.modules.pop, "floor")
        spec.loader.exec_module(self.floor)

    def test_times_are_those_of_what_is_slower(self):
        for d in (2, 3):
            for row in self.floor.rows(d, 30, 8, 10.0, 1e15):
                self.assertAlmostEqual(row.now, row.now_bytes / 10, places=9)
            for row in self.floor.rows(d, 30, 8, 1e15, 5.0):
                self.assertAlmostEqual(row.best, row.best_operations / 5, places=9)

    def test_nothing_is_cheaper_now_than_at_best(self):
        for d in (2, 3):
            for iterations in (2, 12):
                for row in self.floor.rows(d, 30, iterations, 10.0, 20.0):
                    self.assertGreaterEqual(row.now_bytes, row.best_bytes, row.name)
                    self.assertGreaterEqual(row.now, row.best, row.name)

    def test_a_search_looks_at_the_cells_that_its_part_of_a_cell_can_reach(self):
        # Cells of a third of 3 dx hold a particle each. Distances are from the half of a cell that begins at 0.
        apart = [max(cell - 0.5, -(cell + 1), 0) for cell in range(-3, 4)]
        for d, pairs in {2: math.pi * 9, 3: 4 / 3 * math.pi * 27}.items():
            reached = [gaps for gaps in itertools.product(apart, repeat=d) if sum(gap**2 for gap in gaps) <= 9]
            self.assertAlmostEqual(self.floor.candidates(d) * pairs, len(reached), places=9)


class Command(ProgramTest):
    def setUp(self):
        super().setUp()
        self.copied = self.folder / "copied"
        self.copied.mkdir()
        self.leave(summary(50, 4.0, iterations=300, memory=5e5))
        self.fake(FAKE_RUN=str(self.copied))

    def leave(self, told):
        (self.copied / "summary.json").write_text(json.dumps(told))

    def bench(self, *arguments):
        return self.command(speed.main, "--level", "tiny", *arguments)

    def numbers(self):
        told = json.loads((self.folder / "out/speed.json").read_text())
        return {number["name"]: number for number in told["numbers"]}

    def test_whole_runs(self):
        code, out, err = self.bench("--part", "cases", "--set", "scheme.courant=0.1")
        self.assertEqual(code, 0, err)
        numbers = self.numbers()
        for name, expected in (("", 8.0), (".step", 1e6 * 4.0 / 50 / 100), (".steps", 100), (".iterations", 6),
                               (".memory", 5e3)):
            self.assertAlmostEqual(numbers[f"dam_break_3d.0.1.0.01{name}"]["value"], expected, places=9)
        self.assertIn("--set scheme.courant=0.1", out)
        self.assertIn("load", out)

    def test_a_run_that_fails_is_told_and_the_others_count(self):
        self.fake(FAKE_FAILS="dam_break_3d")
        code, out, _ = self.bench("--part", "cases")
        self.assertEqual(code, 3)
        self.assertIn("made to fail", out)
        numbers = self.numbers()
        self.assertIsNone(numbers["dam_break_3d.0.1.0.01"]["value"])
        self.assertEqual(numbers["zhou.0.06.0.2.explicit"]["value"], 8.0)

    def test_runs_that_do_not_differ_are_told(self):
        code, _, _ = self.bench("--part", "growth")
        self.assertEqual(code, 3)
        self.assertIn("the longer run has 50 steps", self.numbers()["step.2D.500"]["note"])

    def test_an_interrupted_bench_leaves_what_it_has(self):
        with unittest.mock.patch.object(speed.Bench, "growth", side_effect=KeyboardInterrupt):
            code, _, err = self.bench("--part", "cases", "--part", "growth")
        self.assertEqual(code, 130)
        self.assertIn("is written", err)
        self.assertEqual(self.numbers()["zhou.0.06.0.2.explicit"]["value"], 8.0)

    def test_modules_that_are_not_built(self):
        code, _, err = self.bench("--part", "cases", "--part", "modules")
        self.assertEqual(code, 2)
        self.assertIn("--target benchmarks", err)
        self.assertEqual(self.calls(), [])
        with contextlib.redirect_stderr(io.StringIO()) as told:
            parts = speed.choose_parts(speed.make_parser().parse_args(["--program", str(self.program)]))
        self.assertEqual(parts, ["cases", "growth", "deep", "ranks"])
        self.assertIn("left out", told.getvalue())

    def test_comparison(self):
        self.bench("--part", "cases")
        before = self.folder / "before.json"
        (self.folder / "out/speed.json").rename(before)
        self.leave(summary(50, 1.0, iterations=300, memory=5e5))
        code, out, _ = self.bench("--part", "cases", "--compare", str(before))
        self.assertEqual(code, 0)
        self.assertRegex(out, r"3D dam break, dx = 0\.1 m, first 0\.01 s +8 +2 +0\.250 +CPU s per simulated s")
        made = len(self.calls())
        code, out, _ = self.bench("--compare", str(before), str(before))
        self.assertEqual((code, len(self.calls())), (0, made))
        self.assertIn("1.000", out)

    def test_bad_input_is_refused_before_anything_is_measured(self):
        self.fake(FAKE_REFUSES="bogus")
        nothing = str(self.folder / "nothing.json")
        for arguments, part in ((("--part", "romos"), "parts: modules, cases"), (("--level", "some"), "quick"),
                                (("--compare", nothing), "No such file"),
                                (("--compare", nothing, nothing, nothing), "one file, or two"),
                                (("--bogus",), "--help"), (("--part", "cases", "--set", "bogus=1"), "not accepted")):
            with self.subTest(arguments):
                code, out, err = self.bench(*arguments)
                self.assertEqual((code, out), (2, ""))
                self.assertRegex(err, "(?m)^error: ")
                self.assertIn(part, err)
        self.assertFalse((self.folder / "out/speed.json").exists())


if __name__ == "__main__":
    unittest.main()
