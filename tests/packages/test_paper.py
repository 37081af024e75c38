"""docs/paper/paper.md has the form that the Journal of Open Source Software asks for: fields, sections, length, references; issue forms have theirs.
docs/paper/method.md, a manuscript, has its references, and its numbers stand on the pages that it names.

Needs python3-yaml; and pandoc (tools/install-dependencies packages) for the references, else that test is skipped.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import TOP  # noqa: E402

PAPER = TOP / "docs/paper/paper.md"
SECTIONS = ["Summary", "Statement of need", "State of the field", "Software design", "Verification", "Research impact", "Acknowledgements", "References"]
MOST_WORDS = 1000
DOI = re.compile(r"10\.\d{4,9}/\S+")


def split(text):
    _, head, body = re.split(r"^---$", text, maxsplit=2, flags=re.M)
    return yaml.safe_load(head), body


def entries(bib):
    """{key: {field: text}} of a file of BibTeX in which each field has a line of its own."""
    return {key: dict(re.findall(r"^  (\w+) = \{(.*)\},?$", fields, re.M)) for key, fields in re.findall(r"^@\w+\{(\w+),\n(.*?)^\}", bib, re.M | re.S)}


def resolve(text, bib, name="paper.bib"):
    """The text with its citations and references, and what pandoc complains of."""
    with tempfile.TemporaryDirectory() as path:
        folder = pathlib.Path(path)
        (folder / "paper.md").write_text(text)
        (folder / name).write_text(bib)
        done = subprocess.run(["pandoc", "--citeproc", "--to=plain", "--wrap=none", "paper.md"], cwd=folder, capture_output=True, text=True, check=False)
    return done.stdout, done.stderr


class Paper(unittest.TestCase):
    text = PAPER.read_text(encoding="utf-8")
    bib = (PAPER.parent / "paper.bib").read_text(encoding="utf-8")

    def test_fields(self):
        head, _ = split(self.text)
        self.assertEqual(set(head), {"title", "tags", "authors", "affiliations", "date", "bibliography"})
        known = {place["index"] for place in head["affiliations"]}
        for author in head["authors"]:
            self.assertTrue(author["name"])
            self.assertIn(author["affiliation"], known)
        self.assertEqual(head["bibliography"], "paper.bib")
        self.assertRegex(str(head["date"]), r"^\d{1,2} [A-Z][a-z]+ \d{4}$")

    def test_sections_and_length(self):
        _, body = split(self.text)
        self.assertEqual(re.findall(r"^# (.*)$", body, re.M), SECTIONS)
        self.assertLessEqual(len(body.split()), MOST_WORDS)

    def test_references(self):
        found = entries(self.bib)
        self.assertEqual(set(re.findall(r"@(\w+)", split(self.text)[1])), set(found))
        for key, fields in found.items():
            self.assertTrue({"author", "title", "year"} <= set(fields), key)
            self.assertTrue(DOI.fullmatch(fields.get("doi", "")) or fields.get("url", "").startswith("https://"), key)
        self.assertEqual(found["Padding2009"]["doi"], yaml.safe_load((TOP / "CITATION.cff").read_text())["references"][0]["doi"])

    @unittest.skipUnless(shutil.which("pandoc"), "pandoc is not installed")
    def test_citations_resolve(self):
        told, complaints = resolve(self.text, self.bib)
        self.assertEqual(complaints, "")
        for fields in entries(self.bib).values():
            self.assertIn(fields.get("doi") or fields["url"], told)
        _, complaints = resolve(self.text.replace("@Padding2009", "@Padding2008"), self.bib)
        self.assertIn("Padding2008", complaints)

    def test_the_review_list(self):
        """Open are persons, the public address and the archive, and nothing else."""
        text = (PAPER.parent / "checklist.md").read_text()
        points = re.findall(r"^\| ([^|]+) \| \*\*Open\*\*", text, re.M)
        self.assertEqual(points, ["repository", "contribution and authorship", "disclosures that the journal asks of authors", "archive"])


class Method(unittest.TestCase):
    text = (PAPER.parent / "method.md").read_text(encoding="utf-8")
    bib = (PAPER.parent / "method.bib").read_text(encoding="utf-8")

    def test_length_and_references(self):
        self.assertTrue(1500 <= len(split(self.text)[1].split()) <= 2500, len(self.text.split()))
        found = entries(self.bib)
        self.assertEqual(set(re.findall(r"@(\w+)", split(self.text)[1])), set(found))
        for key, fields in found.items():
            self.assertTrue({"author", "title", "year"} <= set(fields), key)
            self.assertTrue(DOI.fullmatch(fields.get("doi", "")) or fields.get("url", "").startswith("https://"), key)

    def test_numbers_stand_on_their_pages(self):
        body, _, table = self.text.partition("# 8. Numbers and their commands")
        rows = re.findall(r"^\| ([^|]+) \| \[[^]]+\]\(([^)]+)\) \| ([^|]+) \|$", table, re.M)
        self.assertGreater(len(rows), 5)
        for number, page, _ in rows:
            self.assertIn(number, (PAPER.parent / page).resolve().read_text(encoding="utf-8"), page)
            self.assertIn(number, body)

    @unittest.skipUnless(shutil.which("pandoc"), "pandoc is not installed")
    def test_it_builds(self):
        told, complaints = resolve(self.text, self.bib, "method.bib")
        self.assertEqual(complaints, "")
        self.assertIn("Sirk", told)


class Forms(unittest.TestCase):
    def test_issue_forms(self):
        """Each form has a name, a description, and fields with labels and identifiers of their own; something is required."""
        forms = sorted((TOP / ".github/ISSUE_TEMPLATE").glob("*-*.yml"))
        self.assertEqual([path.name for path in forms], ["file-refused.yml", "number-differs.yml", "port-differs.yml"])
        for path in forms:
            form = yaml.safe_load(path.read_text())
            self.assertTrue(form["name"] and form["description"] and form["title"], path)
            fields = [field for field in form["body"] if field["type"] != "markdown"]
            self.assertLessEqual({field["type"] for field in form["body"]}, {"markdown", "input", "textarea", "checkboxes", "dropdown"})
            self.assertEqual(len({field["id"] for field in fields}), len(fields))
            self.assertTrue(all(field["attributes"]["label"] for field in fields))
            self.assertTrue(any(field.get("validations", {}).get("required") for field in fields), path)


if __name__ == "__main__":
    unittest.main()
