"""What `make` says on machines that lack something, and what its targets install before they build."""
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]
# The Debian package of each library that programs of the Makefile are linked with.
PACKAGES = {"hdf5": "libhdf5-dev", "yaml": "libyaml-dev", "jansson": "libjansson-dev", "xxhash": "libxxhash-dev", "cmocka": "libcmocka-dev",
            "gsl": "libgsl-dev", "gslcblas": "libgsl-dev", "mpfr": "libmpfr-dev", "gmp": "libgmp-dev"}
SYSTEM_TOOLS = ("make", "bash", "sh", "find", "sort", "sed", "git", "mkdir", "ln", "printf", "touch", "rm", "cat", "head", "cmp", "mv", "mktemp", "dirname", "env", "cut", "tr", "uname")


def make(*words, environment=None):
    clean = {name: value for name, value in os.environ.items() if not name.startswith(("MAKE", "MFLAGS"))}
    done = subprocess.run(["make", *words], cwd=TOP, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
                          env={**clean, **(environment or {})})
    return done.returncode, done.stdout + done.stderr


class Lacking(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.build = f"BUILD={self.dir}/build"

    def tools(self, *names):
        """A PATH of nothing but these."""
        place = self.dir / "bin"
        place.mkdir()
        for name in names:
            (place / name).symlink_to(shutil.which(name))
        return {"PATH": str(place)}

    def said(self, *words, environment):
        """What make says, without its own line about the target; it must fail before it compiles, in one sentence or two."""
        status, output = make(*words, environment=environment)
        self.assertNotEqual(status, 0, output)
        lines = [line for line in output.splitlines() if not re.match(r"make(\[\d+\])?: ", line)]
        self.assertNotIn("No such file", output)
        self.assertNotIn("  CC ", output)
        self.assertLessEqual(len(lines), 3, output)
        return "\n".join(lines)

    def test_bare_machine(self):
        said = self.said("-j2", self.build, f"{self.dir}/build/uncross", environment=self.tools(*SYSTEM_TOOLS))
        self.assertIn("gcc, pkg-config, HDF5, libyaml, Jansson and xxHash are missing", said)
        self.assertRegex(said, "apt-get install .*gcc .*libhdf5-dev .*libxxhash-dev")

    def test_no_libraries(self):
        said = self.said("-j2", self.build, f"{self.dir}/build/uncross", environment={"PKG_CONFIG_LIBDIR": "/nowhere"})
        self.assertIn("HDF5, libyaml, Jansson and xxHash are missing", said)
        self.assertNotIn("gcc,", said)

    def test_one_library(self):
        """The headers are there, and one file of pkg-config is not."""
        place = self.dir / "pc"
        place.mkdir()
        found = subprocess.run(["pkg-config", "--variable", "pc_path", "pkg-config"], capture_output=True, text=True, check=True).stdout
        for folder in found.strip().split(":"):
            for path in pathlib.Path(folder).glob("*.pc"):
                if path.name != "jansson.pc" and not (place / path.name).exists():
                    (place / path.name).symlink_to(path)
        said = self.said("-j2", self.build, f"{self.dir}/build/uncross", environment={"PKG_CONFIG_LIBDIR": str(place)})
        self.assertIn(" Jansson is missing", said)

    def test_wrong_flags(self):
        said = self.said(self.build, "OPTIMIZE=-O1 --no-such-flag", f"{self.dir}/build/uncross", environment={})
        self.assertIn("--no-such-flag", said)
        self.assertNotIn("apt-get", said)

    def test_wrong_machine(self):
        for flags, words in (("-m32", "64-bit"), ("-mfpmath=387", "SSE2"), ("-ffast-math", "-ffast-math")):
            with self.subTest(flags):
                said = self.said(self.build, f"CFLAGS={flags}", f"{self.dir}/build/uncross", environment={})
                self.assertRegex(said, f"^uncross needs .*{words}")


class Machine(unittest.TestCase):
    """src/base/machine.h, which all of the physics includes, by compilers for other machines."""

    def test_targets(self):
        for target, words in (("x86_64-linux-gnu", None), ("aarch64-linux-gnu", None), ("riscv64-linux-gnu", None),
                              ("powerpc64-linux-gnu", "little-endian"), ("aarch64_be-linux-gnu", "little-endian"),
                              ("s390x-linux-gnu", "little-endian"), ("i686-linux-gnu", "64-bit"), ("armv7-linux-gnueabihf", "64-bit")):
            with self.subTest(target):
                done = subprocess.run(["clang", f"--target={target}", "-fsyntax-only", "-x", "c", "src/base/machine.h"], cwd=TOP, text=True,
                                      capture_output=True, check=False)
                self.assertEqual(done.returncode == 0, words is None, done.stderr)
                self.assertIn(words or "", done.stderr)

    def test_is_included_first(self):
        for name in ("vec3.h", "philox.h"):
            first = re.search(r'#include (.*)', (TOP / "src/base" / name).read_text())[1]
            self.assertEqual(first, '"base/machine.h"', name)


class Installed(unittest.TestCase):
    """`make -n` tells what a target would install and link where nothing has been built."""

    def test_what_is_linked_is_installed(self):
        for target in ("demo", "check", "stress", "validate", "campaign", "measure", "bench", "peer", "bench-rivals", "bench-error"):
            with self.subTest(target), tempfile.TemporaryDirectory() as folder:
                _, told = make("-n", "-k", f"BUILD={folder}/build", target)
                asked = " ".join(re.findall(r"tools/install-dependencies (.*)", told)).split()
                self.assertTrue(asked, f"make {target} installs nothing")
                have = subprocess.run(["tools/install-dependencies", "--list", *asked], cwd=TOP, capture_output=True, text=True,
                                      check=True).stdout.split()
                linked = {PACKAGES[name] for name in re.findall(r" -l(\w+)", told) if name in PACKAGES}
                self.assertIn("libhdf5-dev", linked)
                self.assertFalse(linked - set(have), f"make {target} links these, and does not install them")


if __name__ == "__main__":
    unittest.main()
