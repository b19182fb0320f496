#include "host/client/device/fault_text.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "boards/facts/board_facts.hpp"
#include "protocol/reports.hpp"

namespace inkwell::device {
namespace {

long percent(float share) { return std::lround(100.0f * share); }

std::string with_figures(std::string_view text) {
  return fmt::format(fmt::runtime(text), fmt::arg("supply_minimum_V", board::supply_minimum_V),
                     fmt::arg("supply_nominal_V", board::supply_nominal_V),
                     fmt::arg("supply_maximum_V", board::supply_maximum_V),
                     fmt::arg("shunt_amplifier_offset_V", board::shunt_amplifier_offset_V),
                     fmt::arg("over_current_percent", percent(protocol::over_current_ratio)),
                     fmt::arg("samples_stale_ms", 1e3f * protocol::samples_stale_s),
                     fmt::arg("main_loop_stalled_ms", 1e3f * protocol::main_loop_stalled_s),
                     fmt::arg("supply_ripple_V", protocol::supply_ripple_V),
                     fmt::arg("analog_supply_percent", percent(protocol::analog_supply_tolerance)),
                     fmt::arg("motor_heat_beyond_percent", percent(protocol::motor_heat_fault - 1.0f)),
                     fmt::arg("motor_heat_holds_back_percent", percent(protocol::motor_heat_limits_from)));
}

}  // namespace

FaultText fault_text(protocol::Fault fault) {
  const auto& row = protocol::info(fault);
  return {with_figures(row.cause), with_figures(row.remedy)};
}

FaultText fault_text(protocol::Fault fault, const protocol::SelfTestReport& test) {
  FaultText text = fault_text(fault);
  std::vector<std::string_view> items, remedies;
  for (std::size_t i = 0; i < protocol::self_test_item_count; ++i) {
    const auto& item = protocol::self_test_item_table[i];
    if (!item.takes_force || !protocol::is_failure(test.entries[i].result)) continue;
    items.push_back(item.name);
    const std::string_view remedy = protocol::remedy_of(item, test.entries[i].result);
    if (std::ranges::find(remedies, remedy) == remedies.end()) remedies.push_back(remedy);
  }
  if (fault != protocol::Fault::self_test_failed || items.empty()) return text;
  text.cause = fmt::format("The self-test failed for items that the force needs: {}.", fmt::join(items, ", "));
  text.remedy = fmt::format("{} Then clear the fault, which tests again.", fmt::join(remedies, " "));
  return text;
}

namespace {

std::string line_of(protocol::Fault fault, const FaultText& text) {
  return fmt::format("{}: {} {}", protocol::info(fault).name, text.cause, text.remedy);
}

}  // namespace

std::string fault_line(protocol::Fault fault) { return line_of(fault, fault_text(fault)); }

std::string fault_line(protocol::Fault fault, const protocol::SelfTestReport& test) {
  return line_of(fault, fault_text(fault, test));
}

}  // namespace inkwell::device
