"""The law of docs/force-laws.md compiles, and what is wrong with a law is said in one sentence.

    law_check_test.py REPOSITORY GENERATED
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

REPOSITORY, GENERATED = map(pathlib.Path, sys.argv[1:3])
LAW = re.search(r"```cpp\n(.*?)```", (REPOSITORY / "docs/force-laws.md").read_text(), re.DOTALL)[1]
FLAGS = ["-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard", "-std=c++20", "-fno-exceptions",
         "-fno-rtti", "-fsyntax-only", "-Wall", "-Wextra", "-Wconversion", "-Wdouble-promotion", "-Werror",
         "-Wno-unused-parameter"]


def compile_law(law: str, name: str = "well") -> subprocess.CompletedProcess:
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / f"{name}.hpp"
        file.write_text(law)
        return subprocess.run(
            ["arm-none-eabi-g++", *FLAGS, f'-DINKWELL_FORCE_LAW_FILE="{file}"', f"-DINKWELL_FORCE_LAW={name}",
             f"-I{REPOSITORY}", f"-I{REPOSITORY}/firmware/force_laws/include", f"-I{GENERATED}",
             REPOSITORY / "firmware/control/signal_path/installed_force_law.cpp"],
            capture_output=True, text=True, check=False)


class LawCheck(unittest.TestCase):
    def assert_refused(self, old: str, new: str, sentence: str, name: str = "well") -> None:
        self.assertIn(old, LAW)
        result = compile_law(LAW.replace(old, new), name)
        self.assertEqual(result.returncode, 1, result.stderr)
        errors = re.findall(r"error: (.*)", result.stderr)
        self.assertEqual(len(errors), 1, result.stderr)
        self.assertIn(sentence, errors[0])

    def test_the_law_of_the_page_compiles(self):
        result = compile_law(LAW)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_struct_of_another_name(self):
        self.assert_refused("struct well", "struct other", "must define a struct named like the file")

    def test_another_signature(self):
        self.assert_refused("  static Vector3 force_N(const Probe& probe, const Parameters& parameters, State&,",
                            "  static Vector3 force_N(const Probe& probe, const Parameters& parameters,",
                            "the force law lacks its function: static Vector3 force_N(const Probe&, const Parameters&,")

    def test_a_law_without_a_description_is_refused(self):
        self.assert_refused("std::string_view help", "std::string_view about", "lacks a sentence on what it is")

    def test_a_member_without_a_row(self):
        self.assert_refused("float depth_m;", "float depth_m, more_m;", "each member of the force law's Signals must be a")

    def test_a_name_that_is_taken(self):
        self.assert_refused('"well_depth_m"', '"force_x_N"', "and no other signal has them")

    def test_a_default_out_of_range(self):
        self.assert_refused("0, 500, 100", "0, 50, 100", "is outside of its range")

    def test_a_large_state(self):
        self.assert_refused("struct State {};", "struct State { float all[100]; };", "no larger than ForceLawMemory::state_bytes")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
