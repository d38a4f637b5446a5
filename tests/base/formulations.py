"""Who asks which formulation a case has: the case room, which reads the keys, and the rooms that compute with it. Probes,
checks, walls, operators and runs go by its traits (case/formulation.h). Texts and comments may name a key.
Usage: formulations.py SRC"""
import pathlib
import re
import sys

# run/explain.cpp tells the case in words, as it is written.
MAY_ASK = ("case/", "flow/", "pressure/", "schemes/", "run/explain.cpp")
ASKS = re.compile(r"\b(SchemeName|Formulation|Integrator)::|\bscheme\.\w|\bstudy\.\w|\b(SchemeTable|StudyTable)\b")
TEXT_OR_COMMENT = re.compile(r'"(?:[^"\\\n]|\\.)*"|//[^\n]*')


def violations(src):
    for file in sorted(src.rglob("*")):
        name = file.relative_to(src).as_posix()
        if file.suffix not in {".h", ".cpp"} or name.startswith(MAY_ASK):
            continue
        code = TEXT_OR_COMMENT.sub(lambda found: " " * len(found.group()), file.read_text())
        for number, line in enumerate(code.splitlines(), 1):
            if ASKS.search(line):
                yield f"{file}:{number}: {line.strip()}"


def main():
    found = list(violations(pathlib.Path(sys.argv[1])))
    print("\n".join(found) or "no room asks that does not compute with it")
    sys.exit(1 if found else 0)


main()
