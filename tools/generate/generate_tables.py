#!/usr/bin/env python3
"""Prints C++ code for a table in protocol/tables: enumerators and rows for a header, or the texts for a source file.

usage: generate_tables.py header TABLE.toml [ARM.toml]    (ARM.toml: defaults of the parameters with default = "arm")
       generate_tables.py monitoring SUPERVISION.toml     (transitions and monitored faults)
       generate_tables.py texts TABLE.toml...

The headers contain no texts, so that a changed text compiles only the source file with the texts.
"""
import json
import pathlib
import re
import sys
import tomllib

NAME = re.compile(r"[a-zA-Z][a-zA-Z0-9_]*")
AXIS = re.compile(r"_([1-3x-z])(?=_|$)")
NUMBER = (int, float)
# Columns of each table: type and default value. A column without a default value is required.
COLUMNS = {
    "parameters": {"id": (int,), "group": (str,), "kind": (str, "real"), "unit": (str,), "range": (list,),
                   "default": ((*NUMBER, str),), "needs_force_off": (bool, False), "help": (str,)},
    "signals": {"id": (int,), "unit": (str,), "wire": (str, "float32"), "help": (str,)},
    "faults": {"code": (int,), "cause": (str,), "remedy": (str,)},
    "refusals": {"code": (int,), "cause": (str,), "remedy": (str,)},
    "limits": {"bit": (int,), "meaning": (str,)},
    "force_sources": {"bit": (int,), "meaning": (str,)},
    "injections": {"part": (str,), "location": (str, "none"), "unit": (str, ""), "range": (list, [0, 0]),
                   "default": (NUMBER, 0), "help": (str,)},
    "state": {"id": (int,), "force_is_on": (bool, False), "meaning": (str,)},
    "event": {"bit": (int,), "meaning": (str,)},
    "transitions": {"from": (str,), "to": (str,), "needs": (list,), "unless": (list,)},
    "conditions": {"fault": (str,), "monitored_in": (list,), "clearing": (str,), "off": (str,),
                   "voids_reference": (bool, False)},
}
TEXTS = ("help", "cause", "remedy", "meaning")
KINDS = ("real", "whole", "choice")
WIRES = ("float32", "current_int16", "duty_int16")


class Table:
    """The rows of one table, with every column."""

    def __init__(self, path: pathlib.Path, source: str, kind: str, rows: dict[str, dict]):
        self.path, self.source, self.kind = path, source, kind
        if not rows:
            self.fail("", "the table has no rows", "Restore the file.")
        self.rows = {name: self.complete(name, row) for name, row in rows.items()}

    def fail(self, name: str, problem: str, remedy: str) -> None:
        header = re.search(rf"^\s*\[(?:\w+\.)?{re.escape(name)}\]", self.source, re.MULTILINE) if name else None
        line = f":{self.source.count(chr(10), 0, header.end()) + 1}" if header else ""
        sys.exit(f"{self.path}{line}: {name + ': ' if name else ''}{problem}. {remedy}")

    def complete(self, name: str, row: object) -> dict:
        columns = COLUMNS[self.kind]
        if not NAME.fullmatch(name):
            self.fail(name, "the name is not an identifier", "Use letters, digits and underscores.")
        if not isinstance(row, dict):
            self.fail(name, "this key belongs to no row", f"Write a row [{name}] with {', '.join(columns)}.")
        for key in row:
            if key not in columns:
                self.fail(name, f"unknown column `{key}`", f"The columns are {', '.join(columns)}.")
        complete = {}
        for key, (types, *default) in columns.items():
            if key not in row and not default:
                self.fail(name, f"the column `{key}` is missing", "Add it; the top of the file describes the columns.")
            value = row.get(key, *default)
            is_bool = isinstance(value, bool)
            if not isinstance(value, types) or (is_bool and types is not bool):
                self.fail(name, f"`{key}` has the value {value!r}, which has the wrong type",
                          "The top of the file describes the columns.")
            if key in TEXTS and self.kind != "event" and not value.endswith("."):
                self.fail(name, f"`{key}` does not end with a period", "Write complete sentences.")
            if key == "range" and not (len(value) == 2 and all(
                    isinstance(bound, NUMBER) and not isinstance(bound, bool) for bound in value)
                    and (value[0] < value[1] or key not in row)):
                self.fail(name, f"{value} is not a range", "Give two numbers, the smaller one first.")
            complete[key] = value
        return complete

    def require_one_of(self, column: str, allowed: tuple[str, ...]) -> None:
        for name, row in self.rows.items():
            if row[column] not in allowed:
                self.fail(name, f"unknown {column} \"{row[column]}\"", f"Use one of: {', '.join(allowed)}.")

    def require_numbers(self, column: str, expected) -> None:
        for index, (name, row) in enumerate(self.rows.items()):
            if row[column] != expected(index):
                self.fail(name, f"`{column}` must be {expected(index)}", "Append new rows with the next number.")

    def require_default_in_range(self, name: str, value: float) -> None:
        low, high = self.rows[name]["range"]
        if not low <= value <= high:
            self.fail(name, f"the default {value} is outside the range {low} to {high}",
                      "Change the default, the range or the arm description.")

    def require_groups(self, column: str) -> None:
        seen = []
        for name, row in self.rows.items():
            if seen and row[column] == seen[-1]:
                continue
            if row[column] in seen:
                self.fail(name, f"the row is apart from the other rows of the {column} \"{row[column]}\"",
                          "Move it to these rows.")
            seen.append(row[column])

    def require_three_rows(self, columns: tuple[str, ...]) -> None:
        """A row for axis 1, 3, x or z needs the row for axis 2 or y, and agrees with it in the columns."""
        for name, row in self.rows.items():
            axis = AXIS.search(name)
            if not axis:
                continue
            middle = name[:axis.start(1)] + ("2" if axis[1].isdigit() else "y") + name[axis.end(1):]
            if middle not in self.rows:
                self.fail(name, f"the row {middle} is missing", "Add the rows 1 to 3, or x to z.")
            for column in columns:
                if self.rows[middle][column] != row[column]:
                    self.fail(name, f"`{column}` differs from the row {middle}",
                              f"The rows 1 to 3, or x to z, must agree in {', '.join(columns)}.")

    def text(self, name: str, column: str) -> str:
        return f"texts::{self.kind}::{name}_{column}"


