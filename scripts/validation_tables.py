#!/usr/bin/python3
"""The tables of results in the documents, made from what `tailwater validate` wrote.

Usage: scripts/validation_tables.py DIR/validation.json   keeps the file as docs/validation.json and writes the tables anew
       scripts/validation_tables.py --check               exit code 1 if a table does not agree with docs/validation.json

A table stands between `<!-- validation: WHAT -->` and `<!-- validation: end -->`. WHAT is `all`, names of studies, or names
of metrics in quotes after `metrics`, as in `metrics "zhou1999.noise" "jet.pressure_error"`. `counts` makes a sentence with
the numbers of targets that are met and missed.
"""
import json
import pathlib
import re
import shlex
import shutil
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "validation"), str(ROOT / "python")]
from tailwater_validation.metric import bar, shown  # noqa: E402

KEPT = ROOT / "docs" / "validation.json"
END = "<!-- validation: end -->"
TABLE = re.compile(r"<!-- validation: (?!end -->)(?P<what>.+?) -->\n.*?" + re.escape(END), re.DOTALL)


def documents():
    return [ROOT / "README.md", ROOT / "docs" / "validation.md", *sorted((ROOT / "cases").glob("*/README.md"))]


def number(value):
    return "-" if value is None else f"{value:.3g}"


def others(metric):
    if not metric["peers"]:
        return ""
    lowest, highest = (pick(end for peer in metric["peers"] for end in peer["range"]) for pick in (min, max))
    values = f"{lowest:g}" if lowest == highest else f"{lowest:g}..{highest:g}"
    return f"{values} ({len(metric['peers'])} code{'s' * (len(metric['peers']) > 1)})"


def row(metric):
    unit = f" {metric['unit']}" if metric["unit"] else ""
    target = "" if metric["verdict"] == "shown" else bar(metric["low"], metric["high"])
    verdict = {"met": "met", "missed": "**missed**", "shown": ""}[metric["verdict"]]
    paper = "" if metric["paper"] is None else number(metric["paper"])
    what = metric["what"] + (f", {metric['variant']}" if metric["variant"] else "")
    return f"| {what} | {shown(metric)}{unit} | {target} | {verdict} | {paper} | {others(metric)} |"


def origin(result):
    scheme = f", scheme {result['scheme']}" if result["scheme"] else ""
    return (f"`tailwater validate --level {result['level']}`{scheme}, {result['date'][:10]}, "
            f"{result['machine']['processor']}")


def chosen(result, what):
    """[(title, metrics)] of a mark. Throws ValueError for names that the results do not have."""
    words = shlex.split(what)
    studies = {study["name"]: study for study in result["studies"]}
    if words[0] == "metrics":
        metrics = {metric["name"]: (study["title"], metric) for study in studies.values() for metric in study["metrics"]}
        missing = [name for name in words[1:] if name not in metrics]
        rows = [(metrics[name][0], [metrics[name][1]]) for name in words[1:] if not missing]
    else:
        missing = [name for name in words if name not in studies and words != ["all"]]
        rows = [(study["title"], [metric for metric in study["metrics"] if metric["verdict"] != "shown"] or
                 ([] if words == ["all"] else study["metrics"]))
                for name, study in studies.items() if words == ["all"] or name in words]
    if missing:
        raise ValueError(f"no results of {', '.join(missing)}")
    return rows


def table(result, what):
    """A mark with its table, as Markdown. Throws ValueError as `chosen` does."""
    lines = [f"<!-- validation: {what} -->"]
    counts = result["verdicts"]
    if what == "counts":
        targets = counts["met"] + counts["missed"]
        return "\n".join([*lines, f"{counts['met']} of {targets} targets are met, {counts['missed']} are missed.", END])
    if what == "all":
        lines += [f"{origin(result)}, commit {result['commit']}:", f"{counts['met']} targets met, {counts['missed']} missed.", ""]
    else:
        lines += [f"{origin(result)}:", ""]
    lines += ["| | value | target | | paper | other codes |", "| --- | --- | --- | --- | --- | --- |"]
    title = ""
    for study_title, metrics in chosen(result, what):
        if metrics and study_title != title:
            title = study_title
            lines.append(f"| **{title}** | | | | | |")
        lines += [row(metric) for metric in metrics]
    return "\n".join([*lines, END])


def with_tables(text, result):
    return TABLE.sub(lambda mark: table(result, mark["what"]), text)


def main(arguments):
    if len(arguments) != 1 or (arguments[0].startswith("-") and arguments[0] != "--check"):
        print(__doc__, file=sys.stderr)
        return 2
    checks = arguments[0] == "--check"
    source = KEPT if checks else pathlib.Path(arguments[0])
    result = json.loads(source.read_text(encoding="utf-8"))
    stale = []
    for path in documents():
        text = path.read_text(encoding="utf-8")
        made = with_tables(text, result)
        if made != text:
            stale.append(path.relative_to(ROOT))
            if not checks:
                path.write_text(made, encoding="utf-8")
    if not checks and source.resolve() != KEPT:
        shutil.copyfile(source, KEPT)
    if checks and stale:
        print(f"{', '.join(map(str, stale))}: the tables do not agree with docs/validation.json; remedy: "
              "scripts/validation_tables.py docs/validation.json")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
