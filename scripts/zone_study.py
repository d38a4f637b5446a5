#!/usr/bin/python3
"""Zones of finer particles beside runs with one spacing: the figures of cases/refinement and docs/theory/refinement.md.

  still   rms speed of still water over sqrt(g depth) in 1e-3, in spans of 2.5 s, with zones in several places
  waves   standing waves: amplitude lost per period, and the last two periods over the first two; the
          amplitude is the root of that of the potential energy at twice the frequency
  dam     dam break on a wall: impulses to 1.4 s (Pa s), noise (rms deviation from the median over 20 ms, from 0.6 to 1.4 s)
          and plateau (median from 0.8 to 1.2 s) over rho g H, at 0.16 m
  gate    depth behind a rising gate after 0.3, 0.4 and 0.5 s, m
  towed   mean force on a towed block from 0.2 to 1.4 s, N/m
  block   lift of a block at rest over the weight of the displaced water: in the first ten steps, and then its extremes to 1 s

Usage: scripts/zone_study.py [--program PATH] [--set KEY=VALUE ...] [--out DIR] STUDY ...
"""
import argparse
import json
import pathlib
import subprocess
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "python"))
from tailwater.tables import read_table  # noqa: E402

G = 9.81  # m/s^2
CASES = ROOT / "cases"
NO_ZONE = ["refinement=[]"]


class Runs:
    """Runs of cases with settings."""

    def __init__(self, options):
        self.options = options

    def folder(self, name, case, settings):
        folder = self.options.out / name
        words = [word for setting in [*settings, *self.options.settings] for word in ("--set", setting)]
        subprocess.run([self.options.program, "run", case, "--out", folder, "--force", "--quiet", *words], check=True)
        return folder


def summary_of(folder):
    return json.loads((folder / "summary.json").read_text(encoding="utf-8"))


def say(*words):
    print(*words, flush=True)


def still(runs):
    """Water 0.4 m deep in a tank of 0.8 m."""
    def ends(**values):
        return [f"parameters.{key}={value}" for key, value in values.items()]

    def zone(text):
        return [f"refinement=[{{{text}}}]"]

    bed, jitter = ends(low=-1, high=9, top=0.2), "particles.jitter={}"
    for name, settings in {
            "middle": [], "middle, jitter 0.1": [jitter.format(0.1)], "middle, jitter 0.2": [jitter.format(0.2)],
            "middle, 20 rows": ["particles.spacing=depth/20"],
            "bed": bed, "bed, 20 rows": [*bed, "particles.spacing=depth/20"],
            "surface": ends(low=-1, high=9, bottom=0.2), "corner": ends(low=-1, high=0.4, top=0.2), "half": ends(low=-1, high=0.4),
            "shape surface": zone('shape="surface", distance=0.04'),
            "polygon": zone('shape="polygon", points=[[-0.4, -1.0], [0.0, -1.0], [1.0, 1.0], [0.6, 1.0]]'),
            "none": NO_ZONE, "middle, implicit": ["scheme.integrator=implicit"],
            "bed, implicit": [*bed, "scheme.integrator=implicit"]}.items():
        steps = read_table(runs.folder(f"still {name}", CASES / "refinement" / "still_water.toml", settings) / "steps.csv")
        speed = np.sqrt(2 * steps["kinetic_J"] / (1000 * 0.8 * 0.4) / (G * 0.4))
        time = steps["time_s"]
        spans = [np.sqrt(np.mean(speed[(time > t) & (time <= t + 2.5)]**2)) for t in np.arange(0.0, 12.5, 2.5)]
        say(f"still, {name}:", " ".join(f"{1e3 * span:.1f}" for span in spans))


def amplitudes(steps, omega):
    """Amplitudes of the wave in each period, in any unit."""
    period = 2 * np.pi / omega
    for number in range(round(steps["time_s"][-1] / period)):
        inside = (steps["time_s"] >= number * period) & (steps["time_s"] < (number + 1) * period)
        t = steps["time_s"][inside]
        terms = np.column_stack([np.cos(2 * omega * t), np.sin(2 * omega * t), np.ones_like(t), t])
        yield np.sqrt(np.hypot(*np.linalg.lstsq(terms, steps["potential_J"][inside], rcond=None)[0][:2]))


def waves(runs):
    def tell(name, case, k, settings):
        steps = read_table(runs.folder(f"waves {name}", case, settings) / "steps.csv")
        found = list(amplitudes(steps, np.sqrt(G * k * np.tanh(k * 0.5))))
        lost = -np.polyfit(np.arange(len(found)), np.log(found), 1)[0]
        say(f"waves, {name}: {100 * lost:.2f} % lost per period, {sum(found[-2:]) / sum(found[:2]):.3f} left")

    steep = CASES / "refinement" / "waves.toml"
    tell("steep, depth/14", steep, 2.0, NO_ZONE)
    tell("steep, zone", steep, 2.0, [])
    tell("steep, zone to 0.35 of the depth", steep, 2.0, ['refinement=[{shape="surface", distance="0.35*depth"}]'])
    tell("steep, depth/28", steep, 2.0, [*NO_ZONE, "particles.spacing=depth/28"])
    half, upper = "refinement=[{min=[0.4, -1.0], max=[9.0, 9.0]}]", "refinement=[{min=[-1.0, 0.2], max=[9.0, 9.0]}]"
    for rows, viscosity in ((10, 5e-3), (20, 5e-3), (20, 1e-6)):
        common = [f"particles.spacing={0.5 / rows}", f"physics.viscosity={viscosity}"]
        for name, settings in {"coarse": [], "x > 0.4 m finer": [half], "y > 0.2 m finer": [upper],
                               "fine": [f"particles.spacing={0.25 / rows}"]}.items():
            tell(f"{rows} rows, viscosity {viscosity}, {name}", CASES / "robustness" / "standing_wave.toml", np.pi,
                 [*common, *settings])


