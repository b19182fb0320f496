#include "boards/virtual/program/requests.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include "boards/virtual/plant/truth.hpp"

namespace inkwell::virtual_board {

using nlohmann::json;

namespace {

/// This number of trace rows limits the memory of a reply. The next reply contains the remaining rows.
constexpr std::size_t rows_of_answer_maximum = 100'000;
constexpr double reach_m = 2.0;  // beyond the reach of any arm that a description allows

const json& at(const json& request, const char* key, const char* what) {
  const auto found = request.find(key);
  if (found == request.end()) throw Refused(fmt::format("\"{}\" is missing; it must be {}", key, what));
  return *found;
}

double checked_number(const json& value, const char* key, double minimum, double maximum) {
  if (!value.is_number()) throw Refused(fmt::format("\"{}\" must contain only numbers", key));
  const double number = value.get<double>();
  if (!(number >= minimum && number <= maximum))
    throw Refused(fmt::format("\"{}\": the value {} is outside {} to {}", key, number, minimum, maximum));
  return number;
}

double number(const json& request, const char* key, double minimum, double maximum) {
  return checked_number(at(request, key, "a number"), key, minimum, maximum);
}

double number_or(const json& request, const char* key, double otherwise, double minimum, double maximum) {
  return request.contains(key) ? number(request, key, minimum, maximum) : otherwise;
}

Vector3 vector(const json& request, const char* key, double largest) {
  const json& value = at(request, key, "a list of three numbers");
  if (!value.is_array() || value.size() != 3) throw Refused(fmt::format("\"{}\" must be a list of three numbers", key));
  Vector3 result;
  for (int i = 0; i < 3; ++i) result[i] = checked_number(value[static_cast<std::size_t>(i)], key, -largest, largest);
  return result;
}

std::string text_or_number(const json& request, const char* key, const char* what) {
  const json& value = at(request, key, what);
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_unsigned()) return std::to_string(value.get<std::uint64_t>());
  throw Refused(fmt::format("\"{}\" must be {}", key, what));
}

}  // namespace

std::span<const CommandInfo> command_table() {
  static const std::vector<CommandInfo> table = {
      {Command::status,
       "status",
       {},
       "board time, mode, resets, USB, awaited programs, injected faults, accesses to unmodeled registers",
       true},
      {Command::truth, "truth", {}, "true physical quantities, and the levels at the bridge inputs"},
      {Command::pause, "pause", {}, "stop board time"},
      {Command::stand_by, "stand_by", {}, "stop board time, except during USB control transfers"},
      {Command::run, "run", {"for_s"}, "run for this board time; the reply follows afterward"},
      {Command::resume, "resume", {}, "run without a limit"},
      {Command::reset, "reset", {}, "reset the board with the reset pin"},
      {Command::cut_power,
       "cut_power",
       {"at_flash_operation"},
       "interrupt the power now, or in the middle of the flash operation with this number; 1 is the next word or "
       "sector that the firmware programs or erases"},
      {Command::quit, "quit", {}, "exit the virtual board", true},
      {Command::usb, "usb", {"connected"}, "plug in or unplug the cable, which supplies VBUS"},
      {Command::buttons, "buttons", {"pressed"}, "press the stylus buttons, such as [true,false]"},
      {Command::supply, "supply", {"voltage_V"}, "set the bridge supply voltage"},
      {Command::pin,
       "pin",
       {"pin", "drive"},
       "read the level at a pin, such as PA5; \"drive\" first drives the pin high, low or floating"},
      {Command::glitch, "glitch", {"pin", "for_s"}, "invert the level that drives a pin, like a spike on its wire"},
      {Command::inject,
       "inject",
       {"fault", "of", "amount", "after_s", "for_s"},
       "inject a fault of the list above, immediately or later, indefinitely or for a time"},
      {Command::heal,
       "heal",
       {"fault", "of"},
       "heal a fault at one position; at all positions without \"of\"; all active faults without both keys"},
      {Command::hand,
       "hand",
       {"holds", "target_m", "stiffness_N_per_m", "damping_Ns_per_m"},
       "let the hand hold the stylus at a target, or release the stylus"},
      {Command::hand_path,
       "hand_path",
       {"points"},
       "move the hand with minimum jerk along [{\"after_s\":0.5,\"target_m\":[x,y,z]},...]"},
      {Command::gimbal, "gimbal", {"angles_rad"}, "turn the stylus to yaw, pitch, roll"},
      {Command::dock, "dock", {"docked"}, "put the stylus into the inkwell, or remove the stylus"},
      {Command::meter,
       "meter",
       {"action"},
       "start or read the meter: peak force, energy and travel of the hand, and peak force of the motors"},
      {Command::trace,
       "trace",
       {"action", "maximum"},
       "start, stop or read the trace of true quantities, with one row per control period"},
  };
  return table;
}

std::string explain_commands() {
  std::string text;
  for (const CommandInfo& command : command_table()) {
    const std::string usage = fmt::format("{} {}", command.name, fmt::join(command.keys, " "));
    constexpr std::size_t column = 26;  // column of the help texts
    text += usage.size() < column ? fmt::format("  {:<{}}{}\n", usage, column, command.help)
                                  : fmt::format("  {}\n  {:{}}{}\n", usage, "", column, command.help);
  }
  return text;
}

