#include "host/companion/window/panes/fault_choice.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include "boards/known/boards.hpp"

namespace inkwell::window {

namespace {

using protocol::InjectionLocation;
using protocol::InjectionPart;

std::string in_small_letters(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return text;
}

std::optional<double> number(const std::string& text, std::string_view of_what) {
  if (text.empty()) return std::nullopt;
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code == std::errc{} && end == text.data() + text.size() && std::isfinite(value)) return value;
  const bool has_comma = text.find(',') != std::string::npos;
  throw device::Error(
      fmt::format("`{}` is not a number. Enter {} as a number{}.", text, of_what,
                  has_comma ? " with a decimal point and without commas" : ", or leave the field empty"));
}

std::string_view word_for(InjectionLocation location) {
  switch (location) {
    case InjectionLocation::motor: return "motor ";
    case InjectionLocation::leg: return "leg ";
    case InjectionLocation::exception: return "exception ";
    case InjectionLocation::converter: return "converter ";
    default: return "";
  }
}

}  // namespace

std::string_view obstacle(const device::SessionStatus& status, bool knows_control_port) {
  const bool connected = status.connection == device::Connection::connected;
  if (connected && !status.is_simulation)
    return "This is a real device, but faults can be injected only into a virtual board. Start a virtual board with "
           "`inkwell --virtual`.";
  if (knows_control_port) return "";
  if (connected)
    return "The control port of this virtual board is unknown. Start the window with `--virtual`, or with `--control` "
           "and the port that the board printed.";
  return "Faults can be injected only into a virtual board, but no device is connected. Start a virtual board with "
         "`inkwell --virtual`.";
}

std::string_view title_of(InjectionPart part) {
  switch (part) {
    case InjectionPart::wires: return "Wires";
    case InjectionPart::encoders: return "Encoders";
    case InjectionPart::shunts: return "Shunt amplifiers";
    case InjectionPart::motors: return "Motors";
    case InjectionPart::bridges: return "Bridge legs";
    case InjectionPart::supply: return "Supply";
    case InjectionPart::clocks: return "Clocks";
    case InjectionPart::usb: return "USB and host";
    case InjectionPart::core: return "Core and converters";
    case InjectionPart::memory: return "Memory";
  }
  return "";
}

std::string readable_name(std::string_view name) {
  std::string words(name);
  std::ranges::replace(words, '_', ' ');
  if (!words.empty()) words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  return words;
}

std::string with_readable_name(std::string_view sentence) {
  constexpr std::string_view beginning = "The virtual board refused \"inject\": ";
  if (sentence.starts_with(beginning)) sentence.remove_prefix(beginning.size());
  const std::string_view name = sentence.substr(0, sentence.find(' '));
  if (!protocol::find_injection(name)) return std::string(sentence);
  return readable_name(name) + std::string(sentence.substr(name.size()));
}

std::string_view missing_input(const TypedInjection& typed) {
  if (!typed.of.empty() && info(typed.fault).location == InjectionLocation::wires)
    return typed.of.find('+') == std::string::npos ? "Choose the second wire first." : "";
  if (!typed.of.empty()) return "";
  switch (info(typed.fault).location) {
    case InjectionLocation::none:
    case InjectionLocation::address: return "";
    case InjectionLocation::motor: return "Choose a motor first.";
    case InjectionLocation::leg: return "Choose a leg first.";
    case InjectionLocation::wire: return "Choose a wire first.";
    case InjectionLocation::wires: return "Choose two wires first.";
    case InjectionLocation::exception: return "Enter the number of the exception first.";
    case InjectionLocation::converter: return "Choose a converter first.";
  }
  return "";
}

bool is_found(const protocol::InjectionInfo& row, std::string_view search) {
  const std::string text = in_small_letters(
      fmt::format("{} {} {} {}", row.name, readable_name(row.name), title_of(row.part), protocol::help_of(row)));
  const std::string small = in_small_letters(std::string(search));
  const std::string_view words = small;
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find(' ', begin), words.size());
    if (text.find(words.substr(begin, end - begin)) == std::string::npos) return false;
    begin = end + 1;
  }
  return true;
}

std::vector<std::string_view> wires() {
  // All boards use the same wire names.
  std::vector<std::string_view> names;
  for (const board::PinUse& use : board::default_board.pin_uses())
    if (!board::default_board.is_usb_data(use.pin)) names.push_back(use.name);
  return names;
}

protocol::InjectionRequest request_of(const TypedInjection& typed) {
  const auto& row = info(typed.fault);
  protocol::InjectionRequest request{.fault = std::string(row.name)};
  if (row.location != InjectionLocation::none) request.of = typed.of;
  if (row.has_amount()) request.amount = number(typed.amount, "the amount");
  request.after_s = number(typed.after_s, "the start delay").value_or(0.0);
  request.for_s = number(typed.for_s, "the duration");
  return request;
}

std::string location_and_amount(const device::Injection& injection) {
  const auto fault = protocol::find_injection(injection.fault);
  std::string described = injection.of;
  if (fault && !described.empty())
    described = fmt::format("{}{}", word_for(protocol::info(*fault).location), described);
  if (!injection.amount) return described;
  const std::string_view unit = fault ? protocol::info(*fault).unit : "";
  return fmt::format("{}{}{:.6g}{}{}", described, described.empty() ? "" : ", ", *injection.amount,
                     unit.empty() ? "" : " ", unit);
}

std::string duration_text(double duration_s) {
  if (duration_s < 0.001) return fmt::format("{:.2f} ms", 1e3 * duration_s);
  if (duration_s < 1.0) return fmt::format("{:.1f} ms", 1e3 * duration_s);
  return fmt::format("{:.2f} s", duration_s);
}

}  // namespace inkwell::window
