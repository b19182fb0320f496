#include "firmware/application/main_loop.hpp"

#include "firmware/store/motor_heat_keeper.hpp"

#include "firmware/application/crash.hpp"
#include "firmware/application/parts.hpp"

namespace inkwell::application {
namespace {

drivers::LedPattern led_pattern(protocol::State state) {
  switch (state) {
    case protocol::State::starting:
    case protocol::State::testing:
    case protocol::State::unreferenced: return drivers::LedPattern::slow_blink;
    case protocol::State::fault: return drivers::LedPattern::fast_blink;
    default: return drivers::LedPattern::steady;
  }
}

bool floats(protocol::SelfTestItem wire) {
  using enum protocol::SelfTestItem;
  switch (wire) {
    case bridge_fault_tim1: return bridges.fault_wire_of_tim1_floats();
    case bridge_fault_tim8: return bridges.fault_wire_of_tim8_floats();
    default: break;
  }
  const std::size_t number = static_cast<std::size_t>(wire) - static_cast<std::size_t>(encoder_1_a);
  return number % 2 == 0 ? encoders.wire_a_floats(number / 2) : encoders.wire_b_floats(number / 2);
}

[[gnu::section(".noinit")]] link::MotorHeatKeeper motor_heat_keeper;

}  // namespace

void take_motor_heat(bool after_power_on) {
  if (const auto warmth = motor_heat_keeper.start(after_power_on)) controller.start_warm(*warmth);
}

// The motor heat is stored only after a change. Storing the heat in every round would use a third of the main loop's
// sleep time. A control interrupt during the copy may cause a difference of one update between housing heat and total
// heat.
void keep_motor_heat() {
  static std::uint32_t kept_at_periods = 0;
  const std::uint32_t periods = completed_periods.load();
  if (periods - kept_at_periods < control::MotorHeat::periods_per_update) return;
  kept_at_periods = periods;
  motor_heat_keeper.store(controller.warmth());
}

void follow_self_test(const BackgroundCheck& background_check) {
  link::SelfTest& test = host_link.self_test;
  if (!test.goes_on()) return;
  const control::AnalogSupply& supply = background_check.analog_supply();
  const std::uint16_t reference_counts = analog_inputs.reference_counts();
  test.follow(controller, host_link.parameters.settings(),
              {.gimbal_ratio = analog_inputs.gimbal_ratio(),
               .analog_supply_V = supply.analog_supply_V(reference_counts),
               .analog_supply_is_right = supply.is_right(reference_counts)});
  if (const auto wire = test.wanted_wire()) test.note_wire(floats(*wire));
}

void feed_watchdogs() {
  static_assert(protocol::main_loop_stalled_s < 0.8f * drivers::IndependentWatchdog::shortest_timeout_s);
  static std::uint32_t fed_at_periods = 0;
  const std::uint32_t periods = completed_periods.load();
  // The bound is halved, because the control interrupt may have advanced `completed_periods` after the read.
  const bool may_be_noted = periods - main_loop_periods.load() > main_loop_stalled_periods / 2;
  main_loop_periods.store(periods);
  if (may_be_noted) crash_record.erase();  // the main loop runs again, and no hang is recorded after the store
  if (periods != fed_at_periods) watchdog.feed();
  fed_at_periods = periods;
}

void show_state() { status_led.show(led_pattern(host_link.status.state()), completed_periods.load()); }

}  // namespace inkwell::application
