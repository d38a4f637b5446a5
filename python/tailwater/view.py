"""The viewer of runs, served by the program."""

import atexit
import html
import tempfile
from pathlib import Path

from .errors import error_of
from .program import call, start

__all__ = ["View"]


class View:
    """Serves the viewer of runs at `address` on this machine, until `close` or the end of this process. A notebook
    embeds a copy of the viewer with the data that the runs have written so far; the copy is saved with the notebook."""

    def __init__(self, *paths):
        self.paths = paths
        self._child = start("view", "--no-browser", *paths)
        line = self._child.stdout.readline()
        if "http://" not in line:
            told = self._child.communicate()[1]
            raise error_of(self._child.returncode, told)
        self.address = line[line.index("http://"):].split()[0]
        atexit.register(self.close)

    def close(self):
        """Ends the server; the viewer then shows no new data."""
        self._child.terminate()
        self._child.communicate()
        atexit.unregister(self.close)

    def __repr__(self):
        return self.address

    def _repr_html_(self):
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / "page.html"
            call("view", *self.paths, "--export", page)
            text = html.escape(page.read_text(encoding="utf-8"))
        return f'<iframe srcdoc="{text}" width="100%" height="560" style="border: 1px solid #ccc"></iframe>'
