"""The page of a dossier: one printable HTML file that loads no other files. It holds the content of the JSON file
except the pictures, so that `report --check` can repeat the runs."""

import html
import json
import math
import re

__all__ = ["body", "content_of", "is_page_of", "page", "without_pictures"]

MARK = '<script type="application/json" id="report">'
# The drawing of the case and the section of pictures in a page.
PICTURES = re.compile(r"<figure><svg.*?</svg>\s*<figcaption>[^<]*</figcaption></figure>|<h2>Pictures</h2>(?:<figure><img [^<>]*>"
                      r"<figcaption>[^<]*</figcaption></figure>|<p>[^<]*</p>)*", re.DOTALL)
STYLE = """
body { font: 11pt/1.45 Georgia, serif; max-width: 62em; margin: 2em auto; padding: 0 1em; color: #111; }
h1 { font-size: 1.5em; } h2 { font-size: 1.15em; margin-top: 1.6em; border-bottom: 1px solid #999; }
.answer { font-size: 1.15em; font-weight: bold; padding: .6em .8em; border-left: 6px solid #0072B2; background: #f2f6fa; }
.unreliable { border-color: #D55E00; background: #fdf1e8; }
table { border-collapse: collapse; font-size: .85em; margin: .6em 0; }
th, td { border-bottom: 1px solid #ccc; padding: .2em .6em; text-align: left; vertical-align: top; }
td.number { text-align: right; white-space: nowrap; }
code, pre { font: .85em monospace; overflow-wrap: anywhere; white-space: pre-wrap; }
img, svg { max-width: 100%; height: auto; } figure { margin: .8em 0; break-inside: avoid; }
figcaption { font-size: .85em; }
@media print { body { margin: 0; max-width: none; font-size: 9.5pt; } h2 { break-after: avoid; } tr { break-inside: avoid; } }
"""


def text(value) -> str:
    """The text of a cell: numbers have five digits, a missing value is a dash."""
    if value is None or value == "":
        return "-"
    if isinstance(value, float):
        return "-" if math.isnan(value) else f"{value:.5g}"
    return html.escape(str(value))


def table(names, rows) -> str:
    def cell(value):
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        return f'<td{" class=number" if is_number else ""}>{text(value)}</td>'

    head = "".join(f"<th>{text(name)}</th>" for name in names)
    return (f"<table><tr>{head}</tr>" + "".join("<tr>" + "".join(map(cell, row)) + "</tr>" for row in rows) + "</table>")


def items(lines) -> str:
    return "<ul>" + "".join(f"<li>{text(line)}</li>" for line in lines) + "</ul>"


def section(title, *parts) -> str:
    return f"<h2>{text(title)}</h2>" + "".join(filter(None, parts))


def paragraph(words) -> str:
    return f"<p>{text(words)}</p>" if words else ""


def body(content) -> str:
    """The page without its head, as in a notebook."""
    kind = "answer unreliable" if content["faults"] else "answer"
    parts = [f'<p class="{kind}">{text(content["first_line"])}</p>', f"<h1>{text(content['case']['title'])}</h1>",
             paragraph(f"Question: {content['question']}"), answer(content), results(content), case(content), checks(content),
             runs(content), balances(content), warnings(content), validated(content), limits(content), units(content),
             pictures(content), provenance(content), inputs(content), reproduction(content)]
    return "\n".join(parts)


def without_pictures(content) -> dict:
    """The content without the pictures and the drawing, which a page shows but does not hold."""
    return content | {"pictures": [], "case": content["case"] | {"drawing": ""}}


def page(content) -> str:
    """The HTML file. Its first line of text is the answer, or the reason why it is not reliable."""
    data = json.dumps(without_pictures(content), ensure_ascii=False).replace("</", "<\\/")
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{text(content["case"]["title"])}: report'
            f"</title><style>{STYLE}</style></head>\n<body>\n{body(content)}\n{MARK}{data}</script>\n</body></html>\n")


def content_of(text_of_file: str) -> dict:
    """The content of a page or of a JSON file. Throws ValueError if it is neither."""
    if MARK in text_of_file:
        text_of_file = text_of_file.partition(MARK)[2].partition("</script>")[0]
    content = json.loads(text_of_file)
    if not isinstance(content, dict) or "first_line" not in content:
        raise ValueError("no report")
    return content


def is_page_of(text_of_file: str, content) -> bool:
    """Whether a file is the page of this content. Its pictures are not compared."""
    return PICTURES.sub("", text_of_file) == PICTURES.sub("", page(without_pictures(content)))


def answer(content):
    row = content["answer"]
    if not row or row["low"] is None:
        return ""
    names = ("limit", "low", "high", "value", "order", "discretisation", "chance", "averaging", "step", "eca_hoekstra")
    words = ("limit", "95 % from", "to", "finest run", "order", "discretisation", "chance", "averaging time",
             "half time step", "Eça & Hoekstra ±")
    return (paragraph("The interval covers the errors of spacing, time step, initial positions and averaging time. It "
                      "does not cover what the model leaves out (limits, below).")
            + table([*words, "unit"], [[*(row.get(name) for name in names), row["unit"]]]) + paragraph(row["notes"]))


