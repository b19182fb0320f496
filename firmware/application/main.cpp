// The driver board's firmware: what it is made of, in the order in which it comes to life.
#include <board/omni_driver.hpp>
#include <drivers/clocks.hpp>
#include <drivers/crash_record.hpp>
#include <drivers/cycle_counter.hpp>
#include <drivers/system.hpp>
#include <placement/interrupt.hpp>
#include <usb/device.hpp>

#include "handlers.hpp"
#include "parts.hpp"

namespace inkwell::application {
namespace {

/// The board cannot work, and its bridges are off: blinks ten times a second until it is switched off.
[[noreturn]] void give_up(std::uint32_t processor_Hz) {
  for (bool on = true;; on = !on) {
    status_led.set(on);
    drivers::wait(processor_Hz / 20);
  }
}

void report_start(const drivers::ResetCause& cause, const std::optional<drivers::CrashRecord>& crash) {
  console.start();
  console.write("inkwell " INKWELL_VERSION ", reset cause ");
  console.write_hexadecimal(cause.flags >> 24);
  if (crash) {
    console.write(", exception ");
    console.write_hexadecimal(crash->exception);
    console.write(" at ");
    console.write_hexadecimal(crash->program_counter);
    console.write(" from ");
    console.write_hexadecimal(crash->link_register);
    console.write(" status ");
    console.write_hexadecimal(crash->configurable_fault_status);
    console.write(" ");
    console.write_hexadecimal(crash->hard_fault_status);
    console.write(" address ");
    console.write_hexadecimal(crash->fault_address);
  }
  console.write("\r\n");
}

drivers::LedPattern led_pattern(protocol::State state) {
  switch (state) {
    case protocol::State::starting:
    case protocol::State::unreferenced: return drivers::LedPattern::slow_blink;
    case protocol::State::ready:
    case protocol::State::active: return drivers::LedPattern::steady;
    case protocol::State::fault: break;
  }
  return drivers::LedPattern::fast_blink;
}

/// The watchdog is fed by the main loop, and only if the control interrupt ran: it bites when either hangs.
void feed_watchdog() {
  static std::uint32_t fed_at_periods = 0;
  const std::uint32_t periods = completed_periods.load();
  if (periods != fed_at_periods) watchdog.feed();
  fed_at_periods = periods;
}

}  // namespace

extern "C" INKWELL_INTERRUPT void usb_interrupt() { drivers::OtgFs::wake(); }

}  // namespace inkwell::application

int main() {
  using namespace inkwell;
  using namespace inkwell::application;
  const auto reset_cause = drivers::take_reset_cause();
  const auto crash = drivers::take_crash_record();

  drivers::start_pins();
  drivers::CycleCounter::start();
  status_led.start();
  if (!drivers::start_clocks()) give_up(drivers::internal_oscillator_Hz);
  report_start(reset_cause, crash);

  // The converters' clocks before TIM1 triggers them (erratum "TRGO trigger output failure").
  analog_inputs.start_clocks();
  bridges.start();
  encoders.start();
  switches.start();
  analog_inputs.start();
  if (crash)
    controller.raise(protocol::Fault::processor_fault);
  else if (reset_cause.watchdog())
    controller.raise(protocol::Fault::watchdog);

  // Just after an update there is nearly a whole period in which to arm all three converters.
  if (!bridges.wait_for_update()) give_up(board::processor_Hz);
  analog_inputs.arm();

  const usb::Identity identity{.serial_number = drivers::unique_identifier(),
                               .firmware_version = {INKWELL_VERSION_NUMBERS},
                               .processor_clock_Hz = board::processor_Hz,
                               .reset_cause = reset_cause.flags >> 24};
  usb::Device usb_device{usb_port, host_link, identity};
  if (!usb_port.start()) give_up(board::processor_Hz);
  watchdog.start();

  for (;;) {
    host_link.scope.pack();
    usb_device.poll();
    feed_watchdog();
    status_led.show(led_pattern(host_link.status.state()), completed_periods.load());
    drivers::wait_for_interrupt();
  }
}
