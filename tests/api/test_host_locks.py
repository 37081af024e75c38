"""A library in a host that wants HDF5 to lock files, on a file system without locks. Needs BUILD, with the libraries in it, UNCROSS
and a C compiler."""
import errno
import os
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "files"))
from damage import SCENE  # noqa: E402
from support import BUILD, TOP, FolderTest, uncross  # noqa: E402
from test_locks import SOURCE  # noqa: E402


@unittest.skipIf("ASAN_OPTIONS" in os.environ, "a sanitizer must be loaded before all others")
class HostLocks(FolderTest):
    def setUp(self):
        super().setUp()
        (self.dir / "flock.c").write_text(SOURCE)
        subprocess.run([os.environ.get("CC", "gcc"), "-shared", "-fPIC", "flock.c", "-o", "flock.so"], cwd=self.dir, check=True)
        (self.dir / "s.yaml").write_text(SCENE)

    def test_a_library_in_a_host_that_wants_locks(self):
        """HDF5 looks at its variable once in a process; the host may have used HDF5 long before."""
        script = ("import sys, h5py, uncross\n"
                  "h5py.File('host.h5', 'w', driver='core', backing_store=False).close()\n"
                  "with uncross.FolderRun('s.yaml', sys.argv[1], resume=sys.argv[2] == 'on') as run:\n"
                  "    run.advance(10)\n")
        for how in "TRUE", "BEST_EFFORT", "FALSE":
            folder = self.dir / how
            settings = dict(os.environ, NO_LOCKS=str(errno.EOPNOTSUPP), LD_PRELOAD=str(self.dir / "flock.so"),
                            HDF5_USE_FILE_LOCKING=how, PYTHONPATH=str(TOP / "python"),
                            UNCROSS_LIBRARY=str(BUILD / "lib/libuncross.so"))
            for begun in "new", "on":
                done = subprocess.run([sys.executable, "-c", script, how, begun], cwd=self.dir, env=settings,
                                      capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, f"{how}, {begun}: {done.stderr}")
                self.assertEqual(list(folder.glob("*.damaged*")), [], f"{how}, {begun}")
            self.assertEqual(uncross("verify", folder).returncode, 0, how)


if __name__ == "__main__":
    unittest.main()
