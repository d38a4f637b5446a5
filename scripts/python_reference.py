#!/usr/bin/python3
"""The reference of the Python package, from its signatures and docstrings: docs/reference/python.md.

Usage: scripts/python_reference.py            writes the page
       scripts/python_reference.py --check    exit code 1 if the page does not agree with the package
"""
import ast
import pathlib
import sys
import textwrap

from generated_page import write_or_check

ROOT = pathlib.Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "python" / "tailwater"
WIDTH = 120  # characters of a line of the page
PAGE = ROOT / "docs" / "reference" / "python.md"
# Chapters with their names. A name with a module is not in __all__: users get such objects from others.
CHAPTERS = {
    "Cases": ["Case", "Check"],
    "Runs": ["Run", "Probes", "Frame", "Curve", "View"],
    "Sweeps, studies and reports": ["sweep", "Sweep", "study", "Study", "report", "Report"],
    "Simulations in the process": ["simulation.Simulation", "simulation.Step", "simulation.Body"],
    "Errors and warnings": ["Error", "InputError", "SolverError", "IoError", "DataError", "RunWarning"],
    "The program": ["program", "version"],
}
HEAD = """\
# Python reference

For users of the package `tailwater` who look up a class or function. The [guide](../guide/python.md) shows their use.
Numbers are in SI units; in 2D forces, masses and discharges are per metre of width. `scripts/python_reference.py`
writes this page from the docstrings of `python/tailwater`; change these instead.
"""


def modules():
    return {path.stem: ast.parse(path.read_text(encoding="utf-8")) for path in sorted(PACKAGE.glob("*.py"))}


def public_names(init):
    """{name: module} of all exported names."""
    return {alias.name: node.module for node in init.body if isinstance(node, ast.ImportFrom) for alias in node.names}


def signature(function):
    """Arguments without self and cls, and the type of the result."""
    text = ast.unparse(function.args)
    for first in ("self, ", "cls, ", "self", "cls"):
        if text.startswith(first):
            text = text[len(first):]
            break
    result = f" -> {ast.unparse(function.returns)}".replace("'", "") if function.returns else ""
    return f"({text.removeprefix('/, ')}){result}"


def text_of(node):
    """The docstring as Markdown: paragraphs wrapped anew, and indented examples as they are."""
    blocks = (ast.get_docstring(node) or "").split("\n\n")
    return "\n\n".join(block if "\n  " in f"\n{block}" or "\n- " in f"\n{block}" else
                       textwrap.fill(block, WIDTH, break_long_words=False, break_on_hyphens=False) for block in blocks)


def decorators(function):
    return {ast.unparse(decorator) for decorator in function.decorator_list}


def members(cls):
    """Public methods and properties with docstrings, in order; a setter is left out."""
    for node in cls.body:
        if not isinstance(node, ast.FunctionDef) or node.name.startswith("_") or not ast.get_docstring(node):
            continue
        if not any(name.endswith(".setter") for name in decorators(node)):
            yield node


def heading(name, call):
    """A heading with the name alone, and the call below it where there are arguments."""
    lines = textwrap.wrap(f"{name}{call}", WIDTH, subsequent_indent=" " * (len(name) + 1), break_on_hyphens=False)
    return [f"### `{name}`", *(["\n".join(["```python", *lines, "```"])] if call else [])]


def entry(name, node):
    if isinstance(node, ast.FunctionDef):
        return [*heading(name, signature(node)), text_of(node)]
    maker = next((one for one in node.body if isinstance(one, ast.FunctionDef) and one.name == "__init__"), None)
    lines = [*heading(name, signature(maker) if maker else ""), text_of(node)]
    rows = []
    for member in members(node):
        is_property = "property" in decorators(member) or any("property" in word for word in decorators(member))
        call = f"{member.name}" if is_property else f"{member.name}{signature(member)}"
        words = " ".join(text_of(member).split("\n\n")[0].split()).replace("|", "\\|")
        rows.append(f"| `{call}` | {words} |".replace(" | None", " or None"))
    if rows:
        lines.append("\n".join(["| member | meaning |", "| --- | --- |", *rows]))
    return lines


def page():
    trees = modules()
    exported = public_names(trees["__init__"])
    listed = {name for names in CHAPTERS.values() for name in names}
    missing = sorted(set(exported) - listed)
    if missing:
        sys.exit(f"python_reference.py: no chapter has {', '.join(missing)}; remedy: add the names to CHAPTERS")
    lines = [HEAD.rstrip("\n")]
    for chapter, names in CHAPTERS.items():
        lines.append(f"## {chapter}")
        for full in names:
            module, _, name = full.rpartition(".")
            tree = trees[module or exported[name]]
            node = next(one for one in tree.body if getattr(one, "name", None) == name)
            lines += entry(name, node)
    return "\n\n".join(line for line in lines if line) + "\n"


if __name__ == "__main__":
    sys.exit(write_or_check(PAGE, page, __doc__))
