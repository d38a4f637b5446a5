"""Actions of a script on a run: forces on water and bodies, the discharge of an inlet, motions of walls."""

import unittest

import numpy as np
import tailwater as tw
from scipy.optimize import brentq
from small import DAM, DROP, PackageTest

INFLOW = """\
[case]
title = "An inlet fills a tank"
[particles]
spacing = 0.05
[[wall]]
name = "tank"
points = [[0, 0], [1, 0], [1, 1]]
[[inlet]]
name = "spring"
from = [0, 0]
to = [0, 1]
discharge = 0.1
[time]
end = 0.3
"""


PISTON = """\
[case]
title = "A piston makes waves"
[particles]
spacing = 0.025
jitter = 0.1
[[fluid]]
name = "water"
min = [0, 0]
max = [1, 0.2]
[[wall]]
name = "flume"
points = [[-0.2, 0.5], [-0.2, 0], [1, 0], [1, 0.5]]
fluid_side = "left"
[[wave_maker]]
name = "piston"
type = "{type}"
from = [0, 0]
to = [0, 0.5]
depth = 0.2
height = 0.06
period = 0.8
ramp = 0.3
[time]
end = 0.5
"""


class OnWater(PackageTest):
    def free_water(self, hook):
        """(the end, bound of the error of its velocity). The bound follows from the small pressure of the drop, which
        acts on a particle all the time, by its difference over half the distance to the next particle."""
        largest = 0.0
        with tw.Case(self.write("drop.toml", DROP)).simulation() as simulation:
            for step in simulation:
                hook(step)
                largest = max(largest, step.pressure.max())
            end = simulation.now()
            largest = max(largest, end.pressure.max())
            self.assertLess(largest, 1e-3)
            return end.time, end.velocity, 4 * largest / (simulation.density * simulation.spacing) * end.time

    def test_equal_force_moves_free_water_as_a_body(self):
        """The force has no divergence and causes no pressure, so the sum of dt a over the steps is a t."""
        force = np.array([3.0, -2.0])

        def pull(step):
            step.body_force = force

        time, velocity, error = self.free_water(pull)
        self.assertLess(abs(velocity - [1, 0] - time * force).max(), error)

    def test_force_of_zero_changes_nothing(self):
        case = tw.Case(self.write("dam.toml", DAM))
        with case.simulation() as simulation:
            simulation.run()
            expected = simulation.now().position.copy()
        with case.simulation(hook=lambda step: step.body_force[:, 0].sum()) as simulation:
            simulation.run()
            self.assertTrue(np.array_equal(simulation.now().position, expected))

    def test_force_acts_in_one_step_only(self):
        pushes = []

        def pull(step):
            if step.number == 1:
                step.body_force[:, 1] = 1.0
                pushes.append(step.dt)

        _, velocity, error = self.free_water(pull)
        self.assertLess(abs(velocity - [1, pushes[0]]).max(), error)

    def test_folder_says_that_a_script_acted(self):
        with self.assertWarnsRegex(tw.RunWarning, "a script acts on the flow from t = 0.0000 s on"):
            case = tw.Case(self.write("drop.toml", DROP))
            with case.simulation("out", hook=lambda step: step.body_force) as simulation:
                simulation.run()
        self.assertIn("a script acts", tw.Run("out").summary["warnings"][0])


