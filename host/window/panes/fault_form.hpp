// The input fields of one fault (location, amount, times) and the button that injects it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <frame/style.hpp>
#include <panes/fault_choice.hpp>

namespace inkwell::window {

class FaultForm {
 public:
  FaultForm(protocol::InjectedFault fault, std::string of) : typed_{fault, std::move(of), {}, {}, {}} {}

  const TypedFault& typed() const { return typed_; }
  /// Sets the keyboard focus to the first field when it is drawn next.
  void take_keyboard() { takes_keyboard_ = true; }
  /// Returns true if the user wants the fault to be injected now.
  bool draw(const Style& style);

 private:
  struct Field {
    const char* label;
    const char* name;  ///< name in inspections
    std::string hint;
    float beside;  ///< free width to the right of the field
  };

  // Each returns true if Enter was pressed in one of the fields.
  bool draw_place(const Style& style);
  bool draw_field(const Field& field, std::string& typed, const Style& style);
  bool draw_number(const char* label, const char* name, const std::string& hint, std::string_view unit,
                   std::string_view help, std::string& typed, const Style& style);
  void draw_names(std::span<const std::string_view> names, const Style& style);
  void draw_wires(const Style& style);

  TypedFault typed_;
  bool takes_keyboard_ = false;
};

}  // namespace inkwell::window
