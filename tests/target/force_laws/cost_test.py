"""The price of the force laws, and what tools/check/force_law_cost.py refuses.

    cost_test.py REPOSITORY IMAGE...
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(sys.argv[1])
IMAGES = sys.argv[2:]
TOOL = REPOSITORY / "tools/check/force_law_cost.py"
CORE = ["-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard"]


def cost(elf: str) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, TOOL, elf], capture_output=True, text=True, check=False)


class Laws(unittest.TestCase):
    def test_each_law_of_the_tree_fits(self):
        self.assertGreaterEqual(len(IMAGES), 5)
        for image in IMAGES:
            result = cost(image)
            self.assertEqual(result.returncode, 0, image + result.stdout + result.stderr)
            print(pathlib.Path(image).stem, result.stdout.strip(), file=sys.stderr)


class Refusals(unittest.TestCase):
    def price(self, source: str) -> subprocess.CompletedProcess:
        """What the tool says of an image whose law has this body; `x` is its input."""
        with tempfile.TemporaryDirectory() as folder:
            file, elf = pathlib.Path(folder) / "law.cpp", str(pathlib.Path(folder) / "law.elf")
            file.write_text(source)
            subprocess.run(["arm-none-eabi-g++", "-std=c++20", "-O2", "-g", *CORE, "-fno-exceptions", "-nostartfiles",
                            "-Wl,-e,0", file, "-o", elf], check=True, capture_output=True)
            return cost(elf)

    def cycles(self, source: str) -> int:
        result = self.price(source)
        self.assertEqual(result.returncode, 0, result.stderr)
        return int(re.search(r"at most (\d+) of", result.stdout)[1])

    def assert_refused(self, result: subprocess.CompletedProcess, sentence: str) -> None:
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn(sentence, result.stderr)

    def test_a_division_is_priced(self):
        plain = self.cycles('extern "C" float step_force_law(float x) { return x * 2.0f; }')
        division = self.cycles('extern "C" float step_force_law(float x) { return 2.0f / x; }')
        self.assertGreaterEqual(division - plain, 10)

    def test_each_call_of_a_function_is_priced(self):
        other = "[[gnu::noipa]] float other(float x) { return x / 3.1f; }\n"
        once = self.cycles(other + 'extern "C" float step_force_law(float x) { return 1.0f + other(x); }')
        twice = self.cycles(other + 'extern "C" float step_force_law(float x) { return other(x) + other(1.0f); }')
        self.assertGreaterEqual(twice - once, 18)

    def test_the_dearer_branch_counts(self):
        cheap = self.cycles('extern "C" float step_force_law(float x) { return x; }')
        dear = self.cycles('extern "C" float step_force_law(float x) { if (x > 1.0f) return x; return x / 3 / x / x; }')
        self.assertGreaterEqual(dear - cheap, 42)

    def test_too_much_is_refused_with_the_figure_and_the_budget(self):
        divisions = " ".join(f"x = {i}.5f / x;" for i in range(120))
        result = self.price(f'extern "C" float step_force_law(float x) {{ {divisions} return x; }}')
        self.assert_refused(result, "the force law may take ")
        self.assertRegex(result.stderr, r"may take \d+ cycles in a control period, but only 800 are left for it\.")

    def test_a_loop_without_a_known_count_is_refused_with_its_location(self):
        result = self.price('extern "C" float step_force_law(float x, int n) {\n'
                            "  for (int i = 0; i < n; ++i)\n    x = 1.0f / x;\n  return x;\n}")
        self.assert_refused(result, "of which the compiler does not know how often it runs")
        self.assertRegex(result.stderr, r"law\.cpp:[1-4] ")

    def test_recursion_is_refused(self):
        result = self.price("[[gnu::noipa]] float other(float x);\n"
                            'extern "C" float step_force_law(float x) { return 1.0f + other(x); }\n'
                            "float other(float x) { return x < 1.0f ? x : 2.0f + step_force_law(x - 1.0f); }\n".replace(
                                "float other(float x);", "float other(float x);\nextern \"C\" float step_force_law(float x);"))
        self.assert_refused(result, "the force law calls itself")

    def test_an_image_without_a_law_is_refused(self):
        self.assert_refused(self.price("int other() { return 1; }"), "has no function step_force_law")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
