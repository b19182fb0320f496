"""The folders of the tree and their dependencies: documented in docs/architecture.md, linked by CMake, and included.

CMake writes target-graph.txt into every build directory (tools/cmake/target_graph.cmake). The PC build does not contain
the drivers, and the board build does not contain the window, so both are read.
"""

import dataclasses
import pathlib
import re

ROOTS = ("protocol", "boards", "firmware", "host")  # the table must list every folder of these
SOURCES = {".cpp", ".hpp"}


class Unreadable(Exception):
    """The table or a graph has another format than expected; the message states the location and the remedy."""


@dataclasses.dataclass
class Row:
    """A row of the table."""

    folder: str
    purpose: str
    uses: set[str]
    libraries: set[str]


@dataclasses.dataclass
class Target:
    name: str
    folder: str
    links: list[str]
    published: list[pathlib.Path]  # headers for other folders; if empty, all headers of the folder


def read_table(document: str) -> dict[str, Row]:
    """The rows of the folder table, by folder. The last part of a path names a used folder."""
    rows = re.findall(r"^\| `([^`]+)/` \| ([^|]*) \| ([^|]*) \| ([^|]*) \|$", document, re.MULTILINE)
    folders = [folder for folder, *_ in rows]
    if not folders:
        raise Unreadable("docs/architecture.md has no table with the columns folder, contents, may use, libraries")

    def named(cell: str) -> set[str]:
        return {name.strip() for name in cell.split(",")} - {"", "-"}

    def folder_called(name: str, by: str) -> str:
        found = [folder for folder in folders if f"/{folder}".endswith(f"/{name}")]
        if len(found) != 1:
            raise Unreadable(f"docs/architecture.md: {by} may use {name}, which is the name of "
                             f"{', '.join(found) or 'no folder in the table'}; write as much of its path as names one")
        return found[0]

    return {folder: Row(folder, purpose.strip(), {folder_called(name, folder) for name in named(uses)},
                        named(libraries))
            for folder, purpose, uses, libraries in rows}


def read_paths(document: str) -> list[list[str]]:
    """The folders of each data path in the first code block: one path per paragraph, one folder per line."""
    block = document.split("## Data path")[1].split("\n## ")[0]
    return [re.findall(r"  ((?:firmware|host)(?:/\w+)+)(?:, [^\n]*)?$", paragraph, re.MULTILINE)
            for paragraph in block.strip("\n").split("\n\n") if paragraph.startswith("    ")]


def read_graph(path: pathlib.Path) -> list[Target]:
    try:
        lines = path.read_text().splitlines()
    except OSError as error:
        raise Unreadable(f"{error}; make it with cmake --preset {path.parent.name}") from error
    parts = [line.split("|") for line in lines]
    return [Target(name, folder, links.split(";") if links else [],
                   [pathlib.Path(header) for header in published.split(";") if header])
            for name, folder, links, published in parts]


def library_name(link: str) -> str:
    """PkgConfig::hdf5 -> hdf5, nlohmann_json::nlohmann_json -> nlohmann_json, pybind11::module -> pybind11."""
    package, _, part = link.rpartition("::")
    return (package if part.lower() in {"headers", "module"} else part).lower()


# Libraries of the operating system, and the flags that every target uses.
NO_LIBRARY = {"threads", "dl", "inkwell_warnings", "inkwell_embedded"}


@dataclasses.dataclass
class Tree:
    """The actual tree: folders with sources, their linked targets and their included files."""

    folders: set[str]
    links: dict[str, set[str]]  # folder of a target -> folders of the targets that it links to
    libraries: dict[str, set[str]]  # folder of a target -> external libraries
    includes: dict[str, dict[str, str]]  # folder -> included folder -> one of the including lines
    private: dict[str, dict[str, str]]  # the same for headers that their folder does not publish

    def uses(self, folder: str) -> set[str]:
        """A folder without a target uses the folders that it includes."""
        return self.links[folder] if folder in self.links else set(self.includes.get(folder, {}))

    def library_folder(self, folder: str) -> str | None:
        """The nearest folder with a target, which contains the files of folders without a target."""
        while folder and folder not in self.links:
            folder = folder.rpartition("/")[0]
        return folder or None

    def can_include(self, folder: str, other: str) -> bool:
        own, owner = self.library_folder(folder), self.library_folder(other)
        return own is None or owner is None or own == owner or owner in self.links[own]


