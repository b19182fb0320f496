// Transfer from a driver to the host controller (USB request block of USB/IP and Linux).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace inkwell::virtual_board {

/// Results of a transfer: negative Linux errno values, as in USB/IP.
namespace transfer_status {
inline constexpr std::int32_t success = 0, busy = -16, invalid = -22, stalled = -32, no_answer = -71, overflow = -75,
                              unlinked = -104, short_packet = -121;
}

namespace transfer_flag {
inline constexpr std::uint32_t short_is_error = 0x0001, zero_packet = 0x0040;
}

struct Urb {
  std::uint32_t sequence = 0;
  bool internal = false;      ///< submitted by the host controller during enumeration
  std::uint8_t endpoint = 0;  ///< number, without the direction
  bool in = false;
  std::uint32_t flags = 0;
  std::uint32_t length = 0;  ///< bytes to send, or space for received bytes
  std::array<std::byte, 8> setup{};
  /// Offset and length of an isochronous packet. The host controller does not execute isochronous transfers.
  struct Packet {
    std::uint32_t offset, length;
  };
  std::vector<Packet> packets;
  std::vector<std::byte> data;  ///< OUT: `length` bytes; IN: bytes received so far

  // Progress.
  enum class Stage : std::uint8_t { setup, data, status };
  Stage stage = Stage::setup;  ///< of control transfers
  std::uint32_t sent = 0;

  std::uint32_t actual_length() const { return in ? static_cast<std::uint32_t>(data.size()) : sent; }
};

}  // namespace inkwell::virtual_board
