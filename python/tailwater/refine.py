"""Propose zones of finer particles from a coarse run, as [[refinement]] tables to paste into the case.

A zone is proposed where water is thin, that is a sheet, jet or tongue of a few particles, around gauges in such water,
and around gauges whose result is uncertain, if the folder of a study is given. `tailwater check` then checks the zones
and estimates their cost.
"""

import json
import math
import os
import re
import sys
import tempfile
import tomllib
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from .case import Case
from .case_features import dimension_of
from .case_text import toml_value
from .command_line import Parser, exit_code_of
from .errors import DataError, InputError
from .program import call
from .run import Run
from .study import COARSEST, Study
from .thin_water import find_thin_water

ROWS = 8  # particles across water that is resolved
OFTEN = 0.05  # fraction of the frames in which a cube must hold thin water
BORDER = 4.0  # spacings of the case, per level
AROUND_GAUGE = 5.0  # spacings beside a gauge that are of the finest spacing
CLEARANCE = 8.5  # spacings from a zone to openings, meshes and walls that move
UNCERTAIN = 0.05  # relative uncertainty of a result, in a study
MOST_OF_THE_WATER = 0.6  # fraction of the wet cubes; above it one spacing is better than a zone
SMALLEST = 3  # cubes with thin water that make a zone


@dataclass
class Zone:
    """A proposed box [m], the rows of particles across the water in it, and the reasons for it."""

    low: np.ndarray
    high: np.ndarray
    rows: float
    reasons: list = field(default_factory=list)
    level: int = 1

    def is_near(self, other, gap):
        return bool((self.low - gap <= other.high).all() and (other.low - gap <= self.high).all())

    def joined(self, other):
        return Zone(np.minimum(self.low, other.low), np.maximum(self.high, other.high), min(self.rows, other.rows),
                    [*self.reasons, *other.reasons])


def groups_of(cells):
    """Lists of neighbouring cells, from an array of indices (n, dimension)."""
    left = {tuple(cell) for cell in cells}
    steps = np.stack(np.meshgrid(*[(-2, -1, 0, 1, 2)] * cells.shape[1]), axis=-1).reshape(-1, cells.shape[1])
    while left:
        group, edge = [], [left.pop()]
        while edge:
            cell = edge.pop()
            group.append(cell)
            for step in steps:
                other = tuple(np.add(cell, step))
                if other in left:
                    left.remove(other)
                    edge.append(other)
        yield np.array(group)


def zones_of_thin_water(water, spacing):
    """Boxes around the thin water that is often in one place."""
    found = []
    for group in groups_of(np.argwhere(water.thin >= OFTEN)):
        if len(group) < SMALLEST:
            continue
        at = tuple(group.T)
        rows = float(np.median(water.thickness[at])) / spacing
        often = float(np.median(water.thin[at]))
        found.append(Zone(water.low + water.edge * group.min(0), water.low + water.edge * (group.max(0) + 1), rows,
                          [f"water {rows:.2g} rows thick, {100 * often:.0f} % of the time"]))
    return found


def places_of(probe, water):
    """The corners [m] of the box that a probe measures; none for a probe of all water."""
    points = [probe[key] for key in ("at", "from", "to") if probe.get(key)]
    if probe["type"] == "depth" and points:
        # The whole column at the place; the height may be missing.
        dim = water.wet.ndim
        flat = np.array(points[0][:dim - 1], float)
        heights = [water.low[-1], water.low[-1] + water.edge * water.wet.shape[-1]]
        return [np.append(flat, height) for height in heights]
    return [np.array(point, float) for point in points]


def rows_at(water, places, spacing):
    """The rows of particles across the water at a gauge: the least of its places, of which dry ones do not count."""
    cells = [cell for cell in map(water.cell_of, np.linspace(places[0], places[-1], 20)) if cell is not None]
    wet = [water.thickness[cell] for cell in cells if water.wet[cell] > OFTEN]
    return float(np.median(wet)) / spacing if wet else math.inf


