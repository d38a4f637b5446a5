"""Other codes beside Tailwater: the results of DFSPH are read from a program that imitates it."""

import json
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))

import beside
import dfsph
from tailwater_validation import peers

# Ten steps with frames of still water on the right wall; one solve gives four fifths of its pressure.
PRETENDER = """#!/usr/bin/python3
import json, pathlib, sys
import numpy as np
scene = json.load(open(sys.argv[1]))
told, folder = scene["Configuration"], pathlib.Path(sys.argv[1]).parent
if "mapFile" not in scene["RigidBodies"][0]:
    (folder / "Cache").mkdir()
    (folder / "Cache" / "tank_sb_vm.cdm").write_text("")
if told["enableVTKExport"]:
    out, dt = folder / "out" / "vtk", told["timeStepSize"]
    out.mkdir(parents=True)
    dx = 2 * told["particleRadius"]
    x, y = np.meshgrid(3.22 - dx * (np.arange(8) + 0.5), dx * (np.arange(20) + 0.5))
    positions = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    pressure = 9.81 * (0.6 - positions[:, 1])
    for k in range(10):
        data = b"# vtk\\nPOINTS %d float\\n" % len(positions) + positions.astype(">f4").tobytes()
        for name, share, power in (("p_/_rho^2", 0.8, 2), ("p_v_/_rho^2", 0.2, 1)):
            data += b"\\n%s 1 %d float\\n" % (name.encode(), len(positions))
            data += (share * pressure * dt**power).astype(">f4").tobytes()
        (out / f"ParticleData_Fluid_{k + 1}.vtk").write_bytes(data)
print("Average time: SimStep: 2.5 ms")
print("Time sum: SimStep: 25 ms")
"""


class Dfsph(unittest.TestCase):
    def test_is_read(self):
        case = beside.zhou(0.03, 0.05)
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder) / "pretender"
            program.write_text(PRETENDER)
            program.chmod(0o755)
            run = beside.done_with_readings(*dfsph.run(program, case, Path(folder)))
        self.assertEqual((run.steps, run.fluid), (10, 160))
        np.testing.assert_allclose(run.result.times, 0.005 * np.arange(1, 11))
        np.testing.assert_allclose(run.result.pressure, 1000 * 9.81 * 0.48, rtol=0.02)
        self.assertAlmostEqual(beside.arrival(run, case), 0.005)

    def test_sees_no_water_where_there_is_little(self):
        one = np.array([[0.0, 0.0, 0.0]])
        self.assertEqual(dfsph.pressure_at([0.0, 0.04], 0.02, one, np.array([1.0])), 0.0)

    def test_has_closed_walls_seen_from_outside(self):
        with tempfile.TemporaryDirectory() as folder:
            dfsph.body("tank", [0, 0, 0], [2, 3, 4], 0.1, True, Path(folder))
            lines = [line.split() for line in (Path(folder) / "tank.obj").read_text().splitlines()]
        corners = np.array([line[1:] for line in lines if line[0] == "v"], float)
        a, b, c = corners[np.array([line[1:] for line in lines if line[0] == "f"], int).T - 1]
        self.assertAlmostEqual(np.einsum("ij,ij", a, np.cross(b, c)) / 6, 24)  # the volume of the tank


class Records(unittest.TestCase):
    def test_code_that_does_not_finish_is_recorded(self):
        def fails():
            raise ValueError("it blew up")

        case = beside.zhou(0.03, 1.0)
        code = beside.Code("as in its example", "its authors", "run it", fails)
        run, message = beside.attempt("Other", code)
        found = beside.record("Other", code, case, run, message)
        self.assertEqual([found[name] for name in ("finished", "message", "chosen_by")], [False, "it blew up", "its authors"])
        self.assertNotIn("cpu_s", found)

    def test_commands_of_stored_records_exist(self):
        for file in (peers.FILE, *filter(Path.is_file, peers.WORK.values())):
            told = json.loads(file.read_text(encoding="utf-8"))
            codes = told.get("runs") or [code for case in told["cases"] for code in case["codes"]]
            for word in (word for code in codes for word in code["command"].split() if word.startswith("benchmarks/")):
                self.assertTrue((ROOT / word.rstrip(":,")).is_file(), f"{file.name}: {word}")

    def test_finished_codes_are_the_peers(self):
        case = beside.zhou(0.03, 1.0)
        done = beside.done_with_readings(10.0, 2.0, 800, 100, np.array([0.5, 0.9]), np.array([0.0, case.pressure]))
        code = beside.Code("defaults", "its authors", "run it", lambda: done)
        cases = [{"case": "zhou", "spacing_m": 0.03, "end_s": 1.0, "codes": [beside.record(name, code, case, run, "") for name, run in (
            ("Tailwater", done), ("Other", done), ("Broken", None))]}]
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "beside.json"
            file.write_text(json.dumps({"cases": cases, "date": "today", "processor": "some"}), encoding="utf-8")
            self.assertEqual(peers.peers_of("zhou", "cpu_s_per_simulated_s", file), (("Other", 5.0, 5.0),))
            figures = peers.figures_of_peers(file)
            table = peers.beside_table("zhou", file)
        self.assertIn("| Other | defaults (its authors) | 100 | 5 | 1 |", table[-1])
        self.assertEqual(figures["beside.zhou.Other.arrival_s"], "0.9 s")
        self.assertFalse([key for key in figures if "Broken" in key])


class Noise(unittest.TestCase):
    def test_is_about_the_running_median(self):
        case = beside.zhou(0.03, 1.0)
        times = np.arange(0.5, 1.0, 0.001)
        steady = 1000.0 * np.ones_like(times)
        spiky = steady + np.where(np.arange(len(times)) % 50 == 25, case.pressure, 0.0)
        for pressure, expected in ((steady, 0.0), (spiky, np.sqrt(1 / 50))):
            run = beside.done_with_readings(1.0, 1.0, 1, 1, times, pressure)
            self.assertAlmostEqual(beside.noise(run, case), expected, delta=1e-6)


if __name__ == "__main__":
    unittest.main()
