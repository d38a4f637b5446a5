"""The pictures of a dossier, as PNG in base64: the water of the finest run, and the answer by spacing."""

import base64
import io

from .errors import DataError
from .study import number, quantities_of

__all__ = ["pictures_of"]


def pictures_of(run, study, row, count) -> list:
    """[{"caption", "png"}], with "note" instead of "png" where a picture cannot be drawn."""
    found = []
    if study and row:
        found.append(drawn(f"{row['probe']}, {row['quantity']}, by spacing, with the 95 % interval of its limit.",
                           lambda: [convergence(study, row)]))
    if count > 0:
        found.append(drawn(f"Water of the run at {number(run.spacing)} m.", lambda: pictures_of_run(run, count)))
    return [picture for group in found for picture in group]


def drawn(caption, draw):
    try:
        return [{"caption": caption, "png": base64.b64encode(image).decode()} for image in draw()]
    except (DataError, ImportError, OSError) as error:
        return [{"caption": caption, "note": f"not drawn: {error}"}]


def pictures_of_run(run, count):
    from . import pictures

    before = {path: path.stat().st_mtime_ns for path in run.path.glob("pictures/*.png")}
    folder = pictures.draw(run, count=count)
    made = [path for path in sorted(folder.glob("*.png")) if before.get(path) != path.stat().st_mtime_ns]
    return [path.read_bytes() for path in made]


def convergence(study, row) -> bytes:
    """A diagram of the values over the spacing, those of other starts and of half the time step, and the limit with its
    interval."""
    import matplotlib

    from . import plots

    with matplotlib.rc_context(plots.STYLE):
        figure = plots.new_figure(6.5, 3.2)
        axes = figure.subplots()
        axes.plot(study.spacings, row["values"], "o", color=plots.BLUE, label="run")
        key = row["probe"], row["quantity"]
        for runs, mark, label in ((study.starts, "x", "other initial positions"), ([study.step], "+", "half the time step")):
            points = [(run.spacing, quantities_of(run)[key][0]) for run in runs if run]
            if points:
                axes.plot(*zip(*points), mark, color=plots.ORANGE, label=label)
        middle, low, high = (row[name] for name in ("limit", "low", "high"))
        axes.errorbar([0], [middle], [[middle - low], [high - middle]], fmt="s", color=plots.BLACK, capsize=4, label="limit")
        unit = f" ({row['unit']})" if row["unit"] else ""
        axes.set(xlim=(-0.05 * study.spacings[-1], None), xlabel="spacing (m)", ylabel=f"{plots.plain(row['quantity'])}{unit}")
        axes.legend(frameon=False)
        image = io.BytesIO()
        figure.savefig(image, dpi=plots.DPI, format="png")
    return image.getvalue()
