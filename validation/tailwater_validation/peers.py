"""Figures of other codes, from files with settings and commands: beside.json, written by `benchmarks/beside.py
--json`, and files of `benchmarks/work_precision.py --json`."""

import json
from pathlib import Path

FILE = Path(__file__).resolve().with_name("beside.json")
WORK = {case: FILE.with_name(f"work_precision{suffix}.json") for case, suffix in (("zhou", ""), ("box", "_box"), ("weir", "_weir"))}
ERRORS = {  # and their columns in a table
    "zhou": {"pressure": "pressure at z = 0.12 m, RMS over rho g H", "impulse": "its impulse, relative",
             "level": "level H1, RMS over H", "noise": "noise of the pressure, over rho g H"},
    "box": {"impulse": "impulse at P1 to P4, mean relative error", "arrival": "arrival at P1 to P4, mean error, s",
            "level": "levels H2 and H4, mean error over H"},
    "weir": {"head": "head above the crest, relative error"}}
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


def work_table(case="zhou", path=None):
    """The runs of a file of work_precision.py as a Markdown table by code, below a line with their origin."""
    told = json.loads((path or WORK[case]).read_text(encoding="utf-8"))
    errors = ERRORS[case]
    lines = [f"`benchmarks/work_precision.py{'' if case == 'zhou' else f' --case {case}'}`, {told['date']}, {told['processor']}.", "",
             f"| code | spacing, m | CPU s | {' | '.join(errors.values())} |", "|" + " --- |" * (3 + len(errors))]
    for code in dict.fromkeys(run["code"] for run in told["runs"]):
        for run in (run for run in told["runs"] if run["code"] == code):
            cells = [f"{run['errors'][name]:.3g}" if name in run["errors"] else "-" for name in errors] if run["finished"] else [
                "did not finish"] + (len(errors) - 1) * [""]
            cost = f"{run['cpu_s']:.3g}" if run["finished"] else ""
            lines.append(f"| {code} | {run['spacing_m']:.3g} | {cost} | {' | '.join(cells)} |")
    if not told["between_readers"]:
        return lines
    between = [f"{told['between_readers'][name]:.3g}" if name in told["between_readers"] else "" for name in errors]
    return [*lines, f"| the laboratory, one reading beside the other | | | {' | '.join(between)} |"]


def beside_table(case, path=FILE):
    """The runs of a case of beside.py as a Markdown table, below a line with their origin."""
    told = json.loads(path.read_text(encoding="utf-8"))
    codes = codes_of(case, path)
    ours = next(code["cpu_s_per_simulated_s"] for code in codes if code["code"] == OURS)
    one = next(one for one in told["cases"] if one["case"] == case)
    lines = [f"`benchmarks/beside.py --case {case}`, dx = {one['spacing_m']:g} m, to {one['end_s']:g} s, {told['date']}, "
             f"{told['processor']}.", "",
             "| code | settings (chosen by) | steps | CPU s per simulated s | Tailwater over this code | noise, over rho g H | arrival, s |",
             "|" + " --- |" * 7]
    for code in codes:
        cost = code["cpu_s_per_simulated_s"]
        numbers = ("-" if code[name] is None else f"{code[name]:.3g}" for name in ("noise_over_rho_g_H", "arrival_s"))
        lines.append(f"| {code['code']} | {code['settings']} ({code['chosen_by']}) | {code['steps']} | {cost:.3g} | "
                     f"{ours / cost:.2g} | {' | '.join(numbers)} |")
    return lines
