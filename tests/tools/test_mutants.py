"""The share of the planted bugs that a submission sees."""
import importlib.machinery
import pathlib
import sys
import types
import unittest

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parents[2]
loader = importlib.machinery.SourceFileLoader("mutants", str(TREE / "tools/mutants"))
mutants = types.ModuleType(loader.name)
mutants.__file__ = loader.path
loader.exec_module(mutants)


class Share(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bugs = mutants.read_bugs()

    def share(self, commit, changed=()):
        return mutants.share(self.bugs, 4, commit, set(changed))

    def test_commits_see_all_bugs_in_turn(self):
        shares = [self.share(f"commit {k}") for k in range(40)]
        self.assertEqual({bug.name for one in shares for bug in one}, {bug.name for bug in self.bugs})
        for one in shares:
            self.assertTrue(0.15 < len(one) / len(self.bugs) < 0.35, len(one))

    def test_what_changed_is_seen_at_once(self):
        bug = next(bug for bug in self.bugs if bug.tests)
        for changed in bug.file, mutants.source_of(bug.tests[0]):
            for k in range(8):
                self.assertIn(bug, self.share(f"commit {k}", [changed]))

    def test_of_what_changed_no_more_than_there_is_time_for(self):
        every = {bug.file for bug in self.bugs}
        new = [bug for bug in self.bugs if bug.file == "src/mpc/virtual.c"]
        known = [bug for bug in self.bugs if bug not in new]
        samples = set()
        for k in range(8):
            turn = {bug.name for bug in mutants.share(self.bugs, 24, f"commit {k}", set())}
            drawn = {bug.name for bug in mutants.share(self.bugs, 24, f"commit {k}", every, most=20, known=known)}
            self.assertEqual(len(drawn - turn), 20)
            self.assertLessEqual({bug.name for bug in new}, drawn)
            samples.add(frozenset(drawn - turn))
        self.assertEqual(len(samples), 8)

    def test_without_a_commit_all_are_seen(self):
        self.assertEqual(self.share(""), self.bugs)


class Check(unittest.TestCase):
    def check(self, **other):
        some = next(b for b in mutants.read_bugs() if b.file == "src/mpc/grid.c")
        bug = some._replace(**other)
        return mutants.check([bug]) or mutants.check_syntax([bug])

    def test_a_bug_that_can_be_planted(self):
        self.assertEqual(self.check(), [])

    def test_one_whose_text_is_gone(self):
        self.assertIn("stands 0 times in src/mpc/grid.c", self.check(old="no such text")[0])

    def test_one_that_names_what_is_gone(self):
        for gone in "return gone(0);", "return lattice_fold(p.y, gone);", "return box->gone;":
            self.assertRegex(self.check(new=gone)[0], "does not compile: .*gone")


if __name__ == "__main__":
    unittest.main()
