"""A dam break by SPlisHSPlasH's DFSPH, for beside.py: writes the scene, runs SPHSimulator, reads its frames.

Particles are as far apart as Tailwater's and begin at the same places. Walls, viscosity, tolerances and steps are those
of SPlisHSPlasH's own scenes of a dam break. The cost is that of a run without output, less that of its start. Another
run, with steps of the mean length of those, writes each step, from which the pressure is read.
"""
import json
import math
import os
import re
import resource
import shutil
import subprocess

import numpy as np

DENSITY = 1000.0
EACH_STEP = 1e6  # frames per second, more than there are steps
MAP_CELL = 4.0  # dx; of the maps of walls
READ_REACH = 3.0  # dx; of the kernel that reads the pressure, as Tailwater's probes do
# Pressures of the solves for the density and for the divergence; over the density, times the step to a power.
PRESSURES = {"p_/_rho^2": 2, "p_v_/_rho^2": 1}
CORNERS = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
TRIANGLES = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
             [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]  # of a box, seen from outside


def in_3d(begin, end, dx):
    """Two corners of a box. In 2D it is 16 dx thick, so that the plane does not see its faces."""
    return ([*begin], [*end]) if len(begin) == 3 else ([*begin, -8 * dx], [*end, 8 * dx])


def body(name, begin, end, dx, is_tank, folder):
    """Writes the box, and adds it to the scene."""
    begin, end = in_3d(begin, end, dx)
    vertices = [[(begin, end)[upper][axis] for axis, upper in enumerate(corner)] for corner in CORNERS]
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in vertices]
    lines += ["f " + " ".join(str(corner + 1) for corner in triangle) for triangle in TRIANGLES]
    (folder / f"{name}.obj").write_text("\n".join(lines) + "\n")
    # A map reaches 16 dx, four times the kernel, beyond the box.
    cells = [math.ceil((upper - lower + 32 * dx) / (MAP_CELL * dx)) for lower, upper in zip(begin, end)]
    told = {"geometryFile": f"{name}.obj", "translation": [0, 0, 0], "rotationAxis": [1, 0, 0], "rotationAngle": 0,
            "scale": [1, 1, 1], "isDynamic": False, "isWall": is_tank, "mapInvert": is_tank, "mapThickness": 0.0,
            "mapResolution": cells}
    return told | {"mapFile": str(made) for made in folder.glob(f"Cache/{name}_*.cdm")}


def write_scene(case, end, folder, step):
    """With steps of one length each of them is written."""
    dimension, dx = len(case.tank), case.dx
    gravity = [0.0, 0.0, 0.0]
    gravity[dimension - 1] = -9.81
    # The first and the last cell of a block stay empty.
    first, last = in_3d([lower - dx / 2 for lower in case.water[0]], [upper + dx / 2 for upper in case.water[1]], dx)
    scene = {
        "Configuration": {
            "pause": False, "stopAt": end, "sim2D": dimension == 2, "particleRadius": dx / 2, "gravitation": gravity,
            "simulationMethod": 4, "boundaryHandlingMethod": 2, "timeStepSize": step or 0.001,
            "cflMethod": 0 if step else 1, "cflFactor": 1, "cflMaxTimeStepSize": 0.005,
            "DFSPH": {"minIterations": 2, "maxIterations": 100, "maxError": 0.05, "enableDivergenceSolver": True,
                      "maxIterationsV": 100, "maxErrorV": 0.1},
            "enableVTKExport": bool(step), "dataExportFPS": EACH_STEP, "particleAttributes": "p / rho^2;p_v / rho^2"},
        "Materials": [{"id": "Fluid", "density0": DENSITY, "viscosityMethod": 1,
                       "Standard viscosity": {"viscosity": 0.01}}],
        "RigidBodies": [body("tank", [0.0] * dimension, case.tank, dx, True, folder)],
        "FluidBlocks": [{"denseMode": 0, "start": first, "end": last, "translation": [0, 0, 0], "scale": [1, 1, 1]}]}
    if case.obstacle:
        scene["RigidBodies"].append(body("obstacle", *case.obstacle, dx, False, folder))
    file = folder / "scene.json"
    file.write_text(json.dumps(scene, indent=1))
    return file


def run_scene(program, case, end, folder, step=None):
    """CPU seconds, and the output of the program."""
    scene = write_scene(case, end, folder, step)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [program, scene, "--no-gui", "--no-initial-pause", "--output-dir", folder / "out"]
    done = subprocess.run(command, check=True, env=os.environ | {"OMP_NUM_THREADS": "1"}, stdout=subprocess.PIPE,
                          text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, done.stdout


def read_frame(file, step):
    """Positions [m], and the pressure over the density [m^2/s^2], after a step of this length [s]."""
    data = file.read_bytes()

    def numbers(header, width):
        found = re.search(header, data)
        count = width * int(found[1])
        return np.frombuffer(data, ">f4", count, found.end()).reshape(-1, width).astype(float)

    positions = numbers(rb"POINTS (\d+) float\n", 3)
    pressure = sum(numbers(re.escape(name.encode()) + rb" 1 (\d+) float\n", 1)[:, 0] / step**power
                   for name, power in PRESSURES.items())
    return positions, pressure


def pressure_at(place, dx, positions, pressure):
    """The mean over the water weighted by a kernel, 0 where less than a quarter of the kernel's water is there: this
    water keeps so far off walls that a full wall has half."""
    dimension = len(place)
    q = np.minimum(np.linalg.norm(positions[:, :dimension] - place, axis=1) / (READ_REACH * dx), 1.0)
    unit = {2: 7 / math.pi, 3: 21 / (2 * math.pi)}[dimension]
    weight = unit / READ_REACH**dimension * (1 - q)**4 * (1 + 4 * q)  # Wendland's, sums to 1/2 beside a full wall
    return DENSITY * float(weight @ pressure / weight.sum()) if weight.sum() > 0.125 else 0.0


def time_of(log, kind):
    """ms; of the steps."""
    return float(re.search(rf"{kind}: SimStep: (\S+) ms", log)[1])


def run(program, case, folder):
    """CPU seconds, simulated seconds, particles of water, steps, times and pressures at the gauge. The folder is for one
    case: maps of the walls are made once."""
    shutil.rmtree(folder / "out", ignore_errors=True)
    run_scene(program, case, 1e-6, folder)  # makes the maps
    start, _ = run_scene(program, case, 1e-6, folder)
    cpu, log = run_scene(program, case, case.end, folder)
    steps = round(time_of(log, "Time sum") / time_of(log, "Average time"))
    step = case.end / steps
    run_scene(program, case, case.end, folder, step)
    frames = sorted(folder.glob("out/vtk/*.vtk"), key=lambda file: int(file.stem.rpartition("_")[2]))
    pressure = []
    for file in frames:
        positions, kinematic = read_frame(file, step)
        pressure.append(pressure_at(case.gauge, case.dx, positions, kinematic))
    return cpu - start, case.end, len(positions), steps, step * np.arange(1, len(frames) + 1), np.array(pressure)
