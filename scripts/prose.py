#!/usr/bin/python3
"""Checks the prose of the tree: documents, comments, messages and subjects of commits.

Usage: scripts/prose.py [FILE ...]

Without FILE it checks all files, and the subjects of all commits after the one that added this program. A finding names
file, line, rule and the better word. Exit code 1 if there is a finding.
Text in backticks, formulas, links and code blocks are not prose.
"""
import io
import pathlib
import re
import subprocess
import sys
import tokenize

ROOT = pathlib.Path(__file__).resolve().parent.parent
TOPS = ("paper", "docs", "cases", "src", "tests", "validation", "scripts", "benchmarks", "python", "web/src", "packaging")
# Dated records keep their text. Generated pages come from declarations in src/, generated tables from docs/validation.json.
EXEMPT = ("docs/notebook/", "docs/reference/case-file.md", "docs/reference/study-keys.md", "docs/reference/probes.md",
          "docs/reference/python.md", "scripts/prose.py", "tests/style/prose_test.py")
LONGEST_SENTENCE = 30  # words
LONGEST_SUBJECT = 72  # characters

# Pattern of a word that is out, and the better word. Only words with no second, right meaning in this tree are here.
WORDS = [
    (r"(?<!time )(?<!colour )(?<!title )(?<!progress )(?<!tool )(?<!error )bars?", "target"),
    (r"verdicts?", "result"),
    (r"bench(es)?", "benchmark, or robustness suite"),
    (r"tells?|telling|told", "report, print or warn"),
    (r"wants", "needs or requires"),
    (r"glides?", "slip velocity, or slips"),
    (r"(?<!under )suction", "tension, or negative pressure"),
    (r"jolts?", "spurious acceleration"),
    (r"dear|price", "expensive, or cost"),
    (r"come(s)? near(er)?", "converge"),
    (r"put back", "returned to the domain"),
    (r"end stretch|fed end", "buffer zone"),
    (r"(wave|waves) dies? out|die out", "decay"),
    (r"without a word", "without a message"),
    (r"rooms?(?! for)", "module"),
    (r"room for", "space for"),
    (r"at work", "running"),
    (r"books", "records, or balance"),
    (r"at hand", "available"),
    (r"by the clock|(?<!wall-)clock time", "elapsed time"),
    (r"in the mean", "on average"),
    (r"there shall be", "is"),
    (r"for want of", "because ... is missing"),
    (r"comes? to nothing", "has no effect"),
    (r"at (this|that|the same|any) moment|moments? of time", "instant, or time"),
    (r"(the|this|that|same|one|its|their|each|a|what) shares?|shares of|share of", "fraction"),
    (r"stabilising devices?|devices? (of|for) (the )?(default|step|noise)", "stabilisation term"),
    (r"(?<!--)level (quick|paper|fine|full)|(quick|paper|fine|full) level", "tier"),
    (r"for who|of who|who has", "for users who"),
    (r"nobody", "no process, or no user"),
    (r"what (a|an|the|it|is|was|are|were|they|this|that|each|one|no|else|there)", "the noun itself, as in: cost per step"),
]
GENERATED = re.compile(r"<!-- (validation|evidence): .*?<!-- \1: end -->", re.DOTALL)
OUT = [(re.compile(rf"\b(?:{pattern})\b", re.IGNORECASE), better) for pattern, better in WORDS]
COMMENT_START = re.compile(r"^(Of|What|The same|Likewise|That of|Those of|How (far|much|often|well))\b(?!.*\?)")
NOT_VERBS = set("""a all an and another any as at both by docs each fewer for from if in it its less more most nine no not of on
one only other some such tests that the their these this those to two what when where which who with""".split())
ENDS_IN_S = set("bypass canvas compress cross discuss dress focus guess pass press process stress toss".split())


def is_question(sentence):
    return sentence.rstrip(" *_)").endswith("?")


