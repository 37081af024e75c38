"""The shared library has the binary interface of include/uncross.abi, and a change of it is seen and named.

Needs BUILD, with the libraries in it, compiled with -g; and abigail-tools (tools/install-dependencies packages), else it is skipped.
"""
import contextlib
import io
import pathlib
import re
import shutil
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import BUILD, TOP, FolderTest, load  # noqa: E402

HEADER = (TOP / "include/uncross.h").read_text()
NUMBER = re.search(r"#define UNCROSS_INTERFACE (\d+)", HEADER)[1]
LIBRARY = BUILD / f"lib/libuncross.so.{NUMBER}"


def found(pattern, path):
    return re.search(pattern, (TOP / path).read_text(), re.M)[1]


class Numbers(unittest.TestCase):
    def test_one_number(self):
        """The interface's number is in the header; the names of the library, of its symbols and of its package follow it."""
        self.assertEqual(found(r"^UNCROSS_(\d+) \{", "src/api/symbols.map"), NUMBER)
        self.assertEqual(found(r"^Package: libuncross(\d+)$", "packaging/debian/control"), NUMBER)
        self.assertEqual(found(r"^libuncross\.so\.(\d+) ", "packaging/debian/libuncross0.symbols"), NUMBER)
        self.assertEqual(found(r"\(symver\)UNCROSS_(\d+) ", "packaging/debian/libuncross0.symbols"), NUMBER)


@unittest.skipUnless(shutil.which("abidiff"), "abigail-tools is not installed")
class Abi(FolderTest):
    def check(self, change=lambda text: text, act="check"):
        """What tools/abi says, if the description that is kept were another one: (complaint, or None; what it printed)."""
        abi = load(TOP / "tools/abi")
        before = abi.KEPT.read_text()
        text = change(before)
        abi.KEPT = self.dir / "kept.abi"
        abi.KEPT.write_text(text)
        told = io.StringIO()
        try:
            with contextlib.redirect_stdout(told):
                abi.main(act, LIBRARY)
        except SystemExit as end:
            return str(end), told.getvalue()
        return None, told.getvalue()

    def without(self, name):
        """The description without this function."""
        def change(text):
            return re.sub(rf" *<function-decl name='{name}'.*?</function-decl>\n|<elf-symbol name='{name}'.*?/>\n", "", text, flags=re.S)
        return change

    def test_the_same(self):
        complaint, told = self.check()
        self.assertIsNone(complaint, told)

    def test_a_parameter_of_another_type(self):
        """uncross_sim_advance(sim, steps, error) with the steps as another type."""
        def change(text):
            function = re.search(r"<function-decl name='uncross_sim_advance'.*?</function-decl>", text, re.S)[0]
            types = re.findall(r"<parameter type-id='([^']*)'", function)
            self.assertEqual(len(types), 3, function)
            return text.replace(function, function.replace(f"type-id='{types[1]}'", f"type-id='{types[2]}'"))
        for act in "check", "write":
            complaint, told = self.check(change, act)
            self.assertIn("raise UNCROSS_INTERFACE above", complaint)
            self.assertIn("uncross_sim_advance", told)

    def test_a_field_of_a_struct_of_the_caller(self):
        complaint, told = self.check(lambda text: text.replace("<class-decl name='uncross_error' size-in-bits='8512'",
                                                               "<class-decl name='uncross_error' size-in-bits='8448'"))
        self.assertIsNotNone(complaint)
        self.assertIn("uncross_error", told)

    def test_a_field_at_the_end_of_what_the_library_allocates(self):
        """uncross_view without its last field: new ones may come there under one number."""
        def change(text):
            kind = re.search(r"<class-decl name='uncross_view' size-in-bits='(\d+)'.*?</class-decl>", text, re.S)
            fields = re.findall(r" *<data-member .*?</data-member>\n", kind[0], re.S)
            last = re.search(r"layout-offset-in-bits='(\d+)'", fields[-1])[1]
            self.assertGreaterEqual(int(kind[1]) - int(last), 64)
            return text.replace(kind[0], kind[0].replace(fields[-1], "").replace(kind[1], last, 1))
        complaint, told = self.check(change, "write")
        self.assertIn("raise UNCROSS_INTERFACE_AGE above", complaint)
        self.assertIn("uncross_view", told)

    def test_a_function_that_is_new(self):
        complaint, told = self.check(self.without("uncross_sim_hash"), "write")
        self.assertIn("raise UNCROSS_INTERFACE_AGE above", complaint)
        self.assertIn("uncross_sim_hash", told)

    def test_a_function_that_is_gone(self):
        complaint, told = self.check(lambda text: text.replace("uncross_sim_hash", "uncross_sim_bash"))
        self.assertIn("raise UNCROSS_INTERFACE above", complaint)
        self.assertIn("uncross_sim_bash", told)

    def test_an_age_that_is_not_written_down(self):
        complaint, _ = self.check(lambda text: text.replace("UNCROSS_INTERFACE_AGE 0", "UNCROSS_INTERFACE_AGE 1"))
        self.assertIn("tools/abi write", complaint)


if __name__ == "__main__":
    unittest.main()
