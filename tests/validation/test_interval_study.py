"""The command line of scripts/interval_study.py."""

import contextlib
import importlib.util
import io
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts/interval_study.py"
SPEC = importlib.util.spec_from_file_location("interval_study", SCRIPT)
interval_study = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(interval_study)


class CommandLine(unittest.TestCase):
    def test_options_stand_anywhere(self):
        for words in ("DIR --jobs 1 ogee weir", "--jobs 1 DIR ogee weir", "DIR ogee weir --jobs 1"):
            options = interval_study.options_of(words.split())
            self.assertEqual((str(options.out), options.names, options.jobs), ("DIR", ["ogee", "weir"], 1), words)
        self.assertEqual(interval_study.options_of(["DIR"]).names, list(interval_study.FLOWS))

    def test_flow_that_there_is_not(self):
        told = io.StringIO()
        with self.assertRaises(SystemExit), contextlib.redirect_stderr(told):
            interval_study.options_of(["DIR", "oge"])
        self.assertIn("they are poiseuille, ", told.getvalue())


if __name__ == "__main__":
    unittest.main()