def results(content):
    rows = [[row["probe"], row["quantity"], row["value"], row["limit"], row["low"], row["high"], row["unit"], row["notes"]]
            for row in content["results"]]
    return section("All results", table(["probe", "quantity", "finest run", "limit", "95 % from", "to", "unit", "notes"], rows))


def case(content):
    told = content["case"]
    drawing = f"<figure>{told['drawing']}<figcaption>Initial state.</figcaption></figure>" if told["drawing"] else ""
    return section("The case", "<p>" + "<br>".join(map(text, told["explain"])) + "</p>" if told["explain"] else "",
                   paragraph(told["note"]), drawing)


def checks(content):
    found = [f"{one['severity']}: {one['message']}" for one in content["case"]["findings"]]
    return section("Checks of the case", items(found) if found else paragraph("No errors and no warnings."))


def runs(content):
    names = ("role", "spacing_m", "fluid_particles", "steps", "dt_mean_s", "courant", "jitter_dx", "seed", "integrator", "ranks",
             "cpu_s", "status", "value")
    words = ["run", "spacing (m)", "fluid particles", "steps", "mean time step (s)", "courant", "jitter (dx)", "seed",
             "integrator", "ranks", "CPU time (s)", "status", "answer"]
    return section("Runs: spacings, initial positions, time steps",
                   table(words, [[run[name] for name in names] for run in content["runs"]]))


def balances(content):
    water = [[run["role"], run["spacing_m"], *(run["water"].get(name) for name in
             ("start", "in", "inside", "outside", "out", "missing")), percent(run["water"].get("missing_relative")),
              percent(run["water"].get("density_error_mean"))] for run in content["runs"]]
    energy = [[run["role"], run["spacing_m"], *(run["energy"].get(name) for name in
              ("start_J", "in_J", "out_J", "brought_by_walls_J", "brought_by_open_ends_J", "viscous_work_J", "end_J",
               "largest_rise_J")), percent(run["energy"].get("largest_rise_over_start"))] for run in content["runs"]]
    return section(
        "Balances", paragraph("Water (m³, in two dimensions m³ per metre of width):"),
        table(["run", "spacing (m)", "start", "in", "inside", "outside", "out", "unaccounted", "relative (%)",
               "mean density error (%)"], water),
        paragraph("Energy (J, in two dimensions J per metre of width):"),
        table(["run", "spacing (m)", "start", "in", "out", "by walls", "by open ends", "viscous", "end", "largest rise",
               "relative to start (%)"], energy))


def percent(value):
    return None if value is None else 100 * value


def warnings(content):
    lines = [f"{one['message']} (spacing {', '.join(f'{spacing:.4g}' for spacing in one['spacings_m'])} m)"
             for one in content["warnings"]]
    return section("Warnings of the runs", items(lines) if lines else paragraph("None."))


def validated(content):
    flow = content["validated"]
    if "name" not in flow:
        return section("Nearest validated flow", paragraph(flow["note"]))
    rows = [[row["what"], row["value_text"], row["target"], row["result"], row["spacing_text"]] for row in flow["rows"]]
    def named(features):
        return ", ".join(features) or "none"

    return section("Nearest validated flow",
                   paragraph(f"{flow['title']}. Shared features: {named(flow['shared'])}. Only in this case: "
                             f"{named(flow['only_here'])}. Only in that flow: {named(flow['only_there'])}."),
                   paragraph(flow["note"]),
                   table(["error there", "value", "target", "result", "spacing"], rows),
                   paragraph(f"Results of commit {flow['commit']}."))


def limits(content):
    return section("Limits that apply to this case", items(f"{one['text']} ({one['page']})" for one in content["limits"]))


def units(content):
    return section("Units, levels and coordinates", items(content["units"]))


def pictures(content):
    figures = [paragraph(f"{one['caption']} {one['note']}") if "note" in one else
               f'<figure><img alt="" src="data:image/png;base64,{one["png"]}"><figcaption>{text(one["caption"])}</figcaption></figure>'
               for one in content["pictures"]]
    return section("Pictures", *figures) if figures else ""


def provenance(content):
    names = {"version": "version", "commit": "commit", "compiler": "compiler", "options": "options", "libraries": "libraries",
             "machine": "machine", "cores": "cores"}
    rows = [[name, "; ".join(map(str, content["provenance"].get(key, [])))] for key, name in names.items()]
    return section("Program and machine", table(["", ""], [*rows, ["this page", f"{content['made_by']}, {content['made']}"]]))


def inputs(content):
    rows = [[f"effective case, {run['role']} at {run['spacing_m']:.4g} m", len(run["case"].encode()), run["case_sha256"]]
            for run in content["runs"]]
    rows += [[one["path"], one["bytes"], one["sha256"]] for one in content["inputs"]]
    return section("Input files", table(["file", "bytes", "SHA-256"], rows))


def reproduction(content):
    missing = [one["path"] for one in content["inputs"] if one["content"] is None]
    return section(
        "How to reproduce", "<pre>tailwater report --check dossier.html</pre>",
        paragraph("This file holds the effective case of each run and the input files. The command runs all of them again with "
                  "the installed program and compares probes and steps bit for bit. For equal bits the program must be of the "
                  "same commit, compiler and processor options."),
        paragraph(f"Not held here, and needed at its place: {', '.join(missing)}") if missing else "")