def dam(runs):
    for name, settings in {"0.024 m": NO_ZONE, "zone of 0.012 m": [], "0.012 m": [*NO_ZONE, "particles.spacing=0.012"],
                           "0.048 m, zone of 0.012 m": ["particles.spacing=0.048",
                                                        "refinement=[{min=[2.2, -1.0], max=[9.0, 9.0], level=2}]"]}.items():
        folder = runs.folder(f"dam {name}", CASES / "refinement" / "dam_break.toml", settings)
        impulses = []
        for probe in ("P160", "P120", "P060"):
            table = read_table(folder / f"probes/{probe}.csv")
            time, pressure = table["time_s"], table["pressure_Pa"]
            until = time <= 1.4
            impulses.append(np.sum(0.5 * (pressure[until][1:] + pressure[until][:-1]) * np.diff(time[until])))
            if probe == "P160":
                even = np.arange(0.6, 1.4, 0.001)
                reading = np.interp(even, time, pressure) / (1000 * G * 0.6)
        medians = np.array([np.median(reading[max(0, n - 10):n + 11]) for n in range(len(reading))])
        plateau = np.median(reading[(even > 0.8) & (even < 1.2)])
        summary = summary_of(folder)
        say(f"dam, {name}: impulses {' '.join(f'{impulse:.0f}' for impulse in impulses)}, noise "
            f"{np.sqrt(np.mean((reading - medians)**2)):.4f}, plateau {plateau:.3f}, largest rise of the energy "
            f"{summary['energy']['largest_rise_over_start']:.2g}, density error {summary['volume']['density_error_rms']:.2%}, "
            f"{summary['volume']['fluid_particles_end']} particles, {summary['cost']['cpu_s']:.1f} s of CPU time")


def gate(runs):
    for name, settings in {"0.04 m": NO_ZONE, "zone of 0.02 m": [], "0.02 m": [*NO_ZONE, "particles.spacing=0.02"]}.items():
        behind = read_table(runs.folder(f"gate {name}", CASES / "refinement" / "gate.toml", settings) / "probes/behind.csv")
        say(f"gate, {name}:", " ".join(f"{np.interp(t, behind['time_s'], behind['connected_m']):.4f}" for t in (0.3, 0.4, 0.5)))


def towed(runs):
    for name, settings in {"B/5": NO_ZONE, "zone of B/10": [], "B/10": [*NO_ZONE, "particles.spacing=B/10"]}.items():
        folder = runs.folder(f"towed {name.replace('/', '')}", CASES / "refinement" / "towed_block.toml", settings)
        force = read_table(folder / "probes/force.csv")
        mean = [np.mean(force[key][force["time_s"] >= 0.2]) for key in ("force_x_N_per_m", "force_y_N_per_m")]
        summary = summary_of(folder)
        say(f"towed, {name}: {mean[0]:.1f} along, {mean[1]:.1f} across, largest rise of the energy "
            f"{summary['energy']['largest_rise_over_start']:.2g}, density error {summary['volume']['density_error_rms']:.2%}, "
            f"{summary['cost']['cpu_s']:.1f} s of CPU time")


BLOCK = """particles.spacing = 0.02
time.end = 1.0
refinement = [{shape = "walls", walls = ["block"], distance = 0.06}]
fluid = [{min = [0.0, 0.0], max = [1.2, 0.4]}]
[[wall]]
points = [[0.0, 0.8], [0.0, 0.0], [1.2, 0.0], [1.2, 0.8]]
[[wall]]
name = "block"
shape = "box"
min = [0.5, 0.12]
max = [0.7, 0.28]
fluid_side = "outside"
[[probe]]
name = "block"
type = "force"
walls = ["block"]
"""


def block(runs):
    case = runs.options.out / "block.toml"
    case.write_text(BLOCK, encoding="utf-8")
    for name, settings in {"0.02 m": NO_ZONE, "zone of 0.01 m": [], "0.01 m": [*NO_ZONE, "particles.spacing=0.01"]}.items():
        table = read_table(runs.folder(f"block {name}", case, settings) / "probes/block.csv")
        lift = table["force_y_N_per_m"] / (1000 * G * 0.2 * 0.16)
        say(f"block, {name}: {' '.join(f'{value:.3f}' for value in lift[:10])}; {lift[10:].min():.3f} to {lift[10:].max():.3f}")


STUDIES = {function.__name__: function for function in (still, waves, dam, gate, towed, block)}


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/release/bin/tailwater", type=pathlib.Path)
    parser.add_argument("--set", dest="settings", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--out", default=ROOT / "out" / "zone_study", type=pathlib.Path)
    parser.add_argument("studies", nargs="+", choices=STUDIES, metavar="STUDY")
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    for name in options.studies:
        STUDIES[name](Runs(options))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
