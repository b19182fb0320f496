#!/usr/bin/env python3
"""Checks the typed register map in firmware/registers against an SVD file.

    tools/check_registers.py STM32F405.svd [--headers DIRECTORY]

Every register's address, every field's position and width is looked up in the SVD. Both sides are read strictly: a
line of a header that is not of the map's form is an error, so nothing escapes the check. SVD files have errors and
gaps of their own; what is known of them stands below, each with its reason, and is printed as such. A known difference
that does not occur any more is an error too.

Exit code 0: all agree, or differ as known. 1: differences, one line each. 2: the input cannot be read.
"""

import argparse
import dataclasses
import pathlib
import re
import sys
import xml.etree.ElementTree

# ---- what is known of the SVD of the STM32F405 ---------------------------------------------------------------


@dataclasses.dataclass
class Known:
    """A difference that is the SVD's, or that has a reason. Patterns match whole names of our map, fields may be None
    for a whole register and registers for a whole peripheral. `svd_name` is what the SVD has instead; None: nothing
    that could be compared."""

    peripheral: str
    register: str | None
    field: str | None
    svd_name: str | None
    reason: str
    uses: int = 0

    def applies(self, *names: str) -> bool:
        patterns = [pattern for pattern in (self.peripheral, self.register, self.field) if pattern is not None]
        return len(patterns) == len(names) and all(map(re.fullmatch, patterns, names))

    def rename(self, name: str) -> str:
        """The SVD's name; `{}` in it stands for ours."""
        return self.svd_name.format(name)


FS_PREFIX = "the SVD puts FS_ before most names of this core"
VIEWS = "the SVD has one view of it for output and one for input"
IN_CPP = "a field cannot have its register's name in C++"
ENDPOINT_0 = "endpoint 0 has a narrower field (packet size as a code, few packets); the driver writes no more to it"
NOT_ON_0 = "endpoint 0 has no data toggle to set; the driver does not set it there"


