"""`tailwater report`: the command line of tailwater.report.

Exit codes: 0 done, 1 a run or the answer differs (--check), 2 bad input, 3 a run failed, 4 a file cannot be read or written, 130
interrupted."""

import os
import sys
from pathlib import Path

from .command_line import Parser, exit_code_of


def parser():
    command = Parser("tailwater report")
    command.description = ("Write a dossier of a study or a run: answer with its 95 % interval, case, balances, warnings, "
                           "limits, pictures, hashes of the inputs. One printable HTML file, and the same as JSON.")
    command.epilog = ("Examples: tailwater report my_study --answer upstream; tailwater report --check my_study/dossier.html. "
                      "The first line states why the number cannot be relied on, if there is a reason.")
    command.add_argument("folder", type=Path, metavar="DIR", help="folder of a study or a run; with --check a report")
    command.add_argument("--answer", default="", metavar="PROBE[, QUANTITY]", help="result that answers the question (default: "
                         "the first one)")
    command.add_argument("--question", default="", metavar="TEXT", help="the question, as the page prints it")
    command.add_argument("--pictures", type=int, default=3, metavar="N", help="pictures of the finest run (3)")
    command.add_argument("--to", type=Path, metavar="FILE", help="page to write (DIR/dossier.html); the JSON file is beside it")
    command.add_argument("--check", action="store_true", help="repeat the runs of a report, compare them bit for bit, and "
                         "compute the answer again")
    return command


def work(options) -> int:
    import tailwater as tw  # imported late, when the path of the program is known

    if options.check:
        from .report_check import check_files, check_report, read_report

        content = read_report(options.folder)
        is_same = [check_files(options.folder), check_report(content)]
        return 0 if all(is_same) else 1
    made = tw.report(options.folder, answer=options.answer, question=options.question, pictures=options.pictures)
    page = made.write(options.to or options.folder / "dossier.html")
    print(f"{made.first_line}\ndossier: {page}, {page.with_suffix('.json').name}")
    return 0


def main(arguments=None):
    options = parser().parse_args(arguments)
    if options.program:
        os.environ["TAILWATER"] = str(options.program)
    return exit_code_of(lambda: work(options))


if __name__ == "__main__":
    sys.exit(main())
