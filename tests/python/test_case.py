"""Cases as dicts: keys, text, errors, checks."""

import os
import tomllib
import unittest
from pathlib import Path

import tailwater as tw
from small import DAM, PackageTest
from tailwater import case_text


class Keys(PackageTest):
    def setUp(self):
        super().setUp()
        self.case = tw.Case.load(self.write("dam.toml", DAM))

    def test_values_are_those_of_the_file_then_defaults(self):
        for key, value in (("parameters.H", 0.5), ("fluid[0].max", [1, "H"]), ("fluid.column.max[1]", "H"),
                           ("probe.depth.type", "depth"), ("particles.seed", 1), ("case.dimension", 2)):
            self.assertEqual(self.case[key], value, key)

    def test_changes_are_seen_and_a_copy_has_its_own(self):
        other = self.case.copy()
        other.update({"parameters.H": 0.6, "fluid.column.max[0]": 2})
        self.assertEqual((other["parameters.H"], other["fluid[0].max"]), (0.6, [2, "H"]))
        self.assertEqual((self.case["parameters.H"], self.case["fluid[0].max"]), (0.5, [1, "H"]))

    def test_a_table_is_deleted_by_name_and_by_number(self):
        self.case["probe.depth.at"] = [0.5, 0]
        other = self.case.copy()
        del other["probe.depth"]
        self.assertNotIn("probe.depth.at", other)
        self.assertIn("there are no probes", other.explain())
        self.assertEqual(self.case["probe.depth.at"], [0.5, 0])
        other["fluid[0].max"] = [0.5, "H"]
        del other["wall[0]"]
        self.assertIn("25 particles", other.explain())
        for key, hint in (("probe.depth", "the case has no"), ("probe[0]", "the case has no"), ("parameters.H", "the case has no"),
                          ("tables", "the case has no"), ("fluid[0].max", "no table that can be deleted")):
            with self.assertRaisesRegex(tw.InputError, hint, msg=key):
                del other[key]

    def test_changes_after_a_table_is_deleted_count(self):
        text = DAM + '[[probe]]\nname = "second"\ntype = "depth"\nat = [0.1, 0]\n'
        case = tw.Case(self.write("two.toml", text))
        case["probe[0].at"] = [0.2, 0]
        case["probe.second.at"] = [0.3, 0]
        del case["probe.depth"]
        case["probe[0].at"] = [0.4, 0]
        (probe,) = case.run("out").case["probe"]
        self.assertEqual((probe["name"], probe["at"]), ("second", [0.4, 0]))
        saved = case.save("saved.toml")
        self.assertEqual((saved["probe[0].name"], saved["probe[0].at"]), ("second", [0.4, 0]))

    def test_key_that_no_case_has_is_refused_at_once(self):
        for key, hint in (("particles.spacin", 'did you mean "spacing"?'),
                          ("particle.spacing", 'did you mean "particles"?'), ("fluid[7].max", "the case has no"),
                          ("probe.dept.at", "the case has no"), ("spacing", "is not a key")):
            with self.assertRaises(tw.InputError, msg=key) as caught:
                self.case[key] = 1
            self.assertIn(hint, str(caught.exception))

    def test_table_that_the_case_has_not_is_named(self):
        def change(key):
            self.case[key] = [0, 0]

        def delete(key):
            del self.case[key]

        for key, words in (("fluid[1].min", r"no fluid\[1\]; it has column"), ("probe.dept.at", "no probe.dept; it has depth"),
                           ("gate[0].speed", "no gate"), ("fluid[0].max[7]", r"no fluid\[0\].max\[7\]")):
            for use in (self.case.__getitem__, change) if "[7]" not in key else (change,):
                with self.assertRaisesRegex(tw.InputError, f"the case has {words}$", msg=(key, use)):
                    use(key)
        with self.assertRaisesRegex(tw.InputError, r"the case has no wall\[4\]; it has tank$"):
            delete("wall[4]")

    def test_renamed_table_has_its_new_name_only(self):
        self.case["probe.depth.name"] = "level"
        self.assertEqual(self.case["probe.level.name"], "level")
        for key in ("probe.depth.name", "probe.depth.at"):
            with self.assertRaisesRegex(tw.InputError, "the case has no probe.depth; it has level"):
                self.case[key]

    def test_parameter_that_the_case_has_not_is_refused(self):
        case = tw.Case.template("weir")
        for use in (lambda: case["parameters.Q"], lambda: case.update({"parameters.Q": 0.06}),
                    lambda: tw.sweep(case, {"parameters.Q": [0.05, 0.06]})):
            with self.assertRaisesRegex(tw.InputError, 'did you mean "q"'):
                use()

    def test_value_that_no_case_has_is_refused(self):
        with self.assertRaisesRegex(tw.InputError, "a case has numbers, texts"):
            self.case["parameters.H"] = {"value": 1}

    def test_templates_are_those_of_the_program(self):
        case = tw.Case.template("pier")
        self.assertTrue(case.file.with_name("pier.obj").exists())
        with self.assertRaisesRegex(tw.InputError, "dam-break"):
            tw.Case.template("dam")


