"""Processes of this machine, by what their command lines say."""

import pathlib


def command_line(process):
    """The words of a process; none when it is gone."""
    try:
        return pathlib.Path(f"/proc/{process}/cmdline").read_text().split("\0")
    except OSError:
        return []


def processes_of(out):
    """Numbers of all processes that run a case into this folder."""
    found = [int(entry.name) for entry in pathlib.Path("/proc").iterdir() if entry.name.isdigit()]
    return [process for process in found if str(out) in command_line(process)]
