"""Mutated case files: `tailwater check` must answer each with an exit code and, where it refuses one, with the place.
With --run, `tailwater run` must do that too, or begin to compute.

The mutations know what a case file is made of (tables, keys, values, lists, expressions), because random bytes would
not get beyond the parser of TOML. They begin with the cases in the tree, made coarse, so that a check takes a fraction
of a second. By hand:

    TAILWATER=build/release/bin/tailwater /usr/bin/python3 -B tests/app/fuzz_cases.py --count 10000 --seed 1

prints how many cases were valid, refused and so on, and keeps each file that provoked a finding in --keep. A
campaign can be made in pieces, by --first.
"""

import contextlib
import functools
import pathlib
import random
import re
import sys
import tempfile
import unittest

import fuzzing

TREE = pathlib.Path(__file__).resolve().parents[2]

COUNT_IN_SUITE = 30

# What a case is made coarser by, so that it has some hundred particles.
COARSE = {"janosi2004": 0.02, "martin_moyce1952": 0.008, "ozmen_cagatay2014": 0.05, "soares_frazao2002": 0.05,
          "zhou1999": 0.1, "tank": 0.1}

NUMBERS = ("0", "-1", "1", "-0.0", "1e308", "-1e308", "1e-308", "1e15", "1e-15", "nan", "inf", "-inf", "1e9", "3.7",
           "9223372036854775807", "-9223372036854775808", "0x7f", "1e400", "0.1", "2", "1e3")
EXPRESSIONS = ('""', '"dx"', '"1/0"', '"sqrt(-1)"', '"2*"', '"((("', '"a*b"', '"t"', '"x+y"', '"sin(100*t)"', '"1e300*t"',
               '"t<0.05 ? 0 : 1"', '"min(1)"', '"2,3"', '"dx^-9"', '"rnd"', '"' + "(" * 300 + '"', '"g/0"', '"x/0"')
OTHERS = ("true", "[]", "{}", '"text"', "1979-05-27", "[[]]", "[[[1]]]", "{a = 1}", '"\\u0000"', "'''\n'''", "[0, 0]",
          "[0, 0, 0]", "[1e15, 1e15]", '["dx", "t"]', '"inside"', '"outside"', '"box"', '"polygon"', '"implicit"',
          '"published"', '"farmani2020"', '"no-slip"')
NAMES = ("spacing", "points", "min", "max", "displacement", "rotation", "pivot", "at", "from", "to", "times", "interval",
         "velocity", "shape", "fluid_side", "open", "end", "dimension", "gravity", "walls", "support", "formulation",
         "periodic_x", "periodic_y", "name", "type", "a.b.c", "jitter", "slip", "direction", "integrator", "scheme",
         "motion", "speed", "side", "waves", "height", "period", "depth", "strength", "axis")
TABLES = ("[[wall]]", "[[fluid]]", "[[probe]]", "[[outlet]]", "[[gate]]", "[[wave_maker]]", "[[damping]]", "[scheme]", "[physics]", "[domain]", "[output]", "[time]",
          "[parameters]", "[pressure_solver]", "[nothing]", "[case]")
KEY = re.compile(r"^(\s*)([\w.]+)(\s*=\s*)(.*)$")
NUMBER = re.compile(r"(?<![\w.])-?\d+\.?\d*(?:[eE][-+]?\d+)?")


def seeds():
    """The cases in the tree as lists of lines."""
    found = []
    for path in sorted([*TREE.glob("cases/**/*.toml"), *TREE.glob("src/app/templates/*.toml")]):
        spacing = COARSE.get(path.parent.name, 0.1 if path.name in ("dam-break.toml", "tank.toml") else None)
        lines = path.read_text().splitlines()
        if spacing:
            lines = [re.sub(r"^spacing = .*", f"spacing = {spacing}", line) for line in lines]
        found.append([line for line in lines if line.strip() and not line.startswith("#")])
    return found


def some_value(rng):
    return rng.choice(rng.choice((NUMBERS, EXPRESSIONS, OTHERS)))


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


def change_key(lines, rng):
    at = rng.choice([k for k, line in enumerate(lines) if KEY.match(line)])
    lines[at] = KEY.sub(lambda m: m[1] + rng.choice(NAMES) + m[3] + m[4], lines[at])


