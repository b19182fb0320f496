"""Rules for code that runs in interrupts, checked in the linked image.

The section .interrupt_text contains exactly the functions that a handler can reach. Its code does not wait, divide,
call through a pointer, or read the flash. The section is copied to RAM, because an erase blocks every access to the
flash and would delay interrupts. Only the user's force law may divide, because tools/check/force_law_cost.py limits its
cycles. PendSV's handler has the lowest priority and counts as part of the main loop. No handler returns with a pending
store (core erratum 838869).
"""

import re

from call_graph import INDIRECT, Function, Image

FLASH = range(0x08000000, 0x08100000)

# Library functions that the compiler calls implicitly, as whole symbol names.
LIBRARY = {
    r"__aeabi_u?ldivmod|__u?(div|mod|divmod)di[34]": "a 64-bit division",
    r"__aeabi_u?idiv(mod)?|__aeabi_(ul|l)2f|__aeabi_f2u?lz": "arithmetic in software",
}

# ---- counters --------------------------------------------------------------------------------------------------

CALL = re.compile(r"blx?\t")
# Instructions that change a register by a step, such as "adds r3, #1", "sub.w r3, r3, r5" and "lsls r3, r3, #1".
STEP = re.compile(r"(?:add|sub|lsl|lsr|asr)[sw]?(?:\.[nw])?\t(\w+), (?:\1, )?(?:#\d+|r\d+)$")
STEP_OF_ACCESS = re.compile(r"\w+(?:\.\w+)?\t.*\[(\w+)(?:\], #-?\d+|, #-?\d+\]!)$|v?(?:ld|st)m\w+(?:\.w)?\t(\w+)!")
READS_ONLY = re.compile(r"(?:v?st|cm[pn]|tst|teq|v?push|vcmp|it|nop|b|cb|dmb|dsb|isb|pld|vmsr|msr)")
FIRST_TWO = re.compile(r"(?:ldrd|[us]mull|[us]mlal|vmov)\S*\t(\w+), (\w+)")
FIRST = re.compile(r"\S+\t(\w+)")
LIST = re.compile(r"(?:ldm|pop).*\{(.*)\}")
ACCESS = re.compile(r"(ldr|str)\S*\t.*(\[[^\]]*\])$")
CALL_SPOILS = {"r0", "r1", "r2", "r3", "ip", "lr"}


def steps_of(text: str) -> set[str]:
    step, access = STEP.fullmatch(text), STEP_OF_ACCESS.match(text)
    return ({step[1]} if step else set()) | ({access[1] or access[2]} if access else set())


def written_otherwise(text: str) -> set[str]:
    """Registers that an instruction changes by anything other than a step."""
    if CALL.match(text):
        return CALL_SPOILS
    if loaded := LIST.match(text):
        return set(loaded[1].replace(" ", "").split(","))
    if READS_ONLY.match(text):
        return set()
    first, two = FIRST.match(text), FIRST_TWO.match(text)
    return (set(two.groups()) if two else {first[1]} if first else set()) - steps_of(text)


def counts(loop: list[str], own: list[str]) -> bool:
    """True if a loop contains a counter: a register in `own` (the loop without inner loops) that changes only by steps,
    or a word in memory that is loaded and stored."""
    steps = set().union(*map(steps_of, own)) - set().union(*map(written_otherwise, loop))
    addresses = {kind: {access[2] for access in map(ACCESS.match, loop) if access and access[1] == kind} for kind in ("ldr", "str")}
    return bool(steps or addresses["ldr"] & addresses["str"])


# ---- loops -----------------------------------------------------------------------------------------------------

JUMP = re.compile(r"(?:b([a-z]{2})?(?:\.[nw])?\t|(cbn?z)\t\w+, )([0-9a-f]+) <")
TABLE = re.compile(r"tb[bh]\t")
CONDITION = "eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le"
LEAVES = re.compile(rf"bx(?:{CONDITION})?\t|(?:pop|ldm\w*(?:\.w)?\t\w+!,).*pc\}}|(?:ldr|mov)(?:\.w)?\tpc,|udf")
MAY_LEAVE = re.compile(rf"(?:bx|pop|ldm\w*|ldr|mov)(?:{CONDITION})(?:\.w)?\t")

Paths = dict[int, set[int]]  # from the address of an instruction to the addresses of its possible successors


def paths_of(function: Function) -> Paths:
    addresses = [address for address, _ in function.instructions]
    paths: Paths = {}
    for i, (address, text) in enumerate(function.instructions):
        following, later = set(addresses[i + 1:i + 2]), set(addresses[i + 1:])
        if jump := JUMP.match(text):
            conditional = jump[1] or jump[2]
            paths[address] = {int(jump[3], 16)} & set(addresses) | (following if conditional else set())
        elif LEAVES.match(text) and not MAY_LEAVE.match(text):
            paths[address] = set()
        else:
            paths[address] = later if TABLE.match(text) else following
    return paths


def reached_from(start: int, paths: Paths) -> set[int]:
    found, waiting = set(), list(paths[start])
    while waiting:
        address = waiting.pop()
        if address not in found:
            found.add(address)
            waiting.extend(paths[address])
    return found