Request read_request(std::string_view line) {
  json values = json::parse(line, nullptr, false);
  if (values.is_discarded() || !values.is_object())
    throw Refused("a command is one JSON object in one line, such as {\"command\":\"status\"}");
  const json& name = at(values, "command", "the name of a command, such as \"status\"");
  // The error message does not quote lists, because printing a deeply nested list can overflow the stack.
  if (!name.is_string()) throw Refused("\"command\" must be the name of a command, such as \"status\"");
  const auto table = command_table();
  const auto found = std::ranges::find(table, name.get_ref<const std::string&>(), &CommandInfo::name);
  if (found == table.end()) {
    std::vector<std::string_view> names;
    for (const CommandInfo& each : table) names.push_back(each.name);
    throw Refused(fmt::format("there is no command {}; use one of these: {}", name.dump(), fmt::join(names, ", ")));
  }
  for (const auto& [key, value] : values.items())
    if (key != "command" && std::ranges::find(found->keys, key) == found->keys.end())
      throw Refused(fmt::format("the command \"{}\" has no key \"{}\"; its keys are: {}", found->name, key,
                                found->keys.empty() ? "none" : fmt::format("{}", fmt::join(found->keys, ", "))));
  return {&*found, std::move(values)};
}

bool truth_value(const json& request, const char* key) {
  const json& value = at(request, key, "true or false");
  if (!value.is_boolean()) throw Refused(fmt::format("\"{}\" must be true or false", key));
  return value.get<bool>();
}

double run_time_s(const json& request) { return number(request, "for_s", 0.0, 1e6); }

std::optional<std::uint64_t> flash_operation(const json& request) {
  if (!request.contains("at_flash_operation")) return std::nullopt;
  return static_cast<std::uint64_t>(number(request, "at_flash_operation", 1.0, 1e9));
}

double supply_voltage_V(const json& request) { return number(request, "voltage_V", 0.0, 36.0); }

double glitch_time_s(const json& request) { return number(request, "for_s", 0.0, 1e3); }

Vector3 gimbal_angles_rad(const json& request) { return vector(request, "angles_rad", 20.0); }

MeterAction meter_action(const json& request) {
  const json& action = at(request, "action", "\"start\" or \"read\"");
  if (action == "start") return MeterAction::start;
  if (action == "read") return MeterAction::read;
  throw Refused("\"action\" must be \"start\" or \"read\"");
}

TraceAction trace_action(const json& request) {
  const json& action = at(request, "action", "\"start\", \"stop\" or \"read\"");
  if (action == "start") return TraceAction::start;
  if (action == "stop") return TraceAction::stop;
  if (action == "read") return TraceAction::read;
  throw Refused("\"action\" must be \"start\", \"stop\" or \"read\"");
}

std::size_t trace_rows(const json& request) {
  const double asked = number_or(request, "maximum", 10'000, 0, Trace::rows_maximum);
  return std::min(static_cast<std::size_t>(asked), rows_of_answer_maximum);
}

HandRequest hand_request(const json& request) {
  if (!truth_value(request, "holds")) return {};
  const auto at_most = [&](const char* key, double maximum) {
    return request.contains(key) ? std::optional(number(request, key, 0.0, maximum)) : std::nullopt;
  };
  return {.holds = true,
          .target_m = vector(request, "target_m", reach_m),
          .stiffness_N_per_m = at_most("stiffness_N_per_m", Hand::stiffness_maximum_N_per_m),
          .damping_Ns_per_m = at_most("damping_Ns_per_m", Hand::damping_maximum_Ns_per_m)};
}

std::vector<Waypoint> hand_path_request(const json& request) {
  const json& points = at(request, "points", "a list of {\"after_s\":time,\"target_m\":[x,y,z]}");
  if (!points.is_array() || points.empty()) throw Refused("\"points\" must be a list of at least one point");
  std::vector<Waypoint> path;
  for (const json& point : points) {
    if (!point.is_object()) throw Refused("each entry of \"points\" must be {\"after_s\":time,\"target_m\":[x,y,z]}");
    const double earliest_s = path.empty() ? 0.0 : path.back().after_s;
    path.push_back({number(point, "after_s", earliest_s, 1e6), vector(point, "target_m", reach_m)});
  }
  return path;
}

std::array<bool, 2> pressed_buttons(const json& request) {
  const json& pressed = at(request, "pressed", "a list of two values, true or false");
  if (!pressed.is_array() || pressed.size() != 2 || !pressed[0].is_boolean() || !pressed[1].is_boolean())
    throw Refused("\"pressed\" must be a list of two values, true or false");
  return {pressed[0].get<bool>(), pressed[1].get<bool>()};
}

PinName pin_of(const json& request) {
  const json& name = at(request, "pin", "a pin, such as \"PA5\"");
  if (!name.is_string()) throw Refused("\"pin\" must be a pin, such as \"PA5\"");
  try {
    return PinName::of(name.get<std::string>());
  } catch (const std::invalid_argument& error) {
    throw Refused(error.what());
  }
}

std::optional<PinLevel> pin_drive(const json& request) {
  const auto level = request.find("drive");
  if (level == request.end()) return std::nullopt;
  if (*level == "high") return PinLevel::high;
  if (*level == "low") return PinLevel::low;
  if (*level == "floating") return PinLevel::floating;
  throw Refused("\"drive\" must be \"high\", \"low\" or \"floating\"");
}

protocol::InjectionRequest injection_request(const json& request) {
  constexpr double largest = 1e12;
  protocol::InjectionRequest wanted;
  wanted.fault = text_or_number(request, "fault", "the name of a fault, such as \"encoder_stuck\"");
  if (request.contains("of")) wanted.of = text_or_number(request, "of", "a number or a name, such as 2 or \"PA0\"");
  if (request.contains("amount")) wanted.amount = number(request, "amount", -largest, largest);
  wanted.after_s = number_or(request, "after_s", 0.0, 0.0, protocol::latest_injection_s);
  if (request.contains("for_s")) wanted.for_s = number(request, "for_s", 0.0, protocol::latest_injection_s);
  return wanted;
}

}  // namespace inkwell::virtual_board
