#include "host/client/device/clear_fault.hpp"

#include <fmt/format.h>

#include "host/client/device/fault_text.hpp"

namespace inkwell::device {
namespace {

using protocol::State;

constexpr std::int64_t fault_patience_periods = protocol::servo_rate_Hz / 5;
constexpr std::int64_t retest_patience_periods = protocol::servo_rate_Hz;

bool tests_itself(State state) { return state == State::starting || state == State::testing; }

}  // namespace

std::string fault_line(protocol::Fault fault, Device& device) {
  return fault == protocol::Fault::self_test_failed ? fault_line(fault, device.read_self_test()) : fault_line(fault);
}

bool is_left_by_a_host(protocol::Fault fault) {
  return fault == protocol::Fault::usb_gone || fault == protocol::Fault::host_silent;
}

void clear_fault(Device& device, const ShownFault& now, const std::function<ShownFault()>& next) {
  device.carry_out(protocol::Command::clear_fault);
  if (now.state != State::fault) return;
  ShownFault seen = now;
  const auto passed_periods = [&] { return seen.time_periods - now.time_periods; };
  while (passed_periods() < fault_patience_periods ||
         (tests_itself(seen.state) && passed_periods() < retest_patience_periods))
    seen = next();
  if (seen.state == State::fault)
    throw FaultStays(fmt::format("The board has raised the fault again. {}", fault_line(seen.fault, device)));
}

}  // namespace inkwell::device
