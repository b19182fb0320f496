// Keeps short keystrokes. ImGui looks once a frame at which keys are down, and would miss one that went down and up
// between two frames.
#pragma once

#include <span>
#include <utility>
#include <vector>

namespace inkwell::window {

class KeyTaps {
 public:
  /// A key went down.
  void note(int key) { noted_.push_back(key); }

  /// Before each frame: what was only tapped since the last one is down for this frame, and up again in the next.
  void apply(std::span<bool> keys_down) {
    for (int key : held_) keys_down[static_cast<std::size_t>(key)] = false;
    held_.clear();
    for (int key : std::exchange(noted_, {})) {
      if (key < 0 || static_cast<std::size_t>(key) >= keys_down.size()) continue;
      bool& down = keys_down[static_cast<std::size_t>(key)];
      if (!down) held_.push_back(key);
      down = true;
    }
  }

 private:
  std::vector<int> noted_;
  std::vector<int> held_;
};

}  // namespace inkwell::window
