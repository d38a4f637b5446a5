#!/usr/bin/python3
"""A dam break computed by a program that was written from docs/theory/time_step.md alone, beside a run of tailwater.

Usage: scripts/time_step_check.py [PROGRAM]    PROGRAM: the tailwater to compare with (default: build/release/bin/tailwater)
The run goes to out/time_step_check. Prints the rms difference of the pressure at the particles over the rms pressure, for
the instants of the run's fields. Takes 15 s of CPU time. The numbers in comments are the stages of the page.
"""
import pathlib
import subprocess
import sys

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import spsolve
from scipy.spatial import cKDTree

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "out" / "time_step_check"
DX, COLUMN, TANK, END = 0.04, (1.2, 0.6), (3.2, 1.6), 1.0  # m, s
RADIUS, VOLUME = 3 * DX, DX**2
DENSITY, VISCOSITY, GRAVITY = 1000.0, 1e-6, np.array([0.0, -9.81])
HEIGHT = COLUMN[1]
REFERENCE_SPEED = np.sqrt(2 * 9.81 * HEIGHT)
CASE = f"""\
particles.spacing = {DX}
time.end = {END}
output.fields_interval = 0.1
[[fluid]]
min = [0, 0]
max = [{COLUMN[0]}, {COLUMN[1]}]
[[wall]]
points = [[0, {TANK[1]}], [0, 0], [{TANK[0]}, 0], [{TANK[0]}, {TANK[1]}]]
"""


def kernel(r):
    return 7 / (np.pi * RADIUS**2) * np.maximum(0, 1 - r / RADIUS) ** 4 * (1 + 4 * r / RADIUS)


def steepness(r):
    return 140 / (np.pi * RADIUS**4) * np.maximum(0, 1 - r / RADIUS) ** 3


def lattice_sums():
    """C_0 and c_0."""
    nodes = DX * np.arange(-4, 5)
    r = np.hypot(*np.meshgrid(nodes, nodes)).ravel()
    return VOLUME * kernel(r).sum(), 2 * VOLUME * steepness(r[r > 0]).sum()


def air_table():
    """Fraction missing and factor phi of 32 depths, from R to DX/2."""
    points = (np.arange(2000) + 0.5) * RADIUS / 2000
    plane = np.array([steepness(np.hypot(points, z)).sum() for z in points])
    rows = []
    for depth in np.linspace(RADIUS, 0.5 * DX, 32):
        above = points > depth
        missing = plane[above].sum()
        beyond = ((points[above] - depth) * plane[above]).sum()
        rows.append((missing / (2 * plane.sum()), 1 + beyond / (depth * missing) if missing > 0 else 1.0))
    return np.array(rows).T


def dummies():
    """Positions and tensors P_w: nodes of the lattice outside the tank, which is open above."""
    width, height = (round(side / DX) for side in TANK)
    nodes = [(i, j) for j in range(-3, height) for i in range(-3, width + 3) if j < 0 or not 0 <= i < width]
    position = [((i + 0.5) * DX, (j + 0.5) * DX) for i, j in nodes]
    return np.array(position), np.array([np.diag([float(not 0 <= i < width), float(j < 0)]) for i, j in nodes])


