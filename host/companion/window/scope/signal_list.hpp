// The signal list next to the plots, with search and formulas.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "host/companion/window/frame/style.hpp"
#include "host/companion/window/scope/scope_layout.hpp"

namespace inkwell::window {

inline constexpr std::string_view nothing_found =
    "No signal matches the search. Search for a single word, such as force.";

void draw_search(std::string& search, const Style& style);

/// Returns the name of the signal that the user dropped onto the last item, or an empty value.
std::optional<std::string> dropped_signal();

class SignalList {
 public:
  bool is_shown() const { return is_shown_; }
  void toggle() { is_shown_ = !is_shown_; }

  /// Draws the visible list to the left of the next item. Draws the open formula dialog.
  void draw(ScopeLayout& layout, const Style& style);

 private:
  void draw_signals(ScopeLayout& layout, const Style& style);
  void draw_formulas(ScopeLayout& layout, const Style& style);
  void ask_about(const Formula& formula);
  void draw_dialog(ScopeLayout& layout, const Style& style);
  void draw_fields(const Style& style);
  /// Returns the formula in the input fields.
  Formula typed() const;

  bool is_shown_ = false;
  std::string search_;
  std::optional<Formula> asked_about_;  ///< the formula before editing; its name is empty for a new formula
  Formula typed_;                       ///< name, text and unit in the fields
  std::string typed_low_pass_;
};

}  // namespace inkwell::window
