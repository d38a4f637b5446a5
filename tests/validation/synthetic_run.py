"""A made-up run folder of cases/zhou1999: the shape of a run's results, with curves of which the scores are known.

Not physics: a column that collapses by a formula, probes that repeat the laboratory's own curves. To see the picture:
PYTHONPATH=validation:python /usr/bin/python3 tests/validation/synthetic_run.py DIR SPACING
"""

import json
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

from tailwater.run import Run
from tailwater_validation.studies import zhou1999

CASES = Path(__file__).resolve().parents[2] / "cases"
SAMPLING = 0.001  # s
ARRIVAL = 0.59  # s: before the window in which noise is scored
SAWTOOTH = 0.03  # of rho g H, over four samples: -1, -1/3, 1/3, 1 times this

EFFECTIVE_CASE = """\
[case]
dimension = 2
title = "Dam break of a 1.2 m x 0.6 m column, Zhou et al. (1999)"
[particles]
spacing = {spacing}
[time]
end = {end}
[scheme]
integrator = "explicit"
[[wall]]
name = "tank"
shape = "polyline"
points = [[0.0, 3.0], [0.0, 0.0], [3.22, 0.0], [3.22, 3.0]]
"""

def tank_case(title, length, height):
    """The effective case of a made-up run in an open tank with a spacing of 0.01 m."""
    return f"""\
[case]
dimension = 2
title = "{title}"
[physics]
density = 1000.0
gravity = [0.0, -9.81]
[particles]
spacing = 0.01
[scheme]
integrator = "explicit"
[[wall]]
name = "tank"
shape = "polyline"
points = [[0.0, {height}], [0.0, 0.0], [{length}, 0.0], [{length}, {height}]]
"""


SUMMARY = {
    "status": "done",
    "particles": {"fluid": 3200, "wall": 2000},
    "steps": {"count": 1600, "dt_mean_s": 0.00125},
    "cost": {"cpu_s": 60.0, "cpu_s_per_simulated_s": 30.0},
    "energy": {"start_J": 2000.0, "end_J": 1800.0, "largest_rise_over_start": 2e-4},
    "water_balance": {"start": {"particles": 3200, "volume_m3": 0.72}},
    "volume": {"density_error_mean": 0.002, "density_error_rms": 0.01, "outside_the_walls_most": 0,
               "outside_the_walls_end": 0},
}


def surface(x, T):
    """Depth over x at time T: a falling column with a running front, then water that climbs the right wall."""
    front = min(1.2 + 0.35 * T**1.5, 3.22)
    depth = 0.6 / (1 + 0.12 * T**1.5) * np.clip(1 - x / front, 0, 1) ** 0.45 + 0.06 * (x < front)
    return depth + max(T - 2.4, 0) * 0.28 * np.exp(-(3.22 - x) / 0.16)


def water_below(level, length, height, spacing):
    """Particles (n, 2) of a lattice below `level`, a function of x, and their hydrostatic pressures (Pa)."""
    x, z = np.meshgrid(np.arange(spacing / 2, length, spacing), np.arange(spacing / 2, height, spacing))
    wet = z < level(x)
    return np.stack([x[wet], z[wet]], axis=1), 9810.0 * (level(x) - z)[wet]


