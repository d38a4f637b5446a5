#!/usr/bin/python3
"""A dam break of ours by OpenFOAM's interFoam (volume of fluid, water and air), scored like a run of Tailwater.

It shows the error of a computation without air, turbulence and surface tension, since each can be switched here.

Usage: benchmarks/interfoam.py zhou1999|martin_moyce1952|janosi2004 OUT --dx METRES [--turbulence none|kOmegaSST]
                               [--air-density 1.2] [--surface-tension 0] [--walls slip|no-slip] [--n2 1] [--end SECONDS]
OUT is made anew: the case that interFoam ran, and scores.json. Needs Debian's package openfoam.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "validation"), str(ROOT / "python")]

import numpy  # noqa: E402
from tailwater.curves import Curve  # noqa: E402
from tailwater_validation.metric import Metric  # noqa: E402
from tailwater_validation.profiles import differences_at, rms  # noqa: E402
from tailwater_validation.studies import janosi2004, martin_moyce1952, zhou1999  # noqa: E402

OPENFOAM = "/usr/share/openfoam"  # where Debian has what its programs read
THICKNESS = 0.1  # m, of the one layer of cells that OpenFOAM needs in two dimensions
WALLS = ("left", "right", "bottom", "gate", "box")  # interFoam ignores those that a case lacks
SAMPLES = 1000  # of every probe over a run


def header(kind, name):
    return f"FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n"


class Case:
    """The parts of a case that all dam breaks share; `cost` (CPU s) is that of its run. A subclass has `size` and `column`
    (length, height, m), `end` (s), `gauges` (names of probes: field and places), and what `scores` needs of a run: `curve`
    and `spacing`. `measured_in`: other files of the laboratory than our case names."""

    measured_in = {}
    cost = None
    sides = "type empty;"  # of a case in two dimensions

    def __init__(self, options):
        self.options = options
        self.folder = self.path = options.out
        ours = ROOT / "cases" / options.case
        self.case = tomllib.loads((ours / "case.toml").read_text())
        for table in self.case["measurement"]:
            table["file"] = ours / self.measured_in.get(table["file"], table["file"])
            table.setdefault("column", "")
        self.cells = tuple(round(length / options.dx) for length in self.size)
        self.spacing = self.size[0] / self.cells[0]

    def centres(self, axis):
        return (numpy.arange(self.cells[axis]) + 0.5) * self.size[axis] / self.cells[axis]

    def write(self, path, text, kind="dictionary"):
        file = self.folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(header(kind, file.name) + text)

    def mesh(self):
        (length, height), (along, up) = self.size, self.cells
        corners = [(x, y, z) for z in (0, height) for x, y in ((0, 0), (length, 0), (length, THICKNESS), (0, THICKNESS))]
        vertices = "\n".join(f"({x} {y} {z})" for x, y, z in corners)
        self.write("system/blockMeshDict", f"""
