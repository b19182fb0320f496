#!/usr/bin/env python3
"""Checks the firmware image for forbidden code (heap, double precision) and for violations of the interrupt rules.

    tools/check/check_image.py build/board/inkwell.elf

Prints the free memory of the image. Prints one line per error and returns exit code 1 if there are errors.
"""

import argparse
import pathlib
import re
import subprocess
import sys

from call_graph import Image, Unreadable, read_image, readable, run
from interrupt_rules import LAW_FUNCTIONS, broken_interrupt_rules

# Functions that the firmware image must not contain, with their causes. Each key is a pattern of a whole symbol name.
FORBIDDEN = {
    r"_?(malloc|calloc|realloc|free)(_r)?|_sbrk(_r)?": "the heap",
    r"_Zn[wa].*|_Zd[la].*": "operator new or delete",
    r"__aeabi_(d|l2d|ul2d|i2d|ui2d|f2d|cd|cdr)\w*": "double precision in software",
    r"__cxa_(throw|rethrow|begin_catch|allocate_exception)|_Unwind_\w+": "exceptions",
    r"__cxa_guard_\w+": "thread-safe initialisation of local variables",
    r"_ZTI.*|__dynamic_cast": "run-time type information",
    r"(sin|cos|tan|a?sin|acos|atan2?|exp|log|pow|fmod|sqrt|cbrt|hypot)f?l?":
        "the mathematical library. Use __builtin_sqrtf or control/trigonometry.hpp",
    r"_?(v?f?n?printf|puts|_vfprintf_r)": "formatted printing",
}


def section_bytes(elf: str) -> dict[str, tuple[int, int]]:
    """Size and address of each section that occupies memory."""
    rows = re.findall(r"^(\.\S+)\s+(\d+)\s+(\d+)$", run("arm-none-eabi-size", "-A", elf), re.MULTILINE)
    return {name: (int(size), int(address)) for name, size, address in rows if int(address) != 0}


# Scarce memory regions of the linker script, with their names in the output.
REGIONS = {"INTERRUPT": "interrupt code", "TABLES": "interrupt tables", "RAM": "RAM", "SRAM2": "SRAM2",
           "CORE_COUPLED": "core-coupled RAM"}
LINKER_SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "boards/facts/stm32f405.ld"


def usage(region: str, sections: dict[str, tuple[int, int]]) -> tuple[int, int, int]:
    """Start address, size and used bytes of a region."""
    memory = re.search(rf"^ +{region} \(\w+\) *: ORIGIN = (0x[0-9A-F]+), LENGTH = (\d+)K", LINKER_SCRIPT.read_text(),
                       re.MULTILINE)
    begin, room = int(memory[1], 16), 1024 * int(memory[2])
    # A section may be longer than its region.
    used = max((address + size - begin for size, address in sections.values() if begin <= address < begin + room),
               default=0)
    return begin, room, used


def free_memory(sections: dict[str, tuple[int, int]]) -> str:
    """Used and free bytes of each region in REGIONS."""
    texts = []
    for region, name in REGIONS.items():
        _, room, used = usage(region, sections)
        texts.append(f"{name} {used} of {room} bytes, {room - used} left")
    return "; ".join(texts)


def forbidden_symbols(image: Image) -> list[str]:
    return [
        f"the image holds {name}: {meaning}{caller_of(image, name)}"
        for name in sorted(image.symbols)
        for pattern, meaning in FORBIDDEN.items()
        if re.fullmatch(pattern, name)
    ]


def caller_of(image: Image, name: str) -> str:
    """Returns the location of a call of the function, preceded by a comma, or an empty text."""
    callers = (function for function in image.functions.values() if name in function.calls)
    caller = next(callers, None)
    return f", called at {image.location_of_call(caller, name)}" if caller else ""


# The firmware and the texts of the largest force law need less than this limit. A larger image probably contains
# unwanted code.
CODE_LIMIT_BYTES = 56 * 1024


def law_bytes(image: Image, section: range) -> int:
    """Bytes of interrupt code that only the force law needs."""
    laws = frozenset(name for name in image.functions if any(law in name for law in LAW_FUNCTIONS))
    others = set().union(*(image.reachable(name, laws) for name in image.interrupts))
    of_law = set().union(*map(image.reachable, laws)) - others
    return sum(image.sizes[name] for name in of_law if image.functions[name].address in section)


def exceeded_limits(image: Image, sections: dict[str, tuple[int, int]], of_law: int) -> list[str]:
    problems = []
    _, room, used = usage("INTERRUPT", sections)
    if used > room:
        problems.append(
            f"the interrupt code needs {used} bytes, but its memory has {room}. The force law needs {of_law} bytes and "
            f"may need {max(room - used + of_law, 0)}. Use fewer unrolled loops, or share code in a function.")
    _, room, used = usage("TABLES", sections)
    if used > room:
        of_law = image.symbols["force_law_tables_end"] - image.symbols["force_law_tables_begin"]
        problems.append(
            f"the tables of interrupt code need {used} bytes, but their memory has {room}. The tables of the force law "
            f"need {of_law} bytes and may need {max(room - used + of_law, 0)}. Use smaller tables.")
    code = sections.get(".text", (0, 0))[0]
    if code > CODE_LIMIT_BYTES:
        problems.append(f"the code of the main loop takes {code} bytes, and the limit is {CODE_LIMIT_BYTES}")
    return problems


def main() -> int:
    parser = argparse.ArgumentParser(description="Checks the firmware's image.")
    parser.add_argument("elf", help="the linked image")
    arguments = parser.parse_args()
    try:
        image = read_image(arguments.elf)
        sections = section_bytes(arguments.elf)
    except (OSError, subprocess.CalledProcessError, Unreadable, KeyError) as error:
        print(f"cannot read {arguments.elf} as the firmware's image: {error}", file=sys.stderr)
        return 2

    print(f"{pathlib.Path(arguments.elf).name}: {free_memory(sections)}")

    size, address = sections.get(".interrupt_text", (0, 0))
    section = range(address, address + size)
    of_law = law_bytes(image, section)
    _, room, used = usage("INTERRUPT", sections)
    print(f"force law: {of_law} of {max(room - used + of_law, 0)} bytes of interrupt code")
    problems = (forbidden_symbols(image) + broken_interrupt_rules(image, section)) or exceeded_limits(image, sections, of_law)
    for problem in problems:
        print(f"ERROR: {readable(problem)}", file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
