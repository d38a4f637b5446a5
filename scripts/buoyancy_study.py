#!/usr/bin/python3
"""Bodies in water at rest: the force on them over the weight of the water they displace (docs/theory/probes.md).

A cylinder and a tilted square in two dimensions; a sphere, a cylinder and a tilted cube, each as STL, in three. Each is
fixed near the middle of a tank, off the water's lattice by a fraction of dx, as bodies of real cases are.

Printed are, over the weight of the water that the body displaces, the mean force over the second half of the run, the
weight of the water that is really missing in the tank, and the mean force across; the force on all walls over the weight
of the water; and the speed at the end over sqrt(g depth).

Usage: scripts/buoyancy_study.py [--bodies NAME ...] [--resolutions N ...] [--jitter SHARE] [--end SECONDS]
       [--off SHARE ...] [--set KEY=VALUE ...]    needs build/release/bin/tailwater
"""
import argparse
import csv
import json
import math
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
DENSITY, GRAVITY = 1000.0, 9.81
SIZE = 1.0  # m; diameter of a round body, edge of the others
TANK = 1.6  # sizes; width and depth of the water
PIECES = 96  # around a circle

OFF = (0.31, 0.12, 0.22)  # dx; off the lattice along x, y and z

TILT_2D = 0.4  # rad
TILTS_3D = (0.5, 0.3)  # rad; about z, then about x


def text_of_stl(triangles):
    lines = ["solid body"]
    for triangle in triangles:
        lines += ["facet normal 0 0 0", " outer loop"]
        lines += [f"  vertex {x:.6f} {y:.6f} {z:.6f}" for x, y, z in triangle]
        lines += [" endloop", "endfacet"]
    return "\n".join(lines + ["endsolid body", ""])


def circle():
    angles = [2.0 * math.pi * k / PIECES for k in range(PIECES)]
    return [(0.5 * SIZE * math.cos(a), 0.5 * SIZE * math.sin(a)) for a in angles]


def tilted_square():
    c, s = 0.5 * SIZE * math.cos(TILT_2D), 0.5 * SIZE * math.sin(TILT_2D)
    return [(s - c, -c - s), (c + s, s - c), (c - s, c + s), (-c - s, c - s)]


def area_of(corners):
    return 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(corners, corners[1:] + corners[:1]))


def volume_of(triangles):
    def six_volumes(a, b, c):
        return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                a[2] * (b[0] * c[1] - b[1] * c[0]))
    return sum(six_volumes(*t) for t in triangles) / 6.0


def quad(a, b, c, d):
    return [(a, b, c), (a, c, d)]


def sphere():
    rings = PIECES // 2

    def at(ring, k):
        polar, around = math.pi * ring / rings, 2.0 * math.pi * (k % PIECES) / PIECES
        sine = math.sin(polar) if 0 < ring < rings else 0.0
        return (0.5 * SIZE * sine * math.cos(around), 0.5 * SIZE * sine * math.sin(around), -0.5 * SIZE * math.cos(polar))
    triangles = []
    for ring in range(rings):
        for k in range(PIECES):
            corners = at(ring, k), at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k)
            triangles += [t for t in quad(*corners) if len(set(t)) == 3]
    return triangles


def cylinder():
    """Its axis along y."""
    rim = circle()
    half = 0.5 * SIZE
    triangles = []
    for (x0, z0), (x1, z1) in zip(rim, rim[1:] + rim[:1]):
        triangles += quad((x0, -half, z0), (x0, half, z0), (x1, half, z1), (x1, -half, z1))
        triangles += [((0.0, half, 0.0), (x1, half, z1), (x0, half, z0)),
                      ((0.0, -half, 0.0), (x0, -half, z0), (x1, -half, z1))]
    return triangles


