"""Power failures: what a run wrote is recorded call by call, and a disk that loses, reorders and tears is made of it.

The calls of a run and of its resume are recorded by strace. After each of them the power fails. Of a file, all that was
written before its last fsync is kept; of the writes since then any may be lost, in any order, and be torn between
sectors of 512 bytes. Of a folder, the same holds for names: files that are made, renamed and removed. So a name may come
before its data, and data before its name. (POSIX promises no more. File systems do, in ways of their own.)

From each state the run is resumed. It must end with the same state, tables and frames as one that was never stopped; a
trajectory may have been set aside, if the run says so. Where no checkpoint is left, a new run must begin, or say why it
cannot. A disk that lies about fsync (everything since the start may be lost or torn) may make the run refuse, in words;
it must not make it wrong.

POWER=N: how many states of each kind are resumed (default 25; 0: all). SEED: of the choices.
Needs UNCROSS and strace, which may be forbidden: then all is skipped.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import UNCROSS, uncross  # noqa: E402

MOST = int(os.environ.get("POWER", "25"))
SEED = int(os.environ.get("SEED", "1"))
SECTOR = 512
SCENE = """box: [4, 4, 4]
time_step: 0.01
steps: 14
seed: 3
solvent: {per_cell: 2, collision_interval: 0.02}
fibers:
  - {name: a, count: 2, vertices: 4, mass: 5, bond_length: 0.5, spring: 100, bending: 4}
observe:
  conserved: {every: 1}
  temperature: {every: 2}
  statics: {every: 1}
trajectory: {every: 2, velocities: true}
checkpoint: {seconds: 1e-9}
"""
CALLS = "openat,open,creat,read,write,pwrite64,lseek,ftruncate,fallocate,rename,renameat,renameat2,unlink,unlinkat,fsync,fdatasync,mkdir"
ENTRY = re.compile(rb"^(\d+) +(\w+)\((.*)\) += (-?\d+)")


def plain(quoted):
    return bytes.fromhex(quoted.replace(b"\\x", b"").decode())


class File:
    """A file on the disk: what is safe, and what was written since its last fsync."""

    def __init__(self):
        self.safe, self.pending = b"", []

    def content(self, kept, rng=None):
        """With these of the pending writes; with rng, each of them torn."""
        data = bytearray(self.safe)
        for offset, new in (self.pending[k] for k in kept):
            if new is None:  # truncated, or made longer
                data = data[:offset] + bytes(max(0, offset - len(data)))
                continue
            data += bytes(max(0, offset + len(new) - len(data)))
            edges = [0, *range(SECTOR - offset % SECTOR, len(new), SECTOR), len(new)]
            for first, last in zip(edges, edges[1:]):
                if rng is None or rng.random() < 0.5:
                    data[offset + first:offset + last] = new[first:last]
        return bytes(data)


class Disk:
    """One folder, and the calls of a process that writes into it."""

    def __init__(self, folder, honest):
        self.folder, self.honest = str(folder).encode(), honest
        self.names, self.safe_names, self.pending = {}, {}, []  # name -> File; [(name, File or None)]
        self.open_files = {}  # (process, descriptor) -> [File, offset]
        self.synced_above = False

    def path(self, words):
        """The absolute path of a call's folder and name."""
        found = re.match(rb'(?:(?:AT_FDCWD|\d+)<([^>]*)>, )?"([^"]*)"', words)
        return os.path.normpath(os.path.join(plain(found[1]) if found[1] else b"/", plain(found[2])))

    def inside(self, path):
        head, name = os.path.split(path)
        return name if head == self.folder else None

    def name_is(self, name, file):
        if file is None:
            self.names.pop(name, None)
        else:
            self.names[name] = file
        self.pending.append((name, file))

    def sync(self, file):
        if self.honest:
            file.safe, file.pending = file.content(range(len(file.pending))), []

    def sync_names(self):
        if self.honest:
            self.safe_names, self.pending = dict(self.names), []

    def call(self, process, what, words, result):
        """True if the disk may have changed."""
        if what in ("openat", "open", "creat"):
            name = self.inside(self.path(words))
            if name is None or b"O_DIRECTORY" in words:
                return False
            made = name not in self.names
            if made:
                self.name_is(name, File())
            file = self.names[name]
            if b"O_TRUNC" in words:
                file.pending.append((0, None))
            self.open_files[process, result] = [file, 0]
            return made
        if what in ("rename", "renameat", "renameat2"):
            both = re.match(rb'((?:[^"]*)"[^"]*"), ((?:[^"]*)"[^"]*")', words)
            old, new = (self.inside(self.path(part)) for part in both.groups())
            file = self.names[old]
            self.name_is(old, None)
            self.name_is(new, file)
            return True
        if what in ("unlink", "unlinkat"):
            name = self.inside(self.path(words))
            if name is not None:
                self.name_is(name, None)
            return name is not None
        descriptor = re.match(rb"(\d+)<([^>]*)>", words)
        if not descriptor:
            return False
        where = plain(descriptor[2])
        if what in ("fsync", "fdatasync") and where == self.folder:
            self.sync_names()
            return True
        if what in ("fsync", "fdatasync") and where == os.path.dirname(self.folder):
            self.synced_above = True
            return False
        key = process, int(descriptor[1])
        if self.inside(where) is None or key not in self.open_files:
            return False
        return self.file_call(self.open_files[key], what, words, result)

    def file_call(self, place, what, words, result):
        file, offset = place
        if what in ("read", "lseek"):
            place[1] = offset + result if what == "read" else result
            return False
        if what in ("fsync", "fdatasync"):
            self.sync(file)
            return True
        numbers = re.findall(rb", (\d+)", re.sub(rb'"[^"]*"', b"", words))
        if what == "ftruncate":
            file.pending.append((int(numbers[-1]), None))
            return True
        if what == "fallocate":
            end = int(numbers[-2]) + int(numbers[-1])
            if end > len(file.content(range(len(file.pending)))):
                file.pending.append((end, None))
            return True
        data = plain(re.search(rb'"([^"]*)"', words)[1])[:result]
        at = int(numbers[-1]) if what == "pwrite64" else offset
        if what == "write":
            place[1] = offset + result
        file.pending.append((at, data))
        return True

    def after_failure(self, choose_names, choose_writes, rng=None):
        """name -> bytes: what is found. The choices: of a list's length, the numbers of what is kept."""
        names = dict(self.safe_names)
        for k in choose_names(len(self.pending)):
            name, file = self.pending[k]
            names.pop(name, None)
            if file is not None:
                names[name] = file
        return {name.decode(): file.content(choose_writes(len(file.pending)), rng) for name, file in names.items()}

    def failures(self, rng):
        """States after the power failed now."""
        def none(_n):
            return ()

        def some(n):
            return [k for k in range(n) if rng.random() < 0.5]

        yield self.after_failure(none, none)
        yield self.after_failure(range, range)
        yield self.after_failure(range, none)
        yield self.after_failure(none, range)
        yield self.after_failure(range, some)
        yield self.after_failure(range, range, rng)
        yield self.after_failure(some, some, rng)


