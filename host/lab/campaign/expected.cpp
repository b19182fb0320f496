#include "host/lab/campaign/expected.hpp"

#include <fmt/format.h>

#include "host/client/device/error.hpp"

#include "host/lab/campaign/page_hand.hpp"
#include "host/lab/campaign/page_plots.hpp"

namespace inkwell::campaign {
namespace {

using protocol::Fault;

// clang-format off
constexpr Expected known_cases[] = {
    // Electrical faults switch the bridges off within two control periods.
    {"wire_low:bridge_fault_tim1 rest 2", Fault::bridge_fault, Fault::bridge_fault, quick_periods, true},
    {"shunt_high:2 wall 1", Fault::over_current, Fault::over_current, quick_periods, false},
    {"wire_low:motor_current[1] motion 3", Fault::over_current, Fault::over_current, quick_periods, true},
    {"leg_low:2A motion 1", Fault::bridge_fault, Fault::bridge_fault, quick_periods, false},
    {"leg_high:1B limited 3", Fault::bridge_fault, Fault::bridge_fault, quick_periods, true},
    {"shunt_high:3 wall 2", Fault::over_current, Fault::over_current, quick_periods, true},
    {"motor_open:2 wall 1", Fault::current_jump, Fault::current_jump, quick_periods, true},
    {"leg_open:2A wall 1", Fault::current_jump, Fault::current_jump, quick_periods, false},
    {"wire_open:bridges[1].leg_a wall 2", Fault::current_jump, Fault::current_jump, quick_periods, false},
    {"wire_low:bridges[1].leg_a motion 1", Fault::current_jump, Fault::current_jump, quick_periods, false},
    {"wire_open:motor_current[1] rest 1", Fault::current_jump, Fault::current_jump, quick_periods, false},
    {"wire_open:motor_current[1] limited 1", Fault::current_jump, Fault::current_jump, quick_periods, true},
    {"wire_open:motor_current[1] motion 2", Fault::current_jump, Fault::current_jump, quick_periods, false},
    {"shunt_gain:2 wall 3", Fault::current_jump, Fault::current_jump, quick_periods, false},
    {"shunt_gain:2=2 wall 1", Fault::current_jump, Fault::current_jump, quick_periods, true},
    {"shunt_offset:2 limited 1", Fault::current_jump, Fault::current_jump, quick_periods, true},
    {"wires_shorted:motor_current[1]+motor_current[2] wall 2", Fault::current_jump, Fault::current_jump, quick_periods, false},
    {"adc_stopped:2 wall 1", Fault::samples_stale, Fault::samples_stale, quick_periods, true},
    {"adc_stopped:3 motion 2", Fault::samples_stale, Fault::samples_stale, quick_periods, false},
    // In these cases a motor does not follow its voltage. A frozen current reading is detected late, because the
    // current deviates slowly from the reading.
    {"wires_shorted:bridges[1].leg_a+bridges[1].leg_b wall 2", Fault::motor_implausible, Fault::current_jump, 40, true},
    {"shunt_frozen:2 wall 3", Fault::motor_implausible, Fault::current_jump, 4000, true},
    {"motor_shorted:2 wall 1", Fault::motor_implausible, Fault::current_jump, 2000, true}};
// clang-format on

}  // namespace

std::span<const Expected> expected_cases() { return known_cases; }

Case case_named(std::string_view name) {
  for (const Case& each : all_cases())
    if (each.name() == name) return each;
  throw device::Error(fmt::format("There is no case `{}`; `inkwell-lab campaign list` shows all cases.", name));
}

std::string fault_free_name(const Case& the_case) {
  if (the_case.situation != CaseSituation::motion) return "";
  return Case{0, {}, the_case.situation, the_case.phase}.name();
}

std::vector<std::string> deviations(const Expected& expected, const Result& result, double energy_without_fault_J) {
  // The newest pose may be one millisecond old.
  constexpr double tolerated_energy_J = 0.01, tolerated_m = 0.0015;
  if (!result.error.empty()) return {result.error};
  std::vector<std::string> found;
  if (!result.off_after_s)
    found.emplace_back("The bridges did not switch off.");
  else if (*result.off_after_s >= expected.longest_off_periods * control_period_s)
    found.push_back(fmt::format("The bridges were off after {:.1f} control periods; the limit is {}.",
                                *result.off_after_s / control_period_s, expected.longest_off_periods));
  if (result.detected_as != expected.detected_as && result.detected_as != expected.or_as)
    found.push_back(fmt::format("The board reported `{}` instead of `{}`.", protocol::info(result.detected_as).name,
                                protocol::info(expected.detected_as).name));
  if (result.peak_force_N >= tolerated_part_of_limit * result.force_limit_N)
    found.push_back(fmt::format("The force on the hand was {:.2f} N with a limit of {:.2f} N.", result.peak_force_N,
                                result.force_limit_N));
  if (result.energy_J >= energy_without_fault_J + tolerated_energy_J)
    found.push_back(fmt::format("The hand received {:.1f} mJ, and {:.1f} mJ without the fault.", 1e3 * result.energy_J,
                                1e3 * energy_without_fault_J));
  if (result.recovery != Recovery::clear_fault)
    found.push_back(fmt::format("The recovery was `{}` instead of `clear_fault`.", name_of(result.recovery)));
  const bool is_quick = expected.longest_off_periods <= quick_periods;
  if (is_quick && (!result.position_error_m || *result.position_error_m >= tolerated_m))
    found.push_back(
        fmt::format("The position error was {:.2f} mm at the end.", 1e3 * result.position_error_m.value_or(1)));
  return found;
}

}  // namespace inkwell::campaign
