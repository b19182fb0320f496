#!/usr/bin/env python3
"""Writes <arm/defaults.hpp> from an arm description: the arm's rows of the parameter table as constants.

usage: generate_arm_defaults.py ARM.toml OUTPUT.hpp
"""
import pathlib
import sys
import tomllib


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    source, output = map(pathlib.Path, sys.argv[1:])
    try:
        description = tomllib.loads(source.read_text())
    except (OSError, tomllib.TOMLDecodeError) as error:
        sys.exit(f"{source}: {error}. Give a readable arm description such as boards/arms/omni.toml.")
    parameters = description.get("parameters")
    name = description.get("arm", {}).get("name")
    if not isinstance(parameters, dict) or not isinstance(name, str):
        sys.exit(f"{source}: [arm] with a name and [parameters] are needed; see boards/arms/omni.toml.")
    lines = [
        f"// Made by the build from {source.name}; edit that file instead.",
        "#pragma once",
        "",
        "namespace inkwell::arm_defaults {",
        "",
        f'inline constexpr char name[] = "{name}";',
    ]
    for key, value in parameters.items():
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            sys.exit(f"{source}: {key} = {value!r} is not a number.")
        lines.append(f"inline constexpr float {key} = {float(value)!r}f;")
    lines += ["", "}  // namespace inkwell::arm_defaults", ""]
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text("\n".join(lines))


main()
