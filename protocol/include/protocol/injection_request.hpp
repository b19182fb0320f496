// A fault as a user or a program asks for it: what may be said of it, and the names of the places that it may be put
// into. Its checks are the virtual board's (injection/injection.hpp), which alone knows what there is.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <protocol/injections.hpp>

namespace inkwell::protocol {

/// No fault comes later, or lasts longer.
inline constexpr double latest_injection_s = 1e6;

/// As it was written.
struct InjectionRequest {
  std::string fault;                  ///< its name in the table
  std::string of = {};                ///< what it is put into, such as "2", "1A" or "encoders[0].a"; empty: not said
  std::optional<double> amount = {};  ///< none: the table's own
  double after_s = 0.0;
  std::optional<double> for_s = {};  ///< none: until it is healed
};

namespace detail {
inline constexpr std::array<std::string_view, 3> one_to_three{"1", "2", "3"};
inline constexpr std::array<std::string_view, 6> legs{"1A", "1B", "2A", "2B", "3A", "3B"};
}  // namespace detail

/// The names of all places of a kind of which there are few; none for the others.
constexpr std::span<const std::string_view> names_of_places(InjectionPlace place) {
  switch (place) {
    case InjectionPlace::motor:
    case InjectionPlace::converter: return detail::one_to_three;
    case InjectionPlace::leg: return detail::legs;
    default: return {};
  }
}

/// What a fault of this kind has to be told, for a sentence that asks for it; empty where it need not be told.
constexpr std::string_view wanted_place(InjectionPlace place) {
  switch (place) {
    case InjectionPlace::motor: return "the motor: 1, 2 or 3";
    case InjectionPlace::leg: return "the half bridge: 1A, 1B, 2A, 2B, 3A or 3B";
    case InjectionPlace::wire: return "the wire: a pin, such as PA0, or encoders[0].a";
    case InjectionPlace::wires: return "two wires, such as encoders[0].a+encoders[0].b";
    case InjectionPlace::exception: return "the exception: 16 is interrupt 0";
    case InjectionPlace::converter: return "the converter: 1, 2 or 3";
    case InjectionPlace::none:
    case InjectionPlace::address: break;
  }
  return "";
}

/// The row's help with its figures in it.
inline std::string help_of(const InjectionInfo& row) {
  constexpr std::string_view figure = "{wire_spike_us}";
  const auto place = row.help.find(figure);
  if (place == std::string_view::npos) return std::string(row.help);
  std::string help(row.help.substr(0, place));
  help += std::to_string(static_cast<int>(1e6 * wire_spike_s + 0.5));
  help += row.help.substr(place + figure.size());
  return help;
}

}  // namespace inkwell::protocol
