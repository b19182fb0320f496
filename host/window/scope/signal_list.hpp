// The list of all signals beside the plots: searched, dragged into a plot, and with formulas at its end.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <frame/style.hpp>
#include <scope/scope_layout.hpp>

namespace inkwell::window {

inline constexpr std::string_view nothing_found = "No signal is called so. Try one word, such as force.";

/// The field in which one types what to look for.
void draw_search(std::string& search, const Style& style);

/// The name of the signal that was dragged onto the last item and let go there, if one was.
std::optional<std::string> dropped_signal();

class SignalList {
 public:
  bool is_shown() const { return is_shown_; }
  void toggle() { is_shown_ = !is_shown_; }

  /// Draws it at the left of what follows, while it is shown, and the dialog about a formula while that is open.
  void draw(ScopeLayout& layout, const Style& style);

 private:
  void draw_signals(ScopeLayout& layout, const Style& style);
  void draw_formulas(ScopeLayout& layout, const Style& style);
  void ask_about(const Formula& formula);
  void draw_dialog(ScopeLayout& layout, const Style& style);
  void draw_fields(const Style& style);
  /// What stands in the fields.
  Formula typed() const;

  bool is_shown_ = false;
  std::string search_;
  std::optional<Formula> asked_about_;  ///< as it was; its name is empty if it is a new one
  Formula typed_;                       ///< name, text and unit as they stand in the fields
  std::string typed_low_pass_;
};

}  // namespace inkwell::window
