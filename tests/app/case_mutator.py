"""Mutations of case files by the program's own reference of all tables and keys, and the files that a case may name.

`Mutator(reference)` takes the output of `tailwater run --help-case=json`; `mutated(rng, lines)` changes the lines of a
case and returns the files that lie beside it.
"""

import contextlib
import re

NUMBERS = ("0", "-1", "1", "-0.0", "1e308", "-1e308", "1e-308", "1e15", "1e-15", "nan", "inf", "-inf", "1e9", "3.7",
           "9223372036854775807", "-9223372036854775808", "0x7f", "1e400", "0.1", "2", "1e3")
EXPRESSIONS = ('""', '"dx"', '"1/0"', '"sqrt(-1)"', '"2*"', '"((("', '"a*b"', '"t"', '"x+y"', '"sin(100*t)"', '"1e300*t"',
               '"t<0.05 ? 0 : 1"', '"min(1)"', '"2,3"', '"dx^-9"', '"rnd"', '"' + "(" * 300 + '"', '"g/0"', '"x/0"')
OTHERS = ("true", "[]", "{}", '"text"', "1979-05-27", "[[]]", "[[[1]]]", "{a = 1}", '"\\u0000"', "'''\n'''", "[0, 0]",
          "[0, 0, 0]", "[1e15, 1e15]", '["dx", "t"]', '"inside"', '"outside"', '"box"', '"polygon"', '"implicit"',
          '"published"', '"farmani2020"', '"no-slip"')
KEY = re.compile(r"^(\s*)([\w.]+)(\s*=\s*)(.*)$")
NUMBER = re.compile(r"(?<![\w.])-?\d+\.?\d*(?:[eE][-+]?\d+)?")


def change_value(lines, rng):
    at = rng.choice([k for k, line in enumerate(lines) if KEY.match(line)])
    lines[at] = KEY.sub(lambda m: m[1] + m[2] + m[3] + some_value(rng), lines[at])


def change_number(lines, rng):
    at = rng.choice([k for k, line in enumerate(lines) if NUMBER.search(line)])
    numbers = list(NUMBER.finditer(lines[at]))
    one = rng.choice(numbers)
    factor = rng.choice((-1, 0, 0.5, 1.01, 2, 10))
    new = rng.choice((rng.choice(NUMBERS), repr(float(one[0]) * factor)))
    lines[at] = lines[at][:one.start()] + new + lines[at][one.end():]


def drop_line(lines, rng):
    del lines[rng.randrange(len(lines))]


def double_line(lines, rng):
    lines.insert(rng.randrange(len(lines)), rng.choice(lines))


def double_table(lines, rng):
    heads = [k for k, line in enumerate(lines) if line.startswith("[")] + [len(lines)]
    k = rng.randrange(len(heads) - 1)
    copied = lines[heads[k]:heads[k + 1]]
    if rng.random() < 0.5:
        copied = [line for line in copied if not line.startswith("name")]
    lines.extend(copied * rng.choice((1, 1, 1, 30)))


def change_bytes(lines, rng):
    at = rng.randrange(len(lines))
    text = list(lines[at])
    for _ in range(rng.choice((1, 1, 3))):
        text.insert(rng.randrange(len(text) + 1), rng.choice("[]{}=,.\"'#\\\n\t-+*e9(\x00é"))
    lines[at] = "".join(text)


def cut_off(lines, rng):
    text = "\n".join(lines)
    lines[:] = text[:rng.randrange(len(text))].splitlines() or [""]


def blow_up(lines, rng):
    k = rng.choice((10, 1000, 20000))
    lines.append(rng.choice(("a" + ".a" * k + " = 1", "a = " + "[" * k, "a = " + "{a=" * k, "[" + "a." * k + "a]",
                             "[parameters]\n" + "\n".join(f'p{i} = "p{i + 1}"' for i in range(k)),
                             "[[fluid]]\n" * k, 'title = "' + "x" * k + '"')))


# Mutations that use only the syntax of a line of TOML.
BLIND = (*[change_value] * 4, *[change_number] * 5, drop_line, double_line, double_table, change_bytes, cut_off, blow_up)


