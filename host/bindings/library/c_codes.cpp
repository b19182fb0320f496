// Compares the constants of the C header with the constants of the protocol.
#include <algorithm>
#include <cstddef>
#include <string_view>

#include <inkwell/inkwell.h>
#include "protocol/faults.hpp"
#include "protocol/reports.hpp"
#include "protocol/self_test.hpp"
#include "protocol/store.hpp"

namespace inkwell {
namespace {

struct Code {
  std::string_view name;
  int value;
};
#define CODE(name) \
  { #name, INKWELL_##name }

/// Returns true if `c` is `prefix` plus `name` in capitals.
constexpr bool is_capital_of(std::string_view c, std::string_view prefix, std::string_view name) {
  if (!c.starts_with(prefix)) return false;
  c.remove_prefix(prefix.size());
  return std::ranges::equal(c, name, [](char capital, char letter) {
    return capital == (letter >= 'a' && letter <= 'z' ? letter - 'a' + 'A' : letter);
  });
}

constexpr Code faults[] = {CODE(FAULT_NONE),
                           CODE(FAULT_BRIDGE_FAULT),
                           CODE(FAULT_SUPPLY_LOW),
                           CODE(FAULT_SUPPLY_HIGH),
                           CODE(FAULT_CURRENT_SENSOR),
                           CODE(FAULT_OVER_CURRENT),
                           CODE(FAULT_OVER_SPEED),
                           CODE(FAULT_ENCODER_IMPLAUSIBLE),
                           CODE(FAULT_HOST_SILENT),
                           CODE(FAULT_SERVO_OVERRUN),
                           CODE(FAULT_WATCHDOG),
                           CODE(FAULT_PROCESSOR_FAULT),
                           CODE(FAULT_NOT_FINITE),
                           CODE(FAULT_SAMPLES_STALE),
                           CODE(FAULT_CRYSTAL_FAILED),
                           CODE(FAULT_FORCE_LAW),
                           CODE(FAULT_MOTOR_HOT),
                           CODE(FAULT_MEMORY_DAMAGED),
                           CODE(FAULT_MOTOR_IMPLAUSIBLE),
                           CODE(FAULT_LOGIC_SUPPLY_LOW),
                           CODE(FAULT_SUPPLY_RIPPLE),
                           CODE(FAULT_ENCODER_WIRE),
                           CODE(FAULT_BRIDGE_WIRE),
                           CODE(FAULT_ANALOG_SUPPLY),
                           CODE(FAULT_SELF_TEST_FAILED),
                           CODE(FAULT_INKWELL_IMPLAUSIBLE),
                           CODE(FAULT_MAIN_LOOP_STALLED),
                           CODE(FAULT_HEARTBEAT_MISSED),
                           CODE(FAULT_CURRENT_JUMP),
                           CODE(FAULT_USB_GONE)};
static_assert(std::ranges::equal(faults, protocol::fault_table, [](const Code& c, const protocol::CodeInfo& row) {
  return c.value == row.code && is_capital_of(c.name, "FAULT_", row.name);
}));

constexpr Code sources[] = {CODE(WALLS), CODE(SHAPES), CODE(PROGRAM)};
static_assert(std::ranges::equal(sources, protocol::force_source_table, [](const Code& c, const auto& row) {
  return c.value == static_cast<int>(row.source) && is_capital_of(c.name, "", row.name);
}));

constexpr Code limits[] = {CODE(LIMIT_FORCE), CODE(LIMIT_CURRENT), CODE(LIMIT_CHANGE), CODE(LIMIT_ENERGY),
                           CODE(LIMIT_HEAT),  CODE(LIMIT_SPEED),   CODE(LIMIT_MOTORS)};
static_assert(std::ranges::equal(limits, protocol::limit_table, [](const Code& c, const auto& row) {
  return c.value == static_cast<int>(row.limit) && is_capital_of(c.name, "LIMIT_", row.name);
}));
// The member `limits` uses former padding and does not change the offsets of other members.
static_assert(offsetof(inkwell_pose, position_m) == 24 && sizeof(inkwell_pose) == 240);

constexpr Code stored[] = {CODE(STORED_NOTHING), CODE(STORED_PARAMETERS), CODE(STORED_FACTORY_RESET),
                           CODE(STORED_OTHER_SCHEMA)};
static_assert(std::ranges::equal(stored, protocol::store_contents_table, [](const Code& c, const auto& row) {
  return &row - protocol::store_contents_table.data() == c.value && is_capital_of(c.name, "STORED_", row.name);
}));
static_assert(std::size(inkwell_store{}.sector_erases) == protocol::store_sectors);

constexpr Code tests[] = {CODE(TEST_NOT_DONE), CODE(TEST_PASSED),        CODE(TEST_FAILED),
                          CODE(TEST_MOVED),    CODE(TEST_NO_PART),       CODE(TEST_BROKEN_OFF),
                          CODE(TEST_MISSING),  CODE(TEST_UNKNOWN_MOTOR), CODE(TEST_WRONG_SIGN)};
static_assert(std::ranges::equal(tests, protocol::self_test_result_table, [](const Code& c, const auto& row) {
  return &row - protocol::self_test_result_table.data() == c.value && is_capital_of(c.name, "TEST_", row.name);
}));

static_assert(INKWELL_MOTOR_HEAT_HOLDS_BACK == protocol::motor_heat_limits_from);
static_assert(INKWELL_BESIDE_WALLS == static_cast<int>(protocol::ForceMode::beside_walls));
static_assert(INKWELL_INSTEAD_OF_WALLS == static_cast<int>(protocol::ForceMode::instead_of_walls));

// pose_reader.cpp maps each new state to one of these states, because existing programs cannot handle new states.
constexpr Code states[] = {CODE(STARTING), CODE(UNREFERENCED), CODE(READY), CODE(ACTIVE), CODE(FAULT)};
static_assert(std::ranges::all_of(states, [](const Code& c) {
  return is_capital_of(c.name, "", info(static_cast<protocol::State>(c.value)).name);
}));

}  // namespace
}  // namespace inkwell
