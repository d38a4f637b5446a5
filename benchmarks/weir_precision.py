"""A sharp-crested weir, the template of `tailwater new weir`, for work_precision.py: codes, and the error of their head against
Rehbock's formula. The plate is smooth: interFoam has free walls and no surface tension, as Tailwater."""

import argparse
import pathlib
import shutil
import subprocess

import beside
import interfoam
import numpy as np
from interfoam import THICKNESS
from tailwater import Run
from tailwater_validation import flume

DISCHARGE, HEIGHT, EXPECTED = 0.05, 0.2, 0.09  # q (m^2/s), P and h (m) of the template
UPSTREAM, PIT, TOP = 8 * EXPECTED, 2.5 * EXPECTED, HEIGHT + 2 * EXPECTED  # m
END = 8.0  # s
SPACINGS = (HEIGHT / 8, HEIGHT / 12, HEIGHT / 16)  # m
ERRORS = {"head": ("head above the crest", "relative error")}
BETWEEN = {}


def rehbock_head():
    """m; of water without surface tension, as both codes have it: without the 1.1 mm that Rehbock adds."""
    return flume.solve(lambda head: flume.rehbock(head, HEIGHT, 0.0) - DISCHARGE, 0.0, 1.0)


def errors_of(done):
    """{error: value}. The result of a run is its head (m), the mean of the second half."""
    return {"head": abs(done.result / rehbock_head() - 1)}


class Weir(interfoam.Case):
    """The plate is a wall between cells whose corners below the crest are separate. Water falls out through the floor of the pit,
    which is open, so that air reaches the space below the nappe."""

    gauge = -4 * EXPECTED  # m

    def __init__(self, options):
        self.options, self.end = options, options.end
        self.folder = self.path = options.out
        self.size = UPSTREAM + PIT, TOP
        self.counts = [[max(1, round(length / options.dx)) for length in lengths]
                       for lengths in ((UPSTREAM, PIT), (HEIGHT, TOP - HEIGHT))]

    def gauges(self):
        below, above = self.counts[1]
        edges = np.append(np.linspace(0, HEIGHT, below + 1), np.linspace(HEIGHT, TOP, above + 1)[1:])
        self.sizes = np.diff(edges)
        return {"upstream": ("alpha.water", [(self.gauge, z) for z in 0.5 * (edges[1:] + edges[:-1])])}

    def mesh(self):
        corners = {}

        def corner(x, z, side):
            """Its two numbers, front and back."""
            return corners.setdefault((x, z, side if x == 0.0 and z < HEIGHT else ""), len(corners))

        blocks, faces = [], {name: [] for name in ("inlet", "bottom", "pit", "right", "top", "gate", "sides")}
        for column, (left, right) in enumerate(((-UPSTREAM, 0.0), (0.0, PIT))):
            for row, (low, high) in enumerate(((0.0, HEIGHT), (HEIGHT, TOP))):
                a, b, c, d = (corner(x, z, column) for x, z in ((left, low), (right, low), (right, high), (left, high)))
                front, back = [2 * number for number in (a, b, c, d)], [2 * number + 1 for number in (a, b, c, d)]
                order = (front[0], front[1], back[1], back[0], front[3], front[2], back[2], back[3])
                blocks.append(f"hex ({' '.join(map(str, order))}) ({self.counts[0][column]} 1 {self.counts[1][row]}) "
                              "simpleGrading (1 1 1)")
                faces["sides"] += [(front[0], front[1], front[2], front[3]), (back[0], back[3], back[2], back[1])]
                left_face, right_face = (front[0], front[3], back[3], back[0]), (front[1], back[1], back[2], front[2])
                if column == 0:
                    faces["inlet"].append(left_face)
                if column == 1:
                    faces["right"].append(right_face)
                if row == 0:
                    faces["gate"].append(left_face if column else right_face)
                    faces["pit" if column else "bottom"].append((front[0], back[0], back[1], front[1]))
                if row == 1:
                    faces["top"].append((front[3], front[2], back[2], back[3]))
        points = "\n".join(f"({x} {y} {z})" for x, z, _ in corners for y in (0, THICKNESS))
        kinds = {"sides": "empty", "inlet": "patch", "pit": "patch", "top": "patch"}
        texts = {name: " ".join(f"({' '.join(map(str, quad))})" for quad in quads) for name, quads in faces.items()}
        patches = "\n".join(f"{name} {{ type {kinds.get(name, 'wall')}; faces ({text}); }}" for name, text in texts.items())
        self.write("system/blockMeshDict", f"vertices ({points});\nblocks ({' '.join(blocks)});\nboundary ({patches});\n")

    def field(self, name, dimensions, inside, wall, top, vector=False):
        """Open at the top and at the floor of the pit."""
        inlet = {"U": f"type variableHeightFlowRateInletVelocity; alpha alpha.water; flowRate constant {DISCHARGE * THICKNESS:g}; "
                      "value uniform (0 0 0);",
                 "alpha.water": "type variableHeightFlowRate; lowerBound 0.0; upperBound 0.9; value uniform 0;"}
        patches = {"inlet": inlet.get(name, wall), "bottom": wall, "right": wall, "gate": wall, "sides": "type empty;",
                   "top": top, "pit": top}
        self.write(f"0/{name}", f"dimensions {dimensions};\ninternalField uniform {inside};\nboundaryField {{ "
                   + "\n".join(f"{patch} {{ {text} }}" for patch, text in patches.items()) + " }\n",
                   "volVectorField" if vector else "volScalarField")

    def water(self):
        speed = DISCHARGE / (HEIGHT + EXPECTED)
        self.write("system/setFieldsDict", f"""
defaultFieldValues (volScalarFieldValue alpha.water 0);
regions (boxToCell {{ box (-9 -1 -1) (0 1 {HEIGHT + EXPECTED});
                      fieldValues (volScalarFieldValue alpha.water 1 volVectorFieldValue U ({speed:g} 0 0)); }});
""")

    def head(self):
        times, wet = self.table("upstream", "alpha.water")
        depth = (np.clip(wet, 0, 1) * self.sizes).sum(axis=1)
        return float(depth[times >= 0.5 * self.end].mean()) - HEIGHT


