"""The documents: their case files, commands and scripts hold, and the checker finds each kind of fault."""

import sys
import unittest
from pathlib import Path

from small import PackageTest

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
import pages  # noqa: E402

PAGE = "docs/guide/stl.md"  # whose scripts run here

BAD = """\
# A guide

This page is for nobody.

```toml
[time]
end = 1
```

    [time]
    end = 1

```toml
# append to the template weir
[[probe]]
name = "far"
type = "depht"
```

```toml
# replace in the template weir
[parameters]
Q = 1
```

    tailwater new weir my.toml

```toml
# in my.toml
[parameters]
P = 0.3
```

    tailwater new wier my.toml
    tailwater chekc my.toml
    tailwater check my.toml --previews
    tailwater run other.toml
    tailwater run my.toml --set particles.spacing=-1
    scripts/site.sh
    scripts/build.sh --all
    npm run nothing

```python
x = (
```

Use `tailwater run --jbos 2` and `particles.spacings`.
"""
FAULTS = [(3, "for whom"), (6, "does not state its use"), (10, "no block of TOML"), (14, "depht"), (21, "Q"), (29, "P = 0.2"),
          (34, "no template wier"), (35, "no command chekc"), (36, "no option --previews"), (37, "nothing on the page makes"),
          (38, "spacing"), (39, "cannot be run"), (40, "no option --all"), (41, "no script nothing"), (44, "'(' was never closed"),
          (47, "no key spacings"), (47, "no option --jbos")]

GOOD = """\
# A guide

For users.

    tailwater new wave-flume my.toml

```toml
# in my.toml
[parameters]
h = 0.2
```

```toml
# replace in my.toml
[time]
end = 1
```

```toml
# append to my.toml, without [[damping]]
[[probe]]
name = "energy"
type = "energy"
```

```python
import pathlib
text = pathlib.Path("my.toml").read_text()
assert "end = 1\\n" in text and "energy" in text and "[[damping]]" not in text.replace("without [[damping]]", "")
```

    $ tailwater check my.toml --set particles.spacing=0.02 && tailwater explain my.toml

    my.toml: valid

See `tailwater new --help` and `time.end`.
"""


class Pages(PackageTest):
    def test_every_fault_of_a_bad_page_is_found(self):
        found = pages.page_faults(PAGE, BAD)
        self.assertEqual([line for line, _ in found], [line for line, _ in FAULTS], found)
        for (_, message), (line, words) in zip(found, FAULTS):
            self.assertIn(words, message, line)

    def test_a_good_page_has_no_finding(self):
        self.assertEqual(pages.page_faults(PAGE, GOOD), [])

    def test_scripts_that_no_test_runs_are_found(self):
        text = "# A guide\n\nFor users.\n\n```python\nx = 1\n```\n"
        self.assertEqual(pages.page_faults("docs/guide/editor.md", text), [(6, "no test runs this script")])

    def test_tables_and_probes_without_an_example_are_found(self):
        found = [message for _, message in pages.example_faults(pages.EXAMPLES, "### [[gate]]\n\n### depth\n")]
        self.assertIn("there is no example of force", found)
        self.assertIn("there is no example of wall", found)
        self.assertNotIn("there is no example of gate", found)
        self.assertNotIn("there is no example of depth", found)

    def test_rows_that_stand_twice_are_found(self):
        row = "| a row that is long enough to be more than a heading | 1 | 2 | 3 |\n"
        found = list(pages.repeated_rows({"a": "# A\n" + row, "b": row, "c": f"<!-- evidence: x -->\n{row}<!-- evidence: end -->\n"}))
        self.assertEqual([(name, line) for name, line, _ in found], [("b", 1)])

    def test_numbers_that_stand_twice_under_other_words_are_found(self):
        rows = "| share | 0.5 | 0.75 | 1.0 | **1.5** |\n", "| part that is missing | 0.5 | 0.75 | 1.0 | 1.5 |\n"
        found = list(pages.repeated_rows({"a": "# A\n" + rows[0], "b": rows[1]}))
        self.assertEqual([(name, line) for name, line, _ in found], [("b", 1)])

    def test_documents_have_no_fault(self):
        self.assertEqual(pages.main([]), 0)


if __name__ == "__main__":
    unittest.main()
