"""The table of evidence: each number of `tailwater validate` that has a target, with its interval, resolution, cost and
result. It is made from stored results (docs/validation.json) and the history of the targets (targets.toml) alone."""

import tomllib
from pathlib import Path

from tailwater.case_features import features_of

from .case_values import friction_of_walls, read_case, water_height
from .metric import RESULTS, bar, result_of, shown
from .peers import figures_of_peers
from .runs import TestRun
from .studies import studies
from .study import COMPARISON, LABORATORY, Plan

TARGETS = Path(__file__).resolve().with_name("targets.toml")
NOT_RUN, NO_TARGET = "not run", "no target"
# Kinds of quantities by words of a row, the first that fits.
KINDS = (("pressure", "pressure"), ("impulse", "pressure"), ("discharge", "discharge"), ("contraction", "discharge"),
         ("jet, from", "discharge"), ("force", "force"), ("front", "front"), ("arrival", "front"), ("reaches the gauge", "front"),
         ("depth", "level"), ("level", "level"), ("height", "level"), ("surface", "level"), ("profile", "level"),
         ("gauge", "level"), ("run-up", "level"), ("speed", "velocity"), ("period", "motion"), ("draught at rest", "motion"))


def kind_of(words):
    return next((kind for part, kind in KINDS if part in words), "")


def read_targets(path=TARGETS):
    """{key: [entries, the oldest first]}. Throws ValueError for an entry that is incomplete or out of order."""
    targets = tomllib.loads(path.read_text(encoding="utf-8"))
    for key, entries in targets.items():
        for entry in entries:
            missing = {"date", "quantity", "against", "reason"} - set(entry)
            if missing or not set(entry) & {"low", "high"}:
                raise ValueError(f"{path}: {key}: an entry has no {', '.join(sorted(missing)) or 'low and no high'}")
        dates = [entry["date"] for entry in entries]
        if dates != sorted(dates):
            raise ValueError(f"{path}: {key}: the entries are not in the order of their dates")
    return targets


def target_of(record):
    """Bounds, quantity and reference of a metric's record, or of an entry of the file of targets."""
    return {"low": record.get("low"), "high": record.get("high"), "quantity": record.get("what", record.get("quantity")),
            "against": record["reference"] if "reference" in record else record["against"]}


def changed_targets(records, targets):
    """Targets whose last entry is missing or differs, as sentences. `records` are those of metrics, in the form of validation.json."""
    found = []
    for record in records:
        if record["low"] is None and record["high"] is None:
            continue
        key, now = record["name"], target_of(record)
        entries = targets.get(key)
        if not entries:
            found.append(f"{key}: has a target and no entry")
        elif target_of(entries[-1]) != now:
            found.append(f"{key}: the target is {now}, the last entry has {target_of(entries[-1])}")
    return found


def runs_of_plan(result):
    """{name of a run: (case file, settings)} of the level and the scheme of the results, and {name of a study: Study}."""
    planned = studies(Plan(result["level"], result["scheme"]))
    return {run.name: (run.case, run.settings) for study in planned.values() for run in study.runs
            if not isinstance(run, TestRun)}, planned


def resolution(runs, cases):
    """Spacings, particles over the water's height, integrator, walls and cost of the runs of a metric."""
    told = [run for run in runs if run.get("spacing_m")]
    if not told:
        return {"spacing_m": None, "spacings": 0, "rows_over_depth": None, "integrator": "", "walls": "", "cpu_s": None}
    finest = min(told, key=lambda run: run["spacing_m"])
    found = {"spacing_m": finest["spacing_m"], "spacings": len({run["spacing_m"] for run in told}),
             "cpu_s": sum(run["cpu_s"] for run in told)}
    settings = dict(setting.split("=", 1) for setting in finest["settings"])
    is_two_step = settings.get("scheme.name") == "farmani2020"
    found["integrator"] = "two-step" if is_two_step else settings.get("scheme.integrator", "explicit")
    path, _ = cases[finest["name"]]
    height = water_height(path, finest["settings"], finest["spacing_m"])
    found["rows_over_depth"] = None if height is None else round(height / finest["spacing_m"], 1)
    found["walls"] = friction_of_walls(path, finest["settings"])
    return found


def result_of_metric(metric):
    if metric["verdict"] == "shown":
        return NO_TARGET
    if metric["verdict"] == "met" and metric["note"]:
        return "met"  # for the reason that the note gives
    return result_of(metric["value"], metric["low"], metric["high"], metric["uncertainty"])