# Files beside a case, by name; each is also used in a damaged form.
FILES = {
    "bed.csv": "station [m],elevation [m]\n0,2\n0,0\n1,0.2\n2,0\n3,0\n3,2\n",
    "roll.csv": "t [s],x [mm],angle [deg]\n0,0,0\n0.1,5,0.5\n0.2,0,0\n1000,0,0\n",
    "way.csv": "t [s],displacement [mm]\n0,0\n0.1,5\n1000,300\n",
    "flood.csv": "t [s],discharge [l/s]\n0,10\n5,20\n1000,20\n",
    "tide.csv": "t [s],level [m]\n0,0.4\n5,0.45\n1000,0.4\n",
    "gauge.csv": "t [s],value\n0,0.5\n0.1,0.498\n5,0.4\n",
    "body.obj": "v 1 1 0.1\nv 2 1 0.1\nv 1 2 0.1\nv 1 1 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
    "sheet.obj": "v 0.8 0 0\nv 0.8 1 0\nv 0.8 1 1\nv 0.8 0 1\nf 1 2 3\nf 1 3 4\n",
    "slope.obj": "v -1 -1 -0.0078125\nv 5 -1 0.3671875\nv 5 2 0.3671875\nv -1 2 -0.0078125\nf 1 2 3\nf 1 3 4\n",
    "chamfer.obj": "".join(f"v {x} {y} {z}\n" for x in (0, 1000) for y, z in (
        (150, 0), (450, 0), (600, 150), (600, 450), (450, 600), (150, 600), (0, 450), (0, 150))) +
        "f 8 7 6 5 4 3 2 1\nf 9 10 11 12 13 14 15 16\n" +
        "".join(f"f {k} {k % 8 + 1} {k % 8 + 9} {k + 8}\n" for k in range(1, 9)),
    "ground.stl": "solid g\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 3 0 0\nvertex 0 3 0\nendloop\nendfacet\n"
                  "facet normal 0 0 1\nouter loop\nvertex 3 0 0\nvertex 3 3 0\nvertex 0 3 0\nendloop\nendfacet\nendsolid g\n",
}
TABLES_OF_NUMBERS = [name for name in FILES if name.endswith(".csv")]
MESHES = [name for name in FILES if not name.endswith(".csv")]
HEADING = re.compile(r"^\[+([\w.]+)\]+")
NAME = re.compile(r'^name = "([^"]*)"')


def some_value(rng):
    return rng.choice(rng.choice((NUMBERS, EXPRESSIONS, OTHERS)))


def shown(number):
    return f"{number:.4g}"


def damaged(text, rng):
    """A file with one error in it."""
    lines = text.splitlines()
    at = rng.randrange(len(lines))
    kind = rng.randrange(7)
    if kind == 0:
        del lines[at]
    elif kind == 1:
        lines.insert(at, lines[at])
    elif kind == 2:
        lines[at] = NUMBER.sub(lambda _: rng.choice(NUMBERS), lines[at], count=rng.choice((1, 2, 9)))
    elif kind == 3:
        lines[at] = lines[at].replace(",", rng.choice((";", " ", ",,", "\t", ".")))
    elif kind == 4:
        lines[at] = lines[at].replace(".", ",")
    elif kind == 5:
        lines[at] += rng.choice((",1", " 1", "\x00", "\xe9", "\x1b[2J", " #"))
    else:
        lines = lines[:at] or [""]
    return "\n".join(lines) + rng.choice(("\n", "\n", ""))


