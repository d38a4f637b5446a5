"""Two ranks under mpirun: each has its part of the particles, and they go through the steps together."""

import sys
import tempfile
from pathlib import Path

import tailwater as tw
from small import DAM

with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "dam.toml"
    file.write_text(DAM, encoding="utf-8")
    case = tw.Case(file)
    with case.simulation() as simulation:
        assert simulation.ranks == 2, simulation.ranks
        for step in simulation:
            count = int(step.is_water.sum())
            step.body_force[:, 0] = 0.5
        assert 0 < count < 50, count
        assert simulation.time >= 0.1
        print(f"rank {simulation.rank}: {count} particles", file=sys.stderr)
