"""The command line of the scripts that generate a page of the documentation: they write it, or with --check compare it."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def write_or_check(path, make_text, usage):
    """The exit code: 0, 1 if the page at `path` does not agree with `make_text()`, 2 for other arguments than --check."""
    arguments = sys.argv[1:]
    if arguments not in ([], ["--check"]):
        print(usage, file=sys.stderr)
        return 2
    text = make_text()
    if not arguments:
        path.write_text(text, encoding="utf-8")
    elif not path.is_file() or path.read_text(encoding="utf-8") != text:
        print(f"{path.relative_to(ROOT)} is out of date; remedy: scripts/{pathlib.Path(sys.argv[0]).name}")
        return 1
    return 0
