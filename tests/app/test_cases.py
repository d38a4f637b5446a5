"""The cases that come with the program."""

import json
import unittest
from pathlib import Path

from program import ProgramTest

ROOT = Path(__file__).resolve().parents[2]


class Cases(ProgramTest):
    def test_check_finds_no_error_in_any_case(self):
        cases = sorted((ROOT / "cases").glob("*/*.toml"))
        self.assertGreater(len(cases), 60)
        for case in cases:
            with self.subTest(str(case.relative_to(ROOT))):
                found = json.loads(self.call("check", "--json", case).stdout)["findings"]
                self.assertEqual([finding for finding in found if finding["severity"] == "error"], [])


if __name__ == "__main__":
    unittest.main()