def run(words, folder):
    return uncross(*words, cwd=folder, timeout=120)


@unittest.skipIf("ASAN_OPTIONS" in os.environ, "the sanitizer of leaks traces the program itself")
class Power(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp()).resolve()
        (cls.folder / "scene.yaml").write_text(SCENE)
        cls.words = ["run", "scene.yaml", "--out", "out", "--quiet"]
        cls.calls = []
        for more in (["--steps", "5"], ["--resume", "--steps", "9"]):
            trace = cls.folder / "trace"
            done = subprocess.run(["strace", "-f", "-y", "-xx", "-s", "100000000", "-o", trace, "-e", f"trace={CALLS}", UNCROSS,
                                   *cls.words, *more], cwd=cls.folder, capture_output=True, text=True, check=False)
            if "not permitted" in done.stderr:
                raise unittest.SkipTest(f"no process may be traced here: {done.stderr}")
            assert done.returncode == 0, done.stderr
            for line in trace.read_bytes().splitlines():
                found = ENTRY.match(line)
                assert found or b"<unfinished" not in line or b"openat" not in line, line
                if found and int(found[4]) >= 0:
                    cls.calls.append((found[1], found[2].decode(), found[3], int(found[4])))
        (cls.folder / "straight").mkdir()
        shutil.copy(cls.folder / "scene.yaml", cls.folder / "straight")
        assert run(cls.words, cls.folder / "straight").returncode == 0
        cls.right = cls.result(cls.folder / "straight/out")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @staticmethod
    def result(out):
        """What must be the same: status and hash, tables, frames."""
        record = json.loads((out / "run.json").read_text())
        with h5py.File(out / "trajectory.h5") as file:
            group = file["particles/trajectory"]
            frames = {int(step): (group["position/value"][k].tobytes(), group["velocity/value"][k].tobytes())
                      for k, step in enumerate(group["position/step"])}
        return {"status": record["status"], "hash": record["state_hash"], "steps": record["steps"], "frames": frames,
                "tables": {path.name: path.read_bytes() for path in out.glob("*.csv")}}

    def states(self, honest):
        """All different states, in a random order: (call number, name -> bytes)."""
        rng = random.Random(SEED)
        disk = Disk(self.folder / "out", honest)
        seen, found = set(), []
        for n, (process, what, words, result) in enumerate(self.calls):
            if not disk.call(process, what, words, result):
                continue
            for state in disk.failures(rng):
                key = hashlib.sha256(b"".join(name.encode() + b"\0" + hashlib.sha256(data).digest()
                                              for name, data in sorted(state.items()))).digest()
                if key not in seen:
                    seen.add(key)
                    found.append((n, state))
        for name, file in disk.names.items():  # the record is right: it ends with what is there
            self.assertEqual(file.content(range(len(file.pending))), (self.folder / "out" / name.decode()).read_bytes(), name)
        self.assertEqual(set(disk.names), {path.name.encode() for path in (self.folder / "out").iterdir()})
        self.assertTrue(disk.synced_above)
        rng.shuffle(found)
        return found

    def resume(self, number, state, place):
        """How it goes on from here, one word; fails if it goes wrong."""
        out = place / "out"
        out.mkdir()
        shutil.copy(self.folder / "scene.yaml", place)
        for name, data in state.items():
            (out / name).write_bytes(data)
        done = run(self.words + ["--resume"], place)
        said = f"after call {number}, {sorted(state)}: {done.returncode}, {done.stderr}"
        if done.returncode == 0:
            self.compare(out, done.stderr, said)
            return "set aside" if "renamed to" in done.stderr else "resumed"
        self.assertIn(done.returncode, (2, 4), said)
        self.assertRegex(done.stderr, r"^uncross: out/?.*: .{10,}\n", said)
        if "checkpoint.h5" in state:
            return "refused"
        anew = run(self.words, place)
        if anew.returncode == 0:
            self.compare(out, anew.stderr, said)
            return "begun anew"
        self.assertIn("but no checkpoint.h5", anew.stderr, said)
        return "no checkpoint"

    def compare(self, out, said, where):
        result = self.result(out)
        frames = result.pop("frames")
        self.assertEqual(result, {key: value for key, value in self.right.items() if key != "frames"}, where)
        for step, frame in frames.items():
            self.assertEqual(frame, self.right["frames"][step], (where, step))
        if "renamed to" not in said and "is gone" not in said and "there was none" not in said:
            self.assertEqual(list(frames), list(self.right["frames"]), where)

    def resume_all(self, honest):
        states = self.states(honest)
        counts, wrong = {}, []

        def one(item):
            with tempfile.TemporaryDirectory(dir=self.folder) as place:
                try:
                    return self.resume(*item, pathlib.Path(place))
                except (AssertionError, subprocess.TimeoutExpired) as trouble:
                    return trouble

        chosen = states[:MOST] if MOST else states
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            for word in pool.map(one, chosen):
                if isinstance(word, str):
                    counts[word] = counts.get(word, 0) + 1
                else:
                    wrong.append(str(word)[:700])
        print(f"# {'fsync keeps its word' if honest else 'a disk that lies'}: {len(states)} states after "
              f"{len(self.calls)} calls, {len(chosen)} resumed: {counts}, {len(wrong)} wrong")
        self.assertFalse(wrong, "\n".join(wrong[:5]))
        return counts

    def test_an_honest_disk(self):
        """Everything goes on, from the first checkpoint on; before it, a new run begins."""
        counts = self.resume_all(True)
        self.assertEqual(counts.get("refused", 0) + counts.get("no checkpoint", 0), 0)
        self.assertGreater(counts.get("resumed", 0), 0)

    def test_a_disk_that_lies(self):
        """It may refuse, but never goes on wrongly. That some are refused shows that the failures above are real."""
        counts = self.resume_all(False)
        self.assertGreater(counts.get("refused", 0), 0)


if __name__ == "__main__":
    unittest.main()
