#!/usr/bin/python3
"""Follows guides: makes their cases and runs their commands in order, prints the output of their blocks of Python, and draws
their pictures into docs/images.

Usage: scripts/walk_guides.py [GUIDE ...]    of waves_on_a_wall, floating_box, sloshing, overtopping, gate_and_basin; all by
default
The runs stay in out/guides and are not made again. All take eight minutes of CPU time.
"""
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "build/release/lib/python3/dist-packages"), str(ROOT / "validation")]
import matplotlib  # noqa: E402
import numpy as np  # noqa: E402
import pages  # noqa: E402
import picture_record  # noqa: E402
import tailwater as tw  # noqa: E402
from PIL import Image  # noqa: E402
from tailwater import pictures, plots  # noqa: E402
from tailwater.program import call  # noqa: E402
from tailwater_validation import floating  # noqa: E402

IMAGES = ROOT / "docs" / "images"
# Guides, and the folder of the first sweep of each.
GUIDES = {"waves_on_a_wall": "wall", "floating_box": "barge", "sloshing": "tank", "overtopping": "seawall",
          "gate_and_basin": "basin"}


def text_of(guide):
    return (ROOT / "docs/guide" / f"{guide}.md").read_text(encoding="utf-8")


def follow(guide, run):
    """Makes the cases of a guide in this folder and calls `run` with the words of each command of the program, in order;
    returns the name of the last case."""
    for block in pages.blocks(text_of(guide)):
        if block.kind == "toml":
            name, faults = pages.assemble(block)
            if faults:
                raise RuntimeError(f"{guide}.md:{block.line}: {faults[0]}")
        elif block.kind == "indented":
            for _, words in pages.commands(block.text):
                if words[0] == "tailwater":
                    run(words[1:])
    return name


def make_template(words):
    if words[0] == "new":
        call(*words, "--force")


def write_case(guide):
    """The last case file that a reader of the guide has, in this folder; returns its name."""
    return follow(guide, make_template)


def run_blocks(guide, old="", new=""):
    """The names that its blocks of Python leave; `new` takes the place of `old` in them."""
    names = {}
    for block in pages.blocks(text_of(guide)):
        if block.kind == "python":
            exec(compile(block.text.replace(old, new) if old else block.text, guide, "exec"), names)
    return names


def save(png, name, size, quality):
    """Saves a drawing as a picture of the documents, at most `size` pixels wide."""
    file = IMAGES / f"{name}.webp"
    image = Image.open(png).convert("RGB")
    image.thumbnail((size, size))
    image.save(file, quality=quality, method=6)
    picture_record.write(file)


def picture(run, time, name, colour="speed"):
    for old in (run.path / "pictures").glob("*.png"):
        old.unlink()
    save(next(pictures.draw(run, times=[time], by=colour).glob("*.png")), name, 900, 80)


def curves(runs, probe, column, scale, label, lines, name):
    """A column over time at all spacings, beside horizontal lines {words: value}."""
    with matplotlib.rc_context(plots.STYLE):
        figure = plots.new_figure(height=3.2)
        axes = figure.subplots()
        for run, colour in zip(runs, (plots.SKY, plots.ORANGE, plots.BLUE)):
            curve = run.curve(probe, column)
            axes.plot(curve.time, scale(curve.value), color=colour, linewidth=1, label=f"dx = {run.spacing:.3g} m")
        for (words, value), style in zip(lines.items(), ("--", ":", "-.")):
            axes.axhline(value, color=plots.GREY, linewidth=1, linestyle=style, label=words)
        axes.set(xlabel="time (s)", ylabel=label, xlim=(0, None))
        axes.legend(loc="upper left", ncols=5, frameon=False, bbox_to_anchor=(0, 1.16))
        figure.savefig("curves.png", dpi=plots.DPI)
    save("curves.png", name, 1000, 85)


def draw_waves_on_a_wall(runs, names):
    force = runs[-1].curve("force", "force_x_N_per_m")
    last = force.window(8 * names["T"], np.inf)
    picture(runs[-1], last.time[np.argmax(last.value)], "waves_on_a_wall")
    at_rest = names["weight"] * names["h"] ** 2 / 2e3
    curves(runs, "force", "force_x_N_per_m", lambda value: value / 1e3 - at_rest, "force, more than at rest (kN/m)",
           {"Sainflou": names["crest"], "Goda": names["goda"], "Sainflou, trough": names["trough"]}, "waves_on_a_wall_force")


def draw_floating_box(runs, names):
    barge = floating.Tank(width=12, depth=4, breadth=10, height=4, mass=25000, inertia=0, density=1000, gravity=9.81)
    print(f"potential theory: period {floating.theory(barge, False, 20)[0]:.2f} s")
    picture(runs[-1], 0.25 * names["period"], "floating_box")
    curves(runs, "box", "displacement_y_m", lambda value: value * 1e3, "displacement of the barge upwards (mm)",
           {"Archimedes": 100.0}, "floating_box_displacement")


def draw_sloshing(runs, names):
    resonant = min(runs, key=lambda run: abs(run.parameters["T"] - 1.98))
    level = resonant.curve("end", "highest_m")
    picture(resonant, level.time[np.argmax(level.value)], "sloshing")
    with matplotlib.rc_context(plots.STYLE):
        figure = plots.new_figure(height=3.2)
        axes = figure.subplots()
        for name, colour, words in (("tank", plots.BLUE, "without a baffle"), ("baffled", plots.ORANGE, "with the baffle")):
            periods = sorted(names["forces"][name])
            axes.plot(periods, [names["forces"][name][period] for period in periods], "o-", color=colour, label=words)
        away = sorted(runs, key=lambda run: run.parameters["T"])
        axes.plot([run.parameters["T"] for run in away], [names["linear_theory"](run) for run in away], "x", color=plots.GREY,
                  label="linear theory, without")
        axes.set(xlabel="period of the motion (s)", ylabel="force (N/m)", ylim=(0, 1250))
        axes.legend(loc="upper right", frameon=False)
        figure.savefig("curves.png", dpi=plots.DPI)
    save("curves.png", "sloshing_force", 1000, 85)


def draw_overtopping(runs, names):
    volume = runs[-1].curve("over", "volume_m3")
    rate = np.gradient(volume.value, volume.time)
    picture(runs[-1], volume.time[np.argmax(rate)], "overtopping")


def draw_gate_and_basin(runs, names):
    picture(runs[0], 8.0, "gate_and_basin")


def run_command(words):
    print(">", *words, flush=True)
    subprocess.run([str(tw.program()), *words, *(["--force"] if words[0] == "new" else [])], check=True)


def walk(guide):
    folder = ROOT / "out/guides" / guide
    folder.mkdir(parents=True, exist_ok=True)
    os.chdir(folder)
    print(f"walk_guides.py: {guide}, {follow(guide, run_command)}", flush=True)
    runs = list(tw.Sweep(GUIDES[guide]))
    globals()[f"draw_{guide}"](runs, run_blocks(guide))
    for run in runs:
        print(f"{run.path.name}: {run.summary['cost']['cpu_s']:.0f} s of CPU time, {run.fluid_particles} particles of water; "
              f"{'; '.join(run.summary['warnings']) or 'no warning'}")


def main(arguments):
    if unknown := [guide for guide in arguments if guide not in GUIDES]:
        print(f"{__doc__}\nno guide {', '.join(unknown)}", file=sys.stderr)
        return 2
    for guide in arguments or GUIDES:
        walk(guide)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
