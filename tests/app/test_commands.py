"""The commands new, check and info, and the command line itself."""

import json
import os
import re
import subprocess
import unittest
import xml.etree.ElementTree
from pathlib import Path

from program import PROGRAM, SLOWDOWN, SMALL_CASE, ProgramTest

COMMANDS = ("new", "check", "explain", "run", "resume", "info", "bench")

FLUME = """\
[particles]
spacing = 0.05
[[fluid]]
name = "water"
min = [0, 0]
max = [3, 0.4]
[[wall]]
name = "paddle"
points = [[0, 0.7], [0, 0]]
motion = "paddle.csv"
[[wall]]
name = "flume"
points = [[-0.5, 0], [3, 0], [3, 0.7]]
[time]
end = 20
"""


class CommandLine(ProgramTest):
    def test_without_arguments_the_help_goes_to_standard_error(self):
        result = self.call(expect=2, errors_only=False)
        self.assertEqual(result.stdout, "")
        self.assertEqual(result.stderr, self.call("--help").stdout)

    def test_help_fits_a_terminal_of_80_columns(self):
        """Except examples, which must be copied unchanged."""
        for command in ((), *((command,) for command in (*COMMANDS, "view", "migrate", "completion"))):
            text = self.call(*command, "--help").stdout
            self.assertEqual([line for line in text.splitlines() if len(line) > 80 and "tailwater " not in line], [])

    def test_help_names_every_command_and_exit_code(self):
        help_text = self.call("--help").stdout
        for word in (*COMMANDS, "0 done", "2 bad input", "3 the solver failed", "4 a file", "130 interrupted"):
            self.assertIn(word, help_text)

    def test_help_of_every_command_has_an_example(self):
        for command in COMMANDS:
            with self.subTest(command):
                result = self.call(command, "--help")
                self.assertIn(f"tailwater {command}", result.stdout)
                self.assertRegex(result.stdout, "Examples?: ")
                self.assertEqual(result.stderr, "")

    def test_manual_page_tells_of_every_command_and_option(self):
        page = self.call("man").stdout.replace("\\-", "-")
        for command in COMMANDS:
            self.assertIn(f".SS tailwater {command}\n", page)
        for word in ("--wall-time", "--sweep", "130 interrupted"):
            self.assertIn(word, page)

    def test_completion_completes_commands_and_options(self):
        script = self.call("completion", "bash").stdout
        for words, expected in ((("ch",), "check"), (("run", "--sw"), "--sweep"), (("resume", "--j"), "--jobs")):
            asked = (f"{script}\nCOMP_WORDS=(tailwater {' '.join(words)}); COMP_CWORD={len(words)}; _tailwater; "
                     'echo "${COMPREPLY[@]}"')
            self.assertEqual(subprocess.run(["bash", "-c", asked], capture_output=True, text=True, check=True).stdout,
                             expected + "\n")
        for shell in ("zsh", "fish"):
            self.assertIn("wall-time", self.call("completion", shell).stdout)
        self.assertIn("bash", self.call("completion", "tcsh", expect=2).stderr)

    def test_version(self):
        self.assertRegex(self.call("--version").stdout, r"^tailwater \d+\.\d+\.\d+ \(commit .+\)\n$")

    def test_starts_without_petsc(self):
        """PETSc takes longer to load than all else. It is loaded by the first linear system that needs it."""
        libraries = subprocess.run(["ldd", PROGRAM], capture_output=True, text=True, check=True).stdout
        self.assertIn("libmpi", libraries)
        self.assertNotIn("petsc", libraries)

    def test_mistakes_are_answered_with_the_way_out(self):
        for arguments, parts in (
            (("chekc", "small.toml"), ('unknown command "chekc"', 'did you mean "check"?')),
            (("--bogus",), ('unknown option "--bogus"', "tailwater --help")),
            (("--bogus", "check", "small.toml"), ('unknown option "--bogus"', "tailwater --help")),
            (("check",), ("case is required", "tailwater check --help")),
            (("check", "small.toml", "--bogus"), ("--bogus", "tailwater check --help")),
            (("check", "small.toml", "--set"), ("--set", "tailwater check --help")),
            (("new", "dambreak", "my.toml"), ("dambreak", "dam-break", "tank", "tailwater new --help")),
            (("run",), ("--out", "tailwater run my.toml --out my_run")),
            (("run", "small.toml"), ("--out", "tailwater run my.toml --out my_run")),
            (("run", "small.toml", "--out", "run", "-n", "two"), ("-n", "two")),
            (("run", "--help-case=html"), ("html", "text", "markdown")),
        ):
            with self.subTest(arguments):
                result = self.call(*arguments, expect=2)
                self.assertEqual(result.stdout, "")
                for part in parts:
                    self.assertIn(part, result.stderr)
        self.assertEqual(list(self.listing()), ["small.toml"])

    def test_waves_is_the_python_package_beside_the_sources(self):
        self.assertIn("tailwater waves", self.call("waves", "--help").stdout)
        self.assertIn("is not the folder of a run", self.call("waves", "nowhere", expect=2).stderr)

    def test_motion_that_paddle_makes_is_one_for_a_wall(self):
        (self.folder / "waves.csv").write_text("f [Hz], S [cm^2/Hz]\n0.5, 0\n0.6, 10\n1, 0\n")
        self.assertIn("Hm0", self.call("paddle", "waves.csv", "--to", "paddle.csv", "--depth", "0.4", "--duration", "30").stdout)
        (self.folder / "flume.toml").write_text(FLUME)
        self.assertIn("particles", self.call("check", "flume.toml").stdout)

    def test_export_writes_what_its_options_name(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        self.call("export", "run", "--netcdf", "gauges.nc", "--paraview", "state.py")
        self.assertEqual((self.folder / "gauges.nc").read_bytes()[:4], b"CDF\x02")
        self.assertIn(str(self.folder / "run" / "fields"), (self.folder / "state.py").read_text())
        self.assertIn("give one of", self.call("export", "run", expect=2).stderr)

    def test_bench_is_the_python_package_beside_the_sources(self):
        self.assertIn("tailwater bench robustness", self.call("bench", "robustness", "--help").stdout)
        self.assertIn("dam-break", self.call("bench", "robustness", "--list").stdout)
        self.assertIn("did you mean tank?", self.call("bench", "robustness", "--gate", "tnak", expect=2).stderr)
        self.assertEqual(list(self.listing()), ["small.toml"])

    def test_help_case_explains_every_key_of_the_effective_case(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        keys = {line.split(" = ")[0] for line in (self.folder / "run/case.effective.toml").read_text().splitlines()
                if " = " in line}
        keys = {key for key in keys if not key.endswith("checksum")}  # only the program writes checksums
        text = self.call("run", "--help-case").stdout
        markdown = self.call("run", "--help-case=markdown").stdout + self.call("run", "--help-case=study").stdout
        self.assertLess({"spacing", "integrator", "gravity"}, keys)
        for key in keys:
            self.assertIn(f"\n  {key} (", text)
            self.assertIn(f"\n| `{key}` |", markdown)

    def test_help_case_as_json_tells_types_ranges_choices_and_uses(self):
        reference = json.loads(self.call("run", "--help-case=json").stdout)
        self.assertEqual(reference["format"], 1)
        keys = {(table["name"], key["name"]): key for table in reference["tables"] for key in table["keys"]}
        self.assertEqual(keys["particles", "spacing"],
                         {"name": "spacing", "type": "number", "unit": "m", "required": True, "default": None,
                          "minimum": 0.0, "minimum_is_excluded": True,
                          "documentation": keys["particles", "spacing"]["documentation"]})
        self.assertEqual((keys["case", "dimension"]["minimum"], keys["case", "dimension"]["maximum"]), (2.0, 3.0))
        self.assertEqual(keys["scheme", "name"]["choices"], ["farzin2014", "farmani2020"])
        self.assertEqual(keys["fluid", "level"]["goes_with"],
                         {"key": "shape", "choices": ["fill"], "needed_by": ["fill"]})
        self.assertEqual((keys["inlet", "discharge"]["type"], keys["inlet", "discharge"]["variables"]),
                         ("varying number", "t"))
        markdown = self.call("run", "--help-case=markdown").stdout + self.call("run", "--help-case=study").stdout
        for (_, name), key in keys.items():
            self.assertIn(f"\n| `{name}` |", markdown)
            self.assertTrue(key["documentation"] and key["type"], name)


class New(ProgramTest):
    def names(self):
        return re.search(r"not in \{(.*?)\}", self.call("new", "?", "my.toml", expect=2).stderr)[1].split(",")

    def pictures(self, run):
        return [path.name for path in (self.folder / run / "pictures").iterdir()]

    def last_picture(self, run):
        """The picture of the last field file, as a list."""
        number = len(list((self.folder / run / "fields").glob("fields_*.vtp"))) - 1
        return [f"picture_{number:05}.png"]

    def test_help_describes_every_template(self):
        described = self.call("new", "--help").stdout.partition("\nTemplates:\n")[2]
        self.assertEqual(sorted(re.findall(r"^  ([\w-]+)  +\w", described, re.MULTILINE)), sorted(self.names()))

    def test_every_template_is_in_the_gallery(self):
        names = self.names()
        docs = Path(__file__).resolve().parents[2] / "docs"
        shown = re.findall(r"^## (.+)$", (docs / "gallery.md").read_text(encoding="utf-8"), re.MULTILINE)
        self.assertEqual(sorted(shown), sorted(names), "remedy: scripts/gallery.py")
        self.assertEqual([name for name in names if not (docs / "images/gallery" / f"{name}.webp").is_file()], [])

    def test_templates_as_they_stand_can_be_checked_and_run_without_a_warning(self):
        for template in self.names():
            with self.subTest(template):
                wrote = self.call("new", template, f"{template}.toml").stdout
                self.assertRegex(wrote, f"^Wrote {template}.toml( and .+, which it reads)?. Next:\n  tailwater check {template}.toml\n")
                self.assertEqual(self.call("check", f"{template}.toml", "--no-preview").stderr, "")
                self.call("run", f"{template}.toml", "--out", template, "--quiet", "--set", "time.end=0.02")
                summary = self.summary(template)
                self.assertEqual(summary["status"], "done")
                of_short_run = ("are after time.end", "[probe-takes-few-readings]")
                self.assertEqual([line for line in summary["warnings"] if not any(part in line for part in of_short_run)], [])

    def test_the_template_with_a_mesh_can_be_checked_and_run(self):
        self.assertEqual(self.call("new", "pier", "pier.toml").stdout.splitlines()[0],
                         "Wrote pier.toml and pier.obj, which it reads. Next:")
        coarse = ("--set", "particles.spacing=0.06", "--set", "time.end=0.02")
        self.assertEqual(self.call("check", "pier.toml", *coarse).stderr, "")
        self.assertTrue((self.folder / "pier.preview.png").read_bytes().startswith(b"\x89PNG"))
        self.call("run", "pier.toml", "--out", "pier", "--quiet", "--pictures", "1", *coarse)
        self.assertEqual(self.pictures("pier"), self.last_picture("pier"))
        self.assertEqual(sorted(path.name for path in (self.folder / "pier/fields").glob("*.pvd")),
                         ["fields.pvd", "surface.pvd", "walls.pvd"])
        self.call("run", "pier.toml", "--out", "pier", "--quiet", "--force", *coarse)
        self.assertFalse((self.folder / "pier/pictures").exists() or (self.folder / "pier/fields/surface.pvd").exists(),
                         "pictures of the earlier run")
        mesh = self.folder / "pier.obj"
        mesh.write_text("".join(mesh.read_text().splitlines(keepends=True)[:-1]))
        self.assertIn("has changed", self.call("resume", "pier", "--set", "time.end=0.03", expect=2).stderr)
        for picture in (self.folder / "pier.preview.svg", self.folder / "pier.preview.png"):
            picture.unlink()
        refused = self.call("check", "pier.toml", *coarse, expect=2)
        self.assertIn("is not watertight", refused.stderr)
        self.assertIn("pier.preview.png", refused.stdout)
        self.assertIn("<circle", (self.folder / "pier.preview.svg").read_text())

    def test_the_template_with_a_surveyed_bed_can_be_checked_and_run(self):
        self.assertIn("reach.toml and bed.csv", self.call("new", "river-reach", "reach.toml").stdout)
        self.assertEqual(self.call("check", "reach.toml").stderr, "")
        self.call("run", "reach.toml", "--out", "reach", "--quiet", "--pictures", "1",
                  "--set", "particles.spacing=0.08", "--set", "time.end=0.05")
        self.assertEqual(self.pictures("reach"), self.last_picture("reach"))

    def test_what_a_template_reads_is_not_overwritten_either(self):
        (self.folder / "bed.csv").write_text("my survey")
        self.assertIn("bed.csv' exists", self.call("new", "river-reach", "reach.toml", expect=2).stderr)
        self.assertFalse((self.folder / "reach.toml").exists())
        self.call("new", "river-reach", "reach.toml", "--force")
        self.call("new", "river-reach", "other.toml")  # this template reads the same file
        self.assertTrue((self.folder / "other.toml").exists())

    def test_force_takes_no_place_of_links_devices_and_pipes(self):
        os.mkfifo(self.folder / "pipe")
        (self.folder / "link").symlink_to("small.toml")
        for name, what in (("pipe", "a pipe"), ("link", "a link"), (".", "a folder")):
            self.assertIn(what, self.call("new", "tank", name, "--force", expect=2).stderr)
        self.assertEqual((self.folder / "small.toml").read_text(), SMALL_CASE)

    @unittest.skipIf(os.geteuid() != 0, "only root can give a file to someone else")
    def test_force_takes_no_place_of_what_others_have(self):
        os.chown(self.folder / "small.toml", 12345, 12345)
        self.assertIn("another user's file", self.call("new", "tank", "small.toml", "--force", expect=2).stderr)
        self.assertEqual((self.folder / "small.toml").read_text(), SMALL_CASE)

    def test_refuses_to_overwrite(self):
        message = self.call("new", "tank", "small.toml", expect=2).stderr
        self.assertIn("small.toml", message)
        self.assertIn("--force", message)
        self.assertEqual((self.folder / "small.toml").read_text(), SMALL_CASE)

    def test_force_overwrites(self):
        self.call("new", "tank", "small.toml", "--force")
        self.assertIn("Tank at rest", (self.folder / "small.toml").read_text())

    def test_where_no_file_can_be(self):
        self.assertIn("nowhere/my.toml", self.call("new", "tank", "nowhere/my.toml", expect=4).stderr)


class Check(ProgramTest):
    def test_tells_counts_and_estimates(self):
        result = self.call("check", "small.toml")
        self.assertEqual(result.stderr, "")
        self.assertIn('small.toml: valid, "Small dam break"', result.stdout)
        # 10 x 5 fluid particles. Walls of three rows: 2 x 3 x (20 + 3) at the sides, three of these rows above the free
        # end, and 3 x (30 + 2 x 3) at the bottom, corners included.
        self.assertIn("particles: 50 fluid, 246 wall, spacing 0.1 m", result.stdout)
        self.assertRegex(result.stdout, r"memory: +about \d+ MB")
        # Steps of at most courant dx / sqrt(2 g H) = 0.55 x 0.1 / sqrt(2 x 9.81 x 0.5) = 17.6 ms. A flow this slow does
        # not need smaller ones: 0.1 s are 5.69 steps. Their elapsed time depends on other work of the machine.
        self.assertRegex(result.stdout, r"time: +about [67] steps, (under )?\d+ s on one core of this machine")

    @unittest.skipIf(SLOWDOWN > 1, "sanitizers need memory themselves")
    def test_memory_is_enough_and_not_twice_what_a_run_takes(self):
        """Compares differences from a tiny run, because the memory of libraries depends on the system."""
        (self.folder / "block.toml").write_text("""
case.dimension = 3
particles.spacing = 0.05
[[fluid]]
min = [0, 0, 0]
max = [1, 1, 1]
[[wall]]
shape = "box"
min = [0, 0, 0]
max = [1, 1, 1.2]
open = ["+z"]
[time]
end = 1e-6
""")

        def memory(case, spacing, integrator):
            case = (case, "--set", f"particles.spacing={spacing}", "--set", f"scheme.integrator={integrator}")
            estimate = self.call("check", *case, "--no-preview").stdout
            self.call("run", *case, "--out", "run", "--force", "--quiet", "-n", "1", "--set", "time.end=1e-6")
            return int(re.search("about (\\d+) MB", estimate)[1]), self.summary("run")["cost"]["peak_memory_bytes"] / 1e6

        for case, tiny, large in (("small.toml", "0.1", "1/240"), ("block.toml", "0.1", "0.04")):
            with self.subTest(case):
                parts = zip(memory(case, large, "implicit"), memory(case, tiny, "implicit"))
                expected, taken = (of_large - of_tiny for of_large, of_tiny in parts)
                self.assertGreater(expected, taken)
                self.assertLess(expected, 2 * taken)

    def test_the_preview_is_an_svg_with_every_fluid_particle(self):
        self.call("check", "small.toml")
        root = xml.etree.ElementTree.parse(self.folder / "small.preview.svg").getroot()
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        self.assertEqual(sorted(self.listing()), ["small.preview.svg", "small.toml"])

    def test_the_preview_goes_where_it_is_told(self):
        self.assertIn("picture.svg", self.call("check", "small.toml", "--preview", "picture.svg").stdout)
        self.assertEqual(sorted(self.listing()), ["picture.svg", "small.toml"])

    def test_nothing_is_drawn_if_nothing_is_to_be(self):
        self.call("check", "small.toml", "--no-preview")
        self.assertEqual(list(self.listing()), ["small.toml"])
        self.assertIn("a name that ends with .svg", self.call("check", "small.toml", "--preview", "a.png", expect=2).stderr)

    def test_the_preview_of_a_wrong_geometry_shows_where(self):
        self.assertIn("preview:", self.call("check", "small.toml", "--set", "fluid.column.max=[1, 2.5]", expect=2).stdout)
        self.assertIn("<circle", (self.folder / "small.preview.svg").read_text())
        error = self.call("check", "small.toml", "--set", "fluid.column.max=[1, 2.5]", "--preview", "no/p.svg", expect=2).stderr
        self.assertIn("warning: no preview", error)

    def test_the_preview_does_not_replace_the_case(self):
        self.assertIn("small.toml", self.call("check", "small.toml", "--preview", "./small.toml", expect=2).stderr)
        self.assertEqual((self.folder / "small.toml").read_text(), SMALL_CASE)

    def test_the_preview_takes_the_place_of_previews_only(self):
        os.mkfifo(self.folder / "pipe.svg")
        (self.folder / "mine.svg").write_text("<svg>my drawing</svg>")
        (self.folder / "link.svg").symlink_to("mine.svg")
        for name, part in (("pipe.svg", "a device or a pipe"), ("link.svg", "a link"), ("mine.svg", "is not a preview")):
            self.assertIn(part, self.call("check", "small.toml", "--preview", name, expect=2).stderr)
        self.assertEqual((self.folder / "mine.svg").read_text(), "<svg>my drawing</svg>")
        for _ in range(2):
            self.call("check", "small.toml", "--preview", "new.svg")
        (self.folder / "small.preview.svg.part").symlink_to("mine.svg")
        told = self.call("check", "small.toml").stderr  # a preview that was not asked for is left out
        self.assertRegex(told, r"warning: no preview: .*small\.preview\.svg\.part.*remedy: .*\[preview-skipped\]")
        self.call("check", "small.toml", "--preview", "small.preview.svg", expect=4)
        self.assertEqual((self.folder / "mine.svg").read_text(), "<svg>my drawing</svg>")

    def test_where_no_preview_can_be(self):
        self.assertIn("nowhere/p.svg", self.call("check", "small.toml", "--preview", "nowhere/p.svg", expect=4).stderr)

    def test_set_overrides_the_file(self):
        result = self.call("check", "small.toml", "--set", "particles.spacing=0.05")
        self.assertIn("particles: 200 fluid", result.stdout)


class Explain(ProgramTest):
    def test_says_what_a_case_is(self):
        text = self.call("explain", "small.toml").stdout
        for part in ('"Small dam break" is a case in two dimensions.', "0.5 m^3 of water per metre of width (500 kg)",
                     "Walls are 'tank' (polyline of 4 points).", "It ends at 0.1 s: about 6 steps"):
            self.assertIn(part, text)
        self.assertEqual(list(self.listing()), ["small.toml"])
        self.assertIn("out of range", self.call("explain", "small.toml", "--set", "time.end=-1", expect=2).stderr)


class Info(ProgramTest):
    def test_tells_about_the_program(self):
        text = self.call("info").stdout
        for part in ("tailwater ", "commit", "Open MPI", "cores"):
            self.assertIn(part, text)

    def test_shows_the_summary_of_a_run(self):
        self.call("run", "small.toml", "--out", "run", "--quiet")
        self.assertEqual(json.loads(self.call("info", "run", "--json").stdout), self.summary("run"))
        digest = self.call("info", "run").stdout
        for part in ("Small dam break\nstatus:    done\nwarnings:  none\n", "particles: 50 fluid, 246 wall",
                     "water:     500 kg per m at the start, 0 in, 500 inside, 0 spilled, 0 out"):
            self.assertIn(part, digest)

    def test_shows_warnings_and_why_a_run_failed(self):
        self.call("run", "small.toml", "--out", "run", "--quiet", "--set", "limits.volume_warning=1e-9", "--set",
                  "limits.energy_stop=1e-9", "--set", "particles.jitter=0.3", "--set",
                  "wall[0].points=[[0, 2], [0, 0], [1, 0], [1, 2]]", "--set", "time.end=0.3", expect=3)
        digest = self.call("info", "run").stdout
        self.assertIn("status:    failed\nmessage:   at t = ", digest)
        self.assertIn("limits.energy_stop = 1e-09", digest)
        self.assertIn("warnings:  1\n  at t = ", digest)

    def test_a_summary_of_something_else(self):
        (self.folder / "summary.json").write_text('{"title": [1, 2]}')
        self.assertIn("not the summary of a run", self.call("info", ".", expect=4).stderr)

    def test_a_folder_that_is_no_run(self):
        for folder in ("nowhere", ".", "small.toml"):
            message = self.call("info", folder, expect=2).stderr
            self.assertIn(f"'{folder}", message)
            self.assertIn("the folder of a run", message)


class Readme(ProgramTest):
    def test_the_small_case_gives_the_results_shown(self):
        text = (Path(__file__).resolve().parents[2] / "README.md").read_text(encoding="utf-8")
        (self.folder / "my.toml").write_text(re.search(r"```toml\n(.*?)```", text, re.DOTALL)[1])
        self.call("run", "my.toml", "--out", "my_run", "--quiet")
        digest = self.call("info", "my_run").stdout
        shown = re.findall(r"^    (\w+): +(\S.*)$", text, re.MULTILINE)
        self.assertEqual([name for name, _ in shown], ["status", "impact", "particles", "water"])
        for name, value in shown:
            result = re.search(rf"^{name}: +(\S.*)$", digest, re.MULTILINE)[1]
            if name == "impact":  # digits of the impact depend on the processor
                self.assertAlmostEqual(float(result.split()[0]) / float(value.split()[0]), 1, delta=0.05)
            else:
                self.assertEqual(result, value)


if __name__ == "__main__":
    unittest.main()
