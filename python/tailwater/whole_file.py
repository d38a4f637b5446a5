"""Files that are written beside their place and then put there."""

import os


def write_whole(path, write):
    """A killed program leaves no half file, and nothing is written through a link."""
    part = path.with_name(path.name + ".part")
    part.unlink(missing_ok=True)
    write(part)
    os.replace(part, path)
