#include "boards/virtual/program/serial_number.hpp"

#include <unistd.h>

#include <charconv>
#include <stdexcept>
#include <string>

namespace inkwell::virtual_board {
namespace {

constexpr std::size_t digits_of_word = 8, digits_of_all = 24;

/// Last word of the unique identifier. The last word differs for each source of identifiers.
enum Lot : std::uint32_t {
  of_seed = 0x3932'3539,
  of_flash = 0x3932'3546,
  of_port = 0x3932'3550,
  of_socket = 0x3932'3555,
  of_process = 0x3932'3558
};

UniqueId unique_id_of_path(const std::filesystem::path& file, Lot lot) {
  std::error_code code;
  const auto real = std::filesystem::weakly_canonical(std::filesystem::absolute(file, code), code);
  std::uint64_t hash = 0xCBF2'9CE4'8422'2325;  // FNV-1a
  for (const char letter : (code ? file : real).string())
    hash = (hash ^ static_cast<std::uint8_t>(letter)) * 0x100'0000'01B3;
  return {static_cast<std::uint32_t>(hash), static_cast<std::uint32_t>(hash >> 32), lot};
}

}  // namespace

UniqueId unique_id_of(std::string_view serial_number) {
  const bool is_number = !serial_number.empty() && serial_number.size() <= digits_of_all &&
                         serial_number.find_first_not_of("0123456789abcdefABCDEF") == std::string_view::npos;
  if (!is_number)
    throw std::invalid_argument("`" + std::string(serial_number) +
                                "` is not a serial number. Use up to 24 hexadecimal digits, for example 2A.");
  const std::string padded = std::string(digits_of_all - serial_number.size(), '0') + std::string(serial_number);
  UniqueId id{};
  for (std::size_t i = 0; i < id.size(); ++i) {
    const char* begin = padded.data() + i * digits_of_word;
    std::from_chars(begin, begin + digits_of_word, id[i], 16);
  }
  return id;
}

UniqueId unique_id_of_seed(std::uint64_t seed) {
  return {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32), of_seed};
}

UniqueId unique_id_of_flash(const std::filesystem::path& file) { return unique_id_of_path(file, of_flash); }

UniqueId unique_id_of_socket(const std::filesystem::path& file) { return unique_id_of_path(file, of_socket); }

UniqueId unique_id_of_port(std::uint16_t usbip_port) { return {usbip_port, 0, of_port}; }

UniqueId unique_id_of_process() { return {static_cast<std::uint32_t>(getpid()), 0, of_process}; }

}  // namespace inkwell::virtual_board
