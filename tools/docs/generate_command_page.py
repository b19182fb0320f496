"""Writes a Markdown page with all commands and options, from the --help output of the programs.

    tools/docs/generate_command_page.py VERSION FILE PROGRAM...
"""

import pathlib
import re
import sys

import help_text
from help_text import Command


def cell(text: str) -> str:
    """Formats a text as a single-line table cell."""
    return " ".join(text.split()).replace("|", "\\|")


def code(text: str) -> str:
    return "\n".join(f"    {line}" for line in text.splitlines())


def rows(command: Command) -> list[str]:
    """Formats the positionals and options of a command as one table."""
    table = []
    for heading, block in command.blocks.items():
        if heading != "Subcommands":
            table += [f"| `{cell(' '.join([', '.join(row.names), row.value]))}` | {cell(row.text)} |" for row in block
                      if "--help" not in row.names]
    return ["| option | meaning |", "| --- | --- |", *table, ""] if table else []


def section(command: Command) -> list[str]:
    heading = "#" * min(len(command.words) + 1, 4)
    lines = [f"{heading} {' '.join(command.words)}", "", command.description, "", code(command.usage), ""]
    lines += rows(command)
    examples = re.search(r"Examples:\n(.*?)(?:\n\n|$)", command.footer, re.DOTALL)
    if examples:
        lines += ["Examples:", "", code(examples[1]), ""]
    for each in command.commands:
        lines += section(each)
    return lines


def main() -> int:
    version, path = sys.argv[1], pathlib.Path(sys.argv[2])
    try:
        programs = [help_text.read(program, [pathlib.Path(program).name]) for program in sys.argv[3:]]
    except help_text.Unreadable as error:
        print(error, file=sys.stderr)
        return 1
    commands = [each for program in programs for each in program.commands]
    index = [f"- [{' '.join(each.words)}](#{'-'.join(each.words)})" for each in commands]
    lines = ["# Commands", "", f"Version {version}. This page is generated from the help texts of the programs.", "", *index, ""]
    for program in programs:
        lines += section(program)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
