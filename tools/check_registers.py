#!/usr/bin/env python3
"""Checks the typed register map in firmware/registers against an SVD file.

    tools/check_registers.py STM32F405.svd [--headers DIRECTORY]

Every register's address, every field's position and width is looked up in the SVD. Both sides are read strictly: a
line of a header that is not of the map's form is an error, so nothing escapes the check. SVD files have errors and
gaps of their own; what is known of them stands below, each with its reason, and is printed as such. An exception that
is not needed any more is an error too.

Exit code 0: all agree or are known exceptions. 1: differences, one line each. 2: the input cannot be read.
"""

import argparse
import dataclasses
import pathlib
import re
import sys
import xml.etree.ElementTree

# ---- what is known of the SVD of the STM32F405 ---------------------------------------------------------------

# Peripherals whose name in the SVD differs from ours.
PERIPHERAL_NAMES = {"ADC_COMMON": "C_ADC"}

# Whole peripherals that the SVD does not have: name -> reason.
PERIPHERALS_ABSENT = {
    "SIGNATURE": "the SVD leaves the device signature out; RM0090, \"Unique device ID register\", has it at 0x1FFF7A10",
    "CORE_DEBUG": "debug registers of the core, ARMv7-M Architecture Reference Manual, C1.6: DEMCR at 0xE000EDFC",
    "DWT": "debug registers of the core, ARMv7-M Architecture Reference Manual, C1.8: DWT_CTRL at 0xE0001000",
}

# Registers that go by another name in the SVD: (peripheral, our name) -> (its name, reason).
REGISTER_NAMES = {
    ("TIM1", "CCMR1"): ("CCMR1_Output", "the SVD has one view of it for output and one for input"),
    ("TIM1", "CCMR2"): ("CCMR2_Output", "the SVD has one view of it for output and one for input"),
    ("TIM8", "CCMR1"): ("CCMR1_Output", "the SVD has one view of it for output and one for input"),
    ("TIM8", "CCMR2"): ("CCMR2_Output", "the SVD has one view of it for output and one for input"),
    ("TIM3", "CCMR1"): ("CCMR1_Input", "the SVD has one view of it for output and one for input"),
    ("TIM4", "CCMR1"): ("CCMR1_Input", "the SVD has one view of it for output and one for input"),
    ("TIM5", "CCMR1"): ("CCMR1_Input", "the SVD has one view of it for output and one for input"),
    ("SCB", "CFSR"): ("CFSR_UFSR_BFSR_MMFSR", "the SVD spells out the three status registers in it"),
}

# Fields that go by another name: (peripheral, register, our name) -> (its name, reason).
FIELD_NAMES = {
    ("RCC", "CSR", "IWDGRSTF"): ("WDGRSTF", "RM0090 calls the independent watchdog's flag IWDGRSTF"),
    ("DBG", "DBGMCU_APB1_FZ", "DBG_IWDG_STOP"): ("DBG_IWDEG_STOP", "a misspelling in the SVD"),
    ("IWDG", "PR", "PR_"): ("PR", "a field cannot have its register's name in C++"),
    ("USART2", "DR", "DR_"): ("DR", "a field cannot have its register's name in C++"),
}

# Fields that the SVD lacks or has wrong: (peripheral, register, field) -> reason.
FIELDS_NOT_COMPARABLE = {
    ("PWR", "CR", "VOS"): "the SVD leaves it out; RM0090, PWR_CR of the STM32F405: bit 14",
    ("SCB", "AIRCR", "VECTKEY"): "the SVD has its name for reading, VECTKEYSTAT, at the same place",
}


# ---- reading our map -------------------------------------------------------------------------------------------


class Unreadable(Exception):
    """The input is not what it should be; the message says where and why."""


@dataclasses.dataclass
class Field:
    name: str
    position: int
    width: int


@dataclasses.dataclass
class Register:
    name: str
    offset: int
    stride: int = 0  # 0: not an array
    count: int = 1
    size_bits: int = 32
    fields: list[Field] = dataclasses.field(default_factory=list)


@dataclasses.dataclass
class Peripheral:
    name: str
    base: int
    registers: list[Register]
    where: str


NUMBER = r"(0x[0-9A-Fa-f]+|\d+)"
IGNORED_LINE = re.compile(r"#pragma once|#include <[\w/.]+>|namespace inkwell::registers \{|\}")
TEMPLATE_LINE = re.compile(r"template <std::uint32_t base>")
STRUCT_LINE = re.compile(r"struct (\w+) \{")
REGISTER_LINE = re.compile(rf"struct (\w+) : Register<base \+ {NUMBER}(?:, std::uint(8|16|32)_t)?> \{{(\}};)?")
ARRAY_LINE = re.compile(
    rf"struct (\w+) : RegisterArray<base \+ {NUMBER}, {NUMBER}, {NUMBER}(?:, std::uint(8|16|32)_t)?> \{{(\}};)?"
)
FIELD_LINE = re.compile(rf"using (\w+) = Field<(\w+), {NUMBER}, {NUMBER}>;")
INSTANCE_LINE = re.compile(rf"using (\w+) = (\w+)<{NUMBER}>;")


