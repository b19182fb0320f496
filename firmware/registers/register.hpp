// Registers and fields as types. Addresses are template arguments, so an access compiles to a load or a store.
//
// The tool tools/check/check_registers.py compares the compiled headers with the manufacturer's description of the
// chip. The header registers/watchdog.hpp is a short example.
//
// The reference manual defines the register and field names.
#pragma once

#include <cstdint>

namespace inkwell::registers {

[[gnu::error("this value does not fit into the field")]] void value_does_not_fit_into_its_field();

/// Field of register `Owner_`. An object of this class is a value for the field:
/// `TIM1::CR1::modify(TIM1::CR1::CEN(1))`.
template <class Owner_, unsigned position_, unsigned width_>
struct Field {
  static_assert(width_ >= 1 && position_ + width_ <= 32);
  using Owner = Owner_;
  static constexpr unsigned position = position_;
  static constexpr unsigned width = width_;
  static constexpr std::uint32_t maximum = width == 32 ? 0xFFFF'FFFFu : (1u << width % 32) - 1u;
  static constexpr std::uint32_t mask = maximum << position;

  std::uint32_t bits;  ///< value at its position in the register

  /// A constant that is too large does not compile. A variable is truncated to the width of the field.
  [[gnu::always_inline]] explicit constexpr Field(std::uint32_t value) : bits((value & maximum) << position) {
    if (__builtin_constant_p(value > maximum) && value > maximum) value_does_not_fit_into_its_field();
  }

  static std::uint32_t read() { return from(Owner::read()); }
  static bool is_set() { return read() != 0; }
  /// Extracts the field from a register value.
  static constexpr std::uint32_t from(std::uint32_t word) { return (word & mask) >> position; }
};

/// Register of 32 bits. `Value` is a narrower type if the manual requires narrower accesses.
template <std::uint32_t address_, class Value = std::uint32_t>
struct Register {
  static constexpr std::uint32_t address = address_;

  static Value read() { return at(); }
  static void write(Value value) { at() = value; }
  /// Writes the given fields, and writes zero to all other fields.
  template <class... Fields>
  requires(sizeof...(Fields) > 0 && (requires { typename Fields::Owner; } && ...)) static void write(Fields... fields) {
    static_assert(((Fields::Owner::address == address) && ...), "a field of another register");
    at() = static_cast<Value>((fields.bits | ...));
  }
  /// Changes only the given fields. Do not use modify() for a register with flags that are cleared by writing one.
  template <class... Fields>
  static void modify(Fields... fields) {
    static_assert(((Fields::Owner::address == address) && ...), "a field of another register");
    at() = static_cast<Value>((at() & ~(Fields::mask | ...)) | (fields.bits | ...));
  }

 private:
  static volatile Value& at() { return *reinterpret_cast<volatile Value*>(address); }
};

/// `count` registers with the same fields, `stride` bytes apart. The caller ensures that `index` is below `count`.
template <std::uint32_t address_, std::uint32_t stride, unsigned count_, class Value = std::uint32_t>
struct RegisterArray {
  static constexpr std::uint32_t address = address_;
  static constexpr unsigned count = count_;

  static Value read(unsigned index) { return at(index); }
  static void write(unsigned index, Value value) { at(index) = value; }
  template <class... Fields>
  requires(sizeof...(Fields) > 0 && (requires { typename Fields::Owner; } && ...)) static void write(unsigned index,
                                                                                                     Fields... fields) {
    static_assert(((Fields::Owner::address == address) && ...), "a field of another register");
    at(index) = static_cast<Value>((fields.bits | ...));
  }
  template <class... Fields>
  static void modify(unsigned index, Fields... fields) {
    static_assert(((Fields::Owner::address == address) && ...), "a field of another register");
    at(index) = static_cast<Value>((at(index) & ~(Fields::mask | ...)) | (fields.bits | ...));
  }

 private:
  static volatile Value& at(unsigned index) { return *reinterpret_cast<volatile Value*>(address + stride * index); }
};

}  // namespace inkwell::registers
