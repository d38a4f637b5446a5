"""Runs on several ranks: how they start and how they end, normally or not."""

import os
import pathlib
import signal
import subprocess
import unittest
import unittest.mock

from frames import read_frames
from processes import command_line, processes_of
from program import PATIENCE, PROGRAM, SMALL_CASE, ProgramTest, environment

MPIRUN = os.environ["MPIRUN"]

# With this setting, Open MPI's mpirun forwards no signals to the ranks, as it does by default on some machines.
FORWARD_NOTHING = {"OMPI_MCA_ess_base_forward_signals": "none"}



class RanksTest(ProgramTest):
    def mpirun(self, *arguments, expect):
        """Runs several ranks as a user of mpirun does. Returns their messages."""
        result = subprocess.run([MPIRUN, "--quiet", *map(str, arguments)], cwd=self.folder, env=environment(),
                                stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=PATIENCE)
        self.assertEqual(result.returncode, expect, result.stdout + result.stderr)
        return result

    def processes(self):
        """Process ids of all processes that run a case into this test's folder."""
        return processes_of(self.folder / "out")

    def ranks(self, process):
        """Process ids of the ranks that `process`, the program as the user called it, has started through mpirun."""
        return [number for number in self.processes() if command_line(number)[:1] == [PROGRAM] and number != process.pid]

    def start_long_run(self, **variables):
        process = self.start("run", "small.toml", "--out", self.folder / "out", "-n", "2", "--set", "time.end=1000",
                             **variables)
        self.wait_for((self.folder / "out" / "fields" / "fields_00000.vtp").exists, process)
        return process

    def check_ended_in_order(self, process):
        _, error = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 130, error)
        self.assertIn("interrupted: results in", error)
        self.assertEqual(self.summary("out")["status"], "interrupted")
        self.assertEqual(self.table("out/steps.csv")[1][-1][0], self.summary("out")["time_s"]["reached"])
        self.assertFalse((self.folder / "out" / "STOP").exists())
        self.assertEqual(self.processes(), [])

    def test_starts_its_ranks(self):
        self.call("run", "small.toml", "--out", "two", "-n", "2", "--quiet")
        self.assertEqual(self.summary("two")["status"], "done")

    def test_many_start_together_and_leave_nothing(self):
        for count, ranks in ((30, "1"), (3, "2")):
            with self.subTest(ranks=ranks):
                (self.folder / ranks).mkdir()
                runs = [self.start("run", "small.toml", "--out", f"{ranks}/out{k}", "-n", ranks, "--quiet", "--set",
                                   "time.end=0.001", TMPDIR=str(self.folder / ranks)) for k in range(count)]
                for run in runs:
                    _, error = run.communicate(timeout=PATIENCE)
                    self.assertEqual((run.returncode, error), (0, ""))
                self.assertEqual({path.name for path in (self.folder / ranks).iterdir()},
                                 {f"out{k}" for k in range(count)})

    def test_one_rank_shares_no_folder_with_others(self):
        run = self.start("run", "small.toml", "--out", "one", "--quiet", TMPDIR="/dev/null")
        self.assertEqual((run.communicate(timeout=PATIENCE)[1], run.returncode), ("", 0))

    def test_write_frames_together(self):
        for run, ranks in (("one", "1"), ("two", "2")):
            self.call("run", "small.toml", "--out", run, "-n", ranks, "--quiet")
        one, two = (self.folder / run / "view" for run in ("one", "two"))
        self.assertEqual((one / "scene.json").read_bytes(), (two / "scene.json").read_bytes())
        frames = [read_frames(self.folder / run) for run in ("one", "two")]
        self.assertEqual(*([(frame.count, round(frame.time, 6)) for frame in of_run] for of_run in frames))

    def test_read_a_depth_beside_a_plate(self):
        (self.folder / "plate.toml").write_text("""
[particles]
spacing = 0.05
[[fluid]]
min = [0.0, 0.0]
max = [1.0, 0.5]
[[wall]]
points = [[0.0, 1.0], [0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]
[[wall]]
shape = "plate"
points = [[0.5, 0.0], [0.5, 0.3]]
[[probe]]
name = "beside"
type = "depth"
at = [0.45, 0.0]
[time]
end = 0.02
""")
        depths = []
        for count in "1", "2":
            self.call("run", "plate.toml", "--out", count, "-n", count, "--quiet")
            depths.append([row[1] for row in self.table(f"{count}/probes/beside.csv")[1]])
        self.assertEqual(len(depths[0]), len(depths[1]))
        for one, two in zip(*depths):
            self.assertAlmostEqual(one, two, delta=1e-4)  # the tolerance of the pressure solve

    def test_is_a_rank_of_mpirun(self):
        for count in ((), ("-n", "2")):
            self.mpirun("-n", "2", PROGRAM, "run", "small.toml", "--out", "out", "--force", "--quiet", *count, expect=0)
            self.assertEqual(self.summary("out")["status"], "done")

    def test_refuses_wrong_counts_before_anything(self):
        for count, answer in (("0", "at least one rank"), ("-1", "at least one rank"), ("100000", "at most ")):
            error = self.call("run", "small.toml", "--out", "out", f"-n{count}", expect=2).stderr
            self.assertIn(answer, error)
        error = self.mpirun("-n", "2", PROGRAM, "run", "small.toml", "--out", "out", "-n", "3", expect=2).stderr
        self.assertEqual(len(error.splitlines()), 1, error)
        self.assertIn("leave -n out", error)
        self.assertFalse((self.folder / "out").exists())

    def test_other_commands_refuse_ranks(self):
        error = self.mpirun("-n", "2", PROGRAM, "check", "small.toml", expect=2).stderr
        self.assertEqual(len(error.splitlines()), 1, error)
        self.assertIn("tailwater check without mpirun", error)

    def test_an_error_of_all_is_told_once(self):
        error = self.call("run", "missing.toml", "--out", "out", "-n", "2", expect=4).stderr
        self.assertEqual(len(error.splitlines()), 1, error)
        error = self.call("run", "small.toml", "--out", "out", "-n", "2", "--set", "particles.spcing=1",
                          expect=2).stderr
        self.assertEqual(len(error.splitlines()), 1, error)
        self.assertIn('did you mean "spacing"?', error)

    def test_an_error_of_one_rank_ends_all(self):
        out = ("--out", "out", "--quiet")
        error = self.mpirun("-n", "1", PROGRAM, "run", "small.toml", *out, ":",
                            "-n", "1", PROGRAM, "run", "missing.toml", *out, expect=4).stderr
        self.assertIn("error: rank 1: missing.toml", error)

    def test_interrupt_ends_all_in_order(self):
        for stop in (signal.SIGINT, signal.SIGTERM, signal.SIGUSR1):
            with self.subTest(stop):
                process = self.start_long_run(**FORWARD_NOTHING)
                self.assertGreaterEqual(len(self.processes()), 4)  # the program, mpirun, two ranks
                process.send_signal(stop)
                self.check_ended_in_order(process)
                (self.folder / "out").rename(self.folder / stop.name)

    def test_a_file_ends_all_in_order(self):
        process = self.start_long_run(**FORWARD_NOTHING)
        (self.folder / "out" / "STOP").touch()
        self.check_ended_in_order(process)

    def test_a_second_interrupt_ends_all_at_once(self):
        process = self.start_long_run(**FORWARD_NOTHING)
        ranks = self.ranks(process)
        self.assertEqual(len(ranks), 2)
        for rank in ranks:
            os.kill(rank, signal.SIGSTOP)  # stopped ranks see no request
        message = self.call("run", "small.toml", "--out", self.folder / "out", "--force", expect=2).stderr
        self.assertIn("is still going (process ", message)
        process.send_signal(signal.SIGINT)
        self.wait_for((self.folder / "out" / "STOP").exists, process)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=PATIENCE), 130)
        self.wait_for(lambda: not self.processes())
        self.assertFalse((self.folder / "out" / "STOP").exists())

    def test_an_interrupt_before_anything_is_written_ends_all_at_once(self):
        """Ranks that still create half a million particles have not touched the results of an earlier run. On a fast
        machine the signal may come just after that; the new run then reports that it had begun."""
        self.call("run", "small.toml", "--out", "out", "--quiet")
        before = self.summary("out")
        process = self.start("run", "small.toml", "--out", self.folder / "out", "--force", "-n", "2", "--set",
                             "particles.spacing=0.001", **FORWARD_NOTHING)
        self.wait_for(lambda: len(self.ranks(process)) == 2, process)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=PATIENCE), 130)
        self.wait_for(lambda: not self.processes())
        if self.summary("out") != before:
            self.assertIn(self.summary("out")["status"], ("running", "interrupted"))
        self.assertFalse((self.folder / "out" / "STOP").exists())

    def test_no_rank_outlives_the_program(self):
        process = self.start_long_run()
        process.kill()
        process.wait()
        self.wait_for(lambda: not self.processes())


