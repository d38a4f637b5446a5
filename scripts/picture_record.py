#!/usr/bin/python3
"""Records the inputs of each picture of the documents, and finds pictures that are older than their inputs.

Usage: scripts/picture_record.py PICTURE ...   records pictures that were just made, or compared with new ones and kept
       scripts/picture_record.py --check       prints pictures whose inputs changed since; exit code 1 if there is one

docs/images/pictures.json holds, for each picture, its script, its date, a hash of the picture and one of each input. Inputs
are the case or the page, the drawing code and the viewer, without comments; not the solver. Scripts record the pictures
they make.
"""
import ast
import datetime
import fnmatch
import hashlib
import json
import pathlib
import re
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"
RECORD = IMAGES / "pictures.json"
SUFFIXES = {".webp", ".svg", ".gif"}
PLOTS = ["python/tailwater/plots.py", "python/tailwater/pictures.py"]
PLOTS_3D = [*PLOTS, *(f"python/tailwater/{name}.py" for name in ("pictures_3d", "scene", "surface"))]
VIEWER = ["web/dist/view.html", "web/test/pictures/pictures.test.ts"]
WEIR = "cases/flume/weir.toml"
ZHOU = "cases/zhou1999/case.toml"
GUIDE = ("waves_on_a_wall", "floating_box", "sloshing", "overtopping", "gate_and_basin")
DRAWN_BY = {"hydraulic-jump": ["scripts/gallery.py#draw_mean"]}
# Pattern of the picture, script, and inputs: FILE, or FILE#PART as `part_of` names them.
RULES = [
    ("examples/*.svg", "scripts/example_pictures.py",
     ["docs/reference/examples.md#{file}", "src/checks/preview.cpp"]),
    ("view_3d.webp", "npm --prefix web run pictures", [*VIEWER, "src/app/templates/pier.toml", "src/app/templates/pier.obj"]),
    ("view_report.webp", "npm --prefix web run pictures", VIEWER),
    ("view_*.webp", "npm --prefix web run pictures", [*VIEWER, WEIR]),
    ("wall_pressure.webp", "scripts/wall_pressure_picture.py", ["scripts/wall_pressure_picture.py", ZHOU]),
    ("dam_break.gif", "scripts/moving_picture.py", ["scripts/moving_picture.py", "python/tailwater/plots.py", ZHOU]),
    ("work_precision.webp", "benchmarks/work_precision.py",
     ["benchmarks/work_precision.py#draw", "validation/tailwater_validation/work_precision.json"]),
    ("kleefsman2005.webp", "scripts/case_pictures.py kleefsman2005",
     ["scripts/case_pictures.py#PICTURES.kleefsman2005", "cases/kleefsman2005/case.toml", *PLOTS_3D]),
    ("spillway_spacing.webp", "scripts/case_pictures.py spillway_spacing",
     ["scripts/case_pictures.py#PICTURES.spillway_spacing", "scripts/gallery_pictures.py#PICTURES.spillway",
      "src/app/templates/spillway.toml", *PLOTS_3D]),
    ("stl_part.webp", "scripts/case_pictures.py stl_part",
     ["scripts/case_pictures.py#PICTURES.stl_part", "docs/guide/stl.md#code", *PLOTS_3D]),
    *((pattern, f"scripts/walk_guides.py {guide}", [f"docs/guide/{guide}.md#code", f"scripts/walk_guides.py#draw_{guide}", *PLOTS])
      for guide in GUIDE for pattern in (f"{guide}.webp", f"{guide}_*.webp")),
]


def template_files(name):
    """The files of a template of `tailwater new`: its case, and the mesh or the bed that the case names."""
    own = pathlib.Path("src/app/templates") / f"{name}.toml"
    file = own if (ROOT / own).is_file() else pathlib.Path("cases/flume") / f"{name.replace('-', '_')}.toml"
    text = (ROOT / file).read_text(encoding="utf-8")
    return [str(file), *(str(file.parent / other) for other in re.findall(r'^(?:file|points_file) = "(.*)"', text, re.MULTILINE))]


def gallery_inputs(name):
    files = template_files(name)
    case = tomllib.loads((ROOT / files[0]).read_text(encoding="utf-8"))
    drawing = PLOTS_3D if case["case"].get("dimension") == 3 else PLOTS
    return [*files, f"scripts/gallery_pictures.py#PICTURES.{name}", *DRAWN_BY.get(name, []), *drawing]


