"""Connectivity of the particles of a run."""

from collections import Counter

import numpy as np


def detached(position, reach):
    """Number of particles (2D) that are not connected to the largest body of water. Particles are connected if they
    are in the same cell or in neighbouring cells of width `reach`."""
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
