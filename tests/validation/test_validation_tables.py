"""The tables of results in the documents: their form, and that they are those of the file they were made from."""

import importlib.util
import json
import re
import subprocess
import sys
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "validation_tables.py"
specification = importlib.util.spec_from_file_location("validation_tables", SCRIPT)
validation_tables = importlib.util.module_from_spec(specification)
specification.loader.exec_module(validation_tables)


def metric(name, **changes):
    return {"name": name, "what": "error", "value": 0.12345, "unit": "H", "low": None, "high": 0.2, "verdict": "met",
            "paper": None, "peers": [], "variant": ""} | changes


PEERS = [{"name": "A", "range": [1, 2]}, {"name": "B", "range": [0.5, 0.5]}]
RESULT = {"level": "paper", "scheme": "", "commit": "abc", "date": "2026-11-21T08:00:00+00:00",
          "machine": {"processor": "a machine"}, "verdicts": {"met": 1, "missed": 2, "shown": 1},
          "studies": [{"name": "one", "title": "One", "metrics": [
              metric("one.a"), metric("one.b", what="late", value=None, verdict="missed", paper=9.24),
              metric("one.c", what="noisy", verdict="missed", peers=PEERS),
              metric("one.d", what="other", verdict="shown")]},
              {"name": "two", "title": "Two", "metrics": [metric("two.a", verdict="shown", variant="coarse")]}]}


class Table(unittest.TestCase):
    def test_of_all_has_what_has_a_target(self):
        text = validation_tables.table(RESULT, "all")
        self.assertIn("`tailwater validate --level paper`, 2026-11-21, a machine, commit abc:\n1 targets met, 2 missed.", text)
        self.assertIn("| **One** | | | | | |\n| error | 0.123 H | <= 0.2 | met |  |  |\n", text)
        self.assertIn("| late | - H | <= 0.2 | **missed** | 9.24 |  |", text)
        self.assertIn("| noisy | 0.123 H | <= 0.2 | **missed** |  | 0.5..2 (2 codes) |", text)
        for word in ("other |", "Two"):
            self.assertNotIn(word, text)

    def test_of_counts_is_a_sentence(self):
        self.assertIn("-->\n1 of 3 targets are met, 2 are missed.\n<!--", validation_tables.table(RESULT, "counts"))

    def test_of_a_study_without_targets_has_what_it_shows(self):
        text = validation_tables.table(RESULT, "two")
        self.assertIn("| **Two** | | | | | |\n| error, coarse | 0.123 H |  |  |  |  |\n", text)
        self.assertNotIn("One", text)
        self.assertNotIn("other |", validation_tables.table(RESULT, "one"))

    def test_of_metrics_has_them_in_the_order_named(self):
        text = validation_tables.table(RESULT, 'metrics "two.a" "one.d"')
        self.assertLess(text.index("**Two**"), text.index("**One**"))
        self.assertIn("| other | 0.123 H |", text)
        self.assertNotIn("noisy", text)

    def test_of_what_there_is_not_is_an_error(self):
        for what in ("three", 'metrics "one.e"', "one three"):
            with self.assertRaises(ValueError):
                validation_tables.table(RESULT, what)

    def test_replaces_only_itself(self):
        page = f"# Title\n<!-- validation: one -->\nold\n{validation_tables.END}\nrest\n"
        once = validation_tables.with_tables(page, RESULT)
        self.assertEqual(once, f"# Title\n{validation_tables.table(RESULT, 'one')}\nrest\n")
        self.assertEqual(validation_tables.with_tables(once, RESULT), once)
        self.assertEqual(validation_tables.with_tables("no marks", RESULT), "no marks")


class Documents(unittest.TestCase):
    def test_agree_with_the_file(self):
        check = subprocess.run([sys.executable, SCRIPT, "--check"], capture_output=True, text=True, check=False)
        self.assertEqual(check.returncode, 0, check.stdout + check.stderr)

    def test_readme_lists_every_missed_target(self):
        """Its list is written by hand: kinds of targets, each with the number of those missed."""
        readme = (SCRIPT.parents[1] / "README.md").read_text(encoding="utf-8")
        listed = [line for line in readme.partition("The misses:")[2].partition("<!--")[0].splitlines() if line.startswith("- ")]
        counts = [int(count) for line in listed for count in re.findall(r": (\d+)\b", line)]
        result = json.loads(validation_tables.KEPT.read_text(encoding="utf-8"))
        self.assertEqual(sum(counts), result["verdicts"]["missed"])


if __name__ == "__main__":
    unittest.main()
