"""A table of errors that a user can make in a case. The program must report each at once and write nothing."""

import os
import resource
import unittest
from typing import NamedTuple

from program import SLOWDOWN, SMALL_CASE, ProgramTest


AT_ONCE = 2 * SLOWDOWN  # s of CPU time


class BadInput(NamedTuple):
    name: str
    parts: tuple  # parts of the message: the place, the key, the value, the remedy
    replace: tuple = ("", "")  # text of the small case, and its replacement
    arguments: tuple = ()  # more arguments
    code: int = 2  # expected exit code


FLOOR = 'points = [[0, 2], [0, 0], [3, 0], [3, 2]]'
COLUMN = "max = [1, 0.5]"
INLET = 'points = [[0, 0], [3, 0], [3, 2]]\n[[inlet]]\nname = "in"\nfrom = [0, 0]\nto = [0, 2]\n'
GATE = '[[wall]]\nname = "gate"\nshape = "box"\nfluid_side = "outside"\nmin = [1, 0]\nmax = [1.4, 1]\n'
SECOND_COLUMN = '\n[[fluid]]\nname = "second"\n'
TABLE = (
    BadInput("misspelt key", ("case.toml:4:11", "particles.spcing", 'did you mean "spacing"?'),
             ("spacing =", "spcing  =")),
    BadInput("misspelt table", ("case.toml:3:1", "particels", 'did you mean "particles"?'),
             ("[particles]", "[particels]")),
    BadInput("wrong type", ("case.toml:4:11", "particles.spacing = true", "number in m"), ("= 0.1\n[[", "= true\n[[")),
    BadInput("unit in a number", ("case.toml:4:11", '"0.1 m"', "without a unit"), ("= 0.1\n[[", '= "0.1 m"\n[[')),
    BadInput("bare unit", ("case.toml:4:", "not valid TOML"), ("= 0.1\n[[", "= 0.1 m\n[[")),
    BadInput("negative spacing", ("case.toml:4:11", "particles.spacing = -0.1", "above 0"),
             ("= 0.1\n[[", "= -0.1\n[[")),
    BadInput("not a number", ("case.toml:4:11", "particles.spacing = nan", "not a finite number"),
             ("= 0.1\n[[", "= nan\n[[")),
    BadInput("infinite", ("time.end = inf", "not a finite number"), ("end = 0.1", "end = inf")),
    BadInput("unknown parameter", ('unknown name "H"', "time.end"), ("end = 0.1", 'end = "2*H"')),
    BadInput("unknown scheme", ("scheme.name", '"farzin2014"', 'did you mean "farzin2014"?'),
             ("[time]", '[scheme]\nname = "farzin2015"\n[time]')),
    BadInput("unknown option of PETSc", ("pressure_solver.petsc_options", "-pressure_ksp_typo", "-pressure_ksp_type"),
             ("[time]", '[pressure_solver]\npetsc_options = "-pressure_ksp_typo gmres"\n[time]')),
    BadInput("duplicate names of walls and fluids", ('"tank"', "used twice"),
             ("[time]", '[[wall]]\nname = "tank"\npoints = [[4, 0], [4, 1]]\n[time]')),
    BadInput("duplicate names of probes", ('"energy"', "used twice"), ('name = "depth"', 'name = "energy"')),
    BadInput("probe outside", ("probe 'depth'", "(9, 0)", "move it"), ("at = [0.5, 0]", "at = [9, 0]")),
    BadInput("wall probe off the wall", ("probe 'wall_pressure'", "(0.5, 1)", "move it"),
             ('"wall-pressure"\nat = [0.5, 0]', '"wall-pressure"\nat = [0.5, 1]')),
    BadInput("name of a probe that leaves the folder", ("../../depth", "letters"),
             ('name = "depth"', 'name = "../../depth"')),
    BadInput("no fluid", ("there is no fluid", "[[fluid]]"),
             (SMALL_CASE[SMALL_CASE.index("[[fluid]]"):SMALL_CASE.index("[[wall]]")], "")),
    BadInput("fluid thinner than a particle", ("fluid 'column'", "0.05", "no particle"), (COLUMN, "max = [1, 0.05]")),
    BadInput("fluid inside out", ("fluid", "max"), (COLUMN, "max = [-1, 0.5]")),
    BadInput("open wall", ("pour out", "wall 'tank'", "higher"), (FLOOR, "points = [[0, 2], [0, 0], [3, 0]]")),
    BadInput("low wall", ("pour out", "wall 'tank'", "higher"),
             (FLOOR, "points = [[0, 2], [0, 0], [3, 0], [3, 0.02]]")),
    BadInput("fluid behind a wall", ("fluid 'column'", "behind wall 'tank'", "50 particles", "fluid_side"),
             (FLOOR, FLOOR + '\nfluid_side = "right"')),
    BadInput("fluid on both sides of a wall", ("wall 'tank'", "both sides", "fluid 'column'"),
             ("min = [0, 0]", "min = [-1, 0]")),
    BadInput("overlap", ("fluid 'column'", "fluid 'second'", "overlap", "(0.55, 0.05)"),
             ("\n[[wall]]", SECOND_COLUMN + "min = [0.5, 0]\nmax = [1.5, 0.5]\n[[wall]]")),
    BadInput("too near to a wall", ("fluid 'column'", "too near to wall 'tank'", "spacings"),
             ("min = [0, 0]", "min = [-0.04, 0]")),
    BadInput("wall without length", ("wall 'tank'",), (FLOOR, "points = [[0, 0], [0, 0]]")),
    BadInput("wall of one point", ("points",), (FLOOR, "points = [[0, 0]]")),
    BadInput("wall that crosses itself", ("wall 'tank'", "crosses itself at (1.5, 1)"),
             (FLOOR, 'shape = "polygon"\nfluid_side = "inside"\npoints = [[0, 0], [3, 2], [3, 0], [0, 2], [-1, 1]]')),
    BadInput("crest higher than the channel", ("wall 'tank'", "crest at (2, 2.5)", "0.5 m"),
             (FLOOR, "points = [[0, 2], [0, 0], [1.5, 0], [2, 2.5], [2.5, 0], [3, 0], [3, 2]]")),
    BadInput("gate through the floor", ("wall 'gate' crosses wall 'tank'", "at t = ", "(1"),
             ("[time]", GATE + 'displacement = [0, "-t"]\n[time]')),
    BadInput("gate table through a roof", ("case.toml:", "gate 'lock' crosses wall 'roof'", "at t = ", "(1"),
             ("[time]", '[[gate]]\nname = "lock"\nfrom = [1, 0]\nto = [1, 1]\nspeed = 10\n[[wall]]\nname = "roof"\n'
              'points = [[0.5, 1.2], [3, 1.2]]\n[time]')),
    BadInput("wave maker too low", ("case.toml:", "wave_maker 'plate'", "its top is 0.4 m above its foot", "higher `to`"),
             ("[time]", '[[wave_maker]]\nname = "plate"\nfrom = [0.5, 0]\nto = [0.5, 0.4]\ndepth = 0.5\nheight = 0.1\n'
              'period = 1\n[time]')),
    BadInput("vent in a wall", ("case.toml:", "vent 'vent1': (1, -0.3) is in wall 'tank', 0.3 m behind"),
             ("[time]", '[air]\npockets = "adiabatic"\n[[vent]]\nat = [1, -0.3]\narea = 1e-4\n[time]')),
    BadInput("vent outside of the walls", ("vent 'vent1': (1, 9) is outside of all walls", "enclose"),
             ("[time]", '[air]\npockets = "adiabatic"\n[[vent]]\nat = [1, 9]\narea = 1e-4\n[time]')),
    BadInput("pressure of open air", ("pocket 'pocket1': at (1, 1) there is no air at the start that water and walls",),
             ("[time]", '[air]\npockets = "adiabatic"\n[[pocket]]\nat = [1, 1]\noverpressure = 500\n[time]')),
    BadInput("gate that closes on the water", ("wall 'gate' comes closer than a spacing", "at t = ", "compressed"),
             ("[time]", GATE + 'displacement = [0, "10*min(t, max(0.06 - t, 0))"]\n[time]')),
    BadInput("lid that crushes the water", ("wall 'lid' crushes the water at t = ", "0.5 m^2 of water"),
             (FLOOR + "\n", 'points = [[0, 2], [0, 0], [1, 0], [1, 2]]\n[[wall]]\nname = "lid"\nshape = "box"\n'
              'fluid_side = "outside"\nmin = [0, 0.6]\nmax = [1, 1]\ndisplacement = [0, "-4*t"]\n')),
    BadInput("outlet in a wall", ("outlet 'end' overlaps wall 'tank' at (3, ",),
             ("[time]", '[[outlet]]\nname = "end"\nfrom = [3, 0]\nto = [3, 2]\n[time]')),
    BadInput("outlet in the water", ("outlet 'end' cuts through fluid 'column'", "at (0.65, 0.05)"),
             ("[time]", '[[outlet]]\nname = "end"\nfrom = [0.6, 0]\nto = [0.6, 2]\n[time]')),
    BadInput("outlet above the bed", ("outlet 'end' leaves a gap to the walls at (2, 0.2)", "0.2 m away"),
             ("[time]", '[[outlet]]\nname = "end"\nfrom = [2, 0.2]\nto = [2, 2]\n[time]')),
    BadInput("inlet in a wall", ("inlet 'in' overlaps wall 'tank' at (0, ",),
             ("[time]", '[[inlet]]\nname = "in"\nfrom = [0, 0]\nto = [0, 2]\ndischarge = 0.1\n[time]')),
    BadInput("inlet that faces outwards", ("case.toml:12:1", "inlet 'in' cuts through fluid 'column'", "reverse its"),
             (FLOOR, INLET + "discharge = 0.1\ndirection = [-1, 0]")),
    BadInput("litres for cubic metres", ("case.toml:12:1", "inlet 'in'", "more water enters", "1 l/s is 0.001"),
             (FLOOR, INLET + "discharge = 50")),
    BadInput("millimetres per second", ("inlet 'in'", "1500 m/s, which is implausible", "a velocity in m/s"),
             (FLOOR, INLET + "velocity = 1500\nlevel = 0.4")),
    BadInput("level that is a depth", ("case.toml:16:9", "inlet 'in': level = -0.3 m", "not depths"),
             (FLOOR, INLET + "level = -0.3")),
    BadInput("discharge that jumps", ("inlet 'in'", "discharge jumps by 0.3 m^3/s", "let it change over"),
             (FLOOR, INLET + 'discharge = "t < 0.05 ? 0.1 : 0.4"')),
    BadInput("discharge without a value", ("inlet 'in'", "has no finite value at t = 0 s"),
             (FLOOR, INLET + 'discharge = "1/t"')),
    BadInput("hydrograph that is not there", ("case.toml:16:8", "inlet[0].file", "cannot read it"),
             (FLOOR, INLET + 'file = "hydrograph.csv"')),
    BadInput("section that is a point", ("probe 'passing' has no extent", "give its two ends"),
             ("[time]", '[[probe]]\nname = "passing"\ntype = "discharge"\nfrom = [1, 0]\nto = [1, 1e-9]\n[time]')),
    BadInput("spacing that needs more memory than there is", ("1e-07 m", "GB", "use a spacing of at least"),
             ("= 0.1\n[[", "= 1e-7\n[[")),
    BadInput("end time that no run reaches", ("case.toml:13:7", "time.end = 1e+09 s", "out of reach", "seconds"),
             ("end = 0.1\n[output]\nfields_interval = 0.02", "end = 1e9")),
    BadInput("number that overflows", ("case.toml:4:11", "particles.spacing = 1e+308", "above 1e+15"),
             ("= 0.1\n[[", "= 1e308\n[[")),
    BadInput("number that no double is", ("case.toml:4:11", "particles.spacing = 9223372036854775807", "above 1e+15"),
             ("= 0.1\n[[", "= 9223372036854775807\n[[")),
    BadInput("number that underflows", ("case.toml:13:11", "scheme.courant = 1e-300", "at least 1e-15"),
             ("[time]", "[scheme]\ncourant = 1e-300\n[time]")),
    BadInput("velocity that overflows", ("case.toml:9:12", "fluid 'column'", "velocity[0]", '"1e300*x"'),
             (COLUMN, COLUMN + "\nvelocity = ['1e300*x', 0]")),
    BadInput("spacing beyond the shapes", ("case.toml:11:10", "points[0] and points[1] are 2 m apart", "1e+09 m"),
             ("= 0.1\n[[", "= 1e9\n[[")),
    BadInput("endless walls", ("case.toml:4:11", "particles.spacing = 0.1 m", "3e+16 wall particles", "smaller shapes"),
             (FLOOR, "points = [[0, 2], [0, 0], [1e15, 0], [1e15, 2]]")),
    BadInput("probe that would fill the disk", ("case.toml:20:12", "probe[0].interval = 1e-12", "1e+11 lines"),
             ("at = [0.5, 0]", "at = [0.5, 0]\ninterval = 1e-12")),
    BadInput("fields that would fill the disk", ("case.toml:15:19", "output.fields_interval = 1e-12", "1e+11 field"),
             ("= 0.02", "= 1e-12")),
    BadInput("option that opens a file", ("case.toml:13:17", "-pressure_ksp_view", "open files"),
             ("[time]", '[pressure_solver]\npetsc_options = "-pressure_ksp_view ascii:trace"\n[time]')),
    BadInput("option that names a file", ("case.toml:13:17", "ascii:trace", "open files"),
             ("[time]", '[pressure_solver]\npetsc_options = "-pressure_ksp_converged_reason ascii:trace"\n[time]')),
    BadInput("option of the whole program", ("case.toml:13:17", "-options_left", "pressure_"),
             ("[time]", '[pressure_solver]\npetsc_options = "-options_left"\n[time]')),
    BadInput("option that ends a solve early", ("case.toml:13:17", "-pressure_ksp_atol", "pressure_solver.tolerance"),
             ("[time]", '[pressure_solver]\npetsc_options = "-pressure_ksp_ATOL 1e6"\n[time]')),
    BadInput("solver that does not exist", ("case.toml:13:17", "PETSc failed", "quickly"),
             ("[time]", '[pressure_solver]\npetsc_options = "-pressure_ksp_type quickly"\n[time]')),
    BadInput("override of a key too deep", ("--set a.", "too many parts"), arguments=("--set", "a." * 50000 + "a=1")),
    BadInput("override without a value", ("--set particles.spacing", "--set table.key=value"),
             arguments=("--set", "particles.spacing")),
    BadInput("override of an unknown key", ("--set particles.spcing=1", 'did you mean "spacing"?'),
             arguments=("--set", "particles.spcing=1")),
    BadInput("override out of range", ("--set particles.spacing=-1", "above 0"),
             arguments=("--set", "particles.spacing=-1")),
    BadInput("override of what is not there", ("probe", "deepth", 'did you mean "depth"?'),
             arguments=("--set", "probe.deepth.interval=1")),
)

