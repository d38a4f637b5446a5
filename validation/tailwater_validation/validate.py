"""`tailwater validate`: runs the papers' cases and the exact solutions, scores them, writes a report.

OUT/runs/NAME are ordinary runs; OUT/validation.json holds every number with its target and result, OUT/report.json the
same with plots, which `tailwater view OUT` shows; OUT/report.html is that page as one file.

Usage: python -m tailwater_validation.validate --program FILE [CASE...] [--level quick|paper|fine] [--out DIR]
Exit codes: 0 all was run and scored, whatever the results are; 2 bad input, 4 a file cannot be written, 130
interrupted.
"""

import datetime
import json
import math
import os
import platform
import subprocess
import sys

from tailwater.errors import DataError
from tailwater.whole_file import write_whole_text

from . import command, panels
from .metric import RESULTS, bar, shown
from .runs import TestRun, finished
from .studies import studies
from .study import LEVELS, Plan
from .text_table import text_table


def finite(value):
    """The value, or None for a value that JSON cannot represent."""
    return value if value is not None and math.isfinite(value) else None


def metric_record(check, metric):
    return {"name": metric.name, "what": metric.what, "value": finite(metric.value), "unit": metric.unit, "low": metric.low,
            "high": metric.high, "paper": metric.paper,
            "peers": [{"name": name, "range": [low, high]} for name, low, high in metric.peers or ()],
            "verdict": metric.verdict or "shown", "result": metric.result or "shown", "reference": metric.against, "shifted_value": finite(metric.shifted_value),
            "shift": metric.shift, "shift_unit": metric.shift_unit, "order": finite(metric.order), "uncertainty": finite(metric.uncertainty), "note": metric.note or metric.met_because,
            "variant": check.variant, "runs": [run.name for run in check.runs]}


def run_record(run, out):
    """Settings, size and cost of a run; for a failed run only the cause; for tests, that they passed."""
    try:
        left = finished(run, out)
    except DataError as error:
        return {"name": run.name, "message": str(error)}
    if isinstance(run, TestRun):
        return {"name": run.name, "message": ""}
    told = left.summary
    energy, has_energy = told["energy"], told["energy"]["start_J"] != 0
    return {"name": run.name, "message": "", "case": str(run.case.name), "settings": list(run.settings),
            "spacing_m": told["spacing_m"], "particles": told["particles"]["fluid"], "steps": told["steps"]["count"],
            "dt_mean_s": told["steps"]["dt_mean_s"],
            "iterations_per_solve": told["pressure_solver"]["iterations_per_solve"], "cpu_s": told["cost"]["cpu_s"],
            "cpu_s_per_simulated_s": told["cost"]["cpu_s_per_simulated_s"],
            "energy_end_over_start": energy["end_J"] / energy["start_J"] if has_energy else None,
            "energy_rise_over_start": energy["largest_rise_over_start"] if has_energy else None,
            "density_error_mean": told["volume"]["density_error_mean"],
            "density_error_rms": told["volume"]["density_error_rms"]}


def study_record(study, out):
    return {"name": study.name, "title": study.title, "kind": study.kind, "about": study.about,
            "uncertainty": study.uncertainty,
            "metrics": [metric_record(check, metric) for check in study.checks for metric in check.scores(out)],
            "runs": [run_record(run, out) for run in study.runs]}


def collect(chosen, program, options):
    """Content of validation.json."""
    records = [study_record(study, options.out) for study in chosen]
    verdicts = [metric["verdict"] for record in records for metric in record["metrics"]]
    cost = {run["name"]: run.get("cpu_s", 0.0) for record in records for run in record["runs"]}
    return {
        "version": program.version, "commit": program.commit, "level": options.level, "scheme": options.scheme,
        "settings": list(options.settings), "ranks": program.ranks, "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "machine": {"name": platform.node(), "processor": processor(), "cores": os.cpu_count()},
        "cpu_s": sum(cost.values()),
        "verdicts": {verdict: verdicts.count(verdict) for verdict in ("met", "missed", "shown")},
        "studies": records,
    }


def processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            return next(line.split(":", 1)[1].strip() for line in file if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.machine()


def finished_of(runs, out):
    """Folders of the runs that belong to cases and reached their end."""
    found = []
    for run in runs:
        try:
            found.append(finished(run, out))
        except DataError:
            continue
    return found


def figure(caption, runs, out, draw):
    """The panels that `draw` makes of the runs that reached their end, or the reason why there are none."""
    left = finished_of(runs, out)
    try:
        return {"caption": caption, **({"panels": draw(*left)} if left else {"missing": "no run reached its end"})}
    except DataError as error:
        return {"caption": caption, "missing": str(error)}


def figures(study, out):
    """Figures of a study: its plots and histories."""
    found = [figure(plot.caption, plot.runs, out, plot.draw) for plot in study.plots]
    cases = [run for run in study.runs if not isinstance(run, TestRun)]
    if cases and study.has_histories:
        found.append(figure("Energy and volume over time.", cases, out,
                            lambda *left: panels.histories(left[:panels.MOST_RUNS], study.names)))
    return found


def moments(study):
    """Instants of the shown run, with labels for buttons."""
    return [{"time": time, "label": f"t = {time:.3g} s" + (f", T = {time / study.time_scale:.3g}" if study.time_scale else "")}
            for time in study.moments]


def report(result, chosen, out):
    """Content of report.json: the result with the pictures and plots of each study."""
    return result | {"studies": [
        record | {"shown": study.shown.name if study.shown and finished_of((study.shown,), out) else None,
                  "moments": moments(study), "figures": figures(study, out)}
        for record, study in zip(result["studies"], chosen)]}


def export(program, out):
    """The report as one file, by the program's own viewer. Throws OSError."""
    page = out / "report.html"
    made = subprocess.run([program.path, "view", out, "--export", page], capture_output=True, text=True, check=False)
    if made.returncode != 0:
        raise OSError(made.returncode, made.stderr.strip().removeprefix("error: "), str(page))
    return page


def overview(result):
    """Table of the numbers that have a target, for the terminal, with notes on their results."""
    rows = [(study["name"], metric["what"], shown(metric), metric["unit"], bar(metric["low"], metric["high"]), metric["result"],
             metric["note"])
            for study in result["studies"] for metric in study["metrics"] if metric["verdict"] != "shown"]
    table = text_table(("study", "what", "value", "unit", "target", "result", "note"), rows)
    results = [row[5] for row in rows]
    return "\n".join([table, "", ", ".join(f"{results.count(name)} {name}" for name in RESULTS)])


def score(chosen, program, options):
    """Writes validation.json and the report; returns the text to print."""
    result, out = collect(chosen, program, options), options.out
    for name, content, indent in (("validation", result, 1), ("report", report(result, chosen, out), None)):
        text = json.dumps(content, indent=indent) + "\n"
        write_whole_text(out / f"{name}.json", text)
    return (f"{overview(result)}\n\nscores: {out / 'validation.json'}\nreport: {export(program, out)}; "
            f"with its runs: tailwater view {out}")


def main(arguments=None):
    parser = command.RunsParser("tailwater validate", "Run the validation cases, compare them with measurements and theory, and "
                                "write a report.", "validation", max(1, os.cpu_count() or 1), "one per core")
    parser.epilog += " Examples: tailwater validate --list; tailwater validate zhou1999 drop --level paper --out my_validation"
    parser.add_argument("cases", nargs="*", metavar="CASE", help="cases to run (default: all; see --list)")
    parser.add_argument("--level", choices=LEVELS, default="quick",
                        help="quick: under ten minutes on two cores; paper: particle counts of the papers; fine: finer")
    parser.add_argument("--scheme", default="", metavar="NAME", help="scheme.name of all runs except comparisons of schemes")
    parser.add_argument("-n", type=int, default=1, dest="ranks", metavar="RANKS", help="ranks per run (1)")
    options = parser.parse_intermixed_args(arguments)
    plan = Plan(options.level, options.scheme)
    options.settings = plan.settings
    return command.execute(options, lambda: command.choose(studies(plan), options.cases, "case"), score)


if __name__ == "__main__":
    sys.exit(main())
