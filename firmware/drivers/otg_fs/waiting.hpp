// Waits for the core, each with an end: it answers within a packet's time of 50 us or never.
#pragma once

#include <cstdint>

namespace inkwell::drivers {

/// A turn reads a register of the core and takes ten processor cycles or more, so this is 60 us or more.
inline constexpr std::uint32_t core_wait_turns = 1000;

template <class Condition>
[[nodiscard]] bool wait_for(Condition condition) {
  for (std::uint32_t turn = 0; turn < core_wait_turns; ++turn)
    if (condition()) return true;
  return false;
}

}  // namespace inkwell::drivers
