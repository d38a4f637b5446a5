"""Repeats the runs of a dossier and compares their tables bit for bit."""

import base64
import hashlib
import json
import tempfile
import zlib
from pathlib import Path

from .errors import DataError, Error, IoError
from .program import call, version
from .report_page import content_of

__all__ = ["check_report", "read_report"]


def read_report(file) -> dict:
    """The content of a report, from its page, its JSON file, or a folder with one. Throws IoError, DataError."""
    path = Path(file)
    path = path / "dossier.json" if path.is_dir() else path
    try:
        return content_of(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise IoError(f"{path}: cannot be read ({error.strerror})") from error
    except ValueError as error:
        raise DataError(f"{path}: is not a report; remedy: name the file that tailwater report has written") from error


def check_report(content, tell=print) -> bool:
    """Whether all finished runs of a report give bit-identical tables with the present program; `tell` receives a line
    for each run. Throws DataError if an input file is missing or has changed, or if the report has no finished run."""
    finished = [run for run in content["runs"] if run["status"] == "done"]
    if not finished:
        raise DataError("the report has no finished run; there is nothing to compare")
    programs = {run["program"] for run in finished}
    if programs != {version()}:
        tell(f"note: the runs are of {', '.join(sorted(programs))}, this is {version()}")
    same = True
    with tempfile.TemporaryDirectory(prefix="tailwater-report-") as folder:
        places = unpack(content["inputs"], Path(folder))
        for number, run in enumerate(finished):
            name = f"{run['role']} at {run['spacing_m']:.4g} m"
            differences = differences_of(run, places, Path(folder) / f"run{number}")
            tell(f"{name}: {'differs in ' + ', '.join(differences) if differences else 'the same, bit for bit'}")
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
