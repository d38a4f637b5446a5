"""The exact solutions of the validation satisfy their equations, and made-up runs have the expected scores."""

import cmath
import json
import math
import tempfile
import unittest
from pathlib import Path

import numpy as np

import synthetic_run
from tailwater.errors import DataError
from tailwater.run import Run
from tailwater.tables import read_table
from tailwater_validation import exact_flows, shallow_water

FLOAT32 = 2.0**-23  # relative spacing of the numbers in field files


class RunTest(unittest.TestCase):
    """Writes runs of a given case: frames are [(time, position (n, 2), fields)], tables {file: {column: values}}."""

    def write_run(self, case, frames, tables=None, status="done"):
        parent = tempfile.TemporaryDirectory()
        self.addCleanup(parent.cleanup)
        folder = Path(parent.name)
        for name in ("fields", "probes"):
            (folder / name).mkdir()
        (folder / "case.effective.toml").write_text(case)
        (folder / "summary.json").write_text(json.dumps(
            {"status": status, "message": "it broke" if status == "failed" else "",
             "particles": {"fluid": len(frames[0][1])}}))
        entries = []
        for k, (time, position, fields) in enumerate(frames):
            synthetic_run.write_frame(folder / "fields" / f"{k}.vtp", position.astype(np.float32), **fields)
            entries.append(f'<DataSet timestep="{time}" file="{k}.vtp"/>')
        (folder / "fields" / "fields.pvd").write_text(
            f'<?xml version="1.0"?>\n<VTKFile type="Collection"><Collection>{"".join(entries)}</Collection>'
            "</VTKFile>\n")
        for name, columns in (tables or {}).items():
            np.savetxt(folder / name, np.stack(list(columns.values()), axis=1), delimiter=",", header=",".join(columns),
                       comments="")
        return Run(folder)


def lattice(low, high, dx):
    x, y = np.meshgrid(*(np.arange(a + dx / 2, b, dx) for a, b in zip(low, high)))
    return np.stack([x.ravel(), y.ravel()], axis=1)


TANK = """\
[parameters]
depth = 0.5
[case]
dimension = 2
[physics]
density = 1000.0
gravity = [0.0, -9.81]
[particles]
spacing = 0.05
[[wall]]
shape = "polyline"
points = [[0.0, 1.0], [0.0, 0.0], [0.5, 0.0], [1.0, 0.5], [1.0, 1.0]]
"""


class Tank(RunTest):
    def test_bottom_is_what_is_not_vertical(self):
        run = self.write_run(TANK, [(0.0, np.zeros((1, 2)), {})])
        position = np.array([[0.1, 0.2, 0.0], [0.75, 0.5, 0.0], [0.0, 0.4, 0.0], [1.0, 0.9, 0.0]])
        np.testing.assert_allclose(exact_flows.bottom_distance(run, position),
                                   [0.2, 0.25 / math.sqrt(2), 0.4, 0.4], atol=1e-12)

    def test_known_errors_come_back(self):
        position = lattice((0, 0), (0.25, 0.5), 0.05)  # far from the slope
        pressure = 9810 * (0.5 - position[:, 1]) + 9810 * 0.5 * 0.01
        density = np.where(position[:, 1] < 0.2, 0.003, -1.0)  # 4 dx = 0.2 m
        mass = 1000 * len(position) * 0.05**2
        time = np.linspace(0, 10, 101)
        speed = np.where(time < 5, 1.0, 2e-3) * math.sqrt(9.81 * 0.5)
        level = np.where(time < 5, 0.7, np.where(time == 7, 0.49, 0.5))
        run = self.write_run(TANK, [(10.0, position, {"pressure": pressure, "density_error": density})], {
            "steps.csv": {"time_s": time, "kinetic_J": 0.5 * mass * speed**2},
            "probes/level.csv": {"time_s": time, "connected_m": level}})
        numbers = exact_flows.tank(run)
        self.assertAlmostEqual(numbers["u_rms"], 2e-3, delta=1e-9)
        self.assertAlmostEqual(numbers["pressure_error"], 0.01, delta=2 * FLOAT32)
        self.assertAlmostEqual(numbers["level_error_dx"], 0.2, delta=1e-9)
        self.assertAlmostEqual(numbers["bottom_density"], 0.003, delta=FLOAT32)

    def test_a_failed_run_and_a_missing_field_are_named(self):
        with self.assertRaisesRegex(DataError, "it broke"):
            exact_flows.tank(self.write_run(TANK, [(0.0, np.zeros((1, 2)), {})], status="failed"))
        with self.assertRaisesRegex(DataError, "no pressure"):
            exact_flows.tank(self.write_run(TANK, [(0.0, np.zeros((1, 2)), {})]))


