"""Obstacles for commands apart from the case itself: names that are not text, escape sequences, very long messages,
links, limits of the system, exhausted memory. The program must report each in one plain line, and never write through a
link or leave a partial file."""

import json
import os
import resource
import signal
import subprocess
import unittest

from program import PATIENCE, PROGRAM, SLOWDOWN, SMALL_CASE, ProgramTest, environment

CROSSED_PLATE = '[[wall]]\nshape = "plate"\npoints = [[0.3, 0.1], [0.6, 0.4], [0.6, 0.1], [0.3, 0.4]]\n[time]'
ENDLESS = ("--set", "time.end=1e4", "--set", "output.fields_interval=0.02")


class Messages(ProgramTest):
    def test_words_that_are_no_text_are_refused(self):
        before = self.listing()
        for words in ((b"run", b"small.toml", b"--out", b"o\xff"), (b"check", b"small.toml", b"--set", b"time.end=\xff"),
                      (b"check", b"a\nb.toml"), (b"new", b"tank", b"a\x1b[2J.toml"), (b"info", b"\xc2\x9b2J")):
            with self.subTest(words):
                result = subprocess.run([os.fsencode(PROGRAM), *words], cwd=self.folder, capture_output=True,
                                        timeout=PATIENCE, check=False)
                self.assertEqual(result.returncode, 2)
                self.assertRegex(result.stderr, rb"^error: word \d of the command line, \"[ -~]+\", has control")
                self.assertEqual(result.stderr.count(b"\n"), 1)
                self.assertNotIn(b"\x1b", result.stderr)
        self.assertEqual(self.listing(), before)

    def test_a_folder_whose_name_is_no_text(self):
        """Only a case that names files needs the folder's name as text."""
        odd = os.path.join(os.fsencode(self.folder), b"o\xff")
        os.mkdir(odd)
        with open(os.path.join(odd, b"case.toml"), "w", encoding="utf-8") as file:
            file.write(SMALL_CASE + '[[wall]]\nname = "a"\npoints_file = "bed.csv"\n')
        result = subprocess.run([PROGRAM, "check", "case.toml", "--no-preview"], cwd=odd, capture_output=True,
                                timeout=PATIENCE, check=False)
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, rb"^error: case.toml:\d+:\d+: wall\[1\].points_file = .*not UTF-8.*\n$")

    def test_numbers_of_python_commands_are_numbers(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        for words in (("waves", "run", "--from", "nan"), ("waves", "run", "--to", "inf"), ("waves", "run", "--depth", "0"),
                      ("pictures", "run", "--times", "nan"), ("pictures", "run", "--from", "nan", "1", "1")):
            with self.subTest(words):
                self.assertEqual(len(self.call(*words, expect=2).stderr.splitlines()), 1)

    def test_unknown_options_are_named_and_repeated_ones_take_one_value(self):
        for words in (("--nosuch",), ("check", "--nosuch"), ("bench", "--nosuch"), ("check", "small.toml", "--nosuch")):
            self.assertIn('unknown option "--nosuch"', self.call(*words, expect=2).stderr)
        told = self.call("check", "--help").stdout
        self.assertIn("--set KEY=VALUE ", told)
        self.assertNotIn("KEY=VALUE ...", told)
        self.assertIn("may be repeated", told)

    def test_the_same_is_told_once(self):
        (self.folder / "plate.toml").write_text(SMALL_CASE.replace("[time]", CROSSED_PLATE))
        lines = self.call("check", "plate.toml", "--no-preview", expect=2).stderr.splitlines()
        self.assertEqual(len(lines), 1, lines)
        self.assertIn("crosses itself at (0.45, 0.25)", lines[0])

    def test_what_others_have_written_cannot_steer_the_terminal(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        summary = self.folder / "run/summary.json"
        summary.write_text(summary.read_text().replace("Small dam break", "\\u001b[2Jcleared"))
        self.assertIn("\\x1B[2Jcleared", self.call("info", "run").stdout)

    def test_a_message_has_an_end(self):
        long = "x" * 20000
        for words in (("check", "small.toml", "--set", f"{long}=1"), ("check", "small.toml", "--set", f"time.end={long}"),
                      ("run", "small.toml", "--out", "run", "--set", f"probe.{long}.interval=1")):
            for line in self.call(*words, expect=2).stderr.splitlines():
                self.assertLess(len(line), 2100)
        text = SMALL_CASE.replace('"column"', f'"{long}"').replace("max = [1, 0.5]", "max = [1, 0.05]")
        (self.folder / "long.toml").write_text(text + f"[{long}]\n" + "[[wall]]\npoints = 3\n" * 300)
        error = self.call("check", "long.toml", expect=2).stderr
        self.assertLess(len(error), 20000)

    def test_a_case_that_fails_its_trial_is_not_called_valid(self):
        result = self.call("check", "small.toml", "--no-preview", "--set", "fluid[0].velocity=['100*x', 0]",
                           "--set", "pressure_solver.max_iterations=1", "--set", "pressure_solver.tolerance=1e-14",
                           expect=3, traps=False)
        self.assertIn("a trial step fails", result.stderr)
        self.assertEqual(result.stdout, "")


class Links(ProgramTest):
    def test_a_run_writes_through_none(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        precious = self.folder / "precious"
        precious.write_text("precious")
        for name in ("steps.csv", "log.txt", "summary.json", "case.effective.toml", "STOP"):
            with self.subTest(name):
                path = self.folder / "run" / name
                kept = path.read_bytes() if path.exists() else None
                path.unlink(missing_ok=True)
                path.symlink_to(precious)
                again = ("run", "small.toml", "--out", "run", "--force")
                self.assertIn("is a link", self.call(*again, "--quiet", expect=2).stderr)
                if name != "case.effective.toml":  # resume reads this file
                    self.assertIn("is a link", self.call("resume", "run", "--set", "time.end=0.2", expect=2).stderr)
                self.assertEqual(precious.read_text(), "precious")
                path.unlink()
                if kept is not None:
                    path.write_bytes(kept)

    def test_nor_through_those_of_probes_and_fields(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        precious = self.folder / "precious"
        precious.write_text("precious")
        for name in ("probes/depth.csv", "fields/fields_00000.vtp", "fields/fields.pvd.part"):
            with self.subTest(name):
                path = self.folder / "run" / name
                path.unlink(missing_ok=True)
                path.symlink_to(precious)
                error = self.call("run", "small.toml", "--out", "run", "--quiet", "--force", expect=4).stderr
                self.assertIn(f"{name}': a link is in its place", error)
                self.assertEqual(precious.read_text(), "precious")
                path.unlink()
        (self.folder / "elsewhere").mkdir()
        (self.folder / "linked").symlink_to("elsewhere")
        self.call("run", "small.toml", "--out", "linked", "--quiet")  # the run folder itself may be a link


class Sizes(ProgramTest):
    def check_as_json(self, text):
        """The findings of `check - --json`, within a few seconds and 2 GB."""
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))
        result = subprocess.run([PROGRAM, "check", "-", "--json"], cwd=self.folder, input=text, capture_output=True,
                                text=True, timeout=PATIENCE, preexec_fn=None if SLOWDOWN > 1 else limit, check=False)
        self.assertIn(result.returncode, (0, 2), result.stderr)
        return json.loads(result.stdout)["findings"]

    def test_a_probe_on_a_wall_without_end(self):
        wall = 'shape = "box"\nmin = [0, 0]\nmax = [3, 2e12]\nopen = ["+y"]\n'
        text = SMALL_CASE.replace("points = [[0, 2], [0, 0], [3, 0], [3, 2]]\n", wall)
        text = text.replace('type = "energy"', 'type = "force"')
        finding = self.check_as_json(text)[0]
        self.assertIn("GB of memory", finding["message"])
        self.assertIn("use a spacing of at least", finding["message"])

    def test_a_case_without_end_on_standard_input(self):
        with open("/dev/zero", "rb") as endless:
            result = subprocess.run([PROGRAM, "check", "-", "--json"], cwd=self.folder, stdin=endless, capture_output=True,
                                    text=True, timeout=PATIENCE, check=False)
        self.assertEqual(result.returncode, 2)
        self.assertIn("standard input has more than 262144 bytes", result.stderr)

    def test_a_run_whose_summary_is_a_pipe(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        (self.folder / "run/summary.json").unlink()
        os.mkfifo(self.folder / "run/summary.json")
        self.assertIn("a device or a pipe", self.call("info", "run", expect=4).stderr)


class Limits(ProgramTest):
    def refuse(self, kind, most, *words):
        def limit():
            resource.setrlimit(kind, (most, most))
        result = subprocess.run([PROGRAM, *words], cwd=self.folder, env=environment(), capture_output=True, text=True,
                                timeout=PATIENCE, preexec_fn=limit, check=False)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertRegex(result.stderr, "^error: this process may .*; remedy: ulimit .*\n$")
        self.assertFalse((self.folder / "run").exists())

    def test_too_few_open_files(self):
        self.refuse(resource.RLIMIT_NOFILE, 20, "run", "small.toml", "--out", "run")
        self.refuse(resource.RLIMIT_NOFILE, 40, "run", "small.toml", "--out", "run", "-n", "2")
        self.refuse(resource.RLIMIT_NOFILE, 20, "check", "small.toml")

    def test_files_that_may_not_be_large(self):
        self.refuse(resource.RLIMIT_FSIZE, 1 << 16, "run", "small.toml", "--out", "run")
        self.refuse(resource.RLIMIT_FSIZE, 1 << 16, "run", "small.toml", "--out", "run", "-n", "2")

    @unittest.skipIf(SLOWDOWN > 1, "sanitizers need the memory themselves")
    def test_when_memory_ends_the_summary_says_so(self):
        process = self.start("run", "small.toml", "--out", "run", "--quiet", *ENDLESS)
        self.wait_for((self.folder / "run/fields/fields_00002.vtp").exists, process)
        resource.prlimit(process.pid, resource.RLIMIT_AS, (1, 1))
        (self.folder / "run/CHECKPOINT").touch()  # a checkpoint needs more memory
        _, message = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 3, message)
        self.assertIn("memory", message)
        summary = self.summary("run")
        self.assertEqual((summary["status"], summary["exit_code"]), ("failed", 3))
        self.assertIn("memory", summary["message"])


class Names(ProgramTest):
    def test_a_run_killed_before_its_first_checkpoint_keeps_the_name_of_its_case(self):
        process = self.start("run", "small.toml", "--out", "run", "--quiet", *ENDLESS)
        self.wait_for((self.folder / "run/summary.json").exists, process)
        process.send_signal(signal.SIGKILL)
        process.communicate()
        self.assertFalse((self.folder / "run/checkpoints").exists())
        self.call("resume", "run", "--quiet", "--set", "time.end=0.05", "--set", "output.fields_interval=0.02")
        self.assertEqual(self.summary("run")["case"], "small.toml")


if __name__ == "__main__":
    unittest.main()
