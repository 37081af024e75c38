"""Where the library writes to: never through a link, never over what is no checkpoint, never into what is no file.

Needs BUILD, the build folder, with the libraries in it.
"""
import os
import pathlib
import signal
import sys
import unittest

import h5py

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import BUILD, TOP, FolderTest  # noqa: E402

os.environ["UNCROSS_LIBRARY"] = str(BUILD / "lib/libuncross.so")
sys.path.insert(0, str(TOP / "python"))
import uncross  # noqa: E402  pylint: disable=wrong-import-position

SCENE = {"box": [4, 4, 4], "time_step": 0.01, "steps": 20, "seed": 2, "solvent": {"per_cell": 4, "collision_interval": 0.02}}


class Saving(FolderTest):
    def setUp(self):
        super().setUp()
        self.run = uncross.Run(SCENE)
        self.path = self.dir / "saved.h5"
        signal.alarm(60)  # a pipe that is waited for
        self.addCleanup(signal.alarm, 0)

    def refused(self, what):
        with self.assertRaisesRegex(uncross.Error, what) as caught:
            self.run.save(self.path)
        self.assertEqual(caught.exception.code, 4)

    def test_an_earlier_checkpoint_is_replaced(self):
        self.run.save(self.path)
        self.run.advance(3).save(self.path)
        self.assertEqual(uncross.Run(SCENE, resume=self.path).step, 3)
        self.assertEqual(os.listdir(self.dir), ["saved.h5"])

    def test_what_is_no_checkpoint_stays(self):
        self.path.write_text("my notes\n")
        self.refused("saved.h5: .*not a checkpoint.*name another file")
        self.assertEqual(self.path.read_text(), "my notes\n")
        with h5py.File(self.path, "w") as file:
            file["mine"] = 7
        self.refused("not a checkpoint")
        with h5py.File(self.path) as file:
            self.assertEqual(file["mine"][()], 7)

    def test_what_is_no_file_stays(self):
        target = self.dir / "target"
        for make, is_still in ((lambda: self.path.symlink_to(target), self.path.is_symlink), (self.path.mkdir, self.path.is_dir),
                               (lambda: os.mkfifo(self.path), self.path.is_fifo)):
            make()
            self.refused("saved.h5: is a link, a folder, a pipe or a device")
            self.assertTrue(is_still())
            self.path.rmdir() if self.path.is_dir() else self.path.unlink()  # pylint: disable=expression-not-assigned
        self.run.save(target)
        self.path.symlink_to(target)
        self.refused("is a link")
        self.assertEqual(uncross.Run(SCENE, resume=target).step, 0)

    def test_what_stands_aside_stays(self):
        """The file is written beside the earlier one first."""
        aside = self.dir / "saved.h5.part"
        aside.write_text("my notes\n")
        self.refused("saved.h5.part: .*name another file")
        self.assertEqual(aside.read_text(), "my notes\n")
        aside.unlink()
        aside.symlink_to("target")
        self.refused("saved.h5.part")
        self.assertTrue(aside.is_symlink())
        aside.unlink()
        self.run.save(self.path)
        self.path.rename(aside)  # what a killed program leaves
        self.run.advance(2).save(self.path)
        self.assertEqual(uncross.Run(SCENE, resume=self.path).step, 2)


if __name__ == "__main__":
    unittest.main()
