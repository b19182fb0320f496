#!/usr/bin/env python3
"""Prints <arm/defaults.hpp> from an arm description: its parameter values and its motor as constants.

usage: generate_arm_defaults.py ARM.toml
"""
import pathlib
import sys
import tomllib


def main() -> None:
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    source = pathlib.Path(sys.argv[1])
    try:
        description = tomllib.loads(source.read_text())
    except (OSError, tomllib.TOMLDecodeError) as error:
        sys.exit(f"{source}: {error}. Give a readable arm description such as boards/arms/omni.toml.")
    sections = {"arm_defaults": description.get("parameters"), "arm_defaults::motor": description.get("motor")}
    name = description.get("arm", {}).get("name")
    if not all(isinstance(section, dict) for section in sections.values()) or not isinstance(name, str):
        sys.exit(f"{source}: [arm] with a name, [parameters] and [motor] are needed; see boards/arms/omni.toml.")
    lines = [
        f"// Made by the build from {source.name}; edit that file instead.",
        "#pragma once",
        "",
        "namespace inkwell::arm_defaults {",
        "",
        f'inline constexpr char name[] = "{name}";',
        "",
        "}  // namespace inkwell::arm_defaults",
    ]
    for namespace, section in sections.items():
        lines += ["", f"namespace inkwell::{namespace} {{", ""]
        for key, value in section.items():
            if isinstance(value, bool) or not isinstance(value, (int, float)):
                sys.exit(f"{source}: {key} = {value!r} is not a number.")
            lines.append(f"inline constexpr float {key} = {float(value)!r}f;")
        lines += ["", f"}}  // namespace inkwell::{namespace}"]
    print("\n".join(lines))


main()
