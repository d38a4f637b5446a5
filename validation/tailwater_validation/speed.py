"""`tailwater bench speed`: cost of cases, steps and modules in CPU time and memory, and its growth.

Runs one thing at a time, prints a table, and writes OUT/speed.json, speed.csv and speed.md. Times are CPU times, except
where ranks are compared; memory is the peak of the process.

Usage: python -m tailwater_validation.speed --program FILE [--level tiny|quick|full] [--part NAME]... [--out DIR]
Exit codes: 0 all was measured, whatever the results are; 2 bad input, 3 a run failed (the rest is written), 4 a file
cannot be read or written, 130 interrupted.
"""

import contextlib
import datetime
import os
import signal
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from tailwater.command_line import complain
from tailwater.errors import DataError, IoError

from . import command, speed_profile, speed_report, speed_modules
from .metric import Metric
from .runs import INTERRUPTED
from .speed_runs import WATERS, ZHOU, Runner, box_of_rows, exponent, least, step_cost
from .text_table import text_table

PARTS = ("modules", "cases", "growth", "deep", "ranks", "profile")  # the last only if it is asked for
PROFILED_STEPS = 40
INTEGRATORS = ("explicit", "implicit")
MEMORY_BARS = {2: 1200, 3: 3000}  # bytes per fluid particle
EXPONENT_BAR = 1.08
SPEED_UP_BAR = 1.8
ZHOU_BARS = {0.015: 4, 0.0075: 30}  # CPU s per simulated s
DAM_BREAK_3D_BARS = {0.02: 300}
DEEP_BARS = {25: 5, 100: 7}  # us per fluid particle and step, by rows of depth


@dataclass(frozen=True)
class Level:
    zhou: tuple  # (dx, end in sqrt(H/g))
    dam_break_3d: tuple  # (dx, end in s)
    growth: dict  # numbers of fluid particles, by dimension
    modules: dict
    ranks: dict
    deep: tuple  # rows of depth
    steps: int  # counted
    repeats: int
    min_time: float  # s, of a benchmark of the modules


LEVELS = {
    "tiny": Level(((0.06, 0.2),), ((0.1, 0.01),), {2: (500, 1000)}, {2: (500,), 3: (600,)}, {2: 500}, (), 30,
                  1, 0.001),
    "quick": Level(((0.015, 4),), ((0.05, 0.3),), {2: (5e3, 2e4, 6e4), 3: (5e3, 1.5e4)}, {2: (2e4,), 3: (1e4,)},
                   {2: 3e4}, (), 10, 1, 0.1),
    "full": Level(((0.015, 8), (0.0075, 8)), ((0.02, 2.0),), {2: (5e3, 2e4, 1e5, 3e5, 1e6), 3: (5e3, 3e4, 1e5, 5e5)},
                  {2: (5e4, 2e5, 1e6), 3: (5e4, 5e5)}, {2: 2e5, 3: 8e4}, (25, 100), 20, 3, 0.5),
}