def row_of(study, metric, runs, cases, targets):
    """Row of a stored result. A number that has lost its target has the reason."""
    entries = targets.get(metric["name"], [])
    ended = bool(entries) and entries[-1].get("ended", False)
    found = resolution([runs[name] for name in metric["runs"] if name in runs], cases)
    return found | {
        "key": metric["name"], "flow": study, "kind": kind_of(metric["what"]),
        "what": metric["what"] + (f", {metric['variant']}" if metric["variant"] else ""),
        "against": metric["reference"], "value": metric["value"], "uncertainty": metric["uncertainty"], "unit": metric["unit"],
        "low": metric["low"], "high": metric["high"], "target": bar(metric["low"], metric["high"]), "result": result_of_metric(metric),
        "value_text": value_text(metric),
        "spacing_text": spacing_text(found), "target_date": str(entries[-1]["date"]) if entries and not ended else "",
        "changes": max(len(entries) - 1, 0), "paper": metric["paper"],
        "note": entries[-1]["reason"] if ended else metric["note"]}


def spacing_text(found):
    """The spacing, and whether there are several spacings: an interval needs at least three."""
    if found["spacing_m"] is None:
        return ""
    rows = f" (depth/{found['rows_over_depth']:.3g})" if found["rows_over_depth"] else ""
    return f"{found['spacing_m']:.3g} m{rows}" + ("" if found["spacings"] > 2 else "; one spacing")


def row_without_result(key, entry, study):
    """Row of a target that has no stored result."""
    return {"key": key, "flow": study.name, "kind": kind_of(entry["quantity"]), "what": entry["quantity"],
            "against": entry["against"], "value": None, "uncertainty": None, "unit": "", "low": entry.get("low"),
            "high": entry.get("high"), "target": bar(entry.get("low"), entry.get("high")), "result": NOT_RUN, "value_text": "-",
            "spacing_m": None, "spacings": 0, "rows_over_depth": None, "integrator": "", "walls": "", "cpu_s": None,
            "spacing_text": "", "target_date": str(entry["date"]), "changes": 0, "paper": None, "note": "no stored result"}


def flow_of(study, rows):
    """Features of a validated flow, with which a report finds the flow most like its own case."""
    run = study.shown or next((run for run in study.runs if not isinstance(run, TestRun)), None)
    if run is None or not rows:
        return None
    return {"name": study.name, "title": study.title, "about": study.about, "uncertainty": study.uncertainty,
            "features": sorted(features_of(read_case(run.case, run.settings))),
            "kinds": sorted({row["kind"] for row in rows} - {""})}


def evidence_of(result, targets):
    """Content of evidence.json, from stored results. Throws ValueError if a target is not the last entry of its history."""
    records = {study["name"]: study for study in result["studies"]}
    all_metrics = [metric for study in records.values() for metric in study["metrics"]]
    if problems := changed_targets(all_metrics, targets):
        raise ValueError("targets.toml: " + "; ".join(problems) + "; remedy: add an entry with date and reason")
    cases, planned = runs_of_plan(result)
    rows, flows = [], []
    for name, study in planned.items():
        record = records.get(name, {"metrics": [], "runs": []})
        runs = {run["name"]: run for run in record["runs"]}
        is_open = study.kind == LABORATORY and all(metric["verdict"] == "shown" for metric in record["metrics"])
        of_study = [row_of(name, metric, runs, cases, targets) for metric in record["metrics"]
                    if metric["verdict"] != "shown" or is_open or metric["name"] in targets]
        known = {row["key"] for row in of_study}
        of_study += [row_without_result(key, entries[-1], study) for key, entries in targets.items()
                     if key not in known and key.startswith(f"{name}.") and not entries[-1].get("ended")]
        rows += of_study
        if study.kind != COMPARISON:
            flows.append(flow_of(study, of_study))
    return {"format": 1, "commit": result["commit"], "version": result["version"], "date": result["date"][:10],
            "level": result["level"], "processor": result["machine"]["processor"],
            "counts": {name: sum(row["result"] == name for row in rows) for name in (*RESULTS, NOT_RUN)},
            "rows": rows, "flows": list(filter(None, flows)), "figures": figures_of(all_metrics) | figures_of_peers()}


def figures_of(metrics):
    """{key: text of the value} of all stored numbers, with or without a target."""
    return {metric["name"]: value_text(metric) for metric in metrics if metric["value"] is not None}


def value_text(metric):
    return shown(metric) + (f" {metric['unit']}" if metric["unit"] else "")
