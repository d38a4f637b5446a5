#!/usr/bin/python3
"""Checks the documents: their case files, commands and scripts, their readers, and tables that stand twice.

Usage: scripts/pages.py [PAGE ...]    all documents by default; prints findings, exit code 1 if there is one

The first line of a TOML block states its use, as in:
  # my.toml                                                      a complete case, saved under this name
  # append to my.toml, without [[damping]]                       the case so far, less these tables, and then the block
  # replace in the template weir                                 values of the template in `tailwater new weir`
  # in my.toml                                                   an excerpt: my.toml has these values; or one of cases/
  # append to a case                                             any case; here a closed tank, half full
The result must be a case that `tailwater check` accepts. Commands of a page run in order, in an empty folder, if they
take less than a second; runs in 2D end after a few steps. Of the others the command, options, files and keys are checked.
"""
import contextlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import tomllib
from typing import NamedTuple

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path += [str(ROOT / "build/release/lib/python3/dist-packages"), str(ROOT / "validation")]
from tailwater import Case, InputError, program  # noqa: E402

TANK = """\
particles.spacing = 0.05
time.end = 1
"""
WATER = """
[[wall]]
name = "a_tank"
shape = "box"
min = [0, 0]
max = [1, 1]
fluid_side = "inside"
[[fluid]]
min = [0, 0]
max = [1, 0.25]
"""
USE = re.compile(r"# (?:(append to|replace in|in) )?(?:the template ([\w-]+)|(a case)|((?:(?<=# in )cases/\w+/)?[\w-]*\.?[\w-]+\.toml))"
                 r"(?:, without ([\w\[\], ]+))?$")
# Pages whose scripts run here. The scripts of the others run in tests, which name the page.
RUN_HERE = {f"docs/guide/{name}.md" for name in ("gauge", "openings", "stl", "terrain", "wave_energy")}
TESTS = "".join((ROOT / f"tests/python/test_{name}.py").read_text(encoding="utf-8") for name in ("guide", "report"))
SIGNATURES = "docs/reference/python.md"
# Files that a page expects of its reader, and what stands in for them.
STAND_INS = {
    "docs/reference/examples.md": {"gauge.csv": "t [s], depth [mm]\n0, 100\n1, 90\n"},
    "docs/theory/moving_walls.md": {"roll.csv": "t [s], angle [deg]\n0, 0\n1, 5\n2, 0\n"},
    "docs/theory/waves.md": {"paddle.csv": "t [s], x [m]\n0, 0\n1, 0.02\n20, 0\n"},
    "docs/theory/probes.md": {"gauge_1.csv": "t [s], H1 [mm]\n0, 100\n1, 90\n"},
}
EXAMPLES = "docs/reference/examples.md"
NO_EXAMPLE = {"parameters", "parallel", "limits", "study"}  # of the page of the case file, and keys for studies
PROGRAM = "tests/install/program"
BUILT = {path.read_text(encoding="utf-8") for path in (ROOT / PROGRAM).iterdir()}  # by a test
OTHER_PROGRAMS = {"apt", "clang-tidy", "cmake", "cp", "export", "mpirun"}
NO_READER = {"README.md", "CODE_OF_CONDUCT.md"}  # README has a section on its readers
LONG_ROW = 60  # characters; shorter rows are headings and common pairs
NOT_RUN = {"bench", "check", "man", "paddle", "pictures", "report", "resume", "study", "validate", "waves"}


class Block(NamedTuple):
    line: int  # of its text
    kind: str  # language, or "indented"
    text: str


def blocks(text):
    """Blocks of code of a page in Markdown, in order."""
    lines = text.splitlines() + [""]
    number = 0
    while number < len(lines):
        begin, fence = number + 1, re.match(r"( *)```(\w*)", lines[number])
        number += 1
        if fence:
            while not lines[number].strip().startswith("```"):
                number += 1
            yield Block(begin + 1, fence[2] or "text", "\n".join(lines[begin:number]) + "\n")
            number += 1
        elif lines[begin - 1].startswith("    ") and (begin == 1 or not lines[begin - 2].strip()):
            while number < len(lines) - 1 and (lines[number].startswith("    ") or not lines[number].strip()):
                number += 1
            yield Block(begin, "indented", "\n".join(line[4:] for line in lines[begin - 1:number]).rstrip() + "\n")


