#!/usr/bin/python3
"""Draws the pictures of docs/reference/examples.md into docs/images/examples: each shows the case of the example above it.

Usage: scripts/example_pictures.py
"""
import contextlib
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import pages
import picture_record

PAGE = "docs/reference/examples.md"
LARGEST = 60e3  # bytes of a picture
SECTION = re.compile(r"```toml\n(?P<text>[^`]*)```\n\n!\[.*?\]\((?P<picture>.*?)\)", re.DOTALL)
HEADING = re.compile(r"^##+ (.*)$", re.MULTILINE)


def draw(text, title, picture):
    """Writes the preview of the case of a block of TOML, with fewer particles where it is large. Throws RuntimeError if the
    block has faults."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        file, faults = pages.assemble(pages.Block(1, "toml", text))
        if faults:
            raise RuntimeError(f"{PAGE}: {faults[0]}")
        spacing = pages.Case(file)["particles.spacing"]
        title = json.dumps(title)
        while True:
            subprocess.run([pages.program(), "check", file, "--preview", picture, "--set", f"particles.spacing={spacing}",
                            "--set", f"case.title={title}"],
                           check=True, stdout=subprocess.DEVNULL)
            if picture.stat().st_size <= LARGEST:
                return
            spacing = f"2*({spacing})"


def main():
    page = pages.ROOT / PAGE
    text = page.read_text(encoding="utf-8")
    for section in SECTION.finditer(text):
        picture = (page.parent / section["picture"]).resolve()
        picture.parent.mkdir(exist_ok=True)
        draw(section["text"], HEADING.findall(text, 0, section.start())[-1], picture)
        picture_record.write(picture)
        print(f"example_pictures.py: {picture.relative_to(pages.ROOT)}, {picture.stat().st_size / 1e3:.0f} kB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