class TaylorGreen(RunTest):
    CASE = """\
[parameters]
U = 2.0
L = 1.0
[case]
dimension = 2
[physics]
density = 1000.0
viscosity = 0.02
[particles]
spacing = 0.1
"""

    def test_field_solves_the_equations(self):
        # Central differences of step h have errors of h^2/6 times a third derivative: (2 pi)^3 U, and (4 pi)^3 for p.
        h, U, nu, rho = 1e-4, 2.0, 0.02, 1000.0
        x = np.array([[0.13, 0.41], [0.77, 0.05], [0.5, 0.9]])
        def at(dx=0.0, dy=0.0, dt=0.0):
            return exact_flows.taylor_green_field(x + [dx, dy], 0.3 + dt, U, 1.0, nu, rho)
        (u, _), (east, pe), (west, pw), (north, pn), (south, ps) = at(), at(h), at(-h), at(0, h), at(0, -h)
        ux, uy = (east - west) / (2 * h), (north - south) / (2 * h)
        laplacian = (east + west + north + south - 4 * u) / h**2
        ut = (at(dt=h)[0] - at(dt=-h)[0]) / (2 * h)
        gradient = np.stack([pe - pw, pn - ps], axis=1) / (2 * h)
        residual = ut + u[:, :1] * ux + u[:, 1:] * uy + gradient / rho - nu * laplacian
        tolerance = h**2 / 6 * U**2 * ((4 * math.pi) ** 3 + 2 * (2 * math.pi) ** 4)
        np.testing.assert_allclose(residual, 0, atol=tolerance + 1e-6)  # the second term is round-off of 1/h^2
        np.testing.assert_allclose(ux[:, 0] + uy[:, 1], 0, atol=tolerance)

    def test_known_errors_come_back(self):
        position = lattice((0, 0), (1, 1), 0.1)
        velocity, pressure = exact_flows.taylor_green_field(position, 0.5, 2.0, 1.0, 0.02, 1000.0)
        rate = 1.1 * 4 * 0.02 * (2 * math.pi) ** 2
        wrong = {"pressure": 0.9 * pressure + 77, "velocity": np.column_stack([1.2 * velocity, 0 * pressure])}
        run = self.write_run(self.CASE, [(0.5, position, wrong)],
                             {"probes/energy.csv": {"time_s": np.array([0.0, 0.5]),
                                                    "kinetic_J": np.array([1.0, math.exp(-0.5 * rate)])}})
        numbers = exact_flows.taylor_green(run)
        # Positions are also stored in single precision: an error of 2 pi/L times their rounding.
        self.assertAlmostEqual(numbers["velocity_error"], 0.2, delta=50 * FLOAT32)
        self.assertAlmostEqual(numbers["pressure_error"], 0.1, delta=50 * FLOAT32)
        self.assertAlmostEqual(numbers["decay_error"], 0.1, places=9)


