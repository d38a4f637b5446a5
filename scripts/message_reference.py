#!/usr/bin/python3
"""The reference of messages, from the places in the source where they are made: docs/reference/messages.md.

Usage: scripts/message_reference.py            writes the page
       scripts/message_reference.py --check    exit code 1 if the page does not agree with the source
Fails if an id stands for two messages, if a message has two ids, or if a file that makes messages is in no group.
"""
import pathlib
import re
import sys
from dataclasses import dataclass

from generated_page import write_or_check

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCES = ROOT / "src", ROOT / "python"
PAGE = ROOT / "docs" / "reference" / "messages.md"
HEAD = """\
# Messages

For users who look up an error or a warning. Every error about a case and every warning ends with its id in brackets:

    case.toml:9:1: the gap of 0.03 m between wall 'bed' and wall 'pier' at (1, 0) counts as closed, because it is
    narrower than half a spacing; let the walls touch, or use a spacing of at most 0.006 m to let water pass
    [gap-closed]

Search this page for the id. An error stops the command, and a warning does not. Most errors of the command line, of
files and of the solver have no id. `tailwater check --json` has the id under `id`, and the lines under `warnings` in
`summary.json` end with it. `…` stands for names, places and numbers, and `key` for a key of the case file.

The last column names the tables of the case file that a message is about:

- `any`: one table, of any kind;
- `several`: tables that do not fit each other;
- `motions, bodies, zones`: `[[gate]]`, `[[wave_maker]]`, `[[body]]`, `[[mooring]]`, `[[damping]]` or `[[refinement]]`;
- `files`: CSV files that the table names.

[Troubleshooting](../guide/troubleshooting.md) explains the most frequent messages. `scripts/message_reference.py`
writes this page from the source.
"""
# Title of a group: {file or folder of the source: its tables}, in the order of the page.
GROUPS = {
    "The case file": {"case/case_toml": "any", "case/overrides": "any", "case/reader": "any", "case/table_reader": "any",
                      "case/foundations": "`[case]`, `[parameters]`", "case/key_rules": "any", "case/table_rules": "any",
                      "case/linked_rules": "`[[inlet]]`, `[[outlet]]`, files", "case/driven_rules": "motions, bodies, zones",
                      "case/across_tables": "several", "case/series_rules": "several", "case/measurements": "`[[measurement]]`",
                      "geometry/from_spec": "any", "app/check_json": "any"},
    "Walls": {"geometry/make_boundary": "`[[wall]]`", "geometry/wall_patches": "`[[wall]]`",
              "checks/self_crossing": "`[[wall]]`", "checks/wall_thickness": "`[[wall]]`", "checks/plates": "`[[wall]]`",
              "checks/leaks": "`[[wall]]`", "checks/crests": "`[[wall]]`", "checks/closed_gaps": "`[[wall]]`",
              "checks/roughness": "`[[wall]]`", "checks/periodic_width": "`[domain]`", "parts/side_walls": "`[physics]`"},
    "Meshes": {"geometry/mesh_walls": "`[[wall]]`, `[[fluid]]`", "sampling/wall_meshes": "`[[wall]]`",
               "checks/meshes": "`[[wall]]`"},
    "Motion of walls": {"checks/moving_walls": "`[[wall]]`", "checks/motion_files": "`[[wall]]`",
                        "checks/paths": "`[[wall]]`", "checks/late_starts": "`[[gate]]`, `[[measurement]]`",
                        "checks/free_ends": "`[[wall]]`",
                        "checks/touching_rows": "`[[wall]]`"},
    "Water at the start": {"checks/blocks": "`[[fluid]]`", "checks/overlap": "`[[fluid]]`",
                           "checks/fluid_at_walls": "`[[fluid]]`", "checks/hanging_water": "`[physics]`",
                           "checks/sealed_space": "`[[fluid]]`", "sampling": "`[[fluid]]`"},
    "Inlets and outlets": {"geometry/opening": "`[[inlet]]`, `[[outlet]]`", "checks/open_ends": "`[[inlet]]`, `[[outlet]]`",
                           "checks/end_flows": "`[[inlet]]`, `[[outlet]]`", "checks/closed_space": "`[[inlet]]`",
                           "checks/speeds": "`[[inlet]]`, `[[outlet]]`, `[[body]]`", "motion/channel_end": "`[[inlet]]`",
                           "open_ends/monitor": "`[[inlet]]`, `[[outlet]]`"},
    "Waves": {"motion/wave_maker": "`[[wave_maker]]`", "motion/wave_field": "`[[damping]]`",
              "motion/wave_zone": "`[[damping]]`", "checks/wave_makers": "`[[wave_maker]]`, `[[damping]]`"},
    "Bodies and moorings": {"checks/bodies": "`[[body]]`, `[[mooring]]`", "checks/body_gaps": "`[[body]]`",
                            "checks/springs": "`[[body]]`, `[[mooring]]`", "bodies/floating_bodies": "`[[body]]`"},
    "Zones of refinement": {"checks/refinement": "`[[refinement]]`", "refinement/spacing_field": "`[[refinement]]`"},
    "Air, porous layers and liquids": {"air": "`[air]`, `[[pocket]]`, `[[vent]]`", "checks/air_places": "`[[pocket]]`, `[[vent]]`",
                                       "air/voids_under_tension": "`[physics]`", "air/pulled_walls": "`[physics]`",
                                       "porous": "`[[porous]]`", "checks/creep": "`[[liquid]]`", "checks/units": "`[physics]`",
                                       "rheology/thick_liquid": "`[[liquid]]`, `[[wall]]`"},
    "Probes": {"checks/probes": "`[[probe]]`, `[[damping]]`", "checks/shared_force": "`[[probe]]`", "probes": "`[[probe]]`"},
    "Cost, solver and machine": {"run/estimate": "`[particles]`, `[time]`", "linear/petsc_options": "`[pressure_solver]`",
                                 "app/ranks": "", "app/pictures": "", "app/check_command": "", "io/folder_lock": "",
                                 "run/resume": ""},
    "During a run": {"results": "`[limits]`, `[[probe]]`, `[[outlet]]`", "run/run_output": "`[[wall]]`", "module": ""},
}
# Messages that pass on another text.
PASSED = {"case-not-readable": "the case cannot be read", "expression-invalid": "the place in the expression and its error",
          "linked-file": "the line of the named file and its fault", "list-expected": "give a list of …",
          "override-misplaced": "the key of --set does not exist, or is not written as table.key=value",
          "balance-limit-passed": "at t = … s the energy of the water rose, or its mean density was off, by … %, more than "
                                  "limits.energy_warning or limits.volume_warning; remedy: use a smaller particles.spacing or "
                                  "scheme.courant",
          "balance-worst": "until t = … s the energy of the water rose, or its mean density was off, by … %, the largest "
                           "value in this run",
          "checkpoint-damaged": "the faults of the newest checkpoints; continuing from the last intact one"}
