"""The first instructions of the firmware use no stack before the clock of the stack's memory is enabled.

    start_test.py ELF
"""

import re
import subprocess
import sys
import unittest

CLOCKS = 0x40023830  # RCC_AHB1ENR
CORE_COUPLED_MEMORY = 1 << 20  # CCMDATARAMEN


class Start(unittest.TestCase):
    image = ""

    def test_the_stack_has_its_clock_before_it_is_used(self):
        text = subprocess.run(["arm-none-eabi-objdump", "-d", "--no-show-raw-insn", "--disassemble=reset_handler", self.image],
                              check=True, capture_output=True, text=True).stdout
        lines = re.findall(r"^\s*[0-9a-f]+:\s+(\S+)\s*(.*?)\s*$", text, re.MULTILINE)
        code = [line for line in lines if line[0] != ".word"]
        words = [int(operand.split()[0], 16) for name, operand in lines if name == ".word"]
        self.assertEqual(CLOCKS, words[0])
        names = [name.removesuffix(".w").removesuffix(".n") for name, _ in code]
        self.assertEqual(["ldr", "ldr", "orr", "str", "ldr"], names[:5], text)
        self.assertIn(f"#{CORE_COUPLED_MEMORY}", code[2][1])
        for name, operand in code[:5]:
            self.assertNotRegex(f"{name} {operand}", r"push|\bsp\b|stmdb|bl")


if __name__ == "__main__":
    Start.image = sys.argv[1]
    unittest.main(argv=sys.argv[:1])
