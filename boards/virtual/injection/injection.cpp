#include "boards/virtual/injection/injection.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include "boards/stm32f405/core/exception_numbers.hpp"

namespace inkwell::virtual_board {
namespace {

using protocol::InjectionLocation;

double number(std::string_view text, std::string_view of_what) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw InvalidInjection(fmt::format("\"{}\" is not a number; a number is required for {}", text, of_what));
  return value;
}

unsigned whole_number(const std::string& text, unsigned minimum, unsigned maximum, std::string_view of_what) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < minimum || value > maximum)
    throw InvalidInjection(
        fmt::format("\"{}\" is not a valid {}; use a number from {} to {}", text, of_what, minimum, maximum));
  return value;
}

PinName wire(const std::string& text, const board::Facts& board) {
  for (const board::PinUse& use : board.pin_uses()) {
    if (use.name != text) continue;
    if (board.is_usb_data(use.pin))
      throw InvalidInjection(
          fmt::format("the wire {} is not modeled separately; use usb_cut to unplug the cable", text));
    return {use.pin.port, use.pin.number};
  }
  if (const auto pin = PinName::find(text)) return *pin;
  throw InvalidInjection(fmt::format(
      "\"{}\" is not a wire; use a pin, such as PA0, or a name of the board description, such as encoders[0].a or "
      "bridge_enable",
      text));
}

bool is_digit_or_point(char c) { return c == '.' || (c >= '0' && c <= '9'); }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string name_of(PinName wire, const board::Facts& board) {
  for (const board::PinUse& use : board.pin_uses())
    if (use.pin.port == wire.port && use.pin.number == wire.pin) return std::string(use.name);
  return wire.text();
}

std::uint32_t address(const std::string& text) {
  std::string_view digits = text;
  const bool hexadecimal = digits.starts_with("0x");
  if (hexadecimal) digits.remove_prefix(2);
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, hexadecimal ? 16 : 10);
  if (error != std::errc() || end != digits.data() + digits.size())
    throw InvalidInjection(fmt::format("\"{}\" is not an address; use a number such as 0x20000100", text));
  return value;
}

/// Returns the index of `text` in `names`.
unsigned one_of(std::span<const std::string_view> names, const std::string& text, std::string_view what) {
  const auto found = std::ranges::find(names, text);
  if (found == names.end())
    throw InvalidInjection(
        fmt::format("\"{}\" is not a valid {}; use one of these: {}", text, what, fmt::join(names, ", ")));
  return static_cast<unsigned>(found - names.begin());
}

void check_target(Injection& injection, const std::string& of, const board::Facts& board) {
  const auto& info = protocol::info(injection.fault);
  if (of.empty() && info.location != InjectionLocation::none && info.location != InjectionLocation::address)
    throw InvalidInjection(fmt::format("{} needs a location; add {}", info.name, required_location(info.location)));
  injection.of = of;
  const auto names = protocol::location_names(info.location);
  switch (info.location) {
    case InjectionLocation::none:
      if (!of.empty()) throw InvalidInjection(fmt::format("{} has no location; omit \"{}\"", info.name, of));
      return;
    case InjectionLocation::motor: injection.number = one_of(names, of, "motor"); return;
    case InjectionLocation::converter: injection.number = 1 + one_of(names, of, "converter"); return;
    case InjectionLocation::exception:
      injection.number = whole_number(of, 2, exception_numbers - 1, "exception");
      return;
    case InjectionLocation::leg: {
      const unsigned leg = one_of(names, of, "half bridge");
      injection.number = leg / 2;
      injection.leg = leg % 2;
      return;
    }
    case InjectionLocation::wire:
      injection.wires[0] = wire(of, board);
      injection.of = name_of(injection.wires[0], board);
      return;
    case InjectionLocation::wires: {
      const auto plus = of.find('+');
      if (plus == std::string::npos)
        throw InvalidInjection(fmt::format("{} needs two wires, such as PA0+PA1", info.name));
      injection.wires = {wire(of.substr(0, plus), board), wire(of.substr(plus + 1), board)};
      if (injection.wires[0] == injection.wires[1])
        throw InvalidInjection("both wires are the same; use two different wires");
      injection.of = name_of(injection.wires[0], board) + "+" + name_of(injection.wires[1], board);
      return;
    }
    case InjectionLocation::address:
      if (!of.empty()) injection.address = address(of);
      return;
  }
}

