#!/usr/bin/python3
"""The gallery, a page of all templates in the documents: runs each unchanged, draws it, and writes its contents and cost.

Usage: scripts/gallery.py [TEMPLATE ...]    runs those that are named, or all, where out/gallery has no whole run of them
       scripts/gallery.py --coarse ...      the same with twice the spacing, where there is no run yet; the page says so

The head of its case describes a template, its run gives the cost. The pictures go to docs/images/gallery, with a record
of their inputs. scripts/gallery_pictures.py lists their contents. Without a run, a section of the page stays as it is.
All need about 15 minutes of CPU time. Exit code 1 if a run of a template as it stands has warned.
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
import picture_record  # noqa: E402
from gallery_pictures import PICTURES, Picture  # noqa: E402

PAGE = ROOT / "docs" / "gallery.md"
IMAGES = ROOT / "docs" / "images" / "gallery"
RUNS = ROOT / "out" / "gallery"
WIDTH = 900  # pixels of a picture
NOT_SHOWN = ("Lengths", "Numbers", "All keys", "Every key", "seconds")
HEAD = """\
# Gallery

For new users who choose a template. The page shows every template of `tailwater new`; a section names a run with
another spacing. These commands write, check and run one:

    tailwater new dam-break my.toml
    tailwater check my.toml && tailwater run my.toml --out my_run --pictures 6

Colours show the speed unless the scale names another quantity. CPU times are for one core of a busy
machine (`scripts/gallery.py`): {processor}.
"""


def templates():
    """All names, in the order of the help."""
    return re.findall(r"^  ([\w-]+)  ", call("new", "--help").partition("\nTemplates:\n")[2], re.MULTILINE)


def what_it_shows(name):
    """The first sentences of the case's comment, up to those that are the same in all."""
    case = tw.Case.template(name)
    head = re.match(r"(#.*\n)+", case.file.read_text(encoding="utf-8"))[0]
    comment = " ".join(line.lstrip("# ") for line in head.splitlines())
    sentences = []
    for sentence in re.findall(r".+?[.?](?=\s|$)", comment):
        if sentence.strip().startswith(NOT_SHOWN):
            break
        sentences.append(sentence.strip())
    return " ".join(sentences)


def is_whole(folder):
    return (folder / "summary.json").is_file() and tw.Run(folder).summary.get("status") == "done"


def run_of(name):
    """A whole run of the template, of twice its spacing only where there is no other; None without one."""
    return next((tw.Run(folder) for folder in (RUNS / name, RUNS / f"{name}-coarse") if is_whole(folder)), None)


def finished(name, may_be_coarse):
    """A whole run of the template, made if it is not there; in a folder NAME-coarse if it is a coarse one."""
    run = run_of(name)
    if run and (may_be_coarse or run.path.name == name):
        return run
    print(f"gallery.py: {name}", flush=True)
    case = tw.Case.template(name)
    if may_be_coarse:
        case["particles.spacing"] = f"2*({case['particles.spacing']})"
    folder = RUNS / (f"{name}-coarse" if may_be_coarse else name)
    case.run(folder, force=folder.exists())
    return tw.Run(folder)


def picture_of(name):
    return PICTURES.get(name, Picture())


def folder_drawn(name):
    """The folder of the run that the picture of a template shows, made with keys of its own or the template's."""
    return RUNS / f"{name}-drawn" if picture_of(name).keys else run_of(name).path


def drawn(name, may_be_coarse):
    """The run that the picture of a template shows, made if it is not there."""
    if not picture_of(name).keys:
        return finished(name, may_be_coarse)
    folder = folder_drawn(name)
    if not is_whole(folder):
        print(f"gallery.py: {name}, for its picture", flush=True)
        case = tw.Case.template(name)
        for key, value in picture_of(name).keys.items():
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
    """Into docs/images/gallery: the picture of a template, unless there is a newer one than the run."""
    image_file, wanted = IMAGES / f"{name}.webp", picture_of(name)
    with tempfile.TemporaryDirectory() as scratch:
        file = pathlib.Path(scratch) / "picture.png"
        if wanted.mean_since is not None:
            draw_mean(run, wanted.mean_since, file)
        else:
            for picture in (run.path / "pictures").glob("*.png"):
                picture.unlink()
            time = run.times[-1] if wanted.time is None else wanted.time
            folder = pictures.draw(run, times=[time], by=wanted.colour)
            file = next(folder.glob("*.png"))
        image = Image.open(file).convert("RGB")
        image.thumbnail((WIDTH, WIDTH))
        IMAGES.mkdir(parents=True, exist_ok=True)
        image.save(image_file, quality=80, method=6)
    picture_record.write(image_file)


