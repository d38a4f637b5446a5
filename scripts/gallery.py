#!/usr/bin/python3
"""The gallery, a page of all templates in the documents: runs each unchanged, draws it, and writes its contents and cost.

Usage: scripts/gallery.py [TEMPLATE ...]    runs those that are named, or all, where out/gallery has no whole run of them
       scripts/gallery.py --coarse ...      the same with twice the spacing, where there is no run yet; the page says so

The head of its case describes a template, its run gives the cost. The pictures go to docs/images/gallery.
All need about ten minutes of CPU time. Exit code 1 if a run of a template as it stands has warned.
"""
import pathlib
import re
import sys
import tempfile
import textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "build/release/lib/python3/dist-packages"))
import tailwater as tw  # noqa: E402
import matplotlib  # noqa: E402
import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402
from tailwater import pictures, plots  # noqa: E402
from tailwater.fields import list_frames, read_frame  # noqa: E402
from tailwater.program import call  # noqa: E402

PAGE = ROOT / "docs" / "gallery.md"
IMAGES = ROOT / "docs" / "images" / "gallery"
RUNS = ROOT / "out" / "gallery"
WIDTH = 900  # pixels of a picture
# s; the moment that is shown, where it is not the end.
MOMENTS = {"dam-break": 0.8, "dam-break-box": 0.6, "shore": 3.6, "pier": 0.6, "run-up": 3.4, "solitary-wave": 2.0,
           "sloshing": 4.5, "floating-box": 0.1}
COLOURS = {"tank": "pressure"}  # instead of the speed, where nothing should move
# Keys of runs that are only drawn, of templates whose own spacing leaves a jet of two particles or a coarse roller.
DRAWN_WITH = {"weir": {"particles.spacing": "P/40", "time.end": 3.0},
              "hydraulic-jump": {"particles.spacing": "h1/10", "time.end": 6.0, "output.fields_interval": 0.05}}
MEAN_SINCE = {"hydraulic-jump": 3.0}  # s; where a mean is shown, because the vortices of one instant hide the flow
NOT_SHOWN = ("Lengths", "Numbers", "All keys", "Every key", "seconds")
HEAD = """\
# Gallery

For new users who choose a template. The page shows every template of `tailwater new` without changes. `tailwater new
NAME my.toml` writes one; then

    tailwater check my.toml && tailwater run my.toml --out my_run --pictures 6

checks and runs it. Colours show the speed; those of the tank show the pressure, and those of the hydraulic jump a mean
velocity. CPU times are of one core of a busy machine (`scripts/gallery.py`): {processor}.
"""


def templates():
    """All names, in the order of the help."""
    return re.findall(r"^  ([\w-]+)  ", call("new", "--help").partition("\nTemplates:\n")[2], re.MULTILINE)


def what_it_shows(name):
    """The first sentences of the case's comment, up to those that are the same in all."""
    case = tw.Case.template(name)
    head = re.match(r"(#.*\n)+", case.file.read_text(encoding="utf-8"))[0]
    comment = " ".join(line.lstrip("# ") for line in head.splitlines())
    told = []
    for sentence in re.findall(r".+?[.?](?=\s|$)", comment):
        if sentence.strip().startswith(NOT_SHOWN):
            break
        told.append(sentence.strip())
    return " ".join(told)


def is_whole(folder):
    return (folder / "summary.json").is_file() and tw.Run(folder).summary.get("status") == "done"


def finished(name, may_be_coarse):
    """A whole run of the template, made if it is not there; in a folder NAME-coarse if it is a coarse one."""
    folders = [RUNS / name, RUNS / f"{name}-coarse"]
    for folder in folders[:2 if may_be_coarse else 1]:
        if is_whole(folder):
            return tw.Run(folder)
    print(f"gallery.py: {name}", flush=True)
    case = tw.Case.template(name)
    if may_be_coarse:
        case["particles.spacing"] = f"2*({case['particles.spacing']})"
    folder = folders[may_be_coarse]
    case.run(folder, force=folder.exists())
    return tw.Run(folder)


def drawn(name, may_be_coarse):
    """The run that the picture of a template shows."""
    if name not in DRAWN_WITH:
        return finished(name, may_be_coarse)
    folder = RUNS / f"{name}-drawn"
    if not is_whole(folder):
        print(f"gallery.py: {name}, for its picture", flush=True)
        case = tw.Case.template(name)
        for key, value in DRAWN_WITH[name].items():
            case[key] = value
        case.run(folder, force=folder.exists())
    return tw.Run(folder)


