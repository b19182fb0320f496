#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include <generated/known_boards.hpp>

namespace inkwell::board {

/// Returns nullptr if no board has this name.
constexpr const Facts* find_board(std::string_view name) {
  const auto found = std::ranges::find(known_boards, name, [](const Facts* board) { return board->name; });
  return found == std::end(known_boards) ? nullptr : *found;
}

/// "bench_modules, omni_driver"
inline std::string names_of_boards() {
  std::string names;
  for (const Facts* board : known_boards) names += (names.empty() ? "" : ", ") + std::string(board->name);
  return names;
}

/// File name of the firmware image for a board.
inline std::string image_name(const Facts& board) {
  return &board == &default_board ? "inkwell.elf" : "inkwell-" + std::string(board.name) + ".elf";
}

}  // namespace inkwell::board
