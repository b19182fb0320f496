#include <charconv>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "host/client/device/force_law.hpp"

#include "host/client/recording/formats.hpp"

namespace inkwell::recording {

std::string force_law_digits(const Information& information) {
  std::string text;
  if (information.force_law)
    for (const std::byte byte : *information.force_law) text += fmt::format("{:02x}", static_cast<unsigned>(byte));
  return text;
}

void take_force_law(Recording& recording, std::string_view digits, std::string_view file) {
  if (digits.empty()) return;  // a file of an earlier version, or of a device without a report
  std::vector<std::byte> report(digits.size() / 2);
  bool is_whole = digits.size() % 2 == 0;
  for (std::size_t i = 0; i < report.size(); ++i) {
    const char* pair = digits.data() + 2 * i;
    unsigned value = 0;
    is_whole &= std::from_chars(pair, pair + 2, value, 16).ptr == pair + 2;
    report[i] = static_cast<std::byte>(value);
  }
  try {
    if (!is_whole) throw device::Error("It is not in hexadecimal digits.");
    const auto law = device::parse_force_law(report);
    recording.information.force_law = law.report;
    if (!device::join_tables(law))
      recording.remarks.push_back(
          fmt::format("{} was recorded with the force law {}, but this program already uses the force law {}: the "
                      "parameters and signals of the recorded force law are ignored.",
                      file, law.name, device::joined_force_law()));
  } catch (const device::Error&) {
    recording.remarks.push_back(fmt::format(
        "The description of the force law in {} is damaged: its parameters and signals are ignored.", file));
  }
}

}  // namespace inkwell::recording