class StandingWave(unittest.TestCase):
    K, DEPTH, G = math.pi, 0.5, 9.81

    def test_root_without_viscosity(self):
        root = exact_flows.wave_root(self.K, self.DEPTH, 0.0, self.G)
        self.assertAlmostEqual(root, 1j * math.sqrt(self.G * self.K * math.tanh(self.K * self.DEPTH)))

    def test_root_solves_its_equation_and_tends_to_2_nu_k2(self):
        for nu in (1e-6, 1e-4, 5e-3):
            with self.subTest(nu):
                k, h = self.K, self.DEPTH
                s = exact_flows.wave_root(k, h, nu, self.G)
                m = cmath.sqrt(k**2 + s / nu)
                left = (s + 2 * nu * k**2) ** 2 + self.G * k * math.tanh(k * h)
                right = 4 * nu**2 * k**3 * m * math.tanh(k * h) / cmath.tanh(m * h)
                self.assertLess(abs(left - right), 1e-12 * abs(s) ** 2)
                # The right side is (nu k^2)^1.5 sqrt(s) at leading order, times 4, and acts through 2 s.
                self.assertLess(abs(s.real + 2 * nu * k**2), 4 * (nu * k**2) ** 1.5 / abs(s) ** 0.5)

    def test_fit_finds_a_damped_oscillation_and_its_offset(self):
        time, true = np.linspace(0, 6, 100), complex(-0.13, 5.2)
        value = 0.4 + (complex(0.3, -0.7) * np.exp(true * time)).real
        found = exact_flows.fit_oscillation(time, value, complex(-0.09, 5.35))
        self.assertAlmostEqual(found, true, places=9)


class Drop(unittest.TestCase):
    def test_ideal_ellipse_keeps_area_and_energy(self):
        # RK4 with steps of 1e-3 of the time scale: errors of the order 1e-12.
        for a, b, rate in exact_flows.drop_axes([0.5, 1.0, 1.7], 1.3, 1.1, 0.9):
            self.assertAlmostEqual(a * b, 1.1 * 0.9, places=10)
            self.assertAlmostEqual(rate**2 * (a**2 + b**2), 1.3**2 * (1.1**2 + 0.9**2), places=10)

    def test_axes_start_with_the_rate_of_strain(self):
        (a, b, _), = exact_flows.drop_axes([1e-6], 2.0, 1.5, 0.5)
        self.assertAlmostEqual((a - 1.5) / 1e-6, 2.0 * 1.5, delta=1e-4)
        self.assertAlmostEqual((b - 0.5) / 1e-6, -2.0 * 0.5, delta=1e-4)

    def test_semi_axes_of_a_lattice(self):
        dx = 0.01
        position = lattice((-2, -1), (2, 1), dx)
        inside = (position[:, 0] / 2) ** 2 + position[:, 1] ** 2 < 1
        # The cells cut by the outline hold at most the fraction dx (perimeter)/area of the second moments.
        np.testing.assert_allclose(exact_flows.semi_axes(position[inside]), [2, 1], rtol=dx)


class Poiseuille(RunTest):
    GAP, VISCOSITY, FORCE = 2.0, 0.1, 0.3
    CASE = """\
[parameters]
L = 2.0
G = 0.3
[physics]
viscosity = 0.1
[particles]
spacing = 0.1
"""

    def profile(self, y, time):
        return exact_flows.poiseuille_profile(np.asarray(y), time, self.GAP, self.VISCOSITY, self.FORCE)

    def test_obeys_the_equation_and_its_edges(self):
        y, d, dt = np.linspace(0.2, 1.8, 9), 1e-3, 1e-4
        for time in (1.0, 5.0):
            rate = (self.profile(y, time + dt) - self.profile(y, time - dt)) / (2 * dt)
            curvature = (self.profile(y + d, time) - 2 * self.profile(y, time) + self.profile(y - d, time)) / d**2
            # Truncation is d^2/12 of the fourth derivative, below 1e-6; round-off in the curvature about 1e-16/d^2.
            np.testing.assert_allclose(rate, self.FORCE + self.VISCOSITY * curvature, atol=1e-6)
            np.testing.assert_allclose(self.profile([0.0, self.GAP], time), 0, atol=1e-12)
        # The first omitted term is 4/pi^3 G L^2/nu/201^3 = 2e-7 at the start.
        np.testing.assert_allclose(self.profile(y, 0.0), 0, atol=1e-6)
        steady = 0.5 * self.FORCE / self.VISCOSITY * y * (self.GAP - y)
        np.testing.assert_allclose(self.profile(y, 1000.0), steady, rtol=1e-12)

    def test_known_errors_come_back(self):
        position = lattice((0, 0), (1.0, self.GAP), 0.1)
        scale = self.FORCE * self.GAP**2 / (self.VISCOSITY * math.sqrt(120))
        frames = [(0.0, position, {"velocity": np.zeros((len(position), 3))})]
        for time, error in ((1.0, 0.02), (2.0, -0.01)):
            velocity = np.zeros((len(position), 3))
            velocity[:, 0] = self.profile(position[:, 1], time) + error * scale
            velocity[:, 1] = 0.5 * error * scale
            frames.append((time, position, {"velocity": velocity}))
        numbers = exact_flows.poiseuille(self.write_run(self.CASE, frames))
        for name, value in (("profile_error", 0.02), ("steady_error", 0.01), ("across", 0.01)):
            self.assertAlmostEqual(numbers[name], value, delta=4 * FLOAT32)


