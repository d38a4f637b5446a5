"""Repeats the runs of a dossier, compares their tables bit for bit, and computes the answer from them again."""

import base64
import hashlib
import json
import math
import tempfile
import zlib
from pathlib import Path

from . import report_faults
from .errors import DataError, Error, IoError
from .program import call, version
from .report import first_line, rows_of, run_record
from .report_page import content_of, is_page_of, without_pictures
from .run import Run
from .study import Study, number

__all__ = ["check_files", "check_report", "read_report"]

ROUNDING = 1e-6  # relative; equal runs give intervals that differ by less on other processors
# Parts of the record of a run that its repetition does not have in common.
OF_ONE_RUN = ("folder", "cpu_s", "program", "case", "case_sha256", "outputs")


def path_of(file) -> Path:
    path = Path(file)
    return path / "dossier.json" if path.is_dir() else path


def text_of(path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise IoError(f"{path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise DataError(f"{path}: is not a report; remedy: name the file that tailwater report has written") from error


def read_report(file) -> dict:
    """The content of a report, from its page, its JSON file, or a folder with one. Throws IoError, DataError."""
    path = path_of(file)
    try:
        return content_of(text_of(path))
    except ValueError as error:
        raise DataError(f"{path}: is not a report; remedy: name the file that tailwater report has written") from error


def check_files(file, tell=print) -> bool:
    """Whether the page shows the numbers that it holds, and whether the JSON file beside it, or the page beside a JSON
    file, has the same content; `tell` receives a line for each difference. Pictures are not compared."""
    path, content = path_of(file), read_report(file)
    is_page = path.suffix.lower() != ".json"
    same, maker = True, "" if content.get("made_by") == version() else f", or was made by another program ({content.get('made_by')})"
    if is_page and not is_page_of(text_of(path), content):
        tell(f"{path}: does not show the numbers that it holds{maker}")
        same = False
    other = path.with_suffix(".json" if is_page else ".html")
    if other.is_file():
        if without_pictures(read_report(other)) != without_pictures(content):
            tell(f"{other}: is not of the same content as {path.name}")
            same = False
        elif not is_page and not is_page_of(text_of(other), content):
            tell(f"{other}: does not show the numbers that it holds{maker}")
            same = False
    return same


def check_report(content, tell=print) -> bool:
    """Whether all finished runs of a report give bit-identical tables with the present program, and the repeated runs
    the same answer; `tell` receives a line for each run and one for the answer. Throws DataError if an input file is
    missing or has changed, or if the report has no finished run."""
    finished = [run for run in content["runs"] if run["status"] == "done"]
    if not finished:
        raise DataError("the report has no finished run; there is nothing to compare")
    programs = {run["program"] for run in finished}
    if programs != {version()}:
        tell(f"note: the runs are of {', '.join(sorted(programs))}, this is {version()}")
    same = True
    with tempfile.TemporaryDirectory(prefix="tailwater-report-") as folder:
        places, repeated = unpack(content["inputs"], Path(folder)), []
        for number_of_run, run in enumerate(finished):
            name = f"{run['role']} at {run['spacing_m']:.4g} m"
            differences = differences_of(run, places, Path(folder) / f"run{number_of_run}")
            tell(f"{name}: {'differs in ' + ', '.join(differences) if differences else 'the same, bit for bit'}")
            same = same and not differences
            if (Path(folder) / f"run{number_of_run}" / "summary.json").is_file():
                repeated.append((run, Run(Path(folder) / f"run{number_of_run}")))
        differences = answer_differences(content, finished, repeated)
        tell(f"answer: {'; '.join(differences) if differences else 'the same, computed again from these runs'}")
        same = same and not differences
    for run in content["runs"]:
        if run["status"] != "done":
            tell(f"{run['role']} at {run['spacing_m']:.4g} m: not compared, {run['status']}")
    return same


def unpack(inputs, folder) -> dict:
    """Writes the input files that the report holds. Returns {path in the cases: new path}."""
    places = {}
    for number, one in enumerate(inputs):
        if one["content"] is None:
            place = Path(one["path"])
            data = place.read_bytes() if place.is_file() else b""
        else:
            place = folder / f"input{number}" / Path(one["path"]).name
            data = zlib.decompress(base64.b64decode(one["content"]))
            place.parent.mkdir()
            place.write_bytes(data)
        if hashlib.sha256(data).hexdigest() != one["sha256"]:
            wanted = one["sha256"] or "unknown, because the file was gone when the report was written"
            raise DataError(f"{one['path']}: is missing or is not the file of the report; remedy: put the file there whose "
                            f"SHA-256 is {wanted}")
        places[one["path"]] = str(place)
    return places


def differences_of(run, places, folder) -> list:
    """The tables of a run that differ from those of the report; the error, if the run fails."""
    text = run["case"]
    if hashlib.sha256(text.encode()).hexdigest() != run["case_sha256"]:
        return ["its case, which is not the one whose hash the report has"]
    for path, place in places.items():
        text = text.replace(json.dumps(path, ensure_ascii=False), json.dumps(place, ensure_ascii=False))
    case = folder.with_suffix(".toml")
    case.write_text(text, encoding="utf-8")
    try:
        call("run", case, "--out", folder, "-n", run["ranks"], "--quiet")
    except Error as error:
        return [str(error)]
    return [name for name, known in run["outputs"].items()
            if not (folder / name).is_file() or hashlib.sha256((folder / name).read_bytes()).hexdigest() != known]


def is_close(a, b, size=0.0) -> bool:
    """Whether two contents are equal, numbers within rounding; `size` is that of numbers beside them."""
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(is_close(a[key], b[key], size) for key in a)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(is_close(one, other, size) for one, other in zip(a, b))
    is_number = all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in (a, b))
    if not is_number:
        return a == b
    return math.isclose(a, b, rel_tol=ROUNDING, abs_tol=1e-3 * ROUNDING * size) or (math.isnan(a) and math.isnan(b))


def row_difference(kept, found) -> str:
    """The first difference of a result from the one computed again; "" if there is none."""
    if kept is None or found is None:
        return "" if kept is found else "the report has no result that the runs have, or one that they have not"
    size = max(abs(found[name] or 0.0) for name in ("value", "limit", "low", "high"))
    name = next((name for name in found if not is_close(kept.get(name), found[name], size)), None)
    if name is None:
        return ""
    words = [number(value, 6) if isinstance(value, float) or value is None else str(value) for value in (kept.get(name), found[name])]
    return f"{found['probe']}, {found['quantity']}: the {name} is {words[0]} in the report and {words[1]} by the runs"


def answer_differences(content, finished, repeated) -> list:
    """Differences of the answer, the faults, the other results and the records of the runs from those that the repeated
    runs give. `repeated` are (record in the report, Run)."""
    if len(repeated) < len(finished):
        return ["cannot be computed, because a run failed"]
    try:
        study, runs = study_of(content, repeated)
    except (DataError, ValueError) as error:
        return [f"cannot be computed ({error})"]
    rows, kept = rows_of(study, runs), content["results"]
    if [(row["probe"], row["quantity"]) for row in rows] != [(row["probe"], row["quantity"]) for row in kept]:
        return ["the report has other results than the runs"]
    told = content["answer"]
    row = next((row for row in rows if told and (row["probe"], row["quantity"]) == (told["probe"], told["quantity"])), None)
    found = [row_difference(*pair) for pair in [(told, row), *zip(kept, rows)]]
    found += fault_differences(content, repeated, content.get("asked", told))
    if content["first_line"] != first_line(content):
        found.append("the first line is not that of the answer")
    if content["case"]["title"] != runs[0].case["case"]["title"]:
        found.append("the title is not that of the case")
    for record, run in repeated:
        again = run_record(record["role"], run, row)
        names = [name for name in again if name not in OF_ONE_RUN and not is_close(record.get(name), again[name])]
        found += [f"the record of the {record['role']} at {run.spacing:.4g} m differs in {', '.join(names)}"] if names else []
    return list(dict.fromkeys(filter(None, found)))


def study_of(content, repeated):
    """(Study or None, runs): the study that the report is of, from the repeated runs, the finest one first."""
    runs = [run for record, run in repeated if record["role"] in ("run", "spacing")] or [run for _, run in repeated]
    runs.sort(key=lambda run: run.spacing)
    if is_of_a_run(content) or is_unfinished(content):
        return None, runs
    others = {role: [run for record, run in repeated if record["role"] == role] for role in ("start", "half step")}
    return Study(runs, others["start"], next(iter(others["half step"]), None)), runs


def is_of_a_run(content) -> bool:
    return [run["role"] for run in content["runs"]] == ["run"]


def is_unfinished(content) -> bool:
    return any(report_faults.UNFINISHED in fault for fault in content["faults"])


def fault_differences(content, repeated, asked) -> list:
    """Differences of the faults; the report of an unfinished study has more of them than its finished runs."""
    roles = [(record["role"], run) for record, run in repeated]
    found = report_faults.faults_of("", roles, not is_of_a_run(content), asked)
    if len({record["program"] for record, _ in repeated}) > 1:
        found.append(report_faults.SEVERAL_PROGRAMS)
    missing = [fault for fault in found if fault not in content["faults"]]
    more = [] if is_unfinished(content) else [fault for fault in content["faults"] if fault not in found]
    return [f"the report does not have the fault: {fault}" for fault in missing] + [
        f"the runs do not have the fault: {fault}" for fault in more]
