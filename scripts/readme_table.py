#!/usr/bin/python3
"""The README's validation table, made from what `tailwater validate` wrote.

Usage: scripts/readme_table.py DIR/validation.json    keeps the file as docs/validation.json and writes the table anew
       scripts/readme_table.py --check                exit code 1 if README.md does not agree with docs/validation.json
Without that file the table is empty.
"""
import json
import pathlib
import shutil
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "validation"))
from tailwater_validation.metric import bar  # noqa: E402

README, KEPT = ROOT / "README.md", ROOT / "docs" / "validation.json"
BEGIN, END = "<!-- validation table: begin -->", "<!-- validation table: end -->"


def number(value):
    return "-" if value is None else f"{value:.3g}"


def others(metric):
    if not metric["peers"]:
        return ""
    lowest, highest = (pick(end for peer in metric["peers"] for end in peer["range"]) for pick in (min, max))
    return f"{lowest:g}..{highest:g} ({len(metric['peers'])} codes)"


def table(result):
    """The numbers that have a target, as Markdown between the marks."""
    counts = result["verdicts"]
    scheme = f", scheme {result['scheme']}" if result["scheme"] else ""
    lines = [BEGIN, f"Level `{result['level']}`{scheme}, commit {result['commit']}, {result['date'][:10]}, "
             f"{result['machine']['processor']}: {counts['met']} targets met, {counts['missed']} missed.",
             "Made by `scripts/readme_table.py` from [docs/validation.json](docs/validation.json).", "",
             "| | value | target | | paper | other codes |", "| --- | --- | --- | --- | --- | --- |"]
    for study in result["studies"]:
        with_target = [metric for metric in study["metrics"] if metric["verdict"] != "shown"]
        if with_target:
            lines.append(f"| **{study['title']}** | | | | | |")
        for metric in with_target:
            unit = f" {metric['unit']}" if metric["unit"] else ""
            verdict = "met" if metric["verdict"] == "met" else "**missed**"
            paper = "" if metric["paper"] is None else number(metric["paper"])
            lines.append(f"| {metric['what']} | {number(metric['value'])}{unit} | {bar(metric['low'], metric['high'])} | "
                         f"{verdict} | {paper} | {others(metric)} |")
    return "\n".join([*lines, END])


def with_table(readme, text):
    """The README with its table replaced. Throws ValueError if it has no marks for it."""
    before, after = readme.index(BEGIN), readme.index(END) + len(END)
    return readme[:before] + text + readme[after:]


def main(arguments):
    if arguments == ["--check"]:
        readme = README.read_text(encoding="utf-8")
        made = table(json.loads(KEPT.read_text(encoding="utf-8"))) if KEPT.exists() else f"{BEGIN}\n{END}"
        agrees = with_table(readme, made) == readme
        print("README.md agrees with docs/validation.json" if agrees else
              "README.md does not agree with docs/validation.json; remedy: scripts/readme_table.py docs/validation.json")
        return 0 if agrees else 1
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    source = pathlib.Path(arguments[0])
    README.write_text(with_table(README.read_text(encoding="utf-8"), table(json.loads(source.read_text(encoding="utf-8")))),
                      encoding="utf-8")
    if source.resolve() != KEPT:
        shutil.copyfile(source, KEPT)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
