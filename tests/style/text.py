"""Rules of texts: lines of Markdown have up to 120 characters, nothing cites a file that is not in the tree, only notebooks
name commits, loops over particles go through base/for_each.h or say on their line why they are plain loops
(`// in order: appends`), files and functions are short, and local functions of a module, whose files are compiled as one,
have names of their own.
Usage: text.py markdown|citations|loops|lengths|locals ROOT"""
import pathlib
import re
import sys

TEXTS = {".md", ".h", ".cpp", ".py", ".toml", ".txt", ".sh", ".csv"}
LONGEST = 120
LONGEST_FILE = 400
LONGEST_FUNCTION = 60
WRITTEN = {"speed.md"}  # by the program, beside its runs
COMMIT = re.compile(r"\b(?=[0-9a-f]*[0-9])(?=[0-9a-f]*[a-f])[0-9a-f]{7,12}\b")
NAMES_COMMITS = {"docs/validation.md"}  # the one that its results are of


def files(root):
    """Files of the tree, without those of builds and runs."""
    for top in ("", "src", "tests", "docs", "paper", "cases", "validation", "scripts", "cmake", "benchmarks", "python"):
        for file in sorted((root / top).rglob("*") if top else root.glob("*")):
            if file.is_file() and file.suffix in TEXTS and file != pathlib.Path(__file__).resolve():
                yield file


def numbered(file):
    return enumerate(file.read_text(encoding="utf-8").splitlines(), 1)


def is_prose(line):
    """Not a row of a table, and not one word that cannot be broken, such as a link."""
    return not line.lstrip().startswith("|") and " " in line.strip()[:LONGEST]


def markdown(root):
    for file in files(root):
        if file.suffix == ".md":
            for number, line in numbered(file):
                if len(line) > LONGEST and is_prose(line):
                    yield file, number, f"{len(line)} characters; break the line at {LONGEST}"


def may_name_commits(file, root):
    path = file.relative_to(root)
    return path.is_relative_to("docs/notebook") or str(path) in NAMES_COMMITS


def is_present(file, root):
    """A document of the present version: a dated page, and the changelog, may name a source that is gone."""
    path = file.relative_to(root)
    return path.suffix == ".md" and path.name != "CHANGELOG.md" and not path.name.startswith("2026-")


def citations(root):
    names = {file.name for file in files(root)} | WRITTEN
    for file in files(root):
        for number, line in numbered(file):
            for issue in re.findall(r"\bissue (?:#\s*)?\d+\b", line):
                yield file, number, f'cites "{issue}", which is not in the tree; say here what it says'
            for commit in COMMIT.findall(line) if file.suffix == ".md" and not may_name_commits(file, root) else []:
                yield file, number, f"names commit {commit}; say what it measured, and leave commits to a notebook"
            for name in re.findall(r"[\w-]+\.md\b", line):
                if name not in names:
                    yield file, number, f"cites {name}, which is not in the tree; say here what it says"
            for source in re.findall(r"`[\w/]*?([\w-]+\.(?:cpp|h))`", line) if is_present(file, root) else []:
                if source not in names:
                    yield file, number, f"names the source {source}, which is not in the tree"


def loops(root):
    loop = re.compile(r"\bfor \([^;]*; \w+ < [^;]*\bowned\b[^;]*;")
    reason = re.compile(r"// in order: \w")
    for file in files(root):
        if file.is_relative_to(root / "src") and file.suffix in {".h", ".cpp"} and file.name != "for_each.h":
            for number, line in numbered(file):
                if loop.search(line) and not reason.search(line):
                    yield file, number, ("a loop over particles of its own; use one of base/for_each.h, or say why its "
                                         "rows depend on each other: // in order: reason")


def lengths(root):
    """Blocks are those of clang-format: an end has the indentation of the line on which its block begins."""
    for file in files(root):
        if not file.is_relative_to(root / "src") or file.suffix not in {".h", ".cpp"} or file.name == "spec.h":
            continue  # spec.h is the table of all keys
        lines = file.read_text(encoding="utf-8").splitlines()
        if len(lines) > LONGEST_FILE:
            yield file, len(lines), f"{len(lines)} lines; at most {LONGEST_FILE}: split it"
        begins = {}  # of a block that may be open, by its indentation
        for number, line in enumerate(lines, 1):
            indentation = len(line) - len(line.lstrip())
            if indentation > 2 or not line.strip():
                continue
            if line.strip().startswith("}"):
                first = begins.pop(indentation, number)
                if number - first + 1 > LONGEST_FUNCTION:
                    yield file, first, f"a function of {number - first + 1} lines; at most {LONGEST_FUNCTION}: split it"
            elif re.match(r"\s*(namespace|struct|class|union|enum)\b", line):
                begins.pop(indentation, None)
            else:
                begins[indentation] = number


def local_names(root):
    """With two local functions of one name and other arguments, a call in either file may take the other's."""
    for module in sorted(path for path in (root / "src").iterdir() if path.is_dir()):
        seen = {}  # name: file
        for file in sorted(module.glob("*.cpp")):
            is_local = False
            for number, line in numbered(file):
                is_local = line == "namespace {" or is_local and line != "}  // namespace"
                function = re.match(r"(?!return|template|struct|class)[A-Za-z][\w:<>,&*\s]*[\s&*>](\w+)\(", line)
                if is_local and function and seen.setdefault(function[1], file) != file:
                    yield file, number, f"{function[1]} is local to {seen[function[1]].name} too: give one another name"


def main():
    root = pathlib.Path(sys.argv[2]).resolve()
    found = list({"markdown": markdown, "citations": citations, "loops": loops, "lengths": lengths,
                  "locals": local_names}[sys.argv[1]](root))
    print("\n".join(f"{file.relative_to(root)}:{number}: {what}" for file, number, what in found))
    if found:
        sys.exit(f"{len(found)} findings")


main()
