#!/usr/bin/python3
"""Pressure near an edge: a plane jet that meets a plate of finite length, over what free-streamline theory gives.

Half of the plate is in the hodograph q from 0 in its middle to U at its edge; with the angle a between the jet far behind
the plate and in front of it, and b the width of the jet,

  y(q) = b/(2 pi) int_0^q d/ds [2 ln(1 + s^2) - ln(s^4 + 2 s^2 cos 2a + 1)] ds/s   (speeds over U),   p = rho/2 (U^2 - q^2),

and the force is rho U^2 b (1 - cos a). The plate is the face of a block 4 dx thick. The table has means from 5 to 8 b/U over
theory: the force, and the pressure at points near the edge, also as a probe would read it in the exact flow.

Usage: scripts/plate_study.py [--program PATH] [--set KEY=VALUE ...] [ACROSS ...]   particles across the jet, 10 20
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "python"))
from tailwater import tables  # noqa: E402

B, U, RHO = 0.1, 2.0, 1000.0  # m, m/s, kg/m^3
ANGLE = np.radians(60)
STEADY = (5 * B / U, 8 * B / U)  # s
POINTS = (0.25, 0.5, 1.0, 1.5, 2.0, 3.0)  # dx from the edge


def exact_plate():
    """(y, p) along half the plate, m and Pa, from the middle to the edge."""
    q = np.linspace(0.0, 1.0, 20001)
    slope = 4 / (1 + q**2) - (4 * q**2 + 4 * np.cos(2 * ANGLE)) / (q**4 + 2 * q**2 * np.cos(2 * ANGLE) + 1)
    y = B / (2 * np.pi) * np.concatenate([[0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1])) * (q[1] - q[0])])
    return y, 0.5 * RHO * U**2 * (1 - q**2)


def exact_reading(across):
    """Readings of a point probe in the exact flow at POINTS, over the pressure there: means over the water with the kernel
    (Wendland C2, 3 dx). The water fills the quarter of the unit disc in v = (u - i w)/U."""
    radii, angles = 3000, 1500
    r = ((np.arange(radii) + 0.5) / radii)[:, None]
    direction = np.exp(-0.5j * np.pi * (np.arange(angles) + 0.5) / angles)[None, :]
    v = r * direction
    slope = B / (2 * np.pi) * (4 / (v**2 - 1) - 4 * (v**2 - np.cos(2 * ANGLE)) / (v**4 - 2 * v**2 * np.cos(2 * ANGLE) + 1))
    step = slope * direction / radii
    z = np.cumsum(step, axis=0) - 0.5 * step  # m; the plate is along the imaginary axis
    area = np.abs(slope)**2 * r
    y, p = exact_plate()
    for distance in POINTS:
        at = y[-1] - distance * B / across
        s = np.minimum(np.abs(z - 1j * at) / (3 * B / across), 1.0)
        weight = (1 - s)**4 * (1 + 4 * s) * area
        yield float(np.sum(weight * 0.5 * RHO * U**2 * (1 - r**2)) / np.sum(weight) / np.interp(at, y, p))


def case(across):
    y, _ = exact_plate()
    half, dx = y[-1], B / across
    text = f"""[case]
title = "Plane jet on a plate of finite length"
[physics]
viscosity = 0.0
gravity = [0.0, 0.0]
[particles]
spacing = {dx}
[[fluid]]
name = "jet"
min = [{-0.5 * B}, 0.0]
max = [{0.5 * B}, {12 * B}]
velocity = [0.0, {-U}]
[[wall]]
name = "block"
shape = "box"
min = [{-half}, {-4 * dx}]
max = [{half}, 0.0]
fluid_side = "outside"
[time]
end = {STEADY[1]}
[output]
fields_interval = {B / U}
"""
    for name, kind, place in probes(half, dx):
        text += f'[[probe]]\nname = "{name}"\ntype = "{kind}"\n{place}\n'
    return text


def probes(half, dx):
    yield "force", "force", 'walls = ["block"]'
    for k, distance in enumerate(POINTS):
        yield f"point{k}", "wall-pressure", f"at = [{half - distance * dx}, 0.0]"


def mean(folder, name, column):
    table = tables.frame(f"{folder}/probes/{name}.csv")
    time, value = table.index.to_numpy(), table[column].to_numpy()
    steps = np.diff(time, prepend=0.0)
    steady = (time > STEADY[0]) & (time <= STEADY[1])
    return float((value * steps)[steady].sum() / steps[steady].sum())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/release/bin/tailwater")
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[])
    parser.add_argument("across", metavar="ACROSS", type=int, nargs="*", default=[10, 20])
    arguments = parser.parse_args()
    y, p = exact_plate()
    half = y[-1]
    whole = RHO * U**2 * B * (1 - np.cos(ANGLE))
    by_pressure = np.sum((p[1:] + p[:-1]) * np.diff(y))
    print(f"half the plate: {half / B:.4f} b; theory's force by its pressure over that by momentum: {by_pressure / whole:.5f}")
    print("| | force |", *(f"{distance:g} dx |" for distance in POINTS))
    for across in arguments.across:
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "case.toml"
            path.write_text(case(across))
            sets = [word for change in arguments.set for word in ("--set", change)]
            subprocess.run([arguments.program, "run", path, "--out", f"{folder}/run", "--quiet", *sets], check=True)
            run = f"{folder}/run"
            print(f"| b/{across}, theory's flow as a probe reads it | |",
                  *(f"{share:.3f} |" for share in exact_reading(across)))
            print(f"| b/{across} {' '.join(arguments.set)} | {-mean(run, 'force', 'force_y_N_per_m') / whole - 1:+.4f} |",
                  *(f"{mean(run, f'point{k}', 'pressure_Pa') / np.interp(half - distance * B / across, y, p):.3f} |"
                    for k, distance in enumerate(POINTS)), flush=True)


if __name__ == "__main__":
    main()
