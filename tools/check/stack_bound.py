#!/usr/bin/env python3
"""Bounds the stack of the firmware and compares it with the stack size of the linker script.

    tools/check/stack_bound.py build/board/inkwell.elf

The bound is the deepest path from the reset handler, plus all nested interrupts, plus the frame of a CPU fault. The
CPU fault handler then uses a separate stack. The bound requires that no function recurses; direct calls are checked for
recursion. Without recursion every call chain visits each function at most once, so the deepest such path is searched. A
virtual call may reach any function in this slot of any class.
"""

import argparse
import subprocess
import sys

from call_graph import Image, Unreadable, read_image, readable

# On exception entry the processor stacks 26 words, including the floating-point registers, and one alignment word.
EXCEPTION_FRAME_BYTES = 27 * 4

# fault_handler replaces an invalid stack, and enter_boot_loader switches to the boot loader's stack.
MAY_SET_STACK = {"cpu_fault_handler", "enter_boot_loader"}


def find_direct_cycle(image: Image, start: str) -> list[str]:
    """Returns a chain of direct calls that returns to its start, or an empty list."""
    done, path = set(), []

    def visit(name: str) -> list[str]:
        if name in path:
            return path[path.index(name):] + [name]
        if name in done:
            return []
        path.append(name)
        for target in sorted(image.targets(image.functions[name])[0]):
            if cycle := visit(target):
                return cycle
        path.pop()
        done.add(name)
        return []

    for name in sorted(image.reachable(start)):
        if cycle := visit(name):
            return cycle
    return []


def deepest_path(image: Image, start: str) -> tuple[int, list[str]]:
    """Bytes and functions of the deepest path from `start` that visits each function once."""
    loops = {}  # function -> whether a path from it can return to a function in a loop of indirect calls

    def can_loop(name: str) -> bool:
        if name not in loops:
            loops[name] = any(other in image.reachable(target)
                              for other in image.reachable(name)
                              for target in set.union(*image.targets(image.functions[other])))
        return loops[name]

    known: dict[str, tuple[int, list[str]]] = {}
    on_path: list[str] = []

    def visit(name: str) -> tuple[int, list[str]]:
        if name in known:
            return known[name]
        on_path.append(name)
        deepest: tuple[int, list[str]] = (0, [])
        for target in sorted(set.union(*image.targets(image.functions[name]))):
            if target not in on_path:
                deepest = max(deepest, visit(target), key=lambda path: path[0])
        on_path.pop()
        result = (image.functions[name].stack_bytes + deepest[0], [name, *deepest[1]])
        if not can_loop(name):
            known[name] = result  # independent of the path to the function
        return result

    return visit(start)


def main() -> int:
    parser = argparse.ArgumentParser(description="Bounds the stack of the firmware.")
    parser.add_argument("elf", help="the linked image")
    arguments = parser.parse_args()
    try:
        image = read_image(arguments.elf)
    except (OSError, subprocess.CalledProcessError, Unreadable, KeyError) as error:
        print(f"cannot read {arguments.elf} as the firmware's image: {error}", file=sys.stderr)
        return 2

    problems = []
    bound = EXCEPTION_FRAME_BYTES  # frame of a CPU fault
    print("stack, in bytes:")
    for start in ("reset_handler", *image.interrupts):
        if cycle := find_direct_cycle(image, start):
            problems.append("recursion: " + " -> ".join(cycle))
            continue
        used, path = deepest_path(image, start)
        bound += used + (EXCEPTION_FRAME_BYTES if start != "reset_handler" else 0)
        print(f"  {start}: {used}, by")
        for name, shown in zip(path, readable("\n".join(path)).splitlines()):
            print(f"    {image.functions[name].stack_bytes:5}  {shown}")
        for name in sorted(image.reachable(start) - MAY_SET_STACK):
            if image.functions[name].moves_stack:
                problems.append(f"{name} moves the stack by an amount that is not a constant")
    room = image.symbols["stack_top"] - image.symbols["stack_bottom"]
    print(f"  bound with {len(image.interrupts) + 1} exception frames of {EXCEPTION_FRAME_BYTES}: {bound} of {room}")
    if bound > room:
        problems.append(f"the stack needs {bound} bytes, but the linker script (boards/facts/stm32f405.ld) gives {room}")
    for problem in problems:
        print(f"ERROR: {readable(problem)}", file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
