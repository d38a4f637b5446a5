"""Keys of a case: finding them in what tomllib reads, writing values as TOML, and changing the text of a case file with
its comments kept."""

import copy
import json
import re
import tomllib

from .errors import InputError

__all__ = ["changed_text", "find", "put", "steps_of", "toml_value"]

STEP = re.compile(r"([^.\[\]]+)|\[(\d+)\]")


def steps_of(key: str) -> list:
    """"fluid[0].max" as ["fluid", 0, "max"]. Throws InputError for what is no key."""
    if not re.fullmatch(r"[^.\[\]]+(\[\d+\])*(\.[^.\[\]]+(\[\d+\])*)+", key):
        raise InputError(f'"{key}" is not a key of a case; write it as in "particles.spacing", "fluid[0].max" or '
                         '"probe.NAME.interval"')
    return [int(index) if index else name for name, index in STEP.findall(key)]


def plain(value):
    """Of numpy's and Python's, what TOML knows."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    return [plain(each) for each in value] if isinstance(value, (list, tuple)) else value


def toml_value(value) -> str:
    """As it stands in a case file: a number, a text (an expression, too), true or false, or a list of these."""
    value = plain(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, (int, float)):
        return repr(value)
    raise InputError(f"{value!r}: a case has numbers, texts, true and false, and lists of them")


def child(node, step, above):
    """One step down. Of a list of tables one is asked for by its number or its name, "fluid1" by default."""
    if isinstance(node, list) and isinstance(step, str):
        for number, table in enumerate(node, 1):
            if isinstance(table, dict) and table.get("name", f"{above}{number}") == step:
                return table
        raise KeyError(step)
    return node[step]


def find(data: dict, steps: list):
    """The value that a case gives to a key. Throws KeyError or IndexError if it gives none."""
    node, above = data, ""
    for step in steps:
        node = child(node, step, above)
        above = step if isinstance(step, str) else above
    return node


def put(data: dict, steps: list, value) -> dict:
    """The case with this value. Throws KeyError or IndexError where no key can be."""
    changed = copy.deepcopy(data)
    node, above = changed, ""
    for step in steps[:-1]:
        if isinstance(node, dict):
            node.setdefault(step, {})
        node = child(node, step, above)
        above = step if isinstance(step, str) else above
    node[steps[-1]] = plain(value)
    return changed


def changed_text(text: str, key: str, value) -> str:
    """The text of a case file with a value put in the place of another, or in a line of its own. Throws InputError
    where the text is written so that this would change more."""
    steps = steps_of(key)
    data = tomllib.loads(text)
    wanted = put(data, steps, value)
    # The line that changes has the whole value: of "fluid[0].max[1]" that of "fluid[0].max".
    while isinstance(steps[-1], int):
        steps = steps[:-1]
    written = toml_value(find(wanted, steps))
    changed = with_line(text, data, steps, written)
    try:
        if tomllib.loads(changed) == wanted:
            return changed
    except tomllib.TOMLDecodeError:
        pass  # as for any text in which the value does not stand in a line of its own
    raise InputError(f"{key}: cannot be changed in the text of the case; remedy: change the file by hand")


def with_line(text, data, steps, written):
    lines = text.splitlines(keepends=True)
    first, last = lines_of_table(lines, data, steps[:-1])
    if first is None:
        return text.rstrip("\n") + f"\n\n[{'.'.join(steps[:-1])}]\n{steps[-1]} = {written}\n"
    head = re.compile(rf"\s*{re.escape(steps[-1])}\s*=\s*")
    for k in range(first, last):
        match = head.match(lines[k])
        if match:
            end = end_of_value(lines, k, match.end())
            comment = comment_after(lines[end - 1], match if end == k + 1 else None)
            return "".join([*lines[:k], match.group() + written + comment, *lines[end:]])
    return "".join([*lines[:first], f"{steps[-1]} = {written}\n", *lines[first:]])


def lines_of_table(lines, data, steps):
    """Of the table, without its heading, as (first, one after the last); (None, None) if the text has none."""
    name = steps[0]
    number = 0
    if len(steps) > 1:
        table = find(data, steps)
        number = next(k for k, each in enumerate(data[name]) if each is table)
    heads = [k for k, line in enumerate(lines) if re.match(r"\s*\[\[?\s*[A-Za-z_]\w*\s*\]\]?\s*(#.*)?$", line)]
    mine = [k for k in heads if re.match(rf"\s*\[\[?\s*{re.escape(name)}\s*\]", lines[k])]
    if number >= len(mine):
        return None, None
    start = mine[number]
    return start + 1, next((k for k in heads if k > start), len(lines))


def end_of_value(lines, k, begin):
    """One after the last line of the value that begins in line k."""
    value = lines[k][begin:]
    for end in range(k + 1, len(lines) + 1):
        try:
            tomllib.loads("value = " + value)
            return end
        except tomllib.TOMLDecodeError:
            value += lines[end] if end < len(lines) else ""
    raise InputError(f"line {k + 1}: its value does not end")


def comment_after(line, match):
    """The comment behind a value of one line, with the blanks before it and the line's end."""
    end = "\n" if line.endswith("\n") else ""
    for mark in re.finditer(r"\s*#", line) if match else ():
        try:
            if mark.start() > match.end() and tomllib.loads("value = " + line[match.end():mark.start()]):
                return line[mark.start():]
        except tomllib.TOMLDecodeError:
            continue  # this # is inside a text
    return end
