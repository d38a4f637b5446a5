"""Figures of other codes, from beside.json, which `benchmarks/beside.py --json` has written with settings and commands."""

import json
from pathlib import Path

FILE = Path(__file__).resolve().with_name("beside.json")
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
