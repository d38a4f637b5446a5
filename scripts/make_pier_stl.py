#!/usr/bin/env python3
"""Writes a round pier as an ASCII STL file in millimetres: its axis along z, from z = -100 to the given height.

Usage: make_pier_stl.py FILE [--diameter MM] [--height MM] [--pieces N]
"""
import argparse
import math
from pathlib import Path

FOOT = -100.0  # mm; below the floor that it stands on


def triangles_of_pier(diameter, height, pieces):
    """Triangles with their front outside: the side, the top and the foot."""
    angles = [2.0 * math.pi * k / pieces for k in range(pieces + 1)]
    rim = [(0.5 * diameter * math.cos(a), 0.5 * diameter * math.sin(a)) for a in angles[:-1]]
    rim.append(rim[0])
    triangles = []
    for (x0, y0), (x1, y1) in zip(rim, rim[1:]):
        low0, low1 = (x0, y0, FOOT), (x1, y1, FOOT)
        high0, high1 = (x0, y0, height), (x1, y1, height)
        triangles += [(low0, low1, high1), (low0, high1, high0)]
        triangles += [((0.0, 0.0, height), high0, high1), ((0.0, 0.0, FOOT), low1, low0)]
    return triangles


def text_of_stl(triangles):
    lines = ["solid pier"]
    for triangle in triangles:
        lines += ["facet normal 0 0 0", " outer loop"]
        lines += [f"  vertex {x:.6f} {y:.6f} {z:.6f}" for x, y, z in triangle]
        lines += [" endloop", "endfacet"]
    return "\n".join(lines + ["endsolid pier", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("--diameter", type=float, default=200.0, help="mm")
    parser.add_argument("--height", type=float, default=600.0, help="mm")
    parser.add_argument("--pieces", type=int, default=64, help="flat pieces around it")
    options = parser.parse_args()
    options.file.write_text(text_of_stl(triangles_of_pier(options.diameter, options.height, options.pieces)))


if __name__ == "__main__":
    main()