def plain(text):
    """Markdown without the parts that are not prose; each of them counts as one word."""
    text = re.sub(r"!\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"``.+?``|`[^`]*`", "CODE", text, flags=re.DOTALL)
    text = re.sub(r"\$\$.+?\$\$|\$[^$]+\$", "FORMULA", text, flags=re.DOTALL)
    return re.sub(r"\S+\.(md|toml|cpp|h|py|csv|json)\b|https?://\S+", "CODE", text)


def paragraphs(text):
    """(line, text, whether sentences are counted) of each paragraph, item, heading and table row of a Markdown page."""
    text = GENERATED.sub(lambda block: re.sub(r"[^\n]", "", block[0]), text)
    fence = False
    begin, lines = 0, []
    blank = True  # the line before was blank, so that four spaces begin a code block
    code = formula = html = False
    for number, line in enumerate([*text.splitlines(), ""], 1):
        stripped = line.strip()
        if stripped.startswith("```"):
            fence = not fence
            code = False
            stripped = ""
        html = not fence and (html or stripped.startswith("<!--"))
        formula = formula or (not fence and stripped.startswith("$$"))
        code = not fence and bool(stripped) and line.startswith("    ") and (code or (blank and not lines))
        hidden = fence or code or html or formula or not stripped or stripped == "```"
        if html and "-->" in stripped:
            html = False
        if formula and stripped.rstrip(" ,.;").endswith("$$") and stripped.rstrip(" ,.;") != "$$":
            formula = False
        elif formula and not stripped:
            formula = False
        row = stripped.startswith("|")
        begins = re.match(r"([-*]|\d+\.|#+|>) ", stripped)
        if lines and (hidden or row or begins):
            yield begin, " ".join(lines), True
            lines = []
        blank = not stripped
        if hidden:
            continue
        if row or stripped.startswith("#"):
            yield number, stripped, False
            continue
        if not lines:
            begin = number
        lines.append(re.sub(r"^([-*]|\d+\.|>) ", "", stripped))


def sentences(text):
    text = re.sub(r"\b(e\.g|i\.e|al|Fig|Eq|vs|No|approx|pp|Proc|J|Int|Comput|Phys|Appl|Math)\.", r"\1", text)
    return [part for part in re.split(r"(?<=[.!?])[)*_\"]*\s+", text) if part]


def words_out(text):
    for pattern, better in OUT:
        for found in pattern.finditer(text):
            yield f'"{found[0]}": {better}'


def check_markdown(text):
    for number, paragraph, is_prose in paragraphs(text):
        prose = plain(paragraph)
        asked = " ".join(part for part in sentences(prose) if not is_question(part))
        yield from ((number, "word", what) for what in words_out(asked))
        for sentence in sentences(prose) if is_prose else []:
            words = [word for word in sentence.split() if re.search(r"\w", word)]
            if len(words) > LONGEST_SENTENCE:
                yield number, "length", f'{len(words)} words, at most {LONGEST_SENTENCE}: "{" ".join(words[:6])} ..."'


def comments_of_c(text):
    """(line, text) of each block of // comments, one behind code by itself."""
    block, begin = [], 0
    for number, line in enumerate([*text.splitlines(), ""], 1):
        bare = re.sub(r'"(\\.|[^"\\])*"', '""', line)
        code, mark, comment = bare.partition("//")
        comment = comment.lstrip("/!< ").strip()
        if block and (code.strip() or not mark):
            yield begin, " ".join(block)
            block = []
        if mark and code.strip():
            yield number, comment
        elif mark:
            begin = begin if block else number
            block.append(comment)


def comments_of_python(text):
    try:
        tokens = list(tokenize.generate_tokens(io.StringIO(text).readline))
    except (tokenize.TokenError, IndentationError, SyntaxError):
        return
    before = None
    for token in tokens:
        if token.type == tokenize.COMMENT and not token.string.startswith("#!"):
            yield token.start[0], token.string.lstrip("# ")
        if token.type == tokenize.STRING and before in (None, tokenize.INDENT, tokenize.NEWLINE, tokenize.NL, tokenize.DEDENT):
            yield token.start[0], " ".join(token.string.strip("rf\"'").split())
        if token.type != tokenize.NL and token.type != tokenize.COMMENT:
            before = token.type


