// The scope's layouts: choosing one, and saving, renaming and deleting the user's own.
#pragma once

#include <cstdint>
#include <string>

#include <frame/style.hpp>
#include <scope/scope_layout.hpp>

namespace inkwell::window {

class LayoutMenu {
 public:
  explicit LayoutMenu(const OwnLayouts& own) : own_(own) {}

  /// Draws the menu, and does to the layout what is chosen in it.
  void draw(ScopeLayout& layout, const Style& style);
  const OwnLayouts& own_layouts() const { return own_; }

 private:
  enum class NameTask : std::uint8_t { none, save, rename };

  void draw_choices(ScopeLayout& layout);
  void ask_for_name(NameTask task, const std::string& suggestion);
  /// The dialog that asks for a name.
  void draw_name(ScopeLayout& layout, const Style& style);
  /// False, with the reason shown, if the name cannot be given.
  bool give_name(ScopeLayout& layout);

  OwnLayouts own_;
  NameTask task_ = NameTask::none;
  std::string name_;  ///< that is typed
  std::string refusal_;
};

}  // namespace inkwell::window
