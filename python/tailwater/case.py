"""Cases: a case file as a dict that checks its keys."""

import filecmp
import html
import json
import os
import shutil
import tempfile
import tomllib
import weakref
from functools import lru_cache
from pathlib import Path

from . import case_text
from .errors import DataError, Error, InputError, IoError
from .input_file import read_bytes
from .program import call
from .run import Run, warn_of
from .whole_file import write_whole, write_whole_text

__all__ = ["Case", "Check"]

LARGEST = 32 << 18  # bytes; limit for an effective case, as in the program


@lru_cache(maxsize=None)
def known_tables() -> dict:
    """{table: (has_free_keys, {key: default})} of the program."""
    tables = json.loads(call("run", "--help-case=json"))["tables"]
    return {table["name"]: (table["has_free_keys"], {key["name"]: key.get("default") for key in table["keys"]})
            for table in tables}


def folder_name(out):
    """Returns the folder name that a caller gives. Throws InputError if it is not a name."""
    if isinstance(out, (str, os.PathLike)) and os.fspath(out):
        return out
    raise InputError(f"out = {out!r}: give the name of a folder, as in case.run(\"my_run\")")


class TemporaryFolder:
    """A folder that is deleted when this object is no longer referenced."""

    def __init__(self):
        self.path = Path(tempfile.mkdtemp(prefix="tailwater-"))
        weakref.finalize(self, shutil.rmtree, self.path, ignore_errors=True)


class Check:
    """The findings of `check` for a case; true if a run may begin.

    `findings` is a list of dicts with "severity" ("error" or "warning"), "id", "line" and "column" (0: none), "message"
    and "places" (lists of coordinates, m). They have "table", "index", "key", "value", "unit" and "remedy" where these are
    known. `particles` (of fluid) and `memory` (bytes) are None where they cannot be computed."""

    def __init__(self, case: "Case"):
        self.case = case
        answer = json.loads(call("check", "--json", *case.words(), reports_errors=True))
        self.findings = answer["findings"]
        cost = answer["cost"] or {}
        self.particles, self.memory = cost.get("fluid"), cost.get("memory_bytes")

    def __bool__(self) -> bool:
        return not any(finding["severity"] == "error" for finding in self.findings)

    @property
    def drawing(self) -> str:
        """The preview as SVG text, with marks at faulty places; "" if nothing can be drawn."""
        with tempfile.TemporaryDirectory() as folder:
            preview = Path(folder) / "preview.svg"
            try:
                call("check", *self.case.words(), "--preview", preview)
            except Error:
                pass  # the findings report these errors
            return preview.read_text(encoding="utf-8") if preview.exists() else ""

    def __repr__(self) -> str:
        lines = [f"{self.case.title}: {'valid' if self else 'not valid'}"]
        if self.particles is not None:
            lines.append(f"{self.particles} fluid particles, about {self.memory / 1e6:.0f} MB")
        lines += [f"{finding['severity']}: {finding['message']} [{finding['id']}]" for finding in self.findings]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        drawing = self.drawing
        picture = f"<div>{drawing[drawing.find('<svg'):]}</div>" if drawing else ""
        return f"<pre>{html.escape(repr(self))}</pre>{picture}"


