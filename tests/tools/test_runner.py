"""tests/run: what stops a test, what it says meanwhile, what it leaves. With tests made for it."""
import pathlib
import shutil
import subprocess
import tempfile
import time
import unittest

RUN = pathlib.Path(__file__).resolve().parents[1] / "run"
BUSY = "import time\nwhile time.process_time() < {}: pass\n"


class Runner(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = pathlib.Path(folder.name)
        (self.tree / "tests").mkdir()
        shutil.copy(RUN, self.tree / "tests/run")

    def put(self, **programs):
        for name, text in programs.items():
            (self.tree / f"tests/test_{name}.py").write_text(text)

    def run_all(self, *words):
        done = subprocess.run([self.tree / "tests/run", *words, self.tree / "build"], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.stderr, "")
        return done.returncode, done.stdout

    def test_waiting_is_not_computing(self):
        """Three times the limit passes, of which a third is computed: on a busy machine a test lasts, and computes no more."""
        self.put(slow="import time\nfor k in range(12):\n  end = time.process_time() + 0.05\n  while time.process_time() < end: pass\n  time.sleep(0.2)\n")
        status, told = self.run_all("--limit", "1")
        self.assertEqual((status, told.splitlines()[-1]), (0, "1 passed, 0 failed"), told)

    def test_computing_too_long(self):
        """What its children compute counts, too; and they are stopped with it."""
        mark = self.tree / "alive"
        self.put(busy=f"import subprocess, sys\nsubprocess.run([sys.executable, '-c', '''{BUSY.format(30)}open(\"{mark}\", \"w\")'''])\n",
                 other="")
        began = time.monotonic()
        status, told = self.run_all("--limit", "1")
        self.assertEqual((status, told.splitlines()[-1]), (1, "1 passed, 1 failed"), told)
        self.assertIn("stopped after 1 s of CPU time", told)
        self.assertLess(time.monotonic() - began, 25)
        left = subprocess.run(["pgrep", "-f", str(mark)], capture_output=True, text=True, check=False).stdout
        self.assertEqual(left, "")

    def test_a_test_that_hangs(self):
        self.put(hangs="import time\ntime.sleep(60)\n")
        status, told = self.run_all("--limit", "2")
        self.assertEqual((status, told.splitlines()[-1]), (1, "0 passed, 1 failed"), told)
        self.assertIn("stopped: it has waited for 2 s", told)

    def test_progress(self):
        """Before the first test ends it is said what runs, and how many there are; and again when nothing has been said for long."""
        go = self.tree / "go"
        self.put(**{f"t{k}": f"import os, time\nwhile not os.path.exists('{go}'): time.sleep(0.05)\n" for k in range(5)})
        with subprocess.Popen([self.tree / "tests/run", "--quiet-for", "0.3", self.tree / "build"], stdout=subprocess.PIPE, text=True) as runner:
            first, second = runner.stdout.readline(), runner.stdout.readline()
            go.write_text("")
            rest = runner.stdout.read()
        self.assertRegex(first, r"^ *\d\.\d s  0 of 5 done; running tests/test_t0.py, tests/test_t1.py, tests/test_t2.py$")
        self.assertRegex(second, r"^ *\d\.\d s  0 of 5 done; running tests/test_t0.py, ")
        self.assertEqual(rest.splitlines()[-1], "5 passed, 0 failed")
        self.assertEqual(rest.count(": 1 passed, 0 failed"), 5)


if __name__ == "__main__":
    unittest.main()
