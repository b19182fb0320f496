#include "host/companion/window/panes/refusal_text.hpp"

#include <fmt/format.h>

#include "host/client/device/parameter_file.hpp"
#include "host/companion/window/device_desk/parameter_editor.hpp"
#include "host/companion/window/frame/shown_unit.hpp"

namespace inkwell::window {

std::string range_text(const protocol::ParameterInfo& info) {
  const auto [unit, factor] = shown_unit(info.unit);
  return fmt::format("{:g} to {:g}{}{}", factor * info.minimum, factor * info.maximum, unit.empty() ? "" : " ", unit);
}

std::string refusal_text(std::string_view refusal) {
  constexpr std::string_view beginning = "The device refused ", range = "Its range is ";
  if (!refusal.starts_with(beginning)) return std::string(refusal);
  const std::string_view rest = refusal.substr(beginning.size());
  const std::size_t equals = rest.find(" = "), colon = rest.find(": "), end = rest.find(range);
  if (equals == std::string_view::npos || colon == std::string_view::npos || colon < equals)
    return std::string(refusal);
  const auto parameter = protocol::find_parameter(rest.substr(0, equals));
  const auto value = device::parse_number(rest.substr(equals + 3, colon - equals - 3));
  if (!parameter || !value) return std::string(refusal);
  const protocol::ParameterInfo& row = protocol::info(*parameter);
  const auto [unit, factor] = shown_unit(row.unit);
  const std::string_view reason = rest.substr(colon, end == std::string_view::npos ? end : end - colon);
  return fmt::format("{}{} = {:g}{}{}{}{}", beginning, full_label_of(row), factor * *value, unit.empty() ? "" : " ",
                     unit, reason, end == std::string_view::npos ? "" : fmt::format("{}{}.", range, range_text(row)));
}

}  // namespace inkwell::window
