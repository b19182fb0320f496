#!/usr/bin/env python3
"""Appends the checksum of the firmware image at the location where the firmware reads it.

    tools/generate/seal_image.py build/board/inkwell.elf

The checksum is the CRC-32 of the STM32F405 (RM0090, chapter CRC) over all words of the image before the section
.image_check. The only gap between the sections is the parameter store, which is not part of the image. Further gaps are
not allowed, because their content depends on the programmer.
"""

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

POLYNOMIAL = 0x04C11DB7


def table_of_bytes() -> list[int]:
    table = []
    for byte in range(256):
        rest = byte << 24
        for _ in range(8):
            rest = (rest << 1 ^ (POLYNOMIAL if rest & 0x80000000 else 0)) & 0xFFFFFFFF
        table.append(rest)
    return table


def checksum(image: bytes) -> int:
    """CRC-32 of whole little-endian words, from the most significant bit on."""
    if len(image) % 4 != 0:
        raise ValueError("the image does not end at a word's end")
    table = table_of_bytes()
    rest = 0xFFFFFFFF
    for at in range(0, len(image), 4):
        for byte in reversed(image[at : at + 4]):
            rest = (rest << 8 & 0xFFFFFFFF) ^ table[rest >> 24 ^ byte]
    return rest


def objcopy(*arguments: str) -> None:
    subprocess.run(["arm-none-eabi-objcopy", *arguments], check=True)


def flash_of(elf: str, folder: Path) -> bytes:
    """The image without the parameter store: the sections in the order of their flash addresses."""
    headers = subprocess.run(["arm-none-eabi-objdump", "-h", elf], check=True, capture_output=True, text=True).stdout
    rows = re.findall(r"^ *\d+ (\S+) +([0-9a-f]{8}) +[0-9a-f]{8} +([0-9a-f]{8}) .*\n +CONTENTS, ALLOC, LOAD", headers,
                      re.MULTILINE)
    sections = sorted((int(address, 16), int(size, 16), name) for name, size, address in rows if int(size, 16) > 0)
    gaps = [(first[0] + first[1], second[0]) for first, second in zip(sections, sections[1:])
            if first[0] + first[1] != second[0]]
    symbols = subprocess.run(["arm-none-eabi-nm", elf], check=True, capture_output=True, text=True).stdout
    addresses = {name: int(value, 16) for value, name in re.findall(r"^([0-9a-f]+) \w (\w+)$", symbols, re.MULTILINE)}
    if gaps != [(addresses["copied_end"], addresses["code_begin"])]:
        raise ValueError("there is a gap between two sections in the flash; align them in the linker script")
    image = b""
    for _, _, name in sections:
        objcopy("-O", "binary", "--only-section", name, elf, str(folder / "section.bin"))
        image += (folder / "section.bin").read_bytes()
    return image


def main() -> int:
    parser = argparse.ArgumentParser(description="Puts the checksum of the firmware's image behind it.")
    parser.add_argument("elf", help="the linked image")
    elf = parser.parse_args().elf
    with tempfile.TemporaryDirectory() as folder:
        word = Path(folder) / "check.bin"
        try:
            image = flash_of(elf, Path(folder))
            word.write_bytes(checksum(image[:-4]).to_bytes(4, "little"))
            objcopy("--update-section", f".image_check={word}", elf)
        except (OSError, ValueError, KeyError, subprocess.CalledProcessError) as error:
            print(f"cannot seal {elf}: {error}", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
