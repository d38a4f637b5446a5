"""The probe output of a run agrees with docs/reference/probes.md: tables, summary, measurements, viewer."""

import json
import re
import unittest

from program import ProgramTest

TANK = {2: """
[[fluid]]
min = [0, 0]
max = [1.2, 0.4]
[[wall]]
name = "tank"
points = [[0, 0.8], [0, 0], [1.2, 0], [1.2, 0.8]]
fluid_side = "left"
[[wall]]
name = "hull"
shape = "box"
min = [0.4, 0.3]
max = [0.8, 0.5]
fluid_side = "outside"
[[body]]
name = "box"
walls = ["hull"]
mass = 40
centre = [0.6, 0.4]
inertia = [0.7]
""", 3: """
[[fluid]]
min = [0, 0, 0]
max = [0.8, 0.4, 0.4]
[[wall]]
name = "tank"
shape = "box"
min = [0, 0, 0]
max = [0.8, 0.4, 0.8]
open = ["+z"]
[[wall]]
name = "hull"
shape = "box"
min = [0.4, 0.1, 0.3]
max = [0.6, 0.3, 0.5]
fluid_side = "outside"
[[body]]
name = "box"
walls = ["hull"]
mass = 4
centre = [0.5, 0.2, 0.4]
inertia = [0.03, 0.03, 0.03]
"""}


def point(dimension, x, z, y=0.2):
    return f"[{x}, {z}]" if dimension == 2 else f"[{x}, {y}, {z}]"


def probes(dimension):
    """(type, keys) of probes that write all possible columns."""
    def line(x, z):
        return point(dimension, x, z)

    return [("depth", f"at = {line(0.2, 0)}"), ("wall-pressure", f"at = {line(0, 0.1)}"),
            ("wall-pressure", f"at = {line(0, 0.1)}\ndiameter = 0.05"),
            ("wall-pressure-mean", f"from = {line(0, 0.1)}\nto = {line(0, 0.5)}"), ("front", ""),
            ("profile", f"from = {line(0, 0)}\nto = {line(0.3, 0)}\ntimes = [0.02]"), ("pressure", f"at = {line(0.2, 0.2)}"),
            ("velocity", f"at = {line(0.2, 0.2)}"), ("energy", ""), ("volume", ""),
            ("discharge", f"from = {point(dimension, 0.3, 0, y=0)}\nto = {point(dimension, 0.3, 0.8, y=0.4)}"),
            ("force", 'walls = ["tank"]'), ("force", f"moment_about = {line(0, 0)}"), ("pressure-map", 'walls = ["tank"]'),
            ("motion", 'body = "box"'), ("run-up", 'walls = ["tank"]'),
            ("level-map", f"from = {point(dimension, 0, 0, y=0)}\nto = {point(dimension, 0.3, 0, y=0.4)}\nstep = 0.1"),
            ("velocity-profile", f"at = {line(0.2, 0)}"), ("pockets", "")]


def in_dimension(cell, dimension):
    """The content of a cell of the page for one dimension."""
    both = re.fullmatch(r"2D: (.*); 3D: (.*)", cell)
    if both:
        return both[dimension - 1]
    of_one = re.fullmatch(r"([23])D: (.*)", cell)
    if of_one:
        return of_one[2] if int(of_one[1]) == dimension else None
    return cell.split(", in 3D also ")[0] if dimension == 2 else cell.replace(", in 3D also", ",")


def read_page(page, dimension):
    """{type: {"column", "result" or "total": rows}}; a row has the name, the unit and the other cells."""
    types = {}
    for section in page.split("\n## ")[1:]:
        tables = types[section.split("\n")[0]] = {"column": [], "result": [], "total": []}
        for line in section.split("\n"):
            cells = [cell.strip() for cell in line.strip("|").split("|")]
            if cells[0] in tables:
                rows = tables[cells[0]]
            elif line.startswith("| ") and cells[0] != "---":
                unit = in_dimension(cells[2] if rows is tables["result"] else cells[1], dimension)
                names = in_dimension(cells[0], dimension)
                if names is None or unit is None:
                    continue
                for name in re.findall(r"`(\w+)`", names) or [names]:
                    rows.append((name, unit, in_dimension(cells[-1], dimension)))
    return types


