// Set of up to 32 bits with a type for each kind of bit.
#pragma once

#include <cstdint>

namespace inkwell::protocol {

/// Sets of different kinds do not convert to each other, and a number does not convert to a set. `Bit` is the type that
/// the bits stand for.
template <class Bit>
class BitSet {
 public:
  constexpr BitSet() = default;
  constexpr explicit BitSet(std::uint32_t bits) : bits_(bits) {}

  constexpr std::uint32_t bits() const { return bits_; }
  constexpr bool any() const { return bits_ != 0; }

  constexpr BitSet operator|(BitSet other) const { return BitSet(bits_ | other.bits_); }
  constexpr BitSet operator&(BitSet other) const { return BitSet(bits_ & other.bits_); }
  constexpr BitSet operator^(BitSet other) const { return BitSet(bits_ ^ other.bits_); }
  constexpr BitSet operator~() const { return BitSet(~bits_); }
  constexpr BitSet& operator|=(BitSet other) { return *this = *this | other; }
  constexpr bool operator==(const BitSet&) const = default;

 private:
  std::uint32_t bits_ = 0;
};

}  // namespace inkwell::protocol
