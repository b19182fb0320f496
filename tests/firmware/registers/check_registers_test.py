"""The register maps' checker finds what is wrong, with maps and an SVD of a made-up peripheral."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOOL = pathlib.Path(__file__).resolve().parents[3] / "tools/check/check_registers.py"

SOURCE = """
#include "firmware/registers/register.hpp"
namespace inkwell::registers {
template <std::uint32_t base>
struct Lamp {
  struct CR : Register<base + 0x00> {
    using ON = Field<CR, 0, 1>;
    using COLOUR = Field<CR, 4, 3>;  ///< in the SVD as three bits
  };
  struct SR : Register<base + 0x04> {};
  struct CHANNEL : RegisterArray<base + 0x10, 0x08, 2> {
    using LEVEL = Field<CHANNEL, 8, 8>;
  };
};
using LAMP = Lamp<0x40001000>;
using LAMP2 = Lamp<0x40002000>;
template struct Lamp<0x40001000>;
template struct Lamp<0x40002000>;
struct Peripherals {
  using LAMP = registers::LAMP;
  using LAMP2 = registers::LAMP2;
} peripherals;
}  // namespace inkwell::registers
"""

SVD = """<?xml version="1.0"?>
<device><peripherals>
  <peripheral><name>LAMP</name><baseAddress>0x40001000</baseAddress><registers>
    <register><name>CR</name><addressOffset>0x0</addressOffset><fields>
      <field><name>ON</name><bitOffset>0</bitOffset><bitWidth>1</bitWidth></field>
      <field><name>COLOUR0</name><bitOffset>4</bitOffset><bitWidth>1</bitWidth></field>
      <field><name>COLOUR1</name><lsb>5</lsb><msb>5</msb></field>
      <field><name>COLOUR2</name><bitRange>[6:6]</bitRange></field>
    </fields></register>
    <register><name>SR</name><addressOffset>0x4</addressOffset></register>
    <register><name>CHANNEL0</name><addressOffset>0x10</addressOffset><fields>
      <field><name>LEVEL</name><bitRange>[15:8]</bitRange></field></fields></register>
    <register><name>CHANNEL1</name><addressOffset>0x18</addressOffset><fields>
      <field><name>LEVEL</name><lsb>8</lsb><msb>15</msb></field></fields></register>
  </registers></peripheral>
  <peripheral derivedFrom="LAMP"><name>LAMP2</name><baseAddress>0x40002000</baseAddress></peripheral>
  <peripheral><name>LAMP3</name><baseAddress>0x40003000</baseAddress><registers>
    <register><name>CR</name><addressOffset>0x0</addressOffset><fields>
      <field><name>ON</name><bitOffset>0</bitOffset><bitWidth>1</bitWidth></field>
    </fields></register>
  </registers></peripheral>
