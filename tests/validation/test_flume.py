"""Flows whose numbers are known by hand."""

import json
import tempfile
import unittest
from pathlib import Path

import numpy as np

from tailwater.errors import DataError
from tailwater.run import Run
from tailwater_validation import flume
from tailwater_validation.potential_gate import contraction

G = 9.81
END = 8.0


class SteadyFlows(unittest.TestCase):
    def run_with(self, parameters, probes, profiles="", spacing=0.01):
        """A run whose probes {name: (column, early value, late value)} are early until a quarter of the run, which does not count;
        volumes grow by `late` per second."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = Path(folder.name)
        (path / "probes").mkdir()
        (path / "case.effective.toml").write_text(
            f"[case]\ndimension = 2\n[physics]\ndensity = 1000.0\ngravity = [0.0, -{G}]\n[particles]\nspacing = {spacing}\n"
            f"[time]\nend = {END}\n[parameters]\n" + "".join(f"{key} = {value}\n" for key, value in parameters.items()))
        for name, (column, early, late) in probes.items():
            (path / "probes" / f"{name}.csv").write_text(f"time_s,{column}\n" + "".join(
                f"{t:.9g},{early if t < END / 4 else late * (t if column == 'volume_m3' else 1):.12g}\n"
                for t in np.linspace(0, END, 801)))
        if profiles:
            (path / "probes" / "surface.csv").write_text(profiles)
        return Run(path)

    def test_a_weir_that_obeys_rehbock_has_no_error(self):
        # he = 0.09, he/P = 0.45: (1.782 + 0.108) 0.027
        head, discharge = 0.0889, 1.89 * 0.09**1.5
        self.assertAlmostEqual(flume.rehbock(head, 0.2), discharge, places=12)
        numbers = flume.weir(self.run_with({"P": 0.2}, {"upstream": ("connected_m", 0.5, 0.2 + head),
                                                        "over_crest": ("volume_m3", 0.0, 1.01 * discharge)}))
        self.assertAlmostEqual(numbers["coefficient_error"], 0.01, places=9)
        self.assertAlmostEqual(numbers["ideal_error"], 1.01 * discharge / ((1.782 + 0.24 * head / 0.2) * head**1.5) - 1,
                               places=9)
        self.assertLess(numbers["head_error"], 0.0)
        self.assertAlmostEqual(numbers["head_m"], head, places=9)

    def test_critical_flow_over_a_broad_weir_has_no_error(self):
        # With depth 0.2 m over P = 0.1: H = 0.1 + q^2/(2 g 0.04) and q = sqrt(g) (2 H/3)^1.5, by iteration.
        q = 0.05
        for _ in range(50):
            q = G**0.5 * (2 / 3 * (0.1 + q**2 / (2 * G * 0.04))) ** 1.5
        numbers = flume.broad_weir(self.run_with({"P": 0.1}, {"upstream": ("connected_m", 0.1, 0.2),
                                                              "crest": ("connected_m", 0.1, (q**2 / G) ** (1 / 3)),
                                                              "over_crest": ("volume_m3", 0.0, q)}))
        self.assertAlmostEqual(numbers["coefficient_error"], 0.0, places=9)
        self.assertAlmostEqual(numbers["potential_error"], 1 / flume.BROAD_WEIR_COEFFICIENT - 1, places=9)
        self.assertAlmostEqual(numbers["crest_over_critical"], 1.0, places=9)

    def test_an_ogee_at_its_design_head_has_no_error(self):
        # Energy head 0.1 over a crest 0.2 m high: the depth by iteration.
        q, depth = flume.OGEE_COEFFICIENT * 0.1**1.5, 0.3
        for _ in range(50):
            depth = 0.3 - q**2 / (2 * G * depth**2)
        numbers = flume.ogee(self.run_with({"P": 0.2}, {"upstream": ("connected_m", 0.1, depth),
                                                        "over_crest": ("volume_m3", 0.0, 1.02 * q)}))
        # 2 % more water also raises the velocity head that is added to the depth.
        raised = 0.0404 * q**2 / (2 * G * depth**2)
        self.assertAlmostEqual(numbers["coefficient_error"], 1.02 * (0.1 / (0.1 + raised)) ** 1.5 - 1, places=9)

    def test_a_gate_without_losses(self):
        # Energy 0.2 + q^2/(2 g 0.04) = jet + q^2/(2 g jet^2)
        jet = contraction(0.25) * 0.05
        q = (2 * G * (0.2 - jet) / (1 / jet**2 - 1 / 0.04)) ** 0.5
        numbers = flume.sluice_gate(self.run_with({"a": 0.05}, {"upstream": ("connected_m", 0.3, 0.2),
                                                                "jet": ("connected_m", 0.1, jet),
                                                                "discharge": ("volume_m3", 0.0, q)}))
        self.assertAlmostEqual(numbers["contraction_error"], 0.0, places=9)
        self.assertAlmostEqual(numbers["discharge_error"], 0.0, places=9)

    def test_a_jump_that_wanders_is_a_bore(self):
        """Water 0.05 m deep at 2 m/s; the jump goes back at 0.1 m/s, so it meets 2.1 m/s."""
        before, q, speed = 0.05, 0.1, -0.1
        behind = 0.5 * before * ((1 + 8 * 2.1**2 / (G * before)) ** 0.5 - 1)
        x = np.arange(-1, 1, 0.01)
        profiles = "time_s,x_m,bed_m,connected_m,highest_m\n" + "".join(
            f"{t},{place:.9g},0,{depth:.9g},{depth:.9g}\n" for t in (5.0, 6.0, 7.0)
            for place, depth in zip(x, np.where(x < speed * t + 0.605, before, behind)))
        run = self.run_with({"q": q}, {"before": ("connected_m", 0.1, before), "behind": ("connected_m", 0.1, behind)},
                            profiles)
        after = q + speed * (behind - before)  # what leaves while the water behind the jump grows longer

        def jump_with(profile):
            rows = "".join(f"6.0,{height},{u},0,{behind},{after / behind},0\n" for height, u in profile)
            (run.path / "probes/velocity_behind.csv").write_text(
                "time_s,height_m,u_m_s,v_m_s,depth_m,mean_u_m_s,mean_v_m_s\n" + rows)
            return flume.hydraulic_jump(Run(run.path))

        even = after / behind
        numbers = jump_with(((0.25 * behind, even), (0.75 * behind, even)))
        self.assertAlmostEqual(numbers["wander_m_s"], speed, places=9)
        self.assertAlmostEqual(numbers["conjugate_error"], 0.0, places=9)
        self.assertAlmostEqual(numbers["momentum_error"], 0.0, places=8)
        # Half as fast above, half as fast again below: a quarter more momentum, so the depth is more than momentum allows.
        numbers = jump_with(((0.25 * behind, 1.5 * even), (0.75 * behind, 0.5 * even)))
        self.assertAlmostEqual(numbers["momentum_coefficient"], 1.25, places=9)
        less = behind / (1 + numbers["momentum_error"])
        relative = q - speed * before
        self.assertAlmostEqual(0.5 * G * less**2 + relative**2 / less + 0.25 * after**2 / behind,
                               0.5 * G * before**2 + relative**2 / before, places=9)

    def test_even_flow_is_told_from_its_levels(self):
        numbers = flume.channel(self.run_with({"H": 0.2, "q": 0.1}, {"depth_upstream": ("connected_m", 0.2, 0.201),
                                                                     "depth_downstream": ("connected_m", 0.2, 0.198),
                                                                     "discharge": ("volume_m3", 0.0, 0.101)}))
        self.assertAlmostEqual(numbers["discharge_error"], 0.01, places=9)
        self.assertAlmostEqual(numbers["level_error_dx"], 0.2, places=9)

    def test_a_backwater_curve_ends_at_the_normal_depth(self):
        # Far upstream the friction of the side walls takes the slope of the bed; half as fast, less than that.
        walls = (0.05, 0.002, 1e-6, G)
        slope = flume.side_wall_slope(0.6, *walls)
        self.assertLess(flume.side_wall_slope(0.5, *walls), slope)
        normal = flume.backwater_curve(0.21, 60.0, 0.09, slope, lambda speed: flume.side_wall_slope(speed, *walls), G, 1000)
        self.assertAlmostEqual(normal, 0.09 / 0.6, places=5)
        # Without friction the energy head falls with the bed.
        above = flume.backwater_curve(0.21, 5.0, 0.09, 0.01, lambda speed: 0.0, G)
        heads = [h + 0.09**2 / (2 * G * h**2) for h in (above, 0.21)]
        self.assertAlmostEqual(heads[1] - heads[0], 0.05, places=5)

    def test_a_backwater_is_told_from_its_curve(self):
        friction = lambda speed: flume.side_wall_slope(speed, 0.05, 0.002, 1e-6, G)
        upstream, middle, downstream = (flume.backwater_curve(0.21, x, 0.09, 0.01, friction, G) for x in (5.0, 3.0, 1.0))
        run = self.run_with({"L": 6.0, "S": 0.01, "H": 0.21, "q": 0.09},
                            {"upstream": ("connected_m", 0.15, upstream + 0.003), "middle": ("connected_m", 0.18, middle),
                             "downstream": ("connected_m", 0.2, downstream - 0.001), "discharge": ("volume_m3", 0.0, 0.0909)})
        effective = run.path / "case.effective.toml"
        effective.write_text(effective.read_text().replace(
            "[physics]", "[physics]\nchannel_width = 0.05\nchannel_roughness = 0.002\nviscosity = 1e-6"))
        numbers = flume.backwater(Run(run.path))
        self.assertAlmostEqual(numbers["level_error_dx"], 0.3, places=6)
        self.assertAlmostEqual(numbers["discharge_error"], 0.01, places=9)

    def test_water_that_circulates_is_counted(self):
        run = self.run_with({"H": 0.2, "q": 0.1}, {"depth_upstream": ("connected_m", 0.2, 0.2),
                                                   "depth_downstream": ("connected_m", 0.2, 0.2),
                                                   "discharge": ("volume_m3", 0.0, 0.1)})
        effective = run.path / "case.effective.toml"
        effective.write_text(effective.read_text() + "[[inlet]]\nreserve = 0.0052\n")  # 52 particles
        (run.path / "summary.json").write_text(json.dumps({"water_balance": {
            "start": {"particles": 400}, "inside": {"particles": 390}, "outside": {"particles": 1},
            "inlets": [{"steps_short_of_water": 3}], "outlets": [{"waiting": {"particles": 60}}]}}))
        numbers = flume.circulation(Run(run.path))
        self.assertEqual((numbers["lost_particles"], numbers["steps_short_of_water"]), (1, 3))
        for name in ("discharge_error", "discharge_drift", "level_error_dx", "level_drift_dx"):
            self.assertAlmostEqual(numbers[name], 0.0, places=7)

    def test_a_solitary_wave_that_obeys(self):
        """It stands at the wall 3 % too high, and presses on it 2 % too much, on the upper gauge 5 %."""
        depth, e = 0.2, 0.2
        run = self.run_with({"h": depth, "H": e * depth}, {})
        effective = run.path / "case.effective.toml"
        speed = (G * depth * (1 + e - e**2 / 20 - 3 * e**3 / 70)) ** 0.5
        places = {"g1": 2.0, "g2": 3.0, "g3": 4.0}
        effective.write_text(effective.read_text() + "".join(
            f"[[probe]]\nname = '{name}'\ntype = 'depth'\nat = [{x}, 0.0]\n" for name, x in places.items()))
        t = np.linspace(0, END, 4001)
        waves = {name: ("highest_m", depth + e * depth / np.cosh(3 * (speed * t - x)) ** 2) for name, x in places.items()}
        highest = (2 * e + e**2 / 2 + 3 * e**3 / 4) * depth
        waves["wall"] = ("connected_m", depth + 1.03 * highest / np.cosh(2 * (speed * t - 5.5)) ** 2)
        exact, scale = flume.wall_history(e), (depth / G) ** 0.5

        def at_wall(values):
            return np.interp((t - 5.5 / speed) / scale, exact.time, values)

        weight = 1000 * G * depth
        waves["force"] = ("force_x_N_per_m", weight * depth * (0.5 + 1.02 * at_wall(exact.force)))
        waves["p1"] = ("pressure_Pa", weight * (0.75 + at_wall(exact.pressure[0.25])))
        waves["p2"] = ("pressure_Pa", weight * (0.25 + 1.05 * at_wall(exact.pressure[0.75])))
        for name, (column, value) in waves.items():
            (run.path / "probes" / f"{name}.csv").write_text(f"time_s,{column}\n" + "".join(
                f"{time:.9g},{z:.9g}\n" for time, z in zip(t, value)))
        numbers = flume.solitary_wave(Run(run.path))
        self.assertAlmostEqual(numbers["force_error"], 0.02, delta=2e-3)
        self.assertAlmostEqual(numbers["pressure_error"], 0.05, delta=2e-3)
        near = exact.force[np.abs(exact.time) < flume.WALL_WINDOW]
        # The two largest forces are matched to a step of the theory.
        step = np.max(np.abs(np.diff(near))) / near.max()
        self.assertAlmostEqual(numbers["force_rms"], 0.02 * np.sqrt(np.mean(near**2)) / near.max(), delta=step)
        self.assertAlmostEqual(numbers["speed_error"], 0.0, delta=5e-4)
        self.assertAlmostEqual(numbers["wall_error"], 0.03, delta=2e-3)
        self.assertAlmostEqual(numbers["height_lost"], 0.0, delta=1e-4)

    def test_a_wave_that_runs_up_as_synolakis_says(self):
        depth, height, cot = 0.2, 0.02, 4.0
        run = self.run_with({"h": depth, "H": height, "cot": cot}, {})
        t = np.linspace(0, END, 2001)
        law = 2.831 * 2 * 0.1**1.25 * depth
        for name, column, value in (("gauge", "highest_m", depth + height / np.cosh(3 * (t - 2)) ** 2),
                                    ("beach", "connected_m", 0.99 * depth + 1.02 * law / np.cosh(2 * (t - 4)) ** 2)):
            (run.path / "probes" / f"{name}.csv").write_text(f"time_s,{column}\n" + "".join(
                f"{time:.9g},{z:.9g}\n" for time, z in zip(t, value)))
        numbers = flume.run_up(run)
        self.assertAlmostEqual(numbers["height_error"], 0.0, delta=2e-3)  # the crest is not quite the parabola
        self.assertAlmostEqual(numbers["run_up_error"], 0.02, delta=4e-3)

    def test_a_run_that_did_not_reach_its_end_has_no_numbers(self):
        run = self.run_with({"P": 0.2}, {"upstream": ("connected_m", 0.3, 0.3)})
        file = run.path / "probes" / "upstream.csv"
        file.write_text("\n".join(file.read_text().splitlines()[:500]) + "\n")
        with self.assertRaisesRegex(DataError, "ends at 4.98 s"):
            flume.steady_mean(run, "upstream", "connected_m")
