#include "boards/stm32f405/debugger/gdb_packets.hpp"
#include <charconv>

#include <fmt/format.h>

namespace inkwell::virtual_board {
namespace {

constexpr char ctrl_c = '\x03', escape = '}';
constexpr std::size_t packet_maximum = 1 << 20;

std::uint8_t checksum(std::string_view text) {
  std::uint8_t sum = 0;
  for (const char c : text) sum = static_cast<std::uint8_t>(sum + static_cast<std::uint8_t>(c));
  return sum;
}

std::string without_escapes(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i)
    plain += text[i] == escape && i + 1 < text.size() ? static_cast<char>(text[++i] ^ 0x20) : text[i];
  return plain;
}

}  // namespace

std::optional<GdbPackets::Received> GdbPackets::take() {
  // Between packets, all bytes except Ctrl-C are ignored.
  const auto begin = bytes_.find_first_of(std::string{'$', ctrl_c});
  bytes_.erase(0, begin);
  if (bytes_.empty()) return std::nullopt;
  if (bytes_.front() == ctrl_c) {
    bytes_.erase(0, 1);
    return Received{Received::Kind::interrupt, {}};
  }
  const auto end = bytes_.find('#');
  if (end == std::string::npos ? bytes_.size() > packet_maximum : end > packet_maximum) {
    bytes_.clear();
    return Received{Received::Kind::damaged, {}};
  }
  constexpr std::size_t checksum_digits = 2;
  if (end == std::string::npos || bytes_.size() < end + 1 + checksum_digits) return std::nullopt;
  const std::string payload = bytes_.substr(1, end - 1);
  const auto sum = number_of(std::string_view(bytes_).substr(end + 1, checksum_digits));
  bytes_.erase(0, end + 1 + checksum_digits);
  if (sum != checksum(payload)) return Received{Received::Kind::damaged, {}};
  return Received{Received::Kind::packet, without_escapes(payload)};
}

std::string gdb_packet(std::string_view payload) {
  std::string escaped;
  for (const char c : payload) {
    if (c == '#' || c == '$' || c == '*' || c == escape) {
      escaped += escape;
      escaped += static_cast<char>(c ^ 0x20);
    } else {
      escaped += c;
    }
  }
  return fmt::format("${}#{:02x}", escaped, checksum(escaped));
}

std::string hexadecimal(std::span<const std::uint8_t> bytes) {
  std::string digits;
  for (const std::uint8_t byte : bytes) digits += fmt::format("{:02x}", byte);
  return digits;
}

std::string hexadecimal(std::string_view text) {
  return hexadecimal(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

std::optional<std::vector<std::uint8_t>> bytes_of(std::string_view digits) {
  if (digits.size() % 2 != 0) return std::nullopt;
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    const auto byte = number_of(digits.substr(i, 2));
    if (!byte) return std::nullopt;
    bytes.push_back(static_cast<std::uint8_t>(*byte));
  }
  return bytes;
}

std::optional<std::uint32_t> number_of(std::string_view digits) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

}  // namespace inkwell::virtual_board
