"""run --sweep: a folder and a line of the table for each member, on from where it was stopped."""

import csv
import itertools
import signal
import unittest

from processes import processes_of
from program import ProgramTest

SPACINGS = ("0.1", "0.05")
SWEPT = ("--sweep", "particles.spacing=" + ",".join(SPACINGS))
SWEEP = ("run", "small.toml", "--out", "sweep", *SWEPT)
MEMBERS = tuple(f"particles.spacing={spacing}" for spacing in SPACINGS)

# The second member fails at its first step, the others have nothing to do with that.
FAILING = ("run", "small.toml", "--out", "sweep", "--sweep", "pressure_solver.max_iterations=500,1,400")


class Sweep(ProgramTest):
    def rows(self, sweep="sweep"):
        """The table as one dict per member."""
        with open(self.folder / sweep / "sweep.csv", newline="") as file:
            return list(csv.DictReader(file))

    def test_each_member_is_the_run_that_set_would_make_and_is_run_once(self):
        result = self.call(*SWEEP, "--jobs", "2", "--set", "time.end=0.05")
        self.assertIn("done: 2 members", result.stderr)
        self.assertRegex(result.stderr, r"\d+\.\d %  ETA ")
        for member, row, spacing in zip(MEMBERS, self.rows(), SPACINGS):
            self.call("run", "small.toml", "--out", member, "--quiet", "--set", f"particles.spacing={spacing}",
                      "--set", "time.end=0.05")
            for file in ("steps.csv", "probes/energy.csv", "case.effective.toml"):
                self.assertEqual((self.folder / "sweep" / member / file).read_bytes(),
                                 (self.folder / member / file).read_bytes())
            summary = self.summary(f"sweep/{member}")
            self.assertEqual((row["member"], row["particles.spacing"], row["status"], row["exit_code"]),
                             (member, spacing, "done", "0"))
            self.assertEqual(float(row["cpu_s"]), summary["cost"]["cpu_s"])
            self.assertEqual(int(row["steps"]), summary["steps"]["count"])
            self.assertEqual(float(row["density_error_rms"]), summary["volume"]["density_error_rms"])
            self.assertEqual(float(row["mass_inside_kg"]), summary["water_balance"]["inside"]["mass_kg"])
        self.assertIn(MEMBERS[1], self.call("info", "sweep").stdout)

        before = self.listing()
        self.assertIn("2 done already", self.call(*SWEEP, "--set", "time.end=0.05").stderr)
        self.call("resume", "sweep", "--quiet")
        after = self.listing()
        del before["sweep/log.txt"], after["sweep/log.txt"]
        self.assertEqual(before, after)

        # More values, the old ones are kept.
        wider = [*SWEEP[:-1], SWEEP[-1] + ",0.2"]
        self.assertIn("2 done already", self.call(*wider, "--set", "time.end=0.05").stderr)
        self.assertEqual([row["status"] for row in self.rows()], ["done"] * 3)

    def test_several_keys_make_the_product(self):
        self.call("run", "small.toml", "--out", "sweep", "--quiet", "--set", "time.end=0.01",
                  "--sweep", "fluid[0].max=[1,0.5],[1, 0.4]", "--sweep", "particles.seed=1,2")
        rows = self.rows()
        expected = itertools.product(("[1,0.5]", "[1, 0.4]"), ("1", "2"))
        self.assertEqual([(row["fluid[0].max"], row["particles.seed"]) for row in rows], list(expected))
        self.assertEqual([row["fluid_particles"] for row in rows], ["50", "50", "40", "40"])
        for row in rows:
            self.assertTrue((self.folder / "sweep" / row["member"] / "summary.json").exists())

    def test_a_member_that_fails_does_not_end_the_others_and_is_tried_again(self):
        result = self.call(*FAILING, "--quiet", expect=3, traps=False)
        self.assertRegex(result.stderr, "^error: sweep/pressure_solver.max_iterations=1: .*did not converge")
        self.assertEqual([row["status"] for row in self.rows()], ["done", "failed", "done"])
        self.assertIn("did not converge", self.rows()[1]["message"])
        result = self.call("resume", "sweep", expect=3, traps=False, errors_only=False)
        self.assertIn("2 done already", result.stderr)
        self.assertIn("2 of 3 members are done", result.stderr)

    def test_a_sweep_that_is_stopped_goes_on(self):
        for stop in (lambda process: process.send_signal(signal.SIGINT),
                     lambda _: (self.folder / "sweep/STOP").touch()):
            sweep = self.start(*SWEEP, "--set", "time.end=1000", "--set", "output.fields_interval=1")
            steps = self.folder / "sweep" / MEMBERS[0] / "steps.csv"
            self.wait_for(lambda: (self.folder / "sweep/sweep.csv").exists() and
                          self.rows()[0]["status"] == "running" and steps.exists() and
                          len(steps.read_text().splitlines()) > 20, sweep)
            self.call("resume", "sweep", expect=2)  # which is going on
            stop(sweep)
            _, told = sweep.communicate()
            self.assertEqual(sweep.returncode, 130, told)
            self.assertIn("tailwater resume sweep", told)
            self.assertEqual([row["status"] for row in self.rows()], ["interrupted", "waiting"])
        self.call("resume", f"sweep/{MEMBERS[0]}", "--quiet", "--set", f"time.end={self.rows()[0]['time_reached_s']}")
        self.call("resume", "sweep", "--quiet", "--wall-time", "0.5s", "--jobs", "2", expect=130, errors_only=False)
        self.assertEqual(self.rows()[0]["status"], "done")

    def test_steps_are_read_from_the_end_of_their_table_on_wherever_a_line_is_cut(self):
        self.call(*SWEEP, "--quiet", "--wall-time", "0.5s", expect=130, errors_only=False)
        line = "0.001," + ",".join(["nan"] * 50) + "\n"
        for zeros in range(4):  # the end begins with n, a, n or a comma
            end = "0.05" + zeros * "0" + "\n"
            (self.folder / "sweep" / MEMBERS[0] / "steps.csv").write_text("time_s\n" + 40 * line + end)
            self.call("resume", "sweep", "--quiet", "--wall-time", "0.5s", expect=130, errors_only=False)

    def test_members_end_with_the_sweep_that_is_killed(self):
        out = self.folder / "sweep"
        sweep = self.start("run", "small.toml", "--out", out, *SWEPT, "--set", "time.end=1000", "--set", "output.fields_interval=1")
        self.wait_for((out / MEMBERS[0] / "summary.json").exists, sweep)
        sweep.kill()
        sweep.wait()
        self.wait_for(lambda: not processes_of(out / MEMBERS[0]))
        self.assertIn(self.summary(f"sweep/{MEMBERS[0]}")["status"], ("interrupted", "running"))

    def test_what_is_wrong_is_refused_before_anything_is_written(self):
        before = self.listing()
        for option, said in (
                ("particles.spacng=1,2", r'--sweep particles.spacng=1: .*did you mean "spacing"'),
                ("particles.spacing=0.1,-1", r"--sweep particles.spacing=-1: .*give a number above 0"),
                ("particles.spacing=0.1,0.7", r"holds no particle of spacing 0.7 m.*particles.spacing=0.7"),
                ("particles.spacing=0.1,,0.2", "a value is missing"),
                ("particles.spacing=0.1,0.1", "twice"),
                ("particles.spacing", "a key or its values are missing"),
                ("particles.seed=" + ",".join(map(str, range(1001))), "more than 1000 members")):
            result = self.call("run", "small.toml", "--out", "sweep", "--sweep", option, expect=2)
            self.assertRegex(result.stderr, said)
        self.call(*SWEEP, "--sweep", "particles.spacing=0.2", expect=2)
        self.call(*SWEEP, "--set", "particles.spacing=0.2", expect=2)
        self.call(*SWEEP, "--jobs", "0", expect=2)
        self.call(*SWEEP, "--jobs", "100000", expect=2)
        self.call(*SWEEP, "--force", expect=2)
        self.call("run", "small.toml", "--out", "run", "--jobs", "2", expect=2)
        self.assertEqual(self.listing(), before)

        self.call("run", "small.toml", "--out", "run", "--quiet", "--set", "time.end=0.01")
        self.call("run", "small.toml", "--out", "run", "--sweep", "particles.seed=1,2", expect=2)
        small = ("run", "small.toml", "--out", "sweep", "--quiet", "--set", "time.end=0.01", "--sweep")
        self.call(*small, "particles.seed=1,2")
        before = self.listing()
        self.call(*small, "particles.seed=1,3", expect=2)
        self.call(*small, "particles.jitter=0.1,0.2", expect=2)
        changed = self.call(*small, "particles.seed=1,2", "--set", "time.end=0.02", expect=2)
        self.assertIn("[time] end = 0.01 instead of [time] end = 0.02", changed.stderr)
        self.call("resume", "sweep", "--set", "time.end=0.02", expect=2)
        self.assertEqual(self.listing(), before)


if __name__ == "__main__":
    unittest.main()
