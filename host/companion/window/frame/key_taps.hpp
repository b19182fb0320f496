// Stores keys that are pressed and released between two frames. ImGui polls the key states once per frame and would
// miss these keys.
#pragma once

#include <span>
#include <utility>
#include <vector>

namespace inkwell::window {

class KeyTaps {
 public:
  /// Records the press of a key.
  void note(int key) { noted_.push_back(key); }

  /// Marks the stored keys as pressed for one frame. Call before each frame.
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
