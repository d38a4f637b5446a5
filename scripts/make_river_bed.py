#!/usr/bin/env python3
"""Writes the bed of a river reach as surveyors hand it over: a CSV file of station and elevation along the deepest line.

The reach is 12 m long and falls by 1 in 200. In its middle are a riffle 0.1 m high and a pool behind it; stones make the bed
uneven by a few millimetres, always the same ones.

Usage: make_river_bed.py FILE [--step METRES]
"""
import argparse
import math
from pathlib import Path

LENGTH, SLOPE = 12.0, 1 / 200  # m
RIFFLE, POOL = (5.0, 0.8, 0.10), (7.5, 1.2, -0.12)  # middle, length and height, m
STONES = 0.005  # m
EVEN = 1.0  # m at both ends, where the reach joins the rest of the river


def elevation(x):
    level = SLOPE * (LENGTH - x)
    for middle, length, height in (RIFFLE, POOL):
        level += height * math.exp(-(((x - middle) / length) ** 2))
    if EVEN < x < LENGTH - EVEN:
        level += STONES * (math.sin(7.3 * x) + math.sin(17.9 * x + 1.0)) / 2
    return level


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("--step", type=float, default=0.25, help="between stations, m")
    options = parser.parse_args()
    count = round(LENGTH / options.step)
    lines = ["# station and elevation along the deepest line", "station [m],elevation [m]"]
    for k in range(count + 1):
        station = LENGTH * k / count
        lines.append(f"{station:.3f},{round(elevation(station), 4) + 0.0:.4f}")  # + 0.0 turns -0 into 0
    options.file.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