# Name: content, expected exit code, parts of the message.
FILES = {
    "empty file": (b"", 2, ("particles.spacing is missing", "time.end is missing", "there is no fluid")),
    "binary garbage": (bytes(range(255, 0, -1)) * 20, 2, ("not valid TOML",)),
    "zeros": (bytes(1000), 2, ("not valid TOML",)),
    "cut off": (SMALL_CASE[:-2].encode(), 2, ("not valid TOML",)),
    "another format": (b'{"spacing": 0.1}\n', 2, ("case.toml:1:1", "not valid TOML")),
    "end of a line where a number is read": ((SMALL_CASE + "[a]\nb = i\n").encode(), 2, ("case.toml:28:6", "saw 'i '")),
    "keys too deep": ((SMALL_CASE + "a." * 50000 + "a = 1\n").encode(), 2, ("case.toml:27", "too many dots")),
    "quoted keys too deep": ((SMALL_CASE + "'#'." * 50000 + "a = 1\n").encode(), 2, ("case.toml:27", "too many dots")),
    "lists too deep": ((SMALL_CASE + "a = " + "[" * 50000).encode(), 2, ("case.toml:27", "nested")),
    "large file": ((SMALL_CASE + "# \n" * 100000).encode(), 2, ("case.toml", "at most 262144")),
    "many points": (SMALL_CASE.replace("[3, 0]", ", ".join(f"[{x}, 0]" for x in range(3, 10004))).encode(), 2,
                    ("case.toml:11:10", "at most 10000")),
    "many walls": (SMALL_CASE.replace("[3, 0]", ", ".join(f"[{x}, 0]" for x in range(3, 5100))).encode(), 2,
                   ("case.toml:9:1", "wall 'tank'", "at most 5000")),
    "long expression": (SMALL_CASE.replace("0.1\n[out", '"' + "(" * 6000 + '"\n[out').encode(), 2,
                        ("case.toml:13:7", "at most 5000")),
    "many parameters": ((SMALL_CASE + "[parameters]\n" + "".join(f"p{k} = 1\n" for k in range(1001))).encode(), 2,
                        ("case.toml:27:1", "at most 1000")),
}