class Couette(RunTest):
    GAP, VISCOSITY, SPEED = 2.0, 0.1, 1.5
    CASE = """\
[parameters]
L = 2.0
U = 1.5
[physics]
viscosity = 0.1
[particles]
spacing = 0.1
"""

    def profile(self, y, time):
        return exact_flows.couette_profile(np.asarray(y), time, self.GAP, self.VISCOSITY, self.SPEED)

    def test_obeys_the_equation_and_its_edges(self):
        y, d, dt = np.linspace(0.2, 1.8, 9), 1e-3, 1e-4
        for time in (1.0, 5.0):
            rate = (self.profile(y, time + dt) - self.profile(y, time - dt)) / (2 * dt)
            curvature = (self.profile(y + d, time) - 2 * self.profile(y, time) + self.profile(y - d, time)) / d**2
            np.testing.assert_allclose(rate, self.VISCOSITY * curvature, atol=1e-6)  # as above
            np.testing.assert_allclose(self.profile([0.0, self.GAP], time), [0, self.SPEED], atol=1e-12)
        # Before diffusion has reached a tenth of the gap: erfc(0.2/(2 sqrt(0.1 * 0.01))) = 8e-6 of the plate's speed.
        np.testing.assert_allclose(self.profile(y[:-1], 0.01), 0, atol=1e-5 * self.SPEED)

    def test_known_errors_come_back(self):
        position = lattice((0, 0), (1.0, self.GAP), 0.1)
        velocity = np.zeros((len(position), 3))
        velocity[:, 0] = self.profile(position[:, 1], 1.0) - 0.03 * self.SPEED / math.sqrt(3)
        numbers = exact_flows.couette(self.write_run(self.CASE, [
            (0.0, position, {"velocity": 0 * velocity}), (1.0, position, {"velocity": velocity})]))
        self.assertAlmostEqual(numbers["profile_error"], 0.03, delta=4 * FLOAT32)


class UniformFlow(RunTest):
    CASE = """\
[parameters]
h = 0.1
n = 0.012
S = 0.002
ks = 0.0008
ut = 0.044
[physics]
gravity = [0.01962, -9.81]
[particles]
spacing = 0.001
[time]
end = 8.0
"""

    def test_known_errors_come_back(self):
        position = lattice((0, 0), (0.02, 0.1), 0.001)
        velocity = np.zeros((len(position), 3))
        velocity[:, 0] = 0.044 / 0.41 * np.log1p(30 * position[:, 1] / 0.0008)
        frames = [(time, position, {"velocity": velocity * (1 - 0.02 * (8 - time))}) for time in (0.0, 6.0, 7.0, 8.0)]
        numbers = exact_flows.uniform_flow(self.write_run(self.CASE, frames))
        mean = velocity[:, 0].mean()
        # The mean of the factors 0.96, 0.98 and 1 is 0.98, and they rise by 0.02 per second.
        self.assertAlmostEqual(numbers["keulegan_error"], -0.02, delta=1e-3)  # mean over particles instead of y
        self.assertAlmostEqual(numbers["depth_error"], 0.1 / (0.98 * mean * 0.1 * 0.012 / 0.002**0.5) ** 0.6 - 1, delta=1e-5)
        self.assertAlmostEqual(numbers["stress_error"], -0.02 * mean * 0.1 / 0.044**2, delta=1e-4)
        self.assertGreater(numbers["profile_error"], 0.01)


