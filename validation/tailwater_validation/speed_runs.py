"""Runs of the speed benchmark: cost of a case and of one of its steps, from the summaries of runs."""

import json
import math
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tailwater.errors import DataError


ROOT = Path(__file__).resolve().parents[2]
ZHOU = ROOT / "cases" / "zhou1999" / "case.toml"
DAM_BREAK_3D = ROOT / "benchmarks" / "dam_break_3d.toml"
GRAVITY, COURANT = 9.81, 0.55  # of the cases; scheme.courant's default sets how long the first steps are
UNCOUNTED_STEPS = 5  # at the start of a run, which builds lists and patterns and has no pressure to begin with


@dataclass(frozen=True)
class Water:
    """A collapsing column: `key` is the setting of its particle spacing."""

    case: Path
    key: str
    volume: float  # m^2 or m^3
    depth: float  # m
    dimension: int
    settings: tuple = ()

    def spacing(self, particles):
        return float(f"{(self.volume / particles) ** (1 / self.dimension):.4g}")

    def at(self, spacing):
        return (*self.settings, f"{self.key}={spacing:g}")

    def first_step(self, spacing):
        """Length of the first steps, s."""
        return COURANT * spacing / math.sqrt(2 * GRAVITY * self.depth)

    def first_steps(self, particles, steps):
        """Settings of a run of about this number of steps from a jittered start."""
        spacing = self.spacing(particles)
        end = (steps - 0.5) * self.first_step(spacing)
        return (*self.at(spacing), "particles.jitter=0.1", f"time.end={end:.6g}",
                f"output.fields_interval={2 * end:.6g}")


def box_of_rows(rows_deep):
    """60 000 particles of a 3D dam break with this number of rows over the depth: the deeper, the shorter and
    narrower the tank."""
    d = 0.01
    long, wide = {25: (60, 40), 100: (30, 20)}[rows_deep]
    shape = {"length": 2 * long, "width": wide, "height": rows_deep + 20, "column": long, "depth": rows_deep,
             "box_begin": 8, "box_length": 4, "box_width": 8, "box_side": (wide - 8) // 2}
    return Water(DAM_BREAK_3D, "parameters.d", long * wide * rows_deep * d**3, rows_deep * d, 3,
                 tuple(f"parameters.{name}={number * d:g}" for name, number in shape.items()))


# Free walls: the flow that other codes, and earlier commits, were timed on.
WATERS = {2: Water(ZHOU, "particles.spacing", 1.2 * 0.6, 0.6, 2, ("wall.tank.slip=free",)),
          3: Water(DAM_BREAK_3D, "parameters.d", 1.228 * 1.0 * 0.55, 0.55, 3)}


class Runner:
    """Runs cases one after the other, each into the same scratch folder, and reports each on standard error."""

    def __init__(self, program, folder, settings, say):
        self.program, self.folder, self.settings, self.say = program, folder, settings, say

    def command(self, case, settings, ranks=1):
        words = [str(self.program), "run", str(case), "--out", str(self.folder / "run"), "--force", "--quiet",
                 "-n", str(ranks)]
        for setting in (*self.settings, *settings):
            words += ["--set", setting]
        return words

    def run(self, case, settings, ranks=1):
        """Summary of a finished run. Throws DataError with the program's message."""
        try:
            told = subprocess.run(self.command(case, settings, ranks), capture_output=True, text=True, check=False)
        except OSError as error:
            raise DataError(f"{self.program}: cannot be started ({error.strerror})") from error
        if told.returncode != 0:
            raise DataError(" ".join(told.stderr.split()).removeprefix("error: ") or f"exit code {told.returncode}")
        return json.loads((self.folder / "run" / "summary.json").read_text(encoding="utf-8"))


@dataclass(frozen=True)
class StepCost:
    """Cost of one step."""

    fluid: int
    cpu: float  # s
    wall: float  # s
    iterations: float
    memory: float  # bytes; peak of the run, all ranks

    @property
    def cpu_per_particle(self):
        return self.cpu / self.fluid


def difference(short, long):
    """Cost of a step, from two runs of different duration, so that the costs of start and end cancel."""
    steps = long["steps"]["count"] - short["steps"]["count"]
    if steps <= 0:
        raise DataError(f"the longer run has {long['steps']['count']} steps, the shorter {short['steps']['count']}")

    def per_step(block, key):
        return (long[block][key] - short[block][key]) / steps

    return StepCost(long["particles"]["fluid"], per_step("cost", "cpu_s"), per_step("cost", "wall_clock_s"),
                    per_step("pressure_solver", "iterations"), long["cost"]["peak_memory_bytes"])


def step_cost(runner, water, particles, steps, ranks=1):
    runs = [runner.run(water.case, water.first_steps(particles, count), ranks)
            for count in (UNCOUNTED_STEPS, UNCOUNTED_STEPS + steps)]
    return difference(*runs)


def least(costs, key):
    """The measurement that other programs disturbed least."""
    return min(costs, key=lambda cost: getattr(cost, key))


def exponent(sizes, costs):
    """p in cost ~ size^p, by least squares of the logarithms. Throws DataError if it cannot be determined."""
    if len(set(sizes)) < 2:
        raise DataError("an exponent needs two sizes")
    if min(costs) <= 0:  # differences of times of short runs on a busy machine
        raise DataError("a cost is not positive: the machine is too busy, or the runs are too short")
    return float(np.polyfit(np.log(sizes), np.log(costs), 1)[0])