def write_frame(path, position, **fields):
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.pad(position, ((0, 0), (0, 3 - position.shape[1]))), deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    for name, values in fields.items():
        array = numpy_to_vtk(values.astype(np.float32), deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(data)
    writer.EncodeAppendedDataOff()
    writer.Write()


def write_series(folder, name, times):
    entries = [f'<DataSet timestep="{time}" file="{name}_{k:05}.vtp"/>' for k, time in enumerate(times)]
    (folder / "fields" / f"{name}.pvd").write_text(
        '<?xml version="1.0"?>\n<VTKFile type="Collection" version="1.0"><Collection>\n'
        + "\n".join(entries) + "\n</Collection></VTKFile>\n")


def write_frames(folder, frames):
    """Field files of [(time in s, positions, pressures)]."""
    for k, (_, position, pressure) in enumerate(frames):
        write_frame(folder / "fields" / f"fields_{k:05}.vtp", position, pressure=pressure)
    write_series(folder, "fields", [time for time, *_ in frames])


def write_frames_3d(folder, frames):
    """Field files of [(time in s, positions)], of water that moves along x at 1 m/s; and walls, one triangle below."""
    for k, (_, position) in enumerate(frames):
        write_frame(folder / "fields" / f"fields_{k:05}.vtp", position,
                    velocity=np.tile([1.0, 0.0, 0.0], (len(position), 1)), pressure=np.zeros(len(position)))
    write_series(folder, "fields", [time for time, _ in frames])
    floor = vtkPolyData()
    points, faces = vtkPoints(), vtkCellArray()
    for corner in ((0, 0, 0), (4, 0, 0), (4, 4, 0)):
        points.InsertNextPoint(corner)
    faces.InsertNextCell(3, (0, 1, 2))
    floor.SetPoints(points)
    floor.SetPolys(faces)
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(str(folder / "fields" / "walls_00000.vtp"))
    writer.SetInputData(floor)
    writer.Write()
    write_series(folder, "walls", [0.0])


def measurements(case):
    """The `[[measurement]]`s of cases/CASE, as a run writes them."""
    tables = tomllib.loads((CASES / case / "case.toml").read_text())["measurement"]
    return "".join(f'[[measurement]]\nprobe = "{table["probe"]}"\ncolumn = "{table.get("column", "")}"\n'
                   f'file = "{CASES / case / table["file"]}"\n' for table in tables)


def make_folder(folder, effective_case):
    """An empty run folder of a case."""
    folder = Path(folder)
    (folder / "probes").mkdir(parents=True)
    (folder / "fields").mkdir()
    (folder / "case.effective.toml").write_text(effective_case)
    (folder / "summary.json").write_text(json.dumps(SUMMARY))
    return folder


def write_probe(folder, name, columns):
    np.savetxt(folder / "probes" / f"{name}.csv", np.stack(list(columns.values()), axis=1), delimiter=",",
               header=",".join(columns), comments="")


def write_surfaces(folder, rows):
    """The table of a probe "surface" of several instants, from rows of time, x, bed, connected and highest level each."""
    names = ("time_s", "x_m", "bed_m", "connected_m", "highest_m")
    write_probe(folder, "surface", dict(zip(names, np.concatenate(rows, axis=1))))


class CaseTest(unittest.TestCase):
    """A test with a made-up run of a case in self.folder, which is not there yet."""

    def setUp(self):
        parent = tempfile.TemporaryDirectory()
        self.addCleanup(parent.cleanup)
        self.folder = Path(parent.name) / "run"

    def assert_drawn(self, module, kinds=frozenset({"run", "measured"})):
        """Each panel has curves of these kinds, and each curve points."""
        panels = module.draw(Run(self.folder))
        self.assertTrue(panels)
        for panel in panels:
            self.assertLessEqual(kinds, {curve["kind"] for curve in panel["curves"]}, panel["title"])
            for curve in panel["curves"]:
                self.assertGreater(len(curve["x"]), 0, f"{panel['title']}, {curve['label']}")
        json.dumps(panels, allow_nan=False)


def write_run(folder, spacing=0.04, end=8.0, delay=0.0, depth_error=0.0):
    """A run until T = `end`. Depths and P2 are the openmps digitisation, `delay` (of T) later, depths `depth_error`
    (of H) too high; the pressure at every point is a step at ARRIVAL and a sawtooth on it."""
    folder = make_folder(folder, EFFECTIVE_CASE.format(spacing=spacing, end=8 * zhou1999.TIME_SCALE)
                         + measurements("zhou1999"))
    run = Run(folder)
    regular = np.arange(0, end * zhou1999.TIME_SCALE + 1e-9, SAMPLING)

    def measured(quantity):
        """(time in s, value): sampled also at the laboratory's own times, so that nothing is lost between samples."""
        curve = zhou1999.laboratory(run, quantity)["openmps"]
        knots = curve.time + delay
        T = np.union1d(regular / zhou1999.TIME_SCALE, knots[(knots >= 0) & (knots <= end)])
        return T * zhou1999.TIME_SCALE, np.interp(T - delay, curve.time, curve.value)

    for gauge in ("H1", "H2"):
        time, depth = measured(gauge)
        level = (depth + depth_error) * zhou1999.H
        later = time > 5 * zhou1999.TIME_SCALE
        write_probe(folder, gauge, {"time_s": time, "connected_m": level, "wet_m": level, "highest_m": level + 0.06 * later})
    time, pressure = measured("P2")
    # A run's wall is dry until the jet arrives; the gauge's noise before that is its own.
    pressure = np.where(time > zhou1999.LABORATORY_QUIET * zhou1999.TIME_SCALE, pressure, 0) * zhou1999.PRESSURE_SCALE
    write_probe(folder, "P2", {"time_s": time, "pressure_Pa": pressure, "wet_share": pressure > 0})
    # The front runs at 5.4 m/s until the wall stops it.
    write_probe(folder, "front", {"time_s": regular, "front_m": np.minimum(1.2 + 5.4 * regular, 3.22)})
    sawtooth = SAWTOOTH * (np.arange(regular.size) % 4 - 1.5) / 1.5
    for point in zhou1999.POINT_HEIGHTS:
        write_probe(folder, point, {
            "time_s": regular,
            "pressure_Pa": np.where(regular >= ARRIVAL - 1e-9, 0.5 + sawtooth, 0) * zhou1999.PRESSURE_SCALE})

    frames = np.arange(0, end + 1e-9, 0.2)
    write_frames(folder, [(T * zhou1999.TIME_SCALE, *water_below(lambda x, T=T: surface(x, T), 3.22, 3.0, spacing))
                          for T in frames])


if __name__ == "__main__":
    write_run(sys.argv[1], spacing=float(sys.argv[2]), delay=0.1, depth_error=0.03)
