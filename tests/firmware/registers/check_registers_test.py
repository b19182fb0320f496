"""The register map's checker finds what is wrong, with a map and an SVD of a made-up peripheral."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
TOOL = REPOSITORY / "tools/check_registers.py"

HEADER = """// A made-up peripheral.
#pragma once

#include <registers/register.hpp>

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
</peripherals></device>
"""


class CheckRegisters(unittest.TestCase):
    def run_tool(self, header: str = HEADER, svd: str = SVD) -> subprocess.CompletedProcess:
        with tempfile.TemporaryDirectory() as folder:
            headers = pathlib.Path(folder) / "headers"
            headers.mkdir()
            (headers / "lamp.hpp").write_text(header)
            svd_file = pathlib.Path(folder) / "chip.svd"
            svd_file.write_text(svd)
            command = [sys.executable, str(TOOL), str(svd_file), "--headers", str(headers)]
            return subprocess.run(command, capture_output=True, text=True, check=False)

    def planted(self, right: str, wrong: str) -> str:
        self.assertIn(right, HEADER)
        result = self.run_tool(HEADER.replace(right, wrong))
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
        self.assertIn("in the SVD at 0x40002000", self.planted("Lamp<0x40002000>", "Lamp<0x40003000>"))
        self.assertIn("no field OFF", self.planted("using ON", "using OFF"))
        self.assertIn("no register STATUS", self.planted("struct SR", "struct STATUS"))
        self.assertIn("no peripheral LANTERN", self.planted("using LAMP2", "using LANTERN"))

    def test_a_line_of_another_form_is_refused(self):
        for line in ("  using ON = Field<CR, 1 - 1, 1>;", "  struct XR : Register<0x04 + base> {};", "int surprise;"):
            result = self.run_tool(HEADER.replace("struct Lamp {", "struct Lamp {\n" + line))
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("lamp.hpp:", result.stderr)

    def test_an_svd_that_is_none_is_refused(self):
        for svd in ("", "<device/>"):
            result = self.run_tool(svd=svd)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("SVD", result.stderr)

    def test_the_firmware_s_own_map_has_the_form(self):
        sys.path.insert(0, str(TOOL.parent))
        import check_registers

        peripherals = check_registers.read_map(REPOSITORY / "firmware/registers/include/registers")
        by_name = {peripheral.name: peripheral for peripheral in peripherals}
        self.assertEqual(by_name["TIM8"].base, 0x40010400)
        self.assertIn("BDTR", [register.name for register in by_name["TIM8"].registers])


if __name__ == "__main__":
    unittest.main()