def commands(text):
    """(offset of the line, words) of the commands in a block of text; lines of output are left out."""
    joined = re.sub(r" \\\n +", " ", text)
    for offset, line in enumerate(joined.splitlines()):
        if re.match(r"(\$ )?(PYTHONPATH=\S+ |build/\S+/bin/)?(tailwater|scripts/|benchmarks/|npm|/usr/bin/python3|cd) ?", line) \
                or line.split(" ")[0] in OTHER_PROGRAMS:
            for part in line.removeprefix("$ ").split(" && "):
                yield offset, shlex.split(part, comments=True)


def values(tables):
    """(key, value) of each value in tables of a case; those of a list must have names."""
    for table, entries in tables.items():
        for entry in entries if isinstance(entries, list) else [entries]:
            prefix = f"{table}.{entry['name']}" if isinstance(entries, list) else table
            yield from ((f"{prefix}.{key}", value) for key, value in entry.items() if key != "name")


def reference():
    """{command: its help} from the page of the command line, which a test compares with the program."""
    page = (ROOT / "docs/reference/command-line.md").read_text(encoding="utf-8")
    return dict(re.findall(r"^## `tailwater ?(\w*)`\n\n```text\n(.*?)```", page, re.MULTILINE | re.DOTALL))


HELP = reference()
TABLES = {table["name"]: table for table in json.loads(subprocess.run(
    [program(), "run", "--help-case=json"], check=True, capture_output=True, text=True).stdout)["tables"]}


def command_fault(words):
    """The fault of a command of the program, or None."""
    if words[1].startswith("-"):
        return None if words[1] in HELP[""] else f"there is no option {words[1]}"
    if words[1] not in HELP:
        return f"there is no command {words[1]}"
    for word in words[2:]:
        option = re.match(r"--?[a-z][\w-]*", word)
        # `bench` has commands of its own, whose options the reference does not list.
        if option and words[1] != "bench" and not re.search(rf"(?<![\w-]){option[0]}(?![\w-])", HELP[words[1]]):
            return f"tailwater {words[1]} has no option {option[0]}"
    for word in words[2:3]:
        if words[1] == "new" and word.islower() and not word.startswith("-") and f"\n  {word} " not in HELP["new"]:
            return f"there is no template {word}"
    return None


def other_fault(words):
    """The fault of a command that is not of the program, or None."""
    if "tailwater_validation.score" in words:
        from tailwater_validation.exact_flows import FLOWS
        from tailwater_validation.studies import LABORATORIES
        name = words[words.index("tailwater_validation.score") + 1]
        names = {*FLOWS, "NAME", *(module.__name__.rpartition(".")[2] for module in LABORATORIES)}
        return None if name in names else f"tailwater_validation.score has no case {name}"
    if words[:2] == ["npm", "run"]:
        scripts = json.loads((ROOT / "web/package.json").read_text(encoding="utf-8"))["scripts"]
        return None if words[2] in scripts else f"web/package.json has no script {words[2]}"
    if words[0].startswith(("scripts/", "benchmarks/")):
        file = ROOT / words[0]
        if not os.access(file, os.X_OK):
            return f"{words[0]} cannot be run"
        text = file.read_text(encoding="utf-8")
        missing = [word for word in words[1:] if word.startswith("--") and word not in text]
        return f"{words[0]} has no option {missing[0]}" if missing else None
    return None


CHECKED = {}  # (text of a case, changes): messages


def check_case(file, changes=()):
    """Messages of the errors that `check` finds."""
    of = (pathlib.Path(file).read_text(encoding="utf-8"), *changes)
    if of not in CHECKED:
        CHECKED[of] = messages_of_check(file, changes)
    return CHECKED[of]


def messages_of_check(file, changes):
    words = [word for change in changes for word in ("--set", change)]
    told = subprocess.run([program(), "check", file, "--json", "--no-preview", *words], capture_output=True, text=True)
    if told.returncode not in (0, 2) or not told.stdout.startswith("{"):
        return [told.stderr.strip()]
    return [finding["message"] for finding in json.loads(told.stdout)["findings"] if finding["severity"] == "error"]


def base(use, fragment):
    """Writes the case on which a fragment builds, and returns its file."""
    _, template, any_case, name, without = use.groups()
    file = name or "a_case.toml"
    if template:
        subprocess.run([program(), "new", template, file, "--force"], check=True, capture_output=True)
    if any_case:
        has_water = re.search(r"^\[\[(fluid|inlet)\]\]", fragment, re.MULTILINE)
        pathlib.Path(file).write_text(TANK + ("" if has_water else WATER), encoding="utf-8")
    if without:
        case = Case(file)
        for table in re.findall(r"\[\[(\w+)\]\]", without):
            del case[table]
        case.save(file)
    return file


