"""The paper has the length, sections and references that the Journal of Open Source Software asks for."""

import pathlib
import re
import unittest

PAPER = pathlib.Path(__file__).resolve().parents[2] / "paper"
SECTIONS = ["Summary", "Statement of need", "State of the field", "Software design", "Research impact statement",
            "AI usage disclosure", "Acknowledgements", "References"]
WORDS = 750, 1750
# A thesis, a conference and a journal that gave none; and the page of a library.
WITHOUT_DOI = {"Farzin2014", "Zhou1999", "SoaresFrazao2002", "OzmenCagatay2014", "petsc"}


class Paper(unittest.TestCase):
    def setUp(self):
        _, _, body = (PAPER / "paper.md").read_text(encoding="utf-8").split("---\n", 2)
        self.body = re.sub(r"<!--.*?-->", "", body, flags=re.DOTALL)
        entries = re.split(r"^@\w+\{", (PAPER / "paper.bib").read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]
        self.entries = {entry.partition(",")[0]: entry for entry in entries}

    def test_length(self):
        least, most = WORDS
        self.assertTrue(least <= len(self.body.split()) <= most, len(self.body.split()))

    def test_sections(self):
        found = re.findall(r"^# (.*)$", self.body, re.MULTILINE)
        self.assertEqual([name for name in found if name in SECTIONS], SECTIONS)

    def test_each_reference_is_cited_and_listed(self):
        self.assertEqual({*re.findall(r"@(\w+)", self.body)}, {*self.entries})

    def test_references_have_a_doi(self):
        without = {name for name, entry in self.entries.items() if not re.search(r"doi = \{10\.\d+/\S+\}", entry)}
        self.assertEqual(without, WITHOUT_DOI)

    def test_figures_are_there(self):
        for name in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", self.body):
            self.assertTrue((PAPER / name).is_file(), name)


if __name__ == "__main__":
    unittest.main()