def zones_of_gauges(run, water, spacing, uncertain):
    """Boxes around gauges in thin water, and around those whose results are uncertain by {probe: relative
    uncertainty}."""
    found = []
    for probe in run.case.get("probe", []):
        places = places_of(probe, water)
        if not places:
            continue
        rows = rows_at(water, places, spacing)
        reasons = []
        if rows < ROWS:
            reasons.append(f"gauge '{probe['name']}' in water {rows:.2g} rows thick")
        if uncertain.get(probe["name"], 0) > UNCERTAIN:
            reasons.append(f"gauge '{probe['name']}', uncertain by {100 * uncertain[probe['name']]:.2g} %")
        if reasons:
            margin = AROUND_GAUGE * spacing
            found.append(Zone(np.min(places, axis=0) - margin, np.max(places, axis=0) + margin, min(rows, ROWS), reasons))
    return found


def uncertainties(study):
    """{probe: largest relative uncertainty of its results}."""
    found = {}
    for row in study.rows:
        if row["limit"] and math.isfinite(row["uncertainty"]):
            found[row["probe"]] = max(found.get(row["probe"], 0), row["uncertainty"] / abs(row["limit"]))
    return found


def merged(zones, gap):
    """Zones of which those with less than a gap [m] between them have become one."""
    zones = list(zones)
    k = 0
    while k < len(zones):
        near = next((other for other in zones[k + 1:] if zones[k].is_near(other, gap)), None)
        if near is None:
            k += 1
            continue
        zones = [zone for zone in zones if zone is not near and zone is not zones[k]] + [zones[k].joined(near)]
        k = 0
    return zones


def walls_around(run, water):
    """The box [m] around the walls at rest and the water of a run."""
    points = [point for wall in run.case.get("wall", []) for point in [*wall.get("points", []),
              *(wall[key] for key in ("min", "max") if wall.get(key))]]
    corners = np.array([*(point for point in points if len(point) == len(water.low)), water.low,
                        water.low + water.edge * np.array(water.wet.shape)])
    return corners.min(0), corners.max(0)


def openings_of(run):
    """The boxes [m] of inlets and outlets that are drawn as segments or rectangles."""
    ends = [np.array([table["from"], table["to"]]) for table in [*run.case.get("inlet", []), *run.case.get("outlet", [])]
            if table.get("from") and table.get("to")]
    return [(end.min(0), end.max(0)) for end in ends]


def kept_off(zone, low, high, clear):
    """The largest part of a zone that is at least `clear` [m] from a box."""
    if not ((zone.low <= high + clear) & (zone.high >= low - clear)).all():
        return zone
    parts = []
    for axis in range(len(low)):
        above, below = replace(zone, low=zone.low.copy()), replace(zone, high=zone.high.copy())
        above.low[axis], below.high[axis] = high[axis] + clear, low[axis] - clear
        parts += [above, below]
    return max(parts, key=lambda part: float(np.prod(np.maximum(part.high - part.low, 0))))


def fitted(zone, run, water, spacing):
    """A zone with space for its border, which ends at the outermost walls or well before them, and before openings."""
    low, high = walls_around(run, water)
    border = BORDER * zone.level * spacing
    zone = replace(zone, low=zone.low - border, high=zone.high + border)
    near = border + 2 * spacing
    zone.low = np.where(zone.low < low + near, low - spacing, np.floor(zone.low / spacing) * spacing)
    zone.high = np.where(zone.high > high - near, high + spacing, np.ceil(zone.high / spacing) * spacing)
    for opening in openings_of(run):
        zone = kept_off(zone, *opening, CLEARANCE * spacing)
    return zone


