#!/usr/bin/python3
"""Ports as a whole: `uncross oracle check`, columns by name, traces against traces, tolerances of single precision. The ports
are scripts. What they are given has no outputs, so those that are right copy the pack of reference-data, and the others change
something in it.
"""
import gzip
import json
import os
import pathlib
import random
import signal
import subprocess
import tempfile
import time
import unittest

import h5py
import numpy as np

TOP = pathlib.Path(__file__).resolve().parents[2]
DATA = TOP / "reference-data"
UNCROSS = os.environ.get("UNCROSS", str(TOP / "build/uncross"))


def run(*words, **how):
    done = subprocess.run([UNCROSS, "oracle", *map(str, words)], capture_output=True, text=True, check=False, **how)
    return done.returncode, done.stdout, done.stderr


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.dir = pathlib.Path(self.folder.name)

    def text_of(self, name):
        return gzip.open(DATA / f"{name}.pack.txt.gz", "rt").read().splitlines()

    def compare(self, lines, *options, ours="coarse"):
        path = self.dir / "theirs.txt"
        path.write_text("\n".join(lines) + "\n")
        return run("compare", DATA / f"{ours}.pack.h5", path, "--no-name", *options)


class ColumnsTest(Folder):
    def test_every_value_is_judged(self):
        """In doubles tolerances are below the largest size of their table, but for the shares that docs/port/tolerances.md states."""
        for path in sorted(DATA.glob("**/*.pack.h5")):
            code, said, _ = run("compare", path, path)
            self.assertEqual(code, 0, said)
            values = int(said.split()[0])
            unjudged = int(said.splitlines()[1].split()[0]) if "not judged" in said else 0
            self.assertLessEqual(unjudged / values, 0.03 if path.name == "spin.pack.h5" else 0.01, path.name)

    def test_any_order_of_lines(self):
        lines = self.text_of("coarse")
        random.Random(12).shuffle(lines)
        code, said, _ = self.compare(lines)
        self.assertEqual((code, said.splitlines()[-1]), (0, "same: every bit"))

    def test_any_order_of_columns(self):
        """HDF5 with its columns turned round, names with them; then the names alone."""
        path = self.dir / "theirs.h5"
        path.write_bytes((DATA / "coarse.pack.h5").read_bytes())
        with h5py.File(path, "r+") as file:
            data = file["kick.1/out.velocity"]
            data[...] = data[:][:, ::-1]
            del data.attrs["xxh64"]
        code, said, _ = run("compare", DATA / "coarse.pack.h5", path)
        self.assertEqual(code, 7, said)
        with h5py.File(path, "r+") as file:
            file["kick.1/out.velocity"].attrs["components"] = "z y x"
        code, said, _ = run("compare", DATA / "coarse.pack.h5", path)
        self.assertEqual(code, 0, said)
        with h5py.File(path, "r+") as file:
            file["kick.1/out.velocity"].attrs["components"] = "z y z"
        code, _, said = run("compare", DATA / "coarse.pack.h5", path)
        self.assertEqual(code, 2, said)
        self.assertIn("there are two columns z", said)

    def test_columns_without_names(self):
        """Those of the contract, in order."""
        path = self.dir / "theirs.h5"
        path.write_bytes((DATA / "coarse.pack.h5").read_bytes())
        with h5py.File(path, "r+") as file:
            for name in ("kick.1/out.velocity", "sum.1/out.load", "order.1/out.order"):
                del file[name].attrs["components"]
        self.assertEqual(run("compare", DATA / "coarse.pack.h5", path)[0], 0)
        with h5py.File(path, "r+") as file:
            data = file["sum.1/out.load"][:, :1]
            del file["sum.1/out.load"]
            file["sum.1/out.load"] = data
        code, said, _ = run("compare", DATA / "coarse.pack.h5", path)
        self.assertEqual(code, 7)
        self.assertIn("2 columns here, 1 without names there", said)

    def test_swapped_names_differ(self):
        lines = [line.replace("out.velocity.x", "out.velocity.Z").replace("out.velocity.z", "out.velocity.x")
                 .replace("out.velocity.Z", "out.velocity.z") for line in self.text_of("coarse")]
        self.assertEqual(self.compare(lines)[0], 7)

    def test_missing_columns_are_named(self):
        lines = [line for line in self.text_of("coarse") if not (line.startswith("kick") and "out.velocity.y" in line)]
        code, said, _ = self.compare(lines)
        self.assertEqual(code, 7)
        self.assertRegex(said, r"kick +1 +out.velocity +columns that are not there: y\n")

    def test_unknown_names_are_refused(self):
        for old, new, word in (("out.velocity.y", "out.velocity.w", "unknown column w; its columns are x y z"),
                               ("out.velocity", "out.speed", "unknown table out.speed")):
            lines = [line.replace(old, new) if line.startswith("kick") else line for line in self.text_of("coarse")]
            code, _, said = self.compare(lines)
            self.assertEqual(code, 2, said)
            self.assertIn(word, said)

    def test_a_single_column_may_be_called_value(self):
        lines = [line.replace("out.order.vertex", "out.order.value") for line in self.text_of("coarse")]
        self.assertEqual(self.compare(lines)[0], 0)

    def test_whole_reals_need_no_point(self):
        lines = [line[:-2] if line.endswith(".0") else line for line in self.text_of("coarse")]
        self.assertEqual(self.compare(lines)[0], 0)

    def test_shortest_decimals(self):
        lines = [" ".join([*line.split()[:4], repr(float(line.split()[4]))]) if "." in line.split()[4] else line
                 for line in self.text_of("dense") if not line.startswith("#")]
        self.assertEqual(self.compare(lines, ours="dense")[0], 0)

    def test_version_1_is_read(self):
        path = self.dir / "old.h5"
        path.write_bytes((DATA / "coarse.pack.h5").read_bytes())
        with h5py.File(path, "r+") as file:
            file.attrs.modify("version", np.int32(1))
        self.assertEqual(run("compare", DATA / "coarse.pack.h5", path)[0], 0)
        with h5py.File(path, "r+") as file:
            file.attrs.modify("version", np.int32(3))
        self.assertEqual(run("compare", DATA / "coarse.pack.h5", path)[0], 2)


