"""resume: a run that was stopped, killed or done continues as if it had not been interrupted."""

import os
import random
import resource
import shutil
import signal
import time
import unittest
import zlib

from fields import read_points, read_series
from program import PATIENCE, ProgramTest
from resumed import assert_same_results

HALF, WHOLE = "time.end=0.2", "time.end=0.4"
FIELDS = ("--set", "output.fields_interval=0.02", "--set", "output.view_interval=0.01")
OFTEN = ("--set", "output.checkpoint_interval=0.001")
GATE = ("--set", 'wall=[{points=[[0, 2], [0, 0], [3, 0], [3, 2]]}, '
        '{points=[[1, 0], [1, 2]], displacement=["0", "1.5*t"]}]')
OUTLET = ("--set", "wall[0].points=[[0, 2], [0, 0], [1.3, 0]]", "--set",
          "outlet=[{name='end', from=[1.3, 0], to=[1.3, 2]}]", "--set", "fluid[0].velocity=[3, 0]")
WAVES = ("--set", "wall[0].points=[[-0.5, 2], [-0.5, 0], [3, 0], [3, 2]]", "--set",
         "wave_maker=[{from=[0, 0], to=[0, 1.5], depth=0.5, waves='regular', height=0.05, period=0.8, ramp=0.1, "
         "absorption='active'}]",
         "--set", "damping=[{min=[0.5, 0], max=[1, 1], strength=5, waves='regular', height=0.05, period=0.8, depth=0.5, "
         "level=0.5}]")
ROLL = ("--set", "wall[0].motion='roll.csv'")
FLUME = ("--set", "wall[0].points=[[0, 0], [1.3, 0]]", "--set", "fluid[0].velocity=[1, 0]", "--set",
         "fluid[0].max=[1.3, 0.5]", "--set", "inlet=[{name='in', from=[0, 0], to=[0, 2], discharge='0.5+0.1*sin(30*t)', "
         "water_from='end', reserve=0.05}]",
         "--set", "outlet=[{name='end', from=[1.3, 0], to=[1.3, 2], level=0.5}]", "--set",
         "probe=[{name='middle', type='discharge', from=[0.6, 0], to=[0.6, 2]}, {name='volume', type='volume'}, "
         "{name='level', type='level-map', from=[0, 0], to=[1.3, 0], step=0.1}, {name='gauge', type='depth', at=[0.6, 0]}, "
         "{name='wetted', type='run-up', region_min=[0, 0], region_max=[1, 1]}, "
         "{name='speeds', type='velocity-profile', at=[0.6, 0], interval=0.02}]")
BARGE = ("--set", "wall=[{points=[[0, 2], [0, 0], [3, 0], [3, 2]]}, {name='hull', shape='box', min=[0.2, 0.3], "
         "max=[1, 1.1], fluid_side='outside'}]", "--set", "body=[{name='barge', walls=['hull'], mass=160, "
         "centre=[0.6, 0.6], inertia=[17]}]", "--set", "mooring=[{body='barge', at=[0.2, 0.3], anchor=[0, 0], "
         "stiffness=100}]", "--set", "probe=[{name='barge', type='motion', body='barge'}, {name='energy', "
         "type='energy'}]")
SUNK = ("--set", "wall=[{points=[[0, 2], [0, 0], [3, 0], [3, 2]]}, {name='hull', shape='polygon', points=[[0.6, 0], "
        "[0.9, 0.3], [0.6, 0.6], [0.3, 0.3]], fluid_side='outside'}]", "--set", "physics.tension=1e4", "--set",
        "probe=[{name='lift', type='force', walls=['hull']}, {name='all', type='pressure-map', averaging_time=0.02}]")
POCKET = ("--set", "wall=[{shape='box', min=[0, 0], max=[3, 2]}, {name='hull', shape='box', min=[0.2, 0.3], "
          "max=[1, 1.1], fluid_side='outside'}]", "--set", "body=[{name='barge', walls=['hull'], mass=160, "
          "centre=[0.6, 0.6], inertia=[17]}]", "--set", "air={pockets='adiabatic', pressure=1000}",
          "--set", "pocket=[{at=[2.9, 1.9], overpressure=-50}]", "--set", "vent=[{at=[2.9, 1.9], area=0.01}]", "--set",
          "probe=[{name='air', type='pockets'}, {name='seldom', type='pockets', interval=0.015}]",
          "--set", "fluid[0].velocity=[1, 0]")
