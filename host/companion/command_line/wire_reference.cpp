#include "host/companion/command_line/wire_reference.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "protocol/black_box.hpp"
#include "protocol/driver.hpp"
#include "protocol/reports.hpp"
#include "protocol/scope.hpp"
#include "protocol/store.hpp"
#include "protocol/usb_identity.hpp"

namespace inkwell::protocol::layouts {

struct Intro {
  std::string_view header, text;
};
struct Field {
  std::string_view type, name;
  std::size_t offset, bytes;
  std::size_t count;         ///< array length; 0 if the field is not an array
  unsigned first_bit, bits;  ///< 0 bits for a field of whole bytes
  std::string_view value, meaning;
};
struct Struct {
  std::string_view name;
  std::size_t bytes;
  std::string_view meaning;
  std::span<const Field> fields;
};
struct Enumerator {
  std::string_view name;
  unsigned value;
  std::string_view meaning;
};
struct Enumeration {
  std::string_view name;
  std::size_t bytes;
  std::string_view meaning;
  std::span<const Enumerator> enumerators;
};
struct Constant {
  std::string_view name;
  double value;
  std::string_view meaning;
};

}  // namespace inkwell::protocol::layouts

#include <wire_layouts.hpp>  // generated from the protocol headers; uses the structures above

namespace inkwell::command_line {
namespace {

namespace layouts = protocol::layouts;

/// Returns true if there are no gaps between the fields. Fields of a union and bit fields may have equal offsets.
constexpr bool is_whole(const layouts::Struct& row) {
  std::size_t begin = 0, end = 0;
  for (const auto& field : row.fields) {
    if (field.offset != end && field.offset != begin) return false;
    begin = field.offset;
    end = std::max(end, field.offset + field.bytes);
  }
  return end == row.bytes;
}
static_assert(std::all_of(std::begin(layouts::structs), std::end(layouts::structs), is_whole),
              "a protocol structure has a gap, or a field that tools/generate/generate_layouts.py did not find");

std::string type_of(const layouts::Field& field) {
  if (field.bits > 0 && field.bits == 1) return fmt::format("bit {}", field.first_bit);
  if (field.bits > 0) return fmt::format("bits {} to {}", field.first_bit, field.first_bit + field.bits - 1);
  return field.count > 0 ? fmt::format("{}[{}]", field.type, field.count) : std::string(field.type);
}

std::string meaning_of(const layouts::Field& field) {
  if (field.value.empty()) return std::string(field.meaning);
  return fmt::format("always `{}`{}{}", field.value, field.meaning.empty() ? "" : "; ", field.meaning);
}

void print_structs() {
  for (const auto& row : layouts::structs) {
    fmt::print("\n### {}, {} bytes\n\n", row.name, row.bytes);
    if (!row.meaning.empty()) fmt::print("{}\n\n", row.meaning);
    fmt::print("| offset | bytes | type | field | meaning |\n| --- | --- | --- | --- | --- |\n");
    for (const auto& field : row.fields)
      fmt::print("| {} | {} | {} | `{}` | {} |\n", field.offset, field.bytes, type_of(field), field.name,
                 meaning_of(field));
  }
}

void print_enumerations() {
  for (const auto& row : layouts::enumerations) {
    fmt::print("\n### {}, {} byte{}\n\n", row.name, row.bytes, row.bytes == 1 ? "" : "s");
    if (!row.meaning.empty()) fmt::print("{}\n\n", row.meaning);
    fmt::print("| value | name | meaning |\n| --- | --- | --- |\n");
    for (const auto& each : row.enumerators) fmt::print("| {} | {} | {} |\n", each.value, each.name, each.meaning);
  }
}

}  // namespace

std::string_view name_of(protocol::SignalWire wire) {
  for (const auto& row : layouts::enumerators_of_SignalWire)
    if (row.value == static_cast<unsigned>(wire)) return row.name;
  return "";
}

void print_wire() {
  fmt::print(
      "\n"
      "## Wire format\n\n"
      "The byte order is little-endian. `float` is a 32-bit IEEE 754 number. Offsets and sizes are in bytes; bit 0 is "
      "the lowest bit. The codes of State, Fault, Refusal, RequestResult, ForceSource and Limit are in the tables "
      "below.\n");
  for (const auto& intro : layouts::intros) {
    std::string text = "    ";
    for (const char letter : intro.text) text += letter == '\n' ? std::string("\n    ") : std::string(1, letter);
    fmt::print(
        "\n"
        "From `{}`:\n\n"
        "{}\n",
        intro.header, text);
  }
  print_structs();
  print_enumerations();
  fmt::print("\n### Constants\n\n| name | value | meaning |\n| --- | --- | --- |\n");
  for (const auto& row : layouts::constants) {
    const bool is_whole_number = row.value == std::floor(row.value);
    fmt::print("| `{}` | {} | {} |\n", row.name,
               is_whole_number ? fmt::format("{:.0f}", row.value) : fmt::format("{:.6g}", row.value), row.meaning);
  }
}

}  // namespace inkwell::command_line
