// Identity of a firmware image at a fixed flash address. Programs check the identity before they write an image.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

#include "protocol/reports.hpp"

namespace inkwell::protocol {

/// The identity follows the vector table (RM0090, "Vector table for STM32F405xx").
inline constexpr std::uint32_t image_begin = 0x0800'0000, image_identity_offset = 512;

/// Flash size of the STM32F405 on both boards.
inline constexpr std::size_t flash_bytes = 1024 * 1024;

/// Returns true if the bytes may be the complete flash content of an STM32F405. The size must match. The reset vector
/// (RM0090, "Boot configuration") must either point into the flash or be erased.
inline bool may_be_flash(std::span<const std::byte> content) {
  if (content.size() != flash_bytes) return false;
  constexpr std::uint32_t erased = 0xFFFF'FFFF;
  std::uint32_t vectors[2];
  std::memcpy(vectors, content.data(), sizeof vectors);
  const auto [stack, first_instruction] = vectors;
  const bool is_thumb = (first_instruction & 1) != 0;
  return (stack == erased && first_instruction == erased) ||
         (is_thumb && first_instruction - image_begin < flash_bytes);
}

struct ImageIdentity {
  static constexpr char right_mark[8] = {'I', 'n', 'k', 'w', 'e', 'l', 'l', '\n'};

  char mark[8];
  std::uint16_t protocol_version;
  std::uint8_t firmware_version[3];
  std::uint8_t reserved;
  char board[board_name_maximum + 1];  ///< target board, padded with zeros

  constexpr std::array<std::uint8_t, 3> version() const {
    return {firmware_version[0], firmware_version[1], firmware_version[2]};
  }
  constexpr bool is_there() const { return std::ranges::equal(mark, right_mark) && !board_name().empty(); }
  constexpr std::string_view board_name() const { return protocol::board_name(board); }
};
static_assert(sizeof(ImageIdentity) == 46 && std::is_trivially_copyable_v<ImageIdentity>);

constexpr ImageIdentity image_identity(std::string_view board, std::uint8_t major, std::uint8_t minor,
                                       std::uint8_t patch) {
  ImageIdentity identity{};
  std::ranges::copy(ImageIdentity::right_mark, identity.mark);
  identity.protocol_version = protocol_version;
  identity.firmware_version[0] = major;
  identity.firmware_version[1] = minor;
  identity.firmware_version[2] = patch;
  std::copy_n(board.begin(), std::min(board.size(), board_name_maximum), identity.board);
  return identity;
}

}  // namespace inkwell::protocol
