"""The table of evidence: its results, the history of the targets, and the figures that pages take from it."""

import copy
import importlib.util
import json
import re
import tempfile
import unittest
from pathlib import Path

from tailwater.evidence import load_evidence
from tailwater.run import Run
from tailwater_validation import evidence
from tailwater_validation.case_values import friction_of_walls, read_case, water_height
from tailwater_validation.metric import Metric, result_of
from tailwater_validation.scatter import readings_table
from tailwater_validation.studies import studies
from tailwater_validation.study import CASES, AllChecks, Plan

ROOT = Path(__file__).resolve().parents[2]
specification = importlib.util.spec_from_file_location("evidence_script", ROOT / "scripts" / "evidence.py")
script = importlib.util.module_from_spec(specification)
specification.loader.exec_module(script)


class NotRun(Run):
    """A run that has left nothing but its case: metrics then have their targets and no values."""

    def __init__(self, run):
        self.path, self.case = Path("nowhere"), read_case(run.case, run.settings)
        self.case.setdefault("scheme", {}).setdefault("name", "farzin2014")
        for table in self.case.get("measurement", []):
            table["file"] = str(run.case.parent / table["file"])

    @property
    def summary(self):
        return {"time_s": {"reached": 6.0}}

    @property
    def spacing(self):
        return 0.01


def metrics_of_program():
    """Each metric of the tier paper, in the form of validation.json, without its value."""
    for study in studies(Plan("paper")).values():
        for check in study.checks:
            if isinstance(check, AllChecks):
                found = [(f"{check.name}.{metric.name}", metric, metric.what + check.suffix)
                         for metric in check.metrics(NotRun(check.runs[0])) if check.keep(metric.name)]
            else:
                found = [(check.metric.name, check.metric, check.metric.what)]
            for name, metric, what in found:
                yield {"name": name, "what": what, "low": metric.low, "high": metric.high, "reference": metric.against}


class Results(unittest.TestCase):
    def test_interval_decides(self):
        for value, half, expected in ((0.01, None, "met"), (0.03, None, "missed"), (0.01, 0.005, "met"), (0.03, 0.005, "missed"),
                                      (0.01, 0.02, "not resolved"), (0.03, 0.02, "not resolved"), (None, None, "missed"),
                                      (float("nan"), None, "missed")):
            self.assertEqual(result_of(value, None, 0.02, half), expected, (value, half))
        self.assertEqual(result_of(0.0, -0.01, 0.01, 0.005), "met")
        self.assertEqual(result_of(0.0, -0.01, 0.01, 0.02), "not resolved")
        self.assertEqual(result_of(1.0, 0.97, None, 0.01), "met")

    def test_verdict_is_of_the_value_alone(self):
        metric = Metric("a", "error", "", "theory", high=0.02, value=0.01, uncertainty=0.02)
        self.assertEqual([metric.verdict, metric.result], ["met", "not resolved"])
        self.assertEqual(Metric("a", "error", "", "theory", value=0.01).result, "")