# A solitary wave with a height of 0.6 spacings.
LOW_WAVE = """
[particles]
spacing = 0.05
[[fluid]]
min = [0, 0]
max = [3, 0.4]
[[wall]]
name = "channel"
points = [[-0.4, 1], [-0.4, 0], [3, 0], [3, 1]]
[[wave_maker]]
name = "piston"
from = [0, 0]
to = [0, 1]
depth = 0.4
waves = "solitary"
height = 0.03
[time]
end = 3
[[probe]]
name = "g1"
type = "depth"
at = [0.5, 0]
[[probe]]
name = "g2"
type = "depth"
at = [0.7, 0]
"""


class UnresolvedSurfaces(ProgramTest):
    def test_waves_lower_than_two_spacings_and_films_are_told(self):
        (self.folder / "wave.toml").write_text(LOW_WAVE)
        told = self.call("run", "wave.toml", "--out", "wave").stderr
        self.assertRegex(told, r"warning: .*wave_maker 'piston': height = 0.03 m is 0.6 spacings: waves lower than 2")
        self.assertRegex(told, r"warning: at probes 'g1', 'g2' the surface moved by 0.0\d+ m or less, 0.\d+ spacings: waves")
        self.assertEqual(len(self.summary("wave")["warnings"]), 2, told)
        film = self.call("run", "small.toml", "--out", "film", "--set", "probe.depth.at=[1.3,0]", "--set",
                         "time.end=0.25").stderr
        self.assertRegex(film, "at probe 'depth' the largest depth was 0.[01]\\d* m or less, .* spacings: films of less than 2")
        high = self.call("run", "wave.toml", "--out", "high", "--set", "wave_maker[0].height=0.12").stderr
        self.assertNotIn("resolved", high)


# A tank full of water, which moves with it.
ACCELERATED_TANK = """
[particles]
spacing = 0.05
[[fluid]]
min = [0, 0]
max = [0.6, 0.2]
[[wall]]
name = "tank"
shape = "box"
min = [0, 0]
max = [0.6, 0.2]
displacement = ["5*t^2/2", 0]
[time]
end = 0.1
[[probe]]
name = "left"
type = "wall-pressure"
at = [0, 0.1]
[[probe]]
name = "right"
type = "wall-pressure"
at = [0.6, 0.1]
[[probe]]
name = "map"
type = "pressure-map"
walls = ["tank"]
region_min = [-0.01, 0.05]
region_max = [0.01, 0.15]
"""


class PressureOnMovingWalls(ProgramTest):
    def test_the_walls_of_an_accelerated_tank_have_the_pressure_of_its_inertia(self):
        (self.folder / "tank.toml").write_text(ACCELERATED_TANK)
        self.call("run", "tank.toml", "--out", "tank")
        left, right = (self.rows("tank", probe)[-1][1] for probe in ("left", "right"))
        # rho a L; with the hydrostatic gradient alone the particles beside both walls would give 11 % less.
        self.assertAlmostEqual(left - right, 1000 * 5 * 0.6, delta=0.01 * 1000 * 5 * 0.6)
        self.assertAlmostEqual(self.rows("tank", "map")[-1][4], left, delta=0.01 * 1000 * 5 * 0.6)  # their mean

    def rows(self, run, probe):
        lines = (self.folder / run / "probes" / f"{probe}.csv").read_text().split("\n")[1:]
        return [[float(number) for number in line.split(",")] for line in lines if line]


class DepthInAValley(ProgramTest):
    def test_water_stands_on_the_bed_where_no_particle_is_as_low(self):
        (self.folder / "valley.toml").write_text(
            'particles.spacing = 0.05\n[[fluid]]\nshape = "fill"\nseed = [0, 0.3]\nlevel = 0.4\n'
            '[[wall]]\nname = "valley"\npoints = [[-1, 1], [0, 0], [1, 1]]\n[time]\nend = 0.02\n'
            '[[probe]]\nname = "d"\ntype = "depth"\nat = [0, 0.2]\n')
        self.call("run", "valley.toml", "--out", "run", "--quiet")
        _, connected, highest, _ = (self.folder / "run/probes/d.csv").read_text().splitlines()[1].split(",")
        self.assertEqual(connected, highest)
        self.assertAlmostEqual(float(connected), 0.4, delta=0.005)


