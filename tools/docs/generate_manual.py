"""Writes compressed manual pages from the --help output of programs: one page per program and per command.

    tools/docs/generate_manual.py VERSION FOLDER PROGRAM...

inkwell.1.gz is the page of `inkwell`. inkwell-record.1.gz is the page of `inkwell record` and its subcommands.
"""

import gzip
import pathlib
import re
import sys

import help_text
from help_text import Command, Row


def roff(text: str) -> str:
    """Escapes all characters that are special in roff."""
    escaped = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq").replace("`", "\\(ga")
    return re.sub(r"^\.", r"\\&.", escaped, flags=re.MULTILINE)


def quoted_as_bold(text: str) -> str:
    """Formats `inkwell info` in bold and escapes the rest."""
    parts = text.split("`")
    return "".join(f"\\fB{roff(part)}\\fR" if index % 2 else roff(part) for index, part in enumerate(parts))


def summary(command: Command) -> str:
    """Returns the first clause of the description."""
    first = re.split(r"[.:;](?:\s|$)", command.description.split("\n\n")[0].replace("\n", " "))[0]
    return first[0].lower() + first[1:] if first[1:2].islower() else first


def paragraphs(text: str) -> str:
    """Indented lines are not filled, all other lines are."""
    out = []
    for paragraph in text.split("\n\n"):
        for lines in re.findall(r"(?:^ .*\n?)+|(?:^\S.*\n?)+", paragraph, re.MULTILINE):
            lines = lines.rstrip("\n")
            out.append(f".EX\n{roff(lines)}\n.EE" if lines.startswith(" ") else quoted_as_bold(lines))
        out.append(".PP")
    return "\n".join(out[:-1])


def row_text(row: Row) -> str:
    names = ", ".join(f"\\fB{roff(name)}\\fR" if name.startswith("-") else f"\\fI{roff(name)}\\fR" for name in row.names)
    value = re.sub(r"^(.*\S) \(([^)]*)\)", r"\1 (\2 unless given)", row.value)
    return f".TP\n{names}{' ' + roff(value) if value else ''}\n{quoted_as_bold(row.text)}"


def blocks(command: Command, heading: str) -> list[str]:
    out = []
    for name, rows in command.blocks.items():
        rows = [row for row in rows if "--help" not in row.names]
        if name != "Subcommands" and rows:
            out += [f".{heading} {roff(name.upper() if heading == 'SH' else name)}", *map(row_text, rows)]
    return out


def below(command: Command) -> list[str]:
    """Formats a subcommand as a section of the page of its command."""
    out = [f".SS {roff(' '.join(command.words))}", f".B {roff(command.usage)}", ".PP", paragraphs(command.description)]
    for rows in command.blocks.values():
        out += [row_text(row) for row in rows if "--help" not in row.names]
    for each in command.commands:
        out += below(each)
    return out


def page(command: Command, version: str) -> str:
    name = "-".join(command.words)
    out = [f'.TH {name.upper()} 1 "" "Inkwell {version}" "Inkwell"', ".SH NAME", f"{roff(name)} \\- {roff(summary(command))}",
           ".SH SYNOPSIS", f".B {roff(command.usage)}", ".SH DESCRIPTION", paragraphs(command.description)]
    if command.commands:
        out.append(".SH COMMANDS")
        for each in command.commands:
            row = next(row for row in command.blocks["Subcommands"] if row.names == each.words[-1:])
            reference = f"\\fB{roff('-'.join(each.words))}\\fR(1)" if len(command.words) == 1 else ""
            out.append(f".TP\n\\fB{roff(each.words[-1])}\\fR {reference}\n{quoted_as_bold(row.text)}".replace(" \n", "\n"))
    out += blocks(command, "SH")
    if len(command.words) > 1:
        for each in command.commands:
            out += below(each)
    examples, found, rest = command.footer.partition("Examples:\n")
    if found:
        lines, _, rest = rest.partition("\n\n")
        out += [".SH EXAMPLES", ".EX", roff(lines), ".EE"]
    if examples + rest:
        out += [".SH NOTES", paragraphs(examples + rest)]
    if len(command.words) > 1:
        out += [".SH SEE ALSO", f"\\fB{roff(command.words[0])}\\fR(1)"]
    return "\n".join(out) + "\n"


def main() -> int:
    version, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    try:
        programs = [help_text.read(program, [pathlib.Path(program).name]) for program in sys.argv[3:]]
    except help_text.Unreadable as error:
        print(error, file=sys.stderr)
        return 1
    for old in folder.glob("*.1.gz"):
        old.unlink()
    for program in programs:
        for command in [program, *program.commands]:
            # The file has no time stamp, so equal help texts produce equal files.
            content = gzip.compress(page(command, version).encode(), 9, mtime=0)
            (folder / f"{'-'.join(command.words)}.1.gz").write_bytes(content)
    return 0


if __name__ == "__main__":
    sys.exit(main())