def number(text: str) -> int:
    return int(text, 0)


def read_header(path: pathlib.Path) -> list[Peripheral]:
    """The peripherals of one header; raises Unreadable on a line that is not of the map's form."""
    forms: dict[str, list[Register]] = {}
    peripherals = []
    form: str | None = None
    register: Register | None = None
    for line_number, line in enumerate(path.read_text().splitlines(), start=1):
        where = f"{path.name}:{line_number}"
        text = re.sub(r"\s*//.*", "", line).strip()
        if not text or TEMPLATE_LINE.fullmatch(text):
            continue
        if match := REGISTER_LINE.fullmatch(text):
            new = Register(match[1], number(match[2]), size_bits=int(match[3] or 32))
        elif match := ARRAY_LINE.fullmatch(text):
            new = Register(match[1], number(match[2]), number(match[3]), number(match[4]), int(match[5] or 32))
        else:
            new = None
        if new is not None:
            if form is None or register is not None:
                raise Unreadable(f"{where}: register {new.name} does not stand in a peripheral's struct")
            forms[form].append(new)
            register = None if text.endswith("};") else new
        elif match := STRUCT_LINE.fullmatch(text):
            if form is not None:
                raise Unreadable(f"{where}: struct {match[1]} begins inside of {form}")
            form = match[1]
            forms[form] = []
        elif match := FIELD_LINE.fullmatch(text):
            if register is None or match[2] != register.name:
                raise Unreadable(f"{where}: field {match[1]} names {match[2]}, but stands elsewhere")
            register.fields.append(Field(match[1], number(match[3]), number(match[4])))
        elif text == "};":
            if register is not None:
                register = None
            elif form is not None:
                form = None
            else:
                raise Unreadable(f"{where}: nothing is open that could end here")
        elif match := INSTANCE_LINE.fullmatch(text):
            if match[2] not in forms:
                raise Unreadable(f"{where}: {match[1]} is made of the unknown struct {match[2]}")
            peripherals.append(Peripheral(match[1], number(match[3]), forms[match[2]], where))
        elif not IGNORED_LINE.fullmatch(text):
            raise Unreadable(f"{where}: not of the register map's form (see register.hpp): {text}")
    return peripherals


def read_map(directory: pathlib.Path) -> list[Peripheral]:
    headers = sorted(path for path in directory.glob("*.hpp") if path.name != "register.hpp")
    if not headers:
        raise Unreadable(f"{directory} has no headers; give the folder of the register map with --headers")
    return [peripheral for header in headers for peripheral in read_header(header)]


# ---- reading the SVD -------------------------------------------------------------------------------------------


@dataclasses.dataclass
class SvdRegister:
    name: str
    address: int
    size_bits: int
    fields: dict[str, tuple[int, int]]  # name -> position, width


def read_svd_field(element) -> tuple[int, int]:
    """Position and width, in any of the three notations of the CMSIS-SVD format."""
    if (offset := element.findtext("bitOffset")) is not None:
        return number(offset), number(element.findtext("bitWidth", "1"))
    if (low := element.findtext("lsb")) is not None:
        return number(low), number(element.findtext("msb")) - number(low) + 1
    if match := re.fullmatch(r"\[(\d+):(\d+)\]", element.findtext("bitRange", "")):
        return int(match[2]), int(match[1]) - int(match[2]) + 1
    raise Unreadable(f"the SVD's field {element.findtext('name')} has no position")


def read_svd(path: pathlib.Path) -> dict[str, tuple[int, list[SvdRegister]]]:
    """Name of each peripheral -> its base and its registers."""
    try:
        root = xml.etree.ElementTree.parse(path).getroot()
    except (OSError, xml.etree.ElementTree.ParseError) as error:
        raise Unreadable(f"cannot read the SVD file {path}: {error}") from error
    elements = {element.findtext("name"): element for element in root.iterfind("peripherals/peripheral")}
    if not elements:
        raise Unreadable(f"{path} has no peripherals: it is not an SVD file")
    peripherals = {}
    for name, element in elements.items():
        source = element
        if element.find("registers") is None and (parent := element.get("derivedFrom")) is not None:
            source = elements[parent]
        base = number(element.findtext("baseAddress"))
        peripherals[name] = (
            base,
            [
                SvdRegister(
                    register.findtext("name"),
                    base + number(register.findtext("addressOffset")),
                    number(register.findtext("size", "32")),
                    {field.findtext("name"): read_svd_field(field) for field in register.iterfind("fields/field")},
                )
                for register in source.iterfind("registers/register")
            ],
        )
    return peripherals


# ---- comparing -------------------------------------------------------------------------------------------------


