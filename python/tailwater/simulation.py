"""A run in this process: its fields as numpy arrays, and forces by a script.

    with case.simulation() as simulation:
        for step in simulation:
            step.body_force[:, 0] = 0.1 * numpy.sin(step.time)

The body of the loop runs before each time step, the first time at t = 0."""

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
warned = 0  # number of warnings already issued as Python warnings; reset when a simulation opens


def warn_of_new():
    global warned
    told = _simulation.warnings()
    new, warned = told[warned:], len(told)
    for line in new:
        warnings.warn(line, RunWarning, stacklevel=3)


class Body:
    """A floating body in a step, by its `name`. Vectors have 2 or 3 components; angles and moments are single numbers
    in 2D. In 2D forces, masses and moments are those of a metre of width."""

    def __init__(self, flow, number, name):
        self._flow, self._number, self.name = flow, number, name

    @property
    def centre(self) -> np.ndarray:
        """The centre of mass, m."""
        return self._flow.body_centre(self._number)

    @property
    def velocity(self) -> np.ndarray:
        """Velocity of the centre of mass, m/s."""
        return self._flow.body_velocity(self._number)[:self._flow.dimension]

    @property
    def angular_velocity(self):
        """rad/s; a number in 2D, a vector in 3D."""
        turns = self._flow.body_velocity(self._number)[self._flow.dimension:]
        return turns if turns.size > 1 else float(turns[0])

    @property
    def rotation(self) -> np.ndarray:
        """The rotation matrix from the position in the case to the present position."""
        return self._flow.body_turn(self._number)

    def place(self, point) -> np.ndarray:
        """The present position (m) of the point of the body that is at `point` (m) in the case."""
        return self.rotation @ np.asarray(point, dtype=float) + self._flow.body_shift(self._number)

    def velocity_at(self, place) -> np.ndarray:
        """Velocity (m/s) of the body at a position (m)."""
        arm, turn = np.asarray(place, dtype=float) - self.centre, self.angular_velocity
        return self.velocity + (np.cross(turn, arm) if arm.size == 3 else turn * np.array([-arm[1], arm[0]]))

    def push(self, force, at=None, moment=0.0):
        """Adds a force (N) at a position (m), by default the centre of mass, and a moment (N m), both for the next
        step."""
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
    """The state before a step: `time` (s), the size `dt` (s) of the step, and the number `number` of completed steps.

    Arrays share the memory of the flow and are read-only. An array that a script keeps does not change in later steps;
    a step that has ended gives no new arrays. Arrays hold the particles of this rank, including wall particles near the
    water. The order of particles may change from step to step; `id` identifies them."""

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
        """(n); unique for the whole run."""
        return self._now().id

    @property
    def is_water(self) -> np.ndarray:
        """(n) booleans; False for wall particles. A copy."""
        return self._now().kind == 0

    @property
    def body_force(self) -> np.ndarray:
        """m/s^2, (n, 2) or (n, 3): force per mass on each fluid particle in this step, writable, initially zero. The
        time step does not take this force into account: keep it below a few times gravity."""
        return self._now().acceleration

    @body_force.setter
    def body_force(self, value):
        self._now().acceleration[...] = value

    @property
    def bodies(self) -> dict:
        """The floating bodies by name."""
        return Bodies({name: Body(self._now(), k, name) for k, name in enumerate(self._now().bodies)})

    def set_discharge(self, inlet: str, discharge: float):
        """Sets the discharge of an inlet from this step on, m^3/s, in 2D per metre of width. Throws InputError for an
        inlet that has no discharge in the case."""
        self._now().set_discharge(inlet, float(discharge))

    def steer(self, wall: str, path):
        """Moves a wave maker, a gate or another moving wall of the case along `path` from this step on. `path` is a
        function of the time (s). It returns the displacement (m) from the position in the case, 2 or 3 numbers,
        followed by the angle (rad) if the wall rotates about its pivot. It is called for times of the next steps, for
        some more than once. Throws InputError for a path that begins away from the present position of the wall."""
        self._now().steer(wall, lambda time: np.atleast_1d(path(time)).tolist())
        self.dt = self._flow.dt


class Simulation:
    """The run of a case in this process, for a `with` statement. Iteration takes the steps, to the end of the case.

    `hook(step)` is called before each step, and once more at the start, where the initial pressure is computed and `dt`
    is 0. Set a force there that acts from the start on.

    `dimension`, `spacing` (m), `density` (kg/m^3) and `end` (s) are those of the case.

    With `out` it also writes a run folder, as `tailwater run` does. Throws InputError, IoError and SolverError. Ctrl-C
    raises KeyboardInterrupt between two steps.

    Under mpirun all ranks must make the same calls; each rank has the particles of its part of space. Ending a run
    needs all ranks, so an error of the script on any rank ends all ranks at once, without a checkpoint. A SolverError
    is raised on all ranks."""

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
        self._hook, self._hooked = hook, -1  # the last step for which the hook was called
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
        """Rank of this process, from 0."""
        return _simulation.rank()

    @property
    def ranks(self) -> int:
        """Number of processes of the run."""
        return _simulation.ranks()

    def _attempt(self, work):
        if self._failure:
            raise RuntimeError(f"the simulation has failed: {self._failure}")
        try:
            return work()
        except Error as error:
            self._failure = str(error)
            raise
        except BaseException as error:  # raised within a step by a path of the script
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
        """Runs to the end, or to the first step at or after `until` (s)."""
        for step in self:
            if step.time >= until:
                return

    @property
    def time(self) -> float:
        """s"""
        return self._flow.time

    @property
    def iterations(self) -> int:
        """Iterations of the pressure solver in the last step."""
        return self._flow.iterations

    def now(self) -> Step:
        """The present state, for reading; after the loop, the final state."""
        return Step(self)

    def result(self) -> Run:
        """The run in the written folder. Throws InputError if the simulation writes no folder."""
        if self._out is None:
            raise InputError("this simulation writes no folder; remedy: case.simulation(out=DIR)")
        return Run(self._out)

    def _end_others(self, error):
        """Ends all ranks after an error of this rank: otherwise they would wait for each other in `close` for ever."""
        if error is not None and not self._failure and self.ranks > 1:
            end_all_ranks(type(error), error, error.__traceback__)

    def close(self):
        """Ends the run and completes its folder, if there is one; writes a checkpoint if the end of the case is not
        reached."""
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