class Text(PackageTest):
    def test_saved_case_keeps_comments_and_has_the_changes(self):
        changes = {"parameters.H": 0.4, "wall.tank.points[1][1]": -0.1, "particles.jitter": 0.1,
                   "output.fields": ["velocity"], "case.title": 'of "us"'}
        saved = tw.Case(self.write("dam.toml", DAM)).update(changes).save("saved.toml")
        text = Path("saved.toml").read_text(encoding="utf-8")
        self.assertIn("# A small dam break\n", text)
        self.assertIn("H = 0.4   # m\n", text)
        for key, value in changes.items():
            self.assertEqual(saved[key], value)
        del changes["particles.jitter"], changes["output.fields"]
        expected = tomllib.loads(DAM) | {"particles": {"spacing": 0.1, "jitter": 0.1},
                                         "output": {"fields": ["velocity"]}}
        for key, value in changes.items():
            expected = case_text.put(expected, case_text.steps_of(key), value)
        self.assertEqual(tomllib.loads(text), expected)

    def test_a_saved_case_is_without_deleted_tables_and_their_comments(self):
        begin, end = "[case]\ntitle = 'x'\n", "# The end\n[time]\nend = 1\n"
        one, two = "# One\n# probe\n[[probe]]\nat = [0, 0]  # here\n", "# Two\n[[probe]]\nat = [1, 0]\n"
        for key, left in (("probe[0]", two), ("probe[1]", one), ("probe.probe1", two), ("probe", "")):
            self.assertEqual(case_text.text_without(begin + one + two + end, key), begin + left + end, key)
            spaced = case_text.text_without("\n".join((begin, one, two, end)), key)
            self.assertEqual([line for line in spaced.split("\n") if line], (begin + left + end).split("\n")[:-1], key)
        with self.assertRaisesRegex(tw.InputError, "cannot be changed in the text"):
            case_text.text_without("probe = [{at = [0, 0]}]\n", "probe[0]")

    def test_tells_what_the_case_says_itself(self):
        case = tw.Case(self.write("dam.toml", DAM))
        self.assertEqual([key in case for key in ("particles.spacing", "fluid[0].max", "physics.density", "no.key")],
                         [True, True, False, False])

    def test_text_that_is_written_otherwise_is_left_alone(self):
        with self.assertRaisesRegex(tw.InputError, "cannot be changed in the text"):
            case_text.changed_text('case.title = "dotted"\n[particles]\nspacing = 0.1\n', "case.title", "other")

    def test_files_that_the_case_reads_go_with_it(self):
        os.mkdir("there")
        case = tw.Case.template("river-reach")
        case.save("there/reach.toml")
        self.assertEqual(Path("there/bed.csv").read_bytes(), case.file.with_name("bed.csv").read_bytes())
        Path("there/bed.csv").write_text("mine", encoding="utf-8")
        with self.assertRaisesRegex(tw.InputError, "is another file"):
            case.save("there/again.toml")

    def test_files_in_folders_go_with_it_however_they_are_named(self):
        names = ("data/lab/gauge.csv", "./hull.stl", "../elsewhere.csv", "/dev/null", "none.csv")
        for folder in ("here/data/lab", "there"):
            os.makedirs(folder)
        for file in ("here/data/lab/gauge.csv", "here/hull.stl", "elsewhere.csv"):
            self.write(file, file)
        text = DAM + "".join(f'[[measurement]]\nprobe = "depth"\nfile = "{name}"\n' for name in names)
        tw.Case(self.write("here/dam.toml", text)).save("there/dam.toml")
        copied = sorted(str(path.relative_to("there")) for path in Path("there").rglob("*") if path.is_file())
        self.assertEqual(copied, ["dam.toml", "data/lab/gauge.csv", "hull.stl"])