ROCK = ("--set", "porous=[{min=[0.8, -1], max=[1.3, 2], porosity=0.5, grain_size=0.05}]", "--set",
        "fluid[0].velocity=[1, 0]")
LAYERS = ("--set", "liquid=[{name='brine', density=1050, viscosity=1e-3}, {name='mud', rheology='bingham', viscosity=1, "
          "yield_stress=5}]", "--set", "fluid=[{min=[0, 0], max=[1, 0.2], liquid='mud'}, "
          "{min=[0, 0.2], max=[0.5, 0.5], liquid='brine'}]", "--set",
          "probe=[{name='level', type='depth', at=[0.6, 0], liquid='mud'}, {name='front', type='front', liquid='brine'}]")
SLIDE = ("--set", "liquid=[{name='mud', rheology='bingham', viscosity=100, yield_stress=2000}]", "--set",
         "fluid=[{min=[0, 0], max=[1, 0.5], liquid='mud', velocity=[1, 0]}]", "--set",
         "wall=[{points=[[0, 2], [0, 0], [3, 0], [3, 2]], slip='coulomb', friction=0.3}]", "--set",
         "probe=[{name='bed', type='force'}, {name='front', type='front'}]")
LOCK = ("--set", "liquid=[{name='brine', density=1050, viscosity=1e-3}, {name='water', viscosity=1e-3}]", "--set",
        "fluid=[{min=[0, 0], max=[0.5, 0.5], liquid='brine'}, {min=[0.5, 0], max=[1, 0.5], liquid='water'}]", "--set",
        "wall=[{shape='box', min=[0, 0], max=[1, 0.5]}]")
WEDGE = ("--set", "liquid=[{name='brine', density=1050, viscosity=1e-3}, {name='water', viscosity=1e-3}]", "--set",
         "fluid=[{min=[0, 0], max=[0.1, 0.2], liquid='brine'}, {min=[0.1, 0], max=[1, 0.2], liquid='water'}, "
         "{min=[0, 0.2], max=[1, 0.5], liquid='water'}]", "--set",
         "wall=[{points=[[0, 2], [0, 0.2]]}, {points=[[0, 0], [1, 0], [1, 2]]}]", "--set",
         "inlet=[{from=[0, 0], to=[0, 0.2], discharge=0.3}]")
CUBE = ("--set", "case.dimension=3", "--set", "physics.gravity=[0, 0, -9.81]", "--set",
        "fluid=[{min=[0, 0, 0], max=[0.5, 0.3, 0.3]}]", "--set",
        "wall=[{shape='box', min=[0, 0, 0], max=[0.8, 0.3, 0.6], open=['+z']}]", "--set",
        "probe=[{name='energy', type='energy'}, {name='force', type='force', moment_about=[0, 0, 0]}, "
        "{name='map', type='pressure-map'}, {name='run_up', type='run-up'}, "
        "{name='level', type='level-map', from=[0, 0, 0], to=[0.8, 0.3, 0], step=0.1}, "
        "{name='speeds', type='velocity-profile', at=[0.2, 0.1, 0], interval=0.02}]")

