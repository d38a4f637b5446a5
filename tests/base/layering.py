"""A module of src/ includes only modules below it, and a flow includes few headers and has few members.

Checks every #include of src/ against the `MODULES` of the module's CMakeLists.txt, and these against the order of modules
in src/CMakeLists.txt. The core of a flow cannot name a part: modules that take the steps link no module of parts. No
other code asks whether a flow has a part, because an absent part is an empty one. Counts the headers of src/ behind
flow/flow.h, which most files of the modules above read, and the members of a flow.
Usage: layering.py SRC"""
import pathlib
import re
import sys


CORE = {"flow", "pressure", "schemes", "robust"}
PARTS = {"parts", "open_ends", "air", "bodies", "porous", "rheology"}
ASKS_FOR_PART = re.compile(r"\bpart<[\w<>]+>\(\)(\.\w+\(\))*\.(empty|size|is_\w*empty)\(\)|"
                           r"dynamic_cast<(const )?\w+<Dim>\*")
MAY_CAST = {"flow/flow.h", "parts/script_loads.cpp"}  # Flow::part, and the part that a script adds to a running flow
MOST_BEHIND_FLOW = 40
MOST_MEMBERS = {"Setup": 15, "State": 6, "Flow": 10}  # half of those before there were parts


def module_order(src):
    text = (src / "CMakeLists.txt").read_text()
    return re.search(r"foreach\(name ([a-z_ ]+)\)", text).group(1).split()


def declared_modules(module):
    """Modules that the module `module` links; None for the program, which may use all."""
    call = re.search(r"\nmodule\(\w+(.*?)\)", "\n" + (module / "CMakeLists.txt").read_text(), re.DOTALL)
    if call is None:
        return None
    words = re.search(r"\bMODULES\b(.*?)(\bLIBRARIES\b|$)", call.group(1), re.DOTALL)
    return words.group(1).split() if words else []


def violations(src):
    order = module_order(src)
    for name in order:
        below = order[: order.index(name)]
        declared = declared_modules(src / name)
        for other in declared or []:
            if other not in below:
                yield f"src/{name}/CMakeLists.txt: module {name} links {other}, which does not stand below it"
        for part in sorted(PARTS & set(declared or [])) if name in CORE else []:
            yield f"src/{name}/CMakeLists.txt: module {name} links {part}, so that it could ask whether a flow has that part"
        allowed = set(below if declared is None else declared) | {name}
        for file in sorted((src / name).rglob("*")):
            if file.suffix not in {".h", ".cpp"}:
                continue
            text = file.read_text()
            if ASKS_FOR_PART.search(text) and file.relative_to(src).as_posix() not in MAY_CAST:
                yield f"{file}: asks whether a flow has a part; use what an empty part gives"
            for included in re.findall(r'#include "(\w+)/', text):
                if included in order and included not in allowed:
                    yield f"{file}: includes module {included}, which module {name} does not link"


def headers_behind(src, header):
    """The headers of src/ that `header` includes, and those that these include."""
    seen = set()
    left = [header]
    while left:
        for included in re.findall(r'^#include "([^"]+)"', (src / left.pop()).read_text(), re.MULTILINE):
            if included not in seen and (src / included).exists():
                seen.add(included)
                left.append(included)
    return sorted(seen)


def members(src, name):
    """The data members of a struct in the module `flow`, as they are declared."""
    text = re.sub(r"//.*", "", (src / "flow" / f"{name.lower()}.h").read_text())
    body = re.search(rf"\nstruct {name} {{(.*?)\n}};", text, re.DOTALL).group(1)
    while re.search(r"{[^{}]*}", body):  # bodies of functions, then those around them
        body = re.sub(r"{[^{}]*}", ";", body)
    return [" ".join(line.split()) for line in body.split(";") if line.strip() and "(" not in line]


def main():
    src = pathlib.Path(sys.argv[1])
    found = list(violations(src))
    behind_flow = headers_behind(src, "flow/flow.h")
    if len(behind_flow) > MOST_BEHIND_FLOW:
        found.append(f"flow/flow.h includes {len(behind_flow)} headers, at most {MOST_BEHIND_FLOW}; declare types "
                     f"whose members are not needed: {' '.join(behind_flow)}")
    count = {name: len(members(src, name)) for name in MOST_MEMBERS}
    for name, most in MOST_MEMBERS.items():
        if count[name] > most:
            found.append(f"{name} has {count[name]} members, at most {most}; give a part or a struct of its own what "
                         f"belongs together: {', '.join(members(src, name))}")
    counts = f"{len(module_order(src))} modules, {len(behind_flow)} headers behind flow/flow.h, members {count}"
    print("\n".join(found) or f"{counts}; no include goes up, and nobody asks for a part")
    sys.exit(1 if found else 0)


main()
