"""The installed program: every command works from a copy without the sources.

A user's program finds the library."""

import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

BUILD = Path(os.environ["TAILWATER_BUILD"])
SOURCES = Path(__file__).resolve().parents[2]
SHORT = ["--set", "particles.spacing=0.05", "--set", "time.end=0.05"]


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.scratch.name)
        cls.prefix = cls.folder / "usr"
        run("cmake", "--install", BUILD, "--prefix", cls.prefix)
        cls.program = cls.prefix / "bin" / "tailwater"
        cls.hidden = cls.hides_sources()

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def hides_sources(cls):
        """A command prefix that replaces the sources by an empty folder, where this machine allows it; otherwise an
        empty list."""
        words = ["unshare", "--mount", "sh", "-c", f'mount -t tmpfs none "{SOURCES}" && exec "$@"', "sh"]
        allowed = subprocess.run([*words, "true"], capture_output=True, check=False).returncode == 0
        return words if allowed else []

    def tailwater(self, *arguments):
        return run(*self.hidden, self.program, *arguments, cwd=self.folder, env={"PATH": os.environ["PATH"]})

    def test_has_no_path_of_the_sources(self):
        for path in [self.program, *self.prefix.glob("lib/cmake/Tailwater/*")]:
            self.assertNotIn(str(SOURCES).encode() + b"/", path.read_bytes(), path)

    def test_commands(self):
        called = set()

        def call(command, *arguments):
            called.add(command)
            return self.tailwater(command, *arguments)

        def write(name, text):
            (self.folder / name).write_text(text, encoding="utf-8")
            return name

        call("new", "dam-break", "my.toml")
        call("check", "my.toml", *SHORT)
        self.assertIn("water", call("explain", "my.toml"))
        call("migrate", "my.toml", "migrated.toml")
        call("run", "migrated.toml", "--out", "out", *SHORT)
        self.assertIn("done", call("info", "out"))
        call("resume", "out", "--set", "time.end=0.06")
        call("pictures", "out")
        self.assertTrue(list(self.folder.glob("out/pictures/*.png")))
        call("study", "my.toml", "--out", "study", "--spacings", "0.1,0.075,0.06", "--starts", "0", "--quiet", *SHORT[2:])
        for folder in ("out", "study"):
            call("view", folder, "--export", f"{folder}.html")
            self.assertIn("tailwater-data", (self.folder / f"{folder}.html").read_text(encoding="utf-8"))
        call("report", "study", "--pictures", "0")
        self.assertIn("<html", (self.folder / "study/dossier.html").read_text(encoding="utf-8"))
        call("export", "out", "--netcdf", "gauges.nc", "--paraview", "state.py")
        survey = write("survey.xyz", "".join(f"{x} {y} {x + y}\n" for x in range(3) for y in range(3)))
        self.assertIn("[[wall]]", call("bed", survey, "--to", "bed.stl"))
        sea = write("sea.csv", "f [Hz], S [m^2/Hz]\n0.5, 0\n0.8, 0.001\n1.2, 0\n")
        call("paddle", sea, "--to", "paddle.csv", "--depth", "0.4", "--duration", "20")
        self.assertIn("particles", call("refine", "out", "--case", "my.toml"))
        self.assertIn("zhou", call("validate", "--list"))
        self.assertIn("tank", call("bench", "robustness", "--list"))
        self.assertIn("GAUGE", call("waves", "--help"))
        self.assertIn(".TH TAILWATER", call("man"))
        words = re.search('-W "(.*?)"', call("completion", "bash"))[1].split()
        self.assertEqual(called, {word for word in words if not word.startswith("-")})

    def test_version_is_one(self):
        version = self.tailwater("--version").split()[1]
        self.assertIn(f"\nversion: {version}\n", (SOURCES / "CITATION.cff").read_text(encoding="utf-8"))
        self.assertIn(f"\n## [{version}]", (SOURCES / "CHANGELOG.md").read_text(encoding="utf-8"))

    def test_manual_page_and_completion_are_there(self):
        share = self.prefix / "share"
        for path in ("man/man1/tailwater.1", "bash-completion/completions/tailwater", "zsh/vendor-completions/_tailwater",
                     "fish/vendor_completions.d/tailwater.fish"):
            self.assertIn("wall-time", (share / path).read_text(encoding="utf-8").replace("\\-", "-"), path)

    def test_schema_is_there(self):
        schema = json.loads((self.prefix / "share/tailwater/case.schema.json").read_text(encoding="utf-8"))
        self.assertIn("particles", schema["properties"])

    def test_cases_are_there(self):
        cases = self.prefix / "share" / "tailwater" / "cases"
        self.tailwater("check", cases / "zhou1999" / "case.toml", "--set", "particles.spacing=0.1")

    def test_library_builds_a_program(self):
        build = self.folder / "build"
        run("cmake", "-S", SOURCES / "tests" / "install" / "program", "-B", build, "-G", "Ninja",
            f"-DCMAKE_PREFIX_PATH={self.prefix}", "-DCMAKE_BUILD_TYPE=None", "-DCMAKE_CXX_FLAGS=-O0")
        run("cmake", "--build", build)
        self.tailwater("new", "tank", "tank.toml")
        text = (self.folder / "tank.toml").read_text(encoding="utf-8")
        self.assertIn("end = ", text)
        (self.folder / "tank.toml").write_text(
            "\n".join("end = 0.01" if line.startswith("end = ") else line for line in text.splitlines()), encoding="utf-8")
        run(build / "a_run", self.folder / "tank.toml", self.folder / "of_program")
        summary = json.loads((self.folder / "of_program" / "summary.json").read_text(encoding="utf-8"))
        self.assertEqual(summary["status"], "done")
        self.assertEqual(float(run(build / "a_run", self.folder / "tank.toml")), summary["time_s"]["reached"])

    def test_python_package_finds_the_program(self):
        script = ("import tailwater as tw; case = tw.Case.template('tank').update({'time.end': 0.01});"
                  "run = case.run('by_python'); print(tw.program(), run.summary['status'])")
        told = run(*self.hidden, "/usr/bin/python3", "-c", script, cwd=self.folder,
                   env={"PATH": os.environ["PATH"], "PYTHONPATH": str(self.prefix / "lib/python3/dist-packages")})
        self.assertEqual(told.split(), [str(self.program), "done"])


if __name__ == "__main__":
    unittest.main()
