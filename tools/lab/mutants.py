"""Mutants of C++ sources: copies with one piece of code removed or changed.

Register mutants remove a register write, or one field or flag of it. Sampled mutants remove a statement or invert a
condition in any other code. Watch mutants remove one monitored fault. Safety mutants systematically remove every
statement, invert every condition, remove every operand of an "and" or "or" except the first, and change every state
transition.
"""

import random
import re
from dataclasses import dataclass
from pathlib import Path

# Calls that write registers: "RCC::CR::modify(", "Timer::CCR::write(", "Line::enable(", "connect<Bridges, ...>(".
REGISTER_WRITE = re.compile(
    r"(?<![\w:.>])(?:\w+::)+(?:write|modify|enable|set_high|set_low|start)\("
    r"|(?<![\w:.>])(?:connect|connect_analog|start_clocks_of|start_clock_of_stream|set_up\w*)(?:<[^;(]*>)?\(")
# A field value in the arguments, such as "CR::PLLON(1)".
FIELD = re.compile(r"(?:typename )?(?:\w+::)+\w+\(")
# A store instruction in an assembly handler.
ASSEMBLY_STORE = re.compile(r'^\s*"(?:str|cpsid|dsb)\b[^"]*"', re.MULTILINE)
FUNCTION_HEAD = re.compile(r"\)\s*(?:const\s*)?(?:noexcept\s*)?[{:]|\)\s*(?:const\s*)?override")
NOTHING = "static_cast<void>(0)"


@dataclass(frozen=True)
class Mutant:
    path: str  # relative to the top of the source tree
    line: int  # line of the change, counted from 1
    what: str  # removed or inverted code; with the path it identifies the mutant independently of line numbers
    begin: int  # replaced characters of the file
    end: int
    text: str

    def applied_to(self, source: str) -> str:
        return source[: self.begin] + self.text + source[self.end :]


def matching(source: str, opening: int) -> int:
    """Returns the position after the bracket that closes the bracket at `opening`."""
    depth = 0
    for i in range(opening, len(source)):
        depth += source[i] in "([{"
        depth -= source[i] in ")]}"
        if depth == 0:
            return i + 1
    raise ValueError("brackets do not match")


def split(source: str, begin: int, end: int, separator: str) -> list[tuple[int, int]]:
    """Returns the parts between separators outside brackets, without surrounding white space."""
    parts, depth, start = [], 0, begin
    for i in range(begin, end):
        depth += source[i] in "([{"
        depth -= source[i] in ")]}"
        if depth == 0 and source[i] == separator:
            parts.append((start, i))
            start = i + 1
    parts.append((start, end))
    stripped = []
    for first, last in parts:
        text = source[first:last]
        stripped.append((first + len(text) - len(text.lstrip()), last - (len(text) - len(text.rstrip()))))
    return [part for part in stripped if part[0] < part[1]]


def in_one_line(text: str) -> str:
    return re.sub(r"\s+", " ", text).strip()


def register_mutants(path: str, source: str) -> list[Mutant]:
    """Register mutants of one file, in the order of its lines."""
    mutants = []

    def add(what: str, begin: int, end: int, text: str) -> None:
        mutants.append(Mutant(path, source.count("\n", 0, begin) + 1, in_one_line(what), begin, end, text))

    for found in REGISTER_WRITE.finditer(source):
        line_begin = source.rfind("\n", 0, found.start()) + 1
        if source[line_begin : found.start()].lstrip().startswith(("//", "#", "template", "using", "void ", "bool ")):
            continue
        end = matching(source, found.end() - 1)
        if not source[end:].lstrip().startswith(";") or FUNCTION_HEAD.match(source[end - 1 :]):
            continue  # a declaration, or part of an expression
        statement = source[found.start() : end]
        add(f"without {statement}", found.start(), end, NOTHING)
        if not re.search(r"(?:write|modify)\($", found.group()):
            continue
        arguments = split(source, found.end(), end - 1, ",")
        for i, (first, last) in enumerate(arguments):
            if len(arguments) > 1 and FIELD.match(source, first, last):
                others = ", ".join(source[a:b] for k, (a, b) in enumerate(arguments) if k != i)
                add(f"{found.group()}...) without {source[first:last]}", found.end(), end - 1, others)
            flags = split(source, first, last, "|")
            for k, (a, b) in enumerate(flags):
                if len(flags) > 1:
                    others = " | ".join(source[c:d] for m, (c, d) in enumerate(flags) if m != k)
                    add(f"{found.group()}...) without {source[a:b]}", first, last, others)
    for found in ASSEMBLY_STORE.finditer(source):
        begin = found.start() + len(found.group()) - len(found.group().lstrip())
        add(f"without {source[begin:found.end()]}", begin, found.end(), '"nop \\n"')
    return mutants


