"""Operators on particles, and the pressure equation with a manufactured solution: errors that the tests record."""

from functools import partial

from tailwater.errors import DataError

from .. import panels
from ..checks import Check
from ..metric import Metric
from ..reading import order
from ..runs import TestRun
from ..study import EXACT, Plot, Study

# quantity that the tests record: (words, the least order that they accept)
OPERATORS = {
    "gradient_regular_support3": ("gradient, regular set", 1.9),
    "gradient_jitter0.3_support3": ("gradient, set displaced by 0.3 dx", 0.9),
    "laplacian_regular_support3": ("Laplacian, regular set", 1.9),
    "laplacian_jitter0.3_support3": ("Laplacian, set displaced by 0.3 dx", 0.9),
    "morris_jitter0.3_support3": ("Laplacian of Morris, set displaced by 0.3 dx (theory: -1)", None),
}
POISSON = {
    "poisson_straight_regular": ("pressure linear at the wall, regular set", 1.5),
    "poisson_straight_jitter0.3": ("pressure linear at the wall, set displaced by 0.3 dx", 0.8),
    "poisson_curved_regular": ("pressure curved at the wall, regular set", 0.8),
    "poisson_curved_jitter0.3": ("pressure curved at the wall, set displaced by 0.3 dx", 0.8),
}
DERIVED = "theory and its margin: the comments of {}"


def recorded(quantity, dimension, numbers):
    """{dx: error}. Throws DataError if the tests recorded none."""
    start = f"{quantity}_{dimension}D_dx"
    found = {float(name.removeprefix(start)): value for name, value in numbers.items() if name.startswith(start)}
    if not found:
        raise DataError(f"the tests recorded no {quantity} in {dimension}D")
    return found


def observed_order(quantity, dimension, numbers):
    return order(recorded(quantity, dimension, numbers))


def draw_errors(quantities, dimension, numbers):
    return panels.convergence({words: recorded(quantity, dimension, numbers)
                               for quantity, (words, _) in quantities.items()}, f"rms error, {dimension}D")


def tests_study(name, title, about, quantities, source, run):
    checks = [Check(Metric(f"{name}.{quantity}.{dimension}d", f"{words}, {dimension}D: observed order", "",
                           DERIVED.format(source), low=low), (run,), partial(observed_order, quantity, dimension))
              for quantity, (words, low) in quantities.items() for dimension in (2, 3)]
    drawings = [Plot(f"Errors by spacing in {dimension}D.", (run,), partial(draw_errors, quantities, dimension))
                for dimension in (2, 3)]
    return Study(name, title, EXACT, about,
                 "The functions are known exactly. An order between two spacings carries the next term of the error's series; "
                 "the margins in the tests' comments are derived from it.", tuple(checks), tuple(drawings))


def operators(plan):
    return tests_study(
        "operators", "Derivatives on regular and disordered particles",
        "Gradient and Laplacian of a wave by the consistent operators of Farzin et al. (F9, F12) and by the Laplacian of "
        "Morris, on regular and on displaced sets, h/dx = 3. These are the errors that the program's own tests measure.",
        OPERATORS, "tests/operators/order_test.cpp", TestRun("tests_operators", "operators", "*Order*", 2))


def poisson(plan):
    return tests_study(
        "poisson", "Pressure equation with a manufactured solution",
        "Rows (F23) inside, given pressure on all faces of a unit square or cube but one, the gradient row (F39) on that one. "
        "The gradient row is exact for linear fields only: order 2 where the solution is straight at that wall, 1 where it "
        "curves.", POISSON, "tests/linear/poisson_test.cpp", TestRun("tests_poisson", "linear", "*Poisson*", 5))
