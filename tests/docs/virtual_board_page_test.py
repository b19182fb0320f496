"""docs/virtual-board.md says of each option, command and fault of virtual-board what it is for, in the order of its help.

usage: virtual_board_page_test.py VIRTUAL_BOARD PAGE
"""
import re
import subprocess
import sys


def names_in_help(help_text):
    options, commands = help_text.split("\nControl socket:", 1)
    faults = options.split("\nInjected faults,", 1)[1].split(":\n", 1)[1]
    return {
        "Options": re.findall(r"^  (--[a-z0-9-]+)", options, re.MULTILINE),
        "Commands of the control socket": re.findall(r"^  ([a-z]\w*)", commands.split(":", 1)[1], re.MULTILINE),
        "Injected faults": re.findall(r"^  ([a-z]\w*)", faults, re.MULTILINE),
    }


def names_in_page(page, section):
    text = page.split(f"## {section}\n", 1)[1].split("\n## ", 1)[0]
    rows = re.findall(r"^- `([^`]+)`: (.+)$", text, re.MULTILINE)
    for name, purpose in rows:
        if len(purpose) < 10:
            print(f"{section}: {name} does not say what it is for")
            sys.exit(1)
    return [name for name, _ in rows]


def main():
    help_text = subprocess.run([sys.argv[1], "--help"], capture_output=True, text=True, check=True).stdout
    with open(sys.argv[2], encoding="utf-8") as page_file:
        page = page_file.read()
    wrong = 0
    for section, in_help in names_in_help(help_text).items():
        in_page = names_in_page(page, section)
        if in_help == in_page:
            continue
        wrong = 1
        missing = [name for name in in_help if name not in in_page]
        gone = [name for name in in_page if name not in in_help]
        print(f"{sys.argv[2]}, {section}: missing {missing}, no more there {gone}; the order is that of --help:")
        print("  " + " ".join(in_help))
    return wrong


sys.exit(main())
