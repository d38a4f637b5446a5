"""A run in this process: its fields as numpy arrays, and forces by a script.

    with case.simulation() as simulation:
        for step in simulation:
            step.body_force[:, 0] = 0.1 * numpy.sin(step.time)

The body of the loop sees the moment before each step, the first at t = 0."""

import atexit
import sys
import traceback
import warnings
import weakref

import numpy as np

from .errors import Error, InputError, IoError, RunWarning
from .run import Run

try:
    from . import _simulation
except ImportError as error:
    raise IoError(f"this installation has no simulations in Python ({error}); remedy: the package "
                  "python3-tailwater, or a build with pybind11-dev and python3-dev (scripts/install.sh)") from error

__all__ = ["Body", "Simulation", "Step"]

open_simulations = weakref.WeakSet()
warned = 0  # of the warnings of this process: how many are Python's; each simulation that opens begins them anew


def warn_of_new():
    global warned
    told = _simulation.warnings()
    new, warned = told[warned:], len(told)
    for line in new:
        warnings.warn(line, RunWarning, stacklevel=3)


class Body:
    """A floating body in a step, by its `name`. Vectors have 2 or 3 components; angles and moments are single numbers in 2D. In 2D
    forces, masses and moments are those of a metre of width."""

    def __init__(self, flow, number, name):
        self._flow, self._number, self.name = flow, number, name

    @property
    def centre(self) -> np.ndarray:
        """m; the centre of mass."""
        return self._flow.body_centre(self._number)

    @property
    def velocity(self) -> np.ndarray:
        """m/s; of the centre of mass."""
        return self._flow.body_velocity(self._number)[:self._flow.dimension]

    @property
    def angular_velocity(self):
        """rad/s; a number in 2D, else about each axis."""
        turns = self._flow.body_velocity(self._number)[self._flow.dimension:]
        return turns if turns.size > 1 else float(turns[0])

    @property
    def rotation(self) -> np.ndarray:
        """The matrix that turns the body from where it is drawn."""
        return self._flow.body_turn(self._number)

    def place(self, point) -> np.ndarray:
        """m; where a point of the body is now that is drawn at `point` (m)."""
        return self.rotation @ np.asarray(point, dtype=float) + self._flow.body_shift(self._number)

    def velocity_at(self, place) -> np.ndarray:
        """m/s; of the body at a place (m)."""
        arm, turn = np.asarray(place, dtype=float) - self.centre, self.angular_velocity
        return self.velocity + (np.cross(turn, arm) if arm.size == 3 else turn * np.array([-arm[1], arm[0]]))

    def push(self, force, at=None, moment=0.0):
        """Adds in the coming step a force (N) at a place (m), by default the centre of mass, and a moment (N m)."""
        force = np.asarray(force, dtype=float)
        if force.shape != (self._flow.dimension,):
            raise InputError(f"a force on body '{self.name}' has {self._flow.dimension} components, not {force.shape}")
        if at is not None:
            moment = moment + np.cross(np.asarray(at, dtype=float) - self.centre, force)
        turns = np.broadcast_to(np.asarray(moment, dtype=float), (1 if force.size == 2 else 3,))
        self._flow.push(self._number, np.concatenate([force, turns]))


class Bodies(dict):
    def __missing__(self, name):
        raise KeyError(f"{name}; the case has {', '.join(self) or 'no bodies'}")


class Step:
    """The moment before a step: `time` (s), `dt` (s) of the step, `number` of those taken.

    Arrays share the memory of the flow and are read-only. Those that are kept stay what they were at their moment; a
    step that is over gives no more. They are of the particles of this rank, also those of walls near the water, and
    particle i of one step may be another in the next: `id` stays."""

    def __init__(self, simulation):
        self._flow = simulation._flow
        self.time, self.dt, self.number = self._flow.time, self._flow.dt, self._flow.number

    def __repr__(self):
        return f"Step({self.number} from {self.time:.6g} s by {self.dt:.4g} s)"

    def _now(self):
        if self._flow.number != self.number:
            raise RuntimeError(f"step {self.number} is over; keep the arrays of a step, not the step")
        return self._flow

    @property
    def position(self) -> np.ndarray:
        """m, (n, 2) or (n, 3)"""
        return self._now().position

    @property
    def velocity(self) -> np.ndarray:
        """m/s, (n, 2) or (n, 3)"""
        return self._now().velocity

    @property
    def pressure(self) -> np.ndarray:
        """Pa, (n)"""
        return self._now().pressure

    @property
    def volume(self) -> np.ndarray:
        """m^3, in 2D m^2, (n)"""
        return self._now().volume

    @property
    def id(self) -> np.ndarray:
        """(n); given once and never to another."""
        return self._now().id

    @property
    def is_water(self) -> np.ndarray:
        """(n) booleans; False: of a wall. A copy."""
        return self._now().kind == 0

    @property
    def body_force(self) -> np.ndarray:
        """m/s^2, (n, 2) or (n, 3): force per mass on each particle of water in this step, to be written into; zero at
        first. The size of the step does not follow it: keep it below some times gravity."""
        return self._now().acceleration

    @body_force.setter
    def body_force(self, value):
        self._now().acceleration[...] = value

    @property
    def bodies(self) -> dict:
        """The floating bodies by name."""
        return Bodies({name: Body(self._now(), k, name) for k, name in enumerate(self._now().bodies)})

    def set_discharge(self, inlet: str, discharge: float):
        """m^3/s, in 2D per metre of width; from this step on, in place of what the case says of an inlet that has a
        discharge. Throws InputError for another."""
        self._now().set_discharge(inlet, float(discharge))

    def steer(self, wall: str, path):
        """From this step on a wave maker, a gate or another wall that moves in the case goes along `path`, a function of
        the time (s) that returns its displacement (m) from where it is drawn, 2 or 3 numbers, and after them, if it
        turns about its pivot, its angle (rad). It is asked at times of the coming steps, some more than once. Throws
        InputError for a path that begins elsewhere than where the wall is."""
        self._now().steer(wall, lambda time: np.atleast_1d(path(time)).tolist())
        self.dt = self._flow.dt