# Every feature whose state a run carries from step to step; all runs have warned before their first checkpoint.
FEATURES = {
    "implicit integrator and a gate": ("--set", "scheme.integrator=implicit", *GATE),
    "a wave maker that absorbs, and a zone of waves": WAVES,
    "a tank that a file rolls": ROLL,
    "water that enters a porous layer": ROCK,
    "two liquids": LAYERS,
    "mud that slides on its bed": SLIDE,
    "two liquids in a full box": LOCK,
    "brine that enters under water": WEDGE,
    "a zone of refinement that water enters": ("--set", "refinement=[{min=[0.8, -1], max=[9, 9]}]"),
    "a zone of refinement that moves through the water": (
        "--set", "refinement=[{min=[0.1, -1], max=[1.0, 9], displacement=['0.5*t', 0]}]"),
    "a body that floats on a line": BARGE,
    "a hull on the bed, in water under tension": SUNK,
    "two-step scheme and an outlet that lets water go": ("--set", "scheme.name=farmani2020", *OUTLET),
    "an inlet, a tailwater whose water circulates, and a discharge probe": FLUME,
    "three dimensions and multigrid": (*CUBE, "--set", "pressure_solver.preconditioner=gamg"),
    "a pocket of air that leaves through a vent, and a body beside it": POCKET,
    "a published formulation": ("--set", "scheme.name=farmani2020", "--set", "scheme.formulation=published"),
}
WARN = ("--set", "limits.volume_warning=1e-9")


class Resumed(ProgramTest):
    def setUp(self):
        super().setUp()
        case = self.folder / "small.toml"
        (self.folder / "roll.csv").write_text("t [s], x [mm], angle [deg]\n" + "".join(
            f"{0.02 * k}, {0.1 * k * k}, {0.05 * k * k}\n" for k in range(25)))
        # Probes with their own interval and with times, beside those of every step.
        case.write_text(case.read_text() + '[[probe]]\nname = "seldom"\ntype = "energy"\ninterval = 0.03\n'
                        '[[probe]]\nname = "force"\ntype = "force"\nmoment_about = [0, 0]\n'
                        '[[probe]]\nname = "map"\ntype = "pressure-map"\ninterval = 0.01\n'
                        '[[probe]]\nname = "push"\ntype = "wall-pressure"\nat = [0.3, 0]\ninterval = 0.015\n')

    def run_case(self, run, *arguments, **options):
        return self.call("run", "small.toml", "--out", run, "--quiet", "--set", "particles.jitter=0.1", *FIELDS,
                         *arguments, **options)

    def start_endless_run(self, *arguments):
        """Starts a run and waits until it has a checkpoint and a few field files."""
        process = self.start("run", "small.toml", "--out", "run", "--quiet", "--set", "time.end=1000", "--set",
                             "output.fields_interval=0.05", "--set", "output.view_interval=0.01", *arguments)
        self.wait_for((self.folder / "run/fields/fields_00002.vtp").exists, process)
        return process

    def checkpoints(self, run="run"):
        return sorted((self.folder / run / "checkpoints").glob("*.h5"))


