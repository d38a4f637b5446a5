#!/usr/bin/python3
"""Cost and results of Tailwater beside other codes: the same dam break, spacing and end, in turn, on one core each.

Usage: benchmarks/beside.py [--case zhou|box]... [--dx SPACING] [--end SECONDS] [--repeats N] [--program FILE]
                            [--dfsph FILE] [--set KEY=VALUE]... [--json FILE]

Cases: zhou, in 2D, at 0.015 m to 1.4 s (cases/zhou1999); box, in 3D, SPHERIC's benchmark 2, at 0.02 m to 1 s
(benchmarks/dam_break_3d.toml). Walls are free in all codes. Of the others those run that are there:
  SISPH, WCSPH  PySPH (apt-get install python3-pysph), zhou only; set as in PySPH's own example (pysph_zhou.py). The first
                run compiles its loops, which takes minutes and is not counted.
  interFoam     OpenFOAM's volume of fluid (apt-get install openfoam), zhou only; set by us (interfoam.py).
  DFSPH         SPlisHSPlasH, built by its users: SPHSimulator in PATH, or --dfsph FILE; set as in its own scenes (dfsph.py).

Prints CPU seconds per simulated second, Tailwater's over theirs, and two numbers of the pressure on a wall, 0.12 m
above the floor where Zhou's water arrives, or 0.06 m above it in the middle of the box: its noise, the RMS about its
running median over 0.02 s from 0.6 s on, over rho g H; and when the water arrives, the first time that it is above 0.05
rho g H (zhou, in the laboratory: 0.596 and 0.607 s, +- 0.03 s). Times are of one machine and hour: only ratios of one
call can be compared. Of several repeats the cheapest counts. A code that does not finish is reported, and the others go on.

--json writes all of it to a file, with the settings of each code, who chose them, the commands and the machine. The
figures of other codes that documents quote come from such a file,
validation/tailwater_validation/beside.json.
"""
import argparse
import csv
import datetime
import importlib.util
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

import dfsph
import interfoam

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "validation"), str(ROOT / "python")]
from tailwater_validation.validate import processor  # noqa: E402
WINDOW = 0.02  # s; of the running median
NOISY_FROM = 0.6  # s
ARRIVED = 0.05  # of rho g H


@dataclass
class Case:
    """A dam break in a box, walls at its floor and sides. Lengths in m, corners as [least, largest]."""

    dx: float
    end: float  # s
    depth: float  # of the water
    tank: list
    water: tuple
    obstacle: tuple
    gauge: list

    @property
    def pressure(self):
        """rho g H [Pa]."""
        return 1000.0 * 9.81 * self.depth


def zhou(dx, end):
    return Case(dx or 0.015, end or 1.4, 0.6, [3.22, 3.0], ([0.0, 0.0], [1.2, 0.6]), (), [3.22, 0.12])


def box(dx, end):
    """As benchmarks/dam_break_3d.toml rounds its lengths."""
    d = dx or 0.02

    def whole(length):
        return d * round(length / d)

    length, width, depth, begin = whole(3.22), whole(1.0), whole(0.55), whole(0.6635)
    across = 2 * whole(0.403 / 2)
    side, thick = whole((width - across) / 2), d * max(3, round(0.161 / d))
    return Case(d, end or 1.0, depth, [length, width, whole(1.0)],
                ([length - whole(1.228), 0.0, 0.0], [length, width, depth]),
                ([begin, side, 0.0], [begin + thick, side + across, thick]), [begin + thick, width / 2, 0.06])


CASES = {"zhou": zhou, "box": box}


@dataclass
class Code:
    """A code to compare with: its settings, who chose them, the command that runs it, and `run`, which returns a Done."""

    settings: str
    chosen_by: str
    command: str
    run: Callable


@dataclass
class Done:
    """Cost and result of a finished run. The type of the result depends on the flow: Readings, a run, a number."""

    cpu: float  # s
    simulated: float  # s
    fluid: int
    steps: int
    result: object

    @property
    def price(self):
        return self.cpu / self.simulated


@dataclass
class Readings:
    """Wall pressure and, of zhou, the length of water at the gauge H1."""

    times: np.ndarray  # s
    pressure: np.ndarray  # Pa
    level: np.ndarray | None = None  # m