class SingleTest(Folder):
    """Outputs that are rounded to 32 bits are within the tolerances of --single. Outputs with 10 bits are not."""

    def rounded(self, bits):
        path = self.dir / f"rounded{bits}.h5"
        path.write_bytes((DATA / "mixed.pack.h5").read_bytes())
        with h5py.File(path, "r+") as file:
            for group in file.values():
                for name, data in group.items():
                    if name.startswith("out.") and data.dtype.kind == "f":
                        fraction, power = np.frexp(data[:])
                        data[...] = np.ldexp(np.rint(np.ldexp(fraction, bits)), power - bits)
                        data.attrs.pop("xxh64", None)
        return path

    def test_tolerances(self):
        code, said, _ = run("compare", DATA / "mixed.pack.h5", self.rounded(24), "--single")
        self.assertEqual(code, 6, said)
        tables = [line for line in said.splitlines() if " values " in line and " differ, " in line and "out." in line]
        self.assertGreater(len(tables), 40)
        for line in tables:
            self.assertRegex(line, r"[0-9.e+-]+ of the tolerance$")

    def test_coarse_outputs_are_beyond(self):
        """Each operator that rounds; in sweeps, errors of an exchange may grow, so their hits are judged by `exchange`."""
        path = self.rounded(8)
        for name in ("random", "crossing", "exchange", "sweep", "bond_force", "bend_force", "force", "kick", "stream", "solve",
                     "rotate", "swap"):
            code, said, _ = run("compare", "--no-name", DATA / "mixed.pack.h5", path, "--single", "--only", name)
            self.assertEqual(code, 7, (name, said))

    def test_factors_have_the_tolerance_of_energies(self):
        """A port whose relative energies are off by one unit, as by a sum in doubles, and whose factors are right for these."""
        for operator, step, ours in (("rescale", 2, "dense"), ("maxwell_boltzmann", 2, "dense")):
            lines, place = self.text_of(ours), f"{operator} {step} "
            values = {(int(k), c): float(v) for _, _, k, c, v in (line.split() for line in lines if line.startswith(place))}
            energy = {k: v for (k, c), v in values.items() if c == "out.relative.energy"}
            total = sum(v + 1 for v in energy.values() if v) / sum(energy.values())
            for at, line in enumerate(lines):
                words = line.split()
                if not line.startswith(place) or not energy[int(words[2])] if words[3].startswith("out.") else True:
                    continue
                e = energy[int(words[2])]
                if words[3] == "out.relative.energy":
                    lines[at] = " ".join([*words[:4], str(int(e) + 1)])
                if words[3] == "out.factor.factor":
                    ratio = total if operator == "rescale" else (e + 1) / e
                    lines[at] = " ".join([*words[:4], repr(float(words[4]) / ratio**0.5)])
            code, said, _ = self.compare(lines, "--only", operator, ours=ours)
            self.assertEqual(code, 6, said)
            self.assertRegex(said, "out.factor +of [0-9]+ values [0-9]{2,} differ, 0 beyond")

    def test_nan_is_called_nan(self):
        lines = self.text_of("mixed")
        at = next(k for k, line in enumerate(lines) if line.startswith("kick 3 7 out.velocity.y"))
        for word in ("nan", "-nan"):
            lines[at] = f"kick 3 7 out.velocity.y {word}"
            for options in ((), ("--single",)):
                code, said, _ = self.compare(lines, *options, ours="mixed")
                self.assertEqual(code, 7, said)
                self.assertIn("1 are NaN", said)
                self.assertIn("NaN there: not a number", said)
                self.assertNotIn("-nan", said)


