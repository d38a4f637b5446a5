"""Two ranks under mpirun, one with an error in its script: both end, and neither waits. Argument: the run's folder."""

import sys
import tempfile
from pathlib import Path

import tailwater as tw
from small import DAM

with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "dam.toml"
    file.write_text(DAM, encoding="utf-8")
    with tw.Case(file).simulation(sys.argv[1], force=True) as simulation:
        for step in simulation:
            if simulation.rank == 1 and step.number == 2:
                raise ValueError("of rank 1 alone")
