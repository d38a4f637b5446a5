"""Only the factory of a formulation reads which one a case has.

No other file of src/ above the module `case` names a formulation or reads [scheme]; texts and comments may name one.
Usage: formulations.py SRC"""
import pathlib
import re
import sys

# The module `case` has the keys; the factory and the makers of the formulations read them. run/explain.cpp prints a
# summary of the case as it is written.
MAY_ASK = ("case/", "case_help/help.cpp", "robust/formulation.cpp", "published/farzin2014.cpp", "published/farmani2020.cpp",
           "published/make_flow.cpp", "run/explain.cpp")
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
    print("\n".join(found) or "no file above the formulations asks which one it is")
    sys.exit(1 if found else 0)


main()
