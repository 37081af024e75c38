"""Names of files and folders that act on shells, terminals or pages, through every command: none of them does anything, and
what is printed can be pasted. Needs UNCROSS."""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]
UNCROSS = os.path.abspath(os.environ.get("UNCROSS", "build/uncross"))
sys.dont_write_bytecode = True
sys.path.insert(0, str(TOP / "python"))

ALL = "x\ntouch PWNED\n#'\"`touch PWNED`$(touch PWNED);touch PWNED\x1b]0;t\x07<script>alert(1)<"
NAMES = [ALL, "-x", "\udcff\udc9b31m", "\u00e9 b", "q'; touch PWNED; '", '"; touch PWNED; "', "`touch PWNED`", "$(touch PWNED)",
         "<script>alert(1)<", "\x1b]52;c;aGk=\x07", "\x9b31m", "\u202egnp", "a\\nb", "tab\there"]
# As a terminal shows them: written by hand. Bytes that act are \xNN, line ends and tabs \n and \t.
SHOWN = ["x\\ntouch PWNED\\n#'\"`touch PWNED`$(touch PWNED);touch PWNED\\x1b]0;t\\x07<script>alert(1)<", "-x", "\\xff\\x9b31m",
         "\u00e9 b", *NAMES[4:9], "\\x1b]52;c;aGk=\\x07", "\\xc2\\x9b31m", "\\xe2\\x80\\xaegnp", "a\\nb", "tab\\there"]
SCENE = """box: [4, 4, 4]
time_step: 0.01
steps: {steps}
solvent: {{per_cell: 3, collision_interval: 0.02}}
observe: {{conserved: {{every: 1}}}}
"""


class HostileNames(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        (self.folder / "s.yaml").write_text(SCENE.format(steps=2))

    def tearDown(self):
        self.temporary.cleanup()

    def run_words(self, *words, program=UNCROSS, **more):
        """Standard output and error, which no byte of acts on a terminal; and the exit code."""
        done = subprocess.run([program, *words], cwd=self.folder, capture_output=True, timeout=600, check=False, **more)
        said = (done.stdout + done.stderr).decode()  # UTF-8
        self.assertFalse([c for c in said if not (c.isprintable() or c == "\n")], (words, said))
        self.assertFalse(list(self.folder.rglob("PWNED")), words)
        return done.returncode, said

    def test_what_is_not_there(self):
        from uncross_sweep import escape
        for name, shown in zip(NAMES, SHOWN):
            self.assertEqual(escape.shown(name), shown)
            for command in (["check"], ["run"], ["info"], ["verify"], ["export"], ["analyze"], ["oracle", "dump"]):
                out = ["--out", "o"] if command[0] in ("run", "analyze") else []
                code, said = self.run_words(*command, *out, "--", name)
                self.assertNotEqual(code, 0, (command, name))
                self.assertIn(shown, said, command)

    def test_options_that_are_none(self):
        """As a glob makes them of files' names."""
        for name in "\x1b]0;pwn\x07", "\x9b31m", "\u202egnp", "a\nb":
            for command in ("check", "run", "info", "verify", "export", "analyze", "map", "sweep", "plot", "compare"):
                for word in f"--{name}", f"-{name}", f"--out{name}=1":
                    code, said = self.run_words(command, word, "s.yaml")
                    self.assertEqual(code, 2, (command, word))
                    self.assertIn("uncross", said)

    def test_what_is_there(self):
        self.run_words("run", "s.yaml", "--out", "whole", "--quiet")
        for name, shown in zip(NAMES, SHOWN):
            shutil.copytree(self.folder / "whole", self.folder / name)
            (self.folder / (name + ".yaml")).write_text(SCENE.format(steps=2))
            place = name if name[0] != "-" else "./" + name
            for words in (["verify", place], ["info", f"{place}/checkpoint.h5"], ["info", f"{place}/run.json"],
                          ["info", f"{place}.yaml"], ["check", f"{place}.yaml"], ["info", f"{place}/conserved.csv"]):
                code, said = self.run_words(*words)
                self.assertEqual(code, 0, said)
                self.assertIn(shown, said, words)

    def test_the_command_that_goes_on(self):
        """An interrupted run prints a command, which bash takes as it is."""
        for name in NAMES[:4]:
            (self.folder / name).write_text(SCENE.format(steps=10000000))
            before = {path for path in self.folder.iterdir() if path.is_dir()}
            words = [UNCROSS, "run", f"--out={name}.d", "--set", "seed=3", "--", name]
            run = subprocess.Popen(words, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            give_up = time.monotonic() + 30
            while not (self.folder / f"{name}.d" / "run.json").exists() and time.monotonic() < give_up:
                time.sleep(0.02)
            run.send_signal(signal.SIGTERM)
            said, told = run.communicate(timeout=60)
            self.assertRegex(said.decode(), "(?m)^go on with: ", told)
            command = re.search(r"^go on with: (.*)$", said.decode(), re.M)[1]
            done = subprocess.run(["bash", "-c", command + " --steps 1"], cwd=self.folder, capture_output=True, check=False)
            self.assertEqual(done.returncode, 0, (command, done.stderr))
            self.assertEqual({path for path in self.folder.iterdir() if path.is_dir()} - before, {self.folder / f"{name}.d"})
            self.assertFalse(list(self.folder.rglob("PWNED")))

    def test_shells_that_are_not_bash(self):
        """A name that acts is a word of bash: $'...'. Another shell may take it for another name, but runs nothing of it."""
        for name in ("a\n'; touch PWNED; #", "a\\\n'; touch PWNED; #", "\x1b'`touch PWNED`'"):
            (self.folder / name).write_text(SCENE.format(steps=2))
            code, script = self.run_words("sweep", f"--out={name}.d", "--list", "--", name)
            self.assertEqual(code, 0, script)
            subprocess.run(["/bin/sh", "-c", script], cwd=self.folder, capture_output=True, check=False)
            self.assertFalse(list(self.folder.rglob("PWNED")), script)

    def test_scripts_of_sweeps(self):
        for name in NAMES[:4]:
            (self.folder / name).write_text(SCENE.format(steps=2))
            for how in ("--slurm", "--list") if name == ALL else ("--slurm",):
                out = f"{name}{how}"
                code, script = self.run_words("sweep", f"--out={out}", how, "--", name)
                self.assertEqual(code, 0, script)
                environment = {**os.environ, "SLURM_ARRAY_TASK_ID": "0"}
                done = subprocess.run(["bash", "-c", script], cwd=self.folder, capture_output=True, check=False, env=environment)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertFalse(list(self.folder.rglob("PWNED")), script)
                self.assertTrue((self.folder / out / "all/seed-1/run.json").exists(), script)

    def test_sweeps_and_pages(self):
        (self.folder / ALL).write_text(SCENE.format(steps=2))
        for name in ALL, NAMES[2]:
            code, said = self.run_words("sweep", "--out", f"{name}.d", "--", ALL)
            self.assertEqual(code, 0, said)
            self.assertEqual(self.run_words("sweep", "--out", f"{name}.d", "--", ALL)[0], 2)
            code, said = self.run_words("plot", f"{name}.d/all/seed-1", "--out", f"{name}.html")
            self.assertEqual(code, 0, said)
            page = (self.folder / f"{name}.html").read_text(encoding="utf-8")
            self.assertNotIn("<script>alert", page)
            self.assertEqual(self.run_words("plot", f"{name}.d", "--out", f"{name}.html")[0], 2)


if __name__ == "__main__":
    unittest.main()
