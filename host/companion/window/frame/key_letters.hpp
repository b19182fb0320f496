// Maps letters to keys, so that shortcuts follow the keyboard layout. GLFW names each key by its character in the
// American layout.
#pragma once

#include <array>

namespace inkwell::window {

/// The GLFW key of each letter from a to z.
using KeyLetters = std::array<int, 26>;

/// Returns the keys of the current layout. `name_of(key)` returns the character of a key, or null. For letters that the
/// layout lacks, returns the keys of the American layout.
template <class NameOf>
KeyLetters key_letters(const NameOf& name_of) {
  constexpr int key_a = 'A', key_z = 'Z';         // GLFW_KEY_A to GLFW_KEY_Z
  constexpr int key_first = ' ', key_last = 162;  // the keys that can write characters: GLFW_KEY_SPACE to
                                                  // GLFW_KEY_WORLD_2
  KeyLetters keys{};
  for (int key = key_a; key <= key_z; ++key) keys[static_cast<std::size_t>(key - key_a)] = key;
  for (int key = key_first; key <= key_last; ++key) {
    const char* name = name_of(key);
    if (name != nullptr && name[0] >= 'a' && name[0] <= 'z' && name[1] == '\0')
      keys[static_cast<std::size_t>(name[0] - 'a')] = key;
  }
  return keys;
}

}  // namespace inkwell::window
