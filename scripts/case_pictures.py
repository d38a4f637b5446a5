#!/usr/bin/python3
"""Draws pictures of single cases into docs/images: one run each, and one instant of it.

Usage: scripts/case_pictures.py [PICTURE ...]    of kleefsman2005, spillway_spacing, stl_part; all by default
The runs stay in out/pictures and are not made again. All take five minutes of CPU time.
"""
import os
import sys
from typing import NamedTuple

import walk_guides
from walk_guides import ROOT, tw

RUNS = ROOT / "out" / "pictures"


class Picture(NamedTuple):
    """`time` and `end` of the run in s; `colour` is one of those of `tailwater pictures`."""

    time: float
    end: float
    colour: str = "speed"


PICTURES = {
    "kleefsman2005": Picture(time=0.9, end=0.95),
    "spillway_spacing": Picture(time=1.3, end=1.31, colour="spacing"),
    "stl_part": Picture(time=0.4, end=1.0),
}


def case_of(name):
    """The case of a picture, from cases/, from a template, or from the guide, whose files are made in this folder."""
    if name == "kleefsman2005":
        return tw.Case(ROOT / "cases/kleefsman2005/case.toml")
    if name == "spillway_spacing":
        return tw.Case.template("spillway")
    walk_guides.run_blocks("stl")  # writes the mesh
    return tw.Case(walk_guides.write_case("stl"))


def main(arguments):
    if unknown := [name for name in arguments if name not in PICTURES]:
        print(f"{__doc__}\nno picture {', '.join(unknown)}", file=sys.stderr)
        return 2
    RUNS.mkdir(parents=True, exist_ok=True)
    os.chdir(RUNS)
    for name in arguments or PICTURES:
        picture, folder = PICTURES[name], RUNS / name
        case = case_of(name)
        case["time.end"] = picture.end
        if not (folder / "summary.json").is_file():
            case.run(folder, force=folder.exists())
        walk_guides.picture(tw.Run(folder), picture.time, name, picture.colour)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
