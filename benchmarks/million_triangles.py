#!/usr/bin/env python3
"""Measures the cost of loading and checking a mesh of a million triangles: CPU time and memory of `tailwater check`.

The mesh is an uneven sphere of 0.4 m in diameter, a binary STL file, in a tank with 7000 particles of water. The tree of
the mesh, its tests and the search for the wall particles behind it are all part of the figures.

Usage: benchmarks/million_triangles.py [--program build/release/bin/tailwater] [--pictures]
"""
import argparse
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parents[1]
RINGS = 501  # with 2 RINGS pieces around: 4 RINGS (RINGS - 1) = 1 002 000 triangles
CASE = """
[case]
dimension = 3
[particles]
spacing = 0.04
[[fluid]]
min = [-0.4, -0.4, -0.4]
max = [0.4, 0.4, 0.4]
[[wall]]
name = "tank"
shape = "box"
min = [-0.4, -0.4, -0.4]
max = [0.4, 0.4, 0.6]
open = ["+z"]
[[wall]]
name = "rock"
shape = "mesh"
file = "rock.stl"
fluid_side = "outside"
[time]
end = 1.0
"""


def rock():
    """Corners of triangles, their front outside: an array of triangle, corner, coordinate."""
    polar, around = numpy.meshgrid(numpy.linspace(0.0, numpy.pi, RINGS + 1),
                                   numpy.linspace(0.0, 2.0 * numpy.pi, 2 * RINGS + 1), indexing="ij")
    radius = 0.2 + 0.01 * numpy.sin(polar) * numpy.cos(9.0 * around) * numpy.sin(7.0 * polar)
    points = numpy.stack([radius * numpy.sin(polar) * numpy.cos(around), radius * numpy.sin(polar) * numpy.sin(around),
                          radius * numpy.cos(polar)], axis=-1).astype("<f4")
    points[:, -1] = points[:, 0]  # the seam; and each pole is one point
    points[0], points[-1] = points[0, 0], points[-1, 0]
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    below = numpy.stack([a, b, c], axis=-2)[:-1]  # at the lower pole they have no area
    above = numpy.stack([a, c, d], axis=-2)[1:]
    return numpy.concatenate([below.reshape(-1, 3, 3), above.reshape(-1, 3, 3)])


def write_stl(path, triangles):
    records = numpy.zeros(len(triangles), numpy.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)),
                                                       ("attribute", "<u2")]))
    records["corners"] = triangles
    path.write_bytes(bytes(80) + len(triangles).to_bytes(4, "little") + records.tobytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, default=ROOT / "build" / "release" / "bin" / "tailwater")
    parser.add_argument("--pictures", action="store_true", help="with the pictures that check draws")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        triangles = rock()
        write_stl(folder / "rock.stl", triangles)
        (folder / "case.toml").write_text(CASE, encoding="utf-8")
        command = [options.program.resolve(), "check", "case.toml"] + ([] if options.pictures else ["--no-preview"])
        code = subprocess.run(command, cwd=folder, check=False).returncode
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"{len(triangles)} triangles: {used.ru_utime + used.ru_stime:.1f} s CPU, {used.ru_maxrss * 1.024e-3:.0f} MB")
    sys.exit(code)


if __name__ == "__main__":
    main()