class TracesTest(Folder):
    def setUp(self):
        super().setUp()
        self.rows = [line.split(",") for line in (DATA / "coarse.trace.csv").read_text().splitlines()]

    def compare_traces(self, rows):
        path = self.dir / "theirs.csv"
        path.write_text("".join(",".join(row) + "\n" for row in rows))
        return run("compare", DATA / "coarse.trace.csv", path)

    def test_same(self):
        code, said, _ = self.compare_traces(self.rows)
        self.assertEqual((code, said.splitlines()[-1]), (0, "same: every state"))
        self.assertEqual(self.compare_traces([row[:3] for row in self.rows])[0], 0)
        self.assertEqual(self.compare_traces([row[::-1] for row in self.rows])[0], 0)
        self.assertEqual(self.compare_traces([[row[0], row[1], row[2].upper() if k else row[2], *row[3:]]
                                              for k, row in enumerate(self.rows)])[0], 0)

    def test_first_difference(self):
        self.rows[9][2], self.rows[12][2] = "0123456789abcdef", "1123456789abcdef"
        code, said, _ = self.compare_traces(self.rows)
        self.assertEqual(code, 7)
        self.assertIn(f"first difference: step {self.rows[9][0]}, stage {self.rows[9][1]}: state hash", said)
        self.assertIn("no sum differs there", said)
        self.assertIn(f"{len(self.rows) - 1} rows compared, 2 differ", said)

    def test_no_sums(self):
        """Sums that are not there are not said to agree; one column of them is enough."""
        self.rows[9][2] = "0123456789abcdef"
        code, said, _ = self.compare_traces([row[:3] for row in self.rows])
        self.assertEqual(code, 7)
        self.assertIn("their trace has no sums", said)
        self.assertNotIn("no sum differs", said)
        code, said, _ = self.compare_traces([row[:4] for row in self.rows])
        self.assertEqual(code, 7)
        self.assertIn("no sum differs there", said)
        self.assertNotIn("has no sums", said)

    def test_sums(self):
        value = float(self.rows[7][6])
        self.rows[7][6] = repr(value * (1 + 1e-12))
        self.assertEqual(self.compare_traces(self.rows)[0], 0)
        self.rows[7][6] = repr(value + 1e-3)
        code, said, _ = self.compare_traces(self.rows)
        self.assertEqual(code, 7)
        self.assertIn("the same state, other sums", said)
        self.assertIn("solvent_kinetic", said)

    def test_rows(self):
        code, said, _ = self.compare_traces(self.rows[:20])
        self.assertEqual(code, 7)
        self.assertIn(f"step {self.rows[20][0]}, stage {self.rows[20][1]}: missing", said)
        code, said, _ = self.compare_traces(self.rows + [self.rows[-1]])
        self.assertIn("not here", said)
        code, said, _ = self.compare_traces(self.rows[:4] + self.rows[5:])
        self.assertEqual(code, 7)
        self.assertIn(f"stage {self.rows[5][1]} there", said)

    def test_bad_input(self):
        for rows in ([["step", "stage", "hash"]], [["step", "stage", "state_hash", "speed"]],
                     [["step", "stage", "state_hash", "stage"]], [self.rows[0], self.rows[1][:2]], [[]]):
            code, _, said = self.compare_traces(rows)
            self.assertEqual(code, 2, rows)
            self.assertIn("theirs.csv", said)


