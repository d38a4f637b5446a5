"""Mutated case files: `tailwater check` must return an exit code for each, and name the place of errors.

With --run, `tailwater run` must do the same or begin to compute.

The mutations (case_mutator.py) use every table and key of the program's own reference, the files that a case may name,
and expressions. They start from the cases in the tree, at a coarse spacing, so that a check takes a fraction of a
second. To run a campaign:

    TAILWATER=build/release/bin/tailwater /usr/bin/python3 -B tests/app/fuzz_cases.py --count 10000 --seed 1

It prints how many cases were valid, refused and so on, and keeps each file with a finding in --keep. --first continues
a campaign in parts.
"""

import functools
import json
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import fuzzing
from case_mutator import Mutator

TREE = pathlib.Path(__file__).resolve().parents[2]

COUNT_IN_SUITE = 100

# Spacings that give a case some hundred particles.
COARSE = {"janosi2004": 0.02, "martin_moyce1952": 0.008, "ozmen_cagatay2014": 0.05, "soares_frazao2002": 0.05,
          "zhou1999": 0.1, "tank": 0.1}


def seeds():
    """The cases in the tree as lists of lines."""
    found = []
    for path in sorted([*TREE.glob("cases/**/*.toml"), *TREE.glob("src/app/templates/*.toml"),
                        *TREE.glob("tests/fuzz/corpus/case/*.toml")]):
        spacing = COARSE.get(path.parent.name, 0.1 if path.name in ("dam-break.toml", "tank.toml") else None)
        lines = re.sub(r'"data/[^"]*\.csv"', '"gauge.csv"', path.read_text()).splitlines()
        if spacing:
            lines = [re.sub(r"^spacing = .*", f"spacing = {spacing}", line) for line in lines]
        found.append([line for line in lines if line.strip() and not line.startswith("#")])
    return found


# Words that messages use for remedies.
REMEDY = re.compile(
    r"\b(give|gives|giving|add|remove|write|use|move|moving|correct|choose|draw|put|let|close|complete|keep|name|make|start|"
    r"did you mean|valid|remedy|at least|at most|export|exchange|lower|higher|larger|smaller|fewer|begin|lift|leave|need|"
    r"needs|check|unite|split|turn|reverse|raise|belongs|several|slower|increase|shorten|without a unit|correct it|must|"
    r"takes|allowed|end|say|change|begins|brings the file up to date)\b")


LONGEST_LINE = 2100


def look_for_findings(code, error):
    """The fault of an answer of `check`, or None."""
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
        if line.startswith("error") and not REMEDY.search(line) and "more problems" not in line:
            return "a message without a remedy"
        if len(line) > LONGEST_LINE:
            return "a message without an end"
    return None


def check_one(folder, number):
    """(exit code, standard error, finding) of `check`, which draws every fourth case."""
    before = {path.name for path in folder.iterdir()}
    code, error = fuzzing.run_within_limits(["check", "case.toml", *(["--no-preview"] if number % 4 else [])], folder)
    finding = look_for_findings(code, error)
    files = {path.name for path in folder.iterdir()} - before - {"case.preview.svg", "case.preview.png"}
    if finding is None and files:
        finding = f"check has written {files}"
    return code, error, finding


def run_for_a_moment(folder, _number):
    """(exit code, standard error, finding) of `run`, which may also stop early (130) or fail at a step (3)."""
    code, error = fuzzing.run_within_limits(["run", "case.toml", "--out", "run", "--quiet", "--wall-time", "1s"], folder)
    finding = fuzzing.look_for_findings(code, error, (0, 2, 3, 130)) if code != 2 else look_for_findings(code, error)
    if finding is None and code == 2 and (folder / "run").exists():
        finding = "a case that is refused has written"
    if finding is None and code == 3 and not (folder / "run/failure/report.txt").exists():
        finding = "a run that has failed without a report"
    return code, error, finding


def run_one(number, seed, keep, cases, mutator, answer):
    """(exit code, finding)."""
    rng = random.Random(f"{seed} {number}")
    lines = list(rng.choice(cases))
    files = mutator.mutated(rng, lines)
    files["case.toml"] = "\n".join(lines) + "\n"
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for name, text in files.items():
            (folder / name).write_text(text, encoding="utf-8", errors="surrogateescape")
        code, error, finding = answer(folder, number)
        if finding and keep:
            kept = keep / f"{seed}-{number}"
            shutil.copytree(folder, kept, dirs_exist_ok=True)
            (kept / "finding.txt").write_text(f"{finding}; exit code {code}\n{error}")
    return code, finding


def campaign_of(answer):
    """The campaign for `fuzzing`: a function of number, seed and folder for findings."""
    reference = json.loads(subprocess.run([fuzzing.PROGRAM, "run", "--help-case=json"], capture_output=True, check=True).stdout)
    return functools.partial(run_one, cases=seeds(), mutator=Mutator(reference), answer=answer)


class MutatedCases(unittest.TestCase):
    def test_each_is_answered(self):
        codes, findings = fuzzing.campaign(campaign_of(check_one), range(COUNT_IN_SUITE), "suite", workers=2)
        self.assertEqual(findings, [])
        self.assertGreater(codes[0], 0, "some mutations are harmless")
        self.assertGreater(codes[2], COUNT_IN_SUITE / 4)


def main():
    parser = fuzzing.arguments(__doc__)
    parser.add_argument("--run", action="store_true", help="run each case for a second instead of checking it")
    options = parser.parse_args()
    answer = run_for_a_moment if options.run else check_one
    return fuzzing.main(options, campaign_of(answer))


if __name__ == "__main__":
    sys.exit(main())
