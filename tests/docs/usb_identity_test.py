"""The settings line for spacenavd contains the USB identity of the firmware."""

import re
import sys
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]


class UsbIdentity(unittest.TestCase):
    def test_the_line_for_spacenavd_names_the_device(self):
        header = (TOP / "protocol/usb_identity.hpp").read_text()
        vendor, product = (re.search(rf"\b{name} = 0x(\w+);", header)[1] for name in ("vendor_id", "product_id"))
        self.assertIn(f"\n    device-id = {vendor}:{product}\n", (TOP / "docs/input-device.md").read_text())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
