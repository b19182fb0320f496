"""The wiring table for builders agrees with the board facts that the firmware is built from.

usage: wiring_table_test.py BOARD_FACTS BOARD, the program that prints the facts and the board's name
"""

import pathlib
import re
import subprocess
import sys
import unittest

BOARDS = pathlib.Path(__file__).resolve().parents[3] / "boards"

# STM32F405 data sheet, "STM32F40xxx pin definitions", LQFP64.
LQFP64 = {
    **{f"PA{n}": position for n, position in enumerate((14, 15, 16, 17, 20, 21, 22, 23, 41, 42, 43, 44, 45, 46, 49, 50))},
    **{f"PB{n}": position for n, position in
       enumerate((26, 27, 28, 55, 56, 57, 58, 59, 61, 62, 29, 30, 33, 34, 35, 36))},
    **{f"PC{n}": position for n, position in enumerate((8, 9, 10, 11, 24, 25, 37, 38, 39, 40, 51, 52, 53, 2, 3, 4))},
}

# Pins of connectors J2 and J3 in pairs (STM32World/hardware, mcustm32f405).
HEADERS = {
    "J2": "- - - - PC1 PC0 PC3 PC2 PA1 PA0 PA3 PA2 PA5 PA4 PA7 PA6 PC5 PC4 PB1 PB0 - PB2 PB11 PB10 PB13 PB12 PB15 PB14 PC7 "
          "PC6 PC9 PC8",
    "J3": "- - - - - - - - PA9 PA8 PA11 PA10 PA13 PA12 PA15 PA14 - - PC11 PC10 - PC12 PB3 PD2 PB5 PB4 PB7 PB6 PB9 PB8 - - "
          "PC13 PC14 PC15",
}
MODULE = {pin: f"{header}.{position}" for header, pins in HEADERS.items() for position, pin in enumerate(pins.split(), 1)}

# Position of each pin in a wiring table.
POSITIONS = {"omni_driver": LQFP64, "bench_modules": MODULE}


class WiringTable(unittest.TestCase):
    def setUp(self):
        lines = subprocess.run([board_facts, board], check=True, capture_output=True, text=True).stdout.splitlines()
        self.facts = {name: (pin, function, channel) for name, pin, function, channel in map(str.split, lines)}
        rows = re.findall(r"^\| [^|]+ \| `([^`]+)` \| (P[A-Z]\d+) \| ([\w.]+) \| ([^|]+) \| ([^|]+) \|", (BOARDS / board / "README.md").read_text(),
                          re.MULTILINE)
        self.rows = {name: (pin, function.strip(), position, peripheral.strip())
                     for name, pin, position, peripheral, function in rows}

    def test_pins_and_functions_agree(self):
        facts = {name: (pin, function) for name, (pin, function, _) in self.facts.items()}
        self.assertEqual({name: row[:2] for name, row in self.rows.items()}, facts)

    def test_positions_of_the_pins_are_right(self):
        for name, (pin, _, position, _) in self.rows.items():
            self.assertEqual(position, str(POSITIONS[board][pin]), name)

    def test_timers_and_channels_agree(self):
        channels = {name: channel for name, (_, _, channel) in self.facts.items() if channel != "-"}
        self.assertEqual(len(channels), 12)
        self.assertEqual({name: self.rows[name][3] for name in channels}, channels)


if __name__ == "__main__":
    board = sys.argv.pop()
    board_facts = sys.argv.pop()
    unittest.main()