def propose(run, spacing, most_level, count, uncertain=()):
    """Zones for a case of this spacing [m], from a run of it. Throws DataError if all of its water is thin."""
    water = find_thin_water(run, ROWS, spacing)
    is_thin = (water.thin >= OFTEN).sum() / max(1, (water.wet >= OFTEN).sum())
    if is_thin > MOST_OF_THE_WATER:
        raise DataError(f"{100 * is_thin:.0f} % of the water has fewer than {ROWS} rows of particles of {spacing:g} m: "
                        f"zones would refine almost everything; remedy: particles.spacing = {spacing / 2:g}")
    thin = sorted(zones_of_thin_water(water, spacing), key=lambda zone: -float(np.prod(zone.high - zone.low)))
    zones = merged([*thin, *zones_of_gauges(run, water, spacing, dict(uncertain))], 2 * BORDER * spacing)
    for zone in zones:
        zone.level = int(np.clip(math.ceil(math.log2(ROWS / max(zone.rows, 1))), 1, most_level))
    zones = [fitted(zone, run, water, spacing) for zone in zones[:count]]
    return [zone for zone in zones if (zone.high - zone.low > 2 * BORDER * zone.level * spacing).all()]


def table_of(zone, name):
    """A zone as TOML."""
    def corner(place):
        return toml_value([float(f"{x:.6g}") for x in place])

    reasons = "".join(f"# {reason}\n" for reason in zone.reasons)
    return (f"[[refinement]]\n{reasons}name = {toml_value(name)}\nlevel = {zone.level}\n"
            f"min = {corner(zone.low)}\nmax = {corner(zone.high)}\n")


def names_for(case, count):
    text = case.file.read_text(encoding="utf-8")
    taken = {table.get("name") for table in tomllib.loads(text).get("refinement", [])}
    names = (f"fine{k}" for k in range(1, 1000))
    return [name for name in names if name not in taken][:count]


def checked_with(case, tables, *words):
    """The output of `tailwater check` for a case with these tables. Throws InputError, without places in the file that
    was made for the check."""
    with tempfile.NamedTemporaryFile("w", suffix=".toml", dir=case.file.parent, prefix=f".{case.file.stem}-") as file:
        file.write(text_with(case, tables))
        file.flush()
        try:
            return call("check", *words, file.name, reports_errors="--json" in words)
        except InputError as error:
            raise InputError(re.sub(rf"{re.escape(file.name)}(:\d+)*: ", "", str(error))) from error


def cost_of(case, tables):
    """The lines of `tailwater check` on the zones and the cost of a case with these tables. Throws InputError."""
    lines = checked_with(case, tables, "--no-preview").splitlines()
    begin = next(k for k, line in enumerate(lines) if line.startswith("refinement:"))
    return [line for line in lines[begin:] if not line.startswith("memory:")]


def text_with(case, tables):
    return case.file.read_text(encoding="utf-8").rstrip("\n") + "\n\n" + "\n".join(tables)


def require_zones(case):
    """Throws InputError if the case has errors, or features that zones do not work with."""
    call("check", *case.words(), "--no-preview")
    # Outside of all walls: `check` rejects this zone, after the features.
    beyond = [1e6] * dimension_of(tomllib.loads(case.file.read_text(encoding="utf-8")))
    zone = Zone(np.array(beyond), 2 * np.array(beyond), ROWS)
    name = names_for(case, 1)[0]
    findings = json.loads(checked_with(case, [table_of(zone, name)], "--json"))["findings"]
    features = [found["message"].removesuffix(f"; {found['remedy']}").removeprefix(f"refinement '{name}': ")
                for found in findings if found["id"] == "zone-refuses-feature"]
    if features:
        raise InputError("\n".join(f"{case.file}: {feature}; remedy: refine the whole case by a smaller particles.spacing"
                                   for feature in features))


