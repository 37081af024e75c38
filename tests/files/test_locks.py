"""File systems without locks, and files that are locked: what cannot be locked is not damaged, and work goes on with one
line of warning. Locks are taken away by a library that is loaded before all others. Needs UNCROSS and a C compiler."""
import errno
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from damage import SCENE  # noqa: E402
from support import uncross  # noqa: E402

# what file systems answer: FUSE, NFS without its lock daemon, old kernels, some network file systems
ANSWERS = errno.EOPNOTSUPP, errno.ENOLCK, errno.ENOSYS, errno.EINVAL, errno.EINTR
SOURCE = """#include <errno.h>
#include <stdlib.h>
int flock(int fd, int how);
int flock(int fd, int how)
{
  (void)fd, (void)how;
  errno = atoi(getenv("NO_LOCKS"));
  return -1;
}
"""


@unittest.skipIf("ASAN_OPTIONS" in os.environ, "a sanitizer must be loaded before all others")
class Locks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.place.cleanup)
        cls.dir = pathlib.Path(cls.place.name)
        (cls.dir / "flock.c").write_text(SOURCE)
        subprocess.run([os.environ.get("CC", "gcc"), "-shared", "-fPIC", "flock.c", "-o", "flock.so"], cwd=cls.dir, check=True)
        (cls.dir / "s.yaml").write_text(SCENE)
        (cls.dir / "start.yaml").write_text(SCENE + "start: {snapshot: whole/checkpoint.h5}\n")
        cls.told = uncross("run", "s.yaml", "--out", "whole", cwd=cls.dir, check=True).stdout

    def without(self, answer, *words, how="FALSE"):
        """The program where there are no locks."""
        settings = dict(os.environ, NO_LOCKS=str(answer), LD_PRELOAD=str(self.dir / "flock.so"), HDF5_USE_FILE_LOCKING=how)
        if how == "FALSE":
            del settings["HDF5_USE_FILE_LOCKING"]
        done = uncross(*words, cwd=self.dir, env=settings)
        self.assertEqual(done.returncode, 0, f"{errno.errorcode[answer]}: {words}: {done.stderr}")
        return done

    def test_work_goes_on_without_locks(self):
        for answer in ANSWERS:
            folder = errno.errorcode[answer]
            done = self.without(answer, "run", "s.yaml", "--out", folder, "--steps", "10")
            self.assertEqual(done.stderr, f"uncross: {folder}: locks cannot be had here ({os.strerror(answer)}): see to it "
                             "yourself that no other process writes into this folder\n")
            done = self.without(answer, "run", "s.yaml", "--out", folder, "--resume")
            self.assertEqual(done.stderr.count("locks cannot be had here"), 1)
            self.assertEqual([line for line in done.stdout.splitlines() if "state hash" in line],
                             [line for line in self.told.splitlines() if "state hash" in line])
            for name in "trajectory.h5", "conserved.csv", "statics-a.csv":
                self.assertEqual((self.dir / folder / name).stat().st_size, (self.dir / "whole" / name).stat().st_size, name)
            self.without(answer, "verify", folder)
            self.without(answer, "export", f"{folder}/trajectory.h5", "--out", f"{folder}.xyz")
            self.without(answer, "info", f"{folder}/checkpoint.h5")
            done = self.without(answer, "analyze", f"{folder}/trajectory.h5", "--out", f"{folder}-tables")
            self.assertEqual(done.stderr.count("locks cannot be had here"), 1)
            self.without(answer, "run", "start.yaml", "--out", f"{folder}-next", "--quiet")

    def test_nobody_makes_hdf5_lock(self):
        """Whatever the user's surroundings say of HDF5's locks, our files have our own."""
        self.without(errno.EOPNOTSUPP, "run", "s.yaml", "--out", "told", "--quiet", how="TRUE")
        self.without(errno.EOPNOTSUPP, "verify", "told", how="TRUE")


if __name__ == "__main__":
    unittest.main()
