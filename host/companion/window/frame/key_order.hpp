// Keeps a key and its modifiers together. ImGui 1.87 and later queues the key events, and combines the press of a key
// and a later release of a modifier in the same frame. The key would then have no modifier.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace inkwell::window {

enum class QueuedInput {
  key_press,  ///< of a key that is not a modifier
  modifier,   ///< press or release of Ctrl, Shift, Alt or Super
  other
};

/// Returns the number of queued events, from the oldest, that one frame may apply. The number ends before the first
/// modifier that follows a key press.
inline std::size_t events_of_frame(std::span<const QueuedInput> queue) {
  const auto press = std::ranges::find(queue, QueuedInput::key_press);
  return static_cast<std::size_t>(std::find(press, queue.end(), QueuedInput::modifier) - queue.begin());
}

}  // namespace inkwell::window
