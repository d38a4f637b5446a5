"""Dossier of a study or a run: the answer with its interval, and all data to judge and to reproduce it.

`report` collects numbers and texts (format of the JSON file: docs/reference/report.md), `report_page` makes the page,
and `report_check` repeats the runs."""

import base64
import datetime
import hashlib
import json
import zlib
from pathlib import Path

from . import case_features, report_faults
from .case import Case
from .errors import DataError, Error
from .evidence import load_evidence
from .program import version
from .report_pictures import pictures_of
from .run import Run
from .study import Study, number, quantities_of
from .whole_file import write_whole

__all__ = ["Report", "report"]

FORMAT = 1
LARGEST_INPUT = 8_000_000  # bytes, compressed; larger files are recorded by their hash only
# Keys that name files, in all tables of a case, and the keys of their CRC-32, which a run writes into its case.
FILE_KEYS = {"file": "checksum", "motion": "motion_checksum", "points_file": ""}
RESULTS = ("steps.csv", "probes/*.csv")  # tables of a run that are compared bit for bit
UNITS = ("All numbers are in SI units (m, kg, s, N, Pa).",
         "In two dimensions volumes, masses, forces and discharges are per metre of width.",
         "Coordinates and levels are those of the case: heights count from the origin of its axes, upwards against gravity.")


class Report:
    """A dossier. `content` is the content of its JSON file; `first_line` is the answer, or the reason why it is not
    reliable."""

    def __init__(self, content: dict):
        self.content = content

    @property
    def first_line(self) -> str:
        return self.content["first_line"]

    @property
    def is_reliable(self) -> bool:
        """Whether no fault was detected."""
        return not self.content["faults"]

    def html(self) -> str:
        """The page: one file without links to others."""
        from .report_page import page

        return page(self.content)

    def write(self, file) -> Path:
        """Writes the page, and a JSON file with the same content beside it. Returns the path of the page. Throws
        DataError for another ending than .html, IoError."""
        file = Path(file)
        if file.suffix.lower() not in (".html", ".htm"):
            raise DataError(f"{file}: is written as HTML; name a file that ends in .html")
        text = json.dumps(self.content, indent=1, ensure_ascii=False) + "\n"
        write_whole(file.with_suffix(".json"), lambda part: part.write_text(text, encoding="utf-8"))
        write_whole(file, lambda part: part.write_text(self.html(), encoding="utf-8"))
        return file

    def __repr__(self):
        return self.first_line

    def _repr_html_(self):
        from .report_page import body

        return body(self.content)


def report(folder, *, answer: str = "", question: str = "", pictures: int = 3) -> Report:
    """Makes the dossier of a study, an unfinished study or a run. `answer` is the probe that answers the question, or
    "PROBE, QUANTITY" (default: the first quantity of the first probe); `question` is the text of the question.
    `pictures` is the number of pictures of the water of the finest run. Throws DataError if the folder holds no run and
    no study."""
    folder = Path(folder)
    found = Material(folder)
    asked = found.asked(answer)
    row = found.row_of(asked)
    finest = found.runs[0]
    features = case_features.features_of(finest.case)
    inputs = inputs_of(run for _, run in found.roles)
    content = {
        "format": FORMAT, "first_line": "",
        "made": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "made_by": version(), "question": question or question_of(finest, asked, row),
        "asked": asked, "answer": row,
        "faults": [*report_faults.faults_of(found.study_fault, found.roles, found.is_study, asked),
                   *faults_of_inputs(run for _, run in found.roles)],
        "warnings": report_faults.warnings_of(found.roles), "results": found.rows, "case": case_of(finest),
        "provenance": provenance(found.runs), "inputs": inputs, "runs": [run_record(role, run, row) for role, run in found.roles],
        "features": sorted(features), "validated": validated(features, finest, row),
        "limits": case_features.limits_of(features), "units": [*UNITS, *references_of(finest.case)],
        "pictures": pictures_of(finest, found.study, row, pictures)}
    content["first_line"] = first_line(content)
    return Report(content)


def references_of(case):
    """Sentences on the datum and the coordinate reference system of a case."""
    about = case.get("case", {})
    datum, crs = about.get("datum", ""), about.get("crs", "")
    return [f"Vertical datum: {datum}." if datum else "The case names no vertical datum (case.datum).",
            f"Coordinate reference system: {crs}." if crs else "The case names no coordinate reference system (case.crs)."]