def duration(seconds):
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.0f} min"


def heading(name, is_coarse):
    """The name of a template, its contents and its picture; `is_coarse` is whether its results have twice the spacing."""
    wanted, other = picture_of(name), ""
    if is_coarse:
        other = f" {'Results' if wanted.keys else 'Picture and results'} are of a run with twice the template's spacing."
    if "particles.spacing" in wanted.keys and is_whole(folder_drawn(name)):
        other += f" The picture is of a run with particles of {tw.Run(folder_drawn(name)).spacing:.3g} m."
    if wanted.note:
        other += f" {wanted.note}"
    return f"\n## {name}\n\n{textwrap.fill(what_it_shows(name) + other, 118)}\n\n![{name}](images/gallery/{name}.webp)\n"


def section(name, run):
    summary = run.summary
    results = [textwrap.fill(f"{probe}: {result['words']}", 120, subsequent_indent="  ", break_on_hyphens=False)
               for probe, result in run.results.items()]
    particles = summary["particles"]
    return "\n".join([
        heading(name, run.path.name.endswith("-coarse")),
        f"{run.dimension}D, {particles['fluid'] + particles['wall']} particles (dx = {run.spacing:.3g} m), "
        f"{summary['time_s']['reached']:.3g} s simulated in {duration(summary['cost']['cpu_s'])} of CPU time."
        + " Results of its probes:\n", "```text", *results, "```"]) + "\n"


def kept_section(name, text):
    """The section of a template without a run: its figures are those of the page."""
    figures = text.partition(".webp)\n")[2].strip()
    has_own_spacing = "particles.spacing" in picture_of(name).keys and not is_whole(folder_drawn(name))
    if has_own_spacing:
        return f"\n{text.strip()}\n"
    return heading(name, "twice the template's spacing" in text.replace("\n", " ")) + f"\n{figures}\n"


def main(arguments):
    may_be_coarse = "--coarse" in arguments
    asked = [word for word in arguments if word != "--coarse"]
    names = templates()
    if unknown := [name for name in asked if name not in names]:
        print(f"{__doc__}\nno template {', '.join(unknown)}", file=sys.stderr)
        return 2
    for name in asked or names:
        finished(name, may_be_coarse)  # for the figures of the section, also where the picture is of another run
        draw(name, drawn(name, may_be_coarse))
    runs = {name: run for name in names if (run := run_of(name)) and is_whole(folder_drawn(name))}
    page = PAGE.read_text(encoding="utf-8")
    kept = {name: text for text, name in re.findall(r"^(## (.+?)$.*?)(?=^## |\Z)", page, re.MULTILINE | re.DOTALL)}
    if unseen := [name for name in names if name not in runs and name not in kept]:
        print(f"gallery.py: neither a run nor a section on the page: {', '.join(unseen)}; remedy: name them, to run them",
              file=sys.stderr)
        return 2
    processor = next(iter(runs.values())).summary["machine"]["processor"]
    sections = [section(name, runs[name]) if name in runs else kept_section(name, kept[name]) for name in names]
    PAGE.write_text(HEAD.format(processor=processor) + "".join(sections), encoding="utf-8")
    if missing := [name for name in names if name not in runs]:
        print(f"gallery.py: sections kept, because there is no run: {', '.join(missing)}")
    print(f"gallery.py: {PAGE}, {sum(run.summary['cost']['cpu_s'] for run in runs.values()):.0f} s of CPU time")
    warned = [f"{name}: {warning}" for name, run in runs.items() if run.path.name == name for warning in run.summary["warnings"]]
    print("".join(f"gallery.py: {line}\n" for line in warned), end="")
    return 1 if warned else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
