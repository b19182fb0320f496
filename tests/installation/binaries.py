"""Host binaries, and where they look for libraries."""

import os
import pathlib
import re
import subprocess
from collections.abc import Iterator

ET_EXEC, ET_DYN = 2, 3
EM_ARM = 40


def readelf(option: str, path: pathlib.Path) -> str:
    return subprocess.run(["readelf", "-W", option, path], check=True, capture_output=True, text=True).stdout


def host_binaries(folder: pathlib.Path) -> Iterator[pathlib.Path]:
    """Programs and shared libraries for this computer, without object files and firmware."""
    for parent, folders, files in os.walk(folder):
        folders[:] = [name for name in folders if name != "CMakeFiles"]
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
