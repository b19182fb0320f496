// The input fields and the injection button for a fault.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "host/companion/window/frame/style.hpp"
#include "host/companion/window/panes/fault_choice.hpp"

namespace inkwell::window {

class FaultForm {
 public:
  FaultForm(protocol::InjectedFault fault, std::string of) : typed_{fault, std::move(of), {}, {}, {}} {}

  const TypedInjection& typed() const { return typed_; }
  /// In the next frame, moves the keyboard focus to the first field.
  void take_keyboard() { takes_keyboard_ = true; }
  /// Returns true if the user injects the fault.
  bool draw(const Style& style);

 private:
  struct Field {
    const char* label;
    const char* name;  ///< name in inspections
    std::string hint;
    float right_room;  ///< free width to the right of the field
  };

  // Returns true if the user pressed Enter in a field.
  bool draw_location(const Style& style);
  bool draw_field(const Field& field, std::string& typed, const Style& style);
  bool draw_number(const char* label, const char* name, const std::string& hint, std::string_view unit,
                   std::string_view help, std::string& typed, const Style& style);
  void draw_names(std::span<const std::string_view> names, const Style& style);
  void draw_wires(const Style& style);

  TypedInjection typed_;
  bool takes_keyboard_ = false;
};

}  // namespace inkwell::window