MADE = re.compile(r"\b(?P<maker>Finding::(?:error|warning)|CaseError|(?:tailwater::)?warn|error|wrong|missing|add|add_override"
                  r"|report|refuse)\(\s*\"(?P<id>[a-z0-9]+(?:-[a-z0-9]+)+)\",\s*")
LITERAL = r'"((?:[^"\\]|\\.)*)"'
TEXT = re.compile(rf"{LITERAL}(?:\s*{LITERAL})*")


@dataclass(frozen=True)
class Message:
    severity: str
    problem: str
    remedy: str


def arguments_from(text, begin):
    """The arguments of a call or list, split at its own commas; `begin` is behind the opening bracket."""
    found, depth, start, k = [], 0, begin, begin
    while depth >= 0:
        if text[k] == '"' and text[k - 1] != "'":
            k = re.compile(LITERAL).match(text, k).end() - 1
        elif text[k] in "({[":
            depth += 1
        elif text[k] in ")}]":
            depth -= 1
        if depth < 0 or depth == 0 and text[k] == ",":
            found.append(text[start:k].strip())
            start = k + 1
        k += 1
    return found


def joined(text):
    """The text of string literals that stand one after another."""
    return "".join(re.findall(LITERAL, text)).replace('\\"', '"')


def filled(arguments):
    """A format with its arguments, as the page shows it."""
    text, rest = joined(TEXT.match(arguments[0])[0]), iter(arguments[1:])

    def shown(_):
        argument = next(rest, "")
        if choice := re.match(r"name_of\(\w+::(\w+)\)$", argument):
            return choice[1].replace("_", "-")
        amount = re.match(r'Amount\{.*"([^"]*)"\}$', argument, re.DOTALL)
        return f"… {amount[1]}" if amount else "…"
    return re.sub(r"(?:… *)*…(?! %)(?=[ ,;:.]|$)", "…", re.sub(r"\{[^{}]*\}", shown, text).replace("{{", "{"))


