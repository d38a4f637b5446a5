"""A module of src/ includes only modules below it.

Checks every #include of src/ against the `ROOMS` of the module's CMakeLists.txt, and these against the order of modules
in src/CMakeLists.txt. The core of a flow cannot name a part: modules that take the steps link no module of parts.
Usage: layering.py SRC"""
import pathlib
import re
import sys


CORE = {"flow", "pressure", "schemes", "robust"}
PARTS = {"parts", "open_ends", "air", "bodies", "porous", "rheology"}


def room_order(src):
    text = (src / "CMakeLists.txt").read_text()
    return re.search(r"foreach\(name ([a-z_ ]+)\)", text).group(1).split()


def declared_rooms(room):
    """Modules that the module `room` links; None for the program, which may use all."""
    call = re.search(r"\nroom\(\w+(.*?)\)", "\n" + (room / "CMakeLists.txt").read_text(), re.DOTALL)
    if call is None:
        return None
    words = re.search(r"\bROOMS\b(.*?)(\bLIBRARIES\b|$)", call.group(1), re.DOTALL)
    return words.group(1).split() if words else []


def violations(src):
    order = room_order(src)
    for name in order:
        below = order[: order.index(name)]
        declared = declared_rooms(src / name)
        for other in declared or []:
            if other not in below:
                yield f"src/{name}/CMakeLists.txt: room {name} links {other}, which does not stand below it"
        for part in sorted(PARTS & set(declared or [])) if name in CORE else []:
            yield f"src/{name}/CMakeLists.txt: room {name} links {part}, so that it could ask whether a flow has that part"
        allowed = set(below if declared is None else declared) | {name}
        for file in sorted((src / name).rglob("*")):
            if file.suffix not in {".h", ".cpp"}:
                continue
            for included in re.findall(r'#include "(\w+)/', file.read_text()):
                if included in order and included not in allowed:
                    yield f"{file}: includes room {included}, which room {name} does not link"


def main():
    src = pathlib.Path(sys.argv[1])
    found = list(violations(src))
    print("\n".join(found) or f"{len(room_order(src))} rooms, no include goes up")
    sys.exit(1 if found else 0)


main()
