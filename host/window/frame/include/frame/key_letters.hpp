// Which key writes which letter: shortcuts go by the character, not by the place that the key has on an American
// keyboard, whose names GLFW gives to the keys.
#pragma once

#include <array>

namespace inkwell::window {

/// GLFW's keys that write a to z.
using KeyLetters = std::array<int, 26>;

/// `name_of(key)`: what a key writes, as glfwGetKeyName gives it; null for none. A letter that no key writes, as on a
/// Greek keyboard, stays where it is on an American one.
template <class NameOf>
KeyLetters key_letters(const NameOf& name_of) {
  constexpr int key_a = 'A', key_z = 'Z';         // GLFW_KEY_A to GLFW_KEY_Z
  constexpr int key_first = ' ', key_last = 162;  // that can write something: GLFW_KEY_SPACE to GLFW_KEY_WORLD_2
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