class Comparison:
    def __init__(self, svd):
        self.svd = svd
        self.differences: list[str] = []
        self.exceptions: dict[tuple, str] = {}
        self.registers = 0
        self.fields = 0

    def compare(self, peripheral: Peripheral) -> None:
        name = PERIPHERAL_NAMES.get(peripheral.name, peripheral.name)
        if name not in self.svd:
            if reason := PERIPHERALS_ABSENT.get(peripheral.name):
                self.exceptions[(peripheral.name,)] = reason
            else:
                self.differences.append(f"{peripheral.where}: the SVD has no peripheral {name}")
            return
        base, registers = self.svd[name]
        if base != peripheral.base:
            self.differences.append(
                f"{peripheral.where}: {peripheral.name} is at 0x{peripheral.base:08X}, in the SVD at 0x{base:08X}"
            )
            return
        for register in peripheral.registers:
            if register.stride and register.size_bits == 32:
                for index in range(register.count):
                    self.compare_register(peripheral, register, registers, index)
            else:
                self.compare_register(peripheral, register, registers, None)

    def compare_register(self, peripheral, register, svd_registers, index) -> None:
        label = f"{peripheral.name}.{register.name}" + ("" if index is None else f"[{index}]")
        address = peripheral.base + register.offset + register.stride * (index or 0)
        wanted = self.register_names(peripheral.name, register.name, index)
        found = next((candidate for candidate in svd_registers if candidate.name in wanted), None)
        if found is None:
            self.differences.append(f"{label}: the SVD has no register {' or '.join(sorted(wanted))} in {peripheral.name}")
            return
        self.registers += 1
        if found.address != address:
            self.differences.append(f"{label} is at 0x{address:08X}, in the SVD at 0x{found.address:08X}")
            return
        for field in register.fields:
            self.compare_field(peripheral.name, register.name, label, field, found)

    def register_names(self, peripheral: str, register: str, index: int | None) -> set[str]:
        if entry := REGISTER_NAMES.get((peripheral, register)):
            self.exceptions[(peripheral, register)] = entry[1]
            return {entry[0]}
        if index is not None:
            # CCR[0] is CCR1 in the timers, ISER[0] is ISER0 in the NVIC: the address tells which count is meant.
            first = 1 if register == "CCR" else 0
            return {f"{register}{index + first}"}
        # An array of bytes is checked by its first register of 32 bits.
        return {register, f"{register}0"} if peripheral == "NVIC" else {register}

    def compare_field(self, peripheral: str, register: str, label: str, field: Field, found: SvdRegister) -> None:
        key = (peripheral, register, field.name)
        if reason := FIELDS_NOT_COMPARABLE.get(key):
            self.exceptions[key] = reason
            return
        name = field.name
        if entry := FIELD_NAMES.get(key):
            name, self.exceptions[key] = entry
        self.fields += 1
        place = found.fields.get(name) or gathered(found.fields, name)
        if place is None:
            self.differences.append(f"{label}: the SVD has no field {name} there")
        elif place != (field.position, field.width):
            self.differences.append(
                f"{label}.{field.name} is at bit {field.position}, {field.width} wide; "
                f"in the SVD at bit {place[0]}, {place[1]} wide"
            )


def gathered(fields: dict[str, tuple[int, int]], name: str) -> tuple[int, int] | None:
    """Place of a field that the SVD has as single bits, as PLLN0 to PLLN8, if they lie side by side."""
    bits = {int(match[1]): place for key, place in fields.items() if (match := re.fullmatch(rf"{name}(\d)", key))}
    if not bits or sorted(bits) != list(range(len(bits))):
        return None
    if any(place != (bits[0][0] + bit, 1) for bit, place in bits.items()):
        return None
    return bits[0][0], len(bits)


def unused_exceptions(comparison: Comparison, peripherals: list[Peripheral]) -> list[str]:
    """Exceptions for what is in our map, but was not needed: the SVD or the map has changed."""
    mapped = {peripheral.name for peripheral in peripherals}
    known = [(name,) for name in PERIPHERALS_ABSENT] + list(REGISTER_NAMES) + list(FIELD_NAMES)
    known += list(FIELDS_NOT_COMPARABLE)
    return [
        f"the exception for {'.'.join(key)} is not needed; remove it from {pathlib.Path(__file__).name}"
        for key in known
        if key[0] in mapped and key not in comparison.exceptions
    ]


def main() -> int:
    default = pathlib.Path(__file__).resolve().parent.parent / "firmware/registers/include/registers"
    parser = argparse.ArgumentParser(description="Checks the register map against an SVD file.")
    parser.add_argument("svd", type=pathlib.Path, help="SVD file of the STM32F405")
    parser.add_argument("--headers", type=pathlib.Path, default=default, help="folder of the register map")
    arguments = parser.parse_args()
    try:
        peripherals = read_map(arguments.headers)
        comparison = Comparison(read_svd(arguments.svd))
    except Unreadable as error:
        print(error, file=sys.stderr)
        return 2
    for peripheral in peripherals:
        comparison.compare(peripheral)
    for key, reason in comparison.exceptions.items():
        print(f"known: {'.'.join(key)}: {reason}")
    problems = comparison.differences + unused_exceptions(comparison, peripherals)
    for problem in problems:
        print(f"DIFFERS: {problem}")
    print(
        f"{len(peripherals)} peripherals, {comparison.registers} registers and {comparison.fields} fields compared: "
        f"{len(problems)} differences, {len(comparison.exceptions)} known exceptions"
    )
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
