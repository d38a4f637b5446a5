"""resume on several ranks."""

import os
import shutil
import signal
import unittest

import numpy as np

from processes import command_line, processes_of
from program import PATIENCE, ProgramTest
from resumed import assert_same_results

MPIRUN = os.environ["MPIRUN"]

# A small limit for the imbalance, so that the domain is divided anew during the run.
CASE = ("--set", "particles.spacing=0.05", "--set", "parallel.imbalance=0.01", "--quiet")
HALF, WHOLE = ("--set", "time.end=0.15"), ("--set", "time.end=0.3")


class Resumed(ProgramTest):
    def test_bit_for_bit_on_as_many(self):
        arguments = (*CASE, "-n", "2")
        self.call("run", "small.toml", "--out", "whole", *WHOLE, *arguments)
        self.call("run", "small.toml", "--out", "part", *HALF, *arguments)
        self.call("resume", "part", *WHOLE, "--quiet")
        self.assertEqual(self.summary("part")["ranks"]["count"], 2)
        assert_same_results(self, "part", "whole")
        self.assertGreater(self.summary("whole")["ranks"]["cuts"], self.cuts_at_half("whole"))

    def cuts_at_half(self, run):
        names, rows = self.table(f"{run}/ranks.csv")
        time, cut = names.index("time_s"), names.index("is_cut_anew")
        return sum(row[cut] for row in rows if row[time] < 0.15)

    def test_after_the_loss_of_the_terminal_the_launcher_and_mpirun(self):
        """Resumes on as many ranks as before, without an option."""
        out = self.folder / "run"
        endless = ("--set", "time.end=1000", "--set", "output.checkpoint_interval=0")
        process = self.start("run", "small.toml", "--out", out, *CASE, *endless, "-n", "2")
        self.wait_for((out / "fields/fields_00000.vtp").exists, process)
        process.send_signal(signal.SIGHUP)
        self.wait_for(lambda: list((out / "checkpoints").glob("*.h5")), process)
        for role in ("the launcher", "mpirun"):
            with self.subTest(role):
                launcher = process.pid
                mpirun = next(number for number in processes_of(out) if command_line(number)[0] == MPIRUN)
                os.kill(launcher if role == "the launcher" else mpirun, signal.SIGKILL)
                process.wait(timeout=PATIENCE)
                self.wait_for(lambda: not processes_of(out))
                steps = (out / "steps.csv").stat().st_size
                process = self.start("resume", out, "--quiet")
                self.wait_for(lambda before=steps: (out / "steps.csv").stat().st_size > before)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=PATIENCE), 130)
        self.assertEqual(self.summary("run")["ranks"]["count"], 2)

    def test_before_there_is_a_checkpoint_too(self):
        out = self.folder / "run"
        process = self.start("run", "small.toml", "--out", out, *CASE, "--set", "time.end=1000", "-n", "2")
        self.wait_for((out / "fields/fields_00000.vtp").exists, process)
        process.kill()
        process.wait()
        self.wait_for(lambda: not processes_of(out))
        # ranks that lose their launcher write a checkpoint if they can
        shutil.rmtree(out / "checkpoints", ignore_errors=True)
        self.call("resume", out, "--quiet", "--set", "time.end=0.01")
        self.assertEqual((self.summary("run")["status"], self.summary("run")["ranks"]["count"]), ("done", 2))

    def test_to_the_tolerance_of_the_solver_on_others(self):
        self.call("run", "small.toml", "--out", "whole", *WHOLE, *CASE)
        names, whole = self.table("whole/probes/energy.csv")
        for before, after in ((1, 2), (2, 1)):
            with self.subTest((before, after)):
                run = f"from{before}"
                self.call("run", "small.toml", "--out", run, *HALF, *CASE, "-n", before)
                self.call("resume", run, *WHOLE, "--quiet", "-n", after)
                summary = self.summary(run)
                self.assertEqual(summary["ranks"]["count"], after)
                self.assertEqual(summary["particles"], self.summary("whole")["particles"])
                _, rows = self.table(f"{run}/probes/energy.csv")
                self.assertEqual(len(rows), len(whole))
                # The pressure is solved to 1e-4, and within 0.15 s the flows cannot diverge.
                total = names.index("total_J")
                np.testing.assert_allclose([row[total] for row in rows], [row[total] for row in whole], rtol=1e-4)


if __name__ == "__main__":
    unittest.main()
