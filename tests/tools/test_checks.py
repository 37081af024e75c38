"""The checks of the house must be able to fail: each rule is broken once in a small tree made for it."""
import pathlib
import subprocess
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"

FILES = {
    "src/base/vec.h": "",
    "src/system/state.h": '#include "base/vec.h"\n',
    "src/mpc/flow.h": '#include "system/state.h"\n',
    "src/mpc/flow.c": '#include "mpc/flow.h"\n/* Padding 2009, Eqs. (1)-(20) and (22), (25). */\nvoid flow(void)\n{\n}\n',
    "src/fiber/bend.h": '#include "system/state.h"\n/* Padding 2009, Eq. (21). */\nstatic inline int bend(int x)\n{\n}\n',
    "src/fiber/bend.c": '#include "fiber/bend.h"\nint twist(int x)\n{\n  /* Padding 2009, Eqs. (23) and (24). */\n}\n',
    "src/step.h": "",
    "src/step.c": '#include "step.h"\n#include "fiber/bend.h"\n#include "mpc/flow.h"\n',
    "src/observe/mean.h": '#include "fiber/bend.h" /* Eq. (1) */\n',
    "src/files/file.h": "#include <hdf5.h>\n",
    "include/house.h": "#include <stddef.h>\n",
    "src/api/door.c": '#include "house.h"\n#include "files/file.h"\n',
    "src/cli/main.c": '#include "house.h"\n#include "files/file.h"\n#include "observe/mean.h"\n#include "step.h"\n',
    "docs/equations.tsv": "# comment\n" + "".join(
        f"{n}\t{'code' if n < 26 else 'later'}\tmeaning\t{'src/step.c' if n < 26 else '-'}\t-\n" for n in range(1, 44)),
}