vertices ({vertices});
blocks (hex (0 1 2 3 4 5 6 7) ({along} 1 {up}) simpleGrading (1 1 1));
boundary
(
    left   {{ type wall; faces ((0 4 7 3)); }}
    right  {{ type wall; faces ((1 2 6 5)); }}
    bottom {{ type wall; faces ((0 3 2 1)); }}
    top    {{ type patch; faces ((4 5 6 7)); }}
    sides  {{ type empty; faces ((0 1 5 4) (3 7 6 2)); }}
);
""")

    def field(self, name, dimensions, inside, wall, top, vector=False):
        walls = "".join(f"{patch} {{ {wall} }}\n" for patch in WALLS)
        self.write(f"0/{name}", f"dimensions {dimensions};\ninternalField uniform {inside};\n"
                                f"boundaryField {{ {walls} sides {{ {self.sides or wall} }} top {{ {top} }} }}\n",
                   "volVectorField" if vector else "volScalarField")

    def fields(self):
        outside = "type inletOutlet; inletValue uniform {0}; value uniform {0};"
        wall = "type slip;" if self.options.walls == "slip" else "type noSlip;"
        self.field("U", "[0 1 -1 0 0 0 0]", "(0 0 0)", wall,
                   "type pressureInletOutletVelocity; value uniform (0 0 0);", vector=True)
        self.field("p_rgh", "[1 -1 -2 0 0 0 0]", 0, "type fixedFluxPressure; value uniform 0;",
                   "type totalPressure; p0 uniform 0;")
        self.field("alpha.water", "[0 0 0 0 0 0 0]", 0, "type zeroGradient;", outside.format(0))
        if self.options.turbulence != "none":
            # Still water: as good as no turbulence at the start.
            self.field("k", "[0 2 -2 0 0 0 0]", 1e-6, "type kqRWallFunction; value uniform 1e-6;", outside.format(1e-6))
            self.field("omega", "[0 0 -1 0 0 0 0]", 1, "type omegaWallFunction; value uniform 1;", outside.format(1))
            self.field("nut", "[0 2 -1 0 0 0 0]", 0, "type nutkWallFunction; value uniform 0;",
                       "type calculated; value uniform 0;")

    def properties(self):
        self.write("constant/g", "dimensions [0 1 -2 0 0 0 0]; value (0 0 -9.81);", "uniformDimensionedVectorField")
        self.write("constant/transportProperties", f"""
phases (water air);
water {{ transportModel Newtonian; nu 1e-06; rho 1000; }}
air   {{ transportModel Newtonian; nu 1.48e-05; rho {self.options.air_density:g}; }}
sigma {self.options.surface_tension:g};
""")
        model = self.options.turbulence
        self.write("constant/turbulenceProperties", "simulationType laminar;" if model == "none" else
                   f"simulationType RAS; RAS {{ RASModel {model}; turbulence on; printCoeffs off; }}")

    def schemes(self):
        self.write("system/fvSchemes", """
ddtSchemes { default Euler; }
gradSchemes { default Gauss linear; }
divSchemes
{
    default none;
    div(rhoPhi,U) Gauss linearUpwind grad(U);
    div(phi,alpha) Gauss vanLeer;
    div(phirb,alpha) Gauss linear;
    div(phi,k) Gauss upwind;
    div(phi,omega) Gauss upwind;
    div(((rho*nuEff)*dev2(T(grad(U))))) Gauss linear;
}
laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; }
snGradSchemes { default corrected; }
wallDist { method meshWave; }
""")
        self.write("system/fvSolution", """
solvers
{
    "alpha.water.*" { nAlphaCorr 2; nAlphaSubCycles 1; cAlpha 1; MULESCorr yes; nLimiterIter 5;
                      solver smoothSolver; smoother symGaussSeidel; tolerance 1e-8; relTol 0; }
    "pcorr.*"  { solver PCG; preconditioner DIC; tolerance 1e-5; relTol 0; }
    p_rgh      { solver PCG; preconditioner { preconditioner GAMG; smoother GaussSeidel; tolerance 1e-7; relTol 0; }
                 tolerance 1e-7; relTol 0.02; }
    p_rghFinal { solver PCG; preconditioner { preconditioner GAMG; smoother GaussSeidel; tolerance 1e-8; relTol 0; }
                 tolerance 1e-8; relTol 0; }
    "(U|k|omega).*" { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-7; relTol 0; minIter 1; }
}
PIMPLE { momentumPredictor no; nOuterCorrectors 1; nCorrectors 3; nNonOrthogonalCorrectors 0; }
relaxationFactors { equations { ".*" 1; } }
""")

    def control(self, start="0", end=None, interval=None, form="binary"):
        """From the fields in the folder `start` to the time `end` (s), by default that of the case; fields at each `interval`
        (s) in a `form`."""
        end = end or self.end

        def probes(name, field, points):
            places = " ".join("({:.6g} {:.6g} {:.6g})".format(*(point if len(point) == 3 else (point[0], THICKNESS / 2, point[1])))
                              for point in points)
            return (f"{name} {{ type probes; libs (sampling); fields ({field}); writeControl adjustableRunTime; "
                    f"writeInterval {self.end / SAMPLES:.6g}; probeLocations ({places}); }}\n")

        functions = "".join(probes(name, *gauge) for name, gauge in self.gauges().items())
        self.write("system/controlDict", f"""
