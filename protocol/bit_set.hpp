// Set of up to 32 bits of type `Bit`.
#pragma once

#include <cstdint>

namespace inkwell::protocol {

/// Numbers and sets of another type do not convert to a BitSet implicitly.
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
