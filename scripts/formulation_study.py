#!/usr/bin/python3
"""Effect of each part of the default on the Zhou dam break: the tables of docs/theory/schemes.md and two-step.md.

One part at a time is left out of the default formulation; then the published one, to T = 8 (or until the run fails). Walls are
free unless the change is theirs, so that energy is lost by the scheme alone.
Usage: scripts/formulation_study.py [SPACING [two-step]]   needs build/release/bin/tailwater (scripts/build.sh)
"""
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "validation"), str(ROOT / "python")]
from tailwater import Run  # noqa: E402
from tailwater_validation.studies import zhou1999  # noqa: E402

PROGRAM = ROOT / "build/release/bin/tailwater"
CASE = ROOT / "cases/zhou1999/case.toml"
VARIANTS = {
    "default": [],
    "the kernel's own pair vectors": ["scheme.pair_vectors=kernel"],
    "implicit": ["scheme.integrator=implicit"],
    "jittered start (0.15 dx)": ["particles.jitter=0.15"],
    "no noise viscosity": ["study.noise_viscosity=0"],
    "artificial viscosity (0.02) instead": ["study.noise_viscosity=0", "study.artificial_viscosity=0.02"],
    "divergence-free at the start (F18)": ["study.divergence_free=start"],
    "moved by the mean velocity (F17)": ["study.displacement=mean-velocity"],
    "no slip": ["wall[0].slip=no-slip"],
    "no slip, no eddy viscosity": ["wall[0].slip=no-slip", "scheme.turbulence=none"],
    "no slip, rough (1 mm)": ["wall[0].slip=no-slip", "wall[0].roughness=0.001"],
    "partial slip (0.5)": ["wall[0].slip=partial", "wall[0].friction=0.5"],
    "no shifting": ["study.shifting=0"],
    "no density relaxation": ["study.density_relaxation=0"],
    "density source whatever the energy": ["study.energy_slack=1e3"],
    "published": ["scheme.formulation=published"],
    "published, implicit": ["scheme.formulation=published", "scheme.integrator=implicit"],
}
TWO_STEP = ["scheme.name=farmani2020"]
TWO_STEP_VARIANTS = {
    "scheme F, default": [],
    "two-step, default": TWO_STEP,
    "Courant number 0.1": TWO_STEP + ["scheme.courant=0.1"],
    "share of the density error 0.1": TWO_STEP + ["study.density_relaxation=0.1"],
    "no density error": TWO_STEP + ["study.density_relaxation=0"],
    "no shifting": TWO_STEP + ["study.shifting=0"],
    "no noise viscosity": TWO_STEP + ["study.noise_viscosity=0"],
    "published": TWO_STEP + ["scheme.formulation=published"],
}


def run(settings, spacing, out):
    command = [PROGRAM, "run", CASE, "--out", out, "--force", "--quiet", "-n", "1", "--set", f"particles.spacing={spacing}"]
    for setting in ("wall[0].slip=free", *settings):
        command += ["--set", setting]
    subprocess.run(command, check=False, stderr=subprocess.DEVNULL)
    return json.loads((pathlib.Path(out) / "summary.json").read_text())


def number(metrics, name, digits):
    return "-" if metrics[name] is None else f"{metrics[name]:.{digits}f}"


def main():
    spacing = float(sys.argv[1]) if len(sys.argv) > 1 else 0.02
    variants = TWO_STEP_VARIANTS if sys.argv[2:] == ["two-step"] else VARIANTS
    print("| variant | reached T | energy at the end | largest rise | density error mean, rms | noise | "
          "arrival z = 0.12 m | CPU s |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for name, settings in variants.items():
            summary = run(settings, spacing, f"{folder}/run")
            metrics = {metric.name: metric.value for metric in zhou1999.metrics(Run(f"{folder}/run"))}
            reached = summary["time_s"]["reached"] / zhou1999.TIME_SCALE
            energy, volume = summary["energy"], summary["volume"]
            cells = [name, f"{reached:.2f}", f"{energy['end_J'] / energy['start_J']:.3f}",
                     f"{energy['largest_rise_over_start']:.1e}",
                     f"{100 * volume['density_error_mean']:+.2f} %, {100 * volume['density_error_rms']:.2f} %",
                     number(metrics, "noise", 4), number(metrics, f"arrival_{zhou1999.READ_AT}", 3),
                     f"{summary['cost']['cpu_s']:.0f}"]
            if summary["status"] == "failed":
                cells[1:] = [f"dies at {reached:.2f}"] + ["-"] * 6
            print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
