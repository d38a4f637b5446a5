"""Made-up gauges of cases/beji_battjes1993: the laboratory's harmonics at another time, with one known error."""

import tempfile
import unittest
from pathlib import Path

import numpy as np

from tailwater.run import Run
from tailwater_validation import beji_battjes

PERIOD, HEIGHT, END, SHIFT = 2.02, 0.02, 10.0, 0.37


class BejiBattjes(unittest.TestCase):
    def test_a_second_harmonic_that_is_a_tenth_too_high_is_reported_at_its_gauge(self):
        measured = beji_battjes.measured_records(beji_battjes.DATA)
        self.assertEqual(len(measured), 11)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = Path(folder.name)
        (path / "probes").mkdir()
        tables, second = "", 0.0
        t = np.arange(0, END + 0.05, 0.01)
        for n, (x, record) in enumerate(measured.items()):
            amplitude = beji_battjes.amplitudes(*record, PERIOD)
            if x == 19.0:
                amplitude[1] *= 1.1
                second = abs(amplitude[1]) / 1.1
            level = 0.4 + sum((a * np.exp(2j * np.pi * k * (t + SHIFT) / PERIOD)).real for k, a in enumerate(amplitude, start=1))
            (path / "probes" / f"g{n}.csv").write_text("time_s,highest_m\n" + "".join(
                f"{time:.9g},{value:.9g}\n" for time, value in zip(t, level)))
            tables += f'[[probe]]\nname = "g{n}"\ntype = "depth"\nat = [{x}, 0.0]\n'
        (path / "case.effective.toml").write_text(f"[case]\ndimension = 2\n[parameters]\nT = {PERIOD}\nH = {HEIGHT}\n[time]\nend = {END}\n"
                                                  + tables)
        found = beji_battjes.beji_battjes(Run(path))
        wrong = found["gauges"]["x19"]
        self.assertAlmostEqual(wrong["rms_over_H"], 0.1 * second / 2**0.5 / HEIGHT, delta=1e-4)
        self.assertAlmostEqual(wrong["harmonics"][1], 0.1 * second / max(wrong["measured_mm"]) * 1e3, delta=1e-3)
        self.assertAlmostEqual(found["largest_rms_over_H"], wrong["rms_over_H"])
        self.assertAlmostEqual(found["largest_error_of_harmonics_behind"], wrong["harmonics"][1])
        self.assertLess(found["gauges"]["x4"]["rms_over_H"], 1e-4)

    def test_the_data_say_where_they_come_from(self):
        for path in beji_battjes.DATA.glob("*.csv"):
            for word in ("# WHAT:", "# PAPER:", "# SOURCE:", "# CAVEATS:", "# ADDED:"):
                self.assertIn(word, path.read_text(encoding="utf-8"))


if __name__ == "__main__":
    unittest.main()