class Mutator:
    def __init__(self, reference):
        self.tables = {table["name"]: table for table in reference["tables"]}
        self.keys = sorted({key["name"] for table in reference["tables"] for key in table["keys"]})

    # Values that usually fit a key

    def number(self, key, rng):
        low, high = key.get("minimum"), key.get("maximum")
        edge = [value for value in (low, high) if value is not None]
        if edge and rng.random() < 0.2:
            return shown(rng.choice(edge) + rng.choice((0, 0, 1e-9, -1e-9, 1e-15)))
        if isinstance(key["default"], (int, float)) and rng.random() < 0.2:
            return shown(key["default"] * rng.choice((0.5, 1, 2)))
        value = rng.choice((0.02, 0.05, 0.1, 0.3, 0.5, 1, 2, 10, 1000))
        if low is not None and high is not None:
            value = low + rng.random() * (high - low)
        if key["type"] == "whole number":
            return str(round(value))
        return rng.choice((shown(value), f'"{shown(value)}*dx/dx"'))

    def varying(self, key, rng):
        value = self.number(key, rng)
        variable = key["variables"][0]
        forms = (value, f'"{value.strip(chr(34))}*sin({variable})"', f'"min({value.strip(chr(34))}, {variable})"',
                 f'"{variable} < 0.1 ? 0 : {variable}"', f'"0.01*{variable}^2"')
        return rng.choice(forms)

    def text(self, key, names, rng):
        name = key["name"]
        if name in ("file", "points_file", "motion"):
            return rng.choice(TABLES_OF_NUMBERS + MESHES + ["", "nowhere.csv", "."])
        if name in ("body", "water_from", "probe"):
            return rng.choice(names or ["nobody"])
        return rng.choice(("tank", "water", "in", "out", "a b", "", "-x", "p" * 101, "\\u001b[1m"))

    def value(self, key, dimension, names, rng):
        """A value of the type of a key as TOML, sometimes of another type."""
        if rng.random() < 0.08:
            return some_value(rng)
        coordinate = lambda: shown(rng.choice((0, 0, 0.1, 0.3, 0.5, 0.8, 1, 1.2, 2, 3, -0.1)))
        point = lambda: "[" + ", ".join(coordinate() for _ in range(dimension)) + "]"
        kind = key["type"]
        if kind in ("number", "whole number"):
            return self.number(key, rng)
        if kind == "choice":
            return f'"{rng.choice(key["choices"])}"'
        if kind == "vector":
            return point()
        if kind == "points":
            return "[" + ", ".join(point() for _ in range(rng.choice((2, 2, 3, 4, 4, 6)))) + "]"
        if kind == "numbers":
            return "[" + ", ".join(sorted(coordinate() for _ in range(rng.choice((1, 2, 2, 3))))) + "]"
        if kind == "texts":
            pool = key.get("choices") or names or ["tank"]
            return "[" + ", ".join(f'"{name}"' for name in rng.sample(pool, min(len(pool), rng.choice((1, 1, 2))))) + "]"
        if kind == "varying number":
            return self.varying(key, rng)
        if kind == "varying vector":
            return "[" + ", ".join(self.varying(key, rng) for _ in range(dimension)) + "]"
        return f'"{self.text(key, names, rng)}"'

    # Mutations; each changes `lines` in place

    def table_at(self, lines, at):
        """The table of the reference that a line belongs to; None if it belongs to none."""
        for line in reversed(lines[:at + 1]):
            if match := HEADING.match(line):
                return self.tables.get(match[1])
        return None

    def about(self, lines):
        dimension = 3 if any(re.match(r"(case\.)?dimension\s*=\s*3", line) for line in lines) else 2
        return dimension, [match[1] for line in lines if (match := NAME.match(line))]

    def set_key(self, lines, rng):
        """Gives a key of the case another value of the key's type."""
        places = [k for k, line in enumerate(lines) if KEY.match(line) and not HEADING.match(line)]
        at = rng.choice(places)
        name = KEY.match(lines[at])[2]
        table = self.table_at(lines, at)
        keys = [key for key in (table or {"keys": []})["keys"] if key["name"] == name]
        if keys:
            lines[at] = f"{name} = {self.value(keys[0], *self.about(lines), rng)}"

    def add_key(self, lines, rng):
        """Adds a key that the table of some line may have."""
        at = rng.randrange(len(lines))
        table = self.table_at(lines, at)
        if table and table["keys"]:
            key = rng.choice(table["keys"])
            lines.insert(at + 1, f'{key["name"]} = {self.value(key, *self.about(lines), rng)}')

    def add_table(self, lines, rng):
        """Adds a table with its required keys and some optional ones."""
        table = rng.choice([table for table in self.tables.values() if table["keys"]])
        dimension, names = self.about(lines)
        lines.append(f'[[{table["name"]}]]' if table["is_list"] else f'[{table["name"]}]')
        chosen = {}
        for key in table["keys"]:
            uses = key.get("goes_with")
            choice = chosen.get(uses["key"]) if uses else None
            is_needed = key["required"] or (uses and choice in uses.get("needed_by", []))
            may_be = not uses or choice in uses["choices"]
            if is_needed or (may_be and rng.random() < 0.15) or rng.random() < 0.01:
                value = self.value(key, dimension, names, rng)
                lines.append(f'{key["name"]} = {value}')
            elif key["type"] == "choice":
                value = f'"{rng.choice(key["choices"])}"' if rng.random() < 0.5 else f'"{key["default"]}"'
                lines.append(f'{key["name"]} = {value}')
            else:
                continue
            chosen[key["name"]] = value.strip('"')

    def link_file(self, lines, rng):
        """Adds a file that may take the place of points or expressions."""
        at = rng.randrange(len(lines))
        key, names = rng.choice((("points_file", ["bed.csv"]), ("motion", ["roll.csv"]), ("file", list(FILES))))
        lines.insert(at + 1, f'{key} = "{rng.choice(names)}"')

    def change_key(self, lines, rng):
        at = rng.choice([k for k, line in enumerate(lines) if KEY.match(line)])
        lines[at] = KEY.sub(lambda m: m[1] + rng.choice(self.keys) + m[3] + m[4], lines[at])

    def mutated(self, rng, lines):
        """Changes the lines of a case. Returns the files beside it; one of them may be damaged."""
        known = (self.set_key, self.set_key, self.set_key, self.add_key, self.add_key, self.add_table, self.link_file,
                 self.change_key)
        for _ in range(rng.choice((1, 1, 1, 2, 2, 3, 5))):
            with contextlib.suppress(IndexError, ValueError):  # the lines to change may be missing
                rng.choice(rng.choice((known, BLIND)))(lines, rng)
        files = dict(FILES)
        if rng.random() < 0.25:
            name = rng.choice(list(files))
            files[name] = damaged(files[name], rng)
        return files
