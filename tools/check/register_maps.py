"""Inputs of the register check: the firmware's map, the emulator's map and an SVD file."""

import dataclasses
import json
import pathlib
import re
import xml.etree.ElementTree


class Unreadable(Exception):
    """The input has an unexpected format; the message states the location and the reason."""


@dataclasses.dataclass
class Field:
    name: str
    position: int
    width: int


@dataclasses.dataclass
class Register:
    name: str
    address: int
    fields: list[Field] = dataclasses.field(default_factory=list)


@dataclasses.dataclass
class Peripheral:
    name: str
    base: int
    registers: list[Register]

    def form(self) -> list:
        """The common description of all peripherals of this kind."""
        return [(register.name, register.address - self.base, register.fields) for register in self.registers]


def number(text: str) -> int:
    return int(text, 0)


class DebugInformation:
    """The firmware's register map from the compiler's debug information."""

    def __init__(self, path: pathlib.Path):
        try:
            from elftools.elf.elffile import ELFFile
        except ImportError as error:
            raise Unreadable("pyelftools is missing: install Debian's package python3-pyelftools") from error
        try:
            self.file = open(path, "rb")  # noqa: SIM115 - read from as long as this object lives
        except OSError as error:
            raise Unreadable(f"cannot read {path}: {error}") from error
        self.units = list(ELFFile(self.file).get_dwarf_info().iter_CUs())
        self.path = path

    @staticmethod
    def name(entry) -> str:
        attribute = entry.attributes.get("DW_AT_name")
        return attribute.value.decode() if attribute else ""

    @staticmethod
    def children(entry, tag: str) -> list:
        return [child for child in entry.iter_children() if child.tag == f"DW_TAG_{tag}"]

    def type_of(self, entry):
        """Resolves all aliases of a type."""
        target = entry.get_DIE_from_attribute("DW_AT_type")
        return self.type_of(target) if target.tag == "DW_TAG_typedef" else target

    def template_values(self, entry) -> list[int]:
        values = self.children(entry, "template_value_param")
        return [value.attributes["DW_AT_const_value"].value for value in values]

    def namespaces(self):
        for unit in self.units:
            for outer in self.children(unit.get_top_DIE(), "namespace"):
                if self.name(outer) == "inkwell":
                    yield from (n for n in self.children(outer, "namespace") if self.name(n) == "registers")

    def peripherals(self) -> list[Peripheral]:
        """Returns the aliases in inkwell::registers::Peripherals. GCC records no unused alias outside a class."""
        structures = [s for namespace in self.namespaces() for s in self.children(namespace, "structure_type")]
        listing = [structure for structure in structures if self.name(structure) == "Peripherals"]
        aliases = [alias for structure in listing for alias in self.children(structure, "typedef")]
        if not aliases:
            raise Unreadable(f"{self.path} has no debug information of the firmware's register map")
        return [self.peripheral(alias) for alias in aliases]

    def peripheral(self, alias) -> Peripheral:
        structure = self.type_of(alias)
        if "DW_AT_declaration" in structure.attributes:
            raise Unreadable(f"{self.name(alias)} is not instantiated in {self.path}")
        (base,) = self.template_values(structure)
        base &= 0xFFFFFFFF
        registers = []
        for entry in self.children(structure, "structure_type"):
            registers += self.registers(entry, base)
        return Peripheral(self.name(alias), base, registers)

    def registers(self, entry, base: int) -> list[Register]:
        name = self.name(entry)
        bases = [self.type_of(inheritance) for inheritance in self.children(entry, "inheritance")]
        fields = [self.field(alias, name) for alias in self.children(entry, "typedef")]
        if len(bases) == 1 and self.name(bases[0]).startswith("RegisterArray<"):
            address, stride, count = (value & 0xFFFFFFFF for value in self.template_values(bases[0]))
            # CCR[0] is CCR1 in the timers. Other arrays start at 0, such as ISER[0] for ISER0. One register of the SVD
            # consists of four elements of a byte array.
            first = 1 if name == "CCR" else 0
            step = max(1, 4 // stride)
            return [
                Register(f"{name}{first + index // step}", address + stride * index, fields)
                for index in range(0, count, step)
            ]
        if len(bases) == 1 and self.name(bases[0]).startswith("Register<"):
            (address,) = self.template_values(bases[0])
            return [Register(name, address & 0xFFFFFFFF, fields)]
        raise Unreadable(f"{name} in the peripheral at 0x{base:08X} is neither a Register nor a RegisterArray")

    def field(self, alias, register: str) -> Field:
        # The debug information contains no members of a field type, because no object has this type.
        form = re.fullmatch(r"Field<.*::(\w+), (\d+)U?, (\d+)U?>", self.name(self.type_of(alias)))
        if not form:
            raise Unreadable(f"{register}.{self.name(alias)} is not a Field")
        if form[1] != register:
            raise Unreadable(f"{register}.{self.name(alias)} says that it is of {form[1]}")
        return Field(self.name(alias), int(form[2]), int(form[3]))


def read_chip(path: pathlib.Path) -> list[Peripheral]:
    """Reads the output of print-chip-registers."""
    try:
        peripherals = json.loads(path.read_text())
        return [
            Peripheral(
                peripheral["name"],
                peripheral["base"],
                [
                    Register(
                        register["name"],
                        peripheral["base"] + register["offset"],
                        [Field(field["name"], field["position"], field["width"]) for field in register["fields"]],
                    )
                    for register in peripheral["registers"]
                ],
            )
            for peripheral in peripherals
        ]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise Unreadable(f"cannot read {path}, what print-chip-registers prints: {error!r}") from error


@dataclasses.dataclass
class SvdRegister:
    name: str
    address: int
    size_bits: int
    fields: dict[str, tuple[int, int]]  # name -> position, width


def read_svd_field(element) -> tuple[int, int]:
    """Position and width of a field, in any of the three notations of the CMSIS-SVD format."""
    if (offset := element.findtext("bitOffset")) is not None:
        return number(offset), number(element.findtext("bitWidth", "1"))
    if (low := element.findtext("lsb")) is not None:
        return number(low), number(element.findtext("msb")) - number(low) + 1
    if match := re.fullmatch(r"\[(\d+):(\d+)\]", element.findtext("bitRange", "")):
        return int(match[2]), int(match[1]) - int(match[2]) + 1
    raise Unreadable(f"the SVD's field {element.findtext('name')} has no position")


def read_svd(path: pathlib.Path) -> dict[str, tuple[int, list[SvdRegister]]]:
    """Maps the name of each peripheral to its base address and registers."""
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
