#!/usr/bin/python3
"""Builds the site from the documents of the tree: out/site/index.html, which opens without a server and without the net.

Usage: scripts/site.py [DIR]    DIR: where to put it (default: out/site)
Needs `scripts/install.sh site`. Exit code 1 if mkdocs warns or a link is dead: every link of every page must lead to a
page, to a place on it, or to a file that is there, and no page may load anything from the net. The search must find every
key, probe type and column of the reference, every key of summary.json, and the id of every message.
"""
import html.parser
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent
KATEX = pathlib.Path("/usr/share/javascript/katex")
MATH = re.compile(r"^```math\n(.*?)^```$", re.DOTALL | re.MULTILINE)  # as GitHub has blocks of formulas
LINK = re.compile(r"(?<=\]\()([^)\s#]+)(?=[)#])")
COMMENT = re.compile(r"<!--.*?-->\n?", re.DOTALL)
CODE = re.compile(r"`[^`\n]+`")
ITEM = re.compile(r"([-*]|\d+\.) ")
PICTURE = re.compile(r"(?<=\n\n)!\[([^\]]+)\]\(([^)]+)\)(?=\n\n[^*]|\n*$)")  # alone, and without a caption below it


def pages():
    """Documents of the tree, relative to it."""
    return sorted(path.relative_to(ROOT) for pattern in ("*.md", "web/*.md", "docs/**/*.md", "cases/*/README.md")
                  for path in ROOT.glob(pattern))


def title(page):
    return next((line[2:] for line in (ROOT / page).read_text(encoding="utf-8").splitlines() if line.startswith("# ")),
                page.stem)


def indented(text):
    """With twice the indentation in lists: the site nests them by four spaces, GitHub by two."""
    lines, fence, is_in_list = [], None, False
    for line in text.split("\n"):
        bare = line.lstrip(" ")
        indent = len(line) - len(bare)
        if fence is None and bare and (indent == 0 or ITEM.match(bare)):
            is_in_list = ITEM.match(bare) is not None
        lines.append((" " * (indent if fence is None else fence) if is_in_list else "") + line)
        if bare.startswith("```"):
            fence = indent if fence is None else None
    return "\n".join(lines)


def as_site(text):
    """A document in the Markdown of the site, where that differs from GitHub's."""
    text = MATH.sub(r"$$\n\1$$", text)
    text = COMMENT.sub("", text)
    text = CODE.sub(lambda code: code[0].replace("\\|", "|"), text)  # in a cell of a table
    text = PICTURE.sub(lambda picture: "<figure><img alt={0} src={1}><figcaption>{2}</figcaption></figure>".format(
        *(json.dumps(html.escape(part, quote=True), ensure_ascii=False) for part in picture.groups()),
        html.escape(picture[1])), text)
    return indented(text)


def stage(folder):
    """Lays the documents out in `folder` as they are in the tree, with the files that they link to."""
    for page in pages():
        text = (ROOT / page).read_text(encoding="utf-8")
        for link in set(LINK.findall(text)):
            target = ((ROOT / page).parent / link).resolve()
            if "://" in link or not target.is_relative_to(ROOT):
                continue
            if target.is_dir():  # a site has no folders to look at
                to = f"{link.rstrip('/')}/README.md" if (target / "README.md").is_file() else None
                text = text.replace(f"]({link})", f"]({to})") if to else re.sub(
                    r"\[([^\]]*)\]\(" + re.escape(link) + r"\)", r"\1", text)
            elif target.is_file() and target.suffix != ".md":
                copy = folder / target.relative_to(ROOT)
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(target, copy)
        copy = folder / page
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(as_site(text), encoding="utf-8")
    shutil.copytree(KATEX, folder / "katex", ignore=shutil.ignore_patterns("*.mjs", "contrib"))
    shutil.copyfile(KATEX / "contrib" / "auto-render.js", folder / "katex" / "auto-render.js")
    for name in ("formulas.js", "site.css"):
        shutil.copyfile(ROOT / "site" / name, folder / name)


def entries(pattern, newest_first=False):
    chosen = [page for page in pages() if page.match(pattern)]
    chosen.sort(key=lambda page: (page.name != "README.md" or "cases" in page.parts, page.name, str(page)),
                reverse=newest_first)
    return [{title(page): str(page)} for page in chosen]


def configuration(source, target):
    config = yaml.safe_load((ROOT / "site" / "mkdocs.yml").read_text(encoding="utf-8"))
    named = set(re.findall(r"docs/theory/[\w-]+\.md", yaml.safe_dump(config["nav"])))  # pages with a place of their own
    theory = [entry for entry in entries("docs/theory/*.md") if not named & set(entry.values())]
    lists = {"THEORY": theory, "CASES": entries("cases/*/README.md"),
             "NOTEBOOK": entries("docs/notebook/*.md", newest_first=True)}

    def fill(node):
        if isinstance(node, list):
            return [fill(child) for child in node]
        if isinstance(node, dict):
            return {key: fill(child) for key, child in node.items()}
        return lists.get(node, node)

    config["theme"]["custom_dir"] = str(ROOT / "site" / config["theme"]["custom_dir"])
    return config | {"docs_dir": str(source), "site_dir": str(target), "nav": fill(config["nav"])}


