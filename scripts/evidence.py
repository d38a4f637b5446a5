#!/usr/bin/python3
"""The table of evidence, python/tailwater/evidence.json, and the figures that pages take from it.

Usage: scripts/evidence.py           makes the file from docs/validation.json, targets.toml and the cases, and fills the pages
       scripts/evidence.py --check   exit code 1 if the file or a page does not agree; it names both values
       scripts/evidence.py --keys    prints the keys with their values

A page has tables between `<!-- evidence: WHAT -->` and `<!-- evidence: end -->`, where `WHAT` is `all`, names of studies, keys
in quotes after `keys`, as in `keys "zhou1999.noise"`, `counts`, a sentence, or `work CASE`, the cost of errors beside other
codes, `beside CASE`, their cost, noise and arrival, or `readings`, those of laboratories within the scatter of the data. `short` before `WHAT` leaves only quantity, value, target, result and spacing. A figure in a sentence stands between
`<!-- figure: KEY -->` and `<!-- figure: end -->`. docs/validation.json is what `tailwater validate` wrote.
"""
import json
import pathlib
import re
import shlex
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "validation"), str(ROOT / "python")]
from tailwater_validation.evidence import NO_TARGET, NOT_RUN, evidence_of, read_targets  # noqa: E402
from tailwater_validation.peers import beside_table, work_table  # noqa: E402
from tailwater_validation.scatter import read_scatter, readings_table  # noqa: E402

SOURCE, KEPT = ROOT / "docs" / "validation.json", ROOT / "python" / "tailwater" / "evidence.json"
TABLE = re.compile(r"<!-- evidence: (?!end -->)(?P<what>.+?) -->\n.*?<!-- evidence: end -->", re.DOTALL)
FIGURE = re.compile(r"<!-- figure: (?!end -->)(?P<key>.+?) -->(?P<text>.*?)<!-- figure: end -->", re.DOTALL)
PEERS = {"work": work_table, "beside": beside_table}  # tables of other codes
HEAD = ("quantity", "compared with", "computed", "target", "result", "finest particle spacing", "integrator", "walls",
        "CPU s", "paper", "target since")
SHORT = ("quantity", "computed", "target", "result", HEAD[5])  # columns of a short table


def documents():
    return [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")), *sorted((ROOT / "cases").glob("*/README.md")),
            *sorted((ROOT / "paper").glob("*.md"))]


def row(one, columns):
    result = f"**{one['result']}**" if one["result"] in ("missed", NOT_RUN) else one["result"]
    if one["result"] == NO_TARGET and one["note"]:
        result += f": {one['note']}"
    changes = f", {one['changes']} change{'s' * (one['changes'] > 1)}" if one["changes"] and one["target_date"] else ""
    cells = (one["what"], one["against"], one["value_text"], one["target"], result, one["spacing_text"], one["integrator"],
             one["walls"], "" if one["cpu_s"] is None else f"{one['cpu_s']:.3g}",
             "" if one["paper"] is None else f"{one['paper']:.3g}", one["target_date"] + changes)
    return f"| {' | '.join(cell.replace('|', '/') for name, cell in zip(HEAD, cells) if name in columns)} |"


def chosen(evidence, what):
    """Rows of a mark. Throws ValueError for names and keys that the evidence lacks."""
    words = shlex.split(what)
    if words == ["all"]:
        return [one for one in evidence["rows"] if one["target"] or one["note"]]
    field, names = ("key", words[1:]) if words[0] == "keys" else ("flow", words)
    missing = [name for name in names if not any(one[field] == name for one in evidence["rows"])]
    if missing:
        raise ValueError(f"the evidence has no {', '.join(missing)}")
    return [one for name in names for one in evidence["rows"] if one[field] == name]


def sentence(evidence):
    counts = evidence["counts"]
    words = ", ".join(f"{count} {name}" for name, count in counts.items())
    return f"{sum(counts.values())} targets: {words}."