application interFoam;
startFrom startTime; startTime {start}; stopAt endTime; endTime {end:.8g};
deltaT 1e-4; adjustTimeStep yes; maxCo 0.4; maxAlphaCo 0.4; maxDeltaT {self.end / SAMPLES:.6g};
writeControl adjustableRunTime; writeInterval {interval or end / 16:.8g};
writeFormat {form}; writePrecision 8; timePrecision 8; runTimeModifiable no;
functions {{ {functions} }}
""")

    def water(self):
        self.write("system/setFieldsDict", f"""
defaultFieldValues (volScalarFieldValue alpha.water 0);
regions (boxToCell {{ box (-1 -1 -1) ({self.column[0]} 1 {self.column[1]});
                      fieldValues (volScalarFieldValue alpha.water 1); }});
""")

    def run(self):
        for part in (self.mesh, self.fields, self.properties, self.schemes, self.water, self.control):
            part()
        for program in ("blockMesh", "setFields", "interFoam"):
            self.call(program)
        self.cost = cpu_seconds(self.folder / "log.interFoam")

    def call(self, program):
        with (self.folder / f"log.{program}").open("w") as log:
            subprocess.run([program], cwd=self.folder, env={"WM_PROJECT_DIR": OPENFOAM} | os.environ, check=True, stdout=log,
                           stderr=subprocess.STDOUT)

    def table(self, name, field):
        """Times, and one row of values for each."""
        file = self.folder / "postProcessing" / name / "0" / field
        rows = numpy.loadtxt(file, comments="#", ndmin=2)
        return rows[:, 0], rows[:, 1:]

    def column_of_cells(self, x, below):
        """Places of the centres of cells above x, in that column of cells which is nearest, up to a height."""
        near = min(self.centres(0), key=lambda centre: abs(centre - x))
        return [(near, z) for z in self.centres(1) if z < below]

    def wet_length(self, name):
        times, wet = self.table(name, "alpha.water")
        return Curve(times, wet.sum(axis=1) * self.size[1] / self.cells[1])

    def front(self):
        times, wet = self.table("floor", "alpha.water")
        last = [max(numpy.flatnonzero(row > 0.5), default=0) for row in wet]
        return Curve(times, (numpy.array(last) + 1) * self.spacing)

    def floor(self):
        return "alpha.water", [(x, self.centres(1)[0]) for x in self.centres(0)]


class Zhou(Case):
    size = zhou1999.TANK, 2.0
    column = 2 * zhou1999.H, zhou1999.H
    end = 8 * zhou1999.TIME_SCALE
    wires = {"H1": 2.725, "H2": 2.228}
    plate = 0.115, 0.205  # m above the floor
    second_impact_within = 5.0, 8.0  # T

    def gauges(self):
        wires = {name: ("alpha.water", self.column_of_cells(x, self.size[1])) for name, x in self.wires.items()}
        return wires | {"floor": self.floor(), "wall": ("p", self.column_of_cells(self.size[0], 0.4))}

    def curve(self, name, _column):
        if name in self.wires:
            return self.wet_length(name)
        if name == "front":
            return self.front()
        times, pressure = self.table("wall", "p")
        heights = [z for _, z in self.column_of_cells(self.size[0], 0.4)]
        places = numpy.linspace(*self.plate, 91) if name == "P2" else zhou1999.POINT_HEIGHTS[name]
        return Curve(times, numpy.array([numpy.interp(places, heights, row).mean() for row in pressure]))

    def scores(self):
        yield from zhou1999.impact(self)
        for reading in zhou1999.laboratory(self, "P2"):
            yield from zhou1999.distances(self, reading)
        late = zhou1999.pressure(self, zhou1999.READ_AT).window(*self.second_impact_within)
        if late.time.size:
            yield Metric("second_impact", "second impact, z = 0.12 m", "T", "about 5.9",
                         value=float(late.time[late.value.argmax()]))
            yield Metric("second_peak", "its pressure", "rho g H", "0.80..0.86", value=float(late.value.max()))


class MartinMoyce(Case):
    a = 0.05715  # m

    def __init__(self, options):
        self.parameters = {"n2": options.n2, "a": self.a}
        self.column = self.a, options.n2 * self.a
        self.size = 15 * self.a, 1.5 * self.column[1]
        self.end = 0.5
        if options.n2 == 2:
            self.measured_in = {"data/front_n2_1_a2.25in.csv": "data/front_n2_2_a2.25in_table2.csv",
                                "data/height_n2_1_a2.25in.csv": "data/height_n2_2_a2.25in_table6.csv",
                                "data/front_n2_1_trixiparticles.csv": "data/front_n2_2_a2.25in_openmps.csv"}
        super().__init__(options)

    def gauges(self):
        return {"height": ("alpha.water", self.column_of_cells(0, self.size[1])), "floor": self.floor()}

    def curve(self, name, _column):
        return self.front() if name == "front" else self.wet_length(name)

    def scores(self):
        yield from martin_moyce1952.of_laboratory(self)


class Janosi(Case):
    """A gate as thin as a face of the mesh, which rises by one cell at a time: for each height of its lip the mesh is made
    anew with a wall there, and the run goes on from the fields of the one before."""

    lock, ahead, depth, speed = 0.38, janosi2004.DEPTH, 0.15, 1.5  # m, m, m, m/s
    size = 1.5, 0.3
    column = lock, depth
    end = 0.63
    every = 0.005  # s, between the surfaces that are compared

    def __init__(self, options):
        super().__init__(options)
        self.in_lock = round(self.lock / self.spacing)
        self.height = self.size[1] / self.cells[1]

    def gauges(self):
        return {}

    def blocks(self, lip):
        """Columns and rows of cells of the blocks below and above the lip, left and right of the gate, as blockMesh orders
        them."""
        along, up = self.cells
        rows = [(low, high) for low, high in ((0, lip), (lip, up)) if low < high]
        return [(columns, block) for block in rows for columns in ((0, self.in_lock), (self.in_lock, along))]

    def mesh(self, lip):
        """A wall between the columns of cells at the gate, above `lip` rows of cells: the blocks there share no corners."""
        corners, blocks, walls = [], [], {name: [] for name in ("left", "right", "bottom", "top", "gate", "sides")}

        def corner(x, z, side):
            """Its two numbers, front and back. Along the gate each side has corners of its own."""
            is_shared = x != self.in_lock or z < lip or 0 < z == lip
            pair = [(x, y, z, "" if is_shared else side) for y in (0, THICKNESS)]
            corners.extend(one for one in pair if one not in corners)
            return [corners.index(one) for one in pair]

        _, up = self.cells
        for (first, last), (low, high) in self.blocks(lip):
            is_left = first == 0
            (a, d), (b, c), (e, h), (f, g) = (corner(x, z, "left" if is_left else "right")
                                              for z in (low, high) for x in (first, last))
            blocks.append(f"hex ({a} {b} {c} {d} {e} {f} {g} {h}) ({last - first} 1 {high - low}) simpleGrading (1 1 1)")
            walls["sides"] += [(a, b, f, e), (d, h, g, c)]
            walls["left" if is_left else "right"].append((a, e, h, d) if is_left else (b, c, g, f))
            if low >= lip:
                walls["gate"].append((b, c, g, f) if is_left else (a, e, h, d))
            if low == 0:
                walls["bottom"].append((a, d, c, b))
            if high == up:
                walls["top"].append((e, f, g, h))
        kinds = {"top": "patch", "sides": "empty"}
        points = "\n".join(f"({x * self.spacing} {y} {z * self.height})" for x, y, z, _ in corners)
        faces = {name: " ".join(f"({a} {b} {c} {d})" for a, b, c, d in quads) for name, quads in walls.items()}
        patches = "\n".join(f"{name} {{ type {kinds.get(name, 'wall')}; faces ({faces[name]}); }}" for name in walls)
        self.write("system/blockMeshDict", f"vertices ({points});\nblocks ({' '.join(blocks)});\nboundary ({patches});\n")

    def start_field(self):
        """Fraction of water at the start, by row and column of cells."""
        filled = numpy.zeros((self.cells[1], self.cells[0]))
        for depth, columns in ((self.depth, slice(0, self.in_lock)), (self.ahead, slice(self.in_lock, None))):
            filled[:, columns] = numpy.clip(depth / self.height - numpy.arange(self.cells[1]), 0, 1)[:, None]
        return filled

    def write_inside(self, name, time, values, lip):
        """Replaces the inside of a field file by values of all cells (rows, columns, components)."""
        parts = [values[low:high, first:last].reshape(-1, values.shape[2])
                 for (first, last), (low, high) in self.blocks(lip)]
        texts = [" ".join(f"{x:.9g}" for x in cell) for cell in numpy.concatenate(parts)]
        is_vector = values.shape[2] == 3
        lines = "\n".join(f"({text})" for text in texts) if is_vector else "\n".join(texts)
        file = self.folder / "0" / name
        text = file.read_text()
        kind = "vector" if is_vector else "scalar"
        text = re.sub(r"internalField uniform [^;]*;", f"internalField nonuniform List<{kind}> {len(texts)}\n(\n{lines}\n);", text)
        (self.folder / time).mkdir(exist_ok=True)
        (self.folder / time / name).write_text(text)

    def read_inside(self, name, time, lip):
        """All cells of a field file (rows, columns, components)."""
        text = (self.folder / time / name).read_text()
        found = re.search(r"internalField\s+nonuniform List<\w+>\s*(\d+)\s*\((.*?)\n\)\s*;", text, re.DOTALL)
        cells = numpy.array(found[2].replace("(", " ").replace(")", " ").split(), float).reshape(int(found[1]), -1)
        values, begin = numpy.zeros((self.cells[1], self.cells[0], cells.shape[1])), 0
        for (first, last), (low, high) in self.blocks(lip):
            count = (last - first) * (high - low)
            values[low:high, first:last] = cells[begin:begin + count].reshape(high - low, last - first, -1)
            begin += count
        return values

    def stage(self, start, end, lip, values):
        """Runs from the fields `values` {name: cells} at one time, named as its folder, to another; returns those at the end
        and the name of its folder."""
        self.mesh(lip)
        self.control(start, end, min(self.every, end - float(start)), "ascii")
        if start != "0":  # Fluxes there are those of the mesh before.
            shutil.rmtree(self.folder / start)
        for name, cells in values.items():
            self.write_inside(name, start, cells, lip)
        self.call("blockMesh")
        self.call("interFoam")
        self.cost += cpu_seconds(self.folder / "log.interFoam")
        last = self.times()[-1]
        return {name: self.read_inside(name, last, lip) for name in values}, last

    def times(self):
        """Names of the folders with fields, in order of their times."""
        return sorted((path.name for path in self.folder.iterdir() if re.fullmatch(r"[\d.]+", path.name)), key=float)

    def level(self, filled):
        """Height of the water that is joined with the bed, by column."""
        is_joined = numpy.cumprod(filled > 0.5, axis=0)
        above = numpy.minimum(is_joined.sum(axis=0), len(filled) - 1)
        rest = numpy.take_along_axis(filled, above[None], axis=0)[0]
        return ((filled * is_joined).sum(axis=0) + rest) * self.height

    def run(self):
        for part in (self.fields, self.properties, self.schemes):
            part()
        self.cost = 0.0
        shape = (self.cells[1], self.cells[0])
        values = {"alpha.water": self.start_field()[:, :, None], "U": numpy.zeros((*shape, 3)), "p_rgh": numpy.zeros((*shape, 1))}
        time, lip = "0", 0
        while float(time) < self.end - 1e-6:
            is_out = lip * self.height > self.depth + 2 * self.height
            until = self.end if is_out else (lip + 0.5) * self.height / self.speed
            values, time = self.stage(time, until, self.cells[1] if is_out else lip, values)
            lip += 1

    def scores(self):
        begin = min(janosi2004.INSTANTS) + min(janosi2004.SHIFTS) - self.every  # the gate is out of the water
        names = [name for name in self.times() if float(name) >= begin]
        times = numpy.array(names, float)
        levels = numpy.array([self.level(self.read_inside("alpha.water", name, self.cells[1])[:, :, 0]) for name in names])

        def distance(instant, shift=0.0):
            level = [numpy.interp(instant + shift, times, column) for column in levels.T]
            return rms(1000 * differences_at(*janosi2004.laboratory(self, instant), self.centres(0), numpy.array(level)))

        instants = [instant for instant in janosi2004.INSTANTS if instant >= janosi2004.TARGET_FROM]
        best = min(janosi2004.SHIFTS, key=lambda shift: sum(distance(instant, shift) ** 2 for instant in instants))
        for instant in janosi2004.INSTANTS:
            yield Metric(f"rms {instant:g}", f"RMS distance of the surface, t = {instant:g} s", "mm", "far water at 38 mm",
                         value=distance(instant), shifted_value=distance(instant, best), shift=best)


CASES = {"zhou1999": Zhou, "martin_moyce1952": MartinMoyce, "janosi2004": Janosi}


def cpu_seconds(log):
    return float(re.findall(r"ExecutionTime = ([\d.]+) s", log.read_text())[-1])


def count_steps(log):
    return len(re.findall(r"^Time = ", log.read_text(), re.MULTILINE))


def run_zhou(dx, end, folder):
    """Zhou's dam break for beside.py, with free walls: CPU seconds, simulated seconds, cells of water, steps, and, sampled
    SAMPLES times, times, pressure on the wall (Pa) and length of water at the gauge H1 (m)."""
    case = Zhou(argparse.Namespace(case="zhou1999", out=pathlib.Path(folder) / "interfoam", dx=dx, turbulence="none",
                                   air_density=1.2, surface_tension=0.0, walls="slip"))
    case.end = end
    case.run()
    log = case.folder / "log.interFoam"
    pressure, level = case.curve(zhou1999.READ_AT, "pressure_Pa"), case.curve("H1", "wet_m")
    water = round(case.column[0] * case.column[1] / case.spacing**2)
    return cpu_seconds(log), end, water, count_steps(log), pressure.time, pressure.value, level.value


def may_begin(options):
    """Whether interFoam is installed and the folder is new; prints an error otherwise."""
    if not shutil.which("interFoam"):
        print("error: interFoam is not installed; remedy: apt-get install openfoam", file=sys.stderr)
        return False
    if options.out.exists() and not options.score:
        print(f"error: {options.out} exists; remedy: name a new folder", file=sys.stderr)
        return False
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", choices=CASES)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--dx", type=float, required=True, help="size of the cells, m")
    parser.add_argument("--turbulence", default="none", choices=("none", "kOmegaSST"))
    parser.add_argument("--air-density", type=float, default=1.2, help="kg/m^3")
    parser.add_argument("--surface-tension", type=float, default=0.0, help="N/m; of water 0.072")
    parser.add_argument("--walls", default="slip", choices=("slip", "no-slip"))
    parser.add_argument("--n2", type=int, default=1, choices=(1, 2), help="martin_moyce1952: height of the column over its width")
    parser.add_argument("--end", type=float, help="s")
    parser.add_argument("--score", action="store_true", help="run nothing, score what OUT holds")
    options = parser.parse_args()
    if not may_begin(options):
        return 2
    case = CASES[options.case](options)
    case.end = options.end or case.end
    if not options.score:
        case.run()
    metrics = list(case.scores())
    for metric in metrics:
        value = metric.note if metric.value is None else f"{metric.value:.3f} {metric.unit}"
        shifted = "" if metric.shifted_value is None else f" (at the best shift {metric.shifted_value:.3f})"
        print(f"{metric.what}, for {metric.against}: {value}{shifted}")
    scores = options.out / "scores.json"
    if options.score and scores.exists():
        case.cost = json.loads(scores.read_text())["cpu_s"]
    scores.write_text(
        json.dumps({"cpu_s": case.cost} | {metric.name: metric.value for metric in metrics}, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
