// Named registers and fields for the peripheral models of the virtual chip.
//
// These register maps are independent of the firmware's register maps, so that one mistake cannot affect both. The
// script tools/check/check_registers.py compares all maps with the manufacturer's chip description.
//
// CrcRegisters in crc.hpp is a short example. A map contains only registers and fields, so code can access a map as an
// array of entries. Maps are compile-time constants, so `crc.cr.reset.in(word)` compiles to a mask. Register and field
// names are from the reference manual.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace inkwell::virtual_board {

/// Access rights of firmware to a field (RM0090, "List of abbreviations for registers").
enum class Access : std::uint8_t {
  rw,     ///< read and write
  r,      ///< read only
  w,      ///< write only
  rc_w0,  ///< writing 0 clears it
  rc_w1,  ///< writing 1 clears it
  rs,     ///< writing 1 sets it, hardware clears it
};

/// Repetition of a register or field. `stride` is in bytes for registers and in bits for fields. The repetitions have
/// numbers from `first` on. The number of a repetition replaces the `#` in the name. Numbers from 'A' on are letters. A
/// field without repetition has the number of its register.
struct Repeat {
  unsigned count = 1, stride = 0, first = 0;
};

struct MapEntry {
  std::array<char, 20> name{};
  std::uint32_t reset_value = 0;     ///< registers only
  std::uint16_t first_position = 0;  ///< byte offset of a register, bit position of a field
  std::uint16_t stride = 0;
  std::uint8_t width = 32, count = 1, first = 0;
  Access access = Access::rw;
  std::uint32_t is_register = 0;

  static consteval std::array<char, 20> named(const char* text) {
    std::array<char, 20> letters{};
    for (std::size_t i = 0; text[i] != 0; ++i) letters.at(i) = text[i];
    return letters;
  }
};
static_assert(sizeof(MapEntry) == 36, "no padding, or a map could not be read as an array");

struct Field : MapEntry {
  consteval Field(const char* text, unsigned position, unsigned bits = 1, Access allowed = Access::rw,
                  Repeat repeat = {})
      : MapEntry{named(text),
                 0,
                 static_cast<std::uint16_t>(position),
                 static_cast<std::uint16_t>(repeat.stride),
                 static_cast<std::uint8_t>(bits),
                 static_cast<std::uint8_t>(repeat.count),
                 static_cast<std::uint8_t>(repeat.first),
                 allowed,
                 0} {}
  constexpr unsigned position(unsigned index = 0) const { return first_position + stride * index; }
  constexpr std::uint32_t maximum() const { return width == 32 ? 0xFFFF'FFFF : (1u << width) - 1; }
  constexpr std::uint32_t mask(unsigned index = 0) const { return maximum() << position(index); }
  /// Value of the field in a register value.
  constexpr std::uint32_t of(std::uint32_t word, unsigned index = 0) const {
    return word >> position(index) & maximum();
  }
  /// Returns true if the field is not 0 in a register value.
  constexpr bool in(std::uint32_t word, unsigned index = 0) const { return of(word, index) != 0; }
  /// Value shifted to the position of the field.
  constexpr std::uint32_t with(std::uint32_t value, unsigned index = 0) const {
    return (value & maximum()) << position(index);
  }
  /// Combined mask of all repetitions.
  constexpr std::uint32_t masks() const {
    std::uint32_t bits = 0;
    for (unsigned i = 0; i < count; ++i) bits |= mask(i);
    return bits;
  }
};

/// A Register object converts to its offset.
struct Register : MapEntry {
  consteval Register(const char* text, unsigned offset, std::uint32_t value_after_reset = 0, Repeat repeat = {})
      : MapEntry{named(text),
                 value_after_reset,
                 static_cast<std::uint16_t>(offset),
                 static_cast<std::uint16_t>(repeat.stride),
                 32,
                 static_cast<std::uint8_t>(repeat.count),
                 static_cast<std::uint8_t>(repeat.first),
                 Access::rw,
                 1} {}
  constexpr operator std::uint32_t() const { return first_position; }
  constexpr bool covers(std::uint32_t offset) const {
    return offset >= first_position && offset < first_position + std::uint32_t{stride} * count &&
           (offset - first_position) % stride == 0;
  }
  /// Index of the repeated register at this offset.
  constexpr unsigned index(std::uint32_t offset) const { return (offset - first_position) / stride; }
};

/// Returns the entries of a map or of one register in the order of declaration.
template <class Map>
constexpr auto entries_of(const Map& map) {
  return std::bit_cast<std::array<MapEntry, sizeof(Map) / sizeof(MapEntry)>>(map);
}

/// Returns the combined mask of the fields with this access right.
template <class OneRegister>
consteval std::uint32_t bits_of(const OneRegister& one_register, Access access) {
  std::uint32_t bits = 0;
  for (const auto& entry : entries_of(one_register))
    for (unsigned i = 0; entry.is_register == 0 && entry.access == access && i < entry.count; ++i)
      bits |= (entry.width == 32 ? 0xFFFF'FFFF : (1u << entry.width) - 1) << (entry.first_position + entry.stride * i);
  return bits;
}

/// Mask of the read-write bits.
template <class OneRegister>
consteval std::uint32_t writable(const OneRegister& one_register) {
  return bits_of(one_register, Access::rw);
}

/// Register map of one peripheral for comparison tools.
struct RegisterMap {
  std::string name;
  std::uint32_t base;
  std::span<const MapEntry> entries;
};

template <const auto& map>
std::span<const MapEntry> shown() {
  static constexpr auto entries = entries_of(map);
  return entries;
}

}  // namespace inkwell::virtual_board
