#!/usr/bin/python3
"""The least time of a step by bytes and operations, beside the measured time: the tables of docs/performance.md.

Counts the reads, writes and operations of each pass over pairs, takes the machine's bandwidth and multiply-adds from the
speed benchmark, and adds up. Bytes are those of arrays with an entry per pair, and of each particle's own once per pass:
its neighbours' are taken to be in a cache.
Usage: benchmarks/floor.py speed/speed.json    of `tailwater bench speed --part modules`
"""
import json
import math
import pathlib
import sys
import textwrap
from dataclasses import dataclass

LINE = 120  # characters
DOUBLE, SINGLE, INDEX = 8, 4, 4  # bytes
# Products of all solves of a step that multigrid should do with: 5 iterations of conjugate gradients, each one product,
# two sweeps and a residual, on levels that add up to a third more than the finest.
FLOOR_PRODUCTS = 5 * 4 * 4 / 3
SET_UP, CYCLE = {2: 15, 3: 4}, {2: 2.6, 3: 0.6}  # products of the multigrid (docs/theory/linear.md)
FIELDS_HELD = 40  # doubles of a particle that must be kept: state, its values before the step, moments, the solver's
FIELDS = 6  # doubles of a particle's own that a pass reads or writes, about


@dataclass(frozen=True)
class Pass:
    """`now` and `floor`: bytes per pair, as the loops are written and as they could be at best (0: joined to another
    pass). `operations`: per pair, a multiply-add counting twice. All as functions of the dimension."""

    name: str
    now: object
    floor: object
    operations: object
    times: float = 1  # in a step


def candidates(d):
    """Particles in the cells of a third of the support that the support reaches from half of a cell, per pair. A search
    for groups compares with more, and finds them at less cost (docs/theory/neighbours.md)."""
    return {2: 46, 3: 278}[d] / 3**d / {2: math.pi, 3: 4 / 3 * math.pi}[d]


SLOPE = 13  # operations: F from the square of the distance, with a root


def pair_vector(d):
    """Operations: the mean of two matrices times a difference, less a difference of vectors, times F."""
    return 3 * d**2 + 3 * d


# At best a pass reads the neighbour's index and computes the rest from the data of both ends in the cache. A pass is joined
# to the one before it unless it needs a result of that one at the neighbours.
PASSES = (
    Pass("search", lambda d: INDEX, lambda d: INDEX, lambda d: 3 * d * candidates(d) + SLOPE),
    # With what shifts go by: the crowding here, the mean of `interior` with the moment correction.
    Pass("kernel sums", lambda d: INDEX, lambda d: 0, lambda d: 2 * d**2 + 5 * d + 8),
    Pass("interior", lambda d: INDEX, lambda d: INDEX, lambda d: 4),
    Pass("moment correction", lambda d: INDEX, lambda d: INDEX, lambda d: 2 * d**2 + 2 * d + 15),
    Pass("closing: pose", lambda d: INDEX + SINGLE, lambda d: INDEX,
         lambda d: 3 * d**2 + 2 * d + 3),
    Pass("closing: two sweeps", lambda d: 2 * (INDEX + SINGLE), lambda d: 2 * INDEX, lambda d: 2 * (2 * d + 1)),
    Pass("closing: close", lambda d: INDEX + SINGLE, lambda d: INDEX,
         lambda d: 5 * d + pair_vector(d)),
    Pass("velocity gradient", lambda d: INDEX, lambda d: 0, lambda d: 2 * d**2 + 2 * d),
    Pass("viscosity and noise", lambda d: INDEX, lambda d: INDEX,
         lambda d: 5 * d**2 + 18 * d + 11 + pair_vector(d)),
    Pass("divergence, source; weights", lambda d: 2 * INDEX + SINGLE,
         lambda d: INDEX + SINGLE, lambda d: 5 * d + 4 + pair_vector(d)),
    Pass("gradient", lambda d: INDEX, lambda d: INDEX, lambda d: 2 * d + 2 + pair_vector(d)),
    Pass("divergence, reported", lambda d: INDEX, lambda d: 0, lambda d: 3 * d + 1 + pair_vector(d), 0.2),
)
AT_BEST_NEVER = "divergence, reported"


def best_times(one):
    return 0 if one.name == AT_BEST_NEVER else one.times


@dataclass(frozen=True)
class Row:
    """A pass of a step; bytes and operations per fluid particle, times in ns per fluid particle."""

    name: str
    now_bytes: float
    best_bytes: float
    best_operations: float
    now: float
    best: float


