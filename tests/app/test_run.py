"""run: the files that it writes, those that it leaves unchanged, and the state of its folder after a stop."""

import fcntl
import os
import resource
import signal
import subprocess
import unittest

import numpy as np

from fields import read_points, read_series
from program import PATIENCE, PROGRAM, ProgramTest, environment

# Such a run takes hours and continues until it is stopped.
ENDLESS = ("--set", "time.end=1000", "--set", "output.fields_interval=0.05")
PROBES = ("depth", "energy", "wall_pressure")


class OutputContract(ProgramTest):
    def test_every_file_is_there_and_nothing_else(self):
        self.call("run", "small.toml", "--out", "deep/below/run", "--quiet")
        run = self.folder / "deep/below/run"
        self.assertEqual({path.name for path in run.iterdir()},
                         {"case.effective.toml", "steps.csv", "summary.json", "log.txt", "probes", "fields",
                          "view", "checkpoints"})
        self.assertEqual({path.name for path in (run / "probes").iterdir()}, {f"{name}.csv" for name in PROBES})
        series = read_series(run / "fields/fields.pvd")
        self.assertEqual({path.name for path in (run / "fields").iterdir()},
                         {"fields.pvd", *(path.name for _, path in series)})

    def test_tables_cover_the_run_step_by_step(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        names, steps = self.table("run/steps.csv")
        time, step, dt = (np.array([row[names.index(name)] for row in steps]) for name in ("time_s", "step", "dt_s"))
        np.testing.assert_array_equal(step, np.arange(1, len(steps) + 1))
        np.testing.assert_allclose(np.cumsum(dt), time, rtol=1e-12)
        self.assertGreaterEqual(time[-1], 0.1)
        self.assertLess(time[-2], 0.1)
        for probe in PROBES:
            _, rows = self.table(f"run/probes/{probe}.csv")
            np.testing.assert_array_equal([row[0] for row in rows], [0.0, *time])

    def test_fields_hold_all_particles_at_increasing_times(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        series = read_series(self.folder / "run/fields/fields.pvd")
        times = [time for time, _ in series]
        # The start, one time at or after each multiple of 0.02 s below 0.1 s, the end.
        self.assertEqual(times, sorted(set(times)))
        self.assertEqual(len(times), 6)
        for k, time in enumerate(times):
            self.assertGreaterEqual(time, 0.02 * k)
        for _, path in series:
            positions, fields = read_points(path)
            self.assertEqual(positions.shape, (50, 3))
            self.assertEqual(set(fields), {"pressure", "velocity", "density_error", "id"})
            np.testing.assert_array_equal(fields["id"], np.arange(50))
            self.assertTrue(np.isfinite(fields["pressure"]).all() and np.isfinite(fields["velocity"]).all())

    def test_summary(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        summary = self.summary("run")
        _, steps = self.table("run/steps.csv")
        self.assertEqual(summary["title"], "Small dam break")
        self.assertEqual(summary["case"], "small.toml")
        self.assertEqual((summary["status"], summary["exit_code"], summary["message"]), ("done", 0, ""))
        self.assertEqual(summary["spacing_m"], 0.1)
        self.assertEqual(summary["particles"], {"fluid": 50, "wall": 246})
        self.assertEqual(summary["time_s"], {"end": 0.1, "reached": steps[-1][0]})
        self.assertEqual(summary["steps"]["count"], len(steps))
        self.assertEqual(summary["volume"]["fluid_particles_end"], summary["volume"]["fluid_particles_start"])
        self.assertGreater(summary["cost"]["wall_clock_s"], 0.0)
        self.assertGreater(summary["cost"]["peak_memory_bytes"], 0.0)
        for block in ("pressure_solver", "divergence", "energy", "interventions", "version", "commit", "compiler", "options",
                      "libraries", "machine"):
            self.assertIn(block, summary)
        self.assertEqual((summary["seed"], summary["ranks"]["count"]), (1, 1))

    def test_the_summary_tells_which_petsc_was_loaded(self):
        for preconditioner, version in (("ssor", r"^Open MPI v"), ("jacobi", r"^PETSc \d+\.\d+\.\d+, Open MPI v")):
            self.call("run", "small.toml", "--out", preconditioner, "--quiet", "--set", "time.end=0.01", "--set",
                      f"pressure_solver.preconditioner={preconditioner}")
            self.assertRegex(self.summary(preconditioner)["libraries"], version)

    def test_the_effective_case_gives_the_same_run(self):
        overrides = ("--set", "scheme.integrator=implicit", "--set", "particles.jitter=0.2", "--set",
                     "particles.seed=7")
        self.call("run", "small.toml", "--out", "first", "--quiet", *overrides)
        self.call("run", "first/case.effective.toml", "--out", "second", "--quiet")

        def text(run, file):
            return (self.folder / run / file).read_text()

        for file in ("steps.csv", *(f"probes/{probe}.csv" for probe in PROBES), "case.effective.toml"):
            self.assertEqual(text("first", file), text("second", file))
        self.call("run", "small.toml", "--out", "other", "--quiet", *overrides[:-1], "particles.seed=8")
        self.assertNotEqual(text("first", "steps.csv"), text("other", "steps.csv"))

    def test_set_reaches_the_run(self):
        self.call("run", "small.toml", "--out", "run", "--quiet", "--set", "probe.depth.interval=0.05", "--set",
                  "output.fields=['id']")
        _, rows = self.table("run/probes/depth.csv")
        self.assertEqual(len(rows), 3)  # at 0, 0.05 and 0.1 s
        _, fields = read_points(read_series(self.folder / "run/fields/fields.pvd")[0][1])
        self.assertEqual(set(fields), {"id"})

    def test_an_end_time_below_the_first_step_makes_one_step(self):
        self.call("run", "small.toml", "--out", "run", "--quiet", "--set", "time.end=1e-6")
        self.assertEqual(self.summary("run")["steps"]["count"], 1)
        self.assertEqual(self.summary("run")["time_s"]["reached"], 1e-6)


class Outlet(ProgramTest):
    """The small dam break with an open end 1.5 m from the wall: at sqrt(g h) = 2.2 m/s some of the water has left after
    0.6 s."""

    OPEN = ("--set", "wall[0].points=[[0, 2], [0, 0], [1.5, 0]]", "--set", "time.end=0.6")

    def setUp(self):
        super().setUp()
        case = self.folder / "small.toml"
        case.write_text(case.read_text() + '[[probe]]\nname = "volume"\ntype = "volume"\n'
                        '[[outlet]]\nname = "end"\nfrom = [1.5, 0]\nto = [1.5, 2]\n')

    def test_what_is_inside_and_what_left_is_what_was_there(self):
        for integrator in ("explicit", "implicit"):
            with self.subTest(integrator):
                result = self.call("run", "small.toml", "--out", integrator, *self.OPEN, "--set", "time.end=1.2", "--set",
                                   f"scheme.integrator={integrator}")
                balance = self.summary(integrator)["water_balance"]
                start, inside, out = (balance[key]["particles"] for key in ("start", "inside", "out"))
                self.assertEqual(start, 50)
                self.assertEqual(inside + out, start)
                self.assertGreater(out, 0)
                for key in ("start", "inside", "out"):
                    self.assertAlmostEqual(balance[key]["volume_m3"], 0.01 * balance[key]["particles"])
                self.assertEqual([(o["name"], o["particles"]) for o in balance["outlets"]], [("end", out)])
                water = next(line for line in result.stderr.splitlines() if line.startswith("water: "))
                self.assertRegex(water, rf"^water: 50 particles .* at the start, {inside} .* inside, 0 .* outside the "
                                        rf"walls, {out} .* out$")

                names, steps = self.table(f"{integrator}/steps.csv")
                volume_out = [row[names.index("volume_out_m3")] for row in steps]
                self.assertEqual(volume_out, sorted(volume_out))
                self.assertAlmostEqual(volume_out[-1], 0.01 * out)
                names, rows = self.table(f"{integrator}/probes/volume.csv")
                for row in rows:  # the probe does not count water in the duct of the outlet
                    in_case_and_out = 0.01 * row[names.index("particles")] + row[names.index("volume_out_m3")]
                    self.assertLess(in_case_and_out, 0.5 + 1e-9)
                self.assertAlmostEqual(0.01 * rows[0][names.index("particles")], 0.5)
                _, fields = read_points(read_series(self.folder / integrator / "fields/fields.pvd")[-1][1])
                self.assertEqual(len(set(fields["id"])), inside)
                self.assertEqual(self.summary(integrator)["volume"]["outside_the_walls_most"], 0)

    def test_what_comes_in_is_counted_and_passes_a_section(self):
        inlet = ("--set", "wall[0].points=[[0, 0], [1.5, 0]]", "--set", "fluid[0].max=[1.5, 0.5]", "--set",
                 "fluid[0].velocity=[1, 0]", "--set", "outlet[0].level=0.5", "--set",
                 "inlet=[{name='in', from=[0, 0], to=[0, 2], discharge=0.5}]", "--set",
                 "probe=[{name='volume', type='volume'}, {name='middle', type='discharge', from=[0.75, 0], to=[0.75, 2]}]")
        result = self.call("run", "small.toml", "--out", "run", *self.OPEN, *inlet)
        summary = self.summary("run")
        balance = summary["water_balance"]
        start, came, inside, outside, out = (balance[key]["particles"]
                                             for key in ("start", "in", "inside", "outside", "out"))
        self.assertEqual(start + came, inside + outside + out)
        self.assertGreater(came, 0)
        self.assertAlmostEqual(balance["in"]["volume_m3"], 0.5 * 0.6, delta=0.1 * 0.5)  # to one layer of particles
        (inlet,), (outlet,) = balance["inlets"], balance["outlets"]
        self.assertEqual((inlet["name"], inlet["particles"], inlet["back"]["particles"]), ("in", came, 0))
        self.assertEqual(outlet["particles"], out)
        self.assertIn(f" {came} particles ", result.stderr)
        names, steps = self.table("run/steps.csv")
        self.assertAlmostEqual(steps[-1][names.index("volume_in_m3")], balance["in"]["volume_m3"])
        names, rows = self.table("run/probes/middle.csv")
        self.assertEqual(names, ["time_s", "discharge_m3_per_s", "volume_m3"])
        (section,) = summary["discharge"]
        self.assertAlmostEqual(section["volume_m3"], rows[-1][2])
        self.assertAlmostEqual(section["mean_m3_per_s"], section["volume_m3"] / summary["time_s"]["reached"])
        self.assertAlmostEqual(rows[0][1], 0.5, places=6)  # a lattice that moves uniformly is counted exactly

    def test_an_end_that_misses_its_level_says_so(self):
        """A supercritical flow 0.5 m deep at 6 m/s passes below a tailwater of 0.9 m: its conjugate depth is 1.68 m."""
        shooting = ("--set", "wall[0].points=[[0, 0], [1.5, 0]]", "--set", "fluid[0].max=[1.5, 0.5]", "--set",
                    "fluid[0].velocity=[6, 0]", "--set", "time.end=9", "--set",
                    "inlet=[{name='in', from=[0, 0], to=[0, 2], discharge=3, level=0.5}]", "--set",
                    "outlet[0].level=0.9")
        result = self.call("run", "small.toml", "--out", "run", *shooting)
        said = "outlet 'end' does not hold its level: since t = "
        self.assertIn(said, result.stderr)
        self.assertIn(said, (self.folder / "run" / "log.txt").read_text())
        self.assertRegex(self.summary("run")["warnings"][-1], "the level at outlet 'end' is still .* m too low; it was off for ")
        balance = self.summary("run")["water_balance"]
        (outlet,), (inlet,) = balance["outlets"], balance["inlets"]
        self.assertAlmostEqual(outlet["level_missed"]["by_m"], 0.5 - 0.9, delta=0.1)  # the particle spacing
        self.assertGreater(outlet["level_missed"]["for_s"], 0)
        self.assertNotIn("level_missed", inlet)
        self.assertAlmostEqual(inlet["asked_for_m3"], 3 * 9, delta=0.1)
        self.assertAlmostEqual(inlet["volume_m3"], 3 * 9, delta=0.5)

    def test_a_run_goes_on_when_all_is_gone(self):
        self.call("run", "small.toml", "--out", "run", *self.OPEN, "--set", "fluid[0].velocity=[8, 0]")
        summary = self.summary("run")
        self.assertEqual(summary["water_balance"]["inside"]["particles"], 0)
        self.assertEqual(summary["status"], "done")
        self.assertGreaterEqual(summary["time_s"]["reached"], 0.6)

    def test_the_preview_shows_it(self):
        self.call("check", "small.toml", *self.OPEN)
        self.assertIn(">end</text>", (self.folder / "small.preview.svg").read_text())


class Books(ProgramTest):
    # The water moves at 3 m/s over a rim 0.2 m away and 0.1 m above its surface.
    OVER_THE_RIM = ("--set", "wall[0].points=[[0, 2], [0, 0], [1.2, 0], [1.2, 0.6]]", "--set",
                    "fluid[0].velocity=[3, 2]", "--set", "time.end=0.2")

    def test_spray_above_an_open_tank_is_not_lost(self):
        self.call("run", "small.toml", "--out", "run", "--quiet", "--set",
                  "wall[0].points=[[0, 0.6], [0, 0], [1, 0], [1, 0.6]]", "--set", "fluid[0].velocity=[0, 3]", "--set",
                  "time.end=0.2", "--set", "particles.spacing=0.05")
        summary = self.summary("run")
        positions, _ = read_points(read_series(self.folder / "run/fields/fields.pvd")[-1][1])
        self.assertGreater(np.count_nonzero(positions[:, 1] > 0.6), 0)
        self.assertEqual(summary["water_balance"]["inside"], summary["water_balance"]["start"])
        self.assertEqual(summary["volume"]["outside_the_walls_most"], 0)
        self.assertEqual(summary["warnings"], [])

    def test_a_tank_that_sinks_from_the_start_gains_no_energy(self):
        self.call("run", "small.toml", "--out", "run", "--quiet", "--set", 'wall[0].displacement=[0, "-t"]', "--set",
                  "fluid[0].velocity=[0, -1]", "--set", "time.end=0.1")
        self.assertEqual(self.summary("run")["warnings"], [])

    def test_water_that_left_over_a_rim_is_outside(self):
        for ranks in ("1", "2"):
            with self.subTest(ranks=ranks):
                self.call("run", "small.toml", "--out", ranks, "--quiet", "-n", ranks, *self.OVER_THE_RIM)
                balance = self.summary(ranks)["water_balance"]
                self.assertGreater(balance["outside"]["particles"], 0)
                positions, _ = read_points(read_series(self.folder / ranks / "fields/fields.pvd")[-1][1])
                # Water above the box around the walls may still fall back into it.
                beyond = (positions[:, 0] > 1.2) | (positions[:, 0] < 0.0) | (positions[:, 1] < 0.0)
                self.assertEqual(balance["outside"]["particles"], np.count_nonzero(beyond))
                for key in ("particles", "volume_m3", "mass_kg"):
                    before, after = ([balance[part][key] for part in parts]
                                     for parts in (("start", "in"), ("inside", "outside", "out")))
                    self.assertAlmostEqual(sum(before), sum(after), delta=1e-12 * sum(before))
                self.assertAlmostEqual(balance["start"]["mass_kg"], 1000 * balance["start"]["volume_m3"], delta=1e-9)

    def test_masses_of_two_liquids(self):
        """A pump draws the heavy liquid from below the light one."""
        (self.folder / "two.toml").write_text(
            "particles.spacing = 0.05\ntime.end = 0.3\n"
            + "".join(f'[[liquid]]\nname = "{name}"\ndensity = {density}\nviscosity = 1e-3\n[[fluid]]\n'
                      f'liquid = "{name}"\nmin = [0, {low}]\nmax = [1, {low + 0.3}]\n'
                      for name, density, low in (("heavy", 2000, 0.0), ("light", 1000, 0.3)))
            + '[[wall]]\nname = "a"\npoints = [[0, 0.9], [0, 0], [0.4, 0]]\n'
            '[[wall]]\nname = "b"\npoints = [[0.6, 0], [1, 0], [1, 0.9]]\n'
            '[[inlet]]\nname = "pump"\nfrom = [0.4, 0]\nto = [0.6, 0]\ndirection = [0, 1]\ndischarge = -0.08\n')
        self.call("run", "two.toml", "--out", "two", "--quiet")
        summary = self.summary("two")
        balance = summary["water_balance"]
        self.assertGreater(balance["out"]["particles"], 0)
        self.assertAlmostEqual(balance["out"]["mass_kg"], 2000 * balance["out"]["volume_m3"], delta=1e-9)
        self.assertAlmostEqual(balance["out"]["mass_kg"], balance["inlets"][0]["back"]["mass_kg"], delta=1e-9)
        heavy_below = balance["start"]["volume_m3"] - 0.3  # with the water in the duct of the pump
        self.assertAlmostEqual(balance["start"]["mass_kg"], 2000 * heavy_below + 1000 * 0.3, delta=1e-6)
        self.assertAlmostEqual(balance["inside"]["mass_kg"],
                               sum(liquid["mass_kg"] for liquid in summary["liquids"]), delta=1e-9)

    def test_water_that_fell_below_all_walls_is_counted_and_no_longer_computed(self):
        floor = -0.3  # one kernel support below the bed, m
        self.call("run", "small.toml", "--out", "run", "--quiet", *self.OVER_THE_RIM, "--set", "time.end=1.2")
        summary = self.summary("run")
        balance = summary["water_balance"]
        positions, _ = read_points(read_series(self.folder / "run/fields/fields.pvd")[-1][1])
        fallen = balance["start"]["particles"] - len(positions)
        self.assertGreater(fallen, 0)
        # The last step may have moved some particles below the limit.
        self.assertGreater(positions[:, 1].min(), floor - 0.1)
        beside = np.count_nonzero((positions[:, 0] > 1.2) & (positions[:, 1] < 0.6))
        self.assertEqual(balance["outside"]["particles"], beside + fallen)
        self.assertEqual(balance["inside"]["particles"] + balance["outside"]["particles"],
                         balance["start"]["particles"])
        self.assertGreaterEqual(summary["volume"]["outside_the_walls_most"], fallen)
        # The energy balance includes the energy of the removed water.
        self.assertLess(summary["energy"]["largest_rise_over_start"], 1e-3)

    # 0.35 m x 0.33 m are no multiples of the spacing of 0.1 m.
    def test_an_obstacle_inside_a_block_takes_its_volume(self):
        self.call("run", "small.toml", "--out", "run", "--quiet", "--set",
                  "wall=[{name='tank', points=[[0, 2], [0, 0], [1, 0], [1, 2]]}, "
                  "{name='block', shape='box', min=[0.32, 0.33], max=[0.67, 0.66], fluid_side='outside'}]", "--set",
                  "fluid[0].max=[1, 1]")
        balance = self.summary("run")["water_balance"]
        self.assertAlmostEqual(balance["start"]["volume_m3"], 1.0 - 0.35 * 0.33, delta=1e-12)
        self.assertEqual(balance["inside"]["particles"], balance["start"]["particles"])
        self.assertEqual(balance["outside"]["particles"], 0)
        for _, path in read_series(self.folder / "run/fields/fields.pvd"):
            positions, _ = read_points(path)
            self.assertEqual(len(positions), balance["start"]["particles"])
            in_block = (np.abs(positions[:, 0] - 0.495) < 0.175) & (np.abs(positions[:, 1] - 0.495) < 0.165)
            self.assertEqual(np.count_nonzero(in_block), 0)

    def test_what_a_piston_pushes_over_the_rim_is_outside(self):
        for ranks in ("1", "2"):
            with self.subTest(ranks=ranks):
                self.call("run", "small.toml", "--out", ranks, "--quiet", "-n", ranks, "--set",
                          "wall=[{name='tank', points=[[-0.2, 0], [1, 0], [1, 0.6]]}, "
                          "{name='piston', points=[[0, 1], [0, 0]], displacement=['2*t', 0]}]", "--set", "time.end=0.4")
                balance = self.summary(ranks)["water_balance"]
                positions, _ = read_points(read_series(self.folder / ranks / "fields/fields.pvd")[-1][1])
                outside = (positions[:, 0] > 1.0) | (positions[:, 1] < 0.0)
                self.assertGreater(np.count_nonzero(outside), 5)
                for part, count in (("inside", np.count_nonzero(~outside)), ("outside", np.count_nonzero(outside))):
                    self.assertEqual(balance[part]["particles"], count)
                    self.assertAlmostEqual(balance[part]["volume_m3"], 0.01 * count)
                self.assertEqual(len(positions), balance["start"]["particles"])

    def test_warnings_are_kept(self):
        run = self.call("run", "small.toml", "--out", "run", *self.OVER_THE_RIM)
        warnings = [line.removeprefix("warning: ") for line in run.stderr.splitlines() if line.startswith("warning: ")]
        self.assertGreater(len(warnings), 0)
        self.assertEqual(self.summary("run")["warnings"], warnings)

    def test_an_error_beyond_its_limit_ends_the_run_with_fields_for_a_look(self):
        for limit in ("energy_stop", "volume_stop"):
            with self.subTest(limit):
                self.call("run", "small.toml", "--out", limit, "--quiet", "--set", f"limits.{limit}=1e-9", "--set",
                          "particles.jitter=0.3", "--set", "wall[0].points=[[0, 2], [0, 0], [1, 0], [1, 2]]", "--set",
                          "time.end=0.3", expect=3)
                summary = self.summary(limit)
                self.assertEqual(summary["status"], "failed")
                self.assertIn(f"limits.{limit} = 1e-09", summary["message"])
                time, path = read_series(self.folder / limit / "fields/fields.pvd")[-1]
                self.assertEqual(time, summary["time_s"]["reached"])
                read_points(path)


class Messages(ProgramTest):
    def test_progress_goes_to_standard_error_in_plain_lines(self):
        result = self.call("run", "small.toml", "--out", "run")
        self.assertEqual(result.stdout, "")
        *progress, depth, pressure, energy, last = result.stderr.splitlines()
        self.assertEqual(last, "done: results in run")
        self.assertRegex(depth, r"^depth: 0\.\d+ m \(mean of \d readings in the second half, still falling\), highest 0\.\d+ m \(at [\d.]+ s\)$")
        self.assertRegex(pressure, r"^wall_pressure: \d+ Pa \(mean of \d readings in the second half, still rising\), largest \d+ Pa.*, impulse [\d.]+ Pa s \(at ")
        self.assertRegex(energy, r"^energy: \d+ J per m \(at 0\.1\d* s\)$")
        self.assertEqual(self.summary("run")["results"]["depth"]["words"], depth.removeprefix("depth: "))
        self.assertRegex(progress[0], r"^ +\d+\.\d %  t = 0\.0\d+ s  ETA ")
        self.assertRegex(progress[-1], r"^100\.0 %")
        self.assertNotIn("\r", result.stderr)

    def test_quiet_says_nothing(self):
        loud = self.call("run", "small.toml", "--out", "loud", *Books.OVER_THE_RIM)
        self.assertGreater(self.summary("loud")["volume"]["outside_the_walls_most"], 0)
        self.assertIn("warning: ", loud.stderr)
        self.assertIn("Remedy: raise the walls", loud.stderr)
        quiet = self.call("run", "small.toml", "--out", "quiet", "--quiet", *Books.OVER_THE_RIM)
        self.assertEqual((quiet.stdout, quiet.stderr), ("", ""))
        for run in ("loud", "quiet"):
            self.assertIn("warning: at t = ", (self.folder / run / "log.txt").read_text())
        self.assertEqual((self.folder / "loud/log.txt").read_text(), loud.stderr)

    def test_the_log_has_the_error_that_ends_a_run(self):
        failed = self.call("run", "small.toml", "--out", "run", "--set", "pressure_solver.max_iterations=1", expect=3,
                           errors_only=False)
        self.assertEqual((self.folder / "run/log.txt").read_text(), failed.stderr)
        self.assertIn("error: step 0 ", failed.stderr)


class LostTerminal(ProgramTest):
    """A run continues to its end when it loses its terminal, and its log has all messages."""

    def check_done(self, run, *expected):
        self.assertEqual(self.summary(run)["status"], "done")
        log = (self.folder / run / "log.txt").read_text()
        for text in ("100.0 %", f"done: results in {run}", *expected):
            self.assertIn(text, log)

    def test_standard_error_that_takes_nothing(self):
        words = {"all closed": "<&- >&- 2>&-", "full": "2>/dev/full", "broken": "2> >(exec true; )",
                 "ranks closed": "-n 2 2>&-"}
        for name, redirection in words.items():
            with self.subTest(name):
                subprocess.run(["bash", "-c", f'"$0" run small.toml --out "{name}" {redirection}', PROGRAM],
                               cwd=self.folder, env=environment(), check=True, timeout=PATIENCE)
                self.check_done(name)

    def test_a_pipe_that_nobody_reads(self):
        read, write = os.pipe()
        fcntl.fcntl(write, fcntl.F_SETPIPE_SZ, 4096)
        os.write(write, bytes(4096))  # full
        process = subprocess.run([PROGRAM, "run", "small.toml", "--out", "run"], cwd=self.folder, env=environment(),
                                 stderr=write, check=False, timeout=PATIENCE)
        self.assertEqual(process.returncode, 0)
        self.check_done("run")
        os.close(read)
        os.close(write)

    def test_hanging_up(self):
        for ranks in ("1", "2"):
            with self.subTest(ranks=ranks):
                process = self.start("run", "small.toml", "--out", ranks, "-n", ranks, *ENDLESS)
                self.wait_for((self.folder / ranks / "fields/fields_00001.vtp").exists, process)
                process.send_signal(signal.SIGHUP)
                process.stderr.close()
                fields = len(list((self.folder / ranks / "fields").iterdir()))
                self.wait_for(lambda: len(list((self.folder / ranks / "fields").iterdir())) > fields + 2, process)
                process.send_signal(signal.SIGTERM)
                self.assertEqual(process.wait(timeout=PATIENCE), 130)
                log = (self.folder / ranks / "log.txt").read_text()
                self.assertIn(f"interrupted: results in {ranks}; to continue: ", log)
                process.stderr = None  # nothing to read at the end of the test

    def test_standard_output_that_takes_nothing_is_an_error(self):
        with open("/dev/full", "w") as full:
            result = subprocess.run([PROGRAM, "check", "small.toml"], cwd=self.folder, env=environment(), stdout=full,
                                    stderr=subprocess.PIPE, text=True, check=False, timeout=PATIENCE)
        self.assertEqual(result.returncode, 4)
        self.assertRegex(result.stderr, "^error: cannot write to standard output")


class ExistingFolder(ProgramTest):
    def test_is_refused_and_left_untouched(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        before = self.listing()
        message = self.call("run", "small.toml", "--out", "run", expect=2).stderr
        self.assertIn("'run'", message)
        self.assertIn("--force", message)
        self.assertEqual(self.listing(), before)

    def test_force_replaces_the_results_only(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        (self.folder / "run/notes.txt").write_text("mine")
        shorter = ("--set", "time.end=0.01", "--set", "probe=[]")
        self.call("run", "small.toml", "--out", "run", "--quiet", "--force", *shorter)
        self.assertEqual((self.folder / "run/notes.txt").read_text(), "mine")
        self.assertEqual(list((self.folder / "run/probes").iterdir()), [])
        series = read_series(self.folder / "run/fields/fields.pvd")
        self.assertEqual(len(list((self.folder / "run/fields").glob("*.vtp"))), len(series))
        self.assertEqual(self.summary("run")["time_s"]["end"], 0.01)

    def test_a_bad_case_with_force_leaves_the_old_results(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        before = self.listing()
        self.call("run", "small.toml", "--out", "run", "--force", "--set", "probe.depth.at=[9, 0]", expect=2)
        self.assertEqual(self.listing(), before)

    def test_force_leaves_files_that_no_run_has_written(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        foreign = [self.folder / "run" / name for name in ("probes/laboratory.csv", "fields/mine.vtp", "fields/note.txt")]
        for path in foreign:
            path.write_text("mine")
        self.call("run", "small.toml", "--out", "run", "--quiet", "--force", "--set", "probe=[]")
        for path in foreign:
            self.assertEqual(path.read_text(), "mine")
        self.assertFalse((self.folder / "run/probes/depth.csv").exists())

    def test_of_a_run_that_goes_on_is_refused(self):
        """test_ranks has the same test for several ranks."""
        process = self.start("run", "small.toml", "--out", "run", "--quiet", *ENDLESS)
        self.wait_for((self.folder / "run/fields/fields_00001.vtp").exists, process)
        for command in (("run", "small.toml", "--out", "run"), ("run", "small.toml", "--out", "run", "--force"),
                        ("resume", "run")):
            message = self.call(*command, expect=2).stderr
            self.assertIn("'run' is still going (process ", message)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=PATIENCE), 130)
        self.table("run/steps.csv")

    def test_of_a_killed_run_is_free(self):
        process = self.start("run", "small.toml", "--out", "run", "--quiet", *ENDLESS)
        self.wait_for((self.folder / "run/fields/fields_00001.vtp").exists, process)
        process.kill()
        process.wait()
        self.call("run", "small.toml", "--out", "run", "--quiet", "--force")
        self.assertFalse((self.folder / "run/.lock").exists())

    def test_an_empty_folder_will_do(self):
        (self.folder / "run").mkdir()
        self.call("run", "small.toml", "--out", "run", "--quiet")
        self.assertEqual(self.summary("run")["status"], "done")

    def test_a_file_in_its_place_is_refused(self):
        (self.folder / "run").write_text("mine")
        self.assertIn("'run' is a file", self.call("run", "small.toml", "--out", "run", expect=2).stderr)
        self.assertEqual((self.folder / "run").read_text(), "mine")


class Unwritable(ProgramTest):
    def test_a_place_where_no_folder_can_be(self):
        before = self.listing()
        for place in ("small.toml/run", "/proc/run"):
            with self.subTest(place):
                self.assertIn(f"'{place}'", self.call("run", "small.toml", "--out", place, expect=4).stderr)
        self.assertEqual(self.listing(), before)

    def test_a_disk_that_fills_up_ends_the_run_with_the_name_of_the_file(self):
        process = self.start("run", "small.toml", "--out", "run", "--quiet", *ENDLESS)
        self.wait_for((self.folder / "run/fields/fields_00002.vtp").exists, process)
        resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (1, 1))
        _, message = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 4)
        self.assertRegex(message, r"^error: cannot write 'run/.+': File too large\n$")
        for _, path in read_series(self.folder / "run/fields/fields.pvd"):
            read_points(path)


class Stopped(ProgramTest):
    def start_endless_run(self):
        process = self.start("run", "small.toml", "--out", "run", "--quiet", *ENDLESS)
        self.wait_for((self.folder / "run/fields/fields_00002.vtp").exists, process)
        return process

    def check_readable(self):
        for path in ("run/steps.csv", *(f"run/probes/{probe}.csv" for probe in PROBES)):
            _, rows = self.table(path)
            self.assertGreater(len(rows), 1)
        series = read_series(self.folder / "run/fields/fields.pvd")
        self.assertGreaterEqual(len(series), 2)
        for _, path in series:
            positions, _ = read_points(path)
            self.assertEqual(len(positions), 50)
        return series

    def test_interrupted_runs_end_in_order(self):
        for stop in (signal.SIGINT, signal.SIGTERM, signal.SIGUSR1):
            with self.subTest(stop):
                process = self.start_endless_run()
                process.send_signal(stop)
                self.assertEqual(process.wait(timeout=PATIENCE), 130)
                summary = self.summary("run")
                self.assertEqual((summary["status"], summary["exit_code"]), ("interrupted", 130))
                series = self.check_readable()
                self.assertEqual(series[-1][0], summary["time_s"]["reached"])
                _, steps = self.table("run/steps.csv")
                self.assertEqual(steps[-1][0], summary["time_s"]["reached"])
                (self.folder / "run").rename(self.folder / stop.name)

    def test_a_file_ends_a_run_in_order(self):
        process = self.start_endless_run()
        (self.folder / "run/STOP").touch()
        self.assertEqual(process.wait(timeout=PATIENCE), 130)
        self.assertEqual(self.summary("run")["status"], "interrupted")
        self.assertEqual(self.check_readable()[-1][0], self.summary("run")["time_s"]["reached"])
        self.assertFalse((self.folder / "run/STOP").exists())

    def test_a_stale_file_stops_nothing(self):
        (self.folder / "run").mkdir()
        (self.folder / "run/STOP").touch()
        self.call("run", "small.toml", "--out", "run", "--quiet", "--force")
        self.assertEqual(self.summary("run")["status"], "done")
        self.assertFalse((self.folder / "run/STOP").exists())

    def test_what_a_killed_run_wrote_can_be_read(self):
        process = self.start_endless_run()
        process.kill()
        process.wait(timeout=PATIENCE)
        self.check_readable()
        summary = self.summary("run")
        self.assertEqual((summary["status"], summary["exit_code"]), ("running", None))
        self.assertIn("tailwater resume run", summary["message"])
        info = self.call("info", "run")
        self.assertIn("killed; to continue: tailwater resume run", info.stdout)
        self.assertNotIn("time:      0 of", info.stdout)

    def test_lines_are_flushed_as_the_run_goes(self):
        process = self.start_endless_run()
        first = self.whole_lines("run/probes/energy.csv")
        self.wait_for(lambda: len(self.whole_lines("run/probes/energy.csv")) > len(first) + 10, process)


if __name__ == "__main__":
    unittest.main()
