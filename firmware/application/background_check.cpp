#include "firmware/application/background_check.hpp"

#include "firmware/application/parts.hpp"

namespace inkwell::application {

using protocol::condition;
using protocol::Fault;
using protocol::Signal;

bool BackgroundCheck::start() {
  analog_supply_ = control::analog_supply(drivers::AnalogInputs::calibrated_reference_counts());
  const bool memory_intact = memory_check_.start();
  report(condition(Fault::memory_damaged, !memory_intact));
  return memory_intact;
}

// The memory check runs one small step in every round of the main loop. Checks of supplies and wires run every 0.15 ms,
// in every third round of the main loop. More frequent checks would displace main loop code from the flash cache. Each
// result is stored for three rounds, so that the control interrupt cannot miss a result.
void BackgroundCheck::run() {
  const bool memory_intact = memory_check_.step();
  if (++rounds_ < rounds_per_check) return;
  rounds_ = 0;
  report(condition(Fault::memory_damaged, !memory_intact) | supply_faults() | encoder_faults() | bridge_faults());
}

void BackgroundCheck::report(protocol::Conditions found) { host_link.found_in_main_loop.store(found); }

protocol::Conditions BackgroundCheck::supply_faults() {
  const bool swings = supply_ripple_.detect_ripple(analog_inputs.supply_counts(), completed_periods.load());
  return condition(Fault::logic_supply_low, logic_supply.is_low()) |
         condition(Fault::analog_supply, analog_supply_.detect_supply_error(analog_inputs.reference_counts())) |
         condition(Fault::supply_ripple, swings);
}

protocol::Conditions BackgroundCheck::encoder_faults() {
  const std::uint32_t now_periods = completed_periods.load();
  const auto timer_counts = encoders.read();
  bool dead = false;
  for (std::size_t i = 0; i < timer_counts.size(); ++i)
    dead |= encoder_wires_[i].detect_dead_wire(timer_counts[i], now_periods);
  return condition(Fault::encoder_wire, dead) | condition(Fault::encoder_implausible, detect_stuck_encoders());
}

bool BackgroundCheck::detect_stuck_encoders() {
  const link::Sample* const sample = host_link.samples.newest();
  if (sample == nullptr) return false;
  const link::Sample& newest = *sample;
  const bool in_inkwell = protocol::is_closed(newest.summary.switches, protocol::Switch::inkwell);
  const bool held = in_inkwell || !protocol::force_is_on(newest.summary.state);
  constexpr protocol::EachAxis<Signal> encoders_counts = Signal::encoder_1_counts, currents_A = Signal::current_1_A;
  const control::Triple& moving_A = host_link.parameters.settings().limits.moving_A;
  bool stuck = false;
  for (std::size_t i = 0; i < stuck_encoders_.size(); ++i) {
    const auto counts = static_cast<std::int32_t>(newest.signals[encoders_counts[i]]);
    stuck |= stuck_encoders_[i].detect_stuck_encoder(counts, newest.signals[currents_A[i]], newest.summary.periods,
                                                     held, moving_A[i]);
  }
  return stuck;
}

protocol::Conditions BackgroundCheck::bridge_faults() {
  const std::uint32_t periods_before = completed_periods.load();
  const control::BridgePins pins{bridges.are_on(), bridges.enable_is_high(), bridges.heartbeat_is_high(),
                                 bridges.hold_is_high(), bridges.a_leg_is_high()};
  // If a control interrupt occurred during the reads, the levels are ignored.
  if (completed_periods.load() == periods_before) bridge_wire_.update(pins);
  return condition(Fault::bridge_wire, bridge_wire_.is_shorted());
}

}  // namespace inkwell::application
