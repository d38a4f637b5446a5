"""The report: one HTML page that needs no other file."""

import base64
import html
import io
import re
from urllib.parse import quote

from matplotlib import rc_context
from PIL import Image

from .metric import bar
from .plots import STYLE, WIDTH
from .runs import duration
from .study import KINDS

RESOLUTION = 130  # dpi of pictures with particles
PATH = re.compile(rb' d="[^"]*"')
COMMENT = re.compile(rb"<!--.*?-->", re.DOTALL)
PICTURE = re.compile(rb'data:image/png;base64,([^"]*)')
LONG_NUMBER = re.compile(rb"(\.\d\d)\d+")

CSS = """\
:root { --ink: #1d2733; --soft: #5b6875; --line: #dfe4ea; --met: #00705a; --missed: #b3261e; --blue: #0072B2; }
* { box-sizing: border-box; }
body { margin: 0; color: var(--ink); background: #fff; font: 16px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
main { max-width: 72rem; margin: 0 auto; padding: 0 1.5rem 4rem; }
header { background: linear-gradient(160deg, #063a5b, #0072B2 70%, #56B4E9); color: #fff; padding: 2.2rem 0 1.8rem; }
header div { max-width: 72rem; margin: 0 auto; padding: 0 1.5rem; }
h1 { margin: 0 0 .3rem; font-size: 2rem; font-weight: 650; }
header p { margin: .2rem 0; opacity: .92; }
.tiles { display: flex; flex-wrap: wrap; gap: 1rem; margin: 1.6rem 0; }
.tile { flex: 1 1 9rem; border: 1px solid var(--line); border-top: 4px solid var(--soft); border-radius: 4px;
        padding: .7rem 1rem; }
.tile b { display: block; font-size: 1.9rem; line-height: 1.2; }
.tile.met { border-top-color: var(--met); } .tile.missed { border-top-color: var(--missed); }
h2 { margin: 3.2rem 0 .4rem; padding-top: .8rem; border-top: 2px solid var(--ink); font-size: 1.45rem; }
h3 { margin: 1.8rem 0 .5rem; font-size: 1.05rem; }
p { max-width: 52rem; }
.soft { color: var(--soft); }
table { border-collapse: collapse; width: 100%; margin: .8rem 0; font-size: .86rem; font-variant-numeric: tabular-nums; }
th { text-align: left; vertical-align: bottom; color: var(--soft); font-weight: 600; border-bottom: 1.5px solid var(--ink); }
th, td { padding: .28rem .55rem .28rem 0; vertical-align: top; }
td { border-bottom: 1px solid var(--line); }
td.number, th.number { text-align: right; } td.number { white-space: nowrap; }
tr.study td { padding-top: 1rem; border-bottom: 1.5px solid var(--line); font-weight: 600; font-size: .95rem; }
.verdict { display: inline-block; min-width: 5.2rem; padding: 0 .5rem; border-radius: 3px; text-align: center;
           color: #fff; background: #8a94a0; white-space: nowrap; }
.verdict.met { background: var(--met); } .verdict.missed { background: var(--missed); }
tr.missed td { background: #fdf1f0; } tr.missed td.value { color: var(--missed); font-weight: 650; }
figure { margin: 1.1rem 0; } figure img { max-width: 100%; height: auto; display: block; }
figcaption { color: var(--soft); font-size: .86rem; max-width: 60rem; margin-top: .2rem; }
.figures { display: flex; flex-wrap: wrap; gap: 0 1.2rem; } .figures figure, .figures p { flex: 1 1 100%; }
.figures figure.half { flex: 0 1 calc(50% - .6rem); }
nav a { margin-right: 1rem; white-space: nowrap; } a { color: var(--blue); }
code { font-size: .9em; background: #f2f5f8; padding: .05rem .25rem; border-radius: 3px; }
.scroll { overflow-x: auto; }
@media print { header { color: #000; background: none; } h2 { break-before: page; } figure, tr { break-inside: avoid; } }
"""

MARK = {"met": "&#10003; met", "missed": "&#10007; missed", "shown": "shown"}


def text(value):
    return html.escape(str(value))


def number(value, digits=3, missing="&#8212;"):
    return missing if value is None else text(f"{value:.{digits}g}")


def target(metric):
    return text(bar(metric["low"], metric["high"])).replace("&lt;=", "&#8804;").replace("&gt;=", "&#8805;")