class Simulation:
    """The run of a case in this process, for a `with`. Going through it takes the steps, to the end of the case.

    `hook(step)` is called before each step, and once more at the start, where the pressure is found and `dt` is 0: a
    force that acts from the start on belongs there.

    `dimension`, `spacing` (m), `density` (kg/m^3) and `end` (s) are the case's.

    With `out` it also writes a run's folder, as `tailwater run` does. Throws InputError, IoError and SolverError;
    Ctrl-C is Python's, between two steps. Under mpirun all ranks do the same in step; each has the particles of its part
    of space. Ending a run is work of all ranks too, so an error of the script on any of them ends all at once, without
    a checkpoint; of a SolverError all know."""

    def __init__(self, case, out=None, *, hook=None, force: bool = False):
        global warned
        if any(out is not None or other._out is not None for other in open_simulations):
            raise InputError("a simulation that writes a folder is the only one in its process; remedy: close the other "
                             "first")
        self._failure = ""
        self._out = out
        words = case.words()
        warned = 0
        try:
            self._flow = _simulation.open(words[0], words[2::2], None if out is None else str(out), force)
        finally:
            warn_of_new()
        self.dimension, self.end = self._flow.dimension, self._flow.end
        self.spacing, self.density = self._flow.spacing, self._flow.density
        self._hook, self._hooked = hook, -1  # the last step that the hook has seen
        open_simulations.add(self)
        if self.ranks > 1:
            sys.excepthook = end_all_ranks
        try:
            if hook is not None:
                hook(Step(self))
            self._attempt(self._flow.start)
        except BaseException as error:
            self._end_others(error)
            self.close()
            raise

    @property
    def rank(self) -> int:
        """Of this process, from 0."""
        return _simulation.rank()

    @property
    def ranks(self) -> int:
        """How many processes the run has."""
        return _simulation.ranks()

    def _attempt(self, work):
        if self._failure:
            raise RuntimeError(f"the simulation has failed: {self._failure}")
        try:
            return work()
        except Error as error:
            self._failure = str(error)
            raise
        except BaseException as error:  # of a path of the script, within a step
            self._end_others(error)
            self._failure = repr(error)
            raise
        finally:
            warn_of_new()

    def __iter__(self):
        while self._attempt(self._flow.prepare):
            step = Step(self)
            if self._hook is not None and step.number > self._hooked:
                self._hooked = step.number
                self._hook(step)
            yield step
            self._attempt(self._flow.step)

    def run(self, until: float = float("inf")):
        """Goes on to the end, or to the first step at or after `until` (s)."""
        for step in self:
            if step.time >= until:
                return

    @property
    def time(self) -> float:
        """s"""
        return self._flow.time

    @property
    def iterations(self) -> int:
        """Of the pressure solver in the last step."""
        return self._flow.iterations

    def now(self) -> Step:
        """The present moment, for reading: after the loop that of the end."""
        return Step(self)

    def result(self) -> Run:
        """The run's folder. Throws InputError if nothing is written."""
        if self._out is None:
            raise InputError("this simulation writes no folder; remedy: case.simulation(out=DIR)")
        return Run(self._out)

    def _end_others(self, error):
        """They would wait for ever for this rank in `close`, or it for them."""
        if error is not None and not self._failure and self.ranks > 1:
            end_all_ranks(type(error), error, error.__traceback__)

    def close(self):
        """Ends the run, and its folder if there is one: with a checkpoint if the end of the case is not reached."""
        if self in open_simulations:
            open_simulations.discard(self)
            try:
                self._flow.finish(self._failure)
            finally:
                warn_of_new()

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        self._end_others(error)
        self.close()


def end():
    for simulation in list(open_simulations):
        simulation.close()
    _simulation.end_session()


def end_all_ranks(kind, error, trace):
    traceback.print_exception(kind, error, trace)
    sys.stderr.flush()
    _simulation.abort()


atexit.register(end)