def parse(path: pathlib.Path) -> tuple[str, dict]:
    try:
        source = path.read_text(encoding="utf-8")
        return source, tomllib.loads(source)
    except (OSError, UnicodeDecodeError) as error:
        sys.exit(f"{path}: {error}. Restore the file.")
    except tomllib.TOMLDecodeError as error:
        sys.exit(f"{path}: {error}. Correct this line; every row needs its own name.")


def load(path: pathlib.Path) -> list[Table]:
    source, content = parse(path)
    if path.stem != "supervision":
        if path.stem not in COLUMNS:
            sys.exit(f"{path}: this table is unknown. Describe its columns in {pathlib.Path(__file__).name}.")
        return [Table(path, source, path.stem, content)]
    for section in content:
        if section not in ("state", "event", "transitions", "state_sets", "conditions"):
            sys.exit(f"{path}: unknown section `{section}`. Compare the file with its committed version.")
    return [Table(path, source, kind, content.get(kind, {})) for kind in ("state", "event")]


def number(value: float) -> str:
    return f"{float(value)!r}"


def check_parameters(table: Table, arm: dict | None) -> None:
    table.require_one_of("kind", KINDS)
    table.require_groups("group")
    for row in table.rows.values():
        row["belongs_to_arm"] = row["default"] == "arm"
    table.require_three_rows(("kind", "unit", "range", "group", "needs_force_off", "belongs_to_arm"))
    before = 0
    for name, row in table.rows.items():
        if row["id"] <= before:
            table.fail(name, f"the id {row['id']} must be above {before}", "Choose a new id, and order the rows by id.")
        before = row["id"]
        if isinstance(row["default"], str):
            if row["default"] != "arm":
                table.fail(name, f"the default \"{row['default']}\" is unknown", "Give a number or \"arm\".")
            if arm is not None:
                if name not in arm:
                    table.fail(name, "the arm description has no value", f"Add the key {name} to each boards/arms/*.toml.")
                table.require_default_in_range(name, arm[name])
        else:
            table.require_default_in_range(name, row["default"])
            if row["kind"] != "real" and row["default"] != int(row["default"]):
                table.fail(name, "the default is not a whole number", "Give a whole number.")