def known_differences() -> list[Known]:
    return [
        Known("ADC_COMMON", None, None, "C_ADC", "the SVD's name for what the three converters share"),
        Known("SIGNATURE", None, None, None, 'not in the SVD; RM0090, "Unique device ID register": 0x1FFF7A10'),
        Known("CORE_DEBUG", None, None, None, "not in the SVD; ARMv7-M Architecture Reference Manual: DEMCR at 0xE000EDFC"),
        Known("DWT", None, None, None, "not in the SVD; ARMv7-M Architecture Reference Manual: DWT_CTRL at 0xE0001000"),
        Known("OTG_FS_FIFO", None, None, None, 'not in the SVD; RM0090, "Data FIFO (DFIFO) access register map": 0x50001000'),
        Known("TIM[18]", "CCMR[12]", None, "{}_Output", VIEWS),
        Known("TIM[345]", "CCMR1", None, "{}_Input", VIEWS),
        Known("SCB", "CFSR", None, "CFSR_UFSR_BFSR_MMFSR", "the SVD spells out the three status registers in it"),
        Known("NVIC", "IPR20", None, None, "the SVD ends with interrupt 79; RM0090's vector table with 81"),
        Known("OTG_FS_GLOBAL", "G(?!RXSTSP).*|DIEPTXF[12]", None, "FS_{}", FS_PREFIX),
        Known("OTG_FS_GLOBAL", "GRXSTSP", None, None, "the SVD has only GRXSTSR, which does not pop; RM0090: 0x50000020"),
        Known("OTG_FS_GLOBAL", "DIEPTXF0", None, "FS_GNPTXFSIZ_Device", "the SVD has its name in host mode"),
        Known("OTG_FS_DEVICE", "DCFG|DCTL|DIEPMSK|DAINTMSK|DIEPCTL0", None, "FS_{}", FS_PREFIX),
        Known("OTG_FS_PWRCLK", "PCGCCTL", None, "FS_{}", FS_PREFIX),
        Known("RCC", "CSR", "IWDGRSTF", "WDGRSTF", "RM0090 calls the independent watchdog's flag IWDGRSTF"),
        Known("DBG", "DBGMCU_APB1_FZ", "DBG_IWDG_STOP", "DBG_IWDEG_STOP", "a misspelling in the SVD"),
        Known("IWDG", "PR", "PR_", "PR", IN_CPP),
        Known("PWR", "CR", "VOS", None, "not in the SVD; RM0090, PWR_CR of the STM32F405: bit 14"),
        Known("SCB", "AIRCR", "VECTKEY", "VECTKEYSTAT", "the SVD has the name for reading"),
        Known("OTG_FS_GLOBAL", "GCCFG", "NOVBUSSENS", None, "not in the SVD; RM0090, OTG_FS_GCCFG: bit 21"),
        Known("OTG_FS_DEVICE", "DIEPCTL[1-3]|DOEPCTL[0-3]", "STALL", "Stall", "the SVD has it in small letters"),
        Known("OTG_FS_DEVICE", "D[IO]EPCTL[1-3]", "SD0PID", "SD0PID_SEVNFRM", "the SVD has both its meanings"),
        Known("OTG_FS_DEVICE", "DOEPTSIZ[1-3]", "STUPCNT", "RXDPID_STUPCNT", "the SVD has both its meanings"),
        Known("OTG_FS_DEVICE", "D[IO]EPCTL0", "SD0PID", None, NOT_ON_0),
        Known("OTG_FS_DEVICE", "D[IO]EPCTL0", "MPSIZ", None, ENDPOINT_0),
        Known("OTG_FS_DEVICE", "D[IO]EPTSIZ0", "XFRSIZ|PKTCNT", None, ENDPOINT_0),
    ]


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
        self.known = known_differences()
        self.differences: list[str] = []
        self.registers = 0
        self.fields = 0

    def svd_name(self, *names: str) -> str | None:
        """Name in the SVD of the peripheral, register or field that `names` lead to; None: not comparable."""
        for known in self.known:
            if known.applies(*names):
                known.uses += 1
                return None if known.svd_name is None else known.rename(names[-1])
        return names[-1]

    def compare(self, peripheral: Peripheral) -> None:
        name = self.svd_name(peripheral.name)
        if name is None:
            return
        if name not in self.svd:
            self.differences.append(f"{peripheral.where}: the SVD has no peripheral {name}")
            return
        base, registers = self.svd[name]
        if base != peripheral.base:
            self.differences.append(
                f"{peripheral.where}: {peripheral.name} is at 0x{peripheral.base:08X}, in the SVD at 0x{base:08X}"
            )
            return
        for register in peripheral.registers:
            for index in range(register.count):
                # An array of bytes is four to a register of the SVD, which has only the whole one.
                if register.size_bits == 32 or index * register.stride % 4 == 0:
                    self.compare_register(peripheral, register, registers, index)

    def compare_register(self, peripheral, register, svd_registers, index) -> None:
        name = register.name
        if register.stride:
            # CCR[0] is CCR1 in the timers; elsewhere, as ISER[0] is ISER0, the count begins with 0.
            name += str(index * register.stride // 4 if register.size_bits != 32 else index + (name == "CCR"))
        label = f"{peripheral.name}.{name}"
        address = peripheral.base + register.offset + register.stride * index
        wanted = self.svd_name(peripheral.name, name)
        if wanted is None:
            return
        found = next((candidate for candidate in svd_registers if candidate.name == wanted), None)
        if found is None:
            self.differences.append(f"{label}: the SVD has no register {wanted} in {peripheral.name}")
            return
        self.registers += 1
        if found.address != address:
            self.differences.append(f"{label} is at 0x{address:08X}, in the SVD at 0x{found.address:08X}")
            return
        for field in register.fields:
            self.compare_field(peripheral.name, name, field, found)

    def compare_field(self, peripheral: str, register: str, field: Field, found: SvdRegister) -> None:
        name = self.svd_name(peripheral, register, field.name)
        if name is None:
            return
        self.fields += 1
        place = found.fields.get(name) or gathered(found.fields, name)
        if place is None:
            self.differences.append(f"{peripheral}.{register}: the SVD has no field {name} there")
        elif place != (field.position, field.width):
            self.differences.append(
                f"{peripheral}.{register}.{field.name} is at bit {field.position}, {field.width} wide; "
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


def unused(comparison: Comparison, peripherals: list[Peripheral]) -> list[str]:
    """Known differences of peripherals in our map that did not occur: the SVD or the map has changed."""
    return [
        f"the known difference of {known.peripheral} {known.register or ''} {known.field or ''} does not occur; "
        f"remove it from {pathlib.Path(__file__).name}"
        for known in comparison.known
        if known.uses == 0 and any(re.fullmatch(known.peripheral, peripheral.name) for peripheral in peripherals)
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
    used = [known for known in comparison.known if known.uses]
    for known in used:
        place = ".".join(pattern for pattern in (known.peripheral, known.register, known.field) if pattern)
        print(f"known: {place}: {known.reason}")
    problems = comparison.differences + unused(comparison, peripherals)
    for problem in problems:
        print(f"DIFFERS: {problem}")
    print(
        f"{len(peripherals)} peripherals, {comparison.registers} registers and {comparison.fields} fields compared: "
        f"{len(problems)} differences, {len(used)} known ones"
    )
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
