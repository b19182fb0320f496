"""The wiring table that a builder follows agrees with the facts that the firmware is made from.

usage: wiring_table_test.py BOARD_FACTS, the program that prints the facts
"""

import pathlib
import re
import subprocess
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
README = HERE.parents[2] / HERE.relative_to(HERE.parents[1]) / "README.md"

# STM32F405 data sheet, "STM32F40xxx pin definitions", LQFP64.
LQFP64 = {
    **{f"PA{n}": place for n, place in enumerate((14, 15, 16, 17, 20, 21, 22, 23, 41, 42, 43, 44, 45, 46, 49, 50))},
    **{f"PB{n}": place for n, place in
       enumerate((26, 27, 28, 55, 56, 57, 58, 59, 61, 62, 29, 30, 33, 34, 35, 36))},
    **{f"PC{n}": place for n, place in enumerate((8, 9, 10, 11, 24, 25, 37, 38, 39, 40, 51, 52, 53, 2, 3, 4))},
}

class WiringTable(unittest.TestCase):
    def setUp(self):
        lines = subprocess.run([board_facts], check=True, capture_output=True, text=True).stdout.splitlines()
        self.facts = {name: (pin, function, channel) for name, pin, function, channel in map(str.split, lines)}
        rows = re.findall(r"^\| [^|]+ \| `([^`]+)` \| (P[A-Z]\d+) \| (\d+) \| ([^|]+) \| ([^|]+) \|", README.read_text(),
                          re.MULTILINE)
        self.rows = {name: (pin, function.strip(), int(place), peripheral.strip())
                     for name, pin, place, peripheral, function in rows}

    def test_pins_and_functions_agree(self):
        facts = {name: (pin, function) for name, (pin, function, _) in self.facts.items()}
        self.assertEqual({name: row[:2] for name, row in self.rows.items()}, facts)

    def test_places_of_the_package_are_right(self):
        for name, (pin, _, place, _) in self.rows.items():
            self.assertEqual(place, LQFP64[pin], name)

    def test_timers_and_channels_agree(self):
        channels = {name: channel for name, (_, _, channel) in self.facts.items() if channel != "-"}
        self.assertEqual(len(channels), 12)
        self.assertEqual({name: self.rows[name][3] for name in channels}, channels)


if __name__ == "__main__":
    board_facts = sys.argv.pop()
    unittest.main()
