// Registers and their fields, declared by name: what a peripheral of the virtual chip takes its bits from.
//
// Apart from the firmware's register map on purpose, so that a mistake in one is not made in the other.
// tools/check_registers.py compares both with the manufacturer's description of the chip.
//
//   struct CrcRegisters {
//     struct : Register {
//       Field dr{"DR", 0, 32};
//     } dr{{"DR", 0x00, 0xFFFF'FFFF}};
//     struct : Register {
//       Field reset{"RESET", 0, 1, Access::w};
//     } cr{{"CR", 0x08}};
//   };
//   inline constexpr CrcRegisters crc_registers;
//
// A map holds nothing but registers and fields, so it can be read as an array of entries: nothing in it can be
// forgotten when it is printed. All of it is known to the compiler: `crc_registers.cr.reset.in(word)` is a mask.
// Names are those of the reference manual.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace inkwell::virtual_board {

/// What firmware can do to a field, in RM0090's words ("List of abbreviations for registers").
enum class Access : std::uint8_t {
  rw,     ///< read and write
  r,      ///< read only
  w,      ///< write only
  rc_w0,  ///< a 0 clears it
  rc_w1,  ///< a 1 clears it
  rs,     ///< a 1 sets it, hardware clears it
};

/// Registers or fields of one form that follow each other: how many, how far apart (registers: bytes, fields:
/// bits), and the number of the first. The number stands in for the `#` in their name; from 'A' on it is a letter.
/// A field that is not repeated takes the number of its register.
struct Repeat {
  unsigned count = 1, stride = 0, first = 0;
};

struct MapEntry {
  std::array<char, 20> name{};
  std::uint32_t reset_value = 0;  ///< of a register
  std::uint16_t place = 0;        ///< byte offset of a register, bit position of a field
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
  constexpr unsigned position(unsigned index = 0) const { return place + stride * index; }
  constexpr std::uint32_t maximum() const { return width == 32 ? 0xFFFF'FFFF : (1u << width) - 1; }
  constexpr std::uint32_t mask(unsigned index = 0) const { return maximum() << position(index); }
  /// The field's value in a word of its register.
  constexpr std::uint32_t of(std::uint32_t word, unsigned index = 0) const {
    return word >> position(index) & maximum();
  }
  /// The field is not 0 in a word of its register.
  constexpr bool in(std::uint32_t word, unsigned index = 0) const { return of(word, index) != 0; }
  /// A value at its place.
  constexpr std::uint32_t with(std::uint32_t value, unsigned index = 0) const {
    return (value & maximum()) << position(index);
  }
  /// Masks of all the fields of a repeated one together.
  constexpr std::uint32_t masks() const {
    std::uint32_t bits = 0;
    for (unsigned i = 0; i < count; ++i) bits |= mask(i);
    return bits;
  }
};

/// Used as a number it is the offset.
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
  constexpr operator std::uint32_t() const { return place; }
  constexpr bool covers(std::uint32_t offset) const {
    return offset >= place && offset < place + std::uint32_t{stride} * count && (offset - place) % stride == 0;
  }
  /// Of a repeated register that covers the offset.
  constexpr unsigned index(std::uint32_t offset) const { return (offset - place) / stride; }
};

/// Registers and fields of a map, or of one register, in the order of declaration.
template <class Map>
constexpr auto entries_of(const Map& map) {
  return std::bit_cast<std::array<MapEntry, sizeof(Map) / sizeof(MapEntry)>>(map);
}

/// Masks of a register's fields with this access.
template <class OneRegister>
consteval std::uint32_t bits_of(const OneRegister& one_register, Access access) {
  std::uint32_t bits = 0;
  for (const auto& entry : entries_of(one_register))
    for (unsigned i = 0; entry.is_register == 0 && entry.access == access && i < entry.count; ++i)
      bits |= (entry.width == 32 ? 0xFFFF'FFFF : (1u << entry.width) - 1) << (entry.place + entry.stride * i);
  return bits;
}

/// What a write can change and a read gives back.
template <class OneRegister>
consteval std::uint32_t writable(const OneRegister& one_register) {
  return bits_of(one_register, Access::rw);
}

/// A peripheral's registers, to be shown to who checks them.
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
