// Packet layer of GDB's remote serial protocol: packets, checksums, hexadecimal digits (GDB manual, appendix "Remote
// Protocol", "Overview").
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace inkwell::virtual_board {

/// Extracts packets from the received bytes.
class GdbPackets {
 public:
  struct Received {
    enum class Kind : std::uint8_t {
      packet,
      damaged,    ///< a packet with a wrong checksum
      interrupt,  ///< Ctrl-C
    };
    Kind kind;
    std::string payload;  ///< of a packet, without escape characters
  };
  void feed(std::string_view bytes) { bytes_ += bytes; }
  /// Returns the next complete packet, or nothing.
  std::optional<Received> take();

 private:
  std::string bytes_;
};

/// Returns a packet with start character, escaped payload and checksum.
std::string gdb_packet(std::string_view payload);

/// Two digits per byte.
std::string hexadecimal(std::span<const std::uint8_t> bytes);
std::string hexadecimal(std::string_view text);
/// Returns nothing if `digits` is not a sequence of hexadecimal digit pairs.
std::optional<std::vector<std::uint8_t>> bytes_of(std::string_view digits);
/// Returns nothing if `digits` is not a hexadecimal number of up to 32 bits.
std::optional<std::uint32_t> number_of(std::string_view digits);

}  // namespace inkwell::virtual_board
