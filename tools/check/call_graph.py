"""Functions of an ARM Thumb image with their stack use and calls, from its disassembly.

The analysis reads the linked image, so it sees inlined and split functions and library code.
"""

import dataclasses
import re
import struct
import subprocess


class Unreadable(Exception):
    """The image contains something that the analysis does not support; the message states what and where."""


@dataclasses.dataclass
class Function:
    name: str
    address: int
    stack_bytes: int = 0
    calls: set[str] = dataclasses.field(default_factory=set)  # direct calls, including jumps into other functions
    virtual_slots: set[int] = dataclasses.field(default_factory=set)  # byte offsets into a virtual table
    calls_any_pointer: bool = False  # through a pointer of unknown origin
    moves_stack: bool = False  # by an amount that is not a constant
    divides: list[str] = dataclasses.field(default_factory=list)  # addresses of divisions and square roots
    instructions: list[tuple[int, str]] = dataclasses.field(default_factory=list)  # (address, text)
    words: list[int] = dataclasses.field(default_factory=list)  # constants between the instructions


@dataclasses.dataclass
class Image:
    functions: dict[str, Function]
    virtual_tables: list[list[str]]  # functions of each class's virtual table, in slot order
    constructors: list[str]  # called by the startup code
    interrupts: list[str]  # handlers of the vector table, except reset and CPU fault handlers
    pended: str  # handler that only PendSV uses, or an empty string
    symbols: dict[str, int]
    sizes: dict[str, int]  # bytes of each symbol
    elf: str

    def source_location(self, address: int) -> str:
        return source_location(self.elf, address)

    def location_of_call(self, function: Function, target: str) -> str:
        """Returns FILE:LINE of the first direct call, or of the start of the function."""
        names = (f"<{target}>", f"<__{target}_veneer>")
        calls = (address for address, text in function.instructions if text.endswith(names))
        return self.source_location(next(calls, function.address))

    def targets(self, function: Function) -> tuple[set[str], set[str]]:
        """The functions that a function calls directly, and those that it may call through pointers."""
        indirect = {table[slot // 4] for slot in function.virtual_slots for table in self.virtual_tables
                    if slot // 4 < len(table)}
        if function.calls_any_pointer:
            indirect.update(name for table in self.virtual_tables for name in table)
            indirect.update(self.constructors)
        return function.calls, indirect & self.functions.keys()

    def reachable(self, start: str, without: frozenset[str] = frozenset()) -> set[str]:
        found, waiting = set(), [start]
        while waiting:
            name = waiting.pop()
            if name not in found and name not in without:
                found.add(name)
                waiting.extend(set.union(*self.targets(self.functions[name])))
        return found


def run(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def source_location(elf: str, address: int) -> str:
    """Returns FILE:LINE of an instruction, or its address if the image has no debug information. For an inlined library
    function, returns the location of its call."""
    lines = [line.split(" ")[0] for line in run("arm-none-eabi-addr2line", "-i", "-e", elf, f"{address:#x}").splitlines()]
    own = [line for line in lines if not line.startswith(("/usr/", "??"))]
    return own[0] if own else f"{address:#x}"


def readable(text: str) -> str:
    """Replaces each symbol in a text by the C++ name of its function, without parameters."""
    return subprocess.run(["arm-none-eabi-c++filt", "-p"], input=text, check=True, capture_output=True, text=True).stdout


# ---- stack of one instruction ----------------------------------------------------------------------------------


def listed_registers(text: str) -> int:
    """Bytes of a register list such as {r4, r5, lr} or {d8-d10}."""
    total = 0
    for part in text.strip("{}").replace(" ", "").split(","):
        first, _, last = part.partition("-")
        count = int(last[1:]) - int(first[1:]) + 1 if last else 1
        total += count * (8 if first.startswith("d") else 4)
    return total


PUSH = re.compile(r"(?:v?push|(?:v?stmdb)\tsp!,)\s*(\{.*\})")
SUBTRACT = re.compile(r"sub(?:\.w|w)?\tsp, (?:sp, )?#(\d+)")
STORE_DOWN = re.compile(r"strd?(?:\.w)?\t.*\[sp, #-(\d+)\]!")
STACK_BY_REGISTER = re.compile(r"(?:sub(?:\.w)?\tsp, (?:sp, )?r\d+|mov\tsp, r\d+|msr\tMSP)")


def stack_of(instruction: str) -> int:
    if match := PUSH.match(instruction):
        return listed_registers(match[1])
    if match := SUBTRACT.match(instruction):
        return int(match[1])
    if match := STORE_DOWN.match(instruction):
        return int(match[1])
    return 0


# ---- functions -------------------------------------------------------------------------------------------------

HEADING = re.compile(r"^([0-9a-f]{8}) <(.+)>:$")
INSTRUCTION = re.compile(r"^ *([0-9a-f]+):\t(.*?)(?:\s+@.*)?$")
BRANCH = re.compile(r"(?:bl?|b[a-z]{2})(?:\.[nw])?\t[0-9a-f]+ <([^>+]+)(\+0x[0-9a-f]+)?>|cbn?z\t\w+, [0-9a-f]+ <([^>+]+)")
INDIRECT = re.compile(r"(?:blx|bx)\t(r\d+|ip|fp|sl|sb)|mov\tpc, (\w+)")
LOAD = re.compile(r"ldr(?:\.w)?\t(\w+), \[(\w+)(?:, #(\d+))?\]")
WORD = re.compile(r"\.word\t0x([0-9a-f]{8})")
# A veneer is a function that the linker inserts for a call beyond the range of the instruction.
VENEER = re.compile(r"__.+_veneer")
DIVIDE = re.compile(r"(?:v?sqrt|vdiv|vsqrt|[su]div)\b")


def read_functions(elf: str) -> dict[str, Function]:
    functions: dict[str, Function] = {}
    aliases: dict[int, Function] = {}
    function: Function | None = None
    loads: dict[str, int] = {}  # register -> offset of the last load into it in this function
    for line in run("arm-none-eabi-objdump", "-d", "--no-show-raw-insn", elf).splitlines():
        if heading := HEADING.match(line):
            address = int(heading[1], 16)
            function = functions[heading[2]] = aliases.setdefault(address, Function(heading[2], address))
            loads = {}
            continue
        instruction = INSTRUCTION.match(line)
        if function is None or instruction is None:
            continue
        if word := WORD.match(instruction[2]):
            function.words.append(int(word[1], 16))
            continue
        text = instruction[2]
        function.instructions.append((int(instruction[1], 16), text))
        function.stack_bytes += stack_of(text)
        if STACK_BY_REGISTER.match(text):
            function.moves_stack = True
        if DIVIDE.match(text):
            function.divides.append(f"{instruction[1]}: {text}".replace("\t", " "))
        if load := LOAD.fullmatch(text):
            loads[load[1]] = int(load[3] or 0)
        if branch := BRANCH.match(text):
            target = branch[1] or branch[3]
            if target != function.name and not branch[2]:
                function.calls.add(target)
        elif indirect := INDIRECT.match(text):
            register = indirect[1] or indirect[2]
            if register in loads:
                function.virtual_slots.add(loads[register])
            else:
                function.calls_any_pointer = True
    return without_veneers(functions, aliases)


def without_veneers(functions: dict[str, Function], by_address: dict[int, Function]) -> dict[str, Function]:
    """Replaces each call through a veneer by a call of the veneer's target."""
    targets = {name: by_address[function.words[0] & ~1].name
               for name, function in functions.items() if VENEER.fullmatch(name)}
    for function in functions.values():
        function.calls = {targets.get(name, name) for name in function.calls}
    return {name: function for name, function in functions.items() if name not in targets}


def read_words(elf: str, address: int, count: int) -> list[int]:
    """Reads words of the image at a flash address."""
    with open(elf, "rb") as file:
        data = file.read()
    header_offset, = struct.unpack_from("<I", data, 28)
    header_size, header_count = struct.unpack_from("<HH", data, 42)
    for i in range(header_count):
        _, offset, _, physical, size = struct.unpack_from("<5I", data, header_offset + i * header_size)
        if physical <= address and address + 4 * count <= physical + size:
            return list(struct.unpack_from(f"<{count}I", data, offset + address - physical))
    raise Unreadable(f"0x{address:08x} is not in the image")


PENDSV = 14  # index in the vector table


def read_interrupts(elf: str, by_address: dict[int, str]) -> tuple[list[str], str]:
    section = re.search(r"^\.vectors\s+(\d+)\s+(\d+)$", run("arm-none-eabi-size", "-A", elf), re.MULTILINE)
    if section is None:
        raise Unreadable("the image has no section .vectors")
    words = read_words(elf, int(section[2]), int(section[1]) // 4)
    handlers = [by_address.get(word & ~1, "") for word in words]
    pended = handlers[PENDSV] if len(handlers) > PENDSV and handlers.count(handlers[PENDSV]) == 1 else ""
    return sorted(set(handlers) - {"", "reset_handler", "cpu_fault_handler"}), pended


def read_image(elf: str) -> Image:
    functions = read_functions(elf)
    by_address = {function.address: name for name, function in functions.items()}
    symbols, sizes, tables = {}, {}, []
    for line in run("arm-none-eabi-nm", "-S", elf).splitlines():
        parts = line.split()
        symbols[parts[-1]] = int(parts[0], 16)
        sizes[parts[-1]] = int(parts[1], 16) if len(parts) == 4 else 0
        if parts[-1].startswith("_ZTV") and len(parts) == 4:
            # The first slot follows two words, the offset to top and the type information.
            words = read_words(elf, int(parts[0], 16), int(parts[1], 16) // 4)[2:]
            tables.append([by_address.get(word & ~1, "") for word in words])
    begin, end = symbols["constructors_begin"], symbols["constructors_end"]
    constructors = [by_address[word & ~1] for word in read_words(elf, begin, (end - begin) // 4)] if end > begin else []
    return Image(functions, tables, constructors, *read_interrupts(elf, by_address), symbols, sizes, elf)
