"""Writes a shell completion script from the --help output of a program: commands, options, choices and files.

    tools/docs/generate_completion.py bash|zsh|fish PROGRAM FILE

The program's tables provide the names of parameters and signals.
"""

import pathlib
import re
import shlex
import subprocess
import sys

import help_text
from help_text import Command, Row

FILES = "<files>"


def output_of(program: str, *arguments: str) -> str:
    return subprocess.run([program, *arguments], capture_output=True, text=True, check=True).stdout


class Words:
    """Possible values of options and positionals."""

    def __init__(self, program: str, root: Command):
        self.parameters: list[str] = []
        self.signals: list[str] = []
        known = {command.words[-1] for command in root.commands}
        if {"reference", "signals"} <= known:
            section = output_of(program, "reference").split("\n## Parameters\n")[1].split("\n## ")[0]
            self.parameters = re.findall(r"^\| \d+ \| `(\w+)`", section, re.MULTILINE)
            self.signals = re.findall(r"^(\w+) ", output_of(program, "signals"), re.MULTILINE)

    def for_value(self, row: Row) -> list[str]:
        if row.takes_file() or row.value.startswith(("FOLDER", "PATH")):
            return [FILES]
        return self.signals if row.names == ["--signals"] else row.choices()

    def for_positional(self, row: Row) -> list[str]:
        if row.names == ["NAME"]:
            return self.parameters
        if row.names == ["ASSIGNMENT"]:
            return [f"{name}=" for name in self.parameters]
        return [FILES] if row.takes_file() else row.choices()


def tables(program: str, root: Command):
    """For each command: its words, the possible next words, its options, and the possible values of each option."""
    words = Words(program, root)
    for command in root.all():
        own = command.options() if command is root else [*command.options(), *shared(root)]
        options = {name: row for row in own for name in row.names}
        follow = [each.words[-1] for each in command.commands]
        for row in command.positionals():
            follow += words.for_positional(row)
        if command.words[1:] == ["run"]:
            follow.append(FILES)  # the program to be run
        yield command, follow, options, {name: words.for_value(row) for name, row in options.items() if row.takes_value()}


def shared(root: Command) -> list[Row]:
    """The options of the device, which every command accepts."""
    return [row for heading, rows in root.blocks.items() if not heading.startswith("Window") for row in rows
            if row.names[0].startswith("--") and row.names != ["--version"]]


def cases(program: str, root: Command) -> str:
    """The body of an sh `case` on "COMMAND|OPTION". It sets `choices` and `options`, and `files` if files are
    possible."""
    lines = []
    for command, follow, options, values in tables(program, root):
        words = " ".join(command.words[1:])

        def line(pattern: str, choices: list[str]) -> str:
            given = " ".join(each for each in choices if each != FILES)
            return f"    {shlex.quote(pattern)}) choices={shlex.quote(given)}{'; files=1' if FILES in choices else ''} ;;"

        lines += [line(f"{words}|{name}", choices) for name, choices in values.items()]
        lines.append(line(f"{words}|", follow).replace(") choices", f"*) options={shlex.quote(' '.join(options))}; choices", 1))
    return "\n".join(lines)


def commands_pattern(root: Command) -> str:
    return "|".join(shlex.quote(" ".join(command.words[1:])) for command in root.all()[1:]) or "''"


BASH = """# bash completion of {name}. Generated from its --help output.
_{function}() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} command= next word choices= options= files=
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    next="${{command:+$command }}$word"
    case $next in {commands}) command=$next ;; esac
  done
  case "$command|$previous" in
{cases}
  esac
  [[ $current == -* ]] && choices=$options files=
  mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$current")
  [[ $files ]] && compopt -o default
  [[ ${{COMPREPLY[*]}} == *= ]] && compopt -o nospace
  return 0
}}
complete -F _{function} {name}
"""


def bash(program: str, root: Command) -> str:
    name = root.words[0]
    return BASH.format(name=name, function=name.replace("-", "_"), commands=commands_pattern(root), cases=cases(program, root))


ZSH = """#compdef {name}
# zsh completion of {name}. Generated from its --help output.
local command= next word choices= options= files=
for word in "${{(@)words[2,CURRENT - 1]}}"; do
  next="${{command:+$command }}$word"
  case $next in {commands}) command=$next ;; esac
done
case "$command|$words[CURRENT - 1]" in
{cases}
esac
[[ $words[CURRENT] == -* ]] && choices=$options files=
compadd -S '' -- ${{(M)${{=choices}}:#*=}}
compadd -- ${{${{=choices}}:#*=}}
[[ -z $files ]] || _files
"""


def zsh(program: str, root: Command) -> str:
    return ZSH.format(name=root.words[0], commands=commands_pattern(root), cases=cases(program, root))


def fish(program: str, root: Command) -> str:
    """Returns one condition per command, from the preceding words, and one line per possible next word."""
    name = root.words[0]
    out = [f"# fish completion of {name}. Generated from its --help output.", f"complete -c {name} -f"]
    for command, follow, options, values in tables(program, root):
        below = [each.words[-1] for each in command.commands]
        condition = " && ".join([f"__fish_seen_subcommand_from {word}" for word in command.words[1:]]
                                + ([f"not __fish_seen_subcommand_from {' '.join(below)}"] if below else []))
        start = f"complete -c {name}" + (f" -n {shlex.quote(condition)}" if condition else "")
        texts = {row.names[0]: row.text.split("\n")[0] for row in command.blocks.get("Subcommands", [])}
        for word in follow:
            if word == FILES:
                out.append(f"{start} -F")
            else:
                text = f" -d {shlex.quote(texts[word])}" if word in texts else ""
                out.append(f"{start} -a {shlex.quote(word)}{text}")
        seen = set()
        for option, row in options.items():
            if id(row) in seen:
                continue
            seen.add(id(row))
            line = f"{start} {' '.join('-l ' + each[2:] if each.startswith('--') else '-s ' + each[1:] for each in row.names)}"
            if option in values:
                choices = values[option]
                line += " -r -F" if FILES in choices else f" -x -a {shlex.quote(' '.join(choices))}" if choices else " -x"
            out.append(f"{line} -d {shlex.quote(row.text.replace(chr(10), ' '))}")
    return "\n".join(out) + "\n"


def main() -> int:
    shell, program, file = sys.argv[1:]
    try:
        root = help_text.read(program, [pathlib.Path(program).name])
    except help_text.Unreadable as error:
        print(error, file=sys.stderr)
        return 1
    path = pathlib.Path(file)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text({"bash": bash, "zsh": zsh, "fish": fish}[shell](program, root), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