void check_time(double time_s, std::string_view what) {
  if (!(time_s >= 0.0 && time_s <= protocol::latest_injection_s))
    throw InvalidInjection(
        fmt::format("{} is {} s, which is outside 0 to {}", what, time_s, protocol::latest_injection_s));
}

}  // namespace

Injection checked(const protocol::InjectionRequest& request, const board::Facts& board) {
  const auto fault = protocol::find_injection(request.fault);
  if (!fault) {
    std::vector<std::string_view> names;
    for (const auto& row : protocol::injection_table) names.push_back(row.name);
    throw InvalidInjection(
        fmt::format("there is no fault \"{}\"; use one of these: {}", request.fault, fmt::join(names, ", ")));
  }
  const auto& info = protocol::info(*fault);
  Injection injection{.fault = *fault};
  check_target(injection, request.of, board);
  injection.amount = request.amount.value_or(info.otherwise);
  if (request.amount && !info.has_amount())
    throw InvalidInjection(fmt::format("{} has no amount; omit {}", info.name, *request.amount));
  if (!(injection.amount >= info.minimum && injection.amount <= info.maximum))
    throw InvalidInjection(fmt::format("{} {}{}{} is outside {} to {}", info.name, injection.amount,
                                       info.unit.empty() ? "" : " ", info.unit, info.minimum, info.maximum));
  check_time(request.after_s, "the delay");
  if (request.for_s) check_time(*request.for_s, "the duration");
  injection.after_s = request.after_s;
  injection.for_s = request.for_s;
  return injection;
}

Injection parse_injection(std::string_view text, const board::Facts& board) {
  protocol::InjectionRequest parts;
  std::string_view rest = text;
  // Splits the text at the last `mark`, because earlier plus signs separate the names of wires.
  const auto cut = [&](char mark, std::string_view what) -> std::optional<double> {
    const auto position = rest.rfind(mark);
    if (position == std::string_view::npos) return std::nullopt;
    const double value = number(rest.substr(position + 1), what);
    rest = rest.substr(0, position);
    return value;
  };
  const auto at = rest.rfind('@'), plus = rest.rfind('+');
  const bool lasts = plus != std::string_view::npos && plus + 1 < rest.size() &&
                     (at == std::string_view::npos || plus > at) && is_digit_or_point(rest[plus + 1]);
  if (lasts) parts.for_s = cut('+', "the duration in seconds");
  if (const auto after_s = cut('@', "the delay in seconds")) parts.after_s = *after_s;
  parts.amount = cut('=', "the amount");
  const auto colon = rest.find(':');
  parts.fault = std::string(rest.substr(0, colon));
  if (colon != std::string_view::npos) parts.of = std::string(rest.substr(colon + 1));
  return checked(parts, board);
}

std::vector<Injection> parse_injections(std::string_view script, const board::Facts& board) {
  std::vector<Injection> injections;
  for (unsigned line_number = 1; !script.empty(); ++line_number) {
    const auto end = std::min(script.find('\n'), script.size());
    std::string_view line = script.substr(0, std::min(end, script.find('#')));
    script.remove_prefix(std::min(end + 1, script.size()));
    while (!line.empty() && is_space(line.front())) line.remove_prefix(1);
    while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
    if (line.empty()) continue;
    try {
      injections.push_back(parse_injection(line, board));
    } catch (const InvalidInjection& error) {
      throw InvalidInjection(fmt::format("line {}: {}", line_number, error.what()));
    }
  }
  return injections;
}

std::string explain_injections() {
  std::string text;
  for (const auto& row : protocol::injection_table) {
    constexpr std::string_view of[] = {"", ":MOTOR", ":LEG", ":WIRE", ":WIRE+WIRE", ":EXCEPTION", ":ADC", "[:ADDRESS]"};
    std::string usage = fmt::format("{}{}", row.name, of[static_cast<std::size_t>(row.location)]);
    if (row.has_amount()) usage += "=" + std::string(row.unit.empty() ? "N" : row.unit);
    constexpr std::size_t column = 30;
    const std::string help = protocol::help_of(row);
    text += usage.size() < column ? fmt::format("  {:<{}}{}", usage, column, help)
                                  : fmt::format("  {}\n  {:{}}{}", usage, "", column, help);
    if (row.has_amount()) text += fmt::format(" {} to {}; {}", row.minimum, row.maximum, row.otherwise);
    text += '\n';
  }
  return text;
}

}  // namespace inkwell::virtual_board