class Case:
    """A case. Keys are as on the command line: "particles.spacing", "fluid[0].max" or "probe.NAME.interval". Values are
    as in the file: numbers, texts (also expressions), true and false, and lists of them.

        case = Case.template("weir")
        case["parameters.q"] = 0.06
        case["parameters.q"]          # 0.06; for a key that the case does not give: its default, or None
        del case["probe.downstream"]  # a table with a name or a number; "probe" deletes all probes
        run = case.run("out")

    Throws InputError for a key that no case has, and for a parameter or a table that this case does not have. `check`
    and `run` check the values."""

    def __init__(self, file):
        """Reads a case file. Throws IoError if it cannot be read, InputError if it is not TOML."""
        self.file = Path(file)
        self.changes = {}  # {key: value}, passed to the program on its command line
        self._edits = []  # changes of the text of the case: (key, value), or (key, None) for a deleted table
        self._folder = None  # the folder of a template, kept as long as a case refers to it
        try:
            text = read_bytes(self.file, LARGEST)
        except DataError as error:
            raise IoError(str(error)) from error
        try:
            self._text = text.decode("utf-8")
            self._data = tomllib.loads(self._text)
        except (RecursionError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
            raise InputError(f"{file}: {error}") from error

    @classmethod
    def load(cls, file) -> "Case":
        """Reads a case file."""
        return cls(file)

    @classmethod
    def template(cls, name: str) -> "Case":
        """A template of `tailwater new`, such as "weir", in a temporary folder with the files that it reads; `save`
        copies all of them. Throws InputError, which lists the names, for an unknown name."""
        folder = TemporaryFolder()
        file = folder.path / f"{name}.toml"
        call("new", name, file)
        case = cls(file)
        case._folder = folder
        return case

    @property
    def title(self) -> str:
        """The title of the case, `case.title`."""
        return self["case.title"]

    def copy(self) -> "Case":
        """A copy with the same values; later changes affect only the copy."""
        other = object.__new__(Case)
        other.__dict__ = {**self.__dict__, "changes": dict(self.changes), "_edits": [*self._edits]}
        return other

    def __getitem__(self, key: str):
        steps = case_text.steps_of(key)
        try:
            return case_text.find(self._data, steps)
        except (KeyError, IndexError, TypeError):
            self._require_known(key, steps)
            if len(steps) > 2 and (isinstance(steps[1], int) or isinstance(steps[2], str)):
                self._require_table(key, steps[:2])
            return known_tables()[steps[0]][1].get(steps[-1])

    def __contains__(self, key: str) -> bool:
        """Whether the case gives the key a value, other than a default."""
        try:
            case_text.find(self._data, case_text.steps_of(key))
        except (KeyError, IndexError, TypeError):
            return False
        return True

    def __setitem__(self, key: str, value):
        steps = case_text.steps_of(key)
        case_text.toml_value(value)
        self._require_known(key, steps)
        try:
            self._data = case_text.put(self._data, steps, value)
        except (KeyError, IndexError, TypeError) as error:
            raise InputError(f"{key}: the case has no {case_text.missing(self._data, steps)}") from error
        self.changes.pop(key, None)  # moved to the end, so that the program applies it last
        self.changes[key] = value
        self._edits.append((key, value))

    def __delitem__(self, key: str):
        steps = case_text.steps_of_table(key)
        try:
            self._data = case_text.without(self._data, steps)
        except TypeError as error:
            raise InputError(f"{key}: the case has no {error}") from error
        except (KeyError, IndexError) as error:
            raise InputError(f"{key}: the case has no {case_text.missing(self._data, steps)}") from error
        # On the command line, a change can only replace all tables of one name.
        table = steps[0]
        self.changes = {other: value for other, value in self.changes.items() if case_text.table_of(other) != table}
        self.changes[table] = self._data[table]
        self._edits.append((key, None))

    def update(self, values: dict) -> "Case":
        """Sets several keys; returns the case."""
        for key, value in values.items():
            self[key] = value
        return self

    def _require_table(self, key, steps):
        """Throws InputError if the case does not have a table of a list, such as "fluid[1]" or "probe.weir"."""
        try:
            case_text.find(self._data, steps)
        except (KeyError, IndexError, TypeError) as error:
            raise InputError(f"{key}: the case has no {case_text.missing(self._data, steps)}") from error

    def _require_known(self, key, steps):
        """Lets the program report the error for an unknown key, or for a parameter that this case does not have."""
        tables = known_tables()
        if steps[0] in tables:
            has_free_keys, keys = tables[steps[0]]
            last = [step for step in steps if isinstance(step, str)][-1]
            if last in (self._data.get(steps[0], {}) if has_free_keys else keys):
                return
        try:
            call("check", *self.words(), "--set", f"{key}=0")
        except InputError as error:  # the message for a script, without the command-line option
            told = str(error).removeprefix(f"--set {key}=0: ").replace(f"{key} = 0:", f"{key}:")
            raise InputError(told) from error

    def words(self, without=()) -> list:
        """The case as command-line words: its file and its changes, except changes of the keys `without`."""
        changes = [f"{key}={case_text.inline(value)}" for key, value in self.changes.items() if key not in without]
        return [str(self.file), *(word for change in changes for word in ("--set", change))]

    def save(self, file) -> "Case":
        """Writes the case with its changes and keeps its comments. In another folder it also writes the files that the
        case reads. Returns the saved case. Throws InputError where a file would replace a different file."""
        file, text = Path(file), self._text
        for key, value in self._edits:
            text = case_text.text_without(text, key) if value is None else case_text.changed_text(text, key, value)
        read = [] if file.parent.resolve() == self.file.parent.resolve() else self._files_read()
        for source in read:
            target = file.parent / source.relative_to(self.file.parent)
            if target.is_file() and not filecmp.cmp(target, source, shallow=False):
                raise InputError(f"{target} exists and is another file than the case reads; remedy: another folder")
        write_whole_text(file, text)
        for source in read:
            target = file.parent / source.relative_to(self.file.parent)
            try:
                target.parent.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                raise IoError(f"{error.filename}: cannot be made ({error.strerror})") from error
            write_whole(target, lambda part, source=source: shutil.copy(source, part))
        return Case(file)

    def _files_read(self):
        """The files that the case reads from the folder of the case file or below; paths elsewhere stay valid."""
        def texts(node):
            if isinstance(node, str):
                yield node
            elif isinstance(node, (list, dict)):
                for each in node.values() if isinstance(node, dict) else node:
                    yield from texts(each)

        folder = self.file.parent
        names = dict.fromkeys(os.path.normpath(text) for text in texts(self._data))
        return [folder / name for name in names if not os.path.isabs(name) and not name.startswith("..")
                and name != self.file.name and os.path.isfile(folder / name)]

    def check(self) -> Check:
        """Checks the case without running it. Never throws for errors in the case."""
        return Check(self)

    def explain(self) -> str:
        """A summary of the case in sentences, with its cost. Throws InputError."""
        return call("explain", *self.words()).rstrip("\n")

    def run(self, out, *, ranks: int = 1, force: bool = False, progress: bool = False) -> Run:
        """Runs the case in the folder `out`, which is created; `force` replaces an earlier run. Ctrl-C stops the run
        with a checkpoint. Throws InputError and IoError before anything is written, SolverError if a step fails.
        Warnings of the run become RunWarnings."""
        words = ["run", *self.words(), "--out", folder_name(out), "-n", ranks, *(["--force"] if force else []),
                 *([] if progress else ["--quiet"])]
        call(*words, progress=progress)
        run = Run(out)
        if not progress:
            warn_of(run)
        return run

    def simulation(self, out=None, *, hook=None, force: bool = False):
        """The run in this process, for a `with` statement (tailwater.simulation). Writes a run folder only if `out` is
        given."""
        from .simulation import Simulation  # compiled; starts MPI

        return Simulation(self, out, hook=hook, force=force)

    def __repr__(self) -> str:
        return f"Case({str(self.file)!r}: {self.title}" + "".join(f", {k} = {v}" for k, v in self.changes.items()) + ")"

    def _repr_html_(self) -> str:
        return self.check()._repr_html_()