def accepted(case, zones):
    """(tables, lines on their cost, refused): the zones that `tailwater check` accepts beside each other. Throws
    InputError if the case itself has errors."""
    call("check", *case.words(), "--no-preview")
    tables, refused, cost = [], [], []
    for zone, name in zip(zones, names_for(case, len(zones))):
        try:
            cost = cost_of(case, [*tables, table_of(zone, name)])
            tables.append(table_of(zone, name))
        except InputError as error:
            refused.append((zone, str(error).splitlines()[0]))
    return tables, cost, refused


def coarse_run(case, out):
    """The run of a case at twice its spacing, made if it is not there."""
    if not (out / "summary.json").exists():
        coarse = case.copy()
        own = case["particles.spacing"]
        coarse["particles.spacing"] = f"{COARSEST:g}*({own})" if isinstance(own, str) else COARSEST * own
        coarse.run(out)
    return Run(out)


def source_of(options):
    """(case, coarse run, {probe: uncertainty}) from the words of the user."""
    given = options.source
    if not given.exists() and given.suffix != ".toml":
        raise InputError(f"{given}: is neither a case file nor the folder of a run or a study; remedy: name one of these")
    if not given.is_dir():
        case = Case(given)
        require_zones(case)
        return case, coarse_run(case, options.out or Path(f"{given.stem}_coarse")), {}
    if (given / "study.json").exists():
        study = Study.load(given)
        run, uncertain = study.runs[0], uncertainties(study)
    else:
        run, uncertain = Run(given), {}
    if options.case is None:
        raise InputError(f"{given}: is a folder; remedy: name the case of its runs by --case FILE")
    return Case(options.case), run, uncertain


def spacing_of(case):
    """m; the spacing of a case, in which it may be an expression."""
    own = case["particles.spacing"]
    if not isinstance(own, str):
        return float(own)
    words = call("check", *case.words(), "--no-preview").split("spacing ")
    return float(words[1].split()[0])


def refine(options):
    case, run, uncertain = source_of(options)
    spacing = spacing_of(case)
    zones = propose(run, spacing, options.level, options.zones, uncertain)
    tables, cost, refused = accepted(case, zones)
    print(f"# From {run.path}, with particles {run.spacing:g} m apart.")
    for zone, message in refused:
        print(f"# Not possible ({'; '.join(zone.reasons)}): {message}")
    if not tables:
        print(f"# No zone: no water is thinner than {ROWS} rows of particles of {spacing:g} m for long, nor around gauges."
              if not refused else "# No zone is left.")
        if options.write:
            print(f"# {options.write} is not written, because the case would have no zone.")
        return
    print("\n" + "\n".join(tables))
    print("\n".join(f"# {line}" for line in cost))
    if options.write:
        if options.write.exists():
            raise InputError(f"{options.write} exists; remedy: choose another name")
        options.write.write_text(text_with(case, tables), encoding="utf-8")
        print(f"# written: {options.write}")


def main(arguments):
    parser = Parser("tailwater refine", description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.epilog = ("With a case file, the case is first run at twice its spacing. Example: tailwater refine my.toml "
                     "--level 2 --write my_refined.toml")
    parser.add_argument("source", type=Path, metavar="CASE", help="case file, or the folder of a run or study")
    parser.add_argument("--case", type=Path, metavar="FILE", help="with a folder: the case file to refine")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder of the coarse run (CASE_coarse); used again if it exists")
    parser.add_argument("--level", type=int, default=1, metavar="N", help="finest level that is proposed, 1 to 4 (1)")
    parser.add_argument("--zones", type=int, default=3, metavar="N", help="largest number of zones (3)")
    parser.add_argument("--write", type=Path, metavar="FILE", help="write the case with these zones")
    options = parser.parse_args(arguments)
    if not 1 <= options.level <= 4:
        parser.error(f"--level {options.level}: give 1 to 4")
    if options.zones < 1:
        parser.error(f"--zones {options.zones}: give at least 1")
    if options.program:
        os.environ["TAILWATER"] = str(options.program)
    return exit_code_of(lambda: refine(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