def text_of(argument, source, place):
    """The text that an argument makes: a clause, a format, a literal, or a name that is one of these above `place`."""
    if argument.startswith("{"):
        inner = arguments_from(argument, 1)
        return filled(inner) if inner[0].startswith('"') else "…"
    if argument.startswith('"'):
        return filled([argument])
    if call := re.search(r"fmt::format\(", argument):
        return filled(arguments_from(argument, call.end()))
    name = re.match(r"(\w+)(\(|$)", argument)
    made = name and [found.end() for found in re.finditer(rf"\b{name[1]}(?:\([^;]*?\) \{{| =\s+)", source) if found.end() < place]
    return text_of(source[made[-1]:made[-1] + 2000], source, 0) if made else "…"


def is_text(argument):
    return argument.startswith(("{", "fmt::format(", "describe(", "discharge_warning(")) or \
        argument in ("message", "wanted", "unseen", "error.what()", "misplaced.reason") or "fmt::format(" in argument or \
        argument.startswith('"') and " " in joined(argument)


def message_at(found, source):
    arguments = arguments_from(source, found.end())
    kind = found["maker"]
    severity = "warning" if kind.endswith("warn") or kind.endswith("warning") else "error"
    if found["id"] in PASSED:
        problem, _, remedy = PASSED[found["id"]].partition("; remedy: ")
        return Message(severity, problem, remedy)
    first = next(k for k, argument in enumerate(arguments) if is_text(argument) and argument != "{}")
    if arguments[first].startswith("{"):
        problem, remedy = (text_of(argument, source, found.start()) if argument != "{}" else ""
                           for argument in arguments[first:first + 2])
        return Message(severity, problem, remedy.removeprefix("remedy: "))
    if arguments[first].startswith('"'):
        text = filled(arguments[first:])
    else:
        text = text_of(arguments[first], source, found.start())
    if severity == "warning":
        problem, _, remedy = text.replace(". Remedy: ", "; remedy: ").partition("; remedy: ")
        return Message(severity, problem, remedy)
    problem, _, remedy = text.rpartition("; ")
    if not problem and not re.match(r"(give|write|use|add|name|names)\b", remedy):
        problem, remedy = remedy, ""
    either = arguments[first] == "message"  # the key is wrong or missing
    key = "" if either else "key is missing" if kind == "missing" else "key = …" if kind in ("wrong", "report") else ""
    return Message(severity, ": ".join(part for part in (key, problem) if part), remedy)


def group_of(file):
    source = next(folder for folder in SOURCES if file.is_relative_to(folder))
    name = str(file.relative_to(source).with_suffix(""))
    for title, files in GROUPS.items():
        for key in (name, name.partition("/")[0]):
            if key in files:
                return title, files[key]
    raise SystemExit(f"message_reference.py: {name} makes messages and is in no group")


def collect():
    """{group: {id: (message, tables)}}. Throws SystemExit for an id or a message that is not unique."""
    groups, of_id, of_message = {title: {} for title in GROUPS}, {}, {}
    for file in sorted(file for folder in SOURCES for end in ("cpp", "h") for file in folder.rglob(f"*.{end}")):
        source = file.read_text(encoding="utf-8")
        for found in MADE.finditer(source):
            message, name = message_at(found, source), found["id"]
            if of_id.setdefault(name, message) != message:
                raise SystemExit(f"message_reference.py: {name} stands for two messages:\n{of_id[name]}\n{message}")
            if message.problem.strip("…: ") and of_message.setdefault(message, name) != name:
                raise SystemExit(f"message_reference.py: {name} and {of_message[message]} are the same message: {message}")
            title, tables = group_of(file)
            if not any(name in group for group in groups.values()):
                groups[title][name] = message, tables
    return groups


def cell(text):
    return text.replace("|", "\\|").replace("[[", "\\[\\[").replace("<", "&lt;")


def page():
    chapters = [HEAD]
    for title, messages in collect().items():
        rows = [f"| `{name}` | {message.severity} | {cell(message.problem)} | {cell(message.remedy)} | {tables} |"
                for name, (message, tables) in sorted(messages.items())]
        chapters.append("\n".join([f"## {title}\n", "| id | kind | message | remedy | table |", "| --- | --- | --- | --- | --- |",
                                   *rows]) + "\n")
    return "\n".join(chapters)


if __name__ == "__main__":
    sys.exit(write_or_check(PAGE, page, __doc__))