def read_tree(repository: pathlib.Path, graphs: list[pathlib.Path]) -> Tree:
    targets = [target for graph in graphs for target in read_graph(graph)]
    folder_of_target = {target.name: target.folder for target in targets}
    inside = [target for target in targets if target.folder.split("/")[0] in ROOTS]

    links: dict[str, set[str]] = {target.folder: set() for target in inside}
    libraries: dict[str, set[str]] = {target.folder: set() for target in inside}
    for target in inside:
        for link in target.links:
            if link in folder_of_target:
                links[target.folder].add(folder_of_target[link])
            else:
                libraries[target.folder].add(library_name(link))
        links[target.folder] -= {target.folder, "."}
        libraries[target.folder] -= NO_LIBRARY

    sources = [path for root in ROOTS for path in sorted((repository / root).rglob("*")) if path.suffix in SOURCES]
    folders = set(links) | {str(path.parent.relative_to(repository)) for path in sources if path.suffix == ".cpp"}

    def folder_of(path: pathlib.Path) -> str | None:
        return next((str(parent) for parent in path.relative_to(repository).parents if str(parent) in folders), None)

    published = {header.relative_to(repository) for target in inside for header in target.published}
    with_private_headers = {str(header.parent) for header in published}

    # User files include these headers with names that differ from their paths: <inkwell/inkwell.h>,
    # <control/force_law.hpp>.
    installed = {str(header.relative_to(directory)): header
                 for root in ROOTS for directory in (repository / root).rglob("include") for header in directory.rglob("*.h*")}

    includes: dict[str, dict[str, str]] = {}
    private: dict[str, dict[str, str]] = {}
    for path in sources:
        folder = folder_of(path)
        for line, name in re.findall(r'^(#include [<"]([^>"]+)[>"])', path.read_text(), re.MULTILINE):
            header = installed.get(name, repository / name)
            owner = folder_of(header) if header.is_file() else None
            if not folder or not owner or owner == folder:
                continue
            where = f"{path.relative_to(repository)}: {line}"
            includes.setdefault(folder, {})[owner] = where
            if owner in with_private_headers and header.relative_to(repository) not in published:
                private.setdefault(folder, {})[owner] = where
    return Tree(folders, links, libraries, includes, private)


def differences(table: dict[str, Row], tree: Tree) -> list[str]:
    """One line for each difference between the table and the tree."""
    problems = [f"{folder}/ has no row in docs/architecture.md" for folder in sorted(tree.folders - table.keys())]
    problems += [f"docs/architecture.md has a row for {folder}/, which holds neither a target nor a .cpp file"
                 for folder in sorted(table.keys() - tree.folders) if folder.split("/")[0] in ROOTS]
    for folder in sorted(table.keys() & tree.folders):
        row = table[folder]
        uses, libraries = tree.uses(folder), tree.libraries.get(folder, set())
        problems += [f"{folder}/ uses {other}/, which its row does not name" for other in sorted(uses - row.uses)]
        problems += [f"{folder}/ does not use {other}/, which its row names" for other in sorted(row.uses - uses)]
        problems += [f"{folder}/ links to {name}, which its row does not name"
                     for name in sorted(libraries - row.libraries)]
        problems += [f"{folder}/ does not link to {name}, which its row names"
                     for name in sorted(row.libraries - libraries)]
        problems += [f"{line}: {folder}/ has no target that links to one of {other}/"
                     for other, line in sorted(tree.includes.get(folder, {}).items())
                     if not tree.can_include(folder, other)]
        problems += [f"{line}: {other}/ does not publish this header (inkwell_publish_headers in its CMakeLists.txt)"
                     for other, line in sorted(tree.private.get(folder, {}).items())
                     if tree.library_folder(folder) != tree.library_folder(other)]
    return problems
