// The menu selects, saves, renames and deletes layouts of the scope.
#pragma once

#include <cstdint>
#include <string>

#include "host/companion/window/frame/style.hpp"
#include "host/companion/window/scope/scope_layout.hpp"

namespace inkwell::window {

class LayoutMenu {
 public:
  explicit LayoutMenu(const OwnLayouts& own) : own_(own) {}

  /// Draws the menu and applies the selected action to the layout.
  void draw(ScopeLayout& layout, const Style& style);
  const OwnLayouts& own_layouts() const { return own_; }

 private:
  enum class NameTask : std::uint8_t { none, save, rename };

  void draw_choices(ScopeLayout& layout);
  void open_name_dialog(NameTask task, const std::string& suggestion);
  void draw_name(ScopeLayout& layout, const Style& style);
  /// Applies the typed name. If the name is invalid, shows the reason and returns false.
  bool save_name(ScopeLayout& layout);

  OwnLayouts own_;
  NameTask task_ = NameTask::none;
  std::string name_;
  std::string refusal_;
};

}  // namespace inkwell::window
