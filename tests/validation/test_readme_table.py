"""The README's validation table: its form, and that it is the one of the file it was made from."""

import importlib.util
import subprocess
import sys
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "readme_table.py"
specification = importlib.util.spec_from_file_location("readme_table", SCRIPT)
readme_table = importlib.util.module_from_spec(specification)
specification.loader.exec_module(readme_table)


def metric(**changes):
    return {"what": "error", "value": 0.12345, "unit": "H", "low": None, "high": 0.2, "verdict": "met", "paper": None,
            "peers": []} | changes


RESULT = {"level": "paper", "scheme": "", "commit": "abc", "date": "2026-11-21T08:00:00+00:00",
          "machine": {"processor": "a machine"}, "verdicts": {"met": 1, "missed": 2, "shown": 1},
          "studies": [{"title": "One", "metrics": [
              metric(), metric(what="late", value=None, verdict="missed", paper=9.24),
              metric(what="noisy", verdict="missed", peers=[{"name": "A", "range": [1, 2]}, {"name": "B", "range": [0.5, 0.5]}]),
              metric(what="other", verdict="shown")]}, {"title": "Two", "metrics": [metric(verdict="shown")]}]}


class Table(unittest.TestCase):
    def test_has_what_has_a_target(self):
        text = readme_table.table(RESULT)
        self.assertIn("Level `paper`, commit abc, 2026-11-21, a machine: 1 targets met, 2 missed.", text)
        self.assertIn("| **One** | | | | | |\n| error | 0.123 H | <= 0.2 | met |  |  |\n", text)
        self.assertIn("| late | - H | <= 0.2 | **missed** | 9.24 |  |", text)
        self.assertIn("| noisy | 0.123 H | <= 0.2 | **missed** |  | 0.5..2 (2 codes) |", text)
        for word in ("other |", "Two"):
            self.assertNotIn(word, text)

    def test_replaces_only_itself(self):
        text = readme_table.table(RESULT)
        readme = f"# Title\n{readme_table.BEGIN}\nold\n{readme_table.END}\nrest\n"
        once = readme_table.with_table(readme, text)
        self.assertEqual(once, f"# Title\n{text}\nrest\n")
        self.assertEqual(readme_table.with_table(once, text), once)
        with self.assertRaises(ValueError):
            readme_table.with_table("no marks", text)


class Readme(unittest.TestCase):
    def test_agrees_with_its_file(self):
        check = subprocess.run([sys.executable, SCRIPT, "--check"], capture_output=True, text=True, check=False)
        self.assertEqual(check.returncode, 0, check.stdout + check.stderr)


if __name__ == "__main__":
    unittest.main()