class Flow:
    def __init__(self):
        columns, rows = (round(side / DX) for side in COLUMN)
        water = [((i + 0.5) * DX, (j + 0.5) * DX) for j in range(rows) for i in range(columns)]
        walls, self.blocked = dummies()
        self.C_0, self.c_0 = lattice_sums()
        self.air = air_table()
        self.x = np.vstack([water, walls])
        self.fluid = len(water)
        self.size = len(self.x)
        self.is_fluid = np.arange(self.size) < self.fluid
        self.u = np.zeros((self.size, 2))
        self.time, self.rise, self.eta = 0.0, 0.0, 1.0
        self.locate()
        tau, speed = self.step_length()
        self.p = self.project(tau, speed)[0]

    def sums(self, terms):
        """Sums of the terms of pairs, by particle i."""
        flat = terms.reshape(len(terms), -1)
        columns = [np.bincount(self.i, flat[:, k], self.size) for k in range(flat.shape[1])]
        return np.stack(columns, -1).reshape((self.size, *terms.shape[1:]))

    def means(self, field):
        """Kernel means of a field over the fluid in reach of wet dummies; 0 elsewhere."""
        weights = self.W_fluid.reshape((-1,) + (1,) * (field.ndim - 1))
        total = np.where(self.is_wet, self.weight, 1.0).reshape((-1,) + (1,) * (field.ndim - 1))
        return np.where(self.is_wet.reshape(total.shape), self.sums(weights * field) / total, 0.0)

    def locate(self):  # 12
        pairs = cKDTree(self.x).query_pairs(RADIUS * (1 - 1e-12), output_type="ndarray")
        pairs = pairs[self.is_fluid[pairs].any(axis=1)]
        i, j = self.i, self.j = np.r_[pairs[:, 0], pairs[:, 1]], np.r_[pairs[:, 1], pairs[:, 0]]
        d = self.d = self.x[i] - self.x[j]
        r = self.r = np.hypot(*d.T)
        W, F = self.W, self.F = kernel(r), steepness(r)
        self.chi = np.minimum(1, r / (0.1 * DX))
        self.W_fluid = W * self.is_fluid[j]
        self.weight = self.sums(self.W_fluid)
        self.is_wet = ~self.is_fluid & (self.weight > 1e-6 * kernel(0.0))
        self.C = np.where(self.is_fluid, (VOLUME * kernel(0.0) + self.sums(VOLUME * W)) / self.C_0, 1.0)
        self.K = self.sums(VOLUME * F[:, None, None] * d[:, :, None] * d[:, None, :])
        self.K[self.fluid:] = np.eye(2)
        own = kernel(0.0)
        mean = (own * self.C + self.sums(self.W_fluid * self.C[j])) / (own + self.weight)
        h = np.clip((mean - 0.94) / 0.04, 0, 1)
        s = self.s = np.where(self.is_fluid, h * h * (3 - 2 * h), 0.0)
        self.s_mean = self.sums(self.W_fluid * s[j]) / np.maximum(self.weight, 1e-300)
        self.find_pair_vectors()

    def find_pair_vectors(self):
        i, j, d, s = self.i, self.j, self.d, self.s
        weight = s[j] * (1 - self.r**2 / RADIUS**2)
        inside = s > 0
        total = (s + self.sums(weight))[inside, None, None]
        mean = (s[:, None, None] * self.K + self.sums(weight[:, None, None] * self.K[j]))[inside] / total
        B = np.tile(np.eye(2), (self.size, 1, 1))
        share = s[inside, None, None]
        B[inside] = (1 - share) * np.eye(2) + share * np.linalg.inv(mean)
        corrected = np.einsum("kab,kb->ka", 0.5 * (B[i] + B[j]), d)
        faces = self.sums(VOLUME * self.F[:, None] * corrected)
        divisor = np.maximum(self.sums(VOLUME * self.F), 1e-300)
        closing = np.zeros((self.size, 2))
        for _ in range(3):
            both = 0.5 * faces + self.sums(VOLUME * self.F[:, None] * closing[j])
            closing = np.where(inside[:, None], (s / divisor)[:, None] * both, 0.0)
        self.a = -self.F[:, None] * (corrected - (closing[i] - closing[j]))
        self.open = np.where(inside[:, None], self.sums(VOLUME * self.a), 0.0)

    def step_length(self):  # 1
        u = self.u
        speed = max(np.hypot(*u[:self.fluid].T).max(), REFERENCE_SPEED)
        both = self.is_fluid[self.i] & self.is_fluid[self.j]
        rates = ((u[self.j] - u[self.i]) * self.d).sum(axis=1) / self.r
        approach = min(max(0.0, rates[both].max()), 2 * speed)
        steps = [0.55 * DX / speed, DX**2 / (8 * (VISCOSITY + 0.2 * DX * speed)), 0.9 * DX / max(approach, 1e-300)]
        return min(steps), speed

    def shown(self, velocity):  # 2
        mean = self.means(velocity[self.j])[self.fluid:]
        images = mean - 2 * np.einsum("kab,kb->ka", self.blocked, mean)
        return np.vstack([velocity[:self.fluid], images])

    def forces(self, u, G, speed):  # 3
        i, j, d = self.i, self.j, self.d
        du = u[j] - u[i]
        along = np.maximum(0, -(self.a * d).sum(axis=1)) / self.r**2
        terms = VISCOSITY * ((2 * self.chi * along)[:, None] * du + np.einsum("kba,kb->ka", G[i] + G[j], self.a))
        noise = du + 0.5 * np.einsum("kab,kb->ka", G[i] + G[j], d)
        adding = np.minimum(0, (noise * du).sum(axis=1)) / np.maximum((du**2).sum(axis=1), 1e-38)
        terms += 0.2 * DX * speed * (2 * self.chi * self.F)[:, None] * (noise - adding[:, None] * du)
        force = self.sums(VOLUME * terms * self.is_fluid[j][:, None])
        force[self.fluid:] = 0
        return force

    def velocity_gradient(self, u):
        du = u[self.j] - u[self.i]
        sums = self.sums((VOLUME * self.F)[:, None, None] * du[:, :, None] * self.d[:, None, :])
        share = np.clip((np.linalg.eigvalsh(self.K)[:, 0] - 0.3) / 0.2, 0, 1)
        inverse = np.zeros_like(self.K)
        inverse[share > 0] = np.linalg.inv(self.K[share > 0])
        share = share[:, None, None]
        G = -sums @ (share * inverse + (1 - share) * np.eye(2))
        G[self.fluid:] = 0
        return G

    def source(self, predicted, G, tau, speed):  # 4, 5
        target = 0.5 * tau * np.einsum("kab,kba->k", G, G)
        divergence = self.sums(VOLUME * ((predicted[self.j] - predicted[self.i]) * self.a).sum(axis=1))
        h = np.clip(1 - 2 * distances(self.x[:self.fluid]).min(axis=1) / DX, 0, 1)
        behind = np.zeros(self.size)
        behind[:self.fluid] = 0.25 * h * h * (3 - h)
        error = self.C - 1
        answered = np.where(error < 0, 1.5 * self.s, self.eta) * error + behind
        return -DENSITY / tau * (divergence - target) + DENSITY / tau**2 * 0.05 * speed * tau / DX * answered

    def project(self, tau, speed):
        """Pressure, predicted velocity, force of stage 3, velocity with that of the dummies."""
        i, j = self.i, self.j
        u = self.shown(self.u)
        G = self.velocity_gradient(u)
        force = self.forces(u, G, speed)
        predicted = self.shown(u + tau * force)
        b = self.source(predicted, G, tau, speed)
        takes_part = self.is_fluid | self.is_wet  # 6
        c = 2 * self.chi * VOLUME * self.F * takes_part[j] * self.is_fluid[i]
        missing = np.maximum(0, self.c_0 - self.sums(c))
        inside = 4 * (self.open**2).sum(axis=1) + 1e-4 / DX**2
        air = (1 - self.s) * np.interp(missing / self.c_0, *self.air) * missing + self.s * inside
        diagonal = np.where(self.is_fluid, self.sums(c) + air, 1.0)
        excess = DENSITY * self.means(self.d) @ GRAVITY
        of_dummies = np.where(self.is_wet[i], self.W_fluid / np.where(self.is_wet, self.weight, 1.0)[i], 0.0)
        weights = np.where(self.is_fluid[i], c / diagonal[i], of_dummies)
        matrix = sparse.csr_matrix((weights, (i, j)), shape=(self.size, self.size))
        right = np.where(self.is_fluid, b / diagonal, excess)
        unit = sparse.identity(self.size)
        rough = spsolve((unit - matrix).tocsc(), right)  # 7
        kept = np.where((rough < 0) & (self.s < 1), self.s, 1.0)
        p = spsolve((unit - sparse.diags(kept) @ matrix).tocsc(), kept * right)
        walls = np.maximum(0, self.means(p[j]) + excess)  # 8
        return np.where(self.is_fluid, p, np.where(self.is_wet, walls, 0.0)), predicted, force, u

    def energies(self):
        kinetic = 0.5 * DENSITY * VOLUME * (self.u[:self.fluid] ** 2).sum()
        return kinetic, kinetic + DENSITY * VOLUME * 9.81 * self.x[:self.fluid, 1].sum()

    def step(self):
        water = slice(self.fluid)
        tau, speed = self.step_length()
        before = self.energies()[1]
        self.p, predicted, force, u = self.project(tau, speed)
        gradient = self.sums(VOLUME * (self.p[self.i] + self.p[self.j])[:, None] * self.a)
        self.u = predicted
        self.u[water] += tau * (GRAVITY - gradient[water] / DENSITY)  # 9
        start = self.x[water].copy()
        moved, self.u[water] = keep_off_walls(start + tau * self.u[water], start, self.u[water])  # 10
        pairing = 1 + 0.2 * (self.W / kernel(DX)) ** 4  # 11
        crowding = -self.sums((VOLUME * self.F * pairing)[:, None] * self.d)
        kept = self.s * np.clip(4 * self.s_mean - 3, 0, 1)
        fastest = np.hypot(*self.u[water].T).max()
        shift = (-min(3 * fastest * tau, DX) * DX * kept[:, None] * crowding)[water]
        shift /= np.sqrt(1 + (shift**2).sum(axis=1) / (0.2 * DX) ** 2)[:, None]
        self.x[water] = keep_off_walls(moved + shift, moved, self.u[water])[0]
        self.locate()
        self.time += tau
        viscous = (DENSITY * VOLUME * force * tau * (u + 0.5 * tau * force))[water].sum()  # 13
        kinetic, after = self.energies()
        fading = np.exp(-1.4 * tau * REFERENCE_SPEED / HEIGHT)
        self.rise = max(0.0, fading * self.rise + after - before - 1.25 * max(0.0, viscous))
        available = 0.5 * DENSITY * VOLUME * self.fluid * 9.81 * HEIGHT + kinetic
        self.eta = max(0.0, 1 - self.rise / (1e-4 * available)) ** 2


