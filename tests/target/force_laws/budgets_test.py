"""Complete images of force laws: their use of both budgets, and the figures of docs/force-laws.md.

    budgets_test.py REPOSITORY COMPILER_VERSION IMAGE...

The page states the figures of GCC 12. With another compiler, the test checks only the budgets.
"""

import pathlib
import re
import subprocess
import sys
import unittest

REPOSITORY, COMPILER_VERSION = pathlib.Path(sys.argv[1]), sys.argv[2]
IMAGES = {pathlib.Path(image).stem: image for image in sys.argv[3:]}
PAGE = (REPOSITORY / "docs/force-laws.md").read_text(encoding="utf-8")


def output_of(tool: str, image: str) -> str:
    return subprocess.run([sys.executable, REPOSITORY / "tools/check" / tool, image], capture_output=True, text=True,
                          check=True).stdout


def budgets(image: str) -> tuple[str, str]:
    """The two lines of the build about a force law."""
    return tuple(next(line for line in output_of(tool, image).splitlines() if line.startswith("force law: "))
                 for tool in ("force_law_cost.py", "check_image.py"))


class Budgets(unittest.TestCase):
    def test_at_most_60_percent_of_at_least_32_KB_hold_the_default_image(self):
        used, room = map(int, re.search(r"interrupt code (\d+) of (\d+) bytes", output_of("check_image.py", IMAGES["inkwell"])).groups())
        self.assertGreaterEqual(room, 32 * 1024)
        self.assertLessEqual(used, 0.6 * room)

    def test_the_page_states_the_figures_of_each_law(self):
        self.assertGreaterEqual(len(IMAGES), 7)
        for name, image in IMAGES.items():
            cycles, code = budgets(image)
            figures = re.search(r"at most (\d+) of", cycles)[1], re.search(r": (\d+) of", code)[1]
            law = "box" if name == "inkwell" else name
            if not COMPILER_VERSION.startswith("12."):
                continue
            if law == "well":  # the page prints these lines
                self.assertIn(f"    {cycles}\n    {code}\n", PAGE)
            elif law not in ("quotient", "largest"):  # laws of the tests
                self.assertRegex(PAGE, rf"\| \[`{law}`\]\([^)]*\) \| [^|]* \| {figures[0]} \| {figures[1]} \|", f"{law} {figures}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