class Jet(unittest.TestCase):
    def test_takes_the_momentum_of_the_jet(self):
        # The force on the plate is rho U^2 b: the integral of p/(rho U^2/2) over x/b is 2.
        x = np.linspace(0, 20, 200001)
        pressure = exact_flows.jet_pressure(x)
        self.assertAlmostEqual(pressure[0], 1.0, delta=1e-8)
        self.assertAlmostEqual(2 * float(np.sum(pressure) - 0.5) * 1e-4, 2.0, delta=1e-4)
        np.testing.assert_array_less(np.diff(pressure), 1e-12)

    def test_the_impulse_is_that_of_the_series(self):
        # P(0) = rho U b sum over odd k of +-4/(k pi)^2.
        k = np.arange(2000)
        self.assertAlmostEqual(exact_flows.JET_IMPULSE, float(np.sum(4 * (-1.0) ** k / ((2 * k + 1) * math.pi) ** 2)), delta=1e-7)


class Slot(RunTest):
    CASE = """\
[parameters]
a = 0.1
B = 0.4
V = 0.15465
[case]
dimension = 2
[physics]
density = 1000.0
gravity = [0.0, 0.0]
[particles]
spacing = 0.01
[time]
end = 1.2
"""

    def test_contraction_is_kirchhoffs_of_a_wide_channel_and_von_mises_of_others(self):
        self.assertAlmostEqual(exact_flows.slot_contraction(1e-6), math.pi / (math.pi + 2), delta=1e-5)
        # von Mises' table
        for share, contraction in ((0.1, 0.612), (0.3, 0.622), (0.5, 0.644), (0.7, 0.687), (0.9, 0.781)):
            self.assertAlmostEqual(exact_flows.slot_contraction(share), contraction, delta=6e-4)

    def test_known_errors_come_back(self):
        position = lattice((0.0, 0.0), (0.5, 0.06), 0.01)
        velocity = np.zeros((len(position), 3))
        velocity[:, 0] = 1.02
        frames = [(time, position, {"velocity": velocity}) for time in (0.0, 0.9, 1.2)]
        time = np.linspace(0, 1.2, 50)
        pressure = np.full(50, 1.03 * 0.5 * 1000 * (1.02**2 - 0.15465**2))
        numbers = exact_flows.slot(self.write_run(self.CASE, frames, {"probes/channel.csv": {
            "time_s": time, "pressure_Pa": pressure}}))
        self.assertAlmostEqual(numbers["contraction_error"], 1 / 1.02 - 1, delta=1e-3)
        self.assertAlmostEqual(numbers["thickness_error"], 0.6 / 0.6186 - 1, delta=1e-3)
        self.assertAlmostEqual(numbers["pressure_error"], 0.03, delta=1e-6)


