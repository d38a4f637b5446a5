"""Particles of a run: how they hang together."""

from collections import Counter

import numpy as np


def detached(position, reach):
    """How many particles (2D) no chain of others joins with the largest body of water: of cells `reach` wide, neighbours
    join."""
    count = Counter(map(tuple, np.floor(position[:, :2] / reach).astype(int)))
    cells = set(count)
    bodies = []
    while cells:
        waiting, body = [cells.pop()], 0
        while waiting:
            x, y = waiting.pop()
            body += count[x, y]
            near = {(x + dx, y + dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1)} & cells
            cells -= near
            waiting += near
        bodies.append(body)
    return len(position) - max(bodies)
