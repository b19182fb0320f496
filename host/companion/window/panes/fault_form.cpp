#include "host/companion/window/panes/fault_form.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "host/companion/window/frame/imgui_versions.hpp"
#include "host/companion/window/frame/inspection.hpp"
#include "host/companion/window/frame/widgets.hpp"

namespace inkwell::window {

namespace {

using protocol::InjectionLocation;

constexpr float amount_unit_points = 46.0f;
constexpr float label_part = 0.34f;  // of a field's row

/// Returns the label of the location field; null if the fault has only one location.
const char* location_label(InjectionLocation location) {
  switch (location) {
    case InjectionLocation::none: return nullptr;
    case InjectionLocation::motor: return "Motor";
    case InjectionLocation::leg: return "Leg";
    case InjectionLocation::wire: return "Wire";
    case InjectionLocation::wires: return "Wires";
    case InjectionLocation::exception: return "Exception";
    case InjectionLocation::converter: return "Converter";
    case InjectionLocation::address: return "Address";
  }
  return nullptr;
}

const char* location_hint(InjectionLocation location) {
  switch (location) {
    case InjectionLocation::wires: return "wire+wire";
    case InjectionLocation::exception: return "16 is interrupt 0";
    case InjectionLocation::address: return "from the seed";
    default: return "name or number";
  }
}

bool is_enter_down() {
  return ImGui::IsKeyDown(key_index(ImGuiKey_Enter)) || ImGui::IsKeyDown(key_index(key_keypad_enter));
}

}  // namespace

bool FaultForm::draw(const Style& style) {
  const auto& row = info(typed_.fault);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{style.points(4), style.points(5)});
  wrapped_text(style.palette->text_quiet, protocol::help_of(row));
  bool entered = draw_location(style);
  if (row.has_amount()) {
    entered |= draw_number("Amount", "amount", fmt::format("{}", row.otherwise), row.unit,
                           "An empty field uses the amount that is shown in gray.", typed_.amount, style);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + label_part * ImGui::GetContentRegionAvail().x);
    text(style.fonts.caption, style.palette->text_quiet, fmt::format("{} to {}", row.minimum, row.maximum));
  }
  entered |= draw_number("Starts after", "after", "immediately", "s",
                         "Delay between Inject and the start of the fault, in board time.", typed_.after_s, style);
  entered |= draw_number("Duration", "duration", "until healed", "s",
                         "Time until the fault heals automatically, in board time.", typed_.for_s, style);
  if (entered) take_keyboard();  // back to the first field, for the next fault
  const std::string_view missing = missing_input(typed_);
  ImGui::BeginDisabled(!missing.empty());
  if (missing.empty() ? primary_button("Inject", style, {-1, 0}) : button("Inject", {-1, 0})) entered = true;
  ImGui::EndDisabled();
  if (!missing.empty()) {
    help_on_hover("Inject", missing, style);
    entered = false;
  }
  ImGui::Dummy({0, style.points(4)});
  ImGui::PopStyleVar();
  return entered;
}

bool FaultForm::draw_field(const Field& field, std::string& typed, const Style& style) {
  const float left = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
  ImGui::AlignTextToFramePadding();
  text(style.palette->text_quiet, field.label);
  ImGui::SameLine();
  ImGui::SetCursorPosX(left + label_part * width);
  ImGui::SetNextItemWidth((1.0f - label_part) * width - field.right_room);
  // Waits until Enter is released, because the input field would otherwise process Enter.
  if (takes_keyboard_ && !is_enter_down()) {
    takes_keyboard_ = false;
    ImGui::SetKeyboardFocusHere();
  }
  const bool entered = ImGui::InputTextWithHint(fmt::format("##{}", field.name).c_str(), field.hint.c_str(), &typed,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  note_item(field.name);
  return entered;
}

bool FaultForm::draw_number(const char* label, const char* name, const std::string& hint, std::string_view unit,
                            std::string_view help, std::string& typed, const Style& style) {
  const bool entered = draw_field({label, name, hint, style.points(amount_unit_points)}, typed, style);
  help_on_hover(label, help, style);
  ImGui::SameLine(0, style.points(6));
  text(style.fonts.caption, style.palette->text_quiet, unit);
  return entered;
}

bool FaultForm::draw_location(const Style& style) {
  const InjectionLocation location = info(typed_.fault).location;
  const char* label = location_label(location);
  if (label == nullptr) return false;
  const bool is_wire = location == InjectionLocation::wire || location == InjectionLocation::wires;
  const float arrow = is_wire ? ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.x : 0.0f;
  const bool entered = draw_field({label, "location", location_hint(location), arrow}, typed_.of, style);
  if (is_wire) draw_wires(style);
  if (const auto names = protocol::location_names(location); !names.empty()) draw_names(names, style);
  return entered;
}

void FaultForm::draw_names(std::span<const std::string_view> names, const Style& style) {
  const float indent = label_part * ImGui::GetContentRegionAvail().x;
  const auto count = static_cast<float>(names.size());
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + indent);
  const float width = (ImGui::GetContentRegionAvail().x - (count - 1.0f) * gap) / count;
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2{0, ImGui::GetStyle().FramePadding.y});
  for (const std::string_view name : names) {
    if (name != names.front()) ImGui::SameLine();
    if (toggle_button(std::string(name).c_str(), typed_.of == name, style, {width, 0})) typed_.of = name;
  }
  ImGui::PopStyleVar();
}

void FaultForm::draw_wires(const Style& style) {
  ImGui::SameLine();
  if (ImGui::ArrowButton("##wires", ImGuiDir_Down)) ImGui::OpenPopup("wires");
  note_item("wires");
  help_on_hover("Wires", "Lists the wires of the board. For any other pin, type its name, such as PA0.", style);
  ImGui::SetNextWindowSizeConstraints({style.points(180), 0}, {style.points(260), style.points(320)});
  if (!ImGui::BeginPopup("wires")) return;
  for (const std::string_view name : wires()) {
    if (ImGui::Selectable(std::string(name).c_str(), typed_.of == name)) {
      // Appends the second wire after a plus sign.
      const bool is_second = info(typed_.fault).location == InjectionLocation::wires && !typed_.of.empty() &&
                             typed_.of.find('+') == std::string::npos;
      typed_.of = is_second ? fmt::format("{}+{}", typed_.of, name) : std::string(name);
    }
    note_item(name);
  }
  ImGui::EndPopup();
}

}  // namespace inkwell::window
