"""What the package's commands share: errors that read like those of the program."""

import argparse
import sys

__all__ = ["Parser", "complain"]


class Parser(argparse.ArgumentParser):
    """Wrong options end it with exit code 2."""

    def error(self, message):
        print(f"error: {message}; see: {self.prog} --help", file=sys.stderr)
        sys.exit(2)


def complain(what, code: int) -> int:
    """Tells an error; returns its exit code."""
    print(f"error: {what}", file=sys.stderr)
    return code
