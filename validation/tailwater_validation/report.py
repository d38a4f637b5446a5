"""What a bench found, as a table for the terminal, as bench.json and as bench.md."""

import datetime
import json

from .metric import bar

COLUMNS = ("gate", "what", "bar", "value", "unit", "verdict", "reference")


def collect(gates, program, level, settings):
    """{version, commit, date, level, settings, gates: [{name, what, metrics: [...]}]}; `gates` are pairs of a gate and
    its [(check, metric with its value)]."""
    return {
        "version": program.version,
        "commit": program.commit,
        "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "level": level,
        "settings": list(settings),
        "gates": [
            {"name": gate.name, "what": gate.what, "metrics": [
                {"name": metric.name, "what": metric.what, "value": metric.value, "low": metric.low,
                 "high": metric.high, "unit": metric.unit, "verdict": metric.verdict, "reference": metric.against,
                 "note": metric.note, "runs": [run.name for run in check.runs]}
                for check, metric in scored]}
            for gate, scored in gates
        ],
    }


def counts(result):
    """How many of the numbers that have a bar are met and missed."""
    verdicts = [metric["verdict"] for gate in result["gates"] for metric in gate["metrics"]]
    return f"{verdicts.count('met')} met, {verdicts.count('missed')} missed"


def rows(result):
    return [(gate["name"], metric["what"], bar(metric["low"], metric["high"]),
             "-" if metric["value"] is None else f"{metric['value']:.3g}", metric["unit"], metric["verdict"],
             metric["note"] or metric["reference"])
            for gate in result["gates"] for metric in gate["metrics"]]


def heading(result):
    settings = "".join(f" --set {setting}" for setting in result["settings"])
    return (f"tailwater {result['version']} (commit {result['commit']}), level {result['level']}{settings}, "
            f"{result['date']}: {counts(result)}")


def table(result):
    lines = [COLUMNS, *rows(result)]
    widths = [max(len(row[k]) for row in lines) for k in range(len(COLUMNS) - 1)]
    text = ["  ".join(cell.ljust(width) for cell, width in zip(row, [*widths, 0])).rstrip() for row in lines]
    return "\n".join([*text[:1], "-" * len(text[0]), *text[1:], "", heading(result)])


def markdown(result):
    lines = [f"# Robustness\n\n{heading(result)}.\n", "| " + " | ".join(COLUMNS) + " |", "| --- " * len(COLUMNS) + "|"]
    lines += ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in rows(result)]
    return "\n".join(lines) + "\n"


def write(result, folder):
    """bench.json and bench.md in `folder`. Throws OSError."""
    (folder / "bench.json").write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")
    (folder / "bench.md").write_text(markdown(result), encoding="utf-8")
