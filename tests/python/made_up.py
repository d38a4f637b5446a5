#!/usr/bin/python3
"""Made-up series of values whose limit is 0: the fraction of intervals that contain it, and the widths of intervals.

Usage: PYTHONPATH=python tests/python/made_up.py [COUNT]    prints the table of docs/theory/uncertainty.md; 3 minutes
"""
import sys

import numpy as np
from tailwater.uncertainty import estimate

H = 0.01 * 2 ** np.linspace(0, 1, 7)  # the seven spacings of a study
STARTS = 3  # other starts at the second coarsest spacing


def sign(random):
    return random.choice([-1, 1])


# Error as a function of x, the spacing over the coarsest one.
FAMILIES = {
    "a x + b x^2 of one sign": lambda x, random: sign(random) * (random.uniform(0, 1) * x + random.uniform(0, 1) * x**2),
    "a x + b x^2 of either sign": lambda x, random: random.uniform(-1, 1) * x + random.uniform(-1, 1) * x**2,
    "x^p, p from 0.5 to 2.5": lambda x, random: sign(random) * x ** random.uniform(0.5, 2.5),
    "a x^2 + b x^3": lambda x, random: random.uniform(-1, 1) * x**2 + random.uniform(-1, 1) * x**3,
    "a x + b x^2 + c x^3, normal": lambda x, random: random.normal(size=3) @ [x, x**2, x**3],
    "a x + b x^2 and scatter up to 0.3": lambda x, random: (random.uniform(-1, 1) * x + random.uniform(-1, 1) * x**2
                                                            + random.uniform(0, 0.3) * random.normal(size=x.size)),
}
# Errors for which the method may fail.
HARD = {
    "a x^0.5 + b x^1.5": lambda x, random: random.uniform(-1, 1) * x**0.5 + random.uniform(-1, 1) * x**1.5,
    "x - b x^2, b from 0.5 to 1": lambda x, random: sign(random) * (x - random.uniform(0.5, 1) * x**2),
}
CHANCES = (0, 0.1, 0.3, 1)  # largest standard deviation over the largest error


def found(error_of, chance, random, of_step=0.0):
    """(Estimate, largest error) of one series. `of_step` is the first-order error of the time step at the coarsest
    spacing; half of the time step is run at the second coarsest spacing."""
    x = H / H[-1]
    error = error_of(x, random) + of_step * x
    largest = abs(error).max()
    deviation = random.uniform(0, chance) * largest
    values = error + deviation * random.normal(size=H.size)
    others = error[-2] + deviation * random.normal(size=STARTS)
    half = error[-2] - 0.5 * of_step * x[-2] + deviation * random.normal()
    return estimate(list(H), list(values), starts={H[-2]: [values[-2], *others]}, step=(H[-2], half)), largest


def shares(error_of, chance, count, steps=0.0, seed=1):
    """For `count` series, the fraction of intervals that contain 0, and their median half width over the largest error;
    then both numbers for the method of Eca & Hoekstra. `steps` is the largest error of the time step."""
    random = np.random.default_rng(seed)
    all_found = [found(error_of, chance, random, steps * random.uniform(-1, 1)) for _ in range(count)]
    inside = [one.low <= 0 <= one.high for one, _ in all_found]
    theirs = [abs(one.value) <= one.eca_hoekstra for one, _ in all_found]
    return (np.mean(inside), np.median([one.uncertainty / largest for one, largest in all_found]),
            np.mean(theirs), np.median([one.eca_hoekstra / largest for one, largest in all_found]))


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 400
    words = [f"chance up to {100 * chance:g} %" if chance else "no chance" for chance in CHANCES]
    print(f"| error | {' | '.join(words)} |\n| --- |{' --- |' * len(CHANCES)}")
    for name, error_of in {**FAMILIES, **HARD}.items():
        cells = []
        for chance in CHANCES:
            inside, half, theirs, their_half = shares(error_of, chance, count)
            cells.append(f"{100 * inside:.0f} %, {half:.2f} ({100 * theirs:.0f} %, {their_half:.2f})")
        print(f"| {name} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
