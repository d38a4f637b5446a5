"""Results of the speed benchmark as speed.json, speed.csv and speed.md, and their comparison with earlier results."""

import csv
import io
import json

from tailwater.errors import DataError
from tailwater.whole_file import write_whole_text

from .metric import Metric, bar
from .text_table import markdown_table, text_table

COLUMNS = ("what", "value", "unit", "bar", "verdict", "note")


def record(metric):
    return {"name": metric.name, "what": metric.what, "value": metric.value, "unit": metric.unit, "low": metric.low,
            "high": metric.high, "verdict": metric.verdict, "note": metric.note}


def shown(value):
    return "-" if value is None else f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def rows(result):
    return [(number["what"], shown(number["value"]), number["unit"], bar(number["low"], number["high"]),
             number["verdict"], number["note"]) for number in result["numbers"]]


def heading(result):
    settings = "".join(f" --set {setting}" for setting in result["settings"])
    machine = result["machine"]
    return (f"tailwater {result['version']} (commit {result['commit']}), {result['compiler']}, {machine['processor']}, "
            f"{machine['cores']} cores, level {result['level']}{settings}, {result['date']}, "
            f"load {result['load_before']:.1f} before{', interrupted' if result['interrupted'] else ''}")


def markdown(result):
    return f"# Speed\n\n{heading(result)}.\n\n{markdown_table(COLUMNS, rows(result))}\n"


def write(result, folder):
    """Throws IoError."""
    write_whole_text(folder / "speed.json", json.dumps(result, indent=1) + "\n")
    write_whole_text(folder / "speed.md", markdown(result))
    lines = io.StringIO()
    writer = csv.DictWriter(lines, ("commit", *record(Metric("", "", "", ""))), lineterminator="\n")
    writer.writeheader()
    writer.writerows({"commit": result["commit"], **number} for number in result["numbers"])
    write_whole_text(folder / "speed.csv", lines.getvalue())


def read(path):
    """The content of an earlier speed.json. Throws DataError."""
    try:
        result = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise DataError(f"{path}: {error.strerror}; give a speed.json of another commit") from error
    except ValueError as error:
        raise DataError(f"{path}: is no JSON ({error})") from error
    try:
        heading(result)
        rows(result)
    except (KeyError, TypeError) as error:
        raise DataError(f"{path}: is not of this bench, {error} is missing") from error
    return result


def comparison(old, new):
    """A table of all numbers in both results, with the ratio of the new to the old one, and of all other
    differences."""
    before = {number["name"]: number["value"] for number in old["numbers"]}
    lines = []
    for number in new["numbers"]:
        was, now = before.get(number["name"]), number["value"]
        if was is not None and now is not None:
            lines.append((number["what"], shown(was), shown(now), f"{now / was:.3f}" if was else "-", number["unit"]))
    others = [f"{what}: {one} and {other}" for what, one, other in (
        ("machine", old["machine"], new["machine"]), ("compiler", old["compiler"], new["compiler"]),
        ("options", old["options"], new["options"]), ("settings", old["settings"], new["settings"])) if one != other]
    text = text_table(("what", f"{old['commit']}", f"{new['commit']}", "ratio", "unit"), lines)
    return text + "".join(f"\nnot the same {other}" for other in others)
