"""A run as those who score it look at it: its probes as curves."""

from tailwater.errors import DataError
from tailwater.run import Run
from tailwater.tables import read_table

from .curves import read_curve


class RunFolder(Run):
    def __init__(self, path):
        super().__init__(path)
        self._profile_tables = {}

    def probe(self, name, column):
        """The curve of a probe's column over time in s."""
        return read_curve(self.path / "probes" / f"{name}.csv", column)

    def profile_table(self, name):
        """Columns of a profile probe's CSV, by name; read once, since one file holds the profiles of all times."""
        if name not in self._profile_tables:
            self._profile_tables[name] = read_table(self.path / "probes" / f"{name}.csv")
        return self._profile_tables[name]

    def step_table(self):
        """Columns of steps.csv, by name."""
        return read_table(self.path / "steps.csv")

    def step_curve(self, column):
        """A column of steps.csv over time in s."""
        return read_curve(self.path / "steps.csv", column)

    @property
    def fluid_particles(self):
        """How many there are at the end. Throws DataError if the run has not ended."""
        if "particles" not in self.summary:
            raise DataError(f"{self.path}: the run has not ended")
        return self.summary["particles"]["fluid"]

    @property
    def integrator(self):
        """"two-step" for the scheme that knows no other."""
        return self.case["scheme"].get("integrator", "two-step")
