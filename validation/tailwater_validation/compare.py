"""Compares a run with the laboratory: a table on standard output, comparison.json and CASE.png in the run's folder.

Usage: python -m tailwater_validation.compare [CASE] RUN_DIR
The case is known by the title of the run's case file; a run under another title needs its name.
Exit codes: 0 done (whatever the verdicts are), 2 what was asked for is wrong, 4 a file cannot be read or written.
"""

import argparse
import json
import sys
from pathlib import Path

from . import (janosi2004, kleefsman2005, laboratory_picture, martin_moyce1952, ozmen_cagatay2014, soares_frazao2002,
               zhou1999)
from .curves import DataError
from .metric import bar
from .run_folder import RunFolder
from .text_table import text_table

# Cases with laboratory data, each a module: `score` takes a run's folder and returns the result of `scoring`, `draw`
# takes the run and returns panels; the water is drawn at MOMENTS (s), or at `moments(run)`.
CASES = {module.__name__.rpartition(".")[2]: module for module in
         (janosi2004, kleefsman2005, martin_moyce1952, ozmen_cagatay2014, soares_frazao2002, zhou1999)}


def recognise(run_folder):
    """Name of the case that the run was made of. Throws DataError if it is none of these."""
    title = RunFolder(run_folder).case.get("case", {}).get("title", "")
    for name, case in CASES.items():
        if case.TITLE == title:
            return name
    raise DataError(f"{run_folder}: its title \"{title}\" is that of no case with laboratory data; name the case, one of "
                    f"{', '.join(sorted(CASES))}")


def cost_and_health(summary):
    """One line on what the run cost and whether it stayed sound; scores mean little without it."""
    if not summary:
        return "The run has not ended: it was killed or still goes on."
    particles, steps, cost = summary["particles"], summary["steps"], summary["cost"]
    energy, volume = summary["energy"], summary["volume"]
    return (f"{summary['status']}: {particles['fluid']} fluid and {particles['wall']} wall particles, "
            f"{steps['count']} steps of {1000 * steps['dt_mean_s']:.2f} ms, CPU {cost['cpu_s']:.0f} s "
            f"({cost['cpu_s_per_simulated_s']:.1f} s per simulated s); "
            f"energy {energy['end_J'] / energy['start_J']:.3f} of the start, "
            f"rise {energy['largest_rise_over_start']:.1e}; "
            f"density error mean {volume['density_error_mean']:+.4f}, rms {volume['density_error_rms']:.4f}; "
            f"{volume['outside_the_walls_most']} particles outside the walls")


def table(result):
    """The scores as lines of text."""
    header, rows = ("quantity", "value", "unit", "target", "", "best shift", "compared with"), []
    for metric in result["metrics"]:
        value = "-" if metric["value"] is None else f"{metric['value']:.3f}"
        target = bar(metric["low"], metric["high"])
        shift = "" if metric["shift"] is None else f"{metric['shifted_value']:.3f} at {metric['shift']:+.3f} {metric['shift_unit']}"
        rows.append((metric["what"], value, metric["unit"], target, metric["verdict"], shift,
                     metric["note"] or metric["against"]))
    heading = f"{result['case']}, dx = {result['spacing_m']:g} m, {result['integrator']}: {result['run']}"
    return "\n".join([heading, cost_and_health(result["summary"]), "", text_table(header, rows)])


def draw(name, run, image):
    """Throws DataError."""
    module = CASES[name]
    moments = module.MOMENTS if hasattr(module, "MOMENTS") else module.moments(run)
    laboratory_picture.draw(run, image, moments, module.draw(run))


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="tailwater_validation.compare",
                                     description="Compares a run with laboratory data.")
    parser.add_argument("case", nargs="?", choices=sorted(CASES), help="default: by the title of the run's case file")
    parser.add_argument("run", type=Path, metavar="RUN_DIR", help="the folder that the run wrote")
    options = parser.parse_args(arguments)
    try:
        name = options.case or recognise(options.run)
        scores, image = options.run / "comparison.json", options.run / f"{name}.png"
        result = CASES[name].score(options.run)
        print(table(result))
        scores.write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")
        draw(name, RunFolder(options.run), image)
    except (DataError, OSError) as error:
        print(f"compare: {error}", file=sys.stderr)
        return 4
    print(f"\nscores:  {scores}\npicture: {image}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