class BitForBit(Resumed):
    def test_with_every_feature(self):
        for k, (feature, arguments) in enumerate(FEATURES.items()):
            with self.subTest(feature):
                self.run_case(f"whole{k}", "--set", WHOLE, *arguments, *WARN)
                self.run_case(f"part{k}", "--set", HALF, *arguments, *WARN)
                self.assertNotEqual(self.summary(f"part{k}")["warnings"], [])
                self.call("resume", f"part{k}", "--set", WHOLE, "--quiet")
                assert_same_results(self, f"part{k}", f"whole{k}")
        for part, end in (("out", "outlet"), ("in", "inlet")):
            k = next(k for k, feature in enumerate(FEATURES) if f"an {end}" in feature)
            self.assertGreater(self.summary(f"whole{k}")["water_balance"][part]["particles"], 0)
        # Resuming a completed run changes no result.
        self.call("resume", "part0", "--quiet")
        assert_same_results(self, "part0", "whole0")

    def test_to_a_later_end_that_takes_a_tank_farther_keeps_its_air(self):
        """The grid in which air is searched for contains all places of the tank until the end."""
        tank = ("--set", "wall=[{shape='box', min=[0, 0], max=[1, 1], displacement=['-2*t', '0']}]", "--set",
                "air.pockets=adiabatic")
        self.run_case("run", "--set", "time.end=0.1", *tank)
        self.call("resume", "run", "--set", "time.end=0.4", "--quiet")
        pockets = self.summary("run")["pockets"]
        self.assertEqual((pockets["begun"], pockets["gas_lost_m3"]), (1, 0.0))

    def test_a_time_step_that_collapses_is_compared_with_the_first(self):
        """The gate accelerates and then jumps away. The first step is 0.01 s, that at half time 2 ms, the last 9 us.
        Compared with the step at half time, the last step would never be too small."""
        gate = ("--set", "particles.spacing=0.0025", "--set", "fluid[0].max=[0.02, 0.02]", "--set",
                "physics.gravity=[0, -0.01]", "--set", 'wall=[{points=[[0, 0.2], [0, 0], [0.6, 0], [0.6, 0.2]]}, '
                '{points=[[0.1, 0], [0.1, 0.2]], displacement=["0", "2*t^2 + 145*max(0, t - 0.3)"]}]')
        self.run_case("part", "--set", HALF, *gate)
        self.call("resume", "part", "--set", WHOLE, "--quiet", expect=3)
        self.run_case("whole", "--set", WHOLE, *gate, expect=3)
        messages = [self.summary(run)["message"].replace(f"{run}/", "") for run in ("part", "whole")]
        self.assertIn("the time step collapsed", messages[0])
        self.assertEqual(*messages)

    def test_from_a_stop_in_mid_run(self):
        process = self.start_endless_run()
        (self.folder / "run/STOP").touch()
        self.assertEqual(process.wait(timeout=PATIENCE), 130)
        log = (self.folder / "run/log.txt").read_text()
        end = ("--set", f"time.end={self.summary('run')['time_s']['reached'] + 0.1}")
        self.call("resume", "run", *end, "--quiet")
        self.assertTrue((self.folder / "run/log.txt").read_text().startswith(f"{log}going on from step "))
        self.call("run", "small.toml", "--out", "whole", "--quiet", *end, "--set", "output.fields_interval=0.05",
                  "--set", "output.view_interval=0.01")
        assert_same_results(self, "run", "whole")
        self.assertEqual(self.summary("run")["cost"]["runs"], 2)

    def test_after_a_kill_before_the_first_checkpoint_from_the_start(self):
        process = self.start_endless_run()
        process.kill()
        process.wait(timeout=PATIENCE)
        self.assertEqual(self.checkpoints(), [])
        result = self.call("resume", "run", "--set", WHOLE)
        self.assertIn("starting again", result.stderr)
        self.assertEqual(self.summary("run")["status"], "done")
        _, steps = self.table("run/steps.csv")
        self.assertEqual([row[1] for row in steps], list(range(1, len(steps) + 1)))


