"""The wiring table that a builder follows agrees with the facts that the firmware is made from."""

import pathlib
import re
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
BOARD = REPOSITORY / "boards/omni_driver"

# STM32F405 data sheet, "STM32F40xxx pin definitions", LQFP64.
LQFP64 = {
    **{f"PA{n}": place for n, place in enumerate((14, 15, 16, 17, 20, 21, 22, 23, 41, 42, 43, 44, 45, 46, 49, 50))},
    **{f"PB{n}": place for n, place in
       enumerate((26, 27, 28, 55, 56, 57, 58, 59, 61, 62, 29, 30, 33, 34, 35, 36))},
    **{f"PC{n}": place for n, place in enumerate((8, 9, 10, 11, 24, 25, 37, 38, 39, 40, 51, 52, 53, 2, 3, 4))},
}

PIN = r"\{'([A-Z])', (\d+)\}"


def fact(pin: re.Match | tuple, function: str) -> tuple[str, str]:
    return f"P{pin[0]}{pin[1]}", function


def facts_of(header: str) -> dict[str, tuple[str, str]]:
    """Name of each pin's fact -> pin and alternate function or ADC channel."""
    facts = {}
    for name, port, number in re.findall(rf"constexpr Pin (\w+){PIN};", header):
        facts[name] = fact((port, number), "-")
    for name, port, number, function in re.findall(rf"constexpr PeripheralPin (\w+)\{{{PIN}, (\d+)\}};", header):
        facts[name] = fact((port, number), f"AF{function}")
    for name, port, number, channel in re.findall(rf"constexpr AnalogInput (\w+)\{{{PIN}, (\d+)\}};", header):
        facts[name] = fact((port, number), f"IN{channel}")
    for name, rows in re.findall(r"constexpr AnalogInput (\w+)\[3\] = \{(.*?)\};", header, re.DOTALL):
        for index, (port, number, channel) in enumerate(re.findall(rf"{PIN}, (\d+)", rows)):
            facts[f"{name}[{index}]"] = fact((port, number), f"IN{channel}")
    for name, members in (("encoders", ("a", "b")), ("bridges", ("leg_a", "leg_b"))):
        rows = re.search(rf"constexpr \w+ {name}\[3\] = \{{(.*?)\}};\n", header, re.DOTALL)[1]
        for place, (port, number, function) in enumerate(re.findall(rf"{PIN}, (\d+)", rows)):
            facts[f"{name}[{place // 2}].{members[place % 2]}"] = fact((port, number), f"AF{function}")
    return facts


class WiringTable(unittest.TestCase):
    def setUp(self):
        self.facts = facts_of((BOARD / "include/board/omni_driver.hpp").read_text())
        readme = (BOARD / "README.md").read_text()
        rows = re.findall(r"^\| [^|]+ \| `([^`]+)` \| (P[A-Z]\d+) \| (\d+) \| ([^|]+) \| ([^|]+) \|", readme, re.MULTILINE)
        self.rows = {name: (pin, function.strip(), int(place), peripheral.strip())
                     for name, pin, place, peripheral, function in rows}

    def test_every_fact_is_read(self):
        self.assertEqual(len(self.facts), 32)

    def test_pins_and_functions_agree(self):
        self.assertEqual({name: row[:2] for name, row in self.rows.items()}, self.facts)

    def test_places_of_the_package_are_right(self):
        for name, (pin, _, place, _) in self.rows.items():
            self.assertEqual(place, LQFP64[pin], name)

    def test_timers_and_channels_agree(self):
        header = (BOARD / "include/board/omni_driver.hpp").read_text()
        encoders = re.search(r"encoders\[3\] = \{(.*?)\};\n", header, re.DOTALL)[1]
        for index, timer in enumerate(re.findall(r"^    \{(\d+), ", encoders, re.MULTILINE)):
            self.assertEqual(self.rows[f"encoders[{index}].a"][3], f"TIM{timer}_CH1")
            self.assertEqual(self.rows[f"encoders[{index}].b"][3], f"TIM{timer}_CH2")
        bridges = re.search(r"bridges\[3\] = \{(.*?)\};\n", header, re.DOTALL)[1]
        for index, channel in enumerate(re.findall(r"^    \{(\d+), ", bridges, re.MULTILINE)):
            self.assertEqual(self.rows[f"bridges[{index}].leg_a"][3], f"TIM1_CH{channel}")
            self.assertEqual(self.rows[f"bridges[{index}].leg_b"][3], f"TIM8_CH{channel}")


if __name__ == "__main__":
    unittest.main()