class Targets(unittest.TestCase):
    def setUp(self):
        self.targets = evidence.read_targets()

    def test_program_has_the_last_entries(self):
        """A target that changes in the code needs an entry with date and reason."""
        records = list(metrics_of_program())
        self.assertGreater(sum(record["high"] is not None or record["low"] is not None for record in records), 100)
        self.assertEqual(evidence.changed_targets(records, self.targets), [])
        held = {record["name"] for record in records if record["high"] is not None or record["low"] is not None}
        ended = {key for key, entries in self.targets.items() if entries[-1].get("ended")}
        self.assertEqual(set(self.targets) - held, ended)

    def test_stored_results_have_the_last_entries(self):
        stored = json.loads((ROOT / "docs" / "validation.json").read_text(encoding="utf-8"))
        metrics = [metric for study in stored["studies"] for metric in study["metrics"]]
        self.assertEqual(evidence.changed_targets(metrics, self.targets), [])

    def test_changed_target_is_found(self):
        record = next(record for record in metrics_of_program() if record["name"] == "zhou1999.noise")
        self.assertEqual(evidence.changed_targets([record], self.targets), [])
        for change in ({"high": 0.007}, {"low": 0.0}, {"what": "noise at another height"}, {"reference": "another"}):
            self.assertEqual(len(evidence.changed_targets([record | change], self.targets)), 1, change)
        self.assertEqual(evidence.changed_targets([record | {"name": "zhou1999.new"}], self.targets),
                         ["zhou1999.new: has a target and no entry"])

    def test_incomplete_entries_are_refused(self):
        good = '[["a"]]\ndate = 2026-11-21\nhigh = 1\nquantity = "q"\nagainst = "r"\nreason = "s"\n'
        for text in (good.replace('reason = "s"\n', ""), good.replace("high = 1\n", ""),
                     good + good.replace("2026-11-21", "2026-11-20")):
            path = Path(self.enterContext(tempfile.TemporaryDirectory())) / "targets.toml"
            path.write_text(text, encoding="utf-8")
            with self.assertRaises(ValueError):
                evidence.read_targets(path)


class Cases(unittest.TestCase):
    def test_water_height(self):
        self.assertAlmostEqual(water_height(CASES / "zhou1999/case.toml", (), 0.01), 0.6)
        self.assertAlmostEqual(water_height(CASES / "flume/weir.toml", ("parameters.h=0.1",), 0.01), 0.3)
        self.assertAlmostEqual(water_height(CASES / "kleefsman2005/case.toml", (), 0.03), 0.55)

    def test_friction_of_walls(self):
        self.assertEqual(friction_of_walls(CASES / "zhou1999/case.toml", ("wall.tank.slip=free",)), "free")
        self.assertEqual(friction_of_walls(CASES / "ozmen_cagatay2014/case.toml", ()), "rough")


class Evidence(unittest.TestCase):
    def test_file_and_pages_agree(self):
        self.assertEqual(script.main(["--check"]), 0)

    def test_rows(self):
        found = load_evidence()
        self.assertEqual(len({row["key"] for row in found["rows"]}), len(found["rows"]))
        self.assertEqual(sum(found["counts"].values()), sum(bool(row["target"]) and row["result"] != evidence.NO_TARGET
                                                            for row in found["rows"]))
        for row in found["rows"]:
            self.assertIn(row["result"], {*found["counts"], evidence.NO_TARGET})
            self.assertEqual("one spacing" in row["spacing_text"], 0 < row["spacings"] < 3)
            if row["uncertainty"] is not None:
                self.assertGreater(row["spacings"], 2, row["key"])
        titles = {flow["name"] for flow in found["flows"]}
        self.assertIn("weir", titles)

    def test_number_that_lost_its_target_has_the_reason(self):
        row = next(row for row in load_evidence()["rows"] if row["key"] == "weir.coefficient_error")
        self.assertEqual([row["result"], row["target"]], [evidence.NO_TARGET, ""])
        self.assertIn("surface tension", row["note"])

    def test_target_without_a_stored_result_is_shown(self):
        stored = json.loads((ROOT / "docs" / "validation.json").read_text(encoding="utf-8"))
        fewer = copy.deepcopy(stored)
        fewer["studies"] = [study for study in stored["studies"] if study["name"] != "jet"]
        rows = {row["key"]: row for row in evidence.evidence_of(fewer, evidence.read_targets())["rows"]}
        self.assertEqual([rows["jet.pressure_error"][name] for name in ("value", "result")], [None, "not run"])

    def test_stored_result_with_another_target_is_refused(self):
        stored = json.loads((ROOT / "docs" / "validation.json").read_text(encoding="utf-8"))
        stored["studies"][0]["metrics"][0]["high"] = 1.0
        with self.assertRaisesRegex(ValueError, "zhou1999.H1.T6: the target is .*remedy"):
            evidence.evidence_of(stored, evidence.read_targets())


