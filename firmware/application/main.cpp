// Start-up sequence and main loop of the driver board's firmware.
#include <optional>

#include <board/board.hpp>
#include "firmware/drivers/boot_loader.hpp"
#include "firmware/drivers/clocks.hpp"
#include "firmware/drivers/cycle_counter.hpp"
#include "firmware/drivers/system.hpp"
#include "firmware/usb/device.hpp"

#include "firmware/application/background_check.hpp"
#include "firmware/application/crash.hpp"
#include "firmware/application/main_loop.hpp"
#include "firmware/application/parameter_memory.hpp"
#include "firmware/application/parts.hpp"
#include "firmware/application/ram_test.hpp"
#include "firmware/application/start_report.hpp"
#include "firmware/application/watchdog_trial.hpp"

namespace inkwell::application {
namespace {

/// Blinks the status LED ten times per second while `lasts` returns true. The bridges are off while the LED blinks.
template <class Condition>
void blink_while(std::uint32_t processor_Hz, Condition lasts) {
  for (bool on = true; lasts(); on = !on) {
    status_led.set(on);
    drivers::wait(processor_Hz / 20);
  }
}
void stop_forever() {
  blink_while(board::processor_Hz, [] { return true; });
}

/// Returns false if the first attempt to start the clocks failed. USB needs the clocks, so the LED and the console
/// report the failure.
bool start_clocks() {
  if (drivers::start_clocks()) return true;
  if (!drivers::crystal_oscillates()) report_no_crystal();
  blink_while(drivers::internal_oscillator_Hz,
              [] { return !drivers::crystal_oscillates() || !drivers::start_clocks(); });
  return false;
}

/// Returns the crash record if a crash caused the last reset.
std::optional<protocol::CrashFacts> read_crash(const drivers::ResetCause& cause) {
  const auto crash = crash_record.load_and_erase();
  if (crash && is_hang(*crash) && !cause.watchdog()) return std::nullopt;
  return crash;
}

/// Returns the fault that matches the cause of the last reset.
protocol::Fault fault_of_start(const drivers::ResetCause& cause, const std::optional<protocol::CrashFacts>& crash,
                               bool started_late) {
  if (started_late || (crash && crystal_stopped(*crash))) return protocol::Fault::crystal_failed;
  if (crash && !is_hang(*crash)) return protocol::Fault::processor_fault;
  if (cause.brown_out()) return protocol::Fault::logic_supply_low;
  return cause.watchdog() ? protocol::Fault::watchdog : protocol::Fault::none;
}

[[noreturn]] void run_main_loop(usb::Device& usb_device, BackgroundCheck& background_check) {
  for (;;) {
    const std::uint32_t periods = completed_periods.load();
    usb_device.poll();
    host_link.stored.follow(host_link.parameters, protocol::force_is_on(host_link.status.state()), periods);
    if (usb_device.leaves_for_update() && host_link.status.state() == protocol::State::update &&
        !host_link.stored.is_busy())
      drivers::start_boot_loader();
    host_link.scope.pack();
    host_link.black_box.follow();
    background_check.run();
    follow_self_test(background_check);
    keep_motor_heat();
    feed_watchdogs();
    show_state();
    drivers::sleep_unless([periods] { return completed_periods.load() != periods; });
  }
}

}  // namespace
}  // namespace inkwell::application

int main() {
  using namespace inkwell;
  using namespace inkwell::application;
  drivers::CycleCounter::start();
  const WatchdogTrial watchdog_trial = try_watchdog(drivers::take_reset_cause());
  const drivers::ResetCause reset_cause = watchdog_trial.cause;
  const auto crash = read_crash(reset_cause);

  drivers::start_pins();
  status_led.start();
  const bool started_late = !start_clocks();
  report_start(reset_cause, crash);
  logic_supply.start();
  if (reset_cause.power_on()) host_link.self_test.note(protocol::SelfTestItem::ram, ram_retains_pattern());

  // The stored parameters are loaded before any parameter is used. A flash erase is harmless at this point, because
  // watchdog, bridges, interrupts and USB do not run yet.
  ParameterMemory parameter_memory;
  host_link.stored.start(parameter_memory, {INKWELL_VERSION_NUMBERS}, host_link.parameters);

  // The converter clocks must start before TIM1 triggers the converters (erratum "TRGO trigger output failure").
  analog_inputs.start_clocks();
  drivers::CallAfterInterrupts::start();
  bridges.start();
  encoders.start();
  switches.start();
  analog_inputs.start();
  const protocol::Fault fault = fault_of_start(reset_cause, crash, started_late);
  if (fault != protocol::Fault::none) controller.raise(fault);
  take_motor_heat(reset_cause.power_on());
  host_link.black_box.start(fault, crash.value_or(protocol::CrashFacts{}));
  BackgroundCheck background_check;
  host_link.self_test.note(protocol::SelfTestItem::flash, background_check.start());

  // The wait leaves enough time to arm all converters before the next update.
  if (!bridges.wait_for_update()) stop_forever();
  analog_inputs.arm();
  logic_supply.arm();

  const usb::Identity identity{.serial_number = drivers::unique_identifier(),
                               .firmware_version = {INKWELL_VERSION_NUMBERS},
                               .board = board::facts.name,
                               .processor_clock_Hz = board::processor_Hz,
                               .reset_cause = reset_cause.flags >> 24,
                               .image_check = *image_check};
  usb::Device usb_device{usb_port, host_link, identity};
  if (!usb_port.start()) stop_forever();
  host_link.self_test.note(protocol::SelfTestItem::watchdog, watchdog.start() && watchdog_trial.is_passed,
                           watchdog_trial.expired_after_ms);

  feed_watchdogs();  // from here on a hang is detected, even in the first round
  run_main_loop(usb_device, background_check);
}
