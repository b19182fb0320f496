// The page that lists every key and what the mouse does.
#pragma once

#include <frame/style.hpp>

namespace inkwell::window {

class KeyHelp {
 public:
  /// At the next frame.
  void open() { is_to_be_opened_ = true; }
  /// Over everything else, while it is open.
  void draw(const Style& style);

 private:
  bool is_to_be_opened_ = false;
};

}  // namespace inkwell::window
