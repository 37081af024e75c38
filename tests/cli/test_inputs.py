"""What is no regular file, as every input of every command: refused at once, with its name and a word. And a file of 100 GB that is
one hole. Needs UNCROSS."""
import os
import pathlib
import subprocess
import tempfile
import unittest

UNCROSS = os.path.abspath(os.environ.get("UNCROSS", "build/uncross"))
SECONDS = 20  # a busy machine; what waits for a pipe waits for ever
MOST = 40.0  # MiB; the program takes some 15, plot 34
SCENE = """box: [4, 4, 4]
time_step: 0.01
steps: 2
solvent: {per_cell: 3, collision_interval: 0.02}
"""
IN = "INPUT"  # what stands for it below
COMMANDS = [["check", IN], ["run", IN, "--out", "r"], ["sweep", IN, "--out", "w"], ["sweep", IN, "--out", "w", "--list"], ["analyze", IN, "--out", "t"],
            ["export", IN], ["info", IN], ["verify", IN], ["plot", IN], ["oracle", "emit", IN, "--out", "e.h5"],
            ["oracle", "start", IN, "--out", "e.h5"], ["oracle", "trace", IN], ["oracle", "dump", IN], ["oracle", "compare", IN, "p.h5"],
            ["oracle", "compare", "p.h5", IN], ["oracle", "judge", IN, "o.csv"], ["oracle", "judge", "o.csv", IN], ["check", "start.yaml"],
            ["run", "start.yaml", "--out", "r"]]


class Inputs(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        (self.folder / "s.yaml").write_text(SCENE)
        (self.folder / "start.yaml").write_text(f"{SCENE}start: {{snapshot: {IN}}}\n")
        (self.folder / "o.csv").write_text("observable,value,error,blocks,time,resolve\na,1,0.01,40,10,0.02\n")
        self.assertEqual(self.run_words("oracle", "emit", "s.yaml", "--out", "p.h5")[0], 0)

    def tearDown(self):
        self.temporary.cleanup()

    def run_words(self, *words):
        """Exit code, output; the code is None where it waits."""
        with tempfile.TemporaryFile() as said:
            program = subprocess.Popen([UNCROSS, *words], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=said, stderr=subprocess.STDOUT)
            try:
                program.wait(SECONDS)
            except subprocess.TimeoutExpired:
                program.kill()
                program.wait()
                return None, "it waits"
            said.seek(0)
            return program.returncode, said.read().decode(errors="replace")

    def refused(self, name, commands):
        for command in commands:
            words = [name if word == IN else word for word in command]
            with self.subTest(words=words):
                code, said = self.run_words(*words)
                self.assertIn(code, (1, 2, 7, 9), said)
                self.assertRegex(said, r"not a file but a folder, a pipe or a device|is a directory|a folder without", said)

    def test_no_regular_file(self):
        for name, make in ((IN, lambda path: os.mkfifo(path)), (IN, lambda path: path.symlink_to("/dev/zero"))):
            make(self.folder / name)
            self.refused(name, COMMANDS)
            (self.folder / name).unlink()

    def test_an_empty_value(self):
        """Of an option: said to be that, by one sentence for every command, before anything is made."""
        before = sorted(os.listdir(self.folder))
        for words in (["run", "s.yaml", "--out", ""], ["sweep", "s.yaml", "--seeds", "1..2", "--out", ""], ["plot", "o.csv", "--out", ""],
                      ["analyze", "p.h5", "-o", ""], ["export", "p.h5", "--out="], ["oracle", "emit", "s.yaml", "-o", ""],
                      ["oracle", "start", "s.yaml", "-o", ""], ["oracle", "check", "port", "--packs", ""], ["check", "s.yaml", "--units", ""]):
            code, said = self.run_words(*words)
            self.assertEqual(code, 2, (words, said))
            self.assertRegex(said, r"--(out|packs|units): an empty value; allowed: [A-Za-z]", words)
        self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_a_folder(self):
        (self.folder / IN).mkdir()
        self.refused(IN, [command for command in COMMANDS if command[0] != "plot"])

    def test_a_hole(self):
        """Its size is known when it is opened, so it is not read."""
        with open(self.folder / "hole.yaml", "wb") as file:
            file.truncate(100 * 10**9)
        for words in ["check", "hole.yaml"], ["run", "hole.yaml", "--out", "r"], ["oracle", "trace", "hole.yaml"], ["sweep", "hole.yaml", "--out", "w"]:
            before = os.times().children_user + os.times().children_system
            program = subprocess.Popen([UNCROSS, *words], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            said = program.stdout.read().decode()
            program.stdout.close()
            _, status, usage = os.wait4(program.pid, 0)
            program.returncode = os.waitstatus_to_exitcode(status)
            self.assertEqual(program.returncode, 2, said)
            self.assertIn("too large; a scene is a YAML file of at most 64 MiB", said)
            self.assertLess(usage.ru_maxrss / 1024, MOST, words)
            self.assertLess(os.times().children_user + os.times().children_system - before, 2.0)


if __name__ == "__main__":
    unittest.main()
