"""CI sums what its stages count, and fails if one of them does: with stages made for it."""
import pathlib
import shutil
import subprocess
import tempfile
import unittest

RUN = pathlib.Path(__file__).resolve().parents[2] / ".ci" / "run"

MAKEFILE = """
check:
\t@echo 1 passed, 9 failed, but not in a line of its own
\t@echo 3 passed, 0 failed
counts:
\t@echo 2 passed, 0 failed
\t@echo 4 passed, 0 failed
lint:
\t@true
port:
\t@echo 5 passed, 1 failed
sanitize:
\t@echo 5 passed, 1 failed; exit 3
fuzz:
\t@echo no count; exit 1
validate:
\t@kill -9 $$(ps -o ppid= -p $$PPID)
"""
# Each says when it begins and when it ends.
ORDERED = "".join(f"{name}:\n\t@echo {name} begins >>order; sleep {seconds}; echo {name} ends >>order\n" for name, seconds in (
    ("tests", 1), ("stress-programs", 0), ("validation-programs", 0), ("check", 0), ("counts", 0), ("fuzz", 0), ("live-test", 0)))


class Ci(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = pathlib.Path(folder.name)
        (self.tree / ".ci").mkdir()
        shutil.copy(RUN, self.tree / ".ci" / "run")
        (self.tree / "Makefile").write_text(MAKEFILE)

    def ends(self, *stages):
        """Exit status and last line."""
        done = subprocess.run([str(self.tree / ".ci" / "run"), *stages], capture_output=True, text=True, check=False)
        return done.returncode, (done.stdout or done.stderr).splitlines()[-1]

    def test_sum(self):
        self.assertEqual(self.ends("check", "lint", "counts"), (0, "9 passed, 0 failed"))

    def test_stages_that_fail(self):
        self.assertEqual(self.ends("check", "sanitize", "lint"), (1, "8 passed, 1 failed"))
        self.assertEqual(self.ends("fuzz", "check"), (1, "3 passed, 1 failed"))
        self.assertEqual(self.ends("check", "fuzz"), (1, "3 passed, 1 failed"))

    def test_a_failure_that_the_stage_hides(self):
        self.assertEqual(self.ends("port", "lint"), (1, "5 passed, 1 failed"))

    def test_a_tool_that_is_not_there(self):
        self.assertEqual(self.ends("check", "mutants"), (1, "3 passed, 1 failed"))

    def test_out_of_time(self):
        """A stage that would begin too late is skipped, and says so: it neither fails nor counts."""
        done = subprocess.run(["env", "CI_SECONDS=0", str(self.tree / ".ci" / "run"), "check", "fuzz"], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout.splitlines()[-1]), (0, "0 passed, 0 failed"))
        self.assertEqual(done.stdout.count("check     skipped: "), 2)

    def test_a_stage_that_is_killed(self):
        """Its shell is: nothing says how it ended."""
        self.assertEqual(self.ends("validate", "check"), (1, "3 passed, 1 failed"))

    def test_order(self):
        """What needs the build begins after it, and something that does not need it runs beside it."""
        (self.tree / "Makefile").write_text(ORDERED)
        self.assertEqual(self.ends("live", "build", "check", "counts", "fuzz"), (0, "0 passed, 0 failed"))
        order = (self.tree / "order").read_text().splitlines()
        for name in ("check", "counts"):
            self.assertLess(order.index("tests ends"), order.index(f"{name} begins"))
        self.assertLess(order.index("fuzz begins"), order.index("tests ends"))
        self.assertEqual(order[-2:], ["live-test begins", "live-test ends"])

    def test_without_the_build_one_follows_the_other(self):
        (self.tree / "Makefile").write_text(ORDERED)
        self.assertEqual(self.ends("check", "counts")[0], 0)
        self.assertEqual((self.tree / "order").read_text().splitlines(), ["check begins", "check ends", "counts begins", "counts ends"])

    def test_jobs(self):
        for jobs in ("0", "two", "-1"):
            done = subprocess.run(["env", f"CI_JOBS={jobs}", str(self.tree / ".ci" / "run"), "check"], capture_output=True, text=True, check=False, timeout=60)
            self.assertEqual((done.returncode, done.stderr), (2, f"ci: CI_JOBS is '{jobs}'; allowed: 1 to 9\n"))

    def test_unknown_stage(self):
        status, line = self.ends("checks")
        self.assertEqual(status, 2)
        self.assertIn("there are install build sanitize check validate lint mutants port counts packages fuzz live site", line)


if __name__ == "__main__":
    unittest.main()