class OnBodies(PackageTest):
    def setUp(self):
        super().setUp()
        # Without the jitter the flow is symmetric, and round-off decides on which side something happens first.
        self.case = tw.Case.template("floating-box").update(
            {"particles.spacing": 0.04, "particles.jitter": 0.1, "time.end": 0.25})

    def without_lines(self):
        text = self.case.save("lines.toml").file.read_text(encoding="utf-8")
        head, _, rest = text.partition("# Lines from its lower corners")
        return tw.Case(self.write("free.toml", head + rest[rest.index("[time]"):]))

    def test_mooring_in_python_is_that_of_the_case(self):
        names = {name: self.case[f"parameters.{name}"] for name in ("L", "B", "h", "m", "up")}
        low = names["h"] - names["m"] / (1000 * names["B"]) + names["up"]
        left, right = names["L"] / 2 - names["B"] / 2, names["L"] / 2 + names["B"] / 2

        def moor(step):
            box = step.bodies["box"]
            for at, anchor in (((left, low), (0, 0)), ((right, low), (names["L"], 0))):
                end = box.place(at)
                way = np.array(anchor) - end
                length = np.linalg.norm(way)
                box.push(max(0.0, 50 * (length - 0.5)) * way / length, at=end)

        def motion(case, hook=None):
            path = []
            with case.simulation(hook=hook) as simulation:
                for step in simulation:
                    box = step.bodies["box"]
                    path.append([step.time, *box.centre, np.arctan2(box.rotation[1, 0], box.rotation[0, 0])])
            return np.array(path)

        # Round-off may cost a solve an iteration, so the tolerance makes this effect negligible. The remaining
        # difference, here 2e-9 to 8e-9 with spacings of 0.035 to 0.045 m, comes from pairs, which are in single
        # precision.
        self.case["pressure_solver.tolerance"] = 1e-8
        moored, pushed = motion(self.case), motion(self.without_lines(), moor)
        self.assertGreater(abs(moored[:, 2] - moored[0, 2]).max(), 1e-4)
        self.assertLess(abs(moored - pushed).max(), np.finfo(np.float32).eps)
        free = motion(self.without_lines())
        self.assertGreater(abs(moored[:len(free)] - free[:len(moored)]).max(), 1e-6)

    def test_velocity_of_a_place_and_moment_of_a_force(self):
        with self.case.simulation() as simulation:
            simulation.run(until=0.03)
            box = simulation.now().bodies["box"]
            self.assertLess(abs(box.velocity_at(box.centre) - box.velocity).max(), 1e-15)
            arm = np.array([0.0, 1.0])
            turned = box.velocity_at(box.centre + arm) - box.velocity
            self.assertLess(abs(turned - [-box.angular_velocity, 0]).max(), 1e-12)
            with self.assertRaisesRegex(tw.InputError, "2 components"):
                box.push([1, 2, 3])
            with self.assertRaisesRegex(KeyError, "the case has box"):
                simulation.now().bodies["boat"]


class AtInlets(PackageTest):
    def test_discharge_is_that_of_the_script(self):
        """The water balance adds dt q in every step."""
        with tw.Case(self.write("inflow.toml", INFLOW)).simulation("out") as simulation:
            asked = 0.0
            for step in simulation:
                discharge = 0.1 + 0.1 * step.time
                step.set_discharge("spring", discharge)
                asked += discharge * step.dt
        books = simulation.result().summary["water_balance"]["inlets"][0]
        self.assertAlmostEqual(books["asked_for_m3"], asked, delta=1e-12)
        self.assertGreater(books["volume_m3"], 0.0)

    def test_inlet_that_is_none(self):
        with tw.Case(self.write("inflow.toml", INFLOW)).simulation() as simulation:
            with self.assertRaisesRegex(tw.InputError, "there is no inlet 'well'"):
                simulation.now().set_discharge("well", 0.1)


