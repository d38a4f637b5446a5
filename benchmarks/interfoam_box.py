#!/usr/bin/python3
"""SPHERIC's benchmark 2, a dam break against a box in 3D, by OpenFOAM's interFoam, scored like a run of Tailwater.

Usage: benchmarks/interfoam_box.py OUT --dx METRES [--end SECONDS] [--walls slip|no-slip] [--score]
OUT is made anew: the case that interFoam ran, and scores.json. --score runs nothing and scores OUT, also of a run that
goes on: up to its present time. Needs Debian's package openfoam. With cells of 0.05 m (11 over the depth) the run takes
about ten minutes of CPU time, with half that size sixteen times as long.
"""
import argparse
import itertools
import json
import pathlib
import sys

import interfoam
import numpy
from tailwater.curves import Curve
from tailwater_validation.studies import kleefsman2005

LEVEL_BELOW = 0.95  # m, height up to which the water of a gauge is sampled
FACES = {(0, -1): (0, 4, 7, 3), (0, 1): (1, 2, 6, 5), (1, -1): (0, 1, 5, 4), (1, 1): (3, 7, 6, 2), (2, -1): (0, 3, 2, 1),
         (2, 1): (4, 5, 6, 7)}  # corners of a block on its side of an axis
PATCHES = {(0, -1): "left", (0, 1): "right", (1, -1): "sides", (1, 1): "sides", (2, -1): "bottom", (2, 1): "top"}


class Box(interfoam.Case):
    """Blocks of cells between planes at the sides of box and water; the block of the box is left out."""

    sides = ""  # walls
    end = kleefsman2005.END
    size = 3.22, 1.0  # m, length and height
    box_length, box_side = (0.6635, 0.8245), (0.2985, 0.7015)  # m
    planes = ((0.0, *box_length, 3.22 - 1.228, 3.22), (0.0, *box_side, 1.0), (0.0, 0.161, kleefsman2005.DEPTH, 1.0))
    gauge_y = {"H": 0.5, "P": 0.5255}

    def __init__(self, options):
        super().__init__(options)
        self.counts = [[max(1, round((high - low) / options.dx)) for low, high in itertools.pairwise(axis)]
                       for axis in self.planes]

    def edges(self, axis):
        """Coordinates between the cells along an axis."""
        parts = [numpy.linspace(low, high, count + 1)[:-1]
                 for (low, high), count in zip(itertools.pairwise(self.planes[axis]), self.counts[axis])]
        return numpy.append(numpy.concatenate(parts), self.planes[axis][-1])

    def heights(self):
        edges = self.edges(2)
        return 0.5 * (edges[1:] + edges[:-1])

    def is_cell_block(self, place):
        return all(0 <= number < len(counts) for number, counts in zip(place, self.counts)) and tuple(place) != (1, 1, 0)

    def mesh(self):
        shape = [len(axis) for axis in self.planes]

        def corner(i, j, k):
            return (k * shape[1] + j) * shape[0] + i

        points = "\n".join(f"({x} {y} {z})" for z in self.planes[2] for y in self.planes[1] for x in self.planes[0])
        blocks, faces = [], {name: [] for name in (*PATCHES.values(), "box")}
        for place in filter(self.is_cell_block, itertools.product(*(range(len(counts)) for counts in self.counts))):
            i, j, k = place
            corners = [corner(i + a, j + b, k + c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
            cells = " ".join(str(counts[number]) for counts, number in zip(self.counts, place))
            blocks.append(f"hex ({' '.join(map(str, corners))}) ({cells}) simpleGrading (1 1 1)")
            for (axis, step), face in FACES.items():
                beyond = [number + step * (axis == each) for each, number in enumerate(place)]
                if not self.is_cell_block(beyond):
                    name = "box" if tuple(beyond) == (1, 1, 0) else PATCHES[axis, step]
                    faces[name].append(f"({' '.join(str(corners[number]) for number in face)})")
        patches = "\n".join(f"{name} {{ type {'patch' if name == 'top' else 'wall'}; faces ({' '.join(each)}); }}"
                            for name, each in faces.items())
        self.write("system/blockMeshDict", f"vertices ({points});\nblocks ({' '.join(blocks)});\nboundary ({patches});\n")

    def water(self):
        self.write("system/setFieldsDict", f"""
defaultFieldValues (volScalarFieldValue alpha.water 0);
regions (boxToCell {{ box ({self.planes[0][3]} -1 -1) (9 9 {kleefsman2005.DEPTH});
                      fieldValues (volScalarFieldValue alpha.water 1); }});
""")

    def gauges(self):
        heights = [z for z in self.heights() if z < LEVEL_BELOW]
        places = {probe["name"]: probe["at"][0] for probe in self.case["probe"] if probe["name"] in kleefsman2005.GAUGES}
        wires = {name: ("alpha.water", [(x, self.gauge_y["H"], z) for z in heights]) for name, x in places.items()}
        # Half a cell in front of the face.
        wall = [(self.box_length[1] + 0.5 * self.options.dx, self.gauge_y["P"], z) for z in heights if z < 0.3]
        return wires | {"wall": ("p", wall)}

    def curve(self, name, column):
        if name in kleefsman2005.GAUGES:
            times, wet = self.table(name, "alpha.water")
            sizes = numpy.diff(self.edges(2))[:wet.shape[1]]
            wet = numpy.clip(wet, 0, 1)
            joined = numpy.cumprod(wet > 0.5, axis=1)
            above = numpy.minimum(joined.sum(axis=1), wet.shape[1] - 1)
            rest = (wet * sizes)[numpy.arange(len(wet)), above] * (joined.sum(axis=1) < wet.shape[1])
            highest = (wet > 0.5) * (numpy.cumsum(sizes))
            return Curve(times, (wet * joined * sizes).sum(axis=1) + rest if column == "connected_m" else highest.max(axis=1))
        times, pressure = self.table("wall", "p")
        heights = [z for z in self.heights() if z < 0.3]
        curve = Curve(times, numpy.array([numpy.interp(kleefsman2005.SENSORS[name], heights, row) for row in pressure]))
        return kleefsman2005.impulses(curve) if column == "impulse_Pa_s" else curve

    @property
    def summary(self):
        """The time that the run has reached, as `end_of` reads it."""
        return {"time_s": {"reached": float(self.table("H1", "alpha.water")[0][-1]) + 1e-9}}

    def scores(self):
        yield from kleefsman2005.of_heights(self)
        for sensor, height in kleefsman2005.SENSORS.items():
            yield from kleefsman2005.of_sensor(self, sensor, height)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--dx", type=float, required=True, help="size of the cells, m")
    parser.add_argument("--end", type=float, help="s")
    parser.add_argument("--walls", default="slip", choices=("slip", "no-slip"))
    parser.add_argument("--score", action="store_true", help="run nothing, score what OUT holds")
    options = parser.parse_args()
    if not interfoam.may_begin(options):
        return 2
    options.case, options.turbulence, options.air_density, options.surface_tension = "kleefsman2005", "none", 1.2, 0.0
    case = Box(options)
    case.end = options.end or case.end
    if not options.score:
        case.run()
    metrics = list(case.scores())
    for metric in metrics:
        value = metric.note if metric.value is None else f"{metric.value:.3f} {metric.unit}"
        print(f"{metric.what}, for {metric.against}: {value}")
    cost = interfoam.cpu_seconds(options.out / "log.interFoam")
    found = {"cpu_s": cost} | {metric.name: metric.value for metric in metrics}
    (options.out / "scores.json").write_text(json.dumps(found, indent=2) + "\n")
    print(f"{cost:.0f} CPU s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