def done_with_readings(cpu, simulated, fluid, steps, *readings):
    return Done(cpu, simulated, fluid, steps, Readings(*readings))


def done_by_tailwater(folder, result):
    """Done of a finished run of Tailwater, whose cost is in its folder."""
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    return Done(summary["cost"]["cpu_s"], summary["time_s"]["reached"], summary["particles"]["fluid"],
                summary["steps"]["count"], result)


def tailwater(program, name, case, settings, folder):
    file, spacing, probe = ROOT / "cases/zhou1999/case.toml", "particles.spacing", "P120"
    if name == "box":
        spacing, probe = "parameters.d", "gauge"
        text = (ROOT / "benchmarks/dam_break_3d.toml").read_text()
        file = folder / "box.toml"
        file.write_text(text + '\n[[probe]]\nname = "gauge"\ntype = "wall-pressure"\n'
                               'at = ["box_begin + box_length", "width/2", 0.06]\n')
    command = [program, "run", file, "--out", folder / "run", "--force", "--quiet", "-n", "1"]
    for setting in (f"{spacing}={case.dx}", f"time.end={case.end}", "wall.tank.slip=free", *settings):
        command += ["--set", setting]
    subprocess.run(command, check=True)
    times, pressure = column(folder, probe, "time_s"), column(folder, probe, "pressure_Pa")
    level = column(folder, "H1", "wet_m") if name == "zhou" else None
    return done_by_tailwater(folder / "run", Readings(times, pressure, level))


def column(folder, probe, name):
    lines = (folder / f"run/probes/{probe}.csv").read_text().splitlines()
    return np.array([float(row[name]) for row in csv.DictReader(line for line in lines if not line.startswith("#"))])


def pysph(scheme, dx, end, folder):
    command = ["/usr/bin/python3", "-B", ROOT / "benchmarks/pysph_zhou.py", scheme, str(dx), str(end), f"{folder}/{scheme}"]
    told = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()[-1])
    return done_with_readings(told["cpu_s"], told["simulated_s"], told["fluid"], told["steps"], *np.array(told["readings"]).T)


def noise(run, case):
    """The noise over rho g H; nothing if the run ends before the water arrives."""
    times, pressure = run.result.times, run.result.pressure
    late = times >= NOISY_FROM
    if not late.any():
        return None
    around = [pressure[abs(times - time) <= WINDOW / 2] for time in times[late]]
    about_median = pressure[late] - [np.median(values) for values in around]
    return float(np.sqrt(np.mean(about_median**2))) / case.pressure


def arrival(run, case):
    """s; nothing if the run ends before."""
    arrived = np.flatnonzero(run.result.pressure > ARRIVED * case.pressure)
    return float(run.result.times[arrived[0]]) if len(arrived) else None


def or_dash(value, form):
    return "-" if value is None else format(value, form)


def show(case_name, code, case, run, ours):
    print(f"{case_name:4}  {code:9}  {run.fluid:7} particles  {run.steps:6} steps"
          f"  {run.price:9.2f} CPU s per simulated s  ours over it {ours.price / run.price:6.3f}"
          f"  noise {or_dash(noise(run, case), '.4f'):>6}  arrival {or_dash(arrival(run, case), '.3f'):>5} s", flush=True)