def check(table: Table, arm: dict | None = None) -> None:
    match table.kind:
        case "parameters":
            check_parameters(table, arm)
        case "signals":
            table.require_one_of("wire", WIRES)
            table.require_numbers("id", lambda index: index)
            table.require_three_rows(("unit", "wire"))
        case "faults" | "refusals":
            table.require_numbers("code", lambda index: index)
        case "state":
            table.require_numbers("id", lambda index: index)
        case "limits" | "force_sources" | "event":
            table.require_numbers("bit", lambda index: 1 << index)
        case "injections":
            table.require_groups("part")
            for name, row in table.rows.items():
                table.require_default_in_range(name, row["default"])
                if row["range"] == [0, 0] and (row["unit"] or row["default"]):
                    table.fail(name, "an amount needs a range", "Add `range`, or remove `unit` and `default`.")


def enumeration(table: Table) -> list[str]:
    types = {"parameters": ("Parameter", 8, "Index of a parameter in the table. The protocol transmits the id instead of "
                            "the index. Values after the last\n/// enumerator are parameters of the force law."),
             "signals": ("Signal", 8, "Index of a signal in the table. The index is also the id in the protocol. Values "
                         "after the last enumerator are\n/// signals of the force law."),
             "faults": ("Fault", 8, "Cause of a stop."), "refusals": ("Refusal", 8, "Result of a parameter transaction."),
             "limits": ("Limit", 8, "Limits that reduce the force: bits of PoseReport::limits. A limit is not a fault."),
             "force_sources": ("ForceSource", 8, "Force sources that the hand feels: bits of PoseReport::force_sources."),
             "injections": ("InjectedFault", 8, "The value of an enumerator is the index of its row."),
             "state": ("State", 8, "State of the supervisor."), "event": ("Event", 16, "Inputs of the supervisor's decisions.")}
    name, bits, meaning = types[table.kind]
    column = next((column for column in ("code", "bit") if column in COLUMNS[table.kind]), None)
    lines = [f"/// {meaning}", f"enum class {name} : std::uint{bits}_t {{"]
    lines += [f"  {row_name} = {row[column] if column else index},"
              for index, (row_name, row) in enumerate(table.rows.items())]
    return lines + ["};", ""]


def row_code(table: Table, name: str, row: dict) -> str:
    def text(column: str) -> str:
        return table.text(name, column)

    match table.kind:
        case "parameters":
            default = f"arm_defaults::{name}" if row["belongs_to_arm"] else number(row["default"]) + "f"
            low, high = (number(bound) + "f" for bound in row["range"])
            fields = [str(row["id"]), json.dumps(name), f"ParameterKind::{row['kind']}", json.dumps(row["unit"]), low, high,
                      default, json.dumps(row["group"]), text("help"), str(row["belongs_to_arm"]).lower(),
                      str(row["needs_force_off"]).lower()]
        case "signals":
            fields = [str(row["id"]), json.dumps(name), json.dumps(row["unit"]), f"SignalWire::{row['wire']}", text("help")]
        case "faults" | "refusals":
            fields = [str(row["code"]), json.dumps(name), text("cause"), text("remedy")]
        case "limits":
            fields = [f"Limit::{name}", json.dumps(name), text("meaning")]
        case "force_sources":
            fields = [f"ForceSource::{name}", json.dumps(name), text("meaning")]
        case "injections":
            fields = [json.dumps(name), f"InjectionPart::{row['part']}", f"InjectionLocation::{row['location']}",
                      json.dumps(row["unit"]), *map(number, row["range"]), number(row["default"]), text("help")]
        case "state":
            fields = [json.dumps(name), str(row["force_is_on"]).lower(), text("meaning")]
        case "event":
            fields = [f"Event::{name}", json.dumps(name), text("meaning")]
    return f"    {{{', '.join(fields)}}},"


def table_code(table: Table) -> list[str]:
    info, variable = {"parameters": ("ParameterInfo", "parameter_table"), "signals": ("SignalInfo", "signal_table"),
                      "faults": ("CodeInfo", "fault_table"), "refusals": ("CodeInfo", "refusal_table"),
                      "limits": ("LimitInfo", "limit_table"), "force_sources": ("ForceSourceInfo", "force_source_table"),
                      "injections": ("InjectionInfo", "injection_table"), "state": ("StateInfo", "state_table"),
                      "event": ("EventInfo", "event_table")}[table.kind]
    columns = [column for column in TEXTS if column in COLUMNS[table.kind]]
    lines = [f"namespace texts::{table.kind} {{"]
    lines += [f"extern const char {name}_{column}[];" for name in table.rows for column in columns]
    lines += [f"}}  // namespace texts::{table.kind}", "", f"inline constexpr auto {variable} = std::to_array<{info}>({{"]
    lines += [row_code(table, name, row) for name, row in table.rows.items()]
    return lines + ["});", ""]


