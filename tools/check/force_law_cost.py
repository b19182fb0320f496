#!/usr/bin/env python3
"""Bounds the cycles of an image's force law per control period, and refuses a law that exceeds the limit.

    tools/check/force_law_cost.py build/board/inkwell.elf

The bound is the most expensive path through the law and all functions that it calls, in the linked image. Each
instruction costs its worst case in the conservative figures of docs/cycles.md, independent of its neighbors. The law
therefore never takes longer, and usually takes much less. Loops are refused, because their number of iterations is
unknown. The compiler unrolls loops with a constant number of up to 64 iterations.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tomllib

from call_graph import Function, read_functions, readable, source_location
from interrupt_rules import LEAVES, outer_loops, paths_of

# With three touched walls and a local model of three features, about 1050 of the 8400 cycles of a period remain. A
# force law may use 800 cycles; about 250 cycles pass between the start of the period and the start of the interrupt.
BUDGET_CYCLES = 800

COSTS = pathlib.Path(__file__).resolve().parents[2] / "boards/stm32f405/timing/costs.toml"
STEP = "step_force_law"


def read_costs() -> dict[str, int]:
    """Reads the conservative figures of the cycle model."""
    return {name: row["conservative"] for name, row in tomllib.loads(COSTS.read_text()).items()}


CONDITION = r"(?:eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)?"
LIST = re.compile(rf"(v?)(?:push|pop|ldm\w*|stm\w*){CONDITION}(?:\.w)?\t.*\{{(.*)\}}")
PAIR = re.compile(rf"(?:ldrd|strd){CONDITION}\t")
FLOAT_ACCESS = re.compile(rf"v(?:ldr|str){CONDITION}\t(\w)")
ACCESS = re.compile(r"(?:ldr|str)\w*(?:\.w)?\t")
ACCUMULATE = re.compile(r"v(?:n?ml[as]|fn?m[as])\w*\.")
ROOT_OR_QUOTIENT = re.compile(r"v(?:div|sqrt)\w*\.")
QUOTIENT = re.compile(r"[us]div")
MOVE_OF_TWO = re.compile(r"vmov\w*\t\w+, \w+, \w+")
JUMP = re.compile(rf"(?:b{CONDITION}|bl|cbn?z)(?:\.[nw])?\t.* <")
JUMP_TO_REGISTER = re.compile(rf"(?:bx|blx){CONDITION}\t|mov\tpc")
TABLE = re.compile(r"tb[bh]\t")
PROGRAM_COUNTER = re.compile(r"\{.*pc\}|(?:ldr)\S*\tpc,")
SYSTEM = re.compile(r"(?:mrs|msr|vmrs|vmsr|cps|dmb|dsb|isb)")


def words_of(registers: str) -> int:
    total = 0
    for part in registers.replace(" ", "").split(","):
        first, _, last = part.partition("-")
        count = int(last[1:]) - int(first[1:]) + 1 if last else 1
        total += count * (2 if first.startswith("d") else 1)
    return total


def price(text: str, costs: dict[str, int]) -> int:
    """Worst-case cycles of an instruction. Each word of an access delays an instruction fetch by one cycle. A jump
    starts with a fetch."""
    cycles = 0
    if PROGRAM_COUNTER.search(text):
        cycles += costs["refill_load"] + 1
    if several := LIST.match(text):
        words = words_of(several[2])
        base = costs["float_multiple_base"] if several[1] else costs["multiple_base"]
        return cycles + base + 2 * words + costs["address_from_previous"]
    if PAIR.match(text):
        return cycles + costs["multiple_base"] + 4 + costs["address_from_previous"]
    if single := FLOAT_ACCESS.match(text):
        words = 2 if single[1] == "d" else 1
        return cycles + costs["float_transfer"] + 2 * words - 1 + costs["address_from_previous"]
    if ACCESS.match(text):
        beyond = max(costs["load_stall"], costs["store_before_load"] + costs["store_register_offset"] - 1)
        return cycles + 1 + beyond + costs["address_from_previous"] + 1
    if TABLE.match(text):
        return costs["table_branch"] + 1
    if JUMP_TO_REGISTER.match(text):
        return 1 + costs["refill_register"] + 1
    if JUMP.match(text):
        return 1 + costs["refill_immediate"] + 1
    if ROOT_OR_QUOTIENT.match(text):
        return 1 + costs["float_divide"] + costs["float_result_used_next"]
    if QUOTIENT.match(text):
        return costs["divide_longest"]
    if ACCUMULATE.match(text):
        return costs["float_multiply_accumulate"] + costs["float_result_used_next"]
    if MOVE_OF_TWO.match(text):
        return costs["float_transfer"]
    if SYSTEM.match(text):
        return max(costs["barrier"] + costs["refill_immediate"], costs["system_register"])
    return 1 + (costs["float_result_used_next"] if text.startswith("v") else 0)


CONDITIONAL_LEAVE = re.compile(r"(?:pop|bx|ldm\w*?)(?:eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)(?:\.w)?\t")


class Refused(Exception):
    """The law has no bound; the message states the reason and the remedy."""


class Bound:
    """Worst-case cycles of functions, computed once per function."""

    def __init__(self, functions: dict[str, Function], elf: str):
        self.functions, self.elf = functions, elf
        self.costs = read_costs()
        self.known: dict[str, int] = {}

    def of(self, name: str, callers: tuple[str, ...] = ()) -> int:
        if name in callers:
            raise Refused(f"the force law calls itself: {' -> '.join((*callers, name))}. Write it without recursion.")
        if name not in self.known:
            self.known[name] = self.dearest_path(self.functions[name], (*callers, name))
        return self.known[name]

    def dearest_path(self, function: Function, callers: tuple[str, ...]) -> int:
        paths = paths_of(function)
        addresses = [address for address, _ in function.instructions]
        for i, (address, text) in enumerate(function.instructions):
            if CONDITIONAL_LEAVE.match(text):
                paths[address] = paths[address] | set(addresses[i + 1:i + 2])
            if LEAVES.match(text) and text.startswith("ldr") and "[sp]" not in text:  # a load from the stack is a return
                paths[address] = set(addresses[i + 1:])  # a jump through a table
        if loops := outer_loops(paths):
            raise Refused(
                f"the force law has a loop at {source_location(self.elf, min(loops[0]))} of which the compiler does not know how often it "
                "runs. Let it run a constant number of times, at most 64, with a condition inside for what must not be done.")
        calls = self.calls(function)
        dearest: dict[int, int] = {}
        for address, text in reversed(function.instructions):
            # Not every jump to a lower address forms a loop. visit() first determines the cost of the jump target.
            self.visit(address, dict(function.instructions), paths, calls, callers, dearest)
        return dearest[addresses[0]]

    def visit(self, address, texts, paths, calls, callers, dearest) -> None:
        waiting = [address]
        while waiting:
            here = waiting[-1]
            open_paths = [to for to in paths[here] if to not in dearest]
            if open_paths:
                waiting += open_paths
                continue
            called = self.of(calls[here], callers) if here in calls else 0
            dearest[here] = price(texts[here], self.costs) + called + max((dearest[to] for to in paths[here]), default=0)
            waiting.pop()

    def calls(self, function: Function) -> dict[int, str]:
        """Called functions, including jump targets, by the address of the instruction."""
        found = {}
        for address, text in function.instructions:
            target = re.search(r"\t[0-9a-f]+ <([^>+]+)>", text)
            if target and target[1] in self.functions and (target[1] != function.name or text.startswith("bl\t")):
                found[address] = target[1]
        return found


def main() -> int:
    parser = argparse.ArgumentParser(description="Bounds the cycles of an image's force law.")
    parser.add_argument("elf", help="the linked image")
    arguments = parser.parse_args()
    try:
        functions = read_functions(arguments.elf)
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"cannot read {arguments.elf} as an image: {error}", file=sys.stderr)
        return 2
    try:
        step = next((name for name in functions if STEP in name), None)
        if step is None:
            raise Refused(f"{arguments.elf} has no function {STEP}.")
        cycles = Bound(functions, arguments.elf).of(step)
        print(f"force law: at most {cycles} of {BUDGET_CYCLES} cycles in a control period")
        if cycles > BUDGET_CYCLES:
            raise Refused(f"the force law may take {cycles} cycles in a control period, but only {BUDGET_CYCLES} are left for "
                          "it. Do less in it, or spread it over several periods with its State.")
    except Refused as refusal:
        print(f"ERROR: {readable(str(refusal))}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