class WaterWedge(RunTest):
    CASE = """\
[parameters]
D = 0.1
U = 2.0
[physics]
density = 1000.0
gravity = [0.0, 0.0]
[particles]
spacing = 0.01
[[probe]]
name = "p0"
type = "wall-pressure"
at = [0.0, 0.0]
[[probe]]
name = "p1"
type = "wall-pressure"
at = [0.15, 0.0]
[[probe]]
name = "beyond"
type = "wall-pressure"
at = [0.25, 0.0]
[[probe]]
name = "force"
type = "force"
"""

    def test_known_errors_come_back(self):
        theory = read_table(exact_flows.WEDGE_PRESSURE)
        x, pressure = theory["x_over_Ut"], theory["pressure"]
        time = np.linspace(0.001, 0.05, 400)

        def gauge(place, factor):
            return {"time_s": time, "pressure_Pa": 4000 * factor * np.interp(place / (2 * time), x, pressure)}

        force = 2 * float(np.sum((pressure[1:] + pressure[:-1]) / 2 * np.diff(x)))
        numbers = exact_flows.water_wedge(self.write_run(self.CASE, [(0.0, np.zeros((1, 2)), {})], {
            "probes/p0.csv": gauge(0.0, 0.97), "probes/p1.csv": gauge(0.15, 1.0), "probes/beyond.csv": gauge(0.25, 0.5),
            "probes/force.csv": {"time_s": time, "force_y_N_per_m": -0.9 * force * 8000 * time}}))
        self.assertAlmostEqual(numbers["middle_error"], -0.03, places=9)
        self.assertAlmostEqual(numbers["pressure_error"], 0.03 / math.sqrt(2), places=9)
        self.assertAlmostEqual(numbers["force_error"], -0.1, places=9)

    def test_the_theory_is_between_what_is_known(self):
        """Wagner's theory, for blunt wedges, gives pi/(2 tan 30 deg) in the middle, which is too low for a sharper
        wedge."""
        theory = read_table(exact_flows.WEDGE_PRESSURE)
        self.assertLess(2.72, theory["pressure"][0])
        # The jet's root is where the pressure is highest; a particle that turns round there leaves at twice its speed.
        root = theory["x_over_Ut"][np.argmax(theory["pressure"])]
        self.assertAlmostEqual(float(theory["pressure"].max()) / (0.5 * root**2), 1.0, delta=0.25)


class WedgeEntry(RunTest):
    def test_known_errors_come_back(self):
        time = np.linspace(0.0, 0.05, 400)
        case = "[parameters]\nD = 0.1\nV = 2.0\n[physics]\ndensity = 1000.0\n"
        run = self.write_run(case, [(0.0, np.zeros((1, 2)), {})], {
            "probes/force.csv": {"time_s": time, "force_y_N_per_m": 0.93 * exact_flows.ENTRY_FORCE * 8000 * time}})
        self.assertAlmostEqual(exact_flows.wedge_entry(run)["force_error"], -0.07, places=9)