def rows_of(path: pathlib.Path, source: str, content: dict, kind: str) -> list[dict]:
    section = content.get(kind)
    if not isinstance(section, dict) or list(section) != ["rows"] or not isinstance(section["rows"], list):
        sys.exit(f"{path}: [{kind}] needs the list `rows`. Compare the file with its committed version.")
    named = {f"row_{index + 1}": row for index, row in enumerate(section["rows"])}
    return list(Table(path, source, kind, named).rows.values())


def monitoring_code(path: pathlib.Path) -> list[str]:
    source, content = parse(path)
    states, events = load(path)
    with_force = [name for name, row in states.rows.items() if row["force_is_on"]]
    sets = {"with_force": with_force, **content.get("state_sets", {})}

    def fail(what: str, name: str, known) -> None:
        sys.exit(f"{path}: {what}: `{name}` is unknown. Use one of: {', '.join(known)}.")

    def require(what: str, name: str, known) -> str:
        if name not in known:
            fail(what, name, known)
        return name

    def members(what: str, names: list[str], depth: int = 0) -> set[str]:
        found = set()
        for name in names:
            if name in states.rows:
                found.add(name)
            elif name in sets and depth <= len(sets):
                found |= members(what, sets[name], depth + 1)
            else:
                fail(what, name, [*states.rows, *sets])
        return found

    def event_set(what: str, names: list[str]) -> str:
        return "events(" + ", ".join(f"Event::{require(what, name, events.rows)}" for name in names) + ")" if names else "{}"

    lines = ["inline constexpr auto transition_table = std::to_array<StateTransition>({"]
    for row in rows_of(path, source, content, "transitions"):
        what = f"transition from {row['from']} to {row['to']}"
        ends = (f"State::{require(what, row[end], states.rows)}" for end in ("from", "to"))
        lines.append(f"    {{{', '.join((*ends, event_set(what, row['needs']), event_set(what, row['unless'])))}}},")
    lines += ["});", "", "inline constexpr auto condition_table = std::to_array<Condition>({"]
    seen = set()
    for row in rows_of(path, source, content, "conditions"):
        what = f"condition of {row['fault']}"
        if row["fault"] in seen:
            sys.exit(f"{path}: {what}: the fault has two rows. Remove one of them.")
        seen.add(row["fault"])
        found = members(what, row["monitored_in"])
        bits = ", ".join(f"State::{name}" for name in states.rows if name in found)
        lines.append(f"    {{Fault::{row['fault']}, States{{{bits}}}, Clearing::{row['clearing']}, Off::{row['off']}, "
                     f"{str(row['voids_reference']).lower()}}},")
    return lines + ["});", ""]


def header(path: pathlib.Path, arm: pathlib.Path | None) -> list[str]:
    values = parse(arm)[1].get("parameters", {}) if arm else None
    lines = []
    for table in load(path):
        check(table, values)
        lines += enumeration(table) + table_code(table)
    return lines


def texts(paths: list[pathlib.Path]) -> list[str]:
    lines = []
    for path in paths:
        for table in load(path):
            lines.append(f"namespace texts::{table.kind} {{")
            lines += [f"extern const char {name}_{column}[] = {json.dumps(row[column], ensure_ascii=False)};"
                      for name, row in table.rows.items() for column in TEXTS if column in row]
            lines += [f"}}  // namespace texts::{table.kind}", ""]
    return lines


def main() -> None:
    match sys.argv[1:]:
        case ["header", table, *arm] if len(arm) <= 1:
            paths, lines = [table], header(pathlib.Path(table), pathlib.Path(arm[0]) if arm else None)
        case ["monitoring", table]:
            paths, lines = [table], monitoring_code(pathlib.Path(table))
        case ["texts", _, *_]:
            paths = sys.argv[2:]
            lines = texts([pathlib.Path(path) for path in paths])
        case _:
            sys.exit(__doc__)
    names = ", ".join(pathlib.Path(path).name for path in paths)
    print(f"// Made by the build from {names}; edit that file instead.")
    if sys.argv[1] != "texts":
        print("#pragma once\n\n#include <array>\n#include <cstdint>")
    print("\nnamespace inkwell::protocol {\n")
    print("\n".join(lines))
    print("}  // namespace inkwell::protocol")


if __name__ == "__main__":
    main()
