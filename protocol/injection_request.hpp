// Requests for injected faults. The virtual board checks requests (injection/injection.hpp), because pins and memory
// depend on the simulated board.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "protocol/injections.hpp"

namespace inkwell::protocol {

/// Upper limit of `after_s` and of `for_s`.
inline constexpr double latest_injection_s = 1e6;

/// Unchecked request.
struct InjectionRequest {
  std::string fault;                  ///< name in the table
  std::string of = {};                ///< location, such as "2", "1A" or "encoders[0].a"; empty if not given
  std::optional<double> amount = {};  ///< without a value: the amount `otherwise` of the table
  double after_s = 0.0;
  std::optional<double> for_s = {};  ///< without a value: until the fault is healed
};

namespace detail {
inline constexpr std::array<std::string_view, 3> one_to_three{"1", "2", "3"};
inline constexpr std::array<std::string_view, 6> legs{"1A", "1B", "2A", "2B", "3A", "3B"};
}  // namespace detail

/// Returns the location names, or an empty list for a kind with many locations.
constexpr std::span<const std::string_view> location_names(InjectionLocation location) {
  switch (location) {
    case InjectionLocation::motor:
    case InjectionLocation::converter: return detail::one_to_three;
    case InjectionLocation::leg: return detail::legs;
    default: return {};
  }
}

/// Describes the required location for error messages. The result is empty if the fault needs no location.
constexpr std::string_view required_location(InjectionLocation location) {
  switch (location) {
    case InjectionLocation::motor: return "the motor: 1, 2 or 3";
    case InjectionLocation::leg: return "the half bridge: 1A, 1B, 2A, 2B, 3A or 3B";
    case InjectionLocation::wire: return "the wire: a pin, such as PA0, or encoders[0].a";
    case InjectionLocation::wires: return "two wires, such as encoders[0].a+encoders[0].b";
    case InjectionLocation::exception: return "the exception: 16 is interrupt 0";
    case InjectionLocation::converter: return "the converter: 1, 2 or 3";
    case InjectionLocation::none:
    case InjectionLocation::address: break;
  }
  return "";
}

/// Returns the help text of a row. Values replace the names in braces.
inline std::string help_of(const InjectionInfo& row) {
  constexpr std::string_view figure = "{wire_spike_us}";
  const std::string_view text = row.help;
  const auto begin = text.find(figure);
  if (begin == std::string_view::npos) return std::string(text);
  std::string help(text.substr(0, begin));
  help += std::to_string(static_cast<int>(1e6 * wire_spike_s + 0.5));
  help += text.substr(begin + figure.size());
  return help;
}

}  // namespace inkwell::protocol
