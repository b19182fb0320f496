// How many bits a packet gets beside its own: after six ones in a row a transmitter puts a zero (USB 2.0,
// section 7.1.9).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace inkwell::virtual_board {

/// Of a data packet: identifier, payload and checksum. The last bit of the synchronisation is a one and counts.
inline unsigned stuffed_bits(bool data1, std::span<const std::byte> payload) {
  constexpr unsigned ones_allowed = 6;
  constexpr std::uint8_t data0_identifier = 0xC3, data1_identifier = 0x4B;
  constexpr std::uint16_t polynomial = 0xA001;  // x^16 + x^15 + x^2 + 1, least significant bit first
  unsigned ones = 1, stuffed = 0;
  std::uint16_t checksum = 0xFFFF;
  const auto send = [&](unsigned value, unsigned bits) {
    for (unsigned i = 0; i < bits; ++i) {
      ones = (value >> i & 1) != 0 ? ones + 1 : 0;
      if (ones != ones_allowed) continue;
      ++stuffed;
      ones = 0;
    }
  };
  send(data1 ? data1_identifier : data0_identifier, 8);
  for (const std::byte one : payload) {
    const auto value = std::to_integer<std::uint8_t>(one);
    send(value, 8);
    checksum ^= value;
    for (int i = 0; i < 8; ++i)
      checksum = static_cast<std::uint16_t>((checksum & 1) != 0 ? checksum >> 1 ^ polynomial : checksum >> 1);
  }
  send(static_cast<std::uint16_t>(~checksum), 16);
  return stuffed;
}

/// At most, for a schedule that does not know what will come.
constexpr std::uint64_t stuffed_bits_maximum(std::size_t payload_bytes) { return (payload_bytes * 8 + 24 + 5) / 6; }

}  // namespace inkwell::virtual_board
