// Number of stuffed bits in a packet. The sender inserts a 0 bit after six consecutive 1 bits (USB 2.0, section 7.1.9).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace inkwell::virtual_board {

/// Bit stuffing of one byte, for a given number of preceding 1 bits.
struct StuffedByte {
  std::uint8_t stuffed, ones;  ///< inserted zeros, and consecutive ones at the end of the byte
};

inline constexpr unsigned ones_before_stuffing = 6;

/// The indices are the number of preceding 1 bits and the byte value.
inline constexpr auto stuffed_bytes = [] {
  std::array<std::array<StuffedByte, 256>, ones_before_stuffing> table{};
  for (unsigned before = 0; before < ones_before_stuffing; ++before)
    for (unsigned value = 0; value < 256; ++value) {
      unsigned ones = before, stuffed = 0;
      for (unsigned bit = 0; bit < 8; ++bit) {
        ones = (value >> bit & 1) != 0 ? ones + 1 : 0;
        if (ones != ones_before_stuffing) continue;
        ++stuffed;
        ones = 0;
      }
      table[before][value] = {static_cast<std::uint8_t>(stuffed), static_cast<std::uint8_t>(ones)};
    }
  return table;
}();

/// CRC16 of each byte value: x^16 + x^15 + x^2 + 1, least significant bit first (USB 2.0, section 8.3.5.2).
inline constexpr auto data_checksums = [] {
  constexpr std::uint16_t polynomial = 0xA001;
  std::array<std::uint16_t, 256> table{};
  for (unsigned value = 0; value < 256; ++value) {
    unsigned rest = value;
    for (unsigned bit = 0; bit < 8; ++bit) rest = (rest & 1) != 0 ? rest >> 1 ^ polynomial : rest >> 1;
    table[value] = static_cast<std::uint16_t>(rest);
  }
  return table;
}();

/// Number of stuffed bits in the identifier, the payload and the checksum of a data packet. The count of consecutive 1
/// bits starts with the last bit of the synchronization pattern.
inline unsigned stuffed_bits(bool data1, std::span<const std::byte> payload) {
  constexpr std::uint8_t data0_identifier = 0xC3, data1_identifier = 0x4B;
  unsigned ones = 1, stuffed = 0, checksum = 0xFFFF;
  const auto send = [&](unsigned value) {
    const StuffedByte& byte = stuffed_bytes[ones][value & 0xFF];
    stuffed += byte.stuffed;
    ones = byte.ones;
  };
  send(data1 ? data1_identifier : data0_identifier);
  for (const std::byte one : payload) {
    const auto value = std::to_integer<std::uint8_t>(one);
    send(value);
    checksum = checksum >> 8 ^ data_checksums[(checksum ^ value) & 0xFF];
  }
  send(~checksum);
  send(~checksum >> 8);
  return stuffed;
}

/// Largest possible number of stuffed bits. The frame schedule uses the largest number, so that the schedule is
/// independent of the data.
constexpr std::uint64_t stuffed_bits_maximum(std::size_t payload_bytes) { return (payload_bytes * 8 + 24 + 5) / 6; }

}  // namespace inkwell::virtual_board
