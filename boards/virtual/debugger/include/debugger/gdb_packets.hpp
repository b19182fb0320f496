// GDB's remote serial protocol, as far as the wire goes: packets, checksums, hexadecimal (GDB manual, appendix
// "Remote Protocol", "Overview").
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace inkwell::virtual_board {

/// Finds packets in the bytes that GDB sends.
class GdbPackets {
 public:
  struct Received {
    enum class Kind : std::uint8_t {
      packet,
      damaged,    ///< a packet whose checksum is wrong
      interrupt,  ///< Ctrl-C
    };
    Kind kind;
    std::string payload;  ///< of a packet, without escapes
  };
  void feed(std::string_view bytes) { bytes_ += bytes; }
  /// The next one, once it is there whole.
  std::optional<Received> take();

 private:
  std::string bytes_;
};

/// A packet on the wire.
std::string gdb_packet(std::string_view payload);

/// Two digits a byte.
std::string hexadecimal(std::span<const std::uint8_t> bytes);
std::string hexadecimal(std::string_view text);
/// Nothing if `digits` are not pairs of hexadecimal digits.
std::optional<std::vector<std::uint8_t>> bytes_of(std::string_view digits);
/// Nothing if `digits` are not a hexadecimal number of up to 32 bits.
std::optional<std::uint32_t> number_of(std::string_view digits);

}  // namespace inkwell::virtual_board
