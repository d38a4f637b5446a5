"""Numbers of a run that you have made of one of the cases, by name, as JSON. The functions that find them explain them.

Usage: python -m tailwater_validation.score CASE RUN_DIR
Exit codes: 0 done, 2 there is no such case, 4 the run cannot be read or lacks data.
"""

import argparse
import json
import sys

from tailwater.command_line import complain
from tailwater.errors import DataError
from tailwater.run import Run

from .exact_flows import FLOWS
from .studies import LABORATORIES


def numbers(laboratory, run):
    """{name: number, or the reason why there is none} of a laboratory's module."""
    return {metric.name: metric.note if metric.value is None else metric.value for metric in laboratory.metrics(run)}


def main(arguments=None):
    laboratories = {module.__name__.rpartition(".")[2]: module for module in LABORATORIES}
    parser = argparse.ArgumentParser(prog="tailwater_validation.score", description=__doc__.partition("\n\n")[0])
    parser.add_argument("case", choices=[*laboratories, *FLOWS])
    parser.add_argument("run", metavar="RUN_DIR", help="the folder that the run wrote")
    options = parser.parse_args(arguments)
    try:
        run = Run(options.run)
        found = FLOWS[options.case](run) if options.case in FLOWS else numbers(laboratories[options.case], run)
    except DataError as error:
        return complain(error, 4)
    print(json.dumps(found, indent=2))
    return 0


if __name__ == "__main__":
    sys.exit(main())