class Checks(PackageTest):
    def test_error_has_file_line_and_key(self):
        case = tw.Case(self.write("dam.toml", DAM.replace("spacing = 0.1", "spacing = -0.1")))
        with self.assertRaises(tw.InputError) as caught:
            case.explain()
        error = caught.exception
        self.assertEqual((error.file, error.line, error.key), ("dam.toml", 7, "particles.spacing"))
        self.assertIn("give a number above 0 in m", str(error))

    def test_error_of_a_change_has_its_key(self):
        case = tw.Case(self.write("dam.toml", DAM))
        with self.assertRaisesRegex(tw.InputError, "^particles.spacin: unknown key") as caught:
            case["particles.spacin"] = 1
        self.assertEqual(caught.exception.key, "particles.spacin")
        case["particles.spacing"] = -1
        with self.assertRaises(tw.InputError) as caught:
            case.run("out")
        self.assertEqual((caught.exception.file, caught.exception.key), (None, "particles.spacing"))
        self.assertFalse(Path("out").exists())

    def test_check_tells_what_is_wrong_and_draws_it(self):
        case = tw.Case(self.write("dam.toml", DAM))
        check = case.check()
        self.assertTrue(check)
        self.assertEqual(check.particles, 50)
        self.assertIn("<svg", case._repr_html_())
        case["probe.depth.at"] = [7, 0]
        self.assertFalse(case.check())
        self.assertIn("'depth'", case.check().findings[0]["message"])

    def test_files_are_beside_the_case_wherever_it_is_checked(self):
        check = tw.Case.template("river-reach").check()  # it reads its bed
        self.assertTrue(check, check.findings)

    def test_explain_is_sentences(self):
        self.assertIn("50 particles", tw.Case(self.write("dam.toml", DAM)).explain())

    def test_a_link_is_not_written_through_and_a_device_is_not_read(self):
        with open("victim", "w", encoding="utf-8") as file:
            file.write("precious")
        os.symlink("victim", "link.toml")
        case = tw.Case(self.write("case.toml", DAM))
        with self.assertRaisesRegex(tw.IoError, "link.toml': a link is in its place"):
            case.save("link.toml")
        with open("victim", encoding="utf-8") as file:
            self.assertEqual(file.read(), "precious")
        os.mkfifo("pipe")
        for name in ("pipe", "/dev/zero", "."):
            with self.assertRaisesRegex(tw.IoError, "a device or a pipe|is a folder"):
                tw.Case(name)
        with open("large.toml", "wb") as file:
            file.truncate(1 << 40)
        with self.assertRaisesRegex(tw.IoError, "such a file has at most"):
            tw.Case("large.toml")

    def test_a_run_needs_the_name_of_a_folder(self):
        case = tw.Case(self.write("case.toml", DAM))
        for out in (None, 3, ""):
            with self.assertRaisesRegex(tw.InputError, "give the name of a folder"):
                case.run(out)
        self.assertFalse(os.path.exists("None"))

    def test_file_that_is_not_there(self):
        with self.assertRaisesRegex(tw.IoError, "none.toml"):
            tw.Case("none.toml")


if __name__ == "__main__":
    unittest.main()