class Material:
    """Runs and results of a folder. `roles` are (role, Run), the runs at different spacings first, the finest first;
    `rows` are results, with intervals if there is a study."""

    def __init__(self, folder):
        self.study, self.study_fault = None, ""
        if (folder / "case.effective.toml").exists():
            self.is_study, self.runs = False, [Run(folder)]
            self.roles = [("run", self.runs[0])]
        else:
            self.is_study = True
            self._read_study(folder)
        self.rows = rows_of(self.study, self.runs)

    def _read_study(self, folder):
        try:
            self.study = Study.load(folder)
        except DataError as error:
            reason = f" ({error})" if (folder / "study.json").exists() else ""
            self.study_fault = f"the study is {report_faults.UNFINISHED}{reason}"
            found = [Run(path.parent) for path in sorted(folder.glob("*/*/case.effective.toml"))]
            if not found:
                raise DataError(f"{folder}: has no run and no study; remedy: name the folder that tailwater run or tailwater "
                                "study has written") from error
            # The folder of a run in an unfinished study names its role.
            spacings = [run for run in found if run.path.parent.name in ("coarsest", "spacings")] or found
            self.runs = sorted(spacings, key=lambda run: (run.status != "done", run.spacing))
            self.roles = [("spacing", run) for run in self.runs] + [
                (run.path.parent.name, run) for run in found if run not in self.runs]
            return
        self.runs = self.study.runs
        self.roles = [("spacing", run) for run in self.runs] + [("start", run) for run in self.study.starts]
        if self.study.step:
            self.roles.append(("half step", self.study.step))

    def asked(self, answer) -> dict:
        """The probe and the quantity that answer the question, {} for a case without probes. By default the probe is the
        first one, and the quantity its first. A quantity is "" if no run has a result of the probe."""
        probe, _, quantity = (part.strip() for part in answer.partition(","))
        probes = [one["name"] for one in self.runs[0].case.get("probe", [])]
        there = {(row["probe"], row["quantity"]) for row in self.rows}
        there |= {key for _, run in self.roles for key in quantities_of(run)}
        found = {"probe": probe or (probes[0] if probes else ""), "quantity": quantity}
        is_there = any(name == found["probe"] and quantity in ("", one) for name, one in there)
        if answer and not is_there and (quantity or probe not in probes):
            words = "; ".join(f"{row['probe']}, {row['quantity']}" for row in self.rows)
            raise DataError(f'"{answer}" is no result; there are: {words or "none"}')
        if not found["probe"]:
            return {}
        row = self.row_of(found)
        return {name: row[name] for name in found} if row else found

    def row_of(self, asked):
        """The result of the probe and quantity; None if there is none."""
        return next((row for row in self.rows
                     if row["probe"] == asked.get("probe") and asked["quantity"] in ("", row["quantity"])), None)


def rows_of(study, runs):
    """The results of a study, or of runs without one, with None for a number that is not there."""
    rows = study.rows if study else rows_without_intervals(runs)
    return [{name: None if value != value else value for name, value in row.items()} for row in rows]


def rows_without_intervals(runs):
    """Results of the first finished run, in the form of the rows of a study."""
    run = next((run for run in runs if run.status == "done"), runs[0])
    return [{"probe": probe, "quantity": quantity, "unit": unit, "value": value, "limit": None, "low": None, "high": None,
             "notes": ""} for (probe, quantity), (value, unit) in quantities_of(run).items()]


def question_of(run, asked, row):
    title = run.case["case"]["title"]
    if row:
        return f"{title}: {row['quantity']} at the probe '{row['probe']}'?"
    return (f"{title}: {asked['quantity'] or 'result'} at the probe '{asked['probe']}'?" if asked
            else f"{title}: the run has no result of a probe")


def interval_of(row):
    """The answer as text, with the interval if there is one."""
    if row is None:
        return "no result"
    unit = f" {row['unit']}" if row["unit"] else ""
    if row["low"] is None:
        return f"{number(row['value'], 5)}{unit}, without an interval"
    return (f"{number(row['limit'], 5)}{unit}, 95 % interval {number(row['low'], 5)} to {number(row['high'], 5)}{unit} "
            f"(finest run: {number(row['value'], 5)}{unit})")


def first_line(content):
    row, words = content["answer"], interval_of(content["answer"])
    name = f"{row['probe']}, {row['quantity']}: " if row else ""
    if row and not content["faults"] and f"'{row['probe']}'" in content["question"]:
        name = ""  # the question contains the name
    if content["faults"]:
        return f"This number cannot be relied on: {'; '.join(content['faults'])}. {name}{words}."
    return f"{content['question']} {name}{words}."


def case_of(run):
    """Summary, findings and drawing of the case, made with the present program."""
    found = {"title": run.case["case"]["title"], "explain": [], "findings": [], "drawing": "", "note": ""}
    try:
        case = Case(run.path / "case.effective.toml")
        found["explain"] = case.explain().splitlines()
        check = case.check()
        found["findings"] = [{"severity": one["severity"], "message": f"{one['message']} [{one['id']}]"} for one in check.findings]
        drawing = check.drawing
        found["drawing"] = drawing[max(drawing.find("<svg"), 0):]
    except Error as error:
        found["note"] = f"the present program does not accept the case: {error}"
    return found