def available_codes(name, case, options, folder):
    """{name: Code} of Tailwater and the other codes that are installed."""
    words = "".join(f" --set {setting}" for setting in options.set)
    codes = {"Tailwater": Code(f"defaults, wall.tank.slip=free{words}", "Tailwater", f"tailwater run, dx = {case.dx:g} m",
                               lambda: tailwater(options.program, name, case, options.set, folder))}
    if name == "zhou" and importlib.util.find_spec("pysph"):
        for scheme, but in (("sisph", ""), ("wcsph", ", with a fixed smoothing length")):
            pysph(scheme, 0.1, 1e-3, folder)  # compiles
            codes[scheme.upper()] = Code(f"scheme, step and kernel of PySPH's own example of a dam break{but}; free walls",
                                         "authors of PySPH", f"benchmarks/pysph_zhou.py {scheme} {case.dx:g} {case.end:g} FOLDER",
                                         lambda scheme=scheme: pysph(scheme, case.dx, case.end, folder))
    if name == "zhou" and shutil.which("interFoam"):
        codes["interFoam"] = Code("Courant number 0.4, vanLeer, linearUpwind, PISO of 3 corrections; water and air; free walls",
                                  "Tailwater", f"benchmarks/interfoam.py zhou1999 FOLDER --dx {case.dx:g} --end {case.end:g}",
                                  lambda: done_with_readings(*interfoam.run_zhou(case.dx, case.end, tempfile.mkdtemp(dir=folder))))
    if options.dfsph:
        scene = pathlib.Path(tempfile.mkdtemp(dir=folder))
        codes["DFSPH"] = Code("viscosity, tolerances and steps of SPlisHSPlasH's own scenes; free walls",
                              "authors of SPlisHSPlasH", "benchmarks/dfsph.py: SPHSimulator scene.json --no-gui",
                              lambda: done_with_readings(*dfsph.run(options.dfsph, case, scene)))
    return codes


def attempt(name, code):
    """(Done, message): None and the reason if the code does not finish."""
    try:
        return code.run(), ""
    except (subprocess.CalledProcessError, OSError, ValueError, IndexError) as error:
        print(f"{name} did not finish: {error}", file=sys.stderr)
        return None, str(error)


def record(name, code, case, run, message):
    """A code in the JSON file."""
    found = {"code": name, "settings": code.settings, "chosen_by": code.chosen_by, "command": code.command,
             "finished": run is not None, "message": message}
    if run is None:
        return found
    return found | {"fluid_particles": run.fluid, "steps": run.steps, "cpu_s": run.cpu, "simulated_s": run.simulated,
                    "cpu_s_per_simulated_s": run.price, "noise_over_rho_g_H": noise(run, case), "arrival_s": arrival(run, case)}


def compare(name, case, options, folder):
    """Runs all available codes in turn; returns the case in the JSON file."""
    codes = available_codes(name, case, options, folder)
    turns = [{each: attempt(each, code) for each, code in codes.items()} for _ in range(options.repeats)]
    records, best = [], {}
    for each, code in codes.items():
        finished = [turn[each][0] for turn in turns if turn[each][0]]
        best[each] = min(finished, key=lambda run: run.price, default=None)
        records.append(record(each, code, case, best[each], "" if finished else turns[-1][each][1]))
    for each, run in best.items():
        if run and best["Tailwater"]:
            show(name, each, case, run, best["Tailwater"])
    return {"case": name, "spacing_m": case.dx, "end_s": case.end, "repeats": options.repeats, "codes": records}


def provenance(options):
    """Program, machine and day of a comparison."""
    version = subprocess.run([options.program, "--version"], check=True, stdout=subprocess.PIPE, text=True).stdout.strip()
    return {"format": 1, "program": version, "date": datetime.date.today().isoformat(), "processor": processor(),
            "cores": os.cpu_count(), "load": os.getloadavg()[0]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--case", action="append", choices=tuple(CASES), help="may be repeated (zhou)")
    parser.add_argument("--dx", type=float, help="m")
    parser.add_argument("--end", type=float, help="simulated seconds")
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--program", default=ROOT / "build/release/bin/tailwater")
    parser.add_argument("--dfsph", metavar="FILE", default=shutil.which("SPHSimulator"))
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="write figures, settings and commands there")
    options = parser.parse_args()
    if options.dfsph and not os.access(options.dfsph, os.X_OK):
        print(f"error: {options.dfsph} is no program; remedy: --dfsph with the path of SPHSimulator", file=sys.stderr)
        return 2
    if not options.dfsph and not importlib.util.find_spec("pysph") and not shutil.which("interFoam"):
        print("error: there is no other code; remedy: apt-get install python3-pysph openfoam, or --dfsph FILE", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as folder:
        cases = [compare(name, CASES[name](options.dx, options.end), options, pathlib.Path(folder))
                 for name in options.case or ("zhou",)]
    if options.json:
        text = json.dumps(provenance(options) | {"cases": cases}, indent=1)
        options.json.write_text(text + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
