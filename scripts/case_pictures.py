#!/usr/bin/python3
"""Draws pictures of single cases into docs/images: one run each, and one instant of it.

Usage: scripts/case_pictures.py [PICTURE ...]    of kleefsman2005, spillway_spacing, stl_part; all by default
The runs stay in out and are not made again. All take five minutes of CPU time.
"""
import os
import sys
from typing import NamedTuple

import gallery
import walk_guides
from walk_guides import ROOT, tw

RUNS = ROOT / "out" / "pictures"


class Picture(NamedTuple):
    """`time`, `end` of the run and `interval` of its field files are in s; `colour` is one of `tailwater pictures`."""

    time: float
    end: float
    interval: float
    colour: str = "speed"


PICTURES = {
    "kleefsman2005": Picture(time=0.9, end=0.91, interval=0.3),
    "spillway_spacing": Picture(time=0.7, end=0.71, interval=0.35, colour="spacing"),
    "stl_part": Picture(time=0.4, end=1.0, interval=0.2),
}


def case_of(name):
    """The case of a picture, from cases/, or from the guide, whose files are made in this folder."""
    if name == "kleefsman2005":
        return tw.Case(ROOT / "cases/kleefsman2005/case.toml")
    walk_guides.run_blocks("stl")  # writes the mesh
    return tw.Case(walk_guides.write_case("stl"))


def run_of(name):
    """The run of a picture, made if it is not there. The spillway is that of the gallery."""
    if name == "spillway_spacing":
        return gallery.drawn("spillway", False)
    picture, folder = PICTURES[name], RUNS / name
    if not (folder / "summary.json").is_file():
        case = case_of(name)
        case["time.end"] = picture.end
        case["output.fields_interval"] = picture.interval
        case.run(folder, force=folder.exists())
    return tw.Run(folder)


def main(arguments):
    if unknown := [name for name in arguments if name not in PICTURES]:
        print(f"{__doc__}\nno picture {', '.join(unknown)}", file=sys.stderr)
        return 2
    RUNS.mkdir(parents=True, exist_ok=True)
    os.chdir(RUNS)
    for name in arguments or PICTURES:
        walk_guides.picture(run_of(name), PICTURES[name].time, name, PICTURES[name].colour)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