def tilted_cube():
    def turned(x, y, z):
        c, s = math.cos(TILTS_3D[0]), math.sin(TILTS_3D[0])
        x, y = c * x - s * y, s * x + c * y
        c, s = math.cos(TILTS_3D[1]), math.sin(TILTS_3D[1])
        return x, c * y - s * z, s * y + c * z
    p = [turned(*(0.5 * SIZE * (1 if k & bit else -1) for bit in (1, 2, 4))) for k in range(8)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return [triangle for face in faces for triangle in quad(*(p[k] for k in face))]


FLAT = {"circle": circle, "square": tilted_square}
SOLID = {"sphere": sphere, "cylinder": cylinder, "cube": tilted_cube}


def case_text(body, wall, dimension, cells, end):
    span = [f"{TANK * SIZE}"] * dimension
    top = span[:-1] + [f"{1.4 * TANK * SIZE}"]
    rest = ", ".join(["0"] * dimension)
    return f"""
[case]
title = "{body} in water at rest"
dimension = {dimension}
[particles]
spacing = {SIZE / cells}
[[fluid]]
min = [{rest}]
max = [{", ".join(span)}]
[[wall]]
name = "tank"
shape = "box"
min = [{rest}]
max = [{", ".join(top)}]
open = ["{"+y" if dimension == 2 else "+z"}"]
fluid_side = "inside"
[[wall]]
name = "body"
{wall}
fluid_side = "outside"
[time]
end = {end}
[[probe]]
name = "body"
type = "force"
walls = ["body"]
moment_about = [{rest}]
[[probe]]
name = "all"
type = "force"
moment_about = [{rest}]
[[probe]]
name = "energy"
type = "energy"
"""


def second_half(path, end):
    """The rows of a probe from end/2 on, as dictionaries of numbers."""
    with path.open() as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    return [row for row in rows if row["time_s"] >= 0.5 * end]


def mean(rows, column):
    return sum(row[column] for row in rows) / len(rows)


def study(body, cells, options, folder):
    dimension = 2 if body in FLAT else 3
    middle = [0.5 * TANK * SIZE + off * SIZE / cells for off in options.off]
    if dimension == 2:
        corners = FLAT[body]()
        volume = area_of(corners)
        points = ", ".join(f"[{x + middle[0]:.9f}, {y + middle[1]:.9f}]" for x, y in corners)
        wall = f'shape = "polygon"\npoints = [{points}]'
    else:
        triangles = SOLID[body]()
        volume = volume_of(triangles)
        (folder / "body.stl").write_text(text_of_stl(triangles))
        wall = f'shape = "mesh"\nfile = "body.stl"\ntranslate = {middle}'
    case = folder / "case.toml"
    case.write_text(case_text(body, wall, dimension, cells, options.end))
    settings = [f"particles.jitter={options.jitter}", *options.set]
    subprocess.run([options.program, "run", case, "--out", folder / "run", "--force", "--quiet", "-n", "1",
                    *(word for setting in settings for word in ("--set", setting))], check=True)
    up, across = ("y", "x") if dimension == 2 else ("z", "x")
    unit = "N_per_m" if dimension == 2 else "N"
    probes = folder / "run/probes"
    on_body, on_all = (second_half(probes / f"{name}.csv", options.end) for name in ("body", "all"))
    weight = DENSITY * GRAVITY * volume
    start = json.loads((folder / "run/summary.json").read_text())["water_balance"]["start"]["volume_m3"]
    missing = (TANK * SIZE) ** dimension - start
    water = DENSITY * GRAVITY * start
    kinetic = second_half(probes / "energy.csv", options.end)[-1]["kinetic_J"]
    speed = math.sqrt(2.0 * kinetic * GRAVITY / water) / math.sqrt(GRAVITY * TANK * SIZE)
    print(f"| {body} | {cells} | {mean(on_body, f'force_{up}_{unit}') / weight:.4f} | {missing / volume:.4f} | "
          f"{mean(on_body, f'force_{across}_{unit}') / weight:+.4f} | "
          f"{-mean(on_all, f'force_{up}_{unit}') / water:.4f} | {speed:.1e} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bodies", nargs="+", default=[*FLAT, *SOLID], choices=[*FLAT, *SOLID])
    parser.add_argument("--resolutions", nargs="+", type=int, default=[10, 20], help="dx across a body")
    parser.add_argument("--jitter", type=float, default=0.0, help="of the start, dx")
    parser.add_argument("--end", type=float, default=0.4, help="s")
    parser.add_argument("--off", nargs=3, type=float, default=OFF, help="of the body from the lattice along x, y, z, dx")
    parser.add_argument("--set", nargs="+", default=[], help="further settings of the runs")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/tailwater")
    options = parser.parse_args()
    print("| body | size/dx | force over weight | water missing | across | water carried | speed, rms over sqrt(g depth) |")
    print("| --- | --- | --- | --- | --- | --- | --- |", flush=True)
    for body in options.bodies:
        for cells in options.resolutions:
            with tempfile.TemporaryDirectory() as folder:
                study(body, cells, options, pathlib.Path(folder))


if __name__ == "__main__":
    main()
