"""Parses the --help output of a program into commands, options and positionals, for manual pages and shell completion.

The format is that of CLI11: a description, "Usage: ...", then blocks with a heading and rows. Each row is indented by
two and contains a name and, from a fixed column on, a description. Further text of the program follows the last block.
"""

import dataclasses
import re
import subprocess


class Unreadable(Exception):
    """The help text has another format; the message states the problem."""


@dataclasses.dataclass
class Row:
    """An option, a positional or a subcommand."""

    names: list[str]
    value: str  # text after the names: a type such as FILE, choices such as {a,b}, a default in brackets
    text: str

    def choices(self) -> list[str]:
        found = re.match(r"\{([^}]*)\}|([\w-]+(?:\|[\w-]+)+)", self.value)
        return re.split(r"[,|]", found[1] or found[2]) if found else []

    def takes_value(self) -> bool:
        return bool(self.value)

    def takes_file(self) -> bool:
        return self.value.startswith("FILE") or self.names[0].startswith("FILE")


@dataclasses.dataclass
class Command:
    words: list[str]  # name of the program, then of the subcommands
    description: str
    usage: str
    blocks: dict[str, list[Row]]  # rows per heading, in the order of the help text
    footer: str
    commands: list["Command"] = dataclasses.field(default_factory=list)

    def options(self) -> list[Row]:
        return [row for rows in self.blocks.values() for row in rows if row.names[0].startswith("-")]

    def positionals(self) -> list[Row]:
        return self.blocks.get("Positionals", [])

    def all(self) -> list["Command"]:
        return [self, *(each for command in self.commands for each in command.all())]


def read_rows(lines: list[str]) -> list[Row]:
    rows: list[Row] = []
    for line in lines:
        start = re.match(r"  (\S.*?)(?:\s{2,}(\S.*))?$", line)
        if start:
            names, _, value = start[1].partition(" ")
            rows.append(Row(names.split(","), value, start[2] or ""))
        elif rows:
            rows[-1].text = f"{rows[-1].text}\n{line.strip()}".strip()
    return rows


def parse(words: list[str], text: str) -> Command:
    description, found, rest = text.partition("Usage: ")
    if not found:
        raise Unreadable(f"the help of {' '.join(words)} has no line that begins with Usage:")
    usage, _, rest = rest.partition("\n")
    blocks: dict[str, list[Row]] = {}
    footer: list[str] = []
    # A heading is a separate line that ends with a colon; its rows follow.
    paragraphs = [lines for lines in re.split(r"\n{2,}", rest.strip("\n")) if lines]
    for index, paragraph in enumerate(paragraphs):
        heading, *lines = paragraph.split("\n")
        is_block = re.fullmatch(r"\S.*:", heading) and lines and lines[0].startswith("  ")
        if not is_block or heading == "Examples:" or not (heading in ("Positionals:", "Subcommands:")
                                                          or lines[0].startswith("  -")):
            footer = paragraphs[index:]
            break
        blocks[heading[:-1]] = read_rows(lines)
    return Command(words, description.strip(), usage, blocks, "\n\n".join(footer))


def read(program: str, words: list[str]) -> Command:
    """Reads the help of `program`, whose name is the first of the words, and of all its commands."""
    result = subprocess.run([program, *words[1:], "--help"], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise Unreadable(f"{program} {' '.join([*words[1:], '--help'])} ended with {result.returncode}: {result.stderr}")
    command = parse(words, result.stdout)
    for row in command.blocks.get("Subcommands", []):
        command.commands.append(read(program, [*words, row.names[0]]))
    return command
