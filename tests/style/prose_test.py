"""The checker of prose finds each fault of a made-up page, of made-up comments and of made-up subjects of commits, and
none in a good page."""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import prose  # noqa: E402

PAGE = "README.md"  # the rules of a page, whatever its name
BAD_PAGE = """\
# The bars

`explain` tells the case in sentences.

This is what a step costs, and here is a list:

- A sentence that goes on and on without an end, although it could have been divided into two or three, has more than
  thirty words and is read twice by each of its readers.

| gate | verdict |
| --- | --- |
"""

GOOD_PAGE = """\
# What is a step? For users

For users of the program. `tells` in code, $a bar$ in a formula and [a link](what-a-page) are not prose.
What is a weir? The time bar shows the time.

    tailwater tells a verdict

```python
bar = "what a step costs"
```

| quantity | target |
| --- | --- |
| a row of a table may be a list of more than thirty words, because it is no sentence: one two three four five six seven \
eight nine ten eleven twelve thirteen fourteen fifteen | met |
"""


def rules(name, text):
    return [(number, rule) for number, rule, _ in prose.findings(pathlib.Path(name), text)]


class Prose(unittest.TestCase):
    def test_every_fault_of_a_bad_page_is_found(self):
        self.assertEqual(rules(PAGE, BAD_PAGE),
                         [(1, "word"), (3, "word"), (5, "word"), (7, "length"), (10, "word")])

    def test_findings_name_the_better_word(self):
        self.assertIn('"verdict": result', [what for _, _, what in prose.findings(pathlib.Path(PAGE), BAD_PAGE)])

    def test_a_good_page_has_no_finding(self):
        self.assertEqual(rules(PAGE, GOOD_PAGE), [])

    def test_comments_of_cpp_begin_with_their_subject(self):
        text = '// Of walls only.\nint a;  // What it costs.\n// Speed of the wall, "of" rest.\nauto url = "http://of";\n'
        self.assertEqual(rules("bad.h", text), [(1, "start"), (2, "start"), (2, "word")])
        text = "/// That of its wall.\nint a;\n/// How far it goes.\nint b;\n/// That is why. How?\nint c;\n"
        self.assertEqual(rules("bad.h", text), [(1, "start"), (3, "start")])

    def test_messages_of_the_program_are_prose(self):
        text = ('throw InputError("the {} has no "\n                 "room for water", name);  // "a bar of it"\n'
                'auto url = "http://a";\n')
        self.assertEqual(rules("src/bad.cpp", text), [(1, "word")])
        self.assertEqual(rules("src/good.cpp", 'tell("Examples: tailwater bench speed and more\\n");\n'), [])

    def test_comments_and_docstrings_of_python_begin_with_their_subject(self):
        text = '"""Of walls only."""\nx = "told"  # Likewise here.\n\ndef f():\n    """What it is: a bar."""\n'
        self.assertEqual(rules("bad.py", text), [(1, "start"), (2, "start"), (5, "start"), (5, "word"), (5, "word")])

    def test_subjects_are_imperative_and_short(self):
        for subject in ("Reject inlets that fill a closed space", "Process a pipe", "Need a reason", "Embed a font"):
            self.assertIsNone(prose.subject_finding(subject), subject)
        for subject in ("check refuses an inlet", "A value is looked at before its key", "Tests: all of them", "Added a page",
                        "Adding a page", "Tests share a bed", "Reject " + 70 * "x"):
            self.assertIsNotNone(prose.subject_finding(subject), subject)


if __name__ == "__main__":
    unittest.main()
