#!/usr/bin/env python3
"""Prints a C++ header with the structures, enumerations and constants of the protocol headers and their doc comments,
for `inkwell reference`. The compiler provides offsets and sizes.

usage: generate_layouts.py HEADER...
"""
import pathlib
import re
import sys

FIELD = re.compile(r"(?P<type>[\w:]+) (?P<name>\w+)(?P<extent>\[[^\]]+\])?( : (?P<bits>\d+))?( = (?P<value>[^;]+))?;"
                   r"( *///< (?P<meaning>.*))?")
ENUMERATOR = re.compile(r"(?P<name>\w+)( = \w+)?,?( *///< (?P<meaning>.*))?")
CONSTANT = re.compile(r"inline constexpr (?:float|std::size_t|std::uint\d+_t) (?P<name>\w+) = [^;]+;"
                      r"( *///< (?P<meaning>.*)| *//.*)?")


class NotUnderstood(Exception):
    pass


def text(words: str | None) -> str:
    return f'R"~({words or ""})~"'


def doc_before(lines: list[str], index: int) -> str:
    """Returns the text of the /// lines directly above."""
    first = index
    while lines[first - 1].startswith("/// "):
        first -= 1
    return " ".join(line[4:] for line in lines[first:index])


def body_from(lines: list[str], index: int) -> list[str]:
    """Returns the lines after line `index` up to the closing brace in the first column."""
    end = lines.index("};", index)
    return [line.strip() for line in lines[index + 1:end]]


def fields(struct: str, body: list[str]) -> list[str]:
    rows, doc = [], []
    before, bits_before = None, 0  # offsetof does not accept a bit field: it follows the last normal field
    for line in body:
        if line.startswith("/// "):
            doc.append(line[4:])
            continue
        if line in ("union {", "};"):
            continue
        field = FIELD.fullmatch(line)
        if not field:
            raise NotUnderstood(f"{struct}: {line}")
        bits, member = int(field["bits"] or 0), f"{struct}::{field['name']}"
        if bits:
            begin = f"offsetof({struct}, {before}) + sizeof({struct}::{before}) + " if before else ""
            offset = f"{begin}{bits_before // 8}"
            size, first_bit = "1", bits_before % 8
            bits_before += bits
        else:
            offset, size, first_bit = f"offsetof({struct}, {field['name']})", f"sizeof({member})", 0
            before, bits_before = field["name"], 0
        count = f"sizeof({member}) / sizeof({member}[0])" if field["extent"] else "0"
        type_name = re.sub(r"^std::|_t$", "", field["type"])
        rows.append(f"{{{text(type_name)}, {text(field['name'])}, {offset}, {size}, {count}, {first_bit}, {bits}, "
                    f"{text(field['value'])}, {text(' '.join(filter(None, [*doc, field['meaning']])))}}},")
        doc = []
    return rows


def enumerators(name: str, body: list[str]) -> list[str]:
    rows = []
    for line in body:
        each = ENUMERATOR.fullmatch(line)
        if not each:
            raise NotUnderstood(f"{name}: {line}")
        rows.append(f"{{{text(each['name'])}, static_cast<unsigned>({name}::{each['name']}), {text(each['meaning'])}}},")
    return rows


def read(header: pathlib.Path, structs: list[str], enums: list[str], constants: list[str]) -> list[str]:
    """Appends the header's rows to the three lists, and returns the arrays that the rows refer to."""
    arrays = []
    lines = header.read_text().splitlines()
    for i, line in enumerate(lines):
        if struct := re.fullmatch(r"struct (\w+) \{", line):
            name, body = struct[1], body_from(lines, i)
            if any(re.match(r"(const )?std::(?!u?int\d+_t)", each) for each in body):
                continue  # contains a C++ text or array and is not transmitted
            arrays += [f"inline constexpr Field fields_of_{name}[] = {{", *fields(name, body), "};"]
            structs.append(f"{{{text(name)}, sizeof({name}), {text(doc_before(lines, i))}, fields_of_{name}}},")
        elif enum := re.match(r"enum class (\w+) : std::uint\d+_t \{(.*)", line):
            name, rest = enum[1], enum[2]
            body = [each.strip() for each in rest.removesuffix("};").split(",")] if rest else body_from(lines, i)
            if "#undef X" in body:
                continue  # generated from a table, which is printed separately
            arrays += [f"inline constexpr Enumerator enumerators_of_{name}[] = {{", *enumerators(name, body), "};"]
            enums.append(f"{{{text(name)}, sizeof({name}), {text(doc_before(lines, i))}, enumerators_of_{name}}},")
        elif constant := CONSTANT.fullmatch(line):
            doc = " ".join(filter(None, [doc_before(lines, i), constant["meaning"]]))
            constants.append(f"{{{text(constant['name'])}, static_cast<double>({constant['name']}), {text(doc)}}},")
    return arrays


def main() -> None:
    headers = [pathlib.Path(each) for each in sys.argv[1:]]
    if not headers:
        sys.exit(__doc__)
    structs, enums, constants, arrays, intros = [], [], [], [], []
    for header in headers:
        try:
            arrays += read(header, structs, enums, constants)
        except (OSError, ValueError, NotUnderstood) as error:
            sys.exit(f"{header}: {error}. Write one field a line, `type name[extent] = value;  ///< meaning`.")
        intro = [line.removeprefix("//").removeprefix(" ") for line in
                 re.match(r"(//.*\n)*", header.read_text())[0].splitlines()]
        intros.append(f"{{{text(header.name)}, {text(chr(10).join(intro))}}},")
    names = ", ".join(header.name for header in headers)
    print("\n".join([f"// Made by the build from {names}; edit those instead.", "#pragma once", "",
                     "namespace inkwell::protocol::layouts {", "", "using namespace usb;", "", *arrays,
                     "inline constexpr Intro intros[] = {", *intros, "};",
                     "inline constexpr Struct structs[] = {", *structs, "};",
                     "inline constexpr Enumeration enumerations[] = {", *enums, "};",
                     "inline constexpr Constant constants[] = {", *constants, "};",
                     "", "}  // namespace inkwell::protocol::layouts"]))


if __name__ == "__main__":
    main()
