#!/usr/bin/python3
"""CPU time of Tailwater beside PySPH's SISPH: Zhou's dam break, the same spacing and end, in turn, one core each.

Usage: benchmarks/beside_sisph.py [--dx 0.015] [--end SECONDS] [--repeats N] [--program FILE] [--set KEY=VALUE]...
The first run of PySPH compiles its loops, which takes a minute or more and is not counted.
"""
import argparse
import csv
import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def sisph(dx, end, folder):
    command = ["/usr/bin/python3", "-B", ROOT / "benchmarks/sisph_zhou.py", str(dx), str(end), f"{folder}/sisph"]
    told = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
    return json.loads(told.splitlines()[-1])


def tailwater(program, dx, end, settings, folder):
    command = [program, "run", ROOT / "cases/zhou1999/case.toml", "--out", f"{folder}/run", "--force", "--quiet",
               "-n", "1"]
    for setting in (f"particles.spacing={dx}", f"time.end={end}", "wall.tank.slip=free", *settings):
        command += ["--set", setting]
    subprocess.run(command, check=True)
    run = pathlib.Path(folder) / "run"
    summary = json.loads((run / "summary.json").read_text())
    rows = csv.reader(line for line in (run / "probes/front.csv").open() if not line.startswith("#"))
    return {"cpu_s": summary["cost"]["cpu_s"], "simulated_s": summary["time_s"]["reached"],
            "steps": summary["steps"]["count"], "fluid": summary["particles"]["fluid"],
            "front_m": float(list(rows)[-1][1])}


def show(name, run):
    per_second = run["cpu_s"] / run["simulated_s"]
    print(f"{name:9}  {run['fluid']:7} particles  {run['steps']:6} steps  front {run['front_m']:.2f} m  "
          f"{per_second:9.2f} CPU s per simulated s", flush=True)
    return per_second


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--dx", type=float, default=0.015)
    parser.add_argument("--end", type=float, default=1.0, help="simulated seconds (1)")
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--program", default=ROOT / "build/release/bin/tailwater")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    options = parser.parse_args()
    if importlib.util.find_spec("pysph") is None:
        print("error: PySPH is not installed; remedy: apt-get install python3-pysph", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as folder:
        sisph(0.1, 1e-3, folder)  # compiles
        costs = []
        for _ in range(options.repeats):
            costs.append((show("SISPH", sisph(options.dx, options.end, folder)),
                          show("Tailwater", tailwater(options.program, options.dx, options.end, options.set, folder))))
    theirs, ours = (min(column) for column in zip(*costs))
    print(f"SISPH {theirs:.1f}, Tailwater {ours:.2f} CPU s per simulated s; ratio {theirs / ours:.1f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