def messages_of_c(text):
    """(line, text) of each string of at least three words; adjacent literals are one, and commands in it are no prose."""
    bare = re.sub(r'("(?:\\.|[^"\\\n])*")|//[^\n]*', lambda found: found[1] or "", text)
    for found in re.finditer(r'"(?:\\.|[^"\\\n])*"(?:\s*"(?:\\.|[^"\\\n])*")*', bare):
        joined = "".join(re.findall(r'"((?:\\.|[^"\\\n])*)"', found[0])).replace("\\n", "\n")
        message = re.sub(r"tailwater [a-z].*", "CODE", joined)
        if message.count(" ") >= 2:
            yield bare.count("\n", 0, found.start()) + 1, " ".join(message.split())


def check_messages(messages):
    for number, message in messages:
        yield from ((number, "word", what) for what in words_out(plain(message)))


def check_comments(comments):
    for number, comment in comments:
        text = plain(comment)
        if COMMENT_START.match(text):
            yield number, "start", f'a comment begins with "{text.split()[0]}": begin with its subject'
        yield from ((number, "word", what) for what in words_out(text))


def findings(path, text):
    """(line, rule, what) of a file."""
    if path.suffix == ".md":
        return list(check_markdown(text))
    if path.suffix == ".py":
        return list(check_comments(comments_of_python(text)))
    messages = messages_of_c(text) if "src" in path.parts else []
    return [*check_comments(comments_of_c(text)), *check_messages(messages)]


def files():
    """The files of the tree that hold prose, relative to it."""
    found = [*ROOT.glob("*.md"), ROOT / "web" / "README.md"]
    for top in TOPS:
        found += [path for path in (ROOT / top).rglob("*") if path.suffix in {".md", ".h", ".cpp", ".py", ".ts"}]
    names = sorted(str(path.relative_to(ROOT)) for path in found if path.is_file())
    return [name for name in names if not name.startswith(EXEMPT) and "node_modules" not in name]


def subject_finding(subject):
    """The fault of the subject of a commit, or None."""
    if len(subject) > LONGEST_SUBJECT:
        return f"{len(subject)} characters, at most {LONGEST_SUBJECT}"
    word = re.match(r"[\w'-]*", subject)[0]
    lower = word.lower()
    ends_badly = re.search(r"(ed|ing)$", lower) and lower not in {"embed", "feed", "need", "seed", "shed", "speed", "bring"}
    if (not word[:1].isupper() or lower in NOT_VERBS or ends_badly or subject[len(word):].startswith(":")
            or (re.search(r"[^s]s$", lower) and lower not in ENDS_IN_S)):
        return f'"{word}" is no imperative: begin with a verb, as in "Reject", "Add", "Compute"'
    return None


def git(*words):
    call = subprocess.run(["git", "-C", ROOT, *words], capture_output=True, text=True, check=False)
    return call.stdout.splitlines() if call.returncode == 0 else None


def commit_findings():
    """(commit, rule, what) of commits after the one that added this program; nothing where there is no history."""
    added = git("log", "--diff-filter=A", "--format=%H", "--", "scripts/prose.py")
    if not added:
        return []
    commits = [line.partition(" ") for line in git("log", "--no-merges", "--format=%h %s", f"{added[-1]}..HEAD")]
    faults = [(commit, subject, subject_finding(subject)) for commit, _, subject in commits]
    return [(f"commit {commit}", "subject", f'{fault}: "{subject}"') for commit, subject, fault in faults if fault]


def main(names):
    if any(name.startswith("-") for name in names):
        print(__doc__, file=sys.stderr)
        return 2
    chosen = [str(pathlib.Path(name).resolve().relative_to(ROOT)) for name in names] or files()
    found = [(f"{name}:{number}", rule, what) for name in chosen
             for number, rule, what in findings(ROOT / name, (ROOT / name).read_text(encoding="utf-8"))]
    found += [] if names else commit_findings()
    for place, rule, what in found:
        print(f"{place}: {rule}: {what}")
    print(f"prose.py: {len(found)} findings")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
