#include <device/fault_text.hpp>

#include <cmath>

#include <fmt/format.h>

#include <board/facts.hpp>
#include <protocol/reports.hpp>

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
                     fmt::arg("supply_ripple_V", protocol::supply_ripple_V),
                     fmt::arg("analog_supply_percent", percent(protocol::analog_supply_bearable)),
                     fmt::arg("motor_heat_beyond_percent", percent(protocol::motor_heat_fault - 1.0f)),
                     fmt::arg("motor_heat_holds_back_percent", percent(protocol::motor_heat_holds_back_from)));
}

}  // namespace

FaultText fault_text(protocol::Fault fault) {
  const auto& row = protocol::info(fault);
  return {with_figures(row.cause), with_figures(row.remedy)};
}

std::string fault_line(protocol::Fault fault) {
  const auto [cause, remedy] = fault_text(fault);
  return fmt::format("{}: {} {}", protocol::info(fault).name, cause, remedy);
}

}  // namespace inkwell::device