def assemble(block):
    """Writes the case of a block of TOML into the working folder; returns (its file, faults of the block)."""
    use = USE.match(block.text.partition("\n")[0])
    if not use:
        return None, ['the block does not state its use in its first line, as in "# append to my.toml"']
    action, _, _, name, _ = use.groups()
    tables = tomllib.loads(block.text)
    if name and name.startswith("."):
        return None, []  # a file of another program
    if not action:
        pathlib.Path(name).write_text(block.text, encoding="utf-8")
        return name, []
    file = base(use, block.text)
    case = Case(file)
    if action == "in":
        return file, [f"{file} has {key} = {case[key]}" for key, value in values(tables) if case[key] != value]
    if action == "replace in":
        case.update(dict(values(tables))).save(file)
    else:
        with open(file, "a", encoding="utf-8") as text:
            text.write("\n" + block.text)
    return file, []


class Walk:
    """A reader who follows a page in an empty folder, which is the working folder. `faults` are (line, message)."""

    def __init__(self, name, text):
        self.name, self.faults, self.complete = name, [], set()
        for file, content in STAND_INS.get(name, {}).items():
            pathlib.Path(file).write_text(content, encoding="utf-8")
        pathlib.Path("cases").symlink_to(ROOT / "cases")
        names = {}  # of the page's scripts
        for block in blocks(text):
            if block.kind == "toml":
                self.follow_toml(block)
            elif block.kind == "python":
                self.follow_python(block, names)
            elif block.kind == "indented":
                self.follow_commands(block)
            elif block.kind in ("cpp", "cmake") and block.text not in BUILT:
                self.fault(block.line, f"no test builds this text; it is not that of a file in {PROGRAM}")

    def fault(self, line, message):
        self.faults.append((line, message))

    def follow_toml(self, block):
        try:
            file, faults = assemble(block)
        except (InputError, tomllib.TOMLDecodeError, FileNotFoundError) as error:
            return self.fault(block.line, str(error))
        if file and block.text.startswith(f"# {file}") and "dimension = 3" not in block.text:
            self.complete.add(file)  # and short enough to run, in 2D
        for message in faults or (check_case(file) if file else []):
            self.fault(block.line, message)

    def follow_python(self, block, names):
        if self.name == SIGNATURES:
            return
        try:
            code = compile(block.text, self.name, "exec")
        except SyntaxError as error:
            return self.fault(block.line, str(error))
        if self.name in RUN_HERE and block.kind == "python":
            exec(code, names)
        elif block.kind == "python" and not re.search(rf'\b{pathlib.PurePath(self.name).stem}(\.md)?"', TESTS):
            self.fault(block.line, "no test runs this script")

    def follow_commands(self, block):
        if block.text.startswith("["):
            self.fault(block.line, "a part of a case is no block of TOML; write ```toml")
        if re.match(r"(case|study)\b.* = |xarray\.", block.text):
            self.follow_python(block, {})
        for offset, words in commands(block.text):
            self.follow_command(block.line + offset, words)

    def follow_command(self, line, words):
        if words[0].startswith("build/"):
            words = [pathlib.PurePath(words[0]).name, *words[1:]]
        if words[0] != "tailwater":
            fault = other_fault(words)
        else:
            fault = command_fault(words) or self.run(words[1], words[2:])
        if fault:
            self.fault(line, f"{shlex.join(words)}: {fault}")

    def run(self, command, words):
        """Runs a command of the program, if its files exist and it is short; returns its fault or None."""
        if ">" in words:
            words = words[:words.index(">")]
        file = next((word for word in words if not word.startswith("-")), "")
        changes = [change for option, change in zip(words, words[1:]) if option == "--set" and "..." not in change]
        if file.endswith(".toml") and command in ("check", "run", "study", "view"):
            if not pathlib.Path(file).exists():
                return f"nothing on the page makes {file}" if self.name.startswith("docs/guide/") else None
            if faults := check_case(file, changes):
                return faults[0]
        if command == "run" and file in self.complete:
            words = [*words[:1], "--out", words[words.index("--out") + 1], "--set", "time.end=0.005", "--quiet"]
        elif command in NOT_RUN or command == "run" and file or command == "view" and "--export" not in words:
            return None
        elif command not in ("new", "bed", "run") and not pathlib.Path(file).exists():
            return None
        done = subprocess.run([program(), command, *words], capture_output=True, text=True)
        return None if done.returncode == 0 else (done.stderr or done.stdout).strip()