class Readings(unittest.TestCase):
    def table_of(self, value, uncertainty):
        metric = {"name": "a.depth", "what": "depth", "value": value, "unit": "m", "low": None, "high": 0.3, "verdict": "met",
                  "uncertainty": uncertainty}
        study = {"title": "Flow: Author (1999)", "metrics": [metric]}
        return readings_table([study], {"a.depth": {"high": 0.1, "source": "two readings differ"}})

    def test_interval_that_reaches_into_the_scatter_is_within(self):
        for value, uncertainty, within, count in ((0.09, None, "yes", 1), (0.15, None, "**no**", 0), (0.15, 0.06, "yes", 1)):
            lines = self.table_of(value, uncertainty)
            self.assertTrue(lines[0].startswith(f"{count} of 1 readings"), lines[0])
            self.assertIn("1 of the 1 that have a target meet it", lines[0])
            self.assertIn(f"| {within} |", lines[-1])

    def test_entries_must_have_a_stored_result(self):
        with self.assertRaisesRegex(ValueError, "no stored result has the name b"):
            readings_table([], {"b": {"high": 1.0, "source": "somewhere"}})


class Pages(unittest.TestCase):
    def test_readme_lists_every_missed_target(self):
        """Its list is written by hand: kinds of targets, each with the number of those missed."""
        readme = (ROOT / "README.md").read_text(encoding="utf-8")
        listed = [line for line in readme.partition("The misses:")[2].partition("<!--")[0].splitlines() if line.startswith("- ")]
        counts = [int(count) for line in listed for count in re.findall(r"(?:^- |, )(\d+) (?:in|for) ", line)]
        self.assertEqual(sum(counts), load_evidence()["counts"]["missed"])

    def setUp(self):
        self.evidence = load_evidence()

    def test_figure_is_filled_and_contradicted(self):
        page = "noise <!-- figure: zhou1999.noise -->?<!-- figure: end --> of it"
        value = self.evidence["figures"]["zhou1999.noise"]
        whole = script.filled(page, self.evidence)
        self.assertIn(f"-->{value}<!--", whole)
        self.assertEqual(script.contradictions(whole, self.evidence), [])
        self.assertEqual(script.contradictions(whole.replace(value, "0.001 rho g H"), self.evidence),
                         [f'zhou1999.noise: the page has "0.001 rho g H", the evidence {value}'])

    def test_figure_that_the_evidence_lacks(self):
        page = "<!-- figure: zhou1999.none -->1<!-- figure: end -->"
        self.assertEqual(script.contradictions(page, self.evidence),
                         ['zhou1999.none: the page has "1", the evidence no such key'])
        with self.assertRaises(ValueError):
            script.filled(page, self.evidence)

    def test_tables(self):
        for what in ("all", "zhou1999 weir", "short weir", 'keys "zhou1999.noise" "weir.ideal_error"', "counts"):
            page = script.filled(f"before\n<!-- evidence: {what} -->\n<!-- evidence: end -->\nafter\n", self.evidence)
            self.assertEqual(script.contradictions(page, self.evidence), [], what)
            self.assertEqual(len(script.contradictions(page.replace("resolved", "resoled"), self.evidence)), 1, what)
        self.assertEqual(script.contradictions("<!-- evidence: nothing -->\n<!-- evidence: end -->", self.evidence),
                         ["the evidence has no nothing"])

    def test_short_table_has_five_columns(self):
        line = next(line for line in script.table(self.evidence, "short jet").splitlines() if "stagnation" in line)
        row = next(row for row in self.evidence["rows"] if row["flow"] == "jet" and "stagnation" in row["what"])
        self.assertEqual([cell.strip() for cell in line.split("|")][2:5], [row["value_text"], row["target"], row["result"]])
        self.assertEqual(line.count("|"), 6)

    def test_only_the_table_of_all_names_the_commit(self):
        commit = self.evidence["commit"]
        self.assertIn(commit, script.table(self.evidence, "all"))
        self.assertNotIn(commit, script.table(self.evidence, "weir"))


if __name__ == "__main__":
    unittest.main()
