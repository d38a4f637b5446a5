"""`tailwater study`: the command line of tailwater.study.

Exit codes: 0 done, 2 bad input, 3 a run failed, 4 a file cannot be read or written, 130 interrupted."""

import argparse
import math
import os
import re
import sys
import tomllib

from .command_line import Parser, exit_code_of

UNITS = {"": 1, "s": 1, "min": 60, "h": 3600}


def seconds(text):
    match = re.fullmatch(r"\s*([0-9.eE+]+)\s*(s|min|h|)\s*", text)
    try:
        value = float(match[1]) * UNITS[match[2]]
    except (TypeError, ValueError):
        value = math.nan
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f'"{text}" is no time; write it as in 90, 20min or 1.5h')
    return value


def numbers(text):
    try:
        return [float(one) for one in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f'"{text}" are no spacings; write them as in 0.02,0.016,0.0125') from None


def count(text):
    try:
        value = int(text)
    except ValueError:
        value = -1
    if value < 0:
        raise argparse.ArgumentTypeError(f'"{text}" is no count; give 0 or more')
    return value


def change(text):
    """Splits KEY=VALUE: the value is as in a case file, or a text or an expression without quotes."""
    key, equals, value = text.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f'"{text}" has no "="; write it as in particles.spacing=0.01')
    try:
        return key, tomllib.loads(f"value = {value}")["value"]
    except tomllib.TOMLDecodeError:
        return key, value


def parser():
    command = Parser("tailwater study")
    command.description = ("Estimate the numerical uncertainty of each probe result: value, extrapolated limit with its "
                           "interval, and observed order (docs/theory/uncertainty.md). The case is run at several "
                           "spacings, from perturbed initial conditions, and with half the time step.")
    command.epilog = ("Repeat the command to continue a study. The table is written to DIR/study.csv, study.json and "
                      "study.txt. Example: tailwater study my.toml --out my_study --budget 20min --jobs 2")
    command.add_argument("case", help="case file")
    command.add_argument("--out", required=True, metavar="DIR", help="folder of the study")
    command.add_argument("--set", action="append", type=change, default=[], metavar="KEY=VALUE",
                         help="override a key; may be repeated")
    command.add_argument("--spacings", type=numbers, metavar="M,M,M", help="three or more spacings, m (default: seven, "
                         "from twice the spacing of the case down to that spacing)")
    command.add_argument("--budget", type=seconds, metavar="TIME", help="computing time, for example 90, 20min or "
                         "1.5h; the finest spacing is chosen to fit")
    command.add_argument("--starts", type=count, default=3, metavar="N", help="runs from perturbed initial conditions (3)")
    command.add_argument("--jobs", type=count, default=1, metavar="N", help="runs at the same time (1)")
    command.add_argument("-n", dest="ranks", type=count, default=1, metavar="N", help="ranks per run (1)")
    command.add_argument("--quiet", action="store_true", help="print no progress")
    return command


def main():
    options = parser().parse_args()
    if options.program:
        os.environ["TAILWATER"] = str(options.program)
    import tailwater as tw  # imported late, when the path of the program is known

    def work():
        case = tw.Case(options.case)
        case.update(dict(options.set))
        found = tw.study(case, out=options.out, spacings=options.spacings, budget=options.budget, starts=options.starts,
                         jobs=options.jobs, ranks=options.ranks, progress=not options.quiet)
        print(found.text(), end="")

    return exit_code_of(work, code_of_data=3)


if __name__ == "__main__":
    sys.exit(main())