VERBATIM = {"code", "pre", "script", "style", "title"}


class Links(html.parser.HTMLParser):
    """Links of a page, the files it loads, the places on it, and its lines with a formula that was not recognised."""

    def __init__(self, text):
        super().__init__()
        self.links, self.loads, self.places, self.raw_formulas = [], [], set(), []
        self.verbatim = 0  # how many elements around the text show it as it is
        self.feed(text)

    def handle_endtag(self, tag):
        self.verbatim -= tag in VERBATIM

    def handle_data(self, data):
        if self.verbatim == 0:
            self.raw_formulas += [line.strip() for line in data.split("\n") if line.count("$") > 1]

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.verbatim += tag in VERBATIM
        self.places |= {values[key] for key in ("id", "name") if values.get(key)}
        if tag == "a" and values.get("href"):
            self.links.append(values["href"])
        if tag in ("img", "script") and values.get("src"):
            self.loads.append(values["src"])
        if tag == "link" and values.get("rel") == "stylesheet":
            self.loads.append(values["href"])


def dead_links(site, parsed):
    """[(page, link)] that lead nowhere or out of the machine, of {page: Links}."""
    dead = []
    for page, found in parsed.items():
        for link in found.links + found.loads:
            address = urllib.parse.urlsplit(link)
            if address.scheme in ("http", "https", "mailto"):
                if link in found.loads:
                    dead.append((page.relative_to(site), link))
                continue
            path = urllib.parse.unquote(address.path)
            target = page if not path else (site / path.lstrip("/") if path.startswith("/") else (page.parent / path)).resolve()
            if target.is_dir():
                target = target / "index.html"
            place = urllib.parse.unquote(address.fragment)
            if page.name != "404.html" and (not target.is_file() or
                                            (place and target in parsed and place not in parsed[target].places)):
                dead.append((page.relative_to(site), link))
    return dead


def names_of_reference():
    """Keys and tables of the case file, types of probes, their columns and results, ids of messages, keys of
    summary.json and columns of steps.csv, as the reference lists them: in the first cells of tables, and in headings."""
    text = "".join((ROOT / f"docs/reference/{name}.md").read_text(encoding="utf-8")
                   for name in ("case-file", "study-keys", "probes", "messages", "summary"))
    cells = " ".join(re.findall(r"^\| (`[^|]*) \|", text, re.MULTILINE))
    return {*re.findall(r"`([\w.-]+)`", cells), *re.findall(r"^##+ \[*([\w-]+)\]*$", text, re.MULTILINE)}


def names_not_found(site):
    """Names of the reference that the search of the site would not find."""
    index = json.loads((site / "search" / "search_index.json").read_text(encoding="utf-8"))
    separator = re.compile(index["config"]["separator"])
    words = {word.lower() for entry in index["docs"] for word in separator.split(entry["text"])}
    keeps_all = '"search.config.pipeline": "trimmer"' in (site / "index.html").read_text(encoding="utf-8")
    return sorted(name for name in names_of_reference()
                  if not keeps_all or not {part for part in separator.split(name.lower()) if part} <= words)


def main(arguments):
    if len(arguments) > 1 or any(argument.startswith("-") for argument in arguments):
        print(__doc__, file=sys.stderr)
        return 2
    site = pathlib.Path(arguments[0] if arguments else ROOT / "out" / "site").resolve()
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder) / "pages"
        source.mkdir()
        stage(source)
        config = pathlib.Path(folder) / "mkdocs.yml"
        config.write_text(yaml.safe_dump(configuration(source, site)), encoding="utf-8")
        built = subprocess.run(["mkdocs", "build", "--strict", "--quiet", "--config-file", config], check=False)
    if built.returncode != 0:
        return 1
    parsed = {path: Links(path.read_text(encoding="utf-8")) for path in site.rglob("*.html")}
    raw = [(page.relative_to(site), line) for page, found in parsed.items() for line in found.raw_formulas]
    dead, lost = dead_links(site, parsed), names_not_found(site)
    for page, line in raw:
        print(f"site.py: {page}: a formula of this line is not recognised: {line}")
    for page, link in dead:
        print(f"site.py: {page}: {link} leads nowhere")
    for name in lost:
        print(f"site.py: the search does not find {name}")
    if not dead and not lost and not raw:
        print(f"site.py: {len(list(site.rglob('*.html')))} pages, no dead link, the search finds {len(names_of_reference())} "
              f"names: {site / 'index.html'}")
    return 1 if dead or lost or raw else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