class OnWalls(PackageTest):
    def stroke(self, kind, time, height=0.06, period=0.8, depth=0.2, ramp=0.3):
        """Stroke of the plate at the still-water level, m: Dean & Dalrymple (1991), ch. 6, and Schaffer (1996)."""
        omega, k = 2 * np.pi / period, self.wave_numbers(2 * np.pi / period, depth)
        y, shape = k[0] * depth, self.shape_integral(kind, k, depth) * k
        first = height / 2 / (2 * np.tanh(y) * shape[0] / (np.tanh(y) + y / np.cosh(y)**2)).real
        # The sums over modes converge like 1 over their number, so they are extrapolated as in the program.
        of_all, of_half = (self.second_stroke(kind, omega, k[:1 + modes], -1j * first, depth) for modes in (20, 10))
        second = 2 * of_all - of_half
        share = 1 if time >= ramp else (1 - np.cos(np.pi * time / ramp)) / 2
        return share * (first * np.sin(omega * time) + (second * np.exp(2j * omega * time)).real)

    def wave_numbers(self, omega, depth, count=20):
        """Wave numbers of the travelling mode, and -i times those of the modes that decay from the plate, 1/m."""
        deep = omega**2 * depth / 9.81
        found = [brentq(lambda y: y * np.tanh(y) - deep, 1e-3, 99)]
        for j in range(1, count + 1):
            found.append(-1j * brentq(lambda y: y * np.sin(y) + deep * np.cos(y), (j - 0.5) * np.pi, j * np.pi, xtol=1e-14))
        return np.array(found, complex) / depth

    def shape_integral(self, kind, p, h):
        """Integral over the depth of cosh p(z + h)/cosh ph, for a flap times 1 + z/h."""
        return np.tanh(p * h) / p - ((1 - 1 / np.cosh(p * h)) / (p * p * h) if kind == "flap" else 0)

    def second_stroke(self, kind, omega, k, first, h):
        """The complex stroke of twice the frequency with which only the bound wave leaves the plate."""
        free = self.wave_numbers(2 * omega, h, 0)[0]
        norm = (np.tanh(k * h) / k + h / np.cosh(k * h)**2) / 2
        potential = -omega * first * self.shape_integral(kind, k, h) / (k * norm)
        one, other = np.meshgrid(k, k)
        bound = np.outer(potential, potential) * 1j * omega / 9.81 * (-1j * (one + other)) / ((one + other)**2 - free**2) * (
            one * other + (one**2 + other**2) / 4 - 1.5 * (omega**2 / 9.81)**2)
        both = np.cosh(k * h) * np.cosh(free * h)

        def of_sum_and_difference(part):
            return (part(k + free) + part(k - free)) / 2 / both

        plate = potential * k**2 * of_sum_and_difference(lambda r: self.shape_integral(kind, r, h) * np.cosh(r * h))
        if kind == "flap":
            plate += potential * k / h * of_sum_and_difference(lambda r: (np.cosh(r * h) - 1) / r)
        return (bound.sum() - first * plate.sum() / 2) / (2j * omega * self.shape_integral(kind, free, h))

    def motion(self, case, hook=None):
        with case.simulation(hook=hook) as simulation:
            simulation.run()
            end = simulation.now()
            return end.time, end.position[np.argsort(end.id)]

    def case(self, kind="piston"):
        return tw.Case(self.write("piston.toml", PISTON.format(type=kind)))

    def test_paddle_in_python_is_that_of_the_case(self):
        paths = {"piston": lambda time: [self.stroke("piston", time), 0],
                 "flap": lambda time: [0, 0, -np.arctan(self.stroke("flap", time) / 0.2)]}
        for kind, path in paths.items():
            time, made = self.motion(self.case(kind))
            still = self.case(kind).update({"wave_maker.piston.start": 100})

            def hook(step, path=path):
                if step.number == 0:
                    step.steer("piston", path)
            steered_time, steered = self.motion(still, hook)
            self.assertAlmostEqual(steered_time, time, delta=1e-10)
            self.assertLess(abs(steered - made).max(), 1e-10, kind)
            self.assertGreater(abs(self.motion(still)[1] - made).max(), 1e-3)

    def test_path_that_jumps_is_refused_and_a_fast_one_shortens_the_step(self):
        with self.case().update({"wave_maker.piston.start": 100}).simulation() as simulation:
            for step in simulation:
                if step.number == 3:
                    begin, long = step.time, step.dt
                    with self.assertRaisesRegex(tw.InputError, "begins 0.01 m from where the wall is at t = "):
                        step.steer("piston", lambda time: [0.01, 0])
                    step.steer("piston", lambda time: [5.0 * (time - begin), 0])
                    self.assertLess(step.dt, 0.5 * long)
                    self.assertLess(5.0 * step.dt, simulation.spacing)
                    return
        self.fail("no step")

    def test_what_cannot_be_steered(self):
        def hook(step):
            for name, path, message in (("flume", None, "no wall 'flume' that a script can move"),
                                        ("piston", lambda time: [time], "not 2 components"),
                                        ("piston", lambda time: [0, np.nan], "not 2 components")):
                with self.assertRaisesRegex(tw.InputError, message):
                    step.steer(name, path)
        with self.case().simulation(hook=hook):
            pass
        with self.assertRaisesRegex(tw.InputError, 'the water moves it too; remedy: absorption = "none"'):
            self.case().update({"wave_maker.piston.absorption": "active"}).simulation(
                hook=lambda step: step.steer("piston", lambda time: [0, 0]))

    def test_error_of_a_path_ends_the_simulation(self):
        def path(time):
            return [0, 0 if time < 0.01 else 1 / 0]
        with self.assertRaises(ZeroDivisionError), self.assertWarnsRegex(tw.RunWarning, "a script acts"):
            with self.case().update({"wave_maker.piston.start": 100}).simulation(
                    "out", hook=lambda step: step.number == 0 and step.steer("piston", path)) as simulation:
                simulation.run()
        summary = tw.Run("out").summary
        self.assertEqual(summary["status"], "failed")
        self.assertIn("ZeroDivisionError", summary["message"])


if __name__ == "__main__":
    unittest.main()
