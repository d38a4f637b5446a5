"""Readings of the laboratories that the stored results reproduce within the scatter of the data (scatter.toml)."""

import tomllib
from pathlib import Path

from .metric import bar, result_of, shown

SCATTER = Path(__file__).resolve().with_name("scatter.toml")
HEAD = ("case", "reading", "computed", "allowed by the data", "within", "source of the scatter")


def read_scatter(path=SCATTER):
    """{key: values that the data allow}. Throws ValueError for an incomplete entry."""
    entries = tomllib.loads(path.read_text(encoding="utf-8"))
    for key, entry in entries.items():
        if "source" not in entry or not set(entry) & {"low", "high"}:
            raise ValueError(f"{path}: {key}: an entry needs a source, and low or high")
    return entries


def readings_of(studies, scatter):
    """(title of the study, metric, entry, whether it is within) of each entry. `studies` are those of validation.json. Throws
    ValueError for an entry without a stored result."""
    metrics = {metric["name"]: (study["title"], metric) for study in studies for metric in study["metrics"]}
    if unknown := sorted(set(scatter) - set(metrics)):
        raise ValueError(f"scatter.toml: no stored result has the name {', '.join(unknown)}")
    return [(*metrics[key], entry,
             result_of(metrics[key][1]["value"], entry.get("low"), entry.get("high"), metrics[key][1]["uncertainty"]) != "missed")
            for key, entry in scatter.items()]


def readings_table(studies, scatter):
    """Lines of Markdown: the fraction of the readings that are within the scatter, and a table of them."""
    readings = readings_of(studies, scatter)
    within = sum(each[3] for each in readings)
    verdicts = [metric["verdict"] for _, metric, _, _ in readings if metric["verdict"] != "shown"]
    lines = [f"{within} of {len(readings)} readings ({100 * within / len(readings):.0f} %) are within the scatter of the data; "
             f"the target is 90 %. {verdicts.count('met')} of the {len(verdicts)} that have a target meet it.", "", f"| {' | '.join(HEAD)} |", f"|{' --- |' * len(HEAD)}"]
    for title, metric, entry, is_within in readings:
        unit = f" {metric['unit']}" if metric["unit"] else ""
        cells = (title.rpartition(": ")[2], metric["what"], shown(metric) + unit, bar(entry.get("low"), entry.get("high")),
                 "yes" if is_within else "**no**", entry["source"])
        lines.append(f"| {' | '.join(cells)} |")
    return lines
