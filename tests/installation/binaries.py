"""How host binaries are protected against memory errors, as readelf shows it, and where they look for libraries."""

import dataclasses
import os
import pathlib
import re
import subprocess
from collections.abc import Iterator

from kinds import LIBRARY

ET_EXEC, ET_DYN = 2, 3
EM_ARM = 40
FUNCTION_BEGIN = b"\xf3\x0f\x1e\xfa"  # endbr64: a valid target of an indirect call
PROBES = (b"\x48\x83\x0c\x24\x00", b"\x48\xc7\x04\x24\x00\x00\x00\x00")  # stack probes of GCC and of Clang
# The C library alone adds fewer than 10 functions with `endbr64` to a binary.
FUNCTIONS_LEAST = 10

# Required properties of every binary, with their flags.
EVERYWHERE = {
    "position independent": "-fPIC, -pie",
    "read-only relocations": "-Wl,-z,relro",
    "immediate binding": "-Wl,-z,now",
    "stack protector": "-fstack-protector-strong",
    "marked functions": "-fcf-protection",
}
CHECKED_CALLS = "checked library calls"
ASSERTIONS = "library assertions"
STACK_PROBES = "stack probes"
# Only binaries with matching code have these properties.
IN_SOME = {
    CHECKED_CALLS: "-D_FORTIFY_SOURCE=3",
    ASSERTIONS: "-D_GLIBCXX_ASSERTIONS",
    STACK_PROBES: "-fstack-clash-protection",
}


@dataclasses.dataclass(frozen=True)
class Binary:
    file: str  # relative to the build folder; * where the name depends on the computer
    kind: str | None  # relative to the prefix, one of kinds.KINDS; None: not installed
    also: frozenset[str]  # subset of IN_SOME
    is_optional: bool = False

    def expected(self) -> dict[str, str]:
        return EVERYWHERE | {name: flag for name, flag in IN_SOME.items() if name in self.also}


def binary(file: str, kind: str | None, *also: str, is_optional: bool = False) -> Binary:
    return Binary(file, kind, frozenset(also), is_optional)


BINARIES = [
    binary("inkwell", r"bin/inkwell", CHECKED_CALLS, ASSERTIONS, STACK_PROBES),
    binary("inkwell-lab", r"bin/inkwell-lab", CHECKED_CALLS, ASSERTIONS, STACK_PROBES),
    binary("virtual-board", r"bin/virtual-board", CHECKED_CALLS, ASSERTIONS, STACK_PROBES),
    binary("inkwell-import", r"lib/inkwell/helpers/inkwell-import", CHECKED_CALLS, ASSERTIONS, STACK_PROBES),
    binary("libinkwell.so", LIBRARY + r"libinkwell\.so\.\d+\.\d+\.\d+", CHECKED_CALLS, ASSERTIONS, STACK_PROBES),
    binary("dropins/libHD.so", r"lib/inkwell/dropins/libHD\.so\.3\.4", ASSERTIONS),
    binary("dropins/libhdPhantom.so", r"lib/inkwell/dropins/libhdPhantom\.so"),
    binary("python/inkwell/_native.*.so", None, ASSERTIONS),
    binary("octave/inkwell_mex.mex", None, ASSERTIONS, is_optional=True),  # only with Octave
]


def readelf(option: str, path: pathlib.Path) -> str:
    return subprocess.run(["readelf", "-W", option, path], check=True, capture_output=True, text=True).stdout


def properties(path: pathlib.Path) -> set[str]:
    """Of EVERYWHERE and IN_SOME, those that the file shows."""
    header, segments, dynamic = (readelf(option, path) for option in ("-h", "-l", "-d"))
    imported = re.findall(r" UND ([\w.]+)", readelf("--dyn-syms", path))
    content = path.read_bytes()
    shown = {
        "position independent": re.search(r"Type: +DYN ", header),
        "read-only relocations": "GNU_RELRO" in segments,
        "immediate binding": re.search(r"\(FLAGS_1\) .*\bNOW\b", dynamic),
        "stack protector": "__stack_chk_fail" in imported,
        CHECKED_CALLS: any(re.fullmatch(r"__\w+_chk", name) for name in imported),
        ASSERTIONS: any("glibcxx_assert_fail" in name for name in imported),
    }
    if "X86-64" in header:
        shown["marked functions"] = content.count(FUNCTION_BEGIN) >= FUNCTIONS_LEAST
        shown[STACK_PROBES] = any(probe in content for probe in PROBES)
    else:  # other processors do not have these two instructions
        shown["marked functions"] = shown[STACK_PROBES] = True
    return {name for name, is_shown in shown.items() if is_shown}


def missing(path: pathlib.Path, binary: Binary) -> list[str]:
    shown = properties(path)
    return [f"{path} has no {name}: {flag}" for name, flag in binary.expected().items() if name not in shown]


def host_binaries(folder: pathlib.Path, left_out: pathlib.Path | None = None) -> Iterator[pathlib.Path]:
    """Programs and shared libraries for this computer, without object files, firmware and the folder `left_out`."""
    for parent, folders, files in os.walk(folder):
        folders[:] = [name for name in folders if name != "CMakeFiles" and pathlib.Path(parent, name) != left_out]
        for path in (pathlib.Path(parent, name) for name in files):
            if path.is_symlink() or not path.is_file():
                continue
            with path.open("rb") as file:
                begin = file.read(20)
            kind, machine = (int.from_bytes(begin[at:at + 2], "little") for at in (16, 18))
            if begin[:4] == b"\x7fELF" and kind in (ET_EXEC, ET_DYN) and machine != EM_ARM:
                yield path


def unsafe_folders(path: pathlib.Path) -> list[str]:
    """Elements of the search path for libraries that depend on the folder in which a program is started."""
    return [f"{path}: in {kind} {elements} not each element is absolute or begins with $ORIGIN"
            for kind, elements in re.findall(r"\((RPATH|RUNPATH)\) .*\[(.*)\]", readelf("-d", path))
            if not all(re.match(r"/|\$ORIGIN(/|$)", element) for element in elements.split(":"))]
