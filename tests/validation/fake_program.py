"""A program that only pretends to run cases, for the tests of the commands that make runs."""

import contextlib
import io
import os
import tempfile
import unittest
from pathlib import Path

# Writes the least that a run leaves, or a copy of the folder $FAKE_RUN; as a page, only the report. A run whose command line holds the word given by
# $FAKE_FAILS fails, one that holds $FAKE_REFUSES is bad input; one that holds $FAKE_WAITS sleeps until it is interrupted.
FAKE = """\
#!/usr/bin/python3
import json, os, pathlib, shutil, sys, time
here = pathlib.Path(__file__)
if sys.argv[1] == "--version":
    print("tailwater 9.9.9 (commit " + here.with_name("commit").read_text() + ")")
    sys.exit()
line = " ".join(sys.argv)
if sys.argv[1] == "check":
    if "bogus" in line:
        print("error: unknown key bogus", file=sys.stderr)
        sys.exit(2)
    sys.exit()
if sys.argv[1] == "view":  # OUT --export FILE
    if os.environ.get("FAKE_FAILS") == "--export":
        print("error: made to fail", file=sys.stderr)
        sys.exit(4)
    pathlib.Path(sys.argv[4]).write_text((pathlib.Path(sys.argv[2]) / "report.json").read_text())
    sys.exit()
out = pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
with open(here.with_name("calls.txt"), "a") as calls:
    print(out.name, file=calls)
failing, waiting, refused, copied = (os.environ.get("FAKE_" + name) for name in ("FAILS", "WAITS", "REFUSES", "RUN"))
if waiting and waiting in line:
    try:
        time.sleep(60)
    except KeyboardInterrupt:
        sys.exit(130)
if refused and refused in line:
    print("error: not accepted", file=sys.stderr)
    sys.exit(2)
if failing and failing in line:
    print("error: made to fail", file=sys.stderr)
    sys.exit(3)
if copied:
    shutil.copytree(copied, out, dirs_exist_ok=True)
    sys.exit()
(out / "case.effective.toml").write_text("[particles]\\nspacing = 0.02\\n[scheme]\\nintegrator = 'explicit'\\n")
(out / "summary.json").write_text(json.dumps({
    "status": "done", "spacing_m": 0.02, "particles": {"fluid": 100}, "steps": {"count": 50, "dt_mean_s": 0.01},
    "pressure_solver": {"iterations_per_solve": 8.0}, "cost": {"cpu_s": 1.0, "cpu_s_per_simulated_s": 2.0},
    "energy": {"start_J": 1.0, "end_J": 0.9, "largest_rise_over_start": 5e-5, "largest_rise_less_density_work_over_start": 0.0},
    "volume": {"outside_the_walls_most": 0, "density_error_mean": 0.001, "density_error_rms": 0.02},
    "interventions": {"stopped_at_walls": 3, "capped_shifts": 1, "per_step": 0.5}}))
"""


class ProgramTest(unittest.TestCase):
    """A folder with a program that only pretends, self.program, and a case, self.case."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        self.program = self.folder / "tailwater"
        self.program.write_text(FAKE)
        self.program.chmod(0o755)
        self.commit("abc")
        self.case = self.folder / "case.toml"
        self.case.write_text("")

    def commit(self, name):
        (self.folder / "commit").write_text(name)

    def calls(self):
        """Names of the runs made so far, in order."""
        path = self.folder / "calls.txt"
        return path.read_text().split() if path.exists() else []

    def fake(self, **variables):
        """Behaviour of the fake program from here on."""
        os.environ.update(variables)
        for name in variables:
            self.addCleanup(os.environ.pop, name, None)

    def command(self, main, *arguments):
        """(exit code, standard output, standard error) of a command's `main`."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            try:
                code = main(["--program", str(self.program), "--out", str(self.folder / "out"), *arguments])
            except SystemExit as leave:
                code = leave.code
        return code, out.getvalue(), err.getvalue()