def tailwater(program, dx, settings, folder):
    case, out = folder / "weir.toml", folder / f"weir_{dx:g}"
    subprocess.run([program, "new", "weir", case, "--force"], check=True, stdout=subprocess.DEVNULL)
    words = [word for each in (f"particles.spacing={dx}", *settings) for word in ("--set", each)]
    subprocess.run([program, "run", case, "--out", out, "--force", "--quiet", "-n", "1", *words], check=True)
    curve = Run(out).curve("upstream", "connected_m").window(0.5 * END, END)
    return beside.done_by_tailwater(out, float(curve.value.mean()) - HEIGHT)


def foam(dx, folder):
    case = Weir(argparse.Namespace(out=pathlib.Path(folder) / f"foam_{dx:g}", dx=dx, turbulence="none", air_density=1.2,
                                   surface_tension=0.0, walls="slip", end=END))
    case.run()
    water = round(UPSTREAM * (HEIGHT + EXPECTED) / dx**2)
    return beside.Done(case.cost, END, water, interfoam.count_steps(case.folder / "log.interFoam"), case.head())


def codes(dx, options, folder):
    """{name: Code} of Tailwater and the other codes that are installed."""
    words = "".join(f" --set {setting}" for setting in options.set)
    found = {"Tailwater": beside.Code(f"defaults{words}", "Tailwater",
                                      f"tailwater new weir FILE; tailwater run FILE --set particles.spacing={dx:g}",
                                      lambda: tailwater(options.program, dx, options.set, folder))}
    if shutil.which("interFoam"):
        found["interFoam"] = beside.Code("Courant number 0.4, vanLeer, linearUpwind, PISO of 3 corrections; water and air; free walls",
                                         "Tailwater", f"benchmarks/work_precision.py --case weir --dx {dx:g}", lambda: foam(dx, folder))
    return found
