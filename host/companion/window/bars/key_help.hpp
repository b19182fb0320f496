// The page with all keys and mouse actions.
#pragma once

#include "host/companion/window/frame/style.hpp"

namespace inkwell::window {

class KeyHelp {
 public:
  /// Opens the page in the next frame.
  void open() { is_to_be_opened_ = true; }
  /// Draws the open page in front of all panes.
  void draw(const Style& style);

 private:
  bool is_to_be_opened_ = false;
};

}  // namespace inkwell::window
