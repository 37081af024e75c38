"""The rules of the page's "A step taken apart" beside reference-data/, with planted errors; see apart.mjs."""
import pathlib
import shutil
import subprocess
import unittest


@unittest.skipUnless(shutil.which("node"), "no node here (tools/install-dependencies live)")
class Apart(unittest.TestCase):
    def test_rules_agree_with_the_packs_and_errors_are_seen(self):
        ran = subprocess.run(["node", pathlib.Path(__file__).with_name("apart.mjs")], capture_output=True, text=True)
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)


if __name__ == "__main__":
    unittest.main()
