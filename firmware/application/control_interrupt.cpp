// The control interrupt reads the sensors and sets the bridges 20 000 times per second.
#include "firmware/control/signal_path/encoders.hpp"
#include "firmware/drivers/cycle_counter.hpp"
#include "firmware/drivers/interrupts.hpp"
#include "firmware/placement/interrupt.hpp"

#include "firmware/application/handlers.hpp"
#include "firmware/application/main_loop.hpp"
#include "firmware/application/memory.hpp"
#include "firmware/application/parts.hpp"

namespace inkwell::application {
namespace {

using protocol::condition;
using protocol::Fault;

INKWELL_CORE_COUPLED drivers::CycleCounter clock;
INKWELL_CORE_COUPLED std::array<std::int32_t, 3> encoder_counts;

INKWELL_INTERRUPT std::uint8_t switch_bits(const drivers::SwitchContacts& contacts) {
  const auto bit = [](bool closed, protocol::Switch which) { return closed ? static_cast<unsigned>(which) : 0u; };
  return static_cast<std::uint8_t>(bit(contacts.button_1, protocol::Switch::button_1) |
                                   bit(contacts.button_2, protocol::Switch::button_2) |
                                   bit(contacts.inkwell, protocol::Switch::inkwell));
}

INKWELL_INTERRUPT control::Samples read_samples() {
  const auto timer_counts = encoders.read();
  for (std::size_t i = 0; i < timer_counts.size(); ++i)
    encoder_counts[i] = control::unwrap(encoder_counts[i], timer_counts[i]);
  const drivers::AnalogInputs::Currents currents = analog_inputs.take_currents();
  const control::Samples samples{.encoder_counts = encoder_counts,
                                 .current_A = currents.current_A,
                                 .gimbal_ratio = analog_inputs.gimbal_ratio(),
                                 .currents_measured = currents.are_new,
                                 .supply_V = analog_inputs.supply_V(),
                                 .switches = switch_bits(switches.read()),
                                 .bridge_fault = bridges.fault(),
                                 .slow_age_periods = analog_inputs.slow_age_periods()};
  analog_inputs.start_slow_conversions();
  return samples;
}

INKWELL_INTERRUPT void write_bridges(const control::Drive& drive) {
  if (drive.enabled)
    bridges.write(drive.duty);
  else
    bridges.write_brake();  // also while the bridges are off, because they start with these levels
  if (drive.enabled || drive.brake)
    bridges.enable();
  else
    bridges.disable();
}

}  // namespace

extern "C" INKWELL_INTERRUPT void control_interrupt() {
  const std::uint32_t begin_cycles = clock.begin();
  const bool bridges_were_released = bridges.begin_period();
  bridges.write_neutral();  // if the interrupt does not finish in time, the motors get no voltage

  const std::uint32_t period = controller.periods();
  const control::Samples samples = read_samples();
  if (host_link.parameters.apply_offered(period)) controller.settings_changed();
  const control::Settings& settings = host_link.parameters.settings();
  if (host_link.commands.take_sign_of_life()) controller.host_alive();
  if (const auto* command = host_link.commands.pop()) {
    controller.carry_out(*command);
    if (host_link.commands.is_of_gone_host(*command)) controller.raise(Fault::usb_gone);
  }
  if (const auto* target = host_link.program.take_force()) controller.drive(*target, settings);
  if (auto* shapes = host_link.program.take_shapes()) controller.replace_shapes(*shapes);
  if (auto* model = host_link.program.take_local_model()) controller.follow(*model);
  if (host_link.update_requested.load()) controller.leave_for_update();
  const std::uint32_t last_round_periods = main_loop_periods.load();
  const std::uint32_t missed_periods = period - last_round_periods;
  const bool main_loop_stalls = missed_periods > main_loop_stalled_periods;
  // Each stall of the main loop causes one hang record, except during start-up.
  if (missed_periods == main_loop_stalled_periods + 1 && last_round_periods != first_period) [[unlikely]]
    drivers::CallAfterInterrupts::request();  // calls hang_handler()
  controller.raise(host_link.found_in_main_loop.load() | condition(Fault::main_loop_stalled, main_loop_stalls) |
                   condition(Fault::heartbeat_missed, bridges_were_released));

  write_bridges(controller.step(samples, settings, clock));
  if (controller.state() == protocol::State::testing) [[unlikely]]
    host_link.self_test.exchange(controller);

  link::Sample& sample = host_link.samples.next();
  controller.write_signals(sample.signals);
  sample.summary = {.state = controller.state(),
                    .fault = controller.fault(),
                    .switches = controller.switches(),
                    .force_sources = controller.force_sources(),
                    .limits = controller.limits(),
                    .is_referenced = controller.is_referenced(),
                    .command_token = host_link.commands.last_token(),
                    .periods = period,
                    .begin_cycles = begin_cycles};
  host_link.samples.record();
  host_link.program.note_proxy(controller.proxy_m(), controller.depth_m());
  host_link.poses.note_load(controller.servo_cycles());
  controller.finish(clock);

  const bool overrun = bridges.period_is_over();
  if (overrun) controller.raise(Fault::servo_overrun);
  host_link.status.record(controller.state(), controller.motor_heat(), controller.servo_cycles(),
                          controller.late_force_reports(), overrun);
  completed_periods.store(controller.periods());
  bridges.end_period();
  drivers::finish_stores();
}

// The supply interrupt and the control interrupt do not preempt each other. After this interrupt, the next control
// period switches the bridges off. The main loop polls the CPU supply and reports the fault while the supply is low.
extern "C" INKWELL_INTERRUPT void logic_supply_interrupt() {
  if (logic_supply.acknowledge_interrupt()) controller.raise(Fault::logic_supply_low);
  drivers::finish_stores();
}

}  // namespace inkwell::application