def distances(x):
    """From the left, right and lower wall."""
    return np.stack([x[:, 0], TANK[0] - x[:, 0], x[:, 1]], axis=1)


def keep_off_walls(x, before, u):
    normals = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]])
    for _ in range(2):
        wall = distances(x).argmin(axis=1)
        each = np.arange(len(x))
        present = distances(x)[each, wall]
        gap = np.clip(distances(before)[each, wall], 0.01 * DX, 0.5 * DX)
        touches = ((present < 0.5 * DX) & (present < gap))[:, None]
        share = gap / (2 * gap - present)
        n = normals[wall]
        x = np.where(touches, x + (share * gap - present)[:, None] * n, x)
        u = np.where(touches, u - ((1 - share) * np.minimum(0, (u * n).sum(axis=1)))[:, None] * n, u)
    return x, u


def main(arguments):
    program = pathlib.Path(arguments[0] if arguments else ROOT / "build/release/bin/tailwater").resolve()
    sys.path.insert(0, str(program.parents[1] / "lib/python3/dist-packages"))
    import tailwater as tw
    OUT.mkdir(parents=True, exist_ok=True)
    (OUT / "dam.toml").write_text(CASE, encoding="utf-8")
    subprocess.run([program, "run", OUT / "dam.toml", "--out", OUT / "run", "--force", "--quiet", "-n", "1"], check=True)
    run = tw.Run(OUT / "run")
    flow = Flow()
    states = [(0.0, flow.x[:flow.fluid].copy(), flow.p[:flow.fluid])]
    while flow.time < END:
        flow.step()
        states.append((flow.time, flow.x[:flow.fluid].copy(), flow.p[:flow.fluid]))
    for time in run.times:
        frame = run.at(time)
        own_time, x, p = min(states, key=lambda state: abs(state[0] - frame.time))
        distance, nearest = cKDTree(x).query(frame.position[:flow.fluid, :2])
        same = distance < 0.3 * DX
        theirs = frame["pressure"][:flow.fluid][same]
        difference = np.sqrt(np.mean((theirs - p[nearest[same]]) ** 2) / np.mean(theirs**2))
        print(f"t = {frame.time:.4f} s ({own_time:.4f} s): {100 * difference:.2f} %, {same.mean():.3f} of the particles matched")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
