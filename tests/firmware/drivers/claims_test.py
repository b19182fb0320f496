"""Two drivers of the same timer, pin, DMA stream or interrupt line do not compile. A driver that uses an unclaimed
resource, or that is not in the list of parts, does not compile either.

    claims_test.py INCLUDE_DIRECTORY...
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
COMPILER = ["arm-none-eabi-g++", "-std=c++20", "-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard",
            "-fno-exceptions", "-fno-rtti", "-I", REPOSITORY / "firmware/application"]

HEADERS = """
#include "firmware/application/parts.hpp"
#include "firmware/drivers/interrupts.hpp"
#include "firmware/drivers/peripheral_clocks.hpp"
"""
FRAME = """
using namespace inkwell;
using namespace inkwell::drivers;
using inkwell::drivers::pin;

struct Newcomer {
  static constexpr std::array claims{%s};
  void start() { %s }
};

template <class Parts> struct WithNewcomer;
template <class... Parts> struct WithNewcomer<PartsList<Parts...>> : PartsList<Parts..., Newcomer> {};
WithNewcomer<application::Parts> all;
Newcomer newcomer;
"""
FREE_PIN = "pin(board::Pin{'C', 13})"
TAKEN = "static assertion failed: two drivers claim the same peripheral, pin, DMA stream or interrupt line"
UNCLAIMED = "static assertion failed: a driver uses what it does not claim"


class Claims(unittest.TestCase):
    includes: list[str] = []
    command: list[str | pathlib.Path]

    @classmethod
    def setUpClass(cls):
        """Compiles the headers once for all tests."""
        folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        compiler = [*COMPILER, *(part for directory in cls.includes for part in ("-I", directory))]
        headers = folder / "headers.hpp"
        headers.write_text(HEADERS)
        subprocess.run([*compiler, "-x", "c++-header", headers], check=True)
        cls.command = [*compiler, "-fsyntax-only", "-Winvalid-pch", "-include", headers, "-x", "c++", "-"]

    def compile(self, claims: str, start: str = "", more: str = "") -> str:
        """Returns the error message of the compiler; empty if the source compiles."""
        result = subprocess.run(self.command, input=FRAME % (claims, start) + more, capture_output=True, text=True,
                                check=False)
        self.assertEqual(result.returncode != 0, "error" in result.stderr, result.stderr)
        return result.stderr

    def assert_refused(self, complaint: str, *sentences: str) -> None:
        for sentence in sentences:
            self.assertIn(sentence, complaint)

    def test_a_driver_of_unclaimed_hardware_compiles(self):
        start = "DigitalOutput<Newcomer, board::Pin{'C', 13}>::start(); start_clock_of_stream<Newcomer, registers::DMA2, 1>();" \
                "RegistersOfStream<Newcomer, registers::DMA2, 1>::LISR::read();"
        self.assertEqual("", self.compile(f"{FREE_PIN}, stream<registers::DMA2, 1>()", start))

    def test_a_second_user_is_refused(self):
        for claim, owner in (("peripheral<registers::TIM1>()", "Bridges"),
                             ("peripheral<registers::TIM3>()", "Encoders"),
                             ("peripheral<registers::ADC2>()", "AnalogInputs"),
                             ("peripheral<registers::USART2>()", "Console"),
                             ("pin(board::facts.bridge_enable)", "Bridges"),
                             ("pin(board::facts.gimbal[1])", "AnalogInputs"),
                             ("pin(board::Pin{'C', 10})", "StatusLed"),
                             ("stream<registers::DMA2, 0>()", "AnalogInputs"),
                             ("interrupt(Interrupt::analog_converters)", "AnalogInputs")):
            with self.subTest(claim):
                self.assert_refused(self.compile(f"{FREE_PIN}, {claim}"), TAKEN,
                                    f"Disjoint<inkwell::drivers::{owner}, Newcomer>")

    def test_a_driver_cannot_use_unclaimed_hardware(self):
        for start in ("RegistersOf<Newcomer, registers::TIM3>::CNT::read();",
                      "RegistersOfStream<Newcomer, registers::DMA2, 1>::LISR::read();",
                      "start_clocks_of<Newcomer, registers::TIM3>();",
                      "start_clock_of_stream<Newcomer, registers::DMA2, 1>();",
                      "InterruptLine<Newcomer, Interrupt::analog_converters>::enable();",
                      "connect<Newcomer, board::facts.usb_plus>(Pull::none, Speed::low);",
                      "connect_analog<Newcomer, board::facts.supply>();",
                      "DigitalInput<Newcomer, board::facts.button_1>::start(Pull::up);",
                      "DigitalOutput<Newcomer, board::facts.status_led>::start();"):
            with self.subTest(start):
                self.assert_refused(self.compile(FREE_PIN, start), UNCLAIMED)

    def test_the_claim_names_give_no_access_to_registers(self):
        self.assert_refused(self.compile(FREE_PIN, "registers::TIM3::CNT::read();"),
                            "registers::TIM3::CNT", "has not been declared")

    def test_a_driver_that_is_not_in_the_list_is_no_part(self):
        self.assert_refused(self.compile(FREE_PIN, more="application::Part<Newcomer> part;"),
                            "template constraint failure", "with Driver = Newcomer")
        self.assertEqual("", self.compile(FREE_PIN, more="extern application::Part<StatusLed> part;"))


if __name__ == "__main__":
    Claims.includes = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