class PortTest(Folder):
    OURS = f'grep -q "kick[ .]3" "$1" && ours={DATA}/mixed || ours={DATA}/coarse; '  # which pack it is; HDF5 names its groups

    def setUp(self):
        super().setUp()
        for name in ("coarse", "mixed"):
            for path in DATA.glob(f"{name}.*"):
                if not path.name.endswith(".gz"):
                    (self.dir / path.name).symlink_to(path)

    def port(self, packs, traces="exit 3"):
        """A script: what it does with a pack in $1, and with a start in $1; to write: $2."""
        path = self.dir / "port"
        path.write_text(f'#!/bin/bash\nif [ "$1" = --trace ]; then shift; {traces}; else {packs}; fi\n')
        path.chmod(0o755)
        return path

    def right(self, then=":"):
        return self.OURS + f'cp $ours.pack.h5 "$2"; {then}'

    def text(self, change="cat"):
        return self.OURS + f'gzip -dc $ours.pack.txt.gz | {change} >"$2"'

    def check(self, port, *options, name=False):
        report = self.dir / "report.json"
        report.unlink(missing_ok=True)
        code, said, wrong = run("check", port, "--packs", self.dir, "-o", report, *options, *([] if name else ["--no-name"]))
        return code, said, json.loads(report.read_text())["checks"], wrong

    def test_right(self):
        trace = f"{UNCROSS} oracle dump $1 | grep -q 'in.run.steps 8' && cp {DATA}/coarse.trace.csv $2 || cp {DATA}/mixed.trace.csv $2"
        code, said, checks, _ = self.check(self.port(self.right(), trace))
        self.assertEqual(code, 0, said)
        self.assertEqual([(c["name"], c["kind"], c["verdict"]) for c in checks],
                         [("coarse.pack", "pack", "same"), ("mixed.pack", "pack", "same"),
                          ("coarse.trace", "trace", "same"), ("mixed.trace", "trace", "same")])
        self.assertIn("same 4, close 0, different 0", said)
        self.assertRegex(said, "not judged: 0 of 1[0-9]{4} values of packs, 0 %")

    def test_text(self):
        code, said, checks, _ = self.check(self.port(self.text("grep -v ' in[.]'")), "--text", "--no-traces")
        self.assertEqual((code, len(checks)), (0, 2), said)
        code, said, _, _ = self.check(self.port("grep -v ' in[.]' $1 >$2"), "--no-traces")
        self.assertEqual(code, 7, said)

    def test_no_answers_are_given(self):
        """Neither outputs nor bounds, in either form. Operators without inputs are asked for by the number of the step."""
        seen = self.dir / "seen"
        seen.mkdir()
        self.check(self.port(f'cp "$1" {seen}/$RANDOM$RANDOM.h5; exit 3'), "--no-traces")
        self.check(self.port(f'cp "$1" {seen}/$RANDOM$RANDOM.txt; exit 3'), "--text", "--no-traces")
        tables = 0
        for path in seen.glob("*.h5"):
            with h5py.File(path) as file:
                names = [name for group in file.values() for name in group]
                self.assertLessEqual({"order.1", "shift.8"} if "kick.1" in file else {"order.3", "shift.30"}, set(file))
                self.assertEqual([name for name in names if not name.startswith("in.")], [])
                tables += len(names)
        for path in seen.glob("*.txt"):
            self.assertRegex(path.read_text(), "\nshift (8|30) 0 in.step.step (8|30)\n")
            lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
            self.assertEqual([line for line in lines if not line.split()[3].startswith("in.")], [])
            tables += len(lines)
        self.assertEqual(len(list(seen.iterdir())), 4)
        self.assertGreater(tables, 1000)

    def test_what_was_given_is_no_answer(self):
        """The script of shared/faults/port-copy."""
        for options in ((), ("--text",)):
            code, said, checks, _ = self.check(self.port('cp "$1" "$2"'), "--no-traces", *options)
            self.assertEqual((code, {c["verdict"] for c in checks}), (7, {"failed"}), said)
            self.assertIn("the port has sent back what it was given: no table out.", checks[0]["trouble"])

    def test_wrong(self):
        code, said, checks, _ = self.check(self.port(self.text("sed '/^kick 1 0 out.velocity.x/s/ [^ ]*$/ 7.5/'")), "--text", "--no-traces")
        self.assertEqual(code, 7)
        self.assertIn("first difference: kick, step 1, vertex 0, out.velocity.x", said)
        self.assertEqual([c["verdict"] for c in checks], ["differs", "same"])
        self.assertEqual(checks[0]["first_difference"], "kick, step 1, vertex 0, out.velocity.x")
        self.assertEqual((checks[0]["different"], checks[0]["beyond_tolerance"]), (1, 1))

    def test_wrong_trace(self):
        change = f"sed '5s/,[0-9a-f]*,/,0123456789abcdef,/' {DATA}/coarse.trace.csv >$2"
        code, said, checks, _ = self.check(self.port(self.right(), change))
        self.assertEqual(code, 7, said)
        self.assertRegex(checks[2]["first_difference"], "^step [0-9]+, stage [a-z]+$")

    def test_close_packs_beside_other_traces(self):
        """What is close may be why a trace differs: it is told on the terminal, too."""
        change = f"sed 5d {DATA}/coarse.trace.csv >$2"  # a row that is missing has a name at once
        code, said, _, _ = self.check(self.port(self.text(self.LAST_DIGIT), change), name=True)
        self.assertEqual(code, 7, said)
        self.assertRegex(said, "\nmixed.pack\n(.*\n)+first difference: kick, step 3, vertex 0, out.velocity.x(.*\n)+this pattern: ")
        code, said, _, _ = self.check(self.port(self.text(self.LAST_DIGIT)), "--no-traces", name=True)
        self.assertNotIn("this pattern", said)
        self.assertIn("\nmixed.pack, close: kick, step 3, vertex 0, out.velocity.x: no larger than rounding", said)

    LAST_DIGIT = "sed -E '/^kick 3 0 out.velocity.x/s/[0-8]$/9/'"

    def test_close(self):
        code, said, checks, _ = self.check(self.port(self.text(self.LAST_DIGIT)), "--text", "--no-traces")
        self.assertEqual(code, 6, said)
        self.assertEqual(["same", "close"], [c["verdict"] for c in checks])

    def test_ports_that_fail(self):
        for does, word in (("exit 3", "the port's exit code is 3"), ("exit 255", "the port's exit code is 255"), ("kill -SEGV $$", "ended by signal 11"),
                           ("exec sleep 60", "took more than 1 s"), ("true", "has not written its output"),
                           ("echo nonsense >$2", "'' is not understood"), ("echo bin 1 0 out.solvent.cell 18446744073709551609 >$2", "and -7 without its sign is printed so"), ("head -c 5000 $1 >$2", "out")):
            code, said, checks, _ = self.check(self.port(does), "--no-traces", "--seconds", 1)
            self.assertEqual((code, {c["verdict"] for c in checks}), (7, {"failed"}), said)
            self.assertIn(word, checks[0]["trouble"])
            self.assertIn("failed: ", said)

    def test_all_that_hangs_is_ended(self):
        """A port that ignores signals, or waits for a child in the same group: one second each, not the child's time."""
        for does in ("trap '' ALRM TERM; sleep 8; sleep 8", "sleep 8"):
            began = time.monotonic()
            code, _, checks, _ = self.check(self.port(does), "--no-traces", "--seconds", 1)
            self.assertEqual((code, {c["verdict"] for c in checks}), (7, {"failed"}))
            self.assertIn("took more than 1 s", checks[0]["trouble"])
            self.assertLess(time.monotonic() - began, 8)

    def test_no_child_writes_into_the_next_output(self):
        """The wrapper ends at once, what it has started would write later."""
        late = self.right(f'(sleep 0.6; echo late >{self.dir}/late; echo nonsense >"$2") & exit 0')
        code, said, _, _ = self.check(self.port(late), "--no-traces")
        self.assertEqual(code, 0, said)
        time.sleep(0.8)
        self.assertFalse((self.dir / "late").exists())

    def test_the_pack_that_runs_is_named(self):
        """Before it is done: within the minute that the port takes."""
        words = [UNCROSS, "oracle", "check", self.port("sleep 60"), "--packs", self.dir, "--no-traces"]
        with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as program:
            said = b""
            while b"coarse.pack" not in said:
                more = os.read(program.stdout.fileno(), 1000)
                self.assertTrue(more)
                said += more
            self.assertIsNone(program.poll())
            program.send_signal(signal.SIGTERM)
            self.assertEqual(program.wait(timeout=10), -signal.SIGTERM)

    def test_repeat(self):
        """The second answer differs in a last digit: within tolerance, but not the same."""
        count = self.dir / "count"
        (self.dir / "coarse.pack.h5").unlink()
        unlike = f"echo >>{count}; [ $(wc -l <{count}) = 2 ] && last=9 || last=0; " + self.text(
            "sed -E \"/^kick 3 0 out.velocity.x/s/[0-9]$/$last/\"")
        code, said, checks, _ = self.check(self.port(unlike), "--no-traces", "--text", "--repeat", 3)
        self.assertEqual((code, [c["verdict"] for c in checks]), (7, ["failed"]), said)
        self.assertIn("call 2 gives other bits than call 1: kick, step 3, vertex 0, out.velocity.x", checks[0]["trouble"])
        code, said, _, _ = self.check(self.port(self.right()), "--no-traces", "--repeat", 2)
        self.assertEqual(code, 0, said)

    def test_repeated_traces(self):
        count = self.dir / "count"
        trace = f"echo >>{count}; sed \"$(wc -l <{count})s/,[0-9a-f]*,/,0123456789abcdef,/\" {DATA}/coarse.trace.csv >$2"
        (self.dir / "mixed.trace.csv").unlink()
        code, said, checks, _ = self.check(self.port(self.right(), trace), "--repeat", 2)
        self.assertEqual(code, 7, said)
        self.assertIn("call 2 gives other bits than call 1: step 0, stage start", checks[2]["trouble"])

    def test_what_the_port_prints(self):
        """It goes to standard error, and nothing of it into the table; nothing is left in TMPDIR."""
        scratch = self.dir / "scratch"
        scratch.mkdir()
        done = subprocess.run([UNCROSS, "oracle", "check", self.port(f"echo chatter; {self.right()}"), "--packs", self.dir,
                               "--no-traces"], capture_output=True, text=True, check=False, env={**os.environ, "TMPDIR": scratch})
        self.assertEqual(done.returncode, 0)
        self.assertNotIn("chatter", done.stdout)
        self.assertIn("chatter", done.stderr)
        self.assertEqual(list(scratch.iterdir()), [])

    def test_only_and_single(self):
        code, _, checks, _ = self.check(self.port(self.right()), "--only", "kick,bin")
        self.assertEqual((code, len(checks)), (0, 2))
        code, _, checks, _ = self.check(self.port(self.right()), "--single")
        self.assertEqual((code, len(checks)), (0, 2))

    def test_bad_input(self):
        port = self.port(self.right())
        (self.dir / "there.json").write_text("mine")
        empty = self.dir / "empty"
        empty.mkdir()
        for words, word in (((self.dir / "no-port",), "cannot be run"), ((port, "--packs", empty), "no packs"),
                            ((port, "--only", "kik"), "nothing to compare"),
                            ((port, "-o", self.dir / "there.json"), "File exists")):
            code, _, said = run("check", "--packs", self.dir, *words) if "--packs" not in words else run("check", *words)
            self.assertEqual(code, 2, words)
            self.assertIn(word, said)
        self.assertEqual((self.dir / "there.json").read_text(), "mine")


if __name__ == "__main__":
    unittest.main()