def outer_loops(paths: Paths) -> list[set[int]]:
    """Strongly connected sets of instructions."""
    reached = {address: reached_from(address, paths) for address in paths}
    loops: list[set[int]] = []
    for address in paths:
        if address in reached[address] and not any(address in loop for loop in loops):
            loops.append({other for other in reached[address] if address in reached[other]})
    return loops


def endless_loops(function: Function, paths: Paths) -> list[set[int]]:
    """Loops without a counter, including inner loops. Only other code or hardware can end such a loop."""
    found = []
    texts = dict(function.instructions)
    for loop in outer_loops(paths):
        entered = {to for address in paths.keys() - loop for to in paths[address]} & loop
        begin = min(entered or loop)
        inside = {address: (paths[address] & loop) - {begin} for address in loop}
        inner = set().union(*outer_loops(inside))
        if not counts([texts[address] for address in loop], [texts[address] for address in loop - inner]):
            found.append(loop)
        found += endless_loops(function, inside)
    return found


def waits(function: Function) -> list[int]:
    """Addresses at which the function waits: sleep instructions, and starts of loops without a counter."""
    asleep = [address for address, text in function.instructions if text.startswith(("wfi", "wfe"))]
    return asleep + [min(loop) for loop in endless_loops(function, paths_of(function))]


# ---- pending stores ----------------------------------------------------------------------------------------------

STORES = re.compile(r"v?st|v?push|blx?\t")  # including calls, which may store


def returns_before_stores_end(function: Function) -> bool:
    """True if a path leads from a store to the function's end without a DSB, or into another function."""
    texts, paths = dict(function.instructions), paths_of(function)
    if any((jump := JUMP.match(text)) and int(jump[3], 16) not in texts for text in texts.values()):
        return True
    waiting = [address for address, text in texts.items() if STORES.match(text)]
    seen = set(waiting)
    while waiting:
        address = waiting.pop()
        if LEAVES.match(texts[address]) and not texts[address].startswith("udf"):
            return True
        further = {other for other in paths[address] if not texts[other].startswith("dsb")} - seen
        seen |= further
        waiting.extend(further)
    return False


# Functions of the installed force law.
LAW_FUNCTIONS = ("step_force_law", "reset_force_law")

# ---- the rules -------------------------------------------------------------------------------------------------


def meaning_of(name: str) -> str:
    return next((f", {meaning}," for pattern, meaning in LIBRARY.items() if re.fullmatch(pattern, name)), "")


def leaves(image: Image, name: str, section: range) -> list[str]:
    """Calls from a function of the section to a function outside, and calls with unknown targets."""
    function = image.functions[name]
    problems = [
        f"{name} runs in an interrupt and calls {target}{meaning_of(target)} which lies outside .interrupt_text: "
        f"mark it INKWELL_INTERRUPT or do without it (call at {image.location_of_call(function, target)})"
        for target in sorted(function.calls)
        if image.functions[target].address not in section
    ]
    problems += [
        f"{name} runs in an interrupt and calls through a pointer at {address:x}"
        for address, text in function.instructions
        if INDIRECT.match(text)
    ]
    return problems


# MOVT sets the upper half word of a register.
UPPER_HALF = re.compile(r"movt\t\w+, #(\d+)")


def reads_flash(function: Function) -> bool:
    """True if a function contains a flash address, as a word or as two half words."""
    upper_halves = [int(upper[1]) for _, text in function.instructions if (upper := UPPER_HALF.match(text))]
    return any(address in FLASH for address in (*function.words, *(half << 16 for half in upper_halves)))


def broken_interrupt_rules(image: Image, section: range) -> list[str]:
    interrupts = [name for name in image.interrupts if name != image.pended]
    reached = set().union(*map(image.reachable, interrupts))
    problems = [
        f"{name} lies in the flash, which interrupts must not need"
        for name in ("interrupt_vectors", "interrupt_text_begin", "interrupt_tables_begin")
        if image.symbols[name] in FLASH
    ] + [
        f"{name} handles an interrupt but lies outside .interrupt_text: mark it INKWELL_INTERRUPT"
        for name in interrupts
        if image.functions[name].address not in section
    ]
    problems += [
        f"{name} lies in .interrupt_text but no interrupt calls it: take its mark away"
        for name, function in sorted(image.functions.items())
        if function.address in section and name not in reached
    ]
    problems += [
        f"{name} handles an interrupt and may return with a store under way: end it by drivers::finish_stores()"
        for name in image.interrupts
        if returns_before_stores_end(image.functions[name])
    ]
    laws = [name for name in image.functions if "step_force_law" in name]
    priced = set().union(*map(image.reachable, laws))
    for name in sorted(reached):
        function = image.functions[name]
        if function.address not in section:
            continue  # its call is the error
        problems += leaves(image, name, section)
        if reads_flash(function):
            problems.append(f"{name} runs in an interrupt and reads the flash: its tables belong into .interrupt_tables")
        if name not in priced:
            problems += [f"division in an interrupt, in {name} at {address}" for address in function.divides]
        problems += [
            f"{name} runs in an interrupt and waits at {image.source_location(address)}" for address in waits(function)
        ]
    return problems