def add_key(lines, rng):
    lines.insert(rng.randrange(1, len(lines) + 1), f"{rng.choice(NAMES)} = {some_value(rng)}")


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


def add_table(lines, rng):
    lines.extend([rng.choice(TABLES), f"{rng.choice(NAMES)} = {some_value(rng)}"])


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


MUTATIONS = (*[change_value] * 5, *[change_number] * 6, change_key, *[add_key] * 2, drop_line, double_line, double_table,
             add_table, change_bytes, cut_off, blow_up)


def mutated(number, seed, cases):
    rng = random.Random(f"{seed} {number}")
    lines = list(rng.choice(cases))
    for _ in range(rng.choice((1, 1, 1, 2, 2, 3, 5))):
        with contextlib.suppress(IndexError, ValueError):  # what it would change is not there any more
            rng.choice(MUTATIONS)(lines, rng)
    return "\n".join(lines) + "\n"


def look_for_findings(code, error):
    """What is wrong with the answer of `check`; nothing, if it is as it should be."""
    finding = fuzzing.look_for_findings(code, error, (0, 2, 3))
    if finding:
        return finding
    for line in error.splitlines():
        if not re.match(r"(error|warning): case\.toml", line):
            return "a message without a place"
        if code == 2 and not re.match(r"(error|warning): case\.toml:(\d+(:\d+)?: |.* (is missing|there is no fluid|more problems|has \d+ bytes))",
                                      line):
            return "a message without a line or a key"
        if re.search(r"\binf\b|\bnan\b", re.sub(r" = (\S+|\"[^\"]*\"):| = .*?: ", "", line)) and code == 2:
            if "not a finite number" not in line and "its value is" not in line and "valid: " not in line and "not valid TOML" not in line:
                return "a message with a number that is none"
    return None


def check_one(folder):
    """(exit code, standard error, finding) of `check`."""
    code, error = fuzzing.run_within_limits(["check", "case.toml"], folder)
    finding = look_for_findings(code, error)
    files = {path.name for path in folder.iterdir()} - {"case.toml", "case.preview.svg", "case.preview.png"}
    if finding is None and files:
        finding = f"check has written {files}"
    return code, error, finding


def run_for_a_moment(folder):
    """The same of `run`, which may also be stopped on its way (130) or fail at a step (3)."""
    code, error = fuzzing.run_within_limits(["run", "case.toml", "--out", "run", "--quiet", "--wall-time", "1s"], folder)
    finding = fuzzing.look_for_findings(code, error, (0, 2, 3, 130)) if code != 2 else look_for_findings(code, error)
    if finding is None and code == 2 and (folder / "run").exists():
        finding = "a case that is refused has written"
    if finding is None and code == 3 and not (folder / "run/failure/report.txt").exists():
        finding = "a run that has failed without a report"
    return code, error, finding


def run_one(number, seed, keep, cases, answer):
    """(exit code, finding)."""
    text = mutated(number, seed, cases)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "case.toml").write_text(text, errors="surrogateescape")
        code, error, finding = answer(folder)
    if finding and keep:
        (keep / f"{seed}-{number}.toml").write_text(f"{text}\n# {finding}; exit code {code}\n" +
                                                    "".join(f"# {line}\n" for line in error.splitlines()))
    return code, finding


class MutatedCases(unittest.TestCase):
    def test_each_is_answered(self):
        codes, findings = fuzzing.campaign(functools.partial(run_one, cases=seeds(), answer=check_one),
                                           range(COUNT_IN_SUITE), "suite")
        self.assertEqual(findings, [])
        self.assertGreater(codes[0], 0, "some mutations are harmless")
        self.assertGreater(codes[2], COUNT_IN_SUITE / 4)


def main():
    parser = fuzzing.arguments(__doc__)
    parser.add_argument("--run", action="store_true", help="run each case for a second instead of checking it")
    options = parser.parse_args()
    answer = run_for_a_moment if options.run else check_one
    return fuzzing.main(options, functools.partial(run_one, cases=seeds(), answer=answer))


if __name__ == "__main__":
    sys.exit(main())
