"""Keys of a case: look them up in the tables of tomllib, write values as TOML, and change the text of a case file
without losing its comments."""

import copy
import json
import re
import tomllib

from .errors import InputError

__all__ = ["changed_text", "find", "inline", "missing", "put", "steps_of", "steps_of_table", "table_of", "text_without", "toml_value",
           "without"]

STEP = re.compile(r"([^.\[\]]+)|\[(\d+)\]")


def steps_of(key: str) -> list:
    """Splits a key: "fluid[0].max" becomes ["fluid", 0, "max"]. Throws InputError if `key` is not a key."""
    if not re.fullmatch(r"[^.\[\]]+(\[\d+\])*(\.[^.\[\]]+(\[\d+\])*)+", key):
        raise InputError(f'"{key}" is not a key of a case; write it as in "particles.spacing", "fluid[0].max" or '
                         '"probe.NAME.interval"')
    return [int(index) if index else name for name, index in STEP.findall(key)]


def steps_of_table(key: str) -> list:
    """Splits the name of a table: "probe.upstream" becomes ["probe", "upstream"], "probe[0]" becomes ["probe", 0],
    "probe" becomes ["probe"]. Throws InputError if `key` is not a table."""
    if not re.fullmatch(r"[^.\[\]]+(\[\d+\]|\.[^.\[\]]+)?", key):
        raise InputError(f'"{key}" is no table that can be deleted; write it as in "probe.NAME", "probe[0]" or "probe"')
    return [int(index) if index else name for name, index in STEP.findall(key)]


def table_of(key: str) -> str:
    """The name of the table of a key, or of a key of a table."""
    return STEP.match(key)[0]


def plain(value):
    """Converts numpy scalars, arrays and tuples to values that TOML can hold."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    return [plain(each) for each in value] if isinstance(value, (list, tuple)) else value


def toml_value(value) -> str:
    """The value as TOML text: a number, a text (also an expression), true or false, or a list of these."""
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


def inline(value) -> str:
    """The value as TOML text on one line, also for tables and lists of tables."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {inline(each)}" for key, each in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(inline, value)) + "]"
    return toml_value(value)


def child(node, step, above):
    """Descends one step. A list of tables is indexed by number or by name; the default name is "fluid1" for the first
    fluid."""
    if isinstance(node, list) and isinstance(step, str):
        for number, table in enumerate(node, 1):
            if isinstance(table, dict) and table.get("name", f"{above}{number}") == step:
                return table
        raise KeyError(step)
    return node[step]


def find(data: dict, steps: list):
    """The value that a case gives to a key. Throws KeyError or IndexError if the case does not give it."""
    node, above = data, ""
    for step in steps:
        node = child(node, step, above)
        above = step if isinstance(step, str) else above
    return node


def missing(data: dict, steps: list) -> str:
    """Words on the first part of a key that a case does not have, such as "fluid[1]; it has column"."""
    node, above, there = data, "", ""
    for step in steps:
        there += f"[{step}]" if isinstance(step, int) else f".{step}" if there else step
        try:
            node, above = child(node, step, above), step if isinstance(step, str) else above
        except (KeyError, IndexError, TypeError):
            tables = [table.get("name", f"{above}{number}") for number, table in enumerate(node, 1)
                      if isinstance(table, dict)] if isinstance(node, list) else []
            return f"{there}; it has {', '.join(tables)}" if tables else there
    return there


def put(data: dict, steps: list, value) -> dict:
    """A copy of the case with a new value. Throws KeyError or IndexError where the key cannot exist."""
    changed = copy.deepcopy(data)
    node, above = changed, ""
    for step in steps[:-1]:
        if len(steps) == 2:
            node.setdefault(step, {})
        node = child(node, step, above)
        above = step if isinstance(step, str) else above
    node[steps[-1]] = plain(value)
    return changed


def without(data: dict, steps: list) -> dict:
    """The case without one table, or without all tables of a name. Throws KeyError or IndexError if the table does not
    exist, TypeError if the entry is not a list of tables."""
    tables = data[steps[0]]
    if not isinstance(tables, list):
        raise TypeError(f'list of tables "{steps[0]}"')
    gone = tables if len(steps) == 1 else [find(data, steps)]
    return {**data, steps[0]: [table for table in tables if not any(table is each for each in gone)]}


def text_without(text: str, key: str) -> str:
    """The text of a case file without a table and the comment above it. Throws InputError as changed_text does."""
    steps = steps_of_table(key)
    data = tomllib.loads(text)
    wanted = without(data, steps)
    lines = text.splitlines(keepends=True)
    for k in reversed(range(len(data[steps[0]]))):
        if len(steps) == 2 and data[steps[0]][k] is not find(data, steps):
            continue
        first, last = lines_of_table(lines, data, [steps[0], k])
        if first is not None:
            lines[comments_begin(lines, first - 1):comments_begin(lines, last) if last < len(lines) else last] = []
    return checked_text(key, "".join(lines), {name: tables for name, tables in wanted.items() if tables != []})


def comments_begin(lines, k):
    """The index of the first comment line of the block that ends above line k; k if there is no comment."""
    while k > 0 and lines[k - 1].lstrip().startswith("#"):
        k -= 1
    return k


def checked_text(key, changed, wanted):
    """Returns the changed text if it parses to `wanted`. This fails where a value or table does not have lines of its
    own. Throws InputError then."""
    try:
        if tomllib.loads(changed) == wanted:
            return changed
    except tomllib.TOMLDecodeError:
        pass
    raise InputError(f"{key}: cannot be changed in the text of the case; remedy: change the file by hand")


def changed_text(text: str, key: str, value) -> str:
    """The text of a case file with a replaced or added value. Throws InputError where the change would affect other
    values."""
    steps = steps_of(key)
    data = tomllib.loads(text)
    wanted = put(data, steps, value)
    # The line to change holds the whole value: for "fluid[0].max[1]" the line of "fluid[0].max".
    while isinstance(steps[-1], int):
        steps = steps[:-1]
    written = toml_value(find(wanted, steps))
    return checked_text(key, with_line(text, data, steps, written), wanted)


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
    """The lines of a table without its heading, as (first, one after the last); (None, None) if the text has no such
    table."""
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
    """The comment behind a value of one line, with the blanks before it and the line ending."""
    end = "\n" if line.endswith("\n") else ""
    for mark in re.finditer(r"\s*#", line) if match else ():
        try:
            if mark.start() > match.end() and tomllib.loads("value = " + line[match.end():mark.start()]):
                return line[mark.start():]
        except tomllib.TOMLDecodeError:
            continue  # this # is inside a text
    return end