class Checkpoints(Resumed):
    def test_two_are_kept(self):
        self.run_case("run", "--set", HALF, *OFTEN)
        self.assertEqual(len(self.checkpoints()), 2)
        for path in self.checkpoints():
            self.assertTrue(path.read_bytes()[512:].startswith(b"\x89HDF"))

    def test_a_file_or_the_loss_of_the_terminal_asks_for_one_and_the_run_goes_on(self):
        process = self.start_endless_run()
        request = self.folder / "run/CHECKPOINT"
        request.touch()
        self.wait_for(lambda: not request.exists(), process)
        first = self.checkpoints()
        self.assertEqual(len(first), 1)
        # A second request within ten steps would find the checkpoint already written.
        written_step = int(first[0].stem.removeprefix("step_"))
        step_column = 1
        self.wait_for(lambda: float(self.whole_lines("run/steps.csv")[-1].split(",")[step_column]) > written_step + 10,
                      process)
        process.send_signal(signal.SIGHUP)
        self.wait_for(lambda: len(self.checkpoints()) == 2, process)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=PATIENCE), 130)

    def test_the_wall_time_ends_a_run_with_one(self):
        self.run_case("run", "--set", "time.end=1000", "--wall-time", "0.3s", expect=130, errors_only=False)
        self.assertEqual(self.summary("run")["status"], "interrupted")
        # On a very busy machine the time may be over before the first step; then there is nothing to save.
        self.assertEqual(len(self.checkpoints()), min(1, self.summary("run")["steps"]["count"]))
        for wrong in ("soon", "3", "-1h", "0s", "1:30", "3h5"):
            with self.subTest(wrong):
                self.assertIn(f"--wall-time {wrong}", self.run_case("no", f"--wall-time={wrong}", expect=2).stderr)

    def test_a_damaged_one_gives_way_to_the_older(self):
        self.run_case("run", "--set", HALF, *OFTEN)
        self.run_case("whole", "--set", WHOLE, *OFTEN)
        older, newer = self.checkpoints()
        content = bytearray(newer.read_bytes())
        random.seed(1)
        for name, damage in (("bits", self.flip), ("truncation", lambda b: b[:len(b) // 2]), ("nothing", lambda b: b"")):
            with self.subTest(name):
                shutil.copytree(self.folder / "run", self.folder / name)
                self.checkpoints(name)[1].write_bytes(damage(content))
                result = self.call("resume", name, "--set", WHOLE)
                self.assertRegex(result.stderr, rf"warning: checkpoint '{name}/checkpoints/{newer.name}' is damaged")
                self.assertIn(f"continuing from '{name}/checkpoints/{older.name}'", result.stderr)
                assert_same_results(self, name, "whole", apart_from=("warnings", ))
                self.assertIn(newer.name, *self.summary(name)["warnings"])
        self.assertNotEqual(older, newer)

    def flip(self, content):
        damaged = bytearray(content)
        damaged[random.randrange(len(damaged))] ^= 1 << random.randrange(8)
        return damaged

    def test_if_none_is_whole_nothing_is_touched(self):
        self.run_case("run", *OFTEN)
        for path in self.checkpoints():
            path.write_bytes(self.flip(path.read_bytes()))
        before = self.listing()
        message = self.call("resume", "run", expect=4).stderr
        for path in self.checkpoints():
            self.assertIn(path.name, message)
        self.assertIn("--force", message)
        self.assertEqual(self.listing(), before)


class Refused(Resumed):
    def setUp(self):
        super().setUp()
        self.run_case("run", "--set", HALF)
        self.before = self.listing()

    def refuse(self, *arguments, parts, untouched=True):
        message = self.call("resume", *arguments, expect=2).stderr
        for part in parts:
            self.assertIn(part, message)
        if untouched:
            self.assertEqual(self.listing(), self.before)

    def test_a_key_that_would_change_results(self):
        for change, key in (("scheme.courant=0.1", "courant"), ("particles.spacing=0.05", "spacing"),
                            ("probe=[]", "probe"), ("output.fields=['id']", "fields")):
            with self.subTest(change):
                self.refuse("run", "--set", change, parts=("--set", key, "time.end", "output.fields_interval"))
        self.call("resume", "run", "--set", "particles.spacing=0.1", "--quiet")  # the same value as before

    def test_an_end_that_the_run_has_passed(self):
        self.refuse("run", "--set", "time.end=0.01", parts=("time.end = 0.01 s", "which the run has reached"))

    def test_an_end_after_that_of_a_series(self):
        self.run_case("rolls", "--set", HALF, *ROLL)
        self.before = self.listing()
        self.refuse("rolls", "--set", "time.end=1", parts=("roll.csv:26", "t = 0.48 s", "the run ends at 1 s",
                                                           "start another run with a longer file"))

    def test_a_folder_that_is_no_runs(self):
        (self.folder / "other").mkdir()
        self.before = self.listing()
        for folder in ("other", "nowhere"):
            self.refuse(folder, parts=(f"'{folder}'", "case.effective.toml", "--out"))

    def test_a_checkpoint_of_another_case(self):
        self.run_case("other", "--set", HALF, "--set", "scheme.courant=0.2")
        for path in self.checkpoints("run"):
            path.unlink()
        shutil.copy(self.checkpoints("other")[0], self.folder / "run/checkpoints")
        self.before = self.listing()
        self.refuse("run", parts=("other case", "courant = 0.55", "courant = 0.2", self.checkpoints("run")[0].name))

    def test_an_older_format(self):
        path = self.checkpoints("run")[0]
        content = path.read_bytes()
        head, body = content[:512].decode(), content[512:]
        lines = head.splitlines()[:4]
        lines[0] = "tailwater checkpoint, format 0"
        lines[1] = "written by tailwater 0.0.1 (commit abc)"
        text = "".join(f"{line}\n" for line in lines)
        head = f"{text}crc32 {zlib.crc32(body, zlib.crc32(text.encode())):08x}\n"
        path.write_bytes(head.ljust(512).encode() + body)
        self.before = self.listing()
        self.refuse("run", parts=(path.name, "format 0", "reads format 28", "tailwater 0.0.1 (commit abc)"))

    def test_tables_that_do_not_go_with_the_checkpoint(self):
        (self.folder / "run/steps.csv").write_text("time_s\n")
        self.assertIn("run/steps.csv", self.call("resume", "run", "--set", WHOLE, expect=4).stderr)


class Faults(Resumed):
    """Runs that cannot finish because of the machine: exit code 4, and the files that were written are usable."""

    def check_ended(self, process, message):
        _, errors = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 4, errors)
        self.assertRegex(errors, message)

    def check_resumable(self):
        self.call("resume", "run", "--set", "time.end=1000", "--wall-time", "0.3s", expect=130, errors_only=False)
        _, steps = self.table("run/steps.csv")
        self.assertEqual([row[1] for row in steps], list(range(1, len(steps) + 1)))

    def test_kills_at_random_moments(self):
        """A short version of scripts/kill_study.py."""
        random.seed(int.from_bytes(os.urandom(4), "little"))
        process = self.start("run", "small.toml", "--out", "run", "--quiet", "--set", "time.end=1000", *FIELDS, *OFTEN)
        self.wait_for(lambda: self.checkpoints(), process)
        reached = 0
        for _ in range(4):
            time.sleep(0.3 * random.random())
            process.kill()
            process.wait(timeout=PATIENCE)
            names = [path.name for path in self.checkpoints()]
            self.assertGreaterEqual(int(names[-1][5:-3]), reached)
            reached = int(names[-1][5:-3])
            process = self.start("resume", "run", "--quiet")
            self.wait_for(lambda: [path.name for path in self.checkpoints()] != names, process)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=PATIENCE), 130)
        end = ("--set", f"time.end={self.summary('run')['time_s']['reached'] + 0.05}")
        self.call("resume", "run", "--quiet", *end)
        self.call("run", "small.toml", "--out", "whole", "--quiet", *end, *FIELDS, *OFTEN)
        assert_same_results(self, "run", "whole")

    def test_a_full_disk(self):
        process = self.start_endless_run(*OFTEN)
        self.wait_for(lambda: len(self.checkpoints()) == 2, process)
        # Space for the summary only.
        resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (8192, 8192))
        self.check_ended(process, r"^error: cannot write 'run/.+': File too large\n$")
        summary = self.summary("run")
        self.assertEqual((summary["status"], summary["exit_code"]), ("failed", 4))
        self.assertIn("File too large", summary["message"])
        for _, path in read_series(self.folder / "run/fields/fields.pvd"):
            read_points(path)
        self.check_resumable()

    def test_a_folder_that_is_moved_away(self):
        process = self.start_endless_run(*OFTEN)
        self.wait_for(lambda: len(self.checkpoints()) == 2, process)
        (self.folder / "run").rename(self.folder / "away")
        self.check_ended(process, r"^error: cannot (write|make the folder) 'run/.+': No such file or directory\n$")
        (self.folder / "away").rename(self.folder / "run")
        self.check_resumable()

    def test_a_folder_that_is_removed_without_a_file_being_due(self):
        process = self.start("run", "small.toml", "--out", "run", "--quiet", "--set", "time.end=1000", "--set",
                             "probe=[]", "--set", "output.fields_interval=1000")
        self.wait_for((self.folder / "run/steps.csv").exists, process)
        shutil.rmtree(self.folder / "run", ignore_errors=True)
        self.check_ended(process, r"^error: cannot write 'run/.+': No such file or directory\n$")


if __name__ == "__main__":
    unittest.main()
