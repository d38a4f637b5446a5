#!/usr/bin/python3
"""The reference of the command line, from the help of every command: docs/reference/command-line.md.

Usage: scripts/command_reference.py            writes the page
       scripts/command_reference.py --check    exit code 1 if the page does not agree with the program
The program is that of the environment variable TAILWATER, or build/release/bin/tailwater.
"""
import os
import pathlib
import re
import subprocess
import sys

from generated_page import write_or_check

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "reference" / "command-line.md"
PROGRAM = os.environ.get("TAILWATER", str(ROOT / "build/release/bin/tailwater"))
HEAD = """\
# Command line

For users who look up a command or an option. The keys of a case file have [a page of their own](case-file.md), and so
have [probes](probes.md) and the [keys for numerical studies](study-keys.md). `scripts/command_reference.py` writes this
page from the help of the program; change the help instead.
"""


def help_of(*command):
    """Help as on a terminal of 100 columns, without spaces at line ends."""
    text = subprocess.run([PROGRAM, *command, "--help"], check=True, capture_output=True, text=True,
                          env=os.environ | {"COLUMNS": "100", "NO_COLOR": "1"}).stdout
    return "\n".join(line.rstrip() for line in text.strip().splitlines())


def commands(overview):
    """Names of all commands, in the order of the overview."""
    listed = overview.split("\nCommands:\n")[1].split("\n\n")[0]
    return re.findall(r"^  (\w+) ", listed, re.MULTILINE)


def page():
    overview = help_of()
    chapters = [HEAD, "## `tailwater`\n", f"```text\n{overview}\n```\n"]
    for name in commands(overview):
        chapters += [f"## `tailwater {name}`\n", f"```text\n{help_of(name)}\n```\n"]
    return "\n".join(chapters)


if __name__ == "__main__":
    sys.exit(write_or_check(PAGE, page, __doc__))
