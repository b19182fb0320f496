#!/usr/bin/env python3
"""Prints a header with the parameters of every arm description, for tests that cannot read files.

usage: generate_arms.py ARM.toml...
"""
import pathlib
import sys
import tomllib


def main() -> None:
    sources = [pathlib.Path(argument) for argument in sys.argv[1:]]
    lines = [
        "// Made by the build from boards/arms/*.toml.",
        "#pragma once",
        "",
        "#include <span>",
        "",
        "#include \"protocol/parameters.hpp\"",
        "",
        "namespace inkwell::tests {",
        "",
        "struct ArmRow {",
        "  protocol::Parameter parameter;",
        "  float value;",
        "};",
        "",
        "struct ArmFile {",
        "  const char* name;",
        "  std::span<const ArmRow> rows;",
        "};",
        "",
    ]
    for index, source in enumerate(sources):
        lines.append(f"inline constexpr ArmRow arm_rows_{index}[] = {{")
        for key, value in tomllib.loads(source.read_text())["parameters"].items():
            lines.append(f"    {{protocol::Parameter::{key}, {float(value)!r}f}},")
        lines.append("};")
    lines.append("inline constexpr ArmFile arm_files[] = {")
    lines += [f'    {{"{source.stem}", arm_rows_{index}}},' for index, source in enumerate(sources)]
    lines += ["};", "", "}  // namespace inkwell::tests"]
    print("\n".join(lines))


main()
