"""Damaged files, through every reader: a small part of tests/stress/stress_damage.py; and how damaged frames are named.
Needs UNCROSS."""
import struct
import tempfile
import unittest

import h5py

import damage

# What of frame 2 (step 10) is changed, and how it is called.
TABLES = [("particles/trajectory/position/value", (2, 7, 1), b"positions"),
          ("particles/trajectory/velocity/value", (2, 201, 2), b"velocities"),
          ("particles/trajectory/position/time", (2,), b"step or time")]


def bond_to_nowhere(own):
    bonds = own.file["connectivity/bonds"]
    del bonds.attrs["xxh64"]
    bonds[0] = [0, 99999999]


class Damage(unittest.TestCase):
    def test_no_damage_is_taken_for_good(self):
        with tempfile.TemporaryDirectory() as folder:
            bench = damage.Bench(folder)
            wrong = bench.attack(24, 8, 8)
            print(f"# {dict(bench.counts)}")
            self.assertFalse(wrong, "\n".join(wrong))

    def test_a_damaged_frame_is_named_and_left_out_if_told(self):
        with tempfile.TemporaryDirectory() as folder:
            bench = damage.Bench(folder)
            whole = bench.data["trajectory"]
            frames = bench.right["trajectory", "export"].split(b"\n202\n")
            for path, place, name in TABLES:
                with h5py.File(bench.victims["trajectory"]) as file:
                    number = struct.pack("<d", file[path][place])
                self.assertEqual(whole.count(number), 1, path)
                bench.put("trajectory", whole.replace(number, bytes([number[0] ^ 1]) + number[1:]))
                said = rb"victim.h5: frame 2 \(step 10\) is damaged: its " + name
                code, _, told = bench.run("export", "--solvent", "victim.h5")
                self.assertEqual(code, 2)
                self.assertRegex(told, said)
                code, output, told = bench.run("export", "--solvent", "--skip-damaged", "victim.h5")
                self.assertEqual(code, 0, told)
                self.assertRegex(told, b"left out: " + said)
                self.assertEqual(output, b"\n202\n".join(frames[:2] + frames[3:]))
                code, output, _ = bench.run("verify", "victim.h5")
                self.assertEqual(code, 9)
                self.assertRegex(output, said + rb"[^\n]*\nvictim.h5: damaged: 1 of 5 frames")
                code, _, told = bench.run("analyze", "victim.h5", "--out", "none")
                self.assertEqual(code, 2)
                self.assertRegex(told, said)
                self.assertFalse((bench.folder / "none").exists())
                code, _, told = bench.run("analyze", "victim.h5", "--skip-damaged", "--out", name.split()[0].decode())
                self.assertEqual(code, 0, told)
                table = (bench.folder / name.split()[0].decode() / "conserved.csv").read_text().splitlines()
                self.assertEqual([row.split(",")[0] for row in table[1:]], ["0", "5", "15", "20"])
                code, _, told = bench.run("run", "s.yaml", "--out", "run", "--resume", "--steps", "25", "--quiet")
                self.assertEqual(code, 0, told)
                self.assertRegex(told, rb"frame 2 \(step 10\)[^\n]*renamed to trajectory.damaged.1.h5")

    def test_old_trajectories_are_read(self):
        """Version 1: no checksums, and it is said."""
        with tempfile.TemporaryDirectory() as folder:
            bench = damage.Bench(folder)
            with h5py.File(bench.folder / "run/trajectory.h5", "r+") as file:
                own = file["parameters/uncross"]
                own.attrs.modify("format_version", 1)
                del own["checksum"]
            code, output, _ = bench.run("export", "--solvent", "run/trajectory.h5")
            self.assertEqual((code, output), (0, bench.right["trajectory", "export"]))
            code, output, _ = bench.run("verify", "run/trajectory.h5")
            self.assertEqual(code, 0)
            self.assertIn(b"readable: 5 frames; the file carries no checksum of them", output)
            code, _, told = bench.run("run", "s.yaml", "--out", "run", "--resume", "--steps", "25", "--quiet")
            self.assertEqual(code, 0)
            self.assertIn(b"without checksums; its frames are kept as they are", told)
            code, output, _ = bench.run("verify", "run")
            self.assertEqual(code, 0, output)
            self.assertIn(b"trajectory.h5: readable: 6 frames", output)

    def test_what_a_file_lacks_is_named(self):
        """Version 2 promises checksums: without them nothing vouches for the frames, and every reader says that they are missing."""
        with tempfile.TemporaryDirectory() as folder:
            bench = damage.Bench(folder)
            damages = {rb"its bonds name particle \d+, and no row is that": bond_to_nowhere,
                       rb"its checksums \(parameters/uncross/checksum\) are missing": lambda own: own.__delitem__("checksum"),
                       rb"its version is 3; allowed: 1 to 2": lambda own: own.attrs.modify("format_version", 3)}
            for says, spoil in damages.items():
                bench.put("trajectory", bench.data["trajectory"])
                with h5py.File(bench.folder / "victim.h5", "r+") as file:
                    spoil(file["parameters/uncross"])
                for reader in ("info", "export", "verify", "analyze", "start"):
                    code, output, told = getattr(bench, reader)()
                    self.assertEqual(code, 9 if reader == "verify" else 2, (reader, told))
                    self.assertRegex(output + told, says, reader)
                    self.assertNotIn(b"unknown HDF5 error", output + told, reader)


if __name__ == "__main__":
    unittest.main()
