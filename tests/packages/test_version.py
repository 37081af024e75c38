"""One version, one license: src/version.h and LICENSE are their homes, and all files that name them agree.

Needs UNCROSS and python3-yaml.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import TOP, FolderTest, load, uncross  # noqa: E402

FILES = ("src/version.h", "CITATION.cff", "codemeta.json", "CHANGELOG.md")
PROGRAM = load(TOP / "tools/set-version")


def read(top):
    """{what names a version: it}; {what names a license: it}; dates."""
    citation = yaml.safe_load((top / "CITATION.cff").read_text())
    codemeta = json.loads((top / "codemeta.json").read_text())
    preferred = citation["preferred-citation"]
    versions = {"version.h": re.search(r'UNCROSS_VERSION "(.*)"', (top / "src/version.h").read_text())[1],
                "CITATION.cff": citation["version"], "preferred-citation": preferred["version"], "codemeta.json": codemeta["version"]}
    licenses = {"CITATION.cff": citation["license"], "codemeta.json": codemeta["license"].rpartition("/")[2]}
    dates = {str(citation["date-released"]), str(preferred["date-released"]), codemeta["dateModified"]}
    return versions, licenses, dates


class Version(FolderTest):
    def test_all_agree(self):
        versions, licenses, dates = read(TOP)
        versions["--version"] = uncross("--version").stdout.split()[1]
        versions["--cite"] = re.search(r"version = \{(\S+),", uncross("--cite").stdout)[1]
        licenses |= {"pyproject.toml": re.search(r'license = \{text = "(.*)"\}', (TOP / "python/pyproject.toml").read_text())[1],
                     "debian/copyright": re.search(r"^License: (.*)$", (TOP / "packaging/debian/copyright").read_text(), re.M)[1],
                     "README.md": re.search(r"^## License\n\n(\S+)", (TOP / "README.md").read_text(), re.M)[1],
                     "NOTICE": re.search(r"contributors\. (\S+), see", (TOP / "NOTICE").read_text())[1],
                     "LICENSE": (TOP / "LICENSE").read_text().split(" License")[0].replace(" ", "-")}
        self.assertEqual(len(set(versions.values())), 1, versions)
        self.assertEqual(set(licenses.values()), {"BSD-3-Clause"}, licenses)
        self.assertEqual(len(dates), 1, dates)

    def test_codemeta_is_made_of_the_citation(self):
        citation = yaml.safe_load((TOP / "CITATION.cff").read_text())
        self.assertEqual(json.loads((TOP / "codemeta.json").read_text()), PROGRAM.codemeta(citation))

    def test_the_citation_is_whole(self):
        """What the Citation File Format 1.2.0 demands, and what an archive asks for."""
        citation = yaml.safe_load((TOP / "CITATION.cff").read_text())
        for key in ("cff-version", "message", "title", "authors", "version", "date-released", "license", "abstract", "type", "keywords", "preferred-citation", "references"):
            self.assertTrue(citation.get(key), key)
        self.assertEqual(citation["cff-version"], "1.2.0")
        for work in (citation["preferred-citation"], *citation["references"]):
            self.assertTrue({"type", "title", "authors"} <= set(work))
        self.assertIn(citation["references"][0]["doi"], uncross("--cite").stdout)

    def test_a_release(self):
        for name in FILES:
            (self.dir / name).parent.mkdir(exist_ok=True)
            shutil.copy(TOP / name, self.dir / name)
        PROGRAM.main(self.dir, "7.8.9", "2031-02-03")
        versions, _, dates = read(self.dir)
        self.assertEqual((set(versions.values()), dates), ({"7.8.9"}, {"2031-02-03"}))
        self.assertIn("## [Unreleased]\n\n## [7.8.9] - 2031-02-03\n", (self.dir / "CHANGELOG.md").read_text())
        for words in ("1.0", "2031-02-03"), ("1.0.0", "3.2.2031"), ("1.0.0", "20310203"), ("1.0.0", "2031-02-30"):
            done = subprocess.run([TOP / "tools/set-version", *words], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertRegex(done.stderr, "^set-version: the (version|date) is '.*'; allowed: ")


if __name__ == "__main__":
    unittest.main()