def script_and_inputs(picture):
    """Script and inputs of a picture, a path in docs/images. Throws KeyError if no rule makes the picture."""
    path = pathlib.Path(picture)
    if path.parent.name == "gallery":
        return f"scripts/gallery.py {path.stem}", gallery_inputs(path.stem)
    for pattern, script, inputs in RULES:
        if fnmatch.fnmatch(picture, pattern):
            return script, [name.format(file=picture) for name in inputs]
    raise KeyError(f"docs/images/{picture}: no script makes it; remedy: add the script to RULES of scripts/picture_record.py")


def without_docstrings(tree):
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list) and body and isinstance(body[0], ast.Expr) and isinstance(body[0].value, ast.Constant):
            body[0].value.value = ""
    return ast.dump(tree)


def part_of(text, suffix, part):
    """A function of a script, a value `TABLE.KEY` of a table in it, the cases, scripts and commands of a page, or the block
    before a picture."""
    if suffix == ".py":
        table, _, key = part.partition(".")
        for node in ast.parse(text).body:
            if isinstance(node, ast.FunctionDef) and node.name == part:
                return without_docstrings(node)
            if key and isinstance(node, ast.Assign) and node.targets[0].id == table:
                return "".join(ast.dump(value) for name, value in zip(node.value.keys, node.value.values) if name.value == key)
        raise KeyError(f"no function or table {part}")
    if part == "code":
        return "".join(re.findall(r"^```(?:toml|python)\n.*?^```|^    tailwater .*?$", text, re.MULTILINE | re.DOTALL))
    return text[:text.index(part)].rpartition("```toml\n")[2]


def hash_of(name):
    file, _, part = name.partition("#")
    path = ROOT / file
    if path.suffix not in {".py", ".toml", ".md", ".cpp"}:
        return hashlib.sha256(path.read_bytes()).hexdigest()[:12]
    text = path.read_text(encoding="utf-8")
    if part:
        text = part_of(text, path.suffix, part)
    elif path.suffix == ".py":
        text = without_docstrings(ast.parse(text))
    elif path.suffix == ".toml":
        text = json.dumps(tomllib.loads(text))
    else:
        text = re.sub(r"^\s*//.*\n", "", text, flags=re.MULTILINE)
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def entry(picture):
    script, inputs = script_and_inputs(picture)
    return {"script": script, "made": str(datetime.date.today()), "picture": hash_of(f"docs/images/{picture}"), "inputs": {name: hash_of(name) for name in inputs}}


def write(*paths):
    """Records pictures in docs/images; other pictures are left out."""
    record = json.loads(RECORD.read_text(encoding="utf-8")) if RECORD.is_file() else {}
    for path in map(pathlib.Path, paths):
        if path.resolve().is_relative_to(IMAGES):
            picture = str(path.resolve().relative_to(IMAGES))
            old, record[picture] = record.get(picture), entry(picture)
            if old and old["picture"] == record[picture]["picture"]:
                record[picture]["made"] = old["made"]  # kept
    lines = (f"{json.dumps(name)}: {json.dumps(record[name])}" for name in sorted(record) if (IMAGES / name).is_file())
    RECORD.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


def findings():
    """One line for each picture without a record, for each record without a picture, and for each picture that is stale."""
    record = json.loads(RECORD.read_text(encoding="utf-8"))
    pictures = {str(path.relative_to(IMAGES)) for path in IMAGES.rglob("*") if path.suffix in SUFFIXES}
    for picture in sorted(pictures | set(record)):
        if picture not in record or picture not in pictures:
            yield f"docs/images/{picture}: {'no record' if picture in pictures else 'a record without the picture'}"
            continue
        try:
            old, new = record[picture], entry(picture)
        except (KeyError, OSError) as error:  # no rule, or an input that is gone
            yield f"docs/images/{picture}: {error.args[0] if isinstance(error, KeyError) else error}"
            continue
        changed = [name for name in sorted(set(old["inputs"]) | set(new["inputs"])) if old["inputs"].get(name) != new["inputs"].get(name)]
        if old["picture"] != new["picture"]:
            yield f"docs/images/{picture}: the picture is not the recorded one; remedy: {new['script']}"
        elif changed:
            yield f"docs/images/{picture}: older than {', '.join(changed)}; remedy: {new['script']}"


def main(arguments):
    if not arguments or (arguments[0].startswith("-") and arguments != ["--check"]):
        print(__doc__, file=sys.stderr)
        return 2
    if arguments != ["--check"]:
        write(*arguments)
        return 0
    found = list(findings())
    print("\n".join(found) or "picture_record.py: no picture is older than its inputs")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
