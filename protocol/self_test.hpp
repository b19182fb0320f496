// Self-test items, results and report.
//
// The self-test runs on command, and after each start when the current sensor offsets have been measured. During the
// self-test the state is `testing`. Flash, RAM and watchdog are tested only at start-up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "protocol/reports.hpp"

namespace inkwell::protocol {

namespace self_test_text {
inline constexpr std::string_view encoder = "The wire from the encoder drives the input pin.";
inline constexpr std::string_view encoder_remedy =
    "Repair the encoder wire, its plug or the Schmitt trigger at the input.";
inline constexpr std::string_view fault_wire = "The fault wire of the bridges reaches the chip.";
inline constexpr std::string_view fault_wire_remedy =
    "Repair the fault wire between the chip, the pull-up resistor and the bridges.";
inline constexpr std::string_view wiper = "The wiper of the gimbal potentiometer is within its track.";
inline constexpr std::string_view wiper_remedy =
    "Check the three wires of the potentiometer. The force does not depend on the potentiometer, but this gimbal angle "
    "is wrong.";
inline constexpr std::string_view motor = "The motor current during short voltage pulses matches the motor resistance.";
inline constexpr std::string_view motor_remedy =
    "If the resistance is too high, check the half bridges, and the wires and brushes of the motor. If the resistance "
    "is too low, the winding may be shorted. In both cases check the shunt, its amplifier, and motor_resistance_n_ohm. "
    "If the motor is new or not installed, set motors_confirmed to 0 and test again: then `inkwell tune current-loop` "
    "can measure a new motor.";
inline constexpr std::string_view bridge = "The half bridges switch within their dead time.";
inline constexpr std::string_view bridge_remedy =
    "Check the supply of the bridge, check its inputs for slow edges, or replace the bridge.";
}  // namespace self_test_text

// clang-format off
/// X(id, name, unit of the figure, true if a failure prevents force, meaning of a pass, remedy)
#define INKWELL_SELF_TEST_ITEMS(X)                                                                                     \
  X(0, flash, "", true, "The firmware in flash, its copies in RAM and the active parameters are undamaged.", "Reset the board. If the failure returns, flash the firmware again. If it still returns, replace the chip.") \
  X(1, ram, "", true, "The RAM retains each bit of a pattern. The RAM is tested at power-on, not at a reset.", "Switch the power off and on. If the failure returns, replace the chip.") \
  X(2, watchdog, "ms", true, "The watchdog oscillator runs, the watchdog has accepted its timeout, and the watchdog expired in time in the power-on test.", "Switch the power off and on. If the failure returns, replace the chip.") \
  X(3, current_offsets, "A", true, "With the bridges off, the current sensors read zero, which is the middle of the converter range.", "Check the shunt amplifiers and their reference, then reset the board.") \
  X(4, analog_supply, "V", true, "The analog supply VDDA is correct relative to the chip's internal reference.", "Check the ferrite bead and capacitors of VDDA, and the 3.3 V regulator.") \
  X(5, encoder_1_a, "", true, self_test_text::encoder, self_test_text::encoder_remedy)                                 \
  X(6, encoder_1_b, "", true, self_test_text::encoder, self_test_text::encoder_remedy)                                 \
  X(7, encoder_2_a, "", true, self_test_text::encoder, self_test_text::encoder_remedy)                                 \
  X(8, encoder_2_b, "", true, self_test_text::encoder, self_test_text::encoder_remedy)                                 \
  X(9, encoder_3_a, "", true, self_test_text::encoder, self_test_text::encoder_remedy)                                 \
  X(10, encoder_3_b, "", true, self_test_text::encoder, self_test_text::encoder_remedy)                                 \
  X(11, bridge_fault_tim1, "", true, self_test_text::fault_wire, self_test_text::fault_wire_remedy)                    \
  X(12, bridge_fault_tim8, "", true, self_test_text::fault_wire, self_test_text::fault_wire_remedy)                    \
  X(13, gimbal_1, "of its track", false, self_test_text::wiper, self_test_text::wiper_remedy)                          \
  X(14, gimbal_2, "of its track", false, self_test_text::wiper, self_test_text::wiper_remedy)                          \
  X(15, gimbal_3, "of its track", false, self_test_text::wiper, self_test_text::wiper_remedy)                          \
  X(16, motor_1, "ohm", true, self_test_text::motor, self_test_text::motor_remedy)                                     \
  X(17, motor_2, "ohm", true, self_test_text::motor, self_test_text::motor_remedy)                                     \
  X(18, motor_3, "ohm", true, self_test_text::motor, self_test_text::motor_remedy)                                     \
  X(19, current_wires, "A", true, "The current of each motor appears only at the sensor of that motor.", "Check the wires from the shunt amplifiers to the chip: two wires are swapped or shorted together.") \
  X(20, bridge_1, "V", false, self_test_text::bridge, self_test_text::bridge_remedy)                                   \
  X(21, bridge_2, "V", false, self_test_text::bridge, self_test_text::bridge_remedy)                                   \
  X(22, bridge_3, "V", false, self_test_text::bridge, self_test_text::bridge_remedy)

/// X(id, name, meaning)
#define INKWELL_SELF_TEST_RESULTS(X)                                                                                   \
  X(0, not_done, "Not tested yet, or not testable because another item failed.")                                                 \
  X(1, passed, "The item is correct.")                                                                               \
  X(2, failed, "The item is not correct.")                                                                           \
  X(3, moved, "Not tested: the arm moved too fast. Hold the arm still and test again. Before the first completed test, motors that are not confirmed receive no current for the force.") \
  X(4, no_part, "Not tested: a motor with a current limit of 0 is not used.")                                          \
  X(5, broken_off, "Not tested: the bridges had no supply, or another fault interrupted the test.")                    \
  X(6, missing, "No current flows. Connect the motor, or check its bridge, its shunt and its amplifier.")                \
  X(7, unknown_motor, "The resistance differs from motor_resistance_n_ohm. Run `inkwell tune current-loop`, and apply its proposals if this motor is the intended one.") \
  X(8, wrong_sign, "The sensor shows a current of the wrong sign. Swap the sense wires of the shunt, not the motor wires.")
// clang-format on

/// The value of an enumerator is the index of its row and of its entry in SelfTestReport::entries.
enum class SelfTestItem : std::uint8_t {
#define X(id, name, ...) name = id,
  INKWELL_SELF_TEST_ITEMS(X)
#undef X
};

enum class SelfTestResult : std::uint8_t {
#define X(id, name, ...) name = id,
  INKWELL_SELF_TEST_RESULTS(X)
#undef X
};

struct SelfTestItemInfo {
  std::string_view name;
  std::string_view unit;  ///< unit of the figure; empty if the item has no figure
  bool takes_force;
  std::string_view meaning;
  std::string_view remedy;
};

struct SelfTestResultInfo {
  std::string_view name;
  std::string_view meaning;
};

inline constexpr auto self_test_item_table = std::to_array<SelfTestItemInfo>({
#define X(id, name, unit, takes_force, meaning, remedy) {#name, unit, takes_force, meaning, remedy},
    INKWELL_SELF_TEST_ITEMS(X)
#undef X
});
inline constexpr std::size_t self_test_item_count = self_test_item_table.size();

inline constexpr auto self_test_result_table = std::to_array<SelfTestResultInfo>({
#define X(id, name, meaning) {#name, meaning},
    INKWELL_SELF_TEST_RESULTS(X)
#undef X
});

inline constexpr SelfTestResultInfo unknown_self_test_result{
    "unknown", "The device reported a result that is unknown to this companion."};

constexpr const SelfTestItemInfo& info(SelfTestItem item) {
  return self_test_item_table[static_cast<std::size_t>(item)];
}
constexpr const SelfTestResultInfo& info(SelfTestResult result) {
  const auto index = static_cast<std::size_t>(result);
  return index < self_test_result_table.size() ? self_test_result_table[index] : unknown_self_test_result;
}

namespace detail {
#define X(id, text, ...) \
  static_assert(self_test_item_table[id].name == std::string_view(#text), #text ": the id must be the row index");
INKWELL_SELF_TEST_ITEMS(X)
#undef X
#define X(id, text, ...) \
  static_assert(self_test_result_table[id].name == std::string_view(#text), #text ": the id must be the row index");
INKWELL_SELF_TEST_RESULTS(X)
#undef X
}  // namespace detail

/// Returns the item of motor, bridge or gimbal angle `axis` (0, 1 or 2). `first` is the item with index 0.
constexpr SelfTestItem of_axis(SelfTestItem first, std::size_t axis) {
  return static_cast<SelfTestItem>(static_cast<std::size_t>(first) + axis);
}

struct SelfTestEntry {
  float figure;  ///< measured value; 0 if the item has no figure or was not tested
  SelfTestResult result;
  std::uint8_t reserved[3];
};

/// Feature report: the newest result of each item.
struct SelfTestReport {
  ReportId report_id = ReportId::self_test;
  std::uint8_t is_running;
  std::uint16_t item_count = self_test_item_count;
  std::uint32_t tests_begun;   ///< self-tests since start-up, including the one at start-up
  std::uint32_t tests_ended;   ///< self-tests since start-up that reached a result
  std::uint32_t time_periods;  ///< board time of this report
  SelfTestEntry entries[self_test_item_count];
};

static_assert(sizeof(SelfTestEntry) == 8);
static_assert(sizeof(SelfTestReport) == 16 + 8 * self_test_item_count);

constexpr bool is_failure(SelfTestResult result) {
  return result == SelfTestResult::failed || result == SelfTestResult::wrong_sign;
}

/// Remedy of a failed item. A wrong sign has its own remedy.
constexpr std::string_view remedy_of(const SelfTestItemInfo& item, SelfTestResult result) {
  return result == SelfTestResult::wrong_sign ? info(result).meaning : item.remedy;
}

/// Returns true if a motor is not driven until the user has connected or confirmed it.
constexpr bool awaits_motor(SelfTestResult result) {
  return result == SelfTestResult::missing || result == SelfTestResult::unknown_motor;
}

/// Returns true if a failed item prevents the force.
constexpr bool takes_force(const SelfTestReport& report) {
  for (std::size_t i = 0; i < self_test_item_count; ++i)
    if (self_test_item_table[i].takes_force && is_failure(report.entries[i].result)) return true;
  return false;
}

/// Returns true if the motors receive no current for the force until all motors are connected and confirmed.
constexpr bool awaits_motors(const SelfTestReport& report) {
  for (std::size_t i = 0; i < self_test_item_count; ++i)
    if (awaits_motor(report.entries[i].result)) return true;
  return false;
}

}  // namespace inkwell::protocol