class ShallowDamBreak(RunTest):
    CASE = """\
[parameters]
h0 = 2.0
h1 = 0.4
[physics]
gravity = [0.0, -9.81]
[particles]
spacing = 0.02
"""
    TIMES = (1.0, 3.0, 4.0, 5.0, 6.0)  # T
    DX = 0.01  # over h0: positions and volumes are known to dx, so slopes over T = 3..6 to a third of it

    def columns(self, x, depth):
        """Columns of water particles of this depth (h0) at the positions x (h0)."""
        places = 2.0 * np.repeat(x, np.rint(depth / self.DX).astype(int))
        return np.column_stack([places, places])

    def run_with(self, depth):
        """A run whose surface at the time T is depth(x/h0, T)."""
        scale = math.sqrt(2.0 / 9.81)
        x = np.arange(-8, 13, self.DX) + 0.5 * self.DX
        rows = [np.column_stack([np.full(x.size, T * scale), 2.0 * x, 0 * x, 2.0 * depth(x, T), 2.0 * depth(x, T)])
                for T in self.TIMES]
        names = ("time_s", "x_m", "bed_m", "connected_m", "highest_m")
        return self.write_run(self.CASE, [(T * scale, self.columns(x, depth(x, T)), {}) for T in self.TIMES],
                              {"probes/surface.csv": dict(zip(names, np.concatenate(rows).T))})

    def test_ritter_keeps_mass(self):
        xi = np.linspace(-1, 2, 3001)
        h = shallow_water.ritter(xi)
        u = 2 / 3 * (1 + xi)  # the rarefaction's velocity over sqrt(g h0)
        # -xi h' + (h u)' = 0; differences of parabolas over 0.001 have errors of 1e-6.
        np.testing.assert_allclose(np.gradient(h * u, xi)[1:-1], xi[1:-1] * np.gradient(h, xi)[1:-1], atol=1e-6)
        self.assertEqual(list(shallow_water.ritter([-2, 0, 3])), [1, 4 / 9, 0])

    def test_stokers_bore_keeps_mass_and_momentum(self):
        for ahead in (0.05, 0.2, 0.6):
            depth, speed, bore = shallow_water.stoker_state(ahead)
            self.assertAlmostEqual(bore * (depth - ahead), speed * depth, places=12)
            self.assertAlmostEqual(bore * speed * depth, speed**2 * depth + 0.5 * (depth**2 - ahead**2), places=12)
            self.assertAlmostEqual(speed + 2 * math.sqrt(depth), 2, places=12)  # the invariant of the rarefaction

    def test_uneven_water_makes_a_bore_faster_by_its_momentum(self):
        depth, speed, bore = shallow_water.stoker_state(0.2, 0.02)
        self.assertAlmostEqual(bore * (depth - 0.2), speed * depth, places=12)
        self.assertAlmostEqual(bore * speed * depth, speed**2 * depth + 0.5 * (depth**2 - 0.2**2) + 0.02, places=12)
        self.assertGreater(bore, shallow_water.stoker_state(0.2)[2])

    def test_momentum_of_uneven_water_comes_back(self):
        """Water 0.5 h0 deep, with every other particle faster by 0.4 sqrt(g h0): 0.5 times 0.2^2 more than uniform
        flow."""
        x = np.arange(0, 8, self.DX) + 0.5 * self.DX
        place = self.columns(x, np.full(x.size, 0.5))
        speed = (0.6 + 0.2 * (-1.0) ** np.arange(len(place))) * math.sqrt(2 * 9.81)
        velocity = np.column_stack([speed, 0 * speed, 0 * speed]).astype(np.float32)
        run = self.write_run(self.CASE, [(T * math.sqrt(2 / 9.81), place, {"velocity": velocity}) for T in self.TIMES])
        self.assertAlmostEqual(shallow_water.uneven_momentum(run, 0.6, 0.8), 0.02, delta=0.02 * self.DX)

    def test_theory_has_no_error_and_a_lag_shows_in_the_profile_only(self):
        cases = ((shallow_water.ritter_dam_break, shallow_water.ritter, "gate_error"),
                 (shallow_water.stoker_dam_break, lambda xi: shallow_water.stoker(xi, 0.2), "plateau_error"))
        for score, theory, other in cases:
            numbers = score(self.run_with(lambda x, T, theory=theory: theory(x / T)))
            for name in ("discharge_error", "front_error", other):
                self.assertAlmostEqual(numbers[name], 0, delta=self.DX, msg=name)
            self.assertAlmostEqual(numbers["profile_error"], 0, places=12)
            late = score(self.run_with(lambda x, T, theory=theory: theory((x + 0.1) / T)))
            self.assertAlmostEqual(late["front_error"], 0, delta=self.DX)
            self.assertGreater(late["profile_error"], 1e-3)

    def test_place_of_a_bore_and_its_splash(self):
        x = np.arange(0.005, 10, 0.01)
        bore = np.where(x < 4, 0.5, 0.2)
        self.assertAlmostEqual(shallow_water.place_of_bore(x, bore, 0.2, 0.0), 4, places=9)
        self.assertAlmostEqual(shallow_water.place_of_bore(x, bore, 0.2, 1.0), 4, places=9)
        # A splash 0.1 thick and 0.3 long in front of the bore adds its volume, 0.03/0.3, at most twice.
        splash = np.where((x > 4) & (x < 4.3), 0.3, bore)
        self.assertLess(shallow_water.place_of_bore(x, splash, 0.2, 0.0) - 4, 2 * 0.03 / 0.3)
        self.assertGreater(shallow_water.place_of_bore(x, splash, 0.2, 0.0), 4)

    def test_known_errors_come_back(self):
        numbers = shallow_water.ritter_dam_break(self.run_with(lambda x, T: 1.02 * shallow_water.ritter(x / T)))
        self.assertAlmostEqual(numbers["discharge_error"], 0.02, delta=self.DX)
        self.assertAlmostEqual(numbers["gate_error"], 0.02, delta=self.DX)
        faster = shallow_water.stoker_dam_break(self.run_with(lambda x, T: shallow_water.stoker(x / (1.1 * T), 0.2)))
        self.assertAlmostEqual(faster["front_error"], 0.1, delta=self.DX)

    def rough_run(self, ahead, states, roughness=0.04, front=1.0):
        """A run over a bed of this roughness (m) with the surfaces `states`. Its front is at `front` times theirs."""
        scale = math.sqrt(2.0 / 9.81)
        rows = [np.column_stack([np.full(x.size, T * scale), 2 * x, 0 * x, 2 * h, 2 * h])
                for T, (x, h, _) in zip(self.LATE_TIMES, states)]
        names = ("time_s", "x_m", "bed_m", "connected_m", "highest_m")
        places = [2 * front * shallow_water.front_of(x, h) for x, h, _ in states]
        return self.write_run(
            f"[parameters]\nh0 = 2.0\nh1 = {2 * ahead}\nback = 10.0\nahead = 16.0\n[physics]\ngravity = [0.0, -9.81]\n"
            f"[particles]\nspacing = 0.1\n[[wall]]\nshape = 'polyline'\nroughness = {roughness}\n", [(0.0, np.zeros((1, 2)), {})],
            {"probes/surface.csv": dict(zip(names, np.concatenate(rows).T)),
             "probes/front.csv": {"time_s": scale * np.array(self.LATE_TIMES), "front_m": np.array(places)}})

    LATE_TIMES = (3.0, 3.5, 4.0)

    def test_a_tip_that_is_too_fast_by_a_known_share(self):
        theory, _ = shallow_water.rough_theory(0.0, 0.02, self.LATE_TIMES, 5.0, 8.0)
        numbers = shallow_water.rough_dry_bed(self.rough_run(0.0, theory, front=1.02))
        self.assertAlmostEqual(numbers["front_error"], 0.02, places=6)
        self.assertAlmostEqual(numbers["speed_error"], 0.02, places=6)
        self.assertAlmostEqual(numbers["profile_error"], 0.0, places=6)
        with self.assertRaisesRegex(DataError, "not rough"):
            shallow_water.rough_dry_bed(self.rough_run(0.0, theory, roughness=0.0))

    def run_that_lets_pass(self, volumes):
        """A run over a rough bed with these volumes of water (h0^2) beyond the gate at LATE_TIMES; the last particle is
        crossing it."""
        frames = [(0.0, np.full((1, 2), -1.0), {})]
        for T, volume in zip(self.LATE_TIMES, volumes):
            whole, rest = divmod(volume / (0.1 / 2.0) ** 2, 1)
            places = np.append(np.ones(int(whole)), 0.1 * (rest - 0.5))
            frames.append((T * math.sqrt(2.0 / 9.81), np.column_stack([places, places]), {}))
        return self.write_run("[parameters]\nh0 = 2.0\nh1 = 0.4\nback = 10.0\nahead = 16.0\n[physics]\ngravity = [0.0, -9.81]\n"
                              "[particles]\nspacing = 0.1\n[[wall]]\nshape = 'polyline'\nroughness = 0.04\n", frames)

    def test_water_that_is_held_back_by_a_known_share_too_much(self):
        rough, free = ([shallow_water.volume_ahead(x, h, 0.2) for x, h, _ in states]
                       for states in shallow_water.rough_theory(0.2, 0.02, self.LATE_TIMES, 5.0, 8.0))
        more = [volume - 0.1 * (free_volume - volume) for volume, free_volume in zip(rough, free)]
        runs = self.run_that_lets_pass(more), self.run_that_lets_pass(free)
        self.assertAlmostEqual(shallow_water.held_back_error(*runs), 0.1, places=3)  # positions are in single precision

    def test_too_few_profiles_are_told(self):
        self.TIMES = (1.0, 3.0)
        with self.assertRaisesRegex(DataError, "too few"):
            shallow_water.ritter_dam_break(self.run_with(lambda x, T: shallow_water.ritter(x / T)))


if __name__ == "__main__":
    unittest.main()
