"""What a program's --help says, as commands, options and positionals: manual pages and shell completion are made of it.

The form is that of CLI11: a description, "Usage: ...", then blocks of a heading and rows that are indented by two, each
with a name and, from a column on, what it is; behind the last of them comes what the program adds.
"""

import dataclasses
import re
import subprocess


class Unreadable(Exception):
    """A help that is not of this form; the message says which."""


@dataclasses.dataclass
class Row:
    """An option, a positional or a subcommand."""

    names: list[str]
    value: str  # what follows the names: a type such as FILE, choices as {a,b}, a default in brackets
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
    words: list[str]  # the program's name, then those of the commands
    description: str
    usage: str
    blocks: dict[str, list[Row]]  # by heading, in the help's order
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
    # A heading stands alone on its line and ends in a colon; below it come rows.
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
    """The help of `program`, called by the first of the words, with that of all its commands."""
    result = subprocess.run([program, *words[1:], "--help"], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise Unreadable(f"{program} {' '.join([*words[1:], '--help'])} ended with {result.returncode}: {result.stderr}")
    command = parse(words, result.stdout)
    for row in command.blocks.get("Subcommands", []):
        command.commands.append(read(program, [*words, row.names[0]]))
    return command
