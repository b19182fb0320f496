"""libinkwell exports exactly the functions of inkwell.h, and each function is named in the version script.

    symbols_test.py LIBRARY_FOLDER LIBRARY
"""
import pathlib
import re
import subprocess
import sys
import unittest

FOLDER, LIBRARY = pathlib.Path(sys.argv[1]), sys.argv[2]


class Symbols(unittest.TestCase):
    def setUp(self):
        self.declared = re.findall(r"INKWELL_API[^;]*?\b(inkwell_\w+)\(", (FOLDER / "include/inkwell/inkwell.h").read_text())

    def test_version_script_names_each_function_once(self):
        script = (FOLDER / "inkwell.map").read_text()
        self.assertEqual(["local: *"], re.findall(r"\w+: \*|\w+\*", script), "a wildcard exports forgotten functions")
        self.assertEqual(sorted(self.declared), sorted(re.findall(r"\b(inkwell_\w+);", script)))

    def test_exports_are_the_declared_functions(self):
        lines = subprocess.run(["nm", "-D", "--defined-only", LIBRARY], capture_output=True, text=True,
                               check=True).stdout.splitlines()
        names = {line.split()[-1] for line in lines if line.split()[-2] != "A"}
        self.assertEqual(set(self.declared), {name.split("@")[0] for name in names})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
