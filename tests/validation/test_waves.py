"""Gauges over made-up waves of which everything is known."""

import tempfile
import unittest
from pathlib import Path

import numpy as np

from tailwater import wave_records, waves
from tailwater.errors import DataError
from tailwater.run import Run

DEPTH = 0.4
GRAVITY = 9.81
PERIOD = 1.25
PLACES = {"g1": 3.0, "g2": 3.2, "g3": 3.55}


def elevation(x, t, components):
    """Sum of waves (height, period, direction, phase)."""
    total = np.zeros_like(t)
    for height, period, direction, phase in components:
        k = waves.wave_numbers(1 / period, DEPTH, GRAVITY)
        total += 0.5 * height * np.cos(2 * np.pi * t / period - direction * k * x + phase)
    return total


class WaveGauges(unittest.TestCase):
    def run_with(self, components, places=None, end=20.0, drift=0.0):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = Path(folder.name)
        (path / "probes").mkdir()
        places = places or PLACES
        probes = "".join(f'[[probe]]\nname = "{name}"\ntype = "depth"\nat = [{x}, 0.0]\n' for name, x in places.items())
        (path / "case.effective.toml").write_text(
            f"[case]\ndimension = 2\n[physics]\ngravity = [0.0, -{GRAVITY}]\n{probes}")
        rng = np.random.default_rng(1)
        for name, x in places.items():
            t = np.cumsum(rng.uniform(0.004, 0.008, int(end / 0.006)))  # steps as uneven as a run's
            depth = DEPTH + elevation(x, t, components) + drift * (t - 0.5 * end)
            (path / "probes" / f"{name}.csv").write_text("time_s,highest_m\n" + "".join(
                f"{time:.9g},{value:.9g}\n" for time, value in zip(t, depth)))
        return Run(path)

    def test_the_wave_number_solves_the_dispersion_relation(self):
        k = waves.wave_numbers([0.1, 0.8, 3.0], DEPTH, GRAVITY)
        np.testing.assert_allclose(GRAVITY * k * np.tanh(k * DEPTH), (2 * np.pi * np.array([0.1, 0.8, 3.0])) ** 2, rtol=1e-12)

    def test_a_trend_of_the_level_is_removed_and_noted(self):
        components = [(0.04, PERIOD, 1, 0.3), (0.012, PERIOD, -1, 1.0)]
        still, _ = waves.analyse(self.run_with(components, end=40.0))
        self.assertNotIn("notes", still)
        for drift in (0.001, -0.002):
            numbers, _ = waves.analyse(self.run_with(components, end=40.0, drift=drift))
            self.assertIn("the mean level has a trend", numbers["notes"][0])
            for part, name in (("separation", "Hm0_there_m"), ("separation", "Hm0_back_m"), ("regular", "H_there_m")):
                self.assertAlmostEqual(numbers[part][name] / still[part][name], 1, delta=5e-3)
            self.assertEqual(numbers["separation"]["runs"], "towards the last gauge")
            for name in PLACES:
                self.assertAlmostEqual(numbers["gauges"][name]["trend_m_per_s"], drift, delta=0.01 * abs(drift))
                self.assertAlmostEqual(numbers["gauges"][name]["Hm0_m"], still["gauges"][name]["Hm0_m"], delta=5e-4)

    def test_a_period_that_is_not_that_of_the_record_is_noted(self):
        run = self.run_with([(0.05, PERIOD, 1, 0.3)])
        self.assertNotIn("notes", waves.analyse(run, period=PERIOD)[0])
        numbers, _ = waves.analyse(run, period=1.1 * PERIOD)
        self.assertRegex(numbers["notes"][0], "harmonics of the period 1.375 s leave .* mean period is 1.25 s: the waves are")
        self.assertIn("note: harmonics of the period 1.375 s", waves.report(numbers))

    def test_regular_waves_have_their_height_and_period(self):
        numbers, spectra = waves.analyse(self.run_with([(0.05, PERIOD, 1, 0.3)]))
        for gauge in numbers["gauges"].values():
            # Heights between samples 0.006 s apart err by (omega dt)^2/8 each way; lines of 9 digits.
            for key in ("H_mean_m", "H_third_m", "H_max_m"):
                self.assertAlmostEqual(gauge[key], 0.05, delta=0.05 * 2e-3)
            self.assertAlmostEqual(gauge["T_mean_s"], PERIOD, delta=1e-3)
            self.assertAlmostEqual(gauge["T_peak_s"], PERIOD, delta=0.02)
            self.assertAlmostEqual(gauge["depth_m"], DEPTH, delta=1e-4)
            # 4 rms of a sine is sqrt(2) times its height.
            self.assertAlmostEqual(gauge["Hm0_m"], 2**0.5 * 0.05, delta=1e-3 * 0.05)
        self.assertLess(numbers["separation"]["reflection"], 0.01)
        self.assertEqual(numbers["separation"]["runs"], "towards the last gauge")
        self.assertEqual(len(spectra), 4)

    def test_waves_and_reflected_waves_are_told_apart(self):
        for direction, runs in ((1, "towards the last gauge"), (-1, "towards the first gauge")):
            found = waves.analyse(self.run_with([(0.05, PERIOD, direction, 0.3), (0.015, PERIOD, -direction, 1.1)]))
            self.assertAlmostEqual(found[0]["separation"]["reflection"], 0.3, delta=0.01)
            self.assertEqual(found[0]["separation"]["runs"], runs)

    def test_of_irregular_waves_too(self):
        rng = np.random.default_rng(2)
        there = [(0.01, period, 1, phase) for period, phase in zip(rng.uniform(1.0, 1.6, 30), rng.uniform(0, 6.28, 30))]
        back = [(0.2 * height, period, -1, phase + 2) for height, period, _, phase in there]
        numbers, _ = waves.analyse(self.run_with(there + back, end=200.0))
        self.assertAlmostEqual(numbers["separation"]["reflection"], 0.2, delta=0.03)

    def test_gauges_over_an_uneven_bed_do_not_separate_waves(self):
        run = self.run_with([(0.05, PERIOD, 1, 0.3)])
        table = run.path / "probes" / "g3.csv"
        lines = table.read_text().splitlines()
        table.write_text("\n".join([lines[0]] + [f"{t},{float(z) - 0.2 * DEPTH:.9g}" for t, z in
                                                 (line.split(",") for line in lines[1:])]) + "\n")
        numbers, _ = waves.analyse(run)
        self.assertNotIn("separation", numbers)
        self.assertIn("over depths from 0.32 to 0.4 m", waves.report(numbers))
        self.assertIn("separation", waves.analyse(run, depth=DEPTH)[0])

    def test_gauges_that_cannot_tell_are_refused(self):
        half = np.pi / waves.wave_numbers(1 / PERIOD, DEPTH, GRAVITY)
        run = self.run_with([(0.05, PERIOD, 1, 0)], places={"a": 1.0, "b": 1.0 + half, "c": 1.0 + 2 * half})
        with self.assertRaisesRegex(DataError, "half a wavelength apart"):
            waves.analyse(run)

    def test_a_solitary_wave_has_its_height_and_speed(self):
        run = self.run_with([])
        height, speed = 0.08, 1.7
        for name, x in PLACES.items():
            t = np.arange(0.0, 8.0, 0.005)
            eta = height / np.cosh(3.0 * (speed * (t - 1.0) - x)) ** 2
            (run.path / "probes" / f"{name}.csv").write_text("time_s,highest_m\n" + "".join(
                f"{time:.9g},{DEPTH + value:.9g}\n" for time, value in zip(t, eta)))
        found = waves.solitary(run)
        self.assertAlmostEqual(found["speed_m_per_s"], speed, delta=1e-3 * speed)
        for gauge in found["gauges"].values():
            self.assertAlmostEqual(gauge["height_m"], height, delta=2e-3 * height)
        # Fenton's third order: 1.2 - 0.002 - 0.000343 of g h.
        self.assertAlmostEqual(found["theory_m_per_s"], (GRAVITY * DEPTH * 1.19766) ** 0.5, delta=1e-3)

    def add_probe(self, run, text, name, columns, series):
        """A further probe of a made-up run."""
        effective = run.path / "case.effective.toml"
        effective.write_text(effective.read_text() + text)
        (run.path / "probes" / f"{name}.csv").write_text(f"time_s,{columns}\n" + "".join(
            ",".join(f"{value:.9g}" for value in row) + "\n" for row in zip(*series)))
        return Run(run.path)

    def test_a_high_standing_wave_has_its_own_wavelength(self):
        position, depth, k = np.array([0.0, 3.86, 9.65]), 5.0, 2 * np.pi / 38.6
        # The wave of three times the wave number over k^2 A^3, by a derivation apart from the program's formula.
        for kh, bound in ((0.3, 18.199), (1.0, 0.69790), (5.0, 0.28134)):
            found = wave_records.bound_by_two_trains(0.005, 0.005, kh / depth, depth, np.array([0.0]))[0]
            self.assertAlmostEqual(found.real / ((kh / depth) ** 2 * 0.01**3), bound, delta=1e-4 * bound)
        amplitude = 1.12 * np.cos(k * position) + 1.054 * k**2 * 1.12**3 * np.cos(3 * k * position)
        waves_found = wave_records.separate_regular(position, amplitude, 1.02 * k, depth)
        self.assertAlmostEqual(2 * np.pi / waves_found.wave_number, 38.6, delta=0.01)
        self.assertAlmostEqual(2 * abs(waves_found.there), 1.12, delta=1e-3)

    def test_two_gauges_separate_regular_waves_in_less_than_two_periods(self):
        run = self.run_with([(0.05, PERIOD, 1, 0.3), (0.015, PERIOD, -1, 1.1)], places={"g1": 3.0, "g2": 3.3})
        numbers, _ = waves.analyse(run, start=18.0, period=PERIOD)
        self.assertAlmostEqual(numbers["regular"]["reflection"], 0.3, delta=0.005)
        self.assertAlmostEqual(numbers["regular"]["H_there_m"], 0.05, delta=0.05 * 5e-3)
        self.assertNotIn("separation", numbers)

    def test_a_short_window_takes_the_period_of_the_maker(self):
        """Waves that are not regular yet: the window of 1.9 periods is shortened to one."""
        run = self.run_with([(0.05, PERIOD, 1, 0.3), (0.04, 0.9, 1, 1.0)])
        start = 20 - 1.9 * PERIOD
        with self.assertRaisesRegex(DataError, rf"^gauge 'g1' between {start:.4g} and .* holds . waves; at least 3"):
            waves.analyse(run, ["g1"], start=start)
        effective = run.path / "case.effective.toml"
        effective.write_text(effective.read_text() + f'[[wave_maker]]\nwaves = "regular"\nperiod = {PERIOD}\n')
        gauge = waves.analyse(Run(run.path), ["g1"], start=start)[0]["gauges"]["g1"]
        self.assertEqual(gauge["T_mean_s"], PERIOD)

    def test_harmonics_have_their_amplitudes_and_phases(self):
        """Stokes' bound second harmonic beside a free one of the same frequency: four gauges separate them."""
        k, free = (float(waves.wave_numbers(n / PERIOD, DEPTH, GRAVITY)) for n in (1, 2))
        places = {"g1": 3.0, "g2": 3.25, "g3": 3.6, "g4": 4.1, "g5": 4.45}
        run = self.run_with([], places=places)
        for name, x in places.items():
            t = np.arange(0.0, 20.0, 0.005)
            angle = 2 * np.pi * t / PERIOD
            depth = (DEPTH + 0.025 * np.cos(angle - k * x) + 0.004 * np.cos(2 * (angle - k * x))
                     + 0.002 * np.cos(2 * angle - free * x + 1.0))
            (run.path / "probes" / f"{name}.csv").write_text("time_s,highest_m\n" + "".join(
                f"{time:.9g},{value:.9g}\n" for time, value in zip(t, depth)))
        numbers, _ = waves.analyse(run, start=10.0)
        self.assertAlmostEqual(numbers["period_s"], PERIOD, delta=1e-4)
        second = numbers["regular"]["second_m"]
        self.assertAlmostEqual(numbers["regular"]["wavelength_m"] * k / (2 * np.pi), 1, delta=5e-4)
        self.assertAlmostEqual(second["bound_there"], 0.004, delta=2e-4)
        self.assertAlmostEqual(second["free_there"], 0.002, delta=2e-4)
        self.assertLess(max(second["bound_back"], second["free_back"]), 2e-4)
        found = numbers["gauges"]["g1"]["harmonics"]
        self.assertAlmostEqual(found["amplitude_m"][0], 0.025, delta=1e-5)
        sum_of_both = 0.004 + 0.002 * np.exp(1j * (2 * k * 3.0 - free * 3.0 + 1.0))
        self.assertAlmostEqual(found["amplitude_m"][1], abs(sum_of_both), delta=1e-5)
        self.assertAlmostEqual(found["phase_from_first_deg"][1], -np.degrees(np.angle(sum_of_both)), delta=0.3)

    def test_set_up_is_the_rise_over_the_first_reading(self):
        run = self.run_with([])
        for name in PLACES:
            t = np.arange(0.0, 40.0, 0.01)
            depth = DEPTH + np.where(t > 5, 0.025 * np.cos(2 * np.pi * t / PERIOD) + 0.0035, 0.0)
            (run.path / "probes" / f"{name}.csv").write_text("time_s,highest_m\n" + "".join(
                f"{time:.9g},{value:.9g}\n" for time, value in zip(t, depth)))
        gauge = waves.analyse(run, ["g1"], start=10.0)[0]["gauges"]["g1"]
        self.assertAlmostEqual(gauge["set_up_m"], 0.0035, delta=2e-5)
        self.assertLess(gauge["set_up_interval_m"], 2e-5)

    def test_a_body_has_its_response_phase_and_drift(self):
        """Regular and irregular waves; the body leads the crest at its place by 40 degrees and drifts."""
        rng = np.random.default_rng(3)
        regular = [(0.05, PERIOD, 1, 0.3), (0.01, PERIOD, -1, 0.0)]
        irregular = [(0.01, period, 1, phase) for period, phase in zip(rng.uniform(1.0, 1.6, 40), rng.uniform(0, 6.28, 40))]
        for components, end, tolerance in ((regular, 20.0, 0.01), (irregular, 400.0, 0.05)):
            run = self.run_with(components, end=end)
            t = np.arange(0.0, end, 0.01)
            there = [wave for wave in components if wave[2] == 1]
            lead = np.radians(40.0)
            heave = 1.7 * elevation(5.0, t, [(H, T, d, phase + lead) for H, T, d, phase in there])
            rows = (t, 0.004 * t - 0.002 * end, heave, 0 * t)
            run = self.add_probe(run, '[[body]]\nname = "box"\ncentre = [5.0, 0.4]\n[[probe]]\nname = "box"\ntype = "motion"\n'
                                 'body = "box"\n', "box", "displacement_x_m,displacement_y_m,angle_rad", rows)
            found = waves.analyse(run, list(PLACES), responses=["box"])[0]["responses"]["box"]
            self.assertAlmostEqual(found["displacement_x_m"]["drift_per_s"], 0.004, delta=1e-6)
            y = found["displacement_y_m"]
            if end < 100:
                rao, phase = y["rao"], y["phase_deg"]
            else:
                best = int(np.argmax(y["coherence"]))
                self.assertGreater(y["coherence"][best], 0.95)
                rao, phase = y["rao"][best], y["phase_deg"][best]
            self.assertAlmostEqual(rao, 1.7, delta=1.7 * tolerance)
            self.assertAlmostEqual(phase, 40.0, delta=100 * tolerance)

    def test_dampers_take_the_power_of_the_velocity(self):
        """A heave of amplitude a: c (a omega)^2/2, and with the square of the velocity 4/(3 pi) q (a omega)^3."""
        run = self.run_with([(0.05, PERIOD, 1, 0.3)])
        t = np.arange(0.0, 20.0, 0.01)
        speed = 0.1 * 2 * np.pi / PERIOD
        rows = (t, 0 * t, 0.1 * np.sin(2 * np.pi * t / PERIOD), 0 * t, 0 * t, speed * np.cos(2 * np.pi * t / PERIOD), 0 * t)
        run = self.add_probe(run, '[[body]]\nname = "box"\ncentre = [5.0, 0.4]\ndamping = [9, 20, 9]\nquadratic_damping = [0, 30, 0]\n'
                             '[[probe]]\nname = "box"\ntype = "motion"\nbody = "box"\n', "box",
                             "displacement_x_m,displacement_y_m,angle_rad,velocity_x_m_per_s,velocity_y_m_per_s,"
                             "angular_velocity_rad_per_s", rows)
        numbers = waves.analyse(run, list(PLACES), responses=["box"])[0]
        found = numbers["damper_power_W"]["box"]
        self.assertIn("box.displacement_y_m: mean", waves.report(numbers))
        self.assertIn("box: dampers take", waves.report(numbers))
        expected = 0.5 * 20 * speed**2 + 4 / (3 * np.pi) * 30 * speed**3
        self.assertAlmostEqual(found["mean"], expected, delta=0.01 * expected)

    def test_overtopping_volumes_are_those_of_single_waves(self):
        run = self.run_with([(0.05, PERIOD, 1, 0.3)])
        t = np.arange(0.0, 20.0, 0.005)
        volumes = {2.0: 1e-3, 4.5: 3e-3, 5.75: 2e-3, 12.0: 5e-3}  # each passes within 0.3 s
        passed = sum(volume * np.clip((t - start) / 0.3, 0, 1) for start, volume in volumes.items())
        run = self.add_probe(run, '[[probe]]\nname = "crest"\ntype = "discharge"\n', "crest", "volume_m3", (t, passed))
        found = waves.analyse(run, list(PLACES), overtopping=["crest"])[0]["overtopping"]["crest"]
        np.testing.assert_allclose(found["volumes"], list(volumes.values()), rtol=1e-6)
        np.testing.assert_allclose(found["times_s"], list(volumes), atol=0.02)
        self.assertEqual(found["overtopping_waves"], 4)
        # The gauges' last reading is 20 s within 0.07 s.
        self.assertAlmostEqual(found["discharge"], 11e-3 / 20.0, delta=1e-2 * 11e-3 / 20.0)

    def test_bad_input_names_what_there_is(self):
        run = self.run_with([(0.05, PERIOD, 1, 0)])
        with self.assertRaisesRegex(DataError, "no depth probe 'g9'; it has g1, g2, g3"):
            waves.analyse(run, ["g9"])
        with self.assertRaisesRegex(DataError, "holds 1 waves"):
            waves.analyse(run, start=17.0)
        with self.assertRaisesRegex(DataError, "no times between"):
            waves.analyse(run, start=30.0)
        with self.assertRaisesRegex(DataError, "a period of 0.01 s has .* readings; its harmonics need 11"):
            waves.analyse(run, period=0.01)
        with self.assertRaisesRegex(DataError, "no motion or force probe 'box'; it has none"):
            waves.analyse(run, responses=["box"])


class Intervals(unittest.TestCase):
    def test_an_interval_holds_the_mean_and_the_drift_95_times_of_100(self):
        rng = np.random.default_rng(4)
        time, held = np.arange(12.0), np.zeros(2)
        for _ in range(2000):
            values = 0.3 * time + rng.normal(size=12)
            slope, slope_half = wave_records.drift_with_interval(time, values)
            mean, mean_half = wave_records.mean_with_interval(values - 0.3 * time)
            held += abs(slope - 0.3) < slope_half, abs(mean) < mean_half
        # 1900 of 2000 have the standard deviation 9.7; correlation is estimated too, which widens some intervals.
        self.assertTrue((held > 1860).all() and (held < 1980).all(), held)

    def test_students_quantile_continues_its_table(self):
        self.assertAlmostEqual(wave_records.student(10), 2.228, delta=1e-3)
        self.assertAlmostEqual(wave_records.student(11), 2.201, delta=2e-3)
        self.assertAlmostEqual(wave_records.student(1e6), 1.960, delta=1e-3)


if __name__ == "__main__":
    unittest.main()
