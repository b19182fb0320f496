"""Checks the firmware's register map and the emulator's against the SVD file that INKWELL_SVD names.

usage: against_svd.py OBJECT PRINT_CHIP_REGISTERS
"""

import os
import pathlib
import subprocess
import sys
import tempfile

SKIPPED = 77
TOOL = pathlib.Path(__file__).resolve().parents[3] / "tools/check/check_registers.py"

svd = os.environ.get("INKWELL_SVD")
if not svd:
    print("Skipped: the registers were not checked. Set INKWELL_SVD to the path of an SVD file of the STM32F405.")
    sys.exit(SKIPPED)
firmware, print_chip_registers = sys.argv[1:]
with tempfile.TemporaryDirectory() as folder:
    chip = pathlib.Path(folder) / "chip.json"
    chip.write_bytes(subprocess.run([print_chip_registers], check=True, capture_output=True).stdout)
    command = [sys.executable, TOOL, svd, "--firmware", firmware, "--chip", chip]
    sys.exit(subprocess.run(command, check=False).returncode)