def provenance(runs):
    """Program and machine of the runs; a key has several values if the runs differ."""
    found = {}
    for run in runs:
        summary = run.summary
        machine = summary.get("machine", {})
        told = {name: summary.get(name, "") for name in ("version", "commit", "compiler", "options", "libraries")}
        told["machine"] = ", ".join(str(machine[name]) for name in ("name", "processor") if name in machine)
        told["cores"] = machine.get("cores", "")
        for name, value in told.items():
            if value != "" and value not in found.setdefault(name, []):
                found[name].append(value)
    return found


def digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def named_files(case):
    """(path, CRC-32 or "") of the files that an effective case names; a run writes their paths as absolute paths."""
    for tables in case.values():
        for table in tables if isinstance(tables, list) else [tables]:
            for key, key_of_checksum in FILE_KEYS.items():
                path = table.get(key, "")
                if isinstance(path, str) and path.startswith("/"):
                    yield path, table.get(key_of_checksum, "")


def faults_of_inputs(runs):
    """Faults of input files that are gone, or are not those of the runs any more."""
    found = []
    for path, checksum in dict.fromkeys(named for run in runs for named in named_files(run.case)):
        if not Path(path).is_file():
            found.append(f"the input file {path} is gone, so nobody can repeat its runs")
        elif checksum and f"{zlib.crc32(Path(path).read_bytes()):08x}" != checksum:
            found.append(f"the input file {path} has changed since the run, whose case has another checksum of it")
    return found


def inputs_of(runs):
    """Each input file once: its path, bytes, hash and, unless it is too large, content; no hash if the file is
    missing."""
    paths = dict.fromkeys(path for run in runs for path, _ in named_files(run.case))
    found = []
    for path in paths:
        if not Path(path).is_file():
            found.append({"path": path, "bytes": None, "sha256": "", "content": None})
            continue
        data = Path(path).read_bytes()
        packed = zlib.compress(data, 9)
        found.append({"path": path, "bytes": len(data), "sha256": digest(data),
                      "content": base64.b64encode(packed).decode() if len(packed) <= LARGEST_INPUT else None})
    return found


def run_record(role, run, row):
    """The record of a run: case, balances, hashes, and its value of the answer."""
    summary, case_text = run.summary, (run.path / "case.effective.toml").read_bytes()
    steps, scheme = summary.get("steps", {}), run.case["scheme"]
    outputs = {str(path.relative_to(run.path)): digest(path.read_bytes())
               for pattern in RESULTS for path in sorted(run.path.glob(pattern))}
    found = quantities_of(run)
    return {"role": role, "folder": str(run.path), "status": run.status, "message": summary.get("message", ""),
            "spacing_m": run.spacing, "fluid_particles": summary.get("particles", {}).get("fluid"),
            "steps": steps.get("count"), "dt_mean_s": steps.get("dt_mean_s"), "integrator": run.integrator,
            "courant": scheme.get("courant"), "jitter_dx": run.case["particles"]["jitter"],
            "seed": run.case["particles"]["seed"], "ranks": summary.get("ranks", {}).get("count", 1),
            "cpu_s": summary.get("cost", {}).get("cpu_s"), "time_s": summary.get("time_s", {}),
            "value": found.get((row["probe"], row["quantity"]), (None,))[0] if row else None,
            "water": report_faults.water_of(summary), "energy": report_faults.energy_of(summary),
            "program": program_of(summary), "case_sha256": digest(case_text), "case": case_text.decode("utf-8"),
            "outputs": outputs}


def program_of(summary):
    return f"tailwater {summary['version']} (commit {summary['commit']})" if "version" in summary else ""


def validated(features, run, row):
    """The validated flow most like the case, with Tailwater's errors for that flow, or a note if there is no table."""
    types = {probe["name"]: probe["type"] for probe in run.case.get("probe", [])}
    kind = case_features.KINDS.get(types.get(row["probe"]), "") if row else ""
    try:
        table = load_evidence()
        flow = case_features.nearest_flow(features, table["flows"], kind)
    except DataError as error:
        return {"note": str(error)}
    rows = [one for one in table["rows"] if one["flow"] == flow["name"] and one["target"]]
    of_kind = [one for one in rows if one["kind"] == kind]
    return {"name": flow["name"], "title": flow["title"], "shared": flow["shared"], "only_here": flow["only_here"],
            "only_there": flow["only_there"], "kind": kind, "commit": table["commit"], "rows": of_kind or rows,
            "note": "" if of_kind or not kind else f"No {kind} was compared in that flow; its other quantities are listed."}