class Tree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name, text in FILES.items():
            self.put(name, text)

    def put(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def add(self, name, text):
        self.put(name, (self.root / name).read_text() + text)

    def replace(self, name, old, new):
        text = (self.root / name).read_text()
        self.assertIn(old, text)
        self.put(name, text.replace(old, new, 1))

    def call(self, tool, *options):
        done = subprocess.run([TOOLS / tool, *options, self.root], capture_output=True, text=True, check=False)
        self.assertEqual(done.stderr, "")
        return done.returncode, done.stdout

    def assert_complains(self, tool, words):
        status, output = self.call(tool)
        self.assertEqual(status, 1, output)
        self.assertIn(words, output)


class Floors(Tree):
    def complain(self, words):
        self.assert_complains("check-floors", words)

    def test_accepts_the_house(self):
        status, output = self.call("check-floors")
        self.assertEqual(status, 0, output)

    def test_upward_include(self):
        self.add("src/system/state.h", '#include "step.h"\n')
        self.complain("src/system/state.h:2: system (floor 1) must not include step (floor 5)")

    def test_mpc_and_fiber_never_meet(self):
        self.add("src/mpc/flow.c", '  # include "fiber/bend.h"\n')
        self.complain("mpc (floor 3) must not include fiber (floor 3)")

    def test_fiber_and_mpc_never_meet(self):
        self.add("src/fiber/bend.h", '#include "mpc/flow.h"\n')
        self.complain("fiber (floor 3) must not include mpc (floor 3)")

    def test_angle_brackets_are_no_way_around(self):
        self.add("src/mpc/flow.c", "#include <fiber/bend.h>\n")
        self.complain('files of this project are included as "room/file.h"')

    def test_macro_is_no_way_around(self):
        self.add("src/mpc/flow.c", "#include BEND\n")
        self.complain("#include BEND")

    def test_unknown_room(self):
        self.put("src/attic/box.h", "")
        self.complain("room 'attic' has no floor")

    def test_missing_file(self):
        self.add("src/step.c", '#include "fiber/knot.h"\n')
        self.complain("there is no src/fiber/knot.h")

    def test_cycle(self):
        self.put("src/fiber/twist.h", '#include "fiber/bend.h"\n')
        self.add("src/fiber/bend.h", '#include "fiber/twist.h"\n')
        self.complain("include cycle: ")

    def test_unreachable_header(self):
        self.put("src/fiber/knot.h", "")
        self.complain("src/fiber/knot.h:1: not reachable")

    def test_unreachable_source(self):
        self.put("src/fiber/knot.c", '#include "system/state.h"\n')
        self.complain("src/fiber/knot.c:1: not reachable")

    def test_file_library_in_the_physics(self):
        self.add("src/observe/mean.h", "#include <hdf5.h>\n")
        self.complain("hdf5.h belongs to floor 8 and above")

    def test_test_library_in_the_program(self):
        self.add("src/cli/main.c", "#include <gsl/gsl_math.h>\n")
        self.complain("gsl/gsl_math.h must not be used in src/")

    def test_library_that_nobody_installs(self):
        self.add("src/cli/main.c", "#include <Random123/philox.h>\n")
        self.complain("Random123/philox.h is neither of the C library nor of a library that the program is built with")


    def test_public_header_inside(self):
        self.add("src/files/file.h", '#include "house.h"\n')
        self.complain("src/files/file.h:2: the public header house.h is for api, cli only")

    def test_public_header_that_knows_the_inside(self):
        self.add("include/house.h", '#include "step.h"\n')
        self.complain('include/house.h:2: #include "step.h": a public header includes the C library only')

    def test_api_is_reached_through_the_public_header(self):
        self.put("src/api/knob.h", "")
        self.complain("src/api/knob.h:1: not reachable")
        self.put("src/api/knob.c", '#include "api/knob.h"\n')
        self.complain("src/api/knob.c:1: not reachable")


class Equations(Tree):
    def setUp(self):
        super().setUp()
        self.assertEqual(self.call("check-equations", "--write")[0], 0)

    def complain(self, words):
        self.assert_complains("check-equations", words)

    def test_accepts_the_table(self):
        status, output = self.call("check-equations")
        self.assertEqual(status, 0, output)
        page = (self.root / "docs/equations.md").read_text()
        self.assertIn("| (20) | meaning | [`flow.c`](../src/mpc/flow.c)<br>`flow` |", page)
        self.assertIn("| (21) | meaning | [`bend.h`](../src/fiber/bend.h)<br>`bend` |", page)
        self.assertIn("| (24) | meaning | [`bend.c`](../src/fiber/bend.c)<br>`twist` |", page)

    def test_code_without_home(self):
        self.replace("src/fiber/bend.h", "Padding 2009, Eq. (21)", "Eq. (21)")
        self.complain("Eq. (21) is listed as code, but nothing in src/ is tagged with it")

    def test_two_homes(self):
        self.add("src/step.c", "/* Padding 2009, Eq. (7) */\n")
        self.complain("Eq. (7) has more than one home: src/mpc/flow.c:2, src/step.c:4")

    def test_tag_of_what_is_not_code(self):
        self.add("src/step.c", "/* Padding 2009, Eq. (29) */\n")
        self.complain("src/step.c:4: Eq. (29) is tagged here, but listed as later")

    def test_malformed_tag(self):
        self.add("src/step.c", "/* (Padding 2009, Eq. 3) */\n")
        self.complain("src/step.c:4: malformed tag")

    def test_equation_left_out(self):
        self.replace("docs/equations.tsv", "13\tcode", "#13\tcode")
        self.complain("Eq. (13) is missing")

    def test_equation_listed_twice(self):
        self.add("docs/equations.tsv", "43\tlater\tmeaning\t-\t-\n")
        self.complain("Eq. (43) is listed twice")

    def test_equation_that_the_paper_has_not(self):
        self.add("docs/equations.tsv", "44\tlater\tmeaning\t-\t-\n")
        self.complain("equation 44 is not one of (1)-(43)")

    def test_unknown_status(self):
        self.replace("docs/equations.tsv", "43\tlater", "43\tsoon")
        self.complain("status 'soon' is not one of")

    def test_code_without_test(self):
        self.replace("docs/equations.tsv", "3\tcode\tmeaning\tsrc/step.c", "3\tcode\tmeaning\t-")
        self.complain("Eq. (3) is listed as code, but no test or validation holds it")

    def test_test_that_is_not_there(self):
        self.replace("docs/equations.tsv", "src/step.c", "tests/none.c")
        self.complain("Eq. (1) names tests/none.c, which is not there")

    def test_case(self):
        (self.root / "validation/cases/tube").mkdir(parents=True)
        self.replace("docs/equations.tsv", "1\tcode\tmeaning\tsrc/step.c\t-", "1\tcode\tmeaning\tsrc/step.c\tvalidation/cases/tube")
        self.complain("Eq. (1) names a case without a page, docs/claims/tube.md")
        self.put("docs/claims/tube.md", "")
        self.assertEqual(self.call("check-equations", "--write")[0], 0)
        self.assertIn("<br>[tube](claims/tube.md) |", (self.root / "docs/equations.md").read_text())

    def test_stale_page(self):
        self.replace("docs/equations.tsv", "meaning", "another meaning")
        self.complain("docs/equations.md:1: out of date")


class Links(Tree):
    def call_links(self):
        done = subprocess.run([TOOLS / "check-links", "docs/page.md", "src/step.c"], cwd=self.root, capture_output=True,
                              text=True, check=False)
        return done.returncode, done.stdout

    def test_accepts_what_is_there(self):
        self.put("docs/page.md", "[table](equations.tsv) [part](page.md#a-part-of-it) [here](#two) [far](https://example.org/x#y)\n# A *part*, of [it](page.md)\n## Two\n")
        self.add("src/step.c", "/* see docs/equations.tsv */\n")
        self.assertEqual(self.call_links()[0], 0)

    def test_dangling_link(self):
        self.put("docs/page.md", "\n[table](table.md#part)\n")
        status, output = self.call_links()
        self.assertEqual(status, 1)
        self.assertIn("docs/page.md:2: there is no docs/table.md", output)

    def test_dangling_place(self):
        self.put("docs/page.md", "[a](page.md#part) [b](#other)\n# Part\n```\n# other\n```\n")
        status, output = self.call_links()
        self.assertEqual(status, 1)
        self.assertEqual(output.splitlines()[:-1], ["docs/page.md:1: there is no place #other in docs/page.md"])

    def test_dangling_mention(self):
        self.put("docs/page.md", "")
        self.add("src/step.c", "/* see docs/none.md */\n")
        status, output = self.call_links()
        self.assertEqual(status, 1)
        self.assertIn("src/step.c:4: there is no docs/none.md", output)


if __name__ == "__main__":
    unittest.main()