def spans(text):
    """(line, text) of code in sentences and tables."""
    bare = re.sub(r"^( *)```.*?^ *```$", lambda block: "\n" * block[0].count("\n"), text, flags=re.MULTILINE | re.DOTALL)
    for found in re.finditer(r"`([^`\n]+(?:\n[^`\n]+)?)`", bare):
        yield bare.count("\n", 0, found.start()) + 1, " ".join(found[1].split())


def span_faults(name, text):
    """(line, message) of commands and keys in sentences that do not exist."""
    for line, span in spans(text) if name != "CHANGELOG.md" else []:  # which names keys that are gone
        words = span.replace('"', "").replace("'", "").split()
        if words[0] == "tailwater" and len(words) > 1 and words[1].islower() and (fault := command_fault(words)):
            yield line, f"`{span}`: {fault}"
        key = re.fullmatch(r"([a-z_]+)\.(?!(?:h|cpp|py|toml|json|md|csv)$)([a-z_]+)", span)
        if key and key[1] in TABLES and not TABLES[key[1]]["has_free_keys"] and key[2] not in {
                each["name"] for each in TABLES[key[1]]["keys"]}:
            yield line, f"`{span}`: the table {key[1]} has no key {key[2]}"


def example_faults(name, text):
    """Tables of the case file and types of probes without an example on the page of examples."""
    if name == EXAMPLES:
        types = next(key for key in TABLES["probe"]["keys"] if key["name"] == "type")["choices"]
        headings = set(re.findall(r"^### \[{0,2}([\w-]+)\]{0,2}$", text, re.MULTILINE))
        for missing in sorted({*TABLES, *types} - headings - NO_EXAMPLE):
            yield 1, f"there is no example of {missing}"


def reader_faults(name, text):
    if name not in NO_READER and not re.match(r"(\s*<!--.*-->)?# .*\n\n(?:!\[.*\n\n)?For ", text):
        yield 3, 'the first line below the title does not say for whom the page is; begin it with "For users", ...'


def row_key(line):
    """Its numbers, if it has four cells with numbers after the first cell, which names them and may be worded otherwise;
    else the row itself, if it is long. None for other lines."""
    if not line.startswith("| ") or "---" in line:
        return None
    numbers = [cell for cell in (cell.strip(" *$") for cell in line.strip("|").split("|")[1:]) if re.search(r"\d", cell)]
    return tuple(numbers) if len(numbers) >= 4 else line if len(line) > LONG_ROW else None


def repeated_rows(pages):
    """(page, line, message) of rows of tables that stand on two pages, those that a program writes left out."""
    seen = {}
    for name, text in pages.items():
        written = re.sub(r"<!-- (evidence|validation):.*?<!-- \1: end -->", lambda part: "\n" * part[0].count("\n"), text,
                         flags=re.DOTALL)
        for number, line in enumerate(written.splitlines(), 1):
            key = row_key(line)
            if key is not None and seen.setdefault(key, name) != name:
                yield name, number, f"the row stands on {seen[key]} too; say it once and link to it"


def page_faults(name, text):
    """(line, message) of a page."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        walked = Walk(name, text).faults
    return sorted([*walked, *span_faults(name, text), *reader_faults(name, text), *example_faults(name, text)])


def names():
    """Documents whose text holds for the present version: the dated pages of the notebook keep theirs."""
    patterns = ("*.md", "docs/*.md", "docs/guide/*.md", "docs/reference/*.md", "docs/theory/*.md", "docs/notebook/README.md",
                "cases/*/README.md", "web/README.md")
    return sorted(str(path.relative_to(ROOT)) for pattern in patterns for path in ROOT.glob(pattern))


def main(arguments):
    if any(argument.startswith("-") for argument in arguments):
        print(__doc__, file=sys.stderr)
        return 2
    chosen = [str(pathlib.Path(name).resolve().relative_to(ROOT)) for name in arguments] or names()
    pages = {name: (ROOT / name).read_text(encoding="utf-8") for name in chosen}
    found = [(name, *fault) for name, text in pages.items() for fault in page_faults(name, text)]
    found += repeated_rows(pages)
    for name, line, message in found:
        print(f"{name}:{line}: {message}")
    print(f"pages.py: {len(pages)} pages, {len(found)} findings")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
