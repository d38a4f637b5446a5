#!/usr/bin/python3
"""Forecast of the time per step on many ranks: the last table of docs/scaling.md.

    T = c n (1 + loss) + messages x latency + bytes/bandwidth + multigrid

n particles per rank. c, loss, bytes per ghost, exchanges per step and iterations are measured (docs/scaling.csv, and
scaling_3d.csv); latency and bandwidth are those of a usual cluster, assumed. A W cycle visits level k 2^k times. Each
visit exchanges ghosts, until the level is gathered: each of its visits gathers it, and all ranks do its work.
Usage: scripts/scaling_model.py
"""
import csv
import math
import pathlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
LATENCY, BANDWIDTH = 2e-6, 10e9  # s per message, bytes/s: assumed
LAYER = 3.6  # dx; support and skin: ghosts lie this far around a rank's particles
REDUCTIONS = 30  # per step outside the solves; 3 more per iteration
NEIGHBOURS = {2: 8, 3: 26}
GATHERED_ROWS = 1024  # of src/linear/cell_multigrid.cpp
CELLS = 1.1  # over particles/2^d: those at borders are not full
COARSENING = {2: 4, 3: 8}  # unknowns from level to level
ROW_VISIT = {2: 25e-9, 3: 60e-9}  # s per row and visit of a level: cycles in a profile of the first steps
# While a run starts (docs/scaling.md): per particle and row of the walls of a rank, and per cell of the box around the
# walls, which is on all ranks.
START_BYTES, ROW_BYTES, CELL_BYTES = 420, 530, 8
ROWS = {2: lambda n: 33 * n ** (1 / 2), 3: lambda n: 27 * n ** (2 / 3)}  # of a tank as there


def read(name):
    with (ROOT / "docs" / name).open() as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def ghosts(n, dimension):
    edge = n ** (1 / dimension)
    return (edge + 2 * LAYER) ** dimension - n


def levels(fluid, dimension):
    """That are not gathered."""
    return max(1, math.ceil(math.log(CELLS * fluid / GATHERED_ROWS, COARSENING[dimension])))


def exchanges_of_cycle(count):
    """Exchanges of a W cycle over so many levels: each visit exchanges before the residual goes down and before the sweep back,
    and between the halves of the W, unless the next level is gathered."""
    return 3 * (2**count - 1) - 2 ** (count - 1)


class Model:
    def __init__(self, dimension, rows):
        self.dimension = dimension
        largest = max(row["particles"] for row in rows)
        alone, two = (next(row for row in rows if row["particles"] == largest and row["ranks"] == ranks)
                      for ranks in (1, 2))
        self.c = alone["seconds_per_step"] / largest
        self.loss = 2 * two["seconds_per_step"] / alone["seconds_per_step"] - 1
        self.iterations = two["iterations_per_step"]
        in_cycles = self.iterations * exchanges_of_cycle(levels(two["fluid"], dimension))
        self.exchanges = two["messages_per_step"] / 2 - in_cycles  # one neighbour each
        self.bytes_per_step = two["bytes_per_step"] / 2
        self.ghosts = two["ghosts"] / 2

    def parts(self, particles, ranks):
        n = particles / ranks
        halo = self.exchanges * NEIGHBOURS[self.dimension] * LATENCY
        halo += self.bytes_per_step / self.ghosts * ghosts(n, self.dimension) / BANDWIDTH
        hops = math.log2(ranks)
        sums = (REDUCTIONS + 3 * self.iterations) * hops * LATENCY
        count = levels(particles, self.dimension)
        messages = exchanges_of_cycle(count) * NEIGHBOURS[self.dimension] * LATENCY
        coarsening = COARSENING[self.dimension]
        rows = CELLS * particles / coarsening**count
        gathered = 2**count * (hops * LATENCY + 4 * rows / BANDWIDTH +
                               ROW_VISIT[self.dimension] * rows / (1 - 2 / coarsening))
        multigrid = self.iterations * (messages + gathered)
        return self.c * n, self.c * n * self.loss, halo, sums, multigrid


def main():
    print("| | particles | ranks | particles per rank | own work, s | lost beside others, s | halo, ms | sums, ms | "
          "multigrid's coarse levels, ms | s per step | efficiency | start, GB per rank |")
    print("| --- " * 12 + "|")
    for dimension, name in ((2, "scaling.csv"), (3, "scaling_3d.csv")):
        model = Model(dimension, read(name))
        for particles, ranks in ((1e7, 1e2), (1e8, 1e3), (1e8, 1e4), (1e9, 1e4)):
            own, lost, halo, sums, multigrid = model.parts(particles, ranks)
            total = own + lost + halo + sums + multigrid
            rows = ROWS[dimension](particles)
            cells = min(2 * particles / 4**dimension, 64 * rows)  # of 4 dx, in a tank half full; src/walls/near_walls.cpp
            start = (START_BYTES * particles + ROW_BYTES * rows) / ranks + CELL_BYTES * cells
            print(f"| {dimension}D | {particles:.0e} | {ranks:.0e} | {particles / ranks:.0e} | {own:.2f} | {lost:.2f} | "
                  f"{1e3 * halo:.1f} | {1e3 * sums:.1f} | {1e3 * multigrid:.0f} | {total:.2f} | {own / total:.0%} | "
                  f"{1e-9 * start:.1f} |")


if __name__ == "__main__":
    main()
