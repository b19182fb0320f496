"""docs/cycles.md contains the table that print-cycle-costs prints.

usage: cycles_page_test.py PRINT_CYCLE_COSTS PAGE
"""
import subprocess
import sys


def table_of(lines):
    return [line for line in lines if line.startswith("| ")]


def main():
    printed = table_of(subprocess.run([sys.argv[1]], capture_output=True, text=True, check=True).stdout.splitlines())
    with open(sys.argv[2], encoding="utf-8") as page:
        written = table_of(page.read().splitlines())
    # Other tables may precede the cost table.
    if printed[0] in written and written[written.index(printed[0]):] == printed:
        return 0
    print(f"The table of {sys.argv[2]} is not what the code charges. Replace it by this table:\n")
    print("\n".join(printed))
    return 1


sys.exit(main())
