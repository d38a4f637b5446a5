"""Two ranks under mpirun: each has its part of the particles, and they go through the steps together."""

import sys
import tempfile
from pathlib import Path

import numpy as np

import tailwater as tw
from small import DAM


def end_of(case, hook=None):
    """{id: position} of this rank's water at the end."""
    with case.simulation(hook=hook) as simulation:
        simulation.run()
        end = simulation.now()
        water = end.is_water
        return dict(zip(end.id[water].tolist(), end.position[water].copy()))


def shake(step):
    if step.number == 0:
        step.steer("tank", lambda time: [0.5 * time**2, 0])


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

    # A tank that a script moves is that of the case that moves so.
    made = end_of(case.copy().update({"wall[0].displacement": ["0.5*t^2", 0]}))
    steered = end_of(case.copy().update({"wall[0].displacement": ["0*t", 0]}), shake)
    at_rest = end_of(case)
    assert made.keys() == steered.keys(), (len(made), len(steered))
    assert max(np.abs(steered[n] - made[n]).max() for n in made) < 1e-10
    assert max(np.abs(at_rest[n] - made[n]).max() for n in made.keys() & at_rest.keys()) > 1e-4