def draw_mean(run, since, file):
    """The mean velocity along x in cells of a spacing, where they hold water for half of the time or more."""
    frames = [read_frame(time, path) for time, path in list_frames(run.path) if time >= since]
    view = plots.View(run, frames, crop=True)
    edges = [run.spacing * np.arange(np.floor(low / run.spacing), np.ceil(high / run.spacing) + 1)
             for low, high in (view.x, view.y)]
    position = np.concatenate([frame.position[:, :2] for frame in frames])
    velocity = np.concatenate([frame.fields["velocity"][:, 0] for frame in frames])
    count = np.histogram2d(*position.T, bins=edges)[0]
    along = np.histogram2d(*position.T, bins=edges, weights=velocity)[0] / np.maximum(count, 1)
    along = np.ma.masked_where(count < 0.5 * len(frames), along).T
    with matplotlib.rc_context(plots.STYLE):
        figure = plots.new_figure(plots.WIDTH, (plots.WIDTH - 1.2) * view.ratio + 0.9)
        axes = figure.subplots()
        mesh = axes.pcolormesh(*edges, along, cmap=plots.COLOURS, rasterized=True)
        plots.draw_walls(axes, run, frames[-1].time)
        view.apply(axes)
        axes.set(xlabel="x (m)", ylabel=view.label_of_heights())
        axes.set_title(f"{run.title}\nmean from $t$ = {since:g} to {frames[-1].time:.3g} s, dx = {run.spacing:.4g} m",
                       loc="left", fontsize=10)
        bar = figure.colorbar(mesh, ax=axes, fraction=0.025, pad=0.01)
        bar.set_label("mean velocity along x (m/s)")
        figure.savefig(file, dpi=plots.DPI)


def draw(name, run):
    """Into docs/images/gallery: a picture of its moment, if there is none of this run."""
    image_file = IMAGES / f"{name}.webp"
    if image_file.is_file() and image_file.stat().st_mtime > (run.path / "summary.json").stat().st_mtime:
        return
    with tempfile.TemporaryDirectory() as scratch:
        if name in MEAN_SINCE:
            file = pathlib.Path(scratch) / "mean.png"
            draw_mean(run, MEAN_SINCE[name], file)
        else:
            for picture in (run.path / "pictures").glob("*.png"):
                picture.unlink()
            folder = pictures.draw(run, times=[MOMENTS.get(name, run.times[-1])], by=COLOURS.get(name, "speed"))
            file = next(folder.glob("*.png"))
        image = Image.open(file).convert("RGB")
        image.thumbnail((WIDTH, WIDTH))
        IMAGES.mkdir(parents=True, exist_ok=True)
        image.save(image_file, quality=80, method=6)


def duration(seconds):
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.0f} min"


def section(name, run):
    summary = run.summary
    told = [textwrap.fill(f"- `{probe}`: {result['words']}", 120, subsequent_indent="  ", break_on_hyphens=False)
            for probe, result in run.results.items()]
    particles = summary["particles"]
    other = " The picture is of a run with twice the template's spacing." if run.path.name.endswith("-coarse") else ""
    if name in DRAWN_WITH:
        other = f" The picture is of a run with particles of {tw.Run(RUNS / f'{name}-drawn').spacing:.3g} m."
    if name in MEAN_SINCE:
        other += " It shows a mean over time: the vortices of one instant look like stripes."
    return "\n".join([
        f"\n## {name}\n", textwrap.fill(what_it_shows(name) + other, 118) + "\n", f"![{name}](images/gallery/{name}.webp)\n",
        f"{run.dimension}D, {particles['fluid'] + particles['wall']} particles (dx = {run.spacing:.3g} m), "
        f"{summary['time_s']['reached']:.3g} s of water in {duration(summary['cost']['cpu_s'])} of CPU time."
        + (" Results of its probes:\n" if told else ""), *told]) + "\n"


def main(arguments):
    may_be_coarse = "--coarse" in arguments
    asked = [word for word in arguments if word != "--coarse"]
    names = templates()
    if unknown := [name for name in asked if name not in names]:
        print(f"{__doc__}\nno template {', '.join(unknown)}", file=sys.stderr)
        return 2
    for name in asked or names:
        draw(name, drawn(name, may_be_coarse))
    if missing := [name for name in names if not any(map(is_whole, (RUNS / name, RUNS / f"{name}-coarse")))]:
        print(f"gallery.py: no page yet; not run: {', '.join(missing)}")
        return 0
    runs = {name: finished(name, True) for name in names}
    processor = next(iter(runs.values())).summary["machine"]["processor"]
    text = HEAD.format(processor=processor) + "".join(section(*run) for run in runs.items())
    PAGE.write_text(text, encoding="utf-8")
    print(f"gallery.py: {PAGE}, {sum(run.summary['cost']['cpu_s'] for run in runs.values()):.0f} s of CPU time")
    warned = [f"{name}: {warning}" for name, run in runs.items() if run.path.name == name for warning in run.summary["warnings"]]
    print("".join(f"gallery.py: {line}\n" for line in warned), end="")
    return 1 if warned else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