</peripherals></device>
"""


def lamp(name: str, base: int) -> dict:
    """As print-chip-registers prints it."""
    fields = [{"name": "ON", "position": 0, "width": 1}, {"name": "COLOUR", "position": 4, "width": 3}]
    registers = [{"name": "CR", "offset": 0, "fields": fields}, {"name": "SR", "offset": 4, "fields": []}]
    return {"name": name, "base": base, "registers": registers}


class CheckRegisters(unittest.TestCase):
    def run_tool(self, source: str | None = SOURCE, chip=None, svd: str = SVD) -> subprocess.CompletedProcess:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "chip.svd").write_text(svd)
            command = [sys.executable, str(TOOL), str(folder / "chip.svd")]
            if source is not None:
                (folder / "map.cpp").write_text(source)
                compiler = [os.environ["INKWELL_CXX"], "-std=c++20", "-g", "-fno-eliminate-unused-debug-types"]
                include = ["-I", os.environ["INKWELL_REGISTERS"]]
                subprocess.run([*compiler, *include, "-c", "map.cpp", "-o", "map.o"], cwd=folder, check=True)
                command += ["--firmware", str(folder / "map.o")]
            if chip is not None:
                (folder / "chip.json").write_text(json.dumps(chip))
                command += ["--chip", str(folder / "chip.json")]
            return subprocess.run(command, capture_output=True, text=True, check=False)

    def planted(self, right: str, wrong: str) -> str:
        self.assertIn(right, SOURCE)
        result = self.run_tool(SOURCE.replace(right, wrong))
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        return result.stdout

    def test_agreement_is_found(self):
        result = self.run_tool()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("2 peripherals, 8 registers and 8 fields compared: 0 differences", result.stdout)

    def test_wrong_offset_is_found_in_every_instance(self):
        output = self.planted("SR : Register<base + 0x04>", "SR : Register<base + 0x08>")
        self.assertIn("LAMP.SR is at 0x40001008, in the SVD at 0x40001004", output)
        self.assertIn("LAMP2.SR is at 0x40002008, in the SVD at 0x40002004", output)

    def test_wrong_stride_is_found(self):
        output = self.planted("<base + 0x10, 0x08, 2>", "<base + 0x10, 0x04, 2>")
        self.assertIn("LAMP.CHANNEL1 is at 0x40001014, in the SVD at 0x40001018", output)

    def test_wrong_position_and_width_are_found(self):
        self.assertIn("LAMP.CR.ON is at bit 1, 1 wide", self.planted("<CR, 0, 1>", "<CR, 1, 1>"))
        self.assertIn("in the SVD at bit 4, 3 wide", self.planted("<CR, 4, 3>", "<CR, 4, 2>"))

    def test_wrong_base_and_unknown_names_are_found(self):
        self.assertIn("in the SVD at 0x40002000", self.planted("Lamp<0x40002000>", "Lamp<0x40005000>"))
        self.assertIn("no field OFF", self.planted("using ON", "using OFF"))
        self.assertIn("LAMP.STATUS: the SVD has no such register", self.planted("struct SR", "struct STATUS"))
        self.assertIn("no peripheral LANTERN", self.planted("using LAMP2 = registers", "using LANTERN = registers"))

    def test_an_invalid_register_declaration_is_refused(self):
        for right, wrong, said in (
            ("template struct Lamp<0x40002000>;", "", "LAMP2 is not instantiated"),
            ("using ON = Field<CR, 0, 1>", "using ON = int", "CR.ON is not a Field"),
            ("using LEVEL = Field<CHANNEL, 8, 8>", "using LEVEL = Field<CR, 8, 8>", "CHANNEL.LEVEL says that it is of CR"),
            ("struct SR : Register<base + 0x04> {};", "struct SR {};", "neither a Register"),
        ):
            self.assertIn(right, SOURCE)
            result = self.run_tool(SOURCE.replace(right, wrong))
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn(said, result.stderr)

    def test_the_emulator_s_map_is_compared_too(self):
        right = [lamp("LAMP", 0x40001000), lamp("LAMP2", 0x40002000)]
        result = self.run_tool(None, right)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("2 peripherals, 4 registers and 4 fields compared: 0 differences", result.stdout)
        wrong = [lamp("LAMP", 0x40001000), lamp("LAMP2", 0x40002000)]
        wrong[1]["registers"][0]["fields"][1]["width"] = 2
        result = self.run_tool(None, wrong)
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn("chip LAMP2.CR.COLOUR is at bit 4, 2 wide; in the SVD at bit 4, 3 wide", result.stdout)

    def test_each_field_must_exist_in_at_least_one_peripheral_of_a_kind(self):
        result = self.run_tool(None, [lamp("LAMP", 0x40001000), lamp("LAMP3", 0x40003000)])
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        result = self.run_tool(None, [lamp("LAMP3", 0x40003000)])
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn("no field COLOUR", result.stdout)
        self.assertIn("chip LAMP3.SR: the SVD has no such register", result.stdout)

    def test_an_invalid_input_file_is_refused(self):
        for svd in ("", "<device/>"):
            result = self.run_tool(None, svd=svd)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("SVD", result.stderr)
        result = self.run_tool(None, [{"name": "LAMP"}])
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("print-chip-registers", result.stderr)
        result = self.run_tool("int nothing;\n")
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("no debug information", result.stderr)


if __name__ == "__main__":
    unittest.main()