def peers(metric):
    """How far the other codes' numbers reach; each of them where the pointer rests on it."""
    if not metric["peers"]:
        return ""
    lowest, highest = min(peer["range"][0] for peer in metric["peers"]), max(peer["range"][1] for peer in metric["peers"])
    each = ", ".join(f"{peer['name']} {number(peer['range'][0])}..{number(peer['range'][1])}" for peer in metric["peers"])
    return f'<span title="{text(each)}">{number(lowest)}..{number(highest)} ({len(metric["peers"])} codes)</span>'


def remark(metric):
    """What the value is compared with, its best shift, or why there is none."""
    parts = [metric["note"]] if metric["note"] else [metric["reference"]] if metric["reference"] else []
    if metric["order"] is not None:
        parts.append(f"observed order {metric['order']:.2f}")
    if metric["shifted_value"] is not None:
        unit = f" {metric['shift_unit']}" if metric["shift_unit"] != "T" else ""
        parts.append(f"{metric['shifted_value']:.3g} with the data {abs(metric['shift']):.3g}{unit} "
                     f"{'later' if metric['shift'] > 0 else 'earlier'}")
    return text("; ".join(parts))


def metric_row(metric):
    return (f'<tr class="{metric["verdict"]}"><td>{text(metric["what"])}</td>'
            f'<td class="number value">{number(metric["value"])}</td><td>{text(metric["unit"])}</td>'
            f'<td class="number">{target(metric)}</td><td class="number">{number(metric["paper"], missing="")}</td>'
            f'<td class="number">{peers(metric)}</td>'
            f'<td><span class="verdict {metric["verdict"]}">{MARK[metric["verdict"]]}</span></td>'
            f"<td>{remark(metric)}</td></tr>")


METRIC_HEAD = ('<tr><th>quantity</th><th class="number">value</th><th>unit</th><th class="number">target</th>'
               '<th class="number">paper</th><th class="number">other codes</th><th>verdict</th><th>compared with</th></tr>')


def table(head, rows):
    return f'<div class="scroll"><table><thead>{head}</thead><tbody>{"".join(rows)}</tbody></table></div>'


def rounded(path):
    """A path of a drawing to a hundredth of a point."""
    return LONG_NUMBER.sub(rb"\1", path.group())


