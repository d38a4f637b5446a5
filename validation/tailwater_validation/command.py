"""Options, error messages and order of work, common to all commands that make and score runs."""

import difflib
import signal
import sys
from pathlib import Path

from tailwater.command_line import Parser, complain
from tailwater.errors import DataError, IoError

from .checks import runs_of
from .runs import INTERRUPTED, Program, duration, make, outcome, require_accepted


class OutParser(Parser):
    """Options of commands that make runs with the program and write results to a folder."""

    def __init__(self, prog, what, out):
        super().__init__(prog, needs_program=True, description=what)
        self.add_argument("--out", type=Path, default=Path(out), metavar="DIR",
                          help=f"folder for runs and results ({out})")


class RunsParser(OutParser):
    """Options of commands that make each run once, several at a time, and keep it."""

    def __init__(self, prog, what, out, jobs, jobs_text=None):
        super().__init__(prog, what, out)
        self.epilog = "Finished runs are not repeated. Missed targets do not change the exit code."
        self.set_defaults(ranks=1, settings=[])
        self.add_argument("--jobs", type=int, default=jobs, metavar="N", help=f"runs at the same time ({jobs_text or jobs})")
        self.add_argument("--list", action="store_true", help="list the runs with estimated times, and exit")


def choose(every, names, kind, option=""):
    """The named groups of {name: group} in the order of that dict; all groups if no name is given. Throws DataError
    for an unknown name."""
    for name in names:
        if name not in every:
            near = difflib.get_close_matches(name, every, 1)
            hint = f"did you mean {near[0]}? " if near else ""
            raise DataError(f"{option}{name}: there is no such {kind}; {hint}{kind.capitalize()}s: {', '.join(every)}")
    return [group for name, group in every.items() if not names or name in names]


def seconds_of(runs):
    return sum(run.seconds for run in runs)


def show(groups):
    width = max(len(group.name) for group in groups)
    for group in groups:
        print(f"{group.name.ljust(width)}  {len(group.runs):3} runs  {duration(seconds_of(group.runs)):>7}  "
              f"{group.what}")


def interrupt(*_):
    raise KeyboardInterrupt


def execute(options, choose_groups, score):
    """Makes the runs of the groups that `choose_groups()` returns, then prints the text that `score(groups, program,
    options)` returns. The exit code is 0 whatever the results are, 2 for bad input, also if the program rejects
    every run, 4 if a file cannot be written, and 130 if interrupted."""
    signal.signal(signal.SIGTERM, interrupt)
    try:
        for name, value, meaning in (("--jobs", options.jobs, "runs at a time"), ("-n", options.ranks, "ranks")):
            if value < 1:
                raise DataError(f"{name} {value}: give a number of {meaning}, at least 1")
        groups = choose_groups()
        if options.list:
            show(groups)
            return 0
        program = Program(options.program, options.ranks)
        runs = runs_of(groups)
        (options.out / "runs").mkdir(parents=True, exist_ok=True)
        if options.settings:
            require_accepted(runs[0], program, options.out)
    except DataError as error:
        return complain(error, 2)
    except OSError as error:
        return complain(f"{error.filename}: {error.strerror}", 4)
    print(f"{len(runs)} runs, about {duration(seconds_of(runs) / options.jobs)} in all", file=sys.stderr)
    try:
        make(runs, program, options.out, options.jobs)
    except KeyboardInterrupt:
        print("interrupted: the runs that have finished will not be made again", file=sys.stderr)
        return INTERRUPTED
    ends = [outcome(options.out / "runs" / run.name) for run in runs]
    if all(end["exit_code"] == 2 for end in ends):
        return complain(f"every run was refused, {runs[0].name} with: {ends[0]['message'].removeprefix('error: ')}", 2)
    try:
        print(score(groups, program, options))
    except IoError as error:
        return complain(error, 4)
    except OSError as error:
        return complain(f"{error.filename}: {error.strerror}", 4)
    return 0
