#!/usr/bin/python3
"""A guide as a Jupyter notebook: its blocks of Python are the cells of code, all else is text between them.

Usage: scripts/notebook.py GUIDE NOTEBOOK, as in: scripts/notebook.py docs/guide/weir.md weir.ipynb
"""
import json
import re
import sys
from pathlib import Path

BLOCK = re.compile(r"^```python\n(.*?)^```\n", re.DOTALL | re.MULTILINE)


def cells(text):
    """Cells of a page in Markdown, alternately text and code."""
    for number, part in enumerate(BLOCK.split(text)):
        if part.strip():
            common = {"id": f"cell-{number}", "metadata": {}, "source": part.strip("\n")}
            yield {"cell_type": "code", "execution_count": None, "outputs": [], **common} if number % 2 else {
                "cell_type": "markdown", **common}


def notebook(text):
    return {"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": {
        "display_name": "Python 3", "language": "python", "name": "python3"}}, "cells": list(cells(text))}


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    guide, target = map(Path, sys.argv[1:])
    target.write_text(json.dumps(notebook(guide.read_text(encoding="utf-8")), indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
