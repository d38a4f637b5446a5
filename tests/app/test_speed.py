"""`tailwater bench speed` at its smallest level: its cases run, and all that is promised is measured."""

import json
import unittest

import program


class Speed(program.ProgramTest):
    def test_cases_and_growth(self):
        self.call("bench", "speed", "--level", "tiny", "--part", "cases", "--part", "growth")
        told = json.loads((self.folder / "speed/speed.json").read_text())
        self.assertTrue(told["commit"] and told["compiler"] and told["machine"]["processor"])
        values = {number["name"]: number["value"] for number in told["numbers"]}
        for name in ("zhou.0.06.0.2.explicit", "zhou.0.06.0.2.implicit.iterations", "dam_break_3d.0.1.0.01.step",
                     "step.2D.500", "step.2D.1000.memory"):
            self.assertGreater(values[name], 0, name)


if __name__ == "__main__":
    unittest.main()