def with_palette(match):
    """A picture in a drawing with 256 colours, if that is smaller."""
    png, small = base64.b64decode(match.group(1)), io.BytesIO()
    colours = Image.open(io.BytesIO(png)).quantize(256, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    colours.save(small, "PNG", optimize=True)
    return b"data:image/png;base64," + base64.b64encode(min(png, small.getvalue(), key=len))


def address(svg):
    """A drawing as the address of an image. Its quotes become single ones, which the address need not encode."""
    drawing = PICTURE.sub(with_palette, PATH.sub(rounded, COMMENT.sub(b"", svg)))
    return "data:image/svg+xml," + quote(drawing.replace(b'"', b"'"), safe=" ='/;,+-.")


def image(svg, caption, kind=""):
    return (f'<figure{kind}><img src="{address(svg)}" alt="{text(caption)}"/>'
            f"<figcaption>{text(caption)}</figcaption></figure>")


def figure_element(figure, caption):
    """A matplotlib figure as part of the page: a vector drawing, particles in it as pixels."""
    buffer = io.BytesIO()
    with rc_context(STYLE):
        figure.savefig(buffer, format="svg", dpi=RESOLUTION, metadata={"Date": None})
    return image(buffer.getvalue(), caption, ' class="half"' if figure.get_figwidth() <= WIDTH / 2 else "")


def sheet_element(draw, folder, caption):
    """The picture that `draw` makes of a run's folder. Throws DataError."""
    buffer = io.BytesIO()
    with rc_context({"savefig.format": "svg"}):
        draw(folder, buffer)
    return image(buffer.getvalue(), caption)


RUN_HEAD = ('<tr><th>run</th><th class="number">dx (mm)</th><th class="number">fluid particles</th>'
            '<th class="number">steps</th><th class="number">dt (ms)</th><th class="number">iterations per solve</th>'
            '<th class="number">CPU (s)</th><th class="number">CPU (s) per simulated s</th>'
            '<th class="number">energy at the end, of the start</th><th class="number">largest rise</th>'
            '<th class="number">density error mean, rms (%)</th></tr>')


def run_row(run):
    if run["message"]:
        return f'<tr class="missed"><td>{text(run["name"])}</td><td colspan="10">{text(run["message"])}</td></tr>'
    cells = (number(1000 * run["spacing_m"]), text(run["particles"]), text(run["steps"]),
             number(1000 * run["dt_mean_s"]), number(run["iterations_per_solve"]), number(run["cpu_s"]),
             number(run["cpu_s_per_simulated_s"]), number(run["energy_end_over_start"], 4),
             number(run["energy_rise_over_start"], 2),
             f'{number(100 * run["density_error_mean"], 2)}, {number(100 * run["density_error_rms"], 2)}')
    return f"<tr><td>{text(run['name'])}</td>" + "".join(f'<td class="number">{cell}</td>' for cell in cells) + "</tr>"


def matrix(metrics):
    """The numbers of a comparison: a row for each quantity, a column for each variant."""
    if not metrics:
        return ""
    variants = list(dict.fromkeys(metric["variant"] for metric in metrics))
    cells = {(metric["what"], metric["variant"]): metric for metric in metrics}
    head = "<tr><th>quantity</th><th>unit</th>" + "".join(f'<th class="number">{text(name)}</th>' for name in variants)
    rows = []
    for what in dict.fromkeys(metric["what"] for metric in metrics):
        values = "".join(f'<td class="number">{number(cells[what, name]["value"])}</td>' for name in variants)
        rows.append(f'<tr><td>{text(what)}</td><td>{text(cells[what, variants[0]]["unit"])}</td>{values}</tr>')
    return table(head + "</tr>", rows)


def single(study):
    """The metrics that are not one of several variants'."""
    return [metric for metric in study["metrics"] if not metric["variant"]]


def metric_table(metrics):
    return table(METRIC_HEAD, [metric_row(metric) for metric in metrics]) if metrics else ""


def run_table(runs):
    """What runs of cases were and cost, and why others failed."""
    rows = [run_row(run) for run in runs if run["message"] or "particles" in run]
    return "<h3>Cost and soundness of the runs</h3>" + table(RUN_HEAD, rows) if rows else ""


def study_section(study, pictures):
    return (f'<section id="{text(study["name"])}"><h2>{text(study["title"])}</h2><p>{text(study["about"])}</p>'
            f'<p class="soft"><b>How well this is known.</b> {text(study["uncertainty"])}</p>'
            + metric_table(single(study)) + matrix([metric for metric in study["metrics"] if metric["variant"]])
            + f'<div class="figures">{"".join(pictures)}</div>' + run_table(study["runs"]) + "</section>")


def summary(result):
    rows = []
    for kind in KINDS:
        for study in (study for study in result["studies"] if study["kind"] == kind):
            rows.append(f'<tr class="study"><td colspan="8">{text(kind)}: <a href="#{text(study["name"])}">'
                        f'{text(study["title"])}</a></td></tr>')
            rows += [metric_row(metric) for metric in single(study)] or [
                '<tr><td colspan="8">the numbers of each variant stand in the section</td></tr>']
    return table(METRIC_HEAD, rows)


def tile(value, words, kind=""):
    return f'<div class="tile {kind}"><b>{text(value)}</b>{text(words)}</div>'


def page(result, pictures):
    """The whole page; `pictures` are the figures of each study, by name, as text of the page."""
    count = result["verdicts"]
    machine = result["machine"]
    scheme = f", scheme {result['scheme']}" if result["scheme"] else ""
    links = "".join(f'<a href="#{text(study["name"])}">{text(study["title"])}</a> ' for study in result["studies"])
    return f"""\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8"/>
<meta name="viewport" content="width=device-width, initial-scale=1"/>
<title>Tailwater validation, level {text(result["level"])}</title>
<style>
{CSS}</style>
</head>
<body>
<header><div>
<h1>Tailwater validation</h1>
<p>Level <b>{text(result["level"])}</b>{text(scheme)} &#183; version {text(result["version"])}, commit {text(result["commit"])} &#183; {text(result["date"])}</p>
<p>{text(machine["processor"])}, {text(machine["cores"])} cores, {text(result["ranks"])} rank(s) per run</p>
</div></header>
<main>
<div class="tiles">{tile(count["met"], "targets met", "met")}{tile(count["missed"], "targets missed", "missed")}
{tile(count["shown"], "numbers without a target")}{tile(duration(result["cpu_s"]), "CPU time of all runs")}</div>
<nav>{links}</nav>
<h2>Summary</h2>
<p>Every number that has a target is met or missed; what is missed stays here, in red. Numbers without a target are
shown for what they are worth. &#8220;Paper&#8221; is what the case's paper reports for its own code, &#8220;other
codes&#8221; what we measured or found published for others.</p>
{summary(result)}
{"".join(study_section(study, pictures.get(study["name"], [])) for study in result["studies"])}
</main>
</body>
</html>
"""