class Bench:
    def __init__(self, level, runner, say):
        self.level, self.runner, self.say = level, runner, say
        self.metrics = []

    def add(self, name, what, unit, value, high=None, low=None, note=""):
        self.metrics.append(Metric(name, what, unit, "", low, high, value, note=note))

    @contextlib.contextmanager
    def measuring(self, name, what):
        """Reports the measurement. A failure becomes a number without a value, and the rest of the block is skipped."""
        self.say(what)
        try:
            yield
        except DataError as error:
            self.say(f"failed: {what}: {error}")
            self.add(name, what, "", None, note=str(error))

    def measure(self, part, options, commit):
        if part != "modules":
            getattr(self, part)()
            return
        with self.measuring("modules", "modules"):
            for metrics in speed_modules.measure(modules_program(options.program), self.level, commit, options.settings,
                                               self.say):
                self.metrics += metrics

    def whole_run(self, name, what, case, settings, high):
        with self.measuring(name, what):
            self.add_whole_run(name, what, self.runner.run(case, settings), high)

    def add_whole_run(self, name, what, run, high):
        fluid, cost, steps = run["particles"]["fluid"], run["cost"], run["steps"]["count"]
        self.add(name, what, "CPU s per simulated s", cost["cpu_s_per_simulated_s"], high)
        self.add(f"{name}.step", what, "us per fluid particle and step", 1e6 * cost["cpu_s"] / steps / fluid)
        self.add(f"{name}.steps", what, "steps per simulated s", steps / run["time_s"]["reached"])
        self.add(f"{name}.iterations", what, "iterations per step", run["pressure_solver"]["iterations"] / steps)
        self.add(f"{name}.memory", what, "bytes per fluid particle, program included",
                 cost["peak_memory_bytes"] / fluid)

    def cases(self):
        """Whole runs from their start."""
        for dx, end in self.level.zhou:
            for integrator in INTEGRATORS:
                settings = (*WATERS[2].at(dx), f"time.end={end:g}*sqrt(H/g)", f"scheme.integrator={integrator}")
                self.whole_run(f"zhou.{dx:g}.{end:g}.{integrator}",
                               f"Zhou, dx = {dx:g} m, to T = {end:g}, {integrator}", ZHOU, settings, ZHOU_BARS.get(dx))
        for dx, end in self.level.dam_break_3d:
            water = WATERS[3]
            self.whole_run(f"dam_break_3d.{dx:g}.{end:g}", f"3D dam break, dx = {dx:g} m, first {end:g} s", water.case,
                           (*water.at(dx), f"time.end={end:g}"), DAM_BREAK_3D_BARS.get(dx))

    def step(self, water, particles, ranks=1, key="cpu"):
        return least([step_cost(self.runner, water, particles, self.level.steps, ranks)
                      for _ in range(self.level.repeats)], key)

    def growth(self):
        """First steps at several numbers of particles. The difference between the smallest and the largest excludes
        the memory of the program itself."""
        for dimension, sizes in self.level.growth.items():
            costs = []
            for particles in sizes:
                name, what = f"step.{dimension}D.{particles:g}", f"{dimension}D dam break, {particles:g} particles"
                with self.measuring(name, what):
                    cost = self.step(WATERS[dimension], particles)
                    costs.append(cost)
                    self.add(name, what, "us per fluid particle and step", 1e6 * cost.cpu_per_particle)
                    self.add(f"{name}.iterations", what, "iterations per step", cost.iterations)
                    self.add(f"{name}.memory", what, "bytes per fluid particle, program included", cost.memory / cost.fluid)
            if len(costs) > 1:
                fluid = [cost.fluid for cost in costs]
                what = f"{dimension}D, {fluid[0]} to {fluid[-1]} particles"
                with self.measuring(f"step.{dimension}D.exponent", f"{what}, CPU time of a step"):
                    self.add(f"step.{dimension}D.exponent", f"{what}, CPU time of a step", "exponent",
                             exponent(fluid, [cost.cpu for cost in costs]), EXPONENT_BAR)
                self.add(f"step.{dimension}D.memory", f"{what}, peak memory without the program",
                         "bytes per fluid particle", (costs[-1].memory - costs[0].memory) / (fluid[-1] - fluid[0]),
                         MEMORY_BARS[dimension])

    def deep(self):
        """Equal numbers of particles in water of several depths, on which the cost of the pressure solve depends."""
        for rows in self.level.deep:
            name, what = f"deep.{rows}", f"3D dam break, {rows} rows deep"
            with self.measuring(name, what):
                cost = self.step(box_of_rows(rows), 6e4)
                self.add(name, what, "us per fluid particle and step", 1e6 * cost.cpu_per_particle, DEEP_BARS[rows])
                self.add(f"{name}.iterations", what, "iterations per step", cost.iterations)

    def ranks(self):
        """One rank and two ranks in turn."""
        for dimension, particles in self.level.ranks.items():
            name, what = f"ranks.{dimension}D.{particles:g}", f"{dimension}D, {particles:g} particles, two ranks"
            with self.measuring(name, what):
                pairs = [[step_cost(self.runner, WATERS[dimension], particles, self.level.steps, ranks)
                          for ranks in (1, 2)] for _ in range(self.level.repeats)]
                one, two = (least(costs, "wall") for costs in zip(*pairs))
                self.add(name, f"{what}: clock time of one rank's step over theirs", "ratio", one.wall / two.wall,
                         low=SPEED_UP_BAR)
                self.add(f"{name}.memory", f"{what}: peak memory over that of one rank", "ratio", two.memory / one.memory)

    def profile(self):
        """Profile of the first steps, including the start of the run."""
        for dimension, sizes in self.level.modules.items():
            name, what = f"profile.{dimension}D", f"{dimension}D, {sizes[0]:g} particles, where the time goes"
            with self.measuring(name, what):
                water = WATERS[dimension]
                run = self.runner.command(water.case, water.first_steps(sizes[0], PROFILED_STEPS))
                self.metrics += speed_profile.measure(self.runner, dimension, run)


