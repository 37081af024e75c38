"""What `make install` puts below a prefix: it serves C, C++ and Python programs alone, and `make uninstall` removes it all.

Needs BUILD, the build folder (default build), with the libraries in it.
"""
import filecmp
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("BUILD", TOP / "build")).resolve()
SCENE = TOP / "reference-data" / "mixed.yaml"
STEPS = 30


def call(*words, environment=None, folder=TOP, code=0, show=False, unset=()):
    kept = {name: text for name, text in os.environ.items() if name not in unset}
    done = subprocess.run([str(w) for w in words], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          check=False, env={**kept, "MAKEFLAGS": "", **(environment or {})})
    if done.returncode != code:
        raise AssertionError(f"{words}: {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr * show


def copy_build(to):
    """A build folder of our own: another prefix links program and library anew, and other tests are running them."""
    to.mkdir()
    for path in BUILD.iterdir():
        if path.name in ("src", "lib", "libexec"):
            shutil.copytree(path, to / path.name, symlinks=True)
        elif path.is_file() and (path.name in ("uncross", "everything.a", "build-info.inc", "made-by") or path.name.startswith("found-")):
            shutil.copy2(path, to)
    return to


def make(target, prefix, destination="", *words, code=0, **more):
    """As it was built: without MARCH, `make install` would build for all processors."""
    return call("make", "-s", target, f"BUILD={os.path.relpath(Installed.build, TOP)}", f"PREFIX={prefix}", f"DESTDIR={destination}",
                f"MARCH={os.environ.get('MARCH', 'native')}", *words, code=code, **more)


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(dir=BUILD))
        Installed.build = copy_build(cls.folder / "build")
        cls.prefix = cls.folder / "a b & 'c' | \"d\""  # as a user may call a folder
        make("install", cls.prefix)
        cls.environment = {"PKG_CONFIG_PATH": str(cls.prefix / "lib/pkgconfig"),
                           "LD_LIBRARY_PATH": str(cls.prefix / "lib"),
                           "PYTHONPATH": str(cls.prefix / "lib/python3/dist-packages")}
        call(cls.prefix / "bin/uncross", "run", SCENE, "--out", cls.folder / "run", "--steps", STEPS, "--quiet")
        cls.hash = json.loads((cls.folder / "run/run.json").read_text())["state_hash"]

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def flags(self, *words):
        return shlex.split(call("pkg-config", *words, environment=self.environment))

    def program(self, name, compiler, source, *flags):
        path = self.folder / name
        call(*compiler.split(), "-Wall", "-Wextra", "-Wpedantic", "-Werror", source, *flags, "-o", path)
        return call(path, SCENE, STEPS, environment=self.environment)

    def test_the_c_example(self):
        flags = self.flags("--cflags", "--libs", "uncross")
        example = self.prefix / "share/uncross/examples/c/end_to_end.c"
        told = self.program("shared", "cc -std=c99", example, *flags, "-lm")
        self.assertRegex(told, f"^step {STEPS}, hash {self.hash}, end-to-end distance [0-9.]+ a0\n$")
        needed = call("readelf", "-d", self.folder / "shared")
        self.assertIn("Shared library: [libuncross.so.0]", needed)

    def test_the_c_example_linked_statically(self):
        flags = [f for f in self.flags("--cflags", "--libs", "--static", "uncross") if f != "-luncross"]
        example = self.prefix / "share/uncross/examples/c/end_to_end.c"
        told = self.program("static", "cc -std=c99", example, self.prefix / "lib/libuncross.a", *flags, "-lm")
        self.assertIn(self.hash, told)
        self.assertNotIn("libuncross", call("readelf", "-d", self.folder / "static"))

    def test_the_header_in_c_plus_plus(self):
        source = self.folder / "user.cc"
        source.write_text('#include <uncross.h>\n#include <cstdio>\n'
                          'int main(int, char **words)\n{\n  uncross_error error;\n'
                          '  uncross_scene *scene = uncross_scene_read(words[1], nullptr, 0, &error);\n'
                          '  uncross_sim *sim = uncross_sim_start(scene, &error);\n  uint64_t hash = 0;\n'
                          '  uncross_sim_advance(sim, 30, &error);\n  uncross_sim_hash(sim, &hash, &error);\n'
                          '  std::printf("%016llx\\n", (unsigned long long)hash);\n'
                          '  uncross_sim_free(sim);\n  uncross_scene_free(scene);\n}\n')
        told = self.program("user", "c++ -std=c++11", source, *self.flags("--cflags", "--libs", "uncross"))
        self.assertEqual(told, self.hash + "\n")

    def test_the_core(self):
        """A program that is built with the core's headers, and needs no library for files."""
        source = self.folder / "core.c"
        source.write_text('#include <stdio.h>\n#include "start/start.h"\n#include "step.h"\n'
                          'int main(void)\n{\n  struct model m = {.box = box_of_cells(4, 4, 4), .seed = 1, .time_step = 0.01,\n'
                          '    .solvent = {.per_cell = 5, .collision_interval = 0.02, .rotation_angle = 90, '
                          '.hydrodynamics = true}};\n  struct model_error error;\n  struct state s;\n  struct work w;\n'
                          '  if (!model_finish(&m, &error) || !state_alloc(&s, &m) || !work_alloc(&w, &m) || !start_state(&s, &m, &w) '
                          '||\n      !step_advance(&s, &m, &w, NULL))\n    return 1;\n'
                          '  printf("step %d\\n", (int)s.step);\n  return 0;\n}\n')
        flags = self.flags("--cflags", "--libs", "uncross-core")
        self.assertFalse([f for f in flags if re.search("hdf5|yaml|jansson", f)])
        self.assertEqual(self.program("core", "cc -std=gnu11 -Wno-missing-field-initializers", source, *flags), "step 1\n")

    def test_the_python_example(self):
        example = self.prefix / "share/uncross/examples/python/end_to_end.py"
        told = call("/usr/bin/python3", example, SCENE, STEPS, environment=self.environment, folder=self.folder)
        self.assertRegex(told, f"^step {STEPS}, hash {self.hash}, end-to-end distance [0-9.]+ a0\n$")
        c = self.program("again", "cc", self.prefix / "share/uncross/examples/c/end_to_end.c",
                         *self.flags("--cflags", "--libs", "uncross"), "-lm")
        self.assertEqual(told, c)

    def test_the_programs_of_the_page(self):
        page = (self.prefix / "share/uncross/docs/library.md").read_text()
        c, python = (re.search(rf"```{language}\n(.*?)```", page, re.S)[1] for language in ("c", "python"))
        place = self.folder / "page"
        place.mkdir()
        (place / "scene.yaml").write_text(
            "box: [4, 4, 4]\ntime_step: 0.01\nsteps: 9\nsolvent: {per_cell: 3, collision_interval: 0.02}\nfibers:\n"
            "  - {name: a, count: 2, vertices: 4, mass: 5, bond_length: 0.5, spring: 100, bending: 4}\n")
        (place / "program.c").write_text(c)
        call("cc", "-Wall", "-Wextra", "-Werror", place / "program.c", *self.flags("--cflags", "--libs", "uncross"), "-o",
             place / "program")
        told = call(place / "program", environment=self.environment, folder=place)
        self.assertRegex(told, r"^hash [0-9a-f]{16}, vertex 0 at x = \S+ a0\n$")
        again = call("/usr/bin/python3", "-c", python, environment=self.environment, folder=place)
        self.assertEqual(again.splitlines()[0] + "\n", told)

    def test_names(self):
        """The shared library shows what uncross.h declares, and nothing else; the static one defines no other names."""
        header = re.sub(r"/\*.*?\*/", "", (self.prefix / "include/uncross.h").read_text(), flags=re.S)
        declared = set(re.findall(r"UNCROSS_API[^;(]*?(uncross_\w+)\(", header))
        self.assertGreater(len(declared), 30)
        shown = {line.split()[2] for line in call("nm", "-D", "--defined-only", self.prefix / "lib/libuncross.so").splitlines()}
        self.assertEqual(shown, {f"{name}@@UNCROSS_0" for name in declared} | {"UNCROSS_0"})
        static = call("nm", "--defined-only", "--extern-only", self.prefix / "lib/libuncross.a").splitlines()
        self.assertEqual({line.split()[2] for line in static if len(line.split()) == 3}, declared)

    def test_manners(self):
        """Nothing in it can end or print, or change signals and locale of the whole process."""
        used = call("nm", "-D", "--undefined-only", self.prefix / "lib/libuncross.so").split()
        used = {name.split("@")[0] for name in used}
        self.assertIn("uselocale", used)
        for name in ("exit", "abort", "__assert_fail", "setlocale", "puts", "printf", "perror", "stdout", "stderr"):
            self.assertNotIn(name, used)
        objects = [path for path in (BUILD / "src").rglob("*.o") if not {"cli", "oracle"} & set(path.parts) and path.name != "info.o"]
        self.assertGreater(len(objects), 150)
        for path in objects:  # a process of its own may, the one that reads files
            used = {line.split()[-1] for line in call("nm", "--undefined-only", path).splitlines()}
            if path.name not in ("apart.o", "reader.o"):
                self.assertFalse(used & {"_exit", "signal", "__sysv_signal", "sigaction", "setrlimit", "kill", "fork"}, path)

    def test_man_page_and_completion(self):
        page = (self.prefix / "share/man/man1/uncross.1").read_text()
        self.assertEqual(page, call(BUILD / "uncross", "help", "--man"))
        for word in (".SH uncross run SCENE", "\\-\\-resume", "\\-\\-false\\-alarm P", ".SH EXIT STATUS"):
            self.assertIn(word, page)
        commands = call(BUILD / "uncross", "help", "--commands").splitlines()
        pages = {f"uncross-{name.replace(' ', '-')}.1" for name in commands} | {"uncross.1"}
        self.assertEqual({path.name for path in (self.prefix / "share/man/man1").iterdir()}, pages)
        self.assertEqual(call(BUILD / "uncross", "help", "--man", "oracle", "emit"), (self.prefix / "share/man/man1/uncross-oracle-emit.1").read_text())
        for name in commands:
            self.assertIn(f".BR uncross\\-{name.replace(' ', chr(92) + '-')} (1)", page)
        self.assertIn("unknown command", call(BUILD / "uncross", "help", "--man", "oracle", code=2, show=True))
        script = self.prefix / "share/bash-completion/completions/uncross"

        def complete(*words):
            array = " ".join(f"'{w}'" for w in words)
            told = call("bash", "-c", f". {shlex.quote(str(script))}; COMP_WORDS=({array}); COMP_CWORD={len(words) - 1}; _uncross; "
                        "printf '%s\\n' \"${COMPREPLY[@]}\"", folder=self.folder)
            return told.split()

        self.assertEqual(complete("uncross", "an"), ["analyze"])
        self.assertEqual(complete("uncross", "oracle", "e"), ["emit"])
        self.assertEqual(complete("uncross", "run", "--re"), ["--resume"])
        self.assertEqual(complete("uncross", "check", "--re"), [])
        self.assertEqual(complete("uncross", "oracle", "judge", "--f"), ["--false-alarm"])
        self.assertEqual(complete("uncross", "run", "run/run."), ["run/run.json"])

    def test_a_page(self):
        """The other program and its modules are found below the prefix, and nothing of the source tree is."""
        table = self.folder / "moved.csv"
        table.write_text("time,g,g_error\n1,2,0.1\n2,3,0.1\n")
        told = call(self.prefix / "bin/uncross", "plot", table, folder=self.folder)
        self.assertEqual(told, f"{self.folder}/moved.html\n")
        self.assertTrue((self.prefix / "libexec/uncross/uncross-plot").is_file())
        self.assertTrue((self.prefix / "lib/python3/dist-packages/uncross_plot/page.html.jinja").is_file())

    def test_an_export(self):
        told = call(self.prefix / "bin/uncross", "export", TOP / "tests/files/old/checkpoint.h5", folder=self.folder)
        self.assertRegex(told, r"^\d+\nLattice=")

    def test_si_units(self):
        told = call(self.prefix / "bin/uncross", "map", "length=10um,persistence=17um", "--units", "T=300K,eta=1mPas", folder=self.folder)
        (self.folder / "fiber.yaml").write_text(told)
        told = call(self.prefix / "bin/uncross", "check", "fiber.yaml", "--units", "a0=50nm,T=300K", folder=self.folder)
        self.assertIn("\n  unit of length                         a0                   1 a0        50 nm ", told)

    def test_what_a_reader_needs(self):
        """License and front pages; the table that judges a port, and the programs that measure, which find the installed program."""
        share = self.prefix / "share/uncross"
        for name in ("LICENSE", "NOTICE", "README.md", "CITATION.cff", "CHANGELOG.md", "reference-data/observables.csv", "reference-data/judge/fibers.yaml"):
            self.assertTrue(filecmp.cmp(TOP / name, share / name), name)
        told = call(self.prefix / "bin/uncross", "oracle", "judge", share / "reference-data/observables.csv", share / "reference-data/observables.csv")
        self.assertIn("consistent", told)
        told = call(share / "docs/exercises/measure", "--seeds", 1, "seed", folder=self.folder)
        self.assertRegex(told, r"\d")
        call(share / "reference-data/measure-observables", self.folder / "observables", "--runs", 2, "fibers", folder=self.folder)

    def test_a_missing_package(self):
        """Each command in Python that needs a package says which, in a line; those of this program have one name."""
        hidden, alone = self.folder / "hidden", self.folder / "alone"
        hidden.mkdir()
        (hidden / "numpy.py").write_text("raise ModuleNotFoundError('gone', name='numpy')\n")
        for part in "bin", "libexec":
            shutil.copytree(self.prefix / part, alone / part)
        for prefix, package, of, words in ((self.prefix, "numpy", "numpy", "sweep scene.yaml --out there"), (self.prefix, "numpy", "numpy", "topology file"),
                                           (alone, "uncross_units", "uncross", "map length=1um --units T=300K,eta=1mPas"), (alone, "uncross_export", "uncross", "export file"),
                                           (alone, "uncross_sweep", "uncross", "plot file")):
            told = call(prefix / "bin/uncross", *words.split(), code=1, environment={"PYTHONPATH": str(hidden)}, show=True)
            self.assertEqual(told, f"uncross: {words.split()[0]}: the Python package {package} is missing; `apt-get install python3-{of}` installs it\n")

    def test_another_folder_for_libraries(self):
        destination = self.folder / "multiarch"
        make("install", "/usr", destination, "LIBDIR=/usr/lib/machine-os")
        libraries = destination / "usr/lib/machine-os"
        self.assertEqual({path.name for path in libraries.iterdir()}, {"libuncross.so", "libuncross.so.0", "libuncross.a", "libuncross-core.a", "pkgconfig"})
        told = call("pkg-config", "--variable=libdir", "uncross", environment={"PKG_CONFIG_PATH": str(libraries / "pkgconfig")})
        self.assertEqual(told, "/usr/lib/machine-os\n")
        loaded = call("/usr/bin/python3", "-c", "import uncross._library as loaded; print(loaded.lib.uncross_interface())",
                      environment={"PYTHONPATH": str(destination / "usr/lib/python3/dist-packages"), "LD_LIBRARY_PATH": ""})
        self.assertEqual(loaded, "0\n")
        make("uninstall", "/usr", destination)
        self.assertEqual([path for path in destination.rglob("*") if not path.is_dir()], [])
        for bad in "/lib/machine-os", "/usr/a b", "/usr/../elsewhere":
            self.assertIn("LIBDIR is a folder below PREFIX", make("install", "/usr", destination, f"LIBDIR={bad}", code=2, show=True))

    def test_flags(self):
        """What is installed by itself is tied to no processor, and a newer compiler's warning does not end it; flags are taken as given."""
        told = call("make", "-n", "install", f"BUILD={self.folder}/other", "CPPFLAGS=-DA_WORD", "CFLAGS=-DANOTHER", "LDFLAGS=-Wl,-z,nodump",
                    unset=("MARCH", "WERROR"))
        compiled = re.findall(r"^.*-std=c11.* -c src/.*$", told, re.M)
        self.assertGreater(len(compiled), 200)
        for line in compiled:
            self.assertNotRegex(line, "-march=(?!x86-64 )|-Werror")
            self.assertRegex(line, "-DA_WORD.* -DANOTHER")
        linked = re.findall(r"^.* -shared .*$|^.*-o \S*/uncross$", told, re.M)
        self.assertEqual([("-Wl,-z,nodump" in line) for line in linked], [True, True])

    def test_uninstall_leaves_nothing(self):
        destination = self.folder / "stage"
        destination.mkdir()
        make("install", "/usr/local", destination)
        installed = sorted(p.relative_to(destination) for p in destination.rglob("*") if not p.is_dir())
        self.assertIn(pathlib.Path("usr/local/share/uncross/docs/scene.md"), installed)
        self.assertIn("prefix=/usr/local\n", (destination / "usr/local/lib/pkgconfig/uncross.pc").read_text())
        self.assertTrue(filecmp.cmp(destination / "usr/local/lib/libuncross.so", self.build / "lib/libuncross.so.0"))
        other = destination / "usr/local/bin/other"
        other.write_text("somebody else's\n")
        make("uninstall", "/usr/local", destination)
        self.assertEqual([p for p in destination.rglob("*") if not p.is_dir()], [other])
        shutil.rmtree(destination / "usr")
        make("install", "/usr/local", destination)
        make("uninstall", "/usr/local", destination)
        self.assertFalse(destination.exists() and list(destination.rglob("*")))

    def test_uninstall_removes_its_own_alone(self):
        """Folders that were there before, even if empty, stay; so do those that a careless shell would take for the prefix."""
        destination = self.folder / "kept of words"
        kept = [destination / name for name in ("usr/local/share/man/man1", "usr/local/bin", "usr/local/lib", "usr/local x")]
        for folder in kept:
            folder.mkdir(parents=True)
        other = self.folder / "kept"
        other.mkdir()
        (other / "file").write_text("somebody else's\n")
        before = sorted(self.folder.glob("kept*/**/*"))
        make("install", "/usr/local x/y", destination)
        make("install", "/usr/local", destination)
        call("/usr/bin/python3", "-c", "import uncross", environment={  # leaves __pycache__
            "PYTHONPATH": str(destination / "usr/local/lib/python3/dist-packages"), "LD_LIBRARY_PATH": str(destination / "usr/local/lib")})
        make("install", "/usr/local", destination)
        make("uninstall", "/usr/local", destination)
        make("uninstall", "/usr/local x/y", destination)
        self.assertEqual(sorted(self.folder.glob("kept*/**/*")), before)
        told = make("uninstall", "/usr/local", destination, code=2, show=True)
        self.assertIn("nothing of uncross is installed in", told)

    def test_hardened(self):
        """Program and library refuse what an overflow would do next: writing over tables of functions, over a return address."""
        for path in (self.prefix / "bin/uncross", self.prefix / "lib/libuncross.so"):
            read = call("readelf", "-hdlW", path)
            self.assertIn("GNU_RELRO", read)
            self.assertRegex(read, r"BIND_NOW|FLAGS_1.*NOW")
            self.assertRegex(read, r"GNU_STACK .* RW ")
            self.assertIn("DYN (", read)
            used = call("nm", "-D", "--undefined-only", path)
            self.assertIn("__stack_chk_fail", used)
            self.assertRegex(used, "__(vs|s)n?printf_chk")


if __name__ == "__main__":
    unittest.main()