def rows(d, pairs, iterations, bandwidth, multiply_adds):
    """One per pass, then the solve. `bandwidth` in bytes per ns, `multiply_adds` in operations per ns."""
    own = FIELDS * DOUBLE
    found = []

    def add(name, now_bytes, best_bytes, operations, best_operations):
        found.append(Row(name, now_bytes, best_bytes, best_operations,
                         max(now_bytes / bandwidth, operations / multiply_adds),
                         max(best_bytes / bandwidth, best_operations / multiply_adds)))

    for one in PASSES:
        operations, floor = pairs * one.operations(d), one.floor(d)
        add(one.name, one.times * (pairs * one.now(d) + own), best_times(one) * (pairs * floor + (own if floor else 0)),
            one.times * operations, best_times(one) * operations)
    # Orthomin applies the matrix and the multigrid once an iteration, and the matrix once more in each of two solves.
    entries, vectors = pairs * (SINGLE + INDEX), 2 * DOUBLE
    products = SET_UP[d] + 2 + (1 + CYCLE[d]) * iterations
    best_products = min(products, FLOOR_PRODUCTS)
    add("pressure solves", products * (entries + vectors), best_products * (entries / 2 + vectors),
        products * 2 * pairs, best_products * 2 * pairs)
    return found


def memory(d, pairs, numbers, label):
    """A sentence on bytes per fluid particle: held now, and held by the best arrangement."""
    parts = (("rows", INDEX * pairs), ("half a matrix", (SINGLE + INDEX) * pairs / 2),
             ("fields", DOUBLE * FIELDS_HELD))
    now = {name: numbers[f"{label}.bytes.{name}"] for name in ("all", "pairs", "pair_vectors", "matrix")}
    return (f"Memory, bytes per fluid particle: now {now['all']:.0f} (pairs {now['pairs']:.0f}, pair vectors "
            f"{now['pair_vectors']:.0f}, matrix {now['matrix']:.0f}); at best {sum(part for _, part in parts):.0f} ("
            + ", ".join(f"{name} {part:.0f}" for name, part in parts) + ").")


def table(d, numbers):
    """Markdown for one dimension, or nothing if the benchmark has no modules of it."""
    sizes = sorted({name.split(".")[1] for name in numbers if name.startswith(f"modules.{d}D ")},
                   key=lambda size: float(size.split()[1]))
    if not sizes:
        return ""
    label = f"modules.{sizes[-1]}"
    pairs, iterations = numbers[f"{label}.pairs"], numbers[f"{label}.step/whole.iterations"]
    found = rows(d, pairs, iterations, numbers["machine/triad"], numbers["machine/multiply_add"])
    lines = [f"{d}D, {float(sizes[-1].split()[1]):.0f} particles, {pairs:.1f} pairs per fluid particle, "
             f"{iterations:.1f} iterations per step:", "",
             "| pass | bytes now | bytes at best | operations at best | ns by bytes and operations now | at best |",
             "| --- " * 6 + "|"]
    total = Row("a step", *(sum(getattr(row, field) for row in found)
                            for field in ("now_bytes", "best_bytes", "best_operations", "now", "best")))
    for row in (*found, total):
        lines.append(f"| {row.name} | {row.now_bytes:.0f} | {row.best_bytes:.0f} | {row.best_operations:.0f} | "
                     f"{row.now:.0f} | {row.best:.0f} |")
    measured = numbers[f"{label}.step/whole"]
    took = (f"Measured: {measured:.0f} ns per fluid particle and step, {measured / total.now:.1f} times what the bytes "
            f"and operations of its loops take, {measured / total.best:.1f} times the floor.")
    sentences = [textwrap.fill(text, LINE) for text in (took, memory(d, pairs, numbers, label))]
    return "\n".join([*lines, "", sentences[0], "", sentences[1], ""])


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    told = json.loads(pathlib.Path(sys.argv[1]).read_text())
    numbers = {number["name"]: number["value"] for number in told["numbers"]}
    if "machine/triad" not in numbers:
        sys.exit(f"error: {sys.argv[1]} has no modules; remedy: tailwater bench speed --part modules")
    print(f"Commit {told['commit']}, {told['machine']['processor']}: {numbers['machine/triad']:.1f} GB/s, "
          f"{numbers['machine/multiply_add']:.1f} GFlop/s on one core.\n")
    print("\n".join(text for text in (table(2, numbers), table(3, numbers)) if text), end="")


if __name__ == "__main__":
    main()
