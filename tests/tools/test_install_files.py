"""tools/install-files removes what it has put there. Its record lies in a folder that others may write into: a line that names
anything else is refused before anything is removed."""
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import TOP, FolderTest  # noqa: E402


class InstallFiles(FolderTest):
    def setUp(self):
        super().setUp()
        (self.dir / "from").write_text("a program\n")
        (self.dir / "victim").mkdir()
        (self.dir / "victim" / "v").write_text("mine\n")
        (self.dir / "victim" / "empty").mkdir()

    def call(self, act, given=""):
        return subprocess.run([TOP / "tools/install-files", act, self.dir / "prefix"], cwd=self.dir, input=given, capture_output=True,
                              text=True, check=False)

    def test_records_that_name_others(self):
        installed, record = self.dir / "prefix/bin/uncross", self.dir / "prefix/share/uncross/installed"
        for line in ("file ../victim/v", "file lib/../../victim/v", f"file {self.dir}/victim/v", "folder ../victim/empty",
                     "folder lib/../../victim/empty", "file share/uncross/../../../victim/v", "file bin/other", "file lnk/v",
                     "file lib/python3/dist-packages/numpy/__init__.py"):
            self.assertEqual(self.call("install", "755 from bin/uncross\n").returncode, 0)
            (self.dir / "prefix/bin/other").write_text("mine\n")
            if not (self.dir / "prefix/lnk").exists():
                (self.dir / "prefix/lnk").symlink_to(self.dir / "victim")
            before = record.read_text()
            record.write_text(before + line + "\n")
            done = self.call("uninstall")
            self.assertNotEqual(done.returncode, 0, line)
            self.assertIn(line.partition(" ")[2], done.stderr)
            self.assertTrue((self.dir / "victim/v").exists() and (self.dir / "victim/empty").exists(), line)
            self.assertTrue((self.dir / "prefix/bin/other").exists() and installed.exists(), line)
            record.write_text(before)
            done = self.call("uninstall")
            self.assertEqual((done.returncode, installed.exists()), (0, False), done.stderr)

    def test_links_that_lead_out(self):
        """A folder that uncross has made, and somebody has put elsewhere: below the prefix it is as good as the folder, else refused."""
        prefix = self.dir / "prefix"
        package = prefix / "lib/python3/dist-packages/uncross"
        files = "755 from bin/uncross\n644 from lib/python3/dist-packages/uncross/v.py\n"
        victim = self.dir / "victim"
        for name in "v.py", "v.1.pyc":
            (victim / name).write_text("mine\n")
        before = sorted(victim.rglob("*"))
        for link, code in (package, 1), (package.parent, 1), (package / "__pycache__", 0):
            self.assertEqual(self.call("install", files).returncode, 0)
            if link.exists():
                link.rename(self.dir / "aside")
            link.symlink_to(victim)
            done = self.call("uninstall")
            self.assertEqual(done.returncode, code, f"{link}: {done.stderr}")
            self.assertEqual(sorted(victim.rglob("*")), before, link)
            if code:
                self.assertIn(f"{prefix}/share/uncross/installed: names what lies outside of {prefix}; nothing is removed", done.stderr)
                self.assertTrue((prefix / "bin/uncross").exists())
            link.unlink()
            if (self.dir / "aside").exists():
                (self.dir / "aside").rename(link)
        self.assertEqual(self.call("install", files).returncode, 0)
        (prefix / "lib").rename(prefix / "lib64")
        (prefix / "lib").symlink_to("lib64")
        self.assertEqual(self.call("uninstall").returncode, 0)
        self.assertFalse([path for path in prefix.rglob("*") if path.is_file()])

    def test_a_prefix_of_two_lines(self):
        done = subprocess.run(["make", "-s", f"{self.dir}/build/build-info.inc", f"BUILD={self.dir}/build", "PREFIX=/usr\nlocal"], cwd=TOP, capture_output=True,
                              text=True, check=False)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 2), done.stderr)
        self.assertIn("PREFIX has a line feed in it", done.stderr)


if __name__ == "__main__":
    unittest.main()
