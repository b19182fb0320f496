// Clears a fault and checks whether the fault returns because its cause remains.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "host/client/device/device.hpp"
#include "host/client/device/error.hpp"
#include "protocol/reports.hpp"

namespace inkwell::device {

/// The fault was cleared, but its cause has raised the fault again. `what()` names the fault and its remedy.
class FaultStays : public Error {
 public:
  using Error::Error;
};

/// The fault information of a pose.
struct ShownFault {
  std::int64_t time_periods;
  protocol::State state;
  protocol::Fault fault;
};

/// One line with the name, cause and remedy of the fault. For a failed self-test the line lists the failed items, which
/// are read from the device.
std::string fault_line(protocol::Fault fault, Device& device);

/// Whether the board raises this fault when its host disconnects or falls silent while the force is on. A program that
/// finds this fault at its start can clear the fault, because the previous program caused the fault.
bool is_left_by_a_host(protocol::Fault fault);

/// Clears the fault, and checks for 0.2 s of board time that the fault does not return. If a self-test follows, the
/// check lasts until the self-test has finished. Returns immediately if `now` shows no fault. `next` waits for the next
/// pose. Throws FaultStays.
void clear_fault(Device& device, const ShownFault& now, const std::function<ShownFault()>& next);

}  // namespace inkwell::device
