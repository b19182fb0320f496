// Keeps a key and its modifiers together. ImGui 1.87 and later could apply a key press and the release of its modifier
// in the same frame. ImGui would then ignore the modifier.
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

/// Returns the number of oldest events that one frame may apply. A frame must not apply a modifier event after a key
/// press.
inline std::size_t events_of_frame(std::span<const QueuedInput> queue) {
  const auto press = std::ranges::find(queue, QueuedInput::key_press);
  return static_cast<std::size_t>(std::find(press, queue.end(), QueuedInput::modifier) - queue.begin());
}

}  // namespace inkwell::window