class ProbeOutput(ProgramTest):
    def page(self, dimension):
        return read_page(self.call("run", "--help-case=probes").stdout, dimension)

    def case(self, dimension, page):
        """Writes the case, with a measurement for each probe whose type has a default; returns the types of its
        probes."""
        text = f"case.dimension = {dimension}\nparticles.spacing = 0.05\ntime.end = 0.03\nair.pockets = \"adiabatic\"\n"
        text += TANK[dimension]
        types = {}
        for k, (kind, keys) in enumerate(probes(dimension)):
            types[f"p{k}"] = kind
            text += f'[[probe]]\nname = "p{k}"\ntype = "{kind}"\n{keys}\n'
            default = [unit for _, unit, comparison in page[kind]["column"] if comparison == "default"]
            if default:
                measured = f"t [s], value [{default[0].removesuffix(' per m')}]\n0, 1\n0.02, 1\n"
                if kind == "profile":
                    measured = "t [s], x [m], value [m]\n0.02, 0.1, 1\n0.02, 0.2, 1\n"
                (self.folder / f"lab{k}.csv").write_text(measured)
                text += f'[[measurement]]\nprobe = "p{k}"\nfile = "lab{k}.csv"\n'
        (self.folder / "all.toml").write_text(text)
        return types

    def columns_in_a_liquid(self, dimension):
        """Columns of a velocity probe with a liquid, beside which the case must have no pockets of air."""
        (self.folder / "liquid.toml").write_text(
            f"case.dimension = {dimension}\nparticles.spacing = 0.05\ntime.end = 0.03\n"
            + TANK[dimension].replace("[[fluid]]", '[[fluid]]\nliquid = "brine"', 1)
            + '[[liquid]]\nname = "brine"\nviscosity = 1e-3\n[[probe]]\nname = "point"\ntype = "velocity"\n'
            + f'at = {point(dimension, 0.2, 0.2)}\nliquid = "brine"\n')
        self.call("run", "liquid.toml", "--out", "liquid", "--quiet", "--force", "-n", "1")
        return self.table("liquid/probes/point.csv")[0][1:]

    def assert_in_order(self, some, all_of_them, what):
        """Asserts that `some` are in the list, in the order of the list."""
        self.assertEqual(some, [one for one in all_of_them if one in some], what)

    def test_is_what_the_reference_says(self):
        for dimension in (2, 3):
            with self.subTest(dimension):
                page = self.page(dimension)
                types = self.case(dimension, page)
                self.assertEqual(set(types.values()), set(page))
                self.call("run", "all.toml", "--out", "run", "--quiet", "--force", "-n", "1")
                summary = self.summary("run")
                log = (self.folder / "run/log.txt").read_text()
                drawn = {probe["name"]: probe for probe in
                         json.loads(self.call("check", "all.toml", "--json").stdout)["drawing"]["probes"]}
                written, told = {}, {}
                for name, kind in types.items():
                    columns, results, totals = (page[kind][table] for table in ("column", "result", "total"))
                    headings = self.table(f"run/probes/{name}.csv")[0][1:]
                    self.assert_in_order(headings, [heading for heading, *_ in columns], kind)
                    written.setdefault(kind, set()).update(headings)
                    self.assertEqual(drawn[name]["columns"], headings)
                    units = {heading: unit for heading, unit, _ in columns}
                    self.assertEqual(drawn[name]["units"], [units[heading] for heading in headings])
                    keys = list(summary.get("probes", {}).get(name, {}))
                    # no waves
                    self.assertEqual(keys, [key for key, *_ in totals][:3 if kind == "depth" else None], kind)
                    quantities = summary["results"][name]["quantities"]
                    self.assert_in_order([(one["name"], one["unit"]) for one in quantities],
                                         [(result, unit) for result, unit, _ in results], kind)
                    told.setdefault(kind, set()).update(one["name"] for one in quantities)
                    self.assertIn(f"\n{name}: {summary['results'][name]['words']}\n", log)
                in_liquid = self.columns_in_a_liquid(dimension)
                self.assertEqual(in_liquid, [heading for heading, *_ in page["velocity"]["column"]])
                written["velocity"].update(in_liquid)
                for kind, tables in page.items():
                    self.assertEqual(written[kind], {heading for heading, *_ in tables["column"]}, kind)
                    # A pressure that does not rise has no rise time, a run this short no largest discharge.
                    absent = {"rise", "largest discharge"}
                    self.assertEqual(told[kind] - absent, {result for result, *_ in tables["result"]} - absent, kind)
                for score in summary["measurements"]:
                    heading, unit, _ = next(row for row in page[types[score["probe"]]]["column"] if row[2] == "default")
                    self.assertTrue(heading.startswith(score["column"] + "_"), heading)
                    self.assertEqual(score["unit"], unit)


if __name__ == "__main__":
    unittest.main()
