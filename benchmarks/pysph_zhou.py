"""Zhou's dam break by PySPH, for beside.py: its incompressible SISPH or its weakly compressible WCSPH. Schemes, steps
and kernels are set as in PySPH's own example of a dam break, but the smoothing length is fixed: with the example's
varying one WCSPH fails at 0.02 m after 1.17 s. Wall particles are as deep as the kernel reaches. Prints one line of
JSON: CPU seconds without the start, simulated seconds, steps, particles, and for each step the time, the pressure on
the wall and the length of water on the vertical at the gauge H1. The pressure is read as Tailwater's probes read it:
the mean over the water weighted by a kernel, 0 where less than half of the kernel's water is there.

Usage: pysph_zhou.py sisph|wcsph DX END FOLDER
"""
import json
import math
import sys
import time

import numpy as np
from pysph.base.kernels import QuinticSpline, WendlandQuintic
from pysph.base.utils import get_particle_array
from pysph.solver.application import Application
from pysph.sph.integrator import PECIntegrator
from pysph.sph.isph.sisph import SISPHScheme
from pysph.sph.scheme import WCSPHScheme

DEPTH, LENGTH, TANK, TOP = 0.6, 1.2, 3.22, 3.0  # m
DENSITY, GRAVITY = 1000.0, 9.81
H_OVER_DX = 1.3
LAYERS = math.ceil(3 * H_OVER_DX)  # the quintic kernel reaches 3 h, Wendland's 2 h
SPEED = math.sqrt(2 * GRAVITY * DEPTH)
SOUND = 10 * SPEED
GAUGE = 0.12  # m; height on the wall that the water runs to
GAUGE_REACH = 3.0  # dx; of the kernel that reads it
LEVEL_AT, LEVEL_WIDTH = 2.725, 3.0  # m; dx, of the strip whose water counts


def centres(begin, end, dx):
    """Centres of cells of about dx between two places."""
    count = round((end - begin) / dx)
    return begin + (np.arange(count) + 0.5) * (end - begin) / count


def lattice(x, y):
    x, y = np.meshgrid(x, y)
    return x.ravel(), y.ravel()


class Zhou(Application):
    def __init__(self, scheme, dx, end, folder):
        self.scheme_name, self.dx, self.end = scheme, dx, end
        self.steps, self.begun, self.readings = 0, None, []
        super().__init__(fname="zhou", output_dir=folder)

    def create_particles(self):
        dx = self.dx
        behind = (np.arange(LAYERS) + 0.5) * dx
        along = np.concatenate((-behind[::-1], centres(0, TANK, dx), TANK + behind))
        up = centres(0, TOP, dx)
        parts = [lattice(along, -behind), lattice(-behind, up), lattice(TANK + behind, up)]
        walls = [np.concatenate(coordinates) for coordinates in zip(*parts)]
        water = lattice(centres(0, LENGTH, dx), centres(0, DEPTH, dx))
        arrays = [get_particle_array(name=name, x=x, y=y, m=DENSITY * dx**2, rho=DENSITY, h=H_OVER_DX * dx)
                  for name, (x, y) in (("fluid", water), ("walls", walls))]
        self.scheme.setup_properties(arrays)
        self.fluid = len(water[0])
        return arrays

    def create_scheme(self):
        if self.scheme_name == "wcsph":
            return WCSPHScheme(["fluid"], ["walls"], dim=2, rho0=DENSITY, c0=SOUND, h0=H_OVER_DX * self.dx, hdx=H_OVER_DX,
                               gy=-GRAVITY, alpha=0.1, beta=0.0, gamma=7.0, hg_correction=True, update_h=False)
        return SISPHScheme(["fluid"], ["walls"], dim=2, nu=0.0, rho0=DENSITY, c0=SOUND, alpha=0.05, gy=-GRAVITY,
                           pref=DENSITY * SOUND**2, internal_flow=False, hg_correction=True, gtvf=True, symmetric=True)

    def configure_scheme(self):
        length = H_OVER_DX * self.dx
        if self.scheme_name == "wcsph":
            self.scheme.configure_solver(kernel=WendlandQuintic(dim=2), integrator_cls=PECIntegrator, adaptive_timestep=True,
                                         n_damp=50, fixed_h=True, dt=0.125 * length / SOUND, tf=self.end, pfreq=10**9)
        else:
            self.scheme.configure_solver(kernel=QuinticSpline(dim=2), dt=0.125 * length / SPEED, tf=self.end,
                                         adaptive_timestep=False, pfreq=10**9)

    def pre_step(self, solver):
        if self.begun is None:
            self.begun = time.process_time()
        self.steps += 1

    def post_step(self, solver):
        water = self.particles[0]
        q = np.minimum(np.hypot(water.x - TANK, water.y - GAUGE) / (GAUGE_REACH * self.dx), 1.0)
        weight = 7 / (np.pi * GAUGE_REACH**2) * (1 - q)**4 * (1 + 4 * q)  # Wendland's, sums to 1/2 beside a full wall
        is_wet = weight.sum() > 0.25
        pressure = float(weight @ water.p / weight.sum()) if is_wet else 0.0
        in_strip = np.count_nonzero(abs(water.x - LEVEL_AT) < LEVEL_WIDTH / 2 * self.dx)
        self.readings.append((solver.t + solver.dt, pressure, in_strip * self.dx / LEVEL_WIDTH))


def main():
    app = Zhou(sys.argv[1], float(sys.argv[2]), float(sys.argv[3]), sys.argv[4])
    app.run(argv=[])
    cpu = time.process_time() - app.begun
    print(json.dumps({"cpu_s": cpu, "simulated_s": app.solver.t, "steps": app.steps, "fluid": app.fluid,
                      "readings": app.readings}))


main()