def cores():
    """Number of physical cores that this test may use."""
    topology = "/sys/devices/system/cpu/cpu{}/topology/thread_siblings_list"
    return len({pathlib.Path(topology.format(processor)).read_text() for processor in os.sched_getaffinity(0)})


def is_limited():
    """Whether a control group grants less time than the processors have."""
    limit = pathlib.Path("/sys/fs/cgroup/cpu.max")
    return limit.exists() and not limit.read_text().startswith("max")


class RanksByDefault(ProgramTest):
    """large.toml has enough water for two ranks. wrong.toml has the same water twice and ends before it makes a
    flow."""

    TOLD = "on 2 ranks; -n 1 for one"

    def setUp(self):
        super().setUp()
        large = SMALL_CASE.replace("spacing = 0.1", 'spacing = "1/450"').replace("end = 0.1", "end = 1e-6")
        (self.folder / "large.toml").write_text(large)
        (self.folder / "wrong.toml").write_text(large + '[[fluid]]\nname = "again"\nmin = [0, 0]\nmax = [1, 0.5]\n')

    def told(self, *words, case="wrong.toml", **options):
        return self.call("run", case, "--out", "out", *words, expect=2, errors_only=False, **options).stderr

    @unittest.skipIf(cores() < 2 or is_limited(), "one core")
    def test_are_as_many_as_cores(self):
        self.assertIn(self.TOLD, self.call("run", "large.toml", "--out", "out").stderr)
        self.assertEqual(self.summary("out")["ranks"]["count"], 2)
        self.assertIn(self.TOLD, self.told())
        self.assertNotIn("ranks", self.told("--quiet"))

    def test_are_one_where_that_was_asked_for(self):
        self.assertNotIn("ranks", self.told("-n", "1"))

    def test_are_one_for_little_water(self):
        self.assertNotIn("ranks", self.told("--set", "particles.spacing=0.005"))

    def test_are_no_more_than_the_cores_that_the_program_may_use(self):
        one = min(os.sched_getaffinity(0))
        self.assertNotIn("ranks", self.told(preexec_fn=lambda: os.sched_setaffinity(0, {one})))

    def test_are_one_where_somebody_else_starts_them(self):
        for variable in ("OMPI_COMM_WORLD_SIZE", "SLURM_STEP_NUM_TASKS", "SLURM_JOB_ID"):
            with self.subTest(variable), unittest.mock.patch.dict(os.environ, {variable: "1"}):
                self.assertNotIn("ranks", self.told())

    def test_are_one_for_a_member_of_a_sweep(self):
        self.call("run", "large.toml", "--out", "sweep", "--sweep", "particles.seed=1", "--jobs", "1", "--quiet")
        self.assertEqual(self.summary("sweep/particles.seed=1")["ranks"]["count"], 1)


if __name__ == "__main__":
    unittest.main()
