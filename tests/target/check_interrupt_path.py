#!/usr/bin/env python3
"""Looks through the machine code that an interrupt can reach for what must not be there.

Divides and square roots take 14 cycles and more, double arithmetic is software, and a call through a pointer
cannot be followed. Prints the reachable functions with their sizes; exits with 1 and names each offender.

usage: check_interrupt_path.py [--objdump PROGRAM] --entry FUNCTION ELF
"""
import argparse
import re
import subprocess
import sys

FORBIDDEN_INSTRUCTION = re.compile(r"^(vdiv|vsqrt|sdiv|udiv)")
FORBIDDEN_FUNCTION = re.compile(
    r"^(__aeabi_(d|cd|cfrcmple_d|f2d|i2d|ui2d|l2d|ul2d|u?idiv|u?ldiv)"
    r"|__(add|sub|mul|div)[dt]f3|__(ieee754|kernel)_"
    r"|(sin|cos|tan|asin|acos|atan|atan2|sqrt|exp|log|pow|fmod|floor|ceil|round|hypot)f?$"
    r"|_?malloc|_?free|_Zn[wa]|_Zd[la]|__cxa_)")
INDIRECT_CALL = re.compile(r"^blx\s+r|^bx\s+(?!lr)r|^blx\s+ip|^bx\s+ip")
FUNCTION_HEAD = re.compile(r"^([0-9a-f]+) <(.+)>:$")
BRANCH = re.compile(r"^(?:b|bl|b\w{2}|cbz|cbnz)(?:\.[nw])?\s+.*<([^+>]+)(?:\+0x[0-9a-f]+)?>$")


def disassemble(objdump: str, elf: str) -> dict[str, list[str]]:
    """Instructions of every function of the ELF, by its name."""
    listing = subprocess.run([objdump, "-d", "--no-show-raw-insn", elf], capture_output=True, text=True)
    if listing.returncode != 0:
        sys.exit(f"{elf} cannot be disassembled: {listing.stderr.strip()}")
    functions: dict[str, list[str]] = {}
    current: list[str] = []
    for line in listing.stdout.splitlines():
        if head := FUNCTION_HEAD.match(line):
            current = functions.setdefault(head.group(2), [])
        elif ":\t" in line:
            instruction = line.split(":\t", 1)[1].split(";")[0].split("@")[0]
            current.append(" ".join(instruction.split()))
    return functions


def reachable(functions: dict[str, list[str]], entry: str) -> list[str]:
    """Functions that can run once `entry` is called, in the order in which they are found."""
    found, waiting = [], [entry]
    while waiting:
        name = waiting.pop()
        if name in found:
            continue
        found.append(name)
        for instruction in functions.get(name, []):
            if branch := BRANCH.match(instruction):
                waiting.append(branch.group(1))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--objdump", default="arm-none-eabi-objdump")
    parser.add_argument("--entry", required=True)
    parser.add_argument("elf")
    arguments = parser.parse_args()

    functions = disassemble(arguments.objdump, arguments.elf)
    if arguments.entry not in functions:
        sys.exit(f"{arguments.elf} has no function {arguments.entry}: name the interrupt's handler.")
    offences = []
    names = reachable(functions, arguments.entry)
    for name in names:
        print(f"{len(functions.get(name, [])):6} instructions  {name}")
        if FORBIDDEN_FUNCTION.match(name):
            offences.append(f"{name} can be reached")
        for instruction in functions.get(name, []):
            if FORBIDDEN_INSTRUCTION.match(instruction) or INDIRECT_CALL.match(instruction):
                offences.append(f"{name}: {instruction}")
    print(f"{sum(len(functions.get(name, [])) for name in names):6} instructions in {len(names)} functions")
    if offences:
        sys.exit("Not allowed in an interrupt's path:\n  " + "\n  ".join(offences))


if __name__ == "__main__":
    main()