def modules_program(program):
    return program.with_name("bench_modules")


def choose_parts(options):
    """The parts to measure, in order: those of `--part`, otherwise all that need no further tool. Throws DataError."""
    for name in options.parts:
        if name not in PARTS:
            raise DataError(f"--part {name}: there is no such part; parts: {', '.join(PARTS)}")
    if "profile" in options.parts:
        speed_profile.require_perf()
    chosen = [name for name in PARTS if name in (options.parts or PARTS[:-1])]
    if "modules" in chosen and not modules_program(options.program).is_file():
        remedy = (f"the benchmarks of the modules are not built; remedy: scripts/install.sh benchmarks, then "
                  f"cmake --build {options.program.parent.parent} --target benchmarks")
        if options.parts:
            raise DataError(remedy)
        print(f"left out: {remedy}", file=sys.stderr)
        chosen.remove("modules")
    return chosen


def provenance(runner):
    """Version, compiler and machine of the program, from a run of no duration, which rejects wrong settings first."""
    summary = runner.run(ZHOU, ("particles.spacing=0.06", "time.end=1e-6"))
    return {key: summary[key] for key in ("version", "commit", "compiler", "options", "libraries", "machine")}


def measure(options, parts, say):
    load = os.getloadavg()[0]
    started = datetime.datetime.now(datetime.timezone.utc)
    with tempfile.TemporaryDirectory(prefix="tailwater_speed_") as scratch:
        runner = Runner(options.program, Path(scratch), tuple(options.settings), say)
        told = provenance(runner)
        bench = Bench(LEVELS[options.level], runner, say)
        is_interrupted = False
        try:
            for part in parts:
                bench.measure(part, options, told["commit"])
        except KeyboardInterrupt:
            is_interrupted = True
    return {**told, "date": started.isoformat(timespec="seconds"), "level": options.level,
            "settings": list(options.settings), "load_before": load, "interrupted": is_interrupted,
            "numbers": [speed_report.record(metric) for metric in bench.metrics]}


def say(text):
    print(text, file=sys.stderr, flush=True)


def make_parser():
    parser = command.OutParser("tailwater bench speed", "Measure the CPU time and memory of cases, time steps "
                               "and modules.", "speed")
    parser.epilog = ("Other programs on the machine affect CPU times: measure both sides of a comparison within the "
                     "same minutes. Missed targets do not change the exit code.")
    parser.add_argument("--level", choices=LEVELS, default="quick",
                        help="tiny: seconds, to test the benchmark; quick: three minutes; full: hours, on an idle machine")
    parser.add_argument("--part", action="append", default=[], metavar="NAME", dest="parts",
                        help="part to measure: modules, cases, growth, deep, ranks or profile; may be repeated "
                        "(default: all except profile, which needs perf)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", dest="settings",
                        help="override a key in all runs; may be repeated")
    parser.add_argument("--compare", type=Path, nargs="+", default=[], metavar="JSON",
                        help="print ratios to an earlier speed.json. With two files, print the ratios of the second to "
                        "the first and measure nothing")
    return parser


def main(arguments=None):
    signal.signal(signal.SIGTERM, command.interrupt)
    options = make_parser().parse_args(arguments)
    try:
        if len(options.compare) > 2:
            raise DataError("--compare takes one file, or two")
        earlier = [speed_report.read(path) for path in options.compare]
        if len(earlier) == 2:
            print(speed_report.comparison(*earlier))
            return 0
        parts = choose_parts(options)
        options.out.mkdir(parents=True, exist_ok=True)
        result = measure(options, parts, say)
        speed_report.write(result, options.out)
    except DataError as error:
        return complain(error, 2)
    except IoError as error:
        return complain(error, 4)
    except OSError as error:
        return complain(f"{error.filename}: {error.strerror}", 4)
    except KeyboardInterrupt:
        return INTERRUPTED
    print(text_table(speed_report.COLUMNS, speed_report.rows(result)))
    print(f"\n{speed_report.heading(result)}\nwritten: {options.out}/speed.json, speed.csv, speed.md")
    if earlier:
        print(f"\n{speed_report.comparison(earlier[0], result)}")
    if result["interrupted"]:
        print("interrupted: what had been measured by then is written", file=sys.stderr)
        return INTERRUPTED
    return 3 if any(number["value"] is None for number in result["numbers"]) else 0


if __name__ == "__main__":
    sys.exit(main())
