#!/usr/bin/env python3
"""Prints <timing/cost_rows.hpp> from boards/stm32f405/timing/costs.toml: its rows as the X-macro INKWELL_COSTS.

usage: generate_costs.py COSTS.toml
"""
import pathlib
import sys
import tomllib


def main() -> None:
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    source = pathlib.Path(sys.argv[1])
    try:
        table = tomllib.loads(source.read_text())
        if without := [name for name, row in table.items() if not row.get("meaning")]:
            sys.exit(f"{source}: {without[0]} has no meaning. State what the cost is for.")
        rows = [f"  X({name}, {row['likely']}, {row['conservative']}, {row['source']})" for name, row in table.items()]
    except (OSError, tomllib.TOMLDecodeError, KeyError, TypeError, AttributeError) as error:
        sys.exit(f"{source}: {error!r}. Each row needs likely, conservative, source and meaning.")
    lines = [f"// Made by the build from {source.name}; edit that file instead.", "#pragma once", "",
             "#define INKWELL_COSTS(X) \\", " \\\n".join(rows)]
    print("\n".join(lines))


main()