def origin(evidence, has_commit):
    commit = f", commit {evidence['commit']}" if has_commit else ""
    text = (f"All rows are results of one `tailwater validate --level {evidence['level']}`, {evidence['date']}{commit}, "
            f"{evidence['processor']}.")
    return textwrap.fill(text, 120, break_long_words=False, break_on_hyphens=False)


def table(evidence, what):
    """A mark with its table, as Markdown."""
    lines = [f"<!-- evidence: {what} -->"]
    if what == "counts":
        return "\n".join([*lines, sentence(evidence), "<!-- evidence: end -->"])
    if what == "readings":
        return "\n".join([*lines, *readings_table(stored()["studies"], read_scatter()), "<!-- evidence: end -->"])
    if what.split()[0] in PEERS:
        return "\n".join([*lines, *PEERS[what.split()[0]](*what.split()[1:]), "<!-- evidence: end -->"])
    words = what.removeprefix("short ")
    columns = HEAD if words == what else SHORT
    lines += [origin(evidence, what == "all"), ""]
    if what == "all":
        lines += [sentence(evidence), ""]
    lines += [f"| {' | '.join(columns)} |", f"|{' --- |' * len(columns)}"]
    titles, title = {flow["name"]: flow["title"] for flow in evidence["flows"]}, ""
    for one in chosen(evidence, words):
        if titles.get(one["flow"], one["flow"]) != title:
            title = titles.get(one["flow"], one["flow"])
            lines.append(f"| **{title}** |{' |' * (len(columns) - 1)}")
        lines.append(row(one, columns))
    return "\n".join([*lines, "<!-- evidence: end -->"])


def filled(text, evidence):
    """A page with its tables and figures. Throws ValueError for a key that the evidence lacks."""
    values = evidence["figures"]

    def figure(mark):
        if mark["key"] not in values:
            raise ValueError(f"the evidence has no {mark['key']}")
        return f"<!-- figure: {mark['key']} -->{values[mark['key']]}<!-- figure: end -->"

    return FIGURE.sub(figure, TABLE.sub(lambda mark: table(evidence, mark["what"]), text))


def contradictions(text, evidence):
    """Figures and tables of a page that differ from the evidence, one sentence each."""
    values = evidence["figures"]
    found = [f'{mark["key"]}: the page has "{mark["text"]}", the evidence {values.get(mark["key"], "no such key")}'
             for mark in FIGURE.finditer(text) if values.get(mark["key"]) != mark["text"]]
    for mark in TABLE.finditer(text):
        try:
            if table(evidence, mark["what"]) != mark[0]:
                found.append(f"the table {mark['what']} is not that of the evidence")
        except ValueError as error:
            found.append(str(error))
    return found


def stored():
    """Results of the validation."""
    return json.loads(SOURCE.read_text(encoding="utf-8"))


def made():
    return evidence_of(stored(), read_targets())


def text_of(evidence):
    return json.dumps(evidence, indent=1, ensure_ascii=False) + "\n"


def check(evidence):
    found = [] if KEPT.is_file() and KEPT.read_text(encoding="utf-8") == text_of(evidence) else [
        f"{KEPT.relative_to(ROOT)}: is not what docs/validation.json, targets.toml and the cases give"]
    for path in documents():
        found += [f"{path.relative_to(ROOT)}: {one}" for one in contradictions(path.read_text(encoding="utf-8"), evidence)]
    print("\n".join([*found, "remedy: scripts/evidence.py"] if found else ["all agree"]))
    return 1 if found else 0


def main(arguments):
    if arguments not in ([], ["--check"], ["--keys"]):
        print(__doc__, file=sys.stderr)
        return 2
    try:
        evidence = made()
        if arguments == ["--check"]:
            return check(evidence)
        if arguments == ["--keys"]:
            print("\n".join(f"{key}: {value}" for key, value in evidence["figures"].items()))
            return 0
        pages = {path: filled(path.read_text(encoding="utf-8"), evidence) for path in documents()}
    except ValueError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    KEPT.write_text(text_of(evidence), encoding="utf-8")
    for path, text in pages.items():
        if text != path.read_text(encoding="utf-8"):
            path.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