STATEMENT = re.compile(r"^[ ]{2,}(?!return\b|using\b|case\b|else\b|static_assert|for\b|throw\b|break\b|const\b|constexpr\b|auto\b)"
                       r"(?:[\w:.\->\[\]]+(?:\([^;{}]*\))? (?:[-+*/|&^]?=) [^;{}]+|[\w:.\->]+\([^;{}]*\));$", re.MULTILINE)
CONDITION = re.compile(r"\bif \(")


def other_mutants(path: str, source: str) -> list[Mutant]:
    mutants = []
    for found in STATEMENT.finditer(source):
        begin = found.start() + len(found.group()) - len(found.group().lstrip())
        line = source.count("\n", 0, begin) + 1
        mutants.append(Mutant(path, line, in_one_line(f"without {source[begin:found.end()]}"), begin, found.end() - 1, NOTHING))
    for found in CONDITION.finditer(source):
        end = matching(source, found.end() - 1)
        condition = source[found.end() : end - 1]
        if ";" in condition or source[: found.start()].endswith("constexpr "):
            continue
        line = source.count("\n", 0, found.start()) + 1
        mutants.append(Mutant(path, line, in_one_line(f"if (not ({condition}))"), found.end(), end - 1, f"!({condition})"))
    return mutants


NOT_WATCHED = "without watching "
WATCH = re.compile(r'^ +\{ fault = "(?P<fault>\w+)", monitored_in = (?P<states>\[[^\[\]]*\]), ', re.MULTILINE)


def watch_mutants(path: str, source: str) -> list[Mutant]:
    """Mutants of the table of monitored faults: each row is active in no state."""
    return [Mutant(path, source.count("\n", 0, found.start("fault")) + 1, NOT_WATCHED + found["fault"],
                   found.start("states"), found.end("states"), "[]")
            for found in WATCH.finditer(source)]


WAY = re.compile(r'^ +\{ from = "(?P<from>\w+)", to = "(?P<to>\w+)", needs = (?P<needs>\[[^\[\]]*\]), '
                 r'unless = (?P<unless>\[[^\[\]]*\]) \},$', re.MULTILINE)


def way_mutants(path: str, source: str) -> list[Mutant]:
    """Mutants of the state transition table: each transition is removed, or its blocking events are ignored."""
    mutants = []
    for found in WAY.finditer(source):
        line = source.count("\n", 0, found.start("from")) + 1
        way = f"{found['from']} to {found['to']} by {found['needs']}"
        mutants.append(Mutant(path, line, f"without the way {way}", found.start("to"), found.end("to"), found["from"]))
        if found["needs"] != "[]" and found["unless"] != "[]":
            mutants.append(Mutant(path, line, f"{way} without unless {found['unless']}", found.start("unless"),
                                  found.end("unless"), "[]"))
    return mutants


OPERATOR = re.compile(r" (?:&&|\|\|) ")


def operand_mutants(path: str, source: str) -> list[Mutant]:
    """Mutants without one operand of an "and" or "or"; the first operand always remains."""
    mutants = []
    for found in OPERATOR.finditer(source):
        line_begin = source.rfind("\n", 0, found.start()) + 1
        if source[line_begin : found.start()].lstrip().startswith(("//", "static_assert", "requires", "template")):
            continue
        end = found.end()
        while source[end] not in ",;?)}" and not OPERATOR.match(source, end):
            end = matching(source, end) if source[end] in "([{" else end + 1
        while source[end - 1].isspace():
            end -= 1
        mutants.append(Mutant(path, source.count("\n", 0, found.start()) + 1,
                              in_one_line(f"without{source[found.start():end]}"), found.start(), end, ""))
    return mutants


def safety_mutants(path: str, source: str) -> list[Mutant]:
    return sorted(other_mutants(path, source) + operand_mutants(path, source) + way_mutants(path, source),
                  key=lambda mutant: (mutant.begin, mutant.what))


def sample(mutants: list[Mutant], count: int, seed: int) -> list[Mutant]:
    chosen = random.Random(seed).sample(mutants, min(count, len(mutants)))
    return sorted(chosen, key=lambda mutant: (mutant.path, mutant.begin))


def sources(top: Path, folders: list[str]) -> list[Path]:
    return sorted(path for folder in folders for path in (top / folder).rglob("*.[ch]pp"))
