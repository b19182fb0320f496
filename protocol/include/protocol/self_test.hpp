// The board's self-test: what it looks at, what it found of each, and the report that tells.
//
// It runs by itself after each start, once the current sensors are measured, and on command: state `testing`. Flash,
// RAM and watchdog are looked at only as the board starts; what they gave then stays in the report.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <protocol/reports.hpp>

namespace inkwell::protocol {

namespace self_test_text {
inline constexpr std::string_view encoder = "The wire from the encoder drives its input.";
inline constexpr std::string_view encoder_remedy = "Mend this wire, its plug or the Schmitt trigger before the chip.";
inline constexpr std::string_view fault_wire = "The wire by which the bridges tell a fault reaches the chip.";
inline constexpr std::string_view fault_wire_remedy = "Mend the wire between this pin, its pull-up and the bridges.";
inline constexpr std::string_view wiper = "The wiper of the gimbal's potentiometer is off the ends of its track.";
inline constexpr std::string_view wiper_remedy =
    "Check the potentiometer's three wires. The force does without it; this angle of the gimbal is wrong.";
inline constexpr std::string_view motor =
    "Small pulses of voltage give the current that the motor's resistance asks for.";
inline constexpr std::string_view motor_remedy =
    "Too much: check the motor's wires and brushes and the legs of its bridge. Too little: its winding may be shorted. "
    "Either: check its shunt and amplifier, and motor_resistance_n_ohm, which `inkwell tune current-loop` measures. "
    "A motor that is not there takes no part with a current_limit_n_A of 0.";
inline constexpr std::string_view bridge = "The legs of the bridge switch without more delay than their dead time.";
inline constexpr std::string_view bridge_remedy =
    "Check the bridge's supply and its inputs for slow edges, or replace it.";
}  // namespace self_test_text

// clang-format off
/// X(id, name, unit of its figure, whether a failure takes the force away, what it means if it passes, remedy)
#define INKWELL_SELF_TEST_ITEMS(X)                                                                                     \
  X(0, flash, "", true, "The firmware in the flash, its copies in the RAM and the parameters in use are undamaged.", "Reset the board. If it comes back, flash the firmware anew; if it still comes back, replace the chip.") \
  X(1, ram, "", true, "The RAM keeps each bit of a pattern. It is looked at when the power comes, not at a reset.", "Switch the power off and on. If it comes back, replace the chip.") \
  X(2, watchdog, "ms", true, "The watchdog's oscillator runs, it has taken the time after which it bites, and when the power came it was left to bite and did so in time.", "Switch the power off and on. If it comes back, replace the chip.") \
  X(3, current_offsets, "A", true, "With the bridges off the current sensors read zero, in the middle of the converters' range.", "Check the shunt amplifiers and their reference, then reset the board.") \
  X(4, analog_supply, "V", true, "VDDA, the reference of converters, amplifiers and potentiometers, is right by the chip's own reference.", "Check VDDA's ferrite bead and capacitors, and the 3.3 V regulator.") \
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
  X(19, current_wires, "A", true, "A motor's current is seen by its own sensor alone.", "Check the wires from the shunt amplifiers to the chip: two of them are swapped or touch.") \
  X(20, bridge_1, "V", false, self_test_text::bridge, self_test_text::bridge_remedy)                                   \
  X(21, bridge_2, "V", false, self_test_text::bridge, self_test_text::bridge_remedy)                                   \
  X(22, bridge_3, "V", false, self_test_text::bridge, self_test_text::bridge_remedy)

/// X(id, name, meaning)
#define INKWELL_SELF_TEST_RESULTS(X)                                                                                   \
  X(0, not_done, "It has not been looked at, or could not be while something else fails.")                                                 \
  X(1, passed, "It is as it should be.")                                                                               \
  X(2, failed, "It is not as it should be.")                                                                           \
  X(3, moved, "Not done: the arm moved too fast to tell. Hold it still and test again.")                               \
  X(4, no_part, "Not done: a motor with a current limit of 0 takes no part.")                                          \
  X(5, broken_off, "Not done: the bridges had no supply, or another fault came before it was over.")
// clang-format on

/// Its value is its place in the table and in SelfTestReport::entries.
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
  std::string_view unit;  ///< of its figure; empty if it has none
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
    "unknown", "The device gave a result that this companion does not know."};

constexpr const SelfTestItemInfo& info(SelfTestItem item) {
  return self_test_item_table[static_cast<std::size_t>(item)];
}
constexpr const SelfTestResultInfo& info(SelfTestResult result) {
  const auto index = static_cast<std::size_t>(result);
  return index < self_test_result_table.size() ? self_test_result_table[index] : unknown_self_test_result;
}

namespace detail {
#define X(id, text, ...) \
  static_assert(self_test_item_table[id].name == std::string_view(#text), #text ": its id is not its place");
INKWELL_SELF_TEST_ITEMS(X)
#undef X
#define X(id, text, ...) \
  static_assert(self_test_result_table[id].name == std::string_view(#text), #text ": its id is not its place");
INKWELL_SELF_TEST_RESULTS(X)
#undef X
}  // namespace detail

/// One of three motors, bridges or gimbal angles, named by the first; `axis` is 0, 1 or 2.
constexpr SelfTestItem of_axis(SelfTestItem first, std::size_t axis) {
  return static_cast<SelfTestItem>(static_cast<std::size_t>(first) + axis);
}

struct SelfTestEntry {
  float figure;  ///< 0 where the item has none, or was not looked at
  SelfTestResult result;
  std::uint8_t reserved[3];
};

/// Feature report: the newest result of each item.
struct SelfTestReport {
  ReportId report_id = ReportId::self_test;
  std::uint8_t is_running;
  std::uint16_t item_count = self_test_item_count;
  std::uint32_t tests_begun;   ///< since the board started, the one after the start included
  std::uint32_t tests_ended;   ///< those of them that came to a verdict
  std::uint32_t time_periods;  ///< now
  SelfTestEntry entries[self_test_item_count];
};

static_assert(sizeof(SelfTestEntry) == 8);
static_assert(sizeof(SelfTestReport) == 16 + 8 * self_test_item_count);

/// An item has failed without which there is no force.
constexpr bool takes_force(const SelfTestReport& report) {
  for (std::size_t i = 0; i < self_test_item_count; ++i)
    if (self_test_item_table[i].takes_force && report.entries[i].result == SelfTestResult::failed) return true;
  return false;
}

}  // namespace inkwell::protocol
