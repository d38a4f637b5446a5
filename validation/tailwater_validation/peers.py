"""Figures of other codes, from files with settings and commands: beside.json, which `benchmarks/beside.py --json` has
written, and work_precision.json of `benchmarks/work_precision.py --json`."""

import json
from pathlib import Path

FILE = Path(__file__).resolve().with_name("beside.json")
WORK = FILE.with_name("work_precision.json")
OURS = "Tailwater"
QUANTITIES = {"cpu_s_per_simulated_s": "s", "noise_over_rho_g_H": "rho g H", "arrival_s": "s"}


def codes_of(case, path=FILE):
    """[record of a code] that finished a case."""
    told = json.loads(path.read_text(encoding="utf-8"))
    return [code for one in told["cases"] if one["case"] == case for code in one["codes"] if code["finished"]]


def peers_of(case, quantity, path=FILE):
    """((name, lowest, highest), ...) of other codes, as a Metric has them."""
    return tuple((code["code"], code[quantity], code[quantity]) for code in codes_of(case, path)
                 if code["code"] != OURS and code[quantity] is not None)


def figures_of_peers(path=FILE):
    """{key: text} of all finished codes, as "beside.zhou.SISPH.arrival_s"."""
    told = json.loads(path.read_text(encoding="utf-8"))
    return {f"beside.{one['case']}.{code['code']}.{quantity}": f"{code[quantity]:.3g} {unit}"
            for one in told["cases"] for code in codes_of(one["case"], path)
            for quantity, unit in QUANTITIES.items() if code[quantity] is not None}


def work_table(path=WORK):
    """The runs of work_precision.json as a table in Markdown, by code, below a line that says where they are from."""
    told = json.loads(path.read_text(encoding="utf-8"))
    lines = [f"`benchmarks/work_precision.py`, {told['date']}, {told['processor']}.", "",
             "| code | spacing, m | CPU s | pressure at z = 0.12 m, RMS over rho g H | its impulse, relative | level H1, RMS over H "
             "| noise of the pressure, over rho g H |", "|" + " --- |" * 7]
    for code in dict.fromkeys(run["code"] for run in told["runs"]):
        for run in (run for run in told["runs"] if run["code"] == code):
            cells = [f"{run['errors'][name]:.3g}" if name in run["errors"] else "-"
                     for name in ("pressure", "impulse", "level", "noise")] if run["finished"] else ["did not finish"] + 3 * [""]
            cost = f"{run['cpu_s']:.3g}" if run["finished"] else ""
            lines.append(f"| {code} | {run['spacing_m']:g} | {cost} | {' | '.join(cells)} |")
    between = [f"{told['between_readers'][name]:.3g}" for name in ("pressure", "impulse", "level")]
    return [*lines, f"| the laboratory, one reading beside the other | | | {' | '.join(between)} | |"]