def cpu_seconds():
    """CPU time of all programs called so far; unlike elapsed time it does not depend on other work of the machine."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class BadCases(ProgramTest):
    def refuse(self, row, arguments):
        before = self.listing()
        for command in (("check", "case.toml", "--no-preview"), ("run", "case.toml", "--out", "out")):
            start = cpu_seconds()
            result = self.call(*command, *arguments, expect=row.code)
            self.assertLess(cpu_seconds() - start, AT_ONCE, "a mistake is answered at once")
            self.assertEqual(result.stdout, "")
            self.assertEqual(self.listing(), before, "a mistake leaves no trace")
            for part in row.parts:
                self.assertIn(part, result.stderr)

    def test_every_mistake_is_answered(self):
        for row in TABLE:
            with self.subTest(row.name):
                old, new = row.replace
                self.assertIn(old, SMALL_CASE)
                (self.folder / "case.toml").write_text(SMALL_CASE.replace(old, new, 1) if old else SMALL_CASE)
                self.refuse(row, row.arguments)

    def test_files_that_are_no_cases(self):
        for name, (content, code, parts) in FILES.items():
            with self.subTest(name):
                (self.folder / "case.toml").write_bytes(content)
                self.refuse(BadInput(name, parts, code=code), ())

    def test_missing_file(self):
        self.refuse(BadInput("", ("case.toml", "No such file", "tailwater new"), code=4), ())

    def test_parameters_in_a_long_chain(self):
        chain = "".join(f'p{k} = "p{k + 1}"\n' for k in range(999))
        (self.folder / "case.toml").write_text(SMALL_CASE + "[parameters]\n" + chain + "p999 = 1\n")
        start = cpu_seconds()
        self.call("check", "case.toml")
        self.assertLess(cpu_seconds() - start, AT_ONCE)

    def test_what_is_no_file(self):
        os.mkfifo(self.folder / "pipe")
        for name in ("pipe", "/dev/zero"):
            for command in (("check", name), ("run", name, "--out", "out")):
                self.assertIn("a device or a pipe", self.call(*command, expect=4).stderr)

    def test_linked_files_that_are_no_files(self):
        os.mkfifo(self.folder / "pipe")
        bed = SMALL_CASE.replace(FLOOR, 'points_file = "LINK"')
        mesh = SMALL_CASE.replace(FLOOR, 'shape = "mesh"\nfluid_side = "inside"\nfile = "LINK"')
        mesh = mesh.replace("[case]", "[case]\ndimension = 3")
        for text, key in ((bed, "case.toml:11:15: wall[0].points_file"), (mesh, "case.toml:14:8: wall[0].file")):
            for name in ("pipe", "/dev/zero"):
                (self.folder / "case.toml").write_text(text.replace("LINK", name))
                self.refuse(BadInput("", (key, "a device or a pipe")), ())

    def test_folder_as_case_file(self):
        (self.folder / "case.toml").mkdir()
        self.refuse(BadInput("", ("case.toml", "is a folder"), code=4), ())

    def test_all_mistakes_at_once(self):
        text = SMALL_CASE.replace("spacing", "spcing").replace("end =", "ende =").replace('"column"', "3")
        (self.folder / "case.toml").write_text(text)
        message = self.call("check", "case.toml", expect=2).stderr
        for part in ("particles.spcing", "time.ende", "fluid[0].name"):
            self.assertIn(part, message)

    def test_many_mistakes_have_an_end_and_each_its_place(self):
        (self.folder / "case.toml").write_text(SMALL_CASE + "[[fluid]]\nmin = [0, 0]\nmax = [1, 0.5]\n" * 60)
        lines = self.call("run", "case.toml", "--out", "out", expect=2).stderr.splitlines()
        self.assertEqual(len(lines), 50)
        for line in lines:
            self.assertRegex(line, r"^error: case\.toml:\d+:1: fluid '")
        self.assertRegex(lines[-1], r"\(and \d+ more problems\)$")


if __name__ == "__main__":
    unittest.main()
